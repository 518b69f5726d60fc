"""scipy.spatial.Delaunay."""

from typing import TYPE_CHECKING, cast

from exactmesh.adapters.given import GivenMesh, index_rows, is_a
from exactmesh.errors import AdapterError
from exactmesh.verify.properties import ADMISSIBLE_MESH, Orientation

if TYPE_CHECKING:
    from scipy.spatial import Delaunay

__all__ = ["WORDS", "accepts", "convert"]

WORDS = "scipy.spatial.Delaunay"


def accepts(mesh: object) -> bool:
    """Tell whether it is a scipy Delaunay."""
    return is_a(mesh, "scipy", "Delaunay")


def convert(mesh: object) -> GivenMesh:
    """Return points and simplices, which scipy promises to be counterclockwise. Of farthest sites nothing is claimed
    but that they are a mesh."""
    found = cast("Delaunay", mesh)
    if found.ndim != 2:
        raise AdapterError(f"the scipy Delaunay has {found.ndim} dimensions; meshes are planar")
    farthest = bool(getattr(found, "furthest_site", False))
    return GivenMesh(
        found.points,
        index_rows(found.simplices, 3, "simplices"),
        orientation=Orientation.ANY if farthest else Orientation.CCW,
        claims=ADMISSIBLE_MESH if farthest else None,
        source="a scipy Delaunay",
    )
