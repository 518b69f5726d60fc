"""V1: which violations a faulty diagram has, one by one, and how large they are."""

import math
from fractions import Fraction
from random import Random
from types import SimpleNamespace

import numpy as np
import numpy.typing as npt
import pytest
from gmpy2 import mpq
from proofs_tests import oracles
from proofs_tests.verify.test_dual import claims_of, dual_finding, is_next
from proofs_tests.verify.test_links import links_of, mesh_of

from exactmesh import delaunay, voronoi
from exactmesh.verify import Finding, Kind, Property, Severity, Verdict, duality, verify
from exactmesh.verify.dual import Ridges
from exactmesh.verify.duality import Check
from exactmesh.verify.report import WITNESSES
from exactmesh.verify.severity import MEASURE_BOUND

INF, NAN, ZERO = math.inf, math.nan, Fraction(0)
#: No four on a circle.
POINTS = np.array([(6.0, 5.0), (16.0, 1.0), (3.0, 15.0), (0.0, 0.0), (8.0, 4.0), (5.0, 9.0)])

#: The first two points are no neighbours.
APART = (0, 1)

Told = tuple[Kind, frozenset[int]]


def told(finding: Finding) -> list[Told]:
    assert finding.count == len(finding.violations)
    return [(violation.kind, frozenset(violation.vertices)) for violation in finding.violations]


def edges_of(triangles: list[list[int]]) -> list[tuple[int, int]]:
    return [(t[i], t[i - 1]) for t in triangles for i in range(3)]


def ridge(claimed: SimpleNamespace, *, ray: bool) -> int:
    """The last ridge of a sort."""
    return int(np.flatnonzero((claimed.ends < 0).any(axis=1) == ray)[-1])


def pair_of(claimed: SimpleNamespace, r: int) -> frozenset[int]:
    return frozenset(claimed.ridge_points[r].tolist())


def add(
    claimed: SimpleNamespace, sites: tuple[int, int], ends: tuple[int, int], direction: tuple[float, float]
) -> None:
    claimed.ridge_points = np.concatenate([claimed.ridge_points, [sites]])
    claimed.ends = np.concatenate([claimed.ends, [ends]])
    claimed.directions = np.concatenate([claimed.directions, [direction]])


def finding_about(claimed: SimpleNamespace) -> Finding:
    claimed.ridge_vertices = claimed.ends
    return dual_finding(POINTS, claimed)


@pytest.mark.obligation("V1", "each fault of a diagram is told once, by its name and corners", method="named cases")
class TestFaults:
    """One fault at a time, of a diagram without any: the violations are those that the fault causes, and no others."""

    def test_control_none(self) -> None:
        """None: nothing is told."""
        assert finding_about(claims_of(POINTS)) == Finding(Verdict.HOLDS)

    @pytest.mark.parametrize("ray", [True, False])
    def test_missing(self, ray: bool) -> None:
        claimed = claims_of(POINTS)
        r = ridge(claimed, ray=ray)
        edge = pair_of(claimed, r)
        for name in ("ridge_points", "ends", "directions"):
            setattr(claimed, name, np.delete(getattr(claimed, name), r, axis=0))
        finding = finding_about(claimed)
        assert told(finding) == [(Kind.MISSING_RIDGE, edge)]
        (violation,) = finding.violations
        a, b = violation.vertices
        names = [f"{v} ({float(POINTS[v, 0])!r}, {float(POINTS[v, 1])!r})" for v in (a, b)]
        assert violation.message == f"no ridge of the diagram is dual to the edge {names[0]} - {names[1]}"

    @pytest.mark.parametrize("ray", [True, False])
    @pytest.mark.parametrize("times", [1, 2])
    def test_twice(self, ray: bool, times: int) -> None:
        claimed = claims_of(POINTS)
        n, r = len(claimed.ends), ridge(claimed, ray=ray)
        rows = [*range(n), *[r] * times]
        for name in ("ridge_points", "ends", "directions"):
            setattr(claimed, name, getattr(claimed, name)[rows])
        finding = finding_about(claimed)
        assert told(finding) == [(Kind.EXTRA_RIDGE, pair_of(claimed, r))] * times
        for i, violation in enumerate(finding.violations):
            expected = "of the diagram is dual to no edge, or to one that another ridge is dual to"
            assert violation.message == f"ridge {n + i} {expected}"

    @pytest.mark.parametrize(
        ("ends", "direction"),
        [((0, 1), (NAN, NAN)), ((0, -1), (1.0, 7.0)), ((-1, -1), (NAN, NAN)), ((-1, 0), (0.0, 0.0))],
    )
    @pytest.mark.parametrize("sites", [(0, 0), APART, APART[::-1], (6, 1), (0, 6), (6, 6)])
    def test_no_edge(self, sites: tuple[int, int], ends: tuple[int, int], direction: tuple[float, float]) -> None:
        """A ridge between sites that are no neighbours, or no points: it is extra, whatever else is wrong with it."""
        claimed = claims_of(POINTS)
        claimed.points = np.concatenate([claimed.points, [(100.0, 100.0)]])
        add(claimed, sites, ends, direction)
        finding = finding_about(claimed)
        assert told(finding) == [(Kind.EXTRA_RIDGE, frozenset(v for v in sites if v < 6))]

    @pytest.mark.parametrize("ends", [(0, 1), (0, -1), (-1, 0), (-1, -1)])
    @pytest.mark.parametrize("ray", [True, False])
    def test_ends(self, ray: bool, ends: tuple[int, int]) -> None:
        """A ray that ends, a ridge that does not, or has no end at all."""
        claimed = claims_of(POINTS)
        r = ridge(claimed, ray=ray)
        claimed.ends[r] = ends
        finding = finding_about(claimed)
        if ray is (sorted(ends)[0] == -1) and ends != (-1, -1):
            assert {violation.kind for violation in finding.violations} == {Kind.WRONG_CENTRE}
            return
        assert (Kind.WRONG_RAY, pair_of(claimed, r)) in told(finding)
        assert [kind for kind, _ in told(finding)].count(Kind.WRONG_RAY) == 1
        (violation,) = (violation for violation in finding.violations if violation.kind is Kind.WRONG_RAY)
        assert violation.message.startswith(f"ridge {r} of the diagram, dual to the edge ")
        assert violation.message.endswith(", ends where it should not, or does not end")

    @pytest.mark.parametrize(
        ("factor", "right"),
        [
            ((1.0, 1.0), True), ((2.0**300, 2.0**300), True), ((2.0**-300, 2.0**-300), True), ((NAN, NAN), True),
            ((-1.0, -1.0), False), ((0.0, 0.0), False), ((1.0, -1.0), False), ((1.0, 0.0), False), ((0.0, 1.0), False),
            ((NAN, 1.0), False), ((1.0, NAN), False), ((INF, 1.0), False), ((1.0, -INF), False), ((INF, INF), False),
            ((1.0, 1.0 + 2.0**-48), False), ((1.0, 1.0 - 2.0**-48), False), ((1.0, 1.0 + 2.0**-53), True),
        ],
    )  # fmt: skip
    def test_directions(self, factor: tuple[float, float], right: bool) -> None:
        """A direction may be missing or of any length; it is finite, perpendicular but for rounding, and outward."""
        for r in range(len(claims_of(POINTS).ends)):
            claimed = claims_of(POINTS)
            if (claimed.ends[r] >= 0).all():
                continue
            a, b = claimed.ridge_points[r].tolist()
            ux, uy = POINTS[b] - POINTS[a]
            outward = 1.0 if ((POINTS - POINTS[a]) @ (uy, -ux) <= 0).all() else -1.0
            claimed.directions[r] = np.array([uy, -ux]) * outward * factor
            finding = finding_about(claimed)
            assert told(finding) == ([] if right else [(Kind.WRONG_RAY, frozenset((a, b)))])
            for violation in finding.violations:
                assert violation.message.endswith(", has a wrong direction")

    @pytest.mark.parametrize("place", [(NAN, 1.0), (1.0, NAN), (INF, 0.0), (0.0, -INF), (NAN, NAN)])
    def test_infinite_vertices(self, place: tuple[float, float]) -> None:
        """A vertex that is no finite point is wrong, and at no distance."""
        for v in range(len(claims_of(POINTS).vertices)):
            claimed = claims_of(POINTS)
            claimed.vertices[v] = place
            (violation,) = finding_about(claimed).violations
            (t,) = violation.triangles
            assert (violation.kind, violation.magnitude) == (Kind.WRONG_CENTRE, None)
            assert violation.severity is Severity.WRONG
            name = f"vertex {v} ({place[0]!r}, {place[1]!r}) of the diagram"
            assert violation.message == f"{name} is not the circumcentre of triangle {t}"

    def test_moved_vertices(self) -> None:
        for v in range(len(claims_of(POINTS).vertices)):
            claimed = claims_of(POINTS)
            claimed.vertices[v] += (3.0, 0.5)
            (violation,) = finding_about(claimed).violations
            (t,) = violation.triangles
            exact = oracles.rationals(POINTS.tolist())
            a, b, c = violation.vertices
            apart = oracles.squared_distance(
                oracles.circumcircle(exact[a], exact[b], exact[c])[0], oracles.rationals(claimed.vertices[v : v + 1])[0]
            )
            assert violation.magnitude == apart
            assert violation.message.endswith(
                f"circumcentre of triangle {t}: its squared distance is {float(apart):.3g}"
            )
            claimed = claims_of(POINTS)
            claimed.vertices[v, 0] += 3 * np.spacing(claimed.vertices[v, 0])
            (violation,) = finding_about(claimed).violations
            assert violation.severity is Severity.ROUNDING
            assert violation.message.endswith(", rounding-sized")

    @pytest.mark.parametrize("where", [0, 3, None])
    def test_stray(self, where: int | None) -> None:
        """A vertex that ends no ridge, first, in the middle, or last."""
        claimed = claims_of(POINTS)
        v = len(claimed.vertices) if where is None else where
        claimed.vertices = np.insert(claimed.vertices, v, (1.0, 1.0), axis=0)
        claimed.ends[claimed.ends >= v] += 1
        finding = finding_about(claimed)
        assert told(finding) == [(Kind.WRONG_CENTRE, frozenset())]
        assert finding.violations[0].message == f"vertex {v} of the diagram is the end of no ridge"

    def test_by_triangle(self) -> None:
        """A vertex a triangle: no vertex is a stray one, and each is that of its triangle even where no ridge ends."""
        square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
        triangles = [(0, 1, 2), (0, 2, 3)]
        rays = ([0, 0, 1, 1], [(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)])
        for vertices, right in (([(0.5, 0.5)] * 2, True), ([(0.5, 0.5), (0.5, 0.25)], False)):
            for edges in ([(0, 1)], []):
                finding = verify(square, triangles, dual=(vertices, edges, *rays)).findings[Property.VORONOI_DUAL]
                assert told(finding) == ([] if right else [(Kind.WRONG_CENTRE, frozenset((0, 2, 3)))])
        alone: tuple[npt.ArrayLike, ...] = ([(3.0, 1.0)], [], [0, 0, 0], [(0.0, -1.0), (1.0, 3.0), (-1.0, 0.0)])
        assert verify([(0.0, 0.0), (6.0, 0.0), (0.0, 2.0)], [(0, 1, 2)], dual=alone).ok


@pytest.mark.obligation(
    "V1", "both orders of a ridge's ends are tried, in rationals as in doubles", method="named cases"
)
class TestOrders:
    """Between two triangles on one circle either order will do, but each end must be the centre of one triangle."""

    SQUARE = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])

    @pytest.mark.parametrize("first", [0, 1])
    @pytest.mark.parametrize("off", [(2.0**-53, 0.0), (0.0, 2.0**-53), (-(2.0**-54), 0.0), (0.25, 0.0)])
    def test_control_one_good_end(self, first: int, off: tuple[float, float]) -> None:
        """Between equal centres a ridge from the centre to a double beside it: doubles cannot tell, fractions do."""
        claimed = claims_of(self.SQUARE)
        assert claimed.vertices.tolist() == [[0.5, 0.5]]
        claimed.vertices = np.array([(0.5, 0.5), (0.5 + off[0], 0.5 + off[1])])
        a, b = (
            (0, 2)
            if [0, 2] in [sorted(pair) for pair in edges_of(delaunay(self.SQUARE).triangles.tolist())]
            else (1, 3)
        )
        add(claimed, (a, b), (0, 1) if first == 0 else (1, 0), (NAN, NAN))
        claimed.ridge_vertices = claimed.ends
        finding = dual_finding(self.SQUARE, claimed)
        assert [violation.kind for violation in finding.violations] == [Kind.WRONG_CENTRE]
        claimed.vertices[1] = (0.5, 0.5)
        assert dual_finding(self.SQUARE, claimed).verdict is Verdict.HOLDS


def check_of(corners: list[tuple[float, float]], vertices: list[tuple[float, float]]) -> Check:
    mesh = mesh_of(corners, [(0, 1, 2)])
    none = np.empty((0, 2), dtype=np.intp)
    return Check(mesh, links_of(mesh), mesh.triangles, Ridges(np.array(vertices), none, none, np.empty((0, 2)), True))


def terms_of(z: oracles.RationalPoint, a: oracles.RationalPoint, b: oracles.RationalPoint) -> list[Fraction]:
    """The products in |z - a|^2 - |z - b|^2, whose sum it is; z and a are looked at apart."""
    products = []
    for i in range(2):
        u = b[i] - a[i]
        products += [2 * z[i] * u, -2 * a[i] * u, -u * u]
    return products


@pytest.mark.obligation(
    "V1", "a vertex is rounding-sized iff doubles hardly tell its distances from the corners", method="differential"
)
class TestSeverity:
    """For no corner the difference of the squared distances is beyond the bound times the sum of its products."""

    @pytest.mark.parametrize("bound", [MEASURE_BOUND, 2.0**-4, 0.25, 0.5])
    def test_terms(self, bound: float, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(duality, "MEASURE_BOUND", bound)
        random, seen, equal = Random(2), set(), 0
        for _ in range(60):
            corners = [(random.randrange(-9, 10) + 0.0, random.randrange(-9, 10) + 0.0) for _ in range(3)]
            a, b, c = oracles.rationals(corners)
            if oracles.orient(a, b, c) == 0:
                continue
            if oracles.orient(a, b, c) < 0:
                corners, b, c = [corners[0], corners[2], corners[1]], c, b
            x, y = oracles.circumcircle(a, b, c)[0]
            wide = 6.0 if bound > 0.01 else 1e-14
            places = [(float(x) + random.randrange(-8, 9) / 8 * wide, float(y) + random.randrange(-8, 9) / 8 * wide)
                      for _ in range(12)]  # fmt: skip
            places += [(random.randrange(-20, 21) / 2, random.randrange(-20, 21) / 2) for _ in range(12)]
            check = check_of(corners, places)
            for v, z in enumerate(oracles.rationals(places)):
                parts = [terms_of(z, a, other) for other in (b, c)]
                slack = [Fraction(bound) * sum(map(abs, terms), ZERO) - abs(sum(terms, ZERO)) for terms in parts]
                equal += min(slack) == 0
                expected = Severity.ROUNDING if min(slack) >= 0 else Severity.WRONG
                assert check._severity(v, 0) is expected
                seen.add(expected)
        assert seen == {Severity.ROUNDING, Severity.WRONG}
        assert equal > 0 or bound not in (0.25, 0.5)

    @pytest.mark.parametrize(("bound", "expected"), [(0.0, Severity.WRONG), (1.0, Severity.ROUNDING)])
    def test_control_other_bounds(self, bound: float, expected: Severity, monkeypatch: pytest.MonkeyPatch) -> None:
        """A bound of nothing, and one that no vertex exceeds."""
        monkeypatch.setattr(duality, "MEASURE_BOUND", bound)
        check = check_of([(0.0, 0.0), (4.0, 0.0), (0.0, 2.0)], [(2.0, 1.0 + 2.0**-50)])
        assert check._severity(0, 0) is expected

    def test_wrong_first(self) -> None:
        """Of many, what is wrong is told before what is rounding-sized, and no more than there is room for."""
        points = np.random.default_rng(8).random((90, 2))
        mesh, claimed = delaunay(points), claims_of(points)
        n = len(claimed.vertices)
        claimed.vertices[:40] += 1e-9
        claimed.vertices[40:, 0] += 4 * np.spacing(claimed.vertices[40:, 0])
        finding = verify(mesh.points, mesh.triangles, dual=claimed).findings[Property.VORONOI_DUAL]
        assert n > WITNESSES + 30
        assert (finding.count, len(finding.violations)) == (n, WITNESSES)
        severities = [violation.severity for violation in finding.violations]
        wrong = severities.count(Severity.WRONG)
        assert severities == [Severity.WRONG] * wrong + [Severity.ROUNDING] * (WITNESSES - wrong)
        assert finding.rounding == n - wrong


@pytest.mark.obligation("V1", "next to a number are the double itself and the two beside it", method="enumeration")
class TestNeighbours:
    """A double is next to a number iff no other one lies between them; infinities are doubles here, NaN is none."""

    def test_doubles(self) -> None:
        seen = set()
        biggest = 1.7976931348623157e308
        for z in (0.0, 1.0, -1.5, 2.0**-1074, biggest, -biggest, 0.1):
            around = [math.nextafter(z, -INF), z, math.nextafter(z, INF)]
            finite = [x for x in around if math.isfinite(x)]
            numbers = [Fraction(x) + d for x in finite for d in (0, Fraction(1, 2**1100), -Fraction(1, 2**1100))]
            for number in (*numbers, Fraction(10) ** 400, -(Fraction(10) ** 400)):
                for x in (*around, math.nextafter(around[0], -INF), math.nextafter(around[2], INF), INF, -INF, NAN):
                    found = duality._is_neighbour(x, mpq(number.numerator, number.denominator))
                    assert found is is_next(x, number)
                    seen.add(found)
        assert seen == {True, False}
        assert duality._is_neighbour(NAN, mpq(0)) is False

    def test_points(self) -> None:
        """Of points both coordinates count."""
        up = math.nextafter(0.5, 1.0)
        corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]
        places = [(x, y) for x in (0.5, up, 0.25) for y in (0.5, up, 0.25)]
        check = check_of(corners, places)
        assert [check._is_next(v, 0) for v in range(9)] == [x == y == 0.5 for x, y in places]
        third = check_of([(0.0, 0.0), (3.0, 0.0), (1.0, 1.0)], [(1.5, -0.5), (math.nextafter(1.5, 2.0), -0.5)])
        assert [third._is_next(v, 0) for v in range(2)] == [True, False]

    def test_control_far_away(self) -> None:
        """Of a circumcentre beyond the doubles: infinity is next to it, the largest double is not."""
        points = np.array([(-1e150, 0.0), (1e150, 0.0), (0.0, 1e-200), (0.0, 1e151)])
        claimed = claims_of(points)
        (far,) = np.flatnonzero(~np.isfinite(claimed.vertices).all(axis=1)).tolist()
        assert dual_finding(points, claimed).verdict is Verdict.HOLDS
        assert dual_finding(points, voronoi(points)).verdict is Verdict.HOLDS
        claimed.vertices[far, 1] = -1.7e308
        assert dual_finding(points, claimed).verdict is Verdict.FAILS
