"""The arrays of a page: byte planes, deflated, in base64."""

import base64
import math
import zlib
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray
from exactmesh.verify import CheckedMesh
from exactmesh.verify.mesh import Integers
from exactmesh.verify.witness import IndexArray

__all__ = ["Payload", "payload_of"]

_NOWHERE = 2**32 - 1  # an index that is none
_LARGEST_EXPONENT = 500  # so that the browser may multiply two coordinates
_LEVEL = 1  # of deflate: byte planes are either easy or hopeless

Array = npt.NDArray[np.float64] | npt.NDArray[np.uint32]


@dataclass(frozen=True, slots=True)
class Payload:
    """What a page draws.

    Attributes:
        exponent: the coordinates of the page, times 2 to this power, are those of the mesh.
        arrays: by name, flat.
    """

    exponent: int
    arrays: dict[str, Array]

    def scaled(self, value: float) -> float:
        """Return a coordinate as it is on the page."""
        return math.ldexp(value, -self.exponent)


def payload_of(mesh: CheckedMesh) -> Payload:
    """Return what is drawn of a mesh: its cells, the points at none, its boundary, its segments or its domain's."""
    n, others = len(mesh.points), np.empty((0, 2)) if mesh.domain is None else mesh.domain.points
    exponent = _exponent_of(np.concatenate([mesh.points.ravel(), others.ravel()]))
    triangles, quads = _indices(mesh.triangles, n), _indices(mesh.quads, n)
    loose = np.ones(n + 1, dtype=np.bool_)
    for cells in (triangles, quads):
        loose[np.minimum(cells, n)] = False
    arrays: dict[str, Array] = {
        "points": np.ldexp(mesh.points, -exponent).ravel(),
        "triangles": triangles.ravel(),
        "quads": quads.ravel(),
        "loose": np.flatnonzero(loose[:n]).astype(np.uint32),
        "boundary": _boundary(triangles, quads).ravel(),
    }
    if mesh.segments is not None:
        arrays["segments"] = _indices(mesh.segments, n).ravel()
    if mesh.domain is not None:
        arrays["corners"] = np.ldexp(others, -exponent).ravel()
        arrays["outline"] = _indices(mesh.domain.segments, len(others)).ravel()
    return Payload(exponent, arrays)


def packed(array: Array) -> str:
    """Return the first bytes of all numbers, then the second bytes and so on, little-endian, deflated, in base64."""
    little = array.astype(array.dtype.newbyteorder("<"), copy=False)
    planes = little.view(np.uint8).reshape(len(array), array.itemsize).T
    return base64.b64encode(zlib.compress(planes.tobytes(), _LEVEL)).decode("ascii")


def _exponent_of(coordinates: FloatArray) -> int:
    sizes = np.abs(coordinates[np.isfinite(coordinates)])
    largest = float(sizes.max()) if sizes.size else 0.0
    exponent = math.frexp(largest)[1] if largest > 0.0 else 0
    return exponent if abs(exponent) > _LARGEST_EXPONENT else 0


def _indices(rows: Integers | IndexArray, n: int) -> npt.NDArray[np.uint32]:
    valid = (rows >= 0) & (rows < n)
    return np.where(valid, rows, _NOWHERE).astype(np.uint32)


def _boundary(triangles: npt.NDArray[np.uint32], quads: npt.NDArray[np.uint32]) -> npt.NDArray[np.uint32]:
    """Return the edges that belong to one cell only."""
    sides = np.concatenate(
        [np.stack([cells, np.roll(cells, -1, axis=1)], axis=2).reshape(-1, 2) for cells in (triangles, quads)]
    ).astype(np.uint64)
    keys = np.sort(sides.min(axis=1) << np.uint64(32) | sides.max(axis=1))
    if not keys.size:
        return np.empty((0, 2), dtype=np.uint32)
    new = np.flatnonzero(np.append(True, keys[1:] != keys[:-1]))
    once = keys[new[np.diff(np.append(new, len(keys))) == 1]]
    edges = np.stack([once >> np.uint64(32), once & np.uint64(_NOWHERE)], axis=1).astype(np.uint32)
    kept: npt.NDArray[np.uint32] = edges[(edges != _NOWHERE).all(axis=1)]
    return kept
