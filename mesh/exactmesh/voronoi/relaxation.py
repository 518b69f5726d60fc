"""Lloyd's relaxation: every site moves to the centroid of its cell, again and again."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

import operator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points
from exactkernel.batch import orient2d_batch
from exactkernel.types import FloatArray
from exactmesh.coincident import lexicographic_order
from exactmesh.delaunay import Progress
from exactmesh.errors import ChoiceError, ClipError
from exactmesh.seeds import inside_hull
from exactmesh.voronoi.build import voronoi
from exactmesh.voronoi.window import window_of

__all__ = ["Relaxation", "lloyd"]

_LARGEST, _SMALLEST = 2.0**200, 2.0**-200  # between, fourth powers neither over- nor underflow
_NAMED = 5


@dataclass(frozen=True, eq=False, repr=False)
class Relaxation:
    """Points after Lloyd's relaxation. Every array is read-only.

    Attributes:
        points: float64 (n, 2), in the order of the input.
        energies: float64 (s + 1,), before each step and at the end: the integral over the window of the squared
            distance to the nearest point. It never grows, but for rounding.
        movements: float64 (s,), how far a point moved at most in each step.
    """

    points: FloatArray
    energies: FloatArray
    movements: FloatArray

    def __repr__(self) -> str:
        steps = len(self.movements)
        return f"Relaxation({len(self.points)} points, {steps} steps, energy {self.energies[-1]:.6g})"


def lloyd(
    points: npt.ArrayLike,
    *,
    clip: npt.ArrayLike,
    iterations: int = 100,
    movement: float = 0.0,
    progress: Progress | None = None,
) -> Relaxation:
    """Return the points moved towards a centroidal Voronoi diagram of a window: each the centroid of its cell.

    Args:
        points: (n, 2), in the window.
        clip: a box (xmin, ymin, xmax, ymax) or a convex polygon (k, 2).
        iterations: how many steps at most.
        movement: stop after a step in which no point moves farther than this.
        progress: called after each step with (steps done, iterations).

    Points at the same position stay together. A point whose rounded centroid would not lie inside stays where it is.

    Raises:
        ClipError: no window, or points outside of it: ``indices`` names them.
        ChoiceError: ``iterations`` or ``movement`` is negative, or no number.
        TooFewPointsError, NonFiniteError, CoordinateError, ShapeError: as for :func:`exactmesh.voronoi`.

    O(n log n) a step. Reference [Lloyd 1982], [Du 1999].

    >>> from exactmesh import lloyd
    >>> relaxed = lloyd([(0.1, 0.5), (0.2, 0.5)], clip=(0, 0, 1, 1), iterations=50)
    >>> relaxed.points.round(6).tolist()
    [[0.25, 0.5], [0.75, 0.5]]
    """
    steps, least = _checked(iterations, movement)
    window, xy = window_of(clip), finite_points(points)
    _refuse_outside(xy, window)
    exponent = _exponent(window)
    window, xy = np.ldexp(window, exponent), np.ldexp(xy, exponent)
    order = lexicographic_order(window)
    energies: list[float] = []
    movements: list[float] = []
    for step in range(steps + 1):
        diagram = voronoi(xy, clip=window)
        assert diagram.clipped is not None
        energies.append(float(diagram.clipped.energies.sum()))
        if step == steps or (movements and movements[-1] <= np.ldexp(least, exponent)):
            break
        wanted = diagram.clipped.centroids[diagram.point_region]
        stays = ~np.isfinite(wanted).all(axis=1)
        wanted[stays] = xy[stays]
        stays = inside_hull(window, order, wanted) == 0
        wanted[stays] = xy[stays]
        movements.append(float(np.hypot(*(wanted - xy).T).max()))
        xy = wanted
        if progress is not None:
            progress(step + 1, steps)
    with np.errstate(over="ignore", under="ignore"):
        columns = np.ldexp(xy, -exponent), np.ldexp(energies, -4 * exponent), np.ldexp(movements, -exponent)
    for array in columns:
        array.setflags(write=False)
    return Relaxation(*columns)


def _checked(iterations: int, movement: float) -> tuple[int, float]:
    try:
        steps, least = operator.index(iterations), float(movement)
    except (TypeError, ValueError):
        raise ChoiceError(
            f"iterations={iterations!r}, movement={movement!r}: expected an integer and a number"
        ) from None
    if steps < 0 or not least >= 0.0:
        raise ChoiceError(f"iterations={iterations!r}, movement={movement!r}: neither may be negative, or NaN")
    return steps, least


def _refuse_outside(points: FloatArray, window: FloatArray) -> None:
    ends = np.roll(window, -1, axis=0)
    suspects = np.flatnonzero(inside_hull(window, lexicographic_order(window), points) == 0)
    bad = [i for i in suspects.tolist() if (orient2d_batch(window, ends, points[i]) < 0).any()]
    if bad:
        named = ", ".join(f"points[{i}]" for i in bad[:_NAMED])
        more = f" and {len(bad) - _NAMED} more" if len(bad) > _NAMED else ""
        raise ClipError(f"{named}{more}: outside of the window", indices=bad)


def _exponent(window: FloatArray) -> int:
    """Return the power of two that brings a window of extreme size to about 1."""
    largest = float(np.abs(window).max())
    return 0 if _SMALLEST < largest < _LARGEST else -int(np.frexp(largest)[1])
