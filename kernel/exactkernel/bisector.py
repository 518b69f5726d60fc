"""Predicates about bisectors, for compiled loops: which site is nearer, and which bisector does a line cross first?

The stages are those of incircle: filter, double-double, expansions, and rationals outside of the window. The filter of
``nearer`` errs by 4 u: lifts 4 u, the last difference is free. ``crossing_order``: inner product 4 u, numerator 5 u,
their product 10 u, and second-order terms as incircle has them.
"""

import math

from exactkernel.bisector_rational import along_from_doubles, crossing_order_from_doubles, nearer_from_doubles
from exactkernel.centre import quotient_offset
from exactkernel.constants import DD_BOUND, INCIRCLE_BOUND, ORIENT2D_BOUND, UNIT_ROUNDOFF
from exactkernel.context import Context
from exactkernel.crossing import is_nearest_certain
from exactkernel.doubledouble import dd_add, dd_multiply
from exactkernel.expansions import determinant_2x2, expansion_product, expansion_sign, expansion_sum, negate, two_diff
from exactkernel.incircle import lift_double_double
from exactkernel.jit import jit
from exactkernel.orient2d import products_difference
from exactkernel.types import FloatArray

__all__ = ["along_adaptive", "bisector_crossing", "crossing_order_adaptive", "nearer_adaptive"]

#: Below, a product may lose bits to underflow: Dekker's is exact for exponents from -970 on.
_SMALLEST_PRODUCT = 2.0**-900
#: A relative error of the denominator up to which first-order error propagation covers the quotient.
_SMALL = 2.0**-10

#: The calculus of constants.py gives 4 u + 14 u^2 for the difference of two lifts.
_NEARER_BOUND = (4.0 + 32.0 * UNIT_ROUNDOFF) * UNIT_ROUNDOFF


@jit
def nearer_adaptive(k: Context, px: float, py: float, qx: float, qy: float, x: float, y: float) -> int:
    """Return the exact sign of |x - p|^2 - |x - q|^2: +1 if x is nearer to q than to p."""
    if k.incircle_bound == math.inf:
        return nearer_from_doubles(k.mailbox, px, py, qx, qy, x, y)
    ux, uy, vx, vy = x - px, y - py, x - qx, y - qy
    to_p, to_q = ux * ux + uy * uy, vx * vx + vy * vy
    error = _NEARER_BOUND * (to_p + to_q)
    if to_p - to_q > error:
        return 1
    if to_q - to_p > error:
        return -1
    ux, ux_tail = two_diff(x, px)
    uy, uy_tail = two_diff(y, py)
    vx, vx_tail = two_diff(x, qx)
    vy, vy_tail = two_diff(y, qy)
    p, p_tail = lift_double_double(ux, ux_tail, uy, uy_tail)
    q, q_tail = lift_double_double(vx, vx_tail, vy, vy_tail)
    difference, _ = dd_add(p, p_tail, -q, -q_tail)
    error = DD_BOUND * (p + q)
    if difference > error:
        return 1
    if -difference > error:
        return -1
    left, right, total, rest = k.scratch[0:16], k.scratch[16:32], k.scratch[32:64], k.scratch[64:]
    n_left = determinant_2x2(ux, ux_tail, ux, ux_tail, uy, uy_tail, -uy, -uy_tail, left, rest)
    n_right = determinant_2x2(vx, vx_tail, vx, vx_tail, vy, vy_tail, -vy, -vy_tail, right, rest)
    negate(right, n_right)
    return expansion_sign(total, expansion_sum(left, n_left, right, n_right, total))


@jit
def along_adaptive(
    k: Context, px: float, py: float, qx: float, qy: float, ax: float, ay: float, bx: float, by: float
) -> int:
    """Return the exact sign of the inner product (q - p) (b - a)."""
    if k.orient2d_bound == math.inf:
        return along_from_doubles(k.mailbox, px, py, qx, qy, ax, ay, bx, by)
    wx, wy, dx, dy = qx - px, qy - py, bx - ax, by - ay
    left, right = wx * dx, wy * dy
    error = ORIENT2D_BOUND * (abs(left) + abs(right))
    if left + right > error:
        return 1
    if -(left + right) > error:
        return -1
    wx, wx_tail = two_diff(qx, px)
    wy, wy_tail = two_diff(qy, py)
    dx, dx_tail = two_diff(bx, ax)
    dy, dy_tail = two_diff(by, ay)
    return (products_difference(wx, wx_tail, dx, dx_tail, -wy, -wy_tail, dy, dy_tail, k.scratch) & 3) - 1


@jit
def _inner(
    wx: float, wx_tail: float, wy: float, wy_tail: float, dx: float, dx_tail: float, dy: float, dy_tail: float
) -> tuple[float, float, float]:
    """Return (high, low, permanent) of w d in double-double."""
    x, x_tail = dd_multiply(wx, wx_tail, dx, dx_tail)
    y, y_tail = dd_multiply(wy, wy_tail, dy, dy_tail)
    high, low = dd_add(x, x_tail, y, y_tail)
    return high, low, abs(x) + abs(y)


@jit
def _numerator(
    wx: float, wx_tail: float, wy: float, wy_tail: float, cx: float, cx_tail: float, cy: float, cy_tail: float
) -> tuple[float, float, float]:
    """Return (high, low, permanent) of 2 w c + |w|^2 in double-double."""
    high, low, permanent = _inner(wx, wx_tail, wy, wy_tail, cx, cx_tail, cy, cy_tail)
    lift, lift_tail = lift_double_double(wx, wx_tail, wy, wy_tail)
    high, low = dd_add(2.0 * high, 2.0 * low, lift, lift_tail)
    return high, low, 2.0 * permanent + lift


@jit
def _term(
    wx: float, wx_tail: float, wy: float, wy_tail: float, cx: float, cx_tail: float, cy: float, cy_tail: float,
    vx: float, vx_tail: float, vy: float, vy_tail: float, dx: float, dx_tail: float, dy: float, dy_tail: float,
    h: FloatArray, scratch: FloatArray,
) -> int:  # fmt: skip
    """Write (2 w c + |w|^2) (v d) into h (1024) as an expansion; uses 1200 doubles of scratch."""
    inner, lift, numerator = scratch[0:16], scratch[16:32], scratch[32:64]
    rest = scratch[64:]
    n_inner = determinant_2x2(wx, wx_tail, cx, cx_tail, -wy, -wy_tail, cy, cy_tail, inner, rest)
    for i in range(n_inner):
        inner[i] *= 2.0
    n_lift = determinant_2x2(wx, wx_tail, wx, wx_tail, -wy, -wy_tail, wy, wy_tail, lift, rest)
    n_numerator = expansion_sum(inner, n_inner, lift, n_lift, numerator)
    n_inner = determinant_2x2(vx, vx_tail, dx, dx_tail, -vy, -vy_tail, dy, dy_tail, inner, rest)
    return expansion_product(numerator, n_numerator, inner, n_inner, h, rest[0:64], rest[64:1088])


@jit
def crossing_order_adaptive(
    k: Context, sx: float, sy: float, px: float, py: float, qx: float, qy: float,
    ax: float, ay: float, bx: float, by: float,
) -> int:  # fmt: skip
    """Return the exact sign of N(p) D(q) - N(q) D(p), where a + (b - a) N(p) / (2 D(p)) is as near to s as to p.

    If both p and q lie ahead of s in the direction from a to b (D is positive), it is that of t(p) - t(q): -1 if the
    line comes first to the bisector of s and p, 1 if to that of s and q, 0 if to both at once.
    """
    if k.incircle_bound == math.inf:
        return crossing_order_from_doubles(k.mailbox, sx, sy, px, py, qx, qy, ax, ay, bx, by)
    dx, dy, cx, cy = bx - ax, by - ay, sx - ax, sy - ay
    wx, wy, vx, vy = px - sx, py - sy, qx - sx, qy - sy
    w_lift, v_lift = wx * wx + wy * wy, vx * vx + vy * vy
    n_w, n_v = 2.0 * (wx * cx + wy * cy) + w_lift, 2.0 * (vx * cx + vy * cy) + v_lift
    d_w, d_v = wx * dx + wy * dy, vx * dx + vy * dy
    det = n_w * d_v - n_v * d_w
    error = INCIRCLE_BOUND * (
        (2.0 * (abs(wx * cx) + abs(wy * cy)) + w_lift) * (abs(vx * dx) + abs(vy * dy))
        + (2.0 * (abs(vx * cx) + abs(vy * cy)) + v_lift) * (abs(wx * dx) + abs(wy * dy))
    )
    if det > error:
        return 1
    if -det > error:
        return -1
    return _crossing_order_exact(k, sx, sy, px, py, qx, qy, ax, ay, bx, by)


@jit
def _crossing_order_exact(
    k: Context, sx: float, sy: float, px: float, py: float, qx: float, qy: float,
    ax: float, ay: float, bx: float, by: float,
) -> int:  # fmt: skip
    """Return what the filter could not certify."""
    dx, dxt = two_diff(bx, ax)
    dy, dyt = two_diff(by, ay)
    cx, cxt = two_diff(sx, ax)
    cy, cyt = two_diff(sy, ay)
    wx, wxt = two_diff(px, sx)
    wy, wyt = two_diff(py, sy)
    vx, vxt = two_diff(qx, sx)
    vy, vyt = two_diff(qy, sy)
    nw, nwt, nw_permanent = _numerator(wx, wxt, wy, wyt, cx, cxt, cy, cyt)
    nv, nvt, nv_permanent = _numerator(vx, vxt, vy, vyt, cx, cxt, cy, cyt)
    dw, dwt, dw_permanent = _inner(wx, wxt, wy, wyt, dx, dxt, dy, dyt)
    dv, dvt, dv_permanent = _inner(vx, vxt, vy, vyt, dx, dxt, dy, dyt)
    left, left_tail = dd_multiply(nw, nwt, dv, dvt)
    right, right_tail = dd_multiply(nv, nvt, dw, dwt)
    det, _ = dd_add(left, left_tail, -right, -right_tail)
    error = DD_BOUND * (nw_permanent * dv_permanent + nv_permanent * dw_permanent)
    if det > error:
        return 1
    if -det > error:
        return -1
    e, f, rest = k.scratch[0:1024], k.scratch[1024:2048], k.scratch[2048:]
    n_e = _term(wx, wxt, wy, wyt, cx, cxt, cy, cyt, vx, vxt, vy, vyt, dx, dxt, dy, dyt, e, rest)
    n_f = _term(vx, vxt, vy, vyt, cx, cxt, cy, cyt, wx, wxt, wy, wyt, dx, dxt, dy, dyt, f, rest)
    negate(f, n_f)
    return expansion_sign(rest, expansion_sum(e, n_e, f, n_f, rest))


@jit
def _nearest_coordinate(
    a: float, b: float, n: float, n_tail: float, n_error: float, det: float, det_tail: float, det_error: float
) -> tuple[float, bool]:
    """Return the double nearest to a + (b - a) n / det, and whether it is certain."""
    if a == b:
        return a, True
    d, d_tail = two_diff(b, a)
    p, p_tail = dd_multiply(n, n_tail, d, d_tail)
    if abs(p) < _SMALLEST_PRODUCT:
        return a, False
    error = n_error * abs(d) + DD_BOUND * abs(p)
    x, tail, error = quotient_offset(a, p, p_tail, 1.125 * error, det, det_tail, det_error)
    return x, abs(x) >= _SMALLEST_PRODUCT and is_nearest_certain(x, tail, error)


@jit
def bisector_crossing(
    k: Context, sx: float, sy: float, px: float, py: float, ax: float, ay: float, bx: float, by: float
) -> tuple[float, float, bool]:
    """Return the doubles nearest to where the line ab meets the bisector of s and p, and whether they are certain.

    The line must not be parallel to the bisector.
    """
    if k.incircle_bound == math.inf:
        return ax, ay, False
    wx, wxt = two_diff(px, sx)
    wy, wyt = two_diff(py, sy)
    cx, cxt = two_diff(sx, ax)
    cy, cyt = two_diff(sy, ay)
    dx, dxt = two_diff(bx, ax)
    dy, dyt = two_diff(by, ay)
    n, n_tail, n_permanent = _numerator(wx, wxt, wy, wyt, cx, cxt, cy, cyt)
    det, det_tail, det_permanent = _inner(wx, wxt, wy, wyt, dx, dxt, dy, dyt)
    n_error, det_error = DD_BOUND * n_permanent, 2.0 * DD_BOUND * det_permanent
    if det == 0.0 or det_error > _SMALL * abs(det):
        return ax, ay, False
    x, certain = _nearest_coordinate(ax, bx, n, n_tail, n_error, 2.0 * det, 2.0 * det_tail, det_error)
    if not certain:
        return x, ay, False
    y, certain = _nearest_coordinate(ay, by, n, n_tail, n_error, 2.0 * det, 2.0 * det_tail, det_error)
    return x, y, certain
