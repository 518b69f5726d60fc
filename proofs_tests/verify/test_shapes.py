"""V1 and V2 for shapes: Gabriel edges, circumcentres, bounds on angles and areas, against brute force."""

import json
import math
from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations
from random import Random

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.kernel import shape_oracle
from proofs_tests.once import once_after
from proofs_tests.oracles import RationalPoint, Triangle
from proofs_tests.recording import Record
from proofs_tests.verify import gabriel_oracle
from proofs_tests.verify.test_verdicts import CONFIGURATIONS, all_sets

from exactkernel import BoundError, ShapeError
from exactmesh import PSLG, constrained_delaunay, delaunay
from exactmesh.errors import CollinearPointsError
from exactmesh.verify import (
    CONFORMING_TRIANGULATION,
    ChoiceError,
    Finding,
    Kind,
    Property,
    Report,
    Severity,
    Verdict,
    centres,
    deciding,
    verify,
)

Points = Sequence[tuple[float, float]]
Pair = tuple[int, int]
CIRCLES = (Property.GABRIEL, Property.CIRCUMCENTRES_INSIDE)


def truths(
    points: Sequence[RationalPoint], triangles: Sequence[Triangle], segments: Sequence[Pair]
) -> dict[Property, bool]:
    return {
        Property.GABRIEL: not gabriel_oracle.encroachers(points, triangles, segments),
        Property.CIRCUMCENTRES_INSIDE: gabriel_oracle.centres_inside(points, triangles),
    }


def circle_faults(points: Points, triangles: Sequence[Triangle], segments: Sequence[Pair] | None) -> list[str]:
    """Where the verifier contradicts brute force about circles, or is undecided without a reason."""
    report = verify(points, list(triangles), segments=segments, claims=CIRCLES)
    if report.verdict(Property.ADMISSIBLE) is not Verdict.HOLDS:
        return [f"{p} holds of what is not admissible" for p in CIRCLES if report.verdict(p) is Verdict.HOLDS]
    if segments is not None and report.verdict(Property.SEGMENTS_PRESENT) is not Verdict.HOLDS:
        return []
    faults = []
    for property_, truth in truths(oracles.rationals(points), triangles, segments or ()).items():
        finding = report.findings[property_]
        if finding.verdict is Verdict.UNDECIDED:
            missing = [report.findings[p].verdict for p in finding.because]
            if property_ is not Property.GABRIEL or not missing or Verdict.HOLDS in missing:
                faults.append(f"{property_} undecided because of {finding.because}")
        elif (finding.verdict is Verdict.HOLDS) is not truth:
            faults.append(f"{property_} {finding.verdict}")
        if (finding.verdict is Verdict.FAILS) is not (finding.count > 0):
            faults.append(f"{property_} {finding.verdict} with {finding.count} violations")
    return faults


def random_mesh(random: Random) -> tuple[Points, list[Triangle], list[Pair]]:
    """A constrained Delaunay triangulation of a few grid points, with segments; some triangles taken away."""
    wide = random.choice((4, 8, 40))
    points = list({(random.randrange(wide), random.randrange(1 + wide // 2)) for _ in range(random.randrange(4, 10))})
    if len(points) < 3:
        return random_mesh(random)
    wanted: list[Pair] = []
    exact = oracles.rationals(points)
    for a, b in random.sample([*combinations(range(len(points)), 2)], 4 if len(points) > 4 else 2):
        lines = [(exact[c], exact[d]) for c, d in wanted]
        if all(not shape_meets(exact[a], exact[b], *line) for line in lines):
            wanted.append((a, b))
    try:
        mesh = constrained_delaunay(PSLG(points, wanted), carve=False)
    except CollinearPointsError:
        return random_mesh(random)
    triangles = [(int(a), int(b), int(c)) for a, b, c in mesh.triangles]
    if random.random() < 0.5:
        gone = set(random.sample(range(len(triangles)), random.randrange(len(triangles))))
        kept = [t for i, t in enumerate(triangles) if i not in gone]
        edges = {frozenset(pair) for t in kept for pair in combinations(t, 2)}
        wanted = [pair for pair in wanted if frozenset(pair) in edges]
        triangles = kept
    return mesh.points.tolist(), triangles, wanted


def shape_meets(a: RationalPoint, b: RationalPoint, c: RationalPoint, d: RationalPoint) -> bool:
    """Tell whether two segments meet but in a common end."""
    signs = [oracles.orient(a, b, c), oracles.orient(a, b, d), oracles.orient(c, d, a), oracles.orient(c, d, b)]
    if signs[0] * signs[1] < 0 and signs[2] * signs[3] < 0:
        return True
    inner = [(p, (c, d)) for p in (a, b) if p not in (c, d)] + [(p, (a, b)) for p in (c, d) if p not in (a, b)]
    return any(oracles.on_segment(p, *line) for p, line in inner)


@pytest.mark.obligation(
    "V1", "the verifier decides Gabriel edges and circumcentres as brute force does", method="enumeration"
)
class TestCircles:
    """For sets of triangles over five points, one in eleven, with and without segments, and for meshes with holes: the
    verdicts are those of the definitions, visibility included."""

    @pytest.mark.parametrize("name", once_after(1, CONFIGURATIONS))
    def test_every_set(self, name: str, record_property: Record) -> None:
        points = CONFIGURATIONS[name]
        brute: list[RationalPoint] = oracles.rationals(points)

        class Brute:  # what all_sets asks for
            pass

        stub = Brute()
        stub.points = brute  # type: ignore[attr-defined]  # made for this test
        tried = 0
        for i, triangles in enumerate(all_sets(stub)):  # type: ignore[arg-type]  # as above
            tried += (i % 11 == 0) + (i % 29 == 0)
            if i % 11 == 0:
                assert not circle_faults(points, triangles, None), triangles
            if i % 29 == 0:
                assert not circle_faults(points, triangles, [(0, 1), (1, 2)]), triangles
        record_property("cases", tried)

    @pytest.mark.parametrize("seed", once_after(30, range(120)))
    def test_meshes(self, seed: int) -> None:
        points, triangles, segments = random_mesh(Random(seed))
        assert not circle_faults(points, triangles, segments), (points, triangles, segments)
        assert not circle_faults(points, triangles, None), (points, triangles)
        far = [(x * 2.0**-600, y * 2.0**-600) for x, y in points]
        assert not circle_faults(far, triangles, segments)

    def test_control_brute_force_tells_the_properties_apart(self) -> None:
        """Meshes that have one of the properties and not another."""
        seen: set[tuple[bool, ...]] = set()
        for seed in range(120):
            points, triangles, segments = random_mesh(Random(seed))
            seen.add(tuple(truths(oracles.rationals(points), triangles, segments).values()))
        assert len(seen) >= 3

    def test_an_invisible_corner_does_no_harm(self) -> None:
        """Two triangles with a gap between them: the apex of one lies in the circle of the other's edge, outside."""
        points = [(0.0, 0.0), (8.0, 0.0), (4.0, -5.0), (4.0, 1.0), (0.0, 9.0), (8.0, 9.0)]
        triangles = [(0, 2, 1), (3, 5, 4)]
        assert not circle_faults(points, triangles, None)
        assert verify(points, triangles, claims=["gabriel"]).ok
        assert not verify(points, [*triangles, (0, 1, 3)], claims=["gabriel"]).ok

    @pytest.mark.parametrize("seed", range(8))
    def test_located_centres(self, seed: int) -> None:
        """Hundreds of random points, not conforming: the centres outside are those that no triangle holds."""
        rng = np.random.default_rng(seed)
        points = rng.random((60, 2)) if seed % 2 else rng.integers(0, 12, (60, 2)).astype(float)
        mesh = delaunay(points * [4.0, 1.0])
        triangles = [tuple(t) for t in mesh.triangles.tolist()]
        if seed % 4 > 1:
            triangles = triangles[:: 1 + seed % 2 or 1][: len(triangles) // 2]
        report = verify(mesh.points, triangles, claims=CIRCLES)
        exact = oracles.rationals(mesh.points.tolist())
        solid = [[exact[v] for v in t] for t in triangles]
        outside = [
            i
            for i, corners in enumerate(solid)
            if not any(
                min(oracles.orient(p, q, z) for p, q in ((a, b), (b, c), (c, a))) >= 0
                for z in [oracles.circumcircle(*corners)[0]]
                for a, b, c in solid
            )
        ]
        finding = report.findings[Property.CIRCUMCENTRES_INSIDE]
        assert finding.count == len(outside)
        assert [v.triangles[0] for v in finding.violations] == outside[:100]


KITE = [(0.0, 0.0), (3.0, -1.0), (6.0, 0.0), (3.0, 1.0)]
HALVES = [(0, 1, 3), (1, 2, 3)]
SQUARE = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]
TWO = [(0, 1, 2), (0, 2, 3)]


@pytest.mark.obligation(
    "V1",
    "bounds on angles and areas are decided as in fractions, with witnesses",
    method="differential",
    control_in="TestAblation",
)
class TestBounds:
    """The violations are the triangles that the law of cosines and the shoelace formula find, in any orientation."""

    @pytest.mark.parametrize("seed", range(30))
    def test_random_triangles(self, seed: int) -> None:
        random = Random(seed)
        scale = 2.0 ** random.choice((0, 0, -600, 400))
        points = [(random.randrange(9) * scale, random.randrange(9) * scale) for _ in range(9)]
        triangles = [tuple(random.sample(range(9), 3)) for _ in range(12)]
        least, most = random.choice((10.0, 30.0, 45.0)), random.choice((60.0, 90.0, 135.0, 120.0))
        area = random.choice((4.0, 6.0, 10.5)) * scale * scale
        if area == 0.0 or math.isinf(area):
            area = random.choice((5e-324, 1.0))
        exact = oracles.rationals(points)
        report = verify(points, triangles, min_angle=least, max_angle=most, max_area=area, orientation="any")
        bounded = (Property.MIN_ANGLE, Property.MAX_ANGLE, Property.MAX_AREA)
        found = {p: sorted(v.triangles[0] for v in report.findings[p].violations) for p in bounded}
        solid = [oracles.orient(*(exact[v] for v in t)) != 0 for t in triangles]
        corners = [[exact[v] for v in t] for t in triangles]
        below = [i for i, c in enumerate(corners) if not solid[i] or shape_oracle.angle_below(c, least)]
        above = [i for i, c in enumerate(corners) if not solid[i] or shape_oracle.angle_above(c, most)]
        large = [i for i, c in enumerate(corners) if shape_oracle.area_above(c, area)]
        assert found[Property.MIN_ANGLE] == below
        assert found[Property.MAX_ANGLE] == above
        assert found[Property.MAX_AREA] == large

    def test_areas_of_triangles(self) -> None:
        """One a triangle; what is not positive or infinite bounds nothing."""
        assert verify(SQUARE, TWO, max_area=[2, 2]).ok
        assert verify(SQUARE, TWO, max_area=[-1, math.inf]).ok
        report = verify(SQUARE, TWO, max_area=[2, math.nextafter(2, 0)])
        (violation,) = report.findings[Property.MAX_AREA].violations
        assert (violation.triangles, violation.magnitude, violation.severity) == ((1,), Fraction(4), Severity.ROUNDING)

    def test_areas_of_regions(self) -> None:
        """The face that the point lies in is bounded, and no other; of two points the smaller area counts."""
        cut = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)]
        for area, seeds, ok in (
            (1.9, [(1.5, 0.5)], False),
            (2.0, [(1.5, 0.5)], True),
            (2.0, [(1.5, 0.5), (1.75, 0.5)], True),
            (-1.0, [(1.5, 0.5)], True),
        ):
            domain = PSLG(SQUARE, cut, regions=[(x, y, 0.0, area) for x, y in seeds])
            report = verify(SQUARE, TWO, domain=domain, claims=["region-areas"])
            assert report.ok is ok, (area, seeds)
            assert [v.triangles for v in report.findings[Property.REGION_AREAS].violations] == ([] if ok else [(0,)])
        both = PSLG(SQUARE, cut, regions=[(1.5, 0.5, 0.0, 9.0), (1.75, 0.5, 0.0, 1.0)])
        assert not verify(SQUARE, TWO, domain=both, claims=["region-areas"]).ok
        assert verify(SQUARE, TWO[::-1], domain=both).ok  # not claimed, not decided

    def test_witnesses(self) -> None:
        report = verify(KITE, HALVES, min_angle=37, max_angle=100)
        (first, second) = report.findings[Property.MIN_ANGLE].violations
        assert (first.kind, first.severity) == (Kind.SMALL_ANGLE, Severity.WRONG)
        assert first.degrees == second.degrees == pytest.approx(math.degrees(2 * math.atan2(1, 3)), abs=1e-12)
        assert "0 (0.0, 0.0), less than 37" in first.message
        document = json.loads(report.to_json())["properties"]["min_angle"]["violations"][0]
        assert document["degrees"] == first.degrees
        assert report.verdict(Property.MAX_ANGLE) is Verdict.HOLDS
        near = math.nextafter(45.0, 90.0)
        (violation, _) = verify(SQUARE, TWO, min_angle=near).findings[Property.MIN_ANGLE].violations
        assert violation.severity is Severity.ROUNDING
        assert verify(SQUARE, TWO, min_angle=45, max_angle=90, max_area=2).ok


@pytest.mark.obligation("V1", "bounds are claims; bad ones are typed errors", method="named cases")
class TestClaims:
    """What is given is claimed; what is claimed without being given is refused, and so are bounds that are none."""

    def test_given_is_claimed(self) -> None:
        report = verify(KITE, HALVES, min_angle=40)
        assert report.claims[-1] is Property.MIN_ANGLE
        assert not report.ok
        assert verify(KITE, HALVES, claims=["admissible"], max_area=3).claims == (
            Property.ADMISSIBLE,
            Property.MAX_AREA,
        )
        assert Property.MIN_ANGLE not in verify(KITE, HALVES).findings
        assert Property.GABRIEL not in verify(KITE, HALVES).findings

    def test_not_given(self) -> None:
        with pytest.raises(ChoiceError, match="min_angle cannot be claimed without min_angle="):
            verify(KITE, HALVES, claims=["min-angle"])
        with pytest.raises(ChoiceError, match="region_areas cannot be claimed without a domain"):
            verify(KITE, HALVES, claims=["region-areas"])

    @pytest.mark.parametrize("bad", [-1, 181, math.nan, math.inf, "20", [20]])
    def test_bad_angles(self, bad: float) -> None:
        with pytest.raises(BoundError, match="min_angle"):
            verify(KITE, HALVES, min_angle=bad)
        with pytest.raises(BoundError, match="max_angle"):
            verify(KITE, HALVES, max_angle=bad)

    @pytest.mark.parametrize("bad", [0, -1.0, math.nan, [1.0, math.nan]])
    def test_bad_areas(self, bad: float) -> None:
        with pytest.raises(BoundError, match="max_area"):
            verify(KITE, HALVES, max_area=bad)

    @pytest.mark.parametrize("bad", ["a", [1.0], [[1.0, 1.0]], [1j, 2j]])
    def test_bad_shapes(self, bad: object) -> None:
        with pytest.raises(ShapeError, match="max_area"):
            verify(KITE, HALVES, max_area=bad)  # type: ignore[call-overload]  # what an untyped caller passes

    def test_unreadable(self) -> None:
        report = verify([(0, 0), (1, math.nan), (0, 1)], [(0, 1, 2)], min_angle=20, claims=CIRCLES)
        for property_ in (*CIRCLES, Property.MIN_ANGLE):
            assert report.findings[property_].because == (Property.FINITE,)

    def test_no_area(self) -> None:
        report = verify([(0, 0), (1, 1), (2, 2)], [(0, 1, 2)], min_angle=20, max_area=1, claims=CIRCLES)
        for property_ in (Property.CIRCUMCENTRES_INSIDE, Property.MIN_ANGLE):
            assert report.findings[property_].violations[0].kind is Kind.ZERO_AREA
        assert report.verdict(Property.MAX_AREA) is Verdict.HOLDS

    def test_control_good_bounds(self) -> None:
        """None: bounds at the ends of their ranges are taken."""
        assert verify(KITE, HALVES, min_angle=0, max_angle=180, max_area=math.inf).claims[-3:] == (
            Property.MIN_ANGLE,
            Property.MAX_ANGLE,
            Property.MAX_AREA,
        )


def holds(*_: object) -> Finding:
    return Finding(Verdict.HOLDS)


def conforming(**changed: object) -> Report:
    """The report on a square with a point in the middle of its lower edge's circle."""
    points = [*SQUARE, (1.0, 0.25)]
    domain = PSLG(points, [(0, 1), (1, 2), (2, 3), (3, 0)])
    mesh = constrained_delaunay(domain)
    bounds: dict[str, object] = {"min_angle": 5, "max_angle": 160, "max_area": 1.75, **changed}
    return verify(mesh.points, mesh.triangles, domain=domain, claims=CONFORMING_TRIANGULATION, **bounds)  # type: ignore[call-overload, no-any-return]  # bounds by name


@pytest.mark.obligation("V2", "each condition about shapes is necessary", method="ablation")
class TestAblation:
    """A mesh that each check refuses passes when that check is taken out."""

    @pytest.mark.parametrize(
        ("name", "property_", "bounds"),
        [
            ("check_gabriel", Property.GABRIEL, {}),
            ("check_centres", Property.CIRCUMCENTRES_INSIDE, {}),
            ("check_angle_bound", Property.MIN_ANGLE, {"min_angle": 20}),
            ("check_angle_bound", Property.MAX_ANGLE, {"max_angle": 100}),
            ("check_areas", Property.MAX_AREA, {"max_area": 1}),
        ],
    )
    def test_control_missing_check(
        self, name: str, property_: Property, bounds: dict[str, object], monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """The checks of circles, angles and areas taken out, one by one."""
        assert conforming(**bounds).verdict(property_) is Verdict.FAILS
        monkeypatch.setattr(deciding, name, holds)
        assert conforming(**bounds).verdict(property_) is Verdict.HOLDS

    def test_control_the_theorem_needs_local_delaunay(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Without it, opposite corners say nothing of the corners behind them."""
        assert self._flipped().verdict(Property.GABRIEL) is Verdict.UNDECIDED
        monkeypatch.setattr(deciding, "is_locally_delaunay", lambda *_: True)
        assert self._flipped().verdict(Property.GABRIEL) is Verdict.HOLDS
        points, triangles = self.HIDDEN
        assert gabriel_oracle.encroachers(oracles.rationals(points), triangles, ())

    #: p = 4 lies inside the circle of 0 1, behind the edges of triangle 0 1 2, whose apex does not.
    HIDDEN = (
        [(0.0, 0.0), (10.0, 0.0), (20.0, 6.0), (9.0, 24.0), (5.0, 4.0), (-12.0, 15.0)],
        [(0, 1, 2), (0, 2, 4), (4, 2, 3), (4, 3, 5), (4, 5, 0)],
    )

    def _flipped(self) -> Report:
        return verify(*self.HIDDEN, claims=["gabriel"])

    def test_control_the_walk_needs_the_filter(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Rationals alone decide the same; a walk that believes whatever it finds does not."""
        rng = np.random.default_rng(3)
        mesh = delaunay(rng.random((40, 2)) * [9.0, 1.0])

        def count() -> int:
            return verify(mesh.points, mesh.triangles, claims=CIRCLES).findings[Property.CIRCUMCENTRES_INSIDE].count

        expected = count()
        assert expected > 0
        monkeypatch.setattr(centres, "find_centres", lambda *a: a[-1].fill(False))
        assert count() == expected
        monkeypatch.setattr(centres, "find_centres", lambda *a: a[-1].fill(True))
        assert count() == 0
