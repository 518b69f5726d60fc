"""The faces round admissible triangles: the plane, cut up by edges of the mesh and by segments that it lacks."""

from dataclasses import dataclass
from fractions import Fraction

import numpy as np
import numpy.typing as npt

from exactkernel.batch import orient2d_batch
from exactkernel.context import chunk_size
from exactkernel.jit import jit
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray
from exactmesh.verify.chains import ODD, Marks
from exactmesh.verify.links import BOUNDARY, Links, ends_of
from exactmesh.verify.matching import lexicographic_order
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.planes import CROSSING, DOWN, INNER, LOOSE, QUERY, UP, WHOLE, Plane, flatten, push, sweep_plane
from exactmesh.verify.status import NIL, empty_status
from exactmesh.verify.witness import IndexArray

__all__ = ["Faces", "faces_of", "joined_marks"]

_CHUNK = 1 << 14  # vertices between two looks at Ctrl-C


@dataclass(frozen=True, slots=True)
class Faces:
    """A plane after the sweep.

    Attributes:
        plane: its first ``len(slots)`` edges are rigid.
        outcome: WHOLE, CROSSING or CUT.
        slots: the slots of the rigid edges.
        corner: (v,) the vertex of the mesh at each vertex of the plane, -1 where there is none.
        queries: the vertices of the plane that the queries became.
    """

    plane: Plane
    outcome: int
    slots: IndexArray
    corner: IndexArray
    queries: IndexArray

    @property
    def edges(self) -> IndexArray:
        """The edges of the plane, as far as the sweep came."""
        return np.flatnonzero(self.plane.done)

    def covered(self, sides: IndexArray) -> npt.NDArray[np.bool_]:
        """Tell which sides triangles cover; not the unbounded one, no more than those of the last edge, a spare one."""
        edge, upper = np.minimum(sides >> 1, len(self.plane.low) - 1), sides & 1
        inside, sort = self.plane.inside[edge] > 0, self.plane.sort[edge]
        lower = np.where(sort == UP, False, np.where(sort == DOWN, True, inside))
        found: npt.NDArray[np.bool_] = np.where(upper, inside, lower)
        return found

    def odd(self, sides: IndexArray) -> npt.NDArray[np.bool_]:
        """Tell which sides (not the unbounded one) an odd number of segments separates from infinity."""
        edge = sides >> 1
        found: npt.NDArray[np.bool_] = (self.plane.parity[edge] ^ (self.plane.odd[edge] & ~sides & 1)) > 0
        return found

    @property
    def answers(self) -> tuple[IndexArray, npt.NDArray[np.bool_]]:
        """The side where each query lies, and whether it lies on an edge."""
        return self.plane.place[self.queries], self.plane.on[self.queries] > 0


@dataclass(frozen=True, slots=True)
class Segments:
    """Loose edges before the sweep.

    Attributes:
        ends: (s, 2, 2) in the coordinates of the mesh.
        corners: (s, 2) the corners there, -1 where there is none.
        source: (s,) what the caller calls them.
    """

    ends: FloatArray
    corners: IndexArray
    source: IndexArray


@jit
def push_all(plane: Plane) -> None:
    """Let every edge begin at its lower end."""
    for e in range(plane.size[0]):
        push(plane, e)


def _ranked(points: FloatArray, nodes: int) -> tuple[FloatArray, IndexArray, npt.NDArray[np.int8]]:
    """Return the distinct positions in lexicographic order, the rank of each point, and which ranks are nodes: those
    of the first points."""
    order = lexicographic_order(points)
    ordered = points[order]
    begins = np.ones(len(points), dtype=np.bool_)
    begins[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    rank = np.empty(len(points), dtype=np.intp)
    rank[order] = np.cumsum(begins) - 1
    node = np.full(int(begins.sum()), QUERY, dtype=np.int8)
    node[rank[:nodes]] = 1
    return ordered[begins], rank, node


def _plane(points: FloatArray, node: npt.NDArray[np.int8], low: IndexArray, high: IndexArray, any_loose: bool) -> Plane:
    """Return the plane before the sweep. Cuts make new edges, of which a planar graph has at most three a vertex."""
    size = len(low)
    capacity = size + (3 * len(points) if any_loose else 1)

    def padded(values: IndexArray) -> IndexArray:
        return np.concatenate([values, np.full(capacity - size, NIL, dtype=np.intp)])

    bits = np.zeros((6, capacity), dtype=np.int8)
    return Plane(
        points=points,
        node=node,
        low=padded(low),
        high=padded(high),
        sort=bits[0],
        odd=bits[1],
        joined=bits[2],
        inside=bits[3],
        parity=bits[4],
        done=bits[5],
        source=np.full(capacity, NIL, dtype=np.intp),
        head=np.full(len(points), NIL, dtype=np.intp),
        following=np.full(capacity, NIL, dtype=np.intp),
        last=np.full(len(points), NIL, dtype=np.intp),
        face=np.arange(2 * capacity + 1, dtype=np.intp),
        place=np.full(len(points), NIL, dtype=np.intp),
        on=(node == 1).astype(np.int8),
        size=np.full(1, size, dtype=np.intp),
        witness=np.full(2, NIL, dtype=np.intp),
    )


def faces_of(
    mesh: Mesh,
    links: Links,
    slots: IndexArray,
    odd: npt.NDArray[np.bool_],
    loose: tuple[FloatArray, IndexArray] | None = None,
    queries: FloatArray | None = None,
) -> Faces:
    """Cut the plane up, and locate queries in it. O((e + q) log(e + q)) expected for e edges, cut ones included.

    Args:
        mesh: admissible triangles.
        links: theirs.
        slots: the edges of the mesh that cut, all of the boundary among them.
        odd: for each of these, whether an odd number of segments that are not loose lies there.
        loose: (s, 2, 2) ends of segments in the mesh's coordinates, and (s, 2) the vertices of the mesh there or -1.
        queries: (q, 2) points in the mesh's coordinates.
    """
    ends, corners = loose if loose is not None else (np.empty((0, 2, 2)), np.empty((0, 2), dtype=np.intp))
    segments = Segments(ends, corners, np.arange(len(ends)))
    asked = np.empty((0, 2)) if queries is None else queries
    while True:
        faces = _swept(mesh, links, slots, odd, segments, asked)
        place = _place_of_crossing(mesh, links, faces)
        if place is None:
            flatten(faces.plane.face)
            return faces
        segments = _cut_at(segments, *place)


def _cut_at(segments: Segments, point: FloatArray, corner: int) -> Segments:
    """Cut the segments that run through a point."""
    ends, corners, source = segments.ends, segments.corners, segments.source
    strictly = [_before(ends[:, i], point) & _before(point, ends[:, 1 - i]) for i in range(2)]
    through = np.flatnonzero(strictly[0] | strictly[1])
    through = through[orient2d_batch(ends[through, 0], ends[through, 1], point) == 0]
    halves = np.repeat(ends[through], 2, axis=0)
    names = np.repeat(corners[through], 2, axis=0)
    halves[0::2, 1] = halves[1::2, 0] = point
    names[0::2, 1] = names[1::2, 0] = corner
    kept = np.ones(len(ends), dtype=np.bool_)
    kept[through] = False
    return Segments(
        np.concatenate([ends[kept], halves]),
        np.concatenate([corners[kept], names]),
        np.concatenate([source[kept], np.repeat(source[through], 2)]),
    )


def _before(p: FloatArray, q: FloatArray) -> npt.NDArray[np.bool_]:
    found: npt.NDArray[np.bool_] = (p[..., 0] < q[..., 0]) | ((p[..., 0] == q[..., 0]) & (p[..., 1] < q[..., 1]))
    return found


def _place_of_crossing(mesh: Mesh, links: Links, faces: Faces) -> tuple[FloatArray, int] | None:
    """Return where two loose edges cross, if that is a corner or an end of a segment; the corner or -1 besides.

    Then segments are cut there before the sweep: it looks ahead, and knows only of corners that are ends."""
    if faces.outcome != CROSSING:
        return None
    plane = faces.plane
    e, f = plane.witness.tolist()
    if plane.sort[e] != LOOSE or plane.sort[f] != LOOSE:
        return None
    (ax, ay), (bx, by), (cx, cy), (dx, dy) = (
        (Fraction(x), Fraction(y))
        for v in (plane.low[e], plane.high[e], plane.low[f], plane.high[f])
        for x, y in (plane.points[v].tolist(),)
    )
    s = ((cx - ax) * (dy - cy) - (cy - ay) * (dx - cx)) / ((bx - ax) * (dy - cy) - (by - ay) * (dx - cx))
    x, y = ax + s * (bx - ax), ay + s * (by - ay)
    if Fraction(float(x)) != x or Fraction(float(y)) != y:
        return None
    point = np.array((float(x), float(y)))
    corner = np.flatnonzero((mesh.coordinates == point).all(axis=1) & (links.last > links.first))
    if corner.size:
        return point, int(corner[0])
    end = (plane.points == point).all(axis=1) & (plane.node == 1)
    return (point, -1) if end.any() else None


def _swept(
    mesh: Mesh,
    links: Links,
    slots: IndexArray,
    odd: npt.NDArray[np.bool_],
    segments: Segments,
    queries: FloatArray,
) -> Faces:
    ends = segments.ends
    origin, target, _ = ends_of(links, slots)
    used = np.zeros(len(mesh.points), dtype=np.bool_)
    used[origin] = used[target] = True
    vertices = np.flatnonzero(used)
    together = np.concatenate([mesh.coordinates[vertices], ends.reshape(-1, 2), queries])
    nodes = len(vertices) + 2 * len(ends)
    points, rank, node = _ranked(together, nodes)
    corner = np.full(len(points), -1, dtype=np.intp)
    corner[rank[len(vertices) : nodes]] = segments.corners.ravel()
    corner[rank[: len(vertices)]] = vertices
    rank_of = np.empty(len(mesh.points), dtype=np.intp)
    rank_of[vertices] = rank[: len(vertices)]
    a, b = rank_of[origin], rank_of[target]
    c, d = rank[len(vertices) : nodes].reshape(-1, 2).T
    low, high = (
        np.concatenate([np.minimum(a, b), np.minimum(c, d)]),
        np.concatenate([np.maximum(a, b), np.maximum(c, d)]),
    )
    plane = _plane(points, node, low, high, bool(len(ends)))
    rigid = len(slots)
    plane.sort[:rigid] = np.where(links.kinds[slots] == BOUNDARY, np.where(a < b, UP, DOWN), INNER)
    plane.odd[:rigid] = odd
    plane.odd[rigid : rigid + len(ends)] = 1
    plane.source[:rigid] = slots
    plane.source[rigid : rigid + len(ends)] = segments.source
    push_all(plane)
    outcome = _run(mesh, plane, bool(len(ends)))
    return Faces(plane, outcome, slots, corner, rank[nodes:])


def _run(mesh: Mesh, plane: Plane, any_loose: bool) -> int:
    status, outcome = empty_status(len(plane.low)), WHOLE
    step = chunk_size(mesh.context, _CHUNK)
    for begin in range(0, len(plane.points), step):
        stop = min(begin + step, len(plane.points))
        outcome = sweep_plane(mesh.context, plane, status, any_loose, begin, stop)
        raise_if_interrupted()
        if outcome != WHOLE:
            break
    return outcome


def joined_marks(faces: Faces, marks: Marks, bits: int) -> None:
    """Write into the marks what loose edges lie on edges of the mesh."""
    rigid = len(faces.slots)
    joined = faces.plane.joined[:rigid] > 0
    slots = faces.slots[joined]
    marks[slots] = (
        (marks[slots] & ~np.uint8(ODD))
        | (bits & ~ODD)
        | np.where(faces.plane.odd[:rigid][joined], ODD, 0).astype(np.uint8)
    )
