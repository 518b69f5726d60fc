"""K7: the stages of angles against a bound: each decides all that its error bound allows, and nothing else."""

import importlib
import itertools
import math
import random
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from proofs_tests.kernel import shape_oracle
from proofs_tests.kernel.interpreted import interpreted
from proofs_tests.kernel.test_measure_stages import code_of, flat, tiny, unsafe
from proofs_tests.rounding.magnitudes import Magnitude, Vector, cross, difference, inner, number

from exactkernel.angle import (
    AngleBound,
    angle_above_adaptive,
    angle_below_adaptive,
    angle_bound,
    corner_code,
    some_corner,
)
from exactkernel.constants import DD_BOUND, LARGEST_WEIGHT, ORIENT2D_BOUND, SHAPE_FACTOR, SMALLEST_WEIGHT
from exactkernel.context import guarded_context, make_context
from exactkernel.types import Stage

angle = importlib.import_module("exactkernel.angle")
corner_expansion: Callable[..., int] = angle.corner_expansion
Point = tuple[float, float]

EXACT = (0.0, 45.0, 90.0, 135.0, 180.0)


def weighed(bound: AngleBound, u: Vector, v: Vector) -> Magnitude:
    """Return dot sin - cross cos, with sine and cosine as the pairs that they are."""
    sine, cosine = (
        Magnitude(Fraction(head) + Fraction(tail), abs(Fraction(head)))
        for head, tail in ((bound.sine, bound.sine_tail), (bound.cosine, bound.cosine_tail))
    )
    return inner(u, v) * sine - cross(u, v) * cosine


def corner(bound: AngleBound, a: Point, b: Point, c: Point) -> Magnitude:
    return weighed(bound, difference(b, a), difference(c, a))


def small(draw: random.Random) -> tuple[Point, Point, Point]:
    """Triangles, counterclockwise, of small integers."""
    while True:
        a, b, c = ((float(draw.randint(-3, 3)), float(draw.randint(-3, 3))) for _ in range(3))
        turn = cross(difference(b, a), difference(c, a)).sign
        if turn != 0:
            return (a, b, c) if turn > 0 else (a, c, b)


def near_ties(draw: random.Random) -> tuple[float, tuple[Point, Point, Point]]:
    """An angle at the first corner off its bound by 2^-25 to 2^-130, or by roundings; differences have tails."""
    x, y, size = draw.uniform(1, 2), draw.uniform(1, 2), 2.0 ** draw.randint(-2, 2)
    a = (tiny(draw), tiny(draw))
    if draw.random() < 0.5:
        degrees = draw.choice((45.0, 90.0, 135.0))
        b = (x, 0.0) if degrees == 45.0 else (x, y)
        c = {45.0: (x, x), 90.0: (-y * size, x * size), 135.0: (-x - y, x - y)}[degrees]
        if degrees == 135.0:  # without a rounding
            b = (x, 0.0)
            c = (-x, x)
        return degrees, (a, b, c)
    degrees = draw.uniform(1.0, 179.0)
    turned = math.atan2(y, x) + math.radians(degrees)
    return degrees, (a, (x, y), (size * math.cos(turned), size * math.sin(turned)))


@interpreted
@pytest.mark.obligation("K7", "each stage of angles decides what its bound allows, and no more", method="named cases")
class TestStages:
    """A value beyond a stage's bound times its permanent is decided there, one within it is left to the next.

    With bounds so large that small integers meet them, and everything exact, the borders are met exactly.
    """

    @pytest.mark.parametrize("grid", [0.0, 2.0, 3.0])
    def test_borders(self, grid: float, monkeypatch: pytest.MonkeyPatch) -> None:
        least, most = 5.0, 14.0
        for constant, number_given in (("ORIENT2D_BOUND", 2.0**-4), ("DD_BOUND", 2.0**-4), ("SMALLEST_WEIGHT", least),
                                ("LARGEST_WEIGHT", most)):  # fmt: skip
            monkeypatch.setattr(angle, constant, number_given)
        k, draw, met = make_context(np.ones(1))._replace(grid_limit=grid), random.Random(1), set()
        for _ in range(900):
            points, bound = small(draw), angle_bound(draw.choice(EXACT))
            value = corner(bound, *points)
            heavy, light = value.permanent >= least, value.permanent <= most
            sides = [abs(x.value) for q in points[1:] for x in difference(q, points[0])]
            if heavy and value.exceeds(SHAPE_FACTOR * 2.0**-4):
                wanted = Stage.FILTER
            elif max(sides) <= grid:
                wanted = Stage.GRID
            elif heavy and light and value.exceeds(2.0**-4):
                wanted = Stage.DOUBLE_DOUBLE
            else:
                wanted = Stage.EXPANSION
            assert corner_code(k, bound, *flat(points)) == code_of(wanted, value.sign), (bound, points)
            met.add((wanted, value.sign))
        assert len(met) >= 7

    def test_filters_of_triangles(self) -> None:
        """The filter of a whole triangle decides where the largest or smallest scalar product is beyond its bound."""
        k, draw, met = make_context(np.ones(1))._replace(orient2d_bound=2.0**-4), random.Random(4), set()
        for _ in range(600):
            points, bound = small(draw), angle_bound(draw.choice(EXACT))
            a, b, c = points
            dots = [inner(difference(q, p), difference(r, p)) for p, q, r in ((a, b, c), (b, c, a), (c, a, b))]
            area = cross(difference(b, a), difference(c, b))
            largest = max(dot.permanent for dot in dots)
            for adaptive, choose, wanted in ((angle_below_adaptive, max, 1), (angle_above_adaptive, min, -1)):
                dot = Magnitude(choose(dot.value for dot in dots), largest)
                value = dot * number(bound.sine) - area * number(bound.cosine)
                k.counts[:] = 0
                assert adaptive(k, bound, *flat(points)) == (value.sign == wanted)
                is_filtered = value.exceeds(SHAPE_FACTOR * 2.0**-4)
                assert k.counts.sum() == 1
                if is_filtered:
                    assert k.counts[0, 0] == 1
                met.add((wanted, value.sign, is_filtered))
        assert len(met) == 10

    def test_triangles_that_the_filter_leaves_are_handed_on(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """And nothing else is: seen by what some_corner is asked."""
        asked: list[int] = []

        def some_corner(_: object, __: object, wanted: int, *___: float) -> bool:
            asked.append(wanted)
            return False

        monkeypatch.setattr(angle, "some_corner", some_corner)
        k = make_context(np.ones(1))._replace(orient2d_bound=2.0**-4)
        right = (0.0, 0.0, 1.0, 0.0, 0.0, 1.0)
        for degrees in (45.0, 90.0):
            for adaptive in (angle_below_adaptive, angle_above_adaptive):
                adaptive(k, angle_bound(degrees), *right)
        assert asked == [1, -1]  # the smallest is 45, the largest 90 degrees; the other two are certain
        assert k.counts[0].tolist() == [2, 0, 0, 0, 0]
        monkeypatch.setattr(angle, "SHAPE_FACTOR", 0.0)
        angle_below_adaptive(k, angle_bound(44.0), *right)
        assert asked == [1, -1]

    def test_near_ties(self) -> None:
        """With the published bounds: the sign is right, and decided no later than twice the bound of a stage asks."""
        k, draw, met = make_context(np.ones(1))._replace(grid_limit=0.0), random.Random(5), set()
        for _ in range(300):
            degrees, points = near_ties(draw)
            bound = angle_bound(degrees)
            value = corner(bound, *points)
            latest = (
                Stage.FILTER if value.exceeds(2 * SHAPE_FACTOR * ORIENT2D_BOUND)
                else Stage.DOUBLE_DOUBLE if value.exceeds(2 * DD_BOUND) else Stage.EXPANSION
            )  # fmt: skip
            found = corner_code(k, bound, *flat(points))
            assert (found & 3) - 1 == -shape_oracle.compare_angle(*points, degrees) == value.sign
            assert found >> 2 <= latest
            met.add((found >> 2, found & 3))
        assert met >= {(s, i) for s in (0, 2, 3) for i in (0, 2)}

    def test_the_weights_of_the_published_windows(self) -> None:
        k, right = make_context(np.ones(1))._replace(grid_limit=0.0), angle_bound(90.0)
        for size, decided in ((SMALLEST_WEIGHT, Stage.FILTER), (math.nextafter(SMALLEST_WEIGHT, 0.0), Stage.EXPANSION)):
            assert corner_code(k, right, 0.0, 0.0, 1.0, 0.0, size, 1.0) == code_of(decided, 1)
        half = LARGEST_WEIGHT / 2.0**501  # two products of half the weight, that differ in their last bit
        for x, y, decided in (
            (half, math.nextafter(half, 0.0), Stage.DOUBLE_DOUBLE),
            (math.nextafter(half, math.inf), half, Stage.DOUBLE_DOUBLE),
            (half * (1 + 2.0**-51), half * (1 + 2.0**-52), Stage.EXPANSION),
        ):
            assert corner_code(k, right, 0.0, 0.0, 2.0**500, 2.0**500, x, -y) == code_of(decided, 1)

    def test_control_another_bound_is_noticed(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Filters with half of their factor."""
        monkeypatch.setattr(angle, "SHAPE_FACTOR", 2.0)
        with pytest.raises(AssertionError):
            self.test_borders(0.0, monkeypatch)
        with pytest.raises(AssertionError):
            self.test_filters_of_triangles()


@interpreted
@pytest.mark.obligation(
    "K7", "one corner is enough, and the latest stage that was needed is tallied", method="enumeration"
)
class TestCorners:
    """For all answers of the three corners: they are asked in turn until one has the wanted sign."""

    @staticmethod
    def answers(patch: pytest.MonkeyPatch, codes: tuple[int, ...], wanted: int) -> tuple[bool, list[int], list[str]]:
        asked: list[str] = []

        def scripted(_: object, __: object, *corners: str) -> int:
            asked.append("".join(corners))
            return codes[len(asked) - 1]

        patch.setattr(angle, "corner_code", scripted)
        k = make_context(np.ones(1))
        found = some_corner(k, angle_bound(20.0), wanted, *"ABCDEF")
        assert k.counts[1].sum() == 0
        return found, k.counts[0].tolist(), asked

    def test_all(self, monkeypatch: pytest.MonkeyPatch) -> None:
        codes = [
            code_of(stage, sign) for stage in (Stage.FILTER, Stage.EXPANSION, Stage.RATIONAL) for sign in (-1, 0, 1)
        ]
        for triple in itertools.product(codes, repeat=3):
            for wanted in (-1, 1):
                hits = [i for i, code in enumerate(triple) if (code & 3) - 1 == wanted]
                last = hits[0] if hits else 2
                stage = max(code >> 2 for code in triple[: last + 1])
                found, counts, asked = self.answers(monkeypatch, triple, wanted)
                assert found == bool(hits)
                assert counts == [int(i == stage) for i in range(5)]
                assert asked == ["ABCDEF", "CDEFAB", "EFABCD"][: last + 1]

    def test_control_the_corners_are_told_apart(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """The corners' answers in reverse order."""
        codes = (code_of(Stage.GRID, 0), code_of(Stage.RATIONAL, 0), code_of(Stage.GRID, 1))
        assert self.answers(monkeypatch, codes, 1) != self.answers(monkeypatch, codes[::-1], 1)


@interpreted
@pytest.mark.obligation("K6", "angles: rationals decide outside of the window, and only there", method="named cases")
class TestWindow:
    """One coordinate outside is enough; a guarded context looks at each, an open one trusts them."""

    def test_each_coordinate(self) -> None:
        guarded, trusted, bound = guarded_context(), make_context(np.ones(1)), angle_bound(90.0)
        for coordinates in unsafe(6):
            points = tuple(zip(coordinates[::2], coordinates[1::2], strict=True))
            assert corner_code(guarded, bound, *coordinates) == code_of(Stage.RATIONAL, corner(bound, *points).sign)
            assert corner_code(trusted, bound, *coordinates) >> 2 != Stage.RATIONAL
        assert corner_code(guarded, bound, 0.0, 0.0, 1.0, 0.0, 0.5, 1.0) == code_of(Stage.FILTER, 1)

    def test_grids_are_for_exact_bounds(self) -> None:
        k, right = make_context(np.ones(1)), (0.0, 0.0, 1.0, 0.0, 0.0, 1.0)
        assert corner_code(k, angle_bound(90.0), *right) == code_of(Stage.GRID, 0)
        assert corner_code(k, angle_bound(math.nextafter(45.0, 0.0)), *right[2:], *right[:2]) == code_of(
            Stage.DOUBLE_DOUBLE, -1
        )
        assert corner_code(k, angle_bound(1e-200), *right) == code_of(Stage.RATIONAL, -1)

    def test_control_an_open_context_lies_outside(self) -> None:
        """A context that trusts coordinates outside of the window."""
        thin = (0.0, 0.0, 2.0**-600, 0.0, 2.0**-600, 2.0**-600)
        bound = angle_bound(90.0)
        assert corner_code(make_context(np.ones(1)), bound, *thin) & 3 == 1
        assert corner_code(guarded_context(), bound, *thin) & 3 == 2
