"""K6: the windows in which doubles suffice: exact inside, left to the rationals one step outside."""

import math
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from proofs_tests.kernel import oracle
from proofs_tests.kernel.strategies import Point, point_tuples

import exactkernel as ek
from exactkernel import constants
from exactkernel.context import bits_of, make_context, scaled_into_window
from exactkernel.incircle import incircle_adaptive, on_common_grid
from exactkernel.orient2d import orient2d_adaptive

STEP_2 = math.ulp(constants.MIN_COORDINATE_DEGREE_2)
STEP_4 = math.ulp(constants.MIN_COORDINATE_DEGREE_4)


def largest_unit(values: list[float]) -> Fraction | None:
    """The largest power of two that divides all of the values; None if they are all zero."""
    exact = [Fraction(v) for v in values if v != 0.0]
    if not exact:
        return None
    common = math.lcm(*(f.denominator for f in exact))
    integer = math.gcd(*(int(f * common) for f in exact))
    return Fraction(integer & -integer, common)


@pytest.mark.obligation(
    "K6",
    "a coordinate inside the window is decided in doubles, one step outside in rationals",
    method="named cases",
    control_in="TestContext",
)
class TestScalarWindow:
    """At each end of each window: the last coordinate inside needs no rationals, the next one outside always does."""

    @staticmethod
    def stages(
        staged: Callable[..., tuple[ek.Sign, ek.Stage]], exact: Callable[..., int], size: float
    ) -> set[ek.Stage]:
        corners: list[Point] = [(size, size), (-size, size), (-size, -size), (size, -size), (0.0, 0.0)]
        n = 4 if staged is ek.incircle_staged else 3
        tuples = [tuple(corners[(i + j * j) % 5] for j in range(n)) for i in range(5)]
        tuples += [((size, 0.0), (0.0, size), (-size, 0.0), (0.0, -size))[:n]]
        seen = set()
        for points in tuples:
            sign, stage = staged(*points)
            assert sign == exact(*points)
            seen.add(stage)
        return seen

    @pytest.mark.parametrize(
        ("staged", "exact", "smallest", "largest"),
        [
            (ek.orient2d_staged, oracle.orient2d, constants.MIN_COORDINATE_DEGREE_2, constants.MAX_COORDINATE_DEGREE_2),
            (
                ek.diametral_staged,
                oracle.diametral,
                constants.MIN_COORDINATE_DEGREE_2,
                constants.MAX_COORDINATE_DEGREE_2,
            ),
            (ek.incircle_staged, oracle.incircle, constants.MIN_COORDINATE_DEGREE_4, constants.MAX_COORDINATE_DEGREE_4),
        ],
    )
    def test_both_ends(
        self,
        staged: Callable[..., tuple[ek.Sign, ek.Stage]],
        exact: Callable[..., int],
        smallest: float,
        largest: float,
    ) -> None:
        for inside in (smallest, math.nextafter(smallest, 1.0), math.nextafter(largest, 1.0), largest):
            assert ek.Stage.RATIONAL not in self.stages(staged, exact, inside)
        for outside in (math.nextafter(smallest, 0.0), math.nextafter(largest, math.inf)):
            assert self.stages(staged, exact, outside) == {ek.Stage.RATIONAL}


@pytest.mark.obligation(
    "K6",
    "the context finds the window of an input, and opens it exactly as far as it is exact",
    method="property-based",
)
class TestContext:
    """The scan finds the largest magnitude and the common unit; bounds are finite exactly inside the windows."""

    @given(st.lists(st.floats(allow_nan=False, allow_infinity=False), max_size=6))
    def test_scan(self, values: list[float]) -> None:
        self.check_scan(values)

    @given(
        st.lists(st.builds(math.ldexp, st.sampled_from([0.0, 1.0, -3.0, 5.0]), st.integers(-1074, 1020)), max_size=6)
    )
    def test_scan_of_few_bits(self, values: list[float]) -> None:
        self.check_scan(values)

    @staticmethod
    def check_scan(values: list[float]) -> None:
        maximum, unit = bits_of(np.array(values))
        assert maximum == max((abs(v) for v in values), default=0.0)
        expected = largest_unit(values)
        assert unit == math.inf if expected is None else Fraction(unit) == expected

    def test_control_a_unit_that_is_too_large_is_noticed(self) -> None:
        """The common unit of fewer numbers, which is too large."""
        assert largest_unit([1.0, 2.0**80]) == 1
        assert largest_unit([2.0**80]) == 2**80
        with pytest.raises(AssertionError):
            assert Fraction(bits_of(np.array([2.0**80]))[1]) == largest_unit([1.0, 2.0**80])

    @pytest.mark.parametrize(
        ("coordinates", "degree_2", "degree_4"),
        [
            ([constants.MIN_UNIT_DEGREE_2], True, False),
            ([constants.MIN_UNIT_DEGREE_2 / 2], False, False),
            ([constants.MAX_COORDINATE_DEGREE_2], True, False),
            ([math.nextafter(constants.MAX_COORDINATE_DEGREE_2, math.inf)], False, False),
            ([constants.MIN_UNIT_DEGREE_4], True, True),
            ([constants.MIN_UNIT_DEGREE_4 / 2], True, False),
            ([constants.MAX_COORDINATE_DEGREE_4], True, True),
            ([math.nextafter(constants.MAX_COORDINATE_DEGREE_4, math.inf)], True, False),
            ([0.0, -0.0], True, True),
            ([1e-200, 1e200], False, False),
        ],
    )
    def test_bounds(self, coordinates: list[float], degree_2: bool, degree_4: bool) -> None:
        context = make_context(np.array(coordinates))
        assert (context.orient2d_bound == constants.ORIENT2D_BOUND) is degree_2
        assert (context.incircle_bound == constants.INCIRCLE_BOUND) is degree_4
        assert math.isinf(context.orient2d_bound) is not degree_2
        assert math.isinf(context.incircle_bound) is not degree_4
        assert (context.grid_limit > 0.0) is degree_4

    @given(st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=4, max_size=4))
    def test_exact_at_the_bottom_of_the_windows(self, steps: list[tuple[int, int]]) -> None:
        lowest = np.array(steps) * constants.MIN_UNIT_DEGREE_4
        points = [tuple(p) for p in lowest.tolist()]
        context = make_context(lowest)._replace(grid_limit=0.0)
        assert incircle_adaptive(context, *lowest.ravel().tolist()) == oracle.incircle(*points)
        lowest = np.array(steps[:3]) * constants.MIN_UNIT_DEGREE_2
        points = [tuple(p) for p in lowest.tolist()]
        assert orient2d_adaptive(make_context(lowest), *lowest.ravel().tolist()) == oracle.orient2d(*points)

    def test_control_below_the_window_doubles_lie(self) -> None:
        """(unit, 0), (0, unit), (0, 0) one step below, with the bound of the inside: the product underflows to 0."""
        unit = constants.MIN_UNIT_DEGREE_2 / 4
        open_wide = make_context(np.array([1.0]))
        assert orient2d_adaptive(open_wide, unit, 0.0, 0.0, unit, 0.0, 0.0) == 0
        assert oracle.orient2d((unit, 0.0), (0.0, unit), (0.0, 0.0)) == 1


@pytest.mark.obligation("K6", "scaling into the window is exact and changes no sign", method="property-based")
class TestScaling:
    """The result is the input times one power of two, inside the window if any power of two leads there."""

    @given(point_tuples(4))
    def test_scaling(self, points: tuple[Point, ...]) -> None:
        coordinates = np.array(points)
        scaled, context = scaled_into_window(coordinates)
        assert self.is_power_of_two_times(coordinates, scaled)
        reachable = self.some_power_leads_inside(coordinates)
        assert math.isfinite(context.incircle_bound) == reachable

    @staticmethod
    def is_power_of_two_times(
        coordinates: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
        scaled: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
    ) -> bool:
        pairs = [(Fraction(x), Fraction(y)) for x, y in zip(coordinates.flat, scaled.flat, strict=True)]
        factors = {y / x for x, y in pairs if x != 0}
        powers = (n for factor in factors for n in (factor.numerator, factor.denominator))
        return len(factors) <= 1 and all(n & (n - 1) == 0 for n in powers) and all(y == 0 for x, y in pairs if x == 0)

    @staticmethod
    def some_power_leads_inside(coordinates: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> bool:
        values = coordinates.ravel().tolist()
        unit = largest_unit(values)
        if unit is None:
            return True
        largest = max(abs(Fraction(v)) for v in values)
        low = -268 - (unit.numerator.bit_length() - unit.denominator.bit_length())
        return any(
            unit * Fraction(2) ** e >= Fraction(constants.MIN_UNIT_DEGREE_4)
            and largest * Fraction(2) ** e <= Fraction(constants.MAX_COORDINATE_DEGREE_4)
            for e in range(low - 2, low + 3)
        )

    def test_no_power_leads_inside(self) -> None:
        wild = np.array([[1e-200, 1e200]])
        scaled, context = scaled_into_window(wild)
        assert scaled is wild
        assert math.isinf(context.incircle_bound)

    def test_inside_already(self) -> None:
        tame = np.array([[0.25, 3.0]])
        assert scaled_into_window(tame)[0] is tame

    def test_control_other_factors(self) -> None:
        """A factor of three, and one number scaled unlike the others."""
        coordinates = np.array([[1.0, 0.0], [3.0, 5.0]])
        assert self.is_power_of_two_times(coordinates, coordinates / 4.0)
        assert not self.is_power_of_two_times(coordinates, coordinates * 3.0)
        assert not self.is_power_of_two_times(coordinates, coordinates * np.array([[4.0], [2.0]]))
        assert not self.is_power_of_two_times(coordinates, coordinates + np.array([[0.0, 1.0], [0.0, 0.0]]))


@pytest.mark.obligation(
    "K6",
    "differences of 4096 grid units are decided exactly by the grid stage, 4097 by another",
    method="property-based",
)
class TestGridStage:
    """At the limit of the grid stage the double determinant is exact, zero included."""

    @staticmethod
    def stage_and_sign(points: tuple[Point, ...]) -> tuple[int, int]:
        coordinates = np.array([*points, (1.0, 1.0)])
        context = make_context(coordinates)
        adaptive, row = (orient2d_adaptive, 0) if len(points) == 3 else (incircle_adaptive, 1)
        sign = int(adaptive(context, *coordinates[:-1].ravel().tolist()))
        return int(np.flatnonzero(context.counts[row])[0]), sign

    @pytest.mark.parametrize("side", [4096.0, 4097.0])
    def test_limit(self, side: float) -> None:
        square = ((side, side), (0.0, side), (0.0, 0.0), (side, 0.0))
        line = ((side, side), (side - 1.0, side - 1.0), (0.0, 0.0))
        within = side <= constants.GRID_STEPS
        for points in (square, line):
            stage, sign = self.stage_and_sign(points)
            assert sign == 0
            assert (stage == ek.Stage.GRID) is within

    @given(st.lists(st.tuples(st.integers(-2047, 2047), st.integers(-2047, 2047)), min_size=4, max_size=4))
    def test_a_grid_of_their_own(self, corners: list[tuple[int, int]]) -> None:
        """Four points find their common grid themselves, at any scale, where that of the input is unknown."""
        for scale in (1.0, 2.0**-100, 2.0**90):
            coordinates = np.array(corners) * scale
            context = make_context(coordinates)._replace(grid_limit=0.0, incircle_bound=math.inf)
            sign = incircle_adaptive(context, *coordinates.ravel().tolist())
            assert sign == oracle.incircle(*[tuple(p) for p in coordinates.tolist()])
            stages = np.flatnonzero(context.counts[1])
            assert set(stages.tolist()) <= {int(ek.Stage.FILTER), int(ek.Stage.GRID)}

    def test_control_numbers_without_a_grid(self) -> None:
        """A difference of 4097 units, and a number off the grid."""
        assert on_common_grid(1.0, 2.0, 4095.0, -7.0, 0.0, 0.5 * 2)
        assert not on_common_grid(1.0, 2.0, 4097.0, -7.0, 0.0, 1.0)
        assert not on_common_grid(1.0, 2.0**-13, 0.0, 0.0, 0.0, 1.0)

    @given(st.lists(st.tuples(st.integers(0, 3), st.integers(0, 3)), min_size=4, max_size=4))
    def test_extreme_corners(self, choice: list[tuple[int, int]]) -> None:
        sides = (0.0, 1.0, 4095.0, 4096.0)
        points = tuple((sides[i], sides[j]) for i, j in choice)
        stage, sign = self.stage_and_sign(points)
        assert sign == oracle.incircle(*points)
        assert stage in (ek.Stage.FILTER, ek.Stage.GRID)

    def test_control_doubles_are_not_exact_on_a_larger_grid(self) -> None:
        """A limit of 2^30 units in the place of 4096."""
        n = 2.0**27
        coordinates = [(n + 1.0, n), (n, n - 1.0), (0.0, 0.0)]
        too_wide = make_context(np.array(coordinates))._replace(grid_limit=2.0**30)
        assert oracle.orient2d(*coordinates) == -1
        assert orient2d_adaptive(too_wide, *np.ravel(coordinates).tolist()) == 0
