"""Noding by rounding: crossings become their nearest doubles, points of the input stay where they are.

That bends the segments a little, and a bent one may meet others that it did not meet before. Then the pieces are noded
again, until no two meet but in common ends, which is the usual end after one round or two; or for as many rounds as are
worth it before the whole drawing is snapped to a grid (snapping.py).
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exactkernel.context import Context, scaled_into_window
from exactkernel.jit import jit
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.chains import Chains, Pieces, chains_of, distinct, pieces_of
from exactmesh.coincident import first_of_each, lexicographic_order
from exactmesh.crossing_points import CrossingRounder
from exactmesh.memory import limited
from exactmesh.segment_meetings import Meeting, is_inside, meetings

__all__ = ["Graph", "LongArray", "alone_of", "chains_in", "node_by_rounding", "placed_meetings", "with_places"]

LongArray = npt.NDArray[np.int64]

_BYTES_PER_MEETING = 48  # of the incidences, after those of a portion were made distinct
_ROUNDS = 8


class Graph(NamedTuple):
    """A planar graph: segments that meet in common ends only.

    Attributes:
        points: float64 (v, 2): those of the input, then new ones.
        representative: int32 (n,): the vertex of each point of the input, the first in its place.
        chains: of the input's segments.
        pieces: of the chains.
        crossings: how many different places crossings were rounded to.
        rounds: how often vertices were put in.
    """

    points: FloatArray
    representative: IntArray
    chains: Chains
    pieces: Pieces
    crossings: int
    rounds: int


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


def placed_meetings(points: FloatArray, segments: IntArray, place: CrossingRounder) -> Incidences:
    """Find all meetings, and say what lies inside which segment; crossings where ``place`` puts them.

    Args:
        points: float64 (v, 2).
        segments: int32 (m, 2), as :func:`meetings` asks for.
        place: maps pairs of crossing segments to places.
    """
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


def with_places(points: FloatArray, used: LongArray, places: FloatArray) -> tuple[FloatArray, LongArray]:
    """Return the points and those places where no used point lies, and the vertex of each place."""
    candidates = np.concatenate([points[used], places])
    first = first_of_each(candidates, lexicographic_order(candidates))[len(used) :]
    is_new = first >= len(used)
    vertex = np.empty(len(places), dtype=np.int64)
    vertex[~is_new] = used[first[~is_new]]
    vertex[is_new] = len(points) + np.arange(is_new.sum())
    return np.concatenate([points, places[is_new]]), vertex


def _spread(pieces: Pieces, piece: LongArray, vertex: LongArray) -> tuple[LongArray, LongArray]:
    """Return (segment, vertex) for (piece, vertex), once for every segment that the piece is a part of."""
    first = np.searchsorted(pieces.incidence[:, 0], np.arange(len(pieces.ends) + 1))
    lengths = (first[1:] - first[:-1])[piece]
    begin = np.repeat(first[:-1][piece] - (np.cumsum(lengths) - lengths), lengths)
    rows = begin + np.arange(lengths.sum())
    return pieces.incidence[rows, 1], np.repeat(vertex, lengths)


def alone_of(representative: IntArray, segments: IntArray) -> IntArray:
    """Return the points that no segment ends in, each place once, as segments from themselves to themselves."""
    ends = np.zeros(len(representative), dtype=np.bool_)
    ends[segments.reshape(-1)] = True
    alone = np.flatnonzero((representative == np.arange(len(representative))) & ~ends).astype(np.int32)
    return np.stack([alone, alone], axis=1)


def chains_in(
    points: FloatArray, used: LongArray, begins: FloatArray, ends: FloatArray, segment: LongArray, vertex: LongArray
) -> Chains:
    """Return the chains; ``used`` are the points in use, which ascend and lie in different places."""
    position = np.zeros(len(points), dtype=np.int32)
    position[used] = np.arange(len(used))
    start, vertices = chains_of(points[used], begins, ends, segment, position[vertex])
    return Chains(start, used[vertices].astype(np.int32))


def node_by_rounding(points: FloatArray, segments: IntArray, representative: IntArray) -> Graph | None:
    """Return the graph, or None if it is not planar after some rounds.

    Args:
        points: float64 (n, 2).
        segments: int32 (s, 2), ends by their representatives, none of them equal.
        representative: int32 (n,).
    """
    begins, ends = points[segments[:, 0]], points[segments[:, 1]]
    segment = np.repeat(np.arange(len(segments)), 2)
    vertex = segments.reshape(-1).astype(np.int64)
    alone = alone_of(representative, segments)
    used = np.flatnonzero(representative == np.arange(len(representative)))
    crossings = 0
    for rounds in range(_ROUNDS + 1):
        chains = chains_in(points, used, begins, ends, segment, vertex)
        pieces = pieces_of(chains)
        items = np.concatenate([pieces.ends, alone])
        found = placed_meetings(points, items, CrossingRounder(points, items))
        if not len(found.segment) and not len(found.place):
            return Graph(points, representative, chains, pieces, crossings, rounds)
        crossings = crossings if rounds else len(found.places)
        points, vertex_of_place = with_places(points, used, found.places)
        used = np.concatenate([used, np.arange(max(len(representative), used[-1] + 1), len(points))])
        more = _spread(
            pieces,
            np.concatenate([found.segment, found.segment_of_place]),
            np.concatenate([found.vertex, vertex_of_place[found.place]]),
        )
        segment, vertex = np.concatenate([segment, more[0]]), np.concatenate([vertex, more[1]])
    return None
