"""From edge rings to arrays of triangles and neighbors."""

import numpy as np

from exactkernel.jit import jit
from exactkernel.types import IntArray
from exactmesh.edgealgebra import EdgeArray, dest, left_next, origin

__all__ = ["OUTER", "triangles_of"]

#: Slot of an edge whose left face is no triangle of the result.
OUTER = -2


@jit
def _collect(
    ring: EdgeArray,
    org: EdgeArray,
    slot: EdgeArray,
    number: IntArray,
    triangles: IntArray,
    neighbors: IntArray,
) -> int:
    """Write the triangles and their neighbors, flat; return how many there are.

    ``slot[e >> 1]`` becomes 4 t + i for the edge e opposite to corner i of triangle t.
    """
    ghost = len(number)
    m = 0
    for half in range(len(slot)):
        if slot[half] != -1:
            continue
        e = 2 * half
        f = left_next(ring, e)
        g = left_next(ring, f)
        a, b, c = origin(org, e), dest(org, e), dest(org, f)  # e's two ends lie side by side in memory
        if a == ghost or b == ghost or c == ghost:
            continue
        triangles[3 * m], triangles[3 * m + 1], triangles[3 * m + 2] = number[a], number[b], number[c]
        slot[f >> 1], slot[g >> 1], slot[e >> 1] = 4 * m, 4 * m + 1, 4 * m + 2
        m += 1
    for half in range(0, len(slot), 2):
        left, right = slot[half], slot[half + 1]
        if left >= 0:
            neighbors[3 * (left >> 2) + (left & 3)] = right >> 2  # -1 >> 2 = OUTER >> 2 = -1
        if right >= 0:
            neighbors[3 * (right >> 2) + (right & 3)] = left >> 2
    return m


def triangles_of(ring: EdgeArray, org: EdgeArray, slot: EdgeArray, number: IntArray) -> tuple[IntArray, IntArray]:
    """Return (triangles, neighbors), int32 (m, 3) each, of the faces, which are triangles. O(edges).

    ``slot`` is scratch, one entry for each directed edge: -1, or OUTER if its left face does not belong to the result.
    ``number[v]`` is what to write for the vertex v; faces at the ghost vertex, ``len(number)``, do not belong either.
    """
    triangles = np.empty(len(slot), dtype=np.int32)
    neighbors = np.empty(len(slot), dtype=np.int32)
    m = _collect(ring, org, slot, number, triangles, neighbors)
    triangles.resize((m, 3), refcheck=False)  # the room of the other faces goes back, and no base is left to write to
    neighbors.resize((m, 3), refcheck=False)
    return triangles, neighbors
