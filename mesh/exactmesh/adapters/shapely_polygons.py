"""Collections of shapely's polygons, each a triangle or a quadrilateral."""

import sys
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, cast

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray
from exactmesh.adapters.given import GivenMesh, is_a
from exactmesh.errors import AdapterError
from exactmesh.verify.properties import ADMISSIBLE_MESH, Orientation

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

__all__ = ["WORDS", "accepts", "convert"]

WORDS = "shapely's GeometryCollection, MultiPolygon, lists and arrays of Polygons (triangles, quadrilaterals)"

_SIDES = (3, 4)


def _is_geometry(value: object) -> bool:
    return is_a(value, "shapely", "Geometry")


def accepts(mesh: object) -> bool:
    """Tell whether it is a geometry, or a list, tuple or array that begins with one."""
    if _is_geometry(mesh):
        return True
    if isinstance(mesh, np.ndarray):
        return mesh.dtype == object and mesh.ndim == 1 and mesh.size > 0 and _is_geometry(mesh[0])
    return isinstance(mesh, list | tuple) and len(mesh) > 0 and _is_geometry(mesh[0])


def convert(mesh: object) -> GivenMesh:
    """Return the polygons: vertices at exactly the same position are one, rings may run either way. Triangles count
    before quadrilaterals, each kind in its order. O(n log n)."""
    polygons = _polygons(mesh)
    shapely: Any = sys.modules["shapely"]
    sides = shapely.get_num_coordinates(polygons) - 1  # the first vertex is there again, and there are no holes
    _require_cells(polygons, sides, shapely)
    coordinates: FloatArray = shapely.get_coordinates(polygons)
    first = np.cumsum(sides + 1) - (sides + 1)
    parts = [first[sides == k][:, None] + np.arange(k) for k in _SIDES]
    points, numbers = _merged(np.concatenate([coordinates[part.ravel()] for part in parts]))
    m = 3 * len(parts[0])
    return GivenMesh(
        points,
        numbers[:m].reshape(-1, 3),
        numbers[m:].reshape(-1, 4),
        orientation=Orientation.ANY,
        claims=ADMISSIBLE_MESH,
        source="shapely polygons",
    )


def _polygons(mesh: object) -> npt.NDArray[np.object_]:
    """Return the parts of geometries, those of collections within collections, too."""
    shapely: Any = sys.modules["shapely"]
    several = [mesh] if _is_geometry(mesh) else list(cast("Iterable[BaseGeometry]", mesh))
    parts = np.empty(len(several), dtype=object)
    parts[:] = several
    odd = np.flatnonzero(~shapely.is_geometry(parts))
    if odd.size:
        kind = type(several[odd[0]]).__name__
        raise AdapterError(f"geometry {odd[0]} is a {kind}, no shapely geometry", indices=odd.tolist())
    while (shapely.get_type_id(parts) > shapely.GeometryType.POLYGON).any():  # collections, of collections perhaps
        try:
            parts = shapely.get_parts(parts)
        except NotImplementedError:  # GEOS knows curves, shapely cannot hand them out
            raise AdapterError("a collection of geometries holds one that is curved") from None
    return parts


def _require_cells(polygons: npt.NDArray[np.object_], sides: npt.NDArray[np.int64], shapely: Any) -> None:
    """Refuse what is no triangle or quadrilateral of the plane."""
    is_polygon = shapely.get_type_id(polygons) == shapely.GeometryType.POLYGON
    tests = (
        (~is_polygon, "is no polygon"),
        (is_polygon & (shapely.get_num_interior_rings(polygons) > 0), "has a hole"),
        (is_polygon & ~np.isin(sides, _SIDES), "is neither a triangle nor a quadrilateral"),
        (shapely.has_z(polygons), "has a third coordinate: see shapely.force_2d"),
    )
    for bad, fault in tests:
        rows = np.flatnonzero(bad)
        if rows.size:
            i = int(rows[0])
            kind = shapely.GeometryType(shapely.get_type_id(polygons[i])).name
            count = f" of {sides[i]} sides" if is_polygon[i] else ""
            raise AdapterError(f"geometry {i}, a {kind.capitalize()}{count}, {fault}", indices=rows.tolist())


def _merged(positions: FloatArray) -> tuple[FloatArray, npt.NDArray[np.intp]]:
    """Return the distinct positions in the order in which they occur first, and the number of each. O(n log n)."""
    order = np.lexsort((positions[:, 1], positions[:, 0]))  # stable: equal ones in their order
    ranked = positions[order]
    begins = np.ones(len(order), dtype=np.bool_)
    begins[1:] = (ranked[1:] != ranked[:-1]).any(axis=1)
    first = np.empty(len(order), dtype=np.intp)
    first[order] = order[begins][np.cumsum(begins) - 1]
    kept = first == np.arange(len(order))
    return positions[kept], (np.cumsum(kept) - 1)[first]
