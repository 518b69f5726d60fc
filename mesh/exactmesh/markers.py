"""Which markers vertices, constrained edges and edges get: Triangle's rule.

An edge gets the marker of its segment if that is not 0, else 1 on the boundary, else 0. A vertex gets its own marker if
that is not 0, else the marker of a segment that touches it, else 1 on the boundary, else 0. Where several could give
one, the first in the input that is not 0 does.
"""

import numpy as np

from exactkernel.types import IntArray
from exactmesh.columns import MarkerArray
from exactmesh.plane import BoolArray
from exactmesh.pslg import PSLG

__all__ = ["boundary_edges", "edge_keys", "markers_along", "markers_of_edges", "vertex_markers"]


def _first_nonzero(rows: IntArray, values: MarkerArray, size: int) -> MarkerArray:
    """Return for each row the first of its values that is not 0, or 0."""
    found = np.zeros(size, dtype=np.int64)
    given = values != 0
    found[rows[given][::-1]] = values[given][::-1]
    return found


def boundary_edges(triangles: IntArray, neighbors: IntArray) -> IntArray:
    """Return the edges with a triangle on one side only, on their left, int32 (b, 2)."""
    open_ = neighbors < 0
    return np.stack([np.roll(triangles, -1, axis=1)[open_], np.roll(triangles, -2, axis=1)[open_]], axis=1)


def markers_along(pslg: PSLG, incidence: IntArray, on_boundary: BoolArray) -> MarkerArray:
    """Return the marker of each constrained edge; ``incidence`` has rows (edge, segment), segments in order."""
    found = np.zeros(len(on_boundary), dtype=np.int64)
    if pslg.segment_markers is not None:
        found = _first_nonzero(incidence[:, 0], pslg.segment_markers[incidence[:, 1]], len(found))
    return np.where(found == 0, on_boundary, found)


def vertex_markers(
    graph: PSLG, representative: IntArray, segments: IntArray, boundary: IntArray, source: PSLG, incidence: IntArray
) -> MarkerArray:
    """Return the marker of each vertex of the graph.

    ``segments`` are the constrained edges, ``boundary`` those of the boundary, and ``incidence`` has rows (constrained
    edge, segment of the source), segments in order.
    """
    vertices = int(representative.max()) + 1
    found = np.zeros(vertices, dtype=np.int64)
    if graph.point_markers is not None:
        stays = representative >= 0
        found = _first_nonzero(representative[stays], graph.point_markers[stays], vertices)
    if source.segment_markers is not None:
        markers = np.repeat(source.segment_markers[incidence[:, 1]], 2)
        touched = _first_nonzero(segments[incidence[:, 0]].reshape(-1), markers, vertices)
        found = np.where(found == 0, touched, found)
    outer = np.zeros(vertices, dtype=np.bool_)
    outer[boundary] = True
    return np.where(found == 0, outer, found)


def markers_of_edges(edges: IntArray, boundary: IntArray, segments: IntArray, markers: MarkerArray) -> MarkerArray:
    """Return the marker of each edge: that of the constrained edge if it is not 0, else 1 on the boundary, else 0.

    ``boundary`` and ``segments`` are edges among them. O(k log k).
    """
    keys = edge_keys(edges)
    order = np.argsort(keys)
    found = np.zeros(len(edges), dtype=np.int64)
    found[order[np.searchsorted(keys, edge_keys(boundary), sorter=order)]] = 1
    rows = order[np.searchsorted(keys, edge_keys(segments), sorter=order)]
    found[rows[markers != 0]] = markers[markers != 0]
    return found


def edge_keys(edges: IntArray) -> MarkerArray:
    """Return a number for each edge, the same in both directions."""
    low, high = edges.min(axis=1).astype(np.int64), edges.max(axis=1)
    keys: MarkerArray = low << 32 | high
    return keys
