"""verify: what is decided first, and what rests on it."""

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from exactkernel.context import INCIRCLE_ROW, ORIENT2D_ROW
from exactkernel.types import IntArray, Stage
from exactmesh.verify.admissible import check_overlap, check_sweep, check_zero_area
from exactmesh.verify.boundary import Boundary, boundary_of, convex_cycle
from exactmesh.verify.delaunay import check_delaunay, enclosed_points
from exactmesh.verify.hull import check_distinct, check_hull, check_used, first_at_position, unused_points
from exactmesh.verify.links import Links, linked
from exactmesh.verify.manifold import check_edges, check_fans, fans_finding
from exactmesh.verify.mesh import Mesh, check_finite, check_indices, index_triples, points_of, prepared_mesh
from exactmesh.verify.properties import Orientation, Property, Verdict, claimed_properties, orientation_of
from exactmesh.verify.report import Finding, Report
from exactmesh.verify.triangles import Shapes, check_angles, check_orientation, classified, turned
from exactmesh.verify.witness import IndexArray

__all__ = ["verify"]


def verify(
    points: npt.ArrayLike,
    triangles: npt.ArrayLike,
    *,
    claims: Collection[Property | str] | None = None,
    orientation: Orientation | str = Orientation.CCW,
) -> Report:
    """Decide exactly which properties a set of triangles has; by default, whether it is what ``delaunay``
    promises.

    Every property of :class:`Property` is decided and reported, claimed or not, for arrays from anywhere:
    nothing about the triangles is assumed, nothing is sampled, no tolerance is used.

    Args:
        points: (n, 2), any numeric dtype whose values are doubles; NaN and infinity fail FINITE.
        triangles: (m, 3), any integer dtype; an index out of range fails INDICES.
        claims: what ``Report.ok`` is about; None claims a Delaunay triangulation of all the points, that is
            everything but WEAKLY_ACUTE and ACUTE.
        orientation: "ccw", or "any" to take clockwise triangles as well.

    Raises:
        ShapeError: points or triangles have another shape, or the triangles another dtype.
        CoordinateError: a coordinate is not exactly a double.
        ChoiceError: an unknown claim or orientation.

    O(n + m) for a Delaunay triangulation; O((n + m) log(n + m)) in general. Reference [Mehlhorn 1999],
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
    claimed, chosen = claimed_properties(claims), orientation_of(orientation)
    doubles, triples = points_of(points), index_triples(triangles)
    findings = {
        Property.FINITE: check_finite(doubles),
        Property.INDICES: check_indices(triples, len(doubles)),
    }
    failed = tuple(property_ for property_, finding in findings.items() if finding.verdict is Verdict.FAILS)
    counts = np.zeros((2, len(Stage)), dtype=np.int64)
    if not failed:
        with np.errstate(over="ignore", invalid="ignore"):  # interpreted, a numpy scalar warns where a double does not
            mesh = prepared_mesh(doubles, triples)
            findings.update(check_mesh(mesh, chosen))
        counts = mesh.context.counts
    elif Property.FINITE not in failed:
        findings[Property.DISTINCT_POINTS] = check_distinct(doubles, first_at_position(doubles))
    undecided = Finding(Verdict.UNDECIDED, because=failed)
    return Report(
        findings={property_: findings.get(property_, undecided) for property_ in Property},
        claims=claimed,
        point_count=len(doubles),
        triangle_count=len(triples),
        stages={
            name: {stage: int(counts[row, stage]) for stage in Stage}
            for name, row in (("orient2d", ORIENT2D_ROW), ("incircle", INCIRCLE_ROW))
        },
    )


@dataclass(frozen=True, slots=True)
class Tiling:
    """What is known about the triangles with area, counterclockwise, when their admissibility is decided."""

    links: Links
    admissible: Finding
    boundary: Boundary | None
    cycle: IndexArray | None


def check_mesh(mesh: Mesh, orientation: Orientation) -> dict[Property, Finding]:
    """Decide everything about finite points and valid triangles."""
    shapes = classified(mesh)
    upright = turned(mesh.triangles, shapes)
    listed = upright if orientation is Orientation.ANY else mesh.triangles
    proper = upright[shapes.orientation > 0] if (shapes.orientation == 0).any() else upright
    tiling = tiled(mesh, shapes, proper)
    links = tiling.links if listed is proper else linked(mesh.coordinates, mesh.context, listed)
    unused = unused_points(links)
    findings = {
        Property.ORIENTATION: check_orientation(mesh, shapes, orientation),
        Property.ALL_POINTS_USED: check_used(mesh, unused),
        Property.EDGE_MANIFOLD: check_edges(mesh, links),
        Property.VERTEX_MANIFOLD: _fans(mesh, links, tiling),
        Property.ADMISSIBLE: tiling.admissible,
        Property.WEAKLY_ACUTE: check_angles(mesh, shapes, Property.WEAKLY_ACUTE),
        Property.ACUTE: check_angles(mesh, shapes, Property.ACUTE),
    }
    findings.update(_against_points(mesh, shapes, tiling, unused))
    return findings


def tiled(mesh: Mesh, shapes: Shapes, proper: IntArray) -> Tiling:
    """Decide ADMISSIBLE: triangles without area, then edges with two triangles on a side, then the
    boundary."""
    links = linked(mesh.coordinates, mesh.context, proper)
    for finding in (check_zero_area(mesh, shapes), check_overlap(mesh, links)):
        if finding.verdict is Verdict.FAILS:
            return Tiling(links, replace(finding, lower_bound=True), None, None)
    boundary = boundary_of(links)
    cycle = convex_cycle(mesh, boundary)
    admissible = Finding(Verdict.HOLDS) if cycle is not None else check_sweep(mesh, boundary)
    return Tiling(links, admissible, boundary, cycle)


def _fans(mesh: Mesh, links: Links, tiling: Tiling) -> Finding:
    """VERTEX_MANIFOLD: admissible triangles that close round a vertex leave no room for more, so two fans are
    open ones, and each begins with an edge of the boundary. Otherwise every vertex is walked round."""
    boundary = tiling.boundary
    if links is not tiling.links or boundary is None or tiling.admissible.verdict is not Verdict.HOLDS:
        return check_fans(mesh, links)
    return fans_finding(mesh, np.unique(boundary.origin[1:][boundary.origin[1:] == boundary.origin[:-1]]))


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
        if not missing and len(mesh.triangles):
            used = np.flatnonzero(tiling.links.first[1:] > tiling.links.first[:-1])
            enclosed = enclosed_points(unused, used, first)
    return {
        Property.DISTINCT_POINTS: distinct,
        Property.COVERS_HULL: hull,
        Property.DELAUNAY: check_delaunay(mesh, shapes, tiling.links, enclosed, tuple(missing)),
    }
