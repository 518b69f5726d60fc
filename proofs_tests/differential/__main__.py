"""``python -m proofs_tests.differential --inputs N [--seed S] [--processes P]``."""

import time
from collections import Counter
from typing import Annotated

import typer
from proofs_tests.differential.families import FAMILIES
from proofs_tests.differential.reducing import code_of
from proofs_tests.differential.running import Disagreement, Portion, portions, smallest
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

_EVERY = 300.0  # seconds, where there is no terminal to draw a bar on


def shown(inputs: Counter[str], found: list[Disagreement]) -> Table:
    """Return the numbers by family."""
    by_family = Counter(one.family for one in found)
    table = Table("family", "inputs", "disagreements")
    for family in FAMILIES:
        table.add_row(family, f"{inputs[family]:,}", str(by_family[family]))
    table.add_section()
    table.add_row("all", f"{inputs.total():,}", str(len(found)))
    return table


def collected(seed: int, inputs: int, processes: int, console: Console) -> Portion:
    """Compare the inputs; an interrupt ends it with what there is."""
    whole, told = Portion(), time.monotonic()
    columns = (
        TextColumn("{task.fields[found]} disagreements"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, disable=not console.is_terminal) as progress:
        task = progress.add_task("", total=inputs, found=0)
        try:
            for portion in portions(seed, inputs, processes):
                whole.inputs += portion.inputs
                whole.disagreements += portion.disagreements
                progress.update(task, completed=whole.inputs.total(), found=len(whole.disagreements))
                if not console.is_terminal and time.monotonic() - told > _EVERY:
                    told = time.monotonic()
                    console.print(f"{whole.inputs.total():,} inputs, {len(whole.disagreements)} disagreements")
        except KeyboardInterrupt:
            console.print(f"interrupted after {whole.inputs.total():,} inputs")
    return whole


def main(
    inputs: Annotated[int, typer.Option(min=1, help="How many inputs, of all families in turn.")] = 20_000,
    seed: Annotated[int, typer.Option(min=0, help="Another seed, other inputs.")] = 0,
    processes: Annotated[int, typer.Option(min=1, help="How many processes share the work.")] = 1,
) -> None:
    """Compare the compiled library with brute force on small inputs. Exit code 1 if they disagree on one."""
    console, start, work = Console(), time.monotonic(), time.process_time()
    whole = collected(seed, inputs, processes, console)
    console.print(shown(whole.inputs, whole.disagreements))
    console.print(f"seed {seed}, {time.monotonic() - start:.0f} s, {time.process_time() - work:.0f} s of this process")
    if not whole.disagreements:
        return
    one, given = smallest(whole.disagreements)
    console.print(f"drawn(family={one.family!r}, seed={one.seed}, number={one.number}):", markup=False)
    for sentence in one.sentences:
        console.print(f"  {sentence}", markup=False, soft_wrap=True)
    console.print(f"reduced to {code_of(given)}", markup=False, soft_wrap=True)
    raise typer.Exit(1)


if __name__ == "__main__":
    typer.run(main)
