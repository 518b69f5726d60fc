"""ARR2: the crossing of two segments in doubles, step by step: sound and tight errors, exact where it can be."""

import itertools
import math
import random
from collections.abc import Callable, Sequence
from fractions import Fraction

import numpy as np
import pytest
from proofs_tests.kernel.interpreted import Workspace, interpreted, watched_expansions
from proofs_tests.oracles import rationals
from proofs_tests.rounding.magnitudes import cross, difference

from exactkernel import crossing
from exactkernel.constants import DD_BOUND, MAX_COORDINATE_DEGREE_4, MIN_COORDINATE_DEGREE_4
from exactkernel.context import SCRATCH_SIZE, Context, guarded_context, make_context
from exactkernel.crossing import crossing_in_pairs, is_nearest_certain
from exactkernel.expansions import determinant_2x2, two_diff
from exactkernel.types import FloatArray

U = Fraction(1, 2**53)
MIN, MAX = MIN_COORDINATE_DEGREE_4, MAX_COORDINATE_DEGREE_4
Points = list[tuple[float, float]]


def flat(points: Points) -> list[float]:
    return [x for point in points for x in point]


def open_context() -> Context:
    return make_context(np.ones(1))


def answering(answers: Sequence[bool], asked: list[float]) -> Callable[..., bool]:
    """Give these answers in turn; the first argument of each question is written down."""

    def answer(x: float, *_: object) -> bool:
        asked.append(x)
        return answers[len(asked) - 1]

    return answer


def exact_crossing(points: Points) -> tuple[Fraction, Fraction]:
    """Where the lines meet."""
    a, b, c, d = rationals(points)
    u, v = (b[0] - a[0], b[1] - a[1]), (d[0] - c[0], d[1] - c[1])
    t = ((c[0] - a[0]) * v[1] - (c[1] - a[1]) * v[0]) / (u[0] * v[1] - u[1] * v[0])
    return a[0] + t * u[0], a[1] + t * u[1]


def generic(draw: random.Random) -> Points:
    """Coordinates of several sizes, so that differences have tails."""
    return [(draw.uniform(-1, 1) * 2.0 ** draw.randint(-9, 9), draw.uniform(-1, 1)) for _ in range(4)]


def through_the_origin(draw: random.Random) -> Points:
    """They cross in the origin, or 2^-60 to 2^-150 beside it."""
    (x, y), (z, w) = ((draw.uniform(1, 2), draw.uniform(1, 2)) for _ in range(2))
    off = draw.choice((0.0, 1.0)) * 2.0 ** -draw.randint(60, 150)
    other = draw.choice([[(z, -w), (-z / 2, w / 2)], [(off, w), (0.0, -w)], [(z, off), (-w, 0.0)]])
    return [(x, y), (-2 * x, -2 * y), *other]


def axes(draw: random.Random) -> Points:
    x, y = draw.uniform(1, 2), draw.uniform(1, 2)
    points = [(x, -1.0), (x, 2.0), (-1.0, y), (3.0, draw.choice((y, y + 0.1)))]
    return draw.choice([points, points[2:] + points[:2]])


@interpreted
@pytest.mark.obligation(
    "ARR2", "whether a double is the exact crossing is decided by expansions", method="property-based"
)
class TestExact:
    """Of doubles near a crossing, exactly the one that is it is told to be."""

    @staticmethod
    def is_exact(points: Points, axis: int, x: float, scratch: FloatArray) -> bool:
        a, b, c, d = points
        u, v, w = ([two_diff(p[i], q[i]) for i in range(2)] for p, q in ((b, a), (d, c), (c, a)))
        det, num, rest = scratch[0:16], scratch[16:32], scratch[32:]
        n_det = determinant_2x2(*u[0], *v[1], *u[1], *v[0], det, rest)
        n_num = determinant_2x2(*w[0], *v[1], *w[1], *v[0], num, rest)
        return bool(crossing._is_exact(x, a[axis], *u[axis], det, n_det, num, n_num, rest))

    def test_near_crossings(self) -> None:
        draw, scratch, met = random.Random(4), np.full(SCRATCH_SIZE, np.nan), set()
        for made, axis, _ in itertools.product((generic, through_the_origin, axes), (0, 1), range(40)):
            points = made(draw)
            exact = exact_crossing(points)[axis]
            for x in (float(exact), math.nextafter(float(exact), 9.0), 0.0, points[0][axis]):
                wanted = Fraction(x) == exact and (x == 0.0 or MIN <= abs(x) <= MAX)
                assert self.is_exact(points, axis, x, scratch) == wanted
                met.add((axis, wanted))
        assert len(met) == 4

    def test_outside_of_the_window(self) -> None:
        """Expansions are not asked there, and could not answer."""
        scratch = np.zeros(SCRATCH_SIZE)
        for x, inside in (
            (MIN, True),
            (math.nextafter(MIN, 0.0), False),
            (MAX, True),
            (math.nextafter(MAX, math.inf), False),
        ):
            points = [(x, 1.0), (x, -1.0), (0.0, 0.0), (1.0, 0.0)]
            assert exact_crossing(points) == (Fraction(x), Fraction(0))
            assert self.is_exact(points, 0, x, scratch) is inside

    def test_room(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """The workspaces hold the longest expansions, and do not overlap."""
        watched_expansions(monkeypatch, crossing)
        k = open_context()._replace(scratch=Workspace.of(SCRATCH_SIZE))
        points = [(-1.0, -1.0), (1.0, 1.0), (-0.1, 0.1), (0.3, -0.3)]
        assert crossing_in_pairs(k, *flat(points)) == (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)

    def test_control_a_neighbour_is_refused(self) -> None:
        """The double beside the nearest."""
        points = [(-1.0, -1.0), (1.0, 1.0), (0.0, 0.5), (1.0, 0.0)]
        assert exact_crossing(points)[0] == Fraction(1, 3)
        assert not self.is_exact(points, 0, 1 / 3, np.zeros(SCRATCH_SIZE))


@interpreted
@pytest.mark.obligation(
    "ARR2",
    "a crossing in pairs is within its error, exact where it is a double, open where unknown",
    method="property-based",
)
class TestPairs:
    """The exact crossing is within the errors, which are zero where it is a double that the window holds."""

    def test_within_the_error(self) -> None:
        draw, met = random.Random(5), set()
        for made, _ in itertools.product((generic, through_the_origin, axes), range(80)):
            points = made(draw)
            found = crossing_in_pairs(open_context(), *flat(points))
            u, v, w = (difference(points[i], points[j]) for i, j in ((1, 0), (3, 2), (2, 0)))
            num, det = cross(w, v), cross(u, v)
            for (x, tail, error), exact, (side, _) in zip(
                (found[:3], found[3:]), exact_crossing(points), zip(u, v, strict=True), strict=True
            ):
                assert abs(Fraction(x) + Fraction(tail) - exact) <= Fraction(error)
                step, size = abs(num.value / det.value * side.value), abs(det.value)
                first_order = num.permanent * side.permanent / size + step * (det.permanent / size + 1) + abs(exact)
                assert Fraction(error) <= Fraction(5, 2) * Fraction(DD_BOUND) * first_order
                is_double = Fraction(float(exact)) == exact
                if exact == 0 or (is_double and made is axes):
                    assert (Fraction(x), tail, error) == (exact, 0.0, 0.0)
                met.add((made.__name__, is_double, error == 0.0))
        assert len(met) >= 5

    def test_small_integers(self) -> None:
        """Crossings that are doubles err by nothing once one of the two coordinates needs a look."""
        draw, met = random.Random(6), set()
        for _ in range(400):
            points = [(float(draw.randint(-4, 4)), float(draw.randint(-4, 4))) for _ in range(4)]
            if cross(difference(points[1], points[0]), difference(points[3], points[2])).value == 0:
                continue
            found = crossing_in_pairs(open_context(), *flat(points))
            both = list(zip((found[:3], found[3:]), exact_crossing(points), strict=True))
            doubles = [Fraction(float(exact)) == exact for _, exact in both]
            for (x, tail, error), exact in both:
                assert abs(Fraction(x) + Fraction(tail) - exact) <= Fraction(error)
            certain = all(is_nearest_certain(*result) for result, _ in both)
            assert certain or not all(doubles)
            met.add((tuple(doubles), certain))
        assert len(met) >= 4

    def test_uncertain_coordinates_are_tried_exactly(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """If either is uncertain: zero first, then whether the double is the crossing itself, on each axis."""
        points = [(0.0, 0.25), (3.0, 0.5), (1.0, 1.0), (2.0, -1.0)]
        for certain in itertools.product((False, True), repeat=2):
            for exact in itertools.product((False, True), repeat=2):
                tried: list[float] = []
                monkeypatch.setattr(crossing, "is_nearest_certain", answering(certain, []))
                monkeypatch.setattr(crossing, "_is_exact", answering(exact, tried))
                found = crossing_in_pairs(open_context(), *flat(points))
                assert len(tried) == (0 if all(certain) else 2)
                for (_, tail, error), told in zip((found[:3], found[3:]), exact, strict=True):
                    assert (error == 0.0) == (bool(tried) and told)
                    assert error > 0.0 or tail == 0.0

    def test_nearly_parallel_lines(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Up to a relative error of the determinant of 2^-10, that included; everything is exact here."""
        draw, met = random.Random(1), set()
        for exponent in (-10, -11, -12, -13):
            monkeypatch.setattr(crossing, "DD_BOUND", 2.0**exponent)
            for _ in range(120):
                points = [(float(draw.randint(-4, 4)), float(draw.randint(-4, 4))) for _ in range(4)]
                det = cross(difference(points[1], points[0]), difference(points[3], points[2]))
                if det.value == 0 and det.permanent == 0:
                    continue
                found = crossing_in_pairs(open_context(), *flat(points))
                relative = Fraction(2) ** exponent * det.permanent * 2**10 - abs(det.value)
                unknown = (points[0][0], 0.0, math.inf, points[0][1], 0.0, math.inf)
                if relative > 0:
                    assert found == unknown
                elif cross(difference(points[2], points[0]), difference(points[3], points[2])).value != 0:
                    assert max(found[2], found[5]) < math.inf
                met.add((relative > 0) - (relative < 0))
        assert met == {-1, 0, 1}

    def test_window(self) -> None:
        """One coordinate one step outside is enough; a context that is open trusts them."""
        inside = [0.0, MIN, MAX, 1.0, -1.0, 0.5, 0.25, 2.0]
        assert crossing_in_pairs(guarded_context(), *inside)[2] < math.inf
        for place, x in itertools.product(range(8), (math.nextafter(MIN, 0.0), math.nextafter(MAX, math.inf))):
            outside = [*inside[:place], x, *inside[place + 1 :]]
            unknown = (outside[0], 0.0, math.inf, outside[1], 0.0, math.inf)
            assert crossing_in_pairs(guarded_context(), *outside) == unknown
            assert crossing_in_pairs(open_context(), *outside) != unknown

    def test_control_the_heads_alone_are_outside(self) -> None:
        """A coordinate rounded to one double, its tail forgotten."""
        points = generic(random.Random(5))
        x, _, error, *_ = crossing_in_pairs(open_context(), *flat(points))
        assert abs(Fraction(x) - exact_crossing(points)[0]) > Fraction(error)
