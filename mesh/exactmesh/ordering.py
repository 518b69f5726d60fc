"""The order of insertion: BRIO rounds, each along a Hilbert curve.

Randomness across rounds bounds the expected number of flips for every input; the curve inside a round keeps each walk
short and each cache line warm. The order decides only how fast the answer comes, never which: so floating point may
round here as it likes. Reference [Amenta 2003], [Hilbert 1891].
"""

import operator

import numpy as np
import numpy.typing as npt

from exactkernel.jit import jit
from exactkernel.types import FloatArray
from exactmesh.errors import SeedError

__all__ = ["IndexArray", "insertion_order"]

UInt64Array = npt.NDArray[np.uint64]
IndexArray = npt.NDArray[np.int64]

_FIRST_ROUND = 1 << 7  # about so many points, at least, make the first round
_ROUND_BITS = 4  # a round holds 15/16 of the points that are left for it and the rounds before
_RUN = 32  # so many points in one cell are worth a finer curve of their own
_SIDE_BITS = 18  # at most 2^18 cells a side
_TINY = 2.0**-1074  # the extent of a single point
_LEVELS = 3  # levels of the curve that one look into the table descends


def _hilbert_table() -> IndexArray:
    """Return table[state, 2 * right + upper] = 4 * position + next state, for one level of the curve.

    The curve passes a square in one of four ways, the Klein four-group of a cup that opens down: state 0 as it is, 1
    reflected in the diagonal, 2 in the other diagonal, 3 turned by 180 degrees; composing two ways is their XOR.
    """
    cup = (0b00, 0b01, 0b11, 0b10)
    ways = (1, 0, 0, 2)  # how the cup's four quadrants are passed in their turn
    table = np.zeros((4, 4), dtype=np.int64)
    for state in range(4):
        for position, quadrant in enumerate(cup):
            turned = quadrant ^ (0b11 if state & 2 else 0)
            if state in (1, 2):
                turned = (turned & 1) << 1 | turned >> 1
            table[state, turned] = 4 * position + (ways[position] ^ state)
    return table


def _deep_table(levels: int) -> IndexArray:
    """Return table[state << 2 levels | x bits << levels | y bits] = 4 * position + next state, for several levels."""
    one = _hilbert_table()
    table = np.zeros(4 << 2 * levels, dtype=np.int64)
    for index in range(len(table)):
        state, position = index >> 2 * levels, 0
        for level in range(levels - 1, -1, -1):
            quadrant = (index >> levels >> level & 1) << 1 | (index >> level & 1)
            step = int(one[state, quadrant])
            state, position = step & 3, position << 2 | step >> 2
        table[index] = 4 * position + state
    return table


_TABLE = _deep_table(_LEVELS)


@jit
def _pack_keys(
    xy: FloatArray,
    group: IndexArray,
    low: FloatArray,
    extent: FloatArray,
    side_bits: int,
    index_bits: int,
    table: IndexArray,
    keys: UInt64Array,
) -> None:
    """Write keys[i] = group | position along the curve in the group's box | i."""
    last = (1 << side_bits) - 1
    for i in range(len(keys)):
        g = group[i]
        u = min(int((0.5 * xy[i, 0] - low[g, 0]) / extent[g] * last), last)
        v = min(int((0.5 * xy[i, 1] - low[g, 1]) / extent[g] * last), last)
        key = g
        state = 0
        for level in range(side_bits - _LEVELS, -1, -_LEVELS):
            step = table[state << 2 * _LEVELS | (u >> level & 7) << _LEVELS | (v >> level & 7)]
            state = step & 3
            key = key << 2 * _LEVELS | step >> 2
        keys[i] = key << index_bits | i


def _rounds(n: int, seed: int) -> IndexArray:
    """Return the BRIO round of each point: the last has 15/16 of all, the one before 15/16 of the rest, and so on."""
    try:
        chosen = operator.index(seed)
    except TypeError:
        raise SeedError(f"seed={seed!r} is no integer") from None
    if chosen < 0:
        raise SeedError(f"seed={chosen} is negative")
    rounds = max(0, (n // _FIRST_ROUND).bit_length() - 1) // _ROUND_BITS
    coins = np.random.default_rng(chosen).random(n, dtype=np.float32)
    group = np.full(n, rounds, dtype=np.int64)
    for level in range(1, rounds + 1):
        group -= coins < 2.0 ** (-_ROUND_BITS * level)
    return group


def _boxes(xy: FloatArray, starts: IndexArray) -> tuple[FloatArray, FloatArray]:
    """Return half the lower corner and half the extent of the groups that start there (whole, they may overflow)."""
    halves = [0.5 * np.ascontiguousarray(xy[:, axis]) for axis in (0, 1)]
    low = [np.minimum.reduceat(half, starts) for half in halves]
    extents = [np.maximum.reduceat(half, starts) - corner for half, corner in zip(halves, low, strict=True)]
    return np.stack(low, axis=1), np.maximum(*extents)


def _along_curves(
    xy: FloatArray, group: IndexArray, low: FloatArray, extent: FloatArray
) -> tuple[IndexArray, IndexArray, IndexArray]:
    """Sort the points by group, and along a curve in the box of each group.

    Returns the order, and the starts and lengths of the runs in it that crowd one cell.
    """
    index_bits, group_bits = len(xy).bit_length(), len(extent).bit_length()
    side_bits = min(_SIDE_BITS, (63 - index_bits - group_bits) // 2 // _LEVELS * _LEVELS)
    keys = np.empty(len(xy), dtype=np.uint64)
    _pack_keys(xy, group, low, np.maximum(extent, _TINY), side_bits, index_bits, _TABLE, keys)
    keys.sort()
    order = (keys & np.uint64((1 << index_bits) - 1)).view(np.int64)
    keys >>= np.uint64(index_bits)
    bounds = np.concatenate(([0], np.flatnonzero(keys[1:] != keys[:-1]) + 1, [len(keys)]))
    lengths = np.diff(bounds)
    crowded = np.flatnonzero(lengths > _RUN)
    return order, bounds[crowded], lengths[crowded]


def insertion_order(xy: FloatArray, seed: int) -> IndexArray:
    """Return the indices of the points, float64 (n, 2), in the order in which to insert them. O(n log n).

    Raises:
        SeedError: the seed is no integer, or negative.

    Points that crowd one cell are sorted again, along a curve in their own bounding box: each level divides the box by
    2^12 at least, so a few levels reach any cluster, and some hundred any doubles.

    >>> import numpy as np
    >>> from exactmesh.ordering import insertion_order
    >>> insertion_order(np.array([[0.0, 0.0], [1.0, 0.0], [0.1, 0.9], [1.0, 1.0]]), seed=0).tolist()
    [0, 2, 3, 1]
    """
    group = _rounds(len(xy), seed)
    rounds = int(group.max()) + 1
    low, extent = (np.repeat(bound, rounds, axis=0) for bound in _boxes(xy, np.zeros(1, dtype=np.int64)))
    order, starts, lengths = _along_curves(xy, group, low, extent)
    positions = np.arange(0)  # of the points that crowd a cell, run after run
    while len(starts):
        run = np.repeat(starts - np.cumsum(lengths) + lengths, lengths) + np.arange(lengths.sum())
        positions = positions[run] if len(positions) else run
        local = xy[order[positions]]
        low, extent = _boxes(local, np.cumsum(lengths) - lengths)
        spread = extent > 0.0  # the others are copies of one point
        kept = np.repeat(spread, lengths)
        group = np.repeat(np.cumsum(spread) - 1, lengths)[kept]
        positions = positions[kept]
        if len(positions) == 0:
            break
        rank, starts, lengths = _along_curves(local[kept], group, low[spread], extent[spread])
        order[positions] = order[positions][rank]
    return order
