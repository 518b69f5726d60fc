"""What is noted of triangles, vertices and fixed edges: which wait, which are given up, and what came of whom."""

import math

from exactkernel.jit import jit, jit_inline
from exactkernel.measure import length_code
from exactmesh.edgealgebra import dest, left_next, origin
from exactmesh.refinement.insertion import is_inside
from exactmesh.refinement.placement import shortest_edge
from exactmesh.refinement.queue import bucket_of, enqueue, forget
from exactmesh.refinement.rules import Reason, Rules, SteinerKind, faults_of, is_encroached, joins_sharp_segments
from exactmesh.refinement.sheet import ANGLE, GIVEN_UP, KNOWN, VERTICES, WAITING, Sheet, distance_squared

__all__ = ["YIELDED_TO_SIZE", "accept", "await_split", "give_up", "is_crowded", "judge", "nearest_squared", "settle"]

_SMALL_INPUT_ANGLE = int(Reason.SMALL_INPUT_ANGLE)
_ENCROACHED = int(SteinerKind.ENCROACHED)

_CLEAR = 1.001  # a square beyond that times another is larger, rounded as they are
_TINY = 2.0**-1000  # unless they underflow

#: The cause of a point that divides a segment for a triangle that is too large: it is as close as was asked for.
YIELDED_TO_SIZE = int(SteinerKind.YIELDED) | 4


@jit_inline
def judge(s: Sheet, rules: Rules, e: int) -> None:
    """Look at a new triangle, on the left of e: into the queue, or given up, or good."""
    f = left_next(s.ring, e)
    g = left_next(s.ring, f)
    forget(s, e >> 1)
    forget(s, f >> 1)
    forget(s, g >> 1)
    faults = faults_of(s, rules, e, origin(s.org, e), origin(s.org, f), origin(s.org, g))
    if faults != 0:
        file_fault(s, rules, e, faults)


@jit_inline
def file_fault(s: Sheet, rules: Rules, e: int, faults: int) -> None:
    """Queue a triangle with faults, or give it up where nothing but the input's own angles is wrong with it."""
    shortest, squared = shortest_edge(s, e)
    if faults == ANGLE and joins_sharp_segments(s, rules, origin(s.org, shortest), dest(s.org, shortest)):
        s.state[e >> 1] = GIVEN_UP * _SMALL_INPUT_ANGLE
        return
    s.state[e >> 1] = faults
    enqueue(s, e >> 1, bucket_of(rules.longest, squared, faults == ANGLE))


@jit_inline
def give_up(s: Sheet, half: int, reason: int) -> None:
    """Leave a triangle as it is."""
    known = s.state[half] & KNOWN
    forget(s, half)
    s.state[half] = GIVEN_UP * reason | known


@jit_inline
def await_split(s: Sheet, e: int, parent: int, cause: int) -> None:
    """Note that the fixed edge e is to be divided."""
    i = 4 * s.counts[WAITING]
    s.waiting[i], s.waiting[i + 1] = e >> 2, dest(s.org, 4 * (e >> 2))
    s.waiting[i + 2], s.waiting[i + 3] = parent, cause
    s.counts[WAITING] += 1


@jit_inline
def accept(s: Sheet, rules: Rules, first: int, p: int) -> None:
    """Judge the triangles round p, from the edge first of its link on."""
    e, last = first, origin(s.org, first)
    while True:
        judge(s, rules, e)
        if s.segment[e >> 2] >= 0 and s.hard[e >> 2] == 0 and is_encroached(s, rules, e, p):
            await_split(s, e, p, _ENCROACHED)
        spoke = left_next(s.ring, e)
        if not is_inside(s, spoke ^ 2):
            return
        e = left_next(s.ring, spoke ^ 2)
        if origin(s.org, e) == last:
            return


@jit_inline
def nearest_squared(s: Sheet, first: int, p: int) -> float:
    """Return the squared length of the shortest edge at p; first is the first edge of its link."""
    e, last = first, origin(s.org, first)
    nearest = distance_squared(s.xy, last, p)
    while True:
        nearest = min(nearest, distance_squared(s.xy, dest(s.org, e), p))
        spoke = left_next(s.ring, e)
        if not is_inside(s, spoke ^ 2):
            return nearest
        e = left_next(s.ring, spoke ^ 2)
        if origin(s.org, e) == last:
            return nearest


@jit_inline
def is_shorter(s: Sheet, length: float, a: int, b: int) -> bool:
    """Tell whether the edge ab is shorter than the length, exactly."""
    xy = s.xy
    return (length_code(s.k, length, xy[2 * a], xy[2 * a + 1], xy[2 * b], xy[2 * b + 1]) & 3) == 0


@jit
def is_crowded(s: Sheet, rules: Rules, first: int, p: int, nearest: float) -> bool:
    """Tell whether an edge at p is shorter than the least edge, exactly; ``nearest`` is the shortest's square, rounded.

    First is the first edge of p's link.
    """
    if rules.min_edge == 0.0 or nearest > max(_CLEAR * rules.min_edge * rules.min_edge, _TINY):
        return False
    e, last = first, origin(s.org, first)
    if is_shorter(s, rules.min_edge, last, p):
        return True
    while True:
        if is_shorter(s, rules.min_edge, dest(s.org, e), p):
            return True
        spoke = left_next(s.ring, e)
        if not is_inside(s, spoke ^ 2):
            return False
        e = left_next(s.ring, spoke ^ 2)
        if origin(s.org, e) == last:
            return False


@jit_inline
def settle(s: Sheet, nearest: float, p: int, parent: int, kind: int, root: float, line: int) -> None:
    """Make p a vertex, whose nearest is at that squared distance; root 0: it is one of its own."""
    radius = math.sqrt(nearest)
    s.line[p], s.parent[p], s.kind[p] = line, parent, kind
    s.radius[p] = radius
    s.root[p] = radius if root == 0.0 else root
    s.counts[VERTICES] = p + 1
