"""Segment insertion."""

import numpy as np
import numpy.typing as npt

from exactkernel.jit import jit
from exactkernel.types import IntArray
from exactmesh.cavity import split_along
from exactmesh.plane import Plane, march, toward
from exactmesh.edgealgebra import EdgeArray, dest

PieceArray = npt.NDArray[np.int32]


@jit
def first_spokes(org: EdgeArray, edges: int, spoke: EdgeArray) -> None:
    """Write an edge that leaves each vertex."""
    ghost = len(spoke)
    for half in range(2 * edges):
        v = org[half]
        if v != ghost:
            spoke[v] = 2 * half


@jit
def find_edge(plane: Plane, a: int, b: int) -> tuple[int, bool]:
    """Return (edge from a to b or -1, whether b has fewer edges), turning round both ends at once."""
    ring, org = plane.ring, plane.org
    first_a, first_b = int(plane.spoke[a]), int(plane.spoke[b])
    e, f = first_a, first_b
    while True:
        if dest(org, e) == b:
            return e, False
        if dest(org, f) == a:
            return f ^ 2, False
        e, f = int(ring[e]), int(ring[f])
        if e == first_a:
            return -1, False
        if f == first_b:
            return -1, True


@jit
def constrain_range(
    plane: Plane, ends: IntArray, order: npt.NDArray[np.int64], first: int, stop: int, pieces: PieceArray, count: int
) -> tuple[int, int, int]:
    """Insert segments order[first .. stop - 1]; return (the next, pieces, crossed edge or -1)."""
    for turn in range(first, stop):
        s = order[turn]
        a, b = ends[s, 0], ends[s, 1]
        while a != b:
            if count == len(pieces):
                ends[s, 0], ends[s, 1] = a, b
                return turn, count, -1
            e, swapped = find_edge(plane, a, b)
            w = b
            if e < 0:
                if swapped:
                    a, b = b, a
                e, straight = toward(plane, a, b)
                w = dest(plane.org, e)
                if not straight:
                    w, crossed, lefts, rights = march(plane, e, b)
                    if w < 0:
                        return turn, count, -1 - w
                    e = split_along(plane, a, w, lefts, rights)
            plane.fixed[e >> 2] = True
            pieces[count, 0], pieces[count, 1] = e >> 2, s
            count += 1
            a = w
    return stop, count, -1
