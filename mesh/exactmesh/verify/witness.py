"""How witnesses are written: exact determinants in fractions, names with coordinates, rows of triangles."""

from collections.abc import Callable, Iterable, Sequence
from decimal import Decimal
from fractions import Fraction

import numpy as np
import numpy.typing as npt

from exactkernel.constants import INCIRCLE_BOUND
from exactkernel.types import FloatArray, IntArray, Sign
from exactmesh.verify.properties import Severity, Verdict
from exactmesh.verify.report import WITNESSES, Finding, Violation

__all__ = [
    "IndexArray",
    "approximately",
    "finding_of",
    "incircle_determinant",
    "point_name",
    "rows_at_vertices",
    "rows_of_triangles",
    "scalar_product",
    "sign_of",
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


def incircle_determinant(points: FloatArray, corners: Iterable[int], d: int) -> tuple[Fraction, Severity]:
    """Return the incircle determinant, and whether the filter for doubles would have resolved it."""
    dx, dy = exact(points, d)
    rows = [(x - dx, y - dy) for x, y in (exact(points, v) for v in corners)]
    determinant = permanent = Fraction(0)
    for i in range(3):
        (x, y), (px, py), (qx, qy) = rows[i], rows[(i + 1) % 3], rows[(i + 2) % 3]
        lift = x * x + y * y
        determinant += lift * (px * qy - py * qx)
        permanent += lift * (abs(px * qy) + abs(py * qx))
    resolved = abs(determinant) > Fraction(INCIRCLE_BOUND) * permanent
    return determinant, Severity.WRONG if resolved else Severity.ROUNDING


def approximately(value: Fraction) -> str:
    """Return three digits of a fraction, whatever its exponent."""
    return f"{Decimal(value.numerator) / Decimal(value.denominator):.3g}"


def point_name(points: FloatArray, vertex: int) -> str:
    """Return "7 (0.5, 1.0)"."""
    return f"{vertex} ({float(points[vertex, 0])!r}, {float(points[vertex, 1])!r})"


def triangle_name(points: FloatArray, corners: Iterable[int]) -> str:
    """Return the three corners with their coordinates."""
    return ", ".join(point_name(points, int(v)) for v in corners)


def rows_of_triangles(triangles: IntArray, wanted: Sequence[tuple[int, ...]], n: int) -> list[tuple[int, ...]]:
    """Return for each triple of corners the rows of the triangles that have them, in any order. O(m)."""
    near = np.zeros(n, dtype=np.bool_)
    near[[v for corners in wanted for v in corners]] = True
    found: dict[frozenset[int], list[int]] = {frozenset(corners): [] for corners in wanted}
    candidates = np.flatnonzero(near[triangles[:, 0]])
    for row in candidates[near[triangles[candidates, 1]] & near[triangles[candidates, 2]]]:
        rows = found.get(frozenset(triangles[row].tolist()))
        if rows is not None and len(rows) < _NAMED_ROWS:
            rows.append(int(row))
    return [tuple(found[frozenset(corners)]) for corners in wanted]


def rows_at_vertices(triangles: IntArray, vertices: IndexArray, n: int) -> dict[int, tuple[int, ...]]:
    """Return for each vertex the first rows that have it as a corner. O(m)."""
    near = np.zeros(n, dtype=np.bool_)
    near[vertices] = True
    rows: dict[int, tuple[int, ...]] = {int(v): () for v in vertices}
    for row in np.flatnonzero(near[triangles].any(axis=1)):
        for v in triangles[row].tolist():
            if v in rows and len(rows[v]) < _NAMED_ROWS:
                rows[v] += (int(row),)
    return rows


def finding_of(culprits: IndexArray, describe: Callable[[int], Violation]) -> Finding:
    """Return FAILS with a violation for each of the first culprits, HOLDS where there are none."""
    if not culprits.size:
        return Finding(Verdict.HOLDS)
    told = tuple(describe(int(culprit)) for culprit in culprits[:WITNESSES])
    return Finding(Verdict.FAILS, int(culprits.size), told)
