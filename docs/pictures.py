"""Draws the pictures of the README and of the site: ``python docs/pictures.py``, with the extra ``plot``."""

import tempfile
from pathlib import Path

import numpy as np
from PIL import Image  # comes with matplotlib

from exactmesh import Triangulation, Voronoi, constrained_delaunay, delaunay, voronoi
from exactmesh.demo import course_points, lake, mosaic
from exactmesh.plot import plot_mesh, plot_voronoi
from exactmesh.voronoi import lloyd

HERE = Path(__file__).resolve().parent / "_static"


def draw(name: str, shown: Triangulation | Voronoi, title: str, *, width: int) -> None:
    """Draw a triangulation or a diagram, then shrink it: few colours, few pixels, few bytes."""
    with tempfile.TemporaryDirectory() as folder:
        large = Path(folder) / f"{name}.png"
        if isinstance(shown, Voronoi):
            plot_voronoi(shown, large, title=title)
        else:
            segments = shown.segments if len(shown.segments) else None
            plot_mesh(shown.points, shown.triangles, large, segments=segments, title=title)
        with Image.open(large) as picture:
            height = round(picture.height * width / picture.width)
            small = picture.convert("RGB").resize((width, height), Image.Resampling.LANCZOS)
    small.quantize(32, method=Image.Quantize.MEDIANCUT).save(HERE / f"{name}.png", optimize=True)


if __name__ == "__main__":
    HERE.mkdir(exist_ok=True)
    draw("mosaic", delaunay(mosaic()), "A grid, rings, a sunflower and spirals", width=880)
    draw("course", delaunay(course_points()), "The course's five points", width=480)
    draw("lake", constrained_delaunay(lake(), crossings="split"), "A lake, islands, and dikes that cross", width=880)
    square = (0.0, 0.0, 1.0, 1.0)
    points = np.random.default_rng(4).random((120, 2))
    relaxed = lloyd(points, clip=square, iterations=100).points
    draw("voronoi", voronoi(points, clip=square), "A hundred and twenty points in a square", width=560)
    draw("lloyd", voronoi(relaxed, clip=square), "The same points, relaxed by a hundred steps", width=560)
