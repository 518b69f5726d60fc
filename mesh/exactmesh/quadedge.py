"""The quad-edge, typed: Guibas and Stolfi's subdivision of an orientable surface, topology only.

:class:`QuadEdge` owns the flat arrays of :mod:`exactmesh.edgealgebra`; :class:`Edge` is a handle on one quarter-edge. A
primal edge runs between vertices, a dual one between faces, and they are different types: ``edge.rot`` of an
``Edge[Primal]`` is an ``Edge[Dual]``, whose ``org`` is a Face, and mypy rejects it where a Vertex is wanted.

                dest
                 ^                      e.sym      e backwards
                 |                      e.rot      the dual edge, from e.right to e.left
       left <----+----- right           e.inv_rot  the dual edge, from e.left to e.right
                 | e.rot                e.onext    the next edge counterclockwise with the same origin
                 |
                org                     and so on: see the picture in edgealgebra.py

Reference [Guibas 1985].
"""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Generic, TypeVar, overload

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import vertex_indices
from exactkernel.jit import jit
from exactkernel.types import IntArray
from exactmesh import edgealgebra as algebra
from exactmesh.connectivity import check_corners, check_neighbors, neighbors_of, rings_of
from exactmesh.edgealgebra import EdgeArray
from exactmesh.errors import ShapeError, TopologyError
from exactmesh.extract import OUTER, triangles_of
from exactmesh.ids import OUTSIDE, Face, QuarterEdge, Vertex

__all__ = ["NO_VERTEX", "Dual", "Edge", "Primal", "QuadEdge"]

#: The origin of an edge that was given none.
NO_VERTEX = Vertex(-1)

#: Quarter-edges are numbered in 31 bits.
MAX_EDGES = 2**29

_FREE = -1  # ring entry of a deleted quarter-edge


class Primal:
    """The kind of an edge between two vertices."""


class Dual:
    """The kind of an edge between two faces."""


Kind = TypeVar("Kind", Primal, Dual)


class _QuarterTurn:
    """The property ``rot`` or ``inv_rot``: it changes the kind of the edge, which a plain property cannot say."""

    def __init__(self, turns: int) -> None:
        self._turns = turns

    @overload
    def __get__(self, edge: Edge[Primal], owner: object = None) -> Edge[Dual]: ...
    @overload
    def __get__(self, edge: Edge[Dual], owner: object = None) -> Edge[Primal]: ...
    def __get__(self, edge: Edge[Primal] | Edge[Dual], owner: object = None) -> Edge[Primal] | Edge[Dual]:
        turn = algebra.rot if self._turns == 1 else algebra.inv_rot
        return Edge(edge.structure, QuarterEdge(turn(edge.index)))


class _Label:
    """The label at the origin of the edge that is some quarter turns away."""

    def __init__(self, turns: int) -> None:
        self._turns = turns

    def _of(self, edge: Edge[Primal] | Edge[Dual]) -> int:
        return edge.structure.label(QuarterEdge((edge.index & ~3) | ((edge.index + self._turns) & 3)))


class _End(_Label):
    """The property ``org`` or ``dest``: a vertex of a primal edge, a face of a dual one."""

    @overload
    def __get__(self, edge: Edge[Primal], owner: object = None) -> Vertex: ...
    @overload
    def __get__(self, edge: Edge[Dual], owner: object = None) -> Face: ...
    def __get__(self, edge: Edge[Primal] | Edge[Dual], owner: object = None) -> int:
        return self._of(edge)


class _Side(_Label):
    """The property ``left`` or ``right``: a face of a primal edge, a vertex of a dual one."""

    @overload
    def __get__(self, edge: Edge[Primal], owner: object = None) -> Face: ...
    @overload
    def __get__(self, edge: Edge[Dual], owner: object = None) -> Vertex: ...
    def __get__(self, edge: Edge[Primal] | Edge[Dual], owner: object = None) -> int:
        return self._of(edge)


@dataclass(frozen=True, slots=True, repr=False)
class Edge(Generic[Kind]):
    """A handle on one directed edge of a :class:`QuadEdge`; two handles are equal if they mean the same edge.

    Attributes:
        structure: the quad-edge that it belongs to.
        index: the quarter-edge, ``4 * edge + quarter turns``.
    """

    structure: QuadEdge
    index: QuarterEdge

    def __repr__(self) -> str:
        kind = "Dual" if self.index & 1 else "Primal"
        ends = (self.structure.label(QuarterEdge(end)) for end in (self.index, algebra.sym(self.index)))
        return f"Edge[{kind}]({' -> '.join(map(str, ends))})"

    def _to(self, index: int) -> Edge[Kind]:
        return Edge(self.structure, QuarterEdge(index))

    rot = _QuarterTurn(1)
    inv_rot = _QuarterTurn(3)
    org = _End(0)
    dest = _End(2)
    left = _Side(3)
    right = _Side(1)

    @property
    def sym(self) -> Edge[Kind]:
        """The same edge backwards."""
        return self._to(algebra.sym(self.index))

    @property
    def onext(self) -> Edge[Kind]:
        """The next edge counterclockwise with the same origin."""
        return self._to(algebra.onext(self._ring, self.index))

    @property
    def oprev(self) -> Edge[Kind]:
        """The next edge clockwise with the same origin."""
        return self._to(algebra.oprev(self._ring, self.index))

    @property
    def dnext(self) -> Edge[Kind]:
        """The next edge counterclockwise with the same destination."""
        return self._to(algebra.dnext(self._ring, self.index))

    @property
    def dprev(self) -> Edge[Kind]:
        """The next edge clockwise with the same destination."""
        return self._to(algebra.dprev(self._ring, self.index))

    @property
    def lnext(self) -> Edge[Kind]:
        """The next edge counterclockwise round the left face."""
        return self._to(algebra.lnext(self._ring, self.index))

    @property
    def lprev(self) -> Edge[Kind]:
        """The next edge clockwise round the left face."""
        return self._to(algebra.lprev(self._ring, self.index))

    @property
    def rnext(self) -> Edge[Kind]:
        """The next edge counterclockwise round the right face."""
        return self._to(algebra.rnext(self._ring, self.index))

    @property
    def rprev(self) -> Edge[Kind]:
        """The next edge clockwise round the right face."""
        return self._to(algebra.rprev(self._ring, self.index))

    @property
    def _ring(self) -> EdgeArray:
        return self.structure.ring_of(self.index)

    def orbit(self) -> Iterator[Edge[Kind]]:
        """Yield the edges with this origin, counterclockwise, from this one on."""
        edge = self
        while True:
            yield edge
            edge = edge.onext
            if edge == self:
                return

    def face(self) -> Iterator[Edge[Kind]]:
        """Yield the edges round the left face, counterclockwise, from this one on."""
        edge = self
        while True:
            yield edge
            edge = edge.lnext
            if edge == self:
                return


def _label(number: int) -> int:
    if not -(2**31) <= number < 2**31:
        raise TopologyError(f"{number} does not fit 32 bits", indices=[number])
    return number


def _is_flat_int32(array: object) -> bool:
    return isinstance(array, np.ndarray) and array.dtype == np.int32 and array.ndim == 1 and array.flags.carray


@jit
def _first_broken(ring: EdgeArray, count: int) -> int:
    """Return the first quarter-edge that breaks an axiom of an edge algebra, or -1."""
    for q in range(4 * count):
        if ring[q] == _FREE:
            if ring[q & ~3] != _FREE:
                return q
            continue
        after = ring[q]
        if after < 0 or after >= 4 * count or ring[after] == _FREE:  # onext leads to a live edge
            return q
        if (after ^ q) & 1:  # onext keeps primal and dual apart
            return q
        if algebra.rot(ring[algebra.rot(after)]) != q:  # e rot onext rot onext = e: onext is one to one, dual to itself
            return q
    return -1


@jit
def _orbits(ring: EdgeArray, count: int, parity: int, seen: EdgeArray) -> int:
    """Count the rings of the primal (parity 0) or dual (1) quarter-edges; seen, all 0, becomes their numbers from 1."""
    orbits = 0
    for q in range(parity, 4 * count, 2):
        if ring[q] == _FREE or seen[q] != 0:
            continue
        orbits += 1
        e = q
        while seen[e] == 0:
            seen[e] = orbits
            e = ring[e]
    return orbits


class QuadEdge:
    """A subdivision of an orientable surface: vertices, edges and faces, and its dual at the same time.

    It knows no coordinates. ``make_edge`` and ``splice`` build everything; ``connect``, ``delete_edge`` and ``swap``
    are made of them. Each operation takes constant time (``make_edge`` on average).

    >>> from exactmesh import QuadEdge, Vertex
    >>> surface = QuadEdge()
    >>> ab = surface.make_edge(Vertex(0), Vertex(1))
    >>> bc = surface.make_edge(Vertex(1), Vertex(2))
    >>> surface.splice(ab.sym, bc)                      # the two edges now share vertex 1
    >>> ca = surface.connect(bc, ab)                    # and a third one closes the triangle
    >>> [edge.org for edge in ab.face()]
    [0, 1, 2]
    >>> surface.check()
    >>> surface.counts()                                # vertices, edges, faces: inside and outside
    (3, 3, 2)
    """

    def __init__(self, capacity: int = 16) -> None:
        """Make an empty subdivision with room for ``capacity`` edges; it grows by itself."""
        capacity = max(1, capacity)
        self._ring = np.full(4 * capacity, _FREE, dtype=np.int32)
        self._vertex = np.full(2 * capacity, NO_VERTEX, dtype=np.int32)
        self._face = np.full(2 * capacity, OUTSIDE, dtype=np.int32)
        self._count = 0  # edges ever made; those that were deleted since are on the free list
        self._free: list[int] = []

    @classmethod
    def from_arrays(cls, ring: EdgeArray, vertex: EdgeArray, face: EdgeArray) -> QuadEdge:
        """Wrap flat arrays, which are not copied.

        Args:
            ring: int32 (4 k,), onext of each quarter-edge.
            vertex: int32 (2 k,), ``vertex[q >> 1]`` the origin of the primal quarter-edge q.
            face: int32 (2 k,), ``face[q >> 1]`` the origin of the dual quarter-edge q.

        Raises:
            ShapeError: an array is not one-dimensional, contiguous, writable and int32.
            TopologyError: the lengths do not agree, or the ring breaks the axioms.
        """
        for name, array in (("ring", ring), ("vertex", vertex), ("face", face)):
            if not _is_flat_int32(array):
                raise ShapeError(f"{name} must be a one-dimensional, contiguous and writable array of int32")
        if len(ring) % 4 or not 2 * len(vertex) == 2 * len(face) == len(ring):
            raise TopologyError(f"{len(ring)} ring entries need half as many origins, not {len(vertex)}, {len(face)}")
        self = cls()
        self._ring, self._vertex, self._face = ring, vertex, face
        self._count = len(ring) // 4
        self.check()
        self._free = (4 * np.flatnonzero(ring[::4] == _FREE)).tolist()
        return self

    @classmethod
    def from_triangles(cls, triangles: npt.ArrayLike, neighbors: IntArray | None = None) -> QuadEdge:
        """Return the quad-edge of triangles that cover a region without pinches: its faces are their row numbers.

        Args:
            triangles: integers (m, 3), counterclockwise.
            neighbors: as in :class:`Triangulation`, if they are known.

        Raises:
            TopologyError: a directed edge is in two triangles, a corner is negative or repeated, or the neighbors are
                not mutual; ``indices`` names the triangles. Or the triangles meet in a vertex without an edge.
            ShapeError: not an integer array of shape (m, 3).

        O(m log m), O(m) with neighbors.

        >>> from exactmesh import QuadEdge
        >>> QuadEdge.from_triangles([(0, 1, 2), (0, 2, 3)]).counts()
        (4, 5, 3)
        """
        corners = vertex_indices(triangles)
        check_corners(corners)
        if neighbors is None:
            given = neighbors_of(corners)
        else:
            given = vertex_indices(neighbors, "neighbors")
            check_neighbors(corners, given)
        surface = cls.from_arrays(*rings_of(corners, given))
        pinched = surface._pinched()
        if pinched.size:
            raise TopologyError(
                f"the triangles at vertex {pinched[0]} are pinched: they meet there without an edge between them",
                indices=pinched.tolist(),
            )
        return surface

    def _pinched(self) -> IntArray:
        """Return the vertices that are the origin of more than one ring."""
        number = np.zeros(4 * self._count, dtype=np.int32)
        rings = _orbits(self._ring, self._count, 0, number)
        origin = np.empty(rings + 1, dtype=np.int32)
        origin[number[0::2]] = self._vertex[: 2 * self._count]
        names, uses = np.unique(origin[1:], return_counts=True)
        pinched: IntArray = names[uses > 1]
        return pinched

    def triangles(self) -> IntArray:
        """Return the corners of the triangular faces that are not OUTSIDE, int32 (m, 3), counterclockwise.

        O(edges) but for sorting the vertices.

        Raises:
            TopologyError: a corner was given no vertex.
        """
        half = np.arange(2 * self._count, dtype=np.int32)
        after = self._ring[(2 * half) ^ 3] ^ 3  # left_next of every primal edge, nonsense for deleted ones
        live = self._ring[2 * half] != _FREE
        after[~live] = 0
        triangular = (after[after[after >> 1] >> 1] == 2 * half) & (after != 2 * half)  # a loop comes back as well
        wanted = live & triangular & (self._face[half ^ 1] != OUTSIDE)
        slot = np.where(wanted, -1, OUTER).astype(np.int32)
        names, vertex = np.unique(self._vertex[: 2 * self._count], return_inverse=True)
        triangles, _ = triangles_of(self._ring, vertex.astype(np.int32), slot, names)
        nameless = np.flatnonzero((triangles < 0).any(axis=1))
        if nameless.size:
            raise TopologyError(f"the triangle {triangles[nameless[0]].tolist()} has a corner that is no vertex")
        return triangles

    def __len__(self) -> int:
        """Return the number of edges (each with its four quarter-edges)."""
        return self._count - len(self._free)

    def __repr__(self) -> str:
        return f"QuadEdge({len(self)} edges)"

    def edges(self) -> Iterator[Edge[Primal]]:
        """Yield each edge once, in the direction in which it was made."""
        for q in range(0, 4 * self._count, 4):
            if self._ring[q] != _FREE:
                yield Edge(self, QuarterEdge(q))

    def edge(self, index: int) -> Edge[Primal]:
        """Return the primal edge with that quarter-edge index.

        Raises:
            TopologyError: there is no such edge, or the index is odd (a dual edge).
        """
        if index % 2:
            raise TopologyError(f"quarter-edge {index} is a dual edge", indices=[index])
        self.ring_of(QuarterEdge(index))
        return Edge(self, QuarterEdge(index))

    def ring_of(self, index: QuarterEdge) -> EdgeArray:
        """Return the onext array, after a check that the quarter-edge is alive.

        Raises:
            TopologyError: it was deleted or never made.
        """
        if not 0 <= index < 4 * self._count or self._ring[index] == _FREE:
            raise TopologyError(f"edge {index >> 2} does not exist or was deleted", indices=[index])
        return self._ring

    def label(self, index: QuarterEdge) -> int:
        """Return the origin of the quarter-edge: a vertex for an even one, a face for an odd one."""
        self.ring_of(index)
        return int((self._face if index & 1 else self._vertex)[index >> 1])

    def set_org(self, edge: Edge[Primal], vertex: Vertex) -> None:
        """Let the edge start at that vertex; the others of its ring are not touched."""
        self._own_primal(edge)
        self._vertex[edge.index >> 1] = _label(vertex)

    def set_left(self, edge: Edge[Primal], face: Face) -> None:
        """Let that face be on the left of the edge; the other edges round it are not touched."""
        self._own_primal(edge)
        self._face[algebra.inv_rot(edge.index) >> 1] = _label(face)

    def _own(self, *edges: Edge[Primal] | Edge[Dual]) -> None:
        for edge in edges:
            if edge.structure is not self:
                raise TopologyError(f"edge {edge.index >> 2} belongs to another quad-edge", indices=[edge.index])
            self.ring_of(edge.index)

    def _own_primal(self, *edges: Edge[Primal]) -> None:
        self._own(*edges)
        for edge in edges:
            if edge.index & 1:
                raise TopologyError(f"quarter-edge {edge.index} is a dual edge", indices=[edge.index])

    def make_edge(self, org: Vertex = NO_VERTEX, dest: Vertex = NO_VERTEX) -> Edge[Primal]:
        """Return a new edge, by itself on a sphere: two vertices, one face."""
        ends = _label(org), _label(dest)
        if self._free:
            q = self._free.pop()
        else:
            if 4 * self._count == len(self._ring):
                self._grow()
            q = 4 * self._count
            self._count += 1
        algebra.make_edge(self._ring, q)
        self._vertex[q >> 1], self._vertex[(q >> 1) + 1] = ends
        self._face[q >> 1] = self._face[(q >> 1) + 1] = OUTSIDE
        return Edge(self, QuarterEdge(q))

    def _grow(self) -> None:
        room = max(1, len(self._ring) // 4)
        if 2 * room > MAX_EDGES:
            raise TopologyError(f"a quad-edge holds at most {MAX_EDGES} edges")
        self._ring = np.concatenate([self._ring, np.full(4 * room, _FREE, dtype=np.int32)])
        self._vertex = np.concatenate([self._vertex, np.full(2 * room, NO_VERTEX, dtype=np.int32)])
        self._face = np.concatenate([self._face, np.full(2 * room, OUTSIDE, dtype=np.int32)])

    def splice(self, a: Edge[Kind], b: Edge[Kind]) -> None:
        """Exchange what follows a and b round their origins, and so round their left faces; its own inverse.

        If the origins were two, they become one; if they were one, it becomes two; the same for the left faces::

            a'       b                 a'   b
              \\     /                    \\ /
               o   o          <->         o           counterclockwise: a, b', b, a'
              /     \\                    / \\
            a        b'                 a   b'

              onext(a) = a'              onext(a) = b'
              onext(b) = b'              onext(b) = a'

        Raises:
            TopologyError: one is primal and one dual, or an edge is another quad-edge's or was deleted.
        """
        self._own(a, b)
        if (a.index ^ b.index) & 1:
            raise TopologyError(
                f"quarter-edges {a.index} and {b.index}: one is primal, one dual", indices=[a.index, b.index]
            )
        algebra.splice(self._ring, a.index, b.index)

    def connect(self, a: Edge[Primal], b: Edge[Primal]) -> Edge[Primal]:
        """Return a new edge from the destination of a to the origin of b, which divides their common left face.

        Before, a and b have the same face on their left; after, the new edge lies between them::

            b.org <--- new --- a.dest
              |                  ^
            b v       left       | a
        """
        self._own_primal(a, b)
        new = self.make_edge(a.dest, b.org)
        self.splice(new, a.lnext)
        self.splice(new.sym, b)
        return new

    def delete_edge(self, edge: Edge[Primal]) -> None:
        """Take the edge out; its two faces become one. Handles on it are dead from here on."""
        self._own_primal(edge)
        self.splice(edge, edge.oprev)
        self.splice(edge.sym, edge.sym.oprev)
        q = edge.index & ~3
        self._ring[q : q + 4] = _FREE
        self._free.append(q)

    def swap(self, edge: Edge[Primal]) -> None:
        """Turn the edge counterclockwise in the quadrilateral of its two triangles; the picture is in edgealgebra.swap.

        The faces left and right of the edge keep their labels and get their new corners. Swapped four times, an edge is
        where it was; twice, it is backwards.

        Raises:
            TopologyError: the faces left and right are not two different triangles.
        """
        self._own_primal(edge)
        for side in (edge, edge.sym):
            corner = side.lnext.lnext
            if corner.lnext != side or corner == side or edge.sym in (edge.lnext, corner):
                raise TopologyError(
                    f"edge {edge.index >> 2} ({edge.org} -> {edge.dest}) is not between two triangles",
                    indices=[edge.index],
                )
        left, right = edge.left, edge.right
        algebra.swap(self._ring, self._vertex, edge.index)
        for side, face in ((edge, left), (edge.sym, right)):
            for e in side.face():
                self.set_left(e, face)

    def counts(self) -> tuple[int, int, int]:
        """Return the numbers of vertices, edges and faces (rings of onext, primal and dual). O(edges)."""
        seen = np.zeros(4 * self._count, dtype=np.int32)
        vertices = _orbits(self._ring, self._count, 0, seen)
        return int(vertices), len(self), int(_orbits(self._ring, self._count, 1, seen))

    def check(self) -> None:
        """Verify the axioms of an edge algebra on every quarter-edge. O(edges).

        rot has order four and onext keeps primal and dual apart by construction of the index; what is stored can break
        them only through onext, which must be a permutation of the live quarter-edges with e rot onext rot onext = e.

        Raises:
            TopologyError: an axiom is broken; ``indices`` names the quarter-edge.
        """
        broken = int(_first_broken(self._ring, self._count))
        if broken >= 0:
            raise TopologyError(
                f"quarter-edge {broken} (edge {broken >> 2}) breaks the axioms: onext = {self._ring[broken]}",
                indices=[broken],
            )
