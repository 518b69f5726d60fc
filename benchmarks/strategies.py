"""How many examples a second the strategies draw, within a real ``@given``, beside plain hypothesis."""

import time
from collections.abc import Callable
from statistics import median

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as numpy_strategies

from benchmarks.tables import Section
from exactmesh import strategies

__all__ = ["run"]

_SIZE = 50
_POINTS = (
    *(strategies.uniform_points, strategies.clustered_points, strategies.grid_points, strategies.tilted_grid_points),
    *(strategies.cocircular_points, strategies.collinear_points, strategies.far_points),
    *(strategies.mixed_scale_points, strategies.subnormal_points, strategies.duplicate_points, strategies.points),
)
_GRAPHS = (
    *(strategies.polygons, strategies.polygons_with_holes, strategies.slits, strategies.spirals),
    *(strategies.small_angles, strategies.near_concurrent, strategies.shared_borders, strategies.t_junctions),
)
_OTHERS: tuple[Callable[..., st.SearchStrategy[object]], ...] = (
    strategies.triangulations,
    strategies.corrupted_triangulations,
    strategies.quadedges,
)


def _rate(strategy: st.SearchStrategy[object], count: int) -> float:
    """Return examples a second of processor time, discarded ones and hypothesis' own work included."""
    drawn = 0

    @settings(max_examples=count, database=None, deadline=None, suppress_health_check=list(HealthCheck))
    @given(strategy)
    def use(_: object) -> None:
        nonlocal drawn
        drawn += 1

    start = time.process_time()
    use()
    return drawn / (time.process_time() - start)


def _rows(named: list[tuple[str, st.SearchStrategy[object]]], count: int, rounds: int) -> list[list[str]]:
    rates: dict[str, list[float]] = {name: [] for name, _ in named}
    for _, strategy in named:
        _rate(strategy, 2)  # what is compiled is compiled
    for _ in range(rounds):
        for name, strategy in named:
            rates[name].append(_rate(strategy, count))
    return [[name, f"{median(found):,.0f}"] for name, found in rates.items()]


def run(*, quick: bool = False, rounds: int = 5) -> None:
    """Time every strategy; write the section ``strategies``."""
    section = Section("strategies", "Drawing inputs")
    count = 20 if quick else 1000
    pair = st.tuples(st.floats(-1, 1), st.floats(-1, 1))
    plain: list[tuple[str, st.SearchStrategy[object]]] = [
        ("plain hypothesis: a list of pairs of floats", st.lists(pair, min_size=_SIZE, max_size=_SIZE)),
        (
            "hypothesis.extra.numpy: an array, filled",
            numpy_strategies.arrays(np.float64, (_SIZE, 2), elements=st.floats(-1, 1)),
        ),
    ]
    points = [(f"`{family.__name__}`", family(min_size=_SIZE, max_size=_SIZE)) for family in _POINTS]
    section.table(["sets of 50 points", "a second"], _rows([*points, *plain], count, rounds))
    graphs = [(f"`{family.__name__}`", family(min_size=_SIZE, max_size=_SIZE)) for family in _GRAPHS]
    section.table(["graphs of 50 points", "a second"], _rows([*graphs], count // 4, rounds))
    others = [(f"`{family.__name__}`", family(min_size=10, max_size=10)) for family in _OTHERS]
    section.table(["of 10 points, or edges", "a second"], _rows([*others], count // 4, rounds))
    section.text(
        "Processor time, within `@given`, with everything that hypothesis does around an example. The array of "
        "hypothesis.extra.numpy has few different numbers, the others are copies."
    )
    if not quick:
        section.write()
