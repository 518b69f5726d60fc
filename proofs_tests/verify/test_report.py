"""What goes into the verifier and what comes out: arrays of any kind, typed errors, reports that a program
can read."""

import json
import re
from collections.abc import Sequence
from fractions import Fraction
from random import Random

import numpy as np
import numpy.typing as npt
import pytest

from exactkernel import CoordinateError, ExactMeshError, ShapeError, Stage
from exactmesh.verify import (
    CONSTRAINED_TRIANGULATION,
    DELAUNAY_TRIANGULATION,
    DOMAIN_TRIANGULATION,
    FORMAT,
    WITNESSES,
    ChoiceError,
    Kind,
    Orientation,
    Property,
    Verdict,
    VerificationError,
    mesh,
    verify,
)
from exactmesh.verify.status import NIL, Status, empty_status, insert, remove

SQUARE = [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (0.0, 1.0)]
HALVES = [(0, 1, 2), (0, 2, 3)]
KITE = [(0.0, 0.0), (3.0, -1.0), (6.0, 0.0), (3.0, 1.0)]  # with HALVES: the wrong diagonal


#: What is not asked about points and triangles alone.
ABOUT_CONSTRAINTS = {*CONSTRAINED_TRIANGULATION, *DOMAIN_TRIANGULATION} - {*DELAUNAY_TRIANGULATION} | {
    Property.NO_NEW_POINTS,
    Property.REGIONS,
    Property.REGION_AREAS,
}
#: Nothing was bounded, and these were not claimed.
NOT_ASKED = {
    Property.CONVEX,
    Property.GABRIEL,
    Property.CIRCUMCENTRES_INSIDE,
    Property.MIN_ANGLE,
    Property.MAX_ANGLE,
    Property.MAX_AREA,
    Property.MAX_LENGTH,
    Property.VORONOI_DUAL,
}


def frozen(array: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    array.flags.writeable = False
    return array


@pytest.mark.obligation(
    "V1", "the verdict depends on the values alone: not on dtype, layout, byte order or scale", method="named cases"
)
class TestInput:
    """The verdict depends on the values alone: not on dtype, layout, byte order, or who owns the array."""

    @pytest.mark.parametrize(
        "triangles",
        [
            *(np.array(HALVES, dtype=dtype) for dtype in ("i1", "u1", "i2", "u4", "i4", "i8", "u8", ">i4")),
            np.array(HALVES, order="F"),
            np.array([[*row, *row] for row in HALVES])[:, ::2][:, [0, 2, 1]],
            np.repeat(np.array(HALVES), 2, axis=0)[::2],
            frozen(np.array(HALVES)),
            HALVES,
        ],
        ids=str,
    )
    def test_triangles(self, triangles: npt.ArrayLike) -> None:
        assert verify(SQUARE, triangles, orientation="any").ok
        assert not verify(KITE, triangles, orientation="any").ok

    @pytest.mark.parametrize("dtype", ["f2", "f4", "f8", ">f8", "i4", "u1", "O"])
    def test_points(self, dtype: str) -> None:
        assert verify(np.array(SQUARE).astype(dtype), HALVES).ok
        assert verify(np.asfortranarray(np.array(SQUARE).astype(dtype)), HALVES).ok
        assert not verify(np.array([*SQUARE[:3], (1.0, 1.0)]).astype(dtype), HALVES).ok

    @pytest.mark.parametrize("factor", [5e-324, 2.0**-1000, 1.0, 2.0**1000, 2.0**1021])
    def test_scale(self, factor: float) -> None:
        assert verify(np.array(SQUARE) * factor, HALVES).ok
        assert not verify(np.array(KITE) * factor, HALVES).ok

    @pytest.mark.parametrize(
        ("points", "triangles", "error"),
        [
            ([(0, 0, 0)], HALVES, ShapeError),
            ([(0, 0), (1,)], HALVES, ShapeError),
            (SQUARE, [(0, 1)], ShapeError),
            (SQUARE, [(0, 1, 2), (0, 2)], ShapeError),
            (SQUARE, [[[0, 1, 2]]], ShapeError),
            (SQUARE, [(0.0, 1.0, 2.0)], ShapeError),
            (SQUARE, [(False, True, True)], ShapeError),
            (SQUARE, np.empty((0, 4), dtype=int), ShapeError),
            ([("a", "b")], HALVES, CoordinateError),
            ([(2**53 + 1, 0)], HALVES, CoordinateError),
        ],
    )
    def test_refused(self, points: npt.ArrayLike, triangles: npt.ArrayLike, error: type[ExactMeshError]) -> None:
        with pytest.raises(error):
            verify(points, triangles)

    def test_too_many_points(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(mesh, "_MAX_POINTS", 3)
        with pytest.raises(ShapeError, match="4 points; at most"):
            verify(SQUARE, HALVES)

    def test_choices(self) -> None:
        with pytest.raises(ChoiceError, match=r"delauney.*no property"):
            verify(SQUARE, HALVES, claims=["delauney"])
        with pytest.raises(ChoiceError, match="clockwise"):
            verify(SQUARE, HALVES, orientation="clockwise")
        assert verify(SQUARE, HALVES, claims="finite").claims == (Property.FINITE,)
        assert verify(SQUARE, HALVES, claims=["acute", Property.FINITE]).claims == (Property.FINITE, Property.ACUTE)
        assert verify(SQUARE, HALVES).claims == DELAUNAY_TRIANGULATION

    def test_nothing(self) -> None:
        """No points and no triangles: everything holds, of nothing. Points without triangles are not
        covered."""
        empty = np.empty((0, 2))
        assert verify(empty, []).ok
        assert verify(empty, np.empty((0, 3), dtype=int)).ok
        report = verify(SQUARE, [])
        failed = [property_ for property_ in Property if report.verdict(property_) is Verdict.FAILS]
        assert failed == [Property.ALL_POINTS_USED, Property.COVERS_HULL]

    def test_a_vertex_of_large_degree(self) -> None:
        """A fan of 200 triangles at one vertex, and the same with one of them repeated."""
        points = [(0, 0), *((i, 100000 + i * i) for i in range(-100, 101))]
        fan = [(0, i + 1, i) for i in range(1, 201)]
        random = Random(0)
        random.shuffle(fan)
        report = verify(points, fan)
        assert report.verdict(Property.ADMISSIBLE) is report.verdict(Property.VERTEX_MANIFOLD) is Verdict.HOLDS
        assert verify(points, [*fan, fan[7]]).verdict(Property.EDGE_MANIFOLD) is Verdict.FAILS

    def test_control_another_value(self) -> None:
        """A point moved across an edge, a corner exchanged: the verdict is another."""
        assert verify(SQUARE, HALVES).ok
        assert not verify([*SQUARE[:2], (-1.0, -1.0), SQUARE[3]], HALVES).ok
        assert not verify(SQUARE, [HALVES[0], HALVES[0]]).ok


@pytest.mark.obligation(
    "V1", "a point that is not finite and an index out of range are findings that name them", method="named cases"
)
class TestUnreadable:
    """A point that is not finite and an index out of range are findings, named; what rests on them is
    undecided."""

    @pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
    def test_not_finite(self, bad: float) -> None:
        points = np.array(SQUARE)
        points[2, 1] = bad
        report = verify(points, HALVES)
        assert report.findings[Property.FINITE].count == 1
        assert report.findings[Property.FINITE].violations[0].vertices == (2,)
        assert report.verdict(Property.INDICES) is Verdict.HOLDS
        for property_ in list(report.findings)[2:]:
            assert report.findings[property_].because == (Property.FINITE,)
        json.loads(report.to_json(), parse_constant=pytest.fail)

    def test_finite_although_the_sum_is_not(self) -> None:
        report = verify([(-1.7e308, -1.7e308), (1.7e308, -1.7e308), (1.7e308, 1.7e308)], [(0, 1, 2)])
        assert report.ok

    @pytest.mark.parametrize("dtype", ["i8", "u8", "i4"])
    def test_indices(self, dtype: str) -> None:
        triangles = np.array([(0, 1, 2), (0, 2, 4), (1, 1, 3)], dtype=dtype)
        report = verify(SQUARE, triangles)
        assert [violation.kind for violation in report.findings[Property.INDICES].violations] == [
            Kind.OUT_OF_RANGE,
            Kind.REPEATED_CORNER,
        ]
        assert report.findings[Property.INDICES].violations[0].triangles == (1,)
        assert report.verdict(Property.DISTINCT_POINTS) is Verdict.HOLDS
        assert report.findings[Property.DELAUNAY].because == (Property.INDICES,)

    def test_extreme_indices(self) -> None:
        for index in (-1, -(2**63), 2**63 - 1, 4):
            assert verify(SQUARE, [(0, 1, index)]).verdict(Property.INDICES) is Verdict.FAILS
        assert verify(SQUARE, np.array([(0, 1, 2**64 - 1)], "u8")).verdict(Property.INDICES) is Verdict.FAILS

    def test_extreme_indices_are_cut_out(self) -> None:
        """What is out of range is so in the part of the mesh that shows it, and what differs still differs."""
        for row in (np.array([(2**63 - 1, -(2**63), 0)]), np.array([(2**64 - 1, 2**63, 1)], "u8")):
            part = verify(SQUARE, row).violations[0].submesh()
            finding = verify(part.points, part.triangles).findings[Property.INDICES]
            assert [violation.kind for violation in finding.violations] == [Kind.OUT_OF_RANGE]
            assert len(np.unique(part.triangles)) == 3

    def test_both(self) -> None:
        report = verify([(np.nan, 0.0)], [(0, 1, 2)])
        assert report.findings[Property.DISTINCT_POINTS].because == (Property.FINITE, Property.INDICES)

    def test_control_readable(self) -> None:
        """None: the same mesh, finite and in range, has neither finding."""
        report = verify(SQUARE, HALVES)
        assert report.verdict(Property.FINITE) is report.verdict(Property.INDICES) is Verdict.HOLDS


class TestReport:
    """A report says what was claimed, what was found and how; as an object, as text, as JSON, and as an
    exception."""

    def test_json(self) -> None:
        document = json.loads(verify(KITE, HALVES).to_json())
        assert document["format"] == FORMAT
        assert document["ok"] is False
        assert list(document["properties"]) == [
            property_.value for property_ in Property if property_ not in ABOUT_CONSTRAINTS | NOT_ASKED
        ]
        found = document["properties"]["delaunay"]
        assert (found["verdict"], found["count"], found["count_is_lower_bound"]) == ("fails", 1, False)
        assert Fraction(found["violations"][0]["magnitude"]) == 96
        assert found["violations"][0]["sign"] == 1
        assert sorted(found["violations"][0]["vertices"]) == [0, 1, 2, 3]
        assert document["stages"]["incircle"]["grid"] + document["stages"]["incircle"]["filter"] == 1
        assert json.loads(verify(SQUARE, HALVES).to_json())["ok"] is True

    def test_exception(self) -> None:
        verify(SQUARE, HALVES).raise_if_failed()
        verify(KITE, HALVES, claims=["admissible"]).raise_if_failed()
        with pytest.raises(VerificationError, match=r"delaunay fails: vertex 1 \(3\.0, -1\.0\)") as caught:
            verify(KITE, HALVES).raise_if_failed()
        assert caught.value.report.violations[0].property is Property.DELAUNAY
        with pytest.raises(VerificationError, match="delaunay undecided: no witness"):
            verify([*SQUARE, (9, 9)], HALVES, claims=["delaunay"]).raise_if_failed()

    def test_text(self) -> None:
        text = str(verify(KITE, HALVES))
        assert "NOT what it claims" in text
        assert "! delaunay         fails, 1 found" in text
        assert "incircle 96" in text
        text = str(verify([*SQUARE, (9, 9)], HALVES))
        assert "? delaunay         undecided: covers_hull would have to hold" in text
        crossing = [(0, 0), (4, 0), (0, 4), (1, 3), (-1, 1), (5, 1)]
        assert "fails, at least 1 found" in str(verify(crossing, [(0, 1, 2), (4, 5, 3)]))

    def test_counts_are_exact_beyond_the_witnesses(self) -> None:
        points = [(i, i * i) for i in range(300)]
        report = verify(points, [(0, 1, 2)])
        unused = report.findings[Property.ALL_POINTS_USED]
        assert (unused.count, len(unused.violations)) == (297, WITNESSES)
        assert "... and 294 more" in str(report)

    def test_stages(self) -> None:
        """The counts of stages add up to the calls: of three diametral and one orient2d a triangle, one
        incircle an inner edge, one orient2d a boundary vertex."""
        report = verify(SQUARE, HALVES)
        assert sum(report.stages["orient2d"].values()) == 4 * 2 + 4
        assert sum(report.stages["incircle"].values()) == 1
        assert verify([(0.0, 0.0), (0.1, 0.1), (0.3, 0.3)], [(0, 1, 2)]).stages["orient2d"][Stage.FILTER] < 4


def listed(status: Status) -> list[int]:
    """Return the tree in order, after checking heap, parents and list."""
    order: list[int] = []

    def visit(node: int, parent: int) -> None:
        if node == NIL:
            return
        assert status.parent[node] == parent or parent == NIL
        assert parent == NIL or status.priority[node] < status.priority[parent]
        visit(int(status.child[node, 0]), node)
        order.append(node)
        visit(int(status.child[node, 1]), node)

    visit(int(status.root[0]), NIL)
    for below, above in zip([NIL, *order], [*order, NIL], strict=True):
        assert below == NIL or status.above[below] == above
        assert above == NIL or status.below[above] == below
    return order


def follow(operations: Sequence[tuple[int, int]], size: int, *, wrong: bool = False) -> bool:
    """Do the operations on a status and on a plain list; tell whether they agree."""
    status, model = empty_status(size), list[int]()
    for e, place in operations:
        if e in model:
            remove(status, e)
            model.remove(e)
        else:
            at = place % (len(model) + 1)
            below, above = [NIL, *model][at], [*model, NIL][at]
            insert(status, e, below, above)
            model.insert(0 if wrong else at, e)
        if listed(status) != model:
            return False
    return True


class TestStatus:
    """Whatever is inserted and removed, the tree in order is the list, parents and priorities form a heap."""

    @pytest.mark.parametrize("seed", range(8))
    def test_as_a_list(self, seed: int) -> None:
        random = Random(seed)
        size = 30
        fresh = list(range(size))
        random.shuffle(fresh)
        operations, present = [], list[int]()
        for _ in range(60):
            if present and (not fresh or random.random() < 0.4):
                operations.append((present.pop(random.randrange(len(present))), 0))
            elif fresh:
                present.append(fresh.pop())
                operations.append((present[-1], random.randrange(1000)))
        assert follow(operations, size)
        assert not follow(operations, size, wrong=True)


class TestOrientation:
    """With "any" a clockwise triangle is taken as it lies, with "ccw" it is a violation; without area it
    always is."""

    def test_clockwise(self) -> None:
        rows = [(0, 2, 1), (0, 2, 3)]
        assert verify(SQUARE, rows, orientation=Orientation.ANY).ok
        report = verify(SQUARE, rows)
        assert [violation.kind for violation in report.findings[Property.ORIENTATION].violations] == [Kind.CLOCKWISE]
        assert report.findings[Property.ORIENTATION].violations[0].magnitude == Fraction(-3)
        assert report.verdict(Property.ADMISSIBLE) is report.verdict(Property.DELAUNAY) is Verdict.HOLDS
        assert report.verdict(Property.EDGE_MANIFOLD) is Verdict.FAILS

    @pytest.mark.parametrize("orientation", list(Orientation))
    def test_no_area(self, orientation: Orientation) -> None:
        report = verify([(0, 0), (1, 1), (3, 3)], [(0, 1, 2)], orientation=orientation)
        for property_ in (Property.ORIENTATION, Property.ADMISSIBLE, Property.DELAUNAY, Property.ACUTE):
            assert report.findings[property_].violations[0].kind is Kind.ZERO_AREA


class TestReportAtAGlance:
    """A report is true if every claim holds, its repr is one line, and unclaimed facts take no room."""

    GOOD = ([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)])
    CLOCKWISE = ([(0, 0), (1, 0), (0, 1)], [(0, 2, 1)])

    def test_truth(self) -> None:
        assert verify(*self.GOOD)
        assert not verify(*self.CLOCKWISE)

    def test_repr(self) -> None:
        assert repr(verify(*self.GOOD)) == "Report(3 points, 1 triangles, ok)"
        assert "orientation fails" in repr(verify(*self.CLOCKWISE))

    def test_unclaimed_failures_have_no_witnesses_in_print(self) -> None:
        assert "90 degrees" not in str(verify(*self.GOOD))
        assert "90 degrees" in str(verify(*self.GOOD, claims=["acute"]))

    def test_claims_stand_first_and_the_rest_apart(self) -> None:
        """Above "not claimed:" there are the claims, what fails first; below it the others, a line each."""
        report = verify(KITE, HALVES, claims=["admissible", "delaunay"])
        head, claims, others = re.split(r".*every|NOT.*\n|  not claimed:\n", str(report))
        assert head == "4 points, 2 triangles: "
        assert re.findall(r"^  (\S \w+)", claims, re.MULTILINE) == ["! delaunay", "+ admissible"]
        told = re.findall(r"^  \S (\w+)", others, re.MULTILINE)
        assert told == [property_ for property_ in report.findings if property_ not in report.claims]
        assert len(others.splitlines()) == len(told) + len(report.stages)
        assert "not claimed" not in str(verify(*self.GOOD, claims=list(report.findings)))  # control


@pytest.mark.obligation("V3", "inverted cells are told apart from the others' orientation", method="named cases")
class TestListing:
    """Where cells may be listed either way, it is said how many are clockwise; where cells overlap, which of them are
    listed the other way round than most. Of an inverted cell of finite elements that is all that there is to see."""

    FAN = ((0, 0), (4, 0), (4, 4), (0, 4), (-4, 4))

    def test_an_inverted_triangle(self) -> None:
        """The vertex at (1, -1) was pushed across the edge from 0 to 1."""
        rows = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 1, 5)]
        assert verify([*self.FAN, (1, -1)], rows, orientation="any", claims=["admissible"]).ok  # it is its other side
        report = verify([*self.FAN, (1, 0.5)], rows, orientation="any", claims=["admissible"])
        (first, *_) = report.findings[Property.ADMISSIBLE].violations
        assert first.triangles == (0, 3)
        assert "; triangle" not in first.message  # both are counterclockwise
        report = verify([*self.FAN, (1, 0.5)], [*rows[:3], (0, 5, 1)], orientation="any", claims=["admissible"])
        (first, *_) = report.findings[Property.ADMISSIBLE].violations
        assert first.message.endswith("they overlap; triangle 3 is listed clockwise, most are counterclockwise")
        (first, *_) = report.findings[Property.EDGE_MANIFOLD].violations
        assert first.message.endswith("; triangle 3 is listed clockwise, most are counterclockwise")
        assert "orientation      holds; 1 of 4 triangles are listed clockwise" in str(report)

    def test_the_few_are_named_whichever_they_are(self) -> None:
        rows = [(0, 2, 1), (0, 3, 2), (0, 4, 3), (0, 1, 5)]
        (first, *_) = verify([*self.FAN, (1, 0.5)], rows, orientation="any").findings[Property.ADMISSIBLE].violations
        assert first.message.endswith("; triangle 3 is listed counterclockwise, most are clockwise")

    def test_quadrilaterals(self) -> None:
        points = [(0, 0), (4, 0), (4, 4), (0, 4), (4, 2), (0, 2), (8, 0), (8, 4)]
        report = verify(points, quads=[(0, 1, 2, 3), (1, 6, 7, 2), (0, 5, 4, 1)], orientation="any")
        (first, *_) = report.findings[Property.ADMISSIBLE].violations
        assert first.message.endswith("; cell 2 is listed clockwise, most are counterclockwise")
        assert report.findings[Property.ORIENTATION].note == "1 of 3 cells are listed clockwise"

    def test_control_nothing_is_said_where_all_are_alike_or_half(self) -> None:
        """Meshes in which all, or half, are listed alike."""
        for rows in ([(0, 1, 2), (0, 1, 5)], [(0, 1, 2), (0, 5, 1)]):
            report = verify([*self.FAN, (1, 0.5)], rows, orientation="any")
            assert "most are" not in str(report)
        assert report.findings[Property.ORIENTATION].note == "1 of 2 triangles are listed clockwise"
        assert verify(SQUARE, HALVES, orientation="any").findings[Property.ORIENTATION].note == ""
