"""The table of obligations is whole, and says what the tests say."""

import ast
import json
import os
import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import pytest
from proofs_tests.obligations.markers import ROOT, MarkerError, Obligation, collect
from proofs_tests.obligations.measured import MEASURED, Figures, load, update
from proofs_tests.obligations.page import page
from proofs_tests.obligations.statements import STATEMENTS

pytestmark = pytest.mark.once


OBLIGATIONS = collect()
PAGE = ROOT / "docs" / "obligations.md"
DOCUMENTS = sorted(path for path in [ROOT / "README.md", *(ROOT / "docs").glob("*.md")] if path != PAGE)

GOOD = '"K7", "statement", method="enumeration"'
METHOD = '    def test_control(self) -> None:\n        """The fault."""\n'


def written(folder: Path, arguments: str, body: str = METHOD) -> list[Obligation]:
    """Return the obligations of one class with this marker."""
    (folder / "proofs_tests").mkdir(exist_ok=True)
    source = f"@pytest.mark.obligation({arguments})\nclass TestIt:\n{body}"
    (folder / "proofs_tests" / "test_it.py").write_text(source, encoding="utf-8")
    return collect(folder)


def gaps(obligations: list[Obligation]) -> list[str]:
    """Return what is missing: in a marker, a control, or what a control says."""
    missing = [f"{o.place}: no obligation {o.id}" for o in obligations if o.id not in STATEMENTS]
    missing += [
        f'{o.place}: no negative control, and no control_in="TestThat" or "mutants"'
        for o in obligations
        if not o.controls
    ]
    missing += [f"{o.place}: what is the fault of {c.name}?" for o in obligations for c in o.controls if not c.fault]
    lines = defaultdict(list)
    for o in obligations:
        lines[o.id, o.statement].append(o.place)
    return missing + [f"{' and '.join(places)} say the same" for places in lines.values() if len(places) > 1]


class TestMarkers:
    """Law: every marker names an obligation, its own statement, a method and a negative control that says its fault."""

    def test_all(self) -> None:
        assert len(OBLIGATIONS) >= 180
        assert not gaps(OBLIGATIONS)

    def test_every_marker_is_read(self) -> None:
        """What stands in the sources, in whatever place, is on the page."""
        sources = [path.read_text(encoding="utf-8") for path in (ROOT / "proofs_tests").rglob("test_*.py")]
        calls = [node for source in sources for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Call)]
        assert sum(ast.unparse(call.func) == "pytest.mark.obligation" for call in calls) == len(OBLIGATIONS)

    @pytest.mark.parametrize(
        "arguments",
        [
            '"K7", "statement"',
            '"K7", "statement", method="looking at it"',
            '"K7", method="enumeration"',
            f"{GOOD}, control_in='TestElsewhere'",
            f"{GOOD}, cases=3",
            '"K7", STATEMENT, method="enumeration"',
        ],
    )
    def test_control_markers_that_say_too_little(self, arguments: str, tmp_path: Path) -> None:
        assert written(tmp_path, GOOD)
        with pytest.raises(MarkerError, match="TestIt"):
            written(tmp_path, arguments)

    def test_control_gaps(self, tmp_path: Path) -> None:
        assert not gaps(written(tmp_path, GOOD))
        assert len(gaps(written(tmp_path, GOOD) * 2)) == 1
        assert len(gaps(written(tmp_path, GOOD.replace("K7", "K99")))) == 1
        assert len(gaps(written(tmp_path, GOOD, METHOD.replace("control", "it")))) == 1
        mute = METHOD.replace('"""The fault."""', "assert True")
        assert len(gaps(written(tmp_path, GOOD, mute))) == 1
        assert len(gaps(written(tmp_path, f"{GOOD}, control_in='TestIt'", mute))) == 2  # its own, and as another's


class TestPage:
    """Law: the page is what the markers and the figures make it; every obligation that the documents name is on it."""

    def test_as_generated(self) -> None:
        assert PAGE.read_text(encoding="utf-8") == page(OBLIGATIONS, load()), (
            "python -m proofs_tests.obligations > docs/obligations.md"
        )

    def test_figures_are_read_where_the_page_has_them_written(self) -> None:
        assert f"--record-obligations={MEASURED.relative_to(ROOT).as_posix()}`" in page(OBLIGATIONS, {})

    def test_figures_are_of_the_classes_that_there_are(self) -> None:
        assert set(load()) == {o.place for o in OBLIGATIONS}

    @pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
    def test_links(self, path: Path) -> None:
        named = re.findall(r"obligations\.md#([a-z]+\d+)", path.read_text(encoding="utf-8"))
        assert set(named) <= {identifier.lower() for identifier in STATEMENTS}

    def test_control_another_statement(self, tmp_path: Path) -> None:
        one, other = (
            page(written(tmp_path, arguments), {}) for arguments in (GOOD, GOOD.replace("statement", "other"))
        )
        assert one != other


class TestRecorded:
    """Law: what is recorded is kept from run to run; figures that differ by chance alone stay as they are."""

    def test_noise_changes_nothing(self, tmp_path: Path) -> None:
        path, place = tmp_path / "recorded.json", "proofs_tests/test_it.py::TestIt"
        update(path, {place: Figures(8.04, 300, 0)}, [place])
        first = path.read_text()
        update(path, {place: Figures(9.91, 300, 0), "elsewhere": Figures(1.0, 1, 0)}, [place])
        assert path.read_text() == first
        update(path, {}, [place])
        assert path.read_text() == first
        update(path, {place: Figures(25.0, 300, 0)}, [place])
        assert load(path)[place] == (25.0, 300, 0)
        update(path, {place: Figures(2.0, 300, 0, 1)}, [place])  # a test failed
        assert load(path)[place] == (25.0, 300, 0)
        update(path, {}, ["another"])
        assert load(path) == {}

    @pytest.mark.parametrize("processes", [0, 2])
    def test_counts(self, processes: int, tmp_path: Path) -> None:
        """Examples of hypothesis, what tests report, and tests; in one process, and gathered from two."""
        (tmp_path / "conftest.py").write_text(CONFTEST)
        (tmp_path / "test_it.py").write_text(CLASSES)
        (tmp_path / "pytest.ini").write_text("[pytest]\n")
        paths = os.pathsep.join(path for path in [str(ROOT), *sys.path] if path)
        done = subprocess.run(
            [sys.executable, "-m", "pytest", "-q", "-n", str(processes), "-p", "no:cacheprovider"],
            env={**os.environ, "PYTHONPATH": paths},
            cwd=tmp_path,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stdout
        recorded = json.loads((tmp_path / "recorded.json").read_text())
        seconds = {place: figures.pop("seconds") for place, figures in recorded.items()}
        assert recorded == {
            "test_it.py::TestExamples": {"cases": 30, "skipped": 0, "failed": 0},
            "test_it.py::TestReported": {"cases": 720 + 1, "skipped": 0, "failed": 0},
            "test_it.py::TestSkipped": {"cases": 3, "skipped": 1, "failed": 0},
        }
        assert seconds["test_it.py::TestReported"] > 0.25 > seconds["test_it.py::TestSkipped"]


CONFTEST = """
import dataclasses, json
from pathlib import Path
from proofs_tests.obligations.recorder import Recorder

class Writing(Recorder):
    def pytest_sessionfinish(self):
        if self.writes:
            self.path.write_text(json.dumps({p: dataclasses.asdict(f) for p, f in self.figures.items()}))

def pytest_configure(config):
    config.pluginmanager.register(Writing(Path("recorded.json"), writes=not hasattr(config, "workerinput")))
"""

CLASSES = """
import subprocess, sys, time
import pytest
from hypothesis import assume, given, settings, strategies as st

class TestExamples:
    @given(st.integers(0, 1000))
    @settings(max_examples=30, derandomize=True, database=None)
    def test_some_are_rejected(self, n):
        assume(n % 3)

class TestReported:
    def test_720(self, record_property):
        record_property("cases", 700)
        record_property("cases", 20)

    def test_in_a_child_process(self):
        subprocess.run([sys.executable, "-c", "import time\\nwhile time.process_time() < 0.3: pass"], check=True)

class TestSkipped:
    @pytest.mark.parametrize("i", range(4))
    def test_one_of_four(self, i):
        if i == 2:
            pytest.skip("for a reason")
"""
