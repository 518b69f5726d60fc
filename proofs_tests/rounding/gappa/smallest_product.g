# What underflows where a product p of pairs is at least 2^-900, and a quotient q of one (or the coordinate x, instead).
# 1. The last bits of its factors multiply to more than p 2^-107, as each is more than 2^-53 of its factor: Dekker's
# product of the heads is exact. 2. The products with tails lose h1, h2, relative to p or, over det, to q; the quotients
# and the bounds lose h3, h4, h5: in all 2^-170 of p or q, while DD_BOUND is 2^-100 and quotient_offset needs a fifth.
#
# code: exactkernel.crossing._coordinate
#   | if abs(p) < _SMALLEST_PRODUCT:
#   | if abs(high) < _SMALLEST_PRODUCT:
# code: exactkernel.bisector._nearest_coordinate
#   | if abs(p) < _SMALLEST_PRODUCT:
#   | return x, abs(x) >= _SMALLEST_PRODUCT and is_nearest_certain(x, tail, error)
# constant: 1b-900 = exactkernel.crossing._SMALLEST_PRODUCT
# constant: 1b-900 = exactkernel.bisector._SMALLEST_PRODUCT
# control, no guard of the product: p in [1b-900 => p in [1b-970
# control, no guard of the quotient: q in [1b-900 => q in [1b-970

{ p in [1b-900, 1b1000] /\ q in [1b-900, 1b1000] /\ |h1| <= 1b-1075 /\ |h2| <= 1b-1075 /\ |h3| <= 1b-1075 /\ |h4| <= 1b-1075 /\ |h5| <= 1b-1075
  -> p * 1b-107 >= 1b-1074 /\ |(h1 + h2) / p| + |(h3 + h4 + h5) / q| <= 1b-170 }
