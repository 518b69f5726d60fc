"""Triangles across edges, and the parts that segments leave connected, for admissible triangles."""

import numpy as np

from exactkernel.jit import jit
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import IntArray
from exactmesh.verify.chains import Marks, edge_slot
from exactmesh.verify.links import Links, slot_of
from exactmesh.verify.witness import IndexArray

__all__ = ["neighbours_of", "parts_of", "rows_of_slots"]

_CHUNK = 1 << 18  # triangles between two looks at Ctrl-C


@jit
def fill_rows(links: Links, cells: IntArray, before: int, rows: IntArray, t_begin: int, t_end: int) -> None:
    """Write the row of the cell of each slot; so many cells come before these."""
    width = cells.shape[1]
    for t in range(t_begin, t_end):
        for i in range(width):
            v, b = cells[t, i], cells[t, (i + 1) % width]
            rows[slot_of(links.slots, links.first[v], links.last[v], b)] = before + t


def rows_of_slots(links: Links, triangles: IntArray, quads: IntArray | None = None) -> IntArray:
    """Return int32 (3m + 4k,): the row of the cell of each slot. O(m + k)."""
    rows = np.empty(len(links.slots), dtype=np.int32)
    for before, cells in ((0, triangles), (len(triangles), triangles[:0] if quads is None else quads)):
        for begin in range(0, len(cells), _CHUNK):
            fill_rows(links, cells, before, rows, begin, min(begin + _CHUNK, len(cells)))
            raise_if_interrupted()
    return rows


@jit
def fill_neighbours(
    links: Links, triangles: IntArray, rows: IntArray, marks: Marks, bits: int, across: IntArray, begin: int, end: int
) -> None:
    """Write the row across each edge, -1 on the boundary and where the edge is marked with some of the bits."""
    for t in range(begin, end):
        for i in range(3):
            v, b = triangles[t, i], triangles[t, (i + 1) % 3]
            slot = slot_of(links.slots, links.first[b], links.last[b], v)
            across[t, i] = -1
            if slot >= 0 and (bits == 0 or marks[edge_slot(links, v, b)] & bits == 0):
                across[t, i] = rows[slot]


def neighbours_of(links: Links, triangles: IntArray, rows: IntArray, marks: Marks, bits: int) -> IntArray:
    """Return int32 (m, 3): the row across the edge from corner i to corner i + 1, -1 where there is none, or where a
    mark of ``bits`` separates. O(m log d) for degrees d."""
    across = np.empty((len(triangles), 3), dtype=np.int32)
    for begin in range(0, len(triangles), _CHUNK):
        fill_neighbours(links, triangles, rows, marks, bits, across, begin, min(begin + _CHUNK, len(triangles)))
        raise_if_interrupted()
    return across


@jit
def flood(across: IntArray, part: IntArray, stack: IndexArray) -> int:
    """Number the connected parts; return how many there are."""
    parts = 0
    for start in range(len(part)):
        if part[start] >= 0:
            continue
        part[start], stack[0], top = parts, start, 1
        while top > 0:
            top -= 1
            t = stack[top]
            for i in range(3):
                s = across[t, i]
                if s >= 0 and part[s] < 0:
                    part[s] = parts
                    stack[top] = s
                    top += 1
        parts += 1
    return parts


def parts_of(across: IntArray) -> tuple[IntArray, int]:
    """Return the number of the connected part of each triangle, int32 (m,), and how many parts there are. O(m)."""
    part = np.full(len(across), -1, dtype=np.int32)
    count = flood(across, part, np.empty(len(across) + 1, dtype=np.intp))
    return part, int(count)
