"""The frozen result: what each array means, that it stays so, and where points lie in it."""

import copy
import dataclasses
import math
import pickle
import sys
from collections.abc import Callable
from fractions import Fraction
from functools import partial
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from proofs_tests import oracles
from proofs_tests.kernel.strategies import Point
from proofs_tests.mesh import oracle as mesh_oracle
from proofs_tests.mesh.enumeration import grid, triangulations
from proofs_tests.mesh.lazy import Lazy
from proofs_tests.mesh.strategies import point_sets
from proofs_tests.oracles import Triangle

from exactkernel.jit import COMPILED
from exactkernel.types import FloatArray, IntArray
from exactmesh import PSLG, ExactMeshError, Triangulation, constrained_delaunay, delaunay
from exactmesh.columns import MarkerArray
from exactmesh.demo import lake
from exactmesh.locate import locate_points

#: Corners of the doubles, subnormals, both zeros, and no common window.
EXTREME: dict[str, list[Point]] = {
    "subnormal": [(0.0, 0.0), (5e-324, 0.0), (0.0, 5e-324), (5e-324, 5e-324), (1e-323, 0.0)],
    "largest": [(-1.7e308, -1.7e308), (1.7e308, -1.7e308), (0.0, 1.7e308), (0.0, 0.0), (0.0, -1.7e308)],
    "no window": [(0.0, 0.0), (1e-200, 0.0), (0.0, 1e-200), (1e200, 1e200), (1e200, -1e200)],
    "two scales": [(0.0, 0.0), (1e-200, 0.0), (0.0, 1e-200), (1.0, 1.0)],
    "both zeros": [(0.0, 0.0), (-0.0, 0.0), (1.0, -0.0), (0.0, 1.0), (-0.0, -0.0)],
}


MESHES = Lazy(
    {name: partial(delaunay, points) for name, points in EXTREME.items()}
    | {
        "grid": lambda: delaunay(grid(5, 4)),
        "random": lambda: delaunay(np.random.default_rng(2).random((40, 2))),
        "circle": lambda: delaunay([(math.cos(i), math.sin(i)) for i in range(30)]),
    }
)
EACH = pytest.mark.parametrize("mesh", MESHES, indirect=True)


@pytest.fixture
def mesh(request: pytest.FixtureRequest) -> Triangulation:
    """Return the mesh of that name."""
    return MESHES[request.param] if request.param in MESHES else CONSTRAINED[request.param]


def triangles_of(mesh: Triangulation) -> list[Triangle]:
    return [(a, b, c) for a, b, c in mesh.triangles.tolist()]


@pytest.mark.obligation(
    "G4",
    "neighbors, edges, hull and statistics are those of naive definitions",
    method="differential",
    control_in="TestStatisticsCanFail",
)
@pytest.mark.bounds
@EACH
class TestArrays:
    """Each array means what its line says, by naive definitions."""

    def test_neighbors(self, mesh: Triangulation) -> None:
        rows = triangles_of(mesh)
        for t, row in enumerate(rows):
            for i in range(3):
                side = {row[(i + 1) % 3], row[(i + 2) % 3]}
                across = [u for u, other in enumerate(rows) if u != t and side <= set(other)]
                assert mesh.neighbors[t, i] == (across[0] if across else -1)
                assert len(across) <= 1

    def test_edges(self, mesh: Triangulation) -> None:
        directed = {(row[i], row[(i + 1) % 3]) for row in triangles_of(mesh) for i in range(3)}
        edges = [(a, b) for a, b in mesh.edges.tolist()]
        assert len({frozenset(edge) for edge in edges}) == len(edges) == len({frozenset(edge) for edge in directed})
        assert set(edges) <= directed  # with a triangle on the left

    def test_hull(self, mesh: Triangulation) -> None:
        exact = oracles.rationals(mesh.points.tolist())
        hull = mesh.hull.tolist()
        assert exact[hull[0]] == min(exact[v] for v in hull) == min(exact)
        sides = [*zip(hull, hull[1:] + hull[:1], strict=True)]
        for a, b in sides:
            assert all(oracles.orient(exact[a], exact[b], p) >= 0 for p in exact)
            assert [v for v, p in enumerate(exact) if oracles.on_segment(p, exact[a], exact[b])] == sorted((a, b))
        area = sum(oracles.orient(exact[hull[0]], exact[a], exact[b]) for a, b in sides)
        assert area == oracles.hull_area(exact)  # once around

    def test_quad_edge(self, mesh: Triangulation) -> None:
        surface = mesh.quad_edge()
        surface.check()
        assert surface.counts() == (len(mesh.points), len(mesh.edges), len(mesh.triangles) + 1)
        assert {frozenset(row) for row in surface.triangles().tolist()} == {frozenset(t) for t in triangles_of(mesh)}

    def test_statistics(self, mesh: Triangulation) -> None:
        """Lengths are relatively right to 2^-30, areas to 2^-40 of the square of the extent, angles to 1e-9 degrees,
        where doubles reach so far."""
        exact, rows, figures = oracles.rationals(mesh.points.tolist()), triangles_of(mesh), mesh.statistics()
        assert (figures.vertices, figures.triangles) == (len(exact), len(rows))
        assert (figures.edges, figures.hull_vertices) == (len(mesh.edges), len(mesh.hull))
        areas = [oracles.orient(*(exact[v] for v in t)) / 2 for t in rows]
        squares = [oracles.squared_distance(exact[a], exact[b]) for a, b in mesh.edges.tolist()]
        error = max(squares) / 2**40
        assert is_close(figures.area, sum(areas, Fraction(0)), error)
        assert is_close(figures.smallest_area, min(areas), error)
        assert is_close(figures.largest_area, max(areas), error)
        for figure, square in ((figures.shortest_edge, min(squares)), (figures.longest_edge, max(squares))):
            root = Fraction(math.isqrt(int(square * 4**1200)), 2**1200)
            assert is_close(figure, root, root / 2**30)
        smallest = smallest_angle(mesh_oracle.sharpest_corner(exact, rows))
        assert math.isclose(figures.smallest_angle, smallest, rel_tol=0.0, abs_tol=1e-9)
        assert figures.largest_angle <= 180.0 - 2.0 * smallest + 1e-9

    def test_svg(self, mesh: Triangulation) -> None:
        root = ElementTree.fromstring(mesh._repr_svg_())
        path = root.find("{http://www.w3.org/2000/svg}path")
        assert path is not None
        drawn = path.attrib["d"].replace("M", " ").replace("L", " ").split()
        assert len(drawn) == 4 * len(mesh.edges)
        assert all(0.0 <= float(number) <= 480.0 for number in drawn)


def is_close(figure: float, exact: Fraction, error: Fraction) -> bool:
    """Tell whether a figure is within an error of the exact one, or as near as a double can be."""
    if math.isinf(figure):
        return exact > Fraction(2) ** 1023
    return abs(Fraction(figure) - exact) <= error + Fraction(2) ** -1074


@pytest.mark.obligation("G4", "the smallest angle is right to 2^-20, however thin the triangle", method="named cases")
class TestNeedles:
    """The smallest angle is relatively right to 2^-20 where short sides are exact: no needle has an angle of 0."""

    def test_the_lake(self) -> None:
        mesh = constrained_delaunay(lake(), crossings="split")
        exact = oracles.rationals(mesh.points.tolist())
        smallest = smallest_angle(mesh_oracle.sharpest_corner(exact, triangles_of(mesh)))
        assert 0.0 < smallest < 1e-13
        assert math.isclose(mesh.statistics().smallest_angle, smallest, rel_tol=2.0**-20)

    def test_control_from_the_long_sides_it_is_lost(self) -> None:
        """The area computed from the long sides: it is 0."""
        mesh = constrained_delaunay(lake(), crossings="split")
        a, b, c = mesh.points[mesh.triangles].transpose(1, 0, 2)
        sides = np.stack([c - b, a - c, b - a])
        first, second = np.roll(sides, 1, axis=0), np.roll(sides, 2, axis=0)
        cross = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
        assert (cross == 0.0).any()


def smallest_angle(cotangent: Fraction) -> float:
    """In degrees; below what doubles hold, 0."""
    return math.degrees(math.atan2(1.0, float(cotangent))) if cotangent < Fraction(2) ** 1000 else 0.0


class TestStatisticsCanFail:
    """The comparison with exact figures rejects other ones."""

    def test_control_close(self) -> None:
        """Figures that are off by more than their error."""
        assert not is_close(0.0, Fraction(1), Fraction(1, 2))
        assert not is_close(1.0001, Fraction(1), Fraction(1, 2**30))
        assert not is_close(math.inf, Fraction(1), Fraction(1))
        assert is_close(1.0, Fraction(1), Fraction(0))

    @pytest.mark.parametrize("most", [20_000, 20])
    def test_picture_of_many_edges(self, most: int, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(sys.modules["exactmesh.svg"], "_MOST_EDGES", most)
        mesh = MESHES["random"]
        assert (f"({most} drawn)" in mesh._repr_svg_()) is (len(mesh.edges) > most)


COPIES: dict[str, Callable[[Triangulation], Triangulation]] = {
    "itself": lambda mesh: mesh,
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda mesh: pickle.loads(pickle.dumps(mesh)),
    "canonical": Triangulation.canonical,
}


@pytest.mark.obligation(
    "G2", "no array of a result can be written to, nor its base, nor an attribute replaced", method="named cases"
)
class TestFrozen:
    """No array of a result can be written to, nor its base, nor an attribute replaced; the same for every copy. What
    the caller passed in stays the caller's: neither changed, nor frozen, nor shared."""

    @pytest.mark.parametrize("made", COPIES.values(), ids=COPIES.keys())
    @pytest.mark.parametrize("name", ["points", "triangles", "neighbors", "representative", "edges", "hull"])
    def test_read_only(self, name: str, made: Callable[[Triangulation], Triangulation]) -> None:
        mesh = made(MESHES["grid"])
        array = getattr(mesh, name)
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
        with pytest.raises(AttributeError):
            setattr(mesh, name, array)
        base = array.base
        assert base is None or not base.flags.writeable

    def test_control_a_view_would_be_noticed(self) -> None:
        """A read-only view of an array that is not."""
        base = np.arange(6)
        view = base.reshape(2, 3)
        view.setflags(write=False)
        assert view.base is base
        assert base.flags.writeable  # what the test above looks for

    @pytest.mark.parametrize("made", COPIES.values(), ids=COPIES.keys())
    @EACH
    def test_copies_are_equal(self, mesh: Triangulation, made: Callable[[Triangulation], Triangulation]) -> None:
        again = made(mesh)
        if made is not Triangulation.canonical:
            assert again == mesh
            assert hash(again) == hash(mesh)
            assert again.work == mesh.work
        assert again.canonical() == mesh.canonical()
        assert (again.points[again.representative] == mesh.points[mesh.representative]).all()

    def test_the_input_is_the_callers(self) -> None:
        points = np.random.default_rng(1).random((20, 2))
        before = points.copy()
        mesh = delaunay(points)
        assert points.flags.writeable
        points[:] = 0.0
        assert (mesh.points == before).all()
        before.setflags(write=False)
        assert delaunay(before) == mesh

    def test_inequality(self) -> None:
        mesh, other = MESHES["grid"], MESHES["random"]
        assert mesh != other
        assert mesh != mesh.triangles.tolist()
        moved = Triangulation(mesh.points + 1.0, mesh.triangles, mesh.neighbors, mesh.representative, mesh.work)
        assert moved != mesh

    def test_repr(self) -> None:
        assert repr(MESHES["grid"]) == "Triangulation(20 vertices, 24 triangles)"


def constrained_meshes() -> Lazy[Triangulation]:
    """A square with a hole, regions, markers, attributes, duplicates and a point outside; and segments that cross."""
    points = [(0, 0), (4, 0), (4, 4), (0, 4), (1, 1), (2, 1), (1, 2), (3, 3), (4, 4), (9, 9), (2, 0)]
    segments = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 4), (7, 8), (0, 10)]
    full = PSLG(
        points,
        segments,
        holes=[(1.25, 1.25)],
        regions=[(3, 1, 7)],
        point_markers=[5, *[0] * 10],
        segment_markers=range(9),
        point_attributes=[[float(i), -1.0] for i in range(11)],
    )
    crossed = PSLG(points[:4], [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2), (1, 3)], segment_markers=range(6))
    return Lazy(
        {
            "carved": lambda: constrained_delaunay(full),
            "whole": lambda: constrained_delaunay(full, carve=False),
            "split": lambda: constrained_delaunay(crossed, crossings="split"),
        }
    )


CONSTRAINED = constrained_meshes()
ARRAYS = [
    field.name for field in dataclasses.fields(Triangulation) if field.type in (FloatArray, IntArray, MarkerArray)
]
EACH_CONSTRAINED = pytest.mark.parametrize("mesh", CONSTRAINED, indirect=True)
EACH_COPY = pytest.mark.parametrize("made", COPIES.values(), ids=COPIES.keys())


@EACH_CONSTRAINED
@pytest.mark.obligation(
    "G2", "results with segments are frozen, compared and renumbered as a whole", method="named cases"
)
class TestConstrained:
    """All of this holds of the arrays that come with segments, too; the canonical form renumbers those as well."""

    @EACH_COPY
    @pytest.mark.parametrize("name", [*ARRAYS, "edges", "edge_markers"])
    def test_read_only(self, mesh: Triangulation, name: str, made: Callable[[Triangulation], Triangulation]) -> None:
        array = getattr(made(mesh), name)
        assert not array.flags.writeable
        assert array.base is None or not array.base.flags.writeable
        for loop in made(mesh).boundary():
            assert not loop.flags.writeable

    @EACH_COPY
    def test_copies(self, mesh: Triangulation, made: Callable[[Triangulation], Triangulation]) -> None:
        again = made(mesh)
        assert again.pslg == mesh.pslg
        assert again.canonical() == mesh.canonical()
        for name in ARRAYS:
            assert (getattr(again.canonical(), name) == getattr(mesh.canonical(), name)).all()
            if made is not Triangulation.canonical:
                assert getattr(again, name).tobytes() == getattr(mesh, name).tobytes()
                assert getattr(again, name).dtype == getattr(mesh, name).dtype
        chains = [[m.points[m.chain(i)].tolist() for i in range(9 if len(m.points) > 5 else 6)] for m in (again, mesh)]
        assert chains[0] == chains[1]

    def test_canonical_moves_columns_along(self, mesh: Triangulation) -> None:
        """What belongs to a place, an edge or a triangle belongs to it in the canonical form."""
        form = mesh.canonical()
        for m, other in ((mesh, form), (form, mesh)):
            assert by_place(m) == by_place(other)

    def test_control_equality_looks_at_segments(self, mesh: Triangulation) -> None:
        """A segment left out, regions exchanged."""
        fewer = dataclasses.replace(mesh, segments=mesh.segments[1:], segment_markers=mesh.segment_markers[1:])
        assert fewer != mesh
        turned = dataclasses.replace(mesh, triangle_regions=mesh.triangle_regions[::-1] + 1)
        assert by_place(turned) != by_place(mesh)

    def test_dtypes(self, mesh: Triangulation) -> None:
        """As the attributes say, and with a row for each vertex, triangle, segment."""
        n, m, s = len(mesh.points), len(mesh.triangles), len(mesh.segments)
        rows = {"vertex_markers": n, "vertex_attributes": n, "triangle_attributes": m, "triangle_regions": m}
        for name, length in {**rows, "segment_markers": s, "edge_markers": len(mesh.edges)}.items():
            assert len(getattr(mesh, name)) == length
        for name in ("triangles", "neighbors", "representative", "segments", "segment_incidence", "triangle_regions"):
            assert getattr(mesh, name).dtype == np.int32
        for name in ("segment_markers", "vertex_markers", "edge_markers"):
            assert getattr(mesh, name).dtype == np.int64

    def test_repr(self, mesh: Triangulation) -> None:
        counts = f"{len(mesh.points)} vertices, {len(mesh.triangles)} triangles, {len(mesh.segments)} segments"
        assert repr(mesh) == f"Triangulation({counts})"


def by_place(mesh: Triangulation) -> dict[str, object]:
    """Everything by position instead of by number."""
    places = [(x, y) for x, y in mesh.points.tolist()]
    edges = [frozenset(places[v] for v in edge) for edge in mesh.segments.tolist()]
    corners = [frozenset(places[v] for v in t) for t in mesh.triangles.tolist()]
    return {
        "vertices": dict(
            zip(places, zip(mesh.vertex_markers.tolist(), mesh.vertex_attributes.tolist(), strict=True), strict=True)
        ),
        "representative": [places[v] if v >= 0 else None for v in mesh.representative.tolist()],
        "segments": dict(zip(edges, mesh.segment_markers.tolist(), strict=True)),
        "incidence": {(edges[row], i) for row, i in mesh.segment_incidence.tolist()},
        "triangles": dict(
            zip(
                corners,
                zip(mesh.triangle_regions.tolist(), mesh.triangle_attributes.tolist(), strict=True),
                strict=True,
            )
        ),
    }


@EACH
class TestCanonical:
    """The canonical form is a renumbering: vertices in lexicographic order, triangles from their smallest corner, in
    order, neighbors moved along; it is its own canonical form."""

    def test_form(self, mesh: Triangulation) -> None:
        form = mesh.canonical()
        positions = [(x, y) for x, y in form.points.tolist()]
        assert positions == sorted(positions)
        rows = triangles_of(form)
        assert rows == sorted(rows)
        assert all(min(row) == row[0] for row in rows)
        named = {frozenset(map(tuple, mesh.points[list(row)].tolist())) for row in triangles_of(mesh)}
        assert {frozenset(positions[v] for v in row) for row in rows} == named
        TestArrays().test_neighbors(form)
        assert form.canonical() == form


def misplaced(mesh: Triangulation, queries: list[Point], found: list[int]) -> list[int]:
    """Return the queries that are not where they were found."""
    exact, rows = oracles.rationals(mesh.points.tolist()), triangles_of(mesh)
    wrong = []
    for i, query in enumerate(oracles.rationals(queries)):
        closed = mesh_oracle.closed_triangles(exact, rows, query)
        if found[i] not in (closed or {-1}):
            wrong.append(i)
    return wrong


@pytest.mark.bounds
@pytest.mark.obligation(
    "G3", "locate names a triangle that holds the point, or none where there is none", method="property-based"
)
class TestLocate:
    """A point is in the closure of the triangle that locate names; -1 means that it is in none."""

    @given(point_sets(), st.data())
    def test_any_points(self, points: list[Point], data: st.DataObject) -> None:
        try:
            mesh = delaunay(points)
        except ExactMeshError:
            return
        queries = data.draw(st.one_of(point_sets(), st.just(points)))
        assert not misplaced(mesh, queries, mesh.locate(queries).tolist())

    @EACH
    def test_vertices_midpoints_and_outside(self, mesh: Triangulation) -> None:
        middles = 0.5 * mesh.points[mesh.edges[:, 0]] + 0.5 * mesh.points[mesh.edges[:, 1]]
        beyond = [(1.79e308, 0.0), (-1.79e308, -1.79e308), (0.0, 1.79e308)]
        queries = [*mesh.points.tolist(), *middles.tolist(), *beyond]
        found = mesh.locate(queries)
        assert not misplaced(mesh, [(x, y) for x, y in queries], found.tolist())
        assert (found[: len(mesh.points)] >= 0).all()
        assert found.dtype == np.int32

    def test_control_a_misplaced_point_is_noticed(self) -> None:
        """Another triangle named, and a triangle for a point outside."""
        mesh = MESHES["random"]
        queries: list[Point] = [(0.5, 0.5), (9.0, 9.0)]
        here, outside = mesh.locate(queries).tolist()
        assert outside == -1
        assert misplaced(mesh, queries, [int(mesh.neighbors[here].max()), here]) == [0, 1]

    def test_one_at_a_time(self) -> None:
        """A single point takes another way than many: the start is chosen, and each predicate guarded by itself."""
        random = np.random.default_rng(5)
        mesh = delaunay(
            np.concatenate([random.random((300, 2)), [(x / 4, y / 4) for x, y in grid(5, 5)], [(3e307, 0.0)]])
        )
        queries = [*mesh.points[::40].tolist(), (0.5, 0.5), (0.3, 0.25), (-1.0, 0.0), (1e300, 1e-300), (5e-324, 0.1)]
        queries += (0.5 * mesh.points[mesh.edges[::90, 0]] + 0.5 * mesh.points[mesh.edges[::90, 1]]).tolist()
        found = [int(mesh.locate([query])[0]) for query in queries]
        assert not misplaced(mesh, [(x, y) for x, y in queries], found)
        many = mesh.locate(queries)
        assert [t < 0 for t in found] == (many < 0).tolist()

    def test_no_queries(self) -> None:
        assert MESHES["grid"].locate(np.empty((0, 2))).shape == (0,)

    def test_many_queries(self) -> None:
        """Over the chunks and rounds of the walk, checked by the sign of one area each."""
        random = np.random.default_rng(3)
        mesh = delaunay(random.random((2000 if COMPILED else 100, 2)))
        queries = random.random((200_000 if COMPILED else 500, 2)) * 1.2 - 0.1
        found = mesh.locate(queries)
        corners = mesh.points[mesh.triangles[found[found >= 0]]]
        sides = np.roll(corners, -1, axis=1) - corners
        offsets = queries[found >= 0][:, None] - corners
        assert (sides[..., 0] * offsets[..., 1] - sides[..., 1] * offsets[..., 0] > -1e-12).all()
        assert 0 < (found < 0).sum() < len(queries) / 2

    @settings(max_examples=settings().max_examples // 3)
    @given(st.sampled_from(list(triangulations(grid(3, 3)))), st.integers(0, 2**32))
    def test_any_triangulation(self, triangles: tuple[Triangle, ...], seed: int) -> None:
        """Not Delaunay ones only."""
        given_mesh = delaunay(grid(3, 3))
        array = np.array(triangles, dtype=np.int32)
        neighbors = np.array([[adjacent(triangles, row, i) for i in range(3)] for row in triangles], dtype=np.int32)
        queries = np.random.default_rng(seed).integers(-2, 12, (20, 2)) / 4.0
        found = locate_points(given_mesh.points, array, neighbors, queries)
        mesh = Triangulation(given_mesh.points, array, neighbors, given_mesh.representative, given_mesh.work)
        assert not misplaced(mesh, [(x, y) for x, y in queries.tolist()], found.tolist())

    def test_a_walk_in_a_circle_ends(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Neighbors that lead round and round: in the end every triangle is looked at, and the answer is right."""
        mesh = MESHES["random"]
        t = np.arange(len(mesh.triangles))
        following = t // 3 * 3 + (t + 1) % 3  # three and three in turn
        lies = np.repeat(np.where(following < len(t), following, 0)[:, None], 3, axis=1)
        queries: list[Point] = [(x, y) for x, y in np.random.default_rng(0).random((30, 2)).tolist()]
        queries += [(-1.0, 0.5), (0.5, 7.0)]
        found = locate_points(mesh.points, mesh.triangles, lies.astype(np.int32), np.array(queries))
        assert found[-2:].tolist() == [-1, -1]
        assert not misplaced(mesh, queries, found.tolist())
        monkeypatch.setattr(sys.modules["exactmesh.locate"], "_CHUNK", 7)
        assert not misplaced(mesh, queries, mesh.locate(queries).tolist())


def adjacent(triangles: tuple[Triangle, ...], row: Triangle, i: int) -> int:
    side = {row[(i + 1) % 3], row[(i + 2) % 3]}
    return next((u for u, other in enumerate(triangles) if other != row and side <= set(other)), -1)
