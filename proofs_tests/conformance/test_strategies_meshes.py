"""Public strategies for triangulations, sound and corrupted, and for edge structures."""

from typing import TypeVar

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, find, given, settings
from hypothesis import strategies as st
from proofs_tests import oracles
from proofs_tests.verify.test_corrupted import KINDS, reason_faults

from exactmesh import QuadEdge, strategies, verify
from exactmesh.errors import OptionError
from exactmesh.strategies import Corrupted, Corruption, PlainMesh, corrupt
from exactmesh.verify import Property, Verdict

pytestmark = pytest.mark.once


T = TypeVar("T")
quiet = settings(
    max_examples=30, deadline=None, database=None, derandomize=True, suppress_health_check=list(HealthCheck)
)
SQUARE = PlainMesh(
    np.array([(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]), np.array([(0, 1, 2), (0, 2, 3)], dtype=np.int32)
)


def drawn(strategy: st.SearchStrategy[T], count: int = 60) -> list[T]:
    found: list[T] = []

    @settings(quiet, max_examples=count)
    @given(strategy)
    def collect(value: T) -> None:
        found.append(value)

    collect()
    return found


def anything(_: object) -> bool:
    return True


def rows_of(mesh: PlainMesh) -> list[tuple[int, int, int]]:
    return [(a, b, c) for a, b, c in mesh.triangles.tolist()]


class TestTriangulations:
    """What is drawn is a triangulation by brute force: counterclockwise, admissible, of the hull, of all points; and
    Delaunay if that is asked for, only."""

    @pytest.mark.parametrize("delaunay", [False, True])
    def test_they_are_right(self, delaunay: bool) -> None:
        are_delaunay = set()
        for mesh in drawn(strategies.triangulations(max_size=9, delaunay=delaunay)):
            exact, rows = oracles.rationals(mesh.points.tolist()), rows_of(mesh)
            assert all(oracles.orient(*(exact[v] for v in t)) > 0 for t in rows)
            assert oracles.is_admissible(exact, rows)
            assert oracles.covers_hull(exact, rows)
            assert {v for t in rows for v in t} == set(range(len(exact)))
            are_delaunay.add(oracles.is_delaunay(exact, rows))
        assert are_delaunay == {True} if delaunay else {True, False}

    @pytest.mark.parametrize("sizes", [(3, 3), (0, 4), (20, 25)], ids=str)
    def test_sizes(self, sizes: tuple[int, int]) -> None:
        low, high = sizes
        meshes = drawn(strategies.triangulations(min_size=low, max_size=high), 25)
        assert {len(mesh.points) for mesh in meshes} <= set(range(max(3, low), high + 1))
        assert all(mesh.points.dtype == np.float64 and mesh.triangles.dtype == np.int32 for mesh in meshes)
        with pytest.raises(OptionError, match="3 points are needed"):
            strategies.triangulations(min_size=0, max_size=2)

    def test_the_simplest(self) -> None:
        mesh = find(strategies.triangulations(), anything, settings=quiet)
        assert (mesh.points.tolist(), rows_of(mesh)) == ([[0, 0], [2, 0], [0, 2]], [(2, 0, 1)])


@pytest.mark.obligation("S1", "each corruption breaks what it says", method="property-based")
class TestCorruptions:
    """Each corruption breaks what it says, can be placed where there is room for it, and changes nothing that it was
    given."""

    def test_any_kind(self) -> None:
        assert len({mesh.corruption for mesh in drawn(strategies.corrupted_triangulations(max_size=8), 100)}) > 12

    def test_all_but_the_legal_ones_say_what_they_break(self) -> None:
        silent = {kind for kind in Corruption if kind.breaks is None}
        assert silent == {Corruption.SHIFTED, Corruption.COCIRCULAR_SWAP}
        assert set(KINDS) == set(Corruption) - silent

    @pytest.mark.parametrize("kind", Corruption)
    def test_one_kind(self, kind: Corruption) -> None:
        for mesh in drawn(strategies.corrupted_triangulations(max_size=7, corruption=kind.value), 10):
            assert mesh.corruption is kind
            report = verify(mesh.points, mesh.triangles, segments=mesh.segments, labels=mesh.labels)
            assert not reason_faults(kind, report)

    def test_places(self) -> None:
        """Different numbers choose different places, and every place is chosen."""
        told = {tuple(map(tuple, corrupt(SQUARE, "dropped", i).triangles.tolist())) for i in range(5)}
        assert told == {((0, 1, 2),), ((0, 2, 3),)}

    def test_a_legal_swap(self) -> None:
        swapped = corrupt(SQUARE, Corruption.COCIRCULAR_SWAP)
        assert {frozenset(t) for t in swapped.triangles.tolist()} == {frozenset((0, 1, 3)), frozenset((1, 2, 3))}
        assert verify(swapped.points, swapped.triangles).ok

    def test_control_a_sound_mesh_has_no_fault(self) -> None:
        """A sound mesh: no corruption is seen in it."""
        report = verify(*SQUARE)
        assert report.ok
        assert all(reason_faults(kind, report) for kind in Corruption if kind.breaks in report.findings)

    @pytest.mark.parametrize("kind", Corruption)
    def test_what_is_given_stays(self, kind: Corruption) -> None:
        mesh = PlainMesh(SQUARE.points.copy(), SQUARE.triangles.copy())
        for array in mesh:
            array.flags.writeable = False
        try:
            corrupt(mesh, kind, 5)
        except OptionError as error:
            assert f"no place for {kind}" in str(error)  # noqa: PT017  # there is none in so small a mesh
        assert np.array_equal(mesh.points, SQUARE.points)
        assert np.array_equal(mesh.triangles, SQUARE.triangles)

    def test_bad_arguments(self) -> None:
        with pytest.raises(OptionError, match="'holed' is no corruption; choose from flipped, swapped"):
            corrupt(SQUARE, "holed")
        with pytest.raises(OptionError, match="corruption='holed'"):
            strategies.corrupted_triangulations(corruption="holed")
        with pytest.raises(OptionError, match="no place for pinched in a mesh of 2 triangles"):
            corrupt(SQUARE, "pinched")

    def test_shrinking(self) -> None:
        def is_overlap(mesh: Corrupted) -> bool:
            return verify(mesh.points, mesh.triangles).verdict(Property.ADMISSIBLE) is Verdict.FAILS

        mesh = find(strategies.corrupted_triangulations(), is_overlap, settings=quiet)
        assert len(mesh.points) <= 5


def state_of(structure: QuadEdge) -> tuple[int, ...]:
    return tuple(edge.onext.index for end in structure.edges() for edge in (end, end.sym))


class TestQuadEdges:
    """Every edge algebra that splices lead to is drawn: (2k)! states of k edges, each with its axioms."""

    @pytest.mark.parametrize(("edges", "states"), [(0, 1), (1, 2), (2, 24)])
    def test_every_state(self, edges: int, states: int) -> None:
        structures = drawn(strategies.quadedges(min_size=edges, max_size=edges), 800 if edges == 2 else 30)
        assert {len(structure) for structure in structures} == {edges}
        for structure in structures:
            structure.check()
        assert len({state_of(structure) for structure in structures}) == states

    def test_euler(self) -> None:
        """Of a connected structure V - E + F = 2 - 2 g; spheres and tori are drawn."""
        genera = set()
        for structure in drawn(strategies.quadedges(min_size=1, max_size=8), 300):
            vertices, edges, faces = structure.counts()
            if is_connected(structure):
                assert (vertices - edges + faces) % 2 == 0
                genera.add(1 - (vertices - edges + faces) // 2)
        assert {0, 1} <= genera
        assert min(genera) == 0

    def test_shrinking(self) -> None:
        assert len(find(strategies.quadedges(), anything, settings=quiet)) == 1
        torus = find(
            strategies.quadedges(),
            lambda s: is_connected(s) and s.counts()[0] - s.counts()[1] + s.counts()[2] == 0,
            settings=settings(quiet, max_examples=2000, phases=(Phase.generate, Phase.shrink)),
        )
        assert torus.counts() in ((1, 2, 1), (2, 3, 1))


def is_connected(structure: QuadEdge) -> bool:
    ends = {end.index: end for edge in structure.edges() for end in (edge, edge.sym)}
    reached, left = set(), [min(ends)]
    while left:
        index = left.pop()
        if index not in reached:
            reached.add(index)
            left += [ends[index].sym.index, ends[index].onext.index]
    return len(reached) == len(ends)
