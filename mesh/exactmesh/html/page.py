"""The page: markup, with the style, the script, the report and the arrays in it."""

import json
from collections.abc import Callable, Iterator
from html import escape
from importlib import resources

from exactmesh.html.payload import Payload, packed, payload_of
from exactmesh.html.places import places_of, properties_of
from exactmesh.verify import CheckedMesh, Finding, Property, Report, Severity, Verdict
from exactmesh.verify.hashing import mesh_sha256

__all__ = ["page_of"]

#: In this order: classes must be there when others are made of them.
_SCRIPTS = (
    *("data.js", "precise.js", "tree.js", "mesh.js", "eye.js", "raster.js", "scene.js", "marks.js"),
    *("panel.js", "main.js", "input.js"),
)
#: Nothing is loaded from anywhere.
_POLICY = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:"


def page_of(report: Report, title: str | None = None) -> str:
    """Return one HTML document that needs nothing else.

    Args:
        report: one with its mesh, as :func:`exactmesh.verify.verify` returns it.
        title: a heading; None stands for the size of the mesh.

    Raises:
        ValueError: the report was made without a mesh.

    O(n + m), 10 to 20 bytes a triangle.
    """
    mesh = report.mesh
    if mesh is None:
        raise ValueError("this report does not have its mesh")
    payload = payload_of(mesh)
    heading = _counts(mesh) if title is None else str(title).encode(errors="replace").decode()  # names of files
    return "".join(_document(report, mesh, payload, heading))


def _document(report: Report, mesh: CheckedMesh, payload: Payload, heading: str) -> Iterator[str]:
    yield "<!doctype html>\n"
    yield '<html lang="en">\n<head>\n<meta charset="utf-8">\n'
    yield f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">\n'
    yield '<meta name="viewport" content="width=device-width, initial-scale=1">\n<link rel="icon" href="data:,">\n'
    yield f"<title>{escape(heading)}</title>\n<style>\n{_file('style.css')}</style>\n</head>\n<body>\n"
    yield from _aside(report, mesh, heading)
    yield _file("stage.html")
    yield f'<script type="application/json" id="report">{_json(report, payload)}</script>\n'
    for name, array in payload.arrays.items():
        yield f'<script type="text/plain" id="{name}">{packed(array) if len(array) else ""}</script>\n'
    yield '<script>\n(() => {\n"use strict";\n'
    yield from (_file(name) for name in _SCRIPTS)
    yield "})();\n</script>\n</body>\n</html>\n"


def _file(name: str) -> str:
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")


def _json(report: Report, payload: Payload) -> str:
    document = {
        "exponent": payload.exponent,
        "arrays": {name: len(array) for name, array in payload.arrays.items()},
        "properties": properties_of(report),
        "violations": places_of(report, payload),
    }
    text = json.dumps(document, allow_nan=False, ensure_ascii=False, separators=(",", ":"))
    return text.replace("<", "\\u003c")  # nothing in it ends the script


def _counts(mesh: CheckedMesh) -> str:
    counts = [(len(mesh.points), "point"), (len(mesh.triangles), "triangle"), (len(mesh.quads), "quadrilateral")]
    if not len(mesh.quads):
        counts.pop()
    return ", ".join(f"{count:,} {name}{'' if count == 1 else 's'}" for count, name in counts)


def _aside(report: Report, mesh: CheckedMesh, heading: str) -> Iterator[str]:
    from exactmesh import __version__

    tone, answer = ("ok", "every claim holds") if report.ok else ("bad", "not what it claims to be")
    yield f'<aside aria-label="Report">\n<header>\n<h1>{escape(heading)}</h1>\n'
    counts = "" if heading == _counts(mesh) else f'<p class="counts">{_counts(mesh)}</p>\n'
    yield f'<span class="answer {tone}">{answer}</span>\n{counts}</header>\n'
    yield "<section>\n<details open>\n<summary><h2>Claims</h2></summary>\n"
    yield '<table id="claims">\n<tbody>\n'
    yield from (
        _claim(property_, report.findings[property_], "") for property_ in sorted(report.claims, key=_rank(report))
    )
    yield "</tbody>\n"
    others = [property_ for property_ in report.findings if property_ not in report.claims]
    if others:
        yield '<tbody>\n<tr><th colspan="2" scope="rowgroup">not claimed</th></tr>\n'
        yield from (_claim(property_, report.findings[property_], "unclaimed ") for property_ in others)
        yield "</tbody>\n"
    yield "</table>\n</details>\n</section>\n"
    yield _file("places.html")
    yield f"<footer>mesh sha256 <code>{mesh_sha256(mesh.points, mesh.triangles, mesh.quads)}</code><br>"
    yield f"verified by exactmesh {escape(__version__)}, exactly</footer>\n</aside>\n"


def _rank(report: Report) -> Callable[[Property], int]:
    """Return what sorts claims: what fails first, and of that what is wrong."""
    order = {Verdict.FAILS: 0, Verdict.UNDECIDED: 2, Verdict.HOLDS: 3}

    def rank(claim: Property) -> int:
        finding = report.findings[claim]
        return order[finding.verdict] + (finding.severity is Severity.ROUNDING)

    return rank


def _claim(property_: Property, finding: Finding, unclaimed: str) -> str:
    name = escape(property_.value.replace("_", " "))
    told = finding.verdict.value
    if finding.verdict is Verdict.FAILS:
        told += f" · {'≥ ' if finding.lower_bound else ''}{finding.count:,}"
    tone = "fails rounding" if finding.severity is Severity.ROUNDING else finding.verdict.value
    if finding.violations:
        name = f'<button type="button" data-property="{escape(property_.value)}">{name}</button>'
    because = ""
    if finding.because:
        rest = " and ".join(other.value.replace("_", " ") for other in finding.because)
        because = f'<span class="because">waits for {escape(rest)}</span>'
    return (
        f'<tr class="{unclaimed}{tone}"><td><span class="dot" aria-hidden="true"></span>{name}{because}</td>'
        f"<td>{escape(told)}</td></tr>\n"
    )
