"""Which adapter an object is for."""

from collections.abc import Callable
from typing import NamedTuple

from exactmesh.adapters import (
    arrays,
    dictionary,
    files,
    matplotlib_tri,
    meshio_mesh,
    meshpy_info,
    own,
    pyvista_data,
    scipy_spatial,
    shapely_polygons,
    skfem_mesh,
)
from exactmesh.adapters.given import GivenMesh
from exactmesh.errors import AdapterError

__all__ = ["given_mesh"]


class Adapter(NamedTuple):
    """What is understood, in words; whether an object is that; and how it is converted."""

    words: str
    accepts: Callable[[object], bool]
    convert: Callable[[object], GivenMesh]


#: The first that accepts an object converts it; what is known by the names of attributes comes last.
_ADAPTERS = (
    *(Adapter(module.WORDS, module.accepts, module.convert) for module in (own, scipy_spatial, matplotlib_tri)),
    *(Adapter(module.WORDS, module.accepts, module.convert) for module in (shapely_polygons, meshio_mesh)),
    *(Adapter(module.WORDS, module.accepts, module.convert) for module in (pyvista_data, skfem_mesh, meshpy_info)),
    *(Adapter(module.WORDS, module.accepts, module.convert) for module in (files, dictionary, arrays)),
)


def given_mesh(mesh: object) -> GivenMesh:
    """Return a mesh of whatever package as arrays, with what is claimed of such a mesh by default.

    Understood are exactmesh's own triangulations, refinements and files' contents, ``scipy.spatial.Delaunay``,
    ``matplotlib.tri.Triangulation`` (without its masked triangles), collections of shapely's polygons, ``meshio.Mesh``,
    pyvista's datasets, scikit-fem's meshes, meshpy's ``MeshInfo``, paths of files, dictionaries as Triangle's,
    pairs (points, triangles), and whatever has ``points`` and ``triangles``.

    Args:
        mesh: one of these.

    Raises:
        AdapterError: something else, or cells that are no triangles or quadrilaterals of the plane.
        ShapeError, CoordinateError: arrays that are none.
        FileFormatError: a file that is missing or broken.
        MeshioUnavailableError: a file of a format that needs meshio, which is not installed.

    Linear time; O(n log n) for shapely's polygons, whose vertices are matched by position.

    >>> from exactmesh import delaunay
    >>> given_mesh(delaunay([(0, 0), (1, 0), (0, 1)]))
    GivenMesh(a Triangulation: 3 points, 1 triangles)
    """
    for adapter in _ADAPTERS:
        if adapter.accepts(mesh):
            return adapter.convert(mesh)
    known = "; ".join(adapter.words for adapter in _ADAPTERS)
    hint = " (an array of points alone has no triangles)" if hasattr(mesh, "__len__") else ""
    raise AdapterError(f"{type(mesh).__module__}.{type(mesh).__qualname__} is no mesh{hint}; understood are {known}")
