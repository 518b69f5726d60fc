"""What a mesher is given: the families of inputs of each task, from :mod:`exactmesh.strategies`."""

from collections.abc import Callable

from hypothesis import strategies as st

from exactkernel.types import FloatArray
from exactmesh import strategies
from exactmesh.conformance.given import Given
from exactmesh.conformance.laws import Task
from exactmesh.pslg import PSLG

__all__ = ["families"]

_LEAST = 3
_POINTS: tuple[Callable[..., st.SearchStrategy[FloatArray]], ...] = (
    strategies.uniform_points,
    strategies.clustered_points,
    strategies.grid_points,
    strategies.tilted_grid_points,
    strategies.cocircular_points,
    strategies.collinear_points,
    strategies.far_points,
    strategies.mixed_scale_points,
    strategies.subnormal_points,
    strategies.duplicate_points,
)
#: With the fewest points that each has.
_SEGMENTS: tuple[tuple[int, Callable[..., st.SearchStrategy[PSLG]]], ...] = (
    (3, strategies.polygons),
    (7, strategies.polygons_with_holes),
    (6, strategies.slits),
    (4, strategies.spirals),
    (3, strategies.small_angles),
    (4, strategies.shared_borders),
    (5, strategies.t_junctions),
    (4, strategies.near_concurrent),
)
#: Every point is the end of an even number of segments.
_DOMAINS = (strategies.polygons, strategies.polygons_with_holes, strategies.spirals)


def families(task: Task, max_size: int) -> dict[str, st.SearchStrategy[Given]]:
    """Return the strategies of a task, by name."""
    if task is Task.POINTS:
        return {family.__name__: family(min_size=_LEAST, max_size=max_size).map(Given.of) for family in _POINTS}
    return {
        family.__name__: family(min_size=least, max_size=max(least, max_size)).map(_given)
        for least, family in _SEGMENTS
        if task is Task.SEGMENTS or family in _DOMAINS
    }


def _given(graph: PSLG) -> Given:
    return Given.of(graph.points, graph.segments)
