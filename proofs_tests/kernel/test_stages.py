"""K7: which stage answers, exactly: each filter and each stage leaves off where its bound or its window does."""

import math
from collections.abc import Callable, Iterator
from fractions import Fraction
from itertools import permutations, product

import numpy as np
import pytest
from proofs_tests.kernel import oracle
from proofs_tests.kernel.strategies import Point

import exactkernel as ek
from exactkernel.constants import (
    MAX_COORDINATE_DEGREE_2,
    MAX_COORDINATE_DEGREE_4,
    MIN_COORDINATE_DEGREE_2,
    MIN_COORDINATE_DEGREE_4,
)
from exactkernel.context import SCRATCH_SIZE, make_context
from exactkernel.diametral import diametral_adaptive, diametral_filter
from exactkernel.incircle import (
    incircle_adaptive,
    incircle_expansion,
    incircle_filter,
    incircle_perturbed_adaptive,
    lifted_term,
)
from exactkernel.orient2d import orient2d_adaptive, orient2d_filter

Filter = Callable[..., int]
Adaptive = Callable[..., int]


def sign(x: Fraction | float) -> int:
    return (x > 0) - (x < 0)


def terms_of_incircle(points: list[tuple[int, int]]) -> list[int]:
    """The products whose sum is the determinant of rows (x, y, x^2 + y^2), the last point being the origin."""
    (dx, dy) = points[3]
    rows = [(x - dx, y - dy, (x - dx) ** 2 + (y - dy) ** 2) for x, y in points[:3]]
    return [
        oracle.parity(p) * rows[0][p[0]] * rows[1][p[1]] * rows[2][p[2]] for p in permutations(range(3))
    ]  # fmt: skip


def terms_of_orient2d(points: list[tuple[int, int]]) -> list[int]:
    (ax, ay), (bx, by), (cx, cy) = points
    return [(ax - cx) * (by - cy), -(ay - cy) * (bx - cx)]


def terms_of_diametral(points: list[tuple[int, int]]) -> list[int]:
    """Thales: the angle at p."""
    (ax, ay), (bx, by), (px, py) = points
    return [-(ax - px) * (bx - px), -(ay - py) * (by - py)]


def cells(n: int) -> Iterator[list[tuple[int, int]]]:
    """Three or four points, the last one fixed off the origin."""
    side = range(-1, 2) if n == 4 else range(-2, 3)
    for values in product(side, repeat=2 * n - 2):
        yield [*zip(values[::2], values[1::2], strict=True), (1, -1)]


@pytest.mark.obligation(
    "K7", "a filter certifies exactly what exceeds its bound", method="enumeration", control_in="mutants"
)
class TestFilterBorder:
    """On small integers, where nothing rounds: the sign where |sum of terms| > bound * sum of |terms|, else 0.

    The bounds are such that both sides are often equal; a bound just below certifies those, too.
    """

    @pytest.mark.parametrize(
        ("certify", "terms", "n"),
        [
            (orient2d_filter, terms_of_orient2d, 3),
            (diametral_filter, terms_of_diametral, 3),
            (incircle_filter, terms_of_incircle, 4),
        ],
    )
    def test_border(
        self,
        certify: Filter,
        terms: Callable[[list[tuple[int, int]]], list[int]],
        n: int,
        record_property: Callable[[str, object], None],
    ) -> None:
        borders = cases = 0
        for points in cells(n):
            there = terms(points)
            det, permanent = sum(there), sum(map(abs, there))
            for bound in (0.0, 0.25, 0.5, 1.0):
                expected = sign(det) if abs(det) > bound * permanent else 0
                assert certify(bound, *np.ravel(points).astype(float).tolist()) == expected
                borders += det != 0 and abs(det) == bound * permanent
                cases += 1
        assert borders > 20
        record_property("cases", cases)


@pytest.mark.obligation("K6", "the grid stage is exact by itself", method="enumeration", control_in="mutants")
class TestGridAlone:
    """With bounds so blunt that the filters certify nothing, the grid stage decides all small integers, exactly; and
    where it does not know of the grid, incircle finds it, and the others do without."""

    @pytest.mark.parametrize(
        ("adaptive", "terms", "n", "row"),
        [
            (orient2d_adaptive, terms_of_orient2d, 3, 0),
            (diametral_adaptive, terms_of_diametral, 3, 0),
            (incircle_adaptive, terms_of_incircle, 4, 1),
        ],
    )
    @pytest.mark.parametrize(("is_known", "unit"), [(True, 1.0), (False, 1.0), (True, 2.0**-9)])
    def test_signs(
        self,
        adaptive: Adaptive,
        terms: Callable[[list[tuple[int, int]]], list[int]],
        n: int,
        row: int,
        is_known: bool,
        unit: float,
        record_property: Callable[[str, object], None],
    ) -> None:
        k = make_context(np.array([unit]))._replace(orient2d_bound=1e300, incircle_bound=1e300)
        if not is_known:
            k = k._replace(grid_limit=0.0)
        cases = 0
        for points in cells(n):
            assert adaptive(k, *(unit * np.ravel(points)).tolist()) == sign(sum(terms(points)))
            cases += 1
        assert (k.counts[row, ek.Stage.GRID] == k.counts.sum() == cases) == (is_known or n == 4)
        assert not k.counts[:, [ek.Stage.FILTER, ek.Stage.RATIONAL]].any()
        record_property("cases", cases)

    @pytest.mark.parametrize(
        ("adaptive", "n", "row"), [(orient2d_adaptive, 3, 0), (diametral_adaptive, 3, 0), (incircle_adaptive, 4, 1)]
    )
    def test_limit(self, adaptive: Adaptive, n: int, row: int) -> None:
        """Whichever difference is the largest: 4096 units are decided there, 4097 are not."""
        for i, s, size in product(range(2 * n - 2), (1.0, -1.0), (4096.0, 4097.0)):
            k = make_context(np.ones(1))._replace(orient2d_bound=1e300, incircle_bound=1e300)
            values = [1.0] * (2 * n - 2) + [0.0, 0.0]
            values[i] = s * size
            adaptive(k, *values)
            assert (k.counts[row, ek.Stage.GRID] == 1) == (size == 4096.0)


WINDOWS = [
    (ek.orient2d_staged, 3, MIN_COORDINATE_DEGREE_2, MAX_COORDINATE_DEGREE_2),
    (ek.diametral_staged, 3, MIN_COORDINATE_DEGREE_2, MAX_COORDINATE_DEGREE_2),
    (ek.incircle_staged, 4, MIN_COORDINATE_DEGREE_4, MAX_COORDINATE_DEGREE_4),
]


@pytest.mark.obligation(
    "K6", "one coordinate outside the window suffices for the rationals", method="enumeration", control_in="mutants"
)
class TestEveryCoordinateIsGuarded:
    """Whichever coordinate is one step outside: rational; no other, and not zero, ever is."""

    @pytest.mark.parametrize(("staged", "n", "smallest", "largest"), WINDOWS, ids=["orient2d", "diametral", "incircle"])
    def test_each(
        self, staged: Callable[..., tuple[ek.Sign, ek.Stage]], n: int, smallest: float, largest: float
    ) -> None:
        usual = [0.5, 0.25, 2.0, 0.125, 0.75, 3.0, 5.0, 7.0][: 2 * n]
        for i, s in product(range(2 * n), (1.0, -1.0)):
            for value in (smallest, largest, 0.0):
                inside = [*usual[:i], s * value, *usual[i + 1 :]]
                assert staged(*np.reshape(inside, (n, 2)))[1] != ek.Stage.RATIONAL
            for value in (math.nextafter(smallest, 0.0), math.nextafter(largest, math.inf)):
                outside = [*usual[:i], s * value, *usual[i + 1 :]]
                assert staged(*np.reshape(outside, (n, 2)))[1] == ek.Stage.RATIONAL


@pytest.mark.obligation(
    "K6", "a common grid is used exactly where there is one", method="enumeration", control_in="mutants"
)
class TestGridOfFour:
    """Without a context, the grid stage of incircle answers exactly what the filter does not, where all differences
    are doubles, and multiples of some unit of at least 1/4096 of the largest (rounded up to a power of two)."""

    HEADS = (0.0, 1.0, 2047.0, 0.25)

    @staticmethod
    def is_on_a_grid(points: list[tuple[float, float]]) -> bool:
        dx, dy = points[3]
        exact = [Fraction(v) - Fraction(d) for p in points[:3] for v, d in zip(p, (dx, dy), strict=True)]
        if any(Fraction(float(e)) != e for e in exact):
            return False
        largest = max(map(abs, exact))
        unit = Fraction(1)
        while unit * 4096 < largest:
            unit *= 2
        while unit * 2048 > largest > 0:
            unit /= 2
        return all((e / unit).denominator == 1 for e in exact)

    @pytest.mark.parametrize("d", [(0.0, 0.0), (2.0**-50, 0.0), (0.0, 2.0**-50), (2.0**-42, 2.0**-41)])
    def test_stage(self, d: Point, record_property: Callable[[str, object], None]) -> None:
        cases = 0
        for heads in product(self.HEADS if d == (0.0, 0.0) else self.HEADS[:3], repeat=6):
            points = [(heads[i] + d[0], heads[i + 1] + d[1]) for i in (0, 2, 4)] + [d]
            answer, stage = ek.incircle_staged(*points)
            if stage != ek.Stage.FILTER:
                assert (stage == ek.Stage.GRID) == self.is_on_a_grid(points)
                assert stage != ek.Stage.GRID or answer == sign(sum(map(Fraction, self.exact_terms(points))))
                cases += 1
        assert cases > 300
        record_property("cases", cases)

    @staticmethod
    def exact_terms(points: list[tuple[float, float]]) -> list[Fraction]:
        (dx, dy) = points[3]
        rows = [(Fraction(x) - Fraction(dx), Fraction(y) - Fraction(dy)) for x, y in points[:3]]
        lifted = [(x, y, x * x + y * y) for x, y in rows]
        return [oracle.parity(p) * lifted[0][p[0]] * lifted[1][p[1]] * lifted[2][p[2]] for p in permutations(range(3))]


@pytest.mark.obligation("K7", "a loop tallies every call, under the stage that decided it", method="named cases")
class TestTally:
    """One call, one more of one stage, in the predicate's own row; ties that are broken count as incircle."""

    @pytest.mark.parametrize(
        ("adaptive", "n", "row"),
        [
            (orient2d_adaptive, 3, 0),
            (diametral_adaptive, 3, 0),
            (incircle_adaptive, 4, 1),
            (incircle_perturbed_adaptive, 4, 1),
        ],
    )
    def test_every_call(self, adaptive: Adaptive, n: int, row: int) -> None:
        clear = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.25, 0.125)]
        even = (
            [(0.0, 0.0), (1.0, 1.0), (0.5, 0.5), (0.0, 1.0)]
            if n == 3
            else [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
        )
        if adaptive is diametral_adaptive:
            even = [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0)]
        k = make_context(np.array([1.0, 0.125]))
        expected = np.zeros((2, 5), dtype=np.int64)
        for points, stage, calls in ((clear, ek.Stage.FILTER, 3), (even, ek.Stage.GRID, 2)):
            for _ in range(calls):
                adaptive(k, *np.ravel(points[:n]).tolist())
            expected[row, stage] += calls
            broken = k.counts - expected  # the orientation that breaks a tie counts as orient2d
            assert broken[0, 0] == (calls if adaptive is incircle_perturbed_adaptive and stage else 0)
            broken[0, 0] = 0
            assert not broken.any()

    @pytest.mark.parametrize(("adaptive", "n", "row"), [(orient2d_adaptive, 3, 1), (incircle_adaptive, 4, 0)])
    def test_control_another_row(self, adaptive: Adaptive, n: int, row: int) -> None:
        """Calls that are looked for in the row of the other predicate."""
        with pytest.raises(AssertionError):
            self.test_every_call(adaptive, n, row)


@pytest.mark.obligation(
    "K5", "the expansions of incircle are exact, whatever the tails", method="named cases", control_in="mutants"
)
class TestLiftedTerm:
    """(a^2 + A^2) (b C - c B) of pairs of doubles, component by component summed in fractions; and the determinant."""

    def test_values(self, record_property: Callable[[str, object], None]) -> None:
        random = np.random.default_rng(7)
        h, scratch = np.zeros(512), np.zeros(SCRATCH_SIZE)
        term_of: Adaptive = lifted_term
        sign_of: Adaptive = incircle_expansion
        cases = 40
        for _ in range(cases):
            heads = random.integers(-9, 10, 6) * 2.0 ** random.integers(-3, 4, 6)
            tails = random.integers(-9, 10, 6) * 2.0 ** random.integers(-90, -60, 6)
            pairs = [float(x) for pair in zip(heads, tails, strict=True) for x in pair]
            a, A, b, B, c, C = (Fraction(x) + Fraction(t) for x, t in zip(pairs[::2], pairs[1::2], strict=True))
            n = term_of(*pairs, h, scratch)
            assert sum(map(Fraction, h[:n].tolist()), Fraction(0)) == (a * a + A * A) * (b * C - c * B)
            terms = [
                (a * a + A * A) * (b * C - c * B),
                (b * b + B * B) * (c * A - a * C),
                (c * c + C * C) * (a * B - b * A),
            ]
            assert sign_of(*pairs, scratch) == sign(sum(terms))
        record_property("cases", cases)
