"""DELAUNAY: locally by the links, globally by the Delaunay lemma."""

import numpy as np

from exactmesh.verify.links import NOT_DELAUNAY, Links, ends_of, slots_of
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.properties import Kind, Property, Severity, Verdict
from exactmesh.verify.report import WITNESSES, Finding, Violation
from exactmesh.verify.triangles import Shapes
from exactmesh.verify.witness import (
    IndexArray,
    approximately,
    finding_of,
    incircle_determinant,
    point_name,
    rows_of_triangles,
    sign_of,
    triangle_name,
)

__all__ = ["check_delaunay", "enclosed_points"]


def enclosed_points(unused: IndexArray, used: IndexArray, first: IndexArray) -> IndexArray:
    """Return the unused points whose position no used point has; ``first`` is that of
    ``first_at_position``."""
    at_corner = np.zeros(len(first), dtype=np.bool_)
    at_corner[first[used]] = True
    return unused[~at_corner[first[unused]]]


def check_delaunay(
    mesh: Mesh, shapes: Shapes, links: Links, enclosed: IndexArray, missing: tuple[Property, ...]
) -> Finding:
    """DELAUNAY.

    A corner inside the circle of the triangle across an edge refutes it, whatever else is wrong. Without any,
    and with triangles that tile the hull, no corner is inside any circle (the Delaunay lemma, theorem D). An
    unused point of the hull then lies in some triangle; unless it is at a corner, it is inside that circle.

    Args:
        mesh: the input.
        shapes: of its triangles.
        links: those of the triangles with area, counterclockwise.
        enclosed: unused points that are at no corner, where the triangles tile the hull.
        missing: which of ADMISSIBLE and COVERS_HULL do not hold.
    """
    degenerate = np.flatnonzero(shapes.orientation == 0)
    parts = [
        finding_of(degenerate, lambda t: _without_circle(mesh, t)),
        _edges(mesh, links),
        finding_of(enclosed, lambda v: _enclosed(mesh, v)),
    ]
    count = sum(part.count for part in parts)
    if count:
        told = tuple(violation for part in parts for violation in part.violations)
        return Finding(Verdict.FAILS, count, told[:WITNESSES], lower_bound=bool(missing))
    if missing and len(mesh.triangles):
        return Finding(Verdict.UNDECIDED, because=missing)
    return Finding(Verdict.HOLDS)


def _without_circle(mesh: Mesh, t: int) -> Violation:
    corners = tuple(mesh.triangles[t].tolist())
    message = f"triangle {t} = {triangle_name(mesh.points, corners)} has no area, hence no circumcircle"
    return Violation(Property.DELAUNAY, Kind.ZERO_AREA, (t,), corners, message)


def _enclosed(mesh: Mesh, v: int) -> Violation:
    message = f"unused point {point_name(mesh.points, v)} lies inside the circumcircle of a triangle around it"
    return Violation(Property.DELAUNAY, Kind.POINT_IN_CIRCLE, (), (v,), message)


def _edges(mesh: Mesh, links: Links) -> Finding:
    slots = slots_of(links, NOT_DELAUNAY)
    if not slots.size:
        return Finding(Verdict.HOLDS)
    told = slots[:WITNESSES]
    v, b, c = ends_of(links, told)
    d = _far_corners(links, v, b)
    near = np.stack([v, b, c], axis=1)
    rows = rows_of_triangles(
        mesh.triangles,
        [*map(tuple, near.tolist()), *map(tuple, np.stack([b, v, d], axis=1).tolist())],
        len(mesh.points),
    )

    def describe(slot: int) -> Violation:
        i = int(np.searchsorted(told, slot))
        corners = near[i].tolist()
        magnitude, severity = incircle_determinant(mesh.points, corners, int(d[i]))
        triangles = rows[i][:1] + rows[i + len(told)][:1]
        near_name, far_name = triangle_name(mesh.points, corners), point_name(mesh.points, int(d[i]))
        message = (
            f"vertex {far_name} of triangle {triangles[1]} lies inside the circumcircle of triangle "
            f"{triangles[0]} = {near_name}: incircle {approximately(magnitude)}"
        )
        if severity is Severity.ROUNDING:
            message += ", rounding-sized"
        vertices = (*corners, int(d[i]))
        return Violation(
            Property.DELAUNAY,
            Kind.POINT_IN_CIRCLE,
            triangles,
            vertices,
            message,
            sign_of(magnitude),
            magnitude,
            severity,
        )

    return finding_of(slots, describe)


def _far_corners(links: Links, v: IndexArray, b: IndexArray) -> IndexArray:
    """Return the third corners of the triangles (v, d, b)."""
    far = np.empty_like(v)
    for i, (origin, target) in enumerate(zip(v.tolist(), b.tolist(), strict=True)):
        bucket = links.slots[links.first[origin] : links.first[origin + 1]]
        far[i] = bucket[np.flatnonzero((bucket & 0xFFFFFFFF) == target)[0]] >> 32
    return far
