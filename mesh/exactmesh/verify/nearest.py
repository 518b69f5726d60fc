"""The nearest corner of the mesh to a position, exactly: a k-d tree, and rationals where doubles cannot tell."""

import math

import numpy as np
from gmpy2 import mpq

from exactkernel.jit import jit
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray
from exactmesh.verify.witness import IndexArray

__all__ = ["nearest_corners", "squared_distance"]

_LEAF = 48
_DEPTH = 64  # more than twice the logarithm of any number of points
_CHUNK = 1 << 14  # positions between two looks at Ctrl-C
#: Coordinates up to 2^500: squares do not overflow, what underflows is below the one slack, roundings below the other.
_EXPONENT = 500
_RELATIVE, _ABSOLUTE = 1.0 + 2.0**-40, 2.0**-500


def _tree(points: FloatArray) -> IndexArray:
    """Return an order in which the middle of each part splits it, by x and y in turn; small parts stay as they are."""
    order = np.arange(len(points), dtype=np.intp)
    stack = [(0, len(points), 0)]
    while stack:
        low, high, axis = stack.pop()
        if high - low <= _LEAF:
            continue
        middle = (low + high) >> 1
        part = order[low:high]
        order[low:high] = part[np.argpartition(points[part, axis], middle - low)]
        stack += [(low, middle, 1 - axis), (middle + 1, high, 1 - axis)]
    return order


@jit
def within_reach(
    points: FloatArray, order: IndexArray, x: float, y: float, reach: float, stack: IndexArray, found: IndexArray
) -> tuple[float, int]:
    """Return the squared distance of the nearest point, and write those that are hardly farther; return how many.

    Only with a ``reach`` that is known (not infinite) are all of them written, as far as there is room.
    """
    best, n, top = reach, 0, 3
    stack[0], stack[1], stack[2] = 0, len(order), 0
    while top > 0:
        top -= 3
        low, high, axis = stack[top], stack[top + 1], stack[top + 2]
        begin, end = low, high
        if high - low > _LEAF:
            begin = (low + high) >> 1
            end = begin + 1
        for i in range(begin, end):
            dx, dy = points[order[i], 0] - x, points[order[i], 1] - y
            squared = dx * dx + dy * dy
            if reach == math.inf:
                best = min(best, squared)
            elif squared <= reach:
                if n < len(found):
                    found[n] = order[i]
                n += 1
        if high - low <= _LEAF:
            continue
        across = (x if axis == 0 else y) - points[order[begin], axis]
        is_far_in_reach = across * across <= best * _RELATIVE + _ABSOLUTE
        near_low = across < 0.0
        if is_far_in_reach:  # the nearer side comes on top
            stack[top], stack[top + 1], stack[top + 2] = (end, high, 1 - axis) if near_low else (low, begin, 1 - axis)
            top += 3
        stack[top], stack[top + 1], stack[top + 2] = (low, begin, 1 - axis) if near_low else (end, high, 1 - axis)
        top += 3
    return best, n


@jit
def find_nearest(
    points: FloatArray, order: IndexArray, wanted: FloatArray, stack: IndexArray, found: IndexArray, counts: IndexArray
) -> None:
    """Write the candidates for each wanted position, and how many there are."""
    for i in range(len(wanted)):
        x, y = wanted[i, 0], wanted[i, 1]
        best, _ = within_reach(points, order, x, y, math.inf, stack, found[i])
        _, counts[i] = within_reach(points, order, x, y, best * _RELATIVE + _ABSOLUTE, stack, found[i])


def squared_distance(p: FloatArray, q: FloatArray) -> mpq:
    """Return the exact squared distance of two positions."""
    (px, py), (qx, qy) = ((mpq(x), mpq(y)) for x, y in (p.tolist(), q.tolist()))
    return (px - qx) * (px - qx) + (py - qy) * (py - qy)


def nearest_corners(points: FloatArray, corners: IndexArray, wanted: FloatArray) -> IndexArray:
    """Return for each wanted position the corner nearest to it, of equally near ones that of the smallest index.

    Args:
        points: (n, 2), finite.
        corners: those rows of it that count, ascending; at least one.
        wanted: (w, 2), finite.

    O((c + w) log c) where corners are distinct.
    """
    largest = max(float(np.abs(points[corners]).max()), float(np.abs(wanted).max(initial=0.0)))
    exponent = _EXPONENT - math.frexp(largest)[1]
    scaled, positions = np.ldexp(points[corners], exponent), np.ldexp(wanted, exponent)
    order = _tree(scaled)
    stack = np.empty(3 * _DEPTH, dtype=np.intp)
    nearest = np.empty(len(wanted), dtype=np.intp)
    for begin in range(0, len(wanted), _CHUNK):
        part = positions[begin : begin + _CHUNK]
        found, counts = np.empty((len(part), 4), dtype=np.intp), np.empty(len(part), dtype=np.intp)
        find_nearest(scaled, order, part, stack, found, counts)
        raise_if_interrupted()
        nearest[begin : begin + len(part)] = corners[found[:, 0]]
        for i in np.flatnonzero(counts > 1).tolist():
            near = found[i, : counts[i]]
            if counts[i] > found.shape[1]:  # a circle round it, or many at one place
                near = np.empty(int(counts[i]), dtype=np.intp)
                best, _ = within_reach(scaled, order, part[i, 0], part[i, 1], math.inf, stack, near)
                within_reach(scaled, order, part[i, 0], part[i, 1], best * _RELATIVE + _ABSOLUTE, stack, near)
            rows = np.sort(corners[near]).tolist()
            nearest[begin + i] = min(rows, key=lambda v: squared_distance(points[v], wanted[begin + i]))
            raise_if_interrupted()
    return nearest
