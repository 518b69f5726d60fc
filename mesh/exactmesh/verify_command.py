"""The commands ``exactmesh verify`` and ``exactmesh check-certificate``."""

import os
from typing import Annotated

import typer

from exactmesh.cli_arguments import MeshPath, require_file
from exactmesh.cli_files import STDOUT, cells_of, domain_of, require_new, write_text

__all__ = ["check_certificate", "verify"]

_VIOLATION = 1


def verify(
    mesh: MeshPath,
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
        str | None,
        typer.Option(metavar="FILE", help="Write a page that shows the mesh and what is wrong; - prints it."),
    ] = None,
) -> None:
    """Check what MESH claims to be: exit code 0 if every claim holds, 1 if not.

    For example: exactmesh verify part.msh --min-angle 20 --html part.html

    A PROPERTY is one of finite, indices, distinct_points, orientation, convex,
    all_points_used, edge_manifold, vertex_manifold, admissible, covers_hull,
    delaunay, segments_present, constrained_delaunay, covers_domain,
    domain_points, no_new_points, regions, weakly_acute, acute, gabriel,
    circumcentres_inside, min_angle, max_angle, max_area, region_areas.
    """
    require_file(mesh)
    require_new({"--json": json, "--html": html}, (mesh, domain))
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

    content = cells_of(mesh)
    graph = None if domain is None else domain_of(domain, carve)
    bounds = Shapes(min_angle=min_angle, max_angle=max_angle, max_area=max_area, gabriel=gabriel, within=within)
    needed = (walk_convex,) if graph is None and content.segments is None else (walk_convex, walk_chains)
    base = getattr(content, "base", 0)
    with working(f"verifying {mesh}", compiling=not is_cache_warm(*needed)):
        if graph is None:
            report, note = checked_alone(content, mesh, claim or None, orientation, bounds)
        else:
            report, note = checked_against(*graph, domain or "", content, claim or None, orientation, bounds), ""
    if html is not None:
        with working(f"writing {html}"):
            page = report.to_html(os.path.basename(mesh))
        write_text(html, page)
    if json is not None:
        write_text(json, report.to_json())
    if STDOUT not in (json, html):
        typer.echo(str(report))
        if note:
            typer.echo(note)
        if base and report.violations:
            typer.echo(f"(Numbers in this report count from 0, those in the files from {base}.)")
    raise typer.Exit(0 if report.ok else _VIOLATION)


def check_certificate(
    certificate: Annotated[str, typer.Argument(metavar="CERT", help="What verify --json wrote.")],
    mesh: MeshPath,
    domain: Annotated[
        str | None,
        typer.Option(metavar="FILE", help="What MESH should cover, if verify was told by --domain."),
    ] = None,
    again: Annotated[
        bool, typer.Option("--again", help="Verify MESH once more, by the same claims, and compare the verdicts.")
    ] = False,
) -> None:
    """Check that CERT is about MESH, bit by bit, and that its claims hold: exit code 0 if so, 1 if not.

    Without --again it is CERT that says so, whoever wrote it; with --again it is found out once more.
    """
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
            raise CertificateError(f"{certificate}: {error} (the order is CERT MESH)") from None
    content = cells_of(mesh)
    graph = None if domain is None else domain_of(domain, None)[0]
    with working(f"checking {mesh}"):
        check = checked_certificate(read, content, graph, again=again)
    typer.echo(said_of(check, certificate, mesh))
    raise typer.Exit(0 if check and check.certificate.ok else _VIOLATION)
