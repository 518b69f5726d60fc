"""K5: sums and products of pairs, over every pair of pairs of tiny floats: the errors that the bounds count on."""

from collections.abc import Callable

import numba
import numpy as np
import pytest
from proofs_tests.rounding.minifloat import Arithmetic, Backend, Floats, MiniFloat, all_numbers, derive

from exactkernel.doubledouble import dd_add, dd_multiply
from exactkernel.expansions import fast_two_sum, split, two_product, two_sum

pytestmark = pytest.mark.compiled

SOURCE: list[Arithmetic] = [two_sum, fast_two_sum, split, two_product, dd_add, dd_multiply]
LEAST = -6  # tails are multiples of 2^-6 units in the last place of their heads
SPREAD = 6  # the heads of two summands are within so many binades, beyond which one of them is a tail's tail


def pairs(precision: int, exponents: range) -> Floats:
    """Every (head, tail) with a positive head in these binades and a tail of at most half a unit in its last place."""
    heads = np.arange(2.0 ** (precision - 1), 2.0**precision)
    tails = all_numbers(precision, range(LEAST, 0))
    tails = np.unique(tails[(abs(tails) <= 0.5) & (tails % 2.0**LEAST == 0.0)])
    scaled = [(h * 2.0**e, t * 2.0**e) for e in exponents for h in heads for t in tails]
    return np.array(scaled)


def worst(operation: Arithmetic, add: bool) -> Arithmetic:
    @numba.njit
    def run(a: Floats, b: Floats) -> float:
        largest = 0.0
        for i in range(len(a)):
            for j in range(len(b)):
                for sign in (1.0, -1.0):
                    bh, bl = sign * b[j, 0], sign * b[j, 1]
                    high, low = operation(a[i, 0], a[i, 1], bh, bl)
                    exact = (a[i, 0] + a[i, 1]) + (bh + bl) if add else (a[i, 0] + a[i, 1]) * (bh + bl)
                    error = abs((high + low) - exact)
                    if error > 0.0:
                        largest = max(largest, error / abs(exact) if exact != 0.0 else np.inf)
        return largest

    return run


def largest_error(name: str, precision: int, edits: dict[str, tuple[str, str]]) -> tuple[float, int]:
    """The largest relative error, in units of u^2 (and the quotient rounded, in doubles), and of how many pairs."""
    derived = derive(SOURCE, MiniFloat(precision, edits=edits), Backend.LOOPS)[name]
    a = pairs(precision, range(1))
    b = pairs(precision, range(-SPREAD, SPREAD + 1) if name == "dd_add" else range(1))
    return worst(derived, name == "dd_add")(a, b) * 4.0**precision, 2 * len(a) * len(b)


@pytest.mark.obligation(
    "K5", "sums and products of pairs err by less than is counted on (4, 5 bits)", method="exhaustive"
)
class TestPairs:
    """The sum of two pairs errs by at most 3 u^2 + 13 u^3 of itself, cancellation included, and the product by at most
    7 u^2, for every two pairs whose tails are multiples of 2^-6 units in the last place."""

    @pytest.mark.parametrize("precision", [4, 5])
    @pytest.mark.parametrize("name", ["dd_add", "dd_multiply"])
    def test_error(self, name: str, precision: int, record_property: Callable[[str, object], None]) -> None:
        largest, cases = largest_error(name, precision, {})
        record_property("cases", cases)
        assert 0.0 < largest < (3.0 + 13.0 * 2.0**-precision if name == "dd_add" else 7.0)

    @pytest.mark.parametrize(
        ("name", "edit"),
        [
            ("dd_add", ("sl + th", "sl")),
            ("dd_add", ("tl + vl", "vl")),
            ("dd_multiply", ("ah * bl + al * bh", "ah * bl")),
            ("dd_multiply", ("pl + (ah * bl + al * bh)", "pl - (ah * bl + al * bh)")),
        ],
    )
    def test_control_a_dropped_term(self, name: str, edit: tuple[str, str]) -> None:
        """A partial sum or product left out: the error is larger."""
        largest, _ = largest_error(name, 4, {name: edit})
        assert largest > 7
