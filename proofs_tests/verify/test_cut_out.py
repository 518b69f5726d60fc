"""V2 for what a violation names: rows of the input in messages, and the same rows cut out as a mesh."""

from itertools import product

import numpy as np
import pytest

from exactkernel import ShapeError
from exactmesh.verify import Finding, Kind, Property, Verdict, Violation, mesh
from exactmesh.verify.checked import CheckedMesh
from exactmesh.verify.mesh import _MAX_POINTS, check_finite, check_indices, index_quads, index_triples, points_of
from exactmesh.verify.submesh import cut_out, with_numbers

TRIANGLES = index_triples([(0, 1, 2), (1, 1, 2), (0, 2, 4)])
QUADS = index_quads([(0, 1, 2, 3), (-1, 1, 2, 3), (3, 1, 2, 3), (0, 1, 2, 7)])


@pytest.mark.obligation(
    "V3",
    "an unreadable cell is told with its row, its corners, and what is wrong",
    method="named cases",
    control_in="mutants",
)
class TestMessages:
    """Rows count triangles first; a quadrilateral is called so; the range is that of the points."""

    def test_indices(self) -> None:
        finding = check_indices(TRIANGLES, QUADS, 4)
        assert [(v.kind, v.triangles, v.message) for v in finding.violations] == [
            (Kind.REPEATED_CORNER, (1,), "triangle 1 (1, 1, 2) repeats a corner"),
            (Kind.OUT_OF_RANGE, (2,), "triangle 2 (0, 2, 4) has an index outside 0 .. 3"),
            (Kind.OUT_OF_RANGE, (4,), "cell 4, the quadrilateral (-1, 1, 2, 3) has an index outside 0 .. 3"),
            (Kind.REPEATED_CORNER, (5,), "cell 5, the quadrilateral (3, 1, 2, 3) repeats a corner"),
            (Kind.OUT_OF_RANGE, (6,), "cell 6, the quadrilateral (0, 1, 2, 7) has an index outside 0 .. 3"),
        ]
        (first,) = check_indices(TRIANGLES[:0], QUADS[1:2], 4).violations
        assert first.message == "cell 0, the quadrilateral (-1, 1, 2, 3) has an index outside 0 .. 3"

    @pytest.mark.parametrize("n", [1, 2, 3, 4])
    def test_all_small_triples(self, n: int) -> None:
        """Every triple of indices from -1 to n: the kind is what counting says, out of range before repeated."""
        rows = index_triples([*product(range(-1, n + 1), repeat=3)])
        for row, corners in enumerate(rows.tolist()):
            kind = next((v.kind for v in check_indices(rows[row : row + 1], QUADS[:0], n).violations), None)
            outside = any(not 0 <= v < n for v in corners)
            repeated = len({*corners}) < 3
            assert kind is (Kind.OUT_OF_RANGE if outside else Kind.REPEATED_CORNER if repeated else None)

    def test_largest_index(self) -> None:
        """Cells are kept in 32 bits: the last of as many points as there may be is the largest number there."""
        assert np.iinfo(np.int32).max == _MAX_POINTS - 1
        assert points_of([]).shape == (0, 2)

    def test_as_many_points_as_there_may_be(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(mesh, "_MAX_POINTS", 3)
        assert len(points_of([(0, 0), (1, 0), (2, 0)])) == 3
        with pytest.raises(ShapeError, match="4 points; at most"):
            points_of([(0, 0), (1, 0), (2, 0), (3, 0)])

    def test_finite(self) -> None:
        points = np.array([(0.0, 1.0), (np.inf, 0.0), (0.0, np.nan), (1e308, 1e308), (1e308, 1e308)])
        assert [v.vertices for v in check_finite(points).violations] == [(1,), (2,)]
        assert check_finite(points[3:]).count == 0


CELLS = [*TRIANGLES.tolist(), *QUADS.tolist()]


def violation(cells: tuple[int, ...], vertices: tuple[int, ...] = ()) -> Violation:
    whole = CheckedMesh(np.arange(8.0).reshape(4, 2), TRIANGLES, QUADS)
    named = Violation(Property.INDICES, Kind.OUT_OF_RANGE, cells, vertices, "")
    return with_numbers(Finding(Verdict.FAILS, 1, (named,)), whole).violations[0]


@pytest.mark.obligation(
    "V3",
    "what is cut out is the rows that were named, whatever their indices are",
    method="enumeration",
    control_in="mutants",
)
class TestCutOut:
    """Points in range are renumbered in their order; of other indices those below zero stay below, those beyond stay
    beyond, and different ones stay different."""

    @pytest.mark.parametrize("rows", [*product(range(7), repeat=2)])
    def test_pairs(self, rows: tuple[int, int]) -> None:
        part = cut_out(violation(tuple(dict.fromkeys(rows)), (3, 9, -5)))
        named = {3, 9, -5} | {v for row in rows for v in CELLS[row]}
        assert part.indices == tuple(sorted(v for v in named if 0 <= v < 4))
        assert part.points.tolist() == [[2.0 * v, 2.0 * v + 1] for v in part.indices]
        found = [*part.triangles.tolist(), *part.quads.tolist()]
        assert len(found) == len(part.cells) == len({*rows})
        assert sorted(part.cells, key=lambda row: row >= 3) == list(part.cells)
        numbers = dict[int, int]()
        for row, cell in zip(part.cells, found, strict=True):
            for v, new in zip(CELLS[row], cell, strict=True):
                assert numbers.setdefault(v, new) == new
        assert len({*numbers.values()}) == len(numbers)
        for v, new in numbers.items():
            if v < 0:
                assert new < 0
            elif v < 4:
                assert part.indices[new] == v
            else:
                assert new >= len(part.indices)

    def test_no_points(self) -> None:
        """Of no points every index is out of range, and 0 is not below them."""
        whole = CheckedMesh(np.zeros((0, 2)), index_triples([(0, 1, -1)]), QUADS[:0])
        named = Violation(Property.INDICES, Kind.OUT_OF_RANGE, (0,), (), "")
        part = cut_out(with_numbers(Finding(Verdict.FAILS, 1, (named,)), whole).violations[0])
        (a, b, c) = part.triangles[0].tolist()
        assert min(a, b) >= 0 > c
        assert a != b

    def test_many_out_of_range(self) -> None:
        """Five indices below zero and four beyond: nine numbers, as many on either side."""
        whole = CheckedMesh(np.zeros((1, 2)), index_triples([(-1, -2, -3), (1, 2, 3), (-4, -5, 4)]), QUADS[:0])
        named = Violation(Property.INDICES, Kind.OUT_OF_RANGE, (0, 1, 2), (0,), "")
        part = cut_out(with_numbers(Finding(Verdict.FAILS, 1, (named,)), whole).violations[0])
        numbers = part.triangles.ravel().tolist()
        assert len({*numbers}) == 9
        assert [v < 0 for v in numbers] == [True] * 3 + [False] * 3 + [True] * 2 + [False]
        assert all(v < 0 or v >= 1 for v in numbers)
