"""M5: the constrained Delaunay triangulation is unique, is what its definition says, and contains every segment."""

import os
import subprocess
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations, pairwise, permutations
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from proofs_tests import oracles
from proofs_tests.graphs.crossing_strategies import SEVEN, bundle
from proofs_tests.graphs.strategies import Graph, graphs
from proofs_tests.kernel.strategies import Point
from proofs_tests.mesh import constrained_oracle
from proofs_tests.mesh.constrained_oracle import Edge, Segment, edges_of
from proofs_tests.mesh.enumeration import (
    CIRCLE_OF_EIGHT,
    COUNTS,
    Triangulation,
    canonical_triangles,
    grid,
    triangulations,
)
from proofs_tests.oracles import RationalPoint, Triangle
from proofs_tests.recording import Record

from exactkernel.jit import COMPILED
from exactmesh import PSLG, ExactMeshError, constrained_delaunay, delaunay, verify
from exactmesh.errors import CollinearPointsError, CrossingError

Rows = tuple[Triangle, ...]


def ours(points: Sequence[Sequence[float]], segments: Iterable[Segment], seed: int = 0) -> Rows:
    """The library's triangles of the whole hull, between distinct points in the order of the input."""
    mesh = constrained_delaunay(PSLG(points, list(segments)), carve=False, seed=seed)
    return canonical_triangles(mesh.triangles.tolist())


def distinct(graph: Graph) -> tuple[list[RationalPoint], list[Segment]]:
    """The graph with equal points merged, in fractions."""
    exact = oracles.rationals(graph.points)
    places = list(dict.fromkeys(exact))
    return places, [(places.index(exact[a]), places.index(exact[b])) for a, b in graph.segments]


SETS: dict[str, list[tuple[int, int]]] = {
    "convex hexagon": COUNTS["convex hexagon"][0],
    "cocircular octagon": CIRCLE_OF_EIGHT,
    "2 x 4 grid": grid(2, 4),
    "3 x 3 grid": grid(3, 3),
    "general position": [(0, 0), (7, 1), (3, 9), (3, 3), (4, 4), (5, 2)],
}


class FlipGraph:
    """All triangulations of some points, and the flips that the perturbed incircle test asks for."""

    def __init__(self, points: list[tuple[int, int]]) -> None:
        self.points = oracles.rationals(points)
        self.all: dict[Triangulation, dict[Edge, Triangulation]] = {t: self.flips(t) for t in triangulations(points)}

    def flips(self, rows: Triangulation) -> dict[Edge, Triangulation]:
        """For each edge that is not locally Delaunay: the triangulation that its flip leads to."""
        found: dict[Edge, Triangulation] = {}
        for one, other in combinations(rows, 2):
            common = frozenset(one) & frozenset(other)
            if len(common) == 2:
                (a,), (b,) = set(one) - common, set(other) - common
                if constrained_oracle.in_circle(self.points, one, b):
                    c, d = common
                    new = [oracles.counterclockwise(self.points, (a, b, v)) for v in (c, d)]
                    found[common] = canonical_triangles([*(t for t in rows if t not in (one, other)), *new])
        return found

    def constraints(self) -> Iterator[frozenset[Edge]]:
        """Every set of inner edges that some triangulation contains."""
        seen: set[frozenset[Edge]] = set()
        for rows in self.all:
            counts = Counter(edge for t in rows for edge in edges_of(t))
            inner = [edge for edge, count in counts.items() if count == 2]
            seen.update(frozenset(c) for k in range(len(inner) + 1) for c in combinations(inner, k))
        return iter(sorted(seen, key=lambda c: sorted(map(sorted, c))))

    def sinks(self, fixed: frozenset[Edge]) -> list[Triangulation]:
        """The triangulations with these edges from which no flip but of these edges leads on."""
        return [rows for rows, flips in self.all.items() if flips.keys() <= fixed and fixed <= all_edges(rows)]


def all_edges(rows: Triangulation) -> set[Edge]:
    return {edge for t in rows for edge in edges_of(t)}


def segments_of(edges: Iterable[Edge]) -> list[Segment]:
    return [(min(edge), max(edge)) for edge in edges]


@pytest.mark.obligation(
    "M5",
    "constrained flips lead from every constrained triangulation to one: ours",
    method="enumeration",
    control_in="TestFaultsAreFound",
)
@pytest.mark.parametrize("name", SETS)
class TestOneSink:
    """Flips of edges that are not locally Delaunay lead to triangulations, and never in a circle; whatever edges are
    left alone, exactly one triangulation that has them allows no flip. It is what constrained_delaunay returns."""

    def test_flips_descend(self, name: str) -> None:
        graph = FlipGraph(SETS[name])
        waiting = set(graph.all)
        while waiting:  # take away those that lead only to what has been taken away
            done = {rows for rows in waiting if not waiting & set(graph.all[rows].values())}
            assert done
            waiting -= done
        assert all(after in graph.all for flips in graph.all.values() for after in flips.values())

    def test_unique(self, name: str, record_property: Record) -> None:
        graph = FlipGraph(SETS[name])
        every = list(graph.constraints())
        for fixed in every:
            assert len(graph.sinks(fixed)) == 1
        record_property("cases", len(every))

    def test_ours(self, name: str, record_property: Record) -> None:
        graph = FlipGraph(SETS[name])
        some = list(graph.constraints())[:: 1 if COMPILED else 17]
        for fixed in some:
            assert [ours(SETS[name], segments_of(fixed))] == graph.sinks(fixed)
        record_property("cases", len(some))

    def test_by_visibility(self, name: str, record_property: Record) -> None:
        """The sink is what visibility says."""
        graph = FlipGraph(SETS[name])
        every = list(graph.constraints())
        for fixed in every[:: 1 + len(every) // 30]:
            assert [constrained_oracle.constrained_triangles(graph.points, segments_of(fixed))] == graph.sinks(fixed)
        record_property("cases", len(every[:: 1 + len(every) // 30]))


@pytest.mark.obligation(
    "M5",
    "no vertex in the circle of a triangle sees it past the segments, and so for no other",
    method="property-based",
)
class TestVisibility:
    """The triangles of the hull are those, over all triples, that no segment cuts and whose perturbed circle contains
    no vertex that they see: for grids, cocircular, collinear and extreme points, overlaps, T-junctions, duplicates."""

    @given(graphs())
    @settings(max_examples=150)
    def test_brute_force(self, graph: Graph) -> None:
        points, segments = distinct(graph)
        try:
            rows = ours(graph.points, graph.segments)
        except CollinearPointsError:
            assert constrained_oracle.constrained_triangles(points, segments) == ()
            return
        assert rows == constrained_oracle.constrained_triangles(points, segments)

    @pytest.mark.once
    @given(graphs(most=8))
    @settings(max_examples=25)
    def test_oracle_covers_the_hull(self, graph: Graph) -> None:
        """The oracle itself: its triangles cover the hull once, and contain every piece of a segment."""
        points, segments = distinct(graph)
        rows = constrained_oracle.constrained_triangles(points, segments)
        if rows:
            assert oracles.is_admissible(points, rows)
            assert oracles.covers_hull(points, rows)
            assert constrained_oracle.noded(points, segments) <= all_edges(rows)

    def test_control_visibility_matters(self) -> None:
        """Without segments in the way, or with one piece left out, the oracle says something else."""
        points, wall = oracles.rationals([(0, 0), (8, 0), (8, 2), (0, 2), (4, 1), (4, -9)]), [(0, 1)]
        assert constrained_oracle.in_circle(points, (0, 1, 4), 5)
        assert (0, 1, 4) in constrained_oracle.constrained_triangles(points, wall)
        assert (0, 1, 4) not in constrained_oracle.constrained_triangles(points, [])
        assert constrained_oracle.is_visible(points, [], (0, 1, 4), 5)
        assert not constrained_oracle.is_visible(points, [frozenset(wall[0])], (0, 1, 4), 5)


@pytest.mark.obligation(
    "M5", "every segment is a chain of constrained edges, and nothing else is constrained", method="property-based"
)
class TestSegmentsArePresent:
    """The constrained edges are the pieces into which vertices cut the segments; segment_incidence has one row for each
    piece of each segment; chain(i) leads along segment i from its start to its end."""

    @given(graphs())
    @settings(max_examples=120)
    def test_pieces(self, graph: Graph) -> None:
        points, segments = distinct(graph)
        try:
            mesh = constrained_delaunay(PSLG(graph.points, graph.segments), carve=False)
        except CollinearPointsError:
            return
        rows: list[list[int]] = mesh.segments.tolist()
        edges = [frozenset(row) for row in rows]
        assert len(set(edges)) == len(edges)
        assert set(edges) == constrained_oracle.noded(points, segments)
        assert set(edges) <= all_edges(canonical_triangles(mesh.triangles.tolist()))
        chains = [constrained_oracle.chain(points, segment) for segment in segments]
        for i, vertices in enumerate(chains):
            assert mesh.chain(i).tolist() == [list(pair) for pair in pairwise(vertices)]
        expected = [
            [edges.index(frozenset(pair)), i] for i, vertices in enumerate(chains) for pair in pairwise(vertices)
        ]
        assert mesh.segment_incidence.tolist() == sorted(expected)

    @given(graphs())
    @settings(max_examples=60)
    def test_rows_follow_the_segments(self, graph: Graph) -> None:
        """Constrained edges come in the order of the first segment that they are part of, in its direction."""
        points, segments = distinct(graph)
        try:
            mesh = constrained_delaunay(PSLG(graph.points, graph.segments), carve=False)
        except CollinearPointsError:
            return
        expected: list[list[int]] = []
        for segment in segments:
            vertices = constrained_oracle.chain(points, segment)
            for pair in pairwise(vertices):
                if set(pair) not in map(set, expected):
                    expected.append(list(pair))
        assert mesh.segments.tolist() == expected

    def test_control_a_vertex_off_the_segment(self) -> None:
        """One unit in the last place beside the segment, a vertex does not cut it."""
        for y, pieces in ((0.5, 2), (np.nextafter(0.5, 1.0), 1)):
            mesh = constrained_delaunay(PSLG([(0, 0), (1, 1), (0, 1), (1, 0), (0.5, y)], [(0, 1)]), carve=False)
            assert len(mesh.segments) == pieces


@pytest.mark.obligation(
    "M5", "the result depends on no order and on no seed", method="enumeration", control_in="TestFaultsAreFound"
)
class TestEveryOrder:
    """Any order of points, any order and direction of segments, and any seed give the same triangulation."""

    POINTS: tuple[Point, ...] = ((0, 0), (4, 0), (4, 2), (0, 2), (1, 1), (2, 1), (3, 1))
    SEGMENTS: tuple[Segment, ...] = ((0, 2), (4, 6), (1, 6), (4, 3))

    def test_every_order_of_segments(self, record_property: Record) -> None:
        expected = ours(self.POINTS, self.SEGMENTS)
        orders = list(permutations(self.SEGMENTS))
        for order in orders:
            for mask in range(1 << len(order)):
                turned = [(b, a) if mask >> i & 1 else (a, b) for i, (a, b) in enumerate(order)]
                assert ours(self.POINTS, turned) == expected
        record_property("cases", len(orders) << len(self.SEGMENTS))

    def test_every_order_of_points(self, record_property: Record) -> None:
        expected = constrained_delaunay(PSLG(self.POINTS, self.SEGMENTS), carve=False).canonical()
        orders = list(permutations(range(7)))[:: 7 if COMPILED else 210]
        for order in orders:
            segments = [(order.index(a), order.index(b)) for a, b in self.SEGMENTS]
            pslg = PSLG([self.POINTS[i] for i in order], segments)
            assert constrained_delaunay(pslg, carve=False).canonical() == expected
        record_property("cases", len(orders))

    @given(graphs(), st.integers(0, 2**64), st.randoms(use_true_random=False))
    @settings(max_examples=80)
    def test_any_order(self, graph: Graph, seed: int, random: st.DataObject) -> None:
        order = list(range(len(graph.points)))
        random.shuffle(order)  # type: ignore[attr-defined]  # hypothesis calls its Random a data object
        segments = [(order.index(b), order.index(a)) for a, b in reversed(graph.segments)]
        pslg = PSLG([graph.points[i] for i in order], segments)
        try:
            mesh = constrained_delaunay(pslg, carve=False, seed=seed)
        except CollinearPointsError:
            return
        same = constrained_delaunay(PSLG(graph.points, graph.segments), carve=False)
        assert (same.canonical().segments == mesh.canonical().segments).all()
        assert same.canonical() == mesh.canonical()

    @given(graphs())
    @settings(max_examples=60)
    def test_edges_that_are_there_change_nothing(self, graph: Graph) -> None:
        """Constraining edges of the Delaunay triangulation, or those of the result, leaves the triangles alone."""
        try:
            mesh = constrained_delaunay(PSLG(graph.points, graph.segments), carve=False)
        except CollinearPointsError:
            return
        places = [(x, y) for x, y in mesh.points.tolist()]
        assert ours(places, [(a, b) for a, b in mesh.edges.tolist()]) == canonical_triangles(mesh.triangles.tolist())
        plain = delaunay(graph.points)
        assert ours(places, [(a, b) for a, b in plain.edges.tolist()]) == canonical_triangles(plain.triangles.tolist())


@pytest.mark.obligation(
    "M5", "the corpus: near-concurrent segments, split, are constrained Delaunay, and admissible", method="named cases"
)
class TestCorpus:
    """Number 7 of the corpus of other meshers' failures, and its 150 bundles: of those Triangle fails on 129."""

    def verified(self, pslg: PSLG) -> bool:
        mesh = constrained_delaunay(pslg, carve=False, crossings="split")
        assert mesh.arrangement is not None
        chains = [mesh.chain(i) for i in range(len(pslg.segments))]
        assert all((chain[1:, 0] == chain[:-1, 1]).all() for chain in chains)
        return verify(mesh.points, mesh.triangles, segments=mesh.segments).ok

    def test_number_seven(self) -> None:
        assert self.verified(PSLG(SEVEN, [(0, 1), (2, 3), (4, 5)]))

    def test_bundles(self) -> None:
        for seed in range(150):
            assert self.verified(PSLG(*bundle(seed))), seed

    def test_control_a_flipped_edge_is_found(self) -> None:
        """A segment that the mesh does not have."""
        mesh = constrained_delaunay(PSLG(*bundle(0)), carve=False, crossings="split")
        assert verify(mesh.points, mesh.triangles, segments=mesh.segments).ok
        assert not verify(mesh.points, mesh.triangles, segments=[(int(mesh.hull[0]), int(mesh.hull[2]))]).ok


@pytest.mark.obligation(
    "M5", "segments that cross are refused, whatever the order, and only those", method="property-based"
)
class TestCrossings:
    """Segments are refused exactly when two of them meet in one point inside both that is no vertex; all these pairs
    are named, and no others."""

    @given(graphs(), st.data())
    @settings(max_examples=150)
    def test_one_more_segment(self, graph: Graph, data: st.DataObject) -> None:
        index = st.integers(0, len(graph.points) - 1)
        extra = data.draw(st.tuples(index, index))
        at = data.draw(st.integers(0, len(graph.segments)))
        try:
            pslg = PSLG(graph.points, [*graph.segments[:at], extra, *graph.segments[at:]])
        except ExactMeshError:
            return
        points, segments = distinct(Graph(graph.points, [tuple(row) for row in pslg.segments.tolist()]))
        pieces = [constrained_oracle.noded(points, [segment]) for segment in segments]
        crossing = [
            [i, j]
            for i, j in combinations(range(len(pieces)), 2)
            if any(constrained_oracle.crosses(points, p, q) for p in pieces[i] for q in pieces[j])
        ]
        found: list[list[int]] = []
        try:
            constrained_delaunay(pslg, carve=False)
        except CollinearPointsError:
            return
        except CrossingError as error:
            found = error.pairs.tolist()
        assert found == crossing

    def test_control_a_vertex_at_the_crossing(self) -> None:
        """Two segments that meet in a vertex are not to blame for two others that cross."""
        points = [(0, 0), (2, 2), (0, 2), (2, 0), (4, 0), (6, 2), (4, 2), (6, 0)]
        segments = [(0, 1), (2, 3), (4, 5), (6, 7)]
        for more, pairs in (
            ([], [[0, 1], [2, 3]]),
            ([(1, 1)], [[2, 3]]),
            ([(1, np.nextafter(1, 2))], [[0, 1], [2, 3]]),
        ):
            with pytest.raises(CrossingError) as caught:
                constrained_delaunay(PSLG([*points, *more], segments), carve=False)
            assert caught.value.pairs.tolist() == pairs


class Pairs:
    """Pairs of segments between points: what brute force says of each, "crossing" or the triangles and pieces."""

    def __init__(self, points: list[tuple[int, int]], every: int) -> None:
        self.points, exact = points, oracles.rationals(points)
        pairs = list(combinations(combinations(range(len(points)), 2), 2))
        self.expected: dict[tuple[Segment, Segment], object] = {}
        for one, other in pairs[::every]:
            first, second = (constrained_oracle.noded(exact, [segment]) for segment in (one, other))
            if any(constrained_oracle.crosses(exact, p, q) for p in first for q in second):
                self.expected[one, other] = "crossing"
            else:
                self.expected[one, other] = (
                    constrained_oracle.constrained_triangles(exact, (one, other)),
                    first | second,
                )

    def ours(self, pair: tuple[Segment, Segment]) -> object:
        try:
            mesh = constrained_delaunay(PSLG(self.points, pair), carve=False)
        except CrossingError:
            return "crossing"
        pieces = {frozenset((a, b)) for a, b in mesh.segments.tolist()}
        return canonical_triangles(mesh.triangles.tolist()), pieces

    def disagreements(self) -> list[tuple[Segment, Segment]]:
        return [pair for pair, result in self.expected.items() if self.ours(pair) != result]


@pytest.mark.obligation(
    "M5",
    "two segments on a grid or between cocircular points, one pair in five, give what brute force gives",
    method="enumeration",
    control_in="TestFaultsAreFound",
)
@pytest.mark.parametrize("points", [grid(3, 3), grid(2, 4), CIRCLE_OF_EIGHT], ids=["3 x 3", "2 x 4", "octagon"])
class TestEveryPair:
    """Two segments, one pair in five: refused exactly when they cross in no vertex, else the triangles and pieces of
    brute force."""

    def test_brute_force(self, points: list[tuple[int, int]], record_property: Record) -> None:
        pairs = Pairs(points, 5 if COMPILED else 11)
        assert not pairs.disagreements()
        refused = list(pairs.expected.values()).count("crossing")
        assert 0 < refused < len(pairs.expected) / 2
        record_property("cases", len(pairs.expected))


FAULTY = """
from proofs_tests.mesh.test_constrain import FAULTS, MODULES, CIRCLE_OF_EIGHT, Pairs, grid

sound = [dict(vars(module)) for module in MODULES.values()]
sets = Pairs(grid(3, 3), 7), Pairs(CIRCLE_OF_EIGHT, 5)
for fault in FAULTS.values():
    for module, names in zip(MODULES.values(), sound):
        vars(module).update(names)
    exec(fault, dict(MODULES))
    print(sum(len(pairs.disagreements()) for pairs in sets))
"""

MODULES = {name: sys.modules[f"exactmesh.{name}"] for name in ("constrain", "cavity", "plane")}

FAULTS = {
    "none": "",
    "the first vertex is the apex": "cavity.apex = lambda plane, chain, i, j: i + 1",
    "the last vertex is the apex": "cavity.apex = lambda plane, chain, i, j: j - 1",
    "ties left as they are": "from exactkernel.incircle import incircle_adaptive; "
    "plane.incircle_perturbed_adaptive = incircle_adaptive",
    "a segment ends at the first vertex on it": "step = constrain.step; "
    "constrain.step = lambda p, a, b: (step(p, a, b)[0], b)",
    "constrained edges are crossed": "march = constrain.march; "
    "constrain.march = lambda p, e, b: march(p._replace(fixed=[False] * len(p.fixed)), e, b)",
}


@pytest.mark.once
@pytest.mark.obligation(
    "M5", "a constrained insertion with a seeded fault is found by the enumeration", method="mutation"
)
class TestFaultsAreFound:
    """The comparison with brute force rejects seeded faults: run in a child process, interpreted."""

    def test_control_faults(self) -> None:
        """Lines of the insertion changed, one by one; each makes the enumeration disagree, none does not."""
        child = subprocess.run(
            [sys.executable, "-c", FAULTY],
            env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
            cwd=Path(__file__).parents[2],
            capture_output=True,
            text=True,
            check=True,
        )
        found = dict(zip(FAULTS, map(int, child.stdout.split()), strict=True))
        assert found.pop("none") == 0
        assert all(found.values()), found
