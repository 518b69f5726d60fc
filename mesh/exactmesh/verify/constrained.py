"""What is decided with segments, a domain or labels at hand, in the order in which one thing rests on another."""

from dataclasses import replace

import numpy as np

from exactkernel.types import FloatArray
from exactmesh.verify.boundary import Boundary
from exactmesh.verify.cells import upright_cells
from exactmesh.verify.chains import CONSTRAINED, IN_DOMAIN, ODD, Marks, chained
from exactmesh.verify.cover import surveyed
from exactmesh.verify.delaunay import check_circles, check_constrained
from exactmesh.verify.domain import Constraints, Outline
from exactmesh.verify.links import Links
from exactmesh.verify.matching import corners_at
from exactmesh.verify.mesh import Integers, Mesh
from exactmesh.verify.placement import used_points
from exactmesh.verify.properties import Kind, Property, Verdict
from exactmesh.verify.regions import check_labels, check_region_areas
from exactmesh.verify.report import Finding, Violation
from exactmesh.verify.trial import Tiled, tried, without_admissible
from exactmesh.verify.triangles import Shapes, turned
from exactmesh.verify.witness import IndexArray, finding_of, joined, point_name

__all__ = ["check_constraints", "stacked"]


def stacked(outline: Outline | None) -> FloatArray:
    """Return every position that belongs to a domain: its points, its holes', its regions'."""
    if outline is None:
        return np.empty((0, 2))
    return np.concatenate([outline.points, outline.holes, outline.regions])


def check_constraints(
    mesh: Mesh,
    shapes: Shapes,
    links: Links,
    boundary: Boundary | None,
    unused: IndexArray,
    constraints: Constraints,
    positions: FloatArray,
    marks: Marks,
    decided: tuple[Property, ...],
) -> dict[Property, Finding]:
    """Decide what rests on segments, the domain and labels.

    Args:
        mesh, shapes, links: the triangles with area, counterclockwise.
        boundary: theirs, None unless they are admissible.
        unused: points that are no corner.
        constraints: what was given.
        positions: that of ``stacked`` in the coordinates of the mesh.
        marks: (3m,) zeros, to be written: what is known about the edges.
        decided: what is asked for.
    """
    tiled = Tiled(mesh, shapes, links, boundary, unused, marks)
    own, outline = constraints.segments, constraints.outline
    segments = Finding(Verdict.HOLDS) if own is None else _present(tiled, own)
    if boundary is None and segments.verdict is Verdict.FAILS:
        segments = without_admissible()
    free = _free(tiled)
    bits = IN_DOMAIN | ODD | (CONSTRAINED if own is None else 0)
    findings: dict[Property, Finding] = {}
    survey = None
    if outline is not None:
        trial = tried(tiled, outline, positions, free, bits, constraints.within)
        findings, survey, segments = trial.findings, trial.survey, _both(segments, trial.segments)
    elif boundary is not None and free.size:
        survey = surveyed(mesh, links, tiled.marks, None, free, bits)
    findings[Property.SEGMENTS_PRESENT] = segments
    enclosed = free[survey.unused_covered] if survey is not None else free[:0]
    missing = _missing_properties(boundary, segments)
    if Property.CONSTRAINED_DELAUNAY in decided:
        constrained = tiled.marks & CONSTRAINED > 0
        findings[Property.CONSTRAINED_DELAUNAY] = (
            check_circles(mesh, shapes, missing)
            if missing
            else check_constrained(mesh, shapes, links, constrained, enclosed)
        )
    if constraints.labels is not None:
        findings[Property.REGIONS] = (
            Finding(Verdict.UNDECIDED, because=missing)
            if missing
            else _regions(tiled, constraints.labels, outline, positions)
        )
    if Property.REGION_AREAS in decided and outline is not None:
        findings[Property.REGION_AREAS] = (
            Finding(Verdict.UNDECIDED, because=missing) if missing else _region_areas(tiled, outline, positions)
        )
    return findings


def _region_areas(tiled: Tiled, outline: Outline, positions: FloatArray) -> Finding:
    triangles = turned(tiled.mesh.triangles, tiled.shapes)
    seeds = positions[len(positions) - len(outline.regions) :]
    return check_region_areas(tiled.mesh, tiled.links, triangles, tiled.marks, seeds, outline.areas)


def _regions(tiled: Tiled, labels: FloatArray, outline: Outline | None, positions: FloatArray) -> Finding:
    attributes = np.empty(0) if outline is None else outline.attributes
    seeds = positions[len(positions) - len(attributes) :]
    cells = upright_cells(tiled.mesh, tiled.shapes)
    return check_labels(tiled.mesh, tiled.links, cells, tiled.marks, labels, seeds, attributes)


def _missing_properties(boundary: Boundary | None, segments: Finding) -> tuple[Property, ...]:
    missing = [Property.ADMISSIBLE] if boundary is None else []
    if segments.verdict is not Verdict.HOLDS:
        missing.append(Property.SEGMENTS_PRESENT)
    return tuple(missing)


def _present(tiled: Tiled, segments: Integers) -> Finding:
    """Find the segments of the mesh that are no chain; mark the edges of the others."""
    n = len(tiled.mesh.points)
    valid = ((segments >= 0) & (segments < n)).all(axis=1)
    ends = np.full(segments.shape, -1, dtype=np.intp)
    ends[valid] = segments[valid]
    absent = np.flatnonzero(~chained(tiled.mesh, tiled.links, ends, tiled.marks, CONSTRAINED))
    return finding_of(absent, lambda i: _missing(tiled.mesh, segments, i))


def _missing(mesh: Mesh, segments: Integers, i: int) -> Violation:
    a, b = (int(v) for v in segments[i])
    if not (0 <= a < len(mesh.points) and 0 <= b < len(mesh.points)):
        message = f"segment {i} ({a}, {b}) has an index outside 0 .. {len(mesh.points) - 1}"
        return Violation(Property.SEGMENTS_PRESENT, Kind.OUT_OF_RANGE, (), (a, b), message)
    name = f"segment {i} from {point_name(mesh.points, a)} to {point_name(mesh.points, b)}"
    if (mesh.points[a] == mesh.points[b]).all():
        return Violation(Property.SEGMENTS_PRESENT, Kind.NO_SEGMENT, (), (a, b), f"{name} has no length")
    message = f"{name} is no chain of edges"
    return Violation(Property.SEGMENTS_PRESENT, Kind.MISSING_SEGMENT, (), (a, b), message)


def _free(tiled: Tiled) -> IndexArray:
    """Return the unused points that are at no corner's position."""
    if not tiled.unused.size:
        return tiled.unused
    points = tiled.mesh.coordinates
    return tiled.unused[corners_at(points, used_points(tiled.links), points[tiled.unused]) < 0]


def _both(one: Finding, other: Finding) -> Finding:
    """Join two findings about one property: of the mesh's segments and of the domain's."""
    findings = [one, other]
    failing = [finding for finding in findings if finding.verdict is Verdict.FAILS]
    if failing:
        return replace(joined(failing), distance_squared=other.distance_squared, note=other.note)
    because = dict.fromkeys(property_ for finding in findings for property_ in finding.because)
    if because:
        return Finding(Verdict.UNDECIDED, because=tuple(because), distance_squared=other.distance_squared)
    return other
