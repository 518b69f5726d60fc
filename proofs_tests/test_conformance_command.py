"""The command and the pytest plugin: exit codes, copyable counterexamples, one test a law, and nothing unasked for."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from exactmesh.cli import main
from exactmesh.conformance import LAWS, Task

ROOT = Path(__file__).resolve().parents[1]
PLACE = "proofs_tests.planted_meshers"
SQUARE = "[(0, 0), (1, 0), (1, 1), (0, 1)]"


@pytest.fixture
def inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


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


def pytest_run(folder: Path, *arguments: str) -> tuple[int, str]:
    """Run pytest with the plugin alone, as in somebody's project."""
    plugins = ("-p", "no:cacheprovider", "-p", "no:xdist", "-p", "no:exactmesh", "-p", "pytest_exactmesh")
    paths = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    command = [sys.executable, "-m", "pytest", *plugins, *arguments]
    environment = {**os.environ, "PYTHONPATH": paths}
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, env=environment)
    return run.returncode, run.stdout + run.stderr


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
        assert "covers_hull: wrong" in told
        assert "from exactmesh.conformance import retry" in told
        assert code == 1

    def test_the_suite_alone(self, tmp_path: Path) -> None:
        laws = len(LAWS[Task.SEGMENTS])
        arguments = ("--mesher=exactmesh", "--mesher-kind=segments", "--pyargs", "exactmesh.conformance")
        code, told = pytest_run(tmp_path, *arguments, *self.small)
        assert f"{laws} passed" in told
        assert code == 0

    def test_control_without_a_mesher_nothing_is_imported(self, tmp_path: Path) -> None:
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
