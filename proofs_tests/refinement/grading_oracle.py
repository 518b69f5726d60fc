"""Insertion radii and the local feature size, from their definitions, in squared fractions."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations
from typing import NamedTuple

from proofs_tests import oracles
from proofs_tests.oracles import RationalPoint

__all__ = [
    "SLACK",
    "SQRT2",
    "Account",
    "grading_constant",
    "grading_faults",
    "local_feature_size_squared",
    "radius_faults",
]

Segment = tuple[int, int]
#: Just above the square root of 2.
SQRT2 = Fraction(141421357, 10**8)
#: A recorded radius is a double: differences, squares, their sum and the root lose less than 2^-50 of its square.
SLACK = Fraction(1, 2**50)
ENCROACHED, YIELDED, INTERIOR = 1, 2, 3


class Account(NamedTuple):
    """What a refinement tells: all points, those of the input first, and of each later one kind, parent and radius."""

    points: list[RationalPoint]
    segments: list[Segment]
    kinds: list[int]
    parents: list[int]
    radii: list[float]

    @property
    def given(self) -> int:
        """How many points are of the input."""
        return len(self.points) - len(self.kinds)


def squared_distance_to_segment(x: RationalPoint, a: RationalPoint, b: RationalPoint) -> Fraction:
    """To its nearest point, an end or the foot of the perpendicular."""
    length = oracles.squared_distance(a, b)
    along = (x[0] - a[0]) * (b[0] - a[0]) + (x[1] - a[1]) * (b[1] - a[1])
    if along <= 0:
        return oracles.squared_distance(x, a)
    return oracles.squared_distance(x, b) if along >= length else oracles.orient(a, b, x) ** 2 / length


def local_feature_size_squared(
    x: RationalPoint, points: Sequence[RationalPoint], segments: Sequence[Segment]
) -> Fraction:
    """The radius of the smallest disk about x that meets two features of the graph that do not touch."""
    features: list[tuple[Fraction, frozenset[int]]] = [
        (oracles.squared_distance(x, p), frozenset({v})) for v, p in enumerate(points)
    ]
    features += [(squared_distance_to_segment(x, points[a], points[b]), frozenset({a, b})) for a, b in segments]
    return min(max(d, e) for (d, f), (e, g) in combinations(features, 2) if not f & g)


def grading_constant(b: Fraction, c: Fraction = 1 / SQRT2) -> Fraction:
    """D = (1 + c) B / (c B - 1), rounded up: Ruppert's (1 + sqrt 2) B / (B - sqrt 2) if c = 1 / sqrt 2; at least 4 B.

    A point inside has D_F = 1 + D_S / B, one on a segment D_S = 1 + D_F / c, or 4 B where another feature is in the
    diametral circle; the larger is D_S.
    """
    return max((1 + c) * b / (c * b - 1), 4 * b)


def grading_faults(account: Account, edges: Sequence[Segment], d: Fraction) -> list[Segment]:
    """The edges shorter than the local feature size at one of their ends, divided by d + 1."""
    given = account.points[: account.given]
    size = [local_feature_size_squared(p, given, account.segments) for p in account.points]
    least = (d + 1) ** 2
    return [
        (u, v)
        for u, v in edges
        if oracles.squared_distance(account.points[u], account.points[v]) * least < max(size[u], size[v])
    ]


def lines_of(account: Account, v: int) -> set[int]:
    """The segments that pass through a vertex."""
    p = account.points
    return {s for s, (a, b) in enumerate(account.segments) if oracles.on_segment(p[v], p[a], p[b])}


def sees(account: Account, u: int, v: int) -> bool:
    """Whether no segment lies between the two vertices."""
    p, q = account.points[u], account.points[v]
    for s, t in account.segments:
        a, b = account.points[s], account.points[t]
        if (
            oracles.orient(p, q, a) * oracles.orient(p, q, b) < 0
            and oracles.orient(a, b, p) * oracles.orient(a, b, q) < 0
        ):
            return False
    return True


def nearest_seen(account: Account, v: int, among: int) -> Fraction:
    """The squared distance of the nearest of the first vertices that v sees."""
    distances = [(oracles.squared_distance(account.points[u], account.points[v]), u) for u in range(among) if u != v]
    distances.sort()
    return next(d for d, u in distances if sees(account, u, v))


def squared_radii(account: Account) -> tuple[list[Fraction], list[Fraction]]:
    """Bounds of the squared insertion radii, from below and from above.

    Of the input: the nearest vertex of it that one sees. Of a Steiner point: what was recorded, rounding accounted for,
    for vertices that were near it then may have been removed since.
    """
    exact = [nearest_seen(account, v, account.given) for v in range(account.given)]
    recorded = [Fraction(r) ** 2 for r in account.radii]
    return [*exact, *(r * (1 - SLACK) for r in recorded)], [*exact, *(r * (1 + SLACK) for r in recorded)]


def radius_faults(account: Account, b: Fraction, c: Fraction) -> list[str]:
    """The Steiner points whose insertion radius is less than their kind and their parent allow; see the test's law."""
    low, high = squared_radii(account)
    faults = []
    for i, (kind, parent) in enumerate(zip(account.kinds, account.parents, strict=True)):
        v = account.given + i
        distance = nearest_seen(account, v, v)
        if low[v] > distance:
            faults.append(f"{v}: a vertex is nearer than its radius")
        if parent < 0:  # it was removed since, and its radius with it: left is what follows from all radii: lfs <= D r
            size = local_feature_size_squared(account.points[v], account.points[: account.given], account.segments)
            if high[v] * grading_constant(b, c) ** 2 < size:
                faults.append(f"{v}: nearer than lfs / D")
            continue
        if kind == INTERIOR and high[v] < b * b * low[parent]:
            faults.append(f"{v}: inside, nearer than B times the radius of {parent}")
        own = lines_of(account, v)
        if kind != INTERIOR and has_foreign_in_circle(account, v, own):
            size = local_feature_size_squared(account.points[v], account.points[: account.given], account.segments)
            if high[v] * (4 * b) ** 2 < size:
                faults.append(f"{v}: with another feature in the circle, nearer than lfs / 4 B")
        elif kind == YIELDED and high[v] < c * c * b * b * low[parent]:
            faults.append(f"{v}: for a rejected point, nearer than c B times the radius of {parent}")
        elif kind == ENCROACHED:
            joint = joint_of(account, own, lines_of(account, parent))
            if joint is None or not is_far_enough(account, v, parent, joint, high, low):
                faults.append(f"{v}: beside a corner, nearer than the radius of {parent}")
    return faults


def has_foreign_in_circle(account: Account, v: int, own: set[int]) -> bool:
    """Whether a vertex of the input, or of a segment elsewhere, is in the closed diametral circle of the edge that v
    divided: the nearest of the vertices before v on its segment, on either side. Elsewhere: with no end in common."""
    points = account.points
    ends = {end for s in own for end in account.segments[s]}
    for s in own:
        a, b = (points[end] for end in account.segments[s])
        on_it = sorted([points[u] for u in range(v) if oracles.on_segment(points[u], a, b)] + [points[v]])
        at = on_it.index(points[v])
        p, q = on_it[at - 1], on_it[at + 1]
        for u in range(v):
            x = points[u]
            across = (p[0] - x[0]) * (q[0] - x[0]) + (p[1] - x[1]) * (q[1] - x[1])
            lines = lines_of(account, u)
            touching = any(set(account.segments[t]) & ends for t in lines) or u in ends
            if across <= 0 and not touching and (lines or u < account.given):
                return True
    return False


def joint_of(account: Account, own: set[int], other: set[int]) -> tuple[int, int, int] | None:
    """The common end of two segments, with their other ends, if one of either set has one."""
    for s in own:
        for t in other - own:
            common = set(account.segments[s]) & set(account.segments[t])
            if len(common) == 1:
                (joint,) = common
                return joint, sum(account.segments[s]) - joint, sum(account.segments[t]) - joint
    return None


def is_far_enough(
    account: Account, v: int, parent: int, joint: tuple[int, int, int], high: list[Fraction], low: list[Fraction]
) -> bool:
    """r >= r_p, and r >= r_p / (3 cos a): 9 cos^2 a r^2 >= r_p^2 for a below 90 degrees."""
    o, p, q = (account.points[u] for u in joint)
    dot = (p[0] - o[0]) * (q[0] - o[0]) + (p[1] - o[1]) * (q[1] - o[1])
    if dot <= 0:
        return True
    cosine = dot * dot / (oracles.squared_distance(o, p) * oracles.squared_distance(o, q))
    return high[v] >= low[parent] and 9 * cosine * high[v] >= low[parent]
