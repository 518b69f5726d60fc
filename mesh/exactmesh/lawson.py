"""Lawson's algorithm: flip edges that are not locally Delaunay, from any triangulation, until there are none.

Each flip of ac to bd lowers the lifted surface, by exactly incircle(a, b, c, d) in a potential that is bounded below,
so the algorithm ends; with the perturbed test it ends in one and the same triangulation from wherever it starts.
Reference [Lawson 1977], [Edelsbrunner 2001].
"""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points, vertex_indices
from exactkernel.context import Context, chunk_size, scaled_into_window
from exactkernel.incircle import incircle_perturbed, incircle_perturbed_adaptive
from exactkernel.jit import jit
from exactkernel.orient2d import orient2d
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray, PointLike, Sign
from exactmesh.along import edges_along
from exactmesh.assembly import Constrained, Cut, Task, assembled, in_order
from exactmesh.connectivity import neighbors_of, rings_of
from exactmesh.constrain import plane_of
from exactmesh.delaunay import Insertion
from exactmesh.edgealgebra import EdgeArray, dest, left_next, origin, swap
from exactmesh.errors import InadmissibleError, TooFewPointsError, TopologyError
from exactmesh.extract import OUTER, triangles_of
from exactmesh.ids import OUTSIDE
from exactmesh.pslg import PSLG
from exactmesh.quadedge import Edge, Primal
from exactmesh.triangulation import Triangulation, work_of
from exactmesh.verify import Property, Report, verify

__all__ = ["flip", "flip_all", "is_flippable", "is_locally_delaunay", "lawson"]

_CHUNK = 1 << 19  # edges tested between two looks at Ctrl-C, where predicates are fast

_TRIANGULATION = (
    Property.FINITE,
    Property.INDICES,
    Property.DISTINCT_POINTS,
    Property.ORIENTATION,
    Property.ALL_POINTS_USED,
    Property.ADMISSIBLE,
    Property.COVERS_HULL,
)


#: Coordinates of the vertices: an array (n, 2), or any sequence of points, rational ones included.
Points: TypeAlias = "FloatArray | Sequence[PointLike]"


def _corners(points: Points, edge: Edge[Primal]) -> tuple[PointLike, PointLike, PointLike, PointLike]:
    """Return a, b, c, d: the edge runs from a to c, b is the apex on its right, d on its left."""
    corners = edge.org, edge.oprev.dest, edge.dest, edge.onext.dest
    missing = [v for v in corners if not 0 <= v < len(points)]
    if missing:
        raise TopologyError(f"vertex {missing[0]} has no row in {len(points)} points", indices=missing)
    a, b, c, d = (points[v] for v in corners)
    return a, b, c, d


def is_locally_delaunay(points: Points, edge: Edge[Primal]) -> bool:
    """Tell whether the apex on one side of the edge is outside the (perturbed) circle of the other; on the hull, True.

    Args:
        points: (n, 2), the coordinates of the vertices.
        edge: of a quad-edge whose faces besides OUTSIDE are counterclockwise triangles.

    >>> from exactmesh import QuadEdge, flip, is_locally_delaunay
    >>> points = [(0, 0), (4, 0), (5, 3), (0, 1)]
    >>> surface = QuadEdge.from_triangles([(0, 1, 2), (0, 2, 3)])
    >>> [(e.org, e.dest) for e in surface.edges() if not is_locally_delaunay(points, e)]
    [(2, 0)]
    """
    if OUTSIDE in (edge.left, edge.right):
        return True
    return incircle_perturbed(*_corners(points, edge)) is not Sign.POSITIVE


def is_flippable(points: Points, edge: Edge[Primal]) -> bool:
    """Tell whether the two triangles at the edge form a strictly convex quadrilateral; arguments as above.

    >>> from exactmesh import QuadEdge, is_flippable
    >>> surface = QuadEdge.from_triangles([(0, 1, 2), (0, 2, 3)])
    >>> [(e.org, e.dest) for e in surface.edges() if is_flippable([(0, 0), (4, 0), (5, 3), (0, 1)], e)]
    [(2, 0)]
    """
    if OUTSIDE in (edge.left, edge.right):
        return False
    a, b, c, d = _corners(points, edge)
    return orient2d(a, b, d) is Sign.POSITIVE and orient2d(b, c, d) is Sign.POSITIVE


def flip(points: Points, edge: Edge[Primal]) -> None:
    """Replace the edge by the other diagonal of its two triangles, in place.

    Raises:
        TopologyError: the edge is on the hull, or its quadrilateral is not strictly convex.

    >>> from exactmesh import QuadEdge, flip
    >>> surface = QuadEdge.from_triangles([(0, 1, 2), (0, 2, 3)])
    >>> diagonal = next(e for e in surface.edges() if {e.org, e.dest} == {0, 2})
    >>> flip([(0, 0), (4, 0), (5, 3), (0, 1)], diagonal)
    >>> sorted((diagonal.org, diagonal.dest))
    [1, 3]
    """
    if not is_flippable(points, edge):
        raise TopologyError(f"the edge {edge.org} -> {edge.dest} cannot be flipped", indices=[edge.org, edge.dest])
    edge.structure.swap(edge)


@jit
def flip_until_delaunay(
    k: Context,
    xy: FloatArray,
    ring: EdgeArray,
    org: EdgeArray,
    fixed: npt.NDArray[np.bool_],
    stack: EdgeArray,
    waiting: npt.NDArray[np.bool_],
    height: int,
    limit: int,
) -> tuple[int, int]:
    """Test up to limit edges from the stack and flip those that fail; return (height of the stack, flips).

    ``waiting[i]`` tells whether edge i is on the stack, so that it is there once at most. Edges that are
    ``fixed`` are left alone.
    """
    flips = 0
    for _ in range(limit):
        if height == 0:
            break
        height -= 1
        i = stack[height]
        waiting[i] = False
        if fixed[i]:
            continue
        e = 4 * i
        cd = left_next(ring, e)
        da = left_next(ring, cd)
        ab = left_next(ring, e ^ 2)
        bc = left_next(ring, ab)
        a, b, c, d = origin(org, e), origin(org, bc), dest(org, e), origin(org, da)
        sign = incircle_perturbed_adaptive(
            k, xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1], xy[c, 0], xy[c, 1], xy[d, 0], xy[d, 1]
        )
        if sign <= 0:
            continue
        swap(ring, org, e)
        flips += 1
        for side in (cd, da, ab, bc):
            if not waiting[side >> 2]:
                waiting[side >> 2] = True
                stack[height] = side >> 2
                height += 1
    return height, flips


@np.errstate(over="ignore", invalid="ignore")  # interpreted, a numpy scalar warns where a double does not
def flip_all(xy: FloatArray, k: Context, ring: EdgeArray, org: EdgeArray, fixed: npt.NDArray[np.bool_]) -> int:
    """Flip until every edge but the fixed ones is locally Delaunay; return the number of flips."""
    edges = len(fixed)
    stack, waiting = np.arange(edges, dtype=np.int32), np.ones(edges, dtype=np.bool_)
    height, flips, limit = edges, 0, chunk_size(k, _CHUNK)
    while height > 0:
        height, more = flip_until_delaunay(k, xy, ring, org, fixed, stack, waiting, height, limit)
        flips += int(more)
        raise_if_interrupted()
    return flips


def _checked(points: FloatArray, corners: IntArray, segments: IntArray | None) -> Report:
    """Verify that the triangles are a triangulation of the points' hull; the report tells about the segments, too."""
    claims = _TRIANGULATION if segments is None else (*_TRIANGULATION, Property.SEGMENTS_PRESENT)
    report = verify(points, corners, segments=segments, claims=claims)
    for fault in () if report.ok else report.violations:
        if fault.property in (*_TRIANGULATION, Property.EDGE_MANIFOLD):
            raise InadmissibleError(
                f"the triangles are no triangulation of the points' hull: {fault.message}",
                report=report,
                indices=fault.triangles or fault.vertices,
            )
    return report


def _constrained(graph: PSLG, built: Insertion, report: Report) -> Constrained:
    """Return the edges along the segments of the graph."""
    plane = plane_of(built)
    pieces, missing = edges_along(plane, graph.segments)
    if missing.size:
        s = int(missing[0])
        more = f", nor are {missing.size - 1} more" if missing.size > 1 else ""
        raise InadmissibleError(
            f"segment {s} {tuple(graph.segments[s].tolist())} is no chain of edges of the triangles{more}",
            report=report,
            indices=missing.tolist(),
        )
    return in_order(plane, graph.segments, pieces)


def lawson(points: npt.ArrayLike, triangles: npt.ArrayLike, *, segments: npt.ArrayLike | None = None) -> Triangulation:
    """Return THE (constrained) Delaunay triangulation of the points, by flips from any triangulation of their hull.

    Args:
        points: (n, 2) finite coordinates, all distinct.
        triangles: integers (m, 3), counterclockwise, a triangulation of the convex hull that uses every point.
        segments: integers (s, 2), rows of points: chains of edges of the triangles, which are not flipped.

    Returns:
        The same :class:`Triangulation` as :func:`exactmesh.delaunay`, or with segments as
        :func:`exactmesh.constrained_delaunay` with ``carve=False``, up to the order of the triangles, whatever the
        start; ``work.flips`` is the number of flips.

    Raises:
        InadmissibleError: the triangles are no such triangulation; ``report`` is the verifier's, with witnesses, and
            ``indices`` names the triangles of the first, or the points where it has none. Or segments are no chains of
            their edges, and ``indices`` names these.
        PSLGError: segments that name no point, begin where they end, or are there twice.
        TooFewPointsError: fewer than three points.
        NonFiniteError, CoordinateError, ShapeError: as for :func:`exactmesh.delaunay`.

    At most n (n - 1) / 2 flips. Reference [Lawson 1977].

    >>> from exactmesh import lawson
    >>> mesh = lawson([(0, 0), (4, 0), (5, 3), (0, 1)], [(0, 1, 2), (0, 2, 3)])
    >>> mesh.work.flips, sorted(sorted(t) for t in mesh.triangles.tolist())
    (1, [[0, 1, 3], [1, 2, 3]])
    >>> lawson([(0, 0), (4, 0), (5, 3), (0, 1)], [(0, 1, 2), (0, 2, 3)], segments=[(2, 0)]).work.flips
    0
    """
    given = finite_points(points).copy()
    if len(given) < 3:
        raise TooFewPointsError(f"{len(given)} points span no triangle; at least 3 are needed")
    corners = vertex_indices(triangles)
    graph = PSLG(given, () if segments is None else segments)
    report = _checked(given, corners, None if segments is None else graph.segments)
    ring, org, face = rings_of(corners, neighbors_of(corners))
    xy, k = scaled_into_window(given)
    outer = face == OUTSIDE
    fixed = outer[0::2] | outer[1::2]
    same = np.arange(len(given), dtype=np.int32)
    built = Insertion(k, xy.reshape(-1), same.astype(np.int64), ring, org, same, len(fixed), 0)
    edges = _constrained(graph, built, report)
    fixed[edges.edges] = True
    built = built._replace(flips=flip_all(xy, k, ring, org, fixed))
    slot = np.where(outer.reshape(-1, 2)[:, ::-1].reshape(-1), OUTER, -1).astype(np.int32)
    found, neighbors = triangles_of(ring, org, slot, same)
    if segments is None:
        return Triangulation(given, found, neighbors, representative=same, work=work_of(k, built.flips))
    sides = (slot.reshape(-1, 2)[edges.edges] >= 0).sum(axis=1)
    cut = Cut(found, neighbors, np.full(len(found), -1, dtype=np.int32), sides, np.empty((0, 2)))
    return assembled(Task(graph, graph, None, None), built, edges, cut)
