"""Pictures show every triangle in proportion, for any finite coordinates."""

import sys
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from exactmesh.demo import course_points, mosaic
from exactmesh.errors import ExactMeshError, FileFormatError, TopologyError
from exactmesh.plot import PICTURES, PlotUnavailableError, plot_mesh

pytestmark = pytest.mark.once


SQUARE = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
HALVES = np.array([(0, 1, 2), (0, 2, 3)])


def painted(path: Path) -> float:
    """The share of the picture that is not white."""
    return float((imread(path)[..., :3].min(axis=2) < 0.999).mean())


class TestTheMeshIsSeen:
    """What is drawn is there: leaving a triangle out leaves its part of the picture white."""

    def test_area_is_painted(self, tmp_path: Path) -> None:
        plot_mesh(SQUARE, HALVES, tmp_path / "all.png")
        plot_mesh(SQUARE, HALVES[:1], tmp_path / "half.png")
        plot_mesh(SQUARE, HALVES[:0], tmp_path / "none.png")
        shares = [painted(tmp_path / f"{name}.png") for name in ("all", "half", "none")]
        assert shares[0] > 0.6
        assert 0.4 * shares[0] < shares[1] < 0.7 * shares[0]
        assert 0.0 < shares[2] < 0.1

    @pytest.mark.parametrize("scale", [5e-324, 1e-308, 1.0, 1.7e308])
    def test_any_size_of_coordinates(self, tmp_path: Path, scale: float) -> None:
        plot_mesh(SQUARE * scale, HALVES, tmp_path / "m.png")
        assert painted(tmp_path / "m.png") > 0.6

    def test_in_proportion(self, tmp_path: Path) -> None:
        plot_mesh(SQUARE * (2.0, 1.0), HALVES, tmp_path / "m.png")
        dark = (imread(tmp_path / "m.png")[..., :3].max(axis=2) < 0.35).nonzero()
        rows = np.unique(dark[0])
        caption = rows[1:][np.diff(rows) > 20].min()  # white lies between
        drawn = dark[0] < caption
        assert 1.95 < np.ptp(dark[1][drawn]) / np.ptp(dark[0][drawn]) < 2.05

    @pytest.mark.parametrize("suffix", PICTURES)
    def test_formats(self, tmp_path: Path, suffix: str) -> None:
        plot_mesh(SQUARE, HALVES, tmp_path / f"m{suffix}", title="a square")
        start = {".png": b"\x89PNG", ".svg": b"<?xml", ".pdf": b"%PDF"}[suffix]
        assert (tmp_path / f"m{suffix}").read_bytes().startswith(start)


class TestBadInput:
    """What cannot be drawn is refused by name, and no file is left."""

    def test_refused(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        with pytest.raises(FileFormatError, match=r"suffix '\.bmp'"):
            plot_mesh(SQUARE, HALVES, tmp_path / "m.bmp")
        with pytest.raises(TopologyError, match=r"triangles\[1\]"):
            plot_mesh(SQUARE, [(0, 1, 2), (0, 2, 4)], tmp_path / "m.png")
        with pytest.raises(ExactMeshError, match="no points"):
            plot_mesh(np.zeros((0, 2)), np.zeros((0, 3), dtype=int), tmp_path / "m.png")
        monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
        with pytest.raises(PlotUnavailableError, match=r"pip install 'exactmesh\[plot\]'"):
            plot_mesh(SQUARE, HALVES, tmp_path / "m.png")
        assert list(tmp_path.iterdir()) == []


class TestTheDemonstrationIsHard:
    """The built-in points are distinct, the same in every run, and defeat a mesher that rounds."""

    def test_points(self) -> None:
        assert len(np.unique(mosaic(), axis=0)) == len(mosaic())
        assert np.array_equal(mosaic(), mosaic())
        assert course_points().tolist() == [[0, 0], [1, 0], [0.4, 0.4], [0, 1], [0.2, 0.3]]

    def test_scipy_gets_it_wrong(self) -> None:
        from scipy.spatial import Delaunay

        from exactmesh.delaunay import delaunay
        from exactmesh.verify import verify

        theirs, ours = Delaunay(mosaic()), delaunay(mosaic())
        assert not verify(theirs.points, theirs.simplices, orientation="any").ok
        assert verify(ours.points, ours.triangles).ok
