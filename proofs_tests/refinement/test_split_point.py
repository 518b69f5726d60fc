"""Where segments are split: on the segment exactly, or as near as doubles go."""

import math
from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from exactkernel.constants import MIN_UNIT_DEGREE_4
from exactkernel.expansions import two_diff
from exactmesh.refinement.split_point import split_point

Split = Callable[[float, float, float, float, float, float, float], tuple[float, float, bool]]

FINEST = 52


class Case(NamedTuple):
    """Arguments of split_point."""

    ax: float
    ay: float
    bx: float
    by: float
    t: float
    slack: float
    unit: float


def is_double(value: Fraction, unit: float) -> bool:
    """Tell whether the number is a double and a multiple of the unit."""
    return Fraction(float(value)) == value and (value / Fraction(unit)).denominator == 1


def at(case: Case, s: Fraction) -> tuple[Fraction, Fraction]:
    """Return the exact point at a parameter."""
    ax, ay, bx, by = map(Fraction, case[:4])
    return ax + s * (bx - ax), ay + s * (by - ay)


def wanted(case: Case) -> Fraction | None:
    """Return the parameter by the definition: the first level with a double at a neighbour of t within the slack."""
    t = Fraction(case.t)
    for m in range(1, FINEST + 1):
        below = Fraction(math.floor(t * 2**m), 2**m)
        near = [s for s in (below, below + Fraction(1, 2**m)) if 0 < s < 1 and abs(s - t) <= Fraction(case.slack)]
        found = [s for s in near if all(is_double(x, case.unit) for x in at(case, s))]
        if found:
            return min(found, key=lambda s: (s.denominator, abs(s - t)))
    return None


def limit_of(exact: Fraction, unit: float) -> Fraction:
    """Return what a rounded coordinate may err by: an ulp of the exact number, and half a unit where it is coarser."""
    ulp, half = Fraction(math.ulp(float(exact))), Fraction(unit) / 2
    return ulp + (half if 2 * half > ulp else 0)


def faults(case: Case, split: Split) -> list[str]:
    """Return what is wrong with the answer."""
    x, y, exact = split(*case)
    s = wanted(case)
    wrong = []
    if exact != (s is not None):
        wrong.append(f"says {'exact' if exact else 'rounded'}, but the parameter is {s}")
    target = at(case, Fraction(case.t) if s is None else s)
    for axis, value, begin, end in ((0, x, case.ax, case.bx), (1, y, case.ay, case.by)):
        if not min(begin, end) <= value <= max(begin, end):
            wrong.append(f"coordinate {axis} leaves the box")
        if not is_double(Fraction(value), case.unit):
            wrong.append(f"coordinate {axis} is no multiple of the unit")
        if abs(target[axis] - Fraction(value)) > (0 if exact else limit_of(target[axis], case.unit)):
            wrong.append(f"coordinate {axis} is too far from where it should be")
    return wrong


@st.composite
def coordinates(draw: st.DrawFn) -> tuple[float, float]:
    """Two coordinates: on a grid, of full precision, of different sizes, close together, or across zero."""
    scale = 2.0 ** draw(st.integers(-200, 200))
    digits = draw(st.sampled_from([1, 3, 10, 26, 50, 53]))
    small = st.integers(-(2**digits), 2**digits).map(float)
    match draw(st.integers(0, 3)):
        case 0:
            pair = draw(small), draw(small)
        case 1:
            pair = draw(small), draw(small) * 2.0 ** draw(st.integers(-60, 60))
        case 2:
            first = draw(small)
            pair = first, first + math.ulp(first) * draw(st.integers(-70, 70))
        case _:
            first = draw(small)
            pair = first, first
    return pair[0] * scale, pair[1] * scale


parameters = st.one_of(
    st.just(0.5),
    st.floats(1e-9, 1.0 - 1e-9),
    st.integers(1, 1023).map(lambda k: k / 1024),
    st.floats(1e-300, 1e-9),
    st.integers(1, 60).map(lambda k: 1.0 - 2.0**-k if k < 53 else 2.0**-k),
)


@st.composite
def cases(draw: st.DrawFn) -> Case:
    """Segments and parameters of all kinds, in a window and on coarse units."""
    ax, bx = draw(coordinates())
    ay, by = draw(coordinates())
    unit = draw(st.sampled_from([MIN_UNIT_DEGREE_4, MIN_UNIT_DEGREE_4, 2.0**-30, 0.5]))
    ends = [math.floor(Fraction(x) / Fraction(unit)) * unit if unit > 1e-60 else x for x in (ax, ay, bx, by)]
    if ends[:2] == ends[2:]:
        ends[2] += max(unit, math.ulp(ends[2]))
    slack = draw(st.sampled_from([0.0, 1e-12, 0.01, 0.1, 0.25, 1.0]))
    return Case(ends[0], ends[1], ends[2], ends[3], draw(parameters), slack, unit)


WINDOW = MIN_UNIT_DEGREE_4

NAMED = {
    "a midpoint on a grid": Case(0.0, 0.0, 3.0, 1.0, 0.5, 0.1, WINDOW),
    "a coarse one before the nearest one": Case(0.0, 0.0, 3.0, 1.0, 0.4, 0.2, WINDOW),
    "three levels": Case(0.0, 0.0, 3.0, 1.0, 0.4, 0.05, WINDOW),
    "no bits left": Case(1.0, 1.0, 2.0, 1.0 + 2.0**-52, 0.5, 0.25, WINDOW),
    "bits won near zero": Case(-1.0 - 2.0**-52, 0.0, 1.0, 1.0, 0.5, 0.25, WINDOW),
    "a difference that is no double": Case(-(2.0**53), 0.0, 2.0**53 - 1.0, 0.0, 0.5, 0.25, WINDOW),
    "one of 80 bits": Case(-(2.0**80), 3.0, 1.0, 5.0, 0.5, 0.25, WINDOW),
    "neighbours": Case(1.0, 1.0, 1.0 + 2.0**-52, 1.0, 0.5, 1.0, WINDOW),
    "the unit forbids": Case(0.0, 0.0, 1.0, 3.0, 0.5, 1.0, 1.0),
    "axis-parallel": Case(0.1, 0.3, 0.1, 0.9, 1.0 / 3.0, 0.0, WINDOW),
}


@pytest.mark.obligation(
    "R1",
    "segments are split exactly on them where doubles allow, else within one ulp",
    method="property-based",
    control_in="TestControls",
)
class TestSplitPoint:
    """Law: the answer is the double at the dyadic parameter of fewest bits among the neighbours of t, exactly, if there
    is one; else the point at t within one ulp a coordinate; in the box, on the unit."""

    @pytest.mark.parametrize("name", NAMED)
    def test_named(self, name: str) -> None:
        assert faults(NAMED[name], split_point) == []

    @given(cases())
    def test_any(self, case: Case) -> None:
        assert faults(case, split_point) == []

    @given(cases())
    def test_either_direction(self, case: Case) -> None:
        swapped = Case(case.bx, case.by, case.ax, case.ay, 1.0 - case.t, case.slack, case.unit)
        assert 0.0 < swapped.t < 1.0 or case.t < 1e-9
        if 0.0 < swapped.t < 1.0:
            assert faults(swapped, split_point) == []

    @given(st.integers(-(2**20), 2**20), st.integers(-(2**20), 2**20), st.integers(1, 25))
    def test_a_coarse_segment_is_halved_again_and_again(self, x: int, y: int, levels: int) -> None:
        ax, ay, bx, by = 0.0, 1.0, float(2 * x + 1), float(y)
        for _ in range(levels):
            bx, by, exact = split_point(ax, ay, bx, by, 0.5, 0.0, MIN_UNIT_DEGREE_4)
            assert exact
        assert Fraction(bx) == Fraction(2 * x + 1, 2**levels)

    @pytest.mark.parametrize("scale", [1e300, 1e-300, 5e-324, 1.7e308])
    def test_outside_the_window_nothing_false_is_claimed(self, scale: float) -> None:
        case = Case(scale, 0.0, -scale, scale, 0.3, 0.1, 5e-324)
        x, y, exact = split_point(*case)
        assert -scale <= x <= scale
        assert 0.0 <= y <= scale
        cross = (Fraction(x) - Fraction(scale)) * Fraction(scale) + Fraction(y) * 2 * Fraction(scale)
        assert not exact or cross == 0


def naive(ax: float, ay: float, bx: float, by: float, t: float, slack: float, unit: float) -> tuple[float, float, bool]:
    """Add the step in doubles and believe it."""
    assert slack >= 0.0
    assert unit > 0.0
    return ax + t * (bx - ax), ay + t * (by - ay), True


def careless(
    ax: float, ay: float, bx: float, by: float, t: float, slack: float, unit: float
) -> tuple[float, float, bool]:
    """Look at the rounded difference only."""
    dx, _ = two_diff(bx, ax)
    dy, _ = two_diff(by, ay)
    if ax + dx == bx and ay + dy == by:
        return split_point(ax, ay, bx, by, t, slack, unit)
    return ax + t * dx, ay + t * dy, True


class TestControls:
    """Controls: the same law rejects splitting by plain arithmetic, and ignoring the tails of the differences."""

    def test_control_plain_arithmetic(self) -> None:
        """The step added in plain doubles, and believed."""
        assert faults(NAMED["no bits left"], naive) != []

    def test_control_ignored_tails(self) -> None:
        """A difference that was rounded, taken for exact."""
        assert faults(NAMED["a difference that is no double"], careless) != []

    def test_control_the_nearest_parameter(self) -> None:
        """An eighth of the slack: the nearest parameter, where a coarser one would be exact."""

        def nearest(
            ax: float, ay: float, bx: float, by: float, t: float, slack: float, unit: float
        ) -> tuple[float, float, bool]:
            return split_point(ax, ay, bx, by, t, slack / 8.0, unit)

        assert faults(NAMED["a coarse one before the nearest one"], nearest) != []
