"""Clipping a Voronoi diagram to a convex window: the cells that its boundary cuts are put together from arcs of it and
chains of their own vertices, the others are inside as a whole, or outside.
"""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from exactkernel.bisector import bisector_crossing
from exactkernel.context import Context, bits_of, exponent_into_window, make_context
from exactkernel.coordinates import rational_point
from exactkernel.jit import jit
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.coincident import lexicographic_order
from exactmesh.ordering import IndexArray
from exactmesh.plane import BoolArray
from exactmesh.seeds import inside_hull
from exactmesh.voronoi.cells import Cells, CornerKind, KindArray, exact_crossing
from exactmesh.voronoi.centres import nearest_doubles
from exactmesh.voronoi.walk import COLUMNS, nearest_site, other_site, walk_around

__all__ = ["Diagram", "clipped_to_window", "placed", "without_repetitions"]

_VERTEX, _CROSSING, _WINDOW = int(CornerKind.VERTEX), int(CornerKind.CROSSING), int(CornerKind.WINDOW)
_SMALLEST_SAFE = 2.0**-1021  # below it, scaling back may round a second time


class Diagram(NamedTuple):
    """What clipping needs of a Voronoi diagram; see :class:`exactmesh.Voronoi`. ``vertex_sites`` is in ``Cells``."""

    points: FloatArray
    vertices: FloatArray
    vertex_sites: IntArray
    ridge_points: IntArray
    offsets: IndexArray
    cells: IntArray
    cell_ridges: IntArray


@jit
def _put(
    kinds: KindArray, sources: IntArray, neighbors: IntArray, at: int, kind: int, source: int, neighbor: int
) -> int:
    kinds[at], sources[at], neighbors[at] = kind, source, neighbor
    return at + 1


@jit
def _arc(
    ridge_points: IntArray, cell_ridges: IntArray, sides: int, visit: IndexArray, kinds: KindArray, sources: IntArray,
    neighbors: IntArray, at: int, crossings: IntArray, count: int,
) -> tuple[int, int]:  # fmt: skip
    """Write the corners of the window's boundary on one visit; return (corners, crossings) written so far."""
    s, came, first, at_first, left, last, at_last = visit[0], visit[1], visit[2], visit[3], visit[4], visit[5], visit[6]
    if came < 0:
        for side in range(sides):
            at = _put(kinds, sources, neighbors, at, _WINDOW, side, -1 - side)
        return at, count
    side = first % sides
    if at_first == 1:
        at = _put(kinds, sources, neighbors, at, _WINDOW, side, -1 - side)
    else:
        crossings[count, 0], crossings[count, 1] = s, other_site(ridge_points, cell_ridges[came], s)
        crossings[count, 2] = side
        at = _put(kinds, sources, neighbors, at, _CROSSING, count, -1 - side)
        count += 1
    for e in range(first + 1, last + 1):
        side = e % sides
        at = _put(kinds, sources, neighbors, at, _WINDOW, side, -1 - side)
    beyond = other_site(ridge_points, cell_ridges[left], s)
    if at_last == 1:
        neighbors[at - 1] = beyond
    else:
        crossings[count, 0], crossings[count, 1], crossings[count, 2] = s, beyond, last % sides
        at = _put(kinds, sources, neighbors, at, _CROSSING, count, beyond)
        count += 1
    return at, count


@jit
def _assemble(
    ridge_points: IntArray, offsets: IndexArray, cells: IntArray, cell_ridges: IntArray, sides: int, sites: IntArray,
    visits: IndexArray, bounds: IndexArray, kinds: KindArray, sources: IntArray, neighbors: IntArray,
    crossings: IntArray,
) -> tuple[int, int]:  # fmt: skip
    """Write the polygons of sites, each with its range of visits, and their ``bounds``; return (corners, crossings)."""
    at = count = row = 0
    for p in range(len(sites)):
        s = sites[p]
        begin, end = offsets[s], offsets[s + 1]
        bounds[p] = at
        head = row
        while row < len(visits) and visits[row, 0] == s:
            at, count = _arc(
                ridge_points, cell_ridges, sides, visits[row], kinds, sources, neighbors, at, crossings, count
            )  # fmt: skip
            j = visits[row, 4]
            row += 1
            goal = visits[row, 1] if row < len(visits) and visits[row, 0] == s else visits[head, 1]
            while j != goal:
                j = j + 1 if j + 1 < end else begin
                beyond = other_site(ridge_points, cell_ridges[j], s)
                at = _put(kinds, sources, neighbors, at, _VERTEX, cells[j], beyond)
        if row == head:  # not cut
            for j in range(begin, end):
                beyond = other_site(ridge_points, cell_ridges[j], s)
                at = _put(kinds, sources, neighbors, at, _VERTEX, cells[j], beyond)
    bounds[len(sites)] = at
    return at, count


@jit
def _place_crossings(
    k: Context, xy: FloatArray, window: FloatArray, crossings: IntArray, places: FloatArray, open_: BoolArray
) -> None:
    for i in range(len(crossings)):
        s, p, a = crossings[i, 0], crossings[i, 1], crossings[i, 2]
        b = (a + 1) % len(window)
        places[i, 0], places[i, 1], certain = bisector_crossing(
            k, xy[s, 0], xy[s, 1], xy[p, 0], xy[p, 1], window[a, 0], window[a, 1], window[b, 0], window[b, 1]
        )  # fmt: skip
        open_[i] = not certain


def _visits(d: Diagram, k: Context, xy: FloatArray, window: FloatArray) -> IndexArray:
    """Walk around the window; return the visits that have a length, by site, and in their order."""
    with np.errstate(over="ignore"):
        middle = ((xy - window[0]) ** 2).sum(axis=1)
    start = int(np.argmin(middle))  # a guess
    corner = window[0].tolist()
    start = int(nearest_site(k, xy, d.offsets, d.cell_ridges, d.ridge_points, start, *corner))
    room = 4 * math.isqrt(len(xy)) + 4 * len(window) + 64
    while True:
        visits = np.empty((room, COLUMNS), dtype=np.int64)
        count = int(walk_around(k, xy, d.offsets, d.cell_ridges, d.ridge_points, window, start, visits))
        raise_if_interrupted()
        if count >= 0:
            break
        room *= 4
    visits = visits[:count].compress(visits[:count, 7] == 0, axis=0)
    return visits.take(np.argsort(visits[:, 0], kind="stable"), axis=0)


def _crossing_places(
    d: Diagram, k: Context, xy: FloatArray, scaled: FloatArray, exponent: int, window: FloatArray, crossings: IntArray
) -> FloatArray:
    """Return the crossings as the nearest doubles."""
    places, open_ = np.empty((len(crossings), 2)), np.zeros(len(crossings), dtype=np.bool_)
    _place_crossings(k, xy, scaled, crossings, places, open_)
    if exponent:
        places = np.ldexp(places, -exponent)
        open_ |= ~((np.abs(places) < np.inf) & (np.abs(places) >= _SMALLEST_SAFE)).all(axis=1)
    for i in np.flatnonzero(open_).tolist():
        s, p, a = crossings[i].tolist()
        given = (*d.points[[s, p]].tolist(), *window[[a, (a + 1) % len(window)]].tolist())
        places[i] = nearest_doubles(exact_crossing(*map(rational_point, given)))
    return places


@np.errstate(over="ignore", invalid="ignore", under="ignore", divide="ignore")  # interpreted, numpy scalars warn
def clipped_to_window(d: Diagram, window: FloatArray) -> Cells:
    """Return the cells inside of a convex window, counterclockwise. O(n log k) for a window of k sides.

    The walk takes O(k + c) for c entries of cells that are visited, counted as often as they are.
    """
    both = np.concatenate([d.points, window])
    exponent = exponent_into_window(*bits_of(both))
    scaled = np.ldexp(both, exponent) if exponent else both
    k, n, sides = make_context(scaled), len(d.points), len(window)
    xy, frame = scaled[:n], scaled[n:]
    visits = _visits(d, k, xy, frame)
    chosen = inside_hull(window, lexicographic_order(window), d.points).astype(np.bool_)
    chosen[visits[:, 0]] = True
    sites = np.flatnonzero(chosen).astype(np.int32)
    room = int((d.offsets[sites + 1] - d.offsets[sites]).sum()) + 4 * len(visits) + 2 * sides
    kinds, (sources, neighbors) = np.empty(room, dtype=np.int8), (np.empty(room, dtype=np.int32) for _ in range(2))
    crossings, bounds = np.empty((2 * len(visits), 3), dtype=np.int32), np.empty(len(sites) + 1, dtype=np.int64)
    size, count = _assemble(
        d.ridge_points, d.offsets, d.cells, d.cell_ridges, sides, sites, visits, bounds, kinds, sources, neighbors,
        crossings,
    )  # fmt: skip
    for array in (kinds, sources, neighbors):
        array.resize(size, refcheck=False)  # no base is left to write to
    crossings = crossings[:count]
    places = _crossing_places(d, k, xy, frame, exponent, window, crossings)
    corners = placed(kinds, sources, {_VERTEX: d.vertices, _CROSSING: places, _WINDOW: window})
    nobody = np.empty((0, 2), dtype=np.int32)
    cells = Cells(
        d.points, sites, bounds, corners, neighbors, kinds, sources, window, d.vertex_sites, crossings, nobody
    )  # fmt: skip
    return without_repetitions(cells)


@jit
def _place(
    kinds: KindArray, sources: IntArray, begins: IndexArray, places: FloatArray, corners: FloatArray
) -> None:  # fmt: skip
    for j in range(len(kinds)):
        i = begins[kinds[j]] + sources[j]
        corners[j, 0], corners[j, 1] = places[i, 0], places[i, 1]


def placed(kinds: KindArray, sources: IntArray, places: Mapping[int, FloatArray]) -> FloatArray:
    """Return the coordinates of corners, float64 (c, 2), given those of the sources of each kind."""
    begins = np.zeros(len(CornerKind), dtype=np.int64)
    begins[list(places)] = np.cumsum([0, *map(len, places.values())])[:-1]
    corners = np.empty((len(kinds), 2))
    _place(kinds, sources, begins, np.concatenate(list(places.values())), corners)
    return corners


@jit
def _repetitions(offsets: IndexArray, corners: FloatArray, found: IndexArray) -> int:
    """Write the corners that are followed by one with the same coordinates, as far as they fit; return how many."""
    count = 0
    for p in range(len(offsets) - 1):
        for j in range(offsets[p], offsets[p + 1]):
            after = j + 1 if j + 1 < offsets[p + 1] else offsets[p]
            if corners[j, 0] == corners[after, 0] and corners[j, 1] == corners[after, 1]:
                if count < len(found):
                    found[count] = j
                count += 1
    return count


def without_repetitions(cells: Cells) -> Cells:
    """Return the same cells without edges of no length: where the nearest doubles agree, rationals decide."""
    count = int(_repetitions(cells.offsets, cells.corners, np.empty(0, dtype=np.int64)))
    same = np.empty(count, dtype=np.int64)
    _repetitions(cells.offsets, cells.corners, same)
    polygon = np.searchsorted(cells.offsets, same, side="right") - 1
    after = np.where(same + 1 < cells.offsets[polygon + 1], same + 1, cells.offsets[polygon])
    pairs = zip(same.tolist(), after.tolist(), strict=True)
    again = [j for j, following in pairs if cells.exact_corner(j) == cells.exact_corner(following)]
    if not again:
        return cells
    kept = np.ones(len(cells.corners), dtype=np.bool_)
    kept[again] = False
    offsets = np.concatenate([[0], np.cumsum(kept)])[cells.offsets]
    columns = (cells.corners[kept], cells.neighbors[kept], cells.kinds[kept], cells.sources[kept])
    rest = (cells.window, cells.vertex_sites, cells.crossings, cells.midpoints)
    return Cells(cells.points, cells.sites, offsets, *columns, *rest)
