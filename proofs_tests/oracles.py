"""Brute force in fractions: naive, slow, obviously right, and sharing no code with what it checks."""

from collections import Counter
from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import combinations

RationalPoint = tuple[Fraction, Fraction]
Triangle = tuple[int, int, int]


def rationals(points: Iterable[Sequence[float]]) -> list[RationalPoint]:
    return [(Fraction(float(x)), Fraction(float(y))) for x, y in points]


def orient(a: RationalPoint, b: RationalPoint, c: RationalPoint) -> Fraction:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def squared_distance(a: RationalPoint, b: RationalPoint) -> Fraction:
    return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2


def circumcircle(a: RationalPoint, b: RationalPoint, c: RationalPoint) -> tuple[RationalPoint, Fraction]:
    """Return centre and squared radius, from the two equations |x - a| = |x - b| = |x - c|."""
    det = 2 * orient(a, b, c)
    (px, py), (qx, qy) = (b[0] - a[0], b[1] - a[1]), (c[0] - a[0], c[1] - a[1])
    p, q = px * px + py * py, qx * qx + qy * qy
    centre = (a[0] + (qy * p - py * q) / det, a[1] + (px * q - qx * p) / det)
    return centre, squared_distance(centre, a)


def counterclockwise(points: Sequence[RationalPoint], triangle: Triangle) -> Triangle:
    a, b, c = triangle
    return (a, c, b) if orient(points[a], points[b], points[c]) < 0 else triangle


def on_segment(p: RationalPoint, a: RationalPoint, b: RationalPoint) -> bool:
    return orient(a, b, p) == 0 and min(a, b) <= p <= max(a, b)


def clip(polygon: list[RationalPoint], a: RationalPoint, b: RationalPoint) -> list[RationalPoint]:
    """Return the part of a convex polygon on the left of the line ab, boundary included."""
    kept: list[RationalPoint] = []
    for p, q in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        side_p, side_q = orient(a, b, p), orient(a, b, q)
        if side_p >= 0:
            kept.append(p)
        if side_p * side_q < 0:
            t = side_p / (side_p - side_q)
            kept.append((p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])))
    return kept


def intersection(points: Sequence[RationalPoint], s: Triangle, t: Triangle) -> list[RationalPoint]:
    """Return points that span the intersection of two closed triangles with area."""
    polygon = [points[v] for v in counterclockwise(points, s)]
    a, b, c = (points[v] for v in counterclockwise(points, t))
    for p, q in ((a, b), (b, c), (c, a)):
        polygon = clip(polygon, p, q)
    return polygon


def meet_admissibly(points: Sequence[RationalPoint], s: Triangle, t: Triangle) -> bool:
    """Two triangles with area meet in nothing, in one common corner, or in one common edge."""
    common = [points[v] for v in set(s) & set(t)]
    meeting = intersection(points, s, t)
    if len(common) == 0:
        return not meeting
    if len(common) == 1:
        return all(p == common[0] for p in meeting)
    return len(common) == 2 and all(on_segment(p, common[0], common[1]) for p in meeting)


def has_area(points: Sequence[RationalPoint], triangle: Triangle) -> bool:
    a, b, c = triangle
    return orient(points[a], points[b], points[c]) != 0


def is_admissible(points: Sequence[RationalPoint], triangles: Sequence[Triangle]) -> bool:
    if not all(has_area(points, t) for t in triangles):
        return False
    return all(meet_admissibly(points, s, t) for s, t in combinations(triangles, 2))


def hull_area(points: Sequence[RationalPoint]) -> Fraction:
    """Return twice the area of the convex hull: summed over the pairs with all others on their left."""
    positions = sorted(set(points))
    area = Fraction(0)
    for a in positions:
        for b in positions:
            others = [p for p in positions if p not in (a, b)]
            if a != b and all(orient(a, b, p) > 0 or on_segment(p, a, b) for p in others):
                area += a[0] * b[1] - a[1] * b[0]
    return area


def covers_hull(points: Sequence[RationalPoint], triangles: Sequence[Triangle]) -> bool:
    """For admissible triangles, whose areas add up."""
    area = sum((abs(orient(*(points[v] for v in t))) for t in triangles), Fraction(0))
    return area == hull_area(points)


def is_delaunay(points: Sequence[RationalPoint], triangles: Sequence[Triangle]) -> bool:
    for a, b, c in triangles:
        if not has_area(points, (a, b, c)):
            return False
        centre, radius = circumcircle(points[a], points[b], points[c])
        if any(squared_distance(centre, p) < radius for p in points):
            return False
    return True


def largest_angle_sign(points: Sequence[RationalPoint], triangle: Triangle) -> int:
    """Return the sign of (largest angle - 90 degrees), by Pythagoras."""
    a, b, c = (points[v] for v in triangle)
    x, y, z = sorted((squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)))
    return (z > x + y) - (z < x + y)


def is_edge_manifold(triangles: Iterable[Triangle]) -> bool:
    edges = Counter(edge for a, b, c in triangles for edge in ((a, b), (b, c), (c, a)))
    return all(count == 1 for count in edges.values())


def is_one_fan(opposite: list[tuple[int, int]]) -> bool:
    """Tell whether directed edges form one simple path or cycle: one way in, one out, of one piece."""
    if any(count > 1 for end in (0, 1) for count in Counter(edge[end] for edge in opposite).values()):
        return False
    piece = set(opposite[0])
    for _ in opposite:
        piece.update(v for edge in opposite if piece & set(edge) for v in edge)
    return all(set(edge) <= piece for edge in opposite)


def is_vertex_manifold(triangles: Iterable[Triangle]) -> bool:
    opposite: dict[int, list[tuple[int, int]]] = {}
    for a, b, c in triangles:
        for v, edge in ((a, (b, c)), (b, (c, a)), (c, (a, b))):
            opposite.setdefault(v, []).append(edge)
    return all(is_one_fan(edges) for edges in opposite.values())
