"""Draws the pictures of the README and of the site: ``python docs/pictures.py``, with the extra ``plot``."""

import tempfile
from pathlib import Path

from PIL import Image  # comes with matplotlib

from exactmesh import Triangulation, constrained_delaunay, delaunay
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


if __name__ == "__main__":
    HERE.mkdir(exist_ok=True)
    draw("mosaic", delaunay(mosaic()), "A grid, rings, a sunflower and spirals", width=880)
    draw("course", delaunay(course_points()), "The course's five points", width=480)
    draw("lake", constrained_delaunay(lake(), crossings="split"), "A lake, islands, and dikes that cross", width=880)
