"""ADMISSIBLE, decided exactly for every set of cells, in linear time where the boundary is convex.

Let T be triangles with area and strictly convex quadrilaterals, counterclockwise, no directed edge twice, and B the
directed edges without a reverse.

1. For x on no edge, the number of cells that contain x is the winding number of B around x: the
   boundaries of the cells sum to B, matched edges cancel.
2. Theorem. T is admissible iff (i) two edges of B meet only in vertices (indices) that they share, and (ii)
   every edge of B has winding number 1 on its left and 0 on its right. If T is admissible, two edges of B lie
   in cells that meet in a common corner or edge; that edge is matched, hence not in B, so the two meet in
   one of its ends at most; and no point is covered twice. Conversely, every component of the complement of B
   touches an edge of B, so by (ii) no x is covered twice. Suppose that p is common to two cells s, t, but
   is no common corner and on no common edge. Their interiors are disjoint, so p is on the boundary of both. If p is
   inside a matched edge of s, or at a corner of s round which the cells close, then s and its neighbours
   cover a neighbourhood of p; t has area near p, so t is one of them, and p is a common corner or on a common
   edge after all. So p lies on an edge of B on both sides, which (i) forbids. Being convex with disjoint
   interiors, s and t are separated by a line, which meets each of them, strictly convex as they are, in a
   corner or an edge: they have nothing, one corner, or one edge in common.
3. If B is one convex cycle, its interior has winding number 1 and the rest 0 (theorems A and C), hence (i)
   and (ii).

Two cells on one side of an edge overlap, so a directed edge that occurs twice is a violation. (i) implies
that no two vertices of B share a position; inner vertices cannot, by the neighbourhood argument: theorem B.
"""

import numpy as np

from exactkernel.orient2d import orient2d
from exactkernel.types import FloatArray
from exactmesh.verify.boundary import Boundary, boundary_of
from exactmesh.verify.cells import Cells
from exactmesh.verify.links import Links, linked
from exactmesh.verify.local import localized
from exactmesh.verify.manifold import repeated_edges
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.pairs import overlapping_row, part_of, rows_listing
from exactmesh.verify.properties import Kind, Property, Verdict
from exactmesh.verify.report import WITNESSES, Finding, Violation
from exactmesh.verify.sweep import COVERED_TWICE, IMPROPER, PROPER, swept
from exactmesh.verify.triangles import Shapes
from exactmesh.verify.witness import IndexArray, finding_of, point_name, rows_at_vertices, triangle_name

__all__ = ["check_overlap", "check_sweep", "check_zero_area"]


def check_zero_area(mesh: Mesh, shapes: Shapes) -> Finding:
    """Find triangles without area."""

    def describe(t: int) -> Violation:
        corners = tuple(mesh.triangles[t].tolist())
        message = f"triangle {t} = {triangle_name(mesh.points, corners)} has no area"
        return Violation(Property.ADMISSIBLE, Kind.ZERO_AREA, (t,), corners, message)

    return finding_of(np.flatnonzero(shapes.orientation == 0), describe)


def check_overlap(mesh: Mesh, cells: Cells, links: Links) -> Finding:
    """Find counterclockwise cells on the same side of an edge."""
    return repeated_edges(mesh, cells, links, Property.ADMISSIBLE, Kind.OVERLAP, "they overlap")


def check_sweep(mesh: Mesh, cells: Cells, boundary: Boundary) -> Finding:
    """Decide (i) and (ii), for counterclockwise cells without repeated edges. O(b log b); stops at the first fault."""
    vertices, points = _sorted_vertices(mesh, boundary)
    same = (points[1:] == points[:-1]).all(axis=1)
    if same.any():
        return _coincident(mesh, np.stack([vertices[:-1][same], vertices[1:][same]], axis=1))
    fault, edges = _swept(mesh, boundary, vertices, points)
    if fault == PROPER:
        return Finding(Verdict.HOLDS)
    first, second = (rows[0] for rows in rows_listing(cells, np.array(edges), len(mesh.points)))
    if fault == COVERED_TWICE:
        first = overlapping_row(mesh, cells, second)
    violation = _meeting(mesh, cells, (min(first, second), max(first, second)))
    return Finding(Verdict.FAILS, 1, (violation,), lower_bound=True)


def _sorted_vertices(mesh: Mesh, boundary: Boundary) -> tuple[IndexArray, FloatArray]:
    """Return the vertices of the boundary in lexicographic order, and where they are."""
    vertices = np.unique(boundary.origin)  # a closed chain: the targets are the same
    x, y = mesh.coordinates[vertices].T
    vertices = vertices[np.lexsort((y, x))]
    return vertices, mesh.coordinates[vertices]


def _swept(
    mesh: Mesh, boundary: Boundary, vertices: IndexArray, points: FloatArray
) -> tuple[int, list[tuple[int, int]]]:
    """Return the fault, and the two directed edges of the boundary that show it."""
    rank = np.empty(len(mesh.points), dtype=np.intp)
    rank[vertices] = np.arange(len(vertices))
    fault, *shown = swept(mesh.context, points, rank[boundary.origin], rank[boundary.target])
    edges = [] if fault == PROPER else [(int(boundary.origin[i]), int(boundary.target[i])) for i in shown]
    return fault, edges


def _meeting(mesh: Mesh, cells: Cells, rows: tuple[int, int]) -> Violation:
    """Say how two cells meet where they should not: what the sweep finds when there are no others."""
    part, own, points = part_of(mesh, cells, rows)
    boundary = boundary_of(linked(len(part.points), part.context, localized(part.coordinates, *own)))
    fault, edges = _swept(part, boundary, *_sorted_vertices(part, boundary))
    (a, b), (c, d) = ((int(points[v]), int(points[w])) for v, w in edges)
    if fault == IMPROPER:
        kind, sentence = _improper(mesh, (a, b), (c, d))
        message = f"{sentence}: {mesh.noun}s {rows[0]} and {rows[1]}"
    else:
        kind = Kind.OVERLAP
        message = f"{mesh.noun}s {rows[0]} and {rows[1]} overlap, to the left of {_edge(mesh, c, d)}"
    return Violation(Property.ADMISSIBLE, kind, rows, tuple(dict.fromkeys((a, b, c, d))), message)


def _edge(mesh: Mesh, a: int, b: int) -> str:
    return f"the edge {point_name(mesh.points, a)} - {point_name(mesh.points, b)}"


def _coincident(mesh: Mesh, pairs: IndexArray) -> Finding:
    rows = rows_at_vertices(mesh.triangles, pairs[:WITNESSES].ravel(), len(mesh.points), mesh.quads)

    def describe(i: int) -> Violation:
        v, w = pairs[i].tolist()
        message = f"corners {point_name(mesh.points, v)} and {point_name(mesh.points, w)} are at the same position"
        return Violation(Property.ADMISSIBLE, Kind.HANGING_NODE, (rows[v][0], rows[w][0]), (v, w), message)

    finding = finding_of(np.arange(len(pairs)), describe)
    return Finding(Verdict.FAILS, finding.count, finding.violations, lower_bound=True)


def _improper(mesh: Mesh, e: tuple[int, int], f: tuple[int, int]) -> tuple[Kind, str]:
    """Say how two edges meet where they should not."""
    for (a, b), (c, d) in ((e, f), (f, e)):
        for v in (c, d):
            if v not in (a, b) and _lies_on(mesh, v, a, b):
                return Kind.HANGING_NODE, f"vertex {point_name(mesh.points, v)} lies on {_edge(mesh, a, b)}"
    return Kind.CROSSING, f"{_edge(mesh, *e)} crosses {_edge(mesh, *f)}"


def _lies_on(mesh: Mesh, v: int, a: int, b: int) -> bool:
    p, q, r = (tuple(mesh.points[i].tolist()) for i in (a, v, b))
    return orient2d(p, r, q) == 0 and (p < q < r or r < q < p)
