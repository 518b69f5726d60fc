"""What is decided first of finite points and valid cells, and what rests on it."""

from __future__ import annotations  # Dual is a union of names

from dataclasses import dataclass, replace

import numpy as np

from exactkernel.types import FloatArray, IntArray
from exactmesh.verify.admissible import check_overlap, check_sweep, check_zero_area
from exactmesh.verify.boundary import Boundary, boundary_of, convex_cycle
from exactmesh.verify.bounds import Bounds, check_angle_bound, check_areas
from exactmesh.verify.cells import (
    Cells,
    check_convex,
    check_quad_orientation,
    proper_cells,
    turns_of,
    upright_cells,
)
from exactmesh.verify.centres import check_centres
from exactmesh.verify.chains import Marks
from exactmesh.verify.constrained import check_constraints
from exactmesh.verify.delaunay import check_delaunay, enclosed_points
from exactmesh.verify.domain import Constraints
from exactmesh.verify.dual import Dual
from exactmesh.verify.duality import check_dual
from exactmesh.verify.gabriel import check_gabriel, is_locally_delaunay
from exactmesh.verify.hull import check_distinct, check_hull, check_used, first_at_position, unused_points
from exactmesh.verify.links import Links, linked
from exactmesh.verify.listing import with_listing
from exactmesh.verify.local import Local, localized
from exactmesh.verify.manifold import check_edges, check_fans, fans_finding
from exactmesh.verify.mesh import (
    Mesh,
)
from exactmesh.verify.properties import (
    Orientation,
    Property,
    Verdict,
)
from exactmesh.verify.report import Finding
from exactmesh.verify.sizes import check_lengths
from exactmesh.verify.triangles import Shapes, check_angles, check_orientation, classified
from exactmesh.verify.witness import IndexArray, joined

__all__ = ["check_mesh"]


@dataclass(frozen=True, slots=True)
class Tiling:
    """What is known about the triangles with area and the convex quadrilaterals, counterclockwise, when their
    admissibility is decided."""

    links: Links
    admissible: Finding
    boundary: Boundary | None
    cycle: IndexArray | None


def check_mesh(
    mesh: Mesh,
    orientation: Orientation,
    constraints: Constraints,
    positions: FloatArray,
    bounds: Bounds,
    dual: Dual | None,
    decided: tuple[Property, ...],
) -> dict[Property, Finding]:
    """Decide everything about finite points and valid cells; ``positions`` are those of the domain."""
    local = localized(mesh.coordinates, mesh.triangles, mesh.quads)
    shapes = classified(mesh.context, local, turns_of(mesh.context, local))
    cells = upright_cells(mesh, shapes)
    listed = cells if orientation is Orientation.ANY else Cells(mesh.triangles, mesh.quads)
    proper = proper_cells(cells, shapes)
    tiling = tiled(mesh, shapes, cells, _links(mesh, proper, local))
    links = tiling.links if listed.are(proper) else _links(mesh, listed, local)
    upright, unused = cells.triangles, unused_points(links)
    findings = {
        Property.ORIENTATION: joined(
            (check_orientation(mesh, shapes, orientation), check_quad_orientation(mesh, shapes, orientation))
        ),
        Property.CONVEX: check_convex(mesh, shapes),
        Property.ALL_POINTS_USED: check_used(mesh, unused),
        Property.EDGE_MANIFOLD: check_edges(mesh, listed, links),
        Property.VERTEX_MANIFOLD: _fans(mesh, listed, links, tiling),
        Property.ADMISSIBLE: tiling.admissible,
        Property.WEAKLY_ACUTE: check_angles(mesh, shapes, Property.WEAKLY_ACUTE),
        Property.ACUTE: check_angles(mesh, shapes, Property.ACUTE),
    }
    findings = with_listing(mesh, shapes, orientation, findings)
    findings.update(_against_points(mesh, shapes, tiling, unused))
    findings.update(_against_bounds(mesh, shapes, upright, bounds))
    if dual is not None:
        findings[Property.VORONOI_DUAL] = check_dual(mesh, tiling.links, upright, dual, findings[Property.DELAUNAY])
    boundary = tiling.boundary if tiling.admissible.verdict is Verdict.HOLDS else None
    marks = np.zeros(len(tiling.links.slots), dtype=np.uint8)
    if constraints.any:
        findings.update(
            check_constraints(mesh, shapes, tiling.links, boundary, unused, constraints, positions, marks, decided)
        )
    if Property.GABRIEL in decided or Property.CIRCUMCENTRES_INSIDE in decided:
        missing = _missing_for_circles(tiling.links, marks, findings)
        findings[Property.GABRIEL] = check_gabriel(mesh, tiling.links, marks, missing)
    if Property.CIRCUMCENTRES_INSIDE in decided:
        findings[Property.CIRCUMCENTRES_INSIDE] = check_centres(
            mesh, shapes, tiling.links, upright, boundary, marks, findings[Property.GABRIEL]
        )
    return findings


def _against_bounds(mesh: Mesh, shapes: Shapes, upright: IntArray, bounds: Bounds) -> dict[Property, Finding]:
    """MIN_ANGLE, MAX_ANGLE, MAX_AREA, MAX_LENGTH, as far as they were given."""
    findings = {}
    for property_, angle in ((Property.MIN_ANGLE, bounds.min_angle), (Property.MAX_ANGLE, bounds.max_angle)):
        if angle is not None:
            findings[property_] = check_angle_bound(mesh, shapes, upright, angle, property_)
    if bounds.max_area is not None:
        findings[Property.MAX_AREA] = check_areas(mesh, upright, bounds.max_area, Property.MAX_AREA)
    if bounds.size is not None and not callable(bounds.size):
        findings[Property.MAX_LENGTH] = check_lengths(mesh, bounds.size)
    return findings


def _missing_for_circles(links: Links, marks: Marks, findings: dict[Property, Finding]) -> tuple[Property, ...]:
    """Return what does not hold of that on which theorem H rests. It asks less than (constrained) Delaunay: unused
    points do no harm."""
    missing: list[Property] = [
        property_
        for property_ in (Property.ADMISSIBLE, Property.SEGMENTS_PRESENT)
        if property_ in findings and findings[property_].verdict is not Verdict.HOLDS
    ]
    if not is_locally_delaunay(links, marks):
        with_segments = Property.CONSTRAINED_DELAUNAY in findings
        missing.append(Property.CONSTRAINED_DELAUNAY if with_segments else Property.DELAUNAY)
    return tuple(missing)


def _links(mesh: Mesh, cells: Cells, local: Local) -> Links:
    """Return the links of cells; ``local`` is the copy of those that were listed."""
    if not cells.are(Cells(mesh.triangles, mesh.quads)):
        local = localized(mesh.coordinates, *cells)
    return linked(len(mesh.points), mesh.context, local)


def tiled(mesh: Mesh, shapes: Shapes, cells: Cells, links: Links) -> Tiling:
    """Decide ADMISSIBLE: triangles without area and quadrilaterals that are not convex, then edges with two cells on a
    side, then the boundary."""
    improper = joined((check_zero_area(mesh, shapes), check_convex(mesh, shapes, Property.ADMISSIBLE)))
    for finding in (improper, check_overlap(mesh, cells, links)):
        if finding.verdict is Verdict.FAILS:
            return Tiling(links, replace(finding, lower_bound=True), None, None)
    boundary = boundary_of(links)
    cycle = convex_cycle(mesh, boundary)
    admissible = Finding(Verdict.HOLDS) if cycle is not None else check_sweep(mesh, cells, boundary)
    return Tiling(links, admissible, boundary, cycle)


def _fans(mesh: Mesh, cells: Cells, links: Links, tiling: Tiling) -> Finding:
    """VERTEX_MANIFOLD: admissible triangles that close round a vertex leave no room for more, so two fans are
    open ones, and each begins with an edge of the boundary. Otherwise every vertex is walked round."""
    boundary = tiling.boundary
    if links is not tiling.links or boundary is None or tiling.admissible.verdict is not Verdict.HOLDS:
        return check_fans(mesh, cells, links)
    return fans_finding(mesh, cells, np.unique(boundary.origin[1:][boundary.origin[1:] == boundary.origin[:-1]]))


def _against_points(mesh: Mesh, shapes: Shapes, tiling: Tiling, unused: IndexArray) -> dict[Property, Finding]:
    """DISTINCT_POINTS, COVERS_HULL, DELAUNAY: what depends on points that no triangle uses.

    Admissible triangles have their corners at distinct positions (theorem B): without unused points nothing
    is sorted.
    """
    admissible = tiling.admissible.verdict is Verdict.HOLDS
    hull, missing = Finding(Verdict.UNDECIDED, because=(Property.ADMISSIBLE,)), [Property.ADMISSIBLE]
    if admissible and tiling.boundary is not None:
        hull = check_hull(mesh, tiling.boundary, tiling.cycle, unused)
        missing = [] if hull.verdict is Verdict.HOLDS else [Property.COVERS_HULL]
    distinct, enclosed = Finding(Verdict.HOLDS), np.empty(0, dtype=np.intp)
    if not admissible or unused.size:
        first = first_at_position(mesh.points)
        distinct = check_distinct(mesh.points, first)
        if not missing and len(mesh.triangles) and not len(mesh.quads):
            used = np.flatnonzero(tiling.links.last > tiling.links.first)
            enclosed = enclosed_points(unused, used, first)
    findings = {Property.DISTINCT_POINTS: distinct, Property.COVERS_HULL: hull}
    if not len(mesh.quads):
        findings[Property.DELAUNAY] = check_delaunay(mesh, shapes, tiling.links, enclosed, tuple(missing))
    return findings
