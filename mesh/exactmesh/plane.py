"""A triangulation under work: the arrays that the compiled editing operations share, and their predicates."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exactkernel.context import Context
from exactkernel.incircle import incircle_perturbed_adaptive
from exactkernel.jit import jit_inline
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.types import FloatArray
from exactmesh.edgealgebra import EdgeArray, dest, left_next, origin

__all__ = ["BoolArray", "Plane", "conflict", "is_ahead", "march", "orient", "toward"]

BoolArray = npt.NDArray[np.bool_]


class Plane(NamedTuple):
    """A triangulation of the whole plane: the faces outside the convex hull have a corner at the ghost vertex.

    Attributes:
        k: for predicates on ``xy``.
        xy: the coordinates, flat.
        ring, org: the quad-edge; every face is a triangle.
        spoke: an edge that leaves each vertex.
        fixed: whether each edge is constrained.
        loose: scratch, False for every edge: see ``cavity``.
        crossed, left, right: what the last march met, see there.
        stack: scratch, three entries for each edge.
        ghost: the ghost vertex.
    """

    k: Context
    xy: FloatArray
    ring: EdgeArray
    org: EdgeArray
    spoke: EdgeArray
    fixed: BoolArray
    loose: BoolArray
    crossed: EdgeArray
    left: EdgeArray
    right: EdgeArray
    stack: npt.NDArray[np.int64]
    ghost: int


@jit_inline
def orient(plane: Plane, a: int, b: int, c: int) -> int:
    """Return orient2d of three vertices, none of them the ghost."""
    xy = plane.xy
    return orient2d_adaptive(plane.k, xy[2 * a], xy[2 * a + 1], xy[2 * b], xy[2 * b + 1], xy[2 * c], xy[2 * c + 1])


@jit_inline
def conflict(plane: Plane, a: int, b: int, c: int, d: int) -> bool:
    """Tell whether d lies in the perturbed circle of a, b, c, counterclockwise, none of them the ghost."""
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


@jit_inline
def toward(plane: Plane, a: int, b: int) -> tuple[int, bool]:
    """Return (e, True) if the edge e leaves a straight toward b; (e, False) if b lies between e and onext(e)."""
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


@jit_inline
def march(plane: Plane, e: int, b: int) -> tuple[int, int, int, int]:
    """Walk from the origin a of e, across the triangle on its left, toward b, to the first vertex on the way.

    Returns (that vertex, edges crossed, edges on the left, edges on the right), or (-1 - edge, 0, 0, 0) if a fixed edge
    is in the way. ``plane.crossed`` becomes the numbers of the edges crossed; ``left`` and ``right`` the edges of the
    crossed triangles that are not, in order, with those triangles on their left: to a on the left, away on the right.

                 l1 <------ l2 <--- .
               /  |  \\      |         \\
              a --|----\\----|--------- b        crossed: r1 l1, r1 l2, ...
               \\  |      \\  |         /
                 r1 -------> r2 --> .
    """
    ring, org = plane.ring, plane.org
    a = origin(org, e)
    c = left_next(ring, e)  # the edge to be crossed, from its end on the right
    crossed, lefts, rights = 0, 1, 1
    plane.right[0] = e
    plane.left[0] = left_next(ring, c)
    while not plane.fixed[c >> 2]:
        plane.crossed[crossed] = c >> 2
        crossed += 1
        f = left_next(ring, c ^ 2)
        g = left_next(ring, f)
        x = dest(org, f)
        side = 0 if x == b else orient(plane, a, b, x)
        if side >= 0:
            plane.left[lefts] = g
            lefts += 1
            c = f
        if side <= 0:
            plane.right[rights] = f
            rights += 1
            c = g
        if side == 0:
            return x, crossed, lefts, rights
    return -1 - (c >> 2), 0, 0, 0
