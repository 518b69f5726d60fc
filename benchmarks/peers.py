"""The meshers: what each needs before the clock starts, and the call that is timed.

Conversions that a peer's binding makes slow (CGAL's list of points, shapely's MultiPoint) are done before the clock.
"""

from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from typing import Any

import numpy as np

from exactkernel.types import FloatArray

__all__ = ["PEERS", "Mesher", "version_of"]


@dataclass(frozen=True)
class Mesher:
    """One row of the tables.

    Attributes:
        name: as printed.
        package: the distribution on PyPI.
        prepare: points or a graph -> what the timed call takes.
        run: the timed call; returns how many triangles came out.
        note: what exactly is timed.
        describe: what comes out of one more call, as the cells of a table; None if there is nothing to tell.
    """

    name: str
    package: str
    prepare: Callable[[Any], Any]
    run: Callable[[Any], int]
    note: str
    describe: Callable[[Any], list[str]] | None = None


def version_of(package: str) -> str:
    """Return the installed version, or a word that says it is missing."""
    try:
        return version(package)
    except PackageNotFoundError:
        return "missing"


def _exactmesh(points: FloatArray) -> int:
    from exactmesh import delaunay

    return len(delaunay(points).triangles)


def _triangle(points: FloatArray) -> int:
    import triangle

    return len(triangle.triangulate({"vertices": points}, "")["triangles"])


def _cgal_points(points: FloatArray) -> Any:
    from CGAL.CGAL_Kernel import Point_2

    return [Point_2(x, y) for x, y in points.tolist()]


def _cgal(points: Any) -> int:
    from CGAL.CGAL_Triangulation_2 import Delaunay_triangulation_2

    mesh = Delaunay_triangulation_2()
    mesh.insert(points)
    return int(mesh.number_of_faces())


def _cdt(points: FloatArray) -> int:
    import pythoncdt as cdt

    mesh = cdt.Triangulation(cdt.VertexInsertionOrder.AUTO, cdt.IntersectingConstraintEdges.NOT_ALLOWED, 0.0)
    vertices: Any = points  # any buffer of pairs of doubles
    mesh.insert_vertices(vertices)
    mesh.erase_super_triangle()
    return int(mesh.triangles_count())


def _scipy(points: FloatArray) -> int:
    from scipy.spatial import Delaunay

    return len(Delaunay(points).simplices)


def _multipoint(points: FloatArray) -> Any:
    import shapely

    return shapely.multipoints(points)


def _geos(points: Any) -> int:
    import shapely

    return int(shapely.get_num_geometries(shapely.delaunay_triangles(points)))


def _gmsh_vector(points: FloatArray) -> Any:
    import gmsh

    if not gmsh.isInitialized():
        gmsh.initialize(interruptible=False)
        gmsh.option.setNumber("General.Terminal", 0)
    return np.ascontiguousarray(points.reshape(-1))


def _gmsh(vector: Any) -> int:
    import gmsh

    return len(gmsh.algorithm.triangulate(vector)) // 3


def _same(points: FloatArray) -> FloatArray:
    return points


PEERS: dict[str, Mesher] = {
    "exactmesh": Mesher("exactmesh", "exactmesh", _same, _exactmesh, "delaunay(points), triangles and neighbors"),
    "triangle": Mesher("Triangle", "triangle", _same, _triangle, "triangulate(points, '')"),
    "cgal": Mesher("CGAL", "cgal", _cgal_points, _cgal, "the bare C++ insertion, Python points made before the clock"),
    "cdt": Mesher("CDT", "pythoncdt", _same, _cdt, "insert_vertices, erase_super_triangle; triangles not fetched"),
    "scipy": Mesher("scipy (Qhull)", "scipy", _same, _scipy, "Delaunay(points)"),
    "geos": Mesher("GEOS", "shapely", _multipoint, _geos, "delaunay_triangles of a MultiPoint made before the clock"),
    "gmsh": Mesher("gmsh", "gmsh", _gmsh_vector, _gmsh, "algorithm.triangulate(vector)"),
}
