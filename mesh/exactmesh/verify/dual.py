"""What a Voronoi diagram claims, in arrays: of this library, of scipy, or of Triangle's files."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

import functools
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from exactkernel.errors import ShapeError
from exactkernel.types import FloatArray, IntArray
from exactmesh.verify.links import Links, slot_of
from exactmesh.verify.matching import corners_at
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.witness import IndexArray

__all__ = ["Diagram", "Dual", "Ridges", "ridges_of"]


class Diagram(Protocol):
    """A diagram by sites: :class:`exactmesh.Voronoi` or ``scipy.spatial.Voronoi``."""

    @property
    def points(self) -> FloatArray:
        """(n, 2), the sites."""

    @property
    def vertices(self) -> FloatArray:
        """(v, 2)."""

    @property
    def ridge_points(self) -> IntArray:
        """(r, 2), the sites on both sides of each ridge."""

    @property
    def ridge_vertices(self) -> npt.ArrayLike:
        """(r, 2), the vertices at which each ridge ends, -1 for infinity."""


#: A diagram by sites, or as Triangle has it: (vertices (m, 2), one a triangle; edges (e, 2) between them; origins (h,)
#: and directions (h, 2) of rays), or as in its files: (vertices, edges with -1 for infinity, directions (e, 2)).
Dual: TypeAlias = "Diagram | tuple[npt.ArrayLike, ...]"


@dataclass(frozen=True, slots=True)
class Ridges:
    """What a diagram claims.

    Attributes:
        vertices: (v, 2).
        pairs: (r, 2) the corners of the mesh on both sides of each ridge, -1 where there is none.
        ends: (r, 2) its vertices; the second is -1 for a ray, both for a line.
        directions: (r, 2) of rays; NaN where the diagram does not say.
        by_triangle: whether vertex t is that of triangle t.
    """

    vertices: FloatArray
    pairs: IndexArray
    ends: IndexArray
    directions: FloatArray
    by_triangle: bool


def ridges_of(dual: Dual, mesh: Mesh, links: Links, triangles: IntArray) -> Ridges:
    """Return what a diagram claims of a mesh of counterclockwise triangles.

    Raises:
        ShapeError: it is no diagram, or an index is out of range.
    """
    if isinstance(dual, tuple):
        return _by_triangles(dual, mesh, links, triangles)
    if not all(hasattr(dual, name) for name in ("points", "vertices", "ridge_points", "ridge_vertices")):
        raise ShapeError(f"dual: expected a Voronoi diagram, not a {type(dual).__name__}")
    vertices, sites = _pairs(dual.vertices, "vertices"), _pairs(dual.points, "points")
    pairs = _indices(dual.ridge_points, len(sites), 0, "ridge_points")
    given: object = getattr(dual, "ends", None)
    ends = _indices(dual.ridge_vertices if given is None else np.asarray(given), len(vertices), -1, "ridge_vertices")
    directions: object = getattr(dual, "directions", None)
    rays = np.full(pairs.shape, np.nan) if directions is None else _pairs(np.asarray(directions), "directions")
    if not len(pairs) == len(ends) == len(rays):
        raise ShapeError(f"dual: {len(pairs)} ridge_points, but {len(ends)} ridges and {len(rays)} directions")
    corner = corners_at(mesh.points, links.last > links.first, sites)
    infinite = np.minimum(ends[:, 0], ends[:, 1]) < 0
    rays = np.where(infinite[:, None], rays, np.nan)
    return Ridges(vertices, corner[pairs], np.where(ends[:, :1] < 0, ends[:, ::-1], ends), rays, False)


def _pairs(values: npt.ArrayLike, name: str) -> FloatArray:
    array = np.asarray(values)
    if array.size == 0:
        return np.empty((0, 2))
    if array.ndim != 2 or array.shape[1] != 2 or array.dtype.kind not in "iuf":
        raise ShapeError(f"dual: {name} has shape {array.shape} and dtype {array.dtype}; expected numbers (k, 2)")
    return array.astype(np.float64)


def _indices(values: npt.ArrayLike, n: int, least: int, name: str) -> IndexArray:
    try:
        array = np.asarray(values)
    except ValueError:  # ragged
        raise ShapeError(f"dual: {name} is not an array of pairs") from None
    if array.size == 0:
        return np.empty((0, 2), dtype=np.intp)
    if array.ndim != 2 or array.shape[1] != 2 or array.dtype.kind not in "iu":
        raise ShapeError(f"dual: {name} has shape {array.shape} and dtype {array.dtype}; expected integers (k, 2)")
    if (array < least).any() or (array >= n).any():
        raise ShapeError(f"dual: {name} has an index outside {least} .. {n - 1}")
    return array.astype(np.intp)


def _by_triangles(dual: tuple[npt.ArrayLike, ...], mesh: Mesh, links: Links, triangles: IntArray) -> Ridges:
    if len(dual) not in (3, 4):
        raise ShapeError(f"dual: {len(dual)} arrays; expected vertices, edges, and the rays' origins and directions")
    vertices = _pairs(dual[0], "vertices")
    if len(vertices) != len(triangles):
        raise ShapeError(f"dual: {len(vertices)} vertices; expected one for each of {len(triangles)} triangles")
    ends, directions = _indices(dual[1], len(vertices), -1, "edges"), _pairs(dual[-1], "directions")
    if len(dual) == 4:
        origins = np.asarray(dual[2]).reshape(-1, 1)
        rays = _indices(np.hstack([origins, np.full_like(origins, -1)]), len(vertices), -1, "origins")
        directions = np.concatenate([np.full(ends.shape, np.nan), directions])
        ends = np.concatenate([ends, rays])
    if len(directions) != len(ends):
        raise ShapeError(f"dual: {len(directions)} directions; expected {len(ends)}")
    ends = np.where(ends[:, :1] < 0, ends[:, ::-1], ends)
    infinite = ends[:, 1] < 0
    pairs = _common_edges(triangles, ends)
    pairs[infinite] = _edges_of_rays(mesh, links, triangles, ends[infinite, 0], directions[infinite])
    return Ridges(vertices, pairs, ends, np.where(infinite[:, None], directions, np.nan), True)


def _common_edges(triangles: IntArray, ends: IndexArray) -> IndexArray:
    """Return the edge of the first triangle that the second one has as well, -1 where there is none."""
    s, t = triangles[ends[:, 0]], triangles[ends[:, 1]]
    shared = (s[:, :, None] == t[:, None, :]).any(axis=2)
    pairs = np.full(ends.shape, -1, dtype=np.intp)
    for i in range(3):
        both = shared[:, i] & shared[:, (i + 1) % 3] & ~shared[:, (i + 2) % 3]
        pairs[both] = s[both][:, [i, (i + 1) % 3]]
    return pairs


def _edges_of_rays(
    mesh: Mesh, links: Links, triangles: IntArray, origins: IndexArray, directions: FloatArray
) -> IndexArray:
    """Return for each ray an edge of its triangle on the boundary: of several, that which no other ray has, and which
    it leaves most nearly at a right angle. If it is the wrong one, the diagram is wrong all the same."""
    pairs, taken = np.empty((len(origins), 2), dtype=np.intp), set[tuple[int, int]]()
    for i, t in enumerate(origins.tolist()):
        a, b, c = triangles[t].tolist()
        free = [
            (v, w)
            for v, w in ((a, b), (b, c), (c, a))
            if (v, w) not in taken and slot_of(links.slots, links.first[w], links.last[w], v) < 0
        ]
        chosen = max(free, key=functools.partial(_leaning, mesh.points, directions[i]), default=(-1, -1))
        pairs[i] = chosen
        taken.add(chosen)
    return pairs


def _leaning(points: FloatArray, direction: FloatArray, edge: tuple[int, int]) -> float:
    """Return the sine of the angle from a direction to an edge, times the direction's length."""
    u = points[edge[1]] - points[edge[0]]
    u /= np.abs(u).max()
    return float((direction[0] * u[1] - direction[1] * u[0]) / np.hypot(u[0], u[1]))
