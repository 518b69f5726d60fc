"""J1: the machine code does what the source says, and the rational stage answers it, come what may."""

import ctypes
import importlib
import os
import pkgutil
import platform
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from types import FrameType, ModuleType
from typing import NoReturn

import llvmlite.binding
import numba
import numpy as np
import pytest
from proofs_tests.kernel import digest as lane_digest
from proofs_tests.kernel import oracle
from proofs_tests.rounding.minifloat import Arithmetic

import exactkernel
import exactkernel as ek
import exactmesh
from exactkernel import batch, doubledouble, expansions, rational, shape
from exactkernel.context import guarded_context
from exactkernel.jit import cache_directory, is_cache_warm

FUSED = re.compile(r"\bv?fn?m(?:add|sub|la|ls)\w*")
HAS_FUSED = platform.machine() in ("aarch64", "arm64") or llvmlite.binding.get_host_cpu_features().get("fma", False)
#: The loops contain the predicates whole: numba links what they call.
MODULES = ("expansions", "doubledouble", "batch")
SHAPES = ("angle_below_adaptive", "angle_above_adaptive", "area_above_adaptive", "length_above_adaptive")


def in_a_child(*command: str, **environment: str) -> str:
    """Run Python in a new process with this one's import path."""
    paths = os.pathsep.join(p for p in sys.path if p)
    done = subprocess.run(
        [sys.executable, *command],
        env={**os.environ, "PYTHONPATH": paths, **environment},
        capture_output=True,
        text=True,
        check=True,
        timeout=300,
    )
    return done.stdout


def digests() -> str:
    parts = {
        **lane_digest.transforms(),
        **lane_digest.expansion_arithmetic(),
        **lane_digest.predicates(),
        **lane_digest.shapes(),
    }
    return "".join(f"{name} {digest}\n" for name, digest in parts.items())


@pytest.mark.compiled
@pytest.mark.obligation(
    "J1", "compiled equals interpreted, bit for bit, in this process and in a later one", method="bit for bit"
)
class TestLanes:
    """Every routine returns the same bits compiled, loaded from the cache in a new process, and interpreted."""

    def test_interpreted(self) -> None:
        assert in_a_child("-m", "proofs_tests.kernel.digest", NUMBA_DISABLE_JIT="1") == digests()

    def test_a_later_process_loads_the_cache_and_reaches_the_callbacks(self) -> None:
        expected = digests()
        assert is_cache_warm()
        assert cache_directory() is not None
        code = (
            "from proofs_tests.kernel.test_compiled import digests\n"
            "print(digests(), end='')\n"
            "from exactkernel.orient2d import orient2d_slow\n"
            "print(sum(orient2d_slow.stats.cache_hits.values()), sum(orient2d_slow.stats.cache_misses.values()))\n"
        )
        assert in_a_child("-c", code) == f"{expected}1 0\n"

    def test_control_the_digest_sees_one_bit(self) -> None:
        """One unit in the last place, and the sign of a zero."""
        one, other, zero = lane_digest.Digest(), lane_digest.Digest(), lane_digest.Digest()
        one.add(1.0, 0.0)
        other.add(1.0 + 2.0**-52, 0.0)
        zero.add(1.0, -0.0)
        assert len({str(one), str(other), str(zero)}) == 3


def compiled_functions(module: str) -> dict[str, Arithmetic]:
    found = {name: value for name, value in vars(sys.modules[module]).items() if hasattr(value, "py_func")}
    return {name: f for name, f in found.items() if f.py_func.__module__ == module}


def options_of(function: Callable[..., object]) -> dict[str, object]:
    """Return what a function is compiled with."""
    options: dict[str, object] = getattr(function, "targetoptions")  # noqa: B009
    return options


def machine_code(function: Callable[..., object], signature: object, **options: object) -> str:
    """Compile anew (what comes from the cache has no listing) and return the assembly, callees included."""
    fresh = numba.njit(_nrt=False, **options)(getattr(function, "py_func", function))  # type: ignore[call-overload]
    fresh.compile(signature)
    listing: str = "".join(fresh.inspect_asm().values())
    return listing


@pytest.mark.compiled
@pytest.mark.obligation("J1", "there is no fused multiply-add in the machine code of the kernel", method="machine code")
class TestMachineCode:
    """No compiled function contains a fused multiply-add, which rounds once where the source rounds twice."""

    def test_every_function(self) -> None:
        digests()
        ek.diametral_batch((0, 0), (1, 1), (2, 2))
        inspected = 0
        functions = {name: f for module in MODULES for name, f in compiled_functions(f"exactkernel.{module}").items()}
        functions.update((name, getattr(shape, name)) for name in SHAPES)
        for name, function in functions.items():
            signatures = getattr(function, "signatures", [])
            assert signatures, f"{name} was never compiled: let the digest call it"
            assert not FUSED.findall(machine_code(function, signatures[0], fastmath=False)), name
            inspected += 1
        assert inspected >= 19

    @pytest.mark.parametrize(("package", "at_least"), [(exactkernel, 70), (exactmesh, 250)], ids=["kernel", "mesh"])
    def test_no_function_allows_contraction(self, package: ModuleType, at_least: int) -> None:
        """Nor any other liberty: what each function of the package, compiled yet or not, is compiled with."""
        names = [module.name for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}.")]
        for name in names:
            if not name.endswith("__main__"):
                importlib.import_module(name)
        functions = {
            f"{name}.{of}": f for name in names if name in sys.modules for of, f in compiled_functions(name).items()
        }
        assert len(functions) >= at_least
        assert [name for name, function in functions.items() if options_of(function)["fastmath"]] == []

    def test_control_an_option_is_seen(self) -> None:
        """A function that is compiled with contraction."""
        assert options_of(numba.njit(fastmath={"contract"})(lambda x: x))["fastmath"]

    @pytest.mark.skipif(not HAS_FUSED, reason="this processor has no fused multiply-add")
    def test_control_contraction_is_seen(self) -> None:
        """Products compiled with contraction."""
        pair = (numba.types.float64, numba.types.float64)
        assert FUSED.findall(machine_code(expansions.two_product, pair, fastmath={"contract"}))
        assert FUSED.findall(machine_code(doubledouble.dd_multiply, pair * 2, fastmath={"contract"}))


ROWS = 50
FAR = np.full((ROWS, 2), 1e-200)
WIDE = np.full((ROWS, 2), 1e200)
THIRD = np.stack([np.zeros(ROWS), np.arange(ROWS) % 3 - 1.0], axis=1)
EXACT = [oracle.orient2d(*points) for points in zip(FAR.tolist(), WIDE.tolist(), THIRD.tolist(), strict=True)]


class Interrupting:
    """A rational predicate that raises at chosen calls, and answers at the others."""

    def __init__(self, error: type[BaseException], every: int) -> None:
        self.error, self.every, self.calls = error, every, 0
        self.predicate: Callable[..., int] = rational.orient2d_rational

    def __call__(self, *points: rational.RationalPoint) -> int:
        self.calls += 1
        if self.calls % self.every == 0:
            raise self.error
        return self.predicate(*points)


@pytest.mark.obligation(
    "J1", "an interrupt in the rational stage never yields a wrong sign, and is not lost", method="named cases"
)
class TestInterrupts:
    """Whatever is raised in a callback: the signs are right, the exception arrives after the run, and nothing hangs."""

    @pytest.mark.parametrize("error", [KeyboardInterrupt, TimeoutError, SystemExit])
    def test_raised_inside(self, error: type[BaseException], monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(rational, "orient2d_rational", Interrupting(error, 7))
        signs = np.full(ROWS, 9, dtype=np.int8)
        batch._orient2d_loop(guarded_context(), FAR, WIDE, THIRD, signs)
        assert signs.tolist() == EXACT
        with pytest.raises(error):
            rational.raise_if_interrupted()
        rational.raise_if_interrupted()
        with pytest.raises(error):
            ek.orient2d_batch(FAR, WIDE, THIRD)

    def test_a_scalar_call_raises_too(self, monkeypatch: pytest.MonkeyPatch) -> None:
        interrupting = Interrupting(KeyboardInterrupt, 2)
        monkeypatch.setattr(rational, "orient2d_rational", interrupting)
        assert ek.orient2d(FAR[0], WIDE[0], THIRD[0]) == EXACT[0]
        with pytest.raises(KeyboardInterrupt):
            ek.orient2d(FAR[0], WIDE[0], THIRD[0])
        monkeypatch.undo()
        assert ek.orient2d(FAR[1], WIDE[1], THIRD[1]) == EXACT[1]

    @pytest.mark.parametrize(
        ("name", "predicate", "n"),
        [("orient2d", ek.orient2d, 3), ("diametral", ek.diametral, 3), ("incircle", ek.incircle, 4)],
    )
    def test_every_predicate_asks_again(
        self, name: str, predicate: Callable[..., int], n: int, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        points = ((1e-200, 0.0), (0.0, 1e200), (-1e-200, 0.0), (0.0, 1.0))[:n]
        expected = predicate(*points)
        calls = []

        def first_interrupted(*exact: rational.RationalPoint) -> int:
            calls.append(exact)
            if len(calls) == 1:
                raise KeyboardInterrupt
            return int(expected)

        monkeypatch.setattr(rational, f"{name}_rational", first_interrupted)
        with pytest.raises(KeyboardInterrupt):
            predicate(*points)
        assert len(calls) == 2
        assert calls[0] == calls[1]

    @pytest.mark.parametrize("error", [RecursionError, MemoryError])
    def test_what_fails_for_good_is_an_error_not_a_loop(
        self, error: type[BaseException], monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(rational, "orient2d_rational", Interrupting(error, 1))
        with pytest.raises(RuntimeError, match="cannot answer"):
            ek.orient2d(FAR[0], WIDE[0], THIRD[0])
        rational.raise_if_interrupted()

    def test_interrupted_at_every_attempt(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(rational, "orient2d_rational", Interrupting(KeyboardInterrupt, 1))
        with pytest.raises(RuntimeError, match="every attempt"):
            ek.orient2d(FAR[0], WIDE[0], THIRD[0])
        with pytest.raises(KeyboardInterrupt):
            rational.raise_if_interrupted()

    @pytest.mark.compiled
    @pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="no interval timer on this platform")
    def test_signals_at_any_moment(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """A signal raises at the very entry of the callback, outside of its try: ctypes reports it and goes on."""
        arrived = []

        def interrupt(number: int, frame: FrameType | None) -> NoReturn:
            arrived.append(number)
            raise KeyboardInterrupt

        monkeypatch.setattr(sys, "unraisablehook", lambda _: None)
        before = signal.signal(signal.SIGALRM, interrupt)
        try:
            while len(arrived) < 5:
                signs = np.full(ROWS, 9, dtype=np.int8)
                try:
                    signal.setitimer(signal.ITIMER_REAL, 1e-4)
                    batch._orient2d_loop(guarded_context(), FAR, WIDE, THIRD, signs)
                    signal.setitimer(signal.ITIMER_REAL, 0.0)
                except KeyboardInterrupt:  # before the loop began or after it ended
                    signal.setitimer(signal.ITIMER_REAL, 0.0)
                assert signs.tolist() in (EXACT, [9] * ROWS)
        finally:
            signal.signal(signal.SIGALRM, before)
        with pytest.raises(KeyboardInterrupt):
            rational.raise_if_interrupted()

    def test_an_interrupt_that_ctypes_swallowed_is_reported(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """A second attempt with nothing on record: the first was interrupted before it could record."""
        mailbox = np.zeros(2, dtype=np.int64)
        monkeypatch.setattr(rational, "COMPILED", True)
        rational._register("exactmesh_test_swallowed", lambda *_: -1, 6)
        answer = rational._keep_alive.pop()
        assert callable(answer)
        answer(mailbox.ctypes.data, 5, 1, *[0.0] * 6)
        assert mailbox.tolist() == [0, 5 * 4 + 1]
        with pytest.raises(KeyboardInterrupt):
            rational.raise_if_interrupted()

    @pytest.mark.compiled
    def test_control_a_failing_ctypes_callback_returns_the_answer_before(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Why answers bear numbers: by return value, the failing call repeats an old answer (or worse)."""

        def sign_plus_two(x: float) -> int:
            if x == 0.0:
                raise KeyboardInterrupt
            return 3 if x > 0 else 1

        monkeypatch.setattr(sys, "unraisablehook", lambda _: None)
        callback = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_double)(sign_plus_two)
        address = ctypes.cast(callback, ctypes.c_void_p).value
        llvmlite.binding.add_symbol("exactmesh_test_by_value", address)
        signature = numba.types.int64(numba.types.float64)
        ask: Arithmetic = numba.types.ExternalFunction("exactmesh_test_by_value", signature)
        four: Arithmetic = numba.njit(lambda: (ask(1.0), ask(0.0), ask(-1.0), ask(0.0)))
        answers = four()
        assert answers[::2] == (3, 1)
        if answers[1::2] == (0, 0):
            pytest.skip("this ctypes happens to return 0")
        assert set(answers[1::2]) & {1, 2, 3}

    def test_threads_share_no_answers(self) -> None:
        interval = sys.getswitchinterval()
        sys.setswitchinterval(1e-6)
        try:
            with ThreadPoolExecutor(4) as pool:
                rows = list(zip(FAR, WIDE, THIRD, strict=True)) * 8
                assert list(pool.map(lambda points: int(ek.orient2d(*points)), rows)) == EXACT * 8
        finally:
            sys.setswitchinterval(interval)
