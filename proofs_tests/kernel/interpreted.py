"""Looking into functions while they run interpreted: which steps they take, and which workspaces they cut."""

import sys
from collections.abc import Callable
from types import CodeType, ModuleType
from typing import Any, TypeVar

import numpy as np
import pytest

from exactkernel import expansions
from exactkernel.jit import COMPILED
from exactkernel.types import FloatArray

__all__ = ["Workspace", "calls_of", "interpreted", "watched_expansions"]

R = TypeVar("R")

#: Machine code does not look names up again; and the steps of a function are compiled as parts of it, not one by one.
interpreted = pytest.mark.skipif(COMPILED, reason="looks into interpreted functions; set NUMBA_DISABLE_JIT=1")


def calls_of(patch: pytest.MonkeyPatch, module: ModuleType, *names: str) -> list[str]:
    """Record the calls that a module makes by these names; a call's name comes into the list, once a call."""
    seen: list[str] = []

    def recorded(name: str, function: Callable[..., R]) -> Callable[..., R]:
        def record(*arguments: object) -> R:
            seen.append(name)
            return function(*arguments)

        return record

    for name in names:
        patch.setattr(module, name, recorded(name, getattr(module, name)))
    return seen


class Workspace(np.ndarray[Any, np.dtype[np.float64]]):
    """Scratch space that refuses to be cut into parts that overlap, by one and the same function."""

    cuts: dict[tuple[int, int, CodeType], set[tuple[int, int]]]

    @classmethod
    def of(cls, size: int) -> "Workspace":
        made = np.full(size, np.nan).view(cls)
        made.cuts = {}
        return made

    def __array_finalize__(self, parent: object) -> None:
        self.cuts = getattr(parent, "cuts", {})

    def __getitem__(self, key: Any) -> Any:  # as numpy's own
        caller = sys._getframe(1)
        if isinstance(key, slice) and caller.f_globals is not vars(expansions):  # whose cuts follow the lengths
            start, stop, _ = key.indices(len(self))
            assert key.stop is None or key.stop <= len(self), f"{key} of {len(self)}"
            whole = (_address(self), len(self), caller.f_code)
            others = self.cuts.setdefault(whole, set())
            for first, last in others - {(start, stop)}:
                assert stop <= first or last <= start, f"{start}:{stop} overlaps {first}:{last}"
            others.add((start, stop))
        return super().__getitem__(key)


def _address(array: FloatArray) -> int:
    return int(array.__array_interface__["data"][0])


class _Lengths:
    """The longest that each expansion can be, and checks that there is room for it."""

    def __init__(self) -> None:
        self.longest: dict[int, int] = {}

    def of(self, e: FloatArray) -> int:
        return self.longest[_address(e)]

    def put(self, h: FloatArray, longest: int, *apart: FloatArray) -> None:
        assert len(h) >= longest, f"{longest} do not fit into {len(h)}"
        arrays = (h, *apart)
        for i, one in enumerate(arrays):
            assert not any(np.shares_memory(one, other) for other in arrays[:i]), "overlapping workspaces"
        self.longest[_address(h)] = longest


def watched_expansions(patch: pytest.MonkeyPatch, module: ModuleType) -> None:
    """Let the module's expansions check that the longest possible ones fit, and that what is in use is disjoint."""
    known = _Lengths()

    original: dict[str, Callable[..., int]] = {
        name: getattr(module, name)
        for name in ("pair", "determinant_2x2", "expansion_sum", "expansion_product")
        if hasattr(module, name)
    }

    def pair(high: float, low: float, h: FloatArray) -> int:
        known.put(h, 2)
        return original["pair"](high, low, h)

    def determinant_2x2(*arguments: Any) -> int:
        known.put(arguments[8], 16, arguments[9])
        assert len(arguments[9]) >= 32
        return original["determinant_2x2"](*arguments)

    def expansion_sum(e: FloatArray, ne: int, f: FloatArray, nf: int, h: FloatArray) -> int:
        assert ne <= known.of(e)
        assert nf <= known.of(f)
        known.put(h, known.of(e) + known.of(f), e, f)
        return original["expansion_sum"](e, ne, f, nf, h)

    def expansion_product(
        e: FloatArray, ne: int, f: FloatArray, nf: int, h: FloatArray, scaled: FloatArray, total: FloatArray
    ) -> int:
        longest = 2 * known.of(e) * known.of(f)
        known.put(h, longest, e, f, scaled, total)
        assert len(scaled) >= 2 * known.of(e)
        assert len(total) >= longest
        return original["expansion_product"](e, ne, f, nf, h, scaled, total)

    for function in (pair, determinant_2x2, expansion_sum, expansion_product):
        if function.__name__ in original:
            patch.setattr(module, function.__name__, function)
