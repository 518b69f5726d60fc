"""Sibson's coordinates of a point in a Delaunay triangulation, compiled: what its cell would take from each neighbor.

The triangles whose circumcircles contain the point q are its cavity. From a vertex b of the cavity's boundary, between
a and c on it, the cell of q takes the polygon of the centres of qab, of the cavity's triangles at b, and of qbc. All
centres are taken relative to q in double-double, and so are the areas: the slimmer the cells, the more bits are lost.
Where all areas together may err by more than 2^-50 of their sum, the rationals answer.
"""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exactkernel.centre import circumcentre_in_pairs
from exactkernel.constants import DD_BOUND
from exactkernel.context import Context
from exactkernel.crossing import dd_cross
from exactkernel.doubledouble import dd_add
from exactkernel.incircle import incircle_adaptive
from exactkernel.jit import jit
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.types import FloatArray, IntArray
from exactmesh.ordering import IndexArray

__all__ = ["Room", "coordinates_of", "room_for"]

FlagArray = npt.NDArray[np.bool_]

_ENOUGH = 2.0**-50


class Room(NamedTuple):
    """Scratch space, and where the answers go.

    Attributes:
        stamp: int32 (m,), for each triangle the query whose cavity it was in last; -1.
        place: int32 (m,), and where in it.
        cavity: int32 (m,), the triangles of the cavity.
        centres: float64 (m, 4), their centres relative to the query, as pairs (x, x tail, y, y tail).
        errors: float64 (m,), bounds of what is wrong about those.
        polygon: float64 (21,): the first and the last corner of a polygon, twice its area as a pair, the largest
            coordinate and the largest error of all corners, their number; two corners more.
    """

    stamp: IntArray
    place: IntArray
    cavity: IntArray
    centres: FloatArray
    errors: FloatArray
    polygon: FloatArray


def room_for(m: int) -> Room:
    """Return scratch space for m triangles."""
    integers = (np.full(m, -1, dtype=np.int32), np.empty(m, dtype=np.int32), np.empty(m, dtype=np.int32))
    return Room(*integers, np.empty((m, 4)), np.empty(m), np.empty(21))


@jit
def _centre(
    k: Context, xy: FloatArray, a: int, b: int, c: int, x: float, y: float, centre: FloatArray
) -> float:  # fmt: skip
    """Write the centre of a, b, c relative to (x, y); return a bound of the error of its coordinates."""
    px, pxt, px_error, py, pyt, py_error = circumcentre_in_pairs(
        k, xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1], xy[c, 0], xy[c, 1]
    )  # fmt: skip
    centre[0], centre[1] = dd_add(px, pxt, -x, 0.0)
    centre[2], centre[3] = dd_add(py, pyt, -y, 0.0)
    return float(max(px_error, py_error) + DD_BOUND * max(abs(centre[0]), abs(centre[2])))


@jit
def _dig(
    k: Context, xy: FloatArray, triangles: IntArray, neighbors: IntArray, room: Room, start: int, query: int, q: int
) -> int:
    """Collect the cavity of vertex q, the query of that number, from a triangle on; return its size."""
    x, y = xy[q, 0], xy[q, 1]
    room.stamp[start], room.place[start], room.cavity[0] = query, 0, start
    size, done = 1, 0
    while done < size:
        t = room.cavity[done]
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        room.errors[done] = _centre(k, xy, a, b, c, x, y, room.centres[done])
        done += 1
        for i in range(3):
            u = neighbors[t, i]
            if u < 0 or room.stamp[u] == query:
                continue
            a, b, c = triangles[u, 0], triangles[u, 1], triangles[u, 2]
            if (
                incircle_adaptive(k, xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1], xy[c, 0], xy[c, 1], x, y) > 0
            ):  # fmt: skip
                room.stamp[u], room.place[u], room.cavity[size] = query, size, u
                size += 1
    return size


@jit
def _add_cross(polygon: FloatArray, p: FloatArray, q: FloatArray) -> None:
    high, low, _ = dd_cross(p[0], p[1], q[2], q[3], p[2], p[3], q[0], q[1])
    polygon[8], polygon[9] = dd_add(polygon[8], polygon[9], high, low)


@jit
def _begin(polygon: FloatArray, corner: FloatArray) -> None:
    """Begin a polygon with a corner: first, last, twice the area as a pair; polygon[10:13] goes on."""
    for i in range(4):
        polygon[i] = polygon[4 + i] = corner[i]
    polygon[8] = polygon[9] = 0.0


@jit
def _go(polygon: FloatArray, corner: FloatArray, error: float) -> None:
    """Go on to the next corner; remember the largest coordinate, the largest error and how many corners there were."""
    _add_cross(polygon, polygon[4:8], corner)
    for i in range(4):
        polygon[4 + i] = corner[i]
    polygon[10] = max(polygon[10], max(abs(corner[0]), abs(corner[2])))
    polygon[11] = max(polygon[11], error)
    polygon[12] += 1.0


@jit
def _corner_of(triangles: IntArray, t: int, v: int) -> int:
    i = 0
    while i < 2 and triangles[t, i] != v:
        i += 1
    return i


@jit
def _rim(neighbors: IntArray, room: Room, size: int, query: int) -> tuple[int, int]:
    """Return a triangle and a side on the boundary of the cavity."""
    for j in range(size):
        t = room.cavity[j]
        for i in range(3):
            u = neighbors[t, i]
            if u < 0 or room.stamp[u] != query:
                return t, i
    return -1, -1


@jit
def _areas(
    k: Context, xy: FloatArray, triangles: IntArray, neighbors: IntArray, room: Room, size: int, query: int, q: int,
    sites: IntArray, weights: FloatArray, at: int,
) -> int:  # fmt: skip
    """Write the vertices of the cavity's boundary, clockwise, and the area that q takes from each, twice.

    Returns where they end. ``room.polygon`` tells what to expect of the errors.
    """
    x, y, polygon = xy[q, 0], xy[q, 1], room.polygon
    centre, before = polygon[13:17], polygon[17:21]
    polygon[10] = polygon[11] = polygon[12] = 0.0
    first_t, first_i = _rim(neighbors, room, size, query)
    t, i = first_t, first_i
    polygon[11] = _centre(k, xy, q, triangles[t, (i + 1) % 3], triangles[t, (i + 2) % 3], x, y, before)
    polygon[10] = max(abs(before[0]), abs(before[2]))
    while True:
        b, j = triangles[t, (i + 2) % 3], (i + 2) % 3
        _begin(polygon, before)
        while True:  # round b, through the cavity
            _go(polygon, room.centres[room.place[t]], room.errors[room.place[t]])
            i = (j + 2) % 3
            u = neighbors[t, i]
            if u < 0 or room.stamp[u] != query:
                break
            t = u
            j = _corner_of(triangles, t, b)
        error = _centre(k, xy, q, b, triangles[t, (j + 1) % 3], x, y, centre)
        _go(polygon, centre, error)
        _add_cross(polygon, centre, polygon[0:4])
        sites[at], weights[at] = b, max(-polygon[8], 0.0)
        at += 1
        for axis in range(4):
            before[axis] = centre[axis]
        if t == first_t and i == first_i:
            return at


@jit
def _on_vertex_or_hull(
    k: Context, xy: FloatArray, triangles: IntArray, neighbors: IntArray, t: int, q: int, sites: IntArray,
    weights: FloatArray, at: int,
) -> int:  # fmt: skip
    """Write the coordinates of a point that is a vertex of triangle t, or lies on the hull; return where they end."""
    for i in range(3):
        v = triangles[t, i]
        if xy[v, 0] == xy[q, 0] and xy[v, 1] == xy[q, 1]:
            sites[at], weights[at] = v, 1.0
            return at + 1
    for i in range(3):
        a, b = triangles[t, (i + 1) % 3], triangles[t, (i + 2) % 3]
        if neighbors[t, i] < 0 and (
            orient2d_adaptive(k, xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1], xy[q, 0], xy[q, 1]) == 0
        ):  # fmt: skip
            axis = 0 if abs(0.5 * xy[b, 0] - 0.5 * xy[a, 0]) >= abs(0.5 * xy[b, 1] - 0.5 * xy[a, 1]) else 1
            before, after = abs(0.5 * xy[q, axis] - 0.5 * xy[a, axis]), abs(0.5 * xy[b, axis] - 0.5 * xy[q, axis])
            sites[at], weights[at] = a, after / (before + after)
            sites[at + 1], weights[at + 1] = b, before / (before + after)
            return at + 2
    return at


@jit
def coordinates_of(
    k: Context, xy: FloatArray, triangles: IntArray, neighbors: IntArray, room: Room, found: IntArray, first: int,
    stop: int, offsets: IndexArray, sites: IntArray, weights: FloatArray, open_: FlagArray,
) -> int:  # fmt: skip
    """Write the natural neighbors of queries first .. stop - 1, which are the last rows of xy, and their coordinates.

    ``offsets[i]`` is where those of query i begin. ``open_[i]``: that is for the rationals to do; it has none here.
    Returns the first query that there was no room for.
    """
    n = len(xy) - len(found)
    at = offsets[first]
    for query in range(first, stop):
        t, q = found[query], n + query
        if at + 2 > len(sites):
            return query
        end = at if t < 0 else _on_vertex_or_hull(k, xy, triangles, neighbors, t, q, sites, weights, at)
        if t >= 0 and end == at:
            size = _dig(k, xy, triangles, neighbors, room, t, query, q)
            if at + size + 2 > len(sites):  # a polygon of that many triangles has two corners more
                for j in range(size):
                    room.stamp[room.cavity[j]] = -1
                return query
            end = _areas(k, xy, triangles, neighbors, room, size, query, q, sites, weights, at)
            total = 0.0
            for j in range(at, end):
                total += weights[j]
            radius, error, corners = room.polygon[10], room.polygon[11], room.polygon[12]
            if not (8.0 * corners * radius * (error + DD_BOUND * radius) <= _ENOUGH * total < math.inf):
                open_[query] = True
                end = at
            for j in range(at, end):
                weights[j] /= total
        at = end
        offsets[query + 1] = at
    return stop
