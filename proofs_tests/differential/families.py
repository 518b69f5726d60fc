"""Inputs by family, seed and number."""

import warnings
from collections.abc import Callable
from functools import cache
from typing import TypeAlias

from hypothesis.errors import HypothesisDeprecationWarning, UnsatisfiedAssumption
from hypothesis.strategies import SearchStrategy
from proofs_tests.differential.drawing import Drawer

from exactkernel.types import FloatArray
from exactmesh import PSLG, Carve, strategies
from exactmesh.strategies import Corrupted, PlainMesh

__all__ = ["FAMILIES", "Given", "drawn", "named"]

Given: TypeAlias = "FloatArray | PSLG | PlainMesh | Corrupted"

_MOST = 8
_POINTS = (
    *(strategies.uniform_points, strategies.clustered_points, strategies.grid_points, strategies.tilted_grid_points),
    *(strategies.cocircular_points, strategies.collinear_points, strategies.far_points),
    *(strategies.mixed_scale_points, strategies.subnormal_points, strategies.duplicate_points),
)
_GRAPHS = (
    *(strategies.polygons, strategies.spirals, strategies.shared_borders, strategies.slits),
    *(strategies.small_angles, strategies.t_junctions, strategies.near_concurrent),
)


def _without_seeds(graph: PSLG) -> PSLG:
    """Leave it to even-odd which rings are holes."""
    return PSLG(graph.points, graph.segments, rule=Carve.EVEN_ODD)


def _made() -> dict[str, Callable[[], SearchStrategy[Given]]]:
    families: dict[str, Callable[[], SearchStrategy[Given]]] = {}
    for points in _POINTS:
        families[points.__name__] = lambda points=points: points(min_size=3, max_size=_MOST)  # type: ignore[misc]  # a default binds it
    for graphs in _GRAPHS:
        families[graphs.__name__] = lambda graphs=graphs: graphs(max_size=_MOST)  # type: ignore[misc]  # as above
    families["polygons_with_holes"] = lambda: strategies.polygons_with_holes(max_size=10)
    families["rings_in_rings"] = lambda: strategies.polygons_with_holes(max_size=10).map(_without_seeds)
    families["triangulations"] = lambda: strategies.triangulations(max_size=_MOST)
    families["corrupted_triangulations"] = lambda: strategies.corrupted_triangulations(max_size=_MOST - 1)
    return families


FAMILIES = tuple(_made())
#: All families in turn; what is spoilt, in many ways, four times.
_TURNS = (*FAMILIES, *3 * ("corrupted_triangulations",))


@cache
def _strategy(family: str) -> SearchStrategy[Given]:
    return _made()[family]()


def drawn(family: str, seed: int, number: int) -> Given:
    """Return an input; the same for the same three."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", HypothesisDeprecationWarning)  # rejecting is for tests, it says
        for attempt in range(1000):
            try:
                return Drawer(hash((seed, number, attempt)))(_strategy(family))
            except UnsatisfiedAssumption:
                continue
    raise RuntimeError(f"{family} rejects everything")


def named(seed: int, number: int) -> tuple[str, Given]:
    """Return the family whose turn it is, and an input of it."""
    family = _TURNS[number % len(_TURNS)]
    return family, drawn(family, seed, number)
