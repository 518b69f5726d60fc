"""How large a violation is: visible to double arithmetic, or rounding-sized; and which of many come first.

A violation is decided by the sign of a polynomial D in differences of coordinates. With P the same sum of products,
each taken absolutely, and C the constant of the filter for doubles, it is rounding-sized iff |D| <= C P. That is a
statement about rationals: it does not depend on how D was evaluated.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction

import numpy as np
import numpy.typing as npt

from exactkernel.angle import AngleBound
from exactkernel.constants import ORIENT2D_BOUND, SHAPE_FACTOR
from exactkernel.rational import raise_if_interrupted
from exactkernel.types import FloatArray
from exactmesh.verify.properties import Severity
from exactmesh.verify.report import WITNESSES
from exactmesh.verify.witness import Ranking, exact, squared_length

__all__ = [
    "MEASURE_BOUND",
    "RESOLVED",
    "ROUNDING_SIZED",
    "UNKNOWN",
    "Grades",
    "angle_severity",
    "area_terms",
    "circle_terms",
    "diametral_terms",
    "length_severity",
    "plain_angle",
    "ranked",
    "severity_of",
]

#: What a compiled pass says of a violation.
ROUNDING_SIZED, RESOLVED, UNKNOWN = 0, 1, 2
Grades = npt.NDArray[np.int8]

#: Of the filters for angles, areas and lengths.
MEASURE_BOUND = SHAPE_FACTOR * ORIENT2D_BOUND

#: D and P.
Terms = tuple[Fraction, Fraction]


def severity_of(terms: Terms, bound: float) -> Severity:
    """Compare |D| with C P."""
    value, permanent = terms
    return Severity.ROUNDING if abs(value) <= Fraction(bound) * permanent else Severity.WRONG


def circle_terms(points: FloatArray, corners: Sequence[int], d: int) -> Terms:
    """Return the incircle determinant of three corners and d, and its permanent, in differences from d."""
    dx, dy = exact(points, d)
    rows = [(x - dx, y - dy) for x, y in (exact(points, v) for v in corners)]
    determinant = permanent = Fraction(0)
    for i in range(3):
        (x, y), (px, py), (qx, qy) = rows[i], rows[(i + 1) % 3], rows[(i + 2) % 3]
        lift = x * x + y * y
        determinant += lift * (px * qy - py * qx)
        permanent += lift * (abs(px * qy) + abs(py * qx))
    return determinant, permanent


def diametral_terms(points: FloatArray, a: int, b: int, p: int) -> Terms:
    """Return (p - a) . (b - p), positive where p sees ab under an obtuse angle, and its permanent."""
    (ax, ay), (bx, by), (px, py) = exact(points, a), exact(points, b), exact(points, p)
    left, right = (px - ax) * (bx - px), (py - ay) * (by - py)
    return left + right, abs(left) + abs(right)


def plain_angle(bound: AngleBound) -> AngleBound:
    """Return the bound with the double nearest to its sine and cosine, and no tails."""
    if bound.sine != bound.sine:  # too small for a pair
        return bound._replace(cosine=1.0, cosine_tail=0.0, sine=0.0, sine_tail=0.0)
    return bound._replace(cosine_tail=0.0, sine_tail=0.0)


def angle_severity(points: FloatArray, corners: Sequence[int], bound: AngleBound, *, least: bool) -> Severity:
    """Return WRONG where at some corner D is beyond C P on the wrong side: D = dot sin - cross cos of the bound."""
    plain, sign = plain_angle(bound), 1 if least else -1
    sine, cosine = Fraction(plain.sine), Fraction(plain.cosine)
    for i in range(3):
        (ax, ay), (bx, by), (cx, cy) = (exact(points, corners[(i + j) % 3]) for j in range(3))
        ux, uy, vx, vy = bx - ax, by - ay, cx - ax, cy - ay
        value = sine * (ux * vx + uy * vy) - cosine * (ux * vy - uy * vx)
        permanent = sine * (abs(ux * vx) + abs(uy * vy)) + abs(cosine) * (abs(ux * vy) + abs(uy * vx))
        if sign * value > Fraction(MEASURE_BOUND) * permanent:
            return Severity.WRONG
    return Severity.ROUNDING


def area_terms(points: FloatArray, corners: Sequence[int], limit: float) -> Terms:
    """Return twice the difference of the area and its limit, and the permanent."""
    (ax, ay), (bx, by), (cx, cy) = (exact(points, v) for v in corners)
    left, right, twice = (bx - ax) * (cy - ay), (by - ay) * (cx - ax), 2 * Fraction(limit)
    return left - right - twice, abs(left) + abs(right) + twice


def length_severity(points: FloatArray, corners: Sequence[int], limit: float) -> Severity:
    """Return WRONG where for some edge D, the squared length minus the squared limit, is beyond C P."""
    for i in range(3):
        squared, limit_squared = squared_length(points, corners[i - 1], corners[i]), Fraction(limit) ** 2
        if squared - limit_squared > Fraction(MEASURE_BOUND) * (squared + limit_squared):
            return Severity.WRONG
    return Severity.ROUNDING


def ranked(grades: Grades, excess: FloatArray, decide: Callable[[int], Severity]) -> Ranking:
    """Rank violations.

    Args:
        grades: (c,) what doubles know; what they do not is written.
        excess: (c,) how far beyond what is allowed each is, in any monotone measure; only for the order.
        decide: the exact severity of one violation.

    O(c log c).
    """
    for i in np.flatnonzero(grades == UNKNOWN).tolist():
        grades[i] = ROUNDING_SIZED if decide(i) is Severity.ROUNDING else RESOLVED
        raise_if_interrupted()
    order = np.lexsort((-excess, -grades))  # stable: ties by position
    return Ranking(order[:WITNESSES], int(np.count_nonzero(grades == ROUNDING_SIZED)))
