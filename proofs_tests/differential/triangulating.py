"""Triangulations by brute force, from a table of signs: Delaunay by empty circles, constrained by greedy and flips."""

from collections import Counter
from collections.abc import Iterable, Sequence
from itertools import combinations, pairwise

from proofs_tests.differential.table import Table

__all__ = [
    "Edge",
    "Triangle",
    "constrained",
    "counterclockwise",
    "crossing_segments",
    "delaunay",
    "domain",
    "pieces_of",
]

Edge = tuple[int, int]  # the smaller rank first
Triangle = tuple[int, int, int]  # ranks in increasing order


def counterclockwise(table: Table, t: Triangle) -> Triangle:
    a, b, c = t
    return t if table.twice[a][b][c] > 0 else (a, c, b)


def delaunay(table: Table) -> set[Triangle]:
    """Return every triangle with an area whose perturbed circle is empty: each four points spoil two or more."""
    spoilt: set[Triangle] = set()
    everyone = range(table.n)
    for four in combinations(everyone, 4):
        i, j, k, m = four
        conflict = table.circle_of(i, j, k, m)[1]
        t = table.twice
        if t[i][j][k] * conflict > 0:
            spoilt.add((i, j, k))
        if t[i][j][m] * conflict < 0:
            spoilt.add((i, j, m))
        if t[i][k][m] * conflict > 0:
            spoilt.add((i, k, m))
        if t[j][k][m] * conflict < 0:
            spoilt.add((j, k, m))
    return {t for t in combinations(everyone, 3) if table.twice[t[0]][t[1]][t[2]] and t not in spoilt}


def pieces_of(table: Table, segments: Sequence[Edge]) -> list[list[Edge]]:
    """Return the pieces of each segment between points."""
    return [list(pairwise(table.between(a, b))) for a, b in segments]


def crossing_segments(table: Table, pieces: Sequence[Sequence[Edge]]) -> list[tuple[int, int]]:
    """Return the pairs of segments of which two pieces cross."""
    return [
        (s, t)
        for s, t in combinations(range(len(pieces)), 2)
        if any(table.cross(p, q) for p in pieces[s] for q in pieces[t])
    ]


def constrained(table: Table, fixed: set[Edge]) -> set[Triangle]:
    """Return the constrained Delaunay triangulation of the hull: edges that cross nothing are added, the fixed ones
    first, until there are no more; then those that are not fixed and not locally Delaunay are flipped."""
    edges = set(fixed)
    for edge in combinations(range(table.n), 2):
        if edge not in edges and len(table.between(*edge)) == 2 and not any(table.cross(edge, e) for e in edges):
            edges.add(edge)
    found = {
        t
        for t in combinations(range(table.n), 3)
        if table.twice[t[0]][t[1]][t[2]] and edges.issuperset(combinations(t, 2)) and not _covers_a_point(table, t)
    }
    while (bad := _first_bad(table, found, fixed)) is not None:
        (u, v), w, x = bad
        found -= {_sorted(u, v, w), _sorted(u, v, x)}
        found |= {_sorted(u, w, x), _sorted(v, w, x)}
    return found


def _sorted(a: int, b: int, c: int) -> Triangle:
    a, b, c = sorted((a, b, c))
    return a, b, c


def _covers_a_point(table: Table, t: Triangle) -> bool:
    a, b, c = counterclockwise(table, t)
    ab, bc, ca = table.twice[a][b], table.twice[b][c], table.twice[c][a]
    return any(min(ab[p], bc[p], ca[p]) >= 0 for p in range(table.n) if p not in t)


def apexes(triangles: Iterable[Triangle]) -> dict[Edge, list[int]]:
    """Return the third corners of the triangles at each edge."""
    found: dict[Edge, list[int]] = {}
    for a, b, c in triangles:
        for edge, apex in (((a, b), c), ((a, c), b), ((b, c), a)):
            found.setdefault(edge, []).append(apex)
    return found


def _first_bad(table: Table, triangles: set[Triangle], fixed: set[Edge]) -> tuple[Edge, int, int] | None:
    for edge, corners in apexes(triangles).items():
        if edge not in fixed and len(corners) == 2:
            w, x = corners
            a, b, c = counterclockwise(table, _sorted(*edge, w))
            if table.incircle(a, b, c, x)[1] > 0:
                return edge, w, x
    return None


def domain(
    table: Table, triangles: set[Triangle], pieces: Sequence[Sequence[Edge]], dug: set[Triangle], *, even_odd: bool
) -> tuple[set[Triangle], bool]:
    """Return the triangles of the domain, and whether some piece has the exterior on both sides.

    A face is what is connected over edges that are no pieces. It is exterior if it reaches the rim of the hull over
    such an edge, a hole if one of its triangles was dug or, by even-odd, if an even number of segments is between it
    and infinity.
    """
    count = Counter(piece for chain in pieces for piece in chain)
    around = apexes(triangles)
    exterior: set[Triangle] = set()
    inside: set[Triangle] = set()
    hollow: set[Triangle] = set()
    for face in _faces(triangles, around, set(count)):
        rim = [edge for t in face for edge in combinations(t, 2) if len(around[edge]) == 1 and edge not in count]
        if rim:
            exterior |= face
        elif face & dug or (even_odd and _parity(table, count, min(face)) == 0):
            hollow |= face
        else:
            inside |= face
    is_open = any(all(_sorted(*edge, apex) in exterior for apex in around[edge]) for edge in count)
    return inside, is_open


def _faces(triangles: set[Triangle], around: dict[Edge, list[int]], fixed: set[Edge]) -> list[set[Triangle]]:
    left, faces = set(triangles), []
    while left:
        start = left.pop()
        face, waiting = {start}, [start]
        while waiting:
            for edge in combinations(waiting.pop(), 2):
                if edge not in fixed:
                    new = {_sorted(*edge, apex) for apex in around[edge]} & left
                    left -= new
                    face |= new
                    waiting.extend(new)
        faces.append(face)
    return faces


def _parity(table: Table, count: Counter[Edge], t: Triangle) -> int:
    """Return how many segments a ray from the triangle's centroid to the right crosses, modulo 2."""
    x, y = (sum(table.at[v][axis] for v in t) for axis in (0, 1))  # three times the centroid
    crossed = 0
    for (a, b), times in count.items():
        (ax, ay), (bx, by) = sorted(((3 * table.at[v][0], 3 * table.at[v][1]) for v in (a, b)), key=lambda p: p[1])
        if ay <= y < by and (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0:
            crossed += times
    return crossed % 2
