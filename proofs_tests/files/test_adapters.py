"""Everybody's meshes: what a package holds reaches the verifier bit for bit; what is no mesh is refused by name."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt
import pytest
import shapely
from matplotlib.tri import Triangulation as PlotTriangulation
from scipy.spatial import Delaunay

import exactmesh.triangle
from exactkernel import ShapeError
from exactmesh import PSLG, constrained_delaunay, delaunay, io, refine, verify
from exactmesh.adapters import GivenMesh, given_mesh
from exactmesh.errors import AdapterError, CoordinateError, FileFormatError
from exactmesh.verify import (
    ADMISSIBLE_MESH,
    CONSTRAINED_TRIANGULATION,
    DELAUNAY_TRIANGULATION,
    DOMAIN_TRIANGULATION,
    Orientation,
    Property,
    Verdict,
)

meshio = pytest.importorskip("meshio", reason="pip install 'exactmesh[mesh]'")
skfem = pytest.importorskip("skfem", reason="pip install scikit-fem")

POINTS = np.random.default_rng(5).random((40, 2))
SQUARE = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (2.0, 0.5)])
TRIANGLES, QUADS = [(1, 4, 2)], [(0, 1, 2, 3)]
FRAME = PSLG.from_rings([[(0, 0), (4, 0), (4, 4), (0, 4)], [(1, 1), (2, 1), (2, 2)]])


def raised(points: npt.ArrayLike, z: float = 0.0) -> npt.NDArray[np.float64]:
    """The points in space."""
    return np.column_stack([np.asarray(points), np.full(len(np.asarray(points)), z)])


def corners(given: GivenMesh) -> set[frozenset[tuple[float, float]]]:
    """The cells, as sets of positions."""
    rows = [*given.triangles.tolist(), *given.quads.tolist()]
    return {frozenset((float(x), float(y)) for x, y in given.points[row]) for row in rows}


def expected(points: npt.ArrayLike, *cells: npt.ArrayLike) -> set[frozenset[tuple[float, float]]]:
    given = np.asarray(points, dtype=np.float64)
    return {frozenset(map(tuple, given[row].tolist())) for part in cells for row in np.asarray(part).tolist()}


@pytest.mark.obligation("A1", "a pair, an object and arrays are the same mesh", method="named cases")
class TestArrays:
    """A pair, an object with points and triangles, and arrays are the same mesh."""

    def test_they_agree(self) -> None:
        mesh = delaunay(POINTS)
        report = verify(mesh.points, mesh.triangles)
        assert report.ok
        assert verify((mesh.points, mesh.triangles)) == report
        assert verify((mesh.points.tolist(), mesh.triangles.tolist())) == report
        assert verify(SimpleNamespace(points=mesh.points, triangles=mesh.triangles)) == report
        assert verify(given_mesh((mesh.points, mesh.triangles))) == report

    def test_quadrilaterals(self) -> None:
        report = verify(SQUARE, TRIANGLES, quads=QUADS)
        assert verify(SimpleNamespace(points=SQUARE, triangles=TRIANGLES, quads=QUADS)) == report
        assert verify((SQUARE[:4], QUADS)) == verify(SQUARE[:4], quads=QUADS)
        assert verify(SimpleNamespace(points=SQUARE[:4], quads=np.array(QUADS))).ok

    def test_points_in_a_plane_of_space(self) -> None:
        report = verify(SQUARE, TRIANGLES)
        assert verify((raised(SQUARE, 3), TRIANGLES)) == report
        assert verify(SimpleNamespace(points=raised(SQUARE), triangles=TRIANGLES)) == report
        with pytest.raises(AdapterError, match="the pair is not planar: point 4"):
            verify((np.column_stack([SQUARE, np.arange(5) > 3]), TRIANGLES))

    def test_what_is_given_wins(self) -> None:
        pair = ([(0, 0), (0, 1), (1, 0)], [(0, 1, 2)])
        assert verify(pair).verdict(Property.ORIENTATION) is Verdict.FAILS
        assert verify(pair, orientation="any").ok
        assert verify(pair, claims=["admissible"]).claims == (Property.ADMISSIBLE,)
        assert verify(pair, min_angle=45).verdict(Property.MIN_ANGLE) is Verdict.HOLDS

    @pytest.mark.parametrize(
        "value",
        [
            POINTS,
            POINTS.tolist(),
            [(0.0, 0.0), (1.0, 0.0)],
            ((0.0, 0.0), (1.0, 0.0)),
            (POINTS, [(0, 1)]),
            (POINTS, [(0, 1, 2, 3, 4)]),
            {},
            {"vertices": POINTS},
            None,
            3,
            b"mesh.msh",
            object(),
            Delaunay,
            SimpleNamespace(points=POINTS),
        ],
    )
    def test_control_what_is_no_mesh_is_refused(self, value: object) -> None:
        """Values that are no mesh."""
        with pytest.raises(AdapterError):
            verify(value)

    def test_the_refusal_lists_what_is_understood(self) -> None:
        with pytest.raises(AdapterError, match=r"builtins\.int is no mesh; understood are .*scipy.*meshio.*scikit-fem"):
            verify(3)
        with pytest.raises(AdapterError, match="an array of points alone has no triangles"):
            verify(POINTS)


@pytest.mark.obligation("A1", "no column is cut off", method="named cases")
class TestWidths:
    """Law: no column is cut off: rows that are wider than their cells are refused, whatever they came in."""

    class Plain:
        """Anything with points and triangles."""

        def __init__(self, triangles: object) -> None:
            self.points = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
            self.triangles = triangles

    @pytest.mark.parametrize("triangles", [[(0, 1, 2, 3)], [(0, 1, 2, 3, 99)], [(0, 1)], [(0, 1, 2), (0, 1)]])
    def test_triangles(self, triangles: object) -> None:
        points = self.Plain(None).points
        for mesh in (self.Plain(triangles), {"vertices": points, "triangles": triangles}):
            with pytest.raises(ShapeError, match="triangles"):
                verify(mesh)

    @pytest.mark.parametrize(
        ("name", "value"),
        [
            ("segments", [(0, 1, 7)]),
            ("regions", "abc"),
            ("regions", [(1, 2, 3), (1,)]),
            ("triangle_attributes", [1, 2, 3]),
            ("triangle_attributes", ["a"]),
        ],
    )
    def test_dictionaries(self, name: str, value: object) -> None:
        ring = [(0, 1), (1, 2), (2, 0)]
        content = {"vertices": [(0, 0), (1, 0), (0, 1)], "triangles": [(0, 1, 2)], "segments": ring}
        assert verify(content).ok
        with pytest.raises(ShapeError, match=name):
            verify({**content, "regions": [(0.2, 0.2, 1, 0)], name: value})

    def test_control_rows_of_three(self) -> None:
        """None: rows as wide as their cells are taken."""
        assert verify(self.Plain([(0, 1, 2), (0, 2, 3)])).ok

    def test_ragged_pair(self) -> None:
        with pytest.raises(ShapeError, match="second array"):
            given_mesh((np.zeros((3, 2)), [(0, 1, 2), (1,)]))


@pytest.mark.obligation("A1", "what exactmesh made is verified as what it promises", method="named cases")
class TestOwn:
    """What exactmesh made is verified as what it promises, its domain with it; a fault in it is found."""

    def test_triangulations(self) -> None:
        assert verify(delaunay(POINTS)).claims == DELAUNAY_TRIANGULATION
        assert verify(delaunay(POINTS)).ok
        mesh = constrained_delaunay(FRAME)
        assert verify(mesh).ok
        assert verify(mesh) == verify(mesh.points, mesh.triangles, domain=mesh.domain)
        hull = constrained_delaunay(FRAME, carve=False)
        assert verify(hull).claims == CONSTRAINED_TRIANGULATION
        assert verify(hull).ok

    def test_refinement(self) -> None:
        done = refine(FRAME, min_angle=25)
        assert given_mesh(done).source == "a Refinement"
        report = verify(done)
        assert report.claims == DOMAIN_TRIANGULATION
        assert report.triangle_count == len(done.triangulation.triangles)

    def test_a_refinement_is_as_far_from_its_domain_as_it_says(self) -> None:
        done = refine(PSLG.from_rings([[(0, 0), (3, 0.1), (3.3, 2.9), (0.2, 3)]]), min_angle=25, max_area=0.1)
        assert done.displacement_squared > 0
        assert verify(done).ok
        domain = done.triangulation.pslg
        report = verify(done, domain=domain, within=done.displacement)
        assert report.ok
        assert report.distance_squared == done.displacement_squared
        assert not verify(done, domain=domain).ok

    def test_labels(self) -> None:
        regions = PSLG(FRAME.points, FRAME.segments, holes=[(1.8, 1.5)], regions=[(0.5, 0.5, 7)])
        mesh = constrained_delaunay(regions)
        report = verify(mesh)
        assert report.ok
        assert Property.REGIONS in report.claims
        given = given_mesh(mesh)
        assert given.labels is not None
        assert verify(mesh, labels=np.arange(len(given.labels))).verdict(Property.REGIONS) is Verdict.FAILS

    def test_control_another_domain_is_not_covered(self) -> None:
        """Another domain, which the mesh does not cover."""
        mesh = constrained_delaunay(FRAME)
        square = PSLG.from_rings([[(0, 0), (4, 0), (4, 4), (0, 4)]])
        assert verify(mesh, domain=square).verdict(Property.COVERS_DOMAIN) is Verdict.FAILS

    def test_files(self, tmp_path: Path) -> None:
        mesh = constrained_delaunay(PSLG(FRAME.points, FRAME.segments, holes=[(1.8, 1.5)]))
        for name in ("a.node", "a.npz"):
            io.write(tmp_path / name, mesh)
            report = verify(tmp_path / name)
            assert report.ok
            assert report.claims == DOMAIN_TRIANGULATION
            assert verify(str(tmp_path / name)) == verify(io.read(tmp_path / name)) == report
        io.write(tmp_path / "b.csv", io.Mesh(POINTS))
        with pytest.raises(FileFormatError, match=r"b\.csv: there are no triangles"):
            verify(tmp_path / "b.csv")
        with pytest.raises(AdapterError, match="no triangles, only points"):
            verify(io.Mesh(POINTS))


@pytest.mark.obligation(
    "A1", "of Triangle's dictionaries, segments, holes and regions are the domain", method="named cases"
)
class TestDictionaries:
    """Triangle's dictionaries: segments, holes and regions are the domain."""

    PLAIN: ClassVar[dict[str, npt.ArrayLike]] = {
        "vertices": FRAME.points,
        "segments": FRAME.segments,
        "holes": [(1.8, 1.5)],
    }

    @pytest.mark.parametrize("switches", ["", "p", "pc", "pq30", "pq30a0.1", "po2"])
    def test_results(self, switches: str) -> None:
        result = exactmesh.triangle.triangulate(self.PLAIN, switches)
        report = verify(result)
        assert report.ok, report
        assert report.claims == (DOMAIN_TRIANGULATION if "p" in switches else DELAUNAY_TRIANGULATION)

    def test_regions(self) -> None:
        result = exactmesh.triangle.triangulate({**self.PLAIN, "regions": [(0.5, 0.5, 7, 0)]}, "pA")
        assert Property.REGIONS in verify(result).claims
        assert verify(result).ok
        wrong = {**result, "triangle_attributes": result["triangle_attributes"] + 1}
        assert verify(wrong).verdict(Property.REGIONS) is Verdict.FAILS

    def test_control_a_lost_triangle_is_missed(self) -> None:
        """A triangle taken away."""
        result = exactmesh.triangle.triangulate(self.PLAIN, "p")
        assert not verify({**result, "triangles": result["triangles"][1:]}).ok

    def test_the_package_itself(self) -> None:
        triangle = pytest.importorskip("triangle", reason="pip install triangle")
        for switches in ("p", "pq30"):
            assert verify(
                triangle.triangulate({key: np.array(value) for key, value in self.PLAIN.items()}, switches)
            ).ok


@pytest.mark.obligation("A1", "scipy's Delaunay is checked for being Delaunay", method="named cases")
class TestScipy:
    """scipy's Delaunay is checked for what it says to be: near the origin it mostly is, far from it it is not."""

    def test_it_holds_and_fails(self) -> None:
        sound = verify(Delaunay(POINTS))
        assert sound.ok
        assert sound.claims == DELAUNAY_TRIANGULATION
        assert verify(Delaunay(POINTS)) == verify(POINTS, Delaunay(POINTS).simplices)

    def test_control_far_from_the_origin(self) -> None:
        """scipy's own mesh of points far from the origin, which leaves most of them out."""
        assert not verify(Delaunay(np.random.default_rng(0).random((300, 2)) + 1e6)).ok

    def test_other_sorts(self) -> None:
        with pytest.raises(AdapterError, match="3 dimensions"):
            verify(Delaunay(np.random.default_rng(0).random((10, 3))))
        farthest = Delaunay(POINTS, furthest_site=True)
        assert verify(farthest).claims == ADMISSIBLE_MESH
        assert verify(farthest).ok


class TestMatplotlib:
    """Masked triangles do not count; Delaunay is what matplotlib made so, the rest is an admissible mesh."""

    def test_sorts(self) -> None:
        x, y = POINTS.T
        assert verify(PlotTriangulation(x, y)).claims == DELAUNAY_TRIANGULATION
        assert verify(PlotTriangulation(x, y)).ok
        own = PlotTriangulation(x, y, delaunay(POINTS).triangles[:, ::-1])
        assert verify(own).claims == ADMISSIBLE_MESH
        assert verify(own).ok

    def test_masks(self) -> None:
        mesh = PlotTriangulation(*POINTS.T)
        whole = verify(mesh).triangle_count
        mask = np.arange(whole) == 3
        mesh.set_mask(mask)
        report = verify(mesh)
        assert report.triangle_count == whole - 1
        assert report.claims == ADMISSIBLE_MESH
        assert report.ok
        assert corners(given_mesh(mesh)) == expected(POINTS, mesh.triangles[~mask])


@pytest.mark.obligation("A1", "shapely's polygons are cells, vertices at one position are one", method="named cases")
class TestShapely:
    """Polygons are the cells, vertices at one position are one; whatever else is refused, and named by its place."""

    def test_triangles(self) -> None:
        found = shapely.delaunay_triangles(shapely.MultiPoint(POINTS))
        given = given_mesh(found)
        assert len(given.points) == len(POINTS)
        for mesh in (found, list(found.geoms), tuple(found.geoms), np.array(found.geoms), [found]):
            report = verify(mesh)
            assert report.ok
            assert report.claims == ADMISSIBLE_MESH
            assert report == verify(given.points, given.triangles, claims=ADMISSIBLE_MESH, orientation="any")
            assert report.verdict(Property.DELAUNAY) is Verdict.HOLDS

    def test_quadrilaterals(self) -> None:
        cells = [shapely.Polygon(SQUARE[row]) for row in map(list, (*QUADS, *TRIANGLES))]
        assert corners(given_mesh(shapely.MultiPolygon(cells))) == expected(SQUARE, TRIANGLES, QUADS)
        assert verify(cells).quad_count == 1
        assert verify(cells).ok
        boxes = [shapely.box(i, j, i + 1, j + 1) for i in range(3) for j in range(3)]
        assert verify(boxes).verdict(Property.COVERS_HULL) is Verdict.HOLDS
        assert len(given_mesh(boxes).points) == 16
        assert not verify([*boxes, shapely.box(0, 0, 3, 3)]).ok

    def test_zeros_have_no_sign(self) -> None:
        lower = shapely.Polygon([(0.0, 0), (1, 0), (1, -1), (0, -1)])
        upper = shapely.Polygon([(-0.0, 0), (1, -0.0), (1, 1), (0, 1)])
        assert verify([lower, upper]).ok
        assert len(given_mesh([lower, upper]).points) == 6

    @pytest.mark.parametrize(
        ("mesh", "fault"),
        [
            ([shapely.box(0, 0, 1, 1), shapely.Point(0, 0)], "geometry 1, a Point, is no polygon"),
            (shapely.Polygon([(0, 0), (2, 0), (3, 1), (2, 2), (0, 2)]), "geometry 0, a Polygon of 5 sides"),
            ([shapely.box(0, 0, 3, 3).difference(shapely.box(1, 1, 2, 2))], "has a hole"),
            (shapely.Polygon([(0, 0, 1), (1, 0, 1), (0, 1, 1)]), "has a third coordinate"),
            ([shapely.box(0, 0, 1, 1), 3], "geometry 1 is a int, no shapely geometry"),
            (shapely.LineString([(0, 0), (1, 1)]), "is no polygon"),
            (shapely.Polygon(), "of -1 sides|is neither"),
        ],
    )
    def test_control_what_is_no_cell_is_refused(self, mesh: object, fault: str) -> None:
        """Geometries that are no triangles and no quadrilaterals."""
        with pytest.raises(AdapterError, match=fault):
            verify(mesh)


@pytest.mark.obligation(
    "A1", "meshio's blocks are joined, lines are segments, planes of space are planes", method="named cases"
)
class TestMeshio:
    """Blocks of cells are joined, nodes beyond the corners and unused points do no harm, lines are segments."""

    def test_blocks(self) -> None:
        cells = [("vertex", [[0]]), ("triangle", TRIANGLES), ("line", [[1, 4]]), ("quad", QUADS), ("line", [[0, 1]])]
        given = given_mesh(meshio.Mesh(raised(SQUARE), cells))
        assert corners(given) == expected(SQUARE, TRIANGLES, QUADS)
        assert given.segments is not None
        assert given.segments.tolist() == [[1, 4], [0, 1]]
        report = verify(meshio.Mesh(raised(SQUARE, 2.5), cells))
        assert report.ok
        assert (
            set(ADMISSIBLE_MESH) < set(report.claims) == {*ADMISSIBLE_MESH, Property.SEGMENTS_PRESENT, Property.CONVEX}
        )

    def test_control_a_line_across_is_missing(self) -> None:
        """A line across a quadrilateral, which is no edge."""
        report = verify(meshio.Mesh(SQUARE, [("quad", QUADS), ("line", [[0, 2]])]))
        assert report.verdict(Property.SEGMENTS_PRESENT) is Verdict.FAILS

    def test_second_order(self) -> None:
        middles = [(0.5, 0), (0.5, 0.5), (0, 0.5)]
        mesh = meshio.Mesh([(0, 0), (1, 0), (0, 1), *middles], [("triangle6", [[0, 1, 2, 3, 4, 5]])])
        assert given_mesh(mesh).triangles.tolist() == [[0, 1, 2]]
        assert verify(mesh).ok
        assert verify(mesh).verdict(Property.ALL_POINTS_USED) is Verdict.FAILS

    def test_numbers_of_32_bits_are_exact(self) -> None:
        points = POINTS.astype(np.float32)
        triangles = delaunay(points).triangles
        assert np.array_equal(given_mesh(meshio.Mesh(points, [("triangle", triangles)])).points, points)
        assert verify(meshio.Mesh(points, [("triangle", triangles)])).verdict(Property.DELAUNAY) is Verdict.HOLDS

    def test_planes(self) -> None:
        points = raised(SQUARE, 1.0)
        points[4, 2] = 1.5
        mesh = meshio.Mesh(points, [("triangle", TRIANGLES), ("quad", QUADS)])
        with pytest.raises(AdapterError, match=r"not planar: point 4 has z = 1\.5, point 0 has z = 1\.0") as caught:
            verify(mesh)
        assert caught.value.indices == (4,)
        assert verify(meshio.Mesh(points, [("quad", QUADS)])).ok  # point 4 is no corner
        points[0, 2] = np.nan
        with pytest.raises(AdapterError, match="point 0 has z = nan"):
            verify(meshio.Mesh(points, [("quad", QUADS)]))

    def test_faults_in_arrays_are_findings(self) -> None:
        report = verify(meshio.Mesh(raised(SQUARE), [("triangle", [(0, 1, 9)])]))
        assert report.verdict(Property.INDICES) is Verdict.FAILS

    def test_other_cells_are_refused(self) -> None:
        with pytest.raises(AdapterError, match="cells of type 'tetra'"):
            verify(meshio.Mesh(raised(SQUARE), [("tetra", [[0, 1, 2, 3]])]))
        with pytest.raises(AdapterError, match="no triangles and no quadrilaterals"):
            verify(meshio.Mesh(raised(SQUARE), [("line", [[0, 1]])]))

    def test_domain(self) -> None:
        mesh = constrained_delaunay(FRAME)
        given = meshio.Mesh(mesh.points, [("triangle", mesh.triangles)])
        report = verify(given, domain=mesh.domain)
        assert report.ok
        assert {Property.COVERS_DOMAIN, Property.DOMAIN_POINTS, Property.SEGMENTS_PRESENT} <= set(report.claims)
        assert Property.CONSTRAINED_DELAUNAY not in report.claims
        lost = meshio.Mesh(mesh.points, [("triangle", mesh.triangles[1:])])
        assert verify(lost, domain=mesh.domain).verdict(Property.COVERS_DOMAIN) is Verdict.FAILS


@pytest.mark.obligation("A1", "meshes of scikit-fem are admissible, those of space are refused", method="named cases")
class TestScikitFem:
    """Meshes of scikit-fem, refined or of second order, are admissible; cells of space are refused."""

    @pytest.mark.parametrize("name", ["MeshTri", "MeshQuad", "MeshTri2", "MeshQuad2"])
    def test_planar(self, name: str) -> None:
        mesh = getattr(skfem, name)().refined(2)
        report = verify(mesh)
        assert report.ok
        assert report.triangle_count + report.quad_count == mesh.t.shape[1]
        assert report.verdict(Property.COVERS_HULL) is Verdict.HOLDS
        assert corners(given_mesh(mesh)) == expected(mesh.p.T, mesh.t.T)

    def test_control_a_pulled_vertex(self) -> None:
        """A vertex pulled over its neighbours."""
        mesh = skfem.MeshQuad().refined(2)
        points = mesh.p.copy()
        inner = int(np.flatnonzero(((points > 0) & (points < 1)).all(axis=0))[0])
        points[:, inner] += 0.6
        assert not verify(skfem.MeshQuad(points, mesh.t)).ok

    @pytest.mark.parametrize("name", ["MeshTet", "MeshHex", "MeshLine"])
    def test_others(self, name: str) -> None:
        with pytest.raises(AdapterError, match="neither triangles nor quadrilaterals of the plane"):
            verify(getattr(skfem, name)())


class TestPyvista:
    """PolyData and grids: faces are cells, pixels are turned into the order of their sides."""

    def test_sorts(self) -> None:
        pyvista = pytest.importorskip("pyvista", reason="pip install pyvista")
        mesh = pyvista.PolyData(raised(SQUARE), [4, 0, 1, 2, 3, 3, 1, 4, 2])
        assert corners(given_mesh(mesh)) == expected(SQUARE, TRIANGLES, QUADS)
        assert verify(mesh).ok
        assert verify(mesh.cast_to_unstructured_grid()).ok
        assert verify(pyvista.ImageData(dimensions=(4, 3, 1))).quad_count == 6
        assert verify(pyvista.ImageData(dimensions=(4, 3, 1))).ok
        assert verify(mesh).verdict(Property.COVERS_HULL) is Verdict.HOLDS
        with pytest.raises(AdapterError, match="a pyvista PolyData is not planar"):
            verify(pyvista.Sphere())


class TestMeshpy:
    """What meshpy's Triangle makes is a constrained Delaunay triangulation."""

    def test_results(self) -> None:
        meshpy = pytest.importorskip("meshpy.triangle", reason="pip install meshpy")
        info = meshpy.MeshInfo()
        info.set_points(FRAME.points.tolist())
        info.set_facets(FRAME.segments.tolist())
        info.set_holes([(1.8, 1.5)])
        with pytest.raises(AdapterError, match="no elements"):
            verify(info)
        report = verify(meshpy.build(info, max_volume=0.2))
        assert report.ok
        assert {Property.CONSTRAINED_DELAUNAY, Property.SEGMENTS_PRESENT} <= set(report.claims)


class TestRegistry:
    """Adapters import nothing to recognise an object, and take classes derived from those of a package."""

    def test_derived_classes(self) -> None:
        class Mine(Delaunay):
            pass

        assert given_mesh(Mine(POINTS)).source == "a scipy Delaunay"

    def test_a_namesake_is_none(self) -> None:
        class Mesh(NamedTuple):
            points: list[tuple[int, int]]

        with pytest.raises(AdapterError):
            verify(Mesh([(0, 0)]))

    def test_nothing_is_imported(self) -> None:
        """Verified in a process of its own: no optional package is there afterwards."""
        code = (
            "import sys; from exactmesh.adapters import given_mesh; from exactmesh.errors import AdapterError\n"
            "given_mesh(([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)]))\n"
            "try: given_mesh(3)\n"
            "except AdapterError: pass\n"
            "names = 'scipy.spatial matplotlib shapely meshio pyvista skfem meshpy triangle'.split()\n"
            "print([name for name in names if name in sys.modules])"
        )
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        assert done.stdout.strip() == "[]"

    @pytest.mark.parametrize(
        ("break_it", "error"),
        [
            (lambda: (POINTS, np.array([(0.0, 1.0, 2.0)])), ShapeError),
            (lambda: ([(2**53 + 1, 0), (1, 0), (0, 1)], [(0, 1, 2)]), CoordinateError),
        ],
    )
    def test_arrays_that_are_none(self, break_it: Callable[[], object], error: type[Exception]) -> None:
        with pytest.raises(error):
            verify(break_it())

    def test_claims_are_those_of_given(self) -> None:
        given = given_mesh(shapely.box(0, 0, 1, 1))
        assert (given.orientation, given.claims) == (Orientation.ANY, ADMISSIBLE_MESH)
        assert repr(given) == "GivenMesh(shapely polygons: 4 points, 0 triangles, 1 quadrilaterals)"
