"""docs/obligations.md: the summary, then each obligation with its classes, their figures and their controls."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from proofs_tests.obligations.markers import Obligation
from proofs_tests.obligations.measured import Measured
from proofs_tests.obligations.statements import CORE, FAMILIES, STATEMENTS, family

__all__ = ["page"]

HEAD = """\
# Obligations

What exactmesh claims, and how each claim is held: a theorem a line, then the test classes that show it.

- *calculus*, *Gappa and Coq*, *symbolic* and *exhaustive* are proofs: for all numbers, for all inputs of a small number
  format or for all states. *enumeration* is every case of small sizes; *ablation* takes conditions out one by one,
  *mutation* puts faults in; everything else is a test on the cases that are counted.
- A *case* is what a test counts for itself, an example of hypothesis, or a test. *CPU s* is processor time of the
  compiled lane, with the machine code in the cache; *passed* is said of that run, *skipped* of
  tests that only the other, interpreted lane can run, or that need a package which was not there.
- The *faults* are negative controls: each is seeded by a test, and the same check must refuse it.

Made from the markers of the tests by `python -m proofs_tests.obligations > docs/obligations.md`; the figures by
`pytest --record-obligations=proofs_tests/obligations.json`.
"""


def page(obligations: Sequence[Obligation], measured: Mapping[str, Measured]) -> str:
    """Return the page, in Markdown."""
    core = [identifier for identifier in STATEMENTS if family(identifier) in CORE]
    rest = [identifier for identifier in STATEMENTS if family(identifier) not in CORE]
    lines = [HEAD, *_summary(core, obligations, measured), "", "What stands on these:", ""]
    lines += _summary(rest, obligations, measured)
    for letters, title in FAMILIES.items():
        lines += ["", f"## {letters}: {title}"]
        for identifier, statement in STATEMENTS.items():
            if family(identifier) == letters:
                own = [o for o in obligations if o.id == identifier]
                lines += ["", f"### {identifier}", "", f"{_sentence(statement)}", *_details(own, measured)]
    return "\n".join(lines) + "\n"


def _summary(
    identifiers: Iterable[str], obligations: Sequence[Obligation], measured: Mapping[str, Measured]
) -> Iterator[str]:
    yield "| | statement | methods | cases | CPU s | faults | status |"
    yield "|---|---|---|---:|---:|---:|---|"
    for identifier in identifiers:
        own = [o for o in obligations if o.id == identifier]
        figures = [measured[o.place] for o in own if o.place in measured]
        methods = ", ".join(dict.fromkeys(o.method for o in sorted(own, key=_strength)))
        seconds = _seconds(sum(f.seconds for f in figures)) if figures else ""
        cases = f"{sum(f.cases for f in figures):,}" if figures else ""
        faults = len({control for o in own for control in o.controls})  # classes may share some
        link = f"[{identifier}](#{identifier.lower()})"
        cells = (link, STATEMENTS[identifier], methods, cases, seconds, str(faults or ""), _status(own, measured))
        yield f"| {' | '.join(cells)} |"


def _strength(obligation: Obligation) -> int:
    return list(type(obligation.method)).index(obligation.method)


def _status(own: Sequence[Obligation], measured: Mapping[str, Measured]) -> str:
    if not own:
        return "**open**"
    missing = [o for o in own if o.place not in measured]
    skipped = sum(measured[o.place].skipped for o in own if o.place in measured)
    if missing:
        return f"{len(own) - len(missing)} of {len(own)} classes measured"
    return f"passed; {skipped} skipped" if skipped else "passed"


def _details(own: Sequence[Obligation], measured: Mapping[str, Measured]) -> Iterator[str]:
    if not own:
        return
    yield ""
    yield "| what a class shows | method | cases | CPU s | faults that it refuses |"
    yield "|---|---|---:|---:|---|"
    for o in sorted(own, key=_strength):
        figures = measured.get(o.place)
        name = o.place.rpartition("::")[2]
        cells = (
            f"{o.statement} <br> `{o.file.removeprefix('proofs_tests/')}` {name}",
            o.method,
            f"{figures.cases:,}" if figures else "",
            _seconds(figures.seconds) if figures else "",
            "; ".join(control.fault for control in o.controls),
        )
        yield f"| {' | '.join(cells)} |"


def _sentence(statement: str) -> str:
    return statement[0].upper() + statement[1:] + "."


def _seconds(seconds: float) -> str:
    if seconds < 1:
        return "< 1"
    return f"{seconds:.0f}" if seconds >= 10 else f"{seconds:.1f}"
