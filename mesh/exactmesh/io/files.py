"""Reading and writing by suffix; Triangle's files are found beside each other."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

from exactmesh.errors import ExactMeshError, FileFormatError, PSLGError
from exactmesh.io.atomic import Writer, text_writer, write_whole
from exactmesh.io.csv import csv_text, read_csv
from exactmesh.io.edge import edge_text, read_edge
from exactmesh.io.ele import ele_text, read_ele
from exactmesh.io.model import Mesh, Triangulated, mesh_of
from exactmesh.io.neigh import neigh_text, read_neigh
from exactmesh.io.node import node_text, read_node
from exactmesh.io.npz import read_npz, write_npz
from exactmesh.io.poly import has_points, mesh_of_pslg, poly_text, pslg_of, read_poly, read_segments, segments_text
from exactmesh.io.text import read_bytes
from exactmesh.pslg import PSLG

if TYPE_CHECKING:
    from exactmesh.refinement.result import Refinement

__all__ = [
    "PathLike",
    "holds_segments",
    "read",
    "read_graph",
    "read_points",
    "read_pslg",
    "read_triangles",
    "write",
    "write_pslg",
]

PathLike: TypeAlias = "str | os.PathLike[str]"

_OF_TRIANGLE = (".node", ".ele", ".poly", ".neigh", ".edge")
_SUFFIXES = (*_OF_TRIANGLE, ".npz", ".csv")
_GEOJSON = (".geojson", ".json")


def read(path: PathLike) -> Mesh:
    """Read a mesh with all that is on file; of Triangle's files, any one stands for those with the same stem.

    Linear time; a million points take about a second.

    Args:
        path: ``.node``, ``.ele``, ``.poly``, ``.neigh``, ``.edge`` (``.node`` must be there, the others are read
            where present), ``.npz`` or ``.csv``. A ``.poly`` file with points of its own belongs to no other file.

    Raises:
        FileFormatError: the file (or the one beside it) is missing, broken or inconsistent; it says where and
            what.

    >>> import tempfile, os
    >>> folder = tempfile.TemporaryDirectory()
    >>> with open(os.path.join(folder.name, "a.node"), "w") as file:
    ...     _ = file.write("3 2 0 0  # three points\\n1 0 0\\n2 1 0\\n3 0 .1\\n")
    >>> mesh = read(os.path.join(folder.name, "a.node"))
    >>> mesh.points.tolist(), mesh.base
    ([[0.0, 0.0], [1.0, 0.0], [0.0, 0.1]], 1)
    >>> folder.cleanup()

    Reference: [Shewchuk 1996]
    """
    name, stem, suffix = _parts(path)
    if suffix not in _OF_TRIANGLE:
        return _read_single(name, suffix)
    if _is_alone(name, suffix):
        return read_poly(name)[0]
    mesh = read_triangles(path)
    if os.path.exists(stem + ".neigh"):
        if mesh.triangles is None:
            raise FileFormatError(f"needs {stem}.ele, which is not there", path=stem + ".neigh")
        mesh = replace(mesh, neighbors=read_neigh(stem + ".neigh", mesh.triangles, mesh.base))
    if os.path.exists(stem + ".edge"):
        edges, markers = read_edge(stem + ".edge", len(mesh.points), mesh.base)
        mesh = replace(mesh, edges=edges, edge_markers=markers)
    return mesh


def read_triangles(path: PathLike) -> Mesh:
    """Read points, triangles and segments as :func:`read` does, and leave ``.neigh`` and ``.edge`` alone.

    Raises:
        FileFormatError: as for :func:`read`.
    """
    name, stem, suffix = _parts(path)
    if suffix not in _OF_TRIANGLE:
        return replace(_read_single(name, suffix), neighbors=None, edges=None, edge_markers=None)
    if _is_alone(name, suffix):
        return read_poly(name)[0]
    mesh = read_points(path)
    if os.path.exists(stem + ".ele"):
        triangles, attributes = read_ele(stem + ".ele", len(mesh.points), mesh.base)
        mesh = replace(mesh, triangles=triangles, triangle_attributes=attributes)
    return read_segments(stem + ".poly", mesh) if os.path.exists(stem + ".poly") else mesh


def read_points(path: PathLike) -> Mesh:
    """Read the points, with their attributes and markers; beside an ``.ele`` those of its ``.node``.

    Raises:
        FileFormatError: as for :func:`read`.
    """
    name, stem, suffix = _parts(path)
    if suffix not in _OF_TRIANGLE:
        return _bare(_read_single(name, suffix))
    if suffix == ".poly":
        return _bare(read_poly(name)[0])
    if suffix != ".node" and not os.path.exists(name):
        raise FileFormatError("no such file", path=name)
    return read_node(stem + ".node")


def _bare(mesh: Mesh) -> Mesh:
    """Return the points alone."""
    attributes, markers = mesh.point_attributes, mesh.point_markers
    return Mesh(mesh.points, point_attributes=attributes, point_markers=markers, base=mesh.base)


def _is_alone(name: str, suffix: str) -> bool:
    """Tell whether this is a .poly file with points of its own, to which no other file belongs."""
    return suffix == ".poly" and has_points(name)


def read_pslg(path: PathLike) -> PSLG:
    """Read a planar straight line graph.

    Args:
        path: ``.poly`` (with its ``.node``, if that has the points), to be carved by seeds; ``.geojson`` or ``.json``,
            to be carved by even-odd; or another file of a mesh, of which points and segments are taken.

    Raises:
        FileFormatError: the file is missing or broken; it says where and what.
        PSLGError: the graph has faults; the message names the file and all of them.

    Linear time, and the check of a PSLG.

    >>> import os, tempfile
    >>> from exactmesh import PSLG
    >>> folder = tempfile.TemporaryDirectory()
    >>> path = os.path.join(folder.name, "a.poly")
    >>> pslg = PSLG([(0, 0), (1, 0), (0, 0.1)], [(0, 1), (1, 2), (2, 0)], segment_markers=[5, 6, 7])
    >>> _ = write_pslg(path, pslg)
    >>> read_pslg(path) == pslg
    True
    >>> folder.cleanup()

    Reference: [Shewchuk 1996]
    """
    return read_graph(path)[0]


def read_graph(path: PathLike) -> tuple[PSLG, int]:
    """Read a PSLG as :func:`read_pslg` does, and return what the indices on file count from besides."""
    name = os.fspath(path)
    if os.path.splitext(name)[1] not in _GEOJSON:
        mesh = read(path)
        return pslg_of(mesh, name), mesh.base
    try:
        return PSLG.from_geojson(read_bytes(name)), 0
    except FileFormatError:
        raise
    except PSLGError as error:
        raise PSLGError(error.faults, path=name) from None
    except ExactMeshError as error:
        raise FileFormatError(str(error), path=name) from None


def holds_segments(path: PathLike) -> bool:
    """Tell whether a file is one of a PSLG, not just of points. FileFormatError if that cannot be told."""
    suffix = os.path.splitext(os.fspath(path))[1]
    return suffix in (".poly", *_GEOJSON) or (suffix == ".npz" and read(path).segments is not None)


def write_pslg(path: PathLike, pslg: PSLG, *, base: int = 0) -> tuple[str, ...]:
    """Write a planar straight line graph so that :func:`read_pslg` returns it bit for bit; return the paths written.

    A ``.poly`` file has no place for the rule: it is read to be carved by seeds. A PSLG without points is written as
    a ``.poly`` and a ``.node`` file, for the first number of a ``.poly`` file cannot say so.

    Args:
        path: ``.poly``, or ``.geojson`` or ``.json`` (see :meth:`exactmesh.PSLG.to_geojson`).
        pslg: what to write.
        base: 0 or 1, what a ``.poly`` file counts from.

    Raises:
        FileFormatError: an unknown suffix.
        GeometryError: GeoJSON cannot hold the PSLG.
        OSError: the folder is missing, the disk full, and so on.
    """
    name = os.fspath(path)
    stem, suffix = os.path.splitext(name)
    writers: dict[str, Writer]
    if suffix in _GEOJSON:
        text = pslg.to_geojson()
        writers = {name: _texts(lambda _: iter((text, "\n")), Mesh(()))}
    elif suffix == ".poly":
        mesh = mesh_of_pslg(pslg, base)
        writers = {name: _texts(poly_text, mesh)}
        if not len(mesh.points):
            writers[stem + ".node"] = _texts(node_text, mesh)
    else:
        known = ", ".join((".poly", *_GEOJSON))
        raise FileFormatError(f"has the suffix {suffix!r}; a PSLG goes into {known}", path=name)
    write_whole(writers)
    return tuple(writers)


def write(path: PathLike, mesh: Mesh | Triangulated | Refinement) -> tuple[str, ...]:
    """Write a mesh so that :func:`read` returns it bit for bit, and return the paths that were written.

    A suffix of Triangle's writes ``.node`` and those of ``.ele``, ``.poly``, ``.neigh`` and ``.edge`` for which there
    is content, with the base of the mesh (0 for a triangulation). ``.csv`` holds points only. Each file is
    complete before it takes its place: an error or an interrupt leaves what was there. Linear time.

    Raises:
        FileFormatError: an unknown suffix, or a suffix that cannot hold the mesh.
        OSError: the folder is missing, the disk full, and so on.

    >>> import os, tempfile
    >>> from exactmesh import delaunay
    >>> folder = tempfile.TemporaryDirectory()
    >>> paths = write(os.path.join(folder.name, "a.node"), delaunay([(0, 0), (1, 0), (0, 0.1)]))
    >>> [os.path.basename(path) for path in paths]
    ['a.node', 'a.ele', 'a.neigh', 'a.edge']
    >>> read(paths[1]).points.tolist()
    [[0.0, 0.0], [1.0, 0.0], [0.0, 0.1]]
    >>> folder.cleanup()

    Reference: [Shewchuk 1996]
    """
    name, stem, suffix = _parts(path)
    content = mesh_of(mesh)
    writers: dict[str, Writer]
    if suffix == ".npz":
        writers = {name: lambda stream: write_npz(content, stream)}
    elif suffix == ".csv":
        if any(array is not None for array in (content.triangles, content.edges, content.segments)):
            raise FileFormatError("a .csv file holds points only; write .node and .ele, or .npz", path=name)
        writers = {name: _texts(csv_text, content)}
    else:
        writers = _of_triangle(stem, content)
        if stem + suffix not in writers:
            raise FileFormatError(f"the mesh has nothing to write into a {suffix} file", path=name)
    write_whole(writers)
    return tuple(writers)


def _parts(path: PathLike) -> tuple[str, str, str]:
    """Return the path, the path without its suffix, and the suffix, one that is known."""
    name = os.fspath(path)
    stem, suffix = os.path.splitext(name)
    if suffix not in _SUFFIXES:
        raise FileFormatError(f"has the unknown suffix {suffix!r}; known are {', '.join(_SUFFIXES)}", path=name)
    return name, stem, suffix


def _read_single(name: str, suffix: str) -> Mesh:
    return read_npz(name) if suffix == ".npz" else read_csv(name)


def _of_triangle(stem: str, mesh: Mesh) -> dict[str, Writer]:
    writers = {stem + ".node": _texts(node_text, mesh)}
    if mesh.triangles is not None:
        writers[stem + ".ele"] = _texts(ele_text, mesh)
    if mesh.segments is not None:
        writers[stem + ".poly"] = _texts(segments_text, mesh)
    if mesh.neighbors is not None:
        writers[stem + ".neigh"] = _texts(neigh_text, mesh)
    if mesh.edges is not None:
        writers[stem + ".edge"] = _texts(edge_text, mesh)
    return writers


def _texts(text: Callable[[Mesh], Iterator[str]], mesh: Mesh) -> Writer:
    return text_writer(lambda: text(mesh))
