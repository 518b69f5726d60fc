"""V1 for the cells that witnesses name, each function alone, against a look at all of them."""

from collections.abc import Iterator
from itertools import combinations, pairwise, permutations, product
from random import Random

import numpy as np
import pytest
from proofs_tests import oracles

from exactkernel.types import FloatArray
from exactmesh.verify import pairs
from exactmesh.verify.cells import Cells
from exactmesh.verify.mesh import Mesh, index_quads, index_triples, prepared_mesh

Cell = tuple[int, ...]


def heaps(quads: bool) -> Iterator[tuple[FloatArray, list[Cell]]]:
    """Convex counterclockwise cells over each other on a small grid: triangles, and some squares after them."""
    grid = [(x, y) for x in range(5) for y in range(4)]
    points = np.array(grid, dtype=np.float64)
    exact = oracles.rationals(grid)
    for seed in range(6):
        random, cells = Random(seed), list[Cell]()
        while len(cells) < 25:
            a, b, c = random.sample(range(len(grid)), 3)
            if oracles.orient(exact[a], exact[b], exact[c]) > 0:
                cells.append((a, b, c))
        if quads:
            for x, y in random.sample([*product(range(4), range(3))], 5):
                cells.append((4 * x + y, 4 * x + y + 4, 4 * x + y + 5, 4 * x + y + 1))
        yield points, cells


def prepared(points: FloatArray, cells: list[Cell]) -> tuple[Mesh, Cells]:
    triangles, quads = ([cell for cell in cells if len(cell) == n] for n in (3, 4))
    mesh, _ = prepared_mesh(points, index_triples(triangles), index_quads(quads), np.empty((0, 2)))
    return mesh, Cells(mesh.triangles, mesh.quads)


def edges_of(cell: Cell) -> list[tuple[int, int]]:
    return [(cell[i - 1], cell[i]) for i in range(len(cell))]


def overlap(points: FloatArray, one: Cell, other: Cell) -> bool:
    """Whether the interiors of convex cells meet: what is left of the one within the other has an area."""
    exact = oracles.rationals(points.tolist())
    polygon = [exact[v] for v in one]
    for a, b in edges_of(other):
        polygon = oracles.clip(polygon, exact[a], exact[b])
    return any(oracles.orient(polygon[0], p, q) for p, q in pairwise(polygon))


@pytest.mark.obligation("V1", "witnesses name the cells that a look at all finds", method="differential")
class TestPairs:
    """Who lists an edge, who overlaps a cell, who lies round a vertex: the rows, in order, triangles first."""

    @pytest.mark.parametrize("quads", [False, True])
    def test_rows_listing(self, quads: bool) -> None:
        for points, cells in heaps(quads):
            _, known = prepared(points, cells)
            every = sorted({edge for cell in cells for edge in edges_of(cell)})
            for edges in (every, every[::-1], every[3:4], [*every[::3], (19, 0), (0, 19)]):
                wanted = list(dict.fromkeys(edges))
                found = pairs.rows_listing(known, np.array(wanted, dtype=np.intp), len(points))
                assert found == [[row for row, cell in enumerate(cells) if edge in edges_of(cell)] for edge in wanted]

    @pytest.mark.parametrize("chunk", [1, 3, 4096])
    @pytest.mark.parametrize("quads", [False, True])
    def test_overlapping_row(self, quads: bool, chunk: int, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(pairs, "_CHUNK", chunk)
        alone = 0
        for points, cells in heaps(quads):
            for kept in (cells[:5] + cells[-5:], cells[:3], cells[:1]):
                mesh, known = prepared(points, kept)
                for row, cell in enumerate(kept):
                    meets = [i for i, other in enumerate(kept) if i != row and overlap(points, cell, other)]
                    if meets:
                        assert pairs.overlapping_row(mesh, known, row) == meets[0]
                        continue
                    alone += 1
                    with pytest.raises(AssertionError, match="no cell overlaps"):
                        pairs.overlapping_row(mesh, known, row)
        assert alone > 0

    def test_control_touching_is_no_overlap(self) -> None:
        """Cells that share an edge, a corner, or a part of an edge."""
        points = np.array([(x, y) for x in range(4) for y in range(4)], dtype=np.float64)
        cells = [(5, 9, 6), (10, 6, 9), (4, 8, 5), (9, 8, 12), (0, 4, 1), (6, 10, 7), (1, 6, 2)]
        mesh, known = prepared(points, [*cells, (9, 13, 14, 10)])
        with pytest.raises(AssertionError):
            pairs.overlapping_row(mesh, known, 0)

    @pytest.mark.parametrize("quads", [False, True])
    def test_part_of(self, quads: bool) -> None:
        for points, cells in heaps(quads):
            mesh, known = prepared(points, cells)
            for rows in ((0, 24), (24, len(cells) - 1), (3,), (25, 26) if quads else (1, 2)):
                part, own, vertices = pairs.part_of(mesh, known, rows)
                assert vertices.tolist() == sorted({v for row in rows for v in cells[row]})
                named = [tuple(vertices[cell].tolist()) for block in own for cell in block]
                assert named == sorted((cells[row] for row in rows), key=len)
                assert part.points.tolist() == points[vertices].tolist()
                assert part.coordinates.tolist() == mesh.coordinates[vertices].tolist()
                assert (part.triangles is own.triangles, part.quads is own.quads) == (True, True)

    @pytest.mark.parametrize("loop", [2, 1 << 17])
    def test_rows_round(self, loop: int, monkeypatch: pytest.MonkeyPatch) -> None:
        """The first triangle, turned either way, that a vertex lies in or on."""
        monkeypatch.setattr(pairs, "_LOOP", loop)
        for points, cells in heaps(False):
            few = [cell if i % 2 else cell[::-1] for i, cell in enumerate(cells[:6])]
            mesh, _ = prepared(points, few)
            exact = oracles.rationals(points.tolist())
            vertices = np.random.default_rng(len(few)).permutation(len(points))
            expected = list[int]()
            for v in vertices.tolist():
                turns = [[oracles.orient(exact[a], exact[b], exact[v]) for a, b in edges_of(cell)] for cell in few]
                expected.append(next((i for i, turn in enumerate(turns) if min(turn) >= 0 or max(turn) <= 0), -1))
            assert pairs.rows_round(mesh, vertices).tolist() == expected
            assert -1 in expected

    def test_unlinked(self) -> None:
        """Two cells with the same edge at the vertex, or with no way round the vertex from one to the other."""
        for quads in (False, True):
            for points, cells in heaps(quads):
                for kept in (cells[:6], cells[6:12], cells[-6:]):
                    self._check_unlinked(points, kept)

    @pytest.mark.parametrize(
        "fan", [((1, 2), (2, 3), (3, 1)), ((1, 2), (2, 3), (3, 6)), ((1, 2), (2, 3), (3, 6), (6, 8))]
    )
    def test_two_fans(self, fan: tuple[tuple[int, int], ...]) -> None:
        """A fan, closed or open, and a cell apart from it, in every order: one row of each is named."""
        for order in permutations([*fan, (4, 5)]):
            arcs = [(tail, head, row) for row, (tail, head) in enumerate(order)]
            assert order.index((4, 5)) in pairs._unlinked(arcs)

    @staticmethod
    def _check_unlinked(points: FloatArray, kept: list[Cell]) -> None:
        _, known = prepared(points, kept)
        arcs = {
            v: {
                row: (cell[(cell.index(v) + 1) % len(cell)], cell[cell.index(v) - 1])
                for row, cell in enumerate(kept)
                if v in cell
            }
            for v in range(len(points))
        }

        def linked(v: int, one: int, other: int) -> bool:
            """Arcs from head to tail lead from the one to the other, or back."""
            return any(_way(arcs[v], *ends) for ends in ((one, other), (other, one)))

        couples = {v: [*combinations(arcs[v], 2)] for v in arcs}
        bad = [v for v in arcs if any(not linked(v, i, j) or _same(arcs[v], i, j) for i, j in couples[v])]
        found = pairs.unlinked_rows(known, np.array(bad, dtype=np.intp), len(points))
        assert [*found] == bad
        for v, (i, j) in found.items():
            assert i != j
            assert {i, j} <= {*arcs[v]}
            clash = any(_same(arcs[v], p, q) for p, q in couples[v])
            assert _same(arcs[v], i, j) if clash else not linked(v, i, j)


def _same(arcs: dict[int, tuple[int, int]], i: int, j: int) -> bool:
    return arcs[i][0] == arcs[j][0] or arcs[i][1] == arcs[j][1]


def _way(arcs: dict[int, tuple[int, int]], one: int, other: int) -> bool:
    reached, more = {one}, [one]
    while more:
        here = more.pop()
        for row, (tail, _) in arcs.items():
            if row not in reached and tail == arcs[here][1]:
                reached.add(row)
                more.append(row)
    return other in reached
