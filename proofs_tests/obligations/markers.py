"""The markers, read out of the sources of the tests."""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from proofs_tests.obligations.method import Method

__all__ = ["Obligation", "collect", "table"]

HERE = Path(__file__).resolve().parent.parent
ROOT = HERE.parent


@dataclass(frozen=True, order=True)
class Obligation:
    """One marker on one test class, or test function."""

    id: tuple[str, int]
    statement: str
    file: str
    name: str
    line: int
    controls: int
    method: Method | None

    @classmethod
    def of(cls, node: ast.ClassDef | ast.FunctionDef, call: ast.Call, path: Path) -> "Obligation":
        identifier, statement = (ast.literal_eval(argument) for argument in call.args)
        letters, digits = re.fullmatch(r"([A-Z]+)(\d+)", identifier).groups()  # type: ignore[union-attr]  # or fail
        where = path.relative_to(ROOT).as_posix()
        controls = sum(isinstance(inner, ast.FunctionDef) and "control" in inner.name for inner in ast.walk(node))
        keywords = {keyword.arg: ast.literal_eval(keyword.value) for keyword in call.keywords}
        method = Method(keywords["method"]) if "method" in keywords else None
        return cls((letters, int(digits)), statement, where, node.name, node.lineno, controls, method)


def _marker(decorator: ast.expr) -> ast.Call | None:
    if isinstance(decorator, ast.Call) and ast.unparse(decorator.func) == "pytest.mark.obligation":
        return decorator
    return None


def collect(folder: Path = HERE) -> list[Obligation]:
    """Return the obligations of all test files, sorted."""
    return sorted(found for path in sorted(folder.rglob("test_*.py")) for found in _of_file(path))


def _of_file(path: Path) -> Iterator[Obligation]:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ClassDef | ast.FunctionDef):
            for decorator in node.decorator_list:
                if call := _marker(decorator):
                    yield Obligation.of(node, call, path)


def table(obligations: list[Obligation]) -> str:
    """Return the page, in Markdown."""
    lines = [
        "# Obligations",
        "",
        "Each line is a statement that a test class proves or tests, and the number of its negative controls: seeded",
        "faults that the same check must refuse. Made by `python -m proofs_tests.obligations`.",
        "",
        "| id | statement | where | controls |",
        "|---|---|---|---|",
    ]
    lines += [
        f"| {''.join(map(str, o.id))} | {o.statement} | `{o.file}` {o.name} | {o.controls or ''} |" for o in obligations
    ]
    return "\n".join(lines) + "\n"
