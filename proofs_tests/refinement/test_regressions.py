"""What went wrong once in refinement, each with the input that showed it."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from exactkernel import angle_below, diametral
from exactmesh import PSLG, Property, Reason, Refinement, Steiner, refine, verify

BOX = [(-8.0, -8.0), (8.0, -8.0), (8.0, 8.0), (-8.0, 8.0)]
RING = [(0, 1), (1, 2), (2, 3), (3, 0)]


def is_right(done: Refinement) -> bool:
    """Tell whether the independent verifier finds a constrained Delaunay mesh of the domain."""
    mesh = done.triangulation
    claims = (Property.ADMISSIBLE, Property.CONSTRAINED_DELAUNAY, Property.COVERS_DOMAIN, Property.SEGMENTS_PRESENT)
    return verify(mesh.points, mesh.triangles, segments=mesh.segments, domain=mesh.domain, claims=claims).ok


@pytest.mark.obligation(
    "R2",
    "lengths that halve because of what is near by are not taken for a run that never ends",
    method="named cases",
    control_in="TestExcuses",
)
class TestChannels:
    """Segments far longer than they are apart, which meet at right angles or not at all, are refined to the end."""

    @pytest.mark.parametrize("angle", [20.0, 30.0])
    def test_a_plate_in_a_trough(self, angle: float) -> None:
        outer, inner = [(0, 0), (800, 0), (800, 8), (0, 8)], [(100, 3), (600, 3), (600, 4), (100, 4)]
        done = refine(PSLG([*outer, *inner], [*RING, (4, 5), (5, 6), (6, 7), (7, 4)]), min_angle=angle)
        assert len(done.unrefined) == 0
        assert is_right(done)

    def test_two_wires(self) -> None:
        outer = [(-2000, -2000), (3000, -2000), (3000, 3000), (-2000, 3000)]
        done = refine(PSLG([*outer, (0, 0), (1000, 0), (-300, 1), (700, 1)], [*RING, (4, 5), (6, 7)]), min_angle=20)
        assert len(done.unrefined) == 0


@pytest.mark.obligation(
    "R1", "only triangles across from an input angle below 60 degrees are excused by one", method="named cases"
)
class TestExcuses:
    """A domain without small angles has no triangle that a small input angle excuses."""

    KITE = (
        (0.1227932325667169, 0.027947816336554937),
        (-0.19890476877408902, 0.046488613112628835),
        (-0.05359532751704863, -0.2761514158371821),
        (0.25174351230267583, -0.03193660038479987),
    )

    def test_a_kite(self) -> None:
        done = refine(PSLG(self.KITE, RING), min_angle=30)
        assert len(done.unrefined) == 0
        corners = done.triangulation.points[done.triangulation.triangles]
        assert not any(angle_below([tuple(p) for p in corner], 30) for corner in corners.tolist())

    def test_control_a_needle_has_some(self) -> None:
        """A domain that has a small angle."""
        done = refine(PSLG([(0, 0), (9, 0), (9, 1)], [(0, 1), (1, 2), (2, 0)]), min_angle=30)
        assert set(done.reasons.tolist()) == {Reason.SMALL_INPUT_ANGLE}


@pytest.mark.obligation(
    "R1", "where points are rounded off their segments, the mesh is constrained Delaunay still", method="named cases"
)
class TestBentSegments:
    """Segments at tiny angles, made Gabriel down to the last bits: what is returned is right, complete or not."""

    @pytest.mark.parametrize("degrees", [1e-3, 1e-8, 1e-10])
    def test_a_fan(self, degrees: float) -> None:
        turns = np.radians(17.0 + degrees * np.arange(3))
        tips = np.stack([np.cos(turns), np.sin(turns)], axis=1) * np.array([[1.0], [1.1], [1.2]])
        graph = PSLG([*BOX, (0, 0), *tips.tolist()], [*RING, (4, 5), (4, 6), (4, 7)])
        done = refine(graph, min_angle=0, conforming=True, max_steiner=400)
        assert is_right(done)

    def test_small_integers(self) -> None:
        points = [(0, 0), (4, 0), (4, 4), (0, 4), (2, 3), (0, 1), (2, 4), (3, 0)]
        done = refine(PSLG(points, [*RING, (4, 5), (5, 6), (6, 7), (7, 4)]), min_angle=0, conforming=True)
        assert done.complete
        assert len(done.steiner) < 40
        mesh = done.triangulation
        for a, b in mesh.segments.tolist():
            start, end = (tuple(mesh.points[v].tolist()) for v in (a, b))
            assert all(diametral(start, end, tuple(p)) <= 0 for p in mesh.points.tolist())

    def test_control_a_point_moved(self) -> None:
        """A Steiner point moved off its place: the verifier's answer is no."""
        points = [(0, 0), (4, 0), (4, 4), (0, 4), (2, 3), (0, 1), (2, 4), (3, 0)]
        done = refine(PSLG(points, [*RING, (4, 5), (5, 6), (6, 7), (7, 4)]), min_angle=0, conforming=True)
        moved = done.triangulation.points.copy()
        moved[-1] += 0.5
        assert is_right(done)
        assert not is_right(replace(done, triangulation=replace(done.triangulation, points=moved)))


@pytest.mark.obligation(
    "R2", "sizes below what forbidden edges allow are given up, not halved for ever", method="named cases"
)
class TestForbiddenEdges:
    """Where the boundary must not be divided, triangles on it are left, with the reason."""

    def test_a_size_far_below_the_boundary(self) -> None:
        plate = PSLG.from_rings([[(0, 0), (9, 0), (9, 1), (0, 1)]])
        done = refine(plate, min_angle=0, size=lambda p: np.full(len(p), 0.25), steiner=Steiner.NOT_ON_BOUNDARY)
        assert set(done.reasons.tolist()) == {Reason.FORBIDDEN}
        assert len(done.triangulation.boundary()[0]) == 4
        assert is_right(done)

    def test_control_allowed(self) -> None:
        """The same with a boundary that may be divided: nothing is given up."""
        plate = PSLG.from_rings([[(0, 0), (9, 0), (9, 1), (0, 1)]])
        done = refine(plate, min_angle=0, size=lambda p: np.full(len(p), 0.25))
        assert done.complete
        assert len(done.triangulation.boundary()[0]) > 4


@pytest.mark.obligation(
    "R1", "no edge with a new end is shorter than min_edge, by as little as may be", method="named cases"
)
class TestLeastEdge:
    """A length that rounds to the least edge, and is shorter, is refused; one that is the least edge is not."""

    def test_rounded(self) -> None:
        points = [*BOX, (0, 0), (-2.49688102, 5.45578456), (-0.74909287, 1.63672229)]
        done = refine(PSLG(points, [*RING, (4, 5), (4, 6)]), min_angle=40, min_edge=0.5, max_steiner=3000)
        mesh = done.triangulation
        new = mesh.edges[mesh.edges.max(axis=1) >= len(points)]
        for a, b in mesh.points[new].tolist():
            dx, dy = (Fraction(p) - Fraction(q) for p, q in zip(a, b, strict=True))
            assert dx * dx + dy * dy >= Fraction(1, 4)

    def test_control_equal(self) -> None:
        """A length that is the least edge exactly."""
        square = PSLG([(0, 0), (4, 0), (4, 4), (0, 4)], RING)
        mesh = refine(
            square, unsuitable=lambda corners, _: np.ones(len(corners), dtype=bool), min_edge=0.5
        ).triangulation
        assert mesh.statistics().shortest_edge == 0.5


@pytest.mark.obligation(
    "R1", "the displacement is a bound of the root of its exact square, at any scale", method="named cases"
)
class TestDisplacement:
    """Squares beyond the doubles, above and below, have roots that are doubles."""

    @pytest.mark.parametrize("scale", [1e300, 1.0, 1e-200])
    def test_scales(self, scale: float) -> None:
        points = np.array([(0, 0), (4, 0), (4, 2), (0, 1.1)]) * scale
        done = refine(PSLG.from_rings([points]), min_angle=33)
        assert done.displacement_squared > 0
        assert 0.0 < done.displacement < 1e-14 * scale

    def test_control_exact(self) -> None:
        """A domain whose points are not rounded."""
        assert refine(PSLG.from_rings([[(0, 0), (4, 0), (4, 2), (0, 1)]]), min_angle=33).displacement == 0.0


class TestNothingAsked:
    """Without a bound, nothing is added, however close segments come."""

    def test_parallel_segments(self) -> None:
        graph = PSLG([*BOX, (-4, 0), (4, 0), (-1.87, 9.09e-13), (5, 9.09e-13)], [*RING, (4, 5), (6, 7)])
        done = refine(graph, min_angle=0)
        assert len(done.steiner) == 0
        assert done.complete

    def test_control_something_asked(self) -> None:
        graph = PSLG([*BOX, (-4, 0), (4, 0)], [*RING, (4, 5)])
        assert len(refine(graph, min_angle=33).steiner) > 0
