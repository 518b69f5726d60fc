"""What a mesh is checked against besides its points: segments, the domain, labels; validated once."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points
from exactkernel.errors import BoundError, ShapeError, shown
from exactkernel.types import FloatArray, IntArray
from exactmesh.errors import ChoiceError, Fault, FaultKind, PSLGError
from exactmesh.verify.mesh import Integers, index_pairs
from exactmesh.verify.witness import IndexArray, point_name

__all__ = ["Constraints", "Domain", "Outline", "constraints_of", "require_even_ends"]

_EVEN_ODD = "even-odd"
_RULES = ("seeds", _EVEN_ODD)


class Domain(Protocol):
    """A planar straight line graph and the rule by which its faces are the domain; :class:`exactmesh.PSLG` is one."""

    @property
    def points(self) -> FloatArray:
        """float64 (n, 2); several may share a position."""

    @property
    def segments(self) -> IntArray:
        """int (s, 2), the indices of their ends. They may overlap, and end inside of one another."""

    @property
    def holes(self) -> FloatArray:
        """float64 (h, 2), a point inside each hole."""

    @property
    def regions(self) -> FloatArray:
        """float64 (r, 3 or more): x, y of a point inside a region, its attribute, its largest area if positive."""

    @property
    def rule(self) -> str:
        """ "seeds": the faces of the segments that reach neither infinity nor a hole's point. "even-odd": those that an
        odd number of segments (coincident ones counted) separates from infinity and that reach no hole's point."""


@dataclass(frozen=True, slots=True)
class Outline:
    """A domain in arrays of its own: points, holes and regions as given; an area of infinity where there is none."""

    points: FloatArray
    segments: IndexArray
    holes: FloatArray
    regions: FloatArray
    attributes: FloatArray
    areas: FloatArray
    even_odd: bool


@dataclass(frozen=True, slots=True)
class Constraints:
    """What was given besides points and triangles.

    Attributes:
        segments: (s, 2) indices of points, as given and unchecked; None where none were given.
        outline: the domain, or None.
        labels: (m,) a label a triangle, or None.
        within: how far the domain may be from the mesh, or None.
    """

    segments: Integers | None
    outline: Outline | None
    labels: FloatArray | None
    within: float | None = None

    @property
    def any(self) -> bool:
        """Whether there are segments at all, the triangles' own or the domain's."""
        return self.segments is not None or self.outline is not None


def constraints_of(
    segments: npt.ArrayLike | None,
    domain: Domain | None,
    labels: npt.ArrayLike | None,
    m: int,
    within: float | None = None,
) -> Constraints:
    """Validate what can be validated without the mesh.

    Raises:
        ShapeError, CoordinateError, NonFiniteError: arrays that are none.
        PSLGError: segments of the domain that name no point or have no length.
        ChoiceError: an unknown rule, or a distance without a domain.
        BoundError: a distance that is negative, or no number.
    """
    if within is not None and domain is None:
        raise ChoiceError("within is a distance from a domain; give domain=")
    return Constraints(
        None if segments is None else index_pairs(segments),
        None if domain is None else _outline(domain),
        None if labels is None else _labels(labels, m),
        _within(within),
    )


def _within(within: float | None) -> float | None:
    given: object = within
    if given is None:
        return None
    if not isinstance(given, (int, float, np.integer, np.floating)) or isinstance(given, bool) or not given >= 0:
        raise BoundError(f"within is a distance, 0 or more, not {shown(given)}")
    try:
        return float(given)
    except OverflowError:
        raise BoundError(f"within is a distance that is a double, not {shown(given)}") from None


def _labels(labels: npt.ArrayLike, m: int) -> FloatArray:
    array = np.asarray(labels)
    if array.shape == (m, 1):
        array = array[:, 0]
    if array.shape != (m,) or array.dtype.kind not in "iufb":
        raise ShapeError(f"labels has shape {array.shape} and dtype {array.dtype}; expected {m} numbers")
    doubles = array.astype(np.float64)
    if array.dtype.kind in "iu" and (doubles.astype(array.dtype) != array).any():
        raise ShapeError("labels beyond 2^53 would be rounded to doubles")
    return doubles


def _require_domain(domain: object) -> None:
    if all(hasattr(domain, name) for name in ("points", "segments", "holes", "regions", "rule")):
        return
    remedy = "make one with PSLG(points, segments)"
    if hasattr(domain, "domain"):
        remedy = "give its .domain"
    elif hasattr(domain, "geom_type"):
        remedy = "make one with PSLG.from_shapely"
    elif isinstance(domain, Mapping) and "vertices" in domain:
        optional = "".join(f", {name}=domain['{name}']" for name in ("holes", "regions") if name in domain)
        remedy = f"make one with PSLG(domain['vertices'], domain['segments']{optional})"
    elif isinstance(domain, Mapping) and "type" in domain:
        remedy = "make one with PSLG.from_geojson"
    raise ShapeError(f"domain: expected a PSLG, not a {type(domain).__name__}: {remedy}")


def _outline(domain: Domain) -> Outline:
    _require_domain(domain)
    rule = str(domain.rule)
    if rule not in _RULES:
        raise ChoiceError(f"{rule!r} is no rule for a domain; choose from {', '.join(_RULES)}")
    points = finite_points(domain.points, "domain.points")
    segments = index_pairs(domain.segments, "domain.segments")
    regions = np.asarray(domain.regions, dtype=np.float64)
    regions = regions.reshape(0, 3) if not regions.size else regions
    if regions.ndim != 2 or regions.shape[1] < 3:
        raise ShapeError(f"domain.regions has shape {regions.shape}; expected (r, 3) or more columns")
    faults = _faults(points, segments)
    if faults:
        raise PSLGError(faults)
    return Outline(
        points,
        segments.astype(np.intp),
        finite_points(domain.holes, "domain.holes"),
        finite_points(regions[:, :2], "domain.regions"),
        regions[:, 2].copy(),
        np.where(regions[:, 3] > 0.0, regions[:, 3], np.inf) if regions.shape[1] > 3 else np.full(len(regions), np.inf),
        rule == _EVEN_ODD,
    )


def _faults(points: FloatArray, segments: Integers) -> list[Fault]:
    outside = ((segments < 0) | (segments >= len(points))).any(axis=1)
    faults = [
        Fault(FaultKind.BAD_INDEX, (i,), f"segment #{i} {tuple(segments[i].tolist())} has an end that does not exist")
        for i in np.flatnonzero(outside).tolist()
    ]
    sound = np.flatnonzero(~outside)
    a, b = segments[sound].astype(np.intp).T
    empty = sound[(points[a] == points[b]).all(axis=1)]
    return faults + [Fault(FaultKind.ZERO_LENGTH, (i,), f"segment #{i} has no length") for i in empty.tolist()]


def require_even_ends(outline: Outline, position: IndexArray) -> None:
    """Refuse segments round which the parity of the even-odd rule is not defined.

    Crossing a segment changes the parity. That says the same on every way round a point exactly where the number of
    segments that end there is even.

    Args:
        outline: the domain.
        position: (n,) a number for the position of each of its points.

    Raises:
        PSLGError: it names the points.
    """
    ends = np.bincount(position[outline.segments.ravel()], minlength=len(outline.points))
    odd = np.flatnonzero(ends & 1)
    if odd.size:
        order = np.argsort(position, kind="stable")
        points = order[np.searchsorted(position[order], odd)].tolist()
        raise PSLGError(
            [
                Fault(
                    FaultKind.INCONSISTENT_PARITY,
                    (v,),
                    f"an odd number of segments ends in point #{point_name(outline.points, v)}",
                )
                for v in points
            ]
        )
