"""The command ``exactmesh``: 0 means yes, 1 a violation, 2 bad input or usage, 130 an interrupt.

Imports stand where they are needed, so that ``--help`` and a wrong path answer at once.
"""

import os
import re
import sys
from collections.abc import Sequence
from typing import Annotated

import typer

from exactmesh import __version__
from exactmesh.cli_arguments import MeshPath, PlainCommand, PlainGroup, require_file
from exactmesh.cli_files import read_any
from exactmesh.conformance.command import conformance
from exactmesh.triangulate_command import triangulate
from exactmesh.verify_command import check_certificate, verify

__all__ = ["app", "main"]

_VIOLATION = 1
_BAD_INPUT = 2
_INTERRUPTED = 130
_READER_GONE = 141  # as a shell reports SIGPIPE: neither yes nor no

#: click's base of wrong options, missing arguments and so on; typer may carry its own copy of click.
_UsageError: type[typer.BadParameter] = typer.BadParameter.__mro__[1]

app = typer.Typer(
    cls=PlainGroup,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Planar meshes whose every answer can be checked, and the checker for everybody else's.",
)


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"exactmesh {__version__}")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def _common(
    context: typer.Context,
    _version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


app.command(cls=PlainCommand)(triangulate)
app.command(cls=PlainCommand)(conformance)
app.command(cls=PlainCommand)(verify)
app.command("check-certificate", cls=PlainCommand)(check_certificate)


@app.command(cls=PlainCommand)
def plot(
    mesh: MeshPath,
    output: Annotated[str, typer.Option("-o", "--output", metavar="PICTURE", help=".png, .svg or .pdf.")],
    title: Annotated[str | None, typer.Option(help="The caption; default: the file's name.")] = None,
) -> None:
    """Draw MESH into a picture; its triangles are coloured by their smallest angle."""
    require_file(mesh)
    import numpy as np

    from exactmesh.plot import plot_mesh
    from exactmesh.progress import working

    with working(f"drawing {mesh}"):
        content = read_any(mesh)
        quads = getattr(content, "quads", ())
        if len(quads):
            raise typer.BadParameter(f"{mesh} has quadrilaterals; verify --html shows them", param_hint="MESH")
        triangles = np.zeros((0, 3), dtype=np.int32) if content.triangles is None else content.triangles
        caption = os.path.basename(mesh) if title is None else title
        plot_mesh(content.points, triangles, output, segments=content.segments, title=caption)
    typer.echo(output)


@app.command(cls=PlainCommand)
def info(mesh: MeshPath) -> None:
    """Print what MESH holds: counts, bounding box, angles and areas."""
    require_file(mesh)
    from rich.console import Console
    from rich.table import Table

    from exactmesh.adapters.files import is_own_format, read_foreign
    from exactmesh.io import read
    from exactmesh.progress import working
    from exactmesh.summary import facts, facts_of_foreign

    with working(f"reading {mesh}"):
        rows = list(facts(read(mesh)) if is_own_format(mesh) else facts_of_foreign(read_foreign(mesh)))
    table = Table(title=mesh, title_justify="left", show_header=False)
    for name, value in rows:
        table.add_row(name, value)
    Console(highlight=False).print(table)


@app.command(cls=PlainCommand)
def demo(
    folder: Annotated[
        str, typer.Option("-o", "--output", metavar="FOLDER", help="Where the pictures go.")
    ] = "exactmesh-demo",
) -> None:
    """Triangulate, verify and draw two built-in point sets; needs no input."""
    from rich.console import Console

    from exactmesh.demo import demo as run_demo

    if not run_demo(folder, Console(highlight=False)):
        raise typer.Exit(_VIOLATION)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command, and return its exit code; errors are one line on standard error."""
    try:
        code = app(arguments, prog_name="exactmesh", standalone_mode=False)
    except (KeyboardInterrupt, typer.Abort):
        code = _INTERRUPTED
    except SystemExit:  # what typer makes of a closed pipe; its code 1 would say "a violation"
        return _READER_GONE
    except _UsageError as error:
        command = getattr(getattr(error, "ctx", None), "command_path", "exactmesh")
        return _complain(f"{error.format_message()} ({_advice(arguments)}see {command} --help)")
    except OSError as error:
        place = "" if error.filename is None else f"{error.filename}: "
        return _complain(f"{place}{error.strerror or error}")
    except MemoryError:
        return _complain("not enough memory")
    except ValueError as error:
        from exactkernel.errors import ExactMeshError

        if not isinstance(error, ExactMeshError):
            raise
        return _complain(str(error))
    if code == _INTERRUPTED:
        return _complain("interrupted", _INTERRUPTED)
    return code if isinstance(code, int) else 0


def _advice(arguments: Sequence[str] | None) -> str:
    """Return what to do about switches that are given as to Triangle's command, ``triangulate -pq30 lake.poly``."""
    command, *given = [*(sys.argv[1:] if arguments is None else arguments), ""]
    switches = [word[1:] for word in given if re.match(r"-[pr]", word)]
    return f"Triangle's switches go behind -s: -s {switches[0]}; " if command == "triangulate" and switches else ""


def _complain(message: str, code: int = _BAD_INPUT) -> int:
    typer.echo(f"exactmesh: {' '.join(message.split())}", err=True)
    return code


if __name__ == "__main__":
    sys.exit(main())
