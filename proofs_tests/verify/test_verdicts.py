"""V1: the verifier's verdicts are those of brute force, on every set of triangles over small
configurations."""

from collections.abc import Iterator, Sequence
from itertools import combinations
from random import Random

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.once import once_after
from proofs_tests.oracles import RationalPoint, Triangle
from proofs_tests.recording import Record

from exactmesh.verify import Orientation, Property, Verdict, verify

Points = Sequence[tuple[float, float]]

#: Five points each; the names say what is special.
CONFIGURATIONS: dict[str, Points] = {
    "general position, convex": [(0, 0), (4, -1), (6, 3), (3, 6), (-1, 4)],
    "general position, one inside": [(0, 0), (7, 1), (6, 7), (-1, 6), (3, 4)],
    "general position, two inside": [(0, 0), (9, 0), (4, 9), (4, 2), (5, 4)],
    "a point inside an edge": [(0, 0), (4, 0), (4, 4), (0, 4), (2, 0)],
    "the centre of a square": [(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)],
    "grid without a corner": [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1)],
    "three collinear inside": [(0, 0), (6, 0), (3, 5), (3, 1), (3, 2)],
    "cocircular": [(5, 0), (3, 4), (-3, 4), (-5, 0), (0, -5)],
    "two at one position": [(0, 0), (3, 0), (0, 3), (3, 3), (3, 0)],
    "two at one position inside": [(0, 0), (9, 0), (0, 9), (2, 2), (2, 2)],
    "collinear": [(0, 0), (1, 1), (2, 2), (3, 3), (4, 4)],
    "beyond the window": [(0, 0), (1e200, 0), (1e200, 1e-200), (0, 1e-200), (5e199, 5e-201)],
}


class BruteForce:
    """The verdicts of brute force on sets of triangles over fixed points."""

    def __init__(self, points: Points) -> None:
        self.points: list[RationalPoint] = oracles.rationals(points)
        self.meetings: dict[tuple[Triangle, Triangle], bool] = {}

    def meet(self, s: Triangle, t: Triangle) -> bool:
        if (s, t) not in self.meetings:
            self.meetings[s, t] = oracles.meet_admissibly(self.points, s, t)
        return self.meetings[s, t]

    def verdicts(self, triangles: Sequence[Triangle], orientation: Orientation) -> dict[Property, bool]:
        points, used = self.points, {v for t in triangles for v in t}
        turned = [oracles.counterclockwise(points, t) for t in triangles]
        listed = turned if orientation is Orientation.ANY else triangles
        solid = all(oracles.has_area(points, t) for t in triangles)
        angles = [oracles.largest_angle_sign(points, t) for t in triangles] if solid else [1]
        admissible = solid and all(self.meet(s, t) for s, t in combinations(turned, 2))
        return {
            Property.FINITE: True,
            Property.INDICES: True,
            Property.DISTINCT_POINTS: len(set(points)) == len(points),
            Property.ORIENTATION: all(oracles.orient(*(points[v] for v in t)) > 0 for t in listed),
            Property.ALL_POINTS_USED: used == set(range(len(points))),
            Property.EDGE_MANIFOLD: oracles.is_edge_manifold(listed),
            Property.VERTEX_MANIFOLD: oracles.is_vertex_manifold(listed),
            Property.ADMISSIBLE: admissible,
            Property.COVERS_HULL: admissible and oracles.covers_hull(points, triangles),
            Property.DELAUNAY: oracles.is_delaunay(points, triangles),
            Property.WEAKLY_ACUTE: all(sign <= 0 for sign in angles),
            Property.ACUTE: all(sign < 0 for sign in angles),
        }


def disagreements(
    brute: BruteForce,
    points: Points,
    triangles: Sequence[Triangle],
    orientation: Orientation = Orientation.CCW,
) -> list[str]:
    """Return where the verifier contradicts brute force, or is undecided without the reason that the enum
    states."""
    report = verify(points, list(triangles), orientation=orientation)
    faults = []
    for property_, truth in brute.verdicts(triangles, orientation).items():
        finding = report.findings[property_]
        if finding.verdict is Verdict.UNDECIDED:
            prerequisites = {Property.COVERS_HULL: 1, Property.DELAUNAY: 2}[property_]
            allowed = (Property.ADMISSIBLE, Property.COVERS_HULL)[:prerequisites]
            if not finding.because or any(
                missing not in allowed or report.verdict(missing) is Verdict.HOLDS for missing in finding.because
            ):
                faults.append(f"{property_} undecided because of {finding.because}")
        elif (finding.verdict is Verdict.HOLDS) is not truth:
            faults.append(f"{property_} {finding.verdict}")
        if (finding.verdict is Verdict.FAILS) is not (finding.count > 0) or bool(finding.violations) is not bool(
            finding.count
        ):
            faults.append(f"{property_} {finding.verdict} with {finding.count} violations")
    return faults


#: Six points each, for what five are too few for: two cells apart, that touch at a vertex, or that cross in a star.
SIX: dict[str, Points] = {
    "a star of David, convex": [(0, 0), (6, 0), (3, 5), (0, 3), (6, 3), (3, -2)],
    "grid of two by three": [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)],
}


def all_sets(brute: BruteForce, most: int | None = None) -> Iterator[tuple[Triangle, ...]]:
    """Every set of triples of the points, counterclockwise: 1,024 of five points; with so many triples at most."""
    triples = [oracles.counterclockwise(brute.points, t) for t in combinations(range(len(brute.points)), 3)]
    for size in range(1 + (len(triples) if most is None else most)):
        yield from combinations(triples, size)


@pytest.mark.obligation(
    "V1",
    "every set of triangles over five points, of three over six, is judged as brute force judges it",
    method="enumeration",
    control_in="proofs_tests/verify/test_meshes.py::TestAblation",
)
class TestEverySet:
    """For every set of triangles over five points, and of at most three over six, each decided verdict is that of
    brute force, and only the two documented ones are ever undecided."""

    @pytest.mark.parametrize("points", once_after(1, CONFIGURATIONS.values(), CONFIGURATIONS.keys()))
    def test_verdicts(self, points: Points, record_property: Record) -> None:
        brute = BruteForce(points)
        sets = list(all_sets(brute))
        for triangles in sets:
            assert not disagreements(brute, points, triangles), triangles
        record_property("cases", len(sets))

    @pytest.mark.once
    @pytest.mark.parametrize("points", SIX.values(), ids=SIX.keys())
    def test_three_triangles_over_six_points(self, points: Points, record_property: Record) -> None:
        brute = BruteForce(points)
        sets = list(all_sets(brute, most=3))
        assert len(sets) == 1 + 20 + 190 + 1140
        for triangles in sets:
            assert not disagreements(brute, points, triangles), triangles
        record_property("cases", len(sets))

    def test_brute_force_accepts_and_rejects_each_property(self) -> None:
        """The enumeration is not vacuous: each property is true of some set, and all but the first two false
        of some."""
        seen: dict[Property, set[bool]] = {property_: set() for property_ in verify([], []).findings}
        for points in CONFIGURATIONS.values():
            brute = BruteForce(points)
            for triangles in list(all_sets(brute))[::9]:
                for property_, truth in brute.verdicts(triangles, Orientation.CCW).items():
                    seen[property_].add(truth)
        seen[Property.ORIENTATION].add(False)  # see the next class
        assert all(truths == {True, False} for truths in list(seen.values())[2:])


def random_triangles(random: Random, n: int, size: int) -> list[Triangle]:
    triangles = []
    for _ in range(size):
        a, b, c = random.sample(range(n), 3)
        triangles.append((a, b, c))
    return triangles


@pytest.mark.obligation(
    "V1",
    "random lists of triangles over six and seven points, degenerate ones too, are judged as by brute force",
    method="differential",
    control_in="proofs_tests/verify/test_meshes.py::TestAblation",
)
class TestRandomSets:
    """The same for random lists over six and seven points of a small grid: any orientation, repeated
    triangles, collinear and coincident points."""

    @pytest.mark.parametrize("seed", once_after(10, range(40)))
    def test_any_order_of_corners(self, seed: int, record_property: Record) -> None:
        random = Random(seed)
        n = random.choice((6, 7))
        points = [(random.randrange(4), random.randrange(4)) for _ in range(n)]
        brute = BruteForce(points)
        for _ in range(10):
            triangles = random_triangles(random, n, random.randrange(1, 7))
            for orientation in Orientation:
                assert not disagreements(brute, points, triangles, orientation), (points, triangles)
        record_property("cases", 10 * len(Orientation))

    @pytest.mark.parametrize("seed", once_after(15, range(60)))
    def test_nearly_admissible(self, seed: int, record_property: Record) -> None:
        """Sets grown by adding triangles that meet the others admissibly, and one that need not: the hard
        negatives."""
        random = Random(seed)
        n = random.choice((6, 7, 8))
        points = [(random.randrange(6), random.randrange(6)) for _ in range(n)]
        brute = BruteForce(points)
        triangles: list[Triangle] = []
        candidates = [oracles.counterclockwise(brute.points, t) for t in combinations(range(n), 3)]
        random.shuffle(candidates)
        for t in candidates:
            if oracles.has_area(brute.points, t) and (
                all(brute.meet(s, t) for s in triangles) or random.random() < 0.02
            ):
                triangles.append(t)
                assert not disagreements(brute, points, triangles), (points, triangles)
        record_property("cases", len(triangles))


#: Meshes whose faults no local check sees; each with the kind of its violation.
STAR = [(0.0, 0.0)] + [(float(np.cos(a)), float(np.sin(a))) for a in np.arange(5) * 4 * np.pi / 5]


@pytest.mark.obligation(
    "V2",
    "what only a global condition finds, the double cover first, is found, and its kind is named",
    method="named cases",
)
class TestHardSets:
    """What only a global condition finds is found, and the same mesh without the fault is accepted."""

    def test_double_cover(self) -> None:
        """Theorem G: the star that winds twice has positive triangles and matched edges, one fan, no repeated
        edge."""
        triangles = [(0, 1 + i, 1 + (i + 1) % 5) for i in range(5)]
        report = verify(STAR, triangles)
        for property_ in (Property.ORIENTATION, Property.EDGE_MANIFOLD, Property.VERTEX_MANIFOLD):
            assert report.verdict(property_) is Verdict.HOLDS
        assert report.verdict(Property.ADMISSIBLE) is Verdict.FAILS
        order = [1, 3, 5, 2, 4]  # the same points in the order of the hull
        simple = [(0, order[i - 1], order[i]) for i in range(5)]
        report = verify(
            [STAR[0], *(STAR[v] for v in range(1, 6))], [(a, c, b) for a, b, c in simple], orientation="any"
        )
        assert report.verdict(Property.ADMISSIBLE) is Verdict.HOLDS

    @pytest.mark.parametrize(
        ("points", "triangles", "kind"),
        [
            ([(0, 0), (9, 0), (0, 9), (1, 1), (2, 1), (1, 2)], [(0, 1, 2), (3, 4, 5)], "overlap"),
            ([(0, 0), (4, 0), (0, 4), (1, 3), (-1, 1), (5, 1)], [(0, 1, 2), (4, 5, 3)], "crossing"),
            ([(0, 0), (4, 0), (2, 4), (2, 0), (1, -3), (3, -3)], [(0, 1, 2), (4, 5, 3)], "hanging_node"),
            ([(0, 0), (4, 0), (2, 4), (4, 0), (9, 0), (9, 4)], [(0, 1, 2), (3, 4, 5)], "hanging_node"),
            ([(0, 0), (4, 0), (2, 4), (6, 4)], [(0, 1, 2), (0, 1, 3)], "overlap"),
            ([(0, 0), (4, 0), (2, 4), (2, -4), (2, 0)], [(0, 1, 2), (0, 3, 4), (4, 3, 1)], "hanging_node"),
            ([(0, 0), (2, 0), (4, 0)], [(0, 1, 2)], "zero_area"),
        ],
    )  # fmt: skip
    def test_control_kind_of_fault(self, points: Points, triangles: list[Triangle], kind: str) -> None:
        """A cell laid over another, cells that cross, hanging nodes, a cell without area."""
        report = verify(points, triangles)
        finding = report.findings[Property.ADMISSIBLE]
        assert finding.verdict is Verdict.FAILS
        assert finding.violations[0].kind == kind
        assert verify(points, triangles[:1]).verdict(Property.ADMISSIBLE) is (
            Verdict.FAILS if kind == "zero_area" else Verdict.HOLDS
        )

    @pytest.mark.parametrize(
        ("points", "triangles"),
        [
            ([(0, 0), (4, 0), (2, 4), (-4, -1), (-2, -4)], [(0, 1, 2), (0, 3, 4)]),  # pinched
            ([(0, 0), (4, 0), (2, 4), (10, 0), (14, 0), (12, 4)], [(0, 1, 2), (3, 4, 5)]),  # apart
            ([(0, 0), (0, 5), (-5, 0), (0, -5), (5, 0)], [(0, 1, 2), (0, 3, 4)]),  # pinched, vertical edges
        ],
    )
    def test_admissible_all_the_same(self, points: Points, triangles: list[Triangle]) -> None:
        report = verify(points, triangles)
        assert report.verdict(Property.ADMISSIBLE) is Verdict.HOLDS
        assert report.verdict(Property.COVERS_HULL) is Verdict.FAILS
        assert report.verdict(Property.VERTEX_MANIFOLD) is (Verdict.HOLDS if len(points) == 6 else Verdict.FAILS)
