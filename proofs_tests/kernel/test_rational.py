"""K7: the last stage: the predicates of rational points, and how compiled code asks for them."""

import inspect
import threading
import types
from collections.abc import Callable
from fractions import Fraction
from itertools import combinations_with_replacement, permutations, product
from pathlib import Path

import llvmlite.binding
import numba
import numpy as np
import pytest
from gmpy2 import mpq
from proofs_tests.kernel import oracle

from exactkernel import jit, rational
from exactkernel.rational import (
    diametral_from_doubles,
    diametral_rational,
    incircle_from_doubles,
    incircle_rational,
    orient2d_from_doubles,
    orient2d_rational,
    shape_from_doubles,
    shape_rational,
)

Predicate = Callable[..., int]


def rational_points(points: tuple[tuple[Fraction, Fraction], ...]) -> list[rational.RationalPoint]:
    return [(mpq(x), mpq(y)) for x, y in points]


@pytest.mark.obligation("K7", "the rational predicates are the definitions", method="enumeration", control_in="mutants")
class TestRational:
    """On thirds of a small grid, off its centre, in every order, and with coordinates of 10^40 and 10^-40."""

    @pytest.mark.parametrize(
        ("predicate", "exact", "n"),
        [(orient2d_rational, oracle.orient2d, 3), (diametral_rational, oracle.diametral, 3)],
    )
    def test_three(self, predicate: Predicate, exact: Predicate, n: int) -> None:
        grid = [(Fraction(x, 3), Fraction(y + 2, 3)) for x, y in product(range(3), repeat=2)]
        for points in product(grid, repeat=n):
            assert predicate(*rational_points(points)) == exact(*points)

    def test_four(self) -> None:
        grid = [(Fraction(x, 3), Fraction(y + 2, 3)) for x, y in product(range(3), repeat=2)]
        for points in combinations_with_replacement(grid, 4):
            sign = oracle.incircle(*points)
            for order in list(permutations(range(4)))[:: 1 if sign else 7]:
                there = tuple(points[i] for i in order)
                assert incircle_rational(*rational_points(there)) == sign * oracle.parity(order)

    def test_sizes(self) -> None:
        wild = [Fraction(10) ** 40, Fraction(1, 10**40), Fraction(-3), Fraction(0), Fraction(7, 3)]
        points = [(x, y) for x in wild for y in wild]
        for i in range(0, 25 * 25, 7):
            there = (points[i % 25], points[i // 25], points[(i * i + 3) % 25], points[(5 * i + 1) % 25])
            assert orient2d_rational(*rational_points(there)[:3]) == oracle.orient2d(*there[:3])
            assert diametral_rational(*rational_points(there)[:3]) == oracle.diametral(*there[:3])
            assert incircle_rational(*rational_points(there)) == oracle.incircle(*there)

    @pytest.mark.parametrize("shift", [(0, 0), (5, -7)])
    def test_measures(self, shift: tuple[int, int]) -> None:
        """The right triangle of 5, 12, 13 and one of 45 degrees, against their measures and numbers beside them."""
        a, b, c, d = [(mpq(x + shift[0]), mpq(y + shift[1])) for x, y in [(0, 0), (12, 0), (12, 5), (12, 12)]]
        for beside in (mpq(-1, 10**9), mpq(0), mpq(1, 10**9)):
            order = (beside > 0) - (beside < 0)
            for corners in ((a, b, c), (b, c, a), (c, a, b)):
                assert shape_rational(rational.AREA, 30 + beside, *corners) == -order
            for p, q, length in ((a, b, 12), (b, c, 5), (a, c, 13), (c, a, 13), (c, d, 7)):
                assert shape_rational(rational.LENGTH, length + beside, p, q, a) == -order
            assert shape_rational(rational.ANGLE, 90 + beside, b, c, a) == order
            assert shape_rational(rational.ANGLE, 45 + beside, a, b, d) == order
            assert shape_rational(rational.ANGLE, 45 + beside, d, a, b) == order
        assert shape_rational(rational.ANGLE, mpq("22.6"), a, b, c) == -1  # atan(5/12) is 22.62 degrees
        assert shape_rational(rational.ANGLE, mpq("22.7"), a, b, c) == 1
        assert shape_rational(rational.ANGLE, mpq("67.3"), c, a, b) == -1
        assert shape_rational(rational.ANGLE, mpq("67.4"), c, a, b) == 1


QUESTIONS: list[tuple[str, Callable[..., int], int]] = [
    ("_ask_orient2d", orient2d_from_doubles, 6),
    ("_ask_diametral", diametral_from_doubles, 6),
    ("_ask_incircle", incircle_from_doubles, 8),
    ("_ask_shape", shape_from_doubles, 8),
]


def source(function: Callable[..., int]) -> Callable[..., int]:
    """The function uncompiled, which looks up whom it asks."""
    plain: Callable[..., int] = getattr(function, "py_func", function)
    return plain


@pytest.mark.obligation(
    "J1",
    "each question to the rational stage has its own number, and only its answer counts",
    method="named cases",
    control_in="mutants",
)
class TestQuestions:
    """The sign is what the answer says that bears the question's number; sixteen attempts are made, each with a new
    number, and told apart; an answer that fails for good, or none, is an error and no sign."""

    @pytest.mark.parametrize(("name", "ask", "arity"), QUESTIONS)
    @pytest.mark.parametrize("sign", [-1, 0, 1])
    @pytest.mark.parametrize("failures", [0, 1, 15])
    def test_answers(
        self,
        name: str,
        ask: Callable[..., int],
        arity: int,
        sign: int,
        failures: int,
        monkeypatch: pytest.MonkeyPatch,
    ) -> None:
        mailbox = np.array([40, 163], dtype=np.int64)
        asked: list[tuple[int, int, tuple[float, ...]]] = []

        def answering(_address: int, number: int, attempt: int, *coordinates: float) -> None:
            assert mailbox.tolist() == [number, 0], "the box is empty while the question is out"
            asked.append((number, attempt, coordinates))
            if attempt == failures:
                mailbox[1] = number * 4 + sign + 2
            elif attempt % 2:
                mailbox[1] = (number - 1) * 4 + 3  # an answer to another question

        monkeypatch.setattr(rational, name, answering)
        coordinates = tuple(float(i) for i in range(arity))
        assert source(ask)(mailbox, *coordinates) == sign
        assert asked == [(41 + i, i, coordinates) for i in range(failures + 1)]

    @pytest.mark.parametrize(("name", "ask", "arity"), QUESTIONS)
    def test_no_answer(self, name: str, ask: Callable[..., int], arity: int, monkeypatch: pytest.MonkeyPatch) -> None:
        attempts: list[int] = []
        monkeypatch.setattr(rational, name, lambda _address, _number, attempt, *_: attempts.append(attempt))
        with pytest.raises(RuntimeError, match="at every attempt"):
            source(ask)(np.zeros(2, dtype=np.int64), *[0.0] * arity)
        assert attempts == list(range(16))

    def test_an_answer_that_fails_for_good(self, monkeypatch: pytest.MonkeyPatch) -> None:
        mailbox = np.zeros(2, dtype=np.int64)
        monkeypatch.setattr(rational, "_ask_orient2d", lambda *_: mailbox.__setitem__(1, -1))
        with pytest.raises(RuntimeError, match="cannot answer"):
            source(orient2d_from_doubles)(mailbox, *[0.0] * 6)

    @pytest.mark.parametrize("arity", [1, 6, 8])
    @pytest.mark.parametrize("compiled", [False, True])
    def test_the_other_side(self, arity: int, compiled: bool, monkeypatch: pytest.MonkeyPatch) -> None:
        """What is called answers in the second place, and passes on what it was given."""
        monkeypatch.setattr(rational, "COMPILED", compiled)
        monkeypatch.setattr(rational, "_pending", [])
        given: list[tuple[float, ...]] = []

        def predicate(*coordinates: float) -> int:
            given.append(coordinates)
            return -1

        ask = rational._register(f"exactmesh_test_other_side_{arity}", predicate, arity)
        answer = rational._keep_alive.pop() if compiled else ask
        assert callable(answer)
        mailbox = np.array([7, 8, 9], dtype=np.int64)
        coordinates = tuple(0.5 + i for i in range(arity))
        answer(mailbox.ctypes.data, 5, 0, *coordinates)
        assert mailbox.tolist() == [7, 5 * 4 + 1, 9]
        assert given == [coordinates]
        assert rational._pending == []

    @pytest.mark.parametrize(("name", "ask", "arity"), QUESTIONS)
    def test_signatures(self, name: str, ask: Callable[..., int], arity: int, monkeypatch: pytest.MonkeyPatch) -> None:
        """Machine code passes an address, a number and an attempt, and all the doubles of the question, by a symbol of
        that question alone."""
        symbols: list[str] = []
        monkeypatch.setattr(llvmlite.binding, "add_symbol", lambda symbol, _: symbols.append(symbol))
        monkeypatch.setattr(jit, "COMPILED", True)
        module = types.ModuleType("exactkernel.rational_compiled")
        path = str(rational.__file__)
        exec(compile(Path(path).read_text(encoding="utf-8"), path, "exec"), vars(module))
        external = vars(module)[name]
        assert external.sig.args == (numba.types.int64,) * 3 + (numba.types.float64,) * arity
        assert external.sig.return_type == numba.types.void
        assert len(inspect.signature(source(ask)).parameters) == arity + 1
        assert external.symbol in symbols
        assert len(set(symbols)) == 4

    @pytest.mark.parametrize("error", [RecursionError, MemoryError, KeyboardInterrupt, ValueError])
    @pytest.mark.parametrize("attempt", [0, 1, 2])
    def test_what_raises(self, error: type[BaseException], attempt: int, monkeypatch: pytest.MonkeyPatch) -> None:
        """It is kept, and raised once, first come first, in the main thread; what fails for good says so instead."""
        pending: list[BaseException] = [OverflowError()]
        monkeypatch.setattr(rational, "COMPILED", False)
        monkeypatch.setattr(rational, "_pending", pending)

        def raising(*_: float) -> int:
            raise error

        mailbox = np.array([7, 0, 9], dtype=np.int64)
        rational._register("exactmesh_test_raises", raising, 6)(mailbox.ctypes.data, 5, attempt, *[0.0] * 6)
        is_final = error in (RecursionError, MemoryError)
        assert mailbox.tolist() == [7, -1 if is_final else 0, 9]
        assert [type(e) for e in pending] == [OverflowError] + [error] * (not is_final)
        thread = threading.Thread(target=rational.raise_if_interrupted)
        thread.start()
        thread.join()
        assert pending
        with pytest.raises(OverflowError):
            rational.raise_if_interrupted()
        assert pending == []
        rational.raise_if_interrupted()

    @pytest.mark.parametrize(("attempt", "is_lost"), [(0, False), (1, True), (2, True)])
    def test_a_second_attempt_means_a_lost_interrupt(
        self, attempt: int, is_lost: bool, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """Compiled code asks again because ctypes swallowed what was raised; unless that is on record, it is put
        there, once."""
        for before in ([], [TimeoutError()]):
            pending: list[BaseException] = list(before)
            monkeypatch.setattr(rational, "COMPILED", True)
            monkeypatch.setattr(rational, "_pending", pending)
            rational._register("exactmesh_test_lost", lambda *_: 0, 6)
            answer = rational._keep_alive.pop()
            assert callable(answer)
            answer(np.zeros(2, dtype=np.int64).ctypes.data, 5, attempt, *[0.0] * 6)
            expected: list[type[BaseException]] = [TimeoutError] if before else [KeyboardInterrupt] * is_lost
            assert [type(e) for e in pending] == expected
