"""The vocabulary of the kernel: signs, stages, and what counts as a coordinate."""

from collections.abc import Sequence
from enum import IntEnum
from fractions import Fraction
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from gmpy2 import mpq, mpz

__all__ = ["Coordinate", "FloatArray", "IntArray", "PointLike", "Sign", "SignArray", "Stage"]


class Sign(IntEnum):
    """The sign of a determinant: the only thing that a predicate ever says."""

    NEGATIVE = -1
    ZERO = 0
    POSITIVE = 1


class Stage(IntEnum):
    """The stage that decided a predicate, cheapest first.

    ======================  ==================================================================
    ``FILTER``              double arithmetic with a certified error bound
    ``GRID``                double arithmetic that is exact: small differences on a common grid
    ``DOUBLE_DOUBLE``       twice the precision, with a certified error bound
    ``EXPANSION``           Shewchuk's exact floating-point expansions
    ``RATIONAL``            gmpy2 rationals: outside the window, or coordinates that are no doubles
    ======================  ==================================================================
    """

    FILTER = 0
    GRID = 1
    DOUBLE_DOUBLE = 2
    EXPANSION = 3
    RATIONAL = 4


#: One coordinate: any exact number, or a finite double.
Coordinate: TypeAlias = "int | float | np.integer[npt.NBitBase] | np.floating[npt.NBitBase] | Fraction | mpz | mpq"
FloatArray: TypeAlias = npt.NDArray[np.float64]
SignArray: TypeAlias = npt.NDArray[np.int8]
IntArray: TypeAlias = npt.NDArray[np.int32]
#: A point: a pair ``(x, y)``, y up.
PointLike: TypeAlias = "Sequence[Coordinate] | FloatArray"
