"""CIRCUMCENTRES_INSIDE: every circumcentre lies in the union of the triangles, by a theorem or by location.

Where the theorem does not apply, a walk from triangle to triangle looks for the circumcentre, in doubles; that it lies
in the triangle where the walk ends is certified by a filter. What the walk does not find (it runs into the boundary, or
the filter cannot tell) is located in exact rationals: the circumcentre lies in the union where it lies on the boundary,
or above an odd number of boundary edges.
"""

import math

import numpy as np
import numpy.typing as npt
from gmpy2 import mpq

from exactkernel.constructions import circumcentre
from exactkernel.context import Context, chunk_size
from exactkernel.jit import jit
from exactkernel.rational import RationalPoint, orient2d_rational, raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.verify.adjacency import neighbours_of, rows_of_slots
from exactmesh.verify.boundary import Boundary
from exactmesh.verify.chains import Marks
from exactmesh.verify.links import Links
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.properties import Kind, Property, Verdict
from exactmesh.verify.report import WITNESSES, Finding, Violation
from exactmesh.verify.triangles import Shapes
from exactmesh.verify.witness import finding_of, triangle_name

__all__ = ["check_centres"]

_CHUNK = 1 << 14  # triangles between two looks at Ctrl-C
_STEPS = 1000  # of a walk; further away, rationals locate
UNKNOWN = 2
#: The determinant of the filter: sides u, cross products and squared lengths 4u, their products 9u, the sum 10u and the
#: last one free: 10u, as incircle. Twice its bound.
_FACTOR = 2.0


@jit
def centre_side(
    k: Context, px: float, py: float, qx: float, qy: float,
    ax: float, ay: float, bx: float, by: float, cx: float, cy: float,
) -> int:  # fmt: skip
    """Return on which side of the line pq the circumcentre of counterclockwise abc lies: 1 left, 0 on it, -1 right, or
    UNKNOWN. Like incircle a polynomial of degree 4 in differences of coordinates: its window and its grid stage."""
    ux, uy, vx, vy, sx, sy = bx - ax, by - ay, cx - ax, cy - ay, qx - px, qy - py
    wx, wy = ax - px, ay - py
    u, v = ux * ux + uy * uy, vx * vx + vy * vy
    left, right = ux * vy, uy * vx
    doubled = 2.0 * (left - right)
    x, y = vy * u - uy * v, ux * v - vx * u
    det = doubled * (sx * wy - sy * wx) + (sx * y - sy * x)
    doubles = 2.0 * (abs(left) + abs(right))
    xs, ys = abs(vy * u) + abs(uy * v), abs(ux * v) + abs(vx * u)
    permanent = doubles * (abs(sx * wy) + abs(sy * wx)) + (abs(sx) * ys + abs(sy) * xs)
    largest = max(max(max(abs(ux), abs(uy)), max(abs(vx), abs(vy))), max(max(abs(sx), abs(sy)), max(abs(wx), abs(wy))))
    error = 0.0 if largest <= k.grid_limit else _FACTOR * k.incircle_bound * permanent
    if det > error:
        return 1
    if -det > error:
        return -1
    return 0 if error == 0.0 else UNKNOWN


@jit
def walk_to_centre(k: Context, points: FloatArray, triangles: IntArray, across: IntArray, t: int) -> int:
    """Return the row of a triangle that holds the circumcentre of t for certain, or -1."""
    a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
    here, before = t, -1
    for _ in range(_STEPS):
        inside, ahead = True, -1
        for i in range(3):
            p, q = triangles[here, i], triangles[here, (i + 1) % 3]
            side = centre_side(
                k, points[p, 0], points[p, 1], points[q, 0], points[q, 1],
                points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1],
            )  # fmt: skip
            inside = inside and (side == 0 or side == 1)
            if side == -1 and across[here, i] >= 0 and across[here, i] != before:
                ahead = across[here, i]
        if inside:
            return here
        if ahead < 0:
            return -1
        before, here = here, ahead
    return -1


@jit
def find_centres(
    k: Context, points: FloatArray, triangles: IntArray, across: IntArray, rows: IntArray, found: npt.NDArray[np.bool_]
) -> None:
    """Tell which circumcentres a walk finds."""
    for i in range(len(rows)):
        found[i] = walk_to_centre(k, points, triangles, across, rows[i]) >= 0


def check_centres(
    mesh: Mesh, shapes: Shapes, links: Links, triangles: IntArray, boundary: Boundary | None, marks: Marks,
    gabriel: Finding,
) -> Finding:  # fmt: skip
    """CIRCUMCENTRES_INSIDE.

    Theorem I: it holds where GABRIEL does and the triangles are admissible and Delaunay across the edges on no segment.
    Let z be the circumcentre of t, not in the union. Then t is obtuse, and the way from the obtuse corner u to z leaves
    the union in a point s inside a boundary edge f. No corner that a point of t sees is strictly inside the circle of t
    (the power of theorem H). So both ends of f are outside of it or on it: otherwise, turning the way from s to an end
    inside, one meets a first corner, which is inside and visible. f cuts off a cap that has u but not the centre, less
    than half of the disc: the cap lies in the diametral disc of f, u strictly, and u is visible from s. Theorem H says
    that there is no such u.

    Args:
        mesh, shapes: the input.
        links: of the triangles with area.
        triangles: the rows of the mesh, counterclockwise.
        boundary: of the triangles, None unless they are admissible.
        marks: of the edges on segments.
        gabriel: the finding; it holds only where what it rests on does.
    """
    flat = np.flatnonzero(shapes.orientation == 0)
    if flat.size:
        finding = finding_of(flat, lambda t: _without_centre(mesh, t))
        return Finding(finding.verdict, finding.count, finding.violations, lower_bound=True)
    if boundary is None:
        return Finding(Verdict.UNDECIDED, because=(Property.ADMISSIBLE,)) if len(triangles) else Finding(Verdict.HOLDS)
    if gabriel.verdict is Verdict.HOLDS:
        return Finding(Verdict.HOLDS)
    obtuse = np.flatnonzero(shapes.widest > 0).astype(np.int32)
    rows = rows_of_slots(links, triangles)
    across = neighbours_of(links, triangles, rows, marks, 0)
    found = np.empty(len(obtuse), dtype=np.bool_)
    step = chunk_size(mesh.context, _CHUNK)
    for start in range(0, len(obtuse), step):
        part = slice(start, start + step)
        find_centres(mesh.context, mesh.coordinates, triangles, across, obtuse[part], found[part])
        raise_if_interrupted()
    return _located(mesh, boundary, obtuse[~found].tolist())


def _located(mesh: Mesh, boundary: Boundary, rows: list[int]) -> Finding:
    """Locate circumcentres exactly."""
    if not rows:
        return Finding(Verdict.HOLDS)
    outline = Outline(mesh.points, boundary)
    outside, violations = 0, []
    for t in rows:
        corners = tuple(mesh.triangles[t].tolist())
        centre = circumcentre(*(tuple(mesh.points[v].tolist()) for v in corners))
        if outline.holds(centre):
            continue
        outside += 1
        if outside <= WITNESSES:
            name = f"triangle {t} = {triangle_name(mesh.points, corners)}"
            message = f"the circumcentre {_shown(centre)} of {name} lies outside of all triangles"
            violations.append(Violation(Property.CIRCUMCENTRES_INSIDE, Kind.CENTRE_OUTSIDE, (t,), corners, message))
    return Finding(Verdict.FAILS if outside else Verdict.HOLDS, outside, tuple(violations))


def _without_centre(mesh: Mesh, t: int) -> Violation:
    corners = tuple(mesh.triangles[t].tolist())
    message = f"triangle {t} = {triangle_name(mesh.points, corners)} has no area, hence no circumcentre"
    return Violation(Property.CIRCUMCENTRES_INSIDE, Kind.ZERO_AREA, (t,), corners, message)


def _shown(point: RationalPoint) -> str:
    return f"({', '.join(f'{_between(x)[0]:.6g}' for x in point)})"


def _between(value: mpq) -> tuple[float, float]:
    """Return the doubles next below and above a rational, or infinities."""
    try:
        nearest = int(value.numerator) / int(value.denominator)
    except OverflowError:
        nearest = math.inf if value > 0 else -math.inf
    if math.isinf(nearest):
        return (1.7976931348623157e308, math.inf) if nearest > 0 else (-math.inf, -1.7976931348623157e308)
    return (
        (nearest, nearest)
        if mpq(nearest) == value
        else (math.nextafter(nearest, -math.inf), math.nextafter(nearest, math.inf))
    )


class Outline:
    """The boundary edges, sorted into vertical strips.

    Each strip lists the edges that reach into it. With about the root of their number of strips there are O(b^1.5)
    entries at worst, and in practice few edges a strip.
    """

    def __init__(self, points: FloatArray, boundary: Boundary) -> None:
        a, b = points[boundary.origin], points[boundary.target]
        swap = a[:, 0] > b[:, 0]
        self.left, self.right = np.where(swap[:, None], b, a), np.where(swap[:, None], a, b)
        self.low = np.minimum(a[:, 1], b[:, 1])
        self.cuts = np.unique(np.sort(a[:, 0])[:: int(len(a) ** 0.5) + 1])
        first, last = (np.searchsorted(self.cuts, ends[:, 0], side="right") for ends in (self.left, self.right))
        counts = last - first + 1
        edges = np.repeat(np.arange(len(a)), counts)
        strips = np.repeat(first, counts) + np.arange(len(edges)) - np.repeat(np.cumsum(counts) - counts, counts)
        order = np.argsort(strips, kind="stable")
        self.edges = edges[order]
        self.begin = np.searchsorted(strips[order], np.arange(len(self.cuts) + 2))

    def holds(self, z: RationalPoint) -> bool:
        """Tell whether z lies in the closed region: on an edge, or above an odd number of them."""
        (west, east), north = _between(z[0]), _between(z[1])[1]
        strips = np.searchsorted(self.cuts, [west, east], side="right")
        near = np.unique(self.edges[self.begin[strips[0]] : self.begin[strips[1] + 1]])
        near = near[(self.left[near, 0] <= east) & (self.right[near, 0] >= west) & (self.low[near] <= north)]
        below = False
        for e in near.tolist():
            (px, py), (qx, qy) = (tuple(map(mpq, ends[e].tolist())) for ends in (self.left, self.right))
            if not px <= z[0] <= qx:
                continue
            if px == qx:
                if min(py, qy) <= z[1] <= max(py, qy):
                    return True
                continue
            turn = orient2d_rational((px, py), (qx, qy), z)
            if turn == 0:
                return True
            below ^= turn > 0 and z[0] < qx  # the right end belongs to the next edge
        return below
