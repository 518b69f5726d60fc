"""Pictures of meshes, by matplotlib (the extra ``plot``)."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

import io
import os
from typing import TYPE_CHECKING, BinaryIO

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray, IntArray
from exactmesh.errors import ExactMeshError, FileFormatError
from exactmesh.io.atomic import write_whole
from exactmesh.io.model import Mesh
from exactmesh.quality import angles_of
from exactmesh.voronoi import Cells, Voronoi, voronoi

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["PICTURES", "PlotUnavailableError", "plot_mesh", "plot_voronoi"]

#: The suffixes that the functions here know.
PICTURES = (".png", ".svg", ".pdf")

_INCHES = 8.0  # the longer side of the drawing
_DPI = 160
_SLIMMEST = 0.2  # of the longer side
_POINTS_DRAWN = 3000  # more of them would hide the mesh
_COLORS = "YlGnBu_r"
_CELL_COLORS = "YlGnBu"
_MARGIN = 0.12  # around the sites of a diagram that is not clipped
_LARGEST_SITE = 2.0**1022
_INK = "#1b2a41"
_RED = "#c1121f"
_BOLD = 1.6


class PlotUnavailableError(ExactMeshError, ImportError):
    """matplotlib, which draws the pictures, is not installed."""


def plot_mesh(
    points: npt.ArrayLike,
    triangles: npt.ArrayLike,
    path: str | os.PathLike[str],
    *,
    segments: npt.ArrayLike | None = None,
    title: str | None = None,
) -> None:
    """Draw a mesh into a picture: triangles by their smallest angle, segments bold, points when they are few.

    The picture is in proportion, without axes; below it stand the title and the counts. Linear time; 100,000 triangles
    take some seconds. Any finite coordinates can be drawn.

    Args:
        points: (n, 2), n > 0.
        triangles: (m, 3), indices into ``points``; of either orientation.
        path: ``.png``, ``.svg`` or ``.pdf``.
        segments: (s, 2), indices into ``points``: the constrained edges.
        title: the first line of the caption.

    Raises:
        PlotUnavailableError: matplotlib is not installed; the message says how to get it.
        FileFormatError: another suffix.
        ExactMeshError: points or triangles that are none, see :class:`exactmesh.io.Mesh`.
        OSError: the picture cannot be written.
    """
    place, suffix = _place_of(path)
    mesh = Mesh(points, triangles=triangles, segments=segments)
    if not len(mesh.points):
        raise ExactMeshError("there are no points to draw")
    assert mesh.triangles is not None
    _save(_figure(mesh, mesh.triangles, title), place, suffix)


def plot_voronoi(diagram: Voronoi, path: str | os.PathLike[str], *, title: str | None = None) -> None:
    """Draw a Voronoi diagram over its Delaunay triangulation: cells by their area, sites when they are few.

    What is drawn is what the diagram is clipped to; if it is not, a box around its sites, somewhat larger.

    Args:
        diagram: of sites whose coordinates are at most a quarter of the largest double.
        path: ``.png``, ``.svg`` or ``.pdf``.
        title: the first line of the caption.

    Raises:
        PlotUnavailableError, FileFormatError, OSError: as for :func:`plot_mesh`.
        ExactMeshError: the sites are too large.
    """
    place, suffix = _place_of(path)
    cells = diagram.clipped
    if cells is None:
        if np.abs(diagram.points).max() > _LARGEST_SITE:
            raise ExactMeshError("a box around these sites leaves the doubles: clip the diagram, or scale it")
        low, high = diagram.points.min(axis=0), diagram.points.max(axis=0)
        margin = max(_MARGIN * float((high - low).max()), float(np.spacing(np.abs(diagram.points).max())))
        cells = voronoi(diagram.points, clip=np.concatenate([low - margin, high + margin])).clipped
        assert cells is not None
    _save(_voronoi_figure(diagram, cells, title), place, suffix)


def _place_of(path: str | os.PathLike[str]) -> tuple[str, str]:
    place = os.fspath(path)
    suffix = os.path.splitext(place)[1].lower()
    if suffix not in PICTURES:
        raise FileFormatError(f"has the suffix {suffix!r}; pictures are {', '.join(PICTURES)}", path=place)
    return place, suffix


def _save(figure: Figure, place: str, suffix: str) -> None:
    picture = io.BytesIO()
    metadata = {".png": {}, ".svg": {"Date": None}, ".pdf": {"CreationDate": None}}[suffix]
    figure.savefig(picture, format=suffix[1:], dpi=_DPI, bbox_inches="tight", pad_inches=0.15, metadata=metadata)

    def write_to(stream: BinaryIO) -> None:
        stream.write(picture.getbuffer())

    write_whole({place: write_to})


def _canvas(drawn: FloatArray) -> tuple[Figure, Axes]:
    """Return an empty figure for what fills that part of the unit square."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise PlotUnavailableError(
            "pictures need matplotlib, which is not installed: pip install 'exactmesh[plot]'"
        ) from None
    width, height = np.maximum(np.ptp(drawn, axis=0), _SLIMMEST)
    figure = Figure(figsize=(_INCHES * width, _INCHES * height))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_aspect("equal")
    axes.set_axis_off()
    return figure, axes


def _figure(mesh: Mesh, triangles: IntArray, title: str | None) -> Figure:
    points = mesh.points
    unit = np.ldexp(points, -int(np.frexp(np.abs(points).max())[1]))  # no difference overflows
    drawn = _in_unit_box(unit)
    figure, axes = _canvas(drawn)
    angles = angles_of(unit, triangles)
    _draw_triangles(axes, drawn, triangles, angles.min(axis=1, initial=60.0))
    if mesh.segments is not None:
        bold = float(np.clip(_BOLD * 30.0 / np.sqrt(max(len(mesh.segments), 1)), 0.3, _BOLD))
        _draw_lines(axes, drawn[mesh.segments], bold, _RED)
    _draw_points(axes, drawn)
    axes.autoscale_view()
    _write_caption(figure, points, angles, title)
    return figure


def _voronoi_figure(diagram: Voronoi, cells: Cells, title: str | None) -> Figure:
    exponent = -int(np.frexp(np.abs(cells.corners).max(initial=0.0))[1])
    corners, sites = np.ldexp(cells.corners, exponent), np.ldexp(diagram.points, exponent)
    low = corners.min(axis=0)
    extent = float((corners - low).max())
    drawn, sites = (corners - low) / extent, (sites - low) / extent
    figure, axes = _canvas(drawn)
    top = drawn.max(axis=0)
    axes.set_xlim(0.0, top[0])
    axes.set_ylim(0.0, top[1])
    _draw_cells(axes, drawn, cells)
    if diagram.triangulation is not None:
        edges = diagram.triangulation.edges
        _draw_lines(axes, sites[edges], float(np.clip(25.0 / np.sqrt(len(edges)), 0.08, 0.7)), _INK)
    _draw_points(axes, sites)
    counts = f"{len(diagram.points):,} sites, {len(diagram.vertices):,} vertices, {len(diagram.ends):,} ridges"
    _write(figure, f"{counts} (colour: the area of each cell)", title)
    return figure


def _draw_cells(axes: Axes, drawn: FloatArray, cells: Cells) -> None:
    from matplotlib.collections import PolyCollection

    polygons = np.split(drawn, cells.offsets[1:-1])
    width = float(np.clip(60.0 / np.sqrt(len(polygons)), 0.1, 1.4))
    following = np.arange(1, len(drawn) + 1)
    following[cells.offsets[1:] - 1] = cells.offsets[:-1]
    across = drawn[:, 0] * drawn[following, 1] - drawn[:, 1] * drawn[following, 0]
    areas = np.add.reduceat(across, cells.offsets[:-1])
    axes.add_collection(
        PolyCollection(polygons, array=areas, cmap=_CELL_COLORS, edgecolors=_RED, linewidths=width, alpha=0.85)
    )


def _draw_points(axes: Axes, drawn: FloatArray) -> None:
    if len(drawn) <= _POINTS_DRAWN:
        size = np.clip(2500.0 / len(drawn), 0.8, 22.0)
        axes.scatter(drawn[:, 0], drawn[:, 1], s=size, c=_INK, linewidths=0, zorder=3)


def _in_unit_box(points: FloatArray) -> FloatArray:
    """Return the points moved and scaled so that the longer side of their box is 1."""
    near: FloatArray = points - points.min(axis=0)
    extent = near.max()
    return near / extent if extent > 0.0 else near


def _draw_triangles(axes: Axes, drawn: FloatArray, triangles: IntArray, smallest: FloatArray) -> None:
    from matplotlib.collections import PolyCollection

    if not len(triangles):
        return
    # matplotlib is fast for (m, k, 2) arrays, though it is typed for sequences of arrays only
    faces = PolyCollection(
        drawn[triangles],  # type: ignore[arg-type]  # see above
        array=smallest,
        cmap=_COLORS,
        linewidths=0,
        alpha=0.75,
    )
    faces.set_clim(0.0, 60.0)
    axes.add_collection(faces)
    edges, uses = np.unique(
        np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0, return_counts=True
    )
    thin = float(np.clip(40.0 / np.sqrt(len(edges)), 0.08, 0.9))
    for shown, width in ((edges, thin), (edges[uses == 1], max(2.0 * thin, 0.7))):
        _draw_lines(axes, drawn[shown], width, _INK)


def _draw_lines(axes: Axes, lines: FloatArray, width: float, color: str) -> None:
    from matplotlib.collections import LineCollection

    axes.add_collection(LineCollection(lines, colors=color, linewidths=width))  # type: ignore[arg-type]  # as above


def _write_caption(figure: Figure, points: FloatArray, angles: FloatArray, title: str | None) -> None:
    counts = f"{len(points):,} points, {len(angles):,} triangles"
    if len(angles):
        counts += f", angles {angles.min():.3g}° to {angles.max():.6g}° (colour: the smallest of each triangle)"
    _write(figure, counts, title)


def _write(figure: Figure, counts: str, title: str | None) -> None:
    text = counts if title is None else f"{title}\n{counts}"
    figure.text(0.5, -0.02, text, ha="center", va="top", color=_INK, fontsize=11, linespacing=1.6)
