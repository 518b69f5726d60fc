"""Insertion of vertices into a draft: walk, split the triangle, flip until all is constrained Delaunay again."""

from exactkernel.jit import jit, jit_inline
from exactmesh.delaunay import in_conflict
from exactmesh.edgealgebra import dest, left_next, origin, split_face, swap
from exactmesh.editing.draft import EDGES, FLIPS, NUMBERS, START, VERTICES, Draft
from exactmesh.editing.walk import ON_EDGE, ON_VERTEX, walk
from exactmesh.ordering import IndexArray
from exactmesh.plane import Plane

__all__ = ["insert_vertices"]


@jit_inline
def legalize_link(plane: Plane, first: int, p: int) -> int:
    """Flip the edges of p's link, counterclockwise from first on, until only fixed ones are in conflict with p.

    Returns the number of flips.
    """
    ring, org = plane.ring, plane.org
    flips = 0
    e = first
    last = origin(org, first)
    while True:
        beyond = left_next(ring, e ^ 2)
        a, b, c = dest(org, e), origin(org, e), dest(org, beyond)
        if not plane.fixed[e >> 2] and in_conflict(plane.k, plane.xy, plane.ghost, a, b, c, p):
            swap(ring, org, e)
            flips += 1
            e = beyond
        else:
            spoke = left_next(ring, e)
            e = left_next(ring, spoke ^ 2)
            if origin(org, e) == last:
                return flips


@jit_inline
def renew_spokes(plane: Plane, p: int, first: int) -> None:
    """Let first leave p, and the edges round p leave its neighbors: the flips may have taken theirs."""
    plane.spoke[p] = e = first
    while True:
        if dest(plane.org, e) != plane.ghost:
            plane.spoke[dest(plane.org, e)] = e ^ 2
        e = int(plane.ring[e])
        if e == first:
            return


@jit_inline
def halve(draft: Draft, e: int, new: int) -> int:
    """Let the edges new and new + 1, which split e, be what it was; flip e away from them; return the next of the link.

            c                         c
           /|\\                       /|\\
          / p \\                     / | \\        the triangle a b p has no area;
         / . . \\         ->        /  p  \\       new  p a,   new + 1  p b
        a---e-->b                 a---+---b
         \\     /                   \\  |  /
          \\   /                     \\ e /
            d                         d
    """
    plane = draft.plane
    for half in range(new, new + 2):
        plane.fixed[half], draft.owner[half] = plane.fixed[e >> 2], draft.owner[e >> 2]
    plane.fixed[e >> 2], draft.owner[e >> 2] = False, -1
    beyond = left_next(plane.ring, e ^ 2)
    swap(plane.ring, plane.org, e)
    return beyond


@jit_inline
def insert_vertex(draft: Draft, p: int) -> int:
    """Insert the vertex p, whose coordinates are there; return the vertex at its position, which may be another one."""
    plane, tally = draft.plane, draft.tally
    ring, org = plane.ring, plane.org
    e, where = walk(plane, tally[START], p)
    if where == ON_VERTEX:
        tally[START] = origin(org, e)
        return origin(org, e)
    new = tally[EDGES]
    split_face(ring, org, e, 4 * new, p)
    for edge in range(new, new + 3):
        plane.fixed[edge], draft.owner[edge] = False, -1
    if where == ON_EDGE:
        e = halve(draft, e, new)
        tally[FLIPS] += 1
    tally[FLIPS] += legalize_link(plane, e, p)
    renew_spokes(plane, p, 4 * new)
    tally[EDGES] += 3
    tally[NUMBERS] = max(tally[NUMBERS], p + 1)
    tally[VERTICES] += 1
    tally[START] = p
    return p


@jit
def insert_vertices(draft: Draft, numbers: IndexArray, first: int, stop: int) -> None:
    """Insert the vertices numbers[first .. stop - 1]; write into twin[p] which vertex stands for p."""
    for i in range(first, stop):
        p = numbers[i]
        draft.twin[p] = insert_vertex(draft, p)
