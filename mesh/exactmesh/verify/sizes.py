"""MAX_LENGTH: every edge of a triangle against the size that is wanted there, exactly."""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from exactkernel.context import Context, chunk_size, make_context
from exactkernel.errors import BoundError, ShapeError
from exactkernel.jit import jit
from exactkernel.rational import raise_if_interrupted
from exactkernel.shape import length_above_adaptive
from exactkernel.types import FloatArray, IntArray
from exactmesh.verify.grading import rank_lengths
from exactmesh.verify.mesh import Integers, Mesh
from exactmesh.verify.properties import Kind, Property, Severity
from exactmesh.verify.report import Finding, Violation, root_above
from exactmesh.verify.severity import length_severity
from exactmesh.verify.witness import finding_of, point_name, squared_length

__all__ = ["Size", "check_lengths", "size_of", "sizes_at"]

_CHUNK = 1 << 17  # triangles between two looks at Ctrl-C

#: Sizes at positions (k, 2), one number or (k,), all positive.
Size: TypeAlias = "Callable[[FloatArray], npt.ArrayLike]"


def size_of(size: "Size | npt.ArrayLike | None", m: int) -> "Size | FloatArray | None":
    """Validate sizes for m triangles: a function is left as it is, numbers become (m,).

    Raises:
        ShapeError: an array of another shape or dtype.
        BoundError: a size is not positive.
    """
    return size if size is None or callable(size) else _sizes(size, m, "size")


def _sizes(sizes: npt.ArrayLike, m: int, name: str) -> FloatArray:
    array = np.asarray(sizes)
    if array.dtype.kind not in "iuf" or array.shape not in ((), (m,)):
        raise ShapeError(f"{name} has shape {array.shape} and dtype {array.dtype}; expected a number or {m} of them")
    limits = np.broadcast_to(array.astype(np.float64), m)
    bad = np.flatnonzero(~(limits > 0.0))
    if bad.size:
        raise BoundError(f"{name} is positive, not {float(limits[bad[0]])} (triangle {bad[0]})", indices=bad.tolist())
    return limits


def _centroids(points: FloatArray, triangles: Integers) -> FloatArray:
    """Return the mean of the corners, in doubles."""
    corners = points[triangles]
    with np.errstate(over="ignore", invalid="ignore"):
        at: FloatArray = corners.mean(axis=1)
    if not np.isfinite(at).all():
        at = np.ldexp(np.ldexp(corners, -2).mean(axis=1), 2)
    return at


@jit
def find_long(
    k: Context, limits: FloatArray, points: FloatArray, triangles: IntArray, found: npt.NDArray[np.bool_]
) -> None:
    """Tell which triangles have an edge above their limit."""
    for t in range(len(triangles)):
        found[t] = False
        for i in range(3):
            a, b = triangles[t, i], triangles[t, (i + 1) % 3]
            if length_above_adaptive(k, limits[t], points[a, 0], points[a, 1], points[b, 0], points[b, 1]):
                found[t] = True


def sizes_at(size: "Size | FloatArray | None", points: FloatArray, triangles: Integers) -> FloatArray | None:
    """Return sizes (m,): those that are given, or what the function says of the centroids.

    Raises:
        ShapeError, BoundError: the function does not return positive numbers.
    """
    if not callable(size):
        return size
    return _sizes(size(_centroids(points, triangles)), len(triangles), "what size returned")


def check_lengths(mesh: Mesh, limits: FloatArray) -> Finding:
    """MAX_LENGTH: a violation for each triangle with an edge longer than its size; measured as areas are."""
    points, triangles, m = mesh.points, mesh.triangles, len(mesh.triangles)
    k = make_context(points)._replace(counts=mesh.context.counts)
    found = np.empty(m, dtype=np.bool_)
    step = chunk_size(k, _CHUNK)
    for start in range(0, m, step):
        part = slice(start, start + step)
        find_long(k, limits[part], points, triangles[part], found[part])
        raise_if_interrupted()

    def describe(t: int) -> Violation:
        corners = triangles[t].tolist()
        edges = [(corners[i - 1], corners[i]) for i in range(3)]
        squared, (a, b) = max((squared_length(points, *edge), edge) for edge in edges)
        limit = float(limits[t])
        severity = length_severity(points, corners, limit)
        message = (
            f"the edge {point_name(points, a)} - {point_name(points, b)} of triangle {t} is "
            f"{root_above(squared):.6g} long, more than {limit:g}"
        )
        if severity is Severity.ROUNDING:
            message += ", rounding-sized"
        kind = Kind.LONG_EDGE
        return Violation(Property.MAX_LENGTH, kind, (t,), (a, b), message, magnitude=squared, severity=severity)

    culprits = np.flatnonzero(found)
    return finding_of(culprits, describe, rank_lengths(points, k, triangles, culprits, limits))
