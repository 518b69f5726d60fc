"""The markers, read out of the sources of the tests, so that nothing needs to be imported or run."""

import ast
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from proofs_tests.obligations.method import Method

__all__ = ["Control", "MarkerError", "Obligation", "collect"]

ROOT = Path(__file__).resolve().parents[2]


class MarkerError(ValueError):
    """A marker that says too little: where it stands, and what is missing."""


@dataclass(frozen=True)
class Control:
    """A test method with ``control`` in its name, and the first line of its docstring: the fault that it seeds."""

    name: str
    fault: str


@dataclass(frozen=True)
class Obligation:
    """One marker on one test class."""

    id: str
    statement: str
    method: Method
    place: str  # file::class, as pytest names it
    line: int
    controls: tuple[Control, ...]  # its own, and those of the class that control_in names

    @property
    def file(self) -> str:
        """The file of the class, from the root of the project."""
        return self.place.partition("::")[0]


def collect(root: Path = ROOT) -> list[Obligation]:
    """Return the obligations of the test files under ``root``, in the order of files and lines."""
    files = sorted((root / "proofs_tests").rglob("test_*.py"))
    classes = {
        f"{path.relative_to(root).as_posix()}::{node.name}": node
        for path in files
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.ClassDef)
    }
    return [_read(call, place, classes) for place, node in classes.items() for call in _markers(node)]


def _markers(node: ast.ClassDef) -> Iterator[ast.Call]:
    for decorator in node.decorator_list:
        if isinstance(decorator, ast.Call) and ast.unparse(decorator.func) == "pytest.mark.obligation":
            yield decorator


def _read(call: ast.Call, place: str, classes: Mapping[str, ast.ClassDef]) -> Obligation:
    node = classes[place]
    try:
        identifier, statement = (ast.literal_eval(argument) for argument in call.args)
        keywords = {str(keyword.arg): ast.literal_eval(keyword.value) for keyword in call.keywords}
        method = Method(keywords.pop("method"))
        elsewhere = keywords.pop("control_in", None)
        if keywords:
            raise ValueError(f"unknown: {', '.join(keywords)}")
        controls = [*_controls(node)]
        if elsewhere == "mutants":
            controls.append(Control("mutants", "mutants of the source (X1)"))
        elif elsewhere is not None:
            other = elsewhere if "::" in elsewhere else f"{place.partition('::')[0]}::{elsewhere}"
            controls += (
                Control(control.name, control.fault and f"{control.fault} ({elsewhere.rpartition('::')[2]})")
                for control in _controls(classes[other])
            )
    except (ValueError, KeyError) as error:
        raise MarkerError(
            f"{place}, line {node.lineno}: the marker is obligation(id, statement, method=, control_in=), all literals,"
            f" method one of {', '.join(Method)}; control_in"
            f" mutants, a class here or a file::class, if at all: {error!r}"
        ) from error
    return Obligation(identifier, statement, method, place, node.lineno, tuple(controls))


def _controls(node: ast.ClassDef) -> Iterator[Control]:
    for inner in node.body:
        if isinstance(inner, ast.FunctionDef) and inner.name.startswith("test") and "control" in inner.name:
            fault = (ast.get_docstring(inner) or "").partition("\n\n")[0].replace("\n", " ").rstrip(".")
            yield Control(inner.name, fault)
