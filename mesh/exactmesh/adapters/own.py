"""exactmesh's own: Triangulation, Refinement, what a file holds, and what an adapter made."""

from typing import TYPE_CHECKING, Protocol, cast

import numpy as np

from exactkernel.types import FloatArray, IntArray
from exactmesh.adapters.given import GivenDomain, GivenMesh, is_a
from exactmesh.errors import AdapterError
from exactmesh.verify.domain import Domain

if TYPE_CHECKING:
    from exactmesh.io import Mesh

__all__ = ["WORDS", "accepts", "convert", "domain_by_seeds"]


class _Triangulation(Protocol):
    """What is asked of a Triangulation; adapters know no algorithm, not even by its type."""

    @property
    def points(self) -> FloatArray: ...
    @property
    def triangles(self) -> IntArray: ...
    @property
    def segments(self) -> IntArray: ...
    @property
    def triangle_attributes(self) -> FloatArray: ...
    @property
    def domain(self) -> Domain | None: ...


class _Refinement(Protocol):
    @property
    def triangulation(self) -> _Triangulation: ...


WORDS = "exactmesh's Triangulation, Refinement and io.Mesh"


def accepts(mesh: object) -> bool:
    """Tell whether it is one of exactmesh's."""
    return is_a(mesh, "exactmesh", "GivenMesh", "Triangulation", "Refinement", "Mesh")


def convert(mesh: object) -> GivenMesh:
    """Return the arrays, and the domain that they should cover: what the object says that it covers, so that of a
    refinement it is the displaced one."""
    if isinstance(mesh, GivenMesh):
        return mesh
    if is_a(mesh, "exactmesh", "Refinement"):
        return _of_triangulation(cast(_Refinement, mesh).triangulation, "a Refinement")
    if is_a(mesh, "exactmesh", "Triangulation"):
        return _of_triangulation(cast(_Triangulation, mesh), "a Triangulation")
    return _of_file(cast("Mesh", mesh))


def _of_triangulation(mesh: _Triangulation, source: str) -> GivenMesh:
    """Without a domain the hull is covered, and segments, if there are any, are edges of the triangles."""
    domain = mesh.domain
    segments = mesh.segments if domain is None and len(mesh.segments) else None
    labels = mesh.triangle_attributes if domain is not None and len(domain.regions) else None
    return GivenMesh(
        mesh.points,
        mesh.triangles,
        segments=segments,
        labels=labels[:, -1] if labels is not None and labels.shape[1] else None,
        domain=domain,
        source=source,
    )


def domain_by_seeds(
    points: FloatArray, segments: IntArray, holes: FloatArray | None, regions: FloatArray | None
) -> GivenDomain:
    """Return the domain that segments and seeds describe."""
    return GivenDomain(
        points,
        segments,
        np.empty((0, 2)) if holes is None else holes,
        np.empty((0, 4)) if regions is None else regions,
    )


def _of_file(mesh: "Mesh") -> GivenMesh:
    """The segments of a file and the seeds in it are the domain; without segments it is the hull."""
    if mesh.triangles is None:
        raise AdapterError("the io.Mesh has no triangles, only points")
    if mesh.segments is None or not len(mesh.segments):
        return GivenMesh(mesh.points, mesh.triangles, source="an io.Mesh")
    attributes = None if mesh.regions is None else mesh.triangle_attributes
    return GivenMesh(
        mesh.points,
        mesh.triangles,
        labels=None if attributes is None else attributes[:, -1],
        domain=domain_by_seeds(mesh.points, mesh.segments, mesh.holes, mesh.regions),
        source="an io.Mesh",
    )
