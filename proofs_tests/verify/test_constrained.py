"""V1 and V2 for constrained meshes: with segments, with domains, every verdict is that of brute force."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from random import Random

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.once import once_after
from proofs_tests.oracles import RationalPoint, Triangle
from proofs_tests.recording import Record
from proofs_tests.verify import domain_oracle
from proofs_tests.verify.domain_oracle import Cells, Line

from exactkernel.types import FloatArray, IntArray
from exactmesh.verify import Property, Verdict, verify

Points = Sequence[tuple[float, float]]
Pair = tuple[int, int]


@dataclass(frozen=True)
class Plain:
    """A domain that nobody has validated: what the protocol asks for."""

    points: FloatArray
    segments: IntArray
    holes: FloatArray
    regions: FloatArray
    rule: str

    @classmethod
    def of(cls, points: Points, segments: Sequence[Pair], holes: Points = (), rule: str = "seeds") -> "Plain":
        return cls(
            np.array(points, dtype=np.float64).reshape(-1, 2),
            np.array(segments, dtype=np.int32).reshape(-1, 2),
            np.array(holes, dtype=np.float64).reshape(-1, 2),
            np.empty((0, 4)),
            rule,
        )


class Truth:
    """The truth about every set of triangles over fixed points, with fixed segments or a fixed domain.

    One set of cells does for all: that of the segments and of all lines between points.
    """

    def __init__(self, points: Points, segments: Sequence[Pair], domain: Plain | None = None) -> None:
        self.given, self.pairs, self.domain = points, segments, domain
        self.points: list[RationalPoint] = oracles.rationals(points)
        theirs = self.points if domain is None else oracles.rationals(domain.points.tolist())
        own = [tuple(pair) for pair in (segments if domain is None else domain.segments.tolist())]
        self.lines: list[Line] = [(theirs[a], theirs[b]) for a, b in own if theirs[a] != theirs[b]]
        self.theirs = theirs
        holes = [] if domain is None else oracles.rationals(domain.holes.tolist())
        everything = [(p, q) for p, q in combinations(self.points, 2) if p != q]
        self.cells = Cells(self.lines, everything, [*theirs, *self.points, *holes])
        self.inside = [] if domain is None else self.cells.domain(holes, domain.rule == "even-odd")
        self.cover = {
            t: [self._within(cell.sample, t) for cell in self.cells.trapezoids]
            for t in combinations(range(len(points)), 3)
        }
        self.parts = [domain_oracle.parts_of(s, [*self.lines, *everything]) for s in self.lines]
        self.meetings: dict[tuple[Triangle, Triangle], bool] = {}
        self.visible: dict[tuple[object, ...], bool] = {}

    def _line(self, edge: frozenset[int]) -> Line:
        a, b = edge
        return self.points[a], self.points[b]

    def _within(self, p: RationalPoint, t: Triangle) -> bool:
        a, b, c = (self.points[v] for v in t)
        signs = [oracles.orient(a, b, p), oracles.orient(b, c, p), oracles.orient(c, a, p)]
        return oracles.orient(a, b, c) != 0 and (min(signs) >= 0 or max(signs) <= 0)

    def meet(self, s: Triangle, t: Triangle) -> bool:
        if (s, t) not in self.meetings:
            self.meetings[s, t] = oracles.meet_admissibly(self.points, s, t)
        return self.meetings[s, t]

    def admissible(self, triangles: Sequence[Triangle]) -> bool:
        return all(oracles.has_area(self.points, t) for t in triangles) and all(
            self.meet(s, t) for s, t in combinations(triangles, 2)
        )

    def in_closed_domain(self, p: RationalPoint) -> bool:
        return any(inside and cell.contains(p) for inside, cell in zip(self.inside, self.cells.trapezoids, strict=True))

    def segments_present(self, triangles: Sequence[Triangle]) -> bool:
        edges = {frozenset(pair) for t in triangles for pair in combinations(t, 2)}
        if self.domain is None:
            return all(domain_oracle.is_chain(self.points, edges, a, b) for a, b in self.pairs)
        corners = {self.points[v] for t in triangles for v in t}
        if all(self._whole(s, edges) for s in self.lines):
            return True
        drawn = [self._line(edge) for edge in edges]
        for s, t in combinations(self.lines, 2):
            crossing = domain_oracle.cross_inside(s, t)
            if crossing is not None and crossing not in corners and crossing not in {p for s in self.lines for p in s}:
                return False
        return all(
            self._part_present(s, ends, triangles, corners, drawn)
            for s, ends in zip(self.lines, self.parts, strict=True)
        )

    def _whole(self, s: Line, edges: set[frozenset[int]]) -> bool:
        starts, ends = ([v for edge in edges for v in edge if self.points[v] == p] for p in s)
        return any(domain_oracle.is_chain(self.points, edges, a, b) for a in set(starts) for b in set(ends))

    def _part_present(
        self,
        s: Line,
        ends: Sequence[RationalPoint],
        triangles: Sequence[Triangle],
        corners: set[RationalPoint],
        drawn: Sequence[Line],
    ) -> bool:
        along = [e for e in drawn if all(oracles.on_segment(v, *s) for v in e)]
        middles = [domain_oracle.middle(p, q) for p, q in pairwise(ends)]
        for p in [*ends, *middles]:
            needed = self.in_closed_domain(p) or any(self._within(p, t) for t in triangles)
            if needed and p not in corners and not any(oracles.on_segment(p, *e) for e in along):
                return False
        return True

    def constrained_delaunay(self, triangles: Sequence[Triangle]) -> bool:
        edges = [frozenset(pair) for t in triangles for pair in combinations(t, 2)]
        blockers = (*self.lines, *(self._line(edge) for edge in edges if edges.count(edge) == 1))
        for t in triangles:
            corners = [self.points[v] for v in oracles.counterclockwise(self.points, t)]
            centre, radius = oracles.circumcircle(*corners)
            for p in set(self.points):
                if oracles.squared_distance(centre, p) < radius and self._sees(p, tuple(corners), blockers):
                    return False
        return True

    def _sees(self, p: RationalPoint, corners: tuple[RationalPoint, ...], blockers: tuple[Line, ...]) -> bool:
        key = (p, corners, blockers)
        if key not in self.visible:
            self.visible[key] = domain_oracle.is_visible(p, corners, blockers)
        return self.visible[key]

    def covers(self, triangles: Sequence[Triangle]) -> bool:
        columns = [self.cover[min(a, b, c), sorted((a, b, c))[1], max(a, b, c)] for a, b, c in triangles]
        return [any(column[i] for column in columns) for i in range(len(self.inside))] == self.inside

    def verdicts(self, triangles: Sequence[Triangle]) -> dict[Property, bool]:
        admissible = self.admissible(triangles)
        found = {
            Property.SEGMENTS_PRESENT: self.segments_present(triangles),
            Property.CONSTRAINED_DELAUNAY: admissible and self.constrained_delaunay(triangles),
        }
        if self.domain is not None:
            corners = {self.points[v] for t in triangles for v in t}
            found[Property.COVERS_DOMAIN] = self.covers(triangles)
            found[Property.DOMAIN_POINTS] = all(p in corners or not self.in_closed_domain(p) for p in self.theirs)
            found[Property.NO_NEW_POINTS] = corners <= set(self.theirs)
        return found


ALLOWED = {
    Property.SEGMENTS_PRESENT: {Property.ADMISSIBLE},
    Property.CONSTRAINED_DELAUNAY: {Property.ADMISSIBLE, Property.SEGMENTS_PRESENT},
    Property.COVERS_DOMAIN: {Property.ADMISSIBLE, Property.SEGMENTS_PRESENT},
    Property.DOMAIN_POINTS: {Property.COVERS_DOMAIN},
    Property.NO_NEW_POINTS: set[Property](),
}


def disagreements(truth: Truth, triangles: Sequence[Triangle]) -> list[str]:
    """Where the verifier contradicts brute force, or is undecided without the reason that the enum states."""
    segments = list(truth.pairs) if truth.domain is None else None
    report = verify(truth.given, list(triangles), segments=segments, domain=truth.domain, orientation="any")
    faults = []
    for property_, true in truth.verdicts(triangles).items():
        finding = report.findings[property_]
        if finding.verdict is Verdict.UNDECIDED:
            if not finding.because or any(
                missing not in ALLOWED[property_] or report.verdict(missing) is Verdict.HOLDS
                for missing in finding.because
            ):
                faults.append(f"{property_} undecided because of {finding.because}")
        elif (finding.verdict is Verdict.HOLDS) is not true:
            faults.append(f"{property_} {finding.verdict}")
        if (finding.verdict is Verdict.FAILS) is not (finding.count > 0) or bool(finding.violations) is not bool(
            finding.count
        ):
            faults.append(f"{property_} {finding.verdict} with {finding.count} violations")
    return faults


def all_sets(points: Points) -> Iterator[tuple[Triangle, ...]]:
    """Every set of triangles with area over at most five points."""
    exact = oracles.rationals(points)
    triples = [t for t in combinations(range(len(points)), 3) if oracles.has_area(exact, t)]
    for bits in range(1 << len(triples)):
        yield tuple(t for i, t in enumerate(triples) if bits >> i & 1)


SQUARE: Points = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)]
RIM = [(0, 1), (1, 2), (2, 3), (3, 0)]

#: Points and segments of the mesh.
WITH_SEGMENTS: dict[str, tuple[Points, list[Pair]]] = {
    "a diagonal": ([(0, 0), (4, 0), (4, 4), (0, 4), (1, 2)], [(0, 2)]),
    "through a vertex": (SQUARE, [(0, 2), (1, 3)]),
    "convex": ([(0, 0), (4, -1), (6, 3), (3, 6), (-1, 4)], [(0, 2)]),
    "inside": ([(0, 0), (9, 0), (4, 9), (4, 2), (5, 4)], [(3, 4), (0, 3)]),
    "grid without a corner": ([(0, 0), (1, 0), (2, 0), (0, 1), (1, 1)], [(2, 0), (0, 4)]),
    "two at one position": ([(0, 0), (3, 0), (0, 3), (3, 3), (3, 0)], [(0, 3), (1, 4)]),
    "no segment": ([(0, 0), (4, 0), (4, 4), (0, 4), (3, 2)], []),
}

Case = tuple[Points, Points, list[Pair], Points, str]
#: Points of the mesh, then the domain.
DOMAINS: dict[str, Case] = {
    "a square and a point": (SQUARE, SQUARE, RIM, (), "seeds"),
    "a point that nobody asked for": (SQUARE, SQUARE[:4], RIM, (), "seeds"),
    "not convex": (SQUARE, SQUARE, [(0, 1), (1, 2), (2, 4), (4, 0)], (), "even-odd"),
    "two triangles": (
        [(0, 0), (4, -1), (6, 3), (3, 6), (-1, 4)],
        [(0, 0), (4, -1), (6, 3), (3, 6), (-1, 4)],
        [(0, 1), (1, 2), (2, 0), (2, 3), (3, 0)],
        (),
        "seeds",
    ),
    "pinched": (SQUARE, SQUARE, [(0, 4), (4, 1), (1, 0), (2, 4), (4, 3), (3, 2)], (), "even-odd"),
    "one of four carved": (SQUARE, SQUARE, [*RIM, (0, 2), (1, 3)], [(1, 0.5)], "seeds"),
    "two of four carved": (SQUARE, SQUARE, [*RIM, (0, 2), (1, 3)], [(1, 0.5), (1.5, 1)], "seeds"),
    "opposite ones carved": (SQUARE, SQUARE, [*RIM, (0, 2), (1, 3)], [(1, 0.5), (1, 1.5)], "seeds"),
    "a T-junction": (
        [(0, 0), (4, 0), (2, 3), (2, 1), (2, 0)],
        [(0, 0), (4, 0), (2, 3), (2, 1), (2, 0)],
        [(0, 4), (0, 1), (1, 2), (2, 0), (2, 3)],
        (),
        "seeds",
    ),
    "all carved": (SQUARE, SQUARE, [*RIM, (0, 4)], [(0.5, 1)], "seeds"),
    "doubled": (SQUARE, [*SQUARE, (0, 0), (2, 2)], [*RIM, (0, 2), (5, 6)], (), "even-odd"),
    "a rim twice": (SQUARE, [*SQUARE[:4], *SQUARE[:4]], [*RIM, (4, 5), (5, 6), (6, 7), (7, 4)], (), "even-odd"),
    "a rim twice and a hole": (
        SQUARE,
        [*SQUARE[:4], *SQUARE[:4]],
        [*RIM, (4, 5), (5, 6), (6, 7), (7, 4)],
        [(1, -1)],
        "even-odd",
    ),
    "overlapping": (SQUARE, [*SQUARE, (1, 0)], [(0, 1), (5, 1), (0, 5), (1, 2), (2, 3), (3, 0)], (), "seeds"),
    "open": (SQUARE, SQUARE, RIM[:3], (), "seeds"),
    "hole and parity": (SQUARE, SQUARE, [*RIM, (0, 4), (4, 2), (0, 2)], [(0.5, 1)], "even-odd"),
}


def truth_of(case: Case) -> Truth:
    points, theirs, segments, holes, rule = case
    return Truth(points, (), Plain.of(theirs, segments, holes, rule))


@pytest.mark.obligation(
    "V1",
    "sets of triangles over five points, every second, are judged against segments and domains as by visibility",
    method="enumeration",
)
class TestEverySet:
    """For every second set of triangles over five points each decided verdict about segments and domains is that of
    brute force: visibility, chains and faces by definition. Undecided is only what the enum says."""

    @pytest.mark.parametrize("case", once_after(1, WITH_SEGMENTS.values(), WITH_SEGMENTS.keys()))
    def test_segments(self, case: tuple[Points, list[Pair]], record_property: Record) -> None:
        points, segments = case
        truth = Truth(points, segments)
        some = list(all_sets(points))[::2]
        for triangles in some:
            assert not disagreements(truth, triangles), triangles
        record_property("cases", len(some))

    @pytest.mark.parametrize("case", once_after(1, DOMAINS.values(), DOMAINS.keys()))
    def test_domain(self, case: Case, record_property: Record) -> None:
        truth = truth_of(case)
        some = list(all_sets(case[0]))[::2]
        for triangles in some:
            assert not disagreements(truth, triangles), triangles
        record_property("cases", len(some))

    def test_control_brute_force_accepts_and_rejects_each_property(self) -> None:
        """Sets of triangles on which each property fails, and others on which it holds."""
        seen: dict[Property, set[bool]] = {}
        for case in DOMAINS.values():
            truth = truth_of(case)
            for triangles in list(all_sets(case[0]))[::5]:
                if truth.admissible(triangles):
                    for property_, true in truth.verdicts(triangles).items():
                        seen.setdefault(property_, set()).add(true)
        assert len(seen) == 5
        assert all(truths == {True, False} for truths in seen.values())


def random_truth(random: Random) -> Truth:
    """A random domain over few positions: rings or single segments, overlapping, crossing, with T-junctions and
    duplicate points; or a few segments of the mesh."""
    size, n = random.choice((3, 4, 5)), random.choice((5, 6))
    points = [(random.randrange(size), random.randrange(size)) for _ in range(n)]
    if random.random() < 0.25:
        return Truth(points, [(a, b) for a, b in (random.sample(range(n), 2) for _ in range(random.randrange(4)))])
    theirs = list(points) if random.random() < 0.3 else list(dict.fromkeys(points))
    random.shuffle(theirs)
    rule = random.choice(("seeds", "even-odd"))
    segments: list[Pair] = []
    for _ in range(random.choice((1, 1, 2, 3))):
        ring = random.sample(range(len(theirs)), min(len(theirs), random.randrange(3, 7)))
        if rule == "seeds" and random.random() < 0.4:
            ring = ring[:2]
        segments += zip(ring, ring[1:] + ring[:1], strict=True)
    segments = [(a, b) for a, b in segments if theirs[a] != theirs[b]]
    holes = [(random.randrange(4 * size) / 4, random.randrange(4 * size) / 4) for _ in range(random.choice((0, 1, 2)))]
    return Truth(points, (), Plain.of(theirs, segments, holes, rule))


def grown(truth: Truth, random: Random) -> list[Triangle]:
    """Triangles that mostly meet admissibly, and often lie in the domain only."""
    candidates = [t for t in combinations(range(len(truth.points)), 3) if oracles.has_area(truth.points, t)]
    random.shuffle(candidates)
    chosen: list[Triangle] = []
    careless = random.choice((0, 0, 0.02))
    for t in candidates:
        if all(truth.meet(s, t) for s in chosen) or random.random() < careless:
            chosen.append(t)
    if truth.domain is not None and random.random() < 0.7:
        chosen = [t for t in chosen if all(i for i, c in zip(truth.inside, truth.cover[t], strict=True) if c)]
    return chosen if random.random() < 0.7 else chosen[1:]


@pytest.mark.obligation(
    "V1",
    "random domains on a small grid, where all coincides with all, are judged as by brute force",
    method="differential",
    control_in="proofs_tests/verify/test_domains.py::TestAblation",
)
class TestRandomDomains:
    """The same for random domains over points of a small grid, where everything coincides with everything."""

    @pytest.mark.parametrize("seed", once_after(20, range(60)))
    def test_verdicts(self, seed: int, record_property: Record) -> None:
        random = Random(seed)
        truth = random_truth(random)
        for _ in range(4):
            triangles = grown(truth, random)
            assert not disagreements(truth, triangles), (truth.given, truth.pairs, truth.domain, triangles)
        record_property("cases", 4)


#: Points, triangles, domain; most were found by fuzzing.
REGRESSIONS: list[tuple[Points, list[Triangle], Plain]] = [
    (  # a segment that ends inside an edge of the boundary, from within
        [(3, 1), (3, 0), (3, 2), (2, 0), (0, 0)],
        [(1, 2, 4)],
        Plain.of([(3, 1), (0, 0), (3, 0), (2, 0), (3, 2)], [(0, 1)], [(2, 1)]),
    ),
    (  # a hole's point on an edge that is no segment
        [(0, 0), (4, 0), (2, 3), (2, 1), (2, 0)],
        [(0, 3, 4)],
        Plain.of([(0, 0), (4, 0), (2, 3), (2, 1), (2, 0)], [(0, 4), (4, 1), (1, 2), (2, 0), (2, 3)], [(2, 0.5)]),
    ),
    (  # absent segments on top of present ones: parity counted twice
        [(2, 0), (3, 3), (0, 0), (2, 2), (1, 0)],
        [(0, 1, 4)],
        Plain.of(
            [(3, 3), (2, 2), (1, 0), (2, 0), (0, 0)],
            [(3, 0), (0, 1), (1, 2), (2, 4), (4, 3)],
            [(1.25, 1.25)],
            "even-odd",
        ),
    ),
    (  # present ones within the triangles below absent ones: parity not counted
        [(2, 2), (1, 1), (1, 2), (1, 0), (1, 0), (0, 2)],
        [(1, 4, 5), (0, 1, 4)],
        Plain.of(
            [(0, 2), (1, 2), (2, 2), (1, 1), (1, 0), (1, 0)],
            [(5, 3), (3, 2), (2, 0), (0, 4), (4, 1), (1, 5), (0, 2), (2, 5), (4, 1), (1, 3), (3, 0)],
            [(1, 0.25)],
            "even-odd",
        ),
    ),
    (  # a hole that has no point
        [(0, 0), (8, 0), (0, 8), (1, 1), (3, 1), (1, 3)],
        [(0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4), (2, 0, 3), (2, 3, 5)],
        Plain.of([(0, 0), (8, 0), (0, 8), (1, 1), (3, 1), (1, 3)], [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3)]),
    ),
    (  # absent segments that cross in an end of a third one
        [(1, 1), (2, 1), (1, 2), (1, 0), (0, 1)],
        [],
        Plain.of(
            [(2, 1), (0, 1), (1, 0), (1, 1), (1, 2)],
            [(3, 4), (4, 1), (1, 0), (0, 2), (2, 3), (2, 4), (4, 1), (1, 0), (0, 2)],
            [],
            "even-odd",
        ),
    ),
]


class TestRegressions:
    """What the checker once got wrong, or might."""

    @pytest.mark.parametrize(("points", "triangles", "domain"), REGRESSIONS)
    def test_verdicts(self, points: Points, triangles: list[Triangle], domain: Plain) -> None:
        assert not disagreements(Truth(points, (), domain), triangles)
