"""V1 and V2 for points against triangles: the hull, points at one position, unused points, and angles."""

from collections import Counter
from collections.abc import Sequence
from itertools import permutations
from random import Random

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.oracles import Triangle
from proofs_tests.recording import Record

from exactmesh import delaunay
from exactmesh.verify import Finding, Kind, Property, Verdict, Violation, verify
from exactmesh.verify.hull import first_at_position
from exactmesh.verify.mesh import index_triples
from exactmesh.verify.triangles import Shapes, turned

Points = Sequence[tuple[float, float]]


def some_points(random: Random) -> list[tuple[float, float]]:
    side = random.choice((2, 3, 4))
    return [(float(random.randrange(side)), float(random.randrange(side))) for _ in range(random.randint(1, 9))]


def part(random: Random, points: Points) -> list[Triangle]:
    """Part of a Delaunay triangulation, or all of it; its triangles are counterclockwise."""
    exact = oracles.rationals(points)
    if not any(oracles.orient(exact[0], p, q) for p in exact for q in exact):
        return []
    kept = random.choice((1.0, 0.9, 0.7, 0.3))
    distinct = list(dict.fromkeys(points))
    place = [points.index(p) for p in distinct]
    rows = [(place[a], place[b], place[c]) for a, b, c in delaunay(np.array(distinct)).triangles]
    return [t for t in rows if random.random() < kept]


class Rim:
    """The boundary of admissible triangles: directed edges that no triangle lists the other way."""

    def __init__(self, points: Points, triangles: Sequence[Triangle]) -> None:
        self.points, self.exact = points, oracles.rationals(points)
        self.listed = {(a, b): t for t in triangles for a, b in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))}
        self.edges = [(a, b) for a, b in self.listed if (b, a) not in self.listed]
        self.triangles = triangles

    def reflex(self) -> set[Triangle]:
        """(a, v, b) where the boundary runs through v once, from a to b, and turns clockwise."""
        out, into = dict(self.edges), {b: a for a, b in self.edges}
        times = Counter(a for a, _ in self.edges)
        corners = [(into[v], v, out[v]) for v, count in times.items() if count == 1]
        return {corner for corner in corners if oracles.orient(*(self.exact[u] for u in corner)) < 0}

    def outside(self) -> set[int]:
        """The points in no closed triangle."""
        corners = [[self.exact[u] for u in t] for t in self.triangles]
        return {
            v
            for v, p in enumerate(self.exact)
            if not any(min(oracles.orient(t[i - 1], t[i], p) for i in range(3)) >= 0 for t in corners)
        }

    def is_right(self, finding: Finding) -> bool:
        """Whether all is told of the hull that there is, and nothing else."""
        kinds, reflex = {violation.kind for violation in finding.violations}, self.reflex()
        if finding.verdict is Verdict.HOLDS:
            return oracles.covers_hull(self.exact, self.triangles)
        if kinds == {Kind.POINT_OUTSIDE}:
            told = {violation.vertices: violation.message for violation in finding.violations}
            names = {(v,): f"point {self.name(v)} lies outside of all triangles" for v in self.outside()}
            return told == names and finding.count == len(told) and not finding.lower_bound and not reflex
        if kinds == {Kind.REFLEX_BOUNDARY}:
            told_of = {violation.vertices for violation in finding.violations}
            counted = finding.count == len(reflex) and finding.lower_bound
            return told_of == reflex and counted and all(map(self.is_turn, finding.violations))
        (violation,) = finding.violations
        told_one = self.is_hull if kinds == {Kind.NOT_COVERED} else self.is_part
        return finding.lower_bound and finding.count == 1 and not reflex and told_one(violation)

    def name(self, v: int) -> str:
        return f"{v} {self.points[v]}"

    def is_turn(self, violation: Violation) -> bool:
        a, v, b = violation.vertices
        magnitude = oracles.orient(*(self.exact[u] for u in (a, v, b)))
        message = f"the boundary turns clockwise at {self.name(v)}, between {self.name(a)} - {self.name(b)}"
        return (violation.message, violation.magnitude, violation.sign) == (message, magnitude, -1)

    def is_hull(self, violation: Violation) -> bool:
        """Whether three points have an area that nothing covers."""
        names = ", ".join(map(self.name, violation.vertices))
        turns = oracles.orient(*(self.exact[v] for v in violation.vertices)) != 0
        return turns and not self.triangles and violation.message == f"no triangle covers the points {names}"

    def is_part(self, violation: Violation) -> bool:
        """Whether an edge of the boundary and its triangle are told, and others are not connected with that."""
        (a, b), (row,) = violation.vertices, violation.triangles
        message = f"the union is in several parts; one begins at triangle {row}, {self.name(a)} - {self.name(b)}"
        if not self.triangles:
            return False
        whole, part_ = {*self.listed.values()}, {self.triangles[row]}
        for _ in whole:
            part_ |= {t for t in whole for s in part_ if len({*s} & {*t}) == 2}
        told = violation.kind is Kind.DISCONNECTED and violation.message == message and part_ != whole
        return told and (a, b) in self.edges and self.listed[a, b] == self.triangles[row]


@pytest.mark.obligation("V3", "of the hull all is told that it lacks, and nothing else", method="differential")
class TestHull:
    """A part of a triangulation is told to cover the hull iff their areas are the same; otherwise where its boundary
    turns clockwise, with the corners, their determinant and its sign; or, where it is convex, the points outside of it;
    or what is in parts, by one of them; or what nothing covers at all."""

    @pytest.mark.parametrize("seed", range(12))
    def test_random(self, seed: int, record_property: Record) -> None:
        random = Random(seed)
        for _ in range(40):
            points = some_points(random)
            triangles = part(random, points)
            finding = verify(points, triangles).findings[Property.COVERS_HULL]
            assert Rim(points, triangles).is_right(finding), (points, triangles, finding)
        record_property("cases", 40)

    @pytest.mark.parametrize(
        ("points", "triangles", "kind"),
        [
            ([(0.0, 0.0), (4.0, 0.0), (0.0, 4.0), (4.0, 4.0)], [(0, 1, 2)], Kind.POINT_OUTSIDE),
            ([(0.0, 0.0), (4.0, 0.0), (0.0, 4.0), (1.0, 1.0)], [(0, 1, 3), (0, 3, 2)], Kind.REFLEX_BOUNDARY),
            ([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (5.0, 5.0), (4.0, 5.0), (5.0, 4.0)], [(0, 1, 2), (3, 4, 5)], None),
            ([(2.0, 2.0), (1.0, 2.0), (2.0, 1.0), (3.0, 2.0), (2.0, 3.0)], [(0, 1, 2), (0, 3, 4)], None),
            (
                [(0.0, 0.0), (2.0, 0.0), (4.0, 0.0), (2.0, 1.0), (2.0, 4.0)],
                [(0, 1, 3), (1, 2, 3), (0, 3, 4)],
                Kind.REFLEX_BOUNDARY,  # and straight on elsewhere
            ),
            ([(0.0, 0.0), (1.0, 1.0), (0.0, 2.0)], [], Kind.NOT_COVERED),
        ],
    )
    def test_control_named(self, points: Points, triangles: list[Triangle], kind: Kind | None) -> None:
        """Each sort of fault once; of another list of triangles it is not true."""
        finding = verify(points, triangles).findings[Property.COVERS_HULL]
        assert [violation.kind for violation in finding.violations] == [kind or Kind.DISCONNECTED]
        assert Rim(points, triangles).is_right(finding)
        assert not Rim(points, [] if kind is not Kind.NOT_COVERED else [(0, 1, 2)]).is_right(finding)
        assert not Rim(points, triangles).is_right(Finding(Verdict.HOLDS))

    def test_the_first_at_each_position(self) -> None:
        random = Random(3)
        for _ in range(100):
            points = some_points(random)
            found = first_at_position(np.array(points))
            assert found.tolist() == [points.index(p) for p in points]


@pytest.mark.obligation("V1", "clockwise triangles alone are turned round", method="enumeration", control_in="mutants")
class TestTurned:
    """Turned are the clockwise triangles and no others: those without area stay as they are listed."""

    def test_every_order(self) -> None:
        points = [(0.0, 0.0), (3.0, 0.0), (0.0, 3.0), (6.0, 0.0)]
        rows = list(permutations(range(4), 3))
        exact = oracles.rationals(points)
        signs = [oracles.orient(*(exact[v] for v in t)) for t in rows]
        orientation = np.array([(s > 0) - (s < 0) for s in signs], dtype=np.int8)
        shapes = Shapes(orientation, orientation, np.empty((0, 4), dtype=np.int8))
        triangles = np.array(rows, dtype=np.int32)
        expected = [(a, c, b) if s < 0 else (a, b, c) for (a, b, c), s in zip(rows, signs, strict=True)]
        assert [tuple(t) for t in turned(triangles, shapes).tolist()] == expected
        upright = Shapes(np.abs(orientation), orientation, shapes.turns)
        assert turned(triangles, upright) is triangles


@pytest.mark.obligation("V3", "of each angle it is told how wide it is, and where", method="named cases")
class TestAngles:
    """A triangle that is not acute is told to have an angle of exactly or of more than 90 degrees, at its corner, with
    the scalar product there; or to have no area."""

    @pytest.mark.parametrize("apex", [(2.0, 2.0), (2.0, 1.0), (2.0, 0.0), (2.0, 3.0)])
    @pytest.mark.parametrize("order", [*permutations(range(3))])
    def test_every_order(self, apex: tuple[float, float], order: Triangle) -> None:
        points = [(0.0, 0.0), (4.0, 0.0), apex]
        corners = (order[0], order[1], order[2])
        findings = verify(points, [corners], orientation="any").findings
        for property_, least in ((Property.ACUTE, 0), (Property.WEAKLY_ACUTE, 1)):
            finding, sign = findings[property_], oracles.largest_angle_sign(oracles.rationals(points), corners)
            if apex[1] and sign < least:
                assert finding == Finding(Verdict.HOLDS)
                continue
            (violation,) = finding.violations
            name = ", ".join(f"{v} {points[v]}" for v in corners)
            x, y = apex
            product = int(x * (4 - x) - y * y)
            kind, words = {
                1: (Kind.OBTUSE_ANGLE, f"an angle of more than 90 degrees at 2 {apex}"),
                0: (Kind.RIGHT_ANGLE, f"an angle of exactly 90 degrees at 2 {apex}"),
            }[sign]
            if not y:
                kind, words, product = Kind.ZERO_AREA, "no area", 0
            assert violation.message == f"triangle 0 = {name} has {words}"
            assert (violation.kind, violation.magnitude or 0, violation.sign) == (kind, product, int(product > 0))

    def test_control_acute(self) -> None:
        """An acute triangle, of which nothing is told."""
        triangles = index_triples([(0, 1, 2)])
        assert verify([(0, 0), (4, 0), (2, 3)], triangles).verdict(Property.ACUTE) is Verdict.HOLDS
        assert verify([(0, 0), (4, 0), (2, 1)], triangles).verdict(Property.WEAKLY_ACUTE) is Verdict.FAILS
