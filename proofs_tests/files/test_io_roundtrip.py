"""What is written is what is read, bit for bit; and what a decimal means is the nearest double."""

import math
from dataclasses import fields, replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from exactmesh.io import Mesh, mesh_of, read, read_points, read_triangles, write
from exactmesh.io import text as text_module

pytestmark = pytest.mark.once


doubles = st.floats(allow_nan=False, allow_infinity=False)
FILES = settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)


def same(one: Mesh, other: Mesh) -> bool:
    """Bit for bit, so that -0.0 is not 0.0; by arrays of bytes, which no comparison of floats can blur."""
    for field in fields(Mesh):
        mine, theirs = getattr(one, field.name), getattr(other, field.name)
        if isinstance(mine, np.ndarray) and isinstance(theirs, np.ndarray):
            if mine.shape != theirs.shape or mine.dtype != theirs.dtype or mine.tobytes() != theirs.tobytes():
                return False
        elif mine is not theirs and mine != theirs:
            return False
    return True


def rows(
    count: int, width: int, values: "st.SearchStrategy[float] | st.SearchStrategy[int]"
) -> st.SearchStrategy[object]:
    row = st.lists(values, min_size=width, max_size=width)
    return st.lists(row, min_size=count, max_size=count).map(lambda table: np.array(table).reshape(count, width))


@st.composite
def point_files(draw: st.DrawFn) -> Mesh:
    n = draw(st.integers(1, 8))
    a = draw(st.integers(0, 3))
    markers = st.lists(st.integers(-(2**59), 2**59), min_size=n, max_size=n)
    return Mesh(
        np.asarray(draw(rows(n, 2, doubles)), dtype=np.float64),
        point_attributes=np.asarray(draw(rows(n, a, doubles)), dtype=np.float64) if a else None,
        point_markers=draw(st.none() | markers),
        base=draw(st.integers(0, 1)),
    )


@st.composite
def mesh_files(draw: st.DrawFn) -> Mesh:
    """Any content that has a place in the files; it need not be a triangulation."""
    nodes = draw(point_files())
    n = len(nodes.points)
    m, k, b = draw(st.integers(0, 6)), draw(st.integers(0, 6)), draw(st.integers(0, 2))
    corners = np.asarray(draw(rows(m, 3, st.integers(0, n - 1))), dtype=np.int64)
    has_edges = draw(st.booleans())
    markers = st.lists(st.integers(-9, 9), min_size=k, max_size=k)
    if draw(st.booleans()):
        s = draw(st.integers(0, 5))
        of_segments = draw(st.none() | st.lists(st.integers(-(2**59), 2**59), min_size=s, max_size=s))
        nodes = replace(
            nodes,
            segments=np.asarray(draw(rows(s, 2, st.integers(0, n - 1))), dtype=np.int32),
            segment_markers=None if of_segments is None else np.array(of_segments, dtype=np.int64),
            holes=np.asarray(draw(rows(draw(st.integers(0, 2)), 2, doubles)), dtype=np.float64),
            regions=np.asarray(draw(rows(draw(st.integers(0, 2)), 4, doubles)), dtype=np.float64),
        )
    return replace(
        nodes,
        triangles=corners.astype(np.int32),
        triangle_attributes=np.asarray(draw(rows(m, b, doubles)), dtype=np.float64) if b and m else None,
        edges=np.asarray(draw(rows(k, 2, st.integers(0, n - 1))), dtype=np.int32) if has_edges else None,
        edge_markers=np.array(draw(markers), dtype=np.int64) if has_edges and draw(st.booleans()) else None,
    )


def strip() -> Mesh:
    """Two triangles with a common edge, and neighbours."""
    return Mesh(
        [(0, 0), (1, 0), (1, 1), (0, 0.1)],
        triangles=[(0, 1, 2), (0, 2, 3)],
        neighbors=[(-1, 1, -1), (-1, -1, 0)],
        edges=[(0, 1), (1, 2), (2, 0), (2, 3), (3, 0)],
        segments=[(0, 1)],
        base=1,
    )


def fresh(folder: Path, suffix: str) -> Path:
    for old in folder.glob("m.*"):
        old.unlink()
    return folder / f"m{suffix}"


@pytest.mark.obligation(
    "P6", "read(write(mesh)) is the mesh, in every format that can hold it", method="property-based"
)
class TestRoundTrip:
    """read(write(mesh)) = mesh, exactly, in every format that can hold the mesh."""

    @FILES
    @given(mesh=mesh_files(), suffix=st.sampled_from([".ele", ".npz"]))
    def test_meshes(self, tmp_path: Path, mesh: Mesh, suffix: str) -> None:
        path = fresh(tmp_path, suffix)
        write(path, mesh)
        assert same(read(path), mesh)

    @FILES
    @given(mesh=point_files(), suffix=st.sampled_from([".node", ".npz", ".csv"]))
    def test_points(self, tmp_path: Path, mesh: Mesh, suffix: str) -> None:
        path = fresh(tmp_path, suffix)
        write(path, mesh)
        assert same(read_points(path), replace(mesh, base=0) if suffix == ".csv" else mesh)

    @pytest.mark.parametrize("suffix", [".node", ".ele", ".poly", ".neigh", ".edge", ".npz"])
    def test_any_of_the_files_stands_for_all(self, tmp_path: Path, suffix: str) -> None:
        write(tmp_path / f"m{suffix}", strip())
        assert same(read(tmp_path / f"m{suffix}"), strip())

    def test_parts_of_a_mesh(self, tmp_path: Path) -> None:
        for suffix in (".ele", ".npz"):
            path = tmp_path / f"m{suffix}"
            write(path, strip())
            assert same(read_triangles(path), replace(strip(), neighbors=None, edges=None))
            assert same(read_points(path), Mesh(strip().points, base=1))

    @pytest.mark.parametrize("suffix", [".node", ".npz", ".csv"])
    def test_no_points(self, tmp_path: Path, suffix: str) -> None:
        write(tmp_path / f"m{suffix}", Mesh(np.zeros((0, 2))))
        assert same(read(tmp_path / f"m{suffix}"), Mesh(np.zeros((0, 2))))

    def test_extreme_doubles(self, tmp_path: Path) -> None:
        hard = [5e-324, -5e-324, 2.2250738585072014e-308, 2.225073858507201e-308, 1.7976931348623157e308, -0.0, 0.1]
        mesh = Mesh(np.array([(x, y) for x in hard for y in hard]))
        for suffix in (".node", ".npz", ".csv"):
            write(tmp_path / f"m{suffix}", mesh)
            assert same(read_points(tmp_path / f"m{suffix}"), mesh)

    def test_more_rows_than_are_formatted_at_once(self, tmp_path: Path) -> None:
        n = 2 * text_module._ROWS_AT_ONCE + 1
        mesh = Mesh(np.random.default_rng(0).standard_normal((n, 2)), base=1)
        write(tmp_path / "m.node", mesh)
        assert same(read(tmp_path / "m.node"), mesh)

    def test_control_fifteen_digits_are_caught(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        """Numbers written with fifteen digits."""
        mesh = Mesh([(0.1 + 0.2, 1 / 3)])
        monkeypatch.setattr(text_module, "_FLOAT", "%.15g")
        write(tmp_path / "m.node", mesh)
        assert not same(read(tmp_path / "m.node"), mesh)

    def test_control_a_lost_sign_of_zero_is_caught(self) -> None:
        """The sign of a zero lost, and another base."""
        assert not same(Mesh([(0.0, 1.0)]), Mesh([(-0.0, 1.0)]))
        assert not same(Mesh([(0.0, 1.0)]), Mesh([(0.0, 1.0)], base=1))


class TestTriangulationsAreWritten:
    """A triangulation is written as the mesh of its arrays."""

    def test_written_and_read(self, tmp_path: Path) -> None:
        from exactmesh.delaunay import delaunay

        triangulation = delaunay([(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0.25)])
        paths = write(tmp_path / "t.node", triangulation)
        assert [Path(path).suffix for path in paths] == [".node", ".ele", ".neigh", ".edge"]
        back = read(tmp_path / "t.node")
        assert same(back, mesh_of(triangulation))
        assert back.neighbors is not None
        assert np.array_equal(back.neighbors, triangulation.neighbors)

    @pytest.mark.parametrize("suffix", [".node", ".poly", ".npz"])
    def test_of_a_graph(self, tmp_path: Path, suffix: str) -> None:
        from exactmesh import PSLG, constrained_delaunay

        outline = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 4)]
        pslg = PSLG(
            [(0, 0), (9, 0), (9, 9), (0, 9), (1, 1), (3, 1), (1, 3)],
            outline,
            holes=[(1.5, 1.5)],
            regions=[(8, 8, 0.1, -1)],
            segment_markers=range(2, 9),
            point_attributes=np.arange(7.0)[:, None],
        )
        triangulation = constrained_delaunay(pslg)
        paths = write(tmp_path / f"t{suffix}", triangulation)
        if suffix != ".npz":
            assert [Path(path).suffix for path in paths] == [".node", ".ele", ".poly", ".neigh", ".edge"]
        back = read(tmp_path / f"t{suffix}")
        assert same(back, mesh_of(triangulation))
        assert back.segments is not None
        assert back.segments.tolist() == triangulation.segments.tolist()
        for array, expected in (
            (back.segment_markers, triangulation.segment_markers),
            (back.point_markers, triangulation.vertex_markers),
            (back.point_attributes, triangulation.vertex_attributes),
            (back.triangle_attributes, triangulation.triangle_attributes),
            (back.edge_markers, triangulation.edge_markers),
            (back.holes, pslg.holes),
            (back.regions, pslg.regions),
        ):
            assert array is not None
            assert array.tolist() == expected.tolist()


decimals = st.from_regex(r"[+-]?([0-9]{1,20}\.?[0-9]{0,20}|\.[0-9]{1,20})([eE][+-]?[0-9]{1,2})?", fullmatch=True)


def is_nearest(text: str, value: float) -> bool:
    """Whether no double is nearer to the decimal than ``value``, and of two that are equally near the even one is."""
    exact = Fraction(text)
    distance = abs(exact - Fraction(value))
    for neighbour in (math.nextafter(value, -math.inf), math.nextafter(value, math.inf)):
        other = abs(exact - Fraction(neighbour))
        if other < distance or (other == distance and int(math.frexp(value)[0] * 2**53) % 2):
            return False
    return True


@pytest.mark.obligation("P6", "a decimal is read as the nearest double, ties to even", method="property-based")
class TestDecimalsAreRoundedToNearest:
    """The number read is the double nearest to the decimal in the file, ties to even; by exact fractions."""

    @FILES
    @given(x=decimals, y=decimals)
    def test_nearest(self, tmp_path: Path, x: str, y: str) -> None:
        path = tmp_path / "m.node"
        path.write_text(f"1 2 0 0\n0 {x} {y}\n")
        point = read(path).points[0]
        assert is_nearest(x, float(point[0]))
        assert is_nearest(y, float(point[1]))

    def test_control_the_neighbouring_double_is_rejected(self) -> None:
        """The double beside the nearest one, and a tie to odd."""
        assert is_nearest("0.1", 0.1)
        assert not is_nearest("0.1", math.nextafter(0.1, 1))
        assert not is_nearest("9007199254740993", 9007199254740994.0)
