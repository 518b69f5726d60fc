"""Natural neighbours, interpolation and Lloyd's relaxation."""

import sys
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from proofs_tests import oracles
from proofs_tests.kernel.test_compiled import in_a_child
from proofs_tests.mesh.digest import inputs
from proofs_tests.mesh.strategies import point_sets
from proofs_tests.once import once_after
from proofs_tests.voronoi.oracle import sibson
from proofs_tests.voronoi.test_voronoi import mesh_of

from exactkernel.types import FloatArray
from exactmesh import Triangulation, delaunay
from exactmesh.errors import (
    ChoiceError,
    ClipError,
    CollinearPointsError,
    ConflictingValuesError,
    CoordinateError,
    ExactMeshError,
    NonFiniteError,
    NotDelaunayError,
    ShapeError,
)
from exactmesh.voronoi import NaturalNeighbors, interpolate, lloyd, natural_neighbors

MODULE = sys.modules["exactmesh.voronoi.interpolation"]

grid_point = st.tuples(st.integers(0, 6), st.integers(0, 6))
eighth = st.tuples(st.integers(0, 48).map(lambda i: i / 8), st.integers(0, 48).map(lambda i: i / 8))


def row(found: NaturalNeighbors, i: int) -> dict[int, float]:
    entries = slice(int(found.offsets[i]), int(found.offsets[i + 1]))
    return dict(zip(found.sites[entries].tolist(), found.weights[entries].tolist(), strict=True))


def largest_error(mesh: Triangulation, queries: FloatArray, found: NaturalNeighbors) -> float:
    """The largest difference from Sibson's coordinates by brute force, over queries strictly inside the hull."""
    points = oracles.rationals(mesh.points)
    worst = 0.0
    for i, q in enumerate(oracles.rationals(queries)):
        edges = zip(mesh.hull.tolist(), np.roll(mesh.hull, -1).tolist(), strict=True)
        if q in points or any(oracles.orient(points[a], points[b], q) <= 0 for a, b in edges):
            continue
        wanted, given = sibson(points, q), row(found, i)
        errors = (abs(wanted.get(v, Fraction(0)) - Fraction(given.get(v, 0.0))) for v in {*wanted, *given})
        worst = max(worst, float(max(errors)))
    return worst


@pytest.mark.obligation(
    "D6", "Sibson's coordinates are the parts of the stolen cell, to 2^-50 of it", method="property-based"
)
class TestCoordinates:
    """The coordinates are the areas that brute force in fractions finds; they add up to 1, and to the point."""

    @given(st.lists(grid_point, min_size=3, max_size=9, unique=True), st.lists(eighth, min_size=1, max_size=4))
    @settings(max_examples=80)
    def test_degenerate(self, points: list[tuple[int, int]], queries: list[tuple[float, float]]) -> None:
        mesh = mesh_of(points)
        assert largest_error(mesh, np.array(queries), natural_neighbors(mesh, queries)) < 1e-14

    @given(point_sets(7), st.integers(0, 2**32))
    @settings(max_examples=60)
    def test_any_doubles(self, points: list[tuple[float, float]], seed: int) -> None:
        """Queries are rounded mixtures of the points, at whatever scale."""
        mesh = mesh_of([p for p in points if max(map(abs, p)) < 1e300])
        mixed = np.random.default_rng(seed).dirichlet(np.ones(len(mesh.points)), 3) @ mesh.points
        assert largest_error(mesh, mixed, natural_neighbors(mesh, mixed)) < 1e-13

    @pytest.mark.parametrize(
        "name", once_after(1, ["subnormal", "uniform", "circle", "line", "clusters", "grid", "no window"])
    )
    def test_partition_of_unity(self, name: str) -> None:
        mesh = delaunay(inputs()[name])
        corners = mesh.points[mesh.triangles]
        queries = np.concatenate([corners[:, 0] / 2 + corners[:, 1] / 4 + corners[:, 2] / 4, mesh.points])
        found = natural_neighbors(mesh, queries)
        assert (found.weights >= 0).all()
        for i in np.flatnonzero(np.diff(found.offsets)).tolist():
            assert sum(row(found, i).values()) == pytest.approx(1.0, rel=1e-13)
        sites = len(mesh.points)
        assert [row(found, len(queries) - sites + v) for v in range(sites)] == [{v: 1.0} for v in range(sites)]

    def test_hull(self) -> None:
        """On an edge of the hull, the limits; outside nothing."""
        found = natural_neighbors([(0, 0), (8, 0), (0, 8), (1, 1)], [(2, 0), (6, 2), (-1, 0), (8.5, 0), (0, 8)])
        assert [row(found, i) for i in range(5)] == [{0: 0.75, 1: 0.25}, {1: 0.75, 2: 0.25}, {}, {}, {2: 1.0}]

    def test_the_rationals_agree(self) -> None:
        """What is left open and done in rationals is the same, rounded."""
        mesh = delaunay(np.random.default_rng(3).random((60, 2)))
        queries = np.random.default_rng(4).random((40, 2)) * 0.6 + 0.2
        found = natural_neighbors(mesh, queries)
        for i, t in enumerate(mesh.locate(queries).tolist()):
            exact = MODULE._exact_coordinates(mesh, queries[i], t)
            assert set(exact) == set(row(found, i))
            assert all(abs(float(weight) - row(found, i)[v]) < 1e-15 for v, weight in exact.items())

    def test_controls(self) -> None:
        """Weights exchanged, and weights that are all the same."""
        mesh = delaunay([(0, 0), (6, 0), (6, 6), (0, 6), (2, 3), (4, 2)])
        queries = np.array([(3.0, 3.0), (1.0, 2.0)])
        found = natural_neighbors(mesh, queries)
        assert largest_error(mesh, queries, found) < 1e-15
        swapped = NaturalNeighbors(found.offsets, found.sites, found.weights[::-1].copy())
        assert largest_error(mesh, queries, swapped) > 1e-3
        uniform = NaturalNeighbors(found.offsets, found.sites, np.full_like(found.weights, 0.25))
        assert largest_error(mesh, queries, uniform) > 1e-3


def deviation(points: FloatArray, values: FloatArray, plane: FloatArray, queries: FloatArray) -> float:
    """How far the interpolant is from a linear function, relative to its values."""
    found = interpolate(points, values, queries)
    inside = ~np.isnan(found)
    assert inside.any()
    return float(np.abs(found - queries @ plane - 1.0)[inside].max() / np.abs(values).max())


@pytest.mark.obligation(
    "D7",
    "the interpolant takes the data, reproduces linear functions, stays within its neighbours",
    method="property-based",
)
class TestInterpolation:
    """It takes the values at the sites, is linear for linear values, continuous, and never beyond the values around."""

    @pytest.mark.parametrize("name", once_after(1, ["duplicates", "uniform", "circle", "line", "clusters", "grid"]))
    def test_linear(self, name: str) -> None:
        points, plane = inputs()[name], np.array([3.0, -2.0])
        random = np.random.default_rng(5)
        queries = random.dirichlet(np.ones(3), 300)[:, :, None] * points[random.integers(0, len(points), (300, 3))]
        assert deviation(points, points @ plane + 1.0, plane, queries.sum(axis=1)) < 1e-13

    def test_control_another_interpolant_is_not_linear(self) -> None:
        """Data that are not linear."""
        points, plane = inputs()["uniform"], np.array([3.0, -2.0])
        assert deviation(points, (points**2) @ plane + 1.0, plane, points[:50] * 0.9) > 1e-3

    @given(st.lists(grid_point, min_size=4, max_size=9, unique=True), st.integers(0, 2**32))
    @settings(max_examples=60)
    def test_data_and_bounds(self, points: list[tuple[int, int]], seed: int) -> None:
        mesh, random = mesh_of(points), np.random.default_rng(seed)
        values = random.normal(size=len(points))
        assert np.array_equal(interpolate(points, values, points), values)
        queries = random.random((30, 2)) * 6
        found = natural_neighbors(mesh, queries)
        result = interpolate(mesh, values, queries)
        for i in range(30):
            around = values[found.sites[found.offsets[i] : found.offsets[i + 1]]]
            assert np.isnan(result[i]) if not len(around) else around.min() - 1e-12 <= result[i] <= around.max() + 1e-12

    @pytest.mark.once
    def test_continuous(self) -> None:
        """Across every edge, circle and site that a path meets, a step of 1e-9 changes little: at most its length times
        a constant, and at a site at most the square root of it."""
        random = np.random.default_rng(6)
        points, values = random.random((80, 2)), random.normal(size=80)
        path = np.linspace(points[3], points[50], 2001)
        there = np.repeat(path, 2, axis=0) + np.tile([[0.0, 0.0], [1e-9, 1e-9]], (len(path), 1))
        found = interpolate(points, values, there).reshape(-1, 2)
        found = found[~np.isnan(found).any(axis=1)]
        assert len(found) > 1900
        assert np.abs(found[:, 0] - found[:, 1]).max() < 1e-6

    def test_columns_and_nan(self) -> None:
        points = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 5)]
        values = np.array([[0, 1], [2, 1], [4, 1], [2, 1], [6, np.nan]])
        found = interpolate(points, values, [(1, 0.5), (9, 9), (1, 3)])
        assert found.shape == (3, 2)
        assert found[0].tolist() == pytest.approx([1.5, 1.0])
        assert np.isnan(found[1]).all()
        assert np.isnan(found[2, 1])
        assert not np.isnan(found[2, 0])

    def test_bad_input(self) -> None:
        points = [(0, 0), (2, 0), (2, 2), (0, 2), (2, 0)]
        assert interpolate(points, [0, 2, 4, 2, 2], [(1, 1)]).tolist() == [2.0]
        with pytest.raises(ConflictingValuesError, match="points 1 and 4") as caught:
            interpolate(points, [0, 2, 4, 2, 3], [(1, 1)])
        assert caught.value.indices == (1, 4)
        mesh = delaunay([(0, 0), (4, 0), (5, 3), (0, 1)])
        wrong = Triangulation(
            mesh.points, np.array([(0, 1, 2), (0, 2, 3)], "i4"), np.array([(-1, 1, -1), (-1, -1, 0)], "i4"),
            mesh.representative, mesh.work,
        )  # fmt: skip
        cases: list[tuple[object, object, object, type[ExactMeshError]]] = [
            (points, [0, 2, 4, 2], [(1, 1)], ShapeError),
            (points, [[[0]]] * 5, [(1, 1)], ShapeError),
            (points, ["a"] * 5, [(1, 1)], CoordinateError),
            (points, [0, 2, 4, 2, 2], [(1, float("nan"))], NonFiniteError),
            (points, [0, 2, 4, 2, 2], [1, 1], ShapeError),
            ([(0, 0), (1, 1), (2, 2)], [0, 1, 2], [(1, 1)], CollinearPointsError),
            (wrong, [0, 1, 2, 3], [(1, 1)], NotDelaunayError),
        ]
        for sites, values, at, error in cases:
            with pytest.raises(error):
                interpolate(sites, values, at)  # type: ignore[arg-type]  # bad on purpose


@pytest.mark.obligation(
    "D8", "Lloyd's energy never grows; it rests where every site is the centroid of its cell", method="property-based"
)
class TestLloyd:
    """The energy falls from step to step, points stay in the window, and a centroidal diagram stays as it is."""

    @given(st.lists(grid_point, min_size=1, max_size=12), st.integers(1, 6))
    @settings(max_examples=40)
    def test_falls(self, points: list[tuple[int, int]], iterations: int) -> None:
        relaxed = lloyd(points, clip=(0, 0, 6, 6), iterations=iterations)
        assert (np.diff(relaxed.energies) <= 1e-12 * relaxed.energies[0]).all()
        assert relaxed.points.shape == (len(points), 2)
        assert ((relaxed.points >= 0) & (relaxed.points <= 6)).all()
        together = {p: {tuple(relaxed.points[i].tolist()) for i, q in enumerate(points) if q == p} for p in points}
        assert all(len(places) == 1 for places in together.values())

    def test_rests(self) -> None:
        grid = [(x + 0.5, y + 0.5) for x in range(4) for y in range(4)]
        relaxed = lloyd(grid, clip=(0, 0, 4, 4), movement=1e-12)
        assert np.abs(relaxed.points - grid).max() < 1e-12
        assert len(relaxed.movements) == 1
        assert relaxed.energies[0] == pytest.approx(16 / 6)

    @pytest.mark.once
    def test_centroidal_in_the_end(self) -> None:
        points = np.random.default_rng(0).random((12, 2))
        relaxed = lloyd(points, clip=[(0, 0), (1, 0), (1, 1), (0, 1)], iterations=2000, movement=1e-9)
        assert relaxed.movements[-1] <= 1e-9 < relaxed.movements[:-1].min()
        assert relaxed.energies[-1] < 0.7 * relaxed.energies[0]

    def test_control_other_moves_raise_the_energy(self) -> None:
        """Points moved away from their centroids."""
        points = np.random.default_rng(0).random((30, 2))
        relaxed = lloyd(points, clip=(0, 0, 1, 1), iterations=3)
        mirrored = np.clip(2 * points - relaxed.points, 0.0, 1.0)
        assert lloyd(mirrored, clip=(0, 0, 1, 1), iterations=0).energies[0] > relaxed.energies[0]

    @pytest.mark.parametrize("scale", [2.0**-1000, 2.0**900])
    def test_any_scale(self, scale: float) -> None:
        points = np.random.default_rng(1).random((10, 2))
        one, other = (
            lloyd(points, clip=(0, 0, 1, 1), iterations=5),
            lloyd(points * scale, clip=(0, 0, scale, scale), iterations=5),
        )
        assert np.abs(other.points / scale - one.points).max() < 1e-12

    def test_bad_input(self) -> None:
        with pytest.raises(ClipError, match=r"points\[1\]") as caught:
            lloyd([(0.5, 0.5), (2, 2), (1, 1)], clip=(0, 0, 1, 1))
        assert caught.value.indices == (1,)
        for options in ({"iterations": -1}, {"iterations": 1.5}, {"movement": -1.0}, {"movement": float("nan")}):
            with pytest.raises(ChoiceError):
                lloyd([(0.5, 0.5)], clip=(0, 0, 1, 1), **options)


@pytest.mark.compiled
@pytest.mark.obligation(
    "J1", "Voronoi diagrams, clipping, interpolation and relaxation: compiled equals interpreted", method="bit for bit"
)
class TestLanes:
    """Diagrams, clipped cells, natural neighbours and relaxation have the same bits compiled and interpreted."""

    def test_child(self) -> None:
        from proofs_tests.voronoi import digest as voronoi_digest

        here = "".join(f"{name}: {digest}\n" for name, digest in voronoi_digest.digests().items())
        assert in_a_child("-m", "proofs_tests.voronoi.digest", NUMBA_DISABLE_JIT="1") == here

    def test_control(self) -> None:
        """One coordinate moved by one unit in the last place."""
        from proofs_tests.voronoi import digest as voronoi_digest

        points = inputs()["uniform"]
        moved = points.copy()
        moved[7, 0] = np.nextafter(moved[7, 0], 2.0)
        assert voronoi_digest.diagram(points) != voronoi_digest.diagram(moved)
        assert voronoi_digest.diagram(points) == voronoi_digest.diagram(points.copy())


@pytest.mark.bounds
@pytest.mark.compiled
class TestBounds:
    """No routine leaves an array on any of the inputs of the digest: with NUMBA_BOUNDSCHECK=1 it would raise."""

    def test_all(self) -> None:
        from proofs_tests.voronoi import digest as voronoi_digest

        assert len(voronoi_digest.digests()) == 3 * len(inputs())
