"""The command: what it writes is verified, its exit code is the answer, and a fault is one line that says where."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from exactkernel import jit
from exactmesh import PSLG, cli, constrained_delaunay, triangulate_file
from exactmesh.cli import main
from exactmesh.io import Mesh, read, read_pslg, write, write_pslg
from exactmesh.progress import COMPILING
from exactmesh.verify import Property, Report, verify

pytestmark = pytest.mark.once


SQUARE = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.5, 0.25)]
THIN = [(0.0, 0.0), (4.0, -1.0), (8.0, 0.0), (4.0, 1.0)]
DELAUNAY, NOT_DELAUNAY = [(0, 1, 3), (1, 2, 3)], [(0, 1, 2), (0, 2, 3)]


@pytest.fixture(autouse=True)
def inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def complaint(capsys: pytest.CaptureFixture[str], *arguments: str, code: int = 2) -> str:
    """Run the command, and return its one line on standard error."""
    assert main(arguments) == code
    captured = capsys.readouterr()
    told = "".join(line for line in captured.err.splitlines(keepends=True) if COMPILING not in line)
    assert told.endswith("\n")
    assert told.count("\n") == 1
    assert captured.out == ""
    return told


class TestTriangulate:
    """The files that ``triangulate`` writes are a Delaunay triangulation of the points in its input."""

    @pytest.mark.parametrize("suffix", [".node", ".csv", ".npz"])
    def test_is_delaunay(self, suffix: str, capsys: pytest.CaptureFixture[str]) -> None:
        points = np.random.default_rng(1).random((200, 2))
        write(f"x{suffix}", Mesh(points))
        assert main(["triangulate", f"x{suffix}"]) == 0
        assert capsys.readouterr().out.startswith("200 points, ")
        mesh = read("x.1.ele")
        assert mesh.triangles is not None
        assert mesh.points.tobytes() == points.tobytes()
        assert verify(mesh.points, mesh.triangles).ok
        assert not verify(mesh.points, mesh.triangles[1:]).ok  # control

    @pytest.mark.parametrize(
        ("source", "target"),
        [("x.node", "x.1.node"), ("x.1.node", "x.2.node"), ("x.9.csv", "x.10.node"), ("x.a.npz", "x.a.1.node")],
    )
    def test_names_as_triangle_gives_them(self, source: str, target: str) -> None:
        write(source, Mesh(SQUARE))
        assert main(["triangulate", source]) == 0
        assert sorted(os.listdir()) == sorted([source, target, target.replace(".node", ".ele")])

    def test_output_by_suffix(self) -> None:
        write("x.node", Mesh(SQUARE))
        assert main(["triangulate", "x.node", "-o", "out.npz"]) == 0
        assert main(["triangulate", "x.node", "-o", "out.ele", "--seed", "5"]) == 0
        assert sorted(os.listdir()) == ["out.ele", "out.node", "out.npz", "x.node"]

    def test_attributes_and_duplicates(self, capsys: pytest.CaptureFixture[str]) -> None:
        given = [(0, 0), (1, 0), (0, 0), (0, 1), (1, 0), (0.0, -0.0)]
        write("x.node", Mesh(given, point_attributes=np.arange(6.0)[:, None], point_markers=np.arange(10, 16), base=1))
        assert main(["triangulate", "x.node"]) == 0
        assert "3 of 6 points left out as duplicates: 3 of 1, 5 of 2, 6 of 1\n" in capsys.readouterr().out
        mesh = read("x.1.node")
        assert mesh.base == 1
        assert mesh.point_attributes is not None
        assert mesh.point_markers is not None
        carried = zip(
            mesh.points.tolist(), mesh.point_attributes[:, 0].tolist(), mesh.point_markers.tolist(), strict=True
        )
        assert sorted(carried) == [([0, 0], 0, 10), ([0, 1], 3, 13), ([1, 0], 1, 11)]

    def test_bad_input(self, capsys: pytest.CaptureFixture[str]) -> None:
        Path("nan.node").write_text("3 2\n1 0 0\n2 nan 0\n3 0 1\n")
        write("line.node", Mesh([(0, 0), (1, 1), (2, 2)]))
        write("two.node", Mesh([(0, 0), (1, 1)]))
        write("x.node", Mesh(SQUARE))
        before = sorted(os.listdir())
        assert complaint(capsys, "triangulate", "nix.node") == "exactmesh: nix.node: no such file\n"
        assert "nan.node:3: 'nan'" in complaint(capsys, "triangulate", "nan.node")
        assert complaint(capsys, "triangulate", "line.node").startswith("exactmesh: line.node: ")
        assert complaint(capsys, "triangulate", "two.node").startswith("exactmesh: two.node: 2 points")
        assert "out.csv" in complaint(capsys, "triangulate", "x.node", "-o", "out.csv")
        assert "nowhere" in complaint(capsys, "triangulate", "x.node", "-o", "nowhere/out.node")
        assert "would overwrite" in complaint(capsys, "triangulate", "x.node", "-o", "./x.ele")
        assert "seed" in complaint(capsys, "triangulate", "x.node", "--seed", "many")
        assert sorted(os.listdir()) == before


LAKE = PSLG(
    [(0, 0), (10, 0), (10, 8), (0, 8), (3, 3), (6, 3), (5, 6), (0, 0), (5, 20), (1, 0.5)],
    [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 4)],
    holes=[(4.5, 4)],
    regions=[(1, 1, 42)],
    segment_markers=[5, 5, 6, 7, 9, 9, 9],
    point_attributes=np.arange(10.0)[:, None] + 0.5,
)
CROSS = PSLG(
    [(0, 0), (10, 0), (10, 10), (0, 10), (1, 1), (9.5, 7), (3, 9), (8, 2)],
    [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (6, 7)],
)
RINGS = '{"type": "Polygon", "coordinates": [[[0,0],[9,0],[9,9],[0,9],[0,0]], [[1,1],[2,1],[1,2],[1,1]]]}'


class TestTriangulateGraphs:
    """Of a graph, the constrained Delaunay triangulation of its domain is written, with all that is known of it."""

    def test_as_the_library_does(self, capsys: pytest.CaptureFixture[str]) -> None:
        write_pslg("lake.poly", LAKE, base=1)
        assert main(["triangulate", "lake.poly"]) == 0
        assert capsys.readouterr().out == (
            "1 of 10 points left out as duplicates: 8 of 1\n"
            "8 points, 9 triangles, 7 segments, 1 points outside of the domain left out: "
            "lake.1.node lake.1.ele lake.1.poly\n"
        )
        mesh = read("lake.1.ele")
        expected = constrained_delaunay(LAKE)
        assert mesh.base == 1
        for array, other in (
            (mesh.points, expected.points),
            (mesh.triangles, expected.triangles),
            (mesh.segments, expected.segments),
            (mesh.segment_markers, expected.segment_markers),
            (mesh.point_markers, expected.vertex_markers),
            (mesh.point_attributes, expected.vertex_attributes),
            (mesh.triangle_attributes, expected.triangle_attributes),
            (mesh.holes, LAKE.holes),
            (mesh.regions, LAKE.regions),
        ):
            assert array is not None
            assert array.tolist() == other.tolist()

    def test_rules(self, capsys: pytest.CaptureFixture[str]) -> None:
        Path("ring.geojson").write_text(RINGS)
        counts = {}
        for rule in ("seeds", "even-odd", "none"):
            assert main(["triangulate", "ring.geojson", "--carve", rule, "-o", f"{rule}.npz"]) == 0
            counts[rule] = len(read(f"{rule}.npz").triangles)  # type: ignore[arg-type]  # there are some
        assert counts == {"seeds": 8, "even-odd": 7, "none": 8}
        assert main(["triangulate", "ring.geojson"]) == 0
        assert "7 points, 7 triangles, 7 segments: ring.1.node ring.1.ele ring.1.poly" in capsys.readouterr().out

    def test_an_archive_with_segments(self) -> None:
        write("m.npz", Mesh(LAKE.points[:7], segments=LAKE.segments, holes=LAKE.holes))
        assert main(["triangulate", "m.npz"]) == 0
        assert read("m.1.ele").segments is not None

    def test_crossings(self, capsys: pytest.CaptureFixture[str]) -> None:
        write_pslg("cross.poly", CROSS, base=1)
        assert complaint(capsys, "triangulate", "cross.poly") == (
            "exactmesh: cross.poly: segments cross: 5 and 6 [(1.0, 1.0) to (9.5, 7.0), (3.0, 9.0) to (8.0, 2.0)] "
            "(--crossings split makes their crossings vertices)\n"
        )
        assert main(["triangulate", "cross.poly", "--crossings", "split"]) == 0
        told = capsys.readouterr().out
        facts = re.match(
            r"9 points, 12 triangles, 8 segments, 1 crossings split, segments moved by at most (.*):", told
        )
        assert facts is not None
        assert 0.0 < float(facts[1]) < 1e-15

    def test_a_stale_file_does_not_stay(self) -> None:
        """A .poly of an older mesh would be read as this one's; one with points of its own is somebody's."""
        write("x.node", Mesh(SQUARE))
        write("x.1.poly", Mesh(SQUARE, segments=[(0, 2)]))
        assert main(["triangulate", "x.node"]) == 0
        assert read("x.1.ele").segments is not None
        assert len(read("x.1.ele").segments) == 0  # type: ignore[arg-type]  # seen
        write_pslg("x.1.poly", LAKE)
        assert main(["triangulate", "x.node"]) == 0
        assert read_pslg("x.1.poly") == LAKE

    def test_bad_input(self, capsys: pytest.CaptureFixture[str]) -> None:
        write_pslg("lake.poly", LAKE)
        write("x.node", Mesh(SQUARE))
        text = Path("lake.poly").read_text()
        Path("bad.poly").write_text(text.replace("6 6 4 9", "6 6 6 9"))
        Path("open.poly").write_text(text.replace("3 3 0 7", "3 3 4 7"))
        Path("far.poly").write_text(text.replace("6 6 4 9", "6 6 77 9"))
        Path("bad.json").write_text("{")
        Path("line.geojson").write_text('{"type": "LineString", "coordinates": [[0, 0], [1, 1], [2, 2]]}')
        before = sorted(os.listdir())
        assert "bad.poly: segment 6 begins and ends in point 6" in complaint(capsys, "triangulate", "bad.poly")
        assert complaint(capsys, "triangulate", "open.poly").startswith("exactmesh: open.poly: ")
        assert "far.poly:19: point 77 does not exist" in complaint(capsys, "triangulate", "far.poly")
        assert "bad.json: is no JSON" in complaint(capsys, "triangulate", "bad.json")
        assert "line.geojson: " in complaint(capsys, "triangulate", "line.geojson")
        assert "'odd'; choose from seeds, even-odd, none" in complaint(
            capsys, "triangulate", "lake.poly", "--carve", "odd"
        )
        assert "'ignore'" in complaint(capsys, "triangulate", "lake.poly", "--crossings", "ignore")
        assert "x.node holds points" in complaint(capsys, "triangulate", "x.node", "--carve", "seeds")
        assert "x.node holds points" in complaint(capsys, "triangulate", "x.node", "--crossings", "split")
        assert "would overwrite" in complaint(capsys, "triangulate", "lake.poly", "-o", "lake.node")
        assert sorted(os.listdir()) == before

    def test_numbers_that_count_from_one(self, capsys: pytest.CaptureFixture[str]) -> None:
        write_pslg("lake.poly", LAKE, base=1)
        Path("bad.poly").write_text(Path("lake.poly").read_text().replace("7 7 5 9", "7 7 7 9"))
        told = complaint(capsys, "triangulate", "bad.poly")
        assert "segment 7 begins and ends in point 7" in told

    def test_switches_as_for_triangle(self, capsys: pytest.CaptureFixture[str]) -> None:
        write_pslg("lake.poly", LAKE)
        told = complaint(capsys, "triangulate", "lake.poly", "-pq30a0.1")
        assert "Triangle's switches go behind -s: -s pq30a0.1" in told
        assert "Triangle's switches" not in complaint(capsys, "triangulate", "lake.poly", "--what")
        assert "Triangle's switches" not in complaint(capsys, "verify", "lake.poly", "-pq30")

    def test_remedies_are_those_of_the_command(self, capsys: pytest.CaptureFixture[str]) -> None:
        write_pslg("open.poly", PSLG(SQUARE, [(0, 1), (1, 2), (2, 3)]), base=1)
        told = complaint(capsys, "triangulate", "open.poly")
        assert "--carve none" in told
        assert "carve=" not in told


class TestVerifyDomains:
    """With --domain, the claim is the constrained Delaunay triangulation of that domain."""

    @pytest.fixture(autouse=True)
    def _files(self, capsys: pytest.CaptureFixture[str]) -> None:
        write_pslg("lake.poly", LAKE, base=1)
        Path("ring.geojson").write_text(RINGS)
        assert main(["triangulate", "lake.poly"]) == 0
        assert main(["triangulate", "ring.geojson"]) == 0
        capsys.readouterr()

    def test_verdict(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["verify", "lake.1.ele", "--domain", "lake.poly"]) == 0
        assert "every claim holds" in capsys.readouterr().out
        assert main(["verify", "lake.1.ele", "--domain", "lake.poly", "--claim", "constrained-delaunay"]) == 0
        assert main(["verify", "lake.1.ele", "--domain", "lake.poly", "--claim", "covers_domain"]) == 0
        assert main(["verify", "ring.1.ele", "--domain", "ring.geojson"]) == 0
        assert main(["verify", "ring.1.ele", "--domain", "ring.geojson", "--carve", "seeds"]) == 1

    def test_shapes(self, capsys: pytest.CaptureFixture[str]) -> None:
        bounds = ["--min-angle", "0.001", "--max-angle", "179.999", "--max-area", "1e9"]
        for where in (["--domain", "lake.poly"], []):
            assert main(["verify", "lake.1.ele", *where, *bounds]) == 0
            told = capsys.readouterr().out
            assert all(re.search(rf"\+ {name} +holds\n", told) for name in ("min_angle", "max_angle", "max_area"))
            assert main(["verify", "lake.1.ele", *where, "--min-angle", "61"]) == 1
            told = capsys.readouterr().out
            assert "less than 61" in told
            assert re.search(r"\+ covers_domain +holds\n", told)  # a shape that fails changes nothing else
            assert main(["verify", "lake.1.ele", *where, "--claim", "admissible", "--max-area", "1e-9"]) == 1
            expected = verify(LAKE.points, constrained_delaunay(LAKE).triangles, domain=LAKE, claims=["gabriel"]).ok
            assert main(["verify", "lake.1.ele", *where, "--gabriel"]) == (0 if expected else 1)
            assert "gabriel" in capsys.readouterr().out
        assert "between 0 and 180" in complaint(capsys, "verify", "lake.1.ele", "--min-angle", "200")
        for claim in ("min-angle", "max_area"):
            option = f"--{claim.replace('_', '-')}"
            assert f"needs a bound, by {option}" in complaint(capsys, "verify", "lake.1.ele", "--claim", claim)
            assert main(["verify", "lake.1.ele", "--claim", claim, option, "1e-9"]) in (0, 1)
            capsys.readouterr()

    def test_control_another_mesh_is_no_triangulation_of_the_domain(self) -> None:
        mesh = read("lake.1.ele")
        assert mesh.triangles is not None
        assert mesh.triangle_attributes is not None
        without = replace(mesh, triangles=mesh.triangles[1:], triangle_attributes=mesh.triangle_attributes[1:])
        write("less.npz", without)
        assert main(["verify", "less.npz", "--domain", "lake.poly"]) == 1
        write("other.npz", replace(mesh, triangle_attributes=mesh.triangle_attributes + 1.0))
        assert main(["verify", "other.npz", "--domain", "lake.poly"]) == 1
        assert main(["verify", "ring.1.ele", "--domain", "lake.poly"]) == 1

    @pytest.mark.parametrize("suffix", ["ele", "npz"])
    def test_without_a_domain_it_is_the_files_own(self, suffix: str, capsys: pytest.CaptureFixture[str]) -> None:
        write("copy.npz", read("lake.1.ele"))
        name, place = {"ele": ("lake.1.ele", "lake.1.poly"), "npz": ("copy.npz", "copy.npz")}[suffix]
        assert main(["verify", name]) == 0
        told = capsys.readouterr().out
        assert "  + covers_domain        holds" in told
        assert f"the domain of the segments and holes in {place}; --domain FILE" in told

    def test_control_without_a_domain_less_is_noticed(self, capsys: pytest.CaptureFixture[str]) -> None:
        mesh = read("lake.1.ele")
        assert mesh.triangles is not None
        write("less.npz", replace(mesh, triangles=mesh.triangles[1:], triangle_attributes=None, regions=None))
        assert main(["verify", "less.npz"]) == 1
        assert main(["verify", "less.npz", "--claim", "covers-domain"]) == 1
        assert "! covers_domain" in capsys.readouterr().out

    def test_a_hull_is_one(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["triangulate", "lake.poly", "--carve", "none"]) == 0
        assert main(["verify", "lake.1.ele"]) == 0
        assert "(Checked against the hull, for it is no triangulation of the domain" in capsys.readouterr().out

    def test_segments_that_are_no_domain(self, capsys: pytest.CaptureFixture[str]) -> None:
        triangles = [(0, 1, 2), (0, 2, 3)]
        write("odd.npz", Mesh(SQUARE[:4], triangles=triangles, segments=[(0, 2)], holes=[SQUARE[0]], base=1))
        assert main(["verify", "odd.npz"]) == 0
        assert "(Checked against the hull, for odd.npz: hole 1 at" in capsys.readouterr().out

    def test_bad_input(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert "nix.poly: no such file" in complaint(capsys, "verify", "lake.1.ele", "--domain", "nix.poly")
        assert "'odd'" in complaint(capsys, "verify", "lake.1.ele", "--domain", "lake.poly", "--carve", "odd")
        assert "--carve" in complaint(capsys, "verify", "lake.1.ele", "--carve", "seeds")
        Path("bad.poly").write_text("x 1")
        assert "bad.poly:1:" in complaint(capsys, "verify", "lake.1.ele", "--domain", "bad.poly")


class TestVerify:
    """The exit code is 0 if every claim holds, 1 if one does not, 2 if there is nothing to judge."""

    @pytest.fixture(autouse=True)
    def _meshes(self) -> None:
        write("good.ele", Mesh(THIN, triangles=DELAUNAY))
        write("bad.ele", Mesh(THIN, triangles=NOT_DELAUNAY))
        write("clockwise.npz", Mesh(THIN, triangles=np.array(DELAUNAY)[:, ::-1]))

    def test_verdict(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["verify", "good.ele"]) == 0
        assert "every claim holds" in capsys.readouterr().out
        assert main(["verify", "bad.ele"]) == 1
        captured = capsys.readouterr()
        assert re.search(r"delaunay +fails", captured.out)
        assert captured.err == ""

    def test_claims_and_orientation(self) -> None:
        assert main(["verify", "bad.ele", "--claim", "admissible", "--claim", "covers_hull"]) == 0
        assert main(["verify", "bad.ele", "--claim", "acute"]) == 1
        assert main(["verify", "clockwise.npz"]) == 1
        assert main(["verify", "clockwise.npz", "--orientation", "any"]) == 0

    def test_numbering_is_said(self, capsys: pytest.CaptureFixture[str]) -> None:
        write("one.ele", Mesh(THIN, triangles=NOT_DELAUNAY, base=1))
        assert main(["verify", "one.ele"]) == 1
        assert "count from 0, those in the files from 1" in capsys.readouterr().out
        assert main(["verify", "bad.ele"]) == 1
        assert "count from" not in capsys.readouterr().out

    def test_json(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["verify", "bad.ele", "--json", "-"]) == 1
        printed = json.loads(capsys.readouterr().out)
        assert main(["verify", "bad.ele", "--json", "report.json"]) == 1
        assert json.loads(Path("report.json").read_text()) == printed
        assert printed["ok"] is False
        capsys.readouterr()
        assert main(["verify", "good.ele", "--json", "-"]) == 0
        assert json.loads(capsys.readouterr().out)["ok"] is True

    def test_bad_input(self, capsys: pytest.CaptureFixture[str]) -> None:
        Path("far.node").write_text("3 2\n1 0 0\n2 1 0\n3 0 1\n")
        Path("far.ele").write_text("1 3\n1 1 2 4\n")
        write("points.csv", Mesh(SQUARE))
        assert "far.ele:2: point 4" in complaint(capsys, "verify", "far.ele")
        assert "no triangles" in complaint(capsys, "verify", "points.csv")
        assert "'beautiful'" in complaint(capsys, "verify", "good.ele", "--claim", "beautiful")
        assert "'upwards'" in complaint(capsys, "verify", "good.ele", "--orientation", "upwards")
        assert "MESH" in complaint(capsys, "verify")
        assert "--frobnicate" in complaint(capsys, "verify", "good.ele", "--frobnicate")
        assert "nowhere" in complaint(capsys, "verify", "good.ele", "--json", "nowhere/report.json")


class TestOutputs:
    """No output of ``verify`` replaces an input or another output, by whatever name; what is refused is untouched."""

    @pytest.fixture(autouse=True)
    def _mesh(self) -> None:
        write("good.ele", Mesh(THIN, triangles=DELAUNAY))
        write_pslg("domain.poly", PSLG(THIN, [(0, 1), (1, 2), (2, 3), (3, 0)]))
        os.symlink("good.ele", "symbolic")
        os.link("good.node", "hard")

    @pytest.mark.parametrize("option", ["--json", "--html"])
    @pytest.mark.parametrize("output", ["good.ele", "./good.node", "symbolic", "hard", "domain.poly"])
    def test_inputs_stay(self, option: str, output: str, capsys: pytest.CaptureFixture[str]) -> None:
        before = Path(output).read_bytes()
        told = complaint(capsys, "verify", "good.ele", "--domain", "domain.poly", option, output)
        assert f"{option}: {output}: would overwrite the input" in told
        assert Path(output).read_bytes() == before

    def test_two_outputs_are_two(self, capsys: pytest.CaptureFixture[str]) -> None:
        for one, other in (("same", "./same"), ("-", "-")):
            told = complaint(capsys, "verify", "good.ele", "--json", one, "--html", other)
            assert f"{other}: would overwrite what --json writes" in told
        assert not Path("same").exists()

    def test_control_others_are_written(self, capsys: pytest.CaptureFixture[str]) -> None:
        Path("old.html").write_text("old")
        assert main(["verify", "good.ele", "--json", "new.json", "--html", "old.html"]) == 0
        page = Path("old.html").read_text(encoding="utf-8")
        assert page.startswith("<!doctype html>")
        assert json.loads(Path("new.json").read_text())["ok"] is True
        capsys.readouterr()
        assert main(["verify", "good.ele", "--html", "-"]) == 0
        assert capsys.readouterr().out == page
        assert not Path("-").exists()

    def test_what_cannot_be_written_is_named_as_given(self, capsys: pytest.CaptureFixture[str]) -> None:
        told = complaint(capsys, "verify", "good.ele", "--html", "nowhere/page.html")
        assert told == "exactmesh: nowhere/page.html: No such file or directory\n"


class TestInfo:
    """``info`` prints counts and extents that a reader can check by hand."""

    def test_by_hand(self, capsys: pytest.CaptureFixture[str]) -> None:
        points = [(0, 0), (4, 0), (0, 3), (4, 0)]
        write("m.ele", Mesh(points, triangles=[(0, 1, 2)], point_markers=[5, 6, 7, 8], base=1))
        assert main(["info", "m.ele"]) == 0
        told = capsys.readouterr().out
        facts = {
            "points": "4, counted from 1",
            "duplicates": "1",
            "x": "0.0 to 4.0",
            "y": "0.0 to 3.0",
            "point markers": "5 to 8",
            "triangles": "1",
            "edges": "3, 3 of them on the boundary",
            "angles": "36.8698976 to 90 degrees",
            "areas": "6 to 6, together 6",
            "edge lengths": "3 to 5",
        }
        for name, value in facts.items():
            assert re.search(rf"\b{name} +│ +{re.escape(value)} ", told), (name, told)
        assert not re.search(r"\btriangles +│ +2 ", told)  # control

    def test_of_a_graph(self, capsys: pytest.CaptureFixture[str]) -> None:
        write_pslg("lake.poly", LAKE, base=1)
        assert main(["info", "lake.poly"]) == 0
        told = capsys.readouterr().out
        for name, value in {"segments": "7", "segment markers": "5 to 9", "holes": "1", "regions": "1"}.items():
            assert re.search(rf"\b{name} +│ +{value} ", told), (name, told)

    @pytest.mark.parametrize("mesh", [Mesh(np.zeros((0, 2))), Mesh([(1e308, -1e308)], triangles=np.zeros((0, 3), int))])
    def test_next_to_nothing(self, mesh: Mesh) -> None:
        write("m.npz", mesh)
        assert main(["info", "m.npz"]) == 0

    def test_bad_input(self, capsys: pytest.CaptureFixture[str]) -> None:
        Path("m.node").write_bytes(b"\x00\x01")
        assert complaint(capsys, "info", "m.node").startswith("exactmesh: m.node:1: ")


class TestPlot:
    """``plot`` writes the picture, or says why not."""

    def test_picture(self) -> None:
        write("m.ele", Mesh(THIN, triangles=DELAUNAY))
        assert main(["plot", "m.ele", "-o", "m.png"]) == 0
        assert Path("m.png").read_bytes().startswith(b"\x89PNG")
        assert main(["plot", "m.node", "-o", "m.svg", "--title", "thin"]) == 0
        assert b"</svg>" in Path("m.svg").read_bytes()

    def test_segments(self) -> None:
        write_pslg("lake.poly", LAKE)
        assert main(["plot", "lake.poly", "-o", "lake.svg"]) == 0
        assert b"#c1121f" in Path("lake.svg").read_bytes()
        write("m.ele", Mesh(THIN, triangles=DELAUNAY))
        assert main(["plot", "m.ele", "-o", "m.svg"]) == 0
        assert b"#c1121f" not in Path("m.svg").read_bytes()  # control

    def test_bad_input(self, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
        write("m.ele", Mesh(THIN, triangles=DELAUNAY))
        assert "m.bmp" in complaint(capsys, "plot", "m.ele", "-o", "m.bmp")
        assert "--output" in complaint(capsys, "plot", "m.ele")
        monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
        assert "pip install 'exactmesh[plot]'" in complaint(capsys, "plot", "m.ele", "-o", "m.png")
        assert not Path("m.png").exists()


class TestCompiling:
    """Where nothing is compiled yet, one line says so, on standard error; else there is none."""

    @pytest.mark.parametrize("warm", [True, False])
    @pytest.mark.parametrize("arguments", [("triangulate", "x.node"), ("triangulate", "x.poly"), ("verify", "m.ele")])
    def test_one_line(
        self,
        arguments: tuple[str, str],
        warm: bool,
        capsys: pytest.CaptureFixture[str],
        monkeypatch: pytest.MonkeyPatch,
    ) -> None:
        write("x.node", Mesh(SQUARE))
        write("m.ele", Mesh(THIN, triangles=DELAUNAY))
        write_pslg("x.poly", LAKE)
        monkeypatch.setattr(triangulate_file, "is_cache_warm", lambda *_: warm)
        monkeypatch.setattr(jit, "is_cache_warm", lambda *_: warm)
        assert main(arguments) == 0
        told = capsys.readouterr()
        assert told.err.count("\n") == told.err.count(COMPILING) == int(not warm)
        assert COMPILING not in told.out


class TestDemo:
    """``demo`` needs nothing, verifies what it shows, and names the folder of its pictures."""

    def test_whole(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["demo"]) == 0
        told = capsys.readouterr().out
        assert re.search(r"│ delaunay +│ +holds +│ +\(fails\) +│ +holds +│", told)
        assert re.search(r"constrained_delaunay +│ +│ +holds +│", told)
        for name in ("mosaic", "lake", "course"):
            assert f"exactmesh-demo/{name}.png" in told
            assert Path(f"exactmesh-demo/{name}.png").read_bytes().startswith(b"\x89PNG")

    def test_without_matplotlib(self, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
        assert main(["demo", "-o", "elsewhere"]) == 0
        assert "pip install 'exactmesh[plot]'" in capsys.readouterr().out

    def test_control_a_wrong_triangulation_is_a_violation(self, monkeypatch: pytest.MonkeyPatch) -> None:
        from exactmesh import demo as module

        def verify_less(points: npt.ArrayLike, triangles: npt.NDArray[np.int32], domain: PSLG | None) -> Report:
            return verify(points, triangles[1:], domain=domain)

        monkeypatch.setattr(module, "verify", verify_less)
        assert main(["demo"]) == 1

    def test_a_file_in_the_way(self, capsys: pytest.CaptureFixture[str]) -> None:
        Path("taken").touch()
        assert main(["demo", "-o", "taken"]) == 2
        assert capsys.readouterr().err.startswith("exactmesh: taken: ")


class TestTheCommandItself:
    """Help and version are at hand; an interrupt is one line and code 130; no fault shows a traceback."""

    @pytest.mark.parametrize("arguments", [[], ["--help"], ["verify", "--help"]])
    def test_help(self, arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
        assert main(arguments) == 0
        assert "Usage: exactmesh" in capsys.readouterr().out

    def test_flags_take_no_value(self, capsys: pytest.CaptureFixture[str]) -> None:
        for command in ([], ["triangulate"], ["verify"], ["check-certificate"], ["conformance"]):
            assert main([*command, "--help"]) == 0
            told = capsys.readouterr().out
            assert "--help" in told
            assert "<bool>" not in told

    def test_every_property_is_named(self, capsys: pytest.CaptureFixture[str]) -> None:
        """All but what needs more than the command can be given: a diagram, a size function."""
        assert main(["verify", "--help"]) == 0
        named = re.split(r"[\s,.]+", capsys.readouterr().out)
        assert {property_ for property_ in Property if property_ not in named} == {"voronoi_dual", "max_length"}

    def test_as_a_module(self, inside: Path) -> None:
        write("bad.ele", Mesh(THIN, triangles=NOT_DELAUNAY))
        command = [sys.executable, "-m", "exactmesh", "verify", "bad.ele"]
        assert subprocess.run(command, cwd=inside, capture_output=True, check=False).returncode == 1

    def test_version(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["--version"]) == 0
        assert re.fullmatch(r"exactmesh \d+\.\d+\.\d+\S*\n", capsys.readouterr().out)

    def test_unknown_command(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert "tessellate" in complaint(capsys, "tessellate")

    def test_interrupt(self, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
        def interrupted(_path: str) -> None:
            raise KeyboardInterrupt

        write("m.node", Mesh(SQUARE))
        monkeypatch.setattr(cli, "require_file", interrupted)
        assert complaint(capsys, "info", "m.node", code=130) == "exactmesh: interrupted\n"

    def test_a_fault_of_ours_is_not_hidden(self, monkeypatch: pytest.MonkeyPatch) -> None:
        def broken(_path: str) -> None:
            raise ValueError("a bug")

        monkeypatch.setattr(cli, "require_file", broken)
        with pytest.raises(ValueError, match="a bug"):
            main(["info", "m.node"])

    @pytest.mark.skipif(shutil.which("sh") is None, reason="signals as POSIX has them")
    def test_ctrl_c_in_a_process(self, inside: Path) -> None:
        code = "import os, signal, sys; from exactmesh import cli; "
        code += "signal.signal(signal.SIGINT, signal.default_int_handler); "  # which a job in the background lacks
        code += "cli.require_file = lambda path: "
        code += "os.kill(os.getpid(), signal.SIGINT); sys.exit(cli.main(['info', 'm.node']))"
        done = subprocess.run([sys.executable, "-c", code], cwd=inside, capture_output=True, text=True, check=False)
        assert (done.returncode, done.stderr) == (128 + signal.SIGINT, "exactmesh: interrupted\n")

    @pytest.mark.skipif(shutil.which("sh") is None, reason="pipes as POSIX has them")
    def test_a_reader_that_leaves_is_no_violation(self, inside: Path) -> None:
        write("good.ele", Mesh(THIN, triangles=DELAUNAY))
        reading, writing = os.pipe()
        os.close(reading)
        command = [sys.executable, "-m", "exactmesh.cli", "verify", "good.ele"]
        done = subprocess.run(command, cwd=inside, stdout=writing, stderr=subprocess.PIPE, text=True, check=False)
        os.close(writing)
        assert (done.returncode, done.stderr) == (141, "")
