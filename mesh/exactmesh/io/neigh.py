"""``.neigh``: the triangle on the other side of each edge."""

from collections.abc import Iterator

import numpy as np

from exactkernel.types import IntArray
from exactmesh.io.model import Mesh
from exactmesh.io.text import TextFile, rows_of_text

__all__ = ["neigh_text", "read_neigh"]

_SIDES = 3


def read_neigh(path: str, triangles: IntArray, base: int) -> IntArray:
    """Return the neighbours (m, 3), counted from 0, opposite the corners of the given triangles; -1 outside.

    Header ``N 3``, then N rows ``i n1 n2 n3``. Linear time.

    Raises:
        FileFormatError: where and what; also when a neighbour lacks the edge, so that the file is another
            mesh's.
    """
    file = TextFile.load(path)
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
    _refuse_strangers(file, triangles, neighbors, base)
    return neighbors


def _refuse_strangers(file: TextFile, triangles: IntArray, neighbors: IntArray, base: int) -> None:
    for side in range(_SIDES):
        rows = np.flatnonzero(neighbors[:, side] >= 0)
        theirs = triangles[neighbors[rows, side]]
        shared = np.ones(len(rows), dtype=np.bool_)
        for corner in (triangles[rows, (side + 1) % 3], triangles[rows, (side + 2) % 3]):
            shared &= (theirs == corner[:, None]).any(axis=1)
        if not shared.all():
            row = int(rows[np.flatnonzero(~shared)[0]])
            raise file.fault(
                f"triangles {base + row} and {base + neighbors[row, side]} have no edge in common there: "
                "the .ele file is of another mesh",
                line=file.line_of(row),
            )


def neigh_text(mesh: Mesh) -> Iterator[str]:
    """Yield the text of a ``.neigh`` file that :func:`read_neigh` reads back."""
    neighbors = np.zeros((0, _SIDES), dtype=np.int32) if mesh.neighbors is None else mesh.neighbors
    m = len(neighbors)
    yield f"{m} {_SIDES}\n"
    shifted = np.where(neighbors < 0, -1, neighbors + np.int64(mesh.base))
    yield from rows_of_text([np.arange(mesh.base, mesh.base + m), shifted])
