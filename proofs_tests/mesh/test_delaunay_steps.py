"""M4: what each step of the incremental insertion promises, against fractions: from the first triangle to the last."""

import sys
from collections.abc import Sequence
from itertools import combinations, permutations, product
from types import SimpleNamespace

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.mesh import oracle as mesh_oracle
from proofs_tests.mesh.enumeration import CIRCLE_OF_EIGHT, canonical_triangles, grid

from exactkernel.context import scaled_into_window
from exactkernel.jit import COMPILED
from exactkernel.types import FloatArray, IntArray
from exactmesh import PSLG, QuadEdge, TooFewPointsError, TooManyPointsError, constrained_delaunay, delaunay
from exactmesh.edgealgebra import dest, left_next, origin
from exactmesh.errors import CollinearPointsError

#: The module; the package exports the function under the same name.
MODULE = sys.modules["exactmesh.delaunay"]

inlined = pytest.mark.skipif(COMPILED, reason="calls functions that are compiled only as parts of others")

Pair = tuple[float, float]


def flat(points: Sequence[Pair]) -> SimpleNamespace:
    """Coordinates, flat, with their context."""
    xy, k = scaled_into_window(np.array(points, dtype=np.float64).reshape(-1, 2))
    return SimpleNamespace(xy=xy.reshape(-1), k=k)


CORNERS = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]


@pytest.mark.obligation(
    "M4", "the first triangle is that of the first vertices that span one", method="enumeration", control_in="mutants"
)
class TestTheFirstTriangle:
    """second_position and first_turn find what a search from the start finds, in any part of the points; the triangle
    and its three ghosts are a closed surface, and its vertices have moved to the front together with their names."""

    @pytest.mark.parametrize("n", [1, 2, 3, 4])
    def test_second_position(self, n: int) -> None:
        for points in product(CORNERS, repeat=n):
            expected = next((i for i, p in enumerate(points) if p != points[0]), n)
            assert MODULE.second_position(np.array(points).reshape(-1)) == expected

    def test_first_turn(self) -> None:
        for points in product(CORNERS[:3], [(2.0, 0.0), (1.0, 1.0), (0.0, 0.0)], CORNERS, CORNERS):
            all_, exact = flat(points), oracles.rationals(points)
            for first, stop in combinations(range(5), 2):
                turns = [oracles.orient(exact[0], exact[1], exact[c]) for c in range(first, stop)]
                c = next((first + i for i, turn in enumerate(turns) if turn), stop)
                expected = (c, np.sign(int(turns[c - first]))) if c < stop else (stop, 0)
                assert MODULE.first_turn(all_.k, all_.xy, 1, first, stop) == expected

    def test_first_triangle(self) -> None:
        points = [(0.0, 0.0), (3.0, 1.0), (1.0, 4.0), (2.0, -5.0), (-7.0, 2.0)]
        exact = oracles.rationals(points)
        for b, c in combinations(range(1, 5), 2):
            order, xy = np.arange(5), np.array(points).reshape(-1)
            ring, org = np.full(60, -7, dtype=np.int32), np.full(30, -7, dtype=np.int32)
            turn = 1 if oracles.orient(exact[0], exact[b], exact[c]) > 0 else -1
            MODULE.first_triangle(xy, order, ring, org, b, c, turn)
            assert order[:3].tolist() == [0, b, c]
            assert sorted(order.tolist()) == [0, 1, 2, 3, 4]
            assert xy.reshape(-1, 2).tolist() == [list(points[i]) for i in order]
            surface = QuadEdge.from_arrays(ring[:24], org[:12], np.zeros(12, dtype=np.int32))  # checks the axioms
            assert surface.counts() == (4, 6, 4)
            second, third = (1, 2) if turn > 0 else (2, 1)
            faces = {tuple(e.org for e in side.face()) for edge in surface.edges() for side in (edge, edge.sym)}
            expected = [(0, second, third), (second, 0, 5), (third, second, 5), (0, third, 5)]
            assert canonical_triangles([t for t in faces if len(t) == 3]) == canonical_triangles(
                [t[i:] + t[:i] for t in expected for i in range(3)]
            )
            assert (ring[24:] == -7).all()
            assert (org[12:] == -7).all()
            assert (org[0], dest(org, 0)) == (0, second)  # where the first walk starts

    @pytest.mark.parametrize("size", [1, 2, 3, 1 << 17])
    @pytest.mark.parametrize("leading", range(9))
    def test_wherever_it_is(self, size: int, leading: int, monkeypatch: pytest.MonkeyPatch) -> None:
        """So many points on a line come first, some equal; pieces of any size: the triangulation is the same."""
        monkeypatch.setattr(MODULE, "_CHUNK", size)
        monkeypatch.setattr(MODULE, "insertion_order", lambda xy, _: np.arange(len(xy)))
        line = [(float(i // 2), 0.0) for i in range(leading)]
        with pytest.raises((CollinearPointsError, TooFewPointsError)):
            delaunay([(0.0, 0.0), *line])
        points = [(0.0, 0.0), *line, (1.0, 2.0), (0.5, -1.0), (0.0, 0.0), (5.0, 1.0)]
        exact = oracles.rationals(points)
        distinct = list(dict.fromkeys(exact))
        mesh = delaunay(points)
        assert canonical_triangles(mesh.triangles.tolist()) == mesh_oracle.delaunay_triangles(distinct)
        assert [distinct[v] for v in mesh.representative] == exact


class Under:
    """The first points inserted in their order, the others not; the ghost is ``len(points)``."""

    def __init__(self, points: Sequence[Pair], inserted: int) -> None:
        self.points, self.exact, self.n = list(points), oracles.rationals(points), len(points)
        all_ = flat(points)
        self.k, self.xy = all_.k, all_.xy
        self.ring, self.org = np.empty(12 * self.n, dtype=np.int32), np.empty(6 * self.n, dtype=np.int32)
        self.twin, order = np.arange(self.n, dtype=np.int32), np.arange(self.n)
        turn = 1 if oracles.orient(*self.exact[:3]) > 0 else -1
        MODULE.first_triangle(self.xy, order, self.ring, self.org, 1, 2, turn)
        self.start, self.edges, self.flips = 0, 6, 0
        self.insert(3, inserted)

    def insert(self, first: int, stop: int) -> int:
        arrays = self.k, self.xy, self.ring, self.org, self.twin
        self.start, self.edges, flips = MODULE.insert_range(*arrays, first, stop, self.start, self.edges)
        self.flips += flips
        return int(flips)

    def ends(self, e: int) -> tuple[int, int, int]:
        """The origin and the destination of an edge, and the third corner of the triangle on its left."""
        return origin(self.org, e), dest(self.org, e), dest(self.org, left_next(self.ring, e))

    def degree(self, p: int) -> int:
        return int((self.org[: 2 * self.edges] == p).sum())

    def triangles(self) -> set[tuple[int, int, int]]:
        faces = [self.ends(e) for e in range(0, 4 * self.edges, 2)]
        return set(canonical_triangles([t for t in faces if self.n not in t]))


STARTS: dict[str, list[Pair]] = {
    "triangle": [(0, 0), (4, 0), (0, 4)],
    "clockwise triangle": [(0, 0), (0, 4), (4, 0)],
    "square with centre": [(0, 0), (4, 0), (4, 4), (0, 4), (2, 2)],
    "grid": [(0, 0), (2, 0), (2, 2), (0, 2), (4, 4), (4, 0), (0, 4), (2, 4), (4, 2)],
    "flat hull": [(0, 0), (4, 0), (2, 3), (2, 0)],
    "slanted": [(0, 0), (4, 1), (1, 4), (3, 3), (-1, 2), (2, 1)],
}


@inlined
@pytest.mark.obligation("M4", "the walk ends where the point is, wherever it starts", method="enumeration")
@pytest.mark.parametrize("name", STARTS)
class TestLocate:
    """From every edge without a ghost end the walk to any point ends at an edge e such that the point is at the origin
    of e (zeros 2), between its ends (1), strictly inside the triangle on its left, or strictly beyond the hull edge of
    the ghost triangle there (0)."""

    PLACES: tuple[Pair, ...] = (
        *((float(x), float(y)) for x, y in product(range(-1, 6), repeat=2)),
        (1.25, 0.5),
        (9, 9),
    )

    def is_right(self, under: Under, p: int, e: int, zeros: int) -> bool:
        a, b, c = under.ends(e)
        exact = under.exact
        if under.n in (a, b):
            return False
        place = exact[p]
        if zeros == 2:
            return place == exact[a]
        if zeros == 1:
            return place not in (exact[a], exact[b]) and oracles.on_segment(place, exact[a], exact[b])
        if zeros != 0:
            return False
        if c == under.n:
            return oracles.orient(exact[a], exact[b], place) > 0
        return min(oracles.orient(exact[u], exact[v], place) for u, v in ((a, b), (b, c), (c, a))) > 0

    def test_from_every_edge(self, name: str) -> None:
        m = len(STARTS[name])
        under = Under([*STARTS[name], *self.PLACES], m)
        starts = [e for e in range(0, 4 * under.edges, 2) if under.n not in under.ends(e)[:2]]
        seen = set()
        for p in range(m, under.n):
            for start in starts:
                e, zeros = MODULE.locate(under.k, under.xy, under.ring, under.org, under.n, start, p)
                assert self.is_right(under, p, e, zeros), (under.points[p], start, e, zeros)
                if zeros == 1:  # on the hull, the triangle inside is the one to split
                    assert under.n not in under.ends(e)
                seen.add((zeros, under.n in under.ends(e)))
        assert seen >= {(0, False), (0, True), (1, False), (2, False)}

    def test_control_another_edge(self, name: str) -> None:
        """Any other edge, or number of zeros, is wrong; inside and outside, one of three or one is right."""
        under = Under([*STARTS[name], *self.PLACES], len(STARTS[name]))
        for p in range(len(STARTS[name]), under.n):
            right = [(e, z) for e in range(0, 4 * under.edges, 2) for z in range(3) if self.is_right(under, p, e, z)]
            assert len({z for _, z in right}) == 1
            exact = under.exact
            if right[0][1] == 0:
                beyond = {under.n in under.ends(e) for e, _ in right}
                assert beyond == {True} or len(right) == 3
            else:
                at = [v for v in range(len(STARTS[name])) if exact[v] == exact[p]]
                assert len(right) == (
                    under.degree(at[0])
                    - any({at[0], under.n} == set(under.ends(e)[:2]) for e in range(0, 4 * under.edges, 2))
                    if at
                    else 2
                )


@inlined
@pytest.mark.obligation(
    "M4",
    "a point is in conflict with a triangle just when it is in its disk",
    method="enumeration",
    control_in="mutants",
)
class TestInConflict:
    """in_conflict is membership in the open (perturbed) disk, from whichever corner the triangle is named; the disk of
    a ghost triangle is the open half plane beyond its hull edge. A triangle is in conflict with none of its corners."""

    @pytest.mark.parametrize("points", [grid(3, 3), CIRCLE_OF_EIGHT[:6]], ids=["grid", "circle"])
    def test_every_triangle(self, points: list[tuple[int, int]]) -> None:
        all_, exact, n = flat(points), oracles.rationals(points), len(points)
        for t in combinations(range(n), 3):
            if oracles.has_area(exact, t):
                a, b, c = oracles.counterclockwise(exact, t)
                for p in range(n):
                    expected = not mesh_oracle.is_perturbed_empty(exact, (a, b, c), [p])
                    for corners in ((a, b, c), (b, c, a), (c, a, b)):
                        assert MODULE.in_conflict(all_.k, all_.xy, n, *corners, p) is expected

    def test_every_ghost(self) -> None:
        points = grid(3, 3)
        all_, exact = flat(points), oracles.rationals(points)
        for (a, b), p in product(permutations(range(9), 2), range(9)):
            expected = oracles.orient(exact[a], exact[b], exact[p]) > 0
            for corners in ((a, b, 9), (b, 9, a), (9, a, b)):
                assert MODULE.in_conflict(all_.k, all_.xy, 9, *corners, p) is bool(expected)


@pytest.mark.obligation(
    "M4",
    "after each insertion: Delaunay, three edges more, degree - 3 flips",
    method="enumeration",
    control_in="mutants",
)
@pytest.mark.parametrize("name", STARTS)
class TestOneInsertion:
    """A vertex that comes in adds three edges, and flips as many as its degree exceeds three, whether it comes inside a
    triangle, on an edge, or beyond the hull; the next walk starts at it. A point in the place of a vertex is its twin,
    and changes nothing. The triangles are always those of brute force."""

    def test_one_by_one(self, name: str) -> None:
        m = len(STARTS[name])
        for p in TestLocate.PLACES[::5]:
            under = Under([*STARTS[name], p], m)
            assert under.edges == 3 * m - 3
            self.check(under, m, m)

    def test_one_after_the_other(self, name: str) -> None:
        m = len(STARTS[name])
        under = Under([*STARTS[name], *TestLocate.PLACES[1::7]], m)
        for p in range(m, under.n):
            self.check(under, p, p)

    def check(self, under: Under, p: int, known: int) -> None:
        exact = under.exact
        places = [exact[v] for v in range(known)]
        before = under.edges, under.ring.copy()
        flips = under.insert(p, p + 1)
        if exact[p] in places:
            assert under.twin[p] == places.index(exact[p])
            assert (under.edges, flips) == (before[0], 0)
            assert (under.ring == before[1]).all()
        else:
            assert under.twin[p] == p
            assert under.edges == before[0] + 3
            assert flips == under.degree(p) - 3
        assert under.start % 2 == 0
        assert origin(under.org, under.start) == under.twin[p]
        assert dest(under.org, under.start) != under.n or under.twin[p] != p
        vertices = [v for v in range(p + 1) if under.twin[v] == v]
        expected = mesh_oracle.delaunay_triangles([exact[v] for v in vertices])
        assert under.triangles() == {tuple(vertices[i] for i in t) for t in expected}

    def test_ranges_add_up(self, name: str) -> None:
        """Several at once are one after the other."""
        points = [*STARTS[name], *TestLocate.PLACES[1::7]]
        m = len(STARTS[name])
        whole, parts = Under(points, len(points)), Under(points, m)
        for p in range(m, len(points)):
            parts.insert(p, p + 1)
        used = slice(4 * whole.edges)
        assert (whole.start, whole.edges, whole.flips) == (parts.start, parts.edges, parts.flips)
        assert (whole.ring[used] == parts.ring[used]).all()
        assert (whole.twin == parts.twin).all()
        empty = parts.start, parts.edges
        assert parts.insert(5, 5) == 0
        assert (parts.start, parts.edges) == empty


@pytest.mark.obligation(
    "M4",
    "vertices are numbered as their points come; of equal ones the first",
    method="enumeration",
    control_in="mutants",
)
class TestNumbers:
    """For every order of up to five points and every way in which they coincide, the vertices are the places in the
    order of their first points, and each point stands for its place."""

    @pytest.mark.parametrize("n", [1, 2, 3, 4, 5])
    def test_every_order(self, n: int) -> None:
        orders = [np.array(order) for order in permutations(range(n))]
        for places in product(range(n), repeat=n):  # the place of each input point
            if list(places) != [sorted(set(places), key=places.index).index(p) for p in places]:
                continue
            firsts = [places.index(p) for p in sorted(set(places))]
            for order in orders[:: max(1, len(orders) // 24)]:
                at = [places[i] for i in order]
                twin = np.array([at.index(p) for p in at], dtype=np.int32)
                kept, vertex, representative = MODULE.number_vertices(order, twin)
                assert kept.tolist() == firsts
                assert representative.tolist() == list(places)
                assert vertex.tolist() == [at[i] if twin[i] == i else -1 for i in range(n)]
                assert {a.dtype for a in (vertex, representative)} == {np.dtype(np.int32)}


@pytest.mark.obligation(
    "M4",
    "so many points are taken at a time, and not more than can be numbered",
    method="named cases",
    control_in="mutants",
)
class TestLimits:
    """Three points are enough, two are not; there may be MAX_POINTS, whose edges just fit 31 bits, and no more; the
    progress is told after each piece of work, in points."""

    def test_too_few(self) -> None:
        assert len(delaunay([(0, 0), (1, 0), (0, 1)]).triangles) == 1
        for n in range(3):
            with pytest.raises(TooFewPointsError, match=f"^{n} points span no triangle; at least 3 are needed$"):
                delaunay(np.arange(2.0 * n).reshape(n, 2))

    def test_too_many(self, monkeypatch: pytest.MonkeyPatch) -> None:
        most = MODULE.MAX_POINTS
        assert 12 * most <= 2**31 < 12 * (most + 1)
        assert f"{most:,}" in str(delaunay.__doc__)
        monkeypatch.setattr(MODULE, "MAX_POINTS", 5)
        points = [(0, 0), (1, 0), (0, 1), (1, 1), (2, 5), (3, 7)]
        assert len(delaunay(points[:5]).points) == 5
        with pytest.raises(TooManyPointsError, match=r"^6 points; at most 5 fit 32-bit edge numbers$"):
            delaunay(points)

    def test_flat(self) -> None:
        with pytest.raises(CollinearPointsError, match=r"^all 3 points are \[1\.0, 2\.0\]: they span no triangle$"):
            delaunay([(1, 2)] * 3)
        with pytest.raises(CollinearPointsError, match=r"are \[-0\.0, 0\.0\]: "):  # the first of them
            delaunay([(-0.0, 0.0), (0.0, -0.0), (0.0, 0.0)])
        for points in ([(0, 0), (1, 1), (2, 2)], [(0, 0), (0, 1), (0, 1)], [(1, 0), (0, 0), (0, 0)]):
            with pytest.raises(CollinearPointsError, match=r"^all 3 points lie on one line: they span no triangle$"):
                delaunay(points)

    @pytest.mark.parametrize("size", [1, 2, 3, 7, 100])
    @pytest.mark.parametrize("n", [3, 4, 5, 11])
    def test_progress(self, size: int, n: int, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(MODULE, "_CHUNK", size)
        calls: list[tuple[int, int]] = []
        points = [(float(i), float(i * i)) for i in range(n)]
        mesh = delaunay(points, progress=lambda done, total: calls.append((done, total)))
        assert mesh.canonical() == delaunay(points).canonical()
        expected = [*range(3 + size, n, size), n] if n > 3 else []
        assert calls == [(done, n) for done in expected]

    @pytest.mark.parametrize("size", [1, 4, 100])
    def test_flips_add_up(self, size: int, monkeypatch: pytest.MonkeyPatch) -> None:
        """The flips that are told are those of each insertion, from 0 on."""
        monkeypatch.setattr(MODULE, "_CHUNK", size)
        monkeypatch.setattr(MODULE, "insertion_order", lambda xy, _: np.arange(len(xy)))
        for start in STARTS.values():
            for n in range(3, len(start) + 1):
                assert delaunay(start[:n]).work.flips == Under(start[:n], n).flips

    def test_the_seed_is_0(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Without a seed the order is that of seed 0; any other is handed on."""
        seeds: list[object] = []
        order = MODULE.insertion_order

        def observed(xy: FloatArray, seed: int) -> IntArray:
            seeds.append(seed)
            result: IntArray = order(xy, seed)
            return result

        monkeypatch.setattr(MODULE, "insertion_order", observed)
        points = np.random.default_rng(3).random((9, 2))
        delaunay(points)
        delaunay(points, seed=5)
        MODULE.insert_points(points)
        constrained_delaunay(PSLG(points, [(0, 1)]), carve=False)
        constrained_delaunay(PSLG(points, [(0, 1)]), carve=False, seed=7)
        assert seeds == [0, 5, 0, 0, 7]

    @pytest.mark.parametrize("exponent", [-1060, -300, 0, 300, 1020])
    @pytest.mark.parametrize("spread", [0, 200, 900])
    def test_no_overflow_is_told(self, exponent: int, spread: int) -> None:
        """Coordinates of any size, near to each other or not, whatever numpy was told to do about an overflow."""
        random = np.random.default_rng(1)
        points = (random.random((8, 2)) + 0.5) * np.ldexp(1.0, exponent)
        points *= np.ldexp(1.0, -np.sign(exponent or 1) * random.integers(0, spread + 1, (8, 2)))
        exact = oracles.rationals(points.tolist())
        with np.errstate(over="raise", invalid="raise"):
            mesh = delaunay(points)
        assert canonical_triangles(mesh.triangles.tolist()) == mesh_oracle.delaunay_triangles(exact)
