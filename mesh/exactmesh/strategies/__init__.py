"""Hypothesis strategies for what breaks geometry code: points, graphs, triangulations, edge structures.

Needs the extra ``hypothesis``. Every strategy takes ``min_size`` and ``max_size``, shrinks towards few items with small
integers as coordinates, and draws few choices, so that a thousand sets of fifty points take a second or two.

>>> from hypothesis import given, settings
>>> from exactmesh import delaunay, verify
>>> from exactmesh.strategies import tilted_grid_points
>>> @settings(max_examples=20, deadline=None)  # the first call may compile
... @given(tilted_grid_points(min_size=4, max_size=9))
... def test_mesher(points):
...     mesh = delaunay(points)
...     verify(mesh.points, mesh.triangles).raise_if_failed()
"""

from exactmesh.errors import HypothesisUnavailableError

try:
    import hypothesis  # noqa: F401  # asked for here, so that every room below may rely on it
except ImportError:
    raise HypothesisUnavailableError(
        "exactmesh.strategies needs hypothesis, which is not installed: pip install 'exactmesh[hypothesis]'"
    ) from None

from exactmesh.strategies.corrupting import corrupt, corrupted_triangulations
from exactmesh.strategies.corruptions import Corrupted, Corruption
from exactmesh.strategies.graphs import pslgs
from exactmesh.strategies.lines import near_concurrent, slits, small_angles, t_junctions
from exactmesh.strategies.meshes import PlainMesh, triangulations
from exactmesh.strategies.point_sets import duplicate_points, points
from exactmesh.strategies.polygons import polygons, polygons_with_holes, shared_borders, spirals
from exactmesh.strategies.regular import cocircular_points, collinear_points, grid_points, tilted_grid_points
from exactmesh.strategies.scattered import (
    clustered_points,
    far_points,
    mixed_scale_points,
    subnormal_points,
    uniform_points,
)
from exactmesh.strategies.structures import quadedges

__all__ = [
    "Corrupted",
    "Corruption",
    "PlainMesh",
    "clustered_points",
    "cocircular_points",
    "collinear_points",
    "corrupt",
    "corrupted_triangulations",
    "duplicate_points",
    "far_points",
    "grid_points",
    "mixed_scale_points",
    "near_concurrent",
    "points",
    "polygons",
    "polygons_with_holes",
    "pslgs",
    "quadedges",
    "shared_borders",
    "slits",
    "small_angles",
    "spirals",
    "subnormal_points",
    "t_junctions",
    "tilted_grid_points",
    "triangulations",
    "uniform_points",
]
