"""Tables of numbers in text files: read by numpy when all is well, line by line to say what is wrong."""

import math
import os
import re
import stat
import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import chain, islice

import numpy as np
import numpy.typing as npt

from exactmesh.errors import FileFormatError

__all__ = ["Table", "TextFile", "fast_table", "is_decimal", "read_bytes", "rows_of_text"]

#: One record a row of the file.
Table = npt.NDArray[np.void]

_NUMBER_LIKE = re.compile(r"[0-9.+-]")
_INTEGER = re.compile(r"[+-]?[0-9]{1,18}")
_DECIMAL = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
_SHOWN = 40  # characters of a bad field that a message repeats
_FLOAT = "%r"  # the shortest decimal that reads back as the same double
_ROWS_AT_ONCE = 1 << 15  # rows that are formatted in one go


def read_bytes(path: str) -> bytes:
    """Return what a regular file holds.

    Raises:
        FileFormatError: there is no such file, it is a folder or a device, or it may not be read.
    """
    try:
        mode = os.stat(path).st_mode
        if stat.S_ISDIR(mode):
            raise FileFormatError("is a folder, not a file", path=path)
        if not stat.S_ISREG(mode):
            raise FileFormatError("is not a regular file", path=path)
        with open(path, "rb") as stream:
            return stream.read()
    except FileNotFoundError:
        raise FileFormatError("no such file", path=path) from None
    except OSError as error:
        raise FileFormatError(f"cannot be read: {error.strerror or error}", path=path) from None
    except ValueError as error:  # a NUL in the path
        raise FileFormatError(str(error), path=repr(path)) from None


def _unix_newlines(data: bytes) -> bytes:
    return data.replace(b"\r\n", b"\n").replace(b"\r", b"\n") if b"\r" in data else data


def _decoded(path: str) -> str:
    data = _unix_newlines(read_bytes(path)).removeprefix(b"\xef\xbb\xbf")
    binary = data.find(b"\0")
    if binary >= 0:
        line = data.count(b"\n", 0, binary) + 1
        raise FileFormatError("holds a NUL byte: a binary file, not text", path=path, line=line)
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise FileFormatError(f"is not UTF-8 text: byte 0x{data[error.start]:02x}", path=path, line=line) from None


def _shown(field: str) -> str:
    return ascii(field if len(field) <= _SHOWN else field[:_SHOWN] + "...")


@dataclass(frozen=True)
class TextFile:
    """The lines of a text file without their comments; line k of the file is ``lines[k - 1]``.

    A file of several sections, each with a header of its own, is read section by section: ``first`` is where the
    present one begins, and :meth:`section` returns the rest of the file beside the table.
    """

    path: str
    lines: list[str]
    first: int = 0

    @classmethod
    def load(cls, path: str, comment: str = r"#[^\n]*") -> "TextFile":
        """Read a text file and take its comments out.

        Raises:
            FileFormatError: it cannot be read, is binary, or is not UTF-8.
        """
        text = _decoded(path)
        return cls(path, (re.sub(comment, "", text) if "#" in text else text).split("\n"))

    @classmethod
    def of(cls, source: "str | TextFile") -> "TextFile":
        """Return the file at a path, or the one that is there already."""
        return cls.load(source) if isinstance(source, str) else source

    @classmethod
    def from_text(cls, text: str, name: str) -> "TextFile":
        """Return a text that was read from elsewhere, without its comments; ``name`` stands for it in messages."""
        return cls(name, re.sub(r"#[^\n]*", "", text.replace("\r\n", "\n").replace("\r", "\n")).split("\n"))

    def fault(self, message: str, *, line: int | None = None) -> FileFormatError:
        """Return the error that says where and what."""
        return FileFormatError(message, path=self.path, line=line)

    def data_lines(self) -> Iterator[tuple[int, list[str]]]:
        """Yield (line number, fields) of each line with something like a number; Triangle skips others."""
        for line, text in enumerate(islice(self.lines, self.first, None), start=self.first + 1):
            if _NUMBER_LIKE.search(text):
                yield line, text.split()

    def line_of(self, row: int) -> int:
        """Return the line of a row of the table, row 0 being the first one after the header."""
        return next(islice(self.data_lines(), row + 1, None))[0]

    def header(self, names: tuple[str, ...], defaults: tuple[int, ...]) -> list[int]:
        """Return the integers of the first data line; fields that are missing at its end take their defaults.

        Raises:
            FileFormatError: there is no such line, or it holds other things or more of them.
        """
        line, fields = next(self.data_lines(), (0, []))
        if not fields:
            fault = f"ends where the {names[0]} belongs" if self.first else "is empty: no header line"
            raise self.fault(fault)
        if len(fields) > len(names):
            raise self.fault(f"the header has {len(fields)} fields, expected {' '.join(names)}", line=line)
        values = list(defaults)
        for k, field in enumerate(fields):
            if not _INTEGER.fullmatch(field):
                raise self.fault(f"{names[k]} is {_shown(field)}, not an integer", line=line)
            values[k] = int(field)
            if values[k] < 0:
                raise self.fault(f"{names[k]} is {field}: negative", line=line)
        return values

    def row_type(
        self,
        count: int,
        what: str,
        *,
        reals: int = 0,
        integers: int = 0,
        attributes: int = 0,
        markers: int = 0,
    ) -> np.dtype[np.void]:
        """Return the type of a row ``number reals... integers... attributes... marker``.

        Raises:
            FileFormatError: the first row has not that many fields (so no header can ask for a gigantic
                type).
        """
        expected = 1 + reals + integers + attributes + markers
        width = self.width()
        if count and width and width != expected:
            raise self.fault(
                f"{width} fields, where the header announces {expected} for each {what}", line=self.line_of(0)
            )
        attributes = attributes if count and width else 0
        return np.dtype(
            [
                ("number", "i8"),
                ("reals", "f8", (reals,)),
                ("integers", "i8", (integers,)),
                ("attributes", "f8", (attributes,)),
                *([("marker", "i8")] if markers else []),
            ]
        )

    def width(self) -> int:
        """Return the number of fields in the first row below the header, 0 if there is none."""
        return len(next(islice(self.data_lines(), 1, None), (0, []))[1])

    def numbered(self, numbers: npt.NDArray[np.int64], base: int, what: str) -> None:
        """Refuse rows that are not numbered base, base + 1, and so on.

        Raises:
            FileFormatError: a number is missing, repeated or out of order; ``line`` is the first such row's.
        """
        wrong = np.flatnonzero(numbers != np.arange(base, base + len(numbers)))
        if wrong.size:
            row = int(wrong[0])
            raise self.fault(
                f"{what} {numbers[row]} where {what} {base + row} belongs: numbers count up from {base}",
                line=self.line_of(row),
            )

    def in_range(self, indices: npt.NDArray[np.int64], low: int, high: int, what: str) -> None:
        """Refuse a table of numbers that are not all in low, ..., high.

        Raises:
            FileFormatError: ``line`` is the first such row's.
        """
        wrong = (indices < low) | (indices > high)
        if wrong.any():
            row = int(np.flatnonzero(wrong.any(axis=1))[0])
            culprit = indices[row][wrong[row]][0]
            allowed = f"{low} to {high}" if low <= high else "none"
            raise self.fault(f"{what} {culprit} does not exist; there are {allowed}", line=self.line_of(row))

    def table(self, dtype: np.dtype[np.void], count: int) -> Table:
        """Return the rows below the header, exactly ``count`` of them, and each with the fields of ``dtype``.

        Nothing is allocated on the word of the header. Linear time; per-line Python only when something is
        wrong.

        Raises:
            FileFormatError: a field is no number or not finite, a row is too short or too long, or the count
                is off.
        """
        fields = _leaves(dtype)
        if count and self.width():
            start = next(self.data_lines())[0]
            rows = fast_table(islice(self.lines, start, None), dtype)
            if rows is not None and len(rows) == count:
                return rows
        return self._slow_table(dtype, fields, count)

    def section(self, dtype: np.dtype[np.void], count: int) -> "tuple[Table, TextFile]":
        """Return ``count`` rows below the header, and the rest of the file, which begins with another header.

        As careful and as fast as :meth:`table`.

        Raises:
            FileFormatError: as for :meth:`table`; a row that is missing shows in the line that stands in its place.
        """
        header = next(self.data_lines())[0]
        stop = min(header + count, len(self.lines))
        rows = fast_table(self.lines[header:stop], dtype) if count and self.width() else None
        if rows is None or len(rows) != count:  # something is wrong, or there are blank lines
            stop = next((line for line, _ in islice(self.data_lines(), count, count + 1)), len(self.lines))
            part = replace(self, lines=self.lines[:stop])
            rows = part.table(dtype, count)
        return rows, replace(self, first=stop)

    def end(self) -> None:
        """Refuse more content.

        Raises:
            FileFormatError: there is more to read.
        """
        for line, _ in self.data_lines():
            raise self.fault("content after the last section", line=line)

    def _slow_table(self, dtype: np.dtype[np.void], fields: list[type], count: int) -> Table:
        rows: list[tuple[int | float, ...]] = []
        last = 0
        for last, row in self.data_lines():
            rows.append(self._values(row, fields, last) if rows else ())
            if len(rows) > count + 1:
                raise self.fault(f"row {count + 1}, where the header announces {count}", line=last)
        if len(rows) <= count:
            raise self.fault(f"the header announces {count} rows, the file ends after {len(rows) - 1}", line=last)
        table = np.zeros(count, dtype=dtype)
        flat = [("", "f8" if field is float else "i8") for field in fields]
        table.view(np.dtype(flat))[:] = rows[1:]
        return table

    def _values(self, row: list[str], fields: list[type], line: int) -> tuple[int | float, ...]:
        if len(row) != len(fields):
            raise self.fault(f"{len(row)} fields in a row of {len(fields)}", line=line)
        return tuple(self.number(text, field, line) for text, field in zip(row, fields, strict=True))

    def number(self, text: str, field: type, line: int) -> int | float:
        """Return a field as an int or a float.

        Raises:
            FileFormatError: it is none, or beyond the largest double.
        """
        if field is int:
            if not _INTEGER.fullmatch(text):
                raise self.fault(f"{_shown(text)} is not an integer", line=line)
            return int(text)
        if not _DECIMAL.fullmatch(text):
            raise self.fault(f"{_shown(text)} is not a finite decimal number", line=line)
        value = float(text)
        if not math.isfinite(value):
            raise self.fault(f"{_shown(text)} is beyond the largest double", line=line)
        return value


def _leaves(dtype: np.dtype[np.void]) -> list[type]:
    """The type of each number of a row, sub-arrays spelled out."""
    leaves: list[type] = []
    for name in dtype.names or ():
        field = dtype[name]
        leaves += [float if field.base.kind == "f" else int] * math.prod(field.shape)
    return leaves


def is_decimal(text: str) -> bool:
    """Tell whether a field is a decimal number, integers included."""
    return _DECIMAL.fullmatch(text) is not None


def fast_table(lines: Iterable[str], dtype: np.dtype[np.void], delimiter: str | None = None) -> Table | None:
    """Parse with numpy; None where it stumbles or meets NaN or infinity, for the slow path to explain."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # numpy warns where it reads an integer out of a float, or finds no row
            table = np.loadtxt(lines, dtype=dtype, comments=None, delimiter=delimiter, ndmin=1)
    except (ValueError, Warning):
        return None
    for name in dtype.names or ():
        if dtype[name].base.kind == "f" and not np.isfinite(table[name]).all():
            return None
    return table


def rows_of_text(columns: Iterable[npt.NDArray[np.generic]], separator: str = " ") -> Iterator[str]:
    """Yield a table as text, some thousands of rows at once; floats in the shortest form that reads back.

    >>> import numpy as np
    >>> "".join(rows_of_text([np.array([1, 2]), np.array([[0.1, -0.0], [1e300, 5e-324]])]))
    '1 0.1 -0.0\\n2 1e+300 5e-324\\n'
    """
    flat = [column for block in columns for column in (block.T if block.ndim == 2 else [block])]
    form = separator.join(_FLOAT if column.dtype.kind == "f" else "%d" for column in flat) + "\n"
    for start in range(0, len(flat[0]), _ROWS_AT_ONCE):
        chunk = [column[start : start + _ROWS_AT_ONCE].tolist() for column in flat]
        yield (form * len(chunk[0])) % tuple(chain.from_iterable(zip(*chunk, strict=True)))
