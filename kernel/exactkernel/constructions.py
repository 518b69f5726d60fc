"""Constructions: exact in rationals, then rounded to doubles with the error stated."""

from dataclasses import dataclass

from gmpy2 import mpq

from exactkernel.coordinates import rational_value, rationals_of
from exactkernel.errors import DegenerateError, shown
from exactkernel.rational import RationalPoint
from exactkernel.types import Coordinate, PointLike

__all__ = ["RoundedPoint", "circumcentre", "point_on_segment", "rounded", "segment_crossing"]


@dataclass(frozen=True, slots=True)
class RoundedPoint:
    """The doubles nearest to an exact point, and how far they are from it.

    Attributes:
        x, y: each the double nearest to the exact coordinate, ties to even.
        error: the exact pair (x - exact x, y - exact y); each at most half a unit in the last place.
    """

    x: float
    y: float
    error: RationalPoint

    @property
    def distance_squared(self) -> mpq:
        """The exact square of the distance between the rounded and the exact point."""
        return self.error[0] * self.error[0] + self.error[1] * self.error[1]


def circumcentre(a: PointLike, b: PointLike, c: PointLike) -> RationalPoint:
    """Return the exact centre of the circle through three points.

    Raises:
        DegenerateError: the points lie on one line.
        NonFiniteError, CoordinateError, ShapeError: as for orient2d.

    >>> from exactkernel import circumcentre
    >>> circumcentre((0, 0), (1, 0), (0, 3))
    (mpq(1,2), mpq(3,2))
    """
    (ax, ay), (bx, by), (cx, cy) = rationals_of(a, b, c)
    ux, uy, vx, vy = bx - ax, by - ay, cx - ax, cy - ay
    twice_area = ux * vy - uy * vx
    if twice_area == 0:
        raise DegenerateError(f"the points {shown(a)}, {shown(b)}, {shown(c)} lie on one line and have no circumcentre")
    u, v = ux * ux + uy * uy, vx * vx + vy * vy
    return ax + (vy * u - uy * v) / (2 * twice_area), ay + (ux * v - vx * u) / (2 * twice_area)


def segment_crossing(a: PointLike, b: PointLike, c: PointLike, d: PointLike) -> RationalPoint:
    """Return the exact point in which the closed segments ab and cd meet.

    Raises:
        DegenerateError: they are parallel (so they meet nowhere, or in more than a point), or they do not
        meet. NonFiniteError, CoordinateError, ShapeError: as for orient2d.

    >>> from exactkernel import segment_crossing
    >>> segment_crossing((0, 0), (1, 1), (0, 1), (2, 0))
    (mpq(2,3), mpq(2,3))
    """
    (ax, ay), (bx, by), (cx, cy), (dx, dy) = rationals_of(a, b, c, d)
    ux, uy, vx, vy = bx - ax, by - ay, dx - cx, dy - cy
    cross = ux * vy - uy * vx
    if cross == 0:
        raise DegenerateError(f"the segments {shown(a)}-{shown(b)} and {shown(c)}-{shown(d)} are parallel")
    s = ((cx - ax) * vy - (cy - ay) * vx) / cross
    t = ((cx - ax) * uy - (cy - ay) * ux) / cross
    if not (0 <= s <= 1 and 0 <= t <= 1):
        raise DegenerateError(f"the segments {shown(a)}-{shown(b)} and {shown(c)}-{shown(d)} do not meet")
    return ax + s * ux, ay + s * uy


def point_on_segment(a: PointLike, b: PointLike, t: Coordinate) -> RationalPoint:
    """Return the exact point a + t (b - a), for any exact number or finite double t.

    Raises:
        NonFiniteError, CoordinateError, ShapeError: as for orient2d, and for t.

    >>> from gmpy2 import mpq
    >>> from exactkernel import point_on_segment
    >>> point_on_segment((0, 0), (3, 1), mpq(1, 3))
    (mpq(1,1), mpq(1,3))
    """
    (ax, ay), (bx, by) = rationals_of(a, b)
    s = rational_value(t)
    return ax + s * (bx - ax), ay + s * (by - ay)


def _nearest(value: mpq) -> float:
    """Return the nearest double; Python's integer division rounds correctly, subnormals included."""
    try:
        return int(value.numerator) / int(value.denominator)
    except OverflowError:
        raise DegenerateError(f"the coordinate {shown(value)} is beyond the doubles") from None


def rounded(point: RationalPoint) -> RoundedPoint:
    """Return the exact point rounded to the nearest doubles, with the exact error.

    Raises:
        DegenerateError: a coordinate is beyond the largest double.

    >>> from exactkernel import circumcentre, rounded
    >>> centre = rounded(circumcentre((0, 0), (1, 0), (0, 3)))
    >>> centre.x, centre.y, centre.distance_squared
    (0.5, 1.5, mpq(0,1))
    """
    x, y = _nearest(point[0]), _nearest(point[1])
    return RoundedPoint(x, y, (mpq(x) - point[0], mpq(y) - point[1]))
