"""From a file of points, or of a planar straight line graph, to files of its triangulation."""

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from math import ldexp, sqrt

import numpy as np
import numpy.typing as npt

from exactkernel.jit import is_cache_warm
from exactmesh.constrain import Crossings, constrain_range, constrained_delaunay
from exactmesh.delaunay import Progress, delaunay, insert_range
from exactmesh.errors import ChoiceError, CrossingError, ExactMeshError, FileFormatError, OptionError, PSLGError
from exactmesh.io import Mesh, mesh_of, read_graph, read_points, write
from exactmesh.io.poly import has_points
from exactmesh.progress import working
from exactmesh.pslg import PSLG, Carve
from exactmesh.refinement import Reason, Refinement, Steiner, refine
from exactmesh.refinement.ruppert import run
from exactmesh.triangulation import Triangulation

__all__ = ["Quality", "files_of", "next_name", "refine_points", "triangulate_graph", "triangulate_points"]

_DEFAULT_ANGLE = 20.0
_NAMED = 3  # duplicates that a line spells out
_HULL = "--carve none"
_SPLIT = "--crossings split makes their crossings vertices"
_TOGETHER = (".node", ".ele", ".poly")


@dataclass(frozen=True)
class Quality:
    """What the command asks of refinement; see :func:`exactmesh.refine`."""

    min_angle: float | None = None
    max_area: float | None = None
    conforming: bool = False
    steiner: str | None = None
    max_steiner: int | None = None
    min_edge: float | None = None

    def refined(self, mesh: Triangulation, progress: Progress) -> Refinement:
        """Refine a triangulation."""
        return refine(
            mesh,
            min_angle=_DEFAULT_ANGLE if self.min_angle is None else self.min_angle,
            max_area=self.max_area,
            conforming=self.conforming,
            steiner=Steiner.ANYWHERE if self.steiner is None else Steiner(self.steiner),
            max_steiner=self.max_steiner,
            min_edge=self.min_edge,
            progress=progress,
        )


def files_of(path: str) -> set[str]:
    """Return the files that are read or written under this name: of Triangle's formats, all with the same stem."""
    stem, suffix = os.path.splitext(path)
    names = [stem + other for other in _TOGETHER] if suffix in _TOGETHER else [path]
    return {os.path.realpath(name) for name in names}


def next_name(source: str) -> str:
    """Return the name of the output as Triangle gives it.

    >>> next_name("x.poly"), next_name("x.1.node")
    ('x.1.node', 'x.2.node')
    """
    stem = os.path.splitext(source)[0]
    numbered = re.fullmatch(r"(.+)\.([0-9]+)", stem)
    return f"{numbered[1]}.{int(numbered[2]) + 1}.node" if numbered else f"{stem}.1.node"


def triangulate_points(source: str, target: str, seed: int) -> Iterator[str]:
    """Write the Delaunay triangulation of the points in a file; yield lines that say what was done."""
    with working(f"reading {source}"):
        points = read_points(source)
    with working("triangulating", compiling=not is_cache_warm(insert_range)) as progress:
        try:
            triangulation = delaunay(points.points, seed=seed, progress=progress)
        except ExactMeshError as error:
            raise FileFormatError(str(error), path=source) from error
    first = np.flatnonzero(np.diff(np.maximum.accumulate(triangulation.representative), prepend=-1))
    attributes, markers = points.point_attributes, points.point_markers
    mesh = replace(
        mesh_of(triangulation),
        point_attributes=None if attributes is None else attributes[first],
        point_markers=None if markers is None else markers[first],
        segments=np.zeros((0, 2), dtype=np.int32) if _would_be_read(_beside(target, ".poly")) else None,
        base=points.base,
    )
    paths = _write(target, mesh)
    left_out = np.delete(np.arange(len(points.points)), first)
    kept = first[triangulation.representative[left_out[:_NAMED]]]
    yield from _duplicates(len(points.points), left_out, kept, points.base)
    yield f"{len(triangulation.points)} points, {len(triangulation.triangles)} triangles: {' '.join(paths)}"


def triangulate_graph(
    source: str, target: str, seed: int, carve: Carve | bool, crossings: Crossings, quality: Quality | None = None
) -> Iterator[str]:
    """Write the constrained Delaunay triangulation of the graph in a file, refined if asked; yield what was done."""
    with working(f"reading {source}"):
        pslg, base = read_graph(source)
    yield from _written(pslg, base, source, target, seed, carve, crossings, quality)


def refine_points(source: str, target: str, seed: int, quality: Quality) -> Iterator[str]:
    """Write a refined triangulation of the hull of the points in a file; yield lines that say what was done."""
    with working(f"reading {source}"):
        points, base = read_graph(source)
    try:
        hull = delaunay(points.points, seed=seed)
    except ExactMeshError as error:
        raise FileFormatError(str(error), path=source) from error
    first = np.flatnonzero(np.diff(np.maximum.accumulate(hull.representative), prepend=-1))
    loop = first[hull.hull]
    pslg = PSLG(
        points.points,
        np.stack([loop, np.roll(loop, -1)], axis=1),
        point_markers=points.point_markers,
        point_attributes=points.point_attributes,
    )
    yield from _written(pslg, base, source, target, seed, True, Crossings.ERROR, quality)


def _written(
    pslg: PSLG, base: int, source: str, target: str, seed: int, carve: Carve | bool, crossings: Crossings,
    quality: Quality | None,
) -> Iterator[str]:  # fmt: skip
    needed = (insert_range, constrain_range, *((run,) if quality is not None else ()))
    refinement = None
    with working("triangulating", compiling=not is_cache_warm(*needed)) as progress:
        try:
            mesh = constrained_delaunay(pslg, carve=carve, crossings=crossings, seed=seed, progress=progress)
            if quality is not None:
                refinement = quality.refined(mesh, progress)
                mesh = refinement.triangulation
        except PSLGError as error:
            raise PSLGError(error.faults, path=source, base=base, hull=_HULL) from None
        except CrossingError as error:
            raise CrossingError(
                error.pairs, pslg.points, pslg.segments, path=source, base=base, remedy=_SPLIT
            ) from None
        except (OptionError, ChoiceError):
            raise
        except ExactMeshError as error:
            raise FileFormatError(str(error), path=source) from error
    paths = _write(target, replace(mesh_of(mesh), base=base))
    duplicates = pslg.duplicates
    yield from _duplicates(len(pslg.points), duplicates, pslg.representative[duplicates[:_NAMED]], base)
    yield f"{', '.join(_facts(pslg, mesh))}: {' '.join(paths)}"
    if refinement is not None:
        yield ", ".join(_account(refinement))


def _account(done: Refinement) -> Iterator[str]:
    """Yield what refinement did, and what it left undone."""
    statistics = done.triangulation.statistics()
    yield f"{len(done.steiner)} Steiner points"
    yield f"angles {statistics.smallest_angle:.4g} to {statistics.largest_angle:.4g} degrees"
    if done.displacement:
        yield f"segments moved by at most {done.displacement:.3g}"
    for reason in Reason:
        count = int((done.reasons == reason).sum())
        if count:
            yield f"{count} triangles left as they are: {reason.name.lower().replace('_', ' ')}"


def _facts(pslg: PSLG, mesh: Triangulation) -> Iterator[str]:
    yield f"{len(mesh.points)} points"
    yield f"{len(mesh.triangles)} triangles"
    yield f"{len(mesh.segments)} segments"
    outside = int(np.count_nonzero(mesh.representative[: len(pslg.points)] < 0))
    if outside:
        yield f"{outside} points outside of the domain left out"
    if mesh.arrangement is not None:
        farthest = mesh.arrangement.max_distance_squared
        moved = _root(Fraction(int(farthest.numerator), int(farthest.denominator)))
        yield f"{mesh.arrangement.crossings} crossings split, segments moved by at most {moved:.3g}"


def _root(square: Fraction) -> float:
    """Return the square root; of a square that is too small or too large for a double as well."""
    shift = (square.numerator.bit_length() - square.denominator.bit_length()) // 2
    return ldexp(sqrt(square / Fraction(4) ** shift), shift)


def _write(target: str, mesh: Mesh) -> tuple[str, ...]:
    """Write the mesh; neighbors and edges only where files of an older mesh would be left beside it, or to an .npz."""
    if os.path.splitext(target)[1] in _TOGETHER:
        if not os.path.exists(_beside(target, ".neigh")):
            mesh = replace(mesh, neighbors=None)
        if not os.path.exists(_beside(target, ".edge")):
            mesh = replace(mesh, edges=None, edge_markers=None)
    with working(f"writing {target}"):
        return write(target, mesh)


def _beside(target: str, suffix: str) -> str:
    return os.path.splitext(target)[0] + suffix


def _would_be_read(path: str) -> bool:
    """Tell whether a .poly file is there that belongs to the .node beside it: one of an older mesh."""
    return os.path.exists(path) and not has_points(path)


def _duplicates(
    total: int, left_out: npt.NDArray[np.integer], kept: npt.NDArray[np.integer], base: int
) -> Iterator[str]:
    """Yield one line that names points which were left out because another has their place, if there are any."""
    if len(left_out):
        named = ", ".join(f"{base + i} of {base + k}" for i, k in zip(left_out, kept, strict=False))
        more = ", ..." if len(left_out) > _NAMED else ""
        yield f"{len(left_out)} of {total} points left out as duplicates: {named}{more}"
