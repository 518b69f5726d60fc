"""ARR: which segments meet, and the planar graph that they become, against brute force in fractions."""

import math
from collections import Counter
from fractions import Fraction
from itertools import combinations, pairwise

import numpy as np
import pytest
from gmpy2 import mpq
from hypothesis import given
from proofs_tests.graphs import crossing_oracle as oracle
from proofs_tests.graphs.crossing_strategies import SEVEN, Drawing, bundle, drawings, near_bundles
from proofs_tests.oracles import RationalPoint, rationals

from exactkernel.types import FloatArray
from exactmesh import PSLG
from exactmesh.coincident import first_of_each, lexicographic_order
from exactmesh.crossings import Arrangement, Rounding, arrange, find_crossings, memory, nearby, planar
from exactmesh.crossings.chains import pieces_of
from exactmesh.crossings.crossing_points import CrossingRounder
from exactmesh.crossings.noding import Drawing as Noded
from exactmesh.crossings.noding import drawing_of
from exactmesh.crossings.snapping import grid_of, snapped
from exactmesh.errors import DegenerateError, NonFiniteError, ShapeError, TooManyCrossingsError, TopologyError

#: The bundles of the corpus that noding does not make planar, so that they are snapped.
SNAPPED_BUNDLES = {26}


def found(
    points: FloatArray | list[tuple[float, float]], segments: list[tuple[int, int]]
) -> list[tuple[int, int, int]]:
    pairs = find_crossings(points, segments)
    return [(i, j, kind) for (i, j), kind in zip(pairs.pairs.tolist(), pairs.kinds.tolist(), strict=True)]


@pytest.mark.obligation(
    "ARR1", "the pairs of segments that meet, and how, are those of brute force", method="property-based"
)
class TestPairs:
    """find_crossings returns exactly the pairs that meet elsewhere than in an end of both, each with its kind."""

    @given(drawings())
    def test_small_drawings(self, drawing: Drawing) -> None:
        points, segments = drawing
        assert found(points, segments) == oracle.true_pairs(points, segments)

    @pytest.mark.parametrize("seed", range(4))
    def test_many_segments_of_a_grid(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        points = rng.integers(0, 9, (80, 2)).astype(np.float64)
        pairs = [(i, i + 1) for i in range(79) if (points[i] != points[i + 1]).any()]
        assert found(points, pairs) == oracle.true_pairs(points.tolist(), pairs)

    @pytest.mark.parametrize("size", [1e-3, 0.1, 1.0])
    def test_cells_and_clipping(self, size: float) -> None:
        rng = np.random.default_rng(5)
        begins = rng.random((150, 2)) + 1e6
        points = np.concatenate([begins, begins + size * rng.normal(size=(150, 2))])
        segments = [(i, i + 150) for i in range(150)]
        assert found(points, segments) == oracle.true_pairs(points.tolist(), segments)

    def test_wheels_stacks_and_bundles(self) -> None:
        rng = np.random.default_rng(7)
        angles = rng.random(100) * 7.0
        rim = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        wheel = np.concatenate([[[0.3, 0.3]], rim])
        assert found(wheel, [(0, i + 1) for i in range(100)]) == []
        stack = np.concatenate(
            [np.arange(100)[:, None] * [-0.001, 0.002], np.arange(100)[:, None] * [-0.001, 0.002] + [2, 1]]
        )
        assert found(stack, [(i, i + 100) for i in range(100)]) == []
        through = np.concatenate([0.3 - rim, 0.3 + rim])
        segments = [(i, i + 100) for i in range(100)]
        assert found(through, segments) == oracle.true_pairs(through.tolist(), segments)

    def test_control_a_pair_left_out_is_noticed(self) -> None:
        """A pair of crossing segments left out; overlaps, touches and common ends taken for each other."""
        points, segments = SEVEN.tolist(), [(0, 1), (2, 3), (4, 5)]
        assert found(points, segments[:2]) != oracle.true_pairs(points, segments)
        assert oracle.true_pairs([(0, 0), (2, 0), (1, 0), (3, 0)], [(0, 1), (2, 3)]) == [(0, 1, oracle.OVERLAP)]
        assert oracle.true_pairs([(0, 0), (2, 0), (1, 0), (1, 1)], [(0, 1), (2, 3)]) == [(0, 1, oracle.TOUCH)]
        assert oracle.true_pairs([(0, 0), (2, 0), (2, 0), (3, 0)], [(0, 1), (2, 3)]) == []


@pytest.mark.obligation(
    "ARR2", "a crossing goes to the nearest doubles, or into its own grid cell", method="property-based"
)
class TestRounding:
    """What is certified in double-double, and what the rationals decide, is the nearest double and the right cell."""

    @staticmethod
    def crossings(drawing: Drawing) -> tuple[FloatArray, list[tuple[int, int]], list[RationalPoint]]:
        points, segments = drawing
        exact = rationals(points)
        ends = [(exact[a], exact[b]) for a, b in segments]
        pairs = [(i, j) for i, j in combinations(range(len(ends)), 2) if oracle.proper_crossing(ends[i], ends[j])]
        crossings = [oracle.proper_crossing(ends[i], ends[j]) for i, j in pairs]
        return np.array(points), pairs, [p for p in crossings if p is not None]

    @given(drawings())
    def test_nearest_and_cells(self, drawing: Drawing) -> None:
        points, pairs, crossings = self.crossings(drawing)
        if not pairs:
            return
        segments = np.array(drawing[1], dtype=np.int32)
        first, second = np.array(pairs, dtype=np.int32).T.copy()
        for p, exact in zip(CrossingRounder(points, segments)(first, second).tolist(), crossings, strict=True):
            assert oracle.is_nearest(p[0], exact[0])
            assert oracle.is_nearest(p[1], exact[1])
        grid = grid_of(points)
        cells = CrossingRounder(points, segments, grid)(first, second).astype(np.int64).tolist()
        assert [tuple(cell) for cell in cells] == [oracle.pixel(p, grid) for p in crossings]

    def test_control_a_neighbour_is_not_the_nearest(self) -> None:
        """The double beside the nearest one."""
        exact = Fraction(1, 3)
        assert oracle.is_nearest(1 / 3, exact)
        assert not oracle.is_nearest(float(np.nextafter(1 / 3, 1.0)), exact)
        assert oracle.pixel((Fraction(1, 2), Fraction(-1, 2)), (1.0, 1.0)) == (1, 0)


def fraction(value: mpq) -> Fraction:
    return Fraction(int(value.numerator), int(value.denominator))


def faults(a: Arrangement) -> list[str]:
    """Return what is wrong with an arrangement, by brute force."""
    wrong = []
    points, exact = a.pslg.points, rationals(a.pslg.points.tolist())
    n = len(a.source.points)
    if not oracle.is_planar(points.tolist(), a.pslg.segments.tolist()):
        wrong.append("not planar")
    if a.rounding is not Rounding.SNAPPED and not np.array_equal(points[:n], a.source.points):
        wrong.append("a point of the input moved")
    edges = {frozenset(s) for s in a.pslg.representative[a.pslg.segments].tolist()}
    limit = (Fraction(a.grid[0]) ** 2 + Fraction(a.grid[1]) ** 2) / 4
    given = rationals(a.source.points.tolist())
    covered = []
    for i, (p, q) in enumerate(a.source.segments.tolist()):
        chain = a.pslg.representative[a.chain(i)].tolist()
        if [chain[0], chain[-1]] != a.pslg.representative[[p, q]].tolist() or len(set(chain)) != len(chain):
            wrong.append(f"chain {i} does not lead from end to end")
        covered += [(frozenset(e), i) for e in pairwise(chain)]
        farthest = max(oracle.distance_squared(exact[v], (given[p], given[q])) for v in chain)
        if farthest != fraction(a.distance_squared[i]):
            wrong.append(f"distance of chain {i}")
        if farthest > limit:
            wrong.append(f"chain {i} is too far")
    rows = a.pslg.representative[a.pslg.segments].tolist()
    told = [(frozenset(rows[piece]), segment) for piece, segment in a.incidence.tolist()]
    if Counter(told) != Counter(covered) or {edge for edge, _ in covered} != edges:
        wrong.append("incidence")
    return wrong


@pytest.mark.obligation(
    "ARR3",
    "the rounded arrangement is planar, within its stated distance, and noding it changes nothing",
    method="property-based",
)
class TestArrangement:
    """Whatever the segments: the result is planar by brute force; every chain leads along its segment, within half the
    diagonal of the grid's cells, at exactly the stated distance; the points of the input stay unless some are snapped;
    and arranging the result changes nothing, bit for bit."""

    @given(drawings())
    def test_small_drawings(self, drawing: Drawing) -> None:
        arranged = arrange(PSLG(*drawing))
        assert faults(arranged) == []
        again = arrange(arranged.pslg)
        assert again.pslg == arranged.pslg
        assert again.rounding is Rounding.EXACT
        assert (again.crossings, again.grid) == (0, (0.0, 0.0))

    @given(near_bundles())
    def test_vertices_are_those_of_brute_force(self, drawing: Drawing) -> None:
        """Where one round was enough, the new vertices are the crossings, rounded to the nearest doubles."""
        points, segments = drawing
        exact = rationals(points)
        ends = [(exact[a], exact[b]) for a, b in segments]
        crossings = {p for s, t in combinations(ends, 2) if (p := oracle.proper_crossing(s, t)) is not None}
        nearest = {(float(p[0]), float(p[1])) for p in crossings}
        is_exact = all((Fraction(float(x)), Fraction(float(y))) == (x, y) for x, y in crossings)
        arranged = arrange(PSLG(points, segments))
        if arranged.rounding is Rounding.EXACT:
            assert is_exact
        if arranged.rounding is Rounding.SNAPPED:
            return
        new = {(x, y) for x, y in arranged.pslg.points[len(points) :].tolist()}
        assert nearest <= new | set(points)
        assert arranged.crossings == len(nearest)

    def test_number_seven_of_the_corpus(self) -> None:
        arranged = arrange(PSLG(SEVEN, [(0, 1), (2, 3), (4, 5)]))
        assert faults(arranged) == []
        assert arranged.rounding is Rounding.NEAREST

    def test_near_concurrent_bundles_of_the_corpus(self) -> None:
        snapped = set()
        for seed in range(150):
            arranged = arrange(PSLG(*bundle(seed)))
            assert faults(arranged) == [], seed
            if arranged.rounding is Rounding.SNAPPED:
                snapped.add(seed)
        assert snapped == SNAPPED_BUNDLES

    def test_control_rounding_alone_is_not_planar(self) -> None:
        """Bundle 0 of the corpus: its crossings, each the nearest double, in their order, make pieces that meet."""
        points, segments = bundle(0)
        exact = rationals(points.tolist())
        ends = [(exact[a], exact[b]) for a, b in segments]
        chains: list[list[tuple[Fraction, tuple[float, float]]]] = []
        for s in ends:
            axis = 0 if s[0][0] != s[1][0] else 1
            sign = 1 if s[0][axis] < s[1][axis] else -1
            crossings = [p for t in ends if (p := oracle.proper_crossing(s, t)) is not None]
            chains.append(sorted((sign * p[axis], (float(p[0]), float(p[1]))) for p in [*s, *crossings]))
        vertices = sorted({p for chain in chains for _, p in chain})
        pieces = {
            (vertices.index(p), vertices.index(q)) for chain in chains for (_, p), (_, q) in pairwise(chain) if p != q
        }
        assert not oracle.is_planar(vertices, sorted(pieces))

    def test_control_wrong_arrangements_are_noticed(self) -> None:
        """Segments left unsplit, a point moved, a chain too far away, a row of the incidence lost."""
        square = PSLG([(0, 0), (4, 4), (0, 4), (4, 0), (2, 2)], [(0, 1), (2, 3)])
        good = arrange(square)
        assert faults(good) == []
        fields = {name: getattr(good, name) for name in good.__dataclass_fields__}
        unsplit = Arrangement(**{**fields, "pslg": square, "incidence": np.array([[0, 0], [1, 1]])})
        assert "not planar" in faults(unsplit)
        moved = good.pslg.points.copy()
        moved[4] = (2.0, 2.5)
        far = PSLG(moved, good.pslg.segments)
        assert {"a point of the input moved", "chain 0 is too far"} <= set(
            faults(Arrangement(**{**fields, "pslg": far}))
        )
        assert "incidence" in faults(Arrangement(**{**fields, "incidence": good.incidence[1:]}))


@pytest.mark.obligation(
    "ARR4",
    "snap rounding is that of brute force: hot pixels, and chains through all that a segment meets",
    method="property-based",
)
class TestSnapping:
    """Of any drawing: the vertices are the centres of the pixels with a point or a crossing in them, and each chain
    leads through exactly the hot pixels that its segment meets; the result is planar."""

    @staticmethod
    def snapped(points: FloatArray, segments: list[tuple[int, int]]) -> Noded:
        representative = first_of_each(points, lexicographic_order(points))
        ends = representative[np.array(segments, dtype=np.int32).reshape(-1, 2)]
        drawing = drawing_of(points, ends, representative)
        rows = np.arange(len(drawing.segments))
        return snapped(drawing, np.ones(len(rows), dtype=np.bool_), rows, grid_of(points))[0]

    @given(drawings())
    def test_small_drawings(self, drawing: Drawing) -> None:
        points, segments = np.array(drawing[0]), drawing[1]
        if not segments:
            return
        whole, grid = self.snapped(points, segments), grid_of(points)
        chains = whole.chains(np.arange(len(segments)))
        exact = rationals(points.tolist())
        ends = [(exact[a], exact[b]) for a, b in segments]
        crossings = [p for s, t in combinations(ends, 2) if (p := oracle.proper_crossing(s, t)) is not None]
        hot = {oracle.pixel(p, grid) for p in [*exact, *crossings]}
        cells = [oracle.pixel(p, grid) for p in rationals(whole.points.tolist())]
        assert set(cells) == hot
        for i, s in enumerate(ends):
            chain = chains.vertices[chains.start[i] : chains.start[i + 1]].tolist()
            met = {cell for cell in hot if oracle.segment_meets_pixel(s, cell, grid)}
            assert {cells[v] for v in chain} == met
            assert len(chain) == len(met)
        assert oracle.is_planar(whole.points.tolist(), pieces_of(chains).ends.tolist())

    def test_control_a_segment_not_led_through_a_hot_pixel(self) -> None:
        """Pixels beside the segment, and corners that do not belong to a pixel."""
        slanted = ((Fraction(0), Fraction(0)), (Fraction(10), Fraction(1)))
        assert oracle.segment_meets_pixel(slanted, (5, 0), (1.0, 1.0))
        assert not oracle.segment_meets_pixel(slanted, (4, 1), (1.0, 1.0))
        assert oracle.segment_meets_pixel(slanted, (5, 1), (1.0, 1.0))
        touching = ((Fraction(-1), Fraction(0)), (Fraction(0), Fraction(-1)))  # the lower left corner of cell (0, 0)
        assert oracle.segment_meets_pixel(touching, (0, 0), (1.0, 1.0))
        touching = ((Fraction(1), Fraction(0)), (Fraction(0), Fraction(1)))  # its upper right corner
        assert not oracle.segment_meets_pixel(touching, (0, 0), (1.0, 1.0))


def snapped_at_once(pslg: PSLG) -> Arrangement:
    """The arrangement without any noding: what meets wrongly is snapped, and whatever that leads to."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(planar, "_ROUNDS", 0)
        return arrange(pslg)


def is_moved(arranged: Arrangement) -> list[bool]:
    """Which points of the input moved: bit for bit, but for the sign of zero."""
    given = arranged.source.points
    return [bool((p != q).any()) for p, q in zip(arranged.pslg.points[: len(given)], given, strict=True)]


@pytest.mark.obligation(
    "ARR6", "snapping is local: planar and within its distance, and nothing far from it moves", method="property-based"
)
class TestLocality:
    """However few segments are snapped, all are planar together and within their distance; and a point stays that is no
    end of a segment which comes near one that is snapped."""

    @given(drawings())
    def test_snapped_beside_not_snapped(self, drawing: Drawing) -> None:
        arranged = snapped_at_once(PSLG(*drawing))
        assert faults(arranged) == []
        assert arrange(arranged.pslg).pslg == arranged.pslg

    @pytest.mark.parametrize("n", [20, 40, 80])
    def test_nearly_collinear_segments_do_not_breed(self, n: int) -> None:
        """Segments one ulp off one line: each rounding made several times as many crossings as there were."""
        rng, x = np.random.default_rng(0), np.linspace(0.0, 1.0, n)
        points = np.stack([x, x / 3.0 + rng.integers(-1, 2, n) * 2.0**-54], axis=1)
        arranged = arrange(PSLG(points, [(i, n - 1 - i) for i in range(n // 2)]))
        assert arranged.rounding is Rounding.SNAPPED
        assert len(find_crossings(arranged.pslg.points, arranged.pslg.segments)) == 0

    @pytest.mark.parametrize("seed", range(12))
    def test_on_finer_doubles_than_the_grid(self, seed: int) -> None:
        """A point far away makes the grid coarser than the doubles: pixels hold many points, and many hold none."""
        rng = np.random.default_rng(seed)
        begins = 1.0 + rng.integers(0, 400, (20, 2)) * 2.0**-50
        points = np.concatenate([begins, begins + rng.integers(1, 60, (20, 2)) * 2.0**-50, [[2.0 ** (seed % 6), 1.5]]])
        arranged = snapped_at_once(PSLG(points, [(i, i + 20) for i in range(20)]))
        assert faults(arranged) == []

    def test_far_from_the_bundle(self) -> None:
        """Bundle 26 of the corpus needs snapping; beside it a bundle that noding makes planar, and points alone."""
        (snapped_points, snapped_pairs), (other, pairs) = bundle(26), bundle(0)
        n = len(snapped_points)
        points = np.concatenate([snapped_points, other + np.array([3.0, 0.0]), [(0.1, 7.3), (3.3, 0.3)]])
        arranged = arrange(PSLG(points, [*snapped_pairs, *((a + n, b + n) for a, b in pairs)]))
        assert faults(arranged) == []
        assert arranged.rounding is Rounding.SNAPPED
        assert any(is_moved(arranged)[:n])
        assert not any(is_moved(arranged)[n:])

    def test_control_all_snapped_moves_far_points(self) -> None:
        """Everything snapped, wherever it is."""
        (points, pairs), far = bundle(26), [(0.1, 7.3), (3.3, 0.3)]
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(planar, "_SNAPS", 0)
            arranged = arrange(PSLG(np.concatenate([points, far]), pairs))
        assert faults(arranged) == []
        assert any(is_moved(arranged)[len(points) :])


@pytest.mark.obligation(
    "ARR7", "the neighbourhood that is searched again holds every box that meets a changed one", method="differential"
)
class TestNeighbourhood:
    """nearby returns at least those segments whose boxes, widened by the margin, meet one that is given."""

    @staticmethod
    def missing(begins: FloatArray, ends: FloatArray, margin: float, rows: list[int], near: list[int]) -> list[int]:
        low = [
            [Fraction(min(p, q)) - Fraction(margin) for p, q in zip(a, b, strict=True)]
            for a, b in zip(begins.tolist(), ends.tolist(), strict=True)
        ]
        high = [
            [Fraction(max(p, q)) + Fraction(margin) for p, q in zip(a, b, strict=True)]
            for a, b in zip(begins.tolist(), ends.tolist(), strict=True)
        ]
        meet = {
            i
            for i in range(len(low))
            for j in rows
            if all(low[i][k] <= high[j][k] and low[j][k] <= high[i][k] for k in (0, 1))
        }
        return sorted(meet - set(near))

    @pytest.mark.parametrize("size", [0.0, 1e-3, 0.2])
    @pytest.mark.parametrize("scale", [2.0**-1070, 1.0, 1e308])
    def test_all_that_meet(self, size: float, scale: float, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(nearby, "_FEW", 0)
        rng = np.random.default_rng(3)
        begins = rng.random((120, 2)).round(2)
        ends = (begins + size * rng.normal(size=(120, 2))).clip(-1.0, 1.0) * scale
        begins *= scale
        margin = math.ulp(float(np.abs([begins, ends]).max()))
        boxes = nearby.boxes_of(begins, ends, (margin, margin))
        for rows in ([5], [1, 2, 100], list(range(0, 120, 7))):
            near = nearby.nearby(boxes, np.array(rows)).tolist()
            assert self.missing(begins, ends, margin, rows, near) == []
            assert near == sorted(set(near))

    def test_control_one_left_out(self) -> None:
        """A neighbour left out."""
        begins, ends = np.array([(0.0, 0.0), (1.0, 1.0), (3.0, 3.0)]), np.array([(1.0, 1.0), (2.0, 2.0), (4.0, 4.0)])
        assert self.missing(begins, ends, 0.0, [0], [0]) == [1]
        assert self.missing(begins, ends, 1.0, [0], [0]) == [1, 2]
        assert self.missing(begins, ends, 0.5, [0], [0, 1]) == []

    def test_few_of_many_are_near(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """What makes it local: it is not always all."""
        monkeypatch.setattr(nearby, "_FEW", 0)
        begins = np.random.default_rng(4).random((1000, 2))
        boxes = nearby.boxes_of(begins, begins + 1e-3, (2.0**-53, 2.0**-53))
        assert len(nearby.nearby(boxes, np.array([3, 77, 500]))) < 50


@pytest.mark.obligation(
    "ARR5", "bad input, too much output, and attributes: typed errors, and nothing lost", method="named cases"
)
class TestBoundary:
    """Faults are named; what would fill the machine is refused; markers, attributes, holes and regions come along."""

    def test_indices_that_do_not_exist(self) -> None:
        with pytest.raises(TopologyError, match=r"segments\[1\]") as caught:
            find_crossings([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 3)])
        assert caught.value.indices == (1,)

    def test_segments_without_length(self) -> None:
        with pytest.raises(DegenerateError, match="segment 1 begins and ends") as caught:
            find_crossings([(0, 0), (1, 0), (1, -0.0)], [(0, 1), (1, 2)])
        assert caught.value.indices == (1,)

    def test_shapes_and_numbers(self) -> None:
        with pytest.raises(ShapeError):
            find_crossings([(0, 0), (1, 0)], [(0, 1, 2)])
        with pytest.raises(NonFiniteError):
            find_crossings([(0, 0), (1, np.nan)], [(0, 1)])
        assert len(find_crossings([], [])) == 0
        assert len(find_crossings([(0, 0), (1, 0)], [])) == 0

    def test_more_than_fits_into_memory(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(memory, "_available", lambda: 1000)
        points, segments = bundle(26)
        with pytest.raises(TooManyCrossingsError, match="pairs of segments meet") as caught:
            find_crossings(
                np.concatenate([points + i * 1e-3 for i in range(4)]),
                [(a + i * len(points), b + i * len(points)) for i in range(4) for a, b in segments],
            )
        assert len(caught.value.indices) == 2

    def test_what_comes_along(self) -> None:
        square = [(0, 0), (4, 0), (4, 4), (0, 4)]
        pslg = PSLG(
            [*square, (0, 2), (4, 2), (2, 0), (2, 4)],
            [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (6, 7)],
            holes=[(1, 1)],
            regions=[(3, 3, 7.0, 0.5)],
            point_markers=range(8),
            segment_markers=[1, 2, 3, 4, 5, 6],
            point_attributes=[[float(x), 1.0] for x, _ in [*square, (0, 2), (4, 2), (2, 0), (2, 4)]],
            rule="even-odd",
        )
        arranged = arrange(pslg)
        noded = arranged.pslg
        assert faults(arranged) == []
        assert noded.points[8:].tolist() == [[2.0, 2.0]]
        assert noded.point_markers is not None
        assert noded.point_markers.tolist() == [*range(8), 0]
        assert noded.point_attributes is not None
        assert noded.point_attributes[8:].tolist() == [[2.0, 1.0]]
        assert noded.segment_markers is not None
        assert noded.segment_markers.tolist() == [1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6]
        assert (noded.holes.tolist(), noded.regions.tolist(), noded.rule) == ([[1, 1]], [[3, 3, 7, 0.5]], pslg.rule)
        assert [arranged.chain(i).tolist() for i in (0, 4, 5)] == [[0, 6, 1], [4, 8, 5], [6, 8, 7]]
        assert (arranged.rounding, arranged.crossings, arranged.grid) == (Rounding.EXACT, 1, (0.0, 0.0))

    def test_overlapping_segments_become_one(self) -> None:
        arranged = arrange(PSLG([(0, 0), (3, 0), (1, 0), (2, 0), (1, 0)], [(0, 1), (3, 2), (0, 4)]))
        assert arranged.pslg.segments.tolist() == [[0, 2], [2, 3], [3, 1]]
        assert arranged.incidence.tolist() == [[0, 0], [0, 2], [1, 0], [1, 1], [2, 0]]
        assert arranged.chain(1).tolist() == [3, 2]

    def test_control_good(self) -> None:
        """None: the same without the fault is taken."""
        assert len(find_crossings([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2)])) == 0
        points, segments = bundle(26)
        assert len(find_crossings(points, segments)) > 0
