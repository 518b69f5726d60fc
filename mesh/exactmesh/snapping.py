"""Snap rounding: the arrangement drawn on a grid, planar whatever happens.

A pixel is hot if a vertex of the exact arrangement lies in it: a point of the input, or a crossing. All vertices move
to the centres of their pixels, and each segment is led through the centres of all hot pixels that it meets. Pieces may
then coincide but not cross, and none passes through the centre of a pixel that its segment does not meet: if it did,
the offsets of the segment from its two centres, both within a pixel, would put some point of the segment within the
same offset of that third centre. Each chain stays within half a pixel's diagonal of its segment. Reference [Hobby
1999], [Guibas 1998].
"""

import math

import numpy as np

from exactkernel.types import FloatArray, IntArray
from exactmesh.chains import pieces_of
from exactmesh.coincident import first_of_each, lexicographic_order
from exactmesh.crossing_points import CrossingRounder, cells_of
from exactmesh.hot_pixels import met_pixels
from exactmesh.noding import Graph, alone_of, chains_in, placed_meetings, with_places

__all__ = ["grid_of", "snap"]


def _spacing(largest: float) -> float:
    return math.ulp(largest) if largest else 1.0


def grid_of(points: FloatArray) -> tuple[float, float]:
    """Return the finest spacings in x and y, powers of two, for which all grid points in the points' bounding box are
    doubles: the distances between doubles at the largest magnitudes."""
    x, y = np.abs(points).max(axis=0, initial=0.0).tolist()
    return _spacing(x), _spacing(y)


def snap(points: FloatArray, segments: IntArray, representative: IntArray) -> Graph:
    """Return the planar graph of the snapped segments. Arguments as for :func:`exactmesh.noding.node_by_rounding`."""
    grid = grid_of(points)
    items = np.concatenate([segments, alone_of(representative, segments)])
    found = placed_meetings(points, items, CrossingRounder(points, items, grid))
    given = cells_of(points, grid)
    merged = first_of_each(given, lexicographic_order(given))
    used = np.flatnonzero(merged == np.arange(len(merged)))
    cells, _ = with_places(given, used, found.places)
    used = np.concatenate([used, np.arange(len(given), len(cells))])
    begins, ends = points[segments[:, 0]], points[segments[:, 1]]
    segment, pixel = met_pixels(begins, ends, cells[used], grid)
    chains = chains_in(cells, used, begins, ends, segment, used[pixel])
    return Graph(cells * np.array(grid), merged, chains, pieces_of(chains), len(found.places), 1)
