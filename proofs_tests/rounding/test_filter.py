"""K1, K3, K4: the constants of the filters, by calculus and over every input of a tiny format."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import z3
from proofs_tests.rounding.calculus import LATER, Bounded, Decision, Recorder, U, context, decisions, largest_needed
from proofs_tests.rounding.minifloat import Arithmetic, Backend, Floats, MiniFloat, all_numbers, derive

from exactkernel.angle import angle_filter, beyond
from exactkernel.bisector import _NEARER_BOUND, along_adaptive, crossing_order_adaptive, nearer_adaptive
from exactkernel.constants import INCIRCLE_BOUND, ORIENT2D_BOUND, SHAPE_FACTOR, UNIT_ROUNDOFF
from exactkernel.diametral import diametral_filter
from exactkernel.incircle import determinant_and_permanent, incircle_filter
from exactkernel.measure import area_filter, length_filter
from exactkernel.orient2d import orient2d_filter
from exactmesh.crossings.chain_distance import beside
from exactmesh.verify.bottleneck import is_ahead
from exactmesh.verify.centres import _FACTOR, centre_side

Record = Callable[[str, object], None]
Arguments = Callable[[Recorder], list[object]]


def points(names: str) -> Callable[[Recorder], list[object]]:
    return lambda r: [coordinate for name in names for coordinate in r.pair(name)]


def after_bound(constant: float, names: str) -> Arguments:
    return lambda r: [r.bound(constant), *points(names)(r)]


def after_context(names: str) -> Arguments:
    return lambda r: [context(r, ORIENT2D_BOUND, INCIRCLE_BOUND), *points(names)(r)]


def of_sides(constant: float, *, sides: int) -> Arguments:
    """A bound on a shape, and sides that are differences."""

    def arguments(r: Recorder) -> list[object]:
        (ax, ay), *others = r.pair("a"), r.pair("b"), r.pair("c")
        return [r.bound(constant), r.given("limit"), *(p - q for x, y in others[:sides] for p, q in ((x, ax), (y, ay)))]

    return arguments


def of_segment(r: Recorder) -> list[object]:
    ends = SegmentEnds([*r.pair("a"), *r.pair("b")])
    return [ends, 0, *r.pair("p")]


class SegmentEnds(list[object]):
    """An array of one row."""

    def __getitem__(self, at: Any) -> Any:
        return list.__getitem__(self, at[1])


def of_line(r: Recorder) -> list[object]:
    return [context(r, ORIENT2D_BOUND, INCIRCLE_BOUND), [*r.pair("a"), *r.pair("b")], *r.pair("v"), *r.pair("w")]


SHAPE_BOUND = SHAPE_FACTOR * ORIENT2D_BOUND
ORIENT, CIRCLE = {"ORIENT2D_BOUND": ORIENT2D_BOUND}, {"INCIRCLE_BOUND": INCIRCLE_BOUND}

#: The source, its constants, its arguments, and how many decisions there are in it.
DECISIONS: dict[str, tuple[list[Arithmetic], dict[str, float], Arguments, int]] = {
    "orient2d": ([orient2d_filter], {}, after_bound(ORIENT2D_BOUND, "abc"), 2),
    "diametral": ([diametral_filter], {}, after_bound(ORIENT2D_BOUND, "abp"), 2),
    "incircle": ([determinant_and_permanent, incircle_filter], {}, after_bound(INCIRCLE_BOUND, "abcd"), 2),
    "nearer": ([nearer_adaptive], {"_NEARER_BOUND": _NEARER_BOUND}, after_context("pqx"), 2),
    "along": ([along_adaptive], ORIENT, after_context("pqab"), 2),
    "crossing order": ([crossing_order_adaptive], CIRCLE, after_context("spqab"), 2),
    "area": ([beyond, area_filter], {}, of_sides(SHAPE_BOUND, sides=2), 2),
    "length": ([beyond, length_filter], {}, of_sides(SHAPE_BOUND, sides=1), 2),
    "centre side": ([centre_side], {"_FACTOR": _FACTOR}, after_context("pqabc"), 2),
    "is ahead": ([is_ahead], ORIENT, of_line, 2),
    "beside": ([beside], {"UNIT_ROUNDOFF": UNIT_ROUNDOFF}, of_segment, 1),
}


def found(name: str) -> list[Decision]:
    source, constants, arguments, _ = DECISIONS[name]
    return decisions(source, constants, arguments)


@pytest.mark.obligation("K1", "the filter constants are sound for u = 2^-53, by exact calculus", method="calculus")
class TestConstants:
    """In each filter, run over its source: what the bound is multiplied by is the permanent of what is compared with
    it, operation by operation; and the calculus of rounding errors asks for no more than the constant."""

    @pytest.mark.parametrize("name", DECISIONS)
    def test_every_decision(self, name: str, record_property: Record) -> None:
        noted = found(name)
        record_property("cases", len(noted))
        assert len(noted) == DECISIONS[name][-1]
        for decision in noted:
            assert decision.is_permanent
            assert 0 < decision.needed <= decision.shipped

    @staticmethod
    def needed_for_angles() -> Fraction:
        product = Bounded(U) * Bounded(U)
        trigonometric = Bounded(U * (1 + U))  # a pair's head, nearest to a value 2^-1000 from the cosine
        return largest_needed(((product + product) * trigonometric).e)

    def test_angle(self) -> None:
        """The filter of angles takes products: cross and dot are sums of two, sine and cosine err by u."""
        recorder = Recorder()
        assert self.needed_for_angles() <= Fraction(SHAPE_BOUND)
        (ax, ay), (bx, by), (cx, cy) = recorder.pair("a"), recorder.pair("b"), recorder.pair("c")
        ux, uy, vx, vy = bx - ax, by - ay, cx - ax, cy - ay
        sums = (ux * vy - uy * vx, abs(ux * vy) + abs(uy * vx), ux * vx + uy * vy, abs(ux * vx) + abs(uy * vy))
        angle = SimpleNamespace(sine=abs(recorder.given("sine")), cosine=recorder.given("cosine"))
        derived = derive([beyond, angle_filter], MiniFloat(53, constants=LATER), Backend.PYTHON)["angle_filter"]
        derived(recorder.bound(SHAPE_BOUND), angle, *sums)
        assert [decision.is_permanent for decision in recorder.found] == [True, True]

    def test_control_smaller_constants_are_refused(self) -> None:
        """(3 + 11 u) u, (10 + 74 u) u, and (4 + 13 u) u, and half of the bound of angles: below what is asked for."""
        assert self.needed_for_angles() > Fraction(SHAPE_BOUND) / 2
        assert found("orient2d")[0].needed > (3 + 11 * U) * U
        assert found("incircle")[0].needed > (10 + 74 * U) * U
        assert found("nearer")[0].needed > (4 + 13 * U) * U

    @pytest.mark.parametrize(
        ("function", "edit"),
        [
            ("determinant_and_permanent", ("(abs(bC) + abs(cB)) * lift_a", "(abs(bC) + abs(aC)) * lift_a")),
            ("determinant_and_permanent", (" + (abs(aB) + abs(bA)) * lift_c", "")),
            ("determinant_and_permanent", ("abs(cA) + abs(aC)", "abs(cA)")),
        ],
    )
    def test_control_another_permanent_is_refused(self, function: str, edit: tuple[str, str]) -> None:
        """A permanent that is not that of the determinant, by one term."""
        recorder = Recorder()
        mini = MiniFloat(53, constants=LATER, edits={function: edit})
        source: list[Arithmetic] = [determinant_and_permanent, incircle_filter]
        derive(source, mini, Backend.PYTHON)["incircle_filter"](*after_bound(INCIRCLE_BOUND, "abcd")(recorder))
        assert recorder.found
        assert not any(decision.is_permanent for decision in recorder.found)

    @pytest.mark.parametrize(
        ("function", "edit"),
        [
            ("determinant_and_permanent", ("(abs(bC) + abs(cB)) * lift_a", "abs((bC - cB) * lift_a)")),
            ("determinant_and_permanent", ("(abs(bC) + abs(cB)) * lift_a", "((bC - cB) * (bC - cB)) * lift_a")),
            ("incircle_filter", ("bound * permanent", "bound * abs(det)")),
        ],
    )
    def test_control_a_permanent_with_cancellation_is_refused(self, function: str, edit: tuple[str, str]) -> None:
        """The magnitude, or the square, of a difference in the place of its permanent."""
        mini = MiniFloat(53, constants=LATER, edits={function: edit})
        recorder = Recorder()
        decide = derive([determinant_and_permanent, incircle_filter], mini, Backend.PYTHON)["incircle_filter"]
        try:
            decide(*after_bound(INCIRCLE_BOUND, "abcd")(recorder))
        except AssertionError:
            return
        assert not any(decision.is_permanent for decision in recorder.found)


def is_implied(hypotheses: Sequence[Any], conclusion: Any) -> bool:
    """z3 finds no reals that satisfy the hypotheses and not the conclusion."""
    solver = z3.Tactic("qfnra-nlsat").solver()
    solver.add(*hypotheses, z3.Not(conclusion))
    answer = solver.check()
    assert answer != z3.unknown
    return bool(answer == z3.unsat)


def within(x: Any, bound: Any) -> Any:
    return z3.And(x <= bound, -x <= bound)


@pytest.mark.obligation("K1", "the rules of the calculus are theorems about rounding to nearest", method="symbolic")
class TestRules:
    """For all reals with |exact - computed| <= e P: the rules for sums, products, decisions. Of rounding they use that
    |fl(x) - x| <= u |fl(x)| and <= u |x|, that fl is monotone (so |fl(a b)| <= fl(P Q)), nothing else."""

    def test_sum(self) -> None:
        a, exact_a, pa, b, exact_b, pb, x, p, e, u = z3.Reals("a A pa b B pb x p e u")
        given = [u > 0, e >= 0, pa >= 0, pb >= 0, within(a - exact_a, e * pa), within(b - exact_b, e * pb)]
        rounded = [within(x - (a + b), u * p), pa + pb <= p * (1 + u)]
        assert is_implied([*given, *rounded], within(x - (exact_a + exact_b), (e * (1 + u) + u) * p))

    def test_product(self) -> None:
        a, da, pa, ea, b, db, pb, eb = z3.Reals("a da pa ea b db pb eb")
        given = [
            pa >= 0,
            pb >= 0,
            ea >= 0,
            eb >= 0,
            within(a, pa),
            within(b, pb),
            within(da, ea * pa),
            within(db, eb * pb),
        ]
        for sign in (1, -1):
            assert is_implied(given, sign * ((a + da) * (b + db) - a * b) <= (ea + eb + ea * eb) * pa * pb)
        u, e, q, r, m, p = z3.Reals("u e q r m p")  # q: that difference, r: the rounding, m = pa pb, p: its rounding
        given = [u > 0, e >= 0, m >= 0, within(q, e * m), within(r, u * p), m <= p * (1 + u)]
        assert is_implied(given, within(q + r, (e * (1 + u) + u) * p))

    def decision(self, factor: Any, u: Any) -> bool:
        """det > error certifies that the exact sum is positive, if the constant is at least ``factor`` times e."""
        s, exact, m, p, det, error, e = z3.Reals("s exact m p det error e")
        given = [u > 0, u < z3.Q(1, 2), e > 0, m > 0, within(s - exact, e * m), s > 0, det <= s * (1 + u)]
        rounded = [m <= p * (1 + u), error >= factor * e * p * (1 - u), det > error]
        return is_implied([*given, *rounded], exact > 0)

    def test_decision(self) -> None:
        u = z3.Real("u")
        assert self.decision((1 + u) * (1 + u) / (1 - u), u)

    def test_control_a_rule_without_its_rounding_is_refuted(self) -> None:
        """The rule for sums without u; a decision with the constant e and nothing more."""
        a, exact_a, pa, b, exact_b, pb, x, p, e, u = z3.Reals("a A pa b B pb x p e u")
        given = [u > 0, e >= 0, pa >= 0, pb >= 0, within(a - exact_a, e * pa), within(b - exact_b, e * pb)]
        rounded = [within(x - (a + b), u * p), pa + pb <= p * (1 + u)]
        assert not is_implied([*given, *rounded], within(x - (exact_a + exact_b), e * (1 + u) * p))
        assert not self.decision(z3.Q(1, 1), z3.Q(1, 8))


def axis_triples(precision: int, binades: int, quantum: float) -> tuple[Floats, Floats]:
    """All (a, b, c) on one axis, one for each value of the exact and the rounded differences, up to a common sign."""
    values = all_numbers(precision, range(binades))
    a, b, c = (v.ravel() for v in np.meshgrid(values, values, values, indexing="ij"))
    difference = derive([minus], MiniFloat(precision, quantum), Backend.ARRAYS)["minus"]
    keys = np.stack([a - c, b - c, difference(a, c), difference(b, c)])
    keys = keys[:, (keys[0] > 0) | ((keys[0] == 0) & (keys[1] >= 0))]
    kept = (a - c > 0) | ((a - c == 0) & (b - c >= 0))
    _, first = np.unique(keys, axis=1, return_index=True)
    return np.stack([a[kept][first], b[kept][first], c[kept][first]]), keys[:2, first]


def minus(a: float, b: float) -> float:
    return a - b


def lies(name: str, mini: MiniFloat, bound: float, binades: int, every: int = 1) -> int:
    """Count the inputs on which the filter certifies a sign that is not the exact one."""
    decide: Arithmetic = derive([orient2d_filter, diametral_filter], mini, Backend.ARRAYS)[name]
    triples, differences = axis_triples(mini.precision, binades, mini.quantum)
    (ax, bx, cx), (px, sx) = triples[:, ::every], differences[:, ::every]
    found = 0
    for (ay, by, cy), (ry, qy) in zip(triples.T.tolist(), differences.T.tolist(), strict=True):
        sign = decide(bound, ax, ay, bx, by, cx, cy)
        # (a - c) x (b - c), or (a - c) . (b - c) with the sign of diametral
        exact = np.sign(px * qy - ry * sx) if name == "orient2d_filter" else -np.sign(px * sx + ry * qy)
        found += int(np.count_nonzero((sign != 0) & (sign != exact)))
    return found


def published(precision: int) -> float:
    u = 2.0**-precision
    return (3.0 + 16.0 * u) * u


BINADES = 3  # test_exhaustive.py has more, compiled


@pytest.mark.obligation(
    "K3",
    "the filters of orient2d and diametral never lie (exhaustive, 3 bits)",
    method="exhaustive",
    control_in="TestFilterControls",
)
class TestFilterNeverLies:
    """A sign that the filter certifies is the exact one: over every input of the format, up to symmetries.

    The symmetries: inputs with equal exact and equal rounded differences, and mirror images in an axis.
    """

    @pytest.mark.parametrize("name", ["orient2d_filter", "diametral_filter"])
    def test_with_the_shipped_constant(self, name: str) -> None:
        assert lies(name, MiniFloat(3), published(3), BINADES) == 0


@pytest.mark.obligation("K4", "an unsound constant and a missing guard are found by K3", method="exhaustive")
class TestFilterControls:
    """The same search finds lies where there are some."""

    @pytest.mark.parametrize("name", ["orient2d_filter", "diametral_filter"])
    @pytest.mark.parametrize("factor", [0.0, 0.5, 1.0])
    def test_control_an_unsound_constant_is_found(self, name: str, factor: float) -> None:
        """The constants 0, u/2 and u."""
        assert lies(name, MiniFloat(3), factor * 2.0**-3, BINADES) > 0

    def test_control_a_missing_guard_is_found(self) -> None:
        """No guard where products underflow."""
        assert lies("orient2d_filter", MiniFloat(3, quantum=2.0**6), published(3), BINADES) > 0

    def test_control_a_wrong_filter_is_found(self) -> None:
        """A comparison with >= in the place of >."""
        mini = MiniFloat(3, edits={"orient2d_filter": ("-det > error", "-det >= error")})
        assert lies("orient2d_filter", mini, published(3), 2) > 0
