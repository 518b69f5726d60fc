"""V1: what quadrilaterals are, by all their turns, against the definition; and what is said of them."""

import sys
from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations, permutations

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.mesh.enumeration import grid
from proofs_tests.oracles import RationalPoint

from exactmesh.verify.cells import (
    Cells,
    check_convex,
    check_quad_orientation,
    is_convex,
    orientation_of_quads,
    proper_cells,
    turns_of,
    upright_cells,
)
from exactmesh.verify.local import localized
from exactmesh.verify.mesh import Mesh, index_quads, index_triples, prepared_mesh
from exactmesh.verify.properties import Kind, Orientation, Property, Verdict
from exactmesh.verify.triangles import Shapes, classified

Quad = tuple[int, ...]

POINTS = grid(3, 3)
EXACT = oracles.rationals(POINTS)
QUADS: list[Quad] = [*permutations(range(9), 4)]
TRIANGLES = [(0, 3, 1), (0, 1, 3), (0, 1, 2), (0, 4, 8), (8, 2, 5)]


def shaped(quads: Sequence[Quad], triangles: Sequence[Quad] = ()) -> tuple[Mesh, Shapes]:
    array = np.array(POINTS, dtype=np.float64)
    mesh = prepared_mesh(array, index_triples(triangles), index_quads(quads), np.empty((0, 2)))[0]
    local = localized(mesh.coordinates, mesh.triangles, mesh.quads)
    return mesh, classified(mesh.context, local, turns_of(mesh.context, local))


def cross(a: RationalPoint, b: RationalPoint, c: RationalPoint, d: RationalPoint) -> bool:
    """Whether two closed segments have a point in common."""
    if any(oracles.on_segment(p, *s) for p, s in ((a, (c, d)), (b, (c, d)), (c, (a, b)), (d, (a, b)))):
        return True
    sides = [oracles.orient(*t) for t in ((a, b, c), (a, b, d), (c, d, a), (c, d, b))]
    return sides[0] * sides[1] < 0 and sides[2] * sides[3] < 0


def area(quad: Quad) -> Fraction:
    """Twice the signed area, by the trapezoids under the sides."""
    places = [EXACT[v] for v in quad]
    return sum(((p[0] * q[1] - q[0] * p[1]) for p, q in zip(places, places[1:] + places[:1], strict=True)), Fraction(0))


def is_simple(quad: Quad) -> bool:
    """Whether sides meet in nothing but the corners that they share; a straight corner is allowed, a spike is not."""
    a, b, c, d = (EXACT[v] for v in quad)
    if cross(a, b, c, d) or cross(b, c, d, a):
        return False
    spikes = ((a, b, c), (b, c, d), (c, d, a), (d, a, b))
    return not any(
        oracles.orient(*t) == 0 and (oracles.on_segment(t[0], *t[1:]) or oracles.on_segment(t[2], *t[:2]))
        for t in spikes
    )


def expected_turns(quad: Quad) -> list[int]:
    turns = [oracles.orient(EXACT[quad[i - 1]], EXACT[quad[i]], EXACT[quad[(i + 1) % 4]]) for i in range(4)]
    return [(turn > 0) - (turn < 0) for turn in turns]


SAMPLE = QUADS[::7]
SHAPES = shaped(SAMPLE)[1]


@pytest.mark.obligation("V1", "a quadrilateral is what its turns say", method="enumeration", control_in="mutants")
class TestTurns:
    """Of quadrilaterals between points of a grid: the turns are those of their corners; the orientation is the sign of
    the area of those that are simple, 0 for all others; convex are those with four strict turns of one sign that are
    simple. However few at a time."""

    @pytest.mark.parametrize("size", [1, 2, 5, 1 << 17])
    def test_turns(self, size: int, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(sys.modules["exactmesh.verify.cells"], "CHUNK", size)
        chosen = SAMPLE[size % 3 :: 4]
        mesh, _ = shaped(chosen)
        turns = turns_of(mesh.context, localized(mesh.coordinates, mesh.triangles, mesh.quads))
        assert turns.dtype == np.int8
        assert turns.tolist() == [expected_turns(quad) for quad in chosen]

    def test_orientation(self) -> None:
        found = orientation_of_quads(SHAPES.turns)
        seen = set()
        for quad, orientation in zip(SAMPLE, found.tolist(), strict=True):
            signed = area(quad)
            assert orientation == (((signed > 0) - (signed < 0)) if is_simple(quad) else 0), quad
            seen.add(orientation)
        assert seen == {-1, 0, 1}

    def test_convex(self) -> None:
        found = is_convex(SHAPES.turns)
        for quad, convex in zip(SAMPLE, found.tolist(), strict=True):
            turns = expected_turns(quad)
            assert convex is (is_simple(quad) and abs(sum(turns)) == 4)
        assert set(found.tolist()) == {True, False}


@pytest.mark.obligation("V1", "cells are turned round, and sorted out, just where they must", method="enumeration")
class TestCells:
    """upright_cells are the same cells, the clockwise ones turned round; proper_cells those with an area and no corner
    that is not strictly convex, in their order; where nothing changes they are the same arrays."""

    def test_upright(self) -> None:
        mesh, shapes = shaped(SAMPLE[:300], TRIANGLES)
        cells = upright_cells(mesh, shapes)
        for quad, ours in zip(SAMPLE[:300], cells.quads.tolist(), strict=True):
            turned = is_simple(quad) and area(quad) < 0
            assert ours == ([quad[0], quad[3], quad[2], quad[1]] if turned else list(quad))
        for triangle, ours in zip(TRIANGLES, cells.triangles.tolist(), strict=True):
            assert (
                min(area((*t, t[0])) for t in (triangle, tuple(ours)))
                == min(area((*triangle, triangle[0])), -area((*triangle, triangle[0])))
                or tuple(ours) == triangle
            )
        assert (mesh.quads == np.array(SAMPLE[:300])).all()  # a copy was turned
        again, shapes = shaped([tuple(quad) for quad in cells.quads.tolist()], [])
        same = upright_cells(again, shapes)
        assert same.are(Cells(again.triangles, again.quads))

    def test_proper(self) -> None:
        for quads, triangles in ((SAMPLE[:60], TRIANGLES), ([(0, 3, 4, 1)], TRIANGLES), (SAMPLE[:9], [(0, 3, 1)])):
            mesh, shapes = shaped(quads, triangles)
            cells = Cells(mesh.triangles, mesh.quads)
            proper = proper_cells(cells, shapes)
            expected = [list(quad) for quad in quads if is_simple(quad) and abs(sum(expected_turns(quad))) == 4]
            assert proper.quads.tolist() == expected
            assert (proper.quads is mesh.quads) is (len(expected) == len(quads))
            with_area = [list(t) for t in triangles if oracles.orient(*(EXACT[v] for v in t))]
            assert proper.triangles.tolist() == with_area
            assert (proper.triangles is mesh.triangles) is (len(with_area) == len(triangles))

    def test_control_are(self) -> None:
        """Equal arrays are not the same arrays."""
        mesh, _ = shaped([(0, 3, 4, 1)], [(0, 3, 1)])
        cells = Cells(mesh.triangles, mesh.quads)
        assert cells.are(cells)
        for other in (Cells(mesh.triangles.copy(), mesh.quads), Cells(mesh.triangles, mesh.quads.copy())):
            assert not cells.are(other)


def name(row: int, quad: Quad) -> str:
    corners = ", ".join(f"{v} ({float(POINTS[v][0])}, {float(POINTS[v][1])})" for v in quad)
    return f"cell {row}, the quadrilateral {corners},"


@pytest.mark.obligation(
    "V1",
    "what is wrong with a quadrilateral is said by its kind, in fractions",
    method="enumeration",
    control_in="mutants",
)
class TestMessages:
    """CONVEX fails for each quadrilateral that is not strictly convex, ORIENTATION for each that is not
    counterclockwise, or, whatever the orientation, not simple; the violation names the corner, and the exact area."""

    @pytest.mark.parametrize("before", [0, 2])
    def test_convex(self, before: int) -> None:
        for quad in SAMPLE[before::3]:
            mesh, shapes = shaped([(0, 3, 4, 1), quad], TRIANGLES[:before])
            finding = check_convex(mesh, shapes)
            turns, row = expected_turns(quad), before + 1
            if is_simple(quad) and abs(sum(turns)) == 4:
                assert finding.verdict is Verdict.HOLDS
                continue
            (violation,) = finding.violations
            assert (violation.triangles, violation.vertices) == ((row,), quad)
            assert violation.property is Property.CONVEX
            if not any(turns):
                assert (violation.kind, violation.message) == (Kind.ZERO_AREA, f"{name(row, quad)} has no area")
            elif not is_simple(quad):
                assert violation.kind is Kind.NOT_SIMPLE
                assert violation.message == f"{name(row, quad)} is no simple polygon: its sides cross or overlap"
            else:
                most = 1 if sum(turns) > 0 else -1
                (i,) = (i for i in range(4) if turns[i] != most)
                turn = oracles.orient(EXACT[quad[i - 1]], EXACT[quad[i]], EXACT[quad[(i + 1) % 4]])
                assert violation.kind is (Kind.REFLEX_CORNER if turn else Kind.STRAIGHT_CORNER)
                assert violation.magnitude == turn
                x, y = POINTS[quad[i]]
                fault = "reflex" if turn else "straight"
                corner = f"{quad[i]} ({float(x)}, {float(y)})"
                assert violation.message == f"{name(row, quad)} is not strictly convex: its corner {corner} is {fault}"

    @pytest.mark.parametrize("orientation", [Orientation.ANY, Orientation.CCW])
    def test_orientation(self, orientation: Orientation) -> None:
        for quad in SAMPLE[1::4]:
            mesh, shapes = shaped([(0, 3, 4, 1), quad], TRIANGLES[:1])
            finding = check_quad_orientation(mesh, shapes, orientation)
            simple, twice = is_simple(quad), area(quad)
            if simple and (twice > 0 or orientation is Orientation.ANY):
                assert finding.verdict is Verdict.HOLDS
                continue
            (violation,) = finding.violations
            assert (violation.triangles, violation.vertices) == ((2,), quad)
            assert violation.property is Property.ORIENTATION
            if simple:
                assert violation.kind is Kind.CLOCKWISE
                assert violation.magnitude == twice
                assert violation.message == f"{name(2, quad)} is clockwise, twice its area is {twice}"
            else:
                assert violation.kind is (Kind.NOT_SIMPLE if any(expected_turns(quad)) else Kind.ZERO_AREA)

    def test_several(self) -> None:
        """All of them are counted, by rows of cells, triangles first."""
        for count in range(1, 4):
            for quads in list(combinations(SAMPLE[::60], count))[::5]:
                mesh, shapes = shaped(quads, TRIANGLES)
                bad = [len(TRIANGLES) + i for i, quad in enumerate(quads) if abs(sum(expected_turns(quad))) < 4]
                finding = check_convex(mesh, shapes)
                assert finding.count == len(bad)
                assert [violation.triangles for violation in finding.violations] == [(row,) for row in bad]
