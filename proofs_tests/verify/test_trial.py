"""V1 for trials: which placement is told of, what advice is given, and corners at one position."""

import math
from collections.abc import Sequence

import numpy as np
import pytest
from proofs_tests.verify.test_constrained import Plain
from proofs_tests.verify.test_within import COVER, damned

from exactmesh.verify import Property, Report, Verdict, placement, trial, verify
from exactmesh.verify.text import digits_above

Points = Sequence[tuple[float, float]]
RIM = [(0, 1), (1, 2), (2, 3), (3, 0)]
FAN = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]


def square(size: float) -> list[tuple[float, float]]:
    return [(0.0, 0.0), (size, 0.0), (size, size), (0.0, size), (size / 2, size / 2)]


def moved(size: float, x: float, y: float, within: float | None = None) -> Report:
    """A square against one whose first corner is elsewhere."""
    theirs = [(x, y), *square(size)[1:4]]
    return verify(square(size), FAN, domain=Plain.of(theirs, RIM), within=within, claims=COVER)


def notes(report: Report) -> dict[Property, str]:
    return {property_: finding.note for property_, finding in report.findings.items() if finding.note}


@pytest.mark.obligation(
    "V1", "advice is given up to a margin that is stated, and where it is due", method="named cases"
)
class TestAdvice:
    """A mesh that misses its domain is told the distance that would do, up to 2^-20 of the largest coordinate, or 16
    times the distance that was allowed; just those of the claims that fail are told, and beyond nothing is."""

    @pytest.mark.parametrize("size", [1024.0, 1.0, 2.0**-40])
    def test_of_the_coordinates(self, size: float) -> None:
        limit = size * 2.0**-20
        for distance in (limit, limit / 2):
            advice = f"within={digits_above(distance)} it would hold"
            outside = moved(size, 0.0, -distance)
            assert notes(outside) == {Property.SEGMENTS_PRESENT: advice, Property.COVERS_DOMAIN: advice}
        inside = moved(size, limit / 4, limit / 2)
        assert set(notes(inside)) == {Property.SEGMENTS_PRESENT}
        assert inside.verdict(Property.COVERS_DOMAIN) is Verdict.UNDECIDED
        assert notes(moved(size, 0.0, -math.nextafter(limit, 1.0))) == {}
        assert notes(moved(size, 0.0, 0.0)) == {}

    def test_of_what_was_allowed(self) -> None:
        within = 2.0**-12
        assert set(notes(moved(1.0, 0.0, -16 * within, within))) == {Property.SEGMENTS_PRESENT, Property.COVERS_DOMAIN}
        assert notes(moved(1.0, 0.0, -math.nextafter(16 * within, 1.0), within)) == {}
        assert notes(moved(1.0, 0.0, -within, within)) == {}

    def test_of_a_point(self) -> None:
        """An isolated point beside a corner: nothing else fails."""
        theirs = [*square(1.0)[:4], (0.5, 0.5 + 2.0**-30)]
        report = verify(square(1.0), FAN, domain=Plain.of(theirs, RIM), claims=COVER)
        assert set(notes(report)) == {Property.DOMAIN_POINTS}

    def test_with_segments_of_the_mesh(self) -> None:
        """What is known of the mesh's own segments, and what was tried before, does not matter; by parity either."""
        theirs = [(0.0, -(2.0**-30)), *square(1.0)[1:4]]
        for rule in ("seeds", "even-odd"):
            domain = Plain.of(theirs, RIM, (), rule)
            report = verify(square(1.0), FAN, segments=[(0, 4), (1, 2)], domain=domain, claims=COVER)
            assert set(notes(report)) == {Property.SEGMENTS_PRESENT, Property.COVERS_DOMAIN}

    def test_control_what_is_not_admissible(self) -> None:
        """A triangle twice: there is nothing to advise."""
        domain = Plain.of([(0.0, -(2.0**-30)), *square(1.0)[1:4]], RIM)
        report = verify(square(1.0), [*FAN, FAN[0]], domain=domain, claims=COVER)
        assert not report.ok
        assert notes(report) == {}
        assert verify([], [], domain=domain, claims=COVER).verdict(Property.COVERS_DOMAIN) is Verdict.FAILS


@pytest.mark.obligation(
    "V1", "the placement that is told of is the first of those that fail least", method="named cases"
)
class TestChoice:
    """Of placements that fail alike the first is told of, which moves less; the first that does not fail is, if any."""

    def test_the_first(self) -> None:
        distance = damned(math.inf).distance
        assert distance == 0.0625
        assert damned(math.inf, [(1.0, 6.0)]).distance == distance
        assert not damned(math.inf, [(1.0, 6.0)]).ok

    def test_control_the_last(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """The placements the other way round."""
        forwards = placement.displaced_placements
        monkeypatch.setattr(trial, "displaced_placements", lambda *given: reversed([*forwards(*given)]))
        distance = damned(math.inf, [(1.0, 6.0)]).distance
        assert distance is not None
        assert distance > 1

    @pytest.mark.parametrize("within", [0.0, 1.0])
    def test_without_admissible(self, within: float) -> None:
        """Segments that are chains are there, whatever else; strictly, and displaced."""
        report = verify(square(1.0), [*FAN, FAN[0]], domain=Plain.of(square(1.0), RIM), within=within)
        assert report.verdict(Property.SEGMENTS_PRESENT) is Verdict.HOLDS
        assert report.findings[Property.COVERS_DOMAIN].because == (Property.ADMISSIBLE,)
        assert report.findings[Property.DOMAIN_POINTS].verdict is Verdict.HOLDS


@pytest.mark.obligation("V1", "a corner is new iff no point of the domain is at its position", method="enumeration")
class TestNewPoints:
    """Of any number of corners at a position all are new or none is, whatever the numbers of the domain's points."""

    @pytest.mark.parametrize("first", range(4))
    def test_corners_at_one_position(self, first: int) -> None:
        corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]
        points = [*corners, *corners]
        order = [corners[(first + i) % 4] for i in range(3)]
        domain = Plain.of(order, [(0, 1), (1, 2), (2, 0)])
        finding = verify(points, [(0, 1, 2), (4, 5, 6), (1, 3, 2)], domain=domain).findings[Property.NO_NEW_POINTS]
        new = [v for v in (0, 1, 2, 3, 4, 5, 6) if points[v] not in order]
        assert [violation.vertices for violation in finding.violations] == [(v,) for v in new]

    def test_control_elsewhere(self) -> None:
        """A corner as near to a point of the domain as can be."""
        points = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])
        domain = Plain.of(points.tolist(), [(0, 1), (1, 2), (2, 0)])
        points[1, 0] = math.nextafter(1.0, 2.0)
        assert verify(points, [(0, 1, 2)], domain=domain).findings[Property.NO_NEW_POINTS].count == 1
