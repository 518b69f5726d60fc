"""K1, K3, K4: the constants of the filters, by calculus and over every input of a tiny format."""

from dataclasses import dataclass
from fractions import Fraction

import numpy as np
import pytest
from proofs_tests.minifloat import Arithmetic, Backend, Floats, MiniFloat, all_numbers, derive

from exactkernel.constants import INCIRCLE_BOUND, ORIENT2D_BOUND
from exactkernel.diametral import diametral_filter
from exactkernel.orient2d import orient2d_filter

U = Fraction(1, 2**53)


@dataclass(frozen=True)
class Bounded:
    """An expression whose computed value errs by at most e times its computed permanent."""

    e: Fraction

    def __add__(self, other: "Bounded") -> "Bounded":
        return Bounded(max(self.e, other.e) * (1 + U) + U)

    def __mul__(self, other: "Bounded") -> "Bounded":
        return Bounded((self.e + other.e + self.e * other.e) * (1 + U) + U)


def largest_needed(last: Bounded) -> Fraction:
    """The bound C for |det| > C permanent, where no rounding is charged to the last addition."""
    return last.e * (1 + U) ** 2 / (1 - U)


@pytest.mark.obligation("K1", "the filter constants are sound for u = 2^-53, by exact calculus", method="calculus")
class TestConstants:
    """The bound that the calculus of rounding errors asks for is at most the constant of the filter."""

    difference = Bounded(U)
    product = difference * difference
    minor = product + product
    lift = product + product
    term = lift * minor

    def test_orient2d(self) -> None:
        assert largest_needed(self.product) <= Fraction(ORIENT2D_BOUND)

    def test_incircle(self) -> None:
        assert largest_needed(self.term + self.term) <= Fraction(INCIRCLE_BOUND)

    def test_control_smaller_constants_are_refused(self) -> None:
        """(3 + 11u)u for orient2d and (10 + 74u)u for incircle."""
        assert largest_needed(self.product) > (3 + 11 * U) * U
        assert largest_needed(self.term + self.term) > (10 + 74 * U) * U


def axis_triples(precision: int, binades: int, quantum: float) -> tuple[Floats, Floats]:
    """All (a, b, c) on one axis, one for each value of the exact and the rounded differences, up to a common sign."""
    values = all_numbers(precision, range(binades))
    a, b, c = (v.ravel() for v in np.meshgrid(values, values, values, indexing="ij"))
    difference = derive([minus], MiniFloat(precision, quantum), Backend.ARRAYS)["minus"]
    keys = np.stack([a - c, b - c, difference(a, c), difference(b, c)])
    keys = keys[:, (keys[0] > 0) | ((keys[0] == 0) & (keys[1] >= 0))]
    kept = (a - c > 0) | ((a - c == 0) & (b - c >= 0))
    _, first = np.unique(keys, axis=1, return_index=True)
    return np.stack([a[kept][first], b[kept][first], c[kept][first]]), keys[:2, first]


def minus(a: float, b: float) -> float:
    return a - b


def lies(name: str, mini: MiniFloat, bound: float, binades: int, every: int = 1) -> int:
    """Count the inputs on which the filter certifies a sign that is not the exact one."""
    decide: Arithmetic = derive([orient2d_filter, diametral_filter], mini, Backend.ARRAYS)[name]
    triples, differences = axis_triples(mini.precision, binades, mini.quantum)
    (ax, bx, cx), (px, sx) = triples[:, ::every], differences[:, ::every]
    found = 0
    for (ay, by, cy), (ry, qy) in zip(triples.T.tolist(), differences.T.tolist(), strict=True):
        sign = decide(bound, ax, ay, bx, by, cx, cy)
        # (a - c) x (b - c), or (a - c) . (b - c) with the sign of diametral
        exact = np.sign(px * qy - ry * sx) if name == "orient2d_filter" else -np.sign(px * sx + ry * qy)
        found += int(np.count_nonzero((sign != 0) & (sign != exact)))
    return found


def published(precision: int) -> float:
    u = 2.0**-precision
    return (3.0 + 16.0 * u) * u


BINADES = 3  # test_kernel_exhaustive.py has more, compiled


@pytest.mark.obligation(
    "K3",
    "the filters of orient2d and diametral never lie (exhaustive, 3 bits)",
    method="exhaustive",
    control_in="TestFilterControls",
)
class TestFilterNeverLies:
    """A sign that the filter certifies is the exact one: over every input of the format, up to symmetries.

    The symmetries: inputs with equal exact and equal rounded differences, and mirror images in an axis.
    """

    @pytest.mark.parametrize("name", ["orient2d_filter", "diametral_filter"])
    def test_with_the_shipped_constant(self, name: str) -> None:
        assert lies(name, MiniFloat(3), published(3), BINADES) == 0


@pytest.mark.obligation("K4", "an unsound constant and a missing guard are found by K3", method="exhaustive")
class TestFilterControls:
    """The same search finds lies where there are some."""

    @pytest.mark.parametrize("name", ["orient2d_filter", "diametral_filter"])
    @pytest.mark.parametrize("factor", [0.0, 0.5, 1.0])
    def test_control_an_unsound_constant_is_found(self, name: str, factor: float) -> None:
        """The constants 0, u/2 and u."""
        assert lies(name, MiniFloat(3), factor * 2.0**-3, BINADES) > 0

    def test_control_a_missing_guard_is_found(self) -> None:
        """No guard where products underflow."""
        assert lies("orient2d_filter", MiniFloat(3, quantum=2.0**6), published(3), BINADES) > 0

    def test_control_a_wrong_filter_is_found(self) -> None:
        """A comparison with >= in the place of >."""
        mini = MiniFloat(3, edits={"orient2d_filter": ("-det > error", "-det >= error")})
        assert lies("orient2d_filter", mini, published(3), 2) > 0
