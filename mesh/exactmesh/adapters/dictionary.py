"""Triangle's dictionaries, of exactmesh.triangle and of the package that it stands in for."""

from collections.abc import Mapping
from typing import cast

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import exact_doubles, finite_points
from exactkernel.errors import ShapeError
from exactkernel.types import FloatArray
from exactmesh.adapters.given import GivenMesh, index_rows
from exactmesh.adapters.own import domain_by_seeds
from exactmesh.errors import AdapterError

__all__ = ["WORDS", "accepts", "convert"]

WORDS = "dictionaries with 'vertices' and 'triangles', as Triangle's"


def accepts(mesh: object) -> bool:
    """Tell whether it is a mapping with vertices."""
    return isinstance(mesh, Mapping) and "vertices" in mesh


def convert(mesh: object) -> GivenMesh:
    """Return vertices and triangles (their corners, where there are six nodes). Segments, holes and regions are the
    domain; labels are the attributes of triangles, where there are regions."""
    content = cast("Mapping[str, npt.ArrayLike]", mesh)
    points = exact_doubles(content["vertices"], "vertices")
    if content.get("triangles") is None:
        raise AdapterError("the dictionary has no 'triangles'")
    triangles = index_rows(content["triangles"], 3, "triangles")
    segments = index_rows(content.get("segments", ()), 2, "segments")
    if not len(segments):
        return GivenMesh(points, triangles, source="a dictionary of triangle")
    regions = _regions(content)
    attributes = np.asarray(content.get("triangle_attributes", ()))
    return GivenMesh(
        points,
        triangles,
        labels=attributes.reshape(len(triangles), -1)[:, -1] if len(regions) and attributes.size else None,
        domain=domain_by_seeds(
            points, segments.astype(np.int64), finite_points(content.get("holes", ()), "holes"), regions
        ),
        source="a dictionary of triangle",
    )


def _regions(content: Mapping[str, npt.ArrayLike]) -> FloatArray:
    regions = np.asarray(content.get("regions", ()), dtype=np.float64)
    if not regions.size:
        return np.empty((0, 4))
    if regions.ndim != 2 or regions.shape[1] < 3:
        raise ShapeError(f"regions has shape {regions.shape}; expected (r, 4): x, y, attribute, area")
    return regions
