"""The strategies of hypothesis without its engine: the same functions draw, a plain generator of numbers chooses."""

import random
from collections.abc import Callable
from typing import Any, TypeVar, cast

from hypothesis.strategies import SearchStrategy

__all__ = ["Drawer", "NotUnderstoodError"]

T = TypeVar("T")


class NotUnderstoodError(TypeError):
    """A strategy of a kind that no family used when this was written."""


class Drawer:
    """What a composite strategy calls ``draw``.

    Hypothesis records every choice, to be able to shrink it, and takes milliseconds for what takes microseconds. It
    does not say what its strategies are made of: that is looked up by the names of their classes, and
    :class:`NotUnderstoodError` tells of a name that is new.
    """

    def __init__(self, seed: int) -> None:
        self.chance = random.Random(seed)

    def __call__(self, strategy: SearchStrategy[T]) -> T:
        inner: Any = strategy  # what hypothesis calls its own is not typed
        while type(inner).__name__ == "LazyStrategy":
            inner = inner.wrapped_strategy
        way = _WAYS.get(type(inner).__name__)
        if way is None:
            raise NotUnderstoodError(f"{type(inner).__name__} is no strategy that a plain generator can draw from")
        return cast("T", way(self, inner))


def _integer(draw: Drawer, it: Any) -> int:
    return draw.chance.randint(it.start, it.end)


def _bytes(draw: Drawer, it: Any) -> bytes:
    return draw.chance.randbytes(draw.chance.randint(it.min_size, int(it.max_size)))


_WAYS: dict[str, Callable[[Drawer, Any], object]] = {
    "IntegersStrategy": _integer,
    "BytesStrategy": _bytes,
    "BooleansStrategy": lambda draw, _: draw.chance.random() < 0.5,
    "SampledFromStrategy": lambda draw, it: draw.chance.choice(it.elements),
    "JustStrategy": lambda _, it: it.elements[0],
    "MappedStrategy": lambda draw, it: it.pack(draw(it.mapped_strategy)),
    "OneOfStrategy": lambda draw, it: draw(draw.chance.choice(it.original_strategies)),
    "CompositeStrategy": lambda draw, it: it.definition(draw, *it.args, **it.kwargs),
}
