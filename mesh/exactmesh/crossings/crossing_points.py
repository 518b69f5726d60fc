"""Where segments cross: the nearest doubles, or the grid cells, certified; rationals for what is not.

Rounding is exact: of all doubles the nearest, ties to even; of all cells the one that contains the point, its left and
lower sides included. So equal crossings get equal results, however they were computed.
"""

import math

import numpy as np
from gmpy2 import mpq

from exactkernel.constructions import rounded, segment_crossing
from exactkernel.context import Context, scaled_into_window
from exactkernel.crossing import crossing_in_pairs, is_nearest_certain
from exactkernel.jit import jit
from exactkernel.rational import RationalPoint, raise_if_interrupted
from exactkernel.types import FloatArray, IntArray

__all__ = ["CrossingRounder", "cells_of"]

_CHUNK = 1 << 18
_SMALLEST = 2.0**-1021  # below, doubles are no longer as dense as in the window


@jit
def _certain_cell(x: float, tail: float, error: float) -> tuple[float, bool]:
    """Return floor(x + 1/2) of any number within the error of x + tail, and whether it is the same for all."""
    cell = float(np.floor(x))
    above = (x - cell) + tail  # the difference is exact
    margin = error + 2.0**-52 * (abs(above) + error)
    if above - 0.5 >= margin and above + margin < 1.5:
        return cell + 1.0, True
    return cell, bool(above + margin < 0.5 and above + 0.5 >= margin)


@jit
def _round_range(
    k: Context,
    xy: FloatArray,
    segments: IntArray,
    first: IntArray,
    second: IntArray,
    scale: FloatArray,
    smallest: float,
    begin: int,
    stop: int,
    out: FloatArray,
    undecided: IntArray,
) -> int:
    """Write the rounded crossings; list those that are left to the rationals, and return how many.

    ``scale`` is (0, 0) for the nearest doubles; else coordinates times it are in units of the grid's cells.
    """
    count = 0
    for i in range(begin, stop):
        a, b, c, d = segments[first[i], 0], segments[first[i], 1], segments[second[i], 0], segments[second[i], 1]
        x, x_tail, x_error, y, y_tail, y_error = crossing_in_pairs(
            k, xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1], xy[c, 0], xy[c, 1], xy[d, 0], xy[d, 1]
        )
        if scale[0] > 0.0:
            x, good_x = _certain_cell(x * scale[0], x_tail * scale[0], x_error * scale[0])
            y, good_y = _certain_cell(y * scale[1], y_tail * scale[1], y_error * scale[1])
        else:
            good_x = is_nearest_certain(x, x_tail, x_error) and (x == 0.0 or abs(x) >= smallest)
            good_y = is_nearest_certain(y, y_tail, y_error) and (y == 0.0 or abs(y) >= smallest)
        out[i, 0] = x + 0.0  # no -0.0
        out[i, 1] = y + 0.0
        if not (good_x and good_y):
            undecided[count] = i
            count += 1
    return count


def _cell(value: mpq, spacing: float) -> float:
    """Return floor(value / spacing + 1/2)."""
    shifted = value / mpq(spacing) + mpq(1, 2)
    return float(int(shifted.numerator) // int(shifted.denominator))


def cells_of(points: FloatArray, grid: tuple[float, float]) -> FloatArray:
    """Return the grid cell of each point: (floor(x / gx + 1/2), floor(y / gy + 1/2)), exact. Spacings are powers of two
    for which all magnitudes divided by them are at most 2^53; what underflows is next to nothing, and lies in cell
    0."""
    scaled = points / np.array(grid)
    floor = np.floor(scaled)
    cells: FloatArray = floor + (scaled - floor >= 0.5) + 0.0
    return cells


class CrossingRounder:
    """Rounds the crossings of segments: to the nearest doubles, or to the cells of a grid.

    Args:
        points: float64 (n, 2), finite.
        segments: int32 (m, 2).
        grid: the spacings of a grid, powers of two as for :func:`cells_of`; None for the nearest doubles.
    """

    def __init__(self, points: FloatArray, segments: IntArray, grid: tuple[float, float] | None = None) -> None:
        self._points, self._segments, self._grid = points, segments, grid
        self._xy, self._context = scaled_into_window(points)
        largest, scaled = float(np.abs(points).max(initial=0.0)), float(np.abs(self._xy).max(initial=0.0))
        self._exponent = math.frexp(largest)[1] - math.frexp(scaled)[1]
        self._scale = np.zeros(2)
        if grid is not None:
            self._scale = np.array([math.ldexp(1.0, self._exponent - math.frexp(g)[1] + 1) for g in grid])

    def _exact(self, first: int, second: int) -> tuple[float, float]:
        """Round one crossing by way of the rationals."""
        (a, b), (c, d) = self._points[self._segments[first]].tolist(), self._points[self._segments[second]].tolist()
        crossing: RationalPoint = segment_crossing(a, b, c, d)
        if self._grid is None:
            nearest = rounded(crossing)
            return nearest.x + 0.0, nearest.y + 0.0
        return _cell(crossing[0], self._grid[0]) + 0.0, _cell(crossing[1], self._grid[1]) + 0.0

    def __call__(self, first: IntArray, second: IntArray) -> FloatArray:
        """Return the rounded crossings of pairs of segments that cross properly, float64 (k, 2): points or cells."""
        out, undecided = np.empty((len(first), 2)), np.empty(_CHUNK, dtype=np.int32)
        left = []
        smallest = _SMALLEST if self._exponent >= 0 else math.ldexp(_SMALLEST, -self._exponent)
        for begin in range(0, len(first), _CHUNK):
            stop = min(begin + _CHUNK, len(first))
            n = _round_range(
                self._context,
                self._xy,
                self._segments,
                first,
                second,
                self._scale,
                smallest,
                begin,
                stop,
                out,
                undecided,
            )
            raise_if_interrupted()
            left += undecided[:n].tolist()
        if self._grid is None and self._exponent:
            out = np.ldexp(out, self._exponent)
        for i in left:
            out[i] = self._exact(int(first[i]), int(second[i]))
        return out
