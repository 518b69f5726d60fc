"""K5: the expansions' memory: compiled code checks no bounds, so that nothing may be longer than the room it has.

The routines are run with stand-ins for the arithmetic that only tell lengths: each returns as many components as there
can be, spoils the scratch that it may use, and marks what it writes. So one run is the longest of all runs.
"""

from collections.abc import Callable, Sequence
from importlib import import_module
from itertools import count
from types import ModuleType

import numpy as np
import pytest
from proofs_tests.rounding.minifloat import Arithmetic, Floats

from exactkernel import angle, bisector, centre, crossing, expansions, measure
from exactkernel.context import SCRATCH_SIZE, guarded_context, make_context
from exactmesh.verify import bottleneck

# the functions hide their modules
orient2d, incircle = (import_module(f"exactkernel.{name}") for name in ("orient2d", "incircle"))


class Longest:
    """The routines of the expansions, reduced to the lengths that their docstrings promise at most."""

    def __init__(self) -> None:
        self.marks = count(1.0)
        self.calls = 0

    def write(
        self,
        h: Floats,
        n: int,
        operands: Sequence[tuple[Floats, int]] = (),
        scratch: Sequence[tuple[Floats, int]] = (),
    ) -> int:
        """Write n components into h, by way of the scratch, while the operands are still needed."""
        self.calls += 1
        before = [e[:ne].tolist() for e, ne in operands]
        for marks, (_, ne) in zip(before, operands, strict=True):
            assert len(marks) == ne, "an operand is longer than its room"
            assert len(set(marks)) <= 1, "an operand was overwritten after it was made"
        written = [(h, n, next(self.marks)), *((room, used, next(self.marks)) for room, used in scratch)]
        for room, used, mark in written:
            assert len(room) >= used, f"room for {len(room)} doubles, {used} needed"
            room[:used] = mark
        for room, used, mark in written:
            assert set(room[:used].tolist()) <= {mark}, "result and scratch overlap"
        for (e, ne), marks in zip(operands, before, strict=True):
            assert e[:ne].tolist() == marks, "an operand lies where the result or the scratch does"
        return n

    def pair(self, high: float, low: float, h: Floats) -> int:
        return self.write(h, 2)

    def expansion_sum(self, e: Floats, ne: int, f: Floats, nf: int, h: Floats) -> int:
        return self.write(h, ne + nf, [(e, ne), (f, nf)])

    def scale_expansion(self, e: Floats, ne: int, b: float, h: Floats) -> int:
        return self.write(h, 2 * ne, [(e, ne)])

    def expansion_product(
        self, e: Floats, ne: int, f: Floats, nf: int, h: Floats, scaled: Floats, total: Floats
    ) -> int:
        n = 2 * ne * nf
        return self.write(h, n, [(e, ne), (f, nf)], [(scaled, 2 * ne), (total, n)])

    def determinant_2x2(
        self,
        p: float, p_tail: float, q: float, q_tail: float, r: float, r_tail: float, s: float, s_tail: float,
        h: Floats, scratch: Floats,
    ) -> int:  # fmt: skip
        return self.write(h, 16, scratch=[(scratch, 32)])

    def negate(self, e: Floats, ne: int) -> None:
        self.write(np.empty(0), 0, [(e, ne)])

    def expansion_sign(self, e: Floats, ne: int) -> int:
        self.write(np.empty(0), 0, [(e, ne)])
        return 1


ARITHMETIC = [name for name in vars(Longest) if name in expansions.__all__]


def source(function: Callable[..., object]) -> Arithmetic:
    """The function uncompiled, which looks its callees up when it runs."""
    plain: Arithmetic = getattr(function, "py_func", function)
    return plain


def longest_in(monkeypatch: pytest.MonkeyPatch, module: ModuleType, *inner: str) -> Longest:
    """Let the module's functions meet the stand-ins; its ``inner`` functions run as they are written."""
    longest = Longest()
    for name in (name for name in ARITHMETIC if hasattr(module, name)):
        monkeypatch.setattr(module, name, getattr(longest, name))
    for name in inner:
        monkeypatch.setattr(module, name, source(ORIGINAL[name]))
    return longest


ORIGINAL = {
    name: getattr(module, name)
    for module, name in [
        (expansions, "expansion_product"),
        (expansions, "determinant_2x2"),
        (incircle, "lifted_term"),
        (bisector, "_term"),
        (centre, "_lifted"),
        (crossing, "_is_exact"),
        (bottleneck, "cross_expansion"),
    ]
}


def room(n: int) -> Floats:
    """So many doubles and no more."""
    return np.zeros(n)


def operand(n: int) -> Floats:
    """An expansion of so many components."""
    return np.full(n, -1.0)


PAIR = (1.0, 0.0)


@pytest.mark.obligation(
    "K5", "no expansion outgrows its room, none is overwritten while in use", method="calculus", control_in="mutants"
)
class TestWorkspace:
    """With every expansion as long as it can be, each fits where it is written, and lasts as long as it is read."""

    @pytest.mark.parametrize(("ne", "nf"), [(1, 1), (2, 2), (16, 2), (16, 16), (32, 16), (3, 5)])
    def test_product(self, monkeypatch: pytest.MonkeyPatch, ne: int, nf: int) -> None:
        longest = longest_in(monkeypatch, expansions, "expansion_product")
        n = 2 * ne * nf
        assert expansions.expansion_product(operand(ne), ne, operand(nf), nf, room(n), room(2 * ne), room(n)) == n
        assert longest.calls == 2 * nf

    def test_determinant(self, monkeypatch: pytest.MonkeyPatch) -> None:
        longest = longest_in(monkeypatch, expansions, "determinant_2x2")
        assert expansions.determinant_2x2(*PAIR * 4, room(16), room(32)) == 16
        assert longest.calls == 8

    def test_difference_of_products(self, monkeypatch: pytest.MonkeyPatch) -> None:
        longest = longest_in(monkeypatch, orient2d)
        source(orient2d.products_difference)(*PAIR * 4, room(48))
        assert longest.calls == 2

    def test_lifted_term(self, monkeypatch: pytest.MonkeyPatch) -> None:
        longest = longest_in(monkeypatch, incircle, "lifted_term")
        assert incircle.lifted_term(*PAIR * 6, room(512), room(608)) == 512
        assert longest.calls == 3

    def test_incircle(self, monkeypatch: pytest.MonkeyPatch) -> None:
        longest = longest_in(monkeypatch, incircle, "lifted_term")
        assert source(incircle.incircle_expansion)(*PAIR * 6, room(SCRATCH_SIZE)) == 1
        assert longest.calls == 12

    def test_lifted(self, monkeypatch: pytest.MonkeyPatch) -> None:
        longest = longest_in(monkeypatch, centre, "_lifted")
        assert centre._lifted(*PAIR * 3, room(64), room(114)) == 64
        assert longest.calls == 3

    @pytest.mark.parametrize("axis", [0, 1])
    def test_beyond_a_coordinate(self, monkeypatch: pytest.MonkeyPatch, axis: int) -> None:
        longest = longest_in(monkeypatch, centre, "_lifted")
        source(centre._beyond)(axis, *PAIR, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, room(820))
        assert longest.calls == 16

    def test_on_a_line(self, monkeypatch: pytest.MonkeyPatch) -> None:
        longest = longest_in(monkeypatch, crossing, "_is_exact")
        assert not crossing._is_exact(1.0, 0.0, *PAIR, operand(16), 16, operand(16), 16, room(354))
        assert longest.calls == 6

    def test_corner(self, monkeypatch: pytest.MonkeyPatch) -> None:
        longest = longest_in(monkeypatch, angle)
        for degrees in (0.0, 45.0, 90.0, 135.0):
            source(angle.corner_expansion)(angle.angle_bound(degrees), *PAIR * 4, room(96))
        assert longest.calls == 4 + 5 + 3 + 4

    def test_bisectors(self, monkeypatch: pytest.MonkeyPatch) -> None:
        longest = longest_in(monkeypatch, bisector, "_term")
        k = guarded_context()
        source(bisector._crossing_order_exact)(k, *[0.0] * 10)
        assert longest.calls == 13
        source(bisector.nearer_adaptive)(make_context(room(6)), *[0.0] * 6)
        assert longest.calls == 18

    def test_measures(self, monkeypatch: pytest.MonkeyPatch) -> None:
        longest = longest_in(monkeypatch, measure)
        k = guarded_context()
        source(measure.area_code)(k, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0)
        source(measure.length_code)(k, 1.0, 0.0, 0.0, 1.0, 0.0)
        assert longest.calls == 8

    def test_distances_from_a_segment(self, monkeypatch: pytest.MonkeyPatch) -> None:
        longest = longest_in(monkeypatch, bottleneck, "cross_expansion")
        points, line = np.zeros((2, 2)), np.array([0.0, 0.0, 1.0, 0.0])
        search = bottleneck.empty_search(2)
        search.high[:] = search.error[:] = 0.0  # as near as the other, as far as this tells
        source(bottleneck.compare)(guarded_context(), points, line, search, 0, 1)
        assert longest.calls == 7
