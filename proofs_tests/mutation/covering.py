"""Which tests can see a mutant: those that run its line, the quickest first."""

import xml.etree.ElementTree as ElementTree
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from coverage import CoverageData
from proofs_tests.mutation.mutants import Mutant, statement_of

__all__ = ["Covering"]


@dataclass(frozen=True)
class Covering:
    """What the interpreted lane recorded: the tests of each line of each file, and how long each test takes."""

    lines: Mapping[str, Mapping[int, Sequence[str]]]
    seconds: Mapping[str, float]

    @classmethod
    def recorded(cls, coverage: Path, times: Sequence[Path], files: Sequence[str]) -> "Covering":
        """Read coverage's data, whose contexts are tests, and pytest's reports in JUnit's XML."""
        data = CoverageData(str(coverage))
        data.read()
        lines: dict[str, dict[int, list[str]]] = {file: defaultdict(list) for file in files}
        for path in data.measured_files():
            for file in (file for file in files if path.endswith(_installed(file))):
                for line, contexts in data.contexts_by_lineno(path).items():
                    lines[file][line] += contexts
        cases = [case for path in times for case in ElementTree.parse(path).iter("testcase")]
        return cls(lines, {_node(case): float(case.attrib["time"]) for case in cases})

    @cached_property
    def touched(self) -> Mapping[str, set[str]]:
        """The files that each test, or the making of a test file's fixtures, runs lines of."""
        files: dict[str, set[str]] = defaultdict(set)
        for file, lines in self.lines.items():
            for contexts in lines.values():
                for context in contexts:
                    files[context].add(file)
        return files

    def tests(self, mutant: Mutant) -> list[str]:
        """Return the tests that run the mutated statement; if it runs on import, all that run a line of its folder."""
        lines = self.lines.get(mutant.file, {})
        contexts = {context for line in statement_of(mutant) for context in lines.get(line, ())}
        if contexts == {""}:  # processes that tests start run lines in no context as well
            folder = Path(mutant.file).parent
            near = [there for file, there in self.lines.items() if Path(file).parent == folder]
            contexts = {context for there in near for line in there.values() for context in line}
        files = {context for context in contexts if context.endswith(".py")}
        found = [test for test in self.seconds if test in contexts or test.split("::")[0] in files]
        return sorted(found, key=lambda test: self._cost(mutant, test))

    def _cost(self, mutant: Mutant, test: str) -> float:
        """Quick tests first, and those that are about little else: they run lines of few files, this one among them."""
        files = self.touched.get(test, set())
        return (self.seconds[test] + 0.002) * (len(files) + 1) * (1 if mutant.file in files else 4)


def _installed(file: str) -> str:
    """Return how the path of a source file ends wherever it lies: in a checkout, or where pip has put the packages."""
    return "/" + file.partition("/")[2]


def _node(case: ElementTree.Element) -> str:
    """Return pytest's name of a test case: path::class::name."""
    parts = case.attrib["classname"].split(".")
    depth = next(i for i, part in enumerate(parts) if part.startswith("test_")) + 1
    return "::".join(["/".join(parts[:depth]) + ".py", *parts[depth:], case.attrib["name"]])
