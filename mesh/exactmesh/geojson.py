"""GeoJSON, as text or as the dictionary that it stands for, to and from rings, lines and points."""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import chain

import numpy as np

from exactkernel.arrays import finite_points
from exactkernel.batch import orient2d_batch
from exactkernel.types import FloatArray
from exactmesh.errors import ExactMeshError, GeometryError
from exactmesh.rings import Piece, Shape

__all__ = ["geojson_of", "pieces_of_geojson"]

_DEEPEST = 60  # collections within collections
_LONGEST_PATH = 4096
_NUMBERS = {int, float}


def pieces_of_geojson(source: str | bytes | Mapping[str, object]) -> list[Piece]:
    """Return the rings, lines and points of a GeoJSON object in their order; properties are not geometry.

    Raises:
        GeometryError: no JSON, no GeoJSON, or positions of other than two finite numbers; it says where.
    """
    return list(_of_object(_parsed(source) if isinstance(source, str | bytes) else source, "", 0))


def _refuse(constant: str) -> float:
    raise GeometryError(f"is no GeoJSON: {constant} is no number")


def _parsed(text: str | bytes) -> object:
    try:
        return json.loads(text, parse_constant=_refuse)
    except RecursionError:
        raise GeometryError("is no GeoJSON: nested too deeply") from None
    except UnicodeDecodeError as error:
        raise GeometryError(f"is no GeoJSON: not UTF-8 text at byte {error.start}") from None
    except ExactMeshError:
        raise
    except ValueError as error:  # JSONDecodeError, or an integer of thousands of digits
        raise GeometryError(f"is no JSON: {error}{_hint(text)}") from None


def _hint(text: str | bytes) -> str:
    words = text.decode(errors="replace") if isinstance(text, bytes) else text
    is_a_path = len(words) < _LONGEST_PATH and words.rstrip().endswith((".geojson", ".json"))
    return "; files are for exactmesh.io.read_pslg" if is_a_path else ""


def _of_object(value: object, where: str, depth: int) -> Iterator[Piece]:
    if not isinstance(value, Mapping):
        raise GeometryError(f"{where or 'GeoJSON'} is {_shown(value)}, not an object")
    if depth > _DEEPEST:
        raise GeometryError(f"{where}: nested too deeply")
    kind = value.get("type")
    if not isinstance(kind, str):  # arrays do not compare as one thing does
        raise GeometryError(f"{where}type is {_shown(kind)}, no type of GeoJSON")
    if kind in _READERS:
        yield from _READERS[kind](_member(value, "coordinates", where), f"{where}coordinates")
    elif kind == "Feature":
        geometry = value.get("geometry")
        if geometry is not None:  # a feature without a place is allowed
            yield from _of_object(geometry, f"{where}geometry.", depth + 1)
    elif kind in ("FeatureCollection", "GeometryCollection"):
        name = "features" if kind == "FeatureCollection" else "geometries"
        for i, member in enumerate(_list(_member(value, name, where), where + name)):
            yield from _of_object(member, f"{where}{name}[{i}].", depth + 1)
    else:
        raise GeometryError(f"{where}type is {_shown(kind)}, no type of GeoJSON")


def _member(value: Mapping[object, object], name: str, where: str) -> object:
    if name not in value:
        raise GeometryError(f"{where}{name} is missing")
    return value[name]


def _list(value: object, where: str) -> Sequence[object]:
    if not isinstance(value, list | tuple):
        raise GeometryError(f"{where} is {_shown(value)}, not an array")
    return value


def _shown(value: object) -> str:
    try:
        text = repr(value)
    except (RecursionError, ValueError):
        return "nothing that can be shown"
    return text if len(text) <= 40 else text[:40] + "..."


def _positions(value: object, where: str) -> FloatArray:
    """Return positions as points; any fault is looked for one by one."""
    rows = _list(value, where)
    for i, row in enumerate(rows):
        if not isinstance(row, list | tuple) or len(row) != 2:
            if isinstance(row, list | tuple) and len(row) == 3:
                raise GeometryError(f"{where}[{i}] has a third coordinate; meshes are planar: take it out")
            raise GeometryError(f"{where}[{i}] is {_shown(row)}, not a position of two numbers")
    if not set(map(type, chain.from_iterable(rows))) <= _NUMBERS:  # type: ignore[arg-type]  # lists, as seen above
        i = next(i for i, row in enumerate(rows) if not set(map(type, row)) <= _NUMBERS)  # type: ignore[call-overload]
        raise GeometryError(f"{where}[{i}] is {_shown(rows[i])}, not a position of two numbers")
    return finite_points(rows, where)  # type: ignore[arg-type]  # of numbers


def _point(value: object, where: str) -> Iterator[Piece]:
    if _list(value, where):
        yield Piece(Shape.POINTS, _positions([value], where))


def _points(value: object, where: str) -> Iterator[Piece]:
    yield Piece(Shape.POINTS, _positions(value, where))


def _line(value: object, where: str) -> Iterator[Piece]:
    positions = _positions(value, where)
    if len(positions) == 1:
        raise GeometryError(f"{where}: a line needs two positions")
    yield Piece(Shape.LINE, positions)


def _polygon(value: object, where: str) -> Iterator[Piece]:
    for i, ring in enumerate(_list(value, where)):
        yield Piece(Shape.RING, _positions(ring, f"{where}[{i}]"))


def _many(read: Callable[[object, str], Iterator[Piece]]) -> Callable[[object, str], Iterator[Piece]]:
    def read_all(value: object, where: str) -> Iterator[Piece]:
        for i, member in enumerate(_list(value, where)):
            yield from read(member, f"{where}[{i}]")

    return read_all


_READERS: dict[str, Callable[[object, str], Iterator[Piece]]] = {
    "Point": _point,
    "MultiPoint": _points,
    "LineString": _line,
    "MultiLineString": _many(_line),
    "Polygon": _polygon,
    "MultiPolygon": _many(_polygon),
}


def geojson_of(rings: Sequence[FloatArray], points: FloatArray) -> str:
    """Return rings as the text of a Polygon or MultiPolygon, by even-odd nesting, and points beside them.

    Each number reads back as the same double.
    """
    polygons = [[_closed(rings[i]) for i in group] for group in _nested(rings)]
    shapes: list[dict[str, object]] = []
    if len(polygons) == 1:
        shapes.append({"type": "Polygon", "coordinates": polygons[0]})
    elif polygons:
        shapes.append({"type": "MultiPolygon", "coordinates": polygons})
    if len(points):
        shapes.append({"type": "MultiPoint", "coordinates": points.tolist()})
    return json.dumps(shapes[0] if len(shapes) == 1 else {"type": "GeometryCollection", "geometries": shapes})


def _closed(ring: FloatArray) -> list[list[float]]:
    positions: list[list[float]] = ring.tolist()
    return [*positions, positions[0]]


def _nested(rings: Sequence[FloatArray]) -> list[list[int]]:
    """Group rings into polygons, an outer ring and its holes: a ring inside of an even number of others is outer."""
    if not rings:
        return []
    low, high = np.array([ring.min(axis=0) for ring in rings]), np.array([ring.max(axis=0) for ring in rings])
    around = []
    for i, ring in enumerate(rings):
        near = np.flatnonzero(((low <= low[i]) & (high >= high[i])).all(axis=1))
        around.append([int(k) for k in near if k != i and _is_within(ring, rings[int(k)])])
    depth = [len(others) for others in around]
    groups = {i: [i] for i in range(len(rings)) if depth[i] % 2 == 0}
    for i, others in enumerate(around):
        if depth[i] % 2:
            parents = [k for k in others if depth[k] == depth[i] - 1]
            groups.setdefault(parents[0] if parents else i, []).append(i)
    return list(groups.values())


def _is_within(ring: FloatArray, other: FloatArray) -> bool:
    """Tell whether the first vertex of the ring that is not on the other ring is inside of that."""
    a, b = other, np.roll(other, -1, axis=0)
    for vertex in ring:
        side = orient2d_batch(a, b, vertex)
        beside = (np.minimum(a, b) <= vertex).all(axis=1) & (np.maximum(a, b) >= vertex).all(axis=1)
        if (beside & (side == 0)).any():
            continue
        up, down = (a[:, 1] <= vertex[1]) & (vertex[1] < b[:, 1]), (b[:, 1] <= vertex[1]) & (vertex[1] < a[:, 1])
        return bool(np.count_nonzero(up & (side > 0)) + np.count_nonzero(down & (side < 0)) & 1)
    return False
