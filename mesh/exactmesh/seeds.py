"""Where seeds of holes and regions lie: on a segment, or inside the convex hull; exactly."""

import numpy as np

from exactkernel.context import Context, chunk_size, scaled_into_window
from exactkernel.jit import jit
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray

__all__ = ["inside_hull", "segment_under"]

_SEGMENTS_AT_ONCE = 1 << 20
_PAIRS_AT_ONCE = 1 << 24


@jit
def _orientation(k: Context, points: FloatArray, a: int, b: int, c: int) -> int:
    return orient2d_adaptive(k, points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1])


@jit
def _mark_segments_under(
    k: Context, points: FloatArray, segments: IntArray, seeds: IntArray, start: int, stop: int, under: IntArray
) -> None:
    """For segments start .. stop - 1: ``under[i]`` becomes a segment through seed i, if it is -1 and there is one.

    ``seeds`` are rows of ``points``, by ascending x.
    """
    for s in range(start, stop):
        a, b = segments[s, 0], segments[s, 1]
        left, right = min(points[a, 0], points[b, 0]), max(points[a, 0], points[b, 0])
        low, high = min(points[a, 1], points[b, 1]), max(points[a, 1], points[b, 1])
        first, last = 0, len(seeds)
        while first < last:  # to the first seed that is not to the left
            middle = (first + last) >> 1
            if points[seeds[middle], 0] < left:
                first = middle + 1
            else:
                last = middle
        for i in range(first, len(seeds)):
            v = seeds[i]
            if points[v, 0] > right:
                break
            if under[i] < 0 and low <= points[v, 1] <= high and _orientation(k, points, a, b, v) == 0:
                under[i] = s


def segment_under(points: FloatArray, segments: IntArray, seeds: FloatArray) -> IntArray:
    """Return for each seed the first segment that it lies on, ends included, int32; -1 if it lies on none.

    Every comparison is exact. O(s log h) for s short segments and h seeds, O(s h) at worst.
    """
    order = np.argsort(seeds[:, 0])
    coordinates, k = scaled_into_window(np.concatenate([points, seeds]))
    rows = (order + len(points)).astype(np.int32)
    under = np.full(len(seeds), -1, dtype=np.int32)
    step = max(1, chunk_size(k, min(_SEGMENTS_AT_ONCE, _PAIRS_AT_ONCE // max(1, len(seeds)))))
    for start in range(0, len(segments), step):
        _mark_segments_under(k, coordinates, segments, rows, start, min(start + step, len(segments)), under)
        raise_if_interrupted()
    found = np.empty_like(under)
    found[order] = under
    return found


@jit
def _chain(k: Context, points: FloatArray, order: IntArray, turn: int, chain: IntArray, size: int, i: int) -> int:
    """Extend a strictly convex chain of ``size`` points by point ``order[i]``; return its size.

    ``turn`` is 1 for the lower chain of the hull, -1 for the upper one.
    """
    v = order[i]
    while size >= 2 and turn * _orientation(k, points, chain[size - 2], chain[size - 1], v) <= 0:
        size -= 1
    chain[size] = v
    return size + 1


@jit
def _chains(
    k: Context,
    points: FloatArray,
    order: IntArray,
    start: int,
    stop: int,
    chains: IntArray,
    sizes: IntArray,
) -> None:
    """Extend the lower chain, ``chains[0]``, and the upper one by the points order[start .. stop - 1]."""
    for i in range(start, stop):
        for side in range(2):
            sizes[side] = _chain(k, points, order, 1 - 2 * side, chains[side], sizes[side], i)


@jit
def _is_left(points: FloatArray, v: int, w: int) -> bool:
    """Tell whether v comes before w lexicographically."""
    if points[v, 0] != points[w, 0]:
        return bool(points[v, 0] < points[w, 0])
    return bool(points[v, 1] < points[w, 1])


@jit
def _side_of_chain(k: Context, points: FloatArray, chain: IntArray, size: int, v: int) -> int:
    """Return the orientation of v against the edge of the chain below or above it."""
    low, high = 0, size - 1
    while high - low > 1:
        middle = (low + high) >> 1
        if _is_left(points, v, chain[middle]):
            high = middle
        else:
            low = middle
    return _orientation(k, points, chain[low], chain[high], v)


@jit
def _mark_inside(
    k: Context, points: FloatArray, first_seed: int, chains: IntArray, sizes: IntArray, inside: IntArray
) -> None:
    lower, upper = chains[0], chains[1]
    start, end = lower[0], lower[sizes[0] - 1]
    for i in range(len(inside)):
        v = first_seed + i
        if _is_left(points, start, v) and _is_left(points, v, end):
            above = _side_of_chain(k, points, lower, sizes[0], v) > 0
            inside[i] = above and _side_of_chain(k, points, upper, sizes[1], v) < 0


def inside_hull(points: FloatArray, order: IntArray, seeds: FloatArray) -> IntArray:
    """Tell for each seed, by 1 or 0, whether it lies strictly inside the convex hull of the points.

    ``order`` is the points' lexicographic order. Exact; Andrew's chains, then O(log n) a seed: O(n + h log n).
    Reference: [Andrew 1979]
    """
    inside = np.zeros(len(seeds), dtype=np.int32)
    if len(points) < 3:
        return inside
    coordinates, k = scaled_into_window(np.concatenate([points, seeds]))
    chains, sizes = np.empty((2, len(points)), dtype=np.int32), np.zeros(2, dtype=np.int32)
    step = chunk_size(k, _SEGMENTS_AT_ONCE)
    for start in range(0, len(order), step):
        _chains(k, coordinates, order, start, min(start + step, len(order)), chains, sizes)
        raise_if_interrupted()
    _mark_inside(k, coordinates, len(points), chains, sizes, inside)
    raise_if_interrupted()
    return inside
