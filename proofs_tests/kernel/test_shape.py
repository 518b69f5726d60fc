"""K1, K7 for bounds on shapes: angles, areas and lengths are compared exactly, ties and extreme doubles included."""

import math
from collections.abc import Callable
from fractions import Fraction
from typing import TypeAlias

import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st
from proofs_tests.kernel import oracle as kernel_oracle
from proofs_tests.kernel import shape_oracle
from proofs_tests.kernel.strategies import Point, exponents, few_ulps, finite, moved, point_tuples, scaled, unit

import exactkernel as ek
from exactkernel.angle import AngleBound, angle_filter
from exactkernel.anglebound import DIRECTIONS, cosine_and_sine
from exactkernel.context import Context, guarded_context, make_context
from exactkernel.measure import area_filter, length_filter
from exactkernel.shape import (
    angle_above_adaptive,
    angle_below_adaptive,
    angle_bound,
    area_above_adaptive,
    length_above_adaptive,
)

Triangle: TypeAlias = tuple[Point, ...]

RIGHT = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))
TENTHS = ((0.1, 0.1), (0.30000000000000004, 0.1), (0.1, 0.30000000000000004))

ASKED = (20.0, 30.0, 33.0, 45.0, 60.0, 90.0, 120.0, 135.0)
EXTREME = (0.0, 5e-324, 1e-120, 1e-100, 1e-9, math.nextafter(45.0, 0.0), 89.99999999999999, 179.99999999999997, 180.0)
bounds = st.one_of(st.sampled_from(ASKED), st.sampled_from(EXTREME), st.floats(0.0, 180.0))


def counterclockwise(points: Triangle) -> Triangle:
    turn = kernel_oracle.orient2d(*points)
    assume(turn != 0)
    return points if turn > 0 else (points[0], points[2], points[1])


@st.composite
def near_angle(draw: st.DrawFn) -> tuple[Triangle, float]:
    """A triangle with an angle within some ulps of the bound, anywhere, of any size."""
    degrees = draw(st.one_of(st.sampled_from(ASKED), st.floats(0.01, 179.0)))
    ax, ay, turned, ratio = draw(unit), draw(unit), draw(st.floats(0.0, 6.3)), draw(st.floats(0.25, 4.0))
    length = 2.0 ** -draw(st.integers(0, 30))
    points = [(ax, ay)]
    for angle, side in ((turned, length), (turned + math.radians(degrees), length * ratio)):
        x, y = ax + side * math.cos(angle), ay + side * math.sin(angle)
        points.append((moved(x, draw(few_ulps)), moved(y, draw(few_ulps))))
    return scaled(tuple(points), draw(exponents)), degrees


def contexts(points: Triangle) -> list[Context]:
    return [guarded_context(), make_context(np.array(points))]


@pytest.mark.obligation(
    "K7", "cosine and sine of a bound are enclosed, and the directions are exact", method="property-based"
)
class TestTrigonometry:
    """The enclosures meet those of Machin and Taylor; pairs of doubles lie within 2^-105 of them."""

    @given(st.floats(0.0, 180.0), st.sampled_from([128, 192]))
    def test_enclosure(self, degrees: float, precision: int) -> None:
        exact = Fraction(degrees)
        cosine, sine, error = (Fraction(int(v.numerator), int(v.denominator)) for v in cosine_and_sine(
            ek.coordinates.rational_value(degrees), precision))  # fmt: skip
        low, high = shape_oracle.cosine_interval(exact, precision)
        assert cosine - error <= low <= high <= cosine + error
        low, high = shape_oracle.cosine_interval(abs(90 - exact), precision)  # the sine
        assert sine - error <= low <= high <= sine + error

    @given(st.floats(1e-9, 180.0))
    def test_pairs(self, degrees: float) -> None:
        bound = angle_bound(degrees)
        assume(not bound.is_exact)
        for turned, head, tail in (
            (Fraction(degrees), bound.cosine, bound.cosine_tail),
            (abs(90 - Fraction(degrees)), bound.sine, bound.sine_tail),
        ):
            low, high = shape_oracle.cosine_interval(turned, 180)
            value = Fraction(head) + Fraction(tail)
            assert max(abs(value - low), abs(value - high)) <= abs(value) * Fraction(1, 2**105) + Fraction(1, 2**170)

    def test_directions(self) -> None:
        for degrees, (cosine, sine) in DIRECTIONS.items():
            angle = math.radians(float(degrees))
            scale = math.hypot(cosine, sine)
            assert cosine == round(math.cos(angle) * scale)
            assert sine == round(math.sin(angle) * scale)

    def test_control_a_rounded_pi_is_noticed(self) -> None:
        """The cosine of the mathematics library, of degrees by a rounded pi."""
        low, high = shape_oracle.cosine_interval(Fraction(20), 128)
        assert not low <= Fraction(math.cos(math.radians(20.0))) <= high


@pytest.mark.obligation(
    "K7", "angles against a bound: exact for all finite doubles and every bound", method="property-based"
)
class TestAngles:
    """Scalar, and in a loop with any context: below and above are those of the law of cosines in fractions."""

    def check(self, points: Triangle, degrees: float) -> None:
        below, above = shape_oracle.angle_below(points, degrees), shape_oracle.angle_above(points, degrees)
        assert ek.angle_below(points, degrees) == below
        assert ek.angle_above(points, degrees) == above
        bound, flat = angle_bound(degrees), np.ravel(points).tolist()
        for k in contexts(points):
            assert angle_below_adaptive(k, bound, *flat) == below
            assert angle_above_adaptive(k, bound, *flat) == above

    @given(point_tuples(3), bounds)
    def test_anything(self, points: Triangle, degrees: float) -> None:
        self.check(counterclockwise(points), degrees)

    @given(near_angle())
    def test_near_the_bound(self, drawn: tuple[Triangle, float]) -> None:
        points, degrees = drawn
        self.check(counterclockwise(points), degrees)

    @given(st.integers(-1000, 1000), st.integers(-1000, 1000), st.integers(-2000, 2000), exponents)
    @example(1, 0, 0, 0)
    def test_ties(self, ux: int, uy: int, offset: int, exponent: int) -> None:
        """45, 90 and 135 degrees, exactly: right isosceles triangles, and a quarter turn and a half."""
        assume((ux, uy) != (0, 0))
        o = (float(offset), float(-offset))
        for (vx, vy), tie in (((-uy, ux), 45.0), ((-uy, ux), 90.0), ((-ux - uy, ux - uy), 135.0)):
            triangle = (o, (o[0] + ux, o[1] + uy), (o[0] + vx, o[1] + vy))
            points = scaled(triangle, exponent)
            for degrees in (tie, math.nextafter(tie, 0.0), math.nextafter(tie, 180.0)):
                self.check(points, degrees)
            assert ek.angle_below(points, 45) == (tie == 135.0)
            assert ek.angle_above(points, tie) == (tie == 45.0)

    def test_ties_in_tenths(self) -> None:
        """Off the grid: expansions decide."""
        for degrees in (45.0, 90.0, 135.0):
            self.check(((0.1, 0.1), (0.3, 0.1), (0.1, 0.3)), degrees)
            self.check(TENTHS, degrees)

    @given(near_angle())
    def test_rationals_and_order(self, drawn: tuple[Triangle, float]) -> None:
        """Corners in any order, divided by three; the bound a fraction."""
        points, degrees = counterclockwise(drawn[0]), Fraction(drawn[1]) / 3
        thirds = [(Fraction(x) / 3, Fraction(y) / 3) for x, y in points]
        for order in (thirds, thirds[::-1]):
            assert ek.angle_below(order, degrees) == shape_oracle.angle_below(points, degrees)
            assert ek.angle_above(order, 2 * degrees) == shape_oracle.angle_above(points, 2 * degrees)

    def test_control_a_filter_without_a_bound_lies(self) -> None:
        """The bound of the filter set to zero."""
        rng = np.random.default_rng(4)
        lies = 0
        for _ in range(2000):
            degrees = float(rng.uniform(1.0, 60.0))
            ux, uy, turned = *(rng.random(2) + 1.0), math.radians(degrees)
            vx, vy = ux * math.cos(turned) - uy * math.sin(turned), ux * math.sin(turned) + uy * math.cos(turned)
            cross, dot = ux * vy - uy * vx, ux * vx + uy * vy
            sign = angle_filter(0.0, angle_bound(degrees), cross, cross, dot, dot)
            lies += sign == shape_oracle.compare_angle((0, 0), (ux, uy), (vx, vy), degrees) != 0
        assert lies > 0

    def test_control_the_bound_rounded_to_radians_is_wrong(self) -> None:
        """Sine and cosine of 45 degrees in doubles, which differ."""
        below, above = math.sin(math.radians(45.0)), math.cos(math.radians(45.0))  # both near the square root of 1/2
        rounded = AngleBound(45.0, below, 0.0, above, 0.0, True)
        assert below < above
        assert angle_below_adaptive(guarded_context(), rounded, *np.ravel(RIGHT).tolist())
        assert not ek.angle_below(RIGHT, 45)


@pytest.mark.obligation(
    "K7", "areas and lengths against a bound: exact for all finite doubles", method="property-based"
)
class TestMeasures:
    """Scalar, and in a loop with any context: areas and lengths are compared as in fractions, ties included."""

    def check_area(self, points: Triangle, bound: float) -> None:
        exact = shape_oracle.area_above(points, bound)
        assert ek.area_above(points, bound) == exact
        flat = np.ravel(points).tolist()
        assert {area_above_adaptive(k, bound, *flat) for k in contexts(points)} == {exact}

    def check_length(self, points: Triangle, bound: float) -> None:
        exact = shape_oracle.length_above(points, bound)
        assert ek.length_above(points, bound) == exact
        flat = np.ravel(points).tolist()
        assert {length_above_adaptive(k, bound, *flat) for k in contexts(points)} == {exact}

    @given(point_tuples(3), finite.map(abs))
    def test_any_area(self, points: Triangle, bound: float) -> None:
        self.check_area(counterclockwise(points), bound)

    @given(point_tuples(3), few_ulps)
    def test_area_near_the_bound(self, points: Triangle, ulps: int) -> None:
        points = counterclockwise(points)
        area = doubled_area(points) / 2
        assume(area < Fraction(2) ** 1023)
        self.check_area(points, abs(moved(float(area), ulps)))

    @given(point_tuples(2), finite.map(abs))
    def test_any_length(self, points: Triangle, bound: float) -> None:
        self.check_length(points, bound)

    @given(point_tuples(2), few_ulps)
    def test_length_near_the_bound(self, points: Triangle, ulps: int) -> None:
        length = math.hypot(points[0][0] / 2 - points[1][0] / 2, points[0][1] / 2 - points[1][1] / 2)
        assume(length < 2.0**1022)
        self.check_length(points, abs(moved(2 * length, ulps)))

    @pytest.mark.parametrize("scale", [1.0, 0.1, 2.0**-300, 2.0**-530, 2.0**300])
    def test_ties(self, scale: float) -> None:
        a, b, c = (0.0, 0.0), (3 * scale, 0.0), (0.0, 4 * scale)
        self.check_length((b, c), 5 * scale)
        self.check_area((a, b, c), 6 * scale * scale)
        self.check_length((a, b), 3 * scale)
        if scale == 1.0:
            assert not ek.length_above((b, c), 5)
            assert not ek.area_above((a, b, c), 6)

    def test_infinite_bounds_are_never_exceeded(self) -> None:
        huge = ((-1.7e308, -1.7e308), (1.7e308, -1.7e308), (0.0, 1.7e308))
        assert not ek.area_above(huge, math.inf)
        assert not ek.length_above(huge[:2], math.inf)
        assert ek.area_above(huge, 1.7e308)
        assert ek.length_above(huge[:2], 1.7e308)

    def test_control_filters_without_a_bound_lie(self) -> None:
        """The bounds of the filters set to zero."""
        rng = np.random.default_rng(4)
        areas = lengths = 0
        for ux, uy, vx, vy in rng.random((2000, 4)).tolist():
            area = float(abs(doubled_area(((0.0, 0.0), (ux, uy), (vx, vy)))) / 2)
            if ux * vy > uy * vx:
                exact = 1 if shape_oracle.area_above(((0, 0), (ux, uy), (vx, vy)), area) else -1
                areas += area_filter(0.0, area, ux, uy, vx, vy) == -exact
            exact = 1 if shape_oracle.length_above(((0, 0), (ux, uy)), math.hypot(ux, uy)) else -1
            lengths += length_filter(0.0, math.hypot(ux, uy), ux, uy) == -exact
        assert areas > 0
        assert lengths > 0


def doubled_area(points: Triangle) -> Fraction:
    (ax, ay), (bx, by), (cx, cy) = ((Fraction(x), Fraction(y)) for x, y in points)
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


@pytest.mark.obligation("K7", "the stage that decides a bound on shapes is pinned", method="named cases")
class TestShapeStages:
    """Each stage decides what it is there for: the rational stage only what lies outside the window."""

    @pytest.mark.parametrize(
        ("adaptive", "bound", "points", "stage"),
        [
            (angle_below_adaptive, angle_bound(20.0), RIGHT, ek.Stage.FILTER),
            (angle_below_adaptive, angle_bound(45.0), RIGHT, ek.Stage.GRID),
            (angle_below_adaptive, angle_bound(45.0), TENTHS, ek.Stage.EXPANSION),
            (angle_below_adaptive, angle_bound(math.nextafter(45.0, 0.0)), RIGHT, ek.Stage.DOUBLE_DOUBLE),
            (angle_below_adaptive, angle_bound(1e-200), RIGHT, ek.Stage.RATIONAL),
            (angle_above_adaptive, angle_bound(90.0), RIGHT, ek.Stage.GRID),
            (
                angle_above_adaptive,
                angle_bound(90.0),
                ((0.0, 0.0), (1.0, 2.0**-53 + 2.0**-105), (-(2.0**-53), 1.0)),
                ek.Stage.DOUBLE_DOUBLE,
            ),
            (area_above_adaptive, 0.5, RIGHT, ek.Stage.GRID),
            (area_above_adaptive, 0.02, TENTHS, ek.Stage.DOUBLE_DOUBLE),
            (area_above_adaptive, 0.4, RIGHT, ek.Stage.FILTER),
        ],
    )
    def test_pinned(
        self, adaptive: Callable[..., bool], bound: AngleBound | float, points: Triangle, stage: ek.Stage
    ) -> None:
        k = make_context(np.array(points))
        adaptive(k, bound, *np.ravel(points).tolist())
        assert k.counts[0].tolist() == [int(stage == i) for i in range(5)]

    def test_outside_the_window(self) -> None:
        far = scaled(RIGHT, -600)
        for k in contexts(far):
            assert not angle_below_adaptive(k, angle_bound(20.0), *np.ravel(far).tolist())
            assert k.counts[0].tolist() == [0, 0, 0, 0, 1]

    def test_control_a_closed_stage_decides_nothing(self) -> None:
        """The grid stage closed: the tally is another one."""
        k = make_context(np.array(RIGHT))._replace(grid_limit=0.0)
        angle_below_adaptive(k, angle_bound(45.0), *np.ravel(RIGHT).tolist())
        assert k.counts[0][ek.Stage.GRID] == 0
        assert k.counts[0].sum() == 1


@pytest.mark.obligation("K7", "bad bounds and shapes raise a typed error", method="named cases")
class TestBadBounds:
    """NaN, infinite, negative, no number: a typed error; a flat triangle has no angles."""

    @pytest.mark.parametrize("degrees", [-1, 180.00000000000003, 1000, Fraction(-1, 10**9)])
    def test_angles_outside_the_range(self, degrees: float) -> None:
        for function in (ek.angle_below, ek.angle_above):
            with pytest.raises(ek.BoundError, match="between 0 and 180"):
                function(RIGHT, degrees)
        with pytest.raises(ek.BoundError, match="between 0 and 180"):
            angle_bound(float(degrees) - 1e-6 if degrees < 0 else float(degrees))

    @pytest.mark.parametrize("degrees", [math.nan, math.inf, -math.inf])
    def test_angles_that_are_no_numbers(self, degrees: float) -> None:
        for function in (ek.angle_below, ek.angle_above):
            with pytest.raises(ek.NonFiniteError):
                function(RIGHT, degrees)
        with pytest.raises(ek.BoundError):
            angle_bound(degrees)

    @pytest.mark.parametrize("bound", [-1, -5e-324, math.nan, -math.inf, np.float64("nan"), Fraction(-1, 3)])
    def test_measures(self, bound: float) -> None:
        with pytest.raises(ek.BoundError, match="a bound on areas"):
            ek.area_above(RIGHT, bound)
        with pytest.raises(ek.BoundError, match="a bound on lengths"):
            ek.length_above(RIGHT[:2], bound)

    def test_shapes(self) -> None:
        with pytest.raises(ek.ShapeError, match="three corners"):
            ek.angle_below(RIGHT[:2], 20)
        with pytest.raises(ek.ShapeError, match="two ends"):
            ek.length_above(RIGHT, 20)
        with pytest.raises(ek.DegenerateError, match="on one line"):
            ek.angle_below([(0, 0), (1, 1), (2, 2)], 20)
        with pytest.raises(ek.CoordinateError):
            ek.area_above(RIGHT, "1")  # type: ignore[arg-type]  # what an untyped caller passes
        assert not ek.area_above([(0, 0), (1, 1), (2, 2)], 0)
        assert ek.area_above(np.array(RIGHT), np.float64(0.25))

    def test_control_good_bounds(self) -> None:
        """None: bounds at the ends of their ranges are taken."""
        assert not ek.angle_below(RIGHT, 0)
        assert not ek.angle_above(RIGHT, 180)
        assert ek.area_above(RIGHT, 0)
        assert not ek.length_above(RIGHT[:2], math.inf)
