"""The markers, read out of the sources of the tests, so that nothing needs to be imported or run."""

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from proofs_tests.obligations.method import Method

__all__ = ["Control", "MarkerError", "Obligation", "collect"]

HERE = Path(__file__).resolve().parent.parent
ROOT = HERE.parent


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
    controls: tuple[Control, ...]
    control_in: str  # the class, or file::class, whose controls are those of this class too

    @classmethod
    def of(cls, node: ast.ClassDef, call: ast.Call, path: Path) -> "Obligation":
        place = f"{path.relative_to(ROOT).as_posix()}::{node.name}"
        try:
            identifier, statement = (ast.literal_eval(argument) for argument in call.args)
            keywords = {str(keyword.arg): ast.literal_eval(keyword.value) for keyword in call.keywords}
            method = Method(keywords.pop("method"))
            control_in = keywords.pop("control_in", "")
            if keywords:
                raise ValueError(f"unknown: {', '.join(keywords)}")
        except (ValueError, KeyError) as error:
            raise MarkerError(
                f"{place}, line {node.lineno}: the marker is obligation(id, statement, method=, control_in=), all"
                f" literals, control_in optional, method one of {', '.join(Method)}: {error}"
            ) from error
        if control_in and "::" not in control_in:
            control_in = f"{path.relative_to(ROOT).as_posix()}::{control_in}"
        return cls(identifier, statement, method, place, node.lineno, tuple(_controls(node)), control_in)


def _controls(node: ast.ClassDef) -> Iterator[Control]:
    for inner in node.body:
        if isinstance(inner, ast.FunctionDef) and inner.name.startswith("test") and "control" in inner.name:
            yield Control(inner.name, (ast.get_docstring(inner) or "").partition("\n\n")[0].replace("\n", " "))


def _marker(decorator: ast.expr) -> ast.Call | None:
    if isinstance(decorator, ast.Call) and ast.unparse(decorator.func) == "pytest.mark.obligation":
        return decorator
    return None


def collect(folder: Path = HERE) -> list[Obligation]:
    """Return the obligations of all test files in ``folder`` and below, in the order of files and lines."""
    return [found for path in sorted(folder.rglob("test_*.py")) for found in _of_file(path)]


def _of_file(path: Path) -> Iterator[Obligation]:
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ClassDef):
            for decorator in node.decorator_list:
                if call := _marker(decorator):
                    yield Obligation.of(node, call, path)
