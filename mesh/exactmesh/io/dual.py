"""``.v.node`` and ``.v.edge``: the Voronoi diagram, edge by edge the dual of the triangulation."""

import os
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from exactkernel.errors import NonFiniteError
from exactkernel.types import FloatArray, IntArray
from exactmesh.errors import FileFormatError
from exactmesh.io.atomic import Writer, text_writer, write_whole
from exactmesh.io.text import rows_of_text

if TYPE_CHECKING:
    from exactmesh.triangulation import Triangulation
    from exactmesh.voronoi import Voronoi

__all__ = ["v_edge_text", "v_node_text", "voronoi_writers", "write_voronoi"]


def v_node_text(centres: FloatArray, base: int) -> Iterator[str]:
    """Yield the text of a ``.v.node`` file: the circumcentres (m, 2), in the order of the triangles."""
    yield f"{len(centres)} 2 0 0\n"
    yield from rows_of_text([np.arange(base, base + len(centres)), centres])


def v_edge_text(edges: IntArray, directions: FloatArray, base: int) -> Iterator[str]:
    """Yield the text of a ``.v.edge`` file: rows ``i p q``, and ``i p -1 dx dy`` for rays.

    Args:
        edges: (k, 2), circumcentres, counted from 0; the second is -1 for a ray.
        directions: (k, 2), where the rays go.
        base: 0 or 1, what the file counts from.
    """
    yield f"{len(edges)} 0\n"
    rays = edges[:, 1] < 0
    turns = np.flatnonzero(np.diff(rays, prepend=~rays[:1])) if len(rays) else np.zeros(0, dtype=np.int64)
    for first, stop in zip(turns.tolist(), [*turns[1:].tolist(), len(edges)], strict=True):
        numbers, rows = np.arange(base + first, base + stop), edges[first:stop] + np.int64(base)
        if rays[first]:
            ends = np.full(stop - first, -1)
            yield from rows_of_text([numbers, rows[:, 0], ends, directions[first:stop]])
        else:
            yield from rows_of_text([numbers, rows])


def voronoi_writers(stem: str, mesh: "Triangulation", base: int) -> dict[str, Writer]:
    """Return what writes ``stem.v.node`` and ``stem.v.edge`` of a Delaunay triangulation.

    Raises:
        NonFiniteError: a circumcentre is beyond the largest double, and no file can hold it.
    """
    from exactmesh.voronoi import circumcentres, dual_edges

    centres = circumcentres(mesh)
    bad = np.flatnonzero(~np.isfinite(centres).all(axis=1))
    if bad.size:
        message = f"the circumcentre of triangle {bad[0] + base} is beyond the largest double"
        raise NonFiniteError(message, indices=bad.tolist())
    edges, directions = dual_edges(mesh)
    return {
        stem + ".v.node": text_writer(lambda: v_node_text(centres, base)),
        stem + ".v.edge": text_writer(lambda: v_edge_text(edges, directions, base)),
    }


def write_voronoi(path: "str | os.PathLike[str]", mesh: "Triangulation | Voronoi", *, base: int = 0) -> tuple[str, ...]:
    """Write the Voronoi diagram of a Delaunay triangulation as Triangle does; return the paths written.

    Row j of ``.v.node`` is the circumcentre of triangle j; row i of ``.v.edge`` is dual to ``mesh.edges[i]``.

    Args:
        path: ``x.v.node`` or ``x.v.edge``: both are written.
        mesh: the triangulation, or the diagram that :func:`exactmesh.voronoi` made of it.
        base: 0 or 1, what the files count from.

    Raises:
        FileFormatError: another suffix; sites on one line, which have no triangulation.
        NonFiniteError: a circumcentre is beyond the largest double.
        OSError: the folder is missing, the disk full, and so on.

    >>> import os, pathlib, tempfile
    >>> from exactmesh import delaunay
    >>> folder = tempfile.TemporaryDirectory()
    >>> paths = write_voronoi(os.path.join(folder.name, "a.v.node"), delaunay([(0, 0), (2, 0), (0, 3)]))
    >>> print(pathlib.Path(paths[1]).read_text(), end="")
    3 0
    0 0 -1 3.0 2.0
    1 0 -1 -3.0 0.0
    2 0 -1 0.0 -2.0
    >>> folder.cleanup()
    """
    from exactmesh.voronoi import Voronoi

    name = os.fspath(path)
    stem = next((name[: -len(suffix)] for suffix in (".v.node", ".v.edge") if name.endswith(suffix)), None)
    if stem is None:
        raise FileFormatError("a Voronoi diagram goes into .v.node and .v.edge", path=name)
    triangulation = mesh.triangulation if isinstance(mesh, Voronoi) else mesh
    if triangulation is None:
        raise FileFormatError("the sites lie on one line: there is no circumcentre to write", path=name)
    writers = voronoi_writers(stem, triangulation, base)
    write_whole(writers)
    return tuple(writers)
