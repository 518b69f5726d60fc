"""Verdicts as tables for a terminal, with the smallest inputs below, ready to copy."""

from collections.abc import Iterator

from rich.console import Console
from rich.table import Table

from exactmesh.conformance.laws import Outcome
from exactmesh.conformance.result import Conformance, Counterexample

__all__ = ["print_result"]

_COLOURS = {
    Outcome.HOLDS: "green",
    Outcome.ROUNDING: "yellow",
    Outcome.REFUSES: "magenta",
    Outcome.WRONG: "red",
    Outcome.HANGS: "bold red",
    Outcome.DIES: "bold red",
}


def print_result(result: Conformance, console: Console) -> None:
    """Print a table of the laws, then each input that breaks some of them, as Python and as a line for the shell."""
    table = Table(title=f"{result.mesher}: {result.task}", title_justify="left")
    table.add_column("law", no_wrap=True)
    table.add_column("verdict", no_wrap=True)
    table.add_column("inputs", justify="right", no_wrap=True)
    table.add_column("what breaks it", overflow="fold")
    for law, ruling in result.rulings.items():
        example = ruling.counterexample
        verdict = f"[{_COLOURS[ruling.outcome]}]{ruling.outcome}[/]"
        table.add_row(str(law), verdict, str(ruling.judged), "" if example is None else example.sentence)
    console.print(table)
    for laws, example in _examples(result):
        _print_raw(console, f"\n# {', '.join(laws)}: {example.sentence}")
        _print_raw(console, example.code)
        _print_raw(console, f"# or: {example.command}")
    unfinished = "" if result.complete else "; the time was up before every family of inputs had its turn (--deadline)"
    restarts = f", {result.restarts} times started again" if result.restarts else ""
    _print_raw(console, f"\n{result.tried} inputs{restarts}{unfinished}")


def _print_raw(console: Console, text: str) -> None:
    """Print as it is, without breaking lines that are to be copied."""
    console.print(text, markup=False, highlight=False, soft_wrap=True)


def _examples(result: Conformance) -> Iterator[tuple[list[str], Counterexample]]:
    """Yield each input once, with the laws that it breaks."""
    seen: dict[bytes, tuple[list[str], Counterexample]] = {}
    for law, ruling in result.rulings.items():
        if ruling.counterexample is not None:
            seen.setdefault(ruling.counterexample.given.key, ([], ruling.counterexample))[0].append(str(law))
    yield from seen.values()
