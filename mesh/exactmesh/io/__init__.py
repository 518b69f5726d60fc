"""Mesh files: Triangle's text formats, ``.npz`` archives, ``.csv`` points; the suffix chooses.

========================  =========================================================================
``.node``                 points, their attributes and markers
``.ele``                  triangles and their attributes (of six-node elements, the three corners)
``.poly``                 segments, holes, regions; with points of its own, or beside a ``.node``
``.neigh`` ``.edge``      neighbours; edges and their markers
``.area``                 the largest area of each triangle, for refinement: :func:`read_areas`
``.v.node`` ``.v.edge``   the Voronoi diagram: :func:`write_voronoi`
``.npz``                  all arrays of a :class:`Mesh`, by their names
``.csv``                  points: with a header that names x and y, or two columns without one
``.geojson`` ``.json``    polygons, lines and points: a PSLG
========================  =========================================================================

Triangle's files belong together by their stem: ``box.1.ele`` needs ``box.1.node`` beside it.

Reference: [Shewchuk 1996]
"""

from exactmesh.io.area import read_areas, write_areas
from exactmesh.io.dual import write_voronoi
from exactmesh.io.files import (
    holds_segments,
    read,
    read_graph,
    read_points,
    read_pslg,
    read_triangles,
    write,
    write_pslg,
)
from exactmesh.io.model import Mesh, Triangulated, mesh_of

__all__ = [
    "Mesh",
    "Triangulated",
    "holds_segments",
    "mesh_of",
    "read",
    "read_areas",
    "read_graph",
    "read_points",
    "read_pslg",
    "read_triangles",
    "write",
    "write_areas",
    "write_pslg",
    "write_voronoi",
]
