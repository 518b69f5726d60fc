"""A copy of the mesh that is numbered as the list of triangles comes upon its corners.

Lists of triangles go over the plane in small steps, most of the time, where the numbers of points jump. With local
numbers, what is near in the plane is near in memory: the passes over edges and triangles take a third of the time.
"""

from typing import NamedTuple

import numpy as np

from exactkernel.jit import jit
from exactkernel.types import FloatArray, IntArray

__all__ = ["Local", "localized"]


class Local(NamedTuple):
    """The corners, renumbered.

    Attributes:
        order: int32 (k,): the point that each corner is.
        points: float64 (k, 2): the corners.
        triangles: int32 (m, 3): the triangles, in local numbers.
        quads: int32 (k, 4): the quadrilaterals.
    """

    order: IntArray
    points: FloatArray
    triangles: IntArray
    quads: IntArray


@jit
def number_corners(cells: IntArray, number: IntArray, order: IntArray, local: IntArray, corners: int) -> int:
    """Number the corners as they come, from ``corners`` on; return how many there are."""
    for t in range(len(cells)):
        for i in range(cells.shape[1]):
            v = cells[t, i]
            if number[v] < 0:
                number[v] = corners
                order[corners] = v
                corners += 1
            local[t, i] = number[v]
    return corners


@jit
def gather(points: FloatArray, order: IntArray, gathered: FloatArray) -> None:
    """Copy some points."""
    for i in range(len(order)):
        gathered[i, 0] = points[order[i], 0]
        gathered[i, 1] = points[order[i], 1]


def localized(points: FloatArray, triangles: IntArray, quads: IntArray) -> Local:
    """Return the local copy. O(n + m)."""
    order = np.empty(min(len(points), triangles.size + quads.size), dtype=np.int32)
    local, local_quads = np.empty(triangles.shape, dtype=np.int32), np.empty(quads.shape, dtype=np.int32)
    number, corners = np.full(len(points), -1, dtype=np.int32), 0
    for cells, numbered in ((triangles, local), (quads, local_quads)):
        corners = number_corners(cells, number, order, numbered, corners)
    order = order[:corners]
    gathered = np.empty((corners, 2))
    gather(points, order, gathered)
    return Local(order, gathered, local, local_quads)
