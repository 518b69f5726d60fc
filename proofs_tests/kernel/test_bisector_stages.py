"""K7: the stages of the predicates about bisectors: each decides all that its bound allows, and nothing else."""

import importlib
import random
from collections.abc import Callable

import numpy as np
import pytest
from proofs_tests.kernel.interpreted import Workspace, calls_of, interpreted, watched_expansions
from proofs_tests.rounding.magnitudes import Magnitude, difference, inner

from exactkernel import bisector
from exactkernel.constants import DD_BOUND, INCIRCLE_BOUND, ORIENT2D_BOUND
from exactkernel.context import SCRATCH_SIZE, Context, guarded_context, make_context

Points = list[tuple[float, float]]

orient2d = importlib.import_module("exactkernel.orient2d")  # the package has a function of this name
FILTER, DOUBLE_DOUBLE, EXPANSION, RATIONAL = range(4)


def nearer(p: tuple[float, float], q: tuple[float, float], x: tuple[float, float]) -> Magnitude:
    to_p, to_q = difference(x, p), difference(x, q)
    return inner(to_p, to_p) - inner(to_q, to_q)


def along(p: tuple[float, float], q: tuple[float, float], a: tuple[float, float], b: tuple[float, float]) -> Magnitude:
    return inner(difference(q, p), difference(b, a))


def numerator(s: tuple[float, float], p: tuple[float, float], a: tuple[float, float]) -> Magnitude:
    """|p - a|^2 - |s - a|^2 in terms of w = p - s: 2 w (s - a) + w^2."""
    w, c = difference(p, s), difference(s, a)
    return inner(w, c) + inner(w, c) + inner(w, w)


def crossing_order(
    s: tuple[float, float], p: tuple[float, float], q: tuple[float, float], a: tuple[float, float],
    b: tuple[float, float],
) -> Magnitude:  # fmt: skip
    d = difference(b, a)
    return numerator(s, p, a) * inner(difference(q, s), d) - numerator(s, q, a) * inner(difference(p, s), d)


CASES: dict[str, tuple[Callable[..., Magnitude], Callable[..., int], int, float]] = {
    "nearer": (nearer, bisector.nearer_adaptive, 3, bisector._NEARER_BOUND),
    "along": (along, bisector.along_adaptive, 4, ORIENT2D_BOUND),
    "crossing order": (crossing_order, bisector.crossing_order_adaptive, 5, INCIRCLE_BOUND),
}


class Stages:
    """What each call did, seen by the functions that it called."""

    def __init__(self, patch: pytest.MonkeyPatch) -> None:
        asked = [name for name in vars(bisector) if name.endswith("_from_doubles")]
        self.seen = calls_of(patch, bisector, "two_diff", "determinant_2x2", *asked)
        self.inner = calls_of(patch, orient2d, "determinant_2x2")

    def decided(self, adaptive: Callable[..., int], k: Context, points: Points) -> tuple[int, int]:
        self.seen.clear()
        self.inner.clear()
        sign = adaptive(k, *(x for point in points for x in point))
        if any(name.endswith("_from_doubles") for name in self.seen):
            return sign, RATIONAL
        if "determinant_2x2" in self.seen + self.inner:
            return sign, EXPANSION
        return sign, DOUBLE_DOUBLE if "two_diff" in self.seen else FILTER


def small(draw: random.Random, n: int) -> Points:
    """Points of which everything is computed exactly, many of them on common lines and circles."""
    return [(float(draw.randint(-3, 3)), float(draw.randint(-3, 3))) for _ in range(n)]


def tiny(draw: random.Random) -> float:
    return draw.choice((-1, 1)) * draw.uniform(1.0, 2.0) * 2.0 ** -draw.randint(20, 130)


def near_ties(name: str, draw: random.Random) -> Points:
    """Points off a tie by 2^-20 to 2^-130, which differences have in their tails."""
    x, y, r, t = (draw.uniform(1.0, 2.0) for _ in range(4))
    deltas = [tiny(draw) for _ in range(4)]
    if name == "nearer":
        return [(x, y), (y, x), (deltas[0], deltas[1])]
    if name == "along":
        return [(deltas[0], deltas[1]), (x, y), (deltas[2], deltas[3]), (-y, x)]
    sites = [(r, deltas[0]), (deltas[1], r), (-r, deltas[2])]
    return [*sites, (-x, -y), (x * 2.0 ** t_exponent(t), y * 2.0 ** t_exponent(t))]


def t_exponent(t: float) -> int:
    return int((t - 1.5) * 8)


@interpreted
@pytest.mark.obligation(
    "K7", "each stage about bisectors decides what its bound allows, and no more", method="named cases"
)
class TestStages:
    """A value beyond a stage's bound times its permanent is decided there; one within it is left to the next.

    With bounds so large that small integers meet them, and everything exact, the border is met exactly.
    """

    @pytest.mark.parametrize("name", CASES)
    def test_borders(self, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
        exact, adaptive, n, _ = CASES[name]
        for constant in ("_NEARER_BOUND", "ORIENT2D_BOUND", "INCIRCLE_BOUND"):
            monkeypatch.setattr(bisector, constant, 2.0**-2)
        for module in (bisector, orient2d):
            monkeypatch.setattr(module, "DD_BOUND", 2.0**-4)
        stages, k, draw, met = Stages(monkeypatch), make_context(np.ones(1)), random.Random(1), set()
        for _ in range(500):
            points = small(draw, n)
            det = exact(*points)
            wanted = FILTER if det.exceeds(2.0**-2) else DOUBLE_DOUBLE if det.exceeds(2.0**-4) else EXPANSION
            assert stages.decided(adaptive, k, points) == (det.sign, wanted), points
            assert stages.decided(adaptive, guarded_context(), points) == (det.sign, RATIONAL)
            met.add((wanted, det.sign, det.exceeds(0) and not det.exceeds(2.0**-2 - 2.0**-40)))
        assert {(stage, sign) for stage, sign, _ in met} >= {(s, i) for s in range(2) for i in (-1, 1)} | {(2, 0)}

    @pytest.mark.parametrize("name", CASES)
    def test_near_ties(self, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
        """With the published bounds: the sign is right, and decided no later than twice the bound of a stage asks."""
        exact, adaptive, _, bound = CASES[name]
        stages, k, draw, met = Stages(monkeypatch), make_context(np.ones(1)), random.Random(2), set()
        for _ in range(300):
            points = near_ties(name, draw)
            det = exact(*points)
            sign, stage = stages.decided(adaptive, k, points)
            assert sign == det.sign, points
            latest = FILTER if det.exceeds(2 * bound) else DOUBLE_DOUBLE if det.exceeds(2 * DD_BOUND) else EXPANSION
            assert stage <= latest, points
            met.add((sign, stage))
        assert met == {(sign, stage) for sign in (-1, 1) for stage in range(3)}

    def test_control_a_laxer_or_a_stricter_border_is_noticed(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Borders that are half and twice the filter's own."""
        monkeypatch.setattr(bisector, "_NEARER_BOUND", 2.0**-3)
        stages, k, draw = Stages(monkeypatch), make_context(np.ones(1)), random.Random(1)
        for border in (2.0**-2, 2.0**-4):
            wrong = 0
            for _ in range(200):
                points = small(draw, 3)
                wrong += (stages.decided(bisector.nearer_adaptive, k, points)[1] == FILTER) != nearer(*points).exceeds(
                    border
                )
            assert wrong > 0


@interpreted
@pytest.mark.obligation(
    "K5", "the workspaces of the predicates about bisectors hold the longest expansions", method="calculus"
)
class TestWorkspaces:
    """Whatever the input: an expansion has room for the longest that its operands allow, and no two overlap."""

    @pytest.mark.parametrize("name", CASES)
    def test_room(self, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
        exact, adaptive, n, _ = CASES[name]
        watched_expansions(monkeypatch, bisector)
        k = make_context(np.ones(1))._replace(scratch=Workspace.of(SCRATCH_SIZE))
        points = [(0.1, 0.3)] * n
        assert adaptive(k, *(x for point in points for x in point)) == exact(*points).sign == 0

    def test_control_parts_that_overlap_are_noticed(self) -> None:
        """A layout whose parts share a double, and one beyond the end."""
        whole = Workspace.of(8)
        assert len(whole[0:4]) == len(whole[4:]) == 4
        with pytest.raises(AssertionError, match="overlaps"):
            whole[3:5]
        with pytest.raises(AssertionError, match="of 8"):
            whole[8:9]
