"""V2 for constrained meshes: polygons with holes, sound and corrupted; each condition is necessary; labels; input."""

import json
from collections.abc import Callable, Sequence
from random import Random

import numpy as np
import pytest
import shapely
from proofs_tests.verify.test_constrained import (
    DOMAINS,
    REGRESSIONS,
    SQUARE,
    WITH_SEGMENTS,
    Plain,
    Truth,
    all_sets,
    disagreements,
)
from proofs_tests.verify.test_verdicts import STAR

from exactkernel import NonFiniteError, ShapeError
from exactkernel.types import FloatArray, IntArray
from exactmesh import PSLG, constrained_delaunay
from exactmesh.errors import ChoiceError, PSLGError
from exactmesh.verify import (
    CONSTRAINED_TRIANGULATION,
    DOMAIN_TRIANGULATION,
    Domain,
    Finding,
    Kind,
    Property,
    Report,
    Verdict,
    constrained,
    cover,
    spokes,
    trial,
    verify,
)
from exactmesh.verify.properties import asked_properties, decided_properties

Points = Sequence[tuple[float, float]]
Pair = tuple[int, int]
Mesh = tuple[FloatArray, IntArray, Plain]


def holey(seed: int, side: int = 6) -> Mesh:
    """A grid of squares, cut in two each, some taken out; the domain has the long sides of what is left, the rims of
    the holes as unit segments, and a point in each square that is missing. Holes touch each other in corners."""
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(side), np.arange(side))
    points = np.stack([x.ravel(), 2.0 * y.ravel()], axis=1).astype(np.float64)
    low = (x + side * y)[:-1, :-1]
    kept = random.random(low.shape) < 0.75
    kept[0, :] = kept[-1, :] = kept[:, 0] = kept[:, -1] = True
    a = low[kept]
    triangles = np.vstack([np.stack([a, a + 1, a + side + 1], 1), np.stack([a, a + side + 1, a + side], 1)])
    last = side - 1
    corners = [0, last, side * side - 1, side * last]
    segments = list(zip(corners, corners[1:] + corners[:1], strict=True))
    for v in low[~kept].tolist():
        ring = [v, v + 1, v + side + 1, v + side]
        segments += zip(ring, ring[1:] + ring[:1], strict=True)
    holes = [(points[v, 0] + 0.5, points[v, 1] + 0.5) for v in low[~kept].tolist()]
    return points, triangles.astype(np.int32), Plain.of(points.tolist(), segments, holes)


def check(mesh: Mesh) -> Report:
    points, triangles, domain = mesh
    return verify(points, triangles, domain=domain)


def without_triangle(mesh: Mesh, random: Random) -> Mesh:
    points, triangles, domain = mesh
    return points, np.delete(triangles, random.randrange(len(triangles)), axis=0), domain


def with_hole_filled(mesh: Mesh, random: Random) -> Mesh:
    """Triangulate a hole, all the rest as it was."""
    points, triangles, domain = mesh
    x, y = random.choice(domain.holes.tolist())
    a, b, c, d = (
        int(np.flatnonzero((points == corner).all(axis=1))[0])
        for corner in ((x - 0.5, y - 0.5), (x + 0.5, y - 0.5), (x + 0.5, y + 1.5), (x - 0.5, y + 1.5))
    )
    return points, np.vstack([triangles, [[a, b, c], [a, c, d]]]).astype(np.int32), domain


def without_hole(mesh: Mesh, random: Random) -> Mesh:
    points, triangles, domain = mesh
    holes = np.delete(domain.holes, random.randrange(len(domain.holes)), axis=0)
    return points, triangles, Plain(domain.points, domain.segments, holes, domain.regions, domain.rule)


def with_segment(mesh: Mesh, random: Random) -> Mesh:
    """Ask for a diagonal that is not there, across a square that is."""
    points, triangles, domain = mesh
    low = random.choice(triangles[: len(triangles) // 2, 0].tolist())
    side = int(np.sqrt(len(points)))
    segments = np.vstack([domain.segments, [[low + 1, low + side]]]).astype(np.int32)
    return points, triangles, Plain(domain.points, segments, domain.holes, domain.regions, domain.rule)


def with_point(mesh: Mesh, random: Random) -> Mesh:
    """Ask for a point inside a triangle."""
    points, triangles, domain = mesh
    x, y = points[triangles[random.randrange(len(triangles))]].mean(axis=0)
    theirs = np.vstack([domain.points, [[x, y]]])
    return points, triangles, Plain(theirs, domain.segments, domain.holes, domain.regions, domain.rule)


def with_unused_point(mesh: Mesh, random: Random) -> Mesh:
    points, triangles, domain = mesh
    return np.vstack([points, points[triangles[random.randrange(len(triangles))]].mean(axis=0)]), triangles, domain


CORRUPTIONS: list[tuple[Callable[[Mesh, Random], Mesh], Property]] = [
    (without_triangle, Property.COVERS_DOMAIN),
    (with_hole_filled, Property.COVERS_DOMAIN),
    (without_hole, Property.COVERS_DOMAIN),
    (with_segment, Property.SEGMENTS_PRESENT),
    (with_point, Property.DOMAIN_POINTS),
    (with_unused_point, Property.CONSTRAINED_DELAUNAY),
]


@pytest.mark.obligation(
    "V2",
    "of a domain with holes, each corruption breaks the property that it should, with a witness",
    method="corruption",
)
class TestHoles:
    """A polygon with many holes, some of which touch, is what it claims to be; each corruption breaks the property
    that it is meant to break, with a witness."""

    @pytest.mark.parametrize("seed", range(6))
    def test_sound(self, seed: int) -> None:
        mesh = holey(seed)
        assert check(mesh).ok, check(mesh)
        assert check(mesh).verdict(Property.NO_NEW_POINTS) is Verdict.HOLDS
        points, triangles, domain = mesh
        shuffled = np.random.default_rng(seed).permutation(len(points))
        place = np.argsort(shuffled)
        assert verify(points[shuffled], place[triangles], domain=domain).ok  # another order of the points
        pslg = PSLG(domain.points, _once(domain.segments), holes=domain.holes)
        assert verify(points, triangles, domain=pslg).ok

    @pytest.mark.parametrize("seed", range(3))
    @pytest.mark.parametrize(("corrupt", "broken"), CORRUPTIONS, ids=[c.__name__ for c, _ in CORRUPTIONS])
    def test_control_corrupted(self, corrupt: Callable[[Mesh, Random], Mesh], broken: Property, seed: int) -> None:
        """Corruptions of triangles, points and segments of meshes with holes."""
        report = check(corrupt(holey(seed), Random(seed)))
        assert not report.ok
        assert report.verdict(broken) is Verdict.FAILS, report
        assert report.findings[broken].violations

    @pytest.mark.parametrize("seed", range(3))
    def test_steiner_points(self, seed: int) -> None:
        """The corners that the domain does not ask for are told, and break nothing else."""
        points, triangles, domain = holey(seed)
        used = np.unique(domain.segments)
        theirs, place = points[used], np.cumsum(np.isin(np.arange(len(points)), used)) - 1
        coarse = Plain(theirs, place[domain.segments].astype(np.int32), domain.holes, domain.regions, domain.rule)
        report = verify(points, triangles, domain=coarse)
        assert report.ok, report
        assert report.findings[Property.NO_NEW_POINTS].count == len(points) - len(used)

    def test_even_odd(self) -> None:
        """Rings say the same without points in holes, as long as holes share no side."""
        for seed in range(20):
            points, triangles, domain = holey(seed)
            if len(_once(domain.segments)) == len(domain.segments):
                rings = Plain(domain.points, domain.segments, domain.holes[:0], domain.regions, "even-odd")
                assert verify(points, triangles, domain=rings).ok
                assert not verify(points, triangles[1:], domain=rings).ok
                break
        else:
            pytest.fail("no such mesh")

    def test_large_coordinates(self) -> None:
        for factor in (2.0**-1060, 2.0**1015):
            points, triangles, domain = holey(0)
            scaled = Plain(domain.points * factor, domain.segments, domain.holes * factor, domain.regions, "seeds")
            assert verify(points * factor, triangles, domain=scaled).ok
            assert not verify(points * factor, triangles[1:], domain=scaled).ok


def _once(segments: IntArray) -> IntArray:
    return np.unique(np.sort(segments, axis=1), axis=0)


HOLDING = Finding(Verdict.HOLDS)


def holds(*_: object) -> Finding:
    return HOLDING


def nothing(*_: object) -> list[Finding]:
    return []


def nobody(survey: cover.Survey, *_: object) -> object:
    return np.zeros(len(survey.faces.plane.face), dtype=np.bool_)


ABLATIONS: list[tuple[object, str, object]] = [
    (trial, "check_inner_parts", holds),
    (trial, "check_outer_parts", holds),
    (trial, "check_cover", holds),
    (constrained, "check_constrained", lambda *_: HOLDING),
    (trial, "_domain_points", holds),
    (trial, "_new_points", holds),
    (constrained, "check_circles", holds),
    (cover, "_against_faces", nothing),
    (cover, "carved_faces", nobody),
    (cover, "joined_marks", lambda *_: None),
    (trial, "is_one_loop", lambda *_: True),
]


@pytest.mark.obligation(
    "V2", "without any one check of segments and domains the verifier contradicts brute force", method="ablation"
)
class TestAblation:
    """Without any one of its checks the verifier contradicts brute force somewhere, so none is superfluous."""

    @pytest.mark.once
    @pytest.mark.parametrize(("module", "name", "instead"), ABLATIONS, ids=[name for _, name, _ in ABLATIONS])
    def test_control_missing_check(
        self, module: object, name: str, instead: object, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """The checks of the verifier taken out, one by one."""
        cases = [(points, Plain.of(*rest)) for points, rest in ((case[0], case[1:]) for case in DOMAINS.values())]
        monkeypatch.setattr(module, name, instead)  # with it nothing disagrees: TestEverySet
        for points, domain in cases:
            truth = Truth(points, (), domain)
            if any(disagreements(truth, triangles) for triangles in list(all_sets(points))[::4]):
                return
        assert any(disagreements(Truth(points, (), domain), rows) for points, rows, domain in REGRESSIONS)

    def test_double_cover(self) -> None:
        """Theorem G: the star that winds twice has its rim on segments, positive triangles and matched edges."""
        triangles = [(0, 1 + i, 1 + (i + 1) % 5) for i in range(5)]
        rim = [(1 + i, 1 + (i + 1) % 5) for i in range(5)]
        report = verify(STAR, triangles, domain=Plain.of(STAR, rim))
        assert report.verdict(Property.SEGMENTS_PRESENT) is Verdict.HOLDS
        assert report.verdict(Property.ADMISSIBLE) is Verdict.FAILS
        assert report.findings[Property.COVERS_DOMAIN].because == (Property.ADMISSIBLE,)
        assert not report.ok


QUARTERS = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
SPOKES = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (4, 2)]


def labelled(labels: Sequence[float], regions: Sequence[tuple[float, float, float]], holes: Points = ()) -> Finding:
    domain = Plain.of(SQUARE, SPOKES, holes)
    with_regions = Plain(domain.points, domain.segments, domain.holes, np.array(regions).reshape(-1, 3), "seeds")
    return verify(SQUARE, QUARTERS, domain=with_regions, labels=labels).findings[Property.REGIONS]


@pytest.mark.obligation(
    "V1",
    "labels are right iff they are constant on each face between segments and those of the regions' points",
    method="enumeration",
)
class TestRegions:
    """Labels are constant across edges that lie on no segment, and where a region's point lies they are its attribute.
    The diagonal 0-4-2 of a square parts its four quarters into two faces."""

    def test_sound(self) -> None:
        assert labelled([7, 7, 3, 3], [(1.5, 1, 7), (0.5, 1, 3)]).verdict is Verdict.HOLDS
        assert labelled([7, 7, 3, 3], [(1.5, 1, 7)]).verdict is Verdict.HOLDS
        assert labelled([7, 7, 7, 7], []).verdict is Verdict.HOLDS
        assert labelled([7, 7, 3, 3], [(1.5, 1, 8), (1.5, 0.5, 7)]).verdict is Verdict.HOLDS  # one of them
        assert labelled([7, 7, 3, 3], [(5, 5, 1), (1, 1, 2), (0.5, 0.5, 2)]).verdict is Verdict.HOLDS  # in no face

    def test_control_wrong(self) -> None:
        """Labels that differ within a face, or are not the point's."""
        differ = labelled([7, 3, 3, 3], [])
        assert [violation.kind for violation in differ.violations] == [Kind.LABELS_DIFFER]
        assert sorted(differ.violations[0].triangles) == [0, 1]
        wrong = labelled([7, 7, 3, 3], [(1.5, 1, 3), (0.5, 1, 3)])
        assert [violation.kind for violation in wrong.violations] == [Kind.WRONG_LABEL]
        assert wrong.violations[0].triangles[0] in (0, 1)
        assert labelled([7, 7, np.nan, np.nan], []).verdict is Verdict.FAILS

    def test_every_labelling(self) -> None:
        """Of two labels a quarter: right are those that are constant on the two halves, and right at the point."""
        for bits in range(16):
            labels = [bits >> i & 1 for i in range(4)]
            right = labels[0] == labels[1] == 1 and labels[2] == labels[3]
            for turn in (QUARTERS, [(a, c, b) for a, b, c in QUARTERS]):
                domain = Plain.of(SQUARE, SPOKES)
                seed = Plain(domain.points, domain.segments, domain.holes, np.array([[1.25, 1.0, 1.0]]), "seeds")
                report = verify(SQUARE, turn, domain=seed, labels=labels, orientation="any")
                assert (report.verdict(Property.REGIONS) is Verdict.HOLDS) is right
                assert report.ok is right

    def test_without_domain(self) -> None:
        report = verify(SQUARE, QUARTERS, segments=[(0, 2)], labels=np.array([[1], [1], [2], [2]]))
        assert report.ok
        assert Property.REGIONS in report.claims
        assert verify(SQUARE, QUARTERS, segments=[(1, 3)], labels=[1, 1, 2, 2]).verdict(Property.REGIONS) is (
            Verdict.FAILS
        )
        missing = verify(SQUARE, QUARTERS[:2], segments=[(1, 3)], labels=[1, 1])
        assert missing.findings[Property.REGIONS].because == (Property.SEGMENTS_PRESENT,)


@pytest.mark.obligation(
    "V1",
    "segments through vertices of large degree, found by angle, are judged as by brute force",
    method="enumeration",
    control_in="TestAblation",
)
class TestBundles:
    """Chains through vertices of large degree are found by angle: the verdicts are the same."""

    @pytest.mark.parametrize("name", ["through a vertex", "inside", "two at one position"])
    def test_every_set(self, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(spokes, "_LARGE", 0)
        points, segments = WITH_SEGMENTS[name]
        truth = Truth(points, segments)
        for triangles in list(all_sets(points))[::3]:
            assert not disagreements(truth, triangles), triangles

    def test_a_bundle(self) -> None:
        """Segments through the centre of a fan."""
        n = 50
        upper = [(2 * i - n + 1.0, float(n)) for i in range(n)]
        points = np.array([(0.0, 0.0), *upper, *((-x, -y) for x, y in upper)])
        order = np.argsort(np.arctan2(points[1:, 1], points[1:, 0])) + 1
        fan = np.stack([np.zeros(2 * n, dtype=np.int64), order, np.roll(order, -1)], axis=1)
        through = [(1 + i, 1 + n + i) for i in range(n)]
        assert verify(points, fan, segments=through).verdict(Property.SEGMENTS_PRESENT) is Verdict.HOLDS
        missed = verify(points, fan, segments=[*through, (1, n + 7), (n + 1, n)])
        assert [violation.vertices for violation in missed.findings[Property.SEGMENTS_PRESENT].violations] == [
            (1, n + 7)
        ]


class TestInput:
    """Claims follow what is given; bad input is refused by name; a PSLG is a domain."""

    def test_claims(self) -> None:
        rim = SPOKES[:4]
        assert verify(SQUARE, QUARTERS, segments=rim).claims == CONSTRAINED_TRIANGULATION
        assert verify(SQUARE, QUARTERS, domain=PSLG(SQUARE, rim)).claims == DOMAIN_TRIANGULATION
        report = verify(SQUARE, QUARTERS, segments=rim, claims=["constrained-delaunay", Property.SEGMENTS_PRESENT])
        assert report.claims == (Property.SEGMENTS_PRESENT, Property.CONSTRAINED_DELAUNAY)
        with pytest.raises(ChoiceError, match="covers_domain cannot be claimed without a domain"):
            verify(SQUARE, QUARTERS, segments=rim, claims=["covers-domain"])
        with pytest.raises(ChoiceError, match="without labels"):
            verify(SQUARE, QUARTERS, segments=rim, claims=["regions"])

    def test_what_is_asked(self) -> None:
        plain = verify(SQUARE, QUARTERS)
        asked = asked_properties(segments=False, domain=False, labels=False)
        assert tuple(plain.findings) == decided_properties(asked, plain.claims)
        assert plain.verdict(Property.COVERS_DOMAIN) is Verdict.UNDECIDED
        full = verify(SQUARE, QUARTERS, domain=PSLG(SQUARE, SPOKES), labels=[0] * 4)
        on_claim = {Property.GABRIEL, Property.CIRCUMCENTRES_INSIDE, Property.REGION_AREAS}
        bounds = {Property.MIN_ANGLE, Property.MAX_ANGLE, Property.MAX_AREA, Property.MAX_LENGTH, Property.VORONOI_DUAL}
        assert set(full.findings) == set(Property) - on_claim - bounds - {Property.CONVEX}
        document = json.loads(full.to_json())
        assert document["properties"]["covers_domain"]["verdict"] == "holds"
        assert "+ constrained_delaunay holds" in str(full)

    def test_segments_and_domain(self) -> None:
        """With both, the mesh's own segments are what is exempt from Delaunay, and all are looked for."""
        points = [(0, 0), (3, -1), (6, 0), (3, 1)]
        halves, rim = [(0, 1, 2), (0, 2, 3)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        domain = PSLG(points, [*rim, (0, 2)])
        assert verify(points, halves, domain=domain).ok
        report = verify(points, halves, domain=domain, segments=rim)
        assert report.verdict(Property.CONSTRAINED_DELAUNAY) is Verdict.FAILS
        assert report.verdict(Property.SEGMENTS_PRESENT) is report.verdict(Property.COVERS_DOMAIN) is Verdict.HOLDS
        both = verify(points, halves, domain=PSLG(points, [*rim, (1, 3)]), segments=[(1, 3)])
        assert both.findings[Property.SEGMENTS_PRESENT].count == 2

    @pytest.mark.parametrize(
        ("segment", "kind"),
        [
            ((0, 5), Kind.OUT_OF_RANGE),
            ((-1, 2), Kind.OUT_OF_RANGE),
            ((2**40, 2), Kind.OUT_OF_RANGE),
            ((3, 3), Kind.NO_SEGMENT),
            ((1, 3), Kind.MISSING_SEGMENT),
        ],
    )
    def test_bad_segments_are_findings(self, segment: Pair, kind: Kind) -> None:
        halves = [(0, 1, 2), (0, 2, 3)]
        report = verify(SQUARE, halves, segments=[(0, 2), segment])
        assert [violation.kind for violation in report.findings[Property.SEGMENTS_PRESENT].violations] == [kind]
        assert verify(SQUARE, halves, segments=np.array([(0, 2)], dtype=np.uint8), claims="segments_present").ok

    def test_bad_domains(self) -> None:
        with pytest.raises(PSLGError, match="segment 0"):
            verify(SQUARE, QUARTERS, domain=Plain.of(SQUARE, [(0, 7), (1, 1)]))
        with pytest.raises(PSLGError, match="odd number of segments ends"):
            verify(SQUARE, QUARTERS, domain=Plain.of(SQUARE, SPOKES, (), "even-odd"))
        with pytest.raises(ChoiceError, match="no rule"):
            verify(SQUARE, QUARTERS, domain=Plain.of(SQUARE, SPOKES, (), "nonzero"))
        with pytest.raises(NonFiniteError):
            verify(SQUARE, QUARTERS, domain=Plain.of([*SQUARE, (np.nan, 0)], SPOKES))
        with pytest.raises(ShapeError, match="labels"):
            verify(SQUARE, QUARTERS, domain=Plain.of(SQUARE, SPOKES), labels=[1])
        with pytest.raises(ShapeError, match=r"segments has shape \(1, 3\)"):
            verify(SQUARE, QUARTERS, segments=[(0, 1, 2)])
        with pytest.raises(ShapeError, match="53"):
            verify(SQUARE, QUARTERS, segments=[(0, 1)], labels=[2**53 + 1] * 4)

    @pytest.mark.parametrize(
        ("domain", "words"),
        [
            (shapely.Polygon(SQUARE[:4]), "expected a PSLG, not a Polygon: make one with PSLG.from_shapely"),
            (
                {"points": SQUARE, "segments": SPOKES},
                r"not a dict: make one with PSLG\(points, segments\)$",
            ),
            ({"vertices": SQUARE, "segments": SPOKES}, r"PSLG\(domain\['vertices'\], domain\['segments'\]\)$"),
            ({"vertices": 0, "segments": 0, "holes": 0}, r", holes=domain\['holes'\]\)$"),
            ({"type": "Polygon"}, "make one with PSLG.from_geojson$"),
            (constrained_delaunay(PSLG(SQUARE, SPOKES)), "expected a PSLG, not a Triangulation: give its .domain"),
            (SQUARE, "expected a PSLG, not a list"),
        ],
    )
    def test_what_is_no_domain(self, domain: object, words: str) -> None:
        with pytest.raises(ShapeError, match=words):
            verify(SQUARE, QUARTERS, domain=domain)  # type: ignore[call-overload]  # a wrong type

    def test_unreadable(self) -> None:
        report = verify([*SQUARE[:4], (np.nan, 1)], QUARTERS, domain=PSLG(SQUARE, SPOKES))
        assert report.findings[Property.COVERS_DOMAIN].because == (Property.FINITE,)

    def test_a_pslg_is_a_domain(self) -> None:
        domain: Domain = PSLG(SQUARE, SPOKES[:4])
        assert verify(SQUARE, QUARTERS, domain=domain).ok

    def test_no_triangles(self) -> None:
        assert verify([], [], domain=Plain.of([], [])).ok
        assert verify([], [], domain=Plain.of(SQUARE, SPOKES[:3])).verdict(Property.COVERS_DOMAIN) is Verdict.HOLDS
        assert verify([], [], domain=Plain.of(SQUARE, SPOKES)).verdict(Property.COVERS_DOMAIN) is Verdict.FAILS
