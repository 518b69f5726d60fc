"""The checker of the theorems, a few lines long: linear conditions, each with a name, in fractions.

It shares no code with the verifier. That the conditions suffice is held against brute force; that none can be left out
is shown by a mesh that only this one refuses.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from itertools import combinations

from proofs_tests import oracles
from proofs_tests.oracles import RationalPoint, Triangle

__all__ = [
    "CONVEX_CONDITIONS",
    "DOMAIN_CONDITIONS",
    "HULL_CONDITIONS",
    "boundary_of",
    "broken_by_cycle",
    "broken_of_domain",
    "broken_of_hull",
]

Pair = tuple[int, int]
Points = Sequence[RationalPoint]

#: Theorem C: a polygon is simple, weakly convex and counterclockwise.
CONVEX_CONDITIONS = ("turns left", "goes straight on", "winds once")
#: Theorems A to D: triangles are a Delaunay triangulation of all points.
HULL_CONDITIONS = ("positive", "edges once", "one cycle", "turns left", "winds once", "all used", "locally Delaunay")
#: Theorems A, B, E, F: triangles are a constrained Delaunay triangulation of a domain, bounded by directed edges.
DOMAIN_CONDITIONS = (
    "positive",
    "edges once",
    "boundary is the domain's",
    "boundary is simple",
    "positions differ",
    "winds round",
    "no point within",
    "segments are edges",
    "locally Delaunay",
)


def directed_edges(triangles: Iterable[Triangle]) -> list[Pair]:
    return [edge for a, b, c in triangles for edge in ((a, b), (b, c), (c, a))]


def boundary_of(triangles: Iterable[Triangle]) -> list[Pair]:
    edges = directed_edges(triangles)
    return [(a, b) for a, b in dict.fromkeys(edges) if (b, a) not in edges]


def cycles_of(edges: Sequence[Pair]) -> list[list[int]]:
    """The closed walks that the edges form; where there is a choice, the first that is left."""
    left, found = list(edges), []
    while left:
        walk = [left.pop(0)]
        while walk[-1][1] != walk[0][0] and (ahead := [edge for edge in left if edge[0] == walk[-1][1]]):
            left.remove(ahead[0])
            walk.append(ahead[0])
        found.append([a for a, _ in walk])
    return found


def broken_by_cycle(points: Points, cycle: Sequence[int]) -> set[str]:
    """Theorem C."""
    broken, n = set(), len(cycle)
    corners = [tuple(points[cycle[(i + k) % n]] for k in range(3)) for i in range(n)]
    for a, b, c in corners:
        turn = oracles.orient(a, b, c)
        ahead = (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1])
        broken |= {"turns left"} if turn < 0 else set()
        broken |= {"goes straight on"} if turn == 0 and ahead < 0 else set()
    if sum((a < b) is not (b < c) for a, b, c in corners) != 2:
        broken.add("winds once")
    return broken


def is_locally_delaunay(points: Points, triangles: Sequence[Triangle], exempt: Callable[[int, int], bool]) -> bool:
    opposite = {(a, b): c for t in triangles for a, b, c in (t, (t[1], t[2], t[0]), (t[2], t[0], t[1]))}
    for (a, b), c in opposite.items():
        d = opposite.get((b, a))
        if d is not None and not exempt(a, b) and oracles.orient(points[a], points[b], points[c]) != 0:
            centre, radius = oracles.circumcircle(points[a], points[b], points[c])
            if oracles.squared_distance(centre, points[d]) < radius:
                return False
    return True


def broken_of_hull(points: Points, triangles: Sequence[Triangle]) -> set[str]:
    """The conditions of theorems A to D that do not hold: of none of them, the triangles are what they should be."""
    broken = set()
    if not all(oracles.orient(*(points[v] for v in t)) > 0 for t in triangles):
        broken.add("positive")
    if any(count > 1 for count in Counter(directed_edges(triangles)).values()):
        broken.add("edges once")
    cycles = cycles_of(boundary_of(triangles))
    if len(cycles) != 1 or len(set(cycles[0])) < len(cycles[0]):
        broken.add("one cycle")
    for cycle in cycles:
        broken |= broken_by_cycle(points, cycle) - {"goes straight on"}  # it would wind round no area
    if {v for t in triangles for v in t} != set(range(len(points))):
        broken.add("all used")
    if not is_locally_delaunay(points, triangles, lambda *_: False):
        broken.add("locally Delaunay")
    return broken


def broken_of_domain(
    points: Points, triangles: Sequence[Triangle], domain: Sequence[Pair], segments: Sequence[Pair] = ()
) -> set[str]:
    """The conditions of theorems A, B, E and F that do not hold, for a domain on the left of directed edges."""
    broken = set()
    if not all(oracles.orient(*(points[v] for v in t)) > 0 for t in triangles):
        broken.add("positive")
    if any(count > 1 for count in Counter(directed_edges(triangles)).values()):
        broken.add("edges once")
    if set(boundary_of(triangles)) != set(domain):
        broken.add("boundary is the domain's")
    lines = [(points[a], points[b]) for a, b in domain]
    for (e, s), (f, t) in combinations(zip(domain, lines, strict=True), 2):
        common = {points[v] for v in set(e) & set(f)}
        if meet_elsewhere(s, t, common | (set(s) & set(t))):
            broken.add("boundary is simple")
    rim = {v for edge in domain for v in edge}
    if len({points[v] for v in rim}) != len(rim):
        broken.add("positions differ")
    if any(winding(points, domain, edge) != (1, 0) for edge in domain):
        broken.add("winds round")
    used = {v for t in triangles for v in t}
    if any(covers(points, t, points[v]) for v in set(range(len(points))) - used for t in triangles):
        broken.add("no point within")
    edges = {frozenset(edge) for edge in directed_edges(triangles)}
    if not all(frozenset(segment) in edges for segment in segments):
        broken.add("segments are edges")
    fixed = {frozenset(segment) for segment in segments}
    if not is_locally_delaunay(points, triangles, lambda a, b: frozenset((a, b)) in fixed):
        broken.add("locally Delaunay")
    return broken


def meet_elsewhere(
    s: tuple[RationalPoint, RationalPoint], t: tuple[RationalPoint, RationalPoint], common: set[RationalPoint]
) -> bool:
    """Whether two segments meet but in these points."""
    (a, b), (c, d) = s, t
    if any(oracles.on_segment(p, *line) and p not in common for line, ends in ((s, t), (t, s)) for p in ends):
        return True
    return (
        oracles.orient(a, b, c) * oracles.orient(a, b, d) < 0 and oracles.orient(c, d, a) * oracles.orient(c, d, b) < 0
    )


def covers(points: Points, t: Triangle, p: RationalPoint) -> bool:
    a, b, c = (points[v] for v in t)
    signs = [oracles.orient(a, b, p), oracles.orient(b, c, p), oracles.orient(c, a, p)]
    return min(signs) >= 0 or max(signs) <= 0


def winding(points: Points, domain: Sequence[Pair], edge: Pair) -> tuple[int, int]:
    """The winding numbers of the domain's boundary on the left and on the right of one of its edges.

    Beside its middle, so near that nothing else is in between: a ray to the right is counted there and here.
    """
    a, b = (points[v] for v in edge)
    middle = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
    left, right = (b[1] - a[1]) * -1, b[0] - a[0]  # the normal to the left
    step = Fraction(1)
    lines = [(points[c], points[d]) for c, d in domain]
    for p, q in (line for line in lines if not oracles.on_segment(middle, *line)):
        while any(
            meet_elsewhere((middle, (middle[0] + s * step * left, middle[1] + s * step * right)), (p, q), set())
            for s in (1, -1)
        ):
            step /= 2
    sides = [(middle[0] + s * step * left, middle[1] + s * step * right) for s in (1, -1)]
    return around(points, domain, sides[0]), around(points, domain, sides[1])


def around(points: Points, domain: Iterable[Pair], p: RationalPoint) -> int:
    """How often directed edges wind round a point that is on none: crossings of the ray to the right."""
    total = 0
    for c, d in domain:
        (_, low), (_, high) = points[c], points[d]
        side = oracles.orient(points[c], points[d], p)
        total += (low <= p[1] < high and side > 0) - (high <= p[1] < low and side < 0)
    return total
