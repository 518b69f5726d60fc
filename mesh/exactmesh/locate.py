"""Point location in a finished triangulation: a visibility walk, query after query along a space-filling curve.

The walk starts each triangle at a side that changes pseudo-randomly, so it ends (with probability one) in every
triangulation of a convex hull, Delaunay or not. Reference [Devillers 2002].
"""

import numpy as np

from exactkernel.context import Context, make_context
from exactkernel.jit import jit
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.ordering import IndexArray, insertion_order

__all__ = ["locate_points"]

_CHUNK = 1 << 17


@jit
def _walk(
    k: Context, points: FloatArray, triangles: IntArray, neighbors: IntArray, start: int, x: float, y: float
) -> int:
    """Return the triangle whose closure contains (x, y), or -1 - t if the walk left the hull from triangle t."""
    t, came_from, side = start, -1, 0
    while True:
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


def locate_points(points: FloatArray, triangles: IntArray, neighbors: IntArray, queries: FloatArray) -> IntArray:
    """Return the triangle of each query (finite), int32, -1 outside the hull. O(k log k) and short walks."""
    found = np.empty(len(queries), dtype=np.int32)
    if len(queries) == 0:
        return found
    k = make_context(np.concatenate([points, queries]))
    order = insertion_order(queries, seed=0)
    start = 0
    for first in range(0, len(order), _CHUNK):
        start = _walk_all(k, points, triangles, neighbors, queries, order[first : first + _CHUNK], start, found)
        raise_if_interrupted()
    return found
