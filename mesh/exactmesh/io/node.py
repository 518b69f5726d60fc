"""``.node``: the points, with attributes and markers."""

from collections.abc import Iterator

import numpy as np

from exactmesh.io.model import Mesh
from exactmesh.io.text import Table, TextFile, rows_of_text

__all__ = ["node_header", "node_rows", "node_text", "points_of", "read_node"]


def read_node(path: str | TextFile) -> Mesh:
    """Return the points of a ``.node`` file; ``base`` is the number of its first point.

    Header ``N 2 attributes has_markers`` (missing fields: 2, 0, 0), then N rows ``i x y attributes...
    [marker]``. Decimals are rounded to the nearest double, as a reader of text must. Linear time.

    Raises:
        FileFormatError: where and what.
    """
    file = TextFile.of(path)
    count, attributes, markers = node_header(file)
    return points_of(file, file.table(node_rows(file, count, attributes, markers), count), markers)


def node_header(file: TextFile) -> tuple[int, int, int]:
    """Return the header's numbers of points, attributes and markers."""
    names = ("number of points", "dimension", "number of attributes", "number of markers")
    count, dimension, attributes, markers = file.header(names, (0, 2, 0, 0))
    if dimension != 2:
        raise file.fault(f"dimension {dimension}; only points of the plane (2) can be read", line=file.line_of(-1))
    if markers > 1:
        raise file.fault(f"{markers} markers a point; there can be 0 or 1", line=file.line_of(-1))
    return count, attributes, markers


def node_rows(file: TextFile, count: int, attributes: int, markers: int) -> np.dtype[np.void]:
    """Return the type of the rows that the header announces."""
    return file.row_type(count, "point", reals=2, attributes=attributes, markers=markers)


def points_of(file: TextFile, rows: Table, markers: int) -> Mesh:
    """Return the points of a table, whose numbers begin with 0 or 1."""
    base = int(rows["number"][0]) if len(rows) else 0
    if base not in (0, 1):
        raise file.fault(f"the first point has number {base}; expected 0 or 1", line=file.line_of(0))
    file.numbered(rows["number"], base, "point")
    return Mesh(
        rows["reals"],
        point_attributes=rows["attributes"],
        point_markers=rows["marker"] if markers else None,
        base=base,
    )


def node_text(mesh: Mesh) -> Iterator[str]:
    """Yield the text of a ``.node`` file that :func:`read_node` reads back bit for bit."""
    n = len(mesh.points)
    attributes = 0 if mesh.point_attributes is None else mesh.point_attributes.shape[1]
    yield f"{n} 2 {attributes} {int(mesh.point_markers is not None)}\n"
    columns = [np.arange(mesh.base, mesh.base + n), mesh.points, mesh.point_attributes, mesh.point_markers]
    yield from rows_of_text(column for column in columns if column is not None)
