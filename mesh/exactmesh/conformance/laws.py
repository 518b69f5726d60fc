"""What is asked of a mesher, and what can be the answer."""

from enum import StrEnum
from typing import TypeAlias

from exactmesh.verify import Property

__all__ = ["LAWS", "Behaviour", "Law", "Outcome", "Task", "is_worse"]


class Task(StrEnum):
    """What a mesher makes of what."""

    POINTS = "points"
    """``mesher(points)``: a Delaunay triangulation of their convex hull."""
    SEGMENTS = "segments"
    """``mesher(points, segments)``: a constrained Delaunay triangulation of the points' convex hull."""
    DOMAIN = "domain"
    """``mesher(points, segments)``: a constrained Delaunay triangulation of what the segments enclose, by the even-odd
    rule: a ring inside a ring is a hole."""


class Outcome(StrEnum):
    """The verdict on one law, the worst that was found."""

    HOLDS = "holds"
    ROUNDING = "rounding"
    """Broken, but by no more than doubles resolve: see :class:`exactmesh.verify.Severity`."""
    REFUSES = "refuses"
    """An exception, though there is a triangulation."""
    WRONG = "wrong"
    HANGS = "hangs"
    DIES = "dies"
    """The process ended."""


class Behaviour(StrEnum):
    """What is asked of the call, not of the mesh."""

    ANSWERS = "answers"
    """It returns a mesh, for every input that has one."""
    KEEPS_INPUT = "keeps_input"
    """The arrays that it is given are afterwards as they were."""
    REPEATABLE = "repeatable"
    """Given the same once more, it returns the same arrays."""


#: One row of the table: about the call, or one of the verifier's properties of the mesh.
Law: TypeAlias = Behaviour | Property

_COMMON: tuple[Law, ...] = (*Behaviour, Property.FINITE, Property.INDICES, Property.ORIENTATION, Property.ADMISSIBLE)
_CONSTRAINED: tuple[Law, ...] = (Property.SEGMENTS_PRESENT, Property.CONSTRAINED_DELAUNAY)

#: The laws of each task, in the order in which they are told.
LAWS: dict[Task, tuple[Law, ...]] = {
    Task.POINTS: (
        *_COMMON,
        Property.NO_NEW_POINTS,
        Property.ALL_POINTS_USED,
        Property.COVERS_HULL,
        Property.DELAUNAY,
    ),
    Task.SEGMENTS: (
        *_COMMON,
        Property.NO_NEW_POINTS,
        Property.ALL_POINTS_USED,
        Property.COVERS_HULL,
        *_CONSTRAINED,
    ),
    Task.DOMAIN: (
        *_COMMON,
        Property.NO_NEW_POINTS,
        Property.DOMAIN_POINTS,
        Property.COVERS_DOMAIN,
        *_CONSTRAINED,
    ),
}


def is_worse(outcome: Outcome, other: Outcome) -> bool:
    """Tell which of two outcomes is to be looked at first.

    >>> is_worse(Outcome.WRONG, Outcome.ROUNDING)
    True
    """
    order = tuple(Outcome)
    return order.index(outcome) > order.index(other)
