"""The families of hard cases, the same for every predicate: around its zeros, at both ends of the doubles, and where
careless implementations are wrong."""

import math
from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import TypeAlias

from proofs_tests.vectors import careless, exact, seeds
from proofs_tests.vectors.predicates import Case, Predicate, case_of
from proofs_tests.vectors.randomness import Random
from proofs_tests.vectors.seeds import Exact
from proofs_tests.vectors.ties import TIED

__all__ = ["FAMILIES", "cases"]

Values = tuple[float, ...]
_LARGEST = math.ldexp(2**53 - 1, 971)
_EXPONENTS = (-1074, -1000, -600, -485, -300, -216, -100, 0, 100, 253, 300, 509, 600, 1000)


Maker: TypeAlias = "Callable[[Predicate, Random], Values | None]"
Filter: TypeAlias = "Callable[[Predicate, Values, int], bool]"


def rounded(values: Exact) -> Values | None:
    """Return the nearest doubles, or None where there are none."""
    if any(abs(value) > _LARGEST for value in values):
        return None
    return tuple(float(value) for value in values)


def scaled(p: Predicate, values: Exact, exponent: int) -> Exact:
    """Return the configuration times 2^exponent, its bound adapted; a bound that is too large for a double is cut."""
    factor = Fraction(2) ** exponent
    points = [value * factor for value in values[p.coordinates]]
    if p.bound_degree is None:
        return points
    return [min(values[0] * factor**p.bound_degree, Fraction(_LARGEST)), *points]


def moved(r: Random, values: Values, steps: int = 1) -> Values:
    """Return the numbers with one of them some doubles further up or down, as far as there are any."""
    i, towards = r.integer(0, len(values) - 1), r.choice((-_LARGEST, _LARGEST))
    x = values[i]
    for _ in range(steps):
        x = math.nextafter(x, towards)
    return (*values[:i], x, *values[i + 1 :])


def seed(p: Predicate, r: Random) -> Exact:
    """Return a degenerate configuration of either sort."""
    return seeds.zero(p.name, r) if r.integer(0, 1) else seeds.nearly(p.name, r)


def size_of(values: Exact) -> int:
    """Return the exponent of the largest number: 2^(e - 1) <= |x| < 2^e, 0 for zeros."""
    largest = max(abs(value) for value in values)
    return max(0, int(largest).bit_length())


def at_scale(p: Predicate, r: Random, low: int, high: int) -> Values | None:
    """Return a rounded configuration whose largest coordinate is about 2^low to 2^high; perhaps one double moved."""
    values = seed(p, r)
    found = rounded(scaled(p, values, r.integer(low, high) - size_of(values[p.coordinates])))
    return moved(r, found) if found is not None and r.integer(0, 2) == 0 else found


def zeros(p: Predicate, r: Random) -> Values | None:
    """Exactly degenerate, 53 bits or fewer, scaled by a power of two."""
    return rounded(scaled(p, seeds.zero(p.name, r), r.integer(-60, 60)))


def neighbours_of_zeros(p: Predicate, r: Random) -> Values | None:
    """Exactly degenerate but for one number, which is one unit in the last place off."""
    found = zeros(p, r)
    return None if found is None else moved(r, found)


def rounded_zeros(p: Predicate, r: Random) -> Values | None:
    """Degenerate, but rounded to doubles."""
    return rounded(seeds.nearly(p.name, r))


def neighbours_of_the_rounded(p: Predicate, r: Random) -> Values | None:
    """Degenerate, rounded, and one number moved by a few units in the last place."""
    found = rounded_zeros(p, r)
    return None if found is None else moved(r, found, r.integer(0, 30))


def tails(p: Predicate, r: Random) -> Values | None:
    """Exactly degenerate with a corner in the origin, which is then moved by as little as 2^-1074."""
    values = seeds.zero(p.name, r)
    first = p.coordinates.start + 2 * r.integer(0, (len(values) - p.coordinates.start) // 2 - 1)
    x, y = values[first], values[first + 1]
    points = [value - (y if i % 2 else x) for i, value in enumerate(values[p.coordinates])]
    found = rounded([*values[: p.coordinates.start], *points])
    if found is None:
        return None
    tiny = math.ldexp(r.integer(-9, 9), -r.choice((60, 100, 106, 160, 300, 500, 900, 1074)))
    i = first + r.integer(0, 1)
    return (*found[:i], tiny, *found[i + 1 :])


def underflowing(p: Predicate, r: Random) -> Values | None:
    """Degenerate, of a size at which the products underflow."""
    middle = -1074 // p.degree
    return at_scale(p, r, middle - 10, middle + 60)


def overflowing(p: Predicate, r: Random) -> Values | None:
    """Degenerate, of a size at which the products overflow."""
    middle = 1024 // p.degree
    return at_scale(p, r, middle - 6, middle + 6)


def largest(p: Predicate, r: Random) -> Values | None:
    """Degenerate, the coordinates next to the largest doubles, so that differences overflow."""
    return at_scale(p, r, 1020, 1024)


def subnormal(p: Predicate, r: Random) -> Values | None:
    """Degenerate, all coordinates subnormal: some bits of them are left."""
    return at_scale(p, r, -1074 + 2, -1074 + 52)


def mixed(p: Predicate, r: Random) -> Values | None:
    """Degenerate, then some coordinates replaced by zeros, huge and tiny numbers."""
    found = at_scale(p, r, -500, 500)
    if found is None:
        return None
    numbers = list(found)
    for i in range(p.coordinates.start, len(numbers)):
        if r.integer(0, 3) == 0:
            numbers[i] = math.ldexp(float(r.double()), r.choice(_EXPONENTS)) if r.integer(0, 5) else 0.0
    return tuple(numbers)


def anything(p: Predicate, r: Random) -> Values | None:
    """Products half-way between two subnormals; degenerate, of a size at which products under- or overflow."""
    if p.name in TIED and r.integer(0, 3):
        return TIED[p.name](r)
    return r.choice((underflowing, underflowing, underflowing, overflowing, subnormal, mixed))(p, r)


def is_allowed(p: Predicate, values: Values) -> bool:
    """Tell whether the predicate takes it: a triangle with angles, a bound that is not negative."""
    if p.bound_degree is None:
        return True
    return values[0] >= 0.0 and (p.bound_degree > 0 or (values[0] <= 180.0 and exact.orient2d(values[1:]) != 0))


def edges(p: Predicate, r: Random) -> Values | None:
    """Degenerate, the smallest or the largest coordinate at an end of the range in which products of this degree
    neither underflow nor overflow."""
    low, high = ((-485, 509), (-216, 253))[p.degree // 2 - 1]
    found = at_scale(p, r, *r.choice(((low - 1, low + 2), (low + 50, low + 56), (high - 1, high + 2))))
    if found is None or r.integer(0, 1):
        return found
    i = r.integer(p.coordinates.start, len(found) - 1)
    value = math.ldexp(1.0, r.choice((low, high)))
    return (*found[:i], r.choice((value, math.nextafter(value, 0.0), math.nextafter(value, math.inf))), *found[i + 1 :])


def grid(p: Predicate, r: Random) -> Values | None:
    """Integers from 0 to 3: coincident, collinear and cocircular points."""
    values = tuple(float(r.integer(0, 3)) for _ in p.columns[p.coordinates])
    if p.bound_degree is None:
        return values
    return (r.choice(((45.0, 90.0, 135.0), (0.0, 1.0, 2.0), (0.5, 1.0, 1.5))[p.bound_degree]), *values)


def wide_grid(p: Predicate, r: Random) -> Values | None:
    """Multiples of a power of two, 12 bits each, far from the origin: differences are exact."""
    values = scaled(p, seeds.zero(p.name, r), 0)
    unit = 2 ** max(0, size_of(values[p.coordinates]) - 12)
    points = [Fraction(round(value / unit)) for value in values[p.coordinates]]
    return rounded(scaled(p, [*values[: p.coordinates.start], *points], r.integer(-200, 200)))


def always(_p: Predicate, _values: Values, _sign: int) -> bool:
    """Take every case."""
    return True


def naive_lies(p: Predicate, values: Values, sign: int) -> bool:
    """Take what the formula in doubles answers wrongly."""
    return careless.naive_sign(p.name, values) != sign


def filter_lies(p: Predicate, values: Values, sign: int) -> bool:
    """Take what the unguarded filter certifies wrongly."""
    return careless.filter_sign(p.name, values) not in (0, sign)


def at_the_bound(p: Predicate, values: Values, _sign: int) -> bool:
    """Take what the filter just decides, or just does not: the determinant is 1/2 to 2 times the bound."""
    det, permanent = careless.FORMULAS[p.name](values)
    bound = careless.FACTORS[p.name] * permanent
    return 0.5 * bound <= abs(det) <= 2.0 * bound


#: What the file is made of: the name of the family, how it is made, which are taken, how many.
FAMILIES = (
    ("zeros: exactly degenerate", zeros, always, 90),
    ("neighbours: exactly degenerate but for one unit in the last place", neighbours_of_zeros, always, 120),
    ("rounded: degenerate before it was rounded to doubles", rounded_zeros, always, 100),
    ("naive: rounded as above, and the formula in doubles has the wrong sign", rounded_zeros, naive_lies, 120),
    ("bound: the formula in doubles is near its error bound", neighbours_of_the_rounded, at_the_bound, 50),
    ("tails: degenerate but for a coordinate as small as 2^-1074", tails, always, 90),
    ("underflow: products underflow", underflowing, always, 70),
    ("certified: a filter without a guard certifies the wrong sign", anything, filter_lies, 50),
    ("overflow: products overflow", overflowing, always, 50),
    ("largest: differences overflow", largest, always, 40),
    ("subnormal: all coordinates are subnormal", subnormal, always, 70),
    ("mixed: huge and tiny, the formula in doubles has the wrong sign", mixed, naive_lies, 50),
    ("edges: at the ends of the range without under- and overflow", edges, always, 50),
    ("grid: small integers", grid, always, 50),
    ("wide grid: twelve bits each", wide_grid, always, 30),
)


def cases(p: Predicate, make: Maker, is_taken: Filter, n: int, start: int) -> Iterator[Case]:
    """Yield n different cases of a family."""
    r, seen = Random(start), set[Values]()
    while len(seen) < n:
        values = make(p, r)
        if values is None or values in seen or not is_allowed(p, values):
            continue
        case = case_of(p, values)
        if is_taken(p, values, case.signs[0]):
            seen.add(values)
            yield case
