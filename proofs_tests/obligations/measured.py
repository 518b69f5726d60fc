"""What a run recorded: proofs_tests/obligations.json, one entry a test class."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import pytest

__all__ = ["MEASURED", "Figures", "Measured", "load", "update"]

MEASURED = Path(__file__).resolve().parents[1] / "obligations.json"


class Measured(NamedTuple):
    """What the page shows of a class: processor seconds, cases, and tests that were skipped."""

    seconds: float
    cases: int
    skipped: int


@dataclass
class Figures:
    """The sums over the reports of a class, in one run."""

    seconds: float = 0.0
    cases: int = 0
    skipped: int = 0
    failed: int = 0

    @classmethod
    def of(cls, report: pytest.TestReport) -> "Figures":
        """Return what one report says: of the three phases of a test, the call has its cases."""
        recorded = dict(report.user_properties)
        figures = cls(float(str(recorded.get("processor seconds", 0.0))), 0, int(report.skipped), int(report.failed))
        if report.when == "call" and report.passed:
            reported = [int(str(value)) for name, value in report.user_properties if name == "cases"]
            figures.cases = sum(reported) if reported else int(str(recorded.get("examples", 1)))
        return figures

    def __iadd__(self, other: "Figures") -> "Figures":
        self.seconds += other.seconds
        self.cases += other.cases
        self.skipped += other.skipped
        self.failed += other.failed
        return self


def load(path: Path = MEASURED) -> dict[str, Measured]:
    """Return the figures by class, as ``file::class``; of nothing where nothing was recorded."""
    if not path.exists():
        return {}
    return {place: Measured(**entry) for place, entry in json.loads(path.read_text(encoding="utf-8")).items()}


def update(path: Path, figures: Mapping[str, Figures], places: Iterable[str]) -> None:
    """Put what was measured into the file, for classes that have a marker; forget those that have none."""
    before = load(path)
    after = {place: _rounded(figures[place], before.get(place)) for place in places if _passed(figures, place)}
    kept = {place: before[place] for place in places if place in before}
    entries = [f'"{place}": {json.dumps(entry._asdict())}' for place, entry in sorted((kept | after).items())]
    path.write_text("{\n" + ",\n".join(entries) + "\n}\n", encoding="utf-8")


def _passed(figures: Mapping[str, Figures], place: str) -> bool:
    """Tell whether all tests of the class that ran passed: of what fails no figure is taken."""
    return place in figures and figures[place].failed == 0


def _rounded(new: Figures, old: Measured | None) -> Measured:
    """Two digits of the seconds; those of the last time, where they are as good: the file is to change with reason."""
    seconds = round(new.seconds, 1) if new.seconds < 10 else float(round(new.seconds))
    if old is not None and old.seconds / 1.5 - 0.5 <= seconds <= old.seconds * 1.5 + 0.5:
        seconds = old.seconds
    return Measured(seconds, new.cases, new.skipped)
