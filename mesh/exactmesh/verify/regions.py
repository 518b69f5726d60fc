"""REGIONS: labels of triangles against the segments between them and the points of regions."""

import numpy as np
import numpy.typing as npt

from exactkernel.jit import jit
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.verify.adjacency import neighbours_of, parts_of, rows_of_slots
from exactmesh.verify.bounds import check_areas
from exactmesh.verify.cells import Cells
from exactmesh.verify.chains import CONSTRAINED, IN_DOMAIN, Marks
from exactmesh.verify.faces import faces_of
from exactmesh.verify.links import BOUNDARY, Links, ends_of, slot_of, slots_of
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.properties import Kind, Property, Verdict
from exactmesh.verify.report import Finding, Violation
from exactmesh.verify.witness import IndexArray, finding_of, point_name

__all__ = ["check_labels", "check_region_areas"]

_CHUNK = 1 << 18  # vertices between two looks at Ctrl-C


@jit
def fill_across(links: Links, rows: IntArray, across: IntArray, v_begin: int, v_end: int) -> None:
    """Write the row across each inner edge, at the slot of its smaller end; -1 elsewhere."""
    for v in range(v_begin, v_end):
        for i in range(links.first[v], links.last[v]):
            b = links.slots[i] >> 32
            across[i] = -1
            if v < b and links.kinds[i] != BOUNDARY:
                across[i] = rows[slot_of(links.slots, links.first[b], links.last[b], v)]


def _across(links: Links, rows: IntArray) -> IntArray:
    """Return the row across each inner edge, at the slot of its smaller end; -1 elsewhere."""
    across, n = np.empty(len(links.slots), dtype=np.int32), len(links.first)
    for begin in range(0, n, _CHUNK):
        fill_across(links, rows, across, begin, min(begin + _CHUNK, n))
        raise_if_interrupted()
    return across


def check_labels(
    mesh: Mesh,
    links: Links,
    cells: Cells,
    marks: Marks,
    labels: npt.NDArray[np.float64],
    seeds: FloatArray,
    attributes: FloatArray,
) -> Finding:
    """REGIONS, for admissible triangles that contain every segment.

    Args:
        mesh: the points.
        links, cells: counterclockwise cells, row by row those of the mesh.
        marks: of their edges.
        labels: (m + k,) their labels.
        seeds: (r, 2) points of regions in the coordinates of the mesh.
        attributes: (r,) what the labels should be.

    O(m), and O(s log s) for s edges on segments where there are seeds.
    """
    rows = rows_of_slots(links, *cells)
    across = _across(links, rows)
    slots = np.flatnonzero((across >= 0) & (marks & (CONSTRAINED | IN_DOMAIN) == 0))
    slots = slots[labels[rows[slots]] != labels[across[slots]]]

    def describe(slot: int) -> Violation:
        v, b, _ = (int(ends[0]) for ends in ends_of(links, np.array([slot])))
        s, t = int(rows[slot]), int(across[slot])
        message = (
            f"{mesh.noun}s {s} and {t} have labels {labels[s]:g} and {labels[t]:g}, but no segment lies between them, "
            f"on the edge {point_name(mesh.points, v)} - {point_name(mesh.points, b)}"
        )
        return Violation(Property.REGIONS, Kind.LABELS_DIFFER, (s, t), (v, b), message)

    finding = finding_of(slots, describe)
    if finding.verdict is Verdict.FAILS or not len(seeds):
        return finding
    inside, face, at = _located(mesh, links, marks, rows, across, seeds)
    return _seeds(mesh, inside, face, at, labels, attributes)


def _located(
    mesh: Mesh, links: Links, marks: Marks, rows: IntArray, across: IntArray, seeds: FloatArray
) -> tuple[IndexArray, IndexArray, IntArray]:
    """Return the seeds that lie in covered faces of the segments, their faces, and the row of a triangle in each."""
    segments = np.flatnonzero((marks & (CONSTRAINED | IN_DOMAIN) > 0) & (links.kinds != BOUNDARY))
    slots = np.concatenate([slots_of(links, BOUNDARY), segments])
    faces = faces_of(mesh, links, slots, np.zeros(len(slots), dtype=np.bool_), None, seeds)
    sides, on = faces.answers
    inside = np.flatnonzero(~on & faces.covered(sides))
    edges, face = sides[inside] >> 1, faces.plane.face[sides[inside]]
    slots = faces.plane.source[edges]
    upwards = ends_of(links, slots)[0] == faces.corner[faces.plane.low[edges]]
    return inside, face, np.where(upwards, rows[slots], across[slots])


def _seeds(
    mesh: Mesh,
    inside: IndexArray,
    face: IndexArray,
    triangles: IntArray,
    labels: npt.NDArray[np.float64],
    attributes: FloatArray,
) -> Finding:
    """Compare the points of regions with the label of their face, where that is one."""
    right = labels[triangles] == attributes[inside]
    culprits = np.flatnonzero(~np.isin(face, face[right]))

    def describe(i: int) -> Violation:
        seed, t = int(inside[i]), int(triangles[i])
        corners = mesh.corners(t)
        message = (
            f"region {seed} has attribute {attributes[seed]:g}, but {mesh.noun} {t} in its face has label {labels[t]:g}"
        )
        return Violation(Property.REGIONS, Kind.WRONG_LABEL, (t,), corners, message)

    return finding_of(culprits, describe)


def check_region_areas(
    mesh: Mesh, links: Links, triangles: IntArray, marks: Marks, seeds: FloatArray, areas: FloatArray
) -> Finding:
    """REGION_AREAS, for admissible triangles that contain every segment; arguments as for check_labels.

    A face of the segments is a part of the triangles that is connected across the edges on no segment: one triangle in
    it finds the others. Of several points in a face the smallest area counts.
    """
    limited = np.flatnonzero(areas < np.inf)
    if not limited.size:
        return Finding(Verdict.HOLDS)
    rows = rows_of_slots(links, triangles)
    inside, _, at = _located(mesh, links, marks, rows, _across(links, rows), seeds[limited])
    part, count = parts_of(neighbours_of(links, triangles, rows, marks, CONSTRAINED | IN_DOMAIN))
    limits = np.full(count, np.inf)
    np.minimum.at(limits, part[at], areas[limited[inside]])
    return check_areas(mesh, triangles, limits[part], Property.REGION_AREAS)
