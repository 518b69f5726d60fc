"""Meshes of anybody: the verifier, the adapters, and the dictionaries of ``exactmesh.triangle``."""

import itertools
from collections.abc import Callable
from types import SimpleNamespace
from typing import cast

import numpy as np
from proofs_tests.fuzzing.cursor import Cursor, table_bytes
from proofs_tests.fuzzing.judging import Target, require

from exactmesh.adapters import given_mesh
from exactmesh.errors import ExactMeshError
from exactmesh.io import Mesh
from exactmesh.triangle import Switch, parse, triangulate
from exactmesh.triangle.dictionary import KEYS
from exactmesh.verify import Property, check_certificate, verify

__all__ = ["TARGETS"]

_STEINER = 10
_CLAIMS = tuple(Property)
_SQUARE, _HALVES = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)], [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]


def _bounds(cursor: Cursor, flags: int) -> dict[str, object]:
    names = ("min_angle", "max_angle", "max_area", "size", "within")
    return {name: cursor.number() for bit, name in enumerate(names) if flags >> bit & 1}


def _verify(data: bytes) -> None:
    """Whatever is given, there is a report, and its certificate is that of what was given."""
    cursor = Cursor(data)
    flags, more = cursor.byte(), cursor.byte()
    points, triangles = cursor.table(2, 9, integers=False), cursor.table(3, 10, integers=True)
    given: dict[str, object] = {}
    if flags & 1:
        given["quads"] = cursor.table(4, 4, integers=True)
    if flags & 2:
        given["segments"] = cursor.table(2, 6, integers=True)
    if flags & 4:
        given["labels"] = cursor.table(1, 10, integers=False)
    asked = _bounds(cursor, more)
    if flags & 8:
        asked["claims"] = [_CLAIMS[cursor.count(len(_CLAIMS) - 1)] for _ in range(cursor.count(4))]
    if flags & 16:
        asked["orientation"] = ("ccw", "cw", "any", "either", "left")[cursor.count(4)]
    report = verify(points, triangles, **given, **asked)  # type: ignore[call-overload]  # of anything
    require(str(report), "a report without words")
    if isinstance(asked.get("size"), float) or isinstance(asked.get("max_area"), float):
        return  # arrays by now, which a certificate holds as hashes
    check = check_certificate(report.to_json(), points, triangles, again=True, **given)  # type: ignore[arg-type]
    require(check, f"its own certificate is not that of the mesh: {check.differences}")


def _verify_seeds() -> list[bytes]:
    mesh = table_bytes(_SQUARE, integers=False) + table_bytes(_HALVES, integers=True)
    quad = (
        table_bytes(_SQUARE[:4], integers=False)
        + table_bytes([], integers=True)
        + table_bytes([(0, 1, 2, 3)], integers=True)
    )
    segments, labels = (
        table_bytes([(0, 1), (1, 2)], integers=True),
        table_bytes([(1,), (1,), (1,), (1,)], integers=False),
    )
    bound = bytes([96 + 30])
    return [
        b"\0\0" + mesh,
        b"\1\0" + quad,
        b"\2\1" + mesh + segments + bound,
        b"\6\0" + mesh + segments + labels,
        b"\x08\0" + mesh + b"\x02\x05\x09",
        b"\x10\4" + mesh + bound + b"\x02",
    ]


def _dictionary(data: bytes) -> None:
    """What ``triangulate`` takes it answers, and takes its own answer."""
    cursor = Cursor(data)
    switches = cursor.text(12)
    asked = parse(switches)
    if asked.refines and asked.max_steiner is None:
        switches += f" S{_STEINER}"
    elif asked.refines and (asked.max_steiner or 0) > _STEINER:
        return  # whoever asks for a large mesh waits for it
    content = {key: _column(cursor, key) for key in _chosen(cursor)}
    found = triangulate(content, switches)
    require(set(found) <= set(KEYS), f"unknown keys {sorted(found)}")
    if "triangles" in found and "vertices" in found and not asked.asks(Switch.QUADRATIC):
        corners, points = found["triangles"], found["vertices"]
        require(verify(points, corners, claims=["orientation"]).ok, "a triangle that is not counterclockwise")
        if not asked.asks(Switch.ATTRIBUTES):
            triangulate(dict(found), "Q")


_WIDTHS = {"vertices": 2, "triangles": 3, "segments": 2, "holes": 2, "regions": 4, "neighbors": 3, "edges": 2}
_INTEGERS = ("triangles", "segments", "neighbors", "edges", "vertex_markers", "segment_markers", "edge_markers")


def _chosen(cursor: Cursor) -> list[str]:
    mask = cursor.byte() | cursor.byte() << 8
    return [key for bit, key in enumerate(KEYS) if mask >> bit & 1] + (["vertex"] if mask >> 15 else [])


def _column(cursor: Cursor, key: str) -> object:
    return cursor.table(_WIDTHS.get(key, 1), 10, integers=key in _INTEGERS)


def dictionary_bytes(switches: str, **content: object) -> bytes:
    """Return bytes that stand for a dictionary and switches."""
    mask = sum(1 << bit for bit, key in enumerate(KEYS) if key in content)
    tables = [table_bytes(content[key], integers=key in _INTEGERS) for key in KEYS if key in content]  # type: ignore[arg-type]
    return bytes([len(switches)]) + switches.encode() + bytes([mask & 255, mask >> 8]) + b"".join(tables)


def _dictionary_seeds() -> list[bytes]:
    box, ring = _SQUARE[:4], [(0, 1), (1, 2), (2, 3), (3, 0)]
    return [
        dictionary_bytes("", vertices=box),
        dictionary_bytes("pq", vertices=box, segments=ring),
        dictionary_bytes("pqaA", vertices=box, segments=ring, regions=[(1, 1, 5, 1)]),
        dictionary_bytes(
            "pen", vertices=_SQUARE, segments=ring, holes=[(1, 1)], vertex_markers=[[1], [2], [3], [4], [5]]
        ),
        dictionary_bytes("ra", vertices=_SQUARE, triangles=_HALVES, triangle_max_area=[[1], [1], [0], [1]]),
        dictionary_bytes("cD", vertices=_SQUARE, vertex_attributes=[[1], [2], [3], [4], [5]]),
    ]


def _plain(cursor: Cursor) -> object:
    return cursor.table(2, 9, integers=False), cursor.table(3 + (cursor.byte() > 128), 9, integers=True)


def _named(cursor: Cursor) -> object:
    names = ("points", "triangles", "quads")
    return SimpleNamespace(
        **{
            name: cursor.table(width, 9, integers=name != "points")
            for name, width in zip(names, (2, 3, 4), strict=True)
            if cursor.byte() < 200
        }
    )


def _mapping(cursor: Cursor) -> object:
    return {key: _column(cursor, key) for key in _chosen(cursor)}


def _own(cursor: Cursor) -> object:
    keys = ("triangles", "segments", "holes", "regions", "neighbors", "edges", "triangle_attributes")
    chosen = [key for key in keys if cursor.byte() & 1]
    points = cursor.table(2, 9, integers=False)
    return Mesh(points, **{key: _column(cursor, key) for key in chosen})  # type: ignore[arg-type]


def _of_matplotlib(cursor: Cursor) -> object:
    from matplotlib.tri import Triangulation

    points, corners = cursor.numbers(cursor.count(9), 2), cursor.indices(cursor.count(9), 3)
    masked = cursor.byte()
    try:
        made = Triangulation(points[:, 0], points[:, 1], corners)
        if masked & 1:
            made.set_mask([masked >> 1 & 1, *[0] * (len(corners) - 1)])
    except Exception as error:  # whatever matplotlib refuses is none
        raise ExactMeshError(f"no Triangulation: {error}") from None
    return made


def _of_meshio(cursor: Cursor) -> object:
    import meshio

    kinds = ("triangle", "quad", "line", "vertex", "triangle6", "pixel", "polygon", "tetra", "quad9", "what")
    points = cursor.table(2 + (cursor.byte() > 128), 9, integers=False)
    blocks = [(kinds[cursor.count(9)], cursor.table(3, 6, integers=True)) for _ in range(cursor.count(3))]
    try:
        return meshio.Mesh(points, blocks)
    except Exception as error:  # whatever meshio refuses is none
        raise ExactMeshError(f"no meshio.Mesh: {error}") from None


def _anything(cursor: Cursor) -> object:
    return cursor.thing()


_MAKERS: tuple[Callable[[Cursor], object], ...] = (
    *(_plain, _named, _mapping, _own, _of_matplotlib, _of_meshio, _anything),
)


def _objects(data: bytes) -> None:
    """An object is taken for a mesh, or refused; as a mesh it has a report."""
    cursor = Cursor(data)
    made = _MAKERS[cursor.count(len(_MAKERS) - 1)](cursor)
    if isinstance(made, str):
        return  # a path
    given = given_mesh(made)
    require(given.points.ndim == 2 and given.points.dtype == np.float64, "points that are none")
    require(str(verify(made)), "a report without words")


def _object_seeds() -> list[bytes]:
    points, cells = table_bytes(_SQUARE, integers=False), table_bytes(_HALVES, integers=True)
    plain, mask = b"\0" + points + b"\0" + cells, (1 << KEYS.index("vertices") | 1 << KEYS.index("triangles"))
    named = b"\1\0" + points + b"\0" + cells + b"\xff"
    own = b"\3\1" + b"\0" * 6 + points + cells
    bare = points[1:] + cells[1:] + b"\3"
    return [
        plain,
        named,
        b"\2" + bytes([mask & 255, mask >> 8]) + points + cells,
        own,
        b"\4" + bare,
        b"\5\0" + points + b"\1\0" + cells,
    ]


def _shapes(data: bytes) -> None:
    """Geometries of shapely, from their bytes, as domains and as meshes."""
    import shapely

    from exactmesh import PSLG

    try:
        geometry = shapely.from_wkb(data)
    except Exception as error:  # whatever shapely refuses is none
        raise ExactMeshError(f"no geometry: {error}") from None
    attempts: list[Callable[[object], object]] = [
        lambda it: PSLG.from_shapely(cast("shapely.Geometry", it)),
        lambda it: str(verify(it)),
    ]
    refused = []
    for attempt in attempts:
        try:
            attempt(geometry)
        except ExactMeshError as error:
            refused.append(error)
            require(str(error), "an error without words")


def _shape_seeds() -> list[bytes]:
    import shapely

    corners = [shapely.Polygon([_SQUARE[v] for v in t]) for t in _HALVES]
    holed = shapely.box(0, 0, 9, 9).difference(shapely.box(2, 2, 3, 3))
    more = [
        shapely.Point(1, 2),
        shapely.LineString([(0, 0), (1, 1)]),
        shapely.Polygon([(0, 0, 1), (1, 0, 1), (0, 1, 1)]),
    ]
    single = [shapely.GeometryCollection(corners), shapely.MultiPolygon(corners[:1]), holed, *more]
    return [shapely.to_wkb(shape) for shape in itertools.chain(single, [shapely.Polygon()])]


TARGETS = (
    Target("verify", _verify, _verify_seeds),
    Target("dictionary", _dictionary, _dictionary_seeds, tuple(s.encode() for s in Switch)),
    Target("objects", _objects, _object_seeds),
    Target("shapes", _shapes, _shape_seeds),
)
