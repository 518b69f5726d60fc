"""Deletion of a vertex from a draft: its star is emptied ear by ear, at random, and the ears flipped in reverse order.

As long as the neighbors of a vertex v lie round it on a polygon with a convex corner whose ear does not contain v, the
edge from v to that corner can be flipped: it becomes the base of the ear. In the end, v has three neighbors and goes;
or it was on the hull, what is left of the polygon is the new hull, and v goes into the ghost vertex. That is a
triangulation of the hole, though any; taken from the last ear to the first, each adds a corner to a polygon that is
constrained Delaunay already, which is repaired by flips that all end in that corner. Random order keeps them few.
Reference [Chew 1990].
"""

from exactkernel.jit import jit, jit_inline
from exactmesh.cavity import legalize_fan
from exactmesh.edgealgebra import dest, left_next, link_ring, origin, rot, swap
from exactmesh.editing.draft import EDGES, START, VERTICES, Draft
from exactmesh.plane import Plane, orient

__all__ = ["constraints_at", "forget", "is_only_apex", "remove_vertex"]


@jit
def constraints_at(draft: Draft, v: int) -> int:
    """Write the constrained edges at v into ``plane.crossed``; return how many."""
    plane = draft.plane
    first = e = int(plane.spoke[v])
    found = 0
    while True:
        if plane.fixed[e >> 2]:
            plane.crossed[found] = e >> 2
            found += 1
        e = int(plane.ring[e])
        if e == first:
            return found


@jit
def is_only_apex(draft: Draft, v: int) -> bool:
    """Tell whether all vertices besides v lie on one line. O(degree of v)."""
    plane = draft.plane
    first = e = int(plane.spoke[v])
    a = b = -1
    degree = 0
    flat = True
    while True:
        w = dest(plane.org, e)
        degree += 1
        if w != plane.ghost:
            if a < 0:
                a = w
            elif b < 0:
                b = w
            elif orient(plane, a, b, w) != 0:
                flat = False
        e = int(plane.ring[e])
        if e == first:
            return flat and degree == draft.tally[VERTICES]


@jit_inline
def collect_star(plane: Plane, v: int) -> tuple[int, int, int]:
    """Write the edges from v to vertices into the stack; return (how many, degree of v, the edge to the ghost, or -1).

    Each neighbor's spoke becomes an edge of the link, which stays.
    """
    first = e = int(plane.spoke[v])
    height, degree, hull = 0, 0, -1
    while True:
        w = dest(plane.org, e)
        degree += 1
        if w == plane.ghost:
            hull = e
        else:
            plane.spoke[w] = left_next(plane.ring, e)
            plane.stack[height] = e
            height += 1
        e = int(plane.ring[e])
        if e == first:
            return height, degree, hull


@jit_inline
def cut_ears(plane: Plane, v: int, height: int, degree: int, on_hull: bool) -> int:
    """Flip edges at v, from the stack, while they can be: to three, or on the hull to none; return how many there were.

    ``plane.crossed`` gets them in order, with the ear on their left.

              j                 j
             /|\\               /|^
            / | \\             / | \\
           v--e->m    ->     v  e  m         orient(i, m, j) > 0, orient(i, j, v) >= 0
            \\ | /             \\ | /
             \\|/               \\|/
              i                 i
    """
    ring, org, stack = plane.ring, plane.org, plane.stack
    cut, state = 0, 1
    while height > 0 and (on_hull or degree - cut > 3):
        state = (1103515245 * state + 12345) & 0x7FFFFFFF
        chosen = (state >> 8) % height
        e = int(stack[chosen])
        height -= 1
        stack[chosen] = stack[height]
        if origin(org, e) != v:
            continue
        before, after = left_next(ring, e ^ 2), int(ring[e])
        i, m, j = dest(org, before), dest(org, e), dest(org, after)
        if i == plane.ghost or j == plane.ghost:
            continue
        if orient(plane, i, m, j) > 0 and orient(plane, i, j, v) >= 0:
            swap(ring, org, e)
            plane.crossed[cut], plane.spoke[v] = e ^ 2, before
            cut += 1
            stack[height], stack[height + 1] = before, after
            height += 2
    return cut


@jit_inline
def unite(plane: Plane, v: int) -> None:
    """Make one triangle of the three at v."""
    ring = plane.ring
    e = int(plane.spoke[v])
    f = int(ring[e])
    g = int(ring[f])
    a, b, c = left_next(ring, e), left_next(ring, f), left_next(ring, g)
    link_ring(ring, a, b)
    link_ring(ring, b, c)
    link_ring(ring, c, a)
    plane.stack[0], plane.stack[1], plane.stack[2] = e >> 2, f >> 2, g >> 2


@jit_inline
def sink(plane: Plane, hull: int) -> None:
    """Let v and the ghost vertex, the ends of the edge hull, become one: it goes, and the two triangles at it.

               w <-- ... <-- u            w <-- ... <-- u
              / \\    |      / \\          / \\    |      / \\
             |   last | first  |        |   -   |    -   |       what is left at v: the middle edges
             |     \\ | /       |        |     \\ | /      |
             |       v         |   ->   |      ghost     |
              \\      | hull   /
               \\-- ghost ----/
    """
    ring, org = plane.ring, plane.org
    first, last = int(ring[hull]), left_next(ring, hull ^ 2)
    to_first, from_last = left_next(ring, hull), left_next(ring, last)
    e = int(ring[first])
    before = from_last if e == last else e ^ 2  # what comes before to_first round the face of the first link edge
    link = left_next(ring, first)
    while e != last:
        org[e >> 1] = plane.ghost
        after = int(ring[e])
        if after == last:
            end = left_next(ring, e)
            link_ring(ring, end, from_last)
            link_ring(ring, from_last, e)
        e = after
    link_ring(ring, to_first, link)
    link_ring(ring, before, to_first)
    if before == from_last:
        link_ring(ring, link, from_last)
    plane.stack[0], plane.stack[1], plane.stack[2] = hull >> 2, first >> 2, last >> 2


@jit_inline
def legalize_ears(plane: Plane, cut: int) -> None:
    """Flip what is not Delaunay in the ears, from the last to the first."""
    ring, org = plane.ring, plane.org
    for turn in range(cut - 1, -1, -1):
        e = int(plane.crossed[turn])
        if dest(org, left_next(ring, e ^ 2)) != plane.ghost:
            plane.loose[e >> 2] = True
            legalize_fan(plane, e, dest(org, left_next(ring, e)))
    for turn in range(cut):
        plane.loose[plane.crossed[turn] >> 2] = False


@jit_inline
def renumber(draft: Draft, source: int, target: int) -> None:
    """Give an edge another number, one that is free."""
    plane = draft.plane
    ring, org = plane.ring, plane.org
    for q in range(4):
        before = rot(int(ring[rot(4 * source + q)]))
        ring[4 * target + q] = ring[4 * source + q]
        ring[before] = 4 * target + q
    for end in range(2):
        v = org[2 * source + end]
        org[2 * target + end] = v
        if v != plane.ghost:
            plane.spoke[v] = 4 * target + 2 * end
    plane.fixed[target], draft.owner[target] = plane.fixed[source], draft.owner[source]


@jit_inline
def close_gaps(draft: Draft) -> None:
    """Let the last edges take the numbers of the three that went: they stand on the stack."""
    stack, tally = draft.plane.stack, draft.tally
    for _ in range(3):
        k = 0
        for i in range(1, 3):
            if stack[i] > stack[k]:
                k = i
        tally[EDGES] -= 1
        if stack[k] != tally[EDGES]:
            renumber(draft, tally[EDGES], stack[k])
        stack[k] = -1


@jit
def remove_vertex(draft: Draft, v: int) -> None:
    """Delete the vertex v, at which no constrained edge ends, and without which there are still triangles."""
    plane, tally = draft.plane, draft.tally
    height, degree, hull = collect_star(plane, v)
    neighbor = dest(plane.org, int(plane.stack[0]))
    cut = cut_ears(plane, v, height, degree, hull >= 0)
    if hull < 0:
        unite(plane, v)
    else:
        sink(plane, hull)
    legalize_ears(plane, cut)
    close_gaps(draft)
    draft.twin[v] = -1
    tally[VERTICES] -= 1
    if tally[START] == v:
        tally[START] = neighbor


@jit
def forget(draft: Draft, v: int) -> None:
    """Delete the vertex v, without which there is no triangle."""
    draft.twin[v] = -1
    draft.tally[VERTICES] -= 1
    draft.tally[EDGES] = 0
