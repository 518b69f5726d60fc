"""The constrained meshers: what each needs before the clock starts, and the call that is timed."""

from typing import Any

import numpy as np

from benchmarks.graphs import Graph
from benchmarks.peers import Mesher

__all__ = ["CONSTRAINERS"]


def _same(graph: Graph) -> Graph:
    return graph


def _compiled(graph: Graph) -> Graph:
    """Compile what only graphs with crossings need."""
    from exactmesh import PSLG, constrained_delaunay

    cross = PSLG([(0, 0), (3, 1), (0, 1), (3, 0)], [(0, 1), (2, 3)])
    constrained_delaunay(cross, carve=False, crossings="split")
    return graph


def _exactmesh(graph: Graph) -> int:
    from exactmesh import PSLG, constrained_delaunay

    pslg = PSLG(graph.points, graph.segments)
    return len(constrained_delaunay(pslg, carve=graph.closed, crossings="split").triangles)


def _triangle(graph: Graph) -> int:
    import triangle

    switches = "p" if graph.closed else "pc"
    return len(triangle.triangulate({"vertices": graph.points, "segments": graph.segments}, switches)["triangles"])


def _cdt(graph: Graph) -> int:
    import pythoncdt as cdt

    mesh = cdt.Triangulation(cdt.VertexInsertionOrder.AUTO, cdt.IntersectingConstraintEdges.TRY_RESOLVE, 0.0)
    vertices: Any = graph.points  # any buffer of pairs of doubles
    edges: Any = graph.segments.astype(np.uint32)
    mesh.insert_vertices(vertices)
    mesh.insert_edges(edges)
    if graph.closed:
        mesh.erase_outer_triangles()
    else:
        mesh.erase_super_triangle()
    return int(mesh.triangles_count())


def _cgal_input(graph: Graph) -> Any:
    from CGAL.CGAL_Kernel import Point_2

    points = [Point_2(x, y) for x, y in graph.points.tolist()]
    return points, [(points[a], points[b]) for a, b in graph.segments.tolist()]


def _cgal(prepared: Any) -> int:
    from CGAL.CGAL_Triangulation_2 import Constrained_Delaunay_triangulation_2

    points, segments = prepared
    mesh = Constrained_Delaunay_triangulation_2()
    mesh.insert(points)
    for a, b in segments:
        mesh.insert_constraint(a, b)
    return int(mesh.number_of_faces())


def _polygon(graph: Graph) -> Any:
    import shapely

    if not graph.closed:
        raise NotImplementedError("polygons only")
    if np.array_equal(graph.segments[:, 1], np.roll(graph.segments[:, 0], -1)):  # one ring
        return shapely.Polygon(graph.points)
    faces = shapely.polygonize(list(shapely.linestrings(graph.points[graph.segments])))
    return shapely.MultiPolygon(list(shapely.get_parts(faces)))


def _geos(polygons: Any) -> int:
    import shapely

    return int(shapely.get_num_geometries(shapely.constrained_delaunay_triangles(polygons)))


CONSTRAINERS: dict[str, Mesher] = {
    "exactmesh-constrained": Mesher(
        "exactmesh",
        "exactmesh",
        _compiled,
        _exactmesh,
        'constrained_delaunay(PSLG(points, segments), crossings="split")',
    ),
    "triangle-constrained": Mesher("Triangle", "triangle", _same, _triangle, "triangulate(graph, 'p'), 'pc' if open"),
    "cdt-constrained": Mesher(
        "CDT", "pythoncdt", _same, _cdt, "insert_vertices, insert_edges (crossings resolved), erase, by buffers"
    ),
    "cgal-constrained": Mesher(
        "CGAL", "cgal", _cgal_input, _cgal, "insert, insert_constraint one by one in Python, nothing carved"
    ),
    "geos-constrained": Mesher(
        "GEOS", "shapely", _polygon, _geos, "constrained_delaunay_triangles of the polygons, which were made before"
    ),
}
