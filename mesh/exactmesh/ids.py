"""Typed handles: a vertex is not a face, and a primal edge is not a dual one. At run time they are plain integers."""

from typing import NewType

__all__ = ["OUTSIDE", "Face", "QuarterEdge", "Vertex"]

#: Index of a vertex (a row of ``points``).
Vertex = NewType("Vertex", int)
#: Index of a face (a row of ``triangles``), or OUTSIDE.
Face = NewType("Face", int)
#: Quarter-edge ``4 * edge + r``, r the number of quarter turns.
QuarterEdge = NewType("QuarterEdge", int)

#: The face on the other side of the hull.
OUTSIDE = Face(-1)
