"""Triangle's other files, texts and folders as dictionaries, and the command with a switch string."""

import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exactmesh import FileFormatError, NonFiniteError, ShapeError, cli, delaunay, voronoi
from exactmesh.io import Mesh, read, read_areas, read_pslg, write, write_areas, write_voronoi
from exactmesh.triangle import TriangleDict, get_data, load, loads, triangulate

pytestmark = pytest.mark.once


LAKE = """8 2 1 1    # x, y, depth, marker
1 0 0 1 0
2 9 0 1 0
3 9 6 2 0
4 0 6 2 0
5 4 2 3 0
6 4 3 3 0
7 5 3 3 0
8 5 2 3 0
8 1
1 1 2 5
2 2 3 5
3 3 4 5
4 4 1 5
5 5 6 7
6 6 7 7
7 7 8 7
8 8 5 7
1
1 4.5 2.5
1
1 1 1 10 0.5
"""


@pytest.fixture(autouse=True)
def inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def table(path: str) -> tuple[list[str], list[list[float]]]:
    """Return the header's fields, and the rows without their numbers; read as simply as can be."""
    lines = Path(path).read_text(encoding="ascii").splitlines()
    return lines[0].split(), [[float(field) for field in line.split()[1:]] for line in lines[1:]]


def circumcentre(points: npt.NDArray[np.float64], corners: list[int]) -> tuple[Fraction, Fraction]:
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(x) for x in points[v].tolist()] for v in corners)
    bx, by, cx, cy = bx - ax, by - ay, cx - ax, cy - ay
    b, c, d = bx * bx + by * by, cx * cx + cy * cy, 2 * (bx * cy - by * cx)
    return ax + (cy * b - by * c) / d, ay + (bx * c - cx * b) / d


class TestAreas:
    """A .area file holds a number a triangle; what is written is read back bit for bit."""

    @given(st.lists(st.floats(allow_nan=False, allow_infinity=False), max_size=9), st.sampled_from([0, 1]))
    def test_round_trip(self, areas: list[float], base: int) -> None:
        write_areas("x.area", np.array(areas), base=base)
        back = read_areas("x.area")
        assert back.dtype == np.float64
        assert back.tobytes() == np.array(areas, dtype=np.float64).tobytes()
        if areas:
            assert Path("x.area").read_text(encoding="ascii").splitlines()[1].split()[0] == str(base)

    @pytest.mark.parametrize(
        ("text", "named"),
        [
            ("2\n1 0.5\n", "2 rows"),
            ("1\n1 x\n", ":2: 'x'"),
            ("1\n1 nan\n", ":2: "),
            ("2\n1 1\n3 1\n", ":3: triangle 3"),
            ("", "empty"),
        ],
    )
    def test_broken(self, text: str, named: str) -> None:
        Path("x.area").write_text(text, encoding="ascii")
        with pytest.raises(FileFormatError) as caught:
            read_areas("x.area")
        assert named in str(caught.value)

    def test_bad_areas(self) -> None:
        with pytest.raises(NonFiniteError):
            write_areas("x.area", np.array([np.nan]))
        with pytest.raises(FileFormatError, match=r"x\.area"):
            read_areas("x.area")


class TestVoronoiFiles:
    """Row j of .v.node is the circumcentre of triangle j, rounded to nearest; row i of .v.edge is dual to edge i: it
    joins the circumcentres on both sides, or goes out at a right angle."""

    @pytest.mark.parametrize("base", [0, 1])
    def test_duality(self, base: int) -> None:
        mesh = delaunay([(0, 0), (4, 0), (1, 3), (5, 4), (2.5, 1), (0.3, 3.7)])
        assert write_voronoi("x.v.edge", mesh, base=base) == ("x.v.node", "x.v.edge")
        assert write_voronoi("y.v.edge", voronoi(mesh), base=base) == ("y.v.node", "y.v.edge")
        for kind in ("node", "edge"):
            assert Path(f"x.v.{kind}").read_bytes() == Path(f"y.v.{kind}").read_bytes()
        header, centres = table("x.v.node")
        assert header == [str(len(mesh.triangles)), "2", "0", "0"]
        exact = [circumcentre(mesh.points, corners) for corners in mesh.triangles.tolist()]
        assert [tuple(centre) for centre in centres] == [(float(x), float(y)) for x, y in exact]
        header, rows = table("x.v.edge")
        assert header == [str(len(mesh.edges)), "0"]
        rays = 0
        for (a, b), row in zip(mesh.edges.tolist(), rows, strict=True):
            around = [t for t, corners in enumerate(mesh.triangles.tolist()) if a in corners and b in corners]
            if row[1] == -1:
                rays += 1
                along = mesh.points[b] - mesh.points[a]
                assert around == [row[0] - base]
                assert np.array_equal(row[2:], [along[1], -along[0]])  # out, for the hull is on the left of a to b
            else:
                assert sorted(around) == sorted(end - base for end in row)
        assert rays == len(mesh.hull)

    def test_beyond_doubles(self) -> None:
        flat = delaunay([(0, 0), (1e300, 0), (2e300, 1e-300)])
        with pytest.raises(NonFiniteError, match="triangle 0"):
            write_voronoi("x.v.node", flat)
        with pytest.raises(FileFormatError, match="on one line"):
            write_voronoi("x.v.node", voronoi([(0, 0), (1, 0)]))
        assert not Path("x.v.node").exists()
        with pytest.raises(FileFormatError, match=r"\.v\.node"):
            write_voronoi("x.node", flat)


def same(one: TriangleDict, other: TriangleDict) -> bool:
    """Tell whether two dictionaries are the same, key by key and bit by bit."""
    return list(one) == list(other) and all(
        np.asarray(one[key]).tobytes() == np.asarray(other[key]).tobytes()  # type: ignore[literal-required]  # a key
        for key in one
    )


class TestLoad:
    """Files, and their texts, give dictionaries that count from 0."""

    def test_lake(self) -> None:
        Path("lake.poly").write_text(LAKE, encoding="ascii")
        lake = load(".", "lake")
        assert lake["vertices"][5].tolist() == [4, 3]
        assert lake["segments"][0].tolist() == [0, 1]
        assert lake["vertex_attributes"][6].tolist() == [3]
        assert lake["segment_markers"].ravel().tolist() == [5, 5, 5, 5, 7, 7, 7, 7]
        assert (lake["holes"].tolist(), lake["regions"].tolist()) == ([[4.5, 2.5]], [[1, 1, 10, 0.5]])
        assert {key: (a.dtype, a.ndim) for key, a in lake.items() if "mark" in key} == {  # type: ignore[attr-defined]
            "vertex_markers": (np.int32, 2), "segment_markers": (np.int32, 2),
        }  # fmt: skip
        assert same(loads(poly=LAKE), lake)
        assert not same(loads(poly=LAKE.replace("10 0.5", "10 0.7")), lake)  # control

    @pytest.mark.parametrize("switches", ["pqen", "po2en", "pAaen"])
    def test_all_files(self, switches: str) -> None:
        """What the command writes is what triangulate returns."""
        Path("lake.poly").write_text(LAKE, encoding="ascii")
        assert cli.main(["triangulate", "lake.poly", "-s", switches]) == 0
        assert same(load(".", "lake.1"), triangulate(load(".", "lake"), switches))

    def test_areas(self) -> None:
        found = loads(node="3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n", ele="1 3\n0 0 1 2\n", area="1\n0 0.1\n")
        assert found["triangle_max_area"].tolist() == [[0.1]]
        assert len(triangulate(found, "ra")["triangles"]) > 4

    @pytest.mark.parametrize(
        ("texts", "named"),
        [
            ({"node": "garbage"}, "node: "),
            ({"ele": "1 3\n0 0 1 2\n"}, "ele: needs the points"),
            ({"poly": "0 2 0 0\n1 0\n1 1 2\n0\n"}, "poly: needs the points"),
            ({"node": "3 2\n1 0 0\n2 1 0\n3 0 1\n", "ele": "1 3\n1 1 2 4\n"}, "ele:2: point 4"),
            ({"node": "3 2\n1 0 0\n2 1 0\n3 0 1\n", "neigh": "1 3\n1 -1 -1 -1\n"}, "neigh: needs the triangles"),
            ({"node": "3 2 0 1\n1 0 0 5000000000\n2 1 0 0\n3 0 1 0\n"}, "32 bits"),
        ],
    )
    def test_broken(self, texts: dict[str, str], named: str) -> None:
        with pytest.raises((FileFormatError, ShapeError)) as caught:
            loads(**texts)
        assert named in str(caught.value)

    def test_nothing(self) -> None:
        with pytest.raises(FileFormatError, match=r"x\.node"):
            load(".", "x")
        assert loads() == {}


def complaint(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """Return the one line on standard error of a command that fails."""
    assert cli.main(["triangulate", *arguments]) == 2
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    return told


class TestCommand:
    """``exactmesh triangulate x.poly -s ...`` reads and writes the files that Triangle's command does."""

    def test_files(self, capsys: pytest.CaptureFixture[str]) -> None:
        Path("lake.poly").write_text(LAKE, encoding="ascii")
        assert cli.main(["triangulate", "lake.poly", "-s", "pq30a2envg"]) == 0
        names = {path.name for path in Path().iterdir()} - {"lake.poly"}
        assert names == {f"lake.1.{s}" for s in ("node", "ele", "poly", "edge", "neigh", "v.node", "v.edge", "off")}
        told = capsys.readouterr().out
        assert re.fullmatch(r"\d+ points, \d+ triangles: lake\.1\.node .*\n", told)
        mesh = read("lake.1.ele")
        assert (mesh.base, len(mesh.holes if mesh.holes is not None else ())) == (1, 1)
        assert cli.main(["verify", "lake.1.ele", "--domain", "lake.poly"]) == 0

    def test_on_and_on(self) -> None:
        """x.1 is refined to x.2, and that to x.3; with z numbers count from 0; areas are read beside them."""
        Path("lake.poly").write_text(LAKE, encoding="ascii")
        assert cli.main(["triangulate", "lake.poly", "-s", "p"]) == 0
        assert cli.main(["triangulate", "lake.1.node", "-s", "rpqa1"]) == 0
        triangles = read("lake.2.ele").triangles
        assert triangles is not None
        write_areas("lake.2.area", np.full(len(triangles), 0.25), base=1)
        assert cli.main(["triangulate", "lake.2.ele", "-s", "rpqaz"]) == 0
        counts = [len(read(f"lake.{k}.node").points) for k in (1, 2, 3)]
        assert counts == sorted(set(counts))
        assert [read(f"lake.{k}.node").base for k in (1, 2, 3)] == [1, 1, 0]
        assert cli.main(["verify", "lake.3.ele", "--domain", "lake.poly"]) == 0

    def test_suppressed(self) -> None:
        write("x.node", Mesh([(0, 0), (1, 0), (0, 1)]))
        assert cli.main(["triangulate", "x.node", "-s", "NPE", "-o", "y.node"]) == 0
        assert cli.main(["triangulate", "x.node", "-s", "cNI"]) == 0
        assert {path.name for path in Path().iterdir()} == {"x.node", "x.ele", "x.poly"}
        assert len(read("x.ele").segments) == 3  # type: ignore[arg-type]  # or the assertion fails
        assert cli.main(["triangulate", "x.node", "-s", "B", "-o", "y.node"]) == 0
        assert table("y.node")[0] == ["3", "2", "0", "0"]
        assert cli.main(["triangulate", "x.node", "-s", "o2", "-o", "y.ele"]) == 0
        assert table("y.ele")[0] == ["1", "6", "0"]

    def test_stale_files(self) -> None:
        """What is left from another mesh would be read with this one, and so is written anew."""
        Path("lake.poly").write_text(LAKE, encoding="ascii")
        assert cli.main(["triangulate", "lake.poly", "-s", "pen"]) == 0
        coarse = read("lake.1.ele")
        assert cli.main(["triangulate", "lake.poly", "-s", "pqa0.5"]) == 0
        fine = read("lake.1.ele")
        assert len(fine.edges) > len(coarse.edges)  # type: ignore[arg-type]  # both are there, or it fails
        assert len(fine.neighbors) == len(fine.triangles)  # type: ignore[arg-type]  # as above

    def test_help(self, capsys: pytest.CaptureFixture[str]) -> None:
        Path("lake.poly").write_text(LAKE, encoding="ascii")
        assert cli.main(["triangulate", "lake.poly", "-s", "h"]) == 0
        told = capsys.readouterr().out
        assert "\nq  no angle below" in told
        assert [path.name for path in Path().iterdir()] == ["lake.poly"]

    def test_notes(self, capsys: pytest.CaptureFixture[str]) -> None:
        Path("lake.poly").write_text(LAKE, encoding="ascii")
        assert cli.main(["triangulate", "lake.poly", "-s", "piX"]) == 0
        assert capsys.readouterr().out.count("note: ") == 2

    def test_errors(self, capsys: pytest.CaptureFixture[str]) -> None:
        Path("lake.poly").write_text(LAKE, encoding="ascii")
        Path("open.poly").write_text("3 2\n1 0 0\n2 1 0\n3 0 1\n2 0\n1 1 2\n2 2 3\n0\n", encoding="ascii")
        write("x.node", Mesh([(0, 0), (1, 0), (0, 1)]))
        write("x.npz", Mesh([(0, 0), (1, 0), (0, 1)]))
        assert "write a0.001" in complaint(capsys, "lake.poly", "-s", "pa1e-3")
        assert "no function to ask" in complaint(capsys, "lake.poly", "-s", "pu")
        assert "lake.node: no such file" in complaint(capsys, "lake.poly", "-s", "rp")
        assert "x.npz: switches are for" in complaint(capsys, "x.npz", "-s", "q")
        assert "out.npz" in complaint(capsys, "x.node", "-s", "q", "-o", "out.npz")
        assert "x.node: is an input" in complaint(capsys, "x.node", "-s", "I")
        assert "no other option" in complaint(capsys, "lake.poly", "-s", "p", "--max-area", "1")
        assert "no other option" in complaint(capsys, "lake.poly", "-s", "p", "--seed", "1")
        assert "the switch c" in complaint(capsys, "open.poly", "-s", "p")
        assert sorted(path.name for path in Path().iterdir()) == ["lake.poly", "open.poly", "x.node", "x.npz"]


class TestRefinementOptions:
    """``--min-angle``, ``--max-area`` and the rest refine what ``triangulate`` makes, and say what came of it."""

    def test_graph(self, capsys: pytest.CaptureFixture[str]) -> None:
        Path("lake.poly").write_text(LAKE, encoding="ascii")
        assert cli.main(["triangulate", "lake.poly", "--min-angle", "30", "--max-area", "2", "--conforming"]) == 0
        told = capsys.readouterr().out
        assert re.search(r"\n\d+ Steiner points, angles 3\d\.\d+ to [\d.]+ degrees\n$", told)
        assert cli.main(["verify", "lake.1.ele", "--domain", "lake.poly"]) == 0
        assert len(read_pslg("lake.1.poly").segments) > 8
        assert cli.main(["triangulate", "lake.poly", "--max-steiner", "3", "--max-area", "0.1"]) == 0
        assert re.search(r"3 Steiner points, .* triangles left as they are: budget\n$", capsys.readouterr().out)

    def test_points(self, capsys: pytest.CaptureFixture[str]) -> None:
        content = get_data("dots")["vertices"]
        write("x.node", Mesh(content))
        assert cli.main(["triangulate", "x.node", "--min-angle", "25"]) == 0
        assert "Steiner points" in capsys.readouterr().out
        assert np.array_equal(read("x.1.node").points[: len(content)], content)
        assert cli.main(["verify", "x.1.ele"]) == 0

    @pytest.mark.parametrize(
        ("option", "value"), [("--max-area", "-1"), ("--min-angle", "60"), ("--steiner", "no"), ("--max-steiner", "-1")]
    )
    def test_errors(self, option: str, value: str, capsys: pytest.CaptureFixture[str]) -> None:
        Path("lake.poly").write_text(LAKE, encoding="ascii")
        assert option[2:].replace("-", "_") in complaint(capsys, "lake.poly", f"{option}={value}")
