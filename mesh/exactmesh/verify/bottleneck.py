"""Chains of edges near a segment: of all that lead from end to end, ever forward, one that stays nearest to it.

Vertices are taken in the order of their distance from the segment's line, beginning with the neighbours of its first
end, until its other end is reached: the last one taken is the bottleneck, and no chain does without one that far.
Within that distance a second search goes, at each vertex, straight to the end if an edge leads there, and else to the
nearest vertex (of equally near ones to that of the smallest index) from which the end can be reached. Comparisons
are exact: of double-doubles where their bounds allow it, of expansions otherwise.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exactkernel.constants import ORIENT2D_BOUND
from exactkernel.context import Context
from exactkernel.crossing import dd_cross
from exactkernel.expansions import determinant_2x2, expansion_sign, expansion_sum, negate, two_diff
from exactkernel.jit import jit
from exactkernel.orient2d import products_difference
from exactkernel.types import FloatArray, IntArray
from exactmesh.verify.links import _LOW, Links
from exactmesh.verify.witness import IndexArray

__all__ = ["NO_CHAIN", "NO_VERTEX", "Search", "empty_search", "find_chains"]

NO_VERTEX = -1  # the ends are joined by an edge
NO_CHAIN = -2


class Search(NamedTuple):
    """Scratch space. What is noted of a vertex is of the segment that is stamped there.

    Attributes:
        known: int32 (n,): stamps where ``high`` and ``error`` are up to date.
        seen: int32 (n,): stamps of what has been on the heap.
        visited: int32 (n,): stamps of what has been on the path.
        high, error: (n,): the cross product with the segment, in the sign of its side, and a bound of its error.
        heap, path: intp (n,).
    """

    known: IntArray
    seen: IntArray
    visited: IntArray
    high: FloatArray
    error: FloatArray
    heap: IndexArray
    path: IndexArray


def empty_search(n: int) -> Search:
    """Return scratch space for n vertices."""
    stamps, keys, lists = np.zeros((3, n), dtype=np.int32), np.empty((2, n)), np.empty((2, n), dtype=np.intp)
    return Search(stamps[0], stamps[1], stamps[2], keys[0], keys[1], lists[0], lists[1])


@jit
def is_ahead(k: Context, line: FloatArray, vx: float, vy: float, wx: float, wy: float) -> bool:
    """Tell whether w lies before v in the direction of the line, strictly."""
    ux, uy, dx, dy = line[2] - line[0], line[3] - line[1], wx - vx, wy - vy
    left, right = ux * dx, uy * dy
    error = ORIENT2D_BOUND * (abs(left) + abs(right))
    if left + right > error:
        return True
    if -(left + right) > error:
        return False
    ux, uxt = two_diff(line[2], line[0])
    uy, uyt = two_diff(line[3], line[1])
    dx, dxt = two_diff(wx, vx)
    dy, dyt = two_diff(wy, vy)
    return (products_difference(ux, uxt, dx, dxt, uy, uyt, -dy, -dyt, k.scratch) & 3) == 2


@jit
def measure(points: FloatArray, line: FloatArray, search: Search, stamp: int, w: int) -> None:
    """Note the cross product of the line and w."""
    if search.known[w] == stamp:
        return
    ux, uxt = two_diff(line[2], line[0])
    uy, uyt = two_diff(line[3], line[1])
    px, pxt = two_diff(points[w, 0], line[0])
    py, pyt = two_diff(points[w, 1], line[1])
    high, low, error = dd_cross(ux, uxt, py, pyt, uy, uyt, px, pxt)
    search.known[w] = stamp
    search.high[w] = abs(high)
    search.error[w] = error + abs(low) + 2.0**-50 * abs(high)


@jit
def cross_expansion(points: FloatArray, line: FloatArray, w: int, h: FloatArray, scratch: FloatArray) -> int:
    """Write the magnitude of the cross product of the line and w into h (16)."""
    ux, uxt = two_diff(line[2], line[0])
    uy, uyt = two_diff(line[3], line[1])
    px, pxt = two_diff(points[w, 0], line[0])
    py, pyt = two_diff(points[w, 1], line[1])
    n = determinant_2x2(ux, uxt, py, pyt, uy, uyt, px, pxt, h, scratch)
    if expansion_sign(h, n) < 0:
        negate(h, n)
    return n


@jit
def compare(k: Context, points: FloatArray, line: FloatArray, search: Search, v: int, w: int) -> int:
    """Return -1, 0, 1 where v is nearer to the line than w, as near, or farther; both are measured."""
    if search.high[v] + search.error[v] < search.high[w] - search.error[w]:
        return -1
    if search.high[w] + search.error[w] < search.high[v] - search.error[v]:
        return 1
    one, other, rest = k.scratch[0:16], k.scratch[16:32], k.scratch[32:]
    n_one = cross_expansion(points, line, v, one, rest)
    n_other = cross_expansion(points, line, w, other, rest)
    negate(other, n_other)
    return expansion_sign(rest, expansion_sum(one, n_one, other, n_other, rest))


@jit
def is_candidate(
    k: Context, points: FloatArray, line: FloatArray, search: Search, stamp: int, limit: float, v: int, w: int
) -> bool:
    """Tell whether w is ahead of v, between the perpendiculars in the segment's ends, and perhaps within the limit."""
    x, y = points[w, 0], points[w, 1]
    if not (
        is_ahead(k, line, points[v, 0], points[v, 1], x, y)
        and is_ahead(k, line, line[0], line[1], x, y)
        and is_ahead(k, line, x, y, line[2], line[3])
    ):
        return False
    measure(points, line, search, stamp, w)
    return bool(search.high[w] - search.error[w] <= limit)


@jit
def push(k: Context, points: FloatArray, line: FloatArray, search: Search, size: int, w: int) -> int:
    """Put w on the heap; return its size."""
    heap, i = search.heap, size
    while i > 0 and compare(k, points, line, search, w, heap[(i - 1) >> 1]) < 0:
        heap[i] = heap[(i - 1) >> 1]
        i = (i - 1) >> 1
    heap[i] = w
    return size + 1


@jit
def pop(k: Context, points: FloatArray, line: FloatArray, search: Search, size: int) -> int:
    """Take the nearest vertex from a heap of this size."""
    heap, nearest = search.heap, search.heap[0]
    last, size, i = heap[size - 1], size - 1, 0
    while 2 * i + 1 < size:
        child = 2 * i + 1
        if child + 1 < size and compare(k, points, line, search, heap[child + 1], heap[child]) < 0:
            child += 1
        if compare(k, points, line, search, last, heap[child]) <= 0:
            break
        heap[i] = heap[child]
        i = child
    heap[i] = last
    return int(nearest)


@jit
def bottleneck(
    k: Context, points: FloatArray, links: Links, line: FloatArray, search: Search, stamp: int, limit: float, a: int,
    b: int,
) -> int:  # fmt: skip
    """Return the farthest vertex on the nearest chain from a to b, NO_VERTEX or NO_CHAIN."""
    v, size, farthest = a, 0, NO_VERTEX
    while True:
        for i in range(2 * links.first[v], 2 * links.last[v]):
            w = links.slots[i >> 1] & _LOW if i & 1 else links.slots[i >> 1] >> 32
            if w == b and is_ahead(k, line, points[v, 0], points[v, 1], points[b, 0], points[b, 1]):
                return farthest
            if w != b and search.seen[w] != stamp and is_candidate(k, points, line, search, stamp, limit, v, w):
                search.seen[w] = stamp
                size = push(k, points, line, search, size, w)
        if size == 0:
            return NO_CHAIN
        v = pop(k, points, line, search, size)
        size -= 1
        if farthest == NO_VERTEX or compare(k, points, line, search, v, farthest) > 0:
            farthest = v


@jit
def next_vertex(
    k: Context, points: FloatArray, links: Links, line: FloatArray, search: Search, stamp: int, limit: float,
    farthest: int, v: int, b: int,
) -> int:  # fmt: skip
    """Return b if an edge leads there, else the nearest vertex ahead that has not been visited, or -1."""
    best = -1
    for i in range(2 * links.first[v], 2 * links.last[v]):
        w = links.slots[i >> 1] & _LOW if i & 1 else links.slots[i >> 1] >> 32
        if w == b and is_ahead(k, line, points[v, 0], points[v, 1], points[b, 0], points[b, 1]):
            return b
        if w == b or search.visited[w] == stamp or farthest < 0:
            continue
        if not is_candidate(k, points, line, search, stamp, limit, v, w):
            continue
        if compare(k, points, line, search, w, farthest) > 0:
            continue
        order = -1 if best < 0 else compare(k, points, line, search, w, best)
        if order < 0 or (order == 0 and w < best):
            best = int(w)
    return best


@jit
def walk(
    k: Context, points: FloatArray, links: Links, line: FloatArray, search: Search, stamp: int, limit: float,
    farthest: int, a: int, b: int,
) -> int:  # fmt: skip
    """Write the chain into the path, given its bottleneck; return how many vertices it has."""
    top = 0
    search.path[0] = a
    while search.path[top] != b:
        w = next_vertex(k, points, links, line, search, stamp, limit, farthest, search.path[top], b)
        if w < 0:
            top -= 1  # a dead end; there is a way, so that the path does not run empty
            continue
        search.visited[w] = stamp
        top += 1
        search.path[top] = w
    return top + 1


@jit
def find_chains(
    k: Context,
    points: FloatArray,
    links: Links,
    lines: FloatArray,
    limits: FloatArray,
    ends: IndexArray,
    search: Search,
    farthest: IndexArray,
    crosses: FloatArray,
    start: IndexArray,
    vertices: npt.NDArray[np.intp],
    begin: int,
    end: int,
) -> int:
    """Find the chains of the segments from ``begin`` to ``end``; return where ``vertices`` ran full, or ``end``."""
    for s in range(begin, end):
        line, stamp, a, b = lines[s], s + 1, ends[s, 0], ends[s, 1]
        farthest[s] = bottleneck(k, points, links, line, search, stamp, limits[s], a, b)
        n = 0
        if farthest[s] != NO_CHAIN:
            n = walk(k, points, links, line, search, stamp, limits[s], farthest[s], a, b)
        if start[s] + n > len(vertices):
            for v in range(len(search.known)):  # the same stamp will come again
                search.known[v] = search.seen[v] = search.visited[v] = 0
            return s
        crosses[s, 0] = search.high[farthest[s]] if farthest[s] >= 0 else 0.0
        crosses[s, 1] = search.error[farthest[s]] if farthest[s] >= 0 else 0.0
        for i in range(n):
            vertices[start[s] + i] = search.path[i]
        start[s + 1] = start[s] + n
    return end
