"""Draws the pictures of the README and of the site: ``python docs/pictures.py``, with the extra ``plot``."""

import tempfile
from pathlib import Path

import numpy as np
from PIL import Image  # comes with matplotlib

from exactmesh import PSLG, Triangulation, constrained_delaunay, delaunay, refine
from exactmesh.demo import course_points, lake, mosaic
from exactmesh.plot import plot_mesh

HERE = Path(__file__).resolve().parent / "_static"


def draw(name: str, mesh: Triangulation, title: str, *, width: int) -> None:
    """Draw a triangulation, then shrink it: few colours, few pixels, few bytes."""
    with tempfile.TemporaryDirectory() as folder:
        large = Path(folder) / f"{name}.png"
        plot_mesh(
            mesh.points, mesh.triangles, large, segments=mesh.segments if len(mesh.segments) else None, title=title
        )
        with Image.open(large) as picture:
            height = round(picture.height * width / picture.width)
            small = picture.convert("RGB").resize((width, height), Image.Resampling.LANCZOS)
    small.quantize(32, method=Image.Quantize.MEDIANCUT).save(HERE / f"{name}.png", optimize=True)


def shores() -> PSLG:
    """Return the lake and its islands, without the dikes."""
    whole = lake()
    assert whole.segment_markers is not None
    shore = whole.segments[whole.segment_markers < 5]
    return PSLG(whole.points[: int(shore.max()) + 1], shore, holes=whole.holes)


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
