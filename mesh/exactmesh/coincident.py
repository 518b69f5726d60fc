"""Points in lexicographic order, and those that lie where another one does."""

import numpy as np

from exactkernel.types import FloatArray, IntArray

__all__ = ["first_of_each", "lexicographic_order"]


def lexicographic_order(points: FloatArray) -> IntArray:
    """Return the finite points' indices by x, then y, then index, int32 (n,); -0.0 is 0.0. O(n log n)."""
    x = points[:, 0]
    order = np.argsort(x).astype(np.int32)
    ranked = x[order]
    same = ranked[1:] == ranked[:-1]
    if same.any():  # only what ties in x needs the slower sort by three keys; ties stand side by side
        tied = np.zeros(len(x), dtype=np.bool_)
        tied[1:] |= same
        tied[:-1] |= same
        culprits = order[tied]
        order[tied] = culprits[np.lexsort((culprits, points[culprits, 1], x[culprits]))]
    return order


def first_of_each(points: FloatArray, order: IntArray) -> IntArray:
    """Return for each point the first one at its position, int32 (n,), given their lexicographic order. O(n)."""
    begins = np.ones(len(order), dtype=np.bool_)
    ranked = points[order]
    begins[1:] = (ranked[1:] != ranked[:-1]).any(axis=1)
    if begins.all():
        return np.arange(len(order), dtype=np.int32)
    first = np.empty(len(order), dtype=np.int32)
    first[order] = order[begins][np.cumsum(begins) - 1]
    return first
