"""Voronoi cells, Sibson's coordinates and nearest doubles by brute force in fractions."""

import math
from collections.abc import Sequence
from fractions import Fraction

from gmpy2 import mpq
from proofs_tests.oracles import RationalPoint, orient, squared_distance

__all__ = ["area", "cell_of", "corners_of", "fractions_of", "nearest_double", "plane", "sibson"]

Polygon = list[RationalPoint]


def fractions_of(point: tuple[mpq, mpq]) -> RationalPoint:
    x, y = point
    return Fraction(int(x.numerator), int(x.denominator)), Fraction(int(y.numerator), int(y.denominator))


def nearest_double(x: Fraction) -> float:
    """Python's division of integers rounds to nearest, ties to even."""
    try:
        return x.numerator / x.denominator
    except OverflowError:
        return math.inf if x > 0 else -math.inf


def plane(exponent: int = 9000) -> Polygon:
    """A square so large that no circumcentre of doubles lies outside."""
    b = Fraction(2) ** exponent
    return [(-b, -b), (b, -b), (b, b), (-b, b)]


def nearer_half(polygon: Polygon, p: RationalPoint, q: RationalPoint) -> Polygon:
    """The part of a convex polygon that is at least as near to p as to q."""
    excess = [squared_distance(x, q) - squared_distance(x, p) for x in polygon]
    kept: Polygon = []
    for i, a in enumerate(polygon):
        j = (i + 1) % len(polygon)
        if excess[i] >= 0:
            kept.append(a)
        if excess[i] * excess[j] < 0:
            t = excess[i] / (excess[i] - excess[j])
            kept.append((a[0] + t * (polygon[j][0] - a[0]), a[1] + t * (polygon[j][1] - a[1])))
    return kept


def area(polygon: Sequence[RationalPoint]) -> Fraction:
    sides = zip(polygon, [*polygon[1:], *polygon[:1]], strict=True)
    return sum((a[0] * b[1] - a[1] * b[0] for a, b in sides), Fraction(0)) / 2


def corners_of(polygon: Sequence[RationalPoint]) -> Polygon:
    """The polygon without repetitions and without corners on straight sides, from its smallest corner on."""
    distinct = [p for i, p in enumerate(polygon) if p != polygon[i - 1]]
    sharp = [p for i, p in enumerate(distinct) if orient(distinct[i - 1], p, distinct[(i + 1) % len(distinct)]) != 0]
    if not sharp:
        return []
    first = sharp.index(min(sharp))
    return sharp[first:] + sharp[:first]


def cell_of(points: Sequence[RationalPoint], i: int, window: Polygon) -> Polygon:
    """The corners of what of a convex window is at least as near to point i as to any other; [] if it has no area."""
    cell = window
    for p in points:
        if p != points[i] and cell:
            cell = nearer_half(cell, points[i], p)
    return corners_of(cell) if cell and area(cell) > 0 else []


def sibson(points: Sequence[RationalPoint], q: RationalPoint) -> dict[int, Fraction]:
    """Which part of the cell of q lies in the cell of each (distinct) point; q lies inside their hull."""
    own = cell_of([*points, q], len(points), plane())
    parts = {i: cell_of(points, i, own) for i in range(len(points))}
    return {i: area(part) / area(own) for i, part in parts.items() if part}
