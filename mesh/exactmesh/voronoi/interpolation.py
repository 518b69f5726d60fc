"""Natural neighbours, and interpolation by Sibson's coordinates."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

from dataclasses import dataclass, fields

import numpy as np
import numpy.typing as npt
from gmpy2 import mpq

from exactkernel.arrays import finite_points
from exactkernel.constructions import circumcentre
from exactkernel.context import chunk_size, scaled_into_window
from exactkernel.coordinates import rational_point
from exactkernel.errors import CoordinateError, ShapeError
from exactkernel.jit import jit
from exactkernel.rational import RationalPoint, incircle_rational, raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.delaunay import delaunay
from exactmesh.errors import ConflictingValuesError
from exactmesh.ordering import IndexArray
from exactmesh.triangulation import Triangulation
from exactmesh.voronoi.areas import area_of_polygon
from exactmesh.voronoi.cavity import coordinates_of, room_for
from exactmesh.voronoi.source import check_hull

__all__ = ["NaturalNeighbors", "interpolate", "natural_neighbors"]

_CHUNK = 1 << 16  # queries between two looks at Ctrl-C
_USUAL = 8  # neighbors that a query has about room for at first


@dataclass(frozen=True, eq=False, repr=False)
class NaturalNeighbors:
    """The natural neighbours of points, and Sibson's coordinates. Every array is read-only.

    Attributes:
        offsets: int64 (k + 1,), point i has the entries from offsets[i] to offsets[i + 1]: none outside of the hull,
            one at a site, two on the hull.
        sites: int32 (e,), the sites from whose cells a cell of the point would take.
        weights: float64 (e,), which part of that cell it would take there: not negative, and they add up to 1.
    """

    offsets: IndexArray
    sites: IntArray
    weights: FloatArray

    def __reduce__(self) -> tuple[type[NaturalNeighbors], tuple[object, ...]]:
        # copies and pickles are made anew: numpy does not pass on that an array is read-only
        return NaturalNeighbors, tuple(getattr(self, f.name) for f in fields(self))

    def __post_init__(self) -> None:
        for f in fields(self):
            getattr(self, f.name).setflags(write=False)

    def __repr__(self) -> str:
        return f"NaturalNeighbors({len(self.offsets) - 1} points, {len(self.sites)} entries)"


def _mesh_of(points_or_mesh: npt.ArrayLike | Triangulation) -> Triangulation:
    if not isinstance(points_or_mesh, Triangulation):
        return delaunay(points_or_mesh)
    check_hull(points_or_mesh)
    return points_or_mesh


def natural_neighbors(points_or_mesh: npt.ArrayLike | Triangulation, at: npt.ArrayLike) -> NaturalNeighbors:
    """Return for each point the sites from which its cell would take, and which part of it: Sibson's coordinates.

    A point is the sum of its natural neighbours weighted by its coordinates; on the hull, the two ends of the edge are
    the limits. Which triangle a point is in, and which circles, is decided exactly; all areas together err by
    less than 2^-50 of their sum, before that is rounded.

    Args:
        points_or_mesh: the sites (n, 2), or a Delaunay triangulation of them.
        at: (k, 2), the points.

    Raises:
        NotDelaunayError, TopologyError: the triangulation is not Delaunay, or does not cover its convex hull.
        CollinearPointsError, TooFewPointsError: the sites span no triangle.
        NonFiniteError, CoordinateError, ShapeError: as for :func:`exactmesh.delaunay`.

    Expected O(k) after location for points among random sites. Reference [Sibson 1981].

    >>> from exactmesh import natural_neighbors
    >>> found = natural_neighbors([(0, 0), (2, 0), (2, 2), (0, 2)], [(1, 1), (0, 2), (0.5, 0)])
    >>> found.offsets.tolist(), found.weights.tolist()
    ([0, 4, 5, 7], [0.25, 0.25, 0.25, 0.25, 1.0, 0.75, 0.25])
    """
    mesh, queries = _mesh_of(points_or_mesh), finite_points(at, "at")
    return _found(mesh, queries, mesh.locate(queries))


@np.errstate(over="ignore", invalid="ignore", under="ignore", divide="ignore")  # interpreted, numpy scalars warn
def _found(mesh: Triangulation, queries: FloatArray, found: IntArray) -> NaturalNeighbors:
    xy, k = scaled_into_window(np.concatenate([mesh.points, queries]))
    count = len(queries)
    offsets, open_ = np.zeros(count + 1, dtype=np.int64), np.zeros(count, dtype=np.bool_)
    sites, weights = np.empty(_USUAL * count + 64, dtype=np.int32), np.empty(_USUAL * count + 64)
    room, step, first = room_for(len(mesh.triangles)), chunk_size(k, _CHUNK), 0
    while first < count:
        stop = min(first + step, count)
        done = int(
            coordinates_of(
                k, xy, mesh.triangles, mesh.neighbors, room, found, first, stop, offsets, sites, weights, open_
            )
        )  # fmt: skip
        raise_if_interrupted()
        if done < stop:
            sites, weights = (np.concatenate([array, np.empty_like(array)]) for array in (sites, weights))
        first = done
    size = int(offsets[-1])
    if not open_.any():
        return NaturalNeighbors(offsets, sites[:size].copy(), weights[:size].copy())
    return _completed(mesh, queries, found, offsets, sites[:size], weights[:size], open_)


def _completed(
    mesh: Triangulation, queries: FloatArray, found: IntArray, offsets: IndexArray, sites: IntArray,
    weights: FloatArray, open_: npt.NDArray[np.bool_],
) -> NaturalNeighbors:  # fmt: skip
    """Put in what the rationals have to say about the queries that are left open."""
    answers = {i: _exact_coordinates(mesh, queries[i], int(found[i])) for i in np.flatnonzero(open_).tolist()}
    lengths = np.diff(offsets)
    lengths[list(answers)] = [len(answer) for answer in answers.values()]
    bounds = np.concatenate([[0], np.cumsum(lengths)])
    all_sites, all_weights = np.empty(bounds[-1], dtype=np.int32), np.empty(bounds[-1])
    old = ~np.repeat(open_, lengths)
    all_sites[old], all_weights[old] = sites, weights
    for i, answer in answers.items():
        all_sites[bounds[i] : bounds[i + 1]] = list(answer)
        all_weights[bounds[i] : bounds[i + 1]] = [float(weight) for weight in answer.values()]
    return NaturalNeighbors(bounds, all_sites, all_weights)


def _exact_coordinates(mesh: Triangulation, query: FloatArray, start: int) -> dict[int, mpq]:
    """Return Sibson's coordinates of a point in triangle ``start``, neither a site nor on the hull, in rationals."""
    q = rational_point(query.tolist())
    cavity, stack = {start}, [start]
    while stack:
        for u in mesh.neighbors[stack.pop()].tolist():
            if u >= 0 and u not in cavity and _is_inside(mesh, u, q):
                cavity.add(u)
                stack.append(u)
    centres = {t: circumcentre(*_corners(mesh, t)) for t in cavity}
    around: dict[tuple[int, int], int] = {}  # the triangle at each directed edge of the cavity
    for t in cavity:
        a, b, c = mesh.triangles[t].tolist()
        around |= {(a, b): t, (b, c): t, (c, a): t}
    # the vertex after each on the boundary, and the triangle between
    onward = {a: (b, t) for (a, b), t in around.items() if (b, a) not in around}
    before = {b: a for a, (b, _) in onward.items()}
    areas = {b: -_stolen(mesh, q, before[b], b, onward, around, centres) for b in onward}
    total = sum(areas.values(), mpq(0))
    return {b: area / total for b, area in areas.items() if area > 0}


def _is_inside(mesh: Triangulation, t: int, q: RationalPoint) -> bool:
    """Tell whether q lies inside the circumcircle of triangle t."""
    a, b, c = _corners(mesh, t)
    return incircle_rational(a, b, c, q) > 0


def _corners(mesh: Triangulation, t: int) -> list[RationalPoint]:
    return [rational_point(point) for point in mesh.points[mesh.triangles[t]].tolist()]


def _stolen(
    mesh: Triangulation, q: RationalPoint, a: int, b: int, onward: dict[int, tuple[int, int]],
    around: dict[tuple[int, int], int], centres: dict[int, RationalPoint],
) -> mpq:  # fmt: skip
    """Return minus the area that q takes from b, which follows a on the boundary of the cavity."""
    pa, pb, pc = (rational_point(mesh.points[v].tolist()) for v in (a, b, onward[b][0]))
    corners, t = [circumcentre(q, pa, pb)], onward[a][1]
    while True:
        corners.append(centres[t])
        row = mesh.triangles[t].tolist()
        c = row[(row.index(b) + 1) % 3]
        if (c, b) not in around:
            return area_of_polygon([*corners, circumcentre(q, pb, pc)])
        t = around[c, b]


@jit
def _sums(offsets: IndexArray, sites: IntArray, weights: FloatArray, values: FloatArray, sums: FloatArray) -> None:
    for i in range(len(sums)):
        for c in range(values.shape[1]):
            total = 0.0
            for j in range(offsets[i], offsets[i + 1]):
                total += weights[j] * values[sites[j], c]
            sums[i, c] = total if offsets[i] < offsets[i + 1] else np.nan


def interpolate(points_or_mesh: npt.ArrayLike | Triangulation, values: npt.ArrayLike, at: npt.ArrayLike) -> FloatArray:
    """Return values interpolated between scattered sites by Sibson's coordinates, float64 (k,) or (k, c).

    The interpolant takes the values at the sites, is continuous, smooth except at the sites and on the hull, and
    reproduces linear functions, but for rounding. Outside of the convex hull it is NaN.

    Args:
        points_or_mesh: the sites (n, 2), or a Delaunay triangulation of them.
        values: (n,) or (n, c), those at the sites; NaN spreads to where its site has a weight.
        at: (k, 2), where to interpolate.

    Raises:
        ConflictingValuesError: points at the same position have different values.
        ShapeError, CoordinateError: values that are none, or not one a site.
        NotDelaunayError, TopologyError, CollinearPointsError, TooFewPointsError, NonFiniteError: as for
            :func:`natural_neighbors`.

    Reference [Sibson 1981].

    >>> from exactmesh import interpolate
    >>> interpolate([(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)], [0, 2, 4, 2, 2], [(0.25, 0.75), (3, 3)]).tolist()
    [1.0, nan]
    """
    mesh = _mesh_of(points_or_mesh)
    given = _values(values)
    if not isinstance(points_or_mesh, Triangulation):
        given = _of_vertices(mesh, given)
    if len(given) != len(mesh.points):
        raise ShapeError(f"{len(given)} values for {len(mesh.points)} sites")
    queries = finite_points(at, "at")
    found = _found(mesh, queries, mesh.locate(queries))
    columns = np.ascontiguousarray(given.reshape(len(given), -1))
    sums = np.empty((len(queries), columns.shape[1]))
    _sums(found.offsets, found.sites, found.weights, columns, sums)
    return sums if given.ndim == 2 else sums.reshape(-1)


def _values(values: npt.ArrayLike) -> FloatArray:
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise ShapeError(f"values is no array: {error}") from None
    if array.ndim not in (1, 2):
        raise ShapeError(f"values has shape {array.shape}; expected (n,) or (n, c)")
    if array.dtype.kind not in "fiu":
        raise CoordinateError(f"values has dtype {array.dtype}; expected real numbers")
    return array.astype(np.float64)


def _of_vertices(mesh: Triangulation, given: FloatArray) -> FloatArray:
    """Return the values of the vertices, given those of the points of the input."""
    if len(given) != len(mesh.representative):
        raise ShapeError(f"{len(given)} values for {len(mesh.representative)} points")
    first = np.full(len(mesh.points), -1, dtype=np.int64)
    first[mesh.representative[::-1]] = np.arange(len(given))[::-1]
    chosen = given[first]
    same = (chosen[mesh.representative] == given) | (np.isnan(chosen[mesh.representative]) & np.isnan(given))
    bad = np.flatnonzero(~same.reshape(len(given), -1).all(axis=1))
    if bad.size:
        i, j = int(first[mesh.representative[bad[0]]]), int(bad[0])
        raise ConflictingValuesError(
            f"points {i} and {j} at {tuple(mesh.points[mesh.representative[j]].tolist())} have different values: "
            f"{given[i].tolist()} and {given[j].tolist()}",
            indices=[i, j],
        )
    return chosen
