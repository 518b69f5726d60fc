"""V1: what a diagram claims is read as it is given, by sites or by triangles; what is none is refused."""

from fractions import Fraction
from itertools import islice, permutations, product
from random import Random
from types import SimpleNamespace

import numpy as np
import numpy.typing as npt
import pytest
from proofs_tests import oracles
from proofs_tests.mesh.enumeration import grid, triangulations
from proofs_tests.oracles import Triangle
from proofs_tests.verify.test_links import links_of, mesh_of

import exactmesh.triangle as drop_in
from exactkernel import ShapeError
from exactmesh import delaunay
from exactmesh.verify import dual
from exactmesh.verify.dual import Dual, Ridges, ridges_of

#: Two triangles, of points of which the first one is a copy that is not used.
POINTS = [(9.0, 9.0), (0.0, 0.0), (4.0, 0.0), (9.0, 9.0), (0.0, 5.0)]
TRIANGLES: list[Triangle] = [(1, 2, 4), (2, 3, 4)]
NAN = float("nan")


def read(claimed: Dual, points: list[tuple[float, float]] = POINTS, triangles: list[Triangle] = TRIANGLES) -> Ridges:
    mesh = mesh_of(points, triangles)
    return ridges_of(claimed, mesh, links_of(mesh), mesh.triangles)


def same(array: npt.NDArray[np.generic], rows: npt.ArrayLike) -> bool:
    expected = np.array(rows, dtype=np.float64).reshape(-1, 2)
    return array.shape == expected.shape and np.array_equal(array.astype(np.float64), expected, equal_nan=True)


#: Sites in another order, one of which is no point of the mesh.
SITES = [(4.0, 0.0), (9.0, 9.0), (1.0, 1.0), (0.0, 5.0), (0.0, 0.0)]
VERTICES = [(2, 3), (5, 6), (7, 8)]
PAIRS = [(0, 4), (1, 3), (2, 0), (3, 0), (4, 2)]
CORNERS = [(2, 1), (3, 4), (-1, 2), (4, 2), (1, -1)]
ENDS = [(0, 1), (-1, 2), (2, -1), (-1, -1), (1, 0)]
DIRECTIONS = [(1, 2), (3, 4), (5, 6), (7, 8), (9, 10)]


def by_sites(**changed: object) -> SimpleNamespace:
    whole = {"points": SITES, "vertices": VERTICES, "ridge_points": PAIRS, "ridge_vertices": ENDS}
    return SimpleNamespace(**{name: value for name, value in (whole | changed).items() if value is not None})


@pytest.mark.obligation("V1", "a diagram by sites is read as it is given", method="named cases")
class TestBySites:
    """Each pair names the used corners at the sites, -1 for none; infinite ends come last; a direction is kept just
    where an end is infinite; nothing else than numbers of the right shape is taken, and every message names it."""

    def test_read(self) -> None:
        for claimed in (
            by_sites(directions=DIRECTIONS),
            by_sites(directions=DIRECTIONS, ridge_vertices=[], ends=ENDS),
            by_sites(**{name: np.array(value) for name, value in vars(by_sites(directions=DIRECTIONS)).items()}),
        ):
            found = read(claimed)
            assert not found.by_triangle
            assert same(found.vertices, VERTICES)
            assert same(found.pairs, CORNERS)
            assert same(found.ends, [(0, 1), (2, -1), (2, -1), (-1, -1), (1, 0)])
            assert same(found.directions, [(NAN, NAN), (3, 4), (5, 6), (7, 8), (NAN, NAN)])

    def test_without_directions(self) -> None:
        assert same(read(by_sites()).directions, [(NAN, NAN)] * 5)

    def test_nothing(self) -> None:
        found = read(by_sites(points=[], vertices=[], ridge_points=[], ridge_vertices=()))
        assert [len(x) for x in (found.vertices, found.pairs, found.ends, found.directions)] == [0, 0, 0, 0]
        assert found.vertices.shape == found.pairs.shape == (0, 2)

    @pytest.mark.parametrize("kind", [np.uint8, np.int32, np.float32, np.float64])
    def test_kinds_of_numbers(self, kind: type) -> None:
        found = read(by_sites(vertices=np.array(VERTICES, dtype=kind)))
        assert same(found.vertices, VERTICES)
        assert found.vertices.dtype == np.float64

    @pytest.mark.parametrize(
        ("changed", "message"),
        [
            ({"points": None}, "dual: expected a Voronoi diagram, not a SimpleNamespace"),
            ({"vertices": None}, "dual: expected a Voronoi diagram, not a SimpleNamespace"),
            ({"ridge_points": None}, "dual: expected a Voronoi diagram, not a SimpleNamespace"),
            ({"ridge_vertices": None}, "dual: expected a Voronoi diagram, not a SimpleNamespace"),
            ({"vertices": [(1, 2, 3)]}, r"dual: vertices has shape \(1, 3\) and dtype int64; expected numbers"),
            ({"vertices": [1, 2]}, r"dual: vertices has shape \(2,\)"),
            ({"vertices": [["a", "b"]]}, "dual: vertices has shape .* and dtype <U1"),
            ({"points": [[(1, 2)]]}, "dual: points has shape"),
            ({"directions": [(1, 2)]}, "dual: 5 ridge_points, but 5 ridges and 1 directions"),
            ({"directions": [(1, 2, 3)] * 5}, "dual: directions has shape"),
            ({"ridge_vertices": ENDS[1:]}, "dual: 5 ridge_points, but 4 ridges and 5 directions"),
            ({"ridge_points": PAIRS[1:]}, "dual: 4 ridge_points, but 5 ridges and 4 directions"),
            ({"ridge_vertices": [[0], [1, 2]]}, "dual: ridge_vertices is not an array of pairs"),
            ({"ridge_vertices": [(0, 1, 1)] * 5}, r"dual: ridge_vertices has shape \(5, 3\) and dtype int64"),
            ({"ridge_vertices": [1, 2]}, r"dual: ridge_vertices has shape \(2,\)"),
            ({"ridge_vertices": [(0.0, 1.0)] * 5}, "dual: ridge_vertices .* dtype float64; expected integers"),
            ({"ridge_vertices": [(0, 3)] * 5}, r"dual: ridge_vertices has an index outside -1 \.\. 2"),
            ({"ridge_vertices": [(0, -2)] * 5}, r"dual: ridge_vertices has an index outside -1 \.\. 2"),
            ({"ridge_points": [(0, 5)] * 5}, r"dual: ridge_points has an index outside 0 \.\. 4"),
            ({"ridge_points": [(0, -1)] * 5}, r"dual: ridge_points has an index outside 0 \.\. 4"),
        ],
    )  # fmt: skip
    def test_control_refused(self, changed: dict[str, object], message: str) -> None:
        """One array of the diagram is missing, or of another shape, kind or range."""
        with pytest.raises(ShapeError, match=message):
            read(by_sites(**changed))


EDGES = [(0, 1), (-1, 0), (1, -1)]
OUTWARD = [(0, 0), (-5, 0), (1, 1)]


@pytest.mark.obligation("V1", "a diagram by triangles is read as it is given", method="enumeration")
class TestByTriangles:
    """A ridge between two triangles is dual to the edge that they share, a ray to an edge of its triangle on the
    boundary that no other ray of it has, and which it leaves most nearly at a right angle."""

    def test_read(self) -> None:
        vertices = [(1, 2), (3, 4)]
        found = read((vertices, EDGES, OUTWARD))
        assert found.by_triangle
        assert same(found.vertices, vertices)
        assert same(found.ends, [(0, 1), (0, -1), (1, -1)])
        assert same(found.pairs, [(2, 4), (4, 1), (3, 4)])
        assert same(found.directions, [(NAN, NAN), (-5, 0), (1, 1)])
        assert repr(read((vertices, EDGES[:1], [0, 1], OUTWARD[1:]))) == repr(found)
        column = read((vertices, EDGES[:1], [[0], [1]], OUTWARD[1:]))
        assert same(column.ends, found.ends)

    @pytest.mark.parametrize(
        ("claimed", "message"),
        [
            ((VERTICES[:2], EDGES), "dual: 2 arrays; expected vertices, edges, and the rays' origins and directions"),
            ((VERTICES[:2], EDGES[:1], [0], [(1, 2)], []), "dual: 5 arrays; expected"),
            ((VERTICES, EDGES, OUTWARD), "dual: 3 vertices; expected one for each of 2 triangles"),
            ((VERTICES[:2], [(0, 2)], [(0, 0)]), r"dual: edges has an index outside -1 \.\. 1"),
            ((VERTICES[:2], [(0, -2)], [(0, 0)]), r"dual: edges has an index outside -1 \.\. 1"),
            ((VERTICES[:2], EDGES[:1], [2], [(1, 2)]), r"dual: origins has an index outside -1 \.\. 1"),
            ((VERTICES[:2], EDGES, OUTWARD[:2]), "dual: 2 directions; expected 3"),
            ((VERTICES[:2], EDGES[:1], [0], OUTWARD), "dual: 4 directions; expected 2"),
            ((VERTICES[:2], EDGES, [(1, 2, 3)] * 3), "dual: directions has shape"),
        ],
    )
    def test_control_refused(self, claimed: tuple[npt.ArrayLike, ...], message: str) -> None:
        """An array is missing, too short or too long, or has an index out of range."""
        with pytest.raises(ShapeError, match=message):
            read(claimed)

    def test_common_edges(self) -> None:
        """Of all pairs of triangles: the two corners that both have, in the order of the first."""
        points = grid(3, 3)
        for rows in islice(triangulations(points), 0, None, 40):
            triangles = np.array(rows, dtype=np.int32)
            ends = [*product(range(len(rows)), repeat=2)]
            found = dual._common_edges(triangles, np.array(ends, dtype=np.intp)).tolist()
            for (s, t), pair in zip(ends, found, strict=True):
                both = [(v, w) for v, w in arcs(rows[s]) if {v, w} == {*rows[s]} & {*rows[t]}]
                assert [tuple(pair)] == (both or [(-1, -1)])

    @pytest.mark.parametrize("exponent", [0, 900, -900])
    def test_rays(self, exponent: int) -> None:
        """One triangle with sides of many lengths, and rays in all directions."""
        random, points = Random(1), [(0.0, 0.0), (40.0, 1.0), (3.0, 7.0)]
        exact, seen = oracles.rationals(points), set()
        scaled = [(x * 2.0**exponent, y * 2.0**exponent) for x, y in points]
        for a, b, c in permutations(range(3)):
            triangle = oracles.counterclockwise(exact, (a, b, c))
            for _ in range(12):
                dx, dy = random.randrange(-9, 10), random.randrange(-9, 10)

                def sine(edge: tuple[int, int], dx: int = dx, dy: int = dy) -> Fraction:
                    (ax, ay), (bx, by) = exact[edge[0]], exact[edge[1]]
                    cross = dx * (by - ay) - dy * (bx - ax)
                    return cross * abs(cross) / oracles.squared_distance((ax, ay), (bx, by))

                direction = (dx * 2.0**exponent, dy * 2.0**exponent)
                found = read(([(0, 0)], [], [0], [direction]), scaled, [triangle])
                assert tuple(found.pairs[0].tolist()) == max(arcs(triangle), key=sine)
                seen.add(frozenset(found.pairs[0].tolist()))
        assert len(seen) == 3

    @pytest.mark.parametrize("direction", [(1.0, 0.0), (0.0, 0.0), (NAN, NAN), (NAN, 1.0)])
    def test_one_each(self, direction: tuple[float, float]) -> None:
        """Wherever they point, three rays of a triangle have its three edges, and a fourth none."""
        for triangle in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            claimed: tuple[npt.ArrayLike, ...] = ([(0, 0)], [], [0, 0, 0, 0], [direction] * 4)
            found = read(claimed, [(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)], [triangle])
            assert {tuple(pair) for pair in found.pairs[:3].tolist()} == {*arcs(triangle)}
            assert found.pairs[3].tolist() == [-1, -1]

    def test_no_other_edges(self) -> None:
        """Of each triangle of a triangulation three rays have its edges on the boundary, and no other ones."""
        points = [(float(x), float(y)) for x, y in grid(3, 3)]
        for rows in islice(triangulations(grid(3, 3)), 0, None, 60):
            every = {arc for t in rows for arc in arcs(t)}
            origins = [t for t in range(len(rows)) for _ in range(3)]
            found = read((np.zeros((len(rows), 2)), [], origins, [(1.0, 7.0)] * len(origins)), points, list(rows))
            for t, row in enumerate(rows):
                there = {tuple(pair) for pair in found.pairs[3 * t : 3 * t + 3].tolist()}
                outer = {(v, w) for v, w in arcs(row) if (w, v) not in every}
                assert there == outer | ({(-1, -1)} if len(outer) < 3 else set())

    @pytest.mark.parametrize("seed", range(4))
    def test_drop_in(self, seed: int) -> None:
        """Every edge has its ridge, in the diagrams of our drop-in, whatever the order of the rays."""
        points = np.random.default_rng(seed).random((7, 2))
        mesh = delaunay(points)
        triangles = [(int(a), int(b), int(c)) for a, b, c in mesh.triangles]
        vertices, edges, origins, directions = drop_in.voronoi(points)
        order = np.random.default_rng(seed).permutation(len(origins))
        found = read((vertices, edges, origins[order], directions[order]), [(x, y) for x, y in points], triangles)
        wanted = {frozenset(arc) for t in triangles for arc in arcs(t)}
        assert sorted(map(sorted, found.pairs.tolist())) == sorted(map(sorted, wanted))
        for (a, b), direction in zip(found.pairs[len(edges) :], directions[order], strict=True):
            (x, y), (ux, uy) = direction, points[b] - points[a]
            assert abs(x * ux + y * uy) < 1e-12 < x * uy - y * ux


def arcs(t: Triangle) -> list[tuple[int, int]]:
    return [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]
