"""What the commands check about their arguments, and how their help shows them."""

import errno
import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Annotated, Protocol

import typer
from typer.core import TyperCommand, TyperGroup

if TYPE_CHECKING:
    from exactmesh.pslg import Carve

__all__ = ["MeshPath", "PlainCommand", "PlainGroup", "carve_rule", "require_file"]

MeshPath = Annotated[
    str, typer.Argument(metavar="MESH", help="A .ele (its .node beside it), .node, .poly, .npz; or what meshio reads.")
]


class PlainCommand(TyperCommand):
    """A command whose help shows flags without ``<bool>``, which looks as if they took a value."""

    def get_params(self, ctx):  # type: ignore[no-untyped-def]  # typer's own classes or click's, by its version
        """Return all options, with ``--help``."""
        options = super().get_params(ctx)
        _show_no_values(options)
        return options


class PlainGroup(TyperGroup):
    """The same of a command with commands in it."""

    def get_params(self, ctx):  # type: ignore[no-untyped-def]  # as above
        """Return all options, with ``--help``."""
        options = super().get_params(ctx)
        _show_no_values(options)
        return options


class _Shown(Protocol):
    metavar: str | None


def _show_no_values(options: Iterable[_Shown]) -> None:
    for option in options:
        if getattr(option, "is_flag", False) and option.metavar is None:
            option.metavar = ""


def require_file(path: str) -> None:
    """Say at once that a file is missing; what is in it is the reader's business."""
    if not os.path.exists(path):
        raise FileNotFoundError(errno.ENOENT, "no such file", path)


def carve_rule(word: str, *others: str) -> "Carve":
    """Return the rule for carving of that name; the message offers other words that the option takes besides."""
    from exactmesh.pslg import Carve

    if word not in tuple(Carve):
        raise typer.BadParameter(f"{word!r}; choose from {', '.join((*Carve, *others))}", param_hint="--carve")
    return Carve(word)
