"""Pictures of dictionaries, by matplotlib."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

from collections.abc import Mapping
from typing import TYPE_CHECKING, Protocol, cast

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray, IntArray
from exactmesh.errors import ChoiceError
from exactmesh.triangle.dictionary import KEYS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["Pyplot", "compare", "comparev", "plot"]

_INK, _EDGE, _SEGMENT, _HOLE, _REGION = "#1b2a35", "#5b7c93", "#c2452d", "#c2452d", "#2d6cc2"
_RAYS = ("ray_origins", "ray_directions")


class Pyplot(Protocol):
    """What is needed of ``matplotlib.pyplot``."""

    def figure(self, *, figsize: tuple[float, float]) -> Figure:
        """Return a new figure."""


def plot(ax: Axes, **tri: object) -> None:
    """Draw what is in a dictionary: vertices, triangles or edges, segments, holes, regions, attributes.

    ``ray_origins`` and ``ray_directions`` besides are rays from vertices, as :func:`voronoi` returns them.

    Raises:
        ChoiceError: a key that there is not, or no ``vertices``.

    >>> import matplotlib.pyplot as plt
    >>> from exactmesh import triangle
    >>> axes = plt.figure().add_subplot()
    >>> triangle.plot(axes, **triangle.triangulate(triangle.get_data("A"), "p"))
    >>> axes.get_aspect()
    1.0
    >>> plt.close()
    """
    unknown = [key for key in tri if key not in (*KEYS, *_RAYS)]
    if unknown or "vertices" not in tri:
        raise ChoiceError(f"{unknown[0]!r} cannot be drawn" if unknown else "there are no 'vertices' to draw")
    content = {key: np.asarray(cast(npt.ArrayLike, value)) for key, value in tri.items()}
    xy = content["vertices"].astype(np.float64)
    _draw_triangles(ax, xy, content)
    if "edges" in content and "triangles" not in content:
        _draw_lines(ax, xy[content["edges"]], _EDGE, 0.9)
    if "segments" in content:
        _draw_lines(ax, xy[content["segments"]], _SEGMENT, 1.6)
    if len(xy):
        ax.scatter(xy[:, 0], xy[:, 1], s=float(np.clip(1500.0 / len(xy), 1.0, 14.0)), c=_INK, linewidths=0, zorder=3)
    _draw_seeds(ax, content)
    ax.set_aspect("equal")
    ax.autoscale_view()
    if all(key in content for key in _RAYS) and len(xy):
        _draw_rays(ax, xy[content["ray_origins"]], content["ray_directions"].astype(np.float64))


def _draw_triangles(ax: Axes, xy: FloatArray, content: Mapping[str, npt.NDArray[np.generic]]) -> None:
    if "triangles" not in content:
        return
    triangles = cast(IntArray, content["triangles"][:, :3])
    sides = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    _draw_lines(ax, xy[sides], _EDGE, float(np.clip(40.0 / np.sqrt(len(sides)), 0.15, 0.9)))
    if "triangle_attributes" in content:
        centres = xy[triangles].mean(axis=1)
        for (x, y), value in zip(centres.tolist(), content["triangle_attributes"][:, 0].tolist(), strict=True):
            ax.text(x, y, f"{value:g}", color=_REGION, ha="center", va="center", fontsize=6)


def _draw_lines(ax: Axes, lines: FloatArray, color: str, width: float) -> None:
    from matplotlib.collections import LineCollection

    # matplotlib takes (k, 2, 2) arrays, though it is typed for sequences of arrays only
    ax.add_collection(LineCollection(lines, colors=color, linewidths=width))  # type: ignore[arg-type]  # as said


def _draw_seeds(ax: Axes, content: Mapping[str, npt.NDArray[np.generic]]) -> None:
    if "holes" in content:
        holes = content["holes"].astype(np.float64)
        ax.scatter(holes[:, 0], holes[:, 1], marker="x", c=_HOLE, s=36)
    for x, y, *label in content["regions"].tolist() if "regions" in content else ():
        ax.scatter([x], [y], marker="*", c=_REGION, s=30)
        ax.text(x, y, f" {label[0]:g}", color=_REGION)


def _draw_rays(ax: Axes, origins: FloatArray, directions: FloatArray) -> None:
    """Draw rays to beyond the picture, with some room around what is in it already."""
    ax.margins(0.25)
    ax.autoscale_view()
    left, right, bottom, top = ax.axis()
    lengths = np.hypot(*directions.T)
    reach = np.hypot(right - left, top - bottom) + np.abs(origins).max(initial=0.0)
    far = origins + directions / np.where(lengths > 0.0, lengths, 1.0)[:, None] * reach
    _draw_lines(ax, np.stack([origins, far], axis=1), _EDGE, 0.9)
    ax.axis((left, right, bottom, top))


def compare(
    plt: Pyplot, A: Mapping[str, object], B: Mapping[str, object], figsize: tuple[float, float] = (6, 3)
) -> None:
    """Draw two dictionaries side by side, in one scale, into a new figure of ``plt``.

    >>> import matplotlib.pyplot as plt
    >>> from exactmesh import triangle
    >>> star = triangle.get_data("A")
    >>> triangle.compare(plt, star, triangle.triangulate(star, "p"))
    >>> len(plt.gcf().axes)
    2
    >>> plt.close()
    """
    _pair(plt.figure(figsize=figsize), (1, 2), A, B)


def comparev(
    plt: Pyplot, A: Mapping[str, object], B: Mapping[str, object], figsize: tuple[float, float] = (3, 6)
) -> None:
    """Draw two dictionaries one above the other, in one scale, into a new figure of ``plt``."""
    _pair(plt.figure(figsize=figsize), (2, 1), A, B)


def _pair(figure: Figure, grid: tuple[int, int], A: Mapping[str, object], B: Mapping[str, object]) -> None:
    first = figure.add_subplot(*grid, 1)
    plot(first, **A)
    limits = first.axis()
    plot(figure.add_subplot(*grid, 2, sharex=first, sharey=first), **B)
    if any(key in B for key in _RAYS) and len(np.asarray(A["vertices"])):
        first.axis(limits)  # circumcentres may be far away
    figure.tight_layout()
