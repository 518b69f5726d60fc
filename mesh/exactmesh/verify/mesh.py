"""What is checked: the input as it came, and the same in the form that the compiled checks read."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import exact_doubles
from exactkernel.context import Context, scaled_into_window
from exactkernel.errors import ShapeError
from exactkernel.types import FloatArray, IntArray
from exactmesh.verify.properties import Kind, Property, Verdict
from exactmesh.verify.report import Finding, Violation
from exactmesh.verify.witness import finding_of, point_name

__all__ = [
    "Integers",
    "Mesh",
    "check_finite",
    "check_indices",
    "index_pairs",
    "index_triples",
    "points_of",
    "prepared_mesh",
]

Integers = npt.NDArray[np.integer[npt.NBitBase]]

_MAX_POINTS = 2**31  # indices are packed in pairs into 62 bits


@dataclass(frozen=True, slots=True)
class Mesh:
    """Finite points and valid triangles.

    Attributes:
        points: float64 (n, 2) as given, for witnesses.
        coordinates: the same, times a power of two where that brings them into the window of the predicates.
        context: for predicates on ``coordinates``.
        triangles: int32 (m, 3) as listed.
    """

    points: FloatArray
    coordinates: FloatArray
    context: Context
    triangles: IntArray


def prepared_mesh(points: FloatArray, triangles: Integers, others: FloatArray) -> tuple[Mesh, FloatArray]:
    """Return the mesh of finite points and valid indices, and other points that its context is for as well."""
    together = np.concatenate([points, others]) if len(others) else points
    coordinates, context = scaled_into_window(together)
    mesh = Mesh(points, coordinates[: len(points)], context, np.ascontiguousarray(triangles, dtype=np.int32))
    return mesh, coordinates[len(points) :]


def points_of(points: npt.ArrayLike) -> FloatArray:
    """Return the points as exact doubles, NaN and infinity included.

    Raises:
        ShapeError: not of shape (n, 2), or too many for 31 bits.
        CoordinateError: a coordinate is not exactly a double.
    """
    doubles = exact_doubles(points)
    if len(doubles) > _MAX_POINTS:
        raise ShapeError(f"{len(doubles)} points; at most 2^31 can be checked")
    return doubles


def index_triples(triangles: npt.ArrayLike) -> Integers:
    """Return the triangles as an integer array (m, 3); an empty list is no triangles.

    Raises:
        ShapeError: another shape, or a dtype that is not integer.
    """
    return _index_rows(triangles, "triangles", "m", 3)


def index_pairs(segments: npt.ArrayLike, name: str = "segments") -> Integers:
    """Return segments as an integer array (s, 2); an empty list is no segments.

    Raises:
        ShapeError: another shape, or a dtype that is not integer.
    """
    return _index_rows(segments, name, "s", 2)


def _index_rows(rows: npt.ArrayLike, name: str, letter: str, width: int) -> Integers:
    try:
        array = np.asarray(rows)
    except ValueError as error:  # ragged
        raise ShapeError(f"{name} is not an array of shape ({letter}, {width}): {error}") from None
    if array.shape in ((0,), (0, width)):
        return np.empty((0, width), dtype=np.int32)
    if array.ndim != 2 or array.shape[1] != width:
        raise ShapeError(f"{name} has shape {array.shape}; expected ({letter}, {width})")
    if array.dtype.kind not in "iu":
        raise ShapeError(f"{name} has dtype {array.dtype}; expected an integer type")
    return array


def check_finite(points: FloatArray) -> Finding:
    """FINITE. O(n)."""
    with np.errstate(over="ignore", invalid="ignore"):
        if np.isfinite(points.sum()):  # one pass; where the sum overflows, look closer
            return Finding(Verdict.HOLDS)
    return finding_of(
        np.flatnonzero(~np.isfinite(points).all(axis=1)),
        lambda v: Violation(Property.FINITE, Kind.NOT_FINITE, (), (v,), f"point {point_name(points, v)} is not finite"),
    )


def check_indices(triangles: Integers, n: int) -> Finding:
    """INDICES. O(m)."""
    a, b, c = triangles.T
    repeated = (a == b) | (b == c) | (c == a)
    outside = np.zeros(len(triangles), dtype=np.bool_)
    if len(triangles) and (int(triangles.min()) < 0 or int(triangles.max()) >= n):
        for corner in (a, b, c):
            outside |= (corner < 0) | (corner >= n)

    def describe(t: int) -> Violation:
        corners = tuple(int(v) for v in triangles[t])
        if outside[t]:
            kind, sentence = Kind.OUT_OF_RANGE, f"has an index outside 0 .. {n - 1}"
        else:
            kind, sentence = Kind.REPEATED_CORNER, "repeats a corner"
        return Violation(Property.INDICES, kind, (t,), corners, f"triangle {t} {corners} {sentence}")

    return finding_of(np.flatnonzero(repeated | outside), describe)
