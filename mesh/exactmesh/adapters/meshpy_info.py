"""meshpy's MeshInfo, which its wrapper of Triangle returns."""

from typing import Any

import numpy as np

from exactkernel.arrays import exact_doubles
from exactmesh.adapters.given import GivenMesh, index_rows, is_a
from exactmesh.adapters.own import domain_by_seeds
from exactmesh.errors import AdapterError
from exactmesh.verify.properties import ADMISSIBLE_MESH, Property

__all__ = ["WORDS", "accepts", "convert"]

WORDS = "meshpy's MeshInfo"


def accepts(mesh: object) -> bool:
    """Tell whether it is one of meshpy."""
    return is_a(mesh, "meshpy", "MeshInfo", "MeshInfoBase")


def convert(mesh: object) -> GivenMesh:
    """Return points and elements. With holes, they and the facets are the domain; but what meshpy returns has lost its
    holes. Then the facets are segments, of which it is not claimed that they bound what is covered."""
    found: Any = mesh  # a C++ class without stubs
    points = np.array(found.points, dtype=np.float64)
    if points.size and points.shape[1] != 2:
        raise AdapterError(f"the meshpy MeshInfo has {points.shape[1]} dimensions; meshes are planar")
    triangles, facets = (np.array(rows, dtype=np.int64) for rows in (found.elements, found.facets))
    if not triangles.size:
        raise AdapterError("the meshpy MeshInfo has no elements: give what meshpy.triangle.build returns")
    holes = np.array(found.holes, dtype=np.float64).reshape(-1, 2)
    segments = index_rows(facets, 2, "facets").astype(np.int32)
    known = bool(len(holes) and len(segments))
    return GivenMesh(
        exact_doubles(points),
        index_rows(triangles, 3, "elements"),
        segments=segments if len(segments) and not known else None,
        domain=domain_by_seeds(points, segments, holes, None) if known else None,
        claims=(*ADMISSIBLE_MESH, Property.CONSTRAINED_DELAUNAY) if len(segments) and not known else None,
        source="a meshpy MeshInfo",
    )
