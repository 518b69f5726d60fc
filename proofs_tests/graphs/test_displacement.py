"""How far points are from their segments, against fractions."""

from fractions import Fraction

import numpy as np
import pytest
from gmpy2 import mpq
from hypothesis import given
from hypothesis import strategies as st

from exactkernel.types import FloatArray
from exactmesh.refinement import displacement
from exactmesh.refinement.displacement import displacement_squared, worst_displacement
from exactmesh.refinement.split_point import split_point

Row = tuple[float, float, float, float, float, float]


def distance_squared(row: Row) -> Fraction:
    """Return the squared distance of a point from a segment: that of the nearest of its points."""
    px, py, ax, ay, bx, by = map(Fraction, row)
    ux, uy = bx - ax, by - ay
    length = ux * ux + uy * uy
    s = Fraction(0) if length == 0 else min(max((ux * (px - ax) + uy * (py - ay)) / length, Fraction(0)), Fraction(1))
    return (px - ax - s * ux) ** 2 + (py - ay - s * uy) ** 2


def columns(rows: list[Row]) -> tuple[FloatArray, FloatArray, FloatArray]:
    array = np.array(rows, dtype=np.float64).reshape(-1, 6)
    return array[:, :2].copy(), array[:, 2:4].copy(), array[:, 4:].copy()


def answer(rows: list[Row]) -> tuple[Fraction, int]:
    distance, worst = worst_displacement(*columns(rows))
    return Fraction(int(distance.numerator), int(distance.denominator)), worst


def expected(rows: list[Row]) -> tuple[Fraction, int]:
    distances = [distance_squared(row) for row in rows]
    largest = max(distances, default=Fraction(0))
    return largest, distances.index(largest) if largest else -1


@st.composite
def rows_near_segments(draw: st.DrawFn) -> list[Row]:
    """Points that split segments, some moved by an ulp or two, some anywhere; scaled together."""
    scale = 2.0 ** draw(st.sampled_from([0, 0, 0, -400, 400, -1000]))
    rows: list[Row] = []
    for _ in range(draw(st.integers(0, 12))):
        numbers = st.one_of(st.integers(-8, 8).map(float), st.floats(-1.0, 1.0))
        ax, ay, bx, by = (draw(numbers) for _ in range(4))
        if draw(st.integers(0, 5)) == 0 or (ax, ay) == (bx, by):
            px, py = draw(numbers), draw(numbers)
        else:
            px, py, _ = split_point(ax, ay, bx, by, draw(st.floats(0.01, 0.99)), 0.1, 2.0**-268)
            py += draw(st.integers(-1, 1)) * np.spacing(py)
        ends = [float(x) * scale for x in (px, py, ax, ay, bx, by)]
        rows.append((ends[0], ends[1], ends[2], ends[3], ends[4], ends[5]))
    return rows


@pytest.mark.obligation(
    "R1", "the displacement of segments that is reported is the exact maximum", method="property-based"
)
class TestDisplacement:
    """Law: the answer is the maximum of the exact distances, and the first point that attains it."""

    @given(rows_near_segments())
    def test_equals_the_fractions(self, rows: list[Row]) -> None:
        assert answer(rows) == expected(rows)

    def test_nothing(self) -> None:
        assert answer([]) == (Fraction(0), -1)
        assert displacement_squared(*columns([])) == 0

    def test_exactly_on_many_segments(self) -> None:
        rng = np.random.default_rng(1)
        starts, steps = rng.integers(-100, 100, (2, 1000, 2)).astype(np.float64)
        middle = starts + steps / 8.0
        assert worst_displacement(middle, starts, starts + steps) == (mpq(0), -1)
        middle[500, 0] += 2.0**-60 if middle[500, 0] == 0.0 else np.spacing(middle[500, 0])
        distance, worst = worst_displacement(middle, starts, starts + steps)
        assert worst == 500
        assert distance > 0

    @pytest.mark.parametrize(
        ("row", "distance"),
        [
            ((3.0, 3.0, 0.0, 0.0, 2.0, 2.0), 2),
            ((-1.0, 0.0, 0.0, 0.0, 2.0, 0.0), 1),
            ((1.0, 1.0, 0.0, 0.0, 0.0, 0.0), 2),
            ((2.0, 0.0, 0.0, 0.0, 2.0, 0.0), 0),
            ((1.0, 1e-300, 0.0, 0.0, 2.0, 0.0), Fraction(1e-300) ** 2),
            ((0.0, 5e-324, -1e308, 0.0, 1e308, 0.0), Fraction(5e-324) ** 2),
        ],
    )
    def test_named(self, row: Row, distance: Fraction) -> None:
        assert distance_squared(row) == distance
        assert answer([row]) == (distance, 0 if distance else -1)

    def test_ties_in_doubles_are_settled_exactly(self) -> None:
        rows = [(1.0, 1.0 + 2.0**-40 + i * 2.0**-90, 0.0, 0.0, 2.0, 0.0) for i in range(3)]
        rows += [(1e-20 * i, 2.0, 0.0, 0.0, 0.5 + i, 2.0**-60 * i) for i in range(9)]
        assert answer(rows) == expected(rows)

    def test_control_in_doubles(self) -> None:
        """Distances compared in doubles: another point is the farthest."""
        rows = [(3.0, 2.0**-k, 0.0, 0.0, 2.0, 0.0) for k in (30, 29, 31)]
        distances = [float(distance_squared(row)) for row in rows]
        assert answer(rows)[1] == expected(rows)[1] == 1
        assert distances.index(max(distances)) != 1


class TestControls:
    """Controls: the same law rejects the distance to the line, and bounds that are no bounds."""

    def test_control_distance_to_the_line(self, monkeypatch: pytest.MonkeyPatch) -> None:
        def to_the_line(a: tuple[mpq, mpq], b: tuple[mpq, mpq], p: tuple[mpq, mpq]) -> mpq:
            ux, uy = b[0] - a[0], b[1] - a[1]
            cross = ux * (p[1] - a[1]) - uy * (p[0] - a[0])
            return cross * cross / (ux * ux + uy * uy)

        monkeypatch.setattr(displacement, "distance_squared", to_the_line)
        rows = [(3.0, 3.0, 0.0, 0.0, 2.0, 2.0)]
        assert answer(rows) != expected(rows)

    def test_control_a_wrong_order_of_bounds(self, monkeypatch: pytest.MonkeyPatch) -> None:
        def too_low(*given: object) -> float:
            high = given[-1]
            assert isinstance(high, np.ndarray)
            high[:] = np.arange(len(high))
            return float(len(high) - 1)

        monkeypatch.setattr(displacement, "_bound_range", too_low)
        rows = [(1.0, 2.0, 0.0, 0.0, 2.0, 0.0), (1.0, 1.0, 0.0, 0.0, 2.0, 0.0)]
        assert answer(rows) != expected(rows)
