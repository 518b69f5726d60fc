"""Domains, chains and visibility by brute force in fractions; shares no code with the verifier.

The plane is cut into trapezoids by vertical lines through every end and every crossing of given segments. Faces are
what is connected across sides that no blocking segment covers.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations, pairwise

from proofs_tests import oracles
from proofs_tests.oracles import RationalPoint

__all__ = ["Cells", "Line", "cross_inside", "is_chain", "is_visible", "meeting_points", "parts_of"]

Line = tuple[RationalPoint, RationalPoint]


def meeting_points(s: Line, t: Line) -> list[RationalPoint]:
    """Where two segments meet: their crossing, or the ends of the one that lie on the other."""
    (a, b), (c, d) = s, t
    denominator = (b[0] - a[0]) * (d[1] - c[1]) - (b[1] - a[1]) * (d[0] - c[0])
    if denominator == 0:
        return [p for p in s if oracles.on_segment(p, c, d)] + [p for p in t if oracles.on_segment(p, a, b)]
    r = ((c[0] - a[0]) * (d[1] - c[1]) - (c[1] - a[1]) * (d[0] - c[0])) / denominator
    p = (a[0] + r * (b[0] - a[0]), a[1] + r * (b[1] - a[1]))
    return [p] if oracles.on_segment(p, a, b) and oracles.on_segment(p, c, d) else []


def cross_inside(s: Line, t: Line) -> RationalPoint | None:
    """The point where two segments cross, if it is an end of neither."""
    points = [p for p in meeting_points(s, t) if p not in (*s, *t)]
    return points[0] if points else None


def parts_of(s: Line, lines: Iterable[Line]) -> list[RationalPoint]:
    """The ends of a segment, and where others meet it, in order."""
    return sorted({*s, *(p for line in lines for p in meeting_points(s, line))})


def middle(p: RationalPoint, q: RationalPoint) -> RationalPoint:
    return (p[0] + q[0]) / 2, (p[1] + q[1]) / 2


def is_chain(points: Sequence[RationalPoint], edges: set[frozenset[int]], a: int, b: int) -> bool:
    """Whether edges between points of the segment ab lead from a to b, each closer to b: every way is tried."""
    p, q = points[a], points[b]
    if p == q:
        return False
    ahead = sorted if p < q else (lambda found: sorted(found, reverse=True))
    reached, places = {a}, ahead({r for r in points if oracles.on_segment(r, p, q)})
    for here in places:
        for v in [v for v in reached if points[v] == here]:
            for edge in edges:
                if v in edge:
                    (w,) = edge - {v}
                    beyond = points[w] > here if p < q else points[w] < here
                    if oracles.on_segment(points[w], p, q) and beyond:
                        reached.add(w)
    return b in reached


def y_at(line: Line, x: Fraction) -> Fraction:
    (ax, ay), (bx, by) = line
    return ay + (by - ay) * (x - ax) / (bx - ax)


@dataclass
class Trapezoid:
    """Between two vertical lines and two segments or infinity (None)."""

    left: Fraction
    right: Fraction
    low: Line | None
    high: Line | None
    sample: RationalPoint
    parity: int

    def at(self, x: Fraction) -> tuple[Fraction | None, Fraction | None]:
        """The lower and the upper end at one of its sides."""
        return (
            None if self.low is None else y_at(self.low, x),
            None if self.high is None else y_at(self.high, x),
        )

    def contains(self, p: RationalPoint) -> bool:
        if not self.left <= p[0] <= self.right:
            return False
        low, high = self.at(p[0])
        return (low is None or low <= p[1]) and (high is None or p[1] <= high)


class Cells:
    """The trapezoids of segments that block, and of lines that only cut.

    Attributes:
        trapezoids: all of them.
        face: for each the number of its face.
    """

    def __init__(self, blocking: Sequence[Line], cutting: Sequence[Line], points: Sequence[RationalPoint]) -> None:
        self.blocking = [(min(line), max(line)) for line in blocking]
        lines = list(dict.fromkeys([*self.blocking, *((min(line), max(line)) for line in cutting)]))
        xs = {p[0] for line in lines for p in line} | {p[0] for p in points}
        xs |= {p[0] for s, t in combinations(lines, 2) for p in meeting_points(s, t)}
        ordered = sorted(xs)
        ordered = [ordered[0] - 1, *ordered, ordered[-1] + 1]
        self.trapezoids = [t for left, right in pairwise(ordered) for t in self._slab(left, right, lines)]
        self.face = self._faces()

    def _slab(self, left: Fraction, right: Fraction, lines: Sequence[Line]) -> Iterator[Trapezoid]:
        x = (left + right) / 2
        heights: dict[Fraction, Line] = {}
        for line in lines:
            if line[0][0] < x < line[1][0]:
                heights.setdefault(y_at(line, x), line)
        ends = [None, *sorted(heights), None]
        for low, high in pairwise(ends):
            if low is None:
                y = Fraction(0) if high is None else high - 1
            else:
                y = low + 1 if high is None else (low + high) / 2
            below = sum(a[0] < x < b[0] and y_at((a, b), x) < y for a, b in self.blocking)
            yield Trapezoid(
                left,
                right,
                None if low is None else heights[low],
                None if high is None else heights[high],
                (x, y),
                below % 2,
            )

    def _blocked(self, p: RationalPoint) -> bool:
        return any(oracles.on_segment(p, a, b) for a, b in self.blocking)

    def _open(self, s: Trapezoid, t: Trapezoid) -> bool:
        """Whether one can walk from s to t across a common side: above s, or on its right."""
        if s.left == t.left:
            if s.high is None or s.high is not t.low:
                return False
            x = s.sample[0]
            return not self._blocked((x, y_at(s.high, x)))
        if s.right != t.left:
            return False
        (a, b), (c, d) = s.at(s.right), t.at(s.right)
        low = a if c is None else c if a is None else max(a, c)
        high = b if d is None else d if b is None else min(b, d)
        ends = [p[1] for line in self.blocking for p in line if p[0] == s.right]
        heights = [Fraction(0), *ends, *(y for y in (a, b, c, d) if y is not None)]
        bottom, top = min(heights) - 2, max(heights) + 2
        low, high = bottom if low is None else low, top if high is None else high
        if low >= high:
            return False
        cuts = sorted({low, high, *(y for y in ends if low < y < high)})
        return any(not self._blocked((s.right, (y + z) / 2)) for y, z in pairwise(cuts) if y < z)

    def _faces(self) -> list[int]:
        face = list(range(len(self.trapezoids)))
        for i, s in enumerate(self.trapezoids):
            for j, t in enumerate(self.trapezoids):
                if face[i] != face[j] and self._open(s, t):
                    face = [face[i] if f == face[j] else f for f in face]
        return face

    def domain(self, holes: Sequence[RationalPoint], even_odd: bool) -> list[bool]:
        """Whether each trapezoid belongs to the domain."""
        outside = {
            self.face[i] for h in holes if not self._blocked(h) for i, t in enumerate(self.trapezoids) if t.contains(h)
        }
        if even_odd:
            return [t.parity == 1 and f not in outside for t, f in zip(self.trapezoids, self.face, strict=True)]
        outside |= {f for t, f in zip(self.trapezoids, self.face, strict=True) if t.low is None or t.high is None}
        return [f not in outside for f in self.face]


def _first_hit(p: RationalPoint, q: RationalPoint, line: Line) -> Fraction | None:
    """The smallest r > 0 with p + r (q - p) on the line, None if there is none. No line is parallel to pq."""
    (a, b), (dx, dy) = line, (q[0] - p[0], q[1] - p[1])
    sa, sb = oracles.orient(p, q, a), oracles.orient(p, q, b)
    if sa * sb > 0:
        return None
    s = sa / (sa - sb)
    x, y = a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])
    r = (x - p[0]) / dx if dx else (y - p[1]) / dy
    return r if r > 0 else None


def _directions(p: RationalPoint, ends: Iterable[RationalPoint]) -> Iterator[RationalPoint]:
    """A direction inside every sector between rays from p through neighbouring ends."""
    seen = {(q[0] - p[0], q[1] - p[1]) for q in ends if q != p}
    seen |= {(-x, -y) for x, y in seen} | {(Fraction(x), Fraction(y)) for x, y in ((1, 0), (0, 1), (-1, 0), (0, -1))}
    zero = (Fraction(0), Fraction(0))

    def half(d: RationalPoint) -> int:
        return 0 if d[1] > 0 or (d[1] == 0 and d[0] > 0) else 1

    ordered: list[RationalPoint] = []
    for d in seen:  # insertion by angle
        i = 0
        while i < len(ordered) and (
            half(ordered[i]) < half(d) or (half(ordered[i]) == half(d) and oracles.orient(zero, ordered[i], d) > 0)
        ):
            i += 1
        ordered.insert(i, d)
    for d, e in zip(ordered, [*ordered[1:], ordered[0]], strict=True):
        if oracles.orient(zero, d, e) > 0:
            yield d[0] + e[0], d[1] + e[1]


def is_visible(p: RationalPoint, triangle: Sequence[RationalPoint], blockers: Sequence[Line]) -> bool:
    """Whether some x inside the counterclockwise triangle sees p: the open segment xp meets no blocker.

    The set of such x is open, so if there is one, there is one on a ray through no end of anything. Between such ends
    all rays are alike: one is tried of each sort.
    """
    a, b, c = triangle
    for d in _directions(p, [*triangle, *(end for line in blockers for end in line)]):
        q = p[0] + d[0], p[1] + d[1]
        entry, exit_ = Fraction(0), None
        for s, t in ((a, b), (b, c), (c, a)):  # orient(s, t, p + r d) is start + r * slope
            start = oracles.orient(s, t, p)
            slope = oracles.orient(s, t, q) - start
            if slope > 0:
                entry = max(entry, -start / slope)
            elif slope < 0:
                exit_ = -start / slope if exit_ is None else min(exit_, -start / slope)
            elif start <= 0:
                exit_ = Fraction(0)
        if exit_ is None or entry >= exit_:
            continue
        obstacles = [r for line in blockers if (r := _first_hit(p, q, line)) is not None]
        if not obstacles or min(obstacles) > entry:
            return True
    return False
