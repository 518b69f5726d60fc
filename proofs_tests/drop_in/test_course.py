"""The course's five calls, and the examples that come along."""

import os
import subprocess
import sys
import warnings
from pathlib import Path

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
import pytest

from exactmesh import ChoiceError, verify
from exactmesh.triangle import (
    TriangleDict,
    TriangleWarning,
    compare,
    comparev,
    get_data,
    plot,
    show_data,
    triangulate,
    voronoi,
)

pytestmark = pytest.mark.once


NAMES = [
    "A", "bbox", "box", "diamond_02_00009", "dots", "double_hex", "double_hex2", "double_hex3", "ell", "face",
    "polygon", "spiral", "square_circle_hole", "triangle",
]  # fmt: skip


def local(corners: npt.NDArray[np.float64], areas: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
    """Tell which triangles the course's function calls too large: it wants small ones near (0.1, 0.1)."""
    off = corners.mean(axis=1) - 0.1
    large: npt.NDArray[np.bool_] = areas > 0.001 * np.exp(50.0 * (off**2).sum(axis=1))
    return large


def call(name: str, switches: str) -> TriangleDict:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", TriangleWarning)  # v is for files
        return triangulate(get_data(name), switches + "ej", unsuitable=local if "u" in switches else None)


def counts(found: TriangleDict) -> tuple[int, int, int, int]:
    """Return how many vertices, triangles, edges, and edges on the boundary there are."""
    sides = np.sort(found["triangles"][:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    uses = np.unique(sides, axis=0, return_counts=True)[1]
    return len(found["vertices"]), len(found["triangles"]), len(found["edges"]), int((uses == 1).sum())


class TestFiveCalls:
    """The calls give what the course shows: the same counts where nothing is added, and else as few points, or about
    as few, as Triangle takes."""

    def test_without_new_vertices(self) -> None:
        assert counts(call("triangle", "")) == (3, 1, 3, 3)
        assert counts(call("polygon", "pv")) == (5, 4, 8, 4)

    @pytest.mark.parametrize(("switches", "most"), [("pvD", 12), ("pa0.1", 7), ("pa0.1u", 48)])
    def test_with(self, switches: str, most: int) -> None:
        found = call("polygon", switches)
        assert 5 < len(found["vertices"]) <= most
        claims = ["orientation", "admissible", "all_points_used", "segments_present", "constrained_delaunay"]
        report = verify(found["vertices"], found["triangles"], segments=found["segments"], claims=claims)
        assert report.ok, str(report)
        missing = np.array([*found["segments"].tolist(), (0, 3)])  # control: a segment that is divided, or no edge
        crossed = np.array([*found["segments"].tolist(), (1, 3)])
        reports = [verify(found["vertices"], found["triangles"], segments=s, claims=claims) for s in (missing, crossed)]
        assert not all(report.ok for report in reports)

    def test_bounds(self) -> None:
        found = call("polygon", "pa0.1u")
        corners = found["vertices"][found["triangles"]]
        (ux, uy), (vx, vy) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
        areas = (ux * vy - uy * vx) / 2
        assert areas.max() <= 0.1
        assert not local(corners, areas * 0.999).any()
        assert local(corners, areas * 30.0).any()  # control

    def test_conforming(self) -> None:
        """With D all circumcentres lie in the domain; without, one does not."""
        assert outside(call("polygon", "pvD")) == 0
        assert outside(call("polygon", "pv")) > 0  # control


def outside(found: TriangleDict) -> int:
    """Return how many circumcentres lie outside of the course's polygon."""
    points, corners = found["vertices"], found["triangles"]
    a, b, c = (points[corners[:, i]] for i in range(3))
    u, v = b - a, c - a
    d = 2.0 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    uu, vv = (u**2).sum(axis=1), (v**2).sum(axis=1)
    x = a[:, 0] + (v[:, 1] * uu - u[:, 1] * vv) / d
    y = a[:, 1] + (u[:, 0] * vv - v[:, 0] * uu) / d
    slack = 1e-12
    below = (1.5 * y + x <= 1.0 + slack) | (
        1.5 * x + y <= 1.0 + slack
    )  # two sides of the notch: the polygon is their union
    inside = (x >= -slack) & (y >= -slack) & below
    return int((~inside).sum())


class TestExamples:
    """Each example is what it says: it can be triangulated, as one of the package's own can, and refined."""

    @pytest.mark.parametrize("name", NAMES)
    def test_triangulates(self, name: str) -> None:
        content = get_data(name)
        switches = "p" if "segments" in content else "r" if "triangles" in content else ""
        found = triangulate(content, switches + "C")
        assert len(found["triangles"]) > 0
        assert np.array_equal(found["vertices"], content["vertices"])
        assert len(triangulate(content, switches + "q25")["triangles"]) >= len(found["triangles"])
        if "holes" in content:
            assert len(triangulate(content, "pO")["triangles"]) > len(found["triangles"])

    def test_no_such_example(self) -> None:
        with pytest.raises(ChoiceError, match="'nope'"):
            get_data("nope")
        for name in ("la", "greenland", "la.1"):
            with pytest.raises(ChoiceError, match="not free"):
                get_data(name)

    def test_a_fresh_copy_each_time(self) -> None:
        get_data("A")["vertices"][:] = 0.0
        assert get_data("A")["vertices"].any()


@pytest.fixture
def agg() -> None:
    mpl.use("Agg")


@pytest.mark.usefixtures("agg")
class TestPictures:
    """plot draws what is in a dictionary; compare and comparev draw two, in one scale."""

    def test_all_kinds(self) -> None:
        from matplotlib import pyplot as plt

        axes = plt.figure().add_subplot()
        content = {**get_data("A"), "regions": np.array([(0.1, 0.05, 3.0, -1.0)])}
        plot(axes, **triangulate(content, "pA"))
        assert {text.get_text() for text in axes.texts} == {"3", " 3"}
        assert len(axes.collections) == 5  # edges, segments, vertices, a hole, a region
        plain = plt.figure().add_subplot()
        plot(plain, vertices=content["vertices"])
        assert len(plain.collections) == 1  # control
        with pytest.raises(ChoiceError, match="'foo'"):
            plot(plain, vertices=[(0, 0)], foo=1)
        with pytest.raises(ChoiceError, match="'vertices'"):
            plot(plain, segments=[(0, 1)])
        plt.close("all")

    def test_rays_leave_the_picture(self) -> None:
        from matplotlib import pyplot as plt

        axes = plt.figure().add_subplot()
        centres, edges, origins, directions = voronoi([(0, 0), (4, 0), (0, 4)])
        plot(axes, vertices=centres, edges=edges, ray_origins=origins, ray_directions=directions)
        left, right, bottom, top = axes.axis()
        (rays,) = [c for c in axes.collections if len(c.get_paths()) == 3]
        for path in rays.get_paths():
            x, y = np.asarray(path.vertices, dtype=np.float64)[1].tolist()
            assert not (left < x < right and bottom < y < top)
        plt.close("all")

    def test_comparisons(self, monkeypatch: pytest.MonkeyPatch) -> None:
        from matplotlib import pyplot as plt

        box = get_data("box")
        far = {"vertices": [(0.5, -1e6)], "ray_origins": [0], "ray_directions": [(0.0, 1.0)]}
        comparev(plt, get_data("dots"), far)
        assert all(-1.0 < end < 2.0 for axes in plt.gcf().axes for end in axes.axis())  # the input fills the picture
        for function, wide in ((compare, True), (comparev, False)):
            function(plt, box, triangulate(box, "pq"))
            first, second = plt.gcf().axes
            assert first.get_xlim() == second.get_xlim()
            width, height = plt.gcf().get_size_inches()
            assert bool(width > height) is wide
        shown: list[bool] = []
        monkeypatch.setattr(plt, "show", lambda: shown.append(True))
        show_data("face")
        assert shown == [True]
        plt.close("all")

    def test_nothing_needs_matplotlib_but_pictures(self, tmp_path: Path) -> None:
        code = "import sys; sys.modules['matplotlib'] = None; import exactmesh.triangle as t; t.get_data('A')"
        subprocess.run([sys.executable, "-c", code], cwd=tmp_path, check=True, env=os.environ.copy())
