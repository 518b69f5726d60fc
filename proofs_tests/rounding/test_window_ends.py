"""K6, every other window and guard of the code: exact at its ends, left to the rationals one step outside."""

import math
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from proofs_tests.graphs.crossing_oracle import is_nearest, proper_crossing
from proofs_tests.kernel import oracle as kernel_oracle
from proofs_tests.kernel import shape_oracle
from proofs_tests.kernel.strategies import Point
from proofs_tests.kernel.test_bisector import ORACLES
from proofs_tests.oracles import circumcircle, rationals

import exactkernel as ek
from exactkernel import constants
from exactkernel.angle import AngleBound, angle_above_adaptive, angle_below_adaptive, angle_bound, angle_filter
from exactkernel.bisector import _SMALLEST_PRODUCT as SMALLEST_STEP
from exactkernel.bisector import _nearest_coordinate, along_adaptive, crossing_order_adaptive, nearer_adaptive
from exactkernel.centre import circumcentre_in_pairs
from exactkernel.context import Context, exponent_into_window, guarded_context, make_context, scaled_into_window
from exactkernel.crossing import _SMALLEST_PRODUCT, _coordinate, crossing_in_pairs
from exactkernel.incircle import incircle_adaptive
from exactkernel.measure import area_above_adaptive, area_filter, length_above_adaptive, length_filter
from exactkernel.orient2d import orient2d_adaptive
from exactmesh.crossings.crossing_points import CrossingRounder
from exactmesh.crossings.hot_pixels import _SAFE, _in_grid_units
from exactmesh.refinement.split_point import _LARGEST, _SMALLEST, split_point
from exactmesh.verify.grading import grade
from exactmesh.verify.severity import RESOLVED, UNKNOWN
from exactmesh.voronoi.centres import centres_of

LOW_2, HIGH_2 = constants.MIN_COORDINATE_DEGREE_2, constants.MAX_COORDINATE_DEGREE_2
LOW_4, HIGH_4 = constants.MIN_COORDINATE_DEGREE_4, constants.MAX_COORDINATE_DEGREE_4
RATIONAL = int(ek.Stage.RATIONAL)


def below(x: float) -> float:
    return math.nextafter(x, 0.0)


def above(x: float) -> float:
    return math.nextafter(x, math.inf)


def flat(points: tuple[Point, ...]) -> list[float]:
    return [x for point in points for x in point]


def asked_rationals(k: Context) -> bool:
    return bool(k.mailbox.any())


def corners(size: float) -> tuple[Point, ...]:
    """A right triangle with legs of that size, counterclockwise, no angle of 30 degrees."""
    return ((0.0, 0.0), (size, 0.0), (0.0, size))


@pytest.mark.obligation(
    "K6", "angles, areas, lengths: doubles inside the window, rationals outside", method="named cases"
)
class TestShapes:
    """At both ends of the window of degree 2, the last size inside needs no rationals, the next one outside always
    does; the answer is exact in both."""

    SIZES = ((LOW_2, HIGH_2), (below(LOW_2), above(HIGH_2)))

    @staticmethod
    def answers(size: float, bounds: tuple[AngleBound, float, float]) -> tuple[list[bool], list[bool], list[Context]]:
        points = corners(size)
        contexts = [guarded_context() for _ in range(4)]
        degrees, area, length = bounds
        found = [
            angle_below_adaptive(contexts[0], degrees, *flat(points)),
            angle_above_adaptive(contexts[1], degrees, *flat(points)),
            area_above_adaptive(contexts[2], area, *flat(points)),
            length_above_adaptive(contexts[3], length, *flat(points[1:])),
        ]
        exact = [
            shape_oracle.angle_below(points, degrees.degrees),
            shape_oracle.angle_above(points, degrees.degrees),
            shape_oracle.area_above(points, area),
            shape_oracle.length_above(points[1:], length),
        ]
        return found, exact, contexts

    @pytest.mark.parametrize("size", SIZES[0])
    def test_inside(self, size: float) -> None:
        for degrees in (45.0, 90.0):  # others are too light at the lower end for anything but rationals
            for factor in (1.0, 2.0):
                area = math.ldexp(factor, 2 * math.frexp(size)[1] - 3) if size > 1.0 else factor * size * size
                bounds = (angle_bound(degrees), area, factor * size if size < 1.0 else 0.5 * factor * size)
                found, exact, contexts = self.answers(size, bounds)
                assert found == exact
                assert not any(asked_rationals(k) for k in contexts)

    @pytest.mark.parametrize("size", SIZES[1])
    def test_outside(self, size: float) -> None:
        found, exact, contexts = self.answers(size, (angle_bound(30.0), 1.0, 1.0))
        assert found == exact
        assert all(k.counts[0, RATIONAL] == k.counts.sum() == 1 for k in contexts)

    def test_the_bound_of_a_length_has_the_same_window(self) -> None:
        """The bound is squared, so it has to be inside, too: where the filter does not decide, rationals do."""
        for bound in (below(LOW_2), 5e-324):
            k = guarded_context()
            assert not length_above_adaptive(k, bound, 0.0, 0.0, bound, 0.0)
            assert k.counts[0, RATIONAL] == 1
        k = guarded_context()
        assert not length_above_adaptive(k, LOW_2, 0.0, 0.0, LOW_2, 0.0)
        assert k.counts[0, RATIONAL] == 0

    def test_control_a_window_that_is_open_wide_lies(self) -> None:
        """The bound of the inside, for a triangle that is far outside: its area underflows."""
        tiny = make_context(np.ones((1, 2)))._replace(grid_limit=1.0)
        assert not area_above_adaptive(tiny, 0.0, *flat(corners(2.0**-540)))
        assert shape_oracle.area_above(corners(2.0**-540), 0.0)


@pytest.mark.obligation(
    "K6", "the filters of shapes decide from SMALLEST_WEIGHT on, and not below", method="named cases"
)
class TestWeights:
    """A weight of exactly SMALLEST_WEIGHT decides, the next one below does not; grade is the same at LARGEST_WEIGHT."""

    FACTOR = constants.SHAPE_FACTOR * constants.ORIENT2D_BOUND
    ROOT = 2.0**-425  # its square is the smallest weight

    def test_area(self) -> None:
        assert self.ROOT**2 == constants.SMALLEST_WEIGHT
        assert area_filter(self.FACTOR, 0.0, self.ROOT, 0.0, 0.0, self.ROOT) == 1
        assert area_filter(self.FACTOR, 0.0, below(self.ROOT), 0.0, 0.0, self.ROOT) == 0

    def test_length(self) -> None:
        assert length_filter(self.FACTOR, 0.0, self.ROOT, 0.0) == 1
        assert length_filter(self.FACTOR, 0.0, below(self.ROOT), 0.0) == 0

    def test_angle(self) -> None:
        flat_bound = angle_bound(0.0)  # sine 0, cosine 1: minus the cross product
        weight = constants.SMALLEST_WEIGHT
        assert angle_filter(self.FACTOR, flat_bound, weight, weight, 0.0, 0.0) == -1
        assert angle_filter(self.FACTOR, flat_bound, below(weight), below(weight), 0.0, 0.0) == 0

    def test_grade(self) -> None:
        low, high = constants.SMALLEST_WEIGHT, constants.LARGEST_WEIGHT
        assert {int(grade(w, w, constants.ORIENT2D_BOUND)) for w in (low, high)} == {RESOLVED}
        assert {int(grade(w, w, constants.ORIENT2D_BOUND)) for w in (below(low), above(high))} == {UNKNOWN}

    def test_control_without_the_guard_a_bound_underflows(self) -> None:
        """The bound of a small weight is 0: anything is certified."""
        assert self.FACTOR * 5e-324 == 0.0


ADAPTIVE: dict[str, tuple[Callable[..., int], int, float, float]] = {
    "nearer": (nearer_adaptive, 3, constants.MIN_UNIT_DEGREE_4, HIGH_4),
    "along": (along_adaptive, 4, constants.MIN_UNIT_DEGREE_2, HIGH_2),
    "crossing order": (crossing_order_adaptive, 5, constants.MIN_UNIT_DEGREE_4, HIGH_4),
    "orient2d": (orient2d_adaptive, 3, constants.MIN_UNIT_DEGREE_2, HIGH_2),
    "incircle": (incircle_adaptive, 4, constants.MIN_UNIT_DEGREE_4, HIGH_4),
}
EXACT = {**ORACLES, "orient2d": kernel_oracle.orient2d, "incircle": kernel_oracle.incircle}


@pytest.mark.obligation("K6", "in a loop: exact at both ends of the window without rationals", method="named cases")
class TestLoops:
    """Tuples of few multiples of the smallest unit, and of the largest coordinates, 150 each, are decided exactly in
    doubles and expansions; one step outside the context closes the window."""

    @staticmethod
    def tuples(n: int, unit: float, largest: float) -> list[tuple[Point, ...]]:
        random = np.random.default_rng(6)
        steps = random.integers(-2, 3, (150, n, 2))
        edges = random.choice([0.0, 1.0, -1.0, 1.0 - 2.0**-53, -1.0 + 2.0**-53, 0.5], (150, n, 2))
        both = [*(steps * unit), *(edges * largest)]
        return [tuple((float(x), float(y)) for x, y in rows) for rows in both]

    @pytest.mark.parametrize("name", ADAPTIVE)
    def test_ends(self, name: str, record_property: Callable[[str, object], None]) -> None:
        adaptive, n, unit, largest = ADAPTIVE[name]
        cases = self.tuples(n, unit, largest)
        record_property("cases", len(cases))
        for points in cases:
            k = make_context(np.array(points))._replace(grid_limit=0.0)
            assert adaptive(k, *flat(points)) == EXACT[name](*rationals(points))
            assert not asked_rationals(k)

    @pytest.mark.parametrize("name", ADAPTIVE)
    def test_one_step_outside(self, name: str) -> None:
        adaptive, n, unit, largest = ADAPTIVE[name]
        for size in (unit / 2.0, above(largest)):
            points: tuple[Point, ...] = (*corners(size), (size, size), (0.0, size))[:n]
            k = make_context(np.array(points))
            assert adaptive(k, *flat(points)) == EXACT[name](*rationals(points))
            assert asked_rationals(k)

    @pytest.mark.parametrize("name", ADAPTIVE)
    def test_control_forced_open_they_lie(self, name: str) -> None:
        """The bounds of the inside, far outside of the window."""
        adaptive, n, unit, _ = ADAPTIVE[name]
        k = make_context(np.ones((1, 2)))._replace(grid_limit=0.0)
        lies, outside = 0, 2.0**-541 if name == "nearer" else unit * 2.0**-4  # nearer is of degree 2 only
        for points in self.tuples(n, outside, 0.0)[:150]:
            lies += adaptive(k, *flat(points)) != EXACT[name](*rationals(points))
        assert lies > 0


@pytest.mark.obligation("K6", "circumcentres and crossings are bounded inside the window of degree 4, unknown outside",
                        method="named cases")  # fmt: skip
class TestConstructions:
    """At both ends of the window the exact point is within the stated error; one step outside the error is infinite."""

    SIZES = ((LOW_4, HIGH_4), (below(LOW_4), above(HIGH_4)))

    @pytest.mark.parametrize("size", SIZES[0])
    def test_inside(self, size: float) -> None:
        points = ((0.0, 0.0), (size, 0.0), (0.75 * size if size > 1.0 else size, size))
        x, xt, xe, y, yt, ye = circumcentre_in_pairs(guarded_context(), *flat(points))
        centre, _ = circumcircle(*rationals(points))
        assert abs(Fraction(x) + Fraction(xt) - centre[0]) <= Fraction(xe)
        assert abs(Fraction(y) + Fraction(yt) - centre[1]) <= Fraction(ye)
        ends = ((-size, -size), (size, size), (-size, size), (size, -size))
        x, xt, xe, y, yt, ye = crossing_in_pairs(guarded_context(), *flat(ends))
        a, b, c, d = rationals(ends)
        crossing = proper_crossing((a, b), (c, d))
        assert crossing is not None
        assert abs(Fraction(x) + Fraction(xt) - crossing[0]) <= Fraction(xe)
        assert abs(Fraction(y) + Fraction(yt) - crossing[1]) <= Fraction(ye)

    @pytest.mark.parametrize("size", SIZES[1])
    def test_outside(self, size: float) -> None:
        assert circumcentre_in_pairs(guarded_context(), *flat(corners(size)))[2::3] == (math.inf, math.inf)
        ends = ((-size, -size), (size, size), (-size, size), (size, -size))
        assert crossing_in_pairs(guarded_context(), *flat(ends))[2::3] == (math.inf, math.inf)

    def test_smallest_product(self) -> None:
        """A product of a numerator and a difference that is below 2^-900 is not trusted."""
        step = 2.0**-450
        assert step * step == _SMALLEST_PRODUCT == SMALLEST_STEP
        assert _coordinate(0.0, step, 0.0, 0.0, 1.0, step, 0.0, 0.0, 1.0, 0.0, 0.0)[2] < math.inf
        assert _coordinate(0.0, below(step), 0.0, 0.0, 1.0, step, 0.0, 0.0, 1.0, 0.0, 0.0)[2] == math.inf
        assert _nearest_coordinate(0.0, step, step, 0.0, 0.0, 1.0, 0.0, 0.0)[1]
        assert not _nearest_coordinate(0.0, below(step), step, 0.0, 0.0, 1.0, 0.0, 0.0)[1]

    def test_scaled_back_to_subnormal_doubles(self) -> None:
        """Below 2^-1021 scaling back could round a second time: the nearest double all the same."""
        base = np.array([(0.0, 0.0), (3.0, 1.0), (1.0, 7.0)])
        for exponent in range(-1074, -1010, 3):
            points = np.ldexp(base, exponent)
            ((x, y),) = centres_of(points, np.array([(0, 1, 2)], dtype=np.int32)).tolist()
            centre, _ = circumcircle(*rationals(points.tolist()))
            assert (x, y) == (float(centre[0]), float(centre[1]))
            ends = np.ldexp(np.array([(0.0, 0.0), (5.0, 3.0), (0.0, 2.0), (4.0, 1.0)]), exponent)
            segments = np.array([(0, 1), (2, 3)], dtype=np.int32)
            rounder = CrossingRounder(ends, segments)
            ((x, y),) = rounder(np.zeros(1, dtype=np.int32), np.ones(1, dtype=np.int32)).tolist()
            a, b, c, d = rationals(ends.tolist())
            crossing = proper_crossing((a, b), (c, d))
            assert crossing is not None
            assert is_nearest(x, crossing[0])
            assert is_nearest(y, crossing[1])

    def test_control_a_bound_of_nothing_does_not_hold(self) -> None:
        """The stated error, taken as zero: the exact centre is not within it."""
        points = ((0.1, 0.2), (3.3, 1.7), (1.9, 7.1))
        x, xt, xe, *_ = circumcentre_in_pairs(guarded_context(), *flat(points))
        centre, _ = circumcircle(*rationals(points))
        assert 0 < abs(Fraction(x) + Fraction(xt) - centre[0]) <= Fraction(xe)


@pytest.mark.obligation("K6", "the windows of splitting segments and of pixels", method="named cases")
class TestOtherWindows:
    """split_point claims exact points up to 2^900 and from differences of 2^-900 on; pixels are decided in doubles from
    2^-200 units on; one step outside neither is."""

    def test_split_point(self) -> None:
        assert split_point(0.0, 0.0, _LARGEST, 0.0, 0.5, 0.25, 2.0**-1074) == (_LARGEST / 2.0, 0.0, True)
        assert not split_point(0.0, 0.0, above(_LARGEST), 0.0, 0.5, 0.25, 2.0**-1074)[2]
        assert split_point(0.0, 0.0, _SMALLEST, 0.0, 0.5, 0.25, 2.0**-1074) == (_SMALLEST / 2.0, 0.0, True)
        assert not split_point(0.0, 0.0, below(_SMALLEST), 0.0, 0.5, 0.25, 2.0**-1074)[2]

    def test_pixels(self) -> None:
        ends = np.array([(3.0, _SAFE), (3.0, below(_SAFE)), (3.0, 0.0)])
        safe = _in_grid_units(np.ones((3, 2)), ends, (1.0, 1.0)).safe
        assert safe.tolist() == [True, False, True]

    def test_exponent_into_window(self) -> None:
        """Where some power of two leads inside, the exponent does; else it is 0."""
        for wanted in (-1000, -300, 300, 900):
            points = np.ldexp(np.array([(1.0, 3.0), (5.0, 7.0)]), wanted)
            exponent = exponent_into_window(float(points.max()), math.ldexp(1.0, wanted))
            assert math.isfinite(make_context(np.ldexp(points, exponent)).incircle_bound)
            assert math.isfinite(scaled_into_window(points)[1].incircle_bound)
        assert exponent_into_window(1e200, 1e-200) == 0
        assert exponent_into_window(1.0, 0.5) == 0

    def test_control_a_difference_that_is_too_small_is_no_exact_pair(self) -> None:
        """Dekker's product of a number of 53 bits and a tail below 2^-970 loses bits."""
        x, s = 2.0**-1000 * (1.0 + 2.0**-52), 1.0 / 3.0
        assert Fraction(x) * Fraction(s) != Fraction(x * s) + Fraction(
            float(Fraction(x) * Fraction(s) - Fraction(x * s))
        )
