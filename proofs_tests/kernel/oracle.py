"""The predicates from their definitions, in fractions: slow, naive, sharing no code and no formula with the kernel."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import permutations
from typing import TypeAlias

__all__ = ["ExactPoint", "diametral", "incircle", "incircle_perturbed", "orient2d", "parity"]

ExactPoint: TypeAlias = "Sequence[float | int | Fraction]"
Matrix: TypeAlias = list[list[Fraction]]


def parity(permutation: Sequence[int]) -> int:
    """Return +1 for an even permutation, -1 for an odd one."""
    inversions = sum(a > b for i, a in enumerate(permutation) for b in permutation[i + 1 :])
    return -1 if inversions % 2 else 1


def _determinant(m: Matrix) -> Fraction:
    """Leibniz' sum over all permutations."""
    total = Fraction(0)
    for p in permutations(range(len(m))):
        term = Fraction(parity(p))
        for row, column in enumerate(p):
            term *= m[row][column]
        total += term
    return total


def _sign(x: Fraction) -> int:
    return (x > 0) - (x < 0)


def _exact(points: Sequence[ExactPoint]) -> list[tuple[Fraction, Fraction]]:
    return [(Fraction(x), Fraction(y)) for x, y in points]


def orient2d(*points: ExactPoint) -> int:
    """The sign of the area: rows (x, y, 1)."""
    return _sign(_determinant([[x, y, Fraction(1)] for x, y in _exact(points)]))


def diametral(a: ExactPoint, b: ExactPoint, p: ExactPoint) -> int:
    """Thales: p is inside where the angle apb is obtuse."""
    (ax, ay), (bx, by), (px, py) = _exact([a, b, p])
    return -_sign((ax - px) * (bx - px) + (ay - py) * (by - py))


def _lifted(points: Sequence[ExactPoint], lifts: Sequence[Fraction]) -> int:
    return _sign(_determinant([[x, y, z, Fraction(1)] for (x, y), z in zip(_exact(points), lifts, strict=True)]))


def incircle(*points: ExactPoint) -> int:
    """On which side of the plane of three lifted points is the fourth: rows (x, y, x^2 + y^2, 1)."""
    return _lifted(points, [x * x + y * y for x, y in _exact(points)])


def incircle_perturbed(*points: ExactPoint) -> int:
    """The determinant is linear in the lifts, so the sign is the first among itself and its slopes, largest first.

    The lift belongs to the point: two rows at one place are lifted together."""
    signs = [incircle(*points)]
    exact = _exact(points)
    order = sorted(range(4), key=lambda position: exact[position])
    signs += [_lifted(points, [Fraction(exact[i] == exact[j]) for j in range(4)]) for i in order]
    return next((sign for sign in signs if sign != 0), 0)
