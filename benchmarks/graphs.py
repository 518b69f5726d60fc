"""The planar straight line graphs of the constrained races, by name and size, always the same."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from exactkernel.types import FloatArray, IntArray

__all__ = ["GRAPHS", "Graph", "county_rings", "cycle", "graph_of", "graph_of_rings"]


class Graph(NamedTuple):
    """What a constrained mesher gets: points float64 (n, 2), segments int32 (s, 2), and whether they bound a domain."""

    points: FloatArray
    segments: IntArray
    closed: bool


def cycle(n: int) -> IntArray:
    """Return the segments of a ring of points in their order."""
    start = np.arange(n, dtype=np.int32)
    return np.stack([start, np.roll(start, -1)], axis=1)


def _star(n: int, rng: np.random.Generator) -> Graph:
    """A star-shaped polygon: every segment crosses what would be edges without it."""
    angle, radius = np.sort(rng.random(n)) * 2.0 * np.pi, 0.5 + 0.5 * rng.random(n)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    return Graph(points, cycle(n), closed=True)


def county_rings() -> list[FloatArray]:
    """The outlines of all US counties."""
    from bokeh_sampledata import us_counties

    rings = []
    for county in us_counties.data.values():
        outline = np.stack([np.array(county[key], dtype=np.float64) for key in ("lons", "lats")], axis=1)
        cuts = np.flatnonzero(np.isnan(outline[:, 0]))
        rings += [part[~np.isnan(part[:, 0])] for part in np.split(outline, cuts)]
    return rings


def graph_of_rings(rings: list[FloatArray]) -> tuple[Graph, IntArray]:
    """Return the graph with every point and every edge of the rings once; and rows (ring, segment)."""
    points, index = np.unique(np.concatenate(rings), axis=0, return_inverse=True)
    lengths = [len(ring) for ring in rings]
    ends = np.cumsum(lengths)
    edges = np.stack([index, np.roll(index, -1)], axis=1)
    edges[ends - 1, 1] = index[ends - lengths]
    proper = edges[:, 0] != edges[:, 1]
    owner = np.repeat(np.arange(len(rings)), lengths)[proper]
    edges, which = np.unique(np.sort(edges[proper], axis=1), axis=0, return_inverse=True)
    graph = Graph(points, edges.astype(np.int32), closed=True)
    return graph, np.stack([owner, which.reshape(-1)], axis=1).astype(np.int32)


def _counties(n: int, rng: np.random.Generator) -> Graph:  # noqa: ARG001  # nothing is random here
    """Every point and every border once; some borders cross: n / 260,000 of the rings."""
    rings = county_rings()
    return graph_of_rings(rings[: max(1, len(rings) * n // _COUNTY_POINTS)])[0]


_COUNTY_POINTS = 263_649


def _scattered(n: int, rng: np.random.Generator) -> Graph:
    """Random segments of all lengths up to a tenth of the square, without those that cross an earlier one."""
    from exactmesh.crossings import find_crossings

    count = 2 * n
    middle, angle = rng.random((count, 2)), rng.random(count) * np.pi
    half = 0.5 * np.minimum(0.3 * rng.random(count) ** -0.5 / np.sqrt(n), 0.1)
    reach = half[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = np.concatenate([middle - reach, middle + reach])
    segments = np.arange(2 * count, dtype=np.int32).reshape(2, count).T
    pairs = find_crossings(points, segments).pairs
    kept = np.delete(np.arange(count), np.unique(pairs[:, 1]))[:n]
    corners = points[segments[kept]].reshape(-1, 2)
    return Graph(corners, np.arange(len(corners), dtype=np.int32).reshape(-1, 2), closed=False)


def _across(n: int, rng: np.random.Generator) -> Graph:
    """Uniform points, and one segment from corner to corner of the square."""
    points = rng.random((n, 2))
    points[:2] = (0.0, 0.0), (1.0, 1.0)
    return Graph(points, np.array([[0, 1]], dtype=np.int32), closed=False)


#: name -> (maker, size, what it is)
GRAPHS: dict[str, tuple[Callable[[int, np.random.Generator], Graph], int, str]] = {
    "star": (_star, 1_000_000, "star polygon of 1,000,000 vertices"),
    "counties": (_counties, _COUNTY_POINTS, "US counties, 263,649 points, some borders cross"),
    "scattered": (_scattered, 100_000, "100,000 random segments that do not cross"),
    "across": (_across, 1_000_000, "one segment across 1,000,000 points"),
}


def graph_of(name: str, n: int | None = None) -> Graph:
    """Return the graph of that name."""
    make, size, _ = GRAPHS[name]
    return make(size if n is None else n, np.random.default_rng(1))
