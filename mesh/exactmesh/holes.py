"""A point in each hole of a domain, whatever made it one: what a ``.poly`` file needs to say the same."""

import numpy as np

from exactkernel.batch import orient2d_batch
from exactkernel.types import FloatArray, IntArray
from exactmesh.plane import BoolArray
from exactmesh.regions import flood, flood_from

__all__ = ["seeds_of_holes"]

_INSIDE, _OUTSIDE, _EXTERIOR, _FIRST = 0, 1, 2, 3


def seeds_of_holes(
    points: FloatArray, triangles: IntArray, neighbors: IntArray, kept: BoolArray, given: FloatArray, found: IntArray
) -> FloatArray:
    """Return a point strictly inside each part of the hull that the kept triangles enclose, float64 (h, 2).

    Those of the given points that lie in such a part come first, one for each, as they are; ``found`` are their
    triangles. For a part so slim that no double is found inside of one of its triangles the row is NaN. O(m log m).
    """
    label = np.where(kept, _INSIDE, _OUTSIDE).astype(np.int32)
    free, stack = np.zeros_like(triangles, dtype=np.bool_), np.empty(len(triangles), dtype=np.int32)
    rim = np.flatnonzero(~kept & (neighbors < 0).any(axis=1)).astype(np.int32)
    stack[: len(rim)] = rim
    flood(neighbors, free, label, _EXTERIOR, stack, len(rim))
    corners = points[triangles]
    with np.errstate(over="ignore", invalid="ignore"):
        centres = (corners / 3.0).sum(axis=1)
        (ux, uy), (vx, vy) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
        heuristic_size = ux * vy - uy * vx
    rest = np.flatnonzero(label == _OUTSIDE).astype(np.int32)
    flood_from(neighbors, free, label, np.concatenate([found, rest]), _OUTSIDE, _FIRST, 1, stack)
    part = label[rest]
    inside = np.ones(len(rest), dtype=np.bool_)
    for i in range(3):
        a, b = corners[rest, i], corners[rest, (i + 1) % 3]
        inside &= orient2d_batch(a, b, centres[rest]) > 0
    order = np.lexsort((-heuristic_size[rest], ~inside, part))
    first = order[np.diff(part[order], prepend=-1) != 0]
    seeds = np.where(inside[first, None], centres[rest[first]], np.nan)
    own = part[first] - _FIRST < len(given)  # the label says which of the given points flooded the part
    seeds[own] = given[part[first][own] - _FIRST]
    return seeds
