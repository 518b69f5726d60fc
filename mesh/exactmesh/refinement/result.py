"""What refinement returns."""

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
from gmpy2 import mpfr, mpq, sqrt

from exactkernel.types import FloatArray, IntArray
from exactmesh.refinement.rules import Reason, SteinerKind
from exactmesh.refinement.sheet import ByteArray
from exactmesh.triangulation import Triangulation

__all__ = ["Refinement"]


@dataclass(frozen=True, eq=False, repr=False)
class Refinement:
    """A refined triangulation, and an account of what was done; immutable: every array is read-only.

    Attributes:
        triangulation: the vertices of the input keep their numbers; Steiner points follow in the order of insertion.
        unrefined: int32 (u,), the triangles, ascending, that do not meet what was asked for.
        reasons: int8 (u,), the :class:`Reason` for each.
        steiner: int32 (s,), the Steiner points that were added, as vertices.
        kinds: int8 (s,), the :class:`SteinerKind` of each.
        parents: int32 (s,), the vertex that caused each, see :class:`SteinerKind`.
        radii: float64 (s,), the insertion radii: the distance to the nearest vertex that each could see when it came.
        displacement_squared: the exact square of the largest distance of a Steiner point on a segment from that
            segment. 0: the domain is covered exactly.

    >>> from exactmesh import PSLG, refine
    >>> plate = PSLG.from_rings([[(0, 0), (4, 0), (4, 1), (0, 1)]])
    >>> done = refine(plate, min_angle=30)
    >>> done
    Refinement(complete, 4 Steiner points, 6 triangles)
    >>> done.displacement
    0.0
    """

    triangulation: Triangulation
    unrefined: IntArray
    reasons: ByteArray
    steiner: IntArray
    kinds: ByteArray
    parents: IntArray
    radii: FloatArray
    displacement_squared: mpq

    def __reduce__(self) -> "tuple[type[Refinement], tuple[object, ...]]":
        # copies and pickles are made anew: numpy does not pass on that an array is read-only
        return Refinement, tuple(getattr(self, f.name) for f in fields(self))

    def __post_init__(self) -> None:
        for f in fields(self):
            array = getattr(self, f.name)
            if isinstance(array, np.ndarray):
                array.setflags(write=False)

    def __repr__(self) -> str:
        state = "complete" if self.complete else "NOT complete"
        left = f", {len(self.unrefined)} of them left as they are" if len(self.unrefined) else ""
        triangles = len(self.triangulation.triangles)
        return f"Refinement({state}, {len(self.steiner)} Steiner points, {triangles} triangles{left})"

    @cached_property
    def complete(self) -> bool:
        """Whether all triangles meet what was asked for, but those across from small angles of the input."""
        return bool((self.reasons == Reason.SMALL_INPUT_ANGLE).all())

    @cached_property
    def counts(self) -> dict[str, int]:
        """How many Steiner points there are of each kind, and how many triangles were left for each reason.

        >>> from exactmesh import PSLG, refine
        >>> needle = PSLG([(0, 0), (9, 0), (9, 1)], [(0, 1), (1, 2), (2, 0)])
        >>> refine(needle).counts["small_input_angle"] > 0
        True
        """
        kinds = {kind.name.lower(): int((self.kinds == kind).sum()) for kind in SteinerKind}
        return kinds | {reason.name.lower(): int((self.reasons == reason).sum()) for reason in Reason}

    @property
    def displacement(self) -> float:
        """The largest distance of a Steiner point from its segment: the square root of its square, rounded up."""
        nearest = float(sqrt(mpfr(self.displacement_squared)))
        enough = nearest == np.inf or mpq(nearest) * mpq(nearest) >= self.displacement_squared
        return nearest if enough else float(np.nextafter(nearest, np.inf))

    def reason_of(self, triangle: int) -> Reason | None:
        """Return why a triangle was left as it is, or None where it meets what was asked for."""
        at = int(np.searchsorted(self.unrefined, triangle))
        found = at < len(self.unrefined) and int(self.unrefined[at]) == triangle
        return Reason(int(self.reasons[at])) if found else None
