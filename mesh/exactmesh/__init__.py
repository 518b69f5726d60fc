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
    AdapterError,
    BoundError,
    CertificateError,
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
    HypothesisUnavailableError,
    InadmissibleError,
    MesherError,
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
from exactmesh.voronoi import (
    NaturalNeighbors,
    Relaxation,
    Voronoi,
    interpolate,
    lloyd,
    natural_neighbors,
    voronoi,
)

__version__ = "0.1.0"

__all__ = [
    "OUTSIDE",
    "PSLG",
    "AdapterError",
    "Arrangement",
    "BoundError",
    "Carve",
    "CertificateError",
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
    "HypothesisUnavailableError",
    "InadmissibleError",
    "Meeting",
    "MesherError",
    "NaturalNeighbors",
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
    "Relaxation",
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
    "__version__",
    "arrange",
    "constrained_delaunay",
    "delaunay",
    "find_crossings",
    "flip",
    "interpolate",
    "is_flippable",
    "is_locally_delaunay",
    "lawson",
    "lloyd",
    "natural_neighbors",
    "refine",
    "verify",
    "voronoi",
]
