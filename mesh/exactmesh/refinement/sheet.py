"""A triangulation that is being refined: the arrays that the compiled operations share.

Faces outside of the domain are polygons, nobody's business; every edge beside one is fixed, as segments are, so nothing
ever walks or flips into them. What belongs to a triangle (its zone, its place in the queue, why it was given up) is
kept at half-edges: half ``h = e >> 1`` of the edge e stands for the triangle on the left of e.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exactkernel.context import Context
from exactkernel.incircle import incircle_perturbed_adaptive
from exactkernel.jit import jit_inline
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.types import FloatArray
from exactmesh.edgealgebra import EdgeArray

__all__ = [
    "ANGLE",
    "ASKED",
    "DEAD",
    "EDGES",
    "FAULTS",
    "FIXED",
    "FLIPS",
    "GIVEN_UP",
    "KNOWN",
    "OUTSIDE",
    "SIZE",
    "TOP",
    "VERTICES",
    "WAITING",
    "ByteArray",
    "Counts",
    "Sheet",
    "conflict",
    "distance_squared",
    "orient",
]

ByteArray = npt.NDArray[np.int8]
Counts = npt.NDArray[np.int64]

#: Entries of ``Sheet.counts``: vertices, edges, fixed ones among them, those that wait to be divided, a bound of the
#: buckets in use, flips, vertices that were removed.
VERTICES, EDGES, FIXED, WAITING, TOP, FLIPS, DEAD = range(7)

#: Parts of ``Sheet.state``. ASKED: one of the user's functions says that something is wrong with the triangle.
ANGLE, SIZE, ASKED, KNOWN, GIVEN_UP = 1, 2, 4, 8, 16
FAULTS = ANGLE | SIZE | ASKED

#: The zone of a face outside of the domain.
OUTSIDE = -1


class Sheet(NamedTuple):
    """The triangulation under refinement. Arrays have room for more; ``counts`` tells how much of them is in use.

    Attributes:
        k: for predicates on ``xy``.
        xy: coordinates of the vertices, flat.
        ring, org: the quad-edge.
        zone: of each half-edge, which area bound holds on its left, or OUTSIDE.
        segment: of each edge, the constrained edge of the input that it is part of, or -1.
        hard: of each edge, the :class:`Reason` for which it must not be split, or 0.
        line: of each vertex, the constrained edge of the input that it divides, or -1.
        parent, radius: of each vertex, the one that caused it, and the distance to the nearest that it saw when it
            came; -1 and the shortest edge for vertices of the input.
        root: of each vertex, the radius of the first of its ancestors that had to be as close as it was.
        kind: of each vertex, its :class:`SteinerKind`, or 0 for the input, or -1 if it was removed.
        waiting: rows (edge, destination, parent, cause) of fixed edges to be divided.
        before, after: the queue of triangles, see ``queue``.
        state: of each half-edge, what is known of the triangle on its left: its FAULTS, if it is in the queue; KNOWN,
            if the user's functions have been asked about it; GIVEN_UP times the :class:`Reason` for that.
        flipped, hit: scratch, one entry for each edge.
        counts: int64.
    """

    k: Context
    xy: FloatArray
    ring: EdgeArray
    org: EdgeArray
    zone: EdgeArray
    segment: EdgeArray
    hard: ByteArray
    line: EdgeArray
    parent: EdgeArray
    radius: FloatArray
    root: FloatArray
    kind: ByteArray
    waiting: EdgeArray
    before: EdgeArray
    after: EdgeArray
    state: ByteArray
    flipped: EdgeArray
    hit: EdgeArray
    counts: Counts


@jit_inline
def orient(s: Sheet, a: int, b: int, c: int) -> int:
    """Return orient2d of three vertices."""
    xy = s.xy
    return orient2d_adaptive(s.k, xy[2 * a], xy[2 * a + 1], xy[2 * b], xy[2 * b + 1], xy[2 * c], xy[2 * c + 1])


@jit_inline
def conflict(s: Sheet, a: int, b: int, c: int, d: int) -> bool:
    """Tell whether d lies in the perturbed circle of a, b, c, counterclockwise."""
    xy = s.xy
    ax, ay, bx, by = xy[2 * a], xy[2 * a + 1], xy[2 * b], xy[2 * b + 1]
    cx, cy, dx, dy = xy[2 * c], xy[2 * c + 1], xy[2 * d], xy[2 * d + 1]
    return incircle_perturbed_adaptive(s.k, ax, ay, bx, by, cx, cy, dx, dy) > 0


@jit_inline
def distance_squared(xy: FloatArray, a: int, b: int) -> float:
    """Return the squared distance of two vertices, rounded."""
    dx, dy = xy[2 * a] - xy[2 * b], xy[2 * a + 1] - xy[2 * b + 1]
    return float(dx * dx + dy * dy)
