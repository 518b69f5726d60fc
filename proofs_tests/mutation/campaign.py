"""Try many mutants side by side, each worker on a copy of the project, and keep what became of them."""

import compileall
import json
import multiprocessing
import os
import random
import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from multiprocessing.queues import Queue
from pathlib import Path
from py_compile import PycInvalidationMode

from proofs_tests.mutation.covering import Covering
from proofs_tests.mutation.mutants import ROOT, Mutant
from proofs_tests.mutation.trial import try_mutants

__all__ = ["Result", "campaign", "read_results"]

_CHUNK = 150


@dataclass(frozen=True)
class Result:
    """What became of a mutant: ``killed`` or ``timeout`` and by which test, ``survived``, or ``uncovered``."""

    mutant: Mutant
    outcome: str
    test: str

    @property
    def alive(self) -> bool:
        """Whether no test noticed the mutant."""
        return self.outcome in ("survived", "uncovered")

    def line(self) -> str:
        """Return the result as a line of JSON."""
        return json.dumps({**asdict(self.mutant), "outcome": self.outcome, "test": self.test})


def read_results(path: Path) -> dict[Mutant, Result]:
    """Read the lines of an earlier campaign; the last one about a mutant counts."""
    results = {}
    for line in path.read_text(encoding="utf-8").splitlines() if path.exists() else ():
        row = json.loads(line)
        outcome, test = row.pop("outcome"), row.pop("test")
        results[Mutant(**row)] = Result(Mutant(**row), outcome, test)
    return results


def campaign(mutants: Sequence[Mutant], covering: Covering, budget: float, processes: int) -> Iterator[Result]:
    """Yield the results as they come."""
    forking = multiprocessing.get_context("fork")  # the workers have imported what takes long to import
    chunks: Queue[list[Mutant] | None] = forking.Queue()
    results: Queue[Result | str] = forking.Queue()
    for chunk in _chunks(mutants):
        chunks.put(chunk)
    with tempfile.TemporaryDirectory() as folder:
        workers = []
        for number in range(processes):
            chunks.put(None)
            tree = _copied(Path(folder) / str(number))
            workers.append(forking.Process(target=_work, args=(tree, covering, budget, chunks, results)))
            workers[-1].start()
        for _ in mutants:
            result = results.get()
            if isinstance(result, str):
                for worker in workers:
                    worker.terminate()
                raise RuntimeError(result)
            yield result
        for worker in workers:
            worker.join()


def _chunks(mutants: Sequence[Mutant]) -> list[list[Mutant]]:
    """Group by file, whose tests are collected once a chunk; in chance order, so that an early end is a sample."""
    files: dict[str, list[Mutant]] = {}
    for mutant in mutants:
        files.setdefault(mutant.file, []).append(mutant)
    chunks = [there[i : i + _CHUNK] for there in files.values() for i in range(0, len(there), _CHUNK)]
    random.Random(1).shuffle(chunks)
    return chunks


def _copied(tree: Path) -> Path:
    for name in ("kernel", "mesh", "proofs_tests", "docs", "benchmarks"):
        shutil.copytree(ROOT / name, tree / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("pyproject.toml", "README.md"):
        shutil.copy(ROOT / name, tree / name)
    compileall.compile_dir(tree, quiet=1, invalidation_mode=PycInvalidationMode.CHECKED_HASH)
    return tree


def _work(
    tree: Path, covering: Covering, budget: float, chunks: "Queue[list[Mutant] | None]", results: "Queue[Result | str]"
) -> None:
    sys.dont_write_bytecode = True
    os.chdir(tree)
    while chunk := chunks.get():
        tests = {mutant: covering.tests(mutant) for mutant in chunk}
        try:
            for mutant, (outcome, test) in try_mutants(tree, chunk, tests, covering.seconds, budget):
                results.put(Result(mutant, outcome, test))
        except RuntimeError as error:
            results.put(str(error))
