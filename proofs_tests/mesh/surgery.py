"""A machine that operates on a quad-edge at random, rightly and wrongly, and compares every step with a plain model."""

from collections.abc import Callable
from typing import ClassVar

import numpy as np
import pytest
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from exactmesh import Edge, Face, Primal, QuadEdge, QuarterEdge, Vertex
from exactmesh.errors import TopologyError
from exactmesh.ids import OUTSIDE

__all__ = ["Surgery"]

Permutation = dict[int, int]
labels = st.integers(-1, 3)
any_integer = st.one_of(st.integers(-3, 40), st.sampled_from([2**31, -(2**31) - 1, 2**70]))


def cycles(permutation: Permutation) -> list[set[int]]:
    """Return the cycles, by walking each."""
    found: list[set[int]] = []
    for q in permutation:
        if not any(q in cycle for cycle in found):
            walked = [q]
            while permutation[walked[-1]] != q:
                walked.append(permutation[walked[-1]])
            found.append(set(walked))
    return found


class Surgery(RuleBasedStateMachine):
    """onext of the primal quarter-edges in a dictionary, the origins and the left faces of them in two others; all else
    follows from these by definition."""

    Surface: ClassVar[type[QuadEdge]] = QuadEdge

    def __init__(self) -> None:
        super().__init__()
        self.surface = self.Surface(capacity=1)
        self.onext: Permutation = {}
        self.org: dict[int, int] = {}
        self.left: dict[int, int] = {}
        self.dead: list[Edge[Primal]] = []

    def pick(self, data: st.DataObject) -> Edge[Primal]:
        return self.surface.edge(data.draw(st.sampled_from(sorted(self.onext))))

    def splice(self, a: int, b: int) -> None:
        self.onext[a], self.onext[b] = self.onext[b], self.onext[a]

    def oprev(self, q: int) -> int:
        return next(p for p, after in self.onext.items() if after == q)

    def lnext(self, q: int) -> int:
        """To the end of the edge, then clockwise."""
        return self.oprev(q ^ 2)

    def face(self, q: int) -> list[int]:
        walked = [q]
        while self.lnext(walked[-1]) != q:
            walked.append(self.lnext(walked[-1]))
        return walked

    def made(self, edge: Edge[Primal], org: int, dest: int) -> None:
        """Note an edge by itself: alone at both ends, the outside on both sides."""
        q = edge.index
        assert q not in self.onext
        self.dead = [gone for gone in self.dead if gone.index >> 2 != q >> 2]
        for side, origin in ((q, org), (q ^ 2, dest)):
            self.onext[side], self.org[side], self.left[side] = side, origin, OUTSIDE

    @rule(org=labels, dest=labels)
    def make(self, org: int, dest: int) -> None:
        self.made(self.surface.make_edge(Vertex(org), Vertex(dest)), org, dest)

    @precondition(lambda self: self.onext)
    @rule(data=st.data(), org=labels, face=labels)
    def label(self, data: st.DataObject, org: int, face: int) -> None:
        a, b = self.pick(data), self.pick(data)
        self.surface.set_org(a, Vertex(org))
        self.surface.set_left(b, Face(face))
        self.org[a.index], self.left[b.index] = org, face

    @precondition(lambda self: self.onext)
    @rule(data=st.data())
    def label_all(self, data: st.DataObject) -> None:
        """One name for each vertex and each face."""
        for ring in cycles(self.onext):
            self.org |= dict.fromkeys(ring, data.draw(labels))
        for face in {min(self.face(q)): self.face(q) for q in self.onext}.values():
            self.left |= dict.fromkeys(face, data.draw(labels))
        for q in self.onext:
            self.surface.set_org(self.surface.edge(q), Vertex(self.org[q]))
            self.surface.set_left(self.surface.edge(q), Face(self.left[q]))

    @precondition(lambda self: self.onext)
    @rule(data=st.data())
    def splice_primal(self, data: st.DataObject) -> None:
        a, b = self.pick(data), self.pick(data)
        self.surface.splice(a, b)
        self.splice(a.index, b.index)

    @precondition(lambda self: self.onext)
    @rule(data=st.data())
    def splice_dual(self, data: st.DataObject) -> None:
        """e rot onext = e oprev inv_rot: the dual splice exchanges what comes before a and b."""
        a, b = self.pick(data), self.pick(data)
        self.surface.splice(a.rot, b.rot)
        p, q = self.oprev(a.index), self.oprev(b.index)
        self.onext[p], self.onext[q] = b.index, a.index

    @precondition(lambda self: self.onext)
    @rule(data=st.data())
    def connect(self, data: st.DataObject) -> None:
        a, b = self.pick(data), self.pick(data)
        after = self.lnext(a.index)
        new = self.surface.connect(a, b)
        self.made(new, self.org[a.index ^ 2], self.org[b.index])
        self.splice(new.index, after)
        self.splice(new.index ^ 2, b.index)

    @precondition(lambda self: self.onext)
    @rule(data=st.data())
    def close_a_triangle(self, data: st.DataObject) -> None:
        """Often enough to have something to swap."""
        a = self.pick(data)
        b = self.surface.make_edge(Vertex(0), Vertex(1))
        self.made(b, 0, 1)
        after = self.lnext(a.index)
        self.surface.splice(a.lnext, b)
        self.splice(after, b.index)
        c, corner = self.surface.connect(b, a), self.lnext(b.index)
        self.made(c, 1, self.org[a.index])
        self.splice(c.index, corner)
        self.splice(c.index ^ 2, a.index)

    @precondition(lambda self: self.onext)
    @rule(data=st.data())
    def delete(self, data: st.DataObject) -> None:
        edge = self.pick(data)
        self.surface.delete_edge(edge)
        for q in (edge.index, edge.index ^ 2):
            self.splice(q, self.oprev(q))
        for q in (edge.index, edge.index ^ 2):
            assert self.onext.pop(q) == q
            del self.org[q], self.left[q]
        self.dead.append(edge)

    def can_swap(self, e: int) -> bool:
        left, right = self.face(e), self.face(e ^ 2)
        return len(left) == len(right) == 3 and e ^ 2 not in left

    @precondition(lambda self: any(map(self.can_swap, self.onext)))
    @rule(data=st.data(), faces=st.tuples(labels, labels))
    def swap(self, data: st.DataObject, faces: tuple[int, int]) -> None:
        """Guibas and Stolfi's four splices; the new ends are the third corners, the faces get their new corners."""
        e = data.draw(st.sampled_from(sorted(q for q in self.onext if self.can_swap(q))))
        for side, label in zip((e, e ^ 2), faces, strict=True):
            for q in self.face(side):
                self.surface.set_left(self.surface.edge(q), Face(label))
        ends = self.org[self.face(e ^ 2)[2]], self.org[self.face(e)[2]]
        self.surface.swap(self.surface.edge(e))
        a, b = self.oprev(e), self.oprev(e ^ 2)
        self.splice(e, a)
        self.splice(e ^ 2, b)
        self.splice(e, self.lnext(a))
        self.splice(e ^ 2, self.lnext(b))
        self.org[e], self.org[e ^ 2] = ends
        for side, label in zip((e, e ^ 2), faces, strict=True):
            self.left |= dict.fromkeys(self.face(side), label)

    def illegal(self, data: st.DataObject) -> list[Callable[[], object]]:
        """Calls that must be refused: strangers, the dead, dual for primal, what does not exist, what is no number."""
        surface, number = self.surface, data.draw(any_integer)
        stranger = QuadEdge().make_edge()
        calls: list[Callable[[], object]] = [lambda: surface.delete_edge(stranger), lambda: surface.swap(stranger)]
        if number % 2 or number not in self.onext:
            calls += [lambda: surface.edge(number)]
        if not -(2**31) <= number < 2**31:
            calls += [lambda: surface.make_edge(Vertex(number)), lambda: surface.make_edge(Vertex(0), Vertex(number))]
        for gone in self.dead:
            calls += [lambda e=gone: surface.swap(e), lambda e=gone: e.onext, lambda e=gone: surface.delete_edge(e)]  # type: ignore[misc]  # a default binds
        if self.onext:
            edge = self.pick(data)
            dual: Edge[Primal] = Edge(surface, edge.rot.index)  # a handle that lies about its kind
            calls += [lambda: surface.splice(edge, dual), lambda: surface.connect(edge, dual)]
            calls += [lambda: surface.connect(dual, edge), lambda: surface.splice(edge, stranger)]
            calls += [
                lambda: surface.delete_edge(dual),
                lambda: surface.swap(dual),
                lambda: surface.connect(edge, stranger),
            ]
            calls += [lambda: surface.set_org(dual, Vertex(0)), lambda: surface.set_left(dual, Face(0))]
            calls += [lambda: surface.set_org(edge, Vertex(2**31)), lambda: surface.set_left(edge, Face(2**31))]
            if not self.can_swap(edge.index):
                calls += [lambda: surface.swap(edge)]
        return calls

    @rule(data=st.data())
    def refuse(self, data: st.DataObject) -> None:
        """Each illegal call raises a typed error and changes nothing."""
        before = self.contents()
        for call in self.illegal(data):
            with pytest.raises(TopologyError):
                call()
            assert self.contents() == before

    def contents(self) -> list[object]:
        s = self.surface
        return [s._count, list(s._free), s._ring.tolist(), s._vertex.tolist(), s._face.tolist()]

    @precondition(lambda self: self.onext)
    @rule()
    def go_through_arrays(self) -> None:
        """What the arrays say is all there is: go on from a copy of them."""
        s, room = self.surface, 4 * self.surface._count
        arrays = s._ring[:room].copy(), s._vertex[: room // 2].copy(), s._face[: room // 2].copy()
        self.surface = self.Surface.from_arrays(*arrays)
        self.dead = []

    @invariant()
    def is_an_edge_algebra(self) -> None:
        """rot has order four and its square is sym; onext permutes the quarter-edges and keeps their kind; e rot onext
        rot onext = e; check() says so as well. Read off the operators, not off the model."""
        self.surface.check()
        live = sorted(q for e in self.onext for q in (e, e ^ 1))
        handles: dict[int, Edge[Primal]] = {q: Edge(self.surface, QuarterEdge(q)) for q in live}
        after = {q: int(handle.onext.index) for q, handle in handles.items()}
        assert sorted(after.values()) == live
        assert all((after[q] - q) % 2 == 0 for q in live)
        for q, handle in handles.items():
            turned = handle.rot
            assert turned.index != q
            assert turned.index >> 2 == q >> 2
            assert (turned.rot, turned.inv_rot) == (handle.sym, handle)
            assert turned.rot.rot.rot == handle
            assert turned.onext.rot.onext == handle

    @invariant()
    def is_the_model(self) -> None:
        """Edges, onext, labels are those of the model; the duals follow from them."""
        assert len(self.surface) * 2 == len(self.onext)
        assert {e.index for edge in self.surface.edges() for e in (edge, edge.sym)} == set(self.onext)
        before = {after: q for q, after in self.onext.items()}
        for q, after in self.onext.items():
            edge = self.surface.edge(q)
            assert (edge.onext.index, edge.oprev.index) == (after, before[q])
            assert (edge.lnext.index, edge.lprev.index) == (before[q ^ 2], after ^ 2)
            assert (edge.rnext.index, edge.rprev.index) == (before[q] ^ 2, self.onext[q ^ 2])
            assert (edge.dnext.index, edge.dprev.index) == (self.onext[q ^ 2] ^ 2, before[q ^ 2] ^ 2)
            assert edge.rot.onext.index == self.surface.edge(before[q]).inv_rot.index
            assert (edge.org, edge.dest) == (self.org[q], self.org[q ^ 2]) == (edge.rot.left, edge.rot.right)
            assert (edge.left, edge.right) == (self.left[q], self.left[q ^ 2]) == (edge.rot.dest, edge.rot.org)

    @invariant()
    def satisfies_euler(self) -> None:
        """Every piece is a closed orientable surface: V - E + F = 2 - 2 genus."""
        rings = cycles(self.onext)
        before = {after: q for q, after in self.onext.items()}
        faces = cycles({q: before[q ^ 2] for q in self.onext})
        assert self.surface.counts() == (len(rings), len(self.onext) // 2, len(faces))
        pieces = [{q, q ^ 2} for q in self.onext if not q & 2]
        for ring in rings:
            touched = [piece for piece in pieces if piece & ring]
            pieces = [piece for piece in pieces if not piece & ring] + [set[int]().union(*touched)]
        for piece in pieces:
            characteristic = sum(r <= piece for r in rings) - len(piece) // 2 + sum(f <= piece for f in faces)
            assert characteristic <= 2
            assert characteristic % 2 == 0

    @invariant()
    def knows_its_triangles(self) -> None:
        """The triangles are the faces of three edges with a label that is not OUTSIDE, each once; where the labels
        disagree round a face or a vertex, nothing is promised."""
        expected = []
        for q in self.onext:
            face = self.face(q)
            if len(face) == 3 and self.left[q] != OUTSIDE and q == min(face):
                expected.append([self.org[e] for e in face])
        if any(self.left[q] != self.left[self.lnext(q)] or self.org[q] != self.org[self.onext[q]] for q in self.onext):
            return
        if any(v < 0 for corners in expected for v in corners):
            with pytest.raises(TopologyError):
                self.surface.triangles()
            return
        found = self.surface.triangles()
        assert found.dtype == np.int32
        assert sorted(map(turned, found.tolist())) == sorted(map(turned, expected))


def turned(corners: list[int]) -> tuple[int, ...]:
    """Return the corners from the smallest rotation on."""
    a, b, c = corners
    return min((a, b, c), (b, c, a), (c, a, b))
