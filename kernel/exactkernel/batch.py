"""The predicates over arrays: float64 of shape (n, 2) or (2,), broadcast against each other, int8 signs out."""

from __future__ import annotations  # help() shows ArrayLike, not all that it stands for

import numpy as np
import numpy.typing as npt

from exactkernel.arrays import finite_points, unrounded_array
from exactkernel.context import Context, chunk_size, scaled_into_window
from exactkernel.diametral import diametral_adaptive
from exactkernel.errors import ShapeError
from exactkernel.incircle import incircle_adaptive
from exactkernel.jit import jit
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray, SignArray

__all__ = ["diametral_batch", "incircle_batch", "orient2d_batch"]

_CHUNK = 1 << 20  # compiled code cannot be interrupted: Ctrl-C waits for this many calls at most


@jit
def _orient2d_loop(k: Context, a: FloatArray, b: FloatArray, c: FloatArray, signs: SignArray) -> None:
    for i in range(len(signs)):
        signs[i] = orient2d_adaptive(k, a[i, 0], a[i, 1], b[i, 0], b[i, 1], c[i, 0], c[i, 1])


@jit
def _diametral_loop(k: Context, a: FloatArray, b: FloatArray, p: FloatArray, signs: SignArray) -> None:
    for i in range(len(signs)):
        signs[i] = diametral_adaptive(k, a[i, 0], a[i, 1], b[i, 0], b[i, 1], p[i, 0], p[i, 1])


@jit
def _incircle_loop(k: Context, a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray, signs: SignArray) -> None:
    for i in range(len(signs)):
        signs[i] = incircle_adaptive(
            k, a[i, 0], a[i, 1], b[i, 0], b[i, 1], c[i, 0], c[i, 1], d[i, 0], d[i, 1]
        )  # fmt: skip


def _broadcast(**operands: npt.ArrayLike) -> tuple[list[FloatArray], Context]:
    """Check the operands, broadcast them to one length, and find the window of all of them together."""
    rows: list[FloatArray] = []
    for name, operand in operands.items():
        array = unrounded_array(operand, name)
        if array.ndim not in (1, 2) or array.shape[-1] != 2:
            raise ShapeError(f"{name} has shape {array.shape}; expected (n, 2) or (2,)")
        rows.append(finite_points(array.reshape(-1, 2), name))
    lengths = {len(points) for points in rows if len(points) != 1}
    if len(lengths) > 1:
        shapes = ", ".join(f"{name} {len(points)}" for name, points in zip(operands, rows, strict=True))
        raise ShapeError(f"the lengths do not broadcast: {shapes}")
    n = lengths.pop() if lengths else 1
    scaled, context = scaled_into_window(np.concatenate(rows))
    rows = np.split(scaled, np.cumsum([len(points) for points in rows])[:-1])
    return [np.broadcast_to(points, (n, 2)) if len(points) == 1 else points for points in rows], context


def orient2d_batch(a: npt.ArrayLike, b: npt.ArrayLike, c: npt.ArrayLike) -> SignArray:
    """Return the signs of :func:`orient2d` over arrays of points.

    Args:
        a, b, c: float64 of shape (n, 2), or (2,) for one point against all. Integers are taken where they are doubles.

    Returns:
        int8 (n,): +1 counterclockwise, 0 collinear, -1 clockwise.

    Raises:
        NonFiniteError, CoordinateError, ShapeError: with the indices of the culprits.

    O(n).

    >>> from exactkernel import orient2d_batch
    >>> orient2d_batch((0, 0), (1, 1), [(0, 1), (2, 2), (1, 0)])
    array([ 1,  0, -1], dtype=int8)
    """
    (a, b, c), k = _broadcast(a=a, b=b, c=c)
    signs = np.empty(len(a), dtype=np.int8)
    step = chunk_size(k, _CHUNK)
    for start in range(0, len(signs), step):
        part = slice(start, start + step)
        _orient2d_loop(k, a[part], b[part], c[part], signs[part])
        raise_if_interrupted()
    return signs


def diametral_batch(a: npt.ArrayLike, b: npt.ArrayLike, p: npt.ArrayLike) -> SignArray:
    """Return the signs of :func:`diametral` over arrays of points.

    Arguments, errors and cost as for :func:`orient2d_batch`.

    Returns:
        int8 (n,): +1 where p lies inside the circle with diameter ab, 0 on it, -1 outside.

    >>> from exactkernel import diametral_batch
    >>> diametral_batch((0, 0), (2, 0), [(1, 0.5), (1, 1), (1, 2)])
    array([ 1,  0, -1], dtype=int8)
    """
    (a, b, p), k = _broadcast(a=a, b=b, p=p)
    signs = np.empty(len(a), dtype=np.int8)
    step = chunk_size(k, _CHUNK)
    for start in range(0, len(signs), step):
        part = slice(start, start + step)
        _diametral_loop(k, a[part], b[part], p[part], signs[part])
        raise_if_interrupted()
    return signs


def incircle_batch(a: npt.ArrayLike, b: npt.ArrayLike, c: npt.ArrayLike, d: npt.ArrayLike) -> SignArray:
    """Return the signs of :func:`incircle` over arrays of points.

    Arguments, errors and cost as for :func:`orient2d_batch`.

    Returns:
        int8 (n,): +1 where d lies inside the circle of counterclockwise a, b, c, 0 on it, -1 outside.

    >>> from exactkernel import incircle_batch
    >>> incircle_batch((0, 0), (1, 0), (1, 1), [(0.5, 0.5), (0, 1), (2, 2)])
    array([ 1,  0, -1], dtype=int8)
    """
    (a, b, c, d), k = _broadcast(a=a, b=b, c=c, d=d)
    signs = np.empty(len(a), dtype=np.int8)
    step = chunk_size(k, _CHUNK)
    for start in range(0, len(signs), step):
        part = slice(start, start + step)
        _incircle_loop(k, a[part], b[part], c[part], d[part], signs[part])
        raise_if_interrupted()
    return signs
