"""The answer of the verifier: a verdict for each property, with witnesses."""

import builtins
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from math import inf, isqrt, nextafter

from exactkernel.errors import ExactMeshError
from exactkernel.types import Sign, Stage
from exactmesh.verify.checked import CheckedMesh
from exactmesh.verify.document import FORMAT, document_of, finding_document, violation_document
from exactmesh.verify.properties import LOCAL_PROPERTIES, Kind, Property, Severity, Verdict
from exactmesh.verify.submesh import Submesh, cut_out
from exactmesh.verify.text import lines_of, size_of, worst_first

__all__ = ["FORMAT", "WITNESSES", "Finding", "Report", "VerificationError", "Violation"]

#: Violations that a finding spells out; ``Finding.count`` goes on counting.
WITNESSES = 100


def root_above(value: Fraction) -> float:
    """Return the smallest double whose square is not smaller, possibly infinity."""
    shift = 64 + value.denominator.bit_length()  # the root, rounded down, has 64 bits at least
    root = Fraction(isqrt((value.numerator << 2 * shift) // value.denominator), 1 << shift)
    try:
        nearest = float(root)
    except OverflowError:
        return inf
    while nearest < inf and Fraction(nearest) ** 2 < value:
        nearest = nextafter(nearest, inf)
    return nearest


@dataclass(frozen=True, slots=True)
class Violation:
    """One witness against a property.

    Attributes:
        property: what is violated.
        kind: in which way.
        triangles: rows of ``triangles`` that are involved; of quadrilaterals the row and the number of triangles.
        vertices: rows of ``points`` that are involved.
        message: one sentence with indices and coordinates.
        sign: the exact sign of the determinant that decided, where there is one.
        magnitude: that determinant, an exact rational in units of the coordinates: twice the signed area
            (orient2d, and where an area is too large), the incircle determinant, or the scalar product of diametral.
        severity: ``ROUNDING`` where doubles do not resolve the magnitude, or its difference from a bound.
        degrees: the angle that is below or above a bound, rounded.
        places: positions that are no vertices, such as a hole's point.
        corners: the corners of each of ``triangles``.
        indices: all of ``vertices`` and corners, ascending.
        points: where these are, exactly; NaN for an index that is out of range.
        point_count: the number of points of the mesh.
    """

    property: Property
    kind: Kind
    triangles: tuple[int, ...]
    vertices: tuple[int, ...]
    message: str
    sign: Sign | None = None
    magnitude: Fraction | None = None
    severity: Severity = Severity.WRONG
    degrees: float | None = None
    places: tuple[tuple[float, float], ...] = ()
    corners: tuple[tuple[int, ...], ...] = field(default=(), compare=False, repr=False)
    indices: tuple[int, ...] = field(default=(), compare=False, repr=False)
    points: tuple[tuple[float, float], ...] = field(default=(), compare=False, repr=False)
    point_count: int = field(default=0, compare=False, repr=False)

    @builtins.property  # the field ``property`` hides the name
    def is_local(self) -> bool:
        """Whether :meth:`submesh` violates the same property by itself, and needs every cell for that. Of what is not
        local no part of a mesh can speak: that a point is unused, or a segment missing."""
        return self.property in LOCAL_PROPERTIES

    def submesh(self) -> Submesh:
        """Return the cells and vertices that are named, as a mesh.

        >>> from exactmesh.verify import verify
        >>> square = [(0, 0), (4, 0), (4, 4), (0, 4), (9, 9)]
        >>> report = verify(square, [(0, 1, 2), (0, 2, 3), (0, 1, 3), (1, 4, 2)], claims=["admissible"])
        >>> part = report.findings["admissible"].violations[0].submesh()
        >>> part.triangles.tolist(), part.indices, part.cells
        ([[0, 1, 2], [0, 1, 3]], (0, 1, 2, 3), (0, 2))
        >>> verify(part.points, part.triangles, claims=["admissible"]).ok
        False
        """
        return cut_out(self)

    def to_python(self) -> str:
        """Return source to copy: the violation as a comment, and the arrays of :meth:`submesh`."""
        return f"# {self.property}, {self.kind}: {self.message}\n{self.submesh().to_python()}"

    def to_dict(self) -> dict[str, object]:
        """Return what JSON can say, see :meth:`Report.to_json`."""
        return violation_document(self)


@dataclass(frozen=True, slots=True)
class Finding:
    """What was found about one property.

    Attributes:
        verdict: HOLDS, FAILS or UNDECIDED.
        count: the number of violations, also of those beyond the first :data:`WITNESSES`.
        violations: the witnesses, wrong ones first, and of those that can be measured the largest.
        lower_bound: True where ``count`` is what was found before the search stopped (an overlap ends the
            plane sweep).
        because: for UNDECIDED, the properties that would have to hold first.
        rounding: how many of ``count`` are rounding-sized.
        distance_squared: where a distance was allowed (``within``), the exact square of the one that was found.
        note: what is worth to know besides, such as how many cells are listed clockwise where that is allowed.
    """

    verdict: Verdict
    count: int = 0
    violations: tuple[Violation, ...] = ()
    lower_bound: bool = False
    because: tuple[Property, ...] = ()
    rounding: int = 0
    distance_squared: Fraction | None = None
    note: str = ""

    @property
    def distance(self) -> float | None:
        """The root of ``distance_squared``, rounded up."""
        return None if self.distance_squared is None else root_above(self.distance_squared)

    @property
    def severity(self) -> Severity | None:
        """WRONG if any violation is, ROUNDING if all of them are rounding-sized, None without violations."""
        if not self.count:
            return None
        return Severity.ROUNDING if self.rounding == self.count else Severity.WRONG

    def to_dict(self) -> dict[str, object]:
        """Return what JSON can say."""
        return finding_document(self)


class VerificationError(ExactMeshError):
    """A claimed property does not hold, or could not be decided; ``report`` has the witnesses."""

    def __init__(self, message: str, *, report: "Report") -> None:
        super().__init__(message)
        self.report = report


@dataclass(frozen=True, slots=True)
class Report:
    """The verdict on every property of a mesh.

    Attributes:
        findings: a :class:`Finding` for each :class:`Property`, claimed or not; but without segments, domain or labels
            none for what is about these.
        claims: the properties that were claimed.
        point_count, triangle_count, quad_count: the size of the input.
        stages: how many calls of "orient2d" (diametral included) and "incircle" each exact stage decided.
        mesh: what was checked; two reports that say the same are equal whatever it is.

    >>> from exactmesh.verify import Property, verify
    >>> report = verify([(0, 0), (4, 0), (0, 3)], [(0, 2, 1)])
    >>> report.ok, [str(claim) for claim in report.claims if report.verdict(claim) != "holds"]
    (False, ['orientation'])
    >>> report.findings[Property.ORIENTATION].violations[0].magnitude
    Fraction(-12, 1)
    """

    findings: Mapping[Property, Finding]
    claims: tuple[Property, ...]
    point_count: int
    triangle_count: int
    stages: Mapping[str, Mapping[Stage, int]]
    mesh: CheckedMesh | None = field(default=None, compare=False)
    quad_count: int = 0

    def __bool__(self) -> bool:
        """Tell whether every claimed property holds, so that ``assert verify(...)`` means what it says."""
        return self.ok

    def __repr__(self) -> str:
        verdicts = ", ".join(f"{claim} {self.verdict(claim)}" for claim in self.claims if not self._holds(claim))
        return f"Report({size_of(self)}, {verdicts or 'ok'})"

    def _holds(self, claim: Property) -> bool:
        return self.findings[claim].verdict is Verdict.HOLDS

    @property
    def ok(self) -> bool:
        """True if every claimed property holds."""
        return all(self._holds(claim) for claim in self.claims)

    @property
    def severity(self) -> Severity | None:
        """How bad it is: None if every claim holds; ROUNDING if what the claims fail for, or wait for, is
        rounding-sized only; WRONG otherwise."""
        if self.ok:
            return None
        found = {severity for claim in self.claims for severity in self._severities(claim)}
        return Severity.ROUNDING if found == {Severity.ROUNDING} else Severity.WRONG

    def _severities(self, property_: Property) -> Iterator[Severity | None]:
        """Yield the severity of a property that does not hold, or of those that it waits for."""
        finding = self.findings.get(property_)
        if finding is None or finding.verdict is Verdict.FAILS:
            yield Severity.WRONG if finding is None else finding.severity
        elif finding.verdict is Verdict.UNDECIDED:
            if not finding.because:
                yield Severity.WRONG
            for awaited in finding.because:
                yield from self._severities(awaited)

    @property
    def distance_squared(self) -> Fraction | None:
        """The exact square of the largest distance of a vertex of the mesh from where the domain has it: of a vertex on
        a segment from the segment, of a corner from its point. None unless ``within`` was given."""
        finding = self.findings.get(Property.SEGMENTS_PRESENT)
        return None if finding is None else finding.distance_squared

    @property
    def distance(self) -> float | None:
        """The root of ``distance_squared``, rounded up to a double."""
        return None if self.distance_squared is None else root_above(self.distance_squared)

    @property
    def violations(self) -> tuple[Violation, ...]:
        """All witnesses, claimed properties or not, in the order of the properties."""
        return tuple(violation for finding in self.findings.values() for violation in finding.violations)

    def verdict(self, property_: Property) -> Verdict:
        """Return the verdict on one property; UNDECIDED where nothing was given to decide it by."""
        finding = self.findings.get(property_)
        return Verdict.UNDECIDED if finding is None else finding.verdict

    def raise_if_failed(self) -> None:
        """Raise unless every claimed property holds.

        Raises:
            VerificationError: it carries this report.
        """
        if not self.ok:
            broken = [claim for claim in worst_first(self) if not self._holds(claim)]
            notes = {claim: self.findings[claim].note for claim in broken}
            summary = ", ".join(
                f"{claim} {self.verdict(claim)}{f' ({note})' if note else ''}" for claim, note in notes.items()
            )
            witnesses = [self.findings[claim].violations for claim in broken]
            sentence = next((violations[0].message for violations in witnesses if violations), "no witness")
            raise VerificationError(f"{summary}: {sentence}", report=self)

    def to_json(self) -> str:
        """Return the report as JSON, format "exactmesh-report/2", with the hash of the mesh: a certificate, which
        :func:`check_certificate` compares with a mesh. The same report makes the same text."""
        return json.dumps(document_of(self), indent=2, allow_nan=False)

    def to_html(self, title: str | None = None) -> str:
        """Return the report as one page for a browser, which needs no network: the mesh, to be zoomed, the failing
        places listed and marked, their numbers.

        Args:
            title: a heading; None stands for the size of the mesh.

        O(n + m), in time and size.
        """
        from exactmesh.html import page_of  # a room of its own: the verifier itself knows no picture

        return page_of(self, title)

    def __str__(self) -> str:
        return "\n".join(lines_of(self))
