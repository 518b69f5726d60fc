"""Small inputs of every family: the library and brute force in integers give the same answers."""

import os
import subprocess
import sys
from collections.abc import Callable
from fractions import Fraction
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from hypothesis import strategies as st
from proofs_tests import oracles
from proofs_tests.differential import triangulating
from proofs_tests.differential.comparing import disagreements
from proofs_tests.differential.drawing import Drawer, NotUnderstoodError
from proofs_tests.differential.families import FAMILIES, drawn, named
from proofs_tests.differential.reducing import code_of, reduced
from proofs_tests.differential.running import compared, portions, smallest
from proofs_tests.differential.table import Table, sign
from proofs_tests.kernel import oracle as kernel_oracle
from proofs_tests.mesh import constrained_oracle
from proofs_tests.mesh import oracle as mesh_oracle

from exactkernel.jit import COMPILED
from exactmesh import PSLG, strategies

#: Of the million that ``python -m proofs_tests.differential`` compares, with another seed.
SAMPLE = 5000 if COMPILED else 300

FAULTY = """
import numpy as np
from exactkernel.incircle import incircle_adaptive
from exactmesh.verify.properties import Verdict
from exactmesh.verify.report import Finding
from proofs_tests.differential.running import compared
from proofs_tests.differential.test_differential import FAULTS, first_found, modules

sound = {name: dict(vars(module)) for name, module in modules().items()}
for fault in FAULTS.values():
    for name, module in modules().items():
        vars(module).update(sound[name])
    exec(fault, {**globals(), **modules()})
    print(first_found())
"""

HOLDS = "lambda *a: Finding(Verdict.HOLDS)"
FAULTS = {
    "none": "",
    "Delaunay: ties are left as they are": "delaunay.incircle_perturbed_adaptive = incircle_adaptive",
    "Delaunay: edges of the hull are never flipped": "conflict = delaunay.in_conflict; "
    "delaunay.in_conflict = lambda k, xy, g, *abcp: g not in abcp and conflict(k, xy, g, *abcp)",
    "orient2d in doubles": "batch.orient2d_adaptive = lambda k, ax, ay, bx, by, cx, cy: "
    "np.sign((ax - cx) * (by - cy) - (ay - cy) * (bx - cx))",
    "incircle: what is nearly on the circle is on it": "batch.incircle_adaptive = lambda k, *a: "
    "0 if abs(np.linalg.det([(x, y, x * x + y * y, 1) for x, y in zip(a[::2], a[1::2])])) < 1e-9 "
    "else incircle_adaptive(k, *a)",
    "constrained: cavities are filled without regard to circles": "cavity.conflict = lambda *a: False",
    "constrained: of several crossings one is told": "pairs = constrain.crossing_pairs; "
    "constrain.crossing_pairs = lambda *a, **k: pairs(*a, **k)[:1]",
    "carving: holes are not dug": "regions.flood_from = lambda *a: None",
    "carving: a ring in a ring is no hole": "regions.separations = lambda n, odd, label, stack: label.fill(0)",
    "verifier: the hull is taken on trust": f"deciding.check_hull = {HOLDS}",
    "verifier: fans are not walked round": f"deciding.check_fans = {HOLDS}",
    "verifier: the boundary is taken for convex": "deciding.convex_cycle = lambda *a: np.zeros(0, dtype=np.int32)",
    "verifier: edges may occur twice": f"deciding.check_overlap = {HOLDS}",
}


def modules() -> dict[str, object]:
    """Where faults are seeded."""
    from exactkernel import batch
    from exactmesh import cavity, constrain, regions
    from exactmesh.verify import deciding

    named_like_functions = {"delaunay": sys.modules["exactmesh.delaunay"]}
    rooms = {"batch": batch, "cavity": cavity, "constrain": constrain, "regions": regions, "deciding": deciding}
    return {**named_like_functions, **rooms}


def first_found(most: int = 1200) -> int:
    """Return how many inputs it took to find a disagreement, or -1."""
    for number in range(most):
        if compared(1, range(number, number + 1)).disagreements:
            return number + 1
    return -1


@pytest.mark.obligation(
    "J2", "predicates, triangulations, carving and verdicts equal brute force on small inputs of every family",
    method="differential",
)  # fmt: skip
class TestSample:
    """On every input of a sample of all families, the answers of the library are those of brute force in integers:
    each orientation and incircle test, the triangulations, what crosses, the domain, the verifier's verdicts."""

    def test_sample(self, record_property: Callable[[str, object], None]) -> None:
        portion = compared(1, range(SAMPLE))
        record_property("cases", portion.inputs.total())
        assert set(portion.inputs) == set(FAMILIES)
        assert not portion.disagreements

    def test_control_seeded_faults_are_found(self) -> None:
        """Twelve faults, of ties, hulls, filters, cavities, crossings, holes, parity and four of the verifier."""
        child = subprocess.run(
            [sys.executable, "-c", FAULTY],
            env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
            cwd=Path(__file__).parents[2],
            capture_output=True,
            text=True,
            check=True,
        )
        found = dict(zip(FAULTS, map(int, child.stdout.split()), strict=True))
        assert {fault for fault, inputs in found.items() if inputs < 0} == {"none"}


class TestBruteForce:
    """Brute force itself: its signs and triangles are those of the definitions in fractions, by other oracles."""

    @pytest.mark.parametrize("family", [family for family in FAMILIES if family.endswith("_points")])
    def test_points(self, family: str) -> None:
        for number in range(6):
            points = np.asarray(drawn(family, 5, number))[:6]
            table, exact = Table(points.tolist()), sorted(set(oracles.rationals(points.tolist())))
            for t in combinations(range(len(exact)), 3):
                assert sign(table.twice[t[0]][t[1]][t[2]]) == sign_of(oracles.orient(*(exact[v] for v in t)))
            for four in list(combinations(range(len(exact)), 4))[:4]:
                a, b, c, d = (exact[v] for v in four[::-1])
                expected = kernel_oracle.incircle(a, b, c, d), kernel_oracle.incircle_perturbed(a, b, c, d)
                assert table.incircle(*four[::-1]) == expected
            own = {tuple(sorted(t)) for t in mesh_oracle.delaunay_triangles(exact)}
            assert triangulating.delaunay(table) == own

    @pytest.mark.parametrize("family", ["polygons", "slits", "t_junctions", "shared_borders", "polygons_with_holes"])
    def test_graphs(self, family: str) -> None:
        for number in range(4):
            graph = drawn(family, 5, number)
            assert isinstance(graph, PSLG)
            table, exact = Table(graph.points.tolist()), sorted(set(oracles.rationals(graph.points.tolist())))
            ends = [(table.rank[a], table.rank[b]) for a, b in graph.segments.tolist()]
            fixed = {piece for chain in triangulating.pieces_of(table, ends) for piece in chain}
            own = {tuple(sorted(t)) for t in constrained_oracle.constrained_triangles(exact, ends)}
            assert triangulating.constrained(table, fixed) == own


def sign_of(value: Fraction) -> int:
    return (value > 0) - (value < 0)


class TestDrawing:
    """Inputs are those of hypothesis' strategies, the same for the same numbers; what is not understood is refused."""

    def test_the_same_again(self) -> None:
        for number in range(2 * len(FAMILIES)):
            assert code_of(named(3, number)[1]) == code_of(named(3, number)[1])

    def test_others_for_other_numbers(self) -> None:
        for family in FAMILIES:
            assert len({code_of(drawn(family, 0, number)) for number in range(20)}) > 5

    def test_every_family_is_among_them(self) -> None:
        offered = {name for name in strategies.__all__ if name.islower()}
        assert offered - set(FAMILIES) == {"corrupt", "points", "pslgs", "quadedges"}

    def test_control_another_kind_of_strategy(self) -> None:
        """A strategy that no family uses is refused, not passed over."""
        with pytest.raises(NotUnderstoodError, match="TupleStrategy"):
            Drawer(0)(st.tuples(st.just(1)))


class TestCommand:
    """Portions add up, whatever the number of processes; a disagreement is told by its smallest input."""

    def test_portions(self) -> None:
        inputs = sum((portion.inputs for portion in portions(0, 45, 1)), start=compared(0, range(0)).inputs)
        assert inputs.total() == 45

    def test_control_a_disagreement_is_reduced(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """A fault in brute force: no triangles at all. What is left of the smallest input is one triangle."""
        monkeypatch.setattr(triangulating, "delaunay", lambda _: set())
        portion = compared(0, range(4))
        assert portion.disagreements
        one, given = smallest(portion.disagreements)
        assert one.family.endswith("_points")
        assert len(np.asarray(given)) == 3

    def test_reduced_graphs_lose_segments(self) -> None:
        graph = drawn("polygons", 0, 3)
        left = reduced(graph, lambda given: isinstance(given, PSLG) and len(given.segments) > 1)
        assert isinstance(left, PSLG)
        assert len(left.segments) == 2
        assert not disagreements(graph)
