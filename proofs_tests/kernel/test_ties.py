"""K9: ties among cocircular points are broken consistently, so that the Delaunay triangulation is unique."""

from collections.abc import Callable, Sequence
from itertools import combinations, permutations, product
from random import Random

import pytest
from proofs_tests.kernel.oracle import parity
from proofs_tests.recording import Record

from exactkernel import incircle, incircle_perturbed, orient2d

Cell = tuple[int, int]
Predicate = Callable[[Cell, Cell, Cell, Cell], int]

GRID_3 = [(x, y) for x in range(3) for y in range(3)]
GRID_4 = [(x, y) for x in range(4) for y in range(4)]


def is_antisymmetric(predicate: Predicate, points: Sequence[Cell]) -> bool:
    """Every permutation of four points changes the sign by its parity, and the sign is not zero."""
    a, b, c, d = points
    reference = int(predicate(a, b, c, d))
    return reference != 0 and all(
        int(predicate(*(points[i] for i in p))) == parity(p) * reference for p in permutations(range(4))
    )


def ignoring_the_order(a: Cell, b: Cell, c: Cell, d: Cell) -> int:
    """A seeded fault: ties say 'inside' whatever the order of the points."""
    return int(incircle(a, b, c, d)) or 1


@pytest.mark.obligation(
    "K9", "perturbed incircle is never zero and antisymmetric (exhaustive on the 4 x 4 grid)", method="enumeration"
)
class TestPerturbedSign:
    """For four distinct points that are not all on a line the sign is not 0, changes with the parity of the order, and
    is that of incircle wherever that decides."""

    def test_all_fours_of_a_grid(self, record_property: Record) -> None:
        ties = 0
        fours = list(combinations(GRID_4, 4))
        for points in fours:
            if all(orient2d(points[0], points[1], p) == 0 for p in points[2:]):
                assert incircle_perturbed(*points) == 0
                continue
            sign = incircle(*points)
            ties += sign == 0
            assert sign in (0, incircle_perturbed(*points))
            assert is_antisymmetric(incircle_perturbed, points)
        assert ties > 150
        record_property("cases", len(fours))

    def test_control_other_predicates_are_refused(self) -> None:
        """The plain incircle, and a perturbation that ignores the order of the points."""
        square = ((0, 0), (1, 0), (1, 1), (0, 1))
        assert not is_antisymmetric(incircle, square)
        assert not is_antisymmetric(ignoring_the_order, square)


@pytest.mark.obligation(
    "K9", "where two of four points coincide no tie is broken", method="exhaustive", control_in="mutants"
)
class TestCoincident:
    """The lift belongs to the point: where two of the four are one point, the perturbed sign is 0 as incircle is,
    whichever two places they have, and whether the point is the smallest or not."""

    @pytest.mark.parametrize("others", [((1, 0), (1, 2), (0, 1)), ((2, 1), (-1, 1), (1, 2))])
    def test_all_pairs_of_places(self, others: tuple[Cell, Cell, Cell]) -> None:
        places = 0
        for points in product(((0, 0), *others), repeat=4):
            if len({*points}) < 4:
                assert incircle_perturbed(*points) == 0
                places += 1
            else:
                assert incircle_perturbed(*points) != 0
        assert places == 4**4 - 24


def triangulation(points: Sequence[Cell], predicate: Predicate) -> list[tuple[Cell, Cell, Cell]]:
    """The counterclockwise triangles whose circle has no other point inside, by definition."""
    found = []
    for a, b, c in combinations(points, 3):
        turn = orient2d(a, b, c)
        if turn == 0:
            continue
        if turn < 0:
            b, c = c, b
        if all(predicate(a, b, c, p) < 0 for p in points if p not in (a, b, c)):
            found.append((a, b, c))
    return found


def twice_hull_area(points: Sequence[Cell]) -> int:
    """By Jarvis' march, in integers."""
    start = current = min(points)
    area = 0
    while True:
        following = next(p for p in points if p != current)
        for p in points:
            turn = _cross(current, following, p)
            further = _cross_length(current, p) > _cross_length(current, following)
            if turn < 0 or (turn == 0 and further):
                following = p
        area += current[0] * following[1] - current[1] * following[0]
        current = following
        if current == start:
            return area


def _cross(a: Cell, b: Cell, c: Cell) -> int:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _cross_length(a: Cell, b: Cell) -> int:
    return (b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2


def covers_the_hull_once(points: Sequence[Cell], predicate: Predicate) -> bool:
    """The areas sum to the hull's, every point is used, and no directed edge occurs twice."""
    triangles = triangulation(points, predicate)
    edges = [(t[i - 1], t[i]) for t in triangles for i in range(3)]
    return (
        sum(_cross(*t) for t in triangles) == twice_hull_area(points)
        and {p for t in triangles for p in t} == set(points)
        and len(set(edges)) == len(edges)
    )


def random_subsets(count: int) -> list[list[Cell]]:
    random = Random(2)
    subsets = [random.sample(GRID_4, random.randint(4, 10)) for _ in range(count)]
    return [s for s in subsets if any(orient2d(s[0], s[1], p) != 0 for p in s)]


@pytest.mark.obligation(
    "K9", "the triangles with empty perturbed circles are one triangulation of the hull", method="property-based"
)
class TestUniqueTriangulation:
    """The triangles whose perturbed circle is empty cover the convex hull exactly once and use every point."""

    def test_grids(self, record_property: Record) -> None:
        assert covers_the_hull_once(GRID_3, incircle_perturbed)
        assert covers_the_hull_once(GRID_4, incircle_perturbed)
        record_property("cases", 2)

    def test_random_subsets(self, record_property: Record) -> None:
        subsets = random_subsets(120)
        for subset in subsets:
            assert covers_the_hull_once(subset, incircle_perturbed)
        record_property("cases", len(subsets))

    def test_the_order_of_the_points_does_not_matter(self) -> None:
        def as_set(points: Sequence[Cell]) -> set[frozenset[Cell]]:
            return {frozenset(t) for t in triangulation(points, incircle_perturbed)}

        for subset in random_subsets(20):
            assert as_set(subset) == as_set(sorted(subset)) == as_set(subset[::-1])

    @pytest.mark.parametrize("predicate", [incircle, ignoring_the_order])
    def test_control_unbroken_ties_leave_holes_or_overlaps(self, predicate: Predicate) -> None:
        """The plain incircle, and a perturbation that ignores the order of the points."""
        assert not covers_the_hull_once(GRID_3, predicate)

    def test_control_ties_broken_the_other_way_overlap(self) -> None:
        """Every tie broken to the outside."""

        def always_outside(a: Cell, b: Cell, c: Cell, d: Cell) -> int:
            return int(incircle(a, b, c, d)) or -1

        assert not covers_the_hull_once(GRID_3, always_outside)
