"""GeoJSON, certificates, switches, and Python on the command line."""

import json
import os
from collections.abc import Sequence

import numpy as np
from proofs_tests.fuzzing.cursor import Cursor
from proofs_tests.fuzzing.judging import Target, require
from proofs_tests.fuzzing.places import clean, names_its_file
from proofs_tests.fuzzing.sameness import same

from exactmesh import PSLG
from exactmesh.conformance.inputs import given_input
from exactmesh.conformance.laws import Task
from exactmesh.errors import ExactMeshError, FileFormatError, GeometryError, PSLGError
from exactmesh.io import read_pslg
from exactmesh.triangle import Switch, parse
from exactmesh.verify import check_certificate, read_certificate, verify

__all__ = ["TARGETS"]

_POINTS, _TRIANGLES = [(0.0, 0.0), (3.0, 0.0), (3.0, 2.0), (0.0, 2.0)], [(0, 1, 2), (0, 2, 3)]
_KINDS = (
    *("Point", "MultiPoint", "LineString", "MultiLineString", "Polygon", "MultiPolygon", "Feature"),
    *("FeatureCollection", "GeometryCollection", "", "polygon"),
)


def _sorted_rows(pslg: PSLG) -> object:
    return pslg.points[np.lexsort((np.signbit(pslg.points[:, 1]), pslg.points[:, 1], pslg.points[:, 0]))]


def _written_again(pslg: PSLG) -> None:
    """What GeoJSON can hold of a graph is read again: the same places, as many segments, the same rule."""
    try:
        text = pslg.to_geojson()
    except (GeometryError, PSLGError):
        return
    again = PSLG.from_geojson(text)
    require(same(_sorted_rows(pslg), _sorted_rows(again)), f"the points of {text} are read again as others")
    require(len(pslg.segments) == len(again.segments), f"{text} is read again with {len(again.segments)} segments")
    require(pslg.rule == again.rule or not len(pslg.segments), "the rule is another one")


def _geojson(data: bytes) -> None:
    path = clean(geojson=data).with_suffix(".geojson")
    try:
        pslg = read_pslg(path)
    except (FileFormatError, PSLGError) as error:
        names_its_file(error)
        raise
    require(PSLG.from_geojson(data) == pslg, "text and file differ")
    _written_again(pslg)


def _features(data: bytes) -> None:
    _written_again(PSLG.from_geojson(_object(Cursor(data), 0)))


def _object(cursor: Cursor, depth: int) -> dict[str, object]:
    """Return a dictionary much like GeoJSON, with anything at all in some places."""
    kind = cursor.count(len(_KINDS))
    if kind == len(_KINDS):
        return {"type": cursor.thing()}
    name = _KINDS[kind]
    if name == "Feature":
        return {"type": name, "geometry": _object(cursor, depth + 1) if depth < 3 else cursor.thing()}
    if name.endswith("Collection"):
        members = [_object(cursor, depth + 1) for _ in range(cursor.count(3))] if depth < 3 else cursor.thing()
        return {"type": name, "features" if name[0] == "F" else "geometries": members}
    return {"type": name, "coordinates": _nested(cursor, cursor.count(4))}


def _nested(cursor: Cursor, depth: int) -> object:
    form = cursor.byte()
    if form >= 240:
        return cursor.thing()
    if depth == 0:
        return cursor.number()
    length = cursor.count(5) if depth > 1 else (3 if form > 200 else 2)
    return [_nested(cursor, depth - 1) for _ in range(length)]


def _geojson_seeds() -> Sequence[bytes]:
    ring = PSLG.from_rings([[(0, 0), (9, 0), (0.1, 9)], [(1, 1), (2, 1), (1, 2)]]).to_geojson()
    point = {"type": "Point", "coordinates": [1, 2.5]}
    line = {"type": "Feature", "properties": None, "geometry": {"type": "LineString", "coordinates": [[0, 0], [1, 1]]}}
    several = {"type": "GeometryCollection", "geometries": [json.loads(ring), point]}
    made = [point, line, {"type": "FeatureCollection", "features": [line]}, several]
    return [ring.encode(), *(json.dumps(one).encode() for one in made)]


def _certificate(data: bytes) -> None:
    read = read_certificate(data)
    repr((read.ok, read.mesh, read.given, read.rule, read.bounds, read.claims, read.answers()))
    require(read_certificate(json.dumps(read.document)).document == read.document, "it is read again as another one")
    for again in (False, True):
        check_certificate(read, _POINTS, _TRIANGLES, again=again)


def _certificate_seeds() -> Sequence[bytes]:
    reports = [
        verify(_POINTS, _TRIANGLES),
        verify(_POINTS, _TRIANGLES, claims=["admissible"], min_angle=10, max_area=4),
        verify(_POINTS, [(0, 1, 2), (0, 1, 3)]),
    ]
    return [report.to_json().encode() for report in reports]


def _switches(data: bytes) -> None:
    text = data.decode("latin-1")
    switches = parse(text)
    require(parse(str(switches)) == switches, f"{text!r} is {str(switches)!r}, which means something else")
    require(str(parse(str(switches))) == str(switches), f"{str(switches)!r} is not canonical")
    list(switches.notes())


def _literal(data: bytes) -> None:
    text = data.decode("utf-8", errors="surrogateescape")
    try:
        there = os.path.exists(text)
    except ValueError:
        there = False
    if there or (text.startswith("corpus:") and len(text) > 20):
        return
    for task in Task:
        try:
            given = given_input(text, task)[0]
        except ExactMeshError:
            continue
        again = given_input(given.literal, task)[0]
        require(same(given.points, again.points), "its points are read again as others")
        require(same(given.segments, again.segments), "its segments are read again as others")


_LITERALS = (
    b"[(0, 0), (1, 0), (0, 1)]",
    b"([(0, 0), (1, 0.5), (0, 1)], [(0, 1), (1, 2)])",
    b"corpus:1",
    b"[(-1e308, 5e-324)]",
)
_JSON_WORDS = (
    *(b'{"type": "', b'"coordinates": [', b"[[0, 0], [1, 0], [0, 1], [0, 0]]", b"null", b"true", b"1e999", b"-0.0"),
    *(
        b"NaN",
        b"Infinity",
        b'"features": [',
        b'"geometry": ',
        b'"geometries": [',
        b"\\ud800",
        b"]}",
        *(k.encode() for k in _KINDS),
    ),
)
TARGETS = (
    Target("geojson", _geojson, _geojson_seeds, _JSON_WORDS),
    Target("features", _features, lambda: [bytes([k, 4, 0, 3, *range(90, 120)]) for k in range(len(_KINDS) + 1)]),
    Target(
        "certificate",
        _certificate,
        _certificate_seeds,
        (b'"verdict": "holds"', b'"claims": [', b"null", b"true", b"false", b"1e400"),
    ),
    Target(
        "switches",
        _switches,
        lambda: [b"pq30a0.1e", b"-pa", b"rqS100YYo2", b"pDLs", b"q", b"pA"],
        tuple(s.encode() for s in Switch),
    ),
    Target(
        "literal",
        _literal,
        lambda: _LITERALS,
        (b"(0, 0), ", b"[", b"]", b"(", b")", b"1e400", b"0x10", b"b''", b"{", b"None"),
    ),
)
