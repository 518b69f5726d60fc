"""Which boxes may meet some of them: a raster, so that what changed in one corner is not looked for everywhere."""

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray

__all__ = ["boxes_of", "nearby"]

_SIDE = 512  # cells of the raster in x and in y
_FEW = 1 << 12  # so few boxes are not worth a raster
_STEEPEST = 2.0**1000  # cells per unit of length


def boxes_of(begins: FloatArray, ends: FloatArray, margin: tuple[float, float]) -> FloatArray:
    """Return the segments' boxes, float64 (s, 4): a quarter of the smallest x and y, and of the largest, so that no
    difference overflows; widened by at least the margin."""
    a, b = 0.25 * begins, 0.25 * ends
    return np.hstack([np.minimum(a, b) - margin, np.maximum(a, b) + margin])


def nearby(boxes: FloatArray, rows: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Return, ascending, at least all boxes that meet one of ``rows``, those included.

    Each box covers a rectangle of cells. Rounding keeps the order of numbers, so boxes that meet have a cell in common.
    O(s) with a small constant.
    """
    if len(boxes) <= _FEW or 2 * len(rows) >= len(boxes):
        return np.arange(len(boxes))
    low, high = boxes[rows, :2].min(axis=0), boxes[rows, 2:].max(axis=0)
    with np.errstate(over="ignore"):
        scale = np.minimum(_SIDE / (high - low), _STEEPEST)
        cells = np.clip((boxes - np.tile(low, 2)) * np.tile(scale, 2), -1.0, _SIDE).astype(np.int64) + 1
    x, y, right, top = cells.T
    image = np.zeros((_SIDE + 3, _SIDE + 3), dtype=np.int64)
    for i, j, change in ((x, y, 1), (right + 1, y, -1), (x, top + 1, -1), (right + 1, top + 1, 1)):
        np.add.at(image, (i[rows], j[rows]), change)
    is_marked = image.cumsum(axis=0).cumsum(axis=1)[:-1, :-1] > 0
    marked = np.zeros_like(image)
    marked[1:, 1:] = is_marked.cumsum(axis=0, dtype=np.int64).cumsum(axis=1)
    count = marked[right + 1, top + 1] - marked[x, top + 1] - marked[right + 1, y] + marked[x, y]
    return np.flatnonzero(count)
