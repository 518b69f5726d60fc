"""Spoiling a triangulation: one function for each kind of fault."""

from collections.abc import Callable, Sequence
from itertools import combinations
from typing import NamedTuple, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray
from exactmesh.strategies.corruptions import Corruption
from exactmesh.strategies.meshes import PlainMesh
from exactmesh.strategies.naive import (
    Place,
    Triple,
    exact_places,
    flipped,
    incircle,
    inner_quads,
    is_convex,
    legalized,
    opposites,
    orient,
    swept,
)

__all__ = ["SPOILERS", "Parts", "Spoiler"]

T = TypeVar("T")
Pairs: TypeAlias = list[tuple[int, int]]


class Parts(NamedTuple):
    """What a corrupted mesh is made of."""

    points: FloatArray
    rows: Sequence[Sequence[int]]
    segments: Pairs | None = None
    labels: list[float] | None = None


class Spoiler:
    """A triangulation, and a number that chooses the places where it is spoilt."""

    def __init__(self, mesh: PlainMesh, choice: int) -> None:
        self.points = mesh.points
        self.rows: list[Triple] = [(a, b, c) for a, b, c in mesh.triangles.tolist()]
        self.places: list[Place] = exact_places(mesh.points)
        self._choice = choice

    def pick(self, candidates: Sequence[T]) -> T:
        """Return one of the candidates."""
        if not candidates:
            raise LookupError
        self._choice, which = divmod(self._choice, len(candidates))
        return candidates[which]

    def with_row(self, row: int, corners: Sequence[int]) -> list[Sequence[int]]:
        """Return the triangles with other corners in a row."""
        return [corners if i == row else t for i, t in enumerate(self.rows)]

    def row_and_corner(self) -> tuple[int, int]:
        """Return a row and a position in it."""
        return self.pick([(row, i) for row in range(len(self.rows)) for i in range(3)])

    def replaced(self, row: int, i: int, v: int) -> list[Sequence[int]]:
        """Return the triangles with another corner in one place."""
        return self.with_row(row, [v if k == i else w for k, w in enumerate(self.rows[row])])

    def and_point(self, point: npt.ArrayLike) -> FloatArray:
        """Return the points and one more."""
        return np.vstack([self.points, point])

    def boundary(self) -> Pairs:
        """Return the edges of one triangle only."""
        opposite = opposites(self.rows)
        return [(a, b) for a, b in opposite if (b, a) not in opposite]

    def fan(self, v: int) -> tuple[list[int], bool]:
        """Return the rows round a vertex counterclockwise, and whether they close."""
        after = {}
        for row, t in enumerate(self.rows):
            if v in t:
                i = t.index(v)
                after[t[(i + 1) % 3]] = (row, t[(i + 2) % 3])
        starts = set(after) - {w for _, w in after.values()}
        w = min(starts or after, default=v)
        rows = []
        for _ in after:
            row, w = after[w]
            rows.append(row)
        return rows, not starts


def _flipped(mesh: Spoiler) -> Parts:
    row = mesh.pick(range(len(mesh.rows)))
    return Parts(mesh.points, mesh.with_row(row, mesh.rows[row][::-1]))


def _swapped(mesh: Spoiler) -> Parts:
    return Parts(mesh.points, [t[::-1] for t in mesh.rows])


def _duplicated(mesh: Spoiler) -> Parts:
    return Parts(mesh.points, [*mesh.rows, mesh.pick(mesh.rows)])


def _dropped(mesh: Spoiler) -> Parts:
    row = mesh.pick(range(len(mesh.rows)))
    return Parts(mesh.points, mesh.rows[:row] + mesh.rows[row + 1 :])


def _dropped_point(mesh: Spoiler) -> Parts:
    v = mesh.pick(range(len(mesh.points)))
    others = [w for w in range(len(mesh.points)) if w != v]
    places = [mesh.places[w] for w in others]
    rows = legalized(places, swept(places))
    if not rows:
        raise LookupError
    return Parts(mesh.points, [[others[w] for w in t] for t in rows])


def _extra_point(mesh: Spoiler) -> Parts:
    a, b, c = mesh.points[list(mesh.pick(mesh.rows))]
    return Parts(mesh.and_point(a / 2 + b / 4 + c / 4), mesh.rows)


def _extra_copy(mesh: Spoiler) -> Parts:
    return Parts(mesh.and_point(mesh.points[mesh.pick(range(len(mesh.points)))]), mesh.rows)


def _cracked(mesh: Spoiler) -> Parts:
    shared = [v for v in range(len(mesh.points)) if sum(v in t for t in mesh.rows) > 1]
    v = mesh.pick(shared)
    row = mesh.pick([row for row, t in enumerate(mesh.rows) if v in t])
    return Parts(mesh.and_point(mesh.points[v]), mesh.replaced(row, mesh.rows[row].index(v), len(mesh.points)))


def _shifted(mesh: Spoiler) -> Parts:
    v, axis, way = mesh.pick(range(len(mesh.points))), mesh.pick((0, 1)), mesh.pick((np.inf, -np.inf))
    points = mesh.points.copy()
    points[v, axis] = np.nextafter(points[v, axis], way)
    return Parts(points, mesh.rows)


def _moved(mesh: Spoiler) -> Parts:
    row, i = mesh.row_and_corner()
    v, a, b = (mesh.rows[row][(i + k) % 3] for k in range(3))
    points = mesh.points.copy()
    points[v] = points[a] + (points[b] - points[v])
    return Parts(points, mesh.rows)


def _rewired(mesh: Spoiler) -> Parts:
    row, i = mesh.row_and_corner()
    return Parts(mesh.points, mesh.replaced(row, i, mesh.pick(sorted({*range(len(mesh.points))} - {*mesh.rows[row]}))))


def _merged(mesh: Spoiler) -> Parts:
    near = {frozenset(pair) for t in mesh.rows for pair in combinations(t, 2)}
    gone, kept = mesh.pick([pair for pair in combinations(range(len(mesh.points)), 2) if frozenset(pair) not in near])
    return Parts(mesh.points, [[kept if v == gone else v for v in t] for t in mesh.rows])


def _pinched(mesh: Spoiler) -> Parts:
    fans = [mesh.fan(v) for v in range(len(mesh.points))]
    rows, closed = mesh.pick([(rows, closed) for rows, closed in fans if len(rows) >= 3 + closed])
    missing = (rows[1], rows[3]) if closed else (rows[1],)
    return Parts(mesh.points, [t for row, t in enumerate(mesh.rows) if row not in missing])


_STAR = np.array([(0, 0), (10, 0), (-8, 6), (3, -9), (3, 9), (-8, -6)])  # from each spoke to the next but one


def _double_covered(mesh: Spoiler) -> Parts:
    step = 2.0 ** np.ceil(np.log2(np.ptp(mesh.points))) / 8
    star = mesh.points.max(axis=0) + step * (20 + _STAR)
    hub = len(mesh.points)
    return Parts(
        np.vstack([mesh.points, star]), [*mesh.rows, *((hub, hub + 1 + i, hub + 1 + (i + 1) % 5) for i in range(5))]
    )


def _overlaid(mesh: Spoiler) -> Parts:
    there = set(map(frozenset, mesh.rows))
    places = mesh.places
    solid = [
        (a, b, c) if orient(places[a], places[b], places[c]) > 0 else (a, c, b)
        for a, b, c in combinations(range(len(places)), 3)
        if frozenset((a, b, c)) not in there and orient(places[a], places[b], places[c]) != 0
    ]
    return Parts(mesh.points, [*mesh.rows, mesh.pick(solid)])


def _divided(mesh: Spoiler, *, is_filled: bool) -> Parts:
    a, b, c, _ = mesh.pick(inner_quads(mesh.rows))
    middle = len(mesh.points)
    kept = [t for t in mesh.rows if set(t) != {a, b, c}]
    flat = [(b, middle, a)] if is_filled else []
    return Parts(
        mesh.and_point(mesh.points[a] / 2 + mesh.points[b] / 2), [*kept, (a, middle, c), (middle, b, c), *flat]
    )


def _hanging_node(mesh: Spoiler) -> Parts:
    return _divided(mesh, is_filled=False)


def _flattened(mesh: Spoiler) -> Parts:
    return _divided(mesh, is_filled=True)


def _wrong_edge(mesh: Spoiler) -> Parts:
    return _with_flip(mesh, -1)


def _cocircular_swap(mesh: Spoiler) -> Parts:
    return _with_flip(mesh, 0)


def _with_flip(mesh: Spoiler, sign: int) -> Parts:
    quads = [quad for quad in inner_quads(mesh.rows) if is_convex(mesh.places, quad)]
    values = [incircle(*(mesh.places[v] for v in quad)) for quad in quads]
    fitting = [quad for quad, value in zip(quads, values, strict=True) if (value > 0) - (value < 0) == sign]
    return Parts(mesh.points, flipped(mesh.rows, mesh.pick(fitting)))


def _out_of_range(mesh: Spoiler) -> Parts:
    row, i = mesh.row_and_corner()
    return Parts(mesh.points, mesh.replaced(row, i, mesh.pick((-1, len(mesh.points)))))


def _repeated_corner(mesh: Spoiler) -> Parts:
    row, i = mesh.row_and_corner()
    return Parts(mesh.points, mesh.replaced(row, i, mesh.rows[row][i - 1]))


def _not_finite(mesh: Spoiler) -> Parts:
    points = mesh.points.copy()
    points[mesh.pick(range(len(points))), mesh.pick((0, 1))] = mesh.pick((np.nan, np.inf, -np.inf))
    return Parts(points, mesh.rows)


def _missing_segment(mesh: Spoiler) -> Parts:
    edges = {frozenset(pair) for t in mesh.rows for pair in combinations(t, 2)}
    places = mesh.places
    bare = [
        (a, b)
        for a, b in combinations(range(len(places)), 2)
        if frozenset((a, b)) not in edges
        and not any(
            orient(places[a], places[b], p) == 0 and min(places[a], places[b]) < p < max(places[a], places[b])
            for p in places
        )
    ]
    return Parts(mesh.points, mesh.rows, [mesh.pick(bare)])


def _lost_segment(mesh: Spoiler) -> Parts:
    quad = mesh.pick([quad for quad in inner_quads(mesh.rows) if is_convex(mesh.places, quad)])
    return Parts(mesh.points, flipped(mesh.rows, quad), [(quad.a, quad.b)])


def _mislabeled(mesh: Spoiler) -> Parts:
    odd = mesh.pick(range(len(mesh.rows))) if len(mesh.rows) > 1 else mesh.pick(())
    return Parts(mesh.points, mesh.rows, mesh.boundary(), [2.0 if row == odd else 1.0 for row in range(len(mesh.rows))])


#: What does each of them.
SPOILERS: dict[Corruption, Callable[[Spoiler], Parts]] = {
    Corruption.FLIPPED: _flipped,
    Corruption.SWAPPED: _swapped,
    Corruption.DUPLICATED: _duplicated,
    Corruption.DROPPED: _dropped,
    Corruption.DROPPED_POINT: _dropped_point,
    Corruption.EXTRA_POINT: _extra_point,
    Corruption.EXTRA_COPY: _extra_copy,
    Corruption.CRACKED: _cracked,
    Corruption.SHIFTED: _shifted,
    Corruption.MOVED: _moved,
    Corruption.REWIRED: _rewired,
    Corruption.MERGED: _merged,
    Corruption.PINCHED: _pinched,
    Corruption.DOUBLE_COVERED: _double_covered,
    Corruption.OVERLAID: _overlaid,
    Corruption.HANGING_NODE: _hanging_node,
    Corruption.FLATTENED: _flattened,
    Corruption.WRONG_EDGE: _wrong_edge,
    Corruption.COCIRCULAR_SWAP: _cocircular_swap,
    Corruption.OUT_OF_RANGE: _out_of_range,
    Corruption.REPEATED_CORNER: _repeated_corner,
    Corruption.NOT_FINITE: _not_finite,
    Corruption.MISSING_SEGMENT: _missing_segment,
    Corruption.LOST_SEGMENT: _lost_segment,
    Corruption.MISLABELED: _mislabeled,
}
