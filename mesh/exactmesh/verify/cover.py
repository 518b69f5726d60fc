"""COVERS_DOMAIN, SEGMENTS_PRESENT and DOMAIN_POINTS for a domain: which faces of its segments the triangles cover.

Let the triangles be admissible, U their union, and let every segment run through U along edges only. Then

1. every component of U minus the segments is covered wholly, and so is every face of the segments, or not at all, if
   the edges that bound U lie on segments. If U is the closed domain they do: its boundary consists of segments.
2. The faces that U does not cover are those into which the parts of segments outside of U cut the complement of U. The
   domain is U iff none of these belongs to the domain, and no face within U is outside of it.
3. By seeds, that is: each uncovered face is the unbounded one or has a hole's point, and no hole's point lies in U. By
   the even-odd rule: besides hole's points, each uncovered face is even and each covered one odd; a face's parity
   is that of the number of segments below it, and both sides of an edge within U agree iff its segments are even.
"""

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from gmpy2 import mpq

from exactkernel.types import FloatArray
from exactmesh.verify.chains import IN_DOMAIN, ODD, Marks, chained
from exactmesh.verify.domain import Outline
from exactmesh.verify.faces import Faces, faces_of, joined_marks
from exactmesh.verify.links import BOUNDARY, Links, ends_of, slots_of
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.planes import CROSSING, INNER, LOOSE, WHOLE, flatten, glue
from exactmesh.verify.properties import Kind, Property, Verdict
from exactmesh.verify.report import Finding, Violation
from exactmesh.verify.witness import IndexArray, finding_of, joined, places_of, point_name

__all__ = ["Placed", "Survey", "check_cover", "check_inner_parts", "check_outer_parts", "surveyed"]


@dataclass(frozen=True, slots=True)
class Placed:
    """A domain whose points have been looked for in the mesh.

    Attributes:
        outline: the domain as given.
        coordinates, holes: its points in the coordinates of the mesh.
        corner: (n,) the corner at each point's position, -1 where there is none.
        present: (s,) which segments are chains of edges from end to end.
        marks: of the edges, by these segments only: a copy.
        within: how far segments and their ends may be from where they should be; None: not at all.
        squared: the exact square of the largest such distance, isolated points left out.
    """

    outline: Outline
    coordinates: FloatArray
    holes: FloatArray
    corner: IndexArray
    present: npt.NDArray[np.bool_]
    marks: Marks
    within: float | None = None
    squared: mpq = field(default_factory=mpq)

    @property
    def absent(self) -> IndexArray:
        """The segments that are no chain from end to end."""
        return np.flatnonzero(~self.present)

    def name(self, segment: int) -> str:
        """Return a segment of the domain by its number and ends."""
        a, b = (point_name(self.outline.points, int(v)) for v in self.outline.segments[segment])
        return f"segment {segment} of the domain, from point {a} to point {b},"

    def ends(self, segment: int) -> tuple[tuple[float, float], ...]:
        """Return where a segment of the domain begins and ends."""
        return places_of(self.outline.points, self.outline.segments[segment])

    def corners(self, segment: int) -> tuple[int, ...]:
        """Return the corners at the ends of a segment, as far as there are any."""
        return tuple(v for v in self.corner[self.outline.segments[segment]].tolist() if v >= 0)


@dataclass(frozen=True, slots=True)
class Survey:
    """What the sweep over the plane says about a domain.

    Attributes:
        faces: the faces.
        hole_sides, hole_free: where each hole's point lies, and whether that is on no edge.
        stray, stray_covered: the domain's points that are at no corner, and whether they lie in the closed union: of
            an edge of the boundary on which they lie they are located on the covered side.
        unused_covered: whether each unused point of the mesh, at no corner either, lies in the closed union.
    """

    faces: Faces
    hole_sides: IndexArray
    hole_free: npt.NDArray[np.bool_]
    stray: IndexArray
    stray_covered: npt.NDArray[np.bool_]
    unused_covered: npt.NDArray[np.bool_]


def surveyed(
    mesh: Mesh, links: Links, marks: Marks, placed: Placed | None, unused: IndexArray, bits: int, *, inner: bool = False
) -> Survey:
    """Sweep the plane: the boundary of the triangles' union, and the segments that are no chain.

    Args:
        mesh: admissible triangles.
        links: theirs.
        marks: of the edges; what absent segments share with edges of the boundary is added.
        placed: the domain, or None.
        unused: unused points of the mesh that are at no corner's position.
        bits: what a segment of the domain makes of an edge.
        inner: whether the segments within the union cut as well.
    """
    slots = slots_of(links, BOUNDARY)
    if inner or (placed is not None and placed.outline.even_odd):
        cutting = marks & (IN_DOMAIN if inner else ODD) > 0  # what is odd counts, together with what is not found yet
        slots = np.concatenate([slots, np.flatnonzero(cutting & (links.kinds != BOUNDARY))])
    none = np.empty(0, dtype=np.intp)
    stray, h, loose = none, 0, None
    queries = [mesh.coordinates[unused]]
    if placed is not None:
        stray, h = np.flatnonzero(placed.corner < 0), len(placed.holes)
        queries = [placed.holes, placed.coordinates[stray], mesh.coordinates[unused]]
        ends = placed.outline.segments[placed.absent]
        loose = (placed.coordinates[ends], placed.corner[ends]) if len(ends) else None
    odd = (marks if placed is None else placed.marks)[slots] & ODD > 0
    faces = faces_of(mesh, links, slots, odd, loose, np.concatenate(queries))
    if not inner:
        joined_marks(faces, marks, bits)
    sides, _ = faces.answers
    covered, s = faces.covered(sides), len(stray)
    return Survey(faces, sides[:h], ~_on_segments(faces, marks)[:h], stray, covered[h : h + s], covered[h + s :])


def _on_segments(faces: Faces, marks: Marks) -> npt.NDArray[np.bool_]:
    """Tell which queries lie on segments, rather than on bare edges of the mesh."""
    plane, (sides, on) = faces.plane, faces.answers
    drawn = plane.sort == LOOSE
    drawn[: len(faces.slots)] = marks[faces.slots] & IN_DOMAIN > 0
    at_node = plane.node[faces.queries] == 1
    drawn_edges = faces.edges[drawn[faces.edges]]
    ends = np.concatenate([plane.low[drawn_edges], plane.high[drawn_edges]])
    edge = np.minimum(sides >> 1, len(drawn) - 1)
    found: npt.NDArray[np.bool_] = np.where(at_node, np.isin(faces.queries, ends), on & drawn[edge])
    return found


def check_inner_parts(mesh: Mesh, links: Links, marks: Marks, placed: Placed, survey: Survey, bits: int) -> Finding:
    """SEGMENTS_PRESENT, as far as it is about the inside of the union. The edges of what is found are marked."""
    faces, absent = survey.faces, placed.absent
    if faces.outcome != WHOLE:
        return _meeting(mesh, placed, faces)
    plane, parts = faces.plane, faces.edges
    parts = parts[(plane.sort[parts] == LOOSE) & (plane.inside[parts] > 0)]
    ends = np.stack([faces.corner[plane.low[parts]], faces.corner[plane.high[parts]]], axis=1)
    odd = plane.odd[parts] > 0
    found = np.empty(len(parts), dtype=np.bool_)
    for toggled in (False, True):
        found[odd == toggled] = chained(mesh, links, ends[odd == toggled], marks, bits if toggled else bits & ~ODD)
    missing = np.unique(absent[plane.source[parts[~found]]])
    return finding_of(
        missing, lambda i: _missing(placed, i, "is no chain of edges where it runs through the triangles")
    )


def check_outer_parts(marks: Marks, placed: Placed, survey: Survey) -> Finding:
    """SEGMENTS_PRESENT, as far as it is about the outside of the union.

    Args:
        marks: of the edges, complete.
        placed: the domain.
        survey: one in which the segments within the union cut as well. What lies on both sides of an edge of the
            boundary that is on no segment is one face of the segments.
    """
    faces = survey.faces
    plane, rigid = faces.plane, len(faces.slots)
    glue(plane.face, np.flatnonzero((marks[faces.slots] & IN_DOMAIN == 0) & (plane.sort[:rigid] != INNER)))
    flatten(plane.face)
    loose = faces.edges[(plane.sort[faces.edges] == LOOSE) & (plane.inside[faces.edges] == 0)]
    sides = np.concatenate([2 * loose, 2 * loose + 1])
    sides = sides[in_domain(placed, survey, sides)]
    missing = np.unique(placed.absent[plane.source[sides >> 1]])
    return finding_of(missing, lambda i: _missing(placed, i, "bounds a face of the domain where no triangle is"))


def _missing(placed: Placed, i: int, fault: str) -> Violation:
    limit = "" if placed.within is None else f" (within {placed.within:g})"
    message = f"{placed.name(i)} {fault}{limit}"
    kind = Kind.MISSING_SEGMENT
    return Violation(Property.SEGMENTS_PRESENT, kind, (), placed.corners(i), message, places=placed.ends(i))


def _meeting(mesh: Mesh, placed: Placed, faces: Faces) -> Finding:
    """Say what ended the sweep: a segment that crosses another one or an edge, or ends in an edge."""
    plane, (e, f) = faces.plane, faces.plane.witness.tolist()
    if faces.outcome == CROSSING:
        e, f = (e, f) if plane.sort[e] == LOOSE else (f, e)
        if plane.sort[f] == LOOSE:
            fault = f"crosses segment {placed.absent[plane.source[f]]} where no corner and no end of a segment is"
        else:
            fault = f"crosses {_edge(mesh, faces, f)}"
        i, kind = int(placed.absent[plane.source[e]]), Kind.CROSSING
    else:
        there = (placed.coordinates == plane.points[f]).all(axis=1)
        i = int(np.flatnonzero(there[placed.outline.segments].any(axis=1))[0])
        fault, kind = f"ends inside {_edge(mesh, faces, e)}", Kind.HANGING_NODE
    message = f"{placed.name(i)} {fault}"
    violation = Violation(Property.SEGMENTS_PRESENT, kind, (), placed.corners(i), message, places=placed.ends(i))
    return Finding(Verdict.FAILS, 1, (violation,), lower_bound=True)


def _edge(mesh: Mesh, faces: Faces, e: int) -> str:
    ends = (int(faces.corner[v]) for v in (faces.plane.low[e], faces.plane.high[e]))
    return f"the edge {' - '.join(point_name(mesh.points, v) for v in ends)}"


def carved_faces(survey: Survey) -> npt.NDArray[np.bool_]:
    """Tell of each side that represents a face whether a hole's point lies in the face."""
    face = survey.faces.plane.face
    carved = np.zeros(len(face), dtype=np.bool_)
    carved[face[survey.hole_sides[survey.hole_free]]] = True
    return carved


def in_domain(placed: Placed, survey: Survey, sides: IndexArray) -> npt.NDArray[np.bool_]:
    """Tell which sides of edges belong to the domain."""
    faces, face = survey.faces, survey.faces.plane.face
    kept = ~carved_faces(survey)[face[sides]]
    found: npt.NDArray[np.bool_] = kept & (faces.odd(sides) if placed.outline.even_odd else face[sides] != face[-1])
    return found


def first_of_faces(faces: Faces, sides: IndexArray) -> IndexArray:
    """Return the first of the sides of each face."""
    _, first = np.unique(faces.plane.face[sides], return_index=True)
    return sides[np.sort(first)]


def check_cover(mesh: Mesh, links: Links, marks: Marks, placed: Placed, survey: Survey | None) -> Finding:
    """COVERS_DOMAIN, given that every segment runs through the union along edges.

    Without a survey the boundary of the union is one loop, or the rule is even-odd; and there are no holes' points and
    no absent segments. Then by seeds there is nothing besides the boundary to look at; by the even-odd rule its edges
    must have odd segments, and those within even ones, so that parity is 1 within the union and 0 outside of it.
    """
    boundary = slots_of(links, BOUNDARY)
    parts = [finding_of(boundary[marks[boundary] & IN_DOMAIN == 0], lambda slot: _off_segments(mesh, links, slot))]
    if parts[0].verdict is Verdict.HOLDS:
        if placed.outline.even_odd:
            inner = np.flatnonzero((marks & ODD > 0) & (links.kinds != BOUNDARY))
            parts.append(finding_of(inner, lambda slot: _odd_inside(mesh, links, slot)))
        if survey is not None:
            parts += _against_faces(mesh, placed, survey)
        elif placed.outline.even_odd:
            even = boundary[marks[boundary] & ODD == 0]
            parts.append(finding_of(even, lambda slot: _even_boundary(mesh, links, slot)))
    return joined(parts, lower_bound=len(parts) == 1)


def _against_faces(mesh: Mesh, placed: Placed, survey: Survey) -> list[Finding]:
    """Compare the faces, each by the lower side of an edge: what is bounded has one."""
    faces, sides = survey.faces, 2 * survey.faces.edges
    holes = np.flatnonzero(survey.hole_free)
    holes = holes[faces.covered(survey.hole_sides[holes])]
    covered = faces.covered(sides)
    bare = sides[~covered & in_domain(placed, survey, sides)]
    found = [
        finding_of(holes, lambda i: _covered_hole(placed, i)),
        finding_of(first_of_faces(faces, bare), lambda side: _bare_face(mesh, placed, faces, side >> 1)),
    ]
    if placed.outline.even_odd:
        even = first_of_faces(faces, sides[covered & ~faces.odd(sides)])
        found.append(finding_of(even, lambda side: _covered_outside(mesh, faces, side >> 1)))
    return found


def _violation(kind: Kind, vertices: tuple[int, ...], message: str) -> Violation:
    return Violation(Property.COVERS_DOMAIN, kind, (), vertices, message)


def _slot_edge(mesh: Mesh, links: Links, slot: int) -> tuple[tuple[int, int], str]:
    v, b, _ = (int(ends[0]) for ends in ends_of(links, np.array([slot])))
    return (v, b), f"the edge {point_name(mesh.points, v)} - {point_name(mesh.points, b)}"


def _off_segments(mesh: Mesh, links: Links, slot: int) -> Violation:
    ends, name = _slot_edge(mesh, links, slot)
    return _violation(Kind.OFF_SEGMENTS, ends, f"{name} bounds the triangles, but lies on no segment of the domain")


def _odd_inside(mesh: Mesh, links: Links, slot: int) -> Violation:
    ends, name = _slot_edge(mesh, links, slot)
    message = f"triangles lie on both sides of {name}, but an odd number of segments separates the domain from the rest"
    return _violation(Kind.COVERED_OUTSIDE, ends, message)


def _even_boundary(mesh: Mesh, links: Links, slot: int) -> Violation:
    ends, name = _slot_edge(mesh, links, slot)
    message = f"{name} bounds the triangles, but an even number of segments does not separate the domain from the rest"
    return _violation(Kind.COVERED_OUTSIDE, ends, message)


def _covered_hole(placed: Placed, i: int) -> Violation:
    message = f"the hole's point {point_name(placed.outline.holes, i)} lies in a triangle"
    places = places_of(placed.outline.holes, [i])
    return Violation(Property.COVERS_DOMAIN, Kind.COVERED_HOLE, (), (), message, places=places)


def _bare_face(mesh: Mesh, placed: Placed, faces: Faces, e: int) -> Violation:
    if faces.plane.sort[e] == LOOSE:
        segment = int(placed.absent[faces.plane.source[e]])
        name, places = placed.name(segment), placed.ends(segment)
    else:
        name, places = _edge(mesh, faces, e), ()
    message = f"no triangle covers the face of the domain below {name}"
    corners = _corners(faces, e)
    return Violation(Property.COVERS_DOMAIN, Kind.NOT_COVERED, (), corners, message, places=places)


def _covered_outside(mesh: Mesh, faces: Faces, e: int) -> Violation:
    message = f"triangles cover the face below {_edge(mesh, faces, e)}, which is outside of the domain"
    return _violation(Kind.COVERED_OUTSIDE, _corners(faces, e), message)


def _corners(faces: Faces, e: int) -> tuple[int, ...]:
    ends = (int(faces.corner[v]) for v in (faces.plane.low[e], faces.plane.high[e]))
    return tuple(v for v in ends if v >= 0)
