"""K7: every predicate, in every form, equals its definition in fractions, for all finite doubles."""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
import pytest
from hypothesis import example, given
from proofs_tests.kernel import oracle
from proofs_tests.kernel.strategies import Point, point_tuples

import exactkernel as ek
from exactkernel.constants import INCIRCLE_BOUND, ORIENT2D_BOUND
from exactkernel.context import Context, guarded_context, make_context, scaled_into_window
from exactkernel.diametral import diametral_adaptive, diametral_filter
from exactkernel.incircle import incircle_adaptive, incircle_filter, incircle_perturbed_adaptive
from exactkernel.orient2d import orient2d_adaptive, orient2d_filter

U = 2.0**-53
#: The published filter answers +1 here; the exact sign is -1.
PUBLISHED_LIE = (
    (float.fromhex("0x1.0000000000003p-537"), float.fromhex("0x1.ffffffffffffep-540")),
    (float.fromhex("0x1.0000000000002p-536"), float.fromhex("0x1p-538")),
    (float.fromhex("0x1.a7ee0ae25e37ep-588"), float.fromhex("-0x1.60ad38a30e5f8p-591")),
)


def in_contexts(adaptive: Callable[..., int], points: tuple[Point, ...]) -> set[int]:
    """The answers of a compiled predicate: guarded, with the context of the points, and scaled into the window."""
    coordinates = np.array(points)
    scaled, scaled_context = scaled_into_window(coordinates)
    runs: list[tuple[Context, list[float]]] = [
        (guarded_context(), coordinates.ravel().tolist()),
        (make_context(coordinates), coordinates.ravel().tolist()),
        (scaled_context, scaled.ravel().tolist()),
    ]
    return {int(adaptive(context, *values)) for context, values in runs}


@pytest.mark.obligation(
    "K7",
    "orient2d, incircle, diametral, incircle_perturbed have the exact sign for all finite doubles",
    method="property-based",
)
class TestExactSigns:
    """Scalar, batch, and in a loop with any context: the sign is that of the determinant in fractions."""

    @given(point_tuples(3))
    @example(PUBLISHED_LIE)
    def test_orient2d(self, points: tuple[Point, ...]) -> None:
        exact = oracle.orient2d(*points)
        assert ek.orient2d(*points) == exact
        assert ek.orient2d_batch(*points).tolist() == [exact]
        assert in_contexts(orient2d_adaptive, points) == {exact}

    @given(point_tuples(3))
    def test_diametral(self, points: tuple[Point, ...]) -> None:
        exact = oracle.diametral(*points)
        assert ek.diametral(*points) == exact
        assert ek.diametral_batch(*points).tolist() == [exact]
        assert in_contexts(diametral_adaptive, points) == {exact}

    @given(point_tuples(4))
    def test_incircle(self, points: tuple[Point, ...]) -> None:
        exact = oracle.incircle(*points)
        assert ek.incircle(*points) == exact
        assert ek.incircle_batch(*points).tolist() == [exact]
        assert in_contexts(incircle_adaptive, points) == {exact}

    @given(point_tuples(4))
    def test_incircle_perturbed(self, points: tuple[Point, ...]) -> None:
        exact = oracle.incircle_perturbed(*points)
        assert ek.incircle_perturbed(*points) == exact
        assert in_contexts(incircle_perturbed_adaptive, points) == {exact}

    def test_control_the_published_filter_lies(self) -> None:
        """The published filter, without a guard against underflow."""
        assert oracle.orient2d(*PUBLISHED_LIE) == -1
        assert orient2d_filter(ORIENT2D_BOUND, *np.ravel(PUBLISHED_LIE).tolist()) == 1

    def test_control_an_unguarded_expansion_lies(self) -> None:
        """Expansions used outside of their window."""
        unguarded = guarded_context()._replace(orient2d_bound=np.finfo(float).max)
        tiny = ((5e-324, 0.0), (0.0, 5e-324), (0.0, 0.0))
        assert orient2d_adaptive(unguarded, *np.ravel(tiny).tolist()) == 0
        assert ek.orient2d(*tiny) == oracle.orient2d(*tiny) == 1

    def test_control_rounded_determinants_miss_what_the_stages_find(self) -> None:
        """The determinant in plain doubles."""
        p = ((1.0 + 2.0**-52, 1.0), (1.0, 1.0 - 2.0**-52), (0.0, 0.0))
        (ax, ay), (bx, by), _ = p
        assert ax * by - ay * bx == 0.0
        assert ek.orient2d(*p) == oracle.orient2d(*p) == -1


F, G, D, E, R = ek.Stage.FILTER, ek.Stage.GRID, ek.Stage.DOUBLE_DOUBLE, ek.Stage.EXPANSION, ek.Stage.RATIONAL
Case: TypeAlias = tuple[Callable[..., tuple[ek.Sign, ek.Stage]], Callable[..., int], ek.Stage, tuple[Point, ...]]
STAGED: list[Case] = [
    (ek.orient2d_staged, oracle.orient2d, F, ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))),
    (ek.orient2d_staged, oracle.orient2d, D, ((0.1, 0.1), (0.2, 0.2), (0.3, 0.30000000000000004))),
    (ek.orient2d_staged, oracle.orient2d, E, ((0.1, 0.1), (0.2, 0.2), (0.3, 0.3))),
    (ek.orient2d_staged, oracle.orient2d, E, ((1.0 + 2 * U, 1.0), (1.0, 1.0 - 2 * U), (0.0, 0.0))),
    (ek.orient2d_staged, oracle.orient2d, R, PUBLISHED_LIE),
    (ek.orient2d_staged, oracle.orient2d, R, ((-1.7e308, -1.7e308), (1.7e308, 1.7e308), (0.0, 1.0))),
    (ek.diametral_staged, oracle.diametral, F, ((-1.0, 0.0), (1.0, 0.0), (0.0, 0.5))),
    (ek.diametral_staged, oracle.diametral, D, ((-1.0, 0.0), (1.0, 0.0), (0.0, 1.0 + 2 * U))),
    (ek.diametral_staged, oracle.diametral, E, ((-1.0, 0.0), (1.0, 0.0), (0.0, 1.0))),
    (ek.diametral_staged, oracle.diametral, E, ((-1.0, 0.0), (1.0, 0.0), (U, 1.0))),
    (ek.diametral_staged, oracle.diametral, R, ((-1e-200, 0.0), (1e-200, 0.0), (0.0, 1e-200))),
    (ek.incircle_staged, oracle.incircle, F, ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, 0.0))),
    (ek.incircle_staged, oracle.incircle, D, ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0 - 2 * U))),
    (ek.incircle_staged, oracle.incircle, G, ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))),
    (ek.incircle_staged, oracle.incircle, E, ((0.1, 0.2), (0.7, 0.2), (0.7, 0.9), (0.1, 0.9))),
    (ek.incircle_staged, oracle.incircle, E, ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (U, -1.0))),
    (ek.incircle_staged, oracle.incircle, R, ((1e-200, 0.0), (0.0, 1e200), (-1.0, 0.0), (0.0, -1.0))),
]


@pytest.mark.obligation(
    "K7", "the stage that decides is pinned, for each stage of each predicate", method="named cases"
)
class TestStages:
    """Each stage decides the inputs that it is there for, and the one before it did not; the sign is exact."""

    @pytest.mark.parametrize(("staged", "exact", "stage", "points"), STAGED)
    def test_pinned(
        self,
        staged: Callable[..., tuple[ek.Sign, ek.Stage]],
        exact: Callable[..., int],
        stage: ek.Stage,
        points: tuple[Point, ...],
    ) -> None:
        assert staged(*points) == (exact(*points), stage)

    @pytest.mark.parametrize(
        ("adaptive", "row", "points"),
        [
            (orient2d_adaptive, 0, ((0.0, 0.0), (1.0, 1.0), (2.0, 2.0))),
            (diametral_adaptive, 0, ((0.0, 0.0), (2.0, 0.0), (1.0, 1.0))),
            (incircle_adaptive, 1, ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))),
        ],
    )
    def test_grids_end_at_the_grid_stage(
        self, adaptive: Callable[..., int], row: int, points: tuple[Point, ...]
    ) -> None:
        for scale in (1.0, 0.125, 2.0**-200, 2.0**200):
            coordinates = np.array(points) * scale
            context = make_context(coordinates)
            assert adaptive(context, *coordinates.ravel().tolist()) == 0
            assert context.counts[row].tolist() == [0, 1, 0, 0, 0]

    @pytest.mark.parametrize(("staged", "exact", "stage", "points"), STAGED)
    def test_the_tally_of_a_loop_names_the_same_stage(
        self,
        staged: Callable[..., tuple[ek.Sign, ek.Stage]],
        exact: Callable[..., int],
        stage: ek.Stage,
        points: tuple[Point, ...],
    ) -> None:
        adaptives: dict[Callable[..., object], Callable[..., int]] = {
            ek.orient2d_staged: orient2d_adaptive,
            ek.diametral_staged: diametral_adaptive,
            ek.incircle_staged: incircle_adaptive,
        }
        context = guarded_context()
        assert adaptives[staged](context, *np.ravel(points).tolist()) == exact(*points)
        assert context.counts.sum(axis=0)[stage] == context.counts.sum() == 1

    def test_control_the_filter_leaves_what_later_stages_decide(self) -> None:
        """The filter alone: it leaves open what it is not pinned for."""
        filters: dict[Callable[..., object], tuple[Callable[..., int], float]] = {
            ek.orient2d_staged: (orient2d_filter, ORIENT2D_BOUND),
            ek.diametral_staged: (diametral_filter, ORIENT2D_BOUND),
            ek.incircle_staged: (incircle_filter, INCIRCLE_BOUND),
        }
        for staged, exact, stage, points in STAGED:
            if stage is not R:
                filter_, bound = filters[staged]
                assert filter_(bound, *np.ravel(points).tolist()) == (exact(*points) if stage is F else 0)
