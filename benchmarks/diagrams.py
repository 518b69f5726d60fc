"""Voronoi diagrams as entries of a race, and what is made of them."""

from typing import Any

import numpy as np

from benchmarks.peers import Mesher
from exactkernel.types import FloatArray

__all__ = ["DIAGRAMS", "USES"]


def _same(points: FloatArray) -> FloatArray:
    return points


def _exactmesh(points: FloatArray) -> int:
    from exactmesh import voronoi

    return len(voronoi(points).vertices)


def _with_lists(points: FloatArray) -> int:
    from exactmesh import voronoi

    diagram = voronoi(points)
    return len(diagram.vertices) if diagram.regions and diagram.ridge_vertices else 0


def _scipy(points: FloatArray) -> int:
    from scipy.spatial import Voronoi

    return len(Voronoi(points).vertices)


def _triangle(points: FloatArray) -> int:
    import triangle

    return len(triangle.voronoi(points)[0])


DIAGRAMS: dict[str, Mesher] = {
    "exactmesh-voronoi": Mesher("exactmesh", "exactmesh", _same, _exactmesh, "voronoi(points), flat arrays"),
    "exactmesh-voronoi-lists": Mesher(
        "exactmesh, lists", "exactmesh", _same, _with_lists, "the same, and scipy's lists: regions, ridge_vertices"
    ),
    "scipy-voronoi": Mesher("scipy (Qhull)", "scipy", _same, _scipy, "Voronoi(points)"),
    "triangle-voronoi": Mesher(
        "Triangle",
        "triangle",
        _same,
        _triangle,
        "triangle.voronoi(points): vertices not merged, no cells",
    ),
}


def _clip(points: FloatArray) -> int:
    from exactmesh import voronoi

    clipped = voronoi(points, clip=(0.0, 0.0, 1.0, 1.0)).clipped
    assert clipped is not None
    return round(float(clipped.areas.sum()) * 1000)


def _polygon(points: FloatArray) -> int:
    from exactmesh import voronoi

    angles = np.arange(1000) * 2.0 * np.pi / 1000
    clipped = voronoi(points, clip=0.5 + 0.5 * np.stack([np.cos(angles), np.sin(angles)], axis=1)).clipped
    assert clipped is not None
    return len(clipped.sites)


def _lloyd(points: FloatArray) -> int:
    from exactmesh.voronoi import lloyd

    return len(lloyd(points, clip=(0.0, 0.0, 1.0, 1.0), iterations=1).points)


def _mesh(points: FloatArray) -> Any:
    from exactmesh import delaunay

    random = np.random.default_rng(7)
    return delaunay(points), random.normal(size=len(points)), random.random((len(points), 2))


def _interpolate(prepared: Any) -> int:
    from exactmesh.voronoi import interpolate

    return len(interpolate(*prepared))


def _linear(points: FloatArray) -> Any:
    from scipy.interpolate import LinearNDInterpolator
    from scipy.spatial import Delaunay

    _, values, at = _mesh(points)
    return LinearNDInterpolator(Delaunay(points), values), at


def _scipy_linear(prepared: Any) -> int:
    interpolant, at = prepared
    return len(interpolant(at))


USES: dict[str, Mesher] = {
    "clip-box": Mesher("clip", "exactmesh", _same, _clip, "voronoi(points, clip=the unit square), areas"),
    "clip-polygon": Mesher("clip to 1,000 sides", "exactmesh", _same, _polygon, "clip=a regular polygon"),
    "lloyd": Mesher("Lloyd", "exactmesh", _same, _lloyd, "lloyd(points, iterations=1): two diagrams, one step"),
    "sibson": Mesher(
        "interpolate",
        "exactmesh",
        _mesh,
        _interpolate,
        "Sibson's interpolant at as many points, triangulated before",
    ),
    "scipy-linear": Mesher(
        "scipy, linear", "scipy", _linear, _scipy_linear, "LinearNDInterpolator, made before: linear on each triangle"
    ),
}
