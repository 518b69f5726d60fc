"""V1 and V2: ten thousand corrupted meshes, every verdict on each of them held against brute force."""

from collections.abc import Iterator
from math import isqrt
from random import Random

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.recording import Record
from proofs_tests.verify.corrupted_oracle import Area, Case, Truth
from proofs_tests.verify.test_constrained import Plain

from exactmesh.errors import OptionError
from exactmesh.strategies import Corrupted, Corruption, PlainMesh, corrupt
from exactmesh.strategies.naive import Place, flipped, inner_quads, is_convex, legalized, opposites, swept
from exactmesh.verify import Finding, Kind, Property, Report, Verdict, Violation, constrained, deciding, trial, verify

CHUNKS, EACH = 40, 250
"""10,000 meshes in all."""
BASES = 12
"""Sound meshes of a chunk; few, so that brute force meets the same pairs of triangles again."""

#: Claimed, so that they are decided; what else there is is decided anyway.
CIRCLES = (Property.GABRIEL, Property.CIRCUMCENTRES_INSIDE)

#: What has to fail, by the enum, where a verdict is left open.
ALLOWED: dict[Property, set[Property]] = {
    Property.COVERS_HULL: {Property.ADMISSIBLE},
    Property.DELAUNAY: {Property.ADMISSIBLE, Property.COVERS_HULL},
    Property.SEGMENTS_PRESENT: {Property.ADMISSIBLE},
    Property.CONSTRAINED_DELAUNAY: {Property.ADMISSIBLE, Property.SEGMENTS_PRESENT},
    Property.COVERS_DOMAIN: {Property.ADMISSIBLE, Property.SEGMENTS_PRESENT},
    Property.DOMAIN_POINTS: {Property.COVERS_DOMAIN},
    Property.REGIONS: {Property.ADMISSIBLE, Property.SEGMENTS_PRESENT},
    Property.GABRIEL: {
        Property.ADMISSIBLE,
        Property.SEGMENTS_PRESENT,
        Property.DELAUNAY,
        Property.CONSTRAINED_DELAUNAY,
    },
    Property.CIRCUMCENTRES_INSIDE: {Property.ADMISSIBLE},
}
#: What brute force can say only of admissible meshes.
NEEDS_ADMISSIBLE = {
    Property.COVERS_HULL,
    Property.CONSTRAINED_DELAUNAY,
    Property.COVERS_DOMAIN,
    Property.REGIONS,
    *CIRCLES,
}
#: What fails of a triangle without area.
NEEDS_AREA = {Property.CONSTRAINED_DELAUNAY, Property.CIRCUMCENTRES_INSIDE}
#: And what only of those whose segments are there.
NEEDS_SEGMENTS = {Property.CONSTRAINED_DELAUNAY, Property.COVERS_DOMAIN, Property.REGIONS, Property.GABRIEL}

#: In which way each corruption breaks what it breaks.
KINDS: dict[Corruption, set[Kind]] = {
    Corruption.FLIPPED: {Kind.CLOCKWISE},
    Corruption.SWAPPED: {Kind.CLOCKWISE},
    Corruption.DUPLICATED: {Kind.REPEATED_EDGE},
    Corruption.DROPPED: {Kind.NOT_COVERED, Kind.REFLEX_BOUNDARY, Kind.DISCONNECTED, Kind.POINT_OUTSIDE},
    Corruption.DROPPED_POINT: {Kind.UNUSED_POINT},
    Corruption.EXTRA_POINT: {Kind.UNUSED_POINT},
    Corruption.EXTRA_COPY: {Kind.COINCIDENT_POINTS},
    Corruption.CRACKED: {Kind.COINCIDENT_POINTS},
    Corruption.MOVED: {Kind.CLOCKWISE},
    Corruption.REWIRED: {Kind.OVERLAP, Kind.CROSSING, Kind.HANGING_NODE, Kind.ZERO_AREA},
    Corruption.MERGED: {Kind.OVERLAP, Kind.CROSSING, Kind.HANGING_NODE, Kind.ZERO_AREA},
    Corruption.PINCHED: {Kind.BROKEN_FAN},
    Corruption.DOUBLE_COVERED: {Kind.CROSSING, Kind.OVERLAP},
    Corruption.OVERLAID: {Kind.OVERLAP, Kind.CROSSING, Kind.HANGING_NODE},
    Corruption.HANGING_NODE: {Kind.HANGING_NODE},
    Corruption.FLATTENED: {Kind.ZERO_AREA},
    Corruption.WRONG_EDGE: {Kind.POINT_IN_CIRCLE},
    Corruption.OUT_OF_RANGE: {Kind.OUT_OF_RANGE},
    Corruption.REPEATED_CORNER: {Kind.REPEATED_CORNER},
    Corruption.NOT_FINITE: {Kind.NOT_FINITE},
    Corruption.MISSING_SEGMENT: {Kind.MISSING_SEGMENT},
    Corruption.LOST_SEGMENT: {Kind.MISSING_SEGMENT},
    Corruption.MISLABELED: {Kind.LABELS_DIFFER},
}


def base(random: Random) -> PlainMesh:
    """A triangulation of five to nine points of a small grid; mostly Delaunay; sometimes far off or tiny."""
    size = random.choice((5, 6, 7, 8, 9))
    side = isqrt(size) + random.choice((1, 1, 2, 6))
    places: list[Place] = [(2 * (k % side), 2 * (k // side)) for k in random.sample(range(side * side), size)]
    triangles = swept(places)
    if not triangles:
        return base(random)
    if random.random() < 0.8:
        triangles = legalized(places, triangles)
    for _ in range(random.choice((0, 0, 0, 3))):
        quads = [quad for quad in inner_quads(triangles) if is_convex(places, quad)]
        triangles = flipped(triangles, random.choice(quads)) if quads else triangles
    shift, exponent = random.choice(((0, 0), (0, 0), (0, 0), (2**30, 0), (0, -600), (0, 500)))
    points = np.ldexp(np.array(places, dtype=np.float64) + shift, exponent)
    return PlainMesh(points, np.array(triangles, dtype=np.int32))


def spoilt(random: Random, bases: list[PlainMesh], kind: Corruption) -> tuple[PlainMesh, Corrupted]:
    """A mesh with that fault, and what it was before."""
    while True:
        mesh = random.choice(bases)
        try:
            return mesh, corrupt(mesh, kind, random.randrange(2**30))
        except OptionError:  # no place for it
            continue


def rows_of(mesh: PlainMesh | Corrupted) -> list[tuple[int, int, int]]:
    return [(a, b, c) for a, b, c in mesh.triangles.tolist()]


def places_of(mesh: PlainMesh | Corrupted) -> list[tuple[float, float]]:
    return [(x, y) for x, y in mesh.points.tolist()]


def plain_case(random: Random, mesh: Corrupted) -> Case:
    """Without segments, or with those that the fault needs."""
    segments = None if mesh.segments is None else [(a, b) for a, b in mesh.segments.tolist()]
    labels = None if mesh.labels is None else mesh.labels.tolist()
    bounds = None
    if random.random() < 0.3:
        low, high = random.choice(((20.0, 90.0), (45.0, 135.0), (30.0, 100.0)))
        bounds = (low, high, random.choice((2.0, 4.0, 1e-300)))
    return Case(places_of(mesh), rows_of(mesh), segments, labels, None, bounds, random.random() < 0.1)


def segment_case(random: Random, before: PlainMesh, mesh: Corrupted) -> Case:
    """With a few edges of the sound mesh as segments, and labels."""
    edges = [(q.a, q.b) for q in inner_quads(rows_of(before))]
    chosen = random.sample(edges, min(len(edges), random.choice((1, 2, 4))))
    labels = [float(random.random() < 0.1) for _ in range(len(mesh.triangles))]
    return Case(places_of(mesh), rows_of(mesh), chosen, labels, None, circles=random.random() < 0.1)


def domain_case(random: Random, bases: list[PlainMesh], kind: Corruption) -> Case:
    """With a domain: some triangles of a sound mesh, which are spoilt then; its points are numbered anew."""
    while True:
        mesh = random.choice(bases)
        kept = [t for t in rows_of(mesh) if random.random() < 0.8]
        if not kept:
            continue
        try:
            spoilt_part = corrupt(PlainMesh(mesh.points, np.array(kept, dtype=np.int32)), kind, random.randrange(2**30))
        except OptionError:
            continue
        break
    number = random.sample(range(len(mesh.points)), len(mesh.points))
    points = [(0.0, 0.0)] * len(number)
    for v, place in enumerate(places_of(mesh)):
        points[number[v]] = place
    opposite = opposites(kept)
    segments = [(a, b) for a, b in opposite if (b, a) not in opposite or (a < b and random.random() < 0.2)]
    holes = [mesh.points[list(t)].T @ (0.5, 0.25, 0.25) for t in rows_of(mesh) if t not in kept]
    area = Area(
        points,
        [(number[a], number[b], number[c]) for a, b, c in kept],
        [(number[a], number[b]) for a, b in segments],
        [(x, y) for x, y in np.array(holes).reshape(-1, 2).tolist()],
    )
    return Case(places_of(spoilt_part), rows_of(spoilt_part), None, None, area, circles=random.random() < 0.1)


def asked(case: Case) -> Report:
    """What the verifier says."""
    low, high, area = case.bounds or (None, None, None)
    domain = None
    if case.area is not None:
        domain = Plain.of(case.area.points, case.area.segments, case.area.holes)
    return verify(
        case.points,
        np.array(case.triangles, dtype=np.int32).reshape(-1, 3),
        segments=case.segments,
        domain=domain,
        labels=case.labels,
        min_angle=low,
        max_angle=high,
        max_area=area,
        claims=CIRCLES if case.circles else None,
    )


def verdict_faults(report: Report, truth: Truth) -> Iterator[str]:
    """Where a decided verdict is wrong, or one is left open without a reason that the enum states."""
    for property_, finding in report.findings.items():
        if finding.verdict is Verdict.UNDECIDED:
            yield from _open_faults(report, property_, finding)
        elif property_ in NEEDS_AREA and not truth.solid:
            if finding.verdict is Verdict.HOLDS:
                yield f"{property_} holds of a triangle without area"
        elif property_ in NEEDS_ADMISSIBLE and not truth.admissible:
            if finding.verdict is Verdict.HOLDS or property_ is not Property.GABRIEL:
                yield f"{property_} {finding.verdict} of what is not admissible"
        elif property_ in NEEDS_SEGMENTS and truth.triangles and not truth.segments_present:
            if finding.verdict is Verdict.HOLDS:
                yield f"{property_} holds without its segments"
        elif (finding.verdict is Verdict.HOLDS) is not truth.ask(property_):
            yield f"{property_} {finding.verdict}"
        fails = finding.verdict is Verdict.FAILS
        if fails is not (finding.count > 0) or bool(finding.violations) is not fails:
            yield f"{property_} {finding.verdict} with {finding.count} violations"


def _open_faults(report: Report, property_: Property, finding: Finding) -> Iterator[str]:
    allowed = ALLOWED.get(property_, set())
    if not finding.because or any(
        missing not in allowed or report.verdict(missing) is Verdict.HOLDS for missing in finding.because
    ):
        yield f"{property_} undecided because of {finding.because}"


def unreadable_faults(case: Case, report: Report) -> Iterator[str]:
    """Of points that are not finite, and indices that are none, only three verdicts are given."""
    finite = all(np.isfinite(p).all() for p in case.points)
    n = len(case.points)
    valid = all(len({a, b, c}) == 3 and min(a, b, c) >= 0 and max(a, b, c) < n for a, b, c in case.triangles)
    expected = {Property.FINITE: finite, Property.INDICES: valid}
    if finite:
        expected[Property.DISTINCT_POINTS] = len(set(case.points)) == n
    for property_, finding in report.findings.items():
        if property_ in expected:
            if finding.verdict is not (Verdict.HOLDS if expected[property_] else Verdict.FAILS):
                yield f"{property_} {finding.verdict}"
        elif finding.verdict is not Verdict.UNDECIDED:
            yield f"{property_} {finding.verdict} of what cannot be read"


def witness_faults(report: Report, truth: Truth) -> Iterator[str]:
    """Where a witness does not show what it says."""
    for violation in report.violations:
        if not shows(violation, truth):
            yield f"{violation}"


def shows(violation: Violation, truth: Truth) -> bool:
    """Recompute what a witness says, for the kinds that say it in numbers or indices alone."""
    if violation.property is Property.ORIENTATION:
        (row,) = violation.triangles
        value = truth.turn(truth.triangles[row])
        return value <= 0 and value == (violation.magnitude or 0) and (value < 0) is (violation.kind is Kind.CLOCKWISE)
    if violation.kind is Kind.UNUSED_POINT:
        return not any(v in t for t in truth.triangles for v in violation.vertices)
    if violation.kind is Kind.COINCIDENT_POINTS:
        return len({truth.points[v] for v in violation.vertices}) == 1 < len(violation.vertices)
    if violation.kind is Kind.POINT_IN_CIRCLE and violation.magnitude is not None:
        a, b, c, d = (truth.points[v] for v in violation.vertices)
        centre, radius = oracles.circumcircle(a, b, c)
        excess = radius - oracles.squared_distance(centre, d)
        return excess > 0 and violation.magnitude == excess * abs(oracles.orient(a, b, c))
    return True


def faults(case: Case, report: Report) -> list[str]:
    """Everything in which the verifier's report on a case contradicts brute force."""
    n = len(case.points)
    if not np.isfinite(case.points).all() or any(len(set(t)) < 3 or min(t) < 0 or max(t) >= n for t in case.triangles):
        return list(unreadable_faults(case, report))
    truth = Truth(case)
    return [*verdict_faults(report, truth), *witness_faults(report, truth)]


def reason_faults(kind: Corruption, report: Report) -> list[str]:
    """Whether the report says of a corrupted mesh what is wrong with it."""
    broken = kind.breaks
    if broken is None:
        return []
    finding = report.findings[broken]
    told = {violation.kind for violation in finding.violations}
    if finding.verdict is not Verdict.FAILS or not told & KINDS[kind]:
        return [f"{kind}: {broken} {finding.verdict}, {sorted(told)}"]
    return []


def chunk(seed: int, count: int = EACH) -> Iterator[tuple[Corruption, Case, bool]]:
    """Corrupted meshes, all kinds in turn, and whether the fault must be named: in a part of a mesh it may be none."""
    random = Random(seed)
    bases = [base(random) for _ in range(BASES)]
    kinds = list(Corruption)
    for i in range(count):
        kind = kinds[(seed + i) % len(kinds)]
        way = random.randrange(3)
        if way == 0 or kind.breaks in (Property.SEGMENTS_PRESENT, Property.REGIONS):
            yield kind, plain_case(random, spoilt(random, bases, kind)[1]), True
        elif way == 1:
            yield kind, segment_case(random, *spoilt(random, bases, kind)), True
        else:
            yield kind, domain_case(random, bases, kind), False


def contradictions(seed: int, count: int = EACH) -> Iterator[tuple[list[str], Case]]:
    """The cases of a chunk that the verifier gets wrong."""
    for kind, case, is_named in chunk(seed, count):
        report = asked(case)
        found = faults(case, report) + (reason_faults(kind, report) if is_named else [])
        if found:
            yield found, case


@pytest.mark.obligation(
    "V1",
    "of 10,000 corrupted meshes every verdict is that of brute force",
    method="corruption",
    control_in="TestKnockedOut",
)
@pytest.mark.obligation(
    "V2",
    "each of 10,000 corrupted meshes is rejected for the right reason, or accepted rightly",
    method="corruption",
    control_in="TestKnockedOut",
)
class TestTenThousand:
    """Every kind of fault, in meshes of the hull and of domains, with and without segments and labels: each verdict of
    each property is that of brute force, what is left open is so for a reason that does not hold, the fault is among
    what is named, in the right way, and witnesses show what they say."""

    @pytest.mark.parametrize(
        "seed", [pytest.param(seed, marks=[pytest.mark.compiled] if seed else []) for seed in range(CHUNKS)]
    )
    def test_verdicts(self, seed: int, record_property: Record) -> None:
        assert next(contradictions(seed), None) is None
        record_property("cases", EACH)

    def test_there_are_ten_thousand(self) -> None:
        assert CHUNKS * EACH == 10_000
        cases = list(chunk(0))
        assert {kind for kind, _, _ in cases} == set(Corruption)
        ways = {(case.segments is None, case.area is None) for _, case, _ in cases}
        assert ways == {(True, True), (False, True), (True, False)}

    def test_what_is_legal_is_accepted(self) -> None:
        """A swap among cocircular points never does harm, a shift by one ulp may, and all the others do."""
        random = Random(1)
        bases = [base(random) for _ in range(60)]
        sound = [mesh for mesh in bases if verify(mesh.points, mesh.triangles).ok]
        answers: dict[Corruption, set[bool]] = {kind: set() for kind in Corruption}
        for kind in Corruption:
            for _ in range(25):
                case = plain_case(random, spoilt(random, sound, kind)[1])
                claims = None if case.segments is None else ("segments_present",)
                claims = claims if case.labels is None else ("regions",)
                report = verify(case.points, case.triangles, segments=case.segments, labels=case.labels, claims=claims)
                answers[kind].add(report.ok)
        assert answers.pop(Corruption.COCIRCULAR_SWAP) == {True}
        assert answers.pop(Corruption.SHIFTED) == {True, False}
        assert set(map(frozenset, answers.values())) == {frozenset({False})}


HOLDING = Finding(Verdict.HOLDS)


def holds(*_: object) -> Finding:
    return HOLDING


#: Every decision of the verifier that stands alone, and what takes its place.
KNOCKED_OUT: list[tuple[object, str, object]] = [
    (deciding, "check_orientation", holds),
    (deciding, "check_used", holds),
    (deciding, "check_edges", holds),
    (deciding, "check_fans", holds),
    (deciding, "check_zero_area", holds),
    (deciding, "check_overlap", holds),
    (deciding, "check_sweep", holds),
    (deciding, "check_hull", holds),
    (deciding, "check_distinct", holds),
    (deciding, "check_delaunay", holds),
    (deciding, "check_angles", holds),
    (deciding, "check_angle_bound", holds),
    (deciding, "check_areas", holds),
    (deciding, "check_gabriel", holds),
    (deciding, "check_centres", holds),
    (deciding, "enclosed_points", lambda *_: np.empty(0, dtype=np.intp)),
    (constrained, "check_constrained", lambda *_: HOLDING),
    (constrained, "check_circles", holds),
    (trial, "check_cover", holds),
    (trial, "check_inner_parts", holds),
    (trial, "_domain_points", holds),
    (trial, "_new_points", holds),
]


@pytest.mark.obligation(
    "V2",
    "without any one of its decisions the verifier misjudges one of the 10,000 corrupted meshes",
    method="ablation",
)
class TestKnockedOut:
    """The negative control of the ten thousand: without any one of its decisions the verifier is caught by them."""

    @pytest.mark.parametrize(("module", "name", "instead"), KNOCKED_OUT, ids=[name for _, name, _ in KNOCKED_OUT])
    def test_control_missing_check(
        self, module: object, name: str, instead: object, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """The checks of the verifier taken out, one by one."""
        monkeypatch.setattr(module, name, instead)
        for seed in range(4):
            try:
                if next(contradictions(seed), None) is not None:
                    return
            except (ValueError, IndexError):  # what rests on the check cannot do without it
                return
        raise AssertionError(f"nobody misses {name}")
