"""The planar straight line graphs of the constrained races, by name and size, always the same."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from exactkernel.types import FloatArray, IntArray

__all__ = ["GRAPHS", "Graph", "graph_of"]


class Graph(NamedTuple):
    """What a constrained mesher gets: points float64 (n, 2), segments int32 (s, 2), and whether to carve it."""

    points: FloatArray
    segments: IntArray
    carve: bool

    def __len__(self) -> int:
        return len(self.points)


def _star(n: int, rng: np.random.Generator) -> Graph:
    """A star-shaped polygon of n random radii."""
    angle, radius = np.sort(rng.random(n)) * 2.0 * np.pi, 0.5 + 0.5 * rng.random(n)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    return Graph(points, _cycle(n), carve=True)


def _cycle(n: int) -> IntArray:
    start = np.arange(n, dtype=np.int32)
    return np.stack([start, (start + 1) % n], axis=1).astype(np.int32)


def _counties(n: int, rng: np.random.Generator) -> Graph:  # noqa: ARG001  # as many as there are
    """The outlines of the US counties, each point and each border once, where no two borders cross."""
    from bokeh_sampledata import us_counties

    rings = []
    for county in us_counties.data.values():
        x, y = np.array(county["lons"], dtype=np.float64), np.array(county["lats"], dtype=np.float64)
        cuts = np.flatnonzero(np.isnan(x))
        rings += [ring[:-1] for ring in np.split(np.stack([x, y], axis=1), cuts) if len(ring) > 3]
    raise NotImplementedError


def _scattered(n: int, rng: np.random.Generator) -> Graph:
    """n random segments that do not cross, of all directions: a random spanning forest's edges would be too short."""
    raise NotImplementedError
