"""A polynomial in fractions together with its permanent: the same expression with every term taken absolutely."""

from dataclasses import dataclass
from fractions import Fraction

__all__ = ["Magnitude", "cross", "difference", "inner", "number"]


@dataclass(frozen=True)
class Magnitude:
    """A value, and the permanent that bounds the rounding error of computing it."""

    value: Fraction
    permanent: Fraction

    def __add__(self, other: "Magnitude") -> "Magnitude":
        return Magnitude(self.value + other.value, self.permanent + other.permanent)

    def __sub__(self, other: "Magnitude") -> "Magnitude":
        return Magnitude(self.value - other.value, self.permanent + other.permanent)

    def __mul__(self, other: "Magnitude") -> "Magnitude":
        return Magnitude(self.value * other.value, self.permanent * other.permanent)

    @property
    def sign(self) -> int:
        return (self.value > 0) - (self.value < 0)

    def exceeds(self, bound: float | Fraction) -> bool:
        """Tell whether the value is more than so many times the permanent away from zero."""
        return abs(self.value) > Fraction(bound) * self.permanent


Vector = tuple[Magnitude, Magnitude]


def number(x: float) -> Magnitude:
    return Magnitude(Fraction(x), abs(Fraction(x)))


def difference(p: tuple[float, float], q: tuple[float, float]) -> Vector:
    """Return p - q: differences of inputs are terms of their own."""
    x, y = Fraction(p[0]) - Fraction(q[0]), Fraction(p[1]) - Fraction(q[1])
    return Magnitude(x, abs(x)), Magnitude(y, abs(y))


def inner(u: Vector, v: Vector) -> Magnitude:
    return u[0] * v[0] + u[1] * v[1]


def cross(u: Vector, v: Vector) -> Magnitude:
    return u[0] * v[1] - u[1] * v[0]
