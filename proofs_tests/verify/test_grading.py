"""V1 for the passes that grade violations, each alone: side of the threshold, and order, in fractions."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import permutations
from random import Random

import numpy as np
import numpy.typing as npt
import pytest
from proofs_tests import oracles
from proofs_tests.oracles import RationalPoint

from exactkernel.angle import AngleBound
from exactkernel.constants import INCIRCLE_BOUND, LARGEST_WEIGHT, ORIENT2D_BOUND, SMALLEST_WEIGHT
from exactkernel.shape import angle_bound
from exactkernel.types import FloatArray
from exactmesh import delaunay
from exactmesh.verify import Severity, grading, severity
from exactmesh.verify.links import INNER, linked
from exactmesh.verify.local import localized
from exactmesh.verify.mesh import index_quads, index_triples, prepared_mesh
from exactmesh.verify.severity import MEASURE_BOUND, RESOLVED, ROUNDING_SIZED, UNKNOWN
from exactmesh.verify.witness import IndexArray

Terms = tuple[Fraction, Fraction]
#: Writes grades and excesses of rows of a table of points.
Pass = Callable[[FloatArray, IndexArray, npt.NDArray[np.int8], FloatArray], None]
#: The value and the weight of a few corners, and the measure of its size, squared where that is a root.
CASES = 100
SMALL = (1.0, 2.0**-20)


def side_of(terms: Terms, bound: float) -> int:
    return RESOLVED if abs(terms[0]) > Fraction(bound) * terms[1] else ROUNDING_SIZED


def graded(pass_: Pass, points: FloatArray, rows: npt.ArrayLike) -> tuple[list[int], list[float]]:
    """What a pass writes about rows, whatever stood there."""
    table = np.array(rows, dtype=np.intp)
    grades, excess = np.full(len(table), 77, dtype=np.int8), np.full(len(table), 7e77)
    with np.errstate(divide="raise", invalid="raise"):
        pass_(points, table, grades, excess)
    return grades.tolist(), excess.tolist()


def is_near(value: float, exact: Fraction) -> bool:
    """Agreement to ten digits, of numbers that sort violations and decide nothing."""
    return abs(Fraction(value) - exact) <= abs(exact) / 10**10


def root(value: Fraction) -> Fraction:
    return Fraction(math.isqrt(value.numerator * 4**200 // value.denominator), 2**200)


def circle_terms(a: RationalPoint, b: RationalPoint, c: RationalPoint, d: RationalPoint) -> Terms:
    """The determinant by the power of d, the permanent by distances."""
    (dx, dy), near = d, (a, b, c)
    value = permanent = Fraction(0)
    for p, q, r in (near, (b, c, a), (c, a, b)):
        value += oracles.squared_distance(p, d) * oracles.orient(d, q, r)
        cross = abs((q[0] - dx) * (r[1] - dy)) + abs((q[1] - dy) * (r[0] - dx))
        permanent += oracles.squared_distance(p, d) * cross
    return value, permanent


def diametral_terms(a: RationalPoint, b: RationalPoint, p: RationalPoint) -> Terms:
    products = [(p[i] - a[i]) * (b[i] - p[i]) for i in range(2)]
    return sum(products, Fraction(0)), sum(map(abs, products), Fraction(0))


def tilted(random: Random, corners: Sequence[tuple[int, int]]) -> FloatArray:
    """Lattice points turned, moved and rounded, and some of them moved by a few units in the last place."""
    angle, x, y = random.random() * 7, random.choice((0.0, 50.0, -900.0)), random.random()
    c, s = math.cos(angle), math.sin(angle)
    points = np.array([(c * p - s * q + x, s * p + c * q + y) for p, q in corners])
    for _ in range(random.randrange(3)):
        i, axis = random.randrange(len(corners)), random.randrange(2)
        points[i, axis] += random.randrange(-9, 10) * np.spacing(points[i, axis])
    return points


def turned(random: Random, corners: FloatArray) -> FloatArray:
    order = [*range(len(corners))]
    random.shuffle(order)
    return corners[order]


TRIANGLES = np.array([(2, 2, 2), (0, 1, 2)], dtype=np.int32)


def angles_pass(bound: AngleBound, sign: int) -> Pass:
    def pass_(points: FloatArray, rows: IndexArray, grades: npt.NDArray[np.int8], excess: FloatArray) -> None:
        grading.grade_angles(bound, sign, points, TRIANGLES, rows, grades, excess)

    return pass_


def lengths_pass(limit: float) -> Pass:
    limits = np.array([7.0, limit])

    def pass_(points: FloatArray, rows: IndexArray, grades: npt.NDArray[np.int8], excess: FloatArray) -> None:
        grading.grade_lengths(limits, points, TRIANGLES, rows, grades, excess)

    return pass_


def areas_pass(limit: float) -> Pass:
    limits = np.array([7.0, limit])

    def pass_(points: FloatArray, rows: IndexArray, grades: npt.NDArray[np.int8], excess: FloatArray) -> None:
        grading.grade_areas(limits, points, TRIANGLES, rows, grades, excess)

    return pass_


@pytest.mark.obligation("V1", "a value is graded by the side of the threshold that it is on", method="named cases")
class TestGrade:
    """Beyond a 2^-40th of the threshold the side is told, within it nothing, nor outside of the window of weights."""

    @pytest.mark.parametrize("bound", [ORIENT2D_BOUND, INCIRCLE_BOUND, 0.5])
    @pytest.mark.parametrize("weight", [1.0, 3.7, SMALLEST_WEIGHT, LARGEST_WEIGHT])
    def test_sides(self, bound: float, weight: float) -> None:
        threshold, step = bound * weight, 2.0**-40
        for part, side in (
            (0.0, ROUNDING_SIZED), (0.5, ROUNDING_SIZED), (1 - 1.5 * step, ROUNDING_SIZED), (1 - 0.75 * step, UNKNOWN),
            (1.0, UNKNOWN), (1 + 0.75 * step, UNKNOWN), (1 + 1.5 * step, RESOLVED), (2.0, RESOLVED),
        ):  # fmt: skip
            assert grading.grade(threshold * part, weight, bound) == side, part
        for part in (1 - step, 1 + step):
            assert grading.grade(threshold * part, weight, bound) == UNKNOWN, part

    @pytest.mark.parametrize("scale", [0.0, 2.0**-900, 2.0**995, math.inf, math.nan])
    def test_control_outside_of_the_window(self, scale: float) -> None:
        """A weight that no margin is proven for: nothing is told, be the value large or small."""
        for value in (0.0, scale, 2.0**1023):
            assert grading.grade(value, scale, 0.5) == UNKNOWN
        for weight in (math.nextafter(SMALLEST_WEIGHT, 0), math.nextafter(LARGEST_WEIGHT, math.inf)):
            assert grading.grade(weight, weight, 0.5) == UNKNOWN


@pytest.mark.obligation(
    "V1", "each pass grades and measures as fractions do", method="differential", control_in="mutants"
)
class TestPasses:
    """Where a pass knows the side it is that of the fractions, nearly always it knows, and its measure is the true one:
    of circles, right angles, areas, lengths and angles a few units in the last place from equality, and far from it."""

    @pytest.mark.parametrize("seed", range(4))
    def test_circles(self, seed: int) -> None:
        random, sides = Random(seed), list[int]()
        ring = [(5, 0), (3, 4), (-3, 4), (4, -3), (0, -5), (-4, 3), (-5, 0), (0, 5)]
        for _ in range(CASES):
            points = tilted(random, random.sample(ring, 4)) * SMALL[seed % 2]
            if random.random() < 0.2:
                points[random.randrange(4)] += random.random()
            (grade,), (excess,) = graded(grading.grade_circles, points, [[0, 1, 2, 3]])
            a, b, c, d = oracles.rationals(points.tolist())
            terms = circle_terms(a, b, c, d)
            assert grade == side_of(terms, INCIRCLE_BOUND)
            assert is_near(excess, abs(terms[0]) / terms[1])
            assert severity.circle_terms(points, [0, 1, 2], 3) == terms
            sides.append(grade)
        assert {*sides} == {RESOLVED, ROUNDING_SIZED}

    @pytest.mark.parametrize("seed", range(4))
    def test_diametral(self, seed: int) -> None:
        random, sides = Random(seed), list[int]()
        for _ in range(CASES):
            points = tilted(random, [(-5, 0), random.choice(((5, 0), (5, 1))), (3, 4)])
            (grade,), (excess,) = graded(grading.grade_diametral, points, [[0, 1, 2]])
            a, b, p = oracles.rationals(points.tolist())
            terms = diametral_terms(a, b, p)
            assert grade == side_of(terms, ORIENT2D_BOUND)
            squares = oracles.squared_distance(a, p) * oracles.squared_distance(b, p)
            assert is_near(excess, abs(terms[0]) / root(squares))
            assert severity.diametral_terms(points, 0, 1, 2) == terms
            sides.append(grade)
        assert {*sides} == {RESOLVED, ROUNDING_SIZED}

    @pytest.mark.parametrize("seed", range(4))
    def test_areas(self, seed: int) -> None:
        random, sides = Random(seed), list[int]()
        for _ in range(CASES):
            points = tilted(random, [(0, 0), (4, 1), (1, 4)]) * SMALL[seed % 2]
            limit = (
                7.5 * random.choice((1, 1, 1, 0.9)) * (1 - random.randrange(0, 40) * 2.0**-52) * SMALL[seed % 2] ** 2
            )
            (grade,), (excess,) = graded(areas_pass(limit), points, [1])
            a, b, c = oracles.rationals(points.tolist())
            products = (b[0] - a[0]) * (c[1] - a[1]), (b[1] - a[1]) * (c[0] - a[0])
            twice = 2 * Fraction(limit)
            terms = products[0] - products[1] - twice, abs(products[0]) + abs(products[1]) + twice
            if terms[0] > 0:
                assert grade == side_of(terms, MEASURE_BOUND)
            assert is_near(excess, (products[0] - products[1]) / twice)
            assert severity.area_terms(points, [0, 1, 2], limit) == terms
            sides.append(grade)
        assert {*sides} >= {RESOLVED, ROUNDING_SIZED}

    @pytest.mark.parametrize("seed", range(4))
    def test_lengths(self, seed: int) -> None:
        random, sides = Random(seed), list[int]()
        for _ in range(CASES):
            points = turned(random, tilted(random, [(0, 0), (3, 4), (random.choice((3, 0)), 0)]))
            limit = random.choice((5.0, 5.0, 3.0)) * (1 + random.randrange(-16, 1) * 2.0**-52)
            (grade,), (excess,) = graded(lengths_pass(limit), points, [1])
            exact, squared = oracles.rationals(points.tolist()), Fraction(limit) ** 2
            squares = [oracles.squared_distance(exact[i - 1], exact[i]) for i in range(3)]
            wrong = any(s - squared > Fraction(MEASURE_BOUND) * (s + squared) for s in squares)
            assert grade == (RESOLVED if wrong else ROUNDING_SIZED)
            assert is_near(excess, max(squares) / squared)
            said = severity.length_severity(points, [0, 1, 2], limit)
            assert said is (Severity.WRONG if wrong else Severity.ROUNDING)
            sides.append(grade)
        assert {*sides} == {RESOLVED, ROUNDING_SIZED}

    @pytest.mark.parametrize(("degrees", "least"), [(45.0, True), (90.0, False), (20.0, True), (135.0, False)])
    def test_angles(self, degrees: float, least: bool) -> None:
        random, sides = Random(degrees), list[int]()
        bound = severity.plain_angle(angle_bound(degrees))
        shapes = [[(0, 0), (2, 0), (0, 2)], [(0, 0), (3, 0), (-1, 1)], [(0, 0), (7, 1), (1, 8)]]
        for i in range(2 * CASES):
            points = turned(random, tilted(random, shapes[i % 3])) * SMALL[i % 2]
            exact, sign = oracles.rationals(points.tolist()), 1 if least else -1
            if oracles.orient(exact[0], exact[1], exact[2]) < 0:
                points, exact = points[::-1].copy(), exact[::-1]
            (grade,), (excess,) = graded(angles_pass(bound, sign), points, [1])
            wrong, cosines = False, list[Fraction]()
            for j in range(3):
                a, b, c = exact[j], exact[j - 2], exact[j - 1]
                (ux, uy), (vx, vy) = ((q[0] - a[0], q[1] - a[1]) for q in (b, c))
                dot, cross = ux * vx + uy * vy, ux * vy - uy * vx
                s, co = Fraction(bound.sine), Fraction(bound.cosine)
                weight = s * (abs(ux * vx) + abs(uy * vy)) + abs(co) * (abs(ux * vy) + abs(uy * vx))
                wrong |= sign * (s * dot - co * cross) > Fraction(MEASURE_BOUND) * weight
                cosines.append(sign * dot / root(oracles.squared_distance(a, b) * oracles.squared_distance(a, c)))
            assert grade == (RESOLVED if wrong else ROUNDING_SIZED)
            assert abs(Fraction(excess) - max(cosines)) < Fraction(1, 10**10)
            said = severity.angle_severity(points, [0, 1, 2], angle_bound(degrees), least=least)
            assert said is (Severity.WRONG if wrong else Severity.ROUNDING)
            sides.append(grade)
        assert {*sides} == {RESOLVED, ROUNDING_SIZED}


@pytest.mark.obligation(
    "V1", "areas and lengths are graded by all of their digits", method="property-based", control_in="mutants"
)
class TestTails:
    """A value beside the border, by less than a unit of what cancels in it or is rounded off its bound, is graded as
    fractions grade it."""

    def test_areas(self) -> None:
        """Of thin triangles: the two products of the area are far larger than itself, and round off as much."""
        random, bound = Random(1), Fraction(MEASURE_BOUND)
        for i in range(CASES):
            ux, uy, t = (random.uniform(1, 2) for _ in range(3))
            points = np.array([(0.0, 0.0), (ux, uy), (ux * t, uy * t + 2.0**-45)])
            left, right = (Fraction(ux) * Fraction(points[2, 1]), Fraction(uy) * Fraction(points[2, 0]))
            aimed = (bound + Fraction((-1) ** i, 2**60)) * (left + right)
            limit = float((left - right - aimed) / (2 * (1 + bound)))
            terms = left - right - 2 * Fraction(limit), left + right + 2 * Fraction(limit)
            (grade,), _ = graded(areas_pass(limit), points, [1])
            assert grade == side_of(terms, MEASURE_BOUND) == (ROUNDING_SIZED if i % 2 else RESOLVED)

    def test_lengths(self) -> None:
        """Of bounds whose squares are no doubles."""
        random, bound = Random(2), Fraction(MEASURE_BOUND)
        for i in range(CASES):
            limit = random.uniform(1, 2)
            y = limit * math.sqrt(2 * MEASURE_BOUND * (1 + (-1) ** i * 2.0**-8))
            points = np.array([(0.0, 0.0), (limit, y), (0.5, 0.25)])
            squares = Fraction(limit) ** 2 + Fraction(y) ** 2, Fraction(limit) ** 2
            (grade,), _ = graded(lengths_pass(limit), points, [1])
            beyond = squares[0] - squares[1] > bound * (squares[0] + squares[1])
            assert grade == (RESOLVED if beyond else ROUNDING_SIZED) == (ROUNDING_SIZED if i % 2 else RESOLVED)


@pytest.mark.obligation("V1", "a triangle is as wrong as its worst part", method="named cases", control_in="mutants")
class TestWorstPart:
    """Of three edges or angles one that is wrong makes the triangle wrong; without any, one that double-doubles cannot
    tell leaves it to rationals: in every order."""

    @pytest.mark.parametrize("order", [*permutations(range(3))])
    def test_lengths(self, order: tuple[int, int, int]) -> None:
        bound = Fraction(MEASURE_BOUND)
        beside = math.sqrt(2 * bound / (1 - bound))  # an edge (1, beside) is on the threshold of 1, to 50 bits
        short, equal, long = (0.5, 0.25), (1.0, beside), (1.0, 3 * beside)
        for end, side in ((short, ROUNDING_SIZED), (equal, UNKNOWN), (long, RESOLVED)):
            points = np.array([(0.0, 0.0), end, (0.5, 0.0)])[[*order]]
            (grade,), _ = graded(lengths_pass(1.0), points, [1])
            assert grade == side
        for other, side in ((equal, UNKNOWN), (long, RESOLVED)):
            points = np.array([(0.0, 0.0), equal, (other[0], -other[1])])[[*order]]
            (grade,), _ = graded(lengths_pass(1.0), points, [1])
            assert grade == side

    @pytest.mark.parametrize("order", [*permutations(range(3))])
    def test_angles(self, order: tuple[int, int, int]) -> None:
        """Two corners at one place have no angle, and are left to rationals; the third has one of nothing."""
        points = np.array([(0.0, 0.0), (0.0, 0.0), (1.0, 2.0)])[[*order]]
        for degrees, sign, side in ((30.0, 1, RESOLVED), (30.0, -1, UNKNOWN)):
            (grade,), (excess,) = graded(angles_pass(severity.plain_angle(angle_bound(degrees)), sign), points, [1])
            assert grade == side
            assert math.isclose(excess, sign, rel_tol=1e-10)

    def test_nothing_to_measure_by(self) -> None:
        """Measures that would be divided by nothing are defined all the same."""
        flat = np.zeros((4, 2))
        assert graded(grading.grade_circles, flat, [[0, 1, 2, 3]]) == ([UNKNOWN], [0.0])
        assert graded(grading.grade_diametral, flat, [[0, 1, 2]]) == ([UNKNOWN], [0.0])
        for sign in (1, -1):
            assert graded(angles_pass(severity.plain_angle(angle_bound(30.0)), sign), flat, [1]) == ([UNKNOWN], [-1.0])
        assert graded(lengths_pass(1e-200), np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), [1])[1] == [math.inf]
        assert graded(areas_pass(0.0), np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]), [1])[1] == [math.inf]

    def test_empty(self) -> None:
        """Lengths of nothing: as near to any limit as 0 is to 1."""
        assert graded(lengths_pass(1.0), np.zeros((3, 2)), [1]) == ([ROUNDING_SIZED], [0.0])


@pytest.mark.obligation(
    "V1",
    "violations are ranked by size, what doubles leave open by fractions",
    method="named cases",
    control_in="mutants",
)
class TestRanked:
    """Wrong ones come first, the larger before the smaller, ties by position; what is unknown is asked for, once."""

    def test_order(self) -> None:
        for grades in ([0, 1, 2, 1, 2, 0], [2] * 6, [1, 1, 0, 0, 1, 1]):
            for excess in ([1.0, 5.0, 3.0, 5.0, 3.0, 2.0], [0.0] * 6):
                asked, known = list[int](), np.array(grades, dtype=np.int8)

                def decide(i: int, asked: list[int] = asked) -> Severity:
                    asked.append(i)
                    return Severity.ROUNDING if i % 4 else Severity.WRONG

                found = severity.ranked(known, np.array(excess), decide)
                small = [grade == 0 or (grade == 2 and i % 4 != 0) for i, grade in enumerate(grades)]
                assert asked == [i for i, grade in enumerate(grades) if grade == 2]
                assert found.rounding == sum(small)
                assert found.order.tolist() == sorted(range(6), key=lambda i: (small[i], -excess[i], i))

    def test_by_size(self) -> None:
        """Triangles that are all wrong, ranked by how much; in coordinates that nothing is proven for, by position."""
        rng = np.random.default_rng(4)
        points = rng.random((60, 2))
        rows = np.arange(60, dtype=np.int32).reshape(-1, 3)
        exact = oracles.rationals(points.tolist())
        turn = np.array([oracles.orient(*(exact[v] for v in t)) < 0 for t in rows.tolist()])
        rows[turn] = rows[turn][:, ::-1]
        mesh, _ = prepared_mesh(points, index_triples(rows), index_quads(()), np.empty((0, 2)))
        beyond = replace(mesh, context=mesh.context._replace(orient2d_bound=math.inf, incircle_bound=math.inf))
        every, limits, sizes = np.arange(20), np.full(20, 1e-9), list[list[float]]()
        for t in rows.tolist():
            sides = [math.dist(points[t[i]], points[t[i - 1]]) for i in range(3)]
            area = float(abs(oracles.orient(*(exact[v] for v in t))))
            a, b, c = sorted(sides)
            angles = [math.acos((x * x + y * y - z * z) / (2 * x * y)) for x, y, z in ((b, c, a), (a, b, c))]
            sizes.append([area, max(sides), -angles[0], angles[1]])
        least, most = angle_bound(179.0), angle_bound(0.001)
        for m in (mesh, beyond):
            k, corners = m.context, rows.astype(np.intp)
            rankings = [
                grading.rank_areas(points, k, rows, every, limits),
                grading.rank_lengths(points, k, rows, every, limits),
                grading.rank_angles(m, rows, every, least, least=True),
                grading.rank_angles(m, rows, every, most, least=False),
            ]
            for i, ranking in enumerate(rankings):
                assert ranking.rounding == 0
                by_size = sorted(range(20), key=lambda t, i=i: -sizes[t][i])  # type: ignore[misc]  # a default
                assert ranking.order.tolist() == (by_size if m is mesh else [*range(20)])
            cosines = [-(points[a] - points[c]) @ (points[b] - points[c]) for a, b, c in corners]
            lengths = [math.dist(points[a], points[c]) * math.dist(points[b], points[c]) for a, b, c in corners]
            by_cosine = sorted(range(20), key=lambda t: -abs(cosines[t] / lengths[t]))
            assert grading.rank_diametral(m, corners).order.tolist() == (by_cosine if m is mesh else [*range(20)])

    def test_equality_is_rounding(self) -> None:
        for sign in (1, -1):
            assert severity.severity_of((Fraction(sign, 2), Fraction(1)), 0.5) is Severity.ROUNDING
            assert severity.severity_of((Fraction(sign * 51, 100), Fraction(1)), 0.5) is Severity.WRONG

    def test_plain_angle(self) -> None:
        for degrees in (30.0, 45.0, 120.0):
            bound = angle_bound(degrees)
            plain = severity.plain_angle(bound)
            assert (plain.sine, plain.cosine) == (bound.sine, bound.cosine)
            assert (plain.sine_tail, plain.cosine_tail) == (0.0, 0.0)
            assert math.isclose(math.degrees(math.atan2(plain.sine, plain.cosine)), degrees)
        tiny = severity.plain_angle(angle_bound(1e-320))
        assert (tiny.sine, tiny.sine_tail, tiny.cosine, tiny.cosine_tail) == (0.0, 0.0, 1.0, 0.0)


@pytest.mark.obligation(
    "V1", "the corner across an edge is that of its other triangle", method="named cases", control_in="mutants"
)
class TestFarCorners:
    """For every inner edge of a mesh the row names its two triangles' third corners, the near one and the far one."""

    def test_every_edge(self) -> None:
        points = np.random.default_rng(1).random((40, 2))
        triangles = delaunay(points).triangles
        mesh, _ = prepared_mesh(points, index_triples(triangles), index_quads(()), np.empty((0, 2)))
        links = linked(len(points), mesh.context, localized(mesh.coordinates, mesh.triangles, mesh.quads))
        third = {(t[i], t[i - 2]): t[i - 1] for t in triangles.tolist() for i in range(3)}
        inner = np.flatnonzero(links.kinds == INNER)
        corners, ranking = grading.rank_circles(mesh, links, inner)
        assert ranking.rounding == 0
        terms = [circle_terms(*oracles.rationals(points[row].tolist())) for row in corners]
        sizes = [abs(value) / permanent for value, permanent in terms]
        assert ranking.order.tolist() == sorted(range(len(inner)), key=lambda i: -sizes[i])[:100]
        beyond = replace(mesh, context=mesh.context._replace(incircle_bound=math.inf))
        assert grading.rank_circles(beyond, links, inner)[1].order.tolist() == [*range(len(inner))][:100]
        assert sorted(map(tuple, corners.tolist())) == sorted(
            (v, b, c, third[b, v]) for (v, b), c in third.items() if (b, v) in third
        )
