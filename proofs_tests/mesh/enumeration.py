"""Enumerators: every triangulation of a small point set, every state of a small quad-edge."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import cache
from itertools import combinations, permutations

import numpy as np
from proofs_tests import oracles
from proofs_tests.oracles import RationalPoint, Triangle

from exactkernel.jit import jit
from exactkernel.types import IntArray
from exactmesh import edgealgebra as algebra

__all__ = [
    "CATALAN",
    "CIRCLE_OF_EIGHT",
    "COUNTS",
    "GRIDS",
    "Triangulation",
    "canonical_triangles",
    "count_triangulations",
    "grid",
    "primal_permutations",
    "reachable_states",
    "triangulations",
]

Triangulation = tuple[Triangle, ...]


def grid(width: int, height: int) -> list[tuple[int, int]]:
    return [(x, y) for x in range(width) for y in range(height)]


#: Eight points exactly on one circle: every choice is a tie.
CIRCLE_OF_EIGHT = [(25, 0), (20, 15), (7, 24), (-15, 20), (-25, 0), (-24, -7), (0, -25), (15, -20)]

#: Published numbers of triangulations that use all points. Of convex polygons; of grids, OEIS A082640: with all points,
#: that is, unimodular; its second column is A296165.
CATALAN = {3: 1, 4: 2, 5: 5, 6: 14, 7: 42, 8: 132, 9: 429, 10: 1430}
GRIDS = {(3, 3): 64, (3, 4): 852, (3, 5): 12170, (4, 4): 46456}

#: Point sets with those numbers.
COUNTS: dict[str, tuple[list[tuple[int, int]], int]] = {
    "convex quadrilateral": ([(i, i * i) for i in range(4)], CATALAN[4]),
    "convex hexagon": ([(i, i * i) for i in range(6)], CATALAN[6]),
    "convex octagon": ([(i, i * i) for i in range(8)], CATALAN[8]),
    "cocircular octagon": (CIRCLE_OF_EIGHT, CATALAN[8]),
    "convex decagon": ([(i, i * i) for i in range(10)], CATALAN[10]),
    "3 x 3 grid": (grid(3, 3), GRIDS[3, 3]),
    "3 x 4 grid": (grid(3, 4), GRIDS[3, 4]),
}


def canonical_triangles(triangles: Sequence[Sequence[int]]) -> Triangulation:
    """Return the triangles in order, each from its smallest corner on, with its direction."""
    turned = []
    for row in triangles:
        a, b, c = row
        turned.append(min((a, b, c), (b, c, a), (c, a, b)))
    return tuple(sorted(turned))


def _contains(points: Sequence[RationalPoint], triangle: Triangle, p: RationalPoint) -> bool:
    a, b, c = (points[v] for v in triangle)
    return min(oracles.orient(a, b, p), oracles.orient(b, c, p), oracles.orient(c, a, p)) >= 0


def _empty_triangles(points: Sequence[RationalPoint]) -> list[Triangle]:
    """Every counterclockwise triangle with no further point in its closure."""
    found = []
    for t in combinations(range(len(points)), 3):
        if oracles.has_area(points, t):
            ccw = oracles.counterclockwise(points, t)
            if not any(_contains(points, ccw, p) for i, p in enumerate(points) if i not in t):
                found.append(ccw)
    return found


def _crosses(points: Sequence[RationalPoint], e: tuple[int, int], f: tuple[int, int]) -> bool:
    """Tell whether two segments cross in a point inside both."""
    (a, b), (c, d) = ((points[i], points[j]) for i, j in (e, f))
    return (
        oracles.orient(a, b, c) * oracles.orient(a, b, d) < 0 and oracles.orient(c, d, a) * oracles.orient(c, d, b) < 0
    )


def _hull_edges(points: Sequence[RationalPoint]) -> set[tuple[int, int]]:
    """The pairs with everything on their left or on their line, and nothing between them."""
    edges = set()
    for i, j in permutations(range(len(points)), 2):
        a, b = points[i], points[j]
        others = [p for k, p in enumerate(points) if k not in (i, j)]
        sides = [oracles.orient(a, b, p) for p in others]
        if min(sides) >= 0 and max(sides) > 0 and not any(oracles.on_segment(p, a, b) for p in others):
            edges.add((i, j))
    return edges


def triangulations(points: Sequence[tuple[int, int]]) -> Iterator[Triangulation]:
    """Yield every triangulation of the hull that uses all the points, each once.

    Backtracking over empty triangles: the smallest directed edge that wants a triangle on its left gets one in every
    possible way. Empty triangles whose edges neither cross nor repeat cannot overlap.
    """
    exact = [(Fraction(x), Fraction(y)) for x, y in points]
    on_left: dict[tuple[int, int], list[Triangle]] = {}
    for a, b, c in _empty_triangles(exact):
        for edge in ((a, b), (b, c), (c, a)):
            on_left.setdefault(edge, []).append((a, b, c))
    crossing = {e: {f for f in on_left if _crosses(exact, e, f)} for e in on_left}
    hull = _hull_edges(exact)

    def extend(
        chosen: list[Triangle], used: set[tuple[int, int]], wanting: set[tuple[int, int]]
    ) -> Iterator[Triangulation]:
        if not wanting:
            yield canonical_triangles(chosen)
            return
        for a, b, c in on_left.get(min(wanting), []):
            edges = {(a, b), (b, c), (c, a)}
            if edges & used or any(crossing[edge] & used for edge in edges):
                continue
            backwards = {(j, i) for i, j in edges if (i, j) not in wanting and (i, j) not in hull}
            yield from extend([*chosen, (a, b, c)], used | edges, (wanting - edges) | backwards)

    yield from extend([], set(), hull)


@jit
def _splice_rows(states: IntArray, pairs: IntArray) -> None:
    """Splice each state by its pair; the pairs take turns."""
    for s in range(len(states)):
        p = s % len(pairs)
        algebra.splice(states[s], pairs[p, 0], pairs[p, 1])


def reachable_states(k: int) -> IntArray:
    """Return every ring array that splices reach from k isolated edges (at most 4), breadth first."""
    first = np.empty((1, 4 * k), dtype=np.int32)
    for edge in range(k):
        algebra.make_edge(first[0], 4 * edge)
    pairs = np.array([(a, b) for a, b in combinations(range(4 * k), 2) if (a - b) % 2 == 0], dtype=np.int32)
    places = np.uint64(4) * np.arange(4 * k, dtype=np.uint64)  # an entry is below 16: the state is one number
    found, frontier = first, first
    seen = (first.astype(np.uint64) << places).sum(axis=1)
    while len(frontier):
        results = np.repeat(frontier, len(pairs), axis=0)
        _splice_rows(results, pairs)
        codes, rows = np.unique((results.astype(np.uint64) << places).sum(axis=1), return_index=True)
        new = np.isin(codes, seen, invert=True)
        frontier, seen = results[rows[new]], np.concatenate([seen, codes[new]])
        found = np.concatenate([found, frontier])
    return found


def primal_permutations(states: IntArray) -> set[tuple[int, ...]]:
    """Return onext of the primal quarter-edges alone, of each state."""
    return {tuple(row) for row in (states[:, ::2] // 2).tolist()}


def count_triangulations(points: Sequence[tuple[int, int]]) -> int:
    """Return how many triangulations of the hull use all the points.

    As :func:`triangulations`, but what is still to be covered is known by its boundary alone, the edges that want a
    triangle on their left: regions that are met again are not counted again.
    """
    exact = [(Fraction(x), Fraction(y)) for x, y in points]
    on_left: dict[tuple[int, int], list[Triangle]] = {}
    for a, b, c in _empty_triangles(exact):
        for edge in ((a, b), (b, c), (c, a)):
            on_left.setdefault(edge, []).append((a, b, c))
    crossing = {e: {f for f in on_left if _crosses(exact, e, f)} for e in on_left}

    @cache
    def completions(wanting: frozenset[tuple[int, int]]) -> int:
        if not wanting:
            return 1
        total = 0
        for a, b, c in on_left.get(min(wanting), []):
            edges = {(a, b), (b, c), (c, a)}
            inside = edges - wanting
            if any(crossing[edge] & wanting for edge in inside):
                continue  # it leaves the region
            total += completions(wanting - edges | {(j, i) for i, j in inside})
        return total

    return completions(frozenset(_hull_edges(exact)))
