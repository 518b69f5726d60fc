"""exactmesh: planar triangulations whose every answer can be checked.

>>> from exactmesh import delaunay
>>> mesh = delaunay([(0, 0), (1, 0), (0, 1)])
>>> mesh.triangles.tolist()
[[0, 1, 2]]
"""

from exactkernel.errors import CoordinateError, DegenerateError, ExactMeshError, NonFiniteError, ShapeError
from exactmesh.delaunay import delaunay
from exactmesh.ids import OUTSIDE, Face, QuarterEdge, Vertex
from exactmesh.lawson import flip, is_flippable, is_locally_delaunay, lawson
from exactmesh.quadedge import Dual, Edge, Primal, QuadEdge
from exactmesh.triangulation import Triangulation, Work
from exactmesh.verify import Property, Report, Verdict, verify

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
    "Property",
    "QuadEdge",
    "QuarterEdge",
    "Report",
    "ShapeError",
    "Triangulation",
    "Verdict",
    "Vertex",
    "Work",
    "delaunay",
    "flip",
    "is_flippable",
    "is_locally_delaunay",
    "lawson",
    "verify",
]
