"""K7: the boundary of arrays: what passes, to the last value, what is refused, and how a refusal reads."""

import math
import re
from collections.abc import Callable
from fractions import Fraction
from functools import partial

import numpy as np
import numpy.typing as npt
import pytest
from proofs_tests.kernel import oracle

import exactkernel as ek
from exactkernel import arrays, batch
from exactkernel.arrays import exact_doubles, finite_points, unrounded_array, vertex_indices
from exactkernel.coordinates import doubles_of
from exactkernel.errors import shown

INTEGERS = (np.int8, np.int16, np.int32, np.int64, np.uint8, np.uint16, np.uint32, np.uint64)


def raised(kind: type[ek.ExactMeshError], function: Callable[[], object]) -> tuple[str, tuple[int, ...]]:
    """The message and the indices of the error."""
    with pytest.raises(kind) as caught:
        function()
    assert caught.type is kind
    return str(caught.value), caught.value.indices


@pytest.mark.obligation(
    "K7", "an integer array passes exactly where it holds doubles", method="named cases", control_in="mutants"
)
class TestIntegerArrays:
    """For every integer type: its extremes pass if they are doubles, and are refused by index if not; the check never
    casts a number to a type that does not hold it, which means something else on each processor."""

    @pytest.mark.parametrize("dtype", INTEGERS)
    def test_extremes(self, dtype: type[np.integer[npt.NBitBase]]) -> None:
        limits = np.iinfo(dtype)
        values = {limits.min, limits.min + 1, 0, 5, limits.max // 2 + 1, limits.max - 1, limits.max}
        values |= {v for e in (52, 53, 54, 60, 62, 63) for v in (2**e - 1, 2**e, 2**e + 1) if v <= limits.max}
        for value in values:
            array = np.array([[0, 0], [1, 1], [2, value]], dtype=dtype)
            with np.errstate(invalid="raise"):
                kept = arrays._is_kept(array, array.astype(np.float64))
            assert kept.tolist() == [[True, True], [True, True], [True, int(float(value)) == value]]
            if kept.all():
                assert exact_doubles(array).tolist() == array.tolist()
            else:
                message, indices = raised(ek.CoordinateError, partial(exact_doubles, array, "p"))
                assert message.startswith(f"p[2]: [2, {value}] would be rounded")
                assert indices == (2,)

    @pytest.mark.parametrize("dtype", [np.float16, np.float32, np.longdouble])
    def test_floats_of_any_size(self, dtype: type[np.floating[npt.NBitBase]]) -> None:
        limits = np.finfo(dtype)
        largest = min(float(limits.max), 1e300)
        array = np.array([[largest, -largest], [limits.smallest_normal, math.inf], [0.0, math.nan]], dtype=dtype)
        if dtype is np.longdouble:
            array[1, 0] = 2.0**-1074
        assert exact_doubles(array)[:2].tolist() == array.astype(np.float64)[:2].tolist()
        assert np.isnan(exact_doubles(array)[2, 1])

    def test_lists_are_floats_until_numpy_may_have_rounded(self) -> None:
        for value in (1.0, 2.0**52, 2.0**53 - 1.0, -(2.0**53) + 1.0, math.inf * 0.0):
            assert unrounded_array([(value, 0.5)], "p").dtype == np.float64
        for value in (2.0**53, -(2.0**53), 1e300):
            assert unrounded_array([(value, 0.5)], "p").dtype == object
            assert unrounded_array(np.array([(value, 0.5)]), "p").dtype == np.float64
        assert unrounded_array([(2**60, 1)], "p").dtype.kind == "i"

    def test_doubles_keep_the_sign_of_zero(self) -> None:
        for zero in (-0.0, np.float64(-0.0)):
            assert [math.copysign(1.0, x) for x in doubles_of((zero, 1), (0.0, zero)) or ()] == [-1.0, 1.0, 1.0, -1.0]

    @pytest.mark.parametrize("value", [2**53 - 1, 2**53, 2**53 + 2, 2**60, 0, 1])
    def test_integers_that_are_doubles(self, value: int) -> None:
        numbers: list[int | Fraction] = [value, -value, Fraction(value)]
        for v in numbers:
            assert doubles_of((v, 0.25)) == [float(v), 0.25]
        for other in (2**53 + 1, -(2**53) - 1, Fraction(1, 3)):
            assert doubles_of((other, 0.25)) is None


@pytest.mark.obligation(
    "K7",
    "a refusal names the culprits, five of them at most, and shows the first",
    method="named cases",
    control_in="mutants",
)
class TestRefusals:
    """Messages and ``indices``, for one to seven culprits in any column."""

    NAMES = ("", "p[1]", "p[1], p[2]", "p[1], p[2], p[3]", "p[1], p[2], p[3], p[4]", "p[1], p[2], p[3], p[4], p[5]")

    @classmethod
    def named(cls, n: int) -> str:
        return cls.NAMES[n] if n <= 5 else f"{cls.NAMES[5]} and {n - 5} more"

    @pytest.mark.parametrize("n", range(1, 8))
    @pytest.mark.parametrize("column", [0, 1])
    def test_points(self, n: int, column: int) -> None:
        points = np.arange(20.0).reshape(10, 2)
        points[1 : n + 1, column] = -np.inf
        message, indices = raised(ek.NonFiniteError, lambda: finite_points(points, "p"))
        assert message == f"{self.named(n)}: {points[1].tolist()} is not finite"
        assert indices == tuple(range(1, n + 1))
        whole = np.arange(20).reshape(10, 2)
        whole[1 : n + 1, column] += 2**60
        rounded = whole | 1
        message, indices = raised(ek.CoordinateError, lambda: exact_doubles(rounded, "p"))
        assert message.startswith(f"{self.named(n)}: {rounded[1].tolist()} would be rounded")
        assert indices == tuple(range(1, n + 1))
        masked = np.ma.MaskedArray(points, mask=points == -np.inf)
        assert raised(ek.CoordinateError, lambda: exact_doubles(masked, "p")) == (f"{self.named(n)}: masked", indices)

    @pytest.mark.parametrize("n", range(1, 8))
    @pytest.mark.parametrize("column", [0, 1, 2])
    def test_vertices(self, n: int, column: int) -> None:
        triangles = np.arange(30).reshape(10, 3)
        triangles[1 : n + 1, column] = 2**31
        message, indices = raised(ek.ShapeError, lambda: vertex_indices(triangles, "p"))
        assert message == f"{self.named(n)}: {triangles[1].tolist()} does not fit 32 bits"
        assert indices == tuple(range(1, n + 1))

    def test_the_last_indices_that_fit(self) -> None:
        rows = [[-(2**31), 2**31 - 1, 0]]
        assert vertex_indices(rows).tolist() == rows
        for value in (-(2**31) - 1, 2**31):
            assert raised(ek.ShapeError, partial(vertex_indices, [[0, 1, value]]))[1] == (0,)

    def test_shapes(self) -> None:
        assert raised(ek.ShapeError, lambda: exact_doubles([[1, 2, 3]], "p"))[0] == (
            "p has shape (1, 3) (list); expected (n, 2)"
        )
        assert raised(ek.ShapeError, lambda: exact_doubles(np.zeros((1, 3)), "p"))[0] == (
            "p has shape (1, 3); expected (n, 2)"
        )
        for bad in (np.zeros((2, 1)), np.zeros(2), np.zeros((2, 2, 2)), np.zeros((0, 3)), np.zeros((1, 0))):
            raised(ek.ShapeError, partial(exact_doubles, bad))
        for bad in (np.zeros((3, 2), int), np.zeros(3, int), np.zeros((3, 3, 3), int), np.zeros((0, 3, 3), int)):
            raised(ek.ShapeError, partial(vertex_indices, bad))
        for ragged in (lambda: exact_doubles([[1, 2], [3]], "p"), lambda: vertex_indices([[1, 2, 3], [3]], "p")):
            assert re.match(r"p is not an array of shape \([nm], [23]\): ", raised(ek.ShapeError, ragged)[0])

    def test_objects(self) -> None:
        bad = np.array([[1, 2], [3, None], [5, 6]], dtype=object)
        message, indices = raised(ek.CoordinateError, lambda: exact_doubles(bad, "p"))
        assert message.startswith("p[1]: a coordinate is ")
        assert indices == (1,)

    @pytest.mark.parametrize("digits", [1, 119, 120, 121, 122, 400])
    def test_shown(self, digits: int) -> None:
        """Up to 120 characters in full, else the first hundred and the last seventeen."""
        value = int("123456789" * 50) % 10**digits + 10 ** (digits - 1) * (digits > 1)
        text = str(value)
        assert shown(value) == (text if len(text) <= 120 else f"{text[:100]}...{text[-17:]}")


@pytest.mark.obligation(
    "K7", "a batch gives every sign, whatever its length and its chunks", method="differential", control_in="mutants"
)
class TestChunks:
    """Every row is decided, the first and the last of each chunk as well, and in its own place."""

    @pytest.mark.parametrize(
        ("signs_of", "exact", "n"),
        [
            (ek.orient2d_batch, oracle.orient2d, 3),
            (ek.diametral_batch, oracle.diametral, 3),
            (ek.incircle_batch, oracle.incircle, 4),
        ],
    )
    def test_chunks(
        self,
        signs_of: Callable[..., npt.NDArray[np.int8]],
        exact: Callable[..., int],
        n: int,
        monkeypatch: pytest.MonkeyPatch,
    ) -> None:
        points = np.random.default_rng(3).integers(-3, 4, (n, 11, 2)).astype(float)
        expected = [exact(*row) for row in np.swapaxes(points, 0, 1).tolist()]
        assert set(expected) == {-1, 0, 1}
        monkeypatch.setattr(np, "empty", lambda shape, dtype: np.full(shape, 9, dtype))  # nothing by chance
        for chunk in (1, 3, 11, 12, 1 << 20):
            monkeypatch.setattr(batch, "_CHUNK", chunk)
            assert signs_of(*points).tolist() == expected
        monkeypatch.undo()

    def test_lengths_that_differ(self) -> None:
        message, _ = raised(ek.ShapeError, lambda: ek.orient2d_batch(np.zeros((2, 2)), (0, 0), np.zeros((3, 2))))
        assert message == "the lengths do not broadcast: a 2, b 1, c 3"
