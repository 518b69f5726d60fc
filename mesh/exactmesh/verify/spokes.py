"""The neighbours of vertices of large degree, sorted by angle, so that a chain finds its way through them quickly.

A bundle of k segments through one vertex would otherwise look at all of its neighbours k times.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exactkernel.context import Context
from exactkernel.jit import jit
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray
from exactmesh.verify.boundary import lexicographically_before
from exactmesh.verify.links import _LOW, Links
from exactmesh.verify.witness import IndexArray

__all__ = ["Spokes", "first_spoke", "spokes_of"]

_LARGE = 64  # triangles round a vertex


class Spokes(NamedTuple):
    """Sorted neighbours.

    Attributes:
        vertices: intp (k,): the vertices of large degree, ascending.
        first: intp (k + 1,): the neighbours of vertices[i] are ends[first[i] : first[i + 1]].
        ends: intp: first those lexicographically after the vertex, from below to above, then those before it, from
            above to below; nearer ones before others in the same direction.
    """

    vertices: IndexArray
    first: IndexArray
    ends: IndexArray


@jit
def precedes(k: Context, points: FloatArray, v: int, a: int, b: int) -> int:
    """Return -1, 0, 1 where a comes before, together with, or after b on the way round v."""
    after_a, after_b = lexicographically_before(points, v, a), lexicographically_before(points, v, b)
    if after_a != after_b:
        return -1 if after_a else 1
    return -orient2d_adaptive(k, points[v, 0], points[v, 1], points[a, 0], points[a, 1], points[b, 0], points[b, 1])


@jit
def comes_first(k: Context, points: FloatArray, v: int, a: int, b: int) -> bool:
    """Tell whether a comes before b, by direction, then distance."""
    order = precedes(k, points, v, a, b)
    if order != 0:
        return bool(order < 0)
    if lexicographically_before(points, v, a):
        return lexicographically_before(points, a, b)
    return lexicographically_before(points, b, a)


@jit
def merge_runs(
    k: Context, points: FloatArray, v: int, source: IndexArray, target: IndexArray, begin: int, end: int, width: int
) -> None:
    """Merge neighbouring sorted runs of a width."""
    low = begin
    while low < end:
        middle, high = min(low + width, end), min(low + 2 * width, end)
        i, j = low, middle
        for out in range(low, high):
            if j >= high or (i < middle and not comes_first(k, points, v, source[j], source[i])):
                target[out] = source[i]
                i += 1
            else:
                target[out] = source[j]
                j += 1
        low = high


@jit
def sort_spokes(
    k: Context, points: FloatArray, links: Links, v: int, begin: int, ends: IndexArray, spare: IndexArray
) -> None:
    """Write the neighbours of v, each as often as it occurs, sorted."""
    end = begin
    for i in range(links.first[v], links.last[v]):
        ends[end] = links.slots[i] >> 32
        ends[end + 1] = links.slots[i] & _LOW
        end += 2
    width = 1
    while width < end - begin:
        merge_runs(k, points, v, ends, spare, begin, end, width)
        for i in range(begin, end):
            ends[i] = spare[i]
        width *= 2


@jit
def first_spoke(k: Context, points: FloatArray, spokes: Spokes, v: int, b: int) -> int:
    """Return the nearest neighbour of v in the direction of b, -1 if there is none, -2 if v has no sorted ones."""
    low, high = 0, len(spokes.vertices)
    while low < high:
        middle = (low + high) >> 1
        if spokes.vertices[middle] < v:
            low = middle + 1
        else:
            high = middle
    if low == len(spokes.vertices) or spokes.vertices[low] != v:
        return -2
    low, high = spokes.first[low], spokes.first[low + 1]
    end = high
    while low < high:
        middle = (low + high) >> 1
        if precedes(k, points, v, spokes.ends[middle], b) < 0:
            low = middle + 1
        else:
            high = middle
    return int(spokes.ends[low]) if low < end and precedes(k, points, v, spokes.ends[low], b) == 0 else -1


def spokes_of(context: Context, points: FloatArray, links: Links) -> Spokes:
    """Sort the neighbours of all vertices of large degree. O(d log d) for degree d."""
    degrees: npt.NDArray[np.int64] = links.last - links.first
    vertices = np.flatnonzero(degrees >= _LARGE)
    first = np.zeros(len(vertices) + 1, dtype=np.intp)
    np.cumsum(2 * degrees[vertices], out=first[1:])
    ends, spare = np.empty((2, int(first[-1])), dtype=np.intp)
    for i, v in enumerate(vertices.tolist()):
        sort_spokes(context, points, links, v, int(first[i]), ends, spare)
        raise_if_interrupted()
    return Spokes(vertices, first, ends)
