"""Error-free transforms and expansion arithmetic.

An expansion is a sum of doubles, stored in an array by increasing magnitude, nonadjacent (between the bits of any two
is a zero bit), without zeros (the number zero has no components); its last component carries its sign. The routines
return the number of components written. Reference [Shewchuk 1997], [Dekker 1971], [Knuth 1969].
"""

from exactkernel.constants import SPLITTER
from exactkernel.jit import jit
from exactkernel.types import FloatArray

__all__ = [
    "determinant_2x2",
    "expansion_product",
    "expansion_sign",
    "expansion_sum",
    "fast_two_sum",
    "negate",
    "pair",
    "scale_expansion",
    "split",
    "two_diff",
    "two_product",
    "two_sum",
]


@jit
def two_sum(a: float, b: float) -> tuple[float, float]:
    """Return (x, y) with x = fl(a + b) and x + y = a + b exactly."""
    x = a + b
    b_virtual = x - a
    a_virtual = x - b_virtual
    return x, (a - a_virtual) + (b - b_virtual)


@jit
def fast_two_sum(a: float, b: float) -> tuple[float, float]:
    """Return (x, y) as two_sum does, provided |a| >= |b| or a = 0."""
    x = a + b
    return x, b - (x - a)


@jit
def two_diff(a: float, b: float) -> tuple[float, float]:
    """Return (x, y) with x = fl(a - b) and x + y = a - b exactly."""
    x = a - b
    b_virtual = a - x
    a_virtual = x + b_virtual
    return x, (a - a_virtual) + (b_virtual - b)


@jit
def split(a: float) -> tuple[float, float]:
    """Return (high, low), each of at most half the bits, with high + low = a exactly."""
    c = SPLITTER * a
    high = c - (c - a)
    return high, a - high


@jit
def two_product(a: float, b: float) -> tuple[float, float]:
    """Return (x, y) with x = fl(a b) and x + y = a b exactly (inside the window of constants.py)."""
    x = a * b
    a_high, a_low = split(a)
    b_high, b_low = split(b)
    error = ((x - a_high * b_high) - a_low * b_high) - a_high * b_low
    return x, a_low * b_low - error


@jit
def pair(high: float, low: float, h: FloatArray) -> int:
    """Write the nonadjacent sum high + low (of two_sum, two_diff or two_product) as an expansion."""
    n = 0
    if low != 0.0:
        h[n] = low
        n += 1
    if high != 0.0:
        h[n] = high
        n += 1
    return n


@jit
def expansion_sum(e: FloatArray, ne: int, f: FloatArray, nf: int, h: FloatArray) -> int:
    """Write e + f into h (not overlapping e or f in memory): merge by magnitude, then carry. O(ne + nf).

    Shewchuk's linear sum: where e and f are nonadjacent, so is h. His fast sum saves three operations of nine, but does
    not keep any property that it asks for: 192 - 24 and -240, in four bits, become 8 - 80.
    """
    if ne == 0 or nf == 0:
        for k in range(ne):
            h[k] = e[k]
        for k in range(nf):
            h[k] = f[k]
        return ne + nf
    i = j = n = 0
    carry = small = 0.0
    for _ in range(ne + nf):
        if j == nf or (i < ne and abs(e[i]) < abs(f[j])):
            component = e[i]
            i += 1
        else:
            component = f[j]
            j += 1
        total, tail = fast_two_sum(component, small)
        if tail != 0.0:
            h[n] = tail
            n += 1
        carry, small = two_sum(carry, total)
    return n + pair(carry, small, h[n:])


@jit
def scale_expansion(e: FloatArray, ne: int, b: float, h: FloatArray) -> int:
    """Write e * b into h (not overlapping e). At most 2 ne components. O(ne)."""
    if ne == 0 or b == 0.0:
        return 0
    n = 0
    carry, tail = two_product(e[0], b)
    if tail != 0.0:
        h[n] = tail
        n += 1
    for k in range(1, ne):
        product_high, product_low = two_product(e[k], b)
        total, tail = two_sum(carry, product_low)
        if tail != 0.0:
            h[n] = tail
            n += 1
        carry, tail = fast_two_sum(product_high, total)
        if tail != 0.0:
            h[n] = tail
            n += 1
    if carry != 0.0:
        h[n] = carry
        n += 1
    return n


@jit
def expansion_product(
    e: FloatArray, ne: int, f: FloatArray, nf: int, h: FloatArray, scaled: FloatArray, total: FloatArray
) -> int:
    """Write e * f into h; ``scaled`` (2 ne) and ``total`` (2 ne nf) are scratch. O(ne nf^2)."""
    n = 0
    for k in range(nf):
        m = scale_expansion(e, ne, f[k], scaled)
        t = expansion_sum(h, n, scaled, m, total)
        for i in range(t):
            h[i] = total[i]
        n = t
    return n


@jit
def negate(e: FloatArray, ne: int) -> None:
    """Change the sign of the expansion in place."""
    for k in range(ne):
        e[k] = -e[k]


@jit
def expansion_sign(e: FloatArray, ne: int) -> int:
    """Return the sign of the expansion, which is that of its last component."""
    if ne == 0:
        return 0
    return 1 if e[ne - 1] > 0.0 else -1


@jit
def determinant_2x2(
    p: float,
    p_tail: float,
    q: float,
    q_tail: float,
    r: float,
    r_tail: float,
    s: float,
    s_tail: float,
    h: FloatArray,
    scratch: FloatArray,
) -> int:
    """Write p q - r s of exact pairs into h (16); uses 32 doubles of scratch."""
    e, f, scaled, total = scratch[0:2], scratch[2:4], scratch[4:8], scratch[8:16]
    left, right = scratch[16:24], scratch[24:32]
    n_left = expansion_product(e, pair(p, p_tail, e), f, pair(q, q_tail, f), left, scaled, total)
    n_right = expansion_product(e, pair(r, r_tail, e), f, pair(s, s_tail, f), right, scaled, total)
    negate(right, n_right)
    return expansion_sum(left, n_left, right, n_right, h)
