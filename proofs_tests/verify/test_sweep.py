"""V1 for the plane sweep alone: of any boundary it tells what a look at all pairs of edges tells."""

import sys
from collections import Counter
from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations, permutations, product
from random import Random

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.oracles import RationalPoint, Triangle

from exactkernel.context import make_context
from exactmesh.verify import sweep
from exactmesh.verify.sweep import COVERED_TWICE, IMPROPER, PROPER, swept

Edge = tuple[int, int]
#: Many on a line, above each other, and on one circle.
LATTICE = [(x, y) for x in range(4) for y in range(3)]
SCATTERED = [(0, 0), (0, 7), (1, 3), (2, 5), (3, 1), (4, 4), (6, 0), (6, 6), (7, 2)]
TINY = Fraction(1, 2**80)


def boundary_of(triangles: Sequence[Triangle]) -> list[Edge]:
    """The directed edges that no reverse matches; none is listed twice."""
    edges = {(t[i - 1], t[i]) for t in triangles for i in range(3)}
    return [(a, b) for a, b in edges if (b, a) not in edges]


def meet_improperly(points: Sequence[RationalPoint], e: Edge, f: Edge) -> bool:
    """Whether two edges have a point in common that is no end of both."""
    (a, b), (c, d) = ((points[v], points[w]) for v, w in (e, f))
    ends = [v for v in e if v not in f and oracles.on_segment(points[v], c, d)]
    ends += [v for v in f if v not in e and oracles.on_segment(points[v], a, b)]
    sides = oracles.orient(a, b, c) * oracles.orient(a, b, d), oracles.orient(c, d, a) * oracles.orient(c, d, b)
    return bool(ends) or (sides[0] < 0 and sides[1] < 0)


def covers(points: Sequence[RationalPoint], triangles: Sequence[Triangle], edge: Edge) -> int:
    """How many triangles contain the points to the left of an edge that are close to its lower end."""
    low, high = points[min(edge)], points[max(edge)]
    dx, dy = (points[edge[1]][i] - points[edge[0]][i] for i in range(2))
    x, y = (low[i] + TINY * (high[i] - low[i]) for i in range(2))
    p = x - TINY * TINY * dy, y + TINY * TINY * dx
    corners = [[points[v] for v in t] for t in triangles]
    return sum(all(oracles.orient(t[i - 1], t[i], p) > 0 for i in range(3)) for t in corners)


def sets_of(points: Sequence[tuple[int, int]], seed: int, count: int) -> list[list[Triangle]]:
    """Sets of counterclockwise triangles with area, no directed edge of which occurs twice."""
    random, exact = Random(seed), oracles.rationals(points)
    every = [
        oracles.counterclockwise(exact, t)
        for t in combinations(range(len(points)), 3)
        if oracles.orient(*(exact[v] for v in t))
    ]
    small = sorted(every, key=lambda t: oracles.orient(*(exact[v] for v in t)))[: len(every) // 3]
    found = list[list[Triangle]]()
    while len(found) < count:
        chosen = list[Triangle]()
        used = set[Edge]()
        for t in random.sample(random.choice((every, small)), random.choice((1, 2, 2, 3, 5, 9))):
            edges = {(t[i - 1], t[i]) for i in range(3)}
            if not edges & used:
                chosen.append(t)
                used |= edges
        found.append(chosen)
    return found


def told(points: Sequence[tuple[int, int]], edges: Sequence[Edge]) -> tuple[int, list[Edge]]:
    """What the sweep says of directed edges between points in lexicographic order."""
    used = sorted({v for edge in edges for v in edge})
    rank = {v: i for i, v in enumerate(used)}
    array = np.array([points[v] for v in used], dtype=np.float64)
    origin, target = np.array([[rank[v], rank[w]] for v, w in edges], dtype=np.intp).T
    fault, *shown = swept(make_context(array), array, origin, target)
    if fault == PROPER:
        assert shown == [-1, -1]
        return fault, []
    return fault, [edges[i] for i in shown]


@pytest.mark.obligation(
    "V1", "the sweep tells whether edges meet improperly or cover twice, and shows two that do", method="differential"
)
class TestSwept:
    """PROPER iff no two edges meet but in a common end, and no left side is covered twice; otherwise the two edges that
    are shown do meet so, or have no edge between them and one side that is covered twice. In pieces of any size."""

    @pytest.fixture(autouse=True, params=[1, 3, 1 << 14])
    def chunk(self, request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> int:
        monkeypatch.setattr(sys.modules["exactmesh.verify.sweep"], "_CHUNK", request.param)
        return int(request.param)

    @pytest.mark.parametrize("points", [LATTICE, SCATTERED])
    def test_any_set(self, points: list[tuple[int, int]], chunk: int) -> None:
        exact, seen = oracles.rationals(points), Counter[int]()
        random = Random(chunk)
        for triangles in sets_of(points, chunk, 60):
            edges = boundary_of(triangles)
            random.shuffle(edges)
            fault, shown = told(points, edges)
            seen[fault] += 1
            improper = any(meet_improperly(exact, e, f) for e, f in combinations(edges, 2))
            twice = any(covers(exact, triangles, edge) > 1 for edge in edges)
            assert (fault == PROPER) is not (improper or twice)
            if fault == IMPROPER:
                assert meet_improperly(exact, shown[0], shown[1])
            elif fault == COVERED_TWICE:
                assert covers(exact, triangles, shown[1]) == covers(exact, triangles, shown[0]) + 1 >= 2
        assert min(seen[fault] for fault in (PROPER, IMPROPER, COVERED_TWICE)) > 0

    def test_nested(self) -> None:
        """A triangle inside another one, which touches it nowhere: of both sides of each edge inside."""
        points = [(0, 0), (3, 1), (4, 1), (4, 3), (9, 0), (9, 9)]
        for first, second in permutations([(0, 4, 5), (1, 2, 3)]):
            fault, shown = told(points, boundary_of([first, second]))
            assert fault == COVERED_TWICE
            assert covers(oracles.rationals(points), [first, second], shown[1]) == 2

    def test_control_names(self) -> None:
        """The answers differ."""
        assert len({PROPER, IMPROPER, COVERED_TWICE}) == 3


@pytest.mark.obligation(
    "V1", "two neighbours of the status are tested rightly", method="enumeration", control_in="mutants"
)
class TestNeighbours:
    """All pairs of edges that one vertical line meets, none beginning where the other ends: they meet improperly iff
    they have a point in common that is no common end. Next to nothing, nothing meets."""

    def test_pairs(self) -> None:
        points = [(0, 0), (0, 1), (1, 0), (1, 2), (2, 1), (2, 2), (3, 0), (3, 3)]
        exact = oracles.rationals(points)
        array = np.array(points, dtype=np.float64)
        edges = [(a, b) for b in range(len(points)) for a in range(b)]
        low, high = np.array(edges, dtype=np.intp).T
        none = np.empty(0, dtype=np.intp)
        segments = sweep.Segments(array, low, high, np.ones(len(edges), dtype=np.int8), none, none, none)
        context, seen = make_context(array), Counter[bool]()
        for e, f in product(range(len(edges)), repeat=2):
            (a, b), (c, d) = edges[e], edges[f]
            if e == f or max(a, c) >= min(b, d):
                continue
            expected = meet_improperly(exact, edges[e], edges[f])
            witness = np.full(2, -7, dtype=np.intp)
            assert sweep.neighbours_meet(context, segments, e, f, witness) == expected
            assert witness.tolist() == ([e, f] if expected else [-7, -7])
            seen[expected] += 1
        assert min(seen[True], seen[False]) > 100
        last = len(edges) - 1
        for below, above in product((-1, 0, last), repeat=2):
            if -1 in (below, above):
                assert not sweep.neighbours_meet(context, segments, below, above, witness)
