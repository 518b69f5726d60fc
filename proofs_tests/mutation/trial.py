"""Run the tests of one file's mutants, each mutant in a process of its own.

A process that has imported the libraries, but nothing of ours, forks one that collects the tests; that one forks one
for each mutant. A mutant that is no change of functions alone is imported anew by a fork of the first.
"""

import bisect
import contextlib
import functools
import importlib
import itertools
import json
import os
import resource
import signal
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

import pytest
from proofs_tests.mutation.mutants import Mutant
from proofs_tests.mutation.transplant import transplant

__all__ = ["Outcome", "try_mutants"]

Outcome = tuple[str, str]  # "killed", "timeout", "survived", "uncovered"; and the test that killed it

_SURVIVED, _NOT_A_FUNCTION = "survived", "not a function"
_MEMORY = 8 << 30
_SLOWEST = 120.0
_terminal = os.dup(2)  # pytest's own output goes nowhere


class _Session:
    """A plugin that replaces pytest's loop over the tests."""

    def __init__(self, seconds: Mapping[str, float], loop: Callable[["_Session", Sequence[pytest.Item]], None]) -> None:
        self.seconds, self.loop = seconds, loop

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        if session.testsfailed:  # a file that does not import
            os._exit(4) if _pipe < 0 else _end("killed", "import")
        self.loop(self, session.items)
        return True

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            _end("killed", report.nodeid)

    def run(self, items: Sequence[pytest.Item]) -> None:
        """Run the tests until one fails, which ends the process; processor time is limited for each."""
        for item, following in zip(items, [*items[1:], None], strict=True):
            _progress(item.nodeid)
            signal.setitimer(signal.ITIMER_PROF, 4.0 + 5.0 * self.seconds.get(item.nodeid, 1.0))
            signal.setitimer(signal.ITIMER_REAL, _SLOWEST)
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
        _end(_SURVIVED, "")


_pipe = -1


def _progress(text: str) -> None:
    os.write(_pipe, text.encode() + b"\n")


def _end(outcome: str, test: str) -> None:
    """Leave at once, whatever pytest would still do."""
    os.write(_pipe, json.dumps([outcome, test]).encode() + b"\n")
    os._exit(0)


def _forked(action: Callable[[], object]) -> Outcome:
    """Run in a fork, which ends with ``_end``; a signal that ends it before is the clock's."""
    global _pipe
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        _pipe = writing
        os.setpgid(0, 0)
        try:
            resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
            action()
        finally:
            os._exit(3)
    os.close(writing)
    said = b""
    with os.fdopen(reading, "rb") as stream:
        while chunk := stream.read1(1 << 16):
            said = (said + chunk)[-(1 << 16) :]
    _, status = os.waitpid(child, 0)
    with contextlib.suppress(ProcessLookupError):
        os.killpg(child, signal.SIGKILL)  # what a test started and left behind
    last = said.decode().splitlines()[-1] if said else ""
    if last.startswith("["):
        outcome, test = json.loads(last)
        return outcome, test
    if not (os.WIFSIGNALED(status) or last):
        raise RuntimeError("no test was run: is the mutant a program?")
    return ("timeout" if os.WIFSIGNALED(status) else "killed"), last


@contextlib.contextmanager
def _written(tree: Path, mutant: Mutant) -> Iterator[tuple[str, str]]:
    path = tree / mutant.file
    original, mutated = path.read_text(encoding="utf-8"), mutant.source()
    path.write_text(mutated, encoding="utf-8")
    try:
        yield original, mutated
    finally:
        path.write_text(original, encoding="utf-8")


def _pytest(tree: Path, plugin: _Session, tests: Sequence[str]) -> None:
    os.chdir(tree)
    silent = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(silent, stream)
    places = [str(tree / "kernel"), str(tree / "mesh")]
    sys.path[:0] = [*places, str(tree)]
    os.environ["PYTHONPATH"] = os.pathsep.join(places)
    files = sorted({test.split("::")[0] for test in tests})
    options = [
        "-q",
        "-n0",
        "-pno:cacheprovider",
        "--assert=plain",
        "--tb=no",
        f"--basetemp={tree}.tmp",
        "-mnot compiled",
    ]
    pytest.main([*options, *files], plugins=[plugin])


def _module(mutant: Mutant) -> str:
    return ".".join(Path(mutant.file).with_suffix("").parts[1:])


def try_mutants(
    tree: Path,
    mutants: Sequence[Mutant],
    tests: Mapping[Mutant, Sequence[str]],
    seconds: Mapping[str, float],
    budget: float,
) -> Iterator[tuple[Mutant, Outcome]]:
    """Yield each mutant and what became of it; ``tree`` is a copy of ours that may be written.

    A mutant that outlives tests worth ``budget`` seconds is a survivor. A test counts as a killer only if it passes
    without the mutant, in the same way of running it.
    """
    covered = [mutant for mutant in mutants if tests[mutant]]
    yield from ((mutant, ("uncovered", "")) for mutant in mutants if not tests[mutant])
    imported = []
    order = _Order(seconds, budget)
    for number, outcome in _in_one_process(tree, covered, tests, order):
        if outcome[0] == _NOT_A_FUNCTION:
            imported.append(covered[number])
        else:
            yield covered[number], outcome
    healthy = _Healthy(lambda test: _forked(lambda: _import_and_try(tree, [test], seconds)))
    for mutant in imported:
        outcome = healthy.outcome(functools.partial(_imported, tree, mutant, seconds), order.best(tests[mutant]))
        order.kills[outcome[1]] += 1
        yield mutant, outcome


class _Order:
    """The tests to run: those that killed others of the file before, then as given; as many as the budget pays for."""

    def __init__(self, seconds: Mapping[str, float], budget: float) -> None:
        self.seconds, self.budget = seconds, budget
        self.kills = Counter[str]()

    def best(self, tests: Sequence[str]) -> list[str]:
        """Return the tests for a mutant."""
        ordered = sorted(tests, key=lambda test: -self.kills[test] / (self.seconds[test] + 0.05))
        spent = list(itertools.accumulate(self.seconds[test] for test in ordered))
        return ordered[: max(1, bisect.bisect_right(spent, self.budget))]


class _Healthy:
    """Makes sure of the tests that kill: each is run without a mutant, once and after each timeout, and left out if it
    fails there too."""

    def __init__(self, run: Callable[[str], Outcome]) -> None:
        self.run, self.known, self.broken = run, {"import", ""}, set[str]()

    def outcome(self, attempt: Callable[[Sequence[str]], Outcome], tests: Sequence[str]) -> Outcome:
        """Try a mutant until no test that fails anyway has the last word."""
        while True:
            outcome = attempt([test for test in tests if test not in self.broken])
            test = outcome[1]
            is_slow = outcome[0] == "timeout"  # which may be the machine's fault, now and not before
            if (test in self.known and not is_slow) or self.run(test)[0] == _SURVIVED:
                self.known.add(test)
                return outcome
            self.broken.add(test)
            os.write(_terminal, f"left out, since it fails without a mutant: {test}\n".encode())


def _in_one_process(
    tree: Path, mutants: Sequence[Mutant], tests: Mapping[Mutant, Sequence[str]], order: _Order
) -> Iterator[tuple[int, Outcome]]:
    """Yield what became of the mutants that are changes of functions alone, by a process that collects once."""
    if not mutants:
        return
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        try:
            _collect_and_try(tree, mutants, tests, order, writing)
        finally:
            os._exit(4)
    os.close(writing)
    with os.fdopen(reading) as stream:
        for line in stream:
            number, outcome, test = json.loads(line)
            yield number, (outcome, test)
    _, status = os.waitpid(child, 0)
    if status != 0:
        raise RuntimeError(f"{mutants[0].file}: its tests cannot be collected, or fail without a mutant")


def _by_name(items: Sequence[pytest.Item], names: Sequence[str]) -> list[pytest.Item]:
    named = {item.nodeid: item for item in items}
    return [named[name] for name in names if name in named]


def _imported(tree: Path, mutant: Mutant, seconds: Mapping[str, float], tests: Sequence[str]) -> Outcome:
    with _written(tree, mutant):
        return _forked(lambda: _import_and_try(tree, tests, seconds))


def _import_and_try(tree: Path, names: Sequence[str], seconds: Mapping[str, float]) -> None:
    _pytest(tree, _Session(seconds, lambda session, items: session.run(_by_name(items, names))), names)
    _end("killed", "import")


def _transplanted(
    session: _Session, tree: Path, mutant: Mutant, items: Sequence[pytest.Item], tests: Sequence[str]
) -> Outcome:
    def action() -> None:
        if not transplant(importlib.import_module(_module(mutant)), *texts):
            _end(_NOT_A_FUNCTION, "")
        session.run(_by_name(items, tests))

    with _written(tree, mutant) as texts:
        return _forked(action)


def _collect_and_try(
    tree: Path,
    mutants: Sequence[Mutant],
    tests: Mapping[Mutant, Sequence[str]],
    order: _Order,
    pipe: int,
) -> None:
    def loop(session: _Session, items: Sequence[pytest.Item]) -> None:
        healthy = _Healthy(lambda test: _forked(lambda: session.run(_by_name(items, [test]))))
        for number, mutant in enumerate(mutants):
            attempt = functools.partial(_transplanted, session, tree, mutant, items)
            outcome = healthy.outcome(attempt, order.best(tests[mutant]))
            order.kills[outcome[1]] += 1
            os.write(pipe, json.dumps([number, *outcome]).encode() + b"\n")
        os._exit(0)

    _pytest(tree, _Session(order.seconds, loop), sorted({test for mutant in mutants for test in tests[mutant]}))
