"""From "these vertices lie on that segment" to chains and pieces, without a look at a single exact position.

Rounding to doubles, or to a grid, is monotone: points in their order along a segment keep it, weakly, in x and in y. So
the rounded vertices of a segment, sorted by x and then by y in the segment's direction, are in the right order.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray, IntArray
from exactmesh.coincident import lexicographic_order

__all__ = ["Chains", "Pieces", "chains_through", "distinct", "pieces_of"]

LongArray = npt.NDArray[np.int64]


class Chains(NamedTuple):
    """Vertices along segments.

    Attributes:
        start: int64 (s + 1,): the chain of segment i is ``vertices[start[i] : start[i + 1]]``.
        vertices: int32.
    """

    start: LongArray
    vertices: IntArray


class Pieces(NamedTuple):
    """What chains are made of.

    Attributes:
        ends: int32 (m, 2): each piece once, in the order and the direction of its first appearance.
        incidence: int64 (k, 2): rows (piece, segment), sorted.
    """

    ends: IntArray
    incidence: LongArray


def distinct(keys: LongArray) -> LongArray:
    """Return the keys sorted, each once."""
    keys = np.sort(keys)
    return keys[np.append(True, keys[1:] != keys[:-1])] if keys.size else keys


def _sorted_chains(
    points: FloatArray, begins: FloatArray, ends: FloatArray, segment: LongArray, vertex: IntArray
) -> Chains:
    """Return the chain of every segment, its vertices in order, each once.

    Args:
        points: float64 (v, 2), where the vertices are now, all in different places.
        begins, ends: float64 (s, 2), where the segments began and ended when nothing was rounded.
        segment, vertex: (k,), which vertices lie on which segment; repeated rows are harmless.
    """
    count, bits = len(begins), max(len(points), 1).bit_length()
    rising = lexicographic_order(points)
    falling = lexicographic_order(points * (1.0, -1.0))
    rank = np.empty((2, len(points)), dtype=np.int64)
    rank[0, rising] = rank[1, falling] = np.arange(len(points))
    (ax, ay), (bx, by) = begins.T, ends.T
    is_falling = (((ax < bx) & (ay > by)) | ((ax > bx) & (ay < by))).astype(np.int8)
    is_reversed = (ax > bx) | ((ax == bx) & (ay > by))
    last = len(points) - 1
    place = rank[is_falling[segment], vertex]
    keys = distinct(segment << bits | np.where(is_reversed[segment], last - place, place))
    segment, place = keys >> bits, keys & ((1 << bits) - 1)
    place = np.where(is_reversed[segment], last - place, place)
    vertices = np.where(is_falling[segment] == 1, falling[place], rising[place])
    return Chains(np.searchsorted(segment, np.arange(count + 1)), vertices.astype(np.int32))


def _marked(rows: npt.NDArray[np.integer], count: int) -> npt.NDArray[np.bool_]:
    mask = np.zeros(count, dtype=np.bool_)
    mask[rows] = True
    return mask


def chains_through(
    points: FloatArray, begins: FloatArray, finishes: FloatArray, ends: IntArray, segment: LongArray, vertex: LongArray
) -> Chains:
    """Return the chain of every segment; only those with something inside cost more than a copy.

    Args:
        points: float64 (v, 2), where the vertices are now; those in use lie in different places.
        begins, finishes: float64 (s, 2), where the segments began and ended when nothing was rounded.
        ends: int32 (s, 2), the vertices there; twice the same one is a chain of one vertex.
        segment, vertex: (k,), which other vertices lie on which segment.
    """
    lengths = 1 + (ends[:, 0] != ends[:, 1])
    is_busy = _marked(segment, len(ends))
    busy = np.flatnonzero(is_busy)
    if busy.size:
        vertex = np.concatenate([ends[busy].reshape(-1), vertex])
        used = np.flatnonzero(_marked(vertex, len(points)))
        number, position = np.empty(len(ends), dtype=np.int64), np.empty(len(points), dtype=np.int32)
        number[busy], position[used] = np.arange(len(busy)), np.arange(len(used))
        owner = np.concatenate([np.repeat(np.arange(len(busy)), 2), number[segment]])
        inner = _sorted_chains(points[used], begins[busy], finishes[busy], owner, position[vertex])
        lengths[busy] = np.diff(inner.start)
    start = np.append(0, np.cumsum(lengths))
    vertices = np.empty(start[-1], dtype=np.int32)
    vertices[start[:-1]], vertices[start[1:] - 1] = ends[:, 0], ends[:, 1]
    if busy.size:
        vertices[np.repeat(is_busy, lengths)] = used[inner.vertices]
    return Chains(start, vertices)


def pieces_of(chains: Chains) -> Pieces:
    """Return the edges of all chains, those in the same place once."""
    lengths = np.diff(chains.start)
    segment = np.repeat(np.arange(len(lengths)), lengths)
    inner = segment[1:] == segment[:-1]
    u, v, segment = chains.vertices[:-1][inner], chains.vertices[1:][inner], segment[1:][inner]
    keys = np.minimum(u, v).astype(np.int64) << 32 | np.maximum(u, v)
    order = np.argsort(keys)
    ranked = keys[order]
    begins = np.append(True, ranked[1:] != ranked[:-1])[: len(ranked)]
    first = np.minimum.reduceat(order, np.flatnonzero(begins)) if len(order) else order  # appearance of each piece
    number = np.empty(len(first), dtype=np.int64)
    by_appearance = np.argsort(first)
    number[by_appearance] = np.arange(len(first))
    piece = np.empty(len(keys), dtype=np.int64)
    piece[order] = number[np.cumsum(begins) - 1]
    shown = first[by_appearance]
    incidence = np.stack([piece, segment], axis=1)[np.argsort(piece, kind="stable")]  # segments ascend already
    return Pieces(np.stack([u[shown], v[shown]], axis=1).astype(np.int32).reshape(-1, 2), incidence)
