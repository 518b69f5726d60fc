"""Every input of a predicate in a tiny format, one for each that it can tell apart.

A filter sees the coordinates only through their differences, axis by axis. So inputs of one axis are put into classes:
equal exact and equal rounded differences are one class, and so are mirror images. A predicate in the plane is then
tried on all pairs of classes, one for x and one for y, and, where exchanging the axes only changes the sign of every
intermediate value or the order of a sum of two, on every unordered pair.
"""

import numpy as np
import numpy.typing as npt
from proofs_tests.rounding.minifloat import Floats, all_numbers, round_array

__all__ = ["Axis", "axis_of", "differences", "offsets"]

Axis = tuple[Floats, npt.NDArray[np.int64]]


def axis_of(
    precision: int, binades: int, points: int, wanted: tuple[tuple[int, int], ...], quantum: float = 0.0
) -> Axis:
    """Return one input for each class, and what it means exactly.

    Args:
        precision, binades, quantum: the format; its numbers are zero and all of both signs in so many binades.
        points: how many coordinates on the axis.
        wanted: the differences (i, j), coordinate i minus coordinate j, that the predicate takes.

    Returns:
        float64 (points, n) the coordinates; int64 (differences, n) their exact differences.
    """
    values = all_numbers(precision, range(binades))
    coordinates = np.array([v.ravel() for v in np.meshgrid(*[values] * points, indexing="ij")])
    exact = np.array([coordinates[i] - coordinates[j] for i, j in wanted])
    rounded = round_array(exact, precision, quantum)
    key = np.zeros(coordinates.shape[1], dtype=np.int64)
    for row in (*exact, *rounded):
        offset = np.int64(row.max())
        key = key * (2 * offset + 1) + (row.astype(np.int64) + offset)
    assert key.max() < 2**62
    _, first = np.unique(key, return_index=True)
    leading = np.zeros(len(first))
    for row in exact[::-1, first]:
        leading = np.where(row != 0.0, row, leading)
    kept = first[leading >= 0.0]
    return coordinates[:, kept], exact[:, kept].astype(np.int64)


def differences(precision: int, binades: int, quantum: float = 0.0) -> Axis:
    """Return the classes of two differences of four coordinates: all pairs of classes of one difference.

    A class of one difference is its exact and its rounded value; so many coordinates would be too many to enumerate.
    """
    coordinates, exact = axis_of(precision, binades, 2, ((0, 1),), quantum)
    both = np.concatenate([coordinates, coordinates[::-1, 1:]], axis=1)  # the mirror images of all but zero
    signed = np.concatenate([exact, -exact[:, 1:]], axis=1)
    assert exact[0, 0] == 0
    i, j = (v.ravel() for v in np.meshgrid(np.arange(exact.shape[1]), np.arange(signed.shape[1]), indexing="ij"))
    return np.concatenate([coordinates[:, i], both[:, j]]), np.concatenate([exact[:, i], signed[:, j]])


def offsets(largest: int, points: int) -> Axis:
    """Return one axis of all points whose offsets from a last point, at 0, are integers up to ``largest``."""
    values = np.arange(-largest, largest + 1, dtype=np.float64)
    exact = np.array([v.ravel() for v in np.meshgrid(*[values] * points, indexing="ij")])
    leading = np.zeros(exact.shape[1])
    for row in exact[::-1]:
        leading = np.where(row != 0.0, row, leading)
    exact = exact[:, leading >= 0.0]
    return np.concatenate([exact, np.zeros((1, exact.shape[1]))]), exact.astype(np.int64)
