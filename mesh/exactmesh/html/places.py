"""The failing places, as the page lists, marks and draws them."""

import math
from collections.abc import Sequence

from exactmesh.html.payload import Payload
from exactmesh.verify import Kind, Property, Report, Severity, Violation
from exactmesh.verify.document import numbered_positions, position, violation_document
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


def places_of(report: Report, payload: Payload) -> list[dict[str, object]]:
    """Return the violations: of claimed properties first, wrong before rounding-sized."""
    ordered = sorted(
        report.violations,
        key=lambda violation: (
            violation.property not in report.claims,
            violation.severity is not Severity.WRONG,
            _gravity(violation.property),
        ),
    )
    return [
        {"index": i, "tone": _tone(report, violation), **_place(violation, payload)}
        for i, violation in enumerate(ordered)
    ]


def _tone(report: Report, violation: Violation) -> str:
    """Return what the eye shall see: what nobody claimed is a fact, not a fault."""
    return violation.severity.value if violation.property in report.claims else "not_claimed"


def _place(violation: Violation, payload: Payload) -> dict[str, object]:
    point_of = dict(zip(violation.indices, numbered_positions(violation), strict=True))
    others: list[dict[str, object]] = [{"vertex": None, **position(*place)} for place in violation.places]
    there = [v for v in violation.vertices if 0 <= v < violation.point_count]
    magnitude = violation.magnitude
    return {
        **violation_document(violation),
        "property": violation.property.value,
        "approximately": None if magnitude is None else approximately(magnitude),
        "points": [*(point_of[v] for v in dict.fromkeys((*violation.vertices, *violation.indices))), *others],
        "places": [[payload.scaled(z) for z in place] for place in violation.places],
        "box": _box((*violation.points, *violation.places), payload),
        "lines": _lines(violation.kind, tuple(there)),
        "circles": _circles(violation.kind, tuple(there)),
    }


def _box(points: Sequence[tuple[float, float]], payload: Payload) -> list[float] | None:
    """Return west, south, east, north of what is finite."""
    finite = [point for point in points if all(map(math.isfinite, point))]
    if not finite:
        return None
    x, y = zip(*finite, strict=True)
    return [payload.scaled(z) for z in (min(x), min(y), max(x), max(y))]


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
