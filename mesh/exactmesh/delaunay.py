"""Randomized incremental insertion with flips: points in, THE Delaunay triangulation out.

Each point is located by a walk, joined to the corners of its triangle, and the edges of its link are flipped until all
pass the perturbed incircle test. A ghost vertex closes the hull: the face on the outer side of a hull edge u -> v is
the ghost triangle (v, u, ghost), whose circumdisk is the open half plane outside, so points beyond the hull take the
same path as those inside. Reference [Guibas 1985], [Lawson 1977], [Amenta 2003], [Shewchuk 1997].
"""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

from collections.abc import Callable
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points
from exactkernel.context import Context, chunk_size, scaled_into_window
from exactkernel.incircle import incircle_perturbed_adaptive
from exactkernel.jit import jit, jit_inline
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray
from exactmesh.edgealgebra import EdgeArray, dest, left_next, link_ring, origin, split_face, swap
from exactmesh.errors import CollinearPointsError, TooFewPointsError, TooManyPointsError
from exactmesh.extract import triangles_of
from exactmesh.ordering import IndexArray, insertion_order
from exactmesh.triangulation import Triangulation, work_of

__all__ = ["MAX_POINTS", "Progress", "delaunay"]

#: Called with (done, total).
Progress: TypeAlias = Callable[[int, int], None]

#: 3 n edges of four quarter-edges each must be numbered in 31 bits.
MAX_POINTS = 2**31 // 12

_CHUNK = 1 << 17  # points between two looks at Ctrl-C and the progress bar, where predicates are fast


# Coordinates are flat, xy[2 v] and xy[2 v + 1]: an index into two dimensions costs a multiplication more each time.


@jit_inline
def orient(k: Context, xy: FloatArray, a: int, b: int, c: int) -> int:
    """Return orient2d of three vertices, none of them the ghost."""
    return orient2d_adaptive(k, xy[2 * a], xy[2 * a + 1], xy[2 * b], xy[2 * b + 1], xy[2 * c], xy[2 * c + 1])


@jit_inline
def in_conflict(k: Context, xy: FloatArray, ghost: int, a: int, b: int, c: int, p: int) -> bool:
    """Tell whether p lies in the (perturbed) circumdisk of the counterclockwise triangle a, b, c, ghost or not."""
    if a == ghost:
        return orient(k, xy, b, c, p) > 0
    if b == ghost:
        return orient(k, xy, c, a, p) > 0
    if c == ghost:
        return orient(k, xy, a, b, p) > 0
    ax, ay, bx, by = xy[2 * a], xy[2 * a + 1], xy[2 * b], xy[2 * b + 1]
    cx, cy, px, py = xy[2 * c], xy[2 * c + 1], xy[2 * p], xy[2 * p + 1]
    return incircle_perturbed_adaptive(k, ax, ay, bx, by, cx, cy, px, py) > 0


@jit_inline
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
    lean = True  # the walk tends to leave triangle after triangle on the same side: that one is tested first
    while True:
        f = left_next(ring, e)
        if dest(org, f) == ghost:
            return e, 0
        g = left_next(ring, f)
        near, far = (f, g) if lean else (g, f)
        side_near = orient(k, xy, origin(org, near), dest(org, near), p)
        if side_near < 0:
            e, side = near ^ 2, 1
            continue
        side_far = orient(k, xy, origin(org, far), dest(org, far), p)
        if side_far < 0:
            e, side, lean = far ^ 2, 1, not lean
            continue
        side_f, side_g = (side_near, side_far) if lean else (side_far, side_near)
        if side == 0:
            return (e, 2) if side_g == 0 else ((f, 2) if side_f == 0 else (e, 1))
        if side_f == 0:
            return (g, 2) if side_g == 0 else (f, 1)
        return (g, 1) if side_g == 0 else (e, 0)


@jit_inline
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
def second_position(xy: FloatArray) -> int:
    """Return the first vertex that lies elsewhere than vertex 0, or n."""
    n = len(xy) // 2
    b = 1
    while b < n and xy[2 * b] == xy[0] and xy[2 * b + 1] == xy[1]:
        b += 1
    return b


@jit
def first_turn(k: Context, xy: FloatArray, b: int, first: int, stop: int) -> tuple[int, int]:
    """Return the first vertex of first .. stop - 1 that is not collinear with 0 and b, or stop; and the turn there."""
    for c in range(first, stop):
        turn = orient(k, xy, 0, b, c)
        if turn != 0:
            return c, turn
    return stop, 0


@jit
def first_triangle(
    xy: FloatArray, order: IndexArray, ring: EdgeArray, org: EdgeArray, b: int, c: int, turn: int
) -> None:
    """Move the vertices b < c to the front and build the triangle that they turn to with 0, and its three ghosts."""
    for position, chosen in ((1, b), (2, c)):
        order[position], order[chosen] = order[chosen], order[position]
        for axis in range(2):
            i, j = 2 * position + axis, 2 * chosen + axis
            xy[i], xy[j] = xy[j], xy[i]
    second, third = (1, 2) if turn > 0 else (2, 1)
    org[0] = org[5] = 0
    org[2] = org[1] = second
    org[4] = org[3] = third
    for e in range(0, 12, 4):
        f = (e + 4) % 12
        link_ring(ring, e, f)
        link_ring(ring, f ^ 2, e ^ 2)
    split_face(ring, org, 2, 12, len(xy) // 2)  # the ghost, in the outer face


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
    ghost = len(xy) // 2
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


def _refuse_flat(points: FloatArray) -> None:
    if (points == points[0]).all():
        raise CollinearPointsError(f"all {len(points)} points are {points[0].tolist()}: they span no triangle")
    raise CollinearPointsError(f"all {len(points)} points lie on one line: they span no triangle")


def _begin(xy: FloatArray, k: Context, order: IndexArray, ring: EdgeArray, org: EdgeArray) -> int:
    """Build the first triangle; return the number of edges: 6, or 0 if all points lie on one line."""
    n, b = len(xy) // 2, second_position(xy)
    step = chunk_size(k, _CHUNK)
    for first in range(b + 1, n, step):
        stop = min(first + step, n)
        c, turn = first_turn(k, xy, b, first, stop)
        raise_if_interrupted()
        if turn != 0:
            first_triangle(xy, order, ring, org, b, c, turn)
            return 6
    return 0


class Insertion(NamedTuple):
    """The Delaunay triangulation while it is still a quad-edge; its vertices are positions in the order of insertion.

    Attributes:
        k: for predicates on ``xy``.
        xy: the coordinates, flat, scaled; the ghost vertex is ``len(xy) // 2``.
        order: which point of the input stands at each position.
        ring, org: the quad-edge, of 3 n edges at most.
        twin: the vertex in whose place each position lies: itself, if it is a vertex.
        edges, flips: how many edges there are, and how many flips it took.
    """

    k: Context
    xy: FloatArray
    order: IndexArray
    ring: EdgeArray
    org: EdgeArray
    twin: EdgeArray
    edges: int
    flips: int


@np.errstate(over="ignore", invalid="ignore")  # interpreted, a numpy scalar warns where a double does not
def insert_points(given: FloatArray, *, seed: int = 0, progress: Progress | None = None) -> Insertion:
    """Return the Delaunay triangulation of finite points, as a quad-edge.

    Raises:
        TooFewPointsError, CollinearPointsError, TooManyPointsError, SeedError: as for :func:`delaunay`.
    """
    if len(given) < 3:
        raise TooFewPointsError(f"{len(given)} points span no triangle; at least 3 are needed")
    if len(given) > MAX_POINTS:
        raise TooManyPointsError(f"{len(given)} points; at most {MAX_POINTS} fit 32-bit edge numbers")
    scaled, k = scaled_into_window(given)
    order = insertion_order(scaled, seed)
    xy = scaled.take(order, axis=0).reshape(-1)
    n = len(order)
    ring = np.empty(12 * n, dtype=np.int32)  # n vertices and the ghost have 3 (n + 1) - 6 edges
    org = np.empty(6 * n, dtype=np.int32)
    twin = np.arange(n, dtype=np.int32)
    start = flips = 0
    edges = _begin(xy, k, order, ring, org)
    step = chunk_size(k, _CHUNK)
    for first in range(3, n if edges else 0, step):
        stop = min(first + step, n)
        start, edges, more = insert_range(k, xy, ring, org, twin, first, stop, start, edges)
        flips += more
        raise_if_interrupted()
        if progress is not None:
            progress(stop, n)
    if edges == 0:
        _refuse_flat(given)
    return Insertion(k, xy, order, ring, org, twin, int(edges), int(flips))


def number_vertices(order: IndexArray, twin: EdgeArray) -> tuple[IndexArray, EdgeArray, EdgeArray]:
    """Return (the input points that become vertices, the vertex at each position of order, of each input point).

    The vertices are numbered in the order of the input; of equal points the first is the vertex.
    """
    n = len(order)
    representative = np.empty(n, dtype=np.int32)
    if (twin == np.arange(n, dtype=np.int32)).all():
        representative[order] = vertex = order.astype(np.int32)
        return np.arange(n), vertex, np.arange(n, dtype=np.int32)
    first = np.full(n, n, dtype=np.int64)  # of each position: the smallest input index of the points that lie there
    np.minimum.at(first, twin, order)
    kept = np.sort(first[first < n])
    vertex = np.full(n, -1, dtype=np.int32)
    places = np.flatnonzero(first < n)
    vertex[places] = np.searchsorted(kept, first[places])
    representative[order] = vertex[twin]
    return kept, vertex, representative


def delaunay(points: npt.ArrayLike, *, seed: int = 0, progress: Progress | None = None) -> Triangulation:
    """Return the Delaunay triangulation of the points: exact, and unique.

    Cocircular points are triangulated by a symbolic perturbation (:func:`exactkernel.incircle_perturbed`), so the
    result depends on the points alone: it is the same for every seed and every order of the input, up to numbering.

    Args:
        points: (n, 2) finite coordinates; float64, or any numeric dtype whose values are doubles exactly.
        seed: chooses the random order of insertion, and so the time it takes, never the result.
        progress: called now and then with (points done, points in all).

    Returns:
        A :class:`Triangulation` of the distinct points. ``representative[i]`` is the vertex that stands for point i.

    Raises:
        TooFewPointsError: fewer than three points.
        CollinearPointsError: all points lie on one line, or in one place.
        NonFiniteError: a coordinate is NaN or infinite; ``indices`` names the points.
        CoordinateError: a value would have to be rounded to become a double.
        ShapeError: not an array of shape (n, 2).
        TooManyPointsError: more than 178,956,970 points.
        SeedError: the seed is no integer, or negative.

    Expected O(n log n) for any input, O(n) after sorting for most. Reference [Guibas 1985], [Amenta 2003].

    >>> from exactmesh import delaunay
    >>> mesh = delaunay([(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0.5)])
    >>> mesh
    Triangulation(5 vertices, 4 triangles)
    >>> mesh.hull.tolist()
    [0, 1, 2, 3]
    """
    given = finite_points(points)
    built = insert_points(given, seed=seed, progress=progress)
    kept, vertex, representative = number_vertices(built.order, built.twin)
    slot = np.full(2 * built.edges, -1, dtype=np.int32)
    triangles, neighbors = triangles_of(built.ring, built.org, slot, vertex)
    return Triangulation(
        points=given.take(kept, axis=0),
        triangles=triangles,
        neighbors=neighbors,
        representative=representative,
        work=work_of(built.k, built.flips),
    )
