"""Take a vertex out of the inside of a domain again: those that a segment about to be divided has in its circle.

They came when the segment was longer, and would only crowd around its middle. Reference [Chew 1993].
"""

from exactkernel.jit import jit, jit_inline
from exactmesh.edgealgebra import dest, left_next, link_ring, origin, swap
from exactmesh.refinement.insertion import undo_flips
from exactmesh.refinement.queue import forget
from exactmesh.refinement.sheet import DEAD, FLIPS, OUTSIDE, Sheet, conflict, orient

__all__ = ["remove_vertex"]


@jit_inline
def flip_to_three(s: Sheet, spoke: int) -> tuple[int, int]:
    """Flip edges away from the origin of the spoke until it has three; return (one of them, flips).

    (-1, flips) if that cannot be: the vertex is in the middle of a line between two neighbours.
    """
    ring, org = s.ring, s.org
    v, degree, e = origin(org, spoke), 1, int(ring[spoke])
    while e != spoke:
        degree, e = degree + 1, int(ring[e])
    flips, idle = 0, 0
    while degree > 3 and idle < degree:
        before = left_next(ring, e ^ 2)  # from v to the neighbour before that of e
        a, b, c = dest(org, before), dest(org, e), dest(org, int(ring[e]))
        following = int(ring[e])
        if orient(s, a, b, c) > 0 and orient(s, a, c, v) > 0:
            swap(ring, org, e)
            s.flipped[flips] = e >> 2
            flips, degree, idle = flips + 1, degree - 1, 0
        else:
            idle += 1
        e = following
    return (e if degree == 3 else -1), flips


@jit_inline
def drop_spokes(s: Sheet, e: int) -> int:
    """Take the vertex of three edges, e among them, out of its triangle; return an edge of that."""
    ring = s.ring
    f = int(ring[e])
    g = int(ring[f])
    spoke = e
    for _ in range(3):
        forget(s, spoke >> 1)
        forget(s, (spoke ^ 2) >> 1)
        s.zone[spoke >> 1] = s.zone[(spoke ^ 2) >> 1] = OUTSIDE
        spoke = int(ring[spoke])
    ab, bc, ca = left_next(ring, e), left_next(ring, f), left_next(ring, g)
    link_ring(ring, ab, bc)
    link_ring(ring, bc, ca)
    link_ring(ring, ca, ab)
    return ab


@jit_inline
def restore(s: Sheet, count: int) -> None:
    """Flip the edges in ``s.flipped``, and those around them, until all are locally Delaunay; the list stays."""
    ring, org = s.ring, s.org
    changed = True
    while changed:  # a polygon of few edges: going round until nothing changes is soon done
        changed = False
        for i in range(count):
            e = 4 * s.flipped[i]
            f = left_next(ring, e)
            beyond = left_next(ring, e ^ 2)
            if conflict(s, origin(org, e), dest(org, e), dest(org, f), dest(org, beyond)):
                swap(ring, org, e)
                s.counts[FLIPS] += 1
                changed = True


@jit
def remove_vertex(s: Sheet, spoke: int) -> tuple[int, int]:
    """Remove the origin of the spoke; return (number of edges in ``s.flipped``, an edge of one of the triangles).

    Each new triangle has an edge among those, but a single one, whose edge is returned. (-1, -1): nothing was done.
    """
    v = origin(s.org, spoke)
    last, flips = flip_to_three(s, spoke)
    if last < 0:
        undo_flips(s, flips)
        return -1, -1
    ab = drop_spokes(s, last)
    restore(s, flips)
    s.kind[v] = -1
    s.counts[DEAD] += 1
    return flips, ab
