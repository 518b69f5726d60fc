"""verify: what is decided first, and what rests on it."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import NamedTuple, cast, overload

import numpy as np
import numpy.typing as npt

from exactkernel.context import INCIRCLE_ROW, ORIENT2D_ROW
from exactkernel.types import FloatArray, IntArray, Stage
from exactmesh.verify.admissible import check_overlap, check_sweep, check_zero_area
from exactmesh.verify.boundary import Boundary, boundary_of, convex_cycle
from exactmesh.verify.bounds import Bounds, bounds_of, check_angle_bound, check_areas
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
from exactmesh.verify.checked import CheckedMesh
from exactmesh.verify.constrained import check_constraints, stacked
from exactmesh.verify.delaunay import check_delaunay, enclosed_points
from exactmesh.verify.domain import Constraints, Domain, constraints_of
from exactmesh.verify.dual import Dual
from exactmesh.verify.duality import check_dual
from exactmesh.verify.gabriel import check_gabriel, is_locally_delaunay
from exactmesh.verify.hull import check_distinct, check_hull, check_used, first_at_position, unused_points
from exactmesh.verify.links import Links, linked
from exactmesh.verify.local import Local, localized
from exactmesh.verify.manifold import check_edges, check_fans, fans_finding
from exactmesh.verify.mesh import (
    Mesh,
    check_finite,
    check_indices,
    index_quads,
    index_triples,
    points_of,
    prepared_mesh,
)
from exactmesh.verify.properties import (
    Orientation,
    Property,
    Verdict,
    asked_properties,
    claimed_properties,
    decided_properties,
    orientation_of,
)
from exactmesh.verify.report import Finding, Report
from exactmesh.verify.sizes import Size, check_lengths, sizes_at
from exactmesh.verify.submesh import with_numbers
from exactmesh.verify.triangles import Shapes, check_angles, check_orientation, classified
from exactmesh.verify.witness import IndexArray, joined

__all__ = ["Extras", "Given", "of_mesh", "verify"]


@overload
def verify(
    points: npt.ArrayLike,
    triangles: npt.ArrayLike,
    *,
    quads: npt.ArrayLike | None = None,
    segments: npt.ArrayLike | None = None,
    domain: Domain | None = None,
    labels: npt.ArrayLike | None = None,
    min_angle: float | None = None,
    max_angle: float | None = None,
    max_area: float | npt.ArrayLike | None = None,
    size: Size | npt.ArrayLike | None = None,
    within: float | None = None,
    dual: Dual | None = None,
    claims: Collection[Property | str] | None = None,
    orientation: Orientation | str | None = None,
) -> Report: ...


@overload
def verify(
    points: object,
    triangles: None = None,
    *,
    quads: npt.ArrayLike | None = None,
    segments: npt.ArrayLike | None = None,
    domain: Domain | None = None,
    labels: npt.ArrayLike | None = None,
    min_angle: float | None = None,
    max_angle: float | None = None,
    max_area: float | npt.ArrayLike | None = None,
    size: Size | npt.ArrayLike | None = None,
    within: float | None = None,
    dual: Dual | None = None,
    claims: Collection[Property | str] | None = None,
    orientation: Orientation | str | None = None,
) -> Report: ...


def verify(
    points: object,
    triangles: npt.ArrayLike | None = None,
    *,
    quads: npt.ArrayLike | None = None,
    segments: npt.ArrayLike | None = None,
    domain: Domain | None = None,
    labels: npt.ArrayLike | None = None,
    min_angle: float | None = None,
    max_angle: float | None = None,
    max_area: float | npt.ArrayLike | None = None,
    size: Size | npt.ArrayLike | None = None,
    within: float | None = None,
    dual: Dual | None = None,
    claims: Collection[Property | str] | None = None,
    orientation: Orientation | str | None = None,
) -> Report:
    """Decide exactly which properties a set of triangles has; by default, whether it is what ``delaunay``
    promises, or, with segments or a domain, what ``constrained_delaunay`` does.

    Every property of :class:`Property` that has a meaning for what is given is decided and reported, claimed or not,
    for arrays from anywhere: nothing about the triangles is assumed, nothing is sampled, no tolerance is used.

    Args:
        points: (n, 2), any numeric dtype whose values are doubles; NaN and infinity fail FINITE. Or, alone, a mesh of
            any package that :func:`exactmesh.adapters.given_mesh` understands, from scipy's Delaunay to the path of a
            file: what comes with it, such as its domain, is taken from there, unless it is given here.
        triangles: (m, 3), any integer dtype; an index out of range fails INDICES.
        quads: (k, 4), quadrilaterals besides or instead, each in the order of its sides. In a report cells are
            numbered triangles first, so that quads[0] is cell m.
        segments: (s, 2) indices of points: straight lines that should be edges, or chains of edges. None stands for
            the segments of the domain, if there is one.
        domain: what should be covered, such as a :class:`exactmesh.PSLG`, in points and indices of its own: they are
            matched with those of the mesh by position, exactly.
        labels: (m,) numbers, one a triangle: the attribute of its region; with quadrilaterals (m + k,).
        min_angle, max_angle: degrees, from 0 to 180: claims that no angle is below or above, exactly. No claim is made
            of what a mesh's input does not allow: a triangle in the corner of a small input angle is a violation, too.
        max_area: claims that no triangle has a larger area; one positive number, or (m,) with infinity or what is not
            positive where there is no bound.
        size: claims that no triangle has an edge longer than its size: a positive number, (m,), or a function that is
            called once with the centroids (m, 2) and returns one or m of them.
        within: how far the mesh may be from the domain, 0 to infinity: each segment may be a chain of edges ever
            forward, all vertices of which are so near to it, and each corner may be so far from its point of the
            domain. What is said of segments and of the domain is then said of the displaced ones, and
            ``Report.distance`` says how far they are, exactly. None: not at all.
        dual: a Voronoi diagram, claimed to be the dual of the triangles: :class:`exactmesh.Voronoi`,
            ``scipy.spatial.Voronoi``, or Triangle's arrays (vertices, edges, origins of rays, their directions).
        claims: what ``Report.ok`` is about. None claims a Delaunay triangulation of all the points, that is
            everything up to DELAUNAY; with segments, a constrained one
            (:data:`~exactmesh.verify.CONSTRAINED_TRIANGULATION`); with a domain, a constrained Delaunay triangulation
            of the domain (:data:`~exactmesh.verify.DOMAIN_TRIANGULATION`); with labels, REGIONS besides. Bounds are
            always claimed. GABRIEL, CIRCUMCENTRES_INSIDE and REGION_AREAS are decided only if they are claimed. Of
            quadrilaterals, and of meshes of finite elements (of meshio, pyvista, scikit-fem, shapely),
            :data:`~exactmesh.verify.ADMISSIBLE_MESH` is claimed, with what is said there.
        orientation: "ccw", or "any" to take clockwise triangles as well. None is "ccw" for arrays, and for other meshes
            what their package promises.

    Raises:
        ShapeError: an array has another shape or dtype.
        CoordinateError: a coordinate is not exactly a double.
        NonFiniteError: a coordinate of the domain is not finite.
        PSLGError: the domain has segments without length or without ends, or none of its faces could be even or odd.
        BoundError: an angle outside of 0 to 180 degrees, an area, a size or a distance that is none.
        ChoiceError: an unknown claim, rule or orientation, a claim about something that was not given, or one that
            has no meaning for quadrilaterals.
        AdapterError, FileFormatError: the mesh is none, see :func:`exactmesh.adapters.given_mesh`.

    O(n + m) for a Delaunay triangulation; O((n + m + s) log(n + m + s)) in general. Reference [Mehlhorn 1999],
    [Devillers 1998].

    >>> from exactmesh.verify import Property, verify
    >>> points = [(0, 0), (3, 0), (3, 1), (0, 1)]
    >>> verify(points, [(0, 1, 2), (0, 2, 3)]).ok
    True
    >>> report = verify([(0, 0), (3, -1), (6, 0), (3, 1)], [(0, 1, 2), (0, 2, 3)])
    >>> report.verdict(Property.ADMISSIBLE), report.verdict(Property.DELAUNAY)
    (<Verdict.HOLDS: 'holds'>, <Verdict.FAILS: 'fails'>)
    >>> report.violations[0].magnitude
    Fraction(96, 1)
    """
    cells = Given(points, triangles, quads)
    extras = Extras(segments, domain, labels, orientation)
    if triangles is None and quads is None:
        cells, extras = of_mesh(points, extras)
    doubles = points_of(cast(npt.ArrayLike, cells.points))
    triples = index_triples(() if cells.triangles is None else cells.triangles)
    fours = index_quads(() if cells.quads is None else cells.quads)
    bounds = bounds_of(min_angle, max_angle, max_area, size, len(triples))
    asked = asked_properties(
        segments=extras.segments is not None,
        domain=extras.domain is not None,
        labels=extras.labels is not None,
        bounds=bounds.properties if dual is None else (*bounds.properties, Property.VORONOI_DUAL),
        quads=bool(len(fours)),
    )
    claimed = claimed_properties(claims, asked, extras.usual)
    chosen = orientation_of(Orientation.CCW if extras.orientation is None else extras.orientation)
    decided = decided_properties(asked, claimed)
    constraints = constraints_of(extras.segments, extras.domain, extras.labels, len(triples) + len(fours), within)
    findings = {
        Property.FINITE: check_finite(doubles),
        Property.INDICES: check_indices(triples, fours, len(doubles)),
    }
    failed = tuple(property_ for property_, finding in findings.items() if finding.verdict is Verdict.FAILS)
    counts = np.zeros((2, len(Stage)), dtype=np.int64)
    sizes = None if failed and callable(bounds.size) else sizes_at(bounds.size, doubles, triples)
    if not failed:
        bounds = replace(bounds, size=sizes)
        with np.errstate(over="ignore", invalid="ignore"):  # interpreted, a numpy scalar warns where a double does not
            mesh, positions = prepared_mesh(doubles, triples, fours, stacked(constraints.outline))
            findings.update(check_mesh(mesh, chosen, constraints, positions, bounds, dual, decided))
        counts = mesh.context.counts
    elif Property.FINITE not in failed:
        findings[Property.DISTINCT_POINTS] = check_distinct(doubles, first_at_position(doubles))
    undecided = Finding(Verdict.UNDECIDED, because=failed)
    checked = CheckedMesh(
        doubles,
        triples,
        fours,
        segments=constraints.segments,
        labels=constraints.labels,
        domain=constraints.outline,
        bounds=_numbers(
            min_angle=min_angle,
            max_angle=max_angle,
            max_area=max_area,
            size=sizes,
            within=within,
        ),
        orientation=chosen,
    )
    return Report(
        findings={property_: with_numbers(findings.get(property_, undecided), checked) for property_ in decided},
        claims=claimed,
        point_count=len(doubles),
        triangle_count=len(triples),
        quad_count=len(fours),
        stages={
            name: {stage: int(counts[row, stage]) for stage in Stage}
            for name, row in (("orient2d", ORIENT2D_ROW), ("incircle", INCIRCLE_ROW))
        },
        mesh=checked,
    )


class Given(NamedTuple):
    """Points and cells, as they were given."""

    points: object
    triangles: npt.ArrayLike | None
    quads: npt.ArrayLike | None


class Extras(NamedTuple):
    """What comes with them; ``usual`` is what is claimed of meshes of this sort."""

    segments: npt.ArrayLike | None
    domain: Domain | None
    labels: npt.ArrayLike | None
    orientation: Orientation | str | None
    usual: tuple[Property, ...] | None = None


def of_mesh(mesh: object, extras: Extras) -> tuple[Given, Extras]:
    """Return the arrays of a mesh of some package, and what comes with it, unless something else was given."""
    from exactmesh.adapters import given_mesh  # arrays need none of it

    given = given_mesh(mesh)
    own_domain = extras.domain is None
    return Given(given.points, given.triangles, given.quads), Extras(
        given.segments if extras.segments is None else extras.segments,
        given.domain if own_domain else extras.domain,
        given.labels if extras.labels is None and own_domain else extras.labels,
        given.orientation if extras.orientation is None else extras.orientation,
        given.claims,
    )


def _numbers(**bounds: npt.ArrayLike | None) -> dict[str, float | FloatArray]:
    """Return what was given, as doubles."""
    given = {name: np.asarray(bound, dtype=np.float64) for name, bound in bounds.items() if bound is not None}
    return {name: array if array.ndim else float(array) for name, array in given.items()}


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
    findings.update(_against_points(mesh, shapes, tiling, unused))
    findings.update(_against_bounds(mesh, shapes, upright, bounds))
    if dual is not None:
        findings[Property.VORONOI_DUAL] = check_dual(mesh, tiling.links, upright, dual, findings[Property.DELAUNAY])
    boundary = tiling.boundary if tiling.admissible.verdict is Verdict.HOLDS else None
    marks = np.zeros(len(tiling.links.slots), dtype=np.uint8)
    if constraints.any:
        free = unused if links is tiling.links else unused_points(tiling.links)
        findings.update(
            check_constraints(mesh, shapes, tiling.links, boundary, free, constraints, positions, marks, decided)
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
