"""Triangulations of a small point set, counted by flips: an algorithm that shares nothing with the enumerators."""

from collections.abc import Iterator
from itertools import pairwise

__all__ = ["count_by_flips"]

Points = list[tuple[int, int]]
Triangle = tuple[int, int, int]


def _turn(points: Points, a: int, b: int, c: int) -> int:
    (ax, ay), (bx, by), (cx, cy) = points[a], points[b], points[c]
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


def _from(a: int, b: int, c: int) -> Triangle:
    """Return a triangle from its smallest corner on."""
    return min((a, b, c), (b, c, a), (c, a, b))


def _first(points: Points) -> frozenset[Triangle]:
    """Return one triangulation: from left to right, each point is joined to what it sees of the hull."""
    order = sorted(range(len(points)), key=points.__getitem__)
    k = next(i for i in range(2, len(order)) if _turn(points, order[0], order[1], order[i]))
    line = order[:k] if _turn(points, order[0], order[1], order[k]) > 0 else order[:k][::-1]
    triangles = {_from(a, b, order[k]) for a, b in pairwise(line)}
    hull = [*line, order[k]]
    for v in order[k + 1 :]:
        n = len(hull)
        sees = [_turn(points, hull[i], hull[(i + 1) % n], v) < 0 for i in range(n)]
        begin = next(i for i in range(n) if sees[i] and not sees[i - 1])
        hull, sees = hull[begin:] + hull[:begin], sees[begin:] + sees[:begin]
        seen = sees.index(False)
        triangles |= {_from(hull[i + 1], hull[i], v) for i in range(seen)}
        hull = [hull[0], v, *hull[seen:]]
    return frozenset(triangles)


def _flips(points: Points, triangles: frozenset[Triangle]) -> Iterator[frozenset[Triangle]]:
    """Yield the triangulations that differ in one diagonal of a strictly convex quadrilateral."""
    apex = {(x, y): z for a, b, c in triangles for x, y, z in ((a, b, c), (b, c, a), (c, a, b))}
    for (a, b), c in apex.items():
        d = apex.get((b, a))
        if a < b and d is not None and _turn(points, d, c, a) > 0 and _turn(points, c, d, b) > 0:
            yield triangles - {_from(a, b, c), _from(b, a, d)} | {_from(d, c, a), _from(c, d, b)}


def count_by_flips(points: Points) -> int:
    """Return how many triangulations flips reach from one of them; that is all there are [Lawson 1977]."""
    first = _first(points)
    reached, frontier = {first}, [first]
    while frontier:
        for other in _flips(points, frontier.pop()):
            if other not in reached:
                reached.add(other)
                frontier.append(other)
    return len(reached)
