"""V1 and V2 for bounds on angles, areas and lengths: which are none, what is said of those that are violated."""

import math
from fractions import Fraction
from random import Random

import numpy as np
import numpy.typing as npt
import pytest
from proofs_tests import oracles

from exactkernel import BoundError
from exactkernel.types import FloatArray
from exactmesh.verify import Property, Severity, Violation, sizes, verify
from exactmesh.verify.mesh import index_triples

Place = tuple[float, float]
LARGEST = 1.7976931348623157e308
#: An area of 6, angles of 36.8698976 and 53.1301024 degrees.
EGYPTIAN = [(0.0, 0.0), (4.0, 0.0), (0.0, 3.0)]


def the_one(points: list[Place], property_: Property, **bounds: float) -> Violation:
    """The violation of a single triangle."""
    report = verify(points, [(0, 1, 2)], **bounds)  # type: ignore[call-overload]  # bounds by name
    (violation,) = report.findings[property_].violations
    assert isinstance(violation, Violation)
    return violation


@pytest.mark.obligation("V3", "a violated bound is told with both numbers", method="named cases", control_in="mutants")
class TestMessages:
    """The area or the angle, its corner, the bound; and that it is rounding-sized, where it is."""

    @pytest.mark.parametrize(
        ("limit", "rounding"), [(5.0, False), (math.nextafter(6.0, 0.0), True), (6.0 - 2.0**-30, False)]
    )
    def test_area(self, limit: float, rounding: bool) -> None:
        violation = the_one(EGYPTIAN, Property.MAX_AREA, max_area=limit)
        tail = ", rounding-sized" if rounding else ""
        assert violation.message.endswith(f" has an area of 6, more than {limit:g}{tail}")
        assert violation.severity is (Severity.ROUNDING if rounding else Severity.WRONG)
        assert violation.magnitude == 12

    @pytest.mark.parametrize(("degrees", "rounding"), [(40.0, False), (None, True)])
    def test_small_angle(self, degrees: float | None, rounding: bool) -> None:
        exact = math.degrees(math.atan2(3, 4))  # the double above the angle, or this one
        bound = degrees or math.nextafter(exact, 90.0)
        violation = the_one(EGYPTIAN, Property.MIN_ANGLE, min_angle=bound)
        tail = ", rounding-sized" if rounding else ""
        assert violation.message.endswith(
            f" has an angle of 36.8699 degrees at 1 (4.0, 0.0), less than {bound:g}{tail}"
        )
        assert violation.severity is (Severity.ROUNDING if rounding else Severity.WRONG)

    @pytest.mark.parametrize(("less", "rounding"), [(0.5, False), (2.0**-53, True)])
    def test_large_angle(self, less: float, rounding: bool) -> None:
        violation = the_one([(0.0, 0.0), (1.0, 1.0 - less), (-1.0, 1.0)], Property.MAX_ANGLE, max_angle=90.0)
        tail = ", rounding-sized" if rounding else ""
        angle = f"{math.degrees(math.atan2(2 - less, -less)):.6g}"
        assert violation.message.endswith(f" has an angle of {angle} degrees at 0 (0.0, 0.0), more than 90{tail}")


@pytest.mark.obligation("V1", "what is no bound is named, what is none at all does not bind", method="named cases")
class TestNoBounds:
    """An area that is not positive, in an array, binds nothing; NaN is refused, and its triangles are listed."""

    points, two = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)], [(0, 1, 2), (0, 2, 3)]

    @pytest.mark.parametrize("none", [0.0, -0.0, -1.0, math.inf, -math.inf])
    def test_not_positive(self, none: float) -> None:
        finding = verify(self.points, self.two, max_area=[none, 1.0]).findings[Property.MAX_AREA]
        assert [v.triangles for v in finding.violations] == [(1,)]

    @pytest.mark.parametrize("areas", [[1.0, math.nan], [math.nan, math.nan]])
    def test_control_not_a_number(self, areas: list[float]) -> None:
        """NaN for a limit, which every comparison would let pass."""
        with pytest.raises(BoundError, match="max_area is NaN") as caught:
            verify(self.points, self.two, max_area=areas)
        assert caught.value.indices == tuple(i for i, area in enumerate(areas) if math.isnan(area))
        with pytest.raises(BoundError, match="max_area is NaN") as caught:
            verify(self.points, self.two, max_area=math.nan)
        assert caught.value.indices == ()


@pytest.mark.obligation("V1", "sizes are asked for at the centroids", method="differential", control_in="mutants")
class TestCentroids:
    """The mean of the corners but for rounding, wherever they are: sums that overflow do no harm."""

    @pytest.mark.parametrize("scale", [1.0, 2.0**1023, 2.0**-1000, LARGEST])
    def test_against_fractions(self, scale: float) -> None:
        random = Random(5)
        corners = [(random.uniform(-1, 1) * scale, random.choice((0.75, 1.0, -1.0)) * scale) for _ in range(12)]
        corners[:3] = [(scale, scale), (scale, -scale), (scale, scale)]
        triangles = index_triples(np.arange(12).reshape(4, 3))
        asked = list[FloatArray]()

        def size(at: FloatArray) -> npt.ArrayLike:
            asked.append(at)
            return math.inf

        sizes.sizes_at(size, np.array(corners), triangles)
        (at,) = asked
        exact = oracles.rationals(corners)
        for t, found in zip(triangles.tolist(), at.tolist(), strict=True):
            for axis in range(2):
                mean = sum((exact[v][axis] for v in t), Fraction(0)) / 3
                assert abs(Fraction(found[axis]) - mean) <= Fraction(scale) / 2**50
