"""Delaunay triangulations, potentials and locations by brute force in fractions."""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import combinations

from proofs_tests import oracles
from proofs_tests.kernel import oracle as kernel_oracle
from proofs_tests.mesh.enumeration import Triangulation, canonical_triangles
from proofs_tests.oracles import RationalPoint, Triangle

__all__ = [
    "closed_triangles",
    "delaunay_triangles",
    "first_occurrences",
    "is_perturbed_empty",
    "potential",
    "sharpest_corner",
    "star_areas",
]


def is_perturbed_empty(points: Sequence[RationalPoint], triangle: Triangle, others: Iterable[int]) -> bool:
    """Tell whether none of the others is in the circle of the counterclockwise triangle, ties perturbed."""
    corners = [points[v] for v in triangle]
    centre, radius = oracles.circumcircle(*corners)
    for v in others:
        if v in triangle:
            continue
        excess = oracles.squared_distance(centre, points[v]) - radius
        if excess < 0 or (excess == 0 and kernel_oracle.incircle_perturbed(*corners, points[v]) > 0):
            return False
    return True


def delaunay_triangles(points: Sequence[RationalPoint]) -> Triangulation:
    """Return every triangle whose perturbed circle is empty, over all triples of distinct points."""
    everyone = range(len(points))
    found = []
    for t in combinations(everyone, 3):
        if oracles.has_area(points, t):
            ccw = oracles.counterclockwise(points, t)
            if is_perturbed_empty(points, ccw, everyone):
                found.append(ccw)
    return canonical_triangles(found)


def first_occurrences(points: Sequence[RationalPoint]) -> list[int]:
    """Return for each point the number of its position among the distinct ones, in the order of their first."""
    distinct: list[RationalPoint] = []
    for p in points:
        if p not in distinct:
            distinct.append(p)
    return [distinct.index(p) for p in points]


def potential(points: Sequence[RationalPoint], triangles: Iterable[Triangle]) -> Fraction:
    """6 Phi: twice the volume under the lifted surface, times three: the sum of orient (|a|^2 + |b|^2 + |c|^2)."""
    total = Fraction(0)
    for t in triangles:
        corners = [points[v] for v in t]
        total += oracles.orient(*corners) * sum(x * x + y * y for x, y in corners)
    return total


def star_areas(points: Sequence[RationalPoint], triangles: Sequence[Triangle]) -> list[Fraction]:
    """The slopes of 6 Phi in the lift of each point, in lexicographic order: twice the area of its star."""
    order = sorted(range(len(points)), key=lambda v: points[v])
    return [sum((oracles.orient(*(points[w] for w in t)) for t in triangles if v in t), Fraction(0)) for v in order]


def sharpest_corner(points: Sequence[RationalPoint], triangles: Iterable[Triangle]) -> Fraction:
    """Return the cotangent of the smallest angle: the larger, the sharper."""
    cotangents = []
    for t in triangles:
        for i in range(3):
            (ax, ay), (bx, by), (cx, cy) = (points[t[(i + k) % 3]] for k in range(3))
            dot = (bx - ax) * (cx - ax) + (by - ay) * (cy - ay)
            cotangents.append(dot / oracles.orient((ax, ay), (bx, by), (cx, cy)))
    return max(cotangents)


def closed_triangles(points: Sequence[RationalPoint], triangles: Iterable[Triangle], p: RationalPoint) -> set[int]:
    """Return the rows of the triangles whose closure contains p."""
    found = set()
    for row, t in enumerate(triangles):
        a, b, c = (points[v] for v in t)
        if min(oracles.orient(a, b, p), oracles.orient(b, c, p), oracles.orient(c, a, p)) >= 0:
            found.add(row)
    return found
