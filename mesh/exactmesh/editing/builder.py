"""A constrained Delaunay triangulation that can be edited step by step, and frozen at any time."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

import operator
from dataclasses import replace
from itertools import islice
from typing import Self, cast, overload

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points
from exactkernel.context import chunk_size
from exactkernel.coordinates import doubles_of
from exactkernel.errors import CoordinateError, shown
from exactkernel.orient2d import orient2d
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import Coordinate, FloatArray, IntArray, PointLike
from exactmesh.assembly import Task, assembled, cut_out, in_order
from exactmesh.coincident import first_of_each, lexicographic_order
from exactmesh.constrain import constrained_delaunay
from exactmesh.delaunay import Insertion
from exactmesh.editing.deletion import constraints_at, forget, is_only_apex, remove_vertex
from exactmesh.editing.draft import (
    EDGES,
    FLIPS,
    NUMBERS,
    SEGMENTS,
    VERTICES,
    Draft,
    empty_draft,
    fitted,
    settled,
    standing,
    with_room,
    with_room_for_segments,
)  # fmt: skip
from exactmesh.editing.insertion import insert_vertices
from exactmesh.editing.segmentation import add_segment, groups_of, look_along, members
from exactmesh.errors import (
    CollinearPointsError,
    ConstrainedVertexError,
    CrossingError,
    TooFewPointsError,
    TopologyError,
)  # fmt: skip
from exactmesh.ids import Vertex
from exactmesh.ordering import insertion_order
from exactmesh.pslg import PSLG
from exactmesh.triangulation import Triangulation

__all__ = ["TriangulationBuilder"]

_CHUNK = 1 << 15  # points between two looks at Ctrl-C, where predicates are fast
_NAMED = 3  # segments that a message spells out
_SPLIT = 'make the builder from constrained_delaunay(pslg, carve=False, crossings="split")'
_POINT_FIRST = "insert a point where they cross, and segments by way of it"


def _row(point: PointLike) -> FloatArray:
    """Return a point as an array (1, 2) of finite doubles."""
    exact = doubles_of(point)
    if exact is None:
        raise CoordinateError(f"{shown(point)} would be rounded to doubles")
    return np.array([exact])


def _with_points(draft: Draft, points: FloatArray, first: int) -> Draft:
    """Return the draft with room for more vertex numbers, where the points' coordinates stand from the first on."""
    draft = fitted(with_room(draft, first + len(points)), points)
    draft.plane.xy[2 * first : 2 * (first + len(points))] = np.ldexp(points, draft.exponent).reshape(-1)
    return draft


class TriangulationBuilder:
    """An editor of a constrained Delaunay triangulation: insert points and segments, delete vertices, freeze.

    After every step it holds THE constrained Delaunay triangulation of its vertices and segments in their convex hull:
    :meth:`triangulation` returns the same as ``constrained_delaunay(PSLG(points, segments), carve=False)``, in whatever
    order the steps came. Until three vertices are not on one line, everything is remembered and there is no triangle.

    A vertex number stays what it is until the vertex is deleted, and is not used again. Bad input raises an error and
    changes nothing. An interrupt (Ctrl-C) comes before a step or after it; ``insert_points`` may be stopped in between,
    after some of the points.

    Args:
        points: (n, 2) finite coordinates. Number i is point i; for points at the same position, all their numbers stand
            for one vertex, which has the first of them.
        segments: integers (s, 2), rows of points. Number j is row j, without those that join the same two positions
            as an earlier one.

    Raises:
        PSLGError, CrossingError: as for :func:`exactmesh.constrained_delaunay`.
        NonFiniteError, CoordinateError, ShapeError: as for :func:`exactmesh.delaunay`.

    >>> from exactmesh import TriangulationBuilder
    >>> builder = TriangulationBuilder([(0, 0), (4, 0), (4, 4), (0, 4)])
    >>> builder.insert_segment(0, 2)
    0
    >>> builder.insert_point(2, 2)                      # on the segment: it becomes two edges
    4
    >>> builder.triangulation().segments.tolist()
    [[0, 4], [4, 2]]
    >>> builder.insert_segment(1, 4), builder.insert_segment(4, 3)
    (1, 2)
    >>> builder.delete_vertex(4)
    Traceback (most recent call last):
    exactmesh.errors.ConstrainedVertexError: vertex 4 cannot be deleted: it lies on segments 0 (0, 2), 1 (1, 4), \
2 (4, 3)
    """

    _draft: Draft
    _places: dict[tuple[float, float], int]  # while there are no triangles: the vertex at each position

    def __init__(self, points: npt.ArrayLike = (), segments: npt.ArrayLike = ()) -> None:
        graph = PSLG(points, segments)
        self._places = {}
        self._draft = empty_draft()
        if len(graph.points) == 0:
            return
        draft = self._pending(graph.points)
        ends = graph.representative[graph.segments]
        _, first = np.unique(np.sort(ends, axis=1), axis=0, return_index=True)
        ends = ends[np.sort(first)]
        draft.tally[SEGMENTS] = len(ends)
        self._settle(draft._replace(ends=np.concatenate([ends, np.empty((8, 2), dtype=np.int64)])), len(graph.points))
        if self._draft.tally[NUMBERS] == 0:
            try:
                constrained_delaunay(graph, carve=False)
            except CrossingError as error:
                raise CrossingError(error.pairs, graph.points, graph.segments, remedy=_SPLIT) from None
            raise CrossingError([])

    @classmethod
    def from_pslg(cls, pslg: PSLG) -> Self:
        """Return a builder of the graph's points and segments; its seeds, markers and attributes are left behind."""
        return cls(pslg.points, pslg.segments)

    @classmethod
    def from_triangulation(cls, mesh: Triangulation) -> Self:
        """Return a builder of the triangulation's vertices, with its constrained edges for segments.

        Numbers are those of the rows of ``mesh.points`` and ``mesh.segments``. What was carved away comes back, for a
        builder keeps the whole convex hull; an edge that is neither constrained nor Delaunay does not.
        """
        return cls(mesh.points, mesh.segments)

    def __len__(self) -> int:
        """Return the number of vertices."""
        return int(self._draft.tally[VERTICES])

    def __repr__(self) -> str:
        return f"TriangulationBuilder({len(self)} vertices, {self._draft.tally[SEGMENTS]} segments)"

    @property
    def vertices(self) -> IntArray:
        """The numbers of the vertices, int32 (n,), ascending. O(n)."""
        return standing(self._draft, int(self._draft.tally[NUMBERS]))

    @property
    def segments(self) -> IntArray:
        """The vertices that the segments join, int32 (s, 2), by the segments' numbers. O(s)."""
        return self._draft.ends[: self._draft.tally[SEGMENTS]].astype(np.int32)

    @overload
    def insert_point(self, x: Coordinate, y: Coordinate, /) -> Vertex: ...

    @overload
    def insert_point(self, point: PointLike, /) -> Vertex: ...

    def insert_point(self, x: Coordinate | PointLike, y: Coordinate | None = None, /) -> Vertex:
        """Insert a point, given by two coordinates or as a pair; return its vertex: the one that is there, if one is.

        A point on a segment splits the edge there into two edges of the same segments.

        Raises:
            NonFiniteError, CoordinateError, ShapeError: it is no point with finite double coordinates.

        A straight walk from the last point that was inserted, and flips: amortised O(1), but for these.

        >>> from exactmesh import TriangulationBuilder
        >>> builder = TriangulationBuilder()
        >>> [builder.insert_point(*p) for p in [(0, 0), (2, 0), (0, 2), (2, 2), (2, 0)]]
        [0, 1, 2, 3, 1]
        """
        row = _row(cast("PointLike", x if y is None else (x, y)))
        if self._draft.tally[EDGES] == 0:
            return Vertex(self._insert_flat(row))
        p = int(self._draft.tally[NUMBERS])
        self._draft = draft = _with_points(self._draft, row, p)
        insert_vertices(draft, np.array([p]), 0, 1)
        raise_if_interrupted()
        return Vertex(int(draft.twin[p]))

    def insert_points(self, points: npt.ArrayLike) -> IntArray:
        """Insert many points, in an order that makes it fast; return the vertex of each, int32 (n,).

        Each point takes a number; those that lie where a vertex is stand for it.

        Raises:
            NonFiniteError, CoordinateError, ShapeError: as for :func:`exactmesh.delaunay`.

        >>> from exactmesh import TriangulationBuilder
        >>> TriangulationBuilder([(0, 0), (1, 0), (0, 1)]).insert_points([(1, 1), (0, 1), (1, 1), (2, 2)]).tolist()
        [3, 2, 3, 6]
        """
        given = finite_points(points)
        first, stop = int(self._draft.tally[NUMBERS]), int(self._draft.tally[NUMBERS]) + len(given)
        if len(given) == 0:
            return np.empty(0, dtype=np.int32)
        if self._draft.tally[EDGES] == 0:
            self._settle(self._pending(given), stop)
            return self._draft.twin[first:stop].copy()
        self._draft = draft = _with_points(self._draft, given, first)
        draft.twin[first:stop] = -1
        draft.tally[NUMBERS] = stop
        original = first_of_each(given, lexicographic_order(given))
        rows = np.flatnonzero(original == np.arange(len(given)))
        numbers = first + rows[insertion_order(given[rows], 0)]
        size = chunk_size(draft.plane.k, _CHUNK)
        for start in range(0, len(numbers), size):
            insert_vertices(draft, numbers, start, min(start + size, len(numbers)))
            raise_if_interrupted()
        draft.twin[first:stop] = draft.twin[first + original]
        return draft.twin[first:stop].copy()

    def insert_segment(self, u: int, v: int) -> int:
        """Insert the segment between two vertices; return its number: the one it has, if it is there already.

        Vertices on its way split it into several edges. Where it overlaps with other segments, they share edges.

        Raises:
            CrossingError: it crosses other segments; ``pairs`` has a row for each, with the number that this one would
                have got.
            TopologyError: u or v is no vertex, or both are the same.

        O(the edges that it crosses, and the degree of u or v).

        >>> from exactmesh import TriangulationBuilder
        >>> builder = TriangulationBuilder([(0, 0), (4, 0), (4, 4), (0, 4)], [(0, 2)])
        >>> builder.insert_segment(1, 3)
        Traceback (most recent call last):
        exactmesh.errors.CrossingError: segments cross: 0 and 1 [(0.0, 0.0) to (4.0, 4.0), (4.0, 0.0) to \
(0.0, 4.0)] (insert a point where they cross, and segments by way of it)
        """
        a, b = self._vertex(u), self._vertex(v)
        if a == b:
            raise TopologyError(f"a segment from vertex {u} to vertex {v} has no length", indices=[a])
        if self._draft.tally[EDGES] == 0:
            return self._insert_flat_segment(a, b)
        way = look_along(self._draft, a, b)
        raise_if_interrupted()
        number = int(self._draft.tally[SEGMENTS])
        if way.crossed:
            crossing = members(self._draft, self._draft.plane.crossed[: way.crossed])
            ends = np.vstack([self.segments, (a, b)])
            points = np.ldexp(self._draft.plane.xy.reshape(-1, 2), -self._draft.exponent)
            raise CrossingError([(s, number) for s in crossing], points, ends, remedy=_POINT_FIRST)
        if way.same >= 0:
            return int(way.same)
        self._draft = draft = with_room_for_segments(self._draft, int(way.shared) + 2)
        draft.ends[number] = a, b
        add_segment(draft, np.array([number]), np.empty((int(way.pieces), 2), dtype=np.int32))
        raise_if_interrupted()
        return number

    def delete_vertex(self, v: int) -> None:
        """Delete a vertex, on the hull or not. The numbers of the others stay; this one is not used again.

        Raises:
            ConstrainedVertexError: it lies on segments, at an end or inside of them; ``indices`` names them.
            TopologyError: there is no such vertex.

        About O(d log d) for d neighbors.

        >>> from exactmesh import TriangulationBuilder
        >>> builder = TriangulationBuilder([(0, 0), (4, 0), (4, 4), (0, 4), (1, 2)])
        >>> builder.delete_vertex(1)
        >>> builder.vertices.tolist(), builder.triangulation().representative.tolist()
        ([0, 2, 3, 4], [0, -1, 1, 2, 3])
        """
        a, draft = self._vertex(v), self._draft
        self._places = {}
        if draft.tally[EDGES]:
            edges = draft.plane.crossed[: constraints_at(draft, a)]
            self._refuse_constrained(a, members(draft, edges))
            (forget if is_only_apex(draft, a) else remove_vertex)(draft, a)
            raise_if_interrupted()
        else:
            self._refuse_constrained(a, self._flat_segments_at(a))
            forget(draft, a)

    def triangulation(self) -> Triangulation:
        """Return the constrained Delaunay triangulation of the hull as it is now: frozen, a copy.

        Its vertices are numbered in the order of their numbers here: ``representative`` has the one of each, and -1 for
        those that were deleted. Its ``pslg`` are the vertices, in that order, and the segments; ``work`` counts since
        the builder was made, without the flips of deletions.

        Raises:
            TooFewPointsError, CollinearPointsError: there is no triangle.

        O(n log n).
        """
        draft, tally = self._draft, self._draft.tally
        numbers, edges = int(tally[NUMBERS]), int(tally[EDGES])
        alive = standing(draft, numbers)
        name = np.full(draft.plane.ghost + 1, -1, dtype=np.int32)
        name[alive], name[draft.plane.ghost] = np.arange(len(alive), dtype=np.int32), len(alive)
        points = np.ldexp(draft.plane.xy.reshape(-1, 2)[alive], -draft.exponent)
        ends = name[draft.ends[: tally[SEGMENTS]]]
        graph = PSLG(points, ends)
        if edges == 0:
            return constrained_delaunay(graph, carve=False)
        order, xy, org = np.arange(len(alive)), points.reshape(-1), name[draft.plane.org[: 2 * edges]]
        built = Insertion(
            draft.plane.k,
            xy,
            order,
            draft.plane.ring[: 4 * edges],
            org,
            order.astype(np.int32),
            edges,
            int(tally[FLIPS]),
        )
        rows = np.empty((groups_of(draft, edges, draft.group[:0]), 2), dtype=np.int32)
        groups_of(draft, edges, rows)
        task, constrained = Task(graph, graph, None, None), in_order(draft.plane._replace(xy=xy, org=org), ends, rows)
        mesh = assembled(task, built, constrained, cut_out(task, built, constrained))
        twin = draft.twin[:numbers]
        return replace(mesh, representative=np.where(twin < 0, np.int32(-1), name[twin]))

    def _vertex(self, v: int) -> int:
        """Return the vertex that the number v stands for."""
        draft = self._draft
        try:
            number = operator.index(v)
        except TypeError:
            raise TopologyError(f"a vertex is an integer, not {shown(v)}") from None
        if not 0 <= number < draft.tally[NUMBERS]:
            raise TopologyError(f"there is no vertex {shown(v)}", indices=[number])
        stands = int(draft.twin[number])
        if stands < 0 or draft.twin[stands] < 0:
            raise TopologyError(f"vertex {number} was deleted", indices=[number])
        return stands

    def _refuse_constrained(self, v: int, segments: list[int]) -> None:
        if segments:
            named = ", ".join(f"{s} {tuple(self._draft.ends[s].tolist())}" for s in segments[:_NAMED])
            more = f" and {len(segments) - _NAMED} more" if len(segments) > _NAMED else ""
            which = "segment" if len(segments) == 1 else "segments"
            raise ConstrainedVertexError(
                f"vertex {v} cannot be deleted: it lies on {which} {named}{more}", indices=segments
            )

    # As long as all vertices lie on one line, there is nothing but lists.

    def _pending(self, points: FloatArray) -> Draft:
        """Return the draft with these points behind its vertex numbers, which do not tally yet."""
        first = int(self._draft.tally[NUMBERS])
        draft, numbers = _with_points(self._draft, points, first), first + np.arange(len(points), dtype=np.int32)
        known = standing(draft, first)
        places = np.concatenate([draft.plane.xy.reshape(-1, 2)[known], draft.plane.xy.reshape(-1, 2)[numbers]])
        original = first_of_each(places, lexicographic_order(places))[len(known) :]
        draft.twin[numbers] = np.concatenate([known, numbers])[original]
        return draft

    def _settle(self, draft: Draft, numbers: int) -> None:
        """Triangulate the first vertex numbers of a draft without edges, if they are not all on one line."""
        self._places = {}
        try:
            found = settled(draft, numbers)
        except (TooFewPointsError, CollinearPointsError):
            tally = draft.tally.copy()
            tally[NUMBERS], tally[VERTICES] = numbers, len(standing(draft, numbers))
            found = draft._replace(tally=tally)
        if found is not None:
            self._draft = found

    def _insert_flat(self, row: FloatArray) -> int:
        x, y = row[0].tolist()
        p = int(self._draft.tally[NUMBERS])
        places = self._flat_places()
        if (x, y) in places:
            return places[x, y]
        draft = _with_points(self._draft, row, p)
        draft.twin[p] = p
        line = [*islice(places, 2)]
        if len(line) == 2 and orient2d(line[0], line[1], (x, y)) != 0:
            self._settle(draft, p + 1)
            return p
        tally = draft.tally.copy()
        tally[NUMBERS], tally[VERTICES] = p + 1, len(places) + 1
        self._draft = draft._replace(tally=tally)
        places[x, y] = p
        return p

    def _flat_places(self) -> dict[tuple[float, float], int]:
        """Return the vertex at each position, made anew when something else has changed the vertices."""
        draft = self._draft
        if len(self._places) != draft.tally[VERTICES]:
            alive = self.vertices
            points = np.ldexp(draft.plane.xy.reshape(-1, 2)[alive], -draft.exponent)
            self._places = dict(zip(map(tuple, points.tolist()), alive.tolist(), strict=True))
        return self._places

    def _insert_flat_segment(self, a: int, b: int) -> int:
        number = int(self._draft.tally[SEGMENTS])
        ends = self._draft.ends[:number]
        same = np.flatnonzero(((ends == (a, b)) | (ends == (b, a))).all(axis=1))
        if same.size:
            return int(same[0])
        self._draft = draft = with_room_for_segments(self._draft, 0)
        draft.ends[number] = a, b
        draft.tally[SEGMENTS] += 1
        return number

    def _flat_segments_at(self, v: int) -> list[int]:
        """Return the segments that pass through v or end in it. O(s)."""
        xy = self._draft.plane.xy.reshape(-1, 2)
        rank = np.empty(len(xy), dtype=np.int64)
        rank[lexicographic_order(xy)] = np.arange(len(xy))
        ends = rank[self._draft.ends[: self._draft.tally[SEGMENTS]]]
        through = (ends.min(axis=1) <= rank[v]) & (rank[v] <= ends.max(axis=1))
        return np.flatnonzero(through).tolist()
