"""Triangle's text formats and ``.csv``: alone, and beside one another."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from proofs_tests.fuzzing.judging import Target, require
from proofs_tests.fuzzing.places import STEM, clean, names_its_file
from proofs_tests.fuzzing.sameness import require_same_dictionaries, require_same_meshes, same

from exactmesh import PSLG, constrained_delaunay
from exactmesh.errors import ExactMeshError, FileFormatError, PSLGError
from exactmesh.io import Mesh, read, read_areas, read_pslg, write, write_areas, write_pslg, write_voronoi
from exactmesh.triangle import TriangleDict, load, loads

__all__ = ["TARGETS"]

_WORDS = (
    b"0 2 0 0\n",
    b"1 0",
    b"-1",
    b"\n",
    b"#",
    b"1e308",
    b"5e-324",
    b"9999999999",
    b"nan",
    b"inf",
    b"1.5e-3",
    b"\r\n",
)
_KINDS = ("node", "ele", "poly", "neigh", "edge", "area")
_BETWEEN = b"\n%%\n"
_SQUARE = PSLG(
    [(0, 0), (4, 0), (4, 4), (0, 4), (1, 1), (3, 1), (2, 3), (0.1, 3.5)],
    [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 4)],
    holes=[(2, 2)],
    regions=[(0.5, 0.5, 7.0, 1.0)],
    point_markers=range(8),
    segment_markers=[1, 2, 3, 4, 5, 6, 7],
    point_attributes=[[0.5 * k, -1e-300] for k in range(8)],
)


def contents_of_files() -> list[dict[str, bytes]]:
    """Return what the writers make of a triangulation, with either base, and of a graph."""
    mesh = constrained_delaunay(_SQUARE)
    bare = Mesh(mesh.points, triangles=mesh.triangles, neighbors=mesh.neighbors, edges=mesh.edges)
    found = []
    for content in (mesh, bare, Mesh(mesh.points, triangles=mesh.triangles, base=1)):
        stem = clean()
        write(stem.with_suffix(".node"), content)
        write_areas(stem.with_suffix(".area"), np.full(len(mesh.triangles), 0.25))
        found.append(_there(stem))
    for base in (0, 1):
        stem = clean()
        write_pslg(stem.with_suffix(".poly"), _SQUARE, base=base)
        found.append(_there(stem))
    stem = clean()
    write_voronoi(f"{stem}.v.node", mesh)
    found.append({"node": Path(f"{stem}.v.node").read_bytes(), "edge": Path(f"{stem}.v.edge").read_bytes()})
    return found


def _there(stem: Path) -> dict[str, bytes]:
    return {path.suffix[1:]: path.read_bytes() for path in sorted(stem.parent.iterdir())}


def _seeds_of(kind: str) -> Callable[[], list[bytes]]:
    def seeds() -> list[bytes]:
        hand_made = {"area": [b"2\n1 0.5\n2 -1\n"], "poly": [b"3 2\n1 0 0\n2 1 0\n3 0 1\n3\n1 1 2\n2 2 3\n3 3 1\n0\n"]}
        return [files[kind] for files in contents_of_files() if kind in files] + hand_made.get(kind, [])

    return seeds


_BESIDE: dict[str, bytes] = {}


def _beside() -> dict[str, bytes]:
    """The sound files beside the one that is not."""
    if not _BESIDE:
        _BESIDE.update(contents_of_files()[1])
    return _BESIDE


def _read_beside(kind: str, *others: str) -> Callable[[bytes], None]:
    def run(data: bytes) -> None:
        around = {other: _beside()[other] for other in others}
        stem = clean(**around, **{kind: data})
        _read_and_write(stem.with_suffix(f".{kind}"), kind)

    return run


def _read_and_write(path: Path, kind: str) -> None:
    try:
        mesh = read(path)
    except (FileFormatError, PSLGError) as error:
        names_its_file(error)
        raise
    again = clean().with_suffix(".csv" if kind == "csv" else ".node")
    write(again, mesh)
    require_same_meshes(mesh, read(again))


def _poly(data: bytes) -> None:
    path = clean(node=_beside()["node"], poly=data).with_suffix(".poly")
    try:
        pslg = read_pslg(path)
    except (FileFormatError, PSLGError) as error:
        names_its_file(error)
        raise
    again = clean().with_suffix(".poly")
    write_pslg(again, pslg, base=len(data) % 2)
    found = read_pslg(again)
    require(found == pslg, f"{pslg!r} is read again as {found!r}")
    require(same(found.points, pslg.points), "zeros change their sign")


def _area(data: bytes) -> None:
    path = clean(area=data).with_suffix(".area")
    try:
        areas = read_areas(path)
    except FileFormatError as error:
        names_its_file(error)
        raise
    write_areas(path, areas, base=len(data) % 2)
    require(same(read_areas(path), areas), "areas are read again as others")


def _siblings(data: bytes) -> None:
    """Read several files that belong together, from a folder and from strings."""
    parts = dict(zip(_KINDS, data.split(_BETWEEN), strict=False))
    texts = {kind: content for kind, content in parts.items() if content}
    stem = clean(**texts)
    found = _loaded(stem)
    try:
        strings = {kind: content.decode().removeprefix("\ufeff") for kind, content in texts.items()}
    except UnicodeDecodeError:
        strings = {}
    if found is not None and strings:
        require_same_dictionaries(found, loads(**strings))
    if texts:
        _read_and_write(
            stem.with_suffix(f".{next(iter(texts))}") if "node" not in texts else stem.with_suffix(".node"), ""
        )


def _loaded(stem: Path) -> TriangleDict | None:
    try:
        return load(stem.parent, STEM)
    except FileFormatError as error:
        names_its_file(error)
        return None
    except ExactMeshError:
        return None


def _csv_seeds() -> Sequence[bytes]:
    stem = clean()
    write(stem.with_suffix(".csv"), Mesh([(0, 0), (1.5, 2)], point_markers=[1, 2], point_attributes=[[0.5], [1e-5]]))
    made = stem.with_suffix(".csv").read_bytes()
    return [made, b"x,y\n0,0\n1,2\n", b"0 0\n1 2\n", b'name;x;y\n"a;b";1;2\n# no\n', b"y\tx\n1\t2\n"]


def _seeds_of_siblings() -> list[bytes]:
    return [_BETWEEN.join(files.get(kind, b"") for kind in _KINDS) for files in contents_of_files()]


TARGETS = (
    Target("node", _read_beside("node"), _seeds_of("node"), _WORDS),
    Target("ele", _read_beside("ele", "node"), _seeds_of("ele"), _WORDS),
    Target("edge", _read_beside("edge", "node"), _seeds_of("edge"), _WORDS),
    Target("neigh", _read_beside("neigh", "node", "ele"), _seeds_of("neigh"), _WORDS),
    Target("poly", _poly, _seeds_of("poly"), _WORDS),
    Target("area", _area, _seeds_of("area"), _WORDS),
    Target("csv", _read_beside("csv"), _csv_seeds, (b"x", b"y", b"marker", b"attribute", b";", b",", b'"', *_WORDS)),
    Target("siblings", _siblings, _seeds_of_siblings, (_BETWEEN, *_WORDS)),
)
