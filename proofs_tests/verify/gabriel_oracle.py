"""Diametral circles, circumcentres and visibility from their definitions, in fractions."""

from collections import Counter
from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import combinations, pairwise

from proofs_tests import oracles
from proofs_tests.oracles import RationalPoint, Triangle

__all__ = ["centres_inside", "encroachers", "outline_edges"]

Pair = tuple[int, int]


def outline_edges(
    points: Sequence[RationalPoint], triangles: Iterable[Triangle], segments: Iterable[Pair]
) -> set[Pair]:
    """The edges of one triangle only, and those on a segment."""
    counts = Counter(tuple(sorted(pair)) for t in triangles for pair in combinations(t, 2))
    lines = [(points[a], points[b]) for a, b in segments]
    return {
        (a, b)
        for (a, b), count in counts.items()
        if count == 1 or any(all(oracles.on_segment(points[v], *line) for v in (a, b)) for line in lines)
    }


def _interval(p: RationalPoint, q: RationalPoint, corners: Sequence[RationalPoint]) -> tuple[Fraction, Fraction] | None:
    """Return the parameters between which the segment pq is in the closed counterclockwise triangle."""
    low, high = Fraction(0), Fraction(1)
    for a, b in zip(corners, [*corners[1:], corners[0]], strict=True):
        start, end = oracles.orient(a, b, p), oracles.orient(a, b, q)
        if start < 0 and end < 0:
            return None
        if start != end:
            crossing = start / (start - end)
            low, high = (
                (max(low, crossing), high) if start < 0 else ((low, min(high, crossing)) if end < 0 else (low, high))
            )
    return (low, high) if low <= high else None


def _is_inside(p: RationalPoint, q: RationalPoint, solid: Sequence[Sequence[RationalPoint]]) -> bool:
    """Tell whether the segment pq lies in the union of closed triangles."""
    reached = Fraction(0)
    for low, high in sorted(found for corners in solid if (found := _interval(p, q, corners)) is not None):
        if low > reached:
            return False
        reached = max(reached, high)
    return reached == 1 and any(_interval(p, p, corners) is not None for corners in solid)


def _sees(
    p: RationalPoint,
    a: RationalPoint,
    b: RationalPoint,
    corners: set[RationalPoint],
    solid: Sequence[Sequence[RationalPoint]],
) -> bool:
    """Tell whether some x strictly between a and b is joined to p within the union.

    What p sees of ab changes only where a line from p through a corner meets it.
    """
    critical = {Fraction(0), Fraction(1)}
    for v in corners:
        start, end = oracles.orient(p, v, a), oracles.orient(p, v, b)
        if start != end and 0 < start / (start - end) < 1:
            critical.add(start / (start - end))
    ordered = sorted(critical)
    tried = ordered[1:-1] + [(s + t) / 2 for s, t in pairwise(ordered)]
    return any(_is_inside((a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])), p, solid) for t in tried)


def encroachers(
    points: Sequence[RationalPoint], triangles: Sequence[Triangle], segments: Iterable[Pair]
) -> set[tuple[Pair, int]]:
    """Return the edges that should be Gabriel with the corners that are inside their circles and visible."""
    turned = [oracles.counterclockwise(points, t) for t in triangles]
    solid = [[points[v] for v in t] for t in turned]
    used = {v for t in triangles for v in t}
    found = set()
    for a, b in outline_edges(points, triangles, segments):
        for v in used - {a, b}:
            p, (ax, ay), (bx, by) = points[v], points[a], points[b]
            inside = (p[0] - ax) * (p[0] - bx) + (p[1] - ay) * (p[1] - by) < 0
            if inside and _sees(p, points[a], points[b], {points[w] for w in used}, solid):
                found.add(((a, b), v))
    return found


def centres_inside(points: Sequence[RationalPoint], triangles: Sequence[Triangle]) -> bool:
    """Tell whether every circumcentre lies in some closed triangle."""
    turned = [[points[v] for v in oracles.counterclockwise(points, t)] for t in triangles]
    return all(
        any(_interval(centre, centre, corners) is not None for corners in turned)
        for centre in (oracles.circumcircle(*corners)[0] for corners in turned)
    )
