"""Pairs of arrays, and objects that have points and triangles."""

from collections.abc import Sequence
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from exactmesh.adapters.given import GivenMesh, Indices, array_of, index_rows, no_pairs, points_of
from exactmesh.errors import AdapterError

__all__ = ["WORDS", "accepts", "convert"]

WORDS = "pairs (points, triangles) and objects with points and triangles"


def accepts(mesh: object) -> bool:
    """Tell whether it has points and cells, or is a tuple of two arrays."""
    return _has_cells(mesh) or (isinstance(mesh, tuple) and len(mesh) == 2 and all(_is_table(part) for part in mesh))


def _has_cells(mesh: object) -> bool:
    return hasattr(mesh, "points") and (hasattr(mesh, "triangles") or hasattr(mesh, "quads"))


def _is_table(part: object) -> bool:
    """Tell whether it has rows, or is empty: two points, as a tuple, are no mesh."""
    if isinstance(part, np.ndarray):
        return part.ndim == 2 or part.size == 0
    return isinstance(part, Sequence) and all(np.iterable(row) for row in part)


def convert(mesh: object) -> GivenMesh:
    """Return the arrays; rows of four indices are quadrilaterals."""
    if not _has_cells(mesh):
        points, cells = cast("tuple[npt.ArrayLike, npt.ArrayLike]", mesh)
        return _of_pair(points, cells)
    found: Any = mesh
    source, triangles, quads = f"a {type(mesh).__name__}", _cells(found, "triangles", 3), _cells(found, "quads", 4)
    corners = np.concatenate([triangles.ravel(), quads.ravel()])
    return GivenMesh(points_of(found.points, corners, source), triangles, quads, source=source)


def _cells(mesh: object, name: str, width: int) -> Indices:
    rows = getattr(mesh, name, None)
    return no_pairs(width) if rows is None else index_rows(rows, width, name)


def _of_pair(points: npt.ArrayLike, cells: npt.ArrayLike) -> GivenMesh:
    rows = array_of(cells, "the second array")
    width = rows.shape[1] if rows.ndim == 2 and rows.size else 3
    if width not in (3, 4):
        raise AdapterError(f"the cells of the pair have {width} corners each; expected 3 or 4")
    found = index_rows(rows, width, "the second array")
    doubles = points_of(points, found, "the pair")
    return GivenMesh(doubles, quads=found) if width == 4 else GivenMesh(doubles, found)
