"""A hierarchical subdivision that hands each cell the pieces of segments in it: which pairs of segments may meet?

A cell is cut by a line, and each piece of a segment goes to the side or the sides on which it lies, clipped to them.
The line's direction is one of the axes or runs along the pieces, whichever of a sample promises the fewest pairs: a
bundle of long slanted segments, which boxes cannot tell apart, falls apart like a stack. A cell that no cut makes
cheaper is a leaf, and all pairs in it are tested: where many segments cross, that costs about as much as what is found.

Clipping is done in doubles and errs on the side of keeping: a piece is an interval of parameters that surely contains
all points of the segment in the cell. So every meeting survives to some leaf, and exactness is left to the test there.
"""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exactkernel.constants import UNIT_ROUNDOFF
from exactkernel.jit import jit
from exactkernel.types import FloatArray, IntArray

__all__ = ["LEAF", "Pool", "box_pieces", "grown", "pool_of", "split_top"]

#: Cells of so few pieces are not worth a cut.
LEAF = 12
_SAMPLE = 24  # pieces that a cut is chosen from
_GAIN = 0.85  # a cut should leave at most this part of the pairs
_MISSES = 1  # so many cuts in a row may fail to
_WORST = 2.0  # all cuts above a cell may leave this multiple of the pairs: never worse than twice all pairs
_DEPTH = 4096  # of the stack of cells; below, a cell is a leaf

#: The value of a (x - ox) + b (y - oy), computed, is off by at most 3 u times the sum of the absolute products, and
#: interpolated between two ends by at most 4 u more; 16 u times the sum for both ends leaves half to spare. The origin
#: is a point of the cell: so what a cut cannot tell apart is small beside the cell, and not beside the coordinates.
#: Scaled coordinates that underflowed are off by 2^-1074 each.
_ERROR = 16.0 * UNIT_ROUNDOFF
#: A point between two ends, computed, is off by at most 3 u times the sum of their magnitudes.
_BOX_ERROR = 4.0 * UNIT_ROUNDOFF
_UNDERFLOW = 2.0**-1060


class Pool(NamedTuple):
    """Cells on a stack, each a run of pieces; the topmost cell is the last run.

    Attributes:
        ends: float64 (m, 4): ax, ay, bx, by of every segment, scaled to magnitudes up to 1.
        segment: int32 (p,): of each piece.
        low, high: float64 (p,): its interval of parameters, 0 at a, 1 at b.
        start: int64: where each cell's run begins; cell c is start[c] .. start[c + 1] - 1.
        misses: int64: how many of the cuts above each cell in a row have not paid.
        remaining: float64: the product of the parts of the pairs that the cuts above each cell left.
        state: int64 (3,): number of cells; in the topmost cell: the next row of its pairs, or -1 where it was not
            looked at; and the length of its part with a common end.
        sample: float64 (_SAMPLE,): scratch.
        origin: float64 (2,): where the cut of the topmost cell is measured from.
        box: float64 (m, 4): of each piece of a leaf, smallest x and y, largest x and y, rounded outwards.
    """

    ends: FloatArray
    segment: IntArray
    low: FloatArray
    high: FloatArray
    start: npt.NDArray[np.int64]
    misses: npt.NDArray[np.int64]
    remaining: FloatArray
    state: npt.NDArray[np.int64]
    sample: FloatArray
    origin: FloatArray
    box: FloatArray


def pool_of(points: FloatArray, segments: IntArray) -> Pool:
    """Return the pool with one cell that holds all segments."""
    m = len(segments)
    scaled = points
    if points.size:
        scaled = np.ldexp(points, -math.frexp(float(np.abs(points).max()))[1])
    size = 3 * m + 64
    segment = np.zeros(size, dtype=np.int32)
    segment[:m] = np.arange(m, dtype=np.int32)
    start = np.zeros(_DEPTH + 2, dtype=np.int64)
    start[1] = m
    return Pool(
        ends=scaled[segments].reshape(-1, 4),
        segment=segment,
        low=np.zeros(size),
        high=np.ones(size),
        start=start,
        misses=np.zeros(_DEPTH + 1, dtype=np.int64),
        remaining=np.ones(_DEPTH + 1),
        state=np.array([1 if m else 0, -1, 0], dtype=np.int64),
        sample=np.empty(_SAMPLE),
        origin=np.zeros(2),
        box=np.empty((m, 4)),
    )


def grown(pool: Pool) -> Pool:
    """Return the pool with room for twice as many pieces."""
    double = {name: np.resize(getattr(pool, name), 2 * len(pool.segment)) for name in ("segment", "low", "high")}
    return pool._replace(**double)


@jit
def _projected(pool: Pool, piece: int, a: float, b: float) -> tuple[float, float, float]:
    """Return a (x - ox) + b (y - oy) at both ends of a piece's segment, and how far values along it may be off."""
    s = pool.segment[piece]
    ax, ay = a * (pool.ends[s, 0] - pool.origin[0]), b * (pool.ends[s, 1] - pool.origin[1])
    bx, by = a * (pool.ends[s, 2] - pool.origin[0]), b * (pool.ends[s, 3] - pool.origin[1])
    return ax + ay, bx + by, _ERROR * (abs(ax) + abs(ay) + abs(bx) + abs(by)) + _UNDERFLOW


@jit
def _set_origin(pool: Pool, piece: int) -> None:
    """Put the origin into the middle of a piece, or near it."""
    s, t = pool.segment[piece], 0.5 * (pool.low[piece] + pool.high[piece])
    for axis in range(2):
        a, b = pool.ends[s, axis], pool.ends[s, axis + 2]
        pool.origin[axis] = a + t * (b - a)


@jit
def _common_direction(pool: Pool, begin: int, step: int, count: int) -> tuple[float, float]:
    """Return the mean direction of a sample of pieces by their lengths; opposite directions are the same."""
    cosine = sine = 0.0
    for i in range(count):
        p = begin + i * step
        s = pool.segment[p]
        part = pool.high[p] - pool.low[p]
        x = part * (pool.ends[s, 2] - pool.ends[s, 0])
        y = part * (pool.ends[s, 3] - pool.ends[s, 1])
        length = math.hypot(x, y)
        if length > 0.0:
            cosine += (x / length) * x - (y / length) * y
            sine += 2.0 * (x / length) * y
    angle = 0.5 * math.atan2(sine, cosine)
    return math.cos(angle), math.sin(angle)


@jit
def _middle(values: FloatArray, count: int) -> float:
    """Return the median of a few values, which are sorted by insertion."""
    for i in range(1, count):
        value = values[i]
        j = i
        while j > 0 and values[j - 1] > value:
            values[j] = values[j - 1]
            j -= 1
        values[j] = value
    return float(0.5 * (values[(count - 1) >> 1] + values[count >> 1]))


@jit
def _try_cut(pool: Pool, begin: int, step: int, count: int, a: float, b: float) -> tuple[float, float]:
    """Return (c, cost): the cut a x + b y = c through the middle of a sample, and the part of its pairs that
    remains."""
    middles = pool.sample
    for i in range(count):
        p = begin + i * step
        f, g, _ = _projected(pool, p, a, b)
        middles[i] = f + 0.5 * (pool.low[p] + pool.high[p]) * (g - f)
    c = _middle(middles, count)
    below = above = 0
    for i in range(count):
        p = begin + i * step
        f, g, _ = _projected(pool, p, a, b)
        first, last = f + pool.low[p] * (g - f), f + pool.high[p] * (g - f)
        below += min(first, last) <= c
        above += max(first, last) >= c
    return c, (below * below + above * above) / (count * count)


@jit
def _best_cut(pool: Pool, begin: int, stop: int) -> tuple[float, float, float, float]:
    """Return (a, b, c, cost) of the best cut of the pieces begin .. stop - 1, judged by a sample."""
    step = max((stop - begin) // _SAMPLE, 1)
    count = min(stop - begin, _SAMPLE)
    best_a, best_b = 1.0, 0.0
    best_c, best = _try_cut(pool, begin, step, count, 1.0, 0.0)
    c, cost = _try_cut(pool, begin, step, count, 0.0, 1.0)
    if cost < best:
        best_a, best_b, best_c, best = 0.0, 1.0, c, cost
    if best > 0.55:  # an even split without a piece on both sides leaves 0.5
        x, y = _common_direction(pool, begin, step, count)
        c, cost = _try_cut(pool, begin, step, count, -y, x)
        if cost < best:
            best_a, best_b, best_c, best = -y, x, c, cost
    return best_a, best_b, best_c, best


@jit
def _sides(pool: Pool, p: int, a: float, b: float, c: float) -> tuple[float, float, float, float]:
    """Return the parameters of the piece below the cut and above it; an empty interval is reversed."""
    low, high = pool.low[p], pool.high[p]
    f, g, error = _projected(pool, p, a, b)
    first, last = f + low * (g - f), f + high * (g - f)
    below_low, below_high, above_low, above_high = low, high, low, high
    if min(first, last) > c + error:
        below_low, below_high = 1.0, 0.0
    elif max(first, last) < c - error:
        above_low, above_high = 1.0, 0.0
    elif abs(g - f) > 4.0 * error:
        t = (c - f) / (g - f)
        slack = 4.0 * error / (abs(g - f) - 2.0 * error) + 8.0 * UNIT_ROUNDOFF
        if g > f:
            below_high, above_low = min(high, t + slack), max(low, t - slack)
        else:
            above_high, below_low = min(high, t + slack), max(low, t - slack)
    return below_low, below_high, above_low, above_high


@jit
def _cut(pool: Pool, begin: int, stop: int, a: float, b: float, c: float) -> tuple[int, int]:
    """Replace the run by the pieces above the cut; put those below behind it. Return both new ends."""
    top, kept = stop, begin
    for p in range(begin, stop):
        below_low, below_high, above_low, above_high = _sides(pool, p, a, b, c)
        s = pool.segment[p]
        if below_low <= below_high:
            pool.segment[top], pool.low[top], pool.high[top] = s, below_low, below_high
            top += 1
        if above_low <= above_high:
            pool.segment[kept], pool.low[kept], pool.high[kept] = s, above_low, above_high
            kept += 1
    for p in range(stop, top):
        q = kept + p - stop
        pool.segment[q], pool.low[q], pool.high[q] = pool.segment[p], pool.low[p], pool.high[p]
    return kept, kept + top - stop


@jit
def split_top(pool: Pool) -> bool:
    """Cut the topmost cell into two if that promises fewer pairs; tell whether it did. Needs room for its pieces
    twice."""
    cell = pool.state[0] - 1
    begin, stop = pool.start[cell], pool.start[cell + 1]
    misses, remaining = pool.misses[cell], pool.remaining[cell]
    if stop - begin <= LEAF or cell + 2 >= _DEPTH or misses > _MISSES:
        return False
    _set_origin(pool, (begin + stop) >> 1)
    a, b, c, cost = _best_cut(pool, begin, stop)
    if (cost > _GAIN and misses == _MISSES) or remaining * cost > _WORST:
        return False
    middle, end = _cut(pool, begin, stop, a, b, c)
    above, below, whole = middle - begin, end - middle, stop - begin
    part = (float(above) * above + float(below) * below) / (float(whole) * whole)  # what rounding kept counts as well
    pool.start[cell + 1], pool.start[cell + 2] = middle, end
    pool.misses[cell] = pool.misses[cell + 1] = 0 if part <= _GAIN else misses + 1
    pool.remaining[cell] = pool.remaining[cell + 1] = remaining * part
    pool.state[0] += 1
    return True


@jit
def box_pieces(pool: Pool, begin: int, stop: int) -> None:
    """Write the boxes of the pieces begin .. stop - 1: two segments that meet in this cell meet in both boxes."""
    for p in range(begin, stop):
        s, low, high = pool.segment[p], pool.low[p], pool.high[p]
        for axis in range(2):
            a, b = pool.ends[s, axis], pool.ends[s, axis + 2]
            first, last = a + low * (b - a), a + high * (b - a)
            error = _UNDERFLOW
            if low <= 0.0 and high >= 1.0:
                first, last = a, b
            else:
                error += _BOX_ERROR * (abs(a) + abs(b))
            pool.box[p - begin, axis] = min(first, last) - error
            pool.box[p - begin, axis + 2] = max(first, last) + error
