"""Formats that meshio reads: what survives the way there and back is verified as it was, what does not is seen."""

import contextlib
import io
import sys
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from exactmesh import PSLG, cli, constrained_delaunay, delaunay, verify
from exactmesh.adapters import files, given_mesh
from exactmesh.errors import FileFormatError
from exactmesh.io import write_pslg
from exactmesh.verify import ADMISSIBLE_MESH, Property, Verdict

pytestmark = pytest.mark.once


meshio = pytest.importorskip("meshio", reason="pip install 'exactmesh[mesh]'")

MESH = delaunay(np.random.default_rng(1).random((40, 2)))
SPACE = np.column_stack([MESH.points, np.zeros(40)])
MIXED = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0.1, 0)])

#: Formats that keep every double and every triangle: meshio's name of the writer, the suffix, its options.
EXACT = {
    "gmsh 2.2": ("gmsh22", ".msh", {}),
    "gmsh 2.2, text": ("gmsh22", ".msh", {"binary": False}),
    "gmsh 4.1": ("gmsh", ".msh", {}),
    "gmsh 4.1, text": ("gmsh", ".msh", {"binary": False}),
    "VTK": ("vtk", ".vtk", {}),
    "VTK, text": ("vtk", ".vtk", {"binary": False}),
    "VTU": ("vtu", ".vtu", {}),
    "Medit": ("medit", ".mesh", {}),
    "Medit, binary": ("medit", ".meshb", {}),
    "Abaqus": ("abaqus", ".inp", {}),
    "OFF": ("off", ".off", {}),
    "PLY": ("ply", ".ply", {}),
    "PLY, text": ("ply", ".ply", {"binary": False}),
    "OBJ": ("obj", ".obj", {}),
    "dolfin": ("dolfin-xml", ".xml", {}),
    "AVS": ("avsucd", ".avs", {}),
    "Netgen": ("netgen", ".vol", {}),
    "Tecplot": ("tecplot", ".dat", {}),
    "Permas": ("permas", ".post", {}),
    "Exodus": ("exodus", ".e", {}),
    "XDMF": ("xdmf", ".xdmf", {}),
}
#: Those of them that hold quadrilaterals beside triangles.
MIXED_FORMATS = sorted(set(EXACT) - {"gmsh 4.1", "gmsh 4.1, text", "OFF", "dolfin", "Tecplot", "XDMF", "Exodus"})

Cells = list[tuple[str, npt.NDArray[np.integer]]]


def written(folder: Path, name: str, points: npt.NDArray[np.float64], cells: Cells) -> Path:
    writer, suffix, options = EXACT[name]
    path = folder / f"mesh{suffix}"
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        try:
            meshio.Mesh(points, cells).write(path, file_format=writer, **options)
        except ModuleNotFoundError as error:
            pytest.skip(f"pip install {error.name}")
    return path


@pytest.mark.obligation(
    "P6", "what meshio writes is read as the same mesh, and verified the same", method="named cases"
)
class TestRoundTrips:
    """What meshio writes and exactmesh reads is the same mesh, number by number; so is its report."""

    @pytest.mark.parametrize("name", EXACT)
    def test_triangles(self, name: str, tmp_path: Path) -> None:
        path = written(tmp_path, name, SPACE, [("triangle", MESH.triangles)])
        given = given_mesh(path)
        assert np.array_equal(given.points, MESH.points)
        assert np.array_equal(given.triangles, MESH.triangles)
        report = verify(path)
        assert report.ok
        assert report.claims == ADMISSIBLE_MESH
        assert report == verify(MESH.points, MESH.triangles, claims=ADMISSIBLE_MESH, orientation="any")
        assert report.verdict(Property.DELAUNAY) is Verdict.HOLDS

    @pytest.mark.parametrize("name", MIXED_FORMATS)
    def test_quadrilaterals(self, name: str, tmp_path: Path) -> None:
        cells: Cells = [("triangle", np.array([[1, 4, 2]])), ("quad", np.array([[0, 1, 2, 3]]))]
        report = verify(written(tmp_path, name, MIXED, cells))
        assert report.ok
        assert report == verify(MIXED[:, :2], cells[0][1], quads=cells[1][1], orientation="any")

    @pytest.mark.parametrize("name", ["gmsh 2.2", "VTK", "Medit", "Abaqus"])
    def test_lines(self, name: str, tmp_path: Path) -> None:
        """Lines are segments: those of the boundary are there, one across is missing."""
        quad = ("quad", np.array([[0, 1, 2, 3]]))
        path = written(tmp_path, name, MIXED, [quad, ("line", np.array([[0, 1], [1, 2]]))])
        assert Property.SEGMENTS_PRESENT in verify(path).claims
        assert verify(path).ok
        path = written(tmp_path, name, MIXED, [quad, ("line", np.array([[0, 1], [0, 2]]))])
        assert verify(path).verdict(Property.SEGMENTS_PRESENT) is Verdict.FAILS

    def test_control_a_fault_survives(self, tmp_path: Path) -> None:
        """A triangle written twice: its report says so."""
        for name in ("gmsh 2.2", "VTU", "OBJ"):
            rows = np.concatenate([MESH.triangles, MESH.triangles[:1]])
            path = written(tmp_path, name, SPACE, [("triangle", rows)])
            assert verify(path).verdict(Property.ADMISSIBLE) is Verdict.FAILS


class TestLosses:
    """What a format loses is there to be seen in what is read."""

    def test_nastran_rounds(self, tmp_path: Path) -> None:
        path = tmp_path / "mesh.bdf"
        meshio.Mesh(SPACE, [("triangle", MESH.triangles)]).write(path, file_format="nastran")
        given = given_mesh(path)
        assert 0 < np.abs(given.points - MESH.points).max() < 1e-11
        assert verify(path) == verify(given.points, MESH.triangles, claims=ADMISSIBLE_MESH, orientation="any")

    def test_rounding_that_closes_a_gap_is_found(self, tmp_path: Path) -> None:
        """Two triangles with a vertex next to their common edge: off by an ulp, and on it when that is lost."""
        near = np.nextafter(0.5, 1.0)
        points = np.array([(0, 0, 0), (1, 1, 0), (0, 1, 0), (near, 0.5, 0), (1, 0, 0)])
        cells: Cells = [("triangle", np.array([[0, 1, 2], [0, 4, 3], [4, 1, 3]]))]
        exact = tmp_path / "mesh.vtk"
        meshio.Mesh(points, cells).write(exact)
        assert verify(exact).ok
        single = tmp_path / "single.vtk"
        meshio.Mesh(points.astype(np.float32), cells).write(single)
        report = verify(single)
        assert report.verdict(Property.ADMISSIBLE) is Verdict.FAILS
        assert report.findings[Property.ADMISSIBLE].violations[0].kind == "hanging_node"

    def test_stl_has_no_indices(self, tmp_path: Path) -> None:
        """Its reader matches corners by position: the same triangles in other numbers."""
        path = tmp_path / "mesh.stl"
        meshio.Mesh(SPACE, [("triangle", MESH.triangles)]).write(path)
        given = given_mesh(path)
        assert len(given.points) == len(MESH.points)
        assert verify(path).ok


SU2 = """NDIME= 2
NELEM= 2
9 0 1 2 3
5 1 4 2
NPOIN= 5
0.0 0.0
1.0 0.0
1.0 1.0
0.0 1.0
2.0 0.1
NMARK= 1
MARKER_TAG= rim
MARKER_ELEMS= 2
3 0 1
3 1 4
"""


class TestFiles:
    """The command takes them; what cannot be read is one line that names the file, and meshio keeps quiet."""

    def test_su2(self, tmp_path: Path) -> None:
        path = tmp_path / "mesh.su2"
        path.write_text(SU2, encoding="utf-8")
        report = verify(path)
        assert report.ok
        assert (report.triangle_count, report.quad_count) == (1, 1)
        assert Property.SEGMENTS_PRESENT in report.claims

    @pytest.mark.parametrize(
        "suffix", [".msh", ".vtk", ".vtu", ".mesh", ".inp", ".stl", ".off", ".ply", ".su2", ".xml"]
    )
    @pytest.mark.parametrize("content", [b"", b"hello\n", b"$MeshFormat\n4.1 0 8\n", b"\x00\xff" * 300])
    def test_broken_files(
        self, suffix: str, content: bytes, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        path = tmp_path / f"broken{suffix}"
        path.write_bytes(content)
        with pytest.raises(FileFormatError, match=f"broken\\{suffix}"):
            verify(path)
        assert cli.main(["verify", str(path)]) == 2
        told = capsys.readouterr()
        assert not told.out
        assert told.err.startswith("exactmesh: ")
        assert len(told.err.splitlines()) == 1
        assert str(path) in told.err

    @pytest.mark.parametrize("cut", [1.0, 0.03, 0.3, 0.6, 0.9, 0.97])
    @pytest.mark.parametrize("binary", [False, True])
    def test_ansys(self, binary: bool, cut: float, tmp_path: Path) -> None:
        """The suffix is Gmsh's as well; of a part meshio's reader waits for the rest, which never comes."""
        path = tmp_path / "ansys.msh"
        meshio.write(path, meshio.Mesh(SPACE[:, :2], [("triangle", MESH.triangles)]), "ansys", binary=binary)
        content = path.read_bytes()
        path.write_bytes(content[: int(cut * len(content))])
        if cut == 1.0:
            assert verify(path).triangle_count == len(MESH.triangles)
        else:
            with pytest.raises(FileFormatError, match=r"ansys\.msh"):
                verify(path)

    @pytest.mark.parametrize("name", EXACT)
    def test_files_that_were_cut_off(self, name: str, tmp_path: Path) -> None:
        """The end of the file is an error, or a mesh with fewer cells; nobody waits for more."""
        path = written(tmp_path, name, SPACE, [("triangle", MESH.triangles)])
        content = path.read_bytes()
        refused = 0
        for end in range(0, len(content), len(content) // 40 + 1):
            path.write_bytes(content[:end])
            try:
                assert verify(path).triangle_count <= len(MESH.triangles)
            except FileFormatError:
                refused += 1
        assert refused > 0

    def test_other_faults(self, tmp_path: Path) -> None:
        with pytest.raises(FileFormatError, match=r"nothing\.msh: no such file"):
            verify(tmp_path / "nothing.msh")
        (tmp_path / "mesh.nosuch").write_text("1")
        with pytest.raises(FileFormatError, match=r"mesh\.nosuch"):
            verify(str(tmp_path / "mesh.nosuch"))
        path = written(tmp_path, "VTK", SPACE + MIXED[[4]] * np.arange(40)[:, None], [("triangle", MESH.triangles)])
        assert verify(path).point_count == 40
        sphere = np.column_stack([MESH.points, MESH.points[:, 0]])
        path = written(tmp_path, "VTK", sphere, [("triangle", MESH.triangles)])
        with pytest.raises(FileFormatError, match=r"mesh\.vtk: the mesh is not planar: point"):
            verify(path)

    def test_without_meshio(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
    ) -> None:
        path = written(tmp_path, "VTK", SPACE, [("triangle", MESH.triangles)])
        monkeypatch.setitem(sys.modules, "meshio", None)
        with pytest.raises(files.MeshioUnavailableError, match=r"mesh\.vtk: .*pip install 'exactmesh\[mesh\]'"):
            verify(path)
        assert cli.main(["verify", str(path)]) == 2
        assert len(capsys.readouterr().err.splitlines()) == 1

    def test_command(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        path = written(tmp_path, "VTU", SPACE, [("triangle", MESH.triangles)])
        assert cli.main(["verify", str(path)]) == 0
        assert "40 points" in capsys.readouterr().out
        assert (
            cli.main(["verify", str(path), "--claim", "delaunay", "--orientation", "ccw", "--min-angle", "0.01"]) == 0
        )
        cells: Cells = [("triangle", np.concatenate([MESH.triangles, MESH.triangles[:1]]))]
        assert cli.main(["verify", str(written(tmp_path, "VTU", SPACE, cells))]) == 1

    def test_info_and_plot(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        path = written(tmp_path, "Medit", SPACE, [("triangle", MESH.triangles)])
        assert cli.main(["info", str(path)]) == 0
        assert f"{len(MESH.edges)}, {len(MESH.hull)} of them on the boundary" in capsys.readouterr().out
        assert cli.main(["plot", str(path), "-o", str(tmp_path / "a.svg")]) == 0
        assert (tmp_path / "a.svg").stat().st_size > 1000
        mixed = [("triangle", np.array([[1, 4, 2]])), ("quad", np.array([[0, 1, 2, 3]]))]
        path = written(tmp_path, "Medit", MIXED, mixed)
        capsys.readouterr()
        assert cli.main(["info", str(path)]) == 0
        assert "quadrilaterals" in capsys.readouterr().out
        assert cli.main(["plot", str(path), "-o", str(tmp_path / "b.svg")]) == 2
        assert "has quadrilaterals" in capsys.readouterr().err

    def test_within(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        """A format of 12 digits is off its domain, by a distance that is told."""
        frame = PSLG.from_rings([[(0, 0), (1, 1 / 3), (2 / 3, 1)]])
        mesh = constrained_delaunay(frame)
        domain, path = tmp_path / "frame.geojson", tmp_path / "mesh.bdf"
        write_pslg(domain, frame)
        space = np.column_stack([mesh.points, np.zeros(len(mesh.points))])
        meshio.Mesh(space, [("triangle", mesh.triangles)]).write(path, file_format="nastran")
        assert cli.main(["verify", str(path), "--domain", str(domain)]) == 1
        assert cli.main(["verify", str(path), "--domain", str(domain), "--within", "1e-9"]) == 0
        capsys.readouterr()
        assert cli.main(["verify", str(path), "--within", "1e-9"]) == 2
        assert "no --domain to be near to" in capsys.readouterr().err

    def test_domain(self, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        frame = PSLG.from_rings([[(0, 0), (4, 0), (4, 4), (0, 4)], [(1, 1), (2, 1), (2, 2)]])
        mesh = constrained_delaunay(frame)
        domain = tmp_path / "frame.geojson"
        write_pslg(domain, frame)
        space = np.column_stack([mesh.points, np.zeros(len(mesh.points))])
        whole = written(tmp_path, "VTK", space, [("triangle", mesh.triangles)])
        assert cli.main(["verify", str(whole), "--domain", str(domain)]) == 0
        assert "+ covers_domain" in capsys.readouterr().out
        part = written(tmp_path, "VTK", space, [("triangle", mesh.triangles[1:])])
        assert cli.main(["verify", str(part), "--domain", str(domain)]) == 1


class TestGmsh:
    """Meshes of triangles and quadrilaterals that gmsh itself makes, with the centres of arcs among their points."""

    @pytest.mark.parametrize("version", [2.2, 4.1])
    def test_disk(self, version: float, tmp_path: Path) -> None:
        gmsh = pytest.importorskip("gmsh", reason="pip install gmsh")
        path = tmp_path / "disk.msh"
        gmsh.initialize(["-noenv"], interruptible=False)
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.option.setNumber("Mesh.MshFileVersion", version)
            gmsh.option.setNumber("Mesh.SaveAll", 1)
            place = [gmsh.model.geo.addPoint(x, y, 0, 0.4) for x, y in ((0, 0), (1, 0), (0, 1), (-1, 0), (0, -1))]
            arcs = [gmsh.model.geo.addCircleArc(place[i], place[0], place[i % 4 + 1]) for i in range(1, 5)]
            gmsh.model.geo.addPlaneSurface([gmsh.model.geo.addCurveLoop(arcs)])
            gmsh.model.geo.synchronize()
            gmsh.option.setNumber("Mesh.RecombineAll", 1)
            gmsh.model.mesh.generate(2)
            gmsh.write(str(path))
        finally:
            gmsh.finalize()
        report = verify(path)
        assert report.ok, report
        assert report.quad_count > 0
        assert report.verdict(Property.ALL_POINTS_USED) is Verdict.FAILS  # the centre
        assert report.verdict(Property.SEGMENTS_PRESENT) is Verdict.HOLDS
