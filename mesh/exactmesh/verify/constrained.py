"""What is decided with segments, a domain or labels at hand, in the order in which one thing rests on another."""

from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
from gmpy2 import mpq

from exactkernel.types import FloatArray
from exactmesh.verify.boundary import Boundary, is_one_loop
from exactmesh.verify.cells import upright_cells
from exactmesh.verify.chains import CONSTRAINED, IN_DOMAIN, ODD, Marks, chained
from exactmesh.verify.cover import Placed, Survey, check_cover, check_inner_parts, check_outer_parts, surveyed
from exactmesh.verify.delaunay import check_circles, check_constrained
from exactmesh.verify.domain import Constraints, Outline, require_even_ends
from exactmesh.verify.hull import first_at_position
from exactmesh.verify.links import Links
from exactmesh.verify.matching import corners_at
from exactmesh.verify.mesh import Integers, Mesh
from exactmesh.verify.nearest import nearest_corners, squared_distance
from exactmesh.verify.placement import displaced_placements, is_within, placed_exactly, used_points
from exactmesh.verify.properties import Kind, Property, Verdict
from exactmesh.verify.regions import check_labels, check_region_areas
from exactmesh.verify.report import Finding, Violation
from exactmesh.verify.triangles import Shapes, turned
from exactmesh.verify.witness import IndexArray, finding_of, joined, places_of, point_name

__all__ = ["check_constraints", "stacked"]


def stacked(outline: Outline | None) -> FloatArray:
    """Return every position that belongs to a domain: its points, its holes', its regions'."""
    if outline is None:
        return np.empty((0, 2))
    return np.concatenate([outline.points, outline.holes, outline.regions])


@dataclass(frozen=True, slots=True)
class Tiled:
    """Triangles, what is known about them, and what their edges are marked with.

    Attributes:
        mesh, shapes, links: as everywhere.
        boundary: where ADMISSIBLE holds; None otherwise.
        unused: points that are no corner.
        marks: (3m,).
    """

    mesh: Mesh
    shapes: Shapes
    links: Links
    boundary: Boundary | None
    unused: IndexArray
    marks: Marks


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
    absent = np.empty(0, dtype=np.intp) if own is None else _absent(tiled, own)
    segments = finding_of(absent, lambda i: _missing(mesh, own, i)) if own is not None else Finding(Verdict.HOLDS)
    if boundary is None and segments.verdict is Verdict.FAILS:
        segments = _without_admissible()
    free = _free(tiled)
    bits = IN_DOMAIN | ODD | (CONSTRAINED if own is None else 0)
    findings: dict[Property, Finding] = {}
    survey = None
    if outline is not None:
        trial = _tried(tiled, outline, positions, free, bits, constraints.within)
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
    r = 0 if outline is None else len(outline.regions)
    attributes = np.empty(0) if outline is None else outline.attributes
    seeds = positions[len(positions) - r :]
    cells = upright_cells(tiled.mesh, tiled.shapes)
    return check_labels(tiled.mesh, tiled.links, cells, tiled.marks, labels, seeds, attributes)


def _missing_properties(boundary: Boundary | None, segments: Finding) -> tuple[Property, ...]:
    missing = [Property.ADMISSIBLE] if boundary is None else []
    if segments.verdict is not Verdict.HOLDS:
        missing.append(Property.SEGMENTS_PRESENT)
    return tuple(missing)


def _without_admissible() -> Finding:
    return Finding(Verdict.UNDECIDED, because=(Property.ADMISSIBLE,))


def _absent(tiled: Tiled, segments: Integers) -> IndexArray:
    """Return the segments of the mesh that are no chain; the edges of the others are marked."""
    n = len(tiled.mesh.points)
    valid = ((segments >= 0) & (segments < n)).all(axis=1)
    ends = np.full(segments.shape, -1, dtype=np.intp)
    ends[valid] = segments[valid]
    return np.flatnonzero(~chained(tiled.mesh, tiled.links, ends, tiled.marks, CONSTRAINED))


def _missing(mesh: Mesh, segments: Integers | None, i: int) -> Violation:
    assert segments is not None
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


@dataclass(frozen=True, slots=True)
class Trial:
    """A domain where it may be in the mesh, and what follows.

    Attributes:
        tiled: with the marks that it makes.
        placed: the domain.
        survey: of the plane, or None where nothing depends on it.
        findings: about the domain.
        segments: SEGMENTS_PRESENT.
    """

    tiled: Tiled
    placed: Placed
    survey: Survey | None
    findings: dict[Property, Finding]
    segments: Finding

    @property
    def faults(self) -> tuple[int, int]:
        """How many properties do not hold, and how many violations there are."""
        found = (self.segments, self.findings[Property.COVERS_DOMAIN], self.findings[Property.DOMAIN_POINTS])
        return sum(finding.verdict is not Verdict.HOLDS for finding in found), sum(finding.count for finding in found)


def _tried(
    tiled: Tiled, outline: Outline, positions: FloatArray, free: IndexArray, bits: int, within: float | None
) -> Trial:
    """Return the first of the ways to place the domain that does not fail, or the one with the fewest faults."""
    if outline.even_odd:
        require_even_ends(outline, first_at_position(outline.points))
    mesh, links, marks = tiled.mesh, tiled.links, tiled.marks
    if within is None:
        return _trial(tiled, placed_exactly(mesh, links, outline, positions, marks, bits), free, bits)
    best = None
    for placed, written in displaced_placements(mesh, links, outline, positions, marks, bits, within):
        trial = _trial(replace(tiled, marks=written), placed, free, bits)
        if best is None or trial.faults < best.faults:
            best = trial
        if best.faults[0] == 0 or tiled.boundary is None:
            break
    assert best is not None  # there is always one
    marks[:] = best.tiled.marks
    return best


def _trial(tiled: Tiled, placed: Placed, free: IndexArray, bits: int) -> Trial:
    survey = _survey(tiled, placed, free, bits)
    findings, segments = _of_domain(tiled, placed, survey, bits)
    if placed.within is not None:
        apart = findings[Property.DOMAIN_POINTS].distance_squared
        distance = max(Fraction(int(placed.squared.numerator), int(placed.squared.denominator)), apart or Fraction(0))
        segments = replace(segments, distance_squared=distance)
        findings[Property.COVERS_DOMAIN] = replace(findings[Property.COVERS_DOMAIN], distance_squared=distance)
    return Trial(tiled, placed, survey, findings, segments)


def _survey(tiled: Tiled, placed: Placed, free: IndexArray, bits: int) -> Survey | None:
    """Sweep the plane where something depends on it."""
    if tiled.boundary is None:
        return None
    simple = placed.outline.even_odd or is_one_loop(tiled.boundary)
    if simple and not (len(placed.holes) or placed.absent.size or free.size or (placed.corner < 0).any()):
        return None
    return surveyed(tiled.mesh, tiled.links, tiled.marks, placed, free, bits)


def _of_domain(
    tiled: Tiled, placed: Placed, survey: Survey | None, bits: int
) -> tuple[dict[Property, Finding], Finding]:
    """Decide what is about the domain; return SEGMENTS_PRESENT of the domain's segments besides."""
    segments, cover = Finding(Verdict.HOLDS), _without_admissible()
    if tiled.boundary is None:
        segments = _without_admissible() if placed.absent.size else segments
    else:
        if survey is not None and placed.absent.size:
            segments = check_inner_parts(tiled.mesh, tiled.links, tiled.marks, placed, survey, bits)
        if segments.verdict is Verdict.HOLDS:
            cover = _cover(tiled, placed, survey, bits)
            if survey is not None and placed.absent.size and cover.verdict is Verdict.FAILS:
                inner = surveyed(tiled.mesh, tiled.links, tiled.marks, placed, tiled.unused[:0], bits, inner=True)
                segments = check_outer_parts(tiled.marks, placed, inner)
        else:
            cover = Finding(Verdict.UNDECIDED, because=(Property.SEGMENTS_PRESENT,))
    findings = {
        Property.COVERS_DOMAIN: cover,
        Property.DOMAIN_POINTS: _domain_points(tiled, placed, survey, cover),
        Property.NO_NEW_POINTS: _new_points(tiled, placed),
    }
    return findings, segments


def _cover(tiled: Tiled, placed: Placed, survey: Survey | None, bits: int) -> Finding:
    """COVERS_DOMAIN. A hole's point in the union may lie on a segment there, which only a sweep over those tells."""
    mesh, links, marks = tiled.mesh, tiled.links, tiled.marks
    if survey is not None and survey.faces.covered(survey.hole_sides[survey.hole_free]).any():
        inner = surveyed(mesh, links, marks, placed, tiled.unused[:0], bits, inner=True)
        survey = replace(survey, hole_free=survey.hole_free & inner.hole_free)
    return check_cover(mesh, links, marks, placed, survey)


def _domain_points(tiled: Tiled, placed: Placed, survey: Survey | None, cover: Finding) -> Finding:
    """DOMAIN_POINTS: given that the union is the domain, a point belongs to the one if it lies in the other.

    Within a distance, its nearest corner will do.
    """
    if not (placed.corner < 0).any():
        return Finding(Verdict.HOLDS)
    if survey is None or cover.verdict is not Verdict.HOLDS:
        return Finding(Verdict.UNDECIDED, because=(Property.COVERS_DOMAIN,))

    def describe(v: int) -> Violation:
        message = f"point {point_name(placed.outline.points, v)} of the domain is no corner of any triangle"
        places = places_of(placed.outline.points, [v])
        return Violation(Property.DOMAIN_POINTS, Kind.MISSING_POINT, (), (), message, places=places)

    culprits, mesh = survey.stray[survey.stray_covered], tiled.mesh
    if placed.within is None or not culprits.size:
        return finding_of(culprits, describe)
    wanted = placed.outline.points[culprits]
    corners = mesh.points[nearest_corners(mesh.points, np.flatnonzero(used_points(tiled.links)), wanted)]
    pairs = [*zip(corners, wanted, strict=True)]
    near = np.array([is_within(p, q, placed.within) for p, q in pairs])
    squared = max((squared_distance(*pairs[i]) for i in np.flatnonzero(near).tolist()), default=mpq(0))
    distance = Fraction(int(squared.numerator), int(squared.denominator))
    return replace(finding_of(culprits[~near], describe), distance_squared=distance)


def _new_points(tiled: Tiled, placed: Placed) -> Finding:
    """NO_NEW_POINTS: of two corners at one position only one is matched, which more than one point would not help."""
    mesh, used = tiled.mesh, used_points(tiled.links)
    new = used.copy()
    new[placed.corner[placed.corner >= 0]] = False
    if new.any():
        rest = np.flatnonzero(new)
        every = np.ones(len(placed.coordinates), dtype=np.bool_)
        new[rest] = corners_at(placed.coordinates, every, mesh.coordinates[rest]) < 0

    def describe(v: int) -> Violation:
        message = f"corner {point_name(mesh.points, v)} is no point of the domain"
        return Violation(Property.NO_NEW_POINTS, Kind.NEW_POINT, (), (v,), message)

    return finding_of(np.flatnonzero(new), describe)


def _both(one: Finding, other: Finding) -> Finding:
    """Join two findings about one property: of the mesh's segments and of the domain's."""
    findings = [one, other]
    failing = [finding for finding in findings if finding.verdict is Verdict.FAILS]
    if failing:
        return replace(joined(failing), distance_squared=other.distance_squared)
    because = dict.fromkeys(property_ for finding in findings for property_ in finding.because)
    if because:
        return Finding(Verdict.UNDECIDED, because=tuple(because), distance_squared=other.distance_squared)
    return other
