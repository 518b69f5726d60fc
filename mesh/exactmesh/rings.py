"""Rings, lines and points, as other people keep geometry, to and from points and segments."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import Enum, auto

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points
from exactkernel.jit import jit
from exactkernel.types import FloatArray, IntArray
from exactmesh.columns import MarkerArray
from exactmesh.errors import Fault, FaultKind, PSLGError

__all__ = ["Graph", "Piece", "Shape", "graph_of", "pieces_of_rings", "rings_of", "vertices_of_rings"]


class Shape(Enum):
    """What a list of positions stands for."""

    RING = auto()
    LINE = auto()
    POINTS = auto()


@dataclass(frozen=True, slots=True)
class Piece:
    """Positions, (k, 2), and what they stand for; the closing position of a ring may be repeated."""

    shape: Shape
    positions: FloatArray


@dataclass(frozen=True, slots=True)
class Graph:
    """Points (n, 2), segments (s, 2), the piece that each segment comes from (s,), and whether all are of lines."""

    points: FloatArray
    segments: MarkerArray
    piece: npt.NDArray[np.intp]
    only_lines: bool


def pieces_of_rings(rings: Iterable[npt.ArrayLike]) -> list[Piece]:
    """Return rings from arrays (k, 2); errors as for points, under the name rings[i]."""
    return [Piece(Shape.RING, finite_points(ring, f"rings[{i}]")) for i, ring in enumerate(rings)]


def graph_of(pieces: Sequence[Piece]) -> Graph:
    """Return all positions as points, in their order, and the segments between consecutive ones. Linear time.

    The repeated end of a ring, or of a closed line, is its first point. A position that repeats its predecessor is a
    point of its own, and no segment leads to it. Among rings a line separates nothing: it is there twice, on points of
    its own, so that no parity depends on it.

    Raises:
        PSLGError: rings with fewer than three distinct positions; all of them are named.
    """
    points, segments, counts = [np.empty((0, 2))], [np.empty((0, 2), dtype=np.int64)], []
    short, start, ring = [], 0, -1
    shapes = {piece.shape for piece in pieces}
    for piece in pieces:
        positions, ring = piece.positions, ring + (piece.shape is Shape.RING)
        if piece.shape is Shape.POINTS:
            inner = segments[0]
        else:
            positions, inner = _path(positions, is_ring=piece.shape is Shape.RING)
            if piece.shape is Shape.RING and not _has_three(positions):
                short.append(ring)
            if piece.shape is Shape.LINE and Shape.RING in shapes:
                inner = np.concatenate([inner, inner + len(positions)])
                positions = np.concatenate([positions, positions])
        points.append(positions)
        segments.append(inner + start)
        counts.append(len(inner))
        start += len(positions)
    if short:
        message = "ring #{} has fewer than three distinct vertices"
        raise PSLGError([Fault(FaultKind.RING_TOO_SHORT, (i,), message.format(i)) for i in short])
    only_lines = Shape.LINE in shapes and Shape.RING not in shapes
    piece_of = np.repeat(np.arange(len(counts)), counts)
    return Graph(np.concatenate(points), np.concatenate(segments), piece_of, only_lines)


def _path(positions: FloatArray, *, is_ring: bool) -> tuple[FloatArray, MarkerArray]:
    """Return the positions without a repeated end, and the segments along them, closed for a ring."""
    ends_meet = len(positions) > 1 and bool((positions[0] == positions[-1]).all())
    is_closed = is_ring or (ends_meet and _has_three(positions))
    if ends_meet and is_closed:
        positions = positions[:-1]
    moves = np.ones(len(positions), dtype=np.bool_)
    moves[1:] = (positions[1:] != positions[:-1]).any(axis=1)
    stops = np.flatnonzero(moves)
    if is_closed and len(stops) > 1 and (positions[stops[-1]] == positions[0]).all():
        stops = stops[:-1]
    after = np.roll(stops, -1)
    last = len(stops) if is_closed and len(stops) > 1 else max(len(stops) - 1, 0)
    return positions, np.stack([stops, after], axis=1)[:last]


def _has_three(positions: FloatArray) -> bool:
    """Tell whether three of the positions are distinct."""
    others = positions[(positions != positions[0]).any(axis=1)] if len(positions) else positions
    return bool(len(others) and (others != others[0]).any())


@jit
def _link(segments: IntArray, links: IntArray, degree: IntArray) -> None:
    """Write for each point the first two segments that end there, and how many there are."""
    for s in range(len(segments)):
        for end in range(2):
            v = segments[s, end]
            if degree[v] < 2:
                links[v, degree[v]] = s
            degree[v] += 1


@jit
def _trace(segments: IntArray, links: IntArray, done: IntArray, vertices: IntArray, starts: IntArray) -> int:
    """Write the cycles one after the other; return how many there are. ``starts[r]`` is where cycle r begins."""
    rings = size = 0
    for first in range(len(segments)):
        if done[first]:
            continue
        starts[rings] = size
        rings += 1
        s, v = first, segments[first, 0]
        while not done[s]:
            done[s] = 1
            vertices[size] = v
            size += 1
            v = segments[s, 1] if segments[s, 0] == v else segments[s, 0]
            s = links[v, 1] if links[v, 0] == s else links[v, 0]
    starts[rings] = size
    return rings


def vertices_of_rings(segments: IntArray, n: int) -> list[IntArray]:
    """Return the cycles that the segments form, as indices of points, each from its first segment on. O(n + s).

    Raises:
        PSLGError: a point is the end of a number of segments that is neither 0 nor 2; all such points are named.
    """
    links, degree = np.full((n, 2), -1, dtype=np.int32), np.zeros(n, dtype=np.int32)
    _link(segments, links, degree)
    odd = np.flatnonzero((degree != 0) & (degree != 2))
    if odd.size:
        message = "point #{} is the end of {}"
        raise PSLGError(
            [Fault(FaultKind.NOT_A_RING, (v,), message.format(v, _segments(int(degree[v])))) for v in odd.tolist()]
        )
    vertices, starts = np.empty(len(segments), dtype=np.int32), np.empty(len(segments) + 1, dtype=np.int32)
    rings = _trace(segments, links, np.zeros(len(segments), dtype=np.int32), vertices, starts)
    return np.split(vertices, starts[1:rings]) if rings else []


def _segments(k: int) -> str:
    return "1 segment" if k == 1 else f"{k} segments"


def rings_of(points: FloatArray, segments: IntArray) -> list[FloatArray]:
    """Return the positions of the cycles of :func:`vertices_of_rings`, the closing one not repeated."""
    return [points[ring] for ring in vertices_of_rings(segments, len(points))]
