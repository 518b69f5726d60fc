"""K7 for the predicates about bisectors: the sign in fractions, for all finite doubles, at every stage."""

from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from proofs_tests.kernel.strategies import Point, point_tuples
from proofs_tests.oracles import RationalPoint, rationals, squared_distance

from exactkernel import bisector
from exactkernel.bisector import along_adaptive, crossing_order_adaptive, nearer_adaptive
from exactkernel.context import Context, guarded_context, scaled_into_window


def sign(x: Fraction) -> int:
    return (x > 0) - (x < 0)


def inner(p: RationalPoint, q: RationalPoint, a: RationalPoint, b: RationalPoint) -> Fraction:
    return (q[0] - p[0]) * (b[0] - a[0]) + (q[1] - p[1]) * (b[1] - a[1])


def numerator(s: RationalPoint, p: RationalPoint, a: RationalPoint) -> Fraction:
    """How far the bisector of s and p is from a, times twice the distance of s and p: |p - a|^2 - |s - a|^2."""
    return squared_distance(p, a) - squared_distance(s, a)


def nearer(p: RationalPoint, q: RationalPoint, x: RationalPoint) -> int:
    return sign(squared_distance(x, p) - squared_distance(x, q))


def crossing_order(
    s: RationalPoint, p: RationalPoint, q: RationalPoint, a: RationalPoint, b: RationalPoint
) -> int:  # fmt: skip
    return sign(numerator(s, p, a) * inner(s, q, a, b) - numerator(s, q, a) * inner(s, p, a, b))


def adaptive(name: str, points: tuple[Point, ...], k: Context | None = None) -> int:
    """The sign of the library, in the window of these points or guarded."""
    flat = np.array(points, dtype=np.float64)
    if k is None:
        flat, k = scaled_into_window(flat)
    with np.errstate(over="ignore", invalid="ignore"):
        values = flat.reshape(-1).tolist()
        if name == "nearer":
            return int(nearer_adaptive(k, *values[:6]))
        if name == "along":
            return int(along_adaptive(k, *values[:8]))
        return int(crossing_order_adaptive(k, *values[:10]))


ORACLES: dict[str, Callable[..., int]] = {
    "nearer": nearer,
    "along": lambda p, q, a, b: sign(inner(p, q, a, b)),
    "crossing order": crossing_order,
}
ARITY = {"nearer": 3, "along": 4, "crossing order": 5}


@pytest.mark.obligation(
    "K7", "the predicates about bisectors equal the sign in fractions for all finite doubles", method="property-based"
)
class TestBisectors:
    """Each sign is that of the fractions, within the window and guarded."""

    @pytest.mark.parametrize("name", ORACLES)
    @given(points=point_tuples(5))
    def test_signs(self, name: str, points: tuple[Point, ...]) -> None:
        wanted = ORACLES[name](*rationals(points)[: ARITY[name]])
        assert adaptive(name, points) == wanted
        assert adaptive(name, points, guarded_context()) == wanted

    @given(points=point_tuples(3))
    def test_ties(self, points: tuple[Point, ...]) -> None:
        """Mirrored sites are as near; right angles; the diagonal of a rectangle meets two bisectors at once."""
        (ax, ay), (bx, by), _ = points
        mirrored = ((ax, ay), (ax, -ay), (bx, 0.0))
        assert adaptive("nearer", mirrored) == 0
        turned = ((0.0, 0.0), (ax, ay), (-ay, ax), (0.0, 0.0), (-ay, ax))  # along: a right angle
        assert adaptive("along", (*turned[:2], (0.0, 0.0), turned[2], points[0])) == 0
        square = (
            (ax, ay),
            (-ax, ay),
            (ax, -ay),
            (-ax, -by),
            (ax, by),
        )  # s, p, q mirrored: crossings agree in the origin
        centre = crossing_order(*rationals((*square[:3], (-ax, -ay), (ax, ay))))
        assert adaptive("crossing order", (*square[:3], (-ax, -ay), (ax, ay))) == centre == 0

    def test_control_plain_doubles_are_wrong(self) -> None:
        """The filters' formulas, believed without their bounds, lie near ties."""
        random = np.random.default_rng(0)
        lies = 0
        for _ in range(300):
            p, q = random.random((2, 2))
            x = (p + q) / 2 + np.array([p[1] - q[1], q[0] - p[0]]) * random.random()  # rounded onto the bisector
            plain = np.sign(((x - p) ** 2).sum() - ((x - q) ** 2).sum())
            lies += int(plain) != nearer(*rationals([p, q, x]))
        assert lies > 20

    def test_control_without_its_bound_the_filter_lies(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """The bound of the filter set to zero."""
        random = np.random.default_rng(0)
        function = getattr(nearer_adaptive, "py_func", nearer_adaptive)
        monkeypatch.setattr(bisector, "_NEARER_BOUND", 0.0)
        lies = 0
        for _ in range(300):
            p, q = random.random((2, 2))
            x = (p + q) / 2 + np.array([p[1] - q[1], q[0] - p[0]]) * random.random()
            _, k = scaled_into_window(np.array([p, q, x]))
            lies += int(function(k, *p.tolist(), *q.tolist(), *x.tolist())) != nearer(*rationals([p, q, x]))
        assert lies > 0
