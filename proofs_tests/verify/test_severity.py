"""V1 for severities: how many violations are rounding-sized, and which of many are told, against fractions."""

import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from random import Random

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.kernel.shape_oracle import cosine_interval
from proofs_tests.oracles import RationalPoint, Triangle

from exactkernel.shape import angle_bound
from exactkernel.types import FloatArray, IntArray
from exactmesh import delaunay
from exactmesh.verify import WITNESSES, Finding, Property, Severity, Verdict, grading, severity, text, verify
from exactmesh.verify.witness import Ranking

U = Fraction(1, 2**53)
CIRCLE, DIAMETRAL, MEASURE = 10 * U + 96 * U * U, 3 * U + 16 * U * U, 12 * U + 64 * U * U


def circle_is_small(a: RationalPoint, b: RationalPoint, c: RationalPoint, d: RationalPoint) -> bool:
    """The determinant by the power of d, the permanent by distances."""
    centre, radius = oracles.circumcircle(a, b, c)
    value = abs((radius - oracles.squared_distance(centre, d)) * oracles.orient(a, b, c))
    x, y = d
    permanent = sum(
        oracles.squared_distance(p, d) * (abs((q[0] - x) * (r[1] - y)) + abs((q[1] - y) * (r[0] - x)))
        for p, q, r in ((a, b, c), (b, c, a), (c, a, b))
    )
    return value <= CIRCLE * permanent


def diametral_is_small(a: RationalPoint, b: RationalPoint, p: RationalPoint) -> bool:
    left, right = (p[0] - a[0]) * (p[0] - b[0]), (p[1] - a[1]) * (p[1] - b[1])
    return abs(left + right) <= DIAMETRAL * (abs(left) + abs(right))


def area_is_small(corners: Sequence[RationalPoint], limit: float) -> bool:
    (ax, ay), (bx, by), (cx, cy) = corners
    permanent = abs((bx - ax) * (cy - ay)) + abs((by - ay) * (cx - ax)) + 2 * Fraction(limit)
    return abs(oracles.orient(*corners)) - 2 * Fraction(limit) <= MEASURE * permanent


def angle_is_small(corners: Sequence[RationalPoint], degrees: float, *, least: bool) -> bool:
    """At no corner the products of the sides, times the doubles nearest to sine and cosine, differ by more."""
    beside = Fraction(degrees) - 90
    nearest = [float(sum(cosine_interval(angle, 120)) / 2) for angle in (abs(beside), Fraction(degrees))]
    sine, cosine = {45.0: (1.0, 1.0), 90.0: (1.0, 0.0)}.get(degrees, nearest)
    s, c = Fraction(sine), Fraction(cosine)
    for i in range(3):
        p, q, r = (corners[(i + j) % 3] for j in range(3))
        u, v = (q[0] - p[0], q[1] - p[1]), (r[0] - p[0], r[1] - p[1])
        value = s * (u[0] * v[0] + u[1] * v[1]) - c * (u[0] * v[1] - u[1] * v[0])
        permanent = s * (abs(u[0] * v[0]) + abs(u[1] * v[1])) + abs(c) * (abs(u[0] * v[1]) + abs(u[1] * v[0]))
        if (value if least else -value) > MEASURE * permanent:
            return False
    return True


def perturbed_grid(seed: int, scale: float = 1.0) -> FloatArray:
    """A tilted grid, rounded: its squares are circles up to rounding; and some points anywhere."""
    x, y = np.meshgrid(np.arange(7.0), np.arange(6.0))
    c, s = math.cos(0.3 + seed), math.sin(0.3 + seed)
    points = np.stack([c * x - s * y, s * x + c * y], axis=-1).reshape(-1, 2) + (1e3 if seed % 3 == 2 else 0.0)
    return np.asarray(points * scale)


def flipped(points: FloatArray, seed: int) -> list[Triangle]:
    """A Delaunay triangulation in which some diagonals are exchanged, convex or not."""
    triangles = [(int(a), int(b), int(c)) for a, b, c in delaunay(points).triangles]
    across = {(t[i], t[(i + 1) % 3]): j for j, t in enumerate(triangles) for i in range(3)}
    random, locked = Random(seed), set[int]()
    exact = oracles.rationals(points.tolist())
    for (a, b), i in across.items():
        j = across.get((b, a))
        if j is None or i in locked or j in locked or random.random() < 0.4:
            continue
        (c,), (d,) = set(triangles[i]) - {a, b}, set(triangles[j]) - {a, b}
        if oracles.orient(exact[c], exact[d], exact[b]) > 0 and oracles.orient(exact[d], exact[c], exact[a]) > 0:
            triangles[i], triangles[j] = (d, b, c), (c, a, d)
            locked |= {i, j}
    return triangles


def across_edges(triangles: Sequence[Triangle]) -> Iterator[tuple[int, int, int, int]]:
    """Yield v < b with the third corners on the left and on the right of vb."""
    left = {(t[i], t[(i + 1) % 3]): t[(i + 2) % 3] for t in triangles for i in range(3)}
    for (v, b), c in left.items():
        if v < b and (b, v) in left:
            yield v, b, c, left[b, v]


def small_circles(points: FloatArray, triangles: Sequence[Triangle]) -> tuple[int, int]:
    """Return how many edges are not Delaunay, and how many of them are rounding-sized."""
    exact, count, small = oracles.rationals(points.tolist()), 0, 0
    for edge in across_edges(triangles):
        a, b, c, d = (exact[v] for v in edge)
        centre, radius = oracles.circumcircle(a, b, c)
        if oracles.squared_distance(centre, d) < radius:
            count += 1
            small += circle_is_small(a, b, c, d)
    return count, small


def checked(finding: Finding) -> Finding:
    """What is said of a finding agrees with its witnesses."""
    small = [violation.severity is Severity.ROUNDING for violation in finding.violations]
    assert small == sorted(small), "wrong ones come first"
    assert finding.rounding <= finding.count
    if finding.count <= WITNESSES:
        assert finding.rounding == sum(small)
    if not finding.count:
        assert finding.severity is None
    else:
        assert (finding.severity is Severity.ROUNDING) is (finding.rounding == finding.count)
    return finding


SCALES = (1.0, 2.0**-70, 2.0**-300, 2.0**330)


@pytest.mark.obligation(
    "V1", "the number of rounding-sized violations is that of the definition in fractions", method="differential"
)
class TestCounts:
    """A violation is rounding-sized iff its determinant is at most the filter's constant times its permanent: counted
    over all violations, at every scale, and the same for each witness."""

    @pytest.mark.parametrize("scale", SCALES)
    @pytest.mark.parametrize("seed", range(6))
    def test_delaunay(self, seed: int, scale: float) -> None:
        points = perturbed_grid(seed, scale)
        triangles = flipped(points, seed)
        finding = checked(verify(points, triangles).findings[Property.DELAUNAY])
        assert (finding.count, finding.rounding) == small_circles(points, triangles)

    def test_control_both_sizes_occur(self) -> None:
        """Violations of both sizes."""
        points = np.concatenate([perturbed_grid(0), [(0.3, 0.2), (40.0, 3.0)]])
        count, small = small_circles(points, flipped(points, 1))
        assert 0 < small < count

    @pytest.mark.parametrize("seed", range(6))
    def test_gabriel(self, seed: int) -> None:
        """Right angles over boundary edges, rounded: grids cut along their diagonals."""
        points = perturbed_grid(seed)
        triangles = [t for t in flipped(points, seed) if Random(f"{seed}{t}").random() < 0.5]
        exact = oracles.rationals(points.tolist())
        sides = {(t[i], t[(i + 1) % 3]): t[(i + 2) % 3] for t in triangles for i in range(3)}
        inside = [
            (a, b, c)
            for (a, b), c in sides.items()
            if (b, a) not in sides
            and sum((exact[c][i] - exact[a][i]) * (exact[c][i] - exact[b][i]) for i in range(2)) < 0
        ]
        finding = checked(verify(points, triangles, claims=["gabriel"]).findings[Property.GABRIEL])
        small = sum(diametral_is_small(*(exact[v] for v in edge)) for edge in inside)
        assert (finding.count, finding.rounding) == (len(inside), small)

    @pytest.mark.parametrize(("least", "most"), [(45.0, 90.0), (44.99999999999999, 90.00000000000003), (20.0, 100.0)])
    @pytest.mark.parametrize("seed", range(4))
    def test_angles(self, seed: int, least: float, most: float) -> None:
        points = np.concatenate([perturbed_grid(seed), np.random.default_rng(seed).random((5, 2)) * 9])
        triangles = flipped(points, seed)
        exact = oracles.rationals(points.tolist())
        report = verify(points, triangles, min_angle=least, max_angle=most)
        for property_, bound in ((Property.MIN_ANGLE, least), (Property.MAX_ANGLE, most)):
            finding = checked(report.findings[property_])
            rows = [v.triangles[0] for v in finding.violations]
            is_least = property_ is Property.MIN_ANGLE
            small = [angle_is_small([exact[v] for v in triangles[t]], bound, least=is_least) for t in rows]
            assert small == [v.severity is Severity.ROUNDING for v in finding.violations]

    @pytest.mark.parametrize("scale", [1.0, 2.0**-90, 2.0**-480])
    def test_areas(self, scale: float) -> None:
        points = np.concatenate([perturbed_grid(0, scale), [(3 * scale, 3.25 * scale)]])
        triangles = [(int(a), int(b), int(c)) for a, b, c in delaunay(points).triangles]
        exact = oracles.rationals(points.tolist())
        limit = 0.5 * scale * scale
        finding = checked(verify(points, triangles, max_area=limit).findings[Property.MAX_AREA])
        large = [t for t in triangles if oracles.orient(*(exact[v] for v in t)) > 2 * Fraction(limit)]
        small = sum(area_is_small([exact[v] for v in t], limit) for t in large)
        assert (finding.count, finding.rounding) == (len(large), small)
        assert small > 0

    def test_what_cannot_be_measured_is_wrong(self) -> None:
        clockwise = verify([(0, 0), (1, 0), (0, 1)], [(0, 2, 1)]).findings[Property.ORIENTATION]
        assert (clockwise.rounding, clockwise.severity) == (0, Severity.WRONG)
        flat = verify([(0, 0), (1, 1), (2, 2)], [(0, 1, 2)], min_angle=1).findings[Property.MIN_ANGLE]
        assert (flat.rounding, flat.severity) == (0, Severity.WRONG)

    @pytest.mark.parametrize("name", ["grade_circles", "grade_areas"])
    def test_rationals_say_the_same(self, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
        """What the compiled pass leaves open is decided likewise."""
        points = perturbed_grid(3)
        triangles = flipped(points, 3)

        def rounding() -> list[int]:
            report = verify(points, triangles, max_area=0.5)
            return [report.findings[p].rounding for p in (Property.DELAUNAY, Property.MAX_AREA)]

        before = rounding()
        monkeypatch.setattr(grading, name, lambda *_: None)
        assert rounding() == before

    def test_control_a_pass_that_guesses(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Every violation taken for rounding-sized."""
        points = perturbed_grid(3)
        triangles = flipped(points, 3)
        monkeypatch.setattr(grading, "grade_circles", lambda *a: a[-2].fill(severity.ROUNDING_SIZED))
        finding = verify(points, triangles).findings[Property.DELAUNAY]
        assert (finding.count, finding.rounding) != small_circles(points, triangles)


def many() -> tuple[FloatArray, list[Triangle]]:
    """Squares on circles up to rounding, each with its worse diagonal, and one kite that is plainly wrong, last."""
    points, triangles = list[tuple[float, float]](), list[Triangle]()
    for i in range(256):
        x, y, c, s = i % 16 - 7.5, i // 16 - 7.5, math.cos(i) / 2, math.sin(i) / 2
        points += [(x + c, y + s), (x - s, y + c), (x - c, y - s), (x + s, y - c)]
        v = len(points) - 4
        p, q, r, t = oracles.rationals(points[v:])
        centre, radius = oracles.circumcircle(p, q, r)
        bad = oracles.squared_distance(centre, t) < radius
        triangles += [(v, v + 1, v + 2), (v, v + 2, v + 3)] if bad else [(v, v + 1, v + 3), (v + 1, v + 2, v + 3)]
    kite, k = [(0.0, -19.0), (3.0, -20.0), (6.0, -19.0), (3.0, -18.0)], len(points)
    return np.array([*points, *kite]), [*triangles, (k, k + 1, k + 2), (k, k + 2, k + 3)]


@pytest.mark.obligation("V1", "of many violations the wrong ones are told, whatever their place", method="named cases")
class TestRanking:
    """The witnesses of a finding are the wrong violations before the rounding-sized, the largest first."""

    def test_one_wrong_among_many(self) -> None:
        points, triangles = many()
        finding = checked(verify(points, triangles).findings[Property.DELAUNAY])
        assert finding.rounding > WITNESSES
        assert (finding.count, finding.rounding) == small_circles(points, triangles)
        assert {*finding.violations[0].vertices} == {*range(1024, 1028)}

    def test_the_largest_first(self) -> None:
        points = [(float(i * i), 0.0) for i in range(9)] + [(float(i * i), 3.0) for i in range(9)]
        triangles = [t for i in range(8) for t in ((i, i + 1, 10 + i), (i, 10 + i, 9 + i))]
        areas = verify(points, triangles, max_area=2).findings[Property.MAX_AREA]
        sizes = [violation.magnitude for violation in areas.violations]
        assert sizes == sorted(sizes, key=lambda size: -(size or 0))
        angles = verify(points, triangles, min_angle=50).findings[Property.MIN_ANGLE]
        degrees = [violation.degrees for violation in angles.violations]
        assert degrees == sorted(degrees, key=lambda x: x or 0.0)

    def test_control_in_order_of_place(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Witnesses in the order of their place."""
        monkeypatch.setattr(grading, "ranked", lambda *_: Ranking(np.arange(WITNESSES), 0))
        told = verify(*many()).findings[Property.DELAUNAY].violations
        assert all({*violation.vertices} != {*range(1024, 1028)} for violation in told)


def tilted_square() -> tuple[list[tuple[float, float]], IntArray]:
    """A square on a circle up to rounding, with the diagonal that is not Delaunay."""
    for i in range(100):
        c, s = math.cos(0.1 + i), math.sin(0.1 + i)
        points = [(c, s), (-s, c), (-c, -s), (s, -c)]
        a, b, p, d = oracles.rationals([(x + 0.25, y) for x, y in points])
        centre, radius = oracles.circumcircle(a, b, p)
        if oracles.squared_distance(centre, d) < radius:
            return [(x + 0.25, y) for x, y in points], np.array([(0, 1, 2), (0, 2, 3)])
    raise AssertionError("no such square")


@pytest.mark.obligation("V3", "the severity of a report is the worst over its claims", method="named cases")
class TestReport:
    """The severity of a report is the worst over the claims that fail, and over what undecided ones wait for; the text
    begins with what is wrong."""

    def test_rounding_only(self) -> None:
        report = verify(*tilted_square())
        assert not report.ok
        assert report.severity is Severity.ROUNDING
        assert "fails, 1 found, all rounding-sized" in str(report)
        assert "by rounding-sized violations only" in str(report).splitlines()[0]
        assert report.findings[Property.DELAUNAY].to_dict()["rounding"] == 1

    def test_wrong(self) -> None:
        points, triangles = tilted_square()
        for report in (
            verify([*points, (0.25, 0.0)], triangles),
            verify(points, triangles[:, ::-1]),
            verify([*points, (9.0, 9.0)], triangles, claims=["covers-hull"]),
        ):
            assert report.severity is Severity.WRONG
        assert verify(points, triangles, claims=["admissible"]).severity is None

    def test_undecided(self) -> None:
        """It waits for what fails: an unclaimed violation counts then."""
        twice = verify([(0, 0), (1, 0), (0, 1)], [(0, 1, 2), (0, 1, 2)], claims=["covers-hull"])
        assert twice.verdict(Property.COVERS_HULL) is Verdict.UNDECIDED
        assert twice.severity is Severity.WRONG
        hidden = verify(*tilted_square(), claims=["gabriel"])
        assert hidden.severity is (None if hidden.ok else Severity.ROUNDING)

    def test_no_severity_iff_ok(self) -> None:
        for seed in range(20):
            points = perturbed_grid(seed)
            report = verify(points, flipped(points, seed)[seed % 3 :])
            assert (report.severity is None) is report.ok

    def test_order(self) -> None:
        points, triangles = tilted_square()
        lines = str(verify([*points, (9.0, 9.0)], triangles, min_angle=50)).splitlines()
        marks = [line[2] for line in lines[1:-2] if line[2] in "!~?+-" and line[3] == " "]
        assert marks == sorted(marks, key="!~?+-".index) or marks[-1] == "-"
        assert lines[1].startswith("  ! ")

    @pytest.mark.parametrize("drop", ["rounding", "order"])
    def test_control_blind_report(self, drop: str, monkeypatch: pytest.MonkeyPatch) -> None:
        """Every violation taken for wrong; findings told in any order."""
        points, triangles = tilted_square()
        if drop == "rounding":
            monkeypatch.setattr(Finding, "severity", property(lambda self: Severity.WRONG if self.count else None))
            assert verify(points, triangles).severity is Severity.WRONG
        else:
            monkeypatch.setattr(text, "worst_first", lambda report: [*report.findings])
            assert not str(verify([*points, (9.0, 9.0)], triangles)).splitlines()[1].startswith("  ! ")


@pytest.mark.obligation("V1", "an angle on the threshold is rounding-sized", method="named cases")
class TestEquality:
    """Of equality in the definition: an angle is beyond 90 degrees by just what counts as rounding,
    D = C P in fractions. No length can be equal to its threshold."""

    BOUND = severity.MEASURE_BOUND

    def corners(self, third: tuple[float, float]) -> Severity:
        points = np.array([(-1.0, 1.0), (0.0, 2.0), third])
        return severity.angle_severity(points, [0, 1, 2], angle_bound(90.0), least=False)

    def test_an_angle(self) -> None:
        third = (-self.BOUND, -self.BOUND)
        a, b, c = oracles.rationals([(-1.0, 1.0), (0.0, 2.0), third])
        products = [(b[i] - a[i]) * (c[i] - a[i]) for i in range(2)]
        assert -sum(products) == Fraction(self.BOUND) * sum(map(abs, products))
        assert self.corners(third) is Severity.ROUNDING

    def test_control_a_trifle_more(self) -> None:
        """One coordinate is beyond by the least that there is."""
        assert self.corners((-self.BOUND, math.nextafter(-self.BOUND, -1.0))) is Severity.WRONG
        assert self.corners((-self.BOUND, math.nextafter(-self.BOUND, 0.0))) is Severity.ROUNDING

    def test_no_length(self) -> None:
        """Where |ab|^2 (1 - C) = l^2 (1 + C) the odd part of l is a multiple of every prime factor of 2^k - c, C being
        c / 2^k; so it has more than 53 bits."""
        bound = Fraction(self.BOUND)
        primes = {3, 127, 307, 2857, 6529, 43691, 4432676798593}
        assert math.prod(primes) * 3 == bound.denominator - bound.numerator
        assert all(math.gcd(p, bound.denominator + bound.numerator) == 1 for p in primes)
        assert math.prod(primes).bit_length() > 53
