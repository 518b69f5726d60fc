"""M4: incremental insertion is brute force, whatever the order, the seed and the degeneracy."""

import os
import subprocess
import sys
from collections.abc import Sequence
from itertools import combinations, permutations
from pathlib import Path
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from proofs_tests import oracles
from proofs_tests.kernel.strategies import Point
from proofs_tests.mesh import oracle as mesh_oracle
from proofs_tests.mesh.enumeration import canonical_triangles, grid
from proofs_tests.mesh.strategies import point_sets
from proofs_tests.recording import Record

from exactkernel.jit import COMPILED
from exactkernel.types import FloatArray, Stage
from exactmesh import Triangulation, delaunay, lawson, verify
from exactmesh.errors import CollinearPointsError, TooFewPointsError

#: The module; the package exports the function under the same name.
MODULE = sys.modules["exactmesh.delaunay"]


class Subsets:
    """Every subset of a grid, as a bit mask, with its Delaunay triangulation by brute force.

    The perturbation looks at the lexicographic order of the points only, so whether a point conflicts with a triangle
    does not depend on the other points: one table serves all subsets.
    """

    def __init__(self, width: int, height: int) -> None:
        self.points = np.array(grid(width, height), dtype=np.float64)
        exact = oracles.rationals(self.points.tolist())
        rows, conflicts = [], []
        for t in combinations(range(len(exact)), 3):
            if oracles.has_area(exact, t):
                ccw = oracles.counterclockwise(exact, t)
                rows.append(canonical_triangles([ccw])[0])
                others = [v for v in range(len(exact)) if v not in t]
                inside = [v for v in others if not mesh_oracle.is_perturbed_empty(exact, ccw, [v])]
                conflicts.append(sum(1 << v for v in inside))
        self.triangles = np.array(rows)
        self.corners = (1 << self.triangles).sum(axis=1)
        self.conflicts = np.array(conflicts)

    def expected(self, mask: int) -> list[list[int]]:
        chosen = ((self.corners & ~mask) == 0) & ((self.conflicts & mask) == 0)
        rows: list[list[int]] = self.triangles[chosen].tolist()
        return rows

    def ours(self, mask: int) -> list[list[int]]:
        """The library's answer in the same numbering; of collinear points, no triangles."""
        chosen = np.array([v for v in range(len(self.points)) if mask >> v & 1], dtype=np.int64)
        try:
            mesh = delaunay(self.points[chosen])
        except (CollinearPointsError, TooFewPointsError):
            return []
        rows: list[list[int]] = chosen[mesh.triangles].tolist()
        return rows

    def disagreements(self, masks: range) -> list[int]:
        return [mask for mask in masks if list(canonical_triangles(self.ours(mask))) != triples(self.expected(mask))]


def triples(rows: list[list[int]]) -> list[tuple[int, int, int]]:
    return sorted((a, b, c) for a, b, c in rows)


@pytest.mark.obligation(
    "M4",
    "insertion equals brute force on every subset of a 4 x 4 grid, in random orders",
    method="enumeration",
    control_in="TestFaultsAreFound",
)
class TestAllSubsetsOfAGrid:
    """For every subset of a grid, inserted in a random order, the triangles are those whose perturbed circles are
    empty, found by looking at all triples; subsets of a line are refused."""

    @pytest.fixture(autouse=True)
    def scrambled(self, monkeypatch: pytest.MonkeyPatch) -> None:
        random = np.random.default_rng(0)
        monkeypatch.setattr(MODULE, "insertion_order", lambda xy, _: random.permutation(len(xy)))

    def test_3x3(self, record_property: Record) -> None:
        masks = range(1 << 9)
        assert not Subsets(3, 3).disagreements(masks)
        record_property("cases", len(masks))

    def test_4x4(self, record_property: Record) -> None:
        masks = range(1 << 16) if COMPILED else range(0, 1 << 16, 97)
        assert not Subsets(4, 4).disagreements(masks)
        record_property("cases", len(masks))

    def test_brute_force_covers_the_hull(self) -> None:
        """The oracle itself: its triangles cover the hull of the subset once."""
        subsets = Subsets(3, 3)
        exact = oracles.rationals(subsets.points.tolist())
        for mask in range(0, 1 << 9, 5):
            inside = [p for v, p in enumerate(exact) if mask >> v & 1]
            rows = triples(subsets.expected(mask))
            assert oracles.is_admissible(exact, rows)
            assert sum(oracles.orient(*(exact[v] for v in t)) for t in rows) == oracles.hull_area(inside)
            used = {v for t in rows for v in t}
            assert not rows or used == {v for v in range(9) if mask >> v & 1}


FAULTY = """
import exactmesh
from exactkernel.incircle import incircle_adaptive
from proofs_tests.mesh.test_delaunay import FAULTS, MODULE, Subsets

subsets, sound = Subsets(3, 3), dict(vars(MODULE))
for fault in FAULTS.values():
    vars(MODULE).update(sound)
    exec(fault)
    print(len(subsets.disagreements(range(0, 1 << 9, 3))))
"""

FAULTS = {
    "none": "",
    "ties left as they are": "MODULE.incircle_perturbed_adaptive = incircle_adaptive",
    "ties taken for conflicts": "MODULE.incircle_perturbed_adaptive = lambda *a: 2 * incircle_adaptive(*a) + 1",
    "no flips": "MODULE.legalize = lambda *a: 0",
    "one flip left out": "legalize = MODULE.legalize; MODULE.legalize = lambda *a: legalize(*a) if a[-1] != 6 else 0",
    "hull edges never flipped": "conflict = MODULE.in_conflict; "
    "MODULE.in_conflict = lambda k, xy, g, *abcp: g not in abcp and conflict(k, xy, g, *abcp)",
}


@pytest.mark.once
@pytest.mark.obligation(
    "M4", "an insertion with a seeded fault is found by the comparison with brute force", method="mutation"
)
class TestFaultsAreFound:
    """The comparison above rejects an insertion with a seeded fault: run in a child process, interpreted."""

    def test_control_faults(self) -> None:
        """Lines of the insertion changed, one by one; each makes the enumeration disagree, none does not."""
        child = subprocess.run(
            [sys.executable, "-c", FAULTY],
            env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
            cwd=Path(__file__).parents[2],
            capture_output=True,
            text=True,
            check=True,
        )
        found = dict(zip(FAULTS, map(int, child.stdout.split()), strict=True))
        assert {fault for fault, count in found.items() if count == 0} == {"none"}


SIX: dict[str, Sequence[Point]] = {
    "2 x 3 grid": grid(2, 3),
    "cocircular": [(5, 0), (3, 4), (-3, 4), (-5, 0), (0, -5), (4, -3)],
    "four on the hull's side": [(0, 0), (1, 0), (2, 0), (3, 0), (1, 1), (1, 2)],
    "one off a line": [(0, 0), (1, 1), (2, 2), (3, 3), (4, 4), (0, 3)],
    "square with centre, and beyond": [(0, 0), (2, 0), (2, 2), (0, 2), (1, 1), (9, 1)],
    "duplicates": [(0, 0), (1, 0), (0, 1), (0, 0), (1, 0), (0, 1)],
    "no window": [(0, 0), (1e200, 0), (0, 1e-200), (1e200, 1e-200), (5e199, 5e-201), (1e-320, 1e300)],
}


@pytest.mark.obligation(
    "M4",
    "insertion gives the same triangulation in all 720 orders of six points",
    method="enumeration",
    control_in="TestFaultsAreFound",
)
class TestEveryOrder:
    """All 720 orders of insertion of six points give one and the same triangulation."""

    @pytest.mark.parametrize("points", SIX.values(), ids=SIX.keys())
    def test_all_permutations(
        self, points: Sequence[Point], monkeypatch: pytest.MonkeyPatch, record_property: Record
    ) -> None:
        orders = list(permutations(range(6)))[:: 1 if COMPILED else 7]
        exact = oracles.rationals(points)
        distinct = list(dict.fromkeys(exact))
        expected = mesh_oracle.delaunay_triangles(distinct)
        coming = iter(orders)
        monkeypatch.setattr(MODULE, "insertion_order", lambda *_: np.array(next(coming)))
        for _ in orders:
            mesh = delaunay(points)
            assert canonical_triangles(mesh.triangles.tolist()) == expected
            assert oracles.rationals(mesh.points.tolist()) == distinct
            assert [distinct[v] for v in mesh.representative] == exact
        record_property("cases", len(orders))


def is_collinear(points: list[oracles.RationalPoint]) -> bool:
    return not any(oracles.has_area(points, t) for t in combinations(range(len(points)), 3))


@pytest.mark.bounds
@pytest.mark.obligation(
    "M4",
    "insertion equals brute force and is a fixed point of Lawson, for any doubles",
    method="property-based",
    control_in="TestFaultsAreFound",
)
class TestAnyPoints:
    """For any doubles, duplicates and all: the vertices are the distinct points in the order of the input, the
    triangles those of brute force, and an error says that all points lie on a line just when they do."""

    @settings(max_examples=settings().max_examples // 2)
    @given(point_sets(8))
    def test_brute_force(self, points: list[Point]) -> None:
        exact = oracles.rationals(points)
        distinct = list(dict.fromkeys(exact))
        if is_collinear(distinct):
            with pytest.raises(CollinearPointsError):
                delaunay(points)
            return
        mesh = delaunay(points)
        assert oracles.rationals(mesh.points.tolist()) == distinct
        assert mesh.representative.tolist() == mesh_oracle.first_occurrences(exact)
        assert canonical_triangles(mesh.triangles.tolist()) == mesh_oracle.delaunay_triangles(distinct)
        assert verify(mesh.points, mesh.triangles).ok

    @given(point_sets(), st.randoms(use_true_random=False))
    def test_order_of_the_input(self, points: list[Point], random: Random) -> None:
        """Up to the numbering the result does not depend on the order of the points."""
        shuffled = list(points)
        random.shuffle(shuffled)
        if is_collinear(oracles.rationals(points)):
            return
        mesh, other = delaunay(points).canonical(), delaunay(shuffled).canonical()
        assert mesh == other
        assert (mesh.neighbors == other.neighbors).all()

    @settings(max_examples=settings().max_examples // 2)
    @given(point_sets())
    def test_lawson(self, points: list[Point]) -> None:
        """Lawson's algorithm has nothing to do on the result, and says so."""
        if is_collinear(oracles.rationals(points)):
            return
        mesh = delaunay(points)
        again = lawson(mesh.points, mesh.triangles)
        assert again.work.flips == 0
        assert again.canonical() == mesh.canonical()


def structured(n: int) -> dict[str, FloatArray]:
    """Larger inputs, where rounds of insertion and clusters of the curve come in."""
    random = np.random.default_rng(5)
    side = int(n**0.5)
    x, y = np.meshgrid(np.arange(side), np.arange(side))
    angles = random.random(n) * 2 * np.pi
    clusters = random.random((8, 2))[random.integers(0, 8, n)]
    along = random.random(n)
    return {
        "uniform": random.random((n, 2)),
        "grid": np.stack([x.ravel(), y.ravel()], axis=1).astype(np.float64),
        "circle": np.stack([np.cos(angles), np.sin(angles)], axis=1),
        "clusters": clusters + 1e-12 * random.standard_normal((n, 2)),
        "line": np.stack([along, along + 1e-16 * random.random(n)], axis=1),
        "duplicates": random.integers(0, side // 2, (n, 2)).astype(np.float64),
        "tiny": random.random((n, 2)) * 2.0**-1060,
        "huge": (random.random((n, 2)) - 0.5) * 2.0**1023,
    }


N = 20_000 if COMPILED else 300
STRUCTURED = structured(N)


def euler_holds(mesh: Triangulation) -> bool:
    """Triangles of a triangulation of the hull: 2 n - h - 2."""
    return len(mesh.triangles) == 2 * len(mesh.points) - len(mesh.hull) - 2


@pytest.mark.bounds
@pytest.mark.obligation(
    "M4", "the triangulation of many points is the same for every seed and order, and verified", method="named cases"
)
class TestManyPoints:
    """The same triangulation for every seed and order of many points; the verifier, which shares no code, agrees."""

    @pytest.mark.parametrize("points", STRUCTURED.values(), ids=STRUCTURED.keys())
    def test_seeds_and_orders(self, points: FloatArray) -> None:
        mesh = delaunay(points)
        assert verify(mesh.points, mesh.triangles).ok
        assert euler_holds(mesh)
        assert (mesh.points[mesh.representative] == points).all()
        canonical = mesh.canonical()
        order = np.random.default_rng(0).permutation(len(points))
        for seed in (1, 2**70):
            assert delaunay(points, seed=seed).canonical() == canonical
            assert delaunay(points[order], seed=seed).canonical() == canonical

    def test_control_a_flipped_edge_is_noticed(self) -> None:
        """One edge flipped."""
        mesh = delaunay(STRUCTURED["uniform"])
        surface = mesh.quad_edge()
        for edge in surface.edges():
            if -1 not in (edge.left, edge.right):
                surface.swap(edge)
                break
        other = Triangulation(mesh.points, surface.triangles(), mesh.neighbors, mesh.representative, mesh.work)
        assert other.canonical() != mesh.canonical()
        assert not verify(other.points, other.triangles).ok


@pytest.mark.obligation("M4", "degenerate input is decided in doubles", method="named cases")
class TestStages:
    """The stage that the design names decides each kind of input, so that no degenerate input ends in rationals."""

    @pytest.mark.parametrize(
        ("name", "stages"),
        [
            ("uniform", {Stage.FILTER}),
            ("grid", {Stage.FILTER, Stage.GRID}),
            ("circle", {Stage.FILTER, Stage.DOUBLE_DOUBLE, Stage.EXPANSION}),
            ("tiny", {Stage.FILTER, Stage.DOUBLE_DOUBLE, Stage.EXPANSION}),
            ("huge", {Stage.FILTER, Stage.DOUBLE_DOUBLE, Stage.EXPANSION}),
        ],
    )
    def test_stages(self, name: str, stages: set[Stage]) -> None:
        work = delaunay(STRUCTURED[name][:300]).work
        assert {stage for stage, count in work.incircle.items() if count} <= stages
        assert work.incircle[Stage.FILTER] > 0
        assert work.flips > 0

    def test_rationals_outside_the_window(self) -> None:
        work = delaunay(SIX["no window"]).work
        assert work.incircle[Stage.RATIONAL] > 0

    def test_control_other_input_needs_other_stages(self) -> None:
        """Points of a circle in the place of points in general position."""
        work = delaunay(STRUCTURED["circle"][:300]).work
        assert not {stage for stage, count in work.incircle.items() if count} <= {Stage.FILTER}


class TestProgress:
    """Progress is told in increasing numbers that end with all points; an exception in it passes through."""

    def test_calls(self) -> None:
        calls: list[tuple[int, int]] = []
        delaunay(STRUCTURED["uniform"], progress=lambda done, total: calls.append((done, total)))
        assert calls == sorted(calls)
        assert calls[-1] == (N, N)

    def test_exception(self) -> None:
        def fail(done: int, total: int) -> None:
            raise LookupError(f"{done} of {total}")

        with pytest.raises(LookupError):
            delaunay(STRUCTURED["uniform"], progress=fail)
