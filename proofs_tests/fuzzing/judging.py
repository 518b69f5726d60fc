"""The law that every target obeys, and what a breach of it is."""

import contextlib
import resource
import signal
import threading
import traceback
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from types import FrameType

from exactmesh.errors import ExactMeshError
from exactmesh.triangle import TriangleWarning

__all__ = ["SECONDS", "Breach", "Target", "WrongResultError", "judged", "limited", "require"]

SECONDS = 10.0  # of one input, of the processor's time
_ROOM = 2 << 30  # bytes that one input may ask for
_OURS = ("/exactmesh/", "/exactkernel/", "/fuzzing/")


class WrongResultError(Exception):
    """A result that is wrong: a round trip that changes something, a mesh that its verifier refuses."""


class Hang(BaseException):
    """An input takes too long; nobody catches it by accident."""


def require(condition: object, complaint: str) -> None:
    """Raise :class:`WrongResultError` unless the condition holds."""
    if not condition:
        raise WrongResultError(complaint)


@dataclass(frozen=True, slots=True)
class Target:
    """One reader.

    Attributes:
        name: what it is asked for by.
        run: reads the bytes; raises ExactMeshError for bad ones, WrongResultError where the law is.
        seeds: makes small valid inputs.
        words: what the syntax is made of.
    """

    name: str
    run: Callable[[bytes], None]
    seeds: Callable[[], Sequence[bytes]]
    words: tuple[bytes, ...] = ()


@dataclass(frozen=True, slots=True)
class Breach:
    """An input that breaks the law: which exception, in which line of ours, and what it says."""

    kind: str
    place: str
    message: str

    @property
    def signature(self) -> str:
        """The same for breaches that have the same cause, most likely."""
        return f"{self.kind} at {self.place}"

    @classmethod
    def of(cls, error: BaseException) -> "Breach":
        frames = traceback.extract_tb(error.__traceback__)
        # what a law is demanded by stands in one place: who demands it tells one breach from another
        telling = [frame for frame in frames if not frame.name.startswith("require")]
        ours = [frame for frame in telling if any(room in frame.filename for room in _OURS)] or list(frames)
        place = f"{ours[-1].filename.rpartition('/')[2]}:{ours[-1].lineno}" if ours else "nowhere"
        return cls(type(error).__name__, place, " ".join(str(error).split())[:300])


def judged(target: Target, data: bytes) -> Breach | None:
    """Return how the target breaks the law on these bytes, or None."""
    try:
        with limited(), warnings.catch_warnings():
            warnings.simplefilter("error")
            warnings.simplefilter("ignore", TriangleWarning)
            target.run(data)
    except ExactMeshError as error:
        return None if str(error).strip() else Breach.of(WrongResultError(f"{type(error).__name__} without a word"))
    except (Exception, SystemExit, Hang) as error:
        return Breach.of(error)
    return None


def _too_long(_: int, __: FrameType | None) -> None:
    raise Hang(f"more than {SECONDS:g} s")


@contextlib.contextmanager
def limited() -> Iterator[None]:
    """Bound the time and the memory of what is run; interpreted, that is: compiled code is not interrupted."""
    if threading.current_thread() is not threading.main_thread():
        raise RuntimeError("only the main thread is told of the time")
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (_in_use() + _ROOM, hard))
    before = signal.signal(signal.SIGVTALRM, _too_long)
    signal.setitimer(signal.ITIMER_VIRTUAL, SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


def _in_use() -> int:
    with open("/proc/self/statm", encoding="ascii") as stream:
        return int(stream.read().split()[0]) * resource.getpagesize()
