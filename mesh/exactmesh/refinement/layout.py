"""From a triangulation to a sheet with room to grow."""

from typing import NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from exactkernel.constants import MAX_COORDINATE_DEGREE_4, MIN_UNIT_DEGREE_4
from exactkernel.context import bits_of, exponent_into_window, make_context, rebounded
from exactkernel.jit import jit
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.connectivity import planar_rings_of
from exactmesh.edgealgebra import EdgeArray, dest, origin
from exactmesh.lawson import flip_all
from exactmesh.markers import boundary_edges, edge_keys
from exactmesh.plane import BoolArray
from exactmesh.refinement.queue import BUCKETS, clear_queue
from exactmesh.refinement.sheet import EDGES, FIXED, OUTSIDE, TOP, VERTICES, WAITING, Sheet
from exactmesh.triangulation import Triangulation

_TINIEST = 5e-324  # the smallest double: no restriction

__all__ = ["Layout", "grown", "laid_out"]

A = TypeVar("A", bound=np.generic)


class Layout(NamedTuple):
    """A sheet, and what of the triangulation it came from is needed besides.

    Attributes:
        sheet: its coordinates are those of the points times 2^exponent.
        exponent: see there.
        unit: new coordinates of the sheet are to be multiples of it.
        rows: int32 (r, 2), the fixed edges: the segments of the triangulation, then the other edges of its boundary.
        lines: int32 (r, 2), the ends of the straight line that each is part of: see ``lines_of``.
        sharp: bool (r, 2), whether another line leaves those ends at less than 90 degrees.
    """

    sheet: Sheet
    exponent: int
    unit: float
    rows: IntArray
    lines: IntArray
    sharp: BoolArray


@jit
def follow_lines(rows: IntArray, at: IntArray, smooth: BoolArray, lines: IntArray) -> None:
    """Write the ends of each row's line, from both its ends on through smooth vertices; ``at`` has their rows."""
    for first in range(len(rows)):
        if lines[first, 0] >= 0:
            continue
        for side in range(2):
            row, v = first, rows[first, side]
            while smooth[v]:
                row = at[v, 0] + at[v, 1] - row
                if row == first:
                    break
                v = rows[row, 0] + rows[row, 1] - v
            lines[first, side] = v
            row, v = first, rows[first, 1 - side]
            while smooth[v]:
                row = at[v, 0] + at[v, 1] - row
                if row == first:
                    break
                v = rows[row, 0] + rows[row, 1] - v
                lines[row, side] = lines[first, side]


def lines_of(mesh: Triangulation, rows: IntArray) -> tuple[IntArray, IntArray]:
    """Return the ends of each row's line, int32 (r, 2), and for each vertex inside of a line one of its rows, or -1.

    A line is what of one segment of the input lies between two vertices at which other segments end.
    """
    n = len(mesh.points)
    source = np.full(len(rows), -1, dtype=np.int64)
    incidence = mesh.segment_incidence[::-1]
    source[incidence[:, 0]] = incidence[:, 1]
    degree = np.bincount(rows.reshape(-1), minlength=n)
    at = np.full((n, 2), -1, dtype=np.int32)
    numbers = np.repeat(np.arange(len(rows), dtype=np.int32), 2)
    at[rows.reshape(-1), 0] = numbers
    at[rows.reshape(-1)[::-1], 1] = numbers[::-1]
    smooth = (degree == 2) & (source[at[:, 0]] == source[at[:, 1]]) & (source[at[:, 0]] >= 0)
    lines = np.full_like(rows, -1)
    follow_lines(rows, at, smooth, lines)
    return lines, np.where(smooth, at[:, 0], np.int32(-1)).astype(np.int32)


@jit
def mark_sharp(
    xy: FloatArray, ring: EdgeArray, org: EdgeArray, zone: EdgeArray, segment: EdgeArray, lines: IntArray,
    sharp: BoolArray,
) -> None:  # fmt: skip
    """Mark the ends of lines from which, through the domain, the next fixed edge is less than 90 degrees away."""
    for e in range(0, 4 * len(segment), 2):
        if segment[e >> 2] < 0 or zone[e >> 1] == OUTSIDE:
            continue
        f = ring[e]
        while segment[f >> 2] < 0:
            f = ring[f]
        v, a, b = origin(org, e), dest(org, e), dest(org, f)
        ax, ay = xy[2 * a] - xy[2 * v], xy[2 * a + 1] - xy[2 * v + 1]
        bx, by = xy[2 * b] - xy[2 * v], xy[2 * b + 1] - xy[2 * v + 1]
        dot, cross = ax * bx + ay * by, ax * by - ay * bx
        if f != e and cross >= 0.0 and dot > 0.0:
            for row in (segment[e >> 2], segment[f >> 2]):
                for end in range(2):
                    if lines[row, end] == v:
                        sharp[row, end] = True


@jit
def shortest_edges(xy: FloatArray, org: EdgeArray, radius: FloatArray) -> None:
    """Write the squared length of the shortest edge at each vertex."""
    radius[:] = np.inf
    for half in range(0, len(org), 2):
        a, b = org[half], org[half + 1]
        dx, dy = xy[2 * a] - xy[2 * b], xy[2 * a + 1] - xy[2 * b + 1]
        squared = dx * dx + dy * dy
        radius[a] = min(radius[a], squared)
        radius[b] = min(radius[b], squared)


def _fixed_rows(mesh: Triangulation) -> IntArray:
    """Return the segments, and then the edges of the boundary that are none."""
    outline = boundary_edges(mesh.triangles, mesh.neighbors)
    extra = outline[~np.isin(edge_keys(outline), edge_keys(mesh.segments))]
    return np.concatenate([mesh.segments, extra]).astype(np.int32)


def laid_out(mesh: Triangulation, zone: IntArray) -> Layout:
    """Return the triangulation as a sheet; ``zone`` int32 (m,) of its triangles. O(m log m)."""
    ring, org, face = planar_rings_of(mesh.points, mesh.triangles, mesh.neighbors)
    vertices, edges = len(mesh.points), len(org) // 2
    maximum, unit = bits_of(mesh.points)
    exponent = exponent_into_window(maximum, unit)
    scaled = np.ldexp(mesh.points, exponent)
    k, finest = make_context(scaled), _TINIEST
    if k.incircle_bound < np.inf and np.abs(scaled).max() <= MAX_COORDINATE_DEGREE_4:
        finest = max(MIN_UNIT_DEGREE_4, float(np.ldexp(1.0, max(exponent - 1074, -1074))))
        k = rebounded(k, float(np.abs(scaled).max()), finest)
    rows = _fixed_rows(mesh)
    lines, line = lines_of(mesh, rows)
    keys = edge_keys(org.reshape(-1, 2))
    order = np.argsort(keys)
    segment = np.full(edges, -1, dtype=np.int32)
    segment[order[np.searchsorted(keys, edge_keys(rows), sorter=order)]] = np.arange(len(rows), dtype=np.int32)
    of_half = np.append(zone, np.int32(OUTSIDE))[face.reshape(-1, 2)[:, ::-1].reshape(-1)].astype(np.int32)
    flip_all(scaled, k, ring, org, segment >= 0)
    sharp = np.zeros(rows.shape, dtype=np.bool_)
    xy = scaled.reshape(-1)
    mark_sharp(xy, ring, org, of_half, segment, lines, sharp)
    radius = np.empty(vertices)
    shortest_edges(xy, org, radius)
    np.sqrt(radius, out=radius)
    nothing = np.empty(0, dtype=np.int32)
    small = np.zeros(edges, dtype=np.int8)
    counts = np.zeros(7, dtype=np.int64)
    counts[VERTICES], counts[EDGES], counts[FIXED], counts[TOP] = vertices, edges, len(rows), -1
    sheet = Sheet(
        k, xy, ring, org, of_half, segment, hard=small, line=line, parent=np.full(vertices, -1, dtype=np.int32),
        radius=radius, root=radius.copy(), kind=np.zeros(vertices, dtype=np.int8), waiting=nothing,
        before=np.empty(BUCKETS, dtype=np.int32), after=np.empty(BUCKETS, dtype=np.int32),
        state=np.zeros(2 * edges, dtype=np.int8),
        flipped=nothing, hit=nothing, counts=counts,
    )  # fmt: skip
    clear_queue(sheet)
    raise_if_interrupted()
    return Layout(sheet, exponent, finest, rows, lines, sharp)


def _stretched(array: npt.NDArray[A], size: int) -> npt.NDArray[A]:
    longer = np.zeros(size, dtype=array.dtype)
    longer[: len(array)] = array
    return longer


def grown(s: Sheet, vertices: int) -> Sheet:
    """Return the sheet with room for so many vertices in all, and three times as many edges."""
    edges = 3 * vertices
    fixed = 8 * (int(s.counts[WAITING]) + int(s.counts[FIXED]) + 64)
    return s._replace(
        xy=_stretched(s.xy, 2 * vertices),
        ring=_stretched(s.ring, 4 * edges),
        org=_stretched(s.org, 2 * edges),
        zone=_stretched(s.zone, 2 * edges),
        segment=_stretched(s.segment, edges),
        hard=_stretched(s.hard, edges),
        line=_stretched(s.line, vertices),
        parent=_stretched(s.parent, vertices),
        radius=_stretched(s.radius, vertices),
        root=_stretched(s.root, vertices),
        kind=_stretched(s.kind, vertices),
        waiting=_stretched(s.waiting, max(fixed, len(s.waiting))),
        before=_stretched(s.before, BUCKETS + 2 * edges),
        after=_stretched(s.after, BUCKETS + 2 * edges),
        state=_stretched(s.state, 2 * edges),
        flipped=np.empty(edges, dtype=np.int32),
        hit=np.empty(edges, dtype=np.int32),
    )
