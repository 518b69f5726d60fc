"""The window that a Voronoi diagram is clipped to: a box, or a convex polygon, checked exactly."""

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points
from exactkernel.batch import orient2d_batch
from exactkernel.types import FloatArray
from exactmesh.errors import ClipError
from exactmesh.pslg import PSLG

__all__ = ["window_of"]


def window_of(clip: npt.ArrayLike) -> FloatArray:
    """Return the corners of a box (xmin, ymin, xmax, ymax) or a convex polygon (k, 2), counterclockwise.

    Repeated corners, and those in the interior of a straight side, are left out. O(k).

    Raises:
        ClipError: neither of the two, or without area; ``indices`` names a corner.
        NonFiniteError, CoordinateError, ShapeError: coordinates that are none.
    """
    if isinstance(clip, PSLG):
        raise ClipError(
            "clip is a PSLG, no convex polygon; the diagram of a mesh of its domain is clipped to that by "
            'voronoi(refine(graph, conforming=True), clip="domain")'
        )
    if isinstance(clip, str):
        raise ClipError(f"clip={clip!r} is neither a box (xmin, ymin, xmax, ymax) nor a convex polygon (k, 2)")
    try:
        shape = np.shape(clip)
    except ValueError:
        raise ClipError("clip is neither a box (xmin, ymin, xmax, ymax) nor a convex polygon (k, 2)") from None
    if shape == (4,):
        low, high = finite_points(np.reshape(np.asarray(clip), (2, 2)), "clip")
        if not (low < high).all():
            raise ClipError(f"the box {np.asarray(clip).tolist()} is empty; expected (xmin, ymin, xmax, ymax)")
        return np.array([(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])])
    if len(shape) != 2 or shape[1] != 2:
        raise ClipError(f"clip has shape {shape}; expected a box (xmin, ymin, xmax, ymax) or a convex polygon (k, 2)")
    return _convex(finite_points(clip, "clip"))


def _convex(corners: FloatArray) -> FloatArray:
    given = np.flatnonzero((corners != np.roll(corners, 1, axis=0)).any(axis=1))
    ring = corners[given]
    if len(ring) < 3:
        raise ClipError(f"clip has {len(ring)} different corners; a polygon needs three")
    turns = orient2d_batch(np.roll(ring, 1, axis=0), ring, np.roll(ring, -1, axis=0))
    if (turns <= 0).all() and (turns < 0).any():
        ring, given, turns = ring[::-1], given[::-1], -turns[::-1]
    bad = np.flatnonzero(turns < 0)
    if bad.size or not (turns > 0).any():
        corner = int(given[bad[0]]) if bad.size else int(given[0])
        what = "turns the other way" if bad.size else "and all others lie on one line"
        raise ClipError(f"clip is no convex polygon: corner {corner} {what}", indices=[corner])
    ahead = _before(ring, np.roll(ring, -1, axis=0))  # turns are left, so a simple polygon changes direction twice
    spikes = np.flatnonzero((ahead != np.roll(ahead, 1)) & (turns == 0))
    if spikes.size or (ahead != np.roll(ahead, 1)).sum() != 2:
        corner = int(given[spikes[0] if spikes.size else 0])
        raise ClipError("clip is no convex polygon: it turns back, or goes round more than once", indices=[corner])
    return ring[turns > 0]


def _before(p: FloatArray, q: FloatArray) -> npt.NDArray[np.bool_]:
    """Tell for each row whether p comes before q lexicographically."""
    before: npt.NDArray[np.bool_] = (p[:, 0] < q[:, 0]) | ((p[:, 0] == q[:, 0]) & (p[:, 1] < q[:, 1]))
    return before
