"""A smaller input with the same fault: fewer segments, fewer points, fewer digits. Greedy, one change at a time."""

from collections.abc import Callable, Iterator

import numpy as np

from exactkernel.types import FloatArray
from exactmesh.conformance.given import Given, digits

__all__ = ["reduced"]

_DIGITS = (0, 1, 2, 3, 4, 6, 8, 12)  # decimals that are tried
_POWERS = (0, 1, 2, 3, 6, 9)  # of ten, instead of a larger one
_EXPONENTS = (4, 7, 10, 20)  # of two, which the largest coordinate is brought to


def reduced(given: Given, is_legal: Callable[[Given], bool], still: Callable[[Given], bool]) -> Given:
    """Return an input on which ``still`` holds, from which no single step leads to a smaller one.

    A step leaves out segments or points (half of them, a quarter, ... one), moves all points to the origin, scales
    them, or rounds coordinates, all or one. ``still`` is called for smaller legal inputs only, whose traits the given
    one has, too; if it answers False to everything, as when a budget is spent, the search ends soon.
    """
    best = given

    def accept(candidate: Given) -> bool:
        nonlocal best
        if not is_legal(candidate) or candidate.size >= best.size:
            return False
        if not candidate.traits <= given.traits or not still(candidate):
            return False
        best = candidate
        return True

    while True:
        before = best
        _drop(lambda: _without_segments(best), accept)
        _drop(lambda: _without_points(best), accept)
        for candidate in _moved(best):
            accept(candidate)
        for v in range(len(best.points)):
            for axis in (0, 1):
                _simplify(best, v, axis, accept)
        if best is before:
            return best


def _drop(candidates: Callable[[], Iterator[Given]], accept: Callable[[Given], bool]) -> None:
    """Accept candidates until none is accepted any more."""
    while any(accept(candidate) for candidate in candidates()):
        pass


def _spans(n: int) -> Iterator[tuple[int, int]]:
    """Yield half-open ranges: halves, quarters, and so on down to single ones."""
    length = n // 2
    while length:
        yield from ((start, min(start + length, n)) for start in range(0, n, length))
        length //= 2


def _without_segments(given: Given) -> Iterator[Given]:
    if given.segments is not None:
        for start, end in _spans(len(given.segments)):
            yield Given(given.points, np.delete(given.segments, slice(start, end), axis=0))


def _without_points(given: Given) -> Iterator[Given]:
    """Yield the input without some points, and without the segments that end in them."""
    n = len(given.points)
    for start, end in _spans(n):
        points = np.delete(given.points, slice(start, end), axis=0)
        if given.segments is None:
            yield Given(points)
            continue
        renamed = np.arange(n) - np.clip(np.arange(n) - start, 0, end - start)
        gone = (given.segments >= start) & (given.segments < end)
        yield Given(points, renamed[given.segments[~gone.any(axis=1)]])
        if end - start == 1 and gone.any(axis=1).sum() == 2:  # a vertex of a ring: its neighbours are joined
            a, b = (int(v) for v in given.segments[gone.any(axis=1)][~gone[gone.any(axis=1)]])
            joined = [*given.segments[~gone.any(axis=1)].tolist(), (a, b)]
            if a != b:
                yield Given(points, renamed[np.array(joined, dtype=np.int64)])


def _moved(given: Given) -> Iterator[Given]:
    with np.errstate(all="ignore"):
        for shift in (given.points.min(axis=0), given.points[0]) if len(given.points) else ():
            yield from _finite(given, given.points - shift)
        for scaled in _scaled(given.points):
            yield from _finite(given, np.round(scaled) + 0.0)
            yield from _finite(given, scaled)
        for digits in _DIGITS:
            yield from _finite(given, np.round(given.points, digits) + 0.0)


def _scaled(points: FloatArray) -> Iterator[FloatArray]:
    """Yield the points times a power of two, so that the largest coordinate is of everyday size."""
    exponent = int(np.frexp(np.abs(points).max(initial=0.0))[1])
    for wanted in _EXPONENTS:
        if exponent != wanted:
            yield np.ldexp(points, wanted - exponent)


def _finite(given: Given, points: FloatArray) -> Iterator[Given]:
    if np.isfinite(points).all():
        yield Given(points, given.segments)


def _simplify(given: Given, v: int, axis: int, accept: Callable[[Given], bool]) -> None:
    """Try simpler values of one coordinate, the simplest first, until one is accepted."""
    value = float(given.points[v, axis])
    for simpler in _simpler(value):
        if digits(simpler) < digits(value):
            points = given.points.copy()
            points[v, axis] = simpler
            if accept(Given(points, given.segments)):
                return


def _simpler(value: float) -> Iterator[float]:
    yield 0.0
    yield from (1.0, -1.0)
    leading, _, exponent = f"{value:.0e}".partition("e")
    most = abs(int(exponent))
    tamer = sorted({power for power in (*_POWERS, most // 2) if power < most})
    yield from (float(f"{leading}e{exponent[0]}{power}") for power in tamer)
    yield from (float(f"{value:.{digits}g}") for digits in range(1, 17))
