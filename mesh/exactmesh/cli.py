"""The command ``exactmesh``: 0 means yes, 1 a violation, 2 bad input or usage, 130 an interrupt.

Imports stand where they are needed, so that ``--help`` and a wrong path answer at once.
"""

import errno
import os
import re
import sys
from collections.abc import Sequence
from importlib.metadata import version
from typing import TYPE_CHECKING, Annotated, BinaryIO

import typer

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from exactkernel.types import FloatArray, IntArray
    from exactmesh.io import Mesh
    from exactmesh.triangulation import Triangulation

__all__ = ["app", "main"]

_VIOLATION = 1
_BAD_INPUT = 2
_INTERRUPTED = 130
_READER_GONE = 141  # as a shell reports SIGPIPE: neither yes nor no
_DUPLICATES_NAMED = 3

#: click's base of wrong options, missing arguments and so on; typer may carry its own copy of click.
_UsageError: type[typer.BadParameter] = typer.BadParameter.__mro__[1]

app = typer.Typer(
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Planar meshes whose every answer can be checked, and the checker for everybody else's.",
)

_Mesh = Annotated[str, typer.Argument(metavar="MESH", help="A .ele (its .node beside it), .node or .npz file.")]


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"exactmesh {version('exactmesh')}")
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


@app.command()
def triangulate(
    source: Annotated[str, typer.Argument(metavar="IN", help="Points: .node, .csv or .npz.")],
    output: Annotated[
        str | None,
        typer.Option("-o", "--output", metavar="OUT", help=".node and .ele, or .npz; x.node gives x.1.node."),
    ] = None,
    seed: Annotated[int, typer.Option(help="Of the insertion order; the triangulation does not depend on it.")] = 0,
) -> None:
    """Write the Delaunay triangulation of the points in IN."""
    _require_file(source)
    target = _next_name(source) if output is None else output
    if os.path.splitext(target)[1] not in (".node", ".ele", ".npz"):
        raise typer.BadParameter(f"{target}: triangles go into .node and .ele, or .npz", param_hint="-o")
    if _files_of(source) & _files_of(target):
        raise typer.BadParameter(f"{target}: would overwrite the input", param_hint="-o")
    from exactkernel.jit import is_cache_warm
    from exactmesh.delaunay import delaunay
    from exactmesh.errors import ExactMeshError, FileFormatError
    from exactmesh.io import read_points, write
    from exactmesh.progress import working

    with working(f"reading {source}"):
        points = read_points(source)
    with working("triangulating", compiling=not is_cache_warm()) as progress:
        try:
            triangulation = delaunay(points.points, seed=seed, progress=progress)
        except ExactMeshError as error:
            raise FileFormatError(str(error), path=source) from error
    duplicates = _duplicates(triangulation, points.base)
    with working(f"writing {target}"):
        mesh = _carried_over(points, triangulation, target)
        paths = write(target, mesh)
    if duplicates is not None:
        typer.echo(duplicates)
    typer.echo(f"{len(triangulation.points)} points, {len(triangulation.triangles)} triangles: {' '.join(paths)}")


def _files_of(path: str) -> set[str]:
    """The files that are read or written under this name: of Triangle's formats, all with the same stem."""
    stem, suffix = os.path.splitext(path)
    names = [f"{stem}.node", f"{stem}.ele"] if suffix in (".node", ".ele") else [path]
    return {os.path.realpath(name) for name in names}


def _next_name(source: str) -> str:
    """The name of the output as Triangle gives it: x.node to x.1.node, x.1.node to x.2.node."""
    stem = os.path.splitext(source)[0]
    numbered = re.fullmatch(r"(.+)\.([0-9]+)", stem)
    return f"{numbered[1]}.{int(numbered[2]) + 1}.node" if numbered else f"{stem}.1.node"


def _first_of_each(triangulation: "Triangulation") -> "npt.NDArray[np.intp]":
    """For each vertex the first input point that it stands for: vertices are numbered as their points come."""
    import numpy as np

    return np.flatnonzero(np.diff(np.maximum.accumulate(triangulation.representative), prepend=-1))


def _carried_over(source: "Mesh", triangulation: "Triangulation", target: str) -> "Mesh":
    """The triangulation as a mesh, with the attributes and markers of the points that were kept.

    Neighbors and edges come along where a .neigh or .edge file of an older mesh would be left beside the target.
    """
    from exactmesh.io import Mesh

    first, stem = _first_of_each(triangulation), os.path.splitext(target)[0]
    attributes, markers = source.point_attributes, source.point_markers
    return Mesh(
        triangulation.points,
        triangles=triangulation.triangles,
        neighbors=triangulation.neighbors if os.path.exists(f"{stem}.neigh") else None,
        edges=triangulation.edges if os.path.exists(f"{stem}.edge") else None,
        point_attributes=None if attributes is None else attributes[first],
        point_markers=None if markers is None else markers[first],
        base=source.base,
    )


def _duplicates(triangulation: "Triangulation", base: int) -> str | None:
    """One line that names points which were left out because another has their place; None if there are none."""
    import numpy as np

    total = len(triangulation.representative)
    if len(triangulation.points) == total:
        return None
    first = _first_of_each(triangulation)
    left_out = np.delete(np.arange(total), first)
    kept = first[triangulation.representative[left_out[:_DUPLICATES_NAMED]]]
    named = ", ".join(f"{base + i} of {base + k}" for i, k in zip(left_out, kept, strict=False))
    more = ", ..." if len(left_out) > _DUPLICATES_NAMED else ""
    return f"{len(left_out)} of {total} points left out as duplicates: {named}{more}"


@app.command()
def verify(
    mesh: _Mesh,
    claim: Annotated[
        list[str] | None,
        typer.Option(metavar="PROPERTY", help="Claim this property (repeatable); default: all up to delaunay."),
    ] = None,
    orientation: Annotated[str, typer.Option(metavar="ccw|any", help="How triangles may be listed.")] = "ccw",
    json: Annotated[
        str | None, typer.Option(metavar="FILE", help="Write the report as JSON, counted from 0; - prints it.")
    ] = None,
) -> None:
    """Check what MESH claims to be: exit code 0 if every claim holds, 1 if not."""
    _require_file(mesh)
    from exactkernel.jit import is_cache_warm
    from exactmesh.progress import working
    from exactmesh.verify import verify as check
    from exactmesh.verify.properties import claimed_properties, orientation_of

    claims, orders = claimed_properties(claim or None), orientation_of(orientation)
    points, triangles, base = _triangles_of(mesh)
    with working(f"verifying {mesh}", compiling=not is_cache_warm()):
        report = check(points, triangles, claims=claims, orientation=orders)
    if json is not None and json != "-":
        _write_text(json, report.to_json())
    typer.echo(report.to_json() if json == "-" else str(report))
    if base and json != "-" and report.violations:
        typer.echo(f"(Numbers in this report count from 0, those in the files from {base}.)")
    raise typer.Exit(0 if report.ok else _VIOLATION)


def _triangles_of(path: str) -> "tuple[FloatArray, IntArray, int]":
    from exactmesh.errors import FileFormatError
    from exactmesh.io import read_triangles
    from exactmesh.progress import working

    with working(f"reading {path}"):
        mesh = read_triangles(path)
    if mesh.triangles is None:
        raise FileFormatError("there are no triangles on file, only points", path=path)
    return mesh.points, mesh.triangles, mesh.base


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
    _require_file(mesh)
    import numpy as np

    from exactmesh.io import read_triangles
    from exactmesh.plot import plot_mesh
    from exactmesh.progress import working

    with working(f"drawing {mesh}"):
        content = read_triangles(mesh)
        triangles = np.zeros((0, 3), dtype=np.int32) if content.triangles is None else content.triangles
        plot_mesh(content.points, triangles, output, title=os.path.basename(mesh) if title is None else title)
    typer.echo(output)


@app.command()
def info(mesh: _Mesh) -> None:
    """Print what MESH holds: counts, bounding box, angles and areas."""
    _require_file(mesh)
    from rich.console import Console
    from rich.table import Table

    from exactmesh.io import read
    from exactmesh.progress import working
    from exactmesh.summary import facts

    with working(f"reading {mesh}"):
        rows = list(facts(read(mesh)))
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


def _require_file(path: str) -> None:
    """Say at once that a file is missing; what is in it is the reader's business."""
    if not os.path.exists(path):
        raise FileNotFoundError(errno.ENOENT, "no such file", path)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command, and return its exit code; errors are one line on standard error."""
    try:
        code = app(arguments, prog_name="exactmesh", standalone_mode=False)
    except (KeyboardInterrupt, typer.Abort):
        code = _INTERRUPTED
    except SystemExit:  # what typer makes of a closed pipe; its code 1 would say "a violation"
        return _READER_GONE
    except _UsageError as error:
        return _complain(f"{error.format_message()} (see exactmesh --help)")
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


def _complain(message: str, code: int = _BAD_INPUT) -> int:
    typer.echo(f"exactmesh: {' '.join(message.split())}", err=True)
    return code


if __name__ == "__main__":
    sys.exit(main())
