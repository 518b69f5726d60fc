"""The assertions say of every sort of mesh what their names say, whatever is usually claimed of such a mesh."""

import meshio
import numpy as np
import pytest
import shapely
import skfem

from exactmesh import PSLG, constrained_delaunay
from exactmesh.conformance import assert_admissible, assert_constrained_delaunay, assert_delaunay
from exactmesh.errors import ChoiceError
from exactmesh.verify import Severity

pytestmark = pytest.mark.once


KITE = np.array([(0.0, 0.0), (3.0, -1.0), (6.0, 0.0), (3.0, 1.0)])
WRONG, RIGHT = [(0, 1, 2), (0, 2, 3)], [(0, 1, 3), (1, 2, 3)]


def meshes(triangles: list[tuple[int, int, int]]) -> list[object]:
    """The same triangles as other packages have them."""
    return [
        (KITE, triangles),
        meshio.Mesh(KITE, [("triangle", triangles)]),
        shapely.GeometryCollection([shapely.Polygon(KITE[list(corners)]) for corners in triangles]),
        skfem.MeshTri(KITE.T, np.array(triangles).T),
    ]


@pytest.mark.obligation(
    "B5", "the assertions pass exactly what they are named for, from every package", method="named cases"
)
class TestAssertions:
    """Law: assert_delaunay passes exactly the Delaunay triangulations, from every package; likewise the others."""

    @pytest.mark.parametrize("mesh", meshes(RIGHT))
    def test_right(self, mesh: object) -> None:
        assert_delaunay(mesh)
        assert_admissible(mesh)

    @pytest.mark.parametrize("mesh", meshes(WRONG))
    def test_control_wrong_diagonal(self, mesh: object) -> None:
        """The wrong diagonal."""
        assert_admissible(mesh)
        with pytest.raises(AssertionError, match="lies inside the circumcircle"):
            assert_delaunay(mesh)

    def test_own_mesh_is_not_excused_by_its_segments(self) -> None:
        mesh = constrained_delaunay(PSLG(KITE, [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)]))
        assert_constrained_delaunay(mesh)
        with pytest.raises(AssertionError, match="delaunay fails"):
            assert_delaunay(mesh)

    def test_segments(self) -> None:
        assert_constrained_delaunay(KITE, WRONG, segments=[(0, 2)])
        with pytest.raises(AssertionError, match="segments_present fails"):
            assert_constrained_delaunay(KITE, WRONG, segments=[(1, 3)])
        mesh = meshio.Mesh(KITE, [("triangle", WRONG), ("line", [(1, 2)])])
        with pytest.raises(AssertionError, match="constrained_delaunay fails"):
            assert_constrained_delaunay(mesh)

    def test_nothing_to_be_constrained_by(self) -> None:
        with pytest.raises(ChoiceError, match="segments"):
            assert_constrained_delaunay(KITE, RIGHT)

    def test_quadrilaterals_are_not_delaunay(self) -> None:
        quad = meshio.Mesh(KITE, [("quad", [(0, 1, 2, 3)])])
        assert_admissible(quad)
        with pytest.raises(ChoiceError, match="quadrilaterals"):
            assert_delaunay(quad)

    def test_rounding_is_said(self) -> None:
        angles = np.linspace(0, 2 * np.pi, 7, endpoint=False)
        ring = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        fans = [[((i + 0) % 7, (i + j) % 7, (i + j + 1) % 7) for j in range(1, 6)] for i in range(7)]
        told = []
        for fan in fans:
            try:
                assert_delaunay(ring, fan)
            except AssertionError as error:
                told.append(str(error))
        assert told
        assert all(f"by {Severity.ROUNDING} only" in sentence for sentence in told)

    def test_what_is_missing_is_shown_with_all_points_that_are_named(self) -> None:
        with pytest.raises(AssertionError, match="no triangle covers the points 0") as caught:
            assert_delaunay([(0, 0), (1000, 0), (500, 0.001)], np.empty((0, 3), dtype=np.int64))
        assert all(f"# point {v}" in str(caught.value) for v in range(3))
        with pytest.raises(AssertionError, match="lies outside of all triangles") as caught:
            assert_delaunay([(0, 0), (1000, 0), (500, 1), (600, 5)], [(0, 1, 2)])
        assert "points =" not in str(caught.value)  # one point alone shows nothing
