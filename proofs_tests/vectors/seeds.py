"""Degenerate configurations of every predicate: exact ones in small integers, and ones that lose their exactness when
they are rounded to doubles."""

from fractions import Fraction
from math import isqrt

from proofs_tests.kernel.shape_oracle import cosine_interval
from proofs_tests.vectors.randomness import Random

__all__ = ["Exact", "nearly", "zero"]

Exact = list[Fraction]
Point = tuple[Fraction, Fraction]
#: Gaussian primes: products of them and of their conjugates have the same norm, so they lie on one circle.
_PRIMES = ((2, 1), (3, 2), (4, 1), (5, 2), (6, 1), (5, 4), (7, 2))
#: Bounds on angles, in degrees; two of them are no short decimals.
_SMALL_ANGLES = (1e-5, 1.0, 20.0, 20.7, 26.45, 30.0, 33.8, 35.264389682754654, 45.0, 50.0)
_LARGE_ANGLES = (65.0, 75.52248781407008, 90.0, 100.0, 120.0, 135.0, 137.1, 150.0, 179.0, 179.99999)


def flat(*points: Point) -> Exact:
    """Return x0, y0, x1, ..."""
    return [coordinate for point in points for coordinate in point]


def step(p: Point, t: Fraction | int, d: Point) -> Point:
    """Return p + t d."""
    return p[0] + t * d[0], p[1] + t * d[1]


def left_of(d: Point) -> Point:
    """Return d turned by 90 degrees."""
    return -d[1], d[0]


def difference(p: Point, q: Point) -> Point:
    """Return q - p."""
    return q[0] - p[0], q[1] - p[1]


def lattice(r: Random, size: int) -> Point:
    """Return a point with integer coordinates."""
    return Fraction(r.integer(-size, size)), Fraction(r.integer(-size, size))


def anywhere(r: Random) -> Point:
    """Return a point whose coordinates use all 53 bits."""
    return r.double(), r.double()


def same_norms(r: Random, n: int) -> list[Point]:
    """Return integer vectors of one length: up to some 2^20."""
    primes = [r.choice(_PRIMES) for _ in range(r.integer(2, 6))]
    vectors = []
    for _ in range(n):
        x, y = r.choice(((1, 0), (0, 1), (-1, 0), (0, -1)))
        for a, b in primes:
            b = r.choice((b, -b))
            x, y = a * x - b * y, a * y + b * x
        vectors.append((Fraction(x), Fraction(y)))
    return vectors


def same_norms_rounded(r: Random, n: int) -> list[Point]:
    """Return rational vectors of one length, by the rational parametrisation of the circle."""
    x, y = anywhere(r)
    vectors = []
    for _ in range(n):
        s = r.fraction() * r.choice((1, 5))
        c, t = (1 - s * s) / (1 + s * s), 2 * s / (1 + s * s)
        vectors.append((c * x - t * y, c * y + t * x))
    return vectors


def orient2d_zero(r: Random) -> Exact:
    a, d = lattice(r, 2**30), lattice(r, 2**20)
    return flat(a, step(a, r.integer(-1000, 1000), d), step(a, r.integer(-1000, 1000), d))


def orient2d_nearly(r: Random) -> Exact:
    a, b = anywhere(r), anywhere(r)
    return flat(a, b, step(a, 2 * r.fraction(), difference(a, b)))


def diametral_zero(r: Random) -> Exact:
    p, d = lattice(r, 2**30), lattice(r, 2**20)
    return flat(step(p, r.integer(-1000, 1000), d), step(p, r.integer(-1000, 1000), left_of(d)), p)


def diametral_nearly(r: Random) -> Exact:
    m = anywhere(r)
    u, v = same_norms_rounded(r, 2)
    return flat(step(m, 1, u), step(m, -1, u), step(m, 1, v))


def incircle_zero(r: Random) -> Exact:
    centre = lattice(r, 2**30)
    return flat(*[step(centre, 1, v) for v in same_norms(r, 4)])


def incircle_nearly(r: Random) -> Exact:
    centre = anywhere(r)
    return flat(*[step(centre, 1, v) for v in same_norms_rounded(r, 4)])


def nearer_zero(r: Random) -> Exact:
    x = lattice(r, 2**30)
    u, v = same_norms(r, 2)
    return flat(step(x, 1, u), step(x, 1, v), x)


def nearer_nearly(r: Random) -> Exact:
    x = anywhere(r)
    u, v = same_norms_rounded(r, 2)
    return flat(step(x, 1, u), step(x, 1, v), x)


def along_zero(r: Random) -> Exact:
    p, a, d = lattice(r, 2**30), lattice(r, 2**30), lattice(r, 2**20)
    return flat(p, step(p, r.integer(-1000, 1000), d), a, step(a, r.integer(-1000, 1000), left_of(d)))


def along_nearly(r: Random) -> Exact:
    p, q, a = anywhere(r), anywhere(r), anywhere(r)
    return flat(p, q, a, step(a, r.fraction(), left_of(difference(p, q))))


def crossing_order_zero(r: Random) -> Exact:
    centre, d = lattice(r, 2**30), lattice(r, 2**20)
    sites = [step(centre, 1, v) for v in same_norms(r, 3)]
    return flat(*sites, step(centre, r.integer(-1000, 1000), d), step(centre, r.integer(-1000, 1000), d))


def crossing_order_nearly(r: Random) -> Exact:
    centre, d = anywhere(r), anywhere(r)
    sites = [step(centre, 1, v) for v in same_norms_rounded(r, 3)]
    return flat(*sites, step(centre, r.fraction(), d), step(centre, r.fraction(), d))


def _turned(degrees: float, d: Point) -> Point:
    """Return d turned by the angle, to 220 bits."""
    bound = Fraction(degrees)
    (c, e), (s, t) = cosine_interval(bound, 220), cosine_interval(abs(90 - bound), 220)
    cosine, sine = (c + e) / 2, (s + t) / 2
    return cosine * d[0] - sine * d[1], cosine * d[1] + sine * d[0]


def angle_below_zero(r: Random) -> Exact:
    """45 degrees, between sides of which one is 1/sqrt 2 to sqrt 2 times the other."""
    a, d = lattice(r, 2**30), lattice(r, 2**20)
    other = r.integer(8, 16)
    return [Fraction(45), *flat(a, step(a, 16, d), step(step(a, other, d), other, left_of(d)))]


def angle_above_zero(r: Random) -> Exact:
    a, d = lattice(r, 2**30), lattice(r, 2**20)
    first, second = r.integer(1, 1000), r.integer(1, 1000)
    if r.integer(0, 1):
        return [Fraction(90), *flat(a, step(a, first, d), step(a, second, left_of(d)))]
    return [Fraction(135), *flat(a, step(a, first, d), step(step(a, -second, d), second, left_of(d)))]


def angle_below_nearly(r: Random) -> Exact:
    a, d, degrees = anywhere(r), anywhere(r), r.choice(_SMALL_ANGLES)
    return [Fraction(degrees), *flat(a, step(a, 1, d), step(a, 1 + r.fraction() / 32, _turned(degrees, d)))]


def angle_above_nearly(r: Random) -> Exact:
    a, d, degrees = anywhere(r), anywhere(r), r.choice(_LARGE_ANGLES)
    return [Fraction(degrees), *flat(a, step(a, 1, d), step(a, 1 + r.fraction() / 32, _turned(degrees, d)))]


def _area_of(a: Point, b: Point, c: Point) -> Fraction:
    (ux, uy), (vx, vy) = difference(a, b), difference(a, c)
    return abs(ux * vy - uy * vx) / 2


def area_zero(r: Random) -> Exact:
    a, b, c = lattice(r, 2**24), lattice(r, 2**24), lattice(r, 2**24)
    return [_area_of(a, b, c), *flat(a, b, c)]


def area_nearly(r: Random) -> Exact:
    a, b, c = anywhere(r), anywhere(r), anywhere(r)
    return [_area_of(a, b, c), *flat(a, b, c)]


def length_zero(r: Random) -> Exact:
    """Pythagorean triples."""
    a, m, n, k = lattice(r, 2**30), r.integer(1, 2**10), r.integer(1, 2**10), r.integer(1, 2**8)
    d = Fraction(k * (m * m - n * n)), Fraction(2 * k * m * n)
    return [Fraction(k * (m * m + n * n)), *flat(a, step(a, 1, r.choice((d, left_of(d)))))]


def length_nearly(r: Random) -> Exact:
    a, b = anywhere(r), anywhere(r)
    dx, dy = difference(a, b)
    squared = (dx * dx + dy * dy) * 4**200
    return [Fraction(isqrt(int(squared)), 2**200), *flat(a, b)]


_ZERO = {
    "orient2d": orient2d_zero,
    "diametral": diametral_zero,
    "incircle": incircle_zero,
    "nearer": nearer_zero,
    "along": along_zero,
    "crossing_order": crossing_order_zero,
    "angle_below": angle_below_zero,
    "angle_above": angle_above_zero,
    "area": area_zero,
    "length": length_zero,
}
_NEARLY = {
    "orient2d": orient2d_nearly,
    "diametral": diametral_nearly,
    "incircle": incircle_nearly,
    "nearer": nearer_nearly,
    "along": along_nearly,
    "crossing_order": crossing_order_nearly,
    "angle_below": angle_below_nearly,
    "angle_above": angle_above_nearly,
    "area": area_nearly,
    "length": length_nearly,
}


def zero(name: str, r: Random) -> Exact:
    """Return an exactly degenerate configuration in integers."""
    return _ZERO[name](r)


def nearly(name: str, r: Random) -> Exact:
    """Return an exactly, or to 200 bits, degenerate configuration in rationals that are no doubles."""
    return _NEARLY[name](r)
