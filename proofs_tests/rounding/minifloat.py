"""The shipped source, run in tiny floating-point formats.

A statement about error-free transforms or filters that holds for every precision can be checked *exhaustively* where
the precision is three to ten bits. ``derive`` takes the source of the shipped functions, wraps every arithmetic
operation into a rounding to p bits (half to even, exponents unbounded unless a quantum is given), and returns what it
defines. The double operation underneath is exact, because tiny operands have tiny sums and products.
"""

import ast
import inspect
import math
import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, TypeAlias

import numba
import numpy as np
import numpy.typing as npt
from numba.extending import overload

from exactkernel.jit import COMPILED

__all__ = ["Arithmetic", "Backend", "MiniFloat", "all_numbers", "derive", "round_array"]

Floats: TypeAlias = npt.NDArray[np.float64]
Arithmetic: TypeAlias = Callable[..., Any]  # what the derived source returns, nobody declares


class Backend(Enum):
    """How the derived functions run."""

    ARRAYS = "over numpy arrays, element by element; for functions without loops"
    LOOPS = "compiled by numba (interpreted with NUMBA_DISABLE_JIT=1)"
    PYTHON = "plain Python: nothing to compile, for a few thousand calls"


@dataclass(frozen=True)
class MiniFloat:
    """A format: p bits, and a smallest subnormal (0: there is no underflow).

    ``constants`` are what the source means by other names: numbers, and functions that are called and not derived.
    ``edits`` are seeded faults: in the source of the named function, the first text becomes the second.
    """

    precision: int
    quantum: float = 0.0
    constants: Mapping[str, object] = field(default_factory=dict)
    edits: Mapping[str, tuple[str, str]] = field(default_factory=dict)

    @property
    def splitter(self) -> float:
        """Veltkamp's splitter of this precision."""
        return float(2 ** math.ceil(self.precision / 2) + 1)


def round_array(x: Floats, precision: int, quantum: float = 0.0) -> Floats:
    """Round to p bits, ties to even, on the bit patterns; below 2^(p-1) quanta, to a multiple of the quantum."""
    bits = np.array(x, dtype=np.float64).view(np.int64)
    dropped = 53 - precision
    half = (np.int64(1) << (dropped - 1)) - 1
    bits += half + ((bits >> dropped) & 1)
    bits &= ~((np.int64(1) << dropped) - 1)
    rounded = bits.view(np.float64)
    if quantum > 0.0:
        rounded = np.where(np.abs(x) < quantum * 2.0 ** (precision - 1), np.rint(x / quantum) * quantum, rounded)
    return rounded


def _round_scalar(x: float, precision: int) -> float:
    """Round to p bits by another road than ``round_array``: the significand as an integer."""
    fraction, exponent = math.frexp(x)
    return math.ldexp(float(np.rint(math.ldexp(fraction, precision))), exponent - precision)


def _rounded(x: float, precision: int, quantum: float) -> float:
    if isinstance(x, int | np.integer):
        return x
    if abs(x) < quantum * 2.0 ** (precision - 1):
        return float(np.rint(x / quantum) * quantum)
    return _round_scalar(x, precision)


def _rounded_float(x: float, precision: int, quantum: float) -> float:
    """As ``round_array``, for one number: in a compiled loop some nanoseconds."""
    if abs(x) < quantum * 2.0 ** (precision - 1):
        return float(np.rint(x / quantum) * quantum)
    bits = np.float64(x).view(np.int64)
    dropped = 53 - precision
    bits += ((np.int64(1) << (dropped - 1)) - 1) + ((bits >> dropped) & 1)
    bits &= ~((np.int64(1) << dropped) - 1)
    rounded: float = np.int64(bits).view(np.float64)
    return rounded


def _kept_integer(x: float, precision: int, quantum: float) -> float:  # called as _rounded_float is
    return x


def _is_float_type(numba_type: object) -> bool:
    return isinstance(numba_type, numba.types.Float)


@overload(_rounded)
def _rounded_overload(
    x: float,
    precision: int,  # numba's rule: all arguments by their names
    quantum: float,
) -> Callable[[float, int, float], float]:
    return _rounded_float if _is_float_type(x) else _kept_integer


class _Rounding(ast.NodeTransformer):
    """Wraps each binary operation; over arrays a conditional expression selects element by element."""

    def __init__(self, backend: Backend) -> None:
        self.arrays = backend is Backend.ARRAYS

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.FunctionDef:
        node.decorator_list, node.returns = [], None
        for argument in node.args.args:
            argument.annotation = None
        self.generic_visit(node)
        return node

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        self.generic_visit(node)
        return ast.Call(ast.Name("fl", ast.Load()), [node], [])

    def visit_AugAssign(self, node: ast.AugAssign) -> ast.stmt:
        raise_unless_counter(node)
        return node

    def visit_IfExp(self, node: ast.IfExp) -> ast.expr:
        self.generic_visit(node)
        if not self.arrays:
            return node
        return ast.Call(ast.Name("where", ast.Load()), [node.test, node.body, node.orelse], [])


def raise_unless_counter(node: ast.AugAssign) -> None:
    """An augmented assignment in the kernel counts components; one of doubles would escape the rounding."""
    if not (isinstance(node.value, ast.Constant) and isinstance(node.value.value, int)):
        raise NotImplementedError(f"line {node.lineno}: an augmented assignment that is no counter")


def _source(function: Arithmetic) -> str:
    return textwrap.dedent(inspect.getsource(getattr(function, "py_func", function)))


def _edited(name: str, source: str, edits: Mapping[str, tuple[str, str]]) -> str:
    if name not in edits:
        return source
    old, new = edits[name]
    if old not in source:
        raise LookupError(f"the source of {name} no longer contains {old!r}: renew the negative control")
    return source.replace(old, new)


def derive(functions: Sequence[Arithmetic], mini: MiniFloat, backend: Backend) -> dict[str, Arithmetic]:
    """Return the functions by name, in the arithmetic of the format; each may call those before it."""
    precision, quantum = mini.precision, mini.quantum
    compiled = backend is Backend.LOOPS and COMPILED

    def rounding() -> Arithmetic:
        if backend is Backend.ARRAYS:
            return lambda x: round_array(x, precision, quantum)
        if compiled:
            wrapper: Arithmetic = numba.njit(lambda x: _rounded(x, precision, quantum))
            return wrapper
        return lambda x: _rounded(x, precision, quantum)

    scope: dict[str, object] = {"fl": rounding(), "where": np.where, "math": math, "SPLITTER": mini.splitter}
    scope.update(mini.constants)
    for function in functions:
        name = function.__name__
        tree = ast.parse(_edited(name, _source(function), mini.edits))
        tree = ast.fix_missing_locations(_Rounding(backend).visit(tree))
        exec(compile(tree, f"<{name} in {precision} bits>", "exec"), scope)
        if compiled:
            scope[name] = numba.njit(scope[name])
    return {f.__name__: derived for f in functions if callable(derived := scope[f.__name__])}


def all_numbers(precision: int, exponents: range) -> Floats:
    """Return zero and every number of p bits, of both signs, whose unit in the last place is 2^e."""
    significands = np.arange(2 ** (precision - 1), 2**precision, dtype=np.float64)
    positive = np.concatenate([significands * 2.0**e for e in exponents])
    return np.concatenate([-positive[::-1], [0.0], positive])
