"""The plane sweep: do edges meet only where they share a vertex, and is nothing covered twice?

The line moves in lexicographic order (that of x, ties by y: as if the plane were sheared a little, so that no
edge is vertical). The status holds the edges that it meets, from below to above. Two neighbours are tested
when they become neighbours, which finds the first improper meeting before it can spoil the order [Shamos
1976]: all edges through the lexicographically smallest improper meeting point are neighbours just before it,
unless a vertex lies there that no edge ends in, and that one is met when it is located. No meeting point is
ever computed.
"""

from typing import NamedTuple

import numpy as np

from exactkernel.context import Context, chunk_size
from exactkernel.jit import jit
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, SignArray
from exactmesh.verify.status import NIL, Status, empty_status, insert, remove
from exactmesh.verify.witness import IndexArray

__all__ = ["COVERED_TWICE", "IMPROPER", "PROPER", "swept"]

PROPER = 0
IMPROPER = 1  # two edges meet elsewhere than in a vertex that they share
COVERED_TWICE = 2  # the left side of the second edge has winding number two

_CHUNK = 1 << 14  # vertices between two looks at Ctrl-C


class Segments(NamedTuple):
    """Edges between ranked vertices; all positions differ.

    Attributes:
        points: float64 (v, 2), ascending lexicographically: a vertex is its rank.
        low, high: intp (b,): the two ends of an edge, low < high; ``low`` ascends.
        direction: int8 (b,): +1 if the edge is directed from low to high, so that its left side is above it.
        first_low: intp (v + 1,): the edges that begin at a vertex are first_low[v] .. first_low[v + 1] - 1.
        ending, first_high: the edges that end at v are ending[first_high[v] : first_high[v + 1]].
    """

    points: FloatArray
    low: IndexArray
    high: IndexArray
    direction: SignArray
    first_low: IndexArray
    ending: IndexArray
    first_high: IndexArray


@jit
def turn(k: Context, points: FloatArray, a: int, b: int, c: int) -> int:
    """Return orient2d of three ranked vertices."""
    return orient2d_adaptive(k, points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1])


@jit
def meet_improperly(k: Context, s: Segments, e: int, f: int) -> bool:
    """Tell whether two edges meet elsewhere than in a common vertex.

    Both are met by the sweep line now: none begins where the other ends, and if they are collinear they overlap.
    """
    a, b, c, d = s.low[e], s.high[e], s.low[f], s.high[f]
    if a == c or b == d:
        return turn(k, s.points, a, b, d if a == c else c) == 0
    if turn(k, s.points, a, b, c) * turn(k, s.points, a, b, d) > 0:
        return False
    return bool(turn(k, s.points, c, d, a) * turn(k, s.points, c, d, b) <= 0)


@jit
def neighbours_meet(k: Context, s: Segments, below: int, above: int, witness: IndexArray) -> bool:
    """Test two neighbours of the status, either of which may be NIL."""
    if below == NIL or above == NIL or not meet_improperly(k, s, below, above):
        return False
    witness[0] = below
    witness[1] = above
    return True


@jit
def locate(k: Context, s: Segments, status: Status, e: int) -> tuple[int, int, int]:
    """Return the neighbours between which e begins, and the edge that passes through its beginning or NIL."""
    v = s.low[e]
    below = above = int(NIL)
    node = status.root[0]
    while node != NIL:
        if s.low[node] == v:
            side = turn(k, s.points, v, s.high[node], s.high[e])
        else:
            side = turn(k, s.points, s.low[node], s.high[node], v)
        if side == 0:
            return below, above, node
        if side > 0:
            below = node
            node = status.child[node, 1]
        else:
            above = node
            node = status.child[node, 0]
    return below, above, NIL


@jit
def end_edges(k: Context, s: Segments, status: Status, v: int, witness: IndexArray) -> bool:
    """Remove the edges that end at v: they are neighbours of each other. Tell whether an improper meeting
    showed."""
    below = above = int(NIL)  # not the literal: numba would compile the callees once more for it
    for i in range(s.first_high[v], s.first_high[v + 1]):
        e = s.ending[i]
        below, above = status.below[e], status.above[e]
        remove(status, e)
    return neighbours_meet(k, s, below, above, witness)


@jit
def begin_edges(k: Context, s: Segments, status: Status, v: int, witness: IndexArray) -> int:
    """Insert the edges that begin at v, and compare the winding numbers on their sides.

    Upwards the winding number rises by one across an edge of direction +1 and falls across the others. It is
    0 below everything, and nowhere negative: so 0 and 1 alternate unless two neighbours have the same
    direction, +1.
    """
    for e in range(s.first_low[v], s.first_low[v + 1]):
        below, above, passing = locate(k, s, status, e)
        if passing != NIL:
            witness[0] = passing
            witness[1] = e
            return IMPROPER
        insert(status, e, below, above)
        if neighbours_meet(k, s, below, e, witness) or neighbours_meet(k, s, e, above, witness):
            return IMPROPER
    for e in range(s.first_low[v], s.first_low[v + 1]):
        below = status.below[e]
        if below != NIL and s.direction[below] == s.direction[e]:
            upwards = (
                s.direction[e] > 0
            )  # otherwise their left sides are below them, and the lower one's is covered twice
            witness[0] = below if upwards else e
            witness[1] = e if upwards else below
            return COVERED_TWICE
    return PROPER


@jit
def sweep(k: Context, s: Segments, status: Status, v_begin: int, v_end: int, witness: IndexArray) -> int:
    """Move the line over some vertices, up to the first fault."""
    for v in range(v_begin, v_end):
        if end_edges(k, s, status, v, witness):
            return IMPROPER
        fault = begin_edges(k, s, status, v, witness)
        if fault != PROPER:
            return fault
    return PROPER


def swept(k: Context, points: FloatArray, origin: IndexArray, target: IndexArray) -> tuple[int, int, int]:
    """Return PROPER, IMPROPER or COVERED_TWICE, and two edges as witnesses. O(b log b) expected.

    Args:
        k: context for ``points``.
        points: float64 (v, 2), distinct, ascending lexicographically.
        origin, target: (b,) ranks: the directed edges of the boundary of a set of counterclockwise triangles.
    """
    low, high = np.minimum(origin, target), np.maximum(origin, target)
    order = np.argsort(low, kind="stable")
    ranks = np.arange(len(points) + 1)
    ending = np.argsort(high[order], kind="stable")
    segments = Segments(
        points=points,
        low=low[order],
        high=high[order],
        direction=np.where(origin < target, 1, -1).astype(np.int8)[order],
        first_low=np.searchsorted(low[order], ranks),
        ending=ending,
        first_high=np.searchsorted(high[order][ending], ranks),
    )
    status, witness = empty_status(len(order)), np.full(2, NIL, dtype=np.intp)
    step = chunk_size(k, _CHUNK)
    for begin in range(0, len(points), step):
        fault = sweep(k, segments, status, begin, min(begin + step, len(points)), witness)
        raise_if_interrupted()
        if fault != PROPER:
            return fault, int(order[witness[0]]), int(order[witness[1]])
    return PROPER, NIL, NIL
