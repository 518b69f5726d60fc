"""diametral: does a point lie inside the circle that has a segment as its diameter (is the segment encroached)?"""

import math

from exactkernel.codes import DECODED, FILTER, GRID, RATIONAL
from exactkernel.constants import ORIENT2D_BOUND
from exactkernel.context import ORIENT2D_ROW, Context, thread_context
from exactkernel.coordinates import doubles_of, rationals_of
from exactkernel.expansions import two_diff
from exactkernel.jit import jit, jit_inline
from exactkernel.orient2d import products_difference, safe_degree_2
from exactkernel.rational import diametral_from_doubles, diametral_rational, raise_if_interrupted
from exactkernel.types import PointLike, Sign, Stage

__all__ = ["diametral", "diametral_adaptive", "diametral_staged"]


@jit_inline
def diametral_filter(bound: float, ax: float, ay: float, bx: float, by: float, px: float, py: float) -> int:
    """Return the sign of diametral if the error bound certifies it, else 0."""
    left = (px - ax) * (bx - px)
    right = (py - ay) * (py - by)
    det = left - right
    error = bound * (abs(left) + abs(right))
    return 1 if det > error else (-1 if -det > error else 0)


@jit
def diametral_slow(c: Context, ax: float, ay: float, bx: float, by: float, px: float, py: float) -> int:
    """Return stage * 4 + sign + 1 for a call that the filter of the loop did not decide."""
    p, q, r, s = px - ax, bx - px, py - ay, py - by
    if c.orient2d_bound == math.inf:  # outside the window: guard this call by itself
        if not (
            safe_degree_2(ax) and safe_degree_2(ay) and safe_degree_2(bx)
            and safe_degree_2(by) and safe_degree_2(px) and safe_degree_2(py)
        ):  # fmt: skip
            return RATIONAL + diametral_from_doubles(c.mailbox, ax, ay, bx, by, px, py)
        sign = diametral_filter(ORIENT2D_BOUND, ax, ay, bx, by, px, py)
        if sign != 0:
            return FILTER + sign
    elif max(max(abs(p), abs(q)), max(abs(r), abs(s))) <= c.grid_limit:
        det = p * q - r * s
        return GRID + (1 if det > 0.0 else (-1 if det < 0.0 else 0))
    p, p_tail = two_diff(px, ax)
    q, q_tail = two_diff(bx, px)
    r, r_tail = two_diff(py, ay)
    s, s_tail = two_diff(py, by)
    return products_difference(p, p_tail, q, q_tail, r, r_tail, s, s_tail, c.scratch)


@jit
def diametral_exact(c: Context, ax: float, ay: float, bx: float, by: float, px: float, py: float) -> int:
    """Return the sign that the filter could not certify, and tally the stage that did."""
    code = diametral_slow(c, ax, ay, bx, by, px, py)
    c.counts[ORIENT2D_ROW, code >> 2] += 1
    return (code & 3) - 1


@jit_inline
def diametral_adaptive(c: Context, ax: float, ay: float, bx: float, by: float, px: float, py: float) -> int:
    """Return the exact sign of diametral in a compiled loop; tallies the stage in ``c.counts``."""
    sign = diametral_filter(c.orient2d_bound, ax, ay, bx, by, px, py)
    if sign != 0:
        c.counts[ORIENT2D_ROW, 0] += 1
        return sign
    return diametral_exact(c, ax, ay, bx, by, px, py)


def diametral_staged(a: PointLike, b: PointLike, p: PointLike) -> tuple[Sign, Stage]:
    """Return the sign of :func:`diametral` and the stage that decided it. Arguments and errors as there.

    >>> from exactkernel import diametral_staged
    >>> diametral_staged((0, 0), (2, 0), (1, 0.5))
    (<Sign.POSITIVE: 1>, <Stage.FILTER: 0>)
    """
    doubles = doubles_of(a, b, p)
    if doubles is None:
        pa, pb, pp = rationals_of(a, b, p)
        return Sign(diametral_rational(pa, pb, pp)), Stage.RATIONAL
    code = diametral_slow(thread_context(), *doubles)
    raise_if_interrupted()
    return DECODED[code]


def diametral(a: PointLike, b: PointLike, p: PointLike) -> Sign:
    """Return on which side of the circle with diameter ab the point p lies, exactly.

    ============  ==============================================================
    ``POSITIVE``  p inside: it sees ab under an obtuse angle and encroaches on it
    ``ZERO``      on the circle
    ``NEGATIVE``  outside
    ============  ==============================================================

    Points are pairs of int, float, numpy scalar, Fraction, mpz or mpq, mixed as they come; nothing is rounded.

    Raises:
        NonFiniteError: a coordinate is NaN or infinite.
        CoordinateError: a coordinate is no number.
        ShapeError: a point is no pair.

    Constant time for doubles. Reference [Ruppert 1995].

    >>> from exactkernel import diametral
    >>> diametral((0, 0), (2, 0), (1, 1))
    <Sign.ZERO: 0>
    """
    return diametral_staged(a, b, p)[0]
