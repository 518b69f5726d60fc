"""Calls of the meshers that Python has, one function for each mesher and task. A package is imported when it is called.

Loaded as a file by the mesher's own process, so that only the mesher's package has to be imported there.
"""
# ruff: noqa: D103  # the name of each function says all: the mesher, and the task

from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]
Mesh = tuple[npt.NDArray[Any], npt.NDArray[Any]]


def _triangles_of(coordinates: Floats) -> Mesh:
    """Return points and triangles of corners (3m, 2) that come without indices: positions are what they share."""
    points, corners = np.unique(coordinates + 0.0, axis=0, return_inverse=True)  # -0.0 is 0.0
    return points, corners.reshape(-1, 3)


def exactmesh_points(points: Floats) -> Mesh:
    from exactmesh import delaunay

    mesh = delaunay(points)
    return mesh.points, mesh.triangles


@cache
def _exactmesh_compiled() -> None:
    """Let exactmesh compile, in its first call, what only segments that cross need."""
    from exactmesh import PSLG, constrained_delaunay

    cross = PSLG([(0, 0), (3, 1), (0, 1), (3, 0)], [(0, 1), (2, 3)])
    constrained_delaunay(cross, carve=False, crossings="split")


def exactmesh_segments(points: Floats, segments: Integers) -> Mesh:
    from exactmesh import PSLG, constrained_delaunay

    _exactmesh_compiled()
    mesh = constrained_delaunay(PSLG(points, segments), carve=False, crossings="split")
    return mesh.points, mesh.triangles


def exactmesh_domain(points: Floats, segments: Integers) -> Mesh:
    from exactmesh import PSLG, constrained_delaunay

    _exactmesh_compiled()
    mesh = constrained_delaunay(PSLG(points, segments, rule="even-odd"), crossings="split")
    return mesh.points, mesh.triangles


def scipy_points(points: Floats) -> npt.NDArray[Any]:
    from scipy.spatial import Delaunay

    return Delaunay(points).simplices


def matplotlib_points(points: Floats) -> npt.NDArray[Any]:
    from matplotlib.tri import Triangulation

    return Triangulation(points[:, 0], points[:, 1]).triangles


def _triangle(given: dict[str, npt.NDArray[Any]], switches: str) -> Mesh:
    import triangle

    made = triangle.triangulate(given, switches)
    return made["vertices"], made.get("triangles", np.zeros((0, 3), dtype=np.int64))


def triangle_points(points: Floats) -> Mesh:
    return _triangle({"vertices": points}, "")


def triangle_segments(points: Floats, segments: Integers) -> Mesh:
    return _triangle({"vertices": points, "segments": segments}, "pc")


def _meshpy(points: Floats, segments: Integers | None, switches: str) -> Mesh:
    from meshpy.triangle import MeshInfo, internals

    given, made = MeshInfo(), MeshInfo()
    given.set_points(points.tolist())
    if segments is not None:
        given.set_facets(segments.tolist())
    internals.triangulate(switches, given, made, MeshInfo(), None)
    return np.array(made.points).reshape(-1, 2), np.array(made.elements, dtype=np.int64).reshape(-1, 3)


def meshpy_points(points: Floats) -> Mesh:
    return _meshpy(points, None, "Qz")


def meshpy_segments(points: Floats, segments: Integers) -> Mesh:
    return _meshpy(points, segments, "pczQ")


def geos_points(points: Floats) -> Mesh:
    import shapely

    corners = [
        triangle.exterior.coords[:3] for triangle in shapely.delaunay_triangles(shapely.multipoints(points)).geoms
    ]
    return _triangles_of(np.array(corners, dtype=np.float64).reshape(-1, 2))


def geos_domain(points: Floats, segments: Integers) -> Mesh:
    import shapely

    area = shapely.build_area(shapely.multilinestrings(points[segments]))
    made = shapely.constrained_delaunay_triangles(area)
    corners = [triangle.exterior.coords[:3] for triangle in made.geoms]
    return _triangles_of(np.array(corners, dtype=np.float64).reshape(-1, 2))


def _cgal(mesh: Any) -> Mesh:
    corners = [
        (point.x(), point.y())
        for face in mesh.finite_faces()
        for point in (face.vertex(0).point(), face.vertex(1).point(), face.vertex(2).point())
    ]
    return _triangles_of(np.array(corners, dtype=np.float64).reshape(-1, 2))


def cgal_points(points: Floats) -> Mesh:
    from CGAL.CGAL_Kernel import Point_2
    from CGAL.CGAL_Triangulation_2 import Delaunay_triangulation_2

    mesh = Delaunay_triangulation_2()
    mesh.insert([Point_2(x, y) for x, y in points.tolist()])
    return _cgal(mesh)


def cgal_segments(points: Floats, segments: Integers) -> Mesh:
    from CGAL.CGAL_Kernel import Point_2
    from CGAL.CGAL_Triangulation_2 import Constrained_Delaunay_triangulation_2

    places = [Point_2(x, y) for x, y in points.tolist()]
    mesh = Constrained_Delaunay_triangulation_2()
    mesh.insert(places)
    for a, b in segments.tolist():
        mesh.insert_constraint(places[a], places[b])
    return _cgal(mesh)


def _cdt(points: Floats, segments: Integers | None, erase: str) -> Mesh:
    import pythoncdt as cdt

    mesh = cdt.Triangulation(cdt.VertexInsertionOrder.AUTO, cdt.IntersectingConstraintEdges.TRY_RESOLVE, 0.0)
    vertices: Any = np.ascontiguousarray(points)  # any buffer of pairs of doubles
    mesh.insert_vertices(vertices)
    if segments is not None and len(segments):
        edges: Any = np.ascontiguousarray(segments, dtype=np.uint32)
        mesh.insert_edges(edges)
    getattr(mesh, erase)()
    made = mesh.vertices_array()
    return np.column_stack([made["x"], made["y"]]), np.array(mesh.triangles_array()["vertices"], dtype=np.int64)


def cdt_points(points: Floats) -> Mesh:
    return _cdt(points, None, "erase_super_triangle")


def cdt_segments(points: Floats, segments: Integers) -> Mesh:
    return _cdt(points, segments, "erase_super_triangle")


def cdt_domain(points: Floats, segments: Integers) -> Mesh:
    return _cdt(points, segments, "erase_outer_triangles_and_holes")


def gmsh_points(points: Floats) -> npt.NDArray[Any]:
    import gmsh

    if not gmsh.isInitialized():
        gmsh.initialize(interruptible=False)
        gmsh.option.setNumber("General.Terminal", 0)
    return np.array(gmsh.algorithm.triangulate(points.ravel()), dtype=np.int64).reshape(-1, 3) - 1


def startinpy_points(points: Floats) -> Mesh:
    import startinpy

    mesh = startinpy.DT()
    mesh.insert(np.column_stack([points, np.zeros(len(points))]))
    made = np.asarray(mesh.points)[:, :2]  # the first one is infinite
    return made, np.asarray(mesh.triangles, dtype=np.int64).reshape(-1, 3)
