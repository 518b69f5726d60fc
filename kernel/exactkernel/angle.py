"""angle: is the smallest angle of a triangle below a bound, or the largest above one? For compiled loops.

The angle at a corner, between 0 and 180 degrees, is below the bound b where D sin b - C cos b > 0, with C the cross
product and D the scalar product of its sides. C, twice the area, is the same at all three corners: so the smallest
angle is that of the largest D, the largest angle that of the smallest, and one comparison serves for all three. See
anglebound.py for why sine and cosine always decide.
"""

import math
from typing import NamedTuple

import numpy as np
from gmpy2 import mpq

from exactkernel.anglebound import DIRECTIONS, cosine_and_sine
from exactkernel.codes import DOUBLE_DOUBLE, EXPANSION, FILTER, GRID, RATIONAL
from exactkernel.constants import DD_BOUND, LARGEST_WEIGHT, ORIENT2D_BOUND, SHAPE_FACTOR, SMALLEST_WEIGHT
from exactkernel.context import ORIENT2D_ROW, Context
from exactkernel.doubledouble import dd_add, dd_multiply
from exactkernel.errors import BoundError, shown
from exactkernel.expansions import determinant_2x2, expansion_sign, expansion_sum, negate, two_diff
from exactkernel.jit import jit, jit_inline
from exactkernel.orient2d import safe_degree_2
from exactkernel.rational import ANGLE, shape_from_doubles
from exactkernel.types import FloatArray

__all__ = ["AngleBound", "angle_above_adaptive", "angle_below_adaptive", "angle_bound", "beyond", "sign_of"]


class AngleBound(NamedTuple):
    """A bound on angles for compiled loops, made by :func:`angle_bound`.

    Attributes:
        degrees: the bound, exactly this double.
        cosine, cosine_tail: its cosine as a pair of doubles, relative error below 2^-106.
        sine, sine_tail: its sine likewise.
        is_exact: multiples of 45 degrees, the only ones that an angle can meet exactly: the pairs are integers, and a
            positive multiple of cosine and sine.
    """

    degrees: float
    cosine: float
    cosine_tail: float
    sine: float
    sine_tail: float
    is_exact: bool


#: Below it the sine comes near the underflow: no pair then, and the rational stage decides.
_SMALLEST_DEGREES = 1e-100
_PAIR_PRECISION = 1024


def _pair_of(value: mpq) -> tuple[float, float]:
    high = float(value)
    return high, float(value - mpq(high))


def angle_bound(degrees: float) -> AngleBound:
    """Return the bound on angles for :func:`angle_below_adaptive` and :func:`angle_above_adaptive`.

    Args:
        degrees: from 0 to 180, taken as exactly the double that it is.

    Raises:
        BoundError: NaN, or outside 0 to 180.

    >>> from exactkernel.shape import angle_bound
    >>> bound = angle_bound(20.0)
    >>> bound.degrees, bound.sine, bound.is_exact
    (20.0, 0.3420201433256687, False)
    """
    given: object = degrees
    if not isinstance(given, (int, float, np.integer, np.floating)) or not 0.0 <= given <= 180.0:
        raise BoundError(f"an angle is between 0 and 180 degrees, not {shown(given)}")
    degrees = float(given)
    exact = mpq(degrees)
    if exact in DIRECTIONS:
        cosine, sine = DIRECTIONS[exact]
        return AngleBound(degrees, float(cosine), 0.0, float(sine), 0.0, True)
    if degrees < _SMALLEST_DEGREES:
        return AngleBound(degrees, math.nan, math.nan, math.nan, math.nan, False)
    c, s, _ = cosine_and_sine(exact, _PAIR_PRECISION)
    return AngleBound(degrees, *_pair_of(c), *_pair_of(s), False)


@jit_inline
def sign_of(x: float) -> int:
    """Return the sign of a double."""
    return 1 if x > 0.0 else (-1 if x < 0.0 else 0)


@jit_inline
def beyond(det: float, error: float) -> int:
    """Return the sign of a value that errs by less than ``error``, or 0 if it is not known."""
    return 1 if det > error else (-1 if -det > error else 0)


@jit_inline
def angle_filter(bound: float, angle: AngleBound, cross: float, crosses: float, dot: float, dots: float) -> int:
    """Return the sign of dot sin - cross cos if the error bound certifies it, else 0; permanents in the plural."""
    det = angle.sine * dot - angle.cosine * cross
    weight = angle.sine * dots + abs(angle.cosine) * crosses
    if not weight >= SMALLEST_WEIGHT:
        return 0
    return beyond(det, bound * weight)


@jit_inline
def edge_products(
    ax: float, ay: float, bx: float, by: float, cx: float, cy: float
) -> tuple[float, float, float, float, float, float]:
    """Return twice the area and its permanent, the scalar product at each corner and their largest permanent."""
    ux, uy, vx, vy, wx, wy = bx - ax, by - ay, cx - bx, cy - by, ax - cx, ay - cy
    left, right = ux * vy, uy * vx
    ax, ay, bx, by, cx, cy = ux * wx, uy * wy, vx * ux, vy * uy, wx * vx, wy * vy
    dots = max(max(abs(ax) + abs(ay), abs(bx) + abs(by)), abs(cx) + abs(cy))
    return left - right, abs(left) + abs(right), -ax - ay, -bx - by, -cx - cy, dots


@jit
def corner_double_double(
    angle: AngleBound, ux: float, uxt: float, uy: float, uyt: float, vx: float, vxt: float, vy: float, vyt: float
) -> float:
    """Return dot sin - cross cos of two sides (pairs) in double-double, rounded to one double."""
    left, left_tail = dd_multiply(ux, uxt, vy, vyt)
    right, right_tail = dd_multiply(uy, uyt, vx, vxt)
    cross, cross_tail = dd_add(left, left_tail, -right, -right_tail)
    left, left_tail = dd_multiply(ux, uxt, vx, vxt)
    right, right_tail = dd_multiply(uy, uyt, vy, vyt)
    dot, dot_tail = dd_add(left, left_tail, right, right_tail)
    left, left_tail = dd_multiply(angle.sine, angle.sine_tail, dot, dot_tail)
    right, right_tail = dd_multiply(angle.cosine, angle.cosine_tail, cross, cross_tail)
    return dd_add(left, left_tail, -right, -right_tail)[0]


@jit
def corner_expansion(
    angle: AngleBound, ux: float, uxt: float, uy: float, uyt: float, vx: float, vxt: float, vy: float, vyt: float,
    scratch: FloatArray,
) -> int:  # fmt: skip
    """Return the exact sign of dot sin - cross cos of two sides (pairs), where sine and cosine are -1, 0 or 1."""
    dot, cross, total, rest = scratch[0:16], scratch[16:32], scratch[32:64], scratch[64:96]
    n_dot = n_cross = 0
    if angle.sine != 0.0:
        n_dot = determinant_2x2(ux, uxt, vx, vxt, uy, uyt, -vy, -vyt, dot, rest)
    if angle.cosine != 0.0:
        n_cross = determinant_2x2(ux, uxt, vy, vyt, uy, uyt, vx, vxt, cross, rest)
    if angle.cosine > 0.0:
        negate(cross, n_cross)
    return expansion_sign(total, expansion_sum(dot, n_dot, cross, n_cross, total))


@jit
def corner_code(k: Context, angle: AngleBound, ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    """Return stage * 4 + sign + 1 of the bound minus the angle at a, for a triangle that the filter did not decide."""
    ux, uy, vx, vy = bx - ax, by - ay, cx - ax, cy - ay
    crosses, dots = abs(ux * vy) + abs(uy * vx), abs(ux * vx) + abs(uy * vy)
    weight = angle.sine * dots + abs(angle.cosine) * crosses
    if k.orient2d_bound < math.inf or (
        safe_degree_2(ax) and safe_degree_2(ay) and safe_degree_2(bx)
        and safe_degree_2(by) and safe_degree_2(cx) and safe_degree_2(cy)
    ):  # fmt: skip
        cross, dot = ux * vy - uy * vx, ux * vx + uy * vy
        sign = angle_filter(SHAPE_FACTOR * ORIENT2D_BOUND, angle, cross, crosses, dot, dots)
        if sign != 0:
            return FILTER + sign
        if angle.is_exact and max(max(abs(ux), abs(uy)), max(abs(vx), abs(vy))) <= k.grid_limit:
            return GRID + sign_of(angle.sine * dot - angle.cosine * cross)
        ux, uxt = two_diff(bx, ax)
        uy, uyt = two_diff(by, ay)
        vx, vxt = two_diff(cx, ax)
        vy, vyt = two_diff(cy, ay)
        if SMALLEST_WEIGHT <= weight <= LARGEST_WEIGHT:
            sign = beyond(corner_double_double(angle, ux, uxt, uy, uyt, vx, vxt, vy, vyt), DD_BOUND * weight)
            if sign != 0:
                return DOUBLE_DOUBLE + sign
        if angle.is_exact:
            return EXPANSION + corner_expansion(angle, ux, uxt, uy, uyt, vx, vxt, vy, vyt, k.scratch)
    return RATIONAL + shape_from_doubles(k.mailbox, ANGLE, angle.degrees, ax, ay, bx, by, cx, cy)


@jit
def some_corner(
    k: Context, angle: AngleBound, wanted: int, ax: float, ay: float, bx: float, by: float, cx: float, cy: float
) -> bool:
    """Tell whether the bound minus the angle has the wanted sign at some corner; tally the stage that decided."""
    code = corner_code(k, angle, ax, ay, bx, by, cx, cy)
    stage = code >> 2
    if (code & 3) - 1 != wanted:
        code = corner_code(k, angle, bx, by, cx, cy, ax, ay)
        stage = max(stage, code >> 2)
    if (code & 3) - 1 != wanted:
        code = corner_code(k, angle, cx, cy, ax, ay, bx, by)
        stage = max(stage, code >> 2)
    k.counts[ORIENT2D_ROW, stage] += 1
    return (code & 3) - 1 == wanted


@jit_inline
def angle_below_adaptive(
    k: Context, angle: AngleBound, ax: float, ay: float, bx: float, by: float, cx: float, cy: float
) -> bool:
    """Tell whether the smallest angle of a counterclockwise triangle is less than the bound, in a compiled loop."""
    cross, crosses, da, db, dc, dots = edge_products(ax, ay, bx, by, cx, cy)
    sign = angle_filter(SHAPE_FACTOR * k.orient2d_bound, angle, cross, crosses, max(max(da, db), dc), dots)
    if sign != 0:
        k.counts[ORIENT2D_ROW, 0] += 1
        return sign > 0
    return some_corner(k, angle, 1, ax, ay, bx, by, cx, cy)


@jit_inline
def angle_above_adaptive(
    k: Context, angle: AngleBound, ax: float, ay: float, bx: float, by: float, cx: float, cy: float
) -> bool:
    """Tell whether the largest angle of a counterclockwise triangle is more than the bound, in a compiled loop."""
    cross, crosses, da, db, dc, dots = edge_products(ax, ay, bx, by, cx, cy)
    sign = angle_filter(SHAPE_FACTOR * k.orient2d_bound, angle, cross, crosses, min(min(da, db), dc), dots)
    if sign != 0:
        k.counts[ORIENT2D_ROW, 0] += 1
        return sign < 0
    return some_corner(k, angle, -1, ax, ay, bx, by, cx, cy)
