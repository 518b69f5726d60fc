"""V2 for the report as an object: what it is equal to, what it says without words, how it is written."""

import json
import math
from dataclasses import fields, replace
from fractions import Fraction
from random import Random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exactmesh.verify import (
    Finding,
    Kind,
    Property,
    Report,
    Severity,
    Verdict,
    Violation,
    document,
    verify,
)
from exactmesh.verify.properties import LOCAL_PROPERTIES
from exactmesh.verify.report import root_above
from exactmesh.verify.witness import finding_of

LARGEST = 1.7976931348623157e308
KITE = [(0.0, 0.0), (3.0, -1.0), (6.0, 0.0), (3.0, 1.0)]
HALVES = [(0, 1, 2), (0, 2, 3)]


@pytest.mark.obligation("V1", "a distance is rounded up, by less than a double", method="property-based")
class TestRootAbove:
    """The square of the result is not below the value, that of the double before it is: for rationals of any size."""

    @staticmethod
    def _is_right(found: float, value: Fraction) -> bool:
        above = found == math.inf or Fraction(found) ** 2 >= value
        below = math.nextafter(found, 0.0)
        return above and (found == 0.0 or Fraction(below) ** 2 < value)

    @given(st.fractions(min_value=0), st.integers(-2200, 2200))
    def test_any(self, value: Fraction, power: int) -> None:
        value *= Fraction(2) ** power
        assert self._is_right(root_above(value), value)

    @pytest.mark.parametrize("seed", range(20))
    def test_squares_of_doubles(self, seed: int) -> None:
        """And the rationals just beside them."""
        random = Random(seed)
        root = math.ldexp(random.random(), random.randrange(-1070, 1020))
        square, step = Fraction(root) ** 2, Fraction(1, 2**2300)
        assert root_above(square) == root_above(square - step) == root
        assert root_above(square + step) == math.nextafter(root, math.inf)

    def test_beyond_all_doubles(self) -> None:
        assert root_above(Fraction(LARGEST) ** 2) == LARGEST
        for more in (1, 2**960, 2**969, 2**970, 2**2000):
            assert root_above((Fraction(LARGEST) + more) ** 2) == math.inf

    def test_control_rounded_to_nearest(self) -> None:
        """The root rounded to the nearest double: below the value, for one rational in two."""
        wrong = sum(not self._is_right(math.sqrt(n), Fraction(n)) for n in range(1000))
        assert wrong > 300
        assert all(self._is_right(root_above(Fraction(n)), Fraction(n)) for n in range(1000))


@pytest.mark.obligation("V3", "reports that say the same are equal", method="named cases")
class TestEquality:
    """What repeats the input (corners, positions, the mesh itself) makes no difference and is not printed."""

    plain = Violation(Property.DELAUNAY, Kind.POINT_IN_CIRCLE, (0,), (1,), "so it is")

    @pytest.mark.parametrize(
        "more",
        [{"corners": ((7, 8, 9),)}, {"indices": (7, 8)}, {"points": ((7.0, 8.0),)}, {"point_count": 789}],
        ids=str,
    )
    def test_what_repeats_the_input(self, more: dict[str, object]) -> None:
        other = replace(self.plain, **more)  # type: ignore[arg-type]  # one attribute or another
        assert other == self.plain
        assert hash(other) == hash(self.plain)
        assert repr(other) == repr(self.plain)
        assert other.is_local is self.plain.is_local is True

    def test_control_what_is_said(self) -> None:
        """Another attribute of those that say something."""
        for more in ({"message": ""}, {"triangles": ()}, {"severity": Severity.ROUNDING}, {"places": ((0.0, 0.0),)}):
            other = replace(self.plain, **more)
            assert other != self.plain
            assert repr(other) != repr(self.plain)

    def test_distance(self) -> None:
        """The square, exactly, and the root, rounded up, of the finding about segments; values, not methods."""
        finding = Finding(Verdict.HOLDS, distance_squared=Fraction(2))
        report = Report({Property.SEGMENTS_PRESENT: finding}, (Property.SEGMENTS_PRESENT,), 3, 1, {})
        assert report.distance_squared == Fraction(2)
        assert report.distance == finding.distance == math.sqrt(2)  # the double above the root
        assert Report({}, (), 3, 1, {}).distance is None

    def test_defaults(self) -> None:
        assert (self.plain.corners, self.plain.indices, self.plain.points, self.plain.point_count) == ((), (), (), 0)
        assert Finding(Verdict.HOLDS) == Finding(Verdict.HOLDS, 0, (), False, (), 0, None, "")
        report = Report({}, (), 3, 1, {})
        assert (report.quad_count, report.mesh, report.ok) == (0, None, True)

    def test_meshes(self) -> None:
        """Other arrays with the same numbers."""
        one, other = verify(KITE, HALVES), verify([*KITE], [*HALVES])
        assert one == other == replace(one, mesh=None)
        assert one.mesh is not other.mesh
        empty = Report({}, (), 3, 1, {})
        assert empty == replace(empty, mesh=one.mesh)
        assert empty.ok


@pytest.mark.obligation("V3", "a violation is local iff its property is", method="enumeration", control_in="mutants")
class TestLocal:
    """A truth value, not a method: false as well."""

    def test_all(self) -> None:
        for property_ in Property:
            violation = Violation(property_, Kind.CROSSING, (), (), "")
            assert violation.is_local is (property_ in LOCAL_PROPERTIES)
        assert {field.name for field in fields(Violation)} >= {"property", "kind"}


@pytest.mark.obligation("V3", "the same report makes the same text, in JSON and nothing else", method="named cases")
class TestText:
    """Indented by two; a number that JSON does not know is refused, and so is none written."""

    def test_layout(self) -> None:
        text = verify(KITE, HALVES, min_angle=20).to_json()
        assert text == json.dumps(json.loads(text), indent=2)
        assert text == verify(KITE, HALVES, min_angle=20).to_json()

    @pytest.mark.parametrize("degrees", [math.nan, math.inf])
    def test_control_no_number(self, degrees: float) -> None:
        """An angle that is no number in a report made by hand."""
        violation = Violation(Property.MIN_ANGLE, Kind.SMALL_ANGLE, (0,), (), "", degrees=degrees)
        finding = Finding(Verdict.FAILS, 1, (violation,))
        report = Report({Property.MIN_ANGLE: finding}, (Property.MIN_ANGLE,), 3, 1, {})
        with pytest.raises(ValueError, match="not JSON compliant"):
            report.to_json()

    @pytest.mark.parametrize("n", [0, 1, 99, 100, 101, 250])
    def test_a_hundred_witnesses(self, n: int) -> None:
        """So many are spelled out, and all are counted."""
        finding = finding_of(np.arange(n), lambda i: Violation(Property.ACUTE, Kind.RIGHT_ANGLE, (i,), (), ""))
        assert (finding.count, [v.triangles for v in finding.violations]) == (n, [(i,) for i in range(min(n, 100))])
        assert finding.severity is (Severity.WRONG if n else None)

    def test_notes(self) -> None:
        """A note is there where there is something to note, and only there."""
        for note in ("", "seen from below"):
            finding = Finding(Verdict.HOLDS, note=note)
            assert finding.to_dict().get("note", "") == note
            assert ("note" in finding.to_dict()) is bool(note)

    @pytest.mark.parametrize("n", [1, 2, 3])
    def test_positions(self, n: int) -> None:
        """Vertices from 0 to n - 1 have one, in hexadecimal digits and in decimal ones; others have none."""
        points = [(0.5 * i, 1.0) for i in range(n)]
        violation = verify(points, [(-1, 0, n)]).findings[Property.INDICES].violations[0]
        positions = {row["vertex"]: (row["hex"], row["decimal"]) for row in document.numbered_positions(violation)}
        assert positions == {
            -1: (None, None),
            0: (["0x0.0p+0", "0x1.0000000000000p+0"], ["0.0", "1.0"]),
            n: (None, None),
        }
