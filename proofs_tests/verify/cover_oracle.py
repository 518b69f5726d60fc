"""What is wrong with a mesh of a domain, by brute force in fractions; and whether a witness says the truth."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import combinations, pairwise

from proofs_tests import oracles
from proofs_tests.oracles import RationalPoint, Triangle
from proofs_tests.verify import domain_oracle
from proofs_tests.verify.domain_oracle import Cells, Line, Trapezoid

from exactmesh.verify import Kind, Property, Verdict, Violation
from exactmesh.verify.report import Finding

__all__ = ["Picture"]

Points = Sequence[tuple[float, float]]
Pair = tuple[int, int]

_CHAIN = "is no chain of edges where it runs through the triangles"
_BOUNDS = "bounds a face of the domain where no triangle is"
_POINT = r"(\d+ \([^)]*\))"


def name_of(points: Points, v: int) -> str:
    x, y = points[v]
    return f"{v} ({float(x)!r}, {float(y)!r})"


@dataclass(frozen=True)
class Picture:
    """Admissible triangles over points, and the points, segments and holes of a domain; the domain's own numbers."""

    points: Points
    triangles: Sequence[Triangle]
    theirs: Points
    segments: Sequence[Pair]
    holes: Points
    even_odd: bool

    @cached_property
    def exact(self) -> list[RationalPoint]:
        return oracles.rationals(self.points)

    @cached_property
    def own(self) -> list[RationalPoint]:
        return oracles.rationals(self.theirs)

    @cached_property
    def lines(self) -> list[Line]:
        return [(self.own[a], self.own[b]) for a, b in self.segments]

    @cached_property
    def corners(self) -> dict[RationalPoint, int]:
        return {self.exact[v]: v for t in self.triangles for v in t}

    @cached_property
    def edges(self) -> dict[frozenset[int], int]:
        """How many triangles each edge has."""
        count: dict[frozenset[int], int] = {}
        for t in self.triangles:
            for pair in combinations(t, 2):
                count[frozenset(pair)] = count.get(frozenset(pair), 0) + 1
        return count

    def line(self, edge: frozenset[int]) -> Line:
        a, b = edge
        return self.exact[a], self.exact[b]

    @cached_property
    def cells(self) -> Cells:
        places = [*self.own, *self.exact, *oracles.rationals(self.holes)]
        return Cells(self.lines, [self.line(edge) for edge in self.edges], places)

    @cached_property
    def inside(self) -> list[bool]:
        return self.cells.domain(oracles.rationals(self.holes), self.even_odd)

    def in_triangles(self, p: RationalPoint) -> bool:
        """Whether a point lies in the closed union."""
        for t in self.triangles:
            a, b, c = (self.exact[v] for v in t)
            signs = [oracles.orient(a, b, p), oracles.orient(b, c, p), oracles.orient(c, a, p)]
            if min(signs) >= 0 or max(signs) <= 0:
                return True
        return False

    @cached_property
    def covered(self) -> list[bool]:
        return [self.in_triangles(cell.sample) for cell in self.cells.trapezoids]

    def in_domain(self, p: RationalPoint) -> bool:
        """Whether a point lies in the closed domain."""
        return any(kept and cell.contains(p) for kept, cell in zip(self.inside, self.cells.trapezoids, strict=True))

    def segments_at(self, edge: frozenset[int]) -> int:
        """How many segments run along an edge of the mesh."""
        p, q = self.line(edge)
        return sum(oracles.on_segment(p, *s) and oracles.on_segment(q, *s) for s in self.lines)

    def beside(self, line: Line, upper: bool) -> Iterator[int]:
        """The trapezoids that meet a line in more than a point, on its upper or left, or its lower or right side."""
        (ax, ay), (bx, by) = min(line), max(line)
        for i, cell in enumerate(self.cells.trapezoids):
            if ax == bx:
                if (cell.right if upper else cell.left) == ax and _overlap(cell, ax, ay, by):
                    yield i
            elif ax <= cell.left and cell.right <= bx:
                x = (cell.left + cell.right) / 2
                bound = cell.low if upper else cell.high
                if bound is not None and domain_oracle.y_at(bound, x) == domain_oracle.y_at((min(line), max(line)), x):
                    yield i

    def parts(self, s: Line) -> list[Line]:
        """The parts into which everything cuts a segment."""
        lines = [*self.lines, *map(self.line, self.edges)]
        return [*pairwise(domain_oracle.parts_of(s, lines))]

    def along(self, p: RationalPoint, s: Line) -> bool:
        """Whether a point of a segment lies on an edge that runs along it."""
        edges = [self.line(edge) for edge in self.edges]
        return any(oracles.on_segment(p, *e) and all(oracles.on_segment(v, *s) for v in e) for e in edges)

    # What should be told.

    @cached_property
    def off_segments(self) -> int:
        return sum(count == 1 and self.segments_at(edge) == 0 for edge, count in self.edges.items())

    @cached_property
    def missing_points(self) -> int:
        return sum(p not in self.corners and self.in_domain(p) for p in self.own)

    @cached_property
    def new_points(self) -> int:
        return sum(p not in self.own for p in self.corners)

    @cached_property
    def covered_holes(self) -> int:
        return sum(self.is_hole_covered(i) for i in range(len(self.holes)))

    @cached_property
    def bare_faces(self) -> int:
        """The faces of the segments that belong to the domain, and have some part that no triangle covers."""
        rows = zip(self.inside, self.covered, self.cells.face, strict=True)
        return len({face for inside, covered, face in rows if inside and not covered})

    @cached_property
    def wrong_parities(self) -> int:
        """Edges within the triangles that an odd number of segments runs along, and edges of the boundary with an even
        one."""
        return sum((count == 1) is not (self.segments_at(edge) % 2 == 1) for edge, count in self.edges.items())

    @cached_property
    def is_plain(self) -> bool:
        """Whether there is nothing to locate: no holes, no segment or point of the domain and no point of the mesh that
        is not on edges or at corners."""
        at = all(p in self.corners for p in [*self.own, *self.exact]) and not self.holes
        return at and all(self.along(domain_oracle.middle(*part), s) for s in self.lines for part in self.parts(s))

    @cached_property
    def missing_segments(self) -> int:
        """How many segments lack something within the triangles; without any, where they bound a part of the domain."""
        return sum(map(self.lacks_a_part_within, self.lines)) or sum(map(self.lacks_a_part_outside, self.lines))

    @cached_property
    def any_overlap(self) -> bool:
        """Whether some segments have more than points in common: of a missing part, any of them may be told."""
        return any(len({*domain_oracle.meeting_points(s, t)}) > 1 for s, t in combinations(self.lines, 2))

    def lacks_a_part_within(self, s: Line) -> bool:
        middles = [domain_oracle.middle(*part) for part in self.parts(s)]
        return any(self.in_triangles(p) and not self.along(p, s) for p in middles)

    def lacks_a_part_outside(self, s: Line) -> bool:
        outside = [part for part in self.parts(s) if not self.in_triangles(domain_oracle.middle(*part))]
        return any(self.inside[i] for part in outside for upper in (False, True) for i in self.beside(part, upper))

    def is_hole_covered(self, i: int) -> bool:
        p = oracles.rationals(self.holes)[i]
        return self.in_triangles(p) and not any(oracles.on_segment(p, *s) for s in self.lines)

    # Whether witnesses say the truth.

    def is_true(self, violation: Violation) -> bool:
        """Whether everything that a witness says is so."""
        if violation.property is Property.SEGMENTS_PRESENT:
            return self._segment(violation)
        return {
            Kind.OFF_SEGMENTS: self._off_segments,
            Kind.COVERED_HOLE: self._covered_hole,
            Kind.NOT_COVERED: self._bare,
            Kind.COVERED_OUTSIDE: self._outside,
            Kind.MISSING_POINT: self._missing_point,
            Kind.NEW_POINT: self._new_point,
        }[violation.kind](violation)

    def _segment(self, violation: Violation) -> bool:
        said = re.fullmatch(
            rf"segment (\d+) of the domain, from point {_POINT} to point {_POINT}, (.*)", violation.message
        )
        assert said is not None, violation.message
        i, (a, b), fault = int(said[1]), self.segments[int(said[1])], said[4]
        s = self.lines[i]
        told = said[2] == name_of(self.theirs, a) and said[3] == name_of(self.theirs, b) and self._is_of(violation, i)
        if fault == _CHAIN:
            return told and self.lacks_a_part_within(s) and violation.kind is Kind.MISSING_SEGMENT
        if fault == _BOUNDS:
            return told and self.lacks_a_part_outside(s) and violation.kind is Kind.MISSING_SEGMENT
        return told and self._meeting(violation, s, fault)

    def _is_of(self, violation: Violation, segment: int) -> bool:
        """Whether a witness names the corners and positions at the ends of a segment."""
        ends = self.segments[segment]
        corners = tuple(self.corners[self.own[v]] for v in ends if self.own[v] in self.corners)
        return violation.vertices == corners and violation.places == tuple(self.theirs[v] for v in ends)

    def _meeting(self, violation: Violation, s: Line, fault: str) -> bool:
        other = re.fullmatch(r"crosses segment (\d+) where no corner and no end of a segment is", fault)
        if other is not None:
            crossing = domain_oracle.cross_inside(s, self.lines[int(other[1])])
            ends = {p for line in self.lines for p in line}
            return crossing is not None and crossing not in {*self.corners, *ends} and violation.kind is Kind.CROSSING
        if fault.startswith("crosses "):
            edge = self._edge(fault.removeprefix("crosses "))
            crosses = edge in self.edges and domain_oracle.cross_inside(s, self.line(edge)) is not None
            return crosses and violation.kind is Kind.CROSSING
        edge = self._edge(fault.removeprefix("ends inside "))
        p, q = self.line(edge)
        inner = [end for end in s if oracles.on_segment(end, p, q) and end not in (p, q)]
        hangs = edge in self.edges and bool(inner) and not any(end in self.corners for end in inner)
        return hangs and violation.kind is Kind.HANGING_NODE

    def _edge(self, name: str) -> frozenset[int]:
        said = re.fullmatch(rf"the edge {_POINT} - {_POINT}", name)
        assert said is not None, name
        edge = frozenset(int(end.split()[0]) for end in said.groups())
        assert {name_of(self.points, v) for v in edge} == set(said.groups())
        return edge

    def _off_segments(self, violation: Violation) -> bool:
        name = violation.message.removesuffix(" bounds the triangles, but lies on no segment of the domain")
        edge = self._edge(name)
        return edge == frozenset(violation.vertices) and self.edges.get(edge) == 1 and self.segments_at(edge) == 0

    def _covered_hole(self, violation: Violation) -> bool:
        said = re.fullmatch(rf"the hole's point {_POINT} lies in a triangle", violation.message)
        assert said is not None, violation.message
        i = int(said[1].split()[0])
        return said[1] == name_of(self.holes, i) and violation.places == (self.holes[i],) and self.is_hole_covered(i)

    def _bare(self, violation: Violation) -> bool:
        name = violation.message.removeprefix("no triangle covers the face of the domain below ")
        other = re.fullmatch(rf"segment (\d+) of the domain, from point {_POINT} to point {_POINT},", name)
        if other is None:
            edge = self._edge(name)
            s, told = self.line(edge), edge in self.edges and frozenset(violation.vertices) == edge
            told &= violation.places == ()
        else:
            i = int(other[1])
            s, (a, b) = self.lines[i], self.segments[i]
            told = other[2] == name_of(self.theirs, a) and other[3] == name_of(self.theirs, b)
            told &= violation.places == tuple(self.theirs[v] for v in self.segments[i])
            told &= all(
                oracles.on_segment(self.exact[v], *s) and self.exact[v] in self.corners for v in violation.vertices
            )
            ends = [self.corners[p] for p in s if p in self.corners]
            told &= bool(violation.vertices) or not ends or not self._is_alone(s)
        return told and any(self.inside[i] and not self.covered[i] for i in self.beside(s, upper=False))

    def _is_alone(self, s: Line) -> bool:
        """Whether nothing cuts a segment."""
        return len(self.parts(s)) == 1

    def _outside(self, violation: Violation) -> bool:
        name, _, rest = violation.message.partition(", but an ")
        if rest:
            parity = int(rest.startswith("odd"))
            sides = 2 if name.startswith("triangles lie on both sides of ") else 1
            assert sides == 2 - (1 - parity)
            edge = self._edge(
                name.removeprefix("triangles lie on both sides of ").removesuffix(" bounds the triangles")
            )
            told = self.edges.get(edge) == sides and self.segments_at(edge) % 2 == parity
            return told and edge == frozenset(violation.vertices)
        face = name.removeprefix("triangles cover the face below ").removesuffix(", which is outside of the domain")
        edge = self._edge(face)
        sides_of = [*self.beside(self.line(edge), upper=False)]
        told = edge in self.edges and edge == frozenset(violation.vertices) and bool(sides_of)
        return told and all(self.covered[i] and not self.inside[i] for i in sides_of)

    def _missing_point(self, violation: Violation) -> bool:
        said = re.fullmatch(rf"point {_POINT} of the domain is no corner of any triangle", violation.message)
        assert said is not None, violation.message
        v = int(said[1].split()[0])
        told = said[1] == name_of(self.theirs, v) and violation.places == (self.theirs[v],)
        return told and self.own[v] not in self.corners and self.in_domain(self.own[v])

    def _new_point(self, violation: Violation) -> bool:
        (v,) = violation.vertices
        told = violation.message == f"corner {name_of(self.points, v)} is no point of the domain"
        return told and self.exact[v] in self.corners and self.exact[v] not in self.own

    def is_bound(self, finding: Finding) -> bool:
        """Whether a finding should say that there may be more violations than it counts."""
        cut = {Kind.CROSSING, Kind.HANGING_NODE, Kind.OFF_SEGMENTS}
        return finding.verdict is Verdict.FAILS and any(violation.kind in cut for violation in finding.violations)


def _overlap(cell: Trapezoid, x: Fraction, low: Fraction, high: Fraction) -> bool:
    """Whether the side of a trapezoid on the vertical line at x has more than a point in common with low .. high."""
    bottom, top = cell.at(x)
    return (bottom is None or bottom < high) and (top is None or low < top) and (bottom is None or bottom != top)
