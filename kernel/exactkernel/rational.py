"""The predicates in gmpy2 rationals: the last stage, the oracle, and the path of coordinates that are no doubles.

Compiled loops reach them through C callbacks, registered by name with LLVM so that cached machine code finds them in a
later process. A callback answers ``sign + 2``: ctypes turns a failing callback (Ctrl-C inside of it) into 0, which is no
answer, so the compiled side asks again and :func:`raise_if_interrupted` reports the interrupt afterwards.
"""

import ctypes
from collections.abc import Callable
from typing import TypeAlias

import llvmlite.binding
from gmpy2 import mpq, sign
from numba import types as numba_types

from exactkernel.jit import COMPILED

__all__ = [
    "RationalPoint",
    "diametral_from_doubles",
    "diametral_rational",
    "incircle_from_doubles",
    "incircle_rational",
    "orient2d_from_doubles",
    "orient2d_rational",
    "raise_if_interrupted",
]

RationalPoint: TypeAlias = "tuple[mpq, mpq]"


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


_interrupts: list[KeyboardInterrupt] = []


def raise_if_interrupted() -> None:
    """Raise the KeyboardInterrupt that arrived inside a callback, if one did. Called after every compiled run."""
    if _interrupts:
        raise _interrupts.pop()


def _orient2d(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    return orient2d_rational((mpq(ax), mpq(ay)), (mpq(bx), mpq(by)), (mpq(cx), mpq(cy)))


def _incircle(ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float) -> int:
    return incircle_rational((mpq(ax), mpq(ay)), (mpq(bx), mpq(by)), (mpq(cx), mpq(cy)), (mpq(dx), mpq(dy)))


def _diametral(ax: float, ay: float, bx: float, by: float, px: float, py: float) -> int:
    return diametral_rational((mpq(ax), mpq(ay)), (mpq(bx), mpq(by)), (mpq(px), mpq(py)))


_keep_alive: list[object] = []


def _register(name: str, predicate: Callable[..., int], arity: int) -> Callable[..., int]:
    """Make ``predicate`` callable from compiled code under ``name``; it answers sign + 2, or 0 for 'ask again'."""

    def answer(*coordinates: float) -> int:
        try:
            return predicate(*coordinates) + 2
        except KeyboardInterrupt as interrupt:
            _interrupts.append(interrupt)
            return 0

    if not COMPILED:
        return answer
    callback = ctypes.CFUNCTYPE(ctypes.c_int64, *[ctypes.c_double] * arity)(answer)
    _keep_alive.append(callback)
    address = ctypes.cast(callback, ctypes.c_void_p).value
    llvmlite.binding.add_symbol(name, address)
    signature = numba_types.int64(*[numba_types.float64] * arity)
    external: Callable[..., int] = numba_types.ExternalFunction(name, signature)
    return external


orient2d_from_doubles = _register("exactmesh_orient2d_rational", _orient2d, 6)
incircle_from_doubles = _register("exactmesh_incircle_rational", _incircle, 8)
diametral_from_doubles = _register("exactmesh_diametral_rational", _diametral, 6)
