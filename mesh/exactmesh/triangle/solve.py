"""From a dictionary and switches to a triangulation: which of the library's functions answers."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray
from exactmesh.constrain import Crossings, constrained_delaunay
from exactmesh.delaunay import Progress, delaunay
from exactmesh.ordering import IndexArray
from exactmesh.plane import BoolArray
from exactmesh.pslg import PSLG
from exactmesh.refinement import Reason, Refinement, Steiner, refine
from exactmesh.triangle.dictionary import Given
from exactmesh.triangle.errors import SwitchError
from exactmesh.triangle.given_mesh import GivenMesh, given_mesh
from exactmesh.triangle.graph import graph_of, hull_edges, solved
from exactmesh.triangle.switches import Switch, Switches
from exactmesh.triangulation import Triangulation
from exactmesh.verify import verify

__all__ = ["Solution", "Unsuitable", "answered", "origin_of"]

#: Tells which triangles are too large: (corners (k, 3, 2), areas (k,)) -> bool (k,).
Unsuitable: TypeAlias = Callable[[FloatArray, FloatArray], npt.ArrayLike]

_STEINER = (Steiner.ANYWHERE, Steiner.NOT_ON_BOUNDARY, Steiner.NOT_ON_SEGMENTS)


@dataclass(frozen=True)
class Solution:
    """A triangulation, and where its parts come from.

    Attributes:
        mesh: the triangulation.
        origin: int64 (n,), which vertex of the dictionary each vertex is, -1 for new ones.
        triangle_attributes: float64 (m, b).
        notes: what was passed over, or missed.
    """

    mesh: Triangulation
    origin: IndexArray
    triangle_attributes: FloatArray
    notes: list[str] = field(default_factory=list)


def answered(
    given: Given, switches: Switches, unsuitable: Unsuitable | None = None, progress: Progress | None = None
) -> Solution:
    """Triangulate, refine, and check, as the switches say.

    Raises:
        SwitchError: the switches ask for something that is not given.
        VerificationError: C was asked, and the verifier finds a fault.
        ExactMeshError: what :func:`exactmesh.triangle.triangulate` raises.
    """
    solution = _solution(given, switches, unsuitable, progress)
    if switches.asks(Switch.CHECK):
        _check(solution)
    return solution


def _solution(given: Given, switches: Switches, unsuitable: Unsuitable | None, progress: Progress | None) -> Solution:
    if switches.asks(Switch.UNSUITABLE) and unsuitable is None:
        raise SwitchError(
            "which triangles are too large? Give triangulate a function unsuitable=",
            switches=str(switches), position=str(switches).find("u"), culprit="u",
        )  # fmt: skip
    task = _Task(switches, unsuitable, progress, [])
    if switches.asks(Switch.REFINE):
        return _of_triangles(given, task)
    if not (switches.refines or switches.asks(Switch.PSLG)):
        mesh = delaunay(given.vertices, progress=progress)
        if switches.asks(Switch.CONVEX):
            hull = hull_edges(mesh.hull, np.arange(len(mesh.points))).astype(np.int32)
            mesh = replace(mesh, segments=hull, segment_markers=np.ones(len(hull), dtype=np.int64))
        return Solution(mesh, origin_of(mesh, len(given.vertices)), mesh.triangle_attributes)
    added = np.zeros((0, 2), dtype=np.int64)
    if switches.asks(Switch.CONVEX) or not switches.asks(Switch.PSLG):
        whole = delaunay(given.vertices)
        added = hull_edges(whole.hull, origin_of(whole, len(given.vertices)))
    graph = graph_of(given, switches, added)
    if switches.local_areas and not len(graph.regions):
        task.notes.append("a without a number takes the areas of regions, and there are none: no area is bounded by it")
    mesh = solved(graph, task.of_graph, task.notes)
    attributes = mesh.triangle_attributes if switches.asks(Switch.ATTRIBUTES) else np.zeros((len(mesh.triangles), 0))
    return Solution(mesh, origin_of(mesh, len(given.vertices)), attributes, task.notes)


def _check(solution: Solution) -> None:
    """Have the verifier look at the result; it raises what it finds."""
    mesh = solution.mesh
    if mesh.pslg is None:
        verify(mesh.points, mesh.triangles).raise_if_failed()
    elif mesh.domain is None:
        verify(mesh.points, mesh.triangles, claims=["admissible"]).raise_if_failed()
    else:
        verify(mesh.points, mesh.triangles, domain=mesh.domain).raise_if_failed()


def _of_triangles(given: Given, task: "_Task") -> Solution:
    """Refine the triangles of a dictionary, or return them as they are."""
    start = given_mesh(given, task.switches, task.notes)
    if not task.switches.refines:
        mesh = start.unchanged()
    else:
        begin = start.delaunay()
        mesh = task.refined(begin, _areas(given, task.switches, start, begin))
    of_vertex = origin_of(mesh, len(start.used))
    origin = np.where(of_vertex >= 0, start.used[of_vertex], -1)
    attributes = given.triangle_attributes
    if attributes is None:
        return Solution(mesh, origin, np.zeros((len(mesh.triangles), 0)), task.notes)
    source = start.source(mesh)
    found = np.where((source >= 0)[:, None], attributes[source], 0.0)
    return Solution(mesh, origin, found, task.notes)


def _areas(given: Given, switches: Switches, start: GivenMesh, begin: Triangulation) -> FloatArray | float | None:
    """Return the area that bounds each triangle, infinite where none does."""
    if not switches.local_areas:
        return switches.max_area
    if given.triangle_max_area is None:
        raise SwitchError(
            "with r, a without a number takes the areas of the dictionary's 'triangle_max_area', and there is none",
            switches=str(switches), position=str(switches).find("a"), culprit="a",
        )  # fmt: skip
    source = start.source(begin)
    areas = np.where(source >= 0, given.triangle_max_area[source], np.inf)
    areas = np.where(areas > 0.0, areas, np.inf)
    return areas if switches.max_area is None else np.minimum(areas, switches.max_area)


def origin_of(mesh: Triangulation, count: int) -> IndexArray:
    """Return the first point of the input, of ``count``, at each vertex, or -1."""
    representative = mesh.representative[:count]
    origin = np.full(len(mesh.points), -1, dtype=np.int64)
    stays = np.flatnonzero(representative >= 0)[::-1]
    origin[representative[stays]] = stays
    return origin


@dataclass(frozen=True)
class _Task:
    switches: Switches
    unsuitable: Unsuitable | None
    progress: Progress | None
    notes: list[str]

    def of_graph(self, pslg: PSLG) -> Triangulation:
        """Triangulate a graph; crossings become vertices."""
        if self.switches.refines:
            return self.refined(pslg, self.switches.max_area)
        return constrained_delaunay(pslg, crossings=Crossings.SPLIT, progress=self.progress)

    def refined(self, domain: PSLG | Triangulation, max_area: FloatArray | float | None) -> Triangulation:
        switches = self.switches
        result = refine(
            domain,
            min_angle=switches.min_angle or 0.0,
            max_area=max_area,
            unsuitable=self._asked if switches.asks(Switch.UNSUITABLE) else None,
            conforming=switches.asks(Switch.CONFORMING, Switch.SPLIT),
            steiner=_STEINER[switches.unsplit],
            max_steiner=switches.max_steiner,
            crossings=Crossings.SPLIT,
            progress=self.progress,
        )
        self._report(result)
        return result.triangulation

    def _asked(self, corners: FloatArray, areas: FloatArray) -> BoolArray:
        assert self.unsuitable is not None
        return np.asarray(self.unsuitable(corners, areas))

    def _report(self, result: Refinement) -> None:
        """Say what was left undone, unless it is what the switches ask for."""
        expected = {Reason.SMALL_INPUT_ANGLE}
        expected |= {Reason.BUDGET} if self.switches.max_steiner is not None else set()
        expected |= {Reason.FORBIDDEN} if self.switches.unsplit else set()
        for reason in sorted({Reason(code) for code in result.reasons.tolist()} - expected):
            count, name = int((result.reasons == reason).sum()), reason.name.lower().replace("_", " ")
            self.notes.append(f"{count} triangles miss what is asked for: {name}")
