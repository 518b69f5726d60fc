"""Assertions about meshes, for tests: what fails says where, in the verifier's words, with a mesh to copy."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

from typing import cast

import numpy.typing as npt

from exactmesh.adapters import given_mesh
from exactmesh.verify import (
    CONSTRAINED_TRIANGULATION,
    DELAUNAY_TRIANGULATION,
    DOMAIN_TRIANGULATION,
    Domain,
    Orientation,
    Property,
    Report,
    Verdict,
    verify,
)

__all__ = ["assert_admissible", "assert_constrained_delaunay", "assert_delaunay"]

_SENTENCES = 3  # of each claim that are told
_ADMISSIBLE = (Property.FINITE, Property.INDICES, Property.ADMISSIBLE)


def assert_delaunay(
    points: object, triangles: npt.ArrayLike | None = None, *, orientation: Orientation | str | None = None
) -> None:
    """Assert that the triangles are a Delaunay triangulation of all the points.

    Args:
        points: (n, 2); or, alone, any mesh that :mod:`exactmesh.adapters` understands.
        triangles: (m, 3).
        orientation: "any" if triangles may be listed clockwise.

    Raises:
        AssertionError: they are not. It tells what is violated, and the smallest part of the mesh that shows it.

    >>> from exactmesh.conformance import assert_delaunay
    >>> kite = [(0, 0), (3, -1), (6, 0), (3, 1)]
    >>> assert_delaunay(kite, [(0, 1, 3), (1, 2, 3)])
    >>> assert_delaunay(kite, [(0, 1, 2), (0, 2, 3)])  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    AssertionError: 4 points, 2 triangles: not what they should be
      delaunay fails: vertex ... lies inside the circumcircle of triangle ...
    <BLANKLINE>
    points = [
        (0.0, 0.0),  # point 0
        (3.0, -1.0),  # point 1
        (6.0, 0.0),  # point 2
        (3.0, 1.0),  # point 3
    ]
    triangles = [
        ...
    ]
    """
    __tracebackhide__ = True
    _assert_holds(_report(points, triangles, claims=DELAUNAY_TRIANGULATION, orientation=orientation))


def assert_admissible(
    points: object, triangles: npt.ArrayLike | None = None, *, quads: npt.ArrayLike | None = None
) -> None:
    """Assert that any two cells meet in nothing, a common corner or a common edge; listed in either orientation.

    Args:
        points: (n, 2); or, alone, any mesh that :mod:`exactmesh.adapters` understands.
        triangles: (m, 3).
        quads: (k, 4).

    Raises:
        AssertionError: they do not.

    >>> from exactmesh.conformance import assert_admissible
    >>> assert_admissible([(0, 0), (2, 0), (1, 1), (1, -1)], [(0, 1, 2), (0, 1, 3)])
    """
    __tracebackhide__ = True
    _assert_holds(_report(points, triangles, quads=quads, claims=_ADMISSIBLE))


def assert_constrained_delaunay(
    points: object,
    triangles: npt.ArrayLike | None = None,
    *,
    segments: npt.ArrayLike | None = None,
    domain: Domain | None = None,
    orientation: Orientation | str | None = None,
) -> None:
    """Assert that the triangles are a constrained Delaunay triangulation: of the hull, or of a domain.

    Args:
        points: (n, 2); or, alone, any mesh that :mod:`exactmesh.adapters` understands.
        triangles: (m, 3).
        segments: (s, 2), rows of points.
        domain: what is covered instead of the hull, such as a :class:`exactmesh.PSLG`.
        orientation: "any" if triangles may be listed clockwise.

    Raises:
        AssertionError: they are not.
        ChoiceError: neither the mesh nor the call has segments or a domain.

    >>> from exactmesh.conformance import assert_constrained_delaunay
    >>> kite = [(0, 0), (3, -1), (6, 0), (3, 1)]
    >>> assert_constrained_delaunay(kite, [(0, 1, 2), (0, 2, 3)], segments=[(0, 2)])
    """
    __tracebackhide__ = True
    own = triangles is None and given_mesh(points).domain is not None
    claims = CONSTRAINED_TRIANGULATION if domain is None and not own else DOMAIN_TRIANGULATION
    _assert_holds(_report(points, triangles, segments=segments, domain=domain, claims=claims, orientation=orientation))


def _report(
    points: object,
    triangles: npt.ArrayLike | None,
    *,
    quads: npt.ArrayLike | None = None,
    segments: npt.ArrayLike | None = None,
    domain: Domain | None = None,
    claims: tuple[Property, ...] | None = None,
    orientation: Orientation | str | None = None,
) -> Report:
    """Call verify in one of its two forms."""
    if triangles is None:
        return verify(points, quads=quads, segments=segments, domain=domain, claims=claims, orientation=orientation)
    return verify(
        cast("npt.ArrayLike", points),
        triangles,
        quads=quads,
        segments=segments,
        domain=domain,
        claims=claims,
        orientation=orientation,
    )


def _assert_holds(report: Report) -> None:
    __tracebackhide__ = True
    if not report.ok:
        raise AssertionError(_told(report))


def _told(report: Report) -> str:
    """Return what fails, claim by claim, and the smallest part of the mesh that shows the first."""
    lines = [f"{report.point_count} points, {report.triangle_count} triangles: not what they should be"]
    failing = [claim for claim in report.claims if report.verdict(claim) is Verdict.FAILS]
    for claim in failing:
        finding = report.findings[claim]
        size = ", by rounding only" if finding.severity == "rounding" else ""
        lines += [f"  {claim} fails{size}: {violation.message}" for violation in finding.violations[:_SENTENCES]]
        if finding.count > _SENTENCES:
            lines.append(f"  ... and {finding.count - _SENTENCES} more")
    undecided = [str(claim) for claim in report.claims if report.verdict(claim) is Verdict.UNDECIDED]
    if undecided:
        lines.append(f"  undecided because of that: {', '.join(undecided)}")
    witnesses = [violation for claim in failing for violation in report.findings[claim].violations]
    if witnesses:
        smallest = min(witnesses, key=lambda violation: (not violation.is_local, len(violation.indices)))
        lines += ["", smallest.submesh().to_python().rstrip()]
    return "\n".join(lines)
