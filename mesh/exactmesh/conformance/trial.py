"""One mesher on trial: every input is tried once, and what it said is kept."""

import math
import time
from dataclasses import dataclass

from exactmesh.conformance.given import Given
from exactmesh.conformance.judge import Fault, Judgement, check_legal, judged
from exactmesh.conformance.laws import Law, Outcome, Task, is_worse
from exactmesh.conformance.process import Fate, MesherProcess
from exactmesh.errors import ExactMeshError

__all__ = ["Clock", "Evidence", "Trial"]


class Clock:
    """A budget of seconds, of which parts can be handed out."""

    def __init__(self, seconds: float) -> None:
        self.end = time.monotonic() + seconds

    @property
    def left(self) -> float:
        """Seconds, not below 0."""
        return max(0.0, self.end - time.monotonic())

    def part(self, share: float) -> "Clock":
        """Return a clock for a share of what is left."""
        return Clock(self.left * share)


@dataclass(frozen=True, slots=True)
class Evidence:
    """An input on which a law is broken, and the family that it belongs to."""

    law: Law
    fault: Fault
    given: Given
    source: str


class Trial:
    """A mesher, its task, and all that was found out.

    ``judgement`` tries each input once: hypothesis asks again and again, and may be told nothing else, or it would call
    the mesher flaky. After the budget is spent nothing new is tried.
    """

    def __init__(self, process: MesherProcess, task: Task, orientation: str) -> None:
        self._process, self._task, self._orientation = process, task, orientation
        self._known: dict[bytes, Judgement] = {}
        self.clock = Clock(0.0)
        self.source, self._patience, self._hung = "", math.inf, 0
        self._worst: dict[Law, list[Evidence]] = {}
        self.judged: dict[Law, int] = {}

    @property
    def tried(self) -> int:
        """How many different inputs the mesher was given."""
        return len(self._known)

    def begin(self, source: str, clock: Clock, *, patience: float = math.inf) -> None:
        """Go on to another family of inputs, for so long, and until the mesher hung so often."""
        self.source, self.clock, self._patience, self._hung = source, clock, patience, 0

    @property
    def patient(self) -> bool:
        """Whether anything new is tried."""
        return bool(self.clock.left) and self._hung < self._patience

    def judgement(self, given: Given) -> Judgement:
        """Return what the mesher's answer says; nothing where the budget is spent."""
        found = self._known.get(given.key)
        if found is not None:
            return found
        if not self.patient:
            return {}
        answer = self._process.ask(given)
        found = judged(self._task, given, answer, self._orientation)
        self._known[given.key] = found
        self._hung += answer.fate is Fate.HUNG
        for law, fault in found.items():
            self.judged[law] = self.judged.get(law, 0) + 1
            if fault is not None:
                self._keep(Evidence(law, fault, given, self.source))
        return found

    def outcome(self, given: Given, law: Law) -> Outcome:
        """Return what one input says about one law."""
        fault = self.judgement(given).get(law)
        return Outcome.HOLDS if fault is None else fault.outcome

    def is_legal(self, given: Given) -> bool:
        """Tell whether the mesher may be asked this."""
        try:
            check_legal(self._task, given)
        except ExactMeshError:
            return False
        return True

    def worst(self, law: Law) -> list[Evidence]:
        """Return the evidence for the worst outcome of a law, smallest input first."""
        return sorted(self._worst.get(law, ()), key=lambda evidence: evidence.given.size)

    def _keep(self, evidence: Evidence) -> None:
        kept = self._worst.setdefault(evidence.law, [])
        if kept and is_worse(evidence.fault.outcome, kept[0].fault.outcome):
            kept.clear()
        if not kept or kept[0].fault.outcome is evidence.fault.outcome:
            kept.append(evidence)
