"""The mutants, and how they are tried."""

import importlib.util
import re
import types
from pathlib import Path

import pytest

pytest.importorskip("cosmic_ray", reason="mutation testing needs cosmic-ray: pip install '.[mutation]'")

from coverage import CoverageData
from proofs_tests.mutation.campaign import Result
from proofs_tests.mutation.command import BAR
from proofs_tests.mutation.covering import Covering
from proofs_tests.mutation.mutants import ROOT, Mutant, mutants_of, source_files
from proofs_tests.mutation.page import Scores, name_of, page
from proofs_tests.mutation.survivors import Survivors, described
from proofs_tests.mutation.transplant import transplant

pytestmark = pytest.mark.once  # no line of the library runs here

ORIGINAL = """
import functools

SCALE = 2


def plain(x, by=1):
    return x + by * SCALE


@functools.cache
def cached():
    return 1


class Box:
    side = 3

    def area(self):
        return [self.side * k for k in (1, 2)][0] * self.side

    @property
    def half(self):
        return self.side / 2

    @classmethod
    def made(cls):
        return cls().side + 1
"""


def _imported(tmp_path: Path) -> types.ModuleType:
    path = tmp_path / "original.py"
    path.write_text(ORIGINAL, encoding="utf-8")
    spec = importlib.util.spec_from_file_location("original", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.obligation("X1", "a mutant is put into a running process just as importing it would", method="named cases")
class TestTransplant:
    """A change inside of functions is exchanged where the functions live; any other change is refused."""

    @pytest.mark.parametrize(
        ("old", "new", "value"),
        [
            ("x + by", "x - by", lambda m: m.plain(5)),
            ("return 1", "return 2", lambda m: m.cached()),
            ("* self.side", "+ self.side", lambda m: m.Box().area()),
            ("self.side * k", "self.side - k", lambda m: m.Box().area()),
            ("self.side / 2", "self.side * 2", lambda m: m.Box().half),
            ("side + 1", "side - 1", lambda m: m.Box.made()),
        ],
    )
    def test_functions_are_exchanged(self, tmp_path: Path, old: str, new: str, value: "types.FunctionType") -> None:
        module = _imported(tmp_path)
        mutated = ORIGINAL.replace(old, new)
        fresh: dict[str, object] = {"__name__": "fresh"}
        exec(mutated, fresh)
        expected, before = value(types.SimpleNamespace(**fresh)), value(_imported(tmp_path))
        assert transplant(module, ORIGINAL, mutated)
        assert value(module) == expected != before

    @pytest.mark.parametrize(
        ("old", "new"),
        [("SCALE = 2", "SCALE = 3"), ("by=1", "by=2"), ("side = 3", "side = 4"), ("    @property\n", "")],
    )
    def test_control_anything_else_is_refused(self, tmp_path: Path, old: str, new: str) -> None:
        """Changes outside of functions, which cannot be exchanged in place."""
        module = _imported(tmp_path)
        assert not transplant(module, ORIGINAL, ORIGINAL.replace(old, new))
        assert (module.plain(5), module.Box().area()) == (7, 9)

    def test_the_original_is_no_mutant(self, tmp_path: Path) -> None:
        assert not transplant(_imported(tmp_path), ORIGINAL, ORIGINAL)


@pytest.mark.obligation(
    "X1", "each mutant is another program, and none is one that no test can see", method="enumeration"
)
class TestMutants:
    """Each mutant parses, differs from the original in one line, and is none of what never runs."""

    def test_each_changes_one_line(self) -> None:
        mutants = list(mutants_of("kernel/exactkernel/coordinates.py"))
        original = (ROOT / mutants[0].file).read_text(encoding="utf-8").splitlines()
        sources = {mutant: mutant.source() for mutant in mutants}
        assert len(set(sources.values())) == len(mutants) > 25
        for mutant, source in sources.items():
            compile(source, mutant.file, "exec")
            lines = source.splitlines()
            changed = [i for i, (a, b) in enumerate(zip(original, lines, strict=False), start=1) if a != b]
            assert changed == [mutant.line] or (changed[0] == mutant.line and len(lines) < len(original))

    def test_annotations_and_compiling_decorators_are_left_alone(self) -> None:
        for mutant in mutants_of("kernel/exactkernel/orient2d.py"):
            assert not mutant.before.startswith("@jit")

    def test_the_files_are_those_that_the_proofs_stand_on(self) -> None:
        files = source_files()
        assert {"kernel/exactkernel/incircle.py", "mesh/exactmesh/quadedge.py", "mesh/exactmesh/lawson.py"} <= {*files}
        assert all((ROOT / file).exists() for file in files)

    def test_control_a_listed_survivor_is_a_mutant_of_today(self) -> None:
        """A survivor that is listed, but that no change of today's source yields, is found."""
        listed = set(Survivors.listed().reasons)
        changes = [mutant.partition(": ")[2] for mutant in listed]
        lines = {change[: arrow.start()] for change in changes for arrow in re.finditer(" -> ", change)}
        mutants = (mutant for file in source_files() for mutant in mutants_of(file) if mutant.before in lines)
        assert not listed - {described(mutant) for mutant in mutants}


@pytest.mark.obligation("X1", "a listed reason that a test refutes is told", method="named cases")
class TestSurvivors:
    """A mutant that survives is explained by the lists, or not; one that is listed and killed refutes its reason."""

    mutant = next(iter(mutants_of("kernel/exactkernel/types.py")))
    other = next(iter(mutants_of("kernel/exactkernel/codes.py")))

    def test_explained(self) -> None:
        survivors = Survivors({described(self.mutant): "why"})
        results = [Result(mutant, "survived", "") for mutant in (self.mutant, self.other)]
        assert survivors.unexplained(results) == results[1:]
        assert not survivors.refuted(results)

    @pytest.mark.parametrize("outcome", ["killed", "timeout"])
    def test_control_a_listed_mutant_that_is_killed(self, outcome: str) -> None:
        """A reason of a mutant that a test kills."""
        survivors = Survivors({described(self.mutant): "why"})
        killed = Result(self.mutant, outcome, "a/test_b.py::test_1")
        assert survivors.refuted([killed, Result(self.other, "killed", "")]) == [killed]

    def test_another_place_of_the_same_words_may_be_killed(self) -> None:
        survivors = Survivors({described(self.mutant): "why"})
        assert not survivors.refuted([Result(self.mutant, outcome, "") for outcome in ("survived", "killed")])


@pytest.mark.obligation("X1", "the page tells of all files, and at least 95 % of the mutants killed", method="mutation")
class TestPage:
    """The last campaign met the bar in each room, and the page that tells of it adds up."""

    def test_the_bar(self) -> None:
        scores = Scores.told((ROOT / "docs" / "mutation.md").read_text(encoding="utf-8"))
        files = {name_of(file): Path(file).parent for file in source_files() if next(mutants_of(file), None)}
        assert set(scores.total) == {"all", *files}
        for counts in (scores.total, scores.killed, scores.late, scores.same):
            assert 2 * counts["all"] == counts.total()
        assert scores.of("all") >= BAR
        for room in set(files.values()):
            names = [name for name, folder in files.items() if folder == room]
            killed, others = (
                sum(counts[name] for name in names) for counts in (scores.killed, scores.total - scores.same)
            )
            assert killed >= BAR * others, room

    def test_control_a_page_below_the_bar(self) -> None:
        """A page with a mutant that survived without a reason, beside one that was killed."""
        mutants = list(mutants_of("kernel/exactkernel/types.py"))[:3]
        outcomes = [
            Result(m, outcome, "") for m, outcome in zip(mutants, ("killed", "survived", "survived"), strict=True)
        ]
        text = page(outcomes, Survivors({described(mutants[2]): "why"}))
        scores = Scores.told(text)
        assert (scores.total["all"], scores.killed["all"], scores.same["all"]) == (3, 1, 1)
        assert scores.of("all") == 0.5 < BAR


@pytest.mark.obligation("X1", "the tests of a mutant are those that run its line", method="named cases")
class TestCovering:
    """A line's tests, those of a fixture's file, and for lines that run on import all tests of the file."""

    mutant = Mutant("kernel/exactkernel/types.py", "AddNot", 0, 7, "f", "if x:")

    def test_tests_of_the_line(self) -> None:
        lines = {self.mutant.file: {7: ["a/test_b.py::test_1", "a/test_c.py"], 8: ["a/test_b.py::test_2"]}}
        seconds = {"a/test_b.py::test_1": 2.0, "a/test_b.py::test_2": 1.0, "a/test_c.py::T::test_3": 0.5}
        covering = Covering(lines, seconds)
        assert covering.tests(self.mutant) == ["a/test_c.py::T::test_3", "a/test_b.py::test_1"]

    def test_lines_that_run_on_import(self) -> None:
        lines = {self.mutant.file: {7: [""], 8: ["a/test_b.py::test_2"]}}
        covering = Covering(lines, {"a/test_b.py::test_1": 2.0, "a/test_b.py::test_2": 1.0})
        assert covering.tests(self.mutant) == ["a/test_b.py::test_2"]

    @pytest.mark.parametrize("place", ["/here/kernel", "/venv/lib/python3.11/site-packages"])
    def test_recorded_wherever_the_packages_lie(self, tmp_path: Path, place: str) -> None:
        data = CoverageData(str(tmp_path / "coverage"))
        data.set_context("a/test_b.py::test_1")
        data.add_lines({f"{place}/exactkernel/types.py": [7], f"{place}/other/types.py": [8]})
        data.write()
        times = tmp_path / "times.xml"
        times.write_text('<testsuite><testcase classname="a.test_b" name="test_1" time="2.0"/></testsuite>')
        covering = Covering.recorded(tmp_path / "coverage", [times], source_files())
        assert covering.tests(self.mutant) == ["a/test_b.py::test_1"]
        assert dict(covering.lines[self.mutant.file]) == {7: ["a/test_b.py::test_1"]}

    def test_control_no_test(self) -> None:
        """A line that no test runs."""
        assert Covering({}, {"a/test_b.py::test_1": 1.0}).tests(self.mutant) == []
