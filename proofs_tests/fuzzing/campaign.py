"""Targets one after another, until the time of each is up."""

import importlib.util
import json
import os
import re
import select
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Self

from proofs_tests.fuzzing.findings import known, written
from proofs_tests.fuzzing.judging import Breach, Target

from exactmesh.errors import ExactMeshError

__all__ = ["AtherisUnavailableError", "Campaign", "Outcome", "require_atheris"]

_STATUS = re.compile(r"^#(\d+)\s.*\bcov: (\d+) ft: (\d+) corp: (\d+)", re.MULTILINE)
_RESTARTS = 20
_LIMITS = ("-timeout=120", "-rss_limit_mb=4000", "-print_final_stats=1")
_LENGTH = 4096


class AtherisUnavailableError(ExactMeshError, ImportError):
    """atheris, which finds inputs that reach new lines, is not installed."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of one target: inputs tried, edges of the control flow reached, inputs kept, files of findings."""

    target: str
    executions: int
    edges: int
    corpus: int
    seconds: float
    findings: tuple[Path, ...]


def require_atheris() -> None:
    """Say how to install what is missing.

    Raises:
        AtherisUnavailableError: it is.
    """
    if importlib.util.find_spec("atheris") is None:
        raise AtherisUnavailableError("fuzzing needs atheris, which is not installed: pip install 'exactmesh[fuzz]'")


class Campaign:
    """A process in which targets run, and the folder where findings go."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        memory = Path("/dev/shm")
        self._place = tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None)
        environment = {**os.environ, "NUMBA_DISABLE_JIT": "1", "TMPDIR": self._place.name}
        command = [sys.executable, "-m", "proofs_tests.fuzzing.nursery"]
        pipe, nothing = subprocess.PIPE, subprocess.DEVNULL
        self._nursery = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=nothing, env=environment)
        self._wait(lambda: None)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        assert self._nursery.stdin is not None
        if error is not None:
            self._nursery.kill()
        self._nursery.stdin.close()
        self._nursery.wait()
        self._place.cleanup()

    def fuzzed(self, target: Target, seconds: float, tick: Callable[[float], None]) -> Outcome:
        """Fuzz one target for so long; ``tick`` is told how much of the time is over."""
        corpus = self.folder / "corpus" / target.name
        corpus.mkdir(parents=True, exist_ok=True)
        for number, seed in enumerate(target.seeds()):
            (corpus / f"seed-{number}").write_bytes(seed)
        before = set(self.folder.glob(f"{target.name}-*.bin"))
        start, executions, edges, kept, log = time.monotonic(), 0, 0, 0, ""
        for _ in range(_RESTARTS):
            left = seconds - (time.monotonic() - start)
            if left < 1:
                break
            log = self._run(target, int(left), corpus, lambda: tick(min(time.monotonic() - start, seconds)))
            rows = _STATUS.findall(log)
            if not rows:
                break
            executions += int(rows[-1][0])
            edges, kept = max(edges, int(rows[-1][1])), int(rows[-1][3])
        findings = tuple(sorted(set(self.folder.glob(f"{target.name}-*.bin")) - before))
        if not (executions or findings):
            raise RuntimeError(f"{target.name}: nothing was tried; libFuzzer says: {log[-1000:]}")
        return Outcome(target.name, executions, edges, kept, time.monotonic() - start, findings)

    def _run(self, target: Target, seconds: int, corpus: Path, tick: Callable[[], None]) -> str:
        """Run libFuzzer once; if that ends by a crash, write the input down as a finding. Return what it said."""
        with tempfile.TemporaryDirectory(dir=self._place.name) as name:
            place = Path(name)
            words, log = place / "words", place / "log"
            words.write_text("".join(f'"{_escaped(word)}"\n' for word in target.words if word), encoding="ascii")
            given = [
                f"-max_total_time={seconds}",
                f"-artifact_prefix={place}/",
                f"-max_len={max(_LENGTH, *(2 * len(seed) for seed in target.seeds()))}",  # what is longer is cut off
                *_LIMITS,
                *([f"-dict={words}"] if words.stat().st_size else []),  # an empty one is an error
                str(corpus),
            ]
            assert self._nursery.stdin is not None
            self._nursery.stdin.write(json.dumps([target.name, str(self.folder), str(log), given]).encode() + b"\n")
            self._nursery.stdin.flush()
            self._wait(tick)
            said = log.read_text(encoding="utf-8", errors="replace")
            for artifact in sorted(place.glob("*-*")):
                kind = artifact.name.partition("-")[0]
                breach = Breach(kind, "the process", said[-300:])
                if kind in ("crash", "timeout", "oom") and breach.signature not in known(self.folder, target.name):
                    written(self.folder, target.name, artifact.read_bytes(), breach)
            return said

    def _wait(self, tick: Callable[[], None]) -> None:
        """Wait for a line of the process."""
        answers = self._nursery.stdout
        assert answers is not None
        while not select.select([answers], [], [], 0.2)[0]:
            tick()
        if not answers.readline():
            raise RuntimeError("the process of the targets has ended: try python -m proofs_tests.fuzzing.nursery")


def _escaped(word: bytes) -> str:
    return "".join(chr(b) if 32 <= b < 127 and b not in b'"\\' else f"\\x{b:02x}" for b in word)
