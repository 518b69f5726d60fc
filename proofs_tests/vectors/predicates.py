"""The predicates of the files: what their columns are, and what their signs mean."""

from collections.abc import Callable
from dataclasses import dataclass

from proofs_tests.vectors import exact

__all__ = ["PREDICATES", "Case", "Predicate", "case_of"]

Values = tuple[float, ...]


@dataclass(frozen=True)
class Predicate:
    """A predicate of the files.

    Attributes:
        name: as the file is called.
        columns: the names of its numbers; ``bound`` first where there is one.
        degree: of the determinant in the coordinates.
        bound_degree: of the bound, or None: 2 for areas, 1 for lengths, 0 for angles.
        signs: the exact signs that stand first in a line, by the column's name.
        meaning: what a positive sign means, for the header.
    """

    name: str
    columns: tuple[str, ...]
    degree: int
    bound_degree: int | None
    signs: dict[str, Callable[[Values], int]]
    meaning: tuple[str, ...]

    @property
    def coordinates(self) -> slice:
        """Where the coordinates stand."""
        return slice(0 if self.bound_degree is None else 1, None)


@dataclass(frozen=True)
class Case:
    """One line: the signs, in the order of the predicate's, and the numbers."""

    signs: tuple[int, ...]
    values: Values


def _columns(letters: str, bound: bool = False) -> tuple[str, ...]:
    return (*(("bound",) if bound else ()), *(letter + axis for letter in letters for axis in "xy"))


_POSITIVE_INSIDE = ("+1: d inside the circle through a, b, c if these turn counterclockwise, outside if clockwise.",)
PREDICATES: tuple[Predicate, ...] = (
    Predicate(
        "orient2d", _columns("abc"), 2, None, {"sign": exact.orient2d},
        ("+1: a, b, c turn counterclockwise (y up), -1: clockwise, 0: they lie on one line.",),
    ),
    Predicate(
        "diametral", _columns("abp"), 2, None, {"sign": exact.diametral},
        ("+1: p inside the circle with diameter ab, 0: on it, -1: outside. Sign of (p - a)(b - p).",),
    ),
    Predicate(
        "incircle", _columns("abcd"), 4, None,
        {"sign": exact.incircle, "perturbed": exact.incircle_perturbed},
        (
            *_POSITIVE_INSIDE,
            "perturbed: the same with ties broken: x^2 + y^2 of the lexicographically smallest point is raised by an",
            "infinitesimal, of the next one by an infinitely smaller one, and so on. 0 where two points coincide or",
            "all lie on one line.",
        ),
    ),
    Predicate(
        "nearer", _columns("pqx"), 2, None, {"sign": exact.nearer},
        ("+1: x is nearer to q than to p, 0: as near, -1: nearer to p.",),
    ),
    Predicate(
        "along", _columns("pqab"), 2, None, {"sign": exact.along},
        ("the sign of the inner product (q - p)(b - a).",),
    ),
    Predicate(
        "crossing_order", _columns("spqab"), 4, None, {"sign": exact.crossing_order},
        (
            "the sign of N(p) D(q) - N(q) D(p), where N(x) = |x - a|^2 - |s - a|^2 and D(x) = (x - s)(b - a): the line",
            "from a to b meets the bisector of s and x at a + (b - a) N(x) / (2 D(x)). If D(p), D(q) > 0: -1 if it",
            "meets the bisector of s and p first, +1 if that of s and q, 0 if both at once.",
        ),
    ),
    Predicate(
        "angle_below", _columns("abc", True), 2, 0, {"sign": exact.angle_below},
        ("the sign of (the smallest angle of the triangle abc) - bound; the bound is in degrees.",),
    ),
    Predicate(
        "angle_above", _columns("abc", True), 2, 0, {"sign": exact.angle_above},
        ("the sign of (the largest angle of the triangle abc) - bound; the bound is in degrees.",),
    ),
    Predicate(
        "area", _columns("abc", True), 2, 2, {"sign": exact.area},
        ("the sign of (the unsigned area of the triangle abc) - bound.",),
    ),
    Predicate(
        "length", _columns("ab", True), 2, 1, {"sign": exact.length},
        ("the sign of |b - a| - bound.",),
    ),
)  # fmt: skip


def case_of(p: Predicate, values: Values) -> Case:
    """Return the numbers with their exact signs."""
    return Case(tuple(sign(values) for sign in p.signs.values()), values)
