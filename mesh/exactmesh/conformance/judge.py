"""What an answer says about each law: the verifier decides about the mesh, exactly."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray
from exactmesh.conformance.given import Given, IndexArray, Trait
from exactmesh.conformance.laws import LAWS, Behaviour, Law, Outcome, Task
from exactmesh.conformance.process import Answer, Fate
from exactmesh.pslg import PSLG, Carve
from exactmesh.verify import Finding, Property, Report, Severity, Verdict, verify

__all__ = ["Fault", "Judgement", "check_legal", "judged"]


@dataclass(frozen=True, slots=True)
class Fault:
    """A broken law: how badly, and a sentence that says where."""

    outcome: Outcome
    sentence: str


#: For each law on which this input has a bearing: None where it was kept.
Judgement = Mapping[Law, Fault | None]

_FATES = {
    Fate.DIED: Outcome.DIES,
    Fate.HUNG: Outcome.HANGS,
    Fate.NO_MESH: Outcome.WRONG,
    Fate.REFUSED: Outcome.REFUSES,
}
#: What can be asked of triangles although the input has no triangulation.
_ALWAYS = (Property.FINITE, Property.INDICES, Property.ORIENTATION, Property.ADMISSIBLE)


def check_legal(task: Task, given: Given) -> None:
    """Raise unless a mesher could be asked this.

    Raises:
        ExactMeshError: coordinates that are not finite, segments that name no point, for ``DOMAIN`` none that enclose
            anything, and so on; the message names the culprits.
    """
    pslg = _domain(given)
    if task is Task.DOMAIN:
        verify(given.points, (), domain=pslg)


def judged(task: Task, given: Given, answer: Answer, orientation: str) -> Judgement:
    """Return what the answer says about each law of the task.

    A law is missing where the input has no bearing on it, or where the verifier leaves it undecided because of another
    one that is broken.
    """
    if answer.fate is not Fate.ANSWERED:
        excused = answer.fate is Fate.REFUSED and _has_no_triangulation(task, given)
        return {Behaviour.ANSWERS: None if excused else Fault(_FATES[answer.fate], answer.message)}
    faults: dict[Law, Fault | None] = dict.fromkeys(Behaviour)
    if not answer.kept:
        faults[Behaviour.KEEPS_INPUT] = Fault(Outcome.WRONG, "the arrays that were given have other values afterwards")
    if not answer.repeats:
        faults[Behaviour.REPEATABLE] = Fault(
            Outcome.WRONG, "the second answer to the same input differs from the first"
        )
    mesh = assembled(given, answer)
    report = _report(task, given, mesh, answer.orientation or orientation)
    laws = _laws(task, given)
    for law in laws:
        if isinstance(law, Property) and law in report.findings:
            finding = report.findings[law]
            if finding.verdict is not Verdict.UNDECIDED:
                faults[law] = _fault_of(finding)
    if Trait.CROSSING not in given.traits:
        faults[Property.NO_NEW_POINTS] = _invented(mesh)
    if Property.ALL_POINTS_USED in laws and report.verdict(Property.INDICES) is Verdict.HOLDS:
        faults[Property.ALL_POINTS_USED] = _dropped(given, mesh)
    return faults


def _domain(given: Given) -> PSLG:
    return PSLG(given.points, () if given.segments is None else given.segments, rule=Carve.EVEN_ODD)


def _has_no_triangulation(task: Task, given: Given) -> bool:
    """Tell whether there are no triangles to be had, or none with these points and segments: an exception says so."""
    if given.traits & {Trait.FLAT, Trait.CROSSING}:
        return True
    if task is not Task.DOMAIN:
        return False
    empty = verify(given.points, (), domain=_domain(given))
    return empty.verdict(Property.COVERS_DOMAIN) is Verdict.HOLDS


def _laws(task: Task, given: Given) -> tuple[Law, ...]:
    """Return the laws on which the input has a bearing."""
    return _ALWAYS if given.traits & {Trait.FLAT, Trait.CROSSING} else LAWS[task]


def _fault_of(finding: Finding) -> Fault | None:
    """Return what the verifier found, the worst of it first."""
    if finding.verdict is Verdict.HOLDS:
        return None
    rounding = finding.severity is Severity.ROUNDING
    worst = [violation for violation in finding.violations if rounding or violation.severity is Severity.WRONG]
    return Fault(Outcome.ROUNDING if rounding else Outcome.WRONG, (worst or finding.violations)[0].message)


@dataclass(frozen=True, slots=True, eq=False)
class Assembled:
    """A mesh in the indices of the input; corners elsewhere, or a second time at one place, have indices beyond.

    Attributes:
        points: (n + k, 2), those of the input first.
        triangles: (m, 3).
        segments: those of the input, from corners to corners where several points share a position.
        invented: the rows of ``points`` at positions that the input does not have.
    """

    points: FloatArray
    triangles: IndexArray
    segments: IndexArray | None
    invented: tuple[int, ...]


def assembled(given: Given, answer: Answer) -> Assembled:
    """Return the mesh in the indices of the input: a mesher may return points of its own. O(n + m)."""
    assert answer.triangles is not None
    points, triangles = given.points, answer.triangles
    invented: tuple[int, ...] = ()
    if answer.points is not None and not np.array_equal(answer.points, given.points):
        points, triangles, invented = _matched(given.points, answer.points, answer.triangles)
    return Assembled(points, triangles, _between_corners(given, triangles), invented)


def _matched(
    given: FloatArray, returned: FloatArray, triangles: IndexArray
) -> tuple[FloatArray, IndexArray, tuple[int, ...]]:
    places: dict[tuple[float, float], list[int]] = {}
    for index, (x, y) in enumerate(given.tolist()):
        places.setdefault((x, y), []).append(index)
    known = set(places)
    valid = (triangles >= 0) & (triangles < len(returned))
    renamed = np.full(len(returned) + 1, -1, dtype=np.int64)  # the last one for what does not exist
    extra: list[tuple[float, float]] = []
    invented = []
    for vertex in np.unique(triangles[valid]).tolist():
        x, y = returned[vertex].tolist()
        free = places.get((x, y))
        if free:
            renamed[vertex] = free.pop(0)
            continue
        renamed[vertex] = len(given) + len(extra)
        extra.append((x, y))
        if (x, y) not in known:
            invented.append(int(renamed[vertex]))
    points = np.concatenate([given, np.array(extra, dtype=np.float64).reshape(-1, 2)])
    return points, renamed[np.where(valid, triangles, -1)], tuple(invented)


def _between_corners(given: Given, triangles: IndexArray) -> IndexArray | None:
    if given.segments is None or Trait.DUPLICATES not in given.traits:
        return given.segments
    used = _used(len(given.points), triangles)
    corner: dict[tuple[float, float], int] = {}
    for index in np.flatnonzero(used).tolist():
        corner.setdefault(_position(given.points, index), index)
    ends = [
        index if used[index] else corner.get(_position(given.points, index), index)
        for index in given.segments.ravel().tolist()
    ]
    return np.array(ends, dtype=np.int64).reshape(-1, 2)


def _used(n: int, triangles: IndexArray) -> npt.NDArray[np.bool_]:
    used = np.zeros(n, dtype=np.bool_)
    used[triangles[(triangles >= 0) & (triangles < n)]] = True
    return used


def _position(points: FloatArray, index: int) -> tuple[float, float]:
    x, y = points[index].tolist()
    return x, y


def _report(task: Task, given: Given, mesh: Assembled, orientation: str) -> Report:
    if task is Task.DOMAIN and Trait.CROSSING not in given.traits:
        domain = _domain(given)
        return verify(mesh.points, mesh.triangles, domain=domain, orientation=orientation)
    if task is Task.SEGMENTS and Trait.CROSSING not in given.traits:
        return verify(mesh.points, mesh.triangles, segments=mesh.segments, orientation=orientation)
    return verify(mesh.points, mesh.triangles, orientation=orientation)


def _invented(mesh: Assembled) -> Fault | None:
    if not mesh.invented:
        return None
    first = mesh.invented[0]
    return Fault(Outcome.WRONG, f"corner {_position(mesh.points, first)!r} is no point of the input")


def _dropped(given: Given, mesh: Assembled) -> Fault | None:
    """ALL_POINTS_USED by position: of points that coincide, one will do."""
    used = _used(len(given.points), mesh.triangles)
    places = {_position(given.points, index) for index in np.flatnonzero(used).tolist()}
    dropped = [index for index in np.flatnonzero(~used).tolist() if _position(given.points, index) not in places]
    if not dropped:
        return None
    count, first = len(dropped), dropped[0]
    where = f"point {first} {_position(given.points, first)!r}"
    said = f"{where} is no corner of any triangle" if count == 1 else f"{count} points are at no corner, first {where}"
    return Fault(Outcome.WRONG, said)
