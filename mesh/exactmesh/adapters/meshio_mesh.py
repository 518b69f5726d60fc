"""meshio.Mesh, and with it every format that meshio reads."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, cast

import numpy as np

from exactmesh.adapters.given import GivenMesh, Indices, index_rows, is_a, no_pairs, planar_points
from exactmesh.errors import AdapterError
from exactmesh.verify.properties import ADMISSIBLE_MESH, Orientation

if TYPE_CHECKING:
    from meshio import Mesh

__all__ = ["WORDS", "accepts", "convert", "given_cells"]

WORDS = "meshio.Mesh"

#: How many corners a cell has, those first; what follows them lies on its sides or inside.
_TRIANGLES = {"triangle": 3, "triangle6": 6, "triangle7": 7}
_QUADS = {"quad": 4, "quad8": 8, "quad9": 9}
_LINES = {"line": 2, "line3": 3}
_PIXEL = [0, 1, 3, 2]  # VTK lists the corners of a pixel row by row


def accepts(mesh: object) -> bool:
    """Tell whether it is a meshio Mesh."""
    return is_a(mesh, "meshio", "Mesh")


def convert(mesh: object) -> GivenMesh:
    """Return triangles and quadrilaterals of all blocks, each kind in its order, and lines as segments.

    Points that no cell uses may be there: gmsh writes the centres of arcs. Labels of cells are left out: the formats do
    not say which of them change across lines only.
    """
    found = cast("Mesh", mesh)
    return given_cells(found.points, ((block.type, block.data) for block in found.cells), "a meshio Mesh")


def given_cells(points: object, blocks: Iterable[tuple[str, object]], source: str) -> GivenMesh:
    """Return the mesh of blocks of cells, named as meshio names them.

    Raises:
        AdapterError: another sort of cells, no cells, or points in space.
    """
    triangles: list[Indices] = []
    quads: list[Indices] = []
    lines: list[Indices] = []
    for kind, rows in blocks:
        if kind in _TRIANGLES:
            triangles.append(index_rows(rows, 3, kind, nodes=_TRIANGLES[kind]))
        elif kind in _QUADS:
            quads.append(index_rows(rows, 4, kind, nodes=_QUADS[kind]))
        elif kind == "pixel":
            quads.append(index_rows(rows, 4, kind)[:, _PIXEL])
        elif kind in _LINES:
            lines.append(index_rows(rows, 2, kind, nodes=_LINES[kind]))
        elif kind == "polygon" and (corners := _columns(rows)) in (3, 4):
            (triangles if corners == 3 else quads).append(index_rows(rows, corners, kind))
        elif kind != "vertex" and _columns(rows) != 0:
            raise AdapterError(f"{source} has cells of type {kind!r}: neither triangles nor quadrilaterals")
    if not triangles and not quads:
        raise AdapterError(f"{source} has no triangles and no quadrilaterals")
    joined = [np.concatenate([no_pairs(width), *rows]) for width, rows in ((3, triangles), (4, quads), (2, lines))]
    used = np.concatenate([joined[0].ravel(), joined[1].ravel()])
    return GivenMesh(
        planar_points(points, used, source),
        joined[0],
        joined[1],
        segments=joined[2] if len(joined[2]) else None,
        orientation=Orientation.ANY,
        claims=ADMISSIBLE_MESH,
        source=source,
    )


def _columns(rows: object) -> int:
    """Return how long the rows are: 0 where there are none, -1 where they are of different lengths, or no rows."""
    try:
        shape = np.shape(cast("Indices", rows))
    except ValueError:
        return -1
    return 0 if 0 in shape else shape[1] if len(shape) == 2 else -1
