"""Holes as points: what a file needs to carve the same domain again."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exactmesh import PSLG, Carve, PSLGError, Triangulation, constrained_delaunay, io

Ring = list[tuple[float, float]]


def square(x: float, y: float, size: float) -> Ring:
    """Return the corners of a square."""
    return [(x, y), (x + size, y), (x + size, y + size), (x, y + size)]


@st.composite
def squares(draw: st.DrawFn) -> PSLG:
    """Return some squares whose outlines do not cross: nested, apart, touching, or the same."""
    rings = [square(0.0, 0.0, 32.0)]
    for _ in range(draw(st.integers(1, 6))):
        depth = draw(st.integers(1, 3))
        size = 32.0 / 2**depth
        x, y = (draw(st.integers(0, 2**depth - 1)) * size for _ in range(2))
        margin = draw(st.sampled_from([0.0, size / 8]))
        rings.append(square(x + margin, y + margin, size - 2 * margin))
    return PSLG.from_rings(rings)


def again(mesh: Triangulation) -> Triangulation:
    """Return the triangulation of what a ``.poly`` file keeps: the edges, and the seeds of the holes."""
    return constrained_delaunay(PSLG(mesh.points, mesh.segments, holes=mesh.holes))


@pytest.mark.obligation(
    "H1", "the segments and the seeds of the holes alone carve the same domain, by seeds", method="property-based"
)
class TestSeeds:
    """Whatever rule carved the domain, carving by the seeds of its holes carves it again."""

    @given(squares())
    def test_same_domain(self, pslg: PSLG) -> None:
        try:
            mesh = constrained_delaunay(pslg, crossings="split")
        except PSLGError:
            return  # nothing is left of it
        assert mesh.pslg is not None
        assert mesh.pslg.rule is Carve.EVEN_ODD
        assert again(mesh).canonical() == mesh.canonical()

    def test_control_without_seeds_the_hole_is_filled(self) -> None:
        """The seeds left out."""
        mesh = constrained_delaunay(PSLG.from_rings([square(0, 0, 9), square(2, 2, 5)]))
        filled = again(replace(mesh, holes=np.empty((0, 2))))
        assert again(mesh).statistics().area == mesh.statistics().area == 56.0
        assert filled.statistics().area == 81.0

    def test_given_seeds_stay_as_they_are(self) -> None:
        graph = PSLG.from_rings([square(0, 0, 9), square(2, 2, 5)])
        seeded = PSLG(graph.points, graph.segments, holes=[(2.25, 3.5)])
        assert constrained_delaunay(seeded).holes.tolist() == [[2.25, 3.5]]

    def test_a_hole_at_the_rim_is_none(self) -> None:
        halves = PSLG(
            [(0, 0), (1, 0), (2, 0), (2, 2), (1, 2), (0, 2)],
            [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 4)],
            holes=[(0.5, 1)],
        )
        mesh = constrained_delaunay(halves)
        assert len(mesh.holes) == 0
        assert again(mesh).canonical() == mesh.canonical()

    @pytest.mark.parametrize("name", ["mesh.poly", "mesh.npz"])
    def test_files(self, name: str, tmp_path: Path) -> None:
        mesh = constrained_delaunay(PSLG.from_rings([square(0, 0, 9), square(2, 2, 5), square(3, 3, 1)]))
        io.write(tmp_path / name, mesh)
        assert constrained_delaunay(io.read_pslg(tmp_path / name)).canonical() == mesh.canonical()
