"""``.npz``: the arrays of a mesh in numpy's archive, by their names; indices count from 0."""

import io
import math
import tokenize
import warnings
import zipfile
import zlib
from dataclasses import fields
from typing import BinaryIO

import numpy as np
import numpy.typing as npt
from numpy.lib import format as npy

from exactmesh.errors import ExactMeshError, FileFormatError
from exactmesh.io.model import Mesh
from exactmesh.io.text import read_bytes

__all__ = ["read_npz", "write_npz"]

_ARRAYS = tuple(field.name for field in fields(Mesh) if field.name != "base")
_NAMED = 8  # arrays that a message spells out
_DEFLATE_AT_MOST = 1033  # deflate cannot shrink further: a larger claim is a lie
_BROKEN = (
    ValueError,
    TypeError,
    OSError,
    EOFError,
    KeyError,
    IndexError,
    OverflowError,
    RuntimeError,  # encrypted, RecursionError, NotImplementedError: an unknown compression
    MemoryError,  # numpy's header is parsed as Python
    SyntaxError,
    tokenize.TokenError,
    zipfile.BadZipFile,
    zlib.error,
    Warning,
)


def read_npz(path: str) -> Mesh:
    """Return the arrays ``points``, ``triangles``, ... (see :class:`Mesh`) of an archive; others are ignored.

    Pickled objects are refused, and nothing is allocated on the word of a header.

    Raises:
        FileFormatError: no archive, a broken one, one without ``points``, or arrays that are no mesh.
    """
    data = read_bytes(path)
    arrays = {}
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            names = {info.filename.removesuffix(".npy"): info for info in archive.infolist()}
            for name in (*_ARRAYS, "base"):
                if name in names:
                    arrays[name] = _member(archive, names[name])
    except FileFormatError:
        raise
    except _BROKEN as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise FileFormatError(f"is no readable .npz archive: {reason}", path=path) from None
    if "points" not in arrays:
        held = ", ".join(sorted(names)[:_NAMED]) or "nothing"
        expected = "points (n, 2), and what there is of triangles (m, 3), segments (s, 2) and so on"
        raise FileFormatError(f"holds no array named 'points', but {held}; expected are {expected}", path=path)
    base = arrays.pop("base", np.zeros((), dtype=np.int64))
    if base.shape != () or base.dtype.kind not in "iu":
        raise FileFormatError("'base' is not one integer", path=path)
    try:
        return Mesh(arrays.pop("points"), base=int(base), **arrays)
    except ExactMeshError as error:
        raise FileFormatError(str(error), path=path) from None


def _member(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> npt.NDArray[np.generic]:
    if info.file_size > _DEFLATE_AT_MOST * (info.compress_size + 1):
        raise ValueError(f"{info.filename} cannot have the size it claims, {info.file_size} bytes")
    stream = io.BytesIO(archive.read(info))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        version = npy.read_magic(stream)
        if version not in ((1, 0), (2, 0)):
            raise ValueError(f"{info.filename} has the unknown version {version}")
        header = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
        shape, in_columns, dtype = header(stream)
    if dtype.hasobject or dtype.kind not in "fiu":
        raise ValueError(f"{info.filename} has dtype {dtype}, not numbers")
    body = stream.read()
    if any(length < 0 for length in shape) or math.prod(shape) * dtype.itemsize != len(body):
        raise ValueError(f"{info.filename} claims the shape {shape} and holds {len(body)} bytes")
    return np.ndarray(shape, dtype, buffer=body, order="F" if in_columns else "C")


def write_npz(mesh: Mesh, stream: BinaryIO) -> None:
    """Write the arrays that the mesh has; :func:`read_npz` returns them bit for bit."""
    arrays = {name: getattr(mesh, name) for name in _ARRAYS}
    present = {name: array for name, array in arrays.items() if array is not None}
    np.savez(stream, base=np.int64(mesh.base), **present)
