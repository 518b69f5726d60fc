"""Arrangements by brute force in fractions: all pairs, naive, obviously right; shares no code with the library."""

import math
from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations

from proofs_tests.oracles import RationalPoint, on_segment, orient, rationals

__all__ = [
    "CROSSING",
    "OVERLAP",
    "TOUCH",
    "distance_squared",
    "is_nearest",
    "is_planar",
    "meeting",
    "pixel",
    "proper_crossing",
    "segment_meets_pixel",
    "true_pairs",
]

CROSSING, TOUCH, OVERLAP = 0, 1, 2
Segment = tuple[RationalPoint, RationalPoint]


def proper_crossing(s: Segment, t: Segment) -> RationalPoint | None:
    """Return the point inside both segments in which they cross, if there is one."""
    (a, b), (c, d) = s, t
    u, v = (b[0] - a[0], b[1] - a[1]), (d[0] - c[0], d[1] - c[1])
    det = u[0] * v[1] - u[1] * v[0]
    if det == 0:
        return None
    p = ((c[0] - a[0]) * v[1] - (c[1] - a[1]) * v[0]) / det
    q = ((c[0] - a[0]) * u[1] - (c[1] - a[1]) * u[0]) / det
    return (a[0] + p * u[0], a[1] + p * u[1]) if 0 < p < 1 and 0 < q < 1 else None


def inside(p: RationalPoint, s: Segment) -> bool:
    return p not in s and on_segment(p, *s)


def meeting(s: Segment, t: Segment) -> int | None:
    """Return how two segments meet in a point that is not an end of both."""
    if proper_crossing(s, t) is not None:
        return CROSSING
    touching = {p for p in s if inside(p, t)} | {p for p in t if inside(p, s)}
    parallel = orient(s[0], s[1], t[0]) == 0 == orient(s[0], s[1], t[1])
    if parallel and (len(touching) == 2 or set(s) == set(t) or (len(touching) == 1 and set(s) & set(t))):
        return OVERLAP
    return TOUCH if touching else None


def true_pairs(points: Sequence[Sequence[float]], segments: Sequence[Sequence[int]]) -> list[tuple[int, int, int]]:
    """Return (i, j, kind) for all pairs i < j that meet."""
    exact = rationals(points)
    ends = [(exact[a], exact[b]) for a, b in segments]
    found = []
    for i, j in combinations(range(len(ends)), 2):
        kind = meeting(ends[i], ends[j])
        if kind is not None:
            found.append((i, j, kind))
    return found


def is_planar(points: Sequence[Sequence[float]], segments: Sequence[Sequence[int]]) -> bool:
    """Tell whether segments meet in common ends only, and no point at all lies inside one."""
    exact = rationals(points)
    ends = [(exact[a], exact[b]) for a, b in segments]
    if any(s[0] == s[1] for s in ends) or any(inside(p, s) for p in exact for s in ends):
        return False
    return all(meeting(s, t) is None for s, t in combinations(ends, 2))


def distance_squared(p: RationalPoint, s: Segment) -> Fraction:
    """Return the squared distance between a point and a segment: to the nearest of both ends and the foot."""
    (a, b) = s
    ux, uy = b[0] - a[0], b[1] - a[1]
    t = ((p[0] - a[0]) * ux + (p[1] - a[1]) * uy) / (ux * ux + uy * uy)
    feet = [a, b] + ([(a[0] + t * ux, a[1] + t * uy)] if 0 <= t <= 1 else [])
    return min((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2 for q in feet)


def is_nearest(x: float, exact: Fraction) -> bool:
    """Tell whether x is the double nearest to the number, the even one of two."""
    error = abs(Fraction(x) - exact)
    rivals = [math.nextafter(x, math.inf), math.nextafter(x, -math.inf)]
    even = int(Fraction(x) / Fraction(math.ulp(x))) % 2 == 0
    errors = [abs(Fraction(r) - exact) for r in rivals if math.isfinite(r)]
    return all(error < other or (error == other and even) for other in errors)


def pixel(p: RationalPoint, grid: tuple[float, float]) -> tuple[int, int]:
    """Return the cell (i, j) with p in [i - 1/2, i + 1/2) x [j - 1/2, j + 1/2), in units of the grid."""
    x, y = (math.floor(v / Fraction(g) + Fraction(1, 2)) for v, g in zip(p, grid, strict=True))
    return x, y


def segment_meets_pixel(s: Segment, cell: tuple[int, int], grid: tuple[float, float]) -> bool:
    """Clip the segment by the four half planes of the half-open square, and tell whether anything is left."""
    low, high = Fraction(0), Fraction(1)
    open_low = open_high = False
    for axis in range(2):
        g = Fraction(grid[axis])
        a, u = s[0][axis], s[1][axis] - s[0][axis]
        left, right = (cell[axis] - Fraction(1, 2)) * g, (cell[axis] + Fraction(1, 2)) * g
        if u == 0:
            if not left <= a < right:
                return False
            continue
        enter, leave = sorted(((left - a) / u, (right - a) / u))
        leaves_right = u > 0  # the right side does not belong to the pixel
        if enter > low or (enter == low and not leaves_right):
            low, open_low = enter, not leaves_right
        if leave < high or (leave == high and leaves_right):
            high, open_high = leave, leaves_right
    return low < high or (low == high and not open_low and not open_high)
