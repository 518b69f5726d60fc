"""The exact sign of every predicate, in integers: all coordinates are multiples of one power of two."""

from collections.abc import Sequence
from fractions import Fraction

from proofs_tests.kernel.shape_oracle import compare_angle

__all__ = [
    "along",
    "angle_above",
    "angle_below",
    "area",
    "crossing_order",
    "diametral",
    "incircle",
    "incircle_perturbed",
    "length",
    "nearer",
    "orient2d",
    "sign",
]

Values = Sequence[float]
Whole = tuple[int, int]


def sign(x: int | Fraction) -> int:
    """Return -1, 0 or 1."""
    return (x > 0) - (x < 0)


def whole(values: Values) -> list[Whole]:
    """Return the points, all multiplied by one power of two that makes their coordinates integers."""
    ratios = [value.as_integer_ratio() for value in values]
    common = max(denominator for _, denominator in ratios)
    integers = [numerator * (common // denominator) for numerator, denominator in ratios]
    return list(zip(integers[0::2], integers[1::2], strict=True))


def area2(a: Whole, b: Whole, c: Whole) -> int:
    """Return twice the signed area: the sum of x (difference of the other two y)."""
    return a[0] * (b[1] - c[1]) + b[0] * (c[1] - a[1]) + c[0] * (a[1] - b[1])


def dot(a: Whole, b: Whole, c: Whole, d: Whole) -> int:
    """Return (b - a) (d - c)."""
    return (b[0] - a[0]) * (d[0] - c[0]) + (b[1] - a[1]) * (d[1] - c[1])


def lifted(a: Whole, b: Whole, c: Whole, d: Whole, lifts: Sequence[int]) -> int:
    """Return the determinant of rows (x, y, lift, 1), developed by the lifts."""
    minors = (area2(b, c, d), -area2(a, c, d), area2(a, b, d), -area2(a, b, c))
    return sum(lift * minor for lift, minor in zip(lifts, minors, strict=True))


def orient2d(values: Values) -> int:
    """Return +1 if a, b, c turn counterclockwise."""
    a, b, c = whole(values)
    return sign(area2(a, b, c))


def diametral(values: Values) -> int:
    """Return +1 if p lies inside the circle with diameter ab."""
    a, b, p = whole(values)
    return -sign(dot(p, a, p, b))


def incircle(values: Values) -> int:
    """Return +1 if d lies inside the circle through counterclockwise a, b, c."""
    a, b, c, d = points = whole(values)
    return sign(lifted(a, b, c, d, [x * x + y * y for x, y in points]))


def incircle_perturbed(values: Values) -> int:
    """Return incircle, ties broken: the lexicographically smallest point is lifted infinitely more than the next."""
    points = whole(values)
    if len(set(points)) < 4:
        return 0
    a, b, c, d = points
    order = sorted(range(4), key=lambda i: points[i])
    signs = [incircle(values), *(sign(lifted(a, b, c, d, [int(i == first) for i in range(4)])) for first in order)]
    return next((found for found in signs if found != 0), 0)


def nearer(values: Values) -> int:
    """Return +1 if x is nearer to q than to p."""
    p, q, x = whole(values)
    return sign(dot(p, x, p, x) - dot(q, x, q, x))


def along(values: Values) -> int:
    """Return the sign of (q - p) (b - a)."""
    p, q, a, b = whole(values)
    return sign(dot(p, q, a, b))


def crossing_order(values: Values) -> int:
    """Return the sign of N(p) D(q) - N(q) D(p), N(x) = |x - a|^2 - |s - a|^2, D(x) = (x - s) (b - a)."""
    s, p, q, a, b = whole(values)
    to_s = dot(a, s, a, s)
    return sign((dot(a, p, a, p) - to_s) * dot(s, q, a, b) - (dot(a, q, a, q) - to_s) * dot(s, p, a, b))


def _angles(values: Values) -> list[int]:
    """Return the signs of the three angles minus the bound, for a triangle that is none on a line."""
    degrees, points = Fraction(values[0]), whole(values[1:])
    a, b, c = points
    turned = ((a, b, c), (b, c, a), (c, a, b))
    return [compare_angle(p, q, r, degrees) for p, q, r in turned]


def angle_below(values: Values) -> int:
    """Return the sign of the smallest angle minus the bound in degrees."""
    return min(_angles(values))


def angle_above(values: Values) -> int:
    """Return the sign of the largest angle minus the bound in degrees."""
    return max(_angles(values))


def area(values: Values) -> int:
    """Return the sign of the area minus the bound."""
    (ax, ay), (bx, by), (cx, cy) = _fractions(values[1:])
    doubled = (ax - cx) * (by - cy) - (ay - cy) * (bx - cx)
    return sign(abs(doubled) - 2 * Fraction(values[0]))


def length(values: Values) -> int:
    """Return the sign of the length of ab minus the bound, which is not negative."""
    (ax, ay), (bx, by) = _fractions(values[1:])
    return sign((ax - bx) ** 2 + (ay - by) ** 2 - Fraction(values[0]) ** 2)


def _fractions(values: Values) -> list[tuple[Fraction, Fraction]]:
    exact = [Fraction(value) for value in values]
    return list(zip(exact[0::2], exact[1::2], strict=True))
