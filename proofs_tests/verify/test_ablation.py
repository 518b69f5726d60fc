"""V1 and V2: the theorems behind the verifier suffice, and no condition of them can be left out."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations, permutations

import pytest
from proofs_tests import oracles
from proofs_tests.oracles import RationalPoint, Triangle
from proofs_tests.recording import Record
from proofs_tests.verify.corrupted_oracle import Case, Truth
from proofs_tests.verify.naive_checker import (
    CONVEX_CONDITIONS,
    DOMAIN_CONDITIONS,
    HULL_CONDITIONS,
    boundary_of,
    broken_by_cycle,
    broken_of_domain,
    broken_of_hull,
)
from proofs_tests.verify.test_constrained import Plain
from proofs_tests.verify.test_verdicts import CONFIGURATIONS, BruteForce, all_sets

from exactmesh.verify import DELAUNAY_TRIANGULATION, Orientation, Property, Verdict, verify

Points = Sequence[tuple[float, float]]
Pair = tuple[int, int]

#: A star that winds twice about its first point.
STAR: Points = [(0, 0), (10, 0), (-8, 6), (3, -9), (3, 9), (-8, -6)]
TWICE: list[Triangle] = [(0, 1 + i, 1 + (i + 1) % 5) for i in range(5)]
KITE: Points = [(0, 0), (3, -1), (6, 0), (3, 1)]
SQUARE: Points = [(0, 0), (2, 0), (2, 2), (0, 2)]
HALVES: list[Triangle] = [(0, 1, 2), (0, 2, 3)]

#: For each condition a mesh of which it alone is broken, and what the verifier says then.
HULL: dict[str, list[tuple[Points, list[Triangle], Property]]] = {
    "positive": [
        ([(5, 1), (0, 1), (5, 4), (4, 5), (1, 5)], [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 1)], Property.ORIENTATION),
        ([(2, 0), (2, 0), (1, 4), (0, 0)], [(2, 3, 0), (1, 0, 3)], Property.ADMISSIBLE),  # flat
    ],
    "edges once": [(SQUARE, [*HALVES, *HALVES], Property.EDGE_MANIFOLD)],
    "one cycle": [
        ([(2, 2), (1, 2), (4, 3), (4, 1), (1, 1)], [(1, 0, 2), (4, 3, 2)], Property.COVERS_HULL),  # pinched
        ([*SQUARE[:3], (5, 0), (6, 0), (5, 1)], [(0, 1, 2), (3, 4, 5)], Property.COVERS_HULL),  # apart
    ],
    "turns left": [([(0, 3), (1, 4), (4, 0), (2, 2)], [(1, 3, 2), (3, 1, 0)], Property.COVERS_HULL)],
    "winds once": [(STAR, TWICE, Property.ADMISSIBLE)],
    "all used": [([(0, 0), (2, 3), (0, 3), (3, 0)], [(1, 2, 0)], Property.ALL_POINTS_USED)],
    "locally Delaunay": [(KITE, HALVES, Property.DELAUNAY)],
}


def is_right(points: Points, triangles: Sequence[Triangle]) -> bool:
    """Brute force: counterclockwise, admissible, all of the hull, all points, no point in a circle."""
    exact = oracles.rationals(points)
    return (
        all(oracles.orient(*(exact[v] for v in t)) > 0 for t in triangles)
        and oracles.is_admissible(exact, triangles)
        and oracles.covers_hull(exact, triangles)
        and {v for t in triangles for v in t} == set(range(len(points)))
        and oracles.is_delaunay(exact, triangles)
    )


@pytest.mark.once
@pytest.mark.obligation(
    "V1",
    "theorems A to D: the local conditions accept exactly the Delaunay triangulations",
    method="enumeration",
    control_in="TestHullConditionsAreNecessary",
)
class TestHullConditionsSuffice:
    """For sets of triangles over five points, all conditions hold exactly if brute force finds nothing wrong: for every
    set for which they hold, and for every ninth of the others."""

    @pytest.mark.parametrize("points", CONFIGURATIONS.values(), ids=CONFIGURATIONS.keys())
    def test_every_set(self, points: Points, record_property: Record) -> None:
        brute = BruteForce(points)
        accepted = compared = 0
        for i, triangles in enumerate(all_sets(brute)):
            broken = broken_of_hull(brute.points, triangles) if triangles else {"there is no cycle"}
            accepted += not broken
            if not broken or i % 9 == 0:
                compared += 1
                verdicts = brute.verdicts(triangles, Orientation.CCW)
                right = bool(triangles) and all(verdicts[property_] for property_ in DELAUNAY_TRIANGULATION)
                assert (not broken) is right, triangles
        exact = brute.points
        has_one = len(set(exact)) == 5 and any(oracles.has_area(exact, t) for t in combinations(range(5), 3))
        assert (accepted > 0) is has_one
        record_property("cases", compared)


@pytest.mark.obligation("V2", "theorems A to D: each condition is necessary", method="ablation")
class TestHullConditionsAreNecessary:
    """Without any one condition the checker accepts a mesh that is wrong; the verifier refuses it, and says why."""

    def test_there_is_a_mesh_for_each(self) -> None:
        assert tuple(HULL) == HULL_CONDITIONS

    @pytest.mark.parametrize(
        ("name", "points", "triangles", "property_"),
        [(name, *mesh) for name, meshes in HULL.items() for mesh in meshes],
    )
    def test_ablation(self, name: str, points: Points, triangles: list[Triangle], property_: Property) -> None:
        assert broken_of_hull(oracles.rationals(points), triangles) == {name}
        assert not is_right(points, triangles)
        assert verify(points, triangles).verdict(property_) is Verdict.FAILS

    @pytest.mark.parametrize(("points", "triangles"), [(SQUARE, HALVES), (KITE, [(0, 1, 3), (1, 2, 3)])])
    def test_control_nothing_is_broken(self, points: Points, triangles: list[Triangle]) -> None:
        """None: sound meshes break no condition."""
        assert not broken_of_hull(oracles.rationals(points), triangles)
        assert verify(points, triangles).ok


#: Theorem C: closed polygons, each with one fault.
POLYGONS: dict[str, Points] = {
    "turns left": [(0, 0), (4, 0), (2, 1), (1, 4)],
    "goes straight on": [(0, 0), (4, 0), (2, 0)],
    "winds once": [STAR[1 + i] for i in range(5)],
}


@pytest.mark.obligation("V2", "theorem C: each condition is necessary", method="ablation")
class TestConvexConditionsAreNecessary:
    """A closed polygon that turns left or goes straight on, never back, and changes its lexicographic direction twice,
    is convex; without any one of the three conditions one passes that is not."""

    def test_there_is_a_polygon_for_each(self) -> None:
        assert tuple(POLYGONS) == CONVEX_CONDITIONS

    @pytest.mark.parametrize(("name", "polygon"), POLYGONS.items(), ids=POLYGONS.keys())
    def test_control_ablation(self, name: str, polygon: Points) -> None:
        """Polygons that are not convex and break one of the three conditions alone."""
        exact = oracles.rationals(polygon)
        assert broken_by_cycle(exact, range(len(exact))) == {name}
        assert not 0 < _area(exact) == oracles.hull_area(exact)

    @pytest.mark.once
    @pytest.mark.parametrize("size", [3, 4, 5])
    def test_they_suffice(self, size: int) -> None:
        """For every closed walk of distinct points of a grid: the conditions hold exactly of the convex polygons, those
        whose edges have all the others on the left or between their ends."""
        grid = oracles.rationals([(x, y) for x in range(3) for y in range(3 if size < 5 else 2)])
        for polygon in permutations(grid, size):
            edges = list(zip(polygon, polygon[1:] + polygon[:1], strict=True))
            beside = ((oracles.orient(a, b, p), a, b, p) for a, b in edges for p in polygon if p not in (a, b))
            convex = all(side > 0 or (side == 0 and not oracles.on_segment(p, a, b)) for side, a, b, p in beside)
            right = convex and 0 < _area(polygon) == oracles.hull_area(polygon)
            assert (not broken_by_cycle(polygon, range(size))) is right, polygon


def _area(polygon: Sequence[RationalPoint]) -> Fraction:
    turned = [*polygon[1:], polygon[0]]
    return sum((p[0] * q[1] - p[1] * q[0] for p, q in zip(polygon, turned, strict=True)), Fraction(0))


#: Points, triangles, the boundary of the domain (None: that of the triangles), segments, and what the verifier says.
Region = tuple[Points, list[Triangle], list[Pair] | None, list[Pair], Property]
REGIONS: dict[str, list[Region]] = {
    "positive": [
        ([(4, 0), (0, 2), (4, 2), (4, 1)], [(2, 3, 0), (1, 0, 3), (3, 2, 1)], None, [], Property.ORIENTATION),
    ],
    "edges once": [(SQUARE, [*HALVES, *HALVES], None, [], Property.EDGE_MANIFOLD)],
    "boundary is the domain's": [
        (SQUARE, [(0, 1, 2)], [(0, 1), (1, 2), (2, 3), (3, 0)], [], Property.COVERS_DOMAIN),
        (SQUARE, HALVES, [(0, 1), (1, 2), (2, 0)], [], Property.COVERS_DOMAIN),
    ],
    "boundary is simple": [
        ([(3, 0), (4, 0), (3, 3), (0, 3), (4, 2)], [(2, 0, 4), (3, 0, 1)], None, [], Property.ADMISSIBLE),
    ],
    "positions differ": [
        ([(2, 1), (2, 1), (2, 0), (0, 4), (0, 0), (4, 1)], [(1, 3, 4), (0, 2, 5)], None, [], Property.ADMISSIBLE),
    ],
    "winds round": [
        ([(0, 0), (9, 0), (0, 9), (1, 1), (2, 1), (1, 2)], [(0, 1, 2), (3, 4, 5)], None, [], Property.ADMISSIBLE),
    ],
    "no point within": [
        ([(0, 3), (2, 1), (2, 3), (1, 2)], [(0, 1, 2)], None, [], Property.CONSTRAINED_DELAUNAY),
    ],
    "segments are edges": [(KITE, [(0, 1, 3), (1, 2, 3)], None, [(0, 2)], Property.SEGMENTS_PRESENT)],
    "locally Delaunay": [(KITE, HALVES, None, [], Property.CONSTRAINED_DELAUNAY)],
}


@pytest.mark.obligation("V2", "theorems A, B, E, F: each condition is necessary", method="ablation")
class TestDomainConditionsAreNecessary:
    """The same for domains, bounded by directed edges."""

    def test_there_is_a_mesh_for_each(self) -> None:
        assert tuple(REGIONS) == DOMAIN_CONDITIONS

    @pytest.mark.parametrize(
        ("name", "region"), [(name, region) for name, regions in REGIONS.items() for region in regions]
    )
    def test_ablation(self, name: str, region: Region) -> None:
        points, triangles, domain, segments, property_ = region
        outline = boundary_of(triangles) if domain is None else domain
        assert broken_of_domain(oracles.rationals(points), triangles, outline, segments) == {name}
        if property_ in (Property.SEGMENTS_PRESENT, Property.CONSTRAINED_DELAUNAY):
            report = verify(points, triangles, segments=segments)
        else:
            report = verify(points, triangles, domain=Plain.of(points, outline))
        assert report.verdict(property_) is Verdict.FAILS

    def test_the_double_cover(self) -> None:
        """Theorem G: of the star that winds twice only what concerns its boundary is broken."""
        exact = oracles.rationals(STAR)
        assert broken_of_domain(exact, TWICE, boundary_of(TWICE)) == {"boundary is simple", "winds round"}
        assert not oracles.is_admissible(exact, TWICE)
        report = verify(STAR, TWICE)
        for property_ in (Property.ORIENTATION, Property.EDGE_MANIFOLD, Property.VERTEX_MANIFOLD):
            assert report.verdict(property_) is Verdict.HOLDS
        assert report.verdict(Property.ADMISSIBLE) is Verdict.FAILS

    def test_control_nothing_is_broken(self) -> None:
        """None: a sound mesh breaks no condition."""
        exact = oracles.rationals(KITE)
        assert not broken_of_domain(exact, HALVES, boundary_of(HALVES), [(0, 2)])
        assert verify(KITE, HALVES, segments=[(0, 2)]).ok


@pytest.mark.once
@pytest.mark.obligation(
    "V1",
    "theorems A, B, E: the conditions accept exactly the constrained Delaunay triangulations",
    method="enumeration",
    control_in="TestDomainConditionsAreNecessary",
)
class TestDomainConditionsSuffice:
    """For sets of triangles over five points, as the domain that they bound: all conditions hold exactly if they are
    counterclockwise, admissible, over no unused point, and no visible point lies in a circle."""

    @pytest.mark.parametrize("name", list(CONFIGURATIONS)[:-1])  # the last is but another scale
    def test_sets(self, name: str, record_property: Record) -> None:
        points = CONFIGURATIONS[name]
        brute = BruteForce(points)
        exact = brute.points
        some = list(all_sets(brute))[1::13]
        for triangles in some:
            right = not broken_of_domain(exact, triangles, boundary_of(triangles))
            unused = set(range(len(points))) - {v for t in triangles for v in t}
            truth = (
                all(oracles.orient(*(exact[v] for v in t)) > 0 for t in triangles)
                and all(brute.meet(s, t) for s, t in combinations(triangles, 2))
                and not any(
                    all(oracles.orient(exact[a], exact[b], exact[v]) >= 0 for a, b in ((p, q), (q, r), (r, p)))
                    for v in unused
                    for p, q, r in triangles
                )
                and Truth(Case([(float(x), float(y)) for x, y in points], list(triangles))).ask(
                    Property.CONSTRAINED_DELAUNAY
                )
            )
            assert right is truth, triangles
        record_property("cases", len(some))
