"""Voronoi diagrams, the duals of Delaunay triangulations; what to make of their cells.

>>> from exactmesh.voronoi import voronoi
>>> voronoi([(0, 0), (2, 0), (0, 2)]).vertices.tolist()
[[1.0, 1.0]]
"""

from exactmesh.voronoi.build import Clip, voronoi
from exactmesh.voronoi.cells import Cells, CornerKind
from exactmesh.voronoi.centres import circumcentres, dual_edges
from exactmesh.voronoi.diagram import Voronoi
from exactmesh.voronoi.interpolation import NaturalNeighbors, interpolate, natural_neighbors
from exactmesh.voronoi.relaxation import Relaxation, lloyd

__all__ = [
    "Cells",
    "Clip",
    "CornerKind",
    "NaturalNeighbors",
    "Relaxation",
    "Voronoi",
    "circumcentres",
    "dual_edges",
    "interpolate",
    "lloyd",
    "natural_neighbors",
    "voronoi",
]
