"""V1 for circumcentres inside of the mesh, each function alone, against fractions."""

import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import pairwise, product
from random import Random

import numpy as np
import pytest
from gmpy2 import mpq
from proofs_tests import oracles
from proofs_tests.oracles import Triangle

from exactkernel.constants import INCIRCLE_BOUND
from exactkernel.context import Context, make_context
from exactkernel.types import FloatArray, IntArray
from exactmesh import delaunay
from exactmesh.verify import Kind, Property, centres, verify
from exactmesh.verify.adjacency import neighbours_of, rows_of_slots
from exactmesh.verify.boundary import boundary_of
from exactmesh.verify.centres import UNKNOWN, Outline
from exactmesh.verify.links import Links, linked
from exactmesh.verify.local import localized
from exactmesh.verify.mesh import Mesh, index_quads, index_triples, prepared_mesh

#: Integers are rationals as well.
Place = tuple[int | Fraction, int | Fraction]


def side(k: Context, points: FloatArray) -> int:
    """What the filter says of p, q and a, b, c in a row."""
    return int(centres.centre_side(k, *points.reshape(-1).tolist()))


def determinant_and_permanent(points: FloatArray) -> tuple[Fraction, Fraction]:
    """How far the circumcentre is to the left of the line, times its length and four times the area; and the sum of the
    magnitudes of all products in that polynomial."""
    p, q, a, b, c = oracles.rationals(points.tolist())
    (ux, uy), (vx, vy), (sx, sy), (wx, wy) = ((y[0] - x[0], y[1] - x[1]) for x, y in ((a, b), (a, c), (p, q), (p, a)))
    uu, vv = ux * ux + uy * uy, vx * vx + vy * vy
    products = [one * other for one in (2 * ux * vy, 2 * uy * vx) for other in (sx * wy, sy * wx)]
    products += [sx * ux * vv, sx * vx * uu, sy * vy * uu, sy * uy * vv]
    value = oracles.orient(p, q, oracles.circumcircle(a, b, c)[0]) * 2 * oracles.orient(a, b, c)
    return value, sum(map(abs, products), Fraction(0))


def line_and_triangle(random: Random) -> FloatArray:
    """A line through the centre of a circle, or beside it, and three lattice points of the circle; turned, moved and
    rounded."""
    ring = [(5, 0), (3, 4), (-3, 4), (-4, 3), (-5, 0), (0, -5), (4, -3)]
    line = [(-2, -1 + random.choice((0, 0, 1))), (4, 2)]
    corners = [ring[i] for i in sorted(random.sample(range(7), 3))]
    angle, x, y = random.random() * 7, random.choice((0.0, 50.0, -900.0)), random.random()
    c, s = math.cos(angle), math.sin(angle)
    return np.array([(c * p - s * q + x, s * p + c * q + y) for p, q in [*line, *corners]])


@pytest.mark.obligation("V1", "the side of a circumcentre is certain where it is told", method="differential")
class TestSide:
    """The filter's sign is that of the fractions, it is told exactly beyond twice the bound of incircle, and equality
    only where all differences are on a grid of doubles."""

    @pytest.mark.parametrize("seed", range(6))
    def test_near_equality(self, seed: int) -> None:
        random, told = Random(seed), set[int]()
        for _ in range(120):
            points = line_and_triangle(random) * random.choice((1.0, 2.0**20, 2.0**-20))
            k = make_context(points)._replace(grid_limit=0.0)
            value, permanent = determinant_and_permanent(points)
            found, error = side(k, points), 2 * Fraction(INCIRCLE_BOUND) * permanent
            assert found in (UNKNOWN, (value > 0) - (value < 0))
            if abs(value) > error * Fraction(11, 10):
                assert found != UNKNOWN
            if abs(value) < error * Fraction(9, 10):
                assert found == UNKNOWN
            told.add(found)
        assert told == {-1, 1, UNKNOWN}

    @pytest.mark.parametrize("seed", range(4))
    def test_integers(self, seed: int) -> None:
        """Small integers: all signs are told, equality as well."""
        random, told = Random(seed), set[int]()
        while len(told) < 3 or random.random() < 0.98:
            points = np.array([(random.randrange(-4, 5), random.randrange(-4, 5)) for _ in range(5)], dtype=np.float64)
            p, q, a, b, c = oracles.rationals(points.tolist())
            if oracles.orient(a, b, c) <= 0:
                continue
            turn = oracles.orient(p, q, oracles.circumcircle(a, b, c)[0])
            assert side(make_context(points), points) == (turn > 0) - (turn < 0)
            told.add((turn > 0) - (turn < 0))

    @pytest.mark.parametrize("which", range(8))
    def test_control_beyond_the_grid(self, which: int) -> None:
        """One difference of the eight beyond the limit: equality is not told any more."""
        hits, random = 0, Random(which)
        for _ in range(9000):
            a, b, c, p = (random.choice(CIRCLE) for _ in range(4))
            size = random.randrange(1, 4)
            points = np.array([p, (-size * p[0], -size * p[1]), a, b, c], dtype=np.float64)  # through the centre
            u, v, s, w = points[3] - points[2], points[4] - points[2], points[1] - points[0], points[2] - points[0]
            sizes = np.abs(np.concatenate([u, v, s, w]))
            if sizes.argmax() != which or np.sum(sizes == sizes.max()) > 1 or u[0] * v[1] <= u[1] * v[0]:
                continue
            k, hits = make_context(points), hits + 1
            assert side(k._replace(grid_limit=float(sizes.max())), points) == 0
            assert side(k._replace(grid_limit=float(sizes.max()) - 0.5), points) == UNKNOWN
            if hits == 3:
                return
        pytest.fail("no case found")


CIRCLE = [(5, 0), (3, 4), (-3, 4), (-4, 3), (-5, 0), (0, -5), (4, -3), (0, 5), (4, 3), (3, -4)]


def linked_mesh(points: FloatArray, triangles: Sequence[Triangle]) -> tuple[Mesh, Links]:
    mesh, _ = prepared_mesh(points, index_triples(triangles), index_quads(()), np.empty((0, 2)))
    return mesh, linked(len(points), mesh.context, localized(mesh.coordinates, mesh.triangles, mesh.quads))


def across_of(mesh: Mesh, links: Links) -> IntArray:
    rows = rows_of_slots(links, mesh.triangles)
    return neighbours_of(links, mesh.triangles, rows, np.zeros(len(links.slots), dtype=np.uint8), 0)


def ladder(height: int, centre: int = 560) -> tuple[list[tuple[float, float]], list[Triangle]]:
    """A tower two triangles wide on a flat one, whose circumcentre is so far above it."""
    points = [(1.0, -1.0 / (2 * centre)), *((float(x), float(y)) for y in range(height + 1) for x in (0, 2))]
    rungs = [((v, v + 1, v + 3), (v, v + 3, v + 2)) for v in range(1, 2 * height, 2)]
    return points, [(0, 2, 1), *(t for rung in rungs for t in rung)]


def holds(z: Place, corners: Sequence[Place]) -> bool:
    """Whether a counterclockwise triangle does, closed."""
    (zx, zy), ends = z, [*zip(corners, [*corners[1:], corners[0]], strict=True)]
    return all((qx - px) * (zy - py) >= (qy - py) * (zx - px) for (px, py), (qx, qy) in ends)


def meshes(holes: bool) -> Iterator[tuple[FloatArray, list[Triangle]]]:
    """Delaunay triangulations of flat clouds of a lattice, and with triangles taken away."""
    for seed in range(4):
        rng = np.random.default_rng(seed)
        points = np.unique(rng.integers(0, 12, (30, 2)), axis=0).astype(np.float64)
        points = points[rng.permutation(len(points))]
        triangles = [(int(a), int(b), int(c)) for a, b, c in delaunay(points).triangles]
        yield points, [t for t in triangles if not holes or rng.random() < 0.7]


@pytest.mark.obligation(
    "V1", "a walk ends in a triangle that holds the circumcentre", method="differential", control_in="mutants"
)
class TestWalk:
    """Where the walk ends the circumcentre is; in a Delaunay triangulation of a convex region it finds every one that
    is inside."""

    @pytest.mark.parametrize("holes", [False, True])
    def test_against_fractions(self, holes: bool) -> None:
        outside = elsewhere = 0
        for points, triangles in meshes(holes):
            mesh, links = linked_mesh(points, triangles)
            across = across_of(mesh, links)
            exact = oracles.rationals(points.tolist())
            solid = [[exact[v] for v in t] for t in triangles]
            found = np.zeros(len(triangles), dtype=np.bool_)
            every = np.arange(len(triangles), dtype=np.int32)
            centres.find_centres(mesh.context, mesh.coordinates, mesh.triangles, across, every[::-1], found)
            for t, corners in enumerate(solid):
                z = oracles.circumcircle(*corners)[0]
                row = centres.walk_to_centre(mesh.context, mesh.coordinates, mesh.triangles, across, t)
                assert found[len(triangles) - 1 - t] == (row >= 0)
                inside = any(holds(z, other) for other in solid)
                assert row == -1 or holds(z, solid[row])
                assert row >= 0 if inside and not holes else inside or row == -1
                outside += not inside
                elsewhere += row not in (-1, t)
        assert min(outside, elsewhere) > 3

    def test_whatever_the_numbers(self) -> None:
        """Each triangle in turn is the first one: where walks begin, lead through and end."""
        points, triangles = next(meshes(holes=False))
        lengths = set[int]()
        for first in range(len(triangles)):
            mesh, links = linked_mesh(points, [*triangles[first:], *triangles[:first]])
            across = across_of(mesh, links)
            every = np.arange(len(triangles), dtype=np.int32)
            found = np.zeros(len(triangles), dtype=np.bool_)
            centres.find_centres(mesh.context, mesh.coordinates, mesh.triangles, across, every, found)
            lengths.add(int(found.sum()))
        assert len(lengths) == 1

    @pytest.mark.parametrize(("height", "inside"), [(600, True), (540, False)])
    def test_too_far_away(self, height: int, inside: bool) -> None:
        """A walk of more than a thousand triangles is given up, and rationals tell where the circumcentre is."""
        points, triangles = ladder(height)
        mesh, links = linked_mesh(np.array(points), triangles)
        across = across_of(mesh, links)
        assert centres.walk_to_centre(mesh.context, mesh.coordinates, mesh.triangles, across, 0) == -1
        finding = verify(points, triangles, claims=["circumcentres-inside"]).findings[Property.CIRCUMCENTRES_INSIDE]
        assert [v.triangles for v in finding.violations] == ([] if inside else [(0,)])

    def test_control_not_too_far_away(self) -> None:
        """A ladder that is shorter: the walk ends where the circumcentre is."""
        points, triangles = ladder(450, 400)
        mesh, links = linked_mesh(np.array(points), triangles)
        row = centres.walk_to_centre(mesh.context, mesh.coordinates, mesh.triangles, across_of(mesh, links), 0)
        exact = oracles.rationals(points)
        centre = oracles.circumcircle(*(exact[v] for v in triangles[0]))[0]
        assert holds(centre, [exact[v] for v in triangles[row]])


@pytest.mark.obligation("V1", "a position is located in the union exactly", method="differential")
class TestOutline:
    """On the closed union or not, for positions of a lattice, between its lines, on edges and corners, and far away."""

    @pytest.mark.parametrize("holes", [False, True])
    def test_against_triangles(self, holes: bool) -> None:
        for points, triangles in meshes(holes):
            mesh, links = linked_mesh(points, triangles)
            outline = Outline(mesh.points, boundary_of(links))
            exact = oracles.rationals(points.tolist())
            solid = [[exact[v] for v in t] for t in triangles]
            six = [[(int(6 * x), int(6 * y)) for x, y in corners] for corners in solid]
            on = [((p[0] + q[0]) // 2, (p[1] + q[1]) // 2) for corners in six for p in corners for q in corners]
            random = Random(len(points))
            near = [(random.randrange(-9, 81), 3 * random.randrange(-3, 27)) for _ in range(120)]
            for x, y in {*on, *near, *((y, x) for x, y in near)}:
                assert outline.holds((mpq(x, 6), mpq(y, 6))) == any(holds((x, y), corners) for corners in six), (x, y)
            far = [(10**400, 1), (5, -(10**400)), (3, 10**400)]
            assert not any(outline.holds((mpq(x), mpq(y))) for x, y in far)
            for i, j in points[:9].astype(int).tolist():
                beside = (i + Fraction(1, 2**70), Fraction(j))
                assert outline.holds((mpq(i) + mpq(1, 2**70), mpq(j))) == any(holds(beside, c) for c in solid)

    def test_strips(self) -> None:
        """Every edge is listed in each of the strips that it reaches into, and in no other."""
        for points, triangles in meshes(True):
            mesh, links = linked_mesh(points, triangles)
            outline = Outline(mesh.points, boundary_of(links))
            cuts = [-math.inf, *outline.cuts.tolist(), math.inf]
            assert cuts == sorted(set(cuts))
            for strip, (west, east) in enumerate(pairwise(cuts)):
                listed = outline.edges[outline.begin[strip] : outline.begin[strip + 1]].tolist()
                reach = [
                    e for e in range(len(outline.left)) if outline.left[e, 0] < east and outline.right[e, 0] >= west
                ]
                assert listed == reach

    def test_beside_corners(self) -> None:
        """Less than half an ulp away, so that the nearest double is the corner's; a cut is at the next one."""
        x, right = 1.1, math.nextafter(1.1, 2)
        points = np.array(
            [(-10.0, -2.1), (x, -2.1), (4.0, -1.9), (0.0, 10.0), (right, 100.0), (20.0, 100.0), (5.0, 110.0)]
        )
        triangles = [(0, 1, 3), (1, 2, 3), (4, 5, 6)]
        mesh, links = linked_mesh(points, triangles)
        outline, exact = Outline(mesh.points, boundary_of(links)), oracles.rationals(points.tolist())
        assert right in outline.cuts
        tiny = Fraction(1, 2**80)
        for (px, py), i, j in product(exact, (-1, 0, 1), (-1, 0, 1)):
            z = px + i * tiny, py + j * tiny
            expected = any(holds(z, [exact[v] for v in t]) for t in triangles)
            assert outline.holds((mpq(z[0]), mpq(z[1]))) == expected, z

    @pytest.mark.parametrize("value", [0.0, 1.5, -0.1, 1e308, -5e-324])
    def test_between(self, value: float) -> None:
        """The double itself, or those next to it; infinity above all."""
        below, above = math.nextafter(value, -math.inf), math.nextafter(value, math.inf)
        assert centres._between(mpq(value)) == (value, value)
        for part in (mpq(1, 3), mpq(2, 3)):
            between = mpq(value) + part * (mpq(above) - mpq(value))
            low, high = centres._between(between)
            assert below <= low <= value <= above <= high
            assert mpq(low) < between < mpq(high)

    @pytest.mark.parametrize("sign", [1, -1])
    def test_control_beyond_all_doubles(self, sign: int) -> None:
        """Rationals that no double is near to."""
        largest = 1.7976931348623157e308
        for value in (mpq(10**400), mpq(2**1024), mpq(largest) + 2**970):
            low, high = centres._between(sign * value)
            assert sorted((sign * low, sign * high)) == [largest, math.inf]
        assert centres._between(sign * mpq(largest)) == (sign * largest, sign * largest)


@pytest.mark.obligation(
    "V1", "centres outside are told with their triangles", method="named cases", control_in="mutants"
)
class TestMessages:
    """A row of obtuse triangles: each is told, the first hundred in words, in pieces of any size."""

    @pytest.mark.parametrize("chunk", [1, 7, 1 << 14])
    def test_a_row(self, chunk: int, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(centres, "_CHUNK", chunk)
        n = 103
        points = [(float(x), y) for i in range(n) for x, y in ((8 * i, 0.0), (8 * i + 4, 0.0), (8 * i + 2, 1.0))]
        triangles = [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(n)]
        finding = verify(points, triangles, claims=["circumcentres-inside"]).findings[Property.CIRCUMCENTRES_INSIDE]
        assert (finding.count, len(finding.violations)) == (n, 100)
        assert [v.triangles for v in finding.violations] == [(i,) for i in range(100)]
        last = finding.violations[99]
        assert (last.kind, last.vertices) == (Kind.CENTRE_OUTSIDE, (297, 298, 299))
        assert "the circumcentre (794, -1.5) of triangle 99 = 297 (792.0, 0.0)" in last.message
        acute = [(x, 3 * y) for x, y in points]
        assert verify(acute, triangles, claims=["circumcentres-inside"]).ok

    def test_rounded_down(self) -> None:
        """A centre between two doubles is shown as the lower one, to six digits; here these differ."""
        tie = mpq(1000005, 1000000)
        low, high = centres._between(tie)
        assert (f"{low:.6g}", f"{high:.6g}") == ("1", "1.00001")
        assert centres._shown((tie, -tie)) == "(1, -1.00001)"

    def test_no_area(self) -> None:
        points = [(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (0.0, 1.0)]
        finding = verify(points, [(0, 2, 3), (0, 1, 2)], claims=["circumcentres-inside"]).findings[
            Property.CIRCUMCENTRES_INSIDE
        ]
        (violation,) = finding.violations
        assert (violation.kind, violation.triangles, violation.vertices) == (Kind.ZERO_AREA, (1,), (0, 1, 2))
        assert finding.lower_bound
        assert violation.message.startswith("triangle 1 = 0 (0.0, 0.0), 1 (1.0, 1.0), 2 (2.0, 2.0) has no area")

    def test_nothing(self) -> None:
        assert verify([(0, 0), (1, 0)], [], claims=["circumcentres-inside"]).ok
