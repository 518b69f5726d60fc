"""``exactmesh conformance``: put a mesher to the test. Imports stand where they are needed: see the command."""

import os
import sys
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from rich.console import Console

    from exactmesh.conformance.laws import Task
    from exactmesh.conformance.result import Conformance

__all__ = ["conformance"]

_BROKEN = 1
_UNFINISHED = 3
_WIDE = 160  # columns, where no terminal says how many


def conformance(
    mesher: Annotated[
        str | None,
        typer.Argument(
            metavar="MESHER", help="A known mesher, such as scipy (--list), or module:function or file.py:function."
        ),
    ] = None,
    segments: Annotated[
        bool, typer.Option("--segments", help="It takes (points, segments) and covers the convex hull.")
    ] = False,
    domain: Annotated[
        bool, typer.Option("--domain", help="It takes (points, segments) and covers what they enclose, by even-odd.")
    ] = False,
    input_: Annotated[
        str | None,
        typer.Option("--input", metavar="INPUT", help="Try this alone: a file, corpus:NUMBER, or points in Python."),
    ] = None,
    law: Annotated[
        list[str] | None, typer.Option("--law", metavar="LAW", help="Only this law (repeatable); default: all.")
    ] = None,
    max_examples: Annotated[int, typer.Option(min=1, help="Inputs of each family.")] = 100,
    max_size: Annotated[int, typer.Option(min=8, help="Points of an input.")] = 40,
    deadline: Annotated[float, typer.Option(metavar="SECONDS", help="For everything, about.")] = 120.0,
    timeout: Annotated[float, typer.Option(metavar="SECONDS", help="For one call; longer is hanging.")] = 10.0,
    seed: Annotated[int, typer.Option(min=0, help="The same seed, the same inputs.")] = 0,
    orientation: Annotated[
        str | None, typer.Option(metavar="ccw|any", help="How triangles may be listed; default: ccw.")
    ] = None,
    allow_rounding: Annotated[
        bool, typer.Option("--allow-rounding", help="Exit with 0 if laws are broken by rounding only.")
    ] = False,
    all_: Annotated[bool, typer.Option("--all", help="All known meshers: write the scoreboard, in Markdown.")] = False,
    output: Annotated[
        str | None, typer.Option("-o", "--output", metavar="FILE", help="Where the scoreboard goes; default: printed.")
    ] = None,
    list_: Annotated[bool, typer.Option("--list", help="List the known meshers and the corpus.")] = False,
) -> None:
    """Hunt the bugs of MESHER: exit code 0 if every law holds, 1 if not, 3 if the time was up too early to tell.

    It runs in a process of its own, where it may crash or hang.
    """
    if list_:
        _list(_console())
        return
    if all_:
        _refuse_with_all(MESHER=mesher, input=input_, law=law, segments=segments, domain=domain)
        _refuse_with_all(orientation=orientation, allow_rounding=allow_rounding)
        _write_scoreboard(output, deadline, timeout, seed)
        return
    if output is not None:
        raise typer.BadParameter("it is for --all", param_hint="--output")
    if mesher is None:
        raise typer.BadParameter("which mesher? (--list names those that are known)", param_hint="MESHER")
    if segments and domain:
        raise typer.BadParameter("--segments and --domain exclude each other", param_hint="--domain")
    from exactmesh.conformance import Task
    from exactmesh.conformance.table import print_result

    task = Task.DOMAIN if domain else Task.SEGMENTS if segments else Task.POINTS
    if os.getcwd() not in sys.path:
        sys.path.insert(0, os.getcwd())  # as python -m has it
    if input_ is None:
        result = _hunted(mesher, task, law, max_examples, max_size, deadline, timeout, orientation, seed)
    else:
        result = _retried(mesher, task, input_, law, timeout, orientation)
    print_result(result, _console())
    if not (result.ok_but_for_rounding if allow_rounding else result.ok):
        raise typer.Exit(_BROKEN)
    raise typer.Exit(0 if result.complete else _UNFINISHED)


def _console() -> "Console":
    from rich.console import Console

    width = None if sys.stdout.isatty() or "COLUMNS" in os.environ else _WIDE
    return Console(highlight=False, width=width)


def _refuse_with_all(**given: object) -> None:
    """Refuse what would have no effect on the scoreboard."""
    for name, value in given.items():
        if value:
            hint = name if name.isupper() else f"--{name.replace('_', '-')}"
            raise typer.BadParameter("--all is for all known meshers and laws, and excludes it", param_hint=hint)


def _hunted(
    mesher: str,
    task: "Task",
    laws: list[str] | None,
    max_examples: int,
    max_size: int,
    deadline: float,
    timeout: float,
    orientation: str | None,
    seed: int,
) -> "Conformance":
    from exactkernel.jit import is_cache_warm
    from exactmesh.conformance import check
    from exactmesh.progress import working
    from exactmesh.verify.boundary import walk_convex

    with working(f"hunting {mesher}", compiling=not is_cache_warm(walk_convex)) as tell:

        def progress(_what: str, done: int, total: int) -> None:
            tell(done, total)

        return check(
            mesher,
            kind=task,
            properties=laws or None,
            max_examples=max_examples,
            max_size=max_size,
            deadline=deadline,
            timeout=timeout,
            orientation=orientation,
            seed=seed,
            progress=progress,
        )


def _retried(
    mesher: str, task: "Task", text: str, laws: list[str] | None, timeout: float, orientation: str | None
) -> "Conformance":
    from exactmesh.conformance import retry
    from exactmesh.conformance.inputs import given_input

    given, source = given_input(text, task)
    return retry(
        mesher,
        given.points,
        given.segments,
        kind=task,
        properties=laws or None,
        source=source,
        timeout=timeout,
        orientation=orientation,
    )


def _write_scoreboard(path: str | None, deadline: float, timeout: float, seed: int) -> None:
    from exactmesh.conformance.scoreboard import scoreboard

    def tell(what: str) -> None:
        typer.echo(what, err=True)

    page = scoreboard(deadline=deadline, timeout=timeout, seed=seed, tell=tell)
    if path is None:
        typer.echo(page, nl=False)
        return
    with open(path, "w", encoding="utf-8") as file:
        file.write(page)
    typer.echo(path)


def _list(console: "Console") -> None:
    from rich.table import Table

    from exactmesh.conformance import CORPUS, KNOWN

    meshers = Table(title="known meshers", title_justify="left")
    for heading in ("name", "mesher", "package", "version", "does"):
        meshers.add_column(heading)
    for name, known in KNOWN.items():
        meshers.add_row(name, known.title, known.package, known.version or "not installed", ", ".join(known.functions))
    console.print(meshers)
    corpus = Table(title="corpus", title_justify="left")
    for heading in ("--input", "for", "what it is", "known to fail"):
        corpus.add_column(heading)
    for case in CORPUS.values():
        corpus.add_row(case.source, str(case.task), case.title, ", ".join(case.failing))
    console.print(corpus)
