"""Pairs of segments that meet where they should not."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points
from exactkernel.batch import orient2d_batch
from exactkernel.errors import DegenerateError
from exactkernel.types import FloatArray, IntArray
from exactmesh.coincident import first_of_each, lexicographic_order
from exactmesh.columns import MarkerArray, frozen, indices_of
from exactmesh.crossings.chains import distinct
from exactmesh.crossings.crossing_points import CrossingRounder
from exactmesh.crossings.memory import limited
from exactmesh.crossings.segment_meetings import Meeting, meetings

__all__ = ["SegmentPairs", "crossing_pairs", "find_crossings"]

_BYTES_PER_PAIR = 40  # of the portions, the keys and their sort


@dataclass(frozen=True, eq=False, slots=True)
class SegmentPairs:
    """Pairs of segments that meet in a point which is not an end of both.

    Attributes:
        pairs: int64 (k, 2), rows i < j of segments, in lexicographic order, each pair once.
        kinds: int8 (k,), the :class:`Meeting` of each pair.
    """

    pairs: MarkerArray
    kinds: npt.NDArray[np.int8]

    def __len__(self) -> int:
        return len(self.pairs)


def find_crossings(points: npt.ArrayLike, segments: npt.ArrayLike) -> SegmentPairs:
    """Return all pairs of segments that cross, touch or overlap; common ends do not count.

    Ends are compared by position: segments that meet in coincident points have a common end.

    Args:
        points: (n, 2) finite coordinates.
        segments: int (s, 2), rows of ``points``.

    Returns:
        :class:`SegmentPairs`, told apart as proper crossings, T-junctions and overlaps. Every decision is exact.

    Raises:
        ShapeError, CoordinateError, NonFiniteError: arrays that are none, see :func:`exactmesh.delaunay`.
        TopologyError: a row of ``points`` that does not exist; ``indices`` names the segments.
        DegenerateError: a segment begins and ends in one place; ``indices`` names the segments.
        TooManyCrossingsError: the pairs do not fit into a quarter of the machine's memory.

    O((s + k) log s) for real data and for bundles of any direction. Reference [Fuchs 1980].

    >>> from exactmesh.crossings import find_crossings
    >>> found = find_crossings([(0, 0), (2, 2), (0, 2), (2, 0), (1, 1), (3, 1)], [(0, 1), (2, 3), (4, 5)])
    >>> found.pairs.tolist()
    [[0, 1], [0, 2], [1, 2]]
    >>> [Meeting(kind).name for kind in found.kinds]
    ['CROSSING', 'TOUCH', 'TOUCH']
    """
    coordinates = finite_points(points)
    given = np.asarray(segments)
    rows = indices_of(given.reshape(-1, 2) if given.size == 0 else given, "segments", 2, 0, len(coordinates))
    assert rows is not None  # an array came in
    ends = first_of_each(coordinates, lexicographic_order(coordinates))[rows]
    flat = np.flatnonzero(ends[:, 0] == ends[:, 1])
    if flat.size:
        raise DegenerateError(f"segment {flat[0]} begins and ends in one place", indices=flat.tolist())
    keys = [
        (portion.first.astype(np.int64) << 31 | portion.second) << 2 | portion.kind
        for portion in limited(meetings(coordinates, ends), _BYTES_PER_PAIR)
    ]
    found = distinct(np.concatenate([np.empty(0, np.int64), *keys]))
    pairs = np.stack([found >> 33, found >> 2 & (2**31 - 1)], axis=1)
    return SegmentPairs(frozen(pairs), frozen((found & 3).astype(np.int8)))


def crossing_pairs(points: FloatArray, segments: IntArray) -> MarkerArray:
    """Return the pairs of segments, int64 (k, 2), that cross where no point is: those that no triangulation has both.

    Where a point lies on both, it is a vertex of both. It is a double, so the crossing is, too, and rounds to itself.
    """
    found = find_crossings(points, segments)
    pairs = found.pairs[found.kinds == Meeting.CROSSING]
    first, second = pairs.astype(np.int32).T
    places = CrossingRounder(points, segments)(first, second)
    candidates = np.concatenate([points, places])
    at = first_of_each(candidates, lexicographic_order(candidates))[len(points) :]
    missed = at >= len(points)
    for side in (first, second):
        ends = candidates[segments[side]]
        missed |= orient2d_batch(ends[:, 0], ends[:, 1], candidates[at]) != 0
    rest: MarkerArray = pairs[missed]
    return rest
