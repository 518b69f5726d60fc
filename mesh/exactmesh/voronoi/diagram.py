"""The Voronoi diagram as flat arrays, read-only; lists where scipy's users expect them."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, fields
from functools import cached_property
from itertools import pairwise

import numpy as np
from gmpy2 import mpq

from exactkernel.coordinates import rational_point
from exactkernel.rational import RationalPoint
from exactkernel.types import FloatArray, IntArray
from exactmesh.ordering import IndexArray
from exactmesh.triangulation import Triangulation
from exactmesh.voronoi.areas import area_of_polygon, areas_of_cells
from exactmesh.voronoi.cells import Cells
from exactmesh.voronoi.centres import exact_centre, nearest_doubles

__all__ = ["Voronoi"]


@contextmanager
def _without_collection() -> Iterator[None]:
    """Millions of small lists without a cycle: looking for garbage among them takes longer than making them."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


@dataclass(frozen=True, eq=False, repr=False)
class Voronoi:
    """The Voronoi diagram of sites: the cell of a site is what lies at least as near to it as to any other.

    It is the dual of the Delaunay triangulation, exactly: cell i belongs to vertex i, ridge r to edge ``edge[r]``, and
    circumcentres of cocircular points are one vertex. Names that scipy.spatial.Voronoi has mean what they mean there;
    those that are lists there are lists here, made when they are first asked for. Every array is read-only.

    Attributes:
        points: float64 (n, 2), the sites: the distinct points, in the order of the input.
        vertices: float64 (v, 2), the Voronoi vertices: the doubles nearest to the exact ones, infinite beyond the
            doubles; see :meth:`exact_vertex`.
        ridge_points: int32 (r, 2), the two sites that each ridge lies between.
        ends: int32 (r, 2), the vertices at which each ridge ends, on the left of the way from the first of its sites to
            the second and on the right; -1 is infinity: a ray has its origin on the left, a line has no end.
        directions: float64 (r, 2), the direction of each ray, away from its origin, and of each line; zeros for
            segments; see :meth:`exact_direction`.
        edge: int32 (r,), the row in ``triangulation.edges`` that each ridge is dual to, in the same direction; the
            ridge is the edge turned clockwise by a right angle. Edges between cocircular points have no ridge.
        triangle_vertex: int32 (m,), the vertex that is the circumcentre of each triangle.
        offsets, cells, cell_ridges: int64 (n + 1,), int32 (2 r,), int32 (2 r,): the cell of site i is the entries from
            offsets[i] to offsets[i + 1], counterclockwise. cells[j] is a vertex, or -1 between two rays, and
            cell_ridges[j] the ridge from there to the next.
        point_region: int32, the site, and so the cell, of each point of the input; duplicates share one.
        triangulation: the Delaunay triangulation; None if the sites lie on one line, where ridges are parallel lines.
        clipped: the cells inside of the window, if one was given.

    >>> from exactmesh import voronoi
    >>> diagram = voronoi([(0, 0), (2, 0), (2, 2), (0, 2), (1, 4)])
    >>> diagram
    Voronoi(5 sites, 2 vertices, 6 ridges)
    >>> diagram.vertices.tolist()                    # the square has one circumcentre
    [[1.0, 1.0], [1.0, 2.75]]
    >>> [diagram.regions[r] for r in diagram.point_region]
    [[-1, 0], [-1, 0], [-1, 1, 0], [-1, 0, 1], [-1, 1]]
    """

    points: FloatArray
    vertices: FloatArray
    ridge_points: IntArray
    ends: IntArray
    directions: FloatArray
    edge: IntArray
    triangle_vertex: IntArray
    offsets: IndexArray
    cells: IntArray
    cell_ridges: IntArray
    point_region: IntArray
    triangulation: Triangulation | None
    clipped: Cells | None = None

    def __reduce__(self) -> "tuple[type[Voronoi], tuple[object, ...]]":
        # copies and pickles are made anew: numpy does not pass on that an array is read-only
        return Voronoi, tuple(getattr(self, f.name) for f in fields(self))

    def __post_init__(self) -> None:
        for f in fields(self):
            array = getattr(self, f.name)
            if isinstance(array, np.ndarray):
                if array.base is not None:  # that would stay writable
                    array = array.copy()
                    object.__setattr__(self, f.name, array)
                array.setflags(write=False)

    def __repr__(self) -> str:
        return f"Voronoi({len(self.points)} sites, {len(self.vertices)} vertices, {len(self.ends)} ridges)"

    @cached_property
    def ridge_vertices(self) -> list[list[int]]:
        """The two vertices of each ridge, as scipy has it: -1 is infinity, and comes first."""
        with _without_collection():
            rows: list[list[int]] = np.where(self.ends[:, 1:] < 0, self.ends[:, ::-1], self.ends).tolist()
        return rows

    @cached_property
    def regions(self) -> list[list[int]]:
        """The vertices of each cell, counterclockwise, as lists; -1 is infinity. Cell i is that of site i."""
        flat, bounds = self.cells.tolist(), self.offsets.tolist()
        with _without_collection():
            return [flat[i:j] for i, j in pairwise(bounds)]

    @property
    def furthest_site(self) -> bool:
        """False: cells are of nearest sites. With the next five, what scipy's users and plotting functions ask for."""
        return False

    @property
    def ndim(self) -> int:
        """2."""
        return 2

    @property
    def npoints(self) -> int:
        """The number of sites."""
        return len(self.points)

    @property
    def min_bound(self) -> FloatArray:
        """The least coordinates of the sites, float64 (2,)."""
        low: FloatArray = self.points.min(axis=0)
        return low

    @property
    def max_bound(self) -> FloatArray:
        """The largest coordinates of the sites, float64 (2,)."""
        high: FloatArray = self.points.max(axis=0)
        return high

    @cached_property
    def ridge_dict(self) -> dict[tuple[int, int], list[int]]:
        """The two vertices of the ridge between two sites, as in ``ridge_vertices``, by ``ridge_points``."""
        return dict(zip(map(tuple, self.ridge_points.tolist()), self.ridge_vertices, strict=True))

    @cached_property
    def areas(self) -> FloatArray:
        """The area of each cell, float64 (n,), infinite where it is unbounded; from the rounded vertices. O(n)."""
        areas = areas_of_cells(self.points, self.vertices, self.offsets, self.cells)
        for site in np.flatnonzero(np.isnan(areas)).tolist():  # with a vertex beyond the doubles
            exact = self.exact_area(site)
            areas[site] = np.inf if exact is None else nearest_doubles((exact, exact))[0]
        areas.setflags(write=False)
        return areas

    @cached_property
    def _first_triangle(self) -> IndexArray:
        return np.unique(self.triangle_vertex, return_index=True)[1]

    def neighbors(self, site: int) -> IntArray:
        """Return the sites whose cells share a ridge with that of the site, int32, counterclockwise."""
        pairs = self.ridge_points[self.cell_ridges[self.offsets[site] : self.offsets[site + 1]]]
        return np.where(pairs[:, 0] == site, pairs[:, 1], pairs[:, 0])

    def exact_vertex(self, vertex: int) -> RationalPoint:
        """Return the exact coordinates of a vertex.

        >>> from exactmesh import voronoi
        >>> voronoi([(0, 0), (3, 0), (1, 1)]).exact_vertex(0)
        (mpq(3,2), mpq(-1,2))
        """
        assert self.triangulation is not None
        mesh = self.triangulation
        return exact_centre(mesh.points, mesh.triangles, int(self._first_triangle[vertex]))

    def exact_direction(self, ridge: int) -> RationalPoint:
        """Return the exact direction of a ridge: from its site to its site, turned clockwise by a right angle.

        >>> from exactmesh import voronoi
        >>> voronoi([(0, 0), (0.5, 0)]).exact_direction(0)
        (mpq(0,1), mpq(-1,2))
        """
        (ax, ay), (bx, by) = (rational_point(self.points[v].tolist()) for v in self.ridge_points[ridge])
        return by - ay, ax - bx

    def exact_area(self, site: int) -> mpq | None:
        """Return the exact area of a cell; None if it is unbounded.

        >>> from exactmesh import voronoi
        >>> voronoi([(0, 0), (3, 0), (-3, 0), (0, 1), (0, -1)]).exact_area(0)
        mpq(3,1)
        """
        cell = self.cells[self.offsets[site] : self.offsets[site + 1]].tolist()
        if -1 in cell or not cell:
            return None
        return area_of_polygon([self.exact_vertex(v) for v in cell])
