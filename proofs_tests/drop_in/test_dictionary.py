"""Dictionaries in and out: the keys, shapes and types of the ``triangle`` package, and what stands under each key."""

import json
import warnings
from fractions import Fraction
from itertools import pairwise

import numpy as np
import numpy.typing as npt
import pytest
from proofs_tests.drop_in.inputs import COURSE, CROSSING, HALVES, INPUTS, MARKED, OUTSIDE, SQUARE, TWICE, UNUSED, calls
from proofs_tests.drop_in.record_contract import RECORD, contract, told

from exactmesh import ChoiceError, ExactMeshError, NonFiniteError, PSLGError, ShapeError, TopologyError, verify
from exactmesh.triangle import (
    TriangleDict,
    TriangleWarning,
    convex_hull,
    delaunay,
    from_meshpy,
    from_triunsuitable,
    get_data,
    triangulate,
    voronoi,
)

pytestmark = pytest.mark.once


CALLS = calls()
CONTRACT: dict[str, dict[str, str]] = json.loads(RECORD.read_text(encoding="utf-8"))
CASES = [(name, o) for name, by_switches in CONTRACT.items() for o in by_switches]


def quiet(content: object, switches: str, **options: object) -> TriangleDict:
    """Triangulate, and let warnings be."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", TriangleWarning)
        return triangulate(content, switches, **options)  # type: ignore[arg-type]  # whatever a test gives


def area(points: npt.NDArray[np.float64], corners: list[int]) -> Fraction:
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(x) for x in points[v].tolist()] for v in corners)
    return ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2


@pytest.mark.obligation(
    "T1",
    "keys, their order, types and shapes are those that the package returned, for every switch",
    method="differential",
)
class TestContract:
    """For every switch, the keys, their order, the types and the shapes are those that the package returned."""

    @pytest.mark.parametrize(("name", "switches"), CASES)
    def test_as_recorded(self, name: str, switches: str) -> None:
        found = quiet(INPUTS[name], switches)
        arrays = {key: np.asarray(array) for key, array in found.items()}
        assert told(arrays, switches in CALLS[name][1]) == CONTRACT[name][switches]
        assert all(array.flags.owndata and array.flags.writeable for array in arrays.values())

    def test_control_other_shapes_are_told_apart(self) -> None:
        """Another type, another shape, another order of keys."""
        found = {key: np.asarray(array) for key, array in quiet(SQUARE, "e").items()}
        expected = CONTRACT["square"]["e"]
        for key, other in (("edges", found["edges"].astype(np.int64)), ("edge_markers", np.zeros((5, 2), np.int32))):
            assert told({**found, key: other}, False) != expected
        assert told(dict(reversed(found.items())), False) != expected

    def test_the_record_is_the_package(self) -> None:
        pytest.importorskip("triangle")
        assert contract() == CONTRACT


class TestVertices:
    """Vertices that are given come first, all of them, in their order; with j, those in use."""

    @pytest.mark.parametrize(
        ("name", "switches"), [case for case in CASES if "N" not in case[1] and "j" not in case[1]]
    )
    def test_first(self, name: str, switches: str) -> None:
        given = np.array(INPUTS[name]["vertices"], dtype=np.float64)
        assert np.array_equal(quiet(INPUTS[name], switches)["vertices"][: len(given)], given)

    def test_jettison(self) -> None:
        assert quiet(OUTSIDE, "pj")["vertices"].tolist() == [list(v) for v in COURSE["vertices"]]
        assert quiet(TWICE, "j")["vertices"].tolist() == [list(v) for v in [*SQUARE["vertices"], (2, 2)]]
        assert quiet(UNUSED, "rj")["vertices"].tolist() == [list(v) for v in UNUSED["vertices"][1:]]
        found = quiet(OUTSIDE, "p")  # control: without it, they stay, and no triangle uses them
        assert len(found["vertices"]) == 7
        assert not np.isin(found["triangles"], [5, 6]).any()

    @pytest.mark.parametrize("switches", ["pc", "pca0.3", "pcq30", "o2", "pco2a0.3"])
    def test_attributes_are_interpolated(self, switches: str) -> None:
        """An attribute that is x + y at the given vertices is x + y at the new ones."""
        content = {**CROSSING} if "p" in switches else {k: v for k, v in CROSSING.items() if k != "segments"}
        found = quiet(content, switches)
        assert len(found["vertices"]) > 5
        assert np.allclose(found["vertex_attributes"][:, 0], found["vertices"].sum(axis=1), rtol=1e-12)

    def test_markers(self) -> None:
        """A vertex's own marker, else that of a segment through it, else 1 on the boundary, else 0."""
        found = quiet(COURSE, "pa0.1")
        assert found["vertex_markers"][:5].ravel().tolist() == [1, 1, 2, 3, 0]
        half = found["vertices"].tolist().index([0.5, 0.0])
        assert found["vertex_markers"][half].tolist() == [1]
        own = {**COURSE, "vertex_markers": [(0,), (-9,), (0,), (0,), (6,)]}
        assert quiet(own, "p")["vertex_markers"].ravel().tolist() == [1, -9, 2, 3, 6]
        assert quiet({**own, "vertex_markers": [0, -9, 0, 0, 6]}, "p")["vertex_markers"].shape == (5, 1)


class TestSixNodes:
    """With o2 nodes 4 to 6 are the middles of the edges opposite the corners 1 to 3; a middle is there once."""

    @pytest.mark.parametrize("name", INPUTS)
    def test_middles(self, name: str) -> None:
        found = quiet(INPUTS[name], "o2e")
        points, nodes = found["vertices"], found["triangles"]
        for i in range(3):
            a, b = nodes[:, (i + 1) % 3], nodes[:, (i + 2) % 3]
            assert np.array_equal(points[nodes[:, 3 + i]], (points[a] + points[b]) / 2)
            assert not np.array_equal(points[nodes[:, 3 + (i + 1) % 3]], (points[a] + points[b]) / 2)  # control
        assert len(np.unique(nodes[:, 3:])) == len(found["edges"])

    def test_refined_again(self) -> None:
        """Middles are no vertices of the mesh: to refine it, its corners are taken."""
        six = quiet(SQUARE, "o2")
        assert quiet(six, "r")["vertices"].tolist() == [list(v) for v in SQUARE["vertices"]]
        assert quiet(six, "ro2")["triangles"].tolist() == six["triangles"].tolist()


class TestMeshes:
    """What comes out is what the switches say: a triangulation of the domain, bounds kept, segments there."""

    @pytest.mark.parametrize("name", ["A", "box", "double_hex3", "face", "polygon"])
    @pytest.mark.parametrize("switches", ["p", "pa0.02", "pq25", "pD", "pqD", "pc"])
    def test_valid(self, name: str, switches: str) -> None:
        content = get_data(name)
        found = quiet(content, switches + "jC")  # C has the verifier look at it
        claims = ["orientation", "admissible", "all_points_used", "segments_present", "constrained_delaunay"]
        report = verify(found["vertices"], found["triangles"], segments=found["segments"], claims=claims)
        assert report.ok, str(report)
        turned = found["triangles"].copy()
        turned[0] = turned[0, ::-1]
        assert not verify(found["vertices"], turned, segments=found["segments"], claims=claims).ok  # control

    @pytest.mark.parametrize("bound", ["0.3", "0.05"])
    def test_areas(self, bound: str) -> None:
        for content, switches in ((SQUARE, "a"), (COURSE, "pa"), (HALVES, "pqa"), (MARKED, "rpa")):
            found = quiet(content, switches + bound)
            areas = [area(found["vertices"], corners) for corners in found["triangles"].tolist()]
            assert min(areas) > 0
            assert max(areas) <= Fraction(float(bound))
        plain = quiet(SQUARE, "")  # control
        assert area(plain["vertices"], plain["triangles"][0].tolist()) > 1

    def test_areas_of_regions(self) -> None:
        """a alone bounds each region by its own area; with A, triangles have its attribute."""
        found = quiet(HALVES, "pAa")
        areas = [area(found["vertices"], corners) for corners in found["triangles"].tolist()]
        left = found["triangle_attributes"][:, 0] == 7.0
        centres = found["vertices"][found["triangles"]].mean(axis=1)
        assert np.array_equal(left, centres[:, 0] < 2.0)
        assert max(a for a, is_left in zip(areas, left, strict=True) if is_left) <= Fraction(1, 2)
        assert max(a for a, is_left in zip(areas, left, strict=True) if not is_left) > Fraction(1, 2)
        both = quiet(HALVES, "pAaa0.8")
        assert max(area(both["vertices"], corners) for corners in both["triangles"].tolist()) <= Fraction(4, 5)
        assert len(quiet(HALVES, "pA")["triangles"]) == 9  # control: without a, areas of regions bound nothing

    def test_areas_of_triangles(self) -> None:
        """ra refines each triangle to its own area, and hands its attributes on."""
        found = quiet(MARKED, "ra")
        points, corners = found["vertices"], found["triangles"]
        below = points[corners].mean(axis=1) @ np.array([1.0, -1.0]) > 0
        small = [area(points, t) for t, is_below in zip(corners.tolist(), below.tolist(), strict=True) if is_below]
        assert max(small) <= 1
        assert len(quiet({**MARKED, "triangle_max_area": [(-1,), (0,)]}, "ra")["triangles"]) == 2
        assert np.array_equal(found["triangle_attributes"][:, 0], np.where(below, 3.0, 4.0))

    def test_steiner_points(self) -> None:
        """S bounds how many there are, Y keeps them off the boundary, YY off all segments."""
        for n in (0, 1, 5):
            assert len(quiet(get_data("A"), f"pqa0.001S{n}")["vertices"]) == 11 + n
        assert len(quiet(get_data("A"), "pqa0.001S")["vertices"]) == 11
        boundary = quiet(HALVES, "pqa0.1Y")
        assert (boundary["segment_markers"] == 1).sum() == 9
        assert len(boundary["segments"]) > 10
        assert len(quiet(HALVES, "pqa0.1YY")["segments"]) == 10
        assert (quiet(HALVES, "pqa0.1")["segment_markers"] == 1).sum() > 9  # control

    def test_holes_are_ignored(self) -> None:
        assert len(quiet(HALVES, "pO")["triangles"]) == len(quiet(HALVES, "p")["triangles"]) + 1

    def test_given_triangles_stay(self) -> None:
        other = {**SQUARE, "triangles": [(0, 1, 3), (1, 2, 3)]}
        assert quiet(other, "r")["triangles"].tolist() == [[0, 1, 3], [1, 2, 3]]
        kite = {"vertices": [(0, 0), (4, 0), (5, 3), (0, 1)], "triangles": [(0, 1, 2), (0, 2, 3)]}
        assert quiet(kite, "r")["triangles"].tolist() == [[0, 1, 2], [0, 2, 3]]  # not Delaunay, but as it is
        refined = quiet(kite, "ra100")["triangles"].tolist()
        assert sorted(map(sorted, refined)) == [[0, 1, 3], [1, 2, 3]]

    def test_refined_again_and_again(self) -> None:
        """What comes out can go in: with r it is refined further, holes stay holes."""
        meshes = [quiet(get_data("A"), "pq")]
        for bound in ("0.01", "0.005", "0.002"):
            meshes.append(quiet(meshes[-1], "rpqC" + "a" + bound))
        for coarse, fine in pairwise(meshes):
            assert len(coarse["vertices"]) < len(fine["vertices"])
            assert np.array_equal(fine["vertices"][: len(coarse["vertices"])], coarse["vertices"])
            total = sum(area(fine["vertices"], t) for t in fine["triangles"].tolist())
            assert abs(total - Fraction(sum(area(coarse["vertices"], t) for t in coarse["triangles"].tolist()))) < 1e-15


class TestCallbacks:
    """u asks a function, of whole arrays, or of one triangle after the other as Triangle and meshpy do."""

    def test_conventions_agree(self) -> None:
        def large(corners: npt.NDArray[np.float64], areas: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
            found: npt.NDArray[np.bool_] = areas > 0.01 + corners[:, :, 0].mean(axis=1) / 10.0
            return found

        by_corners = from_triunsuitable(lambda a, b, c, size: size > 0.01 + (a[0] + b[0] + c[0]) / 3.0 / 10.0)
        by_list = from_meshpy(lambda corners, size: size > 0.01 + sum(x for x, _ in corners) / 3.0 / 10.0)
        meshes = [quiet(COURSE, "pu", unsuitable=function) for function in (large, by_corners, by_list)]
        assert len(meshes[0]["vertices"]) > 10
        assert all(np.array_equal(mesh["vertices"], meshes[0]["vertices"]) for mesh in meshes)

    def test_nobody_asks_without_the_switch(self) -> None:
        with pytest.warns(TriangleWarning, match="write u"):
            found = triangulate(COURSE, "pa0.3", unsuitable=lambda _corners, areas: areas > 0)
        assert len(found["vertices"]) == 5

    def test_what_it_raises_comes_through(self) -> None:
        def broken(_corners: object, _areas: object) -> bool:
            raise RuntimeError("mine")

        with pytest.raises(RuntimeError, match="mine"):
            quiet(COURSE, "pu", unsuitable=broken)
        with pytest.raises(ShapeError):
            quiet(COURSE, "pu", unsuitable=lambda _corners, _areas: True)


class TestFunctions:
    """delaunay, convex_hull and voronoi return plain arrays about the points as they were given."""

    def test_delaunay(self) -> None:
        points = np.array(TWICE["vertices"])
        triangles = delaunay(points)
        assert triangles.dtype == np.int32
        assert verify(points[:4].tolist() + points[5:].tolist(), np.where(triangles == 5, 4, triangles)).ok

    def test_convex_hull(self) -> None:
        points = [(0, 0), (0, 1), (0.5, 0.5), (1, 1), (1, 0), (0, 0.5)]
        assert convex_hull(points).tolist() == [[4, 0], [3, 4], [1, 3], [5, 1], [0, 5]]

    def test_voronoi(self) -> None:
        points = [(0, 0), (0, 1), (0.5, 0.5), (1, 1), (1, 0)]
        centres, edges, origins, directions = voronoi(points)
        assert sorted(centres.tolist()) == [[0, 0.5], [0.5, 0], [0.5, 1], [1, 0.5]]
        assert sorted(sorted(centres[e].tolist()) for e in edges) == [
            [[0, 0.5], [0.5, 0]], [[0, 0.5], [0.5, 1]], [[0.5, 0], [1, 0.5]], [[0.5, 1], [1, 0.5]],
        ]  # fmt: skip
        away = centres[origins] - 0.5
        assert np.array_equal(np.sign(away), directions)
        assert origins.dtype == np.int32
        assert directions.shape == (4, 2)


BAD: list[tuple[dict[str, object], str, type[ExactMeshError], str]] = [
    ({}, "", ChoiceError, "'vertices'"),
    ({**SQUARE, "foo": [1]}, "", ChoiceError, "'foo'"),
    ({"vertices": [(0, 0, 0)]}, "", ShapeError, "vertices"),
    ({"vertices": [0, 1, 2]}, "", ShapeError, "vertices"),
    ({"vertices": [(0, 0), (1,)]}, "", ShapeError, "vertices"),
    ({"vertices": "nonsense"}, "", ExactMeshError, "vertices"),
    ({**SQUARE, "vertex_markers": [1, 2]}, "", ShapeError, "vertex_markers"),
    ({**SQUARE, "vertex_markers": [1.5, 2, 3, 4]}, "", ShapeError, "vertex_markers"),
    ({**SQUARE, "vertex_markers": [1, 2, 3, 1 << 40]}, "", ShapeError, "32 bits"),
    ({**SQUARE, "vertex_attributes": [[1.0, 2.0]]}, "", ShapeError, "vertex_attributes"),
    ({**SQUARE, "vertex_attributes": [1, 2, 3, float("nan")]}, "", NonFiniteError, "vertex_attributes"),
    ({**SQUARE, "segments": [(0, 1, 2)]}, "p", ShapeError, "segments"),
    ({**SQUARE, "segments": [(0, 1)], "segment_markers": [1, 2]}, "p", ShapeError, "segment_markers"),
    ({**SQUARE, "holes": [(1, float("inf"))]}, "p", NonFiniteError, "holes"),
    ({**SQUARE, "regions": [(1, 2)]}, "p", ShapeError, "regions"),
    ({**SQUARE, "triangles": [(0, 1)]}, "r", ShapeError, "triangles"),
    ({**SQUARE, "triangles": [(0, 1, 7)]}, "r", TopologyError, "triangles[0]"),
    ({**SQUARE, "triangles": [(0, 1, 2)], "triangle_max_area": [1, 2]}, "ra", ShapeError, "triangle_max_area"),
    ({**SQUARE, "triangles": [(0, 1, 2)], "triangle_max_area": [[float("nan")]]}, "ra", ShapeError, "NaN"),
    ({**SQUARE, "segments": [(0, 1)]}, "p", PSLGError, "the switch c"),
]


class TestBadDictionaries:
    """What is wrong with a dictionary is said by its key."""

    @pytest.mark.parametrize(("content", "switches", "error", "named"), BAD)
    def test_named(self, content: dict[str, object], switches: str, error: type[ExactMeshError], named: str) -> None:
        with pytest.raises(error) as caught:
            triangulate(content, switches)
        assert named in str(caught.value)

    def test_what_is_harmless_passes(self) -> None:
        empty = {**SQUARE, "segments": [], "holes": np.zeros((0, 2)), "regions": None, "vertex_markers": []}
        assert quiet(empty, "").keys() == quiet(SQUARE, "").keys()
        floats = {**COURSE, "segments": np.array(COURSE["segments"], dtype=np.float64)}
        assert np.array_equal(quiet(floats, "p")["segments"], quiet(COURSE, "p")["segments"])
