"""V1 for circles: which edges and points are told to be in the way, and what is said of them, in fractions."""

from collections import Counter
from fractions import Fraction
from itertools import islice
from random import Random

import pytest
from proofs_tests import oracles
from proofs_tests.mesh.enumeration import triangulations
from proofs_tests.oracles import Triangle
from proofs_tests.verify.test_links import PLACES
from proofs_tests.verify.test_meetings import Points, about, edges_of, name

from exactkernel import Sign
from exactmesh.verify import Finding, Kind, Property, Verdict, Violation, verify


def meshes(seed: int) -> list[list[Triangle]]:
    """Triangulations, some of whose triangles are left out."""
    random = Random(seed)
    return [[t for t in rows if random.random() < 0.9] for rows in islice(triangulations(PLACES), seed, None, 40)][:12]


def exact_incircle(points: Points, a: int, b: int, c: int, d: int) -> Fraction:
    """The determinant: the power of d with respect to the circle, times twice the area."""
    exact = oracles.rationals(points)
    p, q, r, s = (exact[v] for v in (a, b, c, d))
    centre, radius = oracles.circumcircle(p, q, r)
    return (radius - oracles.squared_distance(centre, s)) * oracles.orient(p, q, r)


def told_once(finding: Finding) -> dict[tuple[int, ...], Violation]:
    found = {violation.vertices: violation for violation in finding.violations}
    assert len(found) == finding.count == len(finding.violations)
    return found


@pytest.mark.obligation(
    "V3", "what is said of circles is true, and complete", method="property-based", control_in="mutants"
)
class TestCircles:
    """Each edge whose far corner is in the circle, each edge on the boundary or a segment whose third corner is in its
    own, and each unused point in the circle of its triangle is told, with the determinant and the rows."""

    @pytest.mark.parametrize("seed", range(3))
    def test_edges(self, seed: int) -> None:
        seen = 0
        for triangles in meshes(seed):
            finding = verify(PLACES, triangles).findings[Property.DELAUNAY]
            owner = {e: t for t, row in enumerate(triangles) for e in edges_of(row)}
            third = {e: next(v for v in triangles[t] if v not in e) for e, t in owner.items()}
            found = told_once(finding)
            for e, t in owner.items():
                back = e[::-1]
                if e[0] > e[1] or back not in owner:
                    continue
                d = third[back]
                value = exact_incircle(PLACES, *e, third[e], d) if d != third[e] else Fraction(0)
                violation = found.pop((*e, third[e], d), None)
                assert (violation is not None) is (value > 0)
                if violation is not None:
                    assert (violation.triangles, violation.magnitude, violation.sign) == ((t, owner[back]), value, 1)
                    corners = ", ".join(name(PLACES, v) for v in (*e, third[e]))
                    assert violation.message == (
                        f"vertex {name(PLACES, d)} of triangle {owner[back]} lies inside the circumcircle of "
                        f"triangle {t} = {corners}: incircle {about(value)}"
                    )
                    seen += 1
            assert not found
        assert seen > 3

    @pytest.mark.parametrize("turn", [False, True])
    def test_unused(self, turn: bool) -> None:
        points = [(0, 0), (8, 0), (0, 8), (2, 2), (0, 0), (8, 8), (3, 5), (5, 5)]
        rows = [(0, 1, 2), (1, 5, 2)]
        if turn:
            rows = [row[::-1] for row in rows]
        finding = verify(points, rows, orientation="any").findings[Property.DELAUNAY]
        found = told_once(finding)
        for v, possible in ((3, (0,)), (6, (0, 1)), (7, (1,))):
            (corners,) = (corners for corners in found if corners[3] == v)
            violation = found.pop(corners)
            (t,) = violation.triangles
            assert t in possible
            assert corners[:3] == rows[t]
            value = abs(exact_incircle(points, *rows[t], v))
            assert (violation.kind, violation.magnitude, violation.sign) == (Kind.POINT_IN_CIRCLE, value, 1)
            names = ", ".join(name(points, u) for u in rows[t])
            assert violation.message == (
                f"unused point {name(points, v)} lies in triangle {t} = {names}, inside its circumcircle: "
                f"incircle {about(value)}"
            )
        assert not found

    @pytest.mark.parametrize("inner", [0, 4])
    def test_copies(self, inner: int) -> None:
        """An unused copy of a corner, inside or on the boundary, is in nobody's way; another unused point is."""
        rim = [(0, 0), (4, 0), (4, 4), (0, 4)]
        points = [*rim[:inner], (2, 2), *rim[inner:], (2, 2), (0, 0), (3, 2)]
        a, b, c, d = (v + (inner == 0) for v in range(4))
        rows = [(a, b, inner), (b, c, inner), (c, d, inner), (d, a, inner)]
        for count, n in ((0, 7), (1, 8)):
            report = verify(points[:n], rows, segments=[])
            for property_ in (Property.DELAUNAY, Property.CONSTRAINED_DELAUNAY):
                assert report.findings[property_].count == count

    def test_without_circle(self) -> None:
        points = [(0, 0), (4, 0), (2, 0), (0, 4)]
        rows = [(0, 1, 2), (0, 1, 3)]
        for property_, report in (
            (Property.DELAUNAY, verify(points, rows)),
            (Property.CONSTRAINED_DELAUNAY, verify(points, rows, segments=[])),
        ):
            finding = report.findings[property_]
            (violation,) = finding.violations
            assert (violation.kind, violation.triangles, violation.vertices) == (Kind.ZERO_AREA, (0,), (0, 1, 2))
            names = ", ".join(name(points, v) for v in (0, 1, 2))
            assert violation.message == f"triangle 0 = {names} has no area, hence no circumcircle"
            assert finding.lower_bound

    def test_undecided(self) -> None:
        """Without any violation something that is missing leaves it open, unless there are no triangles at all."""
        overlapping = [(0, 1, 2), (0, 1, 3)]
        points = [(0, 0), (4, 0), (4, 4), (0, 4)]
        report = verify(points, overlapping, segments=[(0, 1)])
        for property_ in (Property.DELAUNAY, Property.CONSTRAINED_DELAUNAY):
            finding = report.findings[property_]
            assert (finding.verdict, finding.because) == (Verdict.UNDECIDED, (Property.ADMISSIBLE,))
        half = verify([*points, (9, 9)], [(0, 1, 2)]).findings[Property.DELAUNAY]
        assert (half.verdict, half.because) == (Verdict.UNDECIDED, (Property.COVERS_HULL,))

    @pytest.mark.parametrize("seed", range(3))
    def test_diametral(self, seed: int) -> None:
        seen = Counter[str]()
        for triangles in meshes(seed + 3):
            owner = {e: t for t, row in enumerate(triangles) for e in edges_of(row)}
            segments = [e for e in owner if e[0] < e[1] and e[::-1] in owner][::2]
            report = verify(PLACES, triangles, segments=segments, claims=["gabriel"])
            found = told_once(report.findings[Property.GABRIEL])
            for e, t in owner.items():
                (c,) = {*triangles[t]} - {*e}
                on_segment = e in segments or e[::-1] in segments
                (ax, ay), (bx, by), (x, y) = (PLACES[v] for v in (*e, c))
                value = (x - ax) * (bx - x) + (y - ay) * (by - y)
                violation = found.pop((*e, c), None)
                assert (violation is not None) is ((on_segment or e[::-1] not in owner) and value > 0)
                if violation is not None:
                    sort = "edge on a segment" if on_segment else "boundary edge"
                    assert (violation.triangles, violation.magnitude, violation.sign) == (
                        (t,),
                        Fraction(value),
                        Sign.POSITIVE,
                    )
                    assert violation.message == (
                        f"vertex {name(PLACES, c)} lies inside the diametral circle of the {sort} "
                        f"{name(PLACES, e[0])} - {name(PLACES, e[1])}: diametral {about(Fraction(value))}"
                    )
                    seen[sort] += 1
            assert not found
        assert len(seen) == 2

    def test_rounding_sized(self) -> None:
        """A right angle, and a circle through four points, up to a unit in the last place."""
        off = 2.0**-50
        right = [(0.0, 0.0), (5.0, 0.0), (1.0 + off / 4, 2.0)]
        (violation,) = verify(right, [(0, 1, 2)], claims=["gabriel"]).findings[Property.GABRIEL].violations
        assert violation.message.endswith(", rounding-sized")
        round_ = [(-3.0, -4.0), (3.0, -4.0), (3.0, 4.0), (-3.0 + off, 4.0)]
        (violation,) = verify(round_, [(0, 1, 2), (0, 2, 3)]).findings[Property.DELAUNAY].violations
        assert violation.message.endswith(", rounding-sized")
