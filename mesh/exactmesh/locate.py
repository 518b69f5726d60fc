"""Point location in a finished triangulation: a visibility walk, query after query along a space-filling curve.

In a Delaunay triangulation (perturbed or not) the walk enters no triangle twice [Edelsbrunner 1990]. In others it may
turn in a circle, though hardly ever, since it starts each triangle at another side [Devillers 2002]; a walk of more
steps than there are triangles gives way to a look at every triangle, so that location ends in any triangulation.
"""

import math

import numpy as np

from exactkernel.batch import orient2d_batch
from exactkernel.context import Context, chunk_size, scaled_into_window, thread_context
from exactkernel.jit import jit
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.ordering import IndexArray, insertion_order

__all__ = ["locate_points", "on_boundary"]

_CHUNK = 1 << 17  # queries between two looks at Ctrl-C, where predicates are fast
_WORTH_A_SCAN = 256  # vertices for each query: from there on, a look at all coordinates takes longer than it saves


@jit
def scan(k: Context, points: FloatArray, triangles: IntArray, x: float, y: float) -> int:
    """Return the first triangle whose closure contains (x, y), or -1: outside the hull."""
    for t in range(len(triangles)):
        inside = True
        for i in range(3):
            a, b = triangles[t, i], triangles[t, (i + 1) % 3]
            if orient2d_adaptive(k, points[a, 0], points[a, 1], points[b, 0], points[b, 1], x, y) < 0:
                inside = False
                break
        if inside:
            return t
    return -1


@jit
def _walk(
    k: Context, points: FloatArray, triangles: IntArray, neighbors: IntArray, start: int, x: float, y: float
) -> int:
    """Return the triangle whose closure contains (x, y), or -1 - t for the triangle t that it left over the hull."""
    t, came_from, side = start, -1, 0
    for _ in range(len(triangles)):
        side = (side * 5 + t + 1) % 3  # any side may be the first to be tested
        leave = -1
        for turn in range(3):
            i = (side + turn) % 3
            beyond = neighbors[t, i]
            if beyond == came_from and came_from >= 0:
                continue
            a, b = triangles[t, (i + 1) % 3], triangles[t, (i + 2) % 3]
            if orient2d_adaptive(k, points[a, 0], points[a, 1], points[b, 0], points[b, 1], x, y) < 0:
                leave = i
                break
        if leave < 0:
            return t
        if neighbors[t, leave] < 0:
            return -1 - t
        came_from, t = t, neighbors[t, leave]
    return scan(k, points, triangles, x, y)


@jit
def _walk_all(
    k: Context, points: FloatArray, triangles: IntArray, neighbors: IntArray, queries: FloatArray, order: IndexArray,
    start: int, found: IntArray,
) -> int:  # fmt: skip
    """Locate queries[order], one from where the last one ended; return the triangle of the last."""
    for i in order:
        t = _walk(k, points, triangles, neighbors, start, queries[i, 0], queries[i, 1])
        found[i] = max(t, -1)
        start = t if t >= 0 else -1 - t
    return start


@jit
def heuristic_start(points: FloatArray, triangles: IntArray, x: float, y: float) -> int:
    """Return the one of some triangles, about the cube root of all, a corner of which is nearest to (x, y).

    From there a walk takes about as many steps as it looked at triangles. Reference [Mucke 1999].
    """
    best, nearest = 0, math.inf
    step = max(1, int(len(triangles) / (1.0 + len(triangles) ** (1.0 / 3.0))))
    for t in range(0, len(triangles), step):
        dx, dy = points[triangles[t, 0], 0] - x, points[triangles[t, 0], 1] - y
        squared = dx * dx + dy * dy
        if squared < nearest:
            best, nearest = t, squared
    return best


@jit
def _walk_each(
    k: Context, points: FloatArray, triangles: IntArray, neighbors: IntArray, queries: FloatArray, found: IntArray
) -> None:
    """Locate a few queries, each from a start of its own."""
    for i in range(len(queries)):
        x, y = queries[i, 0], queries[i, 1]
        found[i] = max(_walk(k, points, triangles, neighbors, heuristic_start(points, triangles, x, y), x, y), -1)


@np.errstate(over="ignore", invalid="ignore")  # interpreted, a numpy scalar warns where a double does not
def locate_points(points: FloatArray, triangles: IntArray, neighbors: IntArray, queries: FloatArray) -> IntArray:
    """Return the triangle of each query (finite), int32, -1 outside the hull.

    O(k log k) and short walks; for a few queries, about the cube root of the number of triangles each.
    """
    found = np.empty(len(queries), dtype=np.int32)
    if len(queries) * _WORTH_A_SCAN <= len(points):
        _walk_each(thread_context(), points, triangles, neighbors, queries, found)
        raise_if_interrupted()
        return found
    scaled, k = scaled_into_window(np.concatenate([points, queries]))
    corners, sought = scaled[: len(points)], scaled[len(points) :]
    order = insertion_order(sought, seed=0)
    start, step = 0, chunk_size(k, _CHUNK)
    for first in range(0, len(order), step):
        start = _walk_all(k, corners, triangles, neighbors, sought, order[first : first + step], start, found)
        raise_if_interrupted()
    return found


def on_boundary(
    points: FloatArray, triangles: IntArray, neighbors: IntArray, m: int, queries: FloatArray, found: IntArray
) -> IntArray:
    """Return for queries in triangles that complete the first m one of the m that they lie on the boundary of, or -1.

    ``found`` are those triangles, whose closures contain the queries.
    """
    place = triangles[found]
    on_side = np.stack(
        [orient2d_batch(points[place[:, (i + 1) % 3]], points[place[:, (i + 2) % 3]], queries) == 0 for i in range(3)],
        axis=1,
    )
    zeros = on_side.sum(axis=1)
    at_vertex = np.empty(len(points), dtype=np.int32)  # every corner of these triangles is one of the first m's, too
    at_vertex[triangles[:m].reshape(-1)] = np.repeat(np.arange(m, dtype=np.int32), 3)
    rows = np.arange(len(found))
    beside = neighbors[found, on_side.argmax(axis=1)]
    result = np.where((zeros == 1) & (beside < m), beside, np.int32(-1))
    corner = place[rows, on_side.argmin(axis=1)]
    result[zeros == 2] = at_vertex[corner[zeros == 2]]
    return result
