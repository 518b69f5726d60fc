"""Triangle's dictionaries, of exactmesh.triangle and of the package that it stands in for."""

from collections.abc import Mapping
from typing import cast

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import exact_doubles, finite_points
from exactkernel.errors import ShapeError
from exactkernel.types import FloatArray
from exactmesh.adapters.given import GivenMesh, Indices, array_of, index_rows
from exactmesh.adapters.own import domain_by_seeds
from exactmesh.errors import AdapterError

__all__ = ["WORDS", "accepts", "convert"]

_WITH_MIDDLES = 6  # corners, and a node on each side

WORDS = "dictionaries with 'vertices' and 'triangles', as Triangle's"


def accepts(mesh: object) -> bool:
    """Tell whether it is a mapping with vertices."""
    return isinstance(mesh, Mapping) and "vertices" in mesh


def convert(mesh: object) -> GivenMesh:
    """Return vertices and triangles; where these have six nodes, their corners, without vertices that are only nodes on
    sides. Segments, holes and regions are the domain; labels are the attributes of triangles, where there are regions.
    """
    content = cast("Mapping[str, npt.ArrayLike]", mesh)
    points = exact_doubles(content["vertices"], "vertices")
    if content.get("triangles") is None:
        raise AdapterError("the dictionary has no 'triangles'")
    triangles = index_rows(content["triangles"], 3, "triangles", nodes=_WITH_MIDDLES)
    segments = index_rows(content.get("segments", ()), 2, "segments")
    if np.shape(content["triangles"])[-1] == _WITH_MIDDLES:
        points, triangles, segments = _without_middles(points, np.asarray(content["triangles"]), segments)
    if not len(segments):
        return GivenMesh(points, triangles, source="a dictionary of triangle")
    regions = _regions(content)
    return GivenMesh(
        points,
        triangles,
        labels=_labels(content, len(triangles)) if len(regions) else None,
        domain=domain_by_seeds(
            points, segments.astype(np.int64), finite_points(content.get("holes", ()), "holes"), regions
        ),
        source="a dictionary of triangle",
    )


def _without_middles(points: FloatArray, nodes: Indices, segments: Indices) -> tuple[FloatArray, Indices, Indices]:
    """Leave out vertices that are nodes on sides, and neither corners nor ends of segments."""
    corners, middles = nodes[:, :3], nodes[:, 3:]
    dropped = np.setdiff1d(middles, np.union1d(corners, segments))
    kept = np.setdiff1d(np.arange(len(points)), dropped)
    if not len(kept) or any(
        rows.size and (rows.min() < 0 or rows.max() >= len(points)) for rows in (corners, segments)
    ):
        return points, corners, segments  # what is wrong with the numbers will be said
    number = np.searchsorted(kept, np.arange(len(points)))
    return points[kept], number[corners], number[segments]


def _labels(content: Mapping[str, npt.ArrayLike], m: int) -> FloatArray | None:
    """Return the last attribute of each triangle, if there are attributes."""
    attributes = _numbers(content, "triangle_attributes")
    if not attributes.size:
        return None
    if len(attributes) != m or attributes.ndim > 2:
        raise ShapeError(f"triangle_attributes has shape {attributes.shape}; expected a row for each of {m} triangles")
    return attributes.reshape(m, -1)[:, -1]


def _regions(content: Mapping[str, npt.ArrayLike]) -> FloatArray:
    regions = _numbers(content, "regions")
    if not regions.size:
        return np.empty((0, 4))
    if regions.ndim != 2 or regions.shape[1] < 3:
        raise ShapeError(f"regions has shape {regions.shape}; expected (r, 4): x, y, attribute, area")
    return regions


def _numbers(content: Mapping[str, npt.ArrayLike], name: str) -> FloatArray:
    array = array_of(content.get(name, ()), name)
    if array.size and array.dtype.kind not in "iuf":
        raise ShapeError(f"{name} has dtype {array.dtype}; expected numbers")
    return array.astype(np.float64)
