"""A triangulation that grows: the arrays of a builder, and how they are made, enlarged and rescaled."""

from typing import NamedTuple

import numpy as np

from exactkernel.context import bits_of, exponent_into_window, guarded_context, rebounded
from exactkernel.jit import jit
from exactkernel.types import FloatArray, IntArray
from exactmesh.constrain import first_spokes, insert_segments
from exactmesh.delaunay import MAX_POINTS, insert_points
from exactmesh.edgealgebra import EdgeArray
from exactmesh.errors import TooManyPointsError
from exactmesh.ordering import IndexArray
from exactmesh.plane import Plane

__all__ = [
    "EDGES",
    "FLIPS",
    "GROUPS",
    "NUMBERS",
    "SEGMENTS",
    "START",
    "VERTICES",
    "Draft",
    "empty_draft",
    "fitted",
    "settled",
    "standing",
    "with_room",
    "with_room_for_segments",
]

#: Entries of ``Draft.tally``: how many edges there are (0: no triangle yet), vertex numbers given, vertices, segments,
#: and groups; the vertex where the next walk starts; the flips so far.
EDGES, NUMBERS, VERTICES, SEGMENTS, GROUPS, START, FLIPS = range(7)


class Draft(NamedTuple):
    """A constrained Delaunay triangulation of the plane, with room to grow.

    The arrays of ``plane`` have room for ``ghost`` vertices. A step of editing changes what the arrays hold in ONE
    compiled call, so an interrupt between two lines of Python finds a valid draft.

    Attributes:
        plane: the triangulation, which means nothing while there are no edges: all vertices on one line.
        owner: the group of segments that each edge is part of, or -1.
        twin: the vertex that stands for each vertex number: itself, another one at its position, or -1: deleted.
        ends: (s, 2), the vertices that each segment joins.
        group: (g, 2), each group of segments as another one, or -1, and one segment more.
        tally: see EDGES and so on.
        maximum, unit: the bits of the coordinates given so far.
        exponent: the power of two that they were multiplied by, so that predicates are fast.
    """

    plane: Plane
    owner: EdgeArray
    twin: IntArray
    ends: IndexArray
    group: IntArray
    tally: IndexArray
    maximum: float
    unit: float
    exponent: int


def _blank_plane(room: int) -> Plane:
    whole, flags = np.int32, np.bool_
    return Plane(
        guarded_context(), xy=np.zeros(2 * room), ring=np.zeros(12 * room, whole), org=np.zeros(6 * room, whole),
        spoke=np.zeros(room, whole), fixed=np.zeros(3 * room, flags), loose=np.zeros(3 * room, flags),
        crossed=np.empty(3 * room, whole), left=np.empty(3 * room + 8, whole), right=np.empty(3 * room + 8, whole),
        stack=np.empty(9 * room + 24, dtype=np.int64), ghost=room,
    )  # fmt: skip


def empty_draft() -> Draft:
    """Return a draft without vertices."""
    room = 8
    owner, twin = np.empty(3 * room, dtype=np.int32), np.empty(room, dtype=np.int32)
    ends, group = np.empty((room, 2), dtype=np.int64), np.empty((room, 2), dtype=np.int32)
    return Draft(_blank_plane(room), owner, twin, ends, group, np.zeros(7, dtype=np.int64), 0.0, np.inf, 0)


def with_room(draft: Draft, vertices: int) -> Draft:
    """Return a draft with room for so many vertex numbers: itself, or one twice as large. Amortised O(1).

    Raises:
        TooManyPointsError: their edges could not be numbered.
    """
    old, room = draft.plane, draft.plane.ghost
    if vertices <= room:
        return draft
    if vertices > MAX_POINTS:
        raise TooManyPointsError(f"{vertices} vertex numbers; at most {MAX_POINTS} fit 32-bit edge numbers")
    new = _blank_plane(min(max(2 * room, vertices), MAX_POINTS))
    for name in ("xy", "ring", "org", "spoke", "fixed"):
        held = getattr(old, name)
        getattr(new, name)[: len(held)] = held
    org = new.org[: 2 * int(draft.tally[EDGES])]
    org[org == room] = new.ghost
    owner, twin = np.empty(3 * new.ghost, dtype=np.int32), np.empty(new.ghost, dtype=np.int32)
    owner[: 3 * room], twin[:room] = draft.owner, draft.twin
    return draft._replace(plane=new._replace(k=old.k), owner=owner, twin=twin)


def with_room_for_segments(draft: Draft, more_groups: int) -> Draft:
    """Return a draft with room for one segment more and so many groups more. Amortised O(1)."""
    segments, groups = int(draft.tally[SEGMENTS]) + 1, int(draft.tally[GROUPS]) + more_groups
    ends, group = draft.ends, draft.group
    if segments > len(ends):
        ends = np.concatenate([ends, np.empty_like(ends)])
    if groups > len(group):
        group = np.concatenate([group, np.empty((max(len(group), more_groups), 2), dtype=np.int32)])
    return draft if ends is draft.ends and group is draft.group else draft._replace(ends=ends, group=group)


@np.errstate(over="ignore")
def fitted(draft: Draft, points: FloatArray) -> Draft:
    """Return a draft whose predicates are valid for these points as well; they are not yet part of it.

    Coordinates are scaled anew when they leave the window, some ten times in a draft's life at most: O(n) each.
    """
    bits = bits_of(points)
    maximum, unit = max(draft.maximum, bits[0]), min(draft.unit, bits[1])
    if (maximum, unit) == (draft.maximum, draft.unit):
        return draft
    exponent, plane = draft.exponent, draft.plane
    k = rebounded(plane.k, *np.ldexp([maximum, unit], exponent).tolist())
    if np.isinf(k.incircle_bound):
        exponent = exponent_into_window(maximum, unit)
        k = rebounded(plane.k, *np.ldexp([maximum, unit], exponent).tolist())
        plane = plane._replace(xy=np.ldexp(plane.xy, exponent - draft.exponent))
    return draft._replace(plane=plane._replace(k=k), maximum=maximum, unit=unit, exponent=exponent)


@jit
def group_pieces(pieces: EdgeArray, segments: int, owner: EdgeArray, group: IntArray) -> int:
    """Write the groups of the edges in rows (edge, segment); return how many groups there are.

    Group s is segment s by itself; the others follow.
    """
    for s in range(segments):
        group[s, 0], group[s, 1] = -1, s
    groups = segments
    for i in range(len(pieces)):
        e, s = pieces[i, 0], pieces[i, 1]
        if owner[e] < 0:
            owner[e] = s
        else:
            group[groups, 0], group[groups, 1] = owner[e], s
            owner[e] = groups
            groups += 1
    return groups


def settled(draft: Draft, numbers: int) -> Draft | None:
    """Return the draft with a triangulation of its first vertex numbers, or None if segments cross.

    Expected O(n log n). The draft that is given does not change.

    Raises:
        TooFewPointsError, CollinearPointsError: there is no triangle.
    """
    vertices = standing(draft, numbers)
    points, segments = draft.plane.xy.reshape(-1, 2), int(draft.tally[SEGMENTS])
    built = insert_points(points[vertices])
    plane, tally = _blank_plane(draft.plane.ghost), draft.tally.copy()
    draft.plane.k.counts[:] += built.k.counts
    plane.ring[: 4 * built.edges] = built.ring[: 4 * built.edges]
    names = np.append(vertices[built.order], plane.ghost)
    plane.org[: 2 * built.edges] = names[built.org[: 2 * built.edges]]
    first_spokes(plane.org, built.edges, plane.spoke)
    plane = plane._replace(k=draft.plane.k, xy=draft.plane.xy)
    pieces = insert_segments(plane, draft.ends[:segments].astype(np.int32))
    if pieces is None:
        return None
    owner = np.full(len(draft.owner), -1, dtype=np.int32)
    group = np.empty((segments + len(pieces) + 8, 2), dtype=np.int32)
    tally[GROUPS] = group_pieces(pieces, segments, owner, group)
    tally[EDGES], tally[START], tally[FLIPS] = built.edges, vertices[0], tally[FLIPS] + built.flips
    tally[NUMBERS], tally[VERTICES] = numbers, len(vertices)
    return draft._replace(plane=plane, owner=owner, group=group, tally=tally)


def standing(draft: Draft, numbers: int) -> IntArray:
    """Return those of the first vertex numbers that are vertices, int32."""
    return np.flatnonzero(draft.twin[:numbers] == np.arange(numbers)).astype(np.int32)
