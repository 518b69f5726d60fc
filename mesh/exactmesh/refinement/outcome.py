"""From a sheet back to a triangulation, with markers, attributes and the domain that is covered."""

from dataclasses import replace

import numpy as np
from gmpy2 import mpq

from exactkernel.types import FloatArray, IntArray
from exactmesh.columns import MarkerArray
from exactmesh.edgealgebra import EdgeArray
from exactmesh.extract import OUTER, triangles_of
from exactmesh.markers import boundary_edges
from exactmesh.pslg import PSLG, Carve
from exactmesh.refinement.displacement import displacement_squared
from exactmesh.refinement.layout import Layout
from exactmesh.refinement.result import Refinement
from exactmesh.refinement.rules import Reason
from exactmesh.refinement.sheet import DEAD, EDGES, FAULTS, FLIPS, GIVEN_UP, OUTSIDE, VERTICES, ByteArray, Sheet
from exactmesh.triangulation import Triangulation, work_of

__all__ = ["refinement_of"]


def _parts(s: Sheet, layout: Layout, mesh: Triangulation, points: FloatArray) -> tuple[IntArray, IntArray]:
    """Return the constrained edges, int32 (p, 2), sorted by row and along it, and their rows."""
    segment = s.segment[: int(s.counts[EDGES])]
    edges = np.flatnonzero((segment >= 0) & (segment < len(mesh.segments)))
    row = segment[edges]
    ends = s.org[: 2 * len(segment)].reshape(-1, 2)[edges]
    start, end = (points[layout.rows[row, i]] for i in range(2))
    sign = np.where(start < end, 1.0, -1.0)  # along a row, neither coordinate turns back
    first, last = points[ends[:, 0]] * sign, points[ends[:, 1]] * sign
    backward = (first > last).any(axis=1)
    ends[backward] = ends[backward][:, ::-1]
    least = np.minimum(first, last)
    order = np.lexsort((least[:, 1], least[:, 0], row))
    return ends[order], row[order]


def _incidence(mesh: Triangulation, row: IntArray) -> IntArray:
    """Return sorted rows (constrained edge, segment of the graph) for constrained edges that are parts of rows."""
    given = mesh.segment_incidence
    first, last = (np.searchsorted(given[:, 0], row, side) for side in ("left", "right"))
    many = last - first
    which = np.repeat(last - np.cumsum(many), many) + np.arange(many.sum())
    return np.stack([np.repeat(np.arange(len(row)), many), given[which, 1]], axis=1).astype(np.int32)


def _vertex_markers(s: Sheet, mesh: Triangulation, count: int) -> MarkerArray:
    """Return the markers of the input's vertices, and for those that divide an edge, its marker."""
    markers = np.zeros(count, dtype=np.int64)
    markers[: len(mesh.points)] = mesh.vertex_markers
    along = np.append(mesh.segment_markers, np.ones(1 + int(s.segment.max(initial=0)), dtype=np.int64))
    divides = np.flatnonzero(s.kind[:count] != 0)
    divides = divides[s.line[divides] >= 0]
    markers[divides] = along[s.line[divides]]
    return markers


def _vertex_attributes(s: Sheet, layout: Layout, mesh: Triangulation, points: FloatArray) -> FloatArray:
    """Interpolate the attributes: along the edge that a point divides, else in the triangle of the input."""
    given, old = mesh.vertex_attributes, len(mesh.points)
    if given.shape[1] == 0:
        return np.zeros((len(points), 0))
    found = np.concatenate([given, np.zeros((len(points) - old, given.shape[1]))])
    line = s.line[old : len(points)]
    on = old + np.flatnonzero(line >= 0)
    a, b = layout.rows[line[on - old]].T
    along, way = mesh.points[b] - mesh.points[a], points[on] - mesh.points[a]
    t = ((along * way).sum(axis=1) / (along * along).sum(axis=1))[:, None]
    found[on] = (1.0 - t) * given[a] + t * given[b]
    inner = old + np.flatnonzero(line < 0)
    corners = mesh.triangles[mesh.locate(points[inner])]
    p, (u, v, w) = points[inner], (mesh.points[corners[:, i]] for i in range(3))
    weights = np.stack([_cross(v - p, w - p), _cross(w - p, u - p), _cross(u - p, v - p)], axis=1)
    found[inner] = (weights[:, :, None] * given[corners]).sum(axis=1) / weights.sum(axis=1)[:, None]
    return found


def _cross(u: FloatArray, v: FloatArray) -> FloatArray:
    product: FloatArray = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    return product


def _moved(s: Sheet, layout: Layout, points: FloatArray, old: int) -> mpq:
    """Return the exact largest squared distance of a point that divides an edge of the input from that edge."""
    line = s.line[old : len(points)]
    on = np.flatnonzero(line >= 0)
    start, end = (points[layout.rows[line[on], i]] for i in range(2))
    return displacement_squared(points[old + on], start, end)


def _domain(mesh: Triangulation, segments: IntArray, outline: IntArray, points: FloatArray, moved: mpq) -> PSLG | None:
    """Return what the triangles cover: the domain that was given, or where its edges have moved, its parts' own."""
    if moved == 0:
        return mesh.domain
    regions = mesh.domain.regions if mesh.domain is not None else None
    both = np.concatenate([segments, outline])
    _, first = np.unique(np.sort(both, axis=1), axis=0, return_index=True)
    return PSLG(points, both[np.sort(first)], holes=mesh.holes, regions=regions, rule=Carve.SEEDS)


def _zones_of_triangles(s: Sheet, slot: EdgeArray, count: int) -> IntArray:
    """Return the zone of each triangle."""
    zone = np.empty(count, dtype=np.int32)
    inner = slot >= 0
    zone[slot[inner] >> 2] = s.zone[: len(slot)][inner]
    return zone


def _unrefined(s: Sheet, slot: EdgeArray) -> tuple[IntArray, ByteArray]:
    """Return the triangles that were given up or still wait, ascending, and the reasons."""
    state = s.state[: len(slot)]
    reason = state // GIVEN_UP
    reason[state & FAULTS != 0] = Reason.BUDGET
    halves = np.flatnonzero(reason)
    triangle = slot[halves] >> 2
    order = np.argsort(triangle, kind="stable")
    return triangle[order].astype(np.int32), reason[halves[order]]


def without_dead(s: Sheet) -> Sheet:
    """Return the sheet without the vertices that were removed; of those that they caused, the parent is -1."""
    count, edges = int(s.counts[VERTICES]), int(s.counts[EDGES])
    if s.counts[DEAD] == 0:
        return s
    alive = np.flatnonzero(s.kind[:count] >= 0)
    number = np.full(count + 1, -1, dtype=np.int32)
    number[alive] = np.arange(len(alive), dtype=np.int32)
    counts = s.counts.copy()
    counts[VERTICES], counts[DEAD] = len(alive), 0
    return s._replace(
        xy=s.xy[: 2 * count].reshape(-1, 2)[alive].reshape(-1),
        org=number[s.org[: 2 * edges]],
        line=s.line[alive],
        parent=number[s.parent[alive]],
        radius=s.radius[alive],
        root=s.root[alive],
        kind=s.kind[alive],
        counts=counts,
    )


def refinement_of(
    s: Sheet, layout: Layout, mesh: Triangulation, regions: IntArray, attributes: FloatArray
) -> Refinement:
    """Return the result; ``regions`` and ``attributes`` (z, a) are those of the triangles in each zone. O(n log n)."""
    s = without_dead(s)
    old, count, edges = len(mesh.points), int(s.counts[VERTICES]), int(s.counts[EDGES])
    points = np.empty((count, 2))
    points[:old] = mesh.points
    points[old:] = np.ldexp(s.xy[2 * old : 2 * count].reshape(-1, 2), -layout.exponent)
    slot = np.where(s.zone[: 2 * edges] == OUTSIDE, OUTER, -1).astype(np.int32)
    same = np.arange(count, dtype=np.int32)
    triangles, neighbors = triangles_of(s.ring[: 4 * edges], s.org[: 2 * edges], slot, same)
    segments, row = _parts(s, layout, mesh, points)
    moved = _moved(s, layout, points, old)
    zone = _zones_of_triangles(s, slot, len(triangles))
    unrefined, reasons = _unrefined(s, slot)
    refined = replace(
        mesh,
        points=points,
        triangles=triangles,
        neighbors=neighbors,
        work=work_of(s.k, int(s.counts[FLIPS])),
        domain=_domain(mesh, segments, boundary_edges(triangles, neighbors), points, moved),
        segments=segments,
        segment_markers=mesh.segment_markers[row],
        segment_incidence=_incidence(mesh, row),
        vertex_markers=_vertex_markers(s, mesh, count),
        vertex_attributes=_vertex_attributes(s, layout, mesh, points),
        triangle_attributes=attributes[zone],
        triangle_regions=regions[zone],
    )
    return Refinement(
        refined, unrefined, reasons, steiner=np.arange(old, count, dtype=np.int32), kinds=s.kind[old:count].copy(),
        parents=s.parent[old:count].copy(), radii=np.ldexp(s.radius[old:count], -layout.exponent),
        displacement_squared=moved,
    )  # fmt: skip
