"""Cases after the tests of npm's robust-orientation 1.2.1 and robust-in-sphere 1.2.1 (Mikola Lysenko, MIT licence).

Of the packages of peers that were looked through, these two ship cases; here they are with signs of our own.
"""

from collections.abc import Iterator

__all__ = ["PUBLISHED"]

Values = tuple[float, ...]


def powers(n: int) -> Iterator[float]:
    """Yield 1e-64 times powers of ten, rounded at each step."""
    x = 1e-64
    for _ in range(n):
        yield x
        x *= 10


def orient2d() -> Iterator[Values]:
    """Three points on a line or nearly so, over two hundred orders of magnitude."""
    yield 0.1, 0.1, 0.1, 0.1, 0.3, 0.7
    yield 0.0, 0.0, -1e-64, 0.0, 0.0, 1.0
    yield 0.0, 0.0, 1e-64, 1e-64, 1.0, 1.0
    yield 0.0, 0.0, 1e-64, 0.0, 0.0, 1.0
    for x in powers(200):
        for y in (1.0, 0.0, -1.0):
            yield -x, 0.0, 0.0, y, x, 0.0
        yield 0.0, 1.0, 0.0, 0.0, x, x


def incircle() -> Iterator[Values]:
    """A triangle of any size, and a point inside, outside, and at a corner."""
    for x in (-0.5, -1.0, -1.5):
        yield 0.0, -1.0, 1.0, 0.0, 0.0, 1.0, x, 0.0
    for x in powers(128):
        for y in (0.0, 2 * x, x):
            yield 0.0, x, -x, -x, x, -x, 0.0, y


PUBLISHED = {"orient2d": orient2d, "incircle": incircle}
FAMILY = "published: after the tests of npm's robust-orientation and robust-in-sphere 1.2.1 (MIT licence)"
