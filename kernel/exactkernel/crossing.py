"""The crossing of two segments as doubles in compiled loops: double-double with a certified bound.

The crossing of ab and cd is a + (num / det) (b - a) with num = (c - a) x (d - c) and det = (b - a) x (d - c). Both
determinants are double-doubles of exact differences, so they err by at most DD_BOUND times their permanents; products,
quotient and sum add relative errors of 7, 15 and 3 u^2 [Joldes 2017]. What the bound leaves open, such as a coordinate
half-way between two doubles, is for the rationals (:func:`exactkernel.constructions.segment_crossing`) to decide.
"""

import math

from exactkernel.constants import (
    DD_BOUND,
    MAX_COORDINATE_DEGREE_4,
    MIN_COORDINATE_DEGREE_4,
    UNIT_ROUNDOFF,
)
from exactkernel.context import Context
from exactkernel.doubledouble import dd_add, dd_multiply
from exactkernel.expansions import (
    determinant_2x2,
    expansion_product,
    expansion_sum,
    fast_two_sum,
    negate,
    pair,
    two_diff,
)
from exactkernel.jit import jit
from exactkernel.types import FloatArray

__all__ = ["crossing_in_pairs", "dd_cross", "is_nearest_certain"]

#: A relative error of det up to which first-order error propagation, times _SLACK, covers the quotient.
_SMALL = 2.0**-10
#: 1 / (1 - 2^-10) and the roundings of the bounds themselves: a few hundred units of u at most.
_SLACK = 1.125
#: Below, num (b - a) may lose bits to underflow: a product of doubles is exact for exponents from -970 on. From there
#: on, what else underflows, bounds of errors included, is nothing beside DD_BOUND times the product or the quotient.
_SMALLEST_PRODUCT = 2.0**-900
#: What is within e of a number whose magnitude is at most e as well, rounded: the sum and this product round by u each.
_TWICE = 2.0 + 4.0 * UNIT_ROUNDOFF


@jit
def dd_cross(
    p: float, p_tail: float, q: float, q_tail: float, r: float, r_tail: float, s: float, s_tail: float
) -> tuple[float, float, float]:
    """Return (high, low, error bound) of p q - r s for exact pairs, inside the window of degree 2."""
    left, left_tail = dd_multiply(p, p_tail, q, q_tail)
    right, right_tail = dd_multiply(r, r_tail, s, s_tail)
    high, low = dd_add(left, left_tail, -right, -right_tail)
    return high, low, DD_BOUND * (abs(left) + abs(right))


@jit
def _is_safe(x: float) -> bool:
    return x == 0.0 or MIN_COORDINATE_DEGREE_4 <= abs(x) <= MAX_COORDINATE_DEGREE_4


@jit
def _coordinate(
    a: float,
    u: float,
    u_tail: float,
    c: float,
    v: float,
    num: float,
    num_tail: float,
    num_error: float,
    det: float,
    det_tail: float,
    det_error: float,
) -> tuple[float, float, float]:
    """Return (high, low, error bound) of a + (num / det) u, or of c if that coordinate is constant along cd."""
    if u == 0.0:
        return a, 0.0, 0.0
    if v == 0.0:
        return c, 0.0, 0.0
    p, p_tail = dd_multiply(num, num_tail, u, u_tail)
    if abs(p) < _SMALLEST_PRODUCT:
        return a, 0.0, math.inf
    high = p / det
    if abs(high) < _SMALLEST_PRODUCT:
        return a, 0.0, math.inf
    m, m_tail = dd_multiply(det, det_tail, high, 0.0)
    q, q_tail = fast_two_sum(high, ((p - m) + (p_tail - m_tail)) / det)
    error = num_error * abs(u / det) + abs(q) * (det_error / abs(det) + DD_BOUND)
    x, x_tail = dd_add(a, 0.0, q, q_tail)
    return x, x_tail, _SLACK * (error + DD_BOUND * abs(x))


@jit
def is_nearest_certain(x: float, tail: float, error: float) -> bool:
    """Tell whether x is the double nearest to every number within the error of x + tail."""
    margin = error + 4.0 * UNIT_ROUNDOFF * (abs(tail) + error)
    return bool(x + (tail + margin) == x and x + (tail - margin) == x)


@jit
def _is_exact(
    x: float,
    a: float,
    u: float,
    u_tail: float,
    det: FloatArray,
    n_det: int,
    num: FloatArray,
    n_num: int,
    scratch: FloatArray,
) -> bool:
    """Tell whether x = a + (num / det) u exactly, by expansions; uses 354 doubles of scratch."""
    if not _is_safe(x):
        return False
    f, scaled, total = scratch[0:2], scratch[2:34], scratch[34:98]
    left, right, difference = scratch[98:162], scratch[162:226], scratch[226:354]
    step, step_tail = two_diff(x, a)
    n_left = expansion_product(det, n_det, f, pair(step, step_tail, f), left, scaled, total)
    n_right = expansion_product(num, n_num, f, pair(u, u_tail, f), right, scaled, total)
    negate(right, n_right)
    return expansion_sum(left, n_left, right, n_right, difference) == 0


@jit
def _zero_if_possible(x: float, tail: float, error: float) -> tuple[float, float, float]:
    """Return zero if it is within the bounds: doubles are so dense there that no bound would ever single it out."""
    magnitude = abs(x) + abs(tail)
    if magnitude <= error < math.inf:
        return 0.0, 0.0, _TWICE * error
    return x, tail, error


@jit
def crossing_in_pairs(
    k: Context, ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float
) -> tuple[float, float, float, float, float, float]:
    """Return (x, x tail, x error, y, y tail, y error) of the crossing of ab and cd, which must not be parallel.

    The exact coordinate differs from x + tail by at most the error: 0 where it is exact, infinite where nothing is
    known.
    """
    inf = math.inf
    if k.incircle_bound == inf and not (
        _is_safe(ax) and _is_safe(ay) and _is_safe(bx) and _is_safe(by)
        and _is_safe(cx) and _is_safe(cy) and _is_safe(dx) and _is_safe(dy)
    ):  # fmt: skip
        return ax, 0.0, inf, ay, 0.0, inf
    ux, ux_tail = two_diff(bx, ax)
    uy, uy_tail = two_diff(by, ay)
    vx, vx_tail = two_diff(dx, cx)
    vy, vy_tail = two_diff(dy, cy)
    wx, wx_tail = two_diff(cx, ax)
    wy, wy_tail = two_diff(cy, ay)
    det, det_tail, det_error = dd_cross(ux, ux_tail, vy, vy_tail, uy, uy_tail, vx, vx_tail)
    num, num_tail, num_error = dd_cross(wx, wx_tail, vy, vy_tail, wy, wy_tail, vx, vx_tail)
    if det_error > _SMALL * abs(det):
        return ax, 0.0, inf, ay, 0.0, inf
    x, x_tail, x_error = _coordinate(
        ax, ux, ux_tail, cx, vx, num, num_tail, num_error, det, det_tail, det_error
    )  # fmt: skip
    y, y_tail, y_error = _coordinate(
        ay, uy, uy_tail, cy, vy, num, num_tail, num_error, det, det_tail, det_error
    )  # fmt: skip
    if not (is_nearest_certain(x, x_tail, x_error) and is_nearest_certain(y, y_tail, y_error)):
        exact_det, exact_num, scratch = k.scratch[0:16], k.scratch[16:32], k.scratch[32:]
        n_det = determinant_2x2(ux, ux_tail, vy, vy_tail, uy, uy_tail, vx, vx_tail, exact_det, scratch)
        n_num = determinant_2x2(wx, wx_tail, vy, vy_tail, wy, wy_tail, vx, vx_tail, exact_num, scratch)
        x, x_tail, x_error = _zero_if_possible(x, x_tail, x_error)
        y, y_tail, y_error = _zero_if_possible(y, y_tail, y_error)
        if _is_exact(x, ax, ux, ux_tail, exact_det, n_det, exact_num, n_num, scratch):
            x_tail = x_error = 0.0
        if _is_exact(y, ay, uy, uy_tail, exact_det, n_det, exact_num, n_num, scratch):
            y_tail = y_error = 0.0
    return x, x_tail, x_error, y, y_tail, y_error
