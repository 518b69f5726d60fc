"""K7: the circumcentre in doubles, step by step: sound and tight errors, exact decisions, nearest results."""

import itertools
import math
import random
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from proofs_tests.crossing_oracle import is_nearest
from proofs_tests.interpreted import Workspace, interpreted, watched_expansions
from proofs_tests.magnitudes import cross, difference, inner
from proofs_tests.oracles import circumcircle, rationals

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
@pytest.mark.obligation("K1", "the error of a quotient in pairs is sound, and tight", method="calculus")
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
<<<<<<< HEAD
        """A result without its tail, or with the tail's sign changed."""
=======
        """A tail that is lost."""
>>>>>>> 1c17f1bd652d14b461f8e2837a1096b7d026f7f6
        x, tail, error = quotient_offset(1.0, 1.0, 0.0, 0.0, 3.0, 0.0, 0.0)
        assert abs(Fraction(4, 3) - Fraction(x) - Fraction(tail)) <= Fraction(error)
        assert abs(Fraction(4, 3) - Fraction(x) + Fraction(tail)) > Fraction(error)


@interpreted
@pytest.mark.obligation(
    "K1", "the circumcentre in pairs is within its error, which is known inside the window", method="calculus"
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
<<<<<<< HEAD
        """A coordinate rounded to one double, its tail forgotten."""
=======
        """The heads without their tails."""
>>>>>>> 1c17f1bd652d14b461f8e2837a1096b7d026f7f6
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
<<<<<<< HEAD
        """The x coordinate taken for y."""
=======
        """The coordinate of the other axis."""
>>>>>>> 1c17f1bd652d14b461f8e2837a1096b7d026f7f6
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
<<<<<<< HEAD
        """A tie rounded to the odd double."""
        tie = 1 + Fraction(1, 2**53)
        assert is_nearest(1.0, tie)
        assert not is_nearest(1.0 + 2.0**-52, tie)
=======
        """The odd neighbour of a tie."""
        tie = 1 + Fraction(1, 2**53)
        assert is_nearest(1.0, tie)
        assert not is_nearest(1.0 + 2.0**-52, tie)


@interpreted
@pytest.mark.obligation("K7", "what cannot be decided about a circumcentre is left open", method="named cases")
class TestLeftOpen:
    """With answers of the expansions given: what is asked of them, and what is made of the answers."""

    @staticmethod
    def decided(
        patch: pytest.MonkeyPatch, x: float, tail: float, *answers: tuple[int, float]
    ) -> tuple[tuple[float, bool], list[tuple[float, float]]]:
        asked: list[tuple[float, float]] = []

        def scripted(axis: int, middle: float, rest: float, *_: object) -> tuple[int, float]:
            asked.append((middle, rest))
            return answers[len(asked) - 1]

        patch.setattr(centre, "_beyond", scripted)
        return centre._decided(open_context(), 0, x, tail, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0), asked

    def test_starts_outside_of_the_window(self, monkeypatch: pytest.MonkeyPatch) -> None:
        below, above = math.nextafter(MIN, 0.0), math.nextafter(MAX, math.inf)
        for x, tail in ((below, 0.0), (-below, 0.0), (above, 0.0), (1.0, above), (1.0, -above), (above, 1.0)):
            assert self.decided(monkeypatch, x, tail, (0, 0.0)) == ((x, False), [])
        for x in (MIN, -MIN, MAX, 0.0):
            assert self.decided(monkeypatch, x, 0.0, (0, 0.0)) == ((x, True), [(x, 0.0)])

    def test_tails_below_the_window_are_dropped(self, monkeypatch: pytest.MonkeyPatch) -> None:
        for sign in (-1, 1):
            assert self.decided(monkeypatch, 1.0, sign * MIN, (0, 0.0))[1] == [(1.0, sign * MIN)]
            assert self.decided(monkeypatch, 1.0, sign * math.nextafter(MIN, 0.0), (0, 0.0))[1] == [(1.0, 0.0)]

    def test_differences_that_are_too_large(self, monkeypatch: pytest.MonkeyPatch) -> None:
        for difference_found in (MAX, -MAX, math.inf, math.nan):
            assert self.decided(monkeypatch, 1.0, 0.0, (1, difference_found)) == ((1.0, False), [(1.0, 0.0)])
        below = math.nextafter(MAX, 0.0)
        monkeypatch.setattr(centre, "is_nearest_certain", lambda *_: True)
        assert self.decided(monkeypatch, 1.0, 0.0, (1, below))[0] == (below, True)

    def test_the_smallest_result(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """MIN itself is large enough; what may be below is compared with zero, and left open if it is not zero."""
        assert self.decided(monkeypatch, MIN, 0.0, (1, MIN * 2.0**-80)) == ((MIN, True), [(MIN, 0.0)])
        assert self.decided(monkeypatch, -MIN, 0.0, (1, MIN * 2.0**-80)) == ((-MIN, True), [(-MIN, 0.0)])
        below = math.nextafter(MIN, 0.0) - MIN
        for sign in (-1, 1):
            for side in (0, 1):
                found = self.decided(monkeypatch, sign * MIN, 0.0, (-sign, sign * below), (side, 0.0))
                assert found == ((0.0, side == 0), [(sign * MIN, 0.0), (0.0, 0.0)])

    def test_near_zero_is_asked_of_zero(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """An interval that touches [-MIN, MIN] from either side, and one that just does not."""
        monkeypatch.setattr(centre, "is_nearest_certain", lambda *_: False)
        for sign in (-1, 1):
            _, asked = self.decided(monkeypatch, sign * MIN, 0.0, (1, MIN * 2.0**-80), (1, 0.0))
            assert asked[1] == (0.0, 0.0)
            _, asked = self.decided(monkeypatch, sign * MIN * (1 + 2.0**-51), 0.0, (1, MIN * 2.0**-80), (1, 0.0))
            assert asked[1:] != [(0.0, 0.0)]

    def test_more_than_two_candidates(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """An error of several units in the last place, and none at all, are left open."""
        monkeypatch.setattr(centre, "is_nearest_certain", lambda *_: False)
        assert self.decided(monkeypatch, -1.0, 0.0, (1, 1.0 + 2.0**-3))[0][1] is False
        assert self.decided(monkeypatch, 1.0, 0.0, (1, 2.0**-60)) == ((1.0, False), [(1.0, 0.0)])

    def test_two_candidates(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Half-way between 1 and its neighbour: the exact side decides, and the even one if it is a tie."""
        high = 1.0 + 2.0**-52
        for side, wanted in ((-1, 1.0), (0, 1.0), (1, high)):
            found = self.decided(monkeypatch, 1.0, 0.0, (1, 2.0**-53), (side, 0.0))
            assert found == ((wanted, True), [(1.0, 0.0), (1.0, 2.0**-53)])
        higher = high + 2.0**-52
        assert self.decided(monkeypatch, high, 2.0**-53, (0, 0.0), (0, 0.0))[0] == (higher, True)

    def test_errors_told(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """At least 16u of the difference and u of the sum, at most twice that."""
        told: list[float] = []
        monkeypatch.setattr(centre, "is_nearest_certain", lambda x, tail, error: bool(told.append(error)) or True)
        for tail, found in ((0.0, 2.0**-60), (2.0**-53, 2.0**-90), (2.0**-60, -(2.0**-61)), (2.0**-60, -(2.0**-60))):
            self.decided(monkeypatch, 1.0, tail, (1, found))
            least = 16 * U * abs(Fraction(found)) + U * abs(Fraction(tail) + Fraction(found))
            assert least <= Fraction(told.pop()) <= 2 * least * (1 + 2 * U)

    def test_the_interval_in_question(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """It reaches beyond the error by at least 4u, at most 8u, of what the error is added to."""
        monkeypatch.setattr(centre, "is_nearest_certain", lambda *_: False)
        for x, half in ((1.0, 2.0**-53), (-1.0, -(2.0**-53)), (1.5, 2.0**-53), (-1.5, -(2.0**-53))):
            first = 0
            for steps in range(400):  # units of u below the middle of two doubles
                near = half * (1 - steps * 2.0**-53)
                (_, is_certain), _ = self.decided(monkeypatch, x, 0.0, (1, near), (1, 0.0))
                first = max(first, steps * is_certain)
            assert 32 + 2 + 4 - 1 <= first <= 32 + 2 + 8 + 1

    def test_when_expansions_are_asked(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Only for coordinates that pairs leave open, or that are below the window; not after one that failed."""
        values = (
            (1.0, 0.0),
            (1.0, 2.0**-53),
            (MIN, 0.0),
            (-MIN, 0.0),
            (math.nextafter(MIN, 0.0), 0.0),
            (1.0, math.inf),
        )
        for (x, x_error), (y, y_error) in itertools.product(values, repeat=2):
            for answers in itertools.product((True, False), repeat=2):
                pairs = (x, 0.0, x_error, y, 0.0, y_error)
                asked: list[tuple[int, float]] = []

                def decide(
                    _: object,
                    axis: int,
                    value: float,
                    *__: float,
                    asked: list[tuple[int, float]] = asked,
                    answers: tuple[bool, ...] = answers,
                ) -> tuple[float, bool]:
                    asked.append((axis, value))
                    return 7.0 + axis, answers[axis]

                monkeypatch.setattr(centre, "circumcentre_in_pairs", lambda *_, pairs=pairs: pairs)
                monkeypatch.setattr(centre, "_decided", decide)
                found = nearest_circumcentre(open_context(), *[0.0] * 6)
                open_ = [abs(value) < MIN or error > 0.0 for value, error in ((x, x_error), (y, y_error))]
                if math.inf in (x_error, y_error):
                    assert (found, asked) == ((x, y, False), [])
                    continue
                first_failed = open_[0] and not answers[0]
                wanted = [(0, x)] * open_[0] + [(1, y)] * (open_[1] and not first_failed)
                assert asked == wanted
                certain = not first_failed and (not open_[1] or answers[1])
                assert found == (7.0 if open_[0] else x, 8.0 if (1, y) in wanted else y, certain)

    def test_control_a_scripted_answer_is_heeded(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """An answer of the other sign."""
        up = self.decided(monkeypatch, 1.0, 0.0, (1, 2.0**-53), (1, 0.0))
        assert up != self.decided(monkeypatch, 1.0, 0.0, (1, 2.0**-53), (-1, 0.0))
>>>>>>> 1c17f1bd652d14b461f8e2837a1096b7d026f7f6
