"""The command ``exactmesh``: 0 means yes, 1 a violation, 2 bad input or usage, 130 an interrupt.

Imports stand where they are needed, so that ``--help`` and a wrong path answer at once.
"""

import os
import re
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, BinaryIO

import typer

from exactmesh import __version__
from exactmesh.cli_arguments import carve_rule, require_file
from exactmesh.conformance.command import conformance
from exactmesh.triangulate_command import triangulate

if TYPE_CHECKING:
    from exactmesh.adapters import GivenMesh
    from exactmesh.io import Mesh
    from exactmesh.pslg import PSLG

__all__ = ["app", "main"]

_VIOLATION = 1
_BAD_INPUT = 2
_INTERRUPTED = 130
_READER_GONE = 141  # as a shell reports SIGPIPE: neither yes nor no

#: click's base of wrong options, missing arguments and so on; typer may carry its own copy of click.
_UsageError: type[typer.BadParameter] = typer.BadParameter.__mro__[1]

app = typer.Typer(
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Planar meshes whose every answer can be checked, and the checker for everybody else's.",
)

_Mesh = Annotated[
    str, typer.Argument(metavar="MESH", help="A .ele (its .node beside it), .node, .poly, .npz; or what meshio reads.")
]


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


app.command()(triangulate)
app.command()(conformance)


@app.command()
def verify(
    mesh: _Mesh,
    claim: Annotated[
        list[str] | None,
        typer.Option(metavar="PROPERTY", help="Claim this property (repeatable); default: all that fits."),
    ] = None,
    domain: Annotated[
        str | None,
        typer.Option(
            metavar="FILE", help="What MESH should cover: .poly, .geojson; default: its own segments, or the hull."
        ),
    ] = None,
    carve: Annotated[
        str | None, typer.Option(metavar="seeds|even-odd", help="Which faces of the domain; default: as its file says.")
    ] = None,
    orientation: Annotated[
        str | None,
        typer.Option(metavar="ccw|any", help="How cells may be listed; default: ccw, but any of formats of others."),
    ] = None,
    min_angle: Annotated[float | None, typer.Option(metavar="DEGREES", help="Claim that no angle is smaller.")] = None,
    max_angle: Annotated[float | None, typer.Option(metavar="DEGREES", help="Claim that no angle is larger.")] = None,
    max_area: Annotated[float | None, typer.Option(metavar="AREA", help="Claim that no triangle is larger.")] = None,
    within: Annotated[
        float | None, typer.Option(metavar="DISTANCE", help="How far MESH may be from --domain; default: not at all.")
    ] = None,
    gabriel: Annotated[
        bool,
        typer.Option("--gabriel", help="Claim that no vertex is inside the circle of a boundary edge or segment."),
    ] = False,
    json: Annotated[
        str | None, typer.Option(metavar="FILE", help="Write the report as JSON, counted from 0; - prints it.")
    ] = None,
    html: Annotated[
        str | None, typer.Option(metavar="FILE", help="Write a page that shows the mesh and what is wrong with it.")
    ] = None,
) -> None:
    """Check what MESH claims to be: exit code 0 if every claim holds, 1 if not."""
    require_file(mesh)
    if domain is None and carve is not None:
        raise typer.BadParameter("there is no --domain to carve", param_hint="--carve")
    if domain is None and within is not None:
        raise typer.BadParameter("there is no --domain to be near to", param_hint="--within")
    for name, bound in (("min-angle", min_angle), ("max-angle", max_angle), ("max-area", max_area)):
        if bound is None and name in [word.replace("_", "-") for word in claim or ()]:
            raise typer.BadParameter(f"{name} needs a bound, by --{name}", param_hint="--claim")
    from exactkernel.jit import is_cache_warm
    from exactmesh.progress import working
    from exactmesh.verify.boundary import walk_convex
    from exactmesh.verify.chains import walk_chains
    from exactmesh.verify_file import Shapes, checked_against, checked_alone

    content = _cells_of(mesh)
    graph = None if domain is None else _domain_of(domain, carve)
    bounds = Shapes(min_angle=min_angle, max_angle=max_angle, max_area=max_area, gabriel=gabriel, within=within)
    needed = (walk_convex,) if graph is None and content.segments is None else (walk_convex, walk_chains)
    base = getattr(content, "base", 0)
    with working(f"verifying {mesh}", compiling=not is_cache_warm(*needed)):
        if graph is None:
            report, note = checked_alone(content, mesh, claim or None, orientation, bounds)
        else:
            report, note = checked_against(*graph, domain or "", content, claim or None, orientation, bounds), ""
    if json is not None and json != "-":
        _write_text(json, report.to_json())
    if html is not None:
        with working(f"writing {html}"):
            _write_text(html, report.to_html(os.path.basename(mesh)))
    typer.echo(report.to_json() if json == "-" else str(report))
    if json != "-" and note:
        typer.echo(note)
    if base and json != "-" and report.violations:
        typer.echo(f"(Numbers in this report count from 0, those in the files from {base}.)")
    raise typer.Exit(0 if report.ok else _VIOLATION)


@app.command(name="check-certificate")
def check_certificate(
    certificate: Annotated[str, typer.Argument(metavar="CERT", help="What verify --json wrote.")],
    mesh: _Mesh,
    domain: Annotated[
        str | None,
        typer.Option(metavar="FILE", help="What MESH should cover, if verify was told by --domain."),
    ] = None,
    again: Annotated[
        bool, typer.Option("--again", help="Verify MESH once more, by the same claims, and compare the verdicts.")
    ] = False,
) -> None:
    """Check that CERT is about MESH, bit by bit: exit code 0 if it is, 1 if not."""
    require_file(certificate)
    require_file(mesh)
    from exactmesh.certificate_file import checked_certificate, said_of
    from exactmesh.errors import CertificateError
    from exactmesh.progress import working
    from exactmesh.verify import read_certificate

    with open(certificate, "rb") as stream:
        try:
            read = read_certificate(stream.read().decode())
        except (CertificateError, UnicodeDecodeError) as error:
            raise CertificateError(f"{certificate}: {error}") from None
    content = _cells_of(mesh)
    graph = None if domain is None else _domain_of(domain, None)[0]
    with working(f"checking {mesh}"):
        check = checked_certificate(read, content, graph, again=again)
    typer.echo(said_of(check, certificate, mesh))
    raise typer.Exit(0 if check else _VIOLATION)


def _domain_of(path: str, carve: str | None) -> "tuple[PSLG, int]":
    """Return the domain on file, and what its numbers count from."""
    rule = None if carve is None else carve_rule(carve)
    require_file(path)
    from exactmesh.io import read_graph
    from exactmesh.progress import working

    with working(f"reading {path}"):
        pslg, base = read_graph(path)
    return pslg if rule is None else pslg.with_rule(rule), base


def _cells_of(path: str) -> "Mesh | GivenMesh":
    """Return what is on file, triangles or other cells among it."""
    from exactmesh.errors import FileFormatError
    from exactmesh.progress import working

    with working(f"reading {path}"):
        mesh = _read_any(path)
    if mesh.triangles is None:
        raise FileFormatError("there are no triangles on file, only points", path=path)
    return mesh


def _read_any(path: str) -> "Mesh | GivenMesh":
    from exactmesh.adapters.files import is_own_format, read_foreign
    from exactmesh.io import read_triangles

    return read_triangles(path) if is_own_format(path) else read_foreign(path)


def _write_text(path: str, text: str) -> None:
    from exactmesh.io.atomic import write_whole

    def write_to(stream: BinaryIO) -> None:
        stream.write(text.encode() + b"\n")

    write_whole({path: write_to})


@app.command()
def plot(
    mesh: _Mesh,
    output: Annotated[str, typer.Option("-o", "--output", metavar="PICTURE", help=".png, .svg or .pdf.")],
    title: Annotated[str | None, typer.Option(help="The caption; default: the file's name.")] = None,
) -> None:
    """Draw MESH into a picture; its triangles are coloured by their smallest angle."""
    require_file(mesh)
    import numpy as np

    from exactmesh.plot import plot_mesh
    from exactmesh.progress import working

    with working(f"drawing {mesh}"):
        content = _read_any(mesh)
        quads = getattr(content, "quads", ())
        if len(quads):
            raise typer.BadParameter(f"{mesh} has quadrilaterals; verify --html shows them", param_hint="MESH")
        triangles = np.zeros((0, 3), dtype=np.int32) if content.triangles is None else content.triangles
        caption = os.path.basename(mesh) if title is None else title
        plot_mesh(content.points, triangles, output, segments=content.segments, title=caption)
    typer.echo(output)


@app.command()
def info(mesh: _Mesh) -> None:
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


@app.command()
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
        return _complain(f"{error.format_message()} ({_advice(arguments)}see exactmesh --help)")
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
