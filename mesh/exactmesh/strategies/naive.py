"""Triangulating in exact numbers, naively: what algorithms are held against shares no code with them."""

from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple, TypeAlias

from exactkernel.types import FloatArray

__all__ = [
    "Place",
    "Quad",
    "Triple",
    "exact_places",
    "flipped",
    "incircle",
    "inner_quads",
    "is_convex",
    "legalized",
    "opposites",
    "orient",
    "swept",
]

Number: TypeAlias = int | Fraction
Place: TypeAlias = tuple[Number, Number]
Triple: TypeAlias = tuple[int, int, int]


class Quad(NamedTuple):
    """Two triangles with a common edge: (a, b, c), and (b, a, d) on its other side."""

    a: int
    b: int
    c: int
    d: int


def exact_places(points: FloatArray) -> list[Place]:
    """Return the points as fractions."""
    return [(Fraction(x), Fraction(y)) for x, y in points.tolist()]


def orient(a: Place, b: Place, c: Place) -> Number:
    """Return twice the signed area, positive if counterclockwise."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def incircle(a: Place, b: Place, c: Place, d: Place) -> Number:
    """Return a positive number if d is strictly inside the circle of the counterclockwise triangle, 0 if on it."""
    rows = [(x - d[0], y - d[1]) for x, y in (a, b, c)]
    total: Number = 0
    for (x, y), (px, py), (qx, qy) in zip(rows, rows[1:] + rows[:1], rows[2:] + rows[:2], strict=True):
        total += (x * x + y * y) * (px * qy - py * qx)
    return total


def swept(places: list[Place]) -> list[Triple]:
    r"""Triangulate distinct points from left to right; return nothing if all are on a line. Quadratic time.

    A hull edge ab is visible from the next point p if p is strictly on its right; (b, a, p) is a triangle then, and p
    takes the place of what is between the ends of the visible chain.

                 b---.
                /|    \
               p |     .
                \|    /
                 a---'
    """
    order = sorted(range(len(places)), key=places.__getitem__)
    run = 2  # as many points as are on one line, in the beginning
    while run < len(order) and orient(places[order[0]], places[order[1]], places[order[run]]) == 0:
        run += 1
    if run >= len(order):
        return []
    apex, hull = order[run], order[:run]
    if orient(places[hull[0]], places[hull[1]], places[apex]) < 0:
        hull.reverse()
    triangles = [(a, b, apex) for a, b in pairwise(hull)]
    hull.append(apex)
    for p in order[run + 1 :]:
        sides = [orient(places[a], places[b], places[p]) for a, b in zip(hull, hull[1:] + hull[:1], strict=True)]
        first = next(i for i, side in enumerate(sides) if side < 0 <= sides[i - 1])
        chain = [*hull[first:], *hull[:first], hull[first]][: 1 + sum(side < 0 for side in sides)]
        triangles += [(b, a, p) for a, b in pairwise(chain)]
        rest = [v for v in [*hull[first:], *hull[:first]] if v not in chain]
        hull = [chain[0], p, chain[-1], *rest]
    return triangles


def opposites(triangles: list[Triple]) -> dict[tuple[int, int], int]:
    """Return the corner opposite to each directed edge, in the triangle on its left."""
    return {edge: v for a, b, c in triangles for edge, v in (((a, b), c), ((b, c), a), ((c, a), b))}


def inner_quads(triangles: list[Triple]) -> list[Quad]:
    """Return the pairs of triangles with a common edge, in the order of these edges."""
    opposite = opposites(triangles)
    return [Quad(a, b, c, opposite[b, a]) for (a, b), c in sorted(opposite.items()) if a < b and (b, a) in opposite]


def is_convex(places: list[Place], quad: Quad) -> bool:
    """Tell whether the edge can be flipped: the quadrilateral adbc is strictly convex."""
    a, b, c, d = (places[v] for v in quad)
    return orient(c, a, d) > 0 and orient(d, b, c) > 0


def flipped(triangles: list[Triple], quad: Quad) -> list[Triple]:
    """Return the triangles with the edge cd instead of ab, in the same rows."""
    a, b, c, d = quad
    new: dict[frozenset[int], Triple] = {frozenset((a, b, c)): (c, a, d), frozenset((a, b, d)): (d, b, c)}
    return [new.get(frozenset(t), t) for t in triangles]


def legalized(places: list[Place], triangles: list[Triple]) -> list[Triple]:
    """Flip edges until the triangles are Delaunay; each flip lowers a paraboloid, so it ends. Lawson's algorithm."""
    while True:
        wrong = (q for q in inner_quads(triangles) if incircle(*(places[v] for v in q)) > 0)
        quad = next(wrong, None)
        if quad is None:
            return triangles
        triangles = flipped(triangles, quad)
