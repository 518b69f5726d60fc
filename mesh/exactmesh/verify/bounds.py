"""MIN_ANGLE, MAX_ANGLE, MAX_AREA: every triangle against a bound, exactly."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
import numpy.typing as npt

from exactkernel.angle import AngleBound
from exactkernel.context import Context, chunk_size, make_context
from exactkernel.errors import BoundError, ShapeError, shown
from exactkernel.jit import jit
from exactkernel.rational import raise_if_interrupted
from exactkernel.shape import angle_above_adaptive, angle_below_adaptive, angle_bound, area_above_adaptive
from exactkernel.types import FloatArray, IntArray
from exactmesh.verify.grading import rank_angles, rank_areas
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.properties import Kind, Property, Severity
from exactmesh.verify.report import Finding, Violation
from exactmesh.verify.severity import MEASURE_BOUND, angle_severity, area_terms, severity_of
from exactmesh.verify.sizes import Size, size_of
from exactmesh.verify.triangles import Shapes
from exactmesh.verify.witness import approximately, exact, finding_of, joined, point_name, triangle_name, twice_area

__all__ = ["Bounds", "bounds_of", "check_angle_bound", "check_areas"]

_CHUNK = 1 << 17  # triangles between two looks at Ctrl-C
Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Bounds:
    """What the shapes of triangles are checked against; None: nothing.

    Attributes:
        min_angle, max_angle: for compiled loops.
        max_area: (m,), infinite where there is no bound.
        size: (m,), or a function of the centroids.
    """

    min_angle: AngleBound | None
    max_angle: AngleBound | None
    max_area: FloatArray | None
    size: "Size | FloatArray | None"

    @property
    def properties(self) -> tuple[Property, ...]:
        """What is bounded."""
        given = (self.min_angle, self.max_angle, self.max_area, self.size)
        names = (Property.MIN_ANGLE, Property.MAX_ANGLE, Property.MAX_AREA, Property.MAX_LENGTH)
        return tuple(name for name, bound in zip(names, given, strict=True) if bound is not None)


def bounds_of(
    min_angle: float | None,
    max_angle: float | None,
    max_area: "float | npt.ArrayLike | None",
    size: "Size | npt.ArrayLike | None",
    m: int,
) -> Bounds:
    """Validate bounds for m triangles.

    Raises:
        BoundError: an angle outside 0 to 180 degrees, an area that is NaN, or one for all that is not positive, a size
            that is not positive.
        ShapeError: an array of areas or sizes of another shape or dtype.
    """
    return Bounds(_angle(min_angle, "min_angle"), _angle(max_angle, "max_angle"), _areas(max_area, m), size_of(size, m))


def _angle(degrees: float | None, name: str) -> AngleBound | None:
    if degrees is None:
        return None
    try:
        return angle_bound(degrees)
    except BoundError:
        raise BoundError(f"{name} is a number of degrees between 0 and 180, not {shown(degrees)}") from None


def _areas(areas: "float | npt.ArrayLike | None", m: int) -> FloatArray | None:
    if areas is None:
        return None
    array = np.asarray(areas)
    if array.dtype.kind not in "iuf" or array.shape not in ((), (m,)):
        raise ShapeError(f"max_area has shape {array.shape} and dtype {array.dtype}; expected a number or {m} of them")
    limits = array.astype(np.float64)
    if np.isnan(limits).any():
        raise BoundError("max_area is NaN", indices=np.flatnonzero(np.isnan(limits)).tolist() if limits.ndim else ())
    if limits.ndim == 0 and not limits > 0.0:
        raise BoundError(f"max_area is positive, not {float(limits)}")
    return np.where(limits > 0.0, np.broadcast_to(limits, m), math.inf)


@jit
def find_below(k: Context, bound: AngleBound, points: FloatArray, triangles: IntArray, found: Flags) -> None:
    """Tell which triangles have an angle below the bound."""
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        found[t] = angle_below_adaptive(
            k, bound, points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1]
        )


@jit
def find_above(k: Context, bound: AngleBound, points: FloatArray, triangles: IntArray, found: Flags) -> None:
    """Tell which triangles have an angle above the bound."""
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        found[t] = angle_above_adaptive(
            k, bound, points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1]
        )


@jit
def find_large(k: Context, limits: FloatArray, points: FloatArray, triangles: IntArray, found: Flags) -> None:
    """Tell which triangles have an area above their limit."""
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        found[t] = area_above_adaptive(
            k, limits[t], points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1]
        )


def _found(k: Context, m: int, search: Callable[[slice, Flags], None]) -> Flags:
    """Search in chunks, so that Ctrl-C is heard."""
    found = np.empty(m, dtype=np.bool_)
    step = chunk_size(k, _CHUNK)
    for start in range(0, m, step):
        part = slice(start, start + step)
        search(part, found[part])
        raise_if_interrupted()
    return found


def check_angle_bound(
    mesh: Mesh, shapes: Shapes, triangles: IntArray, bound: AngleBound, property_: Property
) -> Finding:
    """MIN_ANGLE or MAX_ANGLE: a violation for each triangle that has an angle below or above the bound, or no area.

    Args:
        mesh, shapes: the input.
        triangles: its rows, counterclockwise.
        bound: the angle.
        property_: which of the two.
    """
    least = property_ is Property.MIN_ANGLE
    k, points = mesh.context, mesh.coordinates

    def search(part: slice, found: Flags) -> None:
        if least:
            find_below(k, bound, points, triangles[part], found)
        else:
            find_above(k, bound, points, triangles[part], found)

    flat = shapes.orientation == 0
    culprits = np.flatnonzero(_found(k, len(triangles), search) & ~flat)

    def without_angles(t: int) -> Violation:
        corners = tuple(mesh.triangles[t].tolist())
        message = f"triangle {t} = {triangle_name(mesh.points, corners)} has no area, hence no angles"
        return Violation(property_, Kind.ZERO_AREA, (t,), corners, message)

    def describe(t: int) -> Violation:
        corners = tuple(mesh.triangles[t].tolist())
        name = f"triangle {t} = {triangle_name(mesh.points, corners)}"
        a, b, c = triangles[t].tolist()
        dots = [(_dot(mesh, *turn), turn) for turn in ((a, b, c), (b, c, a), (c, a, b))]
        dot, turn = max(dots) if least else min(dots)
        degrees = _degrees(twice_area(mesh.points, a, b, c), dot)
        kind, size = (Kind.SMALL_ANGLE, "less than") if least else (Kind.LARGE_ANGLE, "more than")
        severity = angle_severity(mesh.points, (a, b, c), bound, least=least)
        corner = point_name(mesh.points, turn[0])
        message = f"{name} has an angle of {degrees:.6g} degrees at {corner}, {size} {bound.degrees:g}"
        if severity is Severity.ROUNDING:
            message += ", rounding-sized"
        return Violation(property_, kind, (t,), corners, message, severity=severity, degrees=degrees)

    ranking = rank_angles(mesh, triangles, culprits, bound, least=least)
    return joined([finding_of(np.flatnonzero(flat), without_angles), finding_of(culprits, describe, ranking)])


def _dot(mesh: Mesh, a: int, b: int, c: int) -> Fraction:
    """Return (b - a) . (c - a)."""
    (ax, ay), (bx, by), (cx, cy) = exact(mesh.points, a), exact(mesh.points, b), exact(mesh.points, c)
    return (bx - ax) * (cx - ax) + (by - ay) * (cy - ay)


def _degrees(cross: Fraction, dot: Fraction) -> float:
    """Return the angle with these products of its sides, to be read."""
    largest = max(abs(cross), abs(dot))
    return math.degrees(math.atan2(float(cross / largest), float(dot / largest)))


def check_areas(mesh: Mesh, triangles: IntArray, limits: FloatArray, property_: Property) -> Finding:
    """MAX_AREA or REGION_AREAS: a violation for each triangle larger than its limit.

    The coordinates that are scaled into the window would ask for limits scaled likewise, which may be no doubles: so
    the triangles are measured as they were given.
    """
    k = make_context(mesh.points)._replace(counts=mesh.context.counts)

    def search(part: slice, found: Flags) -> None:
        find_large(k, limits[part], mesh.points, triangles[part], found)

    def describe(t: int) -> Violation:
        corners = tuple(mesh.triangles[t].tolist())
        magnitude = twice_area(mesh.points, *triangles[t].tolist())
        severity = severity_of(area_terms(mesh.points, triangles[t].tolist(), float(limits[t])), MEASURE_BOUND)
        message = (
            f"triangle {t} = {triangle_name(mesh.points, corners)} has an area of {approximately(magnitude / 2)}, "
            f"more than {float(limits[t]):g}"
        )
        if severity is Severity.ROUNDING:
            message += ", rounding-sized"
        return Violation(property_, Kind.LARGE_AREA, (t,), corners, message, magnitude=magnitude, severity=severity)

    culprits = np.flatnonzero(_found(k, len(triangles), search))
    return finding_of(culprits, describe, rank_areas(mesh.points, k, triangles, culprits, limits))
