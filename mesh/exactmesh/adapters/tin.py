"""The text of ``.wkt`` files: meshio's own pattern tries exponentially many ways to read one that is broken."""

import re

from exactmesh.errors import FileFormatError
from exactmesh.io.text import read_bytes

__all__ = ["require_tin"]

# meshio's pattern, word by word, but none of its parts gives back what it took: what this one matches at the first
# attempt, meshio's does, and what it refuses, meshio's would refuse in the end
_NUMBER = r"[+-]?(?>\d+\.?\d*|\d*\.?\d+)"
_POINT = rf"{_NUMBER}\s++{_NUMBER}\s++{_NUMBER}(?:\s++{_NUMBER})?+"
_TRIANGLE = r"\(\s*+\(\s*+" + r"\s*+,\s*+".join([_POINT] * 4) + r"\s*+\)\s*+\)"
_TIN = re.compile(rf"\s*+TIN\s*+\((?:\s*+{_TRIANGLE}\s*+,?+)*+\s*+\)")


def require_tin(path: str) -> None:
    """Refuse a text that is no TIN of triangles in space. Linear time.

    Raises:
        FileFormatError: it is none.
    """
    text = read_bytes(path).decode("utf-8", errors="replace")
    if _TIN.match(text) is None:
        raise FileFormatError(
            "is no TIN ((( x y z, x y z, x y z, x y z )), ...) in numbers without exponents", path=path
        )
