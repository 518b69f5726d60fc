"""What the commands read and write: meshes of all formats, domains, texts that never replace an input."""

import os
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, BinaryIO

import typer

from exactmesh.cli_arguments import carve_rule, require_file

if TYPE_CHECKING:
    from exactmesh.adapters import GivenMesh
    from exactmesh.io import Mesh
    from exactmesh.pslg import PSLG

__all__ = ["STDOUT", "cells_of", "domain_of", "read_any", "require_new", "write_text"]

#: The name of an output that is printed.
STDOUT = "-"


def domain_of(path: str, carve: str | None) -> "tuple[PSLG, int]":
    """Return the domain on file, and what its numbers count from."""
    rule = None if carve is None else carve_rule(carve)
    require_file(path)
    from exactmesh.io import read_graph
    from exactmesh.progress import working

    with working(f"reading {path}"):
        pslg, base = read_graph(path)
    return pslg if rule is None else pslg.with_rule(rule), base


def cells_of(path: str) -> "Mesh | GivenMesh":
    """Return what is on file, triangles or other cells among it."""
    from exactmesh.errors import FileFormatError
    from exactmesh.progress import working

    with working(f"reading {path}"):
        mesh = read_any(path)
    if mesh.triangles is None:
        raise FileFormatError("there are no triangles on file, only points", path=path)
    return mesh


def read_any(path: str) -> "Mesh | GivenMesh":
    """Return the content of a file of our formats, Triangle's, or one that meshio reads."""
    from exactmesh.adapters.files import is_own_format, read_foreign
    from exactmesh.io import read_triangles

    return read_triangles(path) if is_own_format(path) else read_foreign(path)


def require_new(outputs: Mapping[str, str | None], inputs: Iterable[str | None]) -> None:
    """Refuse outputs, by the names of their options, that would replace an input or one another."""
    if not any(outputs.values()):
        return
    taken = {name: "the input" for path in inputs if path is not None for name in _names(path)}
    for option, path in outputs.items():
        if path is None:
            continue
        names = {STDOUT} if path == STDOUT else {_place(path)}
        for name in names & taken.keys():
            raise typer.BadParameter(f"{path}: would overwrite {taken[name]}", param_hint=option)
        taken.update(dict.fromkeys(names, f"what {option} writes"))


def _names(path: str) -> set[str]:
    """Return the places of the files that are read under this name: of Triangle's formats several."""
    from exactmesh.triangulate_file import files_of

    return {_place(name) for name in files_of(path)}


def _place(path: str) -> str:
    """Return one name for all names of a file, hard links included."""
    place = os.path.realpath(path)
    if not os.path.exists(place):
        return os.path.normcase(place)
    status = os.stat(place)
    return f"{status.st_dev}:{status.st_ino}" if status.st_ino else os.path.normcase(place)


def write_text(path: str, text: str) -> None:
    """Write the whole text, or nothing; print it for "-"."""
    if path == STDOUT:
        typer.echo(text)
        return
    from exactmesh.io.atomic import write_whole

    def write_to(stream: BinaryIO) -> None:
        stream.write(text.encode() + b"\n")

    write_whole({path: write_to})
