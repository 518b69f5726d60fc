"""K5, second half: expansion arithmetic, over every small expansion of tiny floats."""

from collections.abc import Callable
from fractions import Fraction
from itertools import product

import numba
import numpy as np
import numpy.typing as npt
import pytest
from proofs_tests.recording import Record
from proofs_tests.rounding.minifloat import Arithmetic, Backend, Floats, MiniFloat, all_numbers, derive

from exactkernel.expansions import (
    determinant_2x2,
    expansion_product,
    expansion_sign,
    expansion_sum,
    fast_two_sum,
    negate,
    pair,
    scale_expansion,
    split,
    two_product,
    two_sum,
)
from exactkernel.jit import COMPILED

FUNCTIONS: list[Arithmetic] = [
    two_sum,
    fast_two_sum,
    split,
    two_product,
    pair,
    expansion_sum,
    scale_expansion,
    expansion_product,
    negate,
    expansion_sign,
    determinant_2x2,
]
SHEWCHUKS_FAST_SUM = (
    """fast_two_sum(component, small)
        if tail != 0.0:
            h[n] = tail
            n += 1
        carry, small = two_sum(carry, total)""",
    """two_sum(carry, component)
        if tail != 0.0:
            h[n] = tail
            n += 1
        carry = total""",
)
PRECISION = 4  # Shewchuk's theorems ask for at least four bits
BINADES = 7 if COMPILED else 4
Lengths = npt.NDArray[np.int64]


def in_this_lane(function: Callable[..., int]) -> Arithmetic:
    compiled: Arithmetic = numba.njit(function) if COMPILED else function
    return compiled


def lowest_bit_of(x: float) -> int:
    v = int(abs(x))
    return v & -v


lowest_bit = in_this_lane(lowest_bit_of)


def is_nonadjacent(h: Floats, n: int) -> bool:
    """Shewchuk's definition, on integers: no zeros, and between the bits of two neighbours a zero bit at least."""
    for i in range(n):  # noqa: SIM110  # numba compiles this, and no generator
        if h[i] == 0.0 or (i > 0 and 2 * int(abs(h[i - 1])) >= lowest_bit(h[i])):
            return False
    return True


well_formed = in_this_lane(is_nonadjacent)


def is_exact_expansion(h: Floats, n: int, exact: float) -> bool:
    total = 0.0  # exact: everything is an integer far below 2^53
    for i in range(n):
        total += h[i]
    return bool(total == exact and well_formed(h, n))


correct = in_this_lane(is_exact_expansion)


def expansions(precision: int, binades: int, components: int) -> tuple[Floats, Lengths]:
    """Every nonadjacent expansion of at most so many components with integer values, zero included."""
    numbers = [x for x in all_numbers(precision, range(binades)).tolist() if x != 0.0]
    found: list[list[float]] = [[]]
    longest: list[list[float]] = [[]]
    for _ in range(components):
        longest = [[*e, x] for e, x in product(longest, numbers) if _extends(e, x)]
        found += longest
    array = np.zeros((len(found), components))
    for i, e in enumerate(found):
        array[i, : len(e)] = e
    return array, np.array([len(e) for e in found])


def _extends(e: list[float], x: float) -> bool:
    return not e or 2 * abs(e[-1]) < lowest_bit_of(x)


def checkers(mini: MiniFloat, backend: Backend) -> dict[str, Arithmetic]:
    """For each routine, a loop over all inputs that counts the wrong results."""
    kernel = derive(FUNCTIONS, mini, backend)
    lane = in_this_lane if backend is Backend.LOOPS else lambda function: function
    the_sum, scale, multiply = (kernel[f] for f in ("expansion_sum", "scale_expansion", "expansion_product"))
    the_sign = kernel["expansion_sign"]

    def sums(e: Floats, ne: Lengths, f: Floats, nf: Lengths, h: Floats) -> int:
        wrong = 0
        for i in range(len(e)):
            for j in range(len(f)):
                n = the_sum(e[i], ne[i], f[j], nf[j], h)
                exact = e[i].sum() + f[j].sum()
                if not correct(h, n, exact) or the_sign(h, n) != np.sign(exact):
                    wrong += 1
        return wrong

    def scalings(e: Floats, ne: Lengths, b: Floats, h: Floats) -> int:
        wrong = 0
        for i in range(len(e)):
            for x in b:
                if not correct(h, scale(e[i], ne[i], x, h), e[i].sum() * x):
                    wrong += 1
        return wrong

    def products(e: Floats, ne: Lengths, f: Floats, nf: Lengths, h: Floats) -> int:
        scaled, total = np.zeros(64), np.zeros(64)
        wrong = 0
        for i in range(len(e)):
            for j in range(len(f)):
                n = multiply(e[i], ne[i], f[j], nf[j], h, scaled, total)
                if not correct(h, n, e[i].sum() * f[j].sum()):
                    wrong += 1
        return wrong

    return {"sum": lane(sums), "scale": lane(scalings), "product": lane(products)}


SOUND = checkers(MiniFloat(PRECISION), Backend.LOOPS)


@pytest.mark.obligation("K5", "expansion sum, scaling and product are exact and nonadjacent", method="exhaustive")
class TestExpansions:
    """The components of a result sum to the exact value and are nonadjacent, hence bit-disjoint.

    Exhaustive: every nonadjacent expansion of up to two (sum, product) or three components of four bits. What is asked
    of the operands is what holds for the result, so the statement carries over to any sequence of operations.
    """

    def test_sum(self, record_property: Record) -> None:
        e, ne = expansions(PRECISION, BINADES, 2)
        assert SOUND["sum"](e, ne, e, ne, np.zeros(8)) == 0
        record_property("cases", len(e) ** 2)

    def test_scaling(self, record_property: Record) -> None:
        e, ne = expansions(PRECISION, BINADES if COMPILED else 3, 3 if COMPILED else 2)
        assert SOUND["scale"](e, ne, all_numbers(PRECISION, range(1)), np.zeros(16)) == 0
        record_property("cases", len(e) * len(all_numbers(PRECISION, range(1))))

    def test_product(self, record_property: Record) -> None:
        e, ne = expansions(PRECISION, 6 if COMPILED else 2, 2)
        assert SOUND["product"](e, ne, e, ne, np.zeros(64)) == 0
        record_property("cases", len(e) ** 2)

    def test_nothing_added_changes_nothing(self) -> None:
        e, ne = expansions(PRECISION, 3, 2)
        for components, n in zip(e, ne.tolist(), strict=True):
            h = np.zeros(4)
            assert expansion_sum(components, n, np.zeros(2), 0, h) == n
            assert h[:n].tolist() == components[:n].tolist()
            h = np.zeros(4)
            assert expansion_sum(np.zeros(2), 0, components, n, h) == n
            assert h[:n].tolist() == components[:n].tolist()

    def test_longer_operands(self, record_property: Record) -> None:
        e, ne = expansions(PRECISION, 8 if COMPILED else 5, 3)
        long = ne == 3
        f, nf = expansions(PRECISION, BINADES, 1)
        assert SOUND["sum"](e[long], ne[long], f, nf, np.zeros(8)) == 0
        record_property("cases", int(long.sum()) * len(f))

    @pytest.mark.parametrize(
        ("routine", "function", "edit"),
        [
            ("sum", "expansion_sum", ("abs(e[i]) < abs(f[j])", "abs(e[i]) > abs(f[j])")),
            ("sum", "expansion_sum", ("fast_two_sum(component, small)", "fast_two_sum(small, component)")),
            ("sum", "expansion_sum", ("two_sum(carry, total)", "fast_two_sum(carry, total)")),
            ("sum", "expansion_sum", ("return n + pair(carry, small, h[n:])", "return n + pair(carry, 0.0, h[n:])")),
            ("sum", "expansion_sum", SHEWCHUKS_FAST_SUM),
            ("sum", "two_sum", ("(b - b_virtual)", "0.0")),
            ("scale", "scale_expansion", ("two_sum(carry, product_low)", "(carry + product_low, 0.0)")),
            ("scale", "scale_expansion", ("fast_two_sum(product_high, total)", "fast_two_sum(total, product_high)")),
            ("product", "expansion_product", ("range(nf)", "range(min(nf, 1))")),
        ],
    )
    def test_control_seeded_faults_are_found(self, routine: str, function: str, edit: tuple[str, str]) -> None:
        """Orders, conditions and components of the source changed, one by one."""
        faulty = checkers(MiniFloat(PRECISION, edits={function: edit}), Backend.PYTHON)[routine]
        e, ne = expansions(PRECISION, 6, 2)
        if routine == "scale":
            assert faulty(e, ne, all_numbers(PRECISION, range(1)), np.zeros(16)) > 0
        else:
            few, some = slice(0, len(e), 40), slice(0, len(e), 7)
            assert faulty(e[few], ne[few], e[some], ne[some], np.zeros(64)) > 0

    def test_control_a_result_that_overlaps_is_refused(self) -> None:
        """Components that overlap, are zero, or do not add up."""
        assert is_exact_expansion(np.array([1.0, 12.0]), 2, 13.0)
        assert not is_exact_expansion(np.array([1.0, 12.0]), 1, 13.0)
        assert not is_exact_expansion(np.array([3.0, 6.0]), 2, 9.0)
        assert not is_exact_expansion(np.array([1.0, 6.0]), 2, 7.0)
        assert not is_exact_expansion(np.array([0.0, 6.0]), 2, 6.0)


@pytest.mark.obligation("K5", "the determinant of exact pairs is exact, in doubles", method="named cases")
class TestDeterminant:
    """determinant_2x2 of nonoverlapping pairs of doubles has the exact value, in sixteen components or fewer."""

    def test_scaling_without_rounding_leaves_no_zeros(self) -> None:
        h = np.zeros(4)
        assert scale_expansion(np.array([1.0, 4.0]), 2, 2.0, h) == 1
        assert h[0] == 10.0
        assert scale_expansion(np.array([1.0, 4.0]), 2, 0.0, h) == 0

    PAIRS = ((1.0, 2.0**-53), (-3.0, 2.0**-60), (2.0**200 + 2.0**150, -(2.0**100)), (0.0, 0.0), (2.0**-200, 0.0))

    @classmethod
    def wrong(cls, first: int) -> int:
        """Count the determinants that are not the sum of their components, from the first one given on."""
        h, scratch = np.zeros(16), np.zeros(32)
        count = 0
        for p, q, r, s in product(cls.PAIRS, repeat=4):
            n = determinant_2x2(*p, *q, *r, *s, h, scratch)
            value = [Fraction(a) + Fraction(b) for a, b in (p, q, r, s)]
            exact = value[0] * value[1] - value[2] * value[3]
            count += sum((Fraction(x) for x in h[first:n].tolist()), Fraction(0)) != exact
            count += expansion_sign(h, n) != (exact > 0) - (exact < 0)
        return count

    def test_all_quadruples(self, record_property: Record) -> None:
        assert self.wrong(0) == 0
        record_property("cases", len(self.PAIRS) ** 4)

    def test_control_a_lost_component(self) -> None:
        """The smallest component of each determinant left out."""
        assert self.wrong(1) > 100
