"""From the quad-edge with its ghost to arrays of triangles and neighbors."""

import numpy as np

from exactkernel.jit import jit
from exactkernel.types import IntArray
from exactmesh.edgealgebra import EdgeArray, left_next, origin

__all__ = ["triangles_of"]


@jit
def _collect(ring: EdgeArray, org: EdgeArray, edges: int, ghost: int, vertex: EdgeArray, triangles: IntArray,
             neighbors: IntArray, slot: EdgeArray) -> int:  # fmt: skip
    """Write the triangles and their neighbors; return how many there are.

    ``slot[e >> 1]``, -1 before, becomes 3 t + i for the edge e opposite to corner i of triangle t.
    """
    m = 0
    for e in range(0, 4 * edges, 2):
        if slot[e >> 1] >= 0:
            continue
        f = left_next(ring, e)
        g = left_next(ring, f)
        a, b, c = origin(org, e), origin(org, f), origin(org, g)
        if a == ghost or b == ghost or c == ghost:
            continue
        triangles[m, 0], triangles[m, 1], triangles[m, 2] = vertex[a], vertex[b], vertex[c]
        slot[f >> 1], slot[g >> 1], slot[e >> 1] = 3 * m, 3 * m + 1, 3 * m + 2
        m += 1
    for e in range(0, 2 * edges, 2):
        left, right = slot[e], slot[e + 1]
        if left >= 0:
            neighbors[left // 3, left % 3] = right // 3  # -1 // 3 = -1: outside
        if right >= 0:
            neighbors[right // 3, right % 3] = left // 3
    return m


def triangles_of(
    ring: EdgeArray, org: EdgeArray, edges: int, ghost: int, vertex: EdgeArray
) -> tuple[IntArray, IntArray]:
    """Return (triangles, neighbors), int32 (m, 3) each, of a triangulated sphere without the triangles at the ghost.

    ``vertex[v]`` is the number to be written for the vertex v. O(edges).
    """
    capacity = 2 * edges // 3
    triangles = np.empty((capacity, 3), dtype=np.int32)
    neighbors = np.empty((capacity, 3), dtype=np.int32)
    slot = np.full(2 * edges, -1, dtype=np.int32)
    m = _collect(ring, org, edges, ghost, vertex, triangles, neighbors, slot)
    return triangles[:m].copy(), neighbors[:m].copy()
