"""Triangle's files as dictionaries, from a folder or from strings."""

import os
from collections.abc import Mapping
from typing import cast

import numpy as np
import numpy.typing as npt

from exactmesh.errors import FileFormatError
from exactmesh.io.area import read_area
from exactmesh.io.edge import read_edge
from exactmesh.io.ele import read_elements
from exactmesh.io.model import Mesh
from exactmesh.io.neigh import read_neigh
from exactmesh.io.node import node_header, read_node
from exactmesh.io.poly import read_poly, read_segments
from exactmesh.io.text import TextFile
from exactmesh.triangle.dictionary import KEYS, TriangleDict, column

__all__ = ["load", "loads"]

_KINDS = ("node", "ele", "poly", "area", "edge", "neigh")


def load(directory: "str | os.PathLike[str]", name: str) -> TriangleDict:
    """Return what Triangle's files ``name.node``, ``.ele``, ``.poly``, ``.area``, ``.edge`` and ``.neigh`` hold.

    Those that are not there are left out.

    Raises:
        FileFormatError: there is none, or one is broken; it says where and what.

    >>> import os, tempfile
    >>> from exactmesh import triangle
    >>> folder = tempfile.TemporaryDirectory()
    >>> with open(os.path.join(folder.name, "a.node"), "w") as file:
    ...     _ = file.write("3 2 0 0\\n1 0 0\\n2 1 0\\n3 0 1\\n")
    >>> triangle.load(folder.name, "a")["vertices"].tolist()
    [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]
    >>> folder.cleanup()
    """
    stem = os.path.join(os.fspath(directory), name)
    files = {kind: TextFile.load(f"{stem}.{kind}") for kind in _KINDS if os.path.exists(f"{stem}.{kind}")}
    if not files:
        base, _, kind = name.rpartition(".")
        remedy = f": give the name without suffix, {base!r}" if base and kind in _KINDS else ""
        raise FileFormatError(f"no such file, nor another of {', '.join(_KINDS)}{remedy}", path=f"{stem}.node")
    return _dictionary(files)


def loads(
    node: str | None = None,
    ele: str | None = None,
    poly: str | None = None,
    area: str | None = None,
    edge: str | None = None,
    neigh: str | None = None,
) -> TriangleDict:
    """Return what the texts of Triangle's files hold; indices count from 0, whatever the texts count from.

    Raises:
        FileFormatError: one is broken, or needs another that is not there; it says where and what.

    >>> from exactmesh import triangle
    >>> found = triangle.loads(node="3 2 0 0\\n1 0 0\\n2 1 0\\n3 0 1\\n", ele="1 3 0\\n1 1 2 3\\n")
    >>> found["triangles"].tolist()
    [[0, 1, 2]]
    """
    texts = {"node": node, "ele": ele, "poly": poly, "area": area, "edge": edge, "neigh": neigh}
    return _dictionary({kind: TextFile.from_text(text, kind) for kind, text in texts.items() if text is not None})


def _dictionary(files: Mapping[str, TextFile]) -> TriangleDict:
    """Return the content of files, by kind."""
    mesh = _points(files)
    n, base = len(mesh.points), mesh.base
    found: dict[str, npt.NDArray[np.generic] | None] = {
        "vertices": mesh.points,
        "vertex_attributes": mesh.point_attributes,
        "vertex_markers": mesh.point_markers,
        "segments": mesh.segments,
        "segment_markers": mesh.segment_markers,
        "holes": mesh.holes,
        "regions": mesh.regions,
    }
    if "ele" in files:
        triangles, attributes = read_elements(files["ele"], n, base)
        found |= {"triangles": triangles, "triangle_attributes": attributes}
        if "neigh" in files:
            found["neighbors"] = read_neigh(files["neigh"], triangles[:, :3], base)
    elif "neigh" in files:
        raise files["neigh"].fault("needs the triangles of an .ele file")
    if "edge" in files:
        found["edges"], found["edge_markers"] = read_edge(files["edge"], n, base)
    if "area" in files:
        found["triangle_max_area"] = read_area(files["area"])
    return _typed(found)


def _points(files: Mapping[str, TextFile]) -> Mesh:
    """Return the points, and the segments if there are some."""
    poly = files.get("poly")
    if poly is not None and node_header(poly)[0] > 0:
        return read_poly(poly)[0]
    if "node" in files:
        nodes = read_node(files["node"])
        return nodes if poly is None else read_segments(poly, nodes)
    for file in files.values():
        raise file.fault("needs the points of a .node file")
    return Mesh(())


def _typed(found: Mapping[str, npt.NDArray[np.generic] | None]) -> TriangleDict:
    """Return new arrays as the ``triangle`` package has them: markers (k, 1) of 32 bits."""
    result: dict[str, npt.NDArray[np.generic]] = {}
    for key in KEYS:
        array = found.get(key)
        if array is None or array.size == 0:
            continue
        if key.endswith("_markers"):
            array = column(array, key)
        result[key] = (array.reshape(-1, 1) if array.ndim == 1 else array).astype(_type_of(array))
    return cast(TriangleDict, result)


def _type_of(array: npt.NDArray[np.generic]) -> type[np.float64] | type[np.int32]:
    return np.float64 if array.dtype.kind == "f" else np.int32
