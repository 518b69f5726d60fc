"""Which mutants there are: cosmic-ray's, in the files that every proof stands on.

Of each operator of the language one or two replacements are taken, those that are hardest to tell from the original: a
number that moves by one, a comparison that includes its border, a sum for a difference. What runs in no test is not
mutated: annotations, type aliases, what only a type checker reads, and the decorators that compile, which do nothing in
the interpreted lane.
"""

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import cosmic_ray.plugins
from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from cosmic_ray.operators.operator import Operator
from parso.python.tree import Number, PythonLeaf
from parso.tree import NodeOrLeaf

__all__ = ["Mutant", "mutants_of", "source_files", "statement_of"]

ROOT = Path(__file__).resolve().parents[2]

_BINARY = {
    "Add": ["Sub"], "Sub": ["Add"], "Mul": ["Add"], "Div": ["Mul"], "FloorDiv": ["Mul"], "Mod": ["FloorDiv"],
    "Pow": ["Mul"], "LShift": ["RShift"], "RShift": ["LShift"], "BitAnd": ["BitOr"], "BitOr": ["BitAnd"],
    "BitXor": ["BitAnd"],
}  # fmt: skip
_COMPARISON = {
    "Lt": ["LtE", "GtE"], "LtE": ["Lt", "Gt"], "Gt": ["GtE", "LtE"], "GtE": ["Gt", "Lt"], "Eq": ["NotEq"],
    "NotEq": ["Eq"], "Is": ["IsNot"], "IsNot": ["Is"],
}  # fmt: skip
OPERATORS = [
    *(f"ReplaceBinaryOperator_{old}_{new}" for old, news in _BINARY.items() for new in news),
    *(f"ReplaceComparisonOperator_{old}_{new}" for old, news in _COMPARISON.items() for new in news),
    "ReplaceUnaryOperator_USub_UAdd", "ReplaceUnaryOperator_Delete_Not", "ReplaceUnaryOperator_Delete_Invert",
    "AddNot", "ReplaceAndWithOr", "ReplaceOrWithAnd", "ReplaceTrueWithFalse", "ReplaceFalseWithTrue",
    "NumberReplacer", "ReplaceBreakWithContinue", "ReplaceContinueWithBreak", "ZeroIterationForLoop",
    "RemoveDecorator", "ExceptionReplacer",
]  # fmt: skip

#: Decorators without effect on what the interpreted lane computes.
_INERT = {"jit", "jit_inline", "overload", "cache", "functools.cache", "override"}


@dataclass(frozen=True)
class Mutant:
    """One change of one file: the occurrence-th place of an operator of cosmic-ray."""

    file: str
    operator: str
    occurrence: int
    line: int
    function: str
    before: str

    def source(self) -> str:
        """Return the mutated file."""
        mutated = mutate_code((ROOT / self.file).read_text(encoding="utf-8"), _operator(self.operator), self.occurrence)
        assert mutated is not None, self
        return str(mutated)

    def after(self) -> str:
        """Return the mutated line."""
        lines = self.source().splitlines()
        shorter = len(lines) < len((ROOT / self.file).read_text(encoding="utf-8").splitlines())
        return "nothing" if shorter else " ".join(lines[self.line - 1].split())


def source_files() -> list[str]:
    """Return the files of the kernel, the verifier and the algorithms, relative to the root."""
    meshes = ROOT / "mesh" / "exactmesh"
    named = [meshes / f"{name}.py" for name in ("quadedge", "edgealgebra", "delaunay", "lawson", "constrain")]
    rooms = [*(ROOT / "kernel" / "exactkernel").glob("*.py"), *(meshes / "verify").glob("*.py")]
    return sorted(path.relative_to(ROOT).as_posix() for path in [*rooms, *named])


def _operator(name: str) -> Operator:
    operator: Operator = cosmic_ray.plugins.get_operator(f"core/{name}")()
    return operator


def mutants_of(file: str) -> Iterator[Mutant]:
    """Yield the mutants of a file, operator by operator."""
    source = (ROOT / file).read_text(encoding="utf-8")
    nodes, lines = list(ast_nodes(get_ast(source))), source.splitlines()
    tree = ast.parse(source)
    unread, functions = list(_unread(tree)), list(_functions(tree))
    for name in OPERATORS:
        operator = _operator(name)
        places = [(node, position) for node in nodes for position in operator.mutation_positions(node)]
        for occurrence, (node, (start, _)) in enumerate(places):
            if isinstance(node, Number) and occurrence % 2 == _is_zero(node):
                continue
            if _is_marker(node):
                continue
            if not any(first <= start < last for first, last in unread):
                inner = [(first, qualified) for first, last, qualified in functions if first <= start[0] <= last]
                function = max(inner)[1] if inner else ""
                yield Mutant(file, name, occurrence, start[0], function, lines[start[0] - 1].strip())


def statement_of(mutant: Mutant) -> range:
    """Return the lines of the innermost statement around the mutated line; of a compound one, its head."""
    spans = [span for span in _statements(mutant.file) if mutant.line in span]
    return min(spans, key=len, default=range(mutant.line, mutant.line + 1))


@cache
def _statements(file: str) -> list[range]:
    tree = ast.parse((ROOT / file).read_text(encoding="utf-8"))
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.stmt):
            body = getattr(node, "body", [])
            last = body[0].lineno - 1 if body else (node.end_lineno or node.lineno)
            found.append(range(node.lineno, max(last, node.lineno) + 1))
    return found


def _is_marker(node: NodeOrLeaf) -> bool:
    """Tell whether stars unpack, or make parameters keywords: cosmic-ray takes them for products and powers."""
    if not isinstance(node, PythonLeaf) or node.value not in ("*", "**"):
        return False
    return node.parent is None or node.parent.type not in ("term", "power")


def _is_zero(number: Number) -> bool:
    """Zero becomes one, anything else one less: cosmic-ray's even places add, its odd ones subtract."""
    return bool(ast.literal_eval(number.value) == 0)


_Place = tuple[int, int]


def _span(node: ast.expr | ast.stmt) -> tuple[_Place, _Place]:
    return (node.lineno, node.col_offset), (node.end_lineno or node.lineno, node.end_col_offset or 0)


def _unread(tree: ast.Module) -> Iterator[tuple[_Place, _Place]]:
    """Yield the spans that no test runs."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            inert = [d for d in node.decorator_list if ast.unparse(d).split("(")[0] in _INERT]
            yield from (((d.lineno, 0), (d.lineno + 1, 0)) for d in inert)
            if any(ast.unparse(d) == "overload" for d in inert):
                yield _span(node)
        if isinstance(node, ast.arg | ast.AnnAssign) and node.annotation:
            yield _span(node.annotation)
            if isinstance(node, ast.AnnAssign) and ast.unparse(node.annotation) == "TypeAlias":
                yield _span(node)
        if isinstance(node, ast.FunctionDef) and node.returns:
            yield _span(node.returns)
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            yield _span(node)
        if isinstance(node, ast.Call) and ast.unparse(node.func) == "cast":
            yield _span(node.args[0])


def _functions(tree: ast.AST, outer: str = "") -> Iterator[tuple[int, int, str]]:
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            name = f"{outer}{node.name}"
            yield min([node.lineno, *(d.lineno for d in node.decorator_list)]), node.end_lineno or node.lineno, name
            yield from _functions(node, f"{name}.")
        else:
            yield from _functions(node, outer)
