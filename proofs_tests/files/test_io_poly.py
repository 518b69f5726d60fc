"""Files of planar straight line graphs: read for what they say, or refused with the place; written bit for bit."""

import json
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from proofs_tests.files.test_io_faults import mutations
from proofs_tests.files.test_io_roundtrip import doubles, rows

from exactmesh import PSLG, ExactMeshError, FaultKind, FileFormatError, GeometryError, PSLGError
from exactmesh.io import Mesh, holds_segments, read, read_pslg, read_triangles, write, write_pslg
from exactmesh.io import text as text_module

pytestmark = pytest.mark.once


FILES = settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
LAKE = """\
5 2 1 1
1 0 0 .5 7
2 8 0 .5 0
3 8 8 -1e3 0
4 0 8 0 9
5 2 2 0 9
4 1
1 1 2 5
2 2 3 0
3 3 4 -6
4 4 1 5
1
1 1.5 4
2
1 5 5 .25 -1
2 6 6 7
"""
SQUARE = [(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0), (2.0, 2.0)]
EXPECTED = PSLG(
    SQUARE,
    [(0, 1), (1, 2), (2, 3), (3, 0)],
    holes=[(1.5, 4)],
    regions=[(5, 5, 0.25, -1), (6, 6, 7, 7)],
    point_markers=[7, 0, 0, 9, 9],
    segment_markers=[5, 0, -6, 5],
    point_attributes=np.array([[0.5], [0.5], [-1000], [0], [0]]),
)
GEOJSON = '{"type": "Feature", "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [0, 4.5], [0, 0]]]}}'


def put(folder: Path, content: str | bytes, name: str = "lake.poly") -> Path:
    path = folder / name
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def counted_from_zero(text: str) -> str:
    """The same file with all numbers of objects one less, its segments as well."""
    lines = [line.split() for line in text.splitlines()]
    for k, line in enumerate(lines):
        if (len(line) > 2 and k > 0) or k in (12,):
            line[0] = str(int(line[0]) - 1)
        if 7 <= k <= 10:
            line[1:3] = [str(int(v) - 1) for v in line[1:3]]
    return "\n".join(map(" ".join, lines))


class TestWhatIsRead:
    """Comments, blank lines, either base, either line end, points in the .node file: the content is the same."""

    @pytest.mark.parametrize(
        "text",
        [
            LAKE,
            LAKE.replace("\n", "   # so it is\n"),
            LAKE.replace("\n", "\n   \n\nonly words here\n"),
            LAKE.replace("\n", "\r\n"),
            LAKE.rstrip("\n"),
            counted_from_zero(LAKE),
            LAKE.replace("1 1.5 4", "0 1.5 4").replace(
                "1 1 2 5\n2 2 3 0\n3 3 4 -6\n4", "0 1 2 5\n1 2 3 0\n2 3 4 -6\n3"
            ),
            LAKE.replace("2 6 6 7", "2 6 6 7 7.0"),
        ],
    )
    def test_one_content_many_texts(self, tmp_path: Path, text: str) -> None:
        assert read_pslg(put(tmp_path, text)) == EXPECTED

    @pytest.mark.parametrize("header", ["0", "0 2 1 1", "0 2 0 0  # see lake.node"])
    def test_points_in_the_node_file(self, tmp_path: Path, header: str) -> None:
        lines = LAKE.splitlines(keepends=True)
        put(tmp_path, "".join(lines[:6]), "lake.node")
        path = put(tmp_path, header + "\n" + "".join(lines[6:]))
        assert read_pslg(path) == EXPECTED
        assert read(path).segments is not None

    def test_no_optional_part(self, tmp_path: Path) -> None:
        pslg = read_pslg(put(tmp_path, "3\n1 0 0\n2 1 0\n3 0 1\n1\n1 1 2\n0\n"))
        assert pslg == PSLG([(0, 0), (1, 0), (0, 1)], [(0, 1)])
        assert read_pslg(put(tmp_path, "3\n1 0 0\n2 1 0\n3 0 1\n0\n0\n0\n")) == PSLG([(0, 0), (1, 0), (0, 1)])

    def test_control_another_content_is_another_graph(self, tmp_path: Path) -> None:
        assert read_pslg(put(tmp_path, LAKE.replace("-6", "-7"))) != EXPECTED
        assert read_pslg(put(tmp_path, LAKE.replace("2 6 6 7", "2 6 6 7 -1"))) != EXPECTED

    def test_whose_file_it_is(self, tmp_path: Path) -> None:
        """Points of its own: a .poly belongs to no mesh beside it. Without: it is part of the mesh."""
        write(tmp_path / "lake.ele", Mesh(SQUARE[:3], triangles=[(0, 1, 2)]))
        path = put(tmp_path, LAKE)
        assert read(tmp_path / "lake.ele").segments is None
        assert read_triangles(path).triangles is None
        assert len(read(path).points) == 5
        put(tmp_path, "0 2\n1\n0 0 2\n0\n")
        for mesh in (read(tmp_path / "lake.ele"), read(path), read_triangles(path)):
            assert mesh.segments is not None
            assert mesh.triangles is not None
            assert (mesh.segments.tolist(), mesh.triangles.tolist()) == ([[0, 2]], [[0, 1, 2]])

    def test_geojson(self, tmp_path: Path) -> None:
        expected = PSLG.from_rings([[(0, 0), (4, 0), (0, 4.5)]])
        for name in ("a.geojson", "a.json"):
            assert read_pslg(put(tmp_path, GEOJSON, name)) == expected
            assert holds_segments(tmp_path / name)
        assert read_pslg(put(tmp_path, b"\xef\xbb\xbf" + GEOJSON.encode(), "a.geojson")) == expected

    def test_other_files_are_taken_for_their_points(self, tmp_path: Path) -> None:
        write(tmp_path / "m.npz", Mesh(SQUARE, segments=[(0, 1)], segment_markers=[4]))
        assert read_pslg(tmp_path / "m.npz") == PSLG(SQUARE, [(0, 1)], segment_markers=[4])
        assert holds_segments(tmp_path / "m.npz")
        write(tmp_path / "m.node", Mesh(SQUARE))
        assert read_pslg(tmp_path / "m.node") == PSLG(SQUARE)
        assert not holds_segments(tmp_path / "m.node")


@st.composite
def graphs(draw: st.DrawFn) -> PSLG:
    """Any PSLG: distinct points, so that all segments have a length; seeds inside of a large triangle."""
    inner = st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
    corners = [(-1e300, -1e300), (1e300, -1e300), (0.5, 1e301)]
    points = [*corners, *draw(st.lists(inner | st.tuples(doubles, doubles), max_size=5, unique=True))]
    n = len(points)
    pairs = [(a, b) for a in range(n) for b in range(n) if a < b and points[a] != points[b]]
    segments = draw(st.lists(st.sampled_from(pairs), max_size=6, unique=True))
    s, a = len(segments), draw(st.integers(0, 2))
    seeds = np.asarray(draw(rows(draw(st.integers(0, 2)), 2, doubles)), dtype=np.float64)
    content: dict[str, object] = {
        "point_markers": draw(st.none() | st.lists(st.integers(-9, 9), min_size=n, max_size=n)),
        "segment_markers": draw(st.none() | st.lists(st.integers(-(2**59), 2**59), min_size=s, max_size=s)),
        "point_attributes": draw(rows(n, a, doubles)) if a else None,
    }
    try:
        regions = np.hstack([seeds, np.asarray(draw(rows(len(seeds), 2, doubles)), dtype=np.float64)])
        return PSLG(points, segments, holes=seeds, regions=regions, **content)  # type: ignore[arg-type]  # of objects
    except PSLGError:  # a seed on a segment, or far out
        return PSLG(points, segments, **content)  # type: ignore[arg-type]  # of objects


def same(one: PSLG, other: PSLG) -> bool:
    """Equal, and bit for bit, so that -0.0 is not 0.0."""
    arrays = ("points", "holes", "regions", "point_attributes")
    values = ((getattr(one, name), getattr(other, name)) for name in arrays)
    return one == other and all(a is b or a.tobytes() == b.tobytes() for a, b in values)


@pytest.mark.obligation("P4", "a PSLG on file is the PSLG, bit for bit", method="property-based")
class TestRoundTrip:
    """read_pslg(write_pslg(pslg)) = pslg."""

    @FILES
    @given(pslg=graphs(), base=st.integers(0, 1))
    def test_poly(self, tmp_path: Path, pslg: PSLG, base: int) -> None:
        write_pslg(tmp_path / "g.poly", pslg, base=base)
        assert same(read_pslg(tmp_path / "g.poly"), pslg)

    @FILES
    @given(st.lists(st.lists(st.tuples(doubles, doubles), min_size=3, max_size=5, unique=True), max_size=1))
    def test_geojson(self, tmp_path: Path, rings: list[list[tuple[float, float]]]) -> None:
        pslg = PSLG.from_rings(rings)
        write_pslg(tmp_path / "g.geojson", pslg)
        assert same(read_pslg(tmp_path / "g.geojson"), pslg)

    def test_nothing(self, tmp_path: Path) -> None:
        nothing = PSLG(np.zeros((0, 2)))
        assert len(write_pslg(tmp_path / "g.poly", nothing)) == 2
        assert read_pslg(tmp_path / "g.poly") == nothing

    def test_control_fifteen_digits_are_caught(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        """Coordinates written with fifteen digits; the sign of a zero lost."""
        pslg = PSLG([(0.1 + 0.2, 0.0), (1 / 3, 1.0)], [(0, 1)])
        monkeypatch.setattr(text_module, "_FLOAT", "%.15g")
        write_pslg(tmp_path / "g.poly", pslg)
        assert not same(read_pslg(tmp_path / "g.poly"), pslg)
        assert not same(PSLG([(0.0, 1.0)]), PSLG([(-0.0, 1.0)]))

    def test_refused(self, tmp_path: Path) -> None:
        with pytest.raises(FileFormatError, match=r"suffix '\.txt'.*\.poly, \.geojson, \.json"):
            write_pslg(tmp_path / "g.txt", EXPECTED)
        with pytest.raises(GeometryError, match="holes, regions"):
            write_pslg(tmp_path / "g.geojson", EXPECTED)
        assert list(tmp_path.iterdir()) == []


class TestTheFaultIsNamed:
    """A broken file raises FileFormatError with its line; a sound file of a faulty graph PSLGError with its name."""

    @pytest.mark.parametrize(
        ("old", "new", "line", "what"),
        [
            ("5 2 1 1", "5 3 1 1", 1, "dimension 3"),
            ("3 8 8 -1e3 0", "3 8 nan -1e3 0", 4, "'nan' is not a finite"),
            ("3 8 8 -1e3 0", "4 8 8 -1e3 0", 4, "point 4 where point 3 belongs"),
            ("5 2 2 0 9\n", "", 6, "2 fields in a row of 5"),
            ("5 2 2 0 9\n", "5 2 2 0 9\n6 1 1 0 9\n", 7, "the header has 5 fields"),
            ("4 1\n1 1 2", "4 2\n1 1 2", 7, "2 markers a segment"),
            ("4 1\n1 1 2", "-4 1\n1 1 2", 7, "number of segments is -4: negative"),
            ("4 1\n1 1 2", "4 0\n1 1 2", 8, "4 fields, where the header announces 3"),
            ("2 2 3 0", "2 2 6 0", 9, "point 6 does not exist; there are 1 to 5"),
            ("2 2 3 0", "2 0 3 0", 9, "point 0 does not exist"),
            ("2 2 3 0", "2 2 3.0 0", 9, "'3.0' is not an integer"),
            ("2 2 3 0", "3 2 3 0", 9, "segment 3 where segment 2 belongs"),
            ("2 2 3 0", "2 2 3", 9, "3 fields in a row of 4"),
            ("4 4 1 5\n", "", 11, "1 fields in a row of 4"),
            ("1\n1 1.5 4", "1 1\n1 1.5 4", 12, "the header has 2 fields"),
            ("1 1.5 4", "1 1.5 1e999", 13, "beyond the largest double"),
            ("1 1.5 4", "7 1.5 4", 13, "hole 7 where hole 0 belongs"),
            ("2 6 6 7", "2 6 6", 16, "3 fields; a region has"),
            ("2 6 6 7", "2 6 6 7 8 9", 16, "6 fields; a region has"),
            ("2 6 6 7", "2 6 x 7", 16, "'x' is not a finite"),
            ("2 6 6 7\n", "", None, "announces 2 regions, the file ends after 1"),
            ("2 6 6 7\n", "2 6 6 7\n3 1 1 1\n", 17, "content after the last region"),
            ("2 6 6 7", "5 6 6 7", 16, "region 5 where region 2 belongs"),
        ],
    )
    def test_poly(self, tmp_path: Path, old: str, new: str, line: int | None, what: str) -> None:
        assert LAKE.count(old) >= 1
        path = put(tmp_path, LAKE.replace(old, new, 1))
        with pytest.raises(FileFormatError, match=re.escape(what)) as caught:
            read_pslg(path)
        assert (caught.value.path, caught.value.line) == (str(path), line)

    @pytest.mark.parametrize(
        ("rest", "what"),
        [
            ("", "ends where the number of segments belongs"),
            ("1\n1 1 2\n", "ends where the number of holes belongs"),
            ("2\n1 1 2\n", "announces 2 rows, the file ends after 1"),
            ("0\n1\n", "announces 1 rows, the file ends after 0"),
            ("1000000000000000\n1 1 2\n", "announces 1000000000000000 rows"),
            ("0\n0\n1000000000000000\n", "announces 1000000000000000 regions"),
        ],
    )
    def test_truncated(self, tmp_path: Path, rest: str, what: str) -> None:
        with pytest.raises(FileFormatError, match=what):
            read_pslg(put(tmp_path, "3\n1 0 0\n2 1 0\n3 0 1\n" + rest))

    def test_missing_node_file(self, tmp_path: Path) -> None:
        with pytest.raises(FileFormatError, match=r"lake\.node: no such file"):
            read_pslg(put(tmp_path, "0\n0\n0\n"))

    def test_a_faulty_graph(self, tmp_path: Path) -> None:
        text = LAKE.replace("2 2 3 0", "2 2 2 0").replace("1 1.5 4", "1 0 4")
        path = put(tmp_path, text)
        with pytest.raises(PSLGError, match=re.escape(f"{path}: segment 2 begins and ends in point 2")) as caught:
            read_pslg(path)
        assert caught.value.path == str(path)
        assert [(fault.kind, fault.indices) for fault in caught.value.faults] == [
            (FaultKind.ZERO_LENGTH, (1,)),
            (FaultKind.HOLE_ON_SEGMENT, (0, 3)),
        ]

    @pytest.mark.parametrize(
        ("text", "error", "what"),
        [
            ("{", FileFormatError, "a.geojson: is no JSON"),
            (b"\xff{}", FileFormatError, "a.geojson: is no"),
            ("", FileFormatError, "a.geojson: is no JSON"),
            (GEOJSON.replace("4.5", "NaN"), FileFormatError, "a.geojson: .*NaN"),
            (GEOJSON.replace("4.5", "4.5, 1"), FileFormatError, "a.geojson: .*third coordinate"),
            (GEOJSON.replace("[0, 4.5], ", ""), PSLGError, "a.geojson: ring 0"),
        ],
    )
    def test_geojson(self, tmp_path: Path, text: str | bytes, error: type[ExactMeshError], what: str) -> None:
        with pytest.raises(error, match=what):
            read_pslg(put(tmp_path, text, "a.geojson"))
        with pytest.raises(FileFormatError, match="no such file"):
            read_pslg(tmp_path / "b.geojson")


def naive(text: str) -> tuple[list[list[float]], ...]:
    """The sections of a .poly file with points of its own, word by word, as its description says."""
    lines: Iterator[list[str]] = iter(
        [line.split() for line in re.sub("#.*", "", text).splitlines() if re.search("[0-9.+-]", line)]
    )
    sections = []
    for _ in range(4):
        header = next(lines, ["0"])
        sections.append([[float(word) for word in next(lines)] for _ in range(int(header[0]))])
    return tuple(sections)


@pytest.mark.obligation(
    "P5", "a mutated graph file is read for what it says, or refused by a typed error", method="property-based"
)
class TestFuzz:
    """A mutated file is refused with an ExactMeshError, or read for what it then says; it is never anything else."""

    @staticmethod
    def outcome(path: Path) -> PSLG | None:
        try:
            return read_pslg(path)
        except ExactMeshError:
            return None

    def agrees(self, path: Path, text: str) -> bool:
        pslg = self.outcome(path)
        if pslg is None or not len(pslg.points):
            return True
        points, segments, holes, regions = naive(text)
        base = int(points[0][0])
        return bool(
            [row[1:3] for row in points] == pslg.points.tolist()
            and [[v - base for v in row[1:3]] for row in segments] == pslg.segments.tolist()
            and [row[1:3] for row in holes] == pslg.holes.tolist()
            and [[*row[1:], row[-1]][:4] for row in regions] == pslg.regions.tolist()
        )

    @settings(FILES, max_examples=400)
    @given(text=mutations(LAKE.encode()))
    def test_any_mutation(self, tmp_path: Path, text: bytes) -> None:
        path = put(tmp_path, text)
        try:
            decoded = text.decode("utf-8").removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")
        except UnicodeDecodeError:
            assert self.outcome(path) is None
            return
        assert self.agrees(path, decoded)

    lines = st.permutations(LAKE.splitlines()) | st.lists(st.sampled_from(LAKE.splitlines()), max_size=16)

    @FILES
    @given(lines=lines)
    def test_lines_in_disorder(self, tmp_path: Path, lines: list[str]) -> None:
        text = "\n".join(lines)
        assert self.agrees(put(tmp_path, text), text)

    def test_control_a_reader_that_looks_away_is_caught(self, tmp_path: Path) -> None:
        """An end of a segment, and a region's attribute, other than in the text."""
        path = put(tmp_path, LAKE)
        assert self.agrees(path, LAKE)
        assert not self.agrees(path, LAKE.replace("2 2 3 0", "2 2 4 0"))
        assert not self.agrees(path, LAKE.replace("2 6 6 7", "2 6 6 8"))

    @FILES
    @given(text=mutations(GEOJSON.encode()))
    def test_geojson(self, tmp_path: Path, text: bytes) -> None:
        pslg = self.outcome(put(tmp_path, text, "a.json"))
        if pslg is not None:
            assert json.loads(text)["type"] in ("Feature", "Polygon")


class TestTheMeshHasIt:
    """Holes and regions belong to segments; what is not finite is refused."""

    def test_refused(self) -> None:
        with pytest.raises(ExactMeshError, match="holes and regions belong to segments"):
            Mesh(SQUARE, holes=[(1, 1)])
        with pytest.raises(ExactMeshError, match=r"regions\[0\] is not finite"):
            Mesh(SQUARE, segments=[(0, 1)], regions=[(1, 1, np.inf, 1)])
        with pytest.raises(ExactMeshError, match=r"holes\[0\]"):
            Mesh(SQUARE, segments=[(0, 1)], holes=[(1, np.nan)])
        with pytest.raises(ExactMeshError, match="segment_markers has 1 rows for no segments"):
            Mesh(SQUARE, segment_markers=[1])
        with pytest.raises(ExactMeshError, match="segments"):
            Mesh(SQUARE, segments=[(0, 5)])
        assert Mesh(SQUARE, segments=np.zeros((0, 2), dtype=np.int32), holes=[(1, 1)]).holes is not None
