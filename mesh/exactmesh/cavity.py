"""The polygons on the two sides of a new segment, where it crossed edges, triangulated anew.

Every vertex of such a polygon sees the segment, its base. That makes the constrained Delaunay triangulation simple: the
triangle at the base has its third corner at the vertex whose circle with the base is empty of all others, visible or
not, and what is left are two polygons of the same kind. To look for that vertex takes linear time in each, which is
near-linear in all for the cavities that occur, and quadratic for some [Anglada 1997]. Where it becomes too much, the
vertices are inserted one by one in random order instead, each into the edge that spans its place, with flips
[Shewchuk 2015].
"""

import math

from exactkernel.expansions import two_diff
from exactkernel.jit import jit, jit_inline
from exactkernel.orient2d import products_difference
from exactmesh.edgealgebra import EdgeArray, dest, left_next, link_ring, origin, swap
from exactmesh.plane import Plane, conflict, orient

__all__ = ["split_along"]

_PATIENCE = 48  # so many looks at each vertex, on the average, before chance takes over
_SMALL = 32  # polygons too small for that


# New edges take their numbers from plane.crossed, from the last one, ``free``, downwards. A polygon lies on the left of
# its base, an edge from p0 to the last of p0, p1, .. pn, and of its chain:
#
#         p2 ------ p3
#         /           \          chain[i] leads from p(i+1) to p(i)
#        p1            \
#         \             \
#         p0 ---base---> p4


@jit_inline
def corner(org: EdgeArray, chain: EdgeArray, i: int) -> int:
    """Return p(i)."""
    return dest(org, chain[0]) if i == 0 else origin(org, chain[i - 1])


@jit_inline
def new_edge(org: EdgeArray, edge: int, start: int, end: int) -> int:
    """Give an edge its ends; return it."""
    e = 4 * edge
    org[e >> 1] = start
    org[(e ^ 2) >> 1] = end
    return e


@jit_inline
def apex(plane: Plane, chain: EdgeArray, i: int, j: int) -> int:
    """Return the vertex between p(i) and p(j) whose circle with these two is empty of the others."""
    a, b, c = corner(plane.org, chain, i), corner(plane.org, chain, j), corner(plane.org, chain, i + 1)
    best = i + 1
    for m in range(i + 2, j):
        d = corner(plane.org, chain, m)
        if d != c and conflict(plane, a, b, c, d):
            best, c = m, d
    return best


@jit_inline
def halve(plane: Plane, chain: EdgeArray, i: int, j: int, m: int, base: int, free: int) -> tuple[int, int, int]:
    """Make the triangle of the base p(i) p(j) and p(m); return (base of the rest at p(i) p(m), at p(m) p(j), free).

    The bases are -1 where nothing is left: there the triangle is at the chain.
    """
    org = plane.org
    near = far = -1
    f, g = chain[j - 1], chain[i]
    if m > i + 1:
        near = new_edge(org, plane.crossed[free], corner(org, chain, i), corner(org, chain, m))
        free -= 1
        g = near ^ 2
    if m < j - 1:
        far = new_edge(org, plane.crossed[free], corner(org, chain, m), corner(org, chain, j))
        free -= 1
        f = far ^ 2
    link_ring(plane.ring, base, f)
    link_ring(plane.ring, f, g)
    link_ring(plane.ring, g, base)
    return near, far, free


@jit_inline
def fill_by_search(plane: Plane, chain: EdgeArray, base: int, length: int, free: int, patience: int) -> bool:
    """Triangulate a polygon from its base on; tell whether it worked before patience was at its end."""
    stack = plane.stack
    stack[0], stack[1], stack[2] = 0, length, base
    height = 3
    while height:
        height -= 3
        i, j, e = stack[height], stack[height + 1], stack[height + 2]
        patience -= j - i
        if patience < 0:
            return False
        m = apex(plane, chain, i, j)
        near, far, free = halve(plane, chain, i, j, m, e, free)
        if far >= 0:
            stack[height], stack[height + 1], stack[height + 2] = m, j, far
            height += 3
        if near >= 0:
            stack[height], stack[height + 1], stack[height + 2] = i, m, near
            height += 3
    return True


@jit
def is_nearer(plane: Plane, chain: EdgeArray, length: int, i: int, j: int) -> bool:
    """Tell whether p(i) is nearer to the base than p(j): exactly in the window of the coordinates, else about.

    Rounded distances would do for most polygons; but vertices rounded onto one slanted line are told apart by nothing
    except what was rounded off, and a wrong order costs a search through all of them.
    """
    xy, k = plane.xy, plane.k
    a, b = corner(plane.org, chain, 0), corner(plane.org, chain, length)
    u, v = corner(plane.org, chain, i), corner(plane.org, chain, j)
    left = (xy[2 * b] - xy[2 * a]) * (xy[2 * u + 1] - xy[2 * v + 1])
    right = (xy[2 * b + 1] - xy[2 * a + 1]) * (xy[2 * u] - xy[2 * v])
    difference = left - right
    if k.orient2d_bound == math.inf or abs(difference) > k.orient2d_bound * (abs(left) + abs(right)):
        return bool(difference < 0.0)  # two differences, two products: the filter of orient2d
    p, p_tail = two_diff(xy[2 * b], xy[2 * a])
    q, q_tail = two_diff(xy[2 * u + 1], xy[2 * v + 1])
    r, r_tail = two_diff(xy[2 * b + 1], xy[2 * a + 1])
    s, s_tail = two_diff(xy[2 * u], xy[2 * v])
    return (products_difference(p, p_tail, q, q_tail, r, r_tail, s, s_tail, k.scratch) & 3) == 0


@jit
def heuristic_order(plane: Plane, chain: EdgeArray, length: int) -> None:
    """Write stack[3 k], the vertex to insert in turn k = 1 .. n - 1, and for each i the two that it comes between.

    From the last to the first they are taken out at random, but none that is then nearer to the base than both its
    neighbors: so what is left has the shape that the insertion needs, wherever distances are compared exactly.
    """
    stack = plane.stack
    for i in range(length + 1):
        stack[3 * i], stack[3 * i + 1], stack[3 * i + 2] = i, i - 1, i + 1
    state = 1
    for turn in range(length - 1, 0, -1):
        while True:
            state = (1103515245 * state + 12345) & 0x7FFFFFFF
            chosen = 1 + (state >> 8) % turn
            i = stack[3 * chosen]
            before, after = stack[3 * i + 1], stack[3 * i + 2]
            if turn == 1 or not (
                is_nearer(plane, chain, length, i, before) and is_nearer(plane, chain, length, i, after)
            ):
                break
        stack[3 * chosen], stack[3 * turn] = stack[3 * turn], i
        stack[3 * before + 2], stack[3 * after + 1] = after, before


@jit
def legalize_fan(plane: Plane, e: int, u: int) -> None:
    """Flip loose edges opposite to u, from e on, where u has come in between the two ends of e."""
    ring, org = plane.ring, plane.org
    last = left_next(ring, e)
    while True:
        beyond = left_next(ring, e ^ 2)
        a, b = origin(org, e), dest(org, e)
        if plane.loose[e >> 2] and (orient(plane, a, b, u) <= 0 or conflict(plane, b, a, dest(org, beyond), u)):
            swap(ring, org, e)
            e = beyond
            continue
        spoke = left_next(ring, e)
        if spoke == last:
            return
        e = left_next(ring, spoke ^ 2)


@jit
def is_delaunay(plane: Plane, e: int) -> bool:
    """Tell whether the triangles on both sides of e are counterclockwise, and not in conflict."""
    ring, org = plane.ring, plane.org
    a, b = origin(org, e), dest(org, e)
    c, d = dest(org, left_next(ring, e)), dest(org, left_next(ring, e ^ 2))
    return orient(plane, a, b, c) > 0 and orient(plane, b, a, d) > 0 and not conflict(plane, a, b, c, d)


@jit
def fill_by_chance(plane: Plane, chain: EdgeArray, base: int, length: int, free: int) -> bool:
    """Triangulate a polygon by insertion in random order; tell whether it worked, which is checked.

    What is not yet triangulated are pockets between the chain and an edge; the next vertex of a pocket and that edge
    make a triangle, which leaves two pockets.
    """
    ring, first = plane.ring, free
    heuristic_order(plane, chain, length)
    link_ring(ring, base, chain[length - 1])
    for i in range(length - 1, 0, -1):
        link_ring(ring, chain[i], chain[i - 1])
    link_ring(ring, chain[0], base)
    for turn in range(1, length):
        m = plane.stack[3 * turn]
        i, j = plane.stack[3 * m + 1], plane.stack[3 * m + 2]
        e = left_next(ring, chain[i])
        near, far, free = halve(plane, chain, i, j, m, e, free)
        if near >= 0:
            link_ring(ring, near, chain[m - 1])
            link_ring(ring, chain[i], near)
        if far >= 0:
            link_ring(ring, far, chain[j - 1])
            link_ring(ring, chain[m], far)
        if e != base:
            plane.loose[e >> 2] = True
            legalize_fan(plane, e, corner(plane.org, chain, m))
    worked = True
    for i in range(free + 1, first + 1):
        plane.loose[plane.crossed[i]] = False
        worked = worked and is_delaunay(plane, 4 * plane.crossed[i])
    return worked


@jit
def fill_by_chance_or_else(plane: Plane, chain: EdgeArray, base: int, length: int, free: int) -> None:
    """Triangulate a polygon for which searching takes too long."""
    if not fill_by_chance(plane, chain, base, length, free):
        fill_by_search(plane, chain, base, length, free, length * length)


@jit_inline
def split_along(plane: Plane, a: int, b: int, crossed: int, lefts: int, rights: int) -> int:
    """Replace the edges that the march from a to b crossed by ab and Delaunay edges beside it; return ab."""
    left, right, org = plane.left, plane.right, plane.org
    for i in range(rights // 2):  # now it leads back to b
        right[i], right[rights - 1 - i] = right[rights - 1 - i], right[i]
    free = crossed - 1
    base = new_edge(org, plane.crossed[free], a, b)
    free -= 1
    chain, length = left, lefts
    for side in range(2):
        patience = _PATIENCE * length if length > _SMALL else length * length
        if not fill_by_search(plane, chain, base ^ 2 * side, length, free, patience):
            fill_by_chance_or_else(plane, chain, base ^ 2 * side, length, free)
        free -= length - 2
        for i in range(length):
            plane.spoke[origin(org, chain[i])] = chain[i]
        chain, length = right, rights
    return base
