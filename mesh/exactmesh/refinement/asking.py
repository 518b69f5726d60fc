"""The user's functions, asked about many triangles at a time.

A round of refinement ends when nothing is left to do; then they are asked about the triangles that are new, and what
they object to starts the next round. Each triangle is asked about once, so a function that changes its mind does no
harm, and the number of calls grows with the logarithm of the number of triangles.
"""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from exactkernel.context import Context
from exactkernel.jit import jit
from exactkernel.measure import area_above_adaptive, length_above_adaptive
from exactkernel.types import FloatArray, IntArray
from exactmesh.edgealgebra import left_next, origin
from exactmesh.plane import BoolArray
from exactmesh.refinement.options import Size, Unsuitable, flags_of, sizes_of
from exactmesh.refinement.placement import shortest_edge
from exactmesh.refinement.queue import bucket_of, enqueue, forget
from exactmesh.refinement.rules import Rules
from exactmesh.refinement.sheet import ASKED, EDGES, FAULTS, KNOWN, OUTSIDE, Sheet
from exactmesh.triangulation import Triangulation

__all__ = ["Question", "area_question", "ask", "size_question", "unsuitable_question"]

#: Answers for the corners (k, 3, 2) of triangles which of them to refine.
Question: TypeAlias = Callable[[FloatArray], BoolArray]


def unsuitable_question(unsuitable: Unsuitable) -> Question:
    """Return the question whether the user's function finds triangles unsuitable."""

    def answer(corners: FloatArray) -> BoolArray:
        return flags_of(unsuitable(corners, areas_of(corners)), len(corners))

    return answer


def areas_of(corners: FloatArray) -> FloatArray:
    """Return the areas of triangles, rounded."""
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    areas: FloatArray = 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    return areas


@jit
def has_long_edge(k: Context, corners: FloatArray, sizes: FloatArray, answer: BoolArray) -> None:
    """Tell for each triangle whether an edge is longer than its size."""
    for t in range(len(corners)):
        for i in range(3):
            j = (i + 1) % 3
            ax, ay, bx, by = corners[t, i, 0], corners[t, i, 1], corners[t, j, 0], corners[t, j, 1]
            if length_above_adaptive(k, sizes[t], ax, ay, bx, by):
                answer[t] = True


def size_question(size: Size, k: Context) -> Question:
    """Return the question whether triangles have edges longer than the size wanted at their centroids."""

    def answer(corners: FloatArray) -> BoolArray:
        at = corners.mean(axis=1)
        found = np.zeros(len(corners), dtype=np.bool_)
        has_long_edge(k, corners, sizes_of(size(at), len(corners), at), found)
        return found

    return answer


@jit
def is_too_large(k: Context, corners: FloatArray, areas: FloatArray, answer: BoolArray) -> None:
    """Tell for each triangle whether it is larger than the area given for it."""
    for t in range(len(corners)):
        a, b, c = corners[t, 0], corners[t, 1], corners[t, 2]
        answer[t] = area_above_adaptive(k, areas[t], a[0], a[1], b[0], b[1], c[0], c[1])


def area_question(mesh: Triangulation, max_area: FloatArray, k: Context) -> Question:
    """Return the question whether triangles are larger than allowed in that triangle of a mesh where their centroid is.

    A centroid that rounding puts outside of the mesh allows everything.
    """
    allowed = np.append(max_area, np.inf)

    def answer(corners: FloatArray) -> BoolArray:
        found = np.zeros(len(corners), dtype=np.bool_)
        is_too_large(k, corners, allowed[mesh.locate(corners.mean(axis=1))], found)
        return found

    return answer


@jit
def collect_fresh(s: Sheet, halves: IntArray) -> int:
    """Write a half-edge of each triangle that is not known yet; then they are. Return how many."""
    count = 0
    for half in range(2 * s.counts[EDGES]):
        if s.zone[half] == OUTSIDE or s.state[half] & KNOWN:
            continue
        halves[count] = half
        count += 1
        e = 2 * half
        for _ in range(3):
            s.state[e >> 1] |= KNOWN
            e = left_next(s.ring, e)
    return count


@jit
def write_corners(s: Sheet, halves: IntArray, corners: FloatArray) -> None:
    """Write the corners (k, 3, 2) of the triangles on the left of the half-edges."""
    for t in range(len(halves)):
        e = 2 * int(halves[t])
        for i in range(3):
            v = origin(s.org, e)
            corners[t, i, 0], corners[t, i, 1] = s.xy[2 * v], s.xy[2 * v + 1]
            e = left_next(s.ring, e)


@jit
def enqueue_all(s: Sheet, rules: Rules, halves: IntArray) -> None:
    """Queue the triangles on the left of the half-edges."""
    for half in halves:
        shortest, squared = shortest_edge(s, 2 * half)
        e, faults = shortest, ASKED
        for _ in range(3):
            faults |= s.state[e >> 1] & FAULTS
            forget(s, e >> 1)
            s.state[e >> 1] = KNOWN
            e = left_next(s.ring, e)
        s.state[half] |= faults
        enqueue(s, half, bucket_of(rules.longest, squared, False))


def ask(s: Sheet, rules: Rules, questions: list[Question], exponent: int) -> bool:
    """Ask about all triangles that are new; tell whether any was objected to."""
    halves = np.empty(2 * int(s.counts[EDGES]) // 3 + 1, dtype=np.int32)
    halves = halves[: int(collect_fresh(s, halves))]
    count = len(halves)
    if count == 0:  # nothing for a function to stumble over
        return False
    corners = np.empty((count, 3, 2))
    write_corners(s, halves, corners)
    corners = np.ldexp(corners, -exponent)
    corners.setflags(write=False)
    objected = np.zeros(count, dtype=np.bool_)
    for question in questions:
        objected |= question(corners)
    enqueue_all(s, rules, halves[objected])
    return bool(objected.any())
