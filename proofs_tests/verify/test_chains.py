"""V1 for straight chains and for the sorted neighbours that find them, each function alone, against fractions."""

from collections.abc import Iterator, Sequence
from itertools import pairwise, permutations, product
from random import Random

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.oracles import Triangle

from exactkernel.context import make_context
from exactmesh import delaunay
from exactmesh.verify import chains, spokes
from exactmesh.verify.chains import CONSTRAINED, IN_DOMAIN, ODD
from exactmesh.verify.links import Links, linked
from exactmesh.verify.local import localized
from exactmesh.verify.mesh import Mesh, index_quads, index_triples, prepared_mesh

Place = tuple[float, float]


def linked_mesh(points: Sequence[Place], triangles: Sequence[Triangle]) -> tuple[Mesh, Links]:
    mesh, _ = prepared_mesh(np.array(points), index_triples(triangles), index_quads(()), np.empty((0, 2)))
    return mesh, linked(len(points), mesh.context, localized(mesh.coordinates, mesh.triangles, mesh.quads))


def holed_grid(seed: int) -> tuple[list[Place], list[Triangle]]:
    """Points of a grid, shuffled but for one in the middle, triangulated but for a few triangles; and a few in the
    middle of edges that are no corners."""
    random = Random(seed)
    points = [(float(x), float(y)) for x in range(5) for y in range(4) if random.random() < 0.8]
    random.shuffle(points)
    points.sort(key=lambda p: abs(p[0] - 2) + abs(p[1] - 1) > 0)
    triangles = [(int(a), int(b), int(c)) for a, b, c in delaunay(points).triangles]
    triangles = [t for t in triangles if random.random() < 0.8]
    middles = [[(points[v][i] + points[w][i]) / 2 for i in range(2)] for v, w, _ in triangles[:2]]
    return points + [(x, y) for x, y in middles], triangles


def fan(n: int) -> tuple[list[Place], list[Triangle]]:
    """A vertex with more neighbours than are searched one by one, some of them in one direction, and a triangle far
    behind one of them on the same straight line."""
    ring = [(float(x), 20.0) for x in range(-20, 21)] + [(20.0, float(y)) for y in range(19, -21, -1)]
    ring += [(float(x), -20.0) for x in range(19, -21, -1)] + [(-20.0, float(y)) for y in range(-19, 20)]
    ring = ring[:n]
    points = [(0.0, 0.0), *ring, (40.0, 40.0), (41.0, 40.0), (40.0, 41.0)]
    k = len(ring)
    corner = ring.index((20.0, 20.0)) + 1
    triangles = [(0, (i + 1) % k + 1, i + 1) for i in range(k)]
    return points, [*triangles, (corner, k + 1, k + 3), (corner, k + 2, k + 1)]


def slots_by_ends(links: Links) -> dict[tuple[int, int], int]:
    """Which slot each directed edge has."""
    return {
        (v, int(links.slots[i]) >> 32): i for v in range(len(links.first)) for i in range(links.first[v], links.last[v])
    }


def edges_of(triangles: Sequence[Triangle]) -> set[tuple[int, int]]:
    """Edges, both ways."""
    return {(t[i], t[j]) for t in triangles for i in range(3) for j in range(3) if i != j}


def straight(points: Sequence[Place], triangles: Sequence[Triangle], a: int, b: int) -> list[tuple[int, int]] | None:
    """The steps of the chain: from corner to corner on the closed segment, each along an edge."""
    if a < 0 or b < 0 or points[a] == points[b]:
        return None
    exact, edges = oracles.rationals(points), edges_of(triangles)
    if (a, b) in edges:
        return [(a, b)]
    corners = {v for t in triangles for v in t}
    on = [v for v in corners | {a, b} if oracles.on_segment(exact[v], exact[a], exact[b])]
    on.sort(key=lambda v: oracles.squared_distance(exact[v], exact[a]))
    steps = [*pairwise(on)]
    return steps if all(step in edges for step in steps) else None


def meshes() -> Iterator[tuple[list[Place], list[Triangle]]]:
    yield from (holed_grid(seed) for seed in range(4))
    yield fan(160)


@pytest.mark.obligation(
    "V1", "segments are chains iff fractions find one, and exactly their edges are marked", method="differential"
)
class TestStraightChains:
    """Between all pairs of points, those that are no corner and no point as well: which are chains, and how often each
    edge is part of one; with and without sorted neighbours, in pieces of any size."""

    @pytest.mark.parametrize("bits", [CONSTRAINED, CONSTRAINED | ODD, CONSTRAINED | IN_DOMAIN | ODD])
    @pytest.mark.parametrize("large", [1, 64])
    def test_all_pairs(self, bits: int, large: int, monkeypatch: pytest.MonkeyPatch) -> None:
        for number, (points, triangles) in enumerate(meshes()):
            if large == 1 or number % 2:
                monkeypatch.setattr(chains, "_CHUNK", 7)
            monkeypatch.setattr(spokes, "_LARGE", large)
            mesh, links = linked_mesh(points, triangles)
            near = [v for v, p in enumerate(points) if number < 4 or v == 0 or p[0] == p[1] or v > 158]
            ends = [*product([-1, *near], repeat=2)]
            marks = (np.arange(len(links.slots)) % 8).astype(np.uint8)
            expected, slots = marks.tolist(), slots_by_ends(links)
            found = chains.chained(mesh, links, np.array(ends, dtype=np.intp), marks, bits)
            paths = [straight(points, triangles, a, b) for a, b in ends]
            assert found.tolist() == [path is not None for path in paths]
            for v, w in (step for path in paths for step in path or ()):
                low, high = sorted((v, w))
                slot = slots.get((low, high), slots.get((high, low), -1))
                expected[slot] = (expected[slot] | (bits & ~ODD)) ^ (bits & ODD)
            assert marks.tolist() == expected

    def test_edges(self) -> None:
        """The slot of an edge is that from the smaller index where it has one; no other pair has any."""
        for points, triangles in meshes():
            _, links = linked_mesh(points, triangles)
            slots = slots_by_ends(links)
            for v, w in product(range(min(len(points), 40)), repeat=2):
                low, high = sorted((v, w))
                assert chains.edge_slot(links, v, w) == slots.get((low, high), slots.get((high, low), -1))

    @pytest.mark.parametrize("large", [1, 64])
    def test_an_edge_is_a_chain(self, large: int, monkeypatch: pytest.MonkeyPatch) -> None:
        """Whatever else lies on it: triangles over each other, with corners in the middle of edges."""
        monkeypatch.setattr(spokes, "_LARGE", large)
        points = [(0.0, 0.0), (4.0, 0.0), (0.0, 4.0), (2.0, 0.0), (0.0, 2.0), (2.0, 2.0)]
        for order in permutations([(0, 1, 2), (0, 3, 4), (3, 5, 4)]):
            mesh, links = linked_mesh(points, order)
            for v, w in edges_of(order):
                marks = np.zeros(len(links.slots), dtype=np.uint8)
                assert chains.chained(mesh, links, np.array([(v, w)], dtype=np.intp), marks, ODD).all()
                assert np.flatnonzero(marks).tolist() == [chains.edge_slot(links, v, w)]

    def test_no_length(self) -> None:
        """A segment from a point to itself, or to another point at its position, is no chain, even where triangles
        without area have it for an edge."""
        points = [(0.0, 0.0), (0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]
        mesh, links = linked_mesh(points, [(0, 2, 3), (0, 1, 2)])
        marks = np.zeros(len(links.slots), dtype=np.uint8)
        ends = [(0, 1), (1, 0), (0, 0), (1, 1), (2, 2)]
        assert not chains.chained(mesh, links, np.array(ends, dtype=np.intp), marks, CONSTRAINED).any()
        assert not marks.any()

    def test_no_segments(self) -> None:
        mesh, links = linked_mesh(*holed_grid(0))
        marks = np.zeros(len(links.slots), dtype=np.uint8)
        assert chains.chained(mesh, links, np.empty((0, 2), dtype=np.intp), marks, 7).tolist() == []

    def test_bits(self) -> None:
        """What is known about an edge is told apart."""
        assert sorted((CONSTRAINED, IN_DOMAIN, ODD)) == [1, 2, 4]

    def test_control_a_gap(self) -> None:
        """An edge taken away from a chain of four: no chain, and no mark at the others."""
        points = [(float(x), 0.0) for x in range(5)] + [(2.0, 5.0), (2.0, -5.0)]
        whole: list[Triangle] = [(i, i + 1, 5) for i in range(4)]
        for gap in range(5):
            mesh, links = linked_mesh(points, [t for i, t in enumerate(whole) if i != gap])
            marks = np.zeros(len(links.slots), dtype=np.uint8)
            found = chains.chained(mesh, links, np.array([(0, 4), (4, 0)], dtype=np.intp), marks, CONSTRAINED)
            assert found.tolist() == [gap == 4] * 2
            assert np.count_nonzero(marks) == (4 if gap == 4 else 0)


def around(points: Sequence[Place], v: int, w: int) -> tuple[int, float]:
    """The direction of w from v: to the right first, upwards included, from below to above, then back; a grid of
    five has no two slopes that doubles confuse."""
    dx, dy = points[w][0] - points[v][0], points[w][1] - points[v][1]
    slope = dy / dx if dx else float("inf")
    return (0 if (dx, dy) > (0, 0) else 1), slope


SQUARE = [(float(x), float(y)) for x in range(-2, 3) for y in range(-2, 3)]


@pytest.mark.obligation(
    "V1", "neighbours are sorted by direction, then distance", method="enumeration", control_in="mutants"
)
class TestSpokes:
    """All directions of a grid of five by five: their order, and the first neighbour in each."""

    def test_order(self) -> None:
        points = np.array(SQUARE)
        k, centre = make_context(points), SQUARE.index((0.0, 0.0))
        others = [v for v in range(len(SQUARE)) if v != centre]

        def key(w: int) -> tuple[int, float, float]:
            return (*around(SQUARE, centre, w), abs(SQUARE[w][0]) + abs(SQUARE[w][1]))

        for a, b in product(others, repeat=2):
            one, other = key(a), key(b)
            assert spokes.precedes(k, points, centre, a, b) == (one[:2] > other[:2]) - (one[:2] < other[:2])
            assert spokes.comes_first(k, points, centre, a, b) == (one < other)

    def test_between(self) -> None:
        points = np.array(SQUARE)
        for v, w, b in product(range(0, len(SQUARE), 2), range(len(SQUARE)), range(0, len(SQUARE), 3)):
            low, high = sorted((SQUARE[v], SQUARE[b]))
            assert chains.lies_between(points, v, w, b) == (low < SQUARE[w] < high)

    @pytest.mark.parametrize("large", [1, 3, 5])
    def test_first_in_each_direction(self, large: int, monkeypatch: pytest.MonkeyPatch) -> None:
        """A triangle count of exactly ``large`` is large; other vertices are told by -2."""
        monkeypatch.setattr(spokes, "_LARGE", large)
        for seed in range(4):
            points, triangles = holed_grid(seed)
            mesh, links = linked_mesh(points, triangles)
            sorted_ones = spokes.spokes_of(mesh.context, mesh.coordinates, links)
            edges = edges_of(triangles)
            degrees = [sum(v in t for t in triangles) for v in range(len(points))]
            assert sorted_ones.vertices.tolist() == [v for v, degree in enumerate(degrees) if degree >= large]
            for v, b in product(range(len(points)), repeat=2):
                found = spokes.first_spoke(mesh.context, mesh.coordinates, sorted_ones, v, b) if v != b else -1
                way = [w for w in range(len(points)) if (v, w) in edges and b != v]
                way = [w for w in way if around(points, v, w) == around(points, v, b)]
                near = min(
                    way, key=lambda w: abs(points[w][0] - points[v][0]) + abs(points[w][1] - points[v][1]), default=-1
                )
                assert found == (near if degrees[v] >= large or v == b else -2)

    def test_all_are_there(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Each neighbour occurs once for each triangle that it is in with the vertex, in order."""
        monkeypatch.setattr(spokes, "_LARGE", 1)
        for points, triangles in (holed_grid(5), fan(160), fan(100)):
            mesh, links = linked_mesh(points, triangles)
            found = spokes.spokes_of(mesh.context, mesh.coordinates, links)
            for i, v in enumerate(found.vertices.tolist()):
                ends = found.ends[found.first[i] : found.first[i + 1]].tolist()
                assert sorted(ends) == sorted(w for t in triangles if v in t for w in t if w != v)
                keys = [
                    (*around(points, v, w), abs(points[w][0] - points[v][0]) + abs(points[w][1] - points[v][1]))
                    for w in ends
                ]
                assert keys == sorted(keys)
