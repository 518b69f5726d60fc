"""The edges of a triangulation that segments run along, when they are there already."""

import numpy as np

from exactkernel.context import chunk_size
from exactkernel.jit import jit, jit_inline
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import IntArray
from exactmesh.constrain import find_edge
from exactmesh.edgealgebra import EdgeArray, dest
from exactmesh.ordering import IndexArray
from exactmesh.plane import Plane, is_ahead, orient

__all__ = ["edges_along"]

_CHUNK = 1 << 15  # segments between two looks at Ctrl-C, where predicates are fast


@jit_inline
def straight_edge(plane: Plane, a: int, b: int) -> int:
    """Return the edge that leaves a straight toward b, or -1."""
    first = e = int(plane.spoke[a])
    while True:
        v = dest(plane.org, e)
        if v != plane.ghost and orient(plane, a, b, v) == 0 and is_ahead(plane.xy, a, b, v):
            return e
        e = int(plane.ring[e])
        if e == first:
            return -1


@jit
def follow_range(
    plane: Plane, ends: IndexArray, first: int, stop: int, pieces: EdgeArray, count: int
) -> tuple[int, int, bool]:
    """Follow the segments first .. stop - 1 from edge to edge; return (next one, pieces so far, whether it is lost).

    Row after row, ``pieces`` (p, 2) becomes (edge, segment); where it is full, ``ends`` keeps what is left to do.
    """
    for s in range(first, stop):
        a, b = ends[s, 0], ends[s, 1]
        while a != b:
            if count == len(pieces):
                ends[s, 0], ends[s, 1] = a, b
                return s, count, False
            e, swapped = find_edge(plane, a, b)
            if e < 0:
                a, b = (b, a) if swapped else (a, b)
                e = straight_edge(plane, a, b)
                if e < 0:
                    return s, count, True
            pieces[count, 0], pieces[count, 1] = e >> 2, s
            count += 1
            a = dest(plane.org, e)
    return stop, count, False


@np.errstate(over="ignore", invalid="ignore")  # interpreted, a numpy scalar warns where a double does not
def edges_along(plane: Plane, segments: IntArray) -> tuple[EdgeArray, IndexArray]:
    """Return rows (edge, segment), int32, of segments that are chains of edges; and the segments that are none."""
    left = segments.astype(np.int64)
    pieces, missing = np.empty((len(left) + 16, 2), dtype=np.int32), []
    turn = count = 0
    size = chunk_size(plane.k, _CHUNK)
    while turn < len(left):
        turn, count, lost = follow_range(plane, left, turn, min(turn + size, len(left)), pieces, count)
        raise_if_interrupted()
        if lost:
            missing.append(turn)
            turn += 1
        if count == len(pieces):
            pieces = np.concatenate([pieces, np.empty_like(pieces)])
    return pieces[:count], np.array(missing, dtype=np.int64)
