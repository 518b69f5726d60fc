"""What can be wrong with a triangulation: the kinds of faults, and what each of them breaks."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray, IntArray
from exactmesh.verify import Property

__all__ = ["Corrupted", "Corruption"]


class Corruption(StrEnum):
    """A kind of fault in a triangulation of a convex hull that uses every point.

    ``breaks`` is the property that it breaks for certain: None where it depends on the place, or where nothing is
    wrong.
    """

    FLIPPED = "flipped"
    """A triangle is listed clockwise."""
    SWAPPED = "swapped"
    """All triangles are listed clockwise."""
    DUPLICATED = "duplicated"
    """A triangle is there twice."""
    DROPPED = "dropped"
    """A triangle is missing."""
    DROPPED_POINT = "dropped_point"
    """The triangulation, otherwise Delaunay, is that of all points but one."""
    EXTRA_POINT = "extra_point"
    """A new point lies within a triangle, and nobody uses it."""
    EXTRA_COPY = "extra_copy"
    """A point is listed once more, and nobody uses the copy. Delaunay is what it was."""
    CRACKED = "cracked"
    """A triangle has a copy of a point for a corner, the others there have the point."""
    SHIFTED = "shifted"
    """A coordinate is moved by one ulp: for an inner vertex often legal, on the hull often not."""
    MOVED = "moved"
    """A vertex is moved across the opposite edge of one of its triangles."""
    REWIRED = "rewired"
    """A corner of a triangle is another vertex."""
    MERGED = "merged"
    """A vertex stands wherever another one should, one that is not its neighbour."""
    PINCHED = "pinched"
    """Triangles are missing so that the others at a vertex form two fans."""
    DOUBLE_COVERED = "double_covered"
    """Beside the mesh there is a star that winds twice round its centre: all that is local is right."""
    OVERLAID = "overlaid"
    """There is one more triangle, of three vertices, over the others."""
    HANGING_NODE = "hanging_node"
    """An inner edge is divided in one of its two triangles only."""
    FLATTENED = "flattened"
    """A hanging node whose gap is closed by a triangle without area: every edge has its partner."""
    WRONG_EDGE = "wrong_edge"
    """An edge that was Delaunay is flipped."""
    COCIRCULAR_SWAP = "cocircular_swap"
    """An edge between four cocircular points is flipped, which is legal."""
    OUT_OF_RANGE = "out_of_range"
    """A corner is -1, or one more than there are points."""
    REPEATED_CORNER = "repeated_corner"
    """Two corners of a triangle are the same."""
    NOT_FINITE = "not_finite"
    """A coordinate is NaN or infinite."""
    MISSING_SEGMENT = "missing_segment"
    """A segment is asked for that is no edge."""
    LOST_SEGMENT = "lost_segment"
    """A segment is asked for whose edge has been flipped."""
    MISLABELED = "mislabeled"
    """A triangle has another label than its neighbours, and no segment in between."""

    @property
    def breaks(self) -> Property | None:
        """The property that fails for certain.

        >>> from exactmesh.strategies import Corruption
        >>> Corruption.DROPPED.breaks
        <Property.COVERS_HULL: 'covers_hull'>
        """
        return _BREAKS.get(self)


_BREAKS = {
    Corruption.FLIPPED: Property.ORIENTATION,
    Corruption.SWAPPED: Property.ORIENTATION,
    Corruption.DUPLICATED: Property.EDGE_MANIFOLD,
    Corruption.DROPPED: Property.COVERS_HULL,
    Corruption.DROPPED_POINT: Property.ALL_POINTS_USED,
    Corruption.EXTRA_POINT: Property.ALL_POINTS_USED,
    Corruption.EXTRA_COPY: Property.DISTINCT_POINTS,
    Corruption.CRACKED: Property.DISTINCT_POINTS,
    Corruption.MOVED: Property.ORIENTATION,
    Corruption.REWIRED: Property.ADMISSIBLE,
    Corruption.MERGED: Property.ADMISSIBLE,
    Corruption.PINCHED: Property.VERTEX_MANIFOLD,
    Corruption.DOUBLE_COVERED: Property.ADMISSIBLE,
    Corruption.OVERLAID: Property.ADMISSIBLE,
    Corruption.HANGING_NODE: Property.ADMISSIBLE,
    Corruption.FLATTENED: Property.ORIENTATION,
    Corruption.WRONG_EDGE: Property.DELAUNAY,
    Corruption.OUT_OF_RANGE: Property.INDICES,
    Corruption.REPEATED_CORNER: Property.INDICES,
    Corruption.NOT_FINITE: Property.FINITE,
    Corruption.MISSING_SEGMENT: Property.SEGMENTS_PRESENT,
    Corruption.LOST_SEGMENT: Property.SEGMENTS_PRESENT,
    Corruption.MISLABELED: Property.REGIONS,
}


@dataclass(frozen=True, slots=True, eq=False)
class Corrupted:
    """A triangulation with one fault.

    Attributes:
        points: float64 (n, 2).
        triangles: int32 (m, 3).
        corruption: what is wrong.
        segments: int32 (s, 2) that :func:`exactmesh.verify` is to be given, or None.
        labels: float64 (m,), likewise.
    """

    points: FloatArray
    triangles: IntArray
    corruption: Corruption
    segments: IntArray | None = None
    labels: npt.NDArray[np.float64] | None = None
