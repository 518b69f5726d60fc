"""What is carved away and what is kept, whose region it is, what markers say, and how the boundary runs."""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from proofs_tests import oracles
from proofs_tests.graphs.strategies import Seeded, seeded
from proofs_tests.mesh import constrained_oracle
from proofs_tests.mesh.constrained_oracle import Segment
from proofs_tests.oracles import RationalPoint, Triangle

from exactmesh import PSLG, Carve, FaultKind, PSLGError, Triangulation, constrained_delaunay, delaunay, verify
from exactmesh.errors import CollinearPointsError, TooFewPointsError

Corners = tuple[RationalPoint, ...]
Faults = list[tuple[FaultKind, tuple[int, ...]]]


class Expected:
    """What brute force in fractions says of a graph, given the triangles of its hull."""

    def __init__(self, pslg: PSLG, *, even_odd: bool) -> None:
        hull = constrained_delaunay(PSLG(pslg.points, pslg.segments), carve=False)
        self.points = oracles.rationals(hull.points.tolist())
        exact = oracles.rationals(pslg.points.tolist())
        self.segments: list[Segment] = [
            (self.points.index(exact[a]), self.points.index(exact[b])) for a, b in pslg.segments.tolist()
        ]
        self.triangles: list[Triangle] = [(a, b, c) for a, b, c in hull.triangles.tolist()]
        holes = oracles.rationals(pslg.holes.tolist())
        seeds = oracles.rationals(pslg.regions[:, :2].tolist())
        self.even_odd = even_odd
        self.places = constrained_oracle.places(self.points, self.segments, self.triangles, holes, even_odd=even_odd)
        self.hole_rows = [self.row_of(hole) for hole in holes]
        self.region_rows = [self.row_of(seed) for seed in seeds]
        self.labels = [row[2:] for row in pslg.regions.tolist()]
        self.faces = constrained_oracle.components(self.triangles, constrained_oracle.noded(self.points, self.segments))

    def row_of(self, seed: RationalPoint) -> int:
        """A triangle that contains the seed; any of them, for they are in one face."""
        return next(row for row, t in enumerate(self.triangles) if constrained_oracle.contains(self.points, t, seed))

    def lost(self, segment: Segment) -> bool:
        """Tell whether a piece of the segment has the exterior on both sides."""
        exterior = {row for row, place in enumerate(self.places) if place == "exterior"}
        for piece in constrained_oracle.noded(self.points, [segment]):
            beside = {row for row, t in enumerate(self.triangles) if piece in constrained_oracle.edges_of(t)}
            if beside <= exterior:
                return True
        return False

    def faults(self) -> Faults:
        """What must be named."""
        if self.even_odd:
            ends = Counter(v for segment in self.segments for v in segment)
            if any(count % 2 for count in ends.values()):
                return [(FaultKind.INCONSISTENT_PARITY, ())]
        found: Faults = []
        if not self.even_odd:
            found += [(FaultKind.NOT_CLOSED, (i,)) for i, s in enumerate(self.segments) if self.lost(s)]
            found += [(FaultKind.NOT_CLOSED, ())] * (not self.segments)
        for i, row in enumerate(self.hole_rows):
            if self.places[row] == "exterior":
                found.append((FaultKind.HOLE_OUTSIDE, (i,)))
        for i, row in enumerate(self.region_rows):
            if self.places[row] != "domain":
                found.append((FaultKind.REGION_OUTSIDE, (i,)))
        if not found and "domain" not in self.places:
            found.append((FaultKind.EMPTY_DOMAIN, ()))
        return found or self.disagreements()

    def disagreements(self) -> Faults:
        first = self.regions()
        return [
            (FaultKind.REGIONS_DISAGREE, (first[row], i))
            for i, row in enumerate(self.region_rows)
            if self.labels[first[row]] != self.labels[i]
        ]

    def regions(self) -> list[int]:
        """The first region whose seed is in the face of each triangle, or -1."""
        found = [-1] * len(self.triangles)
        for face in self.faces:
            inside = [i for i, row in enumerate(self.region_rows) if row in face]
            for row in face:
                found[row] = min(inside, default=-1)
        return found

    def domain(self) -> list[int]:
        return [row for row, place in enumerate(self.places) if place == "domain"]

    def corners(self, rows: Iterable[int]) -> list[Corners]:
        return [turned(self.points[v] for v in self.triangles[row]) for row in rows]


def turned(corners: Iterable[RationalPoint]) -> Corners:
    """The corners from the smallest on."""
    cycle = tuple(corners)
    first = cycle.index(min(cycle))
    return cycle[first:] + cycle[:first]


def corners_of(mesh: Triangulation) -> list[Corners]:
    points = oracles.rationals(mesh.points.tolist())
    return [turned(points[v] for v in t) for t in mesh.triangles.tolist()]


def rule_of(case: Seeded) -> Carve:
    return Carve.EVEN_ODD if case.even_odd else Carve.SEEDS


def pslg_of(case: Seeded, **columns: Any) -> PSLG | None:
    """The graph, without the seeds that PSLG itself refuses; None if its points are collinear."""
    graph = case.graph

    def is_taken(**seeds: Any) -> bool:
        try:
            PSLG(graph.points, graph.segments, **seeds)
        except PSLGError:
            return False
        return True

    holes = [hole for hole in case.holes if is_taken(holes=[hole])]
    regions = [region for region in case.regions if is_taken(regions=[region])]
    try:
        delaunay(graph.points)
    except (CollinearPointsError, TooFewPointsError):
        return None
    return PSLG(graph.points, graph.segments, holes=holes, regions=regions, rule=rule_of(case), **columns)


def carved(pslg: PSLG) -> Triangulation | Faults:
    """The triangulation, or the faults of the refusal."""
    try:
        return constrained_delaunay(pslg)
    except PSLGError as error:
        return [
            (fault.kind, () if fault.kind is FaultKind.INCONSISTENT_PARITY else fault.indices) for fault in error.faults
        ]


@pytest.mark.obligation(
    "M5", "the domain is what ray casting and floods say; what is wrong with it is named", method="property-based"
)
class TestDomain:
    """A triangle of the hull is kept just if it is in the domain: by parity, an odd number of segments lies on a ray
    from it, each of several coincident ones counted; by seeds, no path over edges that are no segments leads from it to
    infinity or a hole. Refused are exactly the graphs with faults, and all of those are named."""

    @given(seeded())
    @settings(max_examples=150)
    def test_brute_force(self, case: Seeded) -> None:
        pslg = pslg_of(case)
        if pslg is None:
            return
        expected, mesh = Expected(pslg, even_odd=case.even_odd), carved(pslg)
        if not isinstance(mesh, Triangulation):
            assert {kind for kind, _ in mesh} == {kind for kind, _ in expected.faults()}
            assert sorted(set(mesh)) == sorted(set(expected.faults()))
            return
        assert expected.faults() == []
        assert sorted(corners_of(mesh)) == sorted(expected.corners(expected.domain()))

    @given(seeded())
    @settings(max_examples=60)
    def test_regions(self, case: Seeded) -> None:
        """Each triangle has the first region whose seed is in its face, and that region's attribute."""
        pslg = pslg_of(case)
        mesh = carved(pslg) if pslg else []
        if pslg is None or not isinstance(mesh, Triangulation):
            return
        expected = Expected(pslg, even_odd=case.even_odd)
        regions = expected.regions()
        found = dict(zip(corners_of(mesh), mesh.triangle_regions.tolist(), strict=True))
        assert found == {corner: regions[row] for row in expected.domain() for corner in expected.corners([row])}
        assert mesh.triangle_attributes.shape == (len(mesh.triangles), int(len(pslg.regions) > 0))
        if len(pslg.regions):
            labels = [expected.labels[i][0] if i >= 0 else 0.0 for i in mesh.triangle_regions.tolist()]
            assert mesh.triangle_attributes[:, 0].tolist() == labels

    @given(seeded())
    @settings(max_examples=60)
    def test_vertices(self, case: Seeded) -> None:
        """The vertices are the corners of the triangles, in the order of the input; all other points lie outside."""
        pslg = pslg_of(case)
        mesh = carved(pslg) if pslg else []
        if pslg is None or not isinstance(mesh, Triangulation):
            return
        exact, places = oracles.rationals(pslg.points.tolist()), oracles.rationals(mesh.points.tolist())
        used = {corner for corners in corners_of(mesh) for corner in corners}
        assert places == [p for p in dict.fromkeys(exact) if p in used]
        assert mesh.representative.tolist() == [places.index(p) if p in used else -1 for p in exact]

    @given(seeded())
    @settings(max_examples=60)
    def test_segments(self, case: Seeded) -> None:
        """The constrained edges are the pieces at the domain; a chain leaves out what lies outside of it."""
        pslg = pslg_of(case)
        mesh = carved(pslg) if pslg else []
        if pslg is None or not isinstance(mesh, Triangulation):
            return
        expected = Expected(pslg, even_odd=case.even_odd)
        kept = {
            frozenset(expected.points[v] for v in edge)
            for row in expected.domain()
            for edge in constrained_oracle.edges_of(expected.triangles[row])
        }
        places = oracles.rationals(mesh.points.tolist())
        incidence = set()
        for i, segment in enumerate(expected.segments):
            chain = [expected.points[v] for v in constrained_oracle.chain(expected.points, segment)]
            inside = [pair for pair in pairwise(chain) if frozenset(pair) in kept]
            assert [(places[a], places[b]) for a, b in mesh.chain(i).tolist()] == inside
            incidence |= {(frozenset(pair), i) for pair in inside}
        edges = [frozenset(places[v] for v in edge) for edge in mesh.segments.tolist()]
        assert sorted(mesh.segment_incidence.tolist()) == mesh.segment_incidence.tolist()
        assert {(edges[row], i) for row, i in mesh.segment_incidence.tolist()} == incidence
        assert len(set(edges)) == len(edges) == len({edge for edge, _ in incidence})

    @given(seeded())
    @settings(max_examples=40)
    def test_verified(self, case: Seeded) -> None:
        """The verifier, which knows of no flood, agrees, with each region as well."""
        pslg = pslg_of(case)
        mesh = carved(pslg) if pslg else []
        if pslg is None or not isinstance(mesh, Triangulation):
            return
        labels = mesh.triangle_attributes[:, 0] if len(pslg.regions) else None
        report = verify(mesh.points, mesh.triangles, domain=pslg, labels=labels)
        assert report.ok, report.violations
        assert verify(mesh.points, mesh.triangles, domain=mesh.domain, labels=labels).ok

    def test_control_coincident_rings(self) -> None:
        """Each of several coincident segments counts: a ring given twice bounds nothing, three times, it does."""
        ring, hole = [(0, 0), (4, 0), (0, 4)], [(1, 1), (2, 1), (1, 2)]
        for times, area in ((1, 15), (2, 16), (3, 15)):
            mesh = rings_domain([ring, *[hole] * times])
            assert twice_area(mesh) == area
        with pytest.raises(PSLGError, match="every face is exterior"):
            rings_domain([ring, ring])


def ring_graph(rings: Sequence[Sequence[tuple[float, float]]], **more: Any) -> PSLG:
    """Each ring with points of its own, as rings from elsewhere come."""
    points = [p for ring in rings for p in ring]
    starts = np.cumsum([0, *(len(ring) for ring in rings)])
    segments = [
        (int(start) + i, int(start) + (i + 1) % len(ring))
        for start, ring in zip(starts, rings, strict=False)
        for i in range(len(ring))
    ]
    return PSLG(points, segments, **more)


def rings_domain(rings: Sequence[Sequence[tuple[float, float]]], **more: Any) -> Triangulation:
    return constrained_delaunay(ring_graph(rings, rule=Carve.EVEN_ODD, **more))


def twice_area(mesh: Triangulation) -> Fraction:
    points = oracles.rationals(mesh.points.tolist())
    return sum((oracles.orient(*(points[v] for v in t)) for t in mesh.triangles.tolist()), Fraction(0))


def square(x: float, y: float, side: float) -> list[tuple[float, float]]:
    return [(x, y), (x + side, y), (x + side, y + side), (x, y + side)]


def diamond(x: float, y: float, radius: float) -> list[tuple[float, float]]:
    return [(x - radius, y), (x, y - radius), (x + radius, y), (x, y + radius)]


#: Rings by even-odd: (rings, twice the area, number of outer loops, of holes).
RINGS: dict[str, tuple[list[list[tuple[float, float]]], int, int, int]] = {
    "one": ([square(0, 0, 4)], 32, 1, 0),
    "nested five deep": ([square(i, i, 20 - 2 * i) for i in range(5)], 800 - 648 + 512 - 392 + 288, 3, 2),
    "a hole at a corner of the outline": ([square(0, 0, 4), [(0, 0), (2, 1), (1, 2)]], 29, 1, 1),
    "a hole that touches the outline's side": ([square(0, 0, 4), [(2, 0), (3, 2), (1, 2)]], 28, 1, 1),
    "a hole that cuts through": ([square(0, 0, 4), diamond(2, 2, 2)], 16, 4, 0),
    "two holes that touch": ([square(0, 0, 8), diamond(3, 4, 1), diamond(5, 4, 1)], 120, 1, 2),
    "four holes around an island": (
        [square(0, 0, 12), *(diamond(x, y, 2) for x, y in ((4, 4), (8, 4), (4, 8), (8, 8)))], 224, 2, 1
    ),
    "four holes with sides in common": (
        [square(0, 0, 12), *(diamond(x, y, 2) for x, y in ((6, 4), (4, 6), (8, 6), (6, 8)))], 224, 1, 1
    ),
    "pinched outline": ([[(0, 0), (2, 2), (4, 0), (4, 4), (2, 2), (0, 4)]], 16, 2, 0),
    "two squares with a side in common": ([square(0, 0, 4), square(4, 0, 4)], 64, 1, 0),
    "two squares with part of a side in common": ([square(0, 0, 4), square(4, 2, 4)], 64, 1, 0),
    "two frames": ([square(0, 0, 9), square(1, 1, 7), square(2, 2, 5), square(3, 3, 3)], 96, 2, 2),
    "an island that touches the hole around it": ([square(0, 0, 9), square(1, 1, 7), diamond(4, 4, 3)], 100, 2, 1),
    "squares at a corner": ([square(0, 0, 2), square(2, 2, 2)], 16, 2, 0),
    "a ring twice inside": ([square(0, 0, 9), square(2, 2, 5), square(2, 2, 5)], 162, 1, 0),
}  # fmt: skip


@pytest.mark.obligation(
    "M5", "named arrangements of rings have the area and the loops that they have", method="named cases"
)
@pytest.mark.parametrize(("rings", "area", "outer", "holes"), RINGS.values(), ids=RINGS.keys())
class TestRings:
    """By even-odd, and by seeds where rings do not touch themselves, the area is the right one, exactly, and so are the
    numbers of outer loops and holes."""

    def test_even_odd(self, rings: list[list[tuple[float, float]]], area: int, outer: int, holes: int) -> None:
        mesh = rings_domain(rings)
        points = oracles.rationals(mesh.points.tolist())
        signs = [constrained_oracle.signed_area(points, loop) > 0 for loop in (b.tolist() for b in mesh.boundary())]
        assert twice_area(mesh) == area
        assert (signs.count(True), signs.count(False)) == (outer, holes)

    def test_control_one_ring_less(
        self, rings: list[list[tuple[float, float]]], area: int, outer: int, holes: int
    ) -> None:
        """Without its last ring the domain is another one."""
        del outer, holes
        if len(rings) > 1:
            assert twice_area(rings_domain(rings[:-1])) != area


def sides_of(rows: Iterable[Sequence[int]]) -> list[tuple[int, int]]:
    return [(row[i - 1], row[i]) for row in rows for i in range(len(row))]


def check_loops(mesh: Triangulation, loops: Sequence[Sequence[int]]) -> None:
    """Simple, the open sides just once, area for area; one outer loop for each piece of the domain."""
    points = oracles.rationals(mesh.points.tolist())
    rows: list[Triangle] = [(a, b, c) for a, b, c in mesh.triangles.tolist()]
    inner = set(sides_of(rows))
    assert sorted(sides_of(loops)) == sorted(side for side in inner if side[::-1] not in inner)
    for loop in loops:
        assert len(set(loop)) == len(loop) >= 3
        assert points[loop[0]] == min(points[v] for v in loop)
    areas = [constrained_oracle.signed_area(points, loop) for loop in loops]
    assert sum(areas) == twice_area(mesh)
    pieces = constrained_oracle.components(rows, ())
    for piece in pieces:
        corners = set(sides_of([rows[row] for row in piece]))
        assert [area > 0 for loop, area in zip(loops, areas, strict=True) if set(sides_of([loop])) <= corners].count(
            True
        ) == 1
    assert sum(area > 0 for area in areas) == len(pieces)


@pytest.mark.obligation(
    "M5", "the boundary is simple loops with the domain on their left, area for area", method="property-based"
)
class TestBoundary:
    """boundary() consists of simple loops; their sides are the sides with a triangle on the left only, each once; each
    piece that holds together over edges has one outer loop, counterclockwise; areas add up exactly."""

    @given(seeded())
    @settings(max_examples=60)
    def test_loops(self, case: Seeded) -> None:
        pslg = pslg_of(case)
        mesh = carved(pslg) if pslg else []
        if isinstance(mesh, Triangulation):
            check_loops(mesh, [loop.tolist() for loop in mesh.boundary()])

    @pytest.mark.parametrize(
        "damage",
        [
            lambda loops: loops[:-1],
            lambda loops: [loops[0][::-1], *loops[1:]],
            lambda loops: [loops[0][1:] + loops[0][:1], *loops[1:]],
            lambda loops: [loops[0] + loops[1], *loops[2:]],
        ],
        ids=["one missing", "turned round", "begun elsewhere", "two as one"],
    )
    def test_control_damaged(self, damage: Callable[[list[list[int]]], list[list[int]]]) -> None:
        """A loop missing, turned round, begun elsewhere, two joined."""
        mesh = rings_domain(RINGS["four holes around an island"][0])
        loops = [loop.tolist() for loop in mesh.boundary()]
        check_loops(mesh, loops)
        with pytest.raises(AssertionError):
            check_loops(mesh, damage(loops))


def expected_markers(
    mesh: Triangulation, pslg: PSLG
) -> tuple[dict[frozenset[RationalPoint], int], dict[RationalPoint, int]]:
    """Markers of all edges and vertices, from the rule's words: one thing after the other."""
    exact, places = oracles.rationals(pslg.points.tolist()), oracles.rationals(mesh.points.tolist())
    sides = Counter(frozenset(places[v] for v in side) for side in sides_of(mesh.triangles.tolist()))
    point_markers = [0] * len(exact) if pslg.point_markers is None else pslg.point_markers.tolist()
    segment_markers = [0] * len(pslg.segments) if pslg.segment_markers is None else pslg.segment_markers.tolist()
    edges, vertices = dict.fromkeys(sides, 0), dict.fromkeys(places, 0)
    for p, marker in zip(exact, point_markers, strict=True):
        if p in vertices and vertices[p] == 0:
            vertices[p] = marker
    for (a, b), marker in zip(pslg.segments.tolist(), segment_markers, strict=True):
        for edge in edges:
            if all(oracles.on_segment(p, exact[a], exact[b]) for p in edge):
                edges[edge] = edges[edge] or marker
                for p in edge:
                    vertices[p] = vertices[p] or marker
    for edge, count in sides.items():
        if count == 1:
            edges[edge] = edges[edge] or 1
            for p in edge:
                vertices[p] = vertices[p] or 1
    return edges, vertices


@pytest.mark.obligation("M5", "markers follow Triangle's rule, and attributes their points", method="property-based")
class TestMarkers:
    """Edges and vertices have the markers that the rule gives them, word for word; attributes are those of the first
    point at the place."""

    @given(seeded(), st.data())
    @settings(max_examples=60)
    def test_rule(self, case: Seeded, data: st.DataObject) -> None:
        n, s = len(case.graph.points), len(case.graph.segments)
        marker = st.integers(-1, 3)
        columns: dict[str, object] = {"point_attributes": np.arange(2.0 * n).reshape(n, 2)}
        if data.draw(st.booleans()):
            columns["point_markers"] = data.draw(st.lists(marker, min_size=n, max_size=n))
        if data.draw(st.booleans()):
            columns["segment_markers"] = data.draw(st.lists(marker, min_size=s, max_size=s))
        pslg = pslg_of(case, **columns)
        mesh = carved(pslg) if pslg else []
        if pslg is None or not isinstance(mesh, Triangulation):
            return
        edges, vertices = expected_markers(mesh, pslg)
        places = oracles.rationals(mesh.points.tolist())
        assert dict(zip(places, mesh.vertex_markers.tolist(), strict=True)) == vertices
        found = [frozenset(places[v] for v in edge) for edge in mesh.edges.tolist()]
        assert dict(zip(found, mesh.edge_markers.tolist(), strict=True)) == edges
        fixed = [frozenset(places[v] for v in edge) for edge in mesh.segments.tolist()]
        assert mesh.segment_markers.tolist() == [edges[edge] for edge in fixed]
        exact = oracles.rationals(pslg.points.tolist())
        assert mesh.vertex_attributes[:, 0].tolist() == [2.0 * exact.index(p) for p in places]

    def test_control_one_marker(self) -> None:
        """The words tell each rule from the next: own marker, segment's, boundary's, none."""
        points = [(0, 0), (4, 0), (4, 4), (0, 4), (2, 1), (2, 2), (1, 2)]
        segments = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5)]
        mesh = constrained_delaunay(
            PSLG(points, segments, point_markers=[9, 0, 0, 0, 0, 0, 0], segment_markers=[0, 0, 5, 0, 7])
        )
        assert mesh.vertex_markers.tolist() == [9, 1, 5, 5, 7, 7, 0]
        assert mesh.segment_markers.tolist() == [1, 1, 5, 1, 7]
