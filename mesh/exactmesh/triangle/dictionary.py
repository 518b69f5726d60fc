"""The dictionaries of the ``triangle`` package: what comes in is checked, what goes out has its keys and types."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TypedDict, TypeVar, cast

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points
from exactkernel.errors import ShapeError
from exactkernel.types import FloatArray, IntArray
from exactmesh.columns import MarkerArray, array_of, attributes_of, integers, regions_of, rows_for
from exactmesh.errors import ChoiceError

__all__ = ["KEYS", "Given", "TriangleDict", "column", "given_of"]

_CORNERS = (3, 6)

A = TypeVar("A", bound=npt.NDArray[np.generic])


class TriangleDict(TypedDict, total=False):
    """What :func:`exactmesh.triangle.triangulate` returns; what is empty has no key.

    ======================= ======= =========================================================
    ``vertices``            float64 (n, 2): those given, in their order, then the new ones
    ``vertex_attributes``   float64 (n, a): linear between the given ones at new vertices
    ``vertex_markers``      int32   (n, 1)
    ``triangles``           int32   (m, 3), counterclockwise; with o2 (m, 6)
    ``triangle_attributes`` float64 (m, b)
    ``triangle_max_area``   float64 (m, 1): only input, and files
    ``neighbors``           int32   (m, 3), opposite the corners, -1 for none
    ``segments``            int32   (s, 2)
    ``segment_markers``     int32   (s, 1)
    ``holes``               float64 (h, 2), as given
    ``regions``             float64 (r, 4), as given: x, y, attribute, area
    ``edges``               int32   (k, 2)
    ``edge_markers``        int32   (k, 1)
    ======================= ======= =========================================================
    """

    vertices: FloatArray
    vertex_attributes: FloatArray
    vertex_markers: IntArray
    triangles: IntArray
    triangle_attributes: FloatArray
    triangle_max_area: FloatArray
    neighbors: IntArray
    segments: IntArray
    segment_markers: IntArray
    holes: FloatArray
    regions: FloatArray
    edges: IntArray
    edge_markers: IntArray


#: The keys, in and out.
KEYS: tuple[str, ...] = tuple(TriangleDict.__annotations__)


@dataclass(frozen=True)
class Given:
    """A dictionary that was checked; arrays as in :class:`TriangleDict`, markers int64 (k,), areas (m,).

    Of six nodes a triangle, the corners are there.
    """

    vertices: FloatArray
    vertex_attributes: FloatArray | None
    vertex_markers: MarkerArray | None
    triangles: MarkerArray | None
    triangle_attributes: FloatArray | None
    triangle_max_area: FloatArray | None
    segments: MarkerArray
    segment_markers: MarkerArray | None
    holes: FloatArray
    regions: FloatArray


def given_of(tri: Mapping[str, object], *, refines: bool = False) -> Given:
    """Check a dictionary; keys with nothing in them are as good as none.

    If its triangles are to be refined and have six nodes, vertices that are only midpoints are left out.

    Raises:
        ChoiceError: a key that there is not, or no vertices.
        ShapeError, NonFiniteError, CoordinateError: an array is none, or has the wrong shape; the message has its key.
    """
    unknown = [key for key in tri if key not in KEYS]
    if unknown:
        raise ChoiceError(f"{unknown[0]!r} is no key of a triangle dictionary; there are {', '.join(KEYS)}")
    if "vertices" not in tri:
        raise ChoiceError("the dictionary has no 'vertices'")
    content = {key: array_of(cast(npt.ArrayLike, value), key) for key, value in tri.items() if value is not None}
    content = {key: array for key, array in content.items() if array.size}
    points = finite_points(content.get("vertices", ()), "vertices")
    triangles = _read(content, "triangles", _nodes)
    segments = _read(content, "segments", _pairs)
    n, s = len(points), 0 if segments is None else len(segments)
    m = None if triangles is None else len(triangles)
    given = Given(
        points,
        rows_for(_read(content, "vertex_attributes", _attributes), "vertex_attributes", n),
        rows_for(_read(content, "vertex_markers", column), "vertex_markers", n),
        None if triangles is None else triangles[:, :3],
        rows_for(_read(content, "triangle_attributes", _attributes), "triangle_attributes", m),
        rows_for(_read(content, "triangle_max_area", _areas), "triangle_max_area", m),
        np.zeros((0, 2), dtype=np.int64) if segments is None else segments,
        rows_for(_read(content, "segment_markers", column), "segment_markers", s),
        finite_points(content.get("holes", ()), "holes"),
        regions_of(content.get("regions"), "regions"),
    )
    return given if triangles is None or not refines else _without(given, triangles[:, 3:])


def _without(given: Given, middles: MarkerArray) -> Given:
    """Leave out vertices that are only midpoints."""
    assert given.triangles is not None
    n = len(given.vertices)
    dropped = np.setdiff1d(middles, np.union1d(given.triangles, given.segments))
    if dropped.size == 0 or dropped[0] < 0 or dropped[-1] >= n or given.triangles.max() >= n:
        return given  # what is wrong with the numbers will be said
    kept = np.delete(np.arange(n), dropped)
    number = np.cumsum(np.isin(np.arange(n), kept)) - 1
    return replace(
        given,
        vertices=given.vertices[kept],
        vertex_attributes=None if given.vertex_attributes is None else given.vertex_attributes[kept],
        vertex_markers=None if given.vertex_markers is None else given.vertex_markers[kept],
        triangles=number[given.triangles],
        segments=number[given.segments],
    )


def _read(
    content: Mapping[str, npt.NDArray[np.generic]], key: str, kind: Callable[[npt.ArrayLike, str], A]
) -> A | None:
    return kind(content[key], key) if key in content else None


def _whole(values: npt.ArrayLike, name: str) -> MarkerArray:
    """Return integers, also those that come as floats, as they do from files."""
    array = array_of(values, name)
    if array.dtype.kind == "f":
        whole = array.astype(np.float64)
        bad = np.flatnonzero((whole != np.rint(whole)) | (np.abs(whole) > 2.0**31))
        if bad.size:
            raise ShapeError(f"{name} has {whole.reshape(-1)[bad[0]]}; expected integers", indices=bad.tolist())
        return whole.astype(np.int64)
    return integers(values, name)


def column(values: npt.ArrayLike, name: str) -> MarkerArray:
    """Return one integer of 32 bits a row, from (k,) or (k, 1)."""
    array = _whole(values, name)
    if array.ndim == 2 and array.shape[1] == 1:
        array = array.reshape(-1)
    if array.ndim != 1:
        raise ShapeError(f"{name} has shape {array.shape}; expected (k, 1)")
    limits = np.iinfo(np.int32)
    bad = np.flatnonzero((array < limits.min) | (array > limits.max))
    if bad.size:
        raise ShapeError(f"{name}[{bad[0]}] is {array[bad[0]]}: markers have 32 bits", indices=bad.tolist())
    return array


def _pairs(values: npt.ArrayLike, name: str) -> MarkerArray:
    array = _whole(values, name)
    if array.ndim != 2 or array.shape[1] != 2:
        raise ShapeError(f"{name} has shape {array.shape}; expected (s, 2)")
    return array


def _nodes(values: npt.ArrayLike, name: str) -> MarkerArray:
    array = _whole(values, name)
    if array.ndim != 2 or array.shape[1] not in _CORNERS:
        raise ShapeError(f"{name} has shape {array.shape}; expected (m, 3), or (m, 6) from o2")
    return array


def _attributes(values: npt.ArrayLike, name: str) -> FloatArray:
    array = array_of(values, name)
    found = attributes_of(array[:, None] if array.ndim == 1 else array, name)
    assert found is not None  # it is not empty
    return found


def _areas(values: npt.ArrayLike, name: str) -> FloatArray:
    array = array_of(values, name)
    if array.dtype.kind not in "fiu" or array.ndim not in (1, 2) or (array.ndim == 2 and array.shape[1] != 1):
        raise ShapeError(f"{name} is {array.dtype} of shape {array.shape}; expected one number a triangle, (m, 1)")
    areas: FloatArray = array.reshape(-1).astype(np.float64)
    bad = np.flatnonzero(np.isnan(areas))
    if bad.size:
        raise ShapeError(f"{name}[{bad[0]}] is NaN: not positive, or infinite, is unlimited", indices=bad.tolist())
    return areas
