"""The verifier as an entry of a race: the mesh is built before the clock starts."""

from typing import Any

from benchmarks.graphs import Graph
from benchmarks.peers import Mesher
from exactkernel.types import FloatArray

__all__ = ["CONSTRAINED_VERIFIERS", "VERIFIERS"]


def _mesh(points: FloatArray) -> Any:
    from exactmesh import delaunay

    mesh = delaunay(points)
    return mesh.points, mesh.triangles, None


def _foreign_mesh(points: FloatArray) -> Any:
    import triangle

    mesh = triangle.triangulate({"vertices": points}, "")
    return mesh["vertices"], mesh["triangles"], None


def _constrained_mesh(graph: Graph) -> Any:
    from exactmesh import PSLG, constrained_delaunay

    mesh = constrained_delaunay(PSLG(graph.points, graph.segments), carve=False)
    return mesh.points, mesh.triangles, graph.segments


def _foreign_constrained_mesh(graph: Graph) -> Any:
    import triangle

    mesh = triangle.triangulate({"vertices": graph.points, "segments": graph.segments}, "pc")
    return mesh["vertices"], mesh["triangles"], graph.segments


def _verify(mesh: Any) -> int:
    from exactmesh import verify

    points, triangles, segments = mesh
    report = verify(points, triangles, segments=segments)
    report.raise_if_failed()
    return len(triangles)


VERIFIERS: dict[str, Mesher] = {
    "verify-own": Mesher("verify, exactmesh's mesh", "exactmesh", _mesh, _verify, "verify(points, triangles)"),
    "verify-triangle": Mesher(
        "verify, Triangle's mesh", "triangle", _foreign_mesh, _verify, "verify(points, triangles)"
    ),
}

CONSTRAINED_VERIFIERS: dict[str, Mesher] = {
    "verify-own-constrained": Mesher(
        "verify, exactmesh's mesh", "exactmesh", _constrained_mesh, _verify, "verify(points, triangles, segments=...)"
    ),
    "verify-triangle-constrained": Mesher(
        "verify, Triangle's mesh",
        "triangle",
        _foreign_constrained_mesh,
        _verify,
        "verify(points, triangles, segments=...)",
    ),
}
