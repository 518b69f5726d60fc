"""``.edge``: the edges, with markers."""

from collections.abc import Iterator

import numpy as np

from exactkernel.types import IntArray
from exactmesh.io.model import MarkerArray, Mesh
from exactmesh.io.text import TextFile, rows_of_text

__all__ = ["edge_text", "read_edge"]


def read_edge(path: str | TextFile, points: int, base: int) -> tuple[IntArray, MarkerArray | None]:
    """Return the end points (k, 2), counted from 0, and the markers (k,) of a ``.edge`` file.

    Header ``E has_markers`` (missing: 0), then E rows ``i a b [marker]``. Linear time.

    Raises:
        FileFormatError: where and what; the rays of a ``.v.edge`` file are no edges.
    """
    file = TextFile.of(path)
    count, markers = file.header(("number of edges", "number of markers"), (0, 0))
    if markers > 1:
        raise file.fault(f"{markers} markers an edge; there can be 0 or 1", line=file.line_of(-1))
    rows = file.table(file.row_type(count, "edge", integers=2, markers=markers), count)
    file.numbered(rows["number"], base, "edge")
    file.in_range(rows["integers"], base, base + points - 1, "point")
    return (rows["integers"] - base).astype(np.int32), rows["marker"] if markers else None


def edge_text(mesh: Mesh) -> Iterator[str]:
    """Yield the text of a ``.edge`` file that :func:`read_edge` reads back."""
    edges = np.zeros((0, 2), dtype=np.int32) if mesh.edges is None else mesh.edges
    k = len(edges)
    yield f"{k} {int(mesh.edge_markers is not None)}\n"
    columns = [np.arange(mesh.base, mesh.base + k), edges + np.int64(mesh.base), mesh.edge_markers]
    yield from rows_of_text(column for column in columns if column is not None)
