"""M5: editing a constrained Delaunay triangulation step by step ends where building it at once does."""

import copy
import pickle
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, cast

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import settings
from hypothesis.stateful import run_state_machine_as_test
from hypothesis.strategies import DataObject
from proofs_tests import oracles
from proofs_tests.mesh.editing import Editing, is_constrained_delaunay
from proofs_tests.mesh.enumeration import CIRCLE_OF_EIGHT, grid

from exactkernel.jit import COMPILED
from exactkernel.types import PointLike
from exactmesh import (
    PSLG,
    ConstrainedVertexError,
    CrossingError,
    ExactMeshError,
    NonFiniteError,
    ShapeError,
    TopologyError,
    Triangulation,
    TriangulationBuilder,
    constrained_delaunay,
    delaunay,
)
from exactmesh.edgealgebra import dest, left_next, origin, swap
from exactmesh.editing import builder as module
from exactmesh.editing.draft import EDGES, Draft
from exactmesh.editing.walk import INSIDE, ON_EDGE, ON_VERTEX, walk

STEPS = settings(settings(), max_examples=settings().max_examples // (10 if COMPILED else 15), stateful_step_count=25)


def same(builder: TriangulationBuilder) -> bool:
    """Tell whether the builder holds what is built at once from its own vertices and segments."""
    mesh = builder.triangulation()
    assert mesh.pslg is not None
    return mesh.canonical() == constrained_delaunay(mesh.pslg, carve=False).canonical()


@pytest.mark.bounds
@pytest.mark.obligation(
    "M5",
    "every sequence of edits ends in the constrained Delaunay triangulation of what is left",
    method="stateful machine",
)
class TestEditing:
    """After every step, the builder's triangulation is constrained Delaunay by brute force and the one that is built at
    once from the model's points and segments, its inside a sphere of triangles; errors name exactly the segments that
    the model says; illegal calls raise and change nothing."""

    def test_machine(self) -> None:
        run_state_machine_as_test(Editing, settings=STEPS)

    def test_edits_by_hand(self) -> None:
        edit_by_hand()

    @pytest.mark.parametrize("fault", ["unflipped", "unconstrained", "half a segment", "forgotten group"])
    def test_control_a_seeded_fault_is_found(self, fault: str, monkeypatch: pytest.MonkeyPatch) -> None:
        """Edges left unflipped, segments left unconstrained or inserted by half, a group of edits forgotten."""
        name, faulty = FAULTS[fault]
        real = getattr(module, name)
        monkeypatch.setattr(module, name, lambda draft, *rest: faulty(real, draft, *rest))
        with pytest.raises((AssertionError, ExactMeshError, IndexError)):
            edit_by_hand()


class Chosen(DataObject):
    """What the machine draws, in the order in which it asks."""

    def __init__(self, *values: object) -> None:
        self.values = iter(values)

    def draw(self, strategy: object, label: object = None) -> Any:
        return next(self.values)


def edit_by_hand() -> None:
    """Segments that overlap and pass vertices, one that is split, vertices that go: the machine checks each step."""
    machine = Editing()
    steps: list[Callable[[], object]] = [
        lambda: machine.begin(points=[(float(x), float(y)) for y in range(4) for x in range(4)]),
        lambda: machine.insert_segment(data=Chosen([0, 3])),
        lambda: machine.insert_segment(data=Chosen([1, 2])),
        lambda: machine.insert_segment(data=Chosen([4, 14])),
        lambda: machine.insert_on_grid(x=1.5, y=0.0),
        lambda: machine.delete(data=Chosen(6)),
        lambda: machine.delete(data=Chosen(10)),
        lambda: machine.thaw(),
    ]
    for step in steps:
        step()
        machine.is_the_same()
        machine.is_so_by_brute_force()
        machine.is_a_sphere_of_triangles()


Step = Callable[..., None]


def unflipped(real: Step, draft: Draft, v: int) -> None:
    """Delete, but leave the last flip out: that is, turn some free edge back."""
    real(draft, v)
    plane = draft.plane
    xy = oracles.rationals(plane.xy.reshape(-1, 2).tolist())
    for e in range(0, 4 * int(draft.tally[EDGES]), 4):
        corners = [origin(plane.org, e), dest(plane.org, left_next(plane.ring, e ^ 2)), dest(plane.org, e)]
        corners.append(dest(plane.org, left_next(plane.ring, e)))
        if plane.ghost not in corners and not plane.fixed[e >> 2]:
            a, b, c, d = (xy[v] for v in corners)
            if oracles.orient(a, b, d) > 0 and oracles.orient(b, c, d) > 0:
                swap(plane.ring, plane.org, e)
                return


def unconstrained(real: Step, draft: Draft, *rest: object) -> None:
    """Insert, but leave one half of a segment that is split free."""
    before = int(draft.plane.fixed.sum())
    real(draft, *rest)
    if int(draft.plane.fixed.sum()) > before:
        draft.plane.fixed[int(draft.tally[EDGES]) - 3] = False


def half_a_segment(real: Step, draft: Draft, order: object, pieces: npt.NDArray[np.int32]) -> None:
    """Insert a segment, but forget to constrain its last edge."""
    real(draft, order, pieces)
    draft.plane.fixed[pieces[-1, 0]] = False


def forgotten_group(real: Step, draft: Draft, *rest: object) -> None:
    """Insert a segment, but where it overlaps with others forget these."""
    before = draft.group.copy()
    real(draft, *rest)
    draft.group[(draft.group[:, 0] >= 0) & (before != draft.group).any(axis=1), 0] = -1


FAULTS: dict[str, tuple[str, Step]] = {
    "unflipped": ("remove_vertex", unflipped),
    "unconstrained": ("insert_vertices", unconstrained),
    "half a segment": ("add_segment", half_a_segment),
    "forgotten group": ("add_segment", forgotten_group),
}


def hubs() -> Iterator[tuple[str, list[tuple[float, float]]]]:
    """Rings of neighbors of the origin; convex, concave, cocircular, with straight sides, and half of one."""
    yield "cocircular octagon", [(float(x), float(y)) for x, y in CIRCLE_OF_EIGHT]
    yield "square with points on its sides", [(float(x), float(y)) for x, y in grid(5, 5) if {x, y} & {0, 4}]
    angles = np.linspace(0, 2 * np.pi, 60 if COMPILED else 20, endpoint=False)
    for name, radius in (("circle", 1.0 + 0 * angles), ("star", 1.0 + 0.3 * np.cos(5 * angles))):
        yield name, list(zip((radius * np.cos(angles)).tolist(), (radius * np.sin(angles)).tolist(), strict=True))
    yield "astroid", list(zip((np.cos(angles) ** 3).tolist(), (np.sin(angles) ** 3).tolist(), strict=True))
    yield "parabola", [(float(i), 1.0 + i * i / 8) for i in range(-12, 13)]


HUBS = dict(hubs())


@pytest.mark.bounds
@pytest.mark.obligation(
    "M5", "deleting vertices, however many neighbors they have, leaves what the others alone have", method="named cases"
)
class TestDeletion:
    """Whatever vertex goes, inside, on the hull or on a straight side of it, the others keep their numbers, and their
    triangulation is theirs alone."""

    @pytest.mark.parametrize("ring", HUBS.values(), ids=HUBS.keys())
    @pytest.mark.parametrize("centre", [(0.0, 0.0), (0.01, 0.02), (2.0, 2.0)])
    def test_hub(self, ring: list[tuple[float, float]], centre: tuple[float, float]) -> None:
        builder = TriangulationBuilder(ring)
        if centre not in ring:
            builder.delete_vertex(builder.insert_point(centre))
        assert builder.triangulation().canonical() == delaunay(ring).canonical()

    @pytest.mark.parametrize("seed", range(3))
    def test_down_to_three(self, seed: int) -> None:
        random = np.random.default_rng(seed)
        points = [(float(x), float(y)) for x, y in grid(5, 5)]
        builder = TriangulationBuilder(points)
        left = list(range(25))
        while len(left) > 3:
            builder.delete_vertex(left.pop(int(random.integers(len(left)))))
            chosen = [points[v] for v in left]
            if len({oracles.orient(*t) for t in [oracles.rationals([chosen[0], chosen[1], p]) for p in chosen]}) > 1:
                assert builder.triangulation().canonical() == delaunay(chosen).canonical()
        assert builder.vertices.tolist() == sorted(left)

    @pytest.mark.parametrize("shape", ["circle", "concave"])
    def test_near_linear(self, shape: str) -> None:
        """Of a hub with four times the neighbors, the deletion takes about four times the predicates."""
        few, many = (predicates_of_deletion(shape, n) for n in ((1000, 4000) if COMPILED else (64, 256)))
        assert many < 6 * few

    def test_control_flips_from_a_fan_are_quadratic(self) -> None:
        """The measure would tell: flips from the worst triangulation of the same hole, a fan."""
        from exactmesh import lawson

        few, many = (400, 1600) if COMPILED else (24, 96)
        work = []
        for n in (few, many):
            points = [(i / n, (i / n) ** 2) for i in range(n)]
            work.append(lawson(points, [(n - 1, i, i + 1) for i in range(n - 2)]).work.flips)
        assert work[1] > 6 * work[0]


def predicates_of_deletion(shape: str, n: int) -> int:
    t = (np.arange(n) + 0.5) / n
    ring = {
        "circle": np.stack([np.cos(2 * np.pi * t), np.sin(2 * np.pi * t)], axis=1),
        "concave": np.stack([t - 0.5, 1 - np.abs(t - 0.5) + 3 * (t - 0.5) ** 2], axis=1),
    }[shape]
    builder = TriangulationBuilder(ring, [(i, i + 1) for i in range(n - 1)])
    hub = builder.insert_point(0.0, 0.0)
    before = builder.triangulation().work
    builder.delete_vertex(hub)
    after = builder.triangulation().work
    assert same(builder)
    return sum(sum(part.values()) for part in (after.orient2d, after.incircle)) - sum(
        sum(part.values()) for part in (before.orient2d, before.incircle)
    )


@pytest.mark.obligation(
    "M5", "the straight walk ends in the triangle of its target, Delaunay or not, hull or not", method="enumeration"
)
class TestStraightWalk:
    """From every vertex, to every point of a fine grid, within the hull and beyond: the closed triangle on the left of
    the edge holds the target, and what is said of edge and vertex is so."""

    SEGMENTS = ((0, 22), (3, 21), (4, 9), (20, 24))

    def test_everywhere(self) -> None:
        points = [(x + 0.25 * ((x + 2 * y) % 3 == 0), float(y)) for x, y in grid(5, 5)]
        builder = TriangulationBuilder(points, self.SEGMENTS[:1])
        p = builder.insert_point(9.0, 9.0)
        builder.delete_vertex(p)
        plane, exact = builder._draft.plane, oracles.rationals(points)
        said = set()
        for x in np.arange(-1, 6, 0.5 if COMPILED else 1.0).tolist():
            for y in np.arange(-1, 6, 0.5 if COMPILED else 1.0).tolist():
                plane.xy[2 * p : 2 * p + 2] = x, y
                for a in range(0, 25, 1 if COMPILED else 5):
                    e, where = walk(plane, a, p)
                    said.add(where)
                    self.check(builder, e, where, exact, oracles.rationals([(x, y)])[0])
        assert said == {INSIDE, ON_EDGE, ON_VERTEX}

    @staticmethod
    def check(
        builder: TriangulationBuilder,
        e: int,
        where: int,
        exact: list[oracles.RationalPoint],
        target: oracles.RationalPoint,
    ) -> None:
        plane = builder._draft.plane
        u, v, w = origin(plane.org, e), dest(plane.org, e), dest(plane.org, left_next(plane.ring, e))
        if where == ON_VERTEX:
            assert exact[u] == target
            return
        side = oracles.orient(exact[u], exact[v], target)
        if where == ON_EDGE:
            assert side == 0
            assert min(exact[u], exact[v]) < target < max(exact[u], exact[v])
            return
        assert side > 0
        if w != plane.ghost:
            assert oracles.orient(exact[v], exact[w], target) > 0 < oracles.orient(exact[w], exact[u], target)

    def test_control_the_triangle_beside_it(self) -> None:
        """A walk that ends on the other side of its last edge."""
        points = [(float(x), float(y)) for x, y in grid(3, 3)]
        builder = TriangulationBuilder(points)
        p = builder.insert_point(9.0, 9.0)
        builder.delete_vertex(p)
        plane, exact = builder._draft.plane, oracles.rationals(points)
        plane.xy[2 * p : 2 * p + 2] = 0.75, 0.5
        e, where = walk(plane, 0, p)
        target = oracles.rationals([(0.75, 0.5)])[0]
        self.check(builder, e, where, exact, target)
        with pytest.raises(AssertionError):
            self.check(builder, e ^ 2, where, exact, target)


@pytest.mark.obligation(
    "M5", "a builder made of a graph or a triangulation holds the same", method="named cases", control_in="TestEditing"
)
class TestMaking:
    """Made of a graph, of a triangulation or by steps in any order, it is the same; and what is frozen stays so."""

    GRAPH = PSLG(
        [*((float(x), float(y)) for x, y in grid(4, 4)), (1.0, 1.0), (0.5, 2.5)],
        [(0, 15), (0, 5), (5, 10), (16, 13), (3, 17), (3, 2)],
        holes=[(2.2, 2.1)],
    )

    def expected(self) -> Triangulation:
        return constrained_delaunay(self.GRAPH, carve=False).canonical()

    def test_from_a_graph(self) -> None:
        mesh = TriangulationBuilder.from_pslg(self.GRAPH).triangulation()
        assert mesh.canonical() == self.expected()
        assert mesh.representative.tolist() == constrained_delaunay(self.GRAPH, carve=False).representative.tolist()

    def test_from_a_triangulation(self) -> None:
        mesh = TriangulationBuilder.from_triangulation(constrained_delaunay(self.GRAPH, carve=False)).triangulation()
        assert mesh.canonical() == self.expected()

    def test_what_was_carved_comes_back(self) -> None:
        ring = PSLG([(0, 0), (4, 0), (4, 4), (2, 1), (0, 4)], [(0, 1), (1, 2), (2, 3), (3, 4), (4, 0)])
        carved = constrained_delaunay(ring)
        whole = TriangulationBuilder.from_triangulation(carved).triangulation()
        assert len(whole.triangles) == len(carved.triangles) + 1
        assert whole.canonical() == constrained_delaunay(ring, carve=False).canonical()

    def test_pieces_of_a_segment(self) -> None:
        """chain and markers of the frozen one are those of the graph."""
        mesh = TriangulationBuilder.from_pslg(self.GRAPH).triangulation()
        assert mesh.points[mesh.chain(0)].tolist() == [[[i, i], [i + 1, i + 1]] for i in range(3)]

    def test_copies_are_independent(self) -> None:
        builder = TriangulationBuilder.from_pslg(self.GRAPH)
        before = builder.triangulation()
        for other in (copy.deepcopy(builder), pickle.loads(pickle.dumps(builder))):
            other.insert_point(0.3, 0.4)
            other.delete_vertex(1)
            assert same(other)
        assert builder.triangulation() == before

    def test_frozen_stays(self) -> None:
        builder = TriangulationBuilder.from_pslg(self.GRAPH)
        mesh = builder.triangulation()
        kept = replace(mesh, triangles=mesh.triangles.copy(), points=mesh.points.copy())
        builder.insert_points(np.random.default_rng(1).random((100, 2)))
        assert mesh == kept
        assert is_constrained_delaunay(mesh)

    @pytest.mark.parametrize("n", [3000 if COMPILED else 150])
    def test_many(self, n: int) -> None:
        """Thousands of steps, a third of them deletions, with a wall of segments in between."""
        random = np.random.default_rng(4)
        builder = TriangulationBuilder([(0.5, 0.0), (0.45, 0.5), (0.5, 1.0)], [(0, 1), (1, 2)])
        inserted = builder.insert_points(random.random((n, 2))).tolist()
        for v in inserted[:: 3 if COMPILED else 2]:
            builder.delete_vertex(v)
        for x, y in random.random((n // 10, 2)).tolist():
            builder.insert_point(x, y)
        assert same(builder)


BAD_POINTS: list[object] = [
    (float("nan"), 0.0),
    (0.0, float("inf")),
    ("1", "2"),
    "ab",
    None,
    3,
    (1, 2, 3),
    (2**60 + 1, 0),
    (1j, 0),
    {},
    np.ma.masked_array([1.0, 2.0], mask=[True, False]),
]
BAD_VERTICES: list[object] = [-1, 9, 10**30, 1.0, "0", None, np.float64(1)]


@pytest.mark.obligation("G1", "what a builder cannot take is named, and changes nothing", method="named cases")
class TestBadInput:
    """What is no point, no vertex, or a crossing raises an error that says so, and the builder is what it was."""

    def builder(self) -> TriangulationBuilder:
        builder = TriangulationBuilder([(0, 0), (4, 0), (4, 4), (0, 4), (1, 2)], [(0, 2)])
        builder.delete_vertex(4)
        return builder

    def unchanged(self, builder: TriangulationBuilder) -> bool:
        other = self.builder()
        return builder.triangulation() == other.triangulation() and builder.insert_point(5, 5) == 5

    @pytest.mark.parametrize("point", BAD_POINTS, ids=repr)
    def test_points(self, point: object) -> None:
        builder = self.builder()
        with pytest.raises(ExactMeshError):
            builder.insert_point(cast("PointLike", point))
        if not isinstance(point, np.ndarray):  # in a list, numpy drops a mask before anybody sees it
            with pytest.raises(ExactMeshError):
                builder.insert_points(cast("npt.ArrayLike", [point]))
        assert self.unchanged(builder)

    @pytest.mark.parametrize("vertex", [*BAD_VERTICES, 4], ids=repr)
    def test_vertices(self, vertex: object) -> None:
        builder = self.builder()
        with pytest.raises(TopologyError, match="deleted" if vertex == 4 else "vert"):
            builder.delete_vertex(cast("int", vertex))
        for u, v in ((cast("int", vertex), 0), (0, cast("int", vertex))):
            with pytest.raises(TopologyError):
                builder.insert_segment(u, v)
        assert self.unchanged(builder)

    def test_segments(self) -> None:
        builder = self.builder()
        with pytest.raises(TopologyError, match="has no length"):
            builder.insert_segment(1, 1)
        with pytest.raises(CrossingError) as crossing:
            builder.insert_segment(1, 3)
        assert crossing.value.pairs.tolist() == [[0, 1]]
        assert "crossings=" not in str(crossing.value)  # which is none of its arguments
        with pytest.raises(ConstrainedVertexError) as constrained:
            builder.delete_vertex(2)
        assert constrained.value.indices == (0,)
        assert self.unchanged(builder)

    def test_from_the_start(self) -> None:
        with pytest.raises(CrossingError) as crossing:
            TriangulationBuilder([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 2), (1, 3)])
        assert crossing.value.pairs.tolist() == [[0, 1]]
        assert "0 and 1 [(0.0, 0.0) to (1.0, 1.0), (1.0, 0.0) to (0.0, 1.0)]" in str(crossing.value)
        with pytest.raises(NonFiniteError):
            TriangulationBuilder([(0, float("nan"))])
        with pytest.raises(ShapeError):
            TriangulationBuilder([(0, 1, 2)])

    def test_control_a_change_would_be_noticed(self) -> None:
        """A point that was inserted."""
        builder = self.builder()
        builder.insert_point(1, 3)
        assert not self.unchanged(builder)


class TestInterrupts:
    """An interrupt at the end of any step leaves a builder that is valid and can be used."""

    @pytest.mark.parametrize("step", ["insert", "many", "segment", "delete", "settle", "dissolve"])
    def test_interrupted(self, step: str, monkeypatch: pytest.MonkeyPatch) -> None:
        builder = TriangulationBuilder([(0, 0), (4, 0), (0, 4), (3, 3), (1, 1)])
        steps: dict[str, Callable[[], object]] = {
            "insert": lambda: builder.insert_point(2, 1),
            "many": lambda: builder.insert_points([(0.5, 0.5), (0.25, 1.0)]),
            "segment": lambda: builder.insert_segment(1, 2),
            "delete": lambda: builder.delete_vertex(3),
            "settle": lambda: flat.insert_point(0, 1),
            "dissolve": lambda: thin.delete_vertex(3),
        }
        flat = TriangulationBuilder([(0, 0), (1, 0), (2, 0)], [(0, 2)])
        thin = TriangulationBuilder([(0, 0), (1, 0), (2, 0), (1, 1)], [(0, 2)])
        with monkeypatch.context() as patch:
            patch.setattr(module, "raise_if_interrupted", interrupt)
            patch.setattr(sys.modules["exactmesh.delaunay"], "raise_if_interrupted", interrupt)
            with pytest.raises(KeyboardInterrupt):
                steps[step]()
        for used in (flat, thin, builder):
            used.insert_point(0, 1)
            assert same(used)


def interrupt() -> None:
    raise KeyboardInterrupt
