"""The point sets: easy, degenerate and real-world shapes, by name and size, always the same."""

from collections.abc import Callable

import numpy as np

from exactkernel.types import FloatArray

__all__ = ["INPUTS", "points_of"]


def _uniform(n: int, rng: np.random.Generator) -> FloatArray:
    return rng.random((n, 2))


def _grid(n: int, rng: np.random.Generator) -> FloatArray:
    """An integer grid, shuffled: every cell is a tie."""
    side = round(n**0.5)
    grid = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2).astype(np.float64)
    return rng.permutation(grid)


def _circle(n: int, rng: np.random.Generator) -> FloatArray:
    """Points rounded onto a circle: every test is nearly a tie."""
    angle = rng.random(n) * 2.0 * np.pi
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _clusters(n: int, rng: np.random.Generator) -> FloatArray:
    """A hundred clusters of a millionth of the whole."""
    centres = rng.random((100, 2))
    return centres[rng.integers(0, len(centres), n)] + 1e-6 * rng.normal(size=(n, 2))


def _line(n: int, rng: np.random.Generator) -> FloatArray:
    """Points a few units in the last place off a slanted line: every orientation is nearly a tie."""
    x = rng.random(n)
    y = x / 3.0
    return np.stack([x, y + rng.integers(-2, 3, n) * np.spacing(y)], axis=1)


#: name -> (maker, points, what it is)
INPUTS: dict[str, tuple[Callable[[int, np.random.Generator], FloatArray], int, str]] = {
    "uniform": (_uniform, 1_000_000, "1,000,000 uniform points"),
    "grid": (_grid, 1_000_000, "1000 x 1000 integer grid"),
    "circle": (_circle, 200_000, "200,000 points rounded onto a circle"),
    "clusters": (_clusters, 1_000_000, "1,000,000 points in 100 tight clusters"),
    "line": (_line, 200_000, "200,000 points nearly on a line"),
}


def points_of(name: str, n: int | None = None) -> FloatArray:
    """Return the point set of that name, float64 (n, 2)."""
    make, size, _ = INPUTS[name]
    return make(size if n is None else n, np.random.default_rng(1))
