"""V1 and V2 with quadrilaterals: verdicts are those of brute force on polygons, and each condition is necessary."""

import hashlib
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from itertools import combinations, permutations, product
from random import Random

import numpy as np
import numpy.typing as npt
import pytest
from proofs_tests import oracles
from proofs_tests.kernel.test_compiled import in_a_child
from proofs_tests.once import once_after
from proofs_tests.recording import Record
from proofs_tests.verify import cells_oracle, domain_oracle
from proofs_tests.verify.cells_oracle import Cell

from exactkernel import ShapeError, Sign
from exactkernel.types import FloatArray, SignArray
from exactmesh import PSLG
from exactmesh.errors import ChoiceError
from exactmesh.verify import (
    ADMISSIBLE_MESH,
    Kind,
    Orientation,
    Property,
    Report,
    Verdict,
    cells,
    verify,
)
from exactmesh.verify.cells import Cells
from exactmesh.verify.triangles import Shapes

Points = Sequence[tuple[float, float]]

CONFIGURATIONS: dict[str, Points] = {
    "convex": [(0, 0), (4, -1), (6, 3), (3, 6), (-1, 4)],
    "one inside": [(0, 0), (7, 1), (6, 7), (-1, 6), (3, 4)],
    "two inside": [(0, 0), (9, 0), (4, 9), (4, 2), (5, 4)],
    "a point inside an edge": [(0, 0), (4, 0), (4, 4), (0, 4), (2, 0)],
    "the centre of a square": [(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)],
    "grid without a corner": [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1)],
    "two at one position": [(0, 0), (3, 0), (0, 3), (3, 3), (3, 0)],
    "collinear": [(0, 0), (1, 1), (2, 2), (3, 3), (4, 4)],
    "beyond the window": [(0, 0), (1e200, 0), (1e200, 1e-200), (0, 1e-200), (5e199, 5e-201)],
}


def every_cell(n: int) -> list[Cell]:
    """Every triangle and every cyclic order of four points, one direction of each."""
    quads = [
        (a, *rest) for a, *others in combinations(range(n), 4) for rest in permutations(others) if rest[0] < rest[2]
    ]
    return [*combinations(range(n), 3), *quads]


def checked(points: Points, chosen: Sequence[Cell], **options: object) -> Report:
    triangles, quads = ([cell for cell in chosen if len(cell) == width] for width in (3, 4))
    report: Report = verify(points, triangles, quads=quads, **options)  # type: ignore[call-overload]  # loose options
    return report


def truth(points: Points, chosen: Sequence[Cell], orientation: Orientation) -> dict[Property, bool]:
    exact = oracles.rationals(points)
    turned = [cells_oracle.counterclockwise(exact, cell) for cell in chosen]
    listed = turned if orientation is Orientation.ANY else chosen
    admissible = cells_oracle.is_admissible(exact, chosen)
    upright = [cells_oracle.is_simple(exact, cell) and cells_oracle.area(exact, cell) > 0 for cell in listed]
    return {
        Property.FINITE: True,
        Property.INDICES: True,
        Property.DISTINCT_POINTS: len(set(exact)) == len(exact),
        Property.ORIENTATION: all(upright),
        Property.CONVEX: all(cells_oracle.is_convex(exact, cell) for cell in chosen if len(cell) == 4),
        Property.ALL_POINTS_USED: {v for cell in chosen for v in cell} == set(range(len(points))),
        Property.EDGE_MANIFOLD: cells_oracle.is_edge_manifold(listed),
        Property.VERTEX_MANIFOLD: cells_oracle.is_vertex_manifold(listed),
        Property.ADMISSIBLE: admissible,
        Property.COVERS_HULL: admissible and cells_oracle.covers_hull(exact, chosen),
    }


def disagreements(points: Points, chosen: Sequence[Cell], orientation: Orientation) -> list[str]:
    """Return where the verifier contradicts brute force; COVERS_HULL alone may be undecided, without ADMISSIBLE."""
    report = checked(points, chosen, orientation=orientation)
    expected, faults = truth(points, chosen, orientation), []
    if any(len(cell) == 4 for cell in chosen) and set(report.findings) != set(expected):
        faults.append(f"reported are {set(report.findings) ^ set(expected)}")
    for property_, holds in expected.items():
        if property_ not in report.findings:  # no quadrilateral: CONVEX is not asked
            continue
        finding = report.findings[property_]
        if finding.verdict is Verdict.UNDECIDED:
            if property_ is not Property.COVERS_HULL or finding.because != (Property.ADMISSIBLE,):
                faults.append(f"{property_} undecided because of {finding.because}")
        elif (finding.verdict is Verdict.HOLDS) is not holds:
            faults.append(f"{property_} {finding.verdict}")
        if bool(finding.violations) is not (finding.verdict is Verdict.FAILS):
            faults.append(f"{property_} {finding.verdict} with {len(finding.violations)} witnesses")
    return faults


def some_sets(points: Points, triples: int) -> Iterator[tuple[Cell, ...]]:
    """Every set of at most two cells, and some of three, each cell in either direction."""
    everyone, random = every_cell(len(points)), Random(str(points))
    for chosen in [(cell,) for cell in everyone] + list(combinations(everyone, 2)):
        yield tuple(cell if random.random() < 0.5 else cell[::-1] for cell in chosen)
    exact = oracles.rationals(points)
    sound = [cells_oracle.counterclockwise(exact, cell) for cell in everyone if cells_oracle.is_convex(exact, cell)]
    for _ in range(triples if len(sound) > 2 else 0):
        yield tuple(random.sample(sound, 3))


@pytest.mark.obligation(
    "V1",
    "every small set of triangles and quadrilaterals over five points is judged as by brute force",
    method="enumeration",
)
class TestEverySmallSet:
    """For every set of two triangles and quadrilaterals over five points, and some of three, each verdict is that of
    brute force on polygons."""

    @pytest.mark.parametrize("points", once_after(1, CONFIGURATIONS.values(), CONFIGURATIONS.keys()))
    def test_verdicts(self, points: Points, record_property: Record) -> None:
        some = list(some_sets(points, 60))
        for i, chosen in enumerate(some):
            orientation = Orientation.ANY if i % 2 else Orientation.CCW
            assert not disagreements(points, chosen, orientation), (chosen, orientation)
        record_property("cases", len(some))

    @pytest.mark.once
    @pytest.mark.parametrize("name", ["two inside", "a point inside an edge", "the centre of a square"])
    def test_cutting_convex_ones_changes_nothing(self, name: str) -> None:
        """Law: convex cells are admissible if and only if the triangles into which diagonals cut them are."""
        points = CONFIGURATIONS[name]
        exact, random = oracles.rationals(points), Random(2)
        for chosen in some_sets(points, 60):
            if all(cells_oracle.is_convex(exact, cell) for cell in chosen):
                cut: list[Cell] = []
                for cell in chosen:
                    a, b, c, *rest = cell if random.random() < 0.5 else (*cell[1:], cell[0])
                    cut += [(a, b, c), *((a, c, d) for d in rest)]
                whole, halves = (checked(points, part, orientation="any") for part in (chosen, cut))
                assert whole.verdict(Property.ADMISSIBLE) is halves.verdict(Property.ADMISSIBLE), chosen

    def test_brute_force_accepts_and_rejects_each_property(self) -> None:
        seen: dict[Property, set[bool]] = {}
        for points in (CONFIGURATIONS["a point inside an edge"], CONFIGURATIONS["two at one position"]):
            for chosen in some_sets(points, 10):
                for property_, holds in truth(points, chosen, Orientation.CCW).items():
                    seen.setdefault(property_, set()).add(holds)
        assert all(found == {True, False} for property_, found in seen.items() if property_ not in ALWAYS), seen

    def test_control_three_left_turns_are_not_convex(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Quadrilaterals with one right turn taken for convex."""

        def lenient(turns: SignArray) -> npt.NDArray[np.bool_]:
            found: npt.NDArray[np.bool_] = cells.orientation_of_quads(turns) != 0
            return found

        monkeypatch.setattr(cells, "is_convex", lenient)
        points = CONFIGURATIONS["one inside"]
        assert any(disagreements(points, (cell,), Orientation.ANY) for cell in every_cell(5))


ALWAYS = (Property.FINITE, Property.INDICES)

GRID = [(x, y) for y in range(3) for x in range(3)]
SQUARES = [(a, a + 1, a + 4, a + 3) for a in (0, 1, 3, 4)]
RIM = [(0, 1), (1, 2), (2, 5), (5, 8), (8, 7), (7, 6), (6, 3), (3, 0)]


def tilings() -> Iterator[tuple[Cell, ...]]:
    """Every way to leave each square of the grid out, whole, or cut along one of its diagonals."""
    choices = [((), ((a, b, c, d),), ((a, b, c), (a, c, d)), ((a, b, d), (b, c, d))) for a, b, c, d in SQUARES]
    for parts in product(*choices):
        yield tuple(cell for part in parts for cell in part)


@pytest.mark.obligation(
    "V1",
    "in tilings of a grid by squares and halves, segments, domains and labels are judged rightly",
    method="enumeration",
)
class TestTilingsOfAGrid:
    """Squares, whole or cut: they are admissible; a segment is there if it is a chain of sides of cells, a diagonal of
    a quadrilateral is none; the domain is covered if every square is; labels change across segments only."""

    def test_segments(self) -> None:
        exact = oracles.rationals(GRID)
        wanted = [(0, 2), (0, 8), (0, 4), (1, 3), (4, 2), (1, 7), (6, 2), (3, 4), (5, 7)]
        for chosen in tilings():
            edges = {edge for cell in chosen for edge in cells_oracle.edges_of(cell)}
            report = checked(GRID, chosen, segments=wanted)
            absent = [i for i, (a, b) in enumerate(wanted) if not domain_oracle.is_chain(exact, edges, a, b)]
            found = report.findings[Property.SEGMENTS_PRESENT]
            assert report.verdict(Property.ADMISSIBLE) is Verdict.HOLDS
            assert found.count == len(absent), chosen
            assert [v.vertices for v in found.violations] == [wanted[i] for i in absent]

    def test_domains(self) -> None:
        for chosen in tilings():
            squares = [any(set(cell) <= set(square) for cell in chosen) for square in SQUARES]
            report = checked(GRID, chosen, domain=PSLG(GRID, RIM), orientation="any")
            assert report.verdict(Property.COVERS_DOMAIN) is (Verdict.HOLDS if all(squares) else Verdict.FAILS)
            # the rim may lack what no cell touches, were the face behind it not of the domain
            assert report.ok is all(squares)
            assert (report.verdict(Property.COVERS_HULL) is Verdict.HOLDS) is all(squares)

    def test_labels(self) -> None:
        between = [(1, 4), (4, 5)]
        random = Random(1)
        verdicts = set()
        for chosen in tilings():
            labels = [random.choice((1, 1, 1, 2)) for _ in chosen]
            ordered = sorted(range(len(chosen)), key=lambda i: len(chosen[i]))  # triangles first, as cells count
            edges = {edge for cell in chosen for edge in cells_oracle.edges_of(cell)}
            segments = [segment for segment in between if frozenset(segment) in edges]
            same = all(
                labels[i] == labels[j] or common in map(frozenset, segments)
                for i, j in combinations(range(len(chosen)), 2)
                for common in set(cells_oracle.edges_of(chosen[i])) & set(cells_oracle.edges_of(chosen[j]))
            )
            report = checked(GRID, chosen, segments=segments, labels=[labels[i] for i in ordered])
            assert (report.verdict(Property.REGIONS) is Verdict.HOLDS) is same, (chosen, labels)
            verdicts.add(same)
        assert verdicts == {True, False}

    def test_control_halves_have_too_many_edges(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """A verifier that cuts quadrilaterals finds segments along their diagonals."""
        report = checked(GRID, SQUARES, segments=[(0, 8)])
        assert report.verdict(Property.SEGMENTS_PRESENT) is Verdict.FAILS
        original = cells.proper_cells

        def cut(upright: Cells, shapes: Shapes) -> Cells:
            triangles, quads = original(upright, shapes)
            halves = np.concatenate([triangles, quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
            return Cells(np.ascontiguousarray(halves), quads[:0])

        from exactmesh.verify import deciding

        monkeypatch.setattr(deciding, "proper_cells", cut)
        assert checked(GRID, SQUARES, segments=[(0, 8)]).verdict(Property.SEGMENTS_PRESENT) is Verdict.HOLDS


Mesh = tuple[FloatArray, npt.NDArray[np.int64], npt.NDArray[np.int64]]


def mixed_grid(seed: int, side: int = 9) -> Mesh:
    """A grid, every point but those of the rim moved a little, some squares cut."""
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(side), np.arange(side))
    points = np.stack([x.ravel(), y.ravel()], axis=1).astype(np.float64)
    inside = ((points > 0) & (points < side - 1)).all(axis=1)
    points[inside] += random.uniform(-0.2, 0.2, (int(inside.sum()), 2))
    a = np.flatnonzero((points[:, 0] < side - 1) & (points[:, 1] < side - 1))
    quads = np.stack([a, a + 1, a + side + 1, a + side], axis=1)
    cut = random.random(len(quads)) < 0.4
    triangles = np.concatenate([quads[cut][:, [0, 1, 2]], quads[cut][:, [0, 2, 3]]])
    return points, triangles, quads[~cut]


def reflex(mesh: Mesh, random: Random) -> Mesh:
    """Push a corner of a quadrilateral across its diagonal."""
    points, triangles, quads = mesh
    a, b, c, d = random.choice(quads.tolist())
    moved = points.copy()
    moved[c] = (points[a] + 0.45 * (points[b] - points[a]) + 0.45 * (points[d] - points[a])).tolist()
    return moved, triangles, quads


def straight(mesh: Mesh, random: Random) -> Mesh:
    """Make two quadrilaterals of the rim one with five corners, of which four are listed: one lies inside a side."""
    points, triangles, quads = mesh
    row = random.randrange(len(quads))
    changed = quads.copy()
    a, b, _, _ = quads[row].tolist()
    moved = np.concatenate([points, (points[a] + points[b])[None] / 2])
    changed[row] = (a, len(points), b, quads[row, 2])
    moved = np.round(moved * 1024) / 1024
    moved[-1] = (moved[a] + moved[b]) / 2
    return moved, triangles, changed


def crossed(mesh: Mesh, random: Random) -> Mesh:
    points, triangles, quads = mesh
    changed = quads.copy()
    row = random.randrange(len(quads))
    changed[row] = quads[row][[0, 2, 1, 3]]
    return points, triangles, changed


def clockwise(mesh: Mesh, random: Random) -> Mesh:
    points, triangles, quads = mesh
    changed = quads.copy()
    row = random.randrange(len(quads))
    changed[row] = quads[row][::-1]
    return points, triangles, changed


def repeated(mesh: Mesh, random: Random) -> Mesh:
    points, triangles, quads = mesh
    return points, triangles, np.concatenate([quads, quads[[random.randrange(len(quads))]]])


def half_covered(mesh: Mesh, random: Random) -> Mesh:
    """A triangle on top of the half of a quadrilateral, beneath its diagonal."""
    points, triangles, quads = mesh
    return points, np.concatenate([triangles, quads[[random.randrange(len(quads))]][:, [0, 1, 2]]]), quads


def dropped(mesh: Mesh, random: Random) -> Mesh:
    points, triangles, quads = mesh
    return points, triangles, np.delete(quads, random.randrange(len(quads)), axis=0)


def hanging(mesh: Mesh, random: Random) -> Mesh:
    """Two quadrilaterals in the place of one: the new points lie inside sides of the neighbours."""
    points, triangles, quads = mesh
    inner = [row for row, quad in enumerate(quads.tolist()) if points[quad].min() > 0 and points[quad].max() < 8]
    row = random.choice(inner)
    a, b, c, d = quads[row].tolist()
    n = len(points)
    whole = np.round(points * 1024) / 1024
    more = np.concatenate([whole, (whole[[a, d]] + whole[[b, c]]) / 2])
    halves = np.array([(a, n, n + 1, d), (n, b, c, n + 1)])
    return more, triangles, np.concatenate([np.delete(quads, row, axis=0), halves])


def unused(mesh: Mesh, random: Random) -> Mesh:
    points, triangles, quads = mesh
    corner = points[random.choice(quads.tolist())]
    return np.concatenate([points, corner.mean(axis=0)[None]]), triangles, quads


Corruption = tuple[Callable[[Mesh, Random], Mesh], Property, set[Kind]]
CORRUPTIONS: list[Corruption] = [
    (reflex, Property.CONVEX, {Kind.REFLEX_CORNER}),
    (reflex, Property.ADMISSIBLE, {Kind.REFLEX_CORNER, Kind.ZERO_AREA}),
    (straight, Property.CONVEX, {Kind.STRAIGHT_CORNER}),
    (crossed, Property.CONVEX, {Kind.NOT_SIMPLE}),
    (crossed, Property.ORIENTATION, {Kind.NOT_SIMPLE}),
    (clockwise, Property.ORIENTATION, {Kind.CLOCKWISE}),
    (clockwise, Property.EDGE_MANIFOLD, {Kind.REPEATED_EDGE}),
    (repeated, Property.ADMISSIBLE, {Kind.OVERLAP}),
    (repeated, Property.EDGE_MANIFOLD, {Kind.REPEATED_EDGE}),
    (half_covered, Property.ADMISSIBLE, {Kind.OVERLAP}),
    (dropped, Property.COVERS_HULL, {Kind.REFLEX_BOUNDARY, Kind.DISCONNECTED}),
    (hanging, Property.ADMISSIBLE, {Kind.HANGING_NODE}),
    (unused, Property.ALL_POINTS_USED, {Kind.UNUSED_POINT}),
]


@pytest.mark.bounds
@pytest.mark.obligation(
    "V2",
    "of a mesh with quadrilaterals, each corruption breaks the property that it should; the witness names it",
    method="corruption",
)
class TestCorrupted:
    """A mesh of triangles and quadrilaterals is what it claims to be; each corruption breaks the property that it is
    meant to break, and the witness names the cells that were touched."""

    @pytest.mark.parametrize("seed", range(4))
    def test_sound(self, seed: int) -> None:
        points, triangles, quads = mixed_grid(seed)
        report = verify(points, triangles, quads=quads)
        assert report.ok
        assert all(finding.verdict is Verdict.HOLDS for finding in report.findings.values())
        assert report.claims == tuple(p for p in Property if p in (*ADMISSIBLE_MESH, Property.CONVEX))
        exact = oracles.rationals(points.tolist())
        chosen = [tuple(cell) for cell in [*triangles.tolist(), *quads.tolist()]]
        assert sum(cells_oracle.area(exact, cell) for cell in chosen) == 2 * 8 * 8  # twice the area of the square

    @pytest.mark.parametrize(
        ("corrupt", "property_", "kinds"), CORRUPTIONS, ids=[f"{f.__name__}-{p}" for f, p, _ in CORRUPTIONS]
    )
    @pytest.mark.parametrize("seed", range(3))
    def test_control_rejected(
        self, corrupt: Callable[[Mesh, Random], Mesh], property_: Property, kinds: set[Kind], seed: int
    ) -> None:
        """Points moved, cells lost, doubled, turned round, folded, and more, one at a time."""
        points, triangles, quads = corrupt(mixed_grid(seed), Random(seed))
        report = verify(points, triangles, quads=quads)
        finding = report.findings[property_]
        assert finding.verdict is Verdict.FAILS
        assert {violation.kind for violation in finding.violations} <= kinds
        for violation in finding.violations:
            assert all(0 <= row < len(triangles) + len(quads) for row in violation.triangles)
            assert all(0 <= v < len(points) for v in violation.vertices)

    def test_clockwise_is_no_fault_with_any(self) -> None:
        points, triangles, quads = clockwise(mixed_grid(1), Random(1))
        assert verify(points, triangles, quads=quads, orientation="any").ok
        assert not verify(points, triangles, quads=quads).ok


def digests() -> list[str]:
    """One digest of the report a corruption."""
    meshes = [corrupt(mixed_grid(0), Random(0)) for corrupt in dict.fromkeys(c for c, _, _ in CORRUPTIONS)]
    reports = [verify(points, triangles, quads=quads) for points, triangles, quads in meshes]
    return [hashlib.sha256(report.to_json().encode()).hexdigest() for report in reports]


@pytest.mark.compiled
@pytest.mark.obligation(
    "J1", "the verifier says the same of quadrilaterals compiled and interpreted", method="bit for bit"
)
class TestLanes:
    """Reports are the same to the letter, the stages that decided included."""

    def test_interpreted(self) -> None:
        code = "from proofs_tests.verify.test_quads import digests; print(digests())"
        assert in_a_child("-c", code, NUMBA_DISABLE_JIT="1").strip() == str(digests())

    def test_control_digests_differ(self) -> None:
        """Other meshes: most digests differ."""
        assert len(set(digests())) > len(digests()) / 2


class TestWitnesses:
    """Cells count triangles first, messages say cell and quadrilateral, and never speak of halves."""

    def test_numbers(self) -> None:
        points = [(0, 0), (1, 0), (1, 1), (0, 1), (2, 0), (2, 1)]
        report = verify(points, [(1, 4, 5)], quads=[(0, 1, 2, 3), (0, 2, 1, 3)])
        (witness,) = report.findings[Property.CONVEX].violations
        assert witness.triangles == (2,)
        assert witness.vertices == (0, 2, 1, 3)
        assert witness.message == (
            "cell 2, the quadrilateral 0 (0.0, 0.0), 2 (1.0, 1.0), 1 (1.0, 0.0), 3 (0.0, 1.0), "
            "is no simple polygon: its sides cross or overlap"
        )
        assert repr(report) == "Report(6 points, 1 triangles, 2 quadrilaterals, orientation fails, convex fails, " + (
            "edge_manifold fails, admissible fails)"
        )

    def test_both_sides(self) -> None:
        points = [(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 2)]
        report = verify(points, [(3, 2, 4), (0, 1, 4)], quads=[(0, 1, 2, 3)])
        (witness,) = report.findings[Property.EDGE_MANIFOLD].violations
        assert witness.triangles == (1, 2)
        assert "cells 1, 2 lie on one side of the edge from 0" in witness.message

    def test_magnitudes(self) -> None:
        dart = verify([(0, 0), (4, 0), (1, 1), (0, 4)], (), quads=[(0, 1, 2, 3)])
        (witness,) = dart.findings[Property.CONVEX].violations
        assert (witness.kind, witness.magnitude, witness.sign) == (Kind.REFLEX_CORNER, Fraction(-8), Sign.NEGATIVE)
        assert "its corner 2 (1.0, 1.0) is reflex" in witness.message
        assert dart.verdict(Property.ORIENTATION) is Verdict.HOLDS
        turned = verify([(0, 0), (4, 0), (1, 1), (0, 4)], (), quads=[(3, 2, 1, 0)])
        (witness,) = turned.findings[Property.ORIENTATION].violations
        assert (witness.kind, witness.magnitude) == (Kind.CLOCKWISE, Fraction(-8))

    def test_indices(self) -> None:
        report = verify([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1, 2)], quads=[(0, 1, 2, 1), (0, 1, 2, 7)])
        found = [(v.kind, v.triangles) for v in report.findings[Property.INDICES].violations]
        assert found == [(Kind.REPEATED_CORNER, (1,)), (Kind.OUT_OF_RANGE, (2,))]


class TestInput:
    """What has no meaning for quadrilaterals cannot be claimed; shapes are checked; none are as good as not given."""

    SQUARE = ((0, 0), (1, 0), (1, 1), (0, 1))

    def test_claims(self) -> None:
        for claim in ("delaunay", "acute", "gabriel", "circumcentres_inside"):
            with pytest.raises(ChoiceError, match=f"{claim} cannot be claimed of quadrilaterals"):
                verify(self.SQUARE, quads=[(0, 1, 2, 3)], claims=[claim])
        with pytest.raises(ChoiceError, match="constrained_delaunay cannot be claimed of quadrilaterals"):
            verify(self.SQUARE, quads=[(0, 1, 2, 3)], segments=[(0, 1)], claims=["constrained_delaunay"])
        with pytest.raises(ChoiceError, match="min_angle= is about triangles"):
            verify(self.SQUARE, quads=[(0, 1, 2, 3)], min_angle=20)
        with pytest.raises(ChoiceError, match="convex cannot be claimed without quadrilaterals"):
            verify(self.SQUARE, [(0, 1, 2)], claims=["convex"])
        assert verify(self.SQUARE, quads=[(0, 1, 2, 3)], claims=["covers_hull", "convex"]).ok

    def test_defaults(self) -> None:
        rim = [(0, 1), (1, 2), (2, 3), (3, 0)]
        assert Property.SEGMENTS_PRESENT in verify(self.SQUARE, quads=[(0, 1, 2, 3)], segments=rim).claims
        claims = verify(self.SQUARE, quads=[(0, 1, 2, 3)], domain=PSLG(self.SQUARE, rim)).claims
        assert {Property.COVERS_DOMAIN, Property.DOMAIN_POINTS, Property.SEGMENTS_PRESENT} <= set(claims)
        assert Property.CONSTRAINED_DELAUNAY not in claims

    def test_no_quads(self) -> None:
        plain = verify(self.SQUARE, [(0, 1, 2), (0, 2, 3)])
        assert verify(self.SQUARE, [(0, 1, 2), (0, 2, 3)], quads=[]) == plain

    @pytest.mark.parametrize("quads", [[(0, 1, 2)], [(0.0, 1.0, 2.0, 3.0)], [[0, 1, 2, 3], [0, 1]], 3])
    def test_shapes(self, quads: npt.ArrayLike) -> None:
        with pytest.raises(ShapeError, match="quads"):
            verify(self.SQUARE, quads=quads)
