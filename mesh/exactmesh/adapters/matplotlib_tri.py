"""matplotlib.tri.Triangulation."""

from typing import TYPE_CHECKING, cast

import numpy as np

from exactkernel.arrays import exact_doubles
from exactmesh.adapters.given import GivenMesh, index_rows, is_a
from exactmesh.verify.properties import ADMISSIBLE_MESH, Orientation

if TYPE_CHECKING:
    from matplotlib.tri import Triangulation

__all__ = ["WORDS", "accepts", "convert"]

WORDS = "matplotlib.tri.Triangulation"


def accepts(mesh: object) -> bool:
    """Tell whether it is a matplotlib Triangulation."""
    return is_a(mesh, "matplotlib", "Triangulation")


def convert(mesh: object) -> GivenMesh:
    """Return the triangles that are not masked: rows count these. It is Delaunay if matplotlib made it so and nothing
    is masked; it keeps what it is given in either orientation."""
    found = cast("Triangulation", mesh)
    whole = found.mask is None or not np.any(found.mask)
    return GivenMesh(
        exact_doubles(np.column_stack([found.x, found.y])),
        index_rows(found.get_masked_triangles(), 3, "triangles"),
        orientation=Orientation.ANY,
        claims=None if found.is_delaunay and whole else ADMISSIBLE_MESH,
        source="a matplotlib Triangulation",
    )
