"""K7: where a line crosses a bisector: certain only if nearest, and the errors handed on are sound and tight."""

import math
import random
from fractions import Fraction

import numpy as np
import pytest
from proofs_tests.graphs.crossing_oracle import is_nearest
from proofs_tests.kernel.interpreted import interpreted
from proofs_tests.kernel.test_bisector_stages import near_ties, numerator
from proofs_tests.rounding.calculus import Bounded, largest_needed
from proofs_tests.rounding.magnitudes import difference, inner

from exactkernel import bisector
from exactkernel.bisector import bisector_crossing
from exactkernel.centre import quotient_offset
from exactkernel.constants import DD_BOUND
from exactkernel.context import guarded_context, make_context

U = Fraction(1, 2**53)
Points = list[tuple[float, float]]


def crossing(
    s: tuple[float, float], p: tuple[float, float], a: tuple[float, float], b: tuple[float, float]
) -> list[Fraction]:
    t = numerator(s, p, a).value / (2 * inner(difference(p, s), difference(b, a)).value)
    return [Fraction(v) + t * (Fraction(w) - Fraction(v)) for v, w in zip(a, b, strict=True)]


def asked(points: Points) -> tuple[float, float, bool]:
    flat = [x for point in points for x in point]
    return bisector_crossing(make_context(np.ones(1)), *flat)


def generic(draw: random.Random) -> Points:
    """Coordinates of several sizes: the differences have tails."""
    return [(draw.uniform(-1, 1) * 2.0 ** draw.randint(-9, 9), draw.uniform(-1, 1)) for _ in range(4)]


@interpreted
@pytest.mark.obligation(
    "K7", "a crossing of a bisector that is called certain is the nearest double", method="property-based"
)
class TestNearest:
    """Certain coordinates are the nearest doubles to the exact ones, and generic ones are certain."""

    def test_generic(self) -> None:
        draw, certain = random.Random(3), 0
        for _ in range(300):
            points = generic(draw)
            x, y, is_certain = asked(points)
            exact = crossing(*points)
            assert not is_certain or (is_nearest(x, exact[0]) and is_nearest(y, exact[1]))
            certain += is_certain
        assert certain > 290

    def test_axis_parallel_lines_keep_their_coordinate(self) -> None:
        assert asked([(0.1, 0.2), (0.4, 0.7), (0.3, 0.0), (0.3, 1.0)])[::2] == (0.3, True)
        assert asked([(0.1, 0.2), (0.4, 0.7), (0.0, 0.3), (1.0, 0.3)])[1:] == (0.3, True)

    def test_half_way_between_doubles_is_left_open(self) -> None:
        """The crossing is (1 + 2^-53, 1): a tie, which no bound decides."""
        sites = [(1.0, 0.0), (1.0 + 2.0**-52, 0.0)]
        assert crossing(sites[0], sites[1], (0.0, 1.0), (2.0, 1.0)) == [1 + U, 1]
        assert asked([*sites, (0.0, 1.0), (2.0, 1.0)])[2] is False
        assert asked([(y, x) for x, y in [*sites, (0.0, 1.0), (2.0, 1.0)]])[2] is False

    @pytest.mark.parametrize("across", [(0.0, 1.0), (0.25, 1.75)])
    def test_parallel_to_the_bisector_is_left_open(self, across: tuple[float, float]) -> None:
        line = [(0.5, 0.5), (0.5 - across[0], 0.5 + across[1])]
        site = (across[1], across[0])
        assert asked([(0.0, 0.0), site, *line]) == (0.5, 0.5, False)

    def test_outside_the_window_is_left_open(self) -> None:
        flat = [0.0, 0.0, 1.0, 0.0, -1.0, 0.5, 2.0, 0.25]
        assert bisector_crossing(guarded_context(), *flat) == (-1.0, 0.5, False)
        assert bisector_crossing(make_context(np.array(flat)), *flat)[2] is True

    def test_control_a_neighbour_is_refused(self) -> None:
        """The double beside the nearest."""
        points = generic(random.Random(3))
        x, _, is_certain = asked(points)
        assert is_certain
        assert not is_nearest(math.nextafter(x, 9.0), crossing(*points)[0])


@interpreted
@pytest.mark.obligation(
    "K1", "the errors of a crossing with a bisector are bounded as pairs are", method="property-based"
)
class TestErrors:
    """The quotient is told numerator and denominator within errors that hold, and are no larger than need be."""

    def test_errors_told_are_sound_and_tight(self, monkeypatch: pytest.MonkeyPatch) -> None:
        told: list[tuple[float, ...]] = []
        original = quotient_offset

        def recorded(*arguments: float) -> tuple[float, float, float]:
            told.append(arguments)
            return original(*arguments)

        monkeypatch.setattr(bisector, "quotient_offset", recorded)
        draw = random.Random(5)
        for _ in range(150):
            points = draw.choice([generic(draw), self.line_through(draw)])
            told.clear()
            asked(points)
            n, w, d = numerator(*points[:3]), difference(points[1], points[0]), difference(points[3], points[2])
            for (a, p, p_tail, p_error, det, det_tail, det_error), axis in zip(told, range(2), strict=False):
                assert a == points[2][axis]
                exact = n.value * d[axis].value
                assert abs(Fraction(p) + Fraction(p_tail) - exact) <= p_error
                first_order = Fraction(DD_BOUND) * (n.permanent * abs(d[axis].value) + abs(exact))
                assert (1 + Fraction(1, 2**9)) * first_order <= p_error <= Fraction(5, 4) * first_order
                twice = 2 * inner(w, d).value
                assert abs(Fraction(det) + Fraction(det_tail) - twice) <= det_error
                first_order = 2 * Fraction(DD_BOUND) * inner(w, d).permanent
                assert abs(det_error - first_order) <= first_order / 2**40

    @staticmethod
    def line_through(draw: random.Random) -> Points:
        """Tails everywhere."""
        s, p, _, a, b = near_ties("crossing order", draw)
        return [s, p, a, b]

    def test_denominators_that_are_too_uncertain_are_refused(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Up to a relative error of 2^-10, that included; errors and denominators are exact here."""
        draw, met = random.Random(1), set()
        tried: list[float] = []

        def refused(a: float, *_: float) -> tuple[float, bool]:
            tried.append(a)
            return 7.0, False

        monkeypatch.setattr(bisector, "_nearest_coordinate", refused)
        for exponent in (-10, -11, -12, -13):
            monkeypatch.setattr(bisector, "DD_BOUND", 2.0**exponent)
            for _ in range(150):
                points = [(float(draw.randint(-4, 4)), float(draw.randint(-4, 4))) for _ in range(4)]
                det = inner(difference(points[1], points[0]), difference(points[3], points[2]))
                if points[2][0] == points[3][0] or det.value == 0 or numerator(*points[:3]).value == 0:
                    continue
                ratio = 2 * Fraction(2) ** exponent * det.permanent / abs(det.value)
                tried.clear()
                assert asked(points) == ((7.0 if tried else points[2][0]), points[2][1], False)
                assert bool(tried) == (ratio <= Fraction(1, 2**10))
                met.add((ratio > Fraction(1, 2**10)) - (ratio < Fraction(1, 2**10)))
        assert met == {-1, 0, 1}

    def test_products_and_results_near_the_underflow_are_refused(self) -> None:
        """2^-900 is the smallest of both."""
        least, below = 2.0**-900, math.nextafter(2.0**-900, 0.0)
        nearest = bisector._nearest_coordinate
        assert nearest(0.0, 1.0, least, 0.0, 0.0, 1.0, 0.0, 0.0) == (least, True)
        assert nearest(0.0, 1.0, -least, 0.0, 0.0, 1.0, 0.0, 0.0) == (-least, True)
        assert nearest(0.0, 1.0, below, 0.0, 0.0, 1.0, 0.0, 0.0) == (0.0, False)
        assert nearest(3.0, 4.0, -below, 0.0, 0.0, 1.0, 0.0, 0.0) == (3.0, False)
        assert nearest(0.0, 1.0, 2.0 * least, 0.0, 0.0, 2.0, 0.0, 0.0) == (least, True)
        assert nearest(0.0, 1.0, 2.0 * least, 0.0, 0.0, 4.0, 0.0, 0.0)[1] is False
        assert nearest(0.3, 0.3, math.nan, 0.0, 0.0, 1.0, 0.0, 0.0) == (0.3, True)
        assert nearest(0.0, 1.0, 1.0, 0.0, math.inf, 1.0, 0.0, 0.0)[1] is False

    def test_the_bound_of_nearer(self) -> None:
        """The last difference is free: that of a lift. Nothing much is given away, and a tie is within it."""
        difference_of_inputs = Bounded(U)
        square = difference_of_inputs * difference_of_inputs
        needed = largest_needed((square + square).e)
        assert needed <= Fraction(bisector._NEARER_BOUND) <= needed + 64 * U * U
        assert bisector.nearer_adaptive(make_context(np.ones(1)), 0.1, 0.2, 0.7, 0.2, 0.4, 0.3) == 1  # by 5e-17
        assert bisector.nearer_adaptive(make_context(np.ones(1)), 0.0, 0.0, 2.0, 0.0, 1.0, 1.0) == 0

    def test_control_a_bound_without_the_slack_is_too_small(self) -> None:
        """The bound without its second-order part."""
        assert Fraction(bisector._NEARER_BOUND) - 32 * U * U < largest_needed(4 * U)
