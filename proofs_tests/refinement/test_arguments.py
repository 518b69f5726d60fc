"""What refine takes besides the plainest: other domains of a graph, lengths as numbers; what it tells the rest."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from exactkernel.types import FloatArray
from exactmesh import (
    PSLG,
    ClipError,
    OptionError,
    PSLGError,
    ShapeError,
    Triangulation,
    constrained_delaunay,
    delaunay,
    lloyd,
    refine,
    voronoi,
)
from exactmesh.io import write

CORNERS = [(0, 0), (4, 0), (4, 3), (0, 3)]
HOLE = [(1, 1), (2, 1), (2, 2), (1, 2)]
PLATE = PSLG.from_rings([CORNERS, HOLE])


def area(mesh: Triangulation) -> Fraction:
    """Return the area of all triangles, exactly."""
    total = Fraction(0)
    for a, b, c in mesh.points[mesh.triangles].tolist():
        (ax, ay), (bx, by), (cx, cy) = ([Fraction(x) for x in p] for p in (a, b, c))
        total += (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return total / 2


def longest_edge_squared(mesh: Triangulation) -> Fraction:
    """Return the square of the longest edge, exactly."""
    ends = [[[Fraction(x) for x in p] for p in pair] for pair in mesh.points[mesh.edges].tolist()]
    return max((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2 for a, b in ends)


@pytest.mark.obligation("R2", "the domain of a graph is what carve says, refined or not", method="named cases")
class TestCarve:
    """Law: refine(graph, carve=c) refines what constrained_delaunay(graph, carve=c) triangulates."""

    @pytest.mark.parametrize("carve", [True, "even-odd", False])
    def test_the_domain_is_the_same(self, carve: bool | str) -> None:
        domain = constrained_delaunay(PLATE, carve=carve)
        refined = refine(PLATE, carve=carve, max_area=0.5).triangulation
        assert len(refined.triangles) > len(domain.triangles)
        assert area(refined) == area(domain)

    def test_control_the_domains_differ(self) -> None:
        """Carving turned off: the area is another."""
        assert area(refine(PLATE).triangulation) == 11
        assert area(refine(PLATE, carve=False).triangulation) == 12

    def test_points_without_segments(self) -> None:
        graph = PSLG(CORNERS, [])
        assert area(refine(graph, carve=False, max_area=0.5).triangulation) == 12
        with pytest.raises(PSLGError, match="carve=False"):
            refine(graph)


@pytest.mark.obligation(
    "R2", "a number as size, or from a size function, is that length everywhere", method="named cases"
)
class TestSize:
    """Law: a length as ``size``, and a function that returns one number, mean that length everywhere."""

    @pytest.mark.parametrize("length", [0.75, np.float32(0.75), 1, np.int64(2)])
    def test_a_number_is_a_constant_function(self, length: float) -> None:
        def everywhere(at: FloatArray) -> FloatArray:
            return np.full(len(at), float(length))

        expected = refine(PLATE, size=everywhere).triangulation
        assert longest_edge_squared(expected) <= Fraction(float(length)) ** 2
        for size in (length, lambda _: length):
            found = refine(PLATE, size=size).triangulation
            assert found.points.tobytes() == expected.points.tobytes()
            assert found.triangles.tobytes() == expected.triangles.tobytes()

    def test_control_without_it_edges_are_longer(self) -> None:
        """The size left out."""
        assert longest_edge_squared(refine(PLATE).triangulation) > Fraction(0.75) ** 2

    @pytest.mark.parametrize("size", [0, -1.0, float("nan"), True, "0.5", np.ones(3)])
    def test_what_is_no_length_is_refused(self, size: float) -> None:
        with pytest.raises(OptionError, match="size="):
            refine(PLATE, size=size)

    @pytest.mark.parametrize(
        ("answer", "error"),
        [(0.0, OptionError), (float("nan"), OptionError), (True, ShapeError), (None, ShapeError), ([1.0], ShapeError)],
    )
    def test_what_a_function_must_not_return(self, answer: float, error: type[Exception]) -> None:
        with pytest.raises(error, match="size returned"):
            refine(PLATE, size=lambda _: answer)


class TestAdvice:
    """Law: what is refused for being points or rings is accepted as the message says."""

    @pytest.mark.parametrize("given", [CORNERS, np.array(CORNERS, dtype=float), [CORNERS, HOLE]])
    def test_points_and_rings(self, given: PSLG) -> None:
        with pytest.raises(ShapeError, match=r"refine\(delaunay\(points\)\).* refine\(PSLG\.from_rings\(rings\)\)"):
            refine(given)

    def test_the_advice_works(self) -> None:
        assert area(refine(delaunay(CORNERS)).triangulation) == 12
        assert area(refine(PSLG.from_rings([CORNERS, HOLE])).triangulation) == 11


class TestRefinements:
    """Law: a Refinement stands for its triangulation."""

    def test_it_is_refined_further(self) -> None:
        coarse = refine(PLATE)
        found, expected = refine(coarse, max_area=0.25), refine(coarse.triangulation, max_area=0.25)
        assert found.triangulation.triangles.tobytes() == expected.triangulation.triangles.tobytes()
        assert len(found.triangulation.triangles) > len(coarse.triangulation.triangles)

    def test_it_has_a_voronoi_diagram(self) -> None:
        done = refine(PLATE, conforming=True)
        cells = voronoi(done, clip="domain").clipped
        assert cells is not None
        assert sum(Fraction(int(a.numerator), int(a.denominator)) for a in map(cells.exact_area, cells.sites)) == 11

    def test_it_can_be_written(self, tmp_path: Path) -> None:
        done = refine(PLATE)
        names = [write(tmp_path / name, given) for name, given in (("a.node", done), ("b.node", done.triangulation))]
        assert len(names[0]) == len(names[1]) > 2
        for ours, expected in zip(*names, strict=True):
            assert Path(ours).read_bytes() == Path(expected).read_bytes().replace(b"b.", b"a.")

    @pytest.mark.parametrize("clip", [PLATE, "domain"])
    def test_control_what_clips_nothing_is_told(self, clip: str) -> None:
        with pytest.raises(ClipError, match="convex polygon"):
            lloyd(CORNERS, clip=clip)
        with pytest.raises(ClipError, match="conforming=True"):
            voronoi(CORNERS, clip=PLATE)  # type: ignore[arg-type]  # what an untyped caller passes
