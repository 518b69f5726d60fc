"""From a triangulation to a dictionary with the keys, shapes and types of the ``triangle`` package."""

from dataclasses import dataclass
from typing import cast

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray, IntArray
from exactmesh.columns import MarkerArray
from exactmesh.markers import boundary_edges
from exactmesh.ordering import IndexArray
from exactmesh.triangle.dictionary import KEYS, Given, TriangleDict
from exactmesh.triangle.solve import Solution
from exactmesh.triangle.switches import Switch, Switches
from exactmesh.triangulation import Triangulation

__all__ = ["dictionary_of"]


@dataclass(frozen=True)
class _Vertices:
    """The vertices of a result: coordinates, attributes (n, a), a may be 0, and markers (n,)."""

    xy: FloatArray
    attributes: FloatArray
    markers: MarkerArray

    def with_middles(self, edges: IndexArray, markers: MarkerArray) -> "_Vertices":
        """Return these, and after them the middle of each edge."""
        a, b = edges.T
        with np.errstate(over="ignore"):
            sums = self.xy[a] + self.xy[b]
        middles = np.where(np.isfinite(sums), 0.5 * sums, 0.5 * self.xy[a] + 0.5 * self.xy[b])
        between = 0.5 * self.attributes[a] + 0.5 * self.attributes[b]
        return self.followed_by(middles, between, markers)

    def followed_by(self, xy: FloatArray, attributes: FloatArray, markers: MarkerArray) -> "_Vertices":
        """Return these vertices and more."""
        return _Vertices(
            np.concatenate([self.xy, xy]),
            np.concatenate([self.attributes, attributes]),
            np.concatenate([self.markers, markers]),
        )


def dictionary_of(given: Given, switches: Switches, solution: Solution) -> TriangleDict:
    """Return what the switches ask for; arrays with no row, or no column, have no key. O(m log m)."""
    mesh = solution.mesh
    vertices, number = _numbered(given, switches, solution)
    triangles = number[mesh.triangles]
    if switches.asks(Switch.QUADRATIC):
        triangles = np.hstack([triangles, len(vertices.xy) + _edges_opposite(mesh)])
        vertices = vertices.with_middles(number[mesh.edges], mesh.edge_markers)
    found: dict[str, npt.NDArray[np.generic]] = {}
    if not switches.asks(Switch.NO_NODES):
        found |= {"vertices": vertices.xy, "vertex_attributes": vertices.attributes, "vertex_markers": vertices.markers}
    if not switches.asks(Switch.NO_ELEMENTS):
        found |= {"triangles": triangles, "triangle_attributes": solution.triangle_attributes}
    if switches.asks(Switch.NEIGHBORS):
        found["neighbors"] = mesh.neighbors
    if switches.asks(Switch.PSLG, Switch.CONVEX) and not switches.asks(Switch.NO_POLY):
        found |= _poly(given, switches, mesh, number)
    if switches.asks(Switch.EDGES):
        found |= {"edges": number[mesh.edges], "edge_markers": mesh.edge_markers}
    return _typed(found, with_markers=not switches.asks(Switch.NO_MARKERS))


def _poly(
    given: Given, switches: Switches, mesh: Triangulation, number: IndexArray
) -> dict[str, npt.NDArray[np.generic]]:
    """Return segments; with p also holes and regions, as they were given."""
    segments, markers = mesh.segments, mesh.segment_markers
    found: dict[str, npt.NDArray[np.generic]] = {"segments": number[segments], "segment_markers": markers}
    if switches.asks(Switch.PSLG):
        found |= {"holes": given.holes, "regions": given.regions}
    return found


def _typed(found: dict[str, npt.NDArray[np.generic]], *, with_markers: bool) -> TriangleDict:
    """Return fresh arrays of the right types: markers (k, 1), indices of 32 bits."""
    result: dict[str, npt.NDArray[np.generic]] = {}
    for key in KEYS:
        array = found.get(key)
        if array is None or array.size == 0 or (key.endswith("_markers") and not with_markers):
            continue
        array = array.reshape(-1, 1) if array.ndim == 1 else array
        result[key] = np.array(array, dtype=np.float64 if array.dtype.kind == "f" else np.int32, order="C")
    return cast(TriangleDict, result)


def _numbered(given: Given, switches: Switches, solution: Solution) -> tuple[_Vertices, IndexArray]:
    """Return the vertices, and the number of each vertex of the mesh among them."""
    mesh, origin = solution.mesh, solution.origin
    markers, attributes = _markers(given, solution), _attributes(given, solution)
    if switches.asks(Switch.JETTISON):
        return _Vertices(mesh.points, attributes, markers), np.arange(len(origin), dtype=np.int64)
    n = len(given.vertices)
    new = origin < 0
    number = np.where(new, n + np.cumsum(new) - 1, origin)
    own = np.zeros(n, dtype=np.int64) if given.vertex_markers is None else given.vertex_markers.copy()
    own[origin[~new]] = markers[~new]
    columns = np.zeros((n, 0)) if given.vertex_attributes is None else given.vertex_attributes
    return _Vertices(given.vertices, columns, own).followed_by(mesh.points[new], attributes[new], markers[new]), number


def _attributes(given: Given, solution: Solution) -> FloatArray:
    """Return the attributes of the mesh's vertices."""
    columns = given.vertex_attributes
    if columns is None:
        return np.zeros((len(solution.origin), 0))
    old = columns[solution.origin]
    attributes = solution.mesh.vertex_attributes
    found: FloatArray = np.where((solution.origin >= 0)[:, None], old, attributes) if attributes.size else old
    return found


def _markers(given: Given, solution: Solution) -> MarkerArray:
    """Return the markers of the mesh's vertices."""
    mesh = solution.mesh
    if mesh.pslg is not None:
        return mesh.vertex_markers
    markers = np.zeros(len(mesh.points), dtype=np.int64)
    markers[boundary_edges(mesh.triangles, mesh.neighbors)] = 1
    if given.vertex_markers is not None:
        own = given.vertex_markers[solution.origin]
        markers = np.where(own != 0, own, markers)
    return markers


def _edges_opposite(mesh: Triangulation) -> IntArray:
    """Return the row in ``mesh.edges`` of the edge opposite each corner, (m, 3)."""
    neighbors = mesh.neighbors
    own = np.arange(len(neighbors), dtype=np.int32)[:, None] > neighbors  # the edges are listed by these triangles
    rows = np.empty(neighbors.shape, dtype=np.int32)
    rows[own] = np.arange(len(mesh.edges), dtype=np.int32)
    t, i = np.nonzero(~own)
    u = neighbors[t, i]
    rows[t, i] = rows[u, (neighbors[u] == t[:, None]).argmax(axis=1)]
    return rows
