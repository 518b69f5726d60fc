"""The verifier: exact answers about triangles from anywhere, with witnesses. It imports no algorithm.

>>> from exactmesh.verify import verify
>>> print(verify([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)], claims=["admissible"]))
3 points, 1 triangles: every claim holds
  + admissible       holds
  not claimed:
  + finite           holds
  + indices          holds
  + distinct_points  holds
  + orientation      holds
  + all_points_used  holds
  + edge_manifold    holds
  + vertex_manifold  holds
  + covers_hull      holds
  + delaunay         holds
  + weakly_acute     holds
  - acute            fails, 1 found
  orient2d: filter 6, grid 1
  incircle: not called
"""

from exactmesh.verify.certificate import Certificate, CertificateCheck, check_certificate, read_certificate
from exactmesh.verify.checked import CheckedMesh
from exactmesh.verify.domain import Domain
from exactmesh.verify.dual import Diagram
from exactmesh.verify.properties import (
    ADMISSIBLE_MESH,
    CONFORMING_TRIANGULATION,
    CONSTRAINED_TRIANGULATION,
    DELAUNAY_TRIANGULATION,
    DOMAIN_TRIANGULATION,
    ChoiceError,
    Kind,
    Orientation,
    Property,
    Severity,
    Verdict,
)
from exactmesh.verify.report import FORMAT, WITNESSES, Finding, Report, VerificationError, Violation
from exactmesh.verify.schema import report_schema
from exactmesh.verify.submesh import Submesh
from exactmesh.verify.verifier import verify

__all__ = [
    "ADMISSIBLE_MESH",
    "CONFORMING_TRIANGULATION",
    "CONSTRAINED_TRIANGULATION",
    "DELAUNAY_TRIANGULATION",
    "DOMAIN_TRIANGULATION",
    "FORMAT",
    "WITNESSES",
    "Certificate",
    "CertificateCheck",
    "CheckedMesh",
    "ChoiceError",
    "Diagram",
    "Domain",
    "Finding",
    "Kind",
    "Orientation",
    "Property",
    "Report",
    "Severity",
    "Submesh",
    "Verdict",
    "VerificationError",
    "Violation",
    "check_certificate",
    "read_certificate",
    "report_schema",
    "verify",
]

# In the package exactmesh, ``verify`` is the function. ``import exactmesh.verify as v`` finds that one as well, and so
# that ``v.Report`` is there all the same, the function bears the names of this room.
vars(verify).update({name: globals()[name] for name in __all__})
