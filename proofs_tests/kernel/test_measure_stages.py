"""K7: the stages of areas and lengths against a bound: each decides all that its error bound allows, nothing else."""

import itertools
import math
import random
from collections.abc import Callable, Iterator

import numpy as np
import pytest
from proofs_tests.kernel.interpreted import Workspace, interpreted, watched_expansions
from proofs_tests.rounding.magnitudes import Magnitude, cross, difference, inner, number

from exactkernel import measure
from exactkernel.constants import (
    DD_BOUND,
    LARGEST_WEIGHT,
    MAX_COORDINATE_DEGREE_2,
    MIN_COORDINATE_DEGREE_2,
    ORIENT2D_BOUND,
    SHAPE_FACTOR,
    SMALLEST_WEIGHT,
)
from exactkernel.context import SCRATCH_SIZE, Context, guarded_context, make_context
from exactkernel.measure import area_above_adaptive, area_code, length_above_adaptive, length_code
from exactkernel.types import Stage

Point = tuple[float, float]


def area(bound: float, a: Point, b: Point, c: Point) -> Magnitude:
    return cross(difference(b, a), difference(c, a)) - (number(bound) + number(bound))


def length(bound: float, a: Point, b: Point) -> Magnitude:
    u = difference(b, a)
    return inner(u, u) - number(bound) * number(bound)


MEASURES: dict[str, tuple[Callable[..., Magnitude], Callable[..., int], Callable[..., bool], int]] = {
    "area": (area, area_code, area_above_adaptive, 3),
    "length": (length, length_code, length_above_adaptive, 2),
}


def flat(points: tuple[Point, ...]) -> list[float]:
    return [x for point in points for x in point]


def code_of(stage: Stage, sign: int) -> int:
    return int(stage) * 4 + sign + 1


def small(draw: random.Random, n: int) -> tuple[float, tuple[Point, ...]]:
    points = tuple((float(draw.randint(-3, 3)), float(draw.randint(-3, 3))) for _ in range(n))
    return float(draw.randint(0, 12)) / 2, points


def tiny(draw: random.Random) -> float:
    return draw.choice((-1, 1)) * draw.uniform(1.0, 2.0) * 2.0 ** -draw.randint(25, 130)


def near_ties(name: str, draw: random.Random) -> tuple[float, tuple[Point, ...]]:
    """Off a tie by 2^-25 to 2^-130, or by the rounding of a bound; differences have tails."""
    deltas = [tiny(draw) for _ in range(4)]
    x, y = draw.choice([(3.0, 4.0), (5.0, 12.0), (draw.uniform(1, 2), draw.uniform(1, 2))])
    if name == "area":
        return x * y / 2, ((deltas[0], deltas[1]), (x, deltas[2]), (deltas[3], y))
    return math.hypot(x, y), ((deltas[0], deltas[1]), (x, y))


@interpreted
@pytest.mark.obligation(
    "K7", "each stage of areas and lengths decides what its bound allows, and no more", method="named cases"
)
class TestStages:
    """A value beyond a stage's bound times its permanent is decided there, one within it is left to the next.

    With bounds so large that small integers meet them, and everything exact, the borders are met exactly.
    """

    @pytest.mark.parametrize("name", MEASURES)
    @pytest.mark.parametrize("grid", [0.0, 2.0])
    def test_borders(self, name: str, grid: float, monkeypatch: pytest.MonkeyPatch) -> None:
        exact, code, above, n = MEASURES[name]
        least, most = 9.0, 19.0
        for constant, number_given in (("ORIENT2D_BOUND", 2.0**-3), ("DD_BOUND", 2.0**-5), ("SMALLEST_WEIGHT", least),
                                ("LARGEST_WEIGHT", most)):  # fmt: skip
            monkeypatch.setattr(measure, constant, number_given)
        k = make_context(np.ones(1))._replace(orient2d_bound=2.0**-4, grid_limit=grid)
        draw, met = random.Random(1), set()
        for _ in range(1000):
            bound, points = small(draw, n)
            value = exact(bound, *points)
            heavy, light = value.permanent >= least, value.permanent <= most
            sides = [abs(x.value) for q in points[1:] for x in difference(q, points[0])]
            if heavy and value.exceeds(SHAPE_FACTOR * 2.0**-3):
                wanted = Stage.FILTER
            elif name == "area" and max(sides) <= grid:
                wanted = Stage.GRID
            elif heavy and light and value.exceeds(2.0**-5):
                wanted = Stage.DOUBLE_DOUBLE
            else:
                wanted = Stage.EXPANSION
            assert code(k, bound, *flat(points)) == code_of(wanted, value.sign), (bound, points)
            k.counts[:] = 0
            assert above(k, bound, *flat(points)) == (value.sign > 0)
            first = heavy and value.exceeds(SHAPE_FACTOR * 2.0**-4)
            assert k.counts.tolist() == [[int(i == (0 if first else wanted)) for i in range(5)], [0] * 5]
            met.add((wanted, value.sign))
        assert len(met) >= 7

    @pytest.mark.parametrize("name", MEASURES)
    def test_near_ties(self, name: str) -> None:
        """With the published bounds: the sign is right, and decided no later than twice the bound of a stage asks."""
        exact, code, above, _ = MEASURES[name]
        k, draw, met = make_context(np.ones(1))._replace(grid_limit=0.0), random.Random(2), set()
        for _ in range(400):
            bound, points = near_ties(name, draw)
            value = exact(bound, *points)
            latest = (
                Stage.FILTER if value.exceeds(2 * SHAPE_FACTOR * ORIENT2D_BOUND)
                else Stage.DOUBLE_DOUBLE if value.exceeds(2 * DD_BOUND) else Stage.EXPANSION
            )  # fmt: skip
            found = code(k, bound, *flat(points))
            assert (found & 3) - 1 == value.sign, points
            assert found >> 2 <= latest
            assert above(k, bound, *flat(points)) == (value.sign > 0)
            met.add(found)
        assert {
            code_of(stage, sign) for stage in (Stage.FILTER, Stage.DOUBLE_DOUBLE, Stage.EXPANSION) for sign in (-1, 1)
        } <= met

    def test_the_weights_of_the_published_windows(self) -> None:
        """The filter needs the smallest weight; one step below, expansions decide; above the largest likewise."""
        k = make_context(np.ones(1))._replace(grid_limit=0.0)
        for size, decided in ((SMALLEST_WEIGHT, Stage.FILTER), (math.nextafter(SMALLEST_WEIGHT, 0.0), Stage.EXPANSION)):
            assert area_code(k, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, size) == code_of(decided, 1)
        for size, decided in ((2.0**-425, Stage.FILTER), (2.0**-426, Stage.EXPANSION)):
            assert length_code(k, 0.0, 0.0, 0.0, size, 0.0) == code_of(decided, 1)
        for weight, decided in ((LARGEST_WEIGHT, Stage.DOUBLE_DOUBLE), (2 * LARGEST_WEIGHT, Stage.EXPANSION)):
            x = weight / 2.0**500 / 2.0
            assert area_code(k, math.nextafter(weight / 4, 0.0), 0.0, 0.0, x, 0.0, 0.0, 2.0**500) == code_of(decided, 1)
        for x, decided in ((2.0**494, Stage.DOUBLE_DOUBLE), (2.0**495, Stage.EXPANSION)):
            assert length_code(k, math.nextafter(x, 0.0), 0.0, 0.0, x, 0.0) == code_of(decided, 1)

    def test_control_another_factor_is_noticed(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """A filter with half of its factor."""
        monkeypatch.setattr(measure, "SHAPE_FACTOR", 2.0)
        with pytest.raises(AssertionError):
            self.test_borders("area", 0.0, monkeypatch)
        with pytest.raises(AssertionError):
            self.test_borders("length", 0.0, monkeypatch)


def unsafe(n: int) -> Iterator[list[float]]:
    """Coordinates of which exactly one is one step outside of the window, for each place and each end."""
    inside = [0.0, MIN_COORDINATE_DEGREE_2, MAX_COORDINATE_DEGREE_2, 1.0, -1.0, 0.5]
    for place, x in itertools.product(
        range(n), (math.nextafter(MIN_COORDINATE_DEGREE_2, 0.0), math.nextafter(MAX_COORDINATE_DEGREE_2, math.inf))
    ):
        yield [*inside[:place], x, *inside[place + 1 : n]]


@interpreted
@pytest.mark.obligation(
    "K6", "areas and lengths: rationals decide outside of the window, and only there", method="named cases"
)
class TestWindow:
    """One coordinate outside is enough; a guarded context looks at each, an open one trusts them."""

    @pytest.mark.parametrize("name", MEASURES)
    def test_each_coordinate(self, name: str) -> None:
        exact, code, _, n = MEASURES[name]
        guarded, trusted = guarded_context(), make_context(np.ones(1))
        for coordinates in unsafe(2 * n):
            points = tuple(zip(coordinates[::2], coordinates[1::2], strict=True))
            assert code(guarded, 1.0, *coordinates) == code_of(Stage.RATIONAL, exact(1.0, *points).sign)
            assert code(trusted, 1.0, *coordinates) >> 2 != Stage.RATIONAL
        inside = [0.0, MIN_COORDINATE_DEGREE_2, MAX_COORDINATE_DEGREE_2, 1.0, -1.0, 0.5][: 2 * n]
        assert code(guarded, 1.0, *inside) >> 2 != Stage.RATIONAL

    def test_bounds_of_lengths_are_squared(self) -> None:
        edge = (0.0, 0.0, 1.0, 1.0)
        for k in (guarded_context(), make_context(np.ones(1))):
            for bound in (MIN_COORDINATE_DEGREE_2, MAX_COORDINATE_DEGREE_2):
                assert length_code(k, bound, *edge) >> 2 == Stage.FILTER
            for bound in (
                math.nextafter(MIN_COORDINATE_DEGREE_2, 0.0),
                math.nextafter(MAX_COORDINATE_DEGREE_2, math.inf),
            ):
                assert length_code(k, bound, *edge) == code_of(Stage.RATIONAL, 1 if bound < 1.0 else -1)

    def test_bounds_that_nothing_exceeds(self) -> None:
        """Infinity; and for areas of safe coordinates, whatever is infinite when doubled: the filter's answer is no."""
        huge, largest = [1.7e308, 0.0, 0.0, 1.7e308, -1.7e308, -1.7e308], 1.7976931348623157e308
        for k in (guarded_context(), make_context(np.ones(1))):
            assert area_code(k, math.inf, *huge) == length_code(k, math.inf, *huge[:4]) == code_of(Stage.FILTER, -1)
            assert area_code(k, largest, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0) == code_of(Stage.FILTER, -1)
        assert area_code(guarded_context(), largest, *huge) == code_of(Stage.RATIONAL, 1)

    def test_control_an_open_context_lies_outside(self) -> None:
        """A context that trusts coordinates outside of the window."""
        tiny_edge = (0.0, 0.0, 2.0**-600, 0.0)
        assert length_code(make_context(np.ones(1)), 0.0, *tiny_edge) & 3 == 1
        assert length_code(guarded_context(), 0.0, *tiny_edge) & 3 == 2


@interpreted
@pytest.mark.obligation("K5", "the workspaces of areas and lengths hold the longest expansions", method="calculus")
class TestWorkspaces:
    """Whatever the input: an expansion has room for the longest that its operands allow, and no two overlap."""

    @pytest.mark.parametrize("name", MEASURES)
    def test_room(self, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
        _, code, _, n = MEASURES[name]
        watched_expansions(monkeypatch, measure)
        k = make_context(np.ones(1))._replace(scratch=Workspace.of(SCRATCH_SIZE), grid_limit=-1.0)
        assert code(k, 0.0, *[0.1, 0.3] * n) == code_of(Stage.EXPANSION, 0)

    def test_control_too_short_a_workspace_is_noticed(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """A workspace one double too short."""
        watched_expansions(monkeypatch, measure)
        k: Context = make_context(np.ones(1))._replace(scratch=Workspace.of(67), grid_limit=-1.0)
        with pytest.raises(AssertionError):
            area_code(k, 0.0, *[0.1, 0.3] * 3)
