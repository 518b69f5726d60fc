"""Points in special position: on grids, turned grids, circles and lines."""

from functools import cache
from math import isqrt

import numpy as np
from hypothesis import strategies as st

from exactkernel.types import FloatArray
from exactmesh.errors import OptionError
from exactmesh.strategies.drawing import Words, check_integer, check_sizes, codes, distinct, scattered, seeds, shuffled

__all__ = ["cocircular_points", "collinear_points", "grid_points", "tilted_grid_points"]

#: Radii of circles about the origin, products of primes 4k + 1, with their numbers of integer points.
_CIRCLES = ((1, 4), (5, 12), (25, 20), (65, 36), (325, 60), (1105, 108), (5525, 180), (32045, 324), (160225, 540))
_SLOPES = ((1, 0), (1, 1), (0, 1), (2, 1), (3, 7), (5, 3))
_MOST_ULPS = 100


def grid_points(*, min_size: int = 3, max_size: int = 20) -> st.SearchStrategy[FloatArray]:
    """Draw a grid, row by row or in random order, the last row perhaps not full; distinct.

    Everything is collinear and cocircular: ties that are broken one way here and another way there leave holes and
    overlaps. With a spacing such as 0.1 the ties are off by rounding.

    Args:
        min_size, max_size: how many points.

    Returns:
        A strategy for float64 (n, 2). It shrinks to spacing 1, and to one column.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import grid_points
    >>> find(grid_points(), lambda points: [1, 1] in points.tolist()).tolist()
    [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]
    """
    check_sizes(min_size, max_size)
    return _grid(min_size, max_size)


@st.composite
def _cells(draw: st.DrawFn, low: int, high: int) -> FloatArray:
    """The cells of a grid, some columns wide."""
    size, columns, seed = draw(st.integers(low, high)), draw(st.integers(1, 2 * isqrt(high) + 1)), draw(seeds)
    rows, rest = np.divmod(shuffled(seed, size), np.uint64(min(columns, max(1, size))))
    return np.stack([rest, rows], axis=1).astype(np.float64)


@st.composite
def _grid(draw: st.DrawFn, low: int, high: int) -> FloatArray:
    cells = draw(_cells(low, high))
    return cells * draw(st.sampled_from((1.0, 0.1, 1 / 3, 0.7, 1e-9, 1e9)))


def tilted_grid_points(*, min_size: int = 3, max_size: int = 20) -> st.SearchStrategy[FloatArray]:
    """Draw an integer grid turned by a multiple of a thousandth of a degree, distinct.

    Each row is almost collinear, each cell almost cocircular, by the last bit: what decides by floats contradicts
    itself. A 10 x 10 grid turned by 302.328 degrees makes scipy return 162 triangles instead of 185.

    Args:
        min_size, max_size: how many points.

    Returns:
        A strategy for float64 (n, 2). It shrinks to 0 degrees.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import tilted_grid_points
    >>> find(tilted_grid_points(), lambda points: points.min() < -0.5).shape
    (3, 2)
    """
    check_sizes(min_size, max_size)
    return _tilted(min_size, max_size)


@st.composite
def _tilted(draw: st.DrawFn, low: int, high: int) -> FloatArray:
    x, y = draw(_cells(low, high)).T
    angle = np.radians(draw(st.integers(0, 359_999)) / 1000)
    c, s = (1.0, 0.0) if angle == 0 else (np.cos(angle), np.sin(angle))
    return np.stack([c * x - s * y, s * x + c * y], axis=1)


def cocircular_points(*, min_size: int = 3, max_size: int = 20) -> st.SearchStrategy[FloatArray]:
    """Draw points of a circle, distinct: integer points exactly on it, or points of a regular polygon, rounded.

    Every triangulation of exactly cocircular points is Delaunay, but few codes agree with themselves on one. Of the
    rounded ones only exact arithmetic finds the Delaunay triangulation.

    Args:
        min_size, max_size: how many points.

    Returns:
        A strategy for float64 (n, 2). It shrinks to (1, 0), (0, 1), (-1, 0), (0, -1), or to the circle through (3, 4).

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import cocircular_points
    >>> sorted(find(cocircular_points(), lambda points: len(points) == 4).tolist())
    [[-1.0, 0.0], [0.0, -1.0], [0.0, 1.0], [1.0, 0.0]]
    """
    check_sizes(min_size, max_size)
    return _cocircular(min_size, max_size)


@cache
def circle(radius: int) -> FloatArray:
    """Return the integer points at that distance from the origin, counterclockwise from (radius, 0)."""
    x = np.arange(radius + 1, dtype=np.int64)
    y = np.round(np.sqrt((radius * radius - x * x).astype(np.float64))).astype(np.int64)
    hit = x * x + y * y == radius * radius
    quarter = np.stack([x[hit], y[hit]], axis=1)[:0:-1]  # without (0, radius): that is the next quarter's
    whole = [quarter]
    for _ in range(3):
        x, y = whole[-1].T
        whole.append(np.stack([-y, x], axis=1))
    return np.concatenate(whole).astype(np.float64)


@st.composite
def _cocircular(draw: st.DrawFn, low: int, high: int) -> FloatArray:
    size, seed = draw(st.integers(low, high)), draw(seeds)
    is_rounded, larger = draw(st.booleans()), draw(st.integers(0, 2))
    shift = draw(st.sampled_from((0, 1, 1000, 2**20, 2**30)))
    if is_rounded or size > _CIRCLES[-1][1]:
        corners = size + draw(st.integers(0, size))
        angles = 2 * np.pi * shuffled(seed, corners)[:size].astype(np.float64) / corners
        return np.stack([np.cos(angles), np.sin(angles)], axis=1)
    fitting = [radius for radius, count in _CIRCLES if count >= size]
    points = circle(fitting[min(larger, len(fitting) - 1)])
    return points[shuffled(seed, len(points))[:size].astype(np.int64)] + float(shift)


def collinear_points(*, min_size: int = 3, max_size: int = 20, ulps: int = 2) -> st.SearchStrategy[FloatArray]:
    """Draw points of a line, each coordinate moved by at most so many ulps; distinct.

    Orientations of triples are right only if they are exact: float predicates see left turns, right turns and none in
    any order, which makes flat or inverted triangles and hulls that are not convex. With ``ulps=0`` sets are exactly
    collinear where the slope and the spacing allow it, and have no triangulation at all.

    Args:
        min_size, max_size: how many points.
        ulps: how many doubles away from its place a coordinate may be.

    Returns:
        A strategy for float64 (n, 2). It shrinks to consecutive integer points of a horizontal line, unmoved.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order; ulps that are not between 0 and 100.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import collinear_points
    >>> find(collinear_points(), lambda points: len(points) == 3).tolist()
    [[1.0, 1.0], [2.0, 1.0], [3.0, 1.0]]
    """
    check_sizes(min_size, max_size)
    check_integer("ulps", ulps)
    if not 0 <= ulps <= _MOST_ULPS:
        raise OptionError(f"ulps={ulps} is not in 0 .. {_MOST_ULPS}")
    return _collinear(min_size, max_size, ulps)


@st.composite
def _collinear(draw: st.DrawFn, low: int, high: int, ulps: int) -> FloatArray:
    numbers, seed = draw(codes(low, high)), draw(seeds)
    direction, is_falling = draw(st.sampled_from(_SLOPES)), draw(st.booleans())
    scale = draw(st.sampled_from((1.0, 0.1, 1 / 3, 1e-5)))
    points: FloatArray = 1.0 + numbers[:, None].astype(np.float64) * np.array(direction)
    points *= scale * np.array([-1.0 if is_falling else 1.0, 1.0])
    if seed == 0 or ulps == 0:
        return points
    return distinct(points + np.spacing(points) * _moves(seed, numbers, ulps))


def _moves(seed: int, numbers: Words, ulps: int) -> FloatArray:
    pairs = np.stack([numbers << np.uint64(1), numbers << np.uint64(1) | np.uint64(1)], axis=1)
    return (scattered(seed, pairs) % np.uint64(2 * ulps + 1)).astype(np.float64) - ulps
