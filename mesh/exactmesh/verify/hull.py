"""COVERS_HULL, DISTINCT_POINTS, ALL_POINTS_USED: the points against the triangles."""

import numpy as np

from exactkernel.batch import orient2d_batch
from exactkernel.types import FloatArray
from exactmesh.verify.boundary import Boundary, outside_of
from exactmesh.verify.links import Links
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.properties import Kind, Property, Verdict
from exactmesh.verify.report import Finding, Violation
from exactmesh.verify.witness import (
    IndexArray,
    finding_of,
    point_name,
    rows_of_triangles,
    sign_of,
    twice_area,
)

__all__ = ["check_distinct", "check_hull", "check_used", "first_at_position", "unused_points"]


def first_at_position(points: FloatArray) -> IndexArray:
    """Return for each point the smallest index at its position. O(n log n)."""
    order = np.lexsort((points[:, 1], points[:, 0]))  # stable: equal points by index
    sorted_points = points[order]
    begins = np.ones(len(points), dtype=np.bool_)
    begins[1:] = (sorted_points[1:] != sorted_points[:-1]).any(axis=1)
    first = np.empty(len(points), dtype=np.intp)
    first[order] = order[begins][np.cumsum(begins) - 1]
    return first


def check_distinct(points: FloatArray, first: IndexArray) -> Finding:
    """DISTINCT_POINTS: a violation for each point that an earlier one equals."""

    def describe(v: int) -> Violation:
        message = f"point {point_name(points, v)} has the position of point {first[v]}"
        return Violation(Property.DISTINCT_POINTS, Kind.COINCIDENT_POINTS, (), (int(first[v]), v), message)

    return finding_of(np.flatnonzero(first != np.arange(len(points))), describe)


def unused_points(links: Links) -> IndexArray:
    """Return the points that are no corner of a triangle."""
    return np.flatnonzero(links.last == links.first)


def check_used(mesh: Mesh, unused: IndexArray) -> Finding:
    """ALL_POINTS_USED."""

    def describe(v: int) -> Violation:
        message = f"point {point_name(mesh.points, v)} is no corner of any {mesh.noun}"
        return Violation(Property.ALL_POINTS_USED, Kind.UNUSED_POINT, (), (v,), message)

    return finding_of(unused, describe)


def check_hull(mesh: Mesh, boundary: Boundary, cycle: IndexArray | None, unused: IndexArray) -> Finding:
    """COVERS_HULL, for admissible triangles.

    Their union is the hull iff their boundary is one convex cycle that has every point inside or on it: an
    edge of the boundary has the union on its left side only, so where the union is convex, these edges tile
    its boundary, and being admissible they meet in common vertices.
    """
    if not mesh.size:
        return _hull_of_nothing(mesh)
    if cycle is None:
        return _not_convex(mesh, boundary)

    def describe(v: int) -> Violation:
        message = f"point {point_name(mesh.points, v)} lies outside of all {mesh.noun}s"
        return Violation(Property.COVERS_HULL, Kind.POINT_OUTSIDE, (), (v,), message)

    return finding_of(outside_of(mesh, cycle, unused), describe)


def _hull_of_nothing(mesh: Mesh) -> Finding:
    """No triangles: all that they cover is the hull of collinear points."""
    if not len(mesh.points):
        return Finding(Verdict.HOLDS)
    order = np.lexsort((mesh.points[:, 1], mesh.points[:, 0]))
    low, high = int(order[0]), int(order[-1])
    turns = np.flatnonzero(orient2d_batch(mesh.points[low], mesh.points[high], mesh.points))
    if not turns.size:
        return Finding(Verdict.HOLDS)
    corners = (low, high, int(turns[0]))
    message = f"no {mesh.noun} covers the points {', '.join(point_name(mesh.points, v) for v in corners)}"
    return Finding(
        Verdict.FAILS,
        1,
        (Violation(Property.COVERS_HULL, Kind.NOT_COVERED, (), corners, message),),
        lower_bound=True,
    )


def _not_convex(mesh: Mesh, boundary: Boundary) -> Finding:
    """Name the reflex vertices of the boundary; without any it has several parts."""
    origin, target, apex = boundary
    single = np.flatnonzero(np.bincount(origin) == 1)
    by_target = np.argsort(target, kind="stable")
    before = origin[by_target][np.searchsorted(target[by_target], single)]
    after = target[np.searchsorted(origin, single)]
    turns = orient2d_batch(mesh.points[before], mesh.points[single], mesh.points[after])
    reflex = np.flatnonzero(turns < 0)
    if not reflex.size:
        corners = (int(origin[0]), int(target[0]), int(apex[0]))
        rows = rows_of_triangles(mesh.triangles, [corners], len(mesh.points), mesh.quads)[0]
        message = f"the union is in several parts; one begins at {mesh.noun} {rows[0]}, {_pair(mesh, *corners[:2])}"
        violation = Violation(Property.COVERS_HULL, Kind.DISCONNECTED, rows, corners[:2], message)
        return Finding(Verdict.FAILS, 1, (violation,), lower_bound=True)

    def describe(i: int) -> Violation:
        a, v, b = int(before[i]), int(single[i]), int(after[i])
        magnitude = twice_area(mesh.points, a, v, b)
        message = f"the boundary turns clockwise at {point_name(mesh.points, v)}, between {_pair(mesh, a, b)}"
        return Violation(
            Property.COVERS_HULL, Kind.REFLEX_BOUNDARY, (), (a, v, b), message, sign_of(magnitude), magnitude
        )

    finding = finding_of(reflex, describe)
    return Finding(Verdict.FAILS, finding.count, finding.violations, lower_bound=True)


def _pair(mesh: Mesh, a: int, b: int) -> str:
    return f"{point_name(mesh.points, a)} - {point_name(mesh.points, b)}"
