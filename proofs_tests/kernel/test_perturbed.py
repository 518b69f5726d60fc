"""K9: the perturbed incircle, from its definition: small integers, every order, coincident points, rationals."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import combinations_with_replacement, permutations

import numpy as np
import pytest
from proofs_tests.kernel import oracle

import exactkernel as ek
from exactkernel.context import Context, guarded_context, make_context
from exactkernel.incircle import incircle_perturbed_adaptive

Cell = tuple[int, int]

CELLS = [(0, 0), (1, 0), (0, 1), (1, 1), (2, 1), (1, 2), (2, 0)]
LINE = [(i, 2 * i) for i in range(4)]


def fours() -> list[tuple[Cell, ...]]:
    """Four points of seven of a square or of a line of four, coincident ones as well."""
    return [*combinations_with_replacement(CELLS, 4), *combinations_with_replacement(LINE, 4)]


def compiled(points: Sequence[Cell], k: Context) -> int:
    return int(incircle_perturbed_adaptive(k, *np.ravel(points).astype(float).tolist()))


@pytest.mark.obligation(
    "K9", "perturbed incircle has the sign of its definition", method="enumeration", control_in="mutants"
)
class TestDefinition:
    """Every four of seven points of a square, in every order: the sign is that of the lifted determinant, which changes
    with the parity of the order; zero where the smallest point or any other occurs twice, or all lie on a line."""

    def test_every_order(self, record_property: Callable[[str, object], None]) -> None:
        cases = ties = 0
        guarded, open_ = guarded_context(), make_context(np.arange(4.0))
        for points in fours():
            sign = oracle.incircle_perturbed(*points)
            ties += sign != 0 and oracle.incircle(*points) == 0
            for order in permutations(range(4)):
                there = [points[i] for i in order]
                expected = sign * oracle.parity(order)
                assert compiled(there, open_) == expected
                cases += 1
            assert compiled(points, guarded) == sign
        assert ties > 3
        record_property("cases", cases)

    def test_rationals(self, record_property: Callable[[str, object], None]) -> None:
        """A third of every coordinate is no double, and changes no sign."""
        cases = 0
        for points in fours()[::3]:
            sign = oracle.incircle_perturbed(*points)
            for order in list(permutations(range(4)))[::5]:
                there = [(Fraction(x, 3), Fraction(y + 1, 3)) for x, y in (points[i] for i in order)]
                assert ek.incircle_perturbed(*there) == sign * oracle.parity(order)
                assert ek.incircle(*there) in (0, sign * oracle.parity(order))
                cases += 1
        record_property("cases", cases)
