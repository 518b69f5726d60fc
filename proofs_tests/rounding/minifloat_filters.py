"""The shipped filters in tiny formats, and how often each certifies a sign that is not the exact one.

Everything after the filter of a predicate (grid stage, double-doubles, expansions, rationals) is replaced by "not
known", so what answers is the filter. Signs are compared with those of integers.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numba
import numpy as np
from proofs_tests.rounding.minifloat import Arithmetic, Backend, Floats, MiniFloat, derive
from proofs_tests.rounding.minifloat_inputs import Axis, axis_of, differences

from exactkernel.bisector import along_adaptive, nearer_adaptive
from exactkernel.context import Context, guarded_context
from exactkernel.diametral import diametral_filter
from exactkernel.incircle import determinant_and_permanent, incircle_filter
from exactkernel.orient2d import orient2d_filter

__all__ = ["FILTERS", "Filter", "Tally", "bound_of", "tally", "tally_of_doubles"]

Tally: TypeAlias = tuple[int, int, int]


@numba.njit
def _no_sign(*_: object) -> int:
    return 0


@numba.njit
def _undecided(*_: object) -> int:
    return 1  # stage 0, sign 0


@numba.njit
def _no_pair(*_: object) -> tuple[float, float]:
    return 0.0, 0.0


#: What comes after the filter of nearer and along.
LATER: dict[str, object] = {
    "along_from_doubles": _no_sign,
    "determinant_2x2": _no_sign,
    "expansion_sign": _no_sign,
    "expansion_sum": _no_sign,
    "nearer_from_doubles": _no_sign,
    "negate": _no_sign,
    "products_difference": _undecided,
    "dd_add": _no_pair,
    "lift_double_double": _no_pair,
    "two_diff": _no_pair,
    "DD_BOUND": 1.0,
}


@dataclass(frozen=True)
class Filter:
    """A filter, and how to try it on pairs of classes.

    Attributes:
        source: the shipped functions, those that it calls first.
        constant: the name of its bound in the source, if it is no argument.
        factor, second: the shipped bound is (factor + second u) u.
        axis: the classes for a precision, a number of binades and a quantum.
        call: (derived function, bound, coordinates, i, j) -> sign.
        exact: (differences, i, j) -> a number of that sign.
    """

    source: tuple[Arithmetic, ...]
    constant: str
    factor: float
    second: float
    axis: Callable[[int, int, float], Axis]
    call: Callable[[Arithmetic], Arithmetic]
    exact: Arithmetic


def _of_three(decide: Arithmetic) -> Arithmetic:
    @numba.njit
    def call(bound: float, c: Floats, i: int, j: int) -> int:
        sign: int = decide(bound, c[0, i], c[0, j], c[1, i], c[1, j], c[2, i], c[2, j])
        return sign

    return call


def _of_four(decide: Arithmetic) -> Arithmetic:
    @numba.njit
    def call(bound: float, c: Floats, i: int, j: int) -> int:
        sign: int = decide(bound, c[0, i], c[0, j], c[1, i], c[1, j], c[2, i], c[2, j], c[3, i], c[3, j])
        return sign

    return call


def _nearer(decide: Arithmetic) -> Arithmetic:
    k = guarded_context()
    scratch, counts, mailbox = k.scratch, k.counts, k.mailbox

    @numba.njit
    def call(bound: float, c: Floats, i: int, j: int) -> int:  # the bound is a constant of the source
        context = Context(1.0, 1.0, 0.0, scratch, counts, mailbox)
        sign: int = decide(context, c[0, i], c[0, j], c[1, i], c[1, j], c[2, i], c[2, j])
        return sign

    return call


def _along(decide: Arithmetic) -> Arithmetic:
    k = guarded_context()
    scratch, counts, mailbox = k.scratch, k.counts, k.mailbox

    @numba.njit
    def call(bound: float, c: Floats, i: int, j: int) -> int:
        context = Context(1.0, 1.0, 0.0, scratch, counts, mailbox)
        sign: int = decide(
            context, c[1, i], c[1, j], c[0, i], c[0, j], c[3, i], c[3, j], c[2, i], c[2, j]
        )  # fmt: skip
        return sign

    return call


@numba.njit
def _cross(e: Floats, i: int, j: int) -> int:
    value: int = e[0, i] * e[1, j] - e[0, j] * e[1, i]
    return value


@numba.njit
def _obtuse(e: Floats, i: int, j: int) -> int:
    value: int = -(e[0, i] * e[1, i] + e[0, j] * e[1, j])
    return value


@numba.njit
def _inner(e: Floats, i: int, j: int) -> int:
    value: int = e[0, i] * e[1, i] + e[0, j] * e[1, j]
    return value


@numba.njit
def _farther(e: Floats, i: int, j: int) -> int:
    value: int = e[0, i] ** 2 + e[0, j] ** 2 - e[1, i] ** 2 - e[1, j] ** 2
    return value


@numba.njit
def _circle(e: Floats, i: int, j: int) -> int:
    a, b, c, A, B, C = e[0, i], e[1, i], e[2, i], e[0, j], e[1, j], e[2, j]
    value: int = (
        (a * a + A * A) * (b * C - c * B) + (b * b + B * B) * (c * A - a * C) + (c * c + C * C) * (a * B - b * A)
    )
    return value


def _corners(precision: int, binades: int, quantum: float) -> Axis:
    return axis_of(precision, binades, 3, ((0, 2), (1, 2)), quantum)


def _sites(precision: int, binades: int, quantum: float) -> Axis:
    return axis_of(precision, binades, 3, ((2, 0), (2, 1)), quantum)


def _circles(precision: int, binades: int, quantum: float) -> Axis:
    return axis_of(precision, binades, 4, ((0, 3), (1, 3), (2, 3)), quantum)


FILTERS: dict[str, Filter] = {
    "orient2d": Filter((orient2d_filter,), "", 3.0, 16.0, _corners, _of_three, _cross),
    "diametral": Filter((diametral_filter,), "", 3.0, 16.0, _corners, _of_three, _obtuse),
    "along": Filter((along_adaptive,), "ORIENT2D_BOUND", 3.0, 16.0, differences, _along, _inner),
    "nearer": Filter((nearer_adaptive,), "_NEARER_BOUND", 4.0, 32.0, _sites, _nearer, _farther),
    "incircle": Filter(
        (determinant_and_permanent, incircle_filter), "", 10.0, 96.0, _circles, _of_four, _circle
    ),
}  # fmt: skip


def bound_of(name: str, precision: int) -> float:
    """Return the shipped bound with the unit roundoff of a precision."""
    u = 2.0**-precision
    return (FILTERS[name].factor + FILTERS[name].second * u) * u


def _loop(call: Arithmetic, exact: Arithmetic) -> Arithmetic:
    @numba.njit
    def run(bound: float, c: Floats, e: Floats, begin: int, step: int) -> Tally:
        certified = lies = tried = 0
        for i in range(begin, c.shape[1], step):
            for j in range(i, c.shape[1]):
                tried += 1
                sign = call(bound, c, i, j)
                if sign != 0:
                    certified += 1
                    value = exact(e, i, j)
                    lies += not ((sign > 0 and value > 0) or (sign < 0 and value < 0))
        return tried, certified, lies

    return run


def tally(
    name: str, mini: MiniFloat, bound: float, axis: Axis, begin: int = 0, step: int = 1
) -> Tally:  # fmt: skip
    """Return how many unordered pairs of classes there are, on how many the filter certifies a sign, and how many of
    these signs are wrong; of every ``step``-th class of x, from ``begin`` on."""
    known = FILTERS[name]
    constants = {**LATER, **mini.constants, **({known.constant: bound} if known.constant else {})}
    mini = MiniFloat(mini.precision, mini.quantum, constants, mini.edits)
    derived = derive(known.source, mini, Backend.LOOPS)[known.source[-1].__name__]
    run = _loop(known.call(derived), known.exact)
    found: Tally = run(bound, axis[0], axis[1], begin, step)
    return found


def tally_of_doubles(name: str, bound: float, count: int) -> Tally:
    """Return the same for random doubles (between 0 and 1) and the filter in doubles, with any bound."""
    known = FILTERS[name]
    function = known.source[-1]
    decide: Arithmetic = getattr(function, "py_func", function)
    random = np.random.default_rng(0)
    points = 4 if name == "incircle" else 3
    certified = lies = 0
    for row in random.integers(0, 2**53, (count, 2 * points)).tolist():
        sign = int(decide(bound, *(x * 2.0**-53 for x in row)))
        xs, ys = row[::2], row[1::2]
        value = _EXACT[name](xs, ys)
        certified += sign != 0
        lies += sign != 0 and sign * value <= 0
    return count, certified, lies


def _orient_exactly(x: list[int], y: list[int]) -> int:
    return (x[0] - x[2]) * (y[1] - y[2]) - (y[0] - y[2]) * (x[1] - x[2])


def _diametral_exactly(x: list[int], y: list[int]) -> int:
    return (x[2] - x[0]) * (x[1] - x[2]) - (y[2] - y[0]) * (y[2] - y[1])


def _circle_exactly(x: list[int], y: list[int]) -> int:
    rows = [(x[i] - x[3], y[i] - y[3]) for i in range(3)]
    total = 0
    for i in range(3):
        (a, b), (p, q), (r, s) = rows[i], rows[(i + 1) % 3], rows[(i + 2) % 3]
        total += (a * a + b * b) * (p * s - q * r)
    return total


_EXACT = {"orient2d": _orient_exactly, "diametral": _diametral_exactly, "incircle": _circle_exactly}
