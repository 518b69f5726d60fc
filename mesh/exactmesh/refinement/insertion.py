"""Put a vertex into a triangle or onto an edge, restore the constrained Delaunay property by flips, and take it out
again when it turns out to stand too close to a segment.
"""

from exactkernel.jit import jit, jit_inline
from exactmesh.edgealgebra import dest, left_next, link_ring, origin, split_face, swap
from exactmesh.refinement.sheet import EDGES, FIXED, OUTSIDE, Sheet, conflict, orient

__all__ = [
    "close_face",
    "divide_edge",
    "divide_face",
    "is_inside",
    "legalize",
    "rejoin_edge",
    "seek",
    "spokes_are_delaunay",
    "undo_flips",
]

_PATIENCE = 1 << 20


@jit_inline
def is_inside(s: Sheet, e: int) -> bool:
    """Tell whether the face on the left of e belongs to the domain."""
    return bool(s.zone[e >> 1] != OUTSIDE)


@jit_inline
def seek(s: Sheet, e: int, p: int) -> tuple[int, int]:
    """Walk straight from the triangle on the left of e to the vertex p, which is no part of the triangulation yet.

    Returns (edge, zeros): p lies in the closed triangle on the left of that edge: inside (0), on the edge (1), at its
    origin (2); or the fixed edge is in the way (3); or rounding led astray (4).
    """
    ring, org = s.ring, s.org
    f = left_next(ring, e)
    g = left_next(ring, f)
    side_e = orient(s, origin(org, e), dest(org, e), p)
    side_f = orient(s, origin(org, f), dest(org, f), p)
    side_g = orient(s, origin(org, g), dest(org, g), p)
    if side_e >= 0 and side_f >= 0 and side_g >= 0:
        if side_e == 0:
            return (e, 2) if side_g == 0 else ((f, 2) if side_f == 0 else (e, 1))
        if side_f == 0:
            return (g, 2) if side_g == 0 else (f, 1)
        return (g, 1) if side_g == 0 else (e, 0)
    c, a = e, dest(org, f)  # p is beyond c, which is seen from its opposite corner a
    if side_e >= 0:
        c, a = (f, origin(org, e)) if side_f < 0 else (g, dest(org, e))
    for _ in range(_PATIENCE):
        if s.segment[c >> 2] >= 0:
            return c, 3
        f = left_next(ring, c ^ 2)
        g = left_next(ring, f)
        side_f = orient(s, origin(org, f), dest(org, f), p)
        side_g = orient(s, origin(org, g), dest(org, g), p)
        if side_f >= 0 and side_g >= 0:
            if side_f == 0:
                return (g, 2) if side_g == 0 else (f, 1)
            return (g, 1) if side_g == 0 else (f, 0)
        leaves_left = orient(s, a, p, dest(org, f)) >= 0 if side_g < 0 else True
        c = f if side_f < 0 and leaves_left else g
    return c, 4


@jit_inline
def divide_face(s: Sheet, e: int, p: int) -> int:
    """Join p to the corners of the triangle on the left of e; return the first of three new edges."""
    new = 4 * int(s.counts[EDGES])
    zone = s.zone[e >> 1]
    split_face(s.ring, s.org, e, new, p)
    for half in range(new >> 1, (new >> 1) + 6):
        s.zone[half] = zone
    for edge in range(new >> 2, (new >> 2) + 3):
        s.segment[edge], s.hard[edge] = -1, 0
    s.counts[EDGES] += 3
    return new


@jit_inline
def divide_edge(s: Sheet, e: int, p: int) -> int:
    """Put p onto the edge e, join it to the apexes of the triangles there; return the first of the new edges.

    e ends at p now, the edge ``new`` goes on from there, and then there is one for each triangle, the left one first.
    """
    ring, org, zone = s.ring, s.org, s.zone
    new = 4 * int(s.counts[EDGES])
    back, b = e ^ 2, dest(org, e)
    left, right = zone[e >> 1], zone[back >> 1]
    after, before = left_next(ring, e), int(ring[back]) ^ 2  # the edge into b whose left face is that on the right of e
    beyond = left_next(ring, back)
    org[back >> 1], org[new >> 1], org[(new ^ 2) >> 1] = p, p, b
    s.segment[new >> 2], s.hard[new >> 2] = s.segment[e >> 2], s.hard[e >> 2]
    s.counts[FIXED] += s.segment[e >> 2] >= 0
    zone[new >> 1], zone[(new ^ 2) >> 1] = left, right
    link_ring(ring, e, new)
    link_ring(ring, new, after)
    link_ring(ring, before, new ^ 2)
    link_ring(ring, new ^ 2, back)
    link_ring(ring, back, beyond)
    last = new
    if left != OUTSIDE:
        last += 4
        join_apex(s, e, new, after, last, left)
    if right != OUTSIDE:
        last += 4
        join_apex(s, new ^ 2, back, beyond, last, right)
    s.counts[EDGES] = (last >> 2) + 1
    return new


@jit_inline
def join_apex(s: Sheet, into: int, out: int, after: int, new: int, zone: int) -> None:
    """Cut the four-sided face into -> out -> after -> ... in two by an edge, from the vertex between to the apex."""
    ring, org = s.ring, s.org
    last = left_next(ring, after)
    org[new >> 1], org[(new ^ 2) >> 1] = org[out >> 1], org[last >> 1]
    s.zone[new >> 1] = s.zone[(new ^ 2) >> 1] = zone
    s.segment[new >> 2], s.hard[new >> 2] = -1, 0
    link_ring(ring, into, new)
    link_ring(ring, new, last)
    link_ring(ring, last, into)
    link_ring(ring, after, new ^ 2)
    link_ring(ring, new ^ 2, out)


@jit_inline
def legalize(s: Sheet, first: int, p: int) -> tuple[int, int]:
    """Flip the edges of p's link, from the edge first on counterclockwise, until none is in conflict with p.

    Where p is on the boundary, first must be the first edge of the link. Returns the number of flips, whose edges are
    in ``s.flipped``, and the number of fixed edges in the link, which are in ``s.hit``.
    """
    ring, org = s.ring, s.org
    flips, walls, e, last = 0, 0, first, origin(org, first)
    while True:
        flippable = s.segment[e >> 2] < 0
        beyond = left_next(ring, e ^ 2) if flippable else e
        if flippable and conflict(s, dest(org, e), origin(org, e), dest(org, beyond), p):
            swap(ring, org, e)
            s.flipped[flips] = e >> 2
            flips += 1
            e = beyond
        else:
            if not flippable:
                s.hit[walls] = e
                walls += 1
            spoke = left_next(ring, e)
            if not is_inside(s, spoke ^ 2):
                return flips, walls
            e = left_next(ring, spoke ^ 2)
            if origin(org, e) == last:
                return flips, walls


@jit
def undo_flips(s: Sheet, flips: int) -> None:
    """Flip back, the last first. A swap turns by a quarter, so three more restore every edge to its direction."""
    for i in range(flips - 1, -1, -1):
        for _ in range(3):
            swap(s.ring, s.org, 4 * s.flipped[i])


@jit
def close_face(s: Sheet, new: int) -> None:
    """Undo divide_face, whose new edges begin with new."""
    ring = s.ring
    s.counts[EDGES] = new >> 2
    ab, bc, ca = left_next(ring, new), left_next(ring, new + 4), left_next(ring, new + 8)
    link_ring(ring, ab, bc)
    link_ring(ring, bc, ca)
    link_ring(ring, ca, ab)


@jit
def rejoin_edge(s: Sheet, e: int, new: int) -> None:
    """Undo divide_edge of e, whose new edges begin with new."""
    ring, org = s.ring, s.org
    back = e ^ 2
    after, beyond, before = left_next(ring, new), left_next(ring, back), int(ring[new ^ 2]) ^ 2
    if is_inside(s, e):
        last = left_next(ring, left_next(ring, e))
        link_ring(ring, after, last)
        link_ring(ring, last, e)
    if is_inside(s, back):
        before = left_next(ring, left_next(ring, new ^ 2))
        link_ring(ring, beyond, before)
    org[back >> 1] = org[(new ^ 2) >> 1]
    link_ring(ring, e, after)
    link_ring(ring, before, back)
    link_ring(ring, back, beyond)
    s.counts[EDGES] = new >> 2
    s.counts[FIXED] -= s.segment[e >> 2] >= 0


@jit_inline
def spokes_are_delaunay(s: Sheet, first: int, p: int) -> bool:
    """Tell whether the free edges at p are locally Delaunay; first is the first edge of its link.

    They are, but where p was rounded off the segment that it divides, away from a triangle that was there.
    """
    ring, org = s.ring, s.org
    e, last = first, origin(org, first)
    while True:
        spoke = left_next(ring, e)
        if not is_inside(s, spoke ^ 2):
            return True
        following = left_next(ring, spoke ^ 2)
        if s.segment[spoke >> 2] < 0 and conflict(s, origin(org, e), dest(org, e), p, dest(org, following)):
            return False
        e = following
        if origin(org, e) == last:
            return True
