"""The truth about one small mesh with segments, a domain and labels, by brute force in fractions.

The domain is a union of triangles that are known, so that covering it is a matter of areas.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import combinations

from proofs_tests import oracles
from proofs_tests.kernel import shape_oracle
from proofs_tests.oracles import RationalPoint, Triangle
from proofs_tests.verify import domain_oracle, gabriel_oracle
from proofs_tests.verify.domain_oracle import Line

from exactmesh.verify import Property

__all__ = ["Area", "Case", "Given", "Truth"]

Given = tuple[float, float]


@dataclass(frozen=True)
class Area:
    """A domain: its own points, disjoint counterclockwise triangles that make it up, segments, a point in each hole."""

    points: list[Given]
    triangles: list[Triangle]
    segments: list[tuple[int, int]]
    holes: list[Given]


@dataclass(frozen=True)
class Case:
    """A mesh as it is given to the verifier, and bounds on its shapes."""

    points: list[Given]
    triangles: list[Triangle]
    segments: list[tuple[int, int]] | None = None
    labels: list[float] | None = None
    area: Area | None = None
    bounds: tuple[float, float, float] | None = None
    circles: bool = False


@lru_cache(maxsize=2**16)
def exact(p: Given) -> RationalPoint:
    return Fraction(p[0]), Fraction(p[1])


@lru_cache(maxsize=2**16)
def meet(s: tuple[Given, ...], t: tuple[Given, ...], common: tuple[tuple[int, int], ...]) -> bool:
    """Two triangles meet admissibly; ``common`` says which corners are the same by index."""
    names = [0, 1, 2, 3, 4, 5]
    for i, j in common:
        names[3 + j] = i
    points = [exact(p) for p in (*s, *t)]
    return oracles.meet_admissibly(points, (0, 1, 2), (names[3], names[4], names[5]))


@lru_cache(maxsize=2**14)
def common_area(s: tuple[Given, ...], t: tuple[Given, ...]) -> Fraction:
    """Twice the area of the intersection of two triangles."""
    polygon = oracles.intersection([exact(p) for p in (*s, *t)], (0, 1, 2), (3, 4, 5))
    turned = polygon[1:] + polygon[:1]
    return abs(sum((p[0] * q[1] - p[1] * q[0] for p, q in zip(polygon, turned, strict=True)), Fraction(0)))


@lru_cache(maxsize=2**10)
def hull_area(points: tuple[Given, ...]) -> Fraction:
    """Twice the area of the hull."""
    return oracles.hull_area([exact(p) for p in points])


def edges_of(triangles: Iterable[Triangle]) -> Counter[frozenset[int]]:
    return Counter(frozenset(pair) for t in triangles for pair in combinations(t, 2))


class Truth:
    """What is true of a case: a statement for each property, to be asked only where the verifier decided."""

    def __init__(self, case: Case) -> None:
        self.case = case
        self.triangles = case.triangles
        self.points = [exact(p) for p in case.points]

    def ask(self, property_: Property) -> bool:
        """Decide a property of finite points and triangles whose indices are right."""
        answers: dict[Property, Callable[[], bool]] = {
            Property.FINITE: lambda: True,
            Property.INDICES: lambda: True,
            Property.DISTINCT_POINTS: lambda: len(set(self.points)) == len(self.points),
            Property.ORIENTATION: lambda: all(self.turn(t) > 0 for t in self.triangles),
            Property.ALL_POINTS_USED: lambda: {v for t in self.triangles for v in t} == set(range(len(self.points))),
            Property.EDGE_MANIFOLD: lambda: oracles.is_edge_manifold(self.triangles),
            Property.VERTEX_MANIFOLD: lambda: oracles.is_vertex_manifold(self.triangles),
            Property.ADMISSIBLE: lambda: self.admissible,
            Property.COVERS_HULL: lambda: self._area == hull_area(tuple(self.case.points)),
            Property.DELAUNAY: lambda: oracles.is_delaunay(self.points, self.triangles),
            Property.SEGMENTS_PRESENT: lambda: self.segments_present,
            Property.CONSTRAINED_DELAUNAY: self._constrained_delaunay,
            Property.COVERS_DOMAIN: self._covers_domain,
            Property.DOMAIN_POINTS: self._domain_points,
            Property.NO_NEW_POINTS: lambda: self._corners <= set(self._theirs),
            Property.REGIONS: self._regions,
            Property.WEAKLY_ACUTE: lambda: self.solid and all(self._largest(t) <= 0 for t in self.triangles),
            Property.ACUTE: lambda: self.solid and all(self._largest(t) < 0 for t in self.triangles),
            Property.MIN_ANGLE: lambda: self._within(shape_oracle.angle_below, self._bounds[0]),
            Property.MAX_ANGLE: lambda: self._within(shape_oracle.angle_above, self._bounds[1]),
            Property.MAX_AREA: lambda: (
                not any(abs(self.turn(t)) > 2 * Fraction(self._bounds[2]) for t in self.triangles)
            ),
            Property.GABRIEL: lambda: not gabriel_oracle.encroachers(self.points, self.triangles, self._own_segments),
            Property.CIRCUMCENTRES_INSIDE: lambda: gabriel_oracle.centres_inside(self.points, self.triangles),
        }
        return answers[property_]()

    def turn(self, t: Triangle) -> Fraction:
        a, b, c = t
        return oracles.orient(self.points[a], self.points[b], self.points[c])

    @property
    def _area(self) -> Fraction:
        """Twice the area of admissible triangles."""
        return sum((abs(self.turn(t)) for t in self.triangles), Fraction(0))

    def _corners_of(self, t: Triangle) -> tuple[Given, Given, Given]:
        a, b, c = t
        return self.case.points[a], self.case.points[b], self.case.points[c]

    @property
    def _bounds(self) -> tuple[float, float, float]:
        assert self.case.bounds is not None
        return self.case.bounds

    def _largest(self, t: Triangle) -> int:
        return oracles.largest_angle_sign(self.points, t)

    def _within(self, is_beyond: Callable[[Sequence[RationalPoint], float], bool], bound: float) -> bool:
        return self.solid and not any(is_beyond([self.points[v] for v in t], bound) for t in self.triangles)

    @cached_property
    def solid(self) -> bool:
        return all(self.turn(t) != 0 for t in self.triangles)

    @cached_property
    def admissible(self) -> bool:
        return self.solid and all(
            meet(
                self._corners_of(s),
                self._corners_of(t),
                tuple((i, t.index(v)) for i, v in enumerate(s) if v in t),
            )
            for s, t in combinations(self.triangles, 2)
        )

    @property
    def _theirs(self) -> list[RationalPoint]:
        return [] if self.case.area is None else [exact(p) for p in self.case.area.points]

    @property
    def _corners(self) -> set[RationalPoint]:
        return {self.points[v] for t in self.triangles for v in t}

    @property
    def _own_segments(self) -> list[tuple[int, int]]:
        """Segments in the mesh's own points: those of a domain where its points are corners."""
        if self.case.area is None:
            return self.case.segments or []
        rows = {p: v for v, p in enumerate(self.points)}
        theirs = self._theirs
        return [(rows[theirs[a]], rows[theirs[b]]) for a, b in self.case.area.segments]

    @property
    def lines(self) -> list[Line]:
        """What is a segment of the mesh or of the domain."""
        if self.case.area is not None:
            theirs = self._theirs
            return [(theirs[a], theirs[b]) for a, b in self.case.area.segments]
        return [(self.points[a], self.points[b]) for a, b in self.case.segments or ()]

    @cached_property
    def segments_present(self) -> bool:
        edges = set(edges_of(self.triangles))
        if self.case.area is None:
            return all(domain_oracle.is_chain(self.points, edges, a, b) for a, b in self.case.segments or ())
        chains = all(self._is_chain(line, edges) for line in self.lines)
        return chains or all(self._is_drawn(line, edges) for line in self.lines)

    def _is_chain(self, line: Line, edges: set[frozenset[int]]) -> bool:
        starts, ends = ([v for v, p in enumerate(self.points) if p == end] for end in line)
        return any(domain_oracle.is_chain(self.points, edges, a, b) for a in starts for b in ends)

    def _is_drawn(self, line: Line, edges: set[frozenset[int]]) -> bool:
        """Edges along the segment leave no gap: all segments here lie in the domain, none may be missing in part."""
        low, high = min(line), max(line)
        ends = [sorted(self.points[v] for v in edge) for edge in edges]
        reached = low
        for p, q in sorted((p, q) for p, q in ends if oracles.on_segment(p, *line) and oracles.on_segment(q, *line)):
            if p > reached:
                return False
            reached = max(reached, q)
        return reached == high

    def _constrained_delaunay(self) -> bool:
        edges = edges_of(self.triangles)
        rim = [(self.points[a], self.points[b]) for a, b in (edge for edge, count in edges.items() if count == 1)]
        blockers = (*self.lines, *rim)
        for t in self.triangles:
            corners = [self.points[v] for v in oracles.counterclockwise(self.points, t)]
            centre, radius = oracles.circumcircle(*corners)
            for p in set(self.points):
                if oracles.squared_distance(centre, p) < radius and domain_oracle.is_visible(p, corners, blockers):
                    return False
        return True

    def _covers_domain(self) -> bool:
        """For admissible triangles, whose areas add up."""
        assert self.case.area is not None
        theirs = [tuple(self.case.area.points[v] for v in t) for t in self.case.area.triangles]
        own = [self._corners_of(t) for t in self.triangles]
        whole = [common_area(d, d) for d in theirs]
        inside = [sum((common_area(d, t) for t in own), Fraction(0)) for d in theirs]
        return inside == whole and self._area == sum(whole)

    def _domain_points(self) -> bool:
        assert self.case.area is not None
        theirs, corners = self._theirs, self._corners
        return all(
            p in corners
            for p in theirs
            if any(
                oracles.orient(theirs[a], theirs[b], p) >= 0
                and oracles.orient(theirs[b], theirs[c], p) >= 0
                and oracles.orient(theirs[c], theirs[a], p) >= 0
                for a, b, c in self.case.area.triangles
            )
        )

    def _regions(self) -> bool:
        assert self.case.labels is not None
        by_edge: dict[frozenset[int], list[float]] = {}
        for t, label in zip(self.triangles, self.case.labels, strict=True):
            for pair in combinations(t, 2):
                by_edge.setdefault(frozenset(pair), []).append(label)
        return all(
            len(set(labels)) == 1
            for edge, labels in by_edge.items()
            if not any(all(oracles.on_segment(self.points[v], *line) for v in edge) for line in self.lines)
        )
