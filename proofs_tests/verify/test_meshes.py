"""V1 and V2 on meshes of other meshers, sound and corrupted, and on parts of them: nonconvex, pinched, with
holes."""

from collections.abc import Callable
from fractions import Fraction
from random import Random

import numpy as np
import numpy.typing as npt
import pytest
from proofs_tests import oracles
from proofs_tests.verify.test_verdicts import CONFIGURATIONS, STAR, BruteForce, all_sets, disagreements
from scipy.spatial import Delaunay

from exactkernel import Sign
from exactmesh import delaunay
from exactmesh.verify import Finding, Property, Severity, Verdict, deciding, verify

Points = npt.NDArray[np.float64]
Triangles = npt.NDArray[np.int32]
Mesh = tuple[Points, Triangles]

CLAIMED = tuple(property_ for property_ in Property if property_ not in (Property.WEAKLY_ACUTE, Property.ACUTE))


def sound(seed: int, n: int = 60) -> Mesh:
    """A mesh of even integer points, so that midpoints are exact."""
    mesh = Delaunay(np.round(np.random.default_rng(seed).random((n, 2)) * 2**20) * 2)
    return np.array(mesh.points), np.array(mesh.simplices, dtype=np.int32)


def inner_edge(triangles: Triangles, random: Random) -> tuple[int, int]:
    """Return the rows of two triangles with a common edge."""
    s = random.randrange(len(triangles))
    common = [len(set(row) & set(triangles[s])) for row in triangles.tolist()]
    return s, random.choice([t for t, shared in enumerate(common) if shared == 2])


def flipped(mesh: Mesh, random: Random) -> Mesh:
    """Flip an edge of a convex quadrilateral."""
    points, triangles = mesh
    exact = oracles.rationals(points.tolist())
    while True:
        s, t = inner_edge(triangles, random)
        p = next(v for v in triangles[s] if v not in triangles[t])
        q = next(v for v in triangles[t] if v not in triangles[s])
        i = triangles[s].tolist().index(p)
        a, b = triangles[s][(i + 1) % 3], triangles[s][(i + 2) % 3]
        if oracles.orient(exact[p], exact[a], exact[q]) > 0 and oracles.orient(exact[q], exact[b], exact[p]) > 0:
            result = triangles.copy()
            result[s], result[t] = (p, a, q), (q, b, p)
            return points, result


def duplicated(mesh: Mesh, random: Random) -> Mesh:
    points, triangles = mesh
    return points, np.vstack([triangles, triangles[random.randrange(len(triangles))]])


def dropped(mesh: Mesh, random: Random) -> Mesh:
    points, triangles = mesh
    return points, np.delete(triangles, random.randrange(len(triangles)), axis=0)


def shifted(mesh: Mesh, random: Random) -> Mesh:
    """Move an inner vertex across an edge of its star."""
    points, triangles = mesh
    hull = set(np.unique(Delaunay(points).convex_hull).tolist())
    v = random.choice([v for v in range(len(points)) if v not in hull])
    star = triangles[(triangles == v).any(axis=1)]
    a, b = (w for w in star[0].tolist() if w != v)
    moved = points.copy()
    moved[v] = points[a] + points[b] - points[v]
    return moved, triangles


def rewired(mesh: Mesh, random: Random) -> Mesh:
    """Give a triangle another corner."""
    points, triangles = mesh
    result = triangles.copy()
    t = random.randrange(len(triangles))
    result[t, 0] = random.choice([v for v in range(len(points)) if v not in triangles[t]])
    return points, result


def inverted(mesh: Mesh, random: Random) -> Mesh:
    points, triangles = mesh
    result = triangles.copy()
    t = random.randrange(len(triangles))
    result[t] = result[t][::-1]
    return points, result


def hanging(mesh: Mesh, random: Random) -> Mesh:
    """Split an edge at its middle in one of its two triangles only."""
    points, triangles = mesh
    s, t = inner_edge(triangles, random)
    i = next(i for i in range(3) if triangles[s][i] not in triangles[t])
    p, a, b = (triangles[s][(i + k) % 3] for k in range(3))
    m = len(points)
    return (
        np.vstack([points, (points[a] + points[b]) / 2]),
        np.vstack([np.delete(triangles, s, axis=0), [[p, a, m], [p, m, b]]]).astype(np.int32),
    )


def split(mesh: Mesh, random: Random) -> Mesh:
    """Put a new point into a triangle, on nobody's edge, without using it."""
    points, triangles = mesh
    return np.vstack([points, points[triangles[random.randrange(len(triangles))]].mean(axis=0)]), triangles


def doubled(mesh: Mesh, random: Random) -> Mesh:
    """Give one triangle a copy of its corner under a new index."""
    points, triangles = mesh
    result = triangles.copy()
    t = random.randrange(len(triangles))
    result[t, 0] = len(points)
    return np.vstack([points, points[triangles[t, 0]]]), result


CORRUPTIONS: list[tuple[Callable[[Mesh, Random], Mesh], Property]] = [
    (flipped, Property.DELAUNAY),
    (duplicated, Property.EDGE_MANIFOLD),
    (dropped, Property.COVERS_HULL),
    (shifted, Property.ORIENTATION),
    (rewired, Property.ADMISSIBLE),
    (inverted, Property.ORIENTATION),
    (hanging, Property.ADMISSIBLE),
    (split, Property.ALL_POINTS_USED),
    (doubled, Property.DISTINCT_POINTS),
]


@pytest.mark.obligation(
    "V2", "of a sound mesh by another mesher, each corruption breaks the property that it should", method="corruption"
)
class TestCorruptedMeshes:
    """A sound mesh of another mesher has every claimed property; each corruption breaks the one that it is
    meant to break, and the verdicts on the corrupted mesh are those of brute force."""

    @pytest.mark.parametrize("seed", range(3))
    def test_sound(self, seed: int) -> None:
        points, triangles = sound(seed)
        report = verify(points, triangles)
        assert report.ok, report
        assert [
            property_ for property_, finding in report.findings.items() if finding.verdict is not Verdict.HOLDS
        ] == [
            Property.WEAKLY_ACUTE,
            Property.ACUTE,
        ]

    @pytest.mark.parametrize("seed", range(3))
    @pytest.mark.parametrize(("corrupt", "broken"), CORRUPTIONS, ids=[c.__name__ for c, _ in CORRUPTIONS])
    def test_control_corrupted(self, corrupt: Callable[[Mesh, Random], Mesh], broken: Property, seed: int) -> None:
        """Points moved, triangles lost, doubled, turned round, and more, one at a time."""
        points, triangles = corrupt(sound(seed, 16), Random(seed))
        report = verify(points, triangles)
        assert not report.ok
        assert report.verdict(broken) is Verdict.FAILS
        rows = [(a, b, c) for a, b, c in triangles.tolist()]
        assert not disagreements(BruteForce([(x, y) for x, y in points.tolist()]), points.tolist(), rows)


@pytest.mark.obligation(
    "V1",
    "any part of an admissible mesh is admissible; with one more triangle it is what brute force says",
    method="differential",
    control_in="TestAblation",
)
class TestParts:
    """Any part of an admissible set is admissible, however ragged its boundary; with one more triangle it is
    what brute force says. This is where the plane sweep decides."""

    @staticmethod
    def part(seed: int, keep: float) -> Mesh:
        random = np.random.default_rng(seed)
        side = 7
        x, y = np.meshgrid(np.arange(side), np.arange(side))  # many collinear and vertical edges
        points = np.stack([x.ravel(), y.ravel()], axis=1).astype(np.float64)
        low = (x + side * y)[:-1, :-1].ravel()
        triangles = np.vstack(
            [np.stack([low, low + 1, low + side + 1], 1), np.stack([low, low + side + 1, low + side], 1)]
        )
        return points, triangles[random.random(len(triangles)) < keep].astype(np.int32)

    @pytest.mark.parametrize("seed", range(12))
    def test_parts_of_a_grid(self, seed: int) -> None:
        points, triangles = self.part(seed, (seed + 1) / 13)
        report = verify(points, triangles)
        assert report.verdict(Property.ADMISSIBLE) is Verdict.HOLDS
        assert report.verdict(Property.COVERS_HULL) is Verdict.FAILS

    @pytest.mark.parametrize("seed", range(25))
    def test_one_more(self, seed: int) -> None:
        points, triangles = self.part(seed, 0.3)
        random, exact = Random(seed), oracles.rationals(points.tolist())
        for _ in range(8):
            a, b, c = random.sample(range(len(points)), 3)
            t = oracles.counterclockwise(exact, (a, b, c))
            rows = [(a, b, c) for a, b, c in triangles.tolist()]
            truth = oracles.has_area(exact, t) and all(oracles.meet_admissibly(exact, s, t) for s in rows)
            report = verify(points, np.vstack([triangles, t]))
            assert (report.verdict(Property.ADMISSIBLE) is Verdict.HOLDS) is truth, (rows, t)

    @pytest.mark.parametrize("seed", range(6))
    def test_parts_of_a_mesh(self, seed: int) -> None:
        """The same in general position, with a large patch laid over a part without any crossing of
        boundaries."""
        points, triangles = sound(seed, 300)
        chosen = triangles[np.random.default_rng(seed).random(len(triangles)) < 0.6]
        assert verify(points, chosen).verdict(Property.ADMISSIBLE) is Verdict.HOLDS
        corners = np.array([(-9.0, -9.0), (9.0, -9.0), (0.0, 19.0)]) * 2**20
        covered = verify(np.vstack([points, corners]), np.vstack([chosen, [300, 301, 302]]))
        assert covered.verdict(Property.ADMISSIBLE) is Verdict.FAILS
        assert covered.findings[Property.ADMISSIBLE].violations[0].kind == "overlap"
        apart = verify(np.vstack([points, corners + 2**26]), np.vstack([chosen, [300, 301, 302]]))
        assert apart.verdict(Property.ADMISSIBLE) is Verdict.HOLDS


HOLDING = Finding(Verdict.HOLDS)


def holds(*_: object) -> Finding:
    return HOLDING


@pytest.mark.obligation(
    "V2", "without any one check of triangles and edges the verifier contradicts brute force", method="ablation"
)
class TestAblation:
    """Without any one of its checks the verifier contradicts brute force somewhere: none is superfluous, and
    the comparison with brute force would notice its loss."""

    @pytest.mark.once
    @pytest.mark.parametrize("check", ["check_zero_area", "check_overlap", "check_sweep", "check_hull", "check_fans"])
    def test_control_missing_check(self, check: str, monkeypatch: pytest.MonkeyPatch) -> None:
        """The checks of triangles and edges taken out, one by one."""
        brutes = [(BruteForce(points), points) for points in list(CONFIGURATIONS.values())[:6]]
        cases = [(brute, points, rows) for brute, points in brutes for rows in list(all_sets(brute))[::5]]
        monkeypatch.setattr(deciding, check, holds)  # with it nothing disagrees: TestEverySet
        assert any(disagreements(*case) for case in cases)

    def test_control_without_simplicity_the_double_cover_passes(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """The check that the boundary is simple taken out."""
        triangles = [(0, 1 + i, 1 + (i + 1) % 5) for i in range(5)]
        claims = [Property.ORIENTATION, Property.EDGE_MANIFOLD, Property.VERTEX_MANIFOLD, Property.ADMISSIBLE]
        assert not verify(STAR, triangles, claims=claims).ok
        monkeypatch.setattr(deciding, "check_sweep", holds)
        assert verify(STAR, triangles, claims=claims).ok

    def test_enclosed_points(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """An unused point in a triangle breaks Delaunay, an unused copy of a corner does not."""
        corners = [(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)]
        assert verify([*corners, (1.0, 1.0)], [(0, 1, 2)]).verdict(Property.DELAUNAY) is Verdict.FAILS
        assert verify([*corners, (4.0, 0.0)], [(0, 1, 2)]).verdict(Property.DELAUNAY) is Verdict.HOLDS
        monkeypatch.setattr(deciding, "enclosed_points", lambda *_: np.empty(0, dtype=np.intp))
        assert verify([*corners, (1.0, 1.0)], [(0, 1, 2)]).verdict(Property.DELAUNAY) is Verdict.HOLDS


def turned_grid(degrees: float) -> Points:
    x, y = np.meshgrid(np.arange(10.0), np.arange(10.0))
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.stack([c * x - s * y, s * x + c * y], axis=-1).reshape(-1, 2)


def on_a_circle(n: int) -> Points:
    angles = 2 * np.pi * np.arange(n) / n
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


#: What scipy 1.x returns for these is not a Delaunay triangulation of all the points.
CORPUS: dict[str, Points] = {
    "inverted and overlapping": np.random.default_rng(17).random((15, 2)) + 1e6,
    "points dropped": np.random.default_rng(0).random((300, 2)) + 1e6,
    "one edge": np.random.default_rng(15).random((5, 2)) + 1e5,
    "grid turned": turned_grid(302.328),
    "circle": on_a_circle(200),
}


@pytest.mark.obligation(
    "V1",
    "wrong meshes of scipy and GEOS are refused, with exact witnesses; wrong is kept apart from rounding",
    method="named cases",
)
class TestKnownFailures:
    """Wrong answers of other meshers, which they do not report, are refused with a witness that is exactly
    right."""

    @pytest.mark.parametrize("points", CORPUS.values(), ids=CORPUS.keys())
    def test_scipy(self, points: Points) -> None:
        mesh = Delaunay(points)
        report = verify(mesh.points, mesh.simplices)
        exact = oracles.rationals(points.tolist())
        rows = [(a, b, c) for a, b, c in mesh.simplices.tolist()]
        wrong = any(oracles.orient(*(exact[v] for v in t)) <= 0 for t in rows) or not oracles.is_delaunay(exact, rows)
        assert not report.ok
        assert wrong or {v for t in rows for v in t} != set(range(len(points)))
        for violation in report.violations:
            if violation.kind == "point_in_circle" and violation.triangles:
                a, b, c, d = (exact[v] for v in violation.vertices)
                centre, radius = oracles.circumcircle(a, b, c)
                assert oracles.squared_distance(centre, d) < radius
                assert violation.sign is Sign.POSITIVE
                assert violation.magnitude == (radius - oracles.squared_distance(centre, d)) * oracles.orient(a, b, c)

    def test_geos_1286(self) -> None:
        """GEOS takes the wrong diagonal, by far; the right one is accepted."""
        points = [
            (-1.3890020986020145e-10, 4.860466764224401),
            (-1.3889120965221466e-10, -5.531838081766228),
            (-1.388852095135568e-10, -12.460041312426647),
            (0.9999999999166641, -3.799787274101123),
        ]
        right, of_geos = [(0, 1, 3), (1, 2, 3)], [(0, 1, 2), (0, 2, 3)]
        assert oracles.is_delaunay(oracles.rationals(points), right)
        assert verify(points, right, orientation="any").ok
        report = verify(points, of_geos)
        assert report.verdict(Property.ADMISSIBLE) is Verdict.HOLDS
        assert [violation.severity for violation in report.findings[Property.DELAUNAY].violations] == [Severity.WRONG]

    def test_wrong_is_kept_apart_from_rounding(self) -> None:
        """A flipped edge of a coarse quadrilateral is wrong; on points rounded onto a circle some edges are
        rounding-sized: their determinant is within 2^-49 of the sum of the absolute values of its terms."""
        wrong = verify([(0, 0), (3, -1), (6, 0), (3, 1)], [(0, 1, 2), (0, 2, 3)]).violations[0]
        assert wrong.severity is Severity.WRONG
        assert wrong.magnitude == Fraction(96)
        points = on_a_circle(200)
        exact = oracles.rationals(points.tolist())
        small = 0
        for violation in verify(points, [(0, i, i + 1) for i in range(1, 199)]).violations:
            if violation.kind != "point_in_circle" or violation.magnitude is None:
                continue
            a, b, c, (x, y) = (exact[v] for v in violation.vertices)
            terms = sum(
                oracles.squared_distance(p, (x, y)) * (abs((q[0] - x) * (r[1] - y)) + abs((q[1] - y) * (r[0] - x)))
                for p, q, r in ((a, b, c), (b, c, a), (c, a, b))
            )
            assert (violation.severity is Severity.ROUNDING) is (violation.magnitude <= 10 * terms / 2**53)
            small += violation.severity is Severity.ROUNDING
            assert ("rounding-sized" in violation.message) is (violation.severity is Severity.ROUNDING)
        assert small > 0

    @pytest.mark.parametrize("points", CORPUS.values(), ids=CORPUS.keys())
    def test_control_right(self, points: Points) -> None:
        """None: what exactmesh says of the same points is accepted."""
        mesh = delaunay(points)
        assert verify(mesh.points, mesh.triangles).ok
