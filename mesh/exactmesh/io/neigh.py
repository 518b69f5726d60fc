"""``.neigh``: the triangle on the other side of each edge."""

from collections.abc import Iterator

import numpy as np

from exactkernel.types import IntArray
from exactmesh.connectivity import check_neighbors
from exactmesh.errors import TopologyError
from exactmesh.io.model import Mesh
from exactmesh.io.text import TextFile, rows_of_text

__all__ = ["neigh_text", "read_neigh"]

_SIDES = 3


def read_neigh(path: str | TextFile, triangles: IntArray, base: int) -> IntArray:
    """Return the neighbours (m, 3), counted from 0, opposite the corners of the given triangles; -1 outside.

    Header ``N 3``, then N rows ``i n1 n2 n3``. Linear time.

    Raises:
        FileFormatError: where and what; also when neighbours are not mutual across their edge, or one is missing.
    """
    file = TextFile.of(path)
    count, sides = file.header(("number of triangles", "number of neighbours per triangle"), (0, _SIDES))
    if sides != _SIDES:
        raise file.fault(f"{sides} neighbours per triangle; expected 3", line=file.line_of(-1))
    if count != len(triangles):
        raise file.fault(f"{count} triangles, the .ele file has {len(triangles)}", line=file.line_of(-1))
    rows = file.table(file.row_type(count, "triangle", integers=_SIDES), count)
    file.numbered(rows["number"], base, "triangle")
    numbers = rows["integers"]
    outside = numbers == -1
    file.in_range(np.where(outside, base, numbers), base, base + count - 1, "triangle")
    neighbors = np.where(outside, -1, numbers - base).astype(np.int32)
    try:
        check_neighbors(triangles, neighbors)
    except TopologyError as error:
        row = error.indices[0]
        other = _unconfirmed(triangles, neighbors, row)
        message = f"triangles {base + row} and {base + other} are not each other's neighbours across one edge"
        raise file.fault(f"{message}: a broken file, or that of another mesh", line=file.line_of(row)) from None
    _refuse_missing(file, triangles, neighbors, base)
    return neighbors


def _unconfirmed(triangles: IntArray, neighbors: IntArray, row: int) -> int:
    """Return the first neighbour of a triangle that does not have it as its own across the edge between them."""
    for side in range(_SIDES):
        other = int(neighbors[row, side])
        edge = [triangles[row, (side + 2) % 3], triangles[row, (side + 1) % 3]]
        theirs = [k for k in range(_SIDES) if [triangles[other, (k + 1) % 3], triangles[other, (k + 2) % 3]] == edge]
        if other >= 0 and not any(neighbors[other, k] == row for k in theirs):
            return other
    raise AssertionError("check_neighbors found one")  # pragma: no cover


def _refuse_missing(file: TextFile, triangles: IntArray, neighbors: IntArray, base: int) -> None:
    """Refuse two triangles on the two sides of an edge, where each is said to have nobody there."""
    rows, corners = np.nonzero(neighbors < 0)
    start, end = (
        triangles[rows, (corners + 1) % 3].astype(np.int64),
        triangles[rows, (corners + 2) % 3].astype(np.int64),
    )
    both = np.flatnonzero(np.isin(start << 32 | end, end << 32 | start))
    if both.size:
        row, side = int(rows[both[0]]), int(corners[both[0]])
        message = f"triangle {base + row} has a neighbour opposite its corner {side + 1} that is not listed"
        raise file.fault(message, line=file.line_of(row))


def neigh_text(mesh: Mesh) -> Iterator[str]:
    """Yield the text of a ``.neigh`` file that :func:`read_neigh` reads back."""
    neighbors = np.zeros((0, _SIDES), dtype=np.int32) if mesh.neighbors is None else mesh.neighbors
    m = len(neighbors)
    yield f"{m} {_SIDES}\n"
    shifted = np.where(neighbors < 0, -1, neighbors + np.int64(mesh.base))
    yield from rows_of_text([np.arange(mesh.base, mesh.base + m), shifted])
