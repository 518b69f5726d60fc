"""Segments that are hard to keep: slits, sharp corners, bundles through one point, T-junctions."""

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

from exactkernel.types import FloatArray
from exactmesh.pslg import PSLG
from exactmesh.strategies.assembling import assembled, closed, path
from exactmesh.strategies.drawing import check_sizes, codes, heights, seeds, units

__all__ = ["near_concurrent", "slits", "small_angles", "t_junctions"]


def slits(*, min_size: int = 6, max_size: int = 20) -> st.SearchStrategy[PSLG]:
    """Draw a box with slits in it: segments that end inside, floating or attached to the outline.

    The domain lies on both sides of them. What takes each segment for a boundary carves, loses or doubles them.

    Args:
        min_size, max_size: how many points.

    Returns:
        A strategy for :class:`exactmesh.PSLG`.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order; fewer than 6 points.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import slits
    >>> find(slits(), lambda graph: True).points.tolist()
    [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [2.0, 1.0], [2.0, 2.0]]
    """
    check_sizes(min_size, max_size, 6)
    return _slits(max(6, min_size), max_size)


@st.composite
def _slits(draw: st.DrawFn, low: int, high: int) -> PSLG:
    drawn = draw(heights(low - 5, high - 5))  # a slit by two points, one of them by three
    count = (len(drawn) + 1) // 2
    is_bent = len(drawn) % 2 == 0
    is_attached, lows = drawn[:count] % 2 == 1, drawn[:count] // 2
    x = 2 + 2 * np.arange(count)
    bottoms = np.stack([x, np.where(is_attached, 0, 1 + lows)], axis=1)
    tops = np.stack([x, 2 + lows], axis=1)
    bend = np.array([(3, 3 + lows[0])] * is_bent, dtype=np.int64).reshape(-1, 2)
    wide, tall = 2 * count + 2, 3 + int(lows.max()) + is_bent
    cells = np.concatenate([[(0, 0), (wide, 0), (wide, tall), (0, tall)], bottoms, tops, bend])
    rows = 4 + np.arange(count)
    outline = np.concatenate([[0], rows[is_attached], [1, 2, 3]])
    parts = [closed(outline), np.stack([rows, rows + count], axis=1)]
    if is_bent:
        parts.append(np.array([(4 + count, 4 + 2 * count)]))
    return assembled(draw, cells, np.concatenate(parts))


def small_angles(*, min_size: int = 3, max_size: int = 20) -> st.SearchStrategy[PSLG]:
    """Draw a fan: triangles with one corner in common, 2 to 2^30 away from a row of points.

    Angles go down to 2^-30. Refinement that splits segments one after the other round such a corner need not end, and
    no mesh has better angles.

    Args:
        min_size, max_size: how many points.

    Returns:
        A strategy for :class:`exactmesh.PSLG`.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order; fewer than 3 points.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import small_angles
    >>> find(small_angles(), lambda graph: len(graph.points) > 3).points.tolist()
    [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [2.0, 2.0]]
    """
    check_sizes(min_size, max_size, 3)
    return _fan(max(3, min_size), max_size)


@st.composite
def _fan(draw: st.DrawFn, low: int, high: int) -> PSLG:
    steps = draw(codes(low - 1, high - 1)).astype(np.int64)
    away = 2 ** draw(st.integers(1, 30))
    row = np.sort(steps)
    cells = np.concatenate([[(0, 0)], np.stack([np.full_like(row, away), row], axis=1)])
    rows = np.arange(1, len(cells))
    spokes = np.stack([np.zeros_like(rows), rows], axis=1)
    return assembled(draw, cells, np.concatenate([spokes, path(rows)]))


def near_concurrent(*, min_size: int = 4, max_size: int = 14) -> st.SearchStrategy[PSLG]:
    """Draw segments that cross each other in nearly one point, in random directions, or exactly in one.

    Their crossings, rounded, lie in another order along each segment: what splits segments at them one by one inverts
    triangles, leaves gaps, or goes on for ever. Three such segments suffice against Triangle. They bound no domain.

    Args:
        min_size, max_size: how many points, two for each segment, and one more if the number is odd.

    Returns:
        A strategy for :class:`exactmesh.PSLG`. Any two segments cross, or nearly do.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order; fewer than 4 points.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import near_concurrent
    >>> find(near_concurrent(), lambda graph: len(graph.segments) == 3).points.tolist()
    [[-1.0, 0.0], [-1.0, -1.0], [-1.0, -2.0], [1.0, 0.0], [1.0, 1.0], [1.0, 2.0]]
    """
    check_sizes(min_size, max_size, 4)
    return _bundle(max(4, min_size), max_size)


@st.composite
def _bundle(draw: st.DrawFn, low: int, high: int) -> PSLG:
    size = draw(st.integers(low, high))
    numbers, seed = draw(codes(size // 2, size // 2)), draw(seeds)
    if seed == 0:
        centre: FloatArray = np.zeros(2)
        ends = np.stack([np.ones(len(numbers)), numbers.astype(np.float64)], axis=1)
        starts = centre - ends
    else:
        (centre,) = units(seed + 1, numbers[:1], 53)
        angles = np.pi * units(seed + 2, numbers, 53)[:, 0]
        lengths = units(seed, numbers, 53)
        directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        starts, ends = centre - lengths[:, :1] * directions, centre + lengths[:, 1:] * directions
    rows = np.arange(len(numbers))
    points = np.concatenate([starts, ends, centre[None, :][: size % 2]])
    assume(not (starts == ends).all(axis=1).any())
    return PSLG(points, np.stack([rows, rows + len(rows)], axis=1))


def t_junctions(*, min_size: int = 5, max_size: int = 20) -> st.SearchStrategy[PSLG]:
    """Draw a triangle with segments in it that end on one side, exactly, between its ends; perhaps with some along it.

    The side has to be split where nobody said so; segments that overlap are one edge, not two.

    Args:
        min_size, max_size: how many points.

    Returns:
        A strategy for :class:`exactmesh.PSLG`.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order; fewer than 5 points.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import t_junctions
    >>> find(t_junctions(), lambda graph: True).points.tolist()
    [[0.0, 0.0], [4.0, 0.0], [0.0, 8.0], [2.0, 0.0], [2.0, 1.0]]
    """
    check_sizes(min_size, max_size, 5)
    return _comb(max(5, min_size), max_size)


@st.composite
def _comb(draw: st.DrawFn, low: int, high: int) -> PSLG:
    drawn = draw(heights(low - 4, high - 4))  # a tooth by two points, one of them by three
    count = (len(drawn) + 1) // 2
    is_forked = len(drawn) % 2 == 0
    x, tall = 2 + 2 * np.arange(count), 1 + drawn[:count]
    wide = 2 * count + 2
    outline = [(0, 0), (wide, 0), (0, wide * (int(tall.max()) + 1))]  # steep enough to be above all teeth
    feet, heads = np.stack([x, np.zeros_like(x)], axis=1), np.stack([x, tall], axis=1)
    rows = 3 + np.arange(count)
    parts = [closed(np.arange(3)), np.stack([rows, rows + count], axis=1)]
    if is_forked:
        parts.append(np.array([(3, 3 + 2 * count)]))
    if draw(st.booleans()) and count > 1:
        parts.append(path(rows))  # along the side
    return assembled(
        draw, np.concatenate([outline, feet, heads, [(3, 1)][:is_forked] or feet[:0]]), np.concatenate(parts)
    )
