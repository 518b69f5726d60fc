"""What a report is about: the arrays that were checked, and what they were checked against."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from exactkernel.types import FloatArray

if TYPE_CHECKING:
    from exactmesh.verify.domain import Outline
    from exactmesh.verify.mesh import Integers

__all__ = ["CheckedMesh"]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class CheckedMesh:
    """The arrays that were checked: references, not copies; do not write to them while the report is of use.

    Attributes:
        points: float64 (n, 2), NaN and infinity as given.
        triangles: int (m, 3), of any integer dtype, unchecked.
        quads: int (k, 4), likewise.
        segments: int (s, 2) or None, likewise.
        labels: float64 (m + k,) or None.
        domain: the domain as it was understood, or None.
        bounds: what else was given, by the name of the argument: "min_angle", "max_area" and so on; a number or an
            array of them.
        orientation: "ccw" or "any".
    """

    points: FloatArray
    triangles: "Integers"
    quads: "Integers"
    segments: "Integers | None" = None
    labels: FloatArray | None = None
    domain: "Outline | None" = None
    bounds: Mapping[str, "float | FloatArray"] = field(default_factory=dict)
    orientation: str = "ccw"
