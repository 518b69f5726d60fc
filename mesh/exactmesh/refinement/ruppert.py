"""Ruppert's algorithm: divide segments that are encroached upon, and put a point where a bad triangle is, in turn.

A point for a bad triangle that would come too close to a segment, or lie beyond it, is not put there; the segment is
divided instead. Reference [Ruppert 1995], [Shewchuk 2002], [Miller 2003], [Ungor 2004].
"""

from exactkernel.jit import jit
from exactmesh.edgealgebra import dest, left_next
from exactmesh.refinement.judging import await_split, judge
from exactmesh.refinement.queue import next_half
from exactmesh.refinement.rules import Reason, Rules, SteinerKind, is_encroached
from exactmesh.refinement.segments import divide_segment
from exactmesh.refinement.sheet import DEAD, EDGES, FAULTS, FIXED, GIVEN_UP, OUTSIDE, VERTICES, WAITING, Sheet
from exactmesh.refinement.triangles import refine_triangle

__all__ = ["BUDGET", "DONE", "MORE", "ROOM", "judge_all", "mark_encroached", "run"]

#: What a run ended with: nothing left to do, more to do, a full array, no points left.
DONE, MORE, ROOM, BUDGET = range(4)

_BUDGET = int(Reason.BUDGET)
_ENCROACHED = int(SteinerKind.ENCROACHED)


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
