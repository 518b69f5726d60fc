"""Hypothesis strategies for domains where refinement is hard: small angles, slits, near misses, stars, spirals."""

import math

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st
from proofs_tests.graphs.strategies import Graph, graphs, grid_graphs, planar, ring_sets
from proofs_tests.kernel.strategies import Point
from proofs_tests.mesh.constrained_oracle import Segment

from exactmesh import PSLG

__all__ = ["domains", "drawn_domains", "gentle_domains", "hard_domains"]

BOX: list[Point] = [(-8.0, -8.0), (8.0, -8.0), (8.0, 8.0), (-8.0, 8.0)]
FRAME: list[Segment] = [(0, 1), (1, 2), (2, 3), (3, 0)]


def ring(first: int, n: int) -> list[Segment]:
    return [(first + i, first + (i + 1) % n) for i in range(n)]


@st.composite
def wedges(draw: st.DrawFn) -> PSLG:
    """Two segments that meet at a small angle, down to a thousandth of a degree, in a box or as a triangle."""
    degrees = draw(st.sampled_from([0.001, 0.1, 1.0, 5.0, 15.0, 29.0, 45.0, 59.0]))
    turned, ratio = draw(st.floats(0.0, 6.3)), draw(st.floats(0.3, 1.0))
    sides = ((turned, 6.0), (turned + math.radians(degrees), 6.0 * ratio))
    ends = [(side * math.cos(angle), side * math.sin(angle)) for angle, side in sides]
    if draw(st.booleans()):
        return PSLG([(0.0, 0.0), *ends], ring(0, 3))
    return PSLG([*BOX, (0.0, 0.0), *ends], [*FRAME, (4, 5), (4, 6)])


@st.composite
def stars(draw: st.DrawFn) -> PSLG:
    """Spokes in arbitrary directions from one point, of arbitrary lengths, in a box; or a star-shaped polygon."""
    n = draw(st.integers(3, 9))
    turns = st.one_of(st.integers(0, 620).map(lambda i: i / 100.0), st.sampled_from([1e-9, 1e-4, 3.1416]))
    angles = sorted(set(draw(st.lists(turns, min_size=n, max_size=n))))
    tips = [(r * math.cos(t), r * math.sin(t)) for t, r in ((t, draw(st.floats(0.5, 7.0))) for t in angles)]
    tips = list(dict.fromkeys(tips))
    wanted = [(4, 5 + i) for i in range(len(tips))] if draw(st.booleans()) else ring(5, len(tips))
    points = [*BOX, (0.0, 0.0), *tips]
    return PSLG(points, [*FRAME, *planar(points, wanted)])


@st.composite
def near_misses(draw: st.DrawFn) -> PSLG:
    """A point or a parallel segment very near to a segment; a slit; a chain with a step."""
    kind = draw(st.sampled_from(["point", "slit", "parallel", "step", "hole"]))
    # a channel takes as many points as it is long in widths
    gap = 2.0 ** -draw(st.integers(1, 40 if kind in ("point", "slit") else 7))
    x = draw(st.floats(-3.0, 3.0))
    if kind == "point":
        return PSLG([*BOX, (-4.0, 0.0), (4.0, 0.0), (x, gap)], [*FRAME, (4, 5)])
    if kind == "parallel":
        return PSLG([*BOX, (-4.0, 0.0), (4.0, 0.0), (x, gap), (5.0, gap)], [*FRAME, (4, 5), (6, 7)])
    if kind == "slit":
        return PSLG([*BOX, (-8.0, 0.0), (x, gap)], [*FRAME[:3], (3, 4), (4, 0), (4, 5)])
    if kind == "step":
        return PSLG([*BOX, (-4.0, 0.0), (0.0, 0.0), (0.0, gap), (4.0, gap)], [*FRAME, (4, 5), (5, 6), (6, 7)])
    hole = [(-3.0, 8.0 - gap), (3.0, 8.0 - gap), (0.0, 4.0)]
    return PSLG([*BOX, *hole], [*FRAME, *ring(4, 3)], holes=[(0.0, 6.0)])


@st.composite
def spirals(draw: st.DrawFn) -> PSLG:
    """A polyline that winds inwards in a box."""
    n, pitch = draw(st.integers(4, 14)), draw(st.floats(0.05, 0.4))
    points = [((6.0 - pitch * i) * math.cos(0.7 * i), (6.0 - pitch * i) * math.sin(0.7 * i)) for i in range(n)]
    every = [*BOX, *points]
    return PSLG(every, [*FRAME, *planar(every, [(4 + i, 5 + i) for i in range(n - 1)])])


@st.composite
def plates(draw: st.DrawFn) -> PSLG:
    """A rectangle of any aspect with a rectangular hole or region: only right angles."""
    wide = draw(st.sampled_from([1.0, 3.0, 100.0]))
    outer = [(0.0, 0.0), (8 * wide, 0.0), (8 * wide, 8.0), (0.0, 8.0)]
    cells = [draw(st.integers(1, 3)), draw(st.integers(4, 7)), draw(st.integers(1, 3)), draw(st.integers(4, 7))]
    x0, x1, y0, y1 = (float(c) for c in cells)
    inner = [(x0 * wide, y0), (x1 * wide, y0), (x1 * wide, y1), (x0 * wide, y1)]
    middle = ((x0 + x1) * wide / 2, (y0 + y1) / 2)
    area = draw(st.sampled_from([-1.0, 0.5 * wide, 4.0 * wide]))
    kind = draw(st.sampled_from(["plain", "hole", "region"]))
    if kind == "plain":
        return PSLG(outer, ring(0, 4))
    holes, regions = ([middle], None) if kind == "hole" else (None, [(*middle, 1.0, area)])
    return PSLG([*outer, *inner], [*ring(0, 4), *ring(4, 4)], holes=holes, regions=regions)


def _is_domain(graph: Graph) -> bool:
    return len(graph.segments) > 2


@st.composite
def framed(draw: st.DrawFn) -> PSLG:
    """Any small graph, within a frame of its own."""
    graph = draw(st.one_of(graphs(), grid_graphs(), ring_sets()))
    assume(len(graph.points) > 0)
    xy = np.array(graph.points)
    low, high = xy.min(axis=0), xy.max(axis=0)
    reach = max(float((high - low).max()), float(np.abs(xy).max()) * 2.0**-40)
    assume(reach < 2.0**1000)
    (x0, y0), (x1, y1) = (low - reach).tolist(), (high + reach).tolist()
    assume(x0 < low[0] and y0 < low[1] and x1 > high[0] and y1 > high[1])
    n = len(graph.points)
    points = [*graph.points, (x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    return PSLG(points, [*graph.segments, *ring(n, 4)])


def hard_domains() -> st.SearchStrategy[PSLG]:
    return st.one_of(wedges(), stars(), near_misses(), spirals(), framed())


def drawn_domains() -> st.SearchStrategy[PSLG]:
    """Those without extreme coordinates, whose meshes have some thousands of points at most."""
    return st.one_of(wedges(), stars(), near_misses(), spirals(), plates())


def gentle_domains() -> st.SearchStrategy[PSLG]:
    return plates()


@st.composite
def domains(draw: st.DrawFn) -> PSLG:
    """Any of them, of any size."""
    domain = draw(st.one_of(hard_domains(), hard_domains(), gentle_domains()))
    exponent = draw(st.sampled_from([0, 0, 0, -40, 40, -300, 300, -600, 480]))
    if exponent == 0:
        return domain
    with np.errstate(over="ignore", under="ignore"):
        scaled = np.ldexp(domain.points, exponent)
        if not np.isfinite(scaled * 4).all() or (np.ldexp(scaled, -exponent) != domain.points).any():
            return domain
    regions = domain.regions.copy()
    regions[:, :2] = np.ldexp(regions[:, :2], exponent)
    regions[:, 3] = -1.0
    return PSLG(scaled, domain.segments, holes=np.ldexp(domain.holes, exponent), regions=regions)
