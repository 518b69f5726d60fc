"""EDGE_MANIFOLD and VERTEX_MANIFOLD: combinatorics of the links."""

import numpy as np
import numpy.typing as npt

from exactkernel.jit import jit
from exactmesh.verify.links import _LOW, BOUNDARY, CROWDED, REPEATED, Links, ends_of, slot_of, slots_of
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.properties import Kind, Property, Verdict
from exactmesh.verify.report import WITNESSES, Finding, Violation
from exactmesh.verify.witness import IndexArray, finding_of, point_name, rows_at_vertices, rows_of_triangles

__all__ = ["check_edges", "check_fans", "fans_finding", "repeated_edges"]

_CHUNK = 1 << 20


def repeated_edges(mesh: Mesh, links: Links, property_: Property, kind: Kind, fault: str) -> Finding:
    """Return a violation for each directed edge that occurs more than once."""
    if not (links.kinds == REPEATED).any():
        return Finding(Verdict.HOLDS)
    v, b, _ = ends_of(links, slots_of(links, REPEATED))
    edges = np.unique(np.stack([v, b], axis=1), axis=0)
    told = edges[:WITNESSES].tolist()
    triples = [[(v, b, c) for c in _third_corners(links, v, b)] for v, b in told]
    rows = iter(
        rows_of_triangles(
            mesh.triangles, [corners for group in triples for corners in group], len(mesh.points), mesh.quads
        )
    )
    violations = []
    for (v, b), group in zip(told, triples, strict=True):
        found = tuple(sorted({row for _ in group for row in next(rows)}))
        name = f"the edge from {point_name(mesh.points, v)} to {point_name(mesh.points, b)}"
        message = f"{mesh.noun}s {', '.join(map(str, found))} lie on one side of {name}: {fault}"
        violations.append(Violation(property_, kind, found, (v, b), message))
    return Finding(Verdict.FAILS, len(edges), tuple(violations))


def _third_corners(links: Links, v: int, b: int) -> list[int]:
    """Return the different third corners of the triangles that list v -> b, the first few."""
    bucket = links.slots[links.first[v] : links.last[v]]
    return list(dict.fromkeys((bucket[bucket >> 32 == b][:WITNESSES] & _LOW).tolist()))


def check_edges(mesh: Mesh, links: Links) -> Finding:
    """EDGE_MANIFOLD."""
    return repeated_edges(mesh, links, Property.EDGE_MANIFOLD, Kind.REPEATED_EDGE, "they list it in the same direction")


@jit
def find_broken_fans(links: Links, r_begin: int, r_end: int, broken: npt.NDArray[np.bool_]) -> None:
    """Walk round each vertex from where its triangles begin; all of them must be met.

    Without repeated edges each slot has at most one successor and one predecessor, so the walk cannot run in
    circles that miss its start. Two path starts, or a path and a cycle, are two fans.
    """
    slots, kinds = links.slots, links.kinds
    for v in links.order[r_begin:r_end]:
        begin, end = links.first[v], links.last[v]
        start, starts = begin, 0
        for i in range(begin, end):
            if kinds[i] == BOUNDARY:
                start = i
                starts += 1
            elif kinds[i] == REPEATED or kinds[i] == CROWDED:
                broken[v] = True
        if broken[v] or starts > 1:
            broken[v] = True
            continue
        met, i = 0, start
        while i >= 0:
            met += 1
            i = slot_of(slots, begin, end, slots[i] & _LOW) if met < end - begin else -1
            if i == start:
                i = -1
        broken[v] = met < end - begin


def check_fans(mesh: Mesh, links: Links) -> Finding:
    """VERTEX_MANIFOLD by walking round every vertex. Linear time but for searching in the buckets."""
    broken = np.zeros(len(mesh.points), dtype=np.bool_)
    for begin in range(0, len(links.order), _CHUNK):
        find_broken_fans(links, begin, min(begin + _CHUNK, len(links.order)), broken)
    return fans_finding(mesh, np.flatnonzero(broken))


def fans_finding(mesh: Mesh, broken: IndexArray) -> Finding:
    """Return VERTEX_MANIFOLD, given the vertices round which the triangles do not form one fan."""
    if not broken.size:
        return Finding(Verdict.HOLDS)
    rows = rows_at_vertices(mesh.triangles, broken[:WITNESSES], len(mesh.points), mesh.quads)

    def describe(v: int) -> Violation:
        message = f"the {mesh.noun}s round {point_name(mesh.points, v)}, such as {rows[v]}, do not form one fan"
        return Violation(Property.VERTEX_MANIFOLD, Kind.BROKEN_FAN, rows[v], (v,), message)

    return finding_of(broken, describe)
