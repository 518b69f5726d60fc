"""The demonstration: a hard point set, a lake and the course's five points, triangulated, verified and drawn."""

import os
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from exactkernel.jit import is_cache_warm
from exactkernel.types import FloatArray
from exactmesh.constrain import constrain_range, constrained_delaunay
from exactmesh.delaunay import delaunay, insert_range
from exactmesh.plot import PlotUnavailableError, plot_mesh
from exactmesh.progress import COMPILING, working
from exactmesh.pslg import PSLG
from exactmesh.verify import Property, Verdict, verify
from exactmesh.verify.chains import walk_chains

if TYPE_CHECKING:
    from exactmesh.triangulation import Triangulation
    from exactmesh.verify import Report

__all__ = ["course_points", "demo", "lake", "mosaic"]

_STYLES = {Verdict.HOLDS: "green", Verdict.FAILS: "red", Verdict.UNDECIDED: "yellow"}


def course_points() -> FloatArray:
    """Return the five points (5, 2) of the course."""
    return np.array([(0.0, 0.0), (1.0, 0.0), (0.4, 0.4), (0.0, 1.0), (0.2, 0.3)])


def mosaic() -> FloatArray:
    """Return some thousands of points that are hard for a mesher that rounds, the same ones in every run.

    A grid (every square a tie), rings (many points nearly, but not quite, on a circle), a sunflower, and four spirals
    that wind down to 10^-12 from their centres, in a picture 16 wide.
    """
    axis = np.arange(-8.0, 8.25, 0.5)
    grid = np.array([(x, y) for x in axis for y in axis if x * x + y * y > 36.0])
    turns = np.arange(180) * (2.0 * np.pi / 180)
    rings = [r * np.column_stack([np.cos(turns), np.sin(turns)]) for r in (6.0, 5.75, 5.5)]
    k = np.arange(1500)
    golden = k * (np.pi * (3.0 - np.sqrt(5.0)))
    sunflower = (5.25 * np.sqrt((k + 0.5) / len(k)))[:, None] * np.column_stack([np.cos(golden), np.sin(golden)])
    k = np.arange(320)
    winding = (0.9 * 0.917**k)[:, None] * np.column_stack([np.cos(0.7 * k), np.sin(0.7 * k)])
    spirals = [winding * (sx, sy) + (6.25 * sx, 6.25 * sy) for sx in (-1.0, 1.0) for sy in (-1.0, 1.0)]
    return np.concatenate([grid, *rings, sunflower, *spirals])


def lake() -> PSLG:
    """Return a lake with three islands, and seven dikes, some of which cross a shore.

    But for the rounding of their ends the dikes would meet in one point: they cross in several, some 1e-16 apart.
    """
    islands = [(-3.5, 1.0, 1.0), (2.5, 2.0, 0.7), (2.0, -2.0, 1.1)]
    shores = [_shore(0.0, 0.0, 5.0, 240), *(_shore(x, y, size, 80) for x, y, size in islands)]
    middle, angles = np.array([-0.9, -0.7]), np.arange(7) * (np.pi / 7.0) + 0.1
    reach = 2.2 * np.column_stack([np.cos(angles), np.sin(angles)])
    dikes = np.stack([middle - reach, middle + reach], axis=1).reshape(-1, 2)
    segments, count = [], 0
    for shore in shores:
        start = np.arange(len(shore))
        segments.append(count + np.column_stack([start, np.roll(start, -1)]))
        count += len(shore)
    segments.append(count + np.arange(len(dikes)).reshape(-1, 2))
    return PSLG(
        np.concatenate([*shores, dikes]),
        np.concatenate(segments),
        segment_markers=np.repeat(np.arange(1, 6), [len(part) for part in segments]),
        holes=[(x, y) for x, y, _ in islands],
    )


def _shore(x: float, y: float, size: float, count: int) -> FloatArray:
    turn = np.arange(count) * (2.0 * np.pi / count)
    radius = size * (1.0 + 0.12 * np.sin(5.0 * turn + x) + 0.06 * np.sin(11.0 * turn + y))
    return np.column_stack([x + 1.6 * radius * np.cos(turn), y + radius * np.sin(turn)])


@dataclass(frozen=True)
class _Run:
    triangulation: "Triangulation"
    report: "Report"
    seconds: tuple[float, float]  # triangulate, verify


def demo(folder: str, console: Console) -> bool:
    """Triangulate, verify and draw the two point sets and the lake; return whether all are what they claim.

    Prints a table, and writes pictures into ``folder``, which is made if need be.

    Raises:
        OSError: the folder or a picture cannot be written.
    """
    sets: dict[str, FloatArray | PSLG] = {"mosaic": mosaic(), "lake": lake(), "course": course_points()}
    _warm_up(console)
    runs = {}
    for name, given in sets.items():
        with working(f"triangulating and verifying {name}"):
            runs[name] = _run(given)
    console.print(_table(runs))
    _draw(runs, folder, console)
    return all(run.report.ok for run in runs.values())


def _warm_up(console: Console) -> None:
    """Run everything once, points and a graph with crossings, so that no time in the table is one of compiling."""
    cold = not is_cache_warm(insert_range, constrain_range, walk_chains)
    if cold:
        console.print(f"First run: {COMPILING} ...")
    start = time.perf_counter()
    with working("exactmesh"):
        for given in (course_points(), lake()):
            _run(given)
    if cold:
        console.print(f"Compiled in {time.perf_counter() - start:.1f} s; later runs start at once.")


def _run(given: FloatArray | PSLG) -> _Run:
    start = time.perf_counter()
    triangulation = constrained_delaunay(given, crossings="split") if isinstance(given, PSLG) else delaunay(given)
    middle = time.perf_counter()
    report = verify(triangulation.points, triangulation.triangles, domain=triangulation.domain)
    return _Run(triangulation, report, (middle - start, time.perf_counter() - middle))


def _table(runs: Mapping[str, _Run]) -> Table:
    table = Table(title="Delaunay triangulations, verified", title_justify="left")
    table.caption = "in parentheses: decided, but not claimed"
    table.add_column("")
    for name in runs:
        table.add_column(name, justify="right")
    reports = [run.report for run in runs.values()]
    table.add_row("points", *(f"{len(run.triangulation.points):,}" for run in runs.values()))
    table.add_row("triangles", *(f"{len(run.triangulation.triangles):,}" for run in runs.values()))
    for k, step in enumerate(("triangulated in", "verified in")):
        table.add_row(step, *(f"{1000.0 * run.seconds[k]:.1f} ms" for run in runs.values()))
    table.add_section()
    for claim in Property:
        if any(claim in report.findings for report in reports):
            table.add_row(str(claim), *(_verdict(report, claim) for report in reports))
    table.add_section()
    for predicate in reports[0].stages:
        table.add_row(f"{predicate} decided by", *(_stages(report, predicate) for report in reports))
    return table


def _verdict(report: "Report", claim: Property) -> Text:
    if claim not in report.findings:
        return Text()
    verdict = report.verdict(claim)
    if claim in report.claims:
        return Text(str(verdict), style=_STYLES[verdict])
    return Text(f"({verdict})", style="dim")


def _stages(report: "Report", predicate: str) -> str:
    counts = report.stages[predicate]
    return "\n".join(f"{stage.name.lower()} {count:,}" for stage, count in counts.items() if count) or "-"


def _draw(runs: Mapping[str, _Run], folder: str, console: Console) -> None:
    titles = {
        "mosaic": "A grid, rings, a sunflower and spirals",
        "lake": "A lake, islands, and dikes that cross",
        "course": "The course's five points",
    }
    os.makedirs(folder, exist_ok=True)
    try:
        for name, run in runs.items():
            place = os.path.join(folder, f"{name}.png")
            with working(f"drawing {place}"):
                _plot(run.triangulation, place, titles[name])
            console.print(f"Picture: {place}", markup=False, highlight=False, soft_wrap=True)
    except PlotUnavailableError as error:
        console.print(f"No pictures: {error}", markup=False, highlight=False, soft_wrap=True)


def _plot(mesh: "Triangulation", place: str, title: str) -> None:
    segments = mesh.segments if len(mesh.segments) else None
    plot_mesh(mesh.points, mesh.triangles, place, segments=segments, title=title)
