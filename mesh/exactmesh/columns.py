"""Arrays that go beside the points: indices, markers, attributes; checked at the boundary, never rounded."""

from typing import TypeVar

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import exact_doubles, unrounded_array
from exactkernel.errors import CoordinateError, NonFiniteError, ShapeError
from exactkernel.types import FloatArray, IntArray
from exactmesh.errors import TopologyError

__all__ = [
    "MarkerArray",
    "array_of",
    "attributes_of",
    "frozen",
    "indices_of",
    "integers",
    "markers_of",
    "regions_of",
    "rows_for",
]

MarkerArray = npt.NDArray[np.int64]

_REGIONS = "(r, 4): x, y, attribute, area; or (r, 3)"
_ROWS_OF = {
    "p": "points", "v": "vertices", "t": "triangles", "n": "triangles", "e": "edges", "s": "segments",
}  # fmt: skip
_UNLIMITED = -1.0  # area of a region that is given without one

A = TypeVar("A", bound=npt.NDArray[np.generic])


def frozen(array: A) -> A:
    """Return the array as one that nobody can change: itself if that is so already, else a copy."""
    if not array.flags.writeable and array.flags.c_contiguous and array.flags.owndata:
        return array  # one of ours, or at least nobody's to change
    copy = array.copy(order="C")
    copy.flags.writeable = False
    return copy


def array_of(values: npt.ArrayLike, name: str) -> npt.NDArray[np.generic]:
    """Return the values as an array of whatever type; ShapeError if they are ragged, or some are masked."""
    _refuse_masked(values, name)
    try:
        return np.asarray(values)
    except ValueError as error:
        raise ShapeError(f"{name} is no array: {error}") from None


def _refuse_masked(values: npt.ArrayLike | None, name: str) -> None:
    """numpy drops a mask silently, and with it the fact that a value is missing."""
    if isinstance(values, np.ma.MaskedArray) and np.ma.getmaskarray(values).any():
        raise ShapeError(f"{name} has masked values")


def integers(values: npt.ArrayLike, name: str) -> MarkerArray:
    """Return the values as int64; ShapeError if they are no integers, or beyond 64 bits."""
    array = array_of(values, name)
    if array.size == 0:
        return np.zeros(array.shape, dtype=np.int64)
    if array.dtype.kind not in "iu":
        raise ShapeError(f"{name} has dtype {array.dtype}; expected integers")
    if array.dtype.kind == "u" and int(array.max()) >= 1 << 63:
        raise ShapeError(f"{name} has a value beyond 64-bit integers: {array.max()}")
    return array.astype(np.int64)


def indices_of(values: npt.ArrayLike | None, name: str, width: int, low: int, high: int) -> IntArray | None:
    """Return rows of ``width`` indices in low .. high - 1; TopologyError names the others."""
    if values is None:
        return None
    array = integers(values, name)
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


def markers_of(values: npt.ArrayLike | None, name: str) -> MarkerArray | None:
    """Return one integer a row."""
    if values is None:
        return None
    array = integers(values, name)
    if array.ndim != 1:
        raise ShapeError(f"{name} has shape {array.shape}; expected one integer a row")
    return array


def attributes_of(values: npt.ArrayLike | None, name: str) -> FloatArray | None:
    """Return (rows, attributes) as finite doubles, or None if there is no attribute; nothing is rounded."""
    if values is None:
        return None
    array = array_of(values, name)
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


def rows_for(array: A | None, name: str, count: int | None) -> A | None:
    """Return the array if it has the right number of rows; its name tells what a row belongs to."""
    if array is None:
        return None
    if len(array) != count:
        of = _ROWS_OF[name[0]]
        raise ShapeError(f"{name} has {len(array)} rows for {'no' if count is None else count} {of}")
    return array


def regions_of(values: npt.ArrayLike | None, name: str) -> FloatArray:
    """Return rows x, y, attribute, area, (r, 4); rows of three get an area of -1: unlimited. NaN and infinity pass."""
    _refuse_masked(values, name)
    try:
        array = unrounded_array(() if values is None else values, name)
    except ShapeError:
        raise ShapeError(f"{name} has rows of different lengths; expected {_REGIONS}") from None
    if array.size == 0 and array.ndim <= 2:
        return np.zeros((0, 4))
    if array.ndim != 2 or array.shape[1] not in (3, 4):
        raise ShapeError(f"{name} has shape {array.shape}; expected {_REGIONS}")
    places, bounds = exact_doubles(array[:, :2], name), exact_doubles(array[:, [2, -1]], name)
    if array.shape[1] == 3:
        bounds[:, 1] = _UNLIMITED
    return np.hstack([places, bounds])
