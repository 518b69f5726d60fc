"""Crossings: random segments, ten times as many crossings each time; and what breaks simpler searches."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from statistics import median

import numpy as np

from exactkernel.types import FloatArray, IntArray

__all__ = ["HEAD", "CrossingRow", "cells", "hard_rows", "random_rows"]

HEAD = ["segments", "meetings", "find_crossings", "exponent", "arrange", "exponent", "rounding"]

Drawing = tuple[FloatArray, IntArray]


@dataclass(frozen=True)
class CrossingRow:
    """What one drawing took.

    Attributes:
        name: of the drawing.
        segments, meetings: how many.
        find, arrange: medians in seconds.
        rounding: how the arrangement was rounded.
    """

    name: str
    segments: int
    meetings: int
    find: float
    arrange: float
    rounding: str

    @property
    def size(self) -> int:
        """Segments and meetings: what the time should be proportional to."""
        return self.segments + self.meetings


def between(a: FloatArray, b: FloatArray) -> Drawing:
    """Return segments from the rows of a to those of b."""
    n = len(a)
    return np.concatenate([a, b]), np.stack([np.arange(n), np.arange(n) + n], axis=1).astype(np.int32)


def random_segments(n: int, length: float) -> Drawing:
    """Return n segments of one length anywhere in the unit square, in any direction."""
    rng = np.random.default_rng(1)
    begins, angles = rng.random((n, 2)), rng.random(n) * 2.0 * np.pi
    return between(begins, begins + length * np.stack([np.cos(angles), np.sin(angles)], axis=1))


def _on_a_grid() -> Drawing:
    rng = np.random.default_rng(2)
    begins = rng.integers(0, 101, (10_000, 2))
    ends = np.clip(begins + rng.integers(-15, 16, (10_000, 2)), 0, 100)
    proper = (begins != ends).any(axis=1)
    both = np.unique(np.hstack([begins, ends])[proper].astype(np.float64), axis=0)
    return between(both[:, :2], both[:, 2:])


def _stack() -> Drawing:
    steps = np.arange(100_000)[:, None] / 100_000
    return between(steps * (-0.5, 0.8), steps * (-0.5, 0.8) + (0.8, 0.5))


def _one_over_many() -> Drawing:
    points, _ = random_segments(1_000_000, 1e-4)
    begins, ends = points[:1_000_000], points[1_000_000:]
    return between(np.vstack([begins, [(-1.0, 0.3)]]), np.vstack([ends, [(2.0, 0.7)]]))


def _through_one_point() -> Drawing:
    angles = np.random.default_rng(3).random(1000) * np.pi
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return between(-directions, directions)


def _star() -> Drawing:
    rng = np.random.default_rng(4)
    n = 1_000_000
    angles, radii = np.sort(rng.random(n)) * 2.0 * np.pi, 0.5 + 0.5 * rng.random(n)
    ring = np.stack([np.arange(n), (np.arange(n) + 1) % n], axis=1)
    return np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=1), ring.astype(np.int32)


HARD: dict[str, Callable[[], Drawing]] = {
    "10,000 segments of a 100 x 100 grid": _on_a_grid,
    "100,000 parallel slanted segments": _stack,
    "one segment over 1,000,000 tiny ones": _one_over_many,
    "1,000 segments through one point": _through_one_point,
    "star polygon of 1,000,000 vertices": _star,
}


def _seconds(call: Callable[[], object], rounds: int) -> float:
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return median(times)


def timed(name: str, drawing: Drawing, rounds: int) -> CrossingRow:
    """Time both functions on a drawing."""
    from exactmesh import PSLG
    from exactmesh.crossings import arrange, find_crossings

    points, segments = drawing
    pslg = PSLG(points, segments)
    return CrossingRow(
        name=name,
        segments=len(segments),
        meetings=len(find_crossings(points, segments)),
        find=_seconds(lambda: find_crossings(points, segments), rounds),
        arrange=_seconds(lambda: arrange(pslg), rounds),
        rounding=str(arrange(pslg).rounding),
    )


def random_rows(*, quick: bool = False, rounds: int = 3) -> list[CrossingRow]:
    """Return the rows of random segments: 10,000 of growing length, then more of a shrinking one."""
    timed("warm up", random_segments(100, 0.1), 1)
    sizes = [(10_000, 0.01), (10_000, 0.03), (10_000, 0.1), (10_000, 0.2), (100_000, 0.01), (1_000_000, 0.001)]
    return [timed(f"{n:,} random", random_segments(n, length), rounds) for n, length in (sizes[:2] if quick else sizes)]


def hard_rows(*, rounds: int = 3) -> list[CrossingRow]:
    """Return the rows of the drawings that simpler searches fail on."""
    return [timed(name, make(), rounds) for name, make in HARD.items()]


def _exponent(now: float, before: float, row: CrossingRow, last: CrossingRow | None) -> str:
    if last is None or row.size == last.size:
        return ""
    return f"{math.log(now / before) / math.log(row.size / last.size):.2f}"


def cells(rows: list[CrossingRow], *, growth: bool) -> list[list[str]]:
    """Return the rows as text under HEAD; with ``growth`` the exponents from row to row, by segments and meetings."""
    table = []
    last: CrossingRow | None = None
    for row in rows:
        table.append(
            [
                row.name,
                f"{row.meetings:,}",
                f"{row.find:.3f} s",
                _exponent(row.find, last.find if last else 1.0, row, last),
                f"{row.arrange:.3f} s",
                _exponent(row.arrange, last.arrange if last else 1.0, row, last),
                row.rounding,
            ]
        )
        last = row if growth else None
    return table
