"""A bad triangle gets a point, unless a segment objects, which is divided then before the triangle is looked at again.

Reference [Ruppert 1995], [Ungor 2004].
"""

from exactkernel.jit import jit, jit_inline
from exactmesh.edgealgebra import dest, left_next, origin
from exactmesh.refinement.insertion import close_face, divide_edge, divide_face, legalize, rejoin_edge, seek, undo_flips
from exactmesh.refinement.judging import (
    YIELDED_TO_SIZE,
    accept,
    await_split,
    give_up,
    is_crowded,
    nearest_squared,
    settle,
)
from exactmesh.refinement.placement import is_finite, move_to_lattice, place_centre, place_centroid, shortest_edge
from exactmesh.refinement.rules import Reason, Rules, SteinerKind, is_encroached
from exactmesh.refinement.sheet import ANGLE, ASKED, FAULTS, FLIPS, SIZE, VERTICES, Sheet, distance_squared

__all__ = ["refine_triangle"]

_THICK = 1.0 / 64.0  # the height of a triangle, in lengths of its longest edge

_MINIMUM_EDGE = int(Reason.MINIMUM_EDGE)
_PRECISION = int(Reason.PRECISION)
_FORBIDDEN = int(Reason.FORBIDDEN)
_TERMINATION = int(Reason.TERMINATION)
_YIELDED = int(SteinerKind.YIELDED)
_INTERIOR = int(SteinerKind.INTERIOR)


@jit_inline
def hindrance(s: Sheet, rules: Rules, p: int, walls: int) -> int:
    """Keep those of the fixed edges in ``s.hit`` that p is too close to; return how many."""
    hits = 0
    for i in range(walls):
        e = int(s.hit[i])
        if s.hard[e >> 2] != _FORBIDDEN and is_encroached(s, rules, e, p):
            s.hit[hits] = e
            hits += 1
    return hits


@jit_inline
def yield_to(s: Sheet, half: int, edge: int, parent: int, cause: int) -> None:
    """Divide a segment before the triangle is looked at again; give the triangle up where that cannot be."""
    if s.hard[edge >> 2] != 0:
        give_up(s, half, int(s.hard[edge >> 2]))
    else:
        await_split(s, edge, parent, cause)


@jit_inline
def is_thick(s: Sheet, e: int) -> bool:
    """Tell whether the triangle on the left of e is not so flat that what is asked for cannot be had inside of it."""
    xy, f = s.xy, left_next(s.ring, e)
    a, b, c = origin(s.org, e), dest(s.org, e), dest(s.org, f)
    longest = max(distance_squared(xy, a, b), max(distance_squared(xy, b, c), distance_squared(xy, c, a)))
    bx, by = xy[2 * b] - xy[2 * a], xy[2 * b + 1] - xy[2 * a + 1]
    cx, cy = xy[2 * c] - xy[2 * a], xy[2 * c + 1] - xy[2 * a + 1]
    return bool(bx * cy - by * cx > _THICK * longest)


@jit_inline
def insert_for(s: Sheet, rules: Rules, half: int, e: int, zeros: int, p: int, parent: int, root: float) -> None:
    """Insert p into the triangle on the left of e, or onto e (zeros = 1), for the bad triangle of the half-edge."""
    new = divide_face(s, e, p) if zeros == 0 else divide_edge(s, e, p)
    flips, walls = legalize(s, left_next(s.ring, new), p)
    first = left_next(s.ring, new)
    hits = hindrance(s, rules, p, walls)
    nearest = nearest_squared(s, first, p)
    too_near = is_crowded(s, rules, first, p, nearest)
    if hits == 0 and not too_near:
        s.counts[FLIPS] += flips
        settle(s, nearest, p, parent, _INTERIOR, root, -1)
        accept(s, rules, first, p)
        return
    undo_flips(s, flips)
    if zeros == 0:
        close_face(s, new)
    else:
        rejoin_edge(s, e, new)
    if too_near:
        give_up(s, half, _MINIMUM_EDGE)
        return
    reason = 0
    for i in range(hits):
        reason = int(s.hard[s.hit[i] >> 2])
        if reason == 0:  # one at a time: the next may not be in the way any more
            await_split(s, int(s.hit[i]), parent, _YIELDED if root > 0.0 else YIELDED_TO_SIZE)
            return
    give_up(s, half, reason)


@jit
def refine_triangle(s: Sheet, rules: Rules, half: int) -> None:
    """Put a point where the triangle on the left of the half-edge is bad, or divide the segments that object."""
    e, squared = shortest_edge(s, 2 * half)
    a, b = origin(s.org, e), dest(s.org, e)
    parent, faults, p = max(a, b), s.state[half] & FAULTS, int(s.counts[VERTICES])
    root = min(s.root[a], s.root[b])
    if faults == ANGLE and squared < rules.shrink * root * root:
        give_up(s, half, _TERMINATION)
        return
    place_centre(s, rules, e, p, rules.offset if faults & ANGLE else 0.0)
    if faults == SIZE:
        move_to_lattice(s, rules, e, p)
    if not is_finite(s.xy, p):
        give_up(s, half, _PRECISION)
        return
    found, zeros = seek(s, e, p)
    if zeros == 1 and s.segment[found >> 2] >= 0:
        zeros = 3
    if zeros == 3 and s.hard[found >> 2] == _FORBIDDEN and (faults & SIZE or (faults & ASKED and is_thick(s, e))):
        place_centroid(s, rules, e, p)
        found, zeros = seek(s, e, p)
    if zeros == 3:
        yield_to(s, half, found, parent, _YIELDED if faults == ANGLE else YIELDED_TO_SIZE)
        return
    if zeros > 1:
        give_up(s, half, _PRECISION)
        return
    insert_for(s, rules, half, found, zeros, p, parent, root if faults == ANGLE else 0.0)
