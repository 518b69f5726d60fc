"""The links of the vertices: for each vertex, the directed edges opposite to it. Combinatorics and local
Delaunay in one.

The directed edge v -> b has one slot for each triangle (v, b, c) that lists it, in the bucket of v; for a quadrilateral
(v, b, x, c) it is the same. The cell on the other side of the edge (v, b) is the slot of v whose c is this b; a table
over all points tells where in the bucket that is, read back before it is trusted, so that it need not be cleared
between vertices. No hash, and no sort but of large buckets, which others search, and of those with an edge that occurs
twice. Linear time for bounded degrees.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exactkernel.context import Context, chunk_size
from exactkernel.incircle import incircle_adaptive
from exactkernel.jit import jit, jit_inline
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.verify.local import Local
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
_LARGE = 64  # buckets from this size on are sorted by numpy, and searched by halving
_LOW = 0xFFFFFFFF

LongArray = npt.NDArray[np.int64]
KindArray = npt.NDArray[np.int8]


class Links(NamedTuple):
    """The slots of all vertices.

    Attributes:
        first, last: int64 (n,): the slots of v are first[v] .. last[v] - 1.
        order: int32 (k,): the corners in the order of their buckets.
        starts: int64 (k,): where these begin.
        slots: int64 (3m + 4k,): b * 2^32 + c; ascending within a vertex that has 64 or more, or a repeated edge.
        kinds: int8 (3m + 4k,): INNER, BOUNDARY, ...
    """

    first: LongArray
    last: LongArray
    order: IntArray
    starts: LongArray
    slots: LongArray
    kinds: KindArray


class Table(NamedTuple):
    """What :func:`match_slots` knows about the bucket at hand.

    Attributes:
        place: int32 (k,): where in the bucket the edge to each point is, if that slot's edge leads there.
        near: float64 (d, 2): the coordinates of the ends of the bucket's edges, d the largest degree.
    """

    place: IntArray
    near: FloatArray


@jit
def count_corners(triangles: IntArray, degrees: LongArray) -> None:
    """Count the triangles at each vertex."""
    for t in range(len(triangles)):
        degrees[triangles[t, 0]] += 1
        degrees[triangles[t, 1]] += 1
        degrees[triangles[t, 2]] += 1


@jit
def fill_slots(triangles: IntArray, first: LongArray, slots: LongArray) -> None:
    """Fill each bucket from its end, so that ``first`` turns into the beginnings."""
    for t in range(len(triangles)):
        a, b, c = np.int64(triangles[t, 0]), np.int64(triangles[t, 1]), np.int64(triangles[t, 2])
        first[a] -= 1
        slots[first[a]] = (b << 32) | c
        first[b] -= 1
        slots[first[b]] = (c << 32) | a
        first[c] -= 1
        slots[first[c]] = (a << 32) | b


@jit
def count_quad_corners(quads: IntArray, degrees: LongArray) -> None:
    """Count the quadrilaterals at each vertex."""
    for q in range(len(quads)):
        for i in range(4):
            degrees[quads[q, i]] += 1


@jit
def fill_quad_slots(quads: IntArray, first: LongArray, slots: LongArray) -> None:
    """Go on filling each bucket from its end."""
    for q in range(len(quads)):
        for i in range(4):
            v, b, c = quads[q, i], np.int64(quads[q, (i + 1) & 3]), np.int64(quads[q, (i + 3) & 3])
            first[v] -= 1
            slots[first[v]] = (b << 32) | c


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
    if end - begin < _LARGE:
        while low < end and slots[low] >> 32 != b:
            low += 1
        return low if low < end else -1
    while low < high:
        middle = (low + high) >> 1
        if slots[middle] >> 32 < b:
            low = middle + 1
        else:
            high = middle
    return low if low < end and slots[low] >> 32 == b else -1


@jit_inline
def place_slots(points: FloatArray, slots: LongArray, begin: int, end: int, table: Table) -> bool:
    """Write down where in the bucket each edge is, and the far ends' coordinates; tell whether an edge occurs twice."""
    place, near = table
    repeated = False
    for i in range(begin, end):
        b = slots[i] >> 32
        j = begin + place[b]
        repeated |= j < i and slots[j] >> 32 == b
        place[b] = i - begin
        near[i - begin, 0] = points[b, 0]
        near[i - begin, 1] = points[b, 1]
    return repeated


@jit
def mark_repeated(points: FloatArray, slots: LongArray, kinds: KindArray, begin: int, end: int, table: Table) -> None:
    """Sort the bucket, so that the same edges are neighbours, and leave the first of them in the table."""
    if end - begin < _LARGE:
        sort_bucket(slots, begin, end)
    place_slots(points, slots, begin, end, table)
    for i in range(end - 1, begin, -1):
        if slots[i - 1] >> 32 == slots[i] >> 32:
            kinds[i] = REPEATED
            table.place[slots[i] >> 32] = i - 1 - begin


@jit
def match_slots(
    k: Context,
    local: Local,
    first: LongArray,
    slots: LongArray,
    kinds: KindArray,
    table: Table,
    v_begin: int,
    v_end: int,
) -> None:
    """Tell the kinds of the slots of some vertices, all of which are BOUNDARY yet. Vertices have local numbers. With
    quadrilaterals none is NOT_DELAUNAY."""
    points, order = local.points, local.order
    circles = len(local.quads) == 0
    place, near = table
    for v in range(v_begin, v_end):
        begin, end = first[v], first[v + 1]
        if place_slots(points, slots, begin, end, table):
            mark_repeated(points, slots, kinds, begin, end, table)
        for i in range(begin, end):
            b = slots[i] & _LOW
            j = begin + place[b]
            if j >= end or slots[j] >> 32 != b:
                continue
            if kinds[j] != BOUNDARY:
                kinds[j] = CROWDED
                continue
            kinds[j] = INNER
            if circles and order[v] < order[b] and (j + 1 == end or kinds[j + 1] != REPEATED):
                c = slots[j] & _LOW
                far = begin + place[c]
                cx, cy = near[place[c], 0], near[place[c], 1]
                if far >= end or slots[far] >> 32 != c:  # only where the fan of v ends
                    cx, cy = points[c, 0], points[c, 1]
                if incircle_adaptive(
                    k, points[v, 0], points[v, 1], near[j - begin, 0], near[j - begin, 1],
                    cx, cy, near[i - begin, 0], near[i - begin, 1],
                ) > 0:  # fmt: skip
                    kinds[j] = NOT_DELAUNAY


@jit
def name_slots(order: IntArray, slots: LongArray) -> None:
    """Put the numbers of points for local ones."""
    for i in range(len(slots)):
        slots[i] = (np.int64(order[slots[i] >> 32]) << 32) | order[slots[i] & _LOW]


def linked(n: int, context: Context, local: Local) -> Links:
    """Return the links of all n vertices. Linear time but for sorting the buckets of vertices of large degree, and of
    those with repeated edges."""
    corners, size = len(local.order), local.triangles.size + local.quads.size
    first = np.zeros(corners + 1, dtype=np.int64)
    count_corners(local.triangles, first)
    if len(local.quads):  # else there is no need to compile it
        count_quad_corners(local.quads, first)
    most, large = int(first.max()), np.flatnonzero(first >= _LARGE)
    np.cumsum(first, out=first)
    slots, kinds = np.empty(size, dtype=np.int64), np.full(size, BOUNDARY, dtype=np.int8)
    fill_slots(local.triangles, first, slots)
    if len(local.quads):
        fill_quad_slots(local.quads, first, slots)
    for v in large:
        bucket = slots[first[v] : first[v + 1]]
        bucket[:] = bucket[np.argsort(local.order[bucket >> 32], kind="stable")]
    table = Table(np.zeros(corners, dtype=np.int32), np.empty((most, 2)))
    step = chunk_size(context, _CHUNK)
    for begin in range(0, corners, step):
        match_slots(context, local, first, slots, kinds, table, begin, min(begin + step, corners))
        raise_if_interrupted()
    name_slots(local.order, slots)
    ends = np.zeros((2, n), dtype=np.int64)
    ends[0, local.order], ends[1, local.order] = first[:-1], first[1:]
    return Links(ends[0], ends[1], local.order, first[:-1], slots, kinds)


def slots_of(links: Links, kind: int) -> IndexArray:
    """Return the slots of one kind."""
    return np.flatnonzero(links.kinds == kind)


def ends_of(links: Links, slots: IndexArray) -> tuple[IndexArray, IndexArray, IndexArray]:
    """Return v, b, c of slots: their triangles, from the corner of the bucket on."""
    packed = links.slots[slots]
    corner = np.searchsorted(links.starts, slots, side="right") - 1
    return links.order[corner].astype(np.intp), packed >> 32, packed & _LOW
