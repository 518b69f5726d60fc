"""A mesh from a file against its domain: one from another file, or what its own segments and holes describe."""

import os
from collections.abc import Collection
from dataclasses import dataclass

from exactmesh.adapters import GivenMesh
from exactmesh.errors import PSLGError
from exactmesh.io import Mesh
from exactmesh.pslg import PSLG
from exactmesh.verify import (
    ADMISSIBLE_MESH,
    CONSTRAINED_TRIANGULATION,
    DELAUNAY_TRIANGULATION,
    DOMAIN_TRIANGULATION,
    Property,
    Report,
    Verdict,
    verify,
)

__all__ = ["Shapes", "checked_against", "checked_alone"]

_REMEDY = "--domain FILE says what else it should cover"


@dataclass(frozen=True, slots=True, kw_only=True)
class Shapes:
    """What is claimed of shapes; None: nothing. And how far the mesh may be from its domain; None: not at all."""

    min_angle: float | None = None
    max_angle: float | None = None
    max_area: float | None = None
    gabriel: bool = False
    within: float | None = None

    def with_default(self, claims: Collection[str] | None, default: tuple[Property, ...]) -> Collection[str] | None:
        """Return the claims with GABRIEL, where that was asked for."""
        return (*(default if claims is None else claims), Property.GABRIEL) if self.gabriel else claims


_ANY_SHAPE = Shapes()
_WITH_LABELS = (*DOMAIN_TRIANGULATION, Property.REGIONS)


def checked_against(
    domain: PSLG,
    base: int,
    path: str,
    mesh: Mesh | GivenMesh,
    claims: Collection[str] | None,
    orientation: str | None,
    shapes: Shapes = _ANY_SHAPE,
) -> Report:
    """Verify the mesh as a triangulation of the domain that was read from ``path``, which counts from ``base``.

    Attributes of triangles are those of the domain's regions, if it has some.

    Raises:
        PSLGError: the domain has none; the message names the file.
    """
    if isinstance(mesh, GivenMesh):
        try:
            return _checked_given(mesh, domain, claims, orientation, shapes)
        except PSLGError as error:
            raise PSLGError(error.faults, path=path, base=base) from None
    assert mesh.triangles is not None
    attributes = mesh.triangle_attributes if len(domain.regions) else None
    labels = None if attributes is None else attributes[:, -1]
    try:
        return verify(
            mesh.points,
            mesh.triangles,
            domain=domain,
            labels=labels,
            min_angle=shapes.min_angle,
            max_angle=shapes.max_angle,
            max_area=shapes.max_area,
            within=shapes.within,
            claims=shapes.with_default(claims, DOMAIN_TRIANGULATION if labels is None else _WITH_LABELS),
            orientation=orientation,
        )
    except PSLGError as error:
        raise PSLGError(error.faults, path=path, base=base) from None


def _checked_given(
    mesh: GivenMesh, domain: PSLG | None, claims: Collection[str] | None, orientation: str | None, shapes: Shapes
) -> Report:
    """Verify the mesh of a format of others, as what it is by default and, if there is one, against a domain."""
    covering = (Property.SEGMENTS_PRESENT, Property.COVERS_DOMAIN, Property.DOMAIN_POINTS)
    default = ADMISSIBLE_MESH if domain is None else ADMISSIBLE_MESH + covering
    return verify(
        mesh,
        domain=domain,
        min_angle=shapes.min_angle,
        max_angle=shapes.max_angle,
        max_area=shapes.max_area,
        within=shapes.within,
        claims=shapes.with_default(claims, default),
        orientation=orientation,
    )


def _checked_hull(mesh: Mesh, claims: Collection[str] | None, orientation: str | None, shapes: Shapes) -> Report:
    assert mesh.triangles is not None
    default = DELAUNAY_TRIANGULATION if mesh.segments is None else CONSTRAINED_TRIANGULATION
    return verify(
        mesh.points,
        mesh.triangles,
        segments=mesh.segments,
        min_angle=shapes.min_angle,
        max_angle=shapes.max_angle,
        max_area=shapes.max_area,
        claims=shapes.with_default(claims, default),
        orientation=orientation,
    )


def checked_alone(
    mesh: Mesh | GivenMesh,
    path: str,
    claims: Collection[str] | None,
    orientation: str | None,
    shapes: Shapes = _ANY_SHAPE,
) -> tuple[Report, str]:
    """Verify the mesh against its own segments and holes, or else against the hull; return a line that says which.

    The hull it is where there are no segments, where they describe no domain, and where the triangles do not cover that
    domain: what is written with ``--carve none`` covers the hull. What else is wrong is told of the domain.
    """
    if isinstance(mesh, GivenMesh):
        return _checked_given(mesh, None, claims, orientation, shapes), ""
    if mesh.segments is None or not len(mesh.segments):
        return _checked_hull(mesh, claims, orientation, shapes), ""
    place = _place_of_segments(path)
    try:
        domain = PSLG(mesh.points, mesh.segments, holes=mesh.holes, regions=mesh.regions)
        report = checked_against(domain, mesh.base, place, mesh, claims, orientation, shapes)
    except PSLGError as error:
        why = f"for {PSLGError(error.faults, path=place, base=mesh.base)}"
    else:
        if claims is not None or report.verdict(Property.COVERS_DOMAIN) is not Verdict.FAILS:
            return report, f"(Checked against the domain of the segments and holes in {place}; {_REMEDY}.)"
        why = f"for it is no triangulation of the domain of the segments and holes in {place}"
    return _checked_hull(mesh, claims, orientation, shapes), f"(Checked against the hull, {why}; {_REMEDY}.)"


def _place_of_segments(path: str) -> str:
    stem, suffix = os.path.splitext(path)
    return path if suffix == ".npz" else f"{stem}.poly"
