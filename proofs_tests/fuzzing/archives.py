"""``.npz``: any bytes, and any arrays in an archive that is sound as such."""

import io
import struct
import zipfile
from collections.abc import Sequence

import numpy as np
from proofs_tests.fuzzing.judging import Target
from proofs_tests.fuzzing.places import clean, names_its_file
from proofs_tests.fuzzing.sameness import require_same_meshes

from exactmesh.errors import FileFormatError
from exactmesh.io import Mesh, read, write

__all__ = ["TARGETS"]

_NAMES = (
    *("points", "triangles", "neighbors", "edges", "point_attributes", "point_markers", "triangle_attributes"),
    *("edge_markers", "segments", "segment_markers", "holes", "regions", "base", "other"),
)
_WORDS = (
    *(b"'descr': ", b"'<f8'", b"'<i4'", b"'|O'", b"'fortran_order': True", b"'shape': (", b"(99999999, 2)", b"'>f8'"),
    *(b"\x93NUMPY\x01\x00", b"PK\x03\x04", b"PK\x01\x02", b"PK\x05\x06", b"-1", b"L"),
)


def _npz(data: bytes) -> None:
    path = clean(npz=data).with_suffix(".npz")
    try:
        mesh = read(path)
    except FileFormatError as error:
        names_its_file(error)
        raise
    again = clean().with_suffix(".npz")
    write(again, mesh)
    require_same_meshes(mesh, read(again))


def _members(data: bytes) -> None:
    """Read members as (name's number, flags, size of two bytes, content): their checksums are right."""
    stream, at = io.BytesIO(), 0
    with zipfile.ZipFile(stream, "w") as archive:
        while at + 4 <= len(data) and at < 1 << 14:
            name, flags, size = struct.unpack_from("<BBH", data, at)
            info = zipfile.ZipInfo(f"{_NAMES[name % len(_NAMES)]}{'' if flags & 2 else '.npy'}")
            info.compress_type = zipfile.ZIP_DEFLATED if flags & 1 else zipfile.ZIP_STORED
            if info.filename not in archive.namelist():
                archive.writestr(info, data[at + 4 : at + 4 + size])
            at += 4 + size
    _npz(stream.getvalue())


def _meshes() -> list[Mesh]:
    points = np.array([(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)])
    return [
        Mesh(points),
        Mesh(points, triangles=[(0, 1, 2), (0, 2, 3)], neighbors=[(-1, 1, -1), (-1, -1, 0)], point_markers=range(4)),
        Mesh(points, segments=[(0, 1)], holes=[(1, 1)], regions=[(1, 1, 3, 0.5)], segment_markers=[4], base=1),
    ]


def _npz_seeds() -> Sequence[bytes]:
    found = []
    for mesh in _meshes():
        path = clean().with_suffix(".npz")
        write(path, mesh)
        found.append(path.read_bytes())
    return found


def _member_seeds() -> Sequence[bytes]:
    found = []
    for archived in _npz_seeds():
        with zipfile.ZipFile(io.BytesIO(archived)) as archive:
            parts: list[bytes] = []
            for info in archive.infolist():
                content = archive.read(info)
                number = _NAMES.index(info.filename.removesuffix(".npy"))
                parts.append(struct.pack("<BBH", number, len(parts) & 1, len(content)) + content)
            found.append(b"".join(parts))
    return found


TARGETS = (Target("npz", _npz, _npz_seeds, _WORDS), Target("members", _members, _member_seeds, _WORDS))
