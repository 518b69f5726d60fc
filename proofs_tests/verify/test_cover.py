"""V1 and V2 for what is said of a domain: each witness is true, as many as there are, and marks count segments."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from random import Random

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.oracles import Triangle
from proofs_tests.recording import Record
from proofs_tests.verify.cover_oracle import Picture
from proofs_tests.verify.test_constrained import Plain

from exactmesh import delaunay
from exactmesh.verify import Finding, Kind, Property, Report, Verdict, verify
from exactmesh.verify.boundary import boundary_of
from exactmesh.verify.cells import turns_of
from exactmesh.verify.chains import CONSTRAINED, IN_DOMAIN, ODD, edge_slot
from exactmesh.verify.constrained import stacked
from exactmesh.verify.cover import Survey, surveyed
from exactmesh.verify.domain import constraints_of
from exactmesh.verify.hull import unused_points
from exactmesh.verify.links import linked
from exactmesh.verify.local import localized
from exactmesh.verify.mesh import index_quads, index_triples, prepared_mesh
from exactmesh.verify.trial import Tiled, Trial, tried
from exactmesh.verify.triangles import classified
from exactmesh.verify.witness import IndexArray

Pair = tuple[int, int]
Points = Sequence[tuple[float, float]]
ABOUT = (Property.SEGMENTS_PRESENT, Property.COVERS_DOMAIN, Property.DOMAIN_POINTS, Property.NO_NEW_POINTS)


def spread(random: Random) -> list[tuple[float, float]]:
    """Some points of a small grid, not on a line."""
    while True:
        side = random.choice((3, 3, 4))
        points = [(float(random.randrange(side)), float(random.randrange(side))) for _ in range(random.randint(4, 8))]
        points = list(dict.fromkeys(points))
        exact = oracles.rationals(points)
        if any(oracles.orient(exact[0], p, q) for p in exact for q in exact):
            return points


def rim_of(triangles: Sequence[Triangle]) -> list[Pair]:
    """The edges of an odd number of triangles: an even number of them ends in each point."""
    count = Counter(frozenset(pair) for a, b, c in triangles for pair in ((a, b), (b, c), (c, a)))
    return [(min(edge), max(edge)) for edge, times in count.items() if times % 2]


def merged(random: Random, points: Points, rim: Sequence[Pair]) -> list[Pair]:
    """The rim with some segments put together that run straight on."""
    lines, exact = list(rim), oracles.rationals(points)
    for v in range(len(points)):
        ends = [pair for pair in lines if v in pair]
        if len(ends) == 2 and random.random() < 0.7:
            (p,), (q,) = ({*pair} - {v} for pair in ends)
            if oracles.on_segment(exact[v], exact[p], exact[q]) and p != q:
                lines = [pair for pair in lines if pair not in ends] + [(p, q)]
    return lines


def drawn(random: Random, places: list[tuple[float, float]], rim: Sequence[Pair], even_odd: bool) -> list[Pair]:
    """The rim, and rings or lines besides, between new places as well; by seeds some of it may be missing."""
    segments = list(rim)
    for _ in range(random.choice((0, 0, 1, 1, 2))):
        if random.random() < 0.3:
            places.append((random.randrange(7) / 2, random.randrange(7) / 2))
        ring = random.sample(range(len(places)), random.choice((2, 3)))
        if random.random() < 0.5:  # straight on beyond an edge or something longer
            (ax, ay), (bx, by) = places[ring[0]], places[ring[1]]
            ring[1:] = [len(places)]
            places.append((2 * bx - ax, 2 * by - ay))
        sides = list(zip(ring, ring[1:] + ring[:1], strict=True))
        segments += sides if even_odd or random.random() < 0.5 else sides[:1]
    if not even_odd and random.random() < 0.5:
        segments = [pair for pair in segments if random.random() < 0.9]
    return [(a, b) if random.random() < 0.5 else (b, a) for a, b in segments if places[a] != places[b]]


def near(random: Random, points: Points) -> tuple[float, float]:
    """A place at a point, between points, or anywhere."""
    (ax, ay), (bx, by), (cx, cy) = (random.choice(points) for _ in range(3))
    return random.choice(
        ((ax, ay), ((ax + bx) / 2, (ay + by) / 2), ((ax + bx + 2 * cx) / 4, (ay + by + 2 * cy) / 4), (2.6, 1.4))
    )


def picture(random: Random) -> Picture:
    """Part of a Delaunay triangulation, and a domain that is often another part of it, with more segments and holes."""
    points = spread(random)
    rows = [(int(a), int(b), int(c)) for a, b, c in delaunay(np.array(points)).triangles]
    triangles = [t for t in rows if random.random() < 0.8]
    wanted = [t for t in rows if (t in triangles) is not (random.random() < 0.08)]
    even_odd, places = random.random() < 0.5, list(points)
    rim = merged(random, points, rim_of(wanted)) * random.choice((1, 1, 1, 1, 1, 2))
    segments = drawn(random, places, rim, even_odd)
    if random.random() < 0.3:
        places.append((random.randrange(9) / 2, random.randrange(9) / 2))
    kept = [v for v in range(len(places)) if v in {end for pair in segments for end in pair} or random.random() < 0.9]
    random.shuffle(kept)
    place = {v: i for i, v in enumerate(kept)}
    segments = [(place[a], place[b]) for a, b in random.sample(segments, len(segments))]
    holes = [near(random, points) for _ in range(random.choice((0, 0, 1, 2)))]
    shown = points if random.random() < 0.8 else [*points, (0.5, 0.5)]
    return Picture(shown, triangles, [places[v] for v in kept], segments, holes, even_odd)


def domain_of(shown: Picture) -> Plain:
    return Plain.of(shown.theirs, shown.segments, shown.holes, "even-odd" if shown.even_odd else "seeds")


def report_on(shown: Picture) -> Report:
    return verify(shown.points, list(shown.triangles), domain=domain_of(shown))


def expected(shown: Picture, findings: Mapping[Property, Finding]) -> Iterator[tuple[str, int, int]]:
    """What is told and what should be, by number; of what is decided."""
    cover, points = findings[Property.COVERS_DOMAIN], findings[Property.DOMAIN_POINTS]
    kinds = Counter(violation.kind for violation in cover.violations)
    yield "new points", findings[Property.NO_NEW_POINTS].count, shown.new_points
    if points.verdict is not Verdict.UNDECIDED:
        yield "missing points", points.count, shown.missing_points
    if cover.verdict is not Verdict.UNDECIDED:
        yield "off segments", kinds[Kind.OFF_SEGMENTS], shown.off_segments
        if not shown.off_segments:
            yield "holes", kinds[Kind.COVERED_HOLE], shown.covered_holes
            yield "faces", kinds[Kind.NOT_COVERED], shown.bare_faces
            if shown.even_odd and shown.is_plain:
                yield "parities", kinds[Kind.COVERED_OUTSIDE], shown.wrong_parities
        yield "domain", cover.verdict is Verdict.HOLDS, shown.inside == shown.covered
    segments = findings[Property.SEGMENTS_PRESENT]
    if not segments.lower_bound and not (segments.count and shown.any_overlap):
        yield "segments", segments.count, shown.missing_segments


def faults(shown: Picture, findings: Mapping[Property, Finding]) -> list[str]:
    """What is not so of what is said, or not said of what is so."""
    found = [f"{what}: {told}, not {true}" for what, told, true in expected(shown, findings) if told != true]
    for property_ in ABOUT:
        finding = findings[property_]
        found += [violation.message for violation in finding.violations if not shown.is_true(violation)]
        if finding.lower_bound is not shown.is_bound(finding):
            found.append(f"{property_}: a lower bound is {finding.lower_bound}")
        if len({violation.message for violation in finding.violations}) != finding.count:
            found.append(f"{property_}: {finding.count} times the same")
    return found


UNIT: Points = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
HALVES: list[Triangle] = [(0, 1, 2), (0, 2, 3)]
RIM: list[Pair] = [(0, 1), (1, 2), (2, 3), (3, 0)]
RING: Points = [(0.0, 0.0), (8.0, 0.0), (0.0, 8.0), (1.0, 1.0), (3.0, 1.0), (1.0, 3.0)]
ROUND: list[Triangle] = [(0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4), (2, 0, 3), (2, 3, 5)]
RIMS: list[Pair] = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3)]
APART: Points = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (5.0, 5.0), (6.0, 5.0), (6.0, 6.0), (5.0, 6.0)]
SIDES: list[Pair] = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 6), (6, 3)]
STACKED: Points = [(x, y) for y in (0.0, 1.0, 2.0, 3.0) for x in (0.0, 1.0)]
FOUR: list[Triangle] = [(0, 1, 2), (1, 3, 2), (4, 5, 7), (4, 7, 6)]
LOWER: list[Pair] = [(0, 1), (1, 3), (3, 2), (2, 0)]
UPPER: list[Pair] = [(4, 5), (5, 7), (7, 6), (6, 4)]
SPREAD: Points = [(2.0, 2.0), (4.0, 4.0), (2.0, 4.0), (4.0, 2.0), (3.0, 3.0), (9.0, 3.0)]

#: Pictures, and how many violations of which sort they have.
NAMED: dict[str, tuple[Picture, dict[Kind, int]]] = {
    "a square": (Picture(UNIT, HALVES, UNIT, RIM, [], False), {}),
    "a hole that has no point": (Picture(RING, ROUND, RING, RIMS, [], False), {Kind.NOT_COVERED: 1}),
    "a hole that has one": (Picture(RING, ROUND, RING, RIMS, [(1.5, 1.5)], False), {}),
    "two holes that triangles cover": (
        Picture(UNIT, HALVES, UNIT, RIM, [(9.0, 9.0), (0.5, 0.25), (0.5, 0.5), (1.0, 0.5)], False),
        {Kind.COVERED_HOLE: 2},
    ),
    "a hole on a segment inside": (Picture(UNIT, HALVES, UNIT, [*RIM, (0, 2)], [(0.5, 0.5)], False), {}),
    "a square that nothing covers": (
        Picture(APART, [(0, 1, 2)], APART, SIDES, [], False),
        {Kind.NOT_COVERED: 1, Kind.MISSING_SEGMENT: 4},
    ),
    "a square that nothing covers, by parity": (
        Picture(APART, [(0, 1, 2)], APART, SIDES, [], True),
        {Kind.NOT_COVERED: 1, Kind.MISSING_SEGMENT: 4},
    ),
    "a rim twice": (Picture(UNIT, HALVES, UNIT, [*RIM, *RIM], [], True), {Kind.COVERED_OUTSIDE: 4}),
    "a rim twice, and a hole": (
        Picture(UNIT, HALVES, UNIT, [*RIM, *RIM], [(9.0, 9.0)], True),
        {Kind.COVERED_OUTSIDE: 1},
    ),
    "two rims twice": (
        Picture(STACKED, FOUR, STACKED, 2 * [*UPPER, *LOWER], [], True),
        {Kind.COVERED_OUTSIDE: 8},
    ),
    "a cut inside": (
        Picture(UNIT, HALVES, UNIT, [*RIM, (0, 1), (1, 2), (2, 0)], [], True),
        {Kind.COVERED_OUTSIDE: 3},
    ),
    # It was told that the face below the upper square, which is the face outside, belongs to the domain.
    "a cut inside, a square above": (
        Picture(STACKED, FOUR, STACKED, [*LOWER, (0, 1), (1, 2), (2, 0), *UPPER], [(9.0, 9.0)], True),
        {Kind.COVERED_OUTSIDE: 2},
    ),
    "a triangle less": (
        Picture(UNIT, HALVES[1:], UNIT, RIM, [], False),
        {Kind.OFF_SEGMENTS: 1, Kind.MISSING_SEGMENT: 2},
    ),
    "a diagonal that is not there": (
        Picture(UNIT, HALVES, UNIT, [*RIM, (1, 3)], [], False),
        {Kind.MISSING_SEGMENT: 1},
    ),
    "a segment that crosses the rim": (
        Picture(UNIT, HALVES, [*UNIT, (0.5, 0.75), (0.5, 2.0)], [*RIM, (4, 5)], [], False),
        {Kind.CROSSING: 1},
    ),
    "a segment that ends in the rim": (
        Picture(UNIT, HALVES, [(0.5, 1.0), (0.5, 2.0), *UNIT], [(3, 2), (4, 3), (5, 4), (2, 5), (0, 1)], [], False),
        {Kind.HANGING_NODE: 1},
    ),
    "segments that cross outside": (
        Picture(UNIT, HALVES, [*UNIT, *SPREAD[:4]], [*RIM, (4, 5), (6, 7)], [], False),
        {Kind.CROSSING: 1},
    ),
    "segments that cross in an end": (
        Picture(UNIT, HALVES, [*UNIT, *SPREAD], [*RIM, (4, 5), (6, 7), (8, 9)], [], False),
        {},
    ),
    "segments that cross in a corner": (
        Picture(UNIT, HALVES, [*UNIT, (0.0, 2.0), (2.0, 0.0), (2.0, 2.0)], [*RIM, (4, 5), (0, 6)], [], False),
        {},
    ),
    "points inside, outside and on the rim": (
        Picture(UNIT, HALVES, [*UNIT, (0.25, 0.5), (2.0, 2.0), (0.5, 0.0)], RIM, [], False),
        {Kind.MISSING_POINT: 2},
    ),
    "a corner that is no point": (
        Picture([*UNIT, (0.5, 0.0)], [(0, 4, 3), (4, 2, 3), (4, 1, 2)], UNIT, RIM, [], False),
        {Kind.NEW_POINT: 1},
    ),
}


@pytest.mark.obligation("V3", "what a witness says of a domain is true, and all is told", method="differential")
class TestWitnesses:
    """Each sentence about segments, faces, holes and points of a domain is so in fractions, with its numbers, corners
    and positions; as many holes, faces and points are named as there are; and a count that may be too small says so."""

    @pytest.mark.parametrize(("shown", "kinds"), NAMED.values(), ids=list(NAMED))
    def test_named(self, shown: Picture, kinds: dict[Kind, int]) -> None:
        findings = report_on(shown).findings
        assert not faults(shown, findings)
        assert Counter(violation.kind for property_ in ABOUT for violation in findings[property_].violations) == kinds

    @pytest.mark.parametrize("seed", range(24))
    def test_random(self, seed: int, record_property: Record) -> None:
        random = Random(seed)
        for _ in range(10):
            shown = picture(random)
            assert not faults(shown, report_on(shown).findings), shown
        record_property("cases", 10)

    def test_control_another_mesh(self) -> None:
        """Without one of its triangles a mesh is another one, and what was said of it is not so."""
        random, noticed = Random(1), 0
        while noticed < 20:
            shown = picture(random)
            findings = report_on(shown).findings
            if findings[Property.COVERS_DOMAIN].verdict is Verdict.HOLDS:
                for t in shown.triangles:
                    assert faults(replace(shown, triangles=[s for s in shown.triangles if s != t]), findings)
                    noticed += 1


def trial_of(shown: Picture, bits: int) -> tuple[Trial, IndexArray]:
    """What the verifier makes of a picture, with all unused points; these."""
    domain = domain_of(shown)
    constraints = constraints_of(None, domain, None, len(shown.triangles))
    assert constraints.outline is not None
    points = np.array(shown.points)
    others = stacked(constraints.outline)
    mesh, positions = prepared_mesh(points, index_triples(list(shown.triangles)), index_quads(()), others)
    local = localized(mesh.coordinates, mesh.triangles, mesh.quads)
    links = linked(len(points), mesh.context, local)
    shapes = classified(mesh.context, local, turns_of(mesh.context, local))
    unused, marks = unused_points(links), np.zeros(len(links.slots), dtype=np.uint8)
    tiled = Tiled(mesh, shapes, links, boundary_of(links), unused, marks)
    return tried(tiled, constraints.outline, positions, unused, bits, None), unused


@pytest.mark.obligation(
    "V1", "marks of edges count segments, and what is located lies there", method="differential", control_in="mutants"
)
class TestSurveys:
    """Where no segment is missing each edge is marked iff segments run along it, ODD iff an odd number of them, and
    nothing else is; points of the domain at no corner, unused points and holes' points are told to be covered iff they
    lie in the closed union; a sweep with the segments inside tells which holes' points lie on segments."""

    @pytest.mark.parametrize("own", [0, CONSTRAINED])
    @pytest.mark.parametrize("seed", range(8))
    def test_random(self, seed: int, own: int) -> None:
        random, bits = Random(1000 * (1 + own) + seed), IN_DOMAIN | ODD | own
        for _ in range(20):
            shown = picture(random)
            found, unused = trial_of(shown, bits)
            if found.segments.verdict is not Verdict.HOLDS:
                continue
            links, marks = found.tiled.links, found.tiled.marks.copy()
            for edge in shown.edges:
                slot, count = edge_slot(links, *edge), shown.segments_at(edge)
                assert marks[slot] == (count > 0) * (IN_DOMAIN | own) | (count % 2) * ODD, (shown, edge)
                marks[slot] = 0
            assert not marks.any()
            inner = surveyed(found.tiled.mesh, links, found.tiled.marks, found.placed, unused, bits, inner=True)
            for survey in (found.survey, inner):
                if survey is not None:
                    self.located(shown, survey, unused)
            without = surveyed(found.tiled.mesh, links, found.tiled.marks, None, unused, bits)
            assert without.unused_covered.tolist() == inner.unused_covered.tolist()
            holes = oracles.rationals(shown.holes)
            on = [any(oracles.on_segment(p, *s) for s in shown.lines) for p in holes]
            assert inner.hole_free.tolist() == [not on_it for on_it in on], shown

    def located(self, shown: Picture, survey: Survey, unused: IndexArray) -> None:
        assert survey.stray.tolist() == [v for v, p in enumerate(shown.own) if p not in shown.corners]
        assert survey.stray_covered.tolist() == [shown.in_triangles(shown.own[v]) for v in survey.stray]
        assert survey.unused_covered.tolist() == [shown.in_triangles(shown.exact[v]) for v in unused]
        covered = survey.faces.covered(survey.hole_sides)
        for p, told, free in zip(oracles.rationals(shown.holes), covered, survey.hole_free, strict=True):
            if free and not shown.off_segments:  # of a point on a bare edge of the boundary either side will do
                assert told == shown.in_triangles(p), (shown, p)
