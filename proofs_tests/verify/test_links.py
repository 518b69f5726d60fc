"""V1: the links of the vertices and what is read off them, on any list of cells, against counting."""

import sys
from collections import Counter, defaultdict
from collections.abc import Sequence
from itertools import islice, permutations

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.mesh.enumeration import grid, triangulations

from exactkernel.jit import COMPILED
from exactmesh.verify.adjacency import neighbours_of, parts_of, rows_of_slots
from exactmesh.verify.cells import Cells
from exactmesh.verify.chains import edge_slot
from exactmesh.verify.links import (
    _LOW,
    BOUNDARY,
    CROWDED,
    INNER,
    NOT_DELAUNAY,
    REPEATED,
    Links,
    Table,
    ends_of,
    linked,
    match_slots,
    place_slots,
    slot_of,
    slots_of,
    sort_bucket,
)
from exactmesh.verify.local import localized
from exactmesh.verify.manifold import check_edges, check_fans, find_broken_fans
from exactmesh.verify.mesh import Mesh, index_quads, index_triples, prepared_mesh
from exactmesh.verify.properties import Kind, Verdict

#: No three on a line; many on one circle.
PLACES = [(5, 0), (3, 4), (-3, 4), (-5, 0), (0, -5), (4, -3), (1, 1), (-2, 2)]

Cell = tuple[int, ...]


def module(name: str) -> object:
    return sys.modules[f"exactmesh.verify.{name}"]


def mesh_of(points: Sequence[tuple[float, float]], cells: Sequence[Cell]) -> Mesh:
    """A mesh of triangles and quadrilaterals, in that order."""
    triangles, quads = index_triples([c for c in cells if len(c) == 3]), index_quads([c for c in cells if len(c) == 4])
    return prepared_mesh(np.array(points, dtype=np.float64), triangles, quads, np.empty((0, 2)))[0]


def links_of(mesh: Mesh) -> Links:
    return linked(len(mesh.points), mesh.context, localized(mesh.coordinates, mesh.triangles, mesh.quads))


def cells_of(mesh: Mesh) -> list[Cell]:
    return [mesh.corners(row) for row in range(mesh.size)]


def arcs_of(cells: Sequence[Cell]) -> list[tuple[int, int, int]]:
    """(v, b, c) for each corner v of each cell: the edge v -> b, and c -> v."""
    return [(cell[i], cell[(i + 1) % len(cell)], cell[i - 1]) for cell in cells for i in range(len(cell))]


def lists(count: int, width: int, most: int) -> list[list[Cell]]:
    """Lists of chance triangles, or quadrilaterals, of few points: many edges are repeated, or crowded."""
    random = np.random.default_rng(width)
    sizes = random.integers(1, most + 1, count).tolist()
    n = len(PLACES)
    return [[tuple(random.permutation(n)[:width].tolist()) for _ in range(size)] for size in sizes]


LISTS = [*lists(60, 3, 4), *lists(60, 3, 14), *lists(20, 3, 60), *lists(25, 4, 6)]
LISTS += [one + other for one, other in zip(lists(25, 3, 8), lists(25, 4, 5), strict=True)]
#: Two closed fans round one vertex, without a boundary.
TWO_FANS: list[Cell] = [(0, 1, 2), (0, 2, 3), (0, 3, 1), (0, 4, 5), (0, 5, 6), (0, 6, 4)]
LISTS += 3 * [TWO_FANS]
LISTS += [list(t) for t in islice(triangulations(PLACES), 0, None, 3)]


def is_in_circle(v: int, b: int, c: int, x: int) -> bool:
    """Whether the determinant is positive, for the triangle as it is turned."""
    exact = oracles.rationals(PLACES)
    centre, radius = oracles.circumcircle(exact[v], exact[b], exact[c])
    turn = oracles.orient(exact[v], exact[b], exact[c])
    return turn * (radius - oracles.squared_distance(centre, exact[x])) > 0


def expected_kinds(cells: Sequence[Cell]) -> Counter[tuple[int, int, int]]:
    """(v, b, kind) of each slot, by counting."""
    arcs = arcs_of(cells)
    out, into = defaultdict(list), defaultdict(list)
    for v, b, c in arcs:
        out[v, b].append(c)
        into[v, c].append(b)  # the triangle lists c -> v
    kinds: Counter[tuple[int, int, int]] = Counter()
    for (v, b), thirds in out.items():
        kinds[v, b, REPEATED] += len(thirds) - 1
        back = into[v, b]
        kind = (BOUNDARY, INNER, CROWDED)[min(len(back), 2)]
        circles = all(len(cell) == 3 for cell in cells) and len(thirds) == 1 and v < b
        if kind == INNER and circles and back[0] != thirds[0] and is_in_circle(v, b, thirds[0], back[0]):
            kind = NOT_DELAUNAY
        kinds[v, b, kind] += 1
    return +kinds


def found_kinds(links: Links) -> Counter[tuple[int, int, int]]:
    found = Counter[tuple[int, int, int]]()
    for kind in (INNER, BOUNDARY, REPEATED, CROWDED, NOT_DELAUNAY):
        v, b, _ = ends_of(links, slots_of(links, kind))
        found.update(zip(v.tolist(), b.tolist(), [kind] * len(v), strict=True))
    return found


@pytest.mark.obligation("V1", "each slot says what counting says, whatever is listed", method="differential")
class TestKinds:
    """In any list of triangles and quadrilaterals each directed edge has a slot for each cell that lists it: one says
    INNER, BOUNDARY or CROWDED by how many cells list its reverse, or NOT_DELAUNAY by the circle, the others REPEATED.
    From whatever number of edges on a vertex counts as large, and whatever the table held before."""

    @pytest.fixture(autouse=True, params=[2, 3, 8, 64])
    def large(self, request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> int:
        if COMPILED:  # a compiled function keeps its constants
            return 64
        monkeypatch.setattr(module("links"), "_LARGE", request.param)
        return int(request.param)

    def test_any_list(self, large: int) -> None:
        for cells in LISTS:
            mesh = mesh_of(PLACES, cells)
            links, cells = links_of(mesh), cells_of(mesh)
            assert found_kinds(links) == expected_kinds(cells)
            everything = ends_of(links, np.arange(len(links.slots)))
            triples = list(zip(*(ends.tolist() for ends in everything), strict=True))
            assert Counter(triples) == Counter(arcs_of(cells))
            for v in range(len(PLACES)):
                bucket = triples[links.first[v] : links.last[v]]
                assert [u for u, _, _ in bucket] == [v] * sum(v in cell for cell in cells)
                if len(bucket) >= large:
                    assert [b for _, b, _ in bucket] == sorted(b for _, b, _ in bucket)

    def test_any_table(self, large: int) -> None:
        """Nothing that the table held before is trusted."""
        random = np.random.default_rng(large)
        for cells in LISTS[::5]:
            mesh = mesh_of(PLACES, cells)
            local = localized(mesh.coordinates, mesh.triangles, mesh.quads)
            links = linked(len(PLACES), mesh.context, local)
            first = np.append(links.starts, len(links.slots))
            number = np.full(len(PLACES), -1)
            number[links.order] = np.arange(len(links.order))
            slots = (number[links.slots >> 32].astype(np.int64) << 32) | number[links.slots & _LOW]
            degree = int(np.diff(first).max())
            for _ in range(3):
                place = random.integers(0, degree, len(links.order)).astype(np.int32)
                table = Table(place, random.random((degree, 2)))
                kinds = np.full(len(slots), BOUNDARY, dtype=np.int8)
                again = slots.copy()
                match_slots(mesh.context, local, first, again, kinds, table, 0, len(links.order))
                assert Counter(zip(again.tolist(), kinds.tolist(), strict=True)) == Counter(
                    zip(slots.tolist(), links.kinds.tolist(), strict=True)
                )

    def test_control_an_edge_turned_round(self) -> None:
        """Of two triangles at an edge one turned round: their edges are no longer INNER."""
        good, bad = mesh_of(PLACES, [(0, 1, 2), (0, 2, 3)]), mesh_of(PLACES, [(0, 1, 2), (0, 3, 2)])
        assert found_kinds(links_of(good)) != found_kinds(links_of(bad))
        assert found_kinds(links_of(bad))[0, 2, BOUNDARY] == 0

    def test_a_piece_at_a_time(self, monkeypatch: pytest.MonkeyPatch) -> None:
        for size in (1, 2, 3):
            monkeypatch.setattr(module("links"), "_CHUNK", size)
            for cells in LISTS[::9]:
                mesh = mesh_of(PLACES, cells)
                assert found_kinds(links_of(mesh)) == expected_kinds(cells_of(mesh))


@pytest.mark.obligation(
    "V1", "a bucket is sorted and searched within its bounds", method="enumeration", control_in="mutants"
)
class TestBuckets:
    """sort_bucket sorts just its bucket; place_slots tells whether an edge occurs twice in it; slot_of finds the first
    slot of an edge in it, sorted or, below the bound, not, and none of the buckets beside it."""

    @pytest.mark.parametrize("n", [0, 1, 2, 3, 4])
    def test_sort_and_place(self, n: int) -> None:
        for before in (0, 3):
            for bucket in {tuple(row[:n]) for row in permutations([1, 1, 2, 3], 4)}:
                slots = np.array([*[9, 9, 9][:before], *bucket, -7, 0], dtype=np.int64) << 32
                table = Table(np.full(10, 2, dtype=np.int32), np.empty((4, 2)))
                points = np.arange(20.0).reshape(10, 2)
                twice = place_slots(points, slots, before, before + n, table)
                assert bool(twice) is (len(set(bucket)) < n)
                for i, b in enumerate(bucket):
                    assert table.near[i].tolist() == [2 * b, 2 * b + 1]
                    assert bucket[table.place[b]] == b
                sort_bucket(slots, before, before + n)
                assert (slots >> 32).tolist() == [*[9, 9, 9][:before], *sorted(bucket), -7, 0]

    @pytest.mark.parametrize("n", [0, 1, 2, 5, 62, 63, 64, 65, 66, 200])
    @pytest.mark.parametrize("before", [0, 1, 70])
    def test_slot_of(self, n: int, before: int) -> None:
        random = np.random.default_rng(n)
        for spread in (3, 40, 1000):
            ends = np.sort(random.integers(0, spread, n))
            if n < 64:
                ends = random.permutation(ends)
            for b in {*range(min(spread, 45)), *ends.tolist(), spread + 5}:
                around = np.full(before, b), np.full(9, b)
                slots = (np.concatenate([around[0], ends, around[1]]).astype(np.int64) << 32) | 5
                expected = next((before + i for i in range(n) if ends[i] == b), -1)
                assert slot_of(slots, before, before + n, b) == expected


def naive_parts(across: Sequence[Sequence[int]]) -> list[set[int]]:
    parts = [{t} for t in range(len(across))]
    for t, row in enumerate(across):
        for s in row:
            if s >= 0:
                one, other = (next(part for part in parts if u in part) for u in (s, t))
                if one is not other:
                    parts.remove(other)
                    one |= other
    return parts


@pytest.mark.obligation(
    "V1",
    "rows across edges, and the parts they leave connected, are those of a search",
    method="enumeration",
    control_in="mutants",
)
class TestAdjacency:
    """Each slot's row is that of the cell that lists its edge; the row across an edge that of the cell that lists its
    reverse, unless a mark separates them; the parts are those that a merging of sets finds. However few at a time."""

    @pytest.mark.parametrize("size", [1, 2, 3, 5, None])
    def test_triangulations(self, size: int | None, monkeypatch: pytest.MonkeyPatch) -> None:
        if size is not None:
            monkeypatch.setattr(module("adjacency"), "_CHUNK", size)
        random = np.random.default_rng(size or 0)
        points = grid(3, 3)
        for rows in islice(triangulations(points), (size or 0) % 3, None, 7):
            keep = random.random(len(rows)) < 0.8
            keep[0] = True
            cells = [t for t, kept in zip(rows, keep, strict=True) if kept]
            mesh = mesh_of(points, cells)
            links = links_of(mesh)
            owner = {(v, b): t for t, cell in enumerate(cells) for v, b, _ in arcs_of([cell])}
            found = rows_of_slots(links, mesh.triangles)
            v, b, _ = ends_of(links, np.arange(len(links.slots)))
            assert found.tolist() == [owner[pair] for pair in zip(v.tolist(), b.tolist(), strict=True)]
            marks = np.zeros(len(links.slots), dtype=np.uint8)
            marked = {}
            for pair in owner:
                if pair[::-1] not in marked:
                    marked[pair] = int(random.integers(0, 4))
                    marks[edge_slot(links, *pair)] = marked[pair]
            for bits in range(4):
                across = neighbours_of(links, mesh.triangles, found, marks, bits)
                for t, cell in enumerate(cells):
                    for i in range(3):
                        pair = cell[i], cell[(i + 1) % 3]
                        back = (pair[1], pair[0])
                        cut = bits & marked.get(pair, marked.get(back, 0))
                        assert across[t, i] == (-1 if cut else owner.get(back, -1))
                part, count = parts_of(across)
                expected = naive_parts(across.tolist())
                assert count == len(expected)
                named = [{t for t in range(len(cells)) if part[t] == name} for name in range(count)]
                assert named == sorted(expected, key=min)

    @pytest.mark.parametrize("m", [0, 1, 2, 3])
    def test_none_across(self, m: int) -> None:
        part, count = parts_of(np.full((m, 3), -1, dtype=np.int32))
        assert (part.tolist(), count) == (list(range(m)), m)

    @pytest.mark.parametrize("size", [1, 2, 1 << 18])
    def test_with_quads(self, size: int, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(module("adjacency"), "_CHUNK", size)
        points = [(x, y) for x in range(4) for y in range(3)]
        quads = [(v, v + 3, v + 4, v + 1) for v in (0, 1, 3, 4)]
        cells: list[Cell] = [(6, 9, 10), (6, 10, 7), *quads]
        mesh = mesh_of(points, cells)
        links = links_of(mesh)
        owner = {(v, b): t for t, cell in enumerate(cells) for v, b, _ in arcs_of([cell])}
        v, b, _ = ends_of(links, np.arange(len(links.slots)))
        found = rows_of_slots(links, mesh.triangles, mesh.quads)
        assert found.tolist() == [owner[pair] for pair in zip(v.tolist(), b.tolist(), strict=True)]


def broken_vertices(cells: Sequence[Cell]) -> set[int]:
    """The vertices round which the cells do not form one fan."""
    opposite = defaultdict(list)
    for v, b, c in arcs_of(cells):
        opposite[v].append((b, c))
    return {v for v, edges in opposite.items() if not oracles.is_one_fan(edges)}


@pytest.mark.obligation(
    "V1", "edges that occur twice and broken fans are those of a search", method="differential", control_in="mutants"
)
class TestManifold:
    """EDGE_MANIFOLD fails once for each directed edge that is listed more than once, and names the first two cells;
    VERTEX_MANIFOLD once for each vertex round which the cells form no single fan. However few at a time."""

    @pytest.mark.parametrize("size", [1, 2, 3, None])
    def test_fans(self, size: int | None, monkeypatch: pytest.MonkeyPatch) -> None:
        if size is not None:
            monkeypatch.setattr(module("manifold"), "_CHUNK", size)
        seen = set()
        for cells in LISTS[(size or 0) % 3 :: 2]:
            mesh = mesh_of(PLACES, cells)
            links, rows = links_of(mesh), cells_of(mesh)
            broken = np.zeros(len(PLACES), dtype=np.bool_)
            find_broken_fans(links, 0, len(links.order), broken)
            assert set(np.flatnonzero(broken).tolist()) == broken_vertices(rows)
            finding = check_fans(mesh, Cells(mesh.triangles, mesh.quads), links)
            assert (finding.verdict is Verdict.HOLDS) is not bool(broken.any())
            assert finding.count == broken.sum()
            seen.add(min(int(broken.sum()), 2))
        assert seen == {0, 1, 2}

    def test_edges(self) -> None:
        for cells in LISTS[::2]:
            mesh = mesh_of(PLACES, cells)
            rows = cells_of(mesh)
            listing = defaultdict(list)
            for row, cell in enumerate(rows):
                for v, b, _ in arcs_of([cell]):
                    listing[v, b].append(row)
            expected = {edge: found for edge, found in listing.items() if len(found) > 1}
            finding = check_edges(mesh, Cells(mesh.triangles, mesh.quads), links_of(mesh))
            assert finding.count == len(expected)
            for violation in finding.violations:
                edge = violation.vertices
                assert violation.kind is Kind.REPEATED_EDGE
                assert violation.triangles == tuple(expected[edge[0], edge[1]][:2])
                more = len(expected[edge[0], edge[1]]) - 2
                first, second = violation.triangles
                start = (
                    f"{mesh.noun}s {first}, {second} and {more} more lie"
                    if more
                    else f"{mesh.noun}s {first}, {second} lie"
                )
                assert violation.message.startswith(start)


@pytest.mark.obligation("V1", "local numbers are a renaming", method="differential", control_in="mutants")
class TestLocal:
    """Corners are numbered as the list comes upon them, triangles first; the local cells and points, renamed back, are
    the cells and their points."""

    def test_renaming(self) -> None:
        for cells in LISTS:
            mesh = mesh_of(PLACES, cells)
            local = localized(mesh.coordinates, mesh.triangles, mesh.quads)
            coming = list(dict.fromkeys([*mesh.triangles.ravel().tolist(), *mesh.quads.ravel().tolist()]))
            assert local.order.tolist() == coming
            assert (local.points == mesh.coordinates[local.order]).all()
            assert (local.order[local.triangles] == mesh.triangles).all()
            assert (local.order[local.quads] == mesh.quads).all()
