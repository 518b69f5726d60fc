"""K6: contexts: the exponent that leads into the window, wherever one does, and what goes along with it."""

import math
from collections.abc import Callable
from fractions import Fraction
from itertools import product

import numpy as np
import pytest

from exactkernel import constants
from exactkernel.context import (
    Context,
    bits_of,
    exponent_into_window,
    guarded_context,
    make_context,
    rebounded,
    scaled_into_window,
)

TOP, BOTTOM = Fraction(constants.MAX_COORDINATE_DEGREE_4), Fraction(constants.MIN_UNIT_DEGREE_4)
#: Widths of an input, from its largest magnitude to its unit, around the 521 that the window has room for.
WIDTHS = (0, 1, 40, 519, 520, 521, 522, 900)
FACTORS = (1.0, 1.0 + 2.0**-52, 2.0 - 2.0**-52)
POWERS = {e: Fraction(2) ** e for e in range(-1300, 1350)}


def inputs() -> list[tuple[float, float]]:
    """Largest magnitudes and units of some inputs, inside, outside, and across the window."""
    found = []
    for exponent, width, factor in product((-1000, -530, -269, -216, 0, 251, 252, 253, 300, 1023), WIDTHS, FACTORS):
        spread = max(width, 52 if factor != 1.0 else 0)
        if exponent - spread >= -1074:
            found.append((math.ldexp(factor, exponent), math.ldexp(1.0, exponent - spread)))
    return found


def leading_inside(maximum: float, unit: float) -> list[int]:
    """All exponents, by trying each that brings the largest magnitude near the window."""
    size = math.frexp(maximum)[1]
    return [
        e
        for e in range(-270 - size, 260 - size)
        if Fraction(unit) * POWERS[e] >= BOTTOM and Fraction(maximum) * POWERS[e] <= TOP
    ]


def bounds(k: Context) -> tuple[float, float, float]:
    return k.orient2d_bound, k.incircle_bound, k.grid_limit


@pytest.mark.obligation(
    "K6", "if any power of two leads into the window, one is found", method="enumeration", control_in="mutants"
)
class TestExponents:
    """An input inside stays; of those that lead one inside from outside, the middle one is taken, and a factor that
    scales; where there is none, nothing changes."""

    def test_every_width(self, record_property: Callable[[str, object], None]) -> None:
        several = 0
        for maximum, unit in inputs():
            there = leading_inside(maximum, unit)
            several += len(there) == 1
            expected = (there[0] + there[-1]) // 2 if there and 0 not in there else 0
            assert exponent_into_window(maximum, unit) == expected
            coordinates = np.array([[maximum, unit]])
            scaled, context = scaled_into_window(coordinates)
            exponent = math.frexp(scaled[0, 0])[1] - math.frexp(maximum)[1]
            assert (exponent in there) if there else exponent == 0
            assert (scaled is coordinates) == (exponent == 0)
            assert scaled.tolist() == np.ldexp(coordinates, exponent).tolist()
            assert bounds(context) == bounds(make_context(scaled))
        assert several > 5
        record_property("cases", len(inputs()))

    def test_nothing_but_zeros(self) -> None:
        zeros = np.zeros((3, 2))
        assert bits_of(zeros) == (0.0, math.inf)
        assert exponent_into_window(*bits_of(zeros)) == 0
        assert scaled_into_window(zeros)[0] is zeros
        assert math.isfinite(scaled_into_window(zeros)[1].incircle_bound)
        assert make_context(zeros).grid_limit >= 1.0


@pytest.mark.obligation(
    "K6",
    "a context knows the bounds and the grid of its input, a guarded one nothing",
    method="named cases",
    control_in="mutants",
)
class TestBounds:
    """The limit of the grid stage is 4096 units; another's scratch, tally and mailbox are shared, not its bounds."""

    @pytest.mark.parametrize("unit", [constants.MIN_UNIT_DEGREE_4, 2.0**-40, 1.0, 2.0**200])
    def test_grid_limit(self, unit: float) -> None:
        assert make_context(np.array([unit, 3 * unit])).grid_limit == 4096 * unit

    def test_guarded(self) -> None:
        assert bounds(guarded_context()) == (math.inf, math.inf, 0.0)
        wide = make_context(np.array([1.0, 2.0**-300]))
        assert bounds(wide) == (constants.ORIENT2D_BOUND, math.inf, 0.0)

    def test_shared(self) -> None:
        k = guarded_context()
        other = rebounded(k, 1.0, 0.5)
        assert bounds(other) == bounds(make_context(np.array([1.0, 0.5])))
        assert other.scratch is k.scratch
        assert other.counts is k.counts
        assert other.mailbox is k.mailbox
        assert (k.counts.shape, k.mailbox.shape) == ((2, 5), (2,))
        assert not k.mailbox.any()
        assert not k.counts.any()
