"""Which triangles are the domain, and which region each belongs to: floods that stop at constrained edges.

Everything is decided on the triangulation of the convex hull: from outside the exterior is flooded, from the seeds of
holes the holes, from those of regions the regions.
"""

from enum import IntEnum

import numpy as np

from exactkernel.jit import jit
from exactkernel.types import IntArray
from exactmesh.errors import Fault, FaultKind, PSLGError
from exactmesh.plane import BoolArray
from exactmesh.pslg import PSLG, Carve

__all__ = ["Place", "check_parity", "open_faults", "places_of", "regions_of"]


class Place(IntEnum):
    """Where a triangle is."""

    DOMAIN = 0
    EXTERIOR = 1
    HOLE = 2


@jit
def flood(neighbors: IntArray, fixed: BoolArray, label: IntArray, mark: int, stack: IntArray, height: int) -> None:
    """Give the mark to all triangles with the label of those on the stack that are reached over no fixed edge."""
    old = label[stack[0]] if height else 0
    for i in range(height):
        label[stack[i]] = mark
    while height:
        height -= 1
        t = stack[height]
        for i in range(3):
            u = neighbors[t, i]
            if u >= 0 and not fixed[t, i] and label[u] == old:
                label[u] = mark
                stack[height] = u
                height += 1


@jit
def flood_from(
    neighbors: IntArray,
    fixed: BoolArray,
    label: IntArray,
    seeds: IntArray,
    old: int,
    mark: int,
    step: int,
    stack: IntArray,
) -> None:
    """Flood from each seed, a triangle or negative, whose label is ``old`` by then: from seed i with mark + i step."""
    for i in range(len(seeds)):
        t = seeds[i]
        if t >= 0 and label[t] == old:
            stack[0] = t
            flood(neighbors, fixed, label, mark + i * step, stack, 1)


@jit
def behind_hull(neighbors: IntArray, fixed: BoolArray, stack: IntArray) -> int:
    """Put the triangles that nothing separates from the outside onto the stack; return how many."""
    height = 0
    for t in range(len(neighbors)):
        for i in range(3):
            if neighbors[t, i] < 0 and not fixed[t, i]:
                stack[height] = t
                height += 1
                break
    return height


@jit
def separations(neighbors: IntArray, odd: BoolArray, label: IntArray, stack: IntArray) -> None:
    """Write 0 for the triangles that an odd number of segments separates from infinity, and 2 for the others."""
    label[:] = -1
    height = 0
    for t in range(len(neighbors)):
        for i in range(3):
            if neighbors[t, i] < 0 and label[t] < 0:
                label[t] = 0 if odd[t, i] else 2
                stack[height] = t
                height += 1
    while height:
        height -= 1
        t = stack[height]
        for i in range(3):
            u = neighbors[t, i]
            if u >= 0 and label[u] < 0:
                label[u] = 2 - label[t] if odd[t, i] else label[t]
                stack[height] = u
                height += 1


def check_parity(pslg: PSLG) -> None:
    """Refuse segments that do not bound: parity means nothing where a ring is open.

    Raises:
        PSLGError: at a point, an odd number of segments ends.
    """
    ends = pslg.representative[pslg.segments]
    degree = np.bincount(ends.reshape(-1), minlength=len(pslg.points))
    faults = [
        Fault(
            FaultKind.INCONSISTENT_PARITY,
            (int(v),),
            f"at point #{v} {tuple(pslg.points[v].tolist())} {_count(int(degree[v]))}, an odd number",
        )
        for v in np.flatnonzero(degree & 1)
    ]
    if faults:
        raise PSLGError(faults)


def _count(degree: int) -> str:
    return "1 segment ends" if degree == 1 else f"{degree} segments end"


def places_of(
    pslg: PSLG, rule: Carve, neighbors: IntArray, fixed: BoolArray, odd: BoolArray, seeds: IntArray
) -> tuple[IntArray, list[Fault]]:
    """Return the :class:`Place` of each triangle, int32 (m,), and which seeds are outside of the domain. O(m).

    ``fixed`` (m, 3) tells which edges are constrained, ``odd`` which of them by an odd number of segments; ``seeds``
    are the triangles of the holes' seeds, then those of the regions' seeds, or -1.
    """
    place = np.zeros(len(neighbors), dtype=np.int32)
    stack = np.empty(len(neighbors), dtype=np.int32)
    flood(neighbors, fixed, place, int(Place.EXTERIOR), stack, behind_hull(neighbors, fixed, stack))
    holes, regions = np.split(seeds, [len(pslg.holes)])
    faults = _outside(FaultKind.HOLE_OUTSIDE, "hole", pslg.holes.tolist(), holes, place == Place.EXTERIOR)
    if rule is Carve.EVEN_ODD:
        exterior = place == Place.EXTERIOR
        separations(neighbors, odd, place, stack)
        place[exterior] = Place.EXTERIOR
    flood_from(neighbors, fixed, place, holes, int(Place.DOMAIN), int(Place.HOLE), 0, stack)
    faults += _outside(FaultKind.REGION_OUTSIDE, "region", pslg.regions.tolist(), regions, place != Place.DOMAIN)
    return place, faults


def _outside(
    kind: FaultKind, what: str, seeds: list[list[float]], triangles: IntArray, outside: BoolArray
) -> list[Fault]:
    lost = [i for i, t in enumerate(triangles.tolist()) if t < 0 or outside[t]]
    return [Fault(kind, (i,), f"{what} #{i} at {tuple(seeds[i][:2])} is outside the domain") for i in lost]


def open_faults(pslg: PSLG, lost: IntArray) -> list[Fault]:
    """Return the faults of segments, ``lost``, that have the exterior on both sides: what should they bound?

    Those with a loose end come first: there an outline is open, or something overhangs.
    """
    ends = pslg.representative[pslg.segments]
    loose = np.bincount(ends.reshape(-1), minlength=len(pslg.points))[ends[lost]] == 1
    order = np.argsort(~loose.any(axis=1), kind="stable")
    faults = [
        Fault(FaultKind.NOT_CLOSED, (int(s),), _lost_segment(pslg, int(s), is_loose))
        for s, is_loose in zip(lost[order], loose[order].tolist(), strict=True)
    ]
    if len(pslg.segments) == 0:
        faults.append(Fault(FaultKind.NOT_CLOSED, (), "without segments there is nothing to carve"))
    return faults


def _lost_segment(pslg: PSLG, s: int, loose: list[bool]) -> str:
    ends = pslg.segments[s].tolist()
    places = [f"point #{v} {tuple(pslg.points[v].tolist())}" for v, end in zip(ends, loose, strict=True) if end]
    where = f", with the loose end {' and '.join(places)}," if places else ""
    return f"segment #{s} (#{ends[0]}, #{ends[1]}){where} has the exterior on both sides"


def _disagreement(first: int, later: int) -> Fault:
    return Fault(FaultKind.REGIONS_DISAGREE, (first, later), f"regions #{first} and #{later} are in one face")


def regions_of(pslg: PSLG, neighbors: IntArray, fixed: BoolArray, place: IntArray, seeds: IntArray) -> IntArray:
    """Return the region of each triangle, int32 (m,), or -1; ``seeds`` are the triangles of the regions' seeds. O(m).

    Raises:
        PSLGError: two seeds in one face disagree.
    """
    region = np.where(place == Place.DOMAIN, np.int32(-1), np.int32(-2))
    stack = np.empty(len(neighbors), dtype=np.int32)
    flood_from(neighbors, fixed, region, seeds, -1, 0, 1, stack)
    first = region[seeds]
    disagree = np.flatnonzero((pslg.regions[first, 2:] != pslg.regions[:, 2:]).any(axis=1))
    if disagree.size:
        pairs = np.stack([first[disagree], disagree], axis=1).tolist()
        raise PSLGError([_disagreement(i, j) for i, j in pairs])
    return region
