"""Prints one digest a routine and input: for comparing lanes and processes, bit for bit.

python -m proofs_tests.mesh.digest
"""

import hashlib
import sys

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray
from exactmesh import PSLG, Carve, Crossings, Triangulation, constrained_delaunay, delaunay, lawson
from exactmesh.ordering import insertion_order

__all__ = ["digests", "inputs"]


def inputs() -> dict[str, FloatArray]:
    """Small sets that reach every stage of the predicates, and every branch of location."""
    random = np.random.default_rng(11)
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(12.0), np.arange(12.0)))
    angles = random.random(120) * 2 * np.pi
    along = random.random(120)
    return {
        "uniform": random.random((400, 2)),
        "grid": np.stack([x, y], axis=1),
        "circle": np.stack([np.cos(angles), np.sin(angles)], axis=1),
        "line": np.stack([along, along * 3.0 + 1e-15 * random.random(120)], axis=1),
        "clusters": np.repeat(random.random((3, 2)), 60, axis=0) + 1e-14 * random.random((180, 2)),
        "duplicates": random.integers(0, 6, (100, 2)).astype(np.float64),
        "subnormal": random.integers(0, 9, (60, 2)) * 5e-324,
        "huge": (random.random((100, 2)) - 0.5) * 2.0**1023,
        "no window": np.ldexp(random.random((40, 2)), random.integers(-1070, 1020, (40, 2))),
    }


def _hash(*arrays: npt.NDArray[np.generic]) -> str:
    digest = hashlib.sha256()
    for array in arrays:
        digest.update(f"{array.dtype.str}{array.shape}".encode() + array.tobytes())
    return digest.hexdigest()[:16]


def _mesh(mesh: Triangulation) -> str:
    work = [mesh.work.flips, *mesh.work.orient2d.values(), *mesh.work.incircle.values()]
    return _hash(mesh.points, mesh.triangles, mesh.neighbors, mesh.representative, mesh.hull, np.array(work))


def graphs(points: FloatArray) -> dict[str, PSLG]:
    """Graphs without crossings: a path through all points, a segment past them, the hull; and one with crossings."""
    order = np.lexsort((points[:, 1], points[:, 0]))
    apart = (points[order[1:]] != points[order[:-1]]).any(axis=1)
    path = np.stack([order[:-1], order[1:]], axis=1)[apart]
    mesh = delaunay(points)
    hull = np.stack([mesh.hull, np.roll(mesh.hull, -1)], axis=1)
    random = np.random.default_rng(5).integers(0, len(mesh.points), (8, 2))
    across = np.unique(np.sort(random[random[:, 0] != random[:, 1]], axis=1), axis=0)
    markers = np.arange(len(hull)) % 3
    return {
        "path": PSLG(points, path, point_markers=np.arange(len(points)) % 4),
        "long segment": PSLG(points, [(order[0], order[-1])]),
        "hull": PSLG(mesh.points, hull, segment_markers=markers, rule=Carve.EVEN_ODD),
        "crossings": PSLG(mesh.points, across),
    }


def _constrained(pslg: PSLG, name: str) -> str:
    mesh = constrained_delaunay(pslg, carve=name == "hull", crossings=Crossings.SPLIT)
    chains = [mesh.chain(i) for i in range(len(pslg.segments))]
    columns = (mesh.segment_markers, mesh.vertex_markers, mesh.edge_markers, mesh.triangle_regions)
    return _hash(np.array(_mesh(mesh)), mesh.segments, mesh.segment_incidence, *columns, *chains)


def shuffled(mesh: Triangulation) -> npt.NDArray[np.int32]:
    """Return the triangles after a number of flips that ask nothing: any triangulation of a grid of squares will do."""
    surface = mesh.quad_edge()
    for edge in list(surface.edges())[::3]:
        if -1 in (edge.left, edge.right):
            continue
        a, b, c, d = (mesh.points[v] for v in (edge.org, edge.oprev.dest, edge.dest, edge.onext.dest))
        if _turn(a, b, d) > 0.0 and _turn(b, c, d) > 0.0:
            surface.swap(edge)
    return surface.triangles()


def _turn(a: FloatArray, b: FloatArray, c: FloatArray) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def digests() -> dict[str, str]:
    found = {}
    for name, points in inputs().items():
        mesh = delaunay(points)
        found[f"order of {name}"] = _hash(insertion_order(points, 3))
        found[f"delaunay of {name}"] = _mesh(mesh)
        found[f"lawson of {name}"] = _mesh(lawson(mesh.points, mesh.triangles))
        queries = np.concatenate([points, points * 0.75])
        found[f"locate in {name}"] = _hash(mesh.locate(queries))
        found[f"quad-edge of {name}"] = _hash(*(np.array([e.index, e.org, e.left]) for e in mesh.quad_edge().edges()))
        for kind, pslg in graphs(points).items():
            found[f"{kind} of {name}"] = _constrained(pslg, kind)
        if name in ("grid", "uniform"):
            found[f"lawson of shuffled {name}"] = _mesh(lawson(mesh.points, shuffled(mesh)))
    return found


if __name__ == "__main__":
    for name, digest in digests().items():
        sys.stdout.write(f"{name}: {digest}\n")
