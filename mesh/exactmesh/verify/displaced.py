"""Segments of a domain that are chains of edges near them: which, and exactly how far from them (theorem W)."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from gmpy2 import mpq

from exactkernel.context import chunk_size
from exactkernel.jit import jit
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray
from exactmesh.verify.bottleneck import NO_CHAIN, empty_search, find_chains
from exactmesh.verify.chains import ODD, Marks, edge_slot
from exactmesh.verify.chains_rational import chain_in_rationals
from exactmesh.verify.links import Links
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.witness import IndexArray

__all__ = [
    "NearChains",
    "cross_squared",
    "largest_squared",
    "mark_chains",
    "near_chains",
    "slots_of_chains",
]

_CHUNK = 1 << 12  # segments between two looks at Ctrl-C
_MARGIN = 2.0**-40


@dataclass(frozen=True, slots=True)
class NearChains:
    """Chains of segments that are not straight ones.

    Attributes:
        rows: (c,) which segments, ascending.
        start: (c + 1,) and vertices: the chain of rows[i] is vertices[start[i] : start[i + 1]].
        farthest: (c,) the vertex that is farthest from its segment, -1 where there is none between its ends.
        bounds: (c, 2) bounds of its distance, from below and from above, rounded.
    """

    rows: IndexArray
    start: IndexArray
    vertices: IndexArray
    farthest: IndexArray
    bounds: FloatArray

    def taken(self, chosen: npt.NDArray[np.bool_]) -> "NearChains":
        """Return some of the chains."""
        lengths = np.diff(self.start)
        start = np.append(0, np.cumsum(lengths[chosen]))
        vertices = self.vertices[np.repeat(chosen, lengths)]
        return NearChains(self.rows[chosen], start, vertices, self.farthest[chosen], self.bounds[chosen])


def _exponent(mesh: Mesh) -> int:
    """Return by which power of two the coordinates were scaled into the window."""
    i = int(np.argmax(np.abs(mesh.points)))
    given, scaled = float(mesh.points.flat[i]), float(mesh.coordinates.flat[i])
    return math.frexp(scaled)[1] - math.frexp(given)[1]  # of 0 as well


def near_chains(
    mesh: Mesh, links: Links, points: FloatArray, positions: FloatArray, segments: IndexArray, corner: IndexArray,
    rows: IndexArray, within: float,
) -> NearChains:  # fmt: skip
    """Return the chains of edges, ever forward, that stay nearest to their segments, if within the distance.

    Args:
        mesh, links: the triangles.
        points: the domain's, as given.
        positions: the same in the coordinates of the mesh.
        segments: (s, 2) the domain's.
        corner: (n,) the corner for each of its points, or -1.
        rows: which segments to look for.
        within: the largest distance of a vertex between the ends from its segment.

    O(c log c) for each, c being the number of edges at vertices that are as near as the chain.
    """
    rows = rows[(corner[segments[rows]] >= 0).all(axis=1)]
    ends = corner[segments[rows]]
    if not len(rows):
        return _in_rationals(mesh, links, points[segments[rows]], ends, rows, within)
    if mesh.context.orient2d_bound == math.inf:
        return _in_rationals(mesh, links, points[segments[rows]], ends, rows, within)
    lines = positions[segments[rows]].reshape(-1, 4)
    lengths = np.hypot(lines[:, 2] - lines[:, 0], lines[:, 3] - lines[:, 1])
    scaled = np.ldexp(within, _exponent(mesh))
    limits = np.maximum(scaled * lengths * (1.0 + _MARGIN), np.finfo(np.float64).tiny)
    search = empty_search(len(mesh.points))
    c = len(rows)
    farthest, start, crosses = np.empty(c, np.intp), np.zeros(c + 1, np.intp), np.empty((c, 2))
    vertices = np.empty(4 * c + 64, dtype=np.intp)
    begin, step = 0, chunk_size(mesh.context, _CHUNK)
    while begin < c:
        end = min(begin + step, c)
        done = find_chains(
            mesh.context, mesh.coordinates, links, lines, limits, ends, search, farthest, crosses, start, vertices,
            begin, end,
        )  # fmt: skip
        if done < end:
            vertices = np.concatenate([vertices, np.empty_like(vertices)])
        begin = done
        raise_if_interrupted()
    bounds = np.stack([crosses[:, 0] - crosses[:, 1], crosses[:, 0] + crosses[:, 1]], axis=1) / lengths[:, None]
    bounds = np.ldexp(np.maximum(bounds * [1.0 - _MARGIN, 1.0 + _MARGIN], 0.0), -_exponent(mesh))
    found = NearChains(rows, start, vertices[: start[-1]], farthest, bounds)
    return _within(mesh, points, segments, found.taken(farthest != NO_CHAIN), within)


def _within(mesh: Mesh, points: FloatArray, segments: IndexArray, found: NearChains, within: float) -> NearChains:
    """Return the chains that are within the distance, exactly."""
    low, high = np.nextafter(found.bounds[:, 0], -math.inf), np.nextafter(found.bounds[:, 1], math.inf)
    kept = (found.farthest < 0) | (high < within) | (within == math.inf)
    if not kept.all():
        for i in np.flatnonzero(~kept & (low <= within)).tolist():
            a, b = points[segments[found.rows[i]]]
            kept[i] = cross_squared(a, b, mesh.points[found.farthest[i]]) <= mpq(within) * mpq(within)
            raise_if_interrupted()
    return found.taken(kept)


def _in_rationals(
    mesh: Mesh, links: Links, lines: FloatArray, ends: IndexArray, rows: IndexArray, within: float
) -> NearChains:
    """Return the chains where no power of two brings the coordinates into the window of the predicates."""
    chains = []
    for line, (a, b) in zip(lines, ends.tolist(), strict=True):
        chains.append(chain_in_rationals(mesh.points, links, line, a, b, within))
        raise_if_interrupted()
    kept = np.array([chain is not None for chain in chains], dtype=np.bool_)
    found = [chain for chain in chains if chain is not None]
    start = np.append(0, np.cumsum([len(chain.vertices) for chain in found], dtype=np.intp)).astype(np.intp)
    vertices = np.array([v for chain in found for v in chain.vertices], dtype=np.intp)
    farthest = np.array([chain.farthest for chain in found], dtype=np.intp)
    bounds = np.full((len(found), 2), [0.0, math.inf])
    return NearChains(rows[kept], start, vertices, farthest, bounds)


def cross_squared(a: FloatArray, b: FloatArray, p: FloatArray) -> mpq:
    """Return the exact squared distance of p from the line ab."""
    (ax, ay), (bx, by), (px, py) = ((mpq(x), mpq(y)) for x, y in (a.tolist(), b.tolist(), p.tolist()))
    ux, uy = bx - ax, by - ay
    cross = ux * (py - ay) - uy * (px - ax)
    return cross * cross / (ux * ux + uy * uy)


def largest_squared(mesh: Mesh, points: FloatArray, segments: IndexArray, found: NearChains) -> mpq:
    """Return the exact largest squared distance of a vertex between the ends of a chain from its segment."""
    inner = np.flatnonzero(found.farthest >= 0)
    largest = mpq(0)
    least = float(found.bounds[inner, 0].max(initial=0.0))
    for i in inner[found.bounds[inner, 1] >= least].tolist():
        a, b = points[segments[found.rows[i]]]
        largest = max(largest, cross_squared(a, b, mesh.points[found.farthest[i]]))
        raise_if_interrupted()
    return largest


@jit
def fill_slots(links: Links, vertices: IndexArray, at: IndexArray, slots: IndexArray) -> None:
    """Write the slots of the edges from these places to the next ones."""
    for i in range(len(at)):
        slots[i] = edge_slot(links, vertices[at[i]], vertices[at[i] + 1])


def slots_of_chains(links: Links, found: NearChains) -> tuple[IndexArray, IndexArray]:
    """Return the slot of each edge of the chains, and which chain it belongs to."""
    is_last = np.zeros(len(found.vertices), dtype=np.bool_)
    is_last[found.start[1:] - 1] = True
    at = np.flatnonzero(~is_last)
    slots = np.empty(len(at), dtype=np.intp)
    fill_slots(links, found.vertices, at, slots)
    return slots, np.searchsorted(found.start, at, side="right") - 1


def mark_chains(slots: IndexArray, marks: Marks, bits: int) -> None:
    """Write the bits at the edges of chains; ODD is toggled as often as an edge occurs."""
    marks[slots] |= bits & ~ODD
    if bits & ODD:
        np.bitwise_xor.at(marks, slots, np.uint8(ODD))
