"""V1 for chains near a segment, each function of the search alone, against fractions."""

import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import cache
from itertools import pairwise, product
from random import Random

import numpy as np
import numpy.typing as npt
import pytest
from proofs_tests import oracles
from proofs_tests.oracles import RationalPoint, Triangle

from exactkernel.context import Context, make_context
from exactkernel.types import FloatArray
from exactmesh import delaunay
from exactmesh.verify import bottleneck
from exactmesh.verify.bottleneck import NO_CHAIN, NO_VERTEX, Search, empty_search
from exactmesh.verify.chains_rational import chain_in_rationals
from exactmesh.verify.links import Links, linked
from exactmesh.verify.local import localized
from exactmesh.verify.mesh import Mesh, index_quads, index_triples, prepared_mesh

Chain = tuple[int, ...]
Pair = tuple[int, int]


def cross(p: RationalPoint, a: RationalPoint, b: RationalPoint) -> Fraction:
    return abs(oracles.orient(a, b, p))


def along(p: RationalPoint, a: RationalPoint, b: RationalPoint) -> Fraction:
    return (p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])


def hard_points(seed: int) -> tuple[FloatArray, FloatArray]:
    """A segment and points about as far from it as others, or equally far: on a lattice, tilted, with far smaller terms
    added, with coordinates of all sizes."""
    random = Random(seed)
    if seed % 4 == 0:
        points = np.array([*product(range(-3, 4), repeat=2)], dtype=np.float64)
        return points, points[[random.randrange(20), 30 + random.randrange(19)]].reshape(-1)
    if seed % 4 == 1:
        c, s = math.cos(seed), math.sin(seed)
        points = np.array([(c * x - s * y, s * x + c * y) for x, y in product(range(5), repeat=2)])
        return points, points[[0, random.choice((4, 20, 24, 14))]].reshape(-1)
    if seed % 4 == 2:
        points = np.array([(x / 8, 1.0) for x in range(-8, 9)] + [(x / 8, -1.0) for x in range(9)])
        return points, np.array([0.0, 0.0, 1.0, 2.0 ** -random.choice((60, 100, 110, 200))])
    exponents = np.random.default_rng(seed).integers(-400, 0, (12, 2))
    points = np.ldexp(1.0 + np.random.default_rng(seed).random((12, 2)), exponents)
    points = np.concatenate([points, points[:4]])
    return points, points[[5, 6]].reshape(-1)


def measured(points: FloatArray, line: FloatArray) -> Search:
    search = empty_search(len(points))
    for v in range(len(points)):
        bottleneck.measure(points, line, search, 1, v)
    return search


@pytest.mark.obligation(
    "V1", "distances from a segment are compared exactly", method="differential", control_in="mutants"
)
class TestDistances:
    """The order along the segment and the order of the distances are those of the fractions; what is noted of a vertex
    encloses its distance, narrowly."""

    @pytest.mark.parametrize("seed", range(12))
    def test_against_fractions(self, seed: int) -> None:
        points, line = hard_points(seed)
        k, exact = make_context(np.concatenate([points, line.reshape(2, 2)])), oracles.rationals(points.tolist())
        a, b = oracles.rationals(line.reshape(2, 2).tolist())
        search, h, scratch = measured(points, line), np.empty(16), np.empty(64)
        crosses = [cross(p, a, b) for p in exact]
        for v, p in enumerate(exact):
            high, error = Fraction(search.high[v]), Fraction(search.error[v])
            assert high >= 0
            assert high - error <= crosses[v] <= high + error
            assert error <= Fraction(1, 2**45) * (
                abs((b[0] - a[0]) * (p[1] - a[1])) + abs((b[1] - a[1]) * (p[0] - a[0]))
            )
            n = bottleneck.cross_expansion(points, line, v, h, scratch)
            assert sum(map(Fraction, h[:n].tolist())) == crosses[v]
        some = Random(seed).sample(range(len(points)), 14)
        for v, w in product(some, repeat=2):
            order = (crosses[v] > crosses[w]) - (crosses[v] < crosses[w])
            assert bottleneck.compare(k, points, line, search, v, w) == order
            ahead = along(exact[w], a, b) > along(exact[v], a, b)
            assert bottleneck.is_ahead(k, line, *points[v], *points[w]) == ahead

    @pytest.mark.parametrize("seed", range(4))
    def test_near_the_perpendicular(self, seed: int) -> None:
        """Turned right angles, rounded, and three units in the last place to both sides."""
        random, signs = Random(seed), set[bool]()
        for _ in range(40):
            c, s = random.random(), random.random()
            line = np.array([random.random(), 0.0, random.random() + c, s])
            v = (random.random(), random.random() * 2.0**-30)
            w = [v[0] - s, v[1] + (line[2] - line[0])]
            w[1] += random.randrange(-3, 4) * np.spacing(w[1])
            points = np.array([v, w, line[:2], line[2:]])
            p, q, a, b = oracles.rationals(points.tolist())
            ahead = along(q, a, b) > along(p, a, b)
            assert bottleneck.is_ahead(make_context(points), line, *v, *w) == ahead
            signs.add(ahead)
        assert signs == {True, False}

    def test_no_vertex(self) -> None:
        """What stands for no vertex is none, and told apart."""
        assert NO_CHAIN < NO_VERTEX < 0

    def test_noted_once(self) -> None:
        points, line = hard_points(0)
        search = measured(points, line)
        search.high[:] = search.error[:] = 7.0
        bottleneck.measure(points, line, search, 1, 3)
        assert (search.high[3], search.error[3]) == (7.0, 7.0)
        bottleneck.measure(points, line, search, 2, 3)
        assert (search.known[3], search.high[3] < 7.0 or search.error[3] < 7.0) == (2, True)
        assert (search.known[2], search.high[2]) == (1, 7.0)

    def test_scratch_space(self) -> None:
        """Nothing is noted yet, and no two columns share memory."""
        search = empty_search(5)
        columns: list[npt.NDArray[np.generic]] = [*search]
        assert [column.tolist() for column in columns[:3]] == [[0] * 5] * 3
        for i, column in enumerate(columns):
            assert column.shape == (5,)
            assert not any(np.shares_memory(column, other) for other in columns[:i])

    @pytest.mark.parametrize("seed", range(12))
    def test_candidates(self, seed: int) -> None:
        """Between the perpendiculars, strictly ahead, and not certainly beyond the limit."""
        points, line = hard_points(seed)
        k, exact = make_context(np.concatenate([points, line.reshape(2, 2)])), oracles.rationals(points.tolist())
        a, b = oracles.rationals(line.reshape(2, 2).tolist())
        search, places = measured(points, line), [along(p, a, b) for p in exact]
        limits = [
            0.0,
            math.inf,
            *(search.high + search.error)[:4],
            *((search.high - search.error) * (1 - 2.0**-40))[:4],
        ]
        some = Random(seed).sample(range(len(points)), 14)
        for v, w in product(some[:5], some):
            for limit in limits:
                found = bottleneck.is_candidate(k, points, line, search, 1, limit, v, w)
                between = places[v] < places[w] and 0 < places[w] < along(b, a, b)
                if not between or Fraction(search.high[w]) - Fraction(search.error[w]) > Fraction(
                    2 * limit if math.isfinite(limit) else 2**999
                ):
                    assert not found
                elif limit == math.inf or cross(exact[w], a, b) <= limit:
                    assert found
                elif search.high[w] - search.error[w] > limit:
                    assert not found

    @pytest.mark.parametrize("seed", range(12))
    def test_heap(self, seed: int) -> None:
        """No parent is farther than its child, and the vertices come out by their distance."""
        points, line = hard_points(seed)
        k, exact = make_context(np.concatenate([points, line.reshape(2, 2)])), oracles.rationals(points.tolist())
        a, b = oracles.rationals(line.reshape(2, 2).tolist())
        crosses, search = [cross(p, a, b) for p in exact], measured(points, line)
        random, size, inside = Random(seed), 0, list[int]()
        todo = random.sample(range(len(points)), len(points))
        while todo or inside:
            if todo and (random.random() < 0.7 or not inside):
                inside.append(todo.pop())
                size = bottleneck.push(k, points, line, search, size, inside[-1])
            else:
                nearest = bottleneck.pop(k, points, line, search, size)
                assert crosses[nearest] == min(crosses[v] for v in inside)
                inside.remove(nearest)
                size -= 1
            heap = search.heap[:size].tolist()
            assert size == len(heap) == len(inside)
            assert sorted(heap) == sorted(inside)
            assert all(crosses[heap[(i - 1) // 2]] <= crosses[heap[i]] for i in range(1, size))


def meshes() -> Iterator[tuple[FloatArray, list[Triangle]]]:
    """Triangulated grids, shuffled, a few triangles taken away."""
    for seed in range(6):
        random = Random(seed)
        places = [(float(x), float(y)) for x in range(5) for y in range(4) if random.random() < 0.75]
        random.shuffle(places)
        points = np.array(places)
        triangles = [(int(a), int(b), int(c)) for a, b, c in delaunay(points).triangles]
        yield points, [t for t in triangles if random.random() < 0.85]


def linked_mesh(points: FloatArray, triangles: Sequence[Triangle], others: FloatArray) -> tuple[Mesh, Links]:
    mesh, _ = prepared_mesh(points, index_triples(triangles), index_quads(()), others.reshape(-1, 2))
    return mesh, linked(len(points), mesh.context, localized(mesh.coordinates, mesh.triangles, mesh.quads))


class Naive:
    """The chain by thresholds: the least distance within which the end can be reached, and of the ways within it the
    first, by the rules."""

    def __init__(self, points: FloatArray, triangles: Sequence[Triangle], line: FloatArray, pair: Pair) -> None:
        self.end = pair[1]
        exact = oracles.rationals(points.tolist())
        a, b = oracles.rationals(line.reshape(2, 2).tolist())
        self.crosses = [cross(p, a, b) for p in exact]
        places, length = [along(p, a, b) for p in exact], along(b, a, b)
        near: dict[int, set[int]] = {v: set() for v in range(len(points))}
        for t in triangles:
            for v, w in product(t, repeat=2):
                if places[w] > places[v] and (w == self.end or 0 < places[w] < length):
                    near[v].add(w)
        self.near = near
        self.farthest, self.chain = self._found(pair[0])

    def _found(self, a: int) -> tuple[Fraction, Chain | None]:
        for limit in sorted({Fraction(-1), *self.crosses}):

            @cache
            def reaches(v: int, limit: Fraction = limit) -> bool:
                return v == self.end or any(
                    reaches(w) for w in self.near[v] if w == self.end or self.crosses[w] <= limit
                )

            if reaches(a) and self.near[a]:
                chain = [a]
                while chain[-1] != self.end or len(chain) == 1:
                    ways = [
                        w for w in self.near[chain[-1]] if w == self.end or (self.crosses[w] <= limit and reaches(w))
                    ]
                    chain.append(min(ways, key=lambda w: (w != self.end, self.crosses[w], w)))
                return limit, tuple(chain)
        return Fraction(-1), None


def cases(seed: int, points: FloatArray) -> tuple[FloatArray, list[Pair]]:
    random, n = Random(seed), len(points)
    pairs = [(v, w) for v in range(n) for w in range(n) if v != w]
    pairs = random.sample(pairs, min(24, len(pairs)))
    moves = [0.0, 0.0, 0.125, -0.25] if seed % 2 else [0.0]
    lines = np.array([[*(points[v] + random.choice(moves)), *(points[w] + random.choice(moves))] for v, w in pairs])
    return lines, pairs


class Run:
    """A call of the compiled search with room for so many vertices."""

    def __init__(
        self, mesh: Mesh, links: Links, lines: FloatArray, pairs: Sequence[Pair], limits: FloatArray, room: int
    ) -> None:
        self.context: Context = mesh.context
        self.n = n = len(lines)
        self.search = empty_search(len(mesh.points))
        self.farthest, self.crosses = np.full(n, 99, dtype=np.intp), np.full((n, 2), 99.0)
        self.start, self.room = np.zeros(n + 1, dtype=np.intp), room
        self.vertices = np.full(room, 99, dtype=np.intp)
        self.arguments = (mesh.context, mesh.coordinates, links, lines, limits, np.array(pairs, dtype=np.intp))

    def go_on(self, begin: int, end: int) -> int:
        return bottleneck.find_chains(
            *self.arguments, self.search, self.farthest, self.crosses, self.start, self.vertices, begin, end
        )

    def chains(self) -> list[Chain]:
        return [tuple(self.vertices[self.start[i] : self.start[i + 1]].tolist()) for i in range(self.n)]


@pytest.mark.obligation("V1", "the chain is that of the least threshold, by the rules", method="differential")
class TestSearch:
    """Which vertex is the bottleneck, which chain, within which limit, and into how much room it fits."""

    @pytest.mark.parametrize("seed", range(6))
    def test_against_thresholds(self, seed: int) -> None:
        points, triangles = [*meshes()][seed]
        lines, pairs = cases(seed, points)
        mesh, links = linked_mesh(points, triangles, lines)
        naive = [Naive(points, triangles, line, pair) for line, pair in zip(lines, pairs, strict=True)]
        total = sum(len(known.chain or ()) for known in naive)
        run = Run(mesh, links, lines, pairs, np.full(len(lines), math.inf), total)
        assert run.go_on(0, len(lines)) == len(lines)
        assert run.chains() == [known.chain or () for known in naive]
        for i, known in enumerate(naive):
            farthest = int(run.farthest[i])
            if known.chain is None:
                assert farthest == NO_CHAIN
            elif len(known.chain) == 2:
                assert farthest == NO_VERTEX
            else:
                assert farthest >= 0
                assert known.crosses[farthest] == known.farthest
            high, error = map(Fraction, run.crosses[i])
            assert error >= high / 2**53, "no rounded product is known better"
            if farthest >= 0:
                assert high - error <= known.farthest <= high + error
            else:
                assert high == error == 0

    @pytest.mark.parametrize("seed", range(6))
    def test_in_rationals(self, seed: int) -> None:
        """The search in rationals finds the same, and nothing beyond the distance."""
        points, triangles = [*meshes()][seed]
        lines, pairs = cases(seed, points)
        _, links = linked_mesh(points, triangles, lines)
        for line, (a, b) in zip(lines, pairs, strict=True):
            known = Naive(points, triangles, line, (a, b))
            ends = line.reshape(2, 2)
            found = chain_in_rationals(points, links, ends, a, b, math.inf)
            assert (found and found.vertices) == known.chain
            if found is None or known.chain is None:
                continue
            if len(known.chain) == 2:
                assert found.farthest == -1
            else:
                assert known.crosses[found.farthest] == known.farthest
            length = oracles.squared_distance(*oracles.rationals(ends.tolist()))
            for within in (0.0, 0.25, 0.5, 1.0, 2.0):
                near = known.farthest <= 0 or known.farthest**2 <= Fraction(within) ** 2 * length
                again = chain_in_rationals(points, links, ends, a, b, within)
                assert (again and again.vertices) == (known.chain if near else None)

    @pytest.mark.parametrize("seed", range(6))
    def test_limits(self, seed: int) -> None:
        """A limit that the bottleneck meets changes nothing; below it there is no chain."""
        points, triangles = [*meshes()][seed]
        lines, pairs = cases(seed, points)
        mesh, links = linked_mesh(points, triangles, lines)
        naive = [Naive(points, triangles, line, pair) for line, pair in zip(lines, pairs, strict=True)]
        for factor in (1.0, 0.999):
            limits = np.array([float(max(known.farthest, Fraction(0))) * factor for known in naive])
            run = Run(mesh, links, lines, pairs, limits, 9 * len(lines))
            run.go_on(0, len(lines))
            lost = [factor < 1 and known.farthest > 0 for known in naive]
            assert run.chains() == [() if gone else known.chain or () for known, gone in zip(naive, lost, strict=True)]

    @pytest.mark.parametrize("room", range(0, 40, 3))
    def test_room(self, room: int) -> None:
        """Where the room ends in the middle of a chain, it is found again with more of it."""
        points, triangles = [*meshes()][1]
        lines, pairs = cases(1, points)
        mesh, links = linked_mesh(points, triangles, lines)
        chains = [Naive(points, triangles, line, pair).chain or () for line, pair in zip(lines, pairs, strict=True)]
        run = Run(mesh, links, lines, pairs, np.full(len(lines), math.inf), room)
        done, fits = run.go_on(0, len(lines)), 0
        while fits < len(lines) and sum(map(len, chains[: fits + 1])) <= room:
            fits += 1
        assert done == fits
        run.vertices = np.concatenate([run.vertices, np.zeros(900, dtype=np.intp)])
        assert run.go_on(done, len(lines) - 1) == len(lines) - 1
        assert run.go_on(len(lines) - 1, len(lines)) == len(lines)
        assert run.chains() == chains

    def test_control_ties_and_dead_ends(self) -> None:
        """In these cases other rules find other chains: the nearest vertex first of all, and the last index of many."""
        greedy = last = 0
        for seed, (points, triangles) in enumerate(meshes()):
            lines, pairs = cases(seed, points)
            for line, pair in zip(lines, pairs, strict=True):
                known = Naive(points, triangles, line, pair)
                for v, w in pairwise(known.chain or ()):
                    ways = [u for u in known.near[v] if pair[1] not in known.near[v]]
                    greedy += any(known.crosses[u] < known.crosses[w] for u in ways)
                    last += any(known.crosses[u] == known.crosses[w] and u > w for u in ways)
        assert greedy > 0
        assert last > 0
