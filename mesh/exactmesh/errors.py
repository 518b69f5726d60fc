"""What exactmesh raises beyond the kernel's errors; every message names the culprit."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from exactkernel.errors import CoordinateError, DegenerateError, ExactMeshError, NonFiniteError, ShapeError

if TYPE_CHECKING:
    from exactmesh.verify import Report

__all__ = [
    "CollinearPointsError",
    "CoordinateError",
    "DegenerateError",
    "ExactMeshError",
    "FileFormatError",
    "InadmissibleError",
    "NonFiniteError",
    "SeedError",
    "ShapeError",
    "TooFewPointsError",
    "TooManyPointsError",
    "TopologyError",
]


class TooFewPointsError(ExactMeshError):
    """Fewer than three points span no triangle."""


class TooManyPointsError(ExactMeshError):
    """More points than the edge numbers can hold."""


class CollinearPointsError(ExactMeshError):
    """All points lie on one line, or are one point: there is no triangle."""


class SeedError(ExactMeshError):
    """A seed is no integer, or a negative one."""


class TopologyError(ExactMeshError):
    """Indices that do not describe a triangulation, or an edge operation that the edge does not allow."""


class InadmissibleError(ExactMeshError):
    """The triangles are no triangulation of the points' hull; ``report`` says why, with witnesses."""

    def __init__(self, message: str, *, report: "Report", indices: Sequence[int] = ()) -> None:
        super().__init__(message, indices=indices)
        self.report = report


class FileFormatError(ExactMeshError):
    """A file cannot be read as what it should be: ``path``, and ``line`` (from 1) where the fault has one."""

    def __init__(self, message: str, *, path: str, line: int | None = None) -> None:
        place = path if line is None else f"{path}:{line}"
        super().__init__(f"{place}: {message}")
        self.path = path
        self.line = line
