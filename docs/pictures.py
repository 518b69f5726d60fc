"""Draws the pictures of the README and of the site: ``python docs/pictures.py``, with the extras plot, hypothesis."""

import tempfile
import warnings
from pathlib import Path

import numpy as np
from hypothesis import Phase, given, settings
from hypothesis.strategies import SearchStrategy
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from PIL import Image  # comes with matplotlib

from exactkernel.types import FloatArray
from exactmesh import (
    PSLG,
    Triangulation,
    Voronoi,
    constrained_delaunay,
    delaunay,
    lloyd,
    refine,
    strategies,
    triangle,
    voronoi,
)
from exactmesh.demo import course_points, lake, mosaic
from exactmesh.plane import BoolArray
from exactmesh.plot import plot_mesh, plot_voronoi

HERE = Path(__file__).resolve().parent / "_static"


def shrink(large: Path, name: str, width: int) -> None:
    """Save a picture with few colours, few pixels, few bytes."""
    with Image.open(large) as picture:
        height = round(picture.height * width / picture.width)
        small = picture.convert("RGB").resize((width, height), Image.Resampling.LANCZOS)
    small.quantize(32, method=Image.Quantize.MEDIANCUT).save(HERE / f"{name}.png", optimize=True)


def draw(name: str, shown: Triangulation | Voronoi, title: str, *, width: int) -> None:
    """Draw a triangulation or a diagram, then shrink it."""
    with tempfile.TemporaryDirectory() as folder:
        large = Path(folder) / f"{name}.png"
        if isinstance(shown, Voronoi):
            plot_voronoi(shown, large, title=title)
        else:
            segments = shown.segments if len(shown.segments) else None
            plot_mesh(shown.points, shown.triangles, large, segments=segments, title=title)
        shrink(large, name, width)


def near_a_point(corners: FloatArray, areas: FloatArray) -> BoolArray:
    """Tell which triangles are too large for the course: small ones are wanted near (0.1, 0.1)."""
    off = corners.mean(axis=1) - 0.1
    large: BoolArray = areas > 0.001 * np.exp(50.0 * (off**2).sum(axis=1))
    return large


def draw_calls(name: str, *, width: int) -> None:
    """Draw inputs beside outputs: the course's five calls, and a letter; with v, the Voronoi diagram over them."""
    calls = (("triangle", ""), ("polygon", "pv"), ("polygon", "pvD"), ("polygon", "pa0.1"), ("polygon", "pa0.1u"))
    figure = Figure(figsize=(12, 9.4), dpi=150, layout="constrained")
    axes = iter(figure.subplots(3, 4).reshape(-1))
    for data, switches in (*calls, ("A", "pq30a0.01")):
        given = triangle.get_data(data)
        with warnings.catch_warnings(action="ignore"):  # v is for files
            found = triangle.triangulate(given, switches, unsuitable=near_a_point if "u" in switches else None)
        before, after = next(axes), next(axes)
        triangle.plot(before, **given)
        triangle.plot(after, **found)
        if "v" in switches:
            limits = after.axis()
            centres, edges, origins, directions = triangle.voronoi(found["vertices"])
            over = LineCollection(centres[edges], colors="#2a9d6f", linewidths=1.1, linestyles="dashed")
            after.add_collection(over)
            rays = np.stack([centres[origins], centres[origins] + 9.0 * directions], axis=1)
            after.add_collection(LineCollection(rays, colors="#2a9d6f", linewidths=1.1, linestyles="dashed"))
            after.axis(limits)
        before.set_title(f"{data}: {len(given['vertices'])} vertices", fontsize=10)
        after.set_title(
            f'"{switches}": {len(found["vertices"])} vertices, {len(found["triangles"])} triangles', fontsize=10
        )
    for one in figure.axes:
        one.set_axis_off()
    with tempfile.TemporaryDirectory() as folder:
        large = Path(folder) / f"{name}.png"
        figure.savefig(large)
        shrink(large, name, width)


def shores() -> PSLG:
    """Return the lake and its islands, without the dikes."""
    whole = lake()
    assert whole.segment_markers is not None
    shore = whole.segments[whole.segment_markers < 5]
    return PSLG(whole.points[: int(shore.max()) + 1], shore, holes=whole.holes)


def points_of(shown: PSLG | FloatArray) -> FloatArray:
    """Return the points, scaled to fill the unit square."""
    points = shown.points if isinstance(shown, PSLG) else shown
    return (points - points.min(axis=0)) / np.maximum(np.ptp(points, axis=0), 5e-324)


def drawn(strategy: SearchStrategy[PSLG | FloatArray], *, is_grid: bool) -> PSLG | FloatArray:
    """Return one of the examples of a strategy, always the same: what is scattered, or else the least like a line."""
    found: list[PSLG | FloatArray] = []

    @settings(max_examples=60, database=None, deadline=None, derandomize=True, phases=[Phase.generate])
    @given(strategy)
    def collect(value: PSLG | FloatArray) -> None:
        found.append(value)

    collect()
    scattered = [shown for shown in found if not isinstance(shown, PSLG) and len(np.unique(shown)) > 32]
    if scattered and not is_grid:
        return scattered[-2]
    return max(scattered or found, key=lambda shown: np.linalg.det(np.cov(points_of(shown).T)))


def draw_strategies(name: str, *, width: int) -> None:
    """Draw an example of each family of points and graphs, each to fill its square."""
    sets = [f for f in strategies.__all__ if f.endswith("_points")]
    graphs = ["polygons", "polygons_with_holes", "slits", "spirals", "small_angles", "near_concurrent"]
    figure = Figure(figsize=(12, 6.6), dpi=150, layout="constrained")
    for axes, family in zip(
        figure.subplots(3, 6).reshape(-1), [*sets, *graphs, "shared_borders", "t_junctions"], strict=True
    ):
        axes.set_title(family, fontsize=9)
        axes.set_xticks([])
        axes.set_yticks([])
        shown = drawn(getattr(strategies, family)(min_size=30, max_size=30), is_grid=family == "tilted_grid_points")
        placed = points_of(shown)
        if isinstance(shown, PSLG):
            axes.add_collection(LineCollection(placed[shown.segments], colors="#1b2a41", linewidths=0.8))
        axes.plot(*placed.T, ".", color="#c1121f", markersize=3)
        axes.margins(0.08)
    with tempfile.TemporaryDirectory() as folder:
        large = Path(folder) / f"{name}.png"
        figure.savefig(large)
        shrink(large, name, width)


def county(name: str) -> PSLG:
    """Return a county by name, from bokeh's sample data, in kilometres (near enough) from its middle."""
    from bokeh_sampledata import us_counties

    data = next(data for data in us_counties.data.values() if data["name"] == name)
    degrees = np.column_stack([data["lons"], data["lats"]])
    middle = np.nanmean(degrees, axis=0)
    km = 111.2 * (degrees - middle) * (np.cos(np.radians(middle[1])), 1.0)
    cuts = np.flatnonzero(np.isnan(km[:, 0]))
    return PSLG.from_rings([part[~np.isnan(part[:, 0])] for part in np.split(km, cuts)])


if __name__ == "__main__":
    HERE.mkdir(exist_ok=True)
    draw("mosaic", delaunay(mosaic()), "A grid, rings, a sunflower and spirals", width=880)
    draw("course", delaunay(course_points()), "The course's five points", width=480)
    draw("refined", refine(shores(), min_angle=30).triangulation, "The lake, refined to 30 degrees", width=880)
    borders = county("Los Angeles")
    draw("county", refine(borders, min_angle=30).triangulation, "Los Angeles County, refined to 30 degrees", width=880)
    draw("lake", constrained_delaunay(lake(), crossings="split"), "A lake, islands, and dikes that cross", width=880)
    draw_calls("calls", width=1000)
    draw_strategies("strategies", width=1000)
    square = (0.0, 0.0, 1.0, 1.0)
    points = np.random.default_rng(4).random((120, 2))
    relaxed = lloyd(points, clip=square, iterations=100).points
    draw("voronoi", voronoi(points, clip=square), "A hundred and twenty points in a square", width=560)
    draw("lloyd", voronoi(relaxed, clip=square), "The same points, relaxed by a hundred steps", width=560)
