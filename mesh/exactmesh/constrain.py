"""Constrained Delaunay triangulation: segments in, one after the other, then what is outside the domain out.

A segment is an edge already, or passes through a vertex, or crosses edges: those go, and the polygons on its two sides
are triangulated anew. Ties are broken by the perturbation that :func:`exactmesh.delaunay` uses, so the result depends
on nothing but the planar straight line graph. Reference [Chew 1989], [Shewchuk 2015].
"""

from enum import StrEnum
from typing import Self

import numpy as np

from exactkernel.context import chunk_size
from exactkernel.errors import ShapeError
from exactkernel.jit import jit, jit_inline
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import IntArray
from exactmesh.assembly import Task, assembled, cut_out, in_order, of_source
from exactmesh.cavity import split_along
from exactmesh.crossings import arrange, crossing_pairs
from exactmesh.crossings.memory import room_for
from exactmesh.delaunay import Insertion, Progress, insert_points
from exactmesh.edgealgebra import EdgeArray, dest
from exactmesh.errors import ChoiceError, CrossingError, TooManyCrossingsError
from exactmesh.ordering import IndexArray
from exactmesh.plane import Plane, march, toward
from exactmesh.pslg import PSLG, Carve
from exactmesh.regions import check_parity
from exactmesh.triangulation import Triangulation

__all__ = ["Crossings", "constrained_delaunay"]

_BYTES_PER_PIECE = 100  # of the arrays that sort them
_CHUNK = 1 << 15  # segments between two looks at Ctrl-C, where predicates are fast


class Crossings(StrEnum):
    """What to do about segments that cross."""

    ERROR = "error"
    """Refuse them, by name."""
    SPLIT = "split"
    """Make each crossing a vertex, rounded to doubles."""

    @classmethod
    def _missing_(cls, value: object) -> Self:
        raise ChoiceError(f"crossings={value!r}; choose from {', '.join(cls)}")


@jit
def first_spokes(org: EdgeArray, edges: int, spoke: EdgeArray) -> None:
    """Write an edge that leaves each vertex."""
    ghost = len(spoke)
    for half in range(2 * edges):
        if org[half] != ghost:
            spoke[org[half]] = 2 * half


def plane_of(built: Insertion) -> Plane:
    """Return the triangulation in the form that segments are inserted into."""
    n = len(built.order)
    spoke = np.full(n, -1, dtype=np.int32)
    first_spokes(built.org, built.edges, spoke)
    return Plane(
        built.k, built.xy, built.ring, built.org, spoke,
        fixed=np.zeros(built.edges, dtype=np.bool_), loose=np.zeros(built.edges, dtype=np.bool_),
        crossed=np.empty(built.edges, dtype=np.int32),
        left=np.empty(built.edges, dtype=np.int32), right=np.empty(built.edges, dtype=np.int32),
        stack=np.empty(3 * built.edges, dtype=np.int64),
        ghost=n,
    )  # fmt: skip


@jit_inline
def find_edge(plane: Plane, a: int, b: int) -> tuple[int, bool]:
    """Return (the edge from a to b, or -1; whether b has fewer edges), turning round both ends at once."""
    ring, org = plane.ring, plane.org
    first_a, first_b = int(plane.spoke[a]), int(plane.spoke[b])
    e, f = first_a, first_b
    while True:
        if dest(org, e) == b:
            return e, False
        if dest(org, f) == a:
            return f ^ 2, False
        e, f = int(ring[e]), int(ring[f])
        if e == first_a:
            return -1, False
        if f == first_b:
            return -1, True


@jit_inline
def step(plane: Plane, a: int, b: int) -> tuple[int, int]:
    """Constrain the way from a toward b to the next vertex on it; return (edge, that vertex), or (-1, -1): crossed."""
    e, straight = toward(plane, a, b)
    w = dest(plane.org, e)
    if not straight:
        w, crossed, lefts, rights = march(plane, e, b)
        if w < 0:
            return -1, -1
        e = split_along(plane, a, w, crossed, lefts, rights)
    return e, w


@jit
def constrain_range(
    plane: Plane, ends: IndexArray, order: IndexArray, first: int, stop: int, pieces: EdgeArray, count: int
) -> tuple[int, int, bool]:
    """Insert the segments order[first .. stop - 1]; return (the next one, number of pieces, whether it is crossed).

    Row after row, ``pieces`` (p, 2) becomes (edge, segment); where it is full, ``ends`` keeps what is left to do.
    """
    for turn in range(first, stop):
        s = order[turn]
        a, b = ends[s, 0], ends[s, 1]
        while a != b:
            if count == len(pieces):
                ends[s, 0], ends[s, 1] = a, b
                return turn, count, False
            e, swapped = find_edge(plane, a, b)
            w = b
            if e < 0:
                if swapped:
                    a, b = b, a
                e, w = step(plane, a, b)
                if e < 0:
                    return turn, count, True
            plane.fixed[e >> 2] = True
            pieces[count, 0], pieces[count, 1] = e >> 2, s
            count += 1
            a = w
    return stop, count, False


@np.errstate(over="ignore", invalid="ignore")  # interpreted, a numpy scalar warns where a double does not
def insert_segments(plane: Plane, ends: IntArray, progress: Progress | None = None) -> EdgeArray | None:
    """Constrain the segments; return rows (edge, segment), int32, or None when two of them cross.

    They come in the order in which their later ends were inserted: at random from far, along a curve from near.

    Raises:
        TooManyCrossingsError: segments overlap so much that their pieces do not fit into a quarter of the memory.
    """
    order = np.argsort(ends.max(axis=1, initial=0), kind="stable")
    left = ends.astype(np.int64)
    pieces = np.empty((len(ends) + 16, 2), dtype=np.int32)
    turn = count = 0
    step_size = chunk_size(plane.k, _CHUNK)
    while turn < len(ends):
        stop = min(turn + step_size, len(ends))
        turn, count, crossed = constrain_range(plane, left, order, turn, stop, pieces, count)
        raise_if_interrupted()
        if crossed:
            return None
        if count == len(pieces):
            if 2 * count > room_for(_BYTES_PER_PIECE):
                raise TooManyCrossingsError(
                    f"the segments have more than {count} pieces, for they overlap: too many for this machine's memory",
                    indices=[int(pieces[count - 1, 1])],
                )
            pieces = np.concatenate([pieces, np.empty_like(pieces)])
        if progress is not None:
            progress(int(turn), len(ends))
    return pieces[:count]


def triangulated(task: Task, seed: int, progress: Progress | None) -> Triangulation | None:
    """Return the constrained Delaunay triangulation, or None if segments cross."""
    graph = task.graph
    points, everything = len(graph.points), len(graph.points) + len(graph.segments)

    def advance(done: int) -> None:
        if progress is not None:
            progress(done, everything)

    built = insert_points(graph.points, seed=seed, progress=lambda done, _: advance(done))
    position = np.empty(len(built.order), dtype=np.int32)
    position[built.order] = built.twin
    plane, ends = plane_of(built), position[graph.segments]
    pieces = insert_segments(plane, ends, lambda done, _: advance(points + done))
    if pieces is None:
        return None
    edges = in_order(plane, ends, pieces)
    if task.arrangement is not None:
        edges = of_source(edges, task.arrangement.incidence)
    return assembled(task, built, edges, cut_out(task, built, edges))


def constrained_delaunay(
    pslg: PSLG,
    *,
    carve: bool | Carve | str = True,
    crossings: Crossings | str = Crossings.ERROR,
    seed: int = 0,
    progress: Progress | None = None,
) -> Triangulation:
    """Return the constrained Delaunay triangulation of the domain of a planar straight line graph: exact, and unique.

    Every segment is an edge, or a chain of edges where vertices lie on it; no vertex lies inside the circumcircle of a
    triangle from which it can be seen past the segments. Cocircular points are triangulated as by
    :func:`exactmesh.delaunay`, so the result depends on the graph alone, up to numbering.

    Args:
        pslg: points, segments, seeds of holes and regions.
        carve: True keeps the domain by the graph's own rule, a :class:`Carve` or its name by that one; False keeps the
            whole convex hull, holes included.
        crossings: what to do about segments that cross; see :class:`Crossings`.
        seed: chooses the random order of insertion, and so the time it takes, never the result.
        progress: called now and then with (points and segments done, points and segments in all).

    Returns:
        A :class:`Triangulation` with ``segments``, their markers, ``chain(i)`` of each input segment, the regions of
        the triangles, and markers of the vertices. Points outside the domain are left out: ``representative`` is -1.

    Raises:
        CrossingError: segments cross; ``pairs`` names them all.
        PSLGError: what is to be carved is not closed, a seed lies outside of the domain, two seeds disagree, or
            nothing is left.
        TooManyCrossingsError: segments cross or overlap so much that the result does not fit into the memory.
        TooFewPointsError, CollinearPointsError, TooManyPointsError, SeedError: as for :func:`exactmesh.delaunay`.
        ChoiceError: ``carve`` or ``crossings`` is none of the words.
        ShapeError: ``pslg`` is no :class:`PSLG`.

    Expected O(n log n) and the edges that segments cross. Reference [Chew 1989], [Shewchuk 2015].

    >>> from exactmesh import PSLG, constrained_delaunay
    >>> square = PSLG([(0, 0), (4, 0), (4, 4), (0, 4), (1, 1), (2, 1), (1, 2)],
    ...               [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 4)], holes=[(1.2, 1.2)])
    >>> mesh = constrained_delaunay(square)
    >>> mesh
    Triangulation(7 vertices, 7 triangles, 7 segments)
    >>> [loop.tolist() for loop in mesh.boundary()]
    [[0, 1, 2, 3], [4, 6, 5]]
    """
    if not isinstance(pslg, PSLG):
        raise ShapeError(f"expected a PSLG, not a {type(pslg).__name__}: make one with PSLG(points, segments)")
    rule = (pslg.rule if carve else None) if isinstance(carve, (bool, np.bool_)) else Carve(carve)
    pslg = pslg if rule in (None, pslg.rule) else pslg.with_rule(rule)
    treatment = Crossings(crossings)
    if rule is Carve.EVEN_ODD:
        check_parity(pslg)
    mesh = triangulated(Task(pslg, pslg, None, rule), seed, progress)
    if mesh is None:
        if treatment is Crossings.ERROR:
            raise CrossingError(crossing_pairs(pslg.points, pslg.segments), pslg.points, pslg.segments)
        arrangement = arrange(pslg)
        mesh = triangulated(Task(arrangement.pslg, pslg, arrangement, rule), seed, progress)
        assert mesh is not None  # an arrangement is planar
    return mesh
