"""J1: the questions that compiled loops put to the rational predicates about bisectors."""

import importlib.util
import inspect
from collections.abc import Callable
from types import ModuleType

import numpy as np
import pytest
from proofs_tests.kernel.interpreted import interpreted

from exactkernel import bisector_rational, rational

ASKED = [("nearer", 6), ("along", 8), ("crossing_order", 10)]


def loaded_again(module: ModuleType) -> ModuleType:
    """The module's own file, run in a namespace of its own."""
    spec = importlib.util.spec_from_file_location("loaded_again", str(module.__file__))
    assert spec is not None
    assert spec.loader is not None
    fresh = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(fresh)
    return fresh


def arities(register: str = "_register") -> dict[str, tuple[int, int]]:
    """For each callback: how many doubles machine code hands over, and how many its predicate takes."""
    found = {}

    def recorded(name: str, predicate: Callable[..., int], arity: int) -> Callable[..., None]:
        found[name] = (arity, len(inspect.signature(predicate).parameters))
        return lambda *_: None

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(rational, register, recorded)
        loaded_again(bisector_rational)
    return found


@pytest.mark.obligation("J1", "a callback takes as many doubles as machine code hands over", method="enumeration")
class TestArity:
    """Each predicate is registered, under a name of its own, with the number of its parameters."""

    def test_all(self) -> None:
        found = arities()
        assert sorted(taken for _, taken in found.values()) == [arity for _, arity in ASKED]
        assert all(handed == taken for handed, taken in found.values())

    def test_control_a_callback_left_out_is_noticed(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """A module that registers nothing by the watched name."""
        monkeypatch.setattr(rational, "_another", None, raising=False)
        assert arities("_another") == {}


@interpreted
@pytest.mark.obligation(
    "J1", "a question that is not answered is asked sixteen times, then given up", method="enumeration"
)
class TestAttempts:
    """The first try bears the number 0, which tells the callback that no signal came in between."""

    @pytest.mark.parametrize(("name", "arity"), ASKED)
    def test_never_answered(self, name: str, arity: int, monkeypatch: pytest.MonkeyPatch) -> None:
        attempts, mailbox = [], np.zeros(2, dtype=np.int64)

        def silent(_: int, __: int, attempt: int, *___: float) -> None:
            attempts.append(attempt)

        monkeypatch.setattr(bisector_rational, f"_ask_{name}", silent)
        with pytest.raises(RuntimeError, match="interrupted at every attempt"):
            getattr(bisector_rational, f"{name}_from_doubles")(mailbox, *[0.5] * arity)
        assert attempts == list(range(16))

    @pytest.mark.parametrize(("name", "arity"), ASKED)
    def test_control_answered_at_the_second_try(self, name: str, arity: int, monkeypatch: pytest.MonkeyPatch) -> None:
        """A callback that fails once: two tries, not sixteen."""
        attempts, mailbox = [], np.zeros(2, dtype=np.int64)
        original = getattr(bisector_rational, f"_ask_{name}")

        def late(address: int, number: int, attempt: int, *coordinates: float) -> None:
            attempts.append(attempt)
            if attempt > 0:
                original(address, number, attempt, *coordinates)

        monkeypatch.setattr(bisector_rational, f"_ask_{name}", late)
        assert getattr(bisector_rational, f"{name}_from_doubles")(mailbox, *[0.5] * arity) == 0
        assert attempts == [0, 1]
