"""V1: the boundary as a cycle, points against it, and positions looked up, against going through all there are."""

import sys
from collections.abc import Sequence
from itertools import combinations, permutations, product

import numpy as np
import numpy.typing as npt
import pytest
from proofs_tests import oracles
from proofs_tests.mesh.enumeration import grid

from exactmesh.verify.boundary import (
    Boundary,
    boundary_of,
    convex_cycle,
    is_one_loop,
    lexicographically_before,
    outside_of,
)
from exactmesh.verify.hull import check_distinct, check_hull, check_used, first_at_position
from exactmesh.verify.links import linked
from exactmesh.verify.local import localized
from exactmesh.verify.matching import corners_at, lexicographic_order, match_sorted
from exactmesh.verify.mesh import Mesh, index_quads, index_triples, prepared_mesh
from exactmesh.verify.properties import Kind, Verdict

Cycle = tuple[int, ...]

POINTS = grid(3, 3)


def module(name: str) -> object:
    return sys.modules[f"exactmesh.verify.{name}"]


def mesh_of(points: Sequence[tuple[float, float]], triangles: Sequence[tuple[int, ...]] = ()) -> Mesh:
    array = np.array(points, dtype=np.float64).reshape(-1, 2)
    return prepared_mesh(array, index_triples(triangles), index_quads([]), np.empty((0, 2)))[0]


def chain(cycles: Sequence[Cycle]) -> Boundary:
    """The directed edges of some cycles, by origin; the apex is no matter."""
    edges = sorted((cycle[i - 1], cycle[i]) for cycle in cycles for i in range(len(cycle)))
    origin, target = np.array(edges, dtype=np.intp).reshape(-1, 2).T.copy()
    return Boundary(origin, target, np.zeros_like(origin))


def is_convex(points: Sequence[oracles.RationalPoint], cycle: Cycle) -> bool:
    """Whether all vertices are on the left of each edge, or on it; not all are; and the cycle never turns back."""
    for i in range(len(cycle)):
        u, v, w = points[cycle[i - 2]], points[cycle[i - 1]], points[cycle[i]]
        turns = [oracles.orient(v, w, points[p]) for p in cycle]
        backward = (v[0] - u[0]) * (w[0] - v[0]) + (v[1] - u[1]) * (w[1] - v[1]) < 0
        if min(turns) < 0 or max(turns) == 0 or (backward and oracles.orient(u, v, w) == 0):
            return False
    return True


def cycles_of(n: int, most: int, step: int) -> list[Cycle]:
    """Cycles of vertices of a grid, each from its smallest."""
    found = [(a, *rest) for k in range(2, most) for a, *rest in permutations(range(n), k + 1) if a < min(rest)]
    return found[::step]


CYCLES = cycles_of(9, 4, 7) + [c for c in permutations(range(9), 6) if c[0] < min(c[1:])][::97]
EXACT = oracles.rationals(POINTS)
CONVEX = [cycle for cycle in cycles_of(9, 5, 1) if is_convex(EXACT, cycle)] + [(0, 3, 6, 7, 8, 5, 2, 1)]


@pytest.mark.obligation(
    "V1", "a boundary is called convex, or one loop, just when it is", method="enumeration", control_in="mutants"
)
class TestCycles:
    """Of every cycle of vertices of a small grid, and of some cycles together, convex_cycle tells whether it is one
    convex, counterclockwise cycle, and then which (theorem C); is_one_loop whether it is one. However few steps at a
    time."""

    @pytest.mark.parametrize("size", [1, 2, 3, None])
    def test_convex(self, size: int | None, monkeypatch: pytest.MonkeyPatch) -> None:
        if size is not None:
            monkeypatch.setattr(module("boundary"), "_CHUNK", size)
        mesh = mesh_of(POINTS)
        for cycle in CYCLES[(size or 0) % 5 :: 3] + CONVEX[(size or 0) % 5 :: 4]:
            found = convex_cycle(mesh, chain([cycle]))
            assert (found is not None) is is_convex(EXACT, cycle)
            if found is not None:
                assert found.tolist() == list(cycle)
            assert is_one_loop(chain([cycle]))

    def test_several(self) -> None:
        mesh = mesh_of(POINTS)
        assert convex_cycle(mesh, chain([])) is None
        assert is_one_loop(chain([]))
        apart = [(one, two) for one, two in combinations(CONVEX[:200], 2) if not set(one) & set(two)]
        touching = [(one, two) for one, two in combinations(CONVEX[:60], 2) if len(set(one) & set(two)) == 1]
        assert len(apart) > 50
        assert len(touching) > 50
        for cycles in (*apart[::9], *touching[::9]):
            assert convex_cycle(mesh, chain(cycles)) is None
            assert not is_one_loop(chain(cycles))

    def test_before(self) -> None:
        for points in product(product((0.0, 1.0, -0.0), repeat=2), repeat=2):
            assert lexicographically_before(np.array(points), 0, 1) is (points[0] < points[1])

    def test_boundary_of_triangles(self) -> None:
        """Its edges are those that no triangle has in reverse, with the third corner, by origin."""
        rows = [(0, 3, 1), (3, 4, 1), (4, 7, 5), (1, 4, 5), (6, 7, 4)]
        for k in range(1, 6):
            for triangles in combinations(rows, k):
                mesh = mesh_of(POINTS, triangles)
                links = linked(9, mesh.context, localized(mesh.coordinates, mesh.triangles, mesh.quads))
                found = boundary_of(links)
                sides = {(t[i], t[i - 2]): t[i - 1] for t in triangles for i in range(3)}
                expected = [(*edge, apex) for edge, apex in sides.items() if edge[::-1] not in sides]
                assert sorted(zip(*(part.tolist() for part in found), strict=True)) == sorted(expected)
                assert found.origin.tolist() == sorted(found.origin.tolist())


@pytest.mark.obligation(
    "V1",
    "a point lies outside of a convex cycle just when an edge separates it",
    method="enumeration",
    control_in="mutants",
)
class TestOutside:
    """Of all points of a finer and larger grid, outside_of names those that are strictly on the right of an edge,
    however many vertices lie on the sides, and however few points at a time."""

    @pytest.mark.parametrize("size", [1, 3, None])
    @pytest.mark.parametrize("turned", [0, 1])
    def test_every_point(self, size: int | None, turned: int, monkeypatch: pytest.MonkeyPatch) -> None:
        if size is not None:
            monkeypatch.setattr(module("boundary"), "_CHUNK", size)
        finer = [(x / 2, y / 2) for x, y in product(range(-1, 6), repeat=2)]
        points = [*POINTS, *finer]
        mesh, exact = mesh_of(points), oracles.rationals(points)
        everyone = np.arange(len(points))
        chosen = CONVEX[turned::9] + CONVEX[-1:]
        assert any(len(cycle) > 4 for cycle in chosen)
        for cycle in chosen:
            turn = turned * len(cycle) // 2
            start = np.array(cycle[turn:] + cycle[:turn], dtype=np.intp)
            sides = [(exact[cycle[i - 1]], exact[cycle[i]]) for i in range(len(cycle))]
            expected = [v for v in everyone if any(oracles.orient(a, b, exact[v]) < 0 for a, b in sides)]
            assert outside_of(mesh, start, everyone).tolist() == expected
        assert not len(outside_of(mesh, np.array(CONVEX[0]), everyone[:0]))


Mask = npt.NDArray[np.bool_]


@pytest.mark.obligation(
    "V1", "positions are found where there are any, exactly", method="enumeration", control_in="mutants"
)
class TestPositions:
    """corners_at finds for each wanted position a used point that is there, and none where there is none, in whatever
    order they come; -0.0 is 0.0. lexicographic_order and first_at_position are those of sorting tuples."""

    PLACES = ((0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (-0.0, 0.0))

    def check(self, points: Sequence[tuple[float, float]], used: Sequence[bool], wanted: Sequence[int]) -> None:
        places = [self.PLACES[i] for i in wanted]
        found = corners_at(
            np.array(points).reshape(-1, 2), np.array(used, dtype=np.bool_), np.array(places).reshape(-1, 2)
        ).tolist()
        for place, v in zip(places, found, strict=True):
            there = [i for i, p in enumerate(points) if used[i] and p == place]
            assert v in there or (v == -1 and not there)

    def test_every_short_list(self) -> None:
        for n, k in product(range(4), range(3)):
            for points in product(self.PLACES[:3], repeat=n):
                for wanted in product(range(4), repeat=k):
                    for used in product((True, False), repeat=n):
                        self.check(points, used, wanted)

    def test_the_first(self) -> None:
        """Of several used points at a position that is searched for, the first is found, for all that want it."""
        for n, k in product(range(4), range(4)):
            for points in product(self.PLACES[:2], repeat=n):
                for wanted in product(self.PLACES[:2], repeat=k):
                    for used in product((True, False), repeat=n):
                        found, places = np.full(k, -1), np.array(wanted).reshape(-1, 2)
                        order = lexicographic_order(places)
                        match_sorted(np.array(points).reshape(-1, 2), np.array(used, np.bool_), places, order, found)
                        there = [[i for i, q in enumerate(points) if used[i] and q == p] for p in wanted]
                        assert found.tolist() == [min(those, default=-1) for those in there]

    def test_one_to_one(self) -> None:
        """Different wanted positions get the first used point there; of the points themselves each gets itself."""
        for n in range(4):
            for points in product(self.PLACES[:3], repeat=n):
                array, everyone = np.array(points).reshape(-1, 2), np.ones(n, dtype=np.bool_)
                assert corners_at(array, everyone, array).tolist() == list(range(n))
                for wanted in permutations(self.PLACES[:3]):
                    found = corners_at(array, everyone, np.array(wanted)).tolist()
                    assert found == [points.index(p) if p in points else -1 for p in wanted]

    def test_longer_lists(self) -> None:
        random = np.random.default_rng(0)
        for _ in range(200):
            n, k = random.integers(0, 9, 2)
            points = [self.PLACES[i] for i in random.integers(0, 4, n)]
            self.check(points, (random.random(n) < 0.8).tolist(), random.integers(0, 4, k).tolist())
            array = np.array(points).reshape(-1, 2)
            assert lexicographic_order(array).tolist() == sorted(range(n), key=lambda i: (points[i], i))
            assert first_at_position(array).tolist() == [points.index(p) for p in points]

    def test_distinct(self) -> None:
        """DISTINCT_POINTS names each point that an earlier one equals, and the first of these."""
        for points in product(self.PLACES[:3], repeat=4):
            array = np.array(points)
            finding = check_distinct(array, first_at_position(array))
            pairs = [(points.index(p), i) for i, p in enumerate(points) if points.index(p) != i]
            assert (finding.verdict is Verdict.HOLDS) is (not pairs)
            assert [v.vertices for v in finding.violations] == pairs
            for (first, v), violation in zip(pairs, finding.violations, strict=True):
                x, y = points[v]
                assert violation.message == f"point {v} ({x}, {y}) has the position of point {first}"
                assert violation.kind is Kind.COINCIDENT_POINTS

    def test_used(self) -> None:
        mesh = mesh_of(POINTS, [(0, 3, 1)])
        for unused in ([], [2], [2, 4, 8]):
            finding = check_used(mesh, np.array(unused, dtype=np.intp))
            assert [v.vertices for v in finding.violations] == [(v,) for v in unused]
            assert [v.message for v in finding.violations] == [
                f"point {v} ({float(POINTS[v][0])}, {float(POINTS[v][1])}) is no corner of any triangle" for v in unused
            ]

    def test_the_hull_of_nothing(self) -> None:
        """Without triangles the hull is covered just when all points lie on a line; else three that do not are named,
        the first and the last of them all by their coordinates."""
        for points in product((*self.PLACES[:3], (1.0, 1.0), (2.0, 0.0)), repeat=3):
            exact = oracles.rationals(points)
            finding = check_hull(mesh_of(points), chain([]), None, np.arange(3))
            turn = oracles.orient(exact[0], exact[1], exact[2])
            assert (finding.verdict is Verdict.HOLDS) is (turn == 0)
            if turn:
                (violation,) = finding.violations
                order = sorted(range(3), key=lambda i: exact[i])
                assert violation.vertices == (order[0], order[2], order[1])
                assert (violation.kind, finding.count, finding.lower_bound) == (Kind.NOT_COVERED, 1, True)
        assert check_hull(mesh_of([]), chain([]), None, np.arange(0)).verdict is Verdict.HOLDS
