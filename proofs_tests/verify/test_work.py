"""V1: what the verifier asks for, counted in predicates."""

from collections import Counter

import numpy as np
import numpy.typing as npt
import pytest

from exactkernel.types import FloatArray
from exactmesh import delaunay
from exactmesh.verify import Report, verify

RANDOM = np.random.default_rng(3)
ANGLES = np.arange(60) * (np.pi / 30)
POINTS: dict[str, FloatArray] = {
    "one triangle": np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]),
    "12 x 12 grid": np.array([(float(x), float(y)) for x in range(12) for y in range(12)]),
    "60 on a circle": np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1),
    "a hub": np.concatenate([[(0.0, 0.0)], np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1)]),
    **{f"{n} at random": RANDOM.random((n, 2)) for n in (10, 100, 1000)},
}


def asked(report: Report) -> tuple[int, int]:
    """How many orientations and circles, whatever stage decided them."""
    return sum(report.stages["orient2d"].values()), sum(report.stages["incircle"].values())


def expected(triangles: npt.NDArray[np.int32]) -> tuple[int, int]:
    """Four orientations a triangle and one a boundary edge; one circle an inner edge."""
    times = Counter(frozenset((t[i - 1], t[i])) for t in triangles.tolist() for i in range(3))
    boundary = sum(count == 1 for count in times.values())
    return 4 * len(triangles) + boundary, len(times) - boundary


@pytest.mark.obligation(
    "V1",
    "of a Delaunay triangulation four signs a triangle, one a hull edge and one circle an inner edge are asked for",
    method="named cases",
)
class TestWork:
    """Law: everything about a Delaunay triangulation is decided by four orientations a triangle (one is its turn, three
    are its angles), one a vertex of the hull, and one circle an inner edge, however many triangles there are."""

    @pytest.mark.parametrize("name", POINTS)
    def test_counts(self, name: str) -> None:
        mesh = delaunay(POINTS[name])
        report = verify(mesh.points, mesh.triangles)
        assert report.ok
        assert asked(report) == expected(mesh.triangles)

    def test_control_a_bay_takes_a_sweep(self) -> None:
        """A triangle of the boundary taken away: the sweep over the edges of the bay asks for more."""
        mesh = delaunay(POINTS["100 at random"])
        on_the_hull = (mesh.neighbors < 0).any(axis=1)
        triangles = np.delete(mesh.triangles, np.flatnonzero(on_the_hull)[0], axis=0)
        report = verify(mesh.points, triangles, claims=["admissible"])
        assert report.ok
        assert asked(report)[0] > expected(triangles)[0]
