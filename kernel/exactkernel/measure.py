"""measure: is the area of a triangle, or the length of an edge, above a bound? For compiled loops.

The bound is any double: twice the area is compared with twice the bound, the squared length with the squared bound.
"""

import math

from exactkernel.angle import beyond, sign_of
from exactkernel.codes import DOUBLE_DOUBLE, EXPANSION, FILTER, GRID, RATIONAL
from exactkernel.constants import DD_BOUND, LARGEST_WEIGHT, ORIENT2D_BOUND, SHAPE_FACTOR, SMALLEST_WEIGHT
from exactkernel.context import ORIENT2D_ROW, Context
from exactkernel.doubledouble import dd_add, dd_multiply
from exactkernel.expansions import determinant_2x2, expansion_sign, expansion_sum, pair, two_diff, two_product
from exactkernel.jit import jit, jit_inline
from exactkernel.orient2d import safe_degree_2
from exactkernel.rational import AREA, LENGTH, shape_from_doubles

__all__ = ["area_above_adaptive", "length_above_adaptive"]


@jit_inline
def area_filter(factor: float, bound: float, ux: float, uy: float, vx: float, vy: float) -> int:
    """Return the sign of the area of two sides minus the bound if the error bound certifies it, else 0."""
    left, right, twice = ux * vy, uy * vx, 2.0 * bound
    weight = abs(left) + abs(right) + abs(twice)
    if not weight >= SMALLEST_WEIGHT:
        return 0
    return beyond((left - right) - twice, factor * weight)


@jit_inline
def length_filter(factor: float, bound: float, ux: float, uy: float) -> int:
    """Return the sign of the length of a vector minus the bound if the error bound certifies it, else 0."""
    squared, limit = ux * ux + uy * uy, bound * bound
    weight = squared + limit
    if not weight >= SMALLEST_WEIGHT:
        return 0
    return beyond(squared - limit, factor * weight)


@jit
def area_code(k: Context, bound: float, ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    """Return stage * 4 + sign + 1 of the area minus the bound, for a triangle that the filter did not decide."""
    if bound == math.inf:
        return FILTER - 1
    if k.orient2d_bound == math.inf and not (
        safe_degree_2(ax) and safe_degree_2(ay) and safe_degree_2(bx)
        and safe_degree_2(by) and safe_degree_2(cx) and safe_degree_2(cy)
    ):  # fmt: skip
        return RATIONAL + shape_from_doubles(k.mailbox, AREA, bound, ax, ay, bx, by, cx, cy)
    twice = 2.0 * bound
    if twice == math.inf:
        return FILTER - 1
    ux, uy, vx, vy = bx - ax, by - ay, cx - ax, cy - ay
    sign = area_filter(SHAPE_FACTOR * ORIENT2D_BOUND, bound, ux, uy, vx, vy)
    if sign != 0:
        return FILTER + sign
    if max(max(abs(ux), abs(uy)), max(abs(vx), abs(vy))) <= k.grid_limit:
        return GRID + sign_of((ux * vy - uy * vx) - twice)
    ux, uxt = two_diff(bx, ax)
    uy, uyt = two_diff(by, ay)
    vx, vxt = two_diff(cx, ax)
    vy, vyt = two_diff(cy, ay)
    left, left_tail = dd_multiply(ux, uxt, vy, vyt)
    right, right_tail = dd_multiply(uy, uyt, vx, vxt)
    cross, cross_tail = dd_add(left, left_tail, -right, -right_tail)
    weight = abs(left) + abs(right) + abs(twice)
    if SMALLEST_WEIGHT <= weight <= LARGEST_WEIGHT:
        sign = beyond(dd_add(cross, cross_tail, -twice, 0.0)[0], DD_BOUND * weight)
        if sign != 0:
            return DOUBLE_DOUBLE + sign
    doubled, limit, total, rest = k.scratch[0:16], k.scratch[16:18], k.scratch[18:36], k.scratch[36:68]
    n = determinant_2x2(ux, uxt, vy, vyt, uy, uyt, vx, vxt, doubled, rest)
    return EXPANSION + expansion_sign(total, expansion_sum(doubled, n, limit, pair(-twice, 0.0, limit), total))


@jit
def length_code(k: Context, bound: float, ax: float, ay: float, bx: float, by: float) -> int:
    """Return stage * 4 + sign + 1 of the length of ab minus the bound, for an edge that the filter did not decide."""
    if bound == math.inf:
        return FILTER - 1
    if not safe_degree_2(bound) or (
        k.orient2d_bound == math.inf
        and not (safe_degree_2(ax) and safe_degree_2(ay) and safe_degree_2(bx) and safe_degree_2(by))
    ):
        return RATIONAL + shape_from_doubles(k.mailbox, LENGTH, bound, ax, ay, bx, by, ax, ay)
    sign = length_filter(SHAPE_FACTOR * ORIENT2D_BOUND, bound, bx - ax, by - ay)
    if sign != 0:
        return FILTER + sign
    ux, uxt = two_diff(bx, ax)
    uy, uyt = two_diff(by, ay)
    limit, limit_tail = two_product(bound, bound)
    left, left_tail = dd_multiply(ux, uxt, ux, uxt)
    right, right_tail = dd_multiply(uy, uyt, uy, uyt)
    weight = left + right + limit
    if SMALLEST_WEIGHT <= weight <= LARGEST_WEIGHT:
        squared, squared_tail = dd_add(left, left_tail, right, right_tail)
        sign = beyond(dd_add(squared, squared_tail, -limit, -limit_tail)[0], DD_BOUND * weight)
        if sign != 0:
            return DOUBLE_DOUBLE + sign
    both, square, total, rest = k.scratch[0:16], k.scratch[16:18], k.scratch[18:36], k.scratch[36:68]
    n = determinant_2x2(ux, uxt, ux, uxt, uy, uyt, -uy, -uyt, both, rest)
    return EXPANSION + expansion_sign(total, expansion_sum(both, n, square, pair(-limit, -limit_tail, square), total))


@jit
def area_exact(k: Context, bound: float, ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> bool:
    """Tell what the filter could not, and tally the stage that did."""
    code = area_code(k, bound, ax, ay, bx, by, cx, cy)
    k.counts[ORIENT2D_ROW, code >> 2] += 1
    return (code & 3) == 2


@jit
def length_exact(k: Context, bound: float, ax: float, ay: float, bx: float, by: float) -> bool:
    """Tell what the filter could not, and tally the stage that did."""
    code = length_code(k, bound, ax, ay, bx, by)
    k.counts[ORIENT2D_ROW, code >> 2] += 1
    return (code & 3) == 2


@jit_inline
def area_above_adaptive(
    k: Context, bound: float, ax: float, ay: float, bx: float, by: float, cx: float, cy: float
) -> bool:
    """Tell whether the area of a counterclockwise triangle is more than the bound (no NaN), in a compiled loop."""
    sign = area_filter(SHAPE_FACTOR * k.orient2d_bound, bound, bx - ax, by - ay, cx - ax, cy - ay)
    if sign != 0:
        k.counts[ORIENT2D_ROW, 0] += 1
        return sign > 0
    return area_exact(k, bound, ax, ay, bx, by, cx, cy)


@jit_inline
def length_above_adaptive(k: Context, bound: float, ax: float, ay: float, bx: float, by: float) -> bool:
    """Tell whether the edge ab is longer than the bound (0 to infinity, no NaN), in a compiled loop."""
    sign = length_filter(SHAPE_FACTOR * k.orient2d_bound, bound, bx - ax, by - ay)
    if sign != 0:
        k.counts[ORIENT2D_ROW, 0] += 1
        return sign > 0
    return length_exact(k, bound, ax, ay, bx, by)
