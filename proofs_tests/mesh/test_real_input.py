"""Real input: the cities of the world and of the United States; and what other meshers get wrong."""

from collections import Counter
from collections.abc import Callable
from math import cos, pi, radians, sin

import numpy as np
import pytest
from bokeh_sampledata import us_cities, world_cities
from proofs_tests import oracles
from proofs_tests.mesh import oracle as mesh_oracle
from proofs_tests.mesh.enumeration import canonical_triangles
from proofs_tests.oracles import Triangle
from scipy.spatial import Delaunay

from exactkernel.jit import COMPILED
from exactkernel.types import FloatArray
from exactmesh import Triangulation, delaunay, verify

CITIES: dict[str, FloatArray] = {
    "world": np.ascontiguousarray(world_cities.data[["lng", "lat"]], dtype=np.float64),
    "United States": np.stack([us_cities.data["lon"], us_cities.data["lat"]], axis=1),
}
EACH = pytest.mark.parametrize("name", CITIES)


def cities(name: str) -> FloatArray:
    """All of them; interpreted, some, with the duplicates."""
    points = CITIES[name]
    if COMPILED:
        return points
    times = Counter(map(tuple, points.tolist()))
    again = [i for i, p in enumerate(points.tolist()) if times[tuple(p)] > 1]
    return points[sorted({*range(0, len(points), 100), *again})]


@pytest.mark.obligation(
    "M4",
    "real cities, duplicates and all, are triangulated as brute force and scipy say",
    method="named cases",
    control_in="TestKnownCases",
)
@EACH
class TestCities:
    """All cities are triangulated: the verifier agrees, each city has the vertex at its place, no place has two, and
    the order of the input does not matter."""

    def test_verified(self, name: str) -> None:
        points = cities(name)
        mesh = delaunay(points)
        assert verify(mesh.points, mesh.triangles).ok
        assert len(mesh.triangles) == 2 * len(mesh.points) - len(mesh.hull) - 2

    def test_duplicates(self, name: str) -> None:
        points = cities(name)
        mesh = delaunay(points)
        places = list(dict.fromkeys(map(tuple, points.tolist())))
        assert list(map(tuple, mesh.points.tolist())) == places
        number = {place: vertex for vertex, place in enumerate(places)}
        assert mesh.representative.tolist() == [number[tuple(p)] for p in points.tolist()]
        assert (len(places) < len(points)) is (name == "world")

    def test_any_order(self, name: str) -> None:
        points = cities(name)
        canonical = delaunay(points).canonical()
        for seed in (1, 2):
            order = np.random.default_rng(seed).permutation(len(points))
            assert delaunay(points[order], seed=seed).canonical() == canonical

    def test_brute_force(self, name: str) -> None:
        """Of 200 cities, every triangle has an empty (perturbed) circle, and they are as many as Euler wants."""
        points = np.random.default_rng(0).choice(CITIES[name], 200 if COMPILED else 60, replace=False)
        mesh = delaunay(points)
        exact = oracles.rationals(mesh.points.tolist())
        for a, b, c in mesh.triangles.tolist():
            assert oracles.orient(exact[a], exact[b], exact[c]) > 0
            assert mesh_oracle.is_perturbed_empty(exact, (a, b, c), range(len(exact)))
        assert len(mesh.triangles) == 2 * len(exact) - len(mesh.hull) - 2

    def test_scipy(self, name: str) -> None:
        """Where scipy has another triangle, brute force over all cities refutes it (or it is a tie)."""
        mesh = delaunay(cities(name))
        exact = oracles.rationals(mesh.points.tolist())
        ours, theirs = sides(mesh.triangles.tolist()), sides(Delaunay(mesh.points).simplices.tolist())
        assert len(ours & theirs) > 0.999 * len(ours)
        everyone = range(len(exact))
        for a, b, c in map(sorted, ours - theirs):
            assert mesh_oracle.is_perturbed_empty(exact, oracles.counterclockwise(exact, (a, b, c)), everyone)
        for a, b, c in map(sorted, theirs - ours):
            t = oracles.counterclockwise(exact, (a, b, c))
            assert not oracles.has_area(exact, t) or not mesh_oracle.is_perturbed_empty(exact, t, everyone)


def sides(rows: list[list[int]]) -> set[frozenset[int]]:
    return {frozenset(row) for row in rows}


class TestRefutation:
    """The comparison with scipy is not empty talk: a triangle with a city in its circle is refuted."""

    def test_control_refuted(self) -> None:
        points = np.random.default_rng(0).choice(CITIES["world"], 40, replace=False)
        exact = oracles.rationals(delaunay(points).points.tolist())
        t: Triangle = oracles.counterclockwise(exact, (0, 1, 2))
        assert not mesh_oracle.is_perturbed_empty(exact, t, range(len(exact)))


def turned_grid(degrees: float) -> FloatArray:
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(10.0), np.arange(10.0)))
    c, s = cos(radians(degrees)), sin(radians(degrees))
    return np.stack([c * x - s * y, s * x + c * y], axis=1)


def circle(n: int) -> FloatArray:
    angles = 2 * pi * np.arange(n) / n
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


GEOS_1286 = np.array(
    [
        (-1.3890020986020145e-10, 4.860466764224401),
        (-1.3889120965221466e-10, -5.531838081766228),
        (-1.388852095135568e-10, -12.460041312426647),
        (0.9999999999166641, -3.799787274101123),
    ]
)

#: Point sets on which GEOS or scipy are wrong, and the number of triangles that belong there (None: by Euler alone).
CORPUS: dict[str, tuple[FloatArray, int | None]] = {
    "GEOS 1286": (GEOS_1286, 2),
    "scipy: inverted triangle and overlap": (np.random.default_rng(17).random((15, 2)) + 1e6, None),
    "scipy: points dropped": (np.random.default_rng(0).random((300, 2)) + 1e6, None),
    "scipy: one edge": (np.random.default_rng(15).random((5, 2)) + 1e5, None),
    "turned grid": (turned_grid(302.328), 185),
    "circle": (circle(200), 198),
}


@pytest.mark.obligation("M4", "where GEOS and scipy are wrong, insertion is right", method="named cases")
class TestKnownCases:
    """On the published and the known failures of other meshers the result is that of brute force, and verified."""

    @pytest.mark.parametrize(("points", "count"), CORPUS.values(), ids=CORPUS.keys())
    def test_right(self, points: FloatArray, count: int | None) -> None:
        mesh = delaunay(points)
        assert len(mesh.points) == len(points)
        assert verify(mesh.points, mesh.triangles).ok
        assert len(mesh.triangles) == 2 * len(points) - len(mesh.hull) - 2
        assert count is None or len(mesh.triangles) == count
        if len(points) <= 15:
            exact = oracles.rationals(points.tolist())
            assert canonical_triangles(mesh.triangles.tolist()) == mesh_oracle.delaunay_triangles(exact)

    @pytest.mark.parametrize("mesher", [delaunay, Delaunay])
    def test_control_scipy_fails(self, mesher: Callable[[FloatArray], object]) -> None:
        """The checks above reject what scipy says of the same points, and accept what exactmesh says."""
        points = CORPUS["scipy: points dropped"][0]
        mesh = mesher(points)
        rows = mesh.triangles if isinstance(mesh, Triangulation) else Delaunay(points).simplices
        assert verify(points, rows, orientation="any").ok is (mesher is delaunay)
