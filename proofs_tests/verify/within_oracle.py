"""Displaced domains by brute force in fractions: every chain, every nearest corner; no code of the verifier."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import combinations

from proofs_tests import oracles
from proofs_tests.oracles import RationalPoint, Triangle

__all__ = ["Chain", "all_chains", "best_chain", "distance_to_segment", "nearest"]

Chain = tuple[int, ...]


def distance_to_segment(p: RationalPoint, a: RationalPoint, b: RationalPoint) -> Fraction:
    """Return the squared distance: to the nearer end, or to the foot of the perpendicular."""
    length = oracles.squared_distance(a, b)
    t = ((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / length
    t = min(max(t, Fraction(0)), Fraction(1))
    return oracles.squared_distance(p, (a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])))


def all_chains(
    points: Sequence[RationalPoint], triangles: Sequence[Triangle], v: int, w: int, a: RationalPoint, b: RationalPoint
) -> Iterator[Chain]:
    """Yield every chain of edges from v to w that goes ever forward in the direction ab, between the two
    perpendiculars in a and b but for its ends."""

    def along(u: int) -> Fraction:
        return (points[u][0] - a[0]) * (b[0] - a[0]) + (points[u][1] - a[1]) * (b[1] - a[1])

    neighbours: dict[int, set[int]] = {}
    for t in triangles:
        for p, q in combinations(t, 2):
            neighbours.setdefault(p, set()).add(q)
            neighbours.setdefault(q, set()).add(p)
    length = oracles.squared_distance(a, b)

    def extended(chain: Chain) -> Iterator[Chain]:
        for u in neighbours.get(chain[-1], ()):
            if along(u) > along(chain[-1]):
                if u == w:
                    yield (*chain, u)
                elif 0 < along(u) < length:
                    yield from extended((*chain, u))

    return extended((v,))


def best_chain(
    points: Sequence[RationalPoint], triangles: Sequence[Triangle], v: int, w: int, a: RationalPoint, b: RationalPoint
) -> Chain | None:
    """Return that whose farthest inner vertex is nearest; of several the first, a step to the end before all others,
    then by the distance of each vertex, then by its index."""

    def distances(chain: Chain) -> list[Fraction]:
        return [distance_to_segment(points[u], a, b) for u in chain[1:-1]]

    def order(chain: Chain) -> tuple[Fraction, list[tuple[Fraction, int]]]:
        inner = distances(chain)
        steps = [*zip(inner, chain[1:-1], strict=True), (Fraction(-1), w)]
        return max(inner, default=Fraction(-1)), steps

    return min(all_chains(points, triangles, v, w, a, b), key=order, default=None)


def nearest(points: Sequence[RationalPoint], corners: Sequence[int], p: RationalPoint) -> int:
    return min(corners, key=lambda v: (oracles.squared_distance(points[v], p), v))
