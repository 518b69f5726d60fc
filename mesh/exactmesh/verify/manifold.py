"""EDGE_MANIFOLD and VERTEX_MANIFOLD: combinatorics of the links."""

import numpy as np
import numpy.typing as npt

from exactkernel.jit import jit
from exactmesh.verify.cells import Cells
from exactmesh.verify.links import _LOW, BOUNDARY, CROWDED, REPEATED, Links, ends_of, slot_of, slots_of
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.pairs import rows_listing, unlinked_rows
from exactmesh.verify.properties import Kind, Property, Verdict
from exactmesh.verify.report import WITNESSES, Finding, Violation
from exactmesh.verify.witness import IndexArray, finding_of, point_name

__all__ = ["check_edges", "check_fans", "fans_finding", "repeated_edges"]

_CHUNK = 1 << 20


def repeated_edges(mesh: Mesh, cells: Cells, links: Links, property_: Property, kind: Kind, fault: str) -> Finding:
    """Return a violation for each directed edge that occurs more than once; ``links`` are those of the cells."""
    if not (links.kinds == REPEATED).any():
        return Finding(Verdict.HOLDS)
    v, b, _ = ends_of(links, slots_of(links, REPEATED))
    edges = np.unique(np.stack([v, b], axis=1), axis=0)
    rows = rows_listing(cells, edges[:WITNESSES], len(mesh.points))

    def describe(i: int) -> Violation:
        v, b = edges[i].tolist()
        first, second, *others = rows[i]
        more = f" and {len(others)} more" if others else ""
        name = f"the edge from {point_name(mesh.points, v)} to {point_name(mesh.points, b)}"
        message = f"{mesh.noun}s {first}, {second}{more} lie on one side of {name}: {fault}"
        return Violation(property_, kind, (first, second), (v, b), message)

    return finding_of(np.arange(len(edges)), describe)


def check_edges(mesh: Mesh, cells: Cells, links: Links) -> Finding:
    """EDGE_MANIFOLD."""
    fault = "they list it in the same direction"
    return repeated_edges(mesh, cells, links, Property.EDGE_MANIFOLD, Kind.REPEATED_EDGE, fault)


@jit
def find_broken_fans(links: Links, r_begin: int, r_end: int, broken: npt.NDArray[np.bool_]) -> None:
    """Walk round each vertex from where its triangles begin; all of them must be met.

    Without repeated edges each slot has at most one successor and one predecessor, so the walk cannot run in
    circles that miss its start. Two path starts, or a path and a cycle, are two fans.
    """
    slots, kinds = links.slots, links.kinds
    for v in links.order[r_begin:r_end]:
        begin, end = links.first[v], links.last[v]
        start = begin
        for i in range(begin, end):
            if kinds[i] == BOUNDARY:
                start = i
            elif kinds[i] == REPEATED or kinds[i] == CROWDED:
                broken[v] = True
        if broken[v]:
            continue
        met, i = 0, start
        while i >= 0:
            met += 1
            i = slot_of(slots, begin, end, slots[i] & _LOW) if met < end - begin else -1
            if i == start:
                i = -1
        broken[v] = met < end - begin


def check_fans(mesh: Mesh, cells: Cells, links: Links) -> Finding:
    """VERTEX_MANIFOLD by walking round every vertex. Linear time but for searching in the buckets."""
    broken = np.zeros(len(mesh.points), dtype=np.bool_)
    for begin in range(0, len(links.order), _CHUNK):
        find_broken_fans(links, begin, min(begin + _CHUNK, len(links.order)), broken)
    return fans_finding(mesh, cells, np.flatnonzero(broken))


def fans_finding(mesh: Mesh, cells: Cells, broken: IndexArray) -> Finding:
    """Return VERTEX_MANIFOLD, given the vertices round which the cells do not form one fan."""
    if not broken.size:
        return Finding(Verdict.HOLDS)
    rows = unlinked_rows(cells, broken[:WITNESSES], len(mesh.points))

    def describe(v: int) -> Violation:
        first, second = rows[v]
        name = f"the {mesh.noun}s round {point_name(mesh.points, v)}"
        message = f"{name} do not form one fan: {first} and {second} are not in one"
        return Violation(Property.VERTEX_MANIFOLD, Kind.BROKEN_FAN, (first, second), (v,), message)

    return finding_of(broken, describe)
