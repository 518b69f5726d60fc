"""A mesh from a file against its domain: one from another file, or what its own segments and holes describe."""

import os
from collections.abc import Collection

from exactmesh.errors import PSLGError
from exactmesh.io import Mesh
from exactmesh.pslg import PSLG
from exactmesh.verify import Report, verify

__all__ = ["checked_against", "checked_alone"]

_REMEDY = "--domain FILE says what else it should cover"


def checked_against(
    domain: PSLG, base: int, path: str, mesh: Mesh, claims: Collection[str] | None, orientation: str
) -> Report:
    """Verify the mesh as a triangulation of the domain that was read from ``path``, which counts from ``base``.

    Attributes of triangles are those of the domain's regions, if it has some.

    Raises:
        PSLGError: the domain has none; the message names the file.
    """
    assert mesh.triangles is not None
    attributes = mesh.triangle_attributes if len(domain.regions) else None
    labels = None if attributes is None else attributes[:, -1]
    try:
        return verify(mesh.points, mesh.triangles, domain=domain, labels=labels, claims=claims, orientation=orientation)
    except PSLGError as error:
        raise PSLGError(error.faults, path=path, base=base) from None


def checked_alone(mesh: Mesh, path: str, claims: Collection[str] | None, orientation: str) -> tuple[Report, str]:
    """Verify the mesh against its own segments and holes, or else against the hull; return a line that says which.

    The hull it is where there are no segments, where they describe no domain, and where the mesh is one of the hull and
    none of that domain: what is written with ``--carve none``.
    """
    assert mesh.triangles is not None
    if mesh.segments is None or not len(mesh.segments):
        return verify(mesh.points, mesh.triangles, segments=mesh.segments, claims=claims, orientation=orientation), ""
    place = _place_of_segments(path)
    try:
        domain = PSLG(mesh.points, mesh.segments, holes=mesh.holes, regions=mesh.regions)
        report = checked_against(domain, mesh.base, place, mesh, claims, orientation)
    except PSLGError as error:
        why = f"for {PSLGError(error.faults, path=place, base=mesh.base)}"
    else:
        if report.ok or claims is not None:
            return report, f"(Checked against the domain of the segments and holes in {place}; {_REMEDY}.)"
        why = f"for it is no triangulation of the domain of the segments and holes in {place}"
    of_hull = verify(mesh.points, mesh.triangles, segments=mesh.segments, claims=claims, orientation=orientation)
    return of_hull, f"(Checked against the hull, {why}; {_REMEDY}.)"


def _place_of_segments(path: str) -> str:
    stem, suffix = os.path.splitext(path)
    return path if suffix == ".npz" else f"{stem}.poly"
