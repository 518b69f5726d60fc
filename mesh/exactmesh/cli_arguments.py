"""What the commands check about their arguments."""

import errno
import os
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from exactmesh.pslg import Carve

__all__ = ["carve_rule", "require_file"]


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
