"""The calculus of rounding errors, run over the source of the filters: what bound does each decision need?

A computed value carries e, with |exact - computed| <= e P, where P is its computed permanent: the same expression with
every term taken absolutely. P is kept as a tree, so that it can be compared with the one that the source multiplies by
its bound. The source runs on such values; where it compares a value with a bound, that is noted, and "not known" is
what it goes on with. The rules are those of constants.py; test_filter.py has them proved.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from types import SimpleNamespace
from typing import Any, TypeAlias

from proofs_tests.rounding.minifloat import Arithmetic, Backend, MiniFloat, derive

__all__ = ["Bounded", "Decision", "Recorder", "U", "decisions", "largest_needed"]

U = Fraction(1, 2**53)

Tree: TypeAlias = tuple[Any, ...]


@dataclass(frozen=True)
class Bounded:
    """An expression whose computed value errs by at most e times its computed permanent."""

    e: Fraction

    def __add__(self, other: "Bounded") -> "Bounded":
        return Bounded(max(self.e, other.e) * (1 + U) + U)

    def __mul__(self, other: "Bounded") -> "Bounded":
        return Bounded((self.e + other.e + self.e * other.e) * (1 + U) + U)


def largest_needed(last: Fraction) -> Fraction:
    """The bound C for |det| > C permanent, where no rounding is charged to the last addition, of summands that err by
    ``last``."""
    return last * (1 + U) ** 2 / (1 - U)


@dataclass(frozen=True)
class Decision:
    """A comparison with a bound: what the calculus asks for, and what the source has."""

    needed: Fraction
    shipped: Fraction
    is_permanent: bool


@dataclass
class Recorder:
    """Notes the decisions of one run."""

    found: list[Decision] = field(default_factory=list)

    def given(self, name: str) -> "Value":
        """A coordinate, or another number that is taken as it is."""
        return Value(self, Fraction(0), ("input", name))

    def bound(self, value: float) -> "Value":
        """The constant that permanents are multiplied by."""
        return Value(self, Fraction(0), ("bound", Fraction(value)))

    def pair(self, name: str) -> list["Value"]:
        """A point."""
        return [self.given(f"{name}x"), self.given(f"{name}y")]


def _sorted(name: str, one: Tree, other: Tree) -> Tree:
    return (name, *sorted((one, other), key=repr))


def is_power_of_two(x: Fraction) -> bool:
    """Whether a product with it does not round."""
    return (x.numerator & (x.numerator - 1)) == (x.denominator & (x.denominator - 1)) == 0 < x


def _factors(tree: Tree) -> tuple[Fraction, list[Tree]]:
    """The product of the bound and constants in a tree, and what else it is multiplied with."""
    if tree[0] in ("bound", "constant"):
        return tree[1], []
    if tree[0] == "*":
        (c, rest), (d, more) = _factors(tree[1]), _factors(tree[2])
        if not (rest and more):  # else it is a product of the permanent's own
            assert is_power_of_two(c) or is_power_of_two(d), "else the product of the constants rounds"
            return c * d, rest + more
    return Fraction(1), [tree]


@dataclass(frozen=True, eq=False)
class Value:
    """A number of the source.

    Attributes:
        recorder: of its run.
        e: its error, relative to the computed permanent.
        tree: the permanent.
        summands: the larger error of what it is the sum of, None if it is no sum.
        is_term: its magnitude is its permanent; that of a sum of two signs, or of a multiple of one, is smaller.
        is_magnitude: it is its own permanent.
    """

    recorder: Recorder
    e: Fraction
    tree: Tree
    summands: Fraction | None = None
    is_term: bool = True
    is_magnitude: bool = False

    def _other(self, other: "Value | float") -> "Value":
        if isinstance(other, Value):
            return other
        assert math.frexp(other)[0] in (0.5, -0.5), "only powers of two do not round"
        return Value(self.recorder, Fraction(0), ("constant", abs(Fraction(other))), is_magnitude=other > 0.0)

    def _sum(self, given: "Value | float") -> "Value":
        other = self._other(given)
        if self.tree[0] == other.tree[0] == "input":
            return Value(self.recorder, U, _sorted("-", self.tree, other.tree))
        largest = max(self.e, other.e)
        e = (Bounded(self.e) + Bounded(other.e)).e
        magnitude = self.is_magnitude and other.is_magnitude
        return Value(self.recorder, e, _sorted("+", self.tree, other.tree), largest, magnitude, magnitude)

    def _difference(self, given: "Value | float") -> "Value":
        different = self._sum(given)
        is_term = different.summands is None  # of inputs
        return Value(self.recorder, different.e, different.tree, different.summands, is_term)

    def __add__(self, other: "Value | float") -> "Value":
        assert self.tree[0] != "input", "a sum of inputs has another permanent"
        return self._sum(other)

    __radd__ = __add__

    def __sub__(self, other: "Value | float") -> "Value":
        return self._difference(other)

    def __mul__(self, given: "Value | float") -> "Value":
        other = self._other(given)
        e = (Bounded(self.e) * Bounded(other.e)).e
        if "constant" in (self.tree[0], other.tree[0]):
            e = max(self.e, other.e)
        is_term = self.is_term and other.is_term
        magnitude = is_term and (self is other or (self.is_magnitude and other.is_magnitude))
        return Value(self.recorder, e, _sorted("*", self.tree, other.tree), None, is_term, magnitude)

    __rmul__ = __mul__

    def __neg__(self) -> "Value":
        return Value(self.recorder, self.e, self.tree, self.summands, self.is_term)

    def __abs__(self) -> "Value":
        assert self.is_term, "the magnitude of a sum is not its permanent, nor is that of a multiple of it"
        return Value(self.recorder, self.e, self.tree, self.summands, is_magnitude=True)

    def __gt__(self, other: "Value") -> bool:
        """Note a comparison with a bound; 'no' is what makes the source go on."""
        if "'bound'" in repr(other.tree):
            constant, rest = _factors(other.tree)
            is_permanent = rest == [self.tree] and self.summands is not None
            needed = largest_needed(self.summands or Fraction(0))
            self.recorder.found.append(Decision(needed, constant, is_permanent))
        return False

    def __le__(self, other: object) -> bool:  # no grid
        return False

    def __ge__(self, other: object) -> bool:  # within the guard
        return True

    __lt__ = __le__

    __hash__ = object.__hash__


def _nothing(*_: object) -> int:
    return 0


def _pair(*_: object) -> tuple[int, int]:
    return 0, 0


#: What comes after a filter.
LATER: dict[str, object] = {
    **dict.fromkeys(
        ("_crossing_order_exact", "along_from_doubles", "determinant_2x2", "expansion_sign", "expansion_sum"), _nothing
    ),
    **dict.fromkeys(("nearer_from_doubles", "negate", "products_difference", "crossing_order_from_doubles"), _nothing),
    **dict.fromkeys(("dd_add", "lift_double_double", "two_diff"), _pair),
    "DD_BOUND": 0,
    "SMALLEST_WEIGHT": 0.0,
    "UNKNOWN": 2,
    "fl": lambda x: x,
}


def decisions(
    source: Sequence[Arithmetic], constants: dict[str, float], arguments: Callable[[Recorder], list[object]]
) -> list[Decision]:
    """Run the last function of the source and return what it compares with bounds.

    Args:
        source: shipped functions, those that it calls first.
        constants: those that the source multiplies permanents by, by name; others are as in LATER.
        arguments: what to call it with.
    """
    recorder = Recorder()
    bounds = {name: recorder.bound(value) for name, value in constants.items()}
    mini = MiniFloat(53, constants={**LATER, **bounds})
    function = derive(source, mini, Backend.PYTHON)[source[-1].__name__]
    function(*arguments(recorder))
    return recorder.found


def context(recorder: Recorder, orient2d_bound: float, incircle_bound: float) -> SimpleNamespace:
    """A context whose bounds are noted, and no scratch."""
    return SimpleNamespace(
        orient2d_bound=recorder.bound(orient2d_bound),
        incircle_bound=recorder.bound(incircle_bound),
        grid_limit=0.0,
        scratch=[],
        mailbox=None,
    )
