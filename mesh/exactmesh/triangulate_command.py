"""The command ``exactmesh triangulate``: what its options ask for, and who does it."""

import os
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import typer

from exactmesh.cli_arguments import carve_rule, require_file

if TYPE_CHECKING:
    from exactmesh.pslg import Carve
    from exactmesh.triangulate_file import Quality

__all__ = ["triangulate"]

_KEEP_ALL = "none"
_REFINEMENT = "Refinement"


def triangulate(
    source: Annotated[
        str, typer.Argument(metavar="IN", help="A graph: .poly, .geojson, .json; or points: .node, .csv, .npz.")
    ],
    output: Annotated[
        str | None,
        typer.Option("-o", "--output", metavar="OUT", help=".node, .ele and .poly, or .npz; x.poly gives x.1.node."),
    ] = None,
    switches: Annotated[
        str | None,
        typer.Option("-s", "--switches", metavar="pq30a0.1", help="Triangle's switches, for its files; h lists them."),
    ] = None,
    carve: Annotated[
        str | None, typer.Option(metavar="seeds|even-odd|none", help="Which faces of a graph to keep; none: the hull.")
    ] = None,
    crossings: Annotated[
        str | None, typer.Option(metavar="error|split", help="What to do about segments that cross; default: error.")
    ] = None,
    seed: Annotated[int, typer.Option(help="Of the insertion order; the triangulation does not depend on it.")] = 0,
    min_angle: Annotated[
        float | None,
        typer.Option(metavar="DEGREES", help="No smaller angle; 20 with any of these.", rich_help_panel=_REFINEMENT),
    ] = None,
    max_area: Annotated[
        float | None, typer.Option(metavar="AREA", help="No larger triangle.", rich_help_panel=_REFINEMENT)
    ] = None,
    conforming: Annotated[
        bool,
        typer.Option("--conforming", help="All triangles Delaunay, all segments Gabriel.", rich_help_panel=_REFINEMENT),
    ] = False,
    steiner: Annotated[
        str | None,
        typer.Option(
            metavar="anywhere|not-on-boundary|not-on-segments",
            help="Where points may be added.",
            rich_help_panel=_REFINEMENT,
        ),
    ] = None,
    max_steiner: Annotated[
        int | None, typer.Option(metavar="COUNT", help="Add no more points.", rich_help_panel=_REFINEMENT)
    ] = None,
    min_edge: Annotated[
        float | None, typer.Option(metavar="LENGTH", help="Make no shorter edge.", rich_help_panel=_REFINEMENT)
    ] = None,
) -> None:
    """Write the (constrained) Delaunay triangulation of what is in IN, refined if asked."""
    require_file(source)
    options = (min_angle, max_area, conforming or None, steiner, max_steiner, min_edge)
    refines = any(option is not None for option in options)
    if switches is None:
        from exactmesh.triangulate_file import Quality

        quality = Quality(min_angle, max_area, conforming, steiner, max_steiner, min_edge) if refines else None
        lines = _lines(source, output, carve, crossings, seed, quality)
    else:
        from exactmesh.triangle.command import run_switches

        if refines or carve is not None or crossings is not None or seed:
            raise typer.BadParameter("the switches say it all: no other option but -o", param_hint="-s")
        lines = run_switches(switches, source, output)
    for line in lines:
        typer.echo(line)


def _lines(
    source: str, output: str | None, carve: str | None, crossings: str | None, seed: int, quality: "Quality | None"
) -> Iterator[str]:
    """Triangulate a graph, or points; return the lines that say what was done."""
    from exactmesh.constrain import Crossings
    from exactmesh.io import holds_segments
    from exactmesh.triangulate_file import files_of, next_name, refine_points, triangulate_graph, triangulate_points

    target = next_name(source) if output is None else output
    if os.path.splitext(target)[1] not in (".node", ".ele", ".npz"):
        raise typer.BadParameter(f"{target}: triangles go into .node and .ele, or .npz", param_hint="-o")
    if files_of(source) & files_of(target):
        raise typer.BadParameter(f"{target}: would overwrite the input", param_hint="-o")
    if holds_segments(source):
        treatment = Crossings.ERROR if crossings is None else Crossings(crossings)
        return triangulate_graph(source, target, seed, _rule_of(carve), treatment, quality)
    if carve is not None or crossings is not None:
        hint = "--crossings" if carve is None else "--carve"
        raise typer.BadParameter(f"{source} holds points, and no segments", param_hint=hint)
    if quality is not None:
        return refine_points(source, target, seed, quality)
    return triangulate_points(source, target, seed)


def _rule_of(carve: str | None) -> "Carve | bool":
    """What to carve by; True: the file's own rule, False: nothing."""
    if carve is None or carve == _KEEP_ALL:
        return carve is None
    return carve_rule(carve, _KEEP_ALL)
