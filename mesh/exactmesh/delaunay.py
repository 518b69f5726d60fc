"""Randomized incremental insertion with flips: points in, THE Delaunay triangulation out.

Each point is located by a walk, joined to the corners of its triangle, and the edges of its link are flipped until all
pass the perturbed incircle test. A ghost vertex closes the hull: the face on the outer side of a hull edge u -> v is the
ghost triangle (v, u, ghost), whose circumdisk is the open half plane outside, so points beyond the hull take the same
path as those inside. Reference [Guibas 1985], [Lawson 1977], [Amenta 2003], [Shewchuk 1997].
"""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points
from exactkernel.context import Context, scaled_into_window
from exactkernel.incircle import incircle_perturbed_adaptive
from exactkernel.jit import jit
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray
from exactmesh.edgealgebra import EdgeArray, dest, left_next, link_ring, origin, split_face, swap
from exactmesh.ordering import insertion_order

Progress: TypeAlias = "Callable[[int, int], None]"

_CHUNK = 1 << 17  # points between two looks at Ctrl-C and the progress bar


@jit
def orient(k: Context, xy: FloatArray, a: int, b: int, c: int) -> int:
    """Return orient2d of three vertices, none of them the ghost."""
    return orient2d_adaptive(k, xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1], xy[c, 0], xy[c, 1])


@jit
def in_conflict(k: Context, xy: FloatArray, ghost: int, a: int, b: int, c: int, p: int) -> bool:
    """Tell whether p lies in the (perturbed) circumdisk of the counterclockwise triangle a, b, c, ghost or not."""
    if a == ghost:
        return orient(k, xy, b, c, p) > 0
    if b == ghost:
        return orient(k, xy, c, a, p) > 0
    if c == ghost:
        return orient(k, xy, a, b, p) > 0
    return (
        incircle_perturbed_adaptive(k, xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1], xy[c, 0], xy[c, 1], xy[p, 0], xy[p, 1])
        > 0
    )


@jit
def locate(
    k: Context, xy: FloatArray, ring: EdgeArray, org: EdgeArray, ghost: int, start: int, p: int
) -> tuple[int, int]:
    """Walk from the edge start (no ghost end) to the triangle of p; return (edge, zeros).

    p lies in the closed triangle on the left of the edge: inside (zeros = 0), on the edge (1), or at its origin (2); or
    that triangle is a ghost and p lies strictly beyond its hull edge (zeros = 0).
    """
    e = start
    side = orient(k, xy, origin(org, e), dest(org, e), p)
    if side < 0:
        e, side = e ^ 2, 1
    elif side == 0 and dest(org, left_next(ring, e)) == ghost:
        e = e ^ 2
    while True:
        f = left_next(ring, e)
        apex = dest(org, f)
        if apex == ghost:
            return e, 0
        side_f = orient(k, xy, origin(org, f), apex, p)
        if side_f < 0:
            e, side = f ^ 2, 1
            continue
        g = left_next(ring, f)
        side_g = orient(k, xy, apex, origin(org, e), p)
        if side_g < 0:
            e, side = g ^ 2, 1
            continue
        if side == 0:
            return (e, 2) if side_g == 0 else ((f, 2) if side_f == 0 else (e, 1))
        if side_f == 0:
            return (g, 2) if side_g == 0 else (f, 1)
        return (g, 1) if side_g == 0 else (e, 0)


@jit
def legalize(k: Context, xy: FloatArray, ring: EdgeArray, org: EdgeArray, ghost: int, first: int, p: int) -> int:
    """Flip the edges of p's link, from the edge first on counterclockwise, until none is in conflict with p.

    Returns the number of flips. A flip replaces one edge of the link by two, which are tested next.
    """
    flips = 0
    e = first
    last = origin(org, first)
    while True:
        beyond = left_next(ring, e ^ 2)
        if in_conflict(k, xy, ghost, dest(org, e), origin(org, e), dest(org, beyond), p):
            swap(ring, org, e)
            flips += 1
            e = beyond
        else:
            spoke = left_next(ring, e)  # from the link back to p
            e = left_next(ring, spoke ^ 2)
            if origin(org, e) == last:
                return flips


@jit
def insert_range(
    k: Context,
    xy: FloatArray,
    ring: EdgeArray,
    org: EdgeArray,
    twin: EdgeArray,
    first: int,
    stop: int,
    start: int,
    edges: int,
) -> tuple[int, int, int]:
    """Insert the vertices first .. stop - 1; return (edge near the last one, number of edges, flips).

    ``twin[p]`` becomes the vertex in whose place p lies, or stays p.
    """
    ghost = len(xy)
    flips = 0
    for p in range(first, stop):
        e, zeros = locate(k, xy, ring, org, ghost, start, p)
        if zeros == 2:
            twin[p] = origin(org, e)
            start = e
            continue
        split_face(ring, org, e, 4 * edges, p)
        start = 4 * edges
        edges += 3
        if zeros == 1:  # the flat triangle between p and its edge goes by the flip of that edge
            beyond = left_next(ring, e ^ 2)
            swap(ring, org, e)
            flips += 1
            e = beyond
        flips += legalize(k, xy, ring, org, ghost, e, p)
    return start, edges, flips
