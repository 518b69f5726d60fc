"""Smaller inputs that disagree as well."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from proofs_tests.differential.families import Given

from exactmesh import PSLG
from exactmesh.errors import ExactMeshError
from exactmesh.strategies import Corrupted, PlainMesh

__all__ = ["code_of", "reduced", "size_of"]


def reduced(given: Given, is_bad: Callable[[Given], bool]) -> Given:
    """Leave out points, segments or triangles one by one, as long as what is left is bad."""
    found = True
    while found:
        found = False
        for smaller in _smaller(given):
            if is_bad(smaller):
                given, found = smaller, True
                break
    return given


def _smaller(given: Given) -> Iterator[Given]:
    if isinstance(given, PSLG):
        yield from _smaller_graphs(given)
    elif isinstance(given, PlainMesh):
        yield from (
            given._replace(triangles=np.delete(given.triangles, i, axis=0)) for i in range(len(given.triangles))
        )
    elif isinstance(given, Corrupted):
        if given.labels is None:
            yield from (
                replace(given, triangles=np.delete(given.triangles, i, axis=0)) for i in range(len(given.triangles))
            )
    else:
        yield from (np.delete(given, i, axis=0) for i in range(len(given)))


def _smaller_graphs(graph: PSLG) -> Iterator[Given]:
    for i in range(len(graph.segments)):
        yield PSLG(graph.points, np.delete(graph.segments, i, axis=0), holes=graph.holes, rule=graph.rule)
    for v in range(len(graph.points)):
        if not (graph.segments == v).any():
            segments = graph.segments - (graph.segments > v)
            try:
                yield PSLG(np.delete(graph.points, v, axis=0), segments, holes=graph.holes, rule=graph.rule)
            except ExactMeshError:  # a hole is outside of the hull now
                continue


def size_of(given: Given) -> tuple[int, int, float]:
    """Return what makes an input smaller than another."""
    points = given if isinstance(given, np.ndarray) else given.points
    rows = 0 if isinstance(given, np.ndarray) else len(given.segments if isinstance(given, PSLG) else given.triangles)
    finite = points[np.isfinite(points)]
    return len(points), rows, float(np.abs(finite).max(initial=0.0))


def code_of(given: Given) -> str:
    """Return the input as text that Python reads."""
    if isinstance(given, np.ndarray):
        return repr(given.tolist())
    if isinstance(given, PSLG):
        holes = f", holes={given.holes.tolist()}" if len(given.holes) else ""
        return f"PSLG({given.points.tolist()}, {given.segments.tolist()}{holes}, rule={str(given.rule)!r})"
    segments = given.segments if isinstance(given, Corrupted) else None
    more = "" if segments is None else f", segments={segments.tolist()}"
    return f"verify({given.points.tolist()}, {given.triangles.tolist()}{more})"
