"""The command: which mutants, where the results go, and whether enough of them were killed."""

import importlib
import itertools
import random
from pathlib import Path
from typing import Annotated

import typer
from proofs_tests.mutation.campaign import Result, campaign, read_results
from proofs_tests.mutation.covering import Covering
from proofs_tests.mutation.mutants import Mutant, mutants_of, source_files
from proofs_tests.mutation.page import page
from proofs_tests.mutation.survivors import Survivors, described
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

__all__ = ["main"]

BAR = 0.95

#: Imported before the workers fork, once for all mutants.
_LIBRARIES = (
    "numpy",
    "numba",
    "gmpy2",
    "hypothesis",
    "pytest",
    "scipy.spatial",
    "shapely",
    "matplotlib.pyplot",
    "rich",
)


def _run(
    times: Annotated[list[Path], typer.Option(help="what pytest wrote with --junitxml")],
    coverage: Annotated[Path, typer.Option(help="what coverage recorded, combined")] = Path(".coverage"),
    results: Annotated[Path, typer.Option(help="lines of JSON; mutants killed there are not tried again")] = Path(
        "mutants.jsonl"
    ),
    sample: Annotated[
        int | None, typer.Option(help="try so many, drawn by chance from those that are not listed")
    ] = None,
    seed: Annotated[str, typer.Option(help="of the sample")] = "",
    only: Annotated[list[str] | None, typer.Option(help="only files whose path contains one of these")] = None,
    budget: Annotated[float, typer.Option(help="seconds of tests that a mutant is worth")] = 60.0,
    processes: Annotated[int, typer.Option(min=1)] = 2,
    page_file: Annotated[Path | None, typer.Option("--page", help="write the page of docs/ there")] = None,
) -> None:
    """Mutate, test, and tell what survived; exit code 1 below 95 percent, or if a mutant is killed that is listed."""
    mutants = [mutant for file in source_files() if _chosen(file, only) for mutant in mutants_of(file)]
    if sample is not None:
        mutants = _sampled(mutants, sample, seed)
    earlier = read_results(results)
    found = {mutant: earlier[mutant] for mutant in mutants if mutant in earlier and not earlier[mutant].alive}
    for library in _LIBRARIES:
        importlib.import_module(library)
    covering = Covering.recorded(coverage, times, source_files())
    columns = (
        TextColumn("mutants"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.description}"),
        TimeRemainingColumn(),
    )
    with Progress(*columns) as progress, results.open("a", encoding="utf-8") as lines:
        alive = sum(result.alive for result in found.values())
        task = progress.add_task(f"{alive} alive", total=len(mutants), completed=len(found))
        for result in campaign([mutant for mutant in mutants if mutant not in found], covering, budget, processes):
            found[result.mutant] = result
            print(result.line(), file=lines, flush=True)
            alive += result.alive
            progress.update(task, advance=1, description=f"{alive} alive")
    _tell(list(found.values()), page_file)


def _chosen(file: str, parts: list[str] | None) -> bool:
    return not parts or any(part in file for part in parts)


def _sampled(mutants: list[Mutant], count: int, seed: str) -> list[Mutant]:
    """Draw so many mutants that are not known to be equivalent."""
    known = Survivors.listed().reasons
    drawn = random.Random(seed).sample(mutants, len(mutants))
    return list(itertools.islice((mutant for mutant in drawn if described(mutant) not in known), count))


def _tell(results: list[Result], page_file: Path | None) -> None:
    """Print the score and what survived; leave with exit code 1 below the bar, or where a listed reason is wrong."""
    survivors = Survivors.listed()
    if page_file is not None:
        page_file.write_text(page(results, survivors), encoding="utf-8")
    alive = [result for result in results if result.alive]
    unexplained = survivors.unexplained(results)
    for result in unexplained:
        print(f"{result.outcome}: {result.mutant.file}:{result.mutant.line} {described(result.mutant)}")
    refuted = survivors.refuted(results)
    for result in refuted:
        print(f"listed, but {result.outcome} by {result.test}: {described(result.mutant)}")
    explained = len(alive) - len(unexplained)
    print(f"{len(results)} mutants: {len(results) - len(alive)} killed, {explained} known to be equivalent, ", end="")
    print(f"{len(unexplained)} survived")
    score = 1.0 - len(unexplained) / max(len(results) - explained, 1)
    print(f"score {score:.1%}; the bar is {BAR:.0%}")
    raise typer.Exit(score < BAR or bool(refuted))


def main() -> None:
    """Run the command."""
    typer.run(_run)
