"""The straight walk: from a vertex to the triangle of a point, along the segment between the two.

A visibility walk may turn in a circle where edges are constrained, for the triangulation is not Delaunay there. The
straight walk crosses the edges between here and there in their order, each once, so it ends in any triangulation.
Reference [Devillers 2002].
"""

from exactkernel.jit import jit_inline
from exactkernel.types import FloatArray
from exactmesh.edgealgebra import dest, left_next, origin
from exactmesh.plane import Plane, is_ahead, orient

__all__ = ["INSIDE", "ON_EDGE", "ON_VERTEX", "walk"]

#: Where a point lies: inside the triangle on the left of an edge, on the edge, or at its origin.
INSIDE, ON_EDGE, ON_VERTEX = 0, 1, 2

_BETWEEN, _STRAIGHT, _BEYOND = 0, 1, 2


@jit_inline
def coincide(xy: FloatArray, p: int, q: int) -> bool:
    """Tell whether two vertices have the same position."""
    return bool(xy[2 * p] == xy[2 * q] and xy[2 * p + 1] == xy[2 * q + 1])


@jit_inline
def sector(plane: Plane, a: int, p: int) -> tuple[int, int]:
    """Turn round the vertex a to the direction of p, elsewhere; return an edge and what it has to do with p.

    p lies strictly between e and onext(e) as seen from a (_BETWEEN), on the ray of e (_STRAIGHT), or strictly beyond
    the hull edge e, whose left face is at the ghost vertex (_BEYOND).
    """
    ring, org, ghost = plane.ring, plane.org, plane.ghost
    e = int(plane.spoke[a])
    if dest(org, e) == ghost:
        e = int(ring[e])
    side = orient(plane, a, dest(org, e), p)
    while True:
        if side == 0 and is_ahead(plane.xy, a, dest(org, e), p):
            return e, _STRAIGHT
        f = int(ring[e])
        if dest(org, f) == ghost:
            if side > 0:
                return e, _BEYOND
            e = int(ring[f])
            side = orient(plane, a, dest(org, e), p)
            if side < 0:
                return e ^ 2, _BEYOND
            continue
        next_side = orient(plane, a, dest(org, f), p)
        if side > 0 and next_side < 0:
            return e, _BETWEEN
        e, side = f, next_side


@jit_inline
def walk(plane: Plane, a: int, p: int) -> tuple[int, int]:
    """Walk from the vertex a to p, whose coordinates stand in ``plane.xy``; return (edge, where).

    p lies in the closed triangle on the left of the edge: INSIDE, ON_EDGE or ON_VERTEX, its origin; or that triangle is
    at the ghost vertex and p strictly beyond its hull edge (INSIDE).
    """
    ring, org, xy, ghost = plane.ring, plane.org, plane.xy, plane.ghost
    if coincide(xy, a, p):
        return int(plane.spoke[a]), ON_VERTEX
    while True:
        e, where = sector(plane, a, p)
        if where == _BEYOND:
            return e, INSIDE
        x = dest(org, e)
        if where == _STRAIGHT:
            if coincide(xy, x, p):
                return e ^ 2, ON_VERTEX
            if not is_ahead(xy, p, x, a):
                return e, ON_EDGE
            a = x
            continue
        c = left_next(ring, e)  # the edge to be crossed, from its end on the right
        x = -1
        while x < 0:
            side = orient(plane, origin(org, c), dest(org, c), p)
            if side >= 0:
                return c, INSIDE if side > 0 else ON_EDGE
            f = left_next(ring, c ^ 2)
            x = dest(org, f)
            if x == ghost:
                return c ^ 2, INSIDE
            turn = orient(plane, a, p, x)
            if turn > 0:
                c, x = f, -1
            elif turn < 0:
                c, x = left_next(ring, f), -1
        if coincide(xy, x, p):
            return f ^ 2, ON_VERTEX
        if not is_ahead(xy, p, x, a):
            return c ^ 2, INSIDE
        a = x
