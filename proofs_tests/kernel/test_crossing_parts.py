"""K1: the parts of a crossing of two segments: determinants, coordinates, and which double is certainly nearest."""

import itertools
import math
import random
from fractions import Fraction

import pytest
from proofs_tests.kernel.interpreted import interpreted

from exactkernel import crossing
from exactkernel.constants import DD_BOUND
from exactkernel.crossing import dd_cross, is_nearest_certain

U = Fraction(1, 2**53)


@interpreted
@pytest.mark.obligation(
    "K1", "the parts of a crossing: errors sound and tight, small products refused", method="property-based"
)
class TestParts:
    """Determinants and coordinates in pairs are within their errors, which the calculus does not undercut by much."""

    def test_determinants(self) -> None:
        draw = random.Random(1)
        for _ in range(300):
            heads = [draw.uniform(-2, 2) * 2.0 ** draw.randint(-9, 9) for _ in range(4)]
            if draw.random() < 0.5:
                heads = [heads[0], heads[1], heads[1], heads[0]]
            tails = [x * draw.uniform(-1, 1) * 2.0**-54 for x in heads]
            high, low, error = dd_cross(*(x for pair in zip(heads, tails, strict=True) for x in pair))
            p, q, r, s = (Fraction(x) + Fraction(y) for x, y in zip(heads, tails, strict=True))
            assert abs(Fraction(high) + Fraction(low) - (p * q - r * s)) <= Fraction(error)
            assert Fraction(error) <= Fraction(DD_BOUND) * (abs(p * q) + abs(r * s)) * (1 + 8 * U)

    def test_coordinates(self) -> None:
        """At all corners of the errors of numerator and denominator, which are known to 2^-10."""
        draw = random.Random(2)
        for relative, _ in itertools.product((0.0, 2.0**-100, 2.0**-40, 2.0**-10), range(50)):
            a, u, num, det = (
                draw.uniform(1, 2) * 2.0 ** draw.randint(-20, 20) * draw.choice((-1, 1)) for _ in range(4)
            )
            u_tail, num_tail, det_tail = (x * draw.uniform(-1, 1) * 2.0**-54 for x in (u, num, det))
            num_error, det_error = abs(num) * relative, abs(det) * relative
            x, tail, error = crossing._coordinate(
                a, u, u_tail, 9.0, 1.0, num, num_tail, num_error, det, det_tail, det_error
            )
            exact_u = Fraction(u) + Fraction(u_tail)
            for s, t in itertools.product((-1, 0, 1), repeat=2):
                top = Fraction(num) + Fraction(num_tail) + s * Fraction(num_error)
                bottom = Fraction(det) + Fraction(det_tail) + t * Fraction(det_error)
                assert abs(Fraction(a) + top / bottom * exact_u - Fraction(x) - Fraction(tail)) <= Fraction(error)
            step = abs(Fraction(num) / Fraction(det) * exact_u)
            first_order = 2 * Fraction(relative) * step + Fraction(DD_BOUND) * (step + abs(Fraction(x)))
            assert Fraction(error) <= Fraction(5, 4) * first_order

    def test_constant_coordinates(self) -> None:
        """Along ab the coordinate of a, along cd that of c, and neither errs."""
        rest = (0.3, 0.0, 0.1, 0.7, 0.0, 0.1)
        assert crossing._coordinate(0.1, 0.0, 0.0, 0.2, 1.0, *rest) == (0.1, 0.0, 0.0)
        assert crossing._coordinate(0.1, 1.0, 0.0, 0.2, 0.0, *rest) == (0.2, 0.0, 0.0)
        assert crossing._coordinate(0.1, 1.0, 0.0, 0.2, 1.0, *rest)[2] > 0.0

    def test_products_near_the_underflow(self) -> None:
        least, below = 2.0**-900, math.nextafter(2.0**-900, 0.0)
        for sign in (-1.0, 1.0):
            for u, num in ((2.0**-500 * sign, 2.0**-400), (least, sign)):
                x, _, error = crossing._coordinate(1.0, u, 0.0, 0.0, 1.0, num, 0.0, 0.0, 1.0, 0.0, 0.0)
                assert (x, error < 1e-20) == (1.0, True)
            assert crossing._coordinate(1.0, below * sign, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0) == (
                1.0,
                0.0,
                math.inf,
            )
            for det, known in ((2.0**900, True), (math.nextafter(2.0**900, math.inf), False)):
                taken = crossing._coordinate(1.0, 1.0, 0.0, 0.0, 1.0, sign, 0.0, 0.0, det, 0.0, 0.0)
                assert (taken[2] < math.inf) is known
                assert known or taken == (1.0, 0.0, math.inf)

    @staticmethod
    def ends(x: float, tail: float, error: float) -> tuple[Fraction, Fraction]:
        """What is within the error of x + tail."""
        middle = Fraction(x) + Fraction(tail)
        return middle - Fraction(error), middle + Fraction(error)

    @pytest.mark.parametrize("scale", [1.0, 2.0**-300, 2.0**-1022, 2.0**-1060])
    def test_zeros(self, scale: float) -> None:
        """Zero is taken where the error allows it, and the new bound holds what the old one held, and little more."""
        kept = 0
        steps = [scale * (1.0 + k * 2.0**-52) for k in range(4)]
        tails = [s * scale * t for s in (-1.0, 1.0) for t in (0.0, 2.0**-54, 2.0**-53, 3.0 * 2.0**-54)]
        for x, tail, error in itertools.product([*steps, *(-s for s in steps)], tails, [*steps, 0.5 * scale]):
            taken = crossing._zero_if_possible(x, tail, error)
            low, high = self.ends(x, tail, error)
            new_low, new_high = self.ends(*taken)
            assert new_low <= low <= high <= new_high
            if taken != (x, tail, error):
                assert taken[:2] == (0.0, 0.0)
                assert abs(Fraction(x)) + abs(Fraction(tail)) <= Fraction(error) * (1 + U)
                assert max(abs(new_low), abs(new_high)) <= 2 * Fraction(error) * (1 + 4 * U)
                kept += 1
            else:
                assert abs(Fraction(x)) + abs(Fraction(tail)) > Fraction(error)
        assert 0 < kept < len(steps) * 2 * len(tails) * 5

    def test_zeros_and_no_bound(self) -> None:
        assert crossing._zero_if_possible(1.0, 0.0, math.inf) == (1.0, 0.0, math.inf)
        assert crossing._zero_if_possible(0.0, 0.0, 0.0) == (0.0, 0.0, 0.0)

    def test_control_twice_the_error_is_too_little(self) -> None:
        """The bound 2 e: the sum of 1 and u is rounded to e = 1, and 2 + u is beyond it."""
        x, tail, error = 1.0, 2.0**-53, 1.0
        assert crossing._zero_if_possible(x, tail, error)[:2] == (0.0, 0.0)
        assert self.ends(x, tail, error)[1] > 2 * Fraction(error)

    def test_control_a_lost_tail_is_noticed(self) -> None:
        """A result without its tail, or with the tail's sign changed."""
        high, low, error = dd_cross(1 / 3, 0.0, 1 / 7, 0.0, 0.0, 0.0, 0.0, 0.0)
        exact = Fraction(1 / 3) * Fraction(1 / 7)
        assert abs(Fraction(high) + Fraction(low) - exact) <= Fraction(error) < abs(Fraction(high) - exact)


@interpreted
@pytest.mark.obligation(
    "ARR2", "a double is called nearest only if it is nearest to all that the error allows", method="named cases"
)
class TestNearestCertain:
    """Certain: nearest to both ends. Uncertain: an end is at the border, or nearer to it than the margin's 4u."""

    def test_both_ends(self) -> None:
        draw, met = random.Random(3), set()
        for x in (1.0, 1.5, -1.0, 1.0 + 2.0**-52, 2.0**-300 * 1.1):
            for _ in range(80):
                tail = x * 2.0**-53 * draw.choice((0.0, draw.uniform(-1, 1)))
                error = abs(x) * 2.0**-53 * draw.choice((0.0, 1e-9, draw.random()))
                ends = [Fraction(x) + Fraction(tail) + s * Fraction(error) for s in (-1, 1)]
                wide = [
                    e + s * (4 * U * (abs(Fraction(tail)) + Fraction(error)) * (1 + 4 * U))
                    for e, s in zip(ends, (-1, 1), strict=True)
                ]
                certain = is_nearest_certain(x, tail, error)
                assert not certain or all(float(e) == x for e in ends)
                assert certain or not all(float(e) == x for e in wide)
                met.add((certain, tail > 0, tail < 0, error > 0))
        assert len(met) >= 10

    def test_the_margin(self) -> None:
        """Down to the next double it is 2^-54 from 1: an error 2u of itself below that is within the margin."""
        for step, certain in ((8, True), (2, False)):
            assert is_nearest_certain(1.0, 0.0, 2.0**-54 * (1 - step * 2.0**-53)) is certain
        assert is_nearest_certain(0.5, 0.0, 0.0)
        assert is_nearest_certain(0.0, 0.0, 0.0)
        assert not is_nearest_certain(0.5, 0.0, math.inf)
        assert not is_nearest_certain(0.5, 0.5, 0.0)
        assert not is_nearest_certain(0.5, -0.5, 0.0)

    def test_control_a_margin_of_nothing_lies(self) -> None:
        """A sum that is rounded twice, taken as if it were not."""
        tail = 2.0**-53 * (1 - 2.0**-53)
        assert 1.0 + (tail + 2.0**-54 * 2.0**-53) == 1.0  # rounded twice
        assert not is_nearest_certain(1.0, tail, 2.0**-54 * 2.0**-52)
