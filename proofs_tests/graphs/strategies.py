"""Hypothesis strategies for planar straight line graphs: T-junctions, overlaps, duplicates, isolated points, rings."""

from itertools import pairwise
from typing import NamedTuple

from hypothesis import strategies as st
from proofs_tests import oracles
from proofs_tests.kernel.strategies import Point
from proofs_tests.mesh.constrained_oracle import Segment, crosses, noded
from proofs_tests.mesh.strategies import point_sets

__all__ = ["Graph", "Seeded", "graphs", "grid_graphs", "ring_sets", "seeded"]


class Graph(NamedTuple):
    """What a PSLG is made of."""

    points: list[Point]
    segments: list[Segment]


class Seeded(NamedTuple):
    """A graph, seeds of holes and regions, and the rule; the seeds may lie anywhere."""

    graph: Graph
    holes: list[Point]
    regions: list[tuple[float, float, float, float]]
    even_odd: bool


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
    if draw(st.booleans()):
        rings.insert(0, [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)])
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


@st.composite
def grid_graphs(draw: st.DrawFn) -> Graph:
    """Many segments between neighbors on a grid, so that they close faces; mostly within a frame of long ones."""
    points = draw(st.permutations([(float(x), float(y)) for x in range(4) for y in range(4)]))
    index = st.integers(0, 15)
    corners = [points.index(corner) for corner in ((0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0))]
    frame = [*pairwise([*corners, corners[0]])] if draw(st.integers(0, 7)) else []
    near = draw(st.lists(st.tuples(index, st.sampled_from([(0, 1), (1, 0), (1, 1), (3, 0)])), max_size=30))
    wanted = frame
    for i, (dx, dy) in near:
        other = (points[i][0] + dx, points[i][1] + dy)
        if other in points:
            wanted.append((i, points.index(other)))
    return Graph(points, planar(points, wanted))


@st.composite
def seeded(draw: st.DrawFn) -> Seeded:
    """Rings or grid graphs with seeds at quarter steps, so that few lie on segments."""
    rings = draw(st.booleans())
    graph = draw(ring_sets() if rings else grid_graphs())
    step = st.integers(0, 4)
    seed = st.tuples(step.map(lambda i: i + 0.25), step.map(lambda i: i + 0.375))
    value = st.integers(0, 2).map(float)
    holes = draw(st.lists(seed, max_size=2))
    regions = [(x, y, draw(value), -1.0) for x, y in draw(st.lists(seed, max_size=3))]
    return Seeded(graph, holes, regions, rings and draw(st.booleans()))
