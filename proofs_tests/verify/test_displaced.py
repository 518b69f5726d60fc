"""V1 for the distance of chains from their segments where it is far below, or beyond, what doubles hold."""

import math
from fractions import Fraction

import pytest

from exactmesh import PSLG
from exactmesh.verify import Property, Report, verify

Place = tuple[float, float]
COVER = (Property.SEGMENTS_PRESENT, Property.COVERS_DOMAIN)
LARGEST = 1.7976931348623157e308
#: Neighbours in the sequence of Fibonacci: the cross product of two pairs is 1, and its products have 106 bits.
FIBONACCI = (3416454622906707.0, 5527939700884757.0, 8944394323791464.0)


@pytest.mark.obligation("V1", "the distance of a chain is exact, however small or large", method="named cases")
class TestExtremeDistances:
    """A segment from a to b and a vertex between them in place of an edge: within the distance of the vertex from the
    line, rounded up, the domain is covered, within the double below it, it is not."""

    a, u, w = (0.0, 0.0), (0.0, 2.0**53), (2.0**53, 0.0)
    b, p = FIBONACCI[:0:-1], FIBONACCI[1::-1]

    def report(self, within: float) -> Report:
        domain = PSLG([self.a, self.b, self.u, self.w], [(0, 3), (3, 1), (1, 2), (2, 0), (0, 1)])
        points = [self.a, self.b, self.u, self.w, self.p]
        return verify(points, [(0, 4, 2), (4, 1, 2), (4, 0, 3), (1, 4, 3)], domain=domain, within=within, claims=COVER)

    def test_below_the_last_place(self) -> None:
        x, y = map(int, self.b)
        distance = self.report(math.inf).distance
        assert distance is not None
        assert self.report(math.inf).distance_squared == Fraction(1, x * x + y * y)
        assert self.report(distance).ok
        assert self.report(1.0).ok

    @pytest.mark.parametrize("part", [1.0, 0.5, 2.0**-40, 0.0])
    def test_control_within_less(self, part: float) -> None:
        """A vertex that is farther than asked for, where doubles and double-doubles have it on the line."""
        distance = self.report(math.inf).distance
        assert distance is not None
        assert not self.report(math.nextafter(distance * part, 0.0)).ok

    def test_beyond_all_doubles(self) -> None:
        """The distance is twice the largest double: within infinity all is near."""
        points = [(-LARGEST, -LARGEST), (LARGEST, -LARGEST), (0.0, LARGEST), (-LARGEST, LARGEST), (LARGEST, LARGEST)]
        domain = PSLG(points, [(0, 1), (0, 3), (3, 2), (2, 4), (4, 1)])
        triangles = [(0, 2, 3), (1, 4, 2)]
        report = verify(points, triangles, domain=domain, within=math.inf, claims=COVER)
        assert report.ok
        assert (report.distance_squared, report.distance) == ((2 * Fraction(LARGEST)) ** 2, math.inf)
        assert "within Infinity" in str(report)
        assert not verify(points, triangles, domain=domain, within=LARGEST, claims=COVER).ok
