"""Where to split a segment: in a double that lies exactly on it if there is one near the wanted place.

The point at the parameter s of ab is a + s (b - a). Let v be the lowest bit of bx - ax, a power of two. For
s = k / 2^m with k odd, the coordinate is an odd multiple of v / 2^m, unless ax and bx share bits below that; in both
cases it is a double exactly if its magnitude is at most 2^53 v / 2^m. So each halving costs a bit, and a segment whose
ends are on a grid of few bits can be halved many times. The search takes the parameter with the fewest bits for that
reason, not the nearest one: what it leaves are bits for the halves.
"""

import math

from exactkernel.expansions import fast_two_sum, two_diff, two_product, two_sum
from exactkernel.jit import jit

__all__ = ["split_point"]

_DIGITS = 9007199254740992.0  # 2^53
_FINEST = 4503599627370496.0  # 2^52: parameters are multiples of 2^-52
_SLACK = 2.0**-48  # covers the roundings of a bound

# Inside, s (b - a) is an exact pair, whatever s: its tail is a multiple of 2^-52 times the lowest bit of b - a, and
# Veltkamp's split has room. The window of the predicates of degree 4 is far inside.
_LARGEST = 2.0**900
_SMALLEST = 2.0**-900


@jit
def _lowest_bit(x: float) -> float:
    """Return the largest power of two that divides the nonzero double x."""
    mantissa, exponent = math.frexp(abs(x))
    digits = int(mantissa * _DIGITS)
    return math.ldexp(float(digits & -digits), exponent - 53)


@jit
def _along(a: float, d: float, d_tail: float, s: float) -> tuple[float, float]:
    """Return (high, low) of a + s (d + d_tail): low is 0 if and only if high is it exactly; else high + low errs by
    less than an ulp.

    The sum is taken exactly, as a nonoverlapping expansion, by increasing magnitude; then gathered from the top. Once
    low is not 0, what is still to come is less than the lowest bit of low, and cannot cancel it.
    """
    p, p_tail = two_product(s, d)
    h0 = h1 = 0.0
    if d_tail == 0.0:
        carry, h2 = two_sum(a, p_tail)
        h4, h3 = two_sum(carry, p)
    else:
        q, q_tail = two_product(s, d_tail)
        carry, f0 = two_sum(q_tail, p_tail)
        f2, f1 = two_sum(carry, p)
        carry, g0 = two_sum(q, f0)
        carry, g1 = two_sum(carry, f1)
        g3, g2 = two_sum(carry, f2)
        carry, h0 = two_sum(a, g0)
        carry, h1 = two_sum(carry, g1)
        carry, h2 = two_sum(carry, g2)
        h4, h3 = two_sum(carry, g3)
    high, low = h4, 0.0
    for h in (h3, h2, h1, h0):
        if low == 0.0:
            high, low = fast_two_sum(high, h)
        else:
            low += h
    return high, low


@jit
def _is_multiple(x: float, unit: float) -> bool:
    steps = x / unit
    return abs(x) >= _FINEST * unit or steps == float(math.floor(steps))


@jit
def _is_safe(a: float, b: float, d: float, d_tail: float) -> bool:
    return bool(
        max(abs(a), abs(b)) <= _LARGEST
        and (d == 0.0 or abs(d) >= _SMALLEST)
        and (d_tail == 0.0 or abs(d_tail) >= _SMALLEST)
    )


@jit
def _most_halves(a: float, d: float, d_tail: float, low: float, high: float) -> float:
    """Return a bound of 2^m for which a + k / 2^m (d + d_tail) may be a double, for low < k / 2^m < high."""
    if d == 0.0:
        return _FINEST
    first, last = a + low * d, a + high * d
    nearest = 0.0
    if (first > 0.0) == (last > 0.0):
        nearest = min(abs(first), abs(last)) - _SLACK * (abs(a) + abs(d))
    limit = _DIGITS * _lowest_bit(d if d_tail == 0.0 else d_tail)
    return limit / nearest if nearest * _FINEST > limit else _FINEST


@jit
def _rounded(a: float, b: float, d: float, d_tail: float, t: float, unit: float) -> float:
    """Return a + t (b - a), rounded to a double that is a multiple of the unit, between a and b."""
    if d == 0.0:
        return a
    if max(abs(a), abs(b)) <= _LARGEST:
        high, low = _along(a, d, d_tail, t)
        x = high + low
    else:
        x = (1.0 - t) * a + t * b
    if abs(x) < _FINEST * unit:
        x = float(math.floor(x / unit + 0.5)) * unit
    return min(max(x, min(a, b)), max(a, b))


@jit
def split_point(
    ax: float, ay: float, bx: float, by: float, t: float, slack: float, unit: float
) -> tuple[float, float, bool]:
    """Return (x, y, exact): where to split the segment ab near a + t (b - a).

    If a double point lies exactly on ab at a dyadic parameter next to t, not farther than ``slack`` from it, that is
    the point, and ``exact`` is True. Dyadic parameters next to t are the multiples k / 2^m of 2^-m, m = 1 to 52, before
    and after t (or t itself); the smallest m wins, which leaves the most bits to split the halves exactly as well. A
    smaller ``slack`` keeps the point nearer.

    Otherwise it is the point at t itself, each coordinate rounded with an error below one ulp (and half a unit where
    the unit is coarser), and ``exact`` is False. It lies in the closed box of a and b; a coordinate that a and b share
    is kept. It may be a or b itself, when no other double is nearer: there is nothing to split then.

    Args:
        ax, ay, bx, by: a and b, different, multiples of ``unit``.
        t: the wanted parameter, 0 < t < 1.
        slack: the largest difference of parameters, not negative.
        unit: a power of two; the coordinates returned are multiples of it.

    Coordinates beyond 2^900, or that differ by less than 2^-900: the point is never claimed to be exact, and errs by
    some ulps of the larger end. Constant time; allocates nothing.

    >>> from exactmesh.refinement.split_point import split_point
    >>> split_point(0.0, 0.0, 3.0, 1.0, 0.4, 0.2, 2.0**-268)
    (1.5, 0.5, True)
    >>> split_point(0.0, 0.0, 3.0, 1.0, 0.4, 0.05, 2.0**-268)
    (1.125, 0.375, True)
    >>> split_point(1.0, 1.0, 2.0, 1.0 + 2.0**-52, 0.5, 0.25, 2.0**-268)
    (1.5, 1.0, False)
    """
    dx, dx_tail = two_diff(bx, ax)
    dy, dy_tail = two_diff(by, ay)
    if _is_safe(ax, bx, dx, dx_tail) and _is_safe(ay, by, dy, dy_tail):
        low, high = max(t - slack, 0.0), min(t + slack, 1.0)
        most = min(_most_halves(ax, dx, dx_tail, low, high), _most_halves(ay, dy, dy_tail, low, high))
        halves = 2.0
        while halves <= most:
            k = math.floor(t * halves)
            s = (k | 1) / halves  # of k and k + 1 the odd one; the other has been tried before
            if abs(s - t) <= slack:
                x, x_low = _along(ax, dx, dx_tail, s)
                if x_low == 0.0 and _is_multiple(x, unit):
                    y, y_low = _along(ay, dy, dy_tail, s)
                    if y_low == 0.0 and _is_multiple(y, unit):
                        return x, y, True
            halves *= 2.0
    return _rounded(ax, bx, dx, dx_tail, t, unit), _rounded(ay, by, dy, dy_tail, t, unit), False
