"""Bad input: a typed error that names the culprit in one sentence; nothing is lost, nothing crashes or hangs."""

import dataclasses
import math
import pickle
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from proofs_tests.kernel.strategies import finite
from proofs_tests.mesh.lazy import Lazy

from exactmesh import (
    CoordinateError,
    ExactMeshError,
    Face,
    NonFiniteError,
    QuadEdge,
    ShapeError,
    Triangulation,
    delaunay,
    lawson,
    verify,
)
from exactmesh.errors import (
    CollinearPointsError,
    InadmissibleError,
    SeedError,
    TooFewPointsError,
    TooManyPointsError,
    TopologyError,
)
from exactmesh.io import read

SQUARE = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
MESH = Lazy({"square": lambda: delaunay(SQUARE)})
HALVES = [(0, 1, 2), (0, 2, 3)]
NAN, INFINITY = math.nan, math.inf


def with_row(row: object, at: int = 1) -> list[object]:
    rows: list[object] = [*SQUARE]
    rows.insert(at, row)
    return rows


@dataclass(frozen=True)
class Case:
    """Points that are refused: the error, the indices that it carries, and words of its message."""

    points: object
    error: type[ExactMeshError]
    indices: tuple[int, ...] = ()
    words: str = ""


#: What no function takes as points.
UNREADABLE: dict[str, Case] = {
    "NaN": Case(with_row((NAN, 0.0)), NonFiniteError, (1,), r"points\[1\].*nan"),
    "infinity": Case(with_row((0.0, INFINITY), 4), NonFiniteError, (4,), r"points\[4\].*inf"),
    "several": Case([*SQUARE, (NAN, 0), (0, -INFINITY)], NonFiniteError, (4, 5), r"points\[4\], points\[5\]"),
    "many": Case([(NAN, NAN)] * 9, NonFiniteError, tuple(range(9)), "and 4 more"),
    "NaN among huge ones": Case([(1.7e308, 0.0), (1.7e308, NAN), (0, 0)], NonFiniteError, (1,), "nan"),
    "NaN in float32": Case(np.array([*SQUARE, (NAN, 0.0)], dtype=np.float32), NonFiniteError, (4,), "nan"),
    "three columns": Case([(0, 0, 0)] * 4, ShapeError, (), r"\(4, 3\)"),
    "flat": Case([0.0, 1.0, 2.0], ShapeError, (), r"\(3,\)"),
    "nested": Case([[[0.0, 1.0]]], ShapeError, (), r"\(1, 1, 2\)"),
    "a number": Case(3.0, ShapeError, (), r"\(\)"),
    "ragged": Case([(0, 0), (1,)], ShapeError, (), "points"),
    "strings": Case([("a", "b")] * 3, CoordinateError, (), "dtype"),
    "numerals": Case([("0", "1")] * 3, CoordinateError, (), "dtype"),
    "complex": Case([(0j, 1j)] * 3, CoordinateError, (), "complex"),
    "bool": Case(np.eye(4, 2, dtype=np.bool_), CoordinateError, (), "bool"),
    "dates": Case(np.zeros((3, 2), dtype="datetime64[D]"), CoordinateError, (), "datetime"),
    "None": Case(with_row((None, 0.0)), CoordinateError, (1,), "None"),
    "an integer beyond 2^53": Case(with_row((2**53 + 1, 0)), CoordinateError, (1,), "9007199254740993"),
    "int64 beyond 2^53": Case(np.array([(0, 0), (1, 0), (0, 2**62 + 1)]), CoordinateError, (2,), "rounded"),
    "uint64 to the brim": Case(np.array([(0, 0), (1, 2**64 - 1)], dtype=np.uint64), CoordinateError, (1,), "rounded"),
    "an enormous integer": Case(with_row((10**400, 0)), CoordinateError, (1,), r"points\[1\]"),
}

#: What spans no triangle.
FLAT: dict[str, Case] = {
    "no points": Case(np.empty((0, 2)), TooFewPointsError, (), "0 points"),
    "one point": Case(SQUARE[:1], TooFewPointsError, (), "1 point"),
    "two points": Case(SQUARE[:2], TooFewPointsError, (), "2 points"),
    "all equal": Case([(3.0, 4.0)] * 5, CollinearPointsError, (), r"\[3.0, 4.0\]"),
    "zeros of both signs": Case([(0.0, -0.0), (-0.0, 0.0), (0.0, 0.0)], CollinearPointsError, (), "all 3"),
    "two places": Case([(0, 0), (1, 1), (0, 0), (1, 1)], CollinearPointsError, (), "line"),
    "on a line": Case([(i, 3 * i) for i in range(50)], CollinearPointsError, (), "all 50"),
    "on a subnormal line": Case([(i * 5e-324, i * 1e-323) for i in range(9)], CollinearPointsError, (), "line"),
    "on a huge line": Case([(-1.6e308, -0.8e308), (0, 0), (1.6e308, 0.8e308)], CollinearPointsError, (), "line"),
    "on a long line": Case([(1e-200, 1e-200), (0, 0), (1e200, 1e200)], CollinearPointsError, (), "line"),
}


def assert_refused(call: Callable[[], object], case: Case) -> None:
    with pytest.raises(case.error, match=case.words) as raised:
        call()
    assert raised.value.indices == case.indices
    assert isinstance(raised.value, ValueError)
    assert "\n" not in str(raised.value)


def error_of(call: Callable[[], object]) -> ExactMeshError | None:
    try:
        call()
    except ExactMeshError as error:
        return error
    return None


@pytest.mark.obligation(
    "G1", "every function that takes points refuses the same ones, with the same indices", method="named cases"
)
class TestPoints:
    """Every function that takes points refuses the same ones, for the same reason, with the same indices."""

    @pytest.mark.parametrize("case", UNREADABLE.values(), ids=UNREADABLE.keys())
    def test_unreadable(self, case: Case) -> None:
        calls: list[Callable[[npt.ArrayLike], object]] = [delaunay, lambda p: lawson(p, HALVES), MESH["square"].locate]
        for call in calls:
            assert_refused(lambda call=call: call(case.points), case)  # type: ignore[misc]  # bound here

    @pytest.mark.parametrize("case", FLAT.values(), ids=FLAT.keys())
    def test_flat(self, case: Case) -> None:
        assert_refused(lambda: delaunay(case.points), case)  # type: ignore[arg-type]  # tables are of objects

    def test_control_without_the_culprit(self) -> None:
        """Without the culprit the same input is taken."""
        assert len(delaunay(SQUARE).triangles) == 2
        assert lawson(SQUARE, HALVES).canonical() == MESH["square"].canonical()
        assert len(delaunay([*SQUARE, (2**53, 0)]).triangles) == 3

    def test_too_many(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(sys.modules["exactmesh.delaunay"], "MAX_POINTS", 3)
        assert_refused(lambda: delaunay(SQUARE), Case(SQUARE, TooManyPointsError, (), "4 points; at most 3"))
        assert len(delaunay(SQUARE[:3]).triangles) == 1

    @pytest.mark.parametrize("seed", [-1, -(2**70), 1.0, "0", None])
    def test_seed(self, seed: int) -> None:
        with pytest.raises(SeedError, match="seed="):
            delaunay(SQUARE, seed=seed)

    @given(hnp.arrays(np.float64, st.tuples(st.integers(0, 8), st.just(2)), elements=st.floats()))
    def test_any_doubles(self, points: npt.NDArray[np.float64]) -> None:
        """Any array of doubles is triangulated or refused by name; NaN and infinity are refused first."""
        bad = np.flatnonzero(~np.isfinite(points).all(axis=1)).tolist()
        refusal = error_of(lambda: delaunay(points))
        assert isinstance(refusal, NonFiniteError) is bool(bad)
        if bad:
            assert refusal is not None
            assert list(refusal.indices) == bad
        elif len(points) < 3:
            assert isinstance(refusal, TooFewPointsError)
        elif refusal is not None:
            assert isinstance(refusal, CollinearPointsError)
        else:
            mesh = delaunay(points)
            assert verify(mesh.points, mesh.triangles).ok


GOOD: dict[str, npt.NDArray[np.generic]] = {
    "float32": np.array(SQUARE, dtype=np.float32),
    "float16": np.array(SQUARE, dtype=np.float16),
    "longdouble": np.array(SQUARE, dtype=np.longdouble),
    "int8": np.array(SQUARE, dtype=np.int8),
    "uint64": np.array(SQUARE, dtype=np.uint64),
    "big-endian": np.array(SQUARE, dtype=">f8"),
    "Fortran order": np.asfortranarray(SQUARE),
    "strided": np.repeat(np.array(SQUARE), 2, axis=0)[::2],
    "backwards": np.array(SQUARE[::-1])[::-1],
    "transposed": np.array(SQUARE).T.copy().T,
    "a column of a record": np.array([(0, p) for p in SQUARE], dtype=[("i", "i4"), ("p", "f8", 2)])["p"],
    "objects": np.array(SQUARE, dtype=object),
}


class TestGoodPoints:
    """Any layout, byte order and numeric type whose values are doubles gives the same triangulation, bit for bit."""

    @pytest.mark.parametrize("points", GOOD.values(), ids=GOOD.keys())
    def test_layouts(self, points: npt.NDArray[np.generic]) -> None:
        frozen = points.copy() if points.flags.owndata else points
        frozen.setflags(write=False)
        for array in (points, frozen):
            mesh = delaunay(array)
            assert mesh == MESH["square"]
            assert mesh.points.dtype == np.float64
            assert mesh.locate(array).tolist() == MESH["square"].locate(SQUARE).tolist()
            assert lawson(array, HALVES) == lawson(SQUARE, HALVES)

    @given(st.lists(st.tuples(finite, finite), min_size=3, max_size=7))
    def test_nothing_is_rounded(self, points: list[tuple[float, float]]) -> None:
        try:
            mesh = delaunay(points)
        except CollinearPointsError:
            return
        assert (mesh.points[mesh.representative] == np.array(points)).all()


TRIANGLES: dict[str, tuple[object, type[ExactMeshError], tuple[int, ...]]] = {
    "none": ([], InadmissibleError, (0, 1, 2, 3)),
    "one missing": (HALVES[:1], InadmissibleError, (3,)),
    "out of range": ([(0, 1, 2), (0, 2, 4)], InadmissibleError, (1,)),
    "negative": ([(0, 1, 2), (0, 2, -1)], InadmissibleError, (1,)),
    "a corner repeated": ([(0, 1, 2), (0, 2, 2), (0, 2, 3)], InadmissibleError, (1,)),
    "a triangle repeated": ([*HALVES, (0, 1, 2)], InadmissibleError, (0, 2)),
    "clockwise": ([(0, 1, 2), (0, 3, 2)], InadmissibleError, (1,)),
    "overlapping": ([(0, 1, 2), (0, 1, 3)], InadmissibleError, (0, 1)),
    "four corners": ([(0, 1, 2, 3)], ShapeError, ()),
    "flat": ([0, 1, 2], ShapeError, ()),
    "ragged": ([(0, 1, 2), (0, 2)], ShapeError, ()),
    "doubles": ([(0.0, 1.0, 2.0)], ShapeError, ()),
    "beyond 32 bits": ([(0, 1, 2), (0, 2, 2**40)], ShapeError, (1,)),
    "strings": ([("0", "1", "2")], ShapeError, ()),
}


class TestTriangles:
    """lawson refuses what is no triangulation of the hull, with the verifier's report; from_triangles what is no
    subdivision. Both name the rows."""

    @pytest.mark.parametrize(("triangles", "error", "indices"), TRIANGLES.values(), ids=TRIANGLES.keys())
    def test_lawson(self, triangles: npt.ArrayLike, error: type[ExactMeshError], indices: tuple[int, ...]) -> None:
        with pytest.raises(error) as raised:
            lawson(SQUARE, triangles)
        named = raised.value.indices
        assert set(named) <= set(indices)
        assert bool(named) is bool(indices)
        assert "\n" not in str(raised.value)
        if isinstance(raised.value, InadmissibleError):
            assert not raised.value.report.ok
            assert raised.value.report.violations[0].message in str(raised.value)

    @pytest.mark.parametrize(
        "name", ["out of range", "a corner repeated", "negative", "a triangle repeated", "overlapping"]
    )
    def test_from_triangles(self, name: str) -> None:
        triangles, _, indices = TRIANGLES[name]
        if name == "out of range":  # a quad-edge knows no points: any vertex number will do
            assert len(QuadEdge.from_triangles(triangles)) == 5  # type: ignore[arg-type]
            return
        with pytest.raises(TopologyError) as raised:
            QuadEdge.from_triangles(triangles)  # type: ignore[arg-type]  # tables are of objects
        assert raised.value.indices == indices

    def test_duplicates(self) -> None:
        with pytest.raises(InadmissibleError):
            lawson([*SQUARE, SQUARE[0]], HALVES)

    def test_collinear(self) -> None:
        with pytest.raises(InadmissibleError):
            lawson([(0, 0), (1, 1), (2, 2)], [(0, 1, 2)])

    @pytest.mark.parametrize("n", [0, 1, 2])
    def test_too_few(self, n: int) -> None:
        with pytest.raises(TooFewPointsError, match=f"{n} point"):
            lawson(np.array(SQUARE[:n]).reshape(n, 2), np.empty((0, 3), dtype=np.int32))

    @given(hnp.arrays(np.int64, st.tuples(st.integers(0, 6), st.just(3)), elements=st.integers(-2, 6)))
    def test_any_indices(self, triangles: npt.NDArray[np.int64]) -> None:
        """Any indices: the one triangulation, or a refusal; and a sound quad-edge, or a refusal."""
        refusal = error_of(lambda: lawson(SQUARE, triangles))
        if refusal is None:
            assert lawson(SQUARE, triangles).canonical() == MESH["square"].canonical()
        else:
            assert isinstance(refusal, InadmissibleError)
            assert refusal.indices
            assert not verify(SQUARE, triangles).ok
        refusal = error_of(lambda: QuadEdge.from_triangles(triangles))
        if refusal is None:
            surface = QuadEdge.from_triangles(triangles)
            surface.check()
            assert {frozenset(t) for t in surface.triangles().tolist()} == {frozenset(t) for t in triangles.tolist()}
        else:
            assert isinstance(refusal, TopologyError)
            assert refusal.indices


class TestLocate:
    """Queries are checked as points are, under their own name in the message, and any finite one has an answer."""

    @given(hnp.arrays(np.float64, st.tuples(st.integers(0, 5), st.just(2)), elements=finite))
    def test_any_query(self, queries: npt.NDArray[np.float64]) -> None:
        found = MESH["square"].locate(queries)
        inside = ((queries >= 0.0) & (queries <= 1.0)).all(axis=1)
        assert ((found >= 0) == inside).all()

    def test_in_a_mesh_outside_the_window(self) -> None:
        mesh: Triangulation = delaunay([(0, 0), (1e200, 0), (0, 1e-200)])
        assert mesh.locate([(1e199, 1e-202), (1e200, 1e-200), (5e-324, 5e-324), (-5e-324, 0)]).tolist() == [
            0,
            -1,
            0,
            -1,
        ]


class TestErrorsTravel:
    """Every error survives a pickle with its message and what it carries: a worker process can report it."""

    @pytest.mark.parametrize(
        "fail",
        [
            lambda: delaunay([(0.0, np.nan), (1, 0), (0, 1)]),
            lambda: lawson([(0, 0), (1, 0), (0, 1)], [(0, 2, 1)]),
            lambda: verify([(0, 0), (1, 0), (0, 1)], [(0, 2, 1)]).raise_if_failed(),
            lambda: read("no-such-mesh.txt"),
        ],
    )
    def test_round_trip(self, fail: Callable[[], object]) -> None:
        with pytest.raises(ExactMeshError) as caught:
            fail()
        again = pickle.loads(pickle.dumps(caught.value))
        assert type(again) is type(caught.value)
        assert str(again) == str(caught.value)
        assert again.indices == caught.value.indices
        assert sorted(again.__dict__) == sorted(caught.value.__dict__)


class TestNoCrash:
    """Arrays and labels that lead nowhere are refused before compiled code follows them."""

    @pytest.mark.parametrize("name", ["triangles", "neighbors", "representative"])
    def test_triangulation_by_hand(self, name: str) -> None:
        mesh = delaunay([(0, 0), (1, 0), (0, 1)])
        wrong = np.full_like(getattr(mesh, name), 500_000_000)
        with pytest.raises(ExactMeshError, match=f"{name} has entries outside of"):
            dataclasses.replace(mesh, **{name: wrong})

    def test_corner_without_vertex(self) -> None:
        surface = QuadEdge()
        first, second = surface.make_edge(), surface.make_edge()
        surface.splice(first.sym, second)
        third = surface.connect(second, first)
        for edge in (first, second, third):
            surface.set_left(edge, Face(0))
        with pytest.raises(ExactMeshError, match="no vertex"):
            surface.triangles()

    def test_large_labels(self) -> None:
        corners = [(0, 1, 2**31 - 1)]
        assert sorted(QuadEdge.from_triangles(corners).triangles()[0].tolist()) == [0, 1, 2**31 - 1]

    @pytest.mark.parametrize("claims", [[], (), 5])
    def test_nothing_claimed(self, claims: list[str]) -> None:
        with pytest.raises(ExactMeshError, match="claim"):
            verify([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)], claims=claims)

    def test_claims_from_a_generator(self) -> None:
        claims = (claim for claim in ["delaunay"])
        assert not verify([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1, 2), (0, 1, 2)], claims=list(claims)).ok
        endless: Any = (claim for claim in ["delaunay"])
        assert not verify([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1, 2), (0, 1, 2)], claims=endless).ok
