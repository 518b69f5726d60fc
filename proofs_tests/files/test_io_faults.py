"""Files in every shape: either they are read for what they say, or a FileFormatError says where and what."""

import io
import os
import re
import tracemalloc
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from exactmesh.errors import ExactMeshError, FileFormatError, NonFiniteError, ShapeError, TopologyError
from exactmesh.io import Mesh, read, read_points, text, write
from exactmesh.io.atomic import write_whole

pytestmark = pytest.mark.once


NODE = "4 2 1 1\n1 0 0 .5 7\n2 1 0 .5 0\n3 1 1 -1e3 0\n4 0 1 0 9\n"
ELE = "2 3 1\n1 1 2 3 0.25\n2 1 3 4 0.75\n"
NEIGH = "2 3\n1 -1 2 -1\n2 -1 -1 1\n"
EDGE = "2 1\n1 1 2 5\n2 2 3 0\n"
FILES = {".node": NODE, ".ele": ELE, ".neigh": NEIGH, ".edge": EDGE, ".csv": "x,y,marker\n0,0,1\n1.5,2,3\n"}


def put(folder: Path, **contents: str | bytes) -> Path:
    """Write box.node, box.ele, ... and return the stem."""
    for suffix, content in contents.items():
        (folder / f"box.{suffix}").write_bytes(content.encode() if isinstance(content, str) else content)
    return folder / "box"


def fault(path: Path) -> FileFormatError:
    with pytest.raises(FileFormatError) as caught:
        read(path)
    assert str(caught.value).startswith(caught.value.path)
    return caught.value


@pytest.mark.obligation("P5", "one content in many texts is one mesh", method="named cases")
class TestWhatIsRead:
    """Comments, blank lines, missing header fields, either base, either line end: the content is the same."""

    @pytest.mark.parametrize(
        "node",
        [
            NODE,
            "# a box\n\n" + NODE.replace("\n", "   # so it is\n"),
            NODE.replace("\n", "\r\n"),
            NODE.replace("\n", "\r"),
            NODE.rstrip("\n"),
            "\ufeff" + NODE,
            NODE.replace(" ", "\t  "),
            NODE.replace("\n", "\n   \n\nonly words here\n"),
            NODE + "# grün, größer, 点\n",
            "4 2 1 1\n0 0 0 .5 7\n1 1 0 .5 0\n2 1 1 -1e3 0\n3 0 1 0 9",
            NODE.replace("1 0 0 .5 7", "+1 +0 0.0e5 5E-1 07"),
        ],
    )
    def test_one_content_many_texts(self, tmp_path: Path, node: str) -> None:
        mesh = read_points(put(tmp_path, node=node).with_suffix(".node"))
        assert mesh.points.tolist() == [[0, 0], [1, 0], [1, 1], [0, 1]]
        assert mesh.point_attributes is not None
        assert mesh.point_attributes.tolist() == [[0.5], [0.5], [-1000], [0]]
        assert mesh.point_markers is not None
        assert mesh.point_markers.tolist() == [7, 0, 0, 9]
        assert mesh.base == (0 if "\n3 0 1" in node else 1)

    def test_control_another_content_is_another_mesh(self, tmp_path: Path) -> None:
        """A coordinate more for each point announced as an attribute."""
        mesh = read_points(put(tmp_path, node=NODE.replace("4 0 1", "4 0 2")).with_suffix(".node"))
        assert mesh.points.tolist() != [[0, 0], [1, 0], [1, 1], [0, 1]]

    def test_siblings(self, tmp_path: Path) -> None:
        mesh = read(put(tmp_path, node=NODE, ele=ELE, neigh=NEIGH, edge=EDGE).with_suffix(".ele"))
        assert mesh.triangles is not None
        assert mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
        assert mesh.triangle_attributes is not None
        assert mesh.triangle_attributes.tolist() == [[0.25], [0.75]]
        assert mesh.neighbors is not None
        assert mesh.neighbors.tolist() == [[-1, 1, -1], [-1, -1, 0]]
        assert mesh.edges is not None
        assert mesh.edges.tolist() == [[0, 1], [1, 2]]
        assert mesh.edge_markers is not None
        assert mesh.edge_markers.tolist() == [5, 0]

    def test_missing_header_fields(self, tmp_path: Path) -> None:
        stem = put(tmp_path, node="3\n0 0 0\n1 1 0\n2 0 1\n", ele="1\n0 0 1 2\n", edge="1\n0 0 1\n")
        mesh = read(stem.with_suffix(".node"))
        assert mesh.point_attributes is None
        assert mesh.point_markers is None
        assert mesh.edge_markers is None
        assert mesh.triangles is not None
        assert mesh.triangles.tolist() == [[0, 1, 2]]

    def test_the_corners_of_six_node_elements(self, tmp_path: Path) -> None:
        node = "6 2\n1 0 0\n2 2 0\n3 0 2\n4 1 1\n5 0 1\n6 1 0\n"
        mesh = read(put(tmp_path, node=node, ele="1 6 1\n1 1 2 3 4 5 6 0.5\n").with_suffix(".ele"))
        assert mesh.triangles is not None
        assert mesh.triangles.tolist() == [[0, 1, 2]]
        assert mesh.triangle_attributes is not None
        assert mesh.triangle_attributes.tolist() == [[0.5]]
        assert len(mesh.points) == 6

    @pytest.mark.parametrize(
        "table",
        [
            "0,1\n2,3\n",
            "0;1\n2;3\n",
            "0 1\n2 3\n",
            "0\t1\n2\t3",
            "x,y\n0,1\n2,3\n",
            " X ; Y \r\n0;1\r\n2;3\r\n",
            "# from somewhere\n\ny,x\n1,0\n\n3,2\n",
            'name,x,y\n"Paris, #1",0,1\nBonn,2,3\n',
            '"x","y"\n"0","1"\n"2","3"\n',
            "id x y\n7 0 1\n8 2 3\n",
        ],
    )
    def test_csv(self, tmp_path: Path, table: str) -> None:
        assert read(put(tmp_path, csv=table).with_suffix(".csv")).points.tolist() == [[0, 1], [2, 3]]

    def test_csv_attributes_and_markers(self, tmp_path: Path) -> None:
        mesh = read(put(tmp_path, csv="marker,y,x,attribute_h\n5,1,0,.5\n-6,3,2,.25\n").with_suffix(".csv"))
        assert mesh.points.tolist() == [[0, 1], [2, 3]]
        assert mesh.point_markers is not None
        assert mesh.point_markers.tolist() == [5, -6]
        assert mesh.point_attributes is not None
        assert mesh.point_attributes.tolist() == [[0.5], [0.25]]


class TestTheFaultIsNamed:
    """A broken file raises FileFormatError with the line of the fault, and a sentence that names it."""

    @pytest.mark.parametrize(
        ("node", "line", "what"),
        [
            ("", None, "is empty"),
            ("# nothing\n", None, "is empty"),
            ("two 2\n", 1, "'two', not an integer"),
            ("2.0 2\n", 1, "'2.0', not an integer"),
            ("-1 2\n", 1, "negative"),
            ("3 3\n1 0 0 0\n", 1, "dimension 3"),
            ("3 2 0 2\n1 0 0 0\n", 1, "2 markers"),
            ("3 2 0 0 0\n", 1, "5 fields"),
            ("2 2\n1 0 0\n", 2, "announces 2 rows, the file ends after 1"),
            ("1 2\n1 0 0\n# so\n2 1 1\n", 4, "row 2, where the header announces 1"),
            ("0 2\n1 0 0\n", 2, "row 1, where the header announces 0"),
            ("2 2\n1 0 0\n\n2 0\n", 4, "2 fields in a row of 3"),
            ("2 2\n1 0 0\n2 0 0 9\n", 3, "4 fields in a row of 3"),
            ("2 2\n1 0 0 1\n2 0 0 1\n", 2, "4 fields, where the header announces 3"),
            ("2 2\n1 0 0\n2 nan 0\n", 3, "'nan' is not a finite decimal"),
            ("2 2\n1 0 inf\n2 0 0\n", 2, "'inf' is not a finite decimal"),
            ("2 2\n1 0 0\n2 1e999 0\n", 3, "'1e999' is beyond"),
            ("2 2\n1 0 0\n2 0x1p3 0\n", 3, "'0x1p3' is not"),
            ("2 2\n1 0 0\n2 1_0 0\n", 3, "'1_0' is not"),
            ("2 2\n1 0 0\n2 1,5 0\n", 3, "'1,5' is not"),
            ("2 2\n1 0 0\n2.0 1 0\n", 3, "'2.0' is not an integer"),
            ("2 2\n1 0 0\n2 \u0663 0\n", 3, "'\\u0663' is not"),
            ("2 2\n1 0 0\n1 1 0\n", 3, "point 1 where point 2 belongs"),
            ("2 2\n1 0 0\n3 1 0\n", 3, "point 3 where point 2 belongs"),
            ("2 2\n5 0 0\n6 1 0\n", 2, "the first point has number 5"),
            ("1 2 0 1\n1 0 0 0.5\n", 2, "'0.5' is not an integer"),
            ("1 2 0 1\n1 0 0 99999999999999999999\n", 2, "'99999999999999999999' is not an integer"),
            (b"2 2\n1 0 0\n2 \0 0\n", 3, "NUL"),
            (b"2 2\n1 0 0\n2 \xff 0\n", 3, "is not UTF-8 text: byte 0xff"),
            ("2 2\n1 0 0\n2 1 0\n".encode("utf-16"), 1, "NUL"),
        ],
    )
    def test_node(self, tmp_path: Path, node: str | bytes, line: int | None, what: str) -> None:
        error = fault(put(tmp_path, node=node).with_suffix(".node"))
        assert error.line == line
        assert what in str(error)
        assert error.path.endswith("box.node")

    @pytest.mark.parametrize(
        ("suffix", "content", "line", "what"),
        [
            ("ele", "1 3\n1 1 2 5\n", 2, "point 5 does not exist; there are 1 to 4"),
            ("ele", "1 3\n1 0 1 2\n", 2, "point 0 does not exist"),
            ("ele", "1 3\n1 -1 1 2\n", 2, "point -1 does not exist"),
            ("ele", "1 3\n1 1 2 3.5\n", 2, "'3.5' is not an integer"),
            ("ele", "1 4\n1 1 2 3 4\n", 1, "4 nodes per triangle"),
            ("ele", "1 3\n0 1 2 3\n", 2, "triangle 0 where triangle 1 belongs"),
            ("ele", "1 6\n1 1 2 3 4 1 9\n", 2, "point 9"),
            ("neigh", "1 3\n1 -1 -1 -1\n", 1, "1 triangles, the .ele file has 2"),
            ("neigh", "2 2\n1 1 1\n2 1 1\n", 1, "2 neighbours per triangle"),
            ("neigh", "2 3\n1 -1 3 -1\n2 -1 -1 1\n", 2, "triangle 3 does not exist"),
            ("neigh", "2 3\n1 -1 2 -1\n2 -1 1 -1\n", 2, "triangles 1 and 2 are not each other's neighbours"),
            ("neigh", "2 3\n1 -1 -1 -1\n2 -1 -1 1\n", 3, "triangles 2 and 1 are not each other's neighbours"),
            ("neigh", "2 3\n1 -1 2 -1\n2 1 -1 1\n", 3, "triangles 2 and 1 are not each other's neighbours"),
            ("neigh", "2 3\n1 2 2 -1\n2 -1 -1 1\n", 2, "triangles 1 and 2 are not each other's neighbours"),
            ("neigh", "2 3\n1 -1 -1 -1\n2 -1 -1 -1\n", 2, "triangle 1 has a neighbour opposite its corner 2 that is"),
            ("edge", "1 1\n1 1 9 0\n", 2, "point 9"),
            ("edge", "1 1\n1 1 -1 0.5 0.5\n", 2, "5 fields"),
            ("edge", "1 2\n1 1 2 0 0\n", 1, "2 markers"),
        ],
    )
    def test_the_other_files(self, tmp_path: Path, suffix: str, content: str, line: int, what: str) -> None:
        stem = put(tmp_path, **{"node": NODE, "ele": ELE, suffix: content})
        error = fault(stem.with_suffix(".ele"))
        assert (error.line, error.path) == (line, str(stem.with_suffix(f".{suffix}")))
        assert what in str(error)

    @pytest.mark.parametrize(
        ("table", "line", "what"),
        [
            ("", None, "is empty"),
            ("\n# x,y\n", None, "is empty"),
            ("0,1,2\n", 1, "3 columns and no header"),
            ("lon,lat\n1,2\n", 1, "neither a point nor a header"),
            ("x,y,x\n1,2,3\n", 1, "neither a point nor a header"),
            ("x,y,marker,marker\n1,2,3,4\n", 1, "two columns of the same name"),
            ("x,y\n1,2\n3\n", 3, "1 fields in a table of 2"),
            ("x,y\n1,2\n\n3,nan\n", 4, "'nan'"),
            ("name,x,y\na,1,2\nb,,3\n", 3, "'' is not"),
            ("x,y,marker\n1,2,0.5\n", 2, "'0.5' is not an integer"),
            ("1;2\n1,5;2\n", 2, "'1,5'"),
        ],
    )
    def test_csv(self, tmp_path: Path, table: str, line: int | None, what: str) -> None:
        error = fault(put(tmp_path, csv=table).with_suffix(".csv"))
        assert error.line == line
        assert what in str(error)

    def test_what_is_no_file(self, tmp_path: Path) -> None:
        (tmp_path / "folder.node").mkdir()
        os.mkfifo(tmp_path / "pipe.node")
        assert "no such file" in str(fault(tmp_path / "missing.node"))
        assert "is a folder" in str(fault(tmp_path / "folder.node"))
        assert "not a regular file" in str(fault(tmp_path / "pipe.node"))
        assert "unknown suffix '.txt'" in str(fault(tmp_path / "points.txt"))
        assert "unknown suffix ''" in str(fault(tmp_path / "points"))
        assert "null" in str(fault(tmp_path / "a\0.node"))

    def test_missing_sibling(self, tmp_path: Path) -> None:
        assert fault(put(tmp_path, ele=ELE).with_suffix(".ele")).path.endswith("box.node")
        (tmp_path / "box.ele").unlink()
        stem = put(tmp_path, node=NODE, neigh=NEIGH)
        assert fault(stem.with_suffix(".ele")).path.endswith("box.ele")
        assert "box.ele, which is not there" in str(fault(stem.with_suffix(".node")))


@pytest.mark.obligation("P5", "a header that promises 10^15 rows costs no memory", method="named cases")
class TestNothingIsAllocatedOnTheWordOfAHeader:
    """A header that announces 10^15 rows or attributes costs no more memory than the file has content."""

    @staticmethod
    def peak(read_it: Callable[[], object]) -> int:
        tracemalloc.start()
        try:
            with pytest.raises(ExactMeshError):
                read_it()
            return tracemalloc.get_traced_memory()[1]
        finally:
            tracemalloc.stop()

    @pytest.mark.parametrize(
        "node",
        [
            "1000000000000000 2 0 0\n1 0 0\n",
            "1 2 1000000000000000 0\n1 0 0\n",
            "1 2 1000000000000000 1\n",
            "1000000000000000 2 1000000000000000 1\n",
        ],
    )
    def test_node(self, tmp_path: Path, node: str) -> None:
        path = put(tmp_path, node=node).with_suffix(".node")
        assert self.peak(lambda: read(path)) < 1 << 20

    @pytest.mark.parametrize("shape", ["(1000000000000, 2)", "(-1, 2)", "(2, 10000000000000000000000)"])
    def test_npz(self, tmp_path: Path, shape: str) -> None:
        path = tmp_path / "m.npz"
        header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}".encode().ljust(117) + b"\n"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("points.npy", b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header)
        assert self.peak(lambda: read(path)) < 1 << 20

    def test_control_a_trusting_reader_is_caught(self) -> None:
        """A reader that allocates first."""

        def trusting() -> None:
            np.zeros((1 << 20, 2))
            raise ExactMeshError("too late")

        assert self.peak(trusting) > 1 << 20


class TestBothPathsAgree:
    """What numpy parses in one go is what the line-by-line reader makes of it; what it cannot, that one decides."""

    lines = st.lists(st.text("0123456789.+-eEnaif_ x\t", max_size=12), min_size=1, max_size=4)

    @settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
    @given(rows=st.lists(lines.map(" ".join), min_size=1, max_size=4))
    def test_same_outcome(self, tmp_path: Path, rows: list[str]) -> None:
        path = put(tmp_path, node="\n".join([f"{len(rows)} 2", *rows])).with_suffix(".node")
        with pytest.MonkeyPatch.context() as patch:
            quick = self.outcome(path)
            patch.setattr(text, "fast_table", lambda *_: None)
            assert self.outcome(path) == quick

    @pytest.mark.parametrize("row", ["0 1 2", "0 .5 5.", "0 inf 2", "0 1e5 2 ", "0 1e 2", "0 1 2 3", "\x0c0 1\x0b2"])
    def test_same_outcome_examples(self, tmp_path: Path, row: str) -> None:
        self.test_same_outcome.hypothesis.inner_test(self, tmp_path, [row])  # type: ignore[attr-defined]  # untyped

    @staticmethod
    def outcome(path: Path) -> bytes | str:
        try:
            return read(path).points.tobytes()
        except FileFormatError as error:
            return str(error)


def mutations(content: bytes) -> st.SearchStrategy[bytes]:
    """Bytes flipped, cut out, inserted or cut off."""
    position = st.integers(0, len(content))
    replaced = st.tuples(position, position, st.binary(max_size=6)).map(
        lambda cut: content[: min(cut[:2])] + cut[2] + content[max(cut[:2]) :]
    )
    near = st.tuples(
        position, st.integers(0, 3), st.binary(max_size=4) | st.sampled_from([b"-", b"9", b"#", b"\n"])
    ).map(lambda cut: content[: cut[0]] + cut[2] + content[cut[0] + cut[1] :])
    return replaced | near | position.map(lambda end: content[:end]) | st.binary(max_size=200)


def archive() -> bytes:
    stream = io.BytesIO()
    np.savez_compressed(stream, points=[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)], triangles=[(0, 1, 2)], base=0)
    return stream.getvalue()


@pytest.mark.obligation("P5", "a mutated mesh file is read, or refused by a typed error", method="property-based")
class TestFuzz:
    """Whatever happens to a good file, reading it returns a Mesh or raises an ExactMeshError; nothing else."""

    @staticmethod
    def survives(reader: Callable[[Path], object], path: Path) -> bool:
        try:
            reader(path)
        except ExactMeshError:
            return True
        except Exception:
            return False
        return True

    @settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=300)
    @given(data=st.data(), suffix=st.sampled_from([*FILES, ".npz"]))
    def test_mutated(self, tmp_path: Path, data: st.DataObject, suffix: str) -> None:
        put(tmp_path, **{name[1:]: content for name, content in FILES.items()})
        path = tmp_path / f"box{suffix}"
        path.write_bytes(data.draw(mutations(archive() if suffix == ".npz" else FILES[suffix].encode())))
        assert self.survives(read, path)

    def test_control_numpy_alone_does_not_survive(self, tmp_path: Path) -> None:
        """numpy's own reader, whose errors have no type of ours."""
        path = put(tmp_path, node=NODE.replace("-1e3", "-1d3")).with_suffix(".node")
        assert not self.survives(lambda path: np.loadtxt(path, skiprows=1), path)
        assert self.survives(read, path)


class TestArchives:
    """Of an .npz the arrays of a Mesh are taken, whatever their number type, and anything else is refused."""

    def test_number_types(self, tmp_path: Path) -> None:
        points = np.asfortranarray(np.array([(0, 0), (1, 0), (0, 1)], dtype=">f4"))
        np.savez(tmp_path / "m.npz", points=points, triangles=np.array([[0, 1, 2]], dtype=np.uint8), extra=np.zeros(3))
        mesh = read(tmp_path / "m.npz")
        assert mesh.points.tolist() == points.tolist()
        assert mesh.triangles is not None
        assert mesh.triangles.tolist() == [[0, 1, 2]]

    @pytest.mark.parametrize(
        ("arrays", "what"),
        [
            (
                {"faces": np.zeros((1, 3), dtype=int)},
                "no array named 'points', but faces; expected are points (n, 2), and what",
            ),
            ({"points": np.zeros(3)}, "shape (3,)"),
            ({"points": np.array([["a", "b"]])}, "not numbers"),
            ({"points": np.array([[None, 1.0]])}, "not numbers"),
            ({"points": np.array([[np.nan, 1.0]])}, "points[0]"),
            ({"points": np.array([[2**53 + 1, 1]])}, "points[0]"),
            ({"points": np.zeros((3, 2)), "triangles": np.array([[0, 1, 3]])}, "triangles[0] is [0, 1, 3]"),
            ({"points": np.zeros((3, 2)), "triangles": np.array([[0, 1, 2.5]])}, "expected integers"),
            ({"points": np.zeros((3, 2)), "base": np.array(2)}, "base is 2"),
            ({"points": np.zeros((3, 2)), "base": np.array("1")}, "not numbers"),
        ],
    )
    def test_refused(
        self, tmp_path: Path, arrays: dict[str, np.ndarray[tuple[int, ...], np.dtype[np.generic]]], what: str
    ) -> None:
        with (tmp_path / "m.npz").open("wb") as stream, zipfile.ZipFile(stream, "w") as target:
            for name, array in arrays.items():
                member = io.BytesIO()
                np.save(member, array)
                target.writestr(f"{name}.npy", member.getvalue())
        assert what in str(fault(tmp_path / "m.npz"))

    def test_no_archive(self, tmp_path: Path) -> None:
        (tmp_path / "m.npz").write_text(NODE)
        assert "no readable .npz archive" in str(fault(tmp_path / "m.npz"))


@pytest.mark.obligation("P6", "a write that fails leaves the old files as they were", method="named cases")
class TestWholeOrNotAtAll:
    """A write that fails leaves the old files as they were, and nothing beside them."""

    def test_failure_in_the_second_file(self, tmp_path: Path) -> None:
        def broken(_stream: object) -> None:
            raise OSError("disk full")

        (tmp_path / "a").write_text("old")
        with pytest.raises(OSError, match="disk full"):
            write_whole({str(tmp_path / "a"): lambda _: None, str(tmp_path / "b"): broken})
        assert (tmp_path / "a").read_text() == "old"
        assert sorted(os.listdir(tmp_path)) == ["a"]

    def test_interrupt(self, tmp_path: Path) -> None:
        def interrupted(_stream: object) -> None:
            raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            write_whole({str(tmp_path / "a"): interrupted})
        assert os.listdir(tmp_path) == []

    def test_links_and_permissions_stay(self, tmp_path: Path) -> None:
        (tmp_path / "a.npz").touch(mode=0o600)
        (tmp_path / "link.npz").symlink_to("a.npz")
        write(tmp_path / "link.npz", Mesh([(0, 1)]))
        assert (tmp_path / "link.npz").is_symlink()
        assert (tmp_path / "a.npz").stat().st_mode & 0o777 == 0o600
        assert read(tmp_path / "a.npz").points.tolist() == [[0, 1]]

    def test_control_writing_in_place_is_caught(self, tmp_path: Path) -> None:
        """A file that is written in place."""
        path = tmp_path / "a"
        path.write_text("old")
        with pytest.raises(OSError, match="disk full"), path.open("w"):
            raise OSError("disk full")
        assert path.read_text() != "old"

    def test_what_a_suffix_cannot_hold(self, tmp_path: Path) -> None:
        mesh = Mesh([(0, 0), (1, 0), (0, 1)], triangles=[(0, 1, 2)])
        with pytest.raises(FileFormatError, match="points only"):
            write(tmp_path / "m.csv", mesh)
        with pytest.raises(FileFormatError, match=re.escape("nothing to write into a .neigh file")):
            write(tmp_path / "m.neigh", mesh)
        (tmp_path / "m.npz").mkdir()
        with pytest.raises(IsADirectoryError):
            write(tmp_path / "m.npz", mesh)
        assert os.listdir(tmp_path) == ["m.npz"]


class TestMeshIsChecked:
    """A Mesh has consistent arrays, or is not made; its arrays cannot be changed."""

    @pytest.mark.parametrize(
        ("fields", "error"),
        [
            ({"triangles": [(0, 1, 3)]}, TopologyError),
            ({"triangles": [(0, 1)]}, ShapeError),
            ({"triangles": [(0, 1, 2.0)]}, ShapeError),
            ({"triangles": [(0, 1), (1, 2, 0)]}, ShapeError),
            ({"neighbors": [(-1, -1, -1)]}, ShapeError),
            ({"triangles": [(0, 1, 2)], "neighbors": [(-1, -1, 1)]}, TopologyError),
            ({"edges": [(0, -1)]}, TopologyError),
            ({"edge_markers": [1]}, ShapeError),
            ({"point_markers": [1, 2]}, ShapeError),
            ({"point_markers": [[1], [2], [3]]}, ShapeError),
            ({"point_markers": np.array([1, 2, 2**63], dtype=np.uint64)}, ShapeError),
            ({"point_attributes": [1.0, 2.0, 3.0]}, ShapeError),
            ({"point_attributes": [["a"], ["b"], ["c"]]}, ExactMeshError),
            ({"point_attributes": [[1.0], [np.nan], [3.0]]}, NonFiniteError),
            ({"point_attributes": [[1], [2**53 + 1], [3]]}, ExactMeshError),
            ({"base": 2}, ShapeError),
        ],
    )
    def test_refused(self, fields: dict[str, object], error: type[ExactMeshError]) -> None:
        with pytest.raises(error):
            Mesh([(0, 0), (1, 0), (0, 1)], **fields)  # type: ignore[arg-type]  # wrong on purpose

    def test_frozen(self) -> None:
        given_points = np.array([(0.0, 0.0), (1.0, 0.0)])
        mesh = Mesh(given_points)
        given_points[0] = 7.0
        assert mesh.points.tolist() == [[0, 0], [1, 0]]
        with pytest.raises(ValueError, match="read-only"):
            mesh.points[0, 0] = 1.0
