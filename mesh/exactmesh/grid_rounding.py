"""A planar straight line graph on a grid of few bits, so that its segments can be halved exactly.

A point's pixel is the cell of the grid that it lies in. Moving every point to the centre of its pixel keeps the graph
as a drawing as long as no two points share a pixel and no segment meets the pixel of a point that is not one of its
ends: that is snap rounding in which nothing has to be bent, and there no point ever passes over a segment. Points that
lie exactly on a segment may stay there. Reference [Guibas 1998].
"""

import math
import operator
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from exactkernel.batch import orient2d_batch
from exactkernel.types import FloatArray, IntArray
from exactmesh.coincident import first_of_each, lexicographic_order
from exactmesh.columns import MarkerArray
from exactmesh.crossings.crossing_points import cells_of
from exactmesh.crossings.hot_pixels import met_pixels
from exactmesh.crossings.search import crossing_pairs
from exactmesh.errors import CrossingError, OptionError, SnappingError

__all__ = ["Rounded", "grid_spacing", "rounded_to_grid"]

_DIGITS = 53
_SMALLEST_EXPONENT = -1074


class Rounded(NamedTuple):
    """Points and seeds on a grid."""

    points: FloatArray
    holes: FloatArray
    regions: FloatArray


def _exponent(value: Fraction) -> int:
    """Return the smallest k with value <= 2^k, of a positive number."""
    k = value.numerator.bit_length() - value.denominator.bit_length()
    return next(e for e in (k - 1, k, k + 1) if value <= Fraction(2) ** e)


def grid_spacing(points: FloatArray, bits: int) -> float:
    """Return the spacing of the grid with this many bits: 2^-bits of the power of two that spans the points; 0 if
    they are at one place.

    Raises:
        OptionError: the bits are not from 1 to 52, or more than the doubles have at these coordinates.
    """
    try:
        count = operator.index(bits)
    except TypeError:
        raise OptionError(f"bits is {bits!r}; expected an integer from 1 to 52") from None
    if not 1 <= count < _DIGITS:
        raise OptionError(f"bits is {count}; expected an integer from 1 to 52")
    if not len(points):
        return 0.0
    low, high = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    extent = max(Fraction(h) - Fraction(w) for w, h in zip(low, high, strict=True))
    if extent == 0:
        return 0.0
    span, reach = _exponent(extent), _exponent(max(abs(Fraction(x)) for x in (*low, *high)))
    most = min(_DIGITS + min(span - reach, 0), span - _SMALLEST_EXPONENT)
    if count > most:
        remedy = "move the origin to the points"
        raise OptionError(f"bits is {count}; there are {max(most, 0)} at coordinates up to 2^{reach}: {remedy}")
    return math.ldexp(1.0, span - count)


def _rounded(points: FloatArray, spacing: float) -> FloatArray:
    return cells_of(points, (spacing, spacing)) * spacing


def _merged(pixel: IntArray, representative: IntArray) -> MarkerArray:
    """Return the pairs of points at different places that share a pixel: (first, later one)."""
    first = representative[pixel]
    later = np.flatnonzero(first != representative)
    later = later[representative[later] == later]
    return np.stack([first[later], later], axis=1).astype(np.int64)


def _met(points: FloatArray, places: FloatArray, segments: IntArray, spacing: float) -> tuple[MarkerArray, MarkerArray]:
    """Return (segment, the first row of ``places`` in a pixel), all pairs where the segment meets the pixel."""
    grid = (spacing, spacing)
    cells = cells_of(places, grid)
    first = first_of_each(cells, lexicographic_order(cells))
    distinct = np.flatnonzero(first == np.arange(len(first)))
    segment, pixel = met_pixels(points[segments[:, 0]], points[segments[:, 1]], cells[distinct], grid)
    return segment, distinct[pixel]


def _run_over(
    points: FloatArray, centres: FloatArray, pixel: IntArray, segments: IntArray, spacing: float
) -> MarkerArray:
    """Return the pairs (segment, point) that come too near: the segment meets the pixel, in which none of its ends is,
    and the point is not on the segment before and after."""
    segment, vertex = _met(points, points, segments, spacing)
    ends = segments[segment]
    other = (pixel[ends] != vertex[:, None]).all(axis=1)
    segment, vertex, ends = segment[other], vertex[other], ends[other]
    off = np.zeros(len(segment), dtype=np.bool_)
    for xy in (points, centres):
        if len(segment):
            off |= orient2d_batch(xy[ends[:, 0]], xy[ends[:, 1]], xy[vertex]) != 0
    return np.stack([segment[off], vertex[off]], axis=1).astype(np.int64)


def rounded_to_grid(
    points: FloatArray,
    segments: IntArray,
    representative: IntArray,
    holes: FloatArray,
    regions: FloatArray,
    bits: int,
) -> Rounded:
    """Return the points and seeds of a graph, moved to the grid of :func:`grid_spacing`.

    Raises:
        OptionError: see there.
        CrossingError: segments cross.
        SnappingError: the graph has features smaller than the cells.
    """
    spacing = grid_spacing(points, bits)
    if spacing == 0.0:
        return Rounded(points, holes, regions)
    pairs = crossing_pairs(points, segments)
    if len(pairs):
        remedy = "snap what exactmesh.crossings.arrange(pslg).pslg is"
        raise CrossingError(pairs, points, segments, remedy=remedy)
    centres, seeds = _rounded(points, spacing), np.concatenate([holes, regions[:, :2]])
    pixel = first_of_each(centres, lexicographic_order(centres))
    merged = _merged(pixel, representative)
    run_over = _run_over(points, centres, pixel, segments, spacing)
    _, seed = _met(points, seeds, segments, spacing)
    if len(merged) or len(run_over) or len(seed):
        near = np.unique(seed)
        h = np.searchsorted(near, len(holes))
        raise SnappingError(spacing, merged=merged, run_over=run_over, holes=near[:h], regions=near[h:] - len(holes))
    moved = _rounded(seeds, spacing)
    return Rounded(centres, moved[: len(holes)], np.hstack([moved[len(holes) :], regions[:, 2:]]))
