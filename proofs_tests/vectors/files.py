"""The files: plain text, hexadecimal floats, one case a line."""

from collections.abc import Iterator
from pathlib import Path

from proofs_tests.vectors.families import FAMILIES, cases
from proofs_tests.vectors.predicates import PREDICATES, Case, Predicate, case_of
from proofs_tests.vectors.published import FAMILY, PUBLISHED

__all__ = ["DATA", "read", "text_of"]

DATA = Path(__file__).parent / "data"


def hexadecimal(x: float) -> str:
    """Return the shortest hexadecimal form: C99's, without trailing zeros."""
    sign, x_text = ("-", x.hex()[1:]) if x.hex().startswith("-") else ("", x.hex())
    mantissa, exponent = x_text.split("p")
    mantissa = mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa
    return "0" if x == 0.0 and not sign else f"{sign}{mantissa}p{exponent}"


def line_of(case: Case) -> str:
    """Return the signs and the numbers, one space between."""
    return " ".join([*(str(sign) for sign in case.signs), *(hexadecimal(x) for x in case.values)])


def header(p: Predicate) -> list[str]:
    """Return what a reader needs to know."""
    return [
        f"# {p.name}: hard cases with exact signs. See docs/vectors.md of exactmesh. MIT licence.",
        "# A line holds a case: integers -1, 0 or 1, then doubles as C99 writes them in hexadecimal; spaces between.",
        "# Lines that begin with # are comments; those that begin with ## name the family of the lines that follow.",
        *(f"# {line}" for line in p.meaning),
        f"# columns: {' '.join([*p.signs, *p.columns])}",
    ]


def text_of(p: Predicate) -> str:
    """Return the file of a predicate."""
    lines = header(p)
    for i, (family, make, is_taken, n) in enumerate(FAMILIES):
        start = 1000 * PREDICATES.index(p) + i
        lines += [f"## {family}", *(line_of(case) for case in cases(p, make, is_taken, n, start))]
    if p.name in PUBLISHED:
        lines += [f"## {FAMILY}", *(line_of(case_of(p, values)) for values in PUBLISHED[p.name]())]
    return "\n".join(lines) + "\n"


def read(p: Predicate) -> Iterator[tuple[str, Case]]:
    """Yield (family, case) of the file of a predicate."""
    family = ""
    for line in (DATA / f"{p.name}.txt").read_text(encoding="ascii").splitlines():
        if line.startswith("## "):
            family = line[3:].partition(":")[0]
        elif not line.startswith("#"):
            words = line.split(" ")
            n = len(p.signs)
            yield family, Case(tuple(map(int, words[:n])), tuple(map(float.fromhex, words[n:])))
