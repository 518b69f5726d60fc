"""Fixed edges are divided: halfway, or on common circles where segments meet sharply; never so that a mesh is wrong.

Reference [Ruppert 1995], [Shewchuk 2002], [Miller 2003].
"""

import math

from exactkernel.jit import jit, jit_inline
from exactkernel.types import FloatArray
from exactmesh.edgealgebra import dest, left_next, origin
from exactmesh.refinement.insertion import (
    divide_edge,
    is_inside,
    legalize,
    rejoin_edge,
    spokes_are_delaunay,
    undo_flips,
)
from exactmesh.refinement.judging import accept, await_split, is_crowded, judge, nearest_squared, settle
from exactmesh.refinement.placement import is_finite
from exactmesh.refinement.removal import remove_vertex
from exactmesh.refinement.rules import Reason, Rules, SteinerKind, is_encroached
from exactmesh.refinement.sheet import FLIPS, VERTICES, Sheet, distance_squared, orient
from exactmesh.refinement.split_point import split_point

__all__ = ["divide_segment"]

_WELL = 4.0  # squared: the parts of an edge are to be twice as long as the parent is away
_HALFWAY = 0.125  # how far from the middle, in lengths of the edge, will do
_ON_CIRCLE = 1e-4  # how far from a common circle, in lengths of the edge, will do: each of its digits costs bits

_MINIMUM_EDGE = int(Reason.MINIMUM_EDGE)
_PRECISION = int(Reason.PRECISION)
_TERMINATION = int(Reason.TERMINATION)
_ENCROACHED = int(SteinerKind.ENCROACHED)
_YIELDED = int(SteinerKind.YIELDED)
_INTERIOR = int(SteinerKind.INTERIOR)


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
def is_in_circle(xy: FloatArray, a: int, b: int, p: int) -> bool:
    """Tell whether p is in the circle with the diameter ab, in plain floating point."""
    across = (xy[2 * a] - xy[2 * p]) * (xy[2 * b] - xy[2 * p])
    return bool(across + (xy[2 * a + 1] - xy[2 * p + 1]) * (xy[2 * b + 1] - xy[2 * p + 1]) < 0.0)


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
    if is_crowded(s, rules, first, p, nearest):
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
