"""From a constrained triangulation under work to a :class:`Triangulation`: which edges are parts of which segments, the
domain cut out, vertices numbered, markers and attributes handed over.
"""

from typing import NamedTuple

import numpy as np

from exactkernel.types import FloatArray, IntArray
from exactmesh.columns import MarkerArray
from exactmesh.crossings import Arrangement
from exactmesh.delaunay import Insertion, number_vertices
from exactmesh.edgealgebra import EdgeArray
from exactmesh.errors import Fault, FaultKind, PSLGError
from exactmesh.extract import triangles_of
from exactmesh.holes import seeds_of_holes
from exactmesh.locate import locate_points
from exactmesh.markers import boundary_edges, markers_along, vertex_markers
from exactmesh.plane import BoolArray, Plane
from exactmesh.pslg import PSLG, Carve
from exactmesh.regions import Place, open_faults, places_of, regions_of
from exactmesh.triangulation import Triangulation, work_of

__all__ = ["Constrained", "Cut", "Task", "assembled", "cut_out", "in_order", "of_source"]


class Task(NamedTuple):
    """What to triangulate.

    Attributes:
        graph: a graph whose segments do not cross.
        source: the graph that was given; the same, unless it had crossings.
        arrangement: how the one came from the other, or None.
        rule: which faces to keep; None keeps all.
    """

    graph: PSLG
    source: PSLG
    arrangement: Arrangement | None
    rule: Carve | None

    @property
    def domain(self) -> PSLG | None:
        """What the triangles are to cover; None is the convex hull."""
        if self.rule is None or self.arrangement is None:
            return None if self.rule is None else self.graph
        return self.arrangement.domain


class Constrained(NamedTuple):
    """Constrained edges, in the order of the segments they are part of, and along each.

    Attributes:
        edges: int (p,), their numbers in the quad-edge.
        ends: int32 (p, 2), their ends as positions, in the direction of the first segment they are part of.
        row, segment: int (q,) each: edges[row] is part of the segment.
    """

    edges: IntArray
    ends: IntArray
    row: IntArray
    segment: IntArray


def in_order(plane: Plane, given: IntArray, pieces: EdgeArray) -> Constrained:
    """Sort the pieces of segments; ``given`` (s, 2) are the segments' ends as positions. O(p log p)."""
    xy = plane.xy.reshape(-1, 2)
    order = np.argsort(pieces[:, 1], kind="stable")
    edge, segment = pieces[order].T
    ends = np.stack([plane.org[2 * edge], plane.org[2 * edge + 1]], axis=1)
    forward = precedes(xy[given[:, 0]], xy[given[:, 1]])[segment]
    backward = precedes(xy[ends[:, 0]], xy[ends[:, 1]]) != forward
    ends[backward] = ends[backward][:, ::-1]
    several = np.flatnonzero(np.bincount(segment, minlength=len(given))[segment] > 1)
    along = xy[ends[several, 0]]
    along[~forward[several]] *= -1.0
    ranked = several[np.lexsort((along[:, 1], along[:, 0], segment[several]))]
    edge[several], ends[several] = edge[ranked], ends[ranked]
    first = np.empty(len(plane.fixed), dtype=np.int64)
    first[edge[::-1]] = np.arange(len(edge))[::-1]
    is_first = first[edge] == np.arange(len(edge))
    row = (np.cumsum(is_first) - 1)[first[edge]]
    return Constrained(edge[is_first], ends[is_first], row, segment)


def precedes(p: FloatArray, q: FloatArray) -> BoolArray:
    """Tell for each row whether p is lexicographically smaller than q."""
    before: BoolArray = (p[:, 0] < q[:, 0]) | ((p[:, 0] == q[:, 0]) & (p[:, 1] < q[:, 1]))
    return before


def of_source(edges: Constrained, incidence: MarkerArray) -> Constrained:
    """Return the same edges as parts of the segments that the graph was noded from; O(q log q).

    ``incidence`` has sorted rows (segment of the noded graph, segment it is part of).
    """
    first, last = (np.searchsorted(incidence[:, 0], edges.segment, side) for side in ("left", "right"))
    many = last - first
    row = np.repeat(edges.row, many)
    segment = incidence[np.repeat(last - np.cumsum(many), many) + np.arange(many.sum()), 1].astype(np.int32)
    order = np.argsort(segment, kind="stable")
    return edges._replace(row=row[order], segment=segment[order])


class Cut(NamedTuple):
    """The domain, cut out of the triangulation of the hull.

    Attributes:
        triangles, neighbors: int32 (m, 3) each, the corners as positions.
        region: int32 (m,), the region of each triangle, or -1.
        sides: int (p,): how many triangles of the domain are at each constrained edge.
        holes: float64 (h, 2), a point in each part of the hull that the domain encloses.
    """

    triangles: IntArray
    neighbors: IntArray
    region: IntArray
    sides: IntArray
    holes: FloatArray


def cut_out(task: Task, built: Insertion, edges: Constrained) -> Cut:
    """Extract the triangles, and keep those of the domain.

    Raises:
        PSLGError: the segments leave the domain open, a seed lies outside of it, or nothing is left of it.
    """
    graph, rule = task.graph, task.rule
    slot = np.full(2 * built.edges, -1, dtype=np.int32)
    positions = np.arange(len(built.order), dtype=np.int32)
    triangles, neighbors = triangles_of(built.ring, built.org, slot, positions)
    sides = slot[2 * edges.edges[:, None] + np.arange(2)]  # of each constrained edge: 4 t + i, negative for the ghost
    fixed, odd = np.zeros_like(triangles, dtype=np.bool_), np.zeros_like(triangles, dtype=np.bool_)
    _mark(fixed, sides)
    _mark(odd, sides[np.bincount(edges.row, minlength=len(sides)) % 2 == 1])
    seeds = np.concatenate([graph.holes, graph.regions[:, :2]])
    found = locate_points(graph.points[built.order], triangles, neighbors, seeds) if len(seeds) else positions[:0]
    place = np.zeros(len(triangles), dtype=np.int32)
    faults: list[Fault] = []
    if rule is not None:
        place, faults = places_of(graph, rule, neighbors, fixed, odd, found)
    around = np.where(sides >= 0, place[sides >> 2], Place.EXTERIOR)
    if rule is Carve.SEEDS:
        lost = (around == Place.EXTERIOR).all(axis=1)
        faults = open_faults(task.source, np.unique(edges.segment[lost[edges.row]])) + faults
    kept = place == Place.DOMAIN
    if not (faults or kept.any()):
        faults = [Fault(FaultKind.EMPTY_DOMAIN, (), "every face is exterior, or a hole")]
    if faults:
        raise PSLGError(faults)
    region = regions_of(graph, neighbors, fixed, place, found[len(graph.holes) :])
    holes = graph.holes[:0]
    if not kept.all():
        if (place == Place.HOLE).any():
            points = graph.points[built.order]
            holes = seeds_of_holes(points, triangles, neighbors, kept, graph.holes, found[: len(graph.holes)])
        number = np.full(len(kept) + 1, -1, dtype=np.int32)
        number[:-1][kept] = np.arange(kept.sum(), dtype=np.int32)
        triangles, neighbors, region = triangles[kept], number[neighbors[kept]], region[kept]
    return Cut(triangles, neighbors, region, (around == Place.DOMAIN).sum(axis=1), holes)


def _mark(flags: BoolArray, sides: IntArray) -> None:
    real = sides[sides >= 0]
    flags.reshape(-1)[3 * (real >> 2) + (real & 3)] = True


def assembled(task: Task, built: Insertion, edges: Constrained, cut: Cut) -> Triangulation:
    """Number the vertices as their points come in the input, and hand everything over."""
    graph, source = task.graph, task.source
    kept, vertex, representative = number_vertices(built.order, built.twin)
    used = np.zeros(len(kept), dtype=np.bool_)
    used[vertex[cut.triangles]] = True
    if not used.all():
        number = np.full(len(kept) + 1, -1, dtype=np.int32)
        number[:-1][used] = np.arange(used.sum(), dtype=np.int32)
        kept, vertex, representative = kept[used], number[vertex], number[representative]
    inside = cut.sides > 0
    stays = inside[edges.row]
    incidence = np.stack([(np.cumsum(inside) - 1)[edges.row[stays]], edges.segment[stays]], axis=1).astype(np.int32)
    triangles, segments = vertex[cut.triangles], vertex[edges.ends[inside]]
    boundary = boundary_edges(triangles, cut.neighbors)
    attribute = graph.regions[cut.region, 2:3] if len(graph.regions) else np.zeros((len(triangles), 0))
    attributes = graph.point_attributes
    return Triangulation(
        points=graph.points.take(kept, axis=0),
        triangles=triangles,
        neighbors=cut.neighbors,
        representative=representative[: len(source.points)],
        work=work_of(built.k, built.flips),
        pslg=source,
        arrangement=task.arrangement,
        domain=task.domain,
        segments=segments,
        holes=cut.holes,
        segment_markers=markers_along(source, incidence, cut.sides[inside] == 1),
        segment_incidence=incidence[np.lexsort(incidence.T[::-1])],
        vertex_markers=vertex_markers(graph, representative, segments, boundary, source, incidence),
        vertex_attributes=np.zeros((len(kept), 0)) if attributes is None else attributes.take(kept, axis=0),
        triangle_attributes=np.where(cut.region[:, None] >= 0, attribute, 0.0),
        triangle_regions=cut.region,
    )
