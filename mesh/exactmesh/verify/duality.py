"""VORONOI_DUAL: a Voronoi diagram against the Delaunay triangulation, edge by edge, exactly."""

import math
from fractions import Fraction

import numpy as np
import numpy.typing as npt
from gmpy2 import mpq

from exactkernel.constants import ORIENT2D_BOUND
from exactkernel.constructions import circumcentre
from exactkernel.context import make_context
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import IntArray
from exactmesh.verify.adjacency import rows_of_slots
from exactmesh.verify.dual import Dual, Ridges, ridges_of
from exactmesh.verify.dual_passes import (
    NO,
    UNKNOWN,
    YES,
    expect_ridges,
    fill_centres,
    find_ridges,
    match_ends,
    match_vertices,
)
from exactmesh.verify.links import Links, ends_of, slot_of
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.properties import Kind, Property, Severity, Verdict
from exactmesh.verify.report import WITNESSES, Finding, Violation
from exactmesh.verify.severity import MEASURE_BOUND
from exactmesh.verify.witness import IndexArray, Ranking, approximately, exact, finding_of, joined, point_name

__all__ = ["check_dual"]


def check_dual(mesh: Mesh, links: Links, triangles: IntArray, dual: Dual, delaunay: Finding) -> Finding:
    """VORONOI_DUAL.

    Args:
        mesh: the points.
        links, triangles: counterclockwise triangles; a Delaunay triangulation, or else it is undecided.
        dual: the diagram.
        delaunay: the finding about DELAUNAY.

    Raises:
        ShapeError: the diagram is none.

    O(n log n) in general, linear if the sites come in the order of the points.
    """
    if delaunay.verdict is not Verdict.HOLDS:
        return Finding(Verdict.UNDECIDED, because=(Property.DELAUNAY,))
    claimed = ridges_of(dual, mesh, links, triangles)
    if not len(triangles):
        return Finding(Verdict.UNDECIDED)
    return joined(Check(mesh, links, triangles, claimed).findings())


class Check:
    """A diagram and the triangulation that it should be the dual of."""

    def __init__(self, mesh: Mesh, links: Links, triangles: IntArray, claimed: Ridges) -> None:
        self.mesh, self.links, self.triangles, self.claimed = mesh, links, triangles, claimed
        r = len(claimed.pairs)
        self.times = np.zeros(len(links.slots), dtype=np.intp)
        self.slots, self.rows = np.empty(r, dtype=np.intp), np.empty((r, 2), dtype=np.intp)
        rows = rows_of_slots(links, triangles)
        k, points = mesh.context, mesh.coordinates
        find_ridges(links, rows, claimed.pairs, self.times, self.slots, self.rows)
        self.expected = np.empty(len(links.slots), dtype=np.bool_)
        expect_ridges(k, points, links, self.expected, 0, len(points))
        raise_if_interrupted()
        self.centres = np.empty((len(triangles), 6))
        fill_centres(make_context(mesh.points), mesh.points, triangles, self.centres)

    def findings(self) -> list[Finding]:
        """Return what is wrong: ridges that are missing, or too many; rays; vertices."""
        real = self.slots >= 0
        ray = self.rows[:, 1] < 0
        misplaced = real & ((ray != (self.claimed.ends[:, 1] < 0)) | (self.claimed.ends[:, 0] < 0))
        told = real & ~misplaced
        empty = np.zeros(len(self.slots), dtype=np.bool_)  # between equal circumcentres: nothing, and no harm
        empty[told] = ~self.expected[self.slots[told]]
        again = np.zeros_like(empty)
        first = np.unique(self.slots[real], return_index=True)[1]
        again[real] = True
        again[np.flatnonzero(real)[first]] = False
        missing = np.flatnonzero(self.expected & (self.times == 0))
        return [
            finding_of(missing, self._missing),
            finding_of(np.flatnonzero(~real | (again & ~empty)), self._extra),
            finding_of(np.flatnonzero(misplaced), lambda r: self._ray(r, "ends where it should not, or does not end")),
            self._directions(np.flatnonzero(told & ray)),
            self._vertices(told, ray),
        ]

    def _edge(self, a: int, b: int) -> str:
        return f"{point_name(self.mesh.points, a)} - {point_name(self.mesh.points, b)}"

    def _missing(self, slot: int) -> Violation:
        a, b, _ = (int(v[0]) for v in ends_of(self.links, np.array([slot])))
        message = f"no ridge of the diagram is dual to the edge {self._edge(a, b)}"
        return Violation(Property.VORONOI_DUAL, Kind.MISSING_RIDGE, (), (a, b), message)

    def _extra(self, r: int) -> Violation:
        vertices = tuple(v for v in self.claimed.pairs[r].tolist() if v >= 0)
        message = f"ridge {r} of the diagram is dual to no edge, or to one that another ridge is dual to"
        return Violation(Property.VORONOI_DUAL, Kind.EXTRA_RIDGE, (), vertices, message)

    def _ray(self, r: int, fault: str) -> Violation:
        a, b = self.claimed.pairs[r].tolist()
        message = f"ridge {r} of the diagram, dual to the edge {self._edge(a, b)}, {fault}"
        return Violation(Property.VORONOI_DUAL, Kind.WRONG_RAY, (), (a, b), message)

    def _directions(self, rays: IndexArray) -> Finding:
        """A direction that is given points out of the hull, and is perpendicular but for the rounding of it."""
        bad = [r for r in rays[~np.isnan(self.claimed.directions[rays]).all(axis=1)].tolist() if not self._leaves(r)]
        return finding_of(np.array(bad, dtype=np.intp), lambda r: self._ray(r, "has a wrong direction"))

    def _leaves(self, r: int) -> bool:
        a, b = self.claimed.pairs[r].tolist()
        if slot_of(self.links.slots, self.links.first[a], self.links.last[a], b) < 0:
            a, b = b, a
        dx, dy = self.claimed.directions[r].tolist()
        if not (math.isfinite(dx) and math.isfinite(dy)):
            return False
        (ax, ay), (bx, by) = exact(self.mesh.points, a), exact(self.mesh.points, b)
        ux, uy, x, y = bx - ax, by - ay, Fraction(dx), Fraction(dy)
        return x * uy - y * ux > 0 and abs(x * ux + y * uy) <= Fraction(ORIENT2D_BOUND) * (abs(x * ux) + abs(y * uy))

    def _vertices(self, told: npt.NDArray[np.bool_], ray: npt.NDArray[np.bool_]) -> Finding:
        """Every end of a ridge is next to the circumcentre of its triangle; and every vertex is such an end."""
        segments, rays = np.flatnonzero(told & ~ray), np.flatnonzero(told & ray)
        ends, rows = self.claimed.ends[segments], self.rows[segments]
        sure = np.empty(len(ends), dtype=np.intp)
        match_ends(self.centres, self.claimed.vertices, ends, rows, sure)
        for i in np.flatnonzero(sure == UNKNOWN).tolist():
            (p, q), (s, t) = ends[i].tolist(), rows[i].tolist()
            if (self._is_next(p, s) and self._is_next(q, t)) or (self._is_next(p, t) and self._is_next(q, s)):
                sure[i] = YES
        pairs = [np.stack([ends[sure != YES].ravel(), rows[sure != YES].ravel()], axis=1)]
        pairs.append(np.stack([self.claimed.ends[rays, 0], self.rows[rays, 0]], axis=1))
        if self.claimed.by_triangle:
            pairs.append(np.stack([np.arange(len(self.triangles))] * 2, axis=1))
        suspects = np.unique(np.concatenate(pairs), axis=0)
        one = np.empty(len(suspects), dtype=np.intp)
        match_vertices(self.centres, self.claimed.vertices, suspects, one)
        for i in np.flatnonzero(one == UNKNOWN).tolist():
            one[i] = YES if self._is_next(*suspects[i].tolist()) else NO
        wrong = suspects[one == NO]
        found = finding_of(np.arange(len(wrong)), lambda i: self._wrong(*wrong[i].tolist()), self._ranking(wrong))
        used = np.zeros(len(self.claimed.vertices) + 1, dtype=np.bool_)  # the last one for infinity
        used[self.claimed.ends.ravel()] = True
        stray = np.flatnonzero(~used[:-1]) if not self.claimed.by_triangle else np.empty(0, dtype=np.intp)
        return joined([finding_of(stray, self._stray), found])

    def _ranking(self, wrong: IndexArray) -> Ranking:
        rounding = np.array([self._severity(v, t) is Severity.ROUNDING for v, t in wrong.tolist()], dtype=np.bool_)
        return Ranking(np.argsort(rounding, kind="stable")[:WITNESSES], int(rounding.sum()))

    def _centre(self, t: int) -> tuple[mpq, mpq]:
        return circumcentre(*(tuple(self.mesh.points[v].tolist()) for v in self.triangles[t]))

    def _is_next(self, v: int, t: int) -> bool:
        """Tell whether the coordinates are doubles next to the exact ones."""
        raise_if_interrupted()
        (x, y), (zx, zy) = self.claimed.vertices[v].tolist(), self._centre(t)
        return _is_neighbour(x, zx) and _is_neighbour(y, zy)

    def _severity(self, v: int, t: int) -> Severity:
        """ROUNDING where doubles hardly tell that the squared distances from the corners differ."""
        x, y = self.claimed.vertices[v].tolist()
        if not (math.isfinite(x) and math.isfinite(y)):
            return Severity.WRONG
        (ax, ay), *others = ((mpq(p), mpq(q)) for p, q in self.mesh.points[self.triangles[t]].tolist())
        zx, zy = mpq(x), mpq(y)
        for bx, by in others:
            ux, uy = bx - ax, by - ay
            value = 2 * ((zx - ax) * ux + (zy - ay) * uy) - (ux * ux + uy * uy)
            permanent = 2 * ((abs(zx) + abs(ax)) * abs(ux) + (abs(zy) + abs(ay)) * abs(uy)) + ux * ux + uy * uy
            if abs(value) > mpq(MEASURE_BOUND) * permanent:
                return Severity.WRONG
        return Severity.ROUNDING

    def _wrong(self, v: int, t: int) -> Violation:
        x, y = self.claimed.vertices[v].tolist()
        corners, severity, squared = tuple(self.triangles[t].tolist()), self._severity(v, t), None
        message = f"vertex {v} ({x!r}, {y!r}) of the diagram is not the circumcentre of triangle {t}"
        if math.isfinite(x) and math.isfinite(y):
            zx, zy = (Fraction(int(z.numerator), int(z.denominator)) for z in self._centre(t))
            squared = (Fraction(x) - zx) ** 2 + (Fraction(y) - zy) ** 2
            message += f": its squared distance is {approximately(squared)}"
        if severity is Severity.ROUNDING:
            message += ", rounding-sized"
        kind = Kind.WRONG_CENTRE
        return Violation(Property.VORONOI_DUAL, kind, (t,), corners, message, magnitude=squared, severity=severity)

    def _stray(self, v: int) -> Violation:
        message = f"vertex {v} of the diagram is the end of no ridge"
        return Violation(Property.VORONOI_DUAL, Kind.WRONG_CENTRE, (), (), message)


def _is_neighbour(claimed: float, z: mpq) -> bool:
    """Tell whether a double is the exact number, or one of the two doubles (or infinities) next to it."""
    if math.isnan(claimed):
        return False
    below, above = math.nextafter(claimed, -math.inf), math.nextafter(claimed, math.inf)
    over = below == -math.inf or mpq(below) < z
    return over and (above == math.inf or z < mpq(above))
