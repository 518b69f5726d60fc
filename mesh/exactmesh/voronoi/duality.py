"""From triangles to Voronoi cells: circumcentres of cocircular clusters merged, ridges numbered, cells put in order."""

from typing import NamedTuple

import numpy as np

from exactkernel.context import Context, chunk_size, scaled_into_window
from exactkernel.incircle import incircle_adaptive
from exactkernel.jit import jit
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.ordering import IndexArray

__all__ = ["Dual", "dual_of", "first_not_delaunay"]

_CHUNK = 1 << 20  # triangles between two looks at Ctrl-C


class Dual(NamedTuple):
    """The combinatorial Voronoi diagram of a triangulation of a convex hull, or of a domain.

    Attributes:
        vertex: int32 (m,), the Voronoi vertex of each triangle.
        triangle: int32 (v,), the first triangle of each Voronoi vertex.
        edge: int32 (r,), the edge of the triangulation that each ridge is dual to.
        ridge_points, ends: int32 (r, 2), the ends of that edge, and the Voronoi vertices on its left and its right, or
            -1.
        offsets: int64 (n + 1,), where the entries of each cell begin.
        cells, cell_ridges: int32 (2 r,), entry by entry, counterclockwise: a Voronoi vertex, or -1, and the ridge from
            there to that of the next entry.
    """

    vertex: IntArray
    triangle: IntArray
    edge: IntArray
    ridge_points: IntArray
    ends: IntArray
    offsets: IndexArray
    cells: IntArray
    cell_ridges: IntArray


@jit
def _apex(triangles: IntArray, neighbors: IntArray, t: int, i: int) -> int:
    """Return which corner of the neighbor across side i of triangle t is the one off that side."""
    u = neighbors[t, i]
    start = triangles[t, (i + 1) % 3]
    j = 0
    while j < 2 and (neighbors[u, j] != t or triangles[u, (j + 2) % 3] != start):
        j += 1
    return j


@jit
def _incircle_across(k: Context, xy: FloatArray, triangles: IntArray, neighbors: IntArray, t: int, i: int) -> int:
    a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
    d = triangles[neighbors[t, i], _apex(triangles, neighbors, t, i)]
    return incircle_adaptive(
        k, xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1], xy[c, 0], xy[c, 1], xy[d, 0], xy[d, 1]
    )  # fmt: skip


@jit
def _first_conflict(
    k: Context, xy: FloatArray, triangles: IntArray, neighbors: IntArray, first: int, stop: int
) -> int:  # fmt: skip
    for t in range(first, stop):
        for i in range(3):
            if neighbors[t, i] > t and _incircle_across(k, xy, triangles, neighbors, t, i) > 0:
                return 3 * t + i
    return -1


@np.errstate(over="ignore", invalid="ignore")  # interpreted, a numpy scalar warns where a double does not
def first_not_delaunay(points: FloatArray, triangles: IntArray, neighbors: IntArray) -> int:
    """Return 3 t + i for the first side that is not locally Delaunay, or -1. O(m), exact."""
    xy, k = scaled_into_window(points)
    step = chunk_size(k, _CHUNK)
    for first in range(0, len(triangles), step):
        found = int(_first_conflict(k, xy, triangles, neighbors, first, min(first + step, len(triangles))))
        raise_if_interrupted()
        if found >= 0:
            return found
    return -1


@jit
def _root(parent: IntArray, t: int) -> int:
    while parent[t] != t:
        parent[t] = parent[parent[t]]
        t = parent[t]
    return t


@jit
def _merge(
    k: Context, xy: FloatArray, triangles: IntArray, neighbors: IntArray, centres: FloatArray, vertex: IntArray,
    first: IntArray,
) -> int:  # fmt: skip
    """Number the circumcentres, those of one circle alike; return how many there are.

    Triangles of one circle have the same centre, and so the same nearest doubles: only those are tested. ``vertex``
    comes as 0 .. m - 1; ``first`` becomes the first triangle of each.
    """
    for t in range(len(triangles)):
        for i in range(3):
            u = neighbors[t, i]
            if u <= t or centres[t, 0] != centres[u, 0] or centres[t, 1] != centres[u, 1]:
                continue
            if _incircle_across(k, xy, triangles, neighbors, t, i) == 0:
                p, q = _root(vertex, t), _root(vertex, u)
                vertex[max(p, q)] = min(p, q)
    count = 0
    for t in range(len(triangles)):
        root = vertex[t]  # earlier, or t itself: its number is known
        if root == t:
            first[count] = t
            vertex[t] = count
            count += 1
        else:
            vertex[t] = vertex[root]
    return count


@jit
def _ridges(
    triangles: IntArray, neighbors: IntArray, vertex: IntArray, ridge: IntArray, edge: IntArray, points: IntArray,
    ends: IntArray, degree: IndexArray,
) -> int:  # fmt: skip
    """Write the ridges, in the order of the edges, and ``ridge[t, i]``, -1 for an edge whose dual has no length.

    ``degree[v]`` counts the ridges around each site. Returns the number of ridges.
    """
    edges = count = 0
    for t in range(len(triangles)):
        for i in range(3):
            u = neighbors[t, i]
            if u > t:
                continue
            number = -1
            if u < 0 or vertex[u] != vertex[t]:
                number = count
                a, b = triangles[t, (i + 1) % 3], triangles[t, (i + 2) % 3]
                edge[count] = edges
                points[count, 0], points[count, 1] = a, b
                ends[count, 0], ends[count, 1] = vertex[t], -1 if u < 0 else vertex[u]
                degree[a] += 1
                degree[b] += 1
                count += 1
            ridge[t, i] = number
            if u >= 0:
                ridge[u, _apex(triangles, neighbors, t, i)] = number
            edges += 1
    return count


@jit
def _corner(triangles: IntArray, t: int, v: int) -> int:
    i = 0
    while i < 2 and triangles[t, i] != v:
        i += 1
    return i


@jit
def _fan(
    triangles: IntArray, neighbors: IntArray, vertex: IntArray, ridge: IntArray, t: int, i: int, at: int,
    cells: IntArray, cell_ridges: IntArray,
) -> int:  # fmt: skip
    """Write an entry for each ridge around corner i of triangle t, counterclockwise; return where they end."""
    v, begin = triangles[t, i], t
    while True:
        number = ridge[t, (i + 1) % 3]
        if number >= 0:
            cells[at], cell_ridges[at] = vertex[t], number
            at += 1
        t = neighbors[t, (i + 1) % 3]
        if t < 0 or t == begin:
            return at
        i = _corner(triangles, t, v)


@jit
def _fans(
    triangles: IntArray, neighbors: IntArray, vertex: IntArray, ridge: IntArray, at: IndexArray, cells: IntArray,
    cell_ridges: IntArray,
) -> None:  # fmt: skip
    """Write the entries of all cells in the order in which triangles come to their sites, which is kind to caches.

    Those on the boundary first: from ray to ray, and several times where the boundary meets itself. ``at`` comes as
    where each cell begins, and says, by -1 - where it goes on, which cells are begun.
    """
    for t in range(len(triangles)):
        for i in range(3):
            if neighbors[t, i] < 0:
                j = (i + 1) % 3
                v = triangles[t, j]
                begin = at[v] if at[v] >= 0 else -1 - at[v]
                cells[begin], cell_ridges[begin] = -1, ridge[t, i]
                at[v] = -1 - _fan(triangles, neighbors, vertex, ridge, t, j, begin + 1, cells, cell_ridges)
    for t in range(len(triangles)):
        for i in range(3):
            v = triangles[t, i]
            if at[v] >= 0:
                at[v] = -1 - _fan(triangles, neighbors, vertex, ridge, t, i, at[v], cells, cell_ridges)


@np.errstate(over="ignore", invalid="ignore")  # interpreted, a numpy scalar warns where a double does not
def dual_of(points: FloatArray, triangles: IntArray, neighbors: IntArray, centres: FloatArray) -> Dual:
    """Return the dual of a Delaunay triangulation; ``centres`` are the nearest doubles. O(m)."""
    xy, k = scaled_into_window(points)
    m, n = len(triangles), len(points)
    vertex, first = np.arange(m, dtype=np.int32), np.empty(m, dtype=np.int32)
    count = int(_merge(k, xy, triangles, neighbors, centres, vertex, first))
    raise_if_interrupted()
    edges = (3 * m + int((neighbors < 0).sum())) // 2
    edge, ridge = np.empty(edges, dtype=np.int32), np.empty_like(neighbors)
    ridge_points, ends = (np.empty((edges, 2), dtype=np.int32) for _ in range(2))
    offsets = np.zeros(n + 1, dtype=np.int64)
    ridges = int(_ridges(triangles, neighbors, vertex, ridge, edge, ridge_points, ends, offsets[1:]))
    np.cumsum(offsets, out=offsets)
    cells, cell_ridges = (np.empty(2 * ridges, dtype=np.int32) for _ in range(2))
    _fans(triangles, neighbors, vertex, ridge, offsets[:-1].copy(), cells, cell_ridges)
    for array, length in ((first, count), (edge, ridges), (ridge_points, ridges), (ends, ridges)):
        array.resize((length, *array.shape[1:]), refcheck=False)  # no base is left to write to
    return Dual(vertex, first, edge, ridge_points, ends, offsets, cells, cell_ridges)
