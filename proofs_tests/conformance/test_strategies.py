"""The public strategies: what they draw is what they promise, shrinks to the smallest of its kind, and finds bugs."""

import math
import subprocess
import sys
from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import combinations
from typing import TypeAlias, TypeVar

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, find, given, settings
from hypothesis import strategies as st
from hypothesis.errors import NoSuchExample
from proofs_tests import oracles
from proofs_tests.verify import domain_oracle

from exactkernel.types import FloatArray
from exactmesh import PSLG, constrained_delaunay, strategies, verify
from exactmesh.errors import HypothesisUnavailableError, OptionError
from exactmesh.strategies.regular import circle

pytestmark = pytest.mark.once


T = TypeVar("T")
Family: TypeAlias = Callable[..., st.SearchStrategy[FloatArray]]
Graphs: TypeAlias = Callable[..., st.SearchStrategy[PSLG]]

FAMILIES: list[Family] = [
    strategies.uniform_points,
    strategies.clustered_points,
    strategies.grid_points,
    strategies.tilted_grid_points,
    strategies.cocircular_points,
    strategies.collinear_points,
    strategies.far_points,
    strategies.mixed_scale_points,
    strategies.subnormal_points,
    strategies.duplicate_points,
    strategies.points,
]
DOMAINS: list[Graphs] = [
    strategies.polygons,
    strategies.polygons_with_holes,
    strategies.slits,
    strategies.spirals,
    strategies.small_angles,
    strategies.shared_borders,
    strategies.t_junctions,
    strategies.pslgs,
]
LEAST = {
    "polygons_with_holes": 7,
    "slits": 6,
    "t_junctions": 5,
    "spirals": 4,
    "shared_borders": 4,
    "near_concurrent": 4,
}


def anything(_: object) -> bool:
    return True


quiet = settings(
    max_examples=30, deadline=None, database=None, derandomize=True, suppress_health_check=list(HealthCheck)
)
search = settings(quiet, max_examples=1000, phases=(Phase.generate, Phase.shrink))


def name_of(function: Callable[..., object]) -> str:
    return function.__name__


def drawn(strategy: st.SearchStrategy[T], count: int = 40) -> list[T]:
    """Some of what the strategy draws, always the same."""
    found: list[T] = []

    @settings(quiet, max_examples=count)
    @given(strategy)
    def collect(value: T) -> None:
        found.append(value)

    collect()
    return found


@pytest.mark.obligation(
    "S1", "every family draws finite doubles, as many as asked for, distinct where it says so", method="property-based"
)
class TestPoints:
    """Every family draws finite doubles, as many as it was asked for, and where it says so, distinct ones."""

    @pytest.mark.parametrize("sizes", [(0, 0), (1, 1), (2, 3), (3, 12), (50, 50), (600, 600)], ids=str)
    @pytest.mark.parametrize("family", FAMILIES, ids=name_of)
    def test_sizes(self, family: Family, sizes: tuple[int, int]) -> None:
        low, high = sizes
        sets = drawn(family(min_size=low, max_size=high), 8 if high > 50 else 40)
        for points in sets:
            assert points.dtype == np.float64
            assert points.shape == (len(points), 2)
            assert low <= len(points) <= high
            assert np.isfinite(points).all()
        assert len({len(points) for points in sets}) >= min(3, high - low + 1)

    @pytest.mark.parametrize("family", FAMILIES[:-2], ids=name_of)
    def test_distinct(self, family: Family) -> None:
        for points in drawn(family(min_size=0, max_size=60)):
            assert len(set(map(tuple, points.tolist()))) == len(points)

    def test_control_duplicates(self) -> None:
        """The family of duplicates, which are not distinct."""
        for points in drawn(strategies.duplicate_points(min_size=2, max_size=60)):
            assert len(set(map(tuple, points.tolist()))) < len(points)

    @pytest.mark.parametrize("ulps", [0, 1, 5])
    def test_collinear_points_are_near_a_line(self, ulps: int) -> None:
        """All are as near to the line through the first and the last of them as rounding and ulps go."""
        sizes = []
        for points in drawn(strategies.collinear_points(min_size=3, max_size=9, ulps=ulps)):
            exact = oracles.rationals(points.tolist())
            a, b = min(exact), max(exact)
            largest = max(max(abs(x), abs(y)) for x, y in exact)
            sizes += [abs(oracles.orient(a, b, p)) / largest**2 for p in exact]
        assert max(sizes) <= 8 * (ulps + 1) * Fraction(2) ** -52
        assert max(sizes) > ulps * Fraction(2) ** -53
        assert min(sizes) == 0

    def test_circles(self) -> None:
        """The integer points are those that brute force finds."""
        for radius, count in ((1, 4), (5, 12), (25, 20), (65, 36), (325, 60)):
            steps = range(-radius, radius + 1)
            squares = {x * x: x for x in range(radius + 1)}
            roots = {(x, squares.get(radius * radius - x * x)) for x in steps}
            expected = {(x, sign * y) for x, y in roots if y is not None for sign in (1, -1)}
            assert set(map(tuple, circle(radius).tolist())) == expected
            assert len(circle(radius)) == len(expected) == count
        assert [len(circle(radius)) for radius in (1105, 5525, 32045, 160225)] == [108, 180, 324, 540]

    def test_cocircular_points_are_exactly_so_or_nearly(self) -> None:
        kinds = set()
        for points in drawn(strategies.cocircular_points(min_size=4, max_size=30)):
            exact = oracles.rationals(points.tolist())
            centre, radius = oracles.circumcircle(*exact[:3])
            off = max(abs(oracles.squared_distance(centre, p) / radius - 1) for p in exact)
            kinds.add(off == 0)
            assert off < Fraction(1, 10**6)
        assert kinds == {True, False}

    @pytest.mark.parametrize("sizes", [(-1, 3), (4, 3), (2.0, 3), (True, 3), (3, "4"), (3, None)], ids=str)
    @pytest.mark.parametrize("family", [*FAMILIES, *DOMAINS, strategies.near_concurrent], ids=name_of)
    def test_bad_sizes(self, family: Callable[..., object], sizes: tuple[object, object]) -> None:
        with pytest.raises(OptionError, match=r"m(in|ax)_size="):
            family(min_size=sizes[0], max_size=sizes[1])

    @pytest.mark.parametrize("ulps", [-1, 101, 1.5, "2"])
    def test_bad_ulps(self, ulps: object) -> None:
        with pytest.raises(OptionError, match="ulps="):
            strategies.collinear_points(ulps=ulps)  # type: ignore[arg-type]  # a wrong type


def exact_sign(*points: Sequence[float]) -> int:
    value = oracles.orient(*oracles.rationals(points))
    return (value > 0) - (value < 0)


def float_sign(a: Sequence[float], b: Sequence[float], c: Sequence[float]) -> int:
    value = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return 0 if math.isnan(value) else (value > 0) - (value < 0)


def four_on_a_circle(points: FloatArray) -> bool:
    exact = sorted(set(oracles.rationals(points.tolist())))
    for a, b, c, d in combinations(exact, 4):
        if all(oracles.orient(*three) != 0 for three in combinations((a, b, c, d), 3)):
            centre, radius = oracles.circumcircle(a, b, c)
            if oracles.squared_distance(centre, d) == radius:
                return True
    return False


def three_on_a_line(points: FloatArray) -> bool:
    exact = sorted(set(oracles.rationals(points.tolist())))
    return any(oracles.orient(*three) == 0 for three in combinations(exact, 3))


def a_wrong_turn(points: FloatArray) -> bool:
    """The planted bug: orientations in doubles."""
    return any(float_sign(*three) != exact_sign(*three) for three in combinations(points.tolist(), 3))


def lost_in_the_lift(points: FloatArray) -> bool:
    """The planted bug: points are lifted to the paraboloid before anything is subtracted."""
    x, y = points.T
    return len(np.unique(np.stack([x * x + y * y, x, y]), axis=1).T) == len(points) and bool(
        (np.spacing(x * x + y * y) > 1e-3 * np.ptp(points)).any()
    )


def merged_by_a_tolerance(points: FloatArray) -> bool:
    """The planted bug: what is closer than 1e-9 of the bounding box is the same."""
    size = np.ptp(points, axis=0).max()
    return any(0 < math.dist(p, q) < 1e-9 * size for p, q in combinations(points.tolist(), 2))


def overflow(points: FloatArray) -> bool:
    """The planted bug: squares of coordinates."""
    with np.errstate(over="ignore"):
        return bool(np.isinf((points * points).sum(axis=1)).any())


def underflow(points: FloatArray) -> bool:
    """The planted bug: a triangle with an area that is none in doubles."""
    return any(float_sign(*three) == 0 != exact_sign(*three) for three in combinations(points.tolist(), 3))


def two_at_one_place(points: FloatArray) -> bool:
    return len(set(map(tuple, points.tolist()))) < len(points)


CATCHES: list[tuple[Family, Callable[[FloatArray], bool]]] = [
    (strategies.clustered_points, merged_by_a_tolerance),
    (strategies.grid_points, four_on_a_circle),
    (strategies.tilted_grid_points, a_wrong_turn),
    (strategies.cocircular_points, four_on_a_circle),
    (strategies.collinear_points, a_wrong_turn),
    (strategies.far_points, lost_in_the_lift),
    (strategies.mixed_scale_points, overflow),
    (strategies.mixed_scale_points, underflow),
    (strategies.mixed_scale_points, a_wrong_turn),
    (strategies.subnormal_points, underflow),
    (strategies.duplicate_points, two_at_one_place),
]


@pytest.mark.obligation(
    "S2", "each family catches the blunders that it is for within a hundred examples", method="property-based"
)
class TestCatches:
    """Each family catches the blunders that it is there for within a hundred examples, and so does the union of all;
    points spread evenly catch none of them, which is why the others are there."""

    @pytest.mark.parametrize(("family", "bug"), CATCHES, ids=name_of)
    def test_found(self, family: Family, bug: Callable[[FloatArray], bool]) -> None:
        assert any(map(bug, drawn(family(min_size=3, max_size=12), 100)))
        assert any(map(bug, drawn(strategies.points(min_size=3, max_size=12), 300)))

    @pytest.mark.parametrize("bug", dict.fromkeys(bug for _, bug in CATCHES), ids=name_of)
    def test_control_not_by_uniform_points(self, bug: Callable[[FloatArray], bool]) -> None:
        """Points spread evenly: they catch none of them."""

        def scattered(points: FloatArray) -> bool:
            return bool((points % 1).any()) and bug(points)  # no integers: those are for shrinking

        assert not any(map(scattered, drawn(strategies.uniform_points(min_size=3, max_size=12), 100)))


SQUARE = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]
DIAMOND = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]


@pytest.mark.obligation("S2", "what fails shrinks to the fewest points there are", method="property-based")
class TestShrinking:
    """What fails shrinks to the fewest points there are, with the simplest coordinates of their family."""

    @pytest.mark.parametrize("family", FAMILIES[:4] + FAMILIES[6:], ids=name_of)
    def test_four_on_a_circle(self, family: Family) -> None:
        found = find(family(max_size=12), four_on_a_circle, settings=search)
        offset = found.min(axis=0)
        places = sorted((found - offset).tolist())
        assert offset.tolist() in ([0, 0], [1e5, 1e5])
        step = places[-1][0]
        assert step in (1.0, 5e-324)
        corners = [[x, y] for x in (0.0, step) for y in (0.0, step)]
        assert places == sorted(corners + [[0.0, 0.0]] * (len(found) - 4))
        assert len(found) == 4 + (family is strategies.duplicate_points)

    def test_four_on_a_circle_about_the_origin(self) -> None:
        found = find(strategies.cocircular_points(max_size=12), four_on_a_circle, settings=search)
        assert found.tolist() == DIAMOND

    def test_three_on_a_line(self) -> None:
        found = find(strategies.collinear_points(max_size=12), three_on_a_line, settings=search)
        assert found.tolist() == [[1.0, 1.0], [2.0, 1.0], [3.0, 1.0]]
        found = find(strategies.points(max_size=12), three_on_a_line, settings=search)
        assert len(found) <= 5
        assert found.max() == 2

    def test_two_at_one_place(self) -> None:
        found = find(strategies.points(max_size=12), two_at_one_place, settings=search)
        assert found.tolist() == [[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]]

    def test_a_wrong_turn(self) -> None:
        found = find(strategies.points(max_size=12), a_wrong_turn, settings=search)
        assert len(found) <= 5

    def test_control_there_is_no_such_thing(self) -> None:
        """A fault that a family has not: nothing is found."""
        with pytest.raises(NoSuchExample):
            find(strategies.uniform_points(max_size=12), two_at_one_place, settings=quiet)

    @pytest.mark.parametrize("family", [*DOMAINS, strategies.near_concurrent], ids=name_of)
    def test_graphs(self, family: Graphs) -> None:
        graph = find(family(), anything, settings=search)
        assert len(graph.points) == LEAST.get(family.__name__, 3)
        assert np.abs(graph.points).max() <= 8
        assert not graph.duplicates.size


def crossings(graph: PSLG) -> list[tuple[int, int]]:
    """Which segments cross inside of each other: brute force in fractions."""
    exact = oracles.rationals(graph.points.tolist())
    lines = [(exact[a], exact[b]) for a, b in graph.segments.tolist()]
    return [
        (i, j) for (i, s), (j, t) in combinations(enumerate(lines), 2) if domain_oracle.cross_inside(s, t) is not None
    ]


def meetings(graph: PSLG) -> list[tuple[int, int]]:
    """Which segments without a common end meet."""
    exact = oracles.rationals(graph.points.tolist())
    ends = graph.segments.tolist()
    return [
        (i, j)
        for (i, (a, b)), (j, (c, d)) in combinations(enumerate(ends), 2)
        if not {a, b} & {c, d} and domain_oracle.meeting_points((exact[a], exact[b]), (exact[c], exact[d]))
    ]


@pytest.mark.obligation(
    "S1",
    "every family of graphs is planar, and bounds a domain, but for the one that is for crossings",
    method="property-based",
)
class TestGraphs:
    """Every family draws graphs of as many points as it was asked for: planar unless crossings are what it is for, and
    bounding a domain that can be triangulated."""

    @pytest.mark.parametrize("family", [*DOMAINS, strategies.near_concurrent], ids=name_of)
    def test_sizes(self, family: Graphs) -> None:
        least = LEAST.get(family.__name__, 3)
        for low, high in ((least, least), (0, least + 1), (12, 14), (30, 30)):
            sizes = {len(graph.points) for graph in drawn(family(min_size=low, max_size=high), 25)}
            assert max(least, low) == min(sizes)
            assert max(sizes) == high
        if least > 3:
            with pytest.raises(OptionError, match=f"{least} points are needed"):
                family(min_size=3, max_size=least - 1)

    @pytest.mark.parametrize("family", DOMAINS, ids=name_of)
    def test_planar_and_triangulable(self, family: Graphs) -> None:
        @quiet
        @given(family(max_size=14))
        def check(graph: PSLG) -> None:
            assert not crossings(graph)
            mesh = constrained_delaunay(graph)
            assert verify(mesh.points, mesh.triangles, domain=graph).ok

        check()

    @pytest.mark.parametrize("family", [strategies.polygons, strategies.spirals], ids=name_of)
    def test_simple(self, family: Graphs) -> None:
        """Edges of a polygon meet in the vertices that they share, and each vertex has two of them."""

        @quiet
        @given(family(max_size=20))
        def check(graph: PSLG) -> None:
            assert not meetings(graph)
            assert not graph.duplicates.size
            assert (np.bincount(graph.segments.ravel()) == 2).all()

        check()

    def test_control_bundles_cross(self) -> None:
        """The family whose segments cross."""

        @quiet
        @given(strategies.near_concurrent(min_size=6))
        def check(graph: PSLG) -> None:
            assert meetings(graph)

        check()
        some = strategies.pslgs(crossings=True)
        assert crossings(find(some, lambda graph: bool(crossings(graph)), settings=search))
        with pytest.raises(NoSuchExample):
            find(strategies.pslgs(max_size=8), lambda graph: bool(crossings(graph)), settings=quiet)

    @pytest.mark.parametrize(
        ("family", "feature"),
        [
            (strategies.polygons_with_holes, lambda graph: len(graph.holes) > 0),
            (strategies.slits, lambda graph: (np.bincount(graph.segments.ravel()) == 1).any()),
            (strategies.t_junctions, lambda graph: len(meetings(graph)) > 0),
        ],
    )
    def test_what_they_are_for(self, family: Graphs, feature: Callable[[PSLG], bool]) -> None:
        @quiet
        @given(family())
        def check(graph: PSLG) -> None:
            assert feature(graph)

        check()
        assert not all(feature(find(other(), anything, settings=search)) for other in DOMAINS)

    def test_borders(self) -> None:
        """Borders are shared by index, by copies, and by copies that leave some vertices out."""

        def kind(graph: PSLG) -> str:
            if not graph.duplicates.size:
                return "shared"
            return "left out" if meetings_but_duplicates(graph) else "copied"

        for expected in ("shared", "copied", "left out"):
            assert kind(find(strategies.shared_borders(), lambda g: kind(g) == expected, settings=search)) == expected  # noqa: B023


def meetings_but_duplicates(graph: PSLG) -> bool:
    """Whether some vertex lies inside a segment."""
    exact = oracles.rationals(graph.points.tolist())
    return any(
        oracles.on_segment(p, exact[a], exact[b]) and p not in (exact[a], exact[b])
        for p in exact
        for a, b in graph.segments.tolist()
    )


class TestOptional:
    """hypothesis is asked for where it is needed, and nowhere else."""

    def test_it_is_not_imported(self) -> None:
        code = "import sys, exactmesh, exactmesh.cli; assert 'hypothesis' not in sys.modules"
        subprocess.run([sys.executable, "-c", code], check=True, timeout=120)

    def test_without_it(self, monkeypatch: pytest.MonkeyPatch) -> None:
        for module in [name for name in sys.modules if name.startswith("exactmesh.strategies")]:
            monkeypatch.delitem(sys.modules, module)
        monkeypatch.setitem(sys.modules, "hypothesis", None)
        with pytest.raises(HypothesisUnavailableError, match=r"pip install 'exactmesh\[hypothesis\]'"):
            __import__("exactmesh.strategies")
        with pytest.raises(ImportError):
            __import__("exactmesh.strategies")
