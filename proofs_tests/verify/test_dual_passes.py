"""V1 for the passes over a Voronoi diagram, each alone: against fractions, and against a look at all edges."""

import math
from fractions import Fraction
from itertools import islice, permutations, product
from random import Random

import numpy as np
import numpy.typing as npt
import pytest
from proofs_tests import oracles
from proofs_tests.mesh.enumeration import grid, triangulations
from proofs_tests.oracles import Triangle
from proofs_tests.verify.test_links import links_of, mesh_of

from exactkernel.context import make_context
from exactkernel.types import FloatArray
from exactmesh.verify import dual_passes
from exactmesh.verify.adjacency import rows_of_slots
from exactmesh.verify.dual_passes import NO, UNKNOWN, YES
from exactmesh.verify.links import Links, ends_of

ULP = 2.0**-52


def margin(claimed: float, x: float, tail: float) -> tuple[Fraction, Fraction]:
    """How far x + tail is inside the doubles around the claimed one, negative outside, and the distances' sum."""
    z = Fraction(x) + Fraction(tail)
    above = z - Fraction(math.nextafter(claimed, -math.inf))
    below = Fraction(math.nextafter(claimed, math.inf)) - z
    return min(above, below), abs(above) + abs(below)


@pytest.mark.obligation(
    "V1", "a number known up to an error is told to be next to a double, or not, as far as that is known",
    method="enumeration",
)  # fmt: skip
class TestBetweenNeighbours:
    """YES and NO are true of every number within the error; and said as soon as the error, longer by a millionth, and
    2^-50 of the distances allow it."""

    @pytest.mark.parametrize("claimed", [1.0, -1.0, 1.5, -3.25, 0.75, 2.0**300, -(2.0**-300)])
    def test_sides(self, claimed: float) -> None:
        ulp, seen = abs(claimed) * ULP, set()
        steps = (-2, -1, -0.5, -0.25, 0, 0.25, 0.5, 1, 2)
        parts = (1e-16, 1e-12, 0.001, 0.125, 0.25, 0.5, 0.75, 1.0)
        tails = [s * (p + q) for p in parts for q in (0, 2.0**-21, -(2.0**-21), 0.01) for s in (-1, 1)]
        for step, tail, error in product(steps, tails, (0.0, 0.001, 0.25, 0.5, 3.0)):
            x = claimed + step * ulp
            found = dual_passes.between_neighbours(claimed, x, tail * ulp, error * ulp)
            seen.add(found)
            inside, both = margin(claimed, x, tail * ulp)
            known = abs(inside) > Fraction(error * ulp)
            assert found == UNKNOWN or (known and (found == YES) is (inside > 0))
            if abs(inside) > Fraction(error * ulp) * (1 + Fraction(3, 2**21)) + both * Fraction(3, 2**51):
                assert found == (YES if inside > 0 else NO)
            if abs(inside) < Fraction(error * ulp) * (1 + Fraction(1, 2**21)) + both / 2**51:
                assert found == UNKNOWN
        assert seen == {NO, YES, UNKNOWN}
        assert len(seen) == 3

    @pytest.mark.parametrize("share", [2.0**-21, 1.5 * 2.0**-20])
    def test_slack(self, share: float) -> None:
        """An error a little shorter than the distance: by a 2^-21st it is too close to tell, by 1.5 2^-20 it is not."""
        error = 2.0**-60
        tail = ULP - error * (1 + share)
        wanted = UNKNOWN if share < 2.0**-20 else YES
        assert dual_passes.between_neighbours(1.0, 1.0, tail, error) == wanted
        wanted = UNKNOWN if share < 2.0**-20 else NO
        assert dual_passes.between_neighbours(1.0, 1.0 + ULP, error * (1 + share), error) == wanted
        assert dual_passes.between_neighbours(1.0, 1.0 - ULP / 2, -error * (1 + share), error) == wanted

    def test_rounding(self) -> None:
        """Without an error, distances are trusted from 2^-50 of their sum on; that much itself is not."""
        for factor, yes, no in ((0.75, UNKNOWN, UNKNOWN), (1.5, YES, NO)):
            least = factor * 1.5 * 2.0**-102
            assert dual_passes.between_neighbours(1.0, 1.0, ULP - least, 0.0) == yes
            assert dual_passes.between_neighbours(1.0, 1.0, least - ULP / 2, 0.0) == yes
            assert dual_passes.between_neighbours(1.0, 1.0 + ULP, least, 0.0) == no
            assert dual_passes.between_neighbours(1.0, 1.0 - ULP / 2, -least, 0.0) == no
        inner, outer = 1.5 * 2.0**-102, (1.5 * 2.0**52 + 12) * 2.0**-154
        assert margin(1.0, 1.0, ULP - inner) == (Fraction(inner), Fraction(1.5 * ULP))
        for x, tail in (
            (1.0, ULP - inner), (1.0, inner - ULP / 2), (1.0 + ULP, outer), (1.0 - ULP / 2, -outer),
        ):  # fmt: skip
            assert dual_passes.between_neighbours(1.0, x, tail, 0.0) == UNKNOWN

    @pytest.mark.parametrize("claimed", [0.0, 2.0**-1060, -(2.0**-1022)])
    def test_tiny(self, claimed: float) -> None:
        """Below 2^-1000 nothing is told, twice that far outside all is."""
        for x in (0.0, 2.0**-1001, -(2.0**-1001)):
            assert dual_passes.between_neighbours(claimed, x, 0.0, 0.0) == UNKNOWN
        for x in (1.5 * 2.0**-1000, -1.5 * 2.0**-1000):
            assert dual_passes.between_neighbours(claimed, x, 0.0, 0.0) == NO

    @pytest.mark.parametrize("number", [math.inf, -math.inf, math.nan])
    def test_control_nothing_known(self, number: float) -> None:
        """What is claimed, or the error, is no finite number: nothing is told."""
        for x in (0.0, 1.0, -1e300, 1.7e308, -1.7e308):
            assert dual_passes.between_neighbours(number, x, 0.0, 0.0) == UNKNOWN
            assert dual_passes.between_neighbours(1.0, x, 0.0, abs(number)) == UNKNOWN


#: x, tail and error of a coordinate of which is said that z is next to it.
SAID = {NO: (0.5, 0.0, 0.0), YES: (0.0, 0.0, 0.0), UNKNOWN: (0.0, 0.0, math.inf)}


def centre_saying(first: int, second: int) -> list[float]:
    """A circumcentre about which (1, 2) is answered so, coordinate by coordinate."""
    (dx, *x), (dy, *y) = SAID[first], SAID[second]
    return [1.0 + dx, *x, 2.0 + dy, *y]


ANSWERS = (NO, YES, UNKNOWN)
PAIRS = [*product(ANSWERS, ANSWERS)]


def both(first: int, second: int) -> int:
    if NO in (first, second):
        return NO
    return YES if (first, second) == (YES, YES) else UNKNOWN


@pytest.mark.obligation(
    "V1", "a vertex is a circumcentre iff both coordinates are; a ridge's two ends are, in one of the two orders",
    method="enumeration", control_in="mutants",
)  # fmt: skip
class TestMatching:
    """All combinations of what is known of the coordinates, and of two vertices and two triangles."""

    def test_centres(self) -> None:
        table = np.array([centre_saying(*pair) for pair in PAIRS])
        for t, pair in enumerate(PAIRS):
            assert dual_passes.is_centre(table, t, 1.0, 2.0) == both(*pair)
        vertices = np.array([(7.0, 7.0), (1.0, 2.0), (1.0, 7.0)])
        pairs = np.array([(v, t) for v in range(3) for t in range(len(PAIRS))], dtype=np.intp)
        sure = np.full(len(pairs), -7, dtype=np.intp)
        dual_passes.match_vertices(table, vertices, pairs, sure)
        expected = [both(NO if x == 7.0 and a != UNKNOWN else a, NO if y == 7.0 and b != UNKNOWN else b)
                    for x, y in vertices.tolist() for a, b in PAIRS]  # fmt: skip
        assert sure.tolist() == expected

    def test_ends(self) -> None:
        """Four questions with three answers each; vertices are 4 apart, triangles 4 and a little."""
        vertices, table = list[tuple[float, float]](), list[tuple[int, int]]()
        ends, rows, wanted = list[tuple[int, int]](), list[tuple[int, int]](), list[int]()
        for ps, pt, qs, qt in product(ANSWERS, repeat=4):
            straight, turned = (ps, qt), (pt, qs)
            p, q = (1.0, 2.0), (1.0, 1.0 if len(ends) % 2 else 1.5)
            # A triangle answers for p by its x, and for q by its y: both lie on one line x = 1.
            k = len(vertices)
            vertices += [p, q]
            ends.append((k, k + 1))
            rows.append((k, k + 1))
            table += [(ps, qs), (pt, qt)]
            if straight == (YES, YES) or turned == (YES, YES):
                wanted.append(YES)
            else:
                wanted.append(NO if NO in straight and NO in turned else UNKNOWN)
        sure, order = np.empty(len(ends), dtype=np.intp), np.array(ends, dtype=np.intp)
        places = np.array(vertices)

        def answer(centres: FloatArray, t: int, x: float, y: float) -> int:
            return table[t][0 if y == 2.0 else 1]

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(dual_passes, "is_centre", answer)
            match_ends = getattr(dual_passes.match_ends, "py_func", dual_passes.match_ends)
            match_ends(np.zeros((len(table), 6)), places, order, np.array(rows, dtype=np.intp), sure)
        assert sure.tolist() == wanted
        assert {*wanted} == {*ANSWERS}

    @pytest.mark.parametrize("seed", range(4))
    def test_order(self, seed: int) -> None:
        """The likelier order has the smaller sum of distances; of equal sums it is the one that was given."""
        random, n = Random(seed), 60
        centres = np.array([[random.randrange(-4, 5) for _ in range(6)] for _ in range(n)], dtype=np.float64)
        vertices = np.array([[random.randrange(-4, 5) for _ in range(2)] for _ in range(n)], dtype=np.float64)
        ends = np.array([[random.randrange(n), random.randrange(n)] for _ in range(300)], dtype=np.intp)
        rows = np.array([[random.randrange(n), random.randrange(n)] for _ in range(300)], dtype=np.intp)
        after, sure = ends.copy(), np.empty(300, dtype=np.intp)
        dual_passes.match_ends(centres, vertices, after, rows, sure)

        def apart(v: int, t: int) -> float:
            return float(abs(vertices[v, 0] - centres[t, 0]) + abs(vertices[v, 1] - centres[t, 3]))

        changed = 0
        for (p, q), (s, t), found in zip(ends.tolist(), rows.tolist(), after.tolist(), strict=True):
            turned = apart(p, t) + apart(q, s) < apart(p, s) + apart(q, t)
            assert found == ([q, p] if turned else [p, q])
            assert dual_passes.distance_between(centres, s, *vertices[p]) == apart(p, s)
            changed += turned
        assert 0 < changed < 300

    def test_circumcentres(self) -> None:
        """Each exact coordinate is within the error of its pair, which is next to nothing."""
        points = np.random.default_rng(3).random((12, 2)) * [1.0, 4.0] + [0.0, 9.0]
        triangles = np.array([*islice(permutations(range(12), 3), 0, None, 40)], dtype=np.int32)
        centres = np.full((len(triangles), 6), math.nan)
        dual_passes.fill_centres(make_context(points), points, triangles, centres)
        exact = oracles.rationals(points.tolist())
        for (a, b, c), row in zip(triangles.tolist(), centres.tolist(), strict=True):
            centre, _ = oracles.circumcircle(exact[a], exact[b], exact[c])
            for z, (x, tail, error) in zip(centre, (row[:3], row[3:]), strict=True):
                assert abs(z - Fraction(x) - Fraction(tail)) <= error < 1e-15 * (1 + abs(x))


Directed = dict[tuple[int, int], tuple[int, int]]


def directed_edges(triangles: list[Triangle]) -> Directed:
    """The row that lists each directed edge, and the third corner."""
    return {(t[i], t[(i + 1) % 3]): (row, t[i - 1]) for row, t in enumerate(triangles) for i in range(3)}


def slots_by_ends(links: Links) -> dict[tuple[int, int], int]:
    v, b, _ = ends_of(links, np.arange(len(links.slots)))
    return {pair: i for i, pair in enumerate(zip(v.tolist(), b.tolist(), strict=True))}


@pytest.mark.obligation(
    "V1", "a ridge finds its edge and the triangles beside it; ridges are expected just where circumcentres differ",
    method="enumeration", control_in="mutants",
)  # fmt: skip
class TestEdges:
    """On triangulations of lattice points, of which triangles were taken away: all pairs of points, and -1."""

    @staticmethod
    def _cases() -> list[tuple[list[tuple[int, int]], list[Triangle]]]:
        points, random = grid(3, 3), Random(5)
        cases = []
        for rows in islice(triangulations(points), 0, None, 11):
            kept = [t for t in rows if random.random() < 0.85]
            cases.append((points, kept))
        return cases

    def test_found(self) -> None:
        for points, triangles in self._cases():
            mesh = mesh_of(points, triangles)
            links, edges = links_of(mesh), directed_edges(triangles)
            places = slots_by_ends(links)
            pairs = [*product(range(-1, len(points)), repeat=2), (0, 1), (1, 0), (4, 0)]
            slots, found = np.full(len(pairs), -7, dtype=np.intp), np.full((len(pairs), 2), -7, dtype=np.intp)
            times = np.zeros(len(links.slots), dtype=np.intp)
            dual_passes.find_ridges(
                links, rows_of_slots(links, mesh.triangles), np.array(pairs, dtype=np.intp), times, slots, found
            )
            counts: npt.NDArray[np.intp] = np.zeros(len(links.slots), dtype=np.intp)
            for (a, b), slot, beside in zip(pairs, slots.tolist(), found.tolist(), strict=True):
                there = [edges[pair][0] for pair in ((a, b), (b, a)) if pair in edges]
                low, high = min(a, b), max(a, b)
                if a == b or not there:
                    assert (slot, beside) == (-1, [-1, -1])
                    continue
                assert slot == places.get((low, high), places.get((high, low)))
                assert beside == (there if len(there) == 2 else [*there, -1])
                counts[slot] += 1
            assert times.tolist() == counts.tolist()

    def test_expected(self) -> None:
        seen = set()
        for points, triangles in self._cases():
            mesh, exact = mesh_of(points, triangles), oracles.rationals(points)
            links, edges = links_of(mesh), directed_edges(triangles)
            centre = [oracles.circumcircle(exact[a], exact[b], exact[c])[0] for a, b, c in triangles]
            expected = np.full(len(links.slots), True)
            for begin, end in ((0, 4), (4, len(points))):
                dual_passes.expect_ridges(mesh.context, mesh.coordinates, links, expected, begin, end)
            for (v, b), slot in slots_by_ends(links).items():
                back = edges.get((b, v))
                differ = back is not None and centre[back[0]] != centre[edges[v, b][0]]
                assert expected[slot] == (back is None or (v < b and differ))
                seen.add((back is None, v < b, differ))
        assert seen == {(True, True, False), (True, False, False)} | {
            (False, *x) for x in product((True, False), repeat=2)
        }
