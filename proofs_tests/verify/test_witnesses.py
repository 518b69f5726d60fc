"""Witnesses are minimal: what a violation names is a violation by itself, and nothing can be left out of it."""

from collections.abc import Callable, Iterator
from fractions import Fraction
from random import Random
from typing import cast

import numpy as np
import numpy.typing as npt
import pytest
from proofs_tests import oracles
from proofs_tests.once import once_after
from proofs_tests.verify.test_verdicts import BruteForce

from exactmesh.verify import Finding, Kind, Orientation, Property, Report, Submesh, Verdict, Violation, verify
from exactmesh.verify.properties import LOCAL_PROPERTIES

Points = npt.NDArray[np.float64]
Cells = npt.NDArray[np.int64]

#: What brute force decides of triangles.
BY_BRUTE_FORCE = (
    *(Property.DISTINCT_POINTS, Property.ORIENTATION, Property.EDGE_MANIFOLD, Property.VERTEX_MANIFOLD),
    *(Property.ADMISSIBLE, Property.DELAUNAY, Property.WEAKLY_ACUTE, Property.ACUTE),
)
BOUNDS = {"min_angle": 30.0, "max_angle": 100.0, "max_area": 2.0}
ON_CLAIM = (Property.GABRIEL, Property.CIRCUMCENTRES_INSIDE)


verify_any = cast("Callable[..., Report]", verify)  # mypy finds no overload for a dictionary of bounds


def finding_on(part: Submesh, property_: Property, orientation: Orientation) -> Finding | None:
    """Ask the verifier about a part of a mesh; None: it has nothing to say."""
    bounds = {} if len(part.quads) else BOUNDS
    report = verify_any(
        part.points,
        part.triangles,
        quads=part.quads if len(part.quads) else None,
        segments=np.empty((0, 2), dtype=int) if property_ is Property.CONSTRAINED_DELAUNAY else None,
        claims=[property_] if property_ in ON_CLAIM else None,
        orientation=orientation,
        **bounds,
    )
    return report.findings.get(property_)


def without(part: Submesh, cell: int) -> Submesh:
    """Leave a cell out, and the points that are no corner any more."""
    m = len(part.triangles)
    triangles = np.delete(part.triangles, cell, axis=0) if cell < m else part.triangles
    quads = part.quads if cell < m else np.delete(part.quads, cell - m, axis=0)
    before = {*part.triangles.ravel().tolist(), *part.quads.ravel().tolist()}
    after = {*triangles.ravel().tolist(), *quads.ravel().tolist()}
    kept = [v for v in range(len(part.points)) if v in after or v not in before]
    number = {v: i for i, v in enumerate(kept)}

    def renumbered(cells: Cells) -> Cells:
        rows = [[number.get(v, v) for v in row] for row in cells.tolist()]
        return np.array(rows, dtype=np.int64).reshape(cells.shape)

    cells = tuple(row for i, row in enumerate(part.cells) if i != cell)
    indices = tuple(part.indices[v] for v in kept)
    return Submesh(part.points[kept], renumbered(triangles), renumbered(quads), indices, cells)


def faults(violation: Violation, orientation: Orientation) -> Iterator[str]:
    """Yield what is wrong with a witness, by the verifier and by brute force."""
    part, property_ = violation.submesh(), violation.property
    finding = finding_on(part, property_, orientation)
    if finding is None or violation.kind not in [other.kind for other in finding.violations]:
        yield f"{violation.message}: by itself {finding}"
    if contradicts(part, property_, orientation, holds=False):
        yield f"{violation.message}: nothing wrong by brute force"
    for cell in range(len(part.cells)):
        rest = without(part, cell)
        finding = finding_on(rest, property_, orientation)
        if finding is not None and finding.verdict is Verdict.FAILS:
            yield f"{violation.message}: cell {part.cells[cell]} can be left out"
        if contradicts(rest, property_, orientation, holds=True):
            yield f"{violation.message}: cell {part.cells[cell]} can be left out, by brute force"


def contradicts(part: Submesh, property_: Property, orientation: Orientation, *, holds: bool) -> bool:
    """Tell whether brute force, if it has something to say, says otherwise."""
    if property_ not in BY_BRUTE_FORCE or len(part.quads):
        return False
    triangles = [(a, b, c) for a, b, c in part.triangles.tolist()]
    if property_ is Property.DELAUNAY and not triangles:
        return False
    points: list[tuple[float, float]] = [(x, y) for x, y in part.points.tolist()]
    return BruteForce(points).verdicts(triangles, orientation)[property_] is not holds


def random_cells(random: Random) -> tuple[Points, Cells, Cells]:
    """Return points of a small grid, and cells from anywhere, some of them made counterclockwise."""
    n, side = random.randint(4, 10), random.choice((3, 9, 30))
    points = np.array([(random.randint(0, side), random.randint(0, side)) for _ in range(n)], dtype=np.float64)
    rows = {3: random.randint(0, 5), 4: random.choice((0, 0, 0, 1, 2))}
    triangles, quads = (
        np.array([random.sample(range(n), size) for _ in range(rows[size])], dtype=np.int64).reshape(-1, size)
        for size in (3, 4)
    )
    if random.random() < 0.7:
        exact = oracles.rationals([(x, y) for x, y in points.tolist()])
        turned = [oracles.counterclockwise(exact, (a, b, c)) for a, b, c in triangles.tolist()]
        triangles = np.array(turned, dtype=np.int64).reshape(-1, 3)
    return points, triangles, quads


@pytest.mark.obligation(
    "V3",
    "a witness is minimal: its cells violate the property by themselves, and without any one of them do not",
    method="differential",
)
class TestMinimal:
    """Law: for a local property the cells that a violation names violate it by themselves, in the same way, and without
    any one of them nothing is violated."""

    @pytest.mark.parametrize("seed", once_after(1, range(8)))
    def test_random_cells(self, seed: int) -> None:
        random, seen = Random(seed), set()
        for _ in range(25):
            points, triangles, quads = random_cells(random)
            orientation = random.choice(list(Orientation))
            pure = not len(quads)
            report = verify_any(
                points,
                triangles,
                quads=None if pure else quads,
                segments=np.empty((0, 2), dtype=int) if pure and random.random() < 0.5 else None,
                claims=list(ON_CLAIM) if pure else None,
                orientation=orientation,
                **(BOUNDS if pure else {}),
            )
            for violation in report.violations:
                if violation.is_local:
                    assert list(faults(violation, orientation)) == []
                    seen.add(violation.property)
        assert len(seen) > 8

    @pytest.mark.parametrize(
        ("points", "triangles", "kind", "cells"),
        [
            ([(0, 0), (9, 0), (0, 9), (2, 2), (3, 2), (2, 3)], [(0, 1, 2), (3, 4, 5)], Kind.OVERLAP, (0, 1)),
            ([(0, 0), (6, 0), (3, 6), (3, 0), (3, -6)], [(0, 1, 2), (0, 4, 3), (4, 1, 3)], Kind.HANGING_NODE, (0, 1)),
            ([(0, 0), (4, 0), (0, 4), (4, 0), (8, 0), (8, 4)], [(0, 1, 2), (3, 4, 5)], Kind.HANGING_NODE, (0, 1)),
            ([(0, 0), (4, 0), (0, 4), (1, 3), (-1, 1), (5, 1)], [(0, 1, 2), (4, 5, 3)], Kind.CROSSING, (0, 1)),
            ([(0, 0), (4, 0), (0, 4), (1, 1)], [(0, 1, 2), (0, 1, 3)], Kind.OVERLAP, (0, 1)),
        ],
    )
    def test_admissible(
        self, points: list[tuple[int, int]], triangles: list[tuple[int, int, int]], kind: Kind, cells: tuple[int, ...]
    ) -> None:
        """Far from each other in a longer list, the two are found again."""
        away = [(100 + 10 * i + x, y) for i in range(5) for x, y in ((0, 0), (4, 0), (0, 4))]
        others = [tuple(range(3 * i, 3 * i + 3)) for i in range(5)]
        shifted = [tuple(v + len(away) for v in row) for row in triangles]
        report = verify(away + points, others[:3] + shifted + others[3:])
        (violation, *_) = report.findings[Property.ADMISSIBLE].violations
        assert (violation.kind, violation.triangles) == (kind, tuple(3 + row for row in cells))
        assert list(faults(violation, Orientation.CCW)) == []

    def test_an_island_far_from_the_boundary(self) -> None:
        """The edge below an island that is covered twice belongs to a triangle far away from it, not to the pair."""
        grid = np.array([(x, y) for y in range(0, 80, 10) for x in range(0, 80, 10)], dtype=np.float64)
        corners = [8 * y + x for y in range(7) for x in range(7)]
        squares = [row for v in corners for row in ((v, v + 1, v + 9), (v, v + 9, v + 8))]
        island = [(33, 34), (36, 34), (34, 36)]
        report = verify([*grid.tolist(), *island], [*squares, (64, 65, 66)])
        (violation,) = report.findings[Property.ADMISSIBLE].violations
        assert violation.triangles in {(2 * (3 * 7 + 3), len(squares)), (2 * (3 * 7 + 3) + 1, len(squares))}
        assert list(faults(violation, Orientation.CCW)) == []

    def test_more_than_two_on_a_side(self) -> None:
        points = [(0, 0), (4, 0), (0, 4), (1, 4), (2, 4), (3, 4)]
        report = verify(points, [(0, 1, v) for v in (2, 3, 4, 5)])
        violation = report.findings[Property.EDGE_MANIFOLD].violations[0]
        assert violation.triangles == (0, 1)
        assert "0, 1 and 2 more" in violation.message
        assert list(faults(violation, Orientation.CCW)) == []

    def test_the_triangle_listed_the_other_way_is_not_named(self) -> None:
        """(0, 2, 1) has the corners of the others, but lists no edge in their direction."""
        report = verify([(0, 0), (4, 0), (0, 4), (1, 4)], [(0, 2, 1), (0, 1, 2), (0, 1, 3)])
        for violation in report.findings[Property.EDGE_MANIFOLD].violations:
            if violation.vertices == (0, 1):
                assert violation.triangles == (1, 2)

    def test_two_fans(self) -> None:
        """Round the centre there are a fan of three and one of two: one triangle of each is named."""
        points = [(0, 0), (4, 0), (4, 4), (0, 4), (-4, 4), (-4, -4), (0, -4), (4, -4)]
        triangles = [(0, 1, 2), (0, 5, 6), (0, 2, 3), (0, 6, 7), (0, 3, 4)]
        (violation,) = verify(points, triangles).findings[Property.VERTEX_MANIFOLD].violations
        assert violation.triangles == (0, 1)
        assert list(faults(violation, Orientation.CCW)) == []

    def test_an_unused_point_comes_with_a_triangle_round_it(self) -> None:
        points = [(0, 0), (4, 0), (4, 4), (0, 4), (1, 3)]
        (violation,) = verify(points, [(0, 1, 2), (0, 2, 3)]).findings[Property.DELAUNAY].violations
        assert (violation.triangles, violation.vertices, violation.sign) == ((1,), (0, 2, 3, 4), 1)
        assert violation.magnitude == Fraction(4 * 4) * (2 * 2 * 2 - 1 - 1)
        assert list(faults(violation, Orientation.CCW)) == []

    def test_long_edges(self) -> None:
        """Against a size a triangle, the one that is named is too large for its own."""
        points, triangles = [(0, 0), (4, 0), (4, 4), (0, 4)], [(0, 1, 2), (0, 2, 3)]
        (violation,) = verify(points, triangles, size=[6, 5]).findings[Property.MAX_LENGTH].violations
        part = violation.submesh()
        assert violation.is_local
        assert part.cells == (1,)
        assert verify(part.points, part.triangles, size=[5]).verdict(Property.MAX_LENGTH) is Verdict.FAILS
        assert verify(part.points, part.triangles, size=[6]).verdict(Property.MAX_LENGTH) is Verdict.HOLDS

    def test_controls(self) -> None:
        """A witness with one cell too many is noticed, and one with one too few."""
        square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (9.0, 9.0)]
        report = verify(square, [(0, 1, 2), (0, 2, 3), (0, 1, 3), (1, 4, 2)])
        violation = report.findings[Property.EDGE_MANIFOLD].violations[0]
        assert list(faults(violation, Orientation.CCW)) == []
        for cells in ((0, 2, 3), (0,)):
            other = Violation(
                violation.property,
                violation.kind,
                cells,
                violation.vertices,
                "another",
                corners=tuple(((0, 1, 2), (0, 2, 3), (0, 1, 3), (1, 4, 2))[cell] for cell in cells),
                indices=tuple(range(5)),
                points=tuple(square),
                point_count=5,
            )
            assert any(told.startswith("another") for told in faults(other, Orientation.CCW))

    def test_what_is_global(self) -> None:
        """What no part of a mesh can say: that something is nowhere in it, or what lies outside of all of it."""
        assert set(Property) - LOCAL_PROPERTIES >= {
            Property.ALL_POINTS_USED,
            Property.COVERS_HULL,
            Property.SEGMENTS_PRESENT,
            Property.COVERS_DOMAIN,
            Property.DOMAIN_POINTS,
            Property.NO_NEW_POINTS,
            Property.REGIONS,
            Property.REGION_AREAS,
        }


class TestSubmesh:
    """Law: a violation says by itself what it is about: exact coordinates, corners, and Python to copy."""

    @pytest.mark.parametrize("bad", [-1, -(2**63), 7, 2**62])
    def test_an_index_out_of_range_stays_one(self, bad: int) -> None:
        (violation,) = verify([(0, 0), (1, 0), (0, 1)], [(0, 1, 2), (0, 1, bad)]).findings[Property.INDICES].violations
        assert violation.kind is Kind.OUT_OF_RANGE
        assert list(faults(violation, Orientation.CCW)) == []
        part = violation.submesh()
        assert part.points.tolist() == [[0, 0], [1, 0]]
        assert part.indices == (0, 1)
        assert violation.indices == tuple(sorted((0, 1, bad)))

    def test_not_finite(self) -> None:
        report = verify([(0, 0), (1, np.nan), (np.inf, 1)], [(0, 1, 2)])
        for violation in report.findings[Property.FINITE].violations:
            assert list(faults(violation, Orientation.CCW)) == []
            assert 'float("' in violation.to_python()

    def test_python_makes_the_arrays_again(self) -> None:
        rng = np.random.default_rng(5)
        points = rng.random((9, 2)) * 10.0 ** rng.integers(-300, 300, (9, 2))
        cells = [(0, 1, 2), (3, 4, 5), (6, 7, 8), (0, 1, 5)]
        for violation in verify(points, cells, quads=[(0, 3, 6, 8)]).violations:
            names: dict[str, list[tuple[float, ...]]] = {}
            exec(violation.to_python(), names)
            part = violation.submesh()
            assert np.array(names["points"]).reshape(-1, 2).tolist() == part.points.tolist()
            assert np.array(names["triangles"]).reshape(-1, 3).tolist() == part.triangles.tolist()
            assert np.array(names.get("quads", [])).reshape(-1, 4).tolist() == part.quads.tolist()
            assert part.points.tolist() == points[list(part.indices)].tolist()
            assert dict(zip(violation.indices, violation.points, strict=True)) == {
                v: tuple(points[v].tolist()) for v in violation.indices
            }
