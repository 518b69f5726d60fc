"""The interface of the ``triangle`` package, free to use, and with an answer to every input.

``import exactmesh.triangle as triangle`` is all that a program has to change. Dictionaries have the same keys, shapes
and types; switches are those of Triangle. What Triangle misreads, or dies of, is an error that says what to do.

>>> import exactmesh.triangle as triangle
>>> triangle.triangulate({"vertices": [(0, 0), (1, 0), (0, 1)]}, "e")["edges"].tolist()
[[1, 2], [2, 0], [0, 1]]

Reference: [Shewchuk 1996]
"""

from exactmesh import __version__
from exactmesh.triangle.api import convex_hull, delaunay, triangulate, voronoi
from exactmesh.triangle.callbacks import from_meshpy, from_triunsuitable
from exactmesh.triangle.data import get_data, show_data
from exactmesh.triangle.dictionary import TriangleDict
from exactmesh.triangle.errors import SwitchError, TriangleWarning
from exactmesh.triangle.files import load, loads
from exactmesh.triangle.plot import compare, comparev, plot
from exactmesh.triangle.switches import MEANINGS, Switch, Switches, parse

__all__ = [
    "MEANINGS",
    "Switch",
    "SwitchError",
    "Switches",
    "TriangleDict",
    "TriangleWarning",
    "__version__",
    "compare",
    "comparev",
    "convex_hull",
    "delaunay",
    "from_meshpy",
    "from_triunsuitable",
    "get_data",
    "load",
    "loads",
    "parse",
    "plot",
    "show_data",
    "triangulate",
    "voronoi",
]
