"""What a run of refinement is asked to do, and how the compiled loop decides whether a triangle or a segment is good.

Whether a bound holds is decided exactly. Where a point is put, and which segment it is too close to, is a choice: plain
floating point will do, but for Gabriel edges, which are promised.
"""

from enum import IntEnum
from typing import NamedTuple

from exactkernel.angle import AngleBound, angle_below_adaptive
from exactkernel.diametral import diametral_adaptive
from exactkernel.jit import jit_inline
from exactkernel.measure import area_above_adaptive
from exactkernel.types import FloatArray, IntArray
from exactmesh.edgealgebra import dest, origin
from exactmesh.refinement.sheet import ANGLE, SIZE, Sheet, distance_squared

__all__ = ["Reason", "Rules", "SteinerKind", "faults_of", "is_encroached"]


class Reason(IntEnum):
    """Why a triangle was left unrefined."""

    SMALL_INPUT_ANGLE = 1
    """It lies across from a small angle between segments, where no mesh has large angles."""
    BUDGET = 2
    """``max_steiner`` points, or as many as fit into the memory, were inserted before its turn came."""
    MINIMUM_EDGE = 3
    """An edge shorter than ``min_edge`` would be needed."""
    PRECISION = 4
    """No double lies where a point would be needed."""
    FORBIDDEN = 5
    """A point would be needed on an edge where ``steiner`` forbids it."""
    TERMINATION = 6
    """Its shortest edge is far shorter than what caused it: for so large an angle, refinement would never end."""


class SteinerKind(IntEnum):
    """How a Steiner point came about."""

    ENCROACHED = 1
    """It divides a segment, on which its parent encroaches."""
    YIELDED = 2
    """It divides a segment that stood in the way of a point for a bad triangle; that triangle's parent is its own."""
    INTERIOR = 3
    """It was put inside the domain for a bad triangle; its parent is the younger end of that one's shortest edge."""


class Rules(NamedTuple):
    """What is asked for, in the coordinates of the sheet.

    Attributes:
        angle: the least angle.
        has_angle: whether there is one.
        offset: the distance of an off-centre from the shortest edge, in lengths of that; 0 without a least angle.
        lens: the squared cosine from which on a point encroaches.
        gabriel: whether segments must be Gabriel, that is, whether the whole diametral circle counts.
        areas: the largest area in each zone.
        has_area: whether there is any.
        lattice: the edges of the equilateral triangles to fill each zone with, infinite where there is no area bound.
        origin_x, origin_y: a point of the lattices.
        min_edge: the least edge.
        shrink: how much shorter, squared, an edge may be than its root where angles are concerned.
        unit: new coordinates are multiples of it.
        longest: a squared length that is about the largest.
        ends: int32 (s, 2), the ends of the constrained edges of the input.
        sharp: (s, 2), the angle to the nearest other line there, radians, 0 where it is not below 90 degrees.
        max_vertices: the budget.
    """

    angle: AngleBound
    has_angle: bool
    offset: float
    lens: float
    gabriel: bool
    areas: FloatArray
    has_area: bool
    lattice: FloatArray
    origin_x: float
    origin_y: float
    min_edge: float
    shrink: float
    unit: float
    longest: float
    ends: IntArray
    sharp: FloatArray
    max_vertices: int


@jit_inline
def faults_of(s: Sheet, rules: Rules, e: int, a: int, b: int, c: int) -> int:
    """Return what is wrong with the triangle a, b, c on the left of e, in bits."""
    xy = s.xy
    ax, ay, bx, by, cx, cy = xy[2 * a], xy[2 * a + 1], xy[2 * b], xy[2 * b + 1], xy[2 * c], xy[2 * c + 1]
    faults = 0
    if rules.has_angle and angle_below_adaptive(s.k, rules.angle, ax, ay, bx, by, cx, cy):
        faults |= ANGLE
    if rules.has_area and area_above_adaptive(s.k, rules.areas[s.zone[e >> 1]], ax, ay, bx, by, cx, cy):
        faults |= SIZE
    return faults


@jit_inline
def is_encroached(s: Sheet, rules: Rules, e: int, p: int) -> bool:
    """Tell whether p, on the left of the fixed edge e, is too close to it."""
    xy = s.xy
    a, b = origin(s.org, e), dest(s.org, e)
    ax, ay, bx, by, px, py = xy[2 * a], xy[2 * a + 1], xy[2 * b], xy[2 * b + 1], xy[2 * p], xy[2 * p + 1]
    if rules.gabriel:
        return diametral_adaptive(s.k, ax, ay, bx, by, px, py) > 0
    dot = (ax - px) * (bx - px) + (ay - py) * (by - py)
    if dot >= 0.0:
        return False
    return bool(dot * dot >= rules.lens * distance_squared(xy, a, p) * distance_squared(xy, b, p))


@jit_inline
def joins_sharp_segments(s: Sheet, rules: Rules, a: int, b: int) -> bool:
    """Tell whether ab joins two segments that meet below 60 degrees, at equal distances from there.

    Reference [Miller 2003].
    """
    m, n = s.line[a], s.line[b]
    if m < 0 or n < 0 or m == n:
        return False
    joint = -1
    for i in range(2):
        for j in range(2):
            if rules.ends[m, i] == rules.ends[n, j]:
                joint = rules.ends[m, i]
    if joint < 0:
        return False
    first, second = distance_squared(s.xy, a, joint), distance_squared(s.xy, b, joint)
    return bool(0.998 * second < first < 1.002 * second and distance_squared(s.xy, a, b) < first)
