"""``.poly``: a planar straight line graph: points (or those of the ``.node`` beside it), segments, holes, regions."""

import os
from collections.abc import Iterator
from dataclasses import replace
from itertools import islice

import numpy as np
import numpy.typing as npt

from exactkernel.types import FloatArray
from exactmesh.errors import PSLGError
from exactmesh.io.model import Mesh
from exactmesh.io.node import node_header, node_rows, node_text, points_of, read_node
from exactmesh.io.text import TextFile, rows_of_text
from exactmesh.pslg import PSLG

__all__ = [
    "has_points",
    "mesh_of_pslg",
    "poly_text",
    "pslg_of",
    "read_poly",
    "read_segments",
    "segments_text",
]

_FIELDS_OF_A_REGION = (4, 5)


def read_poly(path: str | TextFile) -> tuple[Mesh, bool]:
    """Return the points, segments, holes and regions of a ``.poly`` file, and whether the points are in that file.

    Four sections: the points as in a ``.node`` file, or ``0``: the points are in the ``.node`` file beside it; header
    ``S has_markers``, then ``i a b [marker]``; header ``H``, then ``i x y``; and, if it is there, header ``R``, then
    ``i x y attribute [area]``, where an area that is missing is the attribute again, as it is for Triangle. Indices
    count as the points do; segments, holes and regions are numbered from 0 or 1. Linear time.

    Raises:
        FileFormatError: where and what.
    """
    file = TextFile.of(path)
    count, attributes, markers = node_header(file)
    rows, rest = file.section(node_rows(file, count, attributes, markers), count)
    nodes = points_of(file, rows, markers) if count else read_node(os.path.splitext(file.path)[0] + ".node")
    return _with_segments(nodes, rest), count > 0


def has_points(path: str) -> bool:
    """Tell whether a ``.poly`` file has points of its own. FileFormatError if its header cannot be read."""
    return node_header(TextFile.load(path))[0] > 0


def read_segments(path: str | TextFile, nodes: Mesh) -> Mesh:
    """Return the mesh with what a ``.poly`` file adds to its ``.node``; as it is, if the file has points of its own.

    Raises:
        FileFormatError: as for :func:`read_poly`.
    """
    file = TextFile.of(path)
    count, attributes, markers = node_header(file)
    if count:
        return nodes
    return _with_segments(nodes, file.section(node_rows(file, 0, attributes, markers), 0)[1])


def _with_segments(nodes: Mesh, file: TextFile) -> Mesh:
    base = nodes.base
    count, markers = file.header(("number of segments", "number of markers"), (0, 0))
    if markers > 1:
        raise file.fault(f"{markers} markers a segment; there can be 0 or 1", line=file.line_of(-1))
    rows, holes = file.section(file.row_type(count, "segment", integers=2, markers=markers), count)
    _numbered(file, rows["number"], "segment")
    file.in_range(rows["integers"], base, base + len(nodes.points) - 1, "point")
    (count,) = holes.header(("number of holes",), (0,))
    seeds, regions = holes.section(holes.row_type(count, "hole", reals=2), count)
    _numbered(holes, seeds["number"], "hole")
    return replace(
        nodes,
        segments=(rows["integers"] - base).astype(np.int32),
        segment_markers=rows["marker"] if markers else None,
        holes=seeds["reals"],
        regions=_regions(regions),
    )


def _numbered(file: TextFile, numbers: npt.NDArray[np.int64], what: str) -> None:
    """Triangle reads no number of a segment, hole or region, so that people count these from 0 or 1 as they like."""
    file.numbered(numbers, 1 if numbers[:1].tolist() == [1] else 0, what)


def _regions(file: TextFile) -> FloatArray | None:
    """Return x, y, attribute, area of each region, line by line: there are few, and rows may differ in length."""
    if next(file.data_lines(), None) is None:
        return None
    (count,) = file.header(("number of regions",), (0,))
    rows: list[list[int | float]] = []
    for line, fields in islice(file.data_lines(), 1, None):
        if len(rows) == count:
            raise file.fault("content after the last region", line=line)
        if len(fields) not in _FIELDS_OF_A_REGION:
            raise file.fault(f"{len(fields)} fields; a region has x, y, attribute, perhaps an area", line=line)
        types = [int, *[float] * (len(fields) - 1)]
        values = [file.number(text, kind, line) for text, kind in zip(fields, types, strict=True)]
        rows.append([*values, values[-1]][: _FIELDS_OF_A_REGION[1]])
    if len(rows) < count:
        raise file.fault(f"the header announces {count} regions, the file ends after {len(rows)}")
    _numbered(file, np.array([row[0] for row in rows], dtype=np.int64), "region")
    return np.array([row[1:] for row in rows], dtype=np.float64).reshape(-1, 4)


def pslg_of(mesh: Mesh, path: str) -> PSLG:
    """Return the points and segments of a mesh as a PSLG, to be carved by seeds.

    Raises:
        PSLGError: it has faults; the message names the file.
    """
    try:
        return PSLG(
            mesh.points,
            () if mesh.segments is None else mesh.segments,
            holes=mesh.holes,
            regions=mesh.regions,
            point_markers=mesh.point_markers,
            segment_markers=mesh.segment_markers,
            point_attributes=mesh.point_attributes,
        )
    except PSLGError as error:
        raise PSLGError(error.faults, path=path, base=mesh.base) from None


def mesh_of_pslg(pslg: PSLG, base: int) -> Mesh:
    """Return what a ``.poly`` file can hold of a PSLG: everything but the rule."""
    return Mesh(
        pslg.points,
        segments=pslg.segments,
        holes=pslg.holes,
        regions=pslg.regions,
        point_markers=pslg.point_markers,
        segment_markers=pslg.segment_markers,
        point_attributes=pslg.point_attributes,
        base=base,
    )


def segments_text(mesh: Mesh) -> Iterator[str]:
    """Yield the text of a ``.poly`` file beside a ``.node`` file, as Triangle writes it."""
    attributes = 0 if mesh.point_attributes is None else mesh.point_attributes.shape[1]
    yield f"0 2 {attributes} {int(mesh.point_markers is not None)}\n"
    yield from _sections(mesh)


def poly_text(mesh: Mesh) -> Iterator[str]:
    """Yield the text of a ``.poly`` file with points of its own, that :func:`read_poly` reads back bit for bit."""
    yield from node_text(mesh)
    yield from _sections(mesh)


def _sections(mesh: Mesh) -> Iterator[str]:
    segments = np.zeros((0, 2), dtype=np.int32) if mesh.segments is None else mesh.segments
    yield f"{len(segments)} {int(mesh.segment_markers is not None)}\n"
    columns = [_numbers(mesh, len(segments)), segments + np.int64(mesh.base), mesh.segment_markers]
    yield from rows_of_text(column for column in columns if column is not None)
    for seeds in (mesh.holes, mesh.regions):
        if seeds is not None:
            yield f"{len(seeds)}\n"
            yield from rows_of_text([_numbers(mesh, len(seeds)), seeds])
        elif seeds is mesh.holes:
            yield "0\n"


def _numbers(mesh: Mesh, count: int) -> npt.NDArray[np.int64]:
    return np.arange(mesh.base, mesh.base + count, dtype=np.int64)
