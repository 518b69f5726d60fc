"""Hypothesis strategies for planar straight line graphs: T-junctions, overlaps, duplicates, isolated points, rings."""

from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple

from hypothesis import strategies as st
from proofs_tests import oracles
from proofs_tests.constrained_oracle import Segment, chain, crosses, noded
from proofs_tests.kernel_strategies import Point
from proofs_tests.mesh_strategies import point_sets

__all__ = ["Graph", "graphs", "ring_sets"]


class Graph(NamedTuple):
    """What a PSLG is made of."""

    points: list[Point]
    segments: list[Segment]


def planar(points: list[Point], wanted: list[Segment]) -> list[Segment]:
    """Take the segments one by one, but those without length, repeated, or through the inside of an earlier one."""
    exact = oracles.rationals(points)
    kept: list[Segment] = []
    for i, j in wanted:
        if exact[i] == exact[j] or (i, j) in kept or (j, i) in kept:
            continue
        pieces = noded(exact, [(i, j)])
        if not any(crosses(exact, p, q) for p in pieces for q in noded(exact, kept)):
            kept.append((i, j))
    return kept


@st.composite
def small_grids(draw: st.DrawFn, most: int) -> list[Point]:
    """Points of a small grid, so that most are collinear or cocircular with others; some twice."""
    wide, high = draw(st.sampled_from([(2, 2), (3, 2), (4, 1), (3, 3), (5, 5)]))
    cell = st.tuples(st.integers(0, wide).map(float), st.integers(0, high).map(float))
    points = draw(st.lists(cell, min_size=3, max_size=most))
    extra: list[Point] = [(0.0, 0.0), (1.0, 0.0), (-0.0, 1.0)]
    return draw(st.permutations([*points, *extra]))


@st.composite
def graphs(draw: st.DrawFn, most: int = 7) -> Graph:
    """Segments between points of any family that do not cross; over vertices, over each other, at duplicates."""
    points = draw(st.one_of(small_grids(most), small_grids(most), point_sets(most)))
    index = st.integers(0, len(points) - 1)
    wanted = draw(st.lists(st.tuples(index, index), max_size=12))
    return Graph(points, planar(points, wanted))


@st.composite
def ring_sets(draw: st.DrawFn) -> Graph:
    """Rings on a small grid: each a cycle of segments, which touch, overlap and nest; crossings left out ring-wise.

    Every ring has points of its own, as rings from elsewhere do; so an edge that two of them share is there twice.
    """
    cell = st.tuples(st.integers(0, 4).map(float), st.integers(0, 4).map(float))
    rings = draw(st.lists(st.lists(cell, min_size=3, max_size=5, unique=True), min_size=1, max_size=4))
    points: list[Point] = draw(st.lists(cell, max_size=2))
    segments: list[Segment] = []
    for ring in rings:
        first = len(points)
        rows = [*range(first, first + len(ring)), first]
        tried = points + ring
        if len(planar(tried, [*segments, *pairwise(rows)])) == len(segments) + len(ring):
            points = tried
            segments += pairwise(rows)
    return Graph(points, segments)


def interior_points(graph: Graph) -> list[tuple[Fraction, Fraction]]:
    """Vertices on the inside of segments, for tests of the strategies themselves."""
    exact = oracles.rationals(graph.points)
    return [exact[v] for s in graph.segments for v in chain(exact, s)[1:-1]]
