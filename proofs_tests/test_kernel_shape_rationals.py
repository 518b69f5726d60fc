"""K7: bounds on shapes for coordinates that are no doubles: ties and ends of ranges, exactly."""

import itertools
from fractions import Fraction

import pytest
from proofs_tests import shape_oracle

import exactkernel as ek

THIRD = Fraction(1, 3)
CORNERS = [(Fraction(x) * THIRD, Fraction(y) * THIRD) for x, y in itertools.product(range(3), repeat=2)]


@pytest.mark.obligation("K7", "measures of rational shapes against rational bounds, ties included", method="exhaustive")
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

    def test_control_the_bound_as_a_double_is_wrong(self) -> None:
        triangle = [CORNERS[0], CORNERS[1], CORNERS[3]]
        assert not ek.area_above(triangle, Fraction(1, 18))
        assert ek.area_above(triangle, float(Fraction(1, 18))) == (Fraction(1 / 18) < Fraction(1, 18))
        assert Fraction(1 / 18) != Fraction(1, 18)
