"""The boundary for arrays of points: any numeric dtype in, float64 out, nothing rounded on the way."""

import numpy as np
import numpy.typing as npt

from exactkernel.coordinates import doubles_of
from exactkernel.errors import CoordinateError, NonFiniteError, ShapeError
from exactkernel.types import FloatArray, IntArray

__all__ = ["exact_doubles", "finite_points", "vertex_indices"]

_NAMED = 5  # culprits that a message spells out


def _culprits(rows: npt.NDArray[np.intp], name: str) -> str:
    shown = ", ".join(f"{name}[{i}]" for i in rows[:_NAMED])
    return shown if rows.size <= _NAMED else f"{shown} and {rows.size - _NAMED} more"


def exact_doubles(points: npt.ArrayLike, name: str = "points") -> FloatArray:
    """Return points as a C-contiguous float64 array (n, 2); NaN and infinity pass.

    Raises:
        ShapeError: the shape is not (n, 2).
        CoordinateError: the dtype is not numeric, or a value is not exactly a double (an integer beyond 2^53, say).
    """
    try:
        array = np.asarray(points)
    except ValueError as error:  # ragged
        raise ShapeError(f"{name} is not an array of shape (n, 2): {error}") from None
    if array.ndim != 2 or array.shape[1] != 2:
        raise ShapeError(f"{name} has shape {array.shape}; expected (n, 2)")
    if array.dtype == np.float64:
        return np.ascontiguousarray(array, dtype=np.float64)
    if array.dtype == object:
        return _doubles_of_objects(array, name)
    if array.dtype.kind not in "fiu":
        raise CoordinateError(f"{name} has dtype {array.dtype}; expected float64")
    with np.errstate(over="ignore", invalid="ignore"):
        doubles = np.ascontiguousarray(array, dtype=np.float64)
        kept = (doubles.astype(array.dtype) == array) | (array != array)
    rounded = np.flatnonzero(~kept.all(axis=1))
    if rounded.size:
        raise CoordinateError(
            f"{_culprits(rounded, name)}: {array[rounded[0]].tolist()} would be rounded to a double; "
            "scale or shift the input so that every coordinate is a double",
            indices=rounded.tolist(),
        )
    return doubles


def _doubles_of_objects(array: npt.NDArray[np.object_], name: str) -> FloatArray:
    doubles = np.empty(array.shape, dtype=np.float64)
    for i, (x, y) in enumerate(array.tolist()):
        try:
            exact = doubles_of((x, y))
        except NonFiniteError:
            exact = [float(x), float(y)]
        except CoordinateError as error:
            raise CoordinateError(f"{name}[{i}]: {error}", indices=[i]) from None
        if exact is None:
            raise CoordinateError(f"{name}[{i}]: {(x, y)!r} would be rounded to a double", indices=[i])
        doubles[i] = exact
    return doubles


def finite_points(points: npt.ArrayLike, name: str = "points") -> FloatArray:
    """Return points as :func:`exact_doubles` does, all finite.

    Raises:
        NonFiniteError: a coordinate is NaN or infinite; ``indices`` names the points.
        ShapeError, CoordinateError: as for :func:`exact_doubles`.
    """
    doubles = exact_doubles(points, name)
    with np.errstate(over="ignore", invalid="ignore"):
        suspicious = not np.isfinite(doubles.sum())  # one pass; the sum may overflow without a culprit
    if suspicious:
        bad = np.flatnonzero(~np.isfinite(doubles).all(axis=1))
        if bad.size:
            raise NonFiniteError(
                f"{_culprits(bad, name)}: {doubles[bad[0]].tolist()} is not finite", indices=bad.tolist()
            )
    return doubles


def vertex_indices(triangles: npt.ArrayLike, name: str = "triangles") -> IntArray:
    """Return triangles as a C-contiguous int32 array (m, 3); whether the vertices exist is for the caller to say.

    Raises:
        ShapeError: the shape is not (m, 3), the dtype is not integer, or an index needs more than 31 bits.
    """
    try:
        array = np.asarray(triangles)
    except ValueError as error:  # ragged
        raise ShapeError(f"{name} is not an array of shape (m, 3): {error}") from None
    if array.size == 0 and array.ndim <= 2:
        return np.empty((0, 3), dtype=np.int32)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ShapeError(f"{name} has shape {array.shape}; expected (m, 3)")
    if array.dtype.kind not in "iu":
        raise ShapeError(f"{name} has dtype {array.dtype}; expected integers")
    limits = np.iinfo(np.int32)
    large = np.flatnonzero(((array < limits.min) | (array > limits.max)).any(axis=1))
    if large.size:
        raise ShapeError(
            f"{_culprits(large, name)}: {array[large[0]].tolist()} does not fit 32 bits", indices=large.tolist()
        )
    return np.ascontiguousarray(array, dtype=np.int32)
