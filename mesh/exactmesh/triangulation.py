"""The frozen result: arrays that cannot be changed, and what can be asked of them."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points
from exactkernel.batch import orient2d_batch
from exactkernel.context import INCIRCLE_ROW, ORIENT2D_ROW, Context
from exactkernel.types import FloatArray, IntArray, Stage
from exactmesh.columns import MarkerArray
from exactmesh.connectivity import check_corners, check_neighbors, edges_of, loops_of, planar_rings_of
from exactmesh.crossings import Arrangement
from exactmesh.errors import ShapeError, TopologyError
from exactmesh.locate import locate_points, on_boundary
from exactmesh.markers import boundary_edges, markers_of_edges
from exactmesh.pslg import PSLG
from exactmesh.quadedge import QuadEdge
from exactmesh.quality import Statistics, statistics_of
from exactmesh.svg import svg_of

A = TypeVar("A", bound=npt.NDArray[np.generic])

__all__ = ["Triangulation", "Work", "work_of"]


@dataclass(frozen=True, slots=True)
class Work:
    """What it took to build a triangulation.

    Attributes:
        flips: how many edges were flipped.
        orient2d: how many orientations each stage decided.
        incircle: how many incircle tests each stage decided.
    """

    flips: int
    orient2d: Mapping[Stage, int]
    incircle: Mapping[Stage, int]


def work_of(k: Context, flips: int) -> Work:
    """Return the tally of a context."""
    rows = ({stage: int(k.counts[row, stage]) for stage in Stage} for row in (ORIENT2D_ROW, INCIRCLE_ROW))
    return Work(flips, *rows)


def _no_pairs() -> IntArray:
    return np.empty((0, 2), dtype=np.int32)


def _no_markers() -> MarkerArray:
    return np.empty(0, dtype=np.int64)


def _no_points() -> FloatArray:
    return np.empty((0, 2), dtype=np.float64)


def _no_columns() -> FloatArray:
    return np.empty((0, 0), dtype=np.float64)


@dataclass(frozen=True, eq=False, repr=False)
class Triangulation:
    """A triangulation of the convex hull of its points, or of a domain; immutable: every array is read-only.

    Two triangulations are equal if their points, triangles and segments are, number by number; compare ``canonical()``
    forms to see whether they are the same up to the numbering.

    Attributes:
        points: float64 (n, 2), the vertices: distinct, y up.
        triangles: int32 (m, 3), the corners of each triangle, counterclockwise.
        neighbors: int32 (m, 3), the triangle across the edge opposite to each corner, -1 outside.
        representative: int32, the vertex that stands for each point of the input; duplicates share one, and -1 is a
            point that lies outside of the domain.
        work: what it took to build it.
        pslg: the graph that was triangulated, or None.
        arrangement: how its crossings became vertices, or None where there was no need.
        domain: what the triangles cover, for :func:`exactmesh.verify`; None is the convex hull.
        holes: float64 (h, 2), a point in each hole, whatever rule made it one.
        segments: int32 (s, 2), the constrained edges; without vertices inside of them, row i is segment i of the graph.
        segment_markers: int64 (s,), see :mod:`exactmesh.markers`.
        segment_incidence: int32 (k, 2), sorted rows (constrained edge, segment of the graph): a segment with vertices
            on it is several edges, and segments that overlap share some.
        vertex_markers: int64 (n,), see :mod:`exactmesh.markers`.
        vertex_attributes: float64 (n, a), those of the graph's points.
        triangle_attributes: float64 (m, 1), the attribute of the triangle's region or 0; (m, 0) without regions.
        triangle_regions: int32 (m,), the region of the graph that the triangle is in, or -1.

    >>> from exactmesh import delaunay
    >>> mesh = delaunay([(0, 0), (2, 0), (2, 2), (0, 2), (1, 1), (2, 0)])
    >>> mesh
    Triangulation(5 vertices, 4 triangles)
    >>> mesh.representative.tolist()                    # point 5 lies where point 1 does
    [0, 1, 2, 3, 4, 1]
    >>> mesh.neighbors[mesh.locate([(1, 0.5)])[0]].tolist().count(-1)   # that triangle has one edge on the hull
    1
    """

    points: FloatArray
    triangles: IntArray
    neighbors: IntArray
    representative: IntArray
    work: Work
    pslg: PSLG | None = None
    arrangement: Arrangement | None = None
    domain: PSLG | None = None
    holes: FloatArray = field(default_factory=_no_points)
    segments: IntArray = field(default_factory=_no_pairs)
    segment_markers: MarkerArray = field(default_factory=_no_markers)
    segment_incidence: IntArray = field(default_factory=_no_pairs)
    vertex_markers: MarkerArray = field(default_factory=_no_markers)
    vertex_attributes: FloatArray = field(default_factory=_no_columns)
    triangle_attributes: FloatArray = field(default_factory=_no_columns)
    triangle_regions: IntArray = field(default_factory=_no_pairs)

    def __reduce__(self) -> tuple[type[Triangulation], tuple[object, ...]]:
        # copies and pickles are made anew: numpy does not pass on that an array is read-only
        return Triangulation, tuple(getattr(self, f.name) for f in fields(self))

    def __post_init__(self) -> None:
        vertices, faces = len(self.points), len(self.triangles)
        rows = {"vertex_markers": vertices, "vertex_attributes": vertices, "triangle_attributes": faces}
        for name, length in rows.items():
            if len(getattr(self, name)) == 0 < length:
                empty = getattr(self, name)
                object.__setattr__(self, name, np.zeros((length, *empty.shape[1:]), dtype=empty.dtype))
        if self.triangle_regions.ndim == 2:
            object.__setattr__(self, "triangle_regions", np.full(faces, -1, dtype=np.int32))
        for name, numbers, low, high in (
            ("triangles", self.triangles, 0, vertices),
            ("neighbors", self.neighbors, -1, faces),
            ("representative", self.representative, -1, vertices),
            ("segments", self.segments, 0, vertices),
        ):
            if numbers.size and not low <= numbers.min() <= numbers.max() < high:
                raise TopologyError(f"{name} has entries outside of {low} .. {high - 1}")
        if self.points.shape != (vertices, 2) or not self.triangles.shape == self.neighbors.shape == (faces, 3):
            raise ShapeError("points are (n, 2), triangles and neighbors (m, 3)")
        for f in fields(self):
            array = getattr(self, f.name)
            if isinstance(array, np.ndarray):
                if array.base is not None:  # that would stay writable
                    array = array.copy()
                    object.__setattr__(self, f.name, array)
                array.setflags(write=False)

    def __repr__(self) -> str:
        segments = f", {len(self.segments)} segments" if len(self.segments) else ""
        return f"Triangulation({len(self.points)} vertices, {len(self.triangles)} triangles{segments})"

    def __eq__(self, other: object) -> bool:
        """Tell whether the points, triangles and segments are the same, number by number."""
        if not isinstance(other, Triangulation):
            return NotImplemented
        return all(np.array_equal(getattr(self, n), getattr(other, n)) for n in ("points", "triangles", "segments"))

    def __hash__(self) -> int:
        return hash((len(self.points), self.triangles.tobytes()))

    @cached_property
    def edges(self) -> IntArray:
        """The edges, int32 (k, 2), each once; for one on the hull, the triangle is on its left."""
        return _frozen(edges_of(self.triangles, self.neighbors))

    @cached_property
    def _loops(self) -> tuple[IntArray, ...]:
        return tuple(_frozen(loop) for loop in loops_of(self.points, self.triangles, self.neighbors))

    def boundary(self) -> tuple[IntArray, ...]:
        """Return the boundary as simple loops with the domain on their left, int32 each. O(m), once.

        Outer loops are counterclockwise, holes clockwise; loops that touch in a vertex are separate. Each starts with
        its lexicographically smallest vertex.

        >>> from exactmesh import delaunay
        >>> [loop.tolist() for loop in delaunay([(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)]).boundary()]
        [[0, 1, 2, 3]]
        """
        return self._loops

    @cached_property
    def hull(self) -> IntArray:
        """The vertices on the boundary of the hull, int32, counterclockwise from the lexicographically smallest.

        Vertices in the interior of a straight side are among them.

        Raises:
            TopologyError: the domain is not convex, so that it has no edges along its hull; see :meth:`boundary`.
        """
        if len(self._loops) == 1:
            (loop,) = self._loops
            corners = (self.points[np.roll(loop, -turn)] for turn in range(3))
            if (orient2d_batch(*corners) >= 0).all():
                return loop
        raise TopologyError("the domain is not convex: boundary() returns its boundary")

    def chain(self, segment: int) -> IntArray:
        """Return the edges along a segment of the graph, int32 (k, 2), in its direction. O(log s) and k log k.

        What of the segment lies outside of the domain is left out.

        Raises:
            TopologyError: there is no such segment.

        >>> from exactmesh import PSLG, constrained_delaunay
        >>> mesh = constrained_delaunay(PSLG([(0, 0), (2, 0), (2, 2), (1, 0)], [(0, 1), (1, 2), (2, 0)]))
        >>> mesh.chain(0).tolist()
        [[0, 3], [3, 1]]
        """
        if self.pslg is None or segment not in range(len(self.pslg.segments)):
            raise TopologyError(f"there is no segment {segment!r}")
        segment = int(segment)
        rows = self._by_segment
        first, last = np.searchsorted(rows[:, 1], [segment, segment + 1])
        edges = self.segments[rows[first:last, 0]]
        start, end = self.pslg.points[self.pslg.segments[segment]]
        along = self.points[edges] * np.where(start < end, 1.0, -1.0)  # grows along the segment on both axes
        edges = np.where(np.any(along[:, 0] < along[:, 1], axis=1, keepdims=True), edges, edges[:, ::-1])
        return edges[np.lexsort(along.min(axis=1).T)]

    @cached_property
    def _by_segment(self) -> IntArray:
        return self.segment_incidence[np.argsort(self.segment_incidence[:, 1], kind="stable")]

    @cached_property
    def edge_markers(self) -> MarkerArray:
        """The marker of each edge, int64 (k,): that of its constrained edge, else 1 on the boundary, else 0."""
        on_boundary = boundary_edges(self.triangles, self.neighbors)
        return _frozen(markers_of_edges(self.edges, on_boundary, self.segments, self.segment_markers))

    def locate(self, points: npt.ArrayLike) -> IntArray:
        """Return the triangle that contains each point, int32 (k,), -1 for points outside the domain.

        A point on an edge or a vertex gets one of the triangles there. Exact; a walk along a space-filling curve, so
        near-linear for many points. A domain that is not convex is completed to its hull first, once: O(m + b log b)
        for b edges on its boundary. Raises as :func:`exactmesh.delaunay` does.

        >>> from exactmesh import delaunay
        >>> mesh = delaunay([(0, 0), (1, 0), (0, 1)])
        >>> mesh.locate([(0.2, 0.2), (0.5, 0.5), (1, 1)]).tolist()
        [0, 0, -1]
        """
        queries, m = finite_points(points), len(self.triangles)
        if m == 0:
            return np.full(len(queries), -1, dtype=np.int32)
        triangles, neighbors = self._complete
        found = locate_points(self.points, triangles, neighbors, queries)
        outside = np.flatnonzero(found >= m)
        if outside.size:
            found[outside] = on_boundary(self.points, triangles, neighbors, m, queries[outside], found[outside])
        return found

    @cached_property
    def _complete(self) -> tuple[IntArray, IntArray]:
        """Triangles and neighbors that cover the hull, these first."""
        try:
            if len(self.hull):
                return self.triangles, self.neighbors
        except TopologyError:
            pass
        from exactmesh.completion import completed  # which triangulates, and so imports this module

        return completed(self.points, self.triangles, self.neighbors)

    def quad_edge(self) -> QuadEdge:
        """Return a quad-edge of the triangulation, a fresh and mutable one: faces are triangle numbers, or OUTSIDE.

        Where triangles meet in a vertex without an edge between them, its ring has all its edges in their order, with
        OUTSIDE in the gaps.

        >>> from exactmesh import delaunay
        >>> delaunay([(0, 0), (1, 0), (1, 1), (0, 1)]).quad_edge().counts()
        (4, 5, 3)
        """
        check_corners(self.triangles)
        check_neighbors(self.triangles, self.neighbors)
        return QuadEdge.from_arrays(*planar_rings_of(self.points, self.triangles, self.neighbors))

    def statistics(self) -> Statistics:
        """Return counts, angles, areas and lengths, in plain floating point. O(m)."""
        return statistics_of(self.points, self.triangles, len(self.edges), int((self.neighbors < 0).sum()))

    def canonical(self) -> Triangulation:
        """Return the same triangulation in a numbering that depends on nothing but the points.

        Vertices in lexicographic order, the smallest corner of each triangle first, triangles in order. O(m log m).

        >>> from exactmesh import delaunay
        >>> points = [(0, 0), (2, 0), (1, 3), (1, 1)]
        >>> delaunay(points).canonical() == delaunay(points[::-1], seed=7).canonical()
        True
        """
        order = np.lexsort((self.points[:, 1], self.points[:, 0]))
        rank = _inverse(order)
        renamed = rank[self.triangles]
        turn = (renamed.argmin(axis=1)[:, None] + np.arange(3)) % 3
        triangles = np.take_along_axis(renamed, turn, axis=1)
        neighbors = np.take_along_axis(self.neighbors, turn, axis=1)
        rows = np.lexsort(triangles.T[::-1])
        segments = np.sort(rank[self.segments], axis=1)
        lines = np.lexsort(segments.T[::-1])
        incidence = self.segment_incidence.copy()
        incidence[:, 0] = _inverse(lines)[incidence[:, 0]]
        return replace(
            self,
            points=self.points[order],
            triangles=triangles[rows],
            neighbors=np.append(_inverse(rows), np.int32(-1))[neighbors[rows]],
            representative=np.append(rank, np.int32(-1))[self.representative],
            segments=segments[lines],
            segment_markers=self.segment_markers[lines],
            segment_incidence=incidence[np.lexsort(incidence.T[::-1])],
            vertex_markers=self.vertex_markers[order],
            vertex_attributes=self.vertex_attributes[order],
            triangle_attributes=self.triangle_attributes[rows],
            triangle_regions=self.triangle_regions[rows],
        )

    def _repr_svg_(self) -> str:
        return svg_of(self.points, self.edges)


def _inverse(order: npt.NDArray[np.int64]) -> IntArray:
    place = np.empty(len(order), dtype=np.int32)
    place[order] = np.arange(len(order), dtype=np.int32)
    return place


def _frozen(array: A) -> A:
    array.setflags(write=False)
    return array
