"""K1, K6: the constants, from what they are for: no smaller than sound, no larger than needed."""

import math
from collections.abc import Sequence
from fractions import Fraction

import numpy as np
import pytest
from proofs_tests.rounding.calculus import Bounded, U, largest_needed

import exactkernel as ek
from exactkernel import codes, constants
from exactkernel.context import chunk_size, guarded_context, make_context
from exactkernel.expansions import split, two_product
from exactkernel.measure import area_code
from exactkernel.orient2d import products_difference

#: What the calculus says of a product of two differences of inputs, and of a term of incircle, lift times minor.
PRODUCT = Bounded(U) * Bounded(U)
TERM = (PRODUCT + PRODUCT) * (PRODUCT + PRODUCT)

SMALLEST = Fraction(1, 2**1074)
LARGEST = Fraction(2) ** 1023
DEGREES = ["degree 2", "degree 4"]  # names that do not depend on the constants


def is_sharp(bound: Fraction, last: Bounded) -> bool:
    """Whether a bound is as large as the calculus asks for, and hardly larger."""
    needed = largest_needed(last.e)
    return needed <= bound < needed * (1 + Fraction(1, 10**12))


@pytest.mark.obligation(
    "K1",
    "the constants of the filters exceed what the calculus asks for by less than 10^-12 of it",
    method="calculus",
)
class TestSharpness:
    """The unit roundoff is half the distance of 1 from the next double. A bound is at least what the calculus of
    rounding errors asks for, and exceeds it by less than a millionth of a millionth."""

    def test_unit_roundoff(self) -> None:
        assert math.nextafter(1.0, 2.0) - 1.0 == 2.0 * constants.UNIT_ROUNDOFF

    @pytest.mark.parametrize(
        ("bound", "last"),
        [(constants.ORIENT2D_BOUND, PRODUCT), (constants.INCIRCLE_BOUND, TERM + TERM)],
        ids=["orient2d", "incircle"],
    )
    def test_filters(self, bound: float, last: Bounded) -> None:
        assert is_sharp(Fraction(bound), last)

    @pytest.mark.parametrize(("first", "last"), [(3, PRODUCT), (10, TERM + TERM)], ids=["orient2d", "incircle"])
    def test_control_other_constants(self, first: int, last: Bounded) -> None:
        """Constants without their second order, or with a first order that is a thousandth larger."""
        assert not is_sharp(first * U, last)
        assert not is_sharp((first + Fraction(1, 1000)) * U, last)


@pytest.mark.obligation(
    "K6", "the windows are as wide as under- and overflow let them be", method="calculus", control_in="mutants"
)
class TestWindows:
    """Each end is the last power of two for which the determinant of its degree neither under- nor overflows."""

    @pytest.mark.parametrize(
        ("unit", "degree"), [(constants.MIN_UNIT_DEGREE_2, 2), (constants.MIN_UNIT_DEGREE_4, 4)], ids=DEGREES
    )
    def test_smallest_units(self, unit: float, degree: int) -> None:
        """A determinant consists of multiples of the unit to the degree, and the smallest double is 2^-1074."""
        assert Fraction(unit) ** degree >= SMALLEST > Fraction(unit / 2) ** degree

    @pytest.mark.parametrize(
        ("coordinate", "unit"),
        [
            (constants.MIN_COORDINATE_DEGREE_2, constants.MIN_UNIT_DEGREE_2),
            (constants.MIN_COORDINATE_DEGREE_4, constants.MIN_UNIT_DEGREE_4),
        ],
        ids=DEGREES,
    )
    def test_smallest_coordinates(self, coordinate: float, unit: float) -> None:
        """Every double from there on is a multiple of the unit; not every smaller one is."""
        assert math.ulp(coordinate) == unit
        assert math.ulp(math.nextafter(coordinate, 0.0)) == unit / 2

    @pytest.mark.parametrize(
        ("coordinate", "degree", "terms"),
        [(constants.MAX_COORDINATE_DEGREE_2, 2, 2), (constants.MAX_COORDINATE_DEGREE_4, 4, 3 * 2 * 2)],
        ids=DEGREES,
    )
    def test_largest_coordinates(self, coordinate: float, degree: int, terms: int) -> None:
        """So many products of differences, up to twice the coordinate, and an expansion's partial sums to twice
        their sum, stay below the largest power of two; with coordinates twice as large, they may not."""
        largest = [terms * (2 * Fraction(c)) ** degree * 2 for c in (coordinate, 2 * coordinate)]
        assert largest[0] <= LARGEST < largest[1]

    def test_grid(self) -> None:
        """Three products of a lift and a cross product of n steps are integers below 2^53; of 2 n steps, not."""
        largest = [3 * (2 * Fraction(n) ** 2) ** 2 for n in (constants.GRID_STEPS, 2 * constants.GRID_STEPS)]
        assert largest[0] <= 2**53 < largest[1]

    @pytest.mark.parametrize("exponent", [-850, 990])
    def test_weights(self, exponent: int) -> None:
        """A right triangle against nearly its area, the permanent next to the end: double-doubles inside only."""
        k = guarded_context()
        for side, is_inside in ((1.0 - 2.0**-20, exponent > 0), (1.0 + 2.0**-20, exponent < 0)):
            width, height = math.ldexp(1.0, exponent // 2), math.ldexp(side, exponent - exponent // 2 - 1)
            area = 0.5 * width * height * (1.0 - 2.0**-52)
            code = area_code(k, area, 0.0, 0.0, width, 0.0, 0.0, height)
            stage = ek.Stage.DOUBLE_DOUBLE if is_inside else ek.Stage.EXPANSION
            assert codes.DECODED[code] == (ek.Sign.POSITIVE, stage)

    @pytest.mark.parametrize(("ulps", "stage"), [(23, ek.Stage.DOUBLE_DOUBLE), (25, ek.Stage.FILTER)])
    def test_filters_of_measures(self, ulps: int, stage: ek.Stage) -> None:
        """They leave 12 u times the permanent, here 2, to others."""
        area = 0.5 * (1.0 - ulps * constants.UNIT_ROUNDOFF)
        code = area_code(guarded_context(), area, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0)
        assert codes.DECODED[code] == (ek.Sign.POSITIVE, stage)


@pytest.mark.obligation(
    "K7",
    "double-doubles answer exactly what exceeds 64 u^2 times the permanent",
    method="named cases",
    control_in="mutants",
)
class TestDoubleDoubleBorder:
    """At the border itself the expansions answer, one step beyond it the double-doubles."""

    @pytest.mark.parametrize("s", [1.0, -1.0])
    def test_products(self, s: float) -> None:
        """1 * 1 - 1 * (1 - t) = t, and the permanent is 2; by turns in each of the four factors."""
        border = float(64 * U**2 * 2)
        scratch = np.empty(48)
        for i in range(4):
            for size, stage in [
                (math.nextafter(border, 0.0), ek.Stage.EXPANSION),
                (border, ek.Stage.EXPANSION),
                (math.nextafter(border, 1.0), ek.Stage.DOUBLE_DOUBLE),
            ]:
                tails = [0.0] * 4
                tails[i] = s * size
                answer = s if i < 2 else -s
                assert (
                    products_difference(1.0, tails[0], 1.0, tails[1], 1.0, tails[2], 1.0, tails[3], scratch)
                    == int(stage) * 4 + answer + 1
                )

    @pytest.mark.parametrize("s", [1.0, -1.0])
    @pytest.mark.parametrize("axis", [0, 1])
    def test_incircle(self, s: float, axis: int) -> None:
        """A corner of the unit square moves by t along an edge: the determinant is t - t^2, the permanent 4."""
        border = float(64 * U**2 * 4)
        for size, stage in [
            (math.nextafter(border, 0.0), ek.Stage.EXPANSION),
            (border, ek.Stage.EXPANSION),
            (math.nextafter(border, 1.0), ek.Stage.DOUBLE_DOUBLE),
        ]:
            corner = (s * size, 0.0) if axis == 0 else (0.0, s * size)
            assert ek.incircle_staged((1, 0), (1, 1), (0, 1), corner) == (s, stage)


HARD = [1.0 + 2.0**-52, 2.0 - 2.0**-52, 1.0 + 2.0**-26, 1.0 + 2.0**-27, 1.0 + 2.0**-25 + 2.0**-52, 4.0 / 3.0]


def bits(x: float) -> int:
    """How many bits there are from the first to the last one that is set."""
    n = abs(Fraction(x).numerator)
    return (n // (n & -n)).bit_length() if n else 0


@pytest.mark.obligation(
    "K5", "split and two_product are error-free for doubles", method="named cases", control_in="mutants"
)
class TestSplitter:
    """The halves of a double have at most 26 bits and its sum; a product and its error sum to the exact product."""

    @pytest.mark.parametrize("scale", [1.0, 2.0**-480, 2.0**500])
    def test_doubles(self, scale: float) -> None:
        numbers = [*HARD, *(1.0 + np.random.default_rng(6).random(30)).tolist()]
        for a in numbers:
            high, low = split(a * scale)
            assert high + low == a * scale
            assert max(bits(high), bits(low)) <= 26
            for b in numbers:
                x, y = two_product(a * scale, -b)
                assert x == -(a * scale) * b
                assert Fraction(x) + Fraction(y) == -Fraction(a * scale) * Fraction(b)


@pytest.mark.obligation("K7", "a code says one sign and one stage", method="exhaustive")
class TestCodes:
    """Every stage with every sign is encoded by one small integer, as documented: stage * 4 + sign + 1."""

    def test_there_and_back(self) -> None:
        zeros = (codes.FILTER, codes.GRID, codes.DOUBLE_DOUBLE, codes.EXPANSION, codes.RATIONAL)
        assert zeros == (1, 5, 9, 13, 17)
        assert self.agree(zeros)

    @staticmethod
    def agree(zeros: Sequence[int]) -> bool:
        """Whether these are the codes of zero, stage by stage."""
        return all(
            codes.DECODED[zero + sign] == ((zero + sign & 3) - 1, zero + sign >> 2) == (sign, stage)
            for zero, stage in zip(zeros, ek.Stage, strict=True)
            for sign in ek.Sign
        )

    def test_control_two_stages_exchanged(self) -> None:
        """The codes of two stages exchanged."""
        assert not self.agree((1, 9, 5, 13, 17))

    def test_values(self) -> None:
        assert [int(sign) for sign in ek.Sign] == [-1, 0, 1]
        assert [int(stage) for stage in ek.Stage] == [0, 1, 2, 3, 4]


@pytest.mark.obligation(
    "J1", "Ctrl-C waits for no more than a chunk, rational or not", method="named cases", control_in="mutants"
)
class TestChunks:
    """Where every predicate may be rational, which takes as long as a hundred others, a chunk is that much smaller."""

    def test_size(self) -> None:
        usual = 1 << 20
        assert chunk_size(make_context(np.ones(2)), usual) == usual
        assert 1 <= 100 * chunk_size(guarded_context(), usual) <= usual
