"""Each mesher in a process of its own: it may crash, hang or run out of memory, and the table goes on."""

import multiprocessing
import resource
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from statistics import median
from typing import Any

from benchmarks.constraining import CONSTRAINERS
from benchmarks.diagrams import DIAGRAMS, USES
from benchmarks.graphs import GRAPHS, graph_of
from benchmarks.inputs import points_of
from benchmarks.peers import PEERS, Mesher, version_of
from benchmarks.refining import CALLBACKS, REFINERS
from benchmarks.refining_cases import CASES, case_of
from benchmarks.verifying import CONSTRAINED_VERIFIERS, VERIFIERS

__all__ = ["Outcome", "race"]

_LIMIT_SECONDS = 60.0  # for one call, after which a mesher is out of the race
_START_SECONDS = 300.0  # for the start, with compilation, conversions and warming up
_DESCRIBE_SECONDS = 600.0  # for one more call, and looking at what comes out


@dataclass
class Outcome:
    """What one mesher did with one input.

    Attributes:
        seconds: of each round.
        count: what the timed call returned, how many triangles for a mesher.
        bytes_per_point: growth of the process's peak memory over the first full run.
        failure: why there are no times, or "".
        description: what came out, for meshers that tell.
    """

    seconds: list[float] = field(default_factory=list)
    count: int = 0
    bytes_per_point: float = 0.0
    failure: str = ""
    description: list[str] = field(default_factory=list)

    @property
    def median(self) -> float:
        """The median time in seconds."""
        return median(self.seconds)


def _mesher(key: str) -> Mesher:
    return {**PEERS, **VERIFIERS, **CONSTRAINERS, **REFINERS, **CALLBACKS, **DIAGRAMS, **USES, **CONSTRAINED_VERIFIERS}[
        key
    ]


def _input(name: str, size: int | None) -> Any:
    if name in CASES:
        return case_of(name, size)
    return graph_of(name, size) if name in GRAPHS else points_of(name, size)


def _serve(pipe: Connection, key: str, name: str, size: int | None) -> None:
    """Prepare the input, warm up on a small one, then run once for each message."""
    mesher = _mesher(key)
    try:
        mesher.run(mesher.prepare(_input(name, 400)))
        given = _input(name, size)
        points = getattr(given, "points", given)
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        prepared = mesher.prepare(given)
        pipe.send("ready")
        while True:
            if pipe.recv() == "describe":
                pipe.send(mesher.describe(prepared) if mesher.describe else [])
                continue
            start = time.perf_counter()
            count = mesher.run(prepared)
            seconds = time.perf_counter() - start
            peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
            pipe.send((seconds, count, (peak - before) * 1024 / len(points)))
    except Exception as error:
        pipe.send(f"{type(error).__name__}: {str(error).splitlines()[0] if str(error) else ''}"[:80])


class _Worker:
    def __init__(self, key: str, name: str, size: int | None) -> None:
        self.outcome = Outcome()
        if version_of(_mesher(key).package) == "missing":
            self.outcome.failure = "not installed"
            return
        context = multiprocessing.get_context("spawn")
        self._pipe, other = context.Pipe()
        self._process = context.Process(target=_serve, args=(other, key, name, size), daemon=True)
        self._process.start()
        other.close()
        self._answer(_START_SECONDS)

    def _answer(self, limit: float = _LIMIT_SECONDS) -> object:
        try:
            if not self._pipe.poll(limit):
                self._process.kill()
                self.outcome.failure = f"over {limit:.0f} s"
                return None
            answer: object = self._pipe.recv()
        except (EOFError, ConnectionResetError):
            self._process.join()
            self.outcome.failure = f"died, exit code {self._process.exitcode}"
            return None
        if isinstance(answer, str) and answer != "ready":
            self.outcome.failure = answer
        return answer

    def run(self) -> None:
        """Time one call."""
        if self.outcome.failure:
            return
        self._pipe.send("run")
        answer = self._answer()
        if isinstance(answer, tuple):
            seconds, self.outcome.count, bytes_per_point = answer
            if not self.outcome.seconds:
                self.outcome.bytes_per_point = bytes_per_point
            self.outcome.seconds.append(seconds)

    def describe(self) -> None:
        """Let the mesher tell what comes out."""
        if not self.outcome.failure:
            self._pipe.send("describe")
            answer = self._answer(_DESCRIBE_SECONDS)
            self.outcome.failure = ""  # the times stay
            if isinstance(answer, list):
                self.outcome.description = answer

    def stop(self) -> None:
        """End the process."""
        if hasattr(self, "_process"):
            self._process.kill()
            self._process.join()


def race(keys: Sequence[str], name: str, *, size: int | None = None, rounds: int = 5) -> dict[str, Outcome]:
    """Let the meshers take turns on one input, round after round: a slow moment of the machine hits them all."""
    workers = {key: _Worker(key, name, size) for key in keys}
    for _ in range(rounds):
        for worker in workers.values():
            worker.run()
    for worker in workers.values():
        worker.describe()
        worker.stop()
    return {key: worker.outcome for key, worker in workers.items()}
