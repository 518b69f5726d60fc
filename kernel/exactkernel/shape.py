"""shape: angles, area and edges of a triangle against a bound, exactly."""

import math
from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from gmpy2 import mpq

from exactkernel.angle import AngleBound, angle_above_adaptive, angle_below_adaptive, angle_bound
from exactkernel.context import thread_context
from exactkernel.coordinates import doubles_of, rational_value, rationals_of
from exactkernel.errors import BoundError, DegenerateError, ShapeError, shown
from exactkernel.measure import area_above_adaptive, length_above_adaptive
from exactkernel.orient2d import orient2d
from exactkernel.rational import ANGLE, AREA, LENGTH, raise_if_interrupted, shape_rational
from exactkernel.types import Coordinate, FloatArray, PointLike

__all__ = [
    "AngleBound",
    "angle_above",
    "angle_above_adaptive",
    "angle_below",
    "angle_below_adaptive",
    "angle_bound",
    "area_above",
    "area_above_adaptive",
    "length_above",
    "length_above_adaptive",
]

#: Three points, or two: any sequence of pairs, or an array (3, 2) or (2, 2).
PointsLike: TypeAlias = "Sequence[PointLike] | FloatArray"


def _points(points: PointsLike, n: int) -> list[PointLike]:
    try:
        listed: list[PointLike] = list(points)
    except TypeError:
        listed = []
    if len(listed) != n:
        raise ShapeError(f"{'a triangle has three corners' if n == 3 else 'an edge has two ends'}, not {shown(points)}")
    return listed


def _corners(triangle: PointsLike) -> list[PointLike]:
    """Return the corners counterclockwise."""
    a, b, c = _points(triangle, 3)
    turn = orient2d(a, b, c)
    if turn == 0:
        raise DegenerateError(f"the corners {shown(a)}, {shown(b)} and {shown(c)} lie on one line")
    return [a, b, c] if turn > 0 else [a, c, b]


def _degrees(degrees: Coordinate) -> mpq:
    exact = rational_value(degrees)
    if not 0 <= exact <= 180:
        raise BoundError(f"an angle is between 0 and 180 degrees, not {shown(degrees)}")
    return exact


def _bound(bound: Coordinate, what: str) -> mpq | None:
    """Return the bound in rationals, or None if it is infinite."""
    if isinstance(bound, (float, np.floating)):
        if bound == math.inf:
            return None
        if math.isnan(bound):
            raise BoundError(f"a bound on {what} is a number, not {shown(bound)}")
    exact = rational_value(bound) if bound != -math.inf else mpq(-1)
    if exact < 0:
        raise BoundError(f"a bound on {what} is not negative: {shown(bound)}")
    return exact


def _double(value: mpq) -> float | None:
    """Return the number as a double, or None if it is not exactly one."""
    try:
        nearest = int(value.numerator) / int(value.denominator)
    except OverflowError:
        return None
    return nearest if mpq(nearest) == value else None


def _angle_signs(corners: list[PointLike], degrees: mpq) -> set[int]:
    """Return the signs of the bound minus each angle, in rationals."""
    a, b, c = rationals_of(*corners)
    return {shape_rational(ANGLE, degrees, *turned) for turned in ((a, b, c), (b, c, a), (c, a, b))}


def angle_below(triangle: PointsLike, degrees: Coordinate) -> bool:
    """Tell whether the smallest angle of a triangle is smaller than a bound, exactly; False where it is equal.

    Args:
        triangle: three points in any order, as orient2d takes them; nothing is rounded.
        degrees: the bound, from 0 to 180, exactly the number that it is.

    Raises:
        BoundError: the bound is outside 0 to 180.
        DegenerateError: the corners lie on one line.
        NonFiniteError, CoordinateError, ShapeError: as for orient2d, and for the bound.

    Constant time for doubles. Reference [Niven 1956].

    >>> from exactkernel import angle_below
    >>> angle_below([(0, 0), (1, 0), (0, 1)], 45), angle_below([(0, 0), (1, 0), (0, 1)], 45.00000000000001)
    (False, True)
    """
    exact, corners = _degrees(degrees), _corners(triangle)
    bound, doubles = _double(exact), doubles_of(*corners)
    if bound is None or doubles is None:
        return 1 in _angle_signs(corners, exact)
    below = bool(angle_below_adaptive(thread_context(), angle_bound(bound), *doubles))
    raise_if_interrupted()
    return below


def angle_above(triangle: PointsLike, degrees: Coordinate) -> bool:
    """Tell whether the largest angle of a triangle is larger than a bound, exactly; False where it is equal.

    Arguments and errors as for :func:`angle_below`. Constant time for doubles. Reference [Niven 1956].

    >>> from exactkernel import angle_above
    >>> angle_above([(0, 0), (3, 0), (0, 4)], 90), angle_above([(0, 0), (3, 0), (-1e-300, 4)], 90)
    (False, True)
    """
    exact, corners = _degrees(degrees), _corners(triangle)
    bound, doubles = _double(exact), doubles_of(*corners)
    if bound is None or doubles is None:
        return -1 in _angle_signs(corners, exact)
    above = bool(angle_above_adaptive(thread_context(), angle_bound(bound), *doubles))
    raise_if_interrupted()
    return above


def area_above(triangle: PointsLike, bound: Coordinate) -> bool:
    """Tell whether the area of a triangle is larger than a bound, exactly; False where it is equal.

    Args:
        triangle: three points in any order, as orient2d takes them; on one line they have the area 0.
        bound: not negative, in squared units of the coordinates; infinity: never.

    Raises:
        BoundError: the bound is NaN or negative.
        NonFiniteError, CoordinateError, ShapeError: as for orient2d, and for the bound.

    Constant time for doubles. Reference [Shewchuk 1997].

    >>> from exactkernel import area_above
    >>> area_above([(0, 0), (1, 0), (0, 1)], 0.5), area_above([(0, 0), (1, 0), (1e-300, 1)], 0.4999999999999999)
    (False, True)
    """
    a, b, c = _points(triangle, 3)
    corners = [a, b, c] if orient2d(a, b, c) >= 0 else [a, c, b]
    limit, doubles = _bound(bound, "areas"), doubles_of(*corners)
    if limit is None:
        return False
    double = _double(limit)
    if double is None or doubles is None:
        pa, pb, pc = rationals_of(*corners)
        return shape_rational(AREA, limit, pa, pb, pc) > 0
    above = bool(area_above_adaptive(thread_context(), double, *doubles))
    raise_if_interrupted()
    return above


def length_above(edge: PointsLike, bound: Coordinate) -> bool:
    """Tell whether an edge is longer than a bound, exactly; False where it is equal.

    Args:
        edge: its two ends, as orient2d takes points.
        bound: not negative; infinity: never.

    Raises:
        BoundError: the bound is NaN or negative.
        NonFiniteError, CoordinateError, ShapeError: as for orient2d, and for the bound.

    Constant time for doubles. Reference [Shewchuk 1997].

    >>> from exactkernel import length_above
    >>> length_above([(0, 0), (3, 4)], 5), length_above([(0, 0), (1, 1)], 1.4142135623730951)
    (False, False)
    """
    a, b = _points(edge, 2)
    limit, doubles = _bound(bound, "lengths"), doubles_of(a, b)
    if limit is None:
        return False
    double = _double(limit)
    if double is None or doubles is None:
        pa, pb = rationals_of(a, b)
        return shape_rational(LENGTH, limit, pa, pb, pa) > 0
    above = bool(length_above_adaptive(thread_context(), double, *doubles))
    raise_if_interrupted()
    return above
