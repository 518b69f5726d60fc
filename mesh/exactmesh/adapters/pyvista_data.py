"""pyvista's datasets: PolyData, UnstructuredGrid and whatever casts to one."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, cast

from exactmesh.adapters.given import GivenMesh, is_a
from exactmesh.adapters.meshio_mesh import given_cells

if TYPE_CHECKING:
    from pyvista import DataSet

__all__ = ["WORDS", "accepts", "convert"]

WORDS = "pyvista's PolyData and UnstructuredGrid"

#: meshio's names of VTK's types of cells.
_NAMES = {
    1: "vertex",
    3: "line",
    5: "triangle",
    8: "pixel",
    9: "quad",
    21: "line3",
    22: "triangle6",
    23: "quad8",
    28: "quad9",
    34: "triangle7",
}


def accepts(mesh: object) -> bool:
    """Tell whether it is a pyvista dataset."""
    return is_a(mesh, "pyvista", "DataSet")


def convert(mesh: object) -> GivenMesh:
    """Return triangles and quadrilaterals, and lines as segments; see the adapter of meshio."""
    grid = cast("DataSet", mesh).cast_to_unstructured_grid()

    def blocks() -> Iterator[tuple[str, object]]:
        for kind, rows in grid.cells_dict.items():
            yield _NAMES.get(int(kind), f"VTK {int(kind)}"), rows

    return given_cells(grid.points, blocks(), f"a pyvista {type(mesh).__name__}")
