"""What ``exactmesh info`` says of a mesh."""

from collections.abc import Iterator

import numpy as np

from exactmesh.adapters import GivenMesh
from exactmesh.io.model import Mesh
from exactmesh.quality import statistics_of

__all__ = ["facts", "facts_of_foreign"]


def facts_of_foreign(given: GivenMesh) -> Iterator[tuple[str, str]]:
    """Yield what there is to say of a mesh of another package: with quadrilaterals, counts and extents."""
    if not len(given.quads):
        yield from facts(Mesh(given.points, triangles=given.triangles, segments=given.segments))
        return
    yield from facts(Mesh(given.points, segments=given.segments))
    yield "triangles", f"{len(given.triangles):,}"
    yield "quadrilaterals", f"{len(given.quads):,}"


def facts(mesh: Mesh) -> Iterator[tuple[str, str]]:
    """Yield (name, value) pairs for people to read; extents are exact, angles and areas rounded."""
    points, triangles = mesh.points, mesh.triangles
    yield "points", f"{len(points):,}, counted from {mesh.base}"
    if len(points):
        positions = (points + 0.0).view(np.complex128)  # one sortable number a point; -0.0 + 0.0 is 0.0
        yield "duplicates", f"{len(points) - len(np.unique(positions)):,}"
        for axis, name in enumerate("xy"):
            yield name, f"{points[:, axis].min()!s} to {points[:, axis].max()!s}"
    if mesh.point_attributes is not None:
        yield "attributes of a point", str(mesh.point_attributes.shape[1])
    if mesh.point_markers is not None and len(points):
        yield "point markers", f"{mesh.point_markers.min()} to {mesh.point_markers.max()}"
    if mesh.segments is not None:
        yield "segments", f"{len(mesh.segments):,}"
    if mesh.segment_markers is not None and len(mesh.segment_markers):
        yield "segment markers", f"{mesh.segment_markers.min()} to {mesh.segment_markers.max()}"
    for name, seeds in (("holes", mesh.holes), ("regions", mesh.regions)):
        if seeds is not None:
            yield name, f"{len(seeds):,}"
    if triangles is None:
        return
    yield "triangles", f"{len(triangles):,}"
    sides = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1).astype(np.int64)
    edges, uses = np.unique(sides[:, 0] << 32 | sides[:, 1], return_counts=True)
    boundary = int(np.count_nonzero(uses == 1))
    yield "edges", f"{len(edges):,}, {boundary:,} of them on the boundary"
    if mesh.triangle_attributes is not None:
        yield "attributes of a triangle", str(mesh.triangle_attributes.shape[1])
    if len(triangles):
        figures = statistics_of(points, triangles, len(edges), boundary)
        yield "angles", f"{figures.smallest_angle:.9g} to {figures.largest_angle:.9g} degrees"
        yield "areas", f"{figures.smallest_area:.6g} to {figures.largest_area:.6g}, together {figures.area:.6g}"
        yield "edge lengths", f"{figures.shortest_edge:.6g} to {figures.longest_edge:.6g}"
