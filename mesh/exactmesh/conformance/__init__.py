"""Put anybody's mesher to the test: the laws of a triangulation, inputs that break them, and the smallest of these.

>>> from exactmesh.conformance import check
>>> check("exactmesh", max_examples=5, max_size=8).ok
True
"""

from exactmesh.conformance.assertions import assert_admissible, assert_constrained_delaunay, assert_delaunay
from exactmesh.conformance.checking import DEADLINE, MAX_EXAMPLES, MAX_SIZE, check, retry
from exactmesh.conformance.corpus import BUNDLES, CORPUS, Case, case_named
from exactmesh.conformance.given import Given, Trait
from exactmesh.conformance.known import KNOWN, Known
from exactmesh.conformance.laws import LAWS, Behaviour, Law, Outcome, Task
from exactmesh.conformance.process import Limits
from exactmesh.conformance.reference import loaded
from exactmesh.conformance.result import Conformance, Counterexample, Ruling

__all__ = [
    "BUNDLES",
    "CORPUS",
    "DEADLINE",
    "KNOWN",
    "LAWS",
    "MAX_EXAMPLES",
    "MAX_SIZE",
    "Behaviour",
    "Case",
    "Conformance",
    "Counterexample",
    "Given",
    "Known",
    "Law",
    "Limits",
    "Outcome",
    "Ruling",
    "Task",
    "Trait",
    "assert_admissible",
    "assert_constrained_delaunay",
    "assert_delaunay",
    "case_named",
    "check",
    "loaded",
    "retry",
]
