"""DELAUNAY: locally by the links, globally by the Delaunay lemma."""

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from exactkernel.constants import INCIRCLE_BOUND
from exactmesh.verify.grading import rank_circles
from exactmesh.verify.links import NOT_DELAUNAY, Links, slots_of
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.pairs import rows_round
from exactmesh.verify.properties import Kind, Property, Severity, Verdict
from exactmesh.verify.report import WITNESSES, Finding, Violation
from exactmesh.verify.severity import circle_terms, severity_of
from exactmesh.verify.triangles import Shapes
from exactmesh.verify.witness import (
    IndexArray,
    approximately,
    finding_of,
    joined,
    point_name,
    rows_of_triangles,
    sign_of,
    triangle_name,
    twice_area,
)

__all__ = ["check_circles", "check_constrained", "check_delaunay", "enclosed_points"]


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
    slots = slots_of(links, NOT_DELAUNAY)
    return _finding(mesh, shapes, links, slots, enclosed, Property.DELAUNAY, missing)


def check_constrained(
    mesh: Mesh, shapes: Shapes, links: Links, constrained: npt.NDArray[np.bool_], enclosed: IndexArray
) -> Finding:
    """CONSTRAINED_DELAUNAY, for admissible triangles whose edges contain what of the segments lies in their union.

    Theorem E. If the far corner d of an edge ab that no segment contains lies inside the circle of abc, it is visible
    from points of abc near ab. Conversely, let p be inside the circle of t and visible from x in t. Visibility is
    blocked by closed sets, so x may be moved until the way from x to p meets no vertex: it crosses edges without
    segments between triangles t, t', ..., the last with p as a corner or in its closure. Across each of them incircle
    <= 0, so the power of p with respect to their circles does not grow on the way: p is inside the last circle. So p is
    no corner, but an unused point; one in the union is inside the circle of a triangle around it, and visible.

    Args:
        mesh: the input.
        shapes: of its triangles.
        links: theirs.
        constrained: (3m,) True at the slots that stand for edges on segments.
        enclosed: unused points within the closed union that are at no corner.
    """
    slots = np.flatnonzero((links.kinds == NOT_DELAUNAY) & ~constrained)
    return _finding(mesh, shapes, links, slots, enclosed, Property.CONSTRAINED_DELAUNAY, ())


def check_circles(mesh: Mesh, shapes: Shapes, missing: tuple[Property, ...]) -> Finding:
    """CONSTRAINED_DELAUNAY where something is missing: all that can be said is whether there are circles."""
    finding = finding_of(
        np.flatnonzero(shapes.orientation == 0), lambda t: _without_circle(mesh, t, Property.CONSTRAINED_DELAUNAY)
    )
    if finding.verdict is Verdict.FAILS:
        return replace(finding, lower_bound=True)
    return Finding(Verdict.UNDECIDED, because=missing) if len(mesh.triangles) else finding


def _finding(
    mesh: Mesh,
    shapes: Shapes,
    links: Links,
    slots: IndexArray,
    enclosed: IndexArray,
    property_: Property,
    missing: tuple[Property, ...],
) -> Finding:
    degenerate = np.flatnonzero(shapes.orientation == 0)
    parts = [
        finding_of(degenerate, lambda t: _without_circle(mesh, t, property_)),
        _edges(mesh, links, slots, property_),
        _enclosed(mesh, enclosed, property_),
    ]
    finding = joined(parts, lower_bound=bool(missing))
    if finding.count:
        return finding
    if missing and len(mesh.triangles):
        return Finding(Verdict.UNDECIDED, because=missing)
    return Finding(Verdict.HOLDS)


def _without_circle(mesh: Mesh, t: int, property_: Property) -> Violation:
    corners = tuple(mesh.triangles[t].tolist())
    message = f"triangle {t} = {triangle_name(mesh.points, corners)} has no area, hence no circumcircle"
    return Violation(property_, Kind.ZERO_AREA, (t,), corners, message)


def _enclosed(mesh: Mesh, vertices: IndexArray, property_: Property) -> Finding:
    """Name a triangle round each unused point that lies in the union of the triangles."""
    if not vertices.size:
        return Finding(Verdict.HOLDS)
    rows = dict(zip(vertices.tolist(), rows_round(mesh, vertices[:WITNESSES]).tolist(), strict=False))

    def describe(v: int) -> Violation:
        t = rows[v]
        corners = mesh.triangles[t].tolist()
        magnitude, _ = circle_terms(mesh.points, corners, v)
        magnitude *= sign_of(twice_area(mesh.points, *corners))
        message = (
            f"unused point {point_name(mesh.points, v)} lies in triangle {t} = {triangle_name(mesh.points, corners)}, "
            f"inside its circumcircle: incircle {approximately(magnitude)}"
        )
        vertices, sign = (*corners, v), sign_of(magnitude)
        return Violation(property_, Kind.POINT_IN_CIRCLE, (t,), vertices, message, sign, magnitude)

    return finding_of(vertices, describe)


def _edges(mesh: Mesh, links: Links, slots: IndexArray, property_: Property) -> Finding:
    if not slots.size:
        return Finding(Verdict.HOLDS)
    corners, ranking = rank_circles(mesh, links, slots)
    told = corners[ranking.order]
    near, far = told[:, :3].tolist(), told[:, [1, 0, 3]].tolist()
    rows = rows_of_triangles(mesh.triangles, [*map(tuple, near), *map(tuple, far)], len(mesh.points))
    rows_of = {i: rows[j][:1] + rows[j + len(told)][:1] for j, i in enumerate(ranking.order.tolist())}

    def describe(i: int) -> Violation:
        *near, far = corners[i].tolist()
        terms = circle_terms(mesh.points, near, far)
        magnitude, severity = terms[0], severity_of(terms, INCIRCLE_BOUND)
        triangles = rows_of[i]
        near_name, far_name = triangle_name(mesh.points, near), point_name(mesh.points, far)
        message = (
            f"vertex {far_name} of triangle {triangles[1]} lies inside the circumcircle of triangle "
            f"{triangles[0]} = {near_name}: incircle {approximately(magnitude)}"
        )
        if severity is Severity.ROUNDING:
            message += ", rounding-sized"
        vertices, sign = (*near, far), sign_of(magnitude)
        return Violation(property_, Kind.POINT_IN_CIRCLE, triangles, vertices, message, sign, magnitude, severity)

    return finding_of(np.arange(len(corners)), describe, ranking)
