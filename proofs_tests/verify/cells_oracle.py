"""Meshes of triangles and quadrilaterals from their definitions, in fractions, by brute force."""

from collections import Counter
from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import combinations, pairwise

from proofs_tests import oracles
from proofs_tests.oracles import RationalPoint

__all__ = [
    "Cell",
    "area",
    "counterclockwise",
    "covers_hull",
    "edges_of",
    "is_admissible",
    "is_convex",
    "is_edge_manifold",
    "is_simple",
    "is_vertex_manifold",
    "meet_admissibly",
]

#: The indices of three or four corners, in the order of the sides.
Cell = tuple[int, ...]


def sides(cell: Cell) -> list[tuple[int, int]]:
    return list(pairwise((*cell, cell[0])))


def edges_of(cell: Cell) -> list[frozenset[int]]:
    return [frozenset(side) for side in sides(cell)]


def area(points: Sequence[RationalPoint], cell: Cell) -> Fraction:
    """Return twice the signed area, by the shoelace."""
    turns = (points[a][0] * points[b][1] - points[a][1] * points[b][0] for a, b in sides(cell))
    return sum(turns, Fraction(0))


def _meet(p: RationalPoint, q: RationalPoint, r: RationalPoint, s: RationalPoint) -> bool:
    """Tell whether two closed segments have a point in common."""
    if any((oracles.on_segment(p, r, s), oracles.on_segment(q, r, s), oracles.on_segment(r, p, q))):
        return True
    straddles = oracles.orient(p, q, r) * oracles.orient(p, q, s) < 0
    return straddles and oracles.orient(r, s, p) * oracles.orient(r, s, q) < 0


def is_simple(points: Sequence[RationalPoint], cell: Cell) -> bool:
    """The sides meet in the corners that neighbours share, and nowhere else."""
    corners = [points[v] for v in cell]
    if len(set(corners)) < len(corners) or area(points, cell) == 0:
        return False
    lines = list(pairwise((*corners, corners[0])))
    for i, j in combinations(range(len(lines)), 2):
        (a, b), (c, d) = lines[i], lines[j]
        common = {a, b} & {c, d}
        if not common and _meet(a, b, c, d):
            return False
        if common and any(oracles.on_segment(p, c, d) for p in {a, b} - common):
            return False
        if common and any(oracles.on_segment(p, a, b) for p in {c, d} - common):
            return False
    return True


def is_convex(points: Sequence[RationalPoint], cell: Cell) -> bool:
    """A triangle with an area, or a quadrilateral whose diagonals cross inside both of them."""
    if len(cell) == 3:
        return area(points, cell) != 0
    a, b, c, d = (points[v] for v in cell)
    return (
        oracles.orient(a, c, b) * oracles.orient(a, c, d) < 0 and oracles.orient(b, d, a) * oracles.orient(b, d, c) < 0
    )


def counterclockwise(points: Sequence[RationalPoint], cell: Cell) -> Cell:
    """Return a simple clockwise cell reversed, another as it is."""
    reverse = is_simple(points, cell) and area(points, cell) < 0
    return (cell[0], *cell[:0:-1]) if reverse else cell


def meet_admissibly(points: Sequence[RationalPoint], s: Cell, t: Cell) -> bool:
    """Two convex cells meet in nothing, in one corner of both, or in one edge of both."""
    polygon = [points[v] for v in counterclockwise(points, s)]
    corners = [points[v] for v in counterclockwise(points, t)]
    for p, q in pairwise([*corners, corners[0]]):
        polygon = oracles.clip(polygon, p, q)
    if not polygon:
        return not set(s) & set(t)
    for v in set(s) & set(t):
        if all(p == points[v] for p in polygon):
            return True
    for a, b in set(edges_of(s)) & set(edges_of(t)):
        if all(oracles.on_segment(p, points[a], points[b]) for p in polygon):
            return True
    return False


def is_admissible(points: Sequence[RationalPoint], cells: Sequence[Cell]) -> bool:
    if not all(is_convex(points, cell) for cell in cells):
        return False
    return all(meet_admissibly(points, s, t) for s, t in combinations(cells, 2))


def covers_hull(points: Sequence[RationalPoint], cells: Sequence[Cell]) -> bool:
    """For admissible cells, whose areas add up."""
    return sum((abs(area(points, cell)) for cell in cells), Fraction(0)) == oracles.hull_area(points)


def is_edge_manifold(cells: Iterable[Cell]) -> bool:
    return all(count == 1 for count in Counter(side for cell in cells for side in sides(cell)).values())


def is_vertex_manifold(cells: Iterable[Cell]) -> bool:
    opposite: dict[int, list[tuple[int, int]]] = {}
    for cell in cells:
        for i, v in enumerate(cell):
            opposite.setdefault(v, []).append((cell[(i + 1) % len(cell)], cell[i - 1]))
    return all(oracles.is_one_fan(steps) for steps in opposite.values())
