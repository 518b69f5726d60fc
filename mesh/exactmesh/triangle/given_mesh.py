"""Triangle's ``r``: triangles that are given, and are to be refined."""

from dataclasses import dataclass, replace

import numpy as np

from exactkernel.types import FloatArray, IntArray
from exactmesh.columns import MarkerArray
from exactmesh.completion import completed
from exactmesh.connectivity import neighbors_of
from exactmesh.constrain import constrained_delaunay
from exactmesh.errors import ChoiceError, InadmissibleError, TopologyError
from exactmesh.holes import seeds_of_holes
from exactmesh.markers import boundary_edges
from exactmesh.ordering import IndexArray
from exactmesh.pslg import PSLG
from exactmesh.triangle.dictionary import Given
from exactmesh.triangle.graph import Graph, solved
from exactmesh.triangle.switches import Switch, Switches
from exactmesh.triangulation import Triangulation, Work
from exactmesh.verify import Property, verify

__all__ = ["GivenMesh", "given_mesh"]


@dataclass(frozen=True)
class GivenMesh:
    """Triangles that are given, over the vertices that they use.

    Attributes:
        given: the triangles as they are.
        used: the vertex of the dictionary that each vertex is.
        graph: the domain that they cover: their boundary, and the segments with p.
    """

    given: Triangulation
    used: IndexArray
    graph: PSLG

    def delaunay(self) -> Triangulation:
        """Return the constrained Delaunay triangulation with the same vertices; the triangles, if they are that."""
        return constrained_delaunay(self.graph)

    def source(self, mesh: Triangulation) -> IntArray:
        """Return for each triangle of another mesh of the domain the given one that it lies in, int32 (m,).

        The same triangle where it is there, else that around the centroid, as floating point finds it.
        """
        at_centre = self.given.locate((mesh.points[mesh.triangles] / 3.0).sum(axis=1))
        mine, theirs = np.sort(self.given.triangles, axis=1), np.sort(mesh.triangles, axis=1)
        number = np.unique(np.concatenate([mine, theirs]), axis=0, return_inverse=True)[1].reshape(-1)
        place = np.full(len(number), -1, dtype=np.int32)
        place[number[: len(mine)]] = np.arange(len(mine), dtype=np.int32)
        same = place[number[len(mine) :]]
        found: IntArray = np.where(same >= 0, same, at_centre)
        for corner in mesh.triangles.T:  # slim as it is, its centroid was rounded out of the domain
            lost = np.flatnonzero(found < 0)
            if lost.size:
                found[lost] = self.given.locate(mesh.points[corner[lost]])
        return found

    def unchanged(self) -> Triangulation:
        """Return the triangles as they are, with the segments and markers that belong to them."""
        same, none = self.delaunay(), np.full(len(self.given.triangles), -1, dtype=np.int32)
        return replace(
            same,
            triangles=self.given.triangles,
            neighbors=self.given.neighbors,
            triangle_attributes=np.zeros((len(none), 0)),
            triangle_regions=none,
        )


def given_mesh(given: Given, switches: Switches, notes: list[str]) -> GivenMesh:
    """Check the triangles of a dictionary, and find out what they cover; ``notes`` gets what is left out.

    Raises:
        ChoiceError: there are none.
        TopologyError: they name vertices that there are not.
        InadmissibleError: they overlap, are listed clockwise, and so on; ``report`` says it with witnesses.
        PSLGError: what they cover, and the segments, have faults.
    """
    n, corners = len(given.vertices), given.triangles
    if corners is None:
        raise ChoiceError("r refines triangles, and the dictionary has no 'triangles': leave r out, or give them")
    _check_range("triangles", corners, n)
    segments, markers = np.zeros((0, 2), dtype=np.int64), None
    if switches.asks(Switch.PSLG):
        segments, markers = given.segments, given.segment_markers
        _check_range("segments", segments, n)
    _check_admissible(given.vertices, corners, segments)
    used = np.union1d(corners, segments)
    mesh = _plain(given.vertices[used], np.searchsorted(used, corners).astype(np.int32))
    segments = np.searchsorted(used, segments)
    added = _new(boundary_edges(mesh.triangles, mesh.neighbors), segments)
    if markers is not None:
        markers = np.concatenate([markers, np.zeros(len(added), dtype=np.int64)])
    part = replace(
        given,
        vertices=mesh.points,
        vertex_attributes=None if given.vertex_attributes is None else given.vertex_attributes[used],
        vertex_markers=None if given.vertex_markers is None else given.vertex_markers[used],
    )
    graph = Graph(part, np.concatenate([segments, added]), markers, _holes(mesh), np.zeros((0, 4)))
    return GivenMesh(mesh, used, solved(graph, lambda pslg: pslg, notes))


def _check_range(name: str, rows: MarkerArray, n: int) -> None:
    bad = np.flatnonzero(((rows < 0) | (rows >= n)).any(axis=1))
    if bad.size:
        row = int(bad[0])
        raise TopologyError(f"{name}[{row}] is {rows[row].tolist()}; vertices are 0 to {n - 1}", indices=bad.tolist())


def _new(boundary: IntArray, segments: MarkerArray) -> MarkerArray:
    """Return the edges of the boundary that are no segments, in Triangle's direction."""
    turned = boundary[:, ::-1].astype(np.int64)
    keys, known = (np.sort(rows, axis=1) @ np.array([1 << 32, 1]) for rows in (turned, segments))
    return turned[~np.isin(keys, known)]


def _check_admissible(points: FloatArray, corners: MarkerArray, segments: MarkerArray) -> None:
    claims = (Property.ORIENTATION, Property.ADMISSIBLE, Property.SEGMENTS_PRESENT)
    report = verify(points, corners, segments=segments, claims=claims)
    if not report.ok:
        fault = report.violations[0]
        raise InadmissibleError(
            f"r refines triangulations, and the triangles are none: {fault.message}",
            report=report,
            indices=fault.triangles or fault.vertices,
        )


def _plain(points: FloatArray, triangles: IntArray) -> Triangulation:
    same = np.arange(len(points), dtype=np.int32)
    return Triangulation(points, triangles, neighbors_of(triangles), same, Work(0, {}, {}))


def _holes(mesh: Triangulation) -> FloatArray:
    """Return a point in each hole of what the triangles cover."""
    triangles, neighbors = completed(mesh.points, mesh.triangles, mesh.neighbors)
    kept = np.arange(len(triangles)) < len(mesh.triangles)
    if kept.all():
        return np.zeros((0, 2))
    none = np.zeros((0, 2))
    return seeds_of_holes(mesh.points, triangles, neighbors, kept, none, np.zeros(0, dtype=np.int32))
