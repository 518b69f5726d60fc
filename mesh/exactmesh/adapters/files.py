"""Paths: exactmesh's own formats and Triangle's, then all that meshio reads."""

import contextlib
import io
import os
import warnings
from types import ModuleType
from typing import TYPE_CHECKING, cast

from exactmesh.adapters.given import GivenMesh
from exactmesh.adapters.meshio_mesh import convert as converted
from exactmesh.adapters.own import convert as own_converted
from exactmesh.adapters.streams import ByteStream, TextStream
from exactmesh.adapters.tin import require_tin
from exactmesh.errors import ExactMeshError, FileFormatError

if TYPE_CHECKING:
    from meshio import Mesh

__all__ = ["WORDS", "MeshioUnavailableError", "accepts", "convert", "is_own_format", "read_foreign"]

WORDS = "paths of files, ours, Triangle's, or with the extra 'mesh' meshio's"

_OWN = (".node", ".ele", ".poly", ".neigh", ".edge", ".npz", ".csv")


_BINARY_MEDIT = ".meshb"
_WKT = ".wkt"
_MSH = ".msh"  # of Gmsh, where "$" is the first character, and of Ansys
#: The readers of meshio that take open files, and what they expect.
_STREAMS: dict[str, type[TextStream | ByteStream]] = {
    **dict.fromkeys(
        ("abaqus", "avsucd", "medit", "nastran", "netgen", "obj", "off", "permas", "su2", "tecplot"), TextStream
    ),
    **dict.fromkeys(("mdpa", "ply"), ByteStream),
}


class MeshioUnavailableError(ExactMeshError, ImportError):
    """meshio, which reads the formats of other packages, is not installed."""


def accepts(mesh: object) -> bool:
    """Tell whether it is a path."""
    return isinstance(mesh, str | os.PathLike) and isinstance(os.fspath(mesh), str)


def is_own_format(path: str) -> bool:
    """Tell by the suffix whether exactmesh reads the file itself."""
    return os.path.splitext(path)[1] in _OWN


def convert(mesh: object) -> GivenMesh:
    """Return what the file holds."""
    path = os.fspath(cast("str | os.PathLike[str]", mesh))
    if not is_own_format(path):
        return read_foreign(path)
    from exactmesh.io import read_triangles

    content = read_triangles(path)
    if content.triangles is None:
        raise FileFormatError("there are no triangles on file, only points", path=path)
    return own_converted(content)


def read_foreign(path: str) -> GivenMesh:
    """Return what a file holds that meshio reads.

    Raises:
        MeshioUnavailableError: meshio is not installed.
        FileFormatError: no such file, an unknown suffix, or a file that meshio cannot read.
    """
    if not os.path.exists(path):
        raise FileFormatError("no such file", path=path)
    if os.path.splitext(path)[1].lower() == _WKT:
        require_tin(path)
    mesh = _read(path)
    try:
        return converted(mesh)
    except ExactMeshError as error:
        raise FileFormatError(str(error).replace("a meshio Mesh", "the mesh", 1), path=path) from None


def _parsed(meshio: ModuleType, path: str) -> "Mesh":
    """Return what meshio reads: by a stream that ends, if it has one reader for the suffix and that takes streams."""
    suffix = os.path.splitext(path)[1].lower()
    if suffix == _MSH and _begins_with(path, b"$"):
        return cast("Mesh", meshio.read(path, "gmsh"))
    if suffix == _MSH:
        with ByteStream(path) as bytes_:
            return cast("Mesh", meshio.read(bytes_, "ansys"))
    kinds = meshio.extension_to_filetypes.get(suffix, [])
    stream = _STREAMS.get(kinds[0]) if len(kinds) == 1 and suffix != _BINARY_MEDIT else None
    if stream is None:
        return cast("Mesh", meshio.read(path))
    with stream(path) as content:
        return cast("Mesh", meshio.read(content, kinds[0]))


def _begins_with(path: str, words: bytes) -> bool:
    with open(path, "rb") as stream:
        return stream.read(len(words)) == words


def _read(path: str) -> "Mesh":
    """Read silently: meshio prints, warns, and exits where it cannot read."""
    try:
        import meshio
    except ImportError:
        raise MeshioUnavailableError(
            f"{path}: this format needs meshio, which is not installed: pip install 'exactmesh[mesh]'"
        ) from None
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return _parsed(meshio, path)
    except MemoryError:  # a reader takes a header at its word
        raise FileFormatError("meshio asks for more memory than there is to read it", path=path) from None
    except ImportError as error:
        raise FileFormatError(
            f"meshio needs {error.name} for this format: pip install {error.name}", path=path
        ) from None
    except (Exception, SystemExit) as error:  # a broken file may make a reader raise anything
        why = " ".join(said.getvalue().split()) or f"{type(error).__name__}: {error}"
        raise FileFormatError(f"meshio cannot read it: {why}", path=path) from None
