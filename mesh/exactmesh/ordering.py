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

_FIRST_ROUND = 1 << 10  # about so many points, at least, make the first round
_ROUND_BITS = 3  # a round holds 7/8 of the points that are left for it and the rounds before
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
    """Return the BRIO round of each point: the last has 7/8 of all, the one before 7/8 of the rest, and so on."""
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


def _crowded_runs(cell: UInt64Array) -> tuple[IndexArray, IndexArray]:
    """Return the starts and lengths of the runs of more than _RUN equal cells."""
    bounds = np.concatenate(([0], np.flatnonzero(cell[1:] != cell[:-1]) + 1, [len(cell)]))
    lengths = np.diff(bounds)
    crowded = np.flatnonzero(lengths > _RUN)
    return bounds[crowded], lengths[crowded]


def insertion_order(xy: FloatArray, seed: int) -> IndexArray:
    """Return the indices of the points, float64 (n, 2), in the order in which to insert them. O(n log n).

    Raises:
        SeedError: the seed is no integer, or negative.

    Points that crowd one cell of the curve are sorted again, along a curve in their own bounding box: each level divides
    the box by 2^15 at least, so a few levels reach any cluster, and some hundred any doubles.

    >>> import numpy as np
    >>> from exactmesh.ordering import insertion_order
    >>> insertion_order(np.array([[0.0, 0.0], [1.0, 0.0], [0.1, 0.9], [1.0, 1.0]]), seed=0).tolist()
    [0, 2, 3, 1]
    """
    order = np.arange(len(xy), dtype=np.int64)
    positions, group = order.copy(), _rounds(len(xy), seed)
    rounds = int(group.max()) + 1
    low, extent = (np.repeat(bound, rounds, axis=0) for bound in _boxes(xy, order[:1]))
    local = xy
    while len(positions):
        index_bits, group_bits = len(positions).bit_length(), len(extent).bit_length()
        side_bits = min(_SIDE_BITS, (63 - index_bits - group_bits) // 2 // _LEVELS * _LEVELS)
        keys = np.empty(len(positions), dtype=np.uint64)
        _pack_keys(local, group, low, np.maximum(extent, _TINY), side_bits, index_bits, _TABLE, keys)
        keys.sort()
        order[positions] = order[positions][keys & np.uint64((1 << index_bits) - 1)]
        starts, lengths = _crowded_runs(keys >> np.uint64(index_bits))
        kept = np.repeat(starts - np.cumsum(lengths) + lengths, lengths) + np.arange(lengths.sum())
        positions = positions[kept]
        local = xy[order[positions]]
        if len(positions) == 0:
            break
        low, extent = _boxes(local, np.cumsum(lengths) - lengths)
        spread = extent > 0.0
        group = np.repeat(np.cumsum(spread) - 1, lengths)
        kept = np.repeat(spread, lengths)
        positions, local, group = positions[kept], local[kept], group[kept]
        low, extent = low[spread], extent[spread]
    return order
