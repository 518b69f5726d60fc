"""A folder for the files that readers are given."""

import atexit
import functools
import tempfile
from pathlib import Path

from exactmesh.errors import FileFormatError, PSLGError
from proofs_tests.fuzzing.judging import require

__all__ = ["STEM", "clean", "folder", "names_its_file"]

STEM = "given"


@functools.cache
def folder() -> Path:
    """Return a folder of this process."""
    made = tempfile.TemporaryDirectory(prefix="fuzzing")
    atexit.register(made.cleanup)
    return Path(made.name)


def clean(**contents: bytes) -> Path:
    """Empty the folder, put files ``given.node`` and so on into it, and return their path without suffix."""
    for old in folder().iterdir():
        old.unlink()
    for suffix, content in contents.items():
        (folder() / f"{STEM}.{suffix}").write_bytes(content)
    return folder() / STEM


def names_its_file(error: FileFormatError | PSLGError) -> None:
    """Demand that an error of a file names it, and a line that is there."""
    path = error.path
    require(path is not None and path in str(error), f"{error} names no file")
    line = getattr(error, "line", None)
    if line is not None and path is not None:
        text = Path(path).read_bytes().replace(b"\r\n", b"\n").replace(b"\r", b"\n")
        require(1 <= line <= text.count(b"\n") + 1, f"{error}: there is no line {line}")
