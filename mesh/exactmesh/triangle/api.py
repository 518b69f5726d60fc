"""The functions of the ``triangle`` package."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

import warnings
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from exactkernel.errors import ShapeError
from exactkernel.types import FloatArray, IntArray
from exactmesh.delaunay import Progress
from exactmesh.delaunay import delaunay as delaunay_mesh
from exactmesh.triangle.dictionary import TriangleDict, given_of
from exactmesh.triangle.errors import TriangleWarning
from exactmesh.triangle.graph import hull_edges
from exactmesh.triangle.result import dictionary_of
from exactmesh.triangle.solve import Unsuitable, answered, origin_of
from exactmesh.triangle.switches import MEANINGS, Switch, parse
from exactmesh.voronoi import circumcentres, dual_edges

__all__ = ["convex_hull", "delaunay", "triangulate", "voronoi"]


def triangulate(
    tri: Mapping[str, object],
    opts: str | None = "",
    *,
    unsuitable: Unsuitable | None = None,
    progress: Progress | None = None,
) -> TriangleDict:
    """Triangulate what is in a dictionary, as the switches say; see ``MEANINGS`` for those.

    Args:
        tri: arrays by the keys of :class:`TriangleDict`; ``vertices`` (n, 2) must be there.
        opts: the switches, such as ``"pq30a0.1"``; None is as good as "".
        unsuitable: for ``u``: which triangles are too large, a function of corners (k, 3, 2) and areas (k,) that
            returns bool (k,); :func:`from_triunsuitable` and :func:`from_meshpy` make one of other conventions.
        progress: called now and then with how much is done, and of how much.

    Returns:
        A dictionary of new arrays. The vertices that were given come first, all of them (with ``j`` those in use).

    Warns:
        TriangleWarning: a switch means something else here, something of the input is passed over, or the result
            misses what was asked for.

    Raises:
        SwitchError: the switches cannot be meant, or are no string.
        ChoiceError: a key that there is not; no ``vertices``, or no ``triangles`` for ``r``.
        ShapeError, NonFiniteError, CoordinateError: what is under a key is none; the message has the key. ``tri`` is no
            dictionary.
        PSLGError: the graph has faults, all of them in ``faults``: an outline is open, an end does not exist.
        InadmissibleError: what is to be refined is no triangulation; ``report`` has the verifier's witnesses.
        TooFewPointsError, CollinearPointsError: there is no triangle.

    Reference: [Shewchuk 1996]

    >>> from exactmesh import triangle
    >>> square = dict(vertices=[[0, 0], [0, 1], [1, 1], [1, 0]], segments=[[0, 1], [1, 2], [2, 3], [3, 0]])
    >>> found = triangle.triangulate(square, "pe")
    >>> sorted(found), found["edges"].shape, found["vertex_markers"].ravel().tolist()
    (['edge_markers', 'edges', 'segment_markers', 'segments', 'triangles', 'vertex_markers', 'vertices'], (5, 2), \
[1, 1, 1, 1])
    """
    if not isinstance(tri, Mapping):
        raise ShapeError(f"triangulate takes a dictionary, not a {type(tri).__name__}: {{'vertices': points}}")
    switches = parse(opts or "")
    given = given_of(tri, refines=switches.asks(Switch.REFINE))
    solution = answered(given, switches, unsuitable, progress)
    only_files = (f"{s}: {MEANINGS[s]}" for s in (Switch.VORONOI, Switch.GEOMVIEW) if switches.asks(s))
    unasked = ("unsuitable is not asked: write u",) if unsuitable is not None and "u" not in switches.given else ()
    for note in (*switches.notes(), *only_files, *unasked, *solution.notes):
        warnings.warn(note, TriangleWarning, stacklevel=2)
    return dictionary_of(given, switches, solution)


def delaunay(pts: npt.ArrayLike) -> IntArray:
    """Return the triangles of the Delaunay triangulation, int32 (m, 3), counterclockwise.

    >>> from exactmesh import triangle
    >>> triangle.delaunay([(0, 0), (1, 0), (0, 1)]).tolist()
    [[0, 1, 2]]
    """
    mesh = delaunay_mesh(pts)
    return origin_of(mesh, len(mesh.representative))[mesh.triangles].astype(np.int32)


def convex_hull(pts: npt.ArrayLike) -> IntArray:
    """Return the edges of the convex hull, int32 (h, 2), collinear vertices included: the hull is on their right.

    >>> from exactmesh import triangle
    >>> triangle.convex_hull([(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0.2)]).tolist()
    [[1, 0], [2, 1], [3, 2], [0, 3]]
    """
    mesh = delaunay_mesh(pts)
    return hull_edges(mesh.hull, origin_of(mesh, len(mesh.representative))).astype(np.int32)


def voronoi(pts: npt.ArrayLike) -> tuple[FloatArray, IntArray, IntArray, FloatArray]:
    """Return the Voronoi diagram, edge by edge the dual of the Delaunay triangulation.

    Returns:
        float64 (m, 2), the circumcentres, in the order of ``delaunay(pts)``: of cocircular points, several coincide;
        int32 (k, 2), the edges, circumcentres of two triangles;
        int32 (h,), the circumcentres at which rays begin;
        float64 (h, 2), the directions of the rays.

    >>> from exactmesh import triangle
    >>> points, edges, origins, directions = triangle.voronoi([(0, 0), (2, 0), (0, 2)])
    >>> points.tolist(), edges.shape, origins.tolist(), directions.tolist()
    ([[1.0, 1.0]], (0, 2), [0, 0, 0], [[2.0, 2.0], [-2.0, 0.0], [0.0, -2.0]])
    """
    mesh = delaunay_mesh(pts)
    ends, directions = dual_edges(mesh)
    rays = ends[:, 1] < 0
    return circumcentres(mesh), ends[~rays], ends[rays, 0], directions[rays]
