"""K7 on the committed hard cases: every predicate has the exact sign on each; what is wrong elsewhere is counted."""

from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from proofs_tests.kernel import oracle as kernel_oracle
from proofs_tests.recording import Record
from proofs_tests.vectors import careless
from proofs_tests.vectors.answers import (
    ADAPTIVE,
    BATCH,
    BY_NAME,
    NAMES,
    SCALAR,
    arguments,
    by_definition,
    cases_of,
    in_loops,
    points_of,
    scalar,
    wanted,
)
from proofs_tests.vectors.families import FAMILIES
from proofs_tests.vectors.files import DATA, read, text_of
from proofs_tests.vectors.predicates import Case

import exactkernel as ek
from exactkernel import bisector
from exactkernel.constants import INCIRCLE_BOUND, ORIENT2D_BOUND
from exactkernel.context import Context, guarded_context, make_context, scaled_into_window
from exactkernel.incircle import incircle_perturbed_adaptive


def disagreements(name: str, answers: Callable[[Case], set[int]]) -> int:
    """How many cases are answered otherwise than by the sign of the file alone."""
    return sum(answers(case) != {wanted(name, case)} for _, case in cases_of(name))


@pytest.mark.obligation(
    "K7", "every predicate, in every form, has the exact sign on 1,000 committed hard cases", method="named cases"
)
class TestHardCases:
    """Scalar, batch, in loops of any context: the answer is the sign of the file, and that is the sign in fractions."""

    @pytest.mark.parametrize("name", SCALAR)
    def test_scalar(self, name: str, record_property: Record) -> None:
        record_property("cases", len(cases_of(name)))
        assert disagreements(name, lambda case: {scalar(name, case)}) == 0

    @pytest.mark.parametrize("name", NAMES)
    def test_loops(self, name: str, record_property: Record) -> None:
        record_property("cases", len(cases_of(name)))
        assert disagreements(name, lambda case: set(in_loops(name, case))) == 0

    @pytest.mark.parametrize("name", BATCH)
    def test_batch(self, name: str, record_property: Record) -> None:
        """All at once, which no window holds, and each family by itself, which some window may."""
        record_property("cases", len(cases_of(name)))
        families = {family for family, _ in cases_of(name)}
        for chosen in (families, *({family} for family in families)):
            cases = [case for family, case in cases_of(name) if family in chosen]
            columns = np.array([case.values for case in cases]).reshape(len(cases), -1, 2)
            signs = BATCH[name](*(columns[:, i] for i in range(columns.shape[1])))
            assert signs.tolist() == [case.signs[0] for case in cases]

    def test_perturbed(self, record_property: Record) -> None:
        record_property("cases", len(cases_of("incircle")))
        for _, case in cases_of("incircle"):
            points = points_of(BY_NAME["incircle"], case.values)
            assert ek.incircle_perturbed(*points) == case.signs[1]
            assert incircle_perturbed_adaptive(make_context(np.array(points)), *case.values) == case.signs[1]
            assert kernel_oracle.incircle_perturbed(*points) == case.signs[1]

    @pytest.mark.parametrize("name", NAMES)
    def test_the_files_are_right(self, name: str) -> None:
        """The script computes in integers; here the definitions in fractions. They share nothing but the comparison of
        angles with bounds, on which the second opinion is the library's, above."""
        assert disagreements(name, lambda case: {by_definition(name, case)}) == 0

    @pytest.mark.parametrize("name", NAMES)
    def test_the_script_makes_the_files(self, name: str) -> None:
        assert (DATA / f"{name}.txt").read_bytes() == text_of(BY_NAME[name]).encode("ascii")

    def test_control_a_wrong_sign_in_a_file_is_noticed(self) -> None:
        """One sign of a file is turned round."""
        _, case = cases_of("orient2d")[500]
        turned = Case((-case.signs[0] or 1,), case.values)
        assert scalar("orient2d", turned) != wanted("orient2d", turned) != by_definition("orient2d", turned)

    def test_control_a_wrong_bit_in_a_file_is_noticed(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        """One digit of a coordinate is another."""
        text = (DATA / "length.txt").read_text(encoding="ascii")
        start, _, rest = text.rpartition(".")
        changed = f"{start}.{'f' if rest[0] != 'f' else 'e'}{rest[1:]}"
        (tmp_path / "length.txt").write_text(changed, encoding="ascii")
        monkeypatch.setattr("proofs_tests.vectors.files.DATA", tmp_path)
        assert [case for _, case in read(BY_NAME["length"])] != [case for _, case in cases_of("length")]


def stages_of(name: str, context: Callable[[Case], Context]) -> Counter[int]:
    """How many cases each stage decides; what takes several calls counts for the last stage."""
    tally: Counter[int] = Counter()
    for _, case in cases_of(name):
        k = context(case)
        bounds, numbers = arguments(name, case)
        ADAPTIVE[name](k, *bounds, *numbers)
        tally[int(np.flatnonzero(k.counts.sum(axis=0))[-1])] += 1
    return tally


class Witness:
    """Tells which stages of the bisector predicates, which keep no tally, were entered."""

    STAGES = (
        (ek.Stage.DOUBLE_DOUBLE, ("lift_double_double", "products_difference", "_inner")),
        (ek.Stage.EXPANSION, ("expansion_sign",)),
        (ek.Stage.RATIONAL, ("nearer_from_doubles", "along_from_doubles", "crossing_order_from_doubles")),
    )

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.seen = ek.Stage.FILTER
        exact = bisector._crossing_order_exact
        monkeypatch.setattr(bisector, "_crossing_order_exact", getattr(exact, "py_func", exact))
        for stage, names in self.STAGES:
            for name in names:
                monkeypatch.setattr(bisector, name, self.watched(stage, getattr(bisector, name)))

    def watched(self, stage: ek.Stage, function: Callable[..., int]) -> Callable[..., int]:
        def call(*arguments: object) -> int:
            self.seen = max(self.seen, stage)
            answer = function(*arguments)
            if function.__name__ == "products_difference":
                self.seen = ek.Stage(answer >> 2)
            return answer

        return call

    def stage(self, name: str, case: Case) -> ek.Stage:
        self.seen = ek.Stage.FILTER
        function = ADAPTIVE[name]
        coordinates = np.array(case.values).reshape(-1, 2)
        scaled, k = scaled_into_window(coordinates)
        getattr(function, "py_func", function)(k, *scaled.ravel().tolist())
        return self.seen


@pytest.mark.obligation(
    "K7",
    "the hard cases are hard: zeros, and each stage decides many of them",
    method="named cases",
    control_in="TestCareless",
)
class TestHardness:
    """At least 1,000 different cases a predicate; a tenth exact zeros; each stage decides some that no earlier can."""

    @pytest.mark.parametrize("name", NAMES)
    def test_families(self, name: str) -> None:
        cases = [case for family, case in cases_of(name) if family != "published"]
        assert len({case.values for case in cases}) >= 1000
        zeros = sum(case.signs[0] == 0 for case in cases)
        assert zeros >= 100
        assert min(Counter(case.signs[0] for case in cases).values()) >= 100
        found = Counter(family for family, _ in cases_of(name))
        assert {family.partition(":")[0]: n for family, _, _, n in FAMILIES}.items() <= found.items()

    def test_size(self) -> None:
        assert sum(path.stat().st_size for path in DATA.iterdir()) < 1_500_000
        assert {path.stem for path in DATA.iterdir()} == set(NAMES)

    @pytest.mark.parametrize("name", [name for name in NAMES if name not in ("nearer", "along", "crossing_order")])
    def test_stages(self, name: str) -> None:
        guarded = stages_of(name, lambda _case: guarded_context())
        for stage in (ek.Stage.FILTER, ek.Stage.DOUBLE_DOUBLE, ek.Stage.EXPANSION, ek.Stage.RATIONAL):
            assert guarded[stage] >= 90
        windowed = stages_of(name, lambda case: make_context(np.array(arguments(name, case)[1])))
        assert windowed[ek.Stage.GRID] >= (0 if name == "length" else 7)  # lengths have no such stage

    @pytest.mark.parametrize("name", ["nearer", "along", "crossing_order"])
    def test_stages_of_bisectors(self, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
        witness = Witness(monkeypatch)
        tally = Counter(witness.stage(name, case) for _, case in cases_of(name))
        for stage in (ek.Stage.FILTER, ek.Stage.DOUBLE_DOUBLE, ek.Stage.EXPANSION, ek.Stage.RATIONAL):
            assert tally[stage] >= 30

    def test_ties_are_broken(self) -> None:
        signs = Counter(case.signs for _, case in cases_of("incircle") if case.signs[0] == 0)
        assert min(signs[0, sign] for sign in (-1, 0, 1)) >= 50


#: How many cases the formula in doubles answers wrongly, and of how many a filter without a guard certifies the wrong
#: sign.
WRONG = {
    "orient2d": (606, 50),
    "diametral": (476, 50),
    "incircle": (449, 52),
    "nearer": (460, 52),
    "along": (468, 50),
    "crossing_order": (486, 50),
    "angle_below": (468, 54),
    "angle_above": (538, 53),
    "area": (639, 50),
    "length": (501, 55),
}


@pytest.mark.obligation("K7", "careless implementations are wrong on stated numbers of them", method="named cases")
class TestCareless:
    """The naive formulas and the unguarded filters fail on as many cases as docs/vectors.md says."""

    @pytest.mark.parametrize("name", NAMES)
    def test_control_the_naive_formula(self, name: str) -> None:
        """The sign of the determinant in doubles is believed."""
        wrong = sum(careless.naive_sign(name, case.values) != case.signs[0] for _, case in cases_of(name))
        assert wrong == WRONG[name][0]

    @pytest.mark.parametrize("name", NAMES)
    def test_control_the_unguarded_filter(self, name: str) -> None:
        """Shewchuk's first stage without a guard against underflow and overflow."""
        wrong = sum(careless.filter_sign(name, case.values) not in (0, case.signs[0]) for _, case in cases_of(name))
        assert wrong == WRONG[name][1]

    @pytest.mark.parametrize("name", ["orient2d", "diametral", "incircle", "nearer", "along", "crossing_order"])
    def test_control_the_shipped_stages_without_their_window(self, name: str) -> None:
        """The library's own filter, double-double and expansions, told that every input is inside the window."""
        wrong = 0
        for family, case in cases_of(name):
            if family in ("underflow", "certified", "subnormal"):
                k = guarded_context()._replace(orient2d_bound=ORIENT2D_BOUND, incircle_bound=INCIRCLE_BOUND)
                wrong += ADAPTIVE[name](k, *case.values) != case.signs[0]
        assert wrong >= 100

    def test_the_page_says_the_same(self) -> None:
        page = (DATA.parents[2] / "docs" / "vectors.md").read_text(encoding="utf-8")
        for name, (naive, certified) in WRONG.items():
            assert f"| `{name}` | {len(cases_of(name)):,} | {naive} | {certified} |" in page
