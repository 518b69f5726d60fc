"""K7: what is asked of expansions about a circumcentre, what is made of the answers, and what is left open."""

import itertools
import math
from fractions import Fraction

import pytest
from proofs_tests.kernel.interpreted import interpreted
from proofs_tests.kernel.test_centre import MAX, MIN, U, open_context

from exactkernel import centre
from exactkernel.centre import nearest_circumcentre


@interpreted
@pytest.mark.obligation("K7", "what cannot be decided about a circumcentre is left open", method="named cases")
class TestLeftOpen:
    """With answers of the expansions given: what is asked of them, and what is made of the answers."""

    @staticmethod
    def decided(
        patch: pytest.MonkeyPatch, x: float, tail: float, *answers: tuple[int, float]
    ) -> tuple[tuple[float, bool], list[tuple[float, float]]]:
        asked: list[tuple[float, float]] = []

        def scripted(_: int, middle: float, rest: float, *__: object) -> tuple[int, float]:
            asked.append((middle, rest))
            return answers[len(asked) - 1]

        patch.setattr(centre, "_beyond", scripted)
        return centre._decided(open_context(), 0, x, tail, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0), asked

    def test_starts_outside_of_the_window(self, monkeypatch: pytest.MonkeyPatch) -> None:
        below, above = math.nextafter(MIN, 0.0), math.nextafter(MAX, math.inf)
        for x, tail in ((below, 0.0), (-below, 0.0), (above, 0.0), (1.0, above), (1.0, -above), (above, 1.0)):
            assert self.decided(monkeypatch, x, tail, (0, 0.0)) == ((x, False), [])
        for x in (MIN, -MIN, MAX, 0.0):
            assert self.decided(monkeypatch, x, 0.0, (0, 0.0)) == ((x, True), [(x, 0.0)])

    def test_tails_below_the_window_are_dropped(self, monkeypatch: pytest.MonkeyPatch) -> None:
        for sign in (-1, 1):
            assert self.decided(monkeypatch, 1.0, sign * MIN, (0, 0.0))[1] == [(1.0, sign * MIN)]
            assert self.decided(monkeypatch, 1.0, sign * math.nextafter(MIN, 0.0), (0, 0.0))[1] == [(1.0, 0.0)]

    def test_differences_that_are_too_large(self, monkeypatch: pytest.MonkeyPatch) -> None:
        for difference_found in (MAX, -MAX, math.inf, math.nan):
            assert self.decided(monkeypatch, 1.0, 0.0, (1, difference_found)) == ((1.0, False), [(1.0, 0.0)])
        below = math.nextafter(MAX, 0.0)
        monkeypatch.setattr(centre, "is_nearest_certain", lambda *_: True)
        assert self.decided(monkeypatch, 1.0, 0.0, (1, below))[0] == (below, True)

    def test_the_smallest_result(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """MIN itself is large enough; what may be below is compared with zero, and left open if it is not zero."""
        assert self.decided(monkeypatch, MIN, 0.0, (1, MIN * 2.0**-80)) == ((MIN, True), [(MIN, 0.0)])
        assert self.decided(monkeypatch, -MIN, 0.0, (1, MIN * 2.0**-80)) == ((-MIN, True), [(-MIN, 0.0)])
        below = math.nextafter(MIN, 0.0) - MIN
        for sign in (-1, 1):
            for side in (0, 1):
                found = self.decided(monkeypatch, sign * MIN, 0.0, (-sign, sign * below), (side, 0.0))
                assert found == ((0.0, side == 0), [(sign * MIN, 0.0), (0.0, 0.0)])

    def test_near_zero_is_asked_of_zero(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """An interval that touches [-MIN, MIN] from either side, and one that just does not."""
        monkeypatch.setattr(centre, "is_nearest_certain", lambda *_: False)
        for sign in (-1, 1):
            _, asked = self.decided(monkeypatch, sign * MIN, 0.0, (1, MIN * 2.0**-80), (1, 0.0))
            assert asked[1] == (0.0, 0.0)
            _, asked = self.decided(monkeypatch, sign * MIN * (1 + 2.0**-51), 0.0, (1, MIN * 2.0**-80), (1, 0.0))
            assert asked[1:] != [(0.0, 0.0)]

    def test_more_than_two_candidates(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """An error of several units in the last place, and none at all, are left open."""
        monkeypatch.setattr(centre, "is_nearest_certain", lambda *_: False)
        assert self.decided(monkeypatch, -1.0, 0.0, (1, 1.0 + 2.0**-3))[0][1] is False
        assert self.decided(monkeypatch, 1.0, 0.0, (1, 2.0**-60)) == ((1.0, False), [(1.0, 0.0)])

    def test_two_candidates(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Half-way between 1 and its neighbour: the exact side decides, and the even one if it is a tie."""
        high = 1.0 + 2.0**-52
        for side, wanted in ((-1, 1.0), (0, 1.0), (1, high)):
            found = self.decided(monkeypatch, 1.0, 0.0, (1, 2.0**-53), (side, 0.0))
            assert found == ((wanted, True), [(1.0, 0.0), (1.0, 2.0**-53)])
        higher = high + 2.0**-52
        assert self.decided(monkeypatch, high, 2.0**-53, (0, 0.0), (0, 0.0))[0] == (higher, True)

    def test_errors_told(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """At least 16u of the difference and u of the sum, at most twice that."""
        told: list[float] = []

        def recorded(_: float, __: float, error: float) -> bool:
            told.append(error)
            return True

        monkeypatch.setattr(centre, "is_nearest_certain", recorded)
        for tail, found in ((0.0, 2.0**-60), (2.0**-53, 2.0**-90), (2.0**-60, -(2.0**-61)), (2.0**-60, -(2.0**-60))):
            self.decided(monkeypatch, 1.0, tail, (1, found))
            least = 16 * U * abs(Fraction(found)) + U * abs(Fraction(tail) + Fraction(found))
            assert least <= Fraction(told.pop()) <= 2 * least * (1 + 2 * U)

    def test_the_interval_in_question(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """It reaches beyond the error by at least 4u, at most 8u, of what the error is added to."""
        monkeypatch.setattr(centre, "is_nearest_certain", lambda *_: False)
        for x, half in ((1.0, 2.0**-53), (-1.0, -(2.0**-53)), (1.5, 2.0**-53), (-1.5, -(2.0**-53))):
            first = 0
            for steps in range(400):  # units of u below the middle of two doubles
                near = half * (1 - steps * 2.0**-53)
                (_, is_certain), _ = self.decided(monkeypatch, x, 0.0, (1, near), (1, 0.0))
                first = max(first, steps * is_certain)
            assert 32 + 2 + 4 - 1 <= first <= 32 + 2 + 8 + 1

    def test_the_interval_of_an_error_alone(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """An error 2u of itself below the middle of two doubles, on either side of 1: three candidates."""
        monkeypatch.setattr(centre, "is_nearest_certain", lambda *_: False)
        for steps, is_decided in ((2, False), (32, True)):
            found = 2.0**-5 * (1 - steps * 2.0**-53)
            assert self.decided(monkeypatch, 1.0, -found, (1, found), (0, 0.0))[0][1] is is_decided

    def test_when_expansions_are_asked(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Only for coordinates that pairs leave open, or that are below the window; not after one that failed."""
        values = (
            (1.0, 0.0),
            (1.0, 2.0**-53),
            (MIN, 0.0),
            (-MIN, 0.0),
            (math.nextafter(MIN, 0.0), 0.0),
            (1.0, math.inf),
        )
        for (x, x_error), (y, y_error) in itertools.product(values, repeat=2):
            for answers in itertools.product((True, False), repeat=2):
                pairs = (x, 0.0, x_error, y, 0.0, y_error)
                asked: list[tuple[int, float]] = []

                def decide(
                    _: object,
                    axis: int,
                    value: float,
                    *__: float,
                    asked: list[tuple[int, float]] = asked,
                    answers: tuple[bool, ...] = answers,
                ) -> tuple[float, bool]:
                    asked.append((axis, value))
                    return 7.0 + axis, answers[axis]

                monkeypatch.setattr(centre, "circumcentre_in_pairs", lambda *_, pairs=pairs: pairs)
                monkeypatch.setattr(centre, "_decided", decide)
                found = nearest_circumcentre(open_context(), *[0.0] * 6)
                open_ = [abs(value) < MIN or error > 0.0 for value, error in ((x, x_error), (y, y_error))]
                if math.inf in (x_error, y_error):
                    assert (found, asked) == ((x, y, False), [])
                    continue
                first_failed = open_[0] and not answers[0]
                wanted = [(0, x)] * open_[0] + [(1, y)] * (open_[1] and not first_failed)
                assert asked == wanted
                certain = not first_failed and (not open_[1] or answers[1])
                assert found == (7.0 if open_[0] else x, 8.0 if (1, y) in wanted else y, certain)

    def test_control_a_scripted_answer_is_heeded(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """The opposite answer about a tie."""
        up = self.decided(monkeypatch, 1.0, 0.0, (1, 2.0**-53), (1, 0.0))
        assert up != self.decided(monkeypatch, 1.0, 0.0, (1, 2.0**-53), (-1, 0.0))
