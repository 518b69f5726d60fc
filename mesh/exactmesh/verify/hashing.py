"""Names of arrays that do not change with the machine: SHA-256 of their canonical bytes.

All numbers are little-endian, 64 bits each. First comes a line of ASCII that says what follows, then for each array the
numbers of its rows and columns, then its rows. Coordinates and other reals are IEEE doubles, -0.0 as 0.0 and every NaN
as 0x7ff8000000000000; indices are integers, after the line "unsigned" where one of them is 2^63 or more. The order of
the rows matters, and so does that of the corners of a cell.
"""

import hashlib
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray

if TYPE_CHECKING:
    from exactmesh.verify.domain import Outline

__all__ = ["array_sha256", "domain_sha256", "mesh_sha256"]

Integers = npt.NDArray[np.integer]  # of whatever width
Array = FloatArray | Integers

_ROWS = 1 << 18  # at a time, so that no second copy of a large array is made


def mesh_sha256(points: FloatArray, triangles: Integers, quads: Integers) -> str:
    """Return the name of a mesh: "exactmesh-mesh/1", points (n, 2), triangles (m, 3), quads (k, 4). O(n + m + k)."""
    return _digest(b"exactmesh-mesh/1\n", points, triangles, quads)


def domain_sha256(outline: "Outline") -> str:
    """Return the name of a domain: "exactmesh-domain/1 seeds" or "... even-odd", points (n, 2), segments (s, 2), holes
    (h, 2), regions (r, 4): x, y, attribute, largest area or infinity."""
    rule = b"even-odd" if outline.even_odd else b"seeds"
    regions = np.column_stack([outline.regions, outline.attributes, outline.areas])
    return _digest(
        b"exactmesh-domain/1 " + rule + b"\n", outline.points, outline.segments, outline.holes, regions.reshape(-1, 4)
    )


def array_sha256(array: Array) -> str:
    """Return the name of one array of one or two dimensions: "exactmesh-array/1", then the array."""
    return _digest(b"exactmesh-array/1\n", array if array.ndim == 2 else array[:, None])


def _digest(head: bytes, *arrays: Array) -> str:
    digest = hashlib.sha256(head)
    for array in arrays:
        digest.update(np.array(array.shape, dtype="<i8").tobytes())
        if array.dtype.kind == "u" and array.size and int(array.max()) > np.iinfo(np.int64).max:
            digest.update(b"unsigned\n")  # or they would be those below zero
        for part in _canonical(array):
            digest.update(part.tobytes())
    return digest.hexdigest()


def _canonical(array: Array) -> Iterator[npt.NDArray[np.generic]]:
    real = array.dtype.kind == "f"
    for start in range(0, len(array), _ROWS):
        part = np.array(array[start : start + _ROWS], dtype="<f8" if real else "<i8", order="C")
        if real:
            part += 0.0  # -0.0 + 0.0 is 0.0
            part[np.isnan(part)] = np.nan
        yield part
