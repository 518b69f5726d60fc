"""Bytes as numbers, arrays and objects: every string of bytes means something, and small ones mean small things."""

import struct
from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

__all__ = ["SPECIAL", "Cursor", "number_bytes", "table_bytes"]

#: What breaks geometry: not finite, subnormal, huge, neighbours of round numbers.
SPECIAL = (
    *(float("nan"), float("inf"), float("-inf"), -0.0, 5e-324, -5e-324, 2.2250738585072014e-308, 1e-300, 1e-160),
    *(1.7976931348623157e308, -1.7976931348623157e308, 1e308, 1e160, 2.0**53, 2.0**53 + 2, 2.0**31, 2.0**63, 1e18),
    *(0.1, 0.2, 0.30000000000000004, 1 / 3, 1.0000000000000002, 0.9999999999999999, 0.5, 1e-9, 1e9, 12.0000000000001),
    *(3.5, 2.0**-537, 2.0**-485, 2.0**511),
)
_SMALL, _FIRST_SPECIAL, _FIRST_RAW = 96, 192, 192 + len(SPECIAL)
_DTYPES = ("f8", "i4", "i8", "f4", "u8", "i1", "bool", "c16", "O", "U3", "f2", "u4")
_DEEPEST = 3


class Cursor:
    """Reads bytes from left to right; behind the end there are zeros."""

    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 0

    def byte(self) -> int:
        self.at += 1
        return self.data[self.at - 1] if self.at <= len(self.data) else 0

    def rest(self) -> bytes:
        start, self.at = self.at, len(self.data)
        return self.data[start:]

    def count(self, most: int) -> int:
        return self.byte() % (most + 1)

    def number(self) -> float:
        """Return a double: of one byte a small integer or a special one, of nine any at all."""
        tag = self.byte()
        if tag < _FIRST_SPECIAL:
            return float(tag - _SMALL)
        if tag < _FIRST_RAW:
            return SPECIAL[tag - _FIRST_SPECIAL]
        raw = bytes(self.byte() for _ in range(8))
        return float(struct.unpack("<d", raw)[0])

    def numbers(self, rows: int, width: int) -> npt.NDArray[np.float64]:
        return np.array([self.number() for _ in range(rows * width)], dtype=np.float64).reshape(rows, width)

    def indices(self, rows: int, width: int) -> npt.NDArray[np.int64]:
        """Return signed bytes: small, negative ones among them."""
        return np.array([self.byte() for _ in range(rows * width)], dtype=np.int64).reshape(rows, width) - 4

    def text(self, most: int) -> str:
        return bytes(self.byte() for _ in range(self.count(most))).decode("latin-1")

    def table(self, width: int, most: int, *, integers: bool) -> object:
        """Return rows as they should be, or in another type, or of another width, or something else altogether."""
        form = self.byte()
        rows = self.count(most)
        if form < 160:
            return self.indices(rows, width) if integers else self.numbers(rows, width)
        if form < 192:
            return (self.indices(rows, width) if integers else self.numbers(rows, width)).tolist()
        if form < 224:
            width = self.count(5)
            with np.errstate(all="ignore"):
                shaped: npt.NDArray[np.generic] = self.numbers(rows, width).astype(
                    _DTYPES[self.count(len(_DTYPES) - 1)]
                )
            return shaped
        return self.thing()

    def thing(self, depth: int = 0) -> object:
        """Return any object."""
        kind = self.count(11)
        if kind < 2:
            return (None, True)[kind]
        if kind in (2, 3):
            return self.byte() - 100 if kind == 2 else 10 ** self.byte()
        if kind in (4, 5):
            return self.number() if kind == 4 else self.text(8)
        if kind in (6, 7) and depth < _DEEPEST:
            made: Iterable[object] = [self.thing(depth + 1) for _ in range(self.count(4))]
            return made if kind == 6 else tuple(made)
        if kind == 8 and depth < _DEEPEST:
            return {self.text(4): self.thing(depth + 1) for _ in range(self.count(3))}
        if kind == 9:
            return np.ma.masked_array(self.numbers(2, 2), mask=[[self.byte() % 2 == 1, False], [False, False]])
        if kind == 10:
            return object()
        with np.errstate(all="ignore"):
            dtype = _DTYPES[self.count(len(_DTYPES) - 1)]
            return self.numbers(self.count(3), self.count(3)).astype(dtype)


def number_bytes(value: float) -> bytes:
    """Return bytes that :meth:`Cursor.number` reads as the value."""
    if value == int(value) and -_SMALL <= value < _FIRST_SPECIAL - _SMALL and not (value == 0 and str(value)[0] == "-"):
        return bytes([int(value) + _SMALL])
    return b"\xff" + struct.pack("<d", value)


def table_bytes(rows: npt.ArrayLike, *, integers: bool, form: bool = True) -> bytes:
    """Return bytes that :meth:`Cursor.table` reads as these rows."""
    array = np.asarray(rows)
    content = [bytes([v + 4]) if integers else number_bytes(float(v)) for v in array.ravel().tolist()]
    return (b"\0" if form else b"") + bytes([len(array)]) + b"".join(content)
