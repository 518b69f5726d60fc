"""Which segments meet which pixels: a tree of boxes over the pixels, and an exact test.

Everything is in units of the grid: the pixel of cell (i, j) is the square [i - 1/2, i + 1/2) x [j - 1/2, j + 1/2), its
left and lower sides included, so that every point lies in one pixel. Reference [Hobby 1999], [Guibas 1998].
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from gmpy2 import mpq, sign

from exactkernel.constants import UNIT_ROUNDOFF
from exactkernel.crossing import dd_cross
from exactkernel.expansions import two_diff, two_sum
from exactkernel.jit import jit
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.crossings.crossing_points import cells_of

__all__ = ["met_pixels"]

LongArray = npt.NDArray[np.int64]

_LEAF = 8  # pixels in a box at the bottom
_STACK = 128  # two boxes a level wait at most
_BUDGET = 1 << 21  # boxes looked at between two looks at Ctrl-C
_SAFE = 2.0**-200  # smaller coordinates, in units of the grid, are left to the rationals


class PixelTree(NamedTuple):
    """Boxes over pixels.

    Attributes:
        order: int32 (p,): the pixels from box to box.
        cells: float64 (p, 2), in that order.
        box: float64 (2 l, 4): smallest and largest cells under node i, whose children are 2 i and 2 i + 1; root 1; leaf
            l + j has the pixels _LEAF j .. _LEAF (j + 1) - 1 of ``order``.
    """

    order: IntArray
    cells: FloatArray
    box: FloatArray


class GridSegments(NamedTuple):
    """Segments in units of the grid.

    Attributes:
        ends: float64 (s, 4): ax, ay, bx, by.
        cells: float64 (s, 4): smallest and largest cells of the ends.
        safe: bool (s,): no coordinate is so small that something could underflow.
    """

    ends: FloatArray
    cells: FloatArray
    safe: npt.NDArray[np.bool_]


def _interleaved(cells: FloatArray) -> LongArray:
    """Return the bits of the ranks in x and y, interleaved: near pixels get near numbers, however they are spread."""
    keys = np.zeros(len(cells), dtype=np.int64)
    for axis in range(2):
        rank = np.empty(len(cells), dtype=np.int64)
        rank[np.argsort(cells[:, axis], kind="stable")] = np.arange(len(cells))
        for bit in range(31):
            keys |= (rank >> bit & 1) << (2 * bit + axis)
    return keys


def _tree_of(cells: FloatArray) -> PixelTree:
    order = np.argsort(_interleaved(cells)).astype(np.int32)
    sorted_cells = cells[order]
    leaves = 1
    while leaves * _LEAF < len(cells):
        leaves *= 2
    box = np.empty((2 * leaves, 4))
    box[:, :2], box[:, 2:] = np.inf, -np.inf
    padded = np.full((leaves * _LEAF, 2), np.nan)
    padded[: len(cells)] = sorted_cells
    groups = padded.reshape(leaves, _LEAF, 2)
    box[leaves:, :2] = np.fmin.reduce(groups, axis=1, initial=np.inf)
    box[leaves:, 2:] = np.fmax.reduce(groups, axis=1, initial=-np.inf)
    while leaves > 1:
        leaves //= 2
        children = box[2 * leaves : 4 * leaves].reshape(leaves, 2, 4)
        box[leaves : 2 * leaves, :2] = children[:, :, :2].min(axis=1)
        box[leaves : 2 * leaves, 2:] = children[:, :, 2:].max(axis=1)
    return PixelTree(order, sorted_cells, box)


def _in_grid_units(begins: FloatArray, ends: FloatArray, grid: tuple[float, float]) -> GridSegments:
    spacing = np.array(grid)
    scaled = np.hstack([begins / spacing, ends / spacing])
    a, b = cells_of(begins, grid), cells_of(ends, grid)
    given = np.hstack([begins, ends])
    safe = ((given == 0.0) | (abs(scaled) >= _SAFE)).all(axis=1)
    return GridSegments(scaled, np.hstack([np.minimum(a, b), np.maximum(a, b)]), safe)


@jit
def _may_meet(s: GridSegments, i: int, box: FloatArray, node: int) -> bool:
    """Tell whether the segment may meet a pixel under the node; True when in doubt."""
    if s.cells[i, 0] > box[node, 2] or s.cells[i, 2] < box[node, 0]:
        return False
    if s.cells[i, 1] > box[node, 3] or s.cells[i, 3] < box[node, 1]:
        return False
    ax, ay = s.ends[i, 0], s.ends[i, 1]
    ux, uy = abs(s.ends[i, 2] - ax), abs(s.ends[i, 3] - ay)
    rises = (s.ends[i, 2] > ax) == (s.ends[i, 3] > ay)
    x, y = 0.5 * (box[node, 0] + box[node, 2]), 0.5 * (box[node, 1] + box[node, 3])
    across = ux * (y - ay) - uy * (x - ax) if rises else ux * (y - ay) + uy * (x - ax)
    reach = ux * (y - box[node, 1] + 1.0) + uy * (x - box[node, 0] + 1.0)  # half a unit more than the pixels
    doubt = 32.0 * UNIT_ROUNDOFF * (ux * (abs(y) + abs(ay)) + uy * (abs(x) + abs(ax)))
    return bool(abs(across) <= reach + doubt)


@jit
def _line_meets(s: GridSegments, i: int, x: float, y: float) -> int:
    """Return whether the line of the segment passes the inside of the square about (x, y): 1, 0, or -1 for undecided.

    With u = b - a it does when 2 |u x (c - a)| < |ux| + |uy|.
    """
    ux, ux_tail = two_diff(s.ends[i, 2], s.ends[i, 0])
    uy, uy_tail = two_diff(s.ends[i, 3], s.ends[i, 1])
    if not s.safe[i]:
        return -1
    if ux == 0.0 or uy == 0.0:
        return 1  # the ranges of cells have told
    p, p_tail = two_diff(y, s.ends[i, 1])
    q, q_tail = two_diff(x, s.ends[i, 0])
    cross, cross_tail, error = dd_cross(ux, ux_tail, p, p_tail, uy, uy_tail, q, q_tail)
    if cross < 0.0:
        cross, cross_tail = -cross, -cross_tail
    if ux < 0.0:
        ux, ux_tail = -ux, -ux_tail
    if uy < 0.0:
        uy, uy_tail = -uy, -uy_tail
    reach, reach_tail = two_sum(ux, uy)
    apart, apart_tail = two_diff(2.0 * cross, reach)
    apart += apart_tail + (2.0 * cross_tail - reach_tail - ux_tail - uy_tail)
    # every tail is at most u times its head, and each of the four roundings errs by u times a few of those
    doubt = (
        4.0 * error + 32.0 * UNIT_ROUNDOFF * UNIT_ROUNDOFF * (2.0 * cross + reach) + 4.0 * UNIT_ROUNDOFF * abs(apart)
    )
    if apart > doubt:
        return 0
    return 1 if apart < -doubt else -1


@jit
def _query(
    tree: PixelTree, s: GridSegments, state: LongArray, stack: LongArray, met: LongArray, certain: npt.NDArray[np.bool_]
) -> int:
    """Write rows (segment, pixel) that meet, or may where not ``certain``; go on from state = (segment, stack
    height)."""
    leaves = len(tree.box) // 2
    n, budget = 0, _BUDGET
    while state[0] < len(s.ends) and n + _LEAF <= len(met) and budget > 0:
        if state[1] == 0:
            state[0] += 1
            state[1] = 1
            stack[0] = 1
            continue
        budget -= 1
        state[1] -= 1
        i, node = state[0], stack[state[1]]
        if not _may_meet(s, i, tree.box, node):
            continue
        if node < leaves:
            stack[state[1]] = 2 * node
            stack[state[1] + 1] = 2 * node + 1
            state[1] += 2
            continue
        first = (node - leaves) * _LEAF
        for p in range(first, min(first + _LEAF, len(tree.order))):
            x, y = tree.cells[p, 0], tree.cells[p, 1]
            if s.cells[i, 0] <= x <= s.cells[i, 2] and s.cells[i, 1] <= y <= s.cells[i, 3]:
                answer = _line_meets(s, i, x, y)
                if answer != 0:
                    met[n, 0], met[n, 1] = i, tree.order[p]
                    certain[n] = answer > 0
                    n += 1
    return n


def _meets_exactly(a: list[float], b: list[float], cell: list[float], grid: tuple[float, float]) -> bool:
    """Tell in rationals whether the segment ab meets the pixel of a cell that its ranges of cells include."""
    (ax, ay), (bx, by) = ((mpq(p[0]) / mpq(grid[0]), mpq(p[1]) / mpq(grid[1])) for p in (a, b))
    ux, uy = bx - ax, by - ay
    if ux == 0 or uy == 0:
        return True

    def side(x: mpq, y: mpq) -> int:
        return sign(ux * (y - ay) - uy * (x - ax))

    half, x, y = mpq(1, 2), mpq(cell[0]), mpq(cell[1])
    low_left = side(x - half, y - half)
    others = {side(x + half, y - half), side(x - half, y + half), side(x + half, y + half)}
    # of a line that only touches a square, at a corner, the lower left corner alone belongs to the pixel
    return low_left == 0 or (-1 in others | {low_left} and 1 in others | {low_left})


def met_pixels(
    begins: FloatArray, ends: FloatArray, cells: FloatArray, grid: tuple[float, float]
) -> tuple[LongArray, LongArray]:
    """Return (segment, pixel), all pairs that meet, exactly. About O(log p + m) a short segment, O(sqrt p + m) a long
    one.

    Args:
        begins, ends: float64 (s, 2), the segments.
        cells: float64 (p, 2), different cells of the grid.
        grid: the spacings in x and y.
    """
    tree, s = _tree_of(cells), _in_grid_units(begins, ends, grid)
    state, stack = np.array([0, 1]), np.ones(_STACK, dtype=np.int64)
    met = np.empty((max(4 * len(begins), 1 << 16), 2), dtype=np.int64)
    certain = np.empty(len(met), dtype=np.bool_)
    portions = [np.empty((0, 2), dtype=np.int64)]
    while state[0] < len(s.ends):
        n = _query(tree, s, state, stack, met, certain)
        raise_if_interrupted()
        keep = certain[:n].copy()
        for row in np.flatnonzero(~keep).tolist():
            i, p = met[row].tolist()
            keep[row] = _meets_exactly(begins[i].tolist(), ends[i].tolist(), cells[p].tolist(), grid)
        portions.append(met[:n][keep])
    pairs = np.concatenate(portions)
    return pairs[:, 0], pairs[:, 1]
