"""D6: what Sibson's areas may err by, from the bounds of the centres, at the worst that there can be."""

import inspect
from fractions import Fraction

import pytest

from exactkernel.constants import DD_BOUND
from exactmesh.voronoi import cavity

DD = Fraction(DD_BOUND)
SUM = Fraction(13, 4) / 2**106  # of two pairs: 3 u^2 + 13 u^3


def needed(corners: int, error: Fraction) -> Fraction:
    """What the areas, twice, err by in all, where the coordinates are at most 1 and err by ``error`` each.

    A polygon round a vertex goes on to two corners or more, and closes: at most 3/2 cross products for each corner that
    is gone on to. One errs by 4 e + 2 e^2 where its corners do, and by DD_BOUND of 2 in pairs; its sum with those
    before by SUM times the partial sum: the polygon is convex, so that what its sides sweep is at most 16, forth and
    back.
    """
    products = Fraction(3, 2) * corners
    return products * (4 * error + 2 * error**2 + 2 * DD + SUM * 16)


def allowed(corners: int, error: Fraction) -> Fraction:
    """The left side of the comparison, in the same units, rounded down at each of its operations."""
    return 8 * corners * (error + DD) * (1 - Fraction(1, 2**50))


@pytest.mark.obligation("D6", "the bound of the stolen areas covers the errors of their corners", method="calculus")
class TestErrors:
    """Where 8 n R (e + 2^-100 R) is at most 2^-50 of their sum, all areas together err by less than that: so each
    coordinate errs by less than 2^-49, and by the roundings of a sum of doubles, a unit each."""

    def test_areas(self) -> None:
        assert "8.0 * corners * radius * (error + DD_BOUND * radius) <= _ENOUGH * total" in inspect.getsource(
            getattr(cavity.coordinates_of, "py_func", cavity.coordinates_of)
        )
        for error in (Fraction(0), DD, Fraction(1, 2**70), Fraction(1, 2**10)):
            for corners in (4, 100, 10**6):
                assert needed(corners, error) <= allowed(corners, error)

    def test_quotients(self) -> None:
        """Areas that err by 2^-50 of their sum in all, over a sum that errs by as much."""
        enough = Fraction(cavity._ENOUGH)
        for part in (Fraction(0), Fraction(1, 3), Fraction(1)):
            for area, total in ((enough, -enough), (-enough, enough), (enough, enough), (-enough, -enough)):
                assert abs((part + area) / (1 + total) - part) <= 2 * enough * (1 + 2 * enough)

    def test_control_half_of_it_is_too_little(self) -> None:
        """4 in the place of 8."""
        assert needed(100, Fraction(1, 2**70)) > allowed(100, Fraction(1, 2**70)) / 2
