"""Gappa scripts with a head that says what each proves of which code: read, checked against the source, and run.

The head is made of comments:

    # code: module.function              a function that the script models, and
    #   | left = (ax - cx) * (by - cy)   lines of it, which must be in its source
    # constant: 0x1p509 = module.NAME    a number of the script, and the expression of the code that it stands for;
    #                                    operands are module.NAME, or numbers such as 2^-1075, with * and / between
    # exponent: -537 = module.NAME       the same for an integer whose power of two it is
    # control, the fault: old => new     a change of the text after which the statement must not be provable any more
"""

import importlib
import inspect
import re
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

__all__ = [
    "STANDARD_AXIOMS", "Control", "Script", "axioms_of", "certificate", "is_proved", "prints_of", "scripts",
    "source_of", "value_of",
]  # fmt: skip

FOLDER = Path(__file__).resolve().parent / "gappa"

#: What Coq's own theory of the real numbers assumes (and Flocq with it); nothing else may be assumed.
STANDARD_AXIOMS = frozenset(
    {
        "ClassicalDedekindReals.sig_forall_dec",
        "ClassicalDedekindReals.sig_not_dec",
        "FunctionalExtensionality.functional_extensionality_dep",
        "Classical_Prop.classic",
    }
)

REFUSALS = ("some properties were not satisfied", "no contradiction was found")

#: Gappa leaves the identities of hints for its user to prove; each is a ring or field identity.
REWRITING = "Proof. intros; unfold Float1 in *; first [ring | solve [field] | field; tauto]. Qed."


@dataclass(frozen=True)
class Control:
    """A fault: the text that is changed in a script."""

    fault: str
    old: str
    new: str


@dataclass(frozen=True)
class Script:
    """One script.

    Attributes:
        name: without the suffix.
        text: all of it.
        body: without the head.
        code: (qualified name of a function, a line of it).
        constants: (number in the body, its value, the expression of the code).
        controls: the faults.
    """

    name: str
    text: str
    body: str
    code: tuple[tuple[str, str], ...]
    constants: tuple[tuple[str, Fraction, str], ...]
    controls: tuple[Control, ...]

    def spoiled(self, control: Control) -> str:
        """Return the body with the fault.

        Raises:
            LookupError: the text that the control changes is not there.
        """
        if control.old not in self.body:
            raise LookupError(f"{self.name}.g no longer contains {control.old!r}: renew the control")
        return self.body.replace(control.old, control.new)


def number(text: str) -> Fraction:
    """Return the value of a number as Gappa writes it: 3, -7, 0x1.8p-52, 1b-53; or 2^-1075."""
    if match := re.fullmatch(r"(-?\d+)b(-?\d+)", text):
        return int(match[1]) * Fraction(2) ** int(match[2])
    if match := re.fullmatch(r"2\^(-?\d+)", text):
        return Fraction(2) ** int(match[1])
    if text.startswith("0x"):
        digits, _, exponent = text[2:].partition("p")
        whole, _, part = digits.partition(".")
        return int(whole + part, 16) * Fraction(2) ** (int(exponent or 0) - 4 * len(part))
    return Fraction(text)


def value_of(expression: str) -> Fraction:
    """Return the value of a product or quotient of constants of the code and numbers."""
    value, divide = Fraction(1), False
    for token in expression.split():
        if token in "*/":
            divide = token == "/"
            continue
        operand = shipped(token) if re.match(r"[a-z_]", token) else number(token)
        value = value / operand if divide else value * operand
    return value


def resolved(qualified: str) -> object:
    """Return what module.name is."""
    module, _, name = qualified.rpartition(".")
    return getattr(importlib.import_module(module), name)


def shipped(qualified: str) -> Fraction:
    """Return the exact value of a constant of the code."""
    value = resolved(qualified)
    if not isinstance(value, float):
        raise TypeError(f"{qualified} is no double")
    return Fraction(value)


def source_of(qualified: str) -> str:
    """Return the source of a function with single spaces."""
    function = resolved(qualified)
    original: Callable[..., object] = getattr(function, "py_func", function)  # type: ignore[arg-type]  # a function
    return " ".join(inspect.getsource(original).split())


def _script(path: Path) -> Script:
    text = path.read_text(encoding="utf-8")
    head = [line[1:] for line in text.splitlines() if line.startswith("# ")]
    body = "".join(line + "\n" for line in text.splitlines() if not line.startswith("# "))
    code, constants, controls, function = [], [], [], ""
    for indented in head:
        line = indented.strip()
        if line.startswith("code:"):
            function = line.partition(":")[2].strip()
        elif indented.startswith("   | "):
            code.append((function, " ".join(line[1:].split())))
        elif line.startswith(("constant:", "exponent:")):
            kind, _, rest = line.partition(":")
            written, _, expression = (part.strip() for part in rest.partition(" = "))
            value = number(written) if kind == "constant" else Fraction(2) ** int(written)
            constants.append((written, value, expression))
        elif line.startswith("control,"):
            fault, _, change = line.removeprefix("control,").partition(":")
            old, arrow, new = change.partition("=>")
            if not arrow:
                raise ValueError(f"{path.name}: a control without =>")
            controls.append(Control(fault.strip(), old.strip(), new.strip()))
    return Script(path.stem, text, body, tuple(code), tuple(constants), tuple(controls))


def scripts() -> list[Script]:
    """Return all scripts by name."""
    return [_script(path) for path in sorted(FOLDER.glob("*.g"))]


def is_proved(body: str) -> bool:
    """Tell whether Gappa proves the statement; what it cannot read is an error, not a refusal.

    Raises:
        SyntaxError: Gappa does not understand the script.
    """
    run = subprocess.run(["gappa"], input=body, capture_output=True, text=True, check=False)
    if run.returncode != 0 and not any(refusal in run.stderr for refusal in REFUSALS):
        raise SyntaxError(run.stderr)
    return run.returncode == 0


def certificate(body: str) -> tuple[str, str]:
    """Return the proof for Coq, the identities of hints as lemmas, and the name of its theorem.

    Raises:
        ValueError: a hypothesis is left. Where its section ends, it becomes a premise: nothing that Print Assumptions
            tells.
    """
    run = subprocess.run(["gappa", "-Bcoq"], input=body, capture_output=True, text=True, check=True)
    proof = re.sub(r"^Hypothesis (a\d+ : .*)$", rf"Lemma \1\n{REWRITING}", run.stdout, flags=re.MULTILINE)
    if re.search(r"\b(?:Hypothes[ie]s|Axioms?|Parameters?|Conjecture|Admitted)\b", proof):
        raise ValueError("the certificate assumes what it does not prove")
    theorem = re.findall(r"^(?:Lemma|Theorem) (\w+) :", proof, flags=re.MULTILINE)[-1]
    return "Require Import Reals.\n" + proof, theorem


def prints_of(proof: str, theorem: str, folder: Path) -> str:
    """Return what Coq says after it has checked the proof: what the theorem assumes.

    Raises:
        CalledProcessError: Coq refuses the proof.
    """
    path = folder / "certificate.v"
    path.write_text(f"{proof}\nPrint Assumptions {theorem}.\n", encoding="utf-8")
    return subprocess.run(
        ["coqc", "-q", path.name], cwd=folder, capture_output=True, text=True, check=True
    ).stdout  # fmt: skip


def axioms_of(prints: str) -> set[str]:
    """Return the names of what a theorem assumes, from what Coq prints about it."""
    if "Closed under the global context" in prints:
        return set()
    listed = prints.partition("Axioms:")[2]
    return set(re.findall(r"^([\w.]+) *:", listed, flags=re.MULTILINE))
