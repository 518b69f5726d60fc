"""voronoi: from points, or from a Delaunay triangulation, to the diagram."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

from enum import StrEnum
from typing import Self

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray
from exactmesh.errors import ChoiceError
from exactmesh.refinement.result import Refinement
from exactmesh.triangulation import Triangulation
from exactmesh.voronoi.cells import Cells
from exactmesh.voronoi.centres import centres_of, turned
from exactmesh.voronoi.clipping import Diagram, clipped_to_window
from exactmesh.voronoi.diagram import Voronoi
from exactmesh.voronoi.domain import check_conforming, clipped_to_domain
from exactmesh.voronoi.duality import Dual, dual_of
from exactmesh.voronoi.source import Line, check_delaunay, check_hull, source_of
from exactmesh.voronoi.window import window_of

__all__ = ["Clip", "voronoi"]


class Clip(StrEnum):
    """What to clip a diagram to, besides a window.

    >>> Clip("domain")
    <Clip.DOMAIN: 'domain'>
    """

    DOMAIN = "domain"
    """What the triangulation covers; it has to be boundary conforming."""

    @classmethod
    def _missing_(cls, value: object) -> Self:
        raise ChoiceError(f'{value!r} is no clip; choose "domain", a box (xmin, ymin, xmax, ymax) or a convex polygon')


def voronoi(
    points_or_mesh: npt.ArrayLike | Triangulation | Refinement, *, clip: npt.ArrayLike | Clip | None = None
) -> Voronoi:
    """Return the Voronoi diagram of points, or that of the vertices of a Delaunay triangulation, which is its dual.

    Circumcentres of cocircular points, which is decided exactly, are one vertex, and vertices are rounded once, to the
    nearest doubles. Sites on one line have parallel lines as ridges; one site has the plane as its cell; points at the
    same position share a cell.

    Args:
        points_or_mesh: (n, 2) finite coordinates, or a :class:`Triangulation` of which every edge is locally Delaunay;
            or a :class:`Refinement` of one.
        clip: a box (xmin, ymin, xmax, ymax) or a convex polygon (k, 2), of either orientation: ``clipped`` becomes the
            cells inside of it. Which cells its boundary meets, and which ridges, is decided exactly.
            ``"domain"`` or ``Clip.DOMAIN``: the domain of a boundary conforming triangulation. There a cell is what is
            nearest to its site of all that see it inside the domain.

    Raises:
        NotDelaunayError: an edge of the triangulation is not locally Delaunay.
        NotConformingError: with ``"domain"``, a circumcentre lies outside of it.
        TopologyError: the triangulation covers no convex hull, and ``clip`` is not ``"domain"``.
        ClipError, ChoiceError: ``clip`` is none.
        TooFewPointsError: no point.
        NonFiniteError, CoordinateError, ShapeError, TooManyPointsError: as for :func:`exactmesh.delaunay`.

    O(n) beyond the Delaunay triangulation, and O(n log k + c) for c corners of clipped cells. Reference
    [Guibas 1985], [Aurenhammer 1991].

    >>> from exactmesh import voronoi
    >>> diagram = voronoi([(0, 0), (4, 0), (4, 2), (0, 2)], clip=(-1, -1, 5, 3))
    >>> diagram.vertices.tolist(), diagram.clipped.areas.tolist()
    ([[2.0, 1.0]], [6.0, 6.0, 6.0, 6.0])
    >>> diagram.clipped.polygon(0).tolist()
    [[-1.0, 1.0], [-1.0, -1.0], [2.0, -1.0], [2.0, 1.0]]
    """
    window, to_domain = None, isinstance(clip, str)
    if isinstance(clip, str):
        Clip(clip)
    elif clip is not None:
        window = window_of(clip)
    if isinstance(points_or_mesh, Refinement):
        points_or_mesh = points_or_mesh.triangulation
    source = source_of(points_or_mesh)
    if isinstance(points_or_mesh, Triangulation):
        check_mesh(points_or_mesh, to_domain=to_domain)
    elif to_domain:
        raise ChoiceError('clip="domain" asks for a triangulation: points have no domain')
    if isinstance(source, Line):
        return _of_line(source, window)
    mesh = source
    centres = centres_of(mesh.points, mesh.triangles)
    dual = dual_of(mesh.points, mesh.triangles, mesh.neighbors, centres)
    vertices, vertex_sites = centres[dual.triangle], mesh.triangles[dual.triangle]
    d = Diagram(mesh.points, vertices, vertex_sites, dual.ridge_points, dual.offsets, dual.cells, dual.cell_ridges)
    clipped = clipped_to_domain(d) if to_domain else None if window is None else clipped_to_window(d, window)
    return _of_mesh(mesh, d, dual, clipped)


def check_mesh(mesh: Triangulation, *, to_domain: bool) -> None:
    """Refuse a triangulation without a dual."""
    if to_domain:
        check_delaunay(mesh)
        check_conforming(mesh)
    else:
        check_hull(mesh)


def _of_mesh(mesh: Triangulation, d: Diagram, dual: Dual, clipped: Cells | None) -> Voronoi:
    directions = np.zeros(dual.ends.shape)
    rays = dual.ends[:, 1] < 0
    directions[rays] = turned(mesh.points, dual.ridge_points[rays])
    return Voronoi(
        points=mesh.points,
        vertices=d.vertices,
        ridge_points=dual.ridge_points,
        ends=dual.ends,
        directions=directions,
        edge=dual.edge,
        triangle_vertex=dual.vertex,
        offsets=dual.offsets,
        cells=dual.cells,
        cell_ridges=dual.cell_ridges,
        point_region=mesh.representative,
        triangulation=mesh,
        clipped=clipped,
    )


def _of_line(line: Line, window: FloatArray | None) -> Voronoi:
    """Return the diagram of sites on one line: between two and two that follow each other, a line at a right angle."""
    n, ridges = len(line.points), len(line.points) - 1
    ridge_points = np.stack([line.order[:-1], line.order[1:]], axis=1)
    degree = np.bincount(ridge_points.reshape(-1), minlength=n)
    offsets = np.concatenate([[0], np.cumsum(degree)])
    around = np.repeat(np.arange(ridges, dtype=np.int32), 2)
    cell_ridges = around[np.argsort(ridge_points.reshape(-1), kind="stable")]
    cells = np.full(2 * ridges, -1, dtype=np.int32)
    nothing, nobody = np.empty((0, 2)), np.empty((0, 3), dtype=np.int32)
    d = Diagram(line.points, nothing, nobody, ridge_points, offsets, cells, cell_ridges)
    return Voronoi(
        points=line.points,
        vertices=nothing,
        ridge_points=ridge_points,
        ends=np.full((ridges, 2), -1, dtype=np.int32),
        directions=turned(line.points, ridge_points),
        edge=np.arange(ridges, dtype=np.int32),
        triangle_vertex=np.empty(0, dtype=np.int32),
        offsets=offsets,
        cells=cells,
        cell_ridges=cell_ridges,
        point_region=line.representative,
        triangulation=None,
        clipped=None if window is None else clipped_to_window(d, window),
    )
