"""Inputs in portions, in this process or in several."""

import multiprocessing
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import partial

from proofs_tests.differential.comparing import disagreements
from proofs_tests.differential.families import Given, drawn, named
from proofs_tests.differential.reducing import reduced, size_of

__all__ = ["Disagreement", "Portion", "compared", "portions", "smallest"]

_AT_ONCE = 500


@dataclass(frozen=True, slots=True)
class Disagreement:
    """An input, by its names, and in what the library and brute force differ on it."""

    family: str
    seed: int
    number: int
    sentences: tuple[str, ...]


@dataclass(slots=True)
class Portion:
    """What came of some inputs."""

    inputs: Counter[str] = field(default_factory=Counter)
    disagreements: list[Disagreement] = field(default_factory=list)


def compared(seed: int, numbers: range) -> Portion:
    """Compare the inputs of these numbers."""
    portion = Portion()
    for number in numbers:
        family, given = named(seed, number)
        portion.inputs[family] += 1
        sentences = _sentences(given)
        if sentences:
            portion.disagreements.append(Disagreement(family, seed, number, sentences))
    return portion


def _sentences(given: Given) -> tuple[str, ...]:
    """An error that nobody expects is a disagreement, too."""
    try:
        return tuple(disagreements(given))
    except Exception as error:
        return (f"{type(error).__name__}: {error}",)


def portions(seed: int, inputs: int, processes: int) -> Iterator[Portion]:
    """Yield the portions of so many inputs, in any order."""
    ranges = [range(start, min(start + _AT_ONCE, inputs)) for start in range(0, inputs, _AT_ONCE)]
    work = partial(compared, seed)
    if processes == 1:
        yield from map(work, ranges)
        return
    with multiprocessing.get_context("spawn").Pool(processes) as pool:
        yield from pool.imap_unordered(work, ranges)


def smallest(found: list[Disagreement]) -> tuple[Disagreement, Given]:
    """Return the disagreement on the smallest input, and what is left of that when it is reduced."""
    inputs = [(drawn(one.family, one.seed, one.number), one) for one in found]
    given, one = min(inputs, key=lambda pair: size_of(pair[0]))
    return one, reduced(given, lambda smaller: bool(_sentences(smaller)))
