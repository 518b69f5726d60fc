"""Functions that say which triangles are too large, in the conventions of others, as one for whole arrays."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from exactkernel.types import FloatArray
from exactmesh.plane import BoolArray
from exactmesh.triangle.solve import Unsuitable

__all__ = ["RefinementFunc", "TriUnsuitable", "from_meshpy", "from_triunsuitable"]

#: Triangle's own in C: (origin, destination, apex, area), each corner (x, y).
TriUnsuitable: TypeAlias = Callable[[FloatArray, FloatArray, FloatArray, float], bool]
#: That of ``meshpy.triangle``: (the three corners, area).
RefinementFunc: TypeAlias = Callable[[list[tuple[float, float]], float], bool]


def from_triunsuitable(function: TriUnsuitable) -> Unsuitable:
    """Return Triangle's ``triunsuitable`` as a function of many triangles: it is called for one after the other.

    >>> from exactmesh.triangle import from_triunsuitable, triangulate
    >>> large = from_triunsuitable(lambda a, b, c, area: area > 0.1)
    >>> large(np.array([[(0, 0), (1, 0), (0, 1)]]), np.array([0.5])).tolist()
    [True]
    """

    def unsuitable(corners: FloatArray, areas: FloatArray) -> BoolArray:
        pairs = zip(corners, areas.tolist(), strict=True)
        return np.array([bool(function(a, b, c, area)) for (a, b, c), area in pairs], dtype=np.bool_)

    return unsuitable


def from_meshpy(function: RefinementFunc) -> Unsuitable:
    """Return meshpy's ``refinement_func`` as a function of many triangles: it is called for one after the other.

    >>> from exactmesh.triangle import from_meshpy
    >>> large = from_meshpy(lambda corners, area: area > 0.1 and corners[0] == (0.0, 0.0))
    >>> large(np.array([[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]]), np.array([0.5])).tolist()
    [True]
    """

    def unsuitable(corners: FloatArray, areas: FloatArray) -> BoolArray:
        pairs = zip(corners.tolist(), areas.tolist(), strict=True)
        return np.array([bool(function([(x, y) for x, y in abc], area)) for abc, area in pairs], dtype=np.bool_)

    return unsuitable
