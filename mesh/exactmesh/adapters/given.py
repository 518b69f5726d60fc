"""What an adapter returns, and what several of them need."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

from dataclasses import dataclass, field
from typing import cast

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import exact_doubles
from exactkernel.errors import ShapeError
from exactkernel.types import FloatArray, IntArray
from exactmesh.errors import AdapterError
from exactmesh.verify.domain import Domain
from exactmesh.verify.properties import Orientation, Property

__all__ = [
    "GivenDomain",
    "GivenMesh",
    "Indices",
    "array_of",
    "index_rows",
    "is_a",
    "no_pairs",
    "planar_points",
    "points_of",
]

Indices = npt.NDArray[np.integer]


def no_pairs(width: int) -> Indices:
    """Return no rows of so many indices."""
    return np.empty((0, width), dtype=np.int32)


@dataclass(frozen=True, slots=True)
class GivenDomain:
    """A domain as some file or dictionary describes it: a :class:`exactmesh.verify.Domain`, not checked yet.

    Attributes:
        points, segments, holes, regions: see :class:`exactmesh.verify.Domain`.
        rule: "seeds" or "even-odd".
    """

    points: FloatArray
    segments: IntArray
    holes: FloatArray
    regions: FloatArray
    rule: str = "seeds"


@dataclass(frozen=True, slots=True, eq=False)
class GivenMesh:
    """A mesh of whatever package, as :func:`exactmesh.verify` takes it. Arrays may be those of the object: no copies.

    Attributes:
        points: float64 (n, 2). Numbers of 32 bits are exact; a third coordinate, if constant, is left out.
        triangles: integers (m, 3).
        quads: integers (k, 4), each quadrilateral in the order of its sides.
        segments: integers (s, 2), lines that should be there, or None.
        labels: (m + k,) a label a cell, or None.
        domain: what should be covered, or None.
        orientation: how the package lists corners, as far as it promises something.
        claims: what is claimed of such a mesh by default; None is what :func:`exactmesh.verify` claims of arrays.
        source: what it is, for people: "a scipy Delaunay".
    """

    points: FloatArray
    triangles: Indices = field(default_factory=lambda: no_pairs(3))
    quads: Indices = field(default_factory=lambda: no_pairs(4))
    segments: Indices | None = None
    labels: FloatArray | None = None
    domain: Domain | None = None
    orientation: Orientation = Orientation.CCW
    claims: tuple[Property, ...] | None = None
    source: str = "arrays"

    def __repr__(self) -> str:
        counts = [f"{len(self.points)} points", f"{len(self.triangles)} triangles"]
        if len(self.quads):
            counts.append(f"{len(self.quads)} quadrilaterals")
        return f"GivenMesh({self.source}: {', '.join(counts)})"


def is_a(mesh: object, package: str, *names: str) -> bool:
    """Tell whether the object is of one of these classes of a package, or of one made of them; nothing is imported."""
    return any(base.__name__ in names and base.__module__.partition(".")[0] == package for base in type(mesh).__mro__)


def points_of(points: object, corners: Indices, what: str) -> FloatArray:
    """Return points as exact doubles, of arrays with three columns as :func:`planar_points` does."""
    in_space = isinstance(points, np.ndarray) and points.ndim == 2 and points.shape[1] == 3
    return planar_points(points, corners, what) if in_space else exact_doubles(cast(npt.ArrayLike, points))


def planar_points(points: object, corners: Indices, what: str) -> FloatArray:
    """Return points of the plane, from two or three columns; of three, the last is constant over the corners.

    Points that are no corner (centres of arcs, control points) may lie anywhere.

    Raises:
        AdapterError: another number of columns, or points in space: ``indices`` names the first one off the plane.
        CoordinateError: a coordinate is not exactly a double.
    """
    array = np.asarray(points)
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        raise AdapterError(f"{what} has points of shape {array.shape}; expected (n, 2), or (n, 3) in one plane")
    if array.shape[1] == 3:
        _require_plane(array, corners, what)
    return exact_doubles(array[:, :2])


def _require_plane(array: npt.NDArray[np.generic], corners: Indices, what: str) -> None:
    """Refuse corners at different heights. Corners that do not exist are for the verifier to find."""
    used = np.zeros(len(array), dtype=np.bool_)
    flat = corners.ravel()
    used[flat[(flat >= 0) & (flat < len(array))]] = True
    rows = np.flatnonzero(used)
    if not rows.size:
        return
    height = array[:, 2]
    off = rows[height[rows] != height[rows[0]]]
    if off.size:
        v = int(off[0])
        raise AdapterError(
            f"{what} is not planar: point {v} has z = {height[v]}, point {rows[0]} has z = {height[rows[0]]} "
            "(for another plane, give two columns of the points, and the triangles)",
            indices=[v],
        )


def array_of(rows: object, what: str) -> npt.NDArray[np.generic]:
    """Return an array.

    Raises:
        ShapeError: rows of different lengths.
    """
    try:
        return np.asarray(rows)
    except ValueError as error:
        raise ShapeError(f"{what} is no array: {error}") from None


def index_rows(rows: object, width: int, what: str, *, nodes: int | None = None) -> Indices:
    """Return rows of so many indices; of rows of ``nodes``, the first ones: the corners of cells with more nodes.

    Raises:
        ShapeError: another shape, or no integers.
    """
    array = array_of(rows, what)
    if array.size == 0:
        return no_pairs(width)
    if array.ndim != 2 or array.shape[1] not in (width, nodes) or array.dtype.kind not in "iu":
        raise ShapeError(f"{what} has shape {array.shape} and dtype {array.dtype}; expected integers (m, {width})")
    signed = array.astype(np.int64) if array.dtype == np.uint64 else array  # beside others, numpy would make it float
    return cast("Indices", signed[:, :width])
