"""A triangulation of a domain, completed to one of its convex hull: so that points can be located by walking."""

import numpy as np

from exactkernel.types import FloatArray, IntArray
from exactmesh.constrain import constrained_delaunay
from exactmesh.errors import TopologyError
from exactmesh.ordering import IndexArray
from exactmesh.pslg import PSLG
from exactmesh.regions import flood

__all__ = ["completed"]


def _sides(triangles: IntArray, size: int) -> IndexArray:
    """Return a key for each directed side, opposite to corner i in entry 3 t + i."""
    starts, ends = np.roll(triangles, -1, axis=1).reshape(-1), np.roll(triangles, -2, axis=1).reshape(-1)
    keys: IndexArray = starts.astype(np.int64) * size + ends
    return keys


def completed(points: FloatArray, triangles: IntArray, neighbors: IntArray) -> tuple[IntArray, IntArray]:
    """Return triangles and neighbors that cover the convex hull: first those given, then those of holes and bays.

    The triangles fill the space between the boundary's edges as constrained Delaunay triangles, so all their corners
    are on the boundary. O(m + b log b) for b edges on the boundary.

    Raises:
        TopologyError: an edge of the boundary passes through a vertex of it.
    """
    open_ = np.flatnonzero(neighbors.reshape(-1) < 0)
    m, size = len(triangles), len(points)
    starts, ends = np.divmod(_sides(triangles, size)[open_], size)
    used = np.unique(starts)
    outline = np.searchsorted(used, np.stack([starts, ends], axis=1))
    filled = constrained_delaunay(PSLG(points[used], outline), carve=False)
    corners, beyond = used[filled.triangles].astype(np.int32), filled.neighbors.copy()
    keys = _sides(corners, size)
    order = np.argsort(keys)

    def find(wanted: IndexArray) -> IndexArray:
        place = np.minimum(np.searchsorted(keys[order], wanted), len(keys) - 1)
        found: IndexArray = np.where(keys[order[place]] == wanted, order[place], -1)
        return found

    inner, outer = find(starts * size + ends), find(ends * size + starts)
    if (inner < 0).any():
        s, e = starts[inner < 0][0], ends[inner < 0][0]
        raise TopologyError(f"the edge {s} -> {e} of the boundary passes through a vertex", indices=[s, e])
    glued = outer >= 0
    fixed, label = np.zeros_like(beyond, dtype=np.bool_), np.zeros(len(corners), dtype=np.int32)
    fixed.reshape(-1)[inner] = fixed.reshape(-1)[outer[glued]] = True
    stack, first = np.empty(len(corners), dtype=np.int32), np.unique(outer[glued] // 3)
    stack[: len(first)] = first
    flood(beyond, fixed, label, 1, stack, len(first))
    number = np.full(len(corners) + 1, -1, dtype=np.int32)
    number[:-1][label == 1] = m + np.arange(label.sum(), dtype=np.int32)
    beyond = number[beyond]
    beyond.reshape(-1)[outer[glued]] = open_[glued] // 3
    around = neighbors.copy()
    around.reshape(-1)[open_[glued]] = number[outer[glued] // 3]
    return np.concatenate([triangles, corners[label == 1]]), np.concatenate([around, beyond[label == 1]])
