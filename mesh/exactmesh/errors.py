"""What exactmesh raises beyond the kernel's errors; every message names the culprit."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from exactkernel.errors import (
    BoundError,
    CoordinateError,
    DegenerateError,
    ExactMeshError,
    NonFiniteError,
    ShapeError,
)

if TYPE_CHECKING:
    from exactmesh.verify import Report

__all__ = [
    "AdapterError",
    "BoundError",
    "CertificateError",
    "ChoiceError",
    "ClipError",
    "CollinearPointsError",
    "ConflictingValuesError",
    "ConstrainedVertexError",
    "CoordinateError",
    "CrossingError",
    "DegenerateError",
    "ExactMeshError",
    "Fault",
    "FaultKind",
    "FileFormatError",
    "GeometryError",
    "HypothesisUnavailableError",
    "InadmissibleError",
    "MesherError",
    "NonFiniteError",
    "NotConformingError",
    "NotDelaunayError",
    "OptionError",
    "PSLGError",
    "SeedError",
    "ShapeError",
    "SnappingError",
    "TooFewPointsError",
    "TooManyCrossingsError",
    "TooManyPointsError",
    "TopologyError",
]


class AdapterError(ExactMeshError):
    """An object that is no mesh of triangles and quadrilaterals in the plane; ``indices`` are the culprits in it."""


class CertificateError(ExactMeshError):
    """What should be a certificate is none, or is about more than was given, or less."""


class ChoiceError(ExactMeshError):
    """An argument that must be one of a few words is another."""


class OptionError(ExactMeshError):
    """An option is out of range, or of the wrong kind."""


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


class NotDelaunayError(ExactMeshError):
    """A triangulation that has to be Delaunay is not: ``indices`` are the ends of an edge."""


class NotConformingError(ExactMeshError):
    """A circumcentre lies beyond an edge of the boundary: ``indices`` are the ends of that edge."""


class ClipError(ExactMeshError):
    """A window that is no box and no convex polygon, or points that should lie inside of it: ``indices`` names them."""


class ConflictingValuesError(ExactMeshError):
    """Points at the same position have different values: ``indices`` are two of them."""


class SeedError(ExactMeshError):
    """A seed is no integer, or a negative one."""


class SnappingError(ExactMeshError):
    """A grid is too coarse for a PSLG: something in it is smaller than the cells.

    ``merged`` (k, 2) are points at different places that share a cell; ``run_over`` (k, 2) are rows (segment, point)
    where the segment passes the cell of a point that is not on it; ``holes`` and ``regions`` are seeds of which a
    segment passes the cell. All int64, all of them, counted from 0. ``indices`` are the first of these groups that is
    not empty: points or seeds.
    """

    def __init__(
        self,
        spacing: float,
        *,
        merged: npt.NDArray[np.int64],
        run_over: npt.NDArray[np.int64],
        holes: npt.NDArray[np.int64],
        regions: npt.NDArray[np.int64],
    ) -> None:
        groups = (
            ("points {} and {} share a cell", merged, merged[:, 1]),
            ("segment {} passes the cell of point {}", run_over, run_over[:, 1]),
            ("a segment passes the cell of hole {}", holes[:, None], holes),
            ("a segment passes the cell of region {}", regions[:, None], regions),
        )
        found = [(text, rows, culprits) for text, rows, culprits in groups if len(rows)]
        told = []
        for text, rows, _ in found:
            more = f" and {len(rows) - _NAMED} more" if len(rows) > _NAMED else ""
            told.append(", ".join(text.format(*row) for row in rows[:_NAMED].tolist()) + more)
        super().__init__(
            f"grid of spacing {spacing} too coarse: {'; '.join(told)} (take more bits, or merge what should be one)",
            indices=np.unique(found[0][2]).tolist() if found else (),
        )
        self.merged, self.run_over, self.holes, self.regions = merged, run_over, holes, regions


class TopologyError(ExactMeshError):
    """Indices that do not describe a triangulation, or an edge operation that the edge does not allow."""


class MesherError(ExactMeshError):
    """A mesher that cannot be put to the test: it cannot be found, imported or called in a process of its own."""


class HypothesisUnavailableError(ExactMeshError, ImportError):
    """hypothesis, which draws the inputs of :mod:`exactmesh.strategies`, is not installed."""


class InadmissibleError(ExactMeshError):
    """The triangles are no triangulation of the points' hull; ``report`` says why, with witnesses."""

    def __init__(self, message: str, *, report: Report, indices: Sequence[int] = ()) -> None:
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
    FaultKind.BAD_INDEX: "segments count points from #0",
    FaultKind.ZERO_LENGTH: "leave it out",
    FaultKind.REPEATED_SEGMENT: "leave one out",
    FaultKind.HOLE_NOT_FINITE: "give finite coordinates",
    FaultKind.HOLE_ON_SEGMENT: "move it into the face that is to be a hole",
    FaultKind.HOLE_OUTSIDE: "what lies outside needs no hole: leave it out",
    FaultKind.REGION_NOT_FINITE: "give finite numbers; a negative area means unlimited",
    FaultKind.REGION_ON_SEGMENT: "move it into the face that it labels",
    FaultKind.REGION_OUTSIDE: "move it into the domain, or leave it out",
    FaultKind.REGIONS_DISAGREE: "give them the same attribute and area, or a segment between them",
    FaultKind.NOT_CLOSED: "close the outline, or keep the hull with {hull}",
    FaultKind.INCONSISTENT_PARITY: "close the rings; a line that bounds nothing is given twice, on points of its own",
    FaultKind.EMPTY_DOMAIN: "look at the rule and the holes, or keep the hull with {hull}",
    FaultKind.RING_TOO_SHORT: "a ring needs three vertices at different positions",
    FaultKind.NOT_A_RING: "in a union of rings each point is the end of two segments, or of none",
}
_NAMED = 3  # faults of a kind that a message spells out


@dataclass(frozen=True, slots=True)
class Fault:
    """One thing that is wrong with a PSLG: its kind, the indices of the culprits (see the kind), and a sentence.

    In ``sentence`` an index is written as #7, so that ``told`` can count it as a file does; ``message`` counts from 0.
    """

    kind: FaultKind
    indices: tuple[int, ...]
    sentence: str

    @property
    def message(self) -> str:
        """The sentence, with indices that count from 0."""
        return self.told(0)

    def told(self, base: int) -> str:
        """Return the sentence, with indices that count from ``base``."""
        return _counted(self.sentence, base)

    def __str__(self) -> str:
        return self.message


def _counted(sentence: str, base: int) -> str:
    return re.sub(r"#(\d+)", lambda index: str(int(index[1]) + base), sentence)


class PSLGError(ExactMeshError):
    """A planar straight line graph with faults: all of them in ``faults``, by kind; the message names the first ones.

    ``indices`` are the first index of each fault of the first kind; ``path`` is the file that it came from, or None.
    These, and those of the faults, count from 0; the message counts as the file does, from ``base``. ``hull`` is what
    keeps the whole hull, in the words of the caller.
    """

    def __init__(
        self, faults: Sequence[Fault], *, path: str | None = None, base: int = 0, hull: str = "carve=False"
    ) -> None:
        place = "" if path is None else f"{path}: "
        is_told = all("#" in fault.sentence for fault in faults if fault.indices)
        note = "" if is_told or not base else f" [numbers here count from 0, those in the file from {base}]"
        super().__init__(
            place + "; ".join(_summaries(faults, base if is_told else 0, hull)) + note,
            indices=[i for fault in faults if fault.kind is faults[0].kind for i in fault.indices[:1]],
        )
        self.faults = tuple(faults)
        self.path = path


def _summaries(faults: Sequence[Fault], base: int, hull: str) -> Iterator[str]:
    for kind, group in groupby(faults, key=lambda fault: fault.kind):
        alike = list(group)
        named = ", ".join(fault.told(base) for fault in alike[:_NAMED])
        more = f" and {len(alike) - _NAMED} more" if len(alike) > _NAMED else ""
        yield f"{named}{more} ({_counted(_REMEDIES[kind].format(hull=hull), base)})"


class CrossingError(ExactMeshError):
    """Segments cross, and nobody asked to split them: ``pairs`` (k, 2) are their rows, int64, all of them.

    ``indices`` are the segments that cross another, each once; ``path`` is the file that they came from, or None. Both
    count from 0; the message counts from ``base``, and says where the first ones lie if it is given their ends.

    Args:
        pairs: integers (k, 2), rows of segments.
        points: (n, 2), those of the segments.
        segments: (s, 2), the indices of their ends.
        remedy: what the caller offers.
        path: the file that the segments came from.
        base: what indices count from there.
    """

    def __init__(
        self,
        pairs: npt.ArrayLike,
        points: npt.ArrayLike | None = None,
        segments: npt.ArrayLike | None = None,
        *,
        remedy: str = 'crossings="split" makes their crossings vertices',
        path: str | None = None,
        base: int = 0,
    ) -> None:
        crossing = np.array(pairs, dtype=np.int64).reshape(-1, 2)
        places = {} if points is None or segments is None else _places(crossing[:_NAMED], points, segments)
        named = ", ".join(
            f"{i + base} and {j + base}" + (f" [{places[i]}, {places[j]}]" if places else "")
            for i, j in crossing[:_NAMED].tolist()
        )
        more = f" and {len(crossing) - _NAMED} more pairs" if len(crossing) > _NAMED else ""
        place = "" if path is None else f"{path}: "
        super().__init__(
            f"{place}segments cross: {named}{more} ({remedy})",
            indices=np.unique(crossing).tolist(),
        )
        self.pairs = crossing
        self.path = path


def _places(rows: npt.NDArray[np.int64], points: npt.ArrayLike, segments: npt.ArrayLike) -> dict[int, str]:
    """Return where the segments of these rows lie."""
    coordinates, ends = np.asarray(points), np.asarray(segments)
    return {
        s: " to ".join(str(tuple(coordinates[v].tolist())) for v in ends[s].tolist()) for s in np.unique(rows).tolist()
    }
