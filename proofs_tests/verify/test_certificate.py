"""Reports as JSON, and as certificates: the schema, the hashes, and what the command makes of them."""

import hashlib
import json
import struct
from collections.abc import Callable, Sequence
from pathlib import Path

import jsonschema
import numpy as np
import numpy.typing as npt
import pytest

from exactkernel import ShapeError
from exactmesh import PSLG, constrained_delaunay, delaunay, voronoi
from exactmesh.cli import main
from exactmesh.errors import CertificateError
from exactmesh.io import Mesh, write
from exactmesh.verify import FORMAT, Certificate, Report, check_certificate, read_certificate, report_schema, verify
from exactmesh.verify.hashing import array_sha256, mesh_sha256

SQUARE = [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (0.0, 1.0)]
HALVES = [(0, 1, 2), (0, 2, 3)]
KITE = [(0.0, 0.0), (3.0, -1.0), (6.0, 0.0), (3.0, 1.0)]
RINGS = [(0, 1), (1, 2), (2, 3), (3, 0)]
LAKE = PSLG(
    [(0, 0), (10, 0), (10, 8), (0, 8), (3, 3), (6, 3), (5, 6)],
    [*RINGS, (4, 5), (5, 6), (6, 4)],
    holes=[(4.5, 4)],
    regions=[(1, 1, 42)],
)


def reports() -> list[Report]:
    """Return reports of all sorts."""
    lake = constrained_delaunay(LAKE)
    everything = ["gabriel", "circumcentres_inside", "region_areas", "regions", "covers_domain", "min_angle"]
    return [
        verify(SQUARE, HALVES),
        verify(KITE, HALVES, segments=[(1, 3), (0, 9)], min_angle=40, max_angle=90.5, max_area=[1, 0]),
        verify(SQUARE, HALVES, quads=[(0, 1, 2, 3), (0, 2, 1, 3)]),
        verify([(0, np.nan), (np.inf, 1)], [(0, 1, -5)]),
        verify(lake.points, lake.triangles[1:], domain=LAKE, labels=np.arange(len(lake.triangles) - 1)),
        verify(lake.points, lake.triangles, domain=lake.domain, claims=everything, labels=lake.triangle_attributes,
               min_angle=20, within=np.inf),
        verify([(5e-324 * x, 1e-310 * y) for x, y in KITE], HALVES, orientation="any"),
        verify([], []),
    ]  # fmt: skip


@pytest.mark.obligation(
    "V3", "a report's JSON is what its schema describes, and the same for the same report", method="named cases"
)
class TestSchema:
    """Law: what ``to_json`` writes is what its schema describes, and the same report makes the same text."""

    @pytest.mark.parametrize("number", range(8))
    def test_every_report(self, number: int) -> None:
        report = reports()[number]
        text = report.to_json()
        jsonschema.Draft202012Validator(report_schema()).validate(json.loads(text))
        assert json.loads(text)["format"] == FORMAT
        assert read_certificate(text).ok is report.ok

    def test_the_schema_is_one(self) -> None:
        jsonschema.Draft202012Validator.check_schema(report_schema())

    def test_the_same_text(self) -> None:
        assert [report.to_json() for report in reports()] == [report.to_json() for report in reports()]

    @pytest.mark.parametrize(
        ("path", "value"),
        [
            ("ok", "yes"),
            ("mesh.sha256", "abc"),
            ("properties.delaunay.count", -1),
            ("properties.delaunay.verdict", "maybe"),
            ("properties.delaunay.violations.0.magnitude", "1.5"),
            ("properties.delaunay.violations.0.points.0.hex", ["0x1p0"]),
            ("news", 1),
        ],
    )
    def test_control_other_documents_are_noticed(self, path: str, value: object) -> None:
        """Documents with one value changed."""
        document = part = json.loads(verify(KITE, HALVES).to_json())
        *way, last = path.split(".")
        for name in way:
            part = part[int(name)] if isinstance(part, list) else part[name]
        part[last] = value
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.Draft202012Validator(report_schema()).validate(document)

    def test_coordinates_are_exact(self) -> None:
        """Both notations lead back to the doubles, the smallest ones included."""
        points = np.array(KITE) * 0.1 * 2.0**-1040
        document = json.loads(verify(points, HALVES).to_json())
        (violation,) = document["properties"]["delaunay"]["violations"]
        for point in violation["points"]:
            expected = points[point["vertex"]].tolist()
            assert [float.fromhex(digits) for digits in point["hex"]] == expected
            assert [float(digits) for digits in point["decimal"]] == expected
        assert violation["corners"] == [list(HALVES[row]) for row in violation["triangles"]]


def naive_sha256(points: Sequence[Sequence[float]], *blocks: tuple[int, Sequence[Sequence[int]]]) -> str:
    """Write the canonical bytes of a mesh one number after the other."""
    data = b"exactmesh-mesh/1\n" + struct.pack("<qq", len(points), 2)
    for point in points:
        for z in point:
            data += bytes.fromhex("000000000000f87f") if z != z else struct.pack("<d", z or 0.0)
    for width, rows in blocks:
        data += struct.pack("<qq", len(rows), width) + b"".join(struct.pack(f"<{width}q", *row) for row in rows)
    return hashlib.sha256(data).hexdigest()


@pytest.mark.obligation(
    "V3", "the hash depends on the numbers and their order, and on nothing else", method="property-based"
)
class TestHash:
    """Law: the hash depends on the numbers and their order only, not on dtype, layout or the sign of a zero."""

    @pytest.mark.parametrize("points", [SQUARE, [(-0.0, np.nan), (np.inf, 5e-324), (1.5, -np.nan)], []])
    def test_as_the_documentation_says(self, points: list[tuple[float, float]]) -> None:
        array = np.array(points, dtype=np.float64).reshape(-1, 2)
        rows = np.array(HALVES, dtype=np.int32)
        expected = naive_sha256(points, (3, HALVES), (4, [(0, 1, 2, 3)]))
        assert mesh_sha256(array, rows, np.array([(0, 1, 2, 3)])) == expected

    @pytest.mark.parametrize("dtype", ["i1", "u1", ">i4", "u8"])
    def test_of_numbers(self, dtype: str) -> None:
        points, none = np.array(SQUARE), np.empty((0, 4), dtype=np.int32)
        expected = mesh_sha256(points, np.array(HALVES), none)
        assert mesh_sha256(np.asfortranarray(points) * -1 * -1, np.array(HALVES, dtype=dtype), none) == expected
        assert mesh_sha256(points.repeat(2, axis=0)[::2], np.array(HALVES)[::-1][::-1], none) == expected

    def test_long_arrays_are_read_in_parts(self) -> None:
        array = np.arange(600_001.0)
        whole = b"exactmesh-array/1\n" + struct.pack("<qq", len(array), 1) + array.astype("<f8").tobytes()
        assert array_sha256(array) == hashlib.sha256(whole).hexdigest()

    def test_control_whatever_changes_is_noticed(self) -> None:
        """A coordinate, the order of points, rows or corners changed."""
        points, triangles = np.array(SQUARE), np.array(HALVES)
        none = np.empty((0, 4), dtype=np.int64)
        shifted = points.copy()
        shifted[1, 0] = np.nextafter(3.0, 4.0)
        names = {
            mesh_sha256(points, triangles, none),
            mesh_sha256(shifted, triangles, none),
            mesh_sha256(points[::-1], triangles, none),
            mesh_sha256(points, triangles[::-1], none),
            mesh_sha256(points, triangles[:, [1, 2, 0]], none),
            mesh_sha256(points, triangles[:1], none),
            mesh_sha256(points, triangles, np.array([(0, 1, 2, 3)])),
        }
        assert len(names) == 7


class TestCertificate:
    """Law: a certificate is that of the mesh and the things that it was made of, and of no others."""

    def test_it_is(self) -> None:
        lake = constrained_delaunay(LAKE)
        labels = lake.triangle_attributes[:, 0]
        text = verify(lake.points, lake.triangles, domain=LAKE, labels=labels, min_angle=5).to_json()
        check = check_certificate(text, lake.points, lake.triangles, domain=LAKE, labels=labels, again=True)
        assert check
        assert check.report is not None
        assert check.report.ok
        assert check_certificate(text, lake.points.tolist(), lake.triangles.astype("u8"), domain=LAKE, labels=labels)

    def test_meshes_of_others(self) -> None:
        mesh = delaunay(np.random.default_rng(1).random((30, 2)))
        text = verify(mesh).to_json()
        assert check_certificate(text, mesh, again=True)
        assert not check_certificate(text, delaunay(mesh.points * 2), again=True)

    def test_bounds_that_are_arrays(self) -> None:
        text = verify(SQUARE, HALVES, max_area=[2, 3], max_angle=90).to_json()
        assert check_certificate(text, SQUARE, HALVES, bounds={"max_area": [2, 3]}, again=True)
        assert not check_certificate(text, SQUARE, HALVES, bounds={"max_area": [2, 4]})
        with pytest.raises(CertificateError, match="max_area"):
            check_certificate(text, SQUARE, HALVES)
        with pytest.raises(CertificateError, match="size"):
            check_certificate(text, SQUARE, HALVES, bounds={"max_area": [2, 3], "size": [1, 1]})

    def test_it_is_not(self) -> None:
        text = verify(SQUARE, HALVES, segments=[(0, 1)]).to_json()
        (difference,) = check_certificate(text, KITE, HALVES, segments=[(0, 1)]).differences
        assert difference.startswith("the mesh is another one: its sha256 is ")
        (difference,) = check_certificate(text, SQUARE, HALVES, segments=[(1, 0)]).differences
        assert difference.startswith("the segments are others: their sha256 is ")
        with pytest.raises(CertificateError, match="is about segments"):
            check_certificate(text, SQUARE, HALVES)
        with pytest.raises(CertificateError, match="is not about a domain"):
            check_certificate(text, SQUARE, HALVES, segments=[(0, 1)], domain=LAKE)

    def test_the_domain_and_its_rule(self) -> None:
        square = PSLG(SQUARE, RINGS)
        text = verify(SQUARE, HALVES, domain=square).to_json()
        assert check_certificate(text, SQUARE, HALVES, domain=square, again=True)
        for other in (
            PSLG(SQUARE, RINGS[::-1]),
            PSLG(SQUARE, RINGS, rule="even-odd"),
            PSLG(SQUARE, RINGS, holes=[(1, 0.5)]),
        ):
            (difference,) = check_certificate(text, SQUARE, HALVES, domain=other).differences
            assert "domain" in difference

    def test_again_finds_a_forged_verdict(self) -> None:
        document = json.loads(verify(KITE, HALVES).to_json())
        document["properties"]["delaunay"] |= {"verdict": "holds", "count": 0, "violations": []}
        document["ok"] = True
        assert check_certificate(json.dumps(document), KITE, HALVES)
        check = check_certificate(json.dumps(document), KITE, HALVES, again=True)
        assert check.differences == ("delaunay is fails (1 found), the certificate says holds",)

    @pytest.mark.parametrize(
        ("path", "value"),
        [
            ("ok", True),
            ("claims", []),
            ("claims", [1]),
            ("claims", ["delaunay", "pretty"]),
            ("properties.finite.verdict", "perhaps"),
            ("properties.pretty", {"verdict": "holds"}),
        ],
    )
    def test_contradictions_are_refused(self, path: str, value: object) -> None:
        document = json.loads(verify(KITE, HALVES).to_json())
        *above, last = path.split(".")
        part = document
        for name in above:
            part = part[name]
        part[last] = value
        with pytest.raises(CertificateError):
            read_certificate(json.dumps(document))

    def test_again_finds_forged_witnesses(self) -> None:
        document = json.loads(verify(KITE, HALVES).to_json())
        document["properties"]["delaunay"]["violations"][0]["magnitude"] = "1/7"
        check = check_certificate(json.dumps(document), KITE, HALVES, again=True)
        assert "not with its witnesses" in check.differences[0]
        document["exactmesh"] = "0.0.1"  # another version may say it in other words
        assert check_certificate(json.dumps(document), KITE, HALVES, again=True)

    def test_forged_counts(self) -> None:
        document = json.loads(verify(KITE, HALVES).to_json())
        document["mesh"]["triangles"] = 999
        assert not check_certificate(json.dumps(document), KITE, HALVES)

    def test_indices_beyond_63_bits_are_not_those_below_zero(self) -> None:
        below, beyond = np.array([(0, 1, -1)]), np.array([(0, 1, 2**64 - 1)], dtype=np.uint64)
        assert not check_certificate(verify(KITE, below).to_json(), KITE, beyond)

    def test_a_size_field_is_what_it_was_at_the_triangles(self) -> None:
        text = verify(KITE, HALVES, size=lambda xy: np.full(len(xy), 9.0)).to_json()
        assert check_certificate(text, KITE, HALVES, bounds={"size": np.full(2, 9.0)}, again=True)
        assert not check_certificate(text, KITE, HALVES, bounds={"size": np.full(2, 8.0)})

    def test_a_diagram_is_not_part_of_it(self) -> None:
        dual = voronoi([(0, 0), (4, 0), (1, 3), (5, 6)])
        assert dual.triangulation is not None
        text = verify(dual.points, dual.triangulation.triangles, dual=dual).to_json()
        with pytest.raises(CertificateError, match="does not hold the diagram"):
            check_certificate(text, dual.points, dual.triangulation.triangles, again=True)

    @pytest.mark.parametrize("read", [str, str.encode, json.loads, read_certificate])
    def test_in_whatever_form(self, read: Callable[[str], str | bytes | dict[str, object] | Certificate]) -> None:
        certificate = read(verify(KITE, HALVES).to_json())
        assert check_certificate(certificate, KITE, HALVES, again=True)
        assert not check_certificate(certificate, KITE, HALVES[::-1])

    @pytest.mark.parametrize("certificate", [None, 5, b"", b"\xff\xfe", {}, {"format": 5}, []])
    def test_none_in_another_form(self, certificate: object) -> None:
        with pytest.raises(CertificateError):
            check_certificate(certificate, KITE, HALVES)  # type: ignore[arg-type]  # as callers do

    def test_bounds_are_a_mapping(self) -> None:
        with pytest.raises(ShapeError, match="expected a mapping"):
            check_certificate(verify(KITE, HALVES).to_json(), KITE, HALVES, bounds=3)  # type: ignore[arg-type]  # as above

    def test_nested_too_deep(self) -> None:
        with pytest.raises(CertificateError):
            read_certificate("[" * 100_000)

    @pytest.mark.parametrize(
        "text",
        ["", "[]", "{", "1", '{"format": "exactmesh-report/1"}', json.dumps({"format": FORMAT}), '{"format": NaN}'],
    )
    def test_no_certificate(self, text: str) -> None:
        with pytest.raises(CertificateError):
            read_certificate(text)

    @pytest.mark.parametrize(
        ("path", "value"),
        [
            ("ok", 1),
            ("mesh", None),
            ("mesh.sha256", None),
            ("given", []),
            ("given.domain", "x"),
            ("given.bounds", {"min_angle": "sharp"}),
            ("given.bounds", {"min_angle": [1]}),
            ("given.bounds", {"colour": 3}),
            ("properties", {"delaunay": 3}),
            ("claims", "delaunay"),
        ],
    )
    def test_damaged(self, path: str, value: object) -> None:
        document = part = json.loads(verify(SQUARE, HALVES).to_json())
        *way, last = path.split(".")
        for name in way:
            part = part[name]
        part[last] = value
        with pytest.raises(CertificateError):
            check_certificate(json.dumps(document), SQUARE, HALVES)


@pytest.fixture
def inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def rewritten(path: str, points: npt.NDArray[np.float64], triangles: npt.NDArray[np.int32]) -> None:
    write(path, Mesh(points, triangles=triangles))


@pytest.mark.usefixtures("inside")
class TestCommand:
    """Law: ``verify --json`` writes what ``check-certificate`` accepts, 0, and for another mesh refuses, 1; without a
    certificate, or what it is about, it is 2 and one line."""

    def test_points(self, capsys: pytest.CaptureFixture[str]) -> None:
        mesh = delaunay(np.random.default_rng(2).random((20, 2)))
        rewritten("a.ele", mesh.points, mesh.triangles)
        assert main(["verify", "a.ele", "--json", "a.json", "--html", "a.html"]) == 0
        assert "<!doctype html>" in Path("a.html").read_text(encoding="utf-8")
        assert main(["check-certificate", "a.json", "a.ele"]) == 0
        assert main(["check-certificate", "a.json", "a.ele", "--again"]) == 0
        told = capsys.readouterr().out
        assert "a.json is the certificate of a.ele, sha256 " in told
        assert "it says: every claim holds" in told
        assert "verified again: every claim holds" in told
        rewritten("a.ele", mesh.points, mesh.triangles[::-1].copy())
        assert main(["check-certificate", "a.json", "a.ele"]) == 1
        assert "NOT the certificate of a.ele" in capsys.readouterr().out

    def test_claims_that_do_not_hold(self, capsys: pytest.CaptureFixture[str]) -> None:
        """``check-certificate CERT MESH && ship`` ships no bad mesh, although CERT is that of MESH."""
        rewritten(
            "bad.ele",
            np.array([(0.0, 0.0), (3.0, -1.0), (6.0, 0.0), (3.0, 1.0)]),
            np.array([(0, 1, 2), (0, 2, 3)], dtype=np.int32),
        )
        assert main(["verify", "bad.ele", "--json", "bad.json"]) == 1
        assert main(["check-certificate", "bad.json", "bad.ele"]) == 1
        assert main(["check-certificate", "bad.json", "bad.ele", "--again"]) == 1
        told = capsys.readouterr().out
        assert "bad.json is the certificate of bad.ele" in told
        assert "verified again: NOT every claim holds" in told
        assert main(["verify", "bad.ele", "--claim", "admissible", "--json", "less.json"]) == 0
        assert main(["check-certificate", "less.json", "bad.ele"]) == 0  # control

    def test_domains(self, capsys: pytest.CaptureFixture[str]) -> None:
        from exactmesh.io import write_pslg

        write_pslg("lake.poly", LAKE, base=1)
        assert main(["triangulate", "lake.poly"]) == 0
        assert main(["verify", "lake.1.ele", "--json", "own.json"]) == 0
        assert main(["check-certificate", "own.json", "lake.1.ele", "--again"]) == 0
        assert main(["verify", "lake.1.ele", "--domain", "lake.poly", "--json", "its.json"]) == 0
        assert main(["check-certificate", "its.json", "lake.1.ele", "--domain", "lake.poly", "--again"]) == 0
        write_pslg("lake.poly", PSLG(LAKE.points, LAKE.segments[1:]), base=1)
        capsys.readouterr()
        assert main(["check-certificate", "its.json", "lake.1.ele", "--domain", "lake.poly"]) == 1
        assert "the domain is another one" in capsys.readouterr().out

    def test_carved_by_another_rule(self) -> None:
        from exactmesh.io import write_pslg

        write_pslg("lake.poly", PSLG(LAKE.points, LAKE.segments), base=1)
        assert main(["triangulate", "lake.poly", "--carve", "even-odd"]) == 0
        arguments = ["lake.1.ele", "--domain", "lake.poly"]
        assert main(["verify", *arguments, "--carve", "even-odd", "--json", "its.json"]) == 0
        assert main(["check-certificate", "its.json", *arguments, "--again"]) == 0

    def test_bad_input(self, capsys: pytest.CaptureFixture[str]) -> None:
        mesh = delaunay(SQUARE)
        rewritten("a.ele", mesh.points, mesh.triangles)
        text = verify(mesh.points, mesh.triangles, domain=PSLG(SQUARE, RINGS)).to_json()
        Path("domain.json").write_text(text, encoding="utf-8")
        Path("bad.json").write_text("{}", encoding="utf-8")
        Path("bytes.json").write_bytes(b"\xff\xfe")
        for name, told in (
            ("nix.json", "nix.json: no such file"),
            ("bad.json", "bad.json: no certificate of format"),
            ("bytes.json", "bytes.json: "),
            ("a.ele", "a.ele: no certificate: "),
            ("a.ele", "(the order is CERT MESH)"),
            ("domain.json", "about a domain, and the mesh has no segments: --domain FILE"),
        ):
            assert main(["check-certificate", name, "a.ele"]) == 2
            error = capsys.readouterr().err
            assert told in error
            assert error.count("\n") == 1
