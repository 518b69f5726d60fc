"""Which vertex of the mesh is at the position of a point of the domain."""

import numpy as np
import numpy.typing as npt

from exactkernel.jit import jit
from exactkernel.types import FloatArray
from exactmesh.verify.witness import IndexArray

__all__ = ["corners_at", "lexicographic_order"]


@jit
def match_in_order(points: FloatArray, used: npt.NDArray[np.bool_], wanted: FloatArray, found: IndexArray) -> None:
    """Match as long as both lists are in the same order, and the one of them has nothing that the other lacks."""
    j = 0
    for i in range(len(wanted)):
        while j < len(points) and not used[j]:
            j += 1
        found[i] = -1
        if j < len(points) and points[j, 0] == wanted[i, 0] and points[j, 1] == wanted[i, 1]:
            found[i] = j
            j += 1


@jit
def match_sorted(
    points: FloatArray,
    used: npt.NDArray[np.bool_],
    wanted: FloatArray,
    order: IndexArray,
    found: IndexArray,
) -> None:
    """Look each used point up among the wanted ones, which ``order`` sorts."""
    for v in range(len(points)):
        if not used[v]:
            continue
        x, y = points[v, 0], points[v, 1]
        low, high = 0, len(order)
        while low < high:
            middle = (low + high) >> 1
            i = order[middle]
            if wanted[i, 0] < x or (wanted[i, 0] == x and wanted[i, 1] < y):
                low = middle + 1
            else:
                high = middle
        while low < len(order) and wanted[order[low], 0] == x and wanted[order[low], 1] == y and found[order[low]] < 0:
            found[order[low]] = v
            low += 1


def lexicographic_order(points: FloatArray) -> IndexArray:
    """Return the order by x, ties by y, ties by index; -0.0 is 0.0."""
    return np.lexsort((points[:, 1], points[:, 0]))


def corners_at(points: FloatArray, used: npt.NDArray[np.bool_], wanted: FloatArray) -> IndexArray:
    """Return for each wanted position a used point that is exactly there, -1 where there is none.

    Linear where the points come in the order of the wanted ones, O(n log n) otherwise.
    """
    found = np.empty(len(wanted), dtype=np.intp)
    match_in_order(points, used, wanted, found)
    missing = np.flatnonzero(found < 0)
    if missing.size:
        rest = wanted[missing]
        late = np.full(len(rest), -1, dtype=np.intp)
        match_sorted(points, used, rest, lexicographic_order(rest), late)
        found[missing] = late
    return found
