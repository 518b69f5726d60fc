"""V1 for the distance of chains from their segments where it is far below, or beyond, what doubles hold."""

import math
from collections.abc import Sequence
from fractions import Fraction

import numpy as np
import pytest

from exactmesh import PSLG
from exactmesh.verify import Property, Report, displaced, verify
from exactmesh.verify.links import linked
from exactmesh.verify.local import localized
from exactmesh.verify.mesh import index_quads, index_triples, prepared_mesh

Place = tuple[float, float]
COVER = (Property.SEGMENTS_PRESENT, Property.COVERS_DOMAIN)
LARGEST, SMALLEST = 1.7976931348623157e308, 5e-324
#: Neighbours in the sequence of Fibonacci: the cross product of two pairs is 1, and its products have 106 bits.
FIBONACCI = (3416454622906707.0, 5527939700884757.0, 8944394323791464.0)
END, MIDDLE = FIBONACCI[:0:-1], FIBONACCI[1::-1]
SQUARED = Fraction(1, int(END[0]) ** 2 + int(END[1]) ** 2)


def two_chains(up: float, within: float) -> Report:
    """Segments from the origin: one to END, MIDDLE in place of the edge, and one to the left, a vertex so far up in
    its middle."""
    far, origin = 2.0**53, (0.0, 0.0)
    corners = [END, (0.0, far), (far, 0.0), (-far, 0.0)]
    domain = PSLG([origin, *corners], [(0, 3), (3, 1), (1, 2), (2, 4), (4, 0), (0, 1)])
    triangles = [(5, 0, 2), (0, 1, 2), (0, 5, 3), (1, 0, 3), (5, 2, 6), (6, 2, 4)]
    points = [MIDDLE, *corners, origin, (-far / 2, up)]
    return verify(points, triangles, domain=domain, within=within, claims=COVER)


@pytest.mark.obligation("V1", "the distance of a chain is exact, however small or large", method="named cases")
class TestExtremeDistances:
    """Within the largest distance of a vertex from the line, rounded up, the domain is covered, within the double below
    it, it is not: where doubles and double-doubles have all vertices on the line, where one chain is measured
    narrowly and another widely, and at the ends of the range of doubles."""

    @pytest.mark.parametrize("ratio", [0.0, 0.5, 1 - 2.0**-30, 1 + 2.0**-30, 2.0, 100.0])
    def test_below_the_last_place(self, ratio: float) -> None:
        up = ratio * math.sqrt(SQUARED)
        report = two_chains(up, math.inf)
        assert report.ok
        assert report.distance_squared == max(SQUARED, Fraction(up) ** 2)
        assert report.distance is not None
        assert two_chains(up, report.distance).ok
        assert two_chains(up, 1.0).ok

    @pytest.mark.parametrize("part", [1.0, 0.5, 2.0**-40, 0.0])
    @pytest.mark.parametrize("ratio", [0.0, 2.0])
    def test_control_within_less(self, ratio: float, part: float) -> None:
        """A vertex that is farther than asked for, by the last place at least."""
        distance = two_chains(ratio * math.sqrt(SQUARED), math.inf).distance
        assert distance is not None
        assert not two_chains(ratio * math.sqrt(SQUARED), math.nextafter(distance * part, 0.0)).ok

    @pytest.mark.parametrize("up", [1, 3, 1000])
    def test_smallest_doubles(self, up: int) -> None:
        size = 2.0**-1040
        points = [(size, up * SMALLEST), (0.0, 0.0), (2 * size, 0.0), (size, size)]
        domain = PSLG(points[1:], [(0, 1), (1, 2), (2, 0)])
        for within in (math.inf, up * SMALLEST):
            report = verify(points, [(1, 0, 3), (0, 2, 3)], domain=domain, within=within, claims=COVER)
            assert report.ok
            assert report.distance == up * SMALLEST
        less = (up - 1) * SMALLEST
        assert not verify(points, [(1, 0, 3), (0, 2, 3)], domain=domain, within=less, claims=COVER).ok

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


def chains_within(points: Sequence[Place], within: float) -> list[list[int]]:
    """The chains from point 0 to point 1, and back; triangles on both sides of 0, 4, 1 or of the edge between them."""
    triangles = [(0, 4, 2), (4, 1, 2), (4, 0, 3), (1, 4, 3)] if len(points) == 5 else [(0, 1, 2), (1, 0, 3)]
    places = np.array(points)
    mesh, positions = prepared_mesh(places, index_triples(triangles), index_quads(()), places)
    links = linked(len(points), mesh.context, localized(mesh.coordinates, mesh.triangles, mesh.quads))
    segments, corner = np.array([(0, 1), (1, 0)], dtype=np.intp), np.arange(len(points), dtype=np.intp)
    found = displaced.near_chains(mesh, links, places, positions, segments, corner, np.arange(2), within)
    return [found.vertices[found.start[i] : found.start[i + 1]].tolist() for i in range(len(found.rows))]


@pytest.mark.obligation("V1", "straight chains are within any distance", method="named cases", control_in="mutants")
class TestStraight:
    """An edge, or a chain through a vertex exactly on the segment: within 0 as well."""

    corners = ((0.0, 0.0), (6.0, 2.0), (0.0, 4.0), (5.0, -5.0))

    @pytest.mark.parametrize("within", [0.0, SMALLEST, 1.0, math.inf])
    def test_chains(self, within: float) -> None:
        assert chains_within(self.corners, within) == [[0, 1], [1, 0]]
        assert chains_within([*self.corners, (3.0, 1.0)], within) == [[0, 4, 1], [1, 4, 0]]
        bent = chains_within([*self.corners, (3.0, 1.0 + 2.0**-52)], within)
        assert bent == ([[0, 4, 1], [1, 4, 0]] if within >= 1.0 else [])
