"""M2, M3: Lawson's algorithm between two looks at Ctrl-C: what waits on the stack, and what is done."""

import sys
from itertools import islice

import numpy as np
import numpy.typing as npt
import pytest
from proofs_tests.mesh.enumeration import COUNTS, Triangulation, canonical_triangles, grid, triangulations

from exactkernel.context import Context, scaled_into_window
from exactmesh import (
    PSLG,
    InadmissibleError,
    QuadEdge,
    TooFewPointsError,
    constrained_delaunay,
    delaunay,
    flip,
    is_flippable,
    is_locally_delaunay,
    lawson,
)
from exactmesh.connectivity import neighbors_of, rings_of
from exactmesh.edgealgebra import EdgeArray
from exactmesh.extract import OUTER, triangles_of
from exactmesh.ids import OUTSIDE
from exactmesh.lawson import flip_until_delaunay


class Under:
    """A triangulation under work by ``flip_until_delaunay``, and the flips so far."""

    def __init__(self, points: list[tuple[int, int]], start: Triangulation, fixed: set[frozenset[int]]) -> None:
        corners = np.array(start, dtype=np.int32)
        self.points = points
        self.ring, self.org, self.face = rings_of(corners, neighbors_of(corners))
        self.xy, self.k = scaled_into_window(np.array(points, dtype=np.float64))
        edges = len(self.org) // 2
        self.hull = (self.face.reshape(-1, 2) == OUTSIDE).any(axis=1)
        ends = [frozenset(row) for row in self.org.reshape(-1, 2).tolist()]
        self.fixed: npt.NDArray[np.bool_] = self.hull | np.array([pair in fixed for pair in ends])
        self.stack, self.waiting = np.arange(edges, dtype=np.int32), np.ones(edges, dtype=np.bool_)
        self.height, self.flips = edges, 0

    def go_on(self, limit: int) -> None:
        arrays: tuple[Context, npt.NDArray[np.float64], EdgeArray, EdgeArray] = self.k, self.xy, self.ring, self.org
        self.height, more = flip_until_delaunay(*arrays, self.fixed, self.stack, self.waiting, self.height, limit)
        self.flips += more

    def state(self) -> object:
        stack = self.stack[: self.height]
        return [a.tolist() for a in (self.ring, self.org, self.waiting, stack)], self.height, self.flips

    def rows(self) -> Triangulation:
        slot = np.where((self.face == OUTSIDE).reshape(-1, 2)[:, ::-1].ravel(), OUTER, -1).astype(np.int32)
        names = np.arange(len(self.points), dtype=np.int32)
        return canonical_triangles(triangles_of(self.ring.copy(), self.org, slot, names)[0].tolist())

    def is_sound(self) -> bool:
        """Whether each edge that waits is on the stack once, and each that does not is locally Delaunay, or fixed."""
        waiting = sorted(self.stack[: self.height].tolist())
        if waiting != np.flatnonzero(self.waiting).tolist():
            return False
        surface = QuadEdge.from_triangles(self.rows())
        bad = {frozenset((e.org, e.dest)) for e in surface.edges() if not is_locally_delaunay(self.points, e)}
        done = np.flatnonzero(~self.waiting & ~self.fixed).tolist()
        return not bad & {frozenset(self.org[2 * i : 2 * i + 2].tolist()) for i in done}


POINTS = {name: COUNTS[name][0] for name in ("convex hexagon", "cocircular octagon", "3 x 3 grid")}


def some_edges(start: Triangulation) -> set[frozenset[int]]:
    """Every third edge of a triangulation."""
    edges = sorted({tuple(sorted(pair)) for t in start for pair in (t[:2], t[1:], t[::2])})
    return {frozenset(pair) for pair in edges[::3]}


@pytest.mark.obligation("M3", "an edge that does not wait is locally Delaunay, at any moment", method="enumeration")
@pytest.mark.parametrize("name", POINTS)
class TestTheStack:
    """After each test of an edge, with and without fixed ones, the edges that wait are on the stack once each, and all
    others are locally Delaunay or fixed; k tests in one call do what k calls do; with patience nothing waits."""

    def test_every_moment(self, name: str) -> None:
        for number, start in enumerate(islice(triangulations(POINTS[name]), 0, None, 9)):
            under = Under(POINTS[name], start, some_edges(start) if number % 2 else set())
            under.go_on(0)
            assert under.height == len(under.fixed)
            steps = 0
            while under.height:
                before = under.height
                under.go_on(1)
                steps += 1
                assert under.is_sound()
                assert before - 1 <= under.height <= before + 3
            for limit in (4, steps - 1, steps, 10**6):
                other = Under(POINTS[name], start, some_edges(start) if number % 2 else set())
                while other.height:
                    other.go_on(limit)
                    assert other.height == 0 or limit < steps
                assert other.state() == under.state()

    def test_calls_add_up(self, name: str) -> None:
        start = max(islice(triangulations(POINTS[name]), 40), key=lambda t: Under(POINTS[name], t, set()).rows())
        one = Under(POINTS[name], start, some_edges(start))
        for k in range(12):
            other = Under(POINTS[name], start, some_edges(start))
            other.go_on(k)
            assert other.state() == one.state()
            one.go_on(1)

    def test_control_an_edge_forgotten(self, name: str) -> None:
        """An edge that is not locally Delaunay is taken from the stack without a test; or it is on the stack twice."""
        starts = [t for t in triangulations(POINTS[name]) if lawson(POINTS[name], t).work.flips]
        under = Under(POINTS[name], starts[0], set())
        found = []
        for i in np.flatnonzero(~under.hull).tolist():
            under = Under(POINTS[name], starts[0], set())
            assert under.is_sound()
            under.stack = np.delete(under.stack, i)
            under.height -= 1
            assert not under.is_sound()  # it says that it waits
            under.waiting[i] = False
            found.append(not under.is_sound())
        assert any(found)

    def test_one_edge_at_a_time(self, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
        """However small the pieces of work are, the end is the Delaunay triangulation."""
        monkeypatch.setattr(sys.modules["exactmesh.lawson"], "_CHUNK", 1)
        expected = delaunay(POINTS[name]).canonical()
        for start in islice(triangulations(POINTS[name]), 0, None, 7):
            assert lawson(POINTS[name], start).canonical() == expected


@pytest.mark.obligation(
    "M3", "lawson hands over what constrained_delaunay does", method="differential", control_in="mutants"
)
class TestTheResult:
    """With segments, every attribute is what constrained_delaunay(carve=False) has: no regions, no holes."""

    @pytest.mark.parametrize("points", [grid(3, 3), [(0, 0), (4, 0), (5, 3), (0, 1)]], ids=["grid", "square"])
    def test_every_attribute(self, points: list[tuple[int, int]]) -> None:
        for segments in ([], [(0, 2)], [(2, 0), (1, 0)]):
            there = constrained_delaunay(PSLG(points, segments), carve=False)
            ours, there = lawson(points, there.triangles, segments=segments).canonical(), there.canonical()
            assert ours == there
            names = (
                "points triangles neighbors representative segments segment_incidence segment_markers holes "
                "vertex_markers vertex_attributes triangle_attributes triangle_regions"
            )
            for name in names.split():
                one, other = getattr(ours, name), getattr(there, name)
                assert (one.shape, one.tolist()) == (other.shape, other.tolist()), name
                assert one.dtype == other.dtype, name

    def test_three_points_are_enough(self) -> None:
        assert lawson([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)]).triangles.tolist() == [[1, 2, 0]]
        for n in range(3):
            with pytest.raises(TooFewPointsError, match=f"^{n} points span no triangle; at least 3 are needed$"):
                lawson(np.arange(2.0 * n).reshape(n, 2), np.empty((0, 3), dtype=np.int32))

    @pytest.mark.parametrize(("missing", "more"), [(1, ""), (2, ", nor are 1 more"), (3, ", nor are 2 more")])
    def test_segments_that_are_no_chains_are_counted(self, missing: int, more: str) -> None:
        points = [(0, 0), (4, 0), (4, 4), (0, 4), (1, 2), (3, 2)]
        start = delaunay(points).triangles
        segments = [(0, 1), (1, 3), (0, 4), (0, 2), (2, 5), (0, 5)]
        edges = {frozenset(pair) for t in start.tolist() for pair in (t[:2], t[1:], t[::2])}
        assert [frozenset(pair) in edges for pair in segments] == [True, False, True, False, True, False]
        bad = [1, 3, 5][:missing]
        given = [s for i, s in enumerate(segments) if i not in {1, 3, 5} - set(bad)]
        at = [given.index(segments[i]) for i in bad]
        with pytest.raises(InadmissibleError) as refused:
            lawson(points, start, segments=given)
        named = segments[bad[0]]
        assert str(refused.value) == f"segment {at[0]} {named} is no chain of edges of the triangles{more}"
        assert refused.value.indices == tuple(at)

    @pytest.mark.parametrize("exponent", [-1060, -300, 0, 300, 1020])
    @pytest.mark.parametrize("spread", [0, 200, 900])
    def test_no_overflow_is_told(self, exponent: int, spread: int) -> None:
        """Coordinates of any size, near to each other or not, whatever numpy was told to do about an overflow."""
        random = np.random.default_rng(1)
        points = (random.random((9, 2)) + 0.5) * np.ldexp(1.0, exponent)
        points *= np.ldexp(1.0, -np.sign(exponent or 1) * random.integers(0, spread + 1, (9, 2)))
        mesh = delaunay(points)
        surface = mesh.quad_edge()
        for index in [edge.index for edge in surface.edges()]:
            if is_flippable(points, surface.edge(index)):
                flip(points, surface.edge(index))
        with np.errstate(over="raise", invalid="raise"):
            again = lawson(points, surface.triangles())
        assert again.canonical() == mesh.canonical()
        assert again.work.flips > 0
