"""A certificate against a mesh from a file, and against its domain: one from another file, or its own segments'."""

from exactmesh.adapters import GivenMesh
from exactmesh.errors import CertificateError
from exactmesh.io import Mesh
from exactmesh.pslg import PSLG, Carve
from exactmesh.verify import Certificate, CertificateCheck, check_certificate

__all__ = ["checked_certificate", "said_of"]


def checked_certificate(
    certificate: Certificate, mesh: Mesh | GivenMesh, domain: PSLG | None, *, again: bool
) -> CertificateCheck:
    """Compare what ``verify`` was given, as far as it comes from these files, with what the certificate is about.

    Raises:
        CertificateError: it is about more than there is on file, or less.
        PSLGError: the mesh's own segments and holes describe no domain.
    """
    if domain is not None and certificate.rule is not None:
        domain = domain.with_rule(_rule(certificate))
    if isinstance(mesh, GivenMesh):
        return check_certificate(certificate, mesh, domain=domain, again=again)
    assert mesh.triangles is not None
    segments = mesh.segments if certificate.given["segments"] is not None else None
    if certificate.rule is not None and domain is None:
        domain = _own_domain(certificate, mesh)
    attributes = mesh.triangle_attributes if certificate.given["labels"] is not None else None
    labels = None if attributes is None else attributes[:, -1]
    return check_certificate(
        certificate, mesh.points, mesh.triangles, segments=segments, domain=domain, labels=labels, again=again
    )


def _own_domain(certificate: Certificate, mesh: Mesh) -> PSLG:
    if mesh.segments is None or not len(mesh.segments):
        raise CertificateError("the certificate is about a domain, and the mesh has no segments: --domain FILE")
    return PSLG(mesh.points, mesh.segments, holes=mesh.holes, regions=mesh.regions).with_rule(_rule(certificate))


def _rule(certificate: Certificate) -> Carve:
    rule = certificate.rule
    if rule not in tuple(Carve):
        raise CertificateError(f"the certificate has no proper rule: {rule!r}")
    return Carve(rule)


def said_of(check: CertificateCheck, certificate: str, mesh: str) -> str:
    """Return what the command prints."""
    if not check:
        return "\n".join([f"{certificate} is NOT the certificate of {mesh}:", *map("  {}".format, check.differences)])
    found = "verified again" if check.report is not None else "it says"
    answer = "every claim holds" if check.certificate.ok else "NOT every claim holds"
    bounds = [f"{name}={bound}" for name, bound in check.certificate.bounds.items() if not isinstance(bound, dict)]
    return (
        f"{certificate} is the certificate of {mesh}, sha256 {check.certificate.mesh['sha256']}\n"
        f"{found}: {answer} ({', '.join([*check.certificate.claims, *bounds])})"
    )
