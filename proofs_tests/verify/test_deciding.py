"""V1 for what is decided of small lists of cells as a whole: shortcuts change no answer."""

import hashlib
import struct
from collections import defaultdict
from collections.abc import Sequence
from itertools import product
from types import SimpleNamespace
from typing import ClassVar

import numpy as np
import numpy.typing as npt
import pytest
from proofs_tests import oracles
from proofs_tests.kernel.interpreted import calls_of
from proofs_tests.oracles import Triangle

from exactmesh.verify import Finding, Property, Verdict, constrained, verify
from exactmesh.verify.domain import Outline
from exactmesh.verify.hashing import array_sha256, domain_sha256

Place = tuple[float, float]

#: Triangles round the origin, one pinch after the other, and two closed fans over each other.
RING = [(4.0, 0.0), (0.0, 4.0), (-4.0, 0.0), (0.0, -4.0)]
CASES: dict[str, tuple[list[Place], list[Triangle]]] = {
    "fan": ([(0.0, 0.0), *RING], [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 1)]),
    "pinched": ([(9.0, 9.0), (0.0, 0.0), *RING, (9.0, 0.0)], [(1, 2, 3), (1, 4, 5), (2, 6, 0)]),
    "pinched twice": ([*RING, (0.0, 0.0), (8.0, 1.0), (8.0, -1.0)], [(4, 0, 1), (4, 2, 3), (0, 6, 5)]),
    "two rounds": (
        [(0.0, 0.0), *RING, *((2 * x - y, 2 * y + x) for x, y in RING)],
        [(0, i, i % 4 + 1) for i in range(1, 5)] + [(0, i + 4, i % 4 + 5) for i in range(1, 5)],
    ),
}


def broken_fans(triangles: Sequence[Triangle]) -> set[int]:
    opposite = defaultdict(list)
    for t in triangles:
        for i in range(3):
            opposite[t[i]].append((t[i - 2], t[i - 1]))
    return {v for v, edges in opposite.items() if not oracles.is_one_fan(edges)}


@pytest.mark.obligation("V1", "broken fans are found whatever else is wrong", method="exhaustive", control_in="mutants")
class TestFans:
    """Any of the triangles listed clockwise, pinched vertices, fans over each other: VERTEX_MANIFOLD fails just at the
    vertices whose triangles, as they are listed, form no fan."""

    @pytest.mark.parametrize("name", CASES)
    def test_turned_round(self, name: str) -> None:
        points, triangles = CASES[name]
        for turned in product((False, True), repeat=min(len(triangles), 4)):
            some = [t[::-1] if is_turned else t for t, is_turned in zip(triangles, turned, strict=False)]
            rows = [*some, *triangles[4:]]
            finding = verify(points, rows).findings[Property.VERTEX_MANIFOLD]
            assert {v.vertices[0] for v in finding.violations} == broken_fans(rows)
            finding = verify(points, rows, orientation="any").findings[Property.VERTEX_MANIFOLD]
            assert {v.vertices[0] for v in finding.violations} == broken_fans(triangles)


@pytest.mark.obligation("V1", "where cells overlap, nothing is said that rests on it", method="named cases")
class TestNotAdmissible:
    """Coincident points are found all the same; whether the hull is covered is open, and so is what rests on that."""

    def test_double_cover(self) -> None:
        found = verify(*CASES["two rounds"])
        assert found.verdict(Property.ADMISSIBLE) is Verdict.FAILS
        assert found.findings[Property.COVERS_HULL].because == (Property.ADMISSIBLE,)
        assert found.findings[Property.DELAUNAY].verdict is not Verdict.HOLDS

    def test_control_one_position_under_two_indices(self) -> None:
        """All points are used: they are compared because the triangles are not admissible."""
        points = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, 0.0), (-1.0, 0.0), (0.0, -1.0)]
        found = verify(points, [(0, 1, 2), (3, 4, 5)])
        assert found.verdict(Property.ADMISSIBLE) is Verdict.FAILS
        (violation,) = found.findings[Property.DISTINCT_POINTS].violations
        assert violation.vertices == (0, 3)
        points[3] = (0.0, -0.5)
        assert verify(points, [(0, 1, 2), (3, 4, 5)]).verdict(Property.DISTINCT_POINTS) is Verdict.HOLDS

    def test_the_search_has_ended(self) -> None:
        """Cells without area, or two on one side of an edge: there may be more than was found."""
        flat = verify([(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)], [(0, 1, 2)]).findings[Property.ADMISSIBLE]
        twice = verify([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, 2.0)], [(0, 1, 2), (0, 1, 3)])
        assert flat.lower_bound
        assert twice.findings[Property.ADMISSIBLE].lower_bound
        assert not verify(*CASES["fan"]).findings[Property.ADMISSIBLE].lower_bound


@pytest.mark.obligation("V1", "what rests on something names it", method="named cases", control_in="mutants")
class TestBecause:
    """Gabriel edges, and circumcentres inside, rest on admissible triangles that are (constrained) Delaunay; each is
    decided alone as well. Points that no triangle uses count for Delaunay, where the triangles cover them."""

    obtuse, rows = [(0.0, 0.0), (3.0, -1.0), (6.0, 0.0), (3.0, 1.0)], [(0, 1, 2), (0, 2, 3)]

    def gabriel(self, points: Sequence[Place], triangles: Sequence[Triangle], **given: object) -> Finding:
        report = verify(points, triangles, claims=["gabriel"], **given)  # type: ignore[call-overload]  # by name
        finding = report.findings[Property.GABRIEL]
        assert isinstance(finding, Finding)
        return finding

    def test_gabriel(self) -> None:
        square = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]
        assert self.gabriel(square, self.rows).verdict is Verdict.HOLDS
        assert self.gabriel(self.obtuse, self.rows).because == (Property.DELAUNAY,)
        other = [(1, 2), (0, 1)]
        assert self.gabriel(self.obtuse, self.rows, segments=other).because == (Property.CONSTRAINED_DELAUNAY,)
        missing = (Property.SEGMENTS_PRESENT, Property.CONSTRAINED_DELAUNAY)
        assert self.gabriel(self.obtuse, self.rows, segments=[(1, 3)]).because == missing
        twice = [(0.0, 0.0), (4.0, 0.0), (2.0, 3.0), (2.0, 4.0)]
        assert Property.ADMISSIBLE in self.gabriel(twice, [(0, 1, 2), (0, 1, 3)]).because

    @pytest.mark.parametrize("claim", ["gabriel", "circumcentres_inside"])
    def test_alone(self, claim: str) -> None:
        square = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]
        report = verify(square, self.rows, claims=[claim])
        assert report.ok
        others = {"gabriel", "circumcentres_inside"} - {claim}
        assert not others & {str(property_) for property_ in report.findings}

    def test_unused_points(self) -> None:
        """Inside of a triangle, at the position of a corner, on an edge; outside."""
        points, triangles = CASES["fan"]
        for more, verdict in (
            ((1.0, 1.0), Verdict.FAILS), ((2.0, 2.0), Verdict.FAILS), ((4.0, 0.0), Verdict.HOLDS),
            ((9.0, 0.0), Verdict.UNDECIDED),
        ):  # fmt: skip
            report = verify([*points, more], triangles)
            assert report.verdict(Property.DELAUNAY) is verdict
            assert report.findings[Property.ALL_POINTS_USED].violations[0].vertices == (5,)


def naive(head: str, *arrays: npt.NDArray[np.generic]) -> str:
    """The canonical bytes, one number after the other."""
    data = head.encode()
    for array in arrays:
        data += struct.pack("<qq", *array.shape)
        for number in array.ravel().tolist():
            data += struct.pack("<q" if array.dtype.kind == "i" else "<d", number)
    return hashlib.sha256(data).hexdigest()


@pytest.mark.obligation("V2", "a domain's hash is that of its numbers and its rule", method="differential")
class TestHashes:
    """As an array after the other; unsigned indices where they fit are the same as signed ones."""

    def test_domain(self) -> None:
        points = np.array([(0.0, 0.0), (2.0, 0.0), (0.0, 2.0)])
        segments = np.array([(0, 1), (1, 2), (2, 0)])
        names = set[str]()
        for even_odd in (False, True):
            for holes in (np.empty((0, 2)), np.array([(0.5, 0.5)])):
                outline = Outline(points, segments, holes, np.empty((0, 2)), np.empty(0), np.empty(0), even_odd)
                names.add(domain_sha256(outline))
                rule = "even-odd" if even_odd else "seeds"
                assert domain_sha256(outline) == naive(
                    f"exactmesh-domain/1 {rule}\n", points, segments, holes, np.empty((0, 4))
                )
        assert len(names) == 4

    @pytest.mark.parametrize("index", [0, 2**31, 2**63 - 1])
    def test_unsigned(self, index: int) -> None:
        signed, unsigned = (np.array([[1, index]], dtype=dtype) for dtype in ("i8", "u8"))
        assert array_sha256(signed) == array_sha256(unsigned)

    def test_control_beyond(self) -> None:
        """2^63 is not the -2^63 that has its bits."""
        assert array_sha256(np.array([2**63], dtype="u8")) != array_sha256(np.array([-(2**63)]))


@pytest.mark.obligation("V1", "what is decided of a domain's segments", method="named cases")
class TestDomainSegments:
    """A domain's segments are exempt from being Delaunay where the mesh has none of its own, not otherwise; and areas
    of regions are looked at where they are claimed."""

    POINTS: ClassVar[list[Place]] = [(0.0, 0.0), (4.0, 0.0), (2.0, 1.0), (2.0, -1.0)]
    TRIANGLES: ClassVar[list[Triangle]] = [(0, 1, 2), (0, 3, 1)]  # on both sides of the long diagonal
    DOMAIN = SimpleNamespace(
        points=POINTS,
        segments=[(0, 3), (3, 1), (1, 2), (2, 0), (0, 1)],
        holes=[],
        regions=[(2.0, 0.5, 1.0, 5.0)],
        rule="seeds",
    )

    @pytest.mark.parametrize(
        ("segments", "verdict"), [(None, Verdict.HOLDS), ([(0, 1)], Verdict.HOLDS), ([(0, 2)], Verdict.FAILS)]
    )
    def test_exempt(self, segments: list[tuple[int, int]] | None, verdict: Verdict) -> None:
        findings = verify(self.POINTS, self.TRIANGLES, segments=segments, domain=self.DOMAIN).findings
        assert findings[Property.SEGMENTS_PRESENT].verdict is Verdict.HOLDS
        assert findings[Property.CONSTRAINED_DELAUNAY].verdict is verdict

    def test_control_not_at_all(self) -> None:
        """Segments of the mesh, none of which is the diagonal."""
        self.test_exempt([], Verdict.FAILS)

    @pytest.mark.parametrize("claims", [(Property.ADMISSIBLE,), (Property.REGION_AREAS,)])
    def test_areas_on_claim(self, claims: tuple[Property, ...], monkeypatch: pytest.MonkeyPatch) -> None:
        looked = calls_of(monkeypatch, constrained, "check_region_areas")
        findings = verify(self.POINTS, self.TRIANGLES, domain=self.DOMAIN, claims=claims).findings
        assert len(looked) == (Property.REGION_AREAS in claims)
        assert (Property.REGION_AREAS in findings) is (Property.REGION_AREAS in claims)

    @pytest.mark.parametrize(
        ("unused", "triangles", "sweeps"),
        [([(2.0, 0.5)], TRIANGLES, 1), ([], TRIANGLES, 0), ([(2.0, 0.5)], [(0, 1, 2), (0, 1, 2)], 0)],
    )
    def test_sweeps(
        self, unused: list[Place], triangles: list[Triangle], sweeps: int, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """Where the triangles are admissible, and some unused point may be covered by them."""
        seen = calls_of(monkeypatch, constrained, "surveyed")
        findings = verify([*self.POINTS, *unused], triangles, segments=[(0, 1)]).findings
        assert len(seen) == sweeps
        verdicts = {1: Verdict.FAILS, 0: Verdict.HOLDS if triangles == self.TRIANGLES else Verdict.UNDECIDED}
        assert findings[Property.CONSTRAINED_DELAUNAY].verdict is verdicts[sweeps]
