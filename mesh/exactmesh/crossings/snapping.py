"""Snap rounding where it is needed: segments that rounding does not make planar are drawn on a grid.

A pixel is hot if a vertex of a segment to be snapped lies in it: an end, a crossing, or an end of another segment. All
that lies in a hot pixel moves to its centre, and each segment, snapped or not, is led through the centres of all hot
pixels that it meets. What is left of the vertices in between stays where it was, on segments that are not snapped.

Pieces of two snapped segments may coincide but not cross, and none passes through the centre of a pixel that its
segment does not meet: if it did, the offsets of the segment from its two centres, both within a pixel, would put some
point of the segment within the same offset of that third centre. So what still meets wrongly has a part that is not
snapped, and snapping that too comes to an end: at the latest where everything is. Each chain stays within half a
pixel's diagonal of its segment. Reference [Hobby 1999], [Guibas 1998].
"""

import math

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray
from exactmesh.coincident import first_of_each, lexicographic_order
from exactmesh.crossings.chains import Chains
from exactmesh.crossings.crossing_points import cells_of
from exactmesh.crossings.hot_pixels import met_pixels
from exactmesh.crossings.noding import Drawing, LongArray, distinct_places, met_in, pieces_in

__all__ = ["bent", "grid_of", "snapped"]

BoolArray = npt.NDArray[np.bool_]


def _spacing(largest: float) -> float:
    return math.ulp(largest) if largest else 1.0


def grid_of(points: FloatArray) -> tuple[float, float]:
    """Return the finest spacings in x and y, powers of two, for which all grid points in the points' bounding box are
    doubles: the distances between doubles at the largest magnitudes."""
    x, y = np.abs(points).max(axis=0, initial=0.0).tolist()
    return _spacing(x), _spacing(y)


def _rows_in(places: FloatArray, cells: FloatArray) -> LongArray:
    """Return the row in ``cells``, which are distinct, of each place; -1 for none."""
    together = np.concatenate([cells, places])
    first = first_of_each(together, lexicographic_order(together))[len(cells) :].astype(np.int64)
    return np.where(first < len(cells), first, -1)


def _hot_pixels(
    drawing: Drawing, is_snapped: BoolArray, rows: LongArray, grid: tuple[float, float]
) -> tuple[FloatArray, int]:
    """Return the hot pixels, and in how many of them segments cross. ``rows`` are all segments near the snapped."""
    nothing = np.empty(0, dtype=np.int64)
    pieces = pieces_in(drawing._replace(segment=nothing, vertex=nothing).chains(rows), rows)
    found = met_in(drawing.given, pieces, grid)
    vertices = np.concatenate([drawing.segments[is_snapped].reshape(-1), found.vertex[is_snapped[found.segment]]])
    places = found.places[found.place[is_snapped[found.segment_of_place]]]
    hot, _ = distinct_places(np.concatenate([cells_of(drawing.given[vertices], grid), places]))
    return hot, int(np.count_nonzero(_rows_in(found.places, hot) >= 0))


def snapped(
    drawing: Drawing, is_snapped: BoolArray, rows: LongArray, grid: tuple[float, float]
) -> tuple[Drawing, int, LongArray]:
    """Return the drawing with some segments snapped, the number of crossings, and the segments that changed.

    Args:
        drawing: nothing in it is snapped.
        is_snapped: bool (s,), which segments are to be.
        rows: those, and all others whose boxes, widened by the grid's spacings, meet the boxes of those.
        grid: see :func:`grid_of`.
    """
    hot, crossings = _hot_pixels(drawing, is_snapped, rows, grid)
    segment, pixel = met_pixels(drawing.begins[rows], drawing.finishes[rows], hot, grid)
    segment = rows[segment]
    vertices = np.unique(drawing.segments[rows])
    row = _rows_in(cells_of(drawing.given[vertices], grid), hot)
    at, inside = row[row >= 0], vertices[row >= 0]
    centre = len(drawing.points) + np.arange(len(hot))
    centre[at[::-1]] = inside[::-1]  # of the points in one pixel the first stands for all
    points = np.concatenate([drawing.points, hot * np.array(grid)])
    moves_to = np.arange(len(drawing.given))
    moves_to[inside] = centre[at]
    representative = moves_to[drawing.representative].astype(np.int32)
    moved = np.flatnonzero(np.isin(drawing.representative, inside))
    points[centre] = hot * np.array(grid)
    points[moved] = points[representative[moved]]
    near = np.flatnonzero(np.isin(drawing.segment, rows))
    is_hot = is_snapped[drawing.segment[near]]
    is_hot |= _rows_in(cells_of(drawing.points[drawing.vertex[near]], grid), hot) >= 0
    gone = drawing.vertex[near[is_hot]]
    gone = gone[(gone >= len(drawing.given)) & ~np.isin(gone, drawing.crossings)]
    is_hot |= np.isin(drawing.vertex[near], gone)
    dropped = near[is_hot]
    kept = np.delete(np.arange(len(drawing.segment)), dropped)
    changed = np.unique(np.concatenate([np.flatnonzero(is_snapped), segment, drawing.segment[dropped]]))
    crossings += len(np.intersect1d(drawing.crossings, drawing.vertex[kept]))
    result = drawing._replace(
        points=points,
        representative=representative,
        segment=np.concatenate([drawing.segment[kept], segment]),
        vertex=np.concatenate([drawing.vertex[kept], centre[pixel]]),
    )
    return result, crossings, changed


def bent(drawing: Drawing, chains: Chains, rows: LongArray) -> LongArray:
    """Return those of some segments whose chains turn back, or do not lead from end to end.

    Rounding to doubles keeps the order of vertices along a segment, and so does snapping, but not one beside the other.
    """
    ends = drawing.representative[drawing.segments[rows]]
    first, last = chains.vertices[chains.start[:-1]], chains.vertices[chains.start[1:] - 1]
    wrong = (first != ends[:, 0]) | (last != ends[:, 1])
    at = drawing.given[drawing.segments[rows]]
    direction = np.sign(np.subtract(0.5 * at[:, 1], 0.5 * at[:, 0]))
    owner = np.repeat(np.arange(len(rows)), np.diff(chains.start))
    inner = owner[1:] == owner[:-1]
    where = drawing.points[chains.vertices]
    forward = (where[1:] > where[:-1]).astype(np.int8) - (where[1:] < where[:-1])
    turns = inner & (forward * direction[owner[1:]] < 0).any(axis=1)
    wrong[owner[1:][turns]] = True
    found: LongArray = rows[wrong]
    return found
