"""What a mesh file holds, as arrays."""

from dataclasses import dataclass
from typing import Protocol

import numpy.typing as npt

from exactkernel.arrays import finite_points
from exactkernel.errors import ShapeError
from exactkernel.types import FloatArray, IntArray
from exactmesh.columns import MarkerArray, attributes_of, frozen, indices_of, markers_of, rows_for

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


@dataclass(frozen=True, eq=False)
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
        base: 0 or 1, what Triangle's files count from; kept on writing.

    Raises:
        ShapeError: arrays of other shapes, or of numbers of another kind.
        NonFiniteError: NaN or infinity.
        TopologyError: an index that names no point (no triangle); ``indices`` are the rows.

    >>> Mesh([(0, 0), (1, 0), (0, 1)], triangles=[(0, 1, 2)]).triangles
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
        }
        for name, array in fields.items():
            object.__setattr__(self, name, None if array is None else frozen(array))
        object.__setattr__(self, "base", int(base))


def mesh_of(mesh: Mesh | Triangulated) -> Mesh:
    """Return a mesh as it is, a triangulation as the mesh of its points, triangles, neighbours and edges."""
    if isinstance(mesh, Mesh):
        return mesh
    return Mesh(mesh.points, triangles=mesh.triangles, neighbors=mesh.neighbors, edges=mesh.edges)
