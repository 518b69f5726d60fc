"""Voronoi diagrams: circumcentres to the last bit, duality, cells by brute force."""

import pickle
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from proofs_tests import oracles
from proofs_tests.mesh.digest import inputs
from proofs_tests.mesh.strategies import point_sets, small_grid_sets
from proofs_tests.voronoi.oracle import area, cell_of, corners_of, fractions_of, nearest_double, plane

from exactkernel.rational import RationalPoint
from exactkernel.types import FloatArray, IntArray
from exactmesh import Triangulation, Voronoi, delaunay, voronoi
from exactmesh.errors import (
    CollinearPointsError,
    CoordinateError,
    ExactMeshError,
    NonFiniteError,
    NotDelaunayError,
    ShapeError,
    TooFewPointsError,
    TopologyError,
)
from exactmesh.voronoi import centres, circumcentres, dual_edges

SQUARE = [(0, 0), (2, 0), (2, 2), (0, 2)]


def mesh_of(points: object) -> Triangulation:
    try:
        return delaunay(points)  # type: ignore[arg-type]  # a strategy's list
    except CollinearPointsError:
        assume(False)
        raise


def wrong_centres(mesh: Triangulation, found: FloatArray) -> list[int]:
    """The triangles whose centre is not rounded to the nearest doubles."""
    points = oracles.rationals(mesh.points)
    wrong = []
    for t, (a, b, c) in enumerate(mesh.triangles.tolist()):
        centre, _ = oracles.circumcircle(points[a], points[b], points[c])
        if [nearest_double(x) for x in centre] != found[t].tolist():
            wrong.append(t)
    return wrong


def naive_centres(mesh: Triangulation) -> FloatArray:
    """What everybody writes: the formula, in doubles."""
    a, b, c = np.moveaxis(mesh.points[mesh.triangles], 1, 0)
    u, v = b - a, c - a
    uu, vv, cross = (u**2).sum(axis=1), (v**2).sum(axis=1), 2 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    offset = np.stack([v[:, 1] * uu - u[:, 1] * vv, u[:, 0] * vv - v[:, 0] * uu], axis=1)
    found: FloatArray = a + offset / cross[:, None]
    return found


@pytest.mark.obligation(
    "D1", "circumcentres are rounded once: each coordinate is the nearest double, ties to even", method="property-based"
)
class TestCircumcentres:
    """Each coordinate is the double nearest to the exact one, for any finite input; beyond the doubles, an infinity."""

    @pytest.mark.parametrize("name", inputs())
    def test_hard_inputs(self, name: str) -> None:
        mesh = delaunay(inputs()[name])
        assert wrong_centres(mesh, circumcentres(mesh)) == []

    @given(point_sets())
    @settings(max_examples=100)
    def test_any(self, points: list[tuple[float, float]]) -> None:
        mesh = mesh_of(points)
        assert wrong_centres(mesh, circumcentres(mesh)) == []

    def test_half_way_and_zero(self) -> None:
        """Right triangles have the middle of two doubles as their centre, and symmetric ones have zero."""
        x, y = np.random.default_rng(0).random((2, 12))
        grid = np.stack(np.meshgrid(np.sort(x), np.sort(y)), axis=-1).reshape(-1, 2)
        for points in (grid, np.concatenate([grid, -grid]), grid * 2.0**-900, grid * 2.0**900):
            mesh = delaunay(points)
            assert wrong_centres(mesh, circumcentres(mesh)) == []

    def test_few_are_left_to_the_rationals(self, monkeypatch: pytest.MonkeyPatch) -> None:
        asked: list[int] = []
        exact = centres.exact_centre

        def counted(points: FloatArray, triangles: IntArray, t: int) -> RationalPoint:
            asked.append(t)
            return exact(points, triangles, t)

        monkeypatch.setattr(centres, "exact_centre", counted)
        for name in ("uniform", "grid", "circle", "line", "clusters", "duplicates"):
            circumcentres(delaunay(inputs()[name]))
        assert asked == []
        circumcentres(delaunay(inputs()["no window"]))
        assert asked

    def test_control_the_formula_in_doubles_is_not_that_good(self) -> None:
        """The formula in plain doubles."""
        for name in ("uniform", "circle"):
            mesh = delaunay(inputs()[name])
            assert wrong_centres(mesh, naive_centres(mesh))

    def test_control_one_unit_is_seen(self) -> None:
        """One centre moved by one unit in the last place."""
        mesh = delaunay(inputs()["uniform"])
        found = circumcentres(mesh)
        found[5, 1] = np.nextafter(found[5, 1], 2.0)
        assert wrong_centres(mesh, found) == [5]

    def test_flat_triangle(self) -> None:
        mesh = delaunay(SQUARE)
        flat = replace(mesh, points=np.array([(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0)]))
        with pytest.raises(TopologyError, match=r"triangle 0 .* has no area"):
            circumcentres(flat)


def dual_faults(mesh: Triangulation, duals: IntArray, directions: FloatArray) -> list[int]:
    """The edges whose dual is not what Triangle's convention asks for."""
    on_left = {(row[k - 1], row[k]): t for t, row in enumerate(mesh.triangles.tolist()) for k in range(3)}
    faults = []
    for e, (a, b) in enumerate(mesh.edges.tolist()):
        left, right = on_left[a, b], on_left.get((b, a), -1)
        (ax, ay), (bx, by) = oracles.rationals(mesh.points[[a, b]])
        wanted = (nearest_double(by - ay), nearest_double(ax - bx)) if right < 0 else (0.0, 0.0)
        if duals[e].tolist() != [left, right] or tuple(directions[e].tolist()) != wanted:
            faults.append(e)
    return faults


@pytest.mark.obligation(
    "D2", "edge i is Voronoi edge i turned counterclockwise; triangle j is centre j", method="property-based"
)
class TestDualEdges:
    """Row i has the triangles on the left and on the right of edge i; rays point straight away from the hull."""

    @given(point_sets(), st.booleans())
    @settings(max_examples=60)
    def test_any(self, points: list[tuple[float, float]], small: bool) -> None:
        mesh = mesh_of([(x, y) for x, y in points if max(abs(x), abs(y)) < 1e300] if small else points)
        assume(np.abs(mesh.points).max() < 2.0**1022)
        assert dual_faults(mesh, *dual_edges(mesh)) == []

    def test_control(self) -> None:
        """Sides exchanged, rays turned, rows shifted."""
        mesh = delaunay([*SQUARE, (1, 1)])
        duals, directions = dual_edges(mesh)
        assert dual_faults(mesh, duals[:, ::-1], directions)
        assert dual_faults(mesh, duals, -directions)
        assert dual_faults(mesh, np.roll(duals, 1, axis=0), directions)


def exact_cells(diagram: Voronoi) -> list[list[oracles.RationalPoint | None]]:
    """The cells with their exact vertices; None is infinity."""
    exact = [fractions_of(diagram.exact_vertex(v)) for v in range(len(diagram.vertices))]
    return [[None if v < 0 else exact[v] for v in region] for region in diagram.regions]


def cell_faults(diagram: Voronoi) -> list[int]:
    """The sites whose cell is not what is nearest to them: by its finite corners in their order, and where it is open.

    The brute force cuts a huge square down; what is left of its boundary is where the cell is open.
    """
    points, square = oracles.rationals(diagram.points), plane()
    bound = square[2][0]
    faults = []
    for i, cell in enumerate(exact_cells(diagram)):
        wanted = cell_of(points, i, square)
        inside = [max(map(abs, p)) < bound for p in wanted]
        if all(inside):
            good = None not in cell and corners_of([p for p in cell if p is not None]) == wanted
            good = good and len(cell) == len(wanted)
        else:
            turn = max(k for k in range(len(wanted)) if not inside[k])
            finite = [p for p in wanted[turn + 1 :] + wanted[: turn + 1] if max(map(abs, p)) < bound]
            good = [p for p in cell if p is not None] == finite and (not cell or cell[0] is None)
        if not good:
            faults.append(i)
    return faults


def structure_faults(diagram: Voronoi) -> list[str]:
    """What is wrong with ridges, ends, cells and their cross references."""
    faults = []
    points = oracles.rationals(diagram.points)
    exact = [fractions_of(diagram.exact_vertex(v)) for v in range(len(diagram.vertices))]
    if len(set(exact)) != len(exact):
        faults.append("two vertices at one place")
    uses: dict[int, list[tuple[int, int, int]]] = {}
    for i in range(len(points)):
        entries = range(int(diagram.offsets[i]), int(diagram.offsets[i + 1]))
        for j in entries:
            k = j + 1 if j + 1 in entries else entries[0]
            uses.setdefault(int(diagram.cell_ridges[j]), []).append((i, int(diagram.cells[j]), int(diagram.cells[k])))
    for r, (a, b) in enumerate(diagram.ridge_points.tolist()):
        left, right = diagram.ends[r].tolist()
        if sorted(uses.get(r, [])) != sorted([(a, right, left), (b, left, right)]):
            faults.append(f"ridge {r} in cells")
        for v in {left, right} - {-1}:
            nearest = min(oracles.squared_distance(exact[v], p) for p in points)
            if any(oracles.squared_distance(exact[v], points[s]) != nearest for s in (a, b)):
                faults.append(f"ridge {r} ends where its sites are not nearest")
        if diagram.triangulation is not None:
            if diagram.triangulation.edges[diagram.edge[r]].tolist() != [a, b]:
                faults.append(f"ridge {r} and its edge")
            duals = dual_edges(diagram.triangulation)[0][diagram.edge[r]].tolist()
            if [left, right] != [-1 if t < 0 else int(diagram.triangle_vertex[t]) for t in duals]:
                faults.append(f"ridge {r} and the dual of its edge")
        if (diagram.directions[r] != 0).any() != (right < 0):
            faults.append(f"direction of ridge {r}")
    if diagram.triangulation is not None and len(exact) + 1 - len(diagram.ends) + len(points) != 2:
        faults.append("Euler")
    return faults


@pytest.mark.obligation(
    "D3",
    "each Voronoi cell is what is nearest to its site, exactly; cocircular points have one vertex",
    method="property-based",
)
class TestCells:
    """The cells are those of brute force in fractions; each ridge is in the two cells of its sites, in opposite
    directions, and dual to its edge; vertices are distinct, and with infinity Euler's formula holds."""

    @given(point_sets(8))
    @settings(max_examples=60)
    def test_any(self, points: list[tuple[float, float]]) -> None:
        diagram = voronoi(points)
        assert cell_faults(diagram) == []
        assert structure_faults(diagram) == []

    @given(small_grid_sets())
    @settings(max_examples=60)
    def test_clusters(self, points: list[tuple[int, int]]) -> None:
        diagram = voronoi(points)
        assert cell_faults(diagram) == []
        assert structure_faults(diagram) == []

    @pytest.mark.parametrize("n", [3, 4, 12])
    def test_one_circle(self, n: int) -> None:
        """Points of one circle have one vertex, n rays and no other ridge."""
        circle = [
            (3, 4),
            (4, 3),
            (5, 0),
            (4, -3),
            (3, -4),
            (0, -5),
            (-3, -4),
            (-4, -3),
            (-5, 0),
            (-4, 3),
            (-3, 4),
            (0, 5),
        ]
        diagram = voronoi(circle[:n])
        assert diagram.vertices.tolist() == [[0.0, 0.0]]
        assert (diagram.ends == (0, -1)).all()
        assert len(diagram.ends) == n
        assert diagram.regions == [[-1, 0]] * n

    def test_grid(self) -> None:
        """A grid has a vertex in the middle of each of its squares."""
        diagram = voronoi([(x, y) for x in range(6) for y in range(5)])
        assert sorted(map(tuple, diagram.vertices.tolist())) == [(x + 0.5, y + 0.5) for x in range(5) for y in range(4)]
        assert cell_faults(diagram) == []
        assert sorted(diagram.areas.tolist()) == [1.0] * 12 + [np.inf] * 18

    def test_controls_corrupted_diagrams(self) -> None:
        """A cell turned round, ends and rows exchanged, rays without direction."""
        diagram = voronoi([(0, 0), (4, 0), (4, 4), (0, 4), (2, 2), (1, 3), (9, 7)])
        assert not cell_faults(diagram)
        assert not structure_faults(diagram)
        turned = diagram.cells.copy()
        i = int(np.argmin(np.isinf(diagram.areas)))
        cell = slice(diagram.offsets[i], diagram.offsets[i + 1])
        turned[cell] = turned[cell][::-1]
        assert cell_faults(replace(diagram, cells=turned)) == [i]
        assert structure_faults(replace(diagram, ends=diagram.ends[:, ::-1]))
        assert structure_faults(replace(diagram, cell_ridges=np.roll(diagram.cell_ridges, 1)))
        assert structure_faults(replace(diagram, edge=diagram.edge[::-1]))
        assert structure_faults(replace(diagram, directions=np.zeros_like(diagram.directions)))

    def test_control_a_cluster_of_two_vertices(self) -> None:
        """The unmerged dual of a square has two vertices at one place."""
        diagram = voronoi(SQUARE)
        apart = replace(
            diagram, vertices=np.repeat(diagram.vertices, 2, axis=0), triangle_vertex=np.array([0, 1], "i4")
        )
        assert "two vertices at one place" in structure_faults(apart)


class TestAreas:
    """Areas are those of the exact cells, rounded, and infinite where a cell is open."""

    @given(st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=3, max_size=9, unique=True))
    @settings(max_examples=60)
    def test_against_exact(self, points: list[tuple[int, int]]) -> None:
        diagram = voronoi(points)
        for i, cell in enumerate(exact_cells(diagram)):
            exact = diagram.exact_area(i)
            if None in cell or not cell:
                assert exact is None
                assert diagram.areas[i] == np.inf
                continue
            wanted = area([p for p in cell if p is not None])
            assert exact is not None
            assert Fraction(int(exact.numerator), int(exact.denominator)) == wanted
            assert diagram.areas[i] == pytest.approx(float(wanted), rel=1e-12)

    def test_beyond_the_doubles(self) -> None:
        """A circumcentre beyond the doubles is infinite, and so is the area of its cell: never NaN."""
        diagram = voronoi([(0, 0), (1e308, 1.0), (-1e308, 1.0), (0, 1e-300), (5e307, 3.0)])
        assert np.isinf(diagram.vertices).any()
        assert not np.isnan(diagram.areas).any()
        assert cell_faults(diagram) == []


class TestDegenerate:
    """Sites on a line have parallel lines as ridges, one site the plane; points at one place share a cell."""

    @given(st.lists(st.integers(-20, 20), min_size=1, max_size=7), st.sampled_from([(1, 0), (0, 1), (3, -7), (2, 2)]))
    def test_line(self, along: list[int], direction: tuple[int, int]) -> None:
        points = [(direction[0] * t + 1, direction[1] * t) for t in along]
        diagram = voronoi(points)
        assert cell_faults(diagram) == []
        assert structure_faults(diagram) == []
        assert len(diagram.points) == len(set(along))
        assert len(diagram.ridge_points) == len(set(along)) - 1
        assert diagram.points[diagram.point_region].tolist() == points_as_lists(points)
        sites = diagram.points[diagram.ridge_points]
        assert ((sites[:, 1] - sites[:, 0]) * diagram.directions).sum(axis=1).tolist() == [0.0] * len(sites)
        assert all(diagram.ends.reshape(-1) == -1)
        assert np.isinf(diagram.areas).all()

    def test_duplicates(self) -> None:
        diagram = voronoi([(0, 0), (2, 0), (0, 0), (0, 2), (2, 0)])
        assert diagram.point_region.tolist() == [0, 1, 0, 2, 1]
        assert len(diagram.regions) == 3

    def test_nothing(self) -> None:
        with pytest.raises(TooFewPointsError):
            voronoi([])


def points_as_lists(points: list[tuple[int, int]]) -> list[list[float]]:
    return [[float(x), float(y)] for x, y in points]


class TestScipysNames:
    """In general position ridges, regions and vertices are those of scipy.spatial.Voronoi, up to numbering."""

    @pytest.mark.parametrize("seed", range(4))
    def test_same(self, seed: int) -> None:
        spatial = pytest.importorskip("scipy.spatial")
        points = np.random.default_rng(seed).random((60, 2))
        theirs, ours = spatial.Voronoi(points), voronoi(points)
        place = np.full(len(theirs.vertices) + 1, -1)
        for i, vertex in enumerate(theirs.vertices):
            distance = np.abs(ours.vertices - vertex).max(axis=1)
            place[i] = distance.argmin()
            assert distance.min() < 1e-6 * max(1.0, np.abs(vertex).max())
        assert sorted(place[:-1].tolist()) == list(range(len(ours.vertices)))
        ridges = {
            (*sorted(pair), *sorted(place[ends].tolist()))
            for pair, ends in zip(theirs.ridge_points.tolist(), theirs.ridge_vertices, strict=True)
        }
        assert ridges == {
            (*sorted(pair), *sorted(ends))
            for pair, ends in zip(ours.ridge_points.tolist(), ours.ridge_vertices, strict=True)
        }
        for i in range(len(points)):
            theirs_region = theirs.regions[theirs.point_region[i]]
            assert sorted(place[theirs_region].tolist()) == sorted(ours.regions[ours.point_region[i]])

    def test_it_can_be_drawn_by_scipy(self) -> None:
        """Also the names that only drawing needs; bounds are those of all sites, and the ridges are found by both."""
        spatial, figures = pytest.importorskip("scipy.spatial"), pytest.importorskip("matplotlib.figure")
        points = np.random.default_rng(7).random((20, 2))
        theirs, ours = spatial.Voronoi(points), voronoi(points)
        for name in ("ndim", "npoints", "furthest_site"):
            assert getattr(theirs, name) == getattr(ours, name)
        assert np.array_equal(theirs.min_bound, ours.min_bound)
        assert np.array_equal(theirs.max_bound, ours.max_bound)
        assert {frozenset(pair) for pair in theirs.ridge_dict} == {frozenset(pair) for pair in ours.ridge_dict}
        pictures = [figures.Figure().add_subplot() for _ in range(2)]
        drawn = []
        for diagram, axes in zip((theirs, ours), pictures, strict=True):
            spatial.voronoi_plot_2d(diagram, ax=axes)
            drawn.append([len(lines.get_segments()) for lines in axes.collections])
        assert drawn[0] == drawn[1]


class TestSource:
    """A triangulation is taken as it is if it is Delaunay, and refused by name if not."""

    def test_same_numbers(self) -> None:
        mesh = delaunay(np.random.default_rng(0).random((50, 2)))
        diagram = voronoi(mesh)
        assert diagram.triangulation is mesh
        assert np.array_equal(diagram.vertices[diagram.triangle_vertex], circumcentres(mesh))

    def test_not_delaunay(self) -> None:
        mesh = delaunay([(0, 0), (4, 0), (5, 3), (0, 1)])
        others = np.array([(0, 1, 2), (0, 2, 3)], dtype=np.int32)
        flipped = replace(mesh, triangles=others, neighbors=np.array([(-1, 1, -1), (-1, -1, 0)], dtype=np.int32))
        with pytest.raises(NotDelaunayError, match=r"edge \(2, 0\) between triangles 0 and 1") as caught:
            voronoi(flipped)
        assert sorted(caught.value.indices) == [0, 2]
        assert voronoi(flipped.points).triangulation == mesh

    def test_not_convex(self) -> None:
        mesh = delaunay([(0, 0), (2, 0), (2, 2), (0, 2), (1, 0.9)])
        rows = np.flatnonzero(np.isin(mesh.triangles, [0, 1]).sum(axis=1) < 2)  # all but the lowest
        number = np.full(len(mesh.triangles) + 1, -1, dtype=np.int32)
        number[rows] = np.arange(len(rows), dtype=np.int32)
        part = replace(
            mesh, triangles=mesh.triangles[rows], neighbors=number[mesh.neighbors[rows]],
            triangle_attributes=mesh.triangle_attributes[rows], triangle_regions=mesh.triangle_regions[rows],
        )  # fmt: skip
        with pytest.raises(TopologyError, match="does not cover the convex hull"):
            voronoi(part)

    def test_turned_and_lonely(self) -> None:
        mesh = delaunay(SQUARE)
        clockwise = replace(mesh, triangles=mesh.triangles[:, ::-1], neighbors=mesh.neighbors[:, ::-1])
        with pytest.raises(TopologyError, match=r"triangle 0 .* is not counterclockwise"):
            voronoi(clockwise)
        more = np.concatenate([mesh.points, [(1.0, 0.5)]])
        lonely = replace(mesh, points=more, vertex_markers=np.zeros(5, "i8"), vertex_attributes=np.zeros((5, 0)))
        with pytest.raises(TopologyError, match="vertex 4 is a corner of no triangle"):
            voronoi(lonely)

    @pytest.mark.parametrize(
        ("points", "error"),
        [([(0, 0), (1, float("nan"))], NonFiniteError), ([1, 2, 3], ShapeError), ([(2**53 + 1, 0)], CoordinateError)],
    )
    def test_bad_points(self, points: object, error: type[ExactMeshError]) -> None:
        with pytest.raises(error):
            voronoi(points)  # type: ignore[arg-type]  # bad on purpose


class TestFrozen:
    """Nobody changes a diagram, not even a copy of it."""

    def test_arrays(self) -> None:
        diagram = voronoi([*SQUARE, (1, 5)], clip=(0, 0, 1, 1))
        again = pickle.loads(pickle.dumps(diagram))
        assert diagram.clipped is not None
        for holder in (diagram, again, diagram.clipped, again.clipped):
            arrays = [value for value in vars(holder).values() if isinstance(value, np.ndarray)]
            assert len(arrays) > 5
            assert not any(array.flags.writeable for array in arrays)
        assert np.array_equal(again.vertices, diagram.vertices)
        for array in (diagram.areas, diagram.clipped.areas, diagram.clipped.centroids, diagram.clipped.energies):
            assert not array.flags.writeable
