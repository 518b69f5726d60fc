"""scikit-fem's MeshTri and MeshQuad, of whatever order."""

from typing import TYPE_CHECKING, cast

import numpy as np

from exactmesh.adapters.given import GivenMesh, is_a
from exactmesh.adapters.meshio_mesh import given_cells
from exactmesh.errors import AdapterError

if TYPE_CHECKING:
    from skfem import Mesh

__all__ = ["WORDS", "accepts", "convert"]

WORDS = "scikit-fem's MeshTri and MeshQuad"

_CELLS = {3: "triangle", 4: "quad"}


def accepts(mesh: object) -> bool:
    """Tell whether it is a mesh of scikit-fem."""
    return is_a(mesh, "skfem", "Mesh")


def convert(mesh: object) -> GivenMesh:
    """Return the corners of the cells; nodes on their sides are left out, so curved sides are straight."""
    found = cast("Mesh", mesh)
    name = f"a scikit-fem {type(mesh).__name__}"
    points, cells = np.asarray(found.p), np.asarray(found.t)
    if points.shape[0] != 2 or not is_a(mesh, "skfem", "Mesh2D"):
        raise AdapterError(f"{name} has cells that are neither triangles nor quadrilaterals of the plane")
    return given_cells(points.T, [(_CELLS[len(cells)], cells.T)], name)
