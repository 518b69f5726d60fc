"""V1 and V2 for Voronoi diagrams: against the bisectors of all pairs of sites, in fractions."""

import math
from collections.abc import Callable
from fractions import Fraction
from random import Random
from types import SimpleNamespace

import numpy as np
import numpy.typing as npt
import pytest
from proofs_tests import oracles
from proofs_tests.once import once_after
from proofs_tests.oracles import RationalPoint

import exactmesh.triangle as drop_in
from exactkernel import ShapeError
from exactkernel.types import FloatArray
from exactmesh import delaunay, voronoi
from exactmesh.verify import ChoiceError, Finding, Kind, Property, Report, Severity, Verdict, deciding, duality, verify
from exactmesh.verify.dual import Dual

U = Fraction(1, 2**53)
End = RationalPoint | None


def exact_ridges(sites: list[RationalPoint]) -> dict[tuple[int, int], set[End]]:
    """The ridges of positive length: on the bisector of each pair, what no third site is nearer to; None: infinity."""
    found: dict[tuple[int, int], set[End]] = {}
    for b in range(len(sites)):
        for a in range(b):
            (ax, ay), (bx, by) = sites[a], sites[b]
            mx, my, dx, dy = (ax + bx) / 2, (ay + by) / 2, by - ay, ax - bx
            low: Fraction | None = None
            high: Fraction | None = None
            empty = False
            for c in (site for i, site in enumerate(sites) if i not in (a, b)):
                # |m + t d - c|^2 >= |m + t d - a|^2 is linear in t
                slope = 2 * (dx * (ax - c[0]) + dy * (ay - c[1]))
                rest = oracles.squared_distance((mx, my), c) - oracles.squared_distance((mx, my), sites[a])
                if slope == 0:
                    empty |= rest < 0
                elif slope > 0:
                    low = -rest / slope if low is None else max(low, -rest / slope)
                else:
                    high = -rest / slope if high is None else min(high, -rest / slope)
            if not empty and (low is None or high is None or low < high):
                found[a, b] = {None if t is None else (mx + t * dx, my + t * dy) for t in (low, high)}
    return found


def is_next(claimed: float, z: Fraction) -> bool:
    """The exact number, or one of the two doubles beside it."""
    if math.isnan(claimed):
        return False
    low, high = math.nextafter(claimed, -math.inf), math.nextafter(claimed, math.inf)
    return (low == -math.inf or Fraction(low) < z) and (high == math.inf or z < Fraction(high))


def is_dual(sites: list[RationalPoint], claimed: SimpleNamespace) -> bool:
    """Compare ridge by ridge: each exact one is there once, and nothing besides; no vertex is left over."""
    wanted, used = exact_ridges(sites), set[int]()
    for (a, b), ends, direction in zip(
        claimed.ridge_points.tolist(), claimed.ends.tolist(), claimed.directions.tolist(), strict=True
    ):
        exact = wanted.pop((min(a, b), max(a, b)), None)
        if exact is None or (None in exact) is not (-1 in ends):
            return False
        used.update(ends)
        given = [claimed.vertices[v].tolist() for v in ends if v >= 0]
        finite = [z for z in exact if z is not None]
        orders = [finite, finite[::-1]]
        if len(given) != len(finite) or not any(
            all(is_next(x, z) for p, q in zip(given, order, strict=True) for x, z in zip(p, q, strict=True))
            for order in orders
        ):
            return False
        if None in exact and not leaves(sites, a, b, direction):
            return False
    return not wanted and used | {-1} == {*range(len(claimed.vertices)), -1}


def leaves(sites: list[RationalPoint], a: int, b: int, direction: list[float]) -> bool:
    """All sites are on the other side of ab, and the direction is perpendicular but for 3u of the products."""
    if not all(map(math.isfinite, direction)):
        return False
    x, y = map(Fraction, direction)
    (ax, ay), (bx, by) = sites[a], sites[b]
    ux, uy = bx - ax, by - ay
    turn = x * uy - y * ux
    left = max((oracles.orient(sites[a], sites[b], c) for c in sites), key=abs)
    outward = turn > 0 if left > 0 else turn < 0
    return outward and abs(x * ux + y * uy) <= (3 * U + 16 * U * U) * (abs(x * ux) + abs(y * uy))


def sites_of(seed: int) -> FloatArray:
    rng = np.random.default_rng(seed)
    n = int(rng.integers(4, 9))
    kind = seed % 4
    if kind == 0:
        return np.unique(rng.integers(0, 4, (n, 2)), axis=0).astype(np.float64)
    if kind == 1:
        return np.array([(3.0, 4.0), (-3.0, 4.0), (5.0, 0.0), (-4.0, -3.0), (0.0, -5.0), (4.0, 3.0)])[
            : n if n > 3 else 4
        ]
    return rng.random((n, 2)) * (2.0**-300 if kind == 3 and seed % 8 == 7 else 1.0)


def claims_of(points: FloatArray) -> SimpleNamespace:
    """Our own diagram, as arrays that can be written to."""
    diagram = voronoi(points)
    names = ("points", "vertices", "ridge_points", "ends", "directions")
    copy = {name: np.array(getattr(diagram, name)) for name in names}
    return SimpleNamespace(**copy, ridge_vertices=copy["ends"])


def moved(random: Random, c: SimpleNamespace) -> None:
    """A vertex by some units in the last place."""
    v, axis = random.randrange(len(c.vertices)), random.randrange(2)
    for _ in range(random.choice((1, 1, 2, 3, 40))):
        c.vertices[v, axis] = math.nextafter(c.vertices[v, axis], random.choice((-1, 1)) * math.inf)


def dropped(random: Random, c: SimpleNamespace) -> None:
    kept = np.arange(len(c.ends)) != random.randrange(len(c.ends))
    c.ridge_points, c.ends, c.directions = c.ridge_points[kept], c.ends[kept], c.directions[kept]


def doubled(random: Random, c: SimpleNamespace) -> None:
    rows = [*range(len(c.ends)), random.randrange(len(c.ends))]
    c.ridge_points, c.ends, c.directions = c.ridge_points[rows], c.ends[rows], c.directions[rows]


def rewired(random: Random, c: SimpleNamespace) -> None:
    r = random.randrange(len(c.ends))
    c.ends[r, random.randrange(2)] = random.randrange(-1, len(c.vertices))


def exchanged(random: Random, c: SimpleNamespace) -> None:
    c.ridge_points[random.randrange(len(c.ends)), random.randrange(2)] = random.randrange(len(c.points))


def tilted(random: Random, c: SimpleNamespace) -> None:
    r = random.choice(np.flatnonzero((c.ends < 0).any(axis=1)).tolist())
    factor = random.choice((-1.0, 1.0 + 2.0**-52, 1.0 + 2.0**-50, 1.25, math.nan))
    c.directions[r] *= factor if factor < 0 else [factor, 1.0]


def turned(random: Random, c: SimpleNamespace) -> None:
    """Another order of everything: no fault."""
    order = [*range(len(c.ends))]
    random.shuffle(order)
    c.ridge_points, c.ends, c.directions = c.ridge_points[order][:, ::-1], c.ends[order], c.directions[order]


CORRUPTIONS: tuple[Callable[[Random, SimpleNamespace], None], ...] = (
    moved,
    moved,
    dropped,
    doubled,
    rewired,
    exchanged,
    tilted,
    turned,
)


def dual_finding(points: npt.ArrayLike, dual: Dual) -> Finding:
    mesh = delaunay(points)
    return verify(mesh.points, mesh.triangles, dual=dual).findings[Property.VORONOI_DUAL]


@pytest.mark.obligation(
    "V1", "a diagram is accepted iff its ridges are those of brute force, to the next doubles", method="corruption"
)
class TestDual:
    """Right diagrams and corrupted ones: the verdict is that of a comparison with all bisectors, in fractions."""

    @pytest.mark.parametrize("seed", once_after(16, range(48)))
    def test_against_bisectors(self, seed: int) -> None:
        points, random = sites_of(seed), Random(seed)
        exact = oracles.rationals(points.tolist())
        if len(points) < 3 or all(oracles.orient(exact[0], exact[1], p) == 0 for p in exact):
            return
        assert is_dual(exact, claims_of(points))
        assert dual_finding(points, claims_of(points)).verdict is Verdict.HOLDS
        for corrupt in CORRUPTIONS:
            claimed = claims_of(points)
            corrupt(random, claimed)
            claimed.ridge_vertices = claimed.ends
            finding = dual_finding(points, claimed)
            assert finding.verdict is not Verdict.UNDECIDED
            assert (finding.verdict is Verdict.HOLDS) is is_dual(exact, claimed), (corrupt.__name__, points.tolist())
            assert (finding.verdict is Verdict.FAILS) is (finding.count > 0)

    @pytest.mark.once
    def test_control_both_verdicts_occur(self) -> None:
        """Vertices moved or tilted, ridges dropped, doubled, rewired, exchanged, turned."""
        seen = set()
        for seed in range(48):
            points, random = sites_of(seed), Random(seed)
            exact = oracles.rationals(points.tolist())
            if len(points) < 3 or all(oracles.orient(exact[0], exact[1], p) == 0 for p in exact):
                continue
            for corrupt in CORRUPTIONS:
                claimed = claims_of(points)
                corrupt(random, claimed)
                seen.add((corrupt.__name__, is_dual(exact, claimed)))
        assert {("moved", True), ("moved", False), ("tilted", True), ("tilted", False), ("turned", True)} <= seen
        assert {(name, False) for name in ("dropped", "doubled", "rewired", "exchanged")} <= seen

    @pytest.mark.parametrize("seed", range(4))
    def test_scipy(self, seed: int) -> None:
        """Its diagrams have the right ridges, and its vertices are off by rounding, if at all."""
        scipy_spatial = pytest.importorskip("scipy.spatial", reason="pip install scipy")
        points = np.random.default_rng(seed).random((40, 2)) if seed else np.mgrid[0:5, 0:4].reshape(2, -1).T * 1.0
        diagram = scipy_spatial.Voronoi(points)
        finding = dual_finding(points, diagram)
        assert {violation.kind for violation in finding.violations} <= {Kind.WRONG_CENTRE}
        assert finding.rounding == finding.count
        exact = oracles.rationals(points.tolist())
        mesh = delaunay(points)
        for violation in finding.violations:
            (t,) = violation.triangles
            centre, _ = oracles.circumcircle(*(exact[v] for v in mesh.triangles[t]))
            claimed = min(oracles.squared_distance(centre, v) for v in oracles.rationals(diagram.vertices.tolist()))
            assert violation.magnitude == claimed > 0

    @pytest.mark.parametrize("seed", range(6))
    def test_triangle(self, seed: int) -> None:
        """A vertex a triangle: our drop-in's diagram, as returned and as in files; and with faults."""
        points = sites_of(seed * 4 + (0 if seed < 3 else 2))
        mesh = delaunay(points)
        vertices, edges, origins, directions = drop_in.voronoi(mesh.points)
        whole = (vertices, edges, origins, directions)
        rows = np.concatenate([edges, np.stack([origins, np.full_like(origins, -1)], axis=1)])
        of_file = (vertices, rows, np.concatenate([np.zeros(edges.shape), directions]))
        bad = vertices.copy()
        bad[0, 0] += 1.0
        faulty = [
            (bad, edges, origins, directions),
            (vertices, edges, origins, -directions),
            (vertices, edges, origins[1:], directions[1:]),
            (vertices, np.concatenate([edges, edges]), origins, directions),
        ]
        for dual in (whole, of_file, (vertices, edges[:, ::-1], origins, directions)):
            assert verify(mesh.points, mesh.triangles, dual=dual).ok
        for dual in faulty[: 4 if any((vertices[a] != vertices[b]).any() for a, b in edges) else 3]:
            assert not verify(mesh.points, mesh.triangles, dual=dual).ok

    def test_duplicates_and_other_orders(self) -> None:
        """Sites are matched by position."""
        points = np.random.default_rng(7).random((12, 2))
        twice = np.concatenate([points, points[:3]])
        mesh = delaunay(points)
        assert verify(mesh.points, mesh.triangles, dual=voronoi(twice)).ok
        assert verify(mesh.points, mesh.triangles, dual=voronoi(points[::-1])).ok
        assert not verify(mesh.points, mesh.triangles, dual=voronoi(points[:-1])).ok
        assert not verify(mesh.points, mesh.triangles, dual=voronoi([*points.tolist(), (0.5, 0.5)])).ok

    def test_beyond_the_doubles(self) -> None:
        """A circumcentre too far away is infinite, and nothing else."""
        points = np.array([(0.0, 0.0), (1e300, 1e-10), (2e300, 0.0), (1e300, 1e300)])
        mesh, claimed = delaunay(points), claims_of(points)
        assert not np.isfinite(claimed.vertices).all()
        assert verify(mesh.points, mesh.triangles, dual=claimed).ok
        claimed.vertices[~np.isfinite(claimed.vertices)] = 1.0
        assert not verify(mesh.points, mesh.triangles, dual=claimed).ok


@pytest.mark.obligation(
    "V1", "a diagram is claimed where it is given; without Delaunay nothing is said of it", method="named cases"
)
class TestClaims:
    """What is no diagram is refused."""

    KITE = ([(0.0, 0.0), (3.0, -1.0), (6.0, 0.0), (3.0, 1.0)], [(0, 1, 2), (0, 2, 3)])

    def test_undecided(self) -> None:
        report = verify(*self.KITE, dual=voronoi(self.KITE[0]))
        finding = report.findings[Property.VORONOI_DUAL]
        assert (finding.verdict, finding.because) == (Verdict.UNDECIDED, (Property.DELAUNAY,))
        line = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]
        assert verify(line, [], dual=voronoi(line)).verdict(Property.VORONOI_DUAL) is Verdict.UNDECIDED

    def test_claimed(self) -> None:
        points = self.KITE[0]
        assert verify(points, [(0, 1, 3), (1, 2, 3)], dual=voronoi(points)).claims[-1] is Property.VORONOI_DUAL
        with pytest.raises(ChoiceError, match="dual="):
            verify(*self.KITE, claims=["voronoi-dual"])

    @pytest.mark.parametrize(
        "bad",
        [
            3,
            (),
            ([(0.0, 0.0)], [], [], []),
            ([(0.0, 0.0)] * 2, [(0, 5)], [], []),
            ([(0.0, 0.0)] * 2, [(0, 1)], [(0.0, 1.0)] * 2),
            ([(0.0, 0.0, 0.0)] * 2, [(0, 1)], [], []),
            SimpleNamespace(points=[(0.0, 0.0)], vertices=[], ridge_points=[(0, 1)], ridge_vertices=[(0, 1)]),
            SimpleNamespace(points=[(0.0, 0.0)] * 2, vertices=[], ridge_points=[(0, 1)], ridge_vertices=[(-1, -1)] * 2),
        ],
    )
    def test_bad(self, bad: Dual) -> None:
        with pytest.raises(ShapeError, match="dual"):
            verify(self.KITE[0], [(0, 1, 3), (1, 2, 3)], dual=bad)

    def test_witnesses(self) -> None:
        points = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 5.0)]
        claimed = claims_of(np.array(points))
        claimed.vertices[0, 0] += 0.5
        finding = dual_finding(points, claimed)
        (violation,) = finding.violations
        assert (violation.kind, violation.magnitude) == (Kind.WRONG_CENTRE, Fraction(1, 4))
        assert finding.severity is Severity.WRONG

    def test_control_good(self) -> None:
        """None: a diagram in the same form is taken."""
        points = self.KITE[0]
        assert verify(points, [(0, 1, 3), (1, 2, 3)], dual=voronoi(points)).ok


@pytest.mark.obligation("V2", "each condition about diagrams is necessary", method="ablation")
class TestAblation:
    """A diagram that each check refuses passes when that check is taken out."""

    def _report(self, corrupt: Callable[[SimpleNamespace], None]) -> Report:
        points = np.random.default_rng(11).random((9, 2))
        mesh, claimed = delaunay(points), claims_of(points)
        corrupt(claimed)
        claimed.ridge_vertices = claimed.ends
        return verify(mesh.points, mesh.triangles, dual=claimed)

    @pytest.mark.parametrize(
        ("name", "replacement", "corrupt"),
        [
            ("_vertices", lambda *_: Finding(Verdict.HOLDS), lambda c: c.vertices.__setitem__((0, 0), 9.0)),
            ("_directions", lambda *_: Finding(Verdict.HOLDS), lambda c: c.directions.__imul__(-1.0)),
        ],
    )
    def test_control_missing_check(
        self,
        name: str,
        replacement: Callable[..., Finding],
        corrupt: Callable[[SimpleNamespace], None],
        monkeypatch: pytest.MonkeyPatch,
    ) -> None:
        """The checks of vertices and of directions taken out."""
        assert not self._report(corrupt).ok
        monkeypatch.setattr(duality.Check, name, replacement)
        assert self._report(corrupt).ok

    def test_control_expected_ridges(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Where nothing is expected, nothing is missing."""
        points = np.random.default_rng(11).random((9, 2))
        mesh = delaunay(points)
        none = SimpleNamespace(
            points=points, vertices=np.empty((0, 2)), ridge_points=np.empty((0, 2), int), ridge_vertices=[]
        )
        assert not verify(mesh.points, mesh.triangles, dual=none).ok
        monkeypatch.setattr(duality, "expect_ridges", lambda *a: a[3].fill(False))
        assert verify(mesh.points, mesh.triangles, dual=none).ok

    def test_control_the_dual_needs_delaunay(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Of triangles that are not Delaunay the ridges dual to the edges are no Voronoi diagram."""
        points, triangles = TestClaims.KITE
        centres = [oracles.circumcircle(*(oracles.rationals(points)[v] for v in t))[0] for t in triangles]
        dual = (
            [(float(x), float(y)) for x, y in centres],
            [(0, 1)],
            [0, 0, 1, 1],
            [(-1.0, -3.0), (1.0, -3.0), (1.0, 3.0), (-1.0, 3.0)],
        )
        assert verify(points, triangles, dual=dual).verdict(Property.VORONOI_DUAL) is Verdict.UNDECIDED
        monkeypatch.setattr(deciding, "check_delaunay", lambda *_: Finding(Verdict.HOLDS))
        assert verify(points, triangles, dual=dual).verdict(Property.VORONOI_DUAL) is Verdict.HOLDS
