"""A report as JSON is a certificate: it says by hash what it is about, so that it can be held against a mesh later."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import cast

import numpy as np
import numpy.typing as npt

from exactkernel.errors import ShapeError
from exactkernel.types import FloatArray, IntArray
from exactmesh.errors import CertificateError
from exactmesh.verify.checked import CheckedMesh
from exactmesh.verify.document import FORMAT, document_of, given_document
from exactmesh.verify.domain import Domain, Outline, constraints_of
from exactmesh.verify.given import Extras, Given, of_mesh
from exactmesh.verify.hashing import mesh_sha256
from exactmesh.verify.mesh import index_quads, index_triples, points_of
from exactmesh.verify.properties import Property, Verdict
from exactmesh.verify.report import Report
from exactmesh.verify.verifier import verify

__all__ = ["Certificate", "CertificateCheck", "check_certificate", "read_certificate"]

#: What was given, what messages call it, and how it is given again.
_THINGS = {"segments": "segments", "domain": "a domain", "labels": "labels"}
#: The arguments that are bounds.
_BOUNDS = {"min_angle", "max_angle", "max_area", "size", "within"}


@dataclass(frozen=True, slots=True)
class Certificate:
    """What :meth:`Report.to_json` wrote.

    Attributes:
        document: all of it.
    """

    document: Mapping[str, object]

    @property
    def ok(self) -> bool:
        """Whether every claim held."""
        return self.document["ok"] is True

    @property
    def mesh(self) -> Mapping[str, object]:
        """Hash and counts of the mesh."""
        return cast("Mapping[str, object]", self.document["mesh"])

    @property
    def given(self) -> Mapping[str, object]:
        """What it was checked against."""
        return cast("Mapping[str, object]", self.document["given"])

    @property
    def rule(self) -> str | None:
        """The rule of its domain, if it has one."""
        domain = cast("Mapping[str, str] | None", self.given["domain"])
        return None if domain is None else domain["rule"]

    @property
    def bounds(self) -> Mapping[str, object]:
        """The bounds that were given: numbers, or hashes of arrays."""
        return cast("Mapping[str, object]", self.given["bounds"])

    @property
    def claims(self) -> tuple[str, ...]:
        """The names of what was claimed."""
        return tuple(cast("list[str]", self.document["claims"]))

    def answers(self) -> dict[str, tuple[object, ...]]:
        """Return the verdict on each property, and how many violations there are."""
        return _answers(self.document)


@dataclass(frozen=True, slots=True)
class CertificateCheck:
    """Whether a certificate is that of a mesh.

    Attributes:
        differences: a sentence for each difference; none means that it is.
        certificate: what was read.
        report: what was found when the mesh was verified again; None if it was not.
    """

    differences: tuple[str, ...]
    certificate: Certificate
    report: Report | None = None

    def __bool__(self) -> bool:
        return not self.differences


def read_certificate(text: str | bytes | Mapping[str, object]) -> Certificate:
    """Return the certificate in a text, or in what ``json`` made of it.

    Raises:
        CertificateError: it is no JSON, of another format, not whole, or contradicts itself.
    """
    try:
        document = dict(text) if isinstance(text, Mapping) else json.loads(text)
    except (TypeError, ValueError, RecursionError) as error:
        raise CertificateError(f"no certificate: {error}") from None
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        told = document.get("format") if isinstance(document, dict) else None
        raise CertificateError(f"no certificate of format {FORMAT!r}: its format is {told!r}")
    for path, sort in _PARTS.items():
        part: object = document
        for name in path.split("."):
            part = part.get(name, _ABSENT) if isinstance(part, dict) else _ABSENT
        if not isinstance(part, sort):
            raise CertificateError(f"the certificate has no proper {path!r}")
    domain = document["given"]["domain"]
    if domain is not None and not isinstance(domain.get("rule"), str):
        raise CertificateError("the certificate has no proper 'given.domain.rule'")
    if any(not isinstance(finding, dict) for finding in document["properties"].values()):
        raise CertificateError("the certificate has no proper 'properties'")
    _require_consistency(document["claims"], document["properties"], ok=document["ok"])
    return Certificate(document)


def _require_consistency(claims: list[object], properties: Mapping[str, Mapping[str, object]], *, ok: bool) -> None:
    """Refuse a certificate that contradicts itself: whoever reads "ok" may rely on the verdicts below it."""
    if not claims or not all(isinstance(claim, str) and claim in properties for claim in claims):
        raise CertificateError("the certificate has no proper 'claims': each is one of its 'properties'")
    for name, finding in properties.items():
        if name not in tuple(Property) or finding.get("verdict") not in tuple(Verdict):
            raise CertificateError(f"the certificate has no proper verdict on {name!r}")
    if ok is not all(properties[str(claim)]["verdict"] == Verdict.HOLDS for claim in claims):
        raise CertificateError("the certificate contradicts itself: 'ok' is not what its verdicts on the claims say")


_ABSENT = object()  # null is a proper part of some
_PARTS: dict[str, type | tuple[type, ...]] = {
    "ok": bool,
    "mesh.sha256": str,
    "mesh.points": int,
    "mesh.triangles": int,
    "mesh.quads": int,
    "given.orientation": str,
    "given.segments": (dict, type(None)),
    "given.domain": (dict, type(None)),
    "given.labels": (dict, type(None)),
    "given.bounds": dict,
    "claims": list,
    "properties": dict,
}


def check_certificate(
    certificate: str | bytes | Mapping[str, object] | Certificate,
    points: object,
    triangles: npt.ArrayLike | None = None,
    *,
    quads: npt.ArrayLike | None = None,
    segments: npt.ArrayLike | None = None,
    domain: Domain | None = None,
    labels: npt.ArrayLike | None = None,
    bounds: Mapping[str, npt.ArrayLike] | None = None,
    again: bool = False,
) -> CertificateCheck:
    """Tell whether a certificate is that of a mesh: whether the hashes are those of the arrays.

    What it says of the mesh is as good as its source: it carries no signature. ``again`` checks that, too; which claims
    and bounds were asked for, and how triangles may be listed, is the certificate's own to say.

    Args:
        certificate: what :meth:`Report.to_json` wrote: the text, or what ``json`` makes of it.
        points, triangles, quads, segments, domain, labels: as for :func:`verify`.
        bounds: bounds that were arrays, by the names of their arguments; single numbers are in the certificate.
        again: verify the mesh anew, with the claims of the certificate, and compare the verdicts.

    Raises:
        CertificateError: no certificate, or it is about more than was given, or less.
        ExactMeshError: what :func:`verify` raises.

    O(n + m), and with ``again`` the time of :func:`verify`.

    >>> from exactmesh.verify import check_certificate, verify
    >>> points, triangles = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)], [(0, 1, 2)]
    >>> text = verify(points, triangles).to_json()
    >>> bool(check_certificate(text, points, triangles, again=True))
    True
    >>> check_certificate(text, points, [(1, 2, 0)]).differences
    ('the mesh is another one: its sha256 is 7e8e4cb1..., that of the certificate is 6103f473...',)
    """
    read = certificate if isinstance(certificate, Certificate) else read_certificate(certificate)
    mesh = _given_mesh(Given(points, triangles, quads), Extras(segments, domain, labels, None), _bounds(read, bounds))
    _require_the_same_things(read, mesh)
    differences = list(_differences(read, mesh))
    if differences or not again:
        return CertificateCheck(tuple(differences), read)
    report = _verified_again(read, mesh)
    return CertificateCheck(tuple(_other_answers(read, report)), read, report)


def _bounds(certificate: Certificate, arrays: Mapping[str, npt.ArrayLike] | None) -> dict[str, float | FloatArray]:
    """Return the numbers of the certificate, and the arrays."""
    bounds: dict[str, float | FloatArray] = {}
    for name, bound in certificate.bounds.items():
        if isinstance(bound, dict):
            continue
        try:
            bounds[name] = float(cast("float | str", bound))
        except (TypeError, ValueError, OverflowError):
            raise CertificateError(f"the certificate has no proper bound {name!r}") from None
    if arrays is not None and not isinstance(arrays, Mapping):
        raise ShapeError(f"bounds: expected a mapping of names to arrays, not a {type(arrays).__name__}")
    for name, array in dict(arrays or {}).items():
        try:
            bounds[name] = np.asarray(array, dtype=np.float64)
        except (TypeError, ValueError):
            raise ShapeError(f"bounds[{name!r}] is no array of numbers") from None
    return bounds


def _given_mesh(cells: Given, extras: Extras, bounds: Mapping[str, float | FloatArray]) -> CheckedMesh:
    """Return what was given as the verifier would take it."""
    if cells.triangles is None and cells.quads is None:
        cells, extras = of_mesh(cells.points, extras)
    triangles = index_triples(() if cells.triangles is None else cells.triangles)
    quads = index_quads(() if cells.quads is None else cells.quads)
    points = points_of(cast("npt.ArrayLike", cells.points))
    constraints = constraints_of(extras.segments, extras.domain, extras.labels, len(triangles) + len(quads))
    return CheckedMesh(points, triangles, quads, constraints.segments, constraints.labels, constraints.outline, bounds)


def _require_the_same_things(certificate: Certificate, mesh: CheckedMesh) -> None:
    given = given_document(mesh)
    for name, noun in _THINGS.items():
        if (certificate.given[name] is None) != (given[name] is None):
            fault = "not about" if given[name] is not None else "about"
            raise CertificateError(f"the certificate is {fault} {noun}: {name}")
    names = {*certificate.bounds, *mesh.bounds} - _BOUNDS | set(certificate.bounds) ^ set(mesh.bounds)
    if names:
        raise CertificateError(f"bounds of the certificate and those given differ: {', '.join(sorted(names))}")


def _differences(certificate: Certificate, mesh: CheckedMesh) -> Iterator[str]:
    own = mesh_sha256(mesh.points, mesh.triangles, mesh.quads)
    yield from _difference("the mesh", certificate.mesh["sha256"], own)
    for name, rows in (("points", mesh.points), ("triangles", mesh.triangles), ("quads", mesh.quads)):
        if certificate.mesh[name] != len(rows):
            yield f"there are {len(rows)} {name}, the certificate says {certificate.mesh[name]}"
    given = given_document(mesh)
    for name in _THINGS:
        theirs, ours = (cast("Mapping[str, object] | None", things[name]) for things in (certificate.given, given))
        if theirs is not None and ours is not None:
            yield from _difference(f"the {name}", theirs.get("sha256"), ours["sha256"])
    for name, ours in cast("Mapping[str, Mapping[str, object]]", given["bounds"]).items():
        theirs = cast("Mapping[str, object] | None", certificate.bounds[name])
        if isinstance(ours, dict):
            yield from _difference(name, theirs.get("sha256") if isinstance(theirs, dict) else theirs, ours["sha256"])


def _difference(name: str, theirs: object, ours: object) -> Iterator[str]:
    if theirs != ours:
        verb = "are others: their" if name.endswith("s") else "is another one: its"
        yield f"{name} {verb} sha256 is {str(ours)[:8]}..., that of the certificate is {str(theirs)[:8]}..."


@dataclass(frozen=True, slots=True)
class _Domain:
    """The domain of a mesh that was given."""

    points: FloatArray
    segments: IntArray
    holes: FloatArray
    regions: FloatArray
    rule: str


def _domain(outline: Outline | None) -> _Domain | None:
    if outline is None:
        return None
    regions = np.column_stack([outline.regions, outline.attributes, outline.areas]).reshape(-1, 4)
    rule = "even-odd" if outline.even_odd else "seeds"
    return _Domain(outline.points, outline.segments.astype(np.int32), outline.holes, regions, rule)


def _verified_again(certificate: Certificate, mesh: CheckedMesh) -> Report:
    if Property.VORONOI_DUAL in certificate.claims:
        raise CertificateError("voronoi_dual cannot be verified again: a certificate does not hold the diagram")
    numbers = cast("Mapping[str, float]", mesh.bounds)  # these three are none of the arrays
    return verify(
        mesh.points,
        mesh.triangles,
        quads=mesh.quads,
        segments=mesh.segments,
        domain=_domain(mesh.domain),
        labels=mesh.labels,
        claims=certificate.claims,
        orientation=str(certificate.given["orientation"]),
        min_angle=numbers.get("min_angle"),
        max_angle=numbers.get("max_angle"),
        max_area=mesh.bounds.get("max_area"),
        size=mesh.bounds.get("size"),
        within=numbers.get("within"),
    )


def _other_answers(certificate: Certificate, report: Report) -> Iterator[str]:
    """Compare the answers, and, of the same version of this library, everything that is said about a property."""
    document = document_of(report)
    theirs, ours = certificate.answers(), _answers(document)
    for name in dict.fromkeys([*theirs, *ours]):
        if theirs.get(name) != ours.get(name):
            yield f"{name} is {_said(ours.get(name))}, the certificate says {_said(theirs.get(name))}"
        elif certificate.document.get("exactmesh") == document["exactmesh"]:
            findings = (cast("Mapping[str, object]", it["properties"])[name] for it in (certificate.document, document))
            if len({json.dumps(finding, sort_keys=True) for finding in findings}) > 1:
                yield f"{name} is {_said(ours[name])}, as the certificate says, but not with its witnesses"
    if certificate.document.get("severity") != document["severity"]:
        yield f"the severity is {document['severity']}, the certificate says {certificate.document.get('severity')}"


def _said(answer: tuple[object, ...] | None) -> str:
    if answer is None:
        return "not decided on"
    verdict, count = answer
    return f"{verdict} ({count} found)" if count else str(verdict)


def _answers(document: Mapping[str, object]) -> dict[str, tuple[object, ...]]:
    findings = cast("Mapping[str, Mapping[str, object]]", document["properties"])
    return {name: (finding.get("verdict"), finding.get("count")) for name, finding in findings.items()}
