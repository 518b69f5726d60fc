"""What a mesher does to its process does not hurt; what is no mesh is told; names lead to meshers or to errors."""

import os
import re
import signal
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from proofs_tests.conformance import planted_meshers

from exactmesh import ChoiceError, ExactMeshError, MesherError, OptionError, Property
from exactmesh.conformance import Behaviour, Given, Outcome, Trait, check, loaded, retry
from exactmesh.conformance.judge import check_legal
from exactmesh.conformance.laws import Task
from exactmesh.conformance.process import Answer, Fate, Limits, MesherProcess
from exactmesh.conformance.reduction import reduced

pytestmark = pytest.mark.once


PLACE = "proofs_tests.conformance.planted_meshers"
MANY = Given.of([(x, y) for x in range(5) for y in range(5)])
FEW = Given.of([(0, 0), (1, 0), (0, 1)])
TWICE = Given.of([(0, 0), (1, 0), (0, 1), (0, 0)])


def is_legal(given: Given) -> bool:
    try:
        check_legal(Task.SEGMENTS, given)
    except ExactMeshError:
        return False
    return True


@pytest.mark.obligation(
    "B4", "whatever a mesher does to its process, the next input is tried, and this process lives", method="named cases"
)
class TestWhateverItDoes:
    """Law: a mesher may end its process, crash, hang, raise or eat memory; what it did is told, and it answers the next
    input as if nothing had happened."""

    @pytest.mark.parametrize(
        ("name", "given", "fate", "told"),
        [
            ("exits", MANY, Fate.DIED, "ended the process with exit code 3"),
            ("leaves", MANY, Fate.DIED, "exit code 1: that is too much"),
            ("segfaults", MANY, Fate.DIED, "ended the process by SIGSEGV"),
            ("hangs", TWICE, Fate.HUNG, "did not return within 1.5 s"),
            ("raises", Given.of([(0, 0), (1, 1), (2, 2)]), Fate.REFUSED, "ZeroDivisionError: the first three points"),
            ("eats_memory", MANY, Fate.REFUSED, "MemoryError"),
            ("returns_nothing", FEW, Fate.NO_MESH, "it returned None"),
            ("right", MANY, Fate.ANSWERED, ""),
            ("noisy", MANY, Fate.ANSWERED, ""),
        ],
    )
    def test_is_told(self, name: str, given: Given, fate: Fate, told: str) -> None:
        with MesherProcess(f"{PLACE}:{name}", Limits(seconds=1.5)) as process:
            for _ in range(2):
                answer = process.ask(given)
                assert answer.fate is fate
                assert told in answer.message
            other = Given.of([(0, 0), (2, 0), (3, 3), (0, 2), (1, 7)])
            assert process.ask(other).fate is Fate.ANSWERED

    def test_its_children_end_with_it(self, tmp_path: Path) -> None:
        tmp_path.joinpath("spawner.py").write_text(
            "import subprocess, sys, time\n"
            "def mesh(points):\n"
            "    child = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(60)'])\n"
            f"    open({str(tmp_path / 'pid')!r}, 'w').write(str(child.pid))\n"
            "    time.sleep(60)\n"
        )
        with MesherProcess(f"{tmp_path / 'spawner.py'}:mesh", Limits(seconds=2.0, start_seconds=2.0)) as process:
            assert process.ask(FEW).fate is Fate.HUNG
        pid = int(tmp_path.joinpath("pid").read_text())
        status = Path(f"/proc/{pid}/stat")
        assert not status.exists() or status.read_text().split()[2] == "Z"

    def test_a_process_that_outlives_it_holds_nobody_up(self, tmp_path: Path) -> None:
        """In a session of its own it is not ended with the mesher, and keeps the pipes open that it was given."""
        tmp_path.joinpath("orphan.py").write_text(
            "import os, subprocess, sys\n"
            "def mesh(points):\n"
            "    sleep = [sys.executable, '-c', 'import time; time.sleep(60)']\n"
            "    child = subprocess.Popen(sleep, start_new_session=True)\n"
            f"    open({str(tmp_path / 'pid')!r}, 'w').write(str(child.pid))\n"
            "    os._exit(7)\n"
        )
        answer, lives = self.asked_while_another_lives(tmp_path, "orphan")
        assert answer.message == "ended the process with exit code 7"
        assert lives  # control: it did hold them

    @pytest.mark.skipif(not hasattr(os, "fork"), reason="needs os.fork")
    def test_a_fork_that_outlives_it_does_not_hide_its_death(self, tmp_path: Path) -> None:
        tmp_path.joinpath("forker.py").write_text(
            "import os, time\n"
            "def mesh(points):\n"
            "    child = os.fork()\n"
            "    if child == 0:\n"
            "        os.setsid()\n"
            "        time.sleep(60)\n"
            f"    open({str(tmp_path / 'pid')!r}, 'w').write(str(child))\n"
            "    os._exit(7)\n"
        )
        answer, lives = self.asked_while_another_lives(tmp_path, "forker")
        assert answer.fate is Fate.DIED
        assert answer.message == "ended the process with exit code 7"
        assert lives  # control: the answers' pipe was open

    @staticmethod
    def asked_while_another_lives(folder: Path, name: str) -> tuple[Answer, bool]:
        with MesherProcess(f"{folder / name}.py:mesh", Limits(seconds=30.0)) as process:
            answer = process.ask(FEW)
        pid = int(folder.joinpath("pid").read_text())
        lives = Path(f"/proc/{pid}").exists()
        os.kill(pid, signal.SIGKILL)
        return answer, lives

    @pytest.mark.skipif(not hasattr(os, "fork"), reason="needs os.fork")
    def test_a_fork_that_returns_answers_nothing(self, tmp_path: Path) -> None:
        tmp_path.joinpath("twins.py").write_text(
            "import os\ndef mesh(points):\n    os.fork()\n    return [(0, 1, len(points) - 1)]\n"
        )
        with MesherProcess(f"{tmp_path / 'twins.py'}:mesh") as process:
            for n in (3, 4, 5, 6):
                answer = process.ask(Given(MANY.points[:n]))
                assert answer.triangles is not None
                assert answer.triangles.tolist() == [[0, 1, n - 1]]  # not the fork's to the question before

    @pytest.mark.parametrize(
        ("line", "fate"),
        [
            pytest.param("os.closerange(3, 100), time.sleep(60)", Fate.DIED, id="closed"),
            pytest.param("os.write(4, b'garbage')", Fate.DIED, id="soiled"),
            pytest.param("time.sleep(0)", Fate.ANSWERED, id="control"),
        ],
    )
    def test_pipes_that_are_closed_or_soiled_hold_nobody_up(self, tmp_path: Path, line: str, fate: Fate) -> None:
        tmp_path.joinpath("vandal.py").write_text(
            "import contextlib, os, time\ndef mesh(points):\n    with contextlib.suppress(OSError):\n"
            f"        {line}\n    return [(0, 1, 2)]\n"
        )
        with MesherProcess(f"{tmp_path / 'vandal.py'}:mesh", Limits(seconds=20.0)) as process:
            answer = process.ask(FEW)
        assert answer.fate is fate

    @pytest.mark.parametrize(("each_time", "fate"), [(False, Fate.ANSWERED), (True, Fate.HUNG)])
    def test_control_it_may_compile_after_each_restart(self, tmp_path: Path, each_time: bool, fate: Fate) -> None:
        """A mesher that is slow in every call, not in the first one after a restart only."""
        tmp_path.joinpath("compiles.py").write_text(
            "import os, time\nstate = []\ndef mesh(points):\n"
            f"    if {each_time} or not state:\n        state.append(time.sleep(3.0))\n"
            "    if len(points) == 5:\n        os._exit(3)\n"
            "    return [(0, 1, 2)]\n"
        )
        with MesherProcess(f"{tmp_path / 'compiles.py'}:mesh", Limits(seconds=1.5)) as process:
            died = process.ask(Given(MANY.points[:5]))
            assert died.fate is (Fate.HUNG if each_time else Fate.DIED)
            assert process.ask(FEW).fate is fate

    def test_what_is_no_mesh_is_told(self, tmp_path: Path) -> None:
        answers = {
            "floats": ("[(0.0, 1.0, 2.0)]", "triangles are float64, not integers"),
            "pairs": ("np.array([[0, 1]])", "triangles have shape (1, 2), not (m, 3)"),
            "words": ("'no such file'", "no such file"),
            "solid": ("(np.zeros((3, 3)), [(0, 1, 2)])", "points are float64 of shape (3, 3)"),
            "number": ("7", "int is no mesh"),
        }
        functions = (f"def {name}(points): return {code}\n" for name, (code, _) in answers.items())
        source = "import numpy as np\n" + "".join(functions)
        tmp_path.joinpath("answers.py").write_text(source)
        for name, (_, told) in answers.items():
            result = retry(f"{tmp_path / 'answers.py'}:{name}", FEW.points)
            example = result.rulings[Behaviour.ANSWERS].counterexample
            assert result.outcome("answers") is Outcome.WRONG
            assert example is not None
            assert told in example.sentence

    def test_every_kind_of_mesh_is_understood(self, tmp_path: Path) -> None:
        answers = (
            "[(0, 1, 2)]",
            "np.array([[0, 1, 2]], dtype=np.uint8)",
            "(points[::-1], [(0, 2, 1)])",
            "{'vertices': points, 'triangles': [(0, 1, 2)]}",
            "exactmesh.delaunay(points)",
        )
        source = "import numpy as np, exactmesh\n" + "".join(
            f"def f{i}(points): return {code}\n" for i, code in enumerate(answers)
        )
        tmp_path.joinpath("answers.py").write_text(source)
        for i in range(len(answers)):
            result = retry(f"{tmp_path / 'answers.py'}:f{i}", FEW.points, timeout=60.0)
            assert result.ok, str(result)


class TestNames:
    """Law: a mesher is named by itself, by module:function, by file:function, or by a known name; what leads nowhere is
    a MesherError that says why."""

    def test_a_function(self) -> None:
        assert check(planted_meshers.right, max_examples=2, max_size=6).ok
        assert not check(planted_meshers.drops_a_hull_triangle, max_examples=2, max_size=6).ok  # control

    @pytest.mark.parametrize(
        ("name", "told"),
        [
            ("nobody", "neither module:function nor a known mesher: exactmesh, "),
            ("no_such_module:f", "cannot be imported: ModuleNotFoundError"),
            ("math:no_such_function", "there is no 'no_such_function' in math"),
            ("math:pi", "cannot be called: it is float"),
            ("math.pi", "did you mean math.pi:FUNCTION?"),
            ("no/such/file.py:f", "there is no file"),
            (":f", "is no module:function"),
        ],
    )
    def test_what_leads_nowhere(self, name: str, told: str) -> None:
        with pytest.raises(MesherError, match=re.escape(told)):
            retry(name, FEW.points)

    def test_functions_without_a_name(self) -> None:
        cells = [(0, 1, 2)]

        def inner(_: object) -> object:
            return cells

        assert retry(inner, FEW.points).ok
        wrong = retry(lambda _: [(0, 2, 1)], FEW.points)
        example = wrong.rulings[Property.ORIENTATION].counterexample
        assert example is not None
        assert example.mesher == "<<lambda>>"
        assert example.command == f"retry(mesher, {FEW.literal})"
        assert "print(retry(mesher, points))" in example.code

    def test_functions_that_no_other_process_can_have(self, monkeypatch: pytest.MonkeyPatch) -> None:
        lock = threading.Lock()
        with pytest.raises(MesherError, match="cannot be sent to another process"):
            retry(lambda points: (lock, points), FEW.points)
        monkeypatch.setitem(sys.modules, "cloudpickle", None)  # as if it were not installed
        with pytest.raises(MesherError, match="or pip install cloudpickle"):
            retry(lambda points: points, FEW.points)

    def test_a_known_mesher_does_what_it_does(self) -> None:
        with pytest.raises(MesherError, match="scipy is known for points, not for segments"):
            retry("scipy", FEW.points, [(0, 1)])
        made = loaded("exactmesh", Task.POINTS)(FEW.points)
        assert isinstance(made, tuple)
        assert made[1].tolist() == [[0, 1, 2]]

    def test_a_mesher_that_dies_when_it_is_imported(self, tmp_path: Path) -> None:
        tmp_path.joinpath("deadly.py").write_text("import os\nos._exit(5)\n")
        with pytest.raises(MesherError, match="importing it ended the process with exit code 5"):
            retry(f"{tmp_path / 'deadly.py'}:f", FEW.points)

    def test_a_script_without_a_guard_does_not_run_for_ever(self, tmp_path: Path) -> None:
        script = tmp_path / "script.py"
        source = "from exactmesh.conformance import retry\ndef f(points): return [(0, 1, 2)]\n"
        call = "print(retry(f, [(0, 0), (1, 0), (0, 1)]).ok)\n"
        script.write_text(source + call)
        run = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=False, env=os.environ)
        assert run.returncode == 1
        assert "put the call under if __name__ == '__main__'" in run.stderr
        script.write_text(f"{source}if __name__ == '__main__':\n    {call}")  # control
        run = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=False, env=os.environ)
        assert run.stdout == "True\n"

    @pytest.mark.parametrize(
        ("arguments", "error"),
        [
            ({"kind": "solid"}, ChoiceError),
            ({"properties": ["acute"]}, ChoiceError),
            ({"max_examples": 0}, OptionError),
            ({"timeout": -1.0}, OptionError),
            ({"deadline": float("nan")}, OptionError),
            ({"timeout": float("inf")}, OptionError),
            ({"timeout": 10**400}, OptionError),
            ({"timeout": "a"}, OptionError),
            ({"deadline": 10**400}, OptionError),
            ({"max_examples": 1.5}, OptionError),
            ({"max_examples": "a"}, OptionError),
            ({"max_size": 2}, OptionError),
            ({"memory": -5}, OptionError),
            ({"memory": 0}, OptionError),
            ({"seed": "x"}, OptionError),
            ({"properties": 3}, OptionError),
        ],
    )
    def test_wrong_arguments(self, arguments: dict[str, object], error: type[Exception]) -> None:
        with pytest.raises(error):
            check("exactmesh", **arguments)  # type: ignore[arg-type]  # that is the point

    def test_control_odd_arguments_that_are_right(self) -> None:
        numbers = {"timeout": 1e300, "memory": 10**30, "deadline": float("inf"), "seed": -1, "max_examples": 1}
        assert check("exactmesh", max_size=4, **numbers).ok  # type: ignore[arg-type]  # a dictionary has one type

    @pytest.mark.parametrize(
        ("points", "segments"),
        [
            ([(0, 0), (float("inf"), 0), (1, 1)], None),
            ([(0, 0), (1,)], None),
            (FEW.points, "abc"),
            (FEW.points, [(0, 1, 2)]),
            (FEW.points, [(0, 1.5)]),
            (FEW.points, [(0, 7)]),
        ],
    )
    def test_what_is_no_input(self, points: list[tuple[float, ...]], segments: object) -> None:
        with pytest.raises(ExactMeshError):
            retry("exactmesh", points, segments)  # type: ignore[arg-type]  # that is the point
        assert retry("exactmesh", FEW.points, [(0, 1)]).ok  # control


@pytest.mark.obligation(
    "B2", "of what is left of an input no point and no segment can be left out", method="named cases"
)
class TestReduction:
    """Law: what is left of an input breaks the law still, and no single point or segment can be left out."""

    def test_points(self) -> None:
        wanted = Given.of(np.random.default_rng(0).random((40, 2)) * 100)

        def still(given: Given) -> bool:
            return bool((given.points[:, 0] > 50).sum() >= 3)

        small = reduced(wanted, is_legal, still)
        assert len(small.points) == 3
        assert (small.points == np.round(small.points)).all()
        assert small.traits == frozenset()
        for v in range(3):
            assert not still(Given(np.delete(small.points, v, axis=0)))

    def test_segments(self) -> None:
        ring = [(i, (i + 1) % 8) for i in range(8)]
        wanted = Given.of([(np.cos(i), np.sin(i)) for i in range(8)], ring)
        small = reduced(wanted, is_legal, lambda given: given.segments is not None and len(given.segments) >= 2)
        assert small.segments is not None
        assert len(small.segments) == 2
        assert len(small.points) <= 4

    def test_control_nothing_is_left_out_of_what_is_needed(self) -> None:
        """A fault that takes 25 points: 25 are left."""
        assert reduced(MANY, is_legal, lambda given: len(given.points) >= 25).size <= MANY.size
        assert len(reduced(MANY, is_legal, lambda given: len(given.points) >= 25).points) == 25

    def test_everyday_numbers_come_first(self) -> None:
        """Even before fewer points; but what is only wrong far out is told as it is."""
        wild = Given.of([(0, 1), (0, 0), (1, -3e64)])
        tame = Given.of([(0, 0), (6, 12), (274, 498), (5, 1)])
        assert tame.size < wild.size
        assert wild.traits == tame.traits == frozenset()
        anywhere = reduced(wild, is_legal, lambda given: len(given.points) == 3 and Trait.FLAT not in given.traits)
        assert np.abs(anywhere.points).max() <= 100
        far = reduced(wild, is_legal, lambda given: bool((np.abs(given.points) > 1e60).any()))
        assert np.abs(far.points).max() > 1e60

    def test_traits_are_not_taken_on(self) -> None:
        wanted = Given.of([(0.25, 0), (1.5, 0.125), (0, 1), (2, 2.0625)])
        small = reduced(wanted, is_legal, lambda given: len(given.points) == 4)
        assert small.traits == frozenset()
        flat = Given.of([(0, 0), (0, 0), (1e300, 0)])
        assert flat.traits == {Trait.FLAT, Trait.DUPLICATES, Trait.EXTREME}
