"""How far points are from their segments: the exact maximum of all, rationals only for those that may attain it."""

import math

import numpy as np
from gmpy2 import mpq

from exactkernel.constants import UNIT_ROUNDOFF
from exactkernel.context import Context, chunk_size, scaled_into_window
from exactkernel.jit import jit
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray
from exactmesh.crossings.chain_distance import across, beside, distance_squared

__all__ = ["displacement_squared", "worst_displacement"]

_CHUNK = 1 << 16  # points between two looks at Ctrl-C

#: Differences, their squares' sum, its root and a quotient: at most 6u together. The rest is for higher orders.
_DOUBT = 16.0 * UNIT_ROUNDOFF


@jit
def _distance_bounds(k: Context, segments: FloatArray, i: int, x: float, y: float) -> tuple[float, float]:
    """Return bounds of the distance of (x, y) from a segment; both are 0 if and only if it lies on it."""
    ax, ay, bx, by = segments[i, 0], segments[i, 1], segments[i, 2], segments[i, 3]
    low, high = across(k, segments, i, x, y)
    if high == 0.0 and min(ax, bx) <= x <= max(ax, bx) and min(ay, by) <= y <= max(ay, by):
        return 0.0, 0.0
    if k.incircle_bound == math.inf:
        return 0.0, math.inf
    length = math.sqrt((bx - ax) * (bx - ax) + (by - ay) * (by - ay))
    if length > 0.0:
        low = low / length * (1.0 - _DOUBT)
    if length > 0.0 and beside(segments, i, x, y):
        return low, high / length * (1.0 + _DOUBT)
    to_a = math.sqrt((x - ax) * (x - ax) + (y - ay) * (y - ay))
    to_b = math.sqrt((x - bx) * (x - bx) + (y - by) * (y - by))
    return low, min(to_a, to_b) * (1.0 + _DOUBT)


@jit
def _bound_range(
    k: Context, points: FloatArray, segments: FloatArray, first: int, stop: int, best: float, high: FloatArray
) -> float:
    """Write the upper bounds of the distances, and return the largest of ``best`` and the lower ones."""
    for i in range(first, stop):
        low, high[i] = _distance_bounds(k, segments, i, points[i, 0], points[i, 1])
        best = max(best, low)
    return best


def worst_displacement(points: FloatArray, starts: FloatArray, ends: FloatArray) -> tuple[mpq, int]:
    """Return the exact largest squared distance of points from their segments, and the first point that attains it.

    Args:
        points: finite float64 (n, 2).
        starts, ends: finite float64 (n, 2), the ends of the segment of each point; they may be equal.

    Returns:
        (distance squared, row of ``points``); (0, -1) if every point lies on its segment.

    O(n) where the largest few distances differ; rationals for each of those that doubles cannot tell from the largest.

    >>> import numpy as np
    >>> from exactmesh.refinement.displacement import worst_displacement
    >>> points = np.array([(1.0, 1.0), (1.0, 0.5), (3.0, 0.0)])
    >>> worst_displacement(points, np.zeros((3, 2)), np.array([(2.0, 2.0), (2.0, 1.0), (3.0, 1.0)]))
    (mpq(9,10), 2)
    """
    n = len(points)
    scaled, k = scaled_into_window(np.concatenate([points, starts, ends]))
    segments = np.hstack([scaled[n : 2 * n], scaled[2 * n :]])
    high = np.empty(n, dtype=np.float64)
    best = 0.0
    step = chunk_size(k, _CHUNK)
    for first in range(0, n, step):
        best = _bound_range(k, scaled, segments, first, min(first + step, n), best, high)
        raise_if_interrupted()
    largest, worst = mpq(0), -1
    for i in np.flatnonzero((high > 0.0) & (high >= best)).tolist():
        p, a, b = ((mpq(q[i, 0]), mpq(q[i, 1])) for q in (points, starts, ends))
        distance = distance_squared(a, b, p)
        if distance > largest:
            largest, worst = distance, i
    return largest, worst


def displacement_squared(points: FloatArray, starts: FloatArray, ends: FloatArray) -> mpq:
    """Return the exact largest squared distance of points from their segments, see :func:`worst_displacement`.

    >>> import numpy as np
    >>> from exactmesh.refinement.displacement import displacement_squared
    >>> displacement_squared(np.array([(1.0, 0.5)]), np.array([(0.0, 0.0)]), np.array([(2.0, 2.0)]))
    mpq(1,8)
    """
    return worst_displacement(points, starts, ends)[0]
