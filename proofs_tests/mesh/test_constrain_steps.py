"""M5: what each step of inserting segments promises, against fractions: spokes, edges found, pieces, limits."""

import sys
from collections import Counter
from collections.abc import Sequence
from itertools import pairwise, permutations

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.mesh import constrained_oracle
from proofs_tests.mesh.constrained_oracle import Segment
from proofs_tests.mesh.enumeration import CIRCLE_OF_EIGHT, canonical_triangles, grid

from exactkernel.jit import COMPILED
from exactmesh import PSLG, constrained_delaunay, verify
from exactmesh.delaunay import insert_points
from exactmesh.edgealgebra import dest, origin
from exactmesh.errors import TooManyCrossingsError
from exactmesh.plane import Plane

CONSTRAIN, CAVITY = (sys.modules[f"exactmesh.{name}"] for name in ("constrain", "cavity"))

inlined = pytest.mark.skipif(COMPILED, reason="calls functions that are compiled only as parts of others")

Pair = tuple[float, float]

SETS: dict[str, list[Pair]] = {
    "3 x 3 grid": [*grid(3, 3)],
    "octagon": [*CIRCLE_OF_EIGHT],
    "duplicates": [(0, 0), (2, 0), (0, 0), (1, 3), (2, 0), (1, 1), (1, 1)],
    "fan": [(0, 0), *((4, y) for y in range(-3, 4)), (9, 0)],
}


class Planes:
    """The plane of some points, and what stands where in it."""

    def __init__(self, points: Sequence[Pair]) -> None:
        built = insert_points(np.array(points, dtype=np.float64))
        self.plane: Plane = CONSTRAIN.plane_of(built)
        self.edges, self.n = built.edges, len(points)
        self.exact = [oracles.rationals(points)[i] for i in built.order]
        self.vertices = [v for v in range(self.n) if built.twin[v] == v]

    def neighbors(self, v: int) -> list[int]:
        """The ends of the edges that leave v, the ghost among them."""
        return [dest(self.plane.org, e) for e in range(0, 4 * self.edges, 2) if origin(self.plane.org, e) == v]


@pytest.mark.obligation(
    "M5",
    "an edge between two vertices is found, or which of them has fewer",
    method="enumeration",
    control_in="mutants",
)
@pytest.mark.parametrize("name", SETS)
class TestEdgesAreFound:
    """A spoke leaves every vertex, and none leaves what only lies in the place of one. Between any two vertices the
    search finds their edge, in its direction, and never says then that it swapped; if there is none it says whether
    the second end has fewer edges."""

    def test_spokes(self, name: str) -> None:
        found = Planes(SETS[name])
        for v in range(found.n):
            spoke = int(found.plane.spoke[v])
            if v in found.vertices:
                assert spoke % 2 == 0
                assert origin(found.plane.org, spoke) == v
            else:
                assert spoke == -1

    @inlined
    def test_every_pair(self, name: str) -> None:
        found = Planes(SETS[name])
        seen = set()
        for a, b in permutations(found.vertices, 2):
            e, fewer = CONSTRAIN.find_edge(found.plane, a, b)
            if b in found.neighbors(a):
                assert e % 2 == 0
                assert (origin(found.plane.org, e), dest(found.plane.org, e)) == (a, b)
                assert fewer is False
            else:
                assert e == -1
                assert fewer is (len(found.neighbors(b)) < len(found.neighbors(a)))
            seen.add((e >= 0, fewer))
        assert (True, False) in seen

    @inlined
    def test_one_step(self, name: str) -> None:
        """A step toward b leads to the next vertex on the way, by an edge that is there afterwards; if a fixed edge is
        in the way it leads nowhere."""
        found = Planes(SETS[name])
        for a, b in permutations(found.vertices, 2):
            under = Planes(SETS[name])
            way = [v for v in under.vertices if oracles.on_segment(under.exact[v], under.exact[a], under.exact[b])]
            next_ = sorted(way, key=lambda v: oracles.squared_distance(under.exact[a], under.exact[v]))[1]
            e, w = CONSTRAIN.step(under.plane, a, b)
            assert w == next_
            assert (origin(under.plane.org, e), dest(under.plane.org, e)) == (a, w)
            for fixed in range(found.edges):
                ends = [int(v) for v in found.plane.org[2 * fixed : 2 * fixed + 2]]
                if found.n not in ends and constrained_oracle.crosses(found.exact, (a, next_), ends):
                    under = Planes(SETS[name])
                    under.plane.fixed[fixed] = True
                    assert CONSTRAIN.step(under.plane, a, b) == (-1, -1)
                    break


LINE = [(float(x), 0.0) for x in range(12)]
ALONG: list[Segment] = [(0, 11), (11, 3), (1, 2), (5, 9), (10, 0), (4, 12), (13, 12), (12, 0), (0, 13)]
POINTS = [*LINE, (4.0, 3.0), (4.0, -2.0)]


def expected_pieces(points: Sequence[Pair], segments: Sequence[Segment]) -> Counter[tuple[frozenset[int], int]]:
    exact = oracles.rationals(points)
    chains = [constrained_oracle.chain(exact, segment) for segment in segments]
    return Counter((frozenset(pair), s) for s, chain in enumerate(chains) for pair in pairwise(chain))


@pytest.mark.bounds
@pytest.mark.obligation(
    "M5", "segments are inserted piece by piece, however little room there is", method="enumeration"
)
class TestPieces:
    """With room for however few pieces at a time, and however few segments at a time, the rows (edge, segment) are the
    pieces into which the vertices cut each segment, and their edges are fixed; segments that cross end it."""

    def insert(self, room: int, size: int) -> tuple[Planes, Counter[tuple[frozenset[int], int]]]:
        under = Planes(POINTS)
        number = [under.exact.index(p) for p in oracles.rationals(POINTS)]
        ends = np.array([(number[a], number[b]) for a, b in ALONG], dtype=np.int64)
        order = np.arange(len(ALONG))[::-1].copy()
        pieces, turn, count = np.empty((room, 2), dtype=np.int32), 0, 0
        rows: list[list[int]] = []
        while turn < len(ALONG):
            stop = min(turn + size, len(ALONG))
            before = turn
            turn, count, crossed = CONSTRAIN.constrain_range(under.plane, ends, order, turn, stop, pieces, count)
            assert not crossed
            assert turn == stop or count == len(pieces)
            assert turn > before or count > 0
            rows += pieces[:count].tolist()
            count = 0
        names = {number[i]: i for i in range(len(POINTS))}
        pairs = [(under.plane.org[2 * e : 2 * e + 2].tolist(), s) for e, s in rows]
        assert set(np.flatnonzero(under.plane.fixed).tolist()) == {e for e, _ in rows}
        return under, Counter((frozenset(names[v] for v in pair), s) for pair, s in pairs)

    @pytest.mark.parametrize("room", [1, 2, 3, 7, 100])
    @pytest.mark.parametrize("size", [1, 4, 100])
    def test_any_room(self, room: int, size: int) -> None:
        assert self.insert(room, size)[1] == expected_pieces(POINTS, ALONG)

    @pytest.mark.parametrize("size", [1, 2, 1 << 15])
    def test_all_of_it(self, size: int, monkeypatch: pytest.MonkeyPatch) -> None:
        """More pieces than were expected at first, and segments that overlap."""
        monkeypatch.setattr(CONSTRAIN, "_CHUNK", size)
        mesh = constrained_delaunay(PSLG(POINTS, ALONG), carve=False)
        exact = oracles.rationals(POINTS)
        assert canonical_triangles(mesh.triangles.tolist()) == constrained_oracle.constrained_triangles(exact, ALONG)
        rows = [(frozenset(mesh.segments[row].tolist()), s) for row, s in mesh.segment_incidence.tolist()]
        assert Counter(rows) == expected_pieces(POINTS, ALONG)
        assert len(rows) > len(ALONG) + 16

    def test_control_a_fixed_edge_in_the_way(self) -> None:
        """The same call with a segment that crosses one before it says so, and where."""
        under = Planes([(0, 0), (4, 0), (4, 4), (0, 4)])
        number = [under.exact.index(p) for p in oracles.rationals([(0, 0), (4, 4), (4, 0), (0, 4)])]
        ends = np.array(number, dtype=np.int64).reshape(2, 2)
        for order in (np.array([0, 1]), np.array([1, 0])):
            plane = Planes([(0, 0), (4, 0), (4, 4), (0, 4)]).plane
            pieces = np.empty((9, 2), dtype=np.int32)
            assert CONSTRAIN.constrain_range(plane, ends.copy(), order, 0, 2, pieces, 0) == (1, 1, True)
            assert int(plane.fixed.sum()) == 1


@pytest.mark.obligation(
    "M5",
    "overlaps that do not fit into the memory are refused, and no others",
    method="named cases",
    control_in="mutants",
)
class TestMemory:
    """The rows are doubled as long as twice as many fit into the memory; the error says how many there were, and names
    the segment that was being inserted."""

    @pytest.mark.parametrize("room", [0, 1, 20, 21, 22, 41, 42, 43, 83, 84, 85, 200])
    def test_every_size(self, room: int, monkeypatch: pytest.MonkeyPatch) -> None:
        asked: list[int] = []

        def room_for(bytes_each: int) -> int:
            asked.append(bytes_each)
            return room

        monkeypatch.setattr(CONSTRAIN, "room_for", room_for)
        segments = ALONG[:5]
        total = sum(expected_pieces(POINTS, segments).values())
        sizes = [size for size in ((len(segments) + 16) * 2**k for k in range(9)) if size < total]
        assert sizes
        if all(2 * size <= room for size in sizes):
            constrained_delaunay(PSLG(POINTS, segments), carve=False)
        else:
            count = next(size for size in sizes if 2 * size > room)
            with pytest.raises(TooManyCrossingsError, match=f"^the segments have more than {count} pieces,") as refused:
                constrained_delaunay(PSLG(POINTS, segments), carve=False)
            (segment,) = refused.value.indices
            assert 0 <= segment < len(segments)
            assert sum(n for (_, s), n in expected_pieces(POINTS, segments).items() if s == segment) > 1
        assert set(asked) == {CONSTRAIN._BYTES_PER_PIECE}
        assert 3 * np.empty((1, 2), dtype=np.int64).nbytes <= CONSTRAIN._BYTES_PER_PIECE  # two sorted copies, at least

    def test_the_segment_is_named(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Of many short segments and one long one, the long one is to blame."""
        monkeypatch.setattr(CONSTRAIN, "room_for", lambda _: 0)
        points = [*((float(x), 0.0) for x in range(30)), (3.0, 9.0), (4.0, 9.0)]
        for long in range(3):
            segments = [(30, 31), (30, 0)]
            segments.insert(long, (0, 29))
            with pytest.raises(TooManyCrossingsError) as refused:
                constrained_delaunay(PSLG(points, segments), carve=False)
            assert refused.value.indices == (long,)


@pytest.mark.obligation(
    "M5", "progress counts points, then segments, up to all", method="named cases", control_in="mutants"
)
class TestProgress:
    """After each piece of work the number of points and segments that are done is told, and how many there are."""

    @pytest.mark.parametrize("size", [1, 2, 3, 100])
    def test_calls(self, size: int, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(CONSTRAIN, "_CHUNK", size)
        monkeypatch.setattr(sys.modules["exactmesh.delaunay"], "_CHUNK", 4)
        points, segments = grid(3, 3), [(0, 1), (1, 2), (2, 5), (5, 8), (8, 7), (7, 6), (6, 3)]
        calls: list[tuple[int, int]] = []
        graph = PSLG(points, segments)
        mesh = constrained_delaunay(graph, carve=False, progress=lambda done, total: calls.append((done, total)))
        assert mesh.canonical() == constrained_delaunay(graph, carve=False).canonical()
        inserted = [9 + done for done in [*range(size, 7, size), 7]]
        assert calls == [(done, 16) for done in [7, 9, *inserted]]


def column(height: int) -> list[Pair]:
    """A column of vertices, each joined to two far ones below, so that the left side of a segment passes each twice."""
    return [(-1000.0, -0.5), (1000.0, -0.5), (-40.0, -1.0), (40.0, -1.0), *((0.0, float(y)) for y in range(height))]


@inlined
@pytest.mark.obligation("M5", "scratch has room for a cavity with vertices that come twice", method="named cases")
class TestRoomForCavities:
    """A segment below a column of vertices crosses two edges of each, and the polygon above it has every vertex twice:
    the longest that there can be. Filled by search or by chance, it fits, and is constrained Delaunay."""

    @pytest.mark.parametrize("patience", [1 << 20, 0])
    @pytest.mark.parametrize("height", [3, 20, 40])
    def test_column(self, height: int, patience: int, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(CAVITY, "_PATIENCE", patience)
        monkeypatch.setattr(CAVITY, "_SMALL", 0)
        points = column(height)
        lengths: list[int] = []
        split = CONSTRAIN.split_along

        def observed(plane: Plane, a: int, b: int, crossed: int, lefts: int, rights: int) -> int:
            lengths.append(max(lefts, rights))
            return int(split(plane, a, b, crossed, lefts, rights))

        monkeypatch.setattr(CONSTRAIN, "split_along", observed)
        mesh = constrained_delaunay(PSLG(points, [(0, 1)]), carve=False)
        assert max(lengths) == 2 * height
        bad = [t for t in mesh.triangles.tolist() if 0 in t and 1 in t]
        assert len(bad) == 2
        exact = oracles.rationals(points)
        if height < 5:
            expected = constrained_oracle.constrained_triangles(exact, [(0, 1)])
            assert canonical_triangles(mesh.triangles.tolist()) == expected

    @pytest.mark.parametrize("height", [3, 20])
    def test_control_a_vertex_less(self, height: int, monkeypatch: pytest.MonkeyPatch) -> None:
        """Scratch that is one vertex shorter than the polygon."""
        plane_of = CONSTRAIN.plane_of

        def cut(room: int) -> None:
            monkeypatch.setattr(
                CONSTRAIN,
                "plane_of",
                lambda built: (plane := plane_of(built))._replace(left=plane.left[:room], right=plane.right[:room]),
            )

        cut(2 * height)
        assert len(constrained_delaunay(PSLG(column(height), [(0, 1)]), carve=False).triangles)
        cut(2 * height - 1)
        with pytest.raises(IndexError):
            constrained_delaunay(PSLG(column(height), [(0, 1)]), carve=False)

    @pytest.mark.parametrize("seed", range(6))
    def test_no_overflow_is_told(self, seed: int) -> None:
        """Coordinates of any size, whatever numpy was told to do about an overflow."""
        random = np.random.default_rng(seed)
        points = np.ldexp(random.random((12, 2)) - 0.5, random.integers(-900, 900, (12, 2)) * (seed % 3 != 0))
        graph = PSLG(points, [(0, 1)])
        expected = constrained_delaunay(graph, carve=False)
        with np.errstate(over="raise", invalid="raise"):
            mesh = constrained_delaunay(graph, carve=False)
        assert mesh.canonical() == expected.canonical()
        assert verify(mesh.points, mesh.triangles, segments=mesh.segments).ok
