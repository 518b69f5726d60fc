"""Hypothesis strategies for points where predicates are hard: nearly degenerate, badly scaled, extreme doubles."""

import math
from typing import TypeAlias

from hypothesis import strategies as st

__all__ = ["Point", "finite", "point_tuples"]

Point: TypeAlias = tuple[float, float]
Points: TypeAlias = tuple[Point, ...]

finite = st.floats(allow_nan=False, allow_infinity=False)
unit = st.floats(min_value=-1.0, max_value=1.0)
exponents = st.integers(-540, 500)
few_ulps = st.integers(-3, 3)

#: The smallest subnormal; around the square and fourth roots of it; the largest doubles.
EXTREMES = (0.0, -0.0, 5e-324, 1e-308, 2.0**-537, 3 * 2.0**-268, 1e-200, 1.0, 1e200, 2.0**253, 2.0**509, 1.7e308)


def moved(x: float, ulps: int) -> float:
    """Return the double so many places further; the largest stays where it is."""
    for _ in range(abs(ulps)):
        x = math.nextafter(x, math.copysign(math.inf, ulps))
    return max(min(x, 1.7976931348623157e308), -1.7976931348623157e308)


def scaled(points: Points, exponent: int) -> Points:
    return tuple((math.ldexp(x, exponent), math.ldexp(y, exponent)) for x, y in points)


@st.composite
def near_line(draw: st.DrawFn, n: int) -> Points:
    (ax, ay), (bx, by) = draw(st.tuples(st.tuples(unit, unit), st.tuples(unit, unit)))
    parameters = draw(st.lists(st.floats(-2.0, 3.0), min_size=n, max_size=n))
    shifts = draw(st.lists(st.tuples(few_ulps, few_ulps), min_size=n, max_size=n))
    points = tuple(
        (moved(ax + t * (bx - ax), i), moved(ay + t * (by - ay), j))
        for t, (i, j) in zip(parameters, shifts, strict=True)
    )
    return scaled(points, draw(exponents))


@st.composite
def near_circle(draw: st.DrawFn, n: int) -> Points:
    cx, cy, radius = draw(unit), draw(unit), draw(st.floats(0.25, 1.0))
    angles = draw(st.lists(st.floats(0.0, 6.3), min_size=n, max_size=n))
    shifts = draw(st.lists(st.tuples(few_ulps, few_ulps), min_size=n, max_size=n))
    points = tuple(
        (moved(cx + radius * math.cos(t), i), moved(cy + radius * math.sin(t), j))
        for t, (i, j) in zip(angles, shifts, strict=True)
    )
    return scaled(points, draw(exponents))


@st.composite
def lattice(draw: st.DrawFn, n: int) -> Points:
    """A few steps of one power of two: exact ties, from the subnormals to 2^960, perhaps far from the origin."""
    exponent = draw(st.one_of(st.integers(-1074, 900), st.sampled_from([-1074, -540, -537, -536, -269, -268, -267, 0])))
    offset = draw(st.sampled_from([0, 0, 2**40, -(2**51)]))
    steps = st.integers(-4, 4) if draw(st.booleans()) else st.integers(-5000, 5000)
    return tuple(
        (math.ldexp(float(offset + draw(steps)), exponent), math.ldexp(float(draw(steps) - offset), exponent))
        for _ in range(n)
    )


@st.composite
def on_circle(draw: st.DrawFn, n: int) -> Points:
    """Integer points on a circle about the origin, shifted by integers and scaled: exactly cocircular."""
    shapes = [(25, 0), (24, 7), (20, 15), (15, 20), (7, 24), (0, 25)]
    signs = st.sampled_from([-1, 1])
    shift_x, shift_y = draw(st.integers(-(10**6), 10**6)), draw(st.integers(-(2**46), 2**46))
    factor = draw(st.sampled_from([1, 1001, 2**20 + 1]))
    points = []
    for _ in range(n):
        x, y = draw(st.sampled_from(shapes))
        points.append((float(draw(signs) * x * factor + shift_x), float(draw(signs) * y * factor + shift_y)))
    return scaled(tuple(points), draw(exponents))


@st.composite
def mixed(draw: st.DrawFn, n: int) -> Points:
    value = st.one_of(st.sampled_from(EXTREMES), finite)
    signed = st.builds(lambda x, negative: -x if negative else x, value, st.booleans())
    return tuple((draw(signed), draw(signed)) for _ in range(n))


def point_tuples(n: int) -> st.SearchStrategy[Points]:
    """Tuples of n points from every one of the families."""
    return st.one_of(near_line(n), near_circle(n), lattice(n), on_circle(n), mixed(n))
