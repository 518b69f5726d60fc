"""Examples to try things on, each made by a few lines: none of them is a file of the ``triangle`` package."""

from collections.abc import Callable
from typing import cast

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray
from exactmesh.errors import ChoiceError
from exactmesh.triangle.dictionary import TriangleDict

__all__ = ["get_data", "show_data"]

_NOT_FREE = ("greenland", "la")


def get_data(name: str) -> TriangleDict:
    """Return an example of the library's own; names are those of the ``triangle`` package, shapes are alike.

    ``triangle`` and ``polygon`` are the inputs of the course. All else: ``A``, ``bbox``, ``box``,
    ``diamond_02_00009``, ``dots``, ``double_hex``, ``double_hex2``, ``double_hex3``, ``ell``, ``face``, ``spiral``,
    ``square_circle_hole``.

    Raises:
        ChoiceError: there is no such example; or it is a map that only the package has, and that is not free.

    >>> from exactmesh import triangle
    >>> sorted(triangle.get_data("polygon"))
    ['segment_markers', 'segments', 'vertices']
    """
    if name.split(".")[0] in _NOT_FREE:
        raise ChoiceError(f"{name!r} is data of the triangle package, which is not free; load() reads your copy of it")
    stem, _, result = name.partition(".")
    if result and stem in _MAKERS:
        made_by = f"triangulate(get_data({stem!r}), ...) makes such a one"
        raise ChoiceError(f"{name!r} is a result that the triangle package keeps as a file; {made_by}")
    if name not in _MAKERS:
        raise ChoiceError(f"there is no example {name!r}; there are {', '.join(sorted(_MAKERS))}")
    made = _MAKERS[name]()
    return cast(TriangleDict, {key: _typed(key, np.asarray(value)) for key, value in made.items()})


def show_data(name: str) -> None:
    """Show an example in a window, or wherever matplotlib shows figures."""
    from matplotlib import pyplot

    from exactmesh.triangle.plot import plot

    axes = pyplot.figure().add_subplot()
    plot(axes, **get_data(name))
    axes.set_title(name)
    pyplot.show()


Content = dict[str, npt.ArrayLike]


def _typed(key: str, array: npt.NDArray[np.generic]) -> npt.NDArray[np.generic]:
    is_integer = key in ("triangles", "segments") or key.endswith("_markers")
    return array.astype(np.int32 if is_integer else np.float64)


def _ring(count: int, first: int) -> list[tuple[int, int]]:
    """Return the segments of a closed polygon of vertices first, first + 1, and so on."""
    return [(first + k, first + (k + 1) % count) for k in range(count)]


def _rings(*rings: FloatArray, holes: npt.ArrayLike = (), markers: bool = True) -> Content:
    """Return a graph of closed polygons; the segments of the i-th have the marker i + 1."""
    firsts = np.cumsum([0, *map(len, rings)]).tolist()
    segments = [pair for ring, first in zip(rings, firsts, strict=False) for pair in _ring(len(ring), first)]
    content: Content = {"vertices": np.concatenate(rings), "segments": segments}
    if markers:
        column = np.repeat(np.arange(1, len(rings) + 1), [len(ring) for ring in rings])[:, None]
        content |= {"vertex_markers": column, "segment_markers": column}
    return content | ({"holes": holes} if np.size(np.asarray(holes)) else {})


def _circle(count: int, centre: tuple[float, float], radius: float, turn: float = 0.0) -> FloatArray:
    angles = turn + 2.0 * np.pi * np.arange(count) / count
    return np.stack([centre[0] + radius * np.cos(angles), centre[1] + radius * np.sin(angles)], axis=1)


def _box(low: float, high: float) -> FloatArray:
    return np.array([(low, low), (high, low), (high, high), (low, high)])


def _divided(ring: FloatArray, parts: int) -> FloatArray:
    """Return a polygon with each side divided into equal parts."""
    steps = np.arange(parts)[None, :, None] / parts
    divided: FloatArray = (ring[:, None] + steps * (np.roll(ring, -1, axis=0) - ring)[:, None]).reshape(-1, 2)
    return divided


def _grid(columns: int, rows: int) -> tuple[FloatArray, npt.NDArray[np.int64]]:
    """Return the vertices and triangles of a grid of unit squares, each divided in two."""
    y, x = np.divmod(np.arange((columns + 1) * (rows + 1)), columns + 1)
    corner = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).reshape(-1, 1)
    turns = np.array([(0, 1, columns + 2), (0, columns + 2, columns + 1)])
    return np.stack([x, y], axis=1).astype(np.float64), (corner[:, None] + turns).reshape(-1, 3)


def _triangle() -> Content:
    return {"vertices": [(0, 0), (1, 0), (0, 1)]}


def _polygon() -> Content:
    return {
        "vertices": [(0, 0), (1, 0), (0.4, 0.4), (0, 1), (0.2, 0.3)],
        "segments": _ring(4, 0),
        "segment_markers": [[1], [2], [3], [4]],
    }


def _letter() -> Content:
    """An A: its outline, and the hole above the bar."""
    outline = [(0, 0), (2, 0), (3, 3), (5, 3), (6, 0), (8, 0), (5, 10), (3, 10)]
    counter = [(3.5, 4.5), (4.5, 4.5), (4, 6.5)]
    content = _rings(np.array(outline) / 10.0, np.array(counter) / 10.0, holes=[(0.4, 0.5)], markers=False)
    return content | {"vertex_attributes": np.asarray(content["vertices"])[:, 1:]}


def _bbox() -> Content:
    """A box that is triangulated, to be refined where its areas say so, by ``ra``."""
    vertices, triangles = _grid(2, 2)
    areas = 0.5 / 2.0 ** np.arange(len(triangles))[:, None]
    return {"vertices": vertices, "triangles": triangles, "triangle_max_area": areas}


def _diamond() -> Content:
    x, y = np.divmod(np.arange(9), 3)
    return {"vertices": np.stack([x - y, x + y - 2], axis=1) / 2.0}


def _dots() -> Content:
    k = np.arange(1, 101)
    plastic = 1.32471795724474602596  # spreads points evenly: its powers make the least regular fractions of the plane
    return {"vertices": np.stack([k / plastic % 1.0, k / plastic**2 % 1.0], axis=1)}


def _hexagons(parts: int) -> Callable[[], Content]:
    def make() -> Content:
        hexagons = [_circle(6, (x, 0.5), 0.15) for x in (0.25, 0.75)]
        rings = [_divided(ring, parts) for ring in (_box(0.0, 1.0), *hexagons)]
        return _rings(*rings, holes=[(0.25, 0.5), (0.75, 0.5)])

    return make


def _ell() -> Content:
    vertices, triangles = _grid(4, 4)
    inside = (vertices[triangles].mean(axis=1) < 2.0).any(axis=1)
    used, corners = np.unique(triangles[inside], return_inverse=True)
    return {"vertices": vertices[used], "triangles": corners.reshape(-1, 3)}


def _face() -> Content:
    eyes = [_circle(6, (x, 0.65), 0.09) for x in (0.3, 0.7)]
    mouth = np.array([(0.25, 0.35), (0.5, 0.2), (0.75, 0.35), (0.5, 0.28)])
    holes = [(0.3, 0.65), (0.7, 0.65), (0.5, 0.24)]
    return _rings(_circle(10, (0.5, 0.5), 0.5), *eyes, mouth, holes=holes)


def _spiral() -> Content:
    k = np.arange(15)
    angle = 0.6 * k
    return {"vertices": np.stack([(1.0 + k) * np.cos(angle), (1.0 + k) * np.sin(angle)], axis=1) / 15.0}


_MAKERS: dict[str, Callable[[], Content]] = {
    "A": _letter,
    "bbox": _bbox,
    "box": lambda: _rings(_box(0.0, 3.0), _box(1.0, 2.0), holes=[(1.5, 1.5)]),
    "diamond_02_00009": _diamond,
    "dots": _dots,
    "double_hex": _hexagons(6),
    "double_hex2": _hexagons(3),
    "double_hex3": _hexagons(1),
    "ell": _ell,
    "face": _face,
    "polygon": _polygon,
    "spiral": _spiral,
    "square_circle_hole": lambda: _rings(_box(-2.0, 2.0), _circle(64, (0.0, 0.0), 1.0), holes=[(0.0, 0.0)]),
    "triangle": _triangle,
}
