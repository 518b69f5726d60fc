"""Bad graphs: what is wrong is named by a typed error; everything else has a right result; nothing crashes or hangs."""

import copy
import math
import pickle
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from proofs_tests.kernel.strategies import EXTREMES
from proofs_tests.mesh import constrained_oracle
from proofs_tests.mesh.test_regions import Expected, corners_of

from exactmesh import (
    PSLG,
    Carve,
    ChoiceError,
    CoordinateError,
    CrossingError,
    ExactMeshError,
    FaultKind,
    NonFiniteError,
    PSLGError,
    ShapeError,
    Triangulation,
    constrained_delaunay,
)
from exactmesh.errors import CollinearPointsError, SeedError, TooFewPointsError

Arguments = dict[str, Any]
NAN, INFINITY = math.nan, math.inf

GOOD: Arguments = {
    "points": [(0, 0), (8, 0), (8, 8), (0, 8), (2, 2), (4, 2), (2, 4), (6, 6), (7, 5), (4, 0)],
    "segments": [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 4), (7, 8)],
    "holes": [(2.5, 2.5)],
    "regions": [(7, 1, 5, -1), (1, 7, 5, -1)],
    "point_markers": [0, 0, 3, 0, 0, 0, 0, 0, 0, 0],
    "segment_markers": [1, 2, 3, 4, 0, 0, 0, 9],
    "point_attributes": [[float(i)] for i in range(10)],
}


def with_row(name: str, row: int, value: object) -> Arguments:
    arguments = copy.deepcopy(GOOD)
    arguments[name][row] = value
    return arguments


def with_more(name: str, *rows: object) -> Arguments:
    arguments = copy.deepcopy(GOOD)
    arguments[name] += rows
    for column in ("point_markers", "point_attributes", "segment_markers"):
        if column.startswith(name[:-1]):
            arguments[column] = None
    return arguments


def without(*names: str) -> Arguments:
    return {name: value for name, value in GOOD.items() if name not in names}


def masked(name: str, value: float) -> Any:
    return np.ma.masked_equal(np.array(GOOD[name]), value)


UNCONNECTED = without("segments", "segment_markers")
Kind = type[ExactMeshError] | FaultKind

#: Arguments, the error or the fault, and words of the message.
BAD: dict[str, tuple[Arguments, Kind, str]] = {
    "index too large": (with_row("segments", 4, (4, 10)), FaultKind.BAD_INDEX, r"segment 4 \(4, 10\).*0 to 9"),
    "index negative": (with_row("segments", 4, (4, -1)), FaultKind.BAD_INDEX, r"segment 4 \(4, -1\)"),
    "index enormous": (with_row("segments", 4, (4, 2**40)), FaultKind.BAD_INDEX, "segment 4"),
    "index beyond 64 bits": (with_row("segments", 4, (4, 2**70)), ShapeError, "segments"),
    "index a double": (with_row("segments", 4, (4.0, 5.0)), ShapeError, "segments has dtype float64"),
    "index NaN": (with_row("segments", 4, (4, NAN)), ShapeError, "segments has dtype float64"),
    "index a numeral": (with_row("segments", 4, ("4", "5")), ShapeError, "segments"),
    "zero length": (with_row("segments", 4, (4, 4)), FaultKind.ZERO_LENGTH, "segment 4"),
    "two positions alike": (with_row("points", 5, (2, 2)), FaultKind.ZERO_LENGTH, "segment 4.*4 and 5"),
    "repeated": (with_more("segments", (5, 4)), FaultKind.REPEATED_SEGMENT, "segment 8.*segment 4 again"),
    "three ends": (UNCONNECTED | {"segments": [(0, 1, 2)]}, ShapeError, r"segments.*\(1, 3\)"),
    "ragged": (UNCONNECTED | {"segments": [(0, 1), (2,)]}, ShapeError, "segments"),
    "flat": (UNCONNECTED | {"segments": [0, 1]}, ShapeError, r"segments has shape \(2,\)"),
    "point NaN": (with_row("points", 9, (NAN, 0)), NonFiniteError, r"points\[9\]"),
    "point infinite": (with_row("points", 9, (4, -INFINITY)), NonFiniteError, r"points\[9\]"),
    "point a word": (with_row("points", 9, ("a", 0)), CoordinateError, "points"),
    "hole NaN": (with_row("holes", 0, (NAN, 1)), FaultKind.HOLE_NOT_FINITE, "hole 0"),
    "hole infinite": (with_row("holes", 0, (1, INFINITY)), FaultKind.HOLE_NOT_FINITE, "hole 0"),
    "hole on a vertex": (with_row("holes", 0, (2, 2)), FaultKind.HOLE_ON_SEGMENT, "hole 0.*segment 4"),
    "hole on a segment": (with_row("holes", 0, (3, 2)), FaultKind.HOLE_ON_SEGMENT, "hole 0.*segment 4"),
    "hole outside the hull": (with_row("holes", 0, (9, 9)), FaultKind.HOLE_OUTSIDE, "hole 0"),
    "hole flat": (without("holes") | {"holes": [2.5, 2.5]}, ShapeError, "holes"),
    "hole in the exterior": (with_more("points", (20, 4)) | {"holes": [(9, 4)]}, FaultKind.HOLE_OUTSIDE, "hole 0"),
    "region on a segment": (with_row("regions", 1, (8, 1, 5, -1)), FaultKind.REGION_ON_SEGMENT, "region 1.*segment 1"),
    "region outside": (with_row("regions", 1, (9, 1, 5, -1)), FaultKind.REGION_OUTSIDE, "region 1"),
    "region in the hole": (with_row("regions", 1, (2.5, 3, 5, -1)), FaultKind.REGION_OUTSIDE, "region 1"),
    "region NaN": (with_row("regions", 1, (1, 7, NAN, -1)), FaultKind.REGION_NOT_FINITE, "region 1"),
    "regions that disagree": (with_row("regions", 1, (1, 7, 6, -1)), FaultKind.REGIONS_DISAGREE, "regions 0 and 1"),
    "region of two numbers": (without("regions") | {"regions": [(1, 7)]}, ShapeError, "regions"),
    "outline open": (with_row("segments", 3, (3, 9)), CrossingError, "0 and 4|3 and"),
    "a side missing": (
        UNCONNECTED | {"segments": GOOD["segments"][1:]}, FaultKind.NOT_CLOSED, "segment 0"
    ),
    "no segments": ({"points": GOOD["points"]}, FaultKind.NOT_CLOSED, "without segments"),
    "odd": (without("holes", "regions") | {"rule": "even-odd"}, FaultKind.INCONSISTENT_PARITY, "point 7"),
    "all is hole": (
        without("regions") | {"holes": [(2.5, 2.5), (7, 1)]}, FaultKind.EMPTY_DOMAIN, "every face"
    ),
    "crossing": (with_more("segments", (0, 2)) | {"holes": None}, CrossingError, "5 and 8"),
    "rule unknown": ({**GOOD, "rule": "odd"}, ChoiceError, "'odd'.*seeds, even-odd"),
    "markers too few": ({**GOOD, "point_markers": [1]}, ShapeError, "point_markers has 1 rows for 10 points"),
    "markers of segments too many": ({**GOOD, "segment_markers": [1] * 9}, ShapeError, "segment_markers has 9 rows"),
    "markers doubles": ({**GOOD, "point_markers": [0.5] * 10}, ShapeError, "point_markers has dtype"),
    "attributes flat": ({**GOOD, "point_attributes": [1.0] * 10}, ShapeError, "point_attributes"),
    "attributes NaN": (with_row("point_attributes", 3, [NAN]), NonFiniteError, r"point_attributes\[3\]"),
    "two points": ({"points": [(0, 0), (1, 0)], "segments": [(0, 1)]}, TooFewPointsError, "2 points"),
    "no points": ({"points": []}, TooFewPointsError, "0 points"),
    "a line": ({"points": [(0, 0), (1, 1), (2, 2)], "segments": [(0, 2)]}, CollinearPointsError, "line"),
    "points masked": ({**GOOD, "points": masked("points", 6.0)}, CoordinateError, r"points\[7\]: masked"),
    "segments masked": ({**GOOD, "segments": masked("segments", 6)}, ShapeError, "segments has masked values"),
    "markers masked": ({**GOOD, "point_markers": masked("point_markers", 3)}, ShapeError, "point_markers has masked"),
}  # fmt: skip


def refusal(call: Callable[[], object]) -> ExactMeshError:
    with pytest.raises(ExactMeshError) as caught:
        call()
    return caught.value


class TestNamed:
    """Each fault is refused by its own type or kind, in one line that names the culprit; errors survive a pickle."""

    @pytest.mark.parametrize(("arguments", "kind", "words"), BAD.values(), ids=BAD.keys())
    def test_refused(self, arguments: Arguments, kind: Kind, words: str) -> None:
        error = refusal(lambda: constrained_delaunay(PSLG(**arguments)))
        with pytest.raises(ExactMeshError, match=words):
            raise error
        if isinstance(kind, FaultKind):
            assert isinstance(error, PSLGError)
            assert kind in {fault.kind for fault in error.faults}
        else:
            assert type(error) is kind
        assert "\n" not in str(error)
        again = pickle.loads(pickle.dumps(error))
        assert (type(again), str(again), again.indices) == (type(error), str(error), error.indices)

    def test_control_good(self) -> None:
        """Without any of this the graph is taken."""
        mesh = constrained_delaunay(PSLG(**GOOD))
        check_right(PSLG(**GOOD), mesh)
        assert mesh.triangle_attributes.tolist() == [[5.0]] * len(mesh.triangles)

    def test_several_at_once(self) -> None:
        """Faults of carving come together: segments that bound nothing, and seeds that are outside for it."""
        arguments = without("segments", "segment_markers") | {"segments": GOOD["segments"][1:]}
        error = refusal(lambda: constrained_delaunay(PSLG(**arguments)))
        assert isinstance(error, PSLGError)
        kinds = [fault.kind for fault in error.faults]
        assert kinds[0] is FaultKind.NOT_CLOSED
        assert kinds.count(FaultKind.REGION_OUTSIDE) == 2

    @pytest.mark.parametrize("graph", [None, GOOD["points"], GOOD, np.eye(3), "lake.poly"])
    def test_no_graph(self, graph: Any) -> None:
        with pytest.raises(ShapeError, match="expected a PSLG"):
            constrained_delaunay(graph)

    @pytest.mark.parametrize("options", [{"carve": "holes"}, {"carve": None}, {"carve": 1}, {"crossings": "drop"}])
    def test_choices(self, options: Arguments) -> None:
        with pytest.raises(ChoiceError, match="choose from"):
            constrained_delaunay(PSLG(**GOOD), **options)

    @pytest.mark.parametrize("seed", [-1, 1.5, "0", None])
    def test_seed(self, seed: Any) -> None:
        with pytest.raises(SeedError, match="seed="):
            constrained_delaunay(PSLG(**GOOD), seed=seed)

    @pytest.mark.parametrize("segment", [-1, 8, 1.5, "0", None, NAN, 2**70])
    def test_chain(self, segment: Any) -> None:
        with pytest.raises(ExactMeshError, match="there is no segment"):
            constrained_delaunay(PSLG(**GOOD)).chain(segment)


def layouts(rows: Any, dtype: str) -> dict[str, Any]:
    array = np.array(rows, dtype=dtype)
    frozen = array.copy()
    frozen.setflags(write=False)
    return {
        "read-only": frozen,
        "Fortran": np.asfortranarray(array),
        "strided": np.repeat(array, 2, axis=0)[::2],
        "backwards": array[::-1].copy()[::-1],
        "big-endian": array.astype(array.dtype.newbyteorder(">")),
        "unmasked": np.ma.masked_array(array),
        "small": array.astype("i1" if dtype[0] == "i" else "f4"),
    }


class TestLayouts:
    """Any layout of any array gives the same triangulation, bit for bit; the caller's arrays stay as they were, and
    what they do to them afterwards changes nothing."""

    @pytest.mark.parametrize("layout", layouts([[0]], "i8"))
    def test_same(self, layout: str) -> None:
        expected = constrained_delaunay(PSLG(**GOOD))
        types = {"segments": "i8", "point_markers": "i8", "segment_markers": "i8"}
        arrays = {name: layouts(rows, types.get(name, "f8"))[layout] for name, rows in GOOD.items()}
        before = copy.deepcopy(arrays)
        mesh = constrained_delaunay(PSLG(**arrays))
        for name in ("points", "triangles", "segments", "segment_markers", "vertex_markers", "triangle_attributes"):
            assert getattr(mesh, name).tobytes() == getattr(expected, name).tobytes()
        for name, array in arrays.items():
            assert (array == before[name]).all()

    def test_later_changes(self) -> None:
        arrays = {name: np.array(rows) for name, rows in GOOD.items()}
        pslg = PSLG(**arrays)  # type: ignore[arg-type]  # the rule is not among them
        for array in arrays.values():
            array[...] = 0
        assert pslg == PSLG(**GOOD)


def check_right(pslg: PSLG, mesh: Triangulation) -> None:
    """The hull is brute force's, and what was kept of it is the domain."""
    expected = Expected(pslg, even_odd=pslg.rule is Carve.EVEN_ODD)
    assert sorted(constrained_oracle.constrained_triangles(expected.points, expected.segments)) == sorted(
        min((a, b, c), (b, c, a), (c, a, b)) for a, b, c in expected.triangles
    )
    assert expected.faults() == []
    assert sorted(corners_of(mesh)) == sorted(expected.corners(expected.domain()))


ODD_NUMBERS = (*EXTREMES, -1.0, 1.5, 2.0, 4.0, 8.0, -1.7e308, NAN, INFINITY, 2**60 + 1, 3, "7", None, True, 1j)
ODD_ARRAYS: tuple[Any, ...] = (
    None,
    [],
    (),
    5,
    "segments",
    [[]],
    [None],
    [[0, 1, 2, 3, 4]],
    {},
    np.empty((0, 2)),
    np.empty((0, 3, 2)),
    b"",
)


def changed_row(draw: st.DrawFn, row: Any, numbers: Any, *, whole: bool) -> Any:
    """The row with one entry shifted, or another one."""
    if not isinstance(row, list | tuple) or not row:
        return draw(numbers)
    entries = list(row)
    k = draw(st.integers(0, len(entries) - 1))
    shifted = isinstance(entries[k], int | float) and draw(st.booleans())
    step = st.integers(-3, 3) if whole else st.sampled_from([-2.0, -1.0, -0.5, 0.5, 1.0, 2.0, 5e-324, -(2.0**-52)])
    entries[k] = entries[k] + draw(step) if shifted else draw(numbers)
    return tuple(entries)


@st.composite
def moved(draw: st.DrawFn) -> Arguments:
    """The good graph with one to four changes of coordinates and ends: it stays readable."""
    arguments = copy.deepcopy(without("point_markers", "segment_markers", "point_attributes"))
    for _ in range(draw(st.integers(1, 4))):
        name = draw(st.sampled_from(["points", "points", "segments", "segments", "holes", "regions"]))
        rows, whole = arguments[name], name == "segments"
        i = draw(st.integers(0, len(rows) - 1)) if rows else 0
        change = draw(st.sampled_from(["row", "row", "row", "drop", "repeat"])) if rows else "none"
        if change == "row":
            numbers = st.integers(0, 9) if whole else st.sampled_from([*EXTREMES, 2.0, 4.0, 6.0, 8.0, -1.7e308])
            rows[i] = changed_row(draw, rows[i], numbers, whole=whole)
        elif change == "drop" and name != "points":
            del rows[i]
        elif change == "repeat":
            rows.append(rows[i])
    arguments["rule"] = draw(st.sampled_from([Carve.SEEDS, Carve.SEEDS, Carve.EVEN_ODD]))
    return arguments


@st.composite
def mangled(draw: st.DrawFn) -> Arguments:
    """The good graph with one to three changes of one entry, one row, or one array, into whatever."""
    arguments = copy.deepcopy(GOOD)
    for _ in range(draw(st.integers(1, 3))):
        name = draw(st.sampled_from(sorted(arguments)))
        rows = arguments[name]
        change = draw(st.sampled_from(["entry", "entry", "row", "repeat", "drop", "array"]))
        if change == "array" or not isinstance(rows, list) or not rows:
            arguments[name] = copy.deepcopy(draw(st.sampled_from(ODD_ARRAYS)))
            continue
        i = draw(st.integers(0, len(rows) - 1))
        if change == "drop":
            del rows[i]
        elif change == "repeat":
            rows.insert(i, copy.deepcopy(rows[i]))
        elif change == "row":
            rows[i] = draw(st.sampled_from([*ODD_NUMBERS, (), (1,), (1, 2, 3), rows[0]]))
        else:
            rows[i] = changed_row(draw, rows[i], st.sampled_from(ODD_NUMBERS), whole=True)
    if draw(st.integers(0, 3)) == 0:
        arguments["rule"] = draw(st.sampled_from([*Carve, "even-odd", "", None]))
    return arguments


#: A message names something of the graph: there is nothing else to blame.
CULPRIT = r"point|segment|hole|region|marker|attribute|face|rule"


@pytest.mark.bounds
@pytest.mark.obligation(
    "M5", "a mutated graph has a right result, or a typed error that names the culprit", method="property-based"
)
class TestMutations:
    """However a good graph is changed, the result is that of brute force, or a typed error names something of it."""

    @given(st.one_of(moved(), moved(), mangled()))
    @settings(max_examples=250)
    def test_right_or_refused(self, arguments: Arguments) -> None:
        try:
            pslg = PSLG(**arguments)
            mesh = constrained_delaunay(pslg)
        except ExactMeshError as error:
            message = str(error)
        else:
            check_right(pslg, mesh)
            return
        assert re.search(CULPRIT, message)
        assert "\n" not in message

    @given(st.one_of(moved(), mangled()), st.sampled_from([False, Carve.SEEDS, Carve.EVEN_ODD]))
    @settings(max_examples=100)
    def test_split(self, arguments: Arguments, carve: bool | Carve) -> None:
        """With crossings split nothing crosses any more: the result is a constrained triangulation of some graph."""
        try:
            pslg = PSLG(**arguments)
            mesh = constrained_delaunay(pslg, carve=carve, crossings="split")
        except CrossingError:
            raise
        except ExactMeshError:
            return
        again = PSLG(mesh.points, mesh.segments)
        whole = constrained_delaunay(again, carve=False)
        assert set(corners_of(mesh)) <= set(corners_of(whole))

    def test_control_a_wrong_result(self) -> None:
        """The check refuses a result of another graph."""
        pslg = PSLG(**GOOD)
        other = constrained_delaunay(PSLG(**{**GOOD, "holes": None}))
        with pytest.raises(AssertionError):
            check_right(pslg, other)
