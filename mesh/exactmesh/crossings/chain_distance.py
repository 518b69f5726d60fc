"""How far chains are from their segments: the exact maximum, and rationals only for those that may attain it."""

import math
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt
from gmpy2 import mpq

from exactkernel.constants import UNIT_ROUNDOFF
from exactkernel.context import Context, scaled_into_window
from exactkernel.crossing import dd_cross
from exactkernel.expansions import two_diff
from exactkernel.jit import jit
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import RationalPoint, raise_if_interrupted
from exactkernel.types import FloatArray
from exactmesh.crossings.chains import Chains, LongArray

__all__ = ["across", "beside", "distance_squared", "is_anything_moved", "largest_distances_squared"]

_CHUNK = 1 << 16  # segments between two looks at Ctrl-C


@jit
def across(k: Context, ends: FloatArray, s: int, x: float, y: float) -> tuple[float, float]:
    """Return bounds of |(b - a) x (p - a)|, which is the distance of p from the line times the length of ab."""
    ax, ay, bx, by = ends[s, 0], ends[s, 1], ends[s, 2], ends[s, 3]
    if (x == ax and y == ay) or (x == bx and y == by) or orient2d_adaptive(k, ax, ay, bx, by, x, y) == 0:
        return 0.0, 0.0
    if k.incircle_bound == math.inf:
        return 0.0, math.inf
    ux, ux_tail = two_diff(bx, ax)
    uy, uy_tail = two_diff(by, ay)
    px, px_tail = two_diff(x, ax)
    py, py_tail = two_diff(y, ay)
    cross, tail, error = dd_cross(ux, ux_tail, py, py_tail, uy, uy_tail, px, px_tail)
    doubt = 2.0 * (error + abs(tail)) + 4.0 * UNIT_ROUNDOFF * abs(cross)
    return max(abs(cross) - doubt, 0.0), abs(cross) + doubt


@jit
def beside(ends: FloatArray, s: int, x: float, y: float) -> bool:
    """Tell whether p surely lies between the perpendiculars in both ends; False when in doubt."""
    ax, ay, bx, by = ends[s, 0], ends[s, 1], ends[s, 2], ends[s, 3]
    ux, uy = bx - ax, by - ay
    p, q, r, t = ux * (x - ax), uy * (y - ay), ux * (bx - x), uy * (by - y)
    doubt = 16.0 * UNIT_ROUNDOFF
    return bool(p + q > doubt * (abs(p) + abs(q)) and r + t > doubt * (abs(r) + abs(t)))


@jit
def _candidates(
    k: Context,
    points: FloatArray,
    ends: FloatArray,
    start: LongArray,
    vertices: npt.NDArray[np.int32],
    first: int,
    stop: int,
    out: LongArray,
) -> int:
    """List the places in ``vertices`` that may be farthest from their segment; return how many."""
    n = 0
    for s in range(first, stop):
        best = 0.0
        for i in range(start[s], start[s + 1]):
            x, y = points[vertices[i], 0], points[vertices[i], 1]
            low, high = across(k, ends, s, x, y)
            if low > best and beside(ends, s, x, y):
                best = low
        for i in range(start[s], start[s + 1]):
            x, y = points[vertices[i], 0], points[vertices[i], 1]
            at_end = (x == ends[s, 0] and y == ends[s, 1]) or (x == ends[s, 2] and y == ends[s, 3])
            if at_end:
                continue
            low, high = across(k, ends, s, x, y)
            if (high > 0.0 and high >= best) or not beside(ends, s, x, y):
                out[n] = i
                n += 1
    return n


@jit
def _first_moved(
    k: Context,
    points: FloatArray,
    ends: FloatArray,
    start: LongArray,
    vertices: npt.NDArray[np.int32],
    first: int,
    stop: int,
) -> int:
    """Return the first segment with a vertex off its line, or stop."""
    for s in range(first, stop):
        for i in range(start[s], start[s + 1]):
            v = vertices[i]
            if across(k, ends, s, points[v, 0], points[v, 1])[1] > 0.0:
                return s
    return stop


def _scaled(points: FloatArray, begins: FloatArray, ends: FloatArray) -> tuple[FloatArray, FloatArray, Context]:
    """Return (points, segments (s, 4), context), scaled alike."""
    scaled, k = scaled_into_window(np.concatenate([points, begins, ends]))
    n, s = len(points), len(begins)
    return scaled[:n], np.hstack([scaled[n : n + s], scaled[n + s :]]), k


def _altered(points: FloatArray, begins: FloatArray, ends: FloatArray, chains: Chains) -> tuple[LongArray, Chains]:
    """Return the segments whose chains are not just their two ends, unmoved; and those chains."""
    lengths = np.diff(chains.start)
    first, last = points[chains.vertices[chains.start[:-1]]], points[chains.vertices[chains.start[1:] - 1]]
    is_altered = (lengths != 2) | (first != begins).any(axis=1) | (last != ends).any(axis=1)
    start = np.append(0, np.cumsum(lengths[is_altered]))
    return np.flatnonzero(is_altered), Chains(start, chains.vertices[np.repeat(is_altered, lengths)])


def is_anything_moved(points: FloatArray, begins: FloatArray, ends: FloatArray, chains: Chains) -> bool:
    """Tell whether some vertex of a chain is not on its segment's line."""
    rows, chains = _altered(points, begins, ends, chains)
    xy, segments, k = _scaled(points, begins[rows], ends[rows])
    for first in range(0, len(rows), _CHUNK):
        stop = min(first + _CHUNK, len(rows))
        moved = _first_moved(k, xy, segments, chains.start, chains.vertices, first, stop)
        raise_if_interrupted()
        if moved < stop:
            return True
    return False


def distance_squared(a: RationalPoint, b: RationalPoint, p: RationalPoint) -> mpq:
    """Return the exact squared distance of p from the segment ab."""
    ux, uy, px, py = b[0] - a[0], b[1] - a[1], p[0] - a[0], p[1] - a[1]
    along, length_squared = ux * px + uy * py, ux * ux + uy * uy
    if along <= 0:
        return px * px + py * py
    if along >= length_squared:
        return (p[0] - b[0]) * (p[0] - b[0]) + (p[1] - b[1]) * (p[1] - b[1])
    cross = ux * py - uy * px
    return cross * cross / length_squared


def _all_candidates(
    points: FloatArray, begins: FloatArray, ends: FloatArray, chains: Chains
) -> Iterator[npt.NDArray[np.int64]]:
    xy, segments, k = _scaled(points, begins, ends)
    for first in range(0, len(begins), _CHUNK):
        stop = min(first + _CHUNK, len(begins))
        out = np.empty(chains.start[stop] - chains.start[first], dtype=np.int64)
        n = _candidates(k, xy, segments, chains.start, chains.vertices, first, stop, out)
        raise_if_interrupted()
        yield out[:n]


def largest_distances_squared(
    points: FloatArray, begins: FloatArray, ends: FloatArray, chains: Chains
) -> tuple[mpq, ...]:
    """Return for each segment the exact largest squared distance between a vertex of its chain and the segment.

    That is the Hausdorff distance from the chain to the segment: the distance to a convex set is convex. What is as it
    was costs next to nothing.
    """
    largest = [mpq(0)] * len(begins)
    rows, chains = _altered(points, begins, ends, chains)
    for places in _all_candidates(points, begins[rows], ends[rows], chains):
        owners = rows[np.searchsorted(chains.start, places, side="right") - 1]
        for s, i in zip(owners.tolist(), places.tolist(), strict=True):
            a, b, p = (
                (mpq(q[0]), mpq(q[1]))
                for q in (begins[s].tolist(), ends[s].tolist(), points[chains.vertices[i]].tolist())
            )
            largest[s] = max(largest[s], distance_squared(a, b, p))
    return tuple(largest)
