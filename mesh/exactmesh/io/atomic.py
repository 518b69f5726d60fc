"""Files are written whole or not at all."""

import os
import shutil
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from typing import BinaryIO

__all__ = ["Writer", "text_writer", "write_whole"]

#: Writes one file's content to a stream.
Writer = Callable[[BinaryIO], None]


def text_writer(text: Callable[[], Iterable[str]]) -> Writer:
    """Return what writes a text of ASCII, piece by piece."""

    def write_to(stream: BinaryIO) -> None:
        stream.writelines(piece.encode("ascii") for piece in text())

    return write_to


def _created(temporary: str, path: str) -> BinaryIO:
    """Open a new file; what prevents it is told of the path that the caller knows."""
    try:
        return open(temporary, "xb")
    except FileExistsError:
        raise  # this one is in the way
    except OSError as error:
        error.filename = path
        raise


def write_whole(files: Mapping[str, Writer]) -> None:
    """Write files beside their places, and move them there when all of them are complete.

    Raises:
        OSError: a file cannot be written; what stood at the paths is untouched.
    """
    finished: dict[str, str] = {}
    try:
        for path, write in files.items():
            place = os.path.realpath(path)  # a symbolic link stays one
            if os.path.isdir(place):
                raise IsADirectoryError(21, "Is a directory", path)
            temporary = f"{place}.{os.getpid()}.tmp"
            with _created(temporary, path) as stream:
                finished[place] = temporary  # ours only now
                write(stream)
            if os.path.exists(place):
                shutil.copymode(place, temporary)
        for place, temporary in finished.items():
            os.replace(temporary, place)
    finally:
        for temporary in finished.values():
            with suppress(OSError):
                os.remove(temporary)
