"""V1 for witnesses of ADMISSIBLE and of segments: every sentence is true, by fractions, of the cells that it names."""

from collections import Counter, defaultdict
from decimal import Decimal
from fractions import Fraction
from itertools import combinations, product

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.oracles import Triangle
from proofs_tests.verify.test_constrained import Plain
from proofs_tests.verify.test_links import links_of, mesh_of
from proofs_tests.verify.test_sweep import LATTICE, SCATTERED, covers, meet_improperly, sets_of

from exactmesh.verify import Finding, Kind, Property, Verdict, verify
from exactmesh.verify.admissible import check_sweep
from exactmesh.verify.boundary import boundary_of
from exactmesh.verify.cells import Cells
from exactmesh.verify.constrained import stacked
from exactmesh.verify.domain import constraints_of

Points = list[tuple[int, int]]
Edge = tuple[int, int]


def name(points: Points, v: int) -> str:
    return f"{v} ({float(points[v][0])!r}, {float(points[v][1])!r})"


def edge_name(points: Points, e: Edge) -> str:
    return f"the edge {name(points, e[0])} - {name(points, e[1])}"


def edges_of(t: Triangle) -> list[Edge]:
    return [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]


def about(value: Fraction) -> str:
    return f"{Decimal(value.numerator) / Decimal(value.denominator):.3g}"


def meeting(points: Points, triangles: list[Triangle]) -> Finding:
    """What the sweep finds of counterclockwise triangles, no directed edge of which occurs twice."""
    mesh = mesh_of(points, triangles)
    return check_sweep(mesh, Cells(mesh.triangles, mesh.quads), boundary_of(links_of(mesh)))


def true_sentences(points: Points, s: Triangle, t: Triangle, rows: Edge) -> dict[str, list[tuple[Kind, set[int]]]]:
    """All that can be said of how two triangles meet improperly, and which vertices each sentence may be about."""
    exact, found = oracles.rationals(points), defaultdict[str, list[tuple[Kind, set[int]]]](list)
    both = f": triangles {rows[0]} and {rows[1]}"
    for e in edges_of(s):
        for f in edges_of(t):
            if not meet_improperly(exact, e, f):
                continue
            hanging = [(v, one) for one, other in ((e, f), (f, e)) for v in other
                       if v not in one and oracles.on_segment(exact[v], exact[one[0]], exact[one[1]])]  # fmt: skip
            for v, one in hanging:
                sentence = f"vertex {name(points, v)} lies on {edge_name(points, one)}"
                found[sentence + both].append((Kind.HANGING_NODE, {*e, *f}))
            if not hanging:
                for one, other in ((e, f), (f, e)):
                    sentence = f"{edge_name(points, one)} crosses {edge_name(points, other)}"
                    found[sentence + both].append((Kind.CROSSING, {*e, *f}))
    for e in [*edges_of(s), *edges_of(t)]:
        if covers(exact, [s, t], e) == 2:
            sentence = f"triangles {rows[0]} and {rows[1]} overlap, to the left of {edge_name(points, e)}"
            found[sentence].append((Kind.OVERLAP, {*e}))
    return found


@pytest.mark.obligation("V1", "what is said of two cells that meet improperly is true of them", method="enumeration")
class TestMeetings:
    """Of any set of triangles that is not admissible two are named, in order, that are not so by themselves; what is
    said of them is one of the true sentences, and the vertices are those of the edges in it."""

    @pytest.mark.parametrize("points", [LATTICE, SCATTERED])
    @pytest.mark.parametrize("seed", range(3))
    def test_sentences(self, points: Points, seed: int) -> None:
        exact, seen = oracles.rationals(points), Counter[Kind]()
        for triangles in sets_of(points, seed + 10, 40):
            finding = meeting(points, triangles)
            pairs = combinations(triangles, 2)
            assert (finding.verdict is Verdict.HOLDS) is all(oracles.meet_admissibly(exact, s, t) for s, t in pairs)
            if finding.verdict is Verdict.HOLDS:
                continue
            (violation,) = finding.violations
            assert (finding.count, finding.lower_bound) == (1, True)
            i, j = violation.triangles
            assert i < j
            assert not oracles.meet_admissibly(exact, triangles[i], triangles[j])
            meanings = true_sentences(points, triangles[i], triangles[j], (i, j))[violation.message]
            assert any(kind is violation.kind and corners <= {*violation.vertices} for kind, corners in meanings)
            assert len({*violation.vertices}) == len(violation.vertices) <= 4
            seen[violation.kind] += 1
        assert len(seen) >= 2

    def test_control_each_kind(self) -> None:
        """A corner on an edge, two edges that cross, and a triangle within another one."""
        points = [(0, 0), (8, 0), (0, 8), (4, 0), (6, -4), (3, -4), (1, 1), (3, 1), (1, 3), (-1, 2), (9, 1)]
        big = (0, 1, 2)
        for other, kind in (((3, 5, 4), Kind.HANGING_NODE), ((6, 7, 8), Kind.OVERLAP), ((9, 6, 10), Kind.CROSSING)):
            for triangles in ([big, other], [other, big]):
                exact = oracles.rationals(points)
                assert oracles.orient(*(exact[v] for v in other)) > 0
                (violation,) = verify(points, triangles).findings[Property.ADMISSIBLE].violations
                assert violation.kind is kind
                sentences = true_sentences(points, triangles[0], triangles[1], (0, 1))
                assert kind in [meant for meant, _ in sentences[violation.message]]

    @pytest.mark.parametrize("turn", [(1, 0), (0, 1), (-2, 1)])
    def test_on_one_line(self, turn: tuple[int, int]) -> None:
        """Two triangles on two sides of a line, with edges on it that overlap in any way: the corner is told that is
        inside of the other's edge, and none that is beside it."""
        x, y = turn
        points = [(x * u - y * v, y * u + x * v) for u, v in [*((u, 0) for u in range(5)), (1, 3), (2, -3)]]
        pairs = [*product(combinations(range(5), 2), repeat=2)]
        pairs = [(e, f) for e, f in pairs if max(e[0], f[0]) < min(e[1], f[1]) and e != f]
        for i, ((a, b), (c, d)) in enumerate(pairs):
            rows = [((a, b, 5), (b, 5, a))[i % 2], ((d, c, 6), (c, 6, d))[i // 2 % 2]]
            triangles = rows[:: (1, -1)[i // 4 % 2]]
            (violation,) = meeting(points, triangles).violations
            assert violation.kind is Kind.HANGING_NODE
            assert true_sentences(points, triangles[0], triangles[1], (0, 1))[violation.message]

    def test_same_position(self) -> None:
        """Corners of the boundary that share a position are told pair by pair, with a triangle at each."""
        points = [(0, 0), (4, 0), (0, 4), (0, 0), (-4, 0), (0, -4), (4, 0), (9, 1), (9, -1), (0, 0), (1, 9), (-1, 9)]
        triangles = [(0, 1, 2), (3, 4, 5), (6, 8, 7), (9, 10, 11)]
        finding = verify(points, triangles).findings[Property.ADMISSIBLE]
        expected = {(0, 3): (0, 1), (3, 9): (1, 3), (1, 6): (0, 2)}
        assert (finding.verdict, finding.count, finding.lower_bound) == (Verdict.FAILS, 3, True)
        for violation in finding.violations:
            v, w = violation.vertices
            assert violation.triangles == expected.pop((v, w))
            assert violation.kind is Kind.HANGING_NODE
            message = f"corners {name(points, v)} and {name(points, w)} are at the same position"
            assert violation.message == message
        assert not expected

    def test_zero_area(self) -> None:
        points = [(0, 0), (4, 0), (0, 4), (2, 0)]
        finding = verify(points, [(0, 3, 2), (0, 1, 3), (3, 1, 0)]).findings[Property.ADMISSIBLE]
        for violation, (t, corners) in zip(finding.violations, ((1, (0, 1, 3)), (2, (3, 1, 0))), strict=True):
            assert (violation.kind, violation.triangles, violation.vertices) == (Kind.ZERO_AREA, (t,), corners)
            names = ", ".join(name(points, v) for v in corners)
            assert violation.message == f"triangle {t} = {names} has no area"
        assert (finding.count, finding.lower_bound) == (2, True)

    def test_control_quads(self) -> None:
        """Quadrilaterals are cells: one that a triangle crosses, and one that covers another one."""
        points = [(0, 0), (8, 0), (8, 8), (0, 8), (-1, 2), (9, 1), (-1, 6), (1, 1), (3, 1), (3, 3), (1, 3)]
        crossed = verify(points, [(4, 5, 6)], quads=[(0, 1, 2, 3)]).findings[Property.ADMISSIBLE].violations[0]
        assert crossed.message.endswith(": cells 0 and 1")
        assert crossed.kind is Kind.CROSSING
        covered = verify(points, quads=[(0, 1, 2, 3), (7, 8, 9, 10)]).findings[Property.ADMISSIBLE].violations[0]
        assert covered.message.startswith("cells 0 and 1 overlap, to the left of the edge ")
        assert (covered.kind, covered.triangles) == (Kind.OVERLAP, (0, 1))


SQUARE: Points = [(0, 0), (4, 0), (4, 4), (0, 4), (2, 0), (4, 0)]
HALVES: list[Triangle] = [(0, 4, 3), (4, 2, 3), (4, 1, 2)]


@pytest.mark.obligation("V1", "of each segment that is missing is said why", method="exhaustive")
class TestSegments:
    """All pairs of indices, some of which are none: a segment is there iff edges between its ends lie on it; of the
    others those with an index out of range, without a length, and the rest are told apart."""

    def test_pairs(self) -> None:
        n, exact = len(SQUARE), oracles.rationals(SQUARE)
        edges = {frozenset(e) for t in HALVES for e in edges_of(t)}
        pairs = [(a, b) for a in range(-2, n + 2) for b in range(-2, n + 2)]
        finding = verify(SQUARE, HALVES, segments=pairs).findings[Property.SEGMENTS_PRESENT]
        told = {violation.message.split()[1]: violation for violation in finding.violations}
        assert len(told) == len(finding.violations) == finding.count
        kinds = Counter[Kind]()
        for i, (a, b) in enumerate(pairs):
            violation = told.pop(str(i), None)
            if not (0 <= a < n and 0 <= b < n):
                kind, message = Kind.OUT_OF_RANGE, f"segment {i} ({a}, {b}) has an index outside 0 .. {n - 1}"
            else:
                message = f"segment {i} from {name(SQUARE, a)} to {name(SQUARE, b)} "
                if exact[a] == exact[b]:
                    kind, message = Kind.NO_SEGMENT, f"{message}has no length"
                elif frozenset((a, b)) in edges or {a, b} == {0, 1}:
                    assert violation is None
                    continue
                else:
                    kind, message = Kind.MISSING_SEGMENT, f"{message}is no chain of edges"
            assert violation is not None
            assert (violation.kind, violation.vertices, violation.message) == (kind, (a, b), message)
            kinds[kind] += 1
        assert not told
        assert min(kinds.values()) > 5

    def test_control_both(self) -> None:
        """Segments of the mesh and of the domain: either may be missing, or both."""
        points = [(0, 0), (4, 0), (4, 4), (0, 4)]
        rim = [(0, 1), (1, 2), (2, 3), (3, 0)]
        rows = [(0, 1, 2), (0, 2, 3)]
        for own, theirs, count in (
            ([(0, 2)], rim, 0),
            ([(1, 3)], rim, 1),
            ([], [*rim, (1, 3)], 1),
            ([(1, 3)], [*rim, (1, 3)], 2),
        ):
            domain = Plain.of([(float(x), float(y)) for x, y in points], theirs)
            report = verify(points, rows, segments=own, domain=domain)
            finding = report.findings[Property.SEGMENTS_PRESENT]
            assert finding.count == count
            assert finding.verdict is (Verdict.FAILS if count else Verdict.HOLDS)
            constrained = report.findings[Property.CONSTRAINED_DELAUNAY]
            assert constrained.because == ((Property.SEGMENTS_PRESENT,) if count else ())

    def test_without_admissible(self) -> None:
        """Where triangles overlap, missing segments are no news; nor is what rests on them."""
        points = [(0, 0), (4, 0), (4, 4), (0, 4)]
        overlapping = [(0, 1, 2), (0, 1, 3)]
        report = verify(points, overlapping, segments=[(1, 3)], labels=[1.0, 2.0])
        for property_ in (Property.SEGMENTS_PRESENT, Property.CONSTRAINED_DELAUNAY, Property.REGIONS):
            finding = report.findings[property_]
            if property_ is Property.SEGMENTS_PRESENT and finding.verdict is Verdict.HOLDS:
                continue
            assert finding.verdict is Verdict.UNDECIDED
            assert Property.ADMISSIBLE in finding.because

    def test_labels_alone(self) -> None:
        """Labels with segments and without a domain: only those that differ across free edges are told."""
        points = [(0, 0), (4, 0), (4, 4), (0, 4)]
        for segments, verdict in (([(0, 2)], Verdict.HOLDS), ([], Verdict.FAILS)):
            report = verify(points, [(0, 1, 2), (0, 2, 3)], segments=segments, labels=[1.0, 2.0])
            assert report.verdict(Property.REGIONS) is verdict

    def test_stacked(self) -> None:
        """All positions of a domain, points before holes before regions; without a domain none."""
        assert stacked(None).shape == (0, 2)
        domain = Plain(np.array([(0.0, 0.0), (1.0, 0.0)]), np.array([(0, 1)], dtype=np.int32), np.array([(2.0, 3.0)]),
                       np.array([(4.0, 5.0, 6.0)]), "seeds")  # fmt: skip
        outline = constraints_of(None, domain, None, 0).outline
        assert stacked(outline).tolist() == [[0, 0], [1, 0], [2, 3], [4, 5]]
