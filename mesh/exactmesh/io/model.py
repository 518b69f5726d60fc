"""What a mesh file holds, as arrays."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Protocol

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points
from exactkernel.errors import NonFiniteError, ShapeError
from exactkernel.types import FloatArray, IntArray
from exactmesh.columns import MarkerArray, attributes_of, frozen, indices_of, markers_of, regions_of, rows_for

if TYPE_CHECKING:
    from exactmesh.refinement.result import Refinement

__all__ = ["MarkerArray", "Mesh", "Triangulated", "mesh_of"]


class Triangulated(Protocol):
    """What ``write`` needs of a triangulation: :class:`exactmesh.Triangulation` has it."""

    @property
    def points(self) -> FloatArray:
        """(n, 2), one row a vertex."""

    @property
    def triangles(self) -> IntArray:
        """(m, 3), counterclockwise."""

    @property
    def neighbors(self) -> IntArray:
        """(m, 3), opposite the corners; -1 outside."""

    @property
    def edges(self) -> IntArray:
        """(k, 2)."""


@dataclass(frozen=True, eq=False, repr=False)
class Mesh:
    """The content of a mesh file: read-only arrays, indices from 0 whatever the file counts from.

    It is checked for what every reader relies on (shapes, ranges, finite numbers), not for being a
    triangulation: that is :func:`exactmesh.verify.verify`'s business.

    Attributes:
        points: float64 (n, 2).
        triangles: int32 (m, 3), indices into ``points``; None if there are none on file.
        neighbors: int32 (m, 3), the triangle opposite each corner, -1 outside.
        edges: int32 (k, 2), indices into ``points``.
        point_attributes: float64 (n, a).
        point_markers: int64 (n,).
        triangle_attributes: float64 (m, b).
        edge_markers: int64 (k,).
        segments: int32 (s, 2), the edges that are constrained; None if there are none on file.
        segment_markers: int64 (s,).
        holes: float64 (h, 2), a point inside each hole.
        regions: float64 (r, 4), x, y, attribute and largest area of each region.
        base: 0 or 1, what Triangle's files count from; kept on writing.

    Raises:
        ShapeError: arrays of other shapes, or of numbers of another kind.
        NonFiniteError: NaN or infinity.
        TopologyError: an index that names no point (no triangle); ``indices`` are the rows.

    >>> mesh = Mesh([(0, 0), (1, 0), (0, 1)], triangles=[(0, 1, 2)])
    >>> mesh
    Mesh(3 points, 1 triangles)
    >>> mesh.triangles
    array([[0, 1, 2]], dtype=int32)
    """

    points: FloatArray
    triangles: IntArray | None = None
    neighbors: IntArray | None = None
    edges: IntArray | None = None
    point_attributes: FloatArray | None = None
    point_markers: MarkerArray | None = None
    triangle_attributes: FloatArray | None = None
    edge_markers: MarkerArray | None = None
    segments: IntArray | None = None
    segment_markers: MarkerArray | None = None
    holes: FloatArray | None = None
    regions: FloatArray | None = None
    base: int = 0

    def __init__(
        self,
        points: npt.ArrayLike,
        *,
        triangles: npt.ArrayLike | None = None,
        neighbors: npt.ArrayLike | None = None,
        edges: npt.ArrayLike | None = None,
        point_attributes: npt.ArrayLike | None = None,
        point_markers: npt.ArrayLike | None = None,
        triangle_attributes: npt.ArrayLike | None = None,
        edge_markers: npt.ArrayLike | None = None,
        segments: npt.ArrayLike | None = None,
        segment_markers: npt.ArrayLike | None = None,
        holes: npt.ArrayLike | None = None,
        regions: npt.ArrayLike | None = None,
        base: int = 0,
    ) -> None:
        if base not in (0, 1):
            raise ShapeError(f"base is {base}; files count from 0 or 1")
        coordinates = finite_points(points)
        n = len(coordinates)
        corners = indices_of(triangles, "triangles", 3, 0, n)
        m = None if corners is None else len(corners)
        sides = indices_of(edges, "edges", 2, 0, n)
        k = None if sides is None else len(sides)
        constrained = indices_of(segments, "segments", 2, 0, n)
        s = None if constrained is None else len(constrained)
        hole_seeds, region_seeds = _seeds(holes, regions, s)
        fields = {
            "points": coordinates,
            "triangles": corners,
            "neighbors": rows_for(indices_of(neighbors, "neighbors", 3, -1, m or 0), "neighbors", m),
            "edges": sides,
            "point_attributes": rows_for(attributes_of(point_attributes, "point_attributes"), "point_attributes", n),
            "point_markers": rows_for(markers_of(point_markers, "point_markers"), "point_markers", n),
            "triangle_attributes": rows_for(
                attributes_of(triangle_attributes, "triangle_attributes"), "triangle_attributes", m
            ),
            "edge_markers": rows_for(markers_of(edge_markers, "edge_markers"), "edge_markers", k),
            "segments": constrained,
            "segment_markers": rows_for(markers_of(segment_markers, "segment_markers"), "segment_markers", s),
            "holes": hole_seeds,
            "regions": region_seeds,
        }
        for name, array in fields.items():
            object.__setattr__(self, name, None if array is None else frozen(array))
        object.__setattr__(self, "base", int(base))

    def __repr__(self) -> str:
        parts = {"triangles": self.triangles, "edges": self.edges, "segments": self.segments}
        counts = [f"{len(self.points)} points", *(f"{len(p)} {name}" for name, p in parts.items() if p is not None)]
        return f"Mesh({', '.join(counts)})"


def _seeds(
    holes: npt.ArrayLike | None, regions: npt.ArrayLike | None, segments: int | None
) -> tuple[FloatArray | None, FloatArray | None]:
    """Return the seeds of holes and regions, None if there are none."""
    hole_seeds, region_seeds = finite_points(() if holes is None else holes, "holes"), regions_of(regions, "regions")
    bad = np.flatnonzero(~np.isfinite(region_seeds).all(axis=1))
    if bad.size:
        raise NonFiniteError(f"regions[{bad[0]}] is not finite: {region_seeds[bad[0]].tolist()}", indices=bad.tolist())
    if segments is None and len(hole_seeds) + len(region_seeds):
        raise ShapeError("holes and regions belong to segments, and there are none")
    return hole_seeds if len(hole_seeds) else None, region_seeds if len(region_seeds) else None


def mesh_of(mesh: Mesh | Triangulated | Refinement) -> Mesh:
    """Return a mesh as it is, a triangulation (of a refinement, too) as the mesh of what it consists of.

    That is points, triangles, neighbours and edges; of a PSLG also its segments, markers, attributes, and seeds.
    """
    if isinstance(mesh, Mesh):
        return mesh
    from exactmesh.refinement.result import Refinement  # compiled code stands behind these: most files do not need it
    from exactmesh.triangulation import Triangulation

    if isinstance(mesh, Refinement):
        mesh = mesh.triangulation
    plain = Mesh(mesh.points, triangles=mesh.triangles, neighbors=mesh.neighbors, edges=mesh.edges)
    if not isinstance(mesh, Triangulation) or mesh.pslg is None:
        return plain
    return replace(
        plain,
        point_attributes=mesh.vertex_attributes,
        point_markers=mesh.vertex_markers,
        triangle_attributes=mesh.triangle_attributes,
        edge_markers=mesh.edge_markers,
        segments=mesh.segments,
        segment_markers=mesh.segment_markers,
        holes=mesh.holes,
        regions=mesh.pslg.regions,
    )
