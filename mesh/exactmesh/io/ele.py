"""``.ele``: the triangles, with attributes."""

from collections.abc import Iterator

import numpy as np

from exactkernel.types import FloatArray, IntArray
from exactmesh.io.model import Mesh
from exactmesh.io.text import TextFile, rows_of_text

__all__ = ["ele_text", "elements_text", "read_ele", "read_elements"]

_CORNERS = 3


def read_ele(path: str | TextFile, points: int, base: int) -> tuple[IntArray, FloatArray]:
    """Return the corners (m, 3), counted from 0, and attributes (m, b) of a ``.ele`` file; see :func:`read_elements`.

    Of six-node elements the corners are kept; the midpoints remain as points.
    """
    nodes, attributes = read_elements(path, points, base)
    return np.ascontiguousarray(nodes[:, :_CORNERS]), attributes


def read_elements(path: str | TextFile, points: int, base: int) -> tuple[IntArray, FloatArray]:
    """Return the nodes (m, 3) or (m, 6), counted from 0, and attributes (m, b) of a ``.ele`` file.

    Header ``N nodes_per_triangle attributes`` (missing fields: 3, 0), then N rows ``i n1 n2 n3 ...
    attributes...``; nodes 4 to 6 are the midpoints opposite to corners 1 to 3. Linear time.

    Raises:
        FileFormatError: where and what.
    """
    file = TextFile.of(path)
    names = ("number of triangles", "number of nodes per triangle", "number of attributes")
    count, nodes, attributes = file.header(names, (0, _CORNERS, 0))
    if nodes not in (_CORNERS, 2 * _CORNERS):
        raise file.fault(f"{nodes} nodes per triangle; expected 3 or 6", line=file.line_of(-1))
    rows = file.table(file.row_type(count, "triangle", integers=nodes, attributes=attributes), count)
    file.numbered(rows["number"], base, "triangle")
    file.in_range(rows["integers"], base, base + points - 1, "point")
    return (rows["integers"] - base).astype(np.int32), rows["attributes"]


def ele_text(mesh: Mesh) -> Iterator[str]:
    """Yield the text of a ``.ele`` file that :func:`read_ele` reads back."""
    triangles = np.zeros((0, _CORNERS), dtype=np.int32) if mesh.triangles is None else mesh.triangles
    yield from elements_text(triangles, mesh.triangle_attributes, mesh.base)


def elements_text(nodes: IntArray, attributes: FloatArray | None, base: int) -> Iterator[str]:
    """Yield the text of a ``.ele`` file of elements with three or six nodes (m, 3 or 6), counted from 0."""
    m, width = nodes.shape
    yield f"{m} {width} {0 if attributes is None else attributes.shape[1]}\n"
    columns = [np.arange(base, base + m), nodes + np.int64(base), attributes]
    yield from rows_of_text(column for column in columns if column is not None)
