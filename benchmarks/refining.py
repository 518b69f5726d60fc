"""The refiners: what each needs before the clock starts, the call that is timed, and what came out of it."""

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from benchmarks.graphs import cycle
from benchmarks.peers import Mesher
from benchmarks.refining_cases import Case
from exactkernel.types import FloatArray, IntArray

__all__ = ["CALLBACKS", "DESCRIPTION", "REFINERS"]

#: What ``describe`` tells.
DESCRIPTION = ["points", "triangles", "smallest angle", "below the bound", "admissible, Delaunay", "covers exactly"]

_DOUBT = 1e-9  # degrees: an angle so near to the bound is compared exactly


class Output(NamedTuple):
    """A refined mesh: points (n, 2), counterclockwise triangles (m, 3), and the edges (k, 2) that must stay."""

    points: FloatArray
    triangles: IntArray
    pieces: IntArray


def _below(output: Output, degrees: float) -> tuple[float, int]:
    """Return the smallest angle, and how many triangles have one below the bound, exactly."""
    from exactkernel import angle_below
    from exactmesh.quality import angles_of

    smallest = angles_of(output.points, output.triangles).min(axis=1)
    near = np.flatnonzero(np.abs(smallest - degrees) <= _DOUBT)
    corners = output.points[output.triangles[near]].tolist()
    exactly = sum(angle_below(triangle, degrees) for triangle in corners)
    return float(smallest.min()), int((smallest < degrees - _DOUBT).sum()) + exactly


def _described(case: Case, output: Output) -> list[str]:
    """Return the cells of DESCRIPTION. The verifier is asked whether the mesh is constrained Delaunay with the pieces
    that its maker calls constrained, and whether it covers the domain exactly."""
    from exactmesh import PSLG, verify
    from exactmesh.verify import Property, Verdict

    mesh = verify(output.points, output.triangles, segments=output.pieces)
    claims = (Property.ADMISSIBLE, Property.CONSTRAINED_DELAUNAY)
    sound = [str(mesh.verdict(claim)) for claim in claims]
    domain = verify(output.points, output.triangles, domain=PSLG(case.points, case.segments))
    covers = domain.verdict(Property.COVERS_DOMAIN) is Verdict.HOLDS
    angle, below = _below(output, case.min_angle)
    return [
        f"{len(output.points):,}",
        f"{len(output.triangles):,}",
        f"{angle:.3f}",
        f"{below:,}",
        ", ".join("yes" if verdict == "holds" else verdict for verdict in sound),
        "yes" if covers else "no",
    ]


def _describe(refine: Callable[[Any], tuple[Case, Output]]) -> Callable[[Any], list[str]]:
    return lambda prepared: _described(*refine(prepared))


def _same(case: Case) -> Case:
    return case


def _own(case: Case, **options: Any) -> Any:
    from exactmesh import PSLG, refine

    bounds = {"max_area": case.max_area} if case.max_area else {}
    return refine(PSLG(case.points, case.segments), min_angle=case.min_angle, **{**bounds, **options})


def _exactmesh(case: Case) -> int:
    return len(_own(case).triangulation.triangles)


def _exactmesh_output(case: Case) -> tuple[Case, Output]:
    mesh = _own(case).triangulation
    return case, Output(mesh.points, mesh.triangles, mesh.segments)


def _switches(case: Case) -> str:
    return f"pq{case.min_angle:g}" + (f"a{case.max_area:.16f}" if case.max_area else "")


def _triangle_mesh(case: Case) -> Any:
    import triangle

    return triangle.triangulate({"vertices": case.points, "segments": case.segments}, _switches(case))


def _triangle(case: Case) -> int:
    return len(_triangle_mesh(case)["triangles"])


def _triangle_output(case: Case) -> tuple[Case, Output]:
    mesh = _triangle_mesh(case)
    return case, Output(mesh["vertices"], mesh["triangles"], mesh["segments"])


def _meshpy_input(case: Case) -> tuple[Case, Any]:
    from meshpy.triangle import MeshInfo

    info = MeshInfo()
    info.set_points(case.points.tolist())
    info.set_facets(case.segments.tolist())
    return case, info


def _meshpy_mesh(prepared: tuple[Case, Any]) -> Any:
    from meshpy.triangle import build

    case, info = prepared
    bounds = {"max_volume": case.max_area} if case.max_area else {}
    return build(info, min_angle=case.min_angle, **bounds)


def _meshpy(prepared: tuple[Case, Any]) -> int:
    return len(_meshpy_mesh(prepared).elements)


def _meshpy_output(prepared: tuple[Case, Any]) -> tuple[Case, Output]:
    mesh = _meshpy_mesh(prepared)
    return prepared[0], Output(np.array(mesh.points), np.array(mesh.elements), np.array(mesh.facets))


@cache
def _gmsh_is_ready() -> Any:
    import gmsh

    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.Algorithm", 5)  # Delaunay
    return gmsh


def _gmsh_input(case: Case) -> Case:
    """Make the geometry: edges as long as the area asks for, or else as the segments are."""
    if not np.array_equal(case.segments, cycle(len(case.points))):
        raise NotImplementedError("one ring only")
    gmsh = _gmsh_is_ready()
    gmsh.clear()
    lengths = np.hypot(*(case.points[case.segments[:, 1]] - case.points[case.segments[:, 0]]).T)
    sizes = np.minimum(lengths, np.roll(lengths, 1))
    if case.max_area:
        sizes = np.full(len(sizes), 1.2 * np.sqrt(case.max_area))  # as many triangles as the others make
    n = len(case.points)
    for i in range(n):
        gmsh.model.geo.addPoint(case.points[i, 0], case.points[i, 1], 0.0, sizes[i], i + 1)
    for i in range(n):
        gmsh.model.geo.addLine(i + 1, (i + 1) % n + 1, i + 1)
    gmsh.model.geo.addCurveLoop(list(range(1, n + 1)), 1)
    gmsh.model.geo.addPlaneSurface([1], 1)
    gmsh.model.geo.synchronize()
    return case


def _gmsh(case: Case) -> int:  # noqa: ARG001  # gmsh keeps the geometry by itself
    gmsh = _gmsh_is_ready()
    gmsh.model.mesh.clear()
    gmsh.model.mesh.generate(2)
    return len(gmsh.model.mesh.getElementsByType(2)[0])


def _gmsh_output(case: Case) -> tuple[Case, Output]:
    _gmsh(case)
    gmsh = _gmsh_is_ready()
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    number = np.zeros(int(tags.max()) + 1, dtype=np.int32)
    number[tags] = np.arange(len(tags))
    triangles, lines = (number[gmsh.model.mesh.getElementsByType(kind)[1]] for kind in (2, 1))
    return case, Output(coordinates.reshape(-1, 3)[:, :2].copy(), triangles.reshape(-1, 3), lines.reshape(-1, 2))


REFINERS: dict[str, Mesher] = {
    "exactmesh-refine": Mesher(
        "exactmesh", "exactmesh", _same, _exactmesh, "refine(PSLG(points, segments), ...)", _describe(_exactmesh_output)
    ),
    "triangle-refine": Mesher(
        "Triangle", "triangle", _same, _triangle, "triangulate(graph, 'pq30a...')", _describe(_triangle_output)
    ),
    "meshpy-refine": Mesher(
        "meshpy",
        "meshpy",
        _meshpy_input,
        _meshpy,
        "build(info, min_angle=...), lists before",
        _describe(_meshpy_output),
    ),
    "gmsh-refine": Mesher(
        "gmsh",
        "gmsh",
        _gmsh_input,
        _gmsh,
        "mesh.generate(2) by its Delaunay algorithm, geometry made before; sizes instead of an angle",
        _describe(_gmsh_output),
    ),
}


def _by_unsuitable(case: Case) -> int:
    answer = _own(case, max_area=None, unsuitable=lambda corners, areas: areas > case.max_area)  # noqa: ARG005
    return len(answer.triangulation.triangles)


def _by_size(case: Case) -> int:
    longest = 1.75 * np.sqrt(case.max_area)  # about as many triangles
    answer = _own(case, max_area=None, size=lambda xy: np.full(len(xy), longest))
    return len(answer.triangulation.triangles)


#: The same bound, asked in Python.
CALLBACKS: dict[str, Mesher] = {
    "by-area": Mesher("max_area, built in", "exactmesh", _same, _exactmesh, "refine(..., max_area=a)"),
    "by-unsuitable": Mesher(
        "unsuitable", "exactmesh", _same, _by_unsuitable, "refine(..., unsuitable=lambda corners, areas: areas > a)"
    ),
    "by-size": Mesher("size", "exactmesh", _same, _by_size, "refine(..., size=lambda xy: np.full(len(xy), h))"),
}
