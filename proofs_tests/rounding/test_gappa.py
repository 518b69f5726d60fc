"""K2: every bound that decides a sign in doubles, proved by Gappa, its certificates checked by Coq."""

import os
import shutil
from collections.abc import Callable, Iterable
from pathlib import Path

import pytest
from proofs_tests.rounding.elsewhere import NOTHING_TO_PROVE, PROVED
from proofs_tests.rounding.inventory import Line, lines_with_bounds
from proofs_tests.rounding.scripts import (
    STANDARD_AXIOMS,
    Control,
    Script,
    axioms_of,
    certificate,
    is_proved,
    prints_of,
    scripts,
    source_of,
    value_of,
)

pytestmark = pytest.mark.once  # the provers read sources

SCRIPTS = scripts()
NAMES = [script.name for script in SCRIPTS]
CONTROLS = [(script, control) for script in SCRIPTS for control in script.controls]

CITED = {cited for script in SCRIPTS for cited in script.code}
#: An empty line stands for all of a function's.
LISTED = {
    (function, line)
    for listed in (PROVED, NOTHING_TO_PROVE)
    for functions in listed.values()
    for function, lines in functions.items()
    for line in lines or ("",)
}
LINES = lines_with_bounds()

REQUIRED = os.environ.get("EXACTMESH_REQUIRE_PROVERS") == "1"
INSTALL = "apt-get install gappa libcoq-gappa libcoq-flocq coq"


def need(tool: str) -> None:
    """Skip where a prover is missing; fail where EXACTMESH_REQUIRE_PROVERS=1 says that it must not be."""
    if shutil.which(tool):
        return
    reason = f"{tool} is not installed: {INSTALL}"
    if REQUIRED:
        pytest.fail(reason)
    pytest.skip(reason)


@pytest.mark.obligation("K2", "the bounds that Gappa proves are those of the code", method="named cases")
class TestHeads:
    """Each number of a script equals the constant of the code that its head names, and each line it models is there.

    So a changed constant or formula fails here, before any prover runs.
    """

    @pytest.mark.parametrize("script", SCRIPTS, ids=NAMES)
    def test_constants(self, script: Script) -> None:
        for written, value, expression in script.constants:
            assert value == value_of(expression), f"{script.name}.g: {written} is not {expression}"
            assert written in script.body, f"{script.name}.g does not use {written}"

    @pytest.mark.parametrize("script", SCRIPTS, ids=NAMES)
    def test_lines(self, script: Script) -> None:
        assert script.code
        for function, line in script.code:
            assert line in source_of(function), f"{script.name}.g models what {function} is no longer"

    @staticmethod
    def uncovered(known: Iterable[tuple[str, str]]) -> list[Line]:
        """The lines with a bound that nothing known proves."""
        lines: dict[str, list[str]] = {}
        for function, line in known:
            lines.setdefault(function, []).append(line)
        return [x for x in LINES if not any(not line or x.is_in(line) for line in lines.get(x.function, []))]

    def test_every_bound_is_covered(self) -> None:
        assert self.uncovered(CITED | LISTED) == [], "bounds that nothing proves"

    def test_every_entry_is_needed(self) -> None:
        uncited = self.uncovered(CITED)
        for function, line in LISTED:
            assert any(x.function == function and (not line or x.is_in(line)) for x in uncited), (function, line)

    @pytest.mark.parametrize("place", PROVED)
    def test_the_classes_that_prove_are_there(self, place: str) -> None:
        file, _, name = place.partition("::")
        text = (Path(__file__).resolve().parents[1] / file).read_text(encoding="utf-8")
        assert f"\nclass {name}" in text

    def test_control_another_constant_is_noticed(self) -> None:
        """A constant that differs in the last bit from the one of the script."""
        script = next(s for s in SCRIPTS if s.name == "orient2d_filter")
        ((_, value, expression),) = script.constants
        assert value != value_of(f"{expression} * 0x1.0000000000001p0")

    def test_control_another_formula_is_noticed(self) -> None:
        """A line with a sign changed."""
        function, line = next(s for s in SCRIPTS if s.name == "orient2d_window").code[0]
        assert line in source_of(function)
        assert line.replace("ax - cx", "ax + cx") not in source_of(function)

    def test_control_a_bound_without_a_proof_is_noticed(self) -> None:
        """The inventory, with one script taken away, and with one line of another one."""
        without = {c for script in SCRIPTS if script.name != "grade" for c in script.code}
        assert {x.function for x in self.uncovered(without | LISTED)} == {"exactmesh.verify.grading.grade"}
        line = "if abs(high) < _SMALLEST_PRODUCT:"
        left = self.uncovered({c for c in CITED if c[1] != line} | LISTED)
        assert [(x.function, x.text) for x in left] == [("exactkernel.crossing._coordinate", line[3:-1])]


@pytest.mark.obligation(
    "K2", "the filter bounds, the windows, the grid stages, the double-doubles", method="Gappa and Coq"
)
class TestProofs:
    """Gappa proves the statement of each script; Coq checks the certificate, and all that it assumes are the axioms of
    its own real numbers: the identities that Gappa takes from a script as hints are proved, too."""

    @pytest.mark.parametrize("script", SCRIPTS, ids=NAMES)
    def test_gappa(self, script: Script) -> None:
        need("gappa")
        assert is_proved(script.body)

    @pytest.mark.parametrize("script", SCRIPTS, ids=NAMES)
    def test_coq(self, script: Script, tmp_path: Path) -> None:
        need("gappa")
        need("coqc")
        assert axioms_of(prints_of(*certificate(script.body), tmp_path)) <= STANDARD_AXIOMS

    @pytest.mark.parametrize(("script", "control"), CONTROLS, ids=[f"{s.name}, {c.fault}" for s, c in CONTROLS])
    def test_control_a_fault_is_refused(self, script: Script, control: Control) -> None:
        """A smaller constant, or a guard left out, in each script: Gappa refuses it."""
        need("gappa")
        assert not is_proved(script.spoiled(control))

    def test_control_every_script_has_one(self) -> None:
        """A script without a control."""
        assert all(script.controls for script in SCRIPTS)

    def test_control_a_false_hint_is_refused_by_coq(self, tmp_path: Path) -> None:
        """A hint that is no identity: Gappa believes it, Coq does not."""
        need("gappa")
        need("coqc")
        false = "{ x in [0, 1] -> x * x - y in [0, 1] }\nx * x - y -> x * x;"
        proof, theorem = certificate(false)
        with pytest.raises(Exception, match="coqc"):
            prints_of(proof, theorem, tmp_path)

    def test_control_a_hypothesis_that_is_left_is_noticed(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """A hint that is not turned into a lemma: where the section ends, it is a premise of the theorem."""
        need("gappa")
        body = next(s.body for s in SCRIPTS if s.name == "nearest_certain")
        monkeypatch.setattr("proofs_tests.rounding.scripts.re.sub", lambda _pattern, _new, text, **_: text)
        with pytest.raises(ValueError, match="assumes"):
            certificate(body)

    def test_control_an_assumption_is_noticed(self, tmp_path: Path) -> None:
        """A theorem that rests on an axiom of its own."""
        need("coqc")
        proof = "Axiom easy : 1 = 2.\nLemma wrong : 1 = 2. Proof. exact easy. Qed."
        assert not axioms_of(prints_of(proof, "wrong", tmp_path)) <= STANDARD_AXIOMS


@pytest.mark.obligation(
    "K2", "a prover that is missing skips with a reason, or fails where it is required", method="named cases"
)
class TestMissingProvers:
    """Without Gappa or Coq the proofs are skipped and say how to install them; under EXACTMESH_REQUIRE_PROVERS=1 they
    fail."""

    @pytest.fixture
    def nothing(self, monkeypatch: pytest.MonkeyPatch) -> Callable[[bool], None]:
        def required(is_required: bool) -> None:
            monkeypatch.setenv("PATH", "/nonexistent")
            monkeypatch.setattr(f"{__name__}.REQUIRED", is_required)

        return required

    def test_skip(self, nothing: Callable[[bool], None]) -> None:
        nothing(False)
        with pytest.raises(pytest.skip.Exception, match="apt-get install gappa"):
            need("gappa")

    def test_control_required(self, nothing: Callable[[bool], None]) -> None:
        """A prover that is required, and missing."""
        nothing(True)
        with pytest.raises(pytest.fail.Exception, match="apt-get install gappa"):
            need("gappa")
