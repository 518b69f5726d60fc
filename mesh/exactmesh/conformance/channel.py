"""The pipes to a mesher's process: nothing that becomes of them, or of it, can block who asks.

Each pipe is served by a thread of its own, which also closes it. A process that the mesher started, in a session of its
own perhaps, may hold the other end open for as long as it likes: then the thread is left to wait, and nobody else is.
"""

import contextlib
import os
import pickle
import queue
import signal
import subprocess
import sys
import threading
import time
from collections import deque
from pathlib import Path
from typing import IO, Any

from exactmesh.conformance.child import MARK

__all__ = ["Channel", "EndedError", "SilentError"]

_CHILD = Path(__file__).with_name("child.py")
_LAST_LINES = 20  # of what a mesher printed, kept for when it dies
_TICK = 0.05  # seconds after which it is looked whether the process lives, while it says nothing
_LEAVE = 1.0  # seconds for a thread to read what an ended process had said, and to leave


class EndedError(Exception):
    """The process has ended, or can say no more; the message says how."""


class SilentError(Exception):
    """There was no answer in time; the process is killed."""


class Channel:
    """A process that runs ``child.py``, questions to it and answers from it, both pickled."""

    def __init__(self) -> None:
        self._child = subprocess.Popen(
            [sys.executable, "-P", str(_CHILD)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,
        )
        self._questions: queue.SimpleQueue[object] = queue.SimpleQueue()
        self._answers: queue.SimpleQueue[dict[str, Any] | None] = queue.SimpleQueue()
        self._printed: deque[str] = deque(maxlen=_LAST_LINES)
        self._threads = [
            threading.Thread(target=_speak, args=(self._child.stdin, self._questions), daemon=True),
            threading.Thread(target=_listen, args=(self._child.stdout, self._answers), daemon=True),
            threading.Thread(target=_remember, args=(self._child.stderr, self._printed), daemon=True),
        ]
        for thread in self._threads:
            thread.start()

    def ask(self, question: object, seconds: float) -> dict[str, Any]:
        """Return the answer.

        Raises:
            EndedError, SilentError: there is none; the channel is closed then.
        """
        self._questions.put(question)
        answer = self._received(time.monotonic() + seconds)
        if answer is not None:
            return answer
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._child.wait(_LEAVE)
        code = self._child.poll()
        self.close()
        if code is None:
            raise EndedError("closed the pipe that its answers go through, or wrote into it")
        last = next((line for line in reversed(self._printed) if line.strip()), "")
        raise EndedError(_ending(code) + (f": {last.strip()}" if last else ""))

    def close(self) -> None:
        """End the process, and what it started in its session."""
        self._kill()
        self._child.wait()
        self._questions.put(None)
        for thread in self._threads:
            thread.join(_LEAVE)

    def _received(self, end: float) -> dict[str, Any] | None:
        """Return an answer, or None if there will be none because the process has ended."""
        while True:
            left = end - time.monotonic()
            try:
                return self._answers.get(timeout=min(_TICK, max(0.0, left)))
            except queue.Empty:
                pass
            if _has_ended(self._child):
                break
            if left <= 0:
                self.close()
                raise SilentError
        self._kill()  # a fork of it would hold the pipe open
        try:
            return self._answers.get(timeout=_LEAVE)
        except queue.Empty:
            return None

    def _kill(self) -> None:
        with contextlib.suppress(ProcessLookupError, PermissionError):
            if self._child.returncode is not None:
                return  # its number may be another's by now
            if hasattr(os, "killpg"):
                os.killpg(self._child.pid, signal.SIGKILL)  # and what it started
            else:
                self._child.kill()


def _has_ended(child: "subprocess.Popen[bytes]") -> bool:
    """Tell whether the process has ended, and leave its number to it where that is possible."""
    if hasattr(os, "waitid"):
        return os.waitid(os.P_PID, child.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None
    return child.poll() is not None


def _ending(code: int) -> str:
    if code >= 0:
        return f"ended the process with exit code {code}"
    try:
        return f"ended the process by {signal.Signals(-code).name}"
    except ValueError:
        return f"ended the process by signal {-code}"


def _speak(pipe: IO[bytes], questions: "queue.SimpleQueue[object]") -> None:
    with contextlib.suppress(OSError), pipe:  # it has died: there will be no answer
        for question in iter(questions.get, None):
            pickle.dump(question, pipe, protocol=pickle.HIGHEST_PROTOCOL)
            pipe.flush()


def _listen(pipe: IO[bytes], answers: "queue.SimpleQueue[dict[str, Any] | None]") -> None:
    with contextlib.suppress(OSError), pipe:
        try:
            while pipe.read(len(MARK)) == MARK:
                answers.put(pickle.loads(pipe.read(int.from_bytes(pipe.read(8), "big"))))
        except Exception:  # what came is cut off
            pass
        answers.put(None)  # whatever comes then, it will say no more


def _remember(pipe: IO[bytes], printed: "deque[str]") -> None:
    with contextlib.suppress(OSError), pipe:
        for line in iter(lambda: pipe.readline(1 << 12), b""):
            printed.append(line.decode(errors="replace"))
