"""Files of other packages' formats, through meshio: cut off, spoilt, or sound."""

import contextlib
import io
from collections.abc import Sequence

from proofs_tests.fuzzing.judging import Target, require
from proofs_tests.fuzzing.places import clean

from exactmesh.adapters import given_mesh
from exactmesh.errors import FileFormatError
from exactmesh.verify import verify

__all__ = ["SUFFIXES", "TARGETS"]

#: The formats that Python reads: the first byte chooses.
SUFFIXES = (
    *("off", "obj", "mesh", "su2", "inp", "bdf", "vol", "avs", "post", "dat", "tec", "ply", "mdpa", "msh", "vtk"),
    *("vtu", "stl", "xml", "wkt", "f3grid", "ugrid", "node", "meshb", "nas", "dato", "tin", "xyz"),
)
_WORDS = (
    *(
        b"OFF\n",
        b"3 0 1 2\n",
        b"$Nodes\n",
        b"$EndNodes\n",
        b"$Elements\n",
        b"*NODE\n",
        b"*ELEMENT, TYPE=CPS3\n",
        b"GRID,",
    ),
    *(b"Vertices\n", b"Triangles\n", b"End\n", b"f 1 2 3\n", b"v 0 0 0\n", b"NELEM= 2\n", b"CELLS 2 8\n", b"ENDDATA"),
    *(
        b"POINTS 4 double\n",
        b"element vertex 4\n",
        b"999999999",
        b"-1",
        b"binary",
        b"ascii",
        b"Begin Nodes",
        b"End Nodes",
    ),
)


def _foreign(data: bytes) -> None:
    suffix = SUFFIXES[(data[0] if data else 0) % len(SUFFIXES)]
    path = clean(**{suffix: data[1:]}).with_suffix(f".{suffix}")
    try:
        given = given_mesh(path)
    except FileFormatError as error:
        require(str(path) in str(error), f"{error} names no file")
        raise
    require(str(verify(given.points, given.triangles)), "a report without words")


def _foreign_seeds() -> Sequence[bytes]:
    import meshio

    mesh = meshio.Mesh(
        [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)], [("triangle", [[0, 1, 2], [0, 2, 3]])]
    )
    found = []
    for i, suffix in enumerate(SUFFIXES):
        path = clean().with_suffix(f".{suffix}")
        said = io.StringIO()
        with (
            contextlib.suppress(Exception, SystemExit),
            contextlib.redirect_stdout(said),
            contextlib.redirect_stderr(said),
        ):
            kinds = meshio.extension_to_filetypes.get(f".{suffix}", [])
            meshio.write(path, mesh, kinds[0] if kinds else None)
            found.append(bytes([i]) + path.read_bytes())
    return found


TARGETS = (Target("foreign", _foreign, _foreign_seeds, _WORDS),)
