"""K8: the laws of orientation and incircle on which every algorithm rests, proved over the reals, then on grids.

Polynomial identities are proved by sympy; what follows from them by order, by z3, which decides such statements over
the reals. The proofs are about the polynomials of ``determinants``; that the shipped predicates are their signs is what
K3 and K7 say, and what the exhaustive half of this file repeats.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import permutations
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import pytest
import sympy
import z3
from proofs_tests.kernel.oracle import parity

from exactkernel import Stage, incircle_batch, incircle_staged, orient2d_batch, orient2d_staged

Number: TypeAlias = Any  # sympy's and z3's expressions have no common type
Vector: TypeAlias = tuple[Number, Number]
Signs: TypeAlias = npt.NDArray[np.int8]


def orient(a: Vector, b: Vector, c: Vector) -> Number:
    """Twice the signed area of the triangle."""
    return (a[0] - c[0]) * (b[1] - c[1]) - (a[1] - c[1]) * (b[0] - c[0])


def squared(a: Vector, b: Vector) -> Number:
    """The squared distance."""
    return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])


def circle(a: Vector, b: Vector, c: Vector, d: Vector) -> Number:
    """The incircle determinant in differences from d, as the code has it."""
    return squared(a, d) * orient(b, c, d) + squared(b, d) * orient(c, a, d) + squared(c, d) * orient(a, b, d)


def symbols(names: str) -> list[Vector]:
    return [(sympy.Symbol(f"{n}x"), sympy.Symbol(f"{n}y")) for n in names]


def unknowns(names: str) -> list[Vector]:
    return [(z3.Real(f"{n}x"), z3.Real(f"{n}y")) for n in names]


def is_zero(polynomial: Number) -> bool:
    """Expanded, nothing is left."""
    return bool(sympy.expand(polynomial) == 0)


def counterexample(hypotheses: Sequence[Number], conclusion: Number) -> dict[str, Fraction] | None:
    """Reals that satisfy the hypotheses and not the conclusion; None if there are none, which is a proof."""
    solver = z3.Tactic("qfnra-nlsat").solver()
    solver.add(*hypotheses, z3.Not(conclusion))
    found = solver.check()
    assert found != z3.unknown
    if found == z3.unsat:
        return None
    model = solver.model()
    return {str(v): Fraction(model[v].as_fraction()) for v in model.decls()}


def valued(found: dict[str, Fraction], names: str) -> list[tuple[Fraction, Fraction]]:
    """The points of a counterexample."""
    return [(found.get(f"{n}x", Fraction(0)), found.get(f"{n}y", Fraction(0))) for n in names]


@pytest.mark.obligation("K8", "orient2d obeys Knuth's CC axioms, over the reals", method="symbolic")
class TestAxiomsOverTheReals:
    """Knuth's axioms of counterclockwise systems: cyclic symmetry, antisymmetry, nondegeneracy (only of points on one
    line is neither order counterclockwise), interiority, transitivity; and orientation does not depend on the place."""

    def test_symmetries(self) -> None:
        p, q, r, v = symbols("pqrv")
        assert is_zero(orient(p, q, r) - orient(q, r, p))
        assert is_zero(orient(p, q, r) + orient(p, r, q))
        assert is_zero(orient(p, q, r) - orient(*((x + v[0], y + v[1]) for x, y in (p, q, r))))

    def test_nondegeneracy(self) -> None:
        """Neither pqr nor prq: then every point r is q + k (p - q), with k |p - q|^2 = (r - q) (p - q), or p = q."""
        (p, q, r), k = symbols("pqr"), sympy.Symbol("k")
        on_line = (q[0] + k * (p[0] - q[0]), q[1] + k * (p[1] - q[1]))
        assert is_zero(orient(p, q, on_line))
        (dx, dy), (x, y) = ((v[0] - q[0], v[1] - q[1]) for v in (p, r))
        along = x * dx + y * dy
        assert is_zero(x * squared(p, q) - along * dx - orient(p, q, r) * dy)
        assert is_zero(y * squared(p, q) - along * dy + orient(p, q, r) * dx)

    def test_interiority(self) -> None:
        """tqr, ptr and pqt are the parts into which t divides pqr: their sum is pqr."""
        p, q, r, t = symbols("pqrt")
        assert is_zero(orient(p, q, r) - orient(t, q, r) - orient(p, t, r) - orient(p, q, t))
        p, q, r, t = unknowns("pqrt")
        assert (
            counterexample([orient(t, q, r) > 0, orient(p, t, r) > 0, orient(p, q, t) > 0], orient(p, q, r) > 0) is None
        )

    def test_transitivity(self) -> None:
        """tsp, tsq, tsr, tpq, tqr: tpr. By the three-term Pluecker relation; z3 with t at the origin."""
        p, q, r, s, t = symbols("pqrst")
        assert is_zero(
            orient(t, s, q) * orient(t, p, r) - orient(t, s, p) * orient(t, q, r) - orient(t, s, r) * orient(t, p, q)
        )
        (p, q, r, s), t = unknowns("pqrs"), (z3.RealVal(0), z3.RealVal(0))
        given = [
            orient(t, s, p) > 0,
            orient(t, s, q) > 0,
            orient(t, s, r) > 0,
            orient(t, p, q) > 0,
            orient(t, q, r) > 0,
        ]
        assert counterexample(given, orient(t, p, r) > 0) is None

    def test_control_wrong_identities(self) -> None:
        """Signs changed in each identity."""
        p, q, r, s, t = symbols("pqrst")
        assert not is_zero(orient(p, q, r) - orient(q, p, r))
        assert not is_zero(orient(p, q, r) - orient(t, q, r) - orient(p, t, r) + orient(p, q, t))
        assert not is_zero(
            orient(t, s, q) * orient(t, p, r) + orient(t, s, p) * orient(t, q, r) - orient(t, s, r) * orient(t, p, q)
        )

    def test_control_a_hypothesis_less(self) -> None:
        """Interiority and transitivity without one of their hypotheses: refuted, by points that are checked."""
        p, q, r, t = unknowns("pqrt")
        found = counterexample([orient(t, q, r) > 0, orient(p, t, r) > 0], orient(p, q, r) > 0)
        assert found is not None
        a, b, c, d = valued(found, "pqrt")
        assert orient(d, b, c) > 0
        assert orient(a, d, c) > 0
        assert orient(a, b, c) <= 0
        (p, q, r, s), t = unknowns("pqrs"), (z3.RealVal(0), z3.RealVal(0))
        given = [orient(t, s, p) > 0, orient(t, s, q) > 0, orient(t, p, q) > 0, orient(t, q, r) > 0]
        found = counterexample(given, orient(t, p, r) > 0)
        assert found is not None
        a, b, c, d, o = *valued(found, "pqrs"), (Fraction(0), Fraction(0))
        assert min(orient(o, d, a), orient(o, d, b), orient(o, a, b), orient(o, b, c)) > 0
        assert orient(o, a, c) <= 0


@pytest.mark.obligation(
    "K8", "incircle is the orientation of lifts, antisymmetric, and what a flip gains", method="symbolic"
)
class TestIncircleOverTheReals:
    """incircle(a, b, c, d) is the determinant of rows (x, y, x^2 + y^2, 1), so it changes its sign with the parity of
    the order; with 6 Phi the sum of orient(t) (|a|^2 + |b|^2 + |c|^2) over triangles, a flip of ac to bd lowers 6 Phi
    by exactly incircle(a, b, c, d); and if that is positive, the quadrilateral is strictly convex, the flip legal."""

    def test_lifting(self) -> None:
        points = symbols("abcd")
        lifted = sympy.Matrix([[x, y, x * x + y * y, 1] for x, y in points]).det()
        assert is_zero(circle(*points) - lifted)

    def test_antisymmetry(self, record_property: Callable[[str, object], None]) -> None:
        points = symbols("abcd")
        orders = list(permutations(range(4)))
        for order in orders:
            assert is_zero(circle(*(points[i] for i in order)) - parity(order) * circle(*points))
        record_property("cases", len(orders))

    def test_potential(self) -> None:
        a, b, c, d = symbols("abcd")
        origin = (sympy.Integer(0), sympy.Integer(0))

        def phi(*triangle: Vector) -> Number:
            return orient(*triangle) * sum(squared(p, origin) for p in triangle)

        assert is_zero(phi(a, b, c) + phi(a, c, d) - phi(a, b, d) - phi(b, c, d) - circle(a, b, c, d))

    def test_flippability(self) -> None:
        """With the differences taken from a or c, incircle is a sum of which only one term can be positive."""
        a, b, c, d = symbols("abcd")
        abc, acd, abd, bcd = orient(a, b, c), orient(a, c, d), orient(a, b, d), orient(b, c, d)
        assert is_zero(circle(a, b, c, d) - (abd * squared(a, c) - acd * squared(a, b) - abc * squared(a, d)))
        assert is_zero(circle(a, b, c, d) - (bcd * squared(a, c) - acd * squared(b, c) - abc * squared(c, d)))
        big, near, left, right = z3.Reals("circle near left right")
        one, two, three = z3.Reals("one two three")  # squared distances
        given = [
            left > 0,
            right > 0,
            one >= 0,
            two >= 0,
            three >= 0,
            big > 0,
            big == near * one - left * two - right * three,
        ]
        assert counterexample(given, near > 0) is None

    def test_control_wrong_identities(self) -> None:
        """The lift of another paraboloid, the wrong parity, the potential the other way round."""
        a, b, c, d = points = symbols("abcd")
        other = sympy.Matrix([[x, y, x * x + 2 * y * y, 1] for x, y in points]).det()
        assert not is_zero(circle(*points) - other)
        assert not is_zero(circle(b, a, c, d) - circle(*points))
        assert not is_zero(circle(a, b, c, d) - (orient(a, b, d) * squared(a, c) - orient(a, c, d) * squared(a, b)))

    def test_control_an_edge_that_is_delaunay_need_not_be_flippable(self) -> None:
        """Flippability without the hypothesis that d is inside the circle: refuted, by points that are checked."""
        (a, b, c), d = unknowns("abc"), (z3.RealVal(0), z3.RealVal(0))
        found = counterexample([orient(a, b, c) > 0, orient(a, c, d) > 0], orient(b, c, d) > 0)
        assert found is not None
        a, b, c, d = *valued(found, "abc"), (Fraction(0), Fraction(0))
        assert orient(a, b, c) > 0
        assert orient(a, c, d) > 0
        assert orient(b, c, d) <= 0
        assert circle(a, b, c, d) <= 0


def grid(n: int, step: float, origin: float) -> npt.NDArray[np.float64]:
    """The n x n points origin + k step, rounded: not quite on lines and circles where the step is no short double."""
    values = origin + step * np.arange(n)
    return np.array([(x, y) for x in values for y in values])


#: Points of the diagonal, and all within an ulp of it: where rounded determinants are wrong about most.
NEAR_A_LINE = np.concatenate([grid(3, 2.0**-53, 0.5), [(12.0, 12.0), (24.0, 24.0), (17.3, 17.3)]])

GRIDS = {
    "integers": grid(4, 1.0, 0.0),
    "tenths": grid(4, 0.1, 0.1),
    "thirds, far away": grid(3, 1.0 / 3.0, 1e6),
    "near a line": NEAR_A_LINE,
    "subnormal": grid(3, 5e-324, 0.0),
    "huge": grid(3, 5e307, 0.0),
}


def all_tuples(points: npt.NDArray[np.float64], k: int) -> list[npt.NDArray[np.float64]]:
    indices = np.indices((len(points),) * k).reshape(k, -1)
    return [points[i] for i in indices]


def orientations(points: npt.NDArray[np.float64]) -> Signs:
    """The shipped sign of every triple, (n, n, n)."""
    return np.asarray(orient2d_batch(*all_tuples(points, 3))).reshape((len(points),) * 3)


def circles(points: npt.NDArray[np.float64]) -> Signs:
    """The shipped sign of every quadruple."""
    return np.asarray(incircle_batch(*all_tuples(points, 4))).reshape((len(points),) * 4)


def violations(o: Signs) -> dict[str, int]:
    """How many tuples contradict each axiom; of strict signs, so that degenerate points count as well."""
    positive = o > 0
    t, s, p, q, r = np.ogrid[tuple(slice(n) for n in (len(o),) * 5)]
    interior = positive[t, q, r] & positive[p, t, r] & positive[p, q, t]
    ahead = positive[t, s, p] & positive[t, s, q] & positive[t, s, r] & positive[t, p, q] & positive[t, q, r]
    return {
        "cyclic symmetry": int(np.count_nonzero(o != o.transpose(1, 2, 0))),
        "antisymmetry": int(np.count_nonzero(o != -o.transpose(0, 2, 1))),
        "interiority": int(np.count_nonzero(interior & ~positive[p, q, r])),
        "transitivity": int(np.count_nonzero(ahead & ~positive[t, p, r])),
    }


def broken(c: Signs, o: Signs) -> dict[str, int]:
    """How many quadruples contradict the antisymmetry of incircle, or the legality of a flip."""
    a, b, d, e = np.ogrid[tuple(slice(n) for n in (len(o),) * 4)]  # a b d e: counterclockwise a, b, c = d, d = e
    flip = (o[a, b, d] > 0) & (o[a, d, e] > 0) & (c > 0)
    return {
        "antisymmetry": sum(
            int(np.count_nonzero(c.transpose(order) != parity(order) * c)) for order in permutations(range(4))
        ),
        "flippability": int(np.count_nonzero(flip & ~((o[a, b, e] > 0) & (o[b, d, e] > 0)))),
    }


@pytest.mark.obligation(
    "K8", "the shipped predicates obey the axioms, on every tuple of small grids", method="enumeration"
)
class TestAxiomsOnGrids:
    """Every triple, quadruple and quintuple of small grids, degenerate ones included, whatever stage decides: the
    axioms of orientation, the antisymmetry of incircle, and a non-Delaunay edge is flippable."""

    @pytest.mark.parametrize("name", GRIDS)
    def test_orientation(self, name: str, record_property: Callable[[str, object], None]) -> None:
        points = GRIDS[name]
        record_property("cases", len(points) ** 5)
        assert not any(violations(orientations(points)).values())

    @pytest.mark.parametrize("name", GRIDS)
    def test_incircle(self, name: str, record_property: Callable[[str, object], None]) -> None:
        points = GRIDS[name]
        record_property("cases", len(points) ** 4)
        assert not any(broken(circles(points), orientations(points)).values())

    def test_every_stage_is_reached(self) -> None:
        """The grid stage too, which single calls of orient2d do not know of."""
        triples = [stage for p in GRIDS.values() for _, stage in map(orient2d_staged, *all_tuples(p, 3))]
        fours = [
            stage for p in GRIDS.values() for _, stage in map(incircle_staged, *(v[::7] for v in all_tuples(p, 4)))
        ]
        assert set(triples) == set(Stage) - {Stage.GRID}
        assert set(fours) == set(Stage)

    def test_signs_of_the_determinants(self) -> None:
        """On integers, the shipped signs are those of the polynomials that the proofs are about, in integers."""
        points = GRIDS["integers"]
        triples = [tuple(v.astype(np.int64).T) for v in all_tuples(points, 3)]
        assert np.array_equal(np.sign(orient(*triples)), orientations(points).ravel())
        fours = [tuple(v.astype(np.int64).T) for v in all_tuples(points, 4)]
        assert np.array_equal(np.sign(circle(*fours)), circles(points).ravel())

    def test_control_rounded_determinants_break_them(self) -> None:
        """The determinants in doubles, near a line and on tenths: no symmetry is left."""
        points = NEAR_A_LINE
        rounded = np.sign(orient(*(tuple(v.T) for v in all_tuples(points, 3)))).astype(np.int8)
        found = violations(rounded.reshape((len(points),) * 3))
        assert found["cyclic symmetry"] > 0
        assert found["antisymmetry"] > 0
        points = GRIDS["tenths"]
        in_doubles = np.sign(circle(*(tuple(v.T) for v in all_tuples(points, 4)))).astype(np.int8)
        assert broken(in_doubles.reshape((len(points),) * 4), orientations(points))["antisymmetry"] > 0

    @pytest.mark.parametrize("axiom", ["cyclic symmetry", "antisymmetry", "interiority", "transitivity"])
    def test_control_one_wrong_sign_is_found(self, axiom: str) -> None:
        """One sign of all triples turned round, or a whole symmetric class of it."""
        o = orientations(GRIDS["integers"]).copy()
        p, q, r = 0, 9, 6  # around the point 5
        assert o[p, q, r] != 0
        wrong = -o[p, q, r]
        if axiom in ("cyclic symmetry", "antisymmetry"):
            o[p, q, r] = wrong
        else:
            for i, j, k in ((p, q, r), (q, r, p), (r, p, q)):
                o[i, j, k], o[i, k, j] = wrong, -wrong
        assert violations(o)[axiom] > 0

    def test_control_a_wrong_circle_is_found(self) -> None:
        """Every circle says 'inside': flips of quadrilaterals that are not convex become legal."""
        o = orientations(GRIDS["integers"])
        assert broken(np.ones((len(o),) * 4, dtype=np.int8), o)["flippability"] > 0
