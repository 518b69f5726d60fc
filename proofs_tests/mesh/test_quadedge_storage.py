"""M1: what a quad-edge keeps of its edges, at every limit of its arrays; and what it says of edges that it has not."""

import sys
from collections.abc import Callable
from dataclasses import FrozenInstanceError
from itertools import product

import numpy as np
import pytest
from proofs_tests.mesh.enumeration import grid, reachable_states, triangulations

from exactmesh import Edge, Face, Primal, QuadEdge, QuarterEdge, Vertex
from exactmesh.errors import TopologyError
from exactmesh.ids import OUTSIDE

INT32 = range(-(2**31), 2**31)


@pytest.mark.obligation(
    "M1", "an edge keeps its four labels, whatever else is made or deleted", method="named cases", control_in="mutants"
)
class TestLabels:
    """Every int32 is a label, and no other integer; each edge keeps its two vertices and two faces while others are
    made, labelled and deleted, whatever the capacity; a new edge has the ends that were asked for and OUTSIDE twice."""

    @pytest.mark.parametrize("number", [-(2**31) - 1, -(2**31), -63, -62, -1, 0, 61, 62, 63, 2**31 - 1, 2**31])
    def test_every_int32(self, number: int) -> None:
        surface = QuadEdge()
        edge = surface.make_edge()
        operations: list[tuple[Callable[[], None], Callable[[], int]]] = [
            (lambda: surface.set_org(edge, Vertex(number)), lambda: edge.org),
            (lambda: surface.set_left(edge, Face(number)), lambda: edge.left),
            (lambda: surface.set_left(edge.sym, Face(number)), lambda: edge.right),
        ]
        for write, read in operations:
            if number in INT32:
                write()
                assert read() == number
            else:
                with pytest.raises(TopologyError, match=f"^{number} does not fit 32 bits$") as raised:
                    write()
                assert raised.value.indices == (number,)

    @pytest.mark.parametrize("capacity", [-1, 0, 1, 2, 3, 5, 16, 100])
    def test_any_capacity(self, capacity: int) -> None:
        surface = QuadEdge(capacity)
        for i in range(70):  # more than twice 29
            edge = surface.make_edge(Vertex(4 * i), Vertex(4 * i + 1))
            assert (edge.index, edge.left, edge.right) == (4 * i, OUTSIDE, OUTSIDE)
            surface.set_left(edge, Face(4 * i + 2))
            surface.set_left(edge.sym, Face(4 * i + 3))
        assert [(e.org, e.dest, e.left, e.right) for e in surface.edges()] == [
            (4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3) for i in range(70)
        ]

    @pytest.mark.parametrize("again", [0, 1, 2])
    def test_number_used_again(self, again: int) -> None:
        """A new edge in the place of a deleted one has nothing of it, and leaves its neighbors in memory alone."""
        surface = QuadEdge(capacity=3)
        for i in range(3):
            edge = surface.make_edge(Vertex(i), Vertex(i))
            surface.set_left(edge, Face(i))
            surface.set_left(edge.sym, Face(i))
        surface.delete_edge(surface.edge(4 * again))
        new = surface.make_edge(Vertex(7), Vertex(8))
        assert new.index == 4 * again
        expected = [(i, i, i, i) for i in range(3)]
        expected[again] = (7, 8, OUTSIDE, OUTSIDE)
        assert [(e.org, e.dest, e.left, e.right) for e in surface.edges()] == expected

    @pytest.mark.parametrize("most", [1, 2, 4, 8])
    def test_full(self, most: int, monkeypatch: pytest.MonkeyPatch) -> None:
        """There is room for MAX_EDGES edges, and for no more."""
        monkeypatch.setattr(sys.modules["exactmesh.quadedge"], "MAX_EDGES", most)
        surface = QuadEdge(capacity=1)
        for _ in range(most):
            surface.make_edge()
        with pytest.raises(TopologyError, match=f"at most {most} edges"):
            surface.make_edge()
        assert len(surface) == len([*surface.edges()]) == most

    def test_the_limit_is_that_of_31_bits(self) -> None:
        assert len(QuadEdge()) == 0
        assert 4 * sys.modules["exactmesh.quadedge"].MAX_EDGES == 2**31


@pytest.mark.obligation("M1", "a handle is a value", method="named cases", control_in="mutants")
class TestHandles:
    """A handle cannot be changed, and nothing hung on it; two are equal, and one in a set, iff they mean the same edge
    of the same quad-edge. An edge that was given no vertices has -1 at its ends."""

    def test_values(self) -> None:
        surface, other = QuadEdge(), QuadEdge()
        one, same, two, there = surface.make_edge(), surface.edge(0), surface.make_edge(), other.make_edge()
        assert one == same == one.sym.sym
        assert len({one, same, two, there, one.sym}) == 4
        assert one not in (two, there, one.sym)
        for name in ("index", "structure"):
            with pytest.raises(FrozenInstanceError):
                setattr(one, name, getattr(two, name))
        assert not hasattr(one, "__dict__")
        assert (one.org, one.dest) == (-1, -1)


def three_edges() -> QuadEdge:
    """Edges 0, 1 and 2 of which 1 was deleted, in arrays without room for a fourth."""
    surface = QuadEdge(capacity=3)
    for i in range(3):
        surface.make_edge(Vertex(i), Vertex(i))
    surface.delete_edge(surface.edge(4))
    return surface


@pytest.mark.obligation(
    "M1", "an edge that is none of the quad-edge's is refused by name", method="named cases", control_in="mutants"
)
class TestStrangers:
    """Whatever quarter-edge is asked for, it is there or the error names its edge; so with edges of other quad-edges,
    with dual ones, and with those between which and their neighbors there are no two triangles."""

    @pytest.mark.parametrize("full", [True, False])
    def test_every_number(self, full: bool) -> None:
        surface = three_edges()
        if not full:
            surface.make_edge()
            for _ in range(2):  # twice the room
                surface.make_edge()
            surface.delete_edge(surface.edge(4))
        live = {e.index // 4 for e in surface.edges()}
        room = len(surface.ring_of(QuarterEdge(0)))
        for index in range(-8, room + 8):
            if index // 4 in live:
                assert surface.ring_of(QuarterEdge(index)) is surface.ring_of(QuarterEdge(0))
                continue
            with pytest.raises(TopologyError, match=f"^edge {index // 4} does not exist or was deleted$") as raised:
                surface.ring_of(QuarterEdge(index))
            assert raised.value.indices == (index,)
        for index in range(-8, room + 8):
            if index % 2:
                with pytest.raises(TopologyError, match=f"^quarter-edge {index} is a dual edge$") as raised:
                    surface.edge(index)
                assert raised.value.indices == (index,)

    def test_of_another(self) -> None:
        ours, theirs = three_edges(), three_edges()
        for q in (8, 10):
            for operation in (ours.delete_edge, ours.swap, lambda e: ours.set_org(e, Vertex(0))):
                with pytest.raises(TopologyError, match=r"^edge 2 belongs to another quad-edge$") as raised:
                    operation(theirs.edge(q))
                assert raised.value.indices == (q,)

    def test_no_two_triangles(self) -> None:
        surface = QuadEdge.from_triangles([(0, 1, 2), (0, 2, 3)])
        for edge in surface.edges():
            for side in (edge, edge.sym):
                if OUTSIDE in (side.left, side.right):
                    named = rf"^edge {side.index // 4} \({side.org} -> {side.dest}\) is not between two triangles$"
                    with pytest.raises(TopologyError, match=named) as raised:
                        surface.swap(side)
                    assert raised.value.indices == (side.index,)

    @pytest.mark.parametrize("q", range(12))
    def test_a_broken_axiom(self, q: int) -> None:
        surface = QuadEdge.from_triangles([(0, 1, 2)])
        ring = surface.ring_of(QuarterEdge(0))
        ring[q] ^= 1  # onext leads from primal to dual
        with pytest.raises(TopologyError) as raised:
            surface.check()
        (named,) = raised.value.indices
        assert named <= q
        assert str(raised.value) == (
            f"quarter-edge {named} (edge {named // 4}) breaks the axioms: onext = {ring[named]}"
        )


@pytest.mark.obligation(
    "M1", "the first quarter-edge at fault is named where some are missing", method="exhaustive", control_in="mutants"
)
class TestMissingQuarters:
    """A quarter-edge is missing where its edge was not deleted, or leads to nothing, or breaks an axiom: the first of
    these is named, in every state of two edges of which any one quarter, or two, are taken out."""

    def test_every_hole(self) -> None:
        labels = np.zeros(4, dtype=np.int32)
        for ring in reachable_states(2):
            for holes in product(range(8), repeat=2):
                broken = ring.copy()
                broken[list(holes)] = -1
                entries = broken.tolist()
                first = next(q for q in range(8) if self.is_at_fault(entries, q))
                with pytest.raises(TopologyError) as raised:
                    QuadEdge.from_arrays(broken, labels, labels.copy())
                assert raised.value.indices == (first,)

    @staticmethod
    def is_at_fault(entries: list[int], q: int) -> bool:
        after = entries[q]
        if after == -1:
            return entries[q // 4 * 4] != -1
        turned = entries[after // 4 * 4 + (after + 1) % 4]
        return entries[after] == -1 or turned == -1 or turned // 4 * 4 + (turned + 1) % 4 != q


@pytest.mark.obligation("M1", "arrays of wrong lengths are refused by their lengths", method="enumeration")
class TestLengths:
    """A ring of k entries is taken just when 4 divides k and there are k / 2 vertices and faces."""

    def test_every_length(self) -> None:
        for lengths in product(range(9), repeat=3):
            ring = np.full(lengths[0], -1, dtype=np.int32)  # of edges that were all deleted
            vertex, face = (np.zeros(length, dtype=np.int32) for length in lengths[1:])
            if lengths in ((0, 0, 0), (4, 2, 2), (8, 4, 4)):
                assert len(QuadEdge.from_arrays(ring, vertex, face)) == 0
            else:
                with pytest.raises(TopologyError) as raised:
                    QuadEdge.from_arrays(ring, vertex, face)
                told = "{} ring entries need half as many origins, not {}, {}".format(*lengths)
                assert str(raised.value) == told

    @pytest.mark.parametrize("edges", range(4))
    def test_control_lengths_that_fit(self, edges: int) -> None:
        """None: arrays whose lengths fit are taken."""
        ring = np.full(4 * edges, -1, dtype=np.int32)
        vertex, face = (np.zeros(2 * edges, dtype=np.int32) for _ in range(2))
        assert len(QuadEdge.from_arrays(ring, vertex, face)) == 0


def triangular_faces(surface: QuadEdge) -> set[frozenset[int]]:
    """The corners of the triangular faces that are not OUTSIDE, by walking round each."""
    sides: list[Edge[Primal]] = [side for edge in surface.edges() for side in (edge, edge.sym)]
    faces = [[e.org for e in side.face()] for side in sides if side.left != OUTSIDE]
    return {frozenset(face) for face in faces if len(face) == 3}


@pytest.mark.obligation("M1", "triangles() lists the triangular faces, whatever was deleted", method="enumeration")
class TestTriangles:
    """From any triangulation and whatever edges are deleted, triangles() has a row for each triangular face but those
    OUTSIDE, counterclockwise; vertices may have any names but negative ones."""

    @pytest.mark.parametrize("name", [lambda v: v, lambda v: 2**31 - 1 - v, lambda v: 7 * v % 23])
    def test_after_deletions(self, name: Callable[[int], int]) -> None:
        for number, start in enumerate(triangulations(grid(3, 3))):
            surface = QuadEdge.from_triangles([[name(v) for v in t] for t in start])
            indices = [edge.index for edge in surface.edges()]
            for index in (indices[number % len(indices)], *indices[number % 5 :: 5]):
                if index in {edge.index for edge in surface.edges()}:
                    surface.delete_edge(surface.edge(index))
            rows = surface.triangles().tolist()
            assert len(rows) == len(triangular_faces(surface))
            assert {frozenset(row) for row in rows} == triangular_faces(surface)
            cyclic = {tuple(name(v) for v in t[i:] + t[:i]) for t in start for i in range(3)}
            assert {tuple(row) for row in rows} <= cyclic

    def test_control_a_corner_without_a_name(self) -> None:
        """A corner that was given no vertex is no row of the result, but an error that shows the triangle."""
        surface = QuadEdge.from_triangles([(0, 1, 2), (0, 2, 3)])
        for edge in surface.edges():
            for side in (edge, edge.sym):
                if side.org == 3:
                    surface.set_org(side, Vertex(-1))
        with pytest.raises(
            TopologyError, match=r"^the triangle \[[-0-2, ]*\] has a corner that is no vertex$"
        ) as raised:
            surface.triangles()
        assert "-1" in str(raised.value)

    def test_no_edges(self) -> None:
        assert QuadEdge().triangles().shape == (0, 3)
        assert QuadEdge().triangles().dtype == np.int32
