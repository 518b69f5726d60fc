"""Around a convex window through a Voronoi diagram: which cells its boundary cuts, and between which ridges.

The walk follows the boundary counterclockwise from cell to cell. It behaves as if every side were moved inwards by an
infinitesimal: where a side meets three cells or more in one point it takes, of the ridges that it meets there, the one
that it would then meet first, which is an orientation of the sites. So a side along a ridge belongs to the cell inside,
and cells that the boundary but touches are visited for no length, which is known exactly.
"""

from exactkernel.bisector import along_adaptive, crossing_order_adaptive, nearer_adaptive
from exactkernel.context import Context
from exactkernel.jit import jit
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.types import FloatArray, IntArray
from exactmesh.ordering import IndexArray

__all__ = ["COLUMNS", "nearest_site", "other_site", "walk_around"]

#: Of a row of visits: site; entry of the ridge, side of the window and (1 or 0) whether at the corner where that side
#: begins, on the way in and on the way out; whether the visit has no length.
COLUMNS = 8


@jit
def other_site(ridge_points: IntArray, ridge: int, site: int) -> int:
    """Return the site on the other side of a ridge."""
    a = ridge_points[ridge, 0]
    return int(ridge_points[ridge, 1] if a == site else a)


@jit
def nearest_site(
    k: Context, xy: FloatArray, offsets: IndexArray, cell_ridges: IntArray, ridge_points: IntArray, start: int,
    x: float, y: float,
) -> int:  # fmt: skip
    """Return a site nearest to (x, y): as long as a neighbor is nearer, go there."""
    s, moved = start, True
    while moved:
        moved = False
        for j in range(offsets[s], offsets[s + 1]):
            q = other_site(ridge_points, cell_ridges[j], s)
            if nearer_adaptive(k, xy[s, 0], xy[s, 1], xy[q, 0], xy[q, 1], x, y) > 0:
                s, moved = q, True
                break
    return s


@jit
def _along(k: Context, xy: FloatArray, window: FloatArray, side: int, s: int, q: int) -> int:
    """Return the sign of (q - s) in the direction of a side of the window."""
    a, b = side % len(window), (side + 1) % len(window)
    return along_adaptive(
        k, xy[s, 0], xy[s, 1], xy[q, 0], xy[q, 1], window[a, 0], window[a, 1], window[b, 0], window[b, 1]
    )


@jit
def _inwards(k: Context, xy: FloatArray, window: FloatArray, side: int, s: int, q: int) -> int:
    """Return the sign of (q - s) in the direction inwards, at a right angle to a side of the window."""
    a, b = side % len(window), (side + 1) % len(window)
    return along_adaptive(
        k, xy[s, 0], xy[s, 1], xy[q, 0], xy[q, 1], -window[a, 1], window[a, 0], -window[b, 1], window[b, 0]
    )


@jit
def _order(k: Context, xy: FloatArray, window: FloatArray, side: int, s: int, p: int, q: int) -> int:
    a, b = side % len(window), (side + 1) % len(window)
    return crossing_order_adaptive(
        k, xy[s, 0], xy[s, 1], xy[p, 0], xy[p, 1], xy[q, 0], xy[q, 1],
        window[a, 0], window[a, 1], window[b, 0], window[b, 1],
    )  # fmt: skip


@jit
def _leans(k: Context, xy: FloatArray, s: int, p: int, q: int) -> int:
    return orient2d_adaptive(k, xy[s, 0], xy[s, 1], xy[p, 0], xy[p, 1], xy[q, 0], xy[q, 1])


@jit
def _at_corner(
    k: Context, xy: FloatArray, offsets: IndexArray, cell_ridges: IntArray, ridge_points: IntArray, window: FloatArray,
    side: int, s: int,
) -> int:  # fmt: skip
    """Return the entry of the ridge of s to cross in the corner where a side begins, or -1 if s is where it goes on."""
    x, y = window[side % len(window), 0], window[side % len(window), 1]
    best, site = -1, -1
    for j in range(offsets[s], offsets[s + 1]):
        q = other_site(ridge_points, cell_ridges[j], s)
        if nearer_adaptive(k, xy[s, 0], xy[s, 1], xy[q, 0], xy[q, 1], x, y) != 0:
            continue
        along = _along(k, xy, window, side, s, q)
        if along < 0 or (along == 0 and _inwards(k, xy, window, side, s, q) <= 0):
            continue
        if best < 0 or _leans(k, xy, s, site, q) > 0:
            best, site = j, q
    return best


@jit
def _ahead(
    k: Context, xy: FloatArray, offsets: IndexArray, cell_ridges: IntArray, ridge_points: IntArray, window: FloatArray,
    side: int, s: int,
) -> int:  # fmt: skip
    """Return the entry of the ridge through which the line of a side leaves the cell of s, or -1 if it never does."""
    best, site = -1, -1
    for j in range(offsets[s], offsets[s + 1]):
        q = other_site(ridge_points, cell_ridges[j], s)
        if _along(k, xy, window, side, s, q) <= 0:
            continue
        order = 1 if best < 0 else _order(k, xy, window, side, s, site, q)
        if order > 0 or (order == 0 and _leans(k, xy, s, site, q) > 0):
            best, site = j, q
    return best


@jit
def _twin(offsets: IndexArray, cell_ridges: IntArray, ridge: int, site: int) -> int:
    """Return the entry of a ridge in the cell on its other side."""
    j = offsets[site]
    while cell_ridges[j] != ridge:
        j += 1
    return int(j)


@jit
def _record(
    k: Context, xy: FloatArray, cell_ridges: IntArray, ridge_points: IntArray, window: FloatArray, visit: IndexArray
) -> None:
    """Write whether a visit has no length."""
    s, came, first, at_first, left, last, at_last = visit[0], visit[1], visit[2], visit[3], visit[4], visit[5], visit[6]
    visit[7] = 0
    if came < 0 or first != last or at_first != at_last:
        return
    p, q = other_site(ridge_points, cell_ridges[came], s), other_site(ridge_points, cell_ridges[left], s)
    if at_first == 1 or _order(k, xy, window, first, s, p, q) == 0:
        visit[7] = 1


@jit
def walk_around(
    k: Context, xy: FloatArray, offsets: IndexArray, cell_ridges: IntArray, ridge_points: IntArray, window: FloatArray,
    start: int, visits: IndexArray,
) -> int:  # fmt: skip
    """Write a row of ``visits`` for each time that the boundary of the window passes a cell; return how many.

    ``start`` is a site nearest to the first corner. Sides are counted on: that of entry is not positive in the first
    visit, which begins where the last one does. One visit that comes and goes nowhere, -1, is that of a window inside
    of one cell. Returns -1 if there is no room.
    """
    sides, count = len(window), 0
    s = start
    j = _at_corner(k, xy, offsets, cell_ridges, ridge_points, window, 0, s)
    while j >= 0:
        s = other_site(ridge_points, cell_ridges[j], s)
        j = _at_corner(k, xy, offsets, cell_ridges, ridge_points, window, 0, s)
    first = s
    came, came_side, came_at_corner = -1, 0, 0
    for side in range(sides + 1):
        at_corner = 1
        while not (side == sides and s == first):
            if at_corner == 1:
                j = _at_corner(k, xy, offsets, cell_ridges, ridge_points, window, side, s)
                if j < 0:
                    at_corner = 0
            if at_corner == 0:
                j = _ahead(k, xy, offsets, cell_ridges, ridge_points, window, side, s)
                if j < 0:
                    break
                q, b = other_site(ridge_points, cell_ridges[j], s), (side + 1) % sides
                if nearer_adaptive(k, xy[s, 0], xy[s, 1], xy[q, 0], xy[q, 1], window[b, 0], window[b, 1]) <= 0:
                    break
            if count == len(visits):
                return -1
            visits[count, 0], visits[count, 1], visits[count, 2], visits[count, 3] = s, came, came_side, came_at_corner
            visits[count, 4], visits[count, 5], visits[count, 6] = j, side, at_corner
            _record(k, xy, cell_ridges, ridge_points, window, visits[count])
            count += 1
            s = other_site(ridge_points, cell_ridges[j], s)
            came, came_side, came_at_corner = _twin(offsets, cell_ridges, cell_ridges[j], s), side, at_corner
    if count == 0:
        visits[0, 0], visits[0, 1], visits[0, 4], visits[0, 7] = first, -1, -1, 0
        return 1
    visits[0, 1], visits[0, 2], visits[0, 3] = came, came_side - sides, came_at_corner
    _record(k, xy, cell_ridges, ridge_points, window, visits[0])
    return count
