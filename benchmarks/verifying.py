"""The verifier as an entry of a race: the mesh is built before the clock starts."""

from typing import Any

from benchmarks.peers import Mesher
from exactkernel.types import FloatArray

__all__ = ["VERIFIERS"]


def _mesh(points: FloatArray) -> Any:
    from exactmesh import delaunay

    mesh = delaunay(points)
    return mesh.points, mesh.triangles


def _foreign_mesh(points: FloatArray) -> Any:
    import triangle

    mesh = triangle.triangulate({"vertices": points}, "")
    return mesh["vertices"], mesh["triangles"]


def _verify(mesh: Any) -> int:
    from exactmesh import verify

    report = verify(*mesh)
    report.raise_if_failed()
    return len(mesh[1])


VERIFIERS: dict[str, Mesher] = {
    "verify-own": Mesher("verify, exactmesh's mesh", "exactmesh", _mesh, _verify, "verify(points, triangles)"),
    "verify-triangle": Mesher(
        "verify, Triangle's mesh", "triangle", _foreign_mesh, _verify, "verify(points, triangles)"
    ),
}
