"""Triangulations that are right by construction: swept in exact integers, then changed by legal flips."""

from math import isqrt
from typing import NamedTuple

import numpy as np
from hypothesis import reject
from hypothesis import strategies as st

from exactkernel.types import FloatArray, IntArray
from exactmesh.strategies.drawing import check_sizes, seeds, shuffled, words
from exactmesh.strategies.naive import Place, flipped, inner_quads, is_convex, legalized, swept

__all__ = ["PlainMesh", "triangulations"]

_SHIFTS = (0, -6, 10**6, 2**30)
_EXPONENTS = (0, -1, -20, -300, 300)


class PlainMesh(NamedTuple):
    """A triangulation as two arrays.

    Attributes:
        points: float64 (n, 2).
        triangles: int32 (m, 3), counterclockwise.
    """

    points: FloatArray
    triangles: IntArray


def triangulations(*, min_size: int = 3, max_size: int = 12, delaunay: bool = False) -> st.SearchStrategy[PlainMesh]:
    """Draw triangulations of the convex hull of points on a grid, every point used, Delaunay or not.

    They are admissible by construction, in exact integers and by code of their own: sorted points are joined to the
    hull of the earlier ones, then some edges of convex quadrilaterals are flipped. Collinear and cocircular points,
    also on the hull, are frequent.

    Args:
        min_size, max_size: how many points.
        delaunay: whether edges are flipped until all are Delaunay; of cocircular points, whatever remains.

    Returns:
        A strategy for :class:`PlainMesh`. Coordinates are even integers but for a power of two, so that midpoints are
        exact.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order; fewer than 3 points.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import triangulations
    >>> mesh = find(triangulations(), lambda mesh: len(mesh.triangles) == 2)
    >>> mesh.points.tolist()
    [[0.0, 0.0], [2.0, 0.0], [4.0, 0.0], [0.0, 2.0]]
    >>> mesh.triangles.tolist()
    [[3, 0, 1], [3, 1, 2]]
    """
    check_sizes(min_size, max_size, 3)
    return _triangulation(max(3, min_size), max_size, delaunay)


@st.composite
def _triangulation(draw: st.DrawFn, low: int, high: int, delaunay: bool) -> PlainMesh:
    size, seed, room = draw(st.integers(low, high)), draw(seeds), draw(st.integers(1, 30))
    side = (isqrt(size) + 1) * (room if seed else 1)
    numbers = [int(number) for number in shuffled(seed, side * side)[:size]]
    places: list[Place] = [(2 * (number % side), 2 * (number // side)) for number in numbers]
    triangles = swept(places)
    if not triangles:
        reject()
    for word in draw(words(0, 2 * size)).tolist():
        quads = [quad for quad in inner_quads(triangles) if is_convex(places, quad)]
        if quads:
            triangles = flipped(triangles, quads[word % len(quads)])
    if delaunay:
        triangles = legalized(places, triangles)
    shift, exponent = draw(st.sampled_from(_SHIFTS)), draw(st.sampled_from(_EXPONENTS))
    points: FloatArray = np.array(places, dtype=np.float64) + shift
    return PlainMesh(np.ldexp(points, exponent), np.array(triangles, dtype=np.int32))
