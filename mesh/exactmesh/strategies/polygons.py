"""Polygons that are simple by construction: zigzags, staircases, spirals, with holes, with common borders."""

from itertools import accumulate, pairwise
from math import isqrt

import numpy as np
from hypothesis import strategies as st

from exactmesh.pslg import PSLG, Carve
from exactmesh.strategies.assembling import Cells, assembled, closed
from exactmesh.strategies.drawing import check_sizes, heights, seeds, shuffled

__all__ = ["polygons", "polygons_with_holes", "shared_borders", "spirals"]

_RULES = st.sampled_from((Carve.SEEDS, Carve.EVEN_ODD))


def polygons(*, min_size: int = 3, max_size: int = 20) -> st.SearchStrategy[PSLG]:
    """Draw one simple polygon: a zigzag of two monotone chains, or a staircase.

    It is not convex: a Delaunay triangulation of its vertices lacks some of its edges. It is thin where heights differ
    much.

    Args:
        min_size, max_size: how many points.

    Returns:
        A strategy for :class:`exactmesh.PSLG`. Coordinates are integers but for a power of two, perhaps far off.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order; fewer than 3 points.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import polygons
    >>> find(polygons(), lambda polygon: True).points.tolist()
    [[0.0, 0.0], [1.0, -1.0], [2.0, 0.0]]
    """
    check_sizes(min_size, max_size, 3)
    return _polygon(max(3, min_size), max_size)


@st.composite
def _polygon(draw: st.DrawFn, low: int, high: int) -> PSLG:
    drawn = draw(heights(low - 2, high - 2))
    is_staircase = draw(st.booleans()) and len(drawn) >= 2
    cells = _staircase(drawn) if is_staircase else _zigzag(drawn)
    return assembled(draw, cells, closed(np.arange(len(cells))), rule=draw(_RULES))


def _zigzag(drawn: Cells) -> Cells:
    """A vertex at each x, above or below the axis by the first bit."""
    n = len(drawn)
    x = np.arange(1, n + 1)
    is_above = drawn % 2 == 1
    y = np.where(is_above, 1, -1) * (1 + drawn // 2)
    inner = np.stack([x, y], axis=1)
    return np.concatenate([[(0, 0)], inner[~is_above], [(n + 1, 0)], inner[is_above][::-1]])


def _staircase(drawn: Cells) -> Cells:
    """Columns of those heights side by side, two vertices each, one more below if the number is odd."""
    n = len(drawn)
    steps = 1 + 2 * drawn[: n // 2] + np.arange(n // 2) % 2  # neighbours differ
    x = 2 * np.arange(n // 2)[::-1]
    tops = np.stack([np.stack([x + 2, steps], axis=1), np.stack([x, steps], axis=1)], axis=1).reshape(-1, 2)
    base = [(0, 0), *[(1, 0)] * (n % 2), (2 * (n // 2), 0)]
    return np.concatenate([base, tops])


def spirals(*, min_size: int = 4, max_size: int = 20) -> st.SearchStrategy[PSLG]:
    """Draw a spiral, one arm with right angles that winds round itself, sheared or not.

    Deep pockets: visibility is blocked many times, a segment is far from the triangles beside it, and carving by
    flooding takes long ways.

    Args:
        min_size, max_size: how many points.

    Returns:
        A strategy for :class:`exactmesh.PSLG`.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order; fewer than 4 points.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import spirals
    >>> find(spirals(), lambda spiral: len(spiral.points) > 4).points.tolist()
    [[0.0, -1.0], [3.0, -1.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.0]]
    """
    check_sizes(min_size, max_size, 4)
    return _spiral(max(4, min_size), max_size)


@st.composite
def _spiral(draw: st.DrawFn, low: int, high: int) -> PSLG:
    size = draw(st.integers(low, high))
    bends = np.arange(size // 2 - 1)
    directions = np.array([(1, 0), (0, 1), (-1, 0), (0, -1)])[bends % 4]
    middle = np.concatenate([[(0, 0)], np.cumsum(directions * (3 * (1 + bends // 2))[:, None], axis=0)])
    normals = np.stack([-directions[:, 1], directions[:, 0]], axis=1)
    across = np.zeros_like(middle)  # to the left, by 1, at each end and each bend
    across[:-1] += normals
    across[1:] += normals
    across[0], across[-1] = normals[0], normals[-1]
    cap = middle[-1:] if size % 2 else middle[:0]
    cells = np.concatenate([middle - across, cap, (middle + across)[::-1]])
    return assembled(draw, cells, closed(np.arange(size)), rule=draw(_RULES))


def polygons_with_holes(*, min_size: int = 7, max_size: int = 24) -> st.SearchStrategy[PSLG]:
    """Draw a box with triangular and square holes; squares may touch each other and the box, in points or edges.

    What floods holes leaks through corners, and coincident edges of two holes that touch are counted once or twice.

    Args:
        min_size, max_size: how many points.

    Returns:
        A strategy for :class:`exactmesh.PSLG`, with a seed in each hole, by either rule.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order; fewer than 7 points.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import polygons_with_holes
    >>> find(polygons_with_holes(), lambda polygon: True)
    PSLG(7 points, 7 segments, 1 hole, 0 regions, carve by seeds)
    """
    check_sizes(min_size, max_size, 7)
    return _with_holes(max(7, min_size), max_size)


_TRIANGLE = np.array([(1, 1), (3, 1), (2, 3)])
_SQUARE = np.array([(1, 1), (3, 1), (3, 3), (1, 3)])
_WHOLE = np.array([(0, 0), (4, 0), (4, 4), (0, 4)])


@st.composite
def _with_holes(draw: st.DrawFn, low: int, high: int) -> PSLG:
    size, seed = draw(st.integers(low, high)), draw(seeds)
    count = draw(st.integers(max(1, (size - 10) // 4), (size - 4) // 3))
    spare = size - 4 - 3 * count  # vertices beyond four corners and triangles
    squares = min(count, draw(st.integers(0, spare)))
    spare -= squares
    side = max(isqrt(count) + 1, spare // 4 + 1) + draw(st.integers(0, 1))  # more cells than holes
    square = _WHOLE if draw(st.booleans()) else _SQUARE
    below = np.stack([np.arange(1, spare + 1), np.zeros(spare, dtype=np.int64)], axis=1)
    outline = np.array([(4 * side, 0), (4 * side, 4 * side), (0, 4 * side)])
    rings = [np.concatenate([[(0, 0)], below, outline])]
    centres = []
    for hole, cell in enumerate(shuffled(seed, side * side)[:count].tolist()):
        corner = np.array([4 * (cell % side), 4 * (cell // side)])
        rings.append((square if hole < squares else _TRIANGLE) + corner)
        centres.append((int(corner[0]) + 2, int(corner[1]) + 2))
    segments = np.concatenate([closed(np.arange(a, b)) for a, b in pairwise(accumulate(map(len, rings), initial=0))])
    return assembled(draw, np.concatenate(rings), segments, holes=centres, rule=draw(_RULES))


def shared_borders(*, min_size: int = 4, max_size: int = 20) -> st.SearchStrategy[PSLG]:
    """Draw two polygons with a common border: of the same vertices, of copies, or of copies that leave some out.

    So lie the countries of a map beside each other: each edge of the border is there twice, duplicate vertices at both
    ends, or a long edge of the one runs along short ones of the other.

    Args:
        min_size, max_size: how many points, the copies counted.

    Returns:
        A strategy for :class:`exactmesh.PSLG`.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order; fewer than 4 points.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import shared_borders
    >>> find(shared_borders(), lambda graph: len(graph.duplicates) == 2).points.tolist()
    [[0.0, 0.0], [0.0, 1.0], [-8.0, 0.0], [8.0, 1.0], [0.0, 0.0], [0.0, 1.0]]
    """
    check_sizes(min_size, max_size, 4)
    return _shared_border(max(4, min_size), max_size)


@st.composite
def _shared_border(draw: st.DrawFn, low: int, high: int) -> PSLG:
    size = draw(st.integers(low, high))
    copies = draw(st.integers(0, (size - 2) // 2))
    copies = copies if copies > 1 else 0
    length = size - 2 - copies
    bends = draw(heights(length, length)) % 4
    if 0 < copies < length:
        bends[:] = 0  # what is left out lies on the other's edge
    border = np.stack([bends, np.arange(length)], axis=1)
    kept = np.concatenate([np.arange(max(0, copies - 1)), [length - 1]]) if copies else np.arange(0)
    far = 4 * length
    apexes = np.array([(-far, 0), (far, length - 1)])
    left = np.append(np.arange(length), length)
    right = np.append(np.arange(size - copies, size) if copies else np.arange(length), length + 1)
    segments = np.concatenate([closed(left), closed(right) if copies else closed(right)[length - 1 :]])
    return assembled(draw, np.concatenate([border, apexes, border[kept]]), segments)
