"""V1 and V2 for coverage within a distance: chains, moved corners and the distance itself, against fractions."""

import json
import math
import re
from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import combinations
from random import Random

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.once import once_after
from proofs_tests.oracles import Triangle
from proofs_tests.verify import within_oracle

from exactkernel import BoundError
from exactkernel.types import FloatArray
from exactmesh import PSLG, delaunay, refine
from exactmesh.verify import (
    ChoiceError,
    Kind,
    Property,
    Report,
    Verdict,
    VerificationError,
    displaced,
    placement,
    trial,
    verify,
)
from exactmesh.verify.links import linked
from exactmesh.verify.local import localized
from exactmesh.verify.mesh import index_quads, index_triples, prepared_mesh
from exactmesh.verify.nearest import nearest_corners
from exactmesh.verify.report import root_above

Points = Sequence[tuple[float, float]]
Pair = tuple[int, int]
COVER = (Property.SEGMENTS_PRESENT, Property.COVERS_DOMAIN, Property.DOMAIN_POINTS)


def mesh_of(points: FloatArray) -> list[Triangle]:
    return [(int(a), int(b), int(c)) for a, b, c in delaunay(points).triangles]


def chains_of(
    points: FloatArray, triangles: Sequence[Triangle], lines: FloatArray, ends: Sequence[Pair], within: float
) -> dict[int, tuple[int, ...]]:
    """The chains that the verifier finds for segments with these ends at these corners."""
    flat, corner = lines.reshape(-1, 2), np.array(ends, dtype=np.intp).reshape(-1)
    mesh, positions = prepared_mesh(points, index_triples(triangles), index_quads(()), flat)
    links = linked(len(points), mesh.context, localized(mesh.coordinates, mesh.triangles, mesh.quads))
    rows = np.arange(len(lines), dtype=np.intp)
    segments = np.arange(2 * len(lines), dtype=np.intp).reshape(-1, 2)
    found = displaced.near_chains(mesh, links, flat, positions, segments, corner, rows, within)
    return {
        int(row): tuple(found.vertices[found.start[i] : found.start[i + 1]].tolist())
        for i, row in enumerate(found.rows)
    }


def grid(seed: int) -> FloatArray:
    """A few points of a small grid, not on a line: many are equally near to a segment."""
    random = Random(seed)
    while True:
        points = sorted({(random.randrange(5), random.randrange(4)) for _ in range(random.randrange(5, 12))})
        if len({(a[1] - b[1]) * 60 // (a[0] - b[0]) if a[0] != b[0] else 999 for a, b in combinations(points, 2)}) > 2:
            return np.array(points, dtype=np.float64)


def cases(seed: int) -> tuple[FloatArray, list[Triangle], FloatArray, list[Pair]]:
    """A triangulation of a grid, some triangles taken away; segments whose ends are moved a bit from corners."""
    random, points = Random(seed), grid(seed)
    triangles = [t for t in mesh_of(points) if random.random() < 0.9]
    ends = [(v, w) for v in range(len(points)) for w in range(len(points)) if v != w]
    ends = random.sample(ends, min(30, len(ends)))
    moves = [0.0, 0.0, 0.125, -0.125] if seed % 2 else [0.0]
    lines = np.array([[points[v] + random.choice(moves), points[w] + random.choice(moves)] for v, w in ends])
    return points, triangles, lines, ends


@pytest.mark.obligation(
    "V1", "a displaced segment is the chain of edges that stays nearest, by enumeration of all", method="differential"
)
class TestChains:
    """Of all chains that lead from end to end, ever forward, the verifier takes the one that enumeration finds best, in
    the window of the predicates and outside of it."""

    @pytest.mark.parametrize("spread", [0, 700])
    @pytest.mark.parametrize("seed", once_after(8, range(30)))
    def test_against_enumeration(self, seed: int, spread: int) -> None:
        points, triangles, lines, ends = cases(seed)
        if not triangles:
            return
        if spread:  # a point so near to the origin, and in no triangle, that no power of two helps
            points = np.concatenate([points * 2.0**300, [(2.0**-700, 0.0)]])
            lines = lines * 2.0**300
        exact = oracles.rationals(points.tolist())
        for within in (math.inf, math.ldexp(0.25, 300 if spread else 0)):
            found = chains_of(points, triangles, lines, ends, within)
            for i, (v, w) in enumerate(ends):
                a, b = oracles.rationals(lines[i].tolist())
                if a == b:
                    continue
                best = within_oracle.best_chain(exact, triangles, v, w, a, b)
                inner = [within_oracle.distance_to_segment(exact[u], a, b) for u in (best or ())[1:-1]]
                if within < math.inf and max(inner, default=Fraction(0)) > Fraction(within) ** 2:
                    best = None
                assert found.get(i) == best, (points.tolist(), triangles, lines[i].tolist(), v, w)

    @pytest.mark.once
    def test_control_the_rules_matter(self) -> None:
        """In these cases there are several chains, several with the same bottleneck, and dead ends near the segment."""
        several = ties = greedy = 0
        for seed in range(30):
            points, triangles, lines, ends = cases(seed)
            exact = oracles.rationals(points.tolist())
            for line, (v, w) in zip(lines, ends, strict=True):
                a, b = oracles.rationals(line.tolist())
                if a == b:
                    continue
                chains = [*within_oracle.all_chains(exact, triangles, v, w, a, b)]
                worst = [
                    max((within_oracle.distance_to_segment(exact[u], a, b) for u in c[1:-1]), default=Fraction(-1))
                    for c in chains
                ]
                several += len(chains) > 1
                ties += bool(worst) and worst.count(min(worst)) > 1
                best = within_oracle.best_chain(exact, triangles, v, w, a, b)
                greedy += best is not None and min(chains, key=lambda c: (len(c), c)) != best
        assert min(several, ties, greedy) > 10

    def test_a_long_chain(self) -> None:
        """Thousands of vertices beside a segment, the buffer of chains grows, the distance is that of the farthest."""
        n = 3000
        rng = np.random.default_rng(5)
        below = np.stack([np.arange(1.0, n), rng.random(n - 1) * 2.0**-40], axis=1)
        points = np.concatenate([[(0.0, 0.0)], below, [(n, 0.0), (n / 2, 3.0 * n), (n / 2, -3.0 * n)]])
        triangles = [t for i in range(n) for t in ((i, i + 1, n + 1), (i + 1, i, n + 2))]
        found = chains_of(points, triangles, np.array([[(0.0, 0.0), (float(n), 0.0)]]), [(0, n)], math.inf)
        assert found == {0: tuple(range(n + 1))}
        assert not chains_of(points, triangles, np.array([[(0.0, 0.0), (float(n), 0.0)]]), [(0, n)], 2.0**-41)


@pytest.mark.obligation(
    "V1", "the nearest corner is that of brute force in fractions, ties by index", method="differential"
)
class TestNearest:
    """For points anywhere, at any scale, coincident or on a circle."""

    @pytest.mark.parametrize("seed", range(40))
    def test_against_fractions(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        n = int(rng.integers(1, 200))
        points = rng.random((n, 2))
        if seed % 4 == 0:
            points = rng.integers(0, 12, (n, 2)).astype(np.float64)
        elif seed % 4 == 1:
            points = points * 10.0 ** float(rng.integers(-300, 300))
        elif seed % 4 == 2:
            points = points * [0.0, 1.0]
        else:
            points = np.ldexp(points, rng.integers(-1000, 1000, (n, 2)))
        corners = np.flatnonzero(rng.random(n) < 0.8)
        if not len(corners):
            corners = np.array([0])
        wanted = points[rng.integers(0, n, 12)] + rng.integers(-1, 2, (12, 2)) * np.abs(points).max() / 16
        exact, asked = oracles.rationals(points.tolist()), oracles.rationals(wanted.tolist())
        brute = [within_oracle.nearest(exact, corners.tolist(), p) for p in asked]
        assert nearest_corners(points, corners, wanted).tolist() == brute

    def test_a_circle(self) -> None:
        """All as near as the others, twice: rationals decide, and the first one it is."""
        circle = [(3.0, 4.0), (-3.0, 4.0), (5.0, 0.0), (-4.0, -3.0), (0.0, -5.0), (4.0, 3.0)]
        points = np.array(circle[::-1] * 2)
        assert nearest_corners(points, np.arange(2, 12), np.zeros((1, 2))).tolist() == [2]

    def test_control_in_doubles(self) -> None:
        """Distances in doubles: they are infinite or zero for all, and the first corner is taken."""
        for scale in (1e200, 1e-200):
            points = np.array([(3.0, 3.0), (1.0, 1.0), (2.0, 0.0)]) * scale
            with np.errstate(over="ignore", under="ignore"):
                in_doubles = int((points**2).sum(axis=1).argmin())
            brute = within_oracle.nearest(oracles.rationals(points.tolist()), [0, 1, 2], (Fraction(0), Fraction(0)))
            assert nearest_corners(points, np.arange(3), np.zeros((1, 2))).tolist() == [brute] == [1]
            assert in_doubles != brute


def star_polygon(seed: int, n: int = 9) -> tuple[Points, list[Pair]]:
    """A polygon with slanted sides, and a pentagon inside."""
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.random(n)) * 2 * np.pi
    radii = 1 + rng.random(n) / 2
    outer = [(float(r * np.cos(a)), float(r * np.sin(a))) for r, a in zip(radii, angles, strict=True)]
    inner = [(0.3 * math.cos(seed + k * 1.2566), 0.3 * math.sin(seed + k * 1.2566)) for k in range(5)]
    rings = [(i, (i + 1) % n) for i in range(n)] + [(n + i, n + (i + 1) % 5) for i in range(5)]
    return [*outer, *inner], rings


def slanted(seed: int) -> PSLG:
    points, rings = star_polygon(seed)
    return PSLG(points, rings, holes=[(0.0, 0.0)])


@pytest.mark.obligation(
    "V1",
    "refined meshes cover their domain within exactly the distance that refinement reports",
    method="differential",
    control_in="TestAblation",
)
class TestRefined:
    """Steiner points on slanted segments are rounded: strictly the domain is missed; within any distance it is covered,
    and the distance that is found is the displacement; within the double below it, it is missed again."""

    @pytest.mark.parametrize("seed", range(6))
    def test_our_own(self, seed: int) -> None:
        domain = slanted(seed)
        done = refine(domain, min_angle=25)
        mesh = done.triangulation
        assert not verify(mesh.points, mesh.triangles, domain=domain).ok
        report = verify(mesh.points, mesh.triangles, domain=domain, within=math.inf)
        assert report.ok, str(report)
        assert report.distance_squared == Fraction(str(done.displacement_squared))
        assert report.distance == done.displacement > 0
        assert verify(mesh.points, mesh.triangles, domain=domain, within=report.distance).ok
        below = verify(mesh.points, mesh.triangles, domain=domain, within=math.nextafter(report.distance, 0.0))
        assert not below.ok
        assert below.verdict(Property.SEGMENTS_PRESENT) is not Verdict.HOLDS

    @pytest.mark.parametrize("seed", range(3))
    def test_far_from_the_window(self, seed: int) -> None:
        """Coordinates times 2^-600, and times 2^500: the distance scales along."""
        domain = slanted(seed)
        done = refine(domain, min_angle=20).triangulation
        distance = verify(done.points, done.triangles, domain=domain, within=math.inf).distance
        assert distance is not None
        for scale in (2.0**-600, 2.0**500):
            small = PSLG(domain.points * scale, domain.segments, holes=domain.holes * scale)
            report = verify(done.points * scale, done.triangles, domain=small, within=distance * scale)
            assert report.ok, str(report)
            assert report.distance == distance * scale
            lower = math.nextafter(distance * scale, 0.0)
            assert not verify(done.points * scale, done.triangles, domain=small, within=lower).ok

    @pytest.mark.parametrize("seed", range(3))
    def test_what_is_missing_is_missed(self, seed: int) -> None:
        """A hole that is filled, a hole that nobody asked for, a segment that is not there, a triangle less."""
        domain = slanted(seed)
        mesh = refine(domain, min_angle=20).triangulation
        filled = PSLG(domain.points, domain.segments)
        whole = refine(filled, min_angle=20).triangulation
        open_, closed = (mesh.points, mesh.triangles), (whole.points, whole.triangles)
        assert verify(*closed, domain=filled, within=math.inf).ok
        for (points, triangles), wrong, kind in (
            (open_, filled, Kind.NOT_COVERED),
            (closed, domain, Kind.COVERED_HOLE),
        ):
            report = verify(points, triangles, domain=wrong, within=math.inf)
            assert kind in [v.kind for v in report.findings[Property.COVERS_DOMAIN].violations]
        assert not verify(mesh.points, mesh.triangles[1:], domain=domain, within=math.inf).ok
        joined = {frozenset(pair) for t in mesh.triangles.tolist() for pair in combinations(t, 2)}
        apart = next(i for i in range(9) if {i, 9} not in joined)
        more = PSLG(domain.points, [*domain.segments.tolist(), (apart, 9)], holes=domain.holes)
        assert not verify(mesh.points, mesh.triangles, domain=more, within=1e-3).ok

    @pytest.mark.parametrize("switches", ["pq20Q", "pqa.01Q", "pq30a.05Q"])
    @pytest.mark.parametrize("seed", range(3))
    def test_triangle(self, seed: int, switches: str) -> None:
        """Shewchuk's Triangle: strictly the domain is missed, within what it is, it is covered."""
        triangle = pytest.importorskip("triangle", reason="pip install triangle")
        domain = slanted(seed)
        given = {name: np.array(getattr(domain, name)) for name in ("segments", "holes")} | {
            "vertices": domain.points.copy()
        }
        mesh = triangle.triangulate(given, switches)
        strict = verify(mesh["vertices"], mesh["triangles"], domain=domain, claims=COVER)
        report = verify(mesh["vertices"], mesh["triangles"], domain=domain, within=math.inf, claims=COVER)
        assert report.ok, str(report)
        assert report.distance is not None
        assert strict.ok is (report.distance == 0)
        assert 0 < report.distance < 1e-15
        below = math.nextafter(report.distance, 0.0)
        assert not verify(mesh["vertices"], mesh["triangles"], domain=domain, within=below, claims=COVER).ok


@pytest.mark.obligation(
    "V1",
    "corners that a file format rounded are found, and their distance is exact",
    method="differential",
    control_in="TestAblation",
)
class TestMoved:
    """Coordinates rounded to 32 bits: the domain is covered within the largest distance of a corner from its point or
    of a vertex from its segment, as brute force in fractions measures it, and not within less."""

    @pytest.mark.parametrize("seed", range(4))
    def test_rounded(self, seed: int) -> None:
        domain = slanted(seed)
        mesh = refine(domain, min_angle=20).triangulation
        points = mesh.points.astype(np.float32).astype(np.float64)
        report = verify(points, mesh.triangles, domain=domain, within=1e-5, claims=COVER)
        assert report.ok, str(report)
        exact, given = oracles.rationals(points.tolist()), oracles.rationals(domain.points.tolist())
        triangles = [(int(a), int(b), int(c)) for a, b, c in mesh.triangles]
        at = [within_oracle.nearest(exact, range(len(points)), p) for p in given]
        apart = [oracles.squared_distance(exact[v], p) for v, p in zip(at, given, strict=True)]
        for a, b in domain.segments.tolist():
            chain = within_oracle.best_chain(exact, triangles, at[a], at[b], given[a], given[b])
            assert chain is not None
            apart += [within_oracle.distance_to_segment(exact[v], given[a], given[b]) for v in chain[1:-1]]
        assert report.distance_squared == max(apart)
        assert report.distance is not None
        below = math.nextafter(report.distance, 0.0)
        assert not verify(points, mesh.triangles, domain=domain, within=below, claims=COVER).ok

    def test_isolated_points(self) -> None:
        """Not an end of a segment: its nearest corner counts where it lies in the domain, and not where it does not."""
        square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]
        rings = [(0, 1), (1, 2), (2, 3), (3, 0)]
        points = [*square, (2.0, 2.0)]
        fan = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
        near = PSLG([*square, (2.0, 1.75), (9.0, 9.0)], rings)
        for within, ok in ((0.25, True), (math.nextafter(0.25, 0), False), (math.inf, True)):
            report = verify(points, fan, domain=near, within=within, claims=COVER)
            assert report.ok is ok
            assert report.distance == (0.25 if ok else 0.0)

    def test_ends_do_not_fall_together(self) -> None:
        """A segment both of whose ends are nearest to one corner is not there."""
        square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]
        domain = PSLG(
            [(0.0, 0.0), (4.0, 0.0), (4.25, 2.0), (4.0, 4.0), (0.0, 4.0)], [(i, (i + 1) % 5) for i in range(5)]
        )
        assert not verify(square, [(0, 1, 2), (0, 2, 3)], domain=domain, within=math.inf, claims=COVER).ok
        pair = PSLG([*square, (3.75, 3.5), (3.5, 3.75)], [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5)])
        assert not verify(square, [(0, 1, 2), (0, 2, 3)], domain=pair, within=1, claims=COVER).ok


def damned(within: float | None, more_holes: Points = ()) -> Report:
    """A square lake with a dam in it, within a square: the shore is displaced a bit, the dam not there."""
    outer = [(0.0, 0.0), (12.0, 0.0), (12.0, 12.0), (0.0, 12.0)]
    shore = [(4.0, 4.0), (8.0, 4.0), (8.0, 8.0), (4.0, 8.0)]
    rings = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (4, 6)]
    domain = PSLG([*outer, *shore], rings, holes=[(7.0, 5.0), (5.0, 7.0), *more_holes])
    points = np.array([*outer, *shore, (6.0, 4.0625), (6.0, 7.9375)])
    ring = [
        (0, 1, 8),
        (0, 8, 4),
        (1, 5, 8),
        (1, 2, 5),
        (2, 6, 5),
        (2, 3, 9),
        (2, 9, 6),
        (3, 7, 9),
        (3, 0, 7),
        (0, 4, 7),
    ]
    return verify(points, ring, domain=domain, within=within, claims=COVER)


@pytest.mark.obligation(
    "V1", "what lies outside of the domain may be missing, within any distance, and moves nothing", method="named cases"
)
class TestLeftOut:
    """A segment in a hole is left where it is, although chains along the shore join its ends."""

    def test_a_dam(self) -> None:
        assert not damned(None).ok
        assert damned(math.inf).distance == damned(0.0625).distance == 0.0625
        assert damned(math.inf).ok
        assert not damned(0.0624).ok

    def test_control_all_chains(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Along the shore it is far."""
        monkeypatch.setattr(placement, "_optional", lambda *a: np.zeros(len(a[5].rows), dtype=np.bool_))
        distance = damned(math.inf).distance
        assert distance is not None
        assert distance > 1


def displacements(seed: int) -> Iterator[tuple[Points, list[Triangle], PSLG, float]]:
    """Meshes of grids, some triangles taken away, against polygons near some of their edges."""
    random, points = Random(seed), grid(seed)
    triangles = mesh_of(points)
    for _ in range(6):
        kept = [t for t in triangles if random.random() < random.choice((1.0, 0.8))]
        edges = {(t[i], t[(i + 1) % 3]) for t in kept for i in range(3)}
        hull = sorted((a, b) for a, b in edges if (b, a) not in edges)
        inner = sorted((a, b) for a, b in edges if (b, a) in edges and a < b)
        wanted = hull + random.sample(inner, min(len(inner), 2))
        moved = [(x + random.choice((0, 0, 0.125)), y + random.choice((0, 0, 0.125))) for x, y in points.tolist()]
        if wanted and len(set(moved)) == len(moved):
            drop = random.randrange(len(wanted)) if random.random() < 0.3 else -1
            pairs = [pair for i, pair in enumerate(wanted) if i != drop]
            ends = sorted({v for pair in pairs for v in pair})
            domain = PSLG([moved[v] for v in ends], [(ends.index(a), ends.index(b)) for a, b in pairs])
            yield points.tolist(), kept, domain, random.choice((0.0, 0.125, 0.18, 0.25, math.inf))


def strict_of_displaced(points: Points, triangles: list[Triangle], domain: PSLG) -> tuple[bool, Fraction] | None:
    """Displace every segment along its best chain, by brute force, and verify strictly; None where one has none."""
    exact, given = oracles.rationals(points), oracles.rationals(domain.points.tolist())
    used = sorted({v for t in triangles for v in t})
    at = [exact.index(p) if p in exact and exact.index(p) in used else -1 for p in given]
    ends = {v for pair in domain.segments.tolist() for v in pair}
    at = [within_oracle.nearest(exact, used, given[i]) if v < 0 and i in ends else v for i, v in enumerate(at)]
    squared, edges = Fraction(0), list[Pair]()
    for a, b in domain.segments.tolist():
        chain = within_oracle.best_chain(exact, triangles, at[a], at[b], given[a], given[b])
        if chain is None or at[a] == at[b]:
            return None
        edges += [(chain[i], chain[i + 1]) for i in range(len(chain) - 1)]
        inner = [within_oracle.distance_to_segment(exact[v], given[a], given[b]) for v in chain[1:-1]]
        squared = max([squared, *inner, *(oracles.squared_distance(exact[at[v]], given[v]) for v in (a, b))])
    report = verify(points, triangles, domain=PSLG(points, edges), claims=COVER[:2])
    return report.ok, squared


@pytest.mark.obligation(
    "V1", "within a distance the domain is covered iff the displaced domain is, strictly", method="differential"
)
class TestDisplaced:
    """Displace each segment along its best chain, found by enumeration, and verify strictly: the verdict is the same,
    and so is the distance. What is left out may only make the distance smaller."""

    @pytest.mark.parametrize("seed", once_after(10, range(40)))
    def test_the_same_verdict(self, seed: int) -> None:
        for points, triangles, domain, within in displacements(seed):
            report = verify(points, triangles, domain=domain, within=within, claims=COVER[:2])
            expected = strict_of_displaced(points, triangles, domain)
            allowed = expected is not None and (within == math.inf or expected[1] <= Fraction(within) ** 2)
            assert report.distance_squared is not None
            if expected is not None and allowed and expected[0]:
                assert report.ok, (points, triangles, domain, within)
                assert report.distance_squared <= expected[1]
            elif report.ok:  # something was left out
                assert within == math.inf or report.distance_squared <= Fraction(within) ** 2
            strict = verify(points, triangles, domain=domain, claims=COVER[:2])
            if strict.ok:
                assert report.ok
                assert report.distance == 0

    @pytest.mark.once
    def test_control_all_sorts_occur(self) -> None:
        """Displacements that are too far, and others that are not."""
        seen = set()
        for seed in range(40):
            for points, triangles, domain, within in displacements(seed):
                report = verify(points, triangles, domain=domain, within=within, claims=COVER[:2])
                expected = strict_of_displaced(points, triangles, domain)
                seen.add((report.ok, expected is not None and expected[0], bool(report.distance)))
        assert {(True, True, True), (False, False, False), (True, True, False)} <= seen


@pytest.mark.obligation("V1", "a distance is 0 or more, and needs a domain", method="named cases")
class TestArguments:
    """What is no distance is refused; without one nothing changes; the report says what was found."""

    TWO = (((0.0, 0.0), (1.0, 0.0), (1.0, 1.0)), [(0, 1, 2)])
    HALF = PSLG([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)], [(0, 1), (1, 2), (2, 0)])

    def test_farther_than_any_double(self) -> None:
        """A vertex 3e308 from its segment is within infinity, and within no double."""
        h = 1.7e308
        points = [(-h, h), (0.0, -h), (h, h), (0.0, -0.9 * h)]
        domain = PSLG([(-h, h), (0.0, -h), (h, h)], [(0, 1), (1, 2), (2, 0)])
        mesh = points, [(0, 1, 3), (1, 2, 3)]
        assert verify(*mesh, domain=domain, within=math.inf).verdict(Property.COVERS_DOMAIN) is Verdict.HOLDS
        largest = np.finfo(np.float64).max
        assert verify(*mesh, domain=domain, within=largest).verdict(Property.COVERS_DOMAIN) is Verdict.FAILS

    @pytest.mark.parametrize("bad", [-1, math.nan, "1", True, [1.0]])
    def test_bad(self, bad: float) -> None:
        with pytest.raises(BoundError, match="within"):
            verify(*self.TWO, domain=self.HALF, within=bad)

    def test_without_a_domain(self) -> None:
        with pytest.raises(ChoiceError, match="domain"):
            verify(*self.TWO, within=1)

    def test_report(self) -> None:
        strict, loose = verify(*self.TWO, domain=self.HALF), verify(*self.TWO, domain=self.HALF, within=0)
        assert strict.distance is None
        assert strict.distance_squared is None
        assert loose.distance == loose.distance_squared == 0
        assert "within" not in str(strict)
        assert "segments_present     holds within 0" in str(loose)
        found = json.loads(loose.to_json())["properties"]["covers_domain"]
        assert found["distance_squared"] == "0/1"
        assert "distance_squared" not in json.loads(strict.to_json())["properties"]["covers_domain"]

    @pytest.mark.parametrize("seed", range(20))
    def test_roots(self, seed: int) -> None:
        """The smallest double whose square is not below."""
        random = Random(seed)
        for _ in range(20):
            value = Fraction(random.randrange(1, 10**6), random.randrange(1, 10**6)) * Fraction(2) ** random.randrange(
                -1800, 1800
            )
            root = root_above(value)
            assert Fraction(root) ** 2 >= value > Fraction(math.nextafter(root, 0.0)) ** 2
        assert root_above(Fraction(0)) == 0.0
        assert root_above(Fraction(9, 4)) == 1.5
        assert root_above(Fraction(2) ** 2100) == math.inf

    def test_inadmissible(self) -> None:
        report = verify(self.TWO[0], [(0, 1, 2), (0, 1, 2)], domain=self.HALF, within=1)
        assert report.findings[Property.COVERS_DOMAIN].because == (Property.ADMISSIBLE,)

    def test_control_good(self) -> None:
        """None: distances at the ends of the range are taken."""
        assert verify(*self.TWO, domain=self.HALF, within=0).ok
        assert verify(*self.TWO, domain=self.HALF, within=1e308).ok


@pytest.mark.obligation("V2", "each condition of coverage within a distance is necessary", method="ablation")
class TestAblation:
    """What each check refuses passes when the check is taken out."""

    def _below(self) -> Report:
        domain = slanted(1)
        mesh = refine(domain, min_angle=25).triangulation
        distance = verify(mesh.points, mesh.triangles, domain=domain, within=math.inf).distance
        assert distance is not None
        return verify(mesh.points, mesh.triangles, domain=domain, within=math.nextafter(distance, 0.0), claims=COVER)

    def test_control_the_distance_of_chains(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """The distance of chains taken for small."""
        assert not self._below().ok
        monkeypatch.setattr(displaced, "_within", lambda *a: a[3])
        assert self._below().ok

    def test_control_the_distance_of_corners(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """The distance of corners taken for small."""
        points = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.25)]
        domain = PSLG([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 1.0)], [(0, 1), (1, 2), (2, 0)])

        def report() -> Report:
            return verify(points, [(0, 1, 2)], domain=domain, within=0.125, claims=COVER)

        assert not report().ok
        monkeypatch.setattr(placement, "is_within", lambda *_: True)
        assert report().verdict(Property.SEGMENTS_PRESENT) is Verdict.HOLDS
        assert report().verdict(Property.DOMAIN_POINTS) is Verdict.FAILS
        monkeypatch.setattr(trial, "is_within", lambda *_: True)
        assert report().ok

    def test_control_moved_corners(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Without them, what a format rounded is not found."""
        domain = slanted(0)
        mesh = refine(domain, min_angle=20).triangulation
        points = mesh.points.astype(np.float32).astype(np.float64)
        assert verify(points, mesh.triangles, domain=domain, within=1e-5, claims=COVER).ok
        monkeypatch.setattr(placement, "_moved", lambda *_: None)
        assert not verify(points, mesh.triangles, domain=domain, within=1e-5, claims=COVER).ok


@pytest.mark.obligation(
    "V3", "the distance that a report advises would do, and three digits less would not", method="property-based"
)
class TestAdvice:
    """Where a mesh misses its domain by rounding, the report says which distance would do; it does, and that is the
    smallest one but for three digits. Where there is none so near, nothing is said."""

    @pytest.mark.parametrize("digits", ["d", "f"])
    @pytest.mark.parametrize("within", [None, 0.0, 1e-18])
    def test_it_would_do(self, digits: str, within: float | None) -> None:
        domain = slanted(1)
        mesh = refine(domain, min_angle=20).triangulation
        points = mesh.points.astype(digits).astype(np.float64)
        report = verify(points, mesh.triangles, domain=domain, within=within, claims=COVER)
        notes = {report.findings[claim].note for claim in COVER} - {""}
        (advice,) = (re.fullmatch(r"within=(\S+) it would hold", note) for note in notes)
        assert advice is not None
        assert f"; {advice[0]}\n" in str(report)
        with pytest.raises(VerificationError, match=re.escape(f"({advice[0]})")):
            report.raise_if_failed()
        told = verify(points, mesh.triangles, domain=domain, within=float(advice[1]), claims=COVER)
        assert told.ok
        assert told.distance is not None
        assert 0.99 * float(advice[1]) < told.distance <= float(advice[1])
        assert f"holds within {advice[1]}\n" in str(told)

    @pytest.mark.parametrize("within", [None, 1e-9])
    def test_control_what_is_missing_is_not_excused(self, within: float | None) -> None:
        """A triangle taken away: no distance is advised."""
        domain = slanted(1)
        mesh = refine(domain, min_angle=20).triangulation
        for row in range(0, len(mesh.triangles), 7):
            triangles = np.delete(mesh.triangles, row, axis=0)
            report = verify(mesh.points, triangles, domain=domain, within=within, claims=COVER)
            assert not report.ok
            assert not any(finding.note for finding in report.findings.values())

    def test_not_beyond_the_largest_double(self) -> None:
        with pytest.raises(BoundError, match="that is a double"):
            verify([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)], domain=slanted(1), within=10**400)
