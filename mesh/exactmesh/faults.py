"""What is wrong with a planar straight line graph: one function a group of faults, each over whole arrays."""

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray, IntArray
from exactmesh.columns import MarkerArray
from exactmesh.errors import Fault, FaultKind
from exactmesh.seeds import inside_hull, segment_under

__all__ = ["seed_faults", "segment_faults"]

Mask = npt.NDArray[np.bool_]

_SEEDS = {
    "hole": (FaultKind.HOLE_NOT_FINITE, FaultKind.HOLE_ON_SEGMENT, FaultKind.HOLE_OUTSIDE),
    "region": (FaultKind.REGION_NOT_FINITE, FaultKind.REGION_ON_SEGMENT, FaultKind.REGION_OUTSIDE),
}


def segment_faults(segments: MarkerArray, representative: IntArray) -> tuple[list[Fault], Mask]:
    """Return the faults of the segments by themselves, and which segments have none of them. O(s log s)."""
    n = len(representative)
    exists: Mask = np.all((segments >= 0) & (segments < n), axis=1)
    faults = [_bad_index(int(s), segments, n) for s in np.flatnonzero(~exists)]
    ends = np.where(exists[:, None], segments, 0)
    places = representative[ends] if n else ends
    empty = exists & (places[:, 0] == places[:, 1])
    faults += [_zero_length(int(s), segments) for s in np.flatnonzero(empty)]
    sound = exists & ~empty
    faults += _repeated(segments, sound)
    return faults, sound


def _bad_index(s: int, segments: MarkerArray, n: int) -> Fault:
    there_are = f"points are #0 to #{n - 1}" if n else "there are no points"
    message = f"segment #{s} {_ends(s, segments)} has an end that does not exist: {there_are}"
    return Fault(FaultKind.BAD_INDEX, (s,), message)


def _zero_length(s: int, segments: MarkerArray) -> Fault:
    a, b = segments[s].tolist()
    why = (
        f"begins and ends in point #{a}"
        if a == b
        else f"has no length, for points #{a} and #{b} have the same position"
    )
    return Fault(FaultKind.ZERO_LENGTH, (s,), f"segment #{s} {why}")


def _repeated(segments: MarkerArray, sound: Mask) -> Iterator[Fault]:
    rows = np.flatnonzero(sound)
    keys = segments[rows].min(axis=1) << 32 | segments[rows].max(axis=1)
    ranked = np.sort(keys)
    if not (ranked[1:] == ranked[:-1]).any():
        return
    _, first, which = np.unique(keys, return_index=True, return_inverse=True)  # first: the smallest index
    for k in np.flatnonzero(first[which] != np.arange(len(keys))):
        s, original = int(rows[k]), int(rows[first[which[k]]])
        message = f"segment #{s} {_ends(s, segments)} is segment #{original} again"
        yield Fault(FaultKind.REPEATED_SEGMENT, (original, s), message)


def _ends(s: int, segments: MarkerArray) -> str:
    a, b = segments[s].tolist()
    return f"(#{a}, #{b})" if min(a, b) >= 0 else f"({a}, {b})"


def seed_faults(
    what: str,
    seeds: FloatArray,
    points: FloatArray,
    order: IntArray,
    segments: MarkerArray,
    sound: Mask,
) -> list[Fault]:
    """Return the faults of seeds, ``what`` being "hole" or "region": not finite, on a sound segment, outside.

    Each row of ``seeds`` begins with x, y. ``order`` is the points' lexicographic order. O(n + (s + h) log h) for short
    segments.
    """
    not_finite, on_segment, outside = _SEEDS[what]
    usable = np.isfinite(seeds).all(axis=1)
    faults = [
        Fault(not_finite, (int(i),), f"{what} #{i} is {tuple(seeds[i].tolist())}") for i in np.flatnonzero(~usable)
    ]
    if not usable.any():
        return faults
    places, numbers, rows = seeds[usable, :2], np.flatnonzero(usable), np.flatnonzero(sound)
    under = segment_under(points, segments[rows].astype(np.int32), places)
    inside = inside_hull(points, order, places)
    for k in np.flatnonzero(under >= 0):
        i, s = int(numbers[k]), int(rows[under[k]])
        message = f"{what} #{i} at {_place(seeds[i])} lies on segment #{s} {_ends(s, segments)}"
        faults.append(Fault(on_segment, (i, s), message))
    for k in np.flatnonzero((under < 0) & (inside == 0)):
        i = int(numbers[k])
        faults.append(Fault(outside, (i,), f"{what} #{i} at {_place(seeds[i])} is not inside the hull of the points"))
    return faults


def _place(seed: FloatArray) -> str:
    x, y = seed[:2].tolist()
    return f"({x}, {y})"
