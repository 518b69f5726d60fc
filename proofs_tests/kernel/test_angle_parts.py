"""K1: what angles are compared by: signs, products, double-doubles, expansions, each against fractions."""

import itertools
import math
import random
from fractions import Fraction

import numpy as np
import pytest
from proofs_tests.kernel.interpreted import Workspace, interpreted, watched_expansions
from proofs_tests.kernel.test_angle_stages import EXACT, angle, corner, corner_expansion, near_ties, small
from proofs_tests.kernel.test_measure_stages import flat
from proofs_tests.rounding.magnitudes import cross, difference, inner

from exactkernel.angle import (
    angle_bound,
    beyond,
    corner_double_double,
    edge_products,
    sign_of,
)
from exactkernel.constants import DD_BOUND
from exactkernel.context import SCRATCH_SIZE
from exactkernel.expansions import two_diff


@interpreted
@pytest.mark.obligation(
    "K1", "what angles are computed from: products exact on integers, pairs within their bound", method="property-based"
)
class TestParts:
    """Signs, twice the area, scalar products, and the value in double-double, each against fractions."""

    def test_signs(self) -> None:
        for x in (-1.5, -5e-324, -0.0, 0.0, 5e-324, 1.5):
            assert sign_of(x) == (x > 0) - (x < 0)
            for error in (0.0, 5e-324, 1.5, math.inf):
                assert beyond(x, error) == (x > error) - (x < -error)

    def test_edge_products(self) -> None:
        draw = random.Random(1)
        for _ in range(400):
            a, b, c = small(draw)
            twice, crosses, *dots, largest = edge_products(*flat((a, b, c)))
            wanted = [inner(difference(q, p), difference(r, p)) for p, q, r in ((a, b, c), (b, c, a), (c, a, b))]
            assert dots == [dot.value for dot in wanted]
            assert largest == max(dot.permanent for dot in wanted)
            area = cross(difference(b, a), difference(c, b))
            assert twice == area.value
            assert crosses == area.permanent

    def test_double_doubles(self) -> None:
        """The value errs by at most DD_BOUND times the permanent, and its rounding to one double."""
        draw = random.Random(2)
        for _ in range(300):
            degrees, (a, b, c) = near_ties(draw)
            bound, exact = angle_bound(degrees), corner(angle_bound(degrees), a, b, c)
            pairs = [x for p in (b, c) for i in range(2) for x in two_diff(p[i], a[i])]
            error = abs(Fraction(corner_double_double(bound, *pairs)) - exact.value)
            assert error <= Fraction(DD_BOUND) * exact.permanent + abs(exact.value) / 2**53

    def test_expansions(self) -> None:
        """The exact sign for each bound that an angle can meet, whatever lay in the scratch space."""
        draw, scratch, met = random.Random(3), np.empty(SCRATCH_SIZE), set()
        for _ in range(40):
            _, (a, b, c) = near_ties(draw)
            for x, y in ((1.0, 1.0), (0.0, -3.0), (-1.0, 1.0), (2.0, 0.0), (-2.0, 0.0), (0.0, 0.0)):
                points = ((0.0, 0.0), (0.5, 0.0), (x, y)) if x or y else (a, b, c)
                pairs = [x for p in points[1:] for i in range(2) for x in two_diff(p[i], points[0][i])]
                for degrees in EXACT:
                    bound = angle_bound(degrees)
                    scratch.fill(draw.choice((1e300, -1e300)))
                    sign = corner(bound, *points).sign
                    assert corner_expansion(bound, *pairs, scratch) == sign
                    met.add((degrees, sign))
        assert met == set(itertools.product(EXACT, (-1, 0, 1)))

    def test_bounds(self) -> None:
        """Exact bounds are integers without tails; the smallest that has a sine; beneath it, none."""
        for degrees in EXACT:
            bound = angle_bound(degrees)
            assert (bound.cosine_tail, bound.sine_tail, bound.is_exact) == (0.0, 0.0, True)
        assert angle_bound(1e-100).sine == pytest.approx(math.radians(1e-100), rel=1e-15, abs=0.0)
        assert math.isnan(angle_bound(math.nextafter(1e-100, 0.0)).sine)

    def test_control_a_sine_without_its_tail_errs_by_more(self) -> None:
        """A sine rounded to one double."""
        degrees, (a, b, c) = 20.0, ((0.0, 0.0), (1.0, 0.0), (2.0, 1.0))
        headless = angle_bound(degrees)._replace(sine_tail=0.0)
        pairs = [x for p in (b, c) for i in range(2) for x in two_diff(p[i], a[i])]
        exact = corner(angle_bound(degrees), a, b, c)
        error = abs(Fraction(corner_double_double(headless, *pairs)) - exact.value)
        assert error > Fraction(DD_BOUND) * exact.permanent


@interpreted
@pytest.mark.obligation("K5", "the workspaces of angles hold the longest expansions", method="calculus")
class TestWorkspaces:
    """Whatever the input: an expansion has room for the longest that its operands allow, and no two overlap."""

    def test_room(self, monkeypatch: pytest.MonkeyPatch) -> None:
        watched_expansions(monkeypatch, angle)
        scratch = Workspace.of(SCRATCH_SIZE)
        for degrees in (45.0, 135.0):
            assert corner_expansion(angle_bound(degrees), *[0.1, 1e-20, 0.3, -1e-20] * 2, scratch) == 1

    def test_control_too_short_a_workspace_is_noticed(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """A workspace one double too short."""
        watched_expansions(monkeypatch, angle)
        with pytest.raises(AssertionError):
            corner_expansion(angle_bound(45.0), *[0.1, 1e-20, 0.3, -1e-20] * 2, Workspace.of(95))
