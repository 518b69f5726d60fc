"""The order of insertion: a permutation for any doubles, along a curve whose steps are short."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from proofs_tests.kernel.strategies import Point
from proofs_tests.mesh.strategies import point_sets

from exactkernel.jit import COMPILED
from exactkernel.types import FloatArray
from exactmesh.errors import SeedError
from exactmesh.ordering import (
    _FIRST_ROUND,
    _ROUND_BITS,
    IndexArray,
    _deep_table,
    _hilbert_table,
    _rounds,
    insertion_order,
)


def curve(table: list[int], levels: int, state: int) -> list[tuple[int, int]]:
    """Return the cells of a square of 2^levels a side in the order of their positions."""
    side = 1 << levels
    cells = {table[state << 2 * levels | x << levels | y] >> 2: (x, y) for x in range(side) for y in range(side)}
    return [cells[position] for position in range(side * side)]


def is_a_curve(cells: list[tuple[int, int]]) -> bool:
    """Each cell once, each next to the one before."""
    steps = [abs(a - c) + abs(b - d) for (a, b), (c, d) in pairwise(cells)]
    return len(set(cells)) == len(cells) and set(steps) == {1}


class TestHilbert:
    """In each of its four ways the curve visits every cell once and steps to a neighbor each time, at any depth; each
    way begins and ends in its own corners of one side."""

    @pytest.mark.parametrize("levels", [1, 2, 3, 4])
    def test_steps(self, levels: int) -> None:
        table = _deep_table(levels).tolist()
        ways = [curve(table, levels, state) for state in range(4)]
        assert all(is_a_curve(way) for way in ways)
        last = (1 << levels) - 1
        assert [(way[0], way[-1]) for way in ways] == [
            ((0, 0), (last, 0)),
            ((0, 0), (0, last)),
            ((last, last), (last, 0)),
            ((last, last), (0, last)),
        ]

    def test_depth_is_iteration(self) -> None:
        """A level at a time gives the same position and the same way on."""
        one, deep = _hilbert_table().tolist(), _deep_table(3).tolist()
        for index, found in enumerate(deep):
            state, position = index >> 6, 0
            for level in (2, 1, 0):
                step = one[state][(index >> 3 >> level & 1) << 1 | index >> level & 1]
                position, state = position << 2 | step >> 2, step & 3
            assert found == position << 2 | state

    def test_control_another_table_is_no_curve(self) -> None:
        table = _deep_table(2)
        table[[3, 9]] = table[[9, 3]]
        assert not is_a_curve(curve(table.tolist(), 2, 0))


def is_permutation(order: IndexArray, n: int) -> bool:
    return sorted(order.tolist()) == list(range(n))


HARD = {
    "one place": np.ones((3000, 2)),
    "two places": np.repeat([[0.0, 0.0], [1e-300, 1e300]], 1500, axis=0),
    "nested clusters": 2.0 ** -np.arange(2000.0)[:, None] * np.array([1.0, 1.0]),
    "every scale": np.ldexp(1.0, np.repeat(np.arange(-1074, 1024), 2)).reshape(-1, 2),
    "largest": np.array([[-1.7976931348623157e308, 0.0], [1.7976931348623157e308, 1.0]] * 100),
    "subnormal": np.arange(200.0).reshape(-1, 2) * 5e-324,
    "vertical": np.stack([np.zeros(5000), np.arange(5000.0)], axis=1),
    "last bits": 1.0 + np.arange(4000.0).reshape(-1, 2) * 2.0**-52,
}


@pytest.mark.bounds
class TestPermutation:
    """Each point comes once, however the points lie and whatever the seed; the recursion into clusters ends."""

    @given(point_sets(), st.integers(0, 2**80))
    def test_any_points(self, points: list[Point], seed: int) -> None:
        assert is_permutation(insertion_order(np.array(points), seed), len(points))

    @pytest.mark.parametrize("points", HARD.values(), ids=HARD.keys())
    def test_hard_points(self, points: FloatArray) -> None:
        assert is_permutation(insertion_order(points, 0), len(points))

    def test_control_repetition_is_noticed(self) -> None:
        assert not is_permutation(np.array([0, 1, 1]), 3)

    def test_no_points(self) -> None:
        with pytest.raises((IndexError, ValueError)):
            insertion_order(np.empty((0, 2)), 0)


class TestRounds:
    """Of n points the last round holds all but a fixed share, the one before all but that share of the rest, down to
    about as few as the first shall have; the same seed gives the same rounds, another seed others."""

    def test_sizes(self) -> None:
        n, share = 1 << 20, 2.0**-_ROUND_BITS
        sizes = np.bincount(_rounds(n, 0)).tolist()[::-1]
        left = float(n)
        for size in sizes[:-1]:
            assert abs(size - left * (1.0 - share)) < 6 * left**0.5
            left *= share
        assert abs(sizes[-1] - left) < 6 * left**0.5
        assert _FIRST_ROUND <= left < _FIRST_ROUND / share
        assert set(_rounds(_FIRST_ROUND, 0).tolist()) == {0}

    def test_seeds(self) -> None:
        assert (_rounds(100_000, 5) == _rounds(100_000, 5)).all()
        assert (_rounds(100_000, 5) != _rounds(100_000, 6)).any()

    @pytest.mark.parametrize("seed", [-1, 0.5, None, "1", (1, 2)])
    def test_bad_seeds(self, seed: int) -> None:
        with pytest.raises(SeedError, match="seed="):
            insertion_order(np.zeros((3, 2)), seed)


class TestLocality:
    """Points that follow each other in a round lie near each other: the tour through n uniform points has a length of
    O(sqrt n). A random order does not pass."""

    @staticmethod
    def tour(points: FloatArray, order: IndexArray) -> float:
        return float(np.hypot(*np.diff(points[order], axis=0).T).sum())

    def test_tour(self) -> None:
        n = 4000 if COMPILED else 1000
        points = np.random.default_rng(0).random((n, 2))
        assert self.tour(points, insertion_order(points, 0)) < 1.5 * n**0.5
        assert self.tour(points, np.random.default_rng(1).permutation(n)) > 3 * n**0.5

    def test_clusters_have_curves_of_their_own(self) -> None:
        """All but one in a box of 1e-9: the tour inside is short in units of the box."""
        n = 2000
        points = np.random.default_rng(0).random((n, 2)) * 1e-9
        far = np.concatenate([points, [[1.0, 1.0]]])
        order = insertion_order(far, 0)
        assert self.tour(far, order[order < n]) < 2 * n**0.5 * 1e-9
