"""K7: the circumcentre in doubles, step by step: sound and tight errors, exact decisions, nearest results."""

import itertools
import math
import random
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from proofs_tests.graphs.crossing_oracle import is_nearest
from proofs_tests.kernel.interpreted import Workspace, interpreted, watched_expansions
from proofs_tests.oracles import circumcircle, rationals
from proofs_tests.rounding.magnitudes import cross, difference, inner

from exactkernel import centre, crossing
from exactkernel.centre import circumcentre_in_pairs, nearest_circumcentre, quotient_offset
from exactkernel.constants import DD_BOUND, MAX_COORDINATE_DEGREE_4, MIN_COORDINATE_DEGREE_4
from exactkernel.context import SCRATCH_SIZE, Context, guarded_context, make_context

U = Fraction(1, 2**53)
MIN, MAX = MIN_COORDINATE_DEGREE_4, MAX_COORDINATE_DEGREE_4
_beyond: Callable[..., tuple[int, float]] = centre._beyond
Triangle = list[tuple[float, float]]


def flat(points: Triangle) -> list[float]:
    return [x for point in points for x in point]


def exact_centre(points: Triangle) -> tuple[Fraction, Fraction]:
    return circumcircle(*rationals(points))[0]


def open_context() -> Context:
    return make_context(np.ones(1))


def generic(draw: random.Random) -> Triangle:
    """Coordinates of several sizes, so that differences have tails."""
    return [(draw.uniform(-1, 1) * 2.0 ** draw.randint(-9, 9), draw.uniform(-1, 1)) for _ in range(3)]


def half_way(draw: random.Random) -> Triangle:
    """The centre, that of a right angle's opposite side, is half-way between doubles, or off by 2^-60 to 2^-150."""
    x, y = draw.uniform(1, 2), draw.uniform(-2, -1)
    other = (math.nextafter(x, 3.0), math.nextafter(y, 3.0))
    corner = (x, other[1])
    off = draw.choice((0.0, 1.0)) * draw.choice((-1, 1)) * 2.0 ** -draw.randint(60, 150)
    shift = draw.choice([(0.0, 0.0), (-x, 0.0), (0.0, -y), (-other[0], -other[1])])
    points = [(p[0] + shift[0], p[1] + shift[1]) for p in ((x, y), other, corner)]
    points[2] = (points[2][0] + off, points[2][1] + off)
    return draw.choice([points, [points[1], points[0], points[2]], [points[2], points[0], points[1]]])


def symmetric(draw: random.Random) -> Triangle:
    """A centre with a coordinate that is zero, or nearly so."""
    x, y = draw.uniform(1, 2), draw.uniform(1, 2)
    off = draw.choice((0.0, 1.0)) * 2.0 ** -draw.randint(60, 150)
    points = [(x, off), (-x, -off), (off, y)]
    return draw.choice([points, [(q, p) for p, q in points]])


@interpreted
@pytest.mark.obligation("K1", "the error of a quotient in pairs is sound, and tight", method="property-based")
class TestQuotient:
    """Whatever numerator and denominator are within their errors, the result is within its own, which is no more than
    a quarter above the first order."""

    def test_all_corners_of_the_errors(self) -> None:
        draw = random.Random(1)
        for relative, _ in itertools.product((0.0, 2.0**-100, 2.0**-40, 2.0**-10), range(60)):
            a, n, det = (draw.uniform(-2, 2) * 2.0 ** draw.randint(-20, 20) for _ in range(3))
            n_tail, det_tail = (x * draw.uniform(-1, 1) * 2.0**-54 for x in (n, det))
            n_error, det_error = (abs(x) * relative for x in (n, det))
            x, tail, error = quotient_offset(a, n, n_tail, n_error, det, det_tail, det_error)
            for s, t in itertools.product((-1, 0, 1), repeat=2):
                top = Fraction(n) + Fraction(n_tail) + s * Fraction(n_error)
                bottom = Fraction(det) + Fraction(det_tail) + t * Fraction(det_error)
                assert abs(Fraction(a) + top / bottom - Fraction(x) - Fraction(tail)) <= Fraction(error)
            quotient = abs(Fraction(n) / Fraction(det))
            first_order = 2 * Fraction(relative) * quotient + Fraction(DD_BOUND) * (quotient + abs(Fraction(x)))
            assert Fraction(error) <= Fraction(5, 4) * first_order

    def test_control_a_lost_tail_is_noticed(self) -> None:
        """A result without its tail, or with the tail's sign changed."""
        x, tail, error = quotient_offset(1.0, 1.0, 0.0, 0.0, 3.0, 0.0, 0.0)
        assert abs(Fraction(4, 3) - Fraction(x) - Fraction(tail)) <= Fraction(error)
        assert abs(Fraction(4, 3) - Fraction(x) + Fraction(tail)) > Fraction(error)


@interpreted
@pytest.mark.obligation(
    "K1", "the circumcentre in pairs is within its error, which is known inside the window", method="property-based"
)
class TestPairs:
    """The exact centre is within the errors; they are infinite outside of the window and where it is too flat."""

    def test_within_the_error(self) -> None:
        draw = random.Random(2)
        for made in (generic, half_way, symmetric):
            for _ in range(80):
                points = made(draw)
                x, x_tail, x_error, y, y_tail, y_error = circumcentre_in_pairs(open_context(), *flat(points))
                for value, tail, error, exact in zip(
                    (x, y), (x_tail, y_tail), (x_error, y_error), exact_centre(points), strict=True
                ):
                    assert abs(Fraction(value) + Fraction(tail) - exact) <= Fraction(error)

    def test_errors_told_are_sound_and_tight(self, monkeypatch: pytest.MonkeyPatch) -> None:
        told: list[tuple[float, ...]] = []

        def recorded(*arguments: float) -> tuple[float, float, float]:
            told.append(arguments)
            return quotient_offset(*arguments)

        monkeypatch.setattr(centre, "quotient_offset", recorded)
        draw = random.Random(3)
        for _ in range(150):
            points = draw.choice((generic, half_way, symmetric))(draw)
            told.clear()
            circumcentre_in_pairs(open_context(), *flat(points))
            u, v = difference(points[1], points[0]), difference(points[2], points[0])
            uu, vv, det = inner(u, u), inner(v, v), cross(u, v)
            for (a, n, n_tail, n_error, d, d_tail, d_error), top, p in zip(
                told, (v[1] * uu - u[1] * vv, u[0] * vv - v[0] * uu), points[0], strict=True
            ):
                assert a == p
                for head, tail, error, exact in ((n, n_tail, n_error, top), (d, d_tail, d_error, det + det)):
                    assert abs(Fraction(head) + Fraction(tail) - exact.value) <= Fraction(error)
                    assert abs(Fraction(error) - Fraction(DD_BOUND) * exact.permanent) <= Fraction(error) / 2**40

    def test_flat_triangles(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Up to a relative error of the area of 2^-10, that included; everything is exact here."""
        draw, met = random.Random(1), set()
        for exponent in (-10, -11, -12, -13):
            monkeypatch.setattr(crossing, "DD_BOUND", 2.0**exponent)
            for _ in range(120):
                points = [(float(draw.randint(-4, 4)), float(draw.randint(-4, 4))) for _ in range(3)]
                det = cross(difference(points[1], points[0]), difference(points[2], points[0]))
                x, x_tail, x_error, y, y_tail, y_error = circumcentre_in_pairs(open_context(), *flat(points))
                known = det.value != 0 and Fraction(2) ** exponent * det.permanent <= abs(det.value) / 2**10
                assert (x_error < math.inf) == (y_error < math.inf) == known
                if not known:
                    assert (x, x_tail, y, y_tail) == (points[0][0], 0.0, points[0][1], 0.0)
                met.add((known, Fraction(2) ** exponent * det.permanent == abs(det.value) / 2**10 > 0))
        assert met == {(True, True), (True, False), (False, False)}
        assert circumcentre_in_pairs(open_context(), 0.0, 0.0, 1.0, 0.0, 2.0, 0.0)[2] == math.inf

    def test_window(self) -> None:
        """One coordinate one step outside is enough; a context that is open trusts them."""
        inside = [0.0, MIN, MAX, 1.0, -1.0, 0.5]
        assert circumcentre_in_pairs(guarded_context(), *inside)[2] < math.inf
        for place, x in itertools.product(range(6), (math.nextafter(MIN, 0.0), math.nextafter(MAX, math.inf))):
            outside = [*inside[:place], x, *inside[place + 1 :]]
            unknown = (outside[0], 0.0, math.inf, outside[1], 0.0, math.inf)
            assert circumcentre_in_pairs(guarded_context(), *outside) == unknown
            assert circumcentre_in_pairs(open_context(), *outside)[2] < math.inf

    def test_control_the_heads_alone_are_outside(self) -> None:
        """A coordinate rounded to one double, its tail forgotten."""
        points = generic(random.Random(2))
        x, _, error, *_ = circumcentre_in_pairs(open_context(), *flat(points))
        assert abs(Fraction(x) - exact_centre(points)[0]) > Fraction(error)


@interpreted
@pytest.mark.obligation(
    "K7", "a coordinate of a circumcentre is compared exactly with a sum of two doubles", method="property-based"
)
class TestBeyond:
    """The sign is exact, the difference errs by 16u at most, on both axes, for both orientations."""

    def test_exact(self) -> None:
        draw, scratch, met = random.Random(4), np.empty(SCRATCH_SIZE), set()
        for made, axis, _ in itertools.product((generic, half_way, symmetric), (0, 1), range(25)):
            points = made(draw)
            for turned in (points, points[::-1]):
                exact = exact_centre(turned)[axis]
                middle = float(exact)
                for tail in (0.0, float(exact - Fraction(middle)), -float(exact), 0.3):
                    scratch.fill(draw.choice((math.nan, 1e300)))
                    side, found = _beyond(axis, middle, tail, *flat(turned), scratch)
                    wanted = exact - Fraction(middle) - Fraction(tail)
                    assert side == (wanted > 0) - (wanted < 0)
                    assert abs(Fraction(found) - wanted) <= 16 * U * abs(wanted)
                    met.add((axis, side))
        assert met == set(itertools.product((0, 1), (-1, 0, 1)))

    def test_room(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """The workspaces hold the longest expansions, and do not overlap."""
        watched_expansions(monkeypatch, centre)
        scratch = Workspace.of(SCRATCH_SIZE)
        for axis in (0, 1):
            assert _beyond(axis, 0.5, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, scratch) == (0, 0.0)

    def test_control_the_other_axis_differs(self) -> None:
        """The x coordinate taken for y."""
        points = generic(random.Random(4))
        exact = exact_centre(points)
        _, found = _beyond(0, 0.0, 0.0, *flat(points), np.empty(SCRATCH_SIZE))
        assert abs(Fraction(found) - exact[0]) <= 16 * U * abs(exact[0])
        assert abs(Fraction(found) - exact[1]) > 16 * U * abs(exact[1])


@interpreted
@pytest.mark.obligation(
    "K7", "a circumcentre that is called certain is the nearest double, ties to even", method="property-based"
)
class TestNearest:
    """From any start near it, the nearest double is found; there is no negative zero; whole centres likewise."""

    def test_decided(self) -> None:
        draw, k = random.Random(5), open_context()
        for made, axis, _ in itertools.product((generic, half_way, symmetric), (0, 1), range(40)):
            points = made(draw)
            exact = exact_centre(points)[axis]
            nearest = float(exact)
            for start in (nearest, math.nextafter(nearest, 9.0), nearest * (1 + draw.uniform(-1, 1) * 2.0**-20), -0.0):
                if start == 0.0 and exact != 0:
                    continue  # too far
                tail = draw.choice((0.0, math.ulp(start) / 2, float(exact - Fraction(start)) * draw.choice((1, 0.9))))
                if 0.0 < abs(start) < MIN:
                    continue
                found, is_certain = centre._decided(k, axis, start, tail, *flat(points))
                assert is_certain
                assert is_nearest(found, exact)
                assert found != 0.0 or math.copysign(1.0, found) == 1.0

    def test_whole(self) -> None:
        draw = random.Random(6)
        for made, _ in itertools.product((generic, half_way, symmetric), range(80)):
            points = made(draw)
            x, y, is_certain = nearest_circumcentre(open_context(), *flat(points))
            exact = exact_centre(points)
            assert is_certain or any(0 < abs(value) < 2.0**-50 for value in exact)  # where zero was the first guess
            assert not is_certain or all(map(is_nearest, (x, y), exact))
        assert nearest_circumcentre(open_context(), 0.0, 0.0, 1.0, 0.0, 2.0, 0.0) == (0.0, 0.0, False)

    def test_control_the_odd_neighbour_of_a_tie_is_refused(self) -> None:
        """A tie rounded to the odd double."""
        tie = 1 + Fraction(1, 2**53)
        assert is_nearest(1.0, tie)
        assert not is_nearest(1.0 + 2.0**-52, tie)
