"""The two sides of a new segment: the polygons that it leaves where it crossed edges, triangulated anew.

A march along the segment collects the edges that it crosses and the two chains of edges that are left when those go.
Every vertex of a chain sees the segment, which makes the constrained Delaunay triangulation of its polygon simple: the
third corner of the triangle at the base is the vertex of the chain that is in conflict with no other, and the rest
falls into two polygons of the same kind [Anglada 1997].
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exactkernel.context import Context
from exactkernel.incircle import incircle_perturbed_adaptive
from exactkernel.jit import jit, jit_inline
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.types import FloatArray
from exactmesh.edgealgebra import EdgeArray, dest, left_next, link_ring, origin

__all__ = ["Plane", "Workspace", "fill", "march", "orient", "split_along", "toward"]


class Plane(NamedTuple):
    """A triangulation of the plane under work.

    Attributes:
        k: for predicates on ``xy``.
        xy: the coordinates, flat.
        ring, org: the quad-edge; faces are triangles, those outside the hull have a corner at the ghost vertex.
        spoke: an edge that leaves each vertex.
        fixed: whether each edge is constrained.
        ghost: the ghost vertex.
    """

    k: Context
    xy: FloatArray
    ring: EdgeArray
    org: EdgeArray
    spoke: EdgeArray
    fixed: npt.NDArray[np.bool_]
    ghost: int


class Workspace(NamedTuple):
    """Scratch space, an entry for every vertex at least.

    Attributes:
        crossed: the edges that a march crossed, as edge numbers: free for new use.
        left, right: the chains beside it.
        stack: three entries for each polygon that waits.
    """

    crossed: EdgeArray
    left: EdgeArray
    right: EdgeArray
    stack: EdgeArray


@jit_inline
def orient(plane: Plane, a: int, b: int, c: int) -> int:
    """Return orient2d of three vertices."""
    xy = plane.xy
    return orient2d_adaptive(plane.k, xy[2 * a], xy[2 * a + 1], xy[2 * b], xy[2 * b + 1], xy[2 * c], xy[2 * c + 1])


@jit_inline
def conflict(plane: Plane, a: int, b: int, c: int, d: int) -> bool:
    """Tell whether d lies in the perturbed circle of a, b, c, counterclockwise."""
    xy = plane.xy
    ax, ay, bx, by = xy[2 * a], xy[2 * a + 1], xy[2 * b], xy[2 * b + 1]
    cx, cy, dx, dy = xy[2 * c], xy[2 * c + 1], xy[2 * d], xy[2 * d + 1]
    return incircle_perturbed_adaptive(plane.k, ax, ay, bx, by, cx, cy, dx, dy) > 0


@jit_inline
def is_ahead(xy: FloatArray, a: int, b: int, v: int) -> bool:
    """Tell whether v, on the line of a and b, is on the side of b from a."""
    if xy[2 * a] != xy[2 * b]:
        return bool((xy[2 * v] > xy[2 * a]) == (xy[2 * b] > xy[2 * a]))
    return bool((xy[2 * v + 1] > xy[2 * a + 1]) == (xy[2 * b + 1] > xy[2 * a + 1]))


@jit
def toward(plane: Plane, a: int, b: int) -> tuple[int, bool]:
    """Return (edge, True) if an edge leaves a straight toward b, else (e, False): b lies in the wedge from e to onext(e).

    b is another vertex of the same triangulation of a convex hull.
    """
    ring, org = plane.ring, plane.org
    e = int(plane.spoke[a])
    v = dest(org, e)
    side = 0 if v == plane.ghost else orient(plane, a, b, v)
    while True:
        if side == 0 and v != plane.ghost and is_ahead(plane.xy, a, b, v):
            return e, True
        f = int(ring[e])
        w = dest(org, f)
        next_side = 0 if w == plane.ghost else orient(plane, a, b, w)
        if side < 0 and next_side > 0:
            return e, False
        e, v, side = f, w, next_side


@jit
def march(plane: Plane, work: Workspace, e: int, b: int) -> tuple[int, int, int, int]:
    """Walk from the origin a of e, across the triangle on its left, toward b, until a vertex lies on the way.

    Returns (that vertex, edges crossed, edges in the left chain, in the right chain), or (-1 - edge, 0, 0, 0) for a
    fixed edge in the way. The left chain is passed from a on, its edges lead back to a; those of the right one lead
    away from it. Both have the crossed triangles on their left.
    """
    ring, org = plane.ring, plane.org
    a = origin(org, e)
    c = left_next(ring, e)  # the edge to be crossed, from right to left
    crossed, lefts, rights = 0, 1, 1
    work.right[0] = e
    work.left[0] = left_next(ring, c)
    while True:
        if plane.fixed[c >> 2]:
            return -1 - (c >> 2), 0, 0, 0
        work.crossed[crossed] = c >> 2
        crossed += 1
        f = left_next(ring, c ^ 2)
        g = left_next(ring, f)
        x = dest(org, f)
        side = 0 if x == b else orient(plane, a, b, x)
        if side >= 0:
            work.left[lefts] = g
            lefts += 1
            c = f
        if side <= 0:
            work.right[rights] = f
            rights += 1
            c = g
        if side == 0:
            return x, crossed, lefts, rights


@jit_inline
def corner(org: EdgeArray, chain: EdgeArray, i: int) -> int:
    """Return vertex i of a chain, whose edge i leads from vertex i + 1 back to vertex i."""
    return dest(org, chain[0]) if i == 0 else origin(org, chain[i - 1])


@jit
def apex(plane: Plane, chain: EdgeArray, i: int, j: int) -> int:
    """Return the vertex between i and j that no other is in conflict with, at the base from i to j."""
    org = plane.org
    a, b = corner(org, chain, i), corner(org, chain, j)
    best = i + 1
    c = corner(org, chain, best)
    for m in range(i + 2, j):
        d = corner(org, chain, m)
        if d != c and conflict(plane, a, b, c, d):
            best, c = m, d
    return best


@jit_inline
def new_edge(org: EdgeArray, edge: int, start: int, end: int) -> int:
    """Give an edge its ends; return it."""
    e = 4 * edge
    org[e >> 1] = start
    org[(e ^ 2) >> 1] = end
    return e


@jit
def fill(plane: Plane, work: Workspace, chain: EdgeArray, base: int, length: int, free: int) -> int:
    """Triangulate the polygon of the base, on its left, and the chain of that length; return the next free edge.

        p2 ------ p3
        /           \\          chain[i] leads from p(i+1) to p(i), the base from p0 to the last;
       p1            \\         all have the polygon on their left
        \\             \\
        p0 ---base---> p4
    """
    ring, org, stack = plane.ring, plane.org, work.stack
    stack[0], stack[1], stack[2] = 0, length, base
    height = 3
    while height:
        height -= 3
        i, j, e = stack[height], stack[height + 1], stack[height + 2]
        m = apex(plane, chain, i, j)
        f, g = chain[j - 1], chain[i]
        if m < j - 1:
            f = new_edge(org, work.crossed[free], corner(org, chain, j), corner(org, chain, m))
            free += 1
            stack[height], stack[height + 1], stack[height + 2] = m, j, f ^ 2
            height += 3
        if m > i + 1:
            g = new_edge(org, work.crossed[free], corner(org, chain, m), corner(org, chain, i))
            free += 1
            stack[height], stack[height + 1], stack[height + 2] = i, m, g ^ 2
            height += 3
        link_ring(ring, e, f)
        link_ring(ring, f, g)
        link_ring(ring, g, e)
    return free


@jit
def split_along(plane: Plane, work: Workspace, a: int, b: int, lefts: int, rights: int) -> int:
    """Replace the edges that a march crossed by the edge from a to b and the Delaunay edges beside it; return that edge."""
    left, right = work.left, work.right
    for i in range(rights // 2):
        right[i], right[rights - 1 - i] = right[rights - 1 - i], right[i]
    base = new_edge(plane.org, work.crossed[0], a, b)
    free = fill(plane, work, left, base, lefts, 1)
    fill(plane, work, right, base ^ 2, rights, free)
    for i in range(lefts):
        plane.spoke[origin(plane.org, left[i])] = left[i]
    for i in range(rights):
        plane.spoke[origin(plane.org, right[i])] = right[i]
    return base
