"""What the library, and the definitions in fractions, answer to the hard cases of proofs_tests/vectors."""

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache
from typing import TypeAlias

import numpy as np
from proofs_tests.kernel import oracle as kernel_oracle
from proofs_tests.kernel import shape_oracle
from proofs_tests.oracles import RationalPoint, squared_distance
from proofs_tests.vectors.files import read
from proofs_tests.vectors.predicates import PREDICATES, Case, Predicate

import exactkernel as ek
from exactkernel.angle import AngleBound
from exactkernel.bisector import along_adaptive, crossing_order_adaptive, nearer_adaptive
from exactkernel.context import guarded_context, make_context, scaled_into_window
from exactkernel.diametral import diametral_adaptive
from exactkernel.incircle import incircle_adaptive
from exactkernel.orient2d import orient2d_adaptive
from exactkernel.shape import (
    angle_above_adaptive,
    angle_below_adaptive,
    angle_bound,
    area_above_adaptive,
    length_above_adaptive,
)

__all__ = [
    "ADAPTIVE",
    "BATCH",
    "BY_NAME",
    "NAMES",
    "SCALAR",
    "arguments",
    "by_definition",
    "cases_of",
    "in_loops",
    "points_of",
    "scalar",
    "wanted",
]

Point: TypeAlias = tuple[float, float]
Points: TypeAlias = tuple[Point, ...]
BY_NAME = {p.name: p for p in PREDICATES}
NAMES = list(BY_NAME)


@cache
def cases_of(name: str) -> tuple[tuple[str, Case], ...]:
    return tuple(read(BY_NAME[name]))


def points_of(p: Predicate, values: tuple[float, ...]) -> Points:
    numbers = values[p.coordinates]
    return tuple(zip(numbers[0::2], numbers[1::2], strict=True))


#: What a sign of the file must come to: the shapes only tell whether.
WANTED: dict[str, Callable[[int], int]] = {
    "angle_below": lambda sign: sign < 0,
    "angle_above": lambda sign: sign > 0,
    "area": lambda sign: sign > 0,
    "length": lambda sign: sign > 0,
}
SCALAR: dict[str, Callable[..., int]] = {
    "orient2d": ek.orient2d,
    "diametral": ek.diametral,
    "incircle": ek.incircle,
    "angle_below": ek.angle_below,
    "angle_above": ek.angle_above,
    "area": ek.area_above,
    "length": ek.length_above,
}
BATCH: dict[str, Callable[..., ek.types.SignArray]] = {
    "orient2d": ek.orient2d_batch,
    "diametral": ek.diametral_batch,
    "incircle": ek.incircle_batch,
}
ADAPTIVE: dict[str, Callable[..., int]] = {
    "orient2d": orient2d_adaptive,
    "diametral": diametral_adaptive,
    "incircle": incircle_adaptive,
    "nearer": nearer_adaptive,
    "along": along_adaptive,
    "crossing_order": crossing_order_adaptive,
    "angle_below": angle_below_adaptive,
    "angle_above": angle_above_adaptive,
    "area": area_above_adaptive,
    "length": length_above_adaptive,
}


def wanted(name: str, case: Case) -> int:
    return WANTED.get(name, int)(case.signs[0])


def scalar(name: str, case: Case) -> int:
    p = BY_NAME[name]
    points = points_of(p, case.values)
    function = SCALAR[name]
    return int(function(*points) if p.bound_degree is None else function(list(points), case.values[0]))


def arguments(name: str, case: Case) -> tuple[list[float | AngleBound], list[float]]:
    """The bound, if there is one, and the coordinates, triangles counterclockwise, as compiled loops hold them."""
    p = BY_NAME[name]
    points = points_of(p, case.values)
    if p.bound_degree is None:
        return [], np.ravel(points).tolist()
    if len(points) == 3 and kernel_oracle.orient2d(*points) < 0:
        points = (points[0], points[2], points[1])
    bound: float | AngleBound = angle_bound(case.values[0]) if p.bound_degree == 0 else case.values[0]
    return [bound], np.ravel(points).tolist()


def in_loops(name: str, case: Case) -> Iterator[int]:
    """The answers of a compiled loop: guarded, in the window of the case, and scaled into the window."""
    adaptive = ADAPTIVE[name]
    bounds, numbers = arguments(name, case)
    coordinates = np.array(numbers).reshape(-1, 2)
    yield int(adaptive(guarded_context(), *bounds, *numbers))
    yield int(adaptive(make_context(coordinates), *bounds, *numbers))
    if BY_NAME[name].bound_degree in (None, 0):
        scaled, context = scaled_into_window(coordinates)
        yield int(adaptive(context, *bounds, *scaled.ravel().tolist()))


def inner(p: RationalPoint, q: RationalPoint, a: RationalPoint, b: RationalPoint) -> Fraction:
    return (q[0] - p[0]) * (b[0] - a[0]) + (q[1] - p[1]) * (b[1] - a[1])


def by_definition(name: str, case: Case) -> int:
    """The sign in fractions, by the oracles of the other tests."""
    p = BY_NAME[name]
    points = points_of(p, case.values)
    if name in ("orient2d", "diametral", "incircle"):
        oracle: Callable[..., int] = getattr(kernel_oracle, name)
        return oracle(*points)
    if p.bound_degree is not None:
        function = {"area": "area_above", "length": "length_above"}.get(name, name)
        above: bool = getattr(shape_oracle, function)(points, case.values[0])
        return above
    exact = [(Fraction(x), Fraction(y)) for x, y in points]
    if name == "nearer":
        difference = squared_distance(exact[2], exact[0]) - squared_distance(exact[2], exact[1])
    elif name == "along":
        difference = inner(*exact)
    else:
        s, first, second, a, b = exact
        n_p, n_q = (squared_distance(x, a) - squared_distance(s, a) for x in (first, second))
        difference = n_p * inner(s, second, a, b) - n_q * inner(s, first, a, b)
    return (difference > 0) - (difference < 0)
