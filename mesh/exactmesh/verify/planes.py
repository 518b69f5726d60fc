"""The faces of a plane that is cut up by edges: a second sweep, after the triangles are known to be admissible.

There are two sorts of edges. Rigid ones are edges of admissible triangles and meet in common vertices only. Loose ones
are segments of the domain about which nothing is known. Where a loose edge runs through a vertex it is cut in two,
where it lies on another edge it is joined with it, and where it crosses one the sweep stops: so what remains meets in
common vertices only, and no meeting point is ever computed. All edges through the lexicographically smallest crossing
are neighbours just before it, and two of them are tested when they become neighbours, as in the first sweep.

A face is a class of sides of edges: between two neighbours of the status lies one face [Bentley 1979]. A query is a
vertex in which nothing ends; its face is that above the edge below it.
"""

from typing import NamedTuple

from exactkernel.context import Context
from exactkernel.jit import jit
from exactkernel.types import FloatArray, SignArray
from exactmesh.verify.status import NIL, Status, insert, remove
from exactmesh.verify.sweep import turn
from exactmesh.verify.witness import IndexArray

__all__ = [
    "CROSSING",
    "CUT",
    "DOWN",
    "INNER",
    "LOOSE",
    "QUERY",
    "UP",
    "WHOLE",
    "Plane",
    "flatten",
    "glue",
    "push",
    "sweep_plane",
]

# Sorts of edges.
LOOSE = 0
UP = 1  # rigid, with triangles on its upper side only
DOWN = 2  # rigid, with triangles on its lower side only
INNER = 3  # rigid, between triangles

# How the sweep ends.
WHOLE = 0
CROSSING = 1  # a loose edge and another one cross
CUT = 2  # a vertex lies on a rigid edge

QUERY = 2  # value of Plane.node


class Plane(NamedTuple):
    """Edges between ranked vertices, and what the sweep finds out. A side is 2 * edge, or 2 * edge + 1 for the upper.

    Attributes:
        points: float64 (v, 2), distinct, ascending lexicographically: a vertex is its rank.
        node: int8 (v,): 1 where edges may begin and end, QUERY where a point is to be located only.
        low, high: intp (e,): the ends, low < high; a cut shortens an edge and makes a new one.
        sort: int8 (e,): LOOSE, UP, DOWN, INNER.
        odd: int8 (e,): 1 if an odd number of segments lie there.
        joined: int8 (e,): 1 if a loose edge was joined with it.
        inside: int8 (e,): 1 if triangles cover its upper side.
        parity: int8 (e,): 1 if an odd number of segments lie below its upper side.
        done: int8 (e,): 1 when the sweep has passed it.
        source: intp (e,): what the caller calls it; the parts of a loose edge inherit it.
        head, following: intp (v,), (e,): lists of the edges that begin at each vertex.
        last: intp (v,): an edge that ends at the vertex, of those in the status, or NIL.
        face: intp (2e + 1,): the classes of the sides, a forest of parents; the last is the face without bounds.
        place: intp (v,): the side where a query lies; where it lies on an edge, a side of that edge.
        on: int8 (v,): 1 if the query lies on an edge.
        size: intp (1,): edges that are in use.
        witness: intp (2,): two edges, or an edge and a vertex.
    """

    points: FloatArray
    node: SignArray
    low: IndexArray
    high: IndexArray
    sort: SignArray
    odd: SignArray
    joined: SignArray
    inside: SignArray
    parity: SignArray
    done: SignArray
    source: IndexArray
    head: IndexArray
    following: IndexArray
    last: IndexArray
    face: IndexArray
    place: IndexArray
    on: SignArray
    size: IndexArray
    witness: IndexArray


@jit
def find(face: IndexArray, side: int) -> int:
    """Return the representative of a side's face, and halve the way to it."""
    while face[side] != side:
        face[side] = face[face[side]]
        side = face[side]
    return side


@jit
def unite(p: Plane, below: int, above: int) -> None:
    """Make one face of what lies above the one edge and below the other; NIL stands for the end of the plane."""
    last = len(p.face) - 1
    a = find(p.face, last if below == NIL else 2 * below + 1)
    b = find(p.face, last if above == NIL else 2 * above)
    p.face[min(a, b)] = max(a, b)


@jit
def push(p: Plane, e: int) -> None:
    """Let an edge begin at its lower end, which is still to come or just being looked at."""
    p.following[e] = p.head[p.low[e]]
    p.head[p.low[e]] = e


@jit
def seek(k: Context, p: Plane, status: Status, v: int) -> tuple[int, int, int]:
    """Return the neighbours between which v lies, and an edge on which it lies or NIL."""
    below = above = int(NIL)
    node = status.root[0]
    while node != NIL:
        side = 0 if p.high[node] == v else turn(k, p.points, p.low[node], p.high[node], v)
        if side == 0:
            return below, above, node
        if side > 0:
            below = node
            node = status.child[node, 1]
        else:
            above = node
            node = status.child[node, 0]
    return below, above, NIL


@jit
def seek_direction(k: Context, p: Plane, status: Status, e: int) -> tuple[int, int, int]:
    """Return the neighbours between which e begins, and the edge with which it begins to coincide or NIL.

    No edge of the status passes through the beginning of e.
    """
    v = p.low[e]
    below = above = int(NIL)
    node = status.root[0]
    while node != NIL:
        if p.low[node] == v:
            side = turn(k, p.points, v, p.high[node], p.high[e])
        else:
            side = turn(k, p.points, p.low[node], p.high[node], v)
        if side == 0:
            return below, above, node
        if side > 0:
            below = node
            node = status.child[node, 1]
        else:
            above = node
            node = status.child[node, 0]
    return below, above, NIL


@jit
def reaches(k: Context, p: Plane, any_loose: bool, e: int, v: int) -> bool:
    """Tell whether an edge of the status contains v. Among rigid ones, only those that end there do."""
    return bool(p.high[e] == v or (any_loose and turn(k, p.points, p.low[e], p.high[e], v) == 0))


@jit
def clear(k: Context, p: Plane, status: Status, any_loose: bool, v: int, e: int) -> tuple[int, int, int]:
    """Take the edges that contain v out of the status, e one of them; cut those that do not end there.

    Return how that went, and the neighbours below and above v.
    """
    while status.below[e] != NIL and reaches(k, p, any_loose, status.below[e], v):
        e = status.below[e]
    below = int(status.below[e])
    while e != NIL and reaches(k, p, any_loose, e, v):
        above = int(status.above[e])
        if p.high[e] != v:
            if p.sort[e] != LOOSE:
                p.witness[0], p.witness[1] = e, v
                return CUT, below, above
            rest = p.size[0]
            p.size[0] += 1
            p.low[rest], p.high[rest] = v, p.high[e]
            p.sort[rest], p.odd[rest], p.source[rest] = LOOSE, p.odd[e], p.source[e]
            p.high[e] = v
            push(p, rest)
        p.done[e] = 1
        remove(status, e)
        e = above
    return WHOLE, below, e


@jit
def join(p: Plane, e: int, loose: int) -> int:
    """Join a loose edge with e, which begins in the same vertex and direction; the longer one goes on later."""
    end, other = p.high[e], p.high[loose]
    if other < end:
        if p.sort[e] != LOOSE:
            p.witness[0], p.witness[1] = e, other
            return CUT
        p.high[e], p.high[loose] = other, end
        p.last[other] = e
        p.odd[e], p.odd[loose] = p.odd[e] ^ p.odd[loose], p.odd[e]
        p.source[e], p.source[loose] = p.source[loose], p.source[e]
    else:
        p.odd[e] ^= p.odd[loose]
    p.joined[e] = 1
    if end != other:
        p.low[loose] = min(end, other)
        push(p, loose)
    return WHOLE


@jit
def begin(k: Context, p: Plane, status: Status, v: int) -> tuple[int, int]:
    """Put the edges that begin at v into the status, rigid ones first. Return how that went, and one of them or NIL."""
    some = int(NIL)
    for loose in range(2):
        e = p.head[v]
        while e != NIL:
            following = p.following[e]
            if (p.sort[e] == LOOSE) == (loose == 1):
                below, above, same = seek_direction(k, p, status, e)
                if same == NIL:
                    insert(status, e, below, above)
                    p.last[p.high[e]] = e
                    some = int(e)
                elif join(p, same, e) != WHOLE:
                    return CUT, some
            e = following
    return WHOLE, some


@jit
def cross(k: Context, p: Plane, e: int, f: int) -> bool:
    """Tell whether two edges, one of them loose, cross inside both of them."""
    if e == NIL or f == NIL or (p.sort[e] != LOOSE and p.sort[f] != LOOSE):
        return False
    a, b, c, d = p.low[e], p.high[e], p.low[f], p.high[f]
    if turn(k, p.points, a, b, c) * turn(k, p.points, a, b, d) >= 0:
        return False
    if turn(k, p.points, c, d, a) * turn(k, p.points, c, d, b) >= 0:
        return False
    p.witness[0], p.witness[1] = e, f
    return True


@jit
def settle(k: Context, p: Plane, status: Status, v: int, e: int) -> int:
    """Look at the sides of the edges that began at v, e one of them, from below to above."""
    while status.below[e] != NIL and p.low[status.below[e]] == v:
        e = status.below[e]
    unite(p, status.below[e], e)
    if cross(k, p, status.below[e], e):
        return CROSSING
    while e != NIL and p.low[e] == v:
        below, above = status.below[e], status.above[e]
        covered = 0 if below == NIL else p.inside[below]
        p.inside[e] = covered if p.sort[e] == LOOSE or p.sort[e] == INNER else 2 - p.sort[e]
        p.parity[e] = p.odd[e] ^ (0 if below == NIL else p.parity[below])
        unite(p, e, above)
        if cross(k, p, e, above):
            return CROSSING
        e = above
    return WHOLE


@jit
def answer(k: Context, p: Plane, status: Status, v: int) -> None:
    """Locate a query."""
    below, _, e = seek(k, p, status, v)
    p.on[v] = e != NIL
    if e == NIL:
        p.place[v] = len(p.face) - 1 if below == NIL else 2 * below + 1
    else:
        p.place[v] = 2 * e + (p.sort[e] != DOWN)


@jit
def sweep_plane(k: Context, p: Plane, status: Status, any_loose: bool, v_begin: int, v_end: int) -> int:
    """Move the line over some vertices; stop at a crossing, or where a vertex lies on a rigid edge."""
    for v in range(v_begin, v_end):
        if p.node[v] == QUERY:
            answer(k, p, status, v)
            continue
        e, below, above = int(p.last[v]), int(NIL), int(NIL)
        if any_loose:
            below, above, e = seek(k, p, status, v)
        if e != NIL:
            p.place[v] = 2 * e
            outcome, below, above = clear(k, p, status, any_loose, v, e)
            if outcome != WHOLE:
                return outcome
        outcome, some = begin(k, p, status, v)
        if outcome != WHOLE:
            return outcome
        if some != NIL:
            p.place[v] = 2 * some
            outcome = settle(k, p, status, v, some)
            if outcome != WHOLE:
                return outcome
        elif e != NIL:
            unite(p, below, above)
            if cross(k, p, below, above):
                return CROSSING
    return WHOLE


@jit
def glue(face: IndexArray, edges: IndexArray) -> None:
    """Make one face of the two sides of each of the edges."""
    for i in range(len(edges)):
        a, b = find(face, 2 * edges[i]), find(face, 2 * edges[i] + 1)
        face[min(a, b)] = max(a, b)


@jit
def flatten(face: IndexArray) -> None:
    """Let every side point to the representative of its face."""
    for side in range(len(face)):
        face[side] = find(face, side)
