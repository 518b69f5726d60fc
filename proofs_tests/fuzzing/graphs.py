"""``PSLG`` and rings: what they let pass can be triangulated and refined, and the verifier agrees."""

from typing import Any, cast

import numpy as np
from proofs_tests.fuzzing.cursor import Cursor, number_bytes, table_bytes
from proofs_tests.fuzzing.judging import Target, require
from proofs_tests.fuzzing.sameness import same

from exactmesh import PSLG, constrained_delaunay, refine, verify
from exactmesh.errors import ExactMeshError, PSLGError

__all__ = ["TARGETS"]

_STEINER = 12
_RULES = ("seeds", "even-odd", "seeds", "odd")


def _graph(cursor: Cursor) -> PSLG:
    flags, rule = cursor.byte(), _RULES[cursor.count(3)]
    points = cursor.table(2, 12, integers=False)
    segments = cursor.table(2, 14, integers=True)
    given: dict[str, Any] = {"rule": rule}  # arrays, and what people take for arrays
    if flags & 1:
        given["holes"] = cursor.table(2, 2, integers=False)
    if flags & 2:
        given["regions"] = cursor.table(4, 2, integers=False)
    if flags & 4:
        column = cursor.table(1, 12, integers=True)
        given["point_markers"] = column.reshape(-1) if isinstance(column, np.ndarray) else column
    if flags & 8:
        given["point_attributes"] = cursor.table(2, 12, integers=False)
    return PSLG(cast(Any, points), cast(Any, segments), **given)


def _pslg(data: bytes) -> None:
    cursor = Cursor(data)
    try:
        graph = _graph(cursor)
    except PSLGError as error:
        require(error.faults, "a PSLGError without a fault")
        for fault in error.faults:
            require(fault.message and all(index >= 0 for index in fault.indices), f"{fault} names nobody")
        raise
    options = cursor.byte()
    carve: bool | str = options & 1 == 0
    mesh = constrained_delaunay(graph, carve=carve, crossings="split" if options & 2 == 0 else "error")
    report = verify(mesh)
    require(report.ok, f"constrained_delaunay: {report}")
    if options & 4:
        return
    done = refine(mesh, min_angle=float(options % 34), conforming=bool(options & 8), max_steiner=_STEINER)
    report = verify(done)
    require(report.ok, f"refine: {report}")
    require(len(done.triangulation.points) <= len(mesh.points) + _STEINER, "more Steiner points than allowed")


def _rings(data: bytes) -> None:
    """Rings become a graph; what the graph says of its rings, and of its domain, is the same again."""
    cursor = Cursor(data)
    rings = [cursor.table(2, 8, integers=False) for _ in range(cursor.count(3))]
    graph = PSLG.from_rings(rings)  # type: ignore[arg-type]  # arrays, and what people take for arrays
    again = PSLG.from_rings(graph.rings())
    found = zip(graph.rings(), again.rings(), strict=True)
    require(
        all(same(ring, other) for ring, other in found), f"the rings of {graph!r} are others when they are read again"
    )
    try:
        snapped = graph.snapped(1 + cursor.count(51))
    except ExactMeshError:
        return
    require(snapped.displacement_squared(graph) >= 0, "a negative square")
    require(np.array_equal(snapped.segments, graph.segments), "snapped to other segments")


_SQUARE = [(0, 0), (9, 0), (9, 9), (0, 9), (3, 3), (6, 3), (4, 6)]
_SIDES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 4)]
_STAR = [(0, 0), (8, 0), (8, 8), (0, 8), (-3, 4), (12, 4.5), (4, -3), (3.5, 12)]


def graph_bytes(points: object, segments: object, holes: object = None, options: int = 20) -> bytes:
    """Return bytes that stand for a graph."""
    parts = [bytes([holes is not None, 0]), table_bytes(points, integers=False), table_bytes(segments, integers=True)]  # type: ignore[arg-type]
    if holes is not None:
        parts.append(table_bytes(holes, integers=False))  # type: ignore[arg-type]
    return b"".join(parts) + bytes([options])


def _pslg_seeds() -> list[bytes]:
    tilted = [(0.1 * x - 0.7 * y, 0.7 * x + 0.1 * y) for x in range(3) for y in range(3)]
    return [
        graph_bytes(_SQUARE, _SIDES, [(4, 4)]),
        graph_bytes(_SQUARE, _SIDES, options=200),
        graph_bytes(_STAR, [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (6, 7)]),
        graph_bytes(tilted, [(0, 2), (2, 8), (8, 6), (6, 0), (0, 8)], options=10),
        graph_bytes([(0, 0), (5e-324, 0), (0, 5e-324), (1e308, 1e308)], [(0, 1), (1, 2), (2, 0)], options=1),
        graph_bytes(_SQUARE, [], options=1),
    ]


def _ring_seeds() -> list[bytes]:
    ring, hole = table_bytes(_SQUARE[:4], integers=False), table_bytes(_SQUARE[4:], integers=False)
    far = b"\0\x03" + b"".join(number_bytes(x) for x in (1e15, 0.1, 1e15 + 1, 0.1, 1e15, 0.3))
    return [b"\x02" + ring + hole + b"\x14", b"\x01" + ring + b"\x05", b"\x01" + far + b"\x30"]


TARGETS = (Target("pslg", _pslg, _pslg_seeds), Target("rings", _rings, _ring_seeds))
