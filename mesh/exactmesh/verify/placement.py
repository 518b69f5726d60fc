"""Where a domain's points and segments are in the mesh: exactly there, or displaced (theorem W).

A domain that is displaced has its segments along edges of the mesh. There may be several: which ends of segments have
moved, and which segments are left where they are, because they lie outside of the domain (a dam in a lake that is
carved away). They are tried in a fixed order, those that move less first.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import numpy.typing as npt
from gmpy2 import mpq

from exactkernel.context import Context
from exactkernel.jit import jit
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray
from exactmesh.verify.chains import IN_DOMAIN, Marks, chained
from exactmesh.verify.cover import Placed
from exactmesh.verify.displaced import NearChains, largest_squared, mark_chains, near_chains, slots_of_chains
from exactmesh.verify.domain import Outline
from exactmesh.verify.links import _LOW, BOUNDARY, Links
from exactmesh.verify.matching import corners_at
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.nearest import nearest_corners, squared_distance
from exactmesh.verify.witness import IndexArray

__all__ = ["displaced_placements", "is_within", "placed_exactly", "used_points"]

Flags = npt.NDArray[np.bool_]


def used_points(links: Links) -> Flags:
    """Tell which points are corners."""
    used: Flags = links.last > links.first
    return used


def placed_exactly(
    mesh: Mesh, links: Links, outline: Outline, positions: FloatArray, marks: Marks, bits: int
) -> Placed:
    """Look for points at their positions and for segments that are straight chains; mark the edges of these."""
    n, h = len(outline.points), len(outline.holes)
    points, holes = positions[:n], positions[n : n + h]
    corner = corners_at(mesh.coordinates, used_points(links), points)
    present = chained(mesh, links, corner[outline.segments], marks, bits)
    return Placed(outline, points, holes, corner, present, marks.copy())


def displaced_placements(
    mesh: Mesh, links: Links, outline: Outline, positions: FloatArray, marks: Marks, bits: int, within: float
) -> Iterator[tuple[Placed, Marks]]:
    """Yield where the domain may be, within a distance, and the marks of the edges for each.

    1. Points at their positions, and every segment along the chain that stays nearest to it; but segments that may be
       left where they are, see :func:`_optional`, are.
    2. Those as well along their chains.
    3, 4. Likewise, the ends of segments that are at no corner's position moved to the nearest corner.

    Args:
        mesh, links: admissible triangles, or any.
        outline: the domain.
        positions: its points, holes and regions in the coordinates of the mesh.
        marks: of the edges, not written to.
        bits: what a segment of the domain makes of an edge.
        within: the largest distance.
    """
    own = marks.copy()
    exact = placed_exactly(mesh, links, outline, positions, own, bits)
    yield from _with_chains(mesh, links, replace(exact, within=within), own, positions, bits, within)
    moved = _moved(mesh, links, outline, exact.corner, within)
    if moved is None:
        return
    corner, squared = moved
    there = corner == exact.corner
    straight = there[outline.segments].all(axis=1) & exact.present
    coordinates = exact.coordinates.copy()
    coordinates[~there] = mesh.coordinates[corner[~there]]
    placed = replace(exact, coordinates=coordinates, corner=corner, present=straight, within=within, squared=squared)
    yield from _with_chains(mesh, links, placed, own, positions, bits, within)


def is_within(p: FloatArray, q: FloatArray, within: float) -> bool:
    """Tell exactly whether two positions are at most so far apart."""
    return within == np.inf or squared_distance(p, q) <= mpq(within) * mpq(within)


def _moved(
    mesh: Mesh, links: Links, outline: Outline, corner: IndexArray, within: float
) -> tuple[IndexArray, mpq] | None:
    """Return the corners that ends of segments may have moved to, and the largest squared distance; None if none
    did. Where the two ends of a segment would fall together, those that moved stay where they are."""
    used = np.flatnonzero(used_points(links))
    ends = np.unique(outline.segments)
    lost = ends[corner[ends] < 0]
    if not lost.size or not used.size:
        return None
    found, points = corner.copy(), outline.points
    found[lost] = nearest_corners(mesh.points, used, points[lost])
    lost = np.array([v for v in lost.tolist() if is_within(points[v], mesh.points[found[v]], within)], dtype=np.intp)
    kept, found = found, corner.copy()
    found[lost] = kept[lost]
    while True:
        a, b = found[outline.segments].T
        together = outline.segments[(a == b) & (a >= 0)]
        back = np.intersect1d(lost, together)
        if not back.size:
            break
        found[back] = -1
        lost = np.setdiff1d(lost, back)
    if not lost.size:
        return None
    return found, max(squared_distance(points[v], mesh.points[found[v]]) for v in lost.tolist())


def _with_chains(
    mesh: Mesh, links: Links, placed: Placed, marks: Marks, positions: FloatArray, bits: int, within: float
) -> Iterator[tuple[Placed, Marks]]:
    """Yield the placement with the chains of segments that are not straight: first without those that need not be."""
    outline = placed.outline
    points, segments = outline.points, outline.segments
    rows = placed.absent
    near = positions[: len(points)]
    found = near_chains(mesh, links, points, near, segments, placed.corner, rows, within)
    slots, owner = slots_of_chains(links, found)
    optional = _optional(mesh, links, placed, near, marks, found, slots, owner)
    for left_out in (optional, np.zeros_like(optional)):
        chosen, written, present = found.taken(~left_out), marks.copy(), placed.present.copy()
        mark_chains(slots[~left_out[owner]], written, bits)
        present[chosen.rows] = True
        squared = max(placed.squared, largest_squared(mesh, points, segments, chosen))
        yield replace(placed, present=present, marks=written.copy(), squared=squared), written
        if not left_out.any():
            return


@jit
def enters(k: Context, points: FloatArray, links: Links, a: int, x: float, y: float) -> bool:
    """Tell whether the way from the corner a to (x, y) begins in the cells at a, their edges included."""
    ax, ay = points[a, 0], points[a, 1]
    for i in range(links.first[a], links.last[a]):
        p, q = links.slots[i] >> 32, links.slots[i] & _LOW
        if (
            orient2d_adaptive(k, ax, ay, points[p, 0], points[p, 1], x, y) >= 0
            and orient2d_adaptive(k, ax, ay, points[q, 0], points[q, 1], x, y) <= 0
        ):
            return True
    return False


@jit
def find_entering(
    k: Context, points: FloatArray, links: Links, corners: IndexArray, ends: FloatArray, found: Flags
) -> None:
    """Tell which segments begin or end in the cells, of those that are not known to be needed."""
    for i in range(len(found)):
        a, b = corners[i, 0], corners[i, 1]
        found[i] = (
            found[i]
            or enters(k, points, links, a, ends[i, 1, 0], ends[i, 1, 1])
            or enters(k, points, links, b, ends[i, 0, 0], ends[i, 0, 1])
        )


def _optional(
    mesh: Mesh,
    links: Links,
    placed: Placed,
    positions: FloatArray,
    marks: Marks,
    found: NearChains,
    slots: IndexArray,
    owner: IndexArray,
) -> Flags:
    """Tell which chains may be left out: those of segments that begin and end outside of the cells, if every edge of
    the chain that bounds the cells belongs to some other chain as well."""
    times = np.zeros(len(marks), dtype=np.int64)
    np.add.at(times, slots, 1)
    needed = np.zeros(len(found.rows), dtype=np.bool_)
    alone = (links.kinds[slots] == BOUNDARY) & (times[slots] == 1) & (marks[slots] & IN_DOMAIN == 0)
    needed[owner[alone]] = True
    ends = placed.outline.segments[found.rows]
    k, points = mesh.context, mesh.coordinates
    find_entering(k, points, links, placed.corner[ends], positions[ends], needed)
    raise_if_interrupted()
    return ~needed
