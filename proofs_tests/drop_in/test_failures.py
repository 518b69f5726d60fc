"""Where Triangle dies, hangs or is silently wrong: the right mesh, or an error that names the culprit.

What the ``triangle`` package (20250106) does was found out by calling it in processes of their own, and is told in the
comments; nothing of that is run here.
"""

import math
import warnings
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from proofs_tests.drop_in.inputs import COURSE, HALVES, SQUARE

from exactmesh import (
    ChoiceError,
    CollinearPointsError,
    ExactMeshError,
    FaultKind,
    FileFormatError,
    InadmissibleError,
    NonFiniteError,
    PSLGError,
    ShapeError,
    TooFewPointsError,
    verify,
)
from exactmesh.triangle import SwitchError, TriangleDict, TriangleWarning, get_data, load, triangulate

pytestmark = pytest.mark.once


CLAIMS = ("orientation", "admissible", "segments_present")


def is_right(found: TriangleDict, *claims: str) -> bool:
    """Tell whether the triangles are a triangulation with all segments in it."""
    return verify(found["vertices"], found["triangles"], segments=found["segments"], claims=(*CLAIMS, *claims)).ok


def spokes(seed: int) -> dict[str, object]:
    """Return segments that all pass through one point, up to rounding."""
    rng = np.random.default_rng(seed)
    k = int(rng.integers(3, 8))
    angles, centre = rng.random(k) * math.pi, rng.random(2)
    along = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    back, forth = rng.random((2, k, 1))
    ends = np.stack([centre - back * along, centre + forth * along], axis=1).reshape(-1, 2)
    return {"vertices": ends, "segments": np.arange(2 * k).reshape(k, 2)}


#: With ``pc`` Triangle makes two inverted triangles of these, or hangs.
SIX: dict[str, object] = {
    "vertices": [
        (-0.6616708319446925, 0.043023726210314694), (1.3283374986113592, 0.242690559503971),
        (-0.029024421143340307, -0.7891819431100835), (0.6956910878100069, 1.074896228824369),
        (0.9996093546131575, -0.6028480693195775), (-0.3329426879464908, 0.888562355033863),
    ],
    "segments": [(0, 1), (2, 3), (4, 5)],
}  # fmt: skip


@pytest.mark.obligation(
    "T3", "where Triangle fails and it is clear what is meant, here is the mesh", method="named cases"
)
class TestRightMesh:
    """What is meant is clear: here is the mesh of it."""

    @pytest.mark.parametrize("switches", ["pc", "pcq20", "pcD", "pcqa0.1"])
    def test_six_points(self, switches: str) -> None:
        found = triangulate(SIX, switches)
        assert is_right(found, *(["covers_hull"] if switches == "pc" else []))  # later, points on the hull are rounded

    def test_control_an_inverted_triangle(self) -> None:
        """An inverted triangle, as Triangle has them."""
        found = triangulate(SIX, "pc")
        wrong = found["triangles"].copy()
        wrong[0] = wrong[0, ::-1]
        assert not is_right({**found, "triangles": wrong})

    @pytest.mark.parametrize("seed", range(12))
    def test_segments_through_one_point(self, seed: int) -> None:
        """Most such calls go wrong with Triangle: errors, flat and inverted triangles, hangs; see docs/triangle.md."""
        content = spokes(seed)
        found = triangulate(content, "pc")
        assert is_right(found, "covers_hull", "constrained_delaunay")
        assert len(found["vertices"]) > len(np.asarray(content["vertices"]))
        with warnings.catch_warnings():  # edges of 1e-17 leave no room for better angles, and it says so
            warnings.simplefilter("ignore", TriangleWarning)
            assert is_right(triangulate(content, "pcq"))

    @pytest.mark.parametrize("switches", ["p", "pc", "pq", "pD"])
    def test_duplicates_with_segments(self, switches: str) -> None:
        """The interpreter dies."""
        twice = {
            **COURSE,
            "vertices": [*COURSE["vertices"], (0, 0), (0.4, 0.4)],
            "segments": [(5, 1), (1, 6), (2, 3), (3, 0)],
        }
        found, plain = triangulate(twice, switches + "j"), triangulate(COURSE, switches)
        assert is_right(found)
        assert np.array_equal(np.sort(found["vertices"], axis=0), np.sort(plain["vertices"], axis=0))
        assert len(found["triangles"]) == len(plain["triangles"])

    @pytest.mark.parametrize("scale", [2.0**-1074, 2.0**-500, 2.0**1020])
    def test_any_finite_double(self, scale: float) -> None:
        points = np.array([(0, 0), (7, 0), (3, 2), (7, 7), (0, 5), (3, 3)]) * scale
        content = {"vertices": points, "segments": [(0, 1), (1, 3), (3, 4), (4, 0)]}
        assert is_right(triangulate(content, "pC"), "constrained_delaunay")

    def test_huge_markers_of_segments_and_vertices(self) -> None:
        """Markers of 32 bits come through, negative ones too."""
        markers = [[-(2**31)], [2**31 - 1], [0], [-1]]
        found = triangulate({**COURSE, "segment_markers": markers}, "p")
        assert found["segment_markers"].tolist() == [[-(2**31)], [2**31 - 1], [1], [-1]]


@pytest.mark.obligation("T3", "what Triangle passes over is named by a warning", method="named cases")
class TestPassedOver:
    """What Triangle passes over without a word is passed over with a warning that names it."""

    def warned(self, content: Mapping[str, object], switches: str, named: str) -> TriangleDict:
        with pytest.warns(TriangleWarning) as caught:
            found = triangulate(content, switches)
        assert [named in str(warning.message) for warning in caught] == [True]
        assert is_right(found)
        return found

    def test_seeds_outside(self) -> None:
        found = self.warned({**COURSE, "holes": [(9.0, 9.0)]}, "p", "hole 0 at (9.0, 9.0)")
        assert len(found["triangles"]) == 4
        self.warned({**COURSE, "holes": [(0.6, 0.6)]}, "p", "hole 0 at (0.6, 0.6)")  # in the hull, outside the domain
        self.warned({**COURSE, "regions": [(0.1, 0.1, 5.0, 1.0), (0.6, 0.6, 3.0, 1.0)]}, "pA", "region 1 at (0.6, 0.6)")

    def test_both_rounds_count_as_the_input_does(self) -> None:
        """One hole is outside the hull, and so found before the other, that is outside the domain."""
        with pytest.warns(TriangleWarning) as caught:
            triangulate({**COURSE, "holes": [(9.0, 9.0), (0.6, 0.6)]}, "p")
        assert [str(warning.message).split(" at")[0] for warning in caught] == ["hole 0", "hole 1"]

    def test_control_nothing_to_pass_over(self) -> None:
        """None: the same input without the fault gives no warning."""
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            assert is_right(triangulate(COURSE, "p"))

    def test_segments_without_length(self) -> None:
        self.warned(
            {**COURSE, "segments": [*COURSE["segments"], (2, 2)], "segment_markers": [1, 2, 3, 4, 9]}, "p", "segment 4"
        )
        twice = {**COURSE, "vertices": [*COURSE["vertices"], (0.4, 0.4)], "segments": [*COURSE["segments"], (2, 5)]}
        del twice["segment_markers"]
        self.warned(twice, "p", "segment 4 (2, 5)")

    def test_segments_that_are_there_twice(self) -> None:
        """They are one segment; its marker is the first that is not 0."""
        content = {**COURSE, "segments": [*COURSE["segments"], (1, 0)], "segment_markers": [0, 2, 3, 4, 9]}
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            found = triangulate(content, "p")
        assert found["segment_markers"].ravel().tolist() == [9, 2, 3, 4]

    def test_what_refinement_misses(self) -> None:
        """A bound that was not reached is told, unless a switch asked for that."""
        needle = {"vertices": [(0, 0), (1, 0), (1, 2.0**-40)], "segments": [(0, 1), (1, 2), (2, 0)]}
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            triangulate(needle, "pq")  # a small angle of the input
            triangulate(HALVES, "pqa0.001S3")
            triangulate(HALVES, "pq30YY")


@pytest.mark.obligation("T3", "what is not clear is refused, and the culprit named", method="named cases")
class TestErrors:
    """What is meant is not clear: an error names the culprit."""

    @pytest.mark.parametrize("switches", ["", "p", "pq", "a0.1", "c"])
    @pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
    def test_not_finite(self, bad: float, switches: str) -> None:
        """NaN kills the interpreter, infinity hangs it."""
        with pytest.raises(NonFiniteError) as caught:
            triangulate({**COURSE, "vertices": [*COURSE["vertices"], (0.1, bad)]}, switches)
        assert list(caught.value.indices) == [5]

    def test_control_without_the_fault(self) -> None:
        """None: the same input without the fault is taken."""
        for content, switches in (
            (COURSE, "p"),
            (COURSE, "pq"),
            (SQUARE, ""),
            ({**SQUARE, "triangles": [(0, 1, 2), (0, 2, 3)]}, "r"),
        ):
            assert len(triangulate(content, switches)["triangles"]) > 1

    def test_segment_out_of_range(self) -> None:
        """No error, and with an open outline no triangles."""
        for bad in ((0, 99), (-1, 2)):
            with pytest.raises(PSLGError) as caught:
                triangulate({**COURSE, "segments": [*COURSE["segments"], bad], "segment_markers": None}, "p")
            assert [(fault.kind, fault.indices) for fault in caught.value.faults] == [(FaultKind.BAD_INDEX, (4,))]

    def test_open_outline(self) -> None:
        """No triangles, and no error."""
        with pytest.raises(PSLGError, match="the switch c") as caught:
            triangulate({**SQUARE, "segments": [(0, 1), (1, 2), (2, 3)]}, "p")
        assert {fault.kind for fault in caught.value.faults} == {FaultKind.NOT_CLOSED}
        assert len(triangulate({**SQUARE, "segments": [(0, 1), (1, 2), (2, 3)]}, "pc")["triangles"]) == 2

    def test_seeds_that_decide_nothing(self) -> None:
        """A hole on a segment is taken for one side or the other; of two regions in a face one wins."""
        with pytest.raises(PSLGError, match="hole 0"):
            triangulate({**COURSE, "holes": [(0.5, 0.0)]}, "p")
        with pytest.raises(PSLGError, match="regions 0 and 1"):
            triangulate({**COURSE, "regions": [(0.1, 0.1, 1, 1), (0.1, 0.2, 2, 1)]}, "pA")

    def test_no_triangle(self) -> None:
        """The key ``triangles`` is missing, or a RuntimeError tells nothing."""
        with pytest.raises(CollinearPointsError):
            triangulate({"vertices": [(0, 0), (1, 1), (2, 2)]})
        for points in ([], [(0, 0), (1, 0)]):
            with pytest.raises(TooFewPointsError):
                triangulate({"vertices": points})

    def test_areas_that_are_not_there(self) -> None:
        """The interpreter dies."""
        given = {**SQUARE, "triangles": [(0, 1, 2), (0, 2, 3)]}
        with pytest.raises(SwitchError, match="triangle_max_area"):
            triangulate(given, "ra")
        with pytest.raises(SwitchError, match="triangle_max_area"):
            triangulate({**given, "regions": [(1, 0.5, 9, 1)], "segments": [(0, 1)]}, "rpa")

    def test_nothing_to_refine(self) -> None:
        with pytest.raises(ChoiceError, match="'triangles'"):
            triangulate(SQUARE, "r")

    @pytest.mark.parametrize(
        "triangles", [[(0, 2, 1)], [(0, 1, 2), (0, 1, 3)], [(0, 1, 1)], [(0, 1, 2), (0, 1, 2)]],
        ids=["clockwise", "overlapping", "flat", "twice"],
    )  # fmt: skip
    def test_no_triangulation(self, triangles: list[tuple[int, int, int]]) -> None:
        """It is refined as it is, or not at all."""
        for switches in ("r", "ra0.1", "rq"):
            with pytest.raises(InadmissibleError) as caught:
                triangulate({**SQUARE, "triangles": triangles}, switches)
            assert not caught.value.report.ok

    def test_segments_that_are_no_edges(self) -> None:
        with pytest.raises(InadmissibleError):
            triangulate({**SQUARE, "triangles": [(0, 1, 2), (0, 2, 3)], "segments": [(1, 3)]}, "rp")

    def test_angles_that_no_mesh_has(self) -> None:
        """It does not end, or runs out of memory."""
        with pytest.raises(SwitchError, match="40 at most"):
            triangulate(COURSE, "pq60")

    @pytest.mark.parametrize("given", [SQUARE["vertices"], np.zeros((5, 2)), None, "A"])
    def test_no_dictionary(self, given: Mapping[str, object]) -> None:
        with pytest.raises(ShapeError, match=r"takes a dictionary, not a .*: {'vertices': points}"):
            triangulate(given, "q")

    def test_no_string_of_switches(self) -> None:
        with pytest.raises(SwitchError, match="switches are a string"):
            triangulate(SQUARE, 20)  # type: ignore[arg-type]  # what an untyped caller passes
        none, empty = triangulate(SQUARE, None), triangulate(SQUARE, "")
        assert none["triangles"].tolist() == empty["triangles"].tolist()

    @pytest.mark.parametrize("name", ["box.1", "double_hex3.1", "spiral.q"])
    def test_examples_that_are_results(self, name: str) -> None:
        with pytest.raises(ChoiceError, match=rf"result.*triangulate\(get_data\('{name.split('.')[0]}'\)"):
            get_data(name)
        with pytest.raises(ChoiceError, match="there is no example"):
            get_data("nothing.1")

    def test_a_name_with_its_suffix(self, tmp_path: Path) -> None:
        (tmp_path / "a.node").write_text("3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n")
        assert len(load(tmp_path, "a")["vertices"]) == 3
        with pytest.raises(FileFormatError, match="without suffix, 'a'"):
            load(tmp_path, "a.node")
        with pytest.raises(FileFormatError, match=r"neigh$"):
            load(tmp_path, "b")

    def test_nobody_to_ask(self) -> None:
        """The package has a function of its own, which nobody chose."""
        with pytest.raises(SwitchError, match="unsuitable="):
            triangulate(COURSE, "pu")


NUMBERS = st.one_of(st.sampled_from([0.0, 1.0, 0.5, 2.0, -1.0, math.nan, math.inf, 1e308, 5e-324, 1e-9]), st.floats())
POINTS = st.lists(st.tuples(*[st.one_of(st.sampled_from([0.0, 1.0, 2.0, 3.0]), NUMBERS)] * 2), max_size=7)
GRID = st.lists(st.tuples(*[st.integers(0, 3)] * 2), min_size=3, max_size=8)
PAIRS = st.lists(st.tuples(*[st.integers(-1, 7)] * 2), max_size=6)
DICTIONARIES = st.fixed_dictionaries(
    {"vertices": st.one_of(GRID, POINTS)},
    optional={
        "segments": PAIRS,
        "holes": POINTS.map(lambda rows: rows[:1]),
        "regions": st.lists(st.tuples(*[st.integers(-1, 4)] * 4), max_size=2),
        "triangles": st.lists(st.tuples(*[st.integers(-1, 7)] * 3), max_size=3),
        "triangle_max_area": st.lists(st.tuples(NUMBERS), max_size=3),
        "vertex_markers": st.lists(st.integers(-3, 3), max_size=8),
        "vertex_attributes": st.lists(NUMBERS, max_size=8),
    },
)
SWITCHES = st.tuples(
    st.sampled_from(["", "p", "pc", "r", "rp", "c"]),
    st.sampled_from(["", "q", "q33", "a0.3", "a", "D", "qa", "s", "qY", "qa0.2YY"]),
    st.sampled_from(["", "e", "enj", "o2", "ABO", "C"]),
).map(lambda parts: "".join(parts) + "S9")


@pytest.mark.obligation("T3", "whatever is in a dictionary: a mesh or a typed error", method="property-based")
class TestAlwaysAnswers:
    """Whatever is in a dictionary: a mesh of counterclockwise triangles, or an error of the library's."""

    @settings(max_examples=60, deadline=None)
    @given(DICTIONARIES, SWITCHES)
    def test_result_or_error(self, content: dict[str, object], switches: str) -> None:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", TriangleWarning)
            try:
                found = triangulate(content, switches)
            except ExactMeshError:
                return
        assert verify(found["vertices"], found["triangles"][:, :3], claims=["orientation", "admissible"]).ok

    def test_control_another_mesh(self) -> None:
        """A triangle listed twice."""
        found = triangulate(SQUARE, "")
        twice = found["triangles"][[0, 0]]
        assert not verify(found["vertices"], twice, claims=["orientation", "admissible"]).ok
