"""Random points: uniform, clustered, far off, of mixed scales, subnormal. All are distinct within a set."""

import numpy as np
from hypothesis import strategies as st

from exactkernel.types import FloatArray
from exactmesh.strategies.drawing import bits_for, check_sizes, codes, distinct, lattice, scattered, seeds, units

__all__ = ["clustered_points", "far_points", "mixed_scale_points", "subnormal_points", "uniform_points"]

#: Where the offsets of float meshers' known failures lie, and further up to where one step of a double is 1.
_OFFSETS = (1e5, 1e6, 2.0**20, 2.0**26, 2.0**30, 1e12, 2.0**45, 2.0**52)
_DIRECTIONS = ((1, 1), (1, 0), (0, 1), (-1, 1), (-1, -1))
_LEAST_EXPONENT = -1074  # of the smallest subnormal


def uniform_points(*, min_size: int = 3, max_size: int = 20) -> st.SearchStrategy[FloatArray]:
    """Draw points spread evenly, distinct: integers below 2^10 or 2^20, or all 53 bits in the unit square.

    Float predicates are right on nearly all of them: what fails here is a blunder.

    Args:
        min_size, max_size: how many points.

    Returns:
        A strategy for float64 (n, 2). It shrinks to the first cells of a lattice: (0, 0), (1, 0), (0, 1), (1, 1), ...

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import uniform_points
    >>> find(uniform_points(), lambda points: len(points) > 3).tolist()
    [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]
    """
    check_sizes(min_size, max_size)
    return _uniform(min_size, max_size)


@st.composite
def _uniform(draw: st.DrawFn, low: int, high: int) -> FloatArray:
    numbers, seed = draw(codes(low, high)), draw(seeds)
    bits = draw(st.sampled_from((10, 20, 53)))
    if seed == 0:
        return lattice(numbers)
    bits = bits_for(len(numbers), bits)
    return distinct(units(seed, numbers, bits) * (2.0**bits if bits < 53 else 1.0))


def clustered_points(*, min_size: int = 3, max_size: int = 20) -> st.SearchStrategy[FloatArray]:
    """Draw a few clusters, 2^-4 to 2^-44 wide, and lone points between them, distinct.

    Breaks tolerances and snapping, which merge what lies close, and grids of cells, where all points are in one cell.

    Args:
        min_size, max_size: how many points.

    Returns:
        A strategy for float64 (n, 2) in 0 .. 256.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import clustered_points
    >>> find(clustered_points(max_size=9), lambda points: len(points) == 4).shape
    (4, 2)
    """
    check_sizes(min_size, max_size)
    return _clustered(min_size, max_size)


@st.composite
def _clustered(draw: st.DrawFn, low: int, high: int) -> FloatArray:
    numbers, seed = draw(codes(low, high)), draw(seeds)
    clusters, exponent = draw(st.integers(1, 4)), draw(st.integers(4, 44))
    if seed == 0:
        return lattice(numbers)
    own = scattered(seed, numbers) % np.uint64(clusters + 1)  # the last one's points are on their own
    width = np.where(own < clusters, 2.0**-exponent, 128.0)
    # offsets of few bits, so that the sum is exact
    return distinct(
        np.floor(units(seed + 1, own, 7) * 128) + units(seed, numbers, bits_for(len(numbers), 8)) * width[:, None]
    )


def far_points(*, min_size: int = 3, max_size: int = 20) -> st.SearchStrategy[FloatArray]:
    """Draw points of a small box far from the origin, distinct: 1e5, 1e6, 2^20 to 2^52 away.

    The products of coordinates no longer fit into doubles: what does not subtract first, or lifts coordinates to a
    paraboloid, drops points and inverts triangles. Map coordinates are such points.

    Args:
        min_size, max_size: how many points.

    Returns:
        A strategy for float64 (n, 2). It shrinks to small integers plus 1e5.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import far_points
    >>> find(far_points(), lambda points: points.min() >= 1e6).tolist()
    [[1000000.0, 1000000.0], [1000001.0, 1000000.0], [1000000.0, 1000001.0]]
    """
    check_sizes(min_size, max_size)
    return _far(min_size, max_size)


@st.composite
def _far(draw: st.DrawFn, low: int, high: int) -> FloatArray:
    numbers, seed = draw(codes(low, high)), draw(seeds)
    offset, direction = draw(st.sampled_from(_OFFSETS)), draw(st.sampled_from(_DIRECTIONS))
    width = draw(st.integers(0, 40))
    if seed == 0:
        return lattice(numbers) + np.multiply(direction, offset)
    bits = bits_for(len(numbers), 10)
    steps = float(np.spacing(offset)) * 2.0 ** min(
        width, 52 - bits
    )  # some places of the last bits, up to as wide as far
    return distinct(np.multiply(direction, offset) + units(seed, numbers, bits) * 2.0**bits * steps)


def mixed_scale_points(*, min_size: int = 3, max_size: int = 20) -> st.SearchStrategy[FloatArray]:
    """Draw coordinates each with an exponent of its own, from a few up to all of -1000 .. 1000, distinct points.

    Products overflow to infinity and underflow to zero; bounding boxes, sums and tolerances lose the small ones.

    Args:
        min_size, max_size: how many points.

    Returns:
        A strategy for float64 (n, 2), both signs.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import mixed_scale_points
    >>> bool((abs(find(mixed_scale_points(), lambda points: points.max() > 1e200)) <= 1e302).all())
    True
    """
    check_sizes(min_size, max_size)
    return _mixed_scale(min_size, max_size)


@st.composite
def _mixed_scale(draw: st.DrawFn, low: int, high: int) -> FloatArray:
    numbers, seed = draw(codes(low, high)), draw(seeds)
    spread = draw(st.sampled_from((4, 20, 60, 300, 1000)))
    if seed == 0:
        return lattice(numbers)
    signed = 2.0 * units(seed, numbers, 53) - 1.0
    exponents = np.floor(units(seed + 1, numbers, 53) * (2 * spread + 1)) - spread
    return distinct(np.ldexp(signed, exponents.astype(np.int64)))


def subnormal_points(*, min_size: int = 3, max_size: int = 20) -> st.SearchStrategy[FloatArray]:
    """Draw multiples of a tiny number, from 2^-1074, the smallest double, to 2^-480; distinct.

    Products of differences underflow: determinants in doubles are 0, or have the wrong sign, and no relative error
    bound holds. Subnormal differences are exact, so that the points are as good as any.

    Args:
        min_size, max_size: how many points.

    Returns:
        A strategy for float64 (n, 2), both signs.

    Raises:
        OptionError: sizes that are no integers, negative, or in the wrong order.

    >>> from hypothesis import find
    >>> from exactmesh.strategies import subnormal_points
    >>> find(subnormal_points(), lambda points: True).tolist()
    [[0.0, 0.0], [5e-324, 0.0], [0.0, 5e-324]]
    """
    check_sizes(min_size, max_size)
    return _subnormal(min_size, max_size)


@st.composite
def _subnormal(draw: st.DrawFn, low: int, high: int) -> FloatArray:
    numbers, seed = draw(codes(low, high)), draw(seeds)
    exponent, bits = (
        draw(st.sampled_from((_LEAST_EXPONENT, -1022, -900, -800, -545, -537, -480))),
        draw(st.integers(3, 52)),
    )
    if seed == 0:
        return np.ldexp(lattice(numbers), exponent)
    bits = min(52, bits_for(len(numbers), bits))
    centred = np.ldexp(units(seed, numbers, bits), bits) - 2.0 ** (bits - 1)
    return distinct(np.ldexp(centred, exponent))
