"""``.area``: the largest area that each triangle may have when it is refined."""

import os
from collections.abc import Iterator

import numpy as np

from exactkernel.types import FloatArray
from exactmesh.columns import attributes_of
from exactmesh.io.atomic import text_writer, write_whole
from exactmesh.io.text import TextFile, rows_of_text

__all__ = ["area_text", "read_area", "read_areas", "write_areas"]


def read_areas(path: "str | os.PathLike[str]") -> FloatArray:
    """Read the largest area of each triangle, float64 (m,), from a ``.area`` file; not positive is unlimited.

    Raises:
        FileFormatError: the file is missing or broken; it says where and what.
    """
    return read_area(os.fspath(path))


def write_areas(path: "str | os.PathLike[str]", areas: FloatArray, *, base: int = 0) -> None:
    """Write the largest area of each triangle, so that :func:`read_areas` reads it back bit for bit.

    Args:
        path: a ``.area`` file, beside the ``.node`` and ``.ele`` that it belongs to.
        areas: (m,), one a triangle; not positive is unlimited.
        base: 0 or 1, what those files count from.

    Raises:
        ShapeError, NonFiniteError: the areas are no finite numbers, one a triangle.
        OSError: the folder is missing, the disk full, and so on.

    >>> import os, tempfile
    >>> folder = tempfile.TemporaryDirectory()
    >>> path = os.path.join(folder.name, "a.area")
    >>> write_areas(path, np.array([0.1, -1.0]))
    >>> read_areas(path).tolist()
    [0.1, -1.0]
    >>> folder.cleanup()
    """
    column = attributes_of(np.reshape(areas, (-1, 1)), "areas")
    given = np.zeros(0) if column is None else column.reshape(-1)
    write_whole({os.fspath(path): text_writer(lambda: area_text(given, base))})


def read_area(path: str | TextFile) -> FloatArray:
    """Return the areas (m,) of a ``.area`` file; what is not positive is unlimited.

    Header ``N``, then N rows ``i area``, numbered from 0 or 1. Linear time.

    Raises:
        FileFormatError: where and what.
    """
    file = TextFile.of(path)
    (count,) = file.header(("number of triangles",), (0,))
    rows = file.table(file.row_type(count, "triangle", reals=1), count)
    file.numbered(rows["number"], 1 if rows["number"][:1].tolist() == [1] else 0, "triangle")
    areas: FloatArray = rows["reals"].reshape(-1)
    return areas


def area_text(areas: FloatArray, base: int) -> Iterator[str]:
    """Yield the text of a ``.area`` file that :func:`read_area` reads back bit for bit."""
    yield f"{len(areas)}\n"
    yield from rows_of_text([np.arange(base, base + len(areas)), areas])
