"""pytest --record-obligations=PATH: how many cases each test class tried, and the processor time that it took.

One case is one of: what a test reports by ``record_property("cases", n)``; else an example on which hypothesis ran the
test to its end; else the test itself. Processor time, of child processes too, tells more than a clock where other work
runs beside. Works with pytest-xdist, whose workers hand over what is recorded with their reports.
"""

import functools
import os
from collections import defaultdict
from collections.abc import Generator
from pathlib import Path

import pytest
from proofs_tests.obligations.markers import collect
from proofs_tests.obligations.measured import Figures, update

__all__ = ["Recorder"]


def processor_seconds() -> float:
    """Return the processor time of this process and of its children that have ended."""
    return sum(os.times()[:4])


class Recorder:
    """Counts where tests run, gathers where reports arrive, and writes at the end of a run."""

    def __init__(self, path: Path, *, writes: bool) -> None:
        self.path = path
        self.writes = writes
        self._examples: dict[str, int] = {}
        self._before = processor_seconds()
        self.figures: defaultdict[str, Figures] = defaultdict(Figures)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self) -> Generator[None, object, object]:
        self._before = processor_seconds()
        return (yield)

    @pytest.hookimpl(wrapper=True)
    def pytest_pyfunc_call(self, pyfuncitem: pytest.Function) -> Generator[None, object, object]:
        handle = getattr(pyfuncitem.obj, "hypothesis", None)
        if handle is None:
            return (yield)
        test = handle.inner_test
        count = 0

        @functools.wraps(test)
        def counting(*args: object, **kwargs: object) -> object:
            nonlocal count
            result = test(*args, **kwargs)
            count += 1
            return result

        handle.inner_test = counting
        try:
            return (yield)
        finally:
            handle.inner_test = test
            self._examples[pyfuncitem.nodeid] = count

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self, item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        report = yield
        now = processor_seconds()
        report.user_properties.append(("processor seconds", now - self._before))
        if report.when == "call" and item.nodeid in self._examples:
            report.user_properties.append(("examples", self._examples.pop(item.nodeid)))
        self._before = now
        return report

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        place = report.nodeid.split("[")[0].rpartition("::")[0]
        self.figures[place] += Figures.of(report)

    def pytest_sessionfinish(self, exitstatus: int) -> None:
        if self.writes and exitstatus in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED):
            update(self.path, self.figures, {obligation.place for obligation in collect()})
