"""What a Voronoi diagram is made from: points, or a triangulation that has to be Delaunay."""

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points
from exactkernel.batch import orient2d_batch
from exactkernel.types import FloatArray, IntArray
from exactmesh.coincident import first_of_each, lexicographic_order
from exactmesh.connectivity import check_corners, check_neighbors
from exactmesh.delaunay import delaunay
from exactmesh.errors import CollinearPointsError, NotDelaunayError, TooFewPointsError, TopologyError
from exactmesh.triangulation import Triangulation
from exactmesh.voronoi.duality import first_not_delaunay

__all__ = ["Line", "check_delaunay", "check_hull", "source_of"]


class Line:
    """Sites on one line, or one site: their Voronoi diagram has no vertices.

    Attributes:
        points: float64 (n, 2), the distinct sites, in the order of the input.
        order: int32 (n,), the sites in lexicographic order: along the line.
        representative: int32, the site that stands for each point of the input.
    """

    def __init__(self, given: FloatArray) -> None:
        first = first_of_each(given, lexicographic_order(given))
        kept = np.flatnonzero(first == np.arange(len(given)))
        self.points = given[kept]
        self.representative: IntArray = np.searchsorted(kept, first).astype(np.int32)
        self.order = lexicographic_order(self.points)


def source_of(points_or_mesh: npt.ArrayLike | Triangulation) -> Triangulation | Line:
    """Return the Delaunay triangulation of points, or their line; a triangulation is returned as it is.

    Raises:
        TooFewPointsError: no point.
        NonFiniteError, CoordinateError, ShapeError, TooManyPointsError: as for :func:`exactmesh.delaunay`.
    """
    if isinstance(points_or_mesh, Triangulation):
        return points_or_mesh
    given = finite_points(points_or_mesh)
    if not len(given):
        raise TooFewPointsError("there are no points, and no diagram of them")
    try:
        return delaunay(given)
    except (CollinearPointsError, TooFewPointsError):
        return Line(given)


def check_delaunay(mesh: Triangulation) -> None:
    """Refuse a triangulation with an edge that is not locally Delaunay.

    Raises:
        NotDelaunayError: ``indices`` are the ends of such an edge.
        TopologyError: corners or neighbors that are none, a triangle that is not counterclockwise, a vertex without
            triangle.
    """
    triangles, neighbors = mesh.triangles, mesh.neighbors
    check_corners(triangles)
    check_neighbors(triangles, neighbors)
    corners = mesh.points[triangles]
    turned = np.flatnonzero(orient2d_batch(*np.moveaxis(corners, 1, 0)) <= 0) if len(triangles) else np.arange(0)
    if turned.size:
        t = int(turned[0])
        raise TopologyError(
            f"triangle {t} {tuple(triangles[t].tolist())} is not counterclockwise", indices=turned.tolist()
        )
    alone = np.flatnonzero(np.bincount(triangles.reshape(-1), minlength=len(mesh.points)) == 0)
    if alone.size:
        raise TopologyError(f"vertex {alone[0]} is a corner of no triangle", indices=alone.tolist())
    side = first_not_delaunay(mesh.points, triangles, neighbors)
    if side >= 0:
        t, i = divmod(side, 3)
        a, b = int(triangles[t, (i + 1) % 3]), int(triangles[t, (i + 2) % 3])
        raise NotDelaunayError(
            f"edge ({a}, {b}) between triangles {t} and {neighbors[t, i]} is not locally Delaunay: the "
            "triangulation has no Voronoi diagram as its dual (give its points, or refine it with conforming=True)",
            indices=[a, b],
        )


def check_hull(mesh: Triangulation) -> None:
    """Refuse a triangulation that is not the Delaunay triangulation of its vertices' convex hull.

    Raises:
        NotDelaunayError, TopologyError: as for :func:`check_delaunay`, or the domain is not convex.
    """
    check_delaunay(mesh)
    try:
        mesh.hull  # noqa: B018  # it raises
    except TopologyError:
        raise TopologyError(
            "the triangulation does not cover the convex hull of its vertices: clip the diagram to its domain by "
            'clip="domain", or give its points'
        ) from None
