"""Circumcentres of triangles as the nearest doubles, certified; and the dual of each edge, unmerged."""

import math

import numpy as np
import numpy.typing as npt
from gmpy2 import mpq

from exactkernel.centre import nearest_circumcentre
from exactkernel.constructions import circumcentre
from exactkernel.context import Context, bits_of, chunk_size, exponent_into_window, make_context
from exactkernel.errors import DegenerateError
from exactkernel.jit import jit
from exactkernel.rational import RationalPoint, raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.errors import TopologyError
from exactmesh.triangulation import Triangulation

__all__ = ["centres_of", "circumcentres", "dual_edges", "exact_centre", "nearest_doubles", "turned"]

_CHUNK = 1 << 20  # triangles between two looks at Ctrl-C
_SMALLEST_SAFE = 2.0**-1021  # below it, scaling back may round a second time


@jit
def _nearest_range(
    k: Context, xy: FloatArray, triangles: IntArray, first: int, stop: int, centres: FloatArray, open_: IntArray
) -> int:
    """Write the centres of triangles first .. stop - 1; return how many of them are left ``open_``."""
    count = 0
    for t in range(first, stop):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        x, y, certain = nearest_circumcentre(
            k, xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1], xy[c, 0], xy[c, 1]
        )  # fmt: skip
        centres[t, 0], centres[t, 1] = x, y
        if not certain:
            open_[count] = t
            count += 1
    return count


def nearest_doubles(point: RationalPoint) -> tuple[float, float]:
    """Return the doubles nearest to an exact point; beyond the largest, an infinity."""
    return _nearest(point[0]), _nearest(point[1])


def _nearest(value: mpq) -> float:
    try:
        return int(value.numerator) / int(value.denominator)  # Python rounds correctly, subnormals included
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def exact_centre(points: FloatArray, triangles: IntArray, t: int) -> RationalPoint:
    """Return the exact circumcentre of triangle t.

    Raises:
        TopologyError: the triangle has no area.
    """
    a, b, c = (tuple(points[v].tolist()) for v in triangles[t])
    try:
        return circumcentre(a, b, c)
    except DegenerateError:
        raise TopologyError(f"triangle {t} {tuple(triangles[t].tolist())} has no area", indices=[t]) from None


@np.errstate(over="ignore", invalid="ignore", under="ignore", divide="ignore")  # interpreted, numpy scalars warn
def centres_of(points: FloatArray, triangles: IntArray) -> FloatArray:
    """Return the circumcentre of each triangle, float64 (m, 2): the doubles nearest to the exact ones. O(m)."""
    exponent = exponent_into_window(*bits_of(points))
    scaled = np.ldexp(points, exponent) if exponent else points
    k, centres = make_context(scaled), np.empty((len(triangles), 2))
    step = chunk_size(k, _CHUNK)
    room = np.empty(min(step, len(triangles)), dtype=np.int32)
    lost: list[npt.NDArray[np.int_]] = []
    for first in range(0, len(triangles), step):
        count = _nearest_range(k, scaled, triangles, first, min(first + step, len(triangles)), centres, room)
        lost.append(room[:count].astype(np.int64))
        raise_if_interrupted()
    if exponent:
        centres = np.ldexp(centres, -exponent)
        size = np.abs(centres)
        lost.append(np.flatnonzero(~((size < np.inf) & (size >= _SMALLEST_SAFE)).all(axis=1)))
    for t in np.unique(np.concatenate(lost)).tolist() if lost else ():
        centres[t] = nearest_doubles(exact_centre(points, triangles, t))
    return centres


def circumcentres(mesh: Triangulation) -> FloatArray:
    """Return the circumcentre of each triangle, float64 (m, 2): the doubles nearest to the exact ones, ties to even.

    A coordinate beyond the largest double is infinite, as rounding has it. Row j is that of triangle j: centres that
    coincide, of cocircular points, are all there. What :class:`exactmesh.Voronoi` calls vertices are these, merged.

    Raises:
        TopologyError: a triangle has no area.

    O(m); double-double arithmetic certifies nearly all, expansions nearly all the rest. Reference [Joldes 2017].

    >>> from exactmesh import delaunay
    >>> from exactmesh.voronoi import circumcentres
    >>> circumcentres(delaunay([(0, 0), (2, 0), (0, 3)])).tolist()
    [[1.0, 1.5]]
    """
    return centres_of(mesh.points, mesh.triangles)


def turned(points: FloatArray, edges: IntArray) -> FloatArray:
    """Return (dy, -dx) for each edge, halved where it overflows: what points to its right, at a right angle."""
    with np.errstate(over="ignore", invalid="ignore"):
        along = points[edges[:, 1]] - points[edges[:, 0]]
    wild = ~np.isfinite(along).all(axis=1)
    along[wild] = 0.5 * points[edges[wild, 1]] - 0.5 * points[edges[wild, 0]]
    return np.stack([along[:, 1], -along[:, 0]], axis=1)


def dual_edges(mesh: Triangulation) -> tuple[IntArray, FloatArray]:
    """Return the dual of each edge of the mesh, row by row, as Triangle writes ``.v.edge``.

    Edge i of ``mesh.edges`` is Voronoi edge i turned counterclockwise by a right angle.

    Returns:
        int32 (k, 2), the triangle on the left of the edge and the one on its right, whose centres the Voronoi edge
        connects; the second is -1 for a ray;
        float64 (k, 2), the direction of each ray, at a right angle away from its edge and as long (half as long where
        that would overflow); zeros for edges that are no rays.

    O(m). Edges between triangles of one circumcircle have duals of length 0.

    >>> from exactmesh import delaunay
    >>> from exactmesh.voronoi import dual_edges
    >>> mesh = delaunay([(0, 0), (2, 0), (0, 3)])
    >>> mesh.edges.tolist()
    [[1, 2], [2, 0], [0, 1]]
    >>> [dual.tolist() for dual in dual_edges(mesh)]
    [[[0, -1], [0, -1], [0, -1]], [[3.0, 2.0], [-3.0, 0.0], [0.0, -2.0]]]
    """
    own = np.arange(len(mesh.triangles), dtype=np.int32)[:, None] > mesh.neighbors
    left, right = np.nonzero(own)[0].astype(np.int32), mesh.neighbors[own]
    directions = np.zeros((len(left), 2))
    rays = right < 0
    directions[rays] = turned(mesh.points, mesh.edges[rays]) + 0.0
    return np.stack([left, right], axis=1), directions
