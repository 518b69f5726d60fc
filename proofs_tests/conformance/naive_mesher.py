"""A mesher that is slow and obviously right: a sweep, then flips, in integers. Its predicates can be exchanged."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import pairwise
from math import lcm

Point = tuple[int, int]
Triangle = tuple[int, int, int]
Orient = Callable[[Point, Point, Point], float]
InCircle = Callable[[Point, Point, Point, Point], float]


def on_integers(points: Sequence[Sequence[float]]) -> list[Point]:
    """Return the points times one common factor, which makes all coordinates integers."""
    exact = [(Fraction(float(x)), Fraction(float(y))) for x, y in points]
    scale = lcm(1, *(value.denominator for point in exact for value in point))
    return [(int(x * scale), int(y * scale)) for x, y in exact]


def orient(a: Point, b: Point, c: Point) -> int:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def in_circle(a: Point, b: Point, c: Point, d: Point) -> int:
    rows = [(p[0] - d[0], p[1] - d[1]) for p in (a, b, c)]
    (ax, ay), (bx, by), (cx, cy) = rows
    la, lb, lc = (x * x + y * y for x, y in rows)
    return la * (bx * cy - by * cx) - lb * (ax * cy - ay * cx) + lc * (ax * by - ay * bx)


def sweep(points: Sequence[Point], order: Sequence[int], side: Orient = orient) -> list[Triangle]:
    """Triangulate from left to right: each point is joined to the edges of the hull that it sees."""
    triangles: list[Triangle] = []
    chain, hull = list(order[:1]), list(order[:0])
    for v in order[1:]:
        if not hull:  # all points so far lie on one line
            turn = side(points[chain[0]], points[chain[-1]], points[v]) if len(chain) > 1 else 0
            if turn == 0:
                chain.append(v)
                continue
            hull = [*chain, v] if turn > 0 else [*reversed(chain), v]
            triangles += [(a, b, v) for a, b in pairwise(hull[:-1])]
            continue
        seen = [side(points[a], points[b], points[v]) < 0 for a, b in zip(hull, [*hull[1:], hull[0]], strict=True)]
        start = next((i for i in range(len(hull)) if seen[i] and not seen[i - 1]), None)
        if start is None:  # inexact predicates only
            continue
        hull, seen = hull[start:] + hull[:start], seen[start:] + seen[:start]
        count = seen.index(False) if False in seen else len(seen) - 1
        triangles += [(b, a, v) for a, b in pairwise(hull[: count + 1])]
        hull = [hull[0], v, *hull[count:]]
    return triangles


def flipped(
    points: Sequence[Point], triangles: Sequence[Triangle], inside: InCircle = in_circle, most: int = 10**6
) -> list[Triangle]:
    """Flip edges that are not locally Delaunay, until there are none, or ``most`` flips are done."""
    apex = {}
    for a, b, c in triangles:
        apex.update({(a, b): c, (b, c): a, (c, a): b})
    queue = list(apex)
    while queue and most:
        a, b = queue.pop()
        if (a, b) not in apex or (b, a) not in apex:
            continue
        c, d = apex[a, b], apex[b, a]
        if inside(points[a], points[b], points[c], points[d]) <= 0:
            continue
        del apex[a, b], apex[b, a]
        apex.update({(c, d): b, (d, b): c, (b, c): d, (d, c): a, (c, a): d, (a, d): c})
        queue += [(b, c), (c, a), (a, d), (d, b)]
        most -= 1
    return sorted({_from_least(a, b, c) for (a, b), c in apex.items()})


def _from_least(a: int, b: int, c: int) -> Triangle:
    return min((a, b, c), (b, c, a), (c, a, b))


def distinct(points: Sequence[Sequence[float]]) -> list[int]:
    """Return the first point at each position, from left to right."""
    first: dict[tuple[float, float], int] = {}
    for index, (x, y) in enumerate(points):
        first.setdefault((float(x), float(y)), index)
    return [first[place] for place in sorted(first)]


def mesh(points: Sequence[Sequence[float]], side: Orient = orient, inside: InCircle = in_circle) -> list[Triangle]:
    """Return a Delaunay triangulation of the points; coincident ones count once. O(n^2)."""
    places = on_integers(points)
    return flipped(places, sweep(places, distinct(points), side), inside, most=50 * len(points) ** 2)
