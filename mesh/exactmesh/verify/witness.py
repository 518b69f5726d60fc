"""How witnesses are written: exact determinants in fractions, names with coordinates, rows of triangles."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray, IntArray, Sign
from exactmesh.verify.properties import Severity, Verdict
from exactmesh.verify.report import WITNESSES, Finding, Violation

__all__ = [
    "IndexArray",
    "Ranking",
    "approximately",
    "exact",
    "finding_of",
    "joined",
    "places_of",
    "point_name",
    "rows_at_vertices",
    "rows_of_triangles",
    "scalar_product",
    "sign_of",
    "squared_length",
    "triangle_name",
    "twice_area",
]

IndexArray = npt.NDArray[np.intp]
_NAMED_ROWS = 10  # copies of one triangle, or triangles at one vertex, that a witness names


def exact(points: FloatArray, vertex: int) -> tuple[Fraction, Fraction]:
    """Return the coordinates of a vertex as fractions."""
    return Fraction(float(points[vertex, 0])), Fraction(float(points[vertex, 1]))


def sign_of(value: Fraction) -> Sign:
    """Return the sign of a fraction."""
    return Sign((value > 0) - (value < 0))


def twice_area(points: FloatArray, a: int, b: int, c: int) -> Fraction:
    """Return twice the signed area of the triangle, positive if counterclockwise."""
    (ax, ay), (bx, by), (cx, cy) = exact(points, a), exact(points, b), exact(points, c)
    return (ax - cx) * (by - cy) - (ay - cy) * (bx - cx)


def scalar_product(points: FloatArray, a: int, b: int, p: int) -> Fraction:
    """Return (p - a) . (b - p), positive where p sees ab under an obtuse angle."""
    (ax, ay), (bx, by), (px, py) = exact(points, a), exact(points, b), exact(points, p)
    return (px - ax) * (bx - px) + (py - ay) * (by - py)


def squared_length(points: FloatArray, a: int, b: int) -> Fraction:
    """Return the squared length of an edge."""
    (ax, ay), (bx, by) = exact(points, a), exact(points, b)
    return (bx - ax) ** 2 + (by - ay) ** 2


def approximately(value: Fraction) -> str:
    """Return three digits of a fraction, whatever its exponent."""
    return f"{Decimal(value.numerator) / Decimal(value.denominator):.3g}"


def point_name(points: FloatArray, vertex: int) -> str:
    """Return "7 (0.5, 1.0)"."""
    return f"{vertex} ({float(points[vertex, 0])!r}, {float(points[vertex, 1])!r})"


def places_of(points: FloatArray, rows: Iterable[int]) -> tuple[tuple[float, float], ...]:
    """Return some positions, for witnesses that are about no vertex."""
    return tuple((float(points[row, 0]), float(points[row, 1])) for row in rows)


def triangle_name(points: FloatArray, corners: Iterable[int]) -> str:
    """Return the three corners with their coordinates."""
    return ", ".join(point_name(points, int(v)) for v in corners)


def rows_of_triangles(
    triangles: IntArray, wanted: Sequence[tuple[int, ...]], n: int, quads: IntArray | None = None
) -> list[tuple[int, ...]]:
    """Return for each triple of corners the rows of the triangles that have them, in any order, and those of the
    quadrilaterals that have them in a row. O(m)."""
    near = np.zeros(n, dtype=np.bool_)
    near[[v for corners in wanted for v in corners]] = True
    found: dict[frozenset[int], list[int]] = {frozenset(corners): [] for corners in wanted}
    for row in np.flatnonzero(near[triangles].all(axis=1)):
        rows = found.get(frozenset(triangles[row].tolist()))
        if rows is not None and len(rows) < _NAMED_ROWS:
            rows.append(int(row))
    if quads is not None:
        for row in np.flatnonzero(near[quads].sum(axis=1) >= 3):
            corners = quads[row].tolist()
            for i in range(4):
                rows = found.get(frozenset(corners[:i] + corners[i + 1 :]))
                if rows is not None and len(rows) < _NAMED_ROWS:
                    rows.append(len(triangles) + int(row))
    return [tuple(found[frozenset(corners)]) for corners in wanted]


def rows_at_vertices(triangles: IntArray, vertices: IndexArray, n: int, quads: IntArray) -> dict[int, tuple[int, ...]]:
    """Return for each vertex the first rows of cells that have it as a corner. O(m)."""
    near = np.zeros(n, dtype=np.bool_)
    near[vertices] = True
    rows: dict[int, tuple[int, ...]] = {int(v): () for v in vertices}
    for before, cells in ((0, triangles), (len(triangles), quads)):
        for row in np.flatnonzero(near[cells].any(axis=1)):
            for v in cells[row].tolist():
                if v in rows and len(rows[v]) < _NAMED_ROWS:
                    rows[v] += (before + int(row),)
    return rows


@dataclass(frozen=True, slots=True)
class Ranking:
    """In which order violations are told.

    Attributes:
        order: positions of the first :data:`WITNESSES` violations: the wrong ones, the largest first.
        rounding: how many of all violations are rounding-sized.
    """

    order: IndexArray
    rounding: int


def finding_of(culprits: IndexArray, describe: Callable[[int], Violation], ranking: Ranking | None = None) -> Finding:
    """Return FAILS with a violation for each of the first culprits, HOLDS where there are none."""
    if not culprits.size:
        return Finding(Verdict.HOLDS)
    told, rounding = (culprits[:WITNESSES], 0) if ranking is None else (culprits[ranking.order], ranking.rounding)
    violations = tuple(describe(int(culprit)) for culprit in told)
    return Finding(Verdict.FAILS, int(culprits.size), violations, rounding=rounding)


def joined(parts: Sequence[Finding], *, lower_bound: bool = False) -> Finding:
    """Return one finding about several sorts of violations: FAILS if there are any, what is wrong told first."""
    told = [violation for part in parts for violation in part.violations]
    told.sort(key=lambda violation: violation.severity is Severity.ROUNDING)
    count = sum(part.count for part in parts)
    if not count:
        return Finding(Verdict.HOLDS)
    lower_bound = lower_bound or any(part.lower_bound for part in parts)
    rounding = sum(part.rounding for part in parts)
    return Finding(Verdict.FAILS, count, tuple(told[:WITNESSES]), lower_bound, rounding=rounding)
