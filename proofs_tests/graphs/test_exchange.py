"""Rings, GeoJSON and shapely's geometries become PSLGs and come back, number by number; what is lost is said."""

import dataclasses
import itertools
import json
import sys
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import numpy.typing as npt
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from exactmesh import (
    PSLG,
    Carve,
    ExactMeshError,
    FaultKind,
    GeometryError,
    NonFiniteError,
    PSLGError,
    ShapeError,
    constrained_delaunay,
    verify,
)  # fmt: skip
from exactmesh import geojson as geojson_module

pytestmark = pytest.mark.once


Point = tuple[float, float]
Ring = list[Point]
numbers = st.floats(allow_nan=False, allow_infinity=False)
positions = st.tuples(numbers, numbers)
SQUARE: Ring = [(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)]


def bits(array: npt.NDArray[np.generic]) -> bytes:
    return np.ascontiguousarray(array).tobytes()


rings_of_positions = st.lists(positions, min_size=3, max_size=7, unique=True)
many_rings = st.lists(rings_of_positions, max_size=4)


@pytest.mark.obligation("P3", "rings, GeoJSON and shapely come back from a PSLG bit for bit", method="property-based")
class TestRoundTrip:
    """Rings are the rings of their PSLG, and a PSLG of rings is that of its GeoJSON and of its shapely rings."""

    @given(many_rings, st.booleans(), st.data())
    def test_rings(self, rings: list[Ring], repeat_the_first: bool, data: st.DataObject) -> None:
        markers = data.draw(st.lists(st.integers(-9, 9), min_size=len(rings), max_size=len(rings)))
        given_rings = [ring + ring[:1] for ring in rings] if repeat_the_first else rings
        pslg = PSLG.from_rings(given_rings, markers=markers)
        assert pslg.rule is Carve.EVEN_ODD
        assert [bits(ring) for ring in pslg.rings()] == [bits(np.array(ring)) for ring in rings]
        assert pslg.segment_markers is not None
        assert pslg.segment_markers.tolist() == [m for m, ring in zip(markers, rings, strict=True) for _ in ring]

    @given(many_rings, st.lists(positions, max_size=3))
    def test_geojson(self, rings: list[Ring], lonely: list[Point]) -> None:
        shapes: list[dict[str, object]] = [{"type": "Polygon", "coordinates": [r + r[:1]]} for r in rings]
        shapes.append({"type": "MultiPoint", "coordinates": lonely})
        pslg = PSLG.from_geojson({"type": "GeometryCollection", "geometries": shapes})
        again = PSLG.from_geojson(pslg.to_geojson())
        assert sorted(map(bits, again.rings())) == sorted(bits(np.array(r)) for r in rings)
        assert bits(again.points[len(again.points) - len(lonely) :]) == bits(np.array(lonely).reshape(-1, 2))
        assert again.to_geojson() == PSLG.from_geojson(again.to_geojson()).to_geojson()

    @given(many_rings)
    def test_shapely(self, rings: list[Ring]) -> None:
        pslg = PSLG.from_shapely(shapely.LinearRing(ring) for ring in rings)
        assert pslg == PSLG.from_rings(rings)
        assert bits(pslg.points) == bits(PSLG.from_rings(rings).points)

    def test_control_lost_digits_are_caught(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Coordinates rounded to fifteen places."""
        pslg = PSLG.from_rings([[(0.1 + 0.2, 0.0), (1 / 3, 1.0), (0.0, 1.0)]])
        assert PSLG.from_geojson(pslg.to_geojson()) == pslg
        monkeypatch.setattr(geojson_module, "_closed", lambda ring: np.round([*ring, ring[0]], 15).tolist())
        assert PSLG.from_geojson(pslg.to_geojson()) != pslg

    def test_nothing(self) -> None:
        nothing = PSLG.from_rings([])
        assert nothing.rings() == []
        assert PSLG.from_geojson(nothing.to_geojson()) == nothing
        assert nothing.to_shapely().is_empty
        assert PSLG.from_shapely(shapely.Polygon()) == nothing


class TestKindsOfGeometry:
    """Every type of GeoJSON and of shapely is read: rings are closed, lines are not unless their ends meet."""

    cases: tuple[tuple[str, list[Point], list[tuple[int, int]]], ...] = (
        ("POINT (1 2)", [(1, 2)], []),
        ("MULTIPOINT (1 2, 3 4, 1 2)", [(1, 2), (3, 4), (1, 2)], []),
        ("LINESTRING (0 0, 1 0, 1 1)", [(0, 0), (1, 0), (1, 1)], [(0, 1), (1, 2)]),
        ("LINESTRING (0 0, 1 0, 1 1, 0 0)", [(0, 0), (1, 0), (1, 1)], [(0, 1), (1, 2), (2, 0)]),
        ("LINESTRING (0 0, 1 0, 0 0)", [(0, 0), (1, 0), (0, 0)], [(0, 1), (1, 2)]),
        ("LINESTRING (0 0, 0 0)", [(0, 0), (0, 0)], []),
        ("MULTILINESTRING ((0 0, 1 0), (5 5, 6 6))", [(0, 0), (1, 0), (5, 5), (6, 6)], [(0, 1), (2, 3)]),
        ("POLYGON ((0 0, 1 0, 0 1, 0 0))", [(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2), (2, 0)]),
        (
            "POLYGON ((0 0, 0 0, 1 0, 1 0, 0 1, 0 0, 0 0))",
            [(0, 0), (0, 0), (1, 0), (1, 0), (0, 1), (0, 0)],
            [(0, 2), (2, 4), (4, 0)],
        ),
        (
            "GEOMETRYCOLLECTION (POINT (7 7), MULTIPOLYGON (((0 0, 1 0, 0 1, 0 0))))",
            [(7, 7), (0, 0), (1, 0), (0, 1)],
            [(1, 2), (2, 3), (3, 1)],
        ),
        ("GEOMETRYCOLLECTION EMPTY", [], []),
        ("POINT EMPTY", [], []),
    )

    @pytest.mark.parametrize(("wkt", "points", "segments"), cases, ids=[case[0][:24] for case in cases])
    def test_as_shapely_and_as_geojson(self, wkt: str, points: list[Point], segments: list[tuple[int, int]]) -> None:
        geometry = shapely.from_wkt(wkt)
        text = shapely.to_geojson(geometry)
        feature = {"type": "Feature", "properties": {"name": "a"}, "geometry": json.loads(text)}
        collection = {"type": "FeatureCollection", "features": [feature, {"type": "Feature", "geometry": None}]}
        rule = "seeds" if "LINE" in wkt else "even-odd"
        expected = PSLG(np.array(points, dtype=np.float64).reshape(-1, 2), segments, rule=rule)
        for read in (
            PSLG.from_shapely(geometry),
            PSLG.from_shapely([geometry]),
            PSLG.from_geojson(text),
            PSLG.from_geojson(text.encode()),
            PSLG.from_geojson(feature),
            PSLG.from_geojson(collection),
        ):
            assert read == expected


@pytest.mark.obligation("P3", "a line beside polygons separates nothing", method="named cases")
class TestLinesBesidePolygons:
    """A line separates nothing: beside polygons, the domain is theirs, and the line is edges where it is inside."""

    polygon = shapely.Polygon(SQUARE, [[(2, 2), (4, 2), (4, 4), (2, 4)]])
    lines = (
        shapely.LineString([(5.0, 5.0), (8.0, 5.0), (8.0, 8.0)]),
        shapely.LineString([(6.0, 1.0), (8.0, 1.0), (8.0, 3.0), (6.0, 1.0)]),
        shapely.LineString([(4.0, 4.0), (9.0, 9.0)]),
        shapely.LineString([(0.0, 0.0), (9.0, 0.0)]),
        shapely.LineString([(1.0, 1.0), (20.0, 1.0)]),
    )

    @pytest.mark.parametrize("line", lines, ids=["open", "closed", "a bridge", "on a side", "through a side"])
    def test_domain_and_segments(self, line: shapely.LineString) -> None:
        pslg = PSLG.from_shapely([self.polygon, line])
        assert pslg.rule is Carve.EVEN_ODD
        assert pslg == PSLG.from_geojson(shapely.to_geojson(shapely.GeometryCollection([self.polygon, line])))
        assert pslg.to_shapely().area == 81 - 4
        mesh = constrained_delaunay(pslg, crossings="split")
        assert verify(mesh.points, mesh.triangles, domain=mesh.domain).ok
        assert mesh.statistics().area == 81 - 4
        kept = shapely.union_all(shapely.linestrings(mesh.points[mesh.segments]))
        assert kept.covers(line.intersection(self.polygon))

    def test_control_a_line_given_once_has_no_parity(self) -> None:
        """A line given once: its sides have no parity."""
        pslg = PSLG.from_shapely([self.polygon, self.lines[0]])
        once = PSLG(pslg.points, pslg.segments[:-2], rule="even-odd")
        with pytest.raises(PSLGError, match="an odd number"):
            constrained_delaunay(once)

    def test_control_a_closed_line_given_once_would_be_a_hole(self) -> None:
        """A closed line given once: it is a hole."""
        pslg = PSLG.from_shapely([self.polygon, self.lines[1]])
        once = PSLG(pslg.points, pslg.segments[:-3], rule="even-odd")
        assert once.to_shapely().area == 81 - 4 - 2

    def test_lines_alone_are_carved_by_seeds(self) -> None:
        pslg = PSLG.from_shapely(self.lines[:2])
        assert (pslg.rule, len(pslg.segments), len(pslg.duplicates)) == (Carve.SEEDS, 5, 0)


class TestWhatIsRefused:
    """Geometry that is none, or not planar, raises a typed error of one line that says where."""

    @pytest.mark.parametrize(
        ("source", "error", "words"),
        [
            ("{", GeometryError, "is no JSON: .*line 1"),
            ("folder/x.geojson", GeometryError, "is no JSON: .*; files are for exactmesh.io.read_pslg"),
            (b"\xff\xfe{", GeometryError, "is no"),
            ("[" * 100_000, GeometryError, "nested too deeply"),
            ("[]", GeometryError, r"GeoJSON is \[\], not an object"),
            ("null", GeometryError, "GeoJSON is None"),
            ('{"type": "Circle"}', GeometryError, "type is 'Circle'"),
            ('{"type": ["Point"]}', GeometryError, "no type of GeoJSON"),
            ('{"type": "Point"}', GeometryError, "coordinates is missing"),
            ('{"type": "Point", "coordinates": 1}', GeometryError, "coordinates is 1, not an array"),
            ('{"type": "Point", "coordinates": [1]}', GeometryError, r"coordinates\[0\] is \[1\]"),
            ('{"type": "Point", "coordinates": [1, 2, 3]}', GeometryError, "third coordinate"),
            ('{"type": "Point", "coordinates": [1, true]}', GeometryError, "True"),
            ('{"type": "Point", "coordinates": [1, "2"]}', GeometryError, "'2'"),
            ('{"type": "Point", "coordinates": [1, null]}', GeometryError, "None"),
            ('{"type": "Point", "coordinates": [1, [2]]}', GeometryError, r"\[2\]"),
            ('{"type": "Point", "coordinates": [1, NaN]}', GeometryError, "NaN"),
            ('{"type": "Point", "coordinates": [1, -Infinity]}', GeometryError, "Infinity"),
            ('{"type": "Point", "coordinates": [1, 1e999]}', NonFiniteError, "inf"),
            ('{"type": "Point", "coordinates": [1, 9007199254740993]}', ExactMeshError, "rounded"),
            ('{"type": "Point", "coordinates": [1, ' + "9" * 5000 + "]}", ExactMeshError, "digits"),
            ('{"type": "LineString", "coordinates": [[1, 2]]}', GeometryError, "two positions"),
            ('{"type": "MultiPolygon", "coordinates": [[[[0, 0], [1, 0, 5]]]]}', GeometryError, r"\[0\]\[0\]\[1\] has"),
            ('{"type": "FeatureCollection", "features": [{"type": "Feature", "geometry": 5}]}', GeometryError, "is 5"),
            ('{"type": "GeometryCollection", "geometries": {}}', GeometryError, "not an array"),
            ('{"type":"Feature","geometry":' * 80 + "null" + "}" * 80, GeometryError, "too deeply"),
        ],
    )
    def test_geojson(self, source: str | bytes, error: type[ExactMeshError], words: str) -> None:
        with pytest.raises(error, match=words) as caught:
            PSLG.from_geojson(source)
        assert "\n" not in str(caught.value)

    def test_control_the_same_without_the_fault(self) -> None:
        assert len(PSLG.from_geojson('{"type": "Point", "coordinates": [1, 2]}').points) == 1

    def test_short_rings(self) -> None:
        """All of them are named, those of collections by their number among the rings."""
        with pytest.raises(PSLGError, match="ring 1 has fewer than three distinct vertices") as caught:
            PSLG.from_rings([SQUARE, [(0, 0), (1, 1), (0, 0), (1, 1)], SQUARE, np.zeros((0, 2)), [(0, 0)] * 5])
        assert [(f.kind, f.indices) for f in caught.value.faults] == [
            (FaultKind.RING_TOO_SHORT, (1,)),
            (FaultKind.RING_TOO_SHORT, (3,)),
            (FaultKind.RING_TOO_SHORT, (4,)),
        ]
        with pytest.raises(PSLGError, match="ring 0"):
            PSLG.from_geojson('{"type": "Polygon", "coordinates": [[[0, 0], [1, 1], [0, 0]]]}')

    def test_arrays(self) -> None:
        with pytest.raises(ShapeError, match=r"rings\[1\] has shape"):
            PSLG.from_rings([SQUARE, [(0, 0, 0)]])
        with pytest.raises(NonFiniteError, match=r"rings\[0\]\[1\]"):
            PSLG.from_rings([[(0, 0), (0, np.nan), (1, 1)]])
        with pytest.raises(ShapeError, match="markers has 1 rows for 2 rings"):
            PSLG.from_rings([SQUARE, SQUARE], markers=[1])
        with pytest.raises(ShapeError, match=r"^markers has shape"):
            PSLG.from_rings([SQUARE], markers=7)

    @pytest.mark.parametrize(
        ("geometry", "words"),
        [
            (shapely.Point(1, 2, 3), "third coordinate"),
            ([shapely.Point(1, 2), "POINT (1 2)"], r"geometry\[1\] is str"),
            (5, "int is no shapely geometry"),
            (shapely.MultiPolygon([shapely.Polygon([(0, 0, 1), (1, 0, 1), (0, 1, 1)])]), r"geometry.geoms\[0\] has a"),
        ],
    )
    def test_shapely(self, geometry: object, words: str) -> None:
        with pytest.raises(GeometryError, match=words):
            PSLG.from_shapely(geometry)

    def test_without_shapely(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setitem(sys.modules, "shapely", None)
        calls: list[Callable[[], object]] = [lambda: PSLG.from_shapely([]), PSLG.from_rings([SQUARE]).to_shapely]
        for call in calls:
            with pytest.raises(ImportError, match=r"pip install 'exactmesh\[shapely\]'") as caught:
                call()
            assert isinstance(caught.value, ExactMeshError)

    @pytest.mark.parametrize(
        ("change", "words"),
        [
            ({"rule": "seeds"}, "the rule of seeds"),
            ({"holes": [(1, 1)]}, "no place for holes"),
            ({"regions": [(1, 1, 2)], "point_markers": [1] * 4}, "regions, point_markers"),
            ({"segment_markers": [1] * 4}, "segment_markers"),
            ({"point_attributes": [[1]] * 4}, "point_attributes"),
        ],
    )
    def test_what_geojson_cannot_hold(self, change: dict[str, object], words: str) -> None:
        pslg = dataclasses.replace(PSLG.from_rings([SQUARE]), **change)  # type: ignore[arg-type]  # a table of objects
        with pytest.raises(GeometryError, match=words):
            pslg.to_geojson()

    def test_segments_that_are_no_rings(self) -> None:
        pslg = PSLG(SQUARE, [(0, 1), (1, 2), (2, 0), (2, 3)], rule="even-odd")
        calls: list[Callable[[], object]] = [pslg.rings, pslg.to_geojson]
        for call in calls:
            with pytest.raises(
                PSLGError, match="point 2 is the end of 3 segments, point 3 is the end of 1 seg"
            ) as error:
                call()
            assert [(f.kind, f.indices) for f in error.value.faults] == [
                (FaultKind.NOT_A_RING, (2,)),
                (FaultKind.NOT_A_RING, (3,)),
            ]


def square(x: float, y: float, side: float) -> Ring:
    return [(x, y), (x + side, y), (x + side, y + side), (x, y + side)]


def area_by_parity(rings: list[Ring], holes: list[Point]) -> Fraction:
    """Of unit cells at integer positions: those in an odd number of the (axis-parallel) squares, holes' faces aside."""
    boxes = [(min(ring), max(ring)) for ring in rings]

    def cover(x: float, y: float) -> tuple[bool, ...]:
        return tuple(low[0] < x < high[0] and low[1] < y < high[1] for low, high in boxes)

    cells = [(x + 0.5, y + 0.5) for x, y in itertools.product(range(-1, 20), repeat=2)]
    carved = {cover(*hole) for hole in holes}  # faces of nested squares are told apart by the squares around them
    return Fraction(sum(sum(cover(*cell)) % 2 == 1 and cover(*cell) not in carved for cell in cells))


@pytest.mark.obligation(
    "P3", "GeoJSON nests rings, and shapely's polygon is the domain, by counting rings", method="property-based"
)
class TestDomains:
    """GeoJSON nests rings, and shapely's polygon is the domain, as counting rings around unit cells has it."""

    families = (
        [square(0, 0, 9)],
        [square(0, 0, 9), square(1, 1, 2), square(4, 4, 3)],
        [square(1, 1, 2), square(0, 0, 9), square(2, 5, 1), square(11, 0, 4)],
        [square(0, 0, 12), square(1, 1, 9), square(2, 2, 6), square(3, 3, 2)],
        [square(0, 0, 5), square(5, 0, 5)],
        [square(0, 0, 9), square(0, 0, 9), square(2, 2, 3)],
        [square(0, 0, 9), square(0, 0, 4)],
    )

    @pytest.mark.parametrize("rings", families)
    @pytest.mark.parametrize("order", [1, -1])
    def test_areas(self, rings: list[Ring], order: int) -> None:
        rings = [ring[::order] for ring in rings[::order]]
        pslg = PSLG.from_rings(rings)
        expected = area_by_parity(rings, [])
        assert Fraction(pslg.to_shapely().area) == expected
        read_back = PSLG.from_geojson(pslg.to_geojson())
        assert Fraction(read_back.to_shapely().area) == expected
        if len(set(map(tuple, rings))) == len(rings) and rings not in ([square(0, 0, 9)[::order]],):
            polygons = shapely.get_parts(shapely.from_geojson(pslg.to_geojson()))
            assert Fraction(sum(polygon.area for polygon in polygons)) == expected

    def test_holes_by_seeds(self) -> None:
        rings = [square(0, 0, 9), square(1, 1, 2), square(4, 4, 3)]
        pslg = PSLG(np.concatenate(rings), PSLG.from_rings(rings).segments, holes=[(2, 2.5)])
        assert pslg.to_shapely().area == 81 - 4
        assert dataclasses.replace(pslg, rule=Carve.EVEN_ODD, holes=np.array([(8.0, 8.0)])).to_shapely().is_empty
        assert pslg.to_shapely().equals(shapely.Polygon(rings[0], [rings[1]]))

    def test_vertices_are_those_of_the_pslg(self) -> None:
        rings = [[(0.1, 0.2), (1 / 3, 0.7), (0.0, 0.9)], [(2.1, 0.2), (2.3, 0.7), (2.0, 0.9)]]
        domain = PSLG.from_rings(rings).to_shapely()
        assert set(map(tuple, shapely.get_coordinates(domain))) == set(itertools.chain(*rings))

    def test_control_a_domain_without_nesting_is_caught(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Rings that are never within others."""
        rings = [square(0, 0, 9), square(1, 1, 2)]
        monkeypatch.setattr(geojson_module, "_is_within", lambda *_: False)
        polygons = shapely.get_parts(shapely.from_geojson(PSLG.from_rings(rings).to_geojson()))
        assert Fraction(sum(polygon.area for polygon in polygons)) != area_by_parity(rings, [])


def json_values() -> st.SearchStrategy[object]:
    """Anything that JSON can hold, with the words of GeoJSON among its keys and values."""
    words = st.sampled_from(["Point", "LineString", "Polygon", "MultiPolygon", "Feature", "FeatureCollection", "x"])
    leaves = st.none() | st.booleans() | st.integers(-(2**60), 2**60) | st.floats() | words
    keys = st.sampled_from(["type", "coordinates", "geometry", "geometries", "features", "bbox"])
    return st.recursive(leaves, lambda inner: st.lists(inner, max_size=4) | st.dictionaries(keys, inner, max_size=3))


@pytest.mark.obligation("P5", "whatever the GeoJSON, a graph or a typed error comes of it", method="property-based")
class TestFuzz:
    """Whatever the text or the object, the outcome is a PSLG or an ExactMeshError."""

    good = (
        '{"type": "Feature", "geometry": {"type": "MultiPolygon", '
        '"coordinates": [[[[0, 0], [4, 0], [0, 4.5], [0, 0]], [[1, 1], [2, 1], [1, 2], [1, 1]]]]}}'
    )

    @staticmethod
    def survives(source: object) -> bool:
        try:
            PSLG.from_geojson(source)  # type: ignore[arg-type]  # anything
        except ExactMeshError:
            return True
        return False

    @given(json_values())
    def test_any_object(self, value: object) -> None:
        self.survives({"type": "Polygon", "coordinates": value})
        self.survives(value)
        self.survives(json.dumps(value))

    @given(st.data())
    def test_any_mutation(self, data: st.DataObject) -> None:
        start = data.draw(st.integers(0, len(self.good)))
        cut = data.draw(st.integers(0, 6))
        insert = data.draw(st.text('0123456789.-eE[]{},:" nulltrueNaN', max_size=5))
        self.survives(self.good[:start] + insert + self.good[start + cut :])

    def test_control_another_error_would_be_noticed(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """A reader that raises a TypeError."""
        assert not self.survives(self.good)
        assert self.survives("nonsense")
        monkeypatch.setattr(geojson_module, "_positions", None)
        with pytest.raises(TypeError):
            self.survives(self.good)
