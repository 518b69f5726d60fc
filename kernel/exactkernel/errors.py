"""What the library raises: one base class, and the culprit named in every message."""

from collections.abc import Callable, Sequence

__all__ = [
    "BoundError",
    "CoordinateError",
    "DegenerateError",
    "ExactMeshError",
    "NonFiniteError",
    "ShapeError",
    "shown",
]

_LONGEST = 120


def shown(value: object) -> str:
    """Return the repr of an argument, cut where it is long; Python refuses integers of 4300 digits."""
    try:
        text = repr(value)
    except ValueError:
        return f"<{type(value).__name__} with too many digits to print>"
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 20]}...{text[-17:]}"


class ExactMeshError(ValueError):
    """Base of every error that exactkernel and exactmesh raise on bad input.

    ``indices`` names the offending items of the input (empty where the fault has no index).
    """

    def __init__(self, message: str, *, indices: Sequence[int] = ()) -> None:
        super().__init__(message)
        self.indices = tuple(int(i) for i in indices)

    def __reduce__(self) -> tuple[Callable[..., "ExactMeshError"], tuple[object, ...]]:
        # Exception's own would call the class with the message alone, and subclasses ask for more
        return _remade, (type(self), self.args, self.__dict__)


def _remade(kind: type[ExactMeshError], args: tuple[object, ...], state: dict[str, object]) -> ExactMeshError:
    error = kind.__new__(kind, *args)
    error.__dict__.update(state)
    return error


class CoordinateError(ExactMeshError):
    """A coordinate is no number, or a number that would have to be rounded."""


class NonFiniteError(CoordinateError):
    """A coordinate is NaN or infinite."""


class ShapeError(ExactMeshError):
    """An array or a point has the wrong shape."""


class BoundError(ExactMeshError):
    """A bound on angles, areas or lengths is no number, or lies outside its range."""


class DegenerateError(ExactMeshError):
    """The construction does not exist: collinear corners, parallel lines, a result beyond the doubles."""
