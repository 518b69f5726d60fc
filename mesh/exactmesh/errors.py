"""What exactmesh raises beyond the kernel's errors; every message names the culprit."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from exactkernel.errors import CoordinateError, DegenerateError, ExactMeshError, NonFiniteError, ShapeError

if TYPE_CHECKING:
    from exactmesh.verify import Report

__all__ = [
    "ChoiceError",
    "CollinearPointsError",
    "ConstrainedVertexError",
    "CoordinateError",
    "CrossingError",
    "DegenerateError",
    "ExactMeshError",
    "Fault",
    "FaultKind",
    "FileFormatError",
    "GeometryError",
    "InadmissibleError",
    "NonFiniteError",
    "PSLGError",
    "SeedError",
    "ShapeError",
    "TooFewPointsError",
    "TooManyCrossingsError",
    "TooManyPointsError",
    "TopologyError",
]


class ChoiceError(ExactMeshError):
    """An argument that must be one of a few words is another."""


class TooFewPointsError(ExactMeshError):
    """Fewer than three points span no triangle."""


class TooManyCrossingsError(ExactMeshError):
    """So many segments meet that the answer would not fit into memory."""


class TooManyPointsError(ExactMeshError):
    """More points than the edge numbers can hold."""


class CollinearPointsError(ExactMeshError):
    """All points lie on one line, or are one point: there is no triangle."""


class ConstrainedVertexError(ExactMeshError):
    """A vertex cannot be deleted, for it lies on segments: ``indices`` names them."""


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


class GeometryError(ExactMeshError):
    """Geometry from elsewhere that is none of the plane, or that its format cannot hold."""


class FaultKind(StrEnum):
    """What can be wrong with a planar straight line graph; the comments say what ``Fault.indices`` are."""

    BAD_INDEX = "bad index"  # (segment,)
    ZERO_LENGTH = "zero length"  # (segment,)
    REPEATED_SEGMENT = "repeated segment"  # (first segment, later one)
    HOLE_NOT_FINITE = "hole not finite"  # (hole,)
    HOLE_ON_SEGMENT = "hole on a segment"  # (hole, segment)
    HOLE_OUTSIDE = "hole outside"  # (hole,)
    REGION_NOT_FINITE = "region not finite"  # (region,)
    REGION_ON_SEGMENT = "region on a segment"  # (region, segment)
    REGION_OUTSIDE = "region outside"  # (region,)
    REGIONS_DISAGREE = "regions disagree"  # (first region, later one)
    NOT_CLOSED = "not closed"  # (segment,), or () where there is none
    INCONSISTENT_PARITY = "inconsistent parity"  # (point,)
    EMPTY_DOMAIN = "empty domain"  # ()
    RING_TOO_SHORT = "ring too short"  # (ring,)
    NOT_A_RING = "not a ring"  # (point,)


_REMEDIES = {
    FaultKind.BAD_INDEX: "segments count points from 0",
    FaultKind.ZERO_LENGTH: "leave it out",
    FaultKind.REPEATED_SEGMENT: "leave one out",
    FaultKind.HOLE_NOT_FINITE: "give finite coordinates",
    FaultKind.HOLE_ON_SEGMENT: "move it into the face that is to be a hole",
    FaultKind.HOLE_OUTSIDE: "what lies outside needs no hole: leave it out",
    FaultKind.REGION_NOT_FINITE: "give finite numbers; a negative area means unlimited",
    FaultKind.REGION_ON_SEGMENT: "move it into the face that it labels",
    FaultKind.REGION_OUTSIDE: "move it into the domain, or leave it out",
    FaultKind.REGIONS_DISAGREE: "give them the same attribute and area, or a segment between them",
    FaultKind.NOT_CLOSED: "close the outline, or keep the hull with carve=False",
    FaultKind.INCONSISTENT_PARITY: "close the rings, or carve by seeds",
    FaultKind.EMPTY_DOMAIN: "look at the rule and the holes, or keep the hull with carve=False",
    FaultKind.RING_TOO_SHORT: "a ring needs three vertices at different positions",
    FaultKind.NOT_A_RING: "in a union of rings each point is the end of two segments, or of none",
}
_NAMED = 3  # faults of a kind that a message spells out


@dataclass(frozen=True, slots=True)
class Fault:
    """One thing that is wrong with a PSLG: its kind, the indices of the culprits (see the kind), and a sentence."""

    kind: FaultKind
    indices: tuple[int, ...]
    message: str

    def __str__(self) -> str:
        return self.message


class PSLGError(ExactMeshError):
    """A planar straight line graph with faults: all of them in ``faults``, by kind; the message names the first ones.

    ``indices`` are the first index of each fault of the first kind; ``path`` is the file that it came from, or None.
    All indices count from 0; where the file counts from ``base`` 1, the message says so.
    """

    def __init__(self, faults: Sequence[Fault], *, path: str | None = None, base: int = 0) -> None:
        place = "" if path is None else f"{path}: "
        note = f" [numbers here count from 0, those in the file from {base}]" if base else ""
        super().__init__(
            place + "; ".join(_summaries(faults)) + note,
            indices=[i for fault in faults if fault.kind is faults[0].kind for i in fault.indices[:1]],
        )
        self.faults = tuple(faults)
        self.path = path


def _summaries(faults: Sequence[Fault]) -> Iterator[str]:
    for kind, group in groupby(faults, key=lambda fault: fault.kind):
        alike = list(group)
        named = ", ".join(fault.message for fault in alike[:_NAMED])
        more = f" and {len(alike) - _NAMED} more" if len(alike) > _NAMED else ""
        yield f"{named}{more} ({_REMEDIES[kind]})"


class CrossingError(ExactMeshError):
    """Segments cross, and nobody asked to split them: ``pairs`` (k, 2) are their rows, int64, all of them.

    ``indices`` are the segments that cross another, each once.
    """

    def __init__(self, pairs: npt.ArrayLike) -> None:
        crossing = np.array(pairs, dtype=np.int64).reshape(-1, 2)
        named = ", ".join(f"{i} and {j}" for i, j in crossing[:_NAMED].tolist())
        more = f" and {len(crossing) - _NAMED} more pairs" if len(crossing) > _NAMED else ""
        super().__init__(
            f'segments cross: {named}{more} (crossings="split" makes their crossings vertices)',
            indices=np.unique(crossing).tolist(),
        )
        self.pairs = crossing
