"""Angles, areas and lengths from their definitions, in fractions: pi by Machin's formula, the cosine by Taylor's."""

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache

from proofs_tests.kernel.oracle import ExactPoint

__all__ = ["angle_above", "angle_below", "area_above", "compare_angle", "cosine_interval", "length_above"]

Interval = tuple[Fraction, Fraction]


def _arctan_of_inverse(n: int, bits: int) -> Interval:
    """Leibniz' alternating series: the value lies between any two partial sums that follow each other."""
    total, k = Fraction(0), 0
    while True:
        term = Fraction((-1) ** k, (2 * k + 1) * n ** (2 * k + 1))
        total, k = total + term, k + 1
        if abs(term) < Fraction(1, 2**bits):
            return min(total, total - term), max(total, total - term)


@lru_cache(maxsize=64)
def _pi(bits: int) -> Interval:
    five, other = _arctan_of_inverse(5, bits), _arctan_of_inverse(239, bits)
    return 4 * (4 * five[0] - other[1]), 4 * (4 * five[1] - other[0])


@lru_cache(maxsize=256)
def cosine_interval(degrees: Fraction, bits: int) -> Interval:
    """Return bounds of cos of 0 to 180 degrees, about 2^-bits apart."""
    low, high = (bound * degrees / 180 for bound in _pi(bits + 4))
    unit = 2 ** (bits + 4)
    x = Fraction(round(low * unit), unit)
    total, term, k = Fraction(0), Fraction(1), 0
    while abs(term) * unit > 1 or k < 8:  # beyond, the terms fall by more than half
        total += term
        k += 2
        term *= -x * x / (k * (k - 1))
    error = 2 * abs(term) + (high - low) + Fraction(1, unit)
    return total - error, total + error


#: cos |cos| where it is rational.
EXACT = {
    Fraction(degrees): Fraction(value, 4)
    for degrees, value in zip((0, 30, 45, 60, 90, 120, 135, 150, 180), (4, 3, 2, 1, 0, -1, -2, -3, -4), strict=True)
}


def _sign(x: Fraction) -> int:
    return (x > 0) - (x < 0)


def compare_angle(apex: ExactPoint, p: ExactPoint, q: ExactPoint, degrees: float | Fraction) -> int:
    """Return the sign of the angle at the apex minus a bound: the law of cosines, cosines squared with their sign."""
    (ax, ay), (px, py), (qx, qy) = ([Fraction(x) for x in point] for point in (apex, p, q))
    left, right = (px - ax) ** 2 + (py - ay) ** 2, (qx - ax) ** 2 + (qy - ay) ** 2
    cosine = (left + right - (px - qx) ** 2 - (py - qy) ** 2) / 2
    squared = cosine * abs(cosine) / (left * right)
    bound = Fraction(degrees)
    if bound in EXACT:
        return -_sign(squared - EXACT[bound])
    bits = 64
    while True:
        low, high = cosine_interval(bound, bits)
        if squared > high * abs(high):
            return -1
        if squared < low * abs(low):
            return 1
        bits *= 2


def _angles(points: Sequence[ExactPoint], degrees: float | Fraction) -> list[int]:
    a, b, c = points
    return [compare_angle(*turned, degrees) for turned in ((a, b, c), (b, c, a), (c, a, b))]


def angle_below(points: Sequence[ExactPoint], degrees: float | Fraction) -> bool:
    return min(_angles(points, degrees)) < 0


def angle_above(points: Sequence[ExactPoint], degrees: float | Fraction) -> bool:
    return max(_angles(points, degrees)) > 0


def area_above(points: Sequence[ExactPoint], bound: float | Fraction) -> bool:
    """The shoelace formula."""
    exact = [(Fraction(x), Fraction(y)) for x, y in points]
    doubled = sum((p[0] * q[1] - q[0] * p[1] for p, q in zip(exact, exact[1:] + exact[:1], strict=True)), Fraction(0))
    return abs(doubled) / 2 > Fraction(bound)


def length_above(points: Sequence[ExactPoint], bound: float | Fraction) -> bool:
    (ax, ay), (bx, by) = ([Fraction(x) for x in point] for point in points)
    return (ax - bx) ** 2 + (ay - by) ** 2 > Fraction(bound) ** 2
