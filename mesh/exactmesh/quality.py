"""Angles, areas and lengths, in plain floating point: for people to read, never to decide anything."""

from dataclasses import dataclass

import numpy as np

from exactkernel.types import FloatArray, IntArray

__all__ = ["Statistics", "angles_of", "areas_of", "lengths_of", "statistics_of"]


@dataclass(frozen=True, slots=True)
class Statistics:
    """What a triangulation looks like, rounded.

    Attributes:
        vertices, triangles, edges, hull_vertices: counts.
        area: of the hull, in squared units of the coordinates; ``smallest_area``, ``largest_area`` of a triangle.
        smallest_angle, largest_angle: in degrees.
        shortest_edge, longest_edge: in units of the coordinates.
    """

    vertices: int
    triangles: int
    edges: int
    hull_vertices: int
    area: float
    smallest_area: float
    largest_area: float
    smallest_angle: float
    largest_angle: float
    shortest_edge: float
    longest_edge: float


def _sides(points: FloatArray, triangles: IntArray) -> tuple[FloatArray, int]:
    """Return the vectors of the edges opposite to each corner, (m, 3, 2), halved so many times (0 or 1)."""
    corners = points[triangles]
    halvings = int(np.abs(points).max(initial=0.0) >= 2.0**1023)  # a difference might overflow
    corners = np.ldexp(corners, -halvings)
    sides: FloatArray = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)
    return sides, halvings


def _normalised_sides(points: FloatArray, triangles: IntArray) -> tuple[FloatArray, IntArray]:
    """Return the sides and the binary exponent by which those of each triangle were divided: below 1, no square of
    the largest over- or underflows."""
    sides, halvings = _sides(points, triangles)
    exponents = np.frexp(np.abs(sides).max(axis=(1, 2), initial=0.0))[1]
    return np.ldexp(sides, -exponents[:, None, None]), exponents + halvings


def areas_of(points: FloatArray, triangles: IntArray) -> FloatArray:
    """Return the signed area of each triangle, float64 (m,), positive if counterclockwise."""
    sides, exponents = _normalised_sides(points, triangles)
    areas = 0.5 * (sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
    with np.errstate(over="ignore", under="ignore"):
        scaled: FloatArray = np.ldexp(areas, 2 * exponents)
    return scaled


def lengths_of(points: FloatArray, triangles: IntArray) -> FloatArray:
    """Return the length of the edge opposite to each corner, float64 (m, 3)."""
    sides, halvings = _sides(points, triangles)
    with np.errstate(over="ignore"):
        lengths: FloatArray = np.ldexp(np.hypot(sides[..., 0], sides[..., 1]), halvings)
    return lengths


def angles_of(points: FloatArray, triangles: IntArray) -> FloatArray:
    """Return the angle at each corner in degrees, float64 (m, 3); those of a needle are small, and not 0."""
    sides, _ = _normalised_sides(points, triangles)
    after, before = np.roll(sides, -1, axis=1), np.roll(sides, -2, axis=1)
    longest = (sides**2).sum(axis=2).argmax(axis=1)[:, None, None]
    first, second = (np.take_along_axis(sides, (longest + i) % 3, axis=1)[:, 0] for i in (1, 2))
    cross = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])[:, None]  # the longest would cancel most
    angles: FloatArray = np.degrees(np.arctan2(cross, -(after * before).sum(axis=2)))
    return angles


def statistics_of(points: FloatArray, triangles: IntArray, edges: int, hull_vertices: int) -> Statistics:
    """Return the statistics of a triangulation. O(m).

    >>> from exactmesh import delaunay
    >>> figures = delaunay([(0, 0), (4, 0), (0, 3)]).statistics()
    >>> figures.area, figures.longest_edge, round(figures.smallest_angle, 2)
    (6.0, 5.0, 36.87)
    """
    areas, lengths, angles = (measure(points, triangles) for measure in (areas_of, lengths_of, angles_of))
    with np.errstate(over="ignore"):
        area = float(areas.sum())
    return Statistics(
        vertices=len(points),
        triangles=len(triangles),
        edges=edges,
        hull_vertices=hull_vertices,
        area=area,
        smallest_area=float(areas.min()),
        largest_area=float(areas.max()),
        smallest_angle=float(angles.min()),
        largest_angle=float(angles.max()),
        shortest_edge=float(lengths.min()),
        longest_edge=float(lengths.max()),
    )
