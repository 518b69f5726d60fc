"""K7: the rational decision about an angle: sound at every precision, and it ends."""

import random
from fractions import Fraction

import pytest
from gmpy2 import mpq
from proofs_tests.kernel import shape_oracle

from exactkernel import anglebound
from exactkernel.anglebound import DIRECTIONS, corner_sign, cosine_and_sine


def compared(cross: Fraction, dot: Fraction, degrees: Fraction) -> int:
    """The sign of the bound minus the angle whose sides have these products: one side is (1, 0)."""
    return -shape_oracle.compare_angle((0, 0), (1, 0), (dot, cross), degrees)


def asked(cross: Fraction, dot: Fraction, degrees: Fraction) -> int:
    return corner_sign(*(mpq(x.numerator, x.denominator) for x in (cross, dot, degrees)))


def near_ties(draw: random.Random) -> tuple[Fraction, Fraction, Fraction]:
    """Cross product, scalar product and bound: the angle is off the bound by 2^-3 to 2^-60."""
    degrees = Fraction(draw.randint(1, 1790), 10) + Fraction(1, 30)
    low, high = shape_oracle.cosine_interval(degrees, 80)
    sine, _ = shape_oracle.cosine_interval(abs(90 - degrees), 80)
    off = Fraction(draw.choice((-1, 1)), 2 ** draw.randint(3, 60))
    size = Fraction(draw.randint(1, 1000), 7)
    return sine * size, ((low + high) / 2 + off) * size, degrees


@pytest.mark.obligation(
    "K7", "the rational decision about an angle is exact from whatever precision it starts", method="property-based"
)
class TestCornerSign:
    """Bounds met exactly, right angles, near ties, and every first precision: the sign is that of the fractions."""

    @pytest.mark.parametrize("precision", [4, 6, 10, 192])
    def test_near_ties(self, precision: int, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(anglebound, "_FIRST_PRECISION", precision)
        draw, met = random.Random(precision), set()
        for _ in range(60):
            triple = near_ties(draw)
            sign = asked(*triple)
            assert sign == compared(*triple)
            met.add(sign)
        assert met == {-1, 1}

    def test_right_angles_against_bounds_beside_them(self) -> None:
        for degrees in (Fraction(89), Fraction(179, 2), Fraction(181, 2), Fraction(91)):
            assert asked(Fraction(3), Fraction(0), degrees) == (1 if degrees > 90 else -1)

    def test_multiples_of_45(self) -> None:
        """All that an angle between rational points can meet, and no others beside them."""
        assert set(DIRECTIONS) == {0, 45, 90, 135, 180}
        for degrees in range(181):
            for dot in (-2, -1, 0, 1, 2):
                triple = Fraction(1), Fraction(dot), Fraction(degrees)
                assert asked(*triple) == compared(*triple)

    def test_control_the_first_precision_alone_is_not_enough(self) -> None:
        """Signs taken from four bits, without the bound of their error."""
        draw, wrong = random.Random(4), 0
        for _ in range(60):
            cross, dot, degrees = near_ties(draw)
            c, s, _ = cosine_and_sine(mpq(degrees.numerator, degrees.denominator), 4)
            value = dot * Fraction(int(s.numerator), int(s.denominator)) - cross * Fraction(
                int(c.numerator), int(c.denominator)
            )
            wrong += ((value > 0) - (value < 0)) != compared(cross, dot, degrees)
        assert wrong > 0


@pytest.mark.obligation(
    "K7", "cosine and sine of a bound err by less than is stated, and are computed once", method="property-based"
)
class TestEnclosures:
    """At every precision: within 2^(4 - precision) of the true values."""

    def test_every_precision(self) -> None:
        draw = random.Random(1)
        for precision in range(4, 60):
            for _ in range(4):
                degrees = Fraction(draw.randint(0, 18000), 100)
                values = cosine_and_sine(mpq(degrees.numerator, degrees.denominator), precision)
                cosine, sine, error = (Fraction(int(v.numerator), int(v.denominator)) for v in values)
                assert error == Fraction(2) ** (4 - precision)
                for value, angle in ((cosine, degrees), (sine, abs(90 - degrees))):
                    low, high = shape_oracle.cosine_interval(angle, 80)
                    assert value - error <= low <= high <= value + error

    @staticmethod
    def needed(precision: int) -> Fraction:
        """What the errors of pi, the bound as it is converted, their product, the quotient and the function add up to:
        an angle below 3.15 errs by (1 + e)^4 - 1 of itself, which sine and cosine pass on, and round by e."""
        e = Fraction(1, 2**precision)
        return Fraction(315, 100) * ((1 + e) ** 4 - 1) + e

    def test_lost_bits(self) -> None:
        """From 10 bits on; relative to e the need falls with the precision, so that more bits ask for no more."""
        error = Fraction(2) ** (anglebound._LOST_BITS - 10)
        assert self.needed(10) <= error
        assert self.needed(11) * 2 < self.needed(10)
        assert anglebound._FIRST_PRECISION >= 10

    def test_control_one_bit_less_is_too_little(self) -> None:
        """2^(3 - precision)."""
        assert self.needed(anglebound._FIRST_PRECISION) > Fraction(2) ** (3 - anglebound._FIRST_PRECISION)

    def test_computed_once(self) -> None:
        """The bounds of a mesher are few: 64 of them are remembered."""
        cosine_and_sine.cache_clear()
        first = cosine_and_sine(mpq(1), 100)
        for degrees in range(2, 65):
            cosine_and_sine(mpq(degrees), 100)
        assert cosine_and_sine(mpq(1), 100) is first

    def test_control_values_of_half_the_precision_are_outside(self) -> None:
        """A sine of 20 bits, held against the bound of 40."""
        _, sine, _ = cosine_and_sine(mpq(20), 20)
        _, exact, error = cosine_and_sine(mpq(20), 40)
        assert abs(sine - exact) > error
