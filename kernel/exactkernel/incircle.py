"""incircle: does the fourth point lie inside the circle of the first three? And the tie broken by perturbation."""

import math

from exactkernel.codes import DECODED, DOUBLE_DOUBLE, EXPANSION, FILTER, GRID, RATIONAL
from exactkernel.constants import (
    DD_BOUND,
    INCIRCLE_BOUND,
    MAX_COORDINATE_DEGREE_4,
    MIN_COORDINATE_DEGREE_4,
)
from exactkernel.context import INCIRCLE_ROW, Context, thread_context
from exactkernel.coordinates import doubles_of, rationals_of
from exactkernel.doubledouble import dd_add, dd_multiply
from exactkernel.expansions import determinant_2x2, expansion_product, expansion_sign, expansion_sum, two_diff
from exactkernel.jit import jit, jit_inline
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import (
    RationalPoint,
    incircle_from_doubles,
    incircle_rational,
    orient2d_rational,
    raise_if_interrupted,
)
from exactkernel.types import FloatArray, PointLike, Sign, Stage

__all__ = [
    "incircle",
    "incircle_adaptive",
    "incircle_perturbed",
    "incircle_perturbed_adaptive",
    "incircle_staged",
]


@jit
def safe_degree_4(x: float) -> bool:
    """Tell whether the coordinate is zero or inside the window of degree 4."""
    return x == 0.0 or MIN_COORDINATE_DEGREE_4 <= abs(x) <= MAX_COORDINATE_DEGREE_4


@jit
def incircle_double_double(
    a: float,
    at: float,
    A: float,
    At: float,
    b: float,
    bt: float,
    B: float,
    Bt: float,
    c: float,
    ct: float,
    C: float,
    Ct: float,
) -> float:
    """Return the determinant of rows (a, A), (b, B), (c, C) (pairs) in double-double, rounded to one double."""
    bC, bCt = dd_multiply(b, bt, C, Ct)
    cB, cBt = dd_multiply(c, ct, B, Bt)
    cA, cAt = dd_multiply(c, ct, A, At)
    aC, aCt = dd_multiply(a, at, C, Ct)
    aB, aBt = dd_multiply(a, at, B, Bt)
    bA, bAt = dd_multiply(b, bt, A, At)
    u, ut = dd_add(bC, bCt, -cB, -cBt)
    v, vt = dd_add(cA, cAt, -aC, -aCt)
    w, wt = dd_add(aB, aBt, -bA, -bAt)
    u, ut = dd_multiply(u, ut, *lift_double_double(a, at, A, At))
    v, vt = dd_multiply(v, vt, *lift_double_double(b, bt, B, Bt))
    w, wt = dd_multiply(w, wt, *lift_double_double(c, ct, C, Ct))
    u, ut = dd_add(u, ut, v, vt)
    return dd_add(u, ut, w, wt)[0]


@jit
def lift_double_double(x: float, xt: float, y: float, yt: float) -> tuple[float, float]:
    """Return x^2 + y^2 of two pairs."""
    xx, xxt = dd_multiply(x, xt, x, xt)
    yy, yyt = dd_multiply(y, yt, y, yt)
    return dd_add(xx, xxt, yy, yyt)


@jit
def lifted_term(
    a: float,
    at: float,
    A: float,
    At: float,
    b: float,
    bt: float,
    B: float,
    Bt: float,
    c: float,
    ct: float,
    C: float,
    Ct: float,
    h: FloatArray,
    scratch: FloatArray,
) -> int:
    """Write (a^2 + A^2) (b C - c B) of exact pairs into h (512) as an expansion; uses 608 doubles of scratch."""
    cross, lift = scratch[0:16], scratch[16:32]
    n_cross = determinant_2x2(b, bt, C, Ct, c, ct, B, Bt, cross, scratch[32:64])
    n_lift = determinant_2x2(a, at, a, at, A, At, -A, -At, lift, scratch[32:64])
    return expansion_product(cross, n_cross, lift, n_lift, h, scratch[64:96], scratch[96:608])


@jit
def incircle_expansion(
    a: float,
    at: float,
    A: float,
    At: float,
    b: float,
    bt: float,
    B: float,
    Bt: float,
    c: float,
    ct: float,
    C: float,
    Ct: float,
    scratch: FloatArray,
) -> int:
    """Return the exact sign of the determinant of rows (a, A), (b, B), (c, C), all exact pairs."""
    term, sum_2, sum_3, rest = scratch[0:512], scratch[512:1024], scratch[1024:2048], scratch[2048:2656]
    total = scratch[2656:4192]
    n_2 = lifted_term(a, at, A, At, b, bt, B, Bt, c, ct, C, Ct, sum_2, rest)
    n = lifted_term(b, bt, B, Bt, c, ct, C, Ct, a, at, A, At, term, rest)
    n_3 = expansion_sum(sum_2, n_2, term, n, sum_3)
    n = lifted_term(c, ct, C, Ct, a, at, A, At, b, bt, B, Bt, term, rest)
    return expansion_sign(total, expansion_sum(sum_3, n_3, term, n, total))


@jit_inline
def determinant_and_permanent(a: float, A: float, b: float, B: float, c: float, C: float) -> tuple[float, float]:
    """Return the determinant of rows (a, A, a^2 + A^2), ..., and the same sum with every term taken absolutely."""
    bC, cB, cA, aC, aB, bA = b * C, c * B, c * A, a * C, a * B, b * A
    lift_a, lift_b, lift_c = a * a + A * A, b * b + B * B, c * c + C * C
    det = lift_a * (bC - cB) + lift_b * (cA - aC) + lift_c * (aB - bA)
    permanent = (
        (abs(bC) + abs(cB)) * lift_a + (abs(cA) + abs(aC)) * lift_b + (abs(aB) + abs(bA)) * lift_c
    )  # fmt: skip
    return det, permanent


@jit_inline
def incircle_filter(
    bound: float, ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float
) -> int:
    """Return the sign of incircle if the error bound certifies it, else 0."""
    det, permanent = determinant_and_permanent(ax - dx, ay - dy, bx - dx, by - dy, cx - dx, cy - dy)
    error = bound * permanent
    return 1 if det > error else (-1 if -det > error else 0)


@jit
def on_common_grid(a: float, b: float, c: float, d: float, e: float, f: float) -> bool:
    """Tell whether the numbers are multiples of a power of two that is at least 2^-12 of the largest: see GRID_STEPS.

    Adding 1.5 * 2^52 grid units and taking them away again rounds to a multiple of the unit.
    """
    largest = max(max(max(abs(a), abs(b)), max(abs(c), abs(d))), max(abs(e), abs(f)))
    shift = math.ldexp(1.5, math.frexp(largest)[1] + 40)
    return bool(
        (a + shift) - shift == a
        and (b + shift) - shift == b
        and (c + shift) - shift == c
        and (d + shift) - shift == d
        and (e + shift) - shift == e
        and (f + shift) - shift == f
    )


@jit
def incircle_slow(
    k: Context, ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float
) -> int:
    """Return stage * 4 + sign + 1 for a call that the filter of the loop did not decide."""
    if k.incircle_bound == math.inf:  # outside the window: guard this call by itself
        if not (
            safe_degree_4(ax) and safe_degree_4(ay) and safe_degree_4(bx) and safe_degree_4(by)
            and safe_degree_4(cx) and safe_degree_4(cy) and safe_degree_4(dx) and safe_degree_4(dy)
        ):  # fmt: skip
            return RATIONAL + incircle_from_doubles(k.mailbox, ax, ay, bx, by, cx, cy, dx, dy)
        sign = incircle_filter(INCIRCLE_BOUND, ax, ay, bx, by, cx, cy, dx, dy)
        if sign != 0:
            return FILTER + sign
    a, at = two_diff(ax, dx)
    A, At = two_diff(ay, dy)
    b, bt = two_diff(bx, dx)
    B, Bt = two_diff(by, dy)
    c, ct = two_diff(cx, dx)
    C, Ct = two_diff(cy, dy)
    det, permanent = determinant_and_permanent(a, A, b, B, c, C)
    is_exact = at == 0.0 and At == 0.0 and bt == 0.0 and Bt == 0.0 and ct == 0.0 and Ct == 0.0
    within = max(max(max(abs(a), abs(A)), max(abs(b), abs(B))), max(abs(c), abs(C))) <= k.grid_limit
    if within or (is_exact and on_common_grid(a, A, b, B, c, C)):
        return GRID + (1 if det > 0.0 else (-1 if det < 0.0 else 0))
    det = incircle_double_double(a, at, A, At, b, bt, B, Bt, c, ct, C, Ct)
    bound = DD_BOUND * permanent
    if det > bound:
        return DOUBLE_DOUBLE + 1
    if -det > bound:
        return DOUBLE_DOUBLE - 1
    return EXPANSION + incircle_expansion(a, at, A, At, b, bt, B, Bt, c, ct, C, Ct, k.scratch)


@jit
def incircle_exact(
    k: Context, ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float
) -> int:
    """Return the sign that the filter could not certify, and tally the stage that did."""
    code = incircle_slow(k, ax, ay, bx, by, cx, cy, dx, dy)
    k.counts[INCIRCLE_ROW, code >> 2] += 1
    return (code & 3) - 1


@jit_inline
def incircle_adaptive(
    k: Context, ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float
) -> int:
    """Return the exact sign of incircle in a compiled loop; tallies the stage in ``k.counts``."""
    sign = incircle_filter(k.incircle_bound, ax, ay, bx, by, cx, cy, dx, dy)
    if sign != 0:
        k.counts[INCIRCLE_ROW, 0] += 1
        return sign
    return incircle_exact(k, ax, ay, bx, by, cx, cy, dx, dy)


@jit
def before(ax: float, ay: float, bx: float, by: float) -> bool:
    """Tell whether a comes before b in lexicographic order."""
    return ax < bx or (ax == bx and ay < by)


@jit_inline
def same(ax: float, ay: float, bx: float, by: float) -> bool:
    """Tell whether a and b are one point."""
    return ax == bx and ay == by


@jit
def cofactor(
    k: Context, i: int, ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float
) -> int:
    """Return the sign of d incircle / d lift of the point at position i: orient2d of the other three."""
    if i == 0:
        return orient2d_adaptive(k, bx, by, cx, cy, dx, dy)
    if i == 1:
        return -orient2d_adaptive(k, ax, ay, cx, cy, dx, dy)
    if i == 2:
        return orient2d_adaptive(k, ax, ay, bx, by, dx, dy)
    return -orient2d_adaptive(k, ax, ay, bx, by, cx, cy)


@jit
def break_tie(
    k: Context, ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float
) -> int:
    """Return the sign of incircle, where it vanishes, with infinitesimal lifts, the smallest point's the largest.

    Four distinct cocircular points have no three collinear, so the cofactor of the lexicographically smallest point
    decides, or all four are collinear and every cofactor vanishes. The lift belongs to the point: where two coincide,
    two rows of the determinant are the same; only the smallest point's own cofactor does not say so.
    """
    i, x, y = 0, ax, ay
    if before(bx, by, x, y):
        i, x, y = 1, bx, by
    if before(cx, cy, x, y):
        i, x, y = 2, cx, cy
    if before(dx, dy, x, y):
        i, x, y = 3, dx, dy
    if (
        (i != 0 and same(ax, ay, x, y)) or (i != 1 and same(bx, by, x, y))
        or (i != 2 and same(cx, cy, x, y)) or (i != 3 and same(dx, dy, x, y))
    ):  # fmt: skip
        return 0
    return cofactor(k, i, ax, ay, bx, by, cx, cy, dx, dy)


@jit
def incircle_perturbed_exact(
    k: Context, ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float
) -> int:
    """Return the perturbed sign that the filter could not certify, and tally the stage that did."""
    sign = incircle_exact(k, ax, ay, bx, by, cx, cy, dx, dy)
    if sign != 0:
        return sign
    return break_tie(k, ax, ay, bx, by, cx, cy, dx, dy)


@jit_inline
def incircle_perturbed_adaptive(
    k: Context, ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float
) -> int:
    """Return the sign of incircle in a compiled loop, ties broken by :func:`break_tie`."""
    sign = incircle_filter(k.incircle_bound, ax, ay, bx, by, cx, cy, dx, dy)
    if sign != 0:
        k.counts[INCIRCLE_ROW, 0] += 1
        return sign
    return incircle_perturbed_exact(k, ax, ay, bx, by, cx, cy, dx, dy)


def incircle_staged(a: PointLike, b: PointLike, c: PointLike, d: PointLike) -> tuple[Sign, Stage]:
    """Return the sign of :func:`incircle` and the stage that decided it. Arguments and errors as there.

    >>> from exactkernel import incircle_staged
    >>> incircle_staged((0, 0), (1, 0), (1, 1), (0, 1))
    (<Sign.ZERO: 0>, <Stage.GRID: 1>)
    """
    doubles = doubles_of(a, b, c, d)
    if doubles is None:
        pa, pb, pc, pd = rationals_of(a, b, c, d)
        return Sign(incircle_rational(pa, pb, pc, pd)), Stage.RATIONAL
    code = incircle_slow(thread_context(), *doubles)
    raise_if_interrupted()
    return DECODED[code]


def incircle(a: PointLike, b: PointLike, c: PointLike, d: PointLike) -> Sign:
    """Return on which side of the circle through a, b, c the point d lies, exactly.

    ============  ===================================================
    ``POSITIVE``  d inside the circle of counterclockwise a, b, c
    ``ZERO``      the four points lie on one circle (or line)
    ``NEGATIVE``  d outside
    ============  ===================================================

    For clockwise a, b, c the signs are reversed. Points are pairs of int, float, numpy scalar, Fraction, mpz or mpq.

    Raises:
        NonFiniteError: a coordinate is NaN or infinite.
        CoordinateError: a coordinate is no number.
        ShapeError: a point is no pair.

    Constant time for doubles. Reference [Shewchuk 1997].

    >>> from exactkernel import incircle
    >>> incircle((0, 0), (1, 0), (1, 1), (0.5, 0.5))
    <Sign.POSITIVE: 1>
    >>> incircle((0, 0), (1, 0), (1, 1), (0, 1))
    <Sign.ZERO: 0>
    """
    return incircle_staged(a, b, c, d)[0]


def _perturbed_rational(points: list[RationalPoint]) -> int:
    sign = incircle_rational(points[0], points[1], points[2], points[3])
    smallest = min(points)
    if sign != 0 or points.count(smallest) > 1:
        return sign
    i = points.index(smallest)  # see break_tie
    others = points[:i] + points[i + 1 :]
    turn = orient2d_rational(others[0], others[1], others[2])
    return -turn if i % 2 else turn


def incircle_perturbed(a: PointLike, b: PointLike, c: PointLike, d: PointLike) -> Sign:
    """Return :func:`incircle` with ties broken, so that the Delaunay triangulation is unique.

    Every point is lifted by an infinitesimal of its own, the lexicographically smallest point by the largest. The
    answer is ZERO where two points coincide or all four lie on one line, and nowhere else. Arguments and errors as for
    incircle.

    Constant time for doubles. Reference [Edelsbrunner 1990], [Devillers 2011].

    >>> from exactkernel import incircle_perturbed
    >>> incircle_perturbed((0, 0), (1, 0), (1, 1), (0, 1))
    <Sign.POSITIVE: 1>
    >>> incircle_perturbed((1, 0), (1, 1), (0, 1), (0, 0))
    <Sign.NEGATIVE: -1>
    """
    doubles = doubles_of(a, b, c, d)
    if doubles is None:
        return Sign(_perturbed_rational(rationals_of(a, b, c, d)))
    sign = incircle_perturbed_adaptive(thread_context(), *doubles)
    raise_if_interrupted()
    return Sign(sign)
