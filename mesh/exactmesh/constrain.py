"""Constrained Delaunay triangulation: segments in, one after the other, then what is outside the domain out.

A segment is an edge already, or passes through a vertex, or crosses edges: those go, and the polygons on its two sides
are triangulated anew. Ties are broken by the perturbation that :func:`exactmesh.delaunay` uses, so the result depends
on nothing but the planar straight line graph. Reference [Chew 1989], [Shewchuk 2015].
"""

from enum import StrEnum
from typing import NamedTuple, Self

import numpy as np

from exactkernel.context import chunk_size
from exactkernel.jit import jit, jit_inline
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.cavity import split_along
from exactmesh.columns import MarkerArray
from exactmesh.crossings import Arrangement, Meeting, arrange, find_crossings
from exactmesh.delaunay import Insertion, Progress, insert_points, number_vertices
from exactmesh.edgealgebra import EdgeArray, dest
from exactmesh.errors import ChoiceError, CrossingError, Fault, FaultKind, PSLGError, ShapeError
from exactmesh.extract import triangles_of
from exactmesh.locate import locate_points
from exactmesh.markers import boundary_edges, markers_along, vertex_markers
from exactmesh.ordering import IndexArray
from exactmesh.plane import BoolArray, Plane, march, toward
from exactmesh.pslg import PSLG, Carve
from exactmesh.regions import Place, check_parity, open_faults, places_of, regions_of
from exactmesh.triangulation import Triangulation, work_of

__all__ = ["Crossings", "constrained_delaunay"]

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


class Task(NamedTuple):
    """What to triangulate.

    Attributes:
        graph: a graph whose segments do not cross.
        source: the graph that was given; the same, unless it had crossings.
        arrangement: how the one came from the other, or None.
        rule: which faces to keep; None keeps all.
    """

    graph: PSLG
    source: PSLG
    arrangement: Arrangement | None
    rule: Carve | None


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
        left=np.empty(2 * built.edges, dtype=np.int32), right=np.empty(2 * built.edges, dtype=np.int32),
        stack=np.empty(6 * built.edges, dtype=np.int64),
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
            pieces = np.concatenate([pieces, np.empty_like(pieces)])
        if progress is not None:
            progress(int(turn), len(ends))
    return pieces[:count]


class Constrained(NamedTuple):
    """Constrained edges, in the order of the segments they are part of, and along each.

    Attributes:
        edges: int (p,), their numbers in the quad-edge.
        ends: int32 (p, 2), their ends as positions, in the direction of the first segment they are part of.
        row, segment: int (q,) each: edges[row] is part of the segment.
    """

    edges: IntArray
    ends: IntArray
    row: IntArray
    segment: IntArray


def in_order(plane: Plane, given: IntArray, pieces: EdgeArray) -> Constrained:
    """Sort the pieces of segments; ``given`` (s, 2) are the segments' ends as positions. O(p log p)."""
    xy = plane.xy.reshape(-1, 2)
    order = np.argsort(pieces[:, 1], kind="stable")
    edge, segment = pieces[order].T
    ends = np.stack([plane.org[2 * edge], plane.org[2 * edge + 1]], axis=1)
    forward = precedes(xy[given[:, 0]], xy[given[:, 1]])[segment]
    backward = precedes(xy[ends[:, 0]], xy[ends[:, 1]]) != forward
    ends[backward] = ends[backward][:, ::-1]
    several = np.flatnonzero(np.bincount(segment, minlength=len(given))[segment] > 1)
    along = xy[ends[several, 0]]
    along[~forward[several]] *= -1.0
    ranked = several[np.lexsort((along[:, 1], along[:, 0], segment[several]))]
    edge[several], ends[several] = edge[ranked], ends[ranked]
    first = np.empty(len(plane.fixed), dtype=np.int64)
    first[edge[::-1]] = np.arange(len(edge))[::-1]
    is_first = first[edge] == np.arange(len(edge))
    row = (np.cumsum(is_first) - 1)[first[edge]]
    return Constrained(edge[is_first], ends[is_first], row, segment)


def precedes(p: FloatArray, q: FloatArray) -> BoolArray:
    """Tell for each row whether p is lexicographically smaller than q."""
    before: BoolArray = (p[:, 0] < q[:, 0]) | ((p[:, 0] == q[:, 0]) & (p[:, 1] < q[:, 1]))
    return before


def of_source(edges: Constrained, incidence: MarkerArray) -> Constrained:
    """Return the same edges as parts of the segments that the graph was noded from; O(q log q).

    ``incidence`` has sorted rows (segment of the noded graph, segment it is part of).
    """
    first, last = (np.searchsorted(incidence[:, 0], edges.segment, side) for side in ("left", "right"))
    many = last - first
    row = np.repeat(edges.row, many)
    segment = incidence[np.repeat(last - np.cumsum(many), many) + np.arange(many.sum()), 1].astype(np.int32)
    order = np.argsort(segment, kind="stable")
    return edges._replace(row=row[order], segment=segment[order])


class Cut(NamedTuple):
    """The domain, cut out of the triangulation of the hull.

    Attributes:
        triangles, neighbors: int32 (m, 3) each, the corners as positions.
        region: int32 (m,), the region of each triangle, or -1.
        sides: int (p,): how many triangles of the domain are at each constrained edge.
    """

    triangles: IntArray
    neighbors: IntArray
    region: IntArray
    sides: IntArray


def cut_out(task: Task, built: Insertion, edges: Constrained) -> Cut:
    """Extract the triangles, and keep those of the domain.

    Raises:
        PSLGError: the segments leave the domain open, a seed lies outside of it, or nothing is left of it.
    """
    graph, rule = task.graph, task.rule
    slot = np.full(2 * built.edges, -1, dtype=np.int32)
    positions = np.arange(len(built.order), dtype=np.int32)
    triangles, neighbors = triangles_of(built.ring, built.org, slot, positions)
    sides = slot[2 * edges.edges[:, None] + np.arange(2)]  # of each constrained edge: 4 t + i, negative for the ghost
    fixed, odd = np.zeros_like(triangles, dtype=np.bool_), np.zeros_like(triangles, dtype=np.bool_)
    _mark(fixed, sides)
    _mark(odd, sides[np.bincount(edges.row, minlength=len(sides)) % 2 == 1])
    seeds = np.concatenate([graph.holes, graph.regions[:, :2]])
    found = locate_points(graph.points[built.order], triangles, neighbors, seeds) if len(seeds) else positions[:0]
    place = np.zeros(len(triangles), dtype=np.int32)
    faults: list[Fault] = []
    if rule is not None:
        place, faults = places_of(graph, rule, neighbors, fixed, odd, found)
    around = np.where(sides >= 0, place[sides >> 2], Place.EXTERIOR)
    if rule is Carve.SEEDS:
        lost = (around == Place.EXTERIOR).all(axis=1)
        faults = open_faults(task.source, np.unique(edges.segment[lost[edges.row]])) + faults
    kept = place == Place.DOMAIN
    if not (faults or kept.any()):
        faults = [Fault(FaultKind.EMPTY_DOMAIN, (), "every face is exterior, or a hole")]
    if faults:
        raise PSLGError(faults)
    region = regions_of(graph, neighbors, fixed, place, found[len(graph.holes) :])
    if not kept.all():
        number = np.full(len(kept) + 1, -1, dtype=np.int32)
        number[:-1][kept] = np.arange(kept.sum(), dtype=np.int32)
        triangles, neighbors, region = triangles[kept], number[neighbors[kept]], region[kept]
    return Cut(triangles, neighbors, region, (around == Place.DOMAIN).sum(axis=1))


def _mark(flags: BoolArray, sides: IntArray) -> None:
    real = sides[sides >= 0]
    flags.reshape(-1)[3 * (real >> 2) + (real & 3)] = True


def assembled(task: Task, built: Insertion, edges: Constrained, cut: Cut) -> Triangulation:
    """Number the vertices as their points come in the input, and hand everything over."""
    graph, source = task.graph, task.source
    kept, vertex, representative = number_vertices(built.order, built.twin)
    used = np.zeros(len(kept), dtype=np.bool_)
    used[vertex[cut.triangles]] = True
    if not used.all():
        number = np.full(len(kept) + 1, -1, dtype=np.int32)
        number[:-1][used] = np.arange(used.sum(), dtype=np.int32)
        kept, vertex, representative = kept[used], number[vertex], number[representative]
    inside = cut.sides > 0
    stays = inside[edges.row]
    incidence = np.stack([(np.cumsum(inside) - 1)[edges.row[stays]], edges.segment[stays]], axis=1).astype(np.int32)
    triangles, segments = vertex[cut.triangles], vertex[edges.ends[inside]]
    boundary = boundary_edges(triangles, cut.neighbors)
    attribute = graph.regions[cut.region, 2:3] if len(graph.regions) else np.zeros((len(triangles), 0))
    attributes = graph.point_attributes
    return Triangulation(
        points=graph.points.take(kept, axis=0),
        triangles=triangles,
        neighbors=cut.neighbors,
        representative=representative[: len(source.points)],
        work=work_of(built.k, built.flips),
        pslg=source,
        arrangement=task.arrangement,
        segments=segments,
        segment_markers=markers_along(source, incidence, cut.sides[inside] == 1),
        segment_incidence=incidence[np.lexsort(incidence.T[::-1])],
        vertex_markers=vertex_markers(graph, representative, segments, boundary, source, incidence),
        vertex_attributes=np.zeros((len(kept), 0)) if attributes is None else attributes.take(kept, axis=0),
        triangle_attributes=np.where(cut.region[:, None] >= 0, attribute, 0.0),
        triangle_regions=cut.region,
    )


def triangulated(task: Task, seed: int, progress: Progress | None) -> Triangulation | None:
    """Return the constrained Delaunay triangulation, or None if segments cross."""
    graph = task.graph
    built = insert_points(graph.points, seed=seed, progress=progress)
    position = np.empty(len(built.order), dtype=np.int32)
    position[built.order] = built.twin
    plane, ends = plane_of(built), position[graph.segments]
    pieces = insert_segments(plane, ends)
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
        progress: called now and then with (points done, points in all).

    Returns:
        A :class:`Triangulation` with ``segments``, their markers, ``chain(i)`` of each input segment, the regions of
        the triangles, and markers of the vertices. Points outside the domain are left out: ``representative`` is -1.

    Raises:
        CrossingError: segments cross; ``pairs`` names them all.
        PSLGError: what is to be carved is not closed, a seed lies outside of the domain, two seeds disagree, or
            nothing is left.
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
    rule = (pslg.rule if carve else None) if isinstance(carve, bool) else Carve(carve)
    treatment = Crossings(crossings)
    if rule is Carve.EVEN_ODD:
        check_parity(pslg)
    mesh = triangulated(Task(pslg, pslg, None, rule), seed, progress)
    if mesh is None:
        if treatment is Crossings.ERROR:
            found = find_crossings(pslg.points, pslg.segments)
            raise CrossingError(found.pairs[found.kinds == Meeting.CROSSING])
        arrangement = arrange(pslg)
        mesh = triangulated(Task(arrangement.pslg, pslg, arrangement, rule), seed, progress)
        assert mesh is not None  # an arrangement is planar
    return mesh
