"""A graph on a grid: the same drawing, with bits left for halving; or a refusal that is right."""

import math
from fractions import Fraction
from itertools import combinations, pairwise
from typing import TypeAlias

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exactmesh import PSLG, refine, verify
from exactmesh.crossings import arrange
from exactmesh.errors import CrossingError, OptionError, PSLGError, ShapeError, SnappingError

Place: TypeAlias = "tuple[Fraction, Fraction]"
Ring: TypeAlias = "list[Place]"


def exact(points: np.typing.NDArray[np.float64]) -> list[Place]:
    return [(Fraction(x), Fraction(y)) for x, y in points.tolist()]


def power_above(value: Fraction) -> Fraction:
    """Return the smallest power of two that is at least the number."""
    power = Fraction(1)
    while power < value:
        power *= 2
    while power / 2 >= value:
        power /= 2
    return power


def spacing_of(points: list[Place], bits: int) -> Fraction:
    extent = max(max(p[axis] for p in points) - min(p[axis] for p in points) for axis in range(2))
    spacing: Fraction = power_above(extent) / 2**bits
    return spacing


def turn(a: Place, b: Place, c: Place) -> int:
    cross = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return (cross > 0) - (cross < 0)


def on_segment(a: Place, b: Place, p: Place) -> bool:
    inside = all(min(a[i], b[i]) <= p[i] <= max(a[i], b[i]) for i in range(2))
    return turn(a, b, p) == 0 and inside


def meet(a: Place, b: Place, c: Place, d: Place) -> bool:
    """Tell whether two segments have a common point, by definition of their sides."""
    if any(on_segment(*s, p) for s, p in (((a, b), c), ((a, b), d), ((c, d), a), ((c, d), b))):
        return True
    return turn(a, b, c) * turn(a, b, d) < 0 and turn(c, d, a) * turn(c, d, b) < 0


def side(ring: Ring, p: Place) -> int:
    """Return the winding number of a ring about a point, or 9 for a point on it."""
    winding = 0
    for a, b in pairwise([*ring, ring[0]]):
        if on_segment(a, b, p):
            return 9
        if (a[1] <= p[1]) != (b[1] <= p[1]) and turn(a, b, p) == (1 if b[1] > a[1] else -1):
            winding += 1 if b[1] > a[1] else -1
    return winding


def drawing(points: list[Place], seeds: list[Place], rings: list[list[int]]) -> object:
    """Return all that makes up a drawing of rings: which points coincide, which segments meet, on which side of each
    ring each point and each seed is, and how each ring is oriented."""
    segments = [edge for ring in rings for edge in pairwise([*ring, ring[0]])]
    same = [points[i] == points[j] for i, j in combinations(range(len(points)), 2)]
    met = [
        meet(points[a], points[b], points[c], points[d])
        for (a, b), (c, d) in combinations(segments, 2)
        if not {a, b} & {c, d}
    ]
    around = [side([points[i] for i in ring], p) for ring in rings for p in [*points, *seeds]]
    area = [
        sum(points[a][0] * points[b][1] - points[b][0] * points[a][1] for a, b in pairwise([*ring, ring[0]])) > 0
        for ring in rings
    ]
    return same, met, around, area


def meets_cell(end: tuple[Place, Place], centre: Place, spacing: Fraction) -> bool:
    """Tell whether a segment meets the closed cell around a grid point: clip it."""
    a, b = end
    low, high = Fraction(0), Fraction(1)
    for axis in range(2):
        d, first = b[axis] - a[axis], centre[axis] - spacing / 2 - a[axis]
        if d == 0:
            if not first <= 0 <= first + spacing:
                return False
            continue
        enter, leave = sorted((first / d, (first + spacing) / d))
        low, high = max(low, enter), min(high, leave)
    return low <= high


def around(corner: tuple[float, float]) -> float:
    return math.atan2(corner[1] - 0.5, corner[0] - 0.5)


@st.composite
def ring_graphs(draw: st.DrawFn) -> tuple[PSLG, list[list[int]]]:
    """Up to three rings of three to five corners, beside each other or nested, and seeds; some of them cross."""
    scale = draw(st.sampled_from([1.0, 1.0, 1.0 / 3.0, 1e-300]))
    shift = draw(st.sampled_from([0.0, 0.0, 100.0]))
    number = st.one_of(st.integers(0, 64).map(lambda k: k / 64), st.floats(0.0, 1.0))
    corner = st.tuples(number, number)
    points: list[tuple[float, float]] = []
    rings = []
    for i in range(draw(st.integers(1, 3))):
        size = draw(st.sampled_from([1.0, 0.3, 0.05, 0.01]))
        x, y = draw(st.one_of(st.just((1.2 * i, 0.0)), st.just((0.5 - size / 2, 0.5 - size / 2)), corner))
        corners = sorted(draw(st.lists(corner, min_size=3, max_size=5, unique=True)), key=around)
        rings.append(list(range(len(points), len(points) + len(corners))))
        points += [((x + size * p) * scale + shift, (y + size * q) * scale + shift) for p, q in corners]
    segments = [edge for ring in rings for edge in pairwise([*ring, ring[0]])]
    places, markers = np.array(points), np.arange(len(points))
    segments = [(a, b) for a, b in segments if (places[a] != places[b]).any()]
    seeds = np.reshape(draw(st.lists(corner, max_size=2)), (-1, 2))
    holes = places.min(axis=0) + seeds * np.ptp(places, axis=0)
    try:
        return PSLG(places, segments, holes=holes, point_markers=markers), rings
    except PSLGError:  # a seed on a segment, or outside
        return PSLG(places, segments, point_markers=markers), rings


def is_refusal_right(pslg: PSLG, bits: int, error: SnappingError) -> bool:
    """Tell whether what the error names is too near."""
    points, seeds = exact(pslg.points), exact(pslg.holes)
    g = spacing_of(points, bits)

    def centre(p: Place) -> Place:
        x, y = ((v / g + Fraction(1, 2)).__floor__() * g for v in p)
        return x, y

    ends = [(points[a], points[b]) for a, b in pslg.segments.tolist()]
    merged = all(points[i] != points[j] and centre(points[i]) == centre(points[j]) for i, j in error.merged.tolist())
    passed = all(meets_cell(ends[s], centre(points[v]), g) for s, v in error.run_over.tolist())
    seeded = all(any(meets_cell(end, centre(seeds[h]), g) for end in ends) for h in error.holes.tolist())
    return merged and passed and seeded


def answer(pslg: PSLG, bits: int) -> PSLG | SnappingError | CrossingError:
    """Return the graph on the grid, or the refusal."""
    try:
        return pslg.snapped(bits)
    except (SnappingError, CrossingError) as error:
        return error


@pytest.mark.obligation(
    "R1",
    "a graph that is snapped to a grid is the same drawing, and its segments can be halved",
    method="property-based",
)
class TestSnapped:
    """Law: every point goes to the nearest of the grid; the drawing is the same one, by brute force; segments can be
    halved as often as is said. Or it is refused, and what is named is too near."""

    @given(ring_graphs(), st.integers(1, 12))
    def test_any_rings(self, graph: tuple[PSLG, list[list[int]]], bits: int) -> None:
        pslg, rings = graph
        result = answer(pslg, bits)
        if isinstance(result, SnappingError):
            assert result.indices
            assert is_refusal_right(pslg, bits, result)
            return
        if isinstance(result, CrossingError):
            points = exact(pslg.points)
            ends = [(points[a], points[b]) for a, b in pslg.segments.tolist()]
            assert all(meet(*ends[i], *ends[j]) for i, j in result.pairs.tolist())
            return
        before, after = exact(pslg.points), exact(result.points)
        if len(set(before)) == 1:  # no extent, no grid
            assert result == pslg
            return
        g = spacing_of(before, bits)
        assert all((v / g).denominator == 1 for p in after for v in p)
        moves = [(p[0] - q[0], p[1] - q[1]) for p, q in zip(before, after, strict=True)]
        assert all(abs(v) <= g / 2 for move in moves for v in move)
        assert Fraction(str(result.displacement_squared(pslg))) == max(x * x + y * y for x, y in moves)
        assert drawing(before, exact(pslg.holes), rings) == drawing(after, exact(result.holes), rings)
        assert np.array_equal(result.segments, pslg.segments)
        assert np.array_equal(result.representative, pslg.representative)
        assert result.point_markers is not None
        assert result.point_markers.tolist() == list(range(len(before)))

    @pytest.mark.parametrize(("bits", "shift"), [(10, 0.0), (20, 0.0), (20, 1000.0), (44, 0.0), (30, 2.0**19)])
    def test_halvings(self, bits: int, shift: float) -> None:
        corners = [(0.1, 0.2), (0.9, 0.3), (0.7, 0.8)]
        pslg = PSLG(np.array(corners) + shift, [(0, 1), (1, 2), (2, 0)]).snapped(bits)
        points = exact(pslg.points)
        reach = power_above(max(abs(v) for p in points for v in p)) / power_above(Fraction(7, 10))
        halvings = 53 - bits - (reach.numerator.bit_length() - 1)
        assert halvings > 0
        for a, b in pairwise([*points, points[0]]):
            for k in (1, 2 ** (halvings - 1) - 1, 2 ** (halvings - 1) + 1, 2**halvings - 1):
                place = [p + Fraction(k, 2**halvings) * (q - p) for p, q in zip(a, b, strict=True)]
                assert all(Fraction(float(v)) == v for v in place)

    def test_points_on_segments_stay_there(self) -> None:
        frame = [(0.0, 0.1), (8.0, 0.1), (4.0, 0.1), (4.0, 7.3), (2.0, 3.0)]
        pslg = PSLG(frame, [(0, 1), (2, 3)])
        result = pslg.snapped(10)
        assert len(set(result.points[:3, 1].tolist())) == 1

    def test_a_large_graph(self) -> None:
        rng = np.random.default_rng(1)
        n = 2000
        radius, angle = 0.5 + 0.5 * rng.random(n), np.sort(rng.random(n)) * 2.0 * np.pi
        ring = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
        star = PSLG.from_rings([ring])
        assert float(star.snapped(44).displacement_squared(star)) < 2.0 ** -(2 * 43 + 1)
        with pytest.raises(SnappingError, match=r"and \d+ more") as caught:
            star.snapped(8)
        assert is_refusal_right(star, 8, caught.value)

    def test_crossings_are_arranged_first(self) -> None:
        cross = PSLG([(0, 0), (3, 1), (0, 1), (3, 0.25)], [(0, 1), (2, 3)])
        with pytest.raises(CrossingError, match="arrange"):
            cross.snapped(20)
        assert len(arrange(cross).pslg.snapped(20).segments) == 4

    def test_control_another_drawing(self) -> None:
        """A point that has crossed a segment, two points that have become one: the drawing is another."""
        ring = [[0, 1, 2]]
        corners = [(0, 0), (4, 0), (0, 4)]
        before = drawing(exact(np.array([*corners, (1.0, 1.0)])), [], ring)
        assert drawing(exact(np.array([*corners, (1.0, 0.5)])), [], ring) == before
        assert drawing(exact(np.array([*corners, (3.0, 3.0)])), [], ring) != before
        assert drawing(exact(np.array([*corners, (4.0, 0.0)])), [], ring) != before


@pytest.mark.obligation(
    "R1", "a domain that is snapped to a coarse grid is covered exactly when it is refined", method="named cases"
)
class TestCovered:
    """Law: of a domain on a coarse grid, acute corners included, no Steiner point is off its segment."""

    @pytest.mark.parametrize("bits", [10, 20])
    @pytest.mark.parametrize(
        "corners", [[(0, 0), (0.7, 0.1), (0.3, 0.9)], [(0, 0), (0.7, 0.1), (0.8, 0.9), (0.1, 0.7)]]
    )
    def test_acute_corners(self, corners: list[tuple[float, float]], bits: int) -> None:
        domain = PSLG.from_rings([corners]).snapped(bits)
        done = refine(domain, max_area=0.001)
        assert done.displacement_squared == 0
        assert verify(done.triangulation.points, done.triangulation.triangles, domain=domain).ok

    def test_control_full_precision(self) -> None:
        """The same domain, not snapped: it is not covered exactly."""
        domain = PSLG.from_rings([[(0, 0), (0.7, 0.1), (0.3, 0.9)]])
        assert refine(domain, max_area=0.001).displacement_squared > 0


class TestBadInput:
    """Law: bits that are none, or too many, are refused, with the number that is possible."""

    triangle = PSLG([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2), (2, 0)])

    @pytest.mark.parametrize("bits", [0, -1, 53, 2.5, "8", None])
    def test_bits(self, bits: int) -> None:
        with pytest.raises(OptionError, match="1 to 52"):
            self.triangle.snapped(bits)

    def test_far_from_the_origin(self) -> None:
        far = PSLG(self.triangle.points + 2.0**40, self.triangle.segments)
        assert far.snapped(12) == far
        with pytest.raises(OptionError, match=r"there are 12 at coordinates up to 2\^41"):
            far.snapped(13)

    def test_nothing_to_round(self) -> None:
        assert len(PSLG(np.empty((0, 2))).snapped(4).points) == 0
        assert PSLG([(0.1, 0.2), (0.1, 0.2)]).snapped(4).points.tolist() == [[0.1, 0.2]] * 2

    def test_seeds_beside_a_segment(self) -> None:
        points, segments = self.triangle.points, self.triangle.segments
        pslg = PSLG(points, segments, holes=[(0.3, 0.3)], regions=[(0.2, 0.01, 5.0, 0.5)])
        with pytest.raises(SnappingError, match="region 0") as caught:
            pslg.snapped(4)
        assert caught.value.regions.tolist() == [0]
        assert pslg.snapped(12).regions[0, 2:].tolist() == [5.0, 0.5]

    def test_displacement_of_another_graph(self) -> None:
        with pytest.raises(ShapeError, match="3 points here and 2 there"):
            self.triangle.displacement_squared(PSLG([(0, 0), (1, 0)]))


class TestControls:
    """Control: rounding without looking changes drawings, and the same law finds it."""

    def test_control_an_island_jumps_ashore(self) -> None:
        lake = [(0.0, 0.0), (16.0, 0.4), (16.0, 16.0), (0.0, 16.0)]
        island = [(14.0, 0.42), (14.8, 0.45), (14.4, 0.48)]
        pslg, rings = PSLG.from_rings([lake, island]), [[0, 1, 2, 3], [4, 5, 6]]
        rounded = np.floor(pslg.points + 0.5)
        assert drawing(exact(pslg.points), [], rings) != drawing(exact(rounded), [], rings)
        with pytest.raises(SnappingError):
            pslg.snapped(4)

    def test_control_a_wrong_refusal(self) -> None:
        nothing = np.empty(0, dtype=np.int64)
        pslg = PSLG([(0, 0), (8, 0), (0, 8)], [(0, 1), (1, 2), (2, 0)])
        error = SnappingError(
            1.0, merged=np.array([(0, 1)]), run_over=nothing.reshape(0, 2), holes=nothing, regions=nothing
        )
        assert not is_refusal_right(pslg, 3, error)
