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
    "index_quads",
    "index_triples",
    "points_of",
    "prepared_mesh",
]

Integers = npt.NDArray[np.integer[npt.NBitBase]]

_MAX_POINTS = 2**31  # indices are packed in pairs into 62 bits


@dataclass(frozen=True, slots=True)
class Mesh:
    """Finite points and valid cells: triangles, quadrilaterals, or both. Rows of cells count triangles first.

    Attributes:
        points: float64 (n, 2) as given, for witnesses.
        coordinates: the same, times a power of two where that brings them into the window of the predicates.
        context: for predicates on ``coordinates``.
        triangles: int32 (m, 3) as listed.
        quads: int32 (k, 4) as listed.
    """

    points: FloatArray
    coordinates: FloatArray
    context: Context
    triangles: IntArray
    quads: IntArray

    @property
    def size(self) -> int:
        """The number of cells."""
        return len(self.triangles) + len(self.quads)

    @property
    def noun(self) -> str:
        """What messages call a cell."""
        return "cell" if len(self.quads) else "triangle"

    def corners(self, row: int) -> tuple[int, ...]:
        """Return the corners of a cell."""
        m = len(self.triangles)
        return tuple((self.triangles[row] if row < m else self.quads[row - m]).tolist())


def prepared_mesh(
    points: FloatArray, triangles: Integers, quads: Integers, others: FloatArray
) -> tuple[Mesh, FloatArray]:
    """Return the mesh of finite points and valid indices, and other points that its context is for as well."""
    together = np.concatenate([points, others]) if len(others) else points
    coordinates, context = scaled_into_window(together)
    cells = (np.ascontiguousarray(rows, dtype=np.int32) for rows in (triangles, quads))
    return Mesh(points, coordinates[: len(points)], context, *cells), coordinates[len(points) :]


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


def index_quads(quads: npt.ArrayLike) -> Integers:
    """Return the quadrilaterals as an integer array (k, 4); an empty list is none.

    Raises:
        ShapeError: another shape, or a dtype that is not integer.
    """
    return _index_rows(quads, "quads", "k", 4)


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


def _faults_of_indices(rows: Integers, n: int) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
    """Tell which rows have an index out of range, and which repeat one."""
    outside, repeated = np.zeros((2, len(rows)), dtype=np.bool_)
    corners = rows.T
    for i in range(len(corners)):
        for j in range(i):
            repeated |= corners[i] == corners[j]
    if len(rows) and (int(rows.min()) < 0 or int(rows.max()) >= n):
        for corner in corners:
            outside |= (corner < 0) | (corner >= n)
    return outside, repeated


def check_indices(triangles: Integers, quads: Integers, n: int) -> Finding:
    """INDICES. O(m)."""
    outside, repeated = (
        np.concatenate(masks)
        for masks in zip(_faults_of_indices(triangles, n), _faults_of_indices(quads, n), strict=True)
    )
    m = len(triangles)

    def describe(t: int) -> Violation:
        corners = tuple(int(v) for v in (triangles[t] if t < m else quads[t - m]))
        name = f"triangle {t}" if t < m else f"cell {t}, the quadrilateral"
        if outside[t]:
            kind, sentence = Kind.OUT_OF_RANGE, f"has an index outside 0 .. {n - 1}"
        else:
            kind, sentence = Kind.REPEATED_CORNER, "repeats a corner"
        return Violation(Property.INDICES, kind, (t,), corners, f"{name} {corners} {sentence}")

    return finding_of(np.flatnonzero(repeated | outside), describe)
