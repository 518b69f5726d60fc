"""What is refined in the races: graphs with a least angle and a largest area, by name and size, always the same."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from benchmarks.graphs import county_rings, cycle, graph_of_rings
from exactkernel.types import FloatArray, IntArray

__all__ = ["CASES", "Case", "case_of"]


class Case(NamedTuple):
    """What a refiner gets.

    Attributes:
        points: float64 (n, 2).
        segments: int32 (s, 2).
        min_angle: degrees.
        max_area: of a triangle, or 0 for no bound.
    """

    points: FloatArray
    segments: IntArray
    min_angle: float
    max_area: float


def _square(min_angle: float, factor: float) -> Callable[[int], Case]:
    """Return the unit square with the largest area for which Triangle makes about n triangles."""
    corners = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    return lambda n: Case(corners, cycle(4), min_angle, factor / n)


def _star(n: int) -> Case:
    """A polygon whose radii are random: short edges, small angles, and no room beside them."""
    angle = np.arange(n) * 2.0 * np.pi / n
    radius = 0.961 + 0.039 * np.random.default_rng(1).random(n)
    return Case(np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1), cycle(n), 30.0, 0.0)


def _counties(n: int) -> Case:
    """The counties whose borders cross no other: Triangle dies of crossings, or does not end beside them."""
    rings = county_rings()
    rings = rings[: max(1, len(rings) * n // _COUNTY_POINTS)]
    graph, owners = graph_of_rings(rings)
    from exactmesh.crossings import find_crossings

    crossing = np.isin(owners[:, 1], find_crossings(graph.points, graph.segments).pairs)
    guilty = set(owners[crossing, 0].tolist())
    graph, _ = graph_of_rings([ring for i, ring in enumerate(rings) if i not in guilty])
    return Case(graph.points, graph.segments, 25.0, 0.0)


_COUNTY_POINTS = 261_535

#: name -> (maker, size, what it is)
CASES: dict[str, tuple[Callable[[int], Case], int, str]] = {
    "square-20": (_square(20.0, 1.552), 800_000, "unit square to about 800,000 triangles, 20 degrees"),
    "square-30": (_square(30.0, 1.584), 800_000, "unit square to about 800,000 triangles, 30 degrees"),
    "square-33": (_square(33.0, 1.7096), 800_000, "unit square to about 800,000 triangles, 33 degrees"),
    "star-30": (_star, 20_000, "star polygon of 20,000 vertices, 30 degrees"),
    "counties-25": (_counties, _COUNTY_POINTS, "US counties, 261,535 points, 25 degrees"),
}


def case_of(name: str, n: int | None = None) -> Case:
    """Return the case of that name."""
    make, size, _ = CASES[name]
    return make(size if n is None else n)
