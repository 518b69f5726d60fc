"""Planar straight line graphs: what is given is kept, and every fault is found, exactly and all at once."""

import copy
import dataclasses
import itertools
import math
import pickle
import re
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st
from proofs_tests.kernel.strategies import lattice, mixed, near_line
from proofs_tests.oracles import on_segment, orient, rationals

from exactmesh import PSLG, Carve, CrossingError, ExactMeshError, FaultKind, NonFiniteError, PSLGError, ShapeError
from exactmesh import seeds as seeds_module
from exactmesh.coincident import first_of_each, lexicographic_order
from exactmesh.errors import ChoiceError, CoordinateError, Fault

SQUARE = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]
SIDES = [(0, 1), (1, 2), (2, 3), (3, 0)]
NAN, INFINITY = math.nan, math.inf

Point = tuple[float, float]
Named = list[tuple[FaultKind, tuple[int, ...]]]


def inside_hull(seed: Point, points: Sequence[Point]) -> bool:
    """Not inside: a line through the seed and some point has nothing strictly on one of its sides."""
    s, *hull = rationals([seed, *points])
    sides = [{(area > 0) - (area < 0) for area in (orient(s, q, p) for p in hull)} for q in hull if q != s]
    return bool(sides) and all({-1, 1} <= side for side in sides)


def brute_faults(points: Sequence[Point], segments: Sequence[tuple[int, int]], holes: Sequence[Point]) -> Named:
    """Every fault by its definition, one pair at a time."""
    faults: Named = []
    sound: list[int] = []
    for s, (a, b) in enumerate(segments):
        if not (0 <= a < len(points) and 0 <= b < len(points)):
            faults.append((FaultKind.BAD_INDEX, (s,)))
        elif points[a] == points[b]:
            faults.append((FaultKind.ZERO_LENGTH, (s,)))
        else:
            earlier = [t for t in sound if set(segments[t]) == {a, b}]
            if earlier:
                faults.append((FaultKind.REPEATED_SEGMENT, (earlier[0], s)))
            sound.append(s)
    places = rationals(points)
    for h, hole in enumerate(holes):
        seed = rationals([hole])[0]
        under = [s for s in sound if on_segment(seed, *(places[v] for v in segments[s]))]
        if under:
            faults.append((FaultKind.HOLE_ON_SEGMENT, (h, under[0])))
        elif not inside_hull(hole, points):
            faults.append((FaultKind.HOLE_OUTSIDE, (h,)))
    return faults


def found_faults(call: Callable[[], object]) -> Named:
    try:
        call()
    except PSLGError as error:
        return [(fault.kind, fault.indices) for fault in error.faults]
    return []


@st.composite
def graphs(draw: st.DrawFn) -> tuple[list[Point], list[tuple[int, int]], list[Point]]:
    """Points and seeds of one family, so that seeds lie on segments and corners; indices a little out of range."""
    family = draw(st.sampled_from([lattice, near_line, mixed]))
    n, h = draw(st.integers(1, 7)), draw(st.integers(0, 4))
    places = draw(family(n + h))
    points = [*places[:n], *draw(st.lists(st.sampled_from(places[:n]), max_size=2))]
    index = st.integers(-1, len(points)) if draw(st.booleans()) else st.integers(0, len(points) - 1)
    segments = draw(st.lists(st.tuples(index, index), max_size=8))
    return points, segments, [*places[n:], *draw(st.lists(st.sampled_from(points), max_size=1))]


@pytest.mark.obligation(
    "P1", "a PSLG is refused exactly for the faults that it has, and all of them are named", method="property-based"
)
class TestEveryFaultIsFound:
    """The faults are those of brute force in fractions: no more, no fewer, with the same indices."""

    @given(graphs())
    def test_as_brute_force(self, graph: tuple[list[Point], list[tuple[int, int]], list[Point]]) -> None:
        points, segments, holes = graph
        found = found_faults(lambda: PSLG(points, segments, holes=holes))
        assert sorted(found) == sorted(brute_faults(points, segments, holes))
        regions = [(x, y, 1.0) for x, y in holes]
        as_regions = [(FaultKind[kind.name.replace("HOLE", "REGION")], indices) for kind, indices in found]
        assert found_faults(lambda: PSLG(points, segments, regions=regions)) == as_regions

    @pytest.mark.parametrize("points", list(itertools.combinations(itertools.product(range(3), repeat=2), 4)))
    def test_seeds_on_a_grid(self, points: list[Point]) -> None:
        """All seeds at half steps, all sets of four points of a 3 x 3 grid, two segments."""
        segments = [(0, 1), (3, 2)]
        holes = [(x / 2, y / 2) for x in range(-1, 6) for y in range(-1, 6)]
        found = found_faults(lambda: PSLG(points, segments, holes=holes))
        assert sorted(found) == sorted(brute_faults(points, segments, holes))
        assert any(kind is FaultKind.HOLE_ON_SEGMENT for kind, _ in found)

    def test_control_rounded_orientations_are_caught(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """With the determinant in plain doubles, some seeds next to a segment are taken for seeds on it."""

        def rounded(_k: object, p: npt.NDArray[np.float64], a: int, b: int, c: int) -> int:
            return int(np.sign((p[a, 0] - p[c, 0]) * (p[b, 1] - p[c, 1]) - (p[a, 1] - p[c, 1]) * (p[b, 0] - p[c, 0])))

        points, segments = [(-12.0, -12.0), (24.0, 24.0), (24.0, 0.0)], [(0, 1)]
        holes = [(0.5 + i * 2.0**-53, 0.5 + j * 2.0**-53) for i in range(5) for j in range(5)]
        expected = sorted(brute_faults(points, segments, holes))
        assert sorted(found_faults(lambda: PSLG(points, segments, holes=holes))) == expected
        mark = seeds_module._mark_segments_under
        monkeypatch.setattr(seeds_module, "_mark_segments_under", getattr(mark, "py_func", mark))
        monkeypatch.setattr(seeds_module, "_orientation", rounded)
        assert sorted(found_faults(lambda: PSLG(points, segments, holes=holes))) != expected

    def test_many_blocks(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Looking at Ctrl-C between blocks changes nothing."""
        rng = np.random.default_rng(1)
        points = rng.integers(0, 9, (60, 2)).astype(np.float64)
        segments = np.array([(i, i + 1) for i in range(59) if (points[i] != points[i + 1]).any()])
        holes = rng.integers(0, 9, (40, 2)).astype(np.float64)
        whole = found_faults(lambda: PSLG(points, segments, holes=holes))
        assert len(whole) > 30
        monkeypatch.setattr(seeds_module, "_SEGMENTS_AT_ONCE", 7)
        assert found_faults(lambda: PSLG(points, segments, holes=holes)) == whole


@pytest.mark.obligation(
    "P1", "one error has every fault, and its message names the first of each kind", method="named cases"
)
class TestAllAtOnce:
    """One error has every fault of every kind; its message is one line that names the first of each and a remedy."""

    def test_one_of_each(self) -> None:
        def call() -> PSLG:
            return PSLG(
                [*SQUARE, (4.0, 3.0)],
                [(0, 1), (1, 9), (2, 4), (1, 0), (2, 3), (3, 0), (-1, 2)],
                holes=[(NAN, 0), (1, 0), (5, 5), (-0.0, 2), (1, 1)],
                regions=[(0, 0, 1, INFINITY), (4, 1, 1, 1), (2, 3, 7, 1)],
            )

        assert found_faults(call) == [
            (FaultKind.BAD_INDEX, (1,)),
            (FaultKind.BAD_INDEX, (6,)),
            (FaultKind.ZERO_LENGTH, (2,)),
            (FaultKind.REPEATED_SEGMENT, (0, 3)),
            (FaultKind.HOLE_NOT_FINITE, (0,)),
            (FaultKind.HOLE_ON_SEGMENT, (1, 0)),
            (FaultKind.HOLE_ON_SEGMENT, (3, 5)),
            (FaultKind.HOLE_OUTSIDE, (2,)),
            (FaultKind.REGION_NOT_FINITE, (0,)),
            (FaultKind.REGION_ON_SEGMENT, (2, 4)),
            (FaultKind.REGION_OUTSIDE, (1,)),
        ]
        with pytest.raises(PSLGError, match=r"segment 1 \(1, 9\).*points are 0 to 4.*segment 3 .1, 0. is") as caught:
            call()
        assert caught.value.indices == (1, 6)

    def test_many_alike_are_counted(self) -> None:
        with pytest.raises(PSLGError, match="segment 2 begins and ends in point 2 and 7 more") as caught:
            PSLG(np.random.default_rng(0).random((10, 2)), [(i, i) for i in range(10)])
        assert len(caught.value.faults) == 10

    def test_control_without_faults(self) -> None:
        """None: the same graph without its faults is taken."""
        pslg = PSLG([*SQUARE, (4.0, 3.0)], SIDES, holes=[(1, 1)], regions=[(1, 2, 5)])
        assert pslg.regions.tolist() == [[1, 2, 5, -1]]

    @pytest.mark.parametrize("count", [0, 1, 2])
    def test_few_points(self, count: int) -> None:
        """Points that span nothing are a PSLG; no seed is inside, and no segment leads beyond them."""
        assert len(PSLG(np.array(SQUARE[:count]).reshape(-1, 2)).points) == count
        found = found_faults(lambda: PSLG(np.array(SQUARE[:count]).reshape(-1, 2), [(0, 2)], holes=[(0.5, 0.0)]))
        assert found == [(FaultKind.BAD_INDEX, (0,)), (FaultKind.HOLE_OUTSIDE, (0,))]

    def test_errors_travel(self) -> None:
        errors: list[ExactMeshError] = [
            CrossingError([(0, 3), (1, 2)]),
            CrossingError([(0, 1)], SQUARE, [(0, 2), (1, 3)], remedy="move one", path="a.poly", base=1),
        ]
        with pytest.raises(PSLGError) as caught:
            PSLG(SQUARE, [(0, 0), (1, 7)])
        errors.append(caught.value)
        for error in errors:
            again = pickle.loads(pickle.dumps(error))
            assert type(again) is type(error)
            assert str(again) == str(error)
            assert again.indices == error.indices
            assert sorted(again.__dict__) == sorted(error.__dict__)
        assert caught.value.faults == pickle.loads(pickle.dumps(caught.value)).faults

    def test_crossings_are_named(self) -> None:
        error = CrossingError(np.array([(0, 3), (1, 3), (1, 2), (5, 6)]))
        assert error.pairs.shape == (4, 2)
        assert error.indices == (0, 1, 2, 3, 5, 6)
        assert "0 and 3, 1 and 3, 1 and 2 and 1 more pairs" in str(error)

    def test_crossings_are_placed(self) -> None:
        error = CrossingError([(0, 1)], SQUARE, [(0, 2), (1, 3)], remedy="move one", path="a.poly", base=1)
        a, b, c, d = (tuple(map(float, corner)) for corner in SQUARE)
        assert str(error) == f"a.poly: segments cross: 1 and 2 [{a} to {c}, {b} to {d}] (move one)"
        assert (error.pairs.tolist(), error.indices, error.path) == ([[0, 1]], (0, 1), "a.poly")

    def test_a_message_counts_as_the_file_does(self) -> None:
        """Every index is counted from the base, coordinates stay, and so does what the fault has for programs."""
        with pytest.raises(PSLGError) as caught:
            PSLG(SQUARE, [(0, 0), (1, 7), (1, 2), (2, 1), (-1, 0)], holes=[(9, 9), SQUARE[1]])
        one = PSLGError(caught.value.faults, base=1)
        numbers = re.compile(r"(?<![\d.(])-?\d+(?![\d.])")
        assert "segment 2 (2, 8) has an end that does not exist: points are 1 to 4" in str(one)
        assert "segments count points from 1" in str(one)
        assert "segment 1 begins and ends in point 1" in str(one)
        assert "segment 4 (3, 2) is segment 3 again" in str(one)
        assert "hole 2 at" in str(one)
        assert "hole 1 at (9.0, 9.0)" in str(one)
        assert len(numbers.findall(str(one))) == len(numbers.findall(str(caught.value)))
        assert one.faults == caught.value.faults
        assert "#" not in str(one) + str(caught.value)

    def test_the_remedy_is_the_callers(self) -> None:
        faults = [Fault(FaultKind.NOT_CLOSED, (0,), "segment #0 bounds nothing")]
        assert "carve=False" in str(PSLGError(faults))
        assert "--carve none" in str(PSLGError(faults, hull="--carve none"))

    @given(graphs())
    def test_messages(self, graph: tuple[list[Point], list[tuple[int, int]], list[Point]]) -> None:
        """One line; each fault names its culprits."""
        points, segments, holes = graph
        try:
            PSLG(points, segments, holes=holes)
        except PSLGError as error:
            told = [str(error), *map(str, error.faults)]
            unnamed = [f for f in error.faults if any(str(i) not in f.message for i in f.indices)]
            assert (sum(message.count("\n") for message in told), unnamed) == (0, [])


coordinates = st.sampled_from([0.0, -0.0, 1.0, 5e-324, -5e-324, 1e308, math.nextafter(1.0, 2.0)])


@pytest.mark.obligation(
    "P2", "points at the same position, and only those, share a representative: the first", method="property-based"
)
class TestDuplicates:
    """representative[i] is the first j with the position of i; -0.0 is 0.0, and no two other doubles are equal."""

    @given(st.lists(st.tuples(coordinates, coordinates), max_size=12))
    def test_as_defined(self, points: list[Point]) -> None:
        pslg = PSLG(points)
        expected = [points.index(point) for point in points]  # == on floats: -0.0 == 0.0
        assert pslg.representative.tolist() == expected
        assert pslg.duplicates.tolist() == [i for i, first in enumerate(expected) if i != first]

    @given(st.lists(st.tuples(coordinates, coordinates), max_size=12))
    def test_order(self, points: list[Point]) -> None:
        order = lexicographic_order(np.array(points, dtype=np.float64).reshape(-1, 2))
        assert order.tolist() == sorted(range(len(points)), key=lambda i: (*points[i], i))

    def test_control_an_order_with_a_flaw_is_caught(self) -> None:
        """An order by x alone."""
        points = np.array([(0.0, 1.0), (0.0, 0.0), (0.0, 1.0)])
        assert first_of_each(points, lexicographic_order(points)).tolist() == [0, 1, 0]
        assert first_of_each(points, np.argsort(points[:, 0], kind="stable").astype(np.int32)).tolist() != [0, 1, 0]


@pytest.mark.obligation("G2", "a graph is kept as it was given, and cannot be changed", method="named cases")
class TestKeptAsGiven:
    """Every array is kept, number by number, in its order; and nobody can change it, nor its copies and pickles."""

    full = PSLG(
        [*SQUARE, (-0.0, 0.0)],
        SIDES,
        holes=[(1, 1)],
        regions=[(2, 1, 7.5, 0.25)],
        point_markers=[1, 2, 3, 4, -5],
        segment_markers=[9, 8, 7, 2**62],
        point_attributes=[(0.5,), (1.5,), (2.5,), (3.5,), (4.5,)],
        rule="even-odd",
    )

    def test_a_view_of_what_was_given_changes_nothing(self) -> None:
        given = np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0)])
        view = given[:]
        given.flags.writeable = False
        pslg = PSLG(given, [(0, 1), (1, 2), (2, 0)])
        view[0, 0] = 77.0
        assert given[0, 0] == 77.0
        assert pslg.points[0, 0] == 0.0

    @pytest.mark.parametrize(
        "pslg",
        [full, copy.copy(full), copy.deepcopy(full), pickle.loads(pickle.dumps(full)), dataclasses.replace(full)],
        ids=["given", "copy", "deepcopy", "pickle", "replace"],
    )
    def test_content(self, pslg: PSLG) -> None:
        assert pslg == self.full
        assert hash(pslg) == hash(self.full)
        assert np.signbit(pslg.points[4, 0])
        assert pslg.segments.tolist() == [list(side) for side in SIDES]
        assert pslg.segments.dtype == pslg.representative.dtype == pslg.duplicates.dtype == np.int32
        assert pslg.segment_markers is not None
        assert pslg.segment_markers.tolist() == [9, 8, 7, 2**62]
        assert pslg.regions.tolist() == [[2, 1, 7.5, 0.25]]
        assert pslg.rule is Carve.EVEN_ODD
        for f in dataclasses.fields(pslg):
            value = getattr(pslg, f.name)
            if isinstance(value, np.ndarray):
                assert not value.flags.writeable
                with pytest.raises(ValueError, match="read-only"):
                    value[...] = 0
        with pytest.raises(dataclasses.FrozenInstanceError):
            pslg.rule = Carve.SEEDS  # type: ignore[misc]  # that is the point

    def test_the_callers_arrays_stay_the_callers(self) -> None:
        points = np.array(SQUARE)
        pslg = PSLG(points)
        points[0] = 9.0
        assert pslg.points[0].tolist() == [0.0, 0.0]

    @pytest.mark.parametrize(
        "change",
        [
            {"rule": "seeds"},
            {"holes": None},
            {"regions": [(2, 1, 7.5)]},
            {"point_markers": None},
            {"segment_markers": [9, 8, 7, 6]},
            {"segments": SIDES[::-1]},
        ],
    )
    def test_control_another_content_is_unequal(self, change: dict[str, object]) -> None:
        """Another number in one array: the graphs are unequal."""
        assert dataclasses.replace(self.full, **change) != self.full  # type: ignore[arg-type]  # tables are of objects
        assert self.full != "PSLG"

    def test_shown(self) -> None:
        assert repr(self.full) == "PSLG(5 points, 4 segments, 1 hole, 1 region, carve by even-odd)"
        assert "<svg" in self.full._repr_svg_()


class TestUnreadable:
    """What is no array of the right shape and type is refused by its name, before any fault is looked for."""

    @pytest.mark.parametrize(
        ("arguments", "error", "words"),
        [
            ({"segments": [(0, 1, 2)]}, ShapeError, r"segments has shape \(1, 3\)"),
            ({"segments": [0, 1]}, ShapeError, r"segments has shape \(2,\)"),
            ({"segments": [(0.0, 1.0)]}, ShapeError, "segments has dtype float64"),
            ({"segments": [(0, 1), (2,)]}, ShapeError, "segments"),
            ({"segments": [(0, 2**64)]}, ShapeError, "segments"),
            ({"segments": np.ma.masked_equal([(0, 1), (1, 2)], 2)}, ShapeError, "segments has masked"),
            ({"regions": np.ma.masked_equal([(1.0, 1.0, 2.0)], 2.0)}, ShapeError, "regions has masked"),
            ({"holes": np.ma.masked_equal([(1.0, 2.0)], 2.0)}, CoordinateError, r"holes\[0\]: masked"),
            ({"point_markers": np.ma.masked_equal([1, 2, 3, 4], 2)}, ShapeError, "point_markers has masked"),
            ({"holes": [(0, 0, 1)]}, ShapeError, "holes"),
            ({"holes": [("a", "b")]}, CoordinateError, "holes"),
            ({"regions": [(0, 0)]}, ShapeError, r"regions has shape \(1, 2\)"),
            ({"regions": [(1, 1, 2), (1, 1, 2, 3)]}, ShapeError, r"regions has rows of different.*\(r, 4\).* \(r, 3\)"),
            ({"regions": [(0, 0, 1), (0, 0, 1, 1)]}, ShapeError, "regions"),
            ({"regions": [(0, 0, 2**53 + 1)]}, CoordinateError, r"regions\[0\]"),
            ({"point_markers": [1]}, ShapeError, "point_markers has 1 rows for 4 points"),
            ({"segment_markers": [1]}, ShapeError, "segment_markers has 1 rows for 0 segments"),
            ({"segment_markers": [1.5]}, ShapeError, "segment_markers has dtype"),
            ({"point_attributes": [(NAN,)] * 4}, NonFiniteError, "point_attributes"),
            ({"rule": "odd-even"}, ChoiceError, "'odd-even' is no rule.*seeds, even-odd"),
            ({"rule": None}, ChoiceError, "None"),
        ],
    )
    def test_refused(self, arguments: dict[str, object], error: type[ExactMeshError], words: str) -> None:
        with pytest.raises(error, match=words):
            PSLG(SQUARE, **arguments)  # type: ignore[arg-type]  # tables are of objects

    def test_an_index_beyond_32_bits_is_a_fault(self) -> None:
        assert found_faults(lambda: PSLG(SQUARE, [(0, 2**40), (-(2**40), 1)])) == [
            (FaultKind.BAD_INDEX, (0,)),
            (FaultKind.BAD_INDEX, (1,)),
        ]
