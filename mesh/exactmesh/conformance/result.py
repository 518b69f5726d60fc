"""What a conformance run found: a verdict for each law, and the smallest input that breaks it, ready to copy."""

from collections.abc import Mapping
from dataclasses import dataclass

from exactmesh.conformance.given import Given
from exactmesh.conformance.laws import Law, Outcome, Task

__all__ = ["Conformance", "Counterexample", "Ruling"]


@dataclass(frozen=True, slots=True, eq=False)
class Counterexample:
    """An input on which a law is broken, the smallest that was found.

    Attributes:
        mesher: as it was asked for.
        task: what it was asked to do.
        given: the input.
        sentence: what the verifier, or the process, says about it.
        source: the family of inputs it was found in, or the case of the corpus.
    """

    mesher: str
    task: Task
    given: Given
    sentence: str
    source: str = ""

    @property
    def command(self) -> str:
        """A line for the shell that tries this input again; Python for a mesher that has no name there."""
        task = "" if self.task is Task.POINTS else f" --{self.task}"
        given = self.source if self.source.startswith("corpus:") else f'"{self.given.literal}"'
        if self._is_nameless:
            star = "" if self.given.segments is None else "*"
            return f"retry(mesher, {star}{self.given.literal}{self._kind})"
        return f"exactmesh conformance {self.mesher}{task} --input {given}"

    @property
    def _kind(self) -> str:
        return "" if self.task is Task.POINTS else f", kind={str(self.task)!r}"

    @property
    def _is_nameless(self) -> bool:
        return self.mesher.startswith("<")  # a lambda, or what was defined within a function

    @property
    def code(self) -> str:
        """Python that tries this input again, in a process of its own, and prints what comes of it."""
        if self.source.startswith("corpus:"):
            imported, lines = "case_named, retry", [f"given = case_named({self.source[7:]!r}).make()"]
            arguments = ["given.points", "given.segments"]
        else:
            points = ", ".join(f"({x!r}, {y!r})" for x, y in self.given.points.tolist())
            imported, lines = "retry", [f"points = [{points}]"]
            arguments = ["points", "segments"]
            if self.given.segments is not None:
                lines.append(f"segments = [{', '.join(f'({a}, {b})' for a, b in self.given.segments.tolist())}]")
        told = ", ".join(
            [
                "mesher" if self._is_nameless else repr(self.mesher),
                *arguments[: 1 if self.given.segments is None else 2],
            ]
        )
        return "\n".join(
            [f"from exactmesh.conformance import {imported}", "", *lines, f"print(retry({told}{self._kind}))"]
        )


@dataclass(frozen=True, slots=True, eq=False)
class Ruling:
    """The verdict on one law.

    Attributes:
        law: a behaviour, or a property of the verifier.
        outcome: the worst that was found.
        judged: on how many inputs.
        counterexample: the smallest input with that outcome; None where the law holds, or where nothing could be
            judged because no call returned: see the ruling on ``ANSWERS``.
    """

    law: Law
    outcome: Outcome
    judged: int
    counterexample: Counterexample | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Conformance:
    """The verdicts on a mesher.

    Attributes:
        mesher: as it was asked for.
        task: what it was asked to do.
        rulings: one for each law, in order.
        tried: how many different inputs it was given.
        restarts: how often it had to be started again.
        complete: False where the time ran out before every family of inputs had its turn.
    """

    mesher: str
    task: Task
    rulings: Mapping[Law, Ruling]
    tried: int
    restarts: int
    complete: bool

    @property
    def ok(self) -> bool:
        """True if every law holds."""
        return all(ruling.outcome is Outcome.HOLDS for ruling in self.rulings.values())

    @property
    def ok_but_for_rounding(self) -> bool:
        """True if every law holds, or is broken by no more than doubles resolve."""
        return all(ruling.outcome in (Outcome.HOLDS, Outcome.ROUNDING) for ruling in self.rulings.values())

    def __bool__(self) -> bool:
        return self.ok

    def outcome(self, law: Law | str) -> Outcome:
        """Return the verdict on one law."""
        return next(ruling.outcome for known, ruling in self.rulings.items() if known == str(law).replace("-", "_"))

    def __str__(self) -> str:
        lines = [f"{self.mesher} ({self.task}): {self.tried} inputs tried, {self.restarts} times started again"]
        for law, ruling in self.rulings.items():
            lines.append(f"  {law:<20} {ruling.outcome}")
            if ruling.counterexample is not None:
                lines.append(f"      {ruling.counterexample.sentence}")
                lines.append(f"      {ruling.counterexample.command}")
        return "\n".join(lines)
