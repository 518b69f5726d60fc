"""Severity and size of every violation, in compiled passes: double-doubles tell on which side of C P the value is.

A value in double-double errs by DD_BOUND P, 2^-100 P; P in doubles by less than 2^-48 of itself. So beyond 2^-40 of the
threshold on either side the answer is certain; what is nearer, or too small or too large for it, is left to rationals.
"""

import math

import numpy as np

from exactkernel.angle import AngleBound, corner_double_double
from exactkernel.constants import INCIRCLE_BOUND, LARGEST_WEIGHT, ORIENT2D_BOUND, SMALLEST_WEIGHT
from exactkernel.context import Context
from exactkernel.doubledouble import dd_add, dd_multiply
from exactkernel.expansions import two_diff, two_product
from exactkernel.incircle import determinant_and_permanent, incircle_double_double
from exactkernel.jit import jit
from exactkernel.types import FloatArray, IntArray
from exactmesh.verify.links import _LOW, Links, ends_of, slot_of
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.properties import Severity
from exactmesh.verify.severity import (
    MEASURE_BOUND,
    RESOLVED,
    ROUNDING_SIZED,
    UNKNOWN,
    Grades,
    angle_severity,
    area_terms,
    circle_terms,
    diametral_terms,
    length_severity,
    plain_angle,
    ranked,
    severity_of,
)
from exactmesh.verify.witness import IndexArray, Ranking

__all__ = ["rank_angles", "rank_areas", "rank_circles", "rank_diametral", "rank_lengths"]

_MARGIN = 2.0**-40


@jit
def grade(value: float, weight: float, bound: float) -> int:
    """Return on which side of bound * weight the magnitude of a value is, or UNKNOWN."""
    if not SMALLEST_WEIGHT <= weight <= LARGEST_WEIGHT:
        return UNKNOWN
    threshold = bound * weight
    if value > threshold * (1.0 + _MARGIN):
        return RESOLVED
    return ROUNDING_SIZED if value < threshold * (1.0 - _MARGIN) else UNKNOWN


@jit
def find_far_corners(links: Links, corners: IndexArray) -> None:
    """Write d for the triangle (b, v, d) beyond the edge of each row (v, b, c, d)."""
    for i in range(len(corners)):
        v, b = corners[i, 0], corners[i, 1]
        corners[i, 3] = links.slots[slot_of(links.slots, links.first[b], links.last[b], v)] & _LOW


@jit
def grade_circles(points: FloatArray, corners: IndexArray, grades: Grades, excess: FloatArray) -> None:
    """Grade incircle determinants of rows (a, b, c, d)."""
    for i in range(len(corners)):
        p, q, r, s = corners[i, 0], corners[i, 1], corners[i, 2], corners[i, 3]
        a, at = two_diff(points[p, 0], points[s, 0])
        A, At = two_diff(points[p, 1], points[s, 1])
        b, bt = two_diff(points[q, 0], points[s, 0])
        B, Bt = two_diff(points[q, 1], points[s, 1])
        c, ct = two_diff(points[r, 0], points[s, 0])
        C, Ct = two_diff(points[r, 1], points[s, 1])
        weight = determinant_and_permanent(a, A, b, B, c, C)[1]
        value = abs(incircle_double_double(a, at, A, At, b, bt, B, Bt, c, ct, C, Ct))
        grades[i], excess[i] = grade(value, weight, INCIRCLE_BOUND), value / weight if weight > 0.0 else 0.0


@jit
def grade_diametral(points: FloatArray, corners: IndexArray, grades: Grades, excess: FloatArray) -> None:
    """Grade scalar products at c of rows (a, b, c); the excess is minus the cosine of the angle there."""
    for i in range(len(corners)):
        a, b, c = corners[i, 0], corners[i, 1], corners[i, 2]
        p, pt = two_diff(points[c, 0], points[a, 0])
        q, qt = two_diff(points[b, 0], points[c, 0])
        r, rt = two_diff(points[c, 1], points[a, 1])
        s, st = two_diff(points[b, 1], points[c, 1])
        left, left_tail = dd_multiply(p, pt, q, qt)
        right, right_tail = dd_multiply(r, rt, s, st)
        value = abs(dd_add(left, left_tail, right, right_tail)[0])
        length = math.sqrt(p * p + r * r) * math.sqrt(q * q + s * s)
        grades[i], excess[i] = grade(value, abs(left) + abs(right), ORIENT2D_BOUND), value / length if length else 0.0


@jit
def grade_angles(
    angle: AngleBound, sign: int, points: FloatArray, triangles: IntArray, rows: IndexArray, grades: Grades,
    excess: FloatArray,
) -> None:  # fmt: skip
    """Grade triangles by their angles; the excess is the cosine of the smallest (sign 1), minus that of the largest."""
    for i in range(len(rows)):
        found, excess[i] = ROUNDING_SIZED, -1.0
        for j in range(3):
            a, b, c = triangles[rows[i], j], triangles[rows[i], (j + 1) % 3], triangles[rows[i], (j + 2) % 3]
            ux, uxt = two_diff(points[b, 0], points[a, 0])
            uy, uyt = two_diff(points[b, 1], points[a, 1])
            vx, vxt = two_diff(points[c, 0], points[a, 0])
            vy, vyt = two_diff(points[c, 1], points[a, 1])
            value = sign * corner_double_double(angle, ux, uxt, uy, uyt, vx, vxt, vy, vyt)
            crosses, dots = abs(ux * vy) + abs(uy * vx), abs(ux * vx) + abs(uy * vy)
            one = grade(value, angle.sine * dots + abs(angle.cosine) * crosses, MEASURE_BOUND)
            if one == RESOLVED or found == ROUNDING_SIZED:
                found = one
            length = math.sqrt(ux * ux + uy * uy) * math.sqrt(vx * vx + vy * vy)
            if length > 0.0:
                excess[i] = max(excess[i], sign * (ux * vx + uy * vy) / length)
        grades[i] = found


@jit
def grade_areas(
    limits: FloatArray, points: FloatArray, triangles: IntArray, rows: IndexArray, grades: Grades, excess: FloatArray
) -> None:
    """Grade areas; the excess is the ratio to the limit."""
    for i in range(len(rows)):
        a, b, c, twice = triangles[rows[i], 0], triangles[rows[i], 1], triangles[rows[i], 2], 2.0 * limits[rows[i]]
        ux, uxt = two_diff(points[b, 0], points[a, 0])
        uy, uyt = two_diff(points[b, 1], points[a, 1])
        vx, vxt = two_diff(points[c, 0], points[a, 0])
        vy, vyt = two_diff(points[c, 1], points[a, 1])
        left, left_tail = dd_multiply(ux, uxt, vy, vyt)
        right, right_tail = dd_multiply(uy, uyt, vx, vxt)
        cross, cross_tail = dd_add(left, left_tail, -right, -right_tail)
        value = dd_add(cross, cross_tail, -twice, 0.0)[0]
        grades[i] = grade(value, abs(left) + abs(right) + twice, MEASURE_BOUND)
        excess[i] = cross / twice if twice > 0.0 else math.inf


@jit
def grade_lengths(
    limits: FloatArray, points: FloatArray, triangles: IntArray, rows: IndexArray, grades: Grades, excess: FloatArray
) -> None:
    """Grade triangles by their edges; the excess is the squared ratio of the longest to the limit."""
    for i in range(len(rows)):
        found, excess[i] = ROUNDING_SIZED, 0.0
        limit, limit_tail = two_product(limits[rows[i]], limits[rows[i]])
        for j in range(3):
            a, b = triangles[rows[i], j], triangles[rows[i], (j + 1) % 3]
            ux, uxt = two_diff(points[b, 0], points[a, 0])
            uy, uyt = two_diff(points[b, 1], points[a, 1])
            left, left_tail = dd_multiply(ux, uxt, ux, uxt)
            right, right_tail = dd_multiply(uy, uyt, uy, uyt)
            squared, squared_tail = dd_add(left, left_tail, right, right_tail)
            one = grade(dd_add(squared, squared_tail, -limit, -limit_tail)[0], squared + limit, MEASURE_BOUND)
            if one == RESOLVED or found == ROUNDING_SIZED:
                found = one
            excess[i] = max(excess[i], squared / limit if limit > 0.0 else math.inf)
        grades[i] = found


def _unknown(n: int) -> tuple[Grades, FloatArray]:
    return np.full(n, UNKNOWN, dtype=np.int8), np.zeros(n)


def rank_circles(mesh: Mesh, links: Links, slots: IndexArray) -> tuple[IndexArray, Ranking]:
    """Return rows (v, b, c, d) of edges vb between triangles (v, b, c) and (b, v, d), and how incircle ranks them."""
    corners = np.empty((len(slots), 4), dtype=np.intp)
    corners[:, 0], corners[:, 1], corners[:, 2] = ends_of(links, slots)
    find_far_corners(links, corners)
    grades, excess = _unknown(len(slots))
    if mesh.context.incircle_bound < math.inf:
        grade_circles(mesh.coordinates, corners, grades, excess)

    def decide(i: int) -> Severity:
        *near, far = corners[i].tolist()
        return severity_of(circle_terms(mesh.points, near, far), INCIRCLE_BOUND)

    return corners, ranked(grades, excess, decide)


def rank_diametral(mesh: Mesh, corners: IndexArray) -> Ranking:
    """Return how the scalar product at c ranks rows (a, b, c), with c inside the circle on ab."""
    grades, excess = _unknown(len(corners))
    if mesh.context.orient2d_bound < math.inf:
        grade_diametral(mesh.coordinates, corners, grades, excess)

    def decide(i: int) -> Severity:
        a, b, c = corners[i].tolist()
        return severity_of(diametral_terms(mesh.points, a, b, c), ORIENT2D_BOUND)

    return ranked(grades, excess, decide)


def rank_angles(mesh: Mesh, triangles: IntArray, rows: IndexArray, bound: AngleBound, *, least: bool) -> Ranking:
    """Return how their smallest (or largest) angle ranks counterclockwise triangles that violate a bound."""
    grades, excess = _unknown(len(rows))
    if mesh.context.orient2d_bound < math.inf:
        angle = plain_angle(bound)
        grade_angles(angle, 1 if least else -1, mesh.coordinates, triangles, rows, grades, excess)

    def decide(i: int) -> Severity:
        return angle_severity(mesh.points, triangles[rows[i]].tolist(), bound, least=least)

    return ranked(grades, excess, decide)


def rank_areas(points: FloatArray, k: Context, triangles: IntArray, rows: IndexArray, limits: FloatArray) -> Ranking:
    """Return how their areas rank counterclockwise triangles that are too large; ``k`` is for the points as given."""
    grades, excess = _unknown(len(rows))
    if k.orient2d_bound < math.inf:
        grade_areas(limits, points, triangles, rows, grades, excess)

    def decide(i: int) -> Severity:
        return severity_of(area_terms(points, triangles[rows[i]].tolist(), float(limits[rows[i]])), MEASURE_BOUND)

    return ranked(grades, excess, decide)


def rank_lengths(points: FloatArray, k: Context, triangles: IntArray, rows: IndexArray, limits: FloatArray) -> Ranking:
    """Return how their edges rank triangles that have one that is too long; ``k`` is for the points as given."""
    grades, excess = _unknown(len(rows))
    if k.orient2d_bound < math.inf:
        grade_lengths(limits, points, triangles, rows, grades, excess)

    def decide(i: int) -> Severity:
        return length_severity(points, triangles[rows[i]].tolist(), float(limits[rows[i]]))

    return ranked(grades, excess, decide)
