"""The predicates in gmpy2 rationals: the last stage, the oracle, and the path of coordinates that are no
doubles.

Compiled loops reach them through C callbacks, registered by name with LLVM so that cached machine code finds them in a
later process. When a callback raises (and Ctrl-C raises at its very entry), ctypes returns whatever lay on the stack.
So callbacks return nothing: each question has a number, and its answer, number * 4 + sign + 2, goes into a mailbox. An
answer that bears another number is none: the compiled side asks again, and :func:`raise_if_interrupted` reports the
interrupt after the run.
"""

import ctypes
import threading
from collections.abc import Callable
from typing import TypeAlias

import llvmlite.binding
import numpy as np
import numpy.typing as npt
from gmpy2 import mpq, sign
from numba import types as numba_types

from exactkernel.anglebound import corner_sign
from exactkernel.jit import COMPILED, jit

__all__ = [
    "ANGLE",
    "AREA",
    "LENGTH",
    "RationalPoint",
    "diametral_from_doubles",
    "diametral_rational",
    "incircle_from_doubles",
    "incircle_rational",
    "orient2d_from_doubles",
    "orient2d_rational",
    "raise_if_interrupted",
    "shape_from_doubles",
    "shape_rational",
]

RationalPoint: TypeAlias = "tuple[mpq, mpq]"
Mailbox: TypeAlias = "npt.NDArray[np.int64]"


def orient2d_rational(a: RationalPoint, b: RationalPoint, c: RationalPoint) -> int:
    """Return the exact sign of orient2d: +1 if a, b, c turn counterclockwise."""
    return int(sign((a[0] - c[0]) * (b[1] - c[1]) - (a[1] - c[1]) * (b[0] - c[0])))


def incircle_determinant(a: RationalPoint, b: RationalPoint, c: RationalPoint, d: RationalPoint) -> mpq:
    """Return the exact incircle determinant of rational points."""
    adx, ady = a[0] - d[0], a[1] - d[1]
    bdx, bdy = b[0] - d[0], b[1] - d[1]
    cdx, cdy = c[0] - d[0], c[1] - d[1]
    return (
        (adx * adx + ady * ady) * (bdx * cdy - bdy * cdx)
        + (bdx * bdx + bdy * bdy) * (cdx * ady - cdy * adx)
        + (cdx * cdx + cdy * cdy) * (adx * bdy - ady * bdx)
    )


def incircle_rational(a: RationalPoint, b: RationalPoint, c: RationalPoint, d: RationalPoint) -> int:
    """Return the exact sign of incircle: +1 if d lies inside the circle of counterclockwise a, b, c."""
    return int(sign(incircle_determinant(a, b, c, d)))


def diametral_rational(a: RationalPoint, b: RationalPoint, p: RationalPoint) -> int:
    """Return the exact sign of diametral: +1 if p lies inside the circle with diameter ab."""
    return int(sign((p[0] - a[0]) * (b[0] - p[0]) + (p[1] - a[1]) * (b[1] - p[1])))


#: The questions of :func:`shape_rational`.
ANGLE, AREA, LENGTH = 0.0, 1.0, 2.0


def shape_rational(question: float, bound: mpq, a: RationalPoint, b: RationalPoint, c: RationalPoint) -> int:
    """Return the exact sign of a measure of the counterclockwise triangle abc against a bound.

    ``ANGLE``: the bound in degrees minus the angle at a. ``AREA``: the area minus the bound. ``LENGTH``: the length of
    ab minus the bound, which is not negative.
    """
    ux, uy, vx, vy = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]
    if question == LENGTH:
        return int(sign(ux * ux + uy * uy - bound * bound))
    cross = ux * vy - uy * vx
    if question == AREA:
        return int(sign(cross - 2 * bound))
    return corner_sign(cross, ux * vx + uy * vy, bound)


_pending: list[BaseException] = []


def raise_if_interrupted() -> None:
    """Raise what a signal handler raised inside a callback, if one did. Called after every compiled run."""
    if _pending and threading.current_thread() is threading.main_thread():  # where signals are handled
        first = _pending[0]
        _pending.clear()
        raise first


_ATTEMPTS = 16  # only a signal that arrives during a callback makes it fail, and only once
_NEVER = -1  # the answer of a callback that fails for good

_keep_alive: list[object] = []


def _register(name: str, predicate: Callable[..., int], arity: int) -> Callable[..., None]:
    """Make ``predicate`` callable from compiled code; it puts its answer into the mailbox at ``address``."""

    def answer(address: int, number: int, attempt: int, *coordinates: float) -> None:
        mailbox = (ctypes.c_int64 * 2).from_address(address)
        try:
            if COMPILED and attempt > 0 and not _pending:
                # The signal came before the try, and ctypes has swallowed its exception.
                _pending.append(KeyboardInterrupt())
            mailbox[1] = number * 4 + predicate(*coordinates) + 2
        except (RecursionError, MemoryError):
            mailbox[1] = _NEVER
        except BaseException as interrupt:
            _pending.append(interrupt)

    if not COMPILED:
        return answer
    integer, double = ctypes.c_int64, ctypes.c_double
    callback = ctypes.CFUNCTYPE(None, integer, integer, integer, *[double] * arity)(answer)
    _keep_alive.append(callback)
    llvmlite.binding.add_symbol(name, ctypes.cast(callback, ctypes.c_void_p).value)
    arguments = [numba_types.int64] * 3 + [numba_types.float64] * arity
    external: Callable[..., None] = numba_types.ExternalFunction(name, numba_types.void(*arguments))
    return external


def _orient2d(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    return orient2d_rational((mpq(ax), mpq(ay)), (mpq(bx), mpq(by)), (mpq(cx), mpq(cy)))


def _diametral(ax: float, ay: float, bx: float, by: float, px: float, py: float) -> int:
    return diametral_rational((mpq(ax), mpq(ay)), (mpq(bx), mpq(by)), (mpq(px), mpq(py)))


def _incircle(ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float) -> int:
    return incircle_rational((mpq(ax), mpq(ay)), (mpq(bx), mpq(by)), (mpq(cx), mpq(cy)), (mpq(dx), mpq(dy)))


def _shape(question: float, bound: float, ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    return shape_rational(question, mpq(bound), (mpq(ax), mpq(ay)), (mpq(bx), mpq(by)), (mpq(cx), mpq(cy)))


_ask_orient2d = _register("exactmesh_orient2d_rational", _orient2d, 6)
_ask_diametral = _register("exactmesh_diametral_rational", _diametral, 6)
_ask_incircle = _register("exactmesh_incircle_rational", _incircle, 8)
_ask_shape = _register("exactmesh_shape_rational", _shape, 8)


@jit
def _is_answered(mailbox: Mailbox, number: int) -> bool:
    """Tell whether the mailbox holds the answer to this question; another thread may have asked others since."""
    if mailbox[1] == _NEVER:
        raise RuntimeError("the rational stage cannot answer: recursion limit or memory exhausted")
    return bool(mailbox[1] >> 2 == number)


@jit
def _next_number(mailbox: Mailbox, attempt: int) -> int:
    """Number a new question."""
    if attempt == _ATTEMPTS:
        raise RuntimeError("the rational stage was interrupted at every attempt")
    mailbox[0] += 1
    mailbox[1] = 0
    return int(mailbox[0])


@jit
def orient2d_from_doubles(mailbox: Mailbox, ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    """Return the exact sign of orient2d of any finite doubles, from compiled code."""
    attempt = 0
    while True:
        number = _next_number(mailbox, attempt)
        _ask_orient2d(mailbox.ctypes.data, number, attempt, ax, ay, bx, by, cx, cy)
        if _is_answered(mailbox, number):
            return int(mailbox[1] & 3) - 2
        attempt += 1


@jit
def diametral_from_doubles(mailbox: Mailbox, ax: float, ay: float, bx: float, by: float, px: float, py: float) -> int:
    """Return the exact sign of diametral of any finite doubles, from compiled code."""
    attempt = 0
    while True:
        number = _next_number(mailbox, attempt)
        _ask_diametral(mailbox.ctypes.data, number, attempt, ax, ay, bx, by, px, py)
        if _is_answered(mailbox, number):
            return int(mailbox[1] & 3) - 2
        attempt += 1


@jit
def incircle_from_doubles(
    mailbox: Mailbox, ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float
) -> int:
    """Return the exact sign of incircle of any finite doubles, from compiled code."""
    attempt = 0
    while True:
        number = _next_number(mailbox, attempt)
        _ask_incircle(mailbox.ctypes.data, number, attempt, ax, ay, bx, by, cx, cy, dx, dy)
        if _is_answered(mailbox, number):
            return int(mailbox[1] & 3) - 2
        attempt += 1


@jit
def shape_from_doubles(
    mailbox: Mailbox, question: float, bound: float, ax: float, ay: float, bx: float, by: float, cx: float, cy: float
) -> int:
    """Return :func:`shape_rational` of any finite doubles, from compiled code."""
    attempt = 0
    while True:
        number = _next_number(mailbox, attempt)
        _ask_shape(mailbox.ctypes.data, number, attempt, question, bound, ax, ay, bx, by, cx, cy)
        if _is_answered(mailbox, number):
            return int(mailbox[1] & 3) - 2
        attempt += 1
