"""The arrangement of a PSLG's segments, rounded to doubles so that it stays planar."""

from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property

import numpy as np
from gmpy2 import mpq

from exactkernel.types import FloatArray, IntArray
from exactmesh.columns import MarkerArray, frozen
from exactmesh.crossings.chain_distance import is_anything_moved, largest_distances_squared
from exactmesh.crossings.chains import Chains, LongArray
from exactmesh.crossings.planar import Graph, planar_graph
from exactmesh.crossings.snapping import grid_of
from exactmesh.pslg import PSLG, Carve

__all__ = ["Arrangement", "Rounding", "arrange"]


class Rounding(StrEnum):
    """How the exact arrangement became one of doubles, the mildest way first."""

    EXACT = "exact"
    """Every vertex is a double as it is; nothing was moved."""
    NEAREST = "nearest"
    """Crossings became the nearest doubles, and the pieces still meet in common ends only (perhaps after they were
    noded once more). The points of the input stayed where they are."""
    SNAPPED = "snapped"
    """Where that was not enough, segments were snapped: their vertices, points of the input too, and those nearby went
    to the nearest points of a grid. All others stayed where they were."""


@dataclass(frozen=True, eq=False)
class Arrangement:
    """A planar PSLG and how it came out of another.

    Attributes:
        pslg: segments that meet in common ends only; no point lies inside a segment. Its points are those of the input
            in their order (moved only where ``rounding`` is SNAPPED), then new ones. A new point has marker 0, and
            attributes interpolated along the first input segment that it is on. A segment has the first nonzero marker
            of the input segments that it is a part of. Several input segments that coincide are one here:
            ``incidence`` tells how many, which matters to even-odd carving.
        source: the input.
        chain_start: int64 (s + 1,): the vertices along input segment i, from its first end to its second, are
            ``chain_vertices[chain_start[i] : chain_start[i + 1]]``; a single one if snapping made it a point.
        chain_vertices: int32, rows of ``pslg.points``, of points at one position the first.
        incidence: int64 (k, 2): rows (segment of ``pslg``, input segment), sorted.
        grid: (gx, gy), powers of two: the spacing of doubles at the largest magnitude of x and of y, and in SNAPPED
            the grid. No chain is farther from its segment than half the diagonal of its cells. (0, 0) if EXACT.
        rounding: how much had to be moved.
        crossings: in how many places (after rounding) segments of the input cross properly.
    """

    pslg: PSLG
    source: PSLG
    chain_start: LongArray
    chain_vertices: IntArray
    incidence: MarkerArray
    grid: tuple[float, float]
    rounding: Rounding
    crossings: int

    def chain(self, i: int) -> IntArray:
        """Return the vertices along input segment i."""
        return self.chain_vertices[self.chain_start[i] : self.chain_start[i + 1]]

    @cached_property
    def distance_squared(self) -> tuple[mpq, ...]:
        """For each input segment, exact, the square of the largest distance between its chain and itself."""
        if self.rounding is Rounding.EXACT:
            return (mpq(0),) * len(self.source.segments)
        begins, ends = _ends(self.source)
        return largest_distances_squared(
            self.pslg.points, begins, ends, Chains(self.chain_start, self.chain_vertices)
        )  # fmt: skip

    @property
    def max_distance_squared(self) -> mpq:
        """The largest of them; 0 of none."""
        return max(self.distance_squared, default=mpq(0))

    @cached_property
    def domain(self) -> PSLG:
        """The domain of the planar PSLG, for :func:`exactmesh.verify`.

        The PSLG itself, but for the even-odd rule: that counts coincident segments of the input, so those that are an
        even number come twice here, on points of their own at the same positions.
        """
        if self.pslg.rule is Carve.SEEDS:
            return self.pslg
        many = np.bincount(self.incidence[:, 0], minlength=len(self.pslg.segments))
        again = self.pslg.segments[many % 2 == 0]
        points = np.concatenate([self.pslg.points, self.pslg.points[again.reshape(-1)]])
        copies = np.arange(len(self.pslg.points), len(points), dtype=np.int32).reshape(-1, 2)
        segments = np.concatenate([self.pslg.segments, copies])
        return PSLG(points, segments, holes=self.pslg.holes, regions=self.pslg.regions, rule=self.pslg.rule)

    def __repr__(self) -> str:
        return (
            f"Arrangement({len(self.source.segments)} segments into {len(self.pslg.segments)}, "
            f"{self.crossings} crossings, {self.rounding})"
        )


def _ends(pslg: PSLG) -> tuple[FloatArray, FloatArray]:
    return pslg.points[pslg.segments[:, 0]], pslg.points[pslg.segments[:, 1]]


def _owners(graph: Graph, count: int) -> LongArray:
    """Return for each point from ``count`` on the first segment whose chain it is on."""
    lengths = np.diff(graph.chains.start)
    owner = np.repeat(np.arange(len(lengths)), lengths)
    first = np.zeros(len(graph.points), dtype=np.int64)
    first[graph.chains.vertices[::-1]] = owner[::-1]
    return first[count:]


def _interpolated(pslg: PSLG, graph: Graph) -> FloatArray | None:
    """Return the attributes of all points; between two ends as far as the larger coordinate difference tells."""
    given, n = pslg.point_attributes, len(pslg.points)
    if given is None:
        return None
    owner = _owners(graph, n)
    begins, ends = _ends(pslg)
    half = 0.5 * ends[owner] - 0.5 * begins[owner]  # a difference may overflow
    rows, axis = np.arange(len(owner)), np.argmax(np.abs(half), axis=1)
    new = graph.points[n:]
    t = (0.5 * new[rows, axis] - 0.5 * begins[owner][rows, axis]) / half[rows, axis]
    t = np.clip(t, 0.0, 1.0)[:, None]
    a, b = given[pslg.segments[owner, 0]], given[pslg.segments[owner, 1]]
    return np.concatenate([given, (1.0 - t) * a + t * b])


def _piece_markers(pslg: PSLG, graph: Graph) -> MarkerArray | None:
    """Return for each piece the first nonzero marker of its segments."""
    if pslg.segment_markers is None:
        return None
    markers = np.zeros(len(graph.pieces.ends), dtype=np.int64)
    marker = pslg.segment_markers[graph.pieces.incidence[:, 1]]
    rows = np.flatnonzero(marker)[::-1]
    markers[graph.pieces.incidence[rows, 0]] = marker[rows]  # of repeated rows the last, which is the first, stays
    return markers


def _planar_pslg(pslg: PSLG, graph: Graph) -> PSLG:
    point_markers = pslg.point_markers
    if point_markers is not None:
        point_markers = np.append(point_markers, np.zeros(len(graph.points) - len(pslg.points), dtype=np.int64))
    return PSLG(
        graph.points,
        graph.pieces.ends,
        holes=pslg.holes,
        regions=pslg.regions,
        point_markers=point_markers,
        segment_markers=_piece_markers(pslg, graph),
        point_attributes=_interpolated(pslg, graph),
        rule=pslg.rule,
    )


def _is_unchanged(pslg: PSLG, graph: Graph) -> bool:
    return not graph.is_snapped and len(graph.chains.vertices) == 2 * len(pslg.segments) == 2 * len(graph.pieces.ends)


def arrange(pslg: PSLG) -> Arrangement:
    """Return the arrangement of the segments as a planar PSLG of doubles.

    Crossings become vertices, segments through one point one vertex; a vertex inside a segment splits it; what overlaps
    becomes one. First the mild way: each crossing, an exact rational, goes to the nearest doubles, and an exact search
    finds whether the pieces meet in common ends only. Where they do not, and noding them again does not help within the
    promised distance, segments are snapped to a grid, as few as it takes. A PSLG that is noded already comes back as it
    is.

    Raises:
        PSLGError: a seed came to lie on a segment, or outside, when that moved.
        TooManyCrossingsError: the meetings do not fit into a quarter of the machine's memory.

    About O((n + k) log n) for k pairs of segments that meet. Reference [Hobby 1999], [Guibas 1998].

    >>> from exactmesh import PSLG
    >>> from exactmesh.crossings import arrange
    >>> cross = arrange(PSLG([(0, 0), (3, 1), (0, 1), (3, 0)], [(0, 1), (2, 3)]))
    >>> cross
    Arrangement(2 segments into 4, 1 crossings, exact)
    >>> cross.pslg.points[4:].tolist(), cross.chain(0).tolist()
    ([[1.5, 0.5]], [0, 4, 1])
    """
    ends = pslg.representative[pslg.segments]
    graph, grid = planar_graph(pslg.points, ends, pslg.representative), grid_of(pslg.points)
    rounding = Rounding.SNAPPED if graph.is_snapped else Rounding.NEAREST
    if not graph.is_snapped and not is_anything_moved(graph.points, *_ends(pslg), graph.chains):
        rounding, grid = Rounding.EXACT, (0.0, 0.0)
    return Arrangement(
        pslg=pslg if _is_unchanged(pslg, graph) else _planar_pslg(pslg, graph),
        source=pslg,
        chain_start=frozen(graph.chains.start),
        chain_vertices=frozen(graph.chains.vertices),
        incidence=frozen(graph.pieces.incidence),
        grid=grid,
        rounding=rounding,
        crossings=graph.crossings,
    )
