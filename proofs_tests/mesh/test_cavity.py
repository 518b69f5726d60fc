"""The polygons beside a long segment: both ways of filling agree; the work is linear, counted in predicates."""

import os
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from exactkernel import incircle_perturbed
from exactkernel.jit import COMPILED
from exactkernel.types import FloatArray
from exactmesh import PSLG, Triangulation, constrained_delaunay, delaunay, verify
from exactmesh.edgealgebra import EdgeArray
from exactmesh.plane import Plane

CAVITY = sys.modules["exactmesh.cavity"]


def parabola(n: int, _: int) -> FloatArray:
    x = np.linspace(-1.0, 1.0, n)
    return np.stack([x, 0.1 + x * x], axis=1)


def exponential(n: int, _: int) -> FloatArray:
    x = np.linspace(-1.0, 1.0, n)
    return np.stack([x, 0.1 + np.exp(3.0 * x) / 20.0], axis=1)


def scattered(n: int, seed: int) -> FloatArray:
    return np.random.default_rng(seed).random((n, 2)) * [2.0, 1.0] - [1.0, 0.0]


def sawtooth(n: int, _: int) -> FloatArray:
    return np.stack([np.linspace(-1.0, 1.0, n), 0.1 + 0.5 * (np.arange(n) % 2)], axis=1)


def lattice(n: int, seed: int) -> FloatArray:
    """Integers: many vertices dangle in the cavity, and many distances and circles are ties."""
    random = np.random.default_rng(seed)
    return np.stack([random.integers(-12, 13, n), random.integers(1, 9, n)], axis=1).astype(np.float64)


def nearly_flat(n: int, seed: int) -> FloatArray:
    heights = 0.1 + np.random.default_rng(seed).integers(0, 4, n) * 2.0**-50
    return np.stack([np.linspace(-1.0, 1.0, n), heights], axis=1)


def dangling(n: int, seed: int) -> FloatArray:
    """Fans whose tips hang down to the segment, each from one vertex above."""
    random = np.random.default_rng(seed)
    tips = np.stack([np.linspace(-1.0, 1.0, n), 2.0 ** -random.integers(3, 20, n)], axis=1)
    return np.concatenate([tips[::2], tips[1::2] * [1.0, 0.0] + [0.0, 3.0]])


CHAINS = (parabola, exponential, scattered, sawtooth, lattice, nearly_flat, dangling)
ENDS = np.array([(-30.0, 0.003), (30.0, -0.001)])


def crossing_case(name: str, n: int, seed: int) -> FloatArray:
    """Points with a segment from the first to the second, which crosses most of their edges."""
    random = np.random.default_rng(seed)
    if name == "slanted":  # points rounded onto one line
        t = random.random(n)
        return np.concatenate([[(-1.0, -1.0 / 3.0), (2.0, 2.0 / 3.0)], np.stack([t, t / 3.0], axis=1)])
    if name == "slanted, a few ulps":
        x = np.linspace(0.01, 1.0, n)
        y = x / 3.0 + random.integers(-2, 3, n) * np.spacing(x / 3.0)
        return np.concatenate([[(-1.0, -1.0 / 3.0), (2.0, 2.0 / 3.0)], np.stack([x, y], axis=1)])
    (make,) = (make for make in CHAINS if make.__name__ == name)
    return np.concatenate([ENDS, make(n, seed), make(n, seed + 1) * [1.0, -1.0]])


NAMES = [*(make.__name__ for make in CHAINS), "slanted", "slanted, a few ulps"]
SCALES = (0, -1073, 0, 1000)  # exponents: to the subnormals, to the largest doubles


def divided(points: FloatArray) -> Triangulation:
    return constrained_delaunay(PSLG(points, [(0, 1)]), carve=False)


def bad_edges(mesh: Triangulation) -> list[tuple[int, int]]:
    """Edges of two triangles that are not constrained, and across which the (perturbed) circle is not empty."""
    opposite = {(t[i - 2], t[i - 1]): t[i] for t in mesh.triangles.tolist() for i in range(3)}
    fixed = {frozenset(edge) for edge in mesh.segments.tolist()}
    points = mesh.points.tolist()
    return [
        (a, b)
        for (a, b), c in opposite.items()
        if a < b and (b, a) in opposite and frozenset((a, b)) not in fixed
        if incircle_perturbed(*(tuple(points[v]) for v in (a, b, c, opposite[b, a]))) > 0
    ]


@pytest.mark.bounds
@pytest.mark.obligation(
    "M5", "a long segment leaves a triangulation that is locally Delaunay beside it", method="named cases"
)
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("n", [10, 33, 100, 1000])
class TestLongSegment:
    """What fills the cavity of a long segment is a triangulation of the hull that contains the segment and in which
    every other edge is locally Delaunay: so it is the constrained Delaunay triangulation (theorem E)."""

    def test_locally_delaunay(self, name: str, n: int) -> None:
        mesh = divided(crossing_case(name, n if COMPILED else min(n, 100), 3))
        assert verify(mesh.points, mesh.triangles, segments=[(0, 1)]).ok
        chain = mesh.chain(0).tolist()
        assert (chain[0][0], chain[-1][1]) == (0, 1)
        assert all(one[1] == other[0] for one, other in pairwise(chain))
        assert bad_edges(mesh) == []

    def test_control_without_the_segment(self, name: str, n: int) -> None:
        """The edges beside the segment are not Delaunay by themselves: crossing them was work."""
        points = crossing_case(name, min(n, 100), 3)
        mesh = divided(points)
        plain = delaunay(points)
        assert bad_edges(plain) == []
        assert len(mesh.chain(0)) > 1 or mesh.canonical() != plain.canonical()


BOTH_WAYS = """
from proofs_tests.mesh.test_cavity import FAULTS, CAVITY, compare, far_first

sound = dict(vars(CAVITY))
for fault in FAULTS.values():
    vars(CAVITY).update(sound)
    exec(fault, {"cavity": CAVITY, "far_first": far_first})
    print(*compare())
"""

FAULTS = {
    "none": "",
    "the wrong order": "cavity.heuristic_order = far_first",
    "the wrong order, no check": "cavity.heuristic_order = far_first; cavity.is_delaunay = lambda *a: True",
    "no flips": "cavity.legalize_fan = lambda *a: None; cavity.is_delaunay = lambda *a: True",
}


def far_first(plane: Plane, chain: EdgeArray, length: int) -> None:
    """What heuristic_order writes, but the vertices that are farthest from the base come first."""

    def farther(i: int) -> int:
        return sum(CAVITY.is_nearer(plane, chain, length, i, j) for j in range(1, length))

    inserted = [0, length]
    for turn, i in enumerate(sorted(range(1, length), key=farther), 1):
        plane.stack[3 * turn] = i
        plane.stack[3 * i + 1] = max(j for j in inserted if j < i)
        plane.stack[3 * i + 2] = min(j for j in inserted if j > i)
        inserted.append(i)


def compare() -> tuple[int, int, int]:
    """Fill random cavities by search alone and by chance alone; return (by chance, failed the check, unequal)."""
    fill = CAVITY.fill_by_chance
    results: list[bool] = []
    unequal = 0

    def observed(*arguments: object) -> bool:
        results.append(fill(*arguments))
        return results[-1]

    CAVITY.fill_by_chance = observed  # type: ignore[attr-defined]  # interpreted: functions are looked up by name
    for case in range(63):
        name = NAMES[case % len(NAMES)]
        n = 40 if name in ("dangling", "slanted, a few ulps") else 4 + 3 * (case // len(NAMES)) + case % 5
        scale = SCALES[case % len(SCALES)] if name == "lattice" else 0
        points = np.ldexp(crossing_case(name, n, case), scale)
        CAVITY._PATIENCE, CAVITY._SMALL = 1 << 20, 0  # type: ignore[attr-defined]
        expected = divided(points)
        CAVITY._PATIENCE = 0  # type: ignore[attr-defined]
        unequal += divided(points).canonical() != expected.canonical()
    return len(results), results.count(False), unequal


@pytest.mark.once
@pytest.mark.obligation(
    "M5", "search and chance fill a cavity with the same triangles, and chance does not fail", method="differential"
)
class TestBothWays:
    """Cavities of convex, flat, random and lattice chains, with dangling vertices, filled by search alone and by chance
    alone, are the same; the check that follows chance holds in all of them. Interpreted, in a child process."""

    def test_control_and_equal(self) -> None:
        """In the wrong order some fail the check, yet all are equal; without the check they are not."""
        child = subprocess.run(
            [sys.executable, "-c", BOTH_WAYS],
            env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
            cwd=Path(__file__).parents[2],
            capture_output=True,
            text=True,
            check=True,
        )
        rows = [tuple(map(int, line.split())) for line in child.stdout.splitlines()]
        found = dict(zip(FAULTS, rows, strict=True))
        calls, failed, unequal = found["none"]
        assert calls > 80
        assert (failed, unequal) == (0, 0)
        calls, failed, unequal = found["the wrong order"]
        assert failed > 0
        assert unequal == 0
        assert found["the wrong order, no check"][2] > 0
        assert found["no flips"][2] > 0


def added_work(name: str, n: int) -> float:
    """Predicates a vertex that the segment asked for, beyond those of the points."""
    points = crossing_case(name, n, 1)
    with_segment, without = divided(points).work, delaunay(points).work
    counts = [sum(work.orient2d.values()) + sum(work.incircle.values()) for work in (with_segment, without)]
    return (counts[0] - counts[1]) / len(points)


_MOST = 80.0  # predicates a vertex: the patience of the search, then about a dozen of the insertion


@pytest.mark.compiled
@pytest.mark.obligation(
    "M5",
    "the work of a long segment grows linearly, counted in predicates",
    method="named cases",
    control_in="TestGrowthOfSearch",
)
@pytest.mark.parametrize("name", NAMES)
class TestGrowth:
    """A segment that crosses the edges of n vertices asks at most a constant number of predicates for each."""

    @pytest.mark.parametrize("n", [300, 3000, 30000])
    def test_linear(self, name: str, n: int) -> None:
        assert added_work(name, n) < _MOST


SEARCH_ONLY = """
from proofs_tests.mesh.test_cavity import CAVITY, added_work

CAVITY._PATIENCE = 1 << 20
print(added_work("parabola", 200), added_work("parabola", 400))
"""


@pytest.mark.once
class TestGrowthOfSearch:
    """The count sees what it should: by search alone the work a vertex doubles with the number of vertices."""

    def test_control_search_is_quadratic(self) -> None:
        """Cavities filled by search alone: the work a vertex doubles with the number of vertices."""
        child = subprocess.run(
            [sys.executable, "-c", SEARCH_ONLY],
            env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
            cwd=Path(__file__).parents[2],
            capture_output=True,
            text=True,
            check=True,
        )
        few, many = map(float, child.stdout.split())
        assert many > _MOST
        assert 1.8 * few < many < 2.2 * few
