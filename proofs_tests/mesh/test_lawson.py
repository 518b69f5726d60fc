"""M2, M3: what a flip does, and where flips end, from every triangulation of small point sets."""

import sys
from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import islice, pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from proofs_tests import oracles
from proofs_tests.kernel import oracle as kernel_oracle
from proofs_tests.mesh import enumeration
from proofs_tests.mesh import oracle as mesh_oracle
from proofs_tests.mesh.enumeration import COUNTS, Triangulation, canonical_triangles, grid, triangulations
from proofs_tests.mesh.strategies import small_grid_sets
from proofs_tests.oracles import RationalPoint
from proofs_tests.recording import Record

from exactkernel import incircle
from exactkernel.jit import COMPILED
from exactmesh import (
    PSLG,
    Edge,
    InadmissibleError,
    Primal,
    PSLGError,
    QuadEdge,
    TopologyError,
    constrained_delaunay,
    delaunay,
    flip,
    is_flippable,
    is_locally_delaunay,
    lawson,
)
from exactmesh import Triangulation as Mesh
from exactmesh.ids import OUTSIDE
from exactmesh.verify import Property, Verdict

Points = Sequence[tuple[float, float]]

#: Interpreted, a part of them; compiled, all.
CASES = {name: case if COMPILED or case[1] < 100 else (case[0], -1) for name, case in COUNTS.items()}


def corners(points: Sequence[RationalPoint], edge: Edge[Primal]) -> list[RationalPoint]:
    """a, b, c, d counterclockwise: the edge from a to c, b on its right, d on its left, found by walking the faces."""
    return [points[v] for v in (edge.org, edge.sym.lnext.dest, edge.dest, edge.lnext.dest)]


def exact_incircle(a: RationalPoint, b: RationalPoint, c: RationalPoint, d: RationalPoint) -> Fraction:
    """The determinant, not its sign: twice the area of abc times what d lacks to the circle."""
    centre, radius = oracles.circumcircle(a, b, c)
    return oracles.orient(a, b, c) * (radius - oracles.squared_distance(centre, d))


def inner(surface: QuadEdge) -> list[Edge[Primal]]:
    return [edge for edge in surface.edges() if OUTSIDE not in (edge.left, edge.right)]


def rows(surface: QuadEdge) -> Triangulation:
    return canonical_triangles(surface.triangles().tolist())


Test = Callable[[Points, Edge[Primal]], bool]


def flip_while(points: Points, start: Triangulation, is_good: Test) -> list[Triangulation]:
    """Lawson's algorithm from the public primitives: flip any edge that is not good; return every triangulation met."""
    surface = QuadEdge.from_triangles(start)
    met = [start]
    while True:
        bad = next((edge for edge in inner(surface) if not is_good(points, edge)), None)
        if bad is None:
            return met
        flip(points, bad)
        met.append(rows(surface))


def plain_test(points: Points, edge: Edge[Primal]) -> bool:
    """The test without perturbation: ties are left as they are."""
    a, b, c, d = (points[v] for v in (edge.org, edge.sym.lnext.dest, edge.dest, edge.lnext.dest))
    return incircle(a, b, c, d) <= 0


@pytest.mark.obligation("M2", "each flip lowers 6 Phi by exactly incircle, a tie only its slopes", method="enumeration")
class TestOneFlip:
    """A flip of ac to bd changes 6 Phi by exactly -incircle(a, b, c, d), whichever edge is flipped, Delaunay or not;
    a tie changes nothing but the slopes of 6 Phi in the lifts."""

    @pytest.mark.parametrize("name", ["3 x 3 grid", "cocircular octagon", "convex hexagon"])
    def test_potential(self, name: str, record_property: Record) -> None:
        points = COUNTS[name][0]
        exact = oracles.rationals(points)
        flips = 0
        for start in islice(triangulations(points), 0, None, 4):
            before = mesh_oracle.potential(exact, start)
            for edge in inner(QuadEdge.from_triangles(start)):
                surface = QuadEdge.from_triangles(start)
                same = surface.edge(edge.index)
                if not is_flippable(points, same):
                    with pytest.raises(TopologyError):
                        flip(points, same)
                    assert rows(surface) == start
                    continue
                a, b, c, d = corners(exact, same)
                flip(points, same)
                after = mesh_oracle.potential(exact, rows(surface))
                assert before - after == exact_incircle(a, b, c, d)
                slopes = [mesh_oracle.star_areas(exact, t) for t in (start, rows(surface))]
                assert (slopes[1] < slopes[0]) is (kernel_oracle.incircle_perturbed(a, b, c, d) > 0) or before != after
                flips += 1
        assert flips > 10
        record_property("cases", flips)

    @pytest.mark.parametrize("name", ["3 x 3 grid", "convex hexagon"])
    def test_flippable_is_strictly_convex(self, name: str) -> None:
        points = COUNTS[name][0]
        exact = oracles.rationals(points)
        seen = set()
        for start in triangulations(points):
            for edge in inner(QuadEdge.from_triangles(start)):
                a, b, c, d = corners(exact, edge)
                turns = [oracles.orient(*t) for t in ((a, b, c), (b, c, d), (c, d, a), (d, a, b))]
                assert is_flippable(points, edge) is (min(turns) > 0)
                assert is_locally_delaunay(points, edge) is (kernel_oracle.incircle_perturbed(a, b, c, d) < 0)
                seen.add((is_flippable(points, edge), is_locally_delaunay(points, edge)))
        assert (False, False) not in seen  # what is not locally Delaunay can be flipped
        assert {(True, True), (True, False)} <= seen

    def test_control_another_determinant(self) -> None:
        """The change is no other determinant: with d in the place of c it differs."""
        points = COUNTS["convex hexagon"][0]
        exact = oracles.rationals(points)
        surface = QuadEdge.from_triangles(next(triangulations(points)))
        edge = next(edge for edge in inner(surface) if is_flippable(points, edge))
        a, b, c, d = corners(exact, edge)
        before = mesh_oracle.potential(exact, rows(surface))
        flip(points, edge)
        change = before - mesh_oracle.potential(exact, rows(surface))
        assert change not in (0, exact_incircle(a, b, d, c), exact_incircle(b, a, c, d))

    def test_the_hull_is_left_alone(self) -> None:
        points = [(0, 0), (1, 0), (0, 1)]
        for edge in QuadEdge.from_triangles([(0, 1, 2)]).edges():
            assert is_locally_delaunay(points, edge)
            assert not is_flippable(points, edge)
            with pytest.raises(TopologyError) as raised:
                flip(points, edge)
            assert raised.value.indices == (edge.org, edge.dest)


def descends(points: Sequence[RationalPoint], met: Sequence[Triangulation]) -> bool:
    """Tell whether (6 Phi, its slopes in lexicographic order) falls from each triangulation to the next."""
    heights = [(mesh_oracle.potential(points, t), mesh_oracle.star_areas(points, t)) for t in met]
    return all(after < before for before, after in pairwise(heights))


@pytest.mark.obligation(
    "M2", "the perturbed potential falls along Lawson, which takes at most n(n-1)/2 flips", method="enumeration"
)
class TestDescent:
    """Along Lawson's algorithm the perturbed potential falls strictly, ties included, so it ends, within n(n-1)/2
    flips: an edge once gone never comes back."""

    @pytest.mark.parametrize("name", ["3 x 3 grid", "cocircular octagon", "convex octagon"])
    def test_every_start(self, name: str, record_property: Record) -> None:
        points = COUNTS[name][0]
        exact = oracles.rationals(points)
        starts = list(islice(triangulations(points), 0, None, 5))
        for start in starts:
            met = flip_while(points, start, is_locally_delaunay)
            assert descends(exact, met)
            assert len(met) - 1 <= len(points) * (len(points) - 1) // 2
            gone: set[frozenset[int]] = set()
            for before, after in pairwise(met):
                edges = [{frozenset(e) for a, b, c in t for e in ((a, b), (b, c), (c, a))} for t in (before, after)]
                gone |= edges[0] - edges[1]
                assert not gone & edges[1]
        record_property("cases", len(starts))

    def test_control_descent_can_fail(self) -> None:
        """Backwards it rises; and with ties unperturbed 6 Phi alone stands still."""
        points = COUNTS["cocircular octagon"][0]
        exact = oracles.rationals(points)
        met = max((flip_while(points, t, is_locally_delaunay) for t in triangulations(points)), key=len)
        assert len(met) > 3
        assert not descends(exact, met[::-1])
        assert len({mesh_oracle.potential(exact, t) for t in met}) == 1


@pytest.mark.obligation(
    "M3", "there are as many triangulations as published, and flips connect them", method="enumeration"
)
class TestCounts:
    """The enumerator finds the published number of triangulations, each once. Twenty of each set or fewer, at even
    distances, are looked at: they are admissible, cover the hull and use all points. Flips reach all triangulations of
    a grid and of an octagon."""

    @pytest.mark.parametrize(("points", "count"), COUNTS.values(), ids=COUNTS.keys())
    def test_published(self, points: list[tuple[int, int]], count: int, record_property: Record) -> None:
        found = list(triangulations(points))
        assert len(found) == len(set(found)) == count
        exact = oracles.rationals(points)
        for t in found[:: 1 + count // 20]:
            assert oracles.is_admissible(exact, t)
            assert oracles.covers_hull(exact, t)
            assert {v for row in t for v in row} == set(range(len(points)))
        record_property("cases", count)

    @pytest.mark.parametrize("name", ["3 x 3 grid", "convex octagon"])
    def test_flip_graph_is_connected(self, name: str, record_property: Record) -> None:
        points = COUNTS[name][0]
        everything = set(triangulations(points))
        reached = {min(everything)}
        frontier = list(reached)
        while frontier:
            start = frontier.pop()
            for index in [edge.index for edge in inner(QuadEdge.from_triangles(start))]:
                surface = QuadEdge.from_triangles(start)
                if is_flippable(points, surface.edge(index)):
                    flip(points, surface.edge(index))
                    if rows(surface) not in reached:
                        reached.add(rows(surface))
                        frontier.append(rows(surface))
        assert reached == everything
        record_property("cases", len(everything))

    @pytest.mark.parametrize("name", ["3 x 3 grid", "convex octagon"])
    def test_control_one_diagonal_too_few(self, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
        """An enumeration that leaves out one of the empty triangles: its count is another one."""
        empty = enumeration._empty_triangles
        monkeypatch.setattr(enumeration, "_empty_triangles", lambda points: empty(points)[1:])
        with pytest.raises(AssertionError):
            self.test_published(*COUNTS[name], print)


@pytest.mark.obligation(
    "M3",
    "Lawson ends in the Delaunay triangulation from every triangulation; its smallest angle is maximal",
    method="enumeration",
)
class TestOneSink:
    """From every triangulation Lawson's algorithm ends in the one whose perturbed circles are empty, which is also what
    insertion builds, and whose smallest angle is the largest of all."""

    @pytest.mark.parametrize(("points", "count"), CASES.values(), ids=CASES.keys())
    def test_every_start(self, points: list[tuple[int, int]], count: int, record_property: Record) -> None:
        expected = mesh_oracle.delaunay_triangles(oracles.rationals(points))
        inserted = delaunay(points)
        assert canonical_triangles(inserted.triangles.tolist()) == expected
        most = len(points) * (len(points) - 1) // 2
        flips = set()
        starts = list(islice(triangulations(points), 0, None if count > 0 else 40, max(1, count // 500)))
        for start in starts:
            mesh = lawson(points, start)
            assert canonical_triangles(mesh.triangles.tolist()) == expected
            assert mesh.work.flips <= most
            assert (mesh.work.flips == 0) is (start == expected)
            flips.add(mesh.work.flips)
        assert len(flips) > 1
        assert mesh.canonical() == inserted.canonical()
        record_property("cases", len(starts))

    @pytest.mark.parametrize("name", ["3 x 3 grid", "convex octagon", "cocircular octagon"])
    def test_smallest_angle(self, name: str, record_property: Record) -> None:
        exact = oracles.rationals(COUNTS[name][0])
        best = mesh_oracle.sharpest_corner(exact, mesh_oracle.delaunay_triangles(exact))
        others = [mesh_oracle.sharpest_corner(exact, t) for t in triangulations(COUNTS[name][0])]
        assert min(others) == best
        if name != "cocircular octagon":
            assert max(others) > best
        record_property("cases", len(others))

    def test_control_without_perturbation_there_are_many(self) -> None:
        """The uniqueness above comes from the perturbation: the plain test ends wherever the ties were at the start."""
        points = COUNTS["3 x 3 grid"][0]
        starts = list(triangulations(points))
        assert len({flip_while(points, t, is_locally_delaunay)[-1] for t in starts}) == 1
        assert len({flip_while(points, t, plain_test)[-1] for t in starts}) == 2**4

    @settings(max_examples=settings().max_examples // 3)
    @given(small_grid_sets(), st.integers(0, 2**32))
    def test_grid_sets(self, points: list[tuple[int, int]], seed: int) -> None:
        """Any start within reach of random flips, on points with many ties."""
        mesh = delaunay(points)
        surface = mesh.quad_edge()
        random = np.random.default_rng(seed)
        for index in random.permutation([edge.index for edge in surface.edges()] * 3).tolist():
            if is_flippable(points, surface.edge(index)):
                flip(points, surface.edge(index))
        again = lawson(points, surface.triangles())
        assert canonical_triangles(again.triangles.tolist()) == canonical_triangles(mesh.triangles.tolist())


@pytest.mark.bounds
@pytest.mark.obligation("M3", "Lawson ends there from starts far away", method="named cases", control_in="TestOneSink")
class TestManyPoints:
    """The same from a start that has nothing to do with Delaunay: a fan of needles, and equal diagonals."""

    @pytest.mark.parametrize("n", [12, 2000 if COMPILED else 60])
    def test_fan(self, n: int) -> None:
        points = np.array([(float(i), float(i * i)) for i in range(n)])
        mesh = lawson(points, [(n - 1, i, i + 1) for i in range(n - 2)])
        assert mesh.canonical() == delaunay(points).canonical()
        assert 0 < mesh.work.flips <= n * (n - 1) // 2

    def test_grid_of_equal_diagonals(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(sys.modules["exactmesh.lawson"], "_CHUNK", 100)  # in more than one run
        side = 100 if COMPILED else 12
        points = np.array(grid(side, side), dtype=np.float64)
        low = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
        start = np.concatenate(
            [
                np.stack([low, low + side, low + 1], axis=1),
                np.stack([low + 1, low + side, low + side + 1], axis=1),
            ]
        )
        mesh = lawson(points, start)
        assert mesh.canonical() == delaunay(points).canonical()
        assert mesh.work.flips in (0, (side - 1) ** 2)


@pytest.mark.bounds
@pytest.mark.obligation(
    "M5", "constrained flips end in THE constrained Delaunay triangulation, from every start", method="enumeration"
)
class TestConstrained:
    """From any triangulation in which the segments are edges, the flips of the others end in the triangulation that
    inserting the segments gives."""

    @pytest.mark.parametrize("name", ["convex hexagon", "cocircular octagon", "3 x 3 grid"])
    def test_every_start(self, name: str) -> None:
        points = COUNTS[name][0]
        n = len(points)
        expected: dict[tuple[int, int], Triangulation] = {}
        flips = set()
        for start in islice(triangulations(points), 0, None if COMPILED else 6):
            edges = sorted({(min(a, b), max(a, b)) for t in start for a, b in (t[:2], t[1:], t[::2])})
            for segment in edges[:: 1 if n < 8 else 5]:
                if segment not in expected:
                    graph = constrained_delaunay(PSLG(points, [segment]), carve=False)
                    expected[segment] = canonical_triangles(graph.triangles.tolist())
                mesh = lawson(points, start, segments=[segment])
                assert canonical_triangles(mesh.triangles.tolist()) == expected[segment]
                flips.add(mesh.work.flips)
        assert len(flips) > 1
        assert len(set(expected.values())) > 1

    @settings(max_examples=settings().max_examples // 3)
    @given(small_grid_sets(), st.integers(0, 2**32))
    def test_grid_sets(self, points: list[tuple[int, int]], seed: int) -> None:
        """Random triangulations with random edges, and with segments that are chains of several edges."""
        random = np.random.default_rng(seed)
        surface = delaunay(points).quad_edge()
        for index in random.permutation([edge.index for edge in surface.edges()] * 3).tolist():
            if is_flippable(points, surface.edge(index)):
                flip(points, surface.edge(index))
        edges = [(edge.org, edge.dest) for edge in surface.edges()]
        random.shuffle(edges)
        start = surface.triangles()
        mesh = lawson(points, start, segments=edges[:4])
        assert_the_same(mesh, constrained_delaunay(PSLG(points, edges[:4]), carve=False))
        a, b = random.permutation(len(points))[:2].tolist()
        long = constrained_delaunay(PSLG(points, [(a, b)]), carve=False)
        assert_the_same(lawson(points, long.triangles, segments=[(a, b)]), long)

    def test_a_segment_that_is_no_chain_is_named(self) -> None:
        square = [(0, 0), (4, 0), (4, 4), (0, 4)]
        with pytest.raises(InadmissibleError, match="segment 1 \\(1, 3\\) is no chain of edges") as refused:
            lawson(square, [(0, 1, 2), (0, 2, 3)], segments=[(0, 1), (1, 3), (0, 2)])
        assert refused.value.indices == (1,)
        assert refused.value.report.verdict(Property.SEGMENTS_PRESENT) is Verdict.FAILS
        assert not refused.value.report.ok
        with pytest.raises(PSLGError, match="segment 0 begins and ends"):
            lawson(square, [(0, 1, 2), (0, 2, 3)], segments=[(1, 1)])

    def test_control_the_segment_is_what_keeps_an_edge(self) -> None:
        """The segment left out."""
        points, start = [(0, 0), (4, 0), (5, 3), (0, 1)], [(0, 1, 2), (0, 2, 3)]
        free, kept = lawson(points, start), lawson(points, start, segments=[(2, 0)])
        assert (free.work.flips, kept.work.flips) == (1, 0)
        assert free.canonical() != kept.canonical()


def assert_the_same(one: Mesh, other: Mesh) -> None:
    one, other = one.canonical(), other.canonical()
    assert one == other
    assert one.segment_incidence.tolist() == other.segment_incidence.tolist()
    assert one.vertex_markers.tolist() == other.vertex_markers.tolist()
    assert one.segment_markers.tolist() == other.segment_markers.tolist()


class TestVerticesWithoutCoordinates:
    """A flip primitive names the vertex that the points do not reach."""

    def test_named(self) -> None:
        surface = QuadEdge.from_triangles([(0, 1, 2), (0, 2, 3)])
        diagonal = next(e for e in surface.edges() if {e.org, e.dest} == {0, 2})
        with pytest.raises(TopologyError, match="vertex 3 has no row in 3 points"):
            is_flippable([(0, 0), (1, 0), (1, 1)], diagonal)
