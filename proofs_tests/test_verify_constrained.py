"""V1 and V2 for constrained meshes: with segments, with domains, every verdict is that of brute force."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import combinations
from random import Random

import numpy as np
import pytest
from proofs_tests import domain_oracle, oracles
from proofs_tests.domain_oracle import Cells, Line
from proofs_tests.oracles import RationalPoint, Triangle

from exactmesh import PSLG
from exactmesh.verify import Property, Report, Verdict, verify

Points = Sequence[tuple[float, float]]
Pair = tuple[int, int]

NEW = (
    Property.SEGMENTS_PRESENT,
    Property.CONSTRAINED_DELAUNAY,
    Property.COVERS_DOMAIN,
    Property.DOMAIN_POINTS,
    Property.NO_NEW_POINTS,
)


@dataclass(frozen=True)
class Plain:
    """A domain that nobody has validated: what the protocol asks for."""

    points: np.ndarray
    segments: np.ndarray
    holes: np.ndarray
    regions: np.ndarray
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
        drawn = [tuple(self.points[v] for v in edge) for edge in edges]
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
        middles = [domain_oracle.middle(p, q) for p, q in zip(ends, ends[1:], strict=False)]
        for p in [*ends, *middles]:
            needed = self.in_closed_domain(p) or any(self._within(p, t) for t in triangles)
            if needed and p not in corners and not any(oracles.on_segment(p, *e) for e in along):
                return False
        return True

    def constrained_delaunay(self, triangles: Sequence[Triangle]) -> bool:
        edges = [frozenset(pair) for t in triangles for pair in combinations(t, 2)]
        blockers = tuple(
            [*self.lines, *(tuple(self.points[v] for v in edge) for edge in edges if edges.count(edge) == 1)]
        )
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
        return [any(column) for column in zip(*(self.cover[tuple(sorted(t))] for t in triangles), strict=True)] == (
            self.inside
        ) if triangles else not any(self.inside)

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
    own = {"segments": list(truth.pairs)} if truth.domain is None else {"domain": truth.domain}
    report = verify(truth.given, list(triangles), orientation="any", **own)
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
