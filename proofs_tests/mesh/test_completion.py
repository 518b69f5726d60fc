"""Triangulations of domains with holes, bays, slits and pinches: where points lie in them, and their quad-edges."""

from functools import cmp_to_key

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from proofs_tests import oracles
from proofs_tests.mesh import oracle as mesh_oracle
from proofs_tests.mesh.enumeration import canonical_triangles
from proofs_tests.mesh.lazy import Lazy
from proofs_tests.mesh.strategies import small_grid_sets
from proofs_tests.oracles import RationalPoint, Triangle

from exactmesh import PSLG, QuadEdge, TopologyError, Triangulation, constrained_delaunay, delaunay, flip, is_flippable
from exactmesh.connectivity import neighbors_of
from exactmesh.locate import locate_points

Point = tuple[float, float]


def ring(*points: Point) -> list[Point]:
    return list(points)


def domain(*rings: list[Point], more: tuple[tuple[Point, Point], ...] = ()) -> Triangulation:
    """Return the domain inside an odd number of rings, with further segments."""
    points = [p for r in rings for p in r]
    segments = []
    for r in rings:
        names = [points.index(p) for p in r]
        segments += list(zip(names, names[1:] + names[:1], strict=True))
    graph = PSLG(points + [p for s in more for p in s], segments, rule="even-odd")
    mesh = constrained_delaunay(graph)
    if not more:
        return mesh
    ends = [(len(points) + 2 * i, len(points) + 2 * i + 1) for i in range(len(more))]
    return constrained_delaunay(PSLG(graph.points, [*segments, *ends], holes=[(3.0, 3.0)]))


SQUARE = ring((0, 0), (6, 0), (6, 6), (0, 6))
HOLE = ring((2, 2), (4, 2), (4, 4), (2, 4))
DOMAINS = Lazy(
    {
        "hole": lambda: domain(SQUARE, HOLE),
        "bay": lambda: domain(ring((0, 0), (6, 0), (6, 6), (3, 1), (0, 6))),
        "U": lambda: domain(ring((0, 0), (6, 0), (6, 6), (5, 6), (5, 1), (1, 1), (1, 6), (0, 6))),
        "island in a hole": lambda: domain(SQUARE, ring((1, 1), (5, 1), (5, 5), (1, 5)), HOLE),
        "two pieces": lambda: domain(ring((0, 0), (2, 0), (1, 2)), ring((5, 5), (6, 6), (4, 6))),
        "slit": lambda: domain(SQUARE, HOLE, more=(((1, 1), (1, 5)), ((5, 1), (5, 2)))),
        "hole at a corner of the outline": lambda: domain(SQUARE, ring((0, 0), (2, 1), (1, 2))),
        "holes that touch": lambda: domain(SQUARE, ring((1, 1), (3, 2), (1, 3)), ring((3, 2), (5, 1), (5, 4))),
        "hourglass": lambda: domain(ring((0, 0), (4, 0), (2, 2)), ring((2, 2), (4, 4), (0, 4))),
        "pinwheel": lambda: domain(
            ring((3, 3), (6, 3), (6, 4)),
            ring((3, 3), (3, 6), (2, 6)),
            ring((3, 3), (0, 3), (0, 2)),
            ring((3, 3), (3, 0), (5, 0)),
        ),
    }
)
EACH = pytest.mark.parametrize("mesh", DOMAINS, indirect=True)


@pytest.fixture
def mesh(request: pytest.FixtureRequest) -> Triangulation:
    """Return the domain of that name, triangulated."""
    return DOMAINS[request.param]


def part(mesh: Triangulation, kept: npt.NDArray[np.bool_]) -> Triangulation:
    """Return some of the triangles, with the vertices that they use."""
    number = np.full(len(kept) + 1, -1, dtype=np.int32)
    number[:-1][kept] = np.arange(kept.sum(), dtype=np.int32)
    used = np.unique(mesh.triangles[kept])
    vertex = np.full(len(mesh.points), -1, dtype=np.int32)
    vertex[used] = np.arange(len(used), dtype=np.int32)
    return Triangulation(
        mesh.points[used], vertex[mesh.triangles[kept]], number[mesh.neighbors[kept]], vertex, mesh.work
    )


def misplaced(mesh: Triangulation, queries: list[Point], found: list[int]) -> list[int]:
    """Return the queries that are not where they were found."""
    exact = oracles.rationals(mesh.points.tolist())
    rows = [(a, b, c) for a, b, c in mesh.triangles.tolist()]
    places = [mesh_oracle.closed_triangles(exact, rows, q) for q in oracles.rationals(queries)]
    return [i for i, place in enumerate(places) if found[i] not in (place or {-1})]


QUERIES: list[Point] = [(x / 2, y / 2) for x in range(-1, 14) for y in range(-1, 14)]


@pytest.mark.bounds
@pytest.mark.obligation("G3", "so it does in holes, bays and slots, and between pieces", method="property-based")
class TestLocate:
    """A point is in the closure of the triangle that locate names; -1 means that it is in none: in a hole, in a bay, in
    the slot of a pinch, between two pieces, or outside of all."""

    @EACH
    def test_half_grid(self, mesh: Triangulation) -> None:
        found = mesh.locate(QUERIES).tolist()
        assert not misplaced(mesh, QUERIES, found)
        inside = mesh.locate(mesh.points)
        assert (inside >= 0).all()  # vertices are on the boundary at worst

    @settings(max_examples=settings().max_examples // 3)
    @given(small_grid_sets(), st.integers(0, 2**32))
    def test_any_part(self, points: list[tuple[int, int]], seed: int) -> None:
        """Any triangles of any triangulation, Delaunay or not, of one piece or not."""
        random = np.random.default_rng(seed)
        surface = delaunay(points).quad_edge()
        for index in random.permutation([edge.index for edge in surface.edges()] * 2).tolist():
            if is_flippable(points, surface.edge(index)):
                flip(points, surface.edge(index))
        corners = surface.triangles()
        whole = Triangulation(
            np.array(points, dtype=np.float64),
            corners,
            neighbors_of(corners),
            np.arange(len(points), dtype=np.int32),
            delaunay(points).work,
        )
        kept = random.random(len(whole.triangles)) < 0.6
        kept[0] = True
        mesh = part(whole, kept)
        queries = [(x / 2, y / 2) for x in range(-1, 10) for y in range(-1, 10)]
        assert not misplaced(mesh, queries, mesh.locate(queries).tolist())
        check_rings(mesh)

    def test_far_scales(self) -> None:
        """The same, times a power of two, and beyond the window of the predicates."""
        mesh = DOMAINS["hole"]
        for exponent in (-1070, 1000):
            far = Triangulation(
                np.ldexp(mesh.points, exponent), mesh.triangles, mesh.neighbors, mesh.representative, mesh.work
            )
            assert far.locate(np.ldexp(np.array(QUERIES), exponent)).tolist() == mesh.locate(QUERIES).tolist()

    def test_no_triangle(self) -> None:
        none = np.empty((0, 3), dtype=np.int32)
        mesh = Triangulation(np.empty((0, 2)), none, none, np.empty(0, dtype=np.int32), DOMAINS["hole"].work)
        assert mesh.locate(QUERIES[:3]).tolist() == [-1, -1, -1]

    @pytest.mark.parametrize("name", ["U", "hole", "two pieces"])
    def test_control_a_walk_that_ends_at_the_boundary_is_wrong(self, name: str) -> None:
        """A walk that ends at the boundary."""
        mesh = DOMAINS[name]
        found = locate_points(mesh.points, mesh.triangles, mesh.neighbors, np.array(QUERIES))
        assert misplaced(mesh, QUERIES, found.tolist())


def around(points: list[RationalPoint], v: int, others: list[int]) -> list[int]:
    """Return the others in counterclockwise order round v, by half planes and orientations."""

    def half(w: int) -> bool:
        (vx, vy), (wx, wy) = points[v], points[w]
        return wy < vy or (wy == vy and wx < vx)

    def compare(p: int, q: int) -> int:
        if half(p) != half(q):
            return 1 if half(p) else -1
        turn = oracles.orient(points[v], points[p], points[q])
        return (turn < 0) - (turn > 0)

    return sorted(others, key=cmp_to_key(compare))


def components(mesh: Triangulation) -> int:
    """Count the pieces that edges connect."""
    name = list(range(len(mesh.points)))
    for _ in name:
        for a, b in mesh.edges.tolist():
            name[a] = name[b] = min(name[a], name[b])
    return len(set(name))


def check_rings(mesh: Triangulation) -> None:
    """The quad-edge is that of the plane: one ring at each vertex, ordered by direction; Euler; the triangles."""
    surface = mesh.quad_edge()
    surface.check()
    vertices, edges, faces = surface.counts()
    assert (vertices, edges) == (len(mesh.points), len(mesh.edges))
    assert vertices - edges + faces == 2 * components(mesh)  # each piece has an outer face of its own
    assert canonical_triangles(surface.triangles().tolist()) == canonical_triangles(mesh.triangles.tolist())
    exact = oracles.rationals(mesh.points.tolist())
    for one in surface.edges():
        for edge in (one, one.sym):
            turn = [int(e.dest) for e in edge.orbit()]
            expected = around(exact, edge.org, turn)
            start = expected.index(turn[0])
            assert turn == expected[start:] + expected[:start]


@pytest.mark.obligation("M1", "the quad-edge of any domain is that of its drawing", method="named cases")
class TestQuadEdge:
    """The quad-edge of any domain is that of its drawing: at each vertex one ring, in the order of the directions."""

    @EACH
    def test_rings(self, mesh: Triangulation) -> None:
        check_rings(mesh)

    @pytest.mark.parametrize("name", ["hourglass", "pinwheel", "holes that touch"])
    def test_control_without_coordinates_it_is_not_known(self, name: str) -> None:
        """The triangles without their coordinates: pinched vertices have no order."""
        with pytest.raises(TopologyError, match="pinched"):
            QuadEdge.from_triangles(DOMAINS[name].triangles)

    def test_overlaps_end(self) -> None:
        """Triangles that overlap have no drawing; there is an answer all the same, or an error."""
        rows: list[Triangle] = [(0, 1, 2), (0, 3, 4), (0, 5, 6)]
        points = np.array([(0, 0), (4, 0), (4, 4), (4, 1), (3, 4), (5, 1), (5, 3)], dtype=np.float64)
        none = np.full((3, 3), -1, dtype=np.int32)
        mesh = Triangulation(
            points, np.array(rows, dtype=np.int32), none, np.arange(7, dtype=np.int32), DOMAINS["U"].work
        )
        mesh.quad_edge().check()
