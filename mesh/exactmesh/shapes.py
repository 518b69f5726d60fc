"""shapely's geometries, to and from rings, lines and points; shapely is the extra of that name."""

from collections.abc import Iterable, Iterator
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points
from exactkernel.batch import orient2d_batch
from exactkernel.types import FloatArray, IntArray
from exactmesh.errors import ExactMeshError, GeometryError
from exactmesh.rings import Piece, Shape

if TYPE_CHECKING:
    from shapely import MultiPolygon, Polygon
    from shapely.geometry.base import BaseGeometry

__all__ = ["ShapelyUnavailableError", "domain_of", "pieces_of_shapely"]


class ShapelyUnavailableError(ExactMeshError, ImportError):
    """shapely, which its own geometries come from, is not installed."""


def _shapely() -> ModuleType:
    try:
        import shapely
    except ImportError:
        raise ShapelyUnavailableError(
            "this needs shapely, which is not installed: pip install 'exactmesh[shapely]'"
        ) from None
    module: ModuleType = shapely
    return module


def pieces_of_shapely(geometry: "BaseGeometry | Iterable[BaseGeometry]") -> list[Piece]:
    """Return the rings, lines and points of one geometry or of several, in their order.

    Raises:
        GeometryError: something else, a third coordinate, a number that is not finite.
        ShapelyUnavailableError: shapely is not installed.
    """
    shapely = _shapely()
    if isinstance(geometry, shapely.Geometry):
        return list(_of_geometry(geometry, "geometry"))
    try:
        parts = list(geometry)
    except TypeError:
        raise GeometryError(f"{type(geometry).__name__} is no shapely geometry, nor several of them") from None
    for i, part in enumerate(parts):
        if not isinstance(part, shapely.Geometry):
            raise GeometryError(f"geometry[{i}] is {type(part).__name__}, no shapely geometry")
    return [piece for i, part in enumerate(parts) for piece in _of_geometry(part, f"geometry[{i}]")]


def _of_geometry(geometry: "BaseGeometry", where: str) -> Iterator[Piece]:
    kind = geometry.geom_type
    if kind in ("MultiPolygon", "MultiLineString", "MultiPoint", "GeometryCollection"):
        for i in range(len(geometry.geoms)):
            yield from _of_geometry(_part(geometry, i, where), f"{where}.geoms[{i}]")
    elif geometry.has_z:
        raise GeometryError(f"{where} has a third coordinate; meshes are planar: see shapely.force_2d")
    elif geometry.is_empty:
        return
    elif kind == "Polygon":
        for ring in (geometry.exterior, *geometry.interiors):
            yield Piece(Shape.RING, _positions(ring, where))
    elif kind in ("LinearRing", "LineString", "Point"):
        shape = {"LinearRing": Shape.RING, "LineString": Shape.LINE, "Point": Shape.POINTS}[kind]
        yield Piece(shape, _positions(geometry, where))
    else:
        raise GeometryError(f"{where} is a {kind}, which no straight lines make")


def _part(geometry: "BaseGeometry", i: int, where: str) -> "BaseGeometry":
    try:
        part: BaseGeometry = geometry.geoms[i]
    except NotImplementedError:  # GEOS knows curves, shapely cannot hand them out
        raise GeometryError(f"{where}.geoms[{i}] is curved, and no straight lines make it") from None
    return part


def _positions(geometry: "BaseGeometry", where: str) -> FloatArray:
    return finite_points(_shapely().get_coordinates(geometry), where)


def domain_of(points: FloatArray, segments: IntArray, holes: FloatArray, *, even_odd: bool) -> "Polygon | MultiPolygon":
    """Return the faces of the segments that are the domain, united by shapely.

    Raises:
        GeometryError: the segments cross, and shapely fails at that.
        ShapelyUnavailableError: shapely is not installed.
    """
    shapely = _shapely()
    if not len(segments):
        return shapely.Polygon()
    lines = shapely.linestrings(points[segments])
    try:
        faces = shapely.get_parts(shapely.polygonize([shapely.union_all(lines)]))
    except shapely.GEOSException as error:
        raise GeometryError(f"shapely cannot make faces of the segments: {error}") from None
    kept = np.ones(len(faces), dtype=np.bool_)
    for x, y in holes.tolist():
        kept &= ~shapely.contains_xy(faces, x, y)
    if even_odd:
        places = shapely.get_coordinates(shapely.point_on_surface(faces))
        rays = np.stack([places, np.column_stack([np.full(len(places), points[:, 0].max()), places[:, 1]])], axis=1)
        face, segment = shapely.STRtree(lines).query(shapely.linestrings(rays))
        crossed = _is_crossed(points[segments[segment, 0]], points[segments[segment, 1]], places[face])
        kept &= np.bincount(face[crossed], minlength=len(faces)) % 2 == 1
    return shapely.union_all(faces[kept])


def _is_crossed(a: FloatArray, b: FloatArray, places: FloatArray) -> npt.NDArray[np.bool_]:
    """Tell which rays to the right of places, which are on no segment, cross the segments a b."""
    upward = np.where(a[:, 1] < b[:, 1], 1, -1)
    straddles = (a[:, 1] <= places[:, 1]) != (b[:, 1] <= places[:, 1])
    crossed: npt.NDArray[np.bool_] = straddles & (orient2d_batch(a, b, places) * upward > 0)
    return crossed
