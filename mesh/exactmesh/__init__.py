"""exactmesh: planar triangulations whose every answer can be checked.

>>> from exactmesh import delaunay
>>> mesh = delaunay([(0, 0), (1, 0), (0, 1)])
>>> mesh.triangles.tolist()
[[0, 1, 2]]
"""

from exactkernel.errors import CoordinateError, DegenerateError, ExactMeshError, NonFiniteError, ShapeError
from exactmesh.delaunay import delaunay
from exactmesh.ids import OUTSIDE, Face, QuarterEdge, Vertex
from exactmesh.quadedge import Dual, Edge, Primal, QuadEdge
from exactmesh.triangulation import Triangulation, Work

__all__ = [
    "OUTSIDE",
    "CoordinateError",
    "DegenerateError",
    "Dual",
    "Edge",
    "ExactMeshError",
    "Face",
    "NonFiniteError",
    "Primal",
    "QuadEdge",
    "QuarterEdge",
    "ShapeError",
    "Triangulation",
    "Vertex",
    "Work",
    "delaunay",
]
