"""Targets one after another, each in processes of its own, until its time is up."""

import importlib.util
import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from exactmesh.errors import ExactMeshError
from proofs_tests.fuzzing.findings import known, written
from proofs_tests.fuzzing.judging import Breach, Target

__all__ = ["AtherisUnavailableError", "Outcome", "fuzzed", "require_atheris"]

_STATUS = re.compile(r"^#(\d+)\s.*\bcov: (\d+) ft: (\d+) corp: (\d+)", re.MULTILINE)
_RESTARTS = 20
_LIMITS = ("-timeout=60", "-rss_limit_mb=4000", "-print_final_stats=1", "-max_len=4096", "-verbosity=1")


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


def fuzzed(target: Target, seconds: float, folder: Path, tick: Callable[[float], None]) -> Outcome:
    """Fuzz one target for so long; ``tick`` is told how much of the time is over."""
    corpus = folder / "corpus" / target.name
    corpus.mkdir(parents=True, exist_ok=True)
    for number, seed in enumerate(target.seeds()):
        (corpus / f"seed-{number}").write_bytes(seed)
    before = set(folder.glob(f"{target.name}-*.bin"))
    start, executions, edges, kept = time.monotonic(), 0, 0, 0
    for _ in range(_RESTARTS):
        left = seconds - (time.monotonic() - start)
        if left < 1:
            break
        log = _run(target, int(left), folder, corpus, lambda: tick(min(time.monotonic() - start, seconds)))
        rows = _STATUS.findall(log)
        if not rows:
            raise RuntimeError(f"libFuzzer did not run: {log[-2000:]}")
        executions += int(rows[-1][0])
        edges, kept = max(edges, int(rows[-1][1])), int(rows[-1][3])
    findings = tuple(sorted(set(folder.glob(f"{target.name}-*.bin")) - before))
    return Outcome(target.name, executions, edges, kept, time.monotonic() - start, findings)


def _run(target: Target, seconds: int, folder: Path, corpus: Path, tick: Callable[[], None]) -> str:
    """Run libFuzzer once; if that ends by a crash, write the input down as a finding. Return what it said."""
    memory = Path("/dev/shm")
    with tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None) as place:
        words = Path(place) / "words"
        words.write_text("".join(f'"{_escaped(word)}"\n' for word in target.words if word), encoding="ascii")
        log = Path(place) / "log"
        arguments = [
            f"-max_total_time={seconds}",
            f"-artifact_prefix={place}/",
            f"-dict={words}",
            *_LIMITS,
            str(corpus),
        ]
        environment = {**os.environ, "NUMBA_DISABLE_JIT": "1", "TMPDIR": place}
        command = [sys.executable, "-m", "proofs_tests.fuzzing.child", target.name, str(folder), *arguments]
        with log.open("wb") as stream:
            child = subprocess.Popen(command, stdout=stream, stderr=stream, env=environment)
            try:
                while child.poll() is None:
                    time.sleep(0.2)
                    tick()
            finally:
                child.kill()
        said = log.read_text(encoding="utf-8", errors="replace")
        for artifact in sorted(Path(place).glob("*-*")):
            kind = artifact.name.partition("-")[0]
            breach = Breach(kind, "the process", said[-300:])
            if (
                artifact.is_file()
                and kind in ("crash", "timeout", "oom")
                and breach.signature not in known(folder, target.name)
            ):
                written(folder, target.name, artifact.read_bytes(), breach)
        return said


def _escaped(word: bytes) -> str:
    return "".join(chr(b) if 32 <= b < 127 and b not in b'"\\' else f"\\x{b:02x}" for b in word)
