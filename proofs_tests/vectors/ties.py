"""Configurations whose products lie half-way between two subnormals: a filter without a guard certifies what the
rounding of the products makes of them."""

import math
from fractions import Fraction

from proofs_tests.vectors.randomness import Random

__all__ = ["TIED"]

Values = tuple[float, ...]
_SMALLEST = Fraction(1, 2**1074)


def factors(r: Random, product: Fraction) -> tuple[float, float]:
    """Return two doubles whose product is as near to the given one as that of two doubles is."""
    x = math.ldexp(float(abs(r.double())), -r.integer(535, 538))
    return x, float(product / Fraction(x))


def root(product: Fraction) -> float:
    """Return about the square root."""
    return math.ldexp(math.isqrt(int(product * 2**1280)), -640)


def speck(r: Random) -> tuple[float, float]:
    """Return a point so near to the origin that its distance to others is rounded."""
    return math.ldexp(float(r.double()), -r.integer(587, 592)), math.ldexp(float(r.double()), -r.integer(587, 592))


def sides(r: Random) -> tuple[float, float, float, float]:
    """Return x, y, z, w with x y and z w near the same odd multiple of half of the smallest subnormal."""
    middle = (r.integer(0, 9) + Fraction(1, 2)) * _SMALLEST
    return *factors(r, middle), *factors(r, middle)


def orient2d(r: Random) -> Values:
    x, y, z, w = sides(r)
    return x, z, w, y, *speck(r)


def diametral(r: Random) -> Values:
    x, y, z, w = sides(r)
    return -x, -z, y, -w, *speck(r)


def along(r: Random) -> Values:
    x, y, z, w = sides(r)
    (px, py), (ax, ay) = speck(r), speck(r)
    return px, py, x, z, ax, ay, y, -w


def area(r: Random) -> Values:
    n = r.integer(1, 2**20)
    x, y = factors(r, (2 * n + Fraction(1, 2)) * _SMALLEST)
    z, w = factors(r, _SMALLEST / 2)
    return float(n * _SMALLEST), x, z, w, y, *speck(r)


def length(r: Random) -> Values:
    m, n = r.integer(0, 99), r.integer(0, 99)
    x, y = root((m + Fraction(1, 2)) * _SMALLEST), root((n + Fraction(1, 2)) * _SMALLEST)
    return root((m + n + 1) * _SMALLEST), *speck(r), x, y


def crossing_order(r: Random) -> Values:
    """The sites so near to one another that the squares of their distances underflow; the line far longer."""
    near = [math.ldexp(float(r.double()), -r.integer(534, 538)) for _ in range(8)]
    return *near, math.ldexp(float(r.double()), r.integer(400, 900)), math.ldexp(float(r.double()), r.integer(400, 900))


TIED = {
    "orient2d": orient2d,
    "diametral": diametral,
    "along": along,
    "area": area,
    "length": length,
    "crossing_order": crossing_order,
}
