"""The angle at a corner against a bound in degrees, in gmpy2: exact for every rational bound.

Let an angle of a triangle with rational corners have the cross product C and the scalar product D of its sides. With a
bound b between 0 and 180 degrees, the sign of D sin b - C cos b is that of sin(b - angle): positive where the angle is
smaller. It vanishes only where tan b = C/D or D/C = 0: tangents of rational multiples of 180 degrees are irrational but
for 0, 1 and -1 [Niven 1956], so only bounds of 0, 45, 90, 135 and 180 degrees can be met exactly. For those the
direction (cos b, sin b) is a positive multiple of a pair of integers; for all others an enclosure of the sine and the
cosine decides as soon as it is precise enough.
"""

from functools import lru_cache

import gmpy2
from gmpy2 import mpq, sign

__all__ = ["DIRECTIONS", "corner_sign", "cosine_and_sine"]

#: Positive multiples of (cos b, sin b) for the bounds that an angle between rational points can meet exactly.
DIRECTIONS: dict[mpq, tuple[int, int]] = {
    mpq(0): (1, 0),
    mpq(45): (1, 1),
    mpq(90): (0, 1),
    mpq(135): (-1, 1),
    mpq(180): (-1, 0),
}

_FIRST_PRECISION = 192
#: MPFR rounds correctly: pi, the conversion of b, product and quotient err by 2^-p each, relative to at most 3.15; sine
#: and cosine pass that on at most as it is and add 2^-p. In all less than 14 * 2^-p.
_LOST_BITS = 4


@lru_cache(maxsize=64)
def cosine_and_sine(degrees: mpq, precision: int) -> tuple[mpq, mpq, mpq]:
    """Return cosine and sine of 0 <= degrees <= 180, and 2^(4 - precision), by which each errs at most."""
    with gmpy2.context(precision=precision, round=gmpy2.RoundToNearest):
        angle = gmpy2.mpfr(degrees) * gmpy2.const_pi() / 180
        return mpq(gmpy2.cos(angle)), mpq(gmpy2.sin(angle)), mpq(1, 1 << (precision - _LOST_BITS))


def corner_sign(cross: mpq, dot: mpq, degrees: mpq) -> int:
    """Return the sign of dot sin(degrees) - cross cos(degrees), exactly, for cross > 0 and 0 <= degrees <= 180.

    +1: the angle with this cross and scalar product of its sides is smaller than the bound, 0: equal, -1: larger.
    """
    if degrees in DIRECTIONS:
        cosine, sine = DIRECTIONS[degrees]
        return int(sign(dot * sine - cross * cosine))
    if dot == 0:
        return 1 if degrees > 90 else -1
    precision = _FIRST_PRECISION
    while True:  # ends: the value is not zero [Niven 1956]
        c, s, error = cosine_and_sine(degrees, precision)
        value = dot * s - cross * c
        if abs(value) > error * (abs(dot) + abs(cross)):
            return int(sign(value))
        precision *= 2
