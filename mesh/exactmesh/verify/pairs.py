"""Which two cells are at fault: a witness names no third that could be left out."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from exactkernel.batch import orient2d_batch
from exactkernel.context import Context, chunk_size
from exactkernel.jit import jit
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.verify.cells import Cells
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.witness import IndexArray

__all__ = ["overlapping_row", "part_of", "rows_listing", "rows_round", "unlinked_rows"]

_CHUNK = 1 << 12  # cells that are tested for an overlap at once
_LOOP = 1 << 17  # triangles between two looks at Ctrl-C


def rows_listing(cells: Cells, edges: IndexArray, n: int) -> list[list[int]]:
    """Return for each directed edge (e, 2), which differ, the rows of the cells that list it, ascending. O(m log e)."""
    keys = edges[:, 0].astype(np.int64) << 32 | edges[:, 1]
    order = np.argsort(keys)
    origins, targets = np.zeros((2, n), dtype=np.bool_)
    origins[edges[:, 0]] = targets[edges[:, 1]] = True
    found: list[list[int]] = [[] for _ in range(len(edges))]
    for before, block in ((0, cells.triangles), (len(cells.triangles), cells.quads)):
        for i in range(block.shape[1]):
            a, b = block[:, i], block[:, (i + 1) % block.shape[1]]
            near = np.flatnonzero(origins[a] & targets[b])
            wanted = a[near].astype(np.int64) << 32 | b[near]
            places = order[np.minimum(np.searchsorted(keys[order], wanted), len(order) - 1)]
            hits = keys[places] == wanted
            for place, row in zip(places[hits].tolist(), near[hits].tolist(), strict=True):
                found[place].append(before + row)
    return [sorted(rows) for rows in found]


def unlinked_rows(cells: Cells, vertices: IndexArray, n: int) -> dict[int, tuple[int, int]]:
    """Return for each vertex round which the cells form no fan two of them that form none: they list an edge at the
    vertex in the same direction, or no way round the vertex leads from one to the other. O(m)."""
    near = np.zeros(n, dtype=np.bool_)
    near[vertices] = True
    arcs: dict[int, list[tuple[int, int, int]]] = {int(v): [] for v in vertices}
    for before, block in ((0, cells.triangles), (len(cells.triangles), cells.quads)):
        for row in np.flatnonzero(near[block].any(axis=1)).tolist():
            corners = block[row].tolist()
            for i, v in enumerate(corners):
                if v in arcs:
                    arcs[v].append((corners[(i + 1) % len(corners)], corners[i - 1], before + row))
    return {v: _unlinked(found) for v, found in arcs.items()}


def _unlinked(arcs: Sequence[tuple[int, int, int]]) -> tuple[int, int]:
    """Return the rows of two arcs with the same tail or head, or else of two that no path of arcs contains."""
    by_tail: dict[int, tuple[int, int]] = {}
    by_head: dict[int, tuple[int, int]] = {}
    for tail, head, row in arcs:
        for ends, other, known in ((tail, head, by_tail), (head, tail, by_head)):
            if ends in known:
                return known[ends][1], row
            known[ends] = (other, row)
    tail, head, first = arcs[0]
    linked = {first}
    for end, known in ((head, by_tail), (tail, by_head)):
        while end in known and known[end][1] not in linked:
            end, row = known[end]
            linked.add(row)
    return first, next(row for _, _, row in arcs if row not in linked)


def overlapping_row(mesh: Mesh, cells: Cells, row: int) -> int:
    """Return the first cell whose interior meets that of a given one, another one being known to do so. O(m).

    The cells are convex and counterclockwise. So their interiors are disjoint exactly where all corners of the one lie
    to the right of an edge of the other or on it.
    """
    own = mesh.coordinates[_corners(cells, row)]
    low, high = own.min(axis=0), own.max(axis=0)
    for before, block in ((0, cells.triangles), (len(cells.triangles), cells.quads)):
        near = np.ones(len(block), dtype=np.bool_)
        for axis in (0, 1):
            z = mesh.coordinates[:, axis][block]
            near &= (z.min(axis=1) < high[axis]) & (z.max(axis=1) > low[axis])
        rows = np.flatnonzero(near)
        for start in range(0, len(rows), _CHUNK):
            part = rows[start : start + _CHUNK]
            part = part[before + part != row]
            meets = ~_separated(own, mesh.coordinates[block[part]])
            if meets.any():
                return before + int(part[np.argmax(meets)])
    raise AssertionError("no cell overlaps, although the winding number says so")


def _corners(cells: Cells, row: int) -> IntArray:
    m = len(cells.triangles)
    corners: IntArray = cells.triangles[row] if row < m else cells.quads[row - m]
    return corners


def _separated(own: FloatArray, others: FloatArray) -> npt.NDArray[np.bool_]:
    """Tell which convex polygons (c, s, 2) an edge of theirs or of one polygon (r, 2) separates from it."""
    apart = np.zeros(len(others), dtype=np.bool_)
    for i in range(len(own)):
        apart |= (orient2d_batch(own[i - 1], own[i], others.reshape(-1, 2)).reshape(others.shape[:2]) <= 0).all(axis=1)
    for i in range(others.shape[1]):
        a, b = others[:, i - 1], others[:, i]
        apart |= np.logical_and.reduce([orient2d_batch(a, b, corner) <= 0 for corner in own])
    return apart


def part_of(mesh: Mesh, cells: Cells, rows: tuple[int, ...]) -> tuple[Mesh, Cells, IndexArray]:
    """Return some cells as a mesh of their own, and the points that its vertices are, ascending."""
    m = len(cells.triangles)
    triangles = cells.triangles[[row for row in rows if row < m]]
    quads = cells.quads[[row - m for row in rows if row >= m]]
    points = np.unique(np.concatenate([triangles.ravel(), quads.ravel()]))
    own = Cells(*(np.searchsorted(points, block).astype(np.int32) for block in (triangles, quads)))
    return Mesh(mesh.points[points], mesh.coordinates[points], mesh.context, *own), own, points


@jit
def find_round(
    k: Context,
    points: FloatArray,
    triangles: IntArray,
    wanted: FloatArray,
    found: IndexArray,
    t_begin: int,
    t_end: int,
) -> None:
    """Write the row of a closed triangle round each position; these are sorted by x."""
    for t in range(t_begin, t_end):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        ax, ay, bx, by, cx, cy = points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1]
        low, high = min(ax, min(bx, cx)), max(ax, max(bx, cx))
        for i in range(np.searchsorted(wanted[:, 0], low), len(wanted)):
            x, y = wanted[i, 0], wanted[i, 1]
            if x > high:
                break
            if found[i] >= 0:
                continue
            left = orient2d_adaptive(k, ax, ay, bx, by, x, y)
            middle = orient2d_adaptive(k, bx, by, cx, cy, x, y)
            right = orient2d_adaptive(k, cx, cy, ax, ay, x, y)
            if min(left, min(middle, right)) >= 0 or max(left, max(middle, right)) <= 0:
                found[i] = t


def rows_round(mesh: Mesh, vertices: IndexArray) -> IndexArray:
    """Return for each of a few vertices the row of a triangle, all of which have an area, that contains it; -1 if there
    is none. O(m log v)."""
    order = np.argsort(mesh.coordinates[vertices, 0], kind="stable")
    wanted, found = mesh.coordinates[vertices[order]], np.full(len(vertices), -1, dtype=np.intp)
    step = chunk_size(mesh.context, _LOOP)
    for begin in range(0, len(mesh.triangles), step):
        end = min(begin + step, len(mesh.triangles))
        find_round(mesh.context, mesh.coordinates, mesh.triangles, wanted, found, begin, end)
        raise_if_interrupted()
    rows = np.empty_like(found)
    rows[order] = found
    return rows
