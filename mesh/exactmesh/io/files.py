"""Reading and writing by suffix; Triangle's files are found beside each other."""

import os
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import BinaryIO, TypeAlias

from exactmesh.errors import FileFormatError
from exactmesh.io.atomic import Writer, write_whole
from exactmesh.io.csv import csv_text, read_csv
from exactmesh.io.edge import edge_text, read_edge
from exactmesh.io.ele import ele_text, read_ele
from exactmesh.io.model import Mesh, Triangulated, mesh_of
from exactmesh.io.neigh import neigh_text, read_neigh
from exactmesh.io.node import node_text, read_node
from exactmesh.io.npz import read_npz, write_npz

__all__ = ["PathLike", "read", "read_points", "read_triangles", "write"]

PathLike: TypeAlias = "str | os.PathLike[str]"

_OF_TRIANGLE = (".node", ".ele", ".neigh", ".edge")
_SUFFIXES = (*_OF_TRIANGLE, ".npz", ".csv")


def read(path: PathLike) -> Mesh:
    """Read a mesh with all that is on file; of Triangle's files, any one stands for those with the same stem.

    Linear time; a million points take about a second.

    Args:
        path: ``.node``, ``.ele``, ``.neigh``, ``.edge`` (``.node`` must be there, the others are read where
            present), ``.npz`` or ``.csv``.

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
    """Read points and triangles as :func:`read` does, and leave ``.neigh`` and ``.edge`` alone.

    Raises:
        FileFormatError: as for :func:`read`.
    """
    name, stem, suffix = _parts(path)
    if suffix not in _OF_TRIANGLE:
        return replace(_read_single(name, suffix), neighbors=None, edges=None, edge_markers=None)
    mesh = read_points(path)
    if not os.path.exists(stem + ".ele"):
        return mesh
    triangles, attributes = read_ele(stem + ".ele", len(mesh.points), mesh.base)
    return replace(mesh, triangles=triangles, triangle_attributes=attributes)


def read_points(path: PathLike) -> Mesh:
    """Read the points, with their attributes and markers; beside an ``.ele`` those of its ``.node``.

    Raises:
        FileFormatError: as for :func:`read`.
    """
    name, stem, suffix = _parts(path)
    if suffix not in _OF_TRIANGLE:
        mesh = _read_single(name, suffix)
        return replace(mesh, triangles=None, neighbors=None, edges=None, triangle_attributes=None, edge_markers=None)
    if suffix != ".node" and not os.path.exists(name):
        raise FileFormatError("no such file", path=name)
    return read_node(stem + ".node")


def write(path: PathLike, mesh: Mesh | Triangulated) -> tuple[str, ...]:
    """Write a mesh so that :func:`read` returns it bit for bit, and return the paths that were written.

    A suffix of Triangle's writes ``.node`` and those of ``.ele``, ``.neigh`` and ``.edge`` for which there is
    content, with the base of the mesh (0 for a triangulation). ``.csv`` holds points only. Each file is
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
        if content.triangles is not None or content.edges is not None:
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
    if mesh.neighbors is not None:
        writers[stem + ".neigh"] = _texts(neigh_text, mesh)
    if mesh.edges is not None:
        writers[stem + ".edge"] = _texts(edge_text, mesh)
    return writers


def _texts(text: Callable[[Mesh], Iterator[str]], mesh: Mesh) -> Writer:
    def write_to(stream: BinaryIO) -> None:
        stream.writelines(chunk.encode("ascii") for chunk in text(mesh))

    return write_to
