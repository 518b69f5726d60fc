"""verify: arrays or a mesh in, a report out."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

from collections.abc import Collection
from dataclasses import replace
from typing import cast, overload

import numpy as np
import numpy.typing as npt

from exactkernel.context import INCIRCLE_ROW, ORIENT2D_ROW
from exactkernel.types import Stage
from exactmesh.verify.bounds import bounds_of
from exactmesh.verify.checked import CheckedMesh
from exactmesh.verify.constrained import stacked
from exactmesh.verify.deciding import check_mesh
from exactmesh.verify.domain import Domain, constraints_of
from exactmesh.verify.dual import Dual
from exactmesh.verify.given import Extras, Given, numbers_of, of_mesh
from exactmesh.verify.hull import check_distinct, first_at_position
from exactmesh.verify.mesh import (
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
from exactmesh.verify.sizes import Size, sizes_at
from exactmesh.verify.submesh import with_numbers

__all__ = ["verify"]


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

    Of a Delaunay triangulation 4 m orientations, one a vertex of the hull, and one circle an inner edge are asked for,
    and nothing is sorted but the edges at vertices of large degree; in general, edges and points are sorted and swept.
    Reference [Mehlhorn 1999], [Devillers 1998].

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
        bounds=numbers_of(
            min_angle=min_angle,
            max_angle=max_angle,
            max_area=max_area,
            size=sizes if callable(size) else size,
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
