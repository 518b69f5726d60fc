"""Hypothesis strategies for segments that meet in every hard way."""

import math

import numpy as np
from hypothesis import strategies as st
from proofs_tests.kernel.strategies import Point, few_ulps, moved, unit
from proofs_tests.mesh.strategies import point_sets

from exactkernel.types import FloatArray

__all__ = ["SEVEN", "Drawing", "bundle", "drawings", "near_bundles"]

Drawing = tuple[list[Point], list[tuple[int, int]]]


@st.composite
def joined(draw: st.DrawFn, points: list[Point], most: int = 7) -> Drawing:
    """Some segments between given points, of positive length, no two with the same ends."""
    pairs = [
        (i, j) for i in range(len(points)) for j in range(i) if points[i] != points[j]
    ]  # fmt: skip
    if not pairs:
        return points, []
    chosen = draw(st.lists(st.sampled_from(pairs), max_size=most, unique=True))
    turned = draw(st.lists(st.booleans(), min_size=len(chosen), max_size=len(chosen)))
    return points, [(j, i) if turn else (i, j) for (i, j), turn in zip(chosen, turned, strict=True)]


@st.composite
def on_grids(draw: st.DrawFn) -> Drawing:
    """Integer points: concurrent segments, T-junctions, overlaps; shifted far off or scaled, some points twice."""
    side = draw(st.sampled_from([2, 3, 6]))
    step = st.integers(-side, side)
    offset = draw(st.sampled_from([0, 0, 1, 10**6, 2**40]))
    exponent = draw(st.sampled_from([0, 0, -3, -1074, 900]))
    if exponent == 900:
        offset = 0
    cells = draw(st.lists(st.tuples(step, step), min_size=3, max_size=9))
    points = [(math.ldexp(x + offset, exponent), math.ldexp(y - offset, exponent)) for x, y in cells]
    return draw(joined(points))


@st.composite
def near_bundles(draw: st.DrawFn) -> Drawing:
    """Segments through nearly one point; perhaps a point there as well."""
    cx, cy = draw(unit), draw(unit)
    points: list[Point] = []
    for _ in range(draw(st.integers(2, 6))):
        angle, r, s = draw(st.floats(0.0, 3.2)), draw(st.floats(0.01, 1.0)), draw(st.floats(0.01, 1.0))
        dx, dy = math.cos(angle), math.sin(angle)
        points.append((cx - r * dx, cy - r * dy))
        points.append((moved(cx + s * dx, draw(few_ulps)), moved(cy + s * dy, draw(few_ulps))))
    segments = [(i, i + 1) for i in range(0, len(points), 2) if points[i] != points[i + 1]]
    if draw(st.booleans()):
        points.append((moved(cx, draw(few_ulps)), moved(cy, draw(few_ulps))))
    return points, segments


@st.composite
def of_few_ulps(draw: st.DrawFn) -> Drawing:
    """Points on the doubles around one: hardly any room to round to."""
    ulps = st.integers(-6, 6)
    cx, cy = draw(st.sampled_from([1.0, 0.1, 3e5])), draw(st.sampled_from([1.0, 0.7]))
    cells = draw(st.lists(st.tuples(ulps, ulps), min_size=4, max_size=9))
    return draw(joined([(moved(cx, i), moved(cy, j)) for i, j in cells]))


def drawings() -> st.SearchStrategy[Drawing]:
    """Points and segments of every one of the families."""
    return st.one_of(on_grids(), near_bundles(), of_few_ulps(), point_sets(8).flatmap(joined))


#: Number 7 of the corpus: three segments, 0-1, 2-3, 4-5, nearly through one point.
SEVEN = np.array(
    [
        (-0.6616708319446925, 0.043023726210314694), (1.3283374986113592, 0.242690559503971),
        (-0.029024421143340307, -0.7891819431100835), (0.6956910878100069, 1.074896228824369),
        (0.9996093546131575, -0.6028480693195775), (-0.3329426879464908, 0.888562355033863),
    ]
)  # fmt: skip


def bundle(seed: int) -> tuple[FloatArray, list[tuple[int, int]]]:
    """A near-concurrent bundle of the corpus: 3 to 7 segments through one random point of the unit square."""
    rng = np.random.default_rng(seed)
    k = int(rng.integers(3, 8))
    c = rng.random(2)
    ends = []
    for angle in rng.random(k) * np.pi:
        direction = np.array([np.cos(angle), np.sin(angle)])
        ends += [c - rng.random() * direction, c + rng.random() * direction]
    return np.array(ends), [(2 * i, 2 * i + 1) for i in range(k)]
