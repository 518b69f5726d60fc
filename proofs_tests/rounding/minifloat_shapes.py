"""The shipped filters of angles, areas and lengths in tiny formats: see minifloat_filters.py.

The sides are integers of few bits, so their differences are exact: what is tried is all that rounds after them. Sine
and cosine are numbers of the format; the true ones are any within u of them, relatively.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numba
import numpy as np
from proofs_tests.rounding.minifloat import Arithmetic, Backend, Floats, MiniFloat, derive
from proofs_tests.rounding.minifloat_filters import Tally, _no_pair, _no_sign
from proofs_tests.rounding.minifloat_inputs import offsets

from exactkernel import codes
from exactkernel.angle import AngleBound, angle_filter, beyond, corner_code
from exactkernel.context import Context, guarded_context
from exactkernel.measure import area_filter, length_filter

__all__ = ["SHAPES", "Shape", "shape_tally"]


@numba.njit
def _yes(*_: object) -> bool:
    return True


@numba.njit
def _nothing(*_: object) -> float:
    return 0.0


#: What comes after the filter of angles; the guards do not matter where nothing underflows.
LATER: dict[str, object] = {
    **{name: getattr(codes, name) for name in ("FILTER", "GRID", "DOUBLE_DOUBLE", "EXPANSION", "RATIONAL")},
    "ANGLE": 0,
    "DD_BOUND": 1.0,
    "SMALLEST_WEIGHT": 2.0**-60,
    "LARGEST_WEIGHT": 2.0**60,
    "SHAPE_FACTOR": 1.0,
    "corner_double_double": _nothing,
    "corner_expansion": _no_sign,
    "safe_degree_2": _yes,
    "shape_from_doubles": _no_sign,
    "sign_of": _no_sign,
    "two_diff": _no_pair,
}


def _angles(decide: Arithmetic, u: float) -> Arithmetic:
    k = guarded_context()
    scratch, counts, mailbox = k.scratch, k.counts, k.mailbox

    @numba.njit
    def run(bound: float, x: Floats, sines: Floats, cosines: Floats) -> Tally:  # in the source
        tried = certified = lies = 0
        context = Context(1.0, 1.0, 0.0, scratch, counts, mailbox)
        for sine in sines:
            for cosine in cosines:
                angle = AngleBound(30.0, cosine, 0.0, sine, 0.0, False)
                for i in range(x.shape[1]):
                    for j in range(x.shape[1]):
                        ux, vx, uy, vy = x[0, i], x[1, i], x[0, j], x[1, j]
                        code = decide(context, angle, 0.0, 0.0, ux, uy, vx, vy)
                        tried += 1
                        if code >> 2 == 0 and code != 1:
                            left, right = sine * (ux * vx + uy * vy), cosine * (ux * vy - uy * vx)
                            certified += 1
                            lies += ((code & 3) - 1) * (left - right) <= u * (abs(left) + abs(right))
        return tried, certified, lies

    return run


def _areas(decide: Arithmetic, u: float) -> Arithmetic:  # as _angles
    @numba.njit
    def run(bound: float, x: Floats, limits: Floats, _: Floats) -> Tally:
        tried = certified = lies = 0
        for limit in limits:
            for i in range(x.shape[1]):
                for j in range(x.shape[1]):
                    ux, vx, uy, vy = x[0, i], x[1, i], x[0, j], x[1, j]
                    sign = decide(bound, limit, ux, uy, vx, vy)
                    tried += 1
                    certified += sign != 0
                    lies += sign != 0 and sign * ((ux * vy - uy * vx) - 2.0 * limit) <= 0.0
        return tried, certified, lies

    return run


def _lengths(decide: Arithmetic, u: float) -> Arithmetic:
    @numba.njit
    def run(bound: float, x: Floats, limits: Floats, _: Floats) -> Tally:
        tried = certified = lies = 0
        for limit in limits:
            for i in range(x.shape[1]):
                ux, uy = x[0, i], x[1, i]
                sign = decide(bound, limit, ux, uy)
                tried += 1
                certified += sign != 0
                lies += sign != 0 and sign * ((ux * ux + uy * uy) - limit * limit) <= 0.0
        return tried, certified, lies

    return run


@dataclass(frozen=True)
class Shape:
    """A filter, what it is compared with, and how large the sides are.

    Attributes:
        source: the shipped functions.
        run: makes the loop of the derived function and the unit roundoff.
        size: sides are pairs of integers up to this.
        first, second: what the loop takes besides sides, for a precision: sines and cosines, or bounds.
    """

    source: tuple[Arithmetic, ...]
    run: Callable[[Arithmetic, float], Arithmetic]
    size: int
    first: Callable[[int], Floats]
    second: Callable[[int], Floats]


def _binade(precision: int) -> Floats:
    """The numbers from 1 to 2."""
    u = 2.0**-precision
    return np.arange(0.5 / u, 1.0 / u) * 2.0 * u


def _cosines(precision: int) -> Floats:
    binade = _binade(precision)
    return np.concatenate([-binade, -0.25 * binade, [0.0], 0.25 * binade, binade])


def _bounds(precision: int) -> Floats:
    return np.concatenate([[0.0], *(_binade(precision) * 2.0**e for e in range(-2, 8))])


def _none(_: int) -> Floats:
    return np.zeros(1)


SHAPES: dict[str, Shape] = {
    "angle": Shape((beyond, angle_filter, corner_code), _angles, 6, _binade, _cosines),
    "area": Shape((beyond, area_filter), _areas, 8, _bounds, _none),
    "length": Shape((beyond, length_filter), _lengths, 31, _bounds, _none),
}


def shape_tally(name: str, mini: MiniFloat, bound: float) -> Tally:
    """Return how many cases there are, on how many the filter certifies a sign, and how many are wrong."""
    shape, u = SHAPES[name], 2.0**-mini.precision
    constants = {**LATER, "ORIENT2D_BOUND": bound, **mini.constants}
    mini = MiniFloat(mini.precision, mini.quantum, constants, mini.edits)
    derived = derive(shape.source, mini, Backend.LOOPS)[shape.source[-1].__name__]
    sides = offsets(shape.size, 2)[0][:2]
    run = shape.run(derived, u)
    found: Tally = run(bound, sides, shape.first(mini.precision), shape.second(mini.precision))
    return found
