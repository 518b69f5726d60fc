"""The cells of a boundary conforming Delaunay triangulation, inside of its domain.

If no edge of the boundary sees the apex of its triangle under an obtuse angle, every circumcentre lies in the domain,
and so the ridges dual to those edges end in their midpoints.
"""

import numpy as np

from exactkernel.batch import diametral_batch
from exactkernel.jit import jit
from exactkernel.types import FloatArray, IntArray
from exactmesh.errors import NotConformingError
from exactmesh.ordering import IndexArray
from exactmesh.triangulation import Triangulation
from exactmesh.voronoi.cells import Cells, CornerKind, KindArray
from exactmesh.voronoi.clipping import Diagram, placed, without_repetitions
from exactmesh.voronoi.walk import other_site

__all__ = ["check_conforming", "clipped_to_domain"]

_VERTEX, _MIDPOINT, _SITE = int(CornerKind.VERTEX), int(CornerKind.MIDPOINT), int(CornerKind.SITE)


def check_conforming(mesh: Triangulation) -> None:
    """Refuse a Delaunay triangulation with a circumcentre outside of its domain.

    Raises:
        NotConformingError: ``indices`` are the ends of an edge of the boundary with a circumcentre beyond it.
    """
    t, i = np.nonzero(mesh.neighbors < 0)
    a, b, apex = (mesh.triangles[t, (i + turn) % 3] for turn in (1, 2, 0))
    if not len(t):
        return
    beyond = np.flatnonzero(diametral_batch(mesh.points[a], mesh.points[b], mesh.points[apex]) > 0)
    if beyond.size:
        edge = (int(a[beyond[0]]), int(b[beyond[0]]))
        raise NotConformingError(
            f"the circumcentre of triangle {t[beyond[0]]} lies beyond edge {edge} of the boundary"
            + (f", and {beyond.size - 1} more like it" if beyond.size > 1 else "")
            + ": the triangulation is not boundary conforming (refine it with conforming=True)",
            indices=edge,
        )


@jit
def _polygons(
    ridge_points: IntArray, offsets: IndexArray, cells: IntArray, cell_ridges: IntArray, sites: IntArray,
    bounds: IndexArray, kinds: KindArray, sources: IntArray, neighbors: IntArray,
) -> tuple[int, int]:  # fmt: skip
    """Write the polygons, one for each site inside and for each fan of a site on the boundary; return their number and
    that of the corners."""
    at = count = 0
    for s in range(len(offsets) - 1):
        for j in range(offsets[s], offsets[s + 1]):
            ridge = cell_ridges[j]
            other = other_site(ridge_points, ridge, s)
            is_open = cells[j] < 0
            if j == offsets[s] or is_open:
                sites[count], bounds[count] = s, at
                count += 1
            if is_open:
                kinds[at], sources[at], neighbors[at] = _SITE, s, -1
                kinds[at + 1], sources[at + 1], neighbors[at + 1] = _MIDPOINT, ridge, other
                at += 2
                continue
            kinds[at], sources[at], neighbors[at] = _VERTEX, cells[j], other
            at += 1
            ends = j + 1 == offsets[s + 1] or cells[j + 1] < 0
            if ends and cells[offsets[s]] < 0:
                kinds[at], sources[at], neighbors[at] = _MIDPOINT, ridge, -1
                at += 1
    bounds[count] = at
    return count, at


def clipped_to_domain(d: Diagram) -> Cells:
    """Return the cells inside of the domain of the conforming triangulation that the diagram is the dual of. O(n)."""
    room = len(d.cells) + 2 * int((d.cells < 0).sum())
    kinds, (sources, neighbors) = np.empty(room, dtype=np.int8), (np.empty(room, dtype=np.int32) for _ in range(2))
    most = len(d.points) + int((d.cells < 0).sum())
    sites, bounds = np.empty(most, dtype=np.int32), np.empty(most + 1, dtype=np.int64)
    count, size = _polygons(
        d.ridge_points, d.offsets, d.cells, d.cell_ridges, sites, bounds, kinds, sources, neighbors
    )  # fmt: skip
    kinds, sources, neighbors = kinds[:size], sources[:size], neighbors[:size]
    corners = placed(kinds, sources, {_VERTEX: d.vertices, _MIDPOINT: _midpoints(d), _SITE: d.points})
    nothing, nobody = np.empty((0, 2)), np.empty((0, 3), dtype=np.int32)
    cells = Cells(
        d.points, sites[:count], bounds[: count + 1], corners, neighbors, kinds, sources, nothing, d.vertex_sites,
        nobody, d.ridge_points,
    )  # fmt: skip
    return without_repetitions(cells)


def _midpoints(d: Diagram) -> FloatArray:
    """Return the middle of each edge that has a ridge, as the nearest doubles."""
    a, b = d.points[d.ridge_points[:, 0]], d.points[d.ridge_points[:, 1]]
    with np.errstate(over="ignore"):
        middles = 0.5 * (a + b)
    halves = 0.5 * a + 0.5 * b  # rounds twice, but where the sum overflows nothing is subnormal
    return np.where(np.isfinite(middles), middles, halves)
