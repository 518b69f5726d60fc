"""What a violation names, cut out of the mesh: small arrays, and Python that makes them again."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray
from exactmesh.verify.checked import CheckedMesh

if TYPE_CHECKING:
    from exactmesh.verify.report import Finding, Violation

__all__ = ["Submesh", "cut_out", "with_numbers"]

_NOWHERE = (math.nan, math.nan)


@dataclass(frozen=True, slots=True, eq=False)
class Submesh:
    """Some cells of a mesh, and some points, numbered anew.

    Attributes:
        points: float64 (k, 2).
        triangles: int64 (t, 3).
        quads: int64 (q, 4).
        indices: the numbers of the points in the whole mesh, ascending. An index that is out of range there is not
            among them, and out of range here.
        cells: the rows of triangles and then of quads in the whole mesh.
    """

    points: FloatArray
    triangles: npt.NDArray[np.int64]
    quads: npt.NDArray[np.int64]
    indices: tuple[int, ...]
    cells: tuple[int, ...]

    def to_python(self) -> str:
        """Return source that assigns ``points`` and ``triangles``, and ``quads`` where there are some."""
        numbers = (f"point {v}" for v in self.indices)
        lines = [*_assignment("points", self.points.tolist(), numbers)]
        rows = (f"cell {row}" for row in self.cells)
        lines += _assignment("triangles", self.triangles.tolist(), rows)
        if len(self.quads):
            lines += _assignment("quads", self.quads.tolist(), rows)
        return "\n".join(lines) + "\n"


def _assignment(name: str, rows: Sequence[Sequence[float]], comments: Iterator[str]) -> Iterator[str]:
    if not rows:
        yield f"{name} = []"
        return
    yield f"{name} = ["
    for row in rows:
        yield f"    ({', '.join(map(_literal, row))}),  # {next(comments)}"
    yield "]"


def _literal(number: float) -> str:
    return repr(number) if math.isfinite(number) else f'float("{number!r}")'


def with_numbers(finding: "Finding", mesh: CheckedMesh) -> "Finding":
    """Return the finding with the coordinates in its violations, so that these say all by themselves."""
    if not finding.violations:
        return finding
    return replace(finding, violations=tuple(_with_numbers(violation, mesh) for violation in finding.violations))


def _with_numbers(violation: "Violation", mesh: CheckedMesh) -> "Violation":
    m, n = len(mesh.triangles), len(mesh.points)
    corners = tuple(
        tuple(int(v) for v in (mesh.triangles[row] if row < m else mesh.quads[row - m])) for row in violation.triangles
    )
    indices = sorted({*violation.vertices, *(v for cell in corners for v in cell)})
    x, y = mesh.points.T
    points = tuple((float(x[v]), float(y[v])) if 0 <= v < n else _NOWHERE for v in indices)
    return replace(violation, corners=corners, points=points, indices=tuple(indices), point_count=n)


def cut_out(violation: "Violation") -> Submesh:
    """Return the violation's cells and vertices as a mesh."""
    there = [i for i, v in enumerate(violation.indices) if 0 <= v < violation.point_count]
    kept = [violation.indices[i] for i in there]
    number = {v: i for i, v in enumerate(kept)}
    others = [v for v in violation.indices if v not in number]  # some may be beyond 64 bits
    beyond = {v: -1 - i if v < 0 else len(kept) + i for i, v in enumerate(others)}
    cells = [tuple({**number, **beyond}[v] for v in corners) for corners in violation.corners]
    points = np.array([violation.points[i] for i in there], dtype=np.float64).reshape(-1, 2)
    rows = {
        size: [(row, cell) for row, cell in zip(violation.triangles, cells, strict=True) if len(cell) == size]
        for size in (3, 4)
    }
    triangles, quads = (np.array([cell for _, cell in rows[size]], dtype=np.int64).reshape(-1, size) for size in (3, 4))
    return Submesh(points, triangles, quads, tuple(kept), tuple(row for size in (3, 4) for row, _ in rows[size]))
