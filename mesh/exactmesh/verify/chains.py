"""Segments as chains of mesh edges (theorem F): each strictly monotone, exactly collinear."""

import numpy as np
import numpy.typing as npt

from exactkernel.context import Context, chunk_size
from exactkernel.jit import jit
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray
from exactmesh.verify.boundary import lexicographically_before
from exactmesh.verify.links import _LOW, Links, slot_of
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.spokes import Spokes, first_spoke, spokes_of
from exactmesh.verify.witness import IndexArray

__all__ = ["CONSTRAINED", "IN_DOMAIN", "ODD", "Marks", "chained", "edge_slot"]

#: What is known about a mesh edge, bits at the slot that stands for it.
Marks = npt.NDArray[np.uint8]
CONSTRAINED = 1  # part of a segment: exempt from being Delaunay
IN_DOMAIN = 2  # part of a segment of the domain
ODD = 4  # of an odd number of them

_CHUNK = 1 << 15  # segments between two looks at Ctrl-C


@jit
def edge_slot(links: Links, v: int, w: int) -> int:
    """Return the slot that stands for the edge between v and w, -1 if there is none: that of the edge from the smaller
    index, or else of its reverse."""
    low, high = min(v, w), max(v, w)
    slot = slot_of(links.slots, links.first[low], links.last[low], high)
    if slot < 0:
        slot = slot_of(links.slots, links.first[high], links.last[high], low)
    return slot


@jit
def lies_between(points: FloatArray, v: int, w: int, b: int) -> bool:
    """Tell whether w is lexicographically between v and b, strictly."""
    if lexicographically_before(points, v, w):
        return lexicographically_before(points, w, b)
    return lexicographically_before(points, w, v) and lexicographically_before(points, b, w)


@jit
def next_of_chain(k: Context, points: FloatArray, links: Links, spokes: Spokes, v: int, b: int) -> int:
    """Return a neighbour of v on the straight way to b, strictly between them or b itself, or -1."""
    nearest = first_spoke(k, points, spokes, v, b)
    if nearest != -2:
        return nearest if nearest == b or (nearest >= 0 and lies_between(points, v, nearest, b)) else -1
    for i in range(links.first[v], links.last[v]):
        for far in range(2):
            w = links.slots[i] & _LOW if far else links.slots[i] >> 32
            if w == b:
                return int(w)
            if (
                lies_between(points, v, w, b)
                and orient2d_adaptive(
                    k, points[v, 0], points[v, 1], points[b, 0], points[b, 1], points[w, 0], points[w, 1]
                )
                == 0
            ):
                return int(w)
    return -1


@jit
def walk_chain(
    k: Context, points: FloatArray, links: Links, spokes: Spokes, a: int, b: int, marks: Marks, bits: int
) -> bool:
    """Tell whether a chain leads from a to b, and write the bits at its edges; no bits, no marks.

    Each step leads closer to b, so that the walk ends, whatever the triangles are.
    """
    v = a
    while v != b:
        w = next_of_chain(k, points, links, spokes, v, b)
        if w < 0:
            return False
        if bits:
            slot = edge_slot(links, v, w)
            marks[slot] = (marks[slot] | (bits & ~ODD)) ^ (bits & ODD)
        v = w
    return True


@jit
def walk_chains(
    k: Context,
    points: FloatArray,
    links: Links,
    spokes: Spokes,
    ends: IndexArray,
    marks: Marks,
    bits: int,
    found: npt.NDArray[np.bool_],
) -> None:
    """Walk along segments, and mark the edges of those that are chains."""
    for i in range(len(ends)):
        a, b = ends[i, 0], ends[i, 1]
        if a < 0 or b < 0 or a == b or (points[a, 0] == points[b, 0] and points[a, 1] == points[b, 1]):
            found[i] = False
            continue
        slot = edge_slot(links, a, b)
        if slot >= 0:
            marks[slot] = (marks[slot] | (bits & ~ODD)) ^ (bits & ODD)
            found[i] = True
            continue
        found[i] = walk_chain(k, points, links, spokes, a, b, marks, 0)
        if found[i]:
            walk_chain(k, points, links, spokes, a, b, marks, bits)


def chained(mesh: Mesh, links: Links, ends: IndexArray, marks: Marks, bits: int) -> npt.NDArray[np.bool_]:
    """Tell which segments are chains of edges, and write the bits at their edges; ODD is toggled.

    Args:
        mesh: the points.
        links: of counterclockwise triangles.
        ends: (s, 2) indices of points, -1 where there is none.
        marks: (3m,) what is known about the edges.
        bits: what to add.

    O(log d) for a segment that is an edge, and for each step of the others, d being the degree there; and O(d log d)
    once for each vertex of large degree.
    """
    found = np.empty(len(ends), dtype=np.bool_)
    if not len(ends):
        return found
    spokes = spokes_of(mesh.context, mesh.coordinates, links)
    step = chunk_size(mesh.context, _CHUNK)
    for begin in range(0, len(ends), step):
        part = slice(begin, begin + step)
        walk_chains(mesh.context, mesh.coordinates, links, spokes, ends[part], marks, bits, found[part])
        raise_if_interrupted()
    return found
