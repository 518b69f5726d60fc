"""Points of every family, and points that come more than once."""

from functools import cache

import numpy as np
from hypothesis import strategies as st

from exactkernel.types import FloatArray
from exactmesh.strategies.drawing import check_sizes, codes, seeds, shuffled
from exactmesh.strategies.regular import cocircular_points, collinear_points, grid_points, tilted_grid_points
from exactmesh.strategies.scattered import (
    clustered_points,
    far_points,
    mixed_scale_points,
    subnormal_points,
    uniform_points,
)

__all__ = ["duplicate_points", "points"]


def points(*, min_size: int = 3, max_size: int = 20) -> st.SearchStrategy[FloatArray]:
    """Draw points of any family.

    Sets may be collinear, have no triangulation then, and have points twice; all coordinates are finite.

    Args:
        min_size, max_size: how many points.

    Returns:
        A strategy for float64 (n, 2).

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order.

    >>> from hypothesis import given, settings
    >>> from exactmesh.strategies import points
    >>> @settings(max_examples=30, deadline=None)
    ... @given(points(min_size=3, max_size=10))
    ... def test_hull(points):
    ...     assert 3 <= len(points) <= 10
    >>> test_hull()
    """
    check_sizes(min_size, max_size)
    return _of_one_family(min_size, max_size) | duplicate_points(min_size=min_size, max_size=max_size)


@cache
def _of_one_family(low: int, high: int) -> st.SearchStrategy[FloatArray]:
    families = (  # what fails shrinks to the first that fails
        *(uniform_points, tilted_grid_points, cocircular_points, collinear_points, far_points),
        *(clustered_points, mixed_scale_points, subnormal_points, grid_points),
    )
    return st.one_of([family(min_size=low, max_size=high) for family in families])


def duplicate_points(*, min_size: int = 3, max_size: int = 20) -> st.SearchStrategy[FloatArray]:
    """Draw points of any other family, some of them more than once; a zero may be -0.0 in one of the copies.

    Zero-length edges and triangles without area, endless loops, and vertices that no triangle uses.

    Args:
        min_size, max_size: how many points, the copies counted.

    Returns:
        A strategy for float64 (n, 2).

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import duplicate_points
    >>> find(duplicate_points(), lambda points: True).tolist()
    [[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]]
    """
    check_sizes(min_size, max_size)
    return _duplicates(min_size, max_size)


@st.composite
def _duplicates(draw: st.DrawFn, low: int, high: int) -> FloatArray:
    if high == 0:
        return np.empty((0, 2))
    again = draw(codes(min(1, high - 1), high // 2))
    others, seed = draw(_of_one_family(max(1, low - len(again)), high - len(again))), draw(seeds)
    copies = others[(again % np.uint64(len(others))).astype(np.int64)]
    if seed % 2:
        copies = np.where(copies == 0, -copies, copies)
    return np.concatenate([others, copies])[shuffled(seed, len(others) + len(copies)).astype(np.int64)]
