"""The circumcentre of three points as doubles in compiled loops: double-double with a certified bound, then expansions.

With u = b - a, v = c - a the circumcentre is a + n / (2 u x v), n = (v_y |u|^2 - u_y |v|^2, u_x |v|^2 - v_x |u|^2). The
differences are exact pairs. In double-double a square errs by 7 u^2 relative to its value, a lift by 10, its product
with a difference by 17, and n by 20 u^2 times the sum of the two absolute values: below DD_BOUND; the quotient adds 15
u^2 and the sum 3 u^2 [Joldes 2017]. Where that leaves two neighbouring doubles, expansions compare the exact coordinate
with the number half-way between them. What is left (a window too small, a coordinate beyond it) is for the rationals.
"""

import math

from exactkernel.constants import DD_BOUND, MAX_COORDINATE_DEGREE_4, MIN_COORDINATE_DEGREE_4
from exactkernel.context import Context
from exactkernel.crossing import dd_cross, is_nearest_certain
from exactkernel.doubledouble import dd_add, dd_multiply
from exactkernel.expansions import (
    determinant_2x2,
    expansion_product,
    expansion_sign,
    expansion_sum,
    fast_two_sum,
    negate,
    pair,
    two_diff,
    two_sum,
)
from exactkernel.incircle import lift_double_double, safe_degree_4
from exactkernel.jit import jit
from exactkernel.types import FloatArray

__all__ = ["circumcentre_in_pairs", "nearest_circumcentre", "quotient_offset"]

#: A relative error of the denominator up to which first-order error propagation, times _SLACK, covers the quotient.
_SMALL = 2.0**-10
#: 1 / (1 - 2^-10) and the roundings of the bounds themselves: a few hundred units of u at most.
_SLACK = 1.125


@jit
def quotient_offset(
    a: float, n: float, n_tail: float, n_error: float, det: float, det_tail: float, det_error: float
) -> tuple[float, float, float]:
    """Return (high, low, error bound) of a + n / det, given bounds of the errors of the pairs n and det."""
    high = n / det
    m, m_tail = dd_multiply(det, det_tail, high, 0.0)
    q, q_tail = fast_two_sum(high, ((n - m) + (n_tail - m_tail)) / det)
    error = n_error / abs(det) + abs(q) * (det_error / abs(det) + DD_BOUND)
    x, x_tail = dd_add(a, 0.0, q, q_tail)
    return x, x_tail, _SLACK * (error + DD_BOUND * abs(x))


@jit
def circumcentre_in_pairs(
    k: Context, ax: float, ay: float, bx: float, by: float, cx: float, cy: float
) -> tuple[float, float, float, float, float, float]:
    """Return (x, x tail, x error, y, y tail, y error) of the circumcentre of a, b, c.

    The exact coordinate differs from x + tail by at most the error, which is infinite where nothing is known: far too
    nearly collinear, or coordinates outside of the window of degree 4.
    """
    inf = math.inf
    if k.incircle_bound == inf and not (
        safe_degree_4(ax) and safe_degree_4(ay) and safe_degree_4(bx)
        and safe_degree_4(by) and safe_degree_4(cx) and safe_degree_4(cy)
    ):  # fmt: skip
        return ax, 0.0, inf, ay, 0.0, inf
    ux, ux_tail = two_diff(bx, ax)
    uy, uy_tail = two_diff(by, ay)
    vx, vx_tail = two_diff(cx, ax)
    vy, vy_tail = two_diff(cy, ay)
    det, det_tail, det_error = dd_cross(ux, ux_tail, vy, vy_tail, uy, uy_tail, vx, vx_tail)
    if det_error > _SMALL * abs(det) or det == 0.0:
        return ax, 0.0, inf, ay, 0.0, inf
    uu, uu_tail = lift_double_double(ux, ux_tail, uy, uy_tail)
    vv, vv_tail = lift_double_double(vx, vx_tail, vy, vy_tail)
    nx, nx_tail, nx_error = dd_cross(vy, vy_tail, uu, uu_tail, uy, uy_tail, vv, vv_tail)
    ny, ny_tail, ny_error = dd_cross(ux, ux_tail, vv, vv_tail, vx, vx_tail, uu, uu_tail)
    x, x_tail, x_error = quotient_offset(ax, nx, nx_tail, nx_error, 2.0 * det, 2.0 * det_tail, 2.0 * det_error)
    y, y_tail, y_error = quotient_offset(ay, ny, ny_tail, ny_error, 2.0 * det, 2.0 * det_tail, 2.0 * det_error)
    return x, x_tail, x_error, y, y_tail, y_error


@jit
def _lifted(
    p: float, p_tail: float, x: float, x_tail: float, y: float, y_tail: float, h: FloatArray, scratch: FloatArray
) -> int:
    """Write p (x^2 + y^2) of exact pairs into h (64); uses 114 doubles of scratch."""
    lift, f = scratch[0:16], scratch[16:18]
    n_lift = determinant_2x2(x, x_tail, x, x_tail, y, y_tail, -y, -y_tail, lift, scratch[18:50])
    return expansion_product(lift, n_lift, f, pair(p, p_tail, f), h, scratch[18:50], scratch[50:114])


@jit
def _estimate(e: FloatArray, n: int) -> float:
    """Return the sum of an expansion, rounded: relative error at most 4u."""
    total = 0.0
    for i in range(n):
        total += e[i]
    return total


@jit
def _beyond(
    axis: int, middle: float, tail: float,
    ax: float, ay: float, bx: float, by: float, cx: float, cy: float, scratch: FloatArray,
) -> tuple[int, float]:  # fmt: skip
    """Return the exact sign of (coordinate of the circumcentre) - (middle + tail), and the difference, rounded.

    The difference errs by at most 16u relative to itself. Uses 820 doubles of scratch.
    """
    left, right, n, cross = scratch[0:64], scratch[64:128], scratch[128:256], scratch[256:272]
    step, product, total, rest = scratch[272:276], scratch[276:404], scratch[404:660], scratch[660:]
    ux, ux_tail = two_diff(bx, ax)
    uy, uy_tail = two_diff(by, ay)
    vx, vx_tail = two_diff(cx, ax)
    vy, vy_tail = two_diff(cy, ay)
    if axis == 0:
        n_left = _lifted(vy, vy_tail, ux, ux_tail, uy, uy_tail, left, rest)
        n_right = _lifted(uy, uy_tail, vx, vx_tail, vy, vy_tail, right, rest)
    else:
        n_left = _lifted(ux, ux_tail, vx, vx_tail, vy, vy_tail, left, rest)
        n_right = _lifted(vx, vx_tail, ux, ux_tail, uy, uy_tail, right, rest)
    negate(right, n_right)
    n_n = expansion_sum(left, n_left, right, n_right, n)
    n_cross = determinant_2x2(ux, ux_tail, vy, vy_tail, uy, uy_tail, vx, vx_tail, cross, rest)
    high, low = two_diff(middle, ax if axis == 0 else ay)
    n_high = pair(high, low, left)
    n_low = pair(tail, 0.0, right)
    n_step = expansion_sum(left, n_high, right, n_low, step)
    n_product = expansion_product(cross, n_cross, step, n_step, product, rest[0:32], rest[32:160])
    for i in range(n_product):
        product[i] *= -2.0
    n_total = expansion_sum(n, n_n, product, n_product, total)
    if n_total == 0:
        return 0, 0.0
    difference = _estimate(total, n_total) / (2.0 * _estimate(cross, n_cross))
    return expansion_sign(cross, n_cross) * expansion_sign(total, n_total), difference


@jit
def _decided(
    k: Context, axis: int, x: float, tail: float,
    ax: float, ay: float, bx: float, by: float, cx: float, cy: float,
) -> tuple[float, bool]:  # fmt: skip
    """Return (the nearest double, True) to a coordinate near x + tail, or (x, False) if it is not known.

    One step of refinement by the exact difference; then at most the number half-way between two doubles is in question,
    and ties go to the even one.
    """
    tail = tail if abs(tail) >= MIN_COORDINATE_DEGREE_4 else 0.0
    if not (safe_degree_4(x) and safe_degree_4(tail)):
        return x, False
    side, difference = _beyond(axis, x, tail, ax, ay, bx, by, cx, cy, k.scratch)
    if side == 0 and tail == 0.0:
        return x + 0.0, True  # no negative zero
    if not abs(difference) < MAX_COORDINATE_DEGREE_4:
        return x, False
    rest = tail + difference
    error = 2.0**-48 * abs(difference) + 2.0**-52 * abs(rest)
    x, rest = two_sum(x, rest)
    if abs(x) >= MIN_COORDINATE_DEGREE_4 and is_nearest_certain(x, rest, error):
        return x, True
    margin = error + 2.0**-50 * (abs(rest) + error)
    low, high = x + (rest - margin), x + (rest + margin)
    if low <= MIN_COORDINATE_DEGREE_4 and high >= -MIN_COORDINATE_DEGREE_4:  # zero, or too small for expansions
        side, difference = _beyond(axis, 0.0, 0.0, ax, ay, bx, by, cx, cy, k.scratch)
        return 0.0, side == 0
    if math.nextafter(low, math.inf) != high:
        return x, False
    half = 0.5 * (high - low)
    side, difference = _beyond(axis, low, half, ax, ay, bx, by, cx, cy, k.scratch)
    if side == 0:
        return low + half, True
    return (high, True) if side > 0 else (low, True)


@jit
def nearest_circumcentre(
    k: Context, ax: float, ay: float, bx: float, by: float, cx: float, cy: float
) -> tuple[float, float, bool]:
    """Return the doubles nearest to the circumcentre of a, b, c, and whether they are: if not, ask the rationals."""
    x, x_tail, x_error, y, y_tail, y_error = circumcentre_in_pairs(k, ax, ay, bx, by, cx, cy)
    if not (x_error < math.inf and y_error < math.inf):
        return x, y, False
    certain = True
    if abs(x) < MIN_COORDINATE_DEGREE_4 or not is_nearest_certain(x, x_tail, x_error):  # below, bounds may underflow
        x, certain = _decided(k, 0, x, x_tail, ax, ay, bx, by, cx, cy)
    if certain and (abs(y) < MIN_COORDINATE_DEGREE_4 or not is_nearest_certain(y, y_tail, y_error)):
        y, certain = _decided(k, 1, y, y_tail, ax, ay, bx, by, cx, cy)
    return x, y, certain
