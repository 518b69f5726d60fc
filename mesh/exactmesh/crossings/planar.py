"""From segments to a planar graph of doubles: nodes where they meet, rounded as mildly as it goes.

Each round looks for pieces that meet elsewhere than in common ends. For some rounds those are noded (noding.py). If
that does not come to an end, as with nearly parallel segments that push each other on by one ulp a round, or moves
something too far, the segments in question are snapped to a grid (snapping.py), and those that then are in their way,
until none is. Only the neighbourhood of what changed is looked at.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from gmpy2 import mpq

from exactkernel.types import FloatArray, IntArray
from exactmesh.crossings.chain_distance import largest_distances_squared
from exactmesh.crossings.chains import Chains, Pieces
from exactmesh.crossings.nearby import boxes_of, nearby
from exactmesh.crossings.noding import Drawing, Incidences, LongArray, drawing_of, is_any, met_in, noded, pieces_in
from exactmesh.crossings.snapping import bent, grid_of, snapped

__all__ = ["Graph", "planar_graph"]

_ROUNDS = 8  # of noding
_GROWTH = 2  # times as many meetings in the next round are too many: nearly parallel segments breed them
_SNAPS = 16  # with more segments each time; then all are snapped


BoolArray = npt.NDArray[np.bool_]


class Graph(NamedTuple):
    """A planar graph: segments that meet in common ends only.

    Attributes:
        points: float64 (v, 2): those of the input, then new ones.
        representative: int32 (n,): the vertex of each point of the input, the first in its place.
        chains: of the input's segments.
        pieces: of the chains.
        crossings: how many different places crossings were rounded to.
        is_snapped: whether some segments were snapped to the grid.
    """

    points: FloatArray
    representative: IntArray
    chains: Chains
    pieces: Pieces
    crossings: int
    is_snapped: bool


class Part(NamedTuple):
    """Some segments of a drawing: which, their chains, and the pieces of those."""

    rows: LongArray
    chains: Chains
    pieces: Pieces


def _part(drawing: Drawing, rows: LongArray) -> Part:
    chains = drawing.chains(rows)
    return Part(rows, chains, pieces_in(chains, rows))


def _graph(drawing: Drawing, part: Part, count: int, crossings: int, is_snapped: bool) -> Graph:
    """Return the graph of the first ``count`` segments, the others being points; without vertices that nothing uses."""
    if len(part.rows) < len(drawing.segments):
        part = _part(drawing, np.arange(len(drawing.segments)))
    start, vertices = part.chains.start[: count + 1], part.chains.vertices[: part.chains.start[count]]
    is_used = np.zeros(len(drawing.points), dtype=np.bool_)
    is_used[: len(drawing.given)] = True
    is_used[vertices] = True
    number = (np.cumsum(is_used) - 1).astype(np.int32)
    ends = part.pieces.ends[part.pieces.ends[:, 0] != part.pieces.ends[:, 1]]  # single vertices come last
    incidence = part.pieces.incidence[: np.searchsorted(part.pieces.incidence[:, 0], len(ends))]
    pieces = Pieces(number[ends], incidence)
    return Graph(
        drawing.points[is_used], drawing.representative, Chains(start, number[vertices]), pieces, crossings, is_snapped
    )  # fmt: skip


def _culprits(pieces: Pieces, found: Incidences, is_snapped: BoolArray) -> LongArray:
    """Return segments to be snapped: those with something inside, and where they are already, one that ends there."""
    owner = np.empty(int(pieces.ends.max(initial=-1)) + 1, dtype=np.int64)
    rows, first = np.unique(pieces.incidence[:, 0], return_index=True)
    owner[pieces.ends[rows].reshape(-1)] = np.repeat(pieces.incidence[first, 1], 2)
    others = owner[found.vertex[is_snapped[found.segment]]]
    return np.concatenate([found.segment, found.segment_of_place, others])


def _too_far(drawing: Drawing, rows: LongArray, grid: tuple[float, float]) -> LongArray:
    """Return those of some segments whose chains are farther from them than half the diagonal of the grid's cells."""
    if not len(rows):
        return rows
    distances = largest_distances_squared(
        drawing.points, drawing.begins[rows], drawing.finishes[rows], drawing.chains(rows)
    )  # fmt: skip
    limit = (mpq(grid[0]) * mpq(grid[0]) + mpq(grid[1]) * mpq(grid[1])) / 4
    return rows[[distance > limit for distance in distances]]


def _snapped_graph(
    base: Drawing, wrong: LongArray, late: BoolArray, boxes: FloatArray, grid: tuple[float, float], count: int
) -> Graph:
    """Return the graph with segments snapped until nothing is wrong; ``late`` are those that may be too far off."""
    is_snapped = np.zeros(len(base.segments), dtype=np.bool_)
    snaps = 0
    while True:
        is_snapped[wrong] = True
        is_snapped |= snaps == _SNAPS
        drawing, crossings, changed = snapped(base, is_snapped, nearby(boxes, np.flatnonzero(is_snapped)), grid)
        part = _part(drawing, nearby(boxes, changed))
        found = met_in(drawing.points, part.pieces)
        wrong = np.concatenate([_culprits(part.pieces, found, is_snapped), bent(drawing, part.chains, part.rows)])
        if not len(wrong):
            wrong = _too_far(drawing, np.flatnonzero(late & ~is_snapped), grid)
        if not len(wrong):
            return _graph(drawing, part, count, crossings, is_snapped=True)
        assert not is_snapped.all()  # what is snapped as a whole is planar
        snaps += 1


def planar_graph(points: FloatArray, segments: IntArray, representative: IntArray) -> Graph:
    """Return the planar graph of segments.

    Args:
        points: float64 (n, 2).
        segments: int32 (s, 2), ends by their representatives, none of them equal.
        representative: int32 (n,).
    """
    drawing, grid = drawing_of(points, segments, representative), grid_of(points)
    boxes = boxes_of(drawing.begins, drawing.finishes, grid)
    changed = np.arange(len(drawing.segments))
    late = np.zeros(len(changed), dtype=np.bool_)
    most = np.inf
    for rounds in range(_ROUNDS + 1):
        part = _part(drawing, nearby(boxes, changed))
        found = met_in(drawing.points, part.pieces)
        if not is_any(found):
            wrong = _too_far(drawing, np.flatnonzero(late), grid)
            if not len(wrong):
                return _graph(drawing, part, len(segments), len(drawing.crossings), is_snapped=False)
            break
        if rounds == _ROUNDS or len(found.segment) + len(found.segment_of_place) > most:  # they breed
            wrong = _culprits(part.pieces, found, np.zeros_like(late))
            break
        most = _GROWTH * (len(found.segment) + len(found.segment_of_place))
        changed = np.unique(np.concatenate([found.segment, found.segment_of_place]))
        late[changed] |= rounds > 0
        drawing = noded(drawing, part.pieces, found)
    return _snapped_graph(drawing, wrong, late, boxes, grid, len(segments))
