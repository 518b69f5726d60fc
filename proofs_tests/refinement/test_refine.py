"""R1, R2: what refinement returns is what it says, for every valid graph; and it always returns."""

import math
import sys
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from proofs_tests import oracles
from proofs_tests.refinement import oracle as refine_oracle
from proofs_tests.refinement.oracle import Output
from proofs_tests.refinement.strategies import domains, drawn_domains, gentle_domains, hard_domains

from exactkernel.types import FloatArray
from exactmesh import PSLG, Triangulation, constrained_delaunay, refine
from exactmesh.errors import ChoiceError, CollinearPointsError, ExactMeshError, OptionError, PSLGError, ShapeError
from exactmesh.refinement import Reason, Refinement, Steiner, SteinerKind
from exactmesh.verify import CONFORMING_TRIANGULATION, DOMAIN_TRIANGULATION, Property, Verdict, verify

FEWER = settings(max_examples=max(20, settings().max_examples // 5))
SQUARE = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]
PLATE = PSLG(SQUARE, [(0, 1), (1, 2), (2, 3), (3, 0)])


def starting(domain: PSLG) -> Triangulation:
    """The triangulation that refinement starts from; some graphs have none."""
    try:
        return constrained_delaunay(domain)
    except (PSLGError, CollinearPointsError):
        assume(False)
        raise


def output_of(done: Refinement, domain: PSLG) -> Output:
    """The output beside the graph that it covers: the given one, or where points were moved, what it covers instead."""
    mesh = done.triangulation
    graph = domain if done.displacement_squared == 0 and mesh.arrangement is None else mesh.domain
    assert graph is not None
    triangles = [(int(a), int(b), int(c)) for a, b, c in mesh.triangles]
    segments = [(int(a), int(b)) for a, b in graph.segments]
    return Output([*map(tuple, mesh.points.tolist())], triangles, [*map(tuple, graph.points.tolist())], segments)


def twice_area(mesh: Triangulation) -> Fraction:
    points = oracles.rationals(mesh.points.tolist())
    return sum((oracles.orient(*(points[v] for v in t)) for t in mesh.triangles.tolist()), Fraction(0))


class Case(NamedTuple):
    """A domain and options."""

    domain: PSLG
    min_angle: float
    max_area: float | None
    steiner: Steiner
    max_steiner: int
    conforming: bool


@st.composite
def cases(draw: st.DrawFn, most: int = 40) -> Case:
    domain = draw(domains())
    extent = np.ptp(domain.points, axis=0)
    area = float(extent[0]) * float(extent[1]) / draw(st.sampled_from([2.0, 10.0, 100.0]))
    return Case(
        domain,
        draw(st.sampled_from([0.0, 5.0, 20.0, 30.0, 33.0, 40.0])),
        area if draw(st.booleans()) and 0.0 < area < math.inf else None,
        draw(st.sampled_from([Steiner.ANYWHERE, *Steiner])),
        draw(st.sampled_from([0, 1, 7, most])),
        draw(st.booleans()),
    )


def refined(case: Case) -> Refinement:
    return refine(
        case.domain,
        min_angle=case.min_angle,
        max_area=case.max_area,
        steiner=case.steiner,
        max_steiner=case.max_steiner,
        conforming=case.conforming,
    )


def region_faults(done: Refinement) -> set[int]:
    """The triangles larger than the area of their region, which TestRegions looks at itself."""
    mesh = done.triangulation
    if mesh.pslg is None or not len(mesh.pslg.regions):
        return set()
    points = [*map(tuple, mesh.points.tolist())]
    found = set()
    for i, (t, region) in enumerate(zip(mesh.triangles.tolist(), mesh.triangle_regions.tolist(), strict=True)):
        area = float(mesh.pslg.regions[region, 3]) if region >= 0 else -1.0
        if area > 0.0 and refine_oracle.area_faults(Output(points, [tuple(t)], [], []), area):
            found.add(i)
    return found


def account_faults(done: Refinement, output: Output, case: Case) -> list[str]:
    """Where the account of a refinement is not what brute force says: which triangles are left, and why."""
    wrong = refine_oracle.angle_faults(output, case.min_angle) if case.min_angle > 0.0 else set()
    if case.max_area is not None:
        wrong |= refine_oracle.area_faults(output, case.max_area)
    wrong |= region_faults(done)
    left = set(done.unrefined.tolist())
    faults = [f"triangle {t} is bad but not told" for t in wrong - left]
    if not case.conforming:
        faults += [f"triangle {t} is told but good" for t in left - wrong]
    reasons = {Reason(int(reason)) for reason in done.reasons}
    if Reason.BUDGET in reasons and len(done.steiner) != case.max_steiner:
        faults.append("the budget was not used up")
    if Reason.FORBIDDEN in reasons and case.steiner is Steiner.ANYWHERE:
        faults.append("nothing was forbidden")
    if Reason.MINIMUM_EDGE in reasons:
        faults.append("there was no least edge")
    if Reason.SMALL_INPUT_ANGLE in reasons and not refine_oracle.small_input_angle(output, 60.0):
        faults.append("no angle of the input is small")
    if done.complete is not (reasons <= {Reason.SMALL_INPUT_ANGLE}):
        faults.append("complete or not?")
    return faults


def steiner_faults(done: Refinement, start: Triangulation, case: Case) -> list[str]:
    """Numbers, kinds, parents and insertion radii."""
    mesh, first = done.triangulation, len(start.points)
    faults = [] if (mesh.points[:first] == start.points).all() else ["vertices of the input moved"]
    if done.steiner.tolist() != list(range(first, len(mesh.points))):
        faults.append("Steiner points are not those after the input's")
    if len(done.steiner) > case.max_steiner:
        faults.append("more points than allowed")
    on_segments = done.kinds != SteinerKind.INTERIOR
    if case.steiner is Steiner.NOT_ON_SEGMENTS and on_segments.any():
        faults.append("a point on a segment")
    if case.steiner is Steiner.NOT_ON_BOUNDARY:
        rim = {v for t, row in zip(mesh.triangles, mesh.neighbors, strict=True) for i in range(3) if row[i] < 0
               for v in (int(t[i - 1]), int(t[i - 2]))}  # fmt: skip
        if rim & set(done.steiner.tolist()):
            faults.append("a point on the boundary")
    points = oracles.rationals(mesh.points.tolist())
    for v, parent, radius in zip(done.steiner.tolist(), done.parents.tolist(), done.radii.tolist(), strict=True):
        if not -1 <= parent < v:
            faults.append(f"vertex {v} has the parent {parent}")
        # the nearest vertex may be hidden behind a segment; a rounded square root is within 2 ulp
        if Fraction(radius) ** 2 < refine_oracle.nearest_before(points, v) * (1 - Fraction(1, 2**48)):
            faults.append(f"vertex {v} has the radius {radius}")
    return faults


@pytest.mark.obligation(
    "R1", "theorems A, B, E, F on the output: constrained Delaunay, covering the domain", method="property-based"
)
class TestMesh:
    """Whatever is asked for, complete or not, the result is a constrained Delaunay triangulation of the domain: by
    brute force in fractions, and by the verifier."""

    @FEWER
    @given(cases())
    def test_theorems(self, case: Case) -> None:
        start = starting(case.domain)
        done = refined(case)
        exact = done.displacement_squared == 0
        assert not refine_oracle.mesh_faults(output_of(done, case.domain), twice_area(start) if exact else None)

    @FEWER
    @given(cases(most=300))
    def test_verifier(self, case: Case) -> None:
        starting(case.domain)
        done = refined(case)
        mesh = done.triangulation
        exact = done.displacement_squared == 0 and mesh.arrangement is None
        report = verify(
            mesh.points,
            mesh.triangles,
            domain=case.domain if exact else mesh.domain,
            claims=[*DOMAIN_TRIANGULATION, Property.ALL_POINTS_USED, Property.DISTINCT_POINTS],
        )
        report.raise_if_failed()

    @pytest.mark.parametrize(
        "corrupt",
        [
            lambda o: o._replace(triangles=o.triangles[1:]),
            lambda o: o._replace(triangles=[*o.triangles, o.triangles[0]]),
            lambda o: o._replace(triangles=[o.triangles[0][::-1], *o.triangles[1:]]),
            lambda o: o._replace(segments=[*o.segments, (0, 2)]),
            lambda o: o._replace(points=[*o.points[:-1], (o.points[-1][0] + 1.0, o.points[-1][1])]),
            lambda o: o._replace(points=[*o.points[:4], (2.0, 1e-3), *o.points[5:]]),
        ],
    )
    def test_control_corrupted(self, corrupt: Callable[[Output], Output]) -> None:
        """Triangles lost, doubled or turned, a segment or a point that is not there."""
        output = output_of(refine(PLATE, max_area=1.0), PLATE)
        assert not refine_oracle.mesh_faults(output, Fraction(32))
        assert refine_oracle.mesh_faults(corrupt(output), Fraction(32))

    def test_control_a_flipped_edge(self) -> None:
        """The other diagonal."""
        graph = PSLG([(0.0, 0.0), (3.0, -1.0), (6.0, 0.0), (3.0, 1.0)], [(0, 1), (1, 2), (2, 3), (3, 0)])
        points = [*map(tuple, graph.points.tolist())]
        segments = [*map(tuple, graph.segments.tolist())]
        for triangles, sound in (([(0, 1, 3), (1, 2, 3)], True), ([(0, 1, 2), (0, 2, 3)], False)):
            assert (not refine_oracle.mesh_faults(Output(points, triangles, points, segments))) is sound


@pytest.mark.obligation(
    "R1", "angle and area bounds hold exactly, and every exception is listed with its reason", method="property-based"
)
class TestAccount:
    """The triangles that are left are those that brute force finds bad; reasons apply; points, parents, radii are
    true."""

    @FEWER
    @given(cases())
    def test_exceptions(self, case: Case) -> None:
        starting(case.domain)
        done = refined(case)
        assert not account_faults(done, output_of(done, case.domain), case)

    @FEWER
    @given(cases())
    def test_points(self, case: Case) -> None:
        start = starting(case.domain)
        assert not steiner_faults(refined(case), start, case)

    def test_control_a_missing_exception_is_noticed(self) -> None:
        """An exception left out, a reason that does not apply, radii halved."""
        case = Case(PLATE, 20.0, 0.3, Steiner.ANYWHERE, 3, False)
        done = refined(case)
        output = output_of(done, PLATE)
        assert len(done.unrefined) > 1
        assert not account_faults(done, output, case)
        kept = np.arange(1, len(done.unrefined))
        told = replace(done, unrefined=done.unrefined[kept], reasons=done.reasons[kept])
        assert account_faults(told, output, case)
        blamed = replace(done, reasons=np.full_like(done.reasons, Reason.SMALL_INPUT_ANGLE))
        assert account_faults(blamed, output, case)
        larger = replace(done, radii=done.radii / 2)
        assert steiner_faults(larger, constrained_delaunay(PLATE), case)

    @FEWER
    @given(gentle_domains(), st.sampled_from([10.0, 20.0, 25.0, 30.0]))
    def test_right_angles_leave_nothing(self, domain: PSLG, degrees: float) -> None:
        """Where all angles of the input are 90 degrees, bounds up to 30 degrees are reached; theory promises 20.7."""
        done = refine(domain, min_angle=degrees, max_steiner=20000)
        assert done.complete
        assert not len(done.unrefined)
        mesh = done.triangulation
        claims = [*DOMAIN_TRIANGULATION, Property.REGION_AREAS]
        verify(mesh.points, mesh.triangles, domain=domain, min_angle=degrees, claims=claims).raise_if_failed()

    @FEWER
    @given(gentle_domains(), st.sampled_from([15.0, 20.0, 30.0]))
    def test_insertion_radii(self, domain: PSLG, degrees: float) -> None:
        """What is put inside for the sake of an angle is no nearer to what it sees than B = 1/(2 sin) times the radius
        of its parent: no chain of causes makes edges shorter."""
        bare = PSLG(domain.points, domain.segments, holes=domain.holes)
        done = refine(bare, min_angle=degrees, max_steiner=20000)
        start = len(done.triangulation.points) - len(done.steiner)
        radius = dict(zip(done.steiner.tolist(), done.radii.tolist(), strict=True))
        least = (1.0 - 2.0**-40) * 0.5 / math.sin(math.radians(degrees))
        inside = done.steiner[done.kinds == SteinerKind.INTERIOR].tolist()
        for v, parent in zip(inside, done.parents[done.kinds == SteinerKind.INTERIOR].tolist(), strict=True):
            if parent >= start:
                assert radius[v] >= least * radius[parent], (v, parent)


@pytest.mark.obligation(
    "R1",
    "conforming: every edge of the boundary and of a segment Gabriel, circumcentres inside",
    method="property-based",
)
class TestConforming:
    """With ``conforming``, wherever the points last: Gabriel by brute force and by the verifier."""

    @FEWER
    @given(domains(), st.sampled_from([0.0, 20.0]))
    def test_gabriel(self, domain: PSLG, degrees: float) -> None:
        starting(domain)
        done = refine(domain, min_angle=degrees, conforming=True, max_steiner=1500)
        assume(done.complete and len(done.steiner) < 1500)
        mesh = done.triangulation
        exact = done.displacement_squared == 0 and mesh.arrangement is None
        graph = domain if exact else mesh.domain
        claims = [claim for claim in CONFORMING_TRIANGULATION if claim is not Property.DOMAIN_POINTS]
        verify(mesh.points, mesh.triangles, domain=graph, claims=claims).raise_if_failed()
        if len(mesh.triangles) < 100:
            assert not refine_oracle.encroached(output_of(done, domain))

    def test_control_without_it_segments_are_encroached(self) -> None:
        """The refinement without ``conforming``."""
        tent = PSLG([(0.0, 0.0), (12.0, 0.0), (6.0, 4.0)], [(0, 1), (1, 2), (2, 0)])
        assert refine_oracle.encroached(output_of(refine(tent, min_angle=0), tent))
        done = refine(tent, min_angle=0, conforming=True)
        assert not refine_oracle.encroached(output_of(done, tent))


@pytest.mark.obligation(
    "R1", "size fields, unsuitable triangles, areas of triangles and regions", method="property-based"
)
class TestAskedFor:
    """What the user's functions object to is gone, or listed; areas hold where they are asked for."""

    @staticmethod
    def too_long(done: Refinement, size: Callable[[FloatArray], FloatArray]) -> set[int]:
        """Return the triangles with an edge that is longer than the size at their centroid."""
        corners = done.triangulation.points[done.triangulation.triangles]
        found = set()
        for i, (triangle, limit) in enumerate(zip(corners.tolist(), size(corners.mean(axis=1)).tolist(), strict=True)):
            a, b, c = oracles.rationals(triangle)
            longest = max(oracles.squared_distance(p, q) for p, q in ((a, b), (b, c), (c, a)))
            if longest > Fraction(limit) ** 2:
                found.add(i)
        return found

    @FEWER
    @given(domains(), st.floats(0.05, 1.0))
    def test_size(self, domain: PSLG, fraction: float) -> None:
        starting(domain)
        low, high = domain.points.min(axis=0), domain.points.max(axis=0)
        reach = float((high - low).max())
        assume(math.isfinite(reach) and reach > 2.0**-500)

        def size(xy: FloatArray) -> FloatArray:
            nearer: FloatArray = fraction * reach * (0.5 + np.abs(xy - low).max(axis=1) / reach)
            return nearer

        done = refine(domain, size=size, max_steiner=300)
        assert self.too_long(done, size) <= set(done.unrefined.tolist())
        if len(done.steiner) < 300:
            assert Reason.BUDGET not in done.reasons

    @FEWER
    @given(domains())
    def test_unsuitable(self, domain: PSLG) -> None:
        starting(domain)
        middle = domain.points.mean(axis=0)
        assume(np.isfinite(middle).all())

        def unsuitable(corners: FloatArray, areas: FloatArray) -> "np.ndarray[tuple[int], np.dtype[np.bool_]]":
            assert corners.shape == (len(areas), 3, 2)
            spread = np.ptp(corners, axis=1).max(axis=1)
            reach = float(np.ptp(domain.points, axis=0).max())
            near = np.abs(corners - middle).max(axis=(1, 2)) < 0.4 * reach
            answer: np.ndarray[tuple[int], np.dtype[np.bool_]] = near & (spread > reach / 8)
            return answer

        done = refine(domain, unsuitable=unsuitable, max_steiner=300)
        mesh = done.triangulation
        corners = mesh.points[mesh.triangles]
        asked = set(np.flatnonzero(unsuitable(corners, np.ones(len(corners)))).tolist())
        assert asked <= set(done.unrefined.tolist())

    def test_areas_of_triangles(self) -> None:
        start = constrained_delaunay(PLATE)
        done = refine(start, max_area=[0.5, -1.0])
        mesh = done.triangulation
        where = start.locate(mesh.points[mesh.triangles].mean(axis=1))
        points = oracles.rationals(mesh.points.tolist())
        areas = [oracles.orient(*(points[v] for v in t)) / 2 for t in mesh.triangles.tolist()]
        assert done.complete
        assert max(area for area, t in zip(areas, where, strict=True) if t == 0) <= Fraction(1, 2)
        assert max(area for area, t in zip(areas, where, strict=True) if t == 1) > Fraction(1, 2)

    def test_areas_of_regions(self) -> None:
        """The smaller of the region's area and ``max_area``; no area for a region without one."""
        graph = PSLG(SQUARE, [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)], regions=[(3, 1, 7, 0.25), (1, 3, 8, -1)])
        for max_area, expected in ((None, (0.25, math.inf)), (1.0, (0.25, 1.0)), (0.125, (0.125, 0.125))):
            mesh = refine(graph, max_area=max_area).triangulation
            points = [*map(tuple, mesh.points.tolist())]
            for region, area in enumerate(expected):
                mine = [tuple(t) for t in mesh.triangles[mesh.triangle_regions == region].tolist()]
                output = Output(points, mine, [], [])
                assert mine
                assert area == math.inf or not refine_oracle.area_faults(output, area)
            verify(
                mesh.points, mesh.triangles, domain=graph, labels=mesh.triangle_attributes,
                claims=["region-areas", "regions"],
            ).raise_if_failed()  # fmt: skip

    def test_control_without_being_asked(self) -> None:
        """The size left out: edges are too long, and no triangle is listed for it."""
        done = refine(PLATE)
        assert not self.too_long(done, lambda xy: np.full(len(xy), 0.5)) <= set(done.unrefined.tolist())


@pytest.mark.obligation("R1", "refining further, again and elsewhere gives the same", method="property-based")
class TestRepetition:
    """The result depends on the input alone; what is good is left as it is; a power of two changes nothing."""

    @FEWER
    @given(cases())
    def test_deterministic(self, case: Case) -> None:
        starting(case.domain)
        one, two = refined(case), refined(case)
        for name in ("unrefined", "reasons", "steiner", "kinds", "parents", "radii"):
            assert np.array_equal(getattr(one, name), getattr(two, name))
        assert np.array_equal(one.triangulation.points, two.triangulation.points)
        assert np.array_equal(one.triangulation.triangles, two.triangulation.triangles)

    @FEWER
    @given(hard_domains(), st.sampled_from([20.0, 30.0]))
    def test_again(self, domain: PSLG, degrees: float) -> None:
        starting(domain)
        done = refine(domain, min_angle=degrees, max_steiner=1000)
        assume(not len(done.unrefined))
        again = refine(done.triangulation, min_angle=degrees)
        assert not len(again.steiner)
        assert again.triangulation.canonical() == done.triangulation.canonical()

    @FEWER
    @given(cases())
    def test_further(self, case: Case) -> None:
        """From a triangulation: the domain is still that of the graph."""
        start = starting(case.domain)
        done = refined(case)
        further = refine(done.triangulation, min_angle=25.0, max_steiner=30)
        mesh = further.triangulation
        assert (mesh.points[: len(done.triangulation.points)] == done.triangulation.points).all()
        exact = done.displacement_squared == further.displacement_squared == 0
        if exact:
            assert not refine_oracle.mesh_faults(output_of(further, case.domain), twice_area(start))
        verify(mesh.points, mesh.triangles, domain=mesh.domain).raise_if_failed()

    @FEWER
    @given(hard_domains(), st.sampled_from([-30, 20]))
    def test_scaled(self, domain: PSLG, exponent: int) -> None:
        starting(domain)
        assume((np.abs(domain.points[domain.points != 0.0]) > 2.0**-100).all())
        other = PSLG(np.ldexp(domain.points, exponent), domain.segments, holes=np.ldexp(domain.holes, exponent))
        one, two = refine(domain, max_steiner=200), refine(other, max_steiner=200)
        assert np.array_equal(np.ldexp(one.triangulation.points, exponent), two.triangulation.points)
        assert np.array_equal(one.triangulation.triangles, two.triangulation.triangles)

    def test_control_one_unit(self) -> None:
        """One coordinate moved by one unit in the last place: the points are others."""
        moved = PLATE.points.copy()
        moved[2, 0] = np.nextafter(moved[2, 0], 99.0)
        one, two = refine(PLATE, max_area=0.5), refine(PSLG(moved, PLATE.segments, holes=PLATE.holes), max_area=0.5)
        assert not np.array_equal(one.triangulation.points, two.triangulation.points)


@pytest.mark.obligation("R2", "refinement ends, for every valid graph and every angle", method="property-based")
class TestTermination:
    """Counted, not timed: a limit on points that is far above what is needed is not reached."""

    @FEWER
    @given(drawn_domains(), st.sampled_from([20.0, 30.0, 33.0]), st.booleans())
    def test_it_ends(self, domain: PSLG, degrees: float, conforming: bool) -> None:
        starting(domain)
        done = refine(domain, min_angle=degrees, conforming=conforming, max_steiner=50000)
        assert Reason.BUDGET not in done.reasons

    @pytest.mark.compiled
    @pytest.mark.parametrize("degrees", [36.0, 38.0, 40.0])
    def test_angles_beyond_theory(self, degrees: float) -> None:
        """Where the angle would never be reached, what is given up says so; what is not given up holds."""
        spokes = [(6.0 * math.cos(0.7 * i), 5.0 * math.sin(0.7 * i)) for i in range(9)]
        frame = [(-8.0, -8.0), (8.0, -8.0), (8.0, 8.0), (-8.0, 8.0)]
        graph = PSLG([*frame, *spokes], [(0, 1), (1, 2), (2, 3), (3, 0), *((4 + i, 5 + i) for i in range(8))])
        done = refine(graph, min_angle=degrees, max_steiner=2_000_000)
        assert set(done.reasons.tolist()) <= {Reason.TERMINATION, Reason.SMALL_INPUT_ANGLE}
        mesh = done.triangulation
        report = verify(mesh.points, mesh.triangles, domain=mesh.domain, min_angle=degrees)
        assert report.findings[Property.MIN_ANGLE].count == len(done.unrefined)
        assert [c for c in report.claims if report.verdict(c) is not Verdict.HOLDS] in ([], [Property.MIN_ANGLE])

    @FEWER
    @given(domains(), st.integers(2, 12), st.sampled_from([20.0, 33.0, 40.0]))
    def test_least_edge(self, domain: PSLG, steps: int, degrees: float) -> None:
        """No edge with a new end is shorter than ``min_edge``; the points are distinct and few."""
        starting(domain)
        reach = float(np.ptp(domain.points, axis=0).max())
        assume(2.0**-500 < reach < 2.0**500)
        least = reach * 2.0**-steps
        done = refine(domain, min_angle=degrees, min_edge=least, max_steiner=3000)
        mesh = done.triangulation
        first = len(mesh.points) - len(done.steiner)
        points = oracles.rationals(mesh.points.tolist())
        for a, b in mesh.edges.tolist():
            if max(a, b) >= first:
                assert oracles.squared_distance(points[a], points[b]) >= Fraction(least) ** 2
        assert set(done.reasons.tolist()) <= {*Reason} - {Reason.FORBIDDEN}

    def test_control_without_the_rule_it_goes_on(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Edges that may become ever shorter for the sake of an angle: the limit on points is reached."""
        points = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (0.3, 1.7), (1.1, 2.9), (3.3, 0.4)]
        graph, limit = PSLG(points, [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5)]), 2000
        assert Reason.BUDGET not in refine(graph, min_angle=40.0, max_steiner=limit).reasons
        monkeypatch.setattr(sys.modules["exactmesh.refinement.refine"], "_SHRINKS", ((60.0, 0.0),))
        assert Reason.BUDGET in refine(graph, min_angle=40.0, max_steiner=limit).reasons


BAD_OPTIONS: list[tuple[dict[str, object], type[Exception], str]] = [
    ({"min_angle": 60}, OptionError, "min_angle"),
    ({"min_angle": 90}, OptionError, "min_angle"),
    ({"min_angle": -1}, OptionError, "min_angle"),
    ({"min_angle": math.nan}, OptionError, "min_angle"),
    ({"min_angle": math.inf}, OptionError, "min_angle"),
    ({"min_angle": "20"}, OptionError, "min_angle"),
    ({"min_angle": None}, OptionError, "min_angle"),
    ({"max_area": 0}, OptionError, "max_area"),
    ({"max_area": -1}, OptionError, "max_area"),
    ({"max_area": math.nan}, OptionError, "max_area"),
    ({"max_area": [1.0, 1.0]}, OptionError, "max_area"),
    ({"max_area": "a"}, ExactMeshError, "max_area"),
    ({"max_area": [[1.0]]}, ExactMeshError, "max_area"),
    ({"size": -3}, OptionError, "size"),
    ({"size": 0}, OptionError, "size"),
    ({"size": math.nan}, OptionError, "size"),
    ({"size": "3"}, OptionError, "size"),
    ({"unsuitable": "no"}, OptionError, "unsuitable"),
    ({"steiner": "never"}, ChoiceError, "steiner"),
    ({"max_steiner": -1}, OptionError, "max_steiner"),
    ({"max_steiner": 1.5}, OptionError, "max_steiner"),
    ({"max_steiner": math.nan}, OptionError, "max_steiner"),
    ({"min_edge": -1}, OptionError, "min_edge"),
    ({"min_edge": math.nan}, OptionError, "min_edge"),
    ({"min_edge": math.inf}, OptionError, "min_edge"),
    ({"crossings": "maybe"}, ChoiceError, "crossings"),
    ({"size": lambda xy: np.zeros(len(xy))}, OptionError, "size"),
    ({"size": lambda xy: -np.ones(len(xy))}, OptionError, "size"),
    ({"size": lambda xy: np.full(len(xy), math.nan)}, OptionError, "size"),
    ({"size": lambda xy: np.ones(len(xy) + 1)}, ShapeError, "size"),
    ({"size": lambda _: "1.0"}, ShapeError, "size"),
    ({"size": lambda _: None}, ShapeError, "size"),
    ({"size": lambda xy: ["a"] * len(xy)}, ShapeError, "size"),
    ({"size": lambda xy: [1j] * len(xy)}, ShapeError, "size"),
    ({"size": lambda _: [[1.0], [1.0, 2.0]]}, ExactMeshError, "size"),
    ({"unsuitable": lambda c, _: np.ones((len(c), 2), dtype=bool)}, ShapeError, "unsuitable"),
    ({"unsuitable": lambda c, _: np.full(len(c), 2.0)}, ShapeError, "unsuitable"),
    ({"unsuitable": lambda *_: True}, ShapeError, "unsuitable"),
    ({"unsuitable": lambda *_: None}, ShapeError, "unsuitable"),
    ({"unsuitable": lambda *_: [[True], [True, False]]}, ExactMeshError, "unsuitable"),
]


@pytest.mark.obligation("R2", "bad options: a typed error, or an honest partial result", method="named cases")
class TestBadInput:
    """What is no option names itself; what asks for too much gets a partial result that says so."""

    @pytest.mark.parametrize(("options", "error", "word"), BAD_OPTIONS)
    def test_refused(self, options: dict[str, object], error: type[Exception], word: str) -> None:
        with pytest.raises(error, match=word):
            refine(PLATE, **options)  # type: ignore[arg-type]  # what an untyped caller passes

    @pytest.mark.parametrize("domain", [None, 3, SQUARE, {"vertices": SQUARE}, np.zeros((3, 2))])
    def test_no_domain(self, domain: object) -> None:
        with pytest.raises(ShapeError):
            refine(domain)  # type: ignore[arg-type]  # what an untyped caller passes

    def test_no_angle(self) -> None:
        done = refine(PLATE, min_angle=0)
        assert done.complete
        assert len(done.triangulation.triangles) == 2

    def test_an_infinite_area_bounds_nothing(self) -> None:
        assert not len(refine(PLATE, min_angle=0, max_area=math.inf).steiner)

    @pytest.mark.parametrize("budget", [0, 1, 5])
    def test_budgets(self, budget: int) -> None:
        done = refine(PLATE, max_area=1e-6, max_steiner=budget)
        assert len(done.steiner) == budget
        assert not done.complete
        assert set(done.reasons.tolist()) == {Reason.BUDGET}
        verify(done.triangulation.points, done.triangulation.triangles, domain=PLATE).raise_if_failed()

    @pytest.mark.parametrize("size", [5e-324, 1e-30])
    def test_a_size_of_nearly_zero(self, size: float) -> None:
        done = refine(PLATE, size=lambda xy: np.full(len(xy), size), max_steiner=500)
        assert len(done.steiner) == 500
        assert not done.complete
        assert len(done.unrefined) == len(done.triangulation.triangles)

    def test_an_area_of_nearly_zero(self) -> None:
        done = refine(PLATE, max_area=5e-324, max_steiner=500)
        assert len(done.unrefined) == len(done.triangulation.triangles)

    def test_always_yes(self) -> None:
        done = refine(PLATE, unsuitable=lambda _, areas: areas > 0.0, max_steiner=500)
        assert len(done.steiner) == 500
        verify(done.triangulation.points, done.triangulation.triangles, domain=PLATE).raise_if_failed()
        least = refine(PLATE, unsuitable=lambda _, areas: areas > 0.0, min_edge=0.5)
        assert set(least.reasons.tolist()) == {Reason.MINIMUM_EDGE}

    def test_a_changing_mind(self) -> None:
        rng = np.random.default_rng(5)
        done = refine(PLATE, unsuitable=lambda _, areas: rng.random(len(areas)) < 0.3, max_steiner=2000)
        verify(done.triangulation.points, done.triangulation.triangles, domain=PLATE, min_angle=20).raise_if_failed()

    def test_answers_of_other_types(self) -> None:
        """Lists and numpy's numbers do as well."""
        done = refine(PLATE, size=lambda xy: [2] * len(xy), unsuitable=lambda c, _: [False] * len(c))
        assert done.complete

    @pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt, SystemExit, MemoryError])
    def test_functions_that_raise(self, error: type[BaseException]) -> None:
        """What they raise comes out, and the library works on."""
        calls = [0]

        def raising(corners: FloatArray, _: FloatArray) -> "np.ndarray[tuple[int], np.dtype[np.bool_]]":
            calls[0] += 1
            if calls[0] > 2:
                raise error("mine")
            return np.ones(len(corners), dtype=np.bool_)

        with pytest.raises(error, match="mine"):
            refine(PLATE, unsuitable=raising)
        assert refine(PLATE, max_area=1.0).complete

    def test_functions_cannot_change_the_mesh(self) -> None:
        """What they are given cannot be written to."""

        def scribble(corners: FloatArray, _: FloatArray) -> "np.ndarray[tuple[int], np.dtype[np.bool_]]":
            corners[:] = 7.0
            return np.ones(len(corners), dtype=np.bool_)

        with pytest.raises(ValueError, match="read-only"):
            refine(PLATE, unsuitable=scribble, max_steiner=200)

    def test_results_cannot_be_changed(self) -> None:
        done = refine(PLATE, max_area=1.0)
        for name in ("unrefined", "reasons", "steiner", "kinds", "parents", "radii"):
            assert not getattr(done, name).flags.writeable

    def test_ctrl_c_in_the_progress(self) -> None:
        def stop(*_: int) -> None:
            raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            refine(PLATE, max_area=1e-4, progress=stop)
        assert refine(PLATE, max_area=1.0).complete

    def test_nothing_but_points(self) -> None:
        """No segments: the hull is refined, or there is no domain; either way it says so."""
        try:
            done = refine(PSLG(SQUARE))
        except ExactMeshError:
            return
        assert done.triangulation.segments is not None
        assert verify(done.triangulation.points, done.triangulation.triangles, claims=["admissible"]).verdict(
            Property.ADMISSIBLE
        ) is Verdict.HOLDS  # fmt: skip

    def test_control_good_options(self) -> None:
        """None: the same options with values that they may have are taken."""
        done = refine(
            PLATE, min_angle=20, max_area=1.0, min_edge=1e-3, size=lambda xy: np.ones(len(xy)), max_steiner=999
        )
        assert done.complete
