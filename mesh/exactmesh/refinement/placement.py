"""Where the next point goes: the circumcentre of a bad triangle, or an off-centre nearer to its shortest edge.

The off-centre makes the shortest edge and the new point a triangle that is just good enough. Reference [Ungor 2004].
"""

import math

from exactkernel.doubledouble import dd_add, dd_multiply
from exactkernel.expansions import two_diff
from exactkernel.jit import jit, jit_inline
from exactkernel.types import FloatArray
from exactmesh.edgealgebra import dest, left_next, origin
from exactmesh.refinement.rules import Rules
from exactmesh.refinement.sheet import Sheet, distance_squared

__all__ = ["place_centre", "shortest_edge"]

_ROW = 0.8660254037844386  # the height of an equilateral triangle of edge 1
_APART = 0.55  # how far all vertices are from a point of the lattice that is taken, in its edges
_OUTSIDE = 8.0  # in extents of the domain: nothing is that far away
_FAR = 1e9  # in edges of the lattice: beyond, its points would be far from where they belong
_CLEAR = 1e-6  # of the permanent: an area above that has ten digits


@jit_inline
def shortest_edge(s: Sheet, e: int) -> tuple[int, float]:
    """Return the shortest edge of the triangle on the left of e, and its squared length."""
    f = left_next(s.ring, e)
    g = left_next(s.ring, f)
    xy = s.xy
    a, b, c = origin(s.org, e), origin(s.org, f), origin(s.org, g)
    ax, ay, bx, by, cx, cy = xy[2 * a], xy[2 * a + 1], xy[2 * b], xy[2 * b + 1], xy[2 * c], xy[2 * c + 1]
    ab = (ax - bx) * (ax - bx) + (ay - by) * (ay - by)
    bc = (bx - cx) * (bx - cx) + (by - cy) * (by - cy)
    ca = (cx - ax) * (cx - ax) + (cy - ay) * (cy - ay)
    if ab <= bc and ab <= ca:
        return e, ab
    return (f, bc) if bc <= ca else (g, ca)


@jit
def careful_area(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> float:
    """Return twice the area of a nearly flat triangle, from differences that are exact."""
    p, p_tail = two_diff(ax, cx)
    q, q_tail = two_diff(by, cy)
    r, r_tail = two_diff(ay, cy)
    t, t_tail = two_diff(bx, cx)
    left, left_tail = dd_multiply(p, p_tail, q, q_tail)
    right, right_tail = dd_multiply(r, r_tail, t, t_tail)
    return float(dd_add(left, left_tail, -right, -right_tail)[0])


@jit_inline
def to_unit(x: float, unit: float) -> float:
    """Return x as a multiple of the unit."""
    return round(x / unit) * unit if abs(x) < 4503599627370496.0 * unit else x


@jit_inline
def place_centre(s: Sheet, rules: Rules, e: int, p: int, offset: float) -> None:
    """Write the coordinates of p for the triangle on the left of e, its shortest edge; offset 0: the circumcentre."""
    xy = s.xy
    a, b = origin(s.org, e), dest(s.org, e)
    c = dest(s.org, left_next(s.ring, e))
    ax, ay = xy[2 * a], xy[2 * a + 1]
    bx, by = xy[2 * b] - ax, xy[2 * b + 1] - ay
    cx, cy = xy[2 * c] - ax, xy[2 * c + 1] - ay
    left, right = bx * cy, by * cx
    area = left - right
    if area < _CLEAR * (abs(left) + abs(right)):
        area = careful_area(xy[2 * b], xy[2 * b + 1], xy[2 * c], xy[2 * c + 1], ax, ay)
    if area == 0.0:  # an underflow
        area = math.nan
    bb, cc = bx * bx + by * by, cx * cx + cy * cy
    ux, uy = (cy * bb - by * cc) / (2.0 * area), (bx * cc - cx * bb) / (2.0 * area)
    if offset > 0.0:
        vx, vy = 0.5 * bx - offset * by, 0.5 * by + offset * bx
        mx, my = 0.5 * bx, 0.5 * by
        if (vx - mx) * (vx - mx) + (vy - my) * (vy - my) < (ux - mx) * (ux - mx) + (uy - my) * (uy - my) and (
            (ux - mx) * (vx - mx) + (uy - my) * (vy - my) > 0.0
        ):
            ux, uy = vx, vy
    far = math.sqrt((ux * ux + uy * uy) / rules.longest)
    if far > _OUTSIDE:  # of a needle: nearer is outside, too, and no product overflows there
        ux, uy = ux / far * _OUTSIDE, uy / far * _OUTSIDE
    xy[2 * p] = to_unit(ax + ux, rules.unit)
    xy[2 * p + 1] = to_unit(ay + uy, rules.unit)


@jit_inline
def nearest_on_lattice(x: float, y: float) -> tuple[float, float, float]:
    """Return the lattice point nearest to (x, y), by its coordinates in edges, and its squared distance."""
    best_x, best_y, nearest = 0.0, 0.0, math.inf
    lower = math.floor(y / _ROW)
    for i in range(2):
        row = lower + i
        shift = 0.5 * (row - 2.0 * math.floor(0.5 * row))
        u, v = math.floor(x - shift + 0.5) + shift, row * _ROW
        squared = (u - x) * (u - x) + (v - y) * (v - y)
        if squared < nearest:
            best_x, best_y, nearest = u, v, squared
    return best_x, best_y, nearest


@jit_inline
def move_to_lattice(s: Sheet, rules: Rules, e: int, p: int) -> None:
    """Move p, the circumcentre of a triangle that is too large, to the nearest point of the lattice of its zone.

    The lattice is one of equilateral triangles that are just small enough, so where all points are from it, nothing
    is left to do. p stays where it is if a vertex might be too close to its new place.
    """
    xy, edge = s.xy, rules.lattice[s.zone[e >> 1]]
    x, y = (xy[2 * p] - rules.origin_x) / edge, (xy[2 * p + 1] - rules.origin_y) / edge
    if not abs(x) + abs(y) < _FAR:
        return
    u, v, squared = nearest_on_lattice(x, y)
    if math.sqrt(distance_squared(xy, p, origin(s.org, e))) / edge - math.sqrt(squared) > _APART:
        xy[2 * p] = to_unit(rules.origin_x + u * edge, rules.unit)
        xy[2 * p + 1] = to_unit(rules.origin_y + v * edge, rules.unit)


@jit_inline
def is_finite(xy: FloatArray, p: int) -> bool:
    """Tell whether both coordinates of p are numbers."""
    return math.isfinite(xy[2 * p]) and math.isfinite(xy[2 * p + 1])


@jit_inline
def place_centroid(s: Sheet, rules: Rules, e: int, p: int) -> None:
    """Write the coordinates of the centroid of the triangle on the left of e."""
    f = left_next(s.ring, e)
    a, b, c = origin(s.org, e), origin(s.org, f), dest(s.org, f)
    for axis in range(2):
        third = (s.xy[2 * a + axis] + s.xy[2 * b + axis] + s.xy[2 * c + axis]) / 3.0
        s.xy[2 * p + axis] = to_unit(third, rules.unit)
