"""What fuzzing found, by name, with the bytes."""

import io
import json
import struct
import zipfile
from pathlib import Path

import numpy as np
import pytest
from proofs_tests.fuzzing.judging import judged, limited
from proofs_tests.fuzzing.targets import TARGETS

from exactmesh import PSLG
from exactmesh.adapters import given_mesh
from exactmesh.adapters.meshio_mesh import given_cells
from exactmesh.errors import AdapterError, CertificateError, FileFormatError, GeometryError
from exactmesh.io import read
from exactmesh.verify import read_certificate, verify


@pytest.mark.obligation("P5", "what fuzzing found is refused, at once and by a typed error", method="named cases")
class TestFound:
    """Inputs that once broke the law: each is refused by a typed error that says why, at once."""

    def test_npz_header_with_an_open_bracket(self, tmp_path: Path) -> None:
        """tokenize.TokenError came out of numpy's parser of headers."""
        text = b"{" + b" " * 117
        member = b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text
        path = tmp_path / "a.npz"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("points.npy", member)
        with pytest.raises(FileFormatError, match=r"a\.npz: is no readable \.npz archive"):
            read(path)

    @pytest.mark.parametrize("kind", [np.array([1, 2]), np.array(["Point", "Polygon"]), ["Feature"], None, 3])
    def test_geojson_type_that_is_an_array(self, kind: object) -> None:
        """ValueError: the truth value of an array is ambiguous."""
        with pytest.raises(GeometryError, match=r"type is .*, no type of GeoJSON"):
            PSLG.from_geojson({"type": kind})

    def test_shapely_collection_with_a_curve(self) -> None:
        """NotImplementedError: GEOS reads curves that shapely has no class for."""
        shapely = pytest.importorskip("shapely")
        try:
            curved = shapely.from_wkt("GEOMETRYCOLLECTION (POINT (0 0), CIRCULARSTRING (0 0, 1 1, 2 0))")
        except shapely.GEOSException:
            pytest.skip("a GEOS without curves")
        with pytest.raises(GeometryError, match=r"geometry\.geoms\[1\] is curved"):
            PSLG.from_shapely(curved)
        with pytest.raises(AdapterError, match=r"holds one that is curved"):
            given_mesh(curved)

    @pytest.mark.parametrize("kind", ["polygon", "hexahedron"])
    @pytest.mark.parametrize("rows", [3, np.array(3), None, [[0, 1, 2], [2]]], ids=["int", "array", "None", "ragged"])
    def test_meshio_cells_without_a_length(self, kind: str, rows: object) -> None:
        """TypeError: len() of unsized object; ValueError: inhomogeneous shape."""
        blocks = [("triangle", [[0, 1, 2]]), (kind, rows)]
        with pytest.raises(AdapterError, match=rf"a mesh has cells of type '{kind}'"):
            given_cells(np.zeros((3, 2)), blocks, "a mesh")

    @pytest.mark.parametrize("name", ["segments", "domain", "labels"])
    def test_certificate_without_a_part(self, name: str) -> None:
        """KeyError: what may be null was taken for there when it was not."""
        document = json.loads(verify([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)]).to_json())
        del document["given"][name]
        with pytest.raises(CertificateError, match=rf"the certificate has no proper 'given\.{name}'"):
            read_certificate(document)

    @pytest.mark.parametrize("domain", [{}, {"rule": None}, {"rule": 3}])
    def test_certificate_of_a_domain_without_a_rule(self, domain: object) -> None:
        """KeyError: the rule of a domain was looked up unseen."""
        document = json.loads(verify([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)]).to_json())
        document["given"]["domain"] = domain
        with pytest.raises(CertificateError, match=r"the certificate has no proper 'given\.domain\.rule'"):
            read_certificate(document)

    def test_meshb_that_claims_a_billion_vertices(self, tmp_path: Path) -> None:
        """MemoryError: tens of gigabytes for a file of 40 bytes, where that much cannot be had."""
        path = tmp_path / "a.meshb"
        path.write_bytes(
            bytes.fromhex("01000000 03000000 03000000 30000000 00000000 03000000 30000000") + b"\0" * 5 + b"0" * 7
        )
        with limited(), pytest.raises(FileFormatError, match=r"a\.meshb: meshio asks for more memory than there is"):
            given_mesh(path)

    @pytest.mark.parametrize("triangles", [3, 40, 4000])
    def test_wkt_that_breaks_off(self, tmp_path: Path, triangles: int) -> None:
        """A broken TIN of n triangles took meshio's pattern c^n steps: three triangles two seconds, forty for ever."""
        path = tmp_path / "a.wkt"
        path.write_text("TIN (" + "((0.0 0.0 0.0, 1.0 0.0 0.0, 0.0 1.0 0.0, 0.0 0.0 0.0)), " * triangles + "((0.0")
        with limited(), pytest.raises(FileFormatError, match=r"a\.wkt: is no TIN"):
            given_mesh(path)

    def test_control_a_sound_wkt_is_read(self, tmp_path: Path) -> None:
        """The check of the text refuses no TIN that meshio reads."""
        path = tmp_path / "a.wkt"
        corners = ("0 0 0", "1 0 0.", "+1.5 1 -.0", "0 1 0")
        rings = [(corners[0], corners[1], corners[2], corners[0]), (corners[0], corners[2], corners[3], corners[0])]
        path.write_text("  TIN (" + " , ".join(f"( (  {' , '.join(ring)} ) )" for ring in rings) + " )\n")
        assert given_mesh(path).triangles.tolist() == [[0, 1, 2], [0, 2, 3]]

    def test_control_what_is_cut_off_is_an_archive_no_more(self) -> None:
        """An archive of the same kind that is sound is read."""
        stream = io.BytesIO()
        np.savez(stream, points=np.zeros((1, 2)))
        assert judged(TARGETS["npz"], stream.getvalue()) is None
