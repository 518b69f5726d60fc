"""What follows from an array of triangles: neighbors, edges, hull, and the rings of its quad-edge."""

import numpy as np
import numpy.typing as npt

from exactkernel.context import Context, scaled_into_window
from exactkernel.jit import jit, jit_inline
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.edgealgebra import EdgeArray, dest, link_ring, origin, splice
from exactmesh.errors import TopologyError

BoolArray = npt.NDArray[np.bool_]

__all__ = ["check_corners", "check_neighbors", "edges_of", "loops_of", "neighbors_of", "planar_rings_of", "rings_of"]


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
def _next_on_boundary(triangles: IntArray, neighbors: IntArray, side: int) -> int:
    """Return the open side that follows an open one round the same fan; side 3 t + i is opposite corner i."""
    t, i = side // 3, side % 3
    pivot = triangles[t, (i + 2) % 3]
    i = (i + 1) % 3
    while neighbors[t, i] >= 0:
        t, i = neighbors[t, i], 0
        while triangles[t, (i + 1) % 3] != pivot:
            i += 1
    return 3 * t + i


@jit
def _trace_loops(
    triangles: IntArray, neighbors: IntArray, open_: IntArray, seen: BoolArray, place: IntArray, path: IntArray,
    loops: IntArray, starts: IntArray,
) -> int:  # fmt: skip
    """Write the boundary as simple loops, one after the other, and where each starts; return how many there are.

    ``open_`` are the sides without a neighbor, ``seen`` (of all sides) is False and ``place`` (of all vertices) -1. The
    walk keeps the domain on its left; where it comes to a vertex again, it has closed a loop.
    """
    count = written = 0
    for first in open_:
        height, side = 0, first
        while not seen[side]:
            seen[side] = True
            v = triangles[side // 3, (side + 1) % 3]
            if place[v] >= 0:
                height, count, written = _close(place, path, height, place[v], loops, starts, count, written)
            place[v] = height
            path[height] = v
            height += 1
            side = _next_on_boundary(triangles, neighbors, side)
        if height:
            height, count, written = _close(place, path, height, 0, loops, starts, count, written)
    return count


@jit
def _close(
    place: IntArray, path: IntArray, height: int, base: int, loops: IntArray, starts: IntArray, count: int, written: int
) -> tuple[int, int, int]:
    """Take what is on the path from base on as a loop; return (height of the path, loops, vertices written)."""
    starts[count] = written
    for i in range(base, height):
        loops[written] = path[i]
        place[path[i]] = -1
        written += 1
    return base, count + 1, written


def loops_of(points: FloatArray, triangles: IntArray, neighbors: IntArray) -> tuple[IntArray, ...]:
    """Return the boundary as simple loops with the triangles on their left, int32 each. O(m).

    Outer loops are counterclockwise, holes clockwise; loops that touch in a vertex are separate. Each starts with its
    lexicographically smallest vertex, and they come in the order of those.
    """
    open_ = np.flatnonzero(neighbors.reshape(-1) < 0).astype(np.int32)
    path, loops, starts = (np.empty(len(open_) + 1, dtype=np.int32) for _ in range(3))
    seen, place = np.zeros(neighbors.size, dtype=np.bool_), np.full(len(points), -1, dtype=np.int32)
    count = _trace_loops(triangles, neighbors, open_, seen, place, path, loops, starts)
    starts[count] = len(open_)
    rank = np.empty(len(points), dtype=np.int64)
    on_loops = loops[: len(open_)]
    order = np.lexsort((points[on_loops, 1], points[on_loops, 0]))
    rank[on_loops[order]] = np.arange(len(open_))
    parts = [loops[starts[i] : starts[i + 1]] for i in range(count)]
    turned = [np.concatenate(np.split(part, [rank[part].argmin()])[::-1]) for part in parts]
    return tuple(sorted(turned, key=lambda loop: (int(rank[loop[0]]), int(rank[loop[1]]))))


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


@jit_inline
def _is_between(k: Context, xy: FloatArray, o: int, a: int, p: int, b: int) -> bool:
    """Tell whether, turning counterclockwise round o from a to b, one meets p; the three directions differ."""
    ax, ay, bx, by, ox, oy = xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1], xy[o, 0], xy[o, 1]
    from_a = orient2d_adaptive(k, ox, oy, ax, ay, xy[p, 0], xy[p, 1]) > 0
    to_b = orient2d_adaptive(k, ox, oy, xy[p, 0], xy[p, 1], bx, by) > 0
    return (from_a and to_b) if orient2d_adaptive(k, ox, oy, ax, ay, bx, by) > 0 else (from_a or to_b)


@jit
def _join_fans(k: Context, xy: FloatArray, ring: EdgeArray, vertex: EdgeArray, face: EdgeArray, gap: EdgeArray) -> None:
    """Make one ring of the rings at each vertex, in the order of their directions.

    ``gap`` (n,), all -1, becomes for each vertex on the boundary an edge that leaves it with OUTSIDE on its left.
    """
    for half in range(len(face)):
        e = 2 * half
        if face[(e ^ 3) >> 1] != -1:
            continue
        v = origin(vertex, e)
        g = gap[v]
        gap[v] = e
        if g < 0:
            continue
        first = g
        while not _is_between(k, xy, v, dest(vertex, g), dest(vertex, e), dest(vertex, ring[g])):
            g = ring[g]
            while face[(g ^ 3) >> 1] != -1:
                g = ring[g]
            if g == first:  # never, unless triangles overlap
                break
        splice(ring, g, e)


@np.errstate(over="ignore", invalid="ignore")  # interpreted, a numpy scalar warns where a double does not
def planar_rings_of(
    points: FloatArray, triangles: IntArray, neighbors: IntArray
) -> tuple[EdgeArray, EdgeArray, EdgeArray]:
    """Return what :func:`rings_of` does, with one ring at a vertex where the boundary meets itself.

    O(m), and O(d^2) where d such pieces of the boundary meet.
    """
    ring, vertex, face = rings_of(triangles, neighbors)
    xy, k = scaled_into_window(points)
    _join_fans(k, xy, ring, vertex, face, np.full(len(points), -1, dtype=np.int32))
    raise_if_interrupted()
    return ring, vertex, face
