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
    """

    order: IntArray
    points: FloatArray
    triangles: IntArray


@jit
def number_corners(triangles: IntArray, number: IntArray, order: IntArray, local: IntArray) -> int:
    """Number the corners as they come; return how many there are."""
    corners = 0
    for t in range(len(triangles)):
        for i in range(3):
            v = triangles[t, i]
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


def localized(points: FloatArray, triangles: IntArray) -> Local:
    """Return the local copy. O(n + m)."""
    order = np.empty(min(len(points), 3 * len(triangles)), dtype=np.int32)
    local = np.empty((len(triangles), 3), dtype=np.int32)
    corners = number_corners(triangles, np.full(len(points), -1, dtype=np.int32), order, local)
    order = order[:corners]
    gathered = np.empty((corners, 2))
    gather(points, order, gathered)
    return Local(order, gathered, local)
