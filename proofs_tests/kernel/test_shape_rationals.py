"""K7: bounds on shapes for coordinates that are no doubles: ties and ends of ranges, exactly."""

import itertools
from collections.abc import Callable
from fractions import Fraction

import pytest
from proofs_tests.kernel import shape_oracle
from proofs_tests.kernel.interpreted import calls_of, interpreted

import exactkernel as ek
from exactkernel import shape

THIRD = Fraction(1, 3)
CORNERS = [(Fraction(x) * THIRD, Fraction(y) * THIRD) for x, y in itertools.product(range(3), repeat=2)]


@pytest.mark.obligation(
    "K7", "measures of rational shapes against rational bounds, ties included", method="enumeration"
)
class TestRationals:
    """Every triangle and edge of a grid of thirds, at its own measure, and a little beside it."""

    def test_areas(self) -> None:
        for triangle in itertools.combinations(CORNERS, 3):
            doubled = 18 * abs(
                (triangle[1][0] - triangle[0][0]) * (triangle[2][1] - triangle[0][1])
                - (triangle[1][1] - triangle[0][1]) * (triangle[2][0] - triangle[0][0])
            )
            own = doubled / 36
            for bound in (own, own + Fraction(1, 10**30), max(own - Fraction(1, 10**30), Fraction(0)), Fraction(0)):
                assert ek.area_above(triangle, bound) == shape_oracle.area_above(triangle, bound) == (bound < own)

    def test_lengths(self) -> None:
        """3-4-5 in thirds; and all others against bounds that are rational."""
        edge = ((Fraction(0), THIRD), (4 * THIRD, 4 * THIRD))
        for off in (Fraction(-1, 10**30), Fraction(0), Fraction(1, 10**30)):
            assert ek.length_above(edge, 5 * THIRD + off) == (off < 0)
        for ends, bound in itertools.product(itertools.combinations(CORNERS, 2), (THIRD, 2 * THIRD, Fraction(1, 2))):
            assert ek.length_above(ends, bound) == shape_oracle.length_above(ends, bound)

    @pytest.mark.parametrize("unit", [Fraction(1), THIRD])
    def test_angles_at_the_ends_of_their_range(self, unit: Fraction) -> None:
        """No angle of a triangle is 0 or 180 degrees; both are bounds like others."""
        triangle = [(0 * unit, 0 * unit), (unit, 0 * unit), (0 * unit, unit)]
        assert (ek.angle_below(triangle, 0), ek.angle_below(triangle, 180)) == (False, True)
        assert (ek.angle_above(triangle, 0), ek.angle_above(triangle, 180)) == (True, False)

    def test_what_is_no_sequence_of_points_has_no_shape(self) -> None:
        """The typed error names it, and says how many points there should be."""
        with pytest.raises(ek.ShapeError, match="three corners, not 5"):
            ek.angle_below(5, 20)  # type: ignore[arg-type]  # what an untyped caller passes
        with pytest.raises(ek.ShapeError, match="two ends, not None"):
            ek.length_above(None, 20)  # type: ignore[arg-type]

    def test_control_the_bound_as_a_double_is_wrong(self) -> None:
        """A bound of 1/18 rounded to a double."""
        triangle = [CORNERS[0], CORNERS[1], CORNERS[3]]
        assert not ek.area_above(triangle, Fraction(1, 18))
        assert ek.area_above(triangle, float(Fraction(1, 18))) == (Fraction(1 / 18) < Fraction(1, 18))
        assert Fraction(1 / 18) != Fraction(1, 18)


RIGHT = [(0, 0), (1, 0), (0, 1)]
FUNCTIONS: dict[str, tuple[Callable[..., bool], Callable[..., bool], int]] = {
    "angle_below": (ek.angle_below, shape_oracle.angle_below, 3),
    "angle_above": (ek.angle_above, shape_oracle.angle_above, 3),
    "area_above": (ek.area_above, shape_oracle.area_above, 3),
    "length_above": (ek.length_above, shape_oracle.length_above, 2),
}


@interpreted
@pytest.mark.obligation("K7", "shapes of doubles go the way of loops, and nothing else does", method="enumeration")
class TestWays:
    """Corners and bound, each a double or not: the compiled predicate is asked where all are doubles."""

    @pytest.mark.parametrize("name", FUNCTIONS)
    def test_all(self, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
        function, oracle, n = FUNCTIONS[name]
        asked = calls_of(monkeypatch, shape, f"{name}_adaptive", "shape_rational")
        for unit, bound in itertools.product((Fraction(1), THIRD), (Fraction(1, 2), Fraction(1), THIRD)):
            points = [(x * unit, y * unit) for x, y in RIGHT[:n]]
            asked.clear()
            assert function(points, bound) == oracle(points, bound)
            assert set(asked) == {"shape_rational" if THIRD in (unit, bound) else f"{name}_adaptive"}

    def test_bounds_beyond_the_doubles(self) -> None:
        """Larger than the largest, and smaller than the smallest: both are bounds like others."""
        edge = [(0, 0), (10**400, 0)]
        assert ek.length_above(edge, 10**399)
        assert not ek.length_above(edge, 10**400)
        assert ek.length_above([(0, 0), (Fraction(1, 10**400), 0)], Fraction(1, 10**401))

    def test_control_a_double_beside_the_bound_is_told_apart(self) -> None:
        """A rational whose nearest double is another number."""
        assert shape._double(ek.coordinates.rational_value(0.5)) == 0.5
        assert shape._double(ek.coordinates.rational_value(THIRD)) is None
