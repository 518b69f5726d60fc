"""Every flip of every algorithm, watched: run interpreted, where ``swap`` can be replaced in each module that calls it.

``python -m proofs_tests.mesh.flips`` (with NUMBA_DISABLE_JIT=1) prints a line for each algorithm and caller.
"""

import sys
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import islice
from typing import Any

import numpy as np
from proofs_tests import oracles
from proofs_tests.kernel import oracle as kernel_oracle
from proofs_tests.mesh import oracle as mesh_oracle
from proofs_tests.mesh.enumeration import COUNTS, grid, triangulations
from proofs_tests.oracles import RationalPoint

from exactkernel.types import FloatArray
from exactmesh import PSLG, TriangulationBuilder, constrained_delaunay, delaunay, lawson, refine
from exactmesh.edgealgebra import EdgeArray, dest, left_next, origin, swap

__all__ = ["ALGORITHMS", "CALLERS", "Ledger", "described", "watched"]

#: The functions that flip, by the modules that they are in, and whether each of their flips must descend: those that
#: take a vertex out flip away from it first, undo what they tried, or have triangles turned over in between.
CALLERS = {
    "exactmesh.delaunay": {"legalize": True, "insert_range": False},
    "exactmesh.lawson": {"flip_until_delaunay": True},
    "exactmesh.cavity": {"legalize_fan": False},
    "exactmesh.editing.insertion": {"legalize_link": True, "halve": False},
    "exactmesh.editing.deletion": {"cut_ears": False},
    "exactmesh.refinement.insertion": {"legalize": True, "undo_flips": False},
    "exactmesh.refinement.removal": {"flip_to_three": False, "restore": True},
}


@dataclass
class Ledger:
    """What the flips of one algorithm came to.

    Attributes:
        flips: how many, by "module.function"; those with the ghost vertex apart.
        wrong: how many broke the law, by its name.
        drop: the sum of the determinants: by how much 6 Phi fell in all.
    """

    flips: Counter[str] = field(default_factory=Counter)
    wrong: Counter[str] = field(default_factory=Counter)
    drop: Fraction = Fraction(0)

    def note(
        self, caller: str, must_descend: bool, before: Fraction, after: Fraction, quad: list[RationalPoint]
    ) -> None:
        """Check one flip of the diagonal ac of a, b, c, d to bd, of which 6 Phi is known before and after."""
        a, b, c, d = quad
        fall = before - after
        self.flips[caller] += 1
        self.drop += fall
        self.wrong["potential"] += fall != lifted(a, b, c, d)
        if must_descend:
            sign = (fall > 0) - (fall < 0) or kernel_oracle.incircle_perturbed(a, b, c, d)
            self.wrong["descent"] += sign <= 0


def lifted(a: RationalPoint, b: RationalPoint, c: RationalPoint, d: RationalPoint) -> Fraction:
    """The incircle determinant, by the volumes under the lifted points, so that flat triangles do no harm."""
    rows = [(x - d[0], y - d[1], (x - d[0]) ** 2 + (y - d[1]) ** 2) for x, y in (a, b, c)]
    (p, q, r), (s, t, u), (v, w, z) = rows
    return p * (t * z - u * w) - q * (s * z - u * v) + r * (s * w - t * v)


def coordinates_of(names: Mapping[str, Any]) -> tuple[FloatArray, int]:
    """Return the coordinates, flat, and the ghost vertex or -1, from the variables of the function that flips."""
    if "s" in names:  # a sheet of refinement, which has no ghost
        return names["s"].xy, -1
    plane = names["draft"].plane if "draft" in names else names.get("plane")
    if plane is not None:
        return plane.xy, plane.ghost
    return names["xy"].reshape(-1), names.get("ghost", -1)


def replacement(ledger: Ledger, module: str, rules: dict[str, bool]) -> Callable[[EdgeArray, EdgeArray, int], None]:
    """Return a swap that looks at the two triangles before and after."""

    def watched_swap(ring: EdgeArray, org: EdgeArray, e: int) -> None:
        frame = sys._getframe(1)
        function = frame.f_code.co_name
        caller = f"{module.removeprefix('exactmesh.')}.{function}"
        xy, ghost = coordinates_of(frame.f_locals)
        quad = [origin(org, e), dest(org, left_next(ring, e ^ 2)), dest(org, e), dest(org, left_next(ring, e))]
        if ghost in quad:
            ledger.flips[f"{caller} at the ghost"] += 1
            swap(ring, org, e)
            return
        exact = {v: (Fraction(float(xy[2 * v])), Fraction(float(xy[2 * v + 1]))) for v in map(int, quad)}
        before = potential(ring, org, e, exact)
        swap(ring, org, e)
        ledger.note(caller, rules[function], before, potential(ring, org, e, exact), [exact[int(v)] for v in quad])

    return watched_swap


def potential(ring: EdgeArray, org: EdgeArray, e: int, exact: dict[int, RationalPoint]) -> Fraction:
    """6 Phi of the two triangles at an edge, as the ring has them."""
    total = Fraction(0)
    for side in (e, e ^ 2):
        corners = [
            exact[int(origin(org, q))] for q in (side, left_next(ring, side), left_next(ring, left_next(ring, side)))
        ]
        total += mesh_oracle.potential(corners, [(0, 1, 2)])
    return total


@contextmanager
def watched() -> Iterator[Ledger]:
    """Watch every flip while the block runs."""
    ledger = Ledger()
    for module, rules in CALLERS.items():
        vars(sys.modules[module])["swap"] = replacement(ledger, module, rules)
    try:
        yield ledger
    finally:
        for module in CALLERS:
            vars(sys.modules[module])["swap"] = swap


def points(n: int, seed: int) -> FloatArray:
    """Random points, a third of them on a coarse grid: ties and points on edges."""
    random = np.random.default_rng(seed)
    given = random.random((n, 2))
    given[::3] = random.integers(0, 6, (len(given[::3]), 2)) / 5.0
    return np.unique(given, axis=0)


def insertion() -> Fraction | None:
    for seed in range(4):
        delaunay(points(60, seed))
    delaunay(grid(6, 6))
    return None


def lawson_from_everywhere() -> Fraction | None:
    """All of the potential goes by flips."""
    total = Fraction(0)
    for name in ("3 x 3 grid", "cocircular octagon", "3 x 4 grid"):
        given = COUNTS[name][0]
        exact = oracles.rationals(given)
        for start in islice(triangulations(given), 0, None, 40):
            mesh = lawson(given, start)
            total += mesh_oracle.potential(exact, start)
            total -= mesh_oracle.potential(exact, [(a, b, c) for a, b, c in mesh.triangles.tolist()])
    return total


def constrained() -> Fraction | None:
    for seed in range(4):
        given = points(50, seed)
        fan = [(0, i) for i in range(1, len(given), 3)]
        constrained_delaunay(PSLG(given, fan), carve=False, crossings="split")
    return None


def builder() -> Fraction | None:
    for seed in range(3):
        given = points(40, seed)
        edited = TriangulationBuilder(given[:20])
        vertices = [*range(20), *edited.insert_points(given[20:]).tolist()]
        edited.insert_segment(0, vertices[-1])
        (ax, ay), (bx, by) = given[0].tolist(), edited.triangulation().points[-1].tolist()
        for x, y in ((0.5, 0.5), (0.1, 0.7), (1.0, 0.4), ((ax + bx) / 2, (ay + by) / 2), (0.2, 0.2), (0.3, 0.2)):
            edited.insert_point(x, y)
        on_segments = set(edited.triangulation().segments.ravel().tolist())
        for v in vertices[5:35:2]:
            if v not in on_segments:
                edited.delete_vertex(v)
    return None


def refinement() -> Fraction | None:
    ring = PSLG.from_rings([[(0, 0), (8, 0), (8, 1), (7, 1.25), (0, 6)], [(1, 1), (3, 1), (3, 2), (1, 2)]])
    refine(ring, min_angle=28.0)
    refine(ring, min_angle=20.0, max_area=0.25)
    return None


ALGORITHMS: dict[str, Callable[[], Fraction | None]] = {
    "insertion": insertion,
    "Lawson": lawson_from_everywhere,
    "constrained": constrained,
    "builder": builder,
    "refinement": refinement,
}


def described(name: str) -> str:
    """Run an algorithm; return its flips, what was wrong, and whether they explain what 6 Phi lost."""
    with watched() as ledger:
        lost = ALGORITHMS[name]()
    flips = ", ".join(f"{caller} {n}" for caller, n in sorted(ledger.flips.items()))
    whole = "" if lost is None else f"; of the fall of 6 Phi {'all' if lost == ledger.drop else 'not all'}"
    wrong = ", ".join(f"{law} {n}" for law, n in sorted(ledger.wrong.items()) if n) or "nothing"
    return f"{name}: {flips}{whole}; wrong: {wrong}"


if __name__ == "__main__":
    for algorithm in ALGORITHMS:
        print(described(algorithm))
