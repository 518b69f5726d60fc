"""M1: the edge algebra, on every state that splices reach; the typed quad-edge against a model."""

import re
import sys
from collections.abc import Iterator
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from _pytest.outcomes import Failed
from hypothesis import Phase, settings
from hypothesis.stateful import run_state_machine_as_test
from mypy import api as mypy
from proofs_tests.mesh.enumeration import grid, primal_permutations, reachable_states, triangulations
from proofs_tests.mesh.surgery import Surgery
from proofs_tests.recording import Record

from exactkernel.jit import COMPILED
from exactkernel.types import IntArray
from exactmesh import Edge, Face, Primal, QuadEdge, QuarterEdge, Vertex
from exactmesh import edgealgebra as algebra
from exactmesh.connectivity import neighbors_of, rings_of
from exactmesh.edgealgebra import EdgeArray
from exactmesh.errors import ShapeError, TopologyError
from exactmesh.ids import OUTSIDE
from exactmesh.quadedge import NO_VERTEX, Kind

Permutation = list[int]


def inverse(permutation: Permutation) -> Permutation:
    result = [0] * len(permutation)
    for q, after in enumerate(permutation):
        result[after] = q
    return result


def cycles(permutation: Permutation, start: Iterator[int] | range) -> list[set[int]]:
    """Return the cycles of a permutation, by walking each."""
    found: list[set[int]] = []
    for q in start:
        if not any(q in cycle for cycle in found):
            cycle = [q]
            while permutation[cycle[-1]] != q:
                cycle.append(permutation[cycle[-1]])
            found.append(set(cycle))
    return found


def components(permutation: Permutation) -> list[set[int]]:
    """Return the sets of primal quarter-edges that onext and sym connect."""
    pieces = [{q, q ^ 2} for q in range(0, len(permutation), 4)]
    for ring in cycles(permutation, range(0, len(permutation), 2)):
        touched = [piece for piece in pieces if piece & ring]
        pieces = [piece for piece in pieces if not piece & ring] + [set().union(*touched)]
    return pieces


def left_faces(onext: Permutation) -> list[set[int]]:
    """The cycles of lnext, by its definition without the dual: go to the end, turn clockwise."""
    oprev = inverse(onext)
    lnext = [oprev[q ^ 2] for q in range(len(onext))]
    return cycles(lnext, range(0, len(onext), 2))


@pytest.fixture(scope="module")
def states() -> list[IntArray]:
    """Every reachable ring of 1, 2, 3 and, compiled, 4 edges."""
    return [reachable_states(k) for k in range(1, 5 if COMPILED else 4)]


@pytest.mark.obligation(
    "M1",
    "every reachable state of at most four edges is a subdivision of orientable surfaces (Euler)",
    method="exhaustive",
)
class TestEveryState:
    """From k isolated edges splices reach (2k)! states: every permutation of the primal quarter-edges as onext, each
    with its one dual. Every one is a subdivision of closed orientable surfaces: V - E + F = 2 - 2 genus."""

    def test_published_counts(self, states: list[IntArray]) -> None:
        counts = [2, 24, 720, 40320][: len(states)]
        assert [len(found) for found in states] == counts
        assert [len(primal_permutations(found)) for found in states] == counts

    def test_axioms_and_counts(self, states: list[IntArray], record_property: Record) -> None:
        for ring in (ring for found in states for ring in found):
            labels = np.zeros(len(ring) // 2, dtype=np.int32)
            surface = QuadEdge.from_arrays(ring, labels, labels.copy())  # checks the axioms
            onext = ring.tolist()
            vertices = len(cycles(onext, range(0, len(ring), 2)))
            assert surface.counts() == (vertices, len(ring) // 4, len(left_faces(onext)))
        record_property("cases", sum(map(len, states)))

    def test_euler(self, states: list[IntArray], record_property: Record) -> None:
        genera = set()
        for onext in (ring.tolist() for ring in states[2]):
            rings, faces = cycles(onext, range(0, len(onext), 2)), left_faces(onext)
            for piece in components(onext):
                v, f = sum(ring <= piece for ring in rings), sum(face <= piece for face in faces)
                twice_genus = 2 - (v - len(piece) // 2 + f)
                assert twice_genus >= 0
                assert twice_genus % 2 == 0
                genera.add(twice_genus // 2)
        assert genera == {0, 1}  # three edges make a torus, too
        record_property("cases", len(states[2]))

    def test_control_a_twisted_edge(self) -> None:
        """The ring of a twisted edge (onext leads to the same edge flipped over) is refused: nothing but orientable
        surfaces passes."""
        ring = np.array([0, 1, 2, 3], dtype=np.int32)  # the dual not turned: a projective plane has V - E + F = 1
        labels = np.zeros(2, dtype=np.int32)
        with pytest.raises(TopologyError):
            QuadEdge.from_arrays(ring, labels, labels.copy())


@pytest.mark.obligation(
    "M1", "rot^4 = e, and every operator is what its definition says, in every state", method="exhaustive"
)
class TestOperators:
    """rot has order four, sym is its square, and each operator is what it is without the dual: with oprev the inverse
    of onext, lnext = oprev sym, dnext = sym onext sym, and so on; each next is the inverse of its prev."""

    @pytest.mark.parametrize("k", [1, 2, 3])
    def test_definitions(self, k: int, states: list[IntArray], record_property: Record) -> None:
        for ring in states[k - 1]:
            onext = ring.tolist()
            oprev = inverse(onext)
            for q in range(4 * k):
                expected = {
                    algebra.onext: onext[q],
                    algebra.oprev: oprev[q],
                    algebra.lnext: oprev[q ^ 2],
                    algebra.lprev: onext[q] ^ 2,
                    algebra.rnext: oprev[q] ^ 2,
                    algebra.rprev: onext[q ^ 2],
                    algebra.dnext: onext[q ^ 2] ^ 2,
                    algebra.dprev: oprev[q ^ 2] ^ 2,
                }
                assert {operator: operator(ring, q) for operator in expected} == expected
                if q % 2 == 0:
                    assert algebra.left_next(ring, q) == oprev[q ^ 2]
        record_property("cases", len(states[k - 1]) * 4 * k)

    def test_turns(self) -> None:
        for q in range(16):
            half = algebra.rot(algebra.rot(q))
            assert half == algebra.sym(q) == q ^ 2
            assert algebra.rot(algebra.rot(half)) == q
            assert algebra.inv_rot(algebra.rot(q)) == algebra.rot(algebra.inv_rot(q)) == q
            assert algebra.rot(q) // 4 == q // 4
            assert (algebra.rot(q) - q) % 4 == 1

    def test_handles_follow_the_operators(self) -> None:
        surface = QuadEdge.from_triangles([(0, 1, 2), (0, 2, 3)])
        ring = surface.ring_of(QuarterEdge(0))
        for edge in surface.edges():
            for handle in (edge, edge.sym):
                for name in ("onext", "oprev", "dnext", "dprev", "lnext", "lprev", "rnext", "rprev"):
                    assert getattr(handle, name).index == getattr(algebra, name)(ring, handle.index)
                    assert getattr(handle.rot, name).index == getattr(algebra, name)(ring, handle.rot.index)
                assert handle.rot.inv_rot == handle.inv_rot.rot == handle
                assert handle.rot.rot == handle.sym
                assert (handle.rot.org, handle.rot.dest) == (handle.right, handle.left)
                assert (handle.rot.right, handle.rot.left) == (handle.dest, handle.org)
                assert {e.org for e in handle.orbit()} == {handle.org}
                assert {e.left for e in handle.face()} == {handle.left}

    @pytest.mark.parametrize(("name", "wrong"), [("lnext", "rnext"), ("oprev", "onext"), ("dnext", "lprev")])
    def test_control_operators_mistaken(
        self, name: str, wrong: str, states: list[IntArray], monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """One operator taken for another."""
        other = getattr(algebra, wrong)
        monkeypatch.setattr(algebra, name, lambda ring, q: other(ring, q))
        with pytest.raises(AssertionError):
            self.test_definitions(2, states, print)


@pytest.mark.obligation(
    "M1", "splice is an involution that joins or cuts one origin and one left face", method="exhaustive"
)
class TestSplice:
    """Splice is its own inverse; it joins two origins or cuts one, and the same with the left faces."""

    @pytest.mark.parametrize("k", [1, 2, 3])
    def test_involution(self, k: int, states: list[IntArray], record_property: Record) -> None:
        tried = 0
        for ring in states[k - 1]:
            onext = ring.tolist()
            rings, faces = cycles(onext, range(0, 4 * k, 2)), left_faces(onext)
            for a, b in combinations(range(0, 4 * k, 2), 2):
                after = ring.copy()
                algebra.splice(after, a, b)
                same_origin = any({a, b} <= cycle for cycle in rings)
                same_face = any({a, b} <= cycle for cycle in faces)
                assert len(cycles(after.tolist(), range(0, 4 * k, 2))) == len(rings) + (1 if same_origin else -1)
                assert len(left_faces(after.tolist())) == len(faces) + (1 if same_face else -1)
                assert not any(breaks_axioms(after.tolist(), q) for q in range(4 * k))
                algebra.splice(after, a, b)
                assert (after == ring).all()
                tried += 1
        record_property("cases", tried)

    def test_primal_with_dual_is_refused(self) -> None:
        surface = QuadEdge()
        edge = surface.make_edge()
        dual: Edge[Primal] = Edge(surface, edge.rot.index)  # a handle that lies about its kind
        for operation in (lambda: surface.splice(edge, dual), lambda: surface.connect(edge, dual)):
            with pytest.raises(TopologyError):
                operation()
        for method in (surface.delete_edge, surface.swap, lambda e: surface.set_org(e, Vertex(0))):
            with pytest.raises(TopologyError):
                method(dual)
        surface.check()

    def test_control_the_dual_left_alone(self, states: list[IntArray], monkeypatch: pytest.MonkeyPatch) -> None:
        """A splice of the primal rings only."""

        def primal_only(ring: IntArray, a: int, b: int) -> None:
            ring[a], ring[b] = ring[b], ring[a]

        monkeypatch.setattr(algebra, "splice", primal_only)
        with pytest.raises(AssertionError):
            self.test_involution(2, states, print)


def breaks_axioms(ring: Permutation, q: int) -> bool:
    """Whether onext of q leaves the edges, mixes primal with dual, or e rot onext rot onext differs from e."""
    after = ring[q]
    if not 0 <= after < len(ring) or (after - q) % 2:
        return True
    turned = after // 4 * 4 + (after + 1) % 4
    back = ring[turned]
    return back // 4 * 4 + (back + 1) % 4 != q


@pytest.mark.obligation(
    "M1", "check accepts just the edge algebras and names the quarter-edge that breaks an axiom", method="corruption"
)
class TestCheck:
    """check() accepts the states above and names the first quarter-edge that breaks an axiom in any other."""

    def test_control_every_corruption(self, states: list[IntArray], record_property: Record) -> None:
        """Every entry of every state replaced by every other value, holes and out of range included."""
        labels = np.zeros(4, dtype=np.int32)
        tried = 0
        for ring in states[1]:
            for q in range(len(ring)):
                for wrong in (value for value in range(-2, len(ring) + 2) if value != ring[q]):
                    corrupt = ring.copy()
                    corrupt[q] = wrong
                    tried += 1
                    with pytest.raises(TopologyError, match=r"quarter-edge \d+") as raised:
                        QuadEdge.from_arrays(corrupt, labels, labels.copy())
                    entries = corrupt.tolist()
                    named = raised.value.indices[0]
                    if -1 not in entries:
                        assert named == next(q for q in range(len(entries)) if breaks_axioms(entries, q))
                    else:  # a hole: whoever leads there, or lies beside it
                        assert breaks_axioms(entries, named) or entries[named] == -1 or entries[entries[named]] == -1
        record_property("cases", tried)


def small_surfaces() -> Iterator[QuadEdge]:
    for triangles in triangulations(grid(3, 3)):
        yield QuadEdge.from_triangles(triangles)


def copied(surface: QuadEdge) -> QuadEdge:
    """Return an equal quad-edge, for triangulations that fill their arrays."""
    edges = [*surface.edges()]
    ring = surface.ring_of(QuarterEdge(0)).copy()
    vertex, face = np.empty(len(ring) // 2, dtype=np.int32), np.empty(len(ring) // 2, dtype=np.int32)
    for edge in edges:
        for e in (edge, edge.sym):
            vertex[e.index >> 1] = e.org
            face[e.rot.index >> 1] = e.rot.org
    return QuadEdge.from_arrays(ring, vertex, face)


def origins(surface: QuadEdge) -> list[tuple[int, int]]:
    return [(edge.org, edge.dest) for edge in surface.edges()]


def swap_by_splices(surface: QuadEdge, e: Edge[Primal]) -> None:
    """Guibas and Stolfi's definition, word for word."""
    a, b = e.oprev, e.sym.oprev
    surface.splice(e, a)
    surface.splice(e.sym, b)
    surface.splice(e, a.lnext)
    surface.splice(e.sym, b.lnext)
    surface.set_org(e, a.dest)
    surface.set_org(e.sym, b.dest)


def inner_edges(surface: QuadEdge) -> list[QuarterEdge]:
    return [q.index for e in surface.edges() if OUTSIDE not in (e.left, e.right) for q in (e, e.sym)]


@pytest.mark.bounds
@pytest.mark.obligation(
    "M1", "swap, split_face, connect and delete_edge are what splices make of them", method="exhaustive"
)
class TestDerivedOperations:
    """swap, split_face and delete_edge are what make_edge and splice make of them, entry by entry."""

    def test_swap_is_four_splices(self) -> None:
        for surface in small_surfaces():
            for index in inner_edges(surface):
                ours, theirs = copied(surface), copied(surface)
                ours.swap(ours.edge(index))
                swap_by_splices(theirs, theirs.edge(index))
                assert (ours.ring_of(index) == theirs.ring_of(index)).all()
                assert origins(ours) == origins(theirs)
                ours.check()
                for e in ours.edges():
                    for side in (e, e.sym):
                        assert {f.left for f in side.face()} == {side.left}

    def test_control_a_wrong_swap_is_seen(self) -> None:
        """A swap twice, which turns the edge round."""
        surface = next(small_surfaces())
        index = inner_edges(surface)[0]
        ours, theirs = copied(surface), copied(surface)
        ours.swap(ours.edge(index))
        ours.swap(ours.edge(index))  # now it is the first edge backwards
        assert not (ours.ring_of(index) == theirs.ring_of(index)).all()
        assert ours.edge(index).org == theirs.edge(index).dest
        ours.swap(ours.edge(index))
        ours.swap(ours.edge(index))
        assert (ours.ring_of(index) == theirs.ring_of(index)).all()

    def test_swap_of_two_triangles_on_a_sphere(self) -> None:
        """The faces share all three edges; the swapped edge becomes a loop at the third vertex."""
        ours = QuadEdge.from_triangles([(0, 1, 2), (2, 1, 0)])
        theirs = copied(ours)
        ours.swap(ours.edge(0))
        swap_by_splices(theirs, theirs.edge(0))
        assert (ours.ring_of(QuarterEdge(0)) == theirs.ring_of(QuarterEdge(0))).all()
        assert ours.edge(0).org == ours.edge(0).dest
        ours.check()

    def test_swap_refuses_what_is_not_between_two_triangles(self) -> None:
        surface = QuadEdge.from_triangles([(0, 1, 2), (0, 2, 3)])
        before = surface.ring_of(QuarterEdge(0)).copy()
        for edge in surface.edges():
            if OUTSIDE in (edge.left, edge.right):
                with pytest.raises(TopologyError) as raised:
                    surface.swap(edge)
                assert raised.value.indices == (edge.index,)
        assert (surface.ring_of(QuarterEdge(0)) == before).all()

    def test_swap_refuses_one_triangle_on_both_sides(self) -> None:
        """A loop with an edge inside: the face e, e.sym, loop is a triangle and lies on both sides of e."""
        surface = QuadEdge()
        loop, e = surface.make_edge(Vertex(0), Vertex(0)), surface.make_edge(Vertex(0), Vertex(1))
        surface.splice(loop, loop.sym)
        surface.splice(loop, e)
        sides = [q for q in (e, e.sym) if q.lnext.lnext.lnext == q]
        assert len(sides) == 2
        with pytest.raises(TopologyError):
            surface.swap(e)
        surface.check()

    def test_split_face(self) -> None:
        triangles = np.array([(0, 1, 2), (0, 2, 3)], dtype=np.int32)
        for start in range(0, 20, 2):
            rings = rings_of(triangles, neighbors_of(triangles))
            surface = QuadEdge.from_arrays(*rings)
            e = surface.edge(start)
            if e.left == OUTSIDE:
                continue
            room = (
                np.concatenate([rings[0], np.empty(12, np.int32)]),
                np.concatenate([rings[1], np.empty(6, np.int32)]),
            )
            algebra.split_face(*room, start, 20, 4)
            corners = list(e.face())
            spokes = [surface.make_edge(Vertex(4), corner.org) for corner in corners]
            for corner, spoke, following in zip(corners, spokes, [None, *spokes], strict=False):
                if following is not None:
                    surface.splice(following, spoke)
                surface.splice(corner, spoke.sym)
            assert surface.ring_of(QuarterEdge(0))[:32].tolist() == room[0].tolist()
            assert [v for edge in surface.edges() for v in (edge.org, edge.dest)] == room[1].tolist()
            assert [edge.dest for edge in spokes[0].orbit()] == [corner.org for corner in corners]

    def test_delete_undoes_connect(self) -> None:
        for surface in small_surfaces():
            index = inner_edges(surface)[0]
            e = surface.edge(index)
            a, b = e.sym.lnext.lnext, e.lnext  # ends of the removed diagonal's quadrilateral
            surface.delete_edge(e)
            assert surface.counts()[1] == len(surface) == 15
            before = surface.ring_of(a.index).copy()
            new = surface.connect(b, a)
            assert (new.org, new.dest) == (b.dest, a.org)
            surface.delete_edge(new)
            assert (surface.ring_of(a.index) == before).all()
            surface.check()
            with pytest.raises(TopologyError, match="deleted"):
                _ = new.onext

    def test_a_loop_is_no_triangle(self) -> None:
        surface = QuadEdge()
        loop = surface.make_edge(Vertex(0), Vertex(0))
        surface.splice(loop, loop.sym)
        for side in (loop, loop.sym):
            surface.set_left(side, Face(0))
            assert [*side.face()] == [side]
        assert surface.triangles().shape == (0, 3)


def half_a_splice(ring: EdgeArray, a: int, b: int) -> None:
    """Exchange what follows a and b, and forget the dual."""
    ring[a], ring[b] = ring[b], ring[a]


class KeepsFaces(QuadEdge):
    """swap turns the edge and leaves the labels of the faces where they were."""

    def swap(self, edge: Edge[Primal]) -> None:
        before = self._face.copy()
        super().swap(edge)
        self._face[:] = before


class WrongCorner(QuadEdge):
    """connect begins at a, not at the edge after it."""

    def connect(self, a: Edge[Primal], b: Edge[Primal]) -> Edge[Primal]:
        self._own_primal(a, b)
        new = self.make_edge(a.dest, b.org)
        self.splice(new, a.sym)
        self.splice(new.sym, b)
        return new


class OneEnd(QuadEdge):
    """delete_edge takes the edge out at one end only."""

    def delete_edge(self, edge: Edge[Primal]) -> None:
        self._own_primal(edge)
        self.splice(edge, edge.oprev)
        q = edge.index & ~3
        self._ring[q : q + 4] = -1
        self._free.append(q)


class Remembers(QuadEdge):
    """make_edge gives an edge the faces of the deleted one whose place it takes."""

    def make_edge(self, org: Vertex = NO_VERTEX, dest: Vertex = NO_VERTEX) -> Edge[Primal]:
        before = self._face.copy()
        edge = super().make_edge(org, dest)
        q = edge.index >> 1
        if q < len(before):
            self._face[q : q + 2] = before[q : q + 2]
        return edge


class LooksLate(QuadEdge):
    """swap refuses what is no quadrilateral after it has relabelled it."""

    def swap(self, edge: Edge[Primal]) -> None:
        self._own_primal(edge)
        self._vertex[edge.index >> 1] += 1
        super().swap(edge)
        self._vertex[edge.index >> 1] -= 1


class AnyKind(QuadEdge):
    """splice takes a primal and a dual edge."""

    def splice(self, a: Edge[Kind], b: Edge[Kind]) -> None:
        self._own(a, b)
        algebra.splice(self._ring, a.index, b.index)


class Undead(QuadEdge):
    """Deleted edges are taken for living ones."""

    def ring_of(self, index: QuarterEdge) -> EdgeArray:
        if not 0 <= index < 4 * self._count:
            raise TopologyError(f"edge {index >> 2} does not exist")
        return self._ring


FAULTS = [KeepsFaces, WrongCorner, OneEnd, Remembers, LooksLate, AnyKind, Undead]
SEARCH = settings(
    max_examples=500,
    stateful_step_count=30,
    phases=[Phase.generate],
    print_blob=False,
    report_multiple_bugs=False,
    derandomize=True,
)


def is_found() -> bool:
    """Tell whether the machine fails."""
    try:
        run_state_machine_as_test(Surgery, settings=SEARCH)
    except (AssertionError, TopologyError, IndexError, KeyError, Failed):
        return True
    return False


@pytest.mark.obligation("M1", "the quad-edge is a model of the algebra, step by step", method="stateful machine")
class TestSurgery:
    """After any sequence of operations, deletions included, the quad-edge is its model with its labels and an edge
    algebra, every piece of it a closed orientable surface; an illegal call raises TopologyError and changes nothing."""

    def test_any_sequence(self) -> None:
        steps = 120 if COMPILED else 60
        run_state_machine_as_test(Surgery, settings=settings(max_examples=steps, stateful_step_count=30))

    @pytest.mark.parametrize("fault", FAULTS)
    def test_control_a_faulty_operation_is_found(self, fault: type[QuadEdge], monkeypatch: pytest.MonkeyPatch) -> None:
        """One of seven operations has a fault: wrong corner, one end, stale labels, a late or a missing refusal."""
        monkeypatch.setattr(Surgery, "Surface", fault)
        assert is_found()

    def test_control_a_splice_without_the_dual_is_found(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """splice exchanges the primal rings and forgets the dual ones."""
        monkeypatch.setattr(algebra, "splice", half_a_splice)
        assert is_found()

    def test_control_corrupt_ring(self) -> None:
        """One entry of the ring is another."""
        machine = Surgery()
        machine.make(0, 1)
        machine.is_the_model()
        machine.surface.ring_of(QuarterEdge(0))[0] = 2
        for check in (machine.is_an_edge_algebra, machine.is_the_model):
            with pytest.raises((AssertionError, TopologyError)):
                check()


@pytest.mark.bounds
@pytest.mark.obligation(
    "M1", "triangles to quad-edge and back is the identity; anything else is refused", method="enumeration"
)
class TestFromTriangles:
    """from_triangles and triangles are inverse to each other; what is no triangulation is refused, not walked into."""

    def test_round_trip(self) -> None:
        for triangles in triangulations(grid(3, 3)):
            surface = QuadEdge.from_triangles(triangles)
            assert {frozenset(row) for row in surface.triangles().tolist()} == {frozenset(t) for t in triangles}
            vertices, edges, faces = surface.counts()
            assert (vertices, faces, vertices - edges + faces) == (9, len(triangles) + 1, 2)
            assert [e.dest for e in next(e for e in surface.edges() if e.left == OUTSIDE or e.right == OUTSIDE).orbit()]

    def test_rows_are_faces(self) -> None:
        rows = [(0, 1, 2), (0, 2, 3)]
        for edge in QuadEdge.from_triangles(rows).edges():
            for side in (edge, edge.sym):
                corners = {e.org for e in side.face()}
                assert corners == ({0, 1, 2, 3} if side.left == OUTSIDE else set(rows[side.left]))

    @pytest.mark.parametrize(
        ("triangles", "culprits"),
        [
            ([(0, 1, 2), (-1, 2, 1)], (1,)),
            ([(0, 1, 2), (1, 1, 0)], (1,)),
            ([(0, 1, 2), (0, 1, 3)], (0, 1)),
            ([(0, 1, 2), (0, 1, 2)], (0, 1)),
        ],
    )
    def test_control_bad_corners(self, triangles: list[tuple[int, int, int]], culprits: tuple[int, ...]) -> None:
        """Corners out of range or repeated, an edge used twice in one direction, a triangle twice."""
        with pytest.raises(TopologyError) as raised:
            QuadEdge.from_triangles(triangles)
        assert raised.value.indices == culprits

    @pytest.mark.parametrize("entry", [0, 1, 2, -2])
    def test_control_bad_neighbors(self, entry: int) -> None:
        """Every entry of the neighbors replaced by every other one; a row missing."""
        triangles = [(0, 1, 2), (0, 2, 3)]
        good = np.array([(-1, 1, -1), (-1, -1, 0)], dtype=np.int32)
        assert len(QuadEdge.from_triangles(triangles, good)) == 5
        with pytest.raises(TopologyError, match="1 rows of neighbors for 2"):
            QuadEdge.from_triangles(triangles, good[:1])
        for place in np.ndindex(2, 3):
            bad = good.copy()
            bad[place] = entry
            if entry != good[place]:
                with pytest.raises(TopologyError):
                    QuadEdge.from_triangles(triangles, bad)

    def test_bad_arrays(self) -> None:
        ring, vertex, face = rings_of(np.array([(0, 1, 2)], dtype=np.int32), np.full((1, 3), -1, dtype=np.int32))
        assert len(QuadEdge.from_arrays(ring, vertex, face)) == 3
        frozen = ring.copy()
        frozen.setflags(write=False)
        for wrong in (ring.astype(np.int64), ring.reshape(3, 4), np.repeat(ring, 2)[::2], frozen, ring.tolist()):
            with pytest.raises(ShapeError, match="ring"):
                QuadEdge.from_arrays(wrong, vertex, face)  # type: ignore[arg-type]  # that is the point
        with pytest.raises(TopologyError):
            QuadEdge.from_arrays(ring[:8], vertex, face)

    def test_deleted_edges_stay_deleted(self) -> None:
        surface = QuadEdge.from_triangles([(0, 1, 2), (0, 2, 3)])
        surface.delete_edge(surface.edge(4))
        ring = surface.ring_of(QuarterEdge(0))
        again = QuadEdge.from_arrays(ring, np.zeros(10, np.int32), np.zeros(10, np.int32))
        assert len(again) == len([*again.edges()]) == 4
        assert again.make_edge().index == 4

    def test_empty_grows(self) -> None:
        surface = QuadEdge.from_triangles(np.empty((0, 3), dtype=np.int64))
        assert surface.counts() == (0, 0, 0)
        for edges in range(1, 10):
            surface.make_edge()
            assert surface.counts() == (2 * edges, edges, edges)

    def test_full(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(sys.modules["exactmesh.quadedge"], "MAX_EDGES", 4)
        surface = QuadEdge(capacity=1)
        for _ in range(4):
            surface.make_edge()
        with pytest.raises(TopologyError, match="at most 4"):
            surface.make_edge()
        assert len(surface) == 4
        surface.check()

    def test_strangers(self) -> None:
        ours, theirs = QuadEdge(), QuadEdge()
        for wrong in (2**31, -(2**31) - 1, 2**70):
            with pytest.raises(TopologyError, match="32 bits"):
                ours.make_edge(Vertex(wrong))
        assert len(ours) == 0
        with pytest.raises(TopologyError, match="another"):
            ours.splice(ours.make_edge(), theirs.make_edge())
        for index in (1, -2, 4, 10**9):
            with pytest.raises(TopologyError):
                ours.edge(index)


SNIPPET = """\
from exactmesh import Dual, Edge, Face, Primal, QuadEdge, Vertex

surface = QuadEdge()
edge: Edge[Primal] = surface.make_edge(Vertex(0), Vertex(1))
dual: Edge[Dual] = edge.rot
same: Edge[Primal] = edge.rot.rot.onext.lnext
start: Vertex = edge.org
left: Face = edge.rot.dest
right: Vertex = edge.rot.rot.dest
surface.splice(edge, edge.sym)
surface.splice(edge.rot, dual)
wrong_vertex: Vertex = edge.rot.org  # wrong
wrong_face: Face = edge.dest  # wrong
surface.splice(edge, edge.rot)  # wrong
surface.swap(edge.rot)  # wrong
surface.set_org(edge, edge.left)  # wrong
wrong_kind: Edge[Primal] = edge.inv_rot  # wrong
surface.connect(edge, edge.rot.onext)  # wrong
"""


@pytest.mark.obligation("M1", "primal and dual, vertices and faces are different types", method="named cases")
class TestTypedHandles:
    """To a type checker primal and dual edges, vertices and faces are different things: it rejects just the lines that
    mix them."""

    def test_control_mypy_rejects_just_the_wrong_lines(self, tmp_path: Path) -> None:
        """Lines that mix primal and dual, or vertices and faces."""
        script = tmp_path / "snippet.py"
        script.write_text(SNIPPET)
        root = Path(__file__).parents[2]
        options = ["--config-file", str(root / "pyproject.toml"), "--no-error-summary", "--hide-error-context"]
        output, errors, _ = mypy.run([*options, "--cache-dir", str(root / ".mypy_cache"), str(script)])
        assert not errors
        reported = {int(number) for number in re.findall(r"snippet\.py:(\d+): error:", output)}
        wrong = {number for number, line in enumerate(SNIPPET.splitlines(), 1) if line.endswith("# wrong")}
        assert reported == wrong, output


class TestPinchedTriangles:
    """Triangles that meet in a vertex without an edge between them are no surface that the rings could describe."""

    def test_refused(self) -> None:
        with pytest.raises(TopologyError, match="vertex 0 are pinched"):
            QuadEdge.from_triangles([(0, 1, 2), (0, 3, 4)])

    def test_repr_of_an_edge_names_its_ends(self) -> None:
        edge = next(QuadEdge.from_triangles([(0, 1, 2)]).edges())
        assert repr(edge) == f"Edge[Primal]({edge.org} -> {edge.dest})"
        assert repr(edge.rot) == f"Edge[Dual]({edge.right} -> {edge.left})"
