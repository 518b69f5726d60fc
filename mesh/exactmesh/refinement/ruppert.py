"""Ruppert's algorithm: divide segments that are encroached upon, and put a point where a bad triangle is, in turn.

A point for a bad triangle that would come too close to a segment, or lie beyond it, is not put there; the segment is
divided instead. Reference [Ruppert 1995], [Shewchuk 2002], [Miller 2003], [Ungor 2004].
"""

import math

from exactkernel.jit import jit, jit_inline
from exactkernel.types import FloatArray
from exactmesh.edgealgebra import dest, left_next, origin
from exactmesh.refinement.insertion import (
    close_face,
    divide_edge,
    divide_face,
    is_inside,
    legalize,
    rejoin_edge,
    seek,
    spokes_are_delaunay,
    undo_flips,
)
from exactmesh.refinement.placement import is_finite, move_to_lattice, place_centre, place_centroid, shortest_edge
from exactmesh.refinement.queue import bucket_of, enqueue, forget, next_half
from exactmesh.refinement.removal import remove_vertex
from exactmesh.refinement.rules import Reason, Rules, SteinerKind, faults_of, is_encroached, joins_sharp_segments
from exactmesh.refinement.sheet import (
    ANGLE,
    ASKED,
    DEAD,
    EDGES,
    FAULTS,
    FIXED,
    FLIPS,
    GIVEN_UP,
    KNOWN,
    OUTSIDE,
    SIZE,
    VERTICES,
    WAITING,
    Sheet,
    distance_squared,
    orient,
)
from exactmesh.refinement.split_point import split_point

_THICK = 1.0 / 64.0  # the height of a triangle, in lengths of its longest edge
_WELL = 4.0  # squared: the parts of an edge are to be twice as long as the parent is away
_HALFWAY = 0.125  # how far from the middle, in lengths of the edge, will do
_ON_CIRCLE = 1e-4  # how far from a common circle, in lengths of the edge, will do: each of its digits costs bits

__all__ = ["BUDGET", "DONE", "MORE", "ROOM", "judge_all", "mark_encroached", "run"]

#: What a run ended with: nothing left to do, more to do, a full array, no points left.
DONE, MORE, ROOM, BUDGET = range(4)

_SMALL_INPUT_ANGLE = int(Reason.SMALL_INPUT_ANGLE)
_BUDGET = int(Reason.BUDGET)
_MINIMUM_EDGE = int(Reason.MINIMUM_EDGE)
_PRECISION = int(Reason.PRECISION)
_FORBIDDEN = int(Reason.FORBIDDEN)
_TERMINATION = int(Reason.TERMINATION)
_ENCROACHED = int(SteinerKind.ENCROACHED)
_YIELDED = int(SteinerKind.YIELDED)
_INTERIOR = int(SteinerKind.INTERIOR)
_YIELDED_TO_SIZE = _YIELDED | 4  # where the points come as close as the sizes that are asked for


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
def settle(s: Sheet, nearest: float, p: int, parent: int, kind: int, root: float, line: int) -> None:
    """Make p a vertex, whose nearest is at that squared distance; root 0: it is one of its own."""
    radius = math.sqrt(nearest)
    s.line[p], s.parent[p], s.kind[p] = line, parent, kind
    s.radius[p] = radius
    s.root[p] = radius if root == 0.0 else root
    s.counts[VERTICES] = p + 1


@jit_inline
def concentric(s: Sheet, rules: Rules, a: int, b: int, centre: int, parent: int) -> float:
    """Return where the circle round the centre through the parent divides ab, or 0.0 if that is not well inside."""
    line = s.line[parent]
    if s.kind[parent] != 0 and (line < 0 or (rules.ends[line, 0] != centre and rules.ends[line, 1] != centre)):
        return 0.0
    xy = s.xy
    radius = math.sqrt(distance_squared(xy, centre, parent))
    first, last = math.sqrt(distance_squared(xy, centre, a)), math.sqrt(distance_squared(xy, centre, b))
    if first == last:
        return 0.0
    t = (radius - first) / (last - first)
    if not 0.0 < t < 1.0:
        return 0.0
    dx, dy = xy[2 * b] - xy[2 * a], xy[2 * b + 1] - xy[2 * a + 1]
    px, py = xy[2 * a] + t * dx - xy[2 * parent], xy[2 * a + 1] + t * dy - xy[2 * parent + 1]
    shorter = min(t, 1.0 - t)
    return t if shorter * shorter * (dx * dx + dy * dy) >= _WELL * (px * px + py * py) else 0.0


@jit_inline
def parameter(s: Sheet, rules: Rules, row: int, a: int, b: int, parent: int) -> tuple[float, float]:
    """Return where to divide the edge ab of the constrained edge row, and how far from there will do.

    Halfway; but where segments meet sharply, they are divided on common circles round that end, so that they do not
    encroach on one another for ever: the edge that begins there at a power of two, others on the circle of the parent
    if that divides them well.
    """
    for end in range(2):
        v = rules.ends[row, end]
        angle = rules.sharp[row, end]
        if angle == 0.0:
            continue
        slack = min(_ON_CIRCLE, 0.25 * angle * angle)
        if v not in (a, b):
            t = concentric(s, rules, a, b, v, parent)
            if t > 0.0:
                return t, slack
        else:
            length = math.sqrt(distance_squared(s.xy, a, b))
            if length == 0.0:
                break
            _, exponent = math.frexp(length / 1.5)
            part = math.ldexp(0.5, exponent) / length  # in (1/3, 2/3]
            return (part if v == a else 1.0 - part), slack
    return 0.5, _HALFWAY


@jit_inline
def fits(s: Sheet, e: int, p: int) -> bool:
    """Tell whether the triangle on the left of e, if there is one, falls into two when p divides e."""
    if not is_inside(s, e):
        return True
    a, b, c = origin(s.org, e), dest(s.org, e), dest(s.org, left_next(s.ring, e))
    return orient(s, a, p, c) > 0 and orient(s, p, b, c) > 0


@jit_inline
def clear_circle(s: Sheet, rules: Rules, e: int) -> None:
    """Remove the vertices inside the domain that are next to the fixed edge e and in its diametral circle."""
    while is_inside(s, e):
        spoke = left_next(s.ring, left_next(s.ring, e))
        apex = origin(s.org, spoke)
        if s.kind[apex] != _INTERIOR or not is_in_circle(s.xy, origin(s.org, e), dest(s.org, e), apex):
            return
        edges, single = remove_vertex(s, spoke)
        if edges < 0:
            return
        judge(s, rules, single)
        for i in range(edges):
            judge(s, rules, 4 * s.flipped[i])
            judge(s, rules, 4 * s.flipped[i] ^ 2)


@jit_inline
def is_in_circle(xy: FloatArray, a: int, b: int, p: int) -> bool:
    """Tell whether p is in the circle with the diameter ab, in plain floating point."""
    across = (xy[2 * a] - xy[2 * p]) * (xy[2 * b] - xy[2 * p])
    return bool(across + (xy[2 * a + 1] - xy[2 * p + 1]) * (xy[2 * b + 1] - xy[2 * p + 1]) < 0.0)


@jit_inline
def inherited(s: Sheet, rules: Rules, row: int, parent: int, cause: int) -> float:
    """Return the root that a point on the row has from its parent, or 0.0 if it is one of its own.

    A vertex of the input, or on a segment elsewhere, is as close as it is; one on a segment with a common end is there
    because of what divided that.
    """
    if cause == _YIELDED:
        return float(s.root[parent])
    line = s.line[parent]
    if cause != _ENCROACHED or s.kind[parent] == 0 or line < 0:
        return 0.0
    for i in range(2):
        for j in range(2):
            if rules.ends[row, i] == rules.ends[line, j]:
                return float(s.root[parent])
    return 0.0


@jit_inline
def first_of_link(s: Sheet, e: int, new: int) -> int:
    """Return the first edge of the link of the vertex between the fixed edges e, which ends there, and new."""
    return left_next(s.ring, new) if is_inside(s, new) else left_next(s.ring, e ^ 2)


@jit
def divide_segment(s: Sheet, rules: Rules, e: int, parent: int, cause: int) -> None:
    """Divide a fixed edge, or mark it as hard."""
    xy, p = s.xy, int(s.counts[VERTICES])
    a, b = origin(s.org, e), dest(s.org, e)
    row = int(s.segment[e >> 2])
    t, slack = parameter(s, rules, row, a, b, parent)
    if slack == _HALFWAY:
        clear_circle(s, rules, e)
        clear_circle(s, rules, e ^ 2)
    x, y, is_on_line = split_point(xy[2 * a], xy[2 * a + 1], xy[2 * b], xy[2 * b + 1], t, slack, rules.unit)
    xy[2 * p], xy[2 * p + 1] = x, y
    if not (is_finite(xy, p) and fits(s, e, p) and fits(s, e ^ 2, p)):
        s.hard[e >> 2] = _PRECISION
        return
    shorter, root = min(distance_squared(xy, a, p), distance_squared(xy, b, p)), inherited(s, rules, row, parent, cause)
    if shorter < rules.shrink * root * root:
        s.hard[e >> 2] = _TERMINATION
        return
    new = divide_edge(s, e, p)
    flips, _ = legalize(s, first_of_link(s, e, new), p)
    first = first_of_link(s, e, new)
    nearest, fault = nearest_squared(s, first, p), 0
    if nearest < rules.min_edge:
        fault = _MINIMUM_EDGE
    elif not is_on_line and not spokes_are_delaunay(s, first, p):
        fault = _PRECISION
    if fault != 0:
        undo_flips(s, flips)
        rejoin_edge(s, e, new)
        s.hard[e >> 2] = fault
        return
    s.counts[FLIPS] += flips
    settle(s, nearest, p, parent, cause & 3, root, row)
    accept(s, rules, first, p)
    for part in (e, e ^ 2, new, new ^ 2):
        if is_inside(s, part):
            apex = dest(s.org, left_next(s.ring, part))
            if s.hard[part >> 2] == 0 and is_encroached(s, rules, part, apex):
                await_split(s, part, apex, _ENCROACHED)


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
def give_up(s: Sheet, half: int, reason: int) -> None:
    """Leave a triangle as it is."""
    known = s.state[half] & KNOWN
    forget(s, half)
    s.state[half] = GIVEN_UP * reason | known


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
        yield_to(s, half, found, parent, _YIELDED if faults == ANGLE else _YIELDED_TO_SIZE)
        return
    if zeros > 1:
        give_up(s, half, _PRECISION)
        return
    insert_for(s, rules, half, found, zeros, p, parent, root if faults == ANGLE else 0.0)


@jit_inline
def insert_for(s: Sheet, rules: Rules, half: int, e: int, zeros: int, p: int, parent: int, root: float) -> None:
    """Insert p into the triangle on the left of e, or onto e (zeros = 1), for the bad triangle of the half-edge."""
    new = divide_face(s, e, p) if zeros == 0 else divide_edge(s, e, p)
    flips, walls = legalize(s, left_next(s.ring, new), p)
    first = left_next(s.ring, new)
    hits = hindrance(s, rules, p, walls)
    nearest = nearest_squared(s, first, p)
    too_near = nearest < rules.min_edge
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
            await_split(s, int(s.hit[i]), parent, _YIELDED if root > 0.0 else _YIELDED_TO_SIZE)
            return
    give_up(s, half, reason)


@jit
def has_room(s: Sheet) -> bool:
    """Tell whether one more step fits into the arrays: two vertices, eight edges, and what waits."""
    vertices = s.counts[VERTICES] + 2 <= len(s.line)
    edges = s.counts[EDGES] + 8 <= len(s.segment)
    waiting = 4 * (s.counts[WAITING] + s.counts[FIXED] + 8) <= len(s.waiting)
    return bool(vertices and edges and waiting)


@jit
def run(s: Sheet, rules: Rules, steps: int) -> int:
    """Take up to so many steps; return DONE, MORE, ROOM or BUDGET."""
    for _ in range(steps):
        if not has_room(s):
            return ROOM
        if s.counts[WAITING] > 0:
            if s.counts[VERTICES] - s.counts[DEAD] >= rules.max_vertices:
                return BUDGET
            s.counts[WAITING] -= 1
            i = 4 * s.counts[WAITING]
            e = 4 * int(s.waiting[i])
            # where it was divided meanwhile, its parts have been looked at
            if dest(s.org, e) == s.waiting[i + 1] and s.hard[e >> 2] == 0:
                divide_segment(s, rules, e, int(s.waiting[i + 2]), int(s.waiting[i + 3]))
            continue
        half = next_half(s)
        if half < 0:
            return DONE
        if s.counts[VERTICES] - s.counts[DEAD] >= rules.max_vertices:
            return BUDGET
        refine_triangle(s, rules, half)
    return MORE


@jit
def mark_encroached(s: Sheet, rules: Rules) -> None:
    """Give up the triangles beside segments that are not Gabriel in the end."""
    for half in range(2 * s.counts[EDGES]):
        e = 2 * half
        if s.segment[e >> 2] < 0 or s.zone[half] == OUTSIDE:
            continue
        f = left_next(s.ring, e)
        g = left_next(s.ring, f)
        known = s.state[half] | s.state[f >> 1] | s.state[g >> 1]
        if known & FAULTS == 0 and known < GIVEN_UP and is_encroached(s, rules, e, dest(s.org, f)):
            s.state[half] = GIVEN_UP * (s.hard[e >> 2] if s.hard[e >> 2] != 0 else _BUDGET)


@jit
def judge_all(s: Sheet, rules: Rules, first: int, stop: int) -> None:
    """Judge all triangles and fixed edges among the edges first .. stop - 1."""
    for half in range(2 * first, 2 * stop):
        if s.zone[half] == OUTSIDE:
            continue
        e = 2 * half
        f = left_next(s.ring, e)
        g = left_next(s.ring, f)
        if e < f and e < g:
            judge(s, rules, e)
        if s.segment[e >> 2] >= 0 and s.hard[e >> 2] == 0 and is_encroached(s, rules, e, dest(s.org, f)):
            await_split(s, e, dest(s.org, f), _ENCROACHED)
