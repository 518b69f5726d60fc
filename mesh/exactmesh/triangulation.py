"""The frozen result: arrays that cannot be changed, and what can be asked of them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points
from exactkernel.context import INCIRCLE_ROW, ORIENT2D_ROW, Context
from exactkernel.types import FloatArray, IntArray, Stage
from exactmesh.connectivity import edges_of, hull_of
from exactmesh.errors import ShapeError, TopologyError
from exactmesh.locate import locate_points
from exactmesh.quadedge import QuadEdge
from exactmesh.quality import Statistics, statistics_of
from exactmesh.svg import svg_of

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


@dataclass(frozen=True, eq=False, repr=False)
class Triangulation:
    """A triangulation of the convex hull of its points, immutable: every array is read-only.

    Two triangulations are equal if their points and triangles are, number by number; compare ``canonical()`` forms to
    see whether they are the same up to the numbering.

    Attributes:
        points: float64 (n, 2), the vertices: distinct, y up.
        triangles: int32 (m, 3), the corners of each triangle, counterclockwise.
        neighbors: int32 (m, 3), the triangle across the edge opposite to each corner, -1 outside.
        representative: int32, the vertex that stands for each point of the input; duplicates share one.
        work: what it took to build it.

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
    work: Work = field(compare=False)

    def __reduce__(self) -> "tuple[type[Triangulation], tuple[FloatArray, IntArray, IntArray, IntArray, Work]]":
        # copies and pickles are made anew: numpy does not pass on that an array is read-only
        return Triangulation, (self.points, self.triangles, self.neighbors, self.representative, self.work)

    def __post_init__(self) -> None:
        vertices, faces = len(self.points), len(self.triangles)
        for name, numbers, low, high in (
            ("triangles", self.triangles, 0, vertices),
            ("neighbors", self.neighbors, -1, faces),
            ("representative", self.representative, 0, vertices),
        ):
            if numbers.size and not low <= numbers.min() <= numbers.max() < high:
                raise TopologyError(f"{name} has entries outside of {low} .. {high - 1}")
        if self.points.shape != (vertices, 2) or not self.triangles.shape == self.neighbors.shape == (faces, 3):
            raise ShapeError("points are (n, 2), triangles and neighbors (m, 3)")
        for array in (self.points, self.triangles, self.neighbors, self.representative):
            array.setflags(write=False)

    def __repr__(self) -> str:
        return f"Triangulation({len(self.points)} vertices, {len(self.triangles)} triangles)"

    def __eq__(self, other: object) -> bool:
        """Tell whether the points and triangles are the same, number by number."""
        if not isinstance(other, Triangulation):
            return NotImplemented
        return np.array_equal(self.points, other.points) and np.array_equal(self.triangles, other.triangles)

    def __hash__(self) -> int:
        return hash((len(self.points), self.triangles.tobytes()))

    @cached_property
    def edges(self) -> IntArray:
        """The edges, int32 (k, 2), each once; for one on the hull, the triangle is on its left."""
        return _frozen(edges_of(self.triangles, self.neighbors))

    @cached_property
    def hull(self) -> IntArray:
        """The vertices on the boundary of the hull, int32, counterclockwise from the lexicographically smallest.

        Vertices in the interior of a straight side are among them.
        """
        return _frozen(hull_of(self.points, self.triangles, self.neighbors))

    def locate(self, points: npt.ArrayLike) -> IntArray:
        """Return the triangle that contains each point, int32 (k,), -1 for points outside the hull.

        A point on an edge or a vertex gets one of the triangles there. Exact; a walk along a space-filling curve, so
        near-linear for many points. Raises as :func:`exactmesh.delaunay` does.

        >>> from exactmesh import delaunay
        >>> mesh = delaunay([(0, 0), (1, 0), (0, 1)])
        >>> mesh.locate([(0.2, 0.2), (0.5, 0.5), (1, 1)]).tolist()
        [0, 0, -1]
        """
        return locate_points(self.points, self.triangles, self.neighbors, finite_points(points))

    def quad_edge(self) -> QuadEdge:
        """Return a quad-edge of the triangulation, a fresh and mutable one: faces are triangle numbers, or OUTSIDE.

        >>> from exactmesh import delaunay
        >>> delaunay([(0, 0), (1, 0), (1, 1), (0, 1)]).quad_edge().counts()
        (4, 5, 3)
        """
        return QuadEdge.from_triangles(self.triangles, self.neighbors)

    def statistics(self) -> Statistics:
        """Return counts, angles, areas and lengths, in plain floating point. O(m)."""
        return statistics_of(self.points, self.triangles, len(self.edges), len(self.hull))

    def canonical(self) -> "Triangulation":
        """Return the same triangulation in a numbering that depends on nothing but the points.

        Vertices in lexicographic order, the smallest corner of each triangle first, triangles in order. O(m log m).

        >>> from exactmesh import delaunay
        >>> points = [(0, 0), (2, 0), (1, 3), (1, 1)]
        >>> delaunay(points).canonical() == delaunay(points[::-1], seed=7).canonical()
        True
        """
        order = np.lexsort((self.points[:, 1], self.points[:, 0]))
        rank = np.empty(len(order), dtype=np.int32)
        rank[order] = np.arange(len(order), dtype=np.int32)
        renamed = rank[self.triangles]
        turn = (renamed.argmin(axis=1)[:, None] + np.arange(3)) % 3
        triangles = np.take_along_axis(renamed, turn, axis=1)
        neighbors = np.take_along_axis(self.neighbors, turn, axis=1)
        rows = np.lexsort(triangles.T[::-1])
        place = np.full(len(rows) + 1, -1, dtype=np.int32)  # the last entry: outside
        place[rows] = np.arange(len(rows), dtype=np.int32)
        return Triangulation(
            points=self.points[order],
            triangles=triangles[rows],
            neighbors=place[neighbors[rows]],
            representative=rank[self.representative],
            work=self.work,
        )

    def _repr_svg_(self) -> str:
        return svg_of(self.points, self.edges)


def _frozen(array: IntArray) -> IntArray:
    array.setflags(write=False)
    return array
