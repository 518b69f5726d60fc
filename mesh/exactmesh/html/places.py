"""The failing places, as the page lists, marks and draws them."""

import math

import numpy as np

from exactmesh.html.payload import Payload
from exactmesh.verify import CheckedMesh, Kind, Property, Report, Severity, Violation
from exactmesh.verify.witness import approximately

__all__ = ["places_of", "properties_of"]

#: What people want to know of first, whatever the order of the properties.
_GRAVEST = (
    Property.FINITE,
    Property.INDICES,
    Property.ADMISSIBLE,
    Property.ORIENTATION,
    Property.EDGE_MANIFOLD,
    Property.VERTEX_MANIFOLD,
    Property.ALL_POINTS_USED,
    Property.COVERS_HULL,
    Property.SEGMENTS_PRESENT,
    Property.COVERS_DOMAIN,
    Property.DOMAIN_POINTS,
)


def properties_of(report: Report) -> list[dict[str, object]]:
    """Return the properties whose violations are listed, claimed ones first."""
    ordered = sorted(report.findings, key=lambda property_: (property_ not in report.claims, _gravity(property_)))
    return [
        {
            "name": property_.value,
            "claimed": property_ in report.claims,
            "listed": len(report.findings[property_].violations),
            "total": f"{'≥ ' if report.findings[property_].lower_bound else ''}{report.findings[property_].count}",
        }
        for property_ in ordered
    ]


def _gravity(property_: Property) -> int:
    return _GRAVEST.index(property_) if property_ in _GRAVEST else len(_GRAVEST) + list(Property).index(property_)


def places_of(report: Report, mesh: CheckedMesh, payload: Payload) -> list[dict[str, object]]:
    """Return the violations: of claimed properties first, wrong before rounding-sized."""
    ordered = sorted(
        report.violations,
        key=lambda violation: (
            violation.property not in report.claims,
            violation.severity is not Severity.WRONG,
            _gravity(violation.property),
        ),
    )
    return [{"index": i, **_place(violation, mesh, payload)} for i, violation in enumerate(ordered)]


def _place(violation: Violation, mesh: CheckedMesh, payload: Payload) -> dict[str, object]:
    inside = [v for v in violation.vertices if 0 <= v < len(mesh.points)]
    corners = {v for t in violation.triangles for v in _corners(mesh, t) if 0 <= v < len(mesh.points)}
    positions = mesh.points[sorted(corners | set(inside))]
    degrees = {} if violation.degrees is None else {"degrees": violation.degrees}
    magnitude = violation.magnitude
    return {
        "property": violation.property.value,
        "kind": violation.kind.value,
        "severity": violation.severity.value,
        "message": violation.message,
        "triangles": list(violation.triangles),
        "vertices": list(violation.vertices),
        "sign": None if violation.sign is None else int(violation.sign),
        "magnitude": None if magnitude is None else f"{magnitude.numerator}/{magnitude.denominator}",
        "approximately": None if magnitude is None else approximately(magnitude),
        **degrees,
        "points": [_numbers(v, mesh) for v in violation.vertices],
        "places": [],
        "box": _box(positions, payload),
        "lines": _lines(violation.kind, tuple(inside)),
        "circles": _circles(violation.kind, tuple(inside)),
    }


def _corners(mesh: CheckedMesh, cell: int) -> list[int]:
    m = len(mesh.triangles)
    corners: list[int] = (mesh.triangles[cell] if cell < m else mesh.quads[cell - m]).tolist()
    return corners


def _numbers(v: int, mesh: CheckedMesh) -> dict[str, object]:
    position = mesh.points[v].tolist() if 0 <= v < len(mesh.points) else []
    return {"vertex": v, "decimal": [repr(z) for z in position], "hex": [z.hex() for z in position]}


def _box(positions: "np.ndarray[tuple[int, int], np.dtype[np.float64]]", payload: Payload) -> list[float] | None:
    finite = positions[np.isfinite(positions).all(axis=1)]
    if not len(finite):
        return None
    box = [*finite.min(axis=0).tolist(), *finite.max(axis=0).tolist()]
    return [payload.scaled(z) for z in box if math.isfinite(z)]


def _lines(kind: Kind, vertices: tuple[int, ...]) -> list[tuple[int, int]]:
    """Return the pairs of vertices whose connection is at fault."""
    if len(vertices) == 2 or (kind in (Kind.POINT_IN_CIRCLE, Kind.ENCROACHED) and len(vertices) > 2):
        return [(vertices[0], vertices[1])]
    if kind is Kind.REFLEX_BOUNDARY and len(vertices) == 3:
        return [(vertices[0], vertices[1]), (vertices[1], vertices[2])]
    return []


def _circles(kind: Kind, vertices: tuple[int, ...]) -> list[tuple[int, ...]]:
    """Return three vertices for a circumcircle, two for a diametral circle."""
    if kind is Kind.POINT_IN_CIRCLE and len(vertices) == 4:
        return [vertices[:3]]
    if kind is Kind.ENCROACHED and len(vertices) == 3:
        return [vertices[:2]]
    if kind is Kind.CENTRE_OUTSIDE and len(vertices) == 3:
        return [vertices]
    return []
