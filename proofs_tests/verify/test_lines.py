"""V2 for the report as text: what is worst comes first, marked as what it is."""

from fractions import Fraction
from itertools import product
from random import Random

import pytest

from exactmesh.verify import Finding, Kind, Property, Report, Severity, Verdict, Violation
from exactmesh.verify.text import digits_above, lines_of, worst_first

#: What can be said of a claim, the worst first, and its mark.
WORST = {
    "wrong": (Finding(Verdict.FAILS, 2, rounding=1), "!"),
    "rounding": (Finding(Verdict.FAILS, 2, rounding=2), "~"),
    "undecided": (Finding(Verdict.UNDECIDED, because=(Property.ADMISSIBLE,)), "?"),
    "holds": (Finding(Verdict.HOLDS), "+"),
}
FOUR = (Property.FINITE, Property.INDICES, Property.CONVEX, Property.ACUTE)


@pytest.mark.obligation("V2", "of the claims the worst come first", method="exhaustive", control_in="mutants")
class TestOrder:
    """Four claims, each of which is wrong, rounding-sized, undecided or true: sorted by that, then as defined; each
    line with its mark. What nobody claimed comes last, marked as a fact where it fails."""

    @pytest.mark.parametrize("first", WORST)
    def test_all(self, first: str) -> None:
        for others in product(WORST, repeat=3):
            said = dict(zip(FOUR, (first, *others), strict=True))
            report = Report({claim: WORST[name][0] for claim, name in said.items()}, FOUR, 3, 1, {})
            expected = [claim for name in WORST for claim in FOUR if said[claim] == name]
            assert worst_first(report) == expected
            lines = [line[2:].split()[:2] for line in [*lines_of(report)][1:]]
            assert lines == [[WORST[said[claim]][1], str(claim)] for claim in expected]

    @pytest.mark.parametrize(("name", "mark"), [("wrong", "-"), ("rounding", "-"), ("undecided", "?"), ("holds", "+")])
    def test_not_claimed(self, name: str, mark: str) -> None:
        report = Report({Property.FINITE: WORST[name][0], Property.INDICES: WORST["holds"][0]}, FOUR[1:2], 3, 1, {})
        assert [*lines_of(report)][-1].startswith(f"  {mark} finite ")
        assert [*lines_of(report)][-2] == "  not claimed:"


@pytest.mark.obligation(
    "V3", "the first three violations are told, and how many more", method="enumeration", control_in="mutants"
)
class TestShown:
    """Of any number."""

    @pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 117])
    def test_count(self, count: int) -> None:
        violations = tuple(
            Violation(FOUR[3], Kind.RIGHT_ANGLE, (i,), (), f"number {i}") for i in range(min(count, 100))
        )
        report = Report({FOUR[3]: Finding(Verdict.FAILS, count, violations)}, FOUR[3:], 3, 1, {})
        more = [f"      ... and {count - 3} more"] if count > 3 else []
        assert [*lines_of(report)][2:] == [*(f"      number {i}" for i in range(min(count, 3))), *more]

    @pytest.mark.parametrize("rounding", [0, 1, 2])
    def test_shares(self, rounding: int) -> None:
        report = Report({FOUR[3]: Finding(Verdict.FAILS, 2, rounding=rounding)}, FOUR[3:], 3, 1, {})
        tail = ["", ", 1 of them rounding-sized", ", all rounding-sized"][rounding]
        assert [*lines_of(report)][1].endswith(f"fails, 2 found{tail}")
        assert report.severity is (Severity.ROUNDING if rounding == 2 else Severity.WRONG)


@pytest.mark.obligation("V2", "a distance that is read can be given as a bound", method="property-based")
class TestDigits:
    """Three digits, not smaller than the number, and larger by less than one of the last digit."""

    @pytest.mark.parametrize("seed", range(5))
    def test_above(self, seed: int) -> None:
        random = Random(seed)
        for _ in range(100):
            value = random.choice((1.0, 0.999, 123.4)) * 10.0 ** random.randrange(-300, 300) * random.random()
            read = Fraction(digits_above(value))
            assert Fraction(value) <= read < Fraction(value) * Fraction(101, 100)
            assert len(digits_above(value).split("e")[0].replace(".", "").strip("0")) <= 3
        assert (digits_above(0.0), digits_above(0.25), digits_above(1234.5)) == ("0", "0.25", "1.24e+3")

    def test_control_to_nearest(self) -> None:
        """What formatting says of 1.0001: less."""
        assert float(f"{1.0001:.3g}") < 1.0001 <= float(digits_above(1.0001))
