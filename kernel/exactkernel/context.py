"""What a compiled loop carries along: the bounds that its input allows, scratch space, and a tally of the stages.

The safe window is checked once per input, not once per call. Inside it the bounds are the published constants. Outside
they are infinite, so that no comparison with them ever succeeds, every call falls through to the slow path, and that
looks at its own few coordinates before it chooses between expansions and rationals.
"""

import math
import threading
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exactkernel import constants
from exactkernel.jit import jit
from exactkernel.types import FloatArray

__all__ = [
    "INCIRCLE_ROW",
    "ORIENT2D_ROW",
    "SCRATCH_SIZE",
    "Context",
    "bits_of",
    "chunk_size",
    "exponent_into_window",
    "guarded_context",
    "make_context",
    "rebounded",
    "scaled_into_window",
    "thread_context",
]

#: Rows of ``Context.counts``; diametral counts with orient2d, whose stages it shares.
ORIENT2D_ROW = 0
INCIRCLE_ROW = 1

SCRATCH_SIZE = 4192  # what incircle_expansion uses


class Context(NamedTuple):
    """Everything besides coordinates that a compiled predicate needs.

    Attributes:
        orient2d_bound: ``ORIENT2D_BOUND``, or infinity where the coordinates leave the window of degree 2.
        incircle_bound: ``INCIRCLE_BOUND``, or infinity where they leave the window of degree 4.
        grid_limit: differences up to this make double determinants exact; 0 where no common grid is known.
        scratch: workspace of the expansions.
        mailbox: int64 (2,): the number of the last question to the rational stage, and its answer.
        counts: int64 (2, 5): how often each :class:`Stage` decided orient2d and incircle.
    """

    orient2d_bound: float
    incircle_bound: float
    grid_limit: float
    scratch: FloatArray
    counts: npt.NDArray[np.int64]
    mailbox: npt.NDArray[np.int64]


@jit
def lowest_bit(x: float) -> float:
    """Return the largest power of two that divides the nonzero double x."""
    mantissa, exponent = math.frexp(abs(x))
    digits = int(mantissa * 9007199254740992.0)  # 2^53: the mantissa as an integer
    while digits % 2 == 0:
        digits //= 2
        exponent += 1
    return math.ldexp(1.0, exponent - 53)


@jit
def scan(coordinates: FloatArray) -> tuple[float, float]:
    """Return the largest magnitude and the largest power of two that divides all coordinates (inf if all are 0)."""
    maximum = 0.0
    unit = math.inf
    for x in coordinates:
        magnitude = abs(float(x))
        if magnitude == 0.0:
            continue
        maximum = max(maximum, magnitude)
        steps = magnitude / unit
        if magnitude < unit or steps != np.floor(steps):  # a quotient that overflows is a multiple all the same
            unit = lowest_bit(magnitude)
    return maximum, unit


def bits_of(coordinates: FloatArray) -> tuple[float, float]:
    """Return (largest magnitude, common unit) of an array of any shape. O(n)."""
    maximum, unit = scan(np.ascontiguousarray(coordinates).reshape(-1))
    return float(maximum), float(unit)


def _context(maximum: float, unit: float) -> Context:
    degree_2 = maximum <= constants.MAX_COORDINATE_DEGREE_2 and unit >= constants.MIN_UNIT_DEGREE_2
    degree_4 = maximum <= constants.MAX_COORDINATE_DEGREE_4 and unit >= constants.MIN_UNIT_DEGREE_4
    return Context(
        orient2d_bound=constants.ORIENT2D_BOUND if degree_2 else math.inf,
        incircle_bound=constants.INCIRCLE_BOUND if degree_4 else math.inf,
        grid_limit=min(unit, constants.MAX_COORDINATE_DEGREE_4) * constants.GRID_STEPS if degree_4 else 0.0,
        scratch=np.empty(SCRATCH_SIZE, dtype=np.float64),
        counts=np.zeros((2, 5), dtype=np.int64),
        mailbox=np.zeros(2, dtype=np.int64),
    )


_SLOWDOWN_BITS = 7  # a rational predicate takes about as long as a hundred others


def chunk_size(k: Context, usual: int) -> int:
    """Return how many items to take between two looks at Ctrl-C: fewer where every predicate may be rational."""
    return usual if k.incircle_bound < math.inf else usual >> _SLOWDOWN_BITS


def make_context(coordinates: FloatArray) -> Context:
    """Return the context for predicates on these (finite) coordinates. O(n)."""
    return _context(*bits_of(coordinates))


def rebounded(k: Context, maximum: float, unit: float) -> Context:
    """Return a context for coordinates of these bits that shares the scratch space and the tally of another."""
    return _context(maximum, unit)._replace(scratch=k.scratch, counts=k.counts, mailbox=k.mailbox)


def guarded_context() -> Context:
    """Return a context that assumes nothing: every call looks at its own coordinates."""
    return _context(math.inf, 0.0)


class _PerThread(threading.local):
    def __init__(self) -> None:
        self.guarded = guarded_context()


_PER_THREAD = _PerThread()


def thread_context() -> Context:
    """Return this thread's own guarded context, for single calls: scratch and mailbox must not be shared."""
    return _PER_THREAD.guarded


def _highest_exponent(maximum: float) -> int:
    """Return the largest exponent whose power of two does not lead coordinates up to maximum beyond the window."""
    mantissa, exponent = math.frexp(maximum)
    return 254 - exponent if mantissa == 0.5 else 253 - exponent


def scaled_into_window(coordinates: FloatArray) -> tuple[FloatArray, Context]:
    """Return the coordinates times a power of two that brings them into the window, and their context.

    Coordinates that are in the window already are returned as they are, and so are those that no power of two brings
    there. The scaling is exact, and no sign, perturbed or not, depends on it.
    """
    maximum, unit = bits_of(coordinates)
    context = _context(maximum, unit)
    if context.incircle_bound < math.inf:
        return coordinates, context
    exponent = _highest_exponent(maximum)
    largest, smallest = math.ldexp(maximum, exponent), math.ldexp(unit, exponent)
    if smallest < constants.MIN_UNIT_DEGREE_4:
        return coordinates, context
    return np.ldexp(coordinates, exponent), _context(largest, smallest)


def exponent_into_window(maximum: float, unit: float) -> int:
    """Return an exponent whose power of two brings coordinates of these bits into the window, 0 if there is none.

    They come into the middle of the window, so that there is room for larger and for finer ones to come.
    """
    if _context(maximum, unit).incircle_bound < math.inf:
        return 0
    highest = _highest_exponent(maximum)
    lowest = math.frexp(constants.MIN_UNIT_DEGREE_4)[1] - math.frexp(unit)[1]
    return (lowest + highest) // 2 if lowest <= highest else 0
