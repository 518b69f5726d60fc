"""V1 for the distance of chains from their segments where it is far below, or beyond, what doubles hold."""

import math
from collections.abc import Sequence
from fractions import Fraction

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.oracles import Triangle
from proofs_tests.verify.within_oracle import Chain, best_chain, distance_to_segment

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
SMALL = 1.0 / math.hypot(*END)
#: So far below the origin the line to END passes by MIDDLE at a hundredth of that, and double-doubles say at nothing.
BELOW = -0.99 / (END[0] - MIDDLE[0])


def two_chains(start: Place, up: float, within: float) -> tuple[Report, Fraction]:
    """Segments from a start: one to END, MIDDLE in place of the edge, and one to the left, a vertex so far up in its
    middle. What is said, and the larger one of their squared distances."""
    far = 2.0**53
    corners = [END, (0.0, far), (far, 0.0), (-far, 0.0)]
    domain = PSLG([start, *corners], [(0, 3), (3, 1), (1, 2), (2, 4), (4, 0), (0, 1)])
    triangles = [(5, 0, 2), (0, 1, 2), (0, 5, 3), (1, 0, 3), (5, 2, 6), (6, 2, 4)]
    points = [MIDDLE, *corners, start, (-far / 2, up)]
    exact = oracles.rationals(points)
    squared = [distance_to_segment(exact[v], exact[5], exact[end]) for v, end in ((0, 1), (6, 4))]
    return verify(points, triangles, domain=domain, within=within, claims=COVER), max(squared)


@pytest.mark.obligation("V1", "the distance of a chain is exact, however small or large", method="named cases")
class TestExtremeDistances:
    """Within the largest distance of a vertex from the line, rounded up, the domain is covered, within the double below
    it, it is not: where doubles and double-doubles have all vertices on the line, where one chain is measured
    narrowly and another widely, and at the ends of the range of doubles."""

    @pytest.mark.parametrize(
        "up", [0.0, *(ratio * SMALL for ratio in (0.5, 1 - 2.0**-30, 1 + 2.0**-30, 2.0, 100.0)), BELOW / 2]
    )
    @pytest.mark.parametrize("below", [0.0, BELOW])
    def test_below_the_last_place(self, below: float, up: float) -> None:
        report, expected = two_chains((0.0, below), up, math.inf)
        assert report.ok
        assert report.distance_squared == expected
        assert report.distance is not None
        assert two_chains((0.0, below), up, report.distance)[0].ok
        assert two_chains((0.0, below), up, 1.0)[0].ok

    @pytest.mark.parametrize("part", [1.0, 0.5, 2.0**-40, 0.0])
    @pytest.mark.parametrize(("below", "up"), [(0.0, 0.0), (0.0, 2 * SMALL), (BELOW, 0.0), (BELOW, BELOW / 2)])
    def test_control_within_less(self, below: float, up: float, part: float) -> None:
        """A vertex that is farther than asked for, by the last place at least."""
        distance = two_chains((0.0, below), up, math.inf)[0].distance
        assert distance is not None
        assert not two_chains((0.0, below), up, math.nextafter(distance * part, 0.0))[0].ok

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


def chains(points: Sequence[Place], triangles: Sequence[Triangle], line: Sequence[Place], within: float) -> list[Chain]:
    """The chains that lead from point 0 to point 1, and back, for a segment between these places."""
    places = np.array([*points, *line])
    mesh, positions = prepared_mesh(places[: len(points)], index_triples(triangles), index_quads(()), places)
    links = linked(len(points), mesh.context, localized(mesh.coordinates, mesh.triangles, mesh.quads))
    n = len(points)
    segments, corner = np.array([(n, n + 1), (n + 1, n)], dtype=np.intp), np.array([*range(n), 0, 1], dtype=np.intp)
    found = displaced.near_chains(mesh, links, places, positions, segments, corner, np.arange(2), within)
    return [tuple(found.vertices[found.start[i] : found.start[i + 1]].tolist()) for i in range(len(found.rows))]


@pytest.mark.obligation("V1", "straight chains are within any distance", method="named cases", control_in="mutants")
class TestStraight:
    """An edge, or a chain through a vertex exactly on the segment: within 0 as well."""

    corners = ((0.0, 0.0), (6.0, 2.0), (0.0, 4.0), (5.0, -5.0))

    @pytest.mark.parametrize("within", [0.0, SMALLEST, 1.0, math.inf])
    def test_chains(self, within: float) -> None:
        ends, sides = self.corners[:2], [(0, 4, 2), (4, 1, 2), (4, 0, 3), (1, 4, 3)]
        assert chains(self.corners, [(0, 1, 2), (1, 0, 3)], ends, within) == [(0, 1), (1, 0)]
        assert chains([*self.corners, (3.0, 1.0)], sides, ends, within) == [(0, 4, 1), (1, 4, 0)]
        bent = chains([*self.corners, (3.0, 1.0 + 2.0**-52)], sides, ends, within)
        assert bent == ([(0, 4, 1), (1, 4, 0)] if within >= 1.0 else [])


@pytest.mark.obligation(
    "V1",
    "a chain goes strictly forward, and strictly between the perpendiculars",
    method="enumeration",
    control_in="mutants",
)
class TestForward:
    """A vertex anywhere beside a segment whose ends are anywhere beside corners: it is on the chain iff all chains in
    fractions say so; in the window of the predicates, and so far from it that rationals decide."""

    @pytest.mark.parametrize("shift", [(0, 0), (-1, 1), (1, -1)])
    @pytest.mark.parametrize("power", [0, 300])
    def test_all_places(self, power: int, shift: tuple[int, int]) -> None:
        size, counts = 2.0**power, set[int]()
        line = [((2 + shift[0]) * size, 0.0), ((6 + shift[1]) * size, 0.0)]
        for x in range(9):
            points = [(2.0, 1.0), (6.0, 1.0), (4.0, 9.0), (float(x), 2.0), (4.0, 0.25)]
            points = [(p * size, q * size) for p, q in points]
            if power:
                points.append((2.0**-700, 0.0))  # in no triangle, so near to the origin that no power of two helps
            triangles = [(0, 3, 2), (3, 1, 2)] if 2 < x < 6 else [(0, 2, 3), (1, 2, 3)]
            exact, ends = oracles.rationals(points), oracles.rationals(line)
            expected = [best_chain(exact, triangles, v, w, ends[v], ends[w]) for v, w in ((0, 1), (1, 0))]
            assert chains(points, triangles, line, math.inf) == [chain for chain in expected if chain is not None]
            counts |= {len(chain) for chain in expected if chain is not None}
        assert 3 in counts
