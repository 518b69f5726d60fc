"""V1 for the words and numbers of witnesses: determinants, names, rows of cells, and findings that are joined."""

from collections.abc import Sequence
from dataclasses import FrozenInstanceError
from fractions import Fraction
from itertools import combinations, islice, permutations, product
from random import Random

import numpy as np
import pytest
from proofs_tests import oracles

from exactmesh.verify import CheckedMesh, Finding, Kind, Property, Severity, Verdict, Violation, verify
from exactmesh.verify.report import WITNESSES
from exactmesh.verify.witness import (
    approximately,
    joined,
    places_of,
    rows_at_vertices,
    rows_of_triangles,
    scalar_product,
    sign_of,
    squared_length,
    twice_area,
)

Cell = tuple[int, ...]


@pytest.mark.obligation(
    "V1", "what a witness says of a magnitude is exact", method="property-based", control_in="mutants"
)
class TestMagnitudes:
    """The determinants of witnesses are those of fractions: signs, areas, lengths; the scalar product by the law of
    cosines, 2 (p - a) . (b - p) = |ab|^2 - |ap|^2 - |pb|^2."""

    def test_signs(self) -> None:
        for value in (Fraction(0), Fraction(1), Fraction(5, 7), Fraction(1, 10**400)):
            assert sign_of(value) == (1 if value else 0)
            assert sign_of(-value) == (-1 if value else 0)

    @pytest.mark.parametrize("seed", range(5))
    def test_against_fractions(self, seed: int) -> None:
        random = Random(seed)
        points = np.array([[random.uniform(-3, 3) * 2.0 ** random.randrange(-60, 60) for _ in "xy"] for _ in range(5)])
        exact = oracles.rationals(points.tolist())
        for a, b, c in permutations(range(5), 3):
            assert twice_area(points, a, b, c) == oracles.orient(exact[a], exact[b], exact[c])
            ab, bc, ac = (oracles.squared_distance(exact[u], exact[v]) for u, v in ((a, b), (b, c), (a, c)))
            assert squared_length(points, a, b) == ab
            assert 2 * scalar_product(points, a, b, c) == ab - ac - bc

    def test_three_digits(self) -> None:
        """Of any exponent, a sign, and a fraction that no double is."""
        for value, text in (
            (Fraction(0), "0"),
            (Fraction(2, 3), "0.667"),
            (Fraction(-2, 3), "-0.667"),
            (Fraction(12, 5), "2.4"),
            (Fraction(5 * 10**399), "5.00e+399"),
            (Fraction(-7, 4 * 10**400), "-1.75e-400"),
        ):
            assert float(approximately(value)) == float(text)
            assert approximately(value).startswith(text[:4])


def listed_with(cells: Sequence[Cell], wanted: Cell) -> list[int]:
    """The rows of the cells that have these three corners, of quadrilaterals in a row: as any three of four are."""
    return [row for row, cell in enumerate(cells) if set(wanted) in map(set, combinations(cell, 3))]


def random_cells(random: Random, size: int, count: int, n: int) -> list[Cell]:
    return [tuple(random.sample(range(n), size)) for _ in range(count)]


def array(cells: Sequence[Cell], width: int) -> "np.typing.NDArray[np.int32]":
    return np.array(cells, dtype=np.int32).reshape(-1, width)


@pytest.mark.obligation("V1", "witnesses name the first ten rows of cells that counting finds", method="property-based")
class TestRows:
    """Rows of cells with given corners, and rows of cells at given vertices, are those of a naive search through
    triangles first and quadrilaterals after them, the first ten of them."""

    @pytest.mark.parametrize("seed", range(40))
    def test_any_cells(self, seed: int) -> None:
        random = Random(seed)
        n = random.choice((4, 5, 8))
        triangles = random_cells(random, 3, random.choice((0, 1, 9, 60)), n)
        quads = random_cells(random, 4, random.choice((0, 0, 1, 9, 30)), n)
        triples = random.sample(list(combinations(range(n), 3)), random.randint(1, 3))
        wanted: list[Cell] = [tuple(random.sample(corners, 3)) for corners in triples]
        rows = rows_of_triangles(array(triangles, 3), wanted, n, array(quads, 4))
        assert rows == [tuple(listed_with([*triangles, *quads], corners)[:10]) for corners in wanted]
        without = rows_of_triangles(array(triangles, 3), wanted, n)
        assert without == [tuple(listed_with(triangles, corners)[:10]) for corners in wanted]
        vertices = random.sample(range(n), random.randint(1, 3))
        found = rows_at_vertices(array(triangles, 3), np.array(vertices), n, array(quads, 4))
        cells = [*triangles, *quads]
        assert found == {v: tuple(row for row, cell in enumerate(cells) if v in cell)[:10] for v in vertices}

    def test_control_many(self) -> None:
        """More than ten copies: ten are named, and without the limit the naive search would name others as well."""
        triangles, quads = [(0, 1, 2)] * 8, [(3, 2, 1, 0)] * 8
        (rows,) = rows_of_triangles(array(triangles, 3), [(2, 1, 0)], 4, array(quads, 4))
        assert rows == tuple(range(10)) != tuple(listed_with([*triangles, *quads], (2, 1, 0)))
        assert rows_at_vertices(array(triangles, 3), np.array([2]), 4, array(quads, 4)) == {2: tuple(range(10))}

    def test_places(self) -> None:
        points = np.array([(0.5, 1.0), (2.0, -3.0), (4.0, 7.0)])
        assert places_of(points, [2, 0]) == ((4.0, 7.0), (0.5, 1.0))


def finding(severities: str, *, lower_bound: bool = False, start: int = 0) -> Finding:
    """FAILS with a violation for each letter, r rounding-sized and w wrong; HOLDS without any."""
    if not severities:
        return Finding(Verdict.HOLDS)
    violations = tuple(
        Violation(
            Property.DELAUNAY,
            Kind.POINT_IN_CIRCLE,
            (),
            (start + i,),
            "",
            severity=Severity.ROUNDING if letter == "r" else Severity.WRONG,
        )
        for i, letter in enumerate(severities)
    )
    return Finding(Verdict.FAILS, len(severities), violations[:WITNESSES], lower_bound, rounding=severities.count("r"))


@pytest.mark.obligation("V1", "findings are joined without loss", method="enumeration", control_in="mutants")
class TestJoined:
    """Of findings about several sorts of violations the joined one counts all, and as many rounding-sized; it tells
    wrong ones first, each sort in its order, a hundred at most; it is a lower bound if any part is, or it is said."""

    def test_every_pair(self) -> None:
        words = [*map("".join, (w for n in range(3) for w in product("rw", repeat=n))), "rwr", "w" * 99, "r" * 101]
        for first, second in product(words, repeat=2):
            for low, high, said in product((False, True), repeat=3):
                parts = finding(first, lower_bound=low), finding(second, lower_bound=high, start=1000)
                whole = joined(parts, lower_bound=True) if said else joined(parts)
                if not first + second:
                    assert whole == Finding(Verdict.HOLDS)
                    continue
                assert whole.verdict is Verdict.FAILS
                assert whole.count == len(first + second)
                assert whole.rounding == (first + second).count("r")
                assert whole.lower_bound is (said or (low and first != "") or (high and second != ""))
                told = [violation.vertices[0] for part in parts for violation in part.violations]
                letters = dict(zip(told, first[:WITNESSES] + second[:WITNESSES], strict=True))
                expected = [v for v in told if letters[v] == "w"] + [v for v in told if letters[v] == "r"]
                assert [violation.vertices[0] for violation in whole.violations] == expected[:WITNESSES]

    def test_control_a_part_left_out(self) -> None:
        """A finding without one of its parts: the count differs."""
        parts = finding("wr"), finding("r", start=1000)
        assert joined(parts).count != joined(parts[:1]).count
        assert joined(()) == Finding(Verdict.HOLDS)


@pytest.mark.obligation("V1", "a report knows what it is about", method="named cases", control_in="mutants")
class TestChecked:
    """What was checked cannot be exchanged in a report; it is equal to itself alone, whatever its arrays hold, can be
    hashed, and is short to print."""

    def test_a_report_s_mesh(self) -> None:
        points = np.array([(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)])
        mesh, other = (verify(points.copy(), [(0, 1, 2)]).mesh for _ in range(2))
        assert isinstance(mesh, CheckedMesh)
        assert isinstance(other, CheckedMesh)
        with pytest.raises(FrozenInstanceError):
            mesh.orientation = "any"  # type: ignore[misc]  # that is the question
        assert mesh == mesh  # that is the question
        assert mesh != other
        assert len({mesh, other, mesh}) == 2
        assert len(repr(mesh)) < 100
        assert mesh.quads.shape == (0, 4)

    def test_reports_that_say_the_same_are_equal(self) -> None:
        points = [(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)]
        one, two = (verify(points, [cell]) for cell in islice(permutations(range(3)), 2))
        assert one != two
        assert one == verify(points, [(0, 1, 2)])
