"""Error bounds and safe windows, each with its derivation beside it.

Notation: u = 2^-53 is the unit roundoff; every operation in round-to-nearest has a relative error of at most u as
long as nothing under- or overflows. ``|v - v^| <= e * p^`` bounds the error of a computed ``v^`` by the computed
permanent ``p^`` (the same expression with every term taken absolutely):

    a difference of inputs   e = u
    a +- b                   e = max(ea, eb) (1 + u) + u
    a * b                    e = (ea + eb + ea eb) (1 + u) + u

The sign of the computed determinant is right when ``|det| > C p^`` with ``C >= e (1 + u)^2 / (1 - u)``, no rounding
charged to the operation that forms det last. Reference [Shewchuk 1997].
"""

from typing import Final

__all__ = [
    "DD_BOUND",
    "GRID_STEPS",
    "INCIRCLE_BOUND",
    "LARGEST_WEIGHT",
    "MAX_COORDINATE_DEGREE_2",
    "MAX_COORDINATE_DEGREE_4",
    "MIN_COORDINATE_DEGREE_2",
    "MIN_COORDINATE_DEGREE_4",
    "MIN_UNIT_DEGREE_2",
    "MIN_UNIT_DEGREE_4",
    "ORIENT2D_BOUND",
    "SHAPE_FACTOR",
    "SMALLEST_WEIGHT",
    "SPLITTER",
    "UNIT_ROUNDOFF",
]

UNIT_ROUNDOFF: Final = 2.0**-53

#: Veltkamp's splitter for 53 bits: 2^ceil(53/2) + 1 cuts a double into two halves of at most 26 bits.
SPLITTER: Final = 2.0**27 + 1.0

#: orient2d and diametral. The calculus gives e = 3u + O(u^2) for a product of two differences, and C = 3u + 12u^2.
ORIENT2D_BOUND: Final = (3.0 + 16.0 * UNIT_ROUNDOFF) * UNIT_ROUNDOFF

#: incircle: lift 4u, cross product 4u, their product 9u, the sum of three 10u (the last addition is free), which with
#: the second-order terms is C = 10u + 75u^2.
INCIRCLE_BOUND: Final = (10.0 + 96.0 * UNIT_ROUNDOFF) * UNIT_ROUNDOFF

#: Angles, areas and lengths against a bound: the bound of orient2d times this. Angles: cross and scalar product 4u,
#: sine and cosine u, product 6u, C = 6u + O(u^2). Areas: the cross product 4u, the bound exact. Lengths: 4u, too. Twice
#: what is needed leaves room for what underflows: see SMALLEST_WEIGHT.
SHAPE_FACTOR: Final = 4.0

#: The double-double determinants. The differences are exact pairs; a product of pairs errs by at most 7u^2 relative to
#: its value and a sum by at most 3u^2 relative to the sum of the absolute values [Joldes 2017]. orient2d: 7 + 3 = 10
#: u^2. incircle: squares 7, lift 10, cross product 10, product 10 + 10 + 7 = 27, the sum of three 33 u^2 times the
#: permanent. 64 u^2 leaves half of itself for third-order terms and for the rounding of the permanent and of the bound.
DD_BOUND: Final = 64.0 * UNIT_ROUNDOFF * UNIT_ROUNDOFF

#: On a grid with unit g, differences of at most 2^12 g make every intermediate value of the incircle determinant an
#: integer multiple of g^4 (g^2 for orient2d): lift and cross product <= 2^25, their product <= 2^50, three < 2^52.
#: Integers below 2^53 are doubles, so nothing rounds and the computed determinant is exact, zero included.
GRID_STEPS: Final = 2.0**12

# The windows. When every coordinate is a multiple of a power of two g, so is every difference, head or tail, and a
# determinant of degree k is made of multiples of g^k. While g^k >= 2^-1074, the smallest subnormal, those are doubles
# or round with relative error u: nothing underflows, in the filter and in the expansions alike (Dekker's product of a
# and b is exact because its tail is a multiple of ulp(a) ulp(b)). The bound C p^ may itself round to a subnormal; det,
# being a multiple of g^k, still exceeds it only if it exceeds the exact C p^.
MIN_UNIT_DEGREE_2: Final = 2.0**-537
MIN_UNIT_DEGREE_4: Final = 2.0**-268
# A nonzero double of magnitude at least 2^52 g is a multiple of g, whatever its bits.
MIN_COORDINATE_DEGREE_2: Final = 2.0**-485
MIN_COORDINATE_DEGREE_4: Final = 2.0**-216
# Above: coordinates of magnitude at most 2^M have differences of at most 2^(M+1). Degree 2: products 2^(2M+2), their
# sum 2^(2M+3), and an expansion's partial sums stay below twice that: 2M + 4 <= 1023. Degree 4: lift and cross product
# 2^(2M+3), product 2^(4M+6), the sum of three below 2^(4M+8), twice that 2^(4M+9): 4M + 9 <= 1023. Veltkamp's split
# multiplies by 2^27 + 1 before it subtracts; the largest number split is a factor, below 2^(2M+4), which leaves room.
MAX_COORDINATE_DEGREE_2: Final = 2.0**509
MAX_COORDINATE_DEGREE_4: Final = 2.0**253

# Measures against a bound multiply products of degree 2 by a sine, or compare them with any double: such values are no
# multiples of g^2 and may underflow, by at most 2^-1075 an operation. Where the permanent is at least SMALLEST_WEIGHT,
# the bound of the filter has more than 2^-1013 to spare, that of the double-doubles more than 2^-960, and a few
# underflows in it or beside it do no harm. At most LARGEST_WEIGHT: the split of the double-doubles does not overflow.
SMALLEST_WEIGHT: Final = 2.0**-850
LARGEST_WEIGHT: Final = 2.0**990
