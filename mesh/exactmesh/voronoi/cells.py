"""Cells inside of a window or a domain, as polygons in flat arrays."""

from dataclasses import dataclass, fields
from enum import IntEnum
from functools import cached_property

import numpy as np
import numpy.typing as npt
from gmpy2 import mpq

from exactkernel.constructions import circumcentre
from exactkernel.coordinates import rational_point
from exactkernel.jit import jit
from exactkernel.rational import RationalPoint
from exactkernel.types import FloatArray, IntArray
from exactmesh.ordering import IndexArray
from exactmesh.voronoi.areas import area_of_polygon

__all__ = ["Cells", "CornerKind", "exact_crossing"]

KindArray = npt.NDArray[np.int8]


class CornerKind(IntEnum):
    """What a corner of a clipped cell is, and what ``Cells.sources`` counts: rows of ..."""

    VERTEX = 0
    """A Voronoi vertex: ``vertex_sites``."""
    CROSSING = 1
    """Where a ridge meets a side of the window: ``crossings``."""
    WINDOW = 2
    """A corner of the window: ``window``."""
    MIDPOINT = 3
    """The middle of an edge of the domain's boundary: ``midpoints``."""
    SITE = 4
    """A site on the domain's boundary: ``points``."""


def exact_crossing(s: RationalPoint, p: RationalPoint, a: RationalPoint, b: RationalPoint) -> RationalPoint:
    """Return the exact point of the line ab that is as far from s as from p."""
    wx, wy, dx, dy = p[0] - s[0], p[1] - s[1], b[0] - a[0], b[1] - a[1]
    t = (wx * (s[0] + p[0] - 2 * a[0]) + wy * (s[1] + p[1] - 2 * a[1])) / (2 * (wx * dx + wy * dy))
    return a[0] + t * dx, a[1] + t * dy


@jit
def _moments(
    points: FloatArray, sites: IntArray, offsets: IndexArray, corners: FloatArray, moments: FloatArray
) -> None:
    """Add to each row the integrals of 1, x, y and x^2 + y^2 over the polygons of a site, relative to the site."""
    for p in range(len(sites)):
        s = sites[p]
        x0, y0 = points[s, 0], points[s, 1]
        last = offsets[p + 1] - 1
        ax, ay = corners[last, 0] - x0, corners[last, 1] - y0
        for j in range(offsets[p], offsets[p + 1]):
            bx, by = corners[j, 0] - x0, corners[j, 1] - y0
            cross = ax * by - ay * bx
            moments[s, 0] += cross / 2.0
            moments[s, 1] += cross * (ax + bx) / 6.0
            moments[s, 2] += cross * (ay + by) / 6.0
            squares = ax * ax + ax * bx + bx * bx + ay * ay + ay * by + by * by
            moments[s, 3] += cross * squares / 12.0
            ax, ay = bx, by


@dataclass(frozen=True, eq=False, repr=False)
class Cells:
    """The parts of Voronoi cells inside of a window or a domain: polygons, counterclockwise. Every array is read-only.

    Cells that do not meet the inside of the window have no polygon. In a convex window a cell has one polygon at most.

    Attributes:
        points: float64 (n, 2), the sites.
        sites: int32 (p,), the site of each polygon, ascending.
        offsets: int64 (p + 1,), polygon i has the corners from offsets[i] to offsets[i + 1].
        corners: float64 (c, 2), each the nearest doubles; see :meth:`exact_polygon`.
        neighbors: int32 (c,), the site across the edge from each corner to the next; -1 - i for side i of the window,
            or -1 for the boundary of the domain.
        kinds, sources: int8 (c,), int32 (c,), what each corner is, a :class:`CornerKind`, and which one.
        window: float64 (k, 2), the convex window, counterclockwise; none for a domain.
        vertex_sites: int32 (v, 3), three sites on the circle of each Voronoi vertex.
        crossings: int32 (x, 3), two sites and the side of the window that their ridge meets.
        midpoints: int32 (b, 2), the ends of edges of the domain's boundary.
    """

    points: FloatArray
    sites: IntArray
    offsets: IndexArray
    corners: FloatArray
    neighbors: IntArray
    kinds: KindArray
    sources: IntArray
    window: FloatArray
    vertex_sites: IntArray
    crossings: IntArray
    midpoints: IntArray

    def __reduce__(self) -> "tuple[type[Cells], tuple[object, ...]]":
        # copies and pickles are made anew: numpy does not pass on that an array is read-only
        return Cells, tuple(getattr(self, f.name) for f in fields(self))

    def __post_init__(self) -> None:
        for f in fields(self):
            array = getattr(self, f.name)
            if array.base is not None:  # that would stay writable
                array = array.copy()
                object.__setattr__(self, f.name, array)
            array.setflags(write=False)

    def __repr__(self) -> str:
        return f"Cells({len(self.sites)} polygons, {len(self.corners)} corners)"

    def polygon(self, i: int) -> FloatArray:
        """Return the corners of polygon i, float64 (k, 2), counterclockwise."""
        return self.corners[self.offsets[i] : self.offsets[i + 1]]

    @cached_property
    def _integrals(self) -> FloatArray:
        moments = np.zeros((len(self.points), 4))
        with np.errstate(over="ignore", invalid="ignore", under="ignore"):  # interpreted, numpy scalars warn
            _moments(self.points, self.sites, self.offsets, self.corners, moments)
        return moments

    @cached_property
    def areas(self) -> FloatArray:
        """The area of each site's part, float64 (n,), 0 where there is none; from the rounded corners. O(c)."""
        areas = self._integrals[:, 0].copy()
        areas.setflags(write=False)
        return areas

    @cached_property
    def centroids(self) -> FloatArray:
        """The centroid of each site's part, float64 (n, 2); NaN where there is none. O(c)."""
        with np.errstate(divide="ignore", invalid="ignore"):
            centroids: FloatArray = self.points + self._integrals[:, 1:3] / self._integrals[:, :1]
        centroids.setflags(write=False)
        return centroids

    @cached_property
    def energies(self) -> FloatArray:
        """The integral of the squared distance from the site over each site's part, float64 (n,). O(c)."""
        energies = self._integrals[:, 3].copy()
        energies.setflags(write=False)
        return energies

    def exact_corner(self, j: int) -> RationalPoint:
        """Return the exact coordinates of corner j."""
        kind, source = CornerKind(int(self.kinds[j])), int(self.sources[j])
        if kind is CornerKind.VERTEX:
            a, b, c = (self.points[v].tolist() for v in self.vertex_sites[source])
            return circumcentre(a, b, c)
        if kind is CornerKind.CROSSING:
            s, p, side = self.crossings[source].tolist()
            ends = self.window[[side, (side + 1) % len(self.window)]].tolist()
            return exact_crossing(*map(rational_point, (*self.points[[s, p]].tolist(), *ends)))
        if kind is CornerKind.MIDPOINT:
            (ax, ay), (bx, by) = map(rational_point, self.points[self.midpoints[source]].tolist())
            return (ax + bx) / 2, (ay + by) / 2
        place = self.window if kind is CornerKind.WINDOW else self.points
        return rational_point(place[source].tolist())

    def exact_polygon(self, i: int) -> list[RationalPoint]:
        """Return the exact corners of polygon i.

        >>> from exactmesh import voronoi
        >>> voronoi([(0, 0), (1, 0)], clip=(-1, -1, 2, 1)).clipped.exact_polygon(0)[3]
        (mpq(1,2), mpq(-1,1))
        """
        return [self.exact_corner(j) for j in range(self.offsets[i], self.offsets[i + 1])]

    def exact_area(self, i: int) -> mpq:
        """Return the exact area of polygon i; those of all polygons add up to that of the window, exactly.

        >>> from exactmesh import voronoi
        >>> cells = voronoi([(0, 0), (1, 0), (0, 3)], clip=[(0, 0), (1, 0), (0, 1)]).clipped
        >>> [str(cells.exact_area(i)) for i in range(len(cells.sites))]
        ['3/8', '1/8']
        """
        return area_of_polygon(self.exact_polygon(i))
