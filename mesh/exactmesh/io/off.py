"""``.off``: points and triangles, for Geomview and whoever else reads it; written only."""

from collections.abc import Iterator

import numpy as np

from exactkernel.types import FloatArray, IntArray
from exactmesh.io.text import rows_of_text

__all__ = ["off_text"]


def off_text(points: FloatArray, triangles: IntArray) -> Iterator[str]:
    """Yield the text of an ``.off`` file, z = 0; it counts from 0, and leaves the number of edges at 0."""
    yield f"OFF\n{len(points)} {len(triangles)} 0\n"
    yield from rows_of_text([points, np.zeros(len(points))])
    yield from rows_of_text([np.full(len(triangles), 3), triangles])
