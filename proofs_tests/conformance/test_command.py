"""The command and the pytest plugin: exit codes, copyable counterexamples, one test a law, and nothing unasked for."""

import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from exactmesh.cli import main
from exactmesh.conformance import KNOWN, LAWS, Task

pytestmark = pytest.mark.once


ROOT = Path(__file__).resolve().parents[2]
PLACE = "proofs_tests.conformance.planted_meshers"
SQUARE = "[(0, 0), (1, 0), (1, 1), (0, 1)]"


@pytest.fixture
def inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def squeezed(table: str) -> str:
    """Return the last column of a table, without blanks and breaks."""
    return "".join("".join(line.split("│")[-2].split()) for line in table.splitlines() if line.count("│") > 2)


class TestCommand:
    """Law: exit code 0 if every law holds, 1 if not, 2 for bad input; what is broken is told as Python to copy."""

    def test_one_input(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["conformance", f"{PLACE}:right", "--input", SQUARE]) == 0
        assert "delaunay" in capsys.readouterr().out
        assert main(["conformance", f"{PLACE}:drops_a_hull_triangle", "--input", SQUARE]) == 1
        told = capsys.readouterr().out
        points = "[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]"
        assert f"points = {points}\n" in told
        assert f'exactmesh conformance {PLACE}:drops_a_hull_triangle --input "{points}"\n' in told

    def test_a_hunt(self, capsys: pytest.CaptureFixture[str]) -> None:
        small = ("--max-examples", "3", "--max-size", "8")
        assert main(["conformance", f"{PLACE}:right", *small]) == 0
        assert main(["conformance", f"{PLACE}:repeats_a_triangle", "--law", "admissible", *small]) == 1
        assert "they overlap" in capsys.readouterr().out

    def test_rounding_may_be_allowed(self) -> None:
        pytest.importorskip("shapely")
        assert main(["conformance", "geos", "--input", "corpus:5"]) == 1
        assert main(["conformance", "geos", "--input", "corpus:5", "--allow-rounding"]) == 0
        assert main(["conformance", "geos", "--input", "corpus:1", "--allow-rounding"]) == 1  # control

    def test_a_file_here(self, inside: Path) -> None:
        inside.joinpath("mine.py").write_text("def f(points, segments): return [(0, 1, 2)]\n")
        inside.joinpath("x.poly").write_text("3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n1 0\n1 1 2\n0\n")
        assert main(["conformance", "mine.py:f", "--segments", "--input", "x.poly"]) == 0
        assert main(["conformance", "mine:f", "--segments", "--input", "x.poly"]) == 0
        assert main(["conformance", "mine:f", "--domain", "--input", "([(0,0),(2,0),(0,2)],[(0,1),(1,2),(2,0)])"]) == 0

    def test_one_input_one_law(self, inside: Path) -> None:
        inside.joinpath("mine.py").write_text("def f(points): return [(0, 2, 1), (0, 3, 2)]\n")
        clockwise = ("mine.py:f", "--input", SQUARE)
        assert main(["conformance", *clockwise]) == 1
        assert main(["conformance", *clockwise, "--law", "orientation"]) == 1
        assert main(["conformance", *clockwise, "--law", "all-points-used"]) == 0

    def test_an_unfinished_hunt_has_a_code_of_its_own(self, capsys: pytest.CaptureFixture[str]) -> None:
        hunt = ["conformance", f"{PLACE}:right", "--max-size", "8", "--max-examples", "2"]
        assert main([*hunt, "--deadline", "1e-9"]) == 3
        assert "the time was up" in capsys.readouterr().out
        assert main(hunt) == 0  # control

    def test_what_is_not_installed_is_not_put_on_trial(
        self, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
    ) -> None:
        absent = replace(KNOWN["scipy"], module="no_such_module", package="no-such-package")
        monkeypatch.setitem(KNOWN, "scipy", absent)
        assert main(["conformance", "scipy", "--input", SQUARE]) == 2
        captured = capsys.readouterr()
        assert captured.err == "exactmesh: scipy (Qhull) is not installed: pip install no-such-package\n"
        assert captured.out == ""

    def test_usage_errors_name_the_help_of_the_command(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["conformance"]) == 2
        assert "(see exactmesh conformance --help)" in capsys.readouterr().err
        assert main(["beautify"]) == 2  # control: no such command, no such help
        assert "(see exactmesh --help)" in capsys.readouterr().err

    def test_no_sentence_is_cut(
        self, inside: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """Where no terminal says how wide it is; in one of 80 columns they are broken, not cut."""
        monkeypatch.delenv("COLUMNS", raising=False)
        inside.joinpath("mine.py").write_text("def f(points): return [(0, 2, 1)]\n")
        points = [(0.1, 0.2), (1e16, 0.30000000000000004), (1.1, 7e15)]
        main(["conformance", "mine.py:f", "--input", str(points)])
        table, _, below = capsys.readouterr().out.partition("\n\n")
        sentence = next(line for line in below.splitlines() if "is clockwise" in line).partition(": ")[2]
        assert "".join(sentence.split()) in squeezed(table)
        assert "..." not in table
        monkeypatch.setenv("COLUMNS", "80")
        main(["conformance", "mine.py:f", "--input", str(points)])
        table = capsys.readouterr().out.partition("\n\n")[0]
        assert "".join(sentence.split()) in squeezed(table)

    def test_the_list(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["conformance", "--list"]) == 0
        told = capsys.readouterr().out
        assert "startinpy" in told
        assert "corpus:10" in told

    @pytest.mark.parametrize(
        "arguments",
        [
            [],
            ["nobody"],
            ["exactmesh", "--input", "corpus:99"],
            ["exactmesh", "--input", "[(0, 0), (1,"],
            ["exactmesh", "--input", "[(0, 0), (1, 'x')]"],
            ["exactmesh", "--input", "no_such_file.csv"],
            ["exactmesh", "--input", "np.zeros((3, 2))"],
            ["exactmesh", "--input", "[nan]"],
            ["exactmesh", "--segments", "--input", f"({SQUARE}, [(0, 1, 2)])"],
            ["exactmesh", "--segments", "--input", f"({SQUARE}, 'abc')"],
            ["exactmesh", "--segments", "--input", f"({SQUARE}, [(0, 1.5)])"],
            ["exactmesh", "--timeout", "inf"],
            ["exactmesh", "--all"],
            ["--all", "--input", SQUARE],
            ["--all", "--law", "delaunay"],
            ["exactmesh", "--output", "page.md"],
            ["exactmesh", "--input", "[(0, 0), (1, 1e999)]"],
            ["exactmesh", "--segments", "--input", SQUARE],
            ["exactmesh", "--segments", "--input", f"({SQUARE}, [(0, 9)])"],
            ["exactmesh", "--domain", "--input", f"({SQUARE}, [(0, 1)])"],
            ["exactmesh", "--segments", "--domain"],
            ["exactmesh", "--law", "beauty"],
        ],
    )
    def test_bad_input_is_one_line(self, arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["conformance", *arguments]) == 2
        captured = capsys.readouterr()
        assert captured.err.startswith("exactmesh: ")
        assert captured.err.count("\n") == 1
        assert captured.out == ""


def pytest_run(folder: Path, *arguments: str, script: Sequence[str] = ("-m", "pytest")) -> tuple[int, str]:
    """Run pytest with the plugin alone, as in somebody's project."""
    plugins = ("-p", "no:cacheprovider", "-p", "no:xdist", "-p", "no:exactmesh", "-p", "pytest_exactmesh")
    paths = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    command = [sys.executable, *script, *plugins, *arguments]
    environment = {**os.environ, "PYTHONPATH": paths}
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, env=environment)
    return run.returncode, run.stdout + run.stderr


@pytest.mark.obligation(
    "B5", "--mesher adds a test for each law; without it nothing is added or imported", method="named cases"
)
class TestPlugin:
    """Law: ``--mesher`` adds one test for each law, which fails where the law is broken; without it nothing is added
    and nothing of exactmesh is imported."""

    small = ("--mesher-examples=3", "-q")

    def test_one_test_a_law(self, tmp_path: Path) -> None:
        tmp_path.joinpath("test_own.py").write_text(
            "def test_own(mesher, assert_delaunay, assert_admissible, assert_constrained_delaunay):\n"
            "    import numpy as np\n"
            "    points = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])\n"
            "    assert_delaunay(points, mesher(points))\n"
            "    assert_admissible(points, mesher(points))\n"
            "    assert_constrained_delaunay(points, mesher(points), segments=[(0, 1)])\n"
        )
        count = len(LAWS[Task.POINTS])
        code, told = pytest_run(tmp_path, f"--mesher={PLACE}:right", *self.small)
        assert f"{count + 1} passed" in told
        assert code == 0
        code, told = pytest_run(tmp_path, f"--mesher={PLACE}:drops_a_hull_triangle", *self.small)
        assert "FAILED" in told
        assert "drops_a_hull_triangle breaks covers_hull: wrong, " in told
        assert "from exactmesh.conformance import retry" in told
        assert code == 1

    def test_a_mesher_here_is_found(self, tmp_path: Path) -> None:
        """As the command finds it, without python -m pytest, which the control is."""
        tmp_path.joinpath("mine").mkdir()
        tmp_path.joinpath("mine", "fan.py").write_text("def mesh(points): return []\n")
        for script in (["-P", "-c", "import pytest; raise SystemExit(pytest.main())"], ["-m", "pytest"]):
            code, told = pytest_run(tmp_path, "--mesher=mine.fan:mesh", *self.small, script=script)
            assert "mine.fan:mesh breaks covers_hull: wrong" in told
            assert code == 1

    def test_an_unfinished_hunt_warns(self, tmp_path: Path) -> None:
        code, told = pytest_run(tmp_path, f"--mesher={PLACE}:right", "--mesher-deadline=1e-9", *self.small)
        assert "the time was up" in told
        assert code == 0
        assert "the time was up" not in pytest_run(tmp_path, f"--mesher={PLACE}:right", *self.small)[1]  # control

    def test_the_suite_alone(self, tmp_path: Path) -> None:
        laws = len(LAWS[Task.SEGMENTS])
        arguments = ("--mesher=exactmesh", "--mesher-kind=segments", "--pyargs", "exactmesh.conformance")
        code, told = pytest_run(tmp_path, *arguments, *self.small)
        assert f"{laws} passed" in told
        assert code == 0

    def test_control_without_a_mesher_nothing_is_imported(self, tmp_path: Path) -> None:
        """No mesher: nothing of exactmesh is imported."""
        tmp_path.joinpath("test_own.py").write_text(
            "import sys\ndef test_own():\n    assert not {'exactmesh', 'exactkernel', 'numba'} & set(sys.modules)\n"
        )
        code, told = pytest_run(tmp_path, "-q")
        assert "1 passed" in told
        assert code == 0
        code, told = pytest_run(tmp_path, "-q", "--pyargs", "exactmesh.conformance")
        assert "which mesher?" in pytest_run(tmp_path, "-q", "-rs", "--pyargs", "exactmesh.conformance")[1]
        assert f"{len(LAWS[Task.POINTS])} skipped" in told

    def test_messages_are_readable(self, tmp_path: Path) -> None:
        tmp_path.joinpath("test_own.py").write_text(
            "def test_own(assert_delaunay):\n"
            "    assert_delaunay([(0, 0), (3, -1), (6, 0), (3, 1)], [(0, 1, 2), (0, 2, 3)])\n"
        )
        code, told = pytest_run(tmp_path, "-q")
        assert "delaunay fails: vertex" in told
        assert "triangles = [" in told
        assert "assertions.py" not in told  # no traceback through it
        assert code == 1
