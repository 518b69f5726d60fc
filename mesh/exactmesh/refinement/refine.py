"""Refinement: points added to a constrained Delaunay triangulation until its triangles are as good as asked for."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

import math

import numpy as np
import numpy.typing as npt

from exactkernel.angle import angle_bound
from exactkernel.context import chunk_size, thread_context
from exactkernel.errors import ShapeError
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, IntArray
from exactmesh.constrain import Crossings, constrained_delaunay
from exactmesh.crossings.memory import room_for
from exactmesh.delaunay import MAX_POINTS, Progress
from exactmesh.errors import OptionError
from exactmesh.pslg import PSLG, Carve
from exactmesh.refinement.asking import Question, area_question, ask, size_question, unsuitable_question
from exactmesh.refinement.layout import TINIEST, Layout, grown, laid_out
from exactmesh.refinement.options import MAX_ANGLE, Options, Size, Steiner, Unsuitable, checked_options
from exactmesh.refinement.outcome import refinement_of
from exactmesh.refinement.result import Refinement
from exactmesh.refinement.rules import Reason, Rules
from exactmesh.refinement.ruppert import BUDGET, DONE, ROOM, judge_all, mark_encroached, run
from exactmesh.refinement.sheet import EDGES, OUTSIDE, VERTICES, Sheet
from exactmesh.triangulation import Triangulation

__all__ = ["refine"]

_CHUNK = 1 << 15  # steps between two looks at Ctrl-C and the progress bar, where predicates are fast
_BYTES_PER_VERTEX = 400  # three edges, and what is made of them in the end
_OFFSET = 0.465  # of the exact off-centre's 0.5: its triangle is better than asked for, which takes fewer points
_FILLED = 0.995  # of the largest area: the triangles of a lattice
_FLAT = 1e-6  # below, an off-centre would be farther away than any circumcentre

#: How short edges may become for the sake of an angle up to so many degrees, in radii of what caused them. Up to 30 a
#: circumcentre is no nearer than its parent is; beyond 34 all is lost soon, and is not to be lost in a million points.
_SHRINKS = ((30.0, 1.0 / 64.0), (34.0, 1.0 / 16.0), (MAX_ANGLE, 1.0 / 4.0))


def _zones(mesh: Triangulation) -> tuple[IntArray, IntArray, FloatArray, FloatArray]:
    """Return the zone of each triangle, and of each zone its region, attributes and largest area.

    Triangles are in one zone if region and attributes are the same.
    """
    columns = np.concatenate([mesh.triangle_regions[:, None].astype(np.float64), mesh.triangle_attributes], axis=1)
    if (columns == columns[:1]).all():
        columns = columns[:1]  # without sorting, for the most common case
    _, first, zone = np.unique(columns, axis=0, return_index=True, return_inverse=True)
    zone = np.broadcast_to(zone.reshape(-1), len(mesh.triangles)) if len(columns) == 1 else zone.reshape(-1)
    region = mesh.triangle_regions[first]
    areas = np.full(len(first), math.inf)
    if mesh.pslg is not None and len(mesh.pslg.regions):
        areas = np.where(region >= 0, mesh.pslg.regions[region, 3], math.inf)
    areas = np.where(areas > 0.0, areas, math.inf)
    return zone.astype(np.int32), region, mesh.triangle_attributes[first], areas


def _least(length: float, exponent: int) -> float:
    """Return length times 2^exponent, infinite where it is too large, and not 0 unless the length is."""
    scaled = float(np.ldexp(length, exponent))
    return max(scaled, TINIEST) if length > 0.0 else 0.0


def _scaled(areas: FloatArray, exponent: int) -> FloatArray:
    """Return the areas times 2^exponent.

    Raises:
        OptionError: that rounds, so the triangles would be held against another bound.
    """
    scaled = np.ldexp(areas, exponent)
    rounded = np.flatnonzero(np.ldexp(scaled, -exponent) != areas)
    if rounded.size:
        raise OptionError(f"the largest area {areas[rounded[0]]} is out of proportion to the coordinates")
    return scaled


def _rules(layout: Layout, options: Options, areas: FloatArray) -> Rules:
    """Return the rules in the coordinates of the sheet."""
    cosine = math.cos(math.radians(options.min_angle))
    tangent = math.tan(0.5 * math.radians(options.min_angle))
    if isinstance(options.max_area, float):
        areas = np.minimum(areas, options.max_area)
    areas = _scaled(areas, 2 * layout.exponent)
    vertices = int(layout.sheet.counts[VERTICES])
    extent = float(np.ptp(layout.sheet.xy[: 2 * vertices].reshape(-1, 2), axis=0).max())
    room = min(room_for(_BYTES_PER_VERTEX), MAX_POINTS)
    # A point put into an equilateral triangle makes angles of 30 degrees at most: beyond, a lattice falls to pieces.
    filled = areas if options.min_angle <= 30.0 else np.full_like(areas, math.inf)
    return Rules(
        angle=angle_bound(options.min_angle),
        has_angle=options.min_angle > 0.0,
        offset=_OFFSET / tangent if tangent > _FLAT else 0.0,
        lens=(2.0 * cosine * cosine - 1.0) ** 2 if options.asks_for_points or (areas < math.inf).any() else math.inf,
        gabriel=options.conforming,
        areas=areas,
        has_area=bool((areas < math.inf).any()),
        lattice=np.sqrt(_FILLED * 4.0 / math.sqrt(3.0) * filled),
        origin_x=float(layout.sheet.xy[0 : 2 * vertices : 2].min()),
        origin_y=float(layout.sheet.xy[1 : 2 * vertices : 2].min()),
        min_edge=_least(options.min_edge, layout.exponent),
        shrink=next(shrink * shrink for degrees, shrink in _SHRINKS if options.min_angle <= degrees),
        unit=layout.unit,
        longest=extent * extent,
        ends=layout.lines,
        sharp=layout.sharp,
        max_vertices=int(min(max(room, vertices), vertices + options.max_steiner)),
    )


def _forbid(s: Sheet, steiner: Steiner) -> None:
    """Mark the edges that must not be divided."""
    if steiner is Steiner.ANYWHERE:
        return
    forbidden = s.segment >= 0
    if steiner is Steiner.NOT_ON_BOUNDARY:
        forbidden &= (s.zone.reshape(-1, 2) == OUTSIDE).any(axis=1)
    s.hard[forbidden] = Reason.FORBIDDEN


def _exhaust(s: Sheet, rules: Rules, progress: Progress | None) -> tuple[Sheet, int]:
    """Run until nothing is left to do, or no points are left; return the sheet and which."""
    size = chunk_size(s.k, _CHUNK)
    while True:
        state = int(run(s, rules, size))
        raise_if_interrupted()
        if state == ROOM:
            s = grown(s, 2 * int(s.counts[VERTICES]) + 64)
        elif state in (DONE, BUDGET):
            return s, state
        if progress is not None:
            progress(int(s.counts[VERTICES]), 0)


@np.errstate(over="ignore", invalid="ignore")  # interpreted, a numpy scalar warns where a double does not
def refined(mesh: Triangulation, options: Options, progress: Progress | None) -> Refinement:
    """Refine a triangulation."""
    zone, regions, attributes, areas = _zones(mesh)
    questions: list[Question] = []
    if not isinstance(options.max_area, float):
        if len(options.max_area) != len(mesh.triangles):
            raise ShapeError(f"max_area has {len(options.max_area)} entries for {len(mesh.triangles)} triangles")
        questions.append(area_question(mesh, options.max_area, thread_context()))
    if options.size is not None:
        questions.append(size_question(options.size, thread_context()))
    if options.unsuitable is not None:
        questions.append(unsuitable_question(options.unsuitable))
    layout = laid_out(mesh, zone)
    rules = _rules(layout, options, areas)
    s = grown(layout.sheet, 2 * len(mesh.points) + 64)
    _forbid(s, options.steiner)
    judge_all(s, rules, 0, int(s.counts[EDGES]))
    while True:
        s, state = _exhaust(s, rules, progress)
        if not questions or not ask(s, rules, questions, layout.exponent) or state == BUDGET:
            break
    if options.conforming:
        mark_encroached(s, rules)
    return refinement_of(s, layout, mesh, regions, attributes)


def refine(
    domain: PSLG | Triangulation | Refinement,
    *,
    min_angle: float = 20.0,
    max_area: npt.ArrayLike | None = None,
    size: Size | float | None = None,
    unsuitable: Unsuitable | None = None,
    conforming: bool = False,
    steiner: Steiner | str = Steiner.ANYWHERE,
    max_steiner: int | None = None,
    min_edge: float | None = None,
    carve: bool | Carve | str = True,
    crossings: Crossings | str = Crossings.ERROR,
    progress: Progress | None = None,
) -> Refinement:
    """Add points to a domain's constrained Delaunay triangulation until its triangles are as good as asked for.

    It always ends, and what it returns is admissible and constrained Delaunay, complete or not: ``unrefined`` and
    ``reasons`` name the triangles that do not meet a bound. Whether a bound holds is decided exactly.

    Args:
        domain: a graph, or a triangulation (or what ``refine`` returned), which is refined further; the regions of the
            graph bound areas, too.
        min_angle: the least angle, degrees, 0 (no bound) to 40. Up to 20.7 is proved to succeed where segments meet at
            90 degrees or more, up to 18.4 where at 60.
        max_area: the largest area; or, of a triangulation, one for each of its triangles, not positive for none: it
            holds for triangles whose centroid is there.
        size: a positive length: no edge is to be longer; or a function, called with centroids (k, 2), that returns such
            lengths (k,), or one for all: no edge of the triangle is to be longer.
        unsuitable: called with corners (k, 3, 2), counterclockwise, and areas (k,), returns bools (k,): which triangles
            to refine. Functions are called for many triangles at once, about each triangle once.
        conforming: make every segment Gabriel (no vertex inside its diametral circle), so that all triangles are
            Delaunay and all circumcentres in the domain.
        steiner: where points may be added; see :class:`Steiner`.
        max_steiner: the largest number of points to add; None: what fits into a quarter of the machine's memory.
        min_edge: make no edge shorter than this.
        carve: what of a graph is its domain, as for :func:`exactmesh.constrained_delaunay`; False: the convex hull.
        crossings: what to do about segments of a graph that cross; see :class:`Crossings`.
        progress: called now and then with (vertices so far, 0).

    Returns:
        A :class:`Refinement`.

    Raises:
        OptionError: a number is out of range, or ``size`` returned one that is not positive.
        ShapeError: a function returned something of the wrong shape or type; ``max_area`` does not fit the triangles.
        ChoiceError: ``steiner``, ``carve`` or ``crossings`` is none of the words.
        Exception: what the functions raise; and, for a graph, what :func:`exactmesh.constrained_delaunay` raises.

    Expected O(n log n) for n vertices of the output. Reference [Ruppert 1995], [Shewchuk 2002], [Miller 2003],
    [Ungor 2004].

    >>> from exactmesh import PSLG, refine
    >>> lake = PSLG.from_rings([[(0, 0), (9, 0), (9, 6), (0, 6)], [(4, 2), (4, 3), (5, 3), (5, 2)]])
    >>> mesh = refine(lake, min_angle=30, max_area=1).triangulation
    >>> mesh.statistics().smallest_angle >= 30
    True
    """
    options = checked_options(min_angle, max_area, size, unsuitable, conforming, steiner, max_steiner, min_edge)
    if isinstance(domain, Refinement):
        domain = domain.triangulation
    if isinstance(domain, PSLG):
        if not isinstance(options.max_area, float):
            raise OptionError("max_area for each triangle needs a Triangulation; for a graph, give one number")
        domain = constrained_delaunay(domain, carve=carve, crossings=crossings)
    elif not isinstance(domain, Triangulation):
        raise ShapeError(
            f"expected a PSLG or a Triangulation, not a {type(domain).__name__}: refine(delaunay(points)) refines the"
            " convex hull of points, refine(PSLG.from_rings(rings)) what closed rings enclose"
        )
    return refined(domain, options, progress)
