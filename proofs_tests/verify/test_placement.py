"""V1 for where a domain may be in a mesh: every placement, and which segments may be left out, by enumeration."""

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations, pairwise
from random import Random

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.oracles import RationalPoint, Triangle
from proofs_tests.recording import Record
from proofs_tests.verify import domain_oracle, within_oracle
from proofs_tests.verify.test_constrained import Plain
from proofs_tests.verify.test_links import links_of, mesh_of

from exactmesh import delaunay
from exactmesh.verify.chains import IN_DOMAIN, ODD, Marks, edge_slot
from exactmesh.verify.domain import constraints_of
from exactmesh.verify.links import Links
from exactmesh.verify.mesh import index_quads, index_triples, prepared_mesh
from exactmesh.verify.placement import displaced_placements, enters, is_within

Points = Sequence[tuple[float, float]]
Pair = tuple[int, int]
BITS = IN_DOMAIN | ODD


@dataclass(frozen=True)
class Placement:
    """Where a domain is: the corners at its points, the chains of its segments, and how far that is."""

    corner: tuple[int, ...]
    chains: tuple[tuple[int, ...] | None, ...]
    squared: Fraction


@dataclass(frozen=True)
class Question:
    """A mesh, points and segments of a domain, and a distance."""

    points: Points
    triangles: Sequence[Triangle]
    theirs: Points
    segments: Sequence[Pair]
    within: float

    def placements(self) -> list[Placement]:
        """All that may be, those first that move less."""
        exact = tuple(self.corner_at(p) for p in self.own)
        found = [*self.with_chains(exact, Fraction(0))]
        moved = self.moved(exact)
        if moved != exact:
            apart = [oracles.squared_distance(self.mesh[v], p) for v, p in zip(moved, self.own, strict=True) if v >= 0]
            found += self.with_chains(moved, max(apart))
        return found

    @property
    def mesh(self) -> list[RationalPoint]:
        return oracles.rationals(self.points)

    @property
    def own(self) -> list[RationalPoint]:
        return oracles.rationals(self.theirs)

    @property
    def used(self) -> list[int]:
        return sorted({v for t in self.triangles for v in t})

    @property
    def edges(self) -> Counter[frozenset[int]]:
        return Counter(frozenset(pair) for t in self.triangles for pair in combinations(t, 2))

    def corner_at(self, p: RationalPoint) -> int:
        return next((v for v in self.used if self.mesh[v] == p), -1)

    def allowed(self, squared: Fraction) -> bool:
        return self.within == math.inf or squared <= Fraction(self.within) ** 2

    def moved(self, corner: Sequence[int]) -> tuple[int, ...]:
        """Ends of segments at no corner's position are at the nearest corner, as long as segments keep two ends."""
        found = list(corner)
        for v in {end for pair in self.segments for end in pair if corner[end] < 0}:
            if self.used:
                nearest = within_oracle.nearest(self.mesh, self.used, self.own[v])
                if self.allowed(oracles.squared_distance(self.mesh[nearest], self.own[v])):
                    found[v] = nearest
        while True:
            fallen = [pair for pair in self.segments if found[pair[0]] == found[pair[1]] >= 0]
            back = {v for pair in fallen for v in pair if corner[v] < 0}
            if not back:
                return tuple(found)
            found = [-1 if v in back else at for v, at in enumerate(found)]

    def straight(self, corner: Sequence[int], segment: Pair) -> tuple[int, ...] | None:
        """The vertices of a straight chain, if neither end was moved."""
        a, b = segment
        p, q = self.own[a], self.own[b]
        if (
            self.corner_at(p) < 0
            or self.corner_at(q) < 0
            or (corner[a], corner[b]) != (self.corner_at(p), self.corner_at(q))
        ):
            return None
        if not domain_oracle.is_chain(self.mesh, {*self.edges}, corner[a], corner[b]):
            return None
        along = sorted((self.mesh[v], v) for v in self.used if oracles.on_segment(self.mesh[v], p, q))
        return tuple(v for _, v in along)

    def with_chains(self, corner: tuple[int, ...], squared: Fraction) -> Iterator[Placement]:
        chains = [self.straight(corner, segment) for segment in self.segments]
        near: dict[int, tuple[int, ...]] = {}
        for i, (a, b) in enumerate(self.segments):
            if chains[i] is None and corner[a] >= 0 and corner[b] >= 0 and corner[a] != corner[b]:
                ends = corner[a], corner[b], self.own[a], self.own[b]
                best = within_oracle.best_chain(self.mesh, self.triangles, *ends)
                if best is not None and self.allowed(self.farthest(best, i)):
                    near[i] = best
        straight = Counter(frozenset(pair) for chain in chains if chain is not None for pair in pairwise(chain))
        optional = {i for i in near if self.is_optional(i, near, straight, corner)}
        for left_out in [optional, set[int]()][: 2 if optional else 1]:
            taken = [chain if i not in near or i in left_out else near[i] for i, chain in enumerate(chains)]
            apart = [self.farthest(near[i], i) for i in near if i not in left_out]
            yield Placement(corner, tuple(taken), max([squared, *apart]))

    def farthest(self, chain: Sequence[int], segment: int) -> Fraction:
        a, b = self.segments[segment]
        apart = [within_oracle.distance_to_segment(self.mesh[v], self.own[a], self.own[b]) for v in chain[1:-1]]
        return max(apart, default=Fraction(0))

    def is_optional(
        self, i: int, near: dict[int, tuple[int, ...]], straight: Counter[frozenset[int]], corner: Sequence[int]
    ) -> bool:
        """Whether a segment begins and ends outside of the triangles, and others run along all of the boundary that its
        chain runs along."""
        times = Counter(frozenset(pair) for chain in near.values() for pair in pairwise(chain))
        for pair in pairwise(near[i]):
            edge = frozenset(pair)
            if self.edges[edge] == 1 and times[edge] == 1 and not straight[edge]:
                return False
        a, b = self.segments[i]
        return not self.begins_in(corner[a], self.own[b]) and not self.begins_in(corner[b], self.own[a])

    def begins_in(self, v: int, p: RationalPoint) -> bool:
        """Whether the first thousandth of a thousandth of the way from a corner to a place lies in a triangle there."""
        (ax, ay), small = self.mesh[v], Fraction(1, 10**6)
        q = ax + small * (p[0] - ax), ay + small * (p[1] - ay)
        return any(v in t and self.contains(t, q) for t in self.triangles)

    def contains(self, t: Triangle, p: RationalPoint) -> bool:
        corners = [self.mesh[v] for v in t]
        signs = [oracles.orient(corners[i - 1], corners[i], p) for i in range(3)]
        return min(signs) >= 0 or max(signs) <= 0


def question(random: Random) -> Question:
    """Part of a triangulation of a grid, and segments between its points, or a bit beside them, along and across."""
    while True:
        size = random.choice((2, 3))
        points = [(float(x), float(y)) for x in range(size) for y in range(3) if random.random() < 0.8]
        exact = oracles.rationals(points)
        if points and any(oracles.orient(exact[0], p, q) for p in exact for q in exact):
            break
    rows = [(int(a), int(b), int(c)) for a, b, c in delaunay(np.array(points)).triangles]
    triangles = [t for t in rows if random.random() < 0.75]
    moves = random.choice(((0.0,), (0.0, 0.0, 0.125, -0.125)))
    theirs = [(x + random.choice(moves), y + random.choice(moves)) for x, y in points]
    random.shuffle(theirs)
    if random.random() < 0.5:
        theirs.append((random.randrange(5) / 2, random.randrange(5) / 2))
    pairs = [(a, b) for a in range(len(theirs)) for b in range(len(theirs)) if theirs[a] != theirs[b]]
    segments = [random.choice(pairs) for _ in range(random.randint(1, 5))]
    segments += random.sample(segments, random.choice((0, 0, 1)))
    return Question(points, triangles, theirs, segments, random.choice((0.0, 0.125, 0.18, 1.0, math.inf)))


#: Corners, which segments are there, how many segments run along each edge, and the squared distance.
Answer = tuple[list[int], list[bool], dict[frozenset[int], int], Fraction]


def answers(asked: Question) -> list[Answer]:
    """What the verifier yields."""
    outline = constraints_of(None, Plain.of(asked.theirs, asked.segments), None, 0).outline
    assert outline is not None
    cells = index_triples(list(asked.triangles)), index_quads(())
    mesh, positions = prepared_mesh(np.array(asked.points), *cells, outline.points)
    links = links_of(mesh)
    marks = np.zeros(len(links.slots), dtype=np.uint8)
    found = []
    for placed, written in displaced_placements(mesh, links, outline, positions, marks, BITS, asked.within):
        assert placed.within == asked.within
        assert (placed.marks == written).all()
        for v, at in enumerate(placed.corner.tolist()):
            place = positions[v] if at < 0 else mesh.coordinates[at]
            assert placed.coordinates[v].tolist() == place.tolist()
        squared = Fraction(int(placed.squared.numerator), int(placed.squared.denominator))
        found.append((placed.corner.tolist(), placed.present.tolist(), marked(asked, links, written), squared))
        written[:] = 255
        assert not len(written) or (placed.marks != written).all()
    assert not marks.any()
    return found


def marked(asked: Question, links: Links, marks: Marks) -> dict[frozenset[int], int]:
    """The marks of the edges that have any; other slots have none."""
    left, found = marks.copy(), {}
    for edge in asked.edges:
        slot = edge_slot(links, *edge)
        if left[slot]:
            found[edge] = int(left[slot])
        left[slot] = 0
    assert not left.any()
    return found


def expected(asked: Question) -> list[Answer]:
    found = []
    for placement in asked.placements():
        times = Counter(frozenset(pair) for chain in placement.chains if chain is not None for pair in pairwise(chain))
        marks = {edge: IN_DOMAIN | ODD * (count % 2) for edge, count in times.items()}
        present = [chain is not None for chain in placement.chains]
        found.append((list(placement.corner), present, marks, placement.squared))
    return found


@pytest.mark.obligation("V1", "a domain is placed as enumeration places it", method="differential")
class TestPlacements:
    """Each placement that the verifier tries has the corners, the segments, the marks and the distance of enumeration,
    in the same order: first without the segments that may be left out, then with their chains; then both with the ends
    of segments at their nearest corners. What is written to the marks later changes no placement."""

    @pytest.mark.parametrize("seed", range(16))
    def test_random(self, seed: int, record_property: Record) -> None:
        random, seen = Random(seed), set[int]()
        for _ in range(25):
            asked = question(random)
            found = answers(asked)
            assert found == expected(asked), asked
            seen.add(len(found))
        assert seen >= {1, 2}
        record_property("cases", 25)

    def test_control_another_distance(self) -> None:
        """The placements within another distance, where that matters."""
        random, noticed = Random(1), 0
        while noticed < 5:
            asked = question(random)
            found = answers(asked)
            if found[-1][3]:
                assert found != expected(replace(asked, within=0.0))
                noticed += 1


FAN: Points = [(2.0, 2.0), (4.0, 2.0), (3.0, 3.0), (2.0, 4.0), (0.0, 2.0), (2.0, 0.0), (4.0, 1.0)]
ROWS: Sequence[Triangle] = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5), (0, 5, 6), (0, 6, 1)]


@pytest.mark.obligation("V1", "a way begins in the cells at its corner, or not", method="enumeration")
class TestEnters:
    """The way from a corner to a place begins in the closed cells at the corner iff its beginning lies in one of their
    triangles: to every place of a grid, from every corner of every part of a fan, along their edges too."""

    @pytest.mark.parametrize("bits", range(0, 64, 3))
    def test_every_place(self, bits: int) -> None:
        rows = [t for i, t in enumerate(ROWS) if bits >> i & 1]
        asked, mesh = Question(FAN, rows, [], [], 0.0), mesh_of(FAN, rows)
        links = links_of(mesh)
        for v in range(len(FAN)):
            for x in range(5):
                for y in range(5):
                    if (x, y) != FAN[v]:
                        found = enters(mesh.context, mesh.coordinates, links, v, float(x), float(y))
                        assert bool(found) is asked.begins_in(v, (Fraction(x), Fraction(y))), (rows, v, x, y)

    def test_control_without_a_triangle(self) -> None:
        """A triangle less: the ways into it are ways out."""
        mesh = mesh_of(FAN, ROWS[1:])
        assert not enters(mesh.context, mesh.coordinates, links_of(mesh), 0, 4.0, 2.5)
        assert enters(mesh.context, mesh.coordinates, links_of(mesh_of(FAN, ROWS)), 0, 4.0, 2.5)

    def test_distances(self) -> None:
        p, q = np.array([0.0, 0.0]), np.array([3.0, 4.0])
        assert is_within(p, q, 5.0)
        assert is_within(p, q, math.inf)
        assert not is_within(p, q, math.nextafter(5.0, 0.0))
