"""Clipped Voronoi cells: brute force in fractions, windows through vertices and along ridges, conforming domains."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from proofs_tests import oracles
from proofs_tests.mesh.strategies import point_sets
from proofs_tests.voronoi.oracle import area, cell_of, corners_of, fractions_of, nearest_double

from exactmesh import PSLG, Triangulation, Voronoi, constrained_delaunay, delaunay, refine, voronoi
from exactmesh.errors import (
    ChoiceError,
    ClipError,
    ExactMeshError,
    NonFiniteError,
    NotConformingError,
    NotDelaunayError,
)
from exactmesh.voronoi import Cells, Clip, clipping, walk

Window = tuple[float, ...] | list[tuple[float, float]]

#: On a grid of sites 0 .. 4: through sites, vertices and ridges, along ridges, far off, inside of one cell.
WINDOWS: list[Window] = [
    (0, 0, 4, 4),
    (-1, -1, 5, 5),
    (0.5, 0.5, 3.5, 3.5),
    (1.5, 0, 2.5, 4),
    (2.125, 2.125, 2.25, 2.375),
    [(0, 0), (4, 0), (0, 4)],
    [(2, 0), (4, 2), (2, 4), (0, 2)],
    [(2, 5), (5, 2), (2, -1), (-1, 2)],  # clockwise
    [(10, 10), (11, 10), (10, 11)],
    [(0, 0), (3, 1), (4, 4), (1, 3)],
    [(0, 1), (1, 0), (3, 0), (4, 1), (4, 3), (3, 4), (1, 4), (0, 3)],
    [(0.5, 0.5), (2, 0.5), (3.5, 0.5), (3.5, 3.5), (0.5, 3.5), (0.5, 0.5)],  # a straight corner, a repeated one
]


def cells_of(diagram: Voronoi) -> Cells:
    assert diagram.clipped is not None
    return diagram.clipped


def clip_faults(cells: Cells) -> list[str]:
    """What is wrong with cells in a convex window, by brute force."""
    points, window = oracles.rationals(cells.points), oracles.rationals(cells.window)
    faults = []
    polygons = [[fractions_of(p) for p in cells.exact_polygon(i)] for i in range(len(cells.sites))]
    if cells.sites.tolist() != sorted(set(cells.sites.tolist())):
        faults.append("sites do not ascend")
    found = dict(zip(cells.sites.tolist(), polygons, strict=True))
    wrong = (s for s in range(len(points)) if corners_of(found.get(s, [])) != cell_of(points, s, window))
    faults += [f"polygon of site {s}" for s in wrong]
    if sum(map(area, polygons)) != area(window):
        faults.append("areas do not add up")
    for i, polygon in enumerate(polygons):
        s, begin = int(cells.sites[i]), int(cells.offsets[i])
        if len(set(polygon)) != len(polygon):
            faults.append(f"site {s} has a corner twice")
        for k, a in enumerate(polygon):
            b, neighbor = polygon[(k + 1) % len(polygon)], int(cells.neighbors[begin + k])
            middle = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
            if neighbor >= 0:
                right = oracles.squared_distance(middle, points[s]) == oracles.squared_distance(
                    middle, points[neighbor]
                )
                right = right and neighbor != s
            else:
                right = oracles.orient(window[-1 - neighbor], window[-neighbor % len(window)], middle) == 0
            if not right:
                faults.append(f"neighbor of site {s} across edge {k}")
            if [nearest_double(x) for x in a] != cells.corners[begin + k].tolist():
                faults.append(f"corner {k} of site {s} is not the nearest double")
    return faults


@pytest.mark.obligation(
    "D4",
    "clipped cells are exactly cell and window; their areas add up to the window's, exactly",
    method="property-based",
)
class TestWindow:
    """The polygons are those of brute force in fractions, each corner rounded once, each edge with its neighbour; the
    window may pass through sites and vertices and along ridges."""

    @given(st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4)), min_size=1, max_size=9), st.sampled_from(WINDOWS))
    @settings(max_examples=150)
    def test_degenerate(self, points: list[tuple[int, int]], window: Window) -> None:
        assert clip_faults(cells_of(voronoi(points, clip=window))) == []

    @pytest.mark.parametrize("window", WINDOWS)
    def test_grid(self, window: Window) -> None:
        grid = [(x, y) for x in range(5) for y in range(5)]
        assert clip_faults(cells_of(voronoi(grid, clip=window))) == []

    @given(
        point_sets(7), st.lists(st.floats(-1.7e308, 1.7e308), min_size=4, max_size=4, unique=True), st.integers(0, 1000)
    )
    @settings(max_examples=60)
    def test_any(self, points: list[tuple[float, float]], sides: list[float], seed: int) -> None:
        """Any doubles: a box anywhere, and the triangle of three of the points."""
        x, y = sorted(sides[:2]), sorted(sides[2:])
        assert clip_faults(cells_of(voronoi(points, clip=(x[0], y[0], x[1], y[1])))) == []
        triple = [points[i] for i in np.random.default_rng(seed).integers(0, len(points), 3)]
        a, b, c = oracles.rationals(triple)
        if oracles.orient(a, b, c) != 0:
            assert clip_faults(cells_of(voronoi(points, clip=triple))) == []

    def test_many_arcs_in_one_cell(self) -> None:
        """A polygon of many sides through the cell of a hub with many neighbours: it leaves and comes back."""
        angles = np.arange(12) * 2 * np.pi / 12
        hub = [(0.0, 0.0), *zip(np.cos(angles).tolist(), np.sin(angles).tolist(), strict=True)]
        cells = cells_of(voronoi(hub, clip=np.array(hub[1:]) * 0.51))
        assert clip_faults(cells) == []
        assert len(cells.sites) == 13
        assert (cells.neighbors[cells.offsets[0] : cells.offsets[1]] < 0).sum() >= 12

    def test_controls(self) -> None:
        """A cell lost, neighbours, sites and sources shifted, a corner moved by one unit in the last place."""
        cells = cells_of(voronoi([(0, 0), (3, 1), (1, 3), (4, 4), (2, 2)], clip=(-1, -1, 5, 5)))
        assert clip_faults(cells) == []
        assert "areas do not add up" in clip_faults(replace(cells, sites=cells.sites[:-1], offsets=cells.offsets[:-1]))
        assert clip_faults(replace(cells, neighbors=np.roll(cells.neighbors, 1)))
        assert clip_faults(replace(cells, sites=cells.sites[::-1]))
        assert clip_faults(replace(cells, kinds=np.roll(cells.kinds, 1), sources=np.roll(cells.sources, 1)))
        moved = cells.corners.copy()
        moved[3, 0] = np.nextafter(moved[3, 0], 9.0)
        assert clip_faults(replace(cells, corners=moved)) == ["corner 3 of site 0 is not the nearest double"]

    def test_control_a_faulty_walk(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """A walk that takes any ridge ahead for the next one takes wrong turns; the check sees it."""
        for inner in ("_at_corner", "_ahead", "_record", "walk_around"):
            function = getattr(walk, inner)
            monkeypatch.setattr(walk, inner, getattr(function, "py_func", function))
        monkeypatch.setattr(clipping, "walk_around", walk.walk_around)
        grid = [(x, y) for x in range(5) for y in range(5)]
        assert all(clip_faults(cells_of(voronoi(grid, clip=window))) == [] for window in WINDOWS)
        monkeypatch.setattr(walk, "_order", lambda *_: 1)
        assert clip_faults(cells_of(voronoi(grid, clip=[(0.1, 0.2), (3.7, 1.1), (3.3, 3.9)])))


class TestMoments:
    """Areas, centroids and energies are those of the exact polygons, rounded."""

    @given(st.lists(st.tuples(st.integers(0, 40), st.integers(0, 40)), min_size=2, max_size=12, unique=True))
    @settings(max_examples=40)
    def test_against_fractions(self, points: list[tuple[int, int]]) -> None:
        cells = cells_of(voronoi(points, clip=(0, 0, 40, 40)))
        for i, s in enumerate(cells.sites.tolist()):
            polygon, (x, y) = [fractions_of(p) for p in cells.exact_polygon(i)], oracles.rationals(cells.points)[s]
            whole, mx, my, energy = Fraction(0), Fraction(0), Fraction(0), Fraction(0)
            for a, b in zip(polygon, [*polygon[1:], polygon[0]], strict=True):  # triangles with the site
                t = oracles.orient((x, y), a, b) / 2
                corners = [(x, y), a, b]
                middles = [((p[0] + q[0]) / 2, (p[1] + q[1]) / 2) for p, q in zip(corners, [a, b, (x, y)], strict=True)]
                whole += t
                mx += t * (x + a[0] + b[0]) / 3
                my += t * (y + a[1] + b[1]) / 3
                energy += t * sum(oracles.squared_distance(m, (x, y)) for m in middles) / 3  # exact for squares
            assert cells.areas[s] == pytest.approx(float(whole), rel=1e-12)
            assert cells.centroids[s].tolist() == pytest.approx([float(mx / whole), float(my / whole)], rel=1e-12)
            assert cells.energies[s] == pytest.approx(float(energy), rel=1e-12)

    def test_nothing_inside(self) -> None:
        cells = cells_of(voronoi([(0, 0), (1, 0), (9, 9)], clip=(8, 8, 10, 10)))
        assert cells.areas.tolist() == [0.0, 0.0, 4.0]
        assert np.isnan(cells.centroids[:2]).all()


class TestBadWindows:
    """What is no box and no convex polygon is refused, and the corner named."""

    @pytest.mark.parametrize(
        ("clip", "error", "words"),
        [
            ((0, 0, 0, 1), ClipError, "empty"),
            ((1, 1, 0, 0), ClipError, "empty"),
            ((0, 0, float("nan"), 1), NonFiniteError, "finite"),
            ([(0, 0), (float("inf"), 0), (0, 1)], NonFiniteError, r"clip\[1\]"),
            ([(0, 0), (1, 0)], ClipError, "three"),
            ([(0, 0), (1, 1), (2, 2), (3, 3)], ClipError, "one line"),
            ([(0, 0), (4, 0), (1, 1), (0, 4)], ClipError, "corner 2 turns"),
            ([(0, 0), (2, 2), (2, 0), (0, 2)], ClipError, "turns the other way"),
            ([(0, 3), (-2, -3), (3, 1), (-3, 1), (2, -3)], ClipError, "more than once"),
            ([(0, 0), (4, 0), (2, 0), (4, 4)], ClipError, "no convex polygon"),
            ([(0, 0, 0)] * 3, ClipError, "shape"),
            ([(0, 0), (1,)], ClipError, "neither"),
            (5, ClipError, "shape"),
            ("domian", ChoiceError, "domian"),
            ("domain", ChoiceError, "triangulation"),
        ],
    )
    def test_refused(self, clip: object, error: type[ExactMeshError], words: str) -> None:
        with pytest.raises(error, match=words):
            voronoi([(0, 0), (1, 0), (0, 1)], clip=clip)  # type: ignore[arg-type]  # bad on purpose


def right_angled(cells: list[tuple[int, int]]) -> Triangulation:
    """Unit squares, each cut by its diagonal, as the constrained triangulation of a domain."""
    corners = sorted({(x + i, y + j) for x, y in cells for i in (0, 1) for j in (0, 1)})
    sides: dict[tuple[tuple[int, int], tuple[int, int]], int] = {}
    for x, y in cells:
        ring = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)]
        for a, b in zip(ring, ring[1:] + ring[:1], strict=True):
            key = (min(a, b), max(a, b))
            sides[key] = sides.get(key, 0) + 1
    segments = [(corners.index(a), corners.index(b)) for (a, b), uses in sides.items() if uses == 1]
    return constrained_delaunay(PSLG(corners, segments, rule="even-odd"))


def domain_faults(mesh: Triangulation, cells: Cells) -> list[str]:
    """What is wrong with the cells of a conforming triangulation: each triangle is cut into the parts of its corners,
    which together are its area; corners lie as near to their site as to any."""
    points, faults = oracles.rationals(mesh.points), []
    polygons = [[fractions_of(p) for p in cells.exact_polygon(i)] for i in range(len(cells.sites))]
    total = sum((oracles.orient(*(points[v] for v in t)) for t in mesh.triangles.tolist()), Fraction(0)) / 2
    if sum(map(area, polygons)) != total:
        faults.append("areas do not add up")
    for i, polygon in enumerate(polygons):
        s = int(cells.sites[i])
        if any(oracles.orient(polygon[k - 1], polygon[k], points[s]) < 0 for k in range(len(polygon))):
            faults.append(f"polygon {i} is not a star")
        if len(set(polygon)) != len(polygon):
            faults.append(f"polygon {i} has a corner twice")
        distances = ([oracles.squared_distance(corner, p) for p in points] for corner in polygon)
        faults += [f"a corner of polygon {i} is nearer to another site" for row in distances if row[s] > min(row)]
    return faults


@pytest.mark.obligation(
    "D5", "in a conforming domain every circumcentre is inside, and the cells cover it exactly", method="property-based"
)
class TestDomain:
    """The cells of a boundary conforming triangulation tile its domain, exactly; others are refused by name."""

    SHAPES = ([(0, 0)], [(0, 0), (1, 0), (0, 1)], [(x, y) for x in range(3) for y in range(3) if (x, y) != (1, 1)])

    @pytest.mark.parametrize("shape", SHAPES)
    def test_squares(self, shape: list[tuple[int, int]]) -> None:
        mesh = right_angled(shape)
        cells = cells_of(voronoi(mesh, clip=Clip.DOMAIN))
        assert domain_faults(mesh, cells) == []
        assert cells.areas.sum() == len(shape)
        assert sorted(set(cells.sites.tolist())) == list(range(len(mesh.points)))

    def test_squares_that_touch(self) -> None:
        """Where two parts of the domain meet in a vertex, its cell has two polygons."""
        mesh = right_angled([(0, 0), (1, 1)])
        cells = cells_of(voronoi(mesh, clip="domain"))
        assert domain_faults(mesh, cells) == []
        middle = mesh.points.tolist().index([1.0, 1.0])
        assert cells.sites.tolist().count(middle) == 2

    @pytest.mark.once
    @given(st.lists(st.tuples(st.integers(1, 31), st.integers(1, 31)), max_size=12))
    @settings(max_examples=60)
    def test_convex_domain_is_a_window(self, inner: list[tuple[int, int]]) -> None:
        """In a square whose boundary is dense, the domain's cells are the window's."""
        rim = [(x, y) for t in range(0, 32, 2) for x, y in ((t, 0), (32, t), (32 - t, 32), (0, 32 - t))]
        mesh = delaunay([*rim, *((x, y) for x, y in inner if 2 <= x <= 30 and 2 <= y <= 30)])
        inside, clipped = cells_of(voronoi(mesh, clip="domain")), cells_of(voronoi(mesh, clip=(0, 0, 32, 32)))
        assert inside.sites.tolist() == clipped.sites.tolist()
        for i in range(len(inside.sites)):
            assert corners_of([*map(fractions_of, inside.exact_polygon(i))]) == corners_of(
                [*map(fractions_of, clipped.exact_polygon(i))]
            )

    def test_refined(self) -> None:
        """What refine calls conforming is."""
        corners = [(0, 0), (7, 1), (12, 0), (11, 6), (6, 2), (5, 9), (1, 8)]
        mesh = refine(PSLG.from_rings([corners]), min_angle=20.0, conforming=True).triangulation
        assert domain_faults(mesh, cells_of(voronoi(mesh, clip="domain"))) == []

    def test_not_conforming(self) -> None:
        with pytest.raises(NotConformingError, match=r"beyond edge \(0, 1\) of the boundary") as caught:
            voronoi(delaunay([(0, 0), (4, 0), (2, 1)]), clip="domain")
        assert caught.value.indices == (0, 1)

    def test_not_delaunay(self) -> None:
        mesh = constrained_delaunay(PSLG([(0, 0), (4, 0), (5, 3), (0, 1)], [(0, 2)]), carve=False)
        with pytest.raises(NotDelaunayError):
            voronoi(mesh, clip="domain")

    def test_controls(self) -> None:
        """A cell lost, sites shifted, sources exchanged."""
        mesh = right_angled([(0, 0), (1, 0), (0, 1)])
        cells = cells_of(voronoi(mesh, clip="domain"))
        fewer = replace(cells, sites=cells.sites[:-1], offsets=cells.offsets[:-1])
        assert "areas do not add up" in domain_faults(mesh, fewer)
        assert domain_faults(mesh, replace(cells, sites=np.roll(cells.sites, 1)))
        assert domain_faults(mesh, replace(cells, sources=cells.sources[::-1], kinds=cells.kinds[::-1]))
