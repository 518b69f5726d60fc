"""exactmesh: planar triangulations whose every answer can be checked.

>>> from exactmesh import delaunay
>>> mesh = delaunay([(0, 0), (1, 0), (0, 1)])
>>> mesh.triangles.tolist()
[[0, 1, 2]]
"""

from exactkernel.types import Sign, Stage
from exactmesh.constrain import Crossings, constrained_delaunay
from exactmesh.crossings import Arrangement, Meeting, Rounding, SegmentPairs, arrange, find_crossings
from exactmesh.delaunay import delaunay
from exactmesh.editing.builder import TriangulationBuilder
from exactmesh.errors import (
    ChoiceError,
    ClipError,
    CollinearPointsError,
    ConflictingValuesError,
    ConstrainedVertexError,
    CoordinateError,
    CrossingError,
    DegenerateError,
    ExactMeshError,
    Fault,
    FaultKind,
    FileFormatError,
    GeometryError,
    InadmissibleError,
    NonFiniteError,
    NotConformingError,
    NotDelaunayError,
    OptionError,
    PSLGError,
    SeedError,
    ShapeError,
    SnappingError,
    TooFewPointsError,
    TooManyCrossingsError,
    TooManyPointsError,
    TopologyError,
)
from exactmesh.ids import OUTSIDE, Face, QuarterEdge, Vertex
from exactmesh.lawson import flip, is_flippable, is_locally_delaunay, lawson
from exactmesh.pslg import PSLG, Carve
from exactmesh.quadedge import Dual, Edge, Primal, QuadEdge
from exactmesh.quality import Statistics
from exactmesh.refinement import Reason, Refinement, Steiner, SteinerKind, refine
from exactmesh.triangulation import Triangulation, Work
from exactmesh.verify import Orientation, Property, Report, Verdict, VerificationError, Violation, verify
from exactmesh.voronoi import Voronoi, voronoi

__all__ = [
    "OUTSIDE",
    "PSLG",
    "Arrangement",
    "Carve",
    "ChoiceError",
    "ClipError",
    "CollinearPointsError",
    "ConflictingValuesError",
    "ConstrainedVertexError",
    "CoordinateError",
    "CrossingError",
    "Crossings",
    "DegenerateError",
    "Dual",
    "Edge",
    "ExactMeshError",
    "Face",
    "Fault",
    "FaultKind",
    "FileFormatError",
    "GeometryError",
    "InadmissibleError",
    "Meeting",
    "NonFiniteError",
    "NotConformingError",
    "NotDelaunayError",
    "OptionError",
    "Orientation",
    "PSLGError",
    "Primal",
    "Property",
    "QuadEdge",
    "QuarterEdge",
    "Reason",
    "Refinement",
    "Report",
    "Rounding",
    "SeedError",
    "SegmentPairs",
    "ShapeError",
    "Sign",
    "SnappingError",
    "Stage",
    "Statistics",
    "Steiner",
    "SteinerKind",
    "TooFewPointsError",
    "TooManyCrossingsError",
    "TooManyPointsError",
    "TopologyError",
    "Triangulation",
    "TriangulationBuilder",
    "Verdict",
    "VerificationError",
    "Vertex",
    "Violation",
    "Voronoi",
    "Work",
    "arrange",
    "constrained_delaunay",
    "delaunay",
    "find_crossings",
    "flip",
    "is_flippable",
    "is_locally_delaunay",
    "lawson",
    "refine",
    "verify",
    "voronoi",
]
