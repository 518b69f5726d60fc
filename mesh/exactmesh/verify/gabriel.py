"""GABRIEL: the diametral circles of the boundary and of the segments, locally by the opposite corners."""

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from exactkernel.constants import ORIENT2D_BOUND
from exactkernel.context import Context, chunk_size
from exactkernel.diametral import diametral_adaptive
from exactkernel.jit import jit
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray
from exactmesh.verify.chains import Marks, edge_slot
from exactmesh.verify.grading import rank_diametral
from exactmesh.verify.links import _LOW, BOUNDARY, NOT_DELAUNAY, Links, ends_of
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.properties import Kind, Property, Severity, Verdict
from exactmesh.verify.report import Finding, Violation
from exactmesh.verify.severity import diametral_terms, severity_of
from exactmesh.verify.witness import (
    approximately,
    finding_of,
    point_name,
    rows_of_triangles,
    sign_of,
)

__all__ = ["check_gabriel", "is_locally_delaunay"]

_CHUNK = 1 << 16  # vertices between two looks at Ctrl-C


@jit
def find_encroached(
    k: Context,
    points: FloatArray,
    links: Links,
    marks: Marks,
    encroached: npt.NDArray[np.bool_],
    v_begin: int,
    v_end: int,
) -> None:
    """Tell at which slots of boundary and marked edges the third corner lies inside the diametral circle."""
    for v in range(v_begin, v_end):
        for i in range(links.first[v], links.last[v]):
            b, c = links.slots[i] >> 32, links.slots[i] & _LOW
            encroached[i] = (links.kinds[i] == BOUNDARY or marks[edge_slot(links, v, b)] != 0) and diametral_adaptive(
                k, points[v, 0], points[v, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1]
            ) > 0


def is_locally_delaunay(links: Links, marks: Marks) -> bool:
    """Tell whether across no unmarked edge the far corner is inside the circle."""
    return not ((links.kinds == NOT_DELAUNAY) & (marks == 0)).any()


def check_gabriel(mesh: Mesh, links: Links, marks: Marks, missing: tuple[Property, ...]) -> Finding:
    """GABRIEL, for counterclockwise triangles.

    An opposite corner inside a diametral circle refutes it, whatever else is wrong. Without any, the triangles being
    admissible and Delaunay across unmarked edges, theorem H: let a corner p be strictly inside the circle of the edge e
    and visible from a point x inside e. Move x, or take a corner nearer to x for p, so that on the way from x to p
    there is no vertex. The way crosses edges between triangles t, t', ...; the corner of t opposite to e is not inside,
    so the half of the disc on that side lies within the circle of t, and p with it. Across each further edge the power
    of p does not grow: across an unmarked one because incircle <= 0, across a marked one because neither opposite
    corner is inside its diametral circle, whose power lies between those of the two circles. So p is strictly inside
    the circle of the last triangle, of which it is a corner: a contradiction.

    Args:
        mesh: the points.
        links: of the triangles with area.
        marks: (3m,) nonzero at the slots that stand for edges on segments.
        missing: what does not hold of that on which the theorem rests.

    O(m).
    """
    encroached = np.zeros(len(links.slots), dtype=np.bool_)
    step = chunk_size(mesh.context, _CHUNK)
    for begin in range(0, len(mesh.points), step):
        end = min(begin + step, len(mesh.points))
        find_encroached(mesh.context, mesh.coordinates, links, marks, encroached, begin, end)
        raise_if_interrupted()
    slots = np.flatnonzero(encroached)
    if not slots.size:
        return Finding(Verdict.UNDECIDED, because=missing) if missing else Finding(Verdict.HOLDS)
    corners = np.stack(ends_of(links, slots), axis=1)
    ranking = rank_diametral(mesh, corners)
    found = rows_of_triangles(mesh.triangles, [*map(tuple, corners[ranking.order].tolist())], len(mesh.points))
    rows = {i: rows[:1] for i, rows in zip(ranking.order.tolist(), found, strict=True)}

    def describe(i: int) -> Violation:
        v, b, c = corners[i].tolist()
        terms = diametral_terms(mesh.points, v, b, c)
        magnitude, severity = terms[0], severity_of(terms, ORIENT2D_BOUND)
        kind = "boundary edge" if links.kinds[slots[i]] == BOUNDARY else "edge on a segment"
        message = (
            f"vertex {point_name(mesh.points, c)} lies inside the diametral circle of the {kind} "
            f"{point_name(mesh.points, v)} - {point_name(mesh.points, b)}: diametral {approximately(magnitude)}"
        )
        if severity is Severity.ROUNDING:
            message += ", rounding-sized"
        return Violation(
            Property.GABRIEL, Kind.ENCROACHED, rows[i], (v, b, c), message, sign_of(magnitude), magnitude, severity
        )

    return replace(finding_of(np.arange(len(slots)), describe, ranking), lower_bound=bool(missing))
