"""Triangles and quadrilaterals together: their turns, turned round, those with an area.

A quadrilateral with four left turns is strictly convex and counterclockwise: each turn is by less than 180 degrees, so
that all four make one full turn, not two. With three left turns it is still simple and counterclockwise: the sums of
opposite turns' determinants are both twice its area, so the fourth corner lies strictly inside the triangle of the
others (a right turn), or inside a side of it. With fewer left and fewer right turns its sides cross, overlap, or all
lie on a line.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exactkernel.context import Context, chunk_size
from exactkernel.jit import jit
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray, SignArray
from exactmesh.verify.local import Local
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.properties import Kind, Orientation, Property
from exactmesh.verify.report import Finding, Violation
from exactmesh.verify.triangles import CHUNK, Shapes, turned
from exactmesh.verify.witness import approximately, finding_of, point_name, sign_of, triangle_name, twice_area

__all__ = [
    "Cells",
    "check_convex",
    "check_quad_orientation",
    "is_convex",
    "orientation_of_quads",
    "proper_cells",
    "turns_of",
    "upright_cells",
]

Mask = npt.NDArray[np.bool_]

_TURNED = [0, 3, 2, 1]


class Cells(NamedTuple):
    """Triangles (m, 3) and quadrilaterals (k, 4); rows of cells count triangles first."""

    triangles: IntArray
    quads: IntArray

    def are(self, others: "Cells") -> bool:
        """Tell whether these are the same arrays."""
        return self.triangles is others.triangles and self.quads is others.quads


@jit
def classify_turns(k: Context, points: FloatArray, quads: IntArray, turns: SignArray) -> None:
    """Fill in the sign of the turn at each corner."""
    for q in range(len(quads)):
        for i in range(4):
            a, b, c = quads[q, (i + 3) & 3], quads[q, i], quads[q, (i + 1) & 3]
            turns[q, i] = orient2d_adaptive(
                k, points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1]
            )


def turns_of(context: Context, local: Local) -> SignArray:
    """Return int8 (k, 4): the sign of the turn at each corner of each quadrilateral. O(k)."""
    turns = np.empty(local.quads.shape, dtype=np.int8)
    step = chunk_size(context, CHUNK)
    for start in range(0, len(turns), step):
        part = slice(start, start + step)
        classify_turns(context, local.points, local.quads[part], turns[part])
        raise_if_interrupted()
    return turns


def orientation_of_quads(turns: SignArray) -> SignArray:
    """Return int8 (k,): 1 counterclockwise, -1 clockwise, 0 where the sides are not those of a simple polygon."""
    left, right = (turns > 0).sum(axis=1) >= 3, (turns < 0).sum(axis=1) >= 3
    found: SignArray = left.astype(np.int8) - right.astype(np.int8)
    return found


def is_convex(turns: SignArray) -> Mask:
    """Tell which quadrilaterals are strictly convex."""
    found: Mask = np.abs(turns.sum(axis=1, dtype=np.int8)) == 4
    return found


def upright_cells(mesh: Mesh, shapes: Shapes) -> Cells:
    """Return the cells with the clockwise ones turned round; the same arrays where there are none."""
    clockwise = orientation_of_quads(shapes.turns) < 0
    quads = mesh.quads
    if clockwise.any():
        quads = quads.copy()
        quads[clockwise] = quads[clockwise][:, _TURNED]
    return Cells(turned(mesh.triangles, shapes), quads)


def proper_cells(cells: Cells, shapes: Shapes) -> Cells:
    """Return the triangles with an area and the strictly convex quadrilaterals; the same arrays if these are all."""
    flat, bent = shapes.orientation == 0, ~is_convex(shapes.turns)
    triangles = cells.triangles[~flat] if flat.any() else cells.triangles
    return Cells(triangles, cells.quads[~bent] if bent.any() else cells.quads)


def quad_name(mesh: Mesh, row: int) -> str:
    """Return the cell's number and its corners with their coordinates."""
    return f"cell {row}, the quadrilateral {triangle_name(mesh.points, mesh.corners(row))},"


def describe_quad(mesh: Mesh, shapes: Shapes, row: int, property_: Property) -> Violation:
    """Say what a quadrilateral is instead of strictly convex; if it is that: it is clockwise."""
    corners, turns = mesh.corners(row), shapes.turns[row - len(mesh.triangles)]
    name, round_ = quad_name(mesh, row), int(np.sign(turns.sum(dtype=np.int64)))
    if not turns.any():
        return Violation(property_, Kind.ZERO_AREA, (row,), corners, f"{name} has no area")
    if not orientation_of_quads(turns[None])[0]:
        message = f"{name} is no simple polygon: its sides cross or overlap"
        return Violation(property_, Kind.NOT_SIMPLE, (row,), corners, message)
    odd = np.flatnonzero(turns != round_)
    if property_ is Property.ORIENTATION or not odd.size:
        area = twice_area(mesh.points, *corners[:3]) + twice_area(mesh.points, corners[0], *corners[2:])
        message = f"{name} is clockwise, twice its area is {approximately(area)}"
        return Violation(property_, Kind.CLOCKWISE, (row,), corners, message, sign_of(area), area)
    i = int(odd[0])
    magnitude = twice_area(mesh.points, corners[i - 1], corners[i], corners[(i + 1) % 4])
    kind, fault = (Kind.REFLEX_CORNER, "reflex") if magnitude else (Kind.STRAIGHT_CORNER, "straight")
    message = f"{name} is not strictly convex: its corner {point_name(mesh.points, corners[i])} is {fault}"
    return Violation(property_, kind, (row,), corners, message, sign_of(magnitude), magnitude)


def check_convex(mesh: Mesh, shapes: Shapes, property_: Property = Property.CONVEX) -> Finding:
    """CONVEX, or what ADMISSIBLE asks of each quadrilateral."""
    rows = len(mesh.triangles) + np.flatnonzero(~is_convex(shapes.turns))
    return finding_of(rows, lambda row: describe_quad(mesh, shapes, row, property_))


def check_quad_orientation(mesh: Mesh, shapes: Shapes, orientation: Orientation) -> Finding:
    """ORIENTATION of quadrilaterals."""
    signs = orientation_of_quads(shapes.turns)
    wrong = signs == 0 if orientation is Orientation.ANY else signs <= 0
    rows = len(mesh.triangles) + np.flatnonzero(wrong)
    return finding_of(rows, lambda row: describe_quad(mesh, shapes, row, Property.ORIENTATION))
