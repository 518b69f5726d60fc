"""Random numbers that are the same in every version of every language: splitmix64."""

from collections.abc import Sequence
from fractions import Fraction
from typing import TypeVar

__all__ = ["Random"]

T = TypeVar("T")
_MASK = 2**64 - 1


class Random:
    """A stream of random numbers, determined by its seed."""

    def __init__(self, seed: int) -> None:
        self.state = seed & _MASK

    def bits(self) -> int:
        """Return 64 random bits."""
        self.state = (self.state + 0x9E3779B97F4A7C15) & _MASK
        z = self.state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & _MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & _MASK
        return z ^ (z >> 31)

    def integer(self, low: int, high: int) -> int:
        """Return an integer from low to high, both possible."""
        return low + self.bits() % (high - low + 1)

    def choice(self, items: Sequence[T]) -> T:
        """Return one of the items."""
        return items[self.integer(0, len(items) - 1)]

    def fraction(self, bits: int = 40) -> Fraction:
        """Return a multiple of 2^-bits between -1 and 1."""
        return Fraction(self.integer(-(2**bits), 2**bits), 2**bits)

    def double(self) -> Fraction:
        """Return a double with 53 random bits: 1/2 <= |x| < 1."""
        return Fraction(self.choice((-1, 1)) * self.integer(2**52, 2**53 - 1), 2**53)
