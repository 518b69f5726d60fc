"""The boundary of the kernel: any exact number in, nothing rounded on the way, a typed error that names the culprit."""

from collections.abc import Callable, Sequence
from decimal import Decimal
from fractions import Fraction

import numpy as np
import numpy.typing as npt
import pytest
from gmpy2 import mpq, mpz
from hypothesis import given
from hypothesis import strategies as st
from proofs_tests.kernel import oracle

import exactkernel as ek
from exactkernel.arrays import exact_doubles, finite_points, vertex_indices
from exactkernel.errors import shown

SCALARS: list[tuple[Callable[..., object], int]] = [
    (ek.orient2d, 3),
    (ek.diametral, 3),
    (ek.incircle, 4),
    (ek.incircle_perturbed, 4),
    (ek.circumcentre, 3),
    (ek.segment_crossing, 4),
]
EXTENDED = np.finfo(np.longdouble).nmant > 52


@pytest.mark.obligation(
    "K7", "coordinates of every exact number type, mixed, give the exact sign", method="property-based"
)
class TestNumberTypes:
    """int, float, numpy scalar, Fraction, mpz, mpq of one value give one answer, and no value is rounded."""

    TYPES = (int, float, Fraction, mpz, mpq, np.int8, np.uint64, np.float16, np.float32, np.float64, np.longdouble)

    @given(st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)), min_size=4, max_size=4), st.data())
    def test_mixed_types(self, points: list[tuple[int, int]], data: st.DataObject) -> None:
        kind = st.sampled_from(self.TYPES)
        typed = [tuple(data.draw(kind)(v) for v in p) for p in points]
        assert ek.orient2d(*typed[:3]) == oracle.orient2d(*points[:3])
        assert ek.diametral(*typed[:3]) == oracle.diametral(*points[:3])
        assert ek.incircle(*typed) == oracle.incircle(*points)
        assert ek.incircle_perturbed(*typed) == oracle.incircle_perturbed(*points)

    @given(st.lists(st.tuples(st.fractions(), st.fractions()), min_size=4, max_size=4))
    def test_fractions_that_are_no_doubles(self, points: list[tuple[Fraction, Fraction]]) -> None:
        assert ek.orient2d(*points[:3]) == oracle.orient2d(*points[:3])
        assert ek.diametral(*points[:3]) == oracle.diametral(*points[:3])
        assert ek.incircle(*points) == oracle.incircle(*points)
        assert ek.incircle_perturbed(*points) == oracle.incircle_perturbed(*points)

    @pytest.mark.parametrize(
        "x", [2**53 + 1, mpz(2**53 + 1), np.int64(2**53 + 1), np.uint64(2**64 - 1), 10**400, Fraction(1, 10**400)]
    )
    def test_values_beside_the_doubles(self, x: int | Fraction) -> None:
        same = x if isinstance(x, Fraction) else Fraction(int(x))
        assert ek.orient2d_staged((0, 0), (x, x), (same, same)) == (ek.Sign.ZERO, ek.Stage.RATIONAL)
        assert ek.orient2d((0, 0), (x, x), (same, same + Fraction(1, 10**900))) == 1
        assert ek.orient2d((0, 0), (x, x), (same + Fraction(1, 10**900), same)) == -1

    def test_large_integers_that_are_doubles_stay_doubles(self) -> None:
        assert ek.orient2d_staged((0, 0), (2**60, 0), (0, 2**60))[1] == ek.Stage.FILTER

    @pytest.mark.skipif(not EXTENDED, reason="long double is double on this platform")
    def test_long_double(self) -> None:
        x = np.longdouble(1) + np.longdouble(2) ** -60
        assert ek.orient2d_staged((0, 0), (1, 1), (1, x)) == (  # type: ignore[arg-type]  # its width is a union
            ek.Sign.POSITIVE,
            ek.Stage.RATIONAL,
        )

    def test_arrays_are_points(self) -> None:
        points = np.array([[0, 0], [1, 0], [0, 1]])
        assert ek.orient2d(*points) == 1
        assert ek.orient2d(*points.astype(np.float32)) == 1

    def test_control_rounding_to_doubles_gives_another_sign(self) -> None:
        """A coordinate of 54 bits rounded to a double."""
        a, b, c = (0, 0), (2**53, 2**53), (2**53 + 1, 2**53)
        assert ek.orient2d(a, b, c) == -1
        assert ek.orient2d(a, b, (float(c[0]), float(c[1]))) == 0


@pytest.mark.obligation("K7", "NaN, infinity and what is no number raise a typed error", method="named cases")
class TestBadPoints:
    """Every function refuses every bad coordinate, in every position, with an ExactMeshError that shows it."""

    @pytest.mark.parametrize(("function", "n"), SCALARS)
    @pytest.mark.parametrize(
        "bad", [np.nan, np.inf, -np.inf, np.float32("nan"), np.float64("inf"), np.longdouble("nan")]
    )
    def test_not_finite(self, function: Callable[..., object], n: int, bad: float) -> None:
        good: Sequence[object] = [(0, 0), (1, 0), (0, 1), (Fraction(1, 3), 2)][:n]
        for i in range(n):
            for point in ((bad, 0), (0, bad), (Fraction(1, 3), bad)):
                with pytest.raises(ek.NonFiniteError, match=r"nan|inf"):
                    function(*good[:i], point, *good[i + 1 :])

    @pytest.mark.parametrize(("function", "n"), SCALARS)
    @pytest.mark.parametrize("bad", [True, np.bool_(True), None, "1", b"1", 1j, Decimal(1), [1], np.array([1.0, 2.0])])
    def test_no_number(self, function: Callable[..., object], n: int, bad: object) -> None:
        good: Sequence[object] = [(0, 0), (1, 0), (0, 1), (2, 2)][:n]
        for point in ((bad, 0), (0.5, bad)):
            with pytest.raises(ek.CoordinateError, match=type(bad).__name__):
                function(*good[:-1], point)

    @pytest.mark.parametrize(("function", "n"), SCALARS)
    @pytest.mark.parametrize("bad", [5, None, (), (1,), (1, 2, 3), "abc", np.zeros(3), np.float64(1)])
    def test_no_pair(self, function: Callable[..., object], n: int, bad: object) -> None:
        good: Sequence[object] = [(0, 0), (1, 0), (0, 1), (2, 2)][:n]
        with pytest.raises(ek.ShapeError, match="pair"):
            function(*good[:-1], bad)

    def test_messages_of_huge_numbers(self) -> None:
        with pytest.raises(ek.NonFiniteError, match="too many digits"):
            ek.orient2d((10**5000, np.nan), (0, 0), (1, 1))
        assert len(shown(10**4000)) < 130
        assert shown((1, 2)) == "(1, 2)"

    def test_errors_are_value_errors(self) -> None:
        for error in (ek.CoordinateError, ek.NonFiniteError, ek.ShapeError, ek.DegenerateError):
            assert issubclass(error, ek.ExactMeshError)
            assert issubclass(error, ValueError)

    @pytest.mark.parametrize(("function", "n"), SCALARS)
    def test_control_good_points(self, function: Callable[..., object], n: int) -> None:
        """None: the same points without the bad one are taken."""
        good: Sequence[object] = [(0, 0), (1, 0), (0, 1), (Fraction(1, 3), -2)][:n]
        function(*good)


SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


@pytest.mark.obligation(
    "K7", "array input: any layout and dtype, nothing rounded, culprits named by index", method="named cases"
)
class TestArrays:
    """Numbers that are doubles pass whatever holds them; any other number is refused with its index."""

    @pytest.mark.parametrize("dtype", [np.int8, np.uint16, np.int64, np.uint64, np.float16, np.float32, ">f8", object])
    def test_dtypes(self, dtype: npt.DTypeLike) -> None:
        assert exact_doubles(SQUARE.astype(dtype)).tolist() == SQUARE.tolist()
        assert exact_doubles(SQUARE.astype(dtype)).dtype == np.float64

    def test_layouts(self) -> None:
        read_only = SQUARE.copy()
        read_only.flags.writeable = False
        wide = np.zeros((4, 6))
        wide[:, ::3] = SQUARE
        for array in (read_only, np.asfortranarray(SQUARE), wide[:, ::3], SQUARE[::-1][::-1], SQUARE.tolist()):
            assert finite_points(array).tolist() == SQUARE.tolist()
            assert finite_points(array).flags.c_contiguous
        assert finite_points(np.empty((0, 2))).shape == (0, 2)

    def test_exact_objects(self) -> None:
        exact = np.array([(Fraction(1, 4), mpz(3)), (mpq(1, 2), 2**60)], dtype=object)
        assert exact_doubles(exact).tolist() == [[0.25, 3.0], [0.5, 2.0**60]]

    @pytest.mark.parametrize(
        "bad",
        [
            np.array([[0, 0], [1, 1], [2**53 + 1, 0]]),
            np.array([[0, 0], [1, 1], [0, 2**64 - 1]], dtype=np.uint64),
            np.array([[0, 0], [1, 1], [0, 2**63 - 1]]),
            [(0, 0.5), (1, 1), (2**53 + 1, 0)],
            [(0, -1), (1, 1), (2**63 + 1, 0)],
            [(0, 0), (1, 1), (Fraction(1, 3), 0)],
            [(0, 0), (1, 1), (10**400, 0.5)],
            [(0, 0), (np.nan, 1), (mpq(1, 3), np.inf)],
            [(0, 0), (np.inf, 1), (np.nan, 10**400)],
        ],
    )
    def test_what_would_be_rounded_is_refused(self, bad: npt.ArrayLike) -> None:
        with pytest.raises(ek.CoordinateError, match=r"cloud\[2\].*rounded") as caught:
            exact_doubles(bad, "cloud")
        assert caught.value.indices == (2,)

    @pytest.mark.skipif(not EXTENDED, reason="long double is double on this platform")
    def test_long_double(self) -> None:
        x = np.array([[1, 1], [1, np.longdouble(1) + np.longdouble(2) ** -60]], dtype=np.longdouble)
        with pytest.raises(ek.CoordinateError, match=r"points\[1\]"):
            exact_doubles(x)
        assert exact_doubles(x[:1]).tolist() == [[1.0, 1.0]]

    def test_control_numpy_rounds_in_silence(self) -> None:
        """The conversion that numpy does by itself: 2^53 + 1 becomes 2^53."""
        assert np.asarray([(2**53 + 1, 0.5)])[0, 0] == 2.0**53

    def test_large_doubles_in_a_list_pass(self) -> None:
        assert exact_doubles([(1e300, 0.5), (2**53 + 2, -1e17)]).tolist() == [[1e300, 0.5], [2.0**53 + 2, -1e17]]

    @pytest.mark.parametrize(
        "bad", [5, None, [1, 2], [(1, 2, 3)], [(1, 2), (3,)], np.zeros((2, 3)), np.zeros((2, 2, 2)), "abc"]
    )
    def test_shapes(self, bad: npt.ArrayLike) -> None:
        with pytest.raises(ek.ShapeError, match="points"):
            exact_doubles(bad)

    def test_an_empty_list_is_no_points(self) -> None:
        assert exact_doubles([]).shape == (0, 2)

    def test_masked_values_are_refused(self) -> None:
        masked = np.ma.MaskedArray([(0.0, 0.0), (9e9, 9e9)], mask=[(False, False), (False, True)])
        with pytest.raises(ek.CoordinateError, match=r"points\[1\]: masked") as caught:
            exact_doubles(masked)
        assert caught.value.indices == (1,)
        assert exact_doubles(np.ma.MaskedArray([(0.0, 0.0)])).tolist() == [[0.0, 0.0]]

    @pytest.mark.parametrize(
        "bad", [[(True, False)], [("1", "2")], [(1j, 0)], [(None, 1)], [(Decimal(1), 1)], [(np.nan, None)]]
    )
    def test_no_numbers(self, bad: npt.ArrayLike) -> None:
        with pytest.raises(ek.CoordinateError):
            exact_doubles(bad)

    @pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
    def test_not_finite(self, value: float) -> None:
        points = np.zeros((9, 2))
        points[[3, 5], [0, 1]] = value
        for dtype in (np.float64, np.float32, object):
            with pytest.raises(ek.NonFiniteError, match=r"points\[3\], points\[5\]") as caught:
                finite_points(points.astype(dtype))
            assert caught.value.indices == (3, 5)
        points[:] = value
        with pytest.raises(ek.NonFiniteError, match="and 4 more"):
            finite_points(points)

    def test_a_sum_that_overflows_is_no_culprit(self) -> None:
        largest = np.full((3, 2), 1.7e308)
        assert finite_points(largest).tolist() == largest.tolist()


@pytest.mark.obligation(
    "K7", "vertex indices: any integer dtype, nothing wrapped, culprits named by index", method="named cases"
)
class TestVertexIndices:
    """Integers that fit 31 bits pass whatever holds them; any other is refused with its row."""

    @pytest.mark.parametrize("dtype", [np.int8, np.uint16, np.int64, np.uint64, ">i4"])
    def test_dtypes(self, dtype: npt.DTypeLike) -> None:
        rows = [[0, 1, 2], [2, 1, 3]]
        indices = vertex_indices(np.array(rows, dtype=dtype)[:, ::-1])
        assert indices.dtype == np.int32
        assert indices.flags.c_contiguous
        assert indices[:, ::-1].tolist() == rows

    def test_empty(self) -> None:
        empties: list[npt.ArrayLike] = [[], np.empty((0, 3)), np.empty((0, 3), np.int64)]
        for empty in empties:
            assert vertex_indices(empty).shape == (0, 3)

    @pytest.mark.parametrize("value", [2**31, -(2**31) - 1, 2**63 - 1])
    def test_too_large(self, value: int) -> None:
        with pytest.raises(ek.ShapeError, match=r"triangles\[1\].*32 bits") as caught:
            vertex_indices([[0, 1, 2], [0, 1, value]])
        assert caught.value.indices == (1,)

    @pytest.mark.parametrize("bad", [[[0, 1]], [[0, 1, 2], [3]], [[0.0, 1.0, 2.0]], [["0", "1", "2"]], 5, [0, 1, 2]])
    def test_no_triples_of_integers(self, bad: npt.ArrayLike) -> None:
        with pytest.raises(ek.ShapeError, match="triangles"):
            vertex_indices(bad)

    def test_control_a_cast_wraps_in_silence(self) -> None:
        """The cast that numpy does by itself: 2^32 + 1 becomes 1."""
        assert np.array([2**32 + 1]).astype(np.int32)[0] == 1


BATCHES: list[tuple[Callable[..., npt.NDArray[np.int8]], Callable[..., int], int]] = [
    (ek.orient2d_batch, oracle.orient2d, 3),
    (ek.diametral_batch, oracle.diametral, 3),
    (ek.incircle_batch, oracle.incircle, 4),
]


@pytest.mark.obligation(
    "K7", "batch predicates equal the scalar ones, element by element, over any broadcast", method="differential"
)
class TestBatch:
    """int8 signs, one for each row; a single point stands for as many as the others are."""

    @pytest.mark.parametrize(("batch", "exact", "n"), BATCHES)
    def test_broadcasting(self, batch: Callable[..., npt.NDArray[np.int8]], exact: Callable[..., int], n: int) -> None:
        many = [np.array([[i * j % 7, (i + j * j) % 5] for i in range(11)], dtype=float) for j in range(1, n + 1)]
        for single in range(n + 1):
            operands = [operand[0] if j == single else operand for j, operand in enumerate(many)]
            rows = [[operand.tolist()] * 11 if operand.ndim == 1 else operand.tolist() for operand in operands]
            signs = batch(*operands)
            assert signs.dtype == np.int8
            assert signs.tolist() == [exact(*points) for points in zip(*rows, strict=True)]
        assert batch(*[operand[:1] for operand in many]).shape == (1,)
        assert batch(*[operand[0] for operand in many]).shape == (1,)
        assert batch(*[operand[:0] for operand in many]).shape == (0,)
        assert batch(many[0][0], *[operand[:0] for operand in many[1:]]).shape == (0,)

    @pytest.mark.parametrize(("batch", "n"), [(batch, n) for batch, _, n in BATCHES])
    def test_bad_operands(self, batch: Callable[..., npt.NDArray[np.int8]], n: int) -> None:
        good = [SQUARE] * (n - 1)
        for shape in (SQUARE[:3], np.zeros((2, 4, 2)), np.zeros(3), 5.0, [(1, 2), (3,)], [1, 2, 3]):
            with pytest.raises(ek.ShapeError):
                batch(*good, shape)
        with pytest.raises(ek.NonFiniteError, match=r"[cdp]\[1\]"):
            batch(*good, [(0, 0), (np.nan, 0), (1, 1), (2, 2)])
        with pytest.raises(ek.CoordinateError, match="rounded"):
            batch(*good, (2**53 + 1, 0.5))

    def test_more_than_one_chunk(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr("exactkernel.batch._CHUNK", 3)
        line = np.array([[i, i * i % 7] for i in range(10)], dtype=float)
        expected = [oracle.orient2d((0, 0), (1, 1), p) for p in line.tolist()]
        assert ek.orient2d_batch((0, 0), (1, 1), line).tolist() == expected
        assert len(set(expected)) == 3

    @pytest.mark.parametrize(("batch", "exact", "n"), BATCHES)
    def test_control_a_row_late(
        self, batch: Callable[..., npt.NDArray[np.int8]], exact: Callable[..., int], n: int
    ) -> None:
        """Signs that are those of the row before."""
        with pytest.raises(AssertionError):
            self.test_broadcasting(lambda *points: np.roll(batch(*points), 1), exact, n)


class TestBatchWindow:
    """A power of two brings the operands of a batch into the window: tiny coordinates are not slow, and not wrong."""

    def test_scaled(self) -> None:
        points = np.random.default_rng(0).random((4, 50, 2))
        signs = ek.incircle_batch(*points)
        assert (ek.incircle_batch(*(points * 2.0**-600)) == signs).all()
        assert (
            ek.incircle_batch(points[0] * 2.0**-600, points[1, 0] * 2.0**-600, *(points[2:] * 2.0**-600))
            == ek.incircle_batch(points[0], points[1, 0], *points[2:])
        ).all()
