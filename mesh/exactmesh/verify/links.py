"""The links of the vertices: for each vertex, the directed edges opposite to it. Combinatorics and local
Delaunay in one.

The directed edge v -> b has one slot for each triangle (v, b, c) that lists it, in the bucket of v, sorted by
b and c; of a quadrilateral (v, b, x, c) the slot is the same. So a directed edge that occurs twice makes two
neighbouring slots, and the cell on the other side of the edge (v, b) is the slot of v whose c is this b. No hash, no
sort but within a bucket: linear time for bounded degrees.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exactkernel.context import Context, chunk_size
from exactkernel.incircle import incircle_adaptive
from exactkernel.jit import jit
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.verify.witness import IndexArray

__all__ = [
    "BOUNDARY",
    "CROWDED",
    "INNER",
    "NOT_DELAUNAY",
    "REPEATED",
    "Links",
    "ends_of",
    "linked",
    "slots_of",
]

# What a slot (v, b, c) says about its directed edge v -> b.
INNER = 0  # matched by one b -> v
BOUNDARY = 1  # no b -> v
REPEATED = 2  # v -> b occurred before in this bucket
CROWDED = 3  # matched by more than one b -> v
NOT_DELAUNAY = 4  # INNER, v < b, and the far corner lies inside the circle of (v, b, c)

_CHUNK = 1 << 15  # vertices between two looks at Ctrl-C
_LARGE = 64  # buckets from this size on are sorted by numpy: insertion is for the small ones
_LOW = 0xFFFFFFFF

LongArray = npt.NDArray[np.int64]


class Links(NamedTuple):
    """The slots of all vertices.

    Attributes:
        first: int64 (n + 1,): the slots of v are first[v] .. first[v + 1] - 1.
        slots: int64 (3m + 4k,): b * 2^32 + c, ascending within a vertex.
        kinds: int8 (3m + 4k,): INNER, BOUNDARY, ...
    """

    first: LongArray
    slots: LongArray
    kinds: npt.NDArray[np.int8]


@jit
def count_corners(triangles: IntArray, degrees: LongArray) -> None:
    """Count the triangles at each vertex."""
    for t in range(len(triangles)):
        degrees[triangles[t, 0]] += 1
        degrees[triangles[t, 1]] += 1
        degrees[triangles[t, 2]] += 1


@jit
def fill_slots(triangles: IntArray, ends: LongArray, slots: LongArray) -> None:
    """Fill each bucket from its end, so that ``ends`` turns into the beginnings."""
    for t in range(len(triangles)):
        a, b, c = np.int64(triangles[t, 0]), np.int64(triangles[t, 1]), np.int64(triangles[t, 2])
        ends[a] -= 1
        slots[ends[a]] = (b << 32) | c
        ends[b] -= 1
        slots[ends[b]] = (c << 32) | a
        ends[c] -= 1
        slots[ends[c]] = (a << 32) | b


@jit
def count_quad_corners(quads: IntArray, degrees: LongArray) -> None:
    """Count the quadrilaterals at each vertex."""
    for q in range(len(quads)):
        for i in range(4):
            degrees[quads[q, i]] += 1


@jit
def fill_quad_slots(quads: IntArray, ends: LongArray, slots: LongArray) -> None:
    """Go on filling each bucket from its end."""
    for q in range(len(quads)):
        for i in range(4):
            v, b, c = quads[q, i], np.int64(quads[q, (i + 1) & 3]), np.int64(quads[q, (i + 3) & 3])
            ends[v] -= 1
            slots[ends[v]] = (b << 32) | c


@jit
def sort_bucket(slots: LongArray, begin: int, end: int) -> None:
    """Sort by insertion: small buckets, or sorted ones."""
    for i in range(begin + 1, end):
        slot = slots[i]
        j = i
        while j > begin and slots[j - 1] > slot:
            slots[j] = slots[j - 1]
            j -= 1
        slots[j] = slot


@jit
def slot_of(slots: LongArray, begin: int, end: int, b: int) -> int:
    """Return the first slot of the bucket whose edge leads to b, or -1."""
    low, high = begin, end
    while low < high:
        middle = (low + high) >> 1
        if slots[middle] >> 32 < b:
            low = middle + 1
        else:
            high = middle
    return low if low < end and slots[low] >> 32 == b else -1


@jit
def match_slots(k: Context, points: FloatArray, links: Links, circles: bool, v_begin: int, v_end: int) -> None:
    """Sort the buckets of some vertices and tell the kinds of their slots, NOT_DELAUNAY only with ``circles``."""
    first, slots, kinds = links
    for v in range(v_begin, v_end):
        begin, end = first[v], first[v + 1]
        sort_bucket(slots, begin, end)
        for i in range(begin, end):
            kinds[i] = REPEATED if i > begin and slots[i - 1] >> 32 == slots[i] >> 32 else BOUNDARY
        for i in range(begin, end):
            b = slots[i] & _LOW
            j = slot_of(slots, begin, end, b)
            if j < 0:
                continue
            if kinds[j] != BOUNDARY:
                kinds[j] = CROWDED
                continue
            kinds[j] = INNER
            if circles and v < b and (j + 1 == end or kinds[j + 1] != REPEATED):
                c, d = slots[j] & _LOW, slots[i] >> 32
                if incircle_adaptive(
                    k, points[v, 0], points[v, 1], points[b, 0], points[b, 1],
                    points[c, 0], points[c, 1], points[d, 0], points[d, 1],
                ) > 0:  # fmt: skip
                    kinds[j] = NOT_DELAUNAY


def linked(points: FloatArray, context: Context, triangles: IntArray, quads: IntArray) -> Links:
    """Return the links of all vertices. Linear time but for sorting the buckets of vertices of large
    degree. Where there are quadrilaterals no slot is NOT_DELAUNAY."""
    first = np.zeros(len(points) + 1, dtype=np.int64)
    count_corners(triangles, first)
    count_quad_corners(quads, first)
    large = np.flatnonzero(first >= _LARGE)
    np.cumsum(first, out=first)
    size, circles = 3 * len(triangles) + 4 * len(quads), not len(quads)
    links = Links(first, np.empty(size, np.int64), np.empty(size, np.int8))
    fill_slots(triangles, first, links.slots)
    fill_quad_slots(quads, first, links.slots)
    for v in large:
        links.slots[first[v] : first[v + 1]].sort()
    step = chunk_size(context, _CHUNK)
    for begin in range(0, len(points), step):
        match_slots(context, points, links, circles, begin, min(begin + step, len(points)))
        raise_if_interrupted()
    return links


def slots_of(links: Links, kind: int) -> IndexArray:
    """Return the slots of one kind."""
    return np.flatnonzero(links.kinds == kind)


def ends_of(links: Links, slots: IndexArray) -> tuple[IndexArray, IndexArray, IndexArray]:
    """Return v, b, c of slots: their triangles, from the corner of the bucket on."""
    packed = links.slots[slots]
    return np.searchsorted(links.first, slots, side="right") - 1, packed >> 32, packed & _LOW
