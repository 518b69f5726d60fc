"""A machine that edits a triangulation at random and compares every step with a plain model of it."""

import pickle
from collections.abc import Sequence
from copy import deepcopy
from itertools import pairwise
from typing import ClassVar, cast

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule
from proofs_tests import oracles
from proofs_tests.mesh import oracle as mesh_oracle
from proofs_tests.mesh.enumeration import CIRCLE_OF_EIGHT
from proofs_tests.oracles import RationalPoint

from exactkernel.types import PointLike
from exactmesh import (
    PSLG,
    CollinearPointsError,
    ConstrainedVertexError,
    CrossingError,
    ExactMeshError,
    QuadEdge,
    TooFewPointsError,
    TopologyError,
    Triangulation,
    TriangulationBuilder,
    constrained_delaunay,
    verify,
)
from exactmesh.editing.draft import EDGES

__all__ = ["Editing", "apexes_of", "crossing_point", "is_constrained_delaunay"]

Segment = tuple[int, int]
BAD_POINTS: list[object] = [(float("nan"), 0.0), (0.0, float("inf")), ("1", "2"), None, (1, 2, 3), (2**60 + 1, 0)]


def crossing_point(a: RationalPoint, b: RationalPoint, c: RationalPoint, d: RationalPoint) -> RationalPoint | None:
    """Return the point inside both ab and cd where they cross, if they do."""
    if oracles.orient(a, b, c) * oracles.orient(a, b, d) >= 0 or oracles.orient(c, d, a) * oracles.orient(c, d, b) >= 0:
        return None
    t = oracles.orient(c, d, a) / (oracles.orient(c, d, a) - oracles.orient(c, d, b))
    return a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])


def apexes_of(mesh: Triangulation) -> dict[frozenset[int], list[int]]:
    """Return the third corners of the triangles at each edge."""
    found: dict[frozenset[int], list[int]] = {}
    for row in mesh.triangles.tolist():
        for i in range(3):
            found.setdefault(frozenset((row[i], row[(i + 1) % 3])), []).append(row[(i + 2) % 3])
    return found


def bounds_the_hull(points: Sequence[RationalPoint], triangles: Sequence[oracles.Triangle]) -> bool:
    """Tell whether the edges without a triangle on their right have all points on their left, and form one ring."""
    directed = {edge for a, b, c in triangles for edge in ((a, b), (b, c), (c, a))}
    border = dict(edge for edge in directed if edge[::-1] not in directed)
    at = next(iter(border))
    seen: set[int] = set()
    while at not in seen:
        seen.add(at)
        at = border.get(at, at)
    return len(seen) == len(border) and all(
        oracles.orient(points[u], points[v], p) >= 0 for u, v in border.items() for p in points
    )


def is_constrained_delaunay(mesh: Triangulation) -> bool:
    """Tell by theorems A and E, in fractions: triangles counterclockwise, edges matched, their boundary that of the
    hull, and each edge fixed or locally (perturbed) Delaunay."""
    points = oracles.rationals(mesh.points.tolist())
    triangles = [(a, b, c) for a, b, c in mesh.triangles.tolist()]
    areas = [oracles.orient(*(points[v] for v in t)) for t in triangles]
    if min(areas) <= 0 or not oracles.is_edge_manifold(triangles) or not bounds_the_hull(points, triangles):
        return False
    fixed = {frozenset(edge) for edge in mesh.segments.tolist()}
    for edge, apexes in apexes_of(mesh).items():
        if edge not in fixed and len(apexes) == 2:
            a, b = edge
            c, d = apexes
            ccw = oracles.counterclockwise(points, (a, b, c))
            if not mesh_oracle.is_perturbed_empty(points, ccw, [d]):
                return False
    return set(np.unique(mesh.triangles).tolist()) == set(range(len(points)))


small = st.integers(0, 4).map(float)


class Editing(RuleBasedStateMachine):
    """The builder against two plain things: a dictionary of points, a list of segments."""

    Builder: ClassVar[type[TriangulationBuilder]] = TriangulationBuilder

    @initialize(points=st.lists(st.tuples(small, small), max_size=6))
    def begin(self, points: list[tuple[float, float]]) -> None:
        self.builder = self.Builder(points)
        self.points = {points.index(p): p for p in points}
        self.names = [points.index(p) for p in points]  # the vertex that each number stands for
        self.segments: list[Segment] = []

    @property
    def given(self) -> int:
        """How many numbers were given."""
        return len(self.names)

    def _insert(self, x: float, y: float) -> None:
        there = [v for v, p in self.points.items() if p == (x, y)]
        v = self.builder.insert_point(x, y)
        assert v == (there[0] if there else self.given)
        if not there:
            self.points[v] = (x, y)
            self.names.append(v)

    @rule(x=small, y=small)
    def insert_on_grid(self, x: float, y: float) -> None:
        self._insert(x, y)

    @rule(p=st.sampled_from(CIRCLE_OF_EIGHT))
    def insert_on_circle(self, p: tuple[int, int]) -> None:
        self._insert(float(p[0]), float(p[1]))

    @rule(x=small, exponent=st.integers(-1070, 1020), y=small)
    def insert_far(self, x: float, exponent: int, y: float) -> None:
        self._insert((x + 1) * 2.0**exponent, y)

    @rule(data=st.data(), step=st.sampled_from([-1.0, 0.5, 2.0]))
    @precondition(lambda self: len(self.points) > 1)
    def insert_on_a_line(self, data: st.DataObject, step: float) -> None:
        (ax, ay), (bx, by) = (self.points[data.draw(st.sampled_from(sorted(self.points)))] for _ in range(2))
        self._insert(ax + step * (bx - ax), ay + step * (by - ay))

    @rule(points=st.lists(st.tuples(small, small), max_size=8))
    def insert_many(self, points: list[tuple[float, float]]) -> None:
        vertices = self.builder.insert_points(points).tolist()
        for v, p in zip(vertices, points, strict=True):
            there = [u for u, q in self.points.items() if q == p]
            assert v == (there[0] if there else self.given + points.index(p))
            self.points[v] = p
        self.names += vertices

    @rule(data=st.data())
    @precondition(lambda self: len(self.points) > 1)
    def insert_segment(self, data: st.DataObject) -> None:
        u, v = data.draw(st.permutations(sorted(self.points)))[:2]
        exact = dict(zip(self.points, oracles.rationals(self.points.values()), strict=True))
        places = set(exact.values())
        expected = []
        for s, (a, b) in enumerate(self.segments):
            x = crossing_point(exact[a], exact[b], exact[u], exact[v])
            if x is not None and x not in places:
                expected.append([s, len(self.segments)])
        if expected:
            with pytest.raises(CrossingError) as crossing:
                self.builder.insert_segment(u, v)
            assert crossing.value.pairs.tolist() == expected
            return
        number = self.builder.insert_segment(u, v)
        same = [s for s, ends in enumerate(self.segments) if set(ends) == {u, v}]
        assert number == (same[0] if same else len(self.segments))
        if not same:
            self.segments.append((u, v))

    @rule(data=st.data())
    @precondition(lambda self: self.points)
    def delete(self, data: st.DataObject) -> None:
        v = data.draw(st.sampled_from(sorted(self.points)))
        exact = dict(zip(self.points, oracles.rationals(self.points.values()), strict=True))
        expected = [s for s, (a, b) in enumerate(self.segments) if oracles.on_segment(exact[v], exact[a], exact[b])]
        if expected:
            with pytest.raises(ConstrainedVertexError) as constrained:
                self.builder.delete_vertex(v)
            assert list(constrained.value.indices) == expected
            return
        self.builder.delete_vertex(v)
        del self.points[v]

    @rule(data=st.data(), point=st.tuples(small, small), bad=st.sampled_from(BAD_POINTS))
    def refuse_points(self, data: st.DataObject, point: tuple[float, float], bad: object) -> None:
        """What is no point raises, and of many points none is inserted."""
        with pytest.raises(ExactMeshError):
            self.builder.insert_point(cast("PointLike", bad))
        rows = data.draw(st.permutations([point, bad]))
        with pytest.raises(ExactMeshError):
            self.builder.insert_points(cast("npt.ArrayLike", rows))

    @rule(data=st.data(), bad=st.sampled_from([-1, 10**30, 1.0, "0", None]))
    def refuse_vertices(self, data: st.DataObject, bad: object) -> None:
        """What is no vertex, or is none any more, raises; so does a segment from a vertex to itself."""
        deleted = [number for number, v in enumerate(self.names) if v not in self.points]
        wrong = cast("int", data.draw(st.sampled_from([bad, self.given, *deleted])))
        calls: list[tuple[int, ...]] = [(wrong,), (wrong, wrong)]
        for v in self.points:
            calls += [(v, v), (v, wrong), (wrong, v)]
        for call in calls:
            with pytest.raises(TopologyError):
                (self.builder.delete_vertex if len(call) == 1 else self.builder.insert_segment)(*call)

    @rule(data=st.data())
    def copy(self, data: st.DataObject) -> None:
        """A copy is equal, and what is done to it leaves the first alone."""
        first = self.builder
        before = (first.vertices.tolist(), first.segments.tolist())
        self.builder = data.draw(st.sampled_from((deepcopy, lambda b: pickle.loads(pickle.dumps(b)))))(first)
        self._insert(-1.0, -2.0)
        assert (first.vertices.tolist(), first.segments.tolist()) == before

    @rule()
    def thaw(self) -> None:
        """Go on from what was frozen."""
        try:
            frozen = self.builder.triangulation()
        except (TooFewPointsError, CollinearPointsError):
            return
        assert frozen.pslg is not None
        self.builder = self.Builder.from_pslg(frozen.pslg)
        name = {v: i for i, v in enumerate(sorted(self.points))}
        self.points = {name[v]: p for v, p in self.points.items()}
        self.segments = [(name[a], name[b]) for a, b in self.segments]
        self.names = list(range(len(self.points)))

    def model(self) -> PSLG:
        name = {v: i for i, v in enumerate(sorted(self.points))}
        points = [self.points[v] for v in sorted(self.points)]
        return PSLG(points, [(name[a], name[b]) for a, b in self.segments])

    @invariant()
    def is_the_same(self) -> None:
        """THE constrained Delaunay triangulation of the model, named as the model has it; and the verifier agrees."""
        if not hasattr(self, "points"):
            return
        assert self.builder.vertices.tolist() == sorted(self.points)
        assert len(self.builder) == len(self.points)
        assert self.builder.segments.tolist() == [[a, b] for a, b in self.segments]
        try:
            expected = constrained_delaunay(self.model(), carve=False)
        except (TooFewPointsError, CollinearPointsError) as error:
            with pytest.raises(type(error)):
                self.builder.triangulation()
            return
        mesh = self.builder.triangulation()
        assert mesh.canonical() == expected.canonical()
        assert mesh.points.tolist() == expected.points.tolist()
        assert mesh.segment_incidence.tolist() == expected.segment_incidence.tolist()
        standing = {v: i for i, v in enumerate(sorted(self.points))}
        assert mesh.representative.tolist() == [standing.get(v, -1) for v in self.names]
        assert verify(mesh.points, mesh.triangles, segments=[(standing[a], standing[b]) for a, b in self.segments]).ok

    def is_flat(self) -> bool:
        """Tell whether there is no triangle: everything on one line, or nothing there yet."""
        exact = oracles.rationals(getattr(self, "points", {}).values())
        first = next((q for q in exact[1:] if q != exact[0]), None) if exact else None
        return first is None or all(oracles.orient(exact[0], first, p) == 0 for p in exact)

    @invariant()
    def is_so_by_brute_force(self) -> None:
        """Constrained Delaunay in fractions; just the chains of the vertices on the segments are fixed."""
        if self.is_flat():
            return
        mesh = self.builder.triangulation()
        assert is_constrained_delaunay(mesh)
        exact = oracles.rationals(mesh.points.tolist())
        name = {v: i for i, v in enumerate(sorted(self.points))}
        fixed = set()
        for u, v in self.segments:
            a, b = name[u], name[v]
            on = sorted((p, i) for i, p in enumerate(exact) if oracles.on_segment(p, exact[a], exact[b]))
            fixed |= {frozenset((i, j)) for (_, i), (_, j) in pairwise(on)}
        assert {frozenset(edge) for edge in mesh.segments.tolist()} == fixed
        assert fixed <= set(apexes_of(mesh))

    @invariant()
    def is_a_sphere_of_triangles(self) -> None:
        """Inside, with the ghost vertex: an edge algebra of triangles, V - E + F = 2; spokes leave their vertices."""
        if self.is_flat():
            return
        draft = self.builder._draft
        edges, plane = int(draft.tally[EDGES]), draft.plane
        org = plane.org[: 2 * edges].copy()
        sphere = QuadEdge.from_arrays(plane.ring[: 4 * edges].copy(), org, np.zeros(2 * edges, dtype=np.int32))
        assert sphere.counts() == (len(self.points) + 1, edges, 2 * edges // 3)
        assert sphere.counts()[0] - edges + 2 * edges // 3 == 2
        ends = {v: set[int]() for v in (*self.points, plane.ghost)}
        for edge in sphere.edges():
            for side in (edge, edge.sym):
                assert len([*side.face()]) == 3
                assert {e.org for e in side.orbit()} == {side.org}
                ends[side.org].add(side.index)
        assert all(int(plane.spoke[v]) in ends[v] for v in self.points)
        assert not plane.loose[:edges].any()
