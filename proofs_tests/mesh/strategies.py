"""Hypothesis strategies for point sets that are hard to triangulate, duplicates among them."""

import math

from hypothesis import strategies as st
from proofs_tests.kernel.strategies import Point, lattice, mixed, near_circle, near_line, on_circle, unit

__all__ = ["point_sets", "small_grid_sets"]

Points = tuple[Point, ...]


@st.composite
def uniform(draw: st.DrawFn, n: int) -> Points:
    return tuple(draw(st.lists(st.tuples(unit, unit), min_size=n, max_size=n)))


@st.composite
def clustered(draw: st.DrawFn, n: int) -> Points:
    """A few centres, each with points so near that only the last bits differ, and lone points far away."""
    centres = draw(st.lists(st.tuples(unit, unit), min_size=1, max_size=3))
    radius = 2.0 ** draw(st.integers(-60, -20))
    points = []
    for _ in range(n):
        x, y = draw(st.sampled_from(centres))
        points.append((x + radius * draw(unit), y + radius * draw(unit)))
    return tuple(points)


@st.composite
def far_off(draw: st.DrawFn, n: int) -> Points:
    """Numbers of a few bits behind a large offset: what makes float meshers drop points."""
    offset = draw(st.sampled_from([1e5, 1e6, -1e9, 2.0**45]))
    return tuple((x + offset, y + offset) for x, y in draw(uniform(n)))


@st.composite
def scales(draw: st.DrawFn, n: int) -> Points:
    """Each point at a distance of its own from the origin, over all exponents."""
    exponent = st.integers(-1070, 1020)
    return tuple((math.ldexp(draw(unit), draw(exponent)), math.ldexp(draw(unit), draw(exponent))) for _ in range(n))


FAMILIES = (uniform, clustered, far_off, scales, near_line, near_circle, lattice, on_circle, mixed)


@st.composite
def point_sets(draw: st.DrawFn, most: int = 10) -> list[Point]:
    """Up to so many points of one family or two, some of them twice."""
    n = draw(st.integers(3, most))
    first, second = draw(st.sampled_from(FAMILIES)), draw(st.sampled_from(FAMILIES))
    own = draw(st.sampled_from([n, n, n // 2]))
    points = [*draw(first(own)), *(draw(second(n - own)) if own < n else ())]
    again = draw(st.lists(st.sampled_from(points), max_size=2))
    return draw(st.permutations(points + again))


@st.composite
def small_grid_sets(draw: st.DrawFn) -> list[tuple[int, int]]:
    """Distinct points of a 5 x 5 grid, not all on a line."""
    cell = st.tuples(st.integers(0, 4), st.integers(0, 4))
    others = draw(st.lists(cell, max_size=6))
    return sorted({(0, 0), (1, 0), (0, 1), *others})
