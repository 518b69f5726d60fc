"""Areas of cells: in doubles for all, in rationals for one."""

import math
from collections.abc import Sequence

import numpy as np
from gmpy2 import mpq

from exactkernel.jit import jit
from exactkernel.rational import RationalPoint
from exactkernel.types import FloatArray, IntArray
from exactmesh.ordering import IndexArray

__all__ = ["area_of_polygon", "areas_of_cells"]


@jit
def _areas(points: FloatArray, vertices: FloatArray, offsets: IndexArray, cells: IntArray, areas: FloatArray) -> None:
    for i in range(len(areas)):
        x, y = points[i, 0], points[i, 1]
        twice = 0.0
        bounded = offsets[i] < offsets[i + 1]
        for j in range(offsets[i], offsets[i + 1]):
            v = cells[j]
            w = cells[j + 1 if j + 1 < offsets[i + 1] else offsets[i]]
            if v < 0:
                bounded = False
            elif w >= 0:  # all these triangles are counterclockwise: nothing cancels
                twice += (vertices[v, 0] - x) * (vertices[w, 1] - y) - (vertices[v, 1] - y) * (vertices[w, 0] - x)
        areas[i] = 0.5 * twice if bounded else math.inf


@np.errstate(over="ignore", invalid="ignore")  # interpreted, a numpy scalar warns where a double does not
def areas_of_cells(points: FloatArray, vertices: FloatArray, offsets: IndexArray, cells: IntArray) -> FloatArray:
    """Return the area of each cell, float64 (n,); infinite for those with an entry -1 or
    without any, and NaN where vertices beyond the doubles leave no answer."""
    areas = np.empty(len(points))
    _areas(points, vertices, offsets, cells, areas)
    return areas


def area_of_polygon(corners: Sequence[RationalPoint]) -> mpq:
    """Return the exact area of a simple polygon, counterclockwise."""
    twice = mpq(0)
    for i, (x, y) in enumerate(corners):
        before = corners[i - 1]
        twice += before[0] * y - before[1] * x
    return twice / 2
