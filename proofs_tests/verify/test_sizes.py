"""V1 and V2 for the size field: no edge longer than what is wanted at the centroid, against fractions."""

import json
import math
from fractions import Fraction
from random import Random

import numpy as np
import numpy.typing as npt
import pytest
from proofs_tests import oracles
from proofs_tests.kernel import shape_oracle

from exactkernel import BoundError, ShapeError
from exactkernel.types import FloatArray
from exactmesh import PSLG, delaunay, refine
from exactmesh.verify import ChoiceError, Finding, Kind, Property, Severity, Verdict, deciding, grading, verify

U = Fraction(1, 2**53)
MEASURE = 12 * U + 64 * U * U
SQUARE = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]
TWO = [(0, 1, 2), (0, 2, 3)]


@pytest.mark.obligation(
    "V1",
    "a size field is kept iff no edge is longer than its size, in fractions",
    method="differential",
    control_in="TestAblation",
)
class TestSizes:
    """The violations are the triangles that Pythagoras finds, and as many of them are rounding-sized as by definition,
    at any scale, for degenerate triangles as well."""

    @pytest.mark.parametrize("seed", range(30))
    def test_random_triangles(self, seed: int) -> None:
        random = Random(seed)
        scale = 2.0 ** random.choice((0, 0, -600, 400))
        points = [(random.randrange(9) * scale, random.randrange(9) * scale) for _ in range(9)]
        triangles = [(a, b, c) for a, b, c in (random.sample(range(9), 3) for _ in range(12))]
        sizes = [
            random.choice((3.0, 5.0, math.nextafter(5.0, 0.0), math.sqrt(2.0), math.inf)) * scale for _ in range(12)
        ]
        exact = oracles.rationals(points)
        finding = verify(points, triangles, size=sizes).findings[Property.MAX_LENGTH]
        edges = [[(exact[t[i - 1]], exact[t[i]]) for i in range(3)] for t in triangles]
        long = [
            i
            for i, sides in enumerate(edges)
            if sizes[i] < math.inf and any(shape_oracle.length_above(side, sizes[i]) for side in sides)
        ]
        assert sorted(v.triangles[0] for v in finding.violations) == long
        small = 0
        for i in long:
            squares = [oracles.squared_distance(*side) for side in edges[i]]
            limit = Fraction(sizes[i]) ** 2
            small += all(square - limit <= MEASURE * (square + limit) for square in squares)
        assert (finding.count, finding.rounding) == (len(long), small)
        for violation in finding.violations:
            (t,), (a, b) = violation.triangles, violation.vertices
            longest = max(oracles.squared_distance(*side) for side in edges[t])
            assert violation.magnitude == oracles.squared_distance(exact[a], exact[b]) == longest

    def test_equality_is_no_violation(self) -> None:
        assert verify([(0, 0), (3, 0), (3, 4)], [(0, 1, 2)], size=5).ok
        report = verify([(0, 0), (3, 0), (3, 4)], [(0, 1, 2)], size=math.nextafter(5.0, 0.0))
        (violation,) = report.findings[Property.MAX_LENGTH].violations
        assert (violation.kind, violation.vertices) == (Kind.LONG_EDGE, (2, 0))
        assert violation.magnitude == 25
        assert violation.severity is report.severity is Severity.ROUNDING
        assert "is 5 long, more than 5, rounding-sized" in violation.message

    def test_a_function(self) -> None:
        """It is asked once, at the centroids."""
        asked = list[FloatArray]()

        def size(at: FloatArray) -> npt.ArrayLike:
            asked.append(at)
            return 1.0 + at[:, 0]

        report = verify(SQUARE, TWO, size=size)
        assert len(asked) == 1
        assert np.allclose(asked[0], [(4 / 3, 2 / 3), (2 / 3, 4 / 3)])
        assert [v.triangles for v in report.findings[Property.MAX_LENGTH].violations] == [(1,), (0,)]
        assert verify(SQUARE, TWO, size=lambda _: 3.0).ok
        huge = np.array(SQUARE) * 2.0**1022
        verify(huge, TWO, size=lambda at: np.where(np.isfinite(at).all(axis=1), 1.0, np.nan))

    def test_refined(self) -> None:
        """What refinement promises holds; what it was not asked for does not."""

        def size(at: FloatArray) -> npt.ArrayLike:
            return 0.05 + np.hypot(at[:, 0], at[:, 1]) / 4

        domain = PSLG([(0, 0), (4, 0), (4, 4), (0, 4)], [(0, 1), (1, 2), (2, 3), (3, 0)])
        mesh = refine(domain, size=size).triangulation
        assert verify(mesh.points, mesh.triangles, domain=domain, size=size).ok
        assert not verify(mesh.points, mesh.triangles, domain=domain, size=lambda at: 0.9 * np.asarray(size(at))).ok

    def test_the_worst_first(self) -> None:
        mesh = delaunay(np.random.default_rng(1).random((300, 2)))
        finding = verify(mesh.points, mesh.triangles, size=0.01).findings[Property.MAX_LENGTH]
        sizes = [violation.magnitude or Fraction(0) for violation in finding.violations]
        assert sizes == sorted(sizes, reverse=True)
        assert finding.count > len(sizes) == 100

    @pytest.mark.parametrize("bad", [0, -1.0, math.nan, [1.0, math.nan], [1.0, 0.0], lambda _: -1.0])
    def test_bad_sizes(self, bad: float) -> None:
        with pytest.raises(BoundError, match="positive"):
            verify(SQUARE, TWO, size=bad)

    @pytest.mark.parametrize("bad", ["a", [1.0], [[1.0, 1.0]], lambda at: at])
    def test_bad_shapes(self, bad: float) -> None:
        with pytest.raises(ShapeError, match="size"):
            verify(SQUARE, TWO, size=bad)

    def test_claims(self) -> None:
        assert verify(SQUARE, TWO, size=3).claims[-1] is Property.MAX_LENGTH
        with pytest.raises(ChoiceError, match="size="):
            verify(SQUARE, TWO, claims=["max-length"])
        assert json.loads(verify(SQUARE, TWO, size=1).to_json())["properties"]["max_length"]["count"] == 2
        unreadable = verify([(0, math.nan), (1, 0), (0, 1)], [(0, 1, 2)], size=lambda _: pytest.fail("asked"))
        assert unreadable.verdict(Property.MAX_LENGTH) is Verdict.UNDECIDED


@pytest.mark.obligation("V2", "each condition about sizes is necessary", method="ablation")
class TestAblation:
    """What the check refuses passes without it; what double-doubles leave open, rationals decide likewise."""

    def test_control_missing_check(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """The check of lengths taken out."""
        assert not verify(SQUARE, TWO, size=2.5).ok
        monkeypatch.setattr(deciding, "check_lengths", lambda *_: Finding(Verdict.HOLDS))
        assert verify(SQUARE, TWO, size=2.5).ok

    def test_rationals_say_the_same(self, monkeypatch: pytest.MonkeyPatch) -> None:
        mesh = delaunay(np.random.default_rng(2).random((30, 2)))
        longest = max(math.dist(mesh.points[a], mesh.points[b]) for t in mesh.triangles for a, b in (t[:2], t[1:]))
        sizes = np.random.default_rng(3).choice([longest, 0.2, math.nextafter(longest, 0)], len(mesh.triangles))
        before = verify(mesh.points, mesh.triangles, size=sizes).findings[Property.MAX_LENGTH]
        monkeypatch.setattr(grading, "grade_lengths", lambda *_: None)
        after = verify(mesh.points, mesh.triangles, size=sizes).findings[Property.MAX_LENGTH]
        assert (before.count, before.rounding) == (after.count, after.rounding)
