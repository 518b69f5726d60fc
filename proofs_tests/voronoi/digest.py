"""Prints one digest a routine and input of the Voronoi room: for comparing lanes, bit for bit.

python -m proofs_tests.voronoi.digest
"""

import hashlib
import sys

import numpy as np
import numpy.typing as npt
from proofs_tests.mesh.digest import inputs

from exactkernel.types import FloatArray
from exactmesh import delaunay, voronoi
from exactmesh.voronoi import dual_edges, lloyd, natural_neighbors

__all__ = ["diagram", "digests"]


def _hash(*arrays: npt.NDArray[np.generic]) -> str:
    digest = hashlib.sha256()
    for array in arrays:
        digest.update(f"{array.dtype.str}{array.shape}".encode() + array.tobytes())
    return digest.hexdigest()[:16]


def _box(points: FloatArray) -> FloatArray:
    """Return a box that cuts off a part of the points."""
    low, high = points.min(axis=0), points.max(axis=0)
    return np.concatenate([0.75 * low + 0.25 * high, high])


def diagram(points: FloatArray) -> str:
    found = voronoi(points, clip=_box(points))
    cells = found.clipped
    assert cells is not None
    flat = (found.vertices, found.ends, found.cells, found.cell_ridges, found.directions, found.areas)
    clipped = (cells.sites, cells.offsets, cells.corners, cells.neighbors, cells.kinds, cells.areas, cells.energies)
    return _hash(*flat, *clipped, *dual_edges(delaunay(points)))


def _neighbors(points: FloatArray) -> str:
    corners = points[delaunay(points).triangles[:60] % len(points)]
    found = natural_neighbors(points, corners[:, 0] / 2 + corners[:, 1] / 4 + corners[:, 2] / 4)
    return _hash(found.offsets, found.sites, found.weights)


def _relaxation(points: FloatArray) -> str:
    some = points[:50]
    low, high = some.min(axis=0), some.max(axis=0)
    relaxed = lloyd(some, clip=np.concatenate([low, high]), iterations=2)
    return _hash(relaxed.points, relaxed.energies, relaxed.movements)


def digests() -> dict[str, str]:
    found = {}
    for name, points in inputs().items():
        found[f"diagram of {name}"] = diagram(points)
        found[f"natural neighbours in {name}"] = _neighbors(points)
        found[f"relaxation of {name}"] = _relaxation(points)
    return found


if __name__ == "__main__":
    for name, digest in digests().items():
        sys.stdout.write(f"{name}: {digest}\n")
