"""A report as text: what fails first, sentences of claims that fail, then what nobody claimed."""

from collections.abc import Iterator
from decimal import ROUND_CEILING, Context, Decimal
from typing import TYPE_CHECKING

from exactmesh.verify.properties import Property, Severity, Verdict

if TYPE_CHECKING:
    from exactmesh.verify.report import Finding, Report

__all__ = ["digits_above", "lines_of", "size_of", "worst_first"]

_MARKS = {Verdict.HOLDS: "+", Verdict.FAILS: "!", Verdict.UNDECIDED: "?"}
_ROUNDING_FAILS = "~"
_UNCLAIMED_FAILS = "-"  # a fact, not a fault
_WIDTH = 16  # of the column of names
_SHOWN = 3  # violations of a property that str(report) prints


def digits_above(value: float) -> str:
    """Return three digits of a number that is not smaller, so that what is read can be given as a bound."""
    return f"{Context(prec=3, rounding=ROUND_CEILING).create_decimal(Decimal(value)):.3g}"


def size_of(report: "Report") -> str:
    """Return how many points and cells there are."""
    quads = f", {report.quad_count} quadrilaterals" if report.quad_count else ""
    return f"{report.point_count} points, {report.triangle_count} triangles{quads}"


def worst_first(report: "Report") -> list[Property]:
    """Return the claims in the order in which they are shown: what fails by something wrong, what by something
    rounding-sized, what is undecided, what holds."""

    def rank(claim: Property) -> int:
        finding = report.findings[claim]
        if finding.verdict is Verdict.HOLDS:
            return 3
        if finding.verdict is Verdict.UNDECIDED:
            return 2
        return int(finding.severity is Severity.ROUNDING)

    return sorted((claim for claim in report.findings if claim in report.claims), key=rank)


def lines_of(report: "Report") -> Iterator[str]:
    """Yield the lines of ``str(report)``."""
    outcome = "every claim holds" if report.ok else "NOT what it claims to be"
    if report.severity is Severity.ROUNDING:
        outcome += ", by rounding-sized violations only"
    yield f"{size_of(report)}: {outcome}"
    yield from (line for property_ in worst_first(report) for line in _lines_of(report, property_))
    others = [property_ for property_ in report.findings if property_ not in report.claims]
    if others:
        yield "  not claimed:"
        yield from (_line(report, property_) for property_ in others)
    for predicate, counts in report.stages.items():
        told = ", ".join(f"{stage.name.lower()} {count}" for stage, count in counts.items() if count)
        yield f"  {predicate}: {told or 'not called'}"


def _lines_of(report: "Report", claim: Property) -> Iterator[str]:
    """Yield the verdict on a claim, and sentences of its first violations."""
    yield _line(report, claim)
    finding = report.findings[claim]
    for violation in finding.violations[:_SHOWN]:
        yield f"      {violation.message}"
    if finding.count > _SHOWN:
        yield f"      ... and {finding.count - _SHOWN} more"


def _line(report: "Report", property_: Property) -> str:
    finding = report.findings[property_]
    mark = _MARKS[finding.verdict]
    if finding.verdict is Verdict.FAILS and property_ not in report.claims:
        mark = _UNCLAIMED_FAILS
    elif finding.verdict is Verdict.FAILS and finding.severity is Severity.ROUNDING:
        mark = _ROUNDING_FAILS
    return f"  {mark} {property_:<{max(_WIDTH, *map(len, report.findings))}} {_summary(finding)}"


def _summary(finding: "Finding") -> str:
    text = finding.verdict.value
    if finding.verdict is Verdict.FAILS:
        text += f", {'at least ' if finding.lower_bound else ''}{finding.count} found"
        if finding.rounding:
            share = "all" if finding.rounding == finding.count else f"{finding.rounding} of them"
            text += f", {share} rounding-sized"
    if finding.distance is not None and finding.verdict is Verdict.HOLDS:
        text += f" within {digits_above(finding.distance)}"
    if finding.because:
        text += f": {' and '.join(finding.because)} would have to hold"
    return f"{text}; {finding.note}" if finding.note else text
