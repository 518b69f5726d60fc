"""Compiled passes over a Voronoi diagram and the triangulation: whose ridges, and whose ends."""

import math

import numpy as np
import numpy.typing as npt

from exactkernel.centre import circumcentre_in_pairs
from exactkernel.context import Context
from exactkernel.incircle import incircle_adaptive
from exactkernel.jit import jit
from exactkernel.types import FloatArray, IntArray
from exactmesh.verify.links import _LOW, BOUNDARY, Links, slot_of
from exactmesh.verify.witness import IndexArray

__all__ = [
    "NO", "UNKNOWN", "YES", "expect_ridges", "fill_centres", "find_ridges", "is_centre", "match_ends", "match_vertices",
]  # fmt: skip

#: Whether a vertex is a circumcentre; UNKNOWN is for the rationals.
NO, YES, UNKNOWN = 0, 1, 2
_SLACK = 1.0 + 2.0**-20


@jit
def between_neighbours(claimed: float, x: float, tail: float, error: float) -> int:
    """Tell whether a number within the error of x + tail lies between the doubles below and above the claimed one."""
    if not error < math.inf or not abs(claimed) < math.inf:
        return UNKNOWN
    above = (x - math.nextafter(claimed, -math.inf)) + tail
    below = (math.nextafter(claimed, math.inf) - x) - tail
    doubt = _SLACK * error + 2.0**-50 * (abs(above) + abs(below)) + 2.0**-1000
    if above > doubt and below > doubt:
        return YES
    return NO if above < -doubt or below < -doubt else UNKNOWN


@jit
def is_centre(centres: FloatArray, t: int, x: float, y: float) -> int:
    """Tell whether x and y are doubles next to the circumcentre of the triangle t."""
    first = between_neighbours(x, centres[t, 0], centres[t, 1], centres[t, 2])
    if first == NO:
        return NO
    second = between_neighbours(y, centres[t, 3], centres[t, 4], centres[t, 5])
    return second if first == YES or second == NO else UNKNOWN


@jit
def fill_centres(k: Context, points: FloatArray, triangles: IntArray, centres: FloatArray) -> None:
    """Write the circumcentres: coordinate, tail and error bound, twice."""
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        x = circumcentre_in_pairs(k, points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1])
        for i in range(6):
            centres[t, i] = x[i]


@jit
def match_vertices(centres: FloatArray, vertices: FloatArray, pairs: IndexArray, sure: IndexArray) -> None:
    """Tell for each pair whether the vertex is the circumcentre of the triangle."""
    for i in range(len(pairs)):
        v, t = pairs[i, 0], pairs[i, 1]
        sure[i] = is_centre(centres, t, vertices[v, 0], vertices[v, 1])


@jit
def distance_between(centres: FloatArray, t: int, x: float, y: float) -> float:
    """Return about how far a vertex is from the circumcentre of a triangle."""
    return float(abs(x - centres[t, 0]) + abs(y - centres[t, 3]))


@jit
def match_ends(centres: FloatArray, vertices: FloatArray, ends: IndexArray, rows: IndexArray, sure: IndexArray) -> None:
    """Tell for each ridge whether its ends, in either order, are the circumcentres of its triangles; without an answer
    they are put into the likelier order."""
    for r in range(len(ends)):
        s, t, px, py = rows[r, 0], rows[r, 1], vertices[ends[r, 0], 0], vertices[ends[r, 0], 1]
        qx, qy = vertices[ends[r, 1], 0], vertices[ends[r, 1], 1]
        straight = (is_centre(centres, s, px, py), is_centre(centres, t, qx, qy))
        turned = (is_centre(centres, t, px, py), is_centre(centres, s, qx, qy))
        sure[r] = NO if NO in straight and NO in turned else UNKNOWN
        if straight == (YES, YES) or turned == (YES, YES):
            sure[r] = YES
        first = distance_between(centres, s, px, py) + distance_between(centres, t, qx, qy)
        if distance_between(centres, t, px, py) + distance_between(centres, s, qx, qy) < first:
            ends[r, 0], ends[r, 1] = ends[r, 1], ends[r, 0]


@jit
def find_ridges(
    links: Links, rows: IntArray, pairs: IndexArray, times: IndexArray, slots: IndexArray, found: IndexArray
) -> None:
    """Write for each ridge the slot of its edge, -1 without one, and the triangles on both sides, -1 outside; count the
    ridges of each edge."""
    for r in range(len(pairs)):
        a, b = pairs[r, 0], pairs[r, 1]
        slots[r] = found[r, 0] = found[r, 1] = -1
        if a < 0 or b < 0 or a == b:
            continue
        left = slot_of(links.slots, links.first[a], links.last[a], b)
        right = slot_of(links.slots, links.first[b], links.last[b], a)
        if left < 0 and right < 0:
            continue
        slots[r] = left if right < 0 or (left >= 0 and a < b) else right
        times[slots[r]] += 1
        found[r, 0] = rows[left] if left >= 0 else rows[right]
        found[r, 1] = rows[right] if left >= 0 and right >= 0 else -1


@jit
def expect_ridges(
    k: Context, points: FloatArray, links: Links, expected: npt.NDArray[np.bool_], v_begin: int, v_end: int
) -> None:
    """Tell at which slots there should be a ridge: on the boundary, and between different circumcentres, v < b."""
    for v in range(v_begin, v_end):
        for i in range(links.first[v], links.last[v]):
            b, c = links.slots[i] >> 32, links.slots[i] & _LOW
            expected[i] = links.kinds[i] == BOUNDARY
            if expected[i] or v > b:
                continue
            d = links.slots[slot_of(links.slots, links.first[b], links.last[b], v)] & _LOW
            expected[i] = incircle_adaptive(
                k, points[v, 0], points[v, 1], points[b, 0], points[b, 1],
                points[c, 0], points[c, 1], points[d, 0], points[d, 1],
            ) != 0  # fmt: skip
