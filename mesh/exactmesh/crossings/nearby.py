"""Which boxes may meet some of them: a raster, so that what changed in one corner is not looked for everywhere."""

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray

__all__ = ["boxes_of", "nearby"]

LongArray = npt.NDArray[np.int64]

_SIDE = 512  # cells of the raster in x and in y
_FEW = 1 << 12  # so few boxes are not worth a raster
_STEEPEST = 2.0**1000  # cells per unit of length


def boxes_of(begins: FloatArray, ends: FloatArray, margin: tuple[float, float]) -> FloatArray:
    """Return the segments' boxes, float64 (4, s): a quarter of the smallest x and y, and of the largest, so that no
    difference overflows; widened by at least the margin."""
    (ax, ay), (bx, by) = 0.25 * begins.T, 0.25 * ends.T
    left, low, right, top = np.minimum(ax, bx), np.minimum(ay, by), np.maximum(ax, bx), np.maximum(ay, by)
    return np.stack([left - margin[0], low - margin[1], right + margin[0], top + margin[1]])


def nearby(boxes: FloatArray, rows: LongArray) -> LongArray:
    """Return, ascending, at least all boxes that meet one of ``rows``, which ascend; those included.

    Each box covers a rectangle of cells. Rounding keeps the order of numbers, so boxes that meet have a cell in common.
    O(s) with a small constant.
    """
    total = boxes.shape[1]
    if not len(rows):
        return rows
    if total <= _FEW or 2 * len(rows) >= total:
        return np.arange(total)
    x, y = boxes[:2, rows].min(axis=1)
    right, top = boxes[2:, rows].max(axis=1)
    around = np.flatnonzero((boxes[0] <= right) & (boxes[1] <= top) & (boxes[2] >= x) & (boxes[3] >= y))
    with np.errstate(over="ignore"):
        scale = np.minimum(_SIDE / np.array([right - x, top - y]), _STEEPEST)
        cells = (boxes[:, around] - [[x], [y], [x], [y]]) * np.tile(scale, 2)[:, None]
    cells = np.clip(cells, 0.0, _SIDE).astype(np.int64)
    left, bottom, beyond, above = cells[0], cells[1], cells[2] + 1, cells[3] + 1
    image = np.zeros((_SIDE + 2, _SIDE + 2), dtype=np.int64)
    changed = np.searchsorted(around, rows)
    for i, j, change in ((left, bottom, 1), (beyond, bottom, -1), (left, above, -1), (beyond, above, 1)):
        np.add.at(image, (i[changed], j[changed]), change)
    marked = np.zeros_like(image)  # how many cells are marked to the left of and below each corner
    marked[1:, 1:] = (image.cumsum(axis=0).cumsum(axis=1)[:-1, :-1] > 0).cumsum(axis=0).cumsum(axis=1)
    count = marked[beyond, above] - marked[left, above] - marked[beyond, bottom] + marked[left, bottom]
    found: LongArray = around[count > 0]
    return found
