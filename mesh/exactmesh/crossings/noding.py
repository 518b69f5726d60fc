"""Noding by rounding: crossings become their nearest doubles, points of the input stay where they are.

That bends the segments a little, and a bent one may meet others that it did not meet before. Then the pieces are noded
again, until no two meet but in common ends, which is the usual end after one round or two. A meeting that is new has a
piece in it that is new: so after the first round only the neighbourhood of the segments that changed is searched.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exactkernel.context import Context, scaled_into_window
from exactkernel.jit import jit
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.coincident import first_of_each, lexicographic_order
from exactmesh.crossings.chains import Chains, Pieces, chains_through, distinct, pieces_of
from exactmesh.crossings.crossing_points import CrossingRounder
from exactmesh.crossings.memory import limited
from exactmesh.crossings.segment_meetings import Meeting, is_inside, meetings

__all__ = ["Drawing", "Incidences", "distinct_places", "drawing_of", "is_any", "met_in", "noded", "pieces_in"]

LongArray = npt.NDArray[np.int64]

_BYTES_PER_MEETING = 48  # of the incidences, after those of a portion were made distinct


class Drawing(NamedTuple):
    """Segments, and the vertices that were found on them so far.

    Attributes:
        given: float64 (n, 2): the points of the input.
        segments: int32 (s, 2): ends by their representatives. A point that no segment ends in is one here, from itself
            to itself, after all others.
        points: float64 (v, 2): where the points are now, and vertices after them.
        representative: int32 (n,): the vertex of each point of the input, the first in its place.
        segment, vertex: int64 (k,): vertices on segments, besides their ends. An end may be repeated.
        crossings: int64 (c,): the vertices that crossings of the input's segments became.
    """

    given: FloatArray
    segments: IntArray
    points: FloatArray
    representative: IntArray
    segment: LongArray
    vertex: LongArray
    crossings: LongArray

    @property
    def begins(self) -> FloatArray:
        """Where the segments began, before anything moved."""
        return self.given[self.segments[:, 0]]

    @property
    def finishes(self) -> FloatArray:
        """Where they ended."""
        return self.given[self.segments[:, 1]]

    def chains(self, rows: LongArray) -> Chains:
        """Return the chains of some segments, which ascend."""
        number = np.full(len(self.segments), -1)
        number[rows] = np.arange(len(rows))
        segment = number[self.segment]
        mine = segment >= 0
        at = self.segments[rows]
        ends = self.representative[at]
        return chains_through(
            self.points, self.given[at[:, 0]], self.given[at[:, 1]], ends, segment[mine], self.vertex[mine]
        )  # fmt: skip


def drawing_of(points: FloatArray, segments: IntArray, representative: IntArray) -> Drawing:
    """Return the drawing of segments, int32 (s, 2), given by the representatives, int32 (n,), of their ends."""
    is_alone = representative == np.arange(len(representative))
    is_alone[segments.reshape(-1)] = False
    alone = np.flatnonzero(is_alone).astype(np.int32)
    nothing = np.empty(0, dtype=np.int64)
    segments = np.concatenate([segments, np.stack([alone, alone], axis=1)])
    return Drawing(points, segments, points, representative, nothing, nothing, nothing)


def pieces_in(chains: Chains, rows: LongArray) -> Pieces:
    """Return the pieces of the chains of some segments, and chains of one vertex as pieces from it to itself."""
    pieces = pieces_of(chains)
    single = np.flatnonzero(np.diff(chains.start) == 1)
    vertex = chains.vertices[chains.start[single]]
    incidence = np.stack([len(pieces.ends) + np.arange(len(single)), single], axis=1)
    incidence = np.concatenate([pieces.incidence, incidence])
    incidence[:, 1] = rows[incidence[:, 1]]
    return Pieces(np.concatenate([pieces.ends, np.stack([vertex, vertex], axis=1)]), incidence)


class Incidences(NamedTuple):
    """Which vertices lie inside which segments: vertices of the graph, and places, new or not.

    Attributes:
        segment, vertex: int64 (k,).
        places: float64 (p, 2), distinct.
        segment_of_place, place: int64 (l,): rows of ``places`` on segments.
    """

    segment: LongArray
    vertex: LongArray
    places: FloatArray
    segment_of_place: LongArray
    place: LongArray


@jit
def _ends_inside(
    k: Context,
    xy: FloatArray,
    segments: IntArray,
    first: IntArray,
    second: IntArray,
    inside: LongArray,
) -> int:
    """Write rows (segment, vertex) for each end of one segment that lies inside the other; return how many."""
    n = 0
    for i in range(len(first)):
        for turn in range(2):
            s, t = (first[i], second[i]) if turn == 0 else (second[i], first[i])
            for side in range(2):
                v = segments[t, side]
                if side == 1 and v == segments[t, 0]:
                    continue
                if is_inside(k, xy, segments[s, 0], segments[s, 1], v):
                    inside[n, 0] = s
                    inside[n, 1] = v
                    n += 1
    return n


def _pairs(keys: LongArray) -> tuple[LongArray, LongArray]:
    return keys >> 32, keys & (2**32 - 1)


def distinct_places(places: FloatArray) -> tuple[FloatArray, LongArray]:
    """Return the places in lexicographic order, each once, and the row of each in them."""
    if not len(places):
        return places, np.empty(0, dtype=np.int64)
    order = lexicographic_order(places)
    ranked = places[order]
    begins = np.append(True, (ranked[1:] != ranked[:-1]).any(axis=1))
    row = np.empty(len(places), dtype=np.int64)
    row[order] = np.cumsum(begins) - 1
    return ranked[begins], row


def _placed_meetings(points: FloatArray, segments: IntArray, grid: tuple[float, float] | None) -> Incidences:
    """Find all meetings, and say what lies inside which segment; crossings where a :class:`CrossingRounder` puts them.

    Args:
        points: float64 (v, 2).
        segments: int32 (m, 2), as :func:`meetings` asks for.
        grid: as for :class:`CrossingRounder`.
    """
    place = CrossingRounder(points, segments, grid)
    xy, k = scaled_into_window(points)
    at_vertex, at_place, places, count = [np.empty(0, np.int64)], [], [np.empty((0, 2))], 0
    for portion in limited(meetings(points, segments), _BYTES_PER_MEETING):
        crosses = portion.kind == Meeting.CROSSING
        first, second = portion.first[~crosses], portion.second[~crosses]
        inside = np.empty((4 * len(first), 2), dtype=np.int64)
        n = _ends_inside(k, xy, segments, first, second, inside)
        raise_if_interrupted()
        at_vertex.append(distinct(inside[:n, 0] << 32 | inside[:n, 1]))
        first, second = portion.first[crosses], portion.second[crosses]
        found, row = distinct_places(place(first, second))
        both = np.concatenate([first, second]).astype(np.int64) << 32 | np.tile(row, 2)
        at_place.append(distinct(both) + count)
        places.append(found)
        count += len(found)
    together, row = distinct_places(np.concatenate(places))
    segment, vertex = _pairs(distinct(np.concatenate(at_vertex)))
    owner, local = _pairs(np.concatenate([np.empty(0, np.int64), *at_place]))
    return Incidences(segment, vertex, together, owner, row[local])


def _spread(pieces: Pieces, piece: LongArray, other: LongArray) -> tuple[LongArray, LongArray]:
    """Return (segment, other) for (piece, other), once for every segment that the piece is a part of."""
    first = np.searchsorted(pieces.incidence[:, 0], np.arange(len(pieces.ends) + 1))
    lengths = (first[1:] - first[:-1])[piece]
    begin = np.repeat(first[:-1][piece] - (np.cumsum(lengths) - lengths), lengths)
    rows = begin + np.arange(lengths.sum())
    return pieces.incidence[rows, 1], np.repeat(other, lengths)


def met_in(points: FloatArray, pieces: Pieces, grid: tuple[float, float] | None = None) -> Incidences:
    """Return what lies inside which segment, when ``pieces`` are parts of segments and ``points`` their ends."""
    is_used = np.zeros(len(points), dtype=np.bool_)
    is_used[pieces.ends.reshape(-1)] = True
    used = np.flatnonzero(is_used)
    position = np.empty(len(points), dtype=np.int32)
    position[used] = np.arange(len(used))
    found = _placed_meetings(points[used], position[pieces.ends], grid)
    segment, vertex = _spread(pieces, found.segment, used[found.vertex])
    segment_of_place, place = _spread(pieces, found.segment_of_place, found.place)
    return Incidences(segment, vertex, found.places, segment_of_place, place)


def is_any(found: Incidences) -> bool:
    """Tell whether anything lies inside a segment."""
    return bool(len(found.segment) or len(found.place))


def noded(drawing: Drawing, pieces: Pieces, found: Incidences) -> Drawing:
    """Return the drawing with what was found among some pieces; a place where one of them ends is no new vertex."""
    is_used = np.zeros(len(drawing.points), dtype=np.bool_)
    is_used[pieces.ends.reshape(-1)] = True
    used = np.flatnonzero(is_used)
    candidates = np.concatenate([drawing.points[used], found.places])
    first = first_of_each(candidates, lexicographic_order(candidates))[len(used) :]
    is_new = first >= len(used)
    vertex = np.empty(len(found.places), dtype=np.int64)
    vertex[~is_new] = used[first[~is_new]]
    vertex[is_new] = len(drawing.points) + np.arange(is_new.sum())
    return drawing._replace(
        points=np.concatenate([drawing.points, found.places[is_new]]),
        segment=np.concatenate([drawing.segment, found.segment, found.segment_of_place]),
        vertex=np.concatenate([drawing.vertex, found.vertex, vertex[found.place]]),
        crossings=drawing.crossings if len(drawing.segment) else vertex,
    )
