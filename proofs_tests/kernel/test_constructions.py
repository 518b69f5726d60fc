"""Constructions: exact points, and their nearest doubles with the error stated."""

import math
import sys
from fractions import Fraction

import pytest
from gmpy2 import mpq
from hypothesis import assume, given
from hypothesis import strategies as st
from proofs_tests.kernel import oracle
from proofs_tests.kernel.strategies import Point, point_tuples

from exactkernel import (
    DegenerateError,
    NonFiniteError,
    RoundedPoint,
    circumcentre,
    point_on_segment,
    rounded,
    segment_crossing,
)

ExactPoint = tuple[Fraction, Fraction]


def fractions(point: tuple[mpq, mpq] | Point) -> ExactPoint:
    x, y = (v if isinstance(v, float) else Fraction(int(v.numerator), int(v.denominator)) for v in point)
    return Fraction(x), Fraction(y)


def squared_distance(p: ExactPoint, q: ExactPoint) -> Fraction:
    return (p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2


@pytest.mark.obligation("K7", "circumcentre and crossing are exact", method="property-based")
class TestExactConstructions:
    """The circumcentre has the same exact distance from all corners; the crossing lies on both segments."""

    @staticmethod
    def is_equidistant(centre: ExactPoint, corners: tuple[Point, ...]) -> bool:
        return len({squared_distance(centre, fractions(p)) for p in corners}) == 1

    @given(point_tuples(3))
    def test_circumcentre(self, points: tuple[Point, ...]) -> None:
        if oracle.orient2d(*points) == 0:
            with pytest.raises(DegenerateError):
                circumcentre(*points)
            return
        assert self.is_equidistant(fractions(circumcentre(*points)), points)

    @given(point_tuples(4))
    def test_crossing(self, points: tuple[Point, ...]) -> None:
        a, b, c, d = points
        u, v = (tuple(q - p for p, q in zip(fractions(p), fractions(q), strict=True)) for p, q in ((a, b), (c, d)))
        parallel = u[0] * v[1] == u[1] * v[0]
        apart = oracle.orient2d(a, b, c) * oracle.orient2d(a, b, d) > 0
        apart = apart or oracle.orient2d(c, d, a) * oracle.orient2d(c, d, b) > 0
        if parallel or apart:
            with pytest.raises(DegenerateError):
                segment_crossing(a, b, c, d)
            return
        crossing = fractions(segment_crossing(a, b, c, d))
        for p, q in ((a, b), (c, d)):
            assert self.is_on_segment(crossing, p, q)

    @staticmethod
    def is_on_segment(crossing: ExactPoint, p: Point, q: Point) -> bool:
        between = all(
            min(Fraction(s), Fraction(t)) <= x <= max(Fraction(s), Fraction(t))
            for x, s, t in zip(crossing, p, q, strict=True)
        )
        return between and oracle.orient2d(p, q, crossing) == 0

    def test_control_rounded_points_are_refused(self) -> None:
        """The circumcentre and the crossing rounded to doubles."""
        corners = ((0.0, 0.0), (1.0, 0.0), (0.3, 0.7))
        centre = rounded(circumcentre(*corners))
        assert not self.is_equidistant((Fraction(centre.x), Fraction(centre.y)), corners)
        crossing = rounded(segment_crossing((0.0, 0.0), (1.0, 0.3), (0.0, 0.3), (1.0, 0.1)))
        assert not self.is_on_segment((Fraction(crossing.x), Fraction(crossing.y)), (0.0, 0.0), (1.0, 0.3))

    def test_touching_and_degenerate_segments(self) -> None:
        assert fractions(segment_crossing((0, 0), (2, 0), (1, 0), (1, 5))) == (Fraction(1), Fraction(0))
        with pytest.raises(DegenerateError, match="parallel"):
            segment_crossing((0, 0), (0, 0), (0, 0), (1, 1))

    @given(point_tuples(2), st.floats(0.0, 1.0))
    def test_point_on_segment(self, points: tuple[Point, ...], t: float) -> None:
        a, b = points
        assert self.is_on_segment(fractions(point_on_segment(a, b, t)), a, b)
        assert fractions(point_on_segment(a, b, 0)) == fractions(a)
        assert fractions(point_on_segment(a, b, 1)) == fractions(b)

    def test_a_parameter_that_is_no_number(self) -> None:
        with pytest.raises(NonFiniteError):
            point_on_segment((0, 0), (1, 1), math.nan)


@pytest.mark.obligation(
    "K7", "a rounded construction is the nearest double, and states its error", method="property-based"
)
class TestRounding:
    """Each coordinate is the nearest double, ties to even; the error is exact, at most half an ulp."""

    @staticmethod
    def is_nearest(x: float, exact: Fraction) -> bool:
        error = abs(Fraction(x) - exact)
        neighbours = [math.nextafter(x, math.inf), math.nextafter(x, -math.inf)]
        rivals = [abs(Fraction(n) - exact) for n in neighbours if math.isfinite(n)]
        even = int(Fraction(x) / Fraction(math.ulp(x))) % 2 == 0
        return all(error < rival or (error == rival and even) for rival in rivals)

    @given(st.fractions(), st.integers(-1100, 1000))
    def test_nearest(self, fraction: Fraction, exponent: int) -> None:
        exact = fraction * Fraction(2) ** exponent
        assume(abs(exact) < Fraction(1.7e308))
        point = rounded((mpq(exact.numerator, exact.denominator), mpq(0)))
        assert self.is_nearest(point.x, exact)
        assert fractions(point.error) == (Fraction(point.x) - exact, Fraction(0))
        assert abs(Fraction(point.x) - exact) <= Fraction(math.ulp(point.x)) / 2
        assert point.distance_squared == point.error[0] * point.error[0]

    @pytest.mark.parametrize("k", [1, 3, 5, 2**53 - 1])
    def test_ties_among_subnormals_and_normals(self, k: int) -> None:
        for unit in (Fraction(2) ** -1075, Fraction(2) ** -60):
            exact = (2 * k + 1) * unit
            assert self.is_nearest(rounded((mpq(exact.numerator, exact.denominator), mpq(0))).x, exact)

    def test_control_a_neighbour_is_refused(self) -> None:
        """The double beside the nearest one, and a tie to odd."""
        assert self.is_nearest(1.0, Fraction(1))
        assert not self.is_nearest(math.nextafter(1.0, 2.0), Fraction(1))
        assert not self.is_nearest(1.0 + 2.0**-52, 1 + Fraction(2) ** -53)

    def test_overflow_is_a_typed_error(self) -> None:
        half_ulp = 2**970
        largest = mpq(2**1024 - half_ulp)
        assert rounded((largest - 1, mpq(0))) == RoundedPoint(sys.float_info.max, 0.0, (mpq(1 - half_ulp), mpq(0)))
        for beyond in (largest, -largest, mpq(10**5000)):
            with pytest.raises(DegenerateError, match="beyond the doubles"):
                rounded((mpq(0), beyond))
