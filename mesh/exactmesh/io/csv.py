"""``.csv``: points, in columns that a header names, or in two columns without one."""

import csv
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from exactmesh.io.model import Mesh
from exactmesh.io.text import TextFile, fast_table, is_decimal, rows_of_text

__all__ = ["csv_text", "read_csv"]

_WHOLE_LINE = r"(?m)^[ \t]*#[^\n]*"  # a # further on may be part of a name


def read_csv(path: str) -> Mesh:
    """Return the points of a ``.csv`` file, separated by ``;``, ``,`` or white space, as its first line is.

    With a header: the columns ``x`` and ``y``; columns whose names start with ``attribute``, in their order;
    integers in ``marker``; other columns are skipped. Without: exactly two columns, x and y. Blank lines, and
    lines that start with ``#``, are skipped. Linear time.

    Raises:
        FileFormatError: where and what.
    """
    file = TextFile.load(path, comment=_WHOLE_LINE)
    first = next((k for k, text in enumerate(file.lines) if text.strip()), None)
    if first is None:
        raise file.fault("is empty: no points")
    separator = next((mark for mark in ";," if mark in file.lines[first]), None)
    head = _fields(file.lines[first], separator)
    if all(is_decimal(field) for field in head):
        if len(head) != 2:
            raise file.fault(
                f"{len(head)} columns and no header; name the columns x and y in a first line", line=first + 1
            )
        return _mesh(_columns(file, first, separator, ["x", "y"]))
    names = [field.casefold() for field in head]
    if names.count("x") != 1 or names.count("y") != 1:
        raise file.fault("is neither a point nor a header that names one column x and one y", line=first + 1)
    return _mesh(_columns(file, first + 1, separator, names))


def _mesh(columns: dict[str, npt.NDArray[np.generic]]) -> Mesh:
    attributes = [column for name, column in columns.items() if name.startswith("attribute")]
    return Mesh(
        np.column_stack([columns["x"], columns["y"]]),
        point_attributes=np.column_stack(attributes) if attributes else None,
        point_markers=columns.get("marker"),
    )


def _type_of(name: str) -> type | None:
    if name in ("x", "y") or name.startswith("attribute"):
        return float
    return int if name == "marker" else None


def _columns(file: TextFile, start: int, separator: str | None, names: list[str]) -> dict[str, npt.NDArray[np.generic]]:
    kept = {k: (name, kind) for k, name in enumerate(names) if (kind := _type_of(name)) is not None}
    if len({name for name, _ in kept.values()}) != len(kept):
        raise file.fault("two columns of the same name", line=start)
    if len(kept) == len(names):
        dtype = np.dtype([(name, "f8" if kind is float else "i8") for name, kind in kept.values()])
        rows = fast_table(file.lines[start:], dtype, separator)
        if rows is not None:
            return {name: rows[name] for name in names}
    values: list[list[int | float]] = [[] for _ in kept]
    for line, fields in _records(file, start, separator):
        if len(fields) != len(names):
            raise file.fault(f"{len(fields)} fields in a table of {len(names)} columns", line=line)
        for column, (k, (_, kind)) in zip(values, kept.items(), strict=True):
            column.append(file.number(fields[k], kind, line))
    return {
        name: np.array(column, dtype=np.float64 if kind is float else np.int64)
        for column, (name, kind) in zip(values, kept.values(), strict=True)
    }


def _fields(text: str, separator: str | None) -> list[str]:
    if separator is None:
        return text.split()
    return [field.strip() for field in next(csv.reader([text], delimiter=separator, skipinitialspace=True))]


def _records(file: TextFile, start: int, separator: str | None) -> Iterator[tuple[int, list[str]]]:
    """Yield (line number, fields) of the rows, one Python step a row: quotes and text are allowed."""
    if separator is None:
        yield from ((k + 1, file.lines[k].split()) for k in range(start, len(file.lines)) if file.lines[k].strip())
        return
    reader = csv.reader(file.lines[start:], delimiter=separator, skipinitialspace=True)
    try:
        for fields in reader:
            if fields and (len(fields) > 1 or fields[0].strip()):
                yield start + reader.line_num, [field.strip() for field in fields]
    except csv.Error as error:
        raise file.fault(str(error), line=start + reader.line_num) from None


def csv_text(mesh: Mesh) -> Iterator[str]:
    """Yield the text of a ``.csv`` file of the points, that :func:`read_csv` reads back bit for bit."""
    a = 0 if mesh.point_attributes is None else mesh.point_attributes.shape[1]
    names = [
        "x",
        "y",
        *(f"attribute{k}" for k in range(a)),
        *(["marker"] if mesh.point_markers is not None else []),
    ]
    yield ",".join(names) + "\n"
    columns = [mesh.points, mesh.point_attributes, mesh.point_markers]
    yield from rows_of_text((column for column in columns if column is not None), ",")
