"""What a caller may ask of refinement, checked once."""

import math
from collections.abc import Callable
from enum import StrEnum
from typing import NamedTuple, Self, TypeAlias

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray
from exactmesh.errors import ChoiceError, OptionError, ShapeError
from exactmesh.plane import BoolArray

__all__ = ["MAX_ANGLE", "Options", "Size", "Steiner", "Unsuitable", "checked_options"]

#: Called with points (k, 2); returns the longest edges wanted there, (k,), or one number for all.
Size: TypeAlias = Callable[[FloatArray], npt.ArrayLike]

#: Called with the corners (k, 3, 2) and the areas (k,) of triangles; returns which of them to refine, (k,).
Unsuitable: TypeAlias = Callable[[FloatArray, FloatArray], npt.ArrayLike]

#: Degrees. No triangle has all angles above 60, and refinement gets nowhere long before.
MAX_ANGLE = 40.0


class Steiner(StrEnum):
    """Where points may be added."""

    ANYWHERE = "anywhere"
    NOT_ON_BOUNDARY = "not-on-boundary"
    NOT_ON_SEGMENTS = "not-on-segments"
    """Neither on the boundary nor on segments inside."""

    @classmethod
    def _missing_(cls, value: object) -> Self:
        raise ChoiceError(f"steiner={value!r}; choose from {', '.join(cls)}")


class Options(NamedTuple):
    """The checked arguments of ``refine``; infinity and 0 where there is no bound."""

    min_angle: float
    max_area: float | FloatArray
    size: Size | None
    unsuitable: Unsuitable | None
    conforming: bool
    steiner: Steiner
    max_steiner: float
    min_edge: float

    @property
    def asks_for_points(self) -> bool:
        """Whether any of them asks for points; regions may, too."""
        sized = not isinstance(self.max_area, float) or self.max_area < math.inf or self.size or self.unsuitable
        return bool(self.min_angle > 0.0 or self.conforming or sized)


def checked_options(
    min_angle: float,
    max_area: npt.ArrayLike | None,
    size: Size | float | None,
    unsuitable: Unsuitable | None,
    conforming: bool,
    steiner: Steiner | str,
    max_steiner: int | None,
    min_edge: float | None,
) -> Options:
    """Return the options.

    Raises:
        OptionError: a number is out of range, or none; a function cannot be called.
        ChoiceError: ``steiner`` is none of the words.
    """
    angle = _number("min_angle", min_angle)
    if not 0.0 <= angle <= MAX_ANGLE:
        raise OptionError(f"min_angle={min_angle!r} degrees; it must be from 0 (no bound) to {MAX_ANGLE:g}")
    if unsuitable is not None and not callable(unsuitable):
        raise OptionError(f"unsuitable={unsuitable!r} is no function")
    edge = 0.0 if min_edge is None else _number("min_edge", min_edge)
    if not 0.0 <= edge < math.inf:
        raise OptionError(f"min_edge={min_edge!r}; it must be a length")
    budget = math.inf
    if max_steiner is not None:
        budget = _number("max_steiner", max_steiner)
        if budget < 0.0 or budget != math.floor(budget):
            raise OptionError(f"max_steiner={max_steiner!r}; it must be a number of points")
    return Options(angle, _areas(max_area), _size(size), unsuitable, bool(conforming), Steiner(steiner), budget, edge)


def _number(name: str, value: object) -> float:
    if isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool):
        try:
            number = float(value)
        except OverflowError:
            raise OptionError(f"{name} is beyond the doubles") from None
        if not math.isnan(number):
            return number
    raise OptionError(f"{name}={value!r} is no number")


def _size(size: Size | float | None) -> Size | None:
    if size is None or callable(size):
        return size
    if isinstance(size, bool) or not isinstance(size, (int, float, np.integer, np.floating)):
        raise OptionError(f"size={size!r} is neither a length nor a function")
    length = _number("size", size)
    if length <= 0.0:
        raise OptionError(f"size={size!r}; it must be positive")
    return lambda _: length


def _areas(max_area: npt.ArrayLike | None) -> float | FloatArray:
    if max_area is None:
        return math.inf
    if isinstance(max_area, (int, float, np.integer, np.floating)):
        area = _number("max_area", max_area)
        if area <= 0.0:
            raise OptionError(f"max_area={max_area!r}; it must be positive")
        return area
    areas = _array("max_area", max_area)
    if areas.dtype.kind not in "iuf":
        raise OptionError(f"max_area={max_area!r} is no number, nor an array of numbers")
    areas = areas.astype(np.float64)
    if areas.ndim != 1:
        raise ShapeError(f"max_area has shape {areas.shape}; it must be a number, or one for each triangle")
    if np.isnan(areas).any():
        raise OptionError(f"max_area of triangle {int(np.isnan(areas).argmax())} is no number")
    return np.where(areas > 0.0, areas, math.inf)


def _array(name: str, given: npt.ArrayLike) -> npt.NDArray[np.float64]:
    try:
        array: npt.NDArray[np.float64] = np.asarray(given)  # of any dtype: its kind is looked at
    except ValueError:
        raise ShapeError(f"{name} is ragged: not an array") from None
    return array


def flags_of(answer: npt.ArrayLike, count: int) -> BoolArray:
    """Return what ``unsuitable`` answered.

    Raises:
        ShapeError: it is no array of bools of that length.
    """
    flags: BoolArray = np.asarray(_array("the answer of unsuitable", answer))
    if flags.shape != (count,) or flags.dtype != np.bool_:
        raise ShapeError(
            f"unsuitable returned {flags.dtype} of shape {flags.shape}; it must return one bool for each of the"
            f" {count} triangles"
        )
    return flags


def sizes_of(answer: npt.ArrayLike, count: int, at: FloatArray) -> FloatArray:
    """Return what ``size`` answered.

    Raises:
        ShapeError: it is neither an array of numbers of that length nor one number.
        OptionError: a size is not positive.
    """
    sizes = _array("the answer of size", answer)
    if sizes.ndim == 0:
        sizes = np.broadcast_to(sizes, (count,))
    if sizes.shape != (count,) or sizes.dtype.kind not in "iuf":
        raise ShapeError(
            f"size returned {sizes.dtype} of shape {sizes.shape}; it must return one number, or one for each of the"
            f" {count} points"
        )
    bad = np.flatnonzero(~(sizes > 0))
    if bad.size:
        raise OptionError(f"size returned {sizes[bad[0]]} at {tuple(at[bad[0]].tolist())}; sizes must be positive")
    return sizes.astype(np.float64)
