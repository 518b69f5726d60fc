"""A mesher in a process of its own, seen from outside: asked, waited for, killed, started again."""

import os
import sys
from dataclasses import dataclass, replace
from enum import StrEnum
from types import TracebackType
from typing import Any

import numpy as np

from exactkernel.types import FloatArray
from exactmesh.conformance.channel import Channel, EndedError, SilentError
from exactmesh.conformance.child import IN_CHILD, PICKLED
from exactmesh.conformance.given import Given, IndexArray
from exactmesh.errors import MesherError

__all__ = ["Answer", "Fate", "Limits", "MesherProcess"]

_SQUARE = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
_RING = np.array([(0, 1), (1, 2), (2, 3), (3, 0)])


class Fate(StrEnum):
    """What became of one call."""

    ANSWERED = "answered"
    NO_MESH = "no_mesh"
    REFUSED = "refused"
    DIED = "died"
    HUNG = "hung"


_LOST = (Fate.DIED, Fate.HUNG)  # and its process with it


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
        start_seconds: for importing it, and for the first call in each process, in which it may compile.
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
        self._first: Given | None = Given(_SQUARE, _RING if segments else None)
        self._channel: Channel | None = None
        self.restarts = -1

    def __enter__(self) -> "MesherProcess":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def warm_up(self) -> None:
        """Start a process if there is none, and let the mesher compile in a first call, of which nothing is told.

        A mesher that does not survive that call is never asked for it again.
        """
        if self._channel is not None:
            return
        self._start()
        if self._first is not None and self._call(self._first, self.limits.start_seconds).fate in _LOST:
            self._first = None

    def ask(self, given: Given) -> Answer:
        """Return what the mesher makes of the input, asked twice."""
        self.warm_up()
        first = self._call(given, self.limits.seconds)
        if first.fate is not Fate.ANSWERED:
            return first
        second = self._call(given, self.limits.seconds)
        if second.fate in _LOST:
            return replace(second, message=f"asked a second time, it {second.message}")
        return replace(first, repeats=_same(first, second))

    def close(self) -> None:
        """End the process."""
        channel, self._channel = self._channel, None
        if channel is not None:
            channel.close()

    def _start(self) -> Channel:
        self.restarts += 1
        self._channel = Channel()
        job = {"path": sys.path, "memory": self.limits.memory, "reference": self.reference}
        answer = self._answer(self._channel, job, self.limits.start_seconds)
        if answer["fate"] != "ready":
            self.close()
            told = "importing it " + answer["message"] if answer["fate"] in _LOST else answer["message"]
            name = "the function" if self.reference.startswith(PICKLED) else self.reference
            raise MesherError(f"{name}: {told}")
        return self._channel

    def _answer(self, channel: Channel, question: object, seconds: float) -> dict[str, Any]:
        try:
            return channel.ask(question, seconds)
        except SilentError:
            self._channel = None
            return {"fate": Fate.HUNG, "message": f"did not return within {seconds:g} s"}
        except EndedError as error:
            self._channel = None
            return {"fate": Fate.DIED, "message": str(error)}

    def _call(self, given: Given, seconds: float) -> Answer:
        channel = self._channel or self._start()
        arrays = (given.points,) if given.segments is None else (given.points, given.segments)
        answer = self._answer(channel, (arrays, seconds), seconds)
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
