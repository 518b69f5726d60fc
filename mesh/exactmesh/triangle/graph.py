"""From a dictionary to a planar straight line graph, as forgiving as Triangle where that is harmless, and with a word
where Triangle says none.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np

from exactkernel.types import FloatArray, IntArray
from exactmesh.columns import MarkerArray
from exactmesh.errors import Fault, FaultKind, PSLGError
from exactmesh.ordering import IndexArray
from exactmesh.pslg import PSLG
from exactmesh.triangle.dictionary import Given
from exactmesh.triangle.switches import Switch, Switches

__all__ = ["Graph", "graph_of", "hull_edges", "solved"]

R = TypeVar("R")

_HARMLESS = (FaultKind.ZERO_LENGTH, FaultKind.REPEATED_SEGMENT, FaultKind.HOLE_OUTSIDE, FaultKind.REGION_OUTSIDE)
_UNLIMITED = -1.0


@dataclass(frozen=True)
class Graph:
    """What a PSLG will be made of; ``rows`` say which row of the dictionary a segment, hole or region is."""

    given: Given
    segments: MarkerArray
    markers: MarkerArray | None
    holes: FloatArray
    regions: FloatArray
    rows: dict[str, IndexArray] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in ("segments", "holes", "regions"):
            self.rows.setdefault(name, np.arange(len(getattr(self, name))))

    def pslg(self) -> PSLG:
        """Return the graph, checked."""
        given = self.given
        return PSLG(
            given.vertices,
            self.segments,
            holes=self.holes,
            regions=self.regions,
            point_markers=given.vertex_markers,
            segment_markers=self.markers,
            point_attributes=given.vertex_attributes,
        )


def hull_edges(loop: IntArray, number: IndexArray) -> MarkerArray:
    """Return the edges of a counterclockwise loop as Triangle lists them, the hull on their right; int64 (h, 2)."""
    vertices = number[loop]
    edges: MarkerArray = np.stack([np.roll(vertices, -1), vertices], axis=1).astype(np.int64)
    return edges


def graph_of(given: Given, switches: Switches, hull: MarkerArray) -> Graph:
    """Return the graph that the switches ask for; ``hull`` (h, 2) are segments to be added, where they are none yet."""
    nothing = np.zeros((0, 2), dtype=np.int64)
    is_graph = switches.asks(Switch.PSLG)
    segments, markers = (given.segments, given.segment_markers) if is_graph else (nothing, None)
    added = hull[~np.isin(_keys(hull), _keys(segments))]
    if markers is not None:
        markers = np.concatenate([markers, np.zeros(len(added), dtype=np.int64)])
    holes = given.holes if is_graph and not switches.asks(Switch.NO_HOLES) else np.zeros((0, 2))
    regions = np.zeros((0, 4))
    if is_graph and (switches.local_areas or switches.asks(Switch.ATTRIBUTES)):
        regions = given.regions.copy()
        if not switches.local_areas:
            regions[:, 3] = _UNLIMITED
    return Graph(given, np.concatenate([segments, added]), markers, holes, regions)


def _keys(segments: MarkerArray) -> MarkerArray:
    keys: MarkerArray = segments.min(axis=1) << 32 | segments.max(axis=1)
    return keys


def solved(graph: Graph, solve: Callable[[PSLG], R], notes: list[str]) -> R:
    """Return what ``solve`` makes of the graph; what Triangle passes over is left out, and noted.

    That is segments without length, segments that repeat another, and seeds outside of the domain.

    Raises:
        PSLGError: other faults.
    """
    while True:
        try:
            return solve(graph.pslg())
        except PSLGError as error:
            faults = error.faults
            if any(fault.kind not in _HARMLESS for fault in faults):
                raise PSLGError(faults, hull="the switch c") from None
        graph = _without(graph, faults, notes)


def _without(graph: Graph, faults: Iterable[Fault], notes: list[str]) -> Graph:
    content = {"segments": graph.segments, "holes": graph.holes, "regions": graph.regions}
    kept = {name: np.ones(len(array), dtype=np.bool_) for name, array in content.items()}
    markers = None if graph.markers is None else graph.markers.copy()
    for fault in faults:
        name = {"h": "holes", "r": "regions"}.get(fault.kind.value[0], "segments")
        if fault.kind is FaultKind.REPEATED_SEGMENT:
            name = "segments"
            first, row = fault.indices
            if markers is not None and markers[first] == 0:
                markers[first] = markers[row]
        else:
            (row,) = fault.indices
            notes.append(_note(graph, name, row))
        kept[name][row] = False
    return replace(
        graph,
        segments=graph.segments[kept["segments"]],
        markers=None if markers is None else markers[kept["segments"]],
        holes=graph.holes[kept["holes"]],
        regions=graph.regions[kept["regions"]],
        rows={name: rows[kept[name]] for name, rows in graph.rows.items()},
    )


def _note(graph: Graph, name: str, row: int) -> str:
    number = int(graph.rows[name][row])
    if name == "segments":
        return f"segment {number} {tuple(graph.segments[row].tolist())} has no length: it is ignored"
    place = tuple(getattr(graph, name)[row, :2].tolist())
    return f"{name[:-1]} {number} at {place} is outside the domain: it is ignored"
