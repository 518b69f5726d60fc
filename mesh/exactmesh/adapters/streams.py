"""Open files whose end cannot be read for ever: some of meshio's readers wait for a line that a cut off file lacks."""

import io

__all__ = ["ByteStream", "TextStream"]

_PATIENCE = 1000  # reads at the end; a reader that stops at all needs one


class TextStream(io.TextIOWrapper):
    """A text file that raises EOFError when it is read at its end again and again."""

    def __init__(self, path: str) -> None:
        super().__init__(io.BufferedReader(io.FileIO(path)), encoding="utf-8")
        self._vain = 0

    def readline(self, size: int = -1, /) -> str:  # type: ignore[override]  # as io's, but for names
        """Return the next line, "" at the end."""
        line = super().readline(size)
        self._vain = 0 if line else self._vain + 1
        if self._vain > _PATIENCE:
            raise EOFError("the file ends too early")
        return line


class ByteStream(io.BufferedReader):
    """The same of bytes."""

    def __init__(self, path: str) -> None:
        super().__init__(io.FileIO(path))
        self._vain = 0

    def readline(self, size: int | None = -1, /) -> bytes:
        """Return the next line, b"" at the end."""
        return self._counted(super().readline(size), size)

    def read(self, size: int | None = -1, /) -> bytes:
        """Return so many bytes, or all, b"" at the end."""
        return self._counted(super().read(size), size)

    def _counted(self, content: bytes, size: int | None) -> bytes:
        self._vain = 0 if content or size == 0 else self._vain + 1
        if self._vain > _PATIENCE:
            raise EOFError("the file ends too early")
        return content
