"""V1 for labels and areas of regions, each check alone: against merged sets of triangles."""

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from random import Random

import numpy as np
import pytest
from proofs_tests import oracles
from proofs_tests.mesh.enumeration import grid, triangulations
from proofs_tests.oracles import Triangle
from proofs_tests.verify.test_links import arcs_of, links_of, mesh_of, naive_parts

from exactkernel.types import FloatArray
from exactmesh.verify import Finding, Kind, Verdict
from exactmesh.verify.cells import Cells
from exactmesh.verify.chains import CONSTRAINED, IN_DOMAIN, ODD, Marks, edge_slot
from exactmesh.verify.links import Links
from exactmesh.verify.mesh import Mesh
from exactmesh.verify.regions import check_labels, check_region_areas

Edge = tuple[int, int]
POINTS = grid(3, 3)
EXACT = oracles.rationals(POINTS)
MESHES = [*triangulations(POINTS)]


@dataclass(frozen=True)
class Case:
    """Triangles, which of their edges lie on segments, and points of regions: inside of triangles, beside all of them,
    and on segments."""

    triangles: list[Triangle]
    mesh: Mesh
    links: Links
    marks: Marks
    marked: set[frozenset[int]]
    seeds: FloatArray
    inside: list[int]

    @property
    def part(self) -> list[int]:
        """A name for the part of each triangle that segments leave connected."""
        owner = {(v, b): t for t, row in enumerate(self.triangles) for v, b, _ in arcs_of([row])}
        across = [
            [-1 if frozenset((v, b)) in self.marked else owner.get((b, v), -1) for v, b, _ in arcs_of([row])]
            for row in self.triangles
        ]
        parts = naive_parts(across)
        return [next(min(part) for part in parts if t in part) for t in range(len(self.triangles))]


def cases(seed: int, count: int) -> Iterator[Case]:
    random = Random(seed)
    for _ in range(count):
        triangles = [t for t in random.choice(MESHES) if random.random() < 0.85] or [*MESHES[0]]
        mesh = mesh_of(POINTS, triangles)
        links = links_of(mesh)
        marks, marked = np.zeros(len(links.slots), dtype=np.uint8), set()
        for edge in {(min(v, b), max(v, b)) for v, b, _ in arcs_of(triangles)}:
            bits = random.choice((0, 0, ODD, CONSTRAINED, IN_DOMAIN, CONSTRAINED | ODD))
            marks[edge_slot(links, *edge)] = bits
            if bits & (CONSTRAINED | IN_DOMAIN):
                marked.add(frozenset(edge))
        seeds, inside = [(-5.0, 1.0), (0.5, 9.0)], [-1, -1]
        seeds += [(sum(POINTS[v][0] for v in e) / 2, sum(POINTS[v][1] for v in e) / 2) for e in marked]
        inside += [-1] * len(marked)
        for t in random.choices(range(len(triangles)), k=random.randrange(5)):
            a, b, c = (POINTS[v] for v in triangles[t])
            seeds.append(((a[0] + b[0] + 2 * c[0]) / 4, (a[1] + b[1] + 2 * c[1]) / 4))
            inside.append(t)
        order = random.sample(range(len(seeds)), len(seeds))
        yield Case(
            triangles, mesh, links, marks, marked, np.array([seeds[i] for i in order]), [inside[i] for i in order]
        )


@pytest.fixture(autouse=True, params=[1, 4, 1 << 18])
def chunk(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> int:
    """However few vertices are looked at at a time."""
    monkeypatch.setattr(sys.modules["exactmesh.verify.regions"], "_CHUNK", request.param)
    return int(request.param)


def labelled(case: Case, labels: list[float], seeds: FloatArray, attributes: list[float]) -> Finding:
    cells = Cells(case.mesh.triangles, case.mesh.quads)
    return check_labels(
        case.mesh, case.links, cells, case.marks, np.array(labels), seeds, np.array(attributes, dtype=np.float64)
    )


@pytest.mark.obligation("V1", "labels differ only across segments", method="property-based")
class TestLabels:
    """A violation for each edge on no segment between triangles of different labels, which names both; the labels of
    a part are right if one of the points of regions in it says so, and otherwise each of these points is told."""

    NONE = np.empty((0, 2))

    def test_differing(self, chunk: int) -> None:
        random, seen = Random(chunk), set()
        for case in cases(chunk, 25):
            labels = [random.choice((1.0, 1.0, 1.0, 2.5)) for _ in case.triangles]
            owner = {(v, b): t for t, row in enumerate(case.triangles) for v, b, _ in arcs_of([row])}
            inner = {(v, b): (t, owner[b, v]) for (v, b), t in owner.items() if v < b and (b, v) in owner}
            free = {edge: rows for edge, rows in inner.items() if frozenset(edge) not in case.marked}
            expected = {edge: (s, t) for edge, (s, t) in free.items() if labels[s] != labels[t]}
            finding = labelled(case, labels, self.NONE, [])
            assert finding.count == len(expected)
            assert (finding.verdict is Verdict.FAILS) is bool(expected)
            for violation in finding.violations:
                v, b = violation.vertices
                s, t = expected[v, b]
                assert (violation.kind, violation.triangles) == (Kind.LABELS_DIFFER, (s, t))
                (ax, ay), (bx, by) = POINTS[v], POINTS[b]
                assert violation.message == (
                    f"triangles {s} and {t} have labels {labels[s]:g} and {labels[t]:g}, but no segment lies between "
                    f"them, on the edge {v} ({ax}.0, {ay}.0) - {b} ({bx}.0, {by}.0)"
                )
            assert {violation.vertices for violation in finding.violations} == {*expected}
            seen.add(min(len(expected), 2))
            again = labelled(case, labels, case.seeds, [0.0] * len(case.seeds))
            assert not expected or again == finding
        assert seen == {0, 1, 2}

    def test_control_seeds(self, chunk: int) -> None:
        """Attributes that no triangle has, beside right ones, and of points that are in no triangle."""
        random, seen = Random(chunk), set()
        for case in cases(chunk + 100, 25):
            part = case.part
            labels = [float(name) for name in part]
            attributes = [random.choice((99.0, labels[t])) for t in case.inside]
            right = {
                part[t] for t, attribute in zip(case.inside, attributes, strict=True) if t >= 0 and attribute != 99.0
            }
            wrong = [i for i, t in enumerate(case.inside) if t >= 0 and part[t] not in right]
            finding = labelled(case, labels, case.seeds, attributes)
            assert finding.count == len(wrong)
            assert (finding.verdict is Verdict.FAILS) is bool(wrong)
            for i, violation in zip(wrong, finding.violations, strict=True):
                (t,) = violation.triangles
                assert part[t] == part[case.inside[i]]
                assert (violation.kind, violation.vertices) == (Kind.WRONG_LABEL, case.triangles[t])
                assert violation.message == (
                    f"region {i} has attribute 99, but triangle {t} in its face has label {labels[t]:g}"
                )
            seen.add(min(len(wrong), 2))
        assert seen == {0, 1, 2}


@pytest.mark.obligation("V1", "no triangle is larger than the points of its region allow", method="property-based")
class TestAreas:
    """The smallest area that a point in a part asks for bounds all of its triangles; infinity bounds none."""

    def test_control_limits(self, chunk: int) -> None:
        """Areas a little below those of the triangles, equal to them, and above."""
        random, seen = Random(chunk), set()
        for case in cases(chunk + 200, 25):
            part = case.part
            areas = [random.choice((0.4375, 0.5, 0.75, 1.0, np.inf)) for _ in case.inside]
            limits = dict.fromkeys(part, np.inf)
            for t, area in zip(case.inside, areas, strict=True):
                if t >= 0:
                    limits[part[t]] = min(limits[part[t]], area)
            size = [oracles.orient(*(EXACT[v] for v in t)) / 2 for t in case.triangles]
            large = {t for t, name in enumerate(part) if size[t] > limits[name]}
            finding = check_region_areas(
                case.mesh, case.links, case.mesh.triangles, case.marks, case.seeds, np.array(areas)
            )
            assert finding.count == len(large)
            assert {violation.triangles[0] for violation in finding.violations} == large
            seen.add(min(len(large), 2))
        assert seen == {0, 1, 2}

    def test_without_limits(self) -> None:
        """Without areas nothing is asked."""
        for case in cases(7, 2):
            areas = np.full(len(case.seeds), np.inf)
            holds = check_region_areas(case.mesh, case.links, case.mesh.triangles, case.marks, case.seeds, areas)
            assert holds == Finding(Verdict.HOLDS)
