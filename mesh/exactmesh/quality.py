"""Angles, areas and lengths, in plain floating point: for people to read, never to decide anything."""

from dataclasses import dataclass

import numpy as np

from exactkernel.types import FloatArray, IntArray

__all__ = ["Statistics", "angles_of", "areas_of", "statistics_of"]


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


def _sides(points: FloatArray, triangles: IntArray) -> FloatArray:
    """Return the vectors of the edges opposite to each corner, (m, 3, 2)."""
    corners = points[triangles]
    sides: FloatArray = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)
    return sides


def areas_of(points: FloatArray, triangles: IntArray) -> FloatArray:
    """Return the signed area of each triangle, float64 (m,), positive if counterclockwise."""
    sides = _sides(points, triangles)
    areas: FloatArray = 0.5 * (sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
    return areas


def angles_of(points: FloatArray, triangles: IntArray) -> FloatArray:
    """Return the angle at each corner in degrees, float64 (m, 3)."""
    sides = _sides(points, triangles)
    exponents = np.frexp(np.abs(sides).max(axis=(1, 2), initial=0.0))[1]
    sides = np.ldexp(sides, -exponents[:, None, None])  # the square of a small triangle's side would underflow
    after, before = np.roll(sides, -1, axis=1), np.roll(sides, -2, axis=1)
    cross = np.abs(after[..., 0] * before[..., 1] - after[..., 1] * before[..., 0])
    angles: FloatArray = np.degrees(np.arctan2(cross, -(after * before).sum(axis=2)))
    return angles


def statistics_of(points: FloatArray, triangles: IntArray, edges: int, hull_vertices: int) -> Statistics:
    """Return the statistics of a triangulation. O(m).

    >>> from exactmesh import delaunay
    >>> figures = delaunay([(0, 0), (4, 0), (0, 3)]).statistics()
    >>> figures.area, figures.longest_edge, round(figures.smallest_angle, 2)
    (6.0, 5.0, 36.87)
    """
    scale = float(np.ldexp(1.0, int(np.frexp(np.abs(points).max())[1]) - 1))  # no square over- or underflows
    unit = points / scale
    sides = _sides(unit, triangles)
    with np.errstate(over="ignore", under="ignore"):
        lengths = np.hypot(sides[..., 0], sides[..., 1]) * scale
        areas = areas_of(unit, triangles) * scale * scale
        area = float(areas.sum())
    angles = angles_of(unit, triangles)
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
