"""A report as JSON: what was checked, by hash; what was claimed; every verdict, with witnesses that say all themselves.

The same report makes the same text. :mod:`exactmesh.verify.schema` describes it.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

from exactkernel.types import FloatArray
from exactmesh.verify.checked import CheckedMesh
from exactmesh.verify.hashing import array_sha256, domain_sha256, mesh_sha256

if TYPE_CHECKING:
    from fractions import Fraction

    from exactmesh.verify.domain import Outline
    from exactmesh.verify.mesh import Integers
    from exactmesh.verify.report import Finding, Report, Violation

__all__ = [
    "FORMAT",
    "document_of",
    "finding_document",
    "given_document",
    "numbered_positions",
    "position",
    "violation_document",
]

#: The name and version of what :meth:`Report.to_json` writes.
FORMAT = "exactmesh-report/2"

Json = dict[str, object]


def document_of(report: "Report") -> Json:
    """Return the whole report."""
    import exactmesh  # not before all of it is there

    mesh = report.mesh
    counts = {"points": report.point_count, "triangles": report.triangle_count, "quads": report.quad_count}
    sha256 = None if mesh is None else mesh_sha256(mesh.points, mesh.triangles, mesh.quads)
    return {
        "format": FORMAT,
        "exactmesh": exactmesh.__version__,
        "ok": report.ok,
        "severity": None if report.severity is None else report.severity.value,
        "mesh": {"sha256": sha256, **counts},
        "given": None if mesh is None else given_document(mesh),
        "claims": [claim.value for claim in report.claims],
        "stages": {
            predicate: {stage.name.lower(): count for stage, count in counts.items()}
            for predicate, counts in report.stages.items()
        },
        "properties": {property_.value: finding_document(finding) for property_, finding in report.findings.items()},
    }


def given_document(mesh: CheckedMesh) -> Json:
    """Return what the mesh was checked against, by hash."""
    return {
        "orientation": str(mesh.orientation),
        "segments": None if mesh.segments is None else _array(mesh.segments),
        "domain": None if mesh.domain is None else _domain(mesh.domain),
        "labels": None if mesh.labels is None else _array(mesh.labels),
        "bounds": {name: _bound(bound) for name, bound in sorted(mesh.bounds.items())},
    }


def _array(array: "FloatArray | Integers") -> Json:
    return {"sha256": array_sha256(array), "count": len(array)}


def _domain(outline: "Outline") -> Json:
    return {
        "sha256": domain_sha256(outline),
        "rule": "even-odd" if outline.even_odd else "seeds",
        "points": len(outline.points),
        "segments": len(outline.segments),
        "holes": len(outline.holes),
        "regions": len(outline.regions),
    }


def _bound(bound: float | FloatArray) -> object:
    if isinstance(bound, np.ndarray):
        return _array(bound)
    return bound if math.isfinite(bound) else repr(bound)


def finding_document(finding: "Finding") -> Json:
    """Return what was found about one property."""
    squared = finding.distance_squared
    distance = {} if squared is None else {"distance_squared": _rational(squared)}
    return {
        "verdict": finding.verdict.value,
        "count": finding.count,
        "count_is_lower_bound": finding.lower_bound,
        "rounding": finding.rounding,
        "because": [property_.value for property_ in finding.because],
        **distance,
        **({"note": finding.note} if finding.note else {}),
        "violations": [violation_document(violation) for violation in finding.violations],
    }


def violation_document(violation: "Violation") -> Json:
    """Return one witness; rationals as "p/q", coordinates as they are written in C and as the shortest decimals."""
    angle = {} if violation.degrees is None else {"degrees": violation.degrees}
    return {
        "kind": violation.kind.value,
        "severity": violation.severity.value,
        "triangles": list(violation.triangles),
        "vertices": list(violation.vertices),
        "corners": [list(corners) for corners in violation.corners],
        "points": numbered_positions(violation),
        "places": [position(*place) for place in violation.places],
        "sign": None if violation.sign is None else int(violation.sign),
        "magnitude": None if violation.magnitude is None else _rational(violation.magnitude),
        **angle,
        "message": violation.message,
    }


def numbered_positions(violation: "Violation") -> list[Json]:
    """Return all points of a violation, by index; without digits where there is no such point."""
    nowhere: Json = {"hex": None, "decimal": None}
    return [
        {"vertex": v, **(position(*point) if 0 <= v < violation.point_count else nowhere)}
        for v, point in zip(violation.indices, violation.points, strict=True)
    ]


def _rational(value: "Fraction") -> str:
    return f"{value.numerator}/{value.denominator}"


def position(x: float, y: float) -> Json:
    """Return a position, exactly: doubles have short hexadecimal digits, and decimal ones that lead back to them."""
    return {"hex": [x.hex(), y.hex()], "decimal": [repr(x), repr(y)]}
