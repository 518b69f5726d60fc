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

from exactkernel.jit import COMPILED, jit

__all__ = [
    "RationalPoint",
    "along_from_doubles",
    "along_rational",
    "crossing_order_from_doubles",
    "crossing_order_rational",
    "diametral_from_doubles",
    "diametral_rational",
    "incircle_from_doubles",
    "incircle_rational",
    "nearer_from_doubles",
    "nearer_rational",
    "orient2d_from_doubles",
    "orient2d_rational",
    "raise_if_interrupted",
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


def nearer_rational(p: RationalPoint, q: RationalPoint, x: RationalPoint) -> int:
    """Return the exact sign of |x - p|^2 - |x - q|^2: +1 if x is nearer to q than to p."""
    px, py, qx, qy = x[0] - p[0], x[1] - p[1], x[0] - q[0], x[1] - q[1]
    return int(sign(px * px + py * py - qx * qx - qy * qy))


def along_rational(p: RationalPoint, q: RationalPoint, a: RationalPoint, b: RationalPoint) -> int:
    """Return the exact sign of the inner product (q - p) (b - a)."""
    return int(sign((q[0] - p[0]) * (b[0] - a[0]) + (q[1] - p[1]) * (b[1] - a[1])))


def crossing_order_rational(
    s: RationalPoint, p: RationalPoint, q: RationalPoint, a: RationalPoint, b: RationalPoint
) -> int:
    """Return the exact sign of N(p) D(q) - N(q) D(p), where a + (b - a) N(p) / (2 D(p)) is as near to s as to p."""
    dx, dy, cx, cy = b[0] - a[0], b[1] - a[1], s[0] - a[0], s[1] - a[1]
    px, py, qx, qy = p[0] - s[0], p[1] - s[1], q[0] - s[0], q[1] - s[1]
    n_p, n_q = 2 * (px * cx + py * cy) + px * px + py * py, 2 * (qx * cx + qy * cy) + qx * qx + qy * qy
    return int(sign(n_p * (qx * dx + qy * dy) - n_q * (px * dx + py * dy)))


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


def _nearer(px: float, py: float, qx: float, qy: float, x: float, y: float) -> int:
    return nearer_rational((mpq(px), mpq(py)), (mpq(qx), mpq(qy)), (mpq(x), mpq(y)))


def _along(px: float, py: float, qx: float, qy: float, ax: float, ay: float, bx: float, by: float) -> int:
    return along_rational((mpq(px), mpq(py)), (mpq(qx), mpq(qy)), (mpq(ax), mpq(ay)), (mpq(bx), mpq(by)))


def _crossing_order(
    sx: float, sy: float, px: float, py: float, qx: float, qy: float, ax: float, ay: float, bx: float, by: float
) -> int:
    s, p, q = (mpq(sx), mpq(sy)), (mpq(px), mpq(py)), (mpq(qx), mpq(qy))
    return crossing_order_rational(s, p, q, (mpq(ax), mpq(ay)), (mpq(bx), mpq(by)))


_ask_orient2d = _register("exactmesh_orient2d_rational", _orient2d, 6)
_ask_diametral = _register("exactmesh_diametral_rational", _diametral, 6)
_ask_incircle = _register("exactmesh_incircle_rational", _incircle, 8)
_ask_nearer = _register("exactmesh_nearer_rational", _nearer, 6)
_ask_along = _register("exactmesh_along_rational", _along, 8)
_ask_crossing_order = _register("exactmesh_crossing_order_rational", _crossing_order, 10)


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
def nearer_from_doubles(mailbox: Mailbox, px: float, py: float, qx: float, qy: float, x: float, y: float) -> int:
    """Return the exact sign of nearer of any finite doubles, from compiled code."""
    attempt = 0
    while True:
        number = _next_number(mailbox, attempt)
        _ask_nearer(mailbox.ctypes.data, number, attempt, px, py, qx, qy, x, y)
        if _is_answered(mailbox, number):
            return int(mailbox[1] & 3) - 2
        attempt += 1


@jit
def along_from_doubles(
    mailbox: Mailbox, px: float, py: float, qx: float, qy: float, ax: float, ay: float, bx: float, by: float
) -> int:
    """Return the exact sign of along of any finite doubles, from compiled code."""
    attempt = 0
    while True:
        number = _next_number(mailbox, attempt)
        _ask_along(mailbox.ctypes.data, number, attempt, px, py, qx, qy, ax, ay, bx, by)
        if _is_answered(mailbox, number):
            return int(mailbox[1] & 3) - 2
        attempt += 1


@jit
def crossing_order_from_doubles(
    mailbox: Mailbox, sx: float, sy: float, px: float, py: float, qx: float, qy: float,
    ax: float, ay: float, bx: float, by: float,
) -> int:  # fmt: skip
    """Return the exact sign of crossing_order of any finite doubles, from compiled code."""
    attempt = 0
    while True:
        number = _next_number(mailbox, attempt)
        _ask_crossing_order(mailbox.ctypes.data, number, attempt, sx, sy, px, py, qx, qy, ax, ay, bx, by)
        if _is_answered(mailbox, number):
            return int(mailbox[1] & 3) - 2
        attempt += 1
