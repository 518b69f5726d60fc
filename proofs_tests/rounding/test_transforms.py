"""K5, first half: the error-free transforms, over every pair of tiny floats."""

import numpy as np
import pytest
from proofs_tests.recording import Record
from proofs_tests.rounding.minifloat import Arithmetic, Backend, Floats, MiniFloat, all_numbers, derive, round_array

from exactkernel.expansions import fast_two_sum, split, two_diff, two_product, two_sum

PRECISIONS = (3, 4, 5, 7, 8)


def every_pair(precision: int) -> tuple[Floats, Floats]:
    """All pairs up to a common scale: a in one binade (or zero), b in every binade that can interact with it."""
    a = all_numbers(precision, range(1))
    b = all_numbers(precision, range(-precision - 3, precision + 4))
    first, second = np.meshgrid(a, b, indexing="ij")
    return first.ravel(), second.ravel()


def derived(name: str, mini: MiniFloat) -> Arithmetic:
    return derive([two_sum, fast_two_sum, two_diff, split, two_product], mini, Backend.ARRAYS)[name]


def is_error_free(function: Arithmetic, exact: Floats, a: Floats, b: Floats, precision: int) -> bool:
    """x is the rounded result, y a number of the format, and x + y is the exact result."""
    x, y = function(a, b)
    return bool(
        np.array_equal(x, round_array(exact, precision))
        and np.array_equal(y, round_array(y, precision))
        and np.array_equal(x + y, exact)
    )


@pytest.mark.obligation(
    "K5", "two_sum, fast_two_sum, two_diff are error-free for every pair (exhaustive, 3 to 8 bits)", method="exhaustive"
)
class TestSums:
    """x = fl(a + b) and x + y = a + b exactly, for every pair of floats; fast_two_sum where |a| >= |b| or a = 0."""

    @pytest.mark.parametrize("precision", PRECISIONS)
    def test_two_sum(self, precision: int, record_property: Record) -> None:
        a, b = every_pair(precision)
        assert is_error_free(derived("two_sum", MiniFloat(precision)), a + b, a, b, precision)
        record_property("cases", len(a))

    @pytest.mark.parametrize("precision", PRECISIONS)
    def test_two_diff(self, precision: int, record_property: Record) -> None:
        a, b = every_pair(precision)
        assert is_error_free(derived("two_diff", MiniFloat(precision)), a - b, a, b, precision)
        record_property("cases", len(a))

    @pytest.mark.parametrize("precision", PRECISIONS)
    def test_fast_two_sum_under_its_condition(self, precision: int, record_property: Record) -> None:
        a, b = every_pair(precision)
        allowed = (abs(a) >= abs(b)) | (a == 0.0)
        a, b = a[allowed], b[allowed]
        assert is_error_free(derived("fast_two_sum", MiniFloat(precision)), a + b, a, b, precision)
        record_property("cases", len(a))

    @pytest.mark.parametrize("precision", PRECISIONS)
    def test_control_fast_two_sum_without_its_condition_fails(self, precision: int) -> None:
        """fast_two_sum on pairs whose first is the smaller."""
        a, b = every_pair(precision)
        assert not is_error_free(derived("fast_two_sum", MiniFloat(precision)), a + b, a, b, precision)

    @pytest.mark.parametrize(
        ("name", "edit"),
        [
            ("two_sum", ("(a - a_virtual) + ", "")),
            ("two_sum", ("a_virtual = x - b_virtual", "a_virtual = a")),
            ("two_diff", ("(b_virtual - b)", "(b - b_virtual)")),
            ("two_diff", ("a_virtual = x + b_virtual", "a_virtual = a")),
        ],
    )
    def test_control_wrong_formulas_fail(self, name: str, edit: tuple[str, str]) -> None:
        """Terms of the formulas dropped or exchanged, one by one."""
        a, b = every_pair(5)
        exact = a + b if name == "two_sum" else a - b
        assert not is_error_free(derived(name, MiniFloat(5, edits={name: edit})), exact, a, b, 5)


@pytest.mark.obligation(
    "K5", "split and two_product are error-free for every pair (exhaustive, 3 to 10 bits)", method="exhaustive"
)
class TestProduct:
    """split gives two halves that multiply without rounding; two_product: x = fl(a b), x + y = a b exactly."""

    @staticmethod
    def pairs(precision: int) -> tuple[Floats, Floats]:
        binade = all_numbers(precision, range(1))
        a, b = np.meshgrid(binade, binade, indexing="ij")
        return a.ravel(), b.ravel()

    @staticmethod
    def halves_are_short(mini: MiniFloat, a: Floats) -> bool:
        high, low = derived("split", mini)(a)
        half = mini.precision // 2
        return bool(
            np.array_equal(high + low, a)
            and np.array_equal(round_array(high, half), high)
            and np.array_equal(round_array(low, half), low)
        )

    @pytest.mark.parametrize("precision", [4, 5, 6, 7, 8, 9, 10])
    def test_split(self, precision: int, record_property: Record) -> None:
        assert self.halves_are_short(MiniFloat(precision), all_numbers(precision, range(1)))
        record_property("cases", 2 ** (precision - 1))

    @pytest.mark.parametrize("precision", [4, 5, 6, 7, 8, 9, 10])
    def test_two_product(self, precision: int, record_property: Record) -> None:
        a, b = self.pairs(precision)
        assert is_error_free(derived("two_product", MiniFloat(precision)), a * b, a, b, precision)
        record_property("cases", len(a))

    @pytest.mark.parametrize("splitter", [5.0, 9.0, 33.0, 65.0])
    def test_control_a_wrong_splitter_fails(self, splitter: float) -> None:
        """Splitters that are too small or too large."""
        mini = MiniFloat(7, constants={"SPLITTER": splitter})
        a, b = self.pairs(7)
        assert not is_error_free(derived("two_product", mini), a * b, a, b, 7)
        assert not self.halves_are_short(mini, all_numbers(7, range(1)))

    @pytest.mark.parametrize("edit", [(" - a_high * b_low", ""), ("a_low * b_low - error", "-error")])
    def test_control_a_dropped_partial_product_fails(self, edit: tuple[str, str]) -> None:
        """A partial product dropped."""
        a, b = self.pairs(7)
        mini = MiniFloat(7, edits={"two_product": edit})
        assert not is_error_free(derived("two_product", mini), a * b, a, b, 7)


@pytest.mark.obligation(
    "K5", "the tool itself: a derived function rounds, and rounds half to even", method="exhaustive"
)
class TestMiniFloat:
    """Both roundings of the tool agree with each other and with the definition, for all sums of tiny floats."""

    @pytest.mark.parametrize("precision", [2, 3, 5])
    def test_rounding_is_to_nearest_even(self, precision: int) -> None:
        numbers = np.sort(all_numbers(precision, range(-9, 8)))
        for x in np.arange(-60, 61) / 8.0:
            nearest = np.flatnonzero(abs(numbers - x) == abs(numbers - x).min())
            expected = [numbers[i] for i in nearest]
            rounded = float(round_array(np.array([x]), precision)[0])
            assert rounded in expected
            if len(expected) == 2:  # the even one has the significand that needs a bit less
                other = expected[0] if rounded == expected[1] else expected[1]
                assert round_array(np.array([rounded]), precision - 1)[0] == rounded
                assert round_array(np.array([other]), precision - 1)[0] != other

    def test_scalar_and_array_backends_agree(self) -> None:
        a, b = every_pair(3)
        over_arrays = derive([two_sum], MiniFloat(3), Backend.ARRAYS)["two_sum"](a, b)
        scalar = derive([two_sum], MiniFloat(3), Backend.PYTHON)["two_sum"]
        one_by_one = [scalar(x, y) for x, y in zip(a.tolist(), b.tolist(), strict=True)]
        assert np.array_equal(np.transpose(over_arrays), np.array(one_by_one))

    def test_quantum_is_gradual_underflow(self) -> None:
        x = np.array([0.75, 1.25, 2.5, 3.5, 5.0])
        assert round_array(x, 2, quantum=1.0).tolist() == [1.0, 1.0, 2.0, 4.0, 4.0]
        assert round_array(np.array([0.5, 0.25]), 2, quantum=1.0).tolist() == [0.0, 0.0]

    def test_control_a_stale_edit_is_noticed(self) -> None:
        """An edit of text that the source does not have."""
        with pytest.raises(LookupError):
            derived("two_sum", MiniFloat(3, edits={"two_sum": ("no such text", "")}))
