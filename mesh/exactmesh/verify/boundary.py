"""The boundary chain, and whether it is one convex cycle (theorem C), in linear time."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exactkernel.context import Context, chunk_size
from exactkernel.jit import jit
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray
from exactmesh.verify.links import BOUNDARY, Links, ends_of, slots_of
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.witness import IndexArray

__all__ = ["Boundary", "boundary_of", "convex_cycle", "is_one_loop", "lexicographically_before", "outside_of"]


_CHUNK = 1 << 14  # points between two looks at Ctrl-C


class Boundary(NamedTuple):
    """The directed edges that no triangle has in reverse, their triangles on the left.

    Attributes:
        origin, target, apex: intp (b,): edge and third corner; ``origin`` ascends.
    """

    origin: IndexArray
    target: IndexArray
    apex: IndexArray


def boundary_of(links: Links) -> Boundary:
    """Return the boundary chain of triangles without repeated edges. As a boundary it is closed: every vertex
    has as many edges in as out."""
    origin, target, apex = ends_of(links, slots_of(links, BOUNDARY))
    order = np.argsort(origin, kind="stable")
    return Boundary(origin[order], target[order], apex[order])


@jit
def lexicographically_before(points: FloatArray, v: int, w: int) -> bool:
    """Tell whether v comes before w: smaller x, or the same x and smaller y."""
    if points[v, 0] == points[w, 0]:
        return bool(points[v, 1] < points[w, 1])
    return bool(points[v, 0] < points[w, 0])


@jit
def walk_convex(
    k: Context, points: FloatArray, origin: IndexArray, successor: IndexArray, cycle: IndexArray, begin: int, end: int
) -> int:
    """Follow the chain from step ``begin`` to step ``end``, from the slot that ``cycle[begin]`` holds. Write its
    vertices, and after them the next slot; return how often the direction changed, -1 where the chain turns right or
    comes back too early."""
    i, reversals = cycle[begin], 0
    for step in range(begin, end):
        j = successor[i]
        u, v, w = origin[i], origin[j], origin[successor[j]]
        forward = lexicographically_before(points, u, v)
        reverses = forward != lexicographically_before(points, v, w)
        turn = orient2d_adaptive(k, points[u, 0], points[u, 1], points[v, 0], points[v, 1], points[w, 0], points[w, 1])
        if turn < 0 or (turn == 0 and reverses) or (j == 0) != (step == len(origin) - 1):
            return -1
        if reverses:
            reversals += 1
        cycle[step] = u
        i = j
    if end < len(cycle):
        cycle[end] = i
    return reversals


def convex_cycle(mesh: Mesh, boundary: Boundary) -> IndexArray | None:
    """Return the vertices of the boundary in counterclockwise order if it is one convex cycle, else None.

    Theorem C. A closed polygon whose turns are all left or straight ahead, and whose edges change their
    lexicographic direction exactly twice, is simple, weakly convex and counterclockwise: of a minimum and a
    maximum in lexicographic order, it joins the one to the other by a convex chain and back by another. O(b).
    """
    origin, target, _ = boundary
    if not len(origin) or (origin[1:] == origin[:-1]).any():
        return None
    cycle, successor, reversals = np.zeros_like(origin), np.searchsorted(origin, target), 0
    step = chunk_size(mesh.context, _CHUNK)
    for begin in range(0, len(origin), step):
        end = min(begin + step, len(origin))
        found = walk_convex(mesh.context, mesh.coordinates, origin, successor, cycle, begin, end)
        raise_if_interrupted()
        if found < 0:
            return None
        reversals += found
    return cycle if reversals == 2 else None


@jit
def loop_length(successor: IndexArray) -> int:
    """Return after how many steps the chain from slot 0 is back there."""
    steps, i = 1, successor[0]
    while i != 0:
        i = successor[i]
        steps += 1
    return steps


def is_one_loop(boundary: Boundary) -> bool:
    """Tell whether the boundary is one loop through different vertices, or empty. O(b)."""
    origin, target, _ = boundary
    if not len(origin):
        return True
    if (origin[1:] == origin[:-1]).any():
        return False
    return bool(loop_length(np.searchsorted(origin, target)) == len(origin))


@jit
def side_of_chain(k: Context, points: FloatArray, chain: IndexArray, v: int) -> int:
    """Return the orientation of v against a chain that ascends lexicographically, between whose ends v
    lies."""
    low, high = 0, len(chain) - 1
    while high - low > 1:
        middle = (low + high) >> 1
        if lexicographically_before(points, v, chain[middle]):
            high = middle
        else:
            low = middle
    a, b = chain[low], chain[high]
    return orient2d_adaptive(k, points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[v, 0], points[v, 1])


@jit
def find_outside(
    k: Context,
    points: FloatArray,
    lower: IndexArray,
    upper: IndexArray,
    vertices: IndexArray,
    outside: npt.NDArray[np.bool_],
) -> None:
    """Tell which vertices lie strictly outside of the polygon between two ascending chains."""
    left, right = lower[0], lower[-1]
    for i in range(len(vertices)):
        v = vertices[i]
        outside[i] = (
            lexicographically_before(points, v, left)
            or lexicographically_before(points, right, v)
            or side_of_chain(k, points, lower, v) < 0
            or side_of_chain(k, points, upper, v) > 0
        )  # fmt: skip


def outside_of(mesh: Mesh, cycle: IndexArray, vertices: IndexArray) -> IndexArray:
    """Return those vertices that lie strictly outside of a convex counterclockwise cycle. O(log b) a
    vertex."""
    x, y = mesh.points[cycle].T
    order = np.lexsort((y, x))
    cycle = np.roll(cycle, -int(order[0]))
    right = int(order[-1] - order[0]) % len(cycle)
    lower, upper = cycle[: right + 1], np.append(cycle[right:], cycle[0])[::-1].copy()
    outside = np.empty(len(vertices), dtype=np.bool_)
    for start in range(0, len(vertices), _CHUNK):
        part = slice(start, start + _CHUNK)
        find_outside(mesh.context, mesh.coordinates, lower, upper, vertices[part], outside[part])
        raise_if_interrupted()
    return vertices[outside]
