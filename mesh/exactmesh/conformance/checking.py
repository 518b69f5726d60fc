"""check: put a mesher on trial; retry: one input only."""

import math
import sys
from collections.abc import Callable, Collection, Mapping

import numpy.typing as npt

from exactmesh.conformance.given import Given
from exactmesh.conformance.judge import check_legal
from exactmesh.conformance.laws import LAWS, Behaviour, Law, Outcome, Task
from exactmesh.conformance.options import check_counts, check_integer, check_seconds
from exactmesh.conformance.process import Limits, MesherProcess
from exactmesh.conformance.reference import Mesher, name_of, resolved
from exactmesh.conformance.result import Conformance, Counterexample, Ruling
from exactmesh.conformance.trial import Clock, Evidence, Trial
from exactmesh.errors import ChoiceError, OptionError
from exactmesh.pslg import PSLG
from exactmesh.verify import verify

__all__ = ["DEADLINE", "MAX_EXAMPLES", "MAX_SIZE", "check", "retry"]

#: The default budget: inputs of each family, points of each input, seconds for everything.
MAX_EXAMPLES, MAX_SIZE, DEADLINE = 100, 40, 120.0

_EXPLORING = 0.6  # of the deadline; the rest is for making what was found smaller

Progress = Callable[[str, int, int], None]
"""Called with what is being done, how many steps are done, and how many there are."""


def check(
    mesher: Mesher,
    *,
    kind: Task | str = Task.POINTS,
    properties: Collection[Law | str] | None = None,
    max_examples: int = MAX_EXAMPLES,
    max_size: int = MAX_SIZE,
    deadline: float = DEADLINE,
    timeout: float = Limits.seconds,
    memory: int = Limits.memory,
    orientation: str | None = None,
    seed: int = 0,
    progress: Progress | None = None,
) -> Conformance:
    """Put a mesher to the test.

    It runs in a process of its own, which it may crash, leave or hang. hypothesis draws inputs from every family of
    :mod:`exactmesh.strategies`; the verifier judges each answer, exactly. Of each law that is broken, the worst breach
    is looked for first and made as small as possible.

    Args:
        mesher: a function of a module or script, "module:function", or the name of a known mesher, see
            :data:`exactmesh.conformance.KNOWN`. It is given float64 (n, 2), and int64 (s, 2), and returns triangles;
            points and triangles; or any mesh that :mod:`exactmesh.adapters` understands.
        kind: "points", "segments" or "domain", see :class:`Task`.
        properties: the laws that are of interest; all of the task by default.
        max_examples: inputs of each family.
        max_size: points of an input, at most.
        deadline: seconds for everything, about; whatever is unfinished then is told as it stands.
        timeout: seconds for one call.
        memory: bytes that the process may take.
        orientation: "ccw" or "any": how triangles may be listed; by default as a known mesher says, else "ccw".
        seed: the same seed, the same inputs.
        progress: called now and then with (what, done, total).

    Returns:
        A :class:`Conformance`; ``str()`` of it is a table, ``ok`` tells whether every law holds.

    Raises:
        MesherError: the mesher cannot be imported by another process.
        ChoiceError: an unknown kind or property.
        OptionError: a number that is none, or out of range.
        HypothesisUnavailableError: hypothesis is not installed.

    >>> from exactmesh.conformance import check
    >>> result = check("exactmesh", max_examples=5, max_size=8)
    >>> result.ok, str(result.outcome("delaunay"))
    (True, 'holds')
    """
    from exactmesh.conformance.families import families
    from exactmesh.conformance.hunt import explore, smallest

    task = _task_of(kind)
    laws = _laws_of(task, properties)
    check_counts(max_examples=max_examples, max_size=max_size)
    check_seconds("deadline", deadline, most=math.inf)
    check_integer("seed", seed)
    reference, known = resolved(mesher, task)
    name = name_of(mesher, reference)
    listed = orientation or (known.orientation if known else "ccw")
    sources = families(task, max_size)
    tell = progress or (lambda _what, _done, _total: None)
    steps = len(sources) + len(laws)
    with MesherProcess(reference, _limits(timeout, memory), segments=task is not Task.POINTS) as process:
        process.warm_up()
        _warm_up()
        clock, trial = Clock(deadline), Trial(process, task, listed)
        exploring, complete = clock.part(_EXPLORING), True
        for done, (family, strategy) in enumerate(sources.items()):
            tell(family.replace("_", " "), done, steps)
            part = exploring.part(1 / (len(sources) - done))
            complete = explore(trial, family, strategy, part, max_examples, seed) and complete
        broken = [law for law in laws if trial.worst(law)]
        evidence: dict[Law, Evidence | None] = dict.fromkeys(laws)
        for done, law in enumerate(broken):
            tell(f"shrinking what breaks {law}", len(sources) + done, len(sources) + len(broken))
            trial.clock = clock.part(1 / (len(broken) - done))
            evidence[law] = smallest(trial, law, sources, max_examples, seed)
    rulings = _rulings(name, task, trial, evidence)
    return Conformance(name, task, rulings, trial.tried, process.restarts, complete)


def retry(
    mesher: Mesher,
    points: npt.ArrayLike,
    segments: npt.ArrayLike | None = None,
    *,
    kind: Task | str | None = None,
    properties: Collection[Law | str] | None = None,
    source: str = "",
    timeout: float = Limits.seconds,
    memory: int = Limits.memory,
    orientation: str | None = None,
) -> Conformance:
    """Put a mesher to the test on one input, as :func:`check` does on many. It needs no hypothesis.

    >>> from exactmesh.conformance import retry
    >>> retry("exactmesh", [(0, 0), (1, 0), (1, 1), (0, 1)]).ok
    True
    """
    given = Given.of(points, segments)
    task = _task_of(kind or (Task.POINTS if segments is None else Task.SEGMENTS))
    laws = _laws_of(task, properties)
    check_legal(task, given)
    reference, known = resolved(mesher, task)
    name = name_of(mesher, reference)
    with MesherProcess(reference, _limits(timeout, memory), segments=task is not Task.POINTS) as process:
        trial = Trial(process, task, orientation or (known.orientation if known else "ccw"))
        trial.clock, trial.source = Clock(math.inf), source
        trial.judgement(given)
    evidence = {law: next(iter(trial.worst(law)), None) for law in laws}
    return Conformance(name, task, _rulings(name, task, trial, evidence), trial.tried, process.restarts, True)


def _limits(timeout: float, memory: int) -> Limits:
    check_seconds("timeout", timeout, most=sys.float_info.max)
    check_counts(memory=memory)
    return Limits(seconds=timeout, memory=memory)


def _rulings(name: str, task: Task, trial: Trial, evidence: Mapping[Law, Evidence | None]) -> dict[Law, Ruling]:
    silent = evidence.get(Behaviour.ANSWERS)
    rulings: dict[Law, Ruling] = {}
    for law, found in evidence.items():
        judged = trial.judged.get(law, 0)
        if found is not None:
            example = Counterexample(name, task, found.given, found.fault.sentence, found.source)
            rulings[law] = Ruling(law, found.fault.outcome, judged, example)
        else:  # what never answers keeps no law
            rulings[law] = Ruling(law, silent.fault.outcome if silent and not judged else Outcome.HOLDS, judged)
    return rulings


def _warm_up() -> None:
    """Let the verifier compile, which takes a minute, before the clock is started."""
    corners, halves = [(0, 0), (3, -1), (6, 0), (3, 1)], [(0, 1, 2), (0, 2, 3)]
    for triangles in (halves, halves[1:], [*halves, (0, 1, 3)]):
        verify(corners, triangles, segments=[(0, 2), (1, 3)])
    verify(corners, halves, domain=PSLG(corners, [(0, 1), (1, 2), (2, 3), (3, 0)]))


def _task_of(kind: Task | str) -> Task:
    if kind not in tuple(Task):
        raise ChoiceError(f"kind={kind!r}; choose from {', '.join(Task)}")
    return Task(kind)


def _laws_of(task: Task, properties: Collection[Law | str] | None) -> tuple[Law, ...]:
    """Return the laws that are of interest; whether it answers at all always is."""
    if properties is None:
        return LAWS[task]
    if not isinstance(properties, Collection):
        raise OptionError(f"properties={properties!r} is no list of laws")
    names = [str(name).replace("-", "_") for name in ((properties,) if isinstance(properties, str) else properties)]
    for name in names:
        if name not in LAWS[task]:
            raise ChoiceError(f"{name!r} is not asked of a mesher of {task}; choose from {', '.join(LAWS[task])}")
    return tuple(law for law in LAWS[task] if law in names or law is Behaviour.ANSWERS)
