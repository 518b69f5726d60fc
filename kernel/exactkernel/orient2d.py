"""orient2d: do three points turn left, turn right, or lie on a line?"""

import math

from exactkernel.codes import DECODED, DOUBLE_DOUBLE, EXPANSION, FILTER, GRID, RATIONAL
from exactkernel.constants import (
    DD_BOUND,
    MAX_COORDINATE_DEGREE_2,
    MIN_COORDINATE_DEGREE_2,
    ORIENT2D_BOUND,
)
from exactkernel.context import ORIENT2D_ROW, Context, thread_context
from exactkernel.coordinates import doubles_of, rationals_of
from exactkernel.doubledouble import dd_add, dd_multiply
from exactkernel.expansions import determinant_2x2, expansion_sign, two_diff
from exactkernel.jit import jit, jit_inline
from exactkernel.rational import orient2d_from_doubles, orient2d_rational, raise_if_interrupted
from exactkernel.types import FloatArray, PointLike, Sign, Stage

__all__ = ["orient2d", "orient2d_adaptive", "orient2d_staged"]


@jit
def safe_degree_2(x: float) -> bool:
    """Tell whether the coordinate is zero or inside the window of degree 2."""
    return x == 0.0 or MIN_COORDINATE_DEGREE_2 <= abs(x) <= MAX_COORDINATE_DEGREE_2


@jit
def products_difference(
    p: float,
    p_tail: float,
    q: float,
    q_tail: float,
    r: float,
    r_tail: float,
    s: float,
    s_tail: float,
    scratch: FloatArray,
) -> int:
    """Return stage * 4 + sign + 1 of p q - r s for exact pairs: double-double, then expansions."""
    left, left_tail = dd_multiply(p, p_tail, q, q_tail)
    right, right_tail = dd_multiply(r, r_tail, s, s_tail)
    det, _ = dd_add(left, left_tail, -right, -right_tail)
    bound = DD_BOUND * (abs(left) + abs(right))
    if det > bound:
        return DOUBLE_DOUBLE + 1
    if -det > bound:
        return DOUBLE_DOUBLE - 1
    h = scratch[0:16]
    n = determinant_2x2(p, p_tail, q, q_tail, r, r_tail, s, s_tail, h, scratch[16:])
    return EXPANSION + expansion_sign(h, n)


@jit_inline
def orient2d_filter(bound: float, ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    """Return the sign of orient2d if the error bound certifies it, else 0."""
    left = (ax - cx) * (by - cy)
    right = (ay - cy) * (bx - cx)
    det = left - right
    error = bound * (abs(left) + abs(right))
    return 1 if det > error else (-1 if -det > error else 0)


@jit
def orient2d_slow(c: Context, ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    """Return stage * 4 + sign + 1 for a call that the filter of the loop did not decide."""
    p, q, r, s = ax - cx, by - cy, ay - cy, bx - cx
    if c.orient2d_bound == math.inf:  # outside the window: guard this call by itself
        if not (
            safe_degree_2(ax) and safe_degree_2(ay) and safe_degree_2(bx)
            and safe_degree_2(by) and safe_degree_2(cx) and safe_degree_2(cy)
        ):  # fmt: skip
            return RATIONAL + orient2d_from_doubles(c.mailbox, ax, ay, bx, by, cx, cy)
        sign = orient2d_filter(ORIENT2D_BOUND, ax, ay, bx, by, cx, cy)
        if sign != 0:
            return FILTER + sign
    elif max(max(abs(p), abs(q)), max(abs(r), abs(s))) <= c.grid_limit:
        det = p * q - r * s
        return GRID + (1 if det > 0.0 else (-1 if det < 0.0 else 0))
    p, p_tail = two_diff(ax, cx)
    q, q_tail = two_diff(by, cy)
    r, r_tail = two_diff(ay, cy)
    s, s_tail = two_diff(bx, cx)
    return products_difference(p, p_tail, q, q_tail, r, r_tail, s, s_tail, c.scratch)


@jit
def orient2d_exact(c: Context, ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    """Return the sign that the filter could not certify, and tally the stage that did."""
    code = orient2d_slow(c, ax, ay, bx, by, cx, cy)
    c.counts[ORIENT2D_ROW, code >> 2] += 1
    return (code & 3) - 1


@jit_inline
def orient2d_adaptive(c: Context, ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    """Return the exact sign of orient2d in a compiled loop; tallies the stage in ``c.counts``."""
    sign = orient2d_filter(c.orient2d_bound, ax, ay, bx, by, cx, cy)
    if sign != 0:
        c.counts[ORIENT2D_ROW, 0] += 1
        return sign
    return orient2d_exact(c, ax, ay, bx, by, cx, cy)


def orient2d_staged(a: PointLike, b: PointLike, c: PointLike) -> tuple[Sign, Stage]:
    """Return the sign of :func:`orient2d` and the stage that decided it. Arguments and errors as there.

    >>> from exactkernel import orient2d_staged
    >>> orient2d_staged((0, 0), (1, 0), (0, 1))
    (<Sign.POSITIVE: 1>, <Stage.FILTER: 0>)
    >>> orient2d_staged((0.1, 0.1), (0.2, 0.2), (0.3, 0.3))
    (<Sign.ZERO: 0>, <Stage.EXPANSION: 3>)
    """
    doubles = doubles_of(a, b, c)
    if doubles is None:
        pa, pb, pc = rationals_of(a, b, c)
        return Sign(orient2d_rational(pa, pb, pc)), Stage.RATIONAL
    code = orient2d_slow(thread_context(), *doubles)
    raise_if_interrupted()
    return DECODED[code]


def orient2d(a: PointLike, b: PointLike, c: PointLike) -> Sign:
    """Return the orientation of three points, exactly.

    ============  ===========================================
    ``POSITIVE``  a, b, c turn counterclockwise (y up)
    ``ZERO``      a, b, c lie on one line
    ``NEGATIVE``  a, b, c turn clockwise
    ============  ===========================================

    Points are pairs of int, float, numpy scalar, Fraction, mpz or mpq, mixed as they come; nothing is rounded.

    Raises:
        NonFiniteError: a coordinate is NaN or infinite.
        CoordinateError: a coordinate is no number.
        ShapeError: a point is no pair.

    Constant time for doubles. Reference [Shewchuk 1997].

    >>> from fractions import Fraction
    >>> from exactkernel import orient2d
    >>> orient2d((0, 0), (1, 0), (0.5, 1e-300))
    <Sign.POSITIVE: 1>
    >>> orient2d((0, 0), (3, 1), (1, Fraction(1, 3)))
    <Sign.ZERO: 0>
    """
    return orient2d_staged(a, b, c)[0]
