"""``python -m proofs_tests.fuzzing [TARGET ...] --minutes M``."""

import os

os.environ["NUMBA_DISABLE_JIT"] = "1"  # the lines of compiled functions cannot be watched

from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from proofs_tests.fuzzing.campaign import Campaign, Outcome, require_atheris
from proofs_tests.fuzzing.judging import Target
from proofs_tests.fuzzing.targets import TARGETS, target_named
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeRemainingColumn
from rich.table import Table

from exactmesh.errors import ExactMeshError


def shown(outcomes: list[Outcome]) -> Table:
    """Return the outcomes as a table."""
    table = Table("target", "executions", "per second", "edges", "corpus", "findings")
    for one in outcomes:
        rate = f"{one.executions / max(one.seconds, 1):.0f}"
        row = [str(one.executions), rate, str(one.edges), str(one.corpus), str(len(one.findings))]
        table.add_row(one.target, *row)
    return table


def _tick(progress: Progress, task: TaskID, before: float, over: float) -> None:
    progress.update(task, completed=before + over)


def run(chosen: list[Target], seconds: float, folder: Path, console: Console) -> list[Outcome]:
    """Fuzz the targets one after another, each for so long."""
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.fields[found]} found"),
        TimeRemainingColumn(),
    )
    outcomes: list[Outcome] = []
    with Progress(*columns, console=console) as progress, Campaign(folder) as campaign:
        task = progress.add_task("", total=seconds * len(chosen), found=0)
        for turn, target in enumerate(chosen):
            progress.update(task, description=target.name)
            tick = partial(_tick, progress, task, turn * seconds)
            outcome = campaign.fuzzed(target, seconds, tick)
            outcomes.append(outcome)
            progress.update(task, found=sum(len(one.findings) for one in outcomes))
            if not console.is_terminal:
                told = f"{outcome.executions} executions, {outcome.edges} edges, {len(outcome.findings)} findings"
                console.print(f"{outcome.target}: {told}")
    return outcomes


def main(
    targets: Annotated[
        list[str] | None, typer.Argument(metavar="[TARGET ...]", help=f"Some of {', '.join(TARGETS)}.")
    ] = None,
    minutes: Annotated[float, typer.Option(min=0.05, help="For all targets together, one after another.")] = 5.0,
    folder: Annotated[Path, typer.Option(help="Where findings go, and inputs that reached new lines.")] = Path(
        ".fuzzing"
    ),
) -> None:
    """Look for inputs that break the law of the readers: a right result, or a typed error. Exit code 1 if there are."""
    console = Console()
    try:
        require_atheris()
        chosen = [target_named(name) for name in targets or TARGETS]
    except ExactMeshError as error:
        console.print(str(error), markup=False, soft_wrap=True)
        raise typer.Exit(2) from None
    folder.mkdir(parents=True, exist_ok=True)
    outcomes = run(chosen, 60.0 * minutes / len(chosen), folder, console)
    console.print(shown(outcomes))
    found = [path for outcome in outcomes for path in outcome.findings]
    for path in found:
        console.print(f"{path}: {path.with_suffix('.txt').read_text(encoding='utf-8')}", markup=False, soft_wrap=True)
    raise typer.Exit(1 if found else 0)


if __name__ == "__main__":
    typer.run(main)
