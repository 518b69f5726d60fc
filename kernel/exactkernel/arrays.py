"""The boundary for arrays of points: any numeric dtype in, float64 out, nothing rounded on the way."""

import numpy as np
import numpy.typing as npt

from exactkernel.coordinates import doubles_of
from exactkernel.errors import CoordinateError, NonFiniteError, ShapeError, shown
from exactkernel.types import Coordinate, FloatArray, IntArray

__all__ = ["exact_doubles", "finite_points", "unrounded_array", "vertex_indices"]

_NAMED = 5  # culprits that a message spells out


def _culprits(rows: npt.NDArray[np.intp], name: str) -> str:
    shown = ", ".join(f"{name}[{i}]" for i in rows[:_NAMED])
    return shown if rows.size <= _NAMED else f"{shown} and {rows.size - _NAMED} more"


def unrounded_array(points: npt.ArrayLike, name: str) -> npt.NDArray[np.generic]:
    """Return points as an array, of objects where numpy would round.

    Raises:
        ShapeError: the rows differ in length.
    """
    try:
        array = np.asarray(points)
        if array.dtype == np.float64 and not isinstance(points, np.ndarray) and np.any(abs(array) >= 2.0**53):
            array = np.asarray(points, dtype=object)  # among floats, numpy has rounded the integers
    except ValueError as error:  # ragged
        raise ShapeError(f"{name} is not an array of shape (n, 2): {error}") from None
    return array


def _is_kept(array: npt.NDArray[np.generic], doubles: FloatArray) -> npt.NDArray[np.bool_]:
    """Tell which numbers are doubles, by the way there and back."""
    within = np.ones(doubles.shape, np.bool_)
    if array.dtype.kind != "f":  # the cast back of what rounded up to 2^63 or 2^64 is undefined
        within = doubles < 2.0 ** (8 * array.dtype.itemsize - (array.dtype.kind == "i"))
    back = np.where(within, doubles, 0.0).astype(array.dtype)
    kept: npt.NDArray[np.bool_] = np.equal(back, array) | np.isnan(doubles)
    return within & kept


def _refuse_masked(points: npt.ArrayLike, name: str) -> None:
    """numpy drops a mask silently, and with it the fact that a value is missing."""
    if isinstance(points, np.ma.MaskedArray):
        masked = np.flatnonzero(np.ma.getmaskarray(points).reshape(len(points), -1).any(axis=1))
        if masked.size:
            raise CoordinateError(f"{_culprits(masked, name)}: masked", indices=masked.tolist())


def exact_doubles(points: npt.ArrayLike, name: str = "points") -> FloatArray:
    """Return points as a C-contiguous float64 array (n, 2); NaN and infinity pass.

    Raises:
        ShapeError: the shape is not (n, 2).
        CoordinateError: the dtype is not numeric, or a value is not exactly a double (an integer beyond 2^53,
        say).
    """
    _refuse_masked(points, name)
    array = unrounded_array(points, name)
    if array.shape == (0,):  # an empty list
        return np.empty((0, 2), dtype=np.float64)
    if array.ndim != 2 or array.shape[1] != 2:
        given = "" if isinstance(points, np.ndarray) else f" ({type(points).__name__})"
        raise ShapeError(f"{name} has shape {array.shape}{given}; expected (n, 2)")
    if array.dtype == np.float64:
        return np.ascontiguousarray(array, dtype=np.float64)
    if array.dtype == object:
        return _doubles_of_objects(array, name)
    if array.dtype.kind not in "fiu":
        raise CoordinateError(f"{name} has dtype {array.dtype}; expected float64")
    with np.errstate(over="ignore", invalid="ignore"):
        doubles = np.ascontiguousarray(array, dtype=np.float64)
        rounded = np.flatnonzero(~_is_kept(array, doubles).all(axis=1))
    if rounded.size:
        raise CoordinateError(
            f"{_culprits(rounded, name)}: {array[rounded[0]].tolist()} would be rounded to a double; "
            "scale or shift the input so that every coordinate is a double",
            indices=rounded.tolist(),
        )
    return doubles


def _doubles_of_objects(array: npt.NDArray[np.generic], name: str) -> FloatArray:
    doubles = np.empty(array.shape, dtype=np.float64)
    for i, (x, y) in enumerate(array.tolist()):
        doubles[i] = _double_or_non_finite(x, i, name), _double_or_non_finite(y, i, name)
    return doubles


def _double_or_non_finite(value: Coordinate, i: int, name: str) -> float:
    try:
        exact = doubles_of((value, 0))
    except NonFiniteError:
        return float(value)
    except CoordinateError as error:
        raise CoordinateError(f"{name}[{i}]: {error}", indices=[i]) from None
    if exact is None:
        raise CoordinateError(f"{name}[{i}]: {shown(value)} would be rounded to a double", indices=[i])
    return exact[0]


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
