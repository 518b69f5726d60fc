"""Which lines of the code compute or compare with a floating-point bound, found in their sources.

In compiled functions: every line with a constant of its module that is a double, with a bound of the context, with a
negative power of two, and every line that computes, or compares with, a local error, margin, doubt, slack, bound or
limit. In the others, which prepare or format: every line with a constant that is named as bounds are, or a bound of the
context.
"""

import ast
import importlib
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

__all__ = ["Line", "lines_with_bounds"]

ROOTS = (Path(__file__).resolve().parents[2] / "kernel", Path(__file__).resolve().parents[2] / "mesh")

#: Names of bounds, margins and guards, in the code's own manner of speaking.
_NAMES = re.compile(
    r"\w*(BOUND|MARGIN|SLACK|ERROR|DOUBT|FACTOR|WEIGHT|UNDERFLOW|RELATIVE|ABSOLUTE|ROUNDOFF|SMALL|ENOUGH|PRODUCT|STEPS"
    r"|SAFE|M(IN|AX)_COORDINATE|LOST_BITS)\w*"
)
_INTEGERS = frozenset({"_LOST_BITS", "_SMALLEST_EXPONENT"})  # of powers of two
_LOCALS = re.compile(r"(\w*_)?(error|margin|doubt|slack|bound|limit)")
_ATTRIBUTES = frozenset({"orient2d_bound", "incircle_bound", "grid_limit"})
#: A limit of exact comparisons; of a walk; and what numbers the questions to the rationals.
_NO_BOUNDS = frozenset({"MEASURE_BOUND", "_STEPS", "_CHILD_ERROR", "ANGLE", "AREA", "LENGTH"})

_DECIDES_NOTHING = frozenset({"strategies", "plot.py"})


@dataclass(frozen=True)
class Line:
    """A statement, or what an ``if`` or a loop asks.

    Attributes:
        function: module.function.
        text: with single spaces.
        bounds: the bounds that it names, as they are written.
    """

    function: str
    text: str
    bounds: frozenset[str]

    def is_in(self, cited: str) -> bool:
        """Tell whether a line that is cited is this one, or a part of it with all of its bounds."""
        shorter = re.sub(r"^(?:if|elif|while) |:$", "", cited)
        part = re.search(rf"(?:^|[\s(]){re.escape(shorter)}(?:$|[\s),])", self.text) is not None
        return self.text in shorter or (part and all(bound in shorter for bound in self.bounds))


def _is_compiled(function: ast.FunctionDef) -> bool:
    return any(isinstance(d, ast.Name) and d.id in ("jit", "jit_inline") for d in function.decorator_list)


def _is_constant(module: ModuleType, name: str) -> bool:
    value = getattr(module, name, None)
    return isinstance(value, float) and math.isfinite(value)


def _bounds_in(node: ast.AST, module: ModuleType, compiled: bool, compared: bool) -> set[str]:
    """Return the bounds in an expression."""
    compared |= isinstance(node, ast.Compare)
    found = set()
    if isinstance(node, ast.Name) and node.id not in _NO_BOUNDS:
        named = _is_constant(module, node.id) and (compiled or _NAMES.fullmatch(node.id) is not None)
        if named or node.id in _INTEGERS or (compiled and compared and _LOCALS.fullmatch(node.id)):
            found.add(node.id)
    elif isinstance(node, ast.Attribute) and node.attr in _ATTRIBUTES:
        found.add(node.attr)
    elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow) and isinstance(node.right, ast.UnaryOp):
        found.add(ast.unparse(node))
    return found.union(*(_bounds_in(inner, module, compiled, compared) for inner in ast.iter_child_nodes(node)))


def _statements(node: ast.AST) -> Iterator[ast.stmt]:
    """Yield the statements of a function, not those of functions inside it."""
    for inner in ast.iter_child_nodes(node):
        if isinstance(inner, ast.expr | ast.FunctionDef | ast.ClassDef):
            continue
        if isinstance(inner, ast.stmt):
            yield inner
        yield from _statements(inner)  # of the cases of a match, too


def _lines_of(function: ast.FunctionDef, module: ModuleType, text: str) -> Iterator[Line]:
    compiled, name = _is_compiled(function), f"{module.__name__}.{function.name}"
    for statement in _statements(function):
        asked = [inner for inner in ast.iter_child_nodes(statement) if isinstance(inner, ast.expr)]
        computes = compiled and any(isinstance(inner, ast.Name) and _LOCALS.fullmatch(inner.id) for inner in asked[:1])
        bounds = set().union(*(_bounds_in(inner, module, compiled, computes) for inner in asked[computes:]))
        if bounds or computes:
            part = asked[0] if hasattr(statement, "body") else statement
            yield Line(name, " ".join((ast.get_source_segment(text, part) or "").split()), frozenset(bounds))


def lines_with_bounds() -> list[Line]:
    """Return the lines of the kernel and of the mesh library that compute a bound or compare with one."""
    found = []
    for root in ROOTS:
        for path in sorted(root.rglob("*.py")):
            text = path.read_text(encoding="utf-8")
            if _DECIDES_NOTHING & set(path.parts) or not ("jit" in text or _NAMES.search(text) or "_bound" in text):
                continue
            module = importlib.import_module(".".join(path.relative_to(root).with_suffix("").parts))
            functions = (node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef))
            found += [line for function in functions for line in _lines_of(function, module, text)]
    return found
