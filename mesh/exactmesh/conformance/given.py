"""One input of a mesher, and the traits of it that excuse something."""

from dataclasses import dataclass
from decimal import Decimal
from enum import StrEnum
from functools import cached_property

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points
from exactkernel.batch import orient2d_batch
from exactkernel.types import FloatArray
from exactmesh.crossings import Meeting, find_crossings
from exactmesh.verify.mesh import index_pairs

__all__ = ["Given", "IndexArray", "Trait"]

_LARGE = 2.0**250
_EVERYDAY = 2.0**30  # the order in which inputs are told depends on it, no verdict

IndexArray = npt.NDArray[np.int64]


class Trait(StrEnum):
    """What an input has that makes it less ordinary. Of two that show the same, the more ordinary one is told."""

    FLAT = "flat"
    """All points lie on one line: there is no triangle, and an exception is an answer."""
    DUPLICATES = "duplicates"
    """Several points at one position: any one of them may stand for all."""
    EXTREME = "extreme"
    """A coordinate beyond 2^250, or below 2^-250 and not 0: its fourth power, as incircle has it, is no double."""
    OVERLAP = "overlap"
    """Segments that run along each other."""
    CROSSING = "crossing"
    """Segments that cross: there is no triangulation of these points with these segments, and an exception is an
    answer; but if there are triangles, they do not overlap."""


def digits(value: float) -> int:
    """Return how long the number is when it is written without an exponent, ".0" left out.

    >>> digits(60.0), digits(62.9), digits(-3e64)
    (2, 4, 66)
    """
    text = repr(value)
    return len(format(Decimal(text), "f") if "e" in text else text.removesuffix(".0"))


def _between(points: FloatArray, most: float) -> bool:
    """Tell whether the magnitudes of all coordinates but 0 are from 1 / most to most."""
    magnitudes = np.abs(points[points != 0])
    return bool(((magnitudes <= most) & (magnitudes >= 1 / most)).all())


@dataclass(frozen=True, eq=False)
class Given:
    """Points, and for meshers that take them segments.

    Attributes:
        points: float64 (n, 2), finite.
        segments: int64 (s, 2), rows of ``points``; None for a mesher of points.

    >>> from exactmesh.conformance import Given
    >>> given = Given.of([(0, 0), (1, 0), (0, 1)])
    >>> given.literal
    '[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]'
    """

    points: FloatArray
    segments: IndexArray | None = None

    @classmethod
    def of(cls, points: npt.ArrayLike, segments: npt.ArrayLike | None = None) -> "Given":
        """Return the input with arrays of its own: O(n + s).

        Raises:
            ShapeError: the arrays are no (n, 2) and (s, 2), or the indices no integers.
            CoordinateError: a coordinate is no finite double.
        """
        pairs = None if segments is None else np.array(index_pairs(segments), dtype=np.int64)
        return cls(np.array(finite_points(points)), pairs)

    @property
    def key(self) -> bytes:
        """The input, bit for bit."""
        return self.points.tobytes() + b"|" + (b"" if self.segments is None else self.segments.tobytes())

    @property
    def literal(self) -> str:
        """The input as Python, every double in full: points, or a pair of points and segments."""
        points = "[" + ", ".join(f"({x!r}, {y!r})" for x, y in self.points.tolist()) + "]"
        if self.segments is None:
            return points
        return f"({points}, [{', '.join(f'({a}, {b})' for a, b in self.segments.tolist())}])"

    @cached_property
    def size(self) -> tuple[int, bool, int, int, int]:
        """What makes an input smaller than another: fewer traits, numbers as people have them, fewer points, fewer
        segments, fewer digits."""
        return (
            len(self.traits),
            not _between(self.points, _EVERYDAY),
            len(self.points),
            0 if self.segments is None else len(self.segments),
            sum(digits(x) for x in self.points.ravel().tolist()),
        )

    @cached_property
    def traits(self) -> frozenset[Trait]:
        """What excuses something; exact."""
        found = set()
        positions = np.unique(self.points + 0.0, axis=0)  # -0.0 is 0.0
        if len(positions) < len(self.points):
            found.add(Trait.DUPLICATES)
        if len(positions) < 3 or not orient2d_batch(positions[0], positions[-1], positions).any():
            found.add(Trait.FLAT)
        if not _between(self.points, _LARGE):
            found.add(Trait.EXTREME)
        if self.segments is not None and len(self.segments):
            kinds = find_crossings(self.points, self.segments).kinds
            met = {Meeting.CROSSING: Trait.CROSSING, Meeting.OVERLAP: Trait.OVERLAP}
            found.update(trait for meeting, trait in met.items() if (kinds == meeting).any())
        return frozenset(found)
