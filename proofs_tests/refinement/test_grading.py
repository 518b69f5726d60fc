"""R1: what is known of the edges that refinement makes: insertion radii, and the grading that follows from them."""

from collections import Counter
from collections.abc import Sequence
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from proofs_tests import oracles
from proofs_tests.kernel.shape_oracle import cosine_interval
from proofs_tests.recording import Record
from proofs_tests.refinement import oracle as refine_oracle
from proofs_tests.refinement.grading_oracle import (
    ENCROACHED,
    INTERIOR,
    SLACK,
    SQRT2,
    YIELDED,
    Account,
    grading_constant,
    grading_faults,
    local_feature_size_squared,
    radius_faults,
)

from exactkernel.jit import COMPILED
from exactmesh import PSLG, Refinement, refine

Corner = tuple[float, float]

#: The least angle in degrees, and a B that is less than 1 / (2 sin) of it by more than the rounding of a centre costs:
#: that is computed with an area of ten digits at least, so its distance errs by less than 2^-28.
#: And a number below (2/3) cos of it.
ANGLES = (
    (10.0, Fraction(23, 8), Fraction(656, 1000)),
    (14.47, Fraction(2), Fraction(645, 1000)),
    (17.0, Fraction(17, 10), Fraction(637, 1000)),
)
FEW = settings(max_examples=25 if COMPILED else 6)


def box(width: float, height: float) -> list[Corner]:
    return [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]


FRAME = [(0, 1), (1, 2), (2, 3), (3, 0)]
SPOKES = [(18, 16), (-8, 22), (-24, 0), (-7, -22), (18, -15)]  # 68 to 81 degrees apart
DOMAINS = {
    "square": PSLG.from_rings([box(8, 8)]),
    "strip": PSLG.from_rings([box(60, 1)]),
    "plate with a hole": PSLG.from_rings([box(8, 4), [(1, 1), (3, 1), (3, 3), (1, 3)]]),
    "hole near the side": PSLG.from_rings([box(8, 8), [(1, 1 / 128), (3, 1 / 128), (3, 3), (1, 3)]]),
    "small hole": PSLG.from_rings(
        [box(8, 8), [(4, 4), (4 + 1 / 512, 4), (4 + 1 / 512, 4 + 1 / 512), (4, 4 + 1 / 512)]]
    ),
    "point near the side": PSLG([*box(8, 8), (4, 1 / 512), (2, 5)], FRAME),
    "crossing": PSLG(
        [*box(16, 16), (3, 8), (13, 8), (8, 3), (8, 13), (8, 8)], [*FRAME, (4, 8), (8, 5), (6, 8), (8, 7)]
    ),
    "spokes": PSLG(
        [*box(48, 48), (24, 24), *((24 + x, 24 + y) for x, y in SPOKES)], [*FRAME, *((4, 5 + i) for i in range(5))]
    ),
    "octagon": PSLG.from_rings([[(3, 0), (7, 0), (10, 3), (10, 7), (7, 10), (3, 10), (0, 7), (0, 3)]]),
}


#: Nothing is to be done in these, whatever the angle: of radii they say nothing.
QUIET = frozenset({"square", "crossing", "octagon"})


def meets_below(domain: PSLG, degrees: float) -> bool:
    """Whether two segments meet at less than that."""
    points = [(float(x), float(y)) for x, y in domain.points.tolist()]
    segments = [(a, b) for a, b in domain.segments.tolist()]
    return refine_oracle.small_input_angle(refine_oracle.Output(points, [], points, segments), degrees)


def share(domain: PSLG, c: Fraction) -> Fraction:
    """How much of the radius of a rejected point is left to the one on the segment: 1 / sqrt 2 if it is halfway; beside
    corners below 90 degrees segments are divided at powers of two, between a third and two thirds."""
    return c if meets_below(domain, 90.0) else 1 / SQRT2


@st.composite
def wide_domains(draw: st.DrawFn) -> PSLG:
    """A frame with points, level and upright segments in it, as near to each other as they may come."""
    cells = st.integers(1, 15)
    near = draw(st.sampled_from([0.0, 1 / 8, 1 / 64]))
    points, segments = box(16, 16), list(FRAME)
    for _ in range(draw(st.integers(1, 4))):
        x, y = draw(cells) + near * draw(st.integers(-1, 1)), draw(cells) + near * draw(st.integers(-1, 1))
        length = draw(st.integers(0, 15))
        end = (min(x + length, 15.5), y) if draw(st.booleans()) else (x, min(y + length, 15.5))
        if length == 0:
            points.append((x, y))
        else:
            points += [(x, y), end]
            segments.append((len(points) - 2, len(points) - 1))
    assume(len(set(points)) == len(points))
    exact = oracles.rationals(points)
    for i, (a, b) in enumerate(segments):
        for c, d in segments[:i]:
            assume(
                {a, b} & {c, d}
                or oracles.orient(exact[a], exact[b], exact[c]) * oracles.orient(exact[a], exact[b], exact[d]) > 0
                or oracles.orient(exact[c], exact[d], exact[a]) * oracles.orient(exact[c], exact[d], exact[b]) > 0
            )
        assume(not any(oracles.on_segment(p, exact[a], exact[b]) for v, p in enumerate(exact) if v not in (a, b)))
    domain = PSLG(points, segments)
    assume(not meets_below(domain, 60.0))
    return domain


def account_of(done: Refinement, domain: PSLG) -> Account:
    points = oracles.rationals(done.triangulation.points.tolist())
    segments = [(a, b) for a, b in domain.segments.tolist()]
    return Account(points, segments, done.kinds.tolist(), done.parents.tolist(), done.radii.tolist())


def edges_of(done: Refinement) -> list[tuple[int, int]]:
    return [(a, b) for a, b in done.triangulation.edges.tolist()]


def refined(domain: PSLG, degrees: float) -> Refinement:
    done = refine(domain, min_angle=degrees)
    assert done.complete
    assert done.displacement_squared == 0
    return done


class TestConstants:
    """B is less than 1 / (2 sin of the angle), so what is tested with it is weaker than the theorem, and true."""

    @pytest.mark.parametrize(("degrees", "b", "c"), ANGLES)
    def test_b(self, degrees: float, b: Fraction, c: Fraction) -> None:
        _, sine = cosine_interval(90 - Fraction(degrees), 64)
        assert 2 * sine * b * (1 + Fraction(1, 2**28)) < 1
        assert b * b > 2
        assert 9 * c * c < 4 * (1 - 1 / (4 * b * b))  # cos^2 = 1 - sin^2
        assert c * b > 1

    def test_control_b_is_not_far_below(self) -> None:
        """A B that is larger by a hundredth would not be proved."""
        for degrees, b, _ in ANGLES:
            low, _ = cosine_interval(90 - Fraction(degrees), 64)
            assert 2 * low * b * Fraction(101, 100) > 1


class TestLocalFeatureSize:
    """The oracle, where it can be seen with the naked eye."""

    def test_square(self) -> None:
        corners = oracles.rationals(box(8, 8))
        assert local_feature_size_squared((Fraction(4), Fraction(4)), corners, FRAME) == 16
        assert local_feature_size_squared((Fraction(0), Fraction(0)), corners, FRAME) == 64
        assert local_feature_size_squared((Fraction(1), Fraction(0)), corners, FRAME) == 49

    def test_a_point_near_a_side(self) -> None:
        corners = oracles.rationals([*box(8, 8), (4.0, 1.0)])
        assert local_feature_size_squared((Fraction(4), Fraction(0)), corners, FRAME) == 1
        assert local_feature_size_squared((Fraction(4), Fraction(1)), corners, FRAME) == 1


@pytest.mark.obligation("R1", "insertion radii: no chain of causes makes edges shorter", method="property-based")
class TestInsertionRadii:
    """In a domain whose angles are 60 degrees at least, refined to an angle and nothing else. With r the insertion
    radius, the distance to the nearest vertex that a point saw when it came, p its parent, B = 1 / (2 sin kappa):

    - a point inside (off-centre or circumcentre; p the younger end of the shortest edge): r >= B r_p;
    - a point on a segment for such a one that was rejected (p the parent of that): r >= B r_p / sqrt 2, and beside
      corners below 90 degrees, where it is on a common circle, r >= B r_p (2/3) cos kappa;
    - a point on a segment for a vertex on one that meets it at an angle a: r >= r_p and r >= r_p / (3 cos a). Divided
      at powers of two from the corner, between a third and two thirds: 2^k <= L cos a encroaches on an edge of length
      L, whose shorter part is L / 3 at least, and at least 2^k;
    - but where a vertex of the input, or on a segment that has no end in common, is in the diametral circle of the edge
      that is divided (outside of the lens it need not encroach, and points inside may stay behind it): r >= lfs / 4 B.
      What is outside of the lens is (L / 2) tan kappa from the middle, and lfs is L / 2 at most, both but for where
      between a third and two thirds the point is.
    """

    @pytest.mark.parametrize(("degrees", "b", "c"), ANGLES)
    @pytest.mark.parametrize("name", [name for name in DOMAINS if name not in QUIET])
    def test_named(self, name: str, degrees: float, b: Fraction, c: Fraction, record_property: Record) -> None:
        done = refined(DOMAINS[name], degrees)
        record_property("cases", len(done.steiner))
        assert not meets_below(DOMAINS[name], 60.0)
        assert radius_faults(account_of(done, DOMAINS[name]), b, share(DOMAINS[name], c)) == []

    def test_every_kind_of_point_occurs(self) -> None:
        """With a parent that is still there, else nothing is said of it."""
        seen: Counter[int] = Counter()
        for name in DOMAINS:
            account = account_of(refined(DOMAINS[name], 17.0), DOMAINS[name])
            seen.update(kind for kind, parent in zip(account.kinds, account.parents, strict=True) if parent >= 0)
            assert (account.kinds == []) == (name in QUIET)
        assert min(seen[kind] for kind in (ENCROACHED, YIELDED, INTERIOR)) >= 20

    @FEW
    @given(wide_domains(), st.sampled_from(ANGLES))
    def test_drawn(self, domain: PSLG, angle: tuple[float, Fraction, Fraction]) -> None:
        done = refined(domain, angle[0])
        assert radius_faults(account_of(done, domain), angle[1], share(domain, angle[2])) == []

    def test_control_points_that_nothing_called_for(self) -> None:
        """Asked for small triangles, refinement puts points nearer than their parents' radii would let angles alone."""
        domain = DOMAINS["square"]
        needless = refine(domain, min_angle=14.47, unsuitable=near_the_corner)
        assert radius_faults(account_of(needless, domain), Fraction(2), 1 / SQRT2) != []

    def test_slack(self) -> None:
        """Differences, squares, their sum, the root and its own square in fractions: six roundings at most."""
        u = Fraction(1, 2**53)
        assert (1 + u) ** 6 - 1 <= SLACK
        assert 1 - (1 - u) ** 6 <= SLACK

    def test_control_half_of_the_slack(self) -> None:
        """2^-51."""
        assert (1 + Fraction(1, 2**53)) ** 6 - 1 > SLACK / 2

    def test_control_parents_that_were_removed_hide_nothing(self) -> None:
        """No parent is known, and all radii are a hundredth of what they were."""
        domain = DOMAINS["point near the side"]
        account = account_of(refined(domain, 14.47), domain)
        account = account._replace(parents=[-1] * len(account.kinds))
        assert radius_faults(account, Fraction(2), 1 / SQRT2) == []
        tiny = account._replace(radii=[r / 100 for r in account.radii])
        assert any("lfs / D" in fault for fault in radius_faults(tiny, Fraction(2), 1 / SQRT2))

    @pytest.mark.parametrize("wrong", ["radii", "parents"])
    def test_control_a_wrong_account(self, wrong: str) -> None:
        """Radii that are smaller than they were; another vertex named as the parent."""
        domain = DOMAINS["point near the side"]
        account = account_of(refined(domain, 14.47), domain)
        assert radius_faults(account, Fraction(2), 1 / SQRT2) == []
        if wrong == "parents":
            far = [max(range(account.given), key=lambda v: account.points[v][1])] * len(account.kinds)
            wrong_account = account._replace(parents=far)
        else:
            radii = [r / 16 if k == INTERIOR else r for r, k in zip(account.radii, account.kinds, strict=True)]
            wrong_account = account._replace(radii=radii)
        assert radius_faults(wrong_account, Fraction(2), 1 / SQRT2) != []


def near_the_corner(corners: np.ndarray[tuple[int, ...], np.dtype[np.float64]], _areas: object) -> Sequence[bool]:
    """Ask for triangles there that no feature explains."""
    x = corners.reshape(-1, 3, 2).mean(axis=1)
    span = np.ptp(corners.reshape(-1, 3, 2), axis=1).max(axis=1)
    wanted: list[bool] = (span > 0.02 + np.hypot(x[:, 0] - 2, x[:, 1] - 2)).tolist()
    return wanted


@pytest.mark.obligation("R1", "grading: every edge is lfs / (D + 1) long at least", method="property-based")
class TestGrading:
    """In a domain whose angles are 60 degrees at least, refined to an angle below 20.7 degrees and nothing else, no
    edge is shorter than the local feature size at either end, divided by D + 1; D = (1 + sqrt 2) B / (B - sqrt 2), and
    with corners below 90 degrees (1 + c) B / (c B - 1), c = (2/3) cos kappa; at least 4 B."""

    @pytest.mark.parametrize(("degrees", "b", "c"), ANGLES)
    @pytest.mark.parametrize("name", DOMAINS)
    def test_named(self, name: str, degrees: float, b: Fraction, c: Fraction, record_property: Record) -> None:
        done = refined(DOMAINS[name], degrees)
        record_property("cases", len(edges_of(done)))
        assert (
            grading_faults(
                account_of(done, DOMAINS[name]), edges_of(done), grading_constant(b, share(DOMAINS[name], c))
            )
            == []
        )

    @FEW
    @given(wide_domains(), st.sampled_from(ANGLES))
    def test_drawn(self, domain: PSLG, angle: tuple[float, Fraction, Fraction]) -> None:
        done = refined(domain, angle[0])
        assert (
            grading_faults(
                account_of(done, domain), edges_of(done), grading_constant(angle[1], share(domain, angle[2]))
            )
            == []
        )

    def test_control_midpoints_that_nothing_called_for(self) -> None:
        """A mesh with small triangles far from every feature."""
        domain = DOMAINS["square"]
        needless = refine(domain, min_angle=14.47, unsuitable=near_the_corner)
        assert grading_faults(account_of(needless, domain), edges_of(needless), grading_constant(Fraction(2))) != []
        plain = refined(domain, 14.47)
        assert grading_faults(account_of(plain, domain), edges_of(plain), grading_constant(Fraction(2))) == []

    def test_control_a_smaller_constant(self) -> None:
        """With D = 0 the bound is too good to be true."""
        domain = DOMAINS["small hole"]
        done = refined(domain, 14.47)
        assert grading_constant(Fraction(2)) > 8
        assert grading_faults(account_of(done, domain), edges_of(done), Fraction(0)) != []
