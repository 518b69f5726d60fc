"""Insertion of one segment into a draft: a look at the way first, so that a crossing leaves everything as it was."""

from typing import NamedTuple

from exactkernel.jit import jit
from exactkernel.types import IntArray
from exactmesh.constrain import constrain_range, find_edge
from exactmesh.edgealgebra import EdgeArray, dest, left_next
from exactmesh.editing.draft import GROUPS, SEGMENTS, Draft
from exactmesh.ordering import IndexArray
from exactmesh.plane import orient, toward

__all__ = ["Way", "add_segment", "groups_of", "look_along", "members"]


class Way(NamedTuple):
    """What lies between the ends of a segment.

    Attributes:
        pieces: of how many edges it consists, or would.
        shared: how many of them are constrained already.
        crossed: how many constrained edges it crosses.
        same: the segment that joins the same two vertices already, or -1.
    """

    pieces: int
    shared: int
    crossed: int
    same: int


@jit
def joined_already(draft: Draft, edge: int, a: int, b: int) -> int:
    """Return the segment with the ends a and b among those that the edge is part of, or -1."""
    g = int(draft.owner[edge])
    while g >= 0:
        s = int(draft.group[g, 1])
        u, v = draft.ends[s, 0], draft.ends[s, 1]
        if (u == a and v == b) or (u == b and v == a):
            return s
        g = int(draft.group[g, 0])
    return -1


@jit
def look_along(draft: Draft, a: int, b: int) -> Way:
    """Walk from the vertex a to the vertex b; ``plane.crossed`` gets the numbers of the constrained edges crossed."""
    plane = draft.plane
    ring, org = plane.ring, plane.org
    e, swapped = find_edge(plane, a, b)
    v, w = (b, a) if swapped else (a, b)
    pieces, shared, crossed, some = 0, 0, 0, -1
    while v != w:
        pieces += 1
        straight = e >= 0
        if not straight:
            e, straight = toward(plane, v, w)
        if straight:
            if plane.fixed[e >> 2]:
                shared, some = shared + 1, e >> 2
            v, e = dest(org, e), -1
            continue
        c, side = left_next(ring, e), 1
        while side != 0:
            if plane.fixed[c >> 2]:
                plane.crossed[crossed] = c >> 2
                crossed += 1
            f = left_next(ring, c ^ 2)
            x = dest(org, f)
            side = 0 if x == w else orient(plane, v, w, x)
            c = f if side > 0 else left_next(ring, f)
        v, e = x, -1
    same = joined_already(draft, some, a, b) if shared == pieces else -1
    return Way(pieces, shared, crossed, same)


@jit
def add_segment(draft: Draft, order: IndexArray, pieces: EdgeArray) -> None:
    """Insert the segment order[0], the next one, whose ends are there and which crosses none.

    ``pieces`` has a row for each of its edges, and there is room for as many groups and one more.
    """
    plane, owner, group, tally = draft.plane, draft.owner, draft.group, draft.tally
    s = order[0]
    constrain_range(plane, draft.ends, order, 0, 1, pieces, 0)
    alone = old = new = -1
    for i in range(len(pieces)):
        e = pieces[i, 0]
        if owner[e] < 0:
            if alone < 0:
                alone = tally[GROUPS]
                group[alone, 0], group[alone, 1] = -1, s
                tally[GROUPS] += 1
            owner[e] = alone
        else:
            if owner[e] != old:
                old, new = owner[e], tally[GROUPS]
                group[new, 0], group[new, 1] = old, s
                tally[GROUPS] += 1
            owner[e] = new
    tally[SEGMENTS] += 1


@jit
def groups_of(draft: Draft, edges: int, rows: IntArray) -> int:
    """Write rows (edge, segment) for the first edges, as far as there is room; return how many there are."""
    found = 0
    for e in range(edges):
        g = int(draft.owner[e]) if draft.plane.fixed[e] else -1
        while g >= 0:
            if found < len(rows):
                rows[found, 0], rows[found, 1] = e, draft.group[g, 1]
            found += 1
            g = int(draft.group[g, 0])
    return found


def members(draft: Draft, edges: IntArray) -> list[int]:
    """Return the segments that the constrained edges are part of, each once, in order."""
    found = set()
    for g in draft.owner[edges].tolist():
        while g >= 0:
            g, s = draft.group[g].tolist()
            found.add(s)
    return sorted(found)
