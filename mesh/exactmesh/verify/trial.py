"""A domain where it may be in a mesh: strictly, or displaced; and what follows about it."""

from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
from gmpy2 import mpq

from exactkernel.types import FloatArray
from exactmesh.verify.boundary import Boundary, is_one_loop
from exactmesh.verify.chains import Marks
from exactmesh.verify.cover import Placed, Survey, check_cover, check_inner_parts, check_outer_parts, surveyed
from exactmesh.verify.domain import Outline, require_even_ends
from exactmesh.verify.hull import first_at_position
from exactmesh.verify.links import Links
from exactmesh.verify.matching import corners_at
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.nearest import nearest_corners, squared_distance
from exactmesh.verify.placement import displaced_placements, is_within, placed_exactly, used_points
from exactmesh.verify.properties import Kind, Property, Verdict
from exactmesh.verify.report import Finding, Violation
from exactmesh.verify.text import digits_above
from exactmesh.verify.triangles import Shapes
from exactmesh.verify.witness import IndexArray, finding_of, places_of, point_name

__all__ = ["Tiled", "tried", "without_admissible"]

_ROUNDING = 2.0**-20  # of the coordinates: more than singles lose, or seven decimals; for advice, not for a verdict
_FARTHER = 16.0


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


def without_admissible() -> Finding:
    """Return what is said of what rests on ADMISSIBLE where that does not hold."""
    return Finding(Verdict.UNDECIDED, because=(Property.ADMISSIBLE,))


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

    @property
    def holds(self) -> bool:
        """Whether there is nothing to find fault with."""
        return self.faults == (0, 0)

    def noted(self, note: str) -> "Trial":
        """Return it with a note to what fails."""

        def with_note(finding: Finding) -> Finding:
            return replace(finding, note=note) if finding.verdict is Verdict.FAILS else finding

        findings = dict(self.findings)
        for property_ in (Property.COVERS_DOMAIN, Property.DOMAIN_POINTS):
            findings[property_] = with_note(findings[property_])
        return replace(self, findings=findings, segments=with_note(self.segments))


def tried(
    tiled: Tiled, outline: Outline, positions: FloatArray, free: IndexArray, bits: int, within: float | None
) -> Trial:
    """Return the domain where it is, and write its marks; where it is a little displaced instead, say how far."""
    if outline.even_odd:
        require_even_ends(outline, first_at_position(outline.points))
    if within is None:
        placed = placed_exactly(tiled.mesh, tiled.links, outline, positions, tiled.marks, bits)
        trial = _trial(tiled, placed, free, bits)
    else:
        trial = _displaced(tiled, outline, positions, free, bits, within)
    if trial.holds or tiled.boundary is None:
        return trial
    farther = max(float(np.abs(tiled.mesh.points).max(initial=0.0)) * _ROUNDING, _FARTHER * (within or 0.0))
    other = _displaced(replace(tiled, marks=np.zeros_like(tiled.marks)), outline, positions, free, bits, farther)
    distance = other.segments.distance
    return (
        trial.noted(f"within={digits_above(distance)} it would hold") if other.holds and distance is not None else trial
    )


def _displaced(
    tiled: Tiled, outline: Outline, positions: FloatArray, free: IndexArray, bits: int, within: float
) -> Trial:
    """Return the first of the ways to place the domain that does not fail, or the one with the fewest faults."""
    best = None
    for placed, written in displaced_placements(tiled.mesh, tiled.links, outline, positions, tiled.marks, bits, within):
        trial = _trial(replace(tiled, marks=written), placed, free, bits)
        if best is None or trial.faults < best.faults:
            best = trial
        if best.holds:
            break
    assert best is not None  # there is always one
    tiled.marks[:] = best.tiled.marks
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


def _inner_survey(tiled: Tiled, placed: Placed, bits: int) -> Survey:
    """Sweep over the segments within the triangles as well."""
    return surveyed(tiled.mesh, tiled.links, tiled.marks, placed, tiled.unused[:0], bits, inner=True)


def _of_domain(
    tiled: Tiled, placed: Placed, survey: Survey | None, bits: int
) -> tuple[dict[Property, Finding], Finding]:
    """Decide what is about the domain; return SEGMENTS_PRESENT of the domain's segments besides."""
    segments, cover = Finding(Verdict.HOLDS), without_admissible()
    if tiled.boundary is None:
        segments = without_admissible() if placed.absent.size else segments
    else:
        if survey is not None:
            segments = check_inner_parts(tiled.mesh, tiled.links, tiled.marks, placed, survey, bits)
        if segments.verdict is Verdict.HOLDS:
            cover = _cover(tiled, placed, survey, bits)
            if placed.absent.size and cover.verdict is Verdict.FAILS:
                segments = check_outer_parts(tiled.marks, placed, _inner_survey(tiled, placed, bits))
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
    if survey is not None and survey.faces.covered(survey.hole_sides[survey.hole_free]).any():
        survey = replace(survey, hole_free=survey.hole_free & _inner_survey(tiled, placed, bits).hole_free)
    return check_cover(tiled.mesh, tiled.links, tiled.marks, placed, survey)


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
