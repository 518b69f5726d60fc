"""How two segments meet, exactly; and all pairs that do, in portions.

Vertices are numbered so that equal positions have equal numbers. Two segments with a common end meet elsewhere only if
they overlap, so the subdivision leaves such pairs out (a wheel has as many as it has spokes, squared), and a sort of
the segments around each vertex finds those with equal directions.
"""

from collections.abc import Iterator
from enum import IntEnum
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exactkernel.context import Context, chunk_size, scaled_into_window
from exactkernel.jit import jit, jit_inline
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.crossings.segment_tree import LEAF, Pool, box_pieces, grown, pool_of, split_top

__all__ = ["Meeting", "MeetingArrays", "meetings"]


class Meeting(IntEnum):
    """How two segments meet in a point that is not an end of both.

    ============  ==================================================================
    ``CROSSING``  in one point, inside both
    ``TOUCH``     in one point, an end of one of them and inside the other
    ``OVERLAP``   in infinitely many points: they lie on one line
    ============  ==================================================================
    """

    CROSSING = 0
    TOUCH = 1
    OVERLAP = 2


_CROSSING, _TOUCH, _OVERLAP, _NONE = 0, 1, 2, -1
_MANY = 1 << 14  # segments that fill a cache
#: A zero bit before each of the eight bits of the index.
_SPREAD = np.array([sum((i >> bit & 1) << 2 * bit for bit in range(8)) for i in range(256)], dtype=np.int64)
_BUDGET = 1 << 21  # pairs tested between two looks at Ctrl-C
_LEAST_ROOM = 1 << 16  # of a portion
_SHARED_LEAF = 4 * LEAF  # in larger leaves the pairs with a common end are not even looked at


class MeetingArrays(NamedTuple):
    """A portion of the meetings: ``first``, ``second`` int32 and ``kind`` int8, all (k,)."""

    first: IntArray
    second: IntArray
    kind: npt.NDArray[np.int8]


@jit_inline
def _turn(k: Context, xy: FloatArray, a: int, b: int, c: int) -> int:
    return orient2d_adaptive(k, xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1], xy[c, 0], xy[c, 1])


@jit_inline
def _before(xy: FloatArray, v: int, w: int) -> bool:
    """Tell whether v comes before w lexicographically."""
    return bool(xy[v, 0] < xy[w, 0] or (xy[v, 0] == xy[w, 0] and xy[v, 1] < xy[w, 1]))


@jit
def is_inside(k: Context, xy: FloatArray, a: int, b: int, v: int) -> bool:
    """Tell whether the vertex v lies inside the segment ab."""
    if v in (a, b):
        return False
    low, high = (a, b) if _before(xy, a, b) else (b, a)
    return _before(xy, low, v) and _before(xy, v, high) and _turn(k, xy, a, b, v) == 0


@jit
def _apart(xy: FloatArray, a: int, b: int, c: int, d: int, axis: int) -> bool:
    """Tell whether one of the segments ends before the other begins, along an axis."""
    p, q, r, s = xy[a, axis], xy[b, axis], xy[c, axis], xy[d, axis]
    return bool(max(p, q) < min(r, s) or max(r, s) < min(p, q))


@jit
def meeting_of(k: Context, xy: FloatArray, a: int, b: int, c: int, d: int) -> int:
    """Return how ab and cd meet, or -1; they have no common end, and either may be a single point."""
    if _apart(xy, a, b, c, d, 0) or _apart(xy, a, b, c, d, 1):
        return _NONE
    if a == b or c == d:
        inside = is_inside(k, xy, c, d, a) if a == b else is_inside(k, xy, a, b, c)
        return _TOUCH if inside else _NONE
    side_c, side_d = _turn(k, xy, a, b, c), _turn(k, xy, a, b, d)
    if side_c == 0 and side_d == 0:
        return _OVERLAP  # on one line, and not apart
    if side_c * side_d > 0:
        return _NONE
    side_a, side_b = _turn(k, xy, c, d, a), _turn(k, xy, c, d, b)
    if side_a * side_b > 0:
        return _NONE
    return _CROSSING if side_a != 0 and side_b != 0 and side_c != 0 and side_d != 0 else _TOUCH


@jit
def _gather_common(pool: Pool, segments: IntArray, begin: int, stop: int) -> int:
    """Move the pieces of segments that end in one popular vertex to the front of a leaf; return how many they are."""
    if stop - begin <= _SHARED_LEAF:
        return 0
    most, popular = 1, -1
    for i in range(8):  # a vertex that most segments of the leaf have is an end of one of a few
        s = pool.segment[begin + i * ((stop - begin) >> 3)]
        for side in range(2):
            v = segments[s, side]
            count = 0
            for p in range(begin, stop):
                t = pool.segment[p]
                count += segments[t, 0] == v or segments[t, 1] == v
            if count > most:
                most, popular = count, v
    front = begin
    for p in range(begin, stop):
        t = pool.segment[p]
        if segments[t, 0] == popular or segments[t, 1] == popular:
            low, high = pool.low[p], pool.high[p]
            pool.segment[p], pool.low[p], pool.high[p] = pool.segment[front], pool.low[front], pool.high[front]
            pool.segment[front], pool.low[front], pool.high[front] = t, low, high
            front += 1
    return int(front - begin)


@jit_inline
def _boxes_meet(box: FloatArray, i: int, j: int) -> bool:
    return bool(box[i, 0] <= box[j, 2] and box[j, 0] <= box[i, 2] and box[i, 1] <= box[j, 3] and box[j, 1] <= box[i, 3])


@jit
def _test_row(
    k: Context,
    xy: FloatArray,
    segments: IntArray,
    pool: Pool,
    i: int,
    first: int,
    stop: int,
    out: MeetingArrays,
    n: int,
) -> int:
    """Test the segment of piece i against those of the pieces first .. stop - 1; return the length of ``out``."""
    begin = pool.start[pool.state[0] - 1]
    s = pool.segment[i]
    a, b = segments[s, 0], segments[s, 1]
    for j in range(first, stop):
        if not _boxes_meet(pool.box, i - begin, j - begin):
            continue
        t = pool.segment[j]
        c, d = segments[t, 0], segments[t, 1]
        if a in (c, d) or b in (c, d):
            continue
        kind = meeting_of(k, xy, a, b, c, d)
        if kind != _NONE:
            out.first[n], out.second[n], out.kind[n] = s, t, kind
            n += 1
    return n


@jit
def _test_leaf(
    k: Context, xy: FloatArray, segments: IntArray, pool: Pool, out: MeetingArrays, n: int, budget: int
) -> tuple[int, int]:
    """Go on with the pairs of the topmost cell; return the length of ``out`` and the budget that is left."""
    cell = pool.state[0] - 1
    begin, stop = pool.start[cell], pool.start[cell + 1]
    if pool.state[1] < 0:
        pool.state[1] = begin
        pool.state[2] = _gather_common(pool, segments, begin, stop)
        box_pieces(pool, begin, stop)
    common = begin + pool.state[2]
    while pool.state[1] < stop and n + stop - begin <= len(out.first) and budget > 0:
        i = pool.state[1]
        first = max(i + 1, common) if i < common else i + 1
        n = _test_row(k, xy, segments, pool, i, first, stop, out, n)
        budget -= stop - first + 1
        pool.state[1] += 1
    if pool.state[1] == stop:
        pool.state[0] -= 1
        pool.state[1] = -1
    return n, budget


@jit
def _advance(
    k: Context, xy: FloatArray, segments: IntArray, pool: Pool, out: MeetingArrays, n: int, budget: int
) -> int:
    """Subdivide and test until the budget is used up or room is missing; return the number of meetings in ``out``, of
    which ``n`` are there already."""
    while pool.state[0] > 0 and budget > 0:
        cell = pool.state[0] - 1
        size = pool.start[cell + 1] - pool.start[cell]
        if n + size > len(out.first) or pool.start[cell + 1] + size > len(pool.segment):
            break
        if pool.state[1] < 0 and split_top(pool):
            budget -= 4 * size
            continue
        n, budget = _test_leaf(k, xy, segments, pool, out, n, budget)
    return n


@jit
def _direction_before(k: Context, xy: FloatArray, v: int, a: int, b: int) -> int:
    """Compare the directions from v to a and to b by angle, from just above minus 90 degrees on: -1, 0 or 1."""
    half_a, half_b = _before(xy, v, a), _before(xy, v, b)
    if half_a != half_b:
        return -1 if half_a else 1
    return -_turn(k, xy, v, a, b)


@jit
def _sort_around(
    k: Context, xy: FloatArray, segments: IntArray, v: int, around: IntArray, scratch: IntArray, n: int
) -> None:
    """Sort the segments at v by direction: a merge sort from below."""
    width = 1
    while width < n:
        for low in range(0, n, 2 * width):
            middle, high = min(low + width, n), min(low + 2 * width, n)
            i, j = low, middle
            for out in range(low, high):
                take_left = j == high
                if i < middle and j < high:
                    a = segments[around[i], 0] + segments[around[i], 1] - v
                    b = segments[around[j], 0] + segments[around[j], 1] - v
                    take_left = _direction_before(k, xy, v, a, b) <= 0
                if take_left:
                    scratch[out] = around[i]
                    i += 1
                else:
                    scratch[out] = around[j]
                    j += 1
        for i in range(n):
            around[i] = scratch[i]
        width *= 2


@jit
def _overlaps_around(
    k: Context,
    xy: FloatArray,
    segments: IntArray,
    v: int,
    around: IntArray,
    n: int,
    out: MeetingArrays,
    place: IntArray,
) -> int:
    """List the pairs of equal direction among the sorted segments at v from ``place`` on; return how many.

    ``place`` holds (i, j), the pair to go on with; its i is n when all are listed.
    """
    found = 0
    while place[0] < n and found < len(out.first):
        i, j = place[0], place[1]
        if j < n:
            s, t = around[i], around[j]
            a, b = segments[s, 0] + segments[s, 1] - v, segments[t, 0] + segments[t, 1] - v
            if _direction_before(k, xy, v, a, b) == 0:
                out.first[found], out.second[found], out.kind[found] = min(s, t), max(s, t), _OVERLAP
                found += 1
                place[1] = j + 1
                continue
        place[0] = i + 1
        place[1] = i + 2
    return found


@jit
def _fans(
    k: Context,
    xy: FloatArray,
    segments: IntArray,
    first: IntArray,
    around: IntArray,
    scratch: IntArray,
    begin: int,
    stop: int,
    repeated: IntArray,
) -> int:
    """Sort the segments around the vertices begin .. stop - 1; list those vertices where two have one direction."""
    found = 0
    for v in range(begin, stop):
        low, high = first[v], first[v + 1]
        if high - low < 2:
            continue
        fan = around[low:high]
        _sort_around(k, xy, segments, v, fan, scratch, high - low)
        for i in range(1, high - low):
            a, b = segments[fan[i - 1], 0] + segments[fan[i - 1], 1] - v, segments[fan[i], 0] + segments[fan[i], 1] - v
            if _direction_before(k, xy, v, a, b) == 0:
                repeated[found] = v
                found += 1
                break
    return found


def _room(n: int) -> MeetingArrays:
    return MeetingArrays(np.empty(n, np.int32), np.empty(n, np.int32), np.empty(n, np.int8))


def _taken(out: MeetingArrays, n: int) -> MeetingArrays:
    return MeetingArrays(out.first[:n].copy(), out.second[:n].copy(), out.kind[:n].copy())


def _with_common_end(k: Context, xy: FloatArray, segments: IntArray) -> Iterator[MeetingArrays]:
    """Yield the overlaps of segments that have an end in common."""
    proper = np.flatnonzero(segments[:, 0] != segments[:, 1])
    ends = segments[proper].T.reshape(-1)
    order = np.argsort(ends)
    around = np.tile(proper, 2)[order].astype(np.int32)
    first = np.searchsorted(ends[order], np.arange(len(xy) + 1)).astype(np.int32)
    scratch, repeated = np.empty_like(around), np.empty(len(xy), dtype=np.int32)
    step = chunk_size(k, 1 << 17)
    for begin in range(0, len(xy), step):
        stop = min(begin + step, len(xy))
        n = _fans(k, xy, segments, first, around, scratch, begin, stop, repeated)
        raise_if_interrupted()
        for v in repeated[:n].tolist():
            fan = around[first[v] : first[v + 1]]
            place, out = np.array([0, 1], dtype=np.int32), _room(_LEAST_ROOM)
            while place[0] < len(fan):
                yield _taken(out, _overlaps_around(k, xy, segments, v, fan, len(fan), out, place))
                raise_if_interrupted()


def _neighbours_first(points: FloatArray, segments: IntArray) -> IntArray:
    """Return an order in which segments that begin near each other are near each other in memory: along a Z curve."""
    if len(segments) < _MANY:
        return np.arange(len(segments), dtype=np.int32)
    begins = 0.5 * points[segments[:, 0]]
    low, high = begins.min(axis=0), begins.max(axis=0)
    cells = ((begins - low) / np.maximum(high - low, 2.0**-1074) * 65535.0).astype(np.int64)
    keys = _SPREAD[cells & 255] | _SPREAD[cells >> 8] << 16
    return np.argsort(keys[:, 0] << 1 | keys[:, 1]).astype(np.int32)


def meetings(points: FloatArray, segments: IntArray) -> Iterator[MeetingArrays]:
    """Yield all pairs of segments that meet in a point which is not an end of both; a pair may come more than once.

    Args:
        points: float64 (n, 2), finite.
        segments: int32 (m, 2): rows of ``points``, equal positions by equal rows; twice the same row is a point.
    """
    xy, k = scaled_into_window(points)
    yield from _with_common_end(k, xy, segments)
    order = _neighbours_first(points, segments)
    segments = segments[order]
    pool, budget = pool_of(points, segments), chunk_size(k, _BUDGET)
    out = _room(max(2 * len(segments), _LEAST_ROOM))
    while pool.state[0] > 0:
        top = int(pool.start[pool.state[0]])
        if top + top - int(pool.start[pool.state[0] - 1]) > len(pool.segment):
            pool = grown(pool)
        n = _advance(k, xy, segments, pool, out, 0, budget)
        raise_if_interrupted()
        if n:
            first, second = order[out.first[:n]], order[out.second[:n]]
            yield MeetingArrays(np.minimum(first, second), np.maximum(first, second), out.kind[:n].copy())
