"""What a mesher is given: the families of inputs of each task, from :mod:`exactmesh.strategies`."""

from collections.abc import Callable

from hypothesis import strategies as st

from exactkernel.types import FloatArray
from exactmesh import strategies
from exactmesh.conformance.given import Given
from exactmesh.conformance.laws import Task

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


def families(task: Task, max_size: int) -> dict[str, st.SearchStrategy[Given]]:
    """Return the strategies of a task, by name."""
    if task is Task.POINTS:
        return {
            strategy.__name__: strategy(min_size=_LEAST, max_size=max_size).map(Given.of) for strategy in _POINTS
        }
    raise NotImplementedError
