"""One pass over the triangles: orientation and widest angle, exactly."""

from typing import NamedTuple

import numpy as np

from exactkernel.context import Context, chunk_size
from exactkernel.diametral import diametral, diametral_adaptive
from exactkernel.jit import jit
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray, Sign, SignArray
from exactmesh.verify.local import Local
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.properties import Kind, Orientation, Property
from exactmesh.verify.report import Finding, Violation
from exactmesh.verify.witness import (
    approximately,
    finding_of,
    point_name,
    scalar_product,
    sign_of,
    triangle_name,
    twice_area,
)

__all__ = ["Shapes", "check_angles", "check_orientation", "classified", "turned"]

CHUNK = 1 << 17  # compiled code cannot be interrupted: Ctrl-C waits for this many triangles at most


class Shapes(NamedTuple):
    """Two signs a triangle, four a quadrilateral.

    Attributes:
        orientation: int8 (m,): orient2d of the corners.
        widest: int8 (m,): the widest angle: -1 below 90 degrees, 0 a right angle, 1 above.
        turns: int8 (k, 4): the turn at each corner of a quadrilateral.
    """

    orientation: SignArray
    widest: SignArray
    turns: SignArray


@jit
def classify(k: Context, points: FloatArray, triangles: IntArray, orientation: SignArray, widest: SignArray) -> None:
    """Fill in the signs. At most one angle of a triangle is 90 degrees or more, so the largest sign is the
    widest's."""
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        ax, ay, bx, by, cx, cy = (
            points[a, 0],
            points[a, 1],
            points[b, 0],
            points[b, 1],
            points[c, 0],
            points[c, 1],
        )
        orientation[t] = orient2d_adaptive(k, ax, ay, bx, by, cx, cy)
        at_a = diametral_adaptive(k, bx, by, cx, cy, ax, ay)
        at_b = diametral_adaptive(k, cx, cy, ax, ay, bx, by)
        at_c = diametral_adaptive(k, ax, ay, bx, by, cx, cy)
        widest[t] = max(at_a, max(at_b, at_c))


def classified(context: Context, local: Local, turns: SignArray) -> Shapes:
    """Return the signs of all triangles, with those of quadrilaterals. O(m)."""
    m = len(local.triangles)
    shapes = Shapes(np.empty(m, dtype=np.int8), np.empty(m, dtype=np.int8), turns)
    step = chunk_size(context, CHUNK)
    for start in range(0, m, step):
        part = slice(start, start + step)
        classify(context, local.points, local.triangles[part], shapes.orientation[part], shapes.widest[part])
        raise_if_interrupted()
    return shapes


def turned(triangles: IntArray, shapes: Shapes) -> IntArray:
    """Return the triangles with the clockwise ones turned round; the same array where there are none."""
    clockwise = shapes.orientation < 0
    if not clockwise.any():
        return triangles
    counterclockwise = triangles.copy()
    counterclockwise[clockwise, 1:] = triangles[clockwise, :0:-1]
    return counterclockwise


def check_orientation(mesh: Mesh, shapes: Shapes, orientation: Orientation) -> Finding:
    """ORIENTATION."""
    signs = shapes.orientation
    wrong = signs == 0 if orientation is Orientation.ANY else signs <= 0

    def describe(t: int) -> Violation:
        corners = tuple(mesh.triangles[t].tolist())
        magnitude = twice_area(mesh.points, *corners)
        if magnitude:
            kind, fault = Kind.CLOCKWISE, f"is clockwise, twice its area is {approximately(magnitude)}"
        else:
            kind, fault = Kind.ZERO_AREA, "has no area"
        message = f"triangle {t} = {triangle_name(mesh.points, corners)} {fault}"
        return Violation(Property.ORIENTATION, kind, (t,), corners, message, sign_of(magnitude), magnitude)

    return finding_of(np.flatnonzero(wrong), describe)


def _widest_last(mesh: Mesh, a: int, b: int, c: int) -> tuple[int, int, int]:
    """Turn the corners so that the angle of 90 degrees or more comes last."""
    at = {v: mesh.coordinates[v].tolist() for v in (a, b, c)}
    turns = ((a, b, c), (b, c, a), (c, a, b))
    return max(turns, key=lambda turn: diametral(*(at[v] for v in turn)))


def check_angles(mesh: Mesh, shapes: Shapes, property_: Property) -> Finding:
    """WEAKLY_ACUTE or ACUTE: a violation for each triangle."""
    limit = Sign.ZERO if property_ is Property.WEAKLY_ACUTE else Sign.NEGATIVE

    def describe(t: int) -> Violation:
        a, b, c = mesh.triangles[t].tolist()
        name = f"triangle {t} = {triangle_name(mesh.points, (a, b, c))}"
        if shapes.orientation[t] == 0:
            return Violation(property_, Kind.ZERO_AREA, (t,), (a, b, c), f"{name} has no area", Sign.ZERO)
        u, v, p = _widest_last(mesh, a, b, c)
        magnitude = scalar_product(mesh.points, u, v, p)
        kind, size = (Kind.OBTUSE_ANGLE, "more than") if magnitude else (Kind.RIGHT_ANGLE, "exactly")
        message = f"{name} has an angle of {size} 90 degrees at {point_name(mesh.points, p)}"
        return Violation(property_, kind, (t,), (a, b, c), message, sign_of(magnitude), magnitude)

    return finding_of(np.flatnonzero((shapes.widest > limit) | (shapes.orientation == 0)), describe)
