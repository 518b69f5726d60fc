"""Triangle's command: files in, files out, as a switch string says."""

import os
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from exactkernel.jit import is_cache_warm
from exactkernel.types import IntArray
from exactmesh.constrain import constrain_range
from exactmesh.delaunay import Progress, insert_range
from exactmesh.errors import FileFormatError, PSLGError
from exactmesh.io.area import read_areas
from exactmesh.io.atomic import Writer, text_writer, write_whole
from exactmesh.io.dual import voronoi_writers
from exactmesh.io.edge import edge_text
from exactmesh.io.ele import elements_text, read_elements
from exactmesh.io.files import read_points, read_triangles
from exactmesh.io.model import Mesh
from exactmesh.io.neigh import neigh_text
from exactmesh.io.node import node_text
from exactmesh.io.off import off_text
from exactmesh.io.poly import has_points, read_poly, segments_text
from exactmesh.progress import working
from exactmesh.refinement.ruppert import run
from exactmesh.triangle.dictionary import Given, TriangleDict, given_of
from exactmesh.triangle.errors import SwitchError
from exactmesh.triangle.result import dictionary_of
from exactmesh.triangle.solve import Solution, answered
from exactmesh.triangle.switches import MEANINGS, Switch, Switches, parse
from exactmesh.triangulate_file import next_name

__all__ = ["run_switches"]

_SUFFIXES = (".node", ".ele", ".poly")
_SUPPRESSED = {Switch.NO_NODES, Switch.NO_ELEMENTS, Switch.NO_POLY}


def run_switches(text: str, source: str, output: str | None) -> Iterator[str]:
    """Do what Triangle's command does with these switches and this file; yield lines that say what was done.

    Args:
        text: the switches.
        source: ``x.node``, ``x.ele`` or ``x.poly``; which of the three are read the switches say.
        output: any of these, or None: ``x.1``, or what the next number is.

    Raises:
        SwitchError: the switches cannot be meant, or not here.
        FileFormatError: a file is missing or broken, would be overwritten, or has another suffix.
        ExactMeshError: what :func:`exactmesh.triangle.triangulate` raises.
    """
    switches = parse(text)
    if switches.asks(Switch.HELP):
        yield from (f"{switch}  {meaning}" for switch, meaning in MEANINGS.items())
        return
    _refuse_question(switches, text)
    stem, suffix = os.path.splitext(source)
    if suffix not in _SUFFIXES:
        raise FileFormatError(f"switches are for Triangle's files: {', '.join(_SUFFIXES)}", path=source)
    with working(f"reading {source}"):
        given, base, read = _read(stem, switches)
    target = _target(source, output, switches)
    base = 0 if switches.asks(Switch.ZERO) else base
    with working("triangulating", compiling=_has_to_compile(switches)) as progress:
        solution = _solved(given, switches, progress, source, base)
    written = _written(target, switches)
    found = dictionary_of(given, replace(written, given=written.given - _SUPPRESSED), solution)
    writers = _writers(target, found, written, solution, base)
    overwritten = {os.path.realpath(path) for path in writers} & {os.path.realpath(path) for path in read}
    if overwritten:
        raise FileFormatError("is an input, and would be overwritten: give -o", path=min(overwritten))
    with working(f"writing {target}"):
        write_whole(writers)
    yield from (f"note: {note}" for note in (*switches.notes(), *solution.notes))
    mesh = solution.mesh
    yield f"{len(mesh.points)} points, {len(mesh.triangles)} triangles: {' '.join(writers)}"


def _refuse_question(switches: Switches, text: str) -> None:
    if switches.asks(Switch.UNSUITABLE):
        message = "the command has no function to ask: call exactmesh.triangle.triangulate from Python"
        raise SwitchError(message, switches=text, position=text.find("u"), culprit="u")


def _has_to_compile(switches: Switches) -> bool:
    needed = (insert_range, constrain_range, run) if switches.refines else (insert_range, constrain_range)
    return not is_cache_warm(*needed)


def _target(source: str, output: str | None, switches: Switches) -> str:
    """Return the stem of what is written."""
    if output is None:
        return os.path.splitext(source if switches.asks(Switch.NO_ITERATION) else next_name(source))[0]
    stem, suffix = os.path.splitext(output)
    if suffix not in _SUFFIXES:
        raise FileFormatError(f"with switches, give -o one of {', '.join(_SUFFIXES)}", path=output)
    return stem


def _read(stem: str, switches: Switches) -> tuple[Given, int, list[str]]:
    """Return what Triangle would read with these switches, what it counts from, and the names of the files."""
    read, triangles = [stem + ".node"], None
    if switches.asks(Switch.REFINE):
        read.append(stem + ".ele")
        mesh = read_triangles(stem + ".node")
        triangles = read_elements(stem + ".ele", len(mesh.points), mesh.base)[0]
        if switches.asks(Switch.PSLG):
            read.append(stem + ".poly")
    elif switches.asks(Switch.PSLG):
        read.append(stem + ".poly")
        mesh = read_poly(stem + ".poly")[0]
        if has_points(stem + ".poly"):
            read.remove(stem + ".node")
    else:
        mesh = read_points(stem + ".node")
    areas = None
    if switches.asks(Switch.REFINE) and switches.local_areas:
        read.append(stem + ".area")
        areas = read_areas(stem + ".area")
    content = {
        "vertices": mesh.points,
        "vertex_attributes": mesh.point_attributes,
        "vertex_markers": mesh.point_markers,
        "triangles": triangles,
        "triangle_attributes": mesh.triangle_attributes,
        "triangle_max_area": areas,
        "segments": mesh.segments,
        "segment_markers": mesh.segment_markers,
        "holes": mesh.holes,
        "regions": mesh.regions,
    }
    return given_of(content, refines=switches.asks(Switch.REFINE)), mesh.base, read


def _solved(given: Given, switches: Switches, progress: Progress, source: str, base: int) -> Solution:
    try:
        return answered(given, switches, None, progress)
    except PSLGError as error:
        raise PSLGError(error.faults, path=source, base=base, hull="the switch c") from None


def _column(markers: IntArray | None) -> IntArray | None:
    return None if markers is None else markers.reshape(-1)


def _mesh_of(found: TriangleDict, switches: Switches, base: int) -> Mesh:
    """Return the content of a dictionary; of six nodes a triangle, the corners."""
    nothing = np.zeros((0, 2), dtype=np.int32) if switches.asks(Switch.PSLG, Switch.CONVEX) else None
    triangles = found.get("triangles", np.zeros((0, 3), dtype=np.int32))
    return Mesh(
        found["vertices"],
        point_attributes=found.get("vertex_attributes"),
        point_markers=_column(found.get("vertex_markers")),
        triangles=triangles[:, :3],
        neighbors=found.get("neighbors"),
        edges=found.get("edges"),
        edge_markers=_column(found.get("edge_markers")),
        segments=found.get("segments", nothing),
        segment_markers=_column(found.get("segment_markers")),
        holes=found.get("holes"),
        regions=found.get("regions"),
        base=base,
    )


def _written(stem: str, switches: Switches) -> Switches:
    """Return the switches, with those for files that would else be left there from another mesh."""
    more = {Switch.EDGES: ".edge", Switch.NEIGHBORS: ".neigh"}
    stale = {switch for switch, suffix in more.items() if os.path.exists(stem + suffix)}
    return replace(switches, given=switches.given | stale)


def _writers(stem: str, found: TriangleDict, switches: Switches, solution: Solution, base: int) -> dict[str, Writer]:
    """Return what writes each file that the switches ask for."""
    mesh = _mesh_of(found, switches, base)
    triangles = found.get("triangles", np.zeros((0, 3), dtype=np.int32))
    attributes = found.get("triangle_attributes")
    writers: dict[str, Writer] = {}
    if not switches.asks(Switch.NO_NODES):
        writers[stem + ".node"] = text_writer(lambda: node_text(mesh))
    if not switches.asks(Switch.NO_ELEMENTS):
        writers[stem + ".ele"] = text_writer(lambda: elements_text(triangles, attributes, base))
    old = os.path.exists(stem + ".poly") and not has_points(stem + ".poly")  # of another mesh, that would be read
    if old or (switches.asks(Switch.PSLG, Switch.CONVEX) and not switches.asks(Switch.NO_POLY)):
        writers[stem + ".poly"] = text_writer(lambda: segments_text(mesh))
    if switches.asks(Switch.EDGES):
        writers[stem + ".edge"] = text_writer(lambda: edge_text(mesh))
    if switches.asks(Switch.NEIGHBORS):
        writers[stem + ".neigh"] = text_writer(lambda: neigh_text(mesh))
    if switches.asks(Switch.VORONOI):
        writers |= voronoi_writers(stem, solution.mesh, base)
    if switches.asks(Switch.GEOMVIEW):
        writers[stem + ".off"] = text_writer(lambda: off_text(mesh.points, triangles[:, :3]))
    return writers
