"""K7: exact constructions, for every input on a small grid."""

import dataclasses
import itertools
import math
from fractions import Fraction

import pytest
from gmpy2 import mpq
from proofs_tests.oracles import RationalPoint, on_segment, orient, squared_distance

from exactkernel import DegenerateError, circumcentre, point_on_segment, rounded, segment_crossing

GRID = [(float(x), float(y)) for x in range(3) for y in range(3)]


def exact(point: tuple[mpq, mpq] | tuple[float, float]) -> RationalPoint:
    x, y = (Fraction(int(mpq(v).numerator), int(mpq(v).denominator)) for v in point)
    return x, y


def common_points(a: RationalPoint, b: RationalPoint, c: RationalPoint, d: RationalPoint) -> list[RationalPoint]:
    """Where segments that are not parallel meet: an end of one on the other, or their sides differ."""
    ends = [p for p, s in ((a, (c, d)), (b, (c, d)), (c, (a, b)), (d, (a, b))) if on_segment(p, *s)]
    if ends or not (orient(a, b, c) * orient(a, b, d) < 0 and orient(c, d, a) * orient(c, d, b) < 0):
        return ends[:1]
    t = orient(c, d, a) / (orient(c, d, a) - orient(c, d, b))
    return [(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]))]


@pytest.mark.obligation("K7", "constructions are exact for every input on the 3 x 3 grid", method="enumeration")
class TestGrid:
    """Circumcentres are as far from each corner; crossings are the one common point, or a typed error says why not."""

    def test_circumcentres(self) -> None:
        for corners in itertools.product(GRID, repeat=3):
            a, b, c = map(exact, corners)
            if orient(a, b, c) == 0:
                with pytest.raises(DegenerateError, match="no circumcentre"):
                    circumcentre(*corners)
                continue
            centre = exact(circumcentre(*corners))
            assert squared_distance(centre, a) == squared_distance(centre, b) == squared_distance(centre, c)

    def test_crossings(self) -> None:
        for first, second in itertools.product(itertools.permutations(GRID, 2), repeat=2):
            (a, b), (c, d) = ([exact(p) for p in ends] for ends in (first, second))
            parallel = (b[0] - a[0]) * (d[1] - c[1]) == (b[1] - a[1]) * (d[0] - c[0])
            common = common_points(a, b, c, d)
            if parallel or not common:
                with pytest.raises(DegenerateError, match="parallel" if parallel else "do not meet"):
                    segment_crossing(*first, *second)
                continue
            assert exact(segment_crossing(*first, *second)) == common[0]

    def test_points_on_segments(self) -> None:
        for a, b in itertools.product(GRID, repeat=2):
            for t in (mpq(-1, 2), mpq(0), mpq(1, 3), mpq(1), mpq(2)):
                x, y = point_on_segment(a, b, t)
                assert (x, y) == tuple((1 - t) * mpq(p) + t * mpq(q) for p, q in zip(a, b, strict=True))

    def test_control_a_crossing_beside_is_refused(self) -> None:
        """A segment that passes the other by."""
        a, b, c, d = (exact(p) for p in ((0.0, 0.0), (2.0, 2.0), (0.0, 2.0), (2.0, 1.0)))
        assert common_points(a, b, c, d) == [(Fraction(4, 3), Fraction(4, 3))]
        assert common_points(a, b, c, (Fraction(1), Fraction(3))) == []


@pytest.mark.obligation(
    "K7", "a rounded point is a value: its error and distance are exact, and it does not change", method="named cases"
)
class TestRoundedPoint:
    """Both coordinates and both errors; equal points are equal, and none can be altered."""

    def test_both_axes(self) -> None:
        point = rounded((mpq(1, 3), mpq(2, 7)))
        assert (point.x, point.y) == (1 / 3, 2 / 7)
        assert point.error == (mpq(1 / 3) - mpq(1, 3), mpq(2 / 7) - mpq(2, 7))
        assert point.distance_squared == sum(error * error for error in point.error) > 0

    def test_frozen(self) -> None:
        point = rounded((mpq(1), mpq(2)))
        with pytest.raises(dataclasses.FrozenInstanceError):
            point.x = 3.0  # type: ignore[misc]  # refused by the type checker as well
        assert not hasattr(point, "__dict__")
        assert point == rounded((mpq(1), mpq(2))) != rounded((mpq(1), mpq(3)))

    def test_control_a_rounded_error_differs(self) -> None:
        """An error rounded to a double."""
        error = rounded((mpq(1, 3), mpq(0))).error[0]
        assert mpq(math.nextafter(float(error), 1.0)) != error
