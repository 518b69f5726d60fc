"""Pictures of meshes, by matplotlib (the extra ``plot``)."""

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

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["PICTURES", "PlotUnavailableError", "plot_mesh"]

#: The suffixes that :func:`plot_mesh` knows.
PICTURES = (".png", ".svg", ".pdf")

_INCHES = 8.0  # the longer side of the drawing
_DPI = 160
_SLIMMEST = 0.2  # of the longer side
_POINTS_DRAWN = 3000  # more of them would hide the mesh
_COLORS = "YlGnBu_r"
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
    place = os.fspath(path)
    suffix = os.path.splitext(place)[1].lower()
    if suffix not in PICTURES:
        raise FileFormatError(f"has the suffix {suffix!r}; pictures are {', '.join(PICTURES)}", path=place)
    mesh = Mesh(points, triangles=triangles, segments=segments)
    if not len(mesh.points):
        raise ExactMeshError("there are no points to draw")
    assert mesh.triangles is not None
    figure = _figure(mesh, mesh.triangles, title)
    picture = io.BytesIO()
    metadata = {".png": {}, ".svg": {"Date": None}, ".pdf": {"CreationDate": None}}[suffix]
    figure.savefig(picture, format=suffix[1:], dpi=_DPI, bbox_inches="tight", pad_inches=0.15, metadata=metadata)

    def write_to(stream: BinaryIO) -> None:
        stream.write(picture.getbuffer())

    write_whole({place: write_to})


def _figure(mesh: Mesh, triangles: IntArray, title: str | None) -> "Figure":
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise PlotUnavailableError(
            "pictures need matplotlib, which is not installed: pip install 'exactmesh[plot]'"
        ) from None
    points = mesh.points
    unit = np.ldexp(points, -int(np.frexp(np.abs(points).max())[1]))  # no difference overflows
    drawn = _in_unit_box(unit)
    width, height = np.maximum(np.ptp(drawn, axis=0), _SLIMMEST)
    figure = Figure(figsize=(_INCHES * width, _INCHES * height))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_aspect("equal")
    axes.set_axis_off()
    angles = angles_of(unit, triangles)
    _draw_triangles(axes, drawn, triangles, angles.min(axis=1, initial=60.0))
    if mesh.segments is not None:
        bold = float(np.clip(_BOLD * 30.0 / np.sqrt(max(len(mesh.segments), 1)), 0.3, _BOLD))
        _draw_lines(axes, drawn[mesh.segments], bold, _RED)
    if len(points) <= _POINTS_DRAWN:
        size = np.clip(2500.0 / len(points), 0.8, 22.0)
        axes.scatter(drawn[:, 0], drawn[:, 1], s=size, c=_INK, linewidths=0, zorder=3)
    axes.autoscale_view()
    _write_caption(figure, points, angles, title)
    return figure


def _in_unit_box(points: FloatArray) -> FloatArray:
    """Return the points moved and scaled so that the longer side of their box is 1."""
    near: FloatArray = points - points.min(axis=0)
    extent = near.max()
    return near / extent if extent > 0.0 else near


def _draw_triangles(axes: "Axes", drawn: FloatArray, triangles: IntArray, smallest: FloatArray) -> None:
    from matplotlib.collections import PolyCollection

    if not len(triangles):
        return
    # matplotlib is fast for (m, k, 2) arrays, though it is typed for sequences of arrays only
    faces = PolyCollection(
        drawn[triangles],  # type: ignore[arg-type]
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


def _draw_lines(axes: "Axes", lines: FloatArray, width: float, color: str) -> None:
    from matplotlib.collections import LineCollection

    axes.add_collection(LineCollection(lines, colors=color, linewidths=width))  # type: ignore[arg-type]  # as above


def _write_caption(figure: "Figure", points: FloatArray, angles: FloatArray, title: str | None) -> None:
    counts = f"{len(points):,} points, {len(angles):,} triangles"
    if len(angles):
        counts += f", angles {angles.min():.3g}° to {angles.max():.6g}° (colour: the smallest of each triangle)"
    text = counts if title is None else f"{title}\n{counts}"
    figure.text(0.5, -0.02, text, ha="center", va="top", color=_INK, fontsize=11, linespacing=1.6)
