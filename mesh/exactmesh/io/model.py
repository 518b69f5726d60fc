"""What a mesh file holds, as arrays."""

from dataclasses import dataclass
from typing import Protocol, TypeVar

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points
from exactkernel.errors import CoordinateError, NonFiniteError, ShapeError
from exactkernel.types import FloatArray, IntArray
from exactmesh.errors import TopologyError

__all__ = ["MarkerArray", "Mesh", "Triangulated", "mesh_of"]

MarkerArray = npt.NDArray[np.int64]
A = TypeVar("A", bound=npt.NDArray[np.generic])


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
        corners = _indices(triangles, "triangles", 3, 0, n)
        m = None if corners is None else len(corners)
        sides = _indices(edges, "edges", 2, 0, n)
        k = None if sides is None else len(sides)
        fields = {
            "points": coordinates,
            "triangles": corners,
            "neighbors": _rows(_indices(neighbors, "neighbors", 3, -1, m or 0), "neighbors", m),
            "edges": sides,
            "point_attributes": _rows(_attributes(point_attributes, "point_attributes"), "point_attributes", n),
            "point_markers": _rows(_markers(point_markers, "point_markers"), "point_markers", n),
            "triangle_attributes": _rows(
                _attributes(triangle_attributes, "triangle_attributes"), "triangle_attributes", m
            ),
            "edge_markers": _rows(_markers(edge_markers, "edge_markers"), "edge_markers", k),
        }
        for name, array in fields.items():
            object.__setattr__(self, name, None if array is None else _frozen(array))
        object.__setattr__(self, "base", int(base))


def mesh_of(mesh: Mesh | Triangulated) -> Mesh:
    """Return a mesh as it is, a triangulation as the mesh of its points, triangles, neighbours and edges."""
    if isinstance(mesh, Mesh):
        return mesh
    return Mesh(mesh.points, triangles=mesh.triangles, neighbors=mesh.neighbors, edges=mesh.edges)


def _frozen(array: npt.NDArray[np.generic]) -> npt.NDArray[np.generic]:
    if not array.flags.writeable and array.flags.c_contiguous and array.flags.owndata:
        return array  # one of ours, or at least nobody's to change
    copy = np.array(array, order="C", copy=True)
    copy.flags.writeable = False
    return copy


def _array(values: npt.ArrayLike, name: str) -> npt.NDArray[np.generic]:
    try:
        return np.asarray(values)
    except ValueError as error:
        raise ShapeError(f"{name} is no array: {error}") from None


def _integers(values: npt.ArrayLike, name: str) -> MarkerArray:
    array = _array(values, name)
    if array.size == 0:
        return np.zeros(array.shape, dtype=np.int64)
    if array.dtype.kind not in "iu":
        raise ShapeError(f"{name} has dtype {array.dtype}; expected integers")
    if array.dtype.kind == "u" and int(array.max()) >= 1 << 63:
        raise ShapeError(f"{name} has a value beyond 64-bit integers: {array.max()}")
    return array.astype(np.int64)


def _indices(values: npt.ArrayLike | None, name: str, width: int, low: int, high: int) -> IntArray | None:
    if values is None:
        return None
    array = _integers(values, name)
    if array.ndim != 2 or array.shape[1] != width:
        raise ShapeError(f"{name} has shape {array.shape}; expected (n, {width})")
    bad = np.flatnonzero(((array < low) | (array >= high)).any(axis=1))
    if bad.size:
        row = int(bad[0])
        raise TopologyError(
            f"{name}[{row}] is {array[row].tolist()}; indices go from {low} to {high - 1}",
            indices=bad.tolist(),
        )
    return array.astype(np.int32)


def _markers(values: npt.ArrayLike | None, name: str) -> MarkerArray | None:
    if values is None:
        return None
    array = _integers(values, name)
    if array.ndim != 1:
        raise ShapeError(f"{name} has shape {array.shape}; expected one integer a row")
    return array


def _attributes(values: npt.ArrayLike | None, name: str) -> FloatArray | None:
    if values is None:
        return None
    array = _array(values, name)
    if array.ndim != 2:
        raise ShapeError(f"{name} has shape {array.shape}; expected (rows, attributes)")
    if array.dtype.kind not in "fiu":
        raise CoordinateError(f"{name} has dtype {array.dtype}; expected float64")
    with np.errstate(over="ignore", invalid="ignore"):
        doubles = array.astype(np.float64)
        rounded = np.flatnonzero(((doubles.astype(array.dtype) != array) & (array == array)).any(axis=1))
    if rounded.size:
        raise CoordinateError(f"{name}[{rounded[0]}] would be rounded to doubles", indices=rounded.tolist())
    bad = np.flatnonzero(~np.isfinite(doubles).all(axis=1))
    if bad.size:
        raise NonFiniteError(f"{name}[{bad[0]}] is not finite: {doubles[bad[0]].tolist()}", indices=bad.tolist())
    return doubles if array.size else None


def _rows(array: A | None, name: str, count: int | None) -> A | None:
    if array is None:
        return None
    if len(array) != count:
        of = {"p": "points", "t": "triangles", "n": "triangles", "e": "edges"}[name[0]]
        raise ShapeError(f"{name} has {len(array)} rows for {'no' if count is None else count} {of}")
    return array
