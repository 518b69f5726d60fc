"""V1 for nearest corners and for chains within a distance, each function alone, against fractions."""

import math
import tracemalloc
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from random import Random

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.oracles import Triangle

from exactkernel.types import FloatArray
from exactmesh import delaunay
from exactmesh.verify import displaced, nearest
from exactmesh.verify.bottleneck import NO_VERTEX
from exactmesh.verify.chains import CONSTRAINED, ODD
from exactmesh.verify.displaced import NearChains
from exactmesh.verify.links import Links, linked
from exactmesh.verify.local import localized
from exactmesh.verify.mesh import Mesh, index_quads, index_triples, prepared_mesh
from exactmesh.verify.witness import IndexArray

N = 400


def lattice(seed: int, n: int = N) -> FloatArray:
    """Integers: squares are exact in doubles, and many distances equal."""
    size = (20, 60, 4000)[seed % 3]
    return np.random.default_rng(seed).integers(-size, size, (n, 2)).astype(np.float64)


@pytest.mark.obligation(
    "V1", "the search in the tree finds what a look at all finds", method="differential", control_in="mutants"
)
class TestTree:
    """The least distance, all that is within reach and nothing else, each once, as far as there is room."""

    @pytest.mark.parametrize("n", [1, 2, 48, 49, 50, 97, 98, 99, 200, N])
    def test_order(self, n: int) -> None:
        """A permutation; the middle of each part that is not small separates it by x, its halves by y, in turn."""
        points = lattice(n, n)
        order = nearest._tree(points)
        assert sorted(order.tolist()) == [*range(n)]
        parts = [(0, n, 0)]
        while parts:
            low, high, axis = parts.pop()
            if high - low <= 48:
                continue
            middle, z = (low + high) // 2, points[order, axis]
            assert z[low:middle].max(initial=-math.inf) <= z[middle] <= z[middle + 1 : high].min(initial=math.inf)
            parts += [(low, middle, 1 - axis), (middle + 1, high, 1 - axis)]

    @pytest.mark.parametrize("n", [48, 97])
    def test_parts_that_just_fit(self, n: int) -> None:
        """Of a part that is not split every point is looked at, be it as large as such a part can be."""
        points = lattice(n, n)
        order, stack = nearest._tree(points), np.empty(192, dtype=np.intp)
        for i, (x, y) in enumerate(points.tolist()):
            found = np.full(n, -7, dtype=np.intp)
            _, count = nearest.within_reach(points, order, x, y, 0.0, stack, found)
            assert i in found[:count].tolist()

    @pytest.mark.parametrize("seed", range(6))
    def test_tiny(self, seed: int) -> None:
        """Where squares are below the absolute slack as well, all that is within reach is found."""
        points, far = np.ldexp(lattice(seed), -258), np.ldexp(1.0, -258)
        order, stack = nearest._tree(points), np.empty(192, dtype=np.intp)
        for x, y in (points[:30] + far).tolist():
            squares = (points[:, 0] - x) ** 2 + (points[:, 1] - y) ** 2
            reach, found = float(np.sort(squares)[9]), np.full(N, -7, dtype=np.intp)
            _, count = nearest.within_reach(points, order, x, y, reach, stack, found)
            assert sorted(found[:count].tolist()) == np.flatnonzero(squares <= reach).tolist()

    def test_doubles_that_mislead(self) -> None:
        """Of two corners that are nearly as near the nearer one, although rounded squares are in the other order."""
        random, misled = Random(1), 0
        for _ in range(300):
            (a, b), angle = (random.uniform(1, 2), random.uniform(1, 2)), random.uniform(0, 7)
            c, s = math.cos(angle), math.sin(angle)
            points = np.array([(a, b), (c * a - s * b, s * a + c * b), (50.0, 50.0)])
            squares = [x * x + y * y for x, y in oracles.rationals(points.tolist())]
            rounded = (points**2).sum(axis=1)
            misled += bool(rounded[0] != rounded[1] and (squares[0] < squares[1]) != (rounded[0] < rounded[1]))
            found = nearest.nearest_corners(points, np.arange(3), np.zeros((1, 2)))
            assert found.tolist() == [squares.index(min(squares))]
        assert misled > 5

    @pytest.mark.parametrize("exponent", [-1000, 0, 1000])
    def test_scale_and_room(self, exponent: int, monkeypatch: pytest.MonkeyPatch) -> None:
        """Coordinates are searched far above the absolute slack, whatever they were, and squares do not overflow; the
        stack has three numbers for each part of 2^31 points that waits at the same time: one a level, and another."""
        rooms, levels = list[int](), math.ceil(math.log2(2**31 / 48))

        def recorded(
            points: FloatArray,
            order: IndexArray,
            wanted: FloatArray,
            stack: IndexArray,
            found: IndexArray,
            counts: IndexArray,
        ) -> None:
            rooms.append(len(stack))
            assert 2.0**400 < max(np.abs(points).max(), np.abs(wanted).max()) <= 2.0**500
            found[:], counts[:] = 0, 1

        monkeypatch.setattr(nearest, "find_nearest", recorded)
        nearest.nearest_corners(np.ldexp(lattice(1, 5), exponent), np.arange(5), np.zeros((1, 2)))
        assert rooms[0] >= 3 * (levels + 2)

    @pytest.mark.parametrize("seed", range(6))
    def test_within_reach(self, seed: int) -> None:
        points, random = lattice(seed), Random(seed)
        order, stack = nearest._tree(points), np.empty(192, dtype=np.intp)
        for _ in range(12):
            x, y = points[random.randrange(N)] + [random.randrange(-40, 40), random.randrange(-40, 40)]
            squares = (points[:, 0] - x) ** 2 + (points[:, 1] - y) ** 2
            best, n = nearest.within_reach(points, order, x, y, math.inf, stack, np.full(3, -7, dtype=np.intp))
            assert (best, n) == (squares.min(), 0)
            for reach in (best, best + 100.0, best * 4.0, np.sort(squares)[50]):
                there = np.flatnonzero(squares <= reach).tolist()
                for room in (len(there) + 5, len(there), len(there) - 1, 0):
                    found = np.full(room, -7, dtype=np.intp)
                    assert nearest.within_reach(points, order, x, y, reach, stack, found) == (reach, len(there))
                    written = min(room, len(there))
                    assert (found[written:] == -7).all()
                    assert len({*found[:written].tolist()}) == written
                    assert {*found[:written].tolist()} <= {*there}

    @pytest.mark.parametrize("seed", range(6))
    def test_nearest(self, seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
        """The nearest, of equally near ones that of the smallest index, in pieces of any size, and at any scale."""
        monkeypatch.setattr(nearest, "_CHUNK", (1, 5, 1000)[seed // 2])
        points = lattice(seed)
        corners = np.flatnonzero(np.random.default_rng(seed).random(N) < 0.9)
        wanted = lattice(seed + 3, 24) / 2
        wanted[:4] = points[corners[:4]]
        squares = ((points[corners, None] - wanted) ** 2).sum(axis=2)
        brute = corners[squares.argmin(axis=0)].tolist()
        for exponent in (0, -900, 900):
            scaled, asked = np.ldexp(points, exponent), np.ldexp(wanted, exponent)
            assert nearest.nearest_corners(scaled, corners, asked).tolist() == brute
        assert nearest.nearest_corners(points, corners, wanted[:0]).tolist() == []

    @pytest.mark.parametrize("n", [1, 2, 4, 5, 12])
    def test_rings(self, n: int) -> None:
        """So many as near as the nearest, up to rounding: fractions decide, in favour of the only one that is."""
        ring = [
            (3, 4),
            (-3, 4),
            (5, 0),
            (-4, -3),
            (0, -5),
            (4, 3),
            (-4, 3),
            (4, -3),
            (3, -4),
            (-3, -4),
            (-5, 0),
            (0, 5),
        ]
        for chosen in range(n):
            points = np.array([*ring[:n], (50, 50)], dtype=np.float64)
            centre = np.array([(0.0, 0.0)]) + np.ldexp(points[chosen], -60)
            found = nearest.nearest_corners(points, np.arange(n + 1), centre)
            assert found.tolist() == [chosen]
            assert nearest.nearest_corners(points, np.arange(n + 1), np.zeros((1, 2))).tolist() == [0]

    def test_squared_distance(self) -> None:
        p, q = np.array([2.0**-80, 3.0]), np.array([-1.0, 2.0**-70])
        exact = oracles.squared_distance(*oracles.rationals([p.tolist(), q.tolist()]))
        assert Fraction(str(nearest.squared_distance(p, q))) == exact


def linked_mesh(
    points: FloatArray, triangles: Sequence[Triangle], others: FloatArray
) -> tuple[Mesh, Links, FloatArray]:
    mesh, positions = prepared_mesh(points, index_triples(triangles), index_quads(()), others)
    return mesh, linked(len(points), mesh.context, localized(mesh.coordinates, mesh.triangles, mesh.quads)), positions


def exact_squared(p: Sequence[float], a: Sequence[float], b: Sequence[float]) -> Fraction:
    """The squared distance of p from the line ab."""
    a_, b_, p_ = oracles.rationals([a, b, p])
    return oracles.orient(a_, b_, p_) ** 2 / oracles.squared_distance(a_, b_)


class Strips:
    """Long strips of triangles whose upper and lower vertices are at random heights: segments along the middle."""

    def __init__(self, seed: int, exponent: int = 0, spread: bool = False) -> None:
        random, k = Random(seed), 6
        places = [(0.0, 0.0), (8.0 * k, 0.0)]
        places += [(4.0 * x, (1 + random.randrange(64) / 64) * (1 if x % 2 else -1)) for x in range(1, 2 * k)]
        if spread:
            places.append((2.0**-1000, 0.0))
        self.points = np.ldexp(np.array(places), exponent)
        body = 2 * k + 1
        self.triangles = [(int(a), int(b), int(c)) for a, b, c in delaunay(self.points[:body]).triangles]
        self.domain = np.ldexp(
            np.array([(0.0, random.randrange(4) / 8), (8.0 * k, 0.25), (8.0, 1.5), (30.0, -1.0)]), exponent
        )
        self.segments = np.array([(0, 1), (1, 0), (2, 1), (0, 2), (3, 2)], dtype=np.intp)
        self.corner = np.array([0, 1, 3, -1], dtype=np.intp)
        self.mesh, self.links, self.positions = linked_mesh(self.points, self.triangles, self.domain)

    def found(self, within: float, rows: IndexArray | None = None) -> NearChains:
        return displaced.near_chains(
            self.mesh, self.links, self.domain, self.positions, self.segments, self.corner,
            np.arange(5) if rows is None else rows, within,
        )  # fmt: skip

    def squared(self, found: NearChains, i: int) -> Fraction:
        """The farthest inner vertex of a chain."""
        chain = found.vertices[found.start[i] : found.start[i + 1]].tolist()
        a, b = self.domain[self.segments[found.rows[i]]].tolist()
        return max((exact_squared(self.points[v].tolist(), a, b) for v in chain[1:-1]), default=Fraction(0))


def up(squared: Fraction) -> float:
    """The least double whose square is not less."""
    root = math.sqrt(squared)
    while Fraction(root) ** 2 < squared:
        root = math.nextafter(root, math.inf)
    while Fraction(math.nextafter(root, 0.0)) ** 2 >= squared:
        root = math.nextafter(root, 0.0)
    return root


@pytest.mark.obligation("V1", "a chain is within exactly its largest distance", method="differential")
class TestWithin:
    """Of every chain: which segment, its vertices, its farthest one, and bounds of its distance; it is found within
    that distance and not within the double below, at any scale, in pieces of any size, and in rationals."""

    @pytest.mark.parametrize(("exponent", "spread"), [(0, False), (-700, False), (600, False), (0, True)])
    @pytest.mark.parametrize("seed", range(4))
    def test_exactly(self, seed: int, exponent: int, spread: bool, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(displaced, "_CHUNK", 2 if seed % 2 else 4096)
        strips = Strips(seed, exponent, spread)
        every = strips.found(math.inf)
        assert every.rows.tolist() == [0, 1, 2, 3]
        unit = Fraction(2) ** (2 * exponent)
        distances = [strips.squared(every, i) for i in range(4)]
        for i, row in enumerate(every.rows.tolist()):
            ends = strips.segments[row]
            chain = every.vertices[every.start[i] : every.start[i + 1]].tolist()
            assert [chain[0], chain[-1]] == strips.corner[ends].tolist()
            a, b = strips.domain[ends].tolist()
            if len(chain) == 2:
                assert every.farthest[i] == NO_VERTEX
                continue
            assert exact_squared(strips.points[every.farthest[i]].tolist(), a, b) == distances[i]
            low, high = (Fraction(x) if x < math.inf else unit * 10**9 for x in every.bounds[i].tolist())
            assert low**2 <= distances[i] <= high**2
            if not spread:
                assert (high - low) ** 2 <= distances[i] / 2**60
        for i in range(4):
            if distances[i] == 0:
                continue
            enough = up(distances[i] / unit) * 2.0**exponent
            for within in (enough, math.nextafter(enough, 0.0), math.nextafter(enough, math.inf), 0.9 * enough):
                found = strips.found(within)
                kept = [j for j in range(4) if distances[j] <= Fraction(within) ** 2]
                assert found.rows.tolist() == kept
                assert [strips.squared(found, j) for j in range(len(kept))] == [distances[j] for j in kept]

    @pytest.mark.parametrize("seed", range(4))
    def test_largest(self, seed: int) -> None:
        strips = Strips(seed)
        every = strips.found(math.inf)
        for chosen in range(16):
            flags = np.array([bool(chosen >> i & 1) for i in range(4)])
            found = every.taken(flags)
            rows = np.flatnonzero(flags).tolist()
            assert found.rows.tolist() == rows
            assert found.start[0] == 0
            for i, j in enumerate(rows):
                mine, whole = (c.vertices[c.start[n] : c.start[n + 1]].tolist() for c, n in ((found, i), (every, j)))
                assert mine == whole
                assert found.farthest[i] == every.farthest[j]
                assert found.bounds[i].tolist() == every.bounds[j].tolist()
            most = displaced.largest_squared(strips.mesh, strips.domain, strips.segments, found)
            assert Fraction(str(most)) == max((strips.squared(every, j) for j in rows), default=Fraction(0))

    def test_rows(self) -> None:
        """Only what is asked for; none without rows, none without corners."""
        strips = Strips(0)
        assert strips.found(math.inf, np.array([2, 4])).rows.tolist() == [2]
        for rows in ([], [4]):
            found = strips.found(math.inf, np.array(rows, dtype=np.intp))
            assert (found.rows.tolist(), found.start.tolist(), found.vertices.tolist()) == ([], [0], [])

    @pytest.mark.parametrize("many", [1, 20, 30, 31, 40])
    def test_room(self, many: int) -> None:
        """The same long chain again and again, more vertices than there is room for at first."""
        strips = Strips(1)
        once = strips.found(math.inf, np.array([0]))
        strips.segments = np.repeat(strips.segments[:1], many, axis=0)
        found = strips.found(math.inf, np.arange(many))
        assert found.vertices.tolist() == once.vertices.tolist() * many
        assert found.start.tolist() == [i * len(once.vertices) for i in range(many + 1)]

    def test_room_grows_only_where_it_is_needed(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Fourteen pieces that need no more room: it would be megabytes, doubled after each."""
        monkeypatch.setattr(displaced, "_CHUNK", 1)
        strips = Strips(1)
        strips.found(math.inf, np.array([0]))
        strips.segments = np.repeat(strips.segments[:1], 14, axis=0)
        tracemalloc.start()
        found = strips.found(math.inf, np.arange(14))
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert len(found.rows) == 14
        assert peak < 1 << 20

    def test_distance_of_a_line(self) -> None:
        a, b, p = np.array([1.0, 2.0**-60]), np.array([-3.0, 0.5]), np.array([0.0, 7.0])
        exact = exact_squared(p.tolist(), a.tolist(), b.tolist())
        assert Fraction(str(displaced.cross_squared(a, b, p))) == exact

    @pytest.mark.parametrize("bits", [CONSTRAINED, CONSTRAINED | ODD, ODD])
    def test_marks(self, bits: int) -> None:
        """Each edge of each chain, and whose it is; toggled as often as it occurs."""
        strips = Strips(2)
        every = strips.found(math.inf)
        slots, owner = displaced.slots_of_chains(strips.links, every)
        steps, whose = list[set[int]](), list[int]()
        for i in range(len(every.rows)):
            chain = every.vertices[every.start[i] : every.start[i + 1]].tolist()
            steps += [{v, w} for v, w in pairwise(chain)]
            whose += [i] * (len(chain) - 1)
        links, origin = strips.links, np.zeros(len(strips.links.slots), dtype=np.intp)
        for v in range(len(links.first)):
            origin[links.first[v] : links.last[v]] = v
        assert [{int(origin[s]), int(links.slots[s]) >> 32} for s in slots] == steps
        assert owner.tolist() == whose
        marks = (np.arange(len(links.slots)) % 8).astype(np.uint8)
        expected = marks.tolist()
        for slot in slots.tolist():
            expected[slot] = (expected[slot] | (bits & ~ODD)) ^ (bits & ODD)
        displaced.mark_chains(slots, marks, bits)
        assert marks.tolist() == expected

    def test_control_several_distances(self) -> None:
        """The cases have chains within distances that differ, and some that are edges."""
        distances = set[Fraction]()
        for seed in range(4):
            strips = Strips(seed)
            every = strips.found(math.inf)
            distances |= {strips.squared(every, i) for i in range(4)}
        assert len(distances) > 6
