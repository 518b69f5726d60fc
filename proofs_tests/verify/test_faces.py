"""V1 for the plane cut up by segments: pieces, faces, parity and what lies where, against fractions."""

import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, pairwise, product
from random import Random

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.oracles import RationalPoint, Triangle
from proofs_tests.recording import Record
from proofs_tests.verify import domain_oracle
from proofs_tests.verify.domain_oracle import Cells, Line
from proofs_tests.verify.test_links import links_of, mesh_of

from exactmesh.verify.faces import Faces, Segments, _cut_at, faces_of
from exactmesh.verify.links import BOUNDARY, slots_of
from exactmesh.verify.planes import CROSSING, CUT, LOOSE, WHOLE

Points = Sequence[tuple[float, float]]
Place = tuple[float, float]


@dataclass(frozen=True)
class Cut:
    """Triangles over points, whose boundary cuts the plane, loose segments that cut it as well, and queries."""

    points: Points
    triangles: Sequence[Triangle]
    loose: Sequence[tuple[Place, Place]]
    queries: Points
    odd: bool

    @cached_property
    def rigid(self) -> list[Line]:
        exact = oracles.rationals(self.points)
        count = Counter(frozenset(pair) for t in self.triangles for pair in combinations(t, 2))
        return [(exact[min(e)], exact[max(e)]) for e, times in count.items() if times == 1]

    @cached_property
    def lines(self) -> list[Line]:
        ends = [oracles.rationals(segment) for segment in self.loose]
        return [(a, b) for a, b in ends]

    @cached_property
    def nodes(self) -> set[RationalPoint]:
        """Corners of triangles, and ends of segments."""
        exact = oracles.rationals(self.points)
        return {exact[v] for t in self.triangles for v in t} | {p for line in self.lines for p in line}

    def is_whole(self) -> bool:
        """Whether no segment ends inside of an edge, or crosses anything but in a node."""
        for s, t in combinations(self.lines, 2):
            if (p := domain_oracle.cross_inside(s, t)) is not None and p not in self.nodes:
                return False
        for s, (p, q) in product(self.lines, self.rigid):
            if domain_oracle.cross_inside(s, (p, q)) is not None:
                return False
            if any(oracles.on_segment(end, p, q) and end not in (p, q) for end in s):
                return False
        return True

    def pieces(self) -> dict[tuple[RationalPoint, RationalPoint], tuple[int, bool]]:
        """What all lines cut each other into, each piece with its number of odd lines, and whether it is loose."""
        every = [*self.rigid, *self.lines]
        found: dict[tuple[RationalPoint, RationalPoint], tuple[int, bool]] = {}
        for i, line in enumerate(every):
            for p, q in pairwise(domain_oracle.parts_of(line, every)):
                count, loose = found.get((p, q), (0, True))
                is_rigid = i < len(self.rigid)
                found[p, q] = count + (self.odd if is_rigid else 1), loose and not is_rigid
        return found

    def is_covered(self, p: RationalPoint) -> bool:
        exact = oracles.rationals(self.points)
        corners = [[exact[v] for v in t] for t in self.triangles]
        return any(min(oracles.orient(t[i - 1], t[i], p) for i in range(3)) >= 0 for t in corners)

    def below(self, p: RationalPoint) -> int:
        """How many odd lines lie below a point, on a line that is upright but for a trifle."""
        odd = [*(self.rigid if self.odd else ()), *self.lines]
        ordered = [(min(line), max(line)) for line in odd]
        return sum(a[0] <= p[0] < b[0] and domain_oracle.y_at((a, b), p[0]) < p[1] for a, b in ordered)


def swept(cut: Cut) -> Faces:
    mesh = mesh_of(cut.points, cut.triangles)
    links = links_of(mesh)
    slots = slots_of(links, BOUNDARY)
    loose = np.array(cut.loose, dtype=np.float64).reshape(-1, 2, 2)
    exact = oracles.rationals(cut.points)
    used = {exact[v]: v for t in cut.triangles for v in t}
    corners = np.array([[used.get(p, -1) for p in line] for line in cut.lines], dtype=np.intp).reshape(-1, 2)
    odd, queries = np.full(len(slots), cut.odd), np.array(cut.queries, dtype=np.float64).reshape(-1, 2)
    given = (loose, corners) if cut.loose else None
    return faces_of(mesh, links, slots, odd, given, queries if cut.queries else None)


def cut_of(random: Random) -> Cut:
    """Rings of segments over the places of a small grid, and a few triangles that meet admissibly."""
    points: list[Place] = [
        (2.0, 0.0),
        (3.0, 1.0),
        (2.0, 2.0),
        (1.0, 1.0),
        (2.0, 1.0),
        (0.0, 3.0),
        (0.0, 2.0),
        (9.0, 9.0),
    ]
    rows: list[Triangle] = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4), (3, 5, 6)]
    triangles = [t for t in rows if random.random() < 0.5] if random.random() < 0.7 else []
    places = [(float(x), float(y)) for x, y in product(range(4), repeat=2)]
    loose: list[tuple[Place, Place]] = []
    for _ in range(random.choice((0, 1, 1, 2, 3))):
        ring = random.sample(places, random.choice((2, 3, 3, 4)))
        loose += zip(ring, ring[1:] + ring[:1], strict=True)
    queries = [random.choice(places)] * random.choice((0, 1))
    queries += [(random.randrange(-1, 14) / 4, random.randrange(-1, 14) / 4) for _ in range(random.choice((0, 8)))]
    return Cut(points, triangles, loose, queries, random.random() < 0.5)


def faults(cut: Cut, faces: Faces) -> list[str]:
    """Where the sweep and fractions differ."""
    if (faces.outcome == WHOLE) is not cut.is_whole():
        return [f"the outcome is {faces.outcome}"]
    return faults_of_whole(cut, faces) if faces.outcome == WHOLE else faults_of_witness(cut, faces)


def line_of(faces: Faces, e: int) -> Line:
    a, b = oracles.rationals(faces.plane.points[[faces.plane.low[e], faces.plane.high[e]]].tolist())
    return a, b


def faults_of_witness(cut: Cut, faces: Faces) -> list[str]:
    """The sweep stops where it says."""
    plane, (e, f) = faces.plane, faces.plane.witness.tolist()
    if faces.outcome == CROSSING:
        p = domain_oracle.cross_inside(line_of(faces, e), line_of(faces, f))
        loose = (plane.sort[e] == LOOSE) + (plane.sort[f] == LOOSE)
        return [] if p is not None and loose and (p not in cut.nodes or loose == 1) else ["no crossing"]
    (p,), line = oracles.rationals(plane.points[[f]].tolist()), line_of(faces, e)
    on = oracles.on_segment(p, *line) and p not in line and plane.sort[e] != LOOSE
    return [] if faces.outcome == CUT and on and p in cut.nodes else ["no cut"]


def faults_of_whole(cut: Cut, faces: Faces) -> list[str]:
    plane, found, expected = faces.plane, list[str](), cut.pieces()
    exact = oracles.rationals(cut.points)
    corners = {exact[v]: v for t in cut.triangles for v in t}
    named = {p: corners.get(p, -1) for line in [*cut.rigid, *cut.lines] for p in line}
    if faces.corner.tolist() != [named.get(p, -1) for p in oracles.rationals(plane.points.tolist())]:
        found.append("corners")
    told = {line_of(faces, e): (int(plane.odd[e]), bool(plane.sort[e] == LOOSE)) for e in faces.edges.tolist()}
    if told != {line: (count % 2, loose) for line, (count, loose) in expected.items()}:
        found.append("pieces")
    if len(told) != len(faces.edges):
        found.append("pieces told twice")
    for e in faces.edges.tolist():
        if plane.sort[e] == LOOSE:
            s = cut.lines[plane.source[e]]
            if not all(oracles.on_segment(p, *s) for p in line_of(faces, e)):
                found.append("a source")
    return found + faults_of_queries(cut, faces)


def faults_of_queries(cut: Cut, faces: Faces) -> list[str]:
    """A query's side is one of its face; that is covered and odd iff its place is; two have one face or two."""
    queries, (sides, on), found = oracles.rationals(cut.queries), faces.answers, list[str]()
    every = [*cut.rigid, *cut.lines]
    cells = Cells(every, [], queries) if every and queries else None
    seen: dict[int, int] = {}
    for p, side, is_on in zip(queries, sides.tolist(), on.tolist(), strict=True):
        if is_on is not any(oracles.on_segment(p, *line) for line in every):
            found.append(f"{p} on an edge")
        elif is_on and p not in cut.nodes and not oracles.on_segment(p, *line_of(faces, side >> 1)):
            found.append(f"{p} on another edge")
        if (not is_on or p not in cut.nodes) and bool(faces.covered(np.array([side]))[0]) is not cut.is_covered(p):
            found.append(f"{p} covered")
        if is_on or cells is None:
            continue
        (there,) = {face for face, cell in zip(cells.face, cells.trapezoids, strict=True) if cell.contains(p)}
        if seen.setdefault(int(faces.plane.face[side]), there) != there or list(seen.values()).count(there) > 1:
            found.append(f"the face of {p}")
        if side < len(faces.plane.face) - 1 and bool(faces.odd(np.array([side]))[0]) is not bool(cut.below(p) % 2):
            found.append(f"the parity of {p}")
    return found


@pytest.mark.obligation("V1", "the plane is cut up as fractions cut it up", method="differential")
class TestPlane:
    """Segments and the boundary of triangles are swept to an end iff they meet in nodes only; then the edges are the
    pieces of the arrangement, once each, with the parity of the segments there; a query lies where fractions see it,
    in the face, on the edge, with the cover and the parity of its place. Otherwise the witness is a crossing, or a node
    inside an edge. However few vertices are swept at a time."""

    @pytest.mark.parametrize("seed", range(12))
    @pytest.mark.parametrize("size", [1, 3, None])
    def test_random(
        self, seed: int, size: int | None, record_property: Record, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        if size is not None:
            monkeypatch.setattr(sys.modules["exactmesh.verify.faces"], "_CHUNK", size)
        random, seen = Random(100 * seed + (size or 0)), set[int]()
        for _ in range(15):
            cut = cut_of(random)
            faces = swept(cut)
            assert not faults(cut, faces), cut
            seen.add(faces.outcome)
        assert len(seen) > 1
        record_property("cases", 15)

    def test_a_lattice(self) -> None:
        """Lines in three directions through all places of a grid, each of which is cut nearly everywhere."""
        n = 5
        rows = [((float(x), float(y)), (x + 2.0, float(y))) for x in range(n - 2) for y in range(n)]
        columns = [((float(x), 0.0), (float(x), n - 1.0)) for x in range(n)]
        slanted = [((float(x), 0.0), (n - 1.0, n - 1.0 - x)) for x in range(n - 1)]
        slanted += [((0.0, float(y)), (n - 1.0 - y, n - 1.0)) for y in range(1, n - 1)]
        cut = Cut([(50.0, 50.0)], [], [*rows, *columns, *slanted], [], False)
        faces = swept(cut)
        assert faces.outcome == WHOLE
        assert len(faces.edges) == 2 * n * (n - 1) + (n - 1) ** 2

    def test_a_crossing_in_an_end(self) -> None:
        """Where two segments cross, a third one ends; that is no corner of the mesh, whichever it has."""
        points = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]
        loose = [((3.0, 3.0), (9.0, 3.0)), ((2.0, 2.0), (4.0, 4.0)), ((2.0, 4.0), (4.0, 2.0))]
        cut = Cut(points, [(0, 1, 2)], loose, [], True)
        faces = swept(cut)
        assert not faults(cut, faces)
        assert faces.outcome == WHOLE

    def test_a_crossing_beside_an_end(self) -> None:
        """A segment ends on one of two others, where no double is nearer to their crossing."""
        loose = [((0.0, 0.0), (3.0, 1.0)), ((1.0, 0.0), (1.0, 1.0)), ((1.0, 1.0 / 3.0), (5.0, -3.0))]
        for turn in (False, True):
            turned = [((b, a), (d, c)) for (a, b), (c, d) in loose] if turn else loose
            cut = Cut([(50.0, 50.0)], [], turned, [], True)
            faces = swept(cut)
            assert faces.outcome == CROSSING
            assert not faults(cut, faces)

    def test_a_crossing_of_an_edge_comes_first(self) -> None:
        """A segment crosses an edge of the mesh where another one ends: that is seen before the sweep is there."""
        points = [(0.0, 0.0), (1.0, 4.0), (-4.0, 4.0), (2.0, 8.0)]
        loose = [((-1.0, 3.0), (2.0, 1.0)), ((0.5, 2.0), (3.0, 5.0))]
        cut = Cut(points, [(0, 1, 2)], loose, [], True)
        faces = swept(cut)
        assert faces.outcome == CROSSING
        assert not faults(cut, faces)

    def test_control_another_segment(self) -> None:
        """A segment that was not there: the sweep without it is another one."""
        random, noticed = Random(1), 0
        while noticed < 10:
            cut = cut_of(random)
            more = Cut(cut.points, cut.triangles, [*cut.loose, ((5.0, 5.0), (6.0, 5.0))], cut.queries, cut.odd)
            if more.is_whole():
                assert faults(more, swept(cut))
                noticed += 1


@pytest.mark.obligation("V1", "segments are cut where they run through a point", method="enumeration")
class TestCuts:
    """Cut at a point, each segment that has it strictly between its ends is two, which meet there and have its name;
    the others are what they were: for all segments between places of a grid, and each of these, and one between."""

    def cut_at(self, ends: Sequence[tuple[Place, Place]], point: Place) -> Counter[tuple[object, ...]]:
        corners = np.arange(2 * len(ends)).reshape(-1, 2)
        given = Segments(np.array(ends), corners, np.arange(len(ends)) + 100)
        cut = _cut_at(given, np.array(point), 77)
        rows = zip(cut.ends.tolist(), cut.corners.tolist(), cut.source.tolist(), strict=True)
        return Counter((*map(tuple, pair), *names, source) for pair, names, source in rows)

    @pytest.mark.parametrize("point", [*product((0.0, 1.0, 2.0), repeat=2), (0.5, 0.5), (0.5, 1.0)])
    def test_every_segment(self, point: Place) -> None:
        places = [(float(x), float(y)) for x, y in product(range(3), repeat=2)]
        ends = [(p, q) for p, q in product(places, repeat=2) if p != q]
        (exact,) = oracles.rationals([point])
        expected = Counter[tuple[object, ...]]()
        for i, (p, q) in enumerate(ends):
            a, b = oracles.rationals([p, q])
            if exact not in (a, b) and oracles.on_segment(exact, a, b):
                expected.update([(p, point, 2 * i, 77, 100 + i), (point, q, 77, 2 * i + 1, 100 + i)])
            else:
                expected[p, q, 2 * i, 2 * i + 1, 100 + i] += 1
        assert self.cut_at(ends, point) == expected

    def test_control_beside(self) -> None:
        """A point beside a segment by the least that there is."""
        ends = [((0.0, 0.0), (2.0, 2.0))]
        assert len(self.cut_at(ends, (1.0, 1.0))) == 2
        assert len(self.cut_at(ends, (1.0, np.nextafter(1.0, 2.0)))) == 1
