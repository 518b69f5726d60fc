"""Double-double arithmetic: an unevaluated sum of two doubles, about 106 bits, with certified relative errors.

A pair (high, low) has |low| <= u |high|; two_diff makes such pairs exactly. Reference [Joldes 2017].
"""

from exactkernel.expansions import fast_two_sum, two_product, two_sum
from exactkernel.jit import jit

__all__ = ["dd_add", "dd_multiply"]


@jit
def dd_add(ah: float, al: float, bh: float, bl: float) -> tuple[float, float]:
    """Return the sum of two pairs, relative error at most 3u^2 + 13u^3 (AccurateDWPlusDW)."""
    sh, sl = two_sum(ah, bh)
    th, tl = two_sum(al, bl)
    vh, vl = fast_two_sum(sh, sl + th)
    return fast_two_sum(vh, tl + vl)


@jit
def dd_multiply(ah: float, al: float, bh: float, bl: float) -> tuple[float, float]:
    """Return the product of two pairs, relative error at most 7u^2 (DWTimesDW1)."""
    ph, pl = two_product(ah, bh)
    return fast_two_sum(ph, pl + (ah * bl + al * bh))
