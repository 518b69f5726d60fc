"""A folder for the files that readers are given."""

import functools
import os
import tempfile
from pathlib import Path

from proofs_tests.fuzzing.judging import require

from exactmesh.errors import FileFormatError, PSLGError

__all__ = ["STEM", "clean", "names_its_file"]

STEM = "given"


@functools.cache
def _folder(process: int) -> tuple[Path, tempfile.TemporaryDirectory[str]]:
    """Return a folder of the process, and what removes it in the end."""
    made = tempfile.TemporaryDirectory(prefix=f"fuzzing-{process}-")
    return Path(made.name), made


def clean(**contents: bytes) -> Path:
    """Empty the folder, put files ``given.node`` and so on into it, and return their path without suffix."""
    folder = _folder(os.getpid())[0]
    for old in folder.iterdir():
        old.unlink()
    for suffix, content in contents.items():
        (folder / f"{STEM}.{suffix}").write_bytes(content)
    return folder / STEM


def names_its_file(error: FileFormatError | PSLGError) -> None:
    """Demand that an error of a file names it, and a line that is there."""
    path = error.path
    require(path is not None and path in str(error), f"{error} names no file")
    line = getattr(error, "line", None)
    if line is not None and path is not None:
        text = Path(path).read_bytes().replace(b"\r\n", b"\n").replace(b"\r", b"\n")
        require(1 <= line <= text.count(b"\n") + 1, f"{error}: there is no line {line}")
