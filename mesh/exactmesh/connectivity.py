"""What follows from an array of triangles: neighbors, edges, hull, and the rings of its quad-edge."""

import numpy as np

from exactkernel.jit import jit
from exactkernel.types import FloatArray, IntArray
from exactmesh.edgealgebra import EdgeArray, link_ring
from exactmesh.errors import TopologyError

__all__ = ["check_corners", "check_neighbors", "edges_of", "hull_of", "neighbors_of", "rings_of"]


def check_corners(triangles: IntArray) -> None:
    """Refuse triangles that are none: the loops below would leave their arrays.

    Raises:
        TopologyError: a corner is negative or repeated; ``indices`` names the triangles.
    """
    a, b, c = triangles.T
    bad = np.flatnonzero((triangles.min(axis=1, initial=0) < 0) | (a == b) | (b == c) | (c == a))
    if bad.size:
        t = int(bad[0])
        fault = "has a negative corner" if triangles[t].min() < 0 else "repeats a corner"
        raise TopologyError(f"triangle {t} {tuple(triangles[t].tolist())} {fault}", indices=bad.tolist())


@jit
def _first_bad_neighbor(triangles: IntArray, neighbors: IntArray) -> int:
    """Return 3 t + i for the first entry that the other side does not confirm, or -1."""
    for t in range(len(triangles)):
        for i in range(3):
            u = neighbors[t, i]
            if u == -1:
                continue
            if u < 0 or u >= len(triangles):
                return 3 * t + i
            start, stop = triangles[t, (i + 1) % 3], triangles[t, (i + 2) % 3]
            confirmed = False
            for j in range(3):
                if triangles[u, (j + 1) % 3] == stop and triangles[u, (j + 2) % 3] == start:
                    confirmed = neighbors[u, j] == t
            if not confirmed:
                return 3 * t + i
    return -1


def check_neighbors(triangles: IntArray, neighbors: IntArray) -> None:
    """Refuse neighbors that are not mutual. O(m).

    Raises:
        TopologyError: an entry is no triangle with the same edge backwards and this one as its neighbor; ``indices``
            names the triangle.
    """
    if len(neighbors) != len(triangles):
        raise TopologyError(f"{len(neighbors)} rows of neighbors for {len(triangles)} triangles")
    bad = int(_first_bad_neighbor(triangles, neighbors))
    if bad >= 0:
        t, i = divmod(bad, 3)
        raise TopologyError(
            f"triangle {t} is not the neighbor of neighbors[{t}, {i}] = {neighbors[t, i]} across their edge",
            indices=[t],
        )


def neighbors_of(triangles: IntArray) -> IntArray:
    """Return the triangle across the edge opposite to each corner, int32 (m, 3), -1 where there is none. O(m log m).

    Raises:
        TopologyError: a directed edge is in two triangles: they overlap, or one is clockwise.
    """
    start = np.roll(triangles, -1, axis=1).reshape(-1).astype(np.int64)
    end = np.roll(triangles, -2, axis=1).reshape(-1).astype(np.int64)
    size = int(triangles.max(initial=0)) + 1
    forward, backward = start * size + end, end * size + start
    order = np.argsort(forward)
    ranked = forward[order]
    twice = np.flatnonzero(ranked[1:] == ranked[:-1])
    if twice.size:
        first, second = sorted(order[twice[0] : twice[0] + 2].tolist())
        raise TopologyError(
            f"triangles {first // 3} and {second // 3} both have the edge {start[first]} -> {end[first]}",
            indices=[first // 3, second // 3],
        )
    place = np.searchsorted(ranked, backward)
    place[place == len(ranked)] = 0
    found = ranked[place] == backward
    neighbors: IntArray = np.where(found, order[place] // 3, -1).astype(np.int32).reshape(-1, 3)
    return neighbors


def edges_of(triangles: IntArray, neighbors: IntArray) -> IntArray:
    """Return each edge once, int32 (k, 2), with the triangle of the larger number on its left. O(m)."""
    own = np.arange(len(triangles), dtype=np.int32)[:, None] > neighbors
    starts, ends = np.roll(triangles, -1, axis=1), np.roll(triangles, -2, axis=1)
    return np.stack([starts[own], ends[own]], axis=1)


@jit
def _follow(after: IntArray, cycle: IntArray) -> None:
    """Fill the cycle from its first vertex on."""
    for i in range(1, len(cycle)):
        cycle[i] = after[cycle[i - 1]]


def hull_of(points: FloatArray, triangles: IntArray, neighbors: IntArray) -> IntArray:
    """Return the boundary cycle, int32, counterclockwise from its lexicographically smallest vertex. O(m)."""
    rows, corners = np.nonzero(neighbors < 0)
    starts, ends = triangles[rows, (corners + 1) % 3], triangles[rows, (corners + 2) % 3]
    after = np.empty(len(points), dtype=np.int32)
    after[starts] = ends
    cycle = np.empty(len(starts), dtype=np.int32)
    cycle[0] = starts[np.lexsort((points[starts, 1], points[starts, 0]))[0]]
    _follow(after, cycle)
    return cycle


@jit
def _fill_rings(
    triangles: IntArray, neighbors: IntArray, quarter: EdgeArray, ring: EdgeArray, vertex: EdgeArray, face: EdgeArray
) -> int:
    """Write the quad-edge of the triangles; return the number of edges. ``quarter`` (m, 3) is scratch.

    ``quarter[t, i]`` becomes the edge opposite to corner i that has triangle t on its left.
    """
    edges = 0
    for t in range(len(triangles)):
        for i in range(3):
            u = neighbors[t, i]
            start, stop = triangles[t, (i + 1) % 3], triangles[t, (i + 2) % 3]
            if u >= 0 and u < t:
                j = 0
                while triangles[u, (j + 1) % 3] != stop or triangles[u, (j + 2) % 3] != start:
                    j += 1
                e = quarter[u, j] ^ 2
            else:
                e = 4 * edges
                edges += 1
                face[(e ^ 1) >> 1] = -1
            quarter[t, i] = e
            vertex[e >> 1] = start
            vertex[(e ^ 2) >> 1] = stop
            face[(e ^ 3) >> 1] = t
    for t in range(len(triangles)):
        for i in range(3):
            link_ring(ring, quarter[t, i], quarter[t, (i + 1) % 3])
    for t in range(len(triangles)):
        for i in range(3):
            if neighbors[t, i] < 0:  # the next hull edge clockwise: turn round the start, through triangles
                start, u, j = triangles[t, (i + 1) % 3], t, (i + 2) % 3
                while neighbors[u, j] >= 0:
                    u, j = neighbors[u, j], 0
                    while triangles[u, (j + 2) % 3] != start:
                        j += 1
                link_ring(ring, quarter[t, i] ^ 2, quarter[u, j] ^ 2)
    return edges


def rings_of(triangles: IntArray, neighbors: IntArray) -> tuple[EdgeArray, EdgeArray, EdgeArray]:
    """Return (ring, vertex, face) as :meth:`QuadEdge.from_arrays` takes them. O(m)."""
    hull = int((neighbors < 0).sum())
    edges = (3 * len(triangles) + hull) // 2
    ring = np.empty(4 * edges, dtype=np.int32)
    vertex = np.empty(2 * edges, dtype=np.int32)
    face = np.empty(2 * edges, dtype=np.int32)
    _fill_rings(triangles, neighbors, np.empty_like(neighbors), ring, vertex, face)
    return ring, vertex, face
