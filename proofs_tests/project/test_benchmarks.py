"""The harness of the benchmarks: what it prints, and what it does with meshers that fail. No times."""

from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from benchmarks import tables, workers
from benchmarks.inputs import INPUTS, points_of
from benchmarks.peers import version_of
from benchmarks.tables import Section, cell
from benchmarks.workers import Outcome, race


class TestCells:
    """Law: a cell is the median, the ratio to exactmesh's, and what else differs; or why there is none."""

    def test_cells(self) -> None:
        own, other = Outcome([3.0, 1.0, 2.0], count=10), Outcome([4.0, 4.0, 9.0], count=12)
        assert cell(own, own) == "2.000 s"
        assert cell(other, own) == "4.000 s (2.00), +2 triangles"
        assert cell(Outcome([1.0], count=10), own) == "1.000 s (0.50)"
        assert cell(Outcome(failure="over 60 s"), own) == "over 60 s"

    def test_control_the_mean_is_another_number(self) -> None:
        """An outlier moves the mean and not the median."""
        assert Outcome([1.0, 1.0, 100.0]).median == 1.0


class TestSections:
    """Law: a section takes the place of its last version, and leaves the others alone."""

    def test_write(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        page = tmp_path / "benchmarks.md"
        monkeypatch.setattr(tables, "_PAGE", page)
        for name, text in (("one", "first"), ("two", "second"), ("one", "third")):
            section = Section(name, f"Title of {name}")
            section.text(text)
            section.table(["mesher", "time"], [["exactmesh", "1.000 s"]])
            section.write()
        written = page.read_text(encoding="utf-8")
        assert "first" not in written
        assert written.index("third") < written.index("second")
        assert written.count("<!-- begin one -->") == written.count("<!-- end one -->") == 1
        assert "| mesher | time |\n| --- | --- |\n| exactmesh | 1.000 s |" in written


class Pipe:
    """Stands in for the pipe of a worker."""

    def __init__(self, answers: list[object], ready: bool = True) -> None:
        self.answers, self.ready = answers, ready

    def poll(self, _limit: float) -> bool:
        return self.ready

    def recv(self) -> object:
        answer = self.answers.pop(0)
        if isinstance(answer, Exception):
            raise answer
        return answer

    def send(self, _message: str) -> None: ...


class Process:
    """Stands in for the process of a worker."""

    exitcode = -11
    killed = False

    def kill(self) -> None:
        self.killed = True

    def join(self) -> None: ...


def worker(answers: list[object], ready: bool = True) -> Any:
    made = cast("Any", object.__new__(workers._Worker))
    made.outcome, made._pipe, made._process = Outcome(), Pipe(answers, ready), Process()
    return made


class TestWorkers:
    """Law: a mesher that dies, hangs, raises or is not installed costs its own row only."""

    def test_rounds_are_collected(self) -> None:
        made = worker([(0.5, 7, 3.0), (0.25, 7, 9.0)])
        made.run()
        made.run()
        assert (made.outcome.seconds, made.outcome.count, made.outcome.bytes_per_point) == ([0.5, 0.25], 7, 3.0)

    def test_control_failures_are_named(self) -> None:
        """A process that is gone, one that does not answer, one that raised."""
        dead, slow, raised = worker([EOFError()]), worker([], ready=False), worker(["ValueError: no"])
        for made in (dead, slow, raised):
            made.run()
            made.run()  # out of the race: asked no more
            assert made.outcome.seconds == []
        assert dead.outcome.failure == "died, exit code -11"
        assert slow.outcome.failure == "over 60 s"
        assert slow._process.killed
        assert raised.outcome.failure == "ValueError: no"

    def test_a_race(self) -> None:
        outcome = race(["exactmesh"], "uniform", size=300, rounds=2)["exactmesh"]
        assert outcome.failure == ""
        assert len(outcome.seconds) == 2
        assert outcome.count > 300

    def test_missing(self) -> None:
        assert version_of("no-such-distribution-of-meshes") == "missing"


class TestInputs:
    """Law: an input is the same whenever it is asked for, has about the size asked for, and is finite."""

    @pytest.mark.parametrize("name", INPUTS)
    def test_inputs(self, name: str) -> None:
        points = points_of(name, 400)
        assert points.shape == (400, 2)
        assert np.isfinite(points).all()
        assert (points == points_of(name, 400)).all()
