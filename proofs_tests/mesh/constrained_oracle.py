"""Constrained Delaunay triangulations and domains from their definitions, in fractions, by brute force."""

from collections import Counter
from collections.abc import Collection, Iterable, Sequence
from fractions import Fraction
from functools import cmp_to_key, lru_cache
from itertools import combinations, pairwise

from proofs_tests import oracles
from proofs_tests.kernel import oracle as kernel_oracle
from proofs_tests.mesh.enumeration import Triangulation, canonical_triangles
from proofs_tests.oracles import RationalPoint, Triangle

__all__ = [
    "Edge",
    "chain",
    "components",
    "constrained_triangles",
    "contains",
    "crosses",
    "edges_of",
    "in_circle",
    "is_visible",
    "noded",
    "parity",
    "places",
    "signed_area",
]

Edge = frozenset[int]
Segment = tuple[int, int]


def edges_of(t: Triangle) -> list[Edge]:
    return [frozenset(pair) for pair in combinations(t, 2)]


def chain(points: Sequence[RationalPoint], segment: Segment) -> list[int]:
    """The vertices on a closed segment, from its first end to its second; of equal points the first counts."""
    a, b = (points[v] for v in segment)
    on_it = {p: points.index(p) for p in points if oracles.on_segment(p, a, b)}
    return [on_it[p] for p in sorted(on_it, reverse=a > b)]


def noded(points: Sequence[RationalPoint], segments: Iterable[Segment]) -> set[Edge]:
    """The pieces of the segments between vertices."""
    return {frozenset(piece) for s in segments for piece in pairwise(chain(points, s))}


def crosses(points: Sequence[RationalPoint], s: Collection[int], t: Collection[int]) -> bool:
    """Tell whether two segments meet in one point inside both."""
    (a, b), (c, d) = ((points[i] for i in e) for e in (s, t))
    return (
        oracles.orient(a, b, c) * oracles.orient(a, b, d) < 0 and oracles.orient(c, d, a) * oracles.orient(c, d, b) < 0
    )


def in_circle(points: Sequence[RationalPoint], t: Triangle, v: int) -> bool:
    """Tell whether v is in the perturbed circle of the counterclockwise triangle."""
    return kernel_oracle.incircle_perturbed(*(points[w] for w in t), points[v]) > 0


def _turn(p: RationalPoint, q: RationalPoint) -> Fraction:
    return p[0] * q[1] - p[1] * q[0]


def _compare_directions(p: RationalPoint, q: RationalPoint) -> int:
    """Sort counterclockwise what lies within half a turn."""
    return (_turn(p, q) < 0) - (_turn(p, q) > 0)


def _enters(v: RationalPoint, direction: RationalPoint, a: RationalPoint, b: RationalPoint) -> Fraction | None:
    """Return how far along the ray from v, in units of the direction, it crosses the open segment ab, or None."""
    p, q = (a[0] - v[0], a[1] - v[1]), (b[0] - v[0], b[1] - v[1])
    if _turn(direction, p) * _turn(direction, q) >= 0:
        return None
    side = (q[0] - p[0], q[1] - p[1])
    far = _turn(p, side) / _turn(direction, side)
    return far if far > 0 else None


def is_visible(points: Sequence[RationalPoint], pieces: Iterable[Edge], t: Triangle, v: int) -> bool:
    """Tell whether v, outside of the triangle, sees a point inside of it past the pieces.

    No piece meets the inside of the triangle, and pieces do not cross. So between two directions in which an end of a
    piece or a corner lies, what a ray from v meets is always the same: one ray in the middle of each suffices.
    """
    eye = points[v]
    shifted = [(x - eye[0], y - eye[1]) for x, y in points]
    first, *_, last = sorted((shifted[w] for w in t), key=cmp_to_key(_compare_directions))
    between = [p for p in shifted if _turn(first, p) > 0 and _turn(p, last) > 0]
    spread = [first, *sorted(between, key=cmp_to_key(_compare_directions)), last]
    for p, q in pairwise(spread):
        middle = (p[0] + q[0], p[1] + q[1])
        if _turn(p, q) == 0:
            continue
        reached = [_enters(eye, middle, *(points[w] for w in side)) for side in edges_of(t)]
        entry = min(far for far in reached if far is not None)
        blocked = [_enters(eye, middle, *(points[w] for w in piece)) for piece in pieces]
        if not any(far is not None and far <= entry for far in blocked):
            return True
    return False


def _is_empty(points: Sequence[RationalPoint], t: Triangle) -> bool:
    """No vertex lies in the closed triangle besides its corners."""
    a, b, c = (points[v] for v in t)
    others = (p for v, p in enumerate(points) if v not in t)
    return not any(min(oracles.orient(a, b, p), oracles.orient(b, c, p), oracles.orient(c, a, p)) >= 0 for p in others)


@lru_cache(maxsize=64)
def _candidates(points: tuple[RationalPoint, ...]) -> list[tuple[Triangle, list[int]]]:
    """Every empty triangle, counterclockwise, and the vertices in its perturbed circle: segments apart."""
    everyone = range(len(points))
    triples = [oracles.counterclockwise(points, t) for t in combinations(everyone, 3) if oracles.has_area(points, t)]
    empty = [t for t in triples if _is_empty(points, t)]
    return [(t, [v for v in everyone if v not in t and in_circle(points, t, v)]) for t in empty]


def constrained_triangles(points: Sequence[RationalPoint], segments: Iterable[Segment]) -> Triangulation:
    """Every empty triangle of distinct points that no piece cuts and whose circle contains no vertex that it sees."""
    pieces = noded(points, segments)
    found = []
    for t, inside in _candidates(tuple(points)):
        cut = any(crosses(points, piece, side) for piece in pieces for side in edges_of(t))
        if not cut and not any(is_visible(points, pieces, t, v) for v in inside):
            found.append(t)
    return canonical_triangles(found)


def centroid(points: Sequence[RationalPoint], t: Triangle) -> RationalPoint:
    (ax, ay), (bx, by), (cx, cy) = (points[v] for v in t)
    return (ax + bx + cx) / 3, (ay + by + cy) / 3


def parity(points: Sequence[RationalPoint], segments: Iterable[Segment], p: RationalPoint) -> int:
    """How many of the segments a ray from p to the right crosses, modulo 2; ends count with their upper side only."""
    count = 0
    for i, j in segments:
        a, b = sorted((points[i], points[j]), key=lambda q: q[1])
        if a[1] <= p[1] < b[1] and oracles.orient(a, b, p) > 0:
            count += 1
    return count % 2


def components(triangles: Sequence[Triangle], fixed: Collection[Edge]) -> list[set[int]]:
    """Rows of triangles that are connected over edges that are not fixed."""
    groups = [{row} for row in range(len(triangles))]
    for edge in {edge for t in triangles for edge in edges_of(t)} - set(fixed):
        rows = {row for row, t in enumerate(triangles) if edge in edges_of(t)}
        joined = [group for group in groups if group & rows]
        groups = [group for group in groups if not group & rows] + [set().union(*joined)]
    return groups


def contains(points: Sequence[RationalPoint], t: Triangle, p: RationalPoint) -> bool:
    a, b, c = (points[v] for v in t)
    return min(oracles.orient(a, b, p), oracles.orient(b, c, p), oracles.orient(c, a, p)) >= 0


def places(
    points: Sequence[RationalPoint],
    segments: Sequence[Segment],
    triangles: Sequence[Triangle],
    holes: Iterable[RationalPoint],
    *,
    even_odd: bool,
) -> list[str]:
    """Where each triangle of the hull is: "domain", "exterior" (it reaches infinity) or "hole". Whole faces are."""
    pieces = noded(points, segments)
    sides = Counter(edge for t in triangles for edge in edges_of(t))
    open_ = {edge for edge, count in sides.items() if count == 1} - pieces
    found = [""] * len(triangles)
    for face in components(triangles, pieces):
        parities = {parity(points, segments, centroid(points, triangles[row])) for row in face}
        dug = any(contains(points, triangles[row], hole) for row in face for hole in holes)
        place = "hole" if dug or (even_odd and parities == {0}) else "domain"
        if any(edge in open_ for row in face for edge in edges_of(triangles[row])):
            place = "exterior"
        assert len(parities) == 1 or not even_odd
        for row in face:
            found[row] = place
    return found


def signed_area(points: Sequence[RationalPoint], loop: Sequence[int]) -> Fraction:
    """Twice the area, by the shoelace."""
    turned = [*loop[1:], loop[0]]
    return sum((_turn(points[v], points[w]) for v, w in zip(loop, turned, strict=True)), Fraction(0))
