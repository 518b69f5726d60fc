"""The boundary of the scalar predicates: points of any exact number type in, doubles or rationals out."""

import math
from fractions import Fraction

import numpy as np
from gmpy2 import mpq, mpz

from exactkernel.errors import CoordinateError, NonFiniteError, ShapeError, shown
from exactkernel.rational import RationalPoint
from exactkernel.types import Coordinate, PointLike

__all__ = ["doubles_of", "rational_point", "rational_value", "rationals_of"]

_EXACT_INTEGERS = 2**53


def _pair(point: PointLike) -> tuple[object, object]:
    try:
        x, y = point
    except (TypeError, ValueError):
        raise ShapeError(f"a point is a pair (x, y), not {shown(point)}") from None
    return x, y


def doubles_of(*points: PointLike) -> list[float] | None:
    """Return x0, y0, x1, ... as doubles, or None if some coordinate is not exactly a double."""
    doubles: list[float] = []
    for point in points:
        for value in _pair(point):
            if type(value) is float or isinstance(value, np.float64):
                if not math.isfinite(value):
                    raise NonFiniteError(f"{shown(point)} is not finite")
                doubles.append(float(value))
                continue
            if type(value) is int and -_EXACT_INTEGERS <= value <= _EXACT_INTEGERS:
                doubles.append(float(value))
                continue
            exact = _rational(value, point)
            try:
                rounded = float(exact)
            except OverflowError:
                return None
            if mpq(rounded) != exact:
                return None
            doubles.append(rounded)
    return doubles


def _rational(value: object, point: object) -> mpq:
    if isinstance(value, np.integer):
        return mpq(int(value))
    if isinstance(value, (float, np.floating)):
        if not np.isfinite(value):
            raise NonFiniteError(f"{shown(point)} is not finite")
        return mpq(*value.as_integer_ratio())
    if isinstance(value, Fraction):
        return mpq(int(value.numerator), int(value.denominator))  # Fraction(np.int64(1)) keeps numpy's integer
    if isinstance(value, (int, type(mpz()), type(mpq()))) and not isinstance(value, bool):
        return mpq(value)
    raise CoordinateError(
        f"a coordinate is an int, float, numpy number, Fraction, mpz or mpq, not {type(value).__name__}: {shown(value)}"
    )


def rational_point(point: PointLike) -> RationalPoint:
    """Return the point in exact rationals."""
    x, y = _pair(point)
    return _rational(x, point), _rational(y, point)


def rational_value(value: Coordinate) -> mpq:
    """Return a single number, say a parameter along a segment, as an exact rational."""
    return _rational(value, value)


def rationals_of(*points: PointLike) -> list[RationalPoint]:
    """Return the points in exact rationals."""
    return [rational_point(point) for point in points]
