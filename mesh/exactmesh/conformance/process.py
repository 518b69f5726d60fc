"""A mesher in a process of its own, seen from outside: asked, waited for, killed, started again."""

import contextlib
import os
import pickle
import queue
import signal
import subprocess
import sys
import threading
from collections import deque
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np

from exactkernel.types import FloatArray
from exactmesh.conformance.child import IN_CHILD
from exactmesh.conformance.given import Given, IndexArray
from exactmesh.errors import MesherError

__all__ = ["Answer", "Fate", "Limits", "MesherProcess"]

_CHILD = Path(__file__).with_name("child.py")
_LAST_LINES = 20  # of what a mesher printed, kept for when it dies
_SQUARE = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
_RING = np.array([(0, 1), (1, 2), (2, 3), (3, 0)])


class Fate(StrEnum):
    """What became of one call."""

    ANSWERED = "answered"
    NO_MESH = "no_mesh"
    REFUSED = "refused"
    DIED = "died"
    HUNG = "hung"


@dataclass(frozen=True, slots=True, eq=False)
class Answer:
    """What a mesher made of one input.

    Attributes:
        fate: what became of the call.
        message: for all but ``ANSWERED``, what happened: the exception, the signal, the seconds.
        points: (n, 2) float64 where the mesher returned points of its own, else None.
        triangles: (m, 3) int64.
        orientation: "ccw" or "any", where the type of mesh says how triangles are listed in it.
        kept: the arrays that were given are as before.
        repeats: asked twice, it answered the same.
    """

    fate: Fate
    message: str = ""
    points: FloatArray | None = None
    triangles: IndexArray | None = None
    orientation: str | None = None
    kept: bool = True
    repeats: bool = True


@dataclass(frozen=True)
class Limits:
    """What one call may take.

    Attributes:
        seconds: after which a mesher hangs.
        start_seconds: for importing it, and for its first call, in which it may compile.
        memory: bytes of address space.
    """

    seconds: float = 10.0
    start_seconds: float = 120.0
    memory: int = 4 << 30


class MesherProcess:
    """One mesher, asked about one input after the other; a new process takes over from one that died.

    Args:
        reference: "module:function" or "file.py:function".
        limits: of time and memory.
        segments: whether it takes segments as well.

    Raises:
        MesherError: the mesher cannot be imported, or this already is such a process.
    """

    def __init__(self, reference: str, limits: Limits = Limits(), *, segments: bool = False) -> None:
        if os.environ.get(IN_CHILD):
            raise MesherError(
                "the mesher's own process asks for its conformance: put the call under if __name__ == '__main__'"
            )
        self.reference, self.limits = reference, limits
        self._warm_up: Given | None = Given(_SQUARE, _RING if segments else None)
        self._child: subprocess.Popen[bytes] | None = None
        self.restarts = -1
        self._threads: list[threading.Thread] = []

    def __enter__(self) -> "MesherProcess":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def warm_up(self) -> None:
        """Start the process, and let the mesher compile in a first call, of which nothing is told."""
        warm_up, self._warm_up = self._warm_up, None
        if warm_up is not None:
            self._call(warm_up, self.limits.start_seconds)

    def ask(self, given: Given) -> Answer:
        """Return what the mesher makes of the input, asked twice."""
        self.warm_up()
        first = self._call(given, self.limits.seconds)
        if first.fate is not Fate.ANSWERED:
            return first
        second = self._call(given, self.limits.seconds)
        if second.fate in (Fate.DIED, Fate.HUNG):
            return replace(second, message=f"asked a second time, it {second.message}")
        return replace(first, repeats=_same(first, second))

    def close(self) -> None:
        """End the process."""
        child, self._child = self._child, None
        if child is None:
            return
        with contextlib.suppress(ProcessLookupError, PermissionError):
            if hasattr(os, "killpg"):
                os.killpg(child.pid, signal.SIGKILL)  # and what it started
            else:
                child.kill()
        child.wait()
        for thread in self._threads:
            thread.join()
        for pipe in (child.stdin, child.stdout, child.stderr):
            if pipe is not None:
                with contextlib.suppress(OSError):
                    pipe.close()

    def _start(self) -> None:
        self.restarts += 1
        self._child = subprocess.Popen(
            [sys.executable, "-P", str(_CHILD)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,
        )
        self._answers: queue.SimpleQueue[dict[str, Any] | None] = queue.SimpleQueue()
        self._printed: deque[str] = deque(maxlen=_LAST_LINES)
        self._threads = [
            threading.Thread(target=_listen, args=(self._child.stdout, self._answers), daemon=True),
            threading.Thread(target=_remember, args=(self._child.stderr, self._printed), daemon=True),
        ]
        for thread in self._threads:
            thread.start()
        self._send({"path": sys.path, "memory": self.limits.memory, "reference": self.reference})
        answer = self._receive(self.limits.start_seconds)
        if answer.get("fate") != "ready":
            self.close()
            told = "importing it " + answer["message"] if answer["fate"] in ("died", "hung") else answer["message"]
            raise MesherError(f"{self.reference}: {told}")

    def _send(self, question: object) -> None:
        assert self._child is not None
        assert self._child.stdin is not None
        with contextlib.suppress(OSError):  # it has died: there will be no answer
            pickle.dump(question, self._child.stdin, protocol=pickle.HIGHEST_PROTOCOL)
            self._child.stdin.flush()

    def _receive(self, seconds: float) -> dict[str, Any]:
        assert self._child is not None
        try:
            answer = self._answers.get(timeout=seconds)
        except queue.Empty:
            self.close()
            return {"fate": "hung", "message": f"did not return within {seconds:g} s"}
        if answer is not None:
            return answer
        child = self._child
        code = child.wait()
        self.close()
        last = next((line for line in reversed(self._printed) if line.strip()), "")
        return {"fate": "died", "message": _ending(code) + (f": {last.strip()}" if last else "")}

    def _call(self, given: Given, seconds: float) -> Answer:
        if self._child is None:
            self._start()
        self._send(((given.points,) if given.segments is None else (given.points, given.segments), seconds))
        answer = self._receive(seconds)
        return Answer(
            Fate(answer["fate"]),
            answer["message"],
            answer.get("points"),
            answer.get("triangles"),
            answer.get("orientation"),
            answer.get("kept", True),
        )


def _same(first: Answer, second: Answer) -> bool:
    pairs = ((first.points, second.points), (first.triangles, second.triangles))
    return all((a is None) == (b is None) and (a is None or _equal(a, b)) for a, b in pairs)


def _equal(a: FloatArray | IndexArray, b: FloatArray | IndexArray | None) -> bool:
    return b is not None and a.shape == b.shape and a.tobytes() == b.tobytes()


def _ending(code: int) -> str:
    if code >= 0:
        return f"ended the process with exit code {code}"
    try:
        return f"ended the process by {signal.Signals(-code).name}"
    except ValueError:
        return f"ended the process by signal {-code}"


def _listen(pipe: Any, answers: "queue.SimpleQueue[dict[str, Any] | None]") -> None:
    try:
        while True:
            answers.put(pickle.load(pipe))
    except Exception:  # it is closed, or what came is cut off: either way it will say no more
        answers.put(None)


def _remember(pipe: Any, printed: "deque[str]") -> None:
    with contextlib.suppress(ValueError, OSError):
        for line in iter(lambda: pipe.readline(1 << 12), b""):
            printed.append(line.decode(errors="replace"))
