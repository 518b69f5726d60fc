"""V1 for the second sweep alone: faces, cuts, parities and places are those of trapezoids in fractions."""

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations, product
from random import Random

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.mesh.enumeration import grid, triangulations
from proofs_tests.oracles import RationalPoint, Triangle
from proofs_tests.verify.domain_oracle import Cells

from exactkernel.context import Context, make_context
from exactmesh.verify import planes
from exactmesh.verify.faces import _plane, push_all
from exactmesh.verify.planes import CROSSING, CUT, DOWN, INNER, LOOSE, QUERY, UP, WHOLE, Plane
from exactmesh.verify.status import NIL, empty_status

Edge = tuple[int, int]
TINY = Fraction(1, 2**60)
MESHES = [*triangulations(grid(3, 3))]
#: The corners, and other places.
PLACES = sorted([*grid(3, 3), (0.5, 0.5), (1.5, 0.25), (0.25, 1.5), (1.25, 1.25), (-1, 1), (3, 1), (1, 2.5), (1, 0.5)])
#: Sheared a little, so that none is above another one and the lexicographic order is that of x.
EXACT = [(x + y * Fraction(1, 2**20), y) for x, y in oracles.rationals(PLACES)]
ARRAY = np.array(PLACES, dtype=np.float64)
CONTEXT: Context = make_context(ARRAY)


@dataclass(frozen=True)
class Drawing:
    """Triangles, some of their edges with their sorts and parities, loose segments, and what is asked for."""

    triangles: list[list[RationalPoint]]
    rigid: dict[Edge, int]
    odd: set[Edge]
    loose: list[Edge]

    @property
    def nodes(self) -> set[int]:
        return {v for edge in [*self.rigid, *self.loose] for v in edge}

    @property
    def is_even(self) -> bool:
        """Whether an even number of segments ends wherever one does: otherwise parity depends on the way."""
        ends = Counter(v for edge in [*self.odd, *self.loose] for v in edge)
        return all(times % 2 == 0 for times in ends.values())

    def is_disturbed(self, segment: Edge) -> bool:
        """Whether a segment would cross another one, or end inside of a rigid edge."""
        crossing = any(crosses(segment, e) for e in [*self.rigid, *self.loose])
        return crossing or any(runs_through(e, v) for e in self.rigid for v in segment)

    def covered(self, p: RationalPoint) -> bool:
        return any(all(oracles.orient(t[i - 1], t[i], p) > 0 for i in range(3)) for t in self.triangles)

    def below(self, p: RationalPoint) -> int:
        """How many segments lie below a point."""
        lines = [(EXACT[a], EXACT[b]) for a, b in [*self.odd, *self.loose]]
        return sum(a < p < b and oracles.orient(a, b, p) > 0 for a, b in lines)


def crosses(e: Edge, f: Edge) -> bool:
    (a, b), (c, d) = ((EXACT[v], EXACT[w]) for v, w in (e, f))
    one, other = oracles.orient(a, b, c) * oracles.orient(a, b, d), oracles.orient(c, d, a) * oracles.orient(c, d, b)
    return one < 0 and other < 0


def runs_through(e: Edge, v: int) -> bool:
    """Whether a point lies inside of an edge."""
    return v not in e and oracles.on_segment(EXACT[v], EXACT[e[0]], EXACT[e[1]])


def drawn(seed: int, rows: Sequence[Triangle]) -> Drawing:
    """Some triangles of a triangulation of the grid: all the edges of the boundary, some others, segments."""
    random, name = Random(seed), [PLACES.index(p) for p in grid(3, 3)]
    share = random.choice((0.0, 0.7, 0.7))
    triangles = [tuple(name[v] for v in t) for t in rows if random.random() < share]
    arcs = {(t[i - 1], t[i]) for t in triangles for i in range(3)}
    chosen = Counter(
        (min(t[i - 1], t[i]), max(t[i - 1], t[i])) for t in triangles if random.random() < 0.5 for i in range(3)
    )
    odd = {edge for edge, times in chosen.items() if times % 2}
    rigid = {(min(a, b), max(a, b)): UP if a < b else DOWN for a, b in arcs if (b, a) not in arcs}
    rigid |= {e: INNER for e in arcs if e[0] < e[1] and e[::-1] in arcs and (e in odd or random.random() < 0.5)}
    if rigid and random.random() < 0.3:
        odd ^= {random.choice([*rigid])}
    drawing = Drawing([[EXACT[v] for v in t] for t in triangles], rigid, odd, [])
    peaceful, closed, segments = random.random() < 0.6, random.random() < 0.5, (0, 1, 3, 6, 9)[seed % 5]
    for _ in range(100):
        corners = sorted(random.sample(range(len(PLACES)), 3))
        loop = [*combinations(corners, 2)] if closed else [(corners[0], corners[1])]
        if len(drawing.loose) + len(loop) <= segments and not (peaceful and any(map(drawing.is_disturbed, loop))):
            drawing.loose.extend(loop)
    return drawing


def swept(drawing: Drawing, size: int, any_loose: bool) -> tuple[int, Plane]:
    edges = [*drawing.rigid, *drawing.loose]
    low, high = np.array(edges, dtype=np.intp).reshape(-1, 2).T
    node = np.full(len(PLACES), QUERY, dtype=np.int8)
    node[np.array([*drawing.nodes], dtype=np.intp)] = 1
    plane, r = _plane(ARRAY, node, low, high, any_loose), len(drawing.rigid)
    plane.sort[:r] = [*drawing.rigid.values()]
    plane.odd[: len(edges)] = [edge in drawing.odd for edge in drawing.rigid] + [True] * len(drawing.loose)
    plane.source[: len(edges)] = range(100, 100 + len(edges))
    push_all(plane)
    status, outcome = empty_status(len(plane.low)), WHOLE
    for begin in range(0, len(PLACES), size):
        if outcome == WHOLE:
            stop = min(begin + size, len(PLACES))
            outcome = planes.sweep_plane(CONTEXT, plane, status, any_loose, begin, stop)
    planes.flatten(plane.face)
    return outcome, plane


def beside(e: Edge, side: int) -> RationalPoint:
    """A point next to the middle of an edge, above (1) or below (0) it."""
    (ax, ay), (bx, by) = EXACT[e[0]], EXACT[e[1]]
    step = TINY if side else -TINY
    return (ax + bx) / 2 - step * (by - ay), (ay + by) / 2 + step * (bx - ax)


@pytest.mark.obligation(
    "V1", "the second sweep cuts the plane into the faces that trapezoids tell, or says what is in the way",
    method="differential",
)  # fmt: skip
class TestSweep:
    """On triangles and segments by chance: without a vertex on a rigid edge and without a crossing the sweep is WHOLE;
    otherwise it shows one. Two sides have one face iff trapezoids between them are connected; each upper side is
    covered and separated from infinity as fractions tell; loose edges are cut where vertices lie on them, and joined
    where they coincide; a query lies in the face, or on an edge, where it does lie."""

    @pytest.mark.parametrize("part", range(6))
    def test_outcomes(self, part: int) -> None:
        for seed, rows in enumerate(MESHES[part::6]):
            drawing = drawn(seed + 1000 * part, rows)
            outcome, plane = swept(drawing, 1 + seed % 3, bool(drawing.loose) or seed % 2 == 0)
            clear = not any(runs_through(e, v) for e in drawing.rigid for v in drawing.nodes)
            pairs = combinations([*drawing.rigid, *drawing.loose], 2)
            clear = clear and not any(crosses(e, f) for e, f in pairs)
            assert outcome == WHOLE or not clear
            first, second = plane.witness.tolist()
            edge = (int(plane.low[first]), int(plane.high[first]))
            if outcome == CROSSING:
                other = (int(plane.low[second]), int(plane.high[second]))
                assert crosses(edge, other)
                assert LOOSE in (plane.sort[first], plane.sort[second])
            elif outcome == CUT:
                assert plane.sort[first] != LOOSE
                assert runs_through(edge, second)
            else:
                self.check(drawing, plane, faces=seed % 4 == 0)

    def test_control_all_outcomes(self) -> None:
        """Vertices on rigid edges, and crossings; without either parities that are defined, and others."""
        seen = Counter[tuple[int, bool]]()
        for seed in range(2 * len(MESHES)):
            drawing = drawn(seed, MESHES[seed % len(MESHES)])
            seen[swept(drawing, 3, any_loose=True)[0], drawing.is_even] += 1
        assert min(seen[WHOLE, True], seen[WHOLE, False]) > 0
        assert len({outcome for outcome, _ in seen}) == 3

    def check(self, drawing: Drawing, plane: Plane, *, faces: bool) -> None:
        done = np.flatnonzero(plane.done).tolist()
        ends = {e: (int(plane.low[e]), int(plane.high[e])) for e in done}
        assert len({*ends.values()}) == len(ends)
        assert not any(crosses(one, other) for one, other in combinations(ends.values(), 2))
        rigid = {e: edge for e, edge in ends.items() if plane.sort[e] != LOOSE}
        assert rigid == dict(enumerate(drawing.rigid))
        for e, edge in ends.items():
            assert not any(runs_through(edge, v) for v in drawing.nodes)
            self.check_edge(drawing, plane, e, edge)
        whole = {v: [w for w in drawing.nodes if runs_through(edge, w)] for v, edge in enumerate(drawing.loose)}
        assert len({*ends.values()}) <= len(drawing.rigid) + sum(len(cuts) + 1 for cuts in whole.values())
        self.check_places(drawing, plane, ends)
        if faces:
            self.check_faces(drawing, plane, ends)

    def check_edge(self, drawing: Drawing, plane: Plane, e: int, edge: Edge) -> None:
        r = len(drawing.rigid)
        ends = [EXACT[v] for v in edge]
        lines = [(EXACT[a], EXACT[b]) for a, b in drawing.loose]
        there = [i for i, (a, b) in enumerate(lines) if all(oracles.on_segment(p, a, b) for p in ends)]
        assert plane.odd[e] == (len(there) + (edge in drawing.odd)) % 2
        if plane.sort[e] == LOOSE:
            assert plane.source[e] - 100 - r in there
            assert plane.joined[e] == (len(there) > 1)
        else:
            assert plane.source[e] == 100 + e
            assert plane.joined[e] == bool(there)
        assert plane.inside[e] == drawing.covered(beside(edge, 1))
        if drawing.is_even:
            assert plane.parity[e] == drawing.below(beside(edge, 1)) % 2

    def check_places(self, drawing: Drawing, plane: Plane, ends: dict[int, Edge]) -> None:
        for v in range(len(PLACES)):
            place, on = int(plane.place[v]), bool(plane.on[v])
            below = place >> 1
            through = {e for e, edge in ends.items() if v in edge or runs_through(edge, v)}
            assert on == (v in drawing.nodes or bool(through))
            if v in drawing.nodes:
                assert below in through
            elif through:
                assert {below} == through
                sort = plane.sort[below]
                assert place & 1 == (sort != DOWN)
                assert sort == LOOSE or drawing.covered(beside(ends[below], place & 1))

    def check_faces(self, drawing: Drawing, plane: Plane, ends: dict[int, Edge]) -> None:
        lines = [(EXACT[a], EXACT[b]) for a, b in {*ends.values()}]
        cells = Cells(lines, [], [EXACT[v] for v in range(len(PLACES))])

        def face_at(p: RationalPoint) -> int:
            return next(cells.face[i] for i, t in enumerate(cells.trapezoids) if t.contains(p))

        last = len(plane.face) - 1
        named = [(int(plane.face[last]), cells.face[0])]
        for e, edge in ends.items():
            named += [(int(plane.face[2 * e + side]), face_at(beside(edge, side))) for side in (0, 1)]
        for v in np.flatnonzero(plane.on == 0).tolist():
            named.append((int(plane.face[plane.place[v]]), face_at(EXACT[v])))
        theirs, ours = defaultdict(set), defaultdict(set)
        for found, expected in named:
            theirs[found].add(expected)
            ours[expected].add(found)
        assert all(len(faces) == 1 for faces in (*theirs.values(), *ours.values()))

    def test_rigid_alone(self) -> None:
        """Without loose edges it does not matter whether the sweep looks for cuts."""
        for seed, rows in enumerate(MESHES[::7]):
            drawing = drawn(5 * seed, rows)
            first, second = (swept(drawing, 4, any_loose) for any_loose in (False, True))
            assert first[0] == second[0] == WHOLE
            n = len(drawing.rigid)
            for name in ("inside", "parity", "done"):
                assert getattr(first[1], name)[:n].tolist() == getattr(second[1], name)[:n].tolist()
            assert first[1].on.tolist() == second[1].on.tolist()


@pytest.mark.obligation(
    "V1", "two edges cross iff each separates the ends of the other", method="enumeration", control_in="mutants"
)
class TestCross:
    """All pairs of edges, of which one at least is loose; touching is not crossing, and nothing crosses no edge."""

    def test_pairs(self) -> None:
        edges = [*combinations(range(0, len(PLACES), 2), 2)]
        edges = sorted(edges, key=lambda e: sum(crosses(e, f) for f in edges))  # what lies at index -1 crosses many
        low, high = np.array(edges, dtype=np.intp).T
        plane = _plane(ARRAY, np.ones(len(PLACES), dtype=np.int8), low, high, any_loose=False)
        plane = plane._replace(low=low.copy(), high=high.copy())
        seen = Counter[bool]()
        for e, f in product(range(len(edges)), repeat=2):
            expected = crosses(edges[e], edges[f])
            for sorts in ((LOOSE, LOOSE), (LOOSE, UP), (INNER, LOOSE), (DOWN, INNER)):
                if e == f and sorts[0] != sorts[1]:
                    continue
                plane.sort[e], plane.sort[f] = sorts
                plane.witness[:] = -7
                assert planes.cross(CONTEXT, plane, e, f) == (expected and LOOSE in sorts)
                assert plane.witness.tolist() == ([e, f] if expected and LOOSE in sorts else [-7, -7])
            seen[expected] += 1
        assert min(seen.values()) > 50
        plane.sort[:] = LOOSE
        for e in range(len(edges)):
            assert not planes.cross(CONTEXT, plane, NIL, e)
            assert not planes.cross(CONTEXT, plane, e, NIL)
        assert not planes.cross(CONTEXT, plane, NIL, NIL)
        assert any(crosses(edges[-1], f) for f in edges)
        assert len({WHOLE, CROSSING, CUT}) == 3


@pytest.mark.obligation(
    "V1", "gluing joins the faces on both sides of edges, and no others", method="property-based", control_in="mutants"
)
class TestGlue:
    """The classes are those of sets that are merged; each side points to one of its class."""

    @pytest.mark.parametrize("seed", range(6))
    def test_classes(self, seed: int) -> None:
        random, n = Random(seed), 30
        face = np.arange(2 * n + 1, dtype=np.intp)
        for side in range(2 * n):
            if random.random() < 0.4:
                face[side] = random.randrange(side, 2 * n + 1)
        parts = {side: {side} for side in range(2 * n + 1)}

        def merge(a: int, b: int) -> None:
            together = parts[a] | parts[b]
            for side in together:
                parts[side] = together

        for side, parent in enumerate(face.tolist()):
            merge(side, parent)
        edges = random.sample(range(n), 5)
        planes.glue(face, np.array(edges, dtype=np.intp))
        planes.flatten(face)
        for e in edges:
            merge(2 * e, 2 * e + 1)
        for side in range(2 * n + 1):
            assert {s for s in range(2 * n + 1) if face[s] == face[side]} == parts[side]
            assert face[face[side]] == face[side]
