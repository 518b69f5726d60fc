"""Meshers with one fault each. What each breaks stands in :data:`PLANTED`."""

import ctypes
import itertools
import os
import sys
from typing import Any

import numpy as np
import numpy.typing as npt
from proofs_tests.conformance.naive_mesher import (
    Point,
    Triangle,
    distinct,
    flipped,
    in_circle,
    mesh,
    on_integers,
    sweep,
)

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]


def right(points: Floats) -> list[Triangle]:
    return mesh(points.tolist())


def noisy(points: Floats) -> list[Triangle]:
    """Right, and prints."""
    print("x" * 100_000)
    os.write(1, b"\x80\x04junk")
    sys.stderr.write("warning\n" * 1000)
    return right(points)


def drops_a_point(points: Floats) -> list[Triangle]:
    return right(points[:-1] if len(points) > 8 else points)


def drops_an_inner_point(points: Floats) -> list[Triangle]:
    triangles = right(points)
    corners = {v for triangle in triangles for v in triangle}
    edges = {(t[i], t[i - 2]) for t in triangles for i in range(3)}
    inner = corners - {a for a, b in edges if (b, a) not in edges} - {b for a, b in edges if (b, a) not in edges}
    return right(np.where(np.arange(len(points))[:, None] == min(inner), points[0], points)) if inner else triangles


def drops_a_hull_triangle(points: Floats) -> list[Triangle]:
    return right(points)[1:]


def skips_a_flip(points: Floats) -> list[Triangle]:
    """One edge of the sweep's triangles stays, Delaunay or not."""
    places = on_integers(points.tolist())
    kept: list[frozenset[Point]] = []

    def forgetful(a: Point, b: Point, c: Point, d: Point) -> int:
        found = in_circle(a, b, c, d)
        if found > 0 and not kept:
            kept.append(frozenset((a, b)))
        return 0 if kept == [frozenset((a, b))] else found

    return flipped(places, sweep(places, distinct(points.tolist())), forgetful)


def float_predicates(points: Floats) -> list[Triangle]:
    places: Any = [tuple(point) for point in points.tolist()]
    triangles = sweep(places, distinct(points.tolist()), _float_orient)
    return flipped(places, triangles, _float_in_circle, most=1000)


def flips_what_doubles_resolve(points: Floats) -> list[Triangle]:
    """An error bound where there should be exact arithmetic: a tolerance."""

    def permanent(a: Point, b: Point, c: Point, d: Point) -> int:
        rows = [(abs(p[0] - d[0]), abs(p[1] - d[1])) for p in (a, b, c)]
        turned = zip(rows, rows[1:] + rows[:1], rows[2:] + rows[:2], strict=True)
        return sum((x * x + y * y) * (px * qy + py * qx) for (x, y), (px, py), (qx, qy) in turned)

    def filtered(a: Point, b: Point, c: Point, d: Point) -> int:
        determinant = in_circle(a, b, c, d)
        turns = ((a, b, c, d), (b, c, d, a), (c, d, a, b), (d, a, b, c))  # whichever the origin is moved to
        return determinant if determinant << 51 > min(permanent(*turn) for turn in turns) else 0

    return mesh(points.tolist(), inside=filtered)


def _float_orient(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _float_in_circle(a: Point, b: Point, c: Point, d: Point) -> float:
    rows = [(p[0] - d[0], p[1] - d[1]) for p in (a, b, c)]
    (ax, ay), (bx, by), (cx, cy) = rows
    la, lb, lc = (x * x + y * y for x, y in rows)
    return la * (bx * cy - by * cx) - lb * (ax * cy - ay * cx) + lc * (ax * by - ay * bx)


def counts_from_one(points: Floats) -> Integers:
    return np.array(right(points), dtype=np.int64).reshape(-1, 3) + 1


def counts_from_minus_one(points: Floats) -> Integers:
    """Python would take -1 for the last point."""
    return np.array(right(points), dtype=np.int64).reshape(-1, 3) - 1


def repeats_a_triangle(points: Floats) -> list[Triangle]:
    triangles = right(points)
    return triangles + triangles[:1]


def covers_twice(points: Floats) -> list[Triangle]:
    return 2 * right(points)


def swaps_orientation(points: Floats) -> list[Triangle]:
    return [(a, c, b) if i == 6 else (a, b, c) for i, (a, b, c) in enumerate(right(points))]


def exits(points: Floats) -> list[Triangle]:
    if len(points) > 12:
        os._exit(3)
    return right(points)


def leaves(points: Floats) -> list[Triangle]:
    if len(points) > 12:
        sys.exit("that is too much")
    return right(points)


def segfaults(points: Floats) -> list[Triangle]:
    if len(points) > 12:
        ctypes.string_at(0)
    return right(points)


def hangs(points: Floats) -> list[Triangle]:
    while len(np.unique(points, axis=0)) < len(points):
        pass
    return right(points)


def raises(points: Floats) -> list[Triangle]:
    (ax, ay), (bx, by), (cx, cy) = points[:3].tolist()
    if (bx - ax) * (cy - ay) == (by - ay) * (cx - ax):
        raise ZeroDivisionError("the first three points span no triangle")
    return right(points)


def wrong_far_away(points: Floats) -> list[Triangle]:
    """Beyond 2^20 coordinates are kept with 24 bits."""
    far = np.abs(points).max(initial=0) > 2**20
    return right(points.astype(np.float32).astype(np.float64) if far else points)


def keeps_duplicates(points: Floats) -> list[Triangle]:
    """Joins coincident points as if they were two."""
    triangles = right(points)
    places = points.tolist()
    for v in range(len(places)):
        if places.index(places[v]) < v and triangles:
            triangles.append((places.index(places[v]), v, triangles[0][0]))
    return triangles


def merges_near_points(points: Floats) -> list[Triangle]:
    return right(np.round(points, 6))


def returns_nan(points: Floats) -> tuple[Floats, list[Triangle]]:
    made = points.copy()
    made[np.abs(made) > 1e100] = np.nan
    return made, right(points)


def returns_single_precision(points: Floats) -> tuple[npt.NDArray[np.float32], list[Triangle]]:
    with np.errstate(all="ignore"):
        return points.astype(np.float32), right(points)


def adds_the_centre(points: Floats) -> tuple[Floats, list[Triangle]]:
    """A Steiner point that nobody asked for."""
    triangles = right(points)
    if not triangles:
        return points, triangles
    a, b, c = triangles[0]
    n = len(points)
    return np.concatenate([points, [points[[a, b, c]].mean(axis=0)]]), [*triangles[1:], (a, b, n), (b, c, n), (c, a, n)]


_calls = itertools.count()


def never_the_same(points: Floats) -> list[Triangle]:
    triangles = right(points)
    start = next(_calls) % max(len(triangles), 1)
    return triangles[start:] + triangles[:start]


def sorts_in_place(points: Floats) -> list[Triangle]:
    triangles = right(points)
    points -= points.min(axis=0)
    return triangles


def returns_nothing(points: Floats) -> list[Triangle] | None:
    return right(points) or None if len(points) > 3 else None


def eats_memory(points: Floats) -> list[Triangle]:
    return right(points) if len(points) < 20 else right(np.ones((1 << 36, 2))[: len(points)])


def refuses(points: Floats) -> list[Triangle]:
    raise ValueError(f"no {len(points)} points")


def refuses_segments(points: Floats, segments: Integers) -> list[Triangle]:
    raise ValueError(f"no {len(points)} points and {len(segments)} segments")


def loses_a_segment(points: Floats, segments: Integers) -> Any:
    from exactmesh.conformance.meshers import exactmesh_segments

    return exactmesh_segments(points, segments[:-1])


def ignores_segments(points: Floats, segments: Integers) -> list[Triangle]:
    assert len(segments) >= 0
    return right(points)


def carves_too_much(points: Floats, segments: Integers) -> Any:
    """What the segments enclose, where the hull was asked for."""
    from exactmesh import PSLG, constrained_delaunay

    made = constrained_delaunay(PSLG(points, segments), crossings="split")
    return made.points, made.triangles


def fills_holes(points: Floats, segments: Integers) -> Any:
    """Rings inside of rings are no holes to it."""
    from exactmesh import PSLG, constrained_delaunay

    made = constrained_delaunay(PSLG(points, segments), crossings="split")
    return made.points, made.triangles


#: What each mesher of points breaks, and how.
PLANTED: dict[str, tuple[str, str]] = {
    "drops_a_point": ("all_points_used", "wrong"),
    "drops_an_inner_point": ("delaunay", "wrong"),
    "drops_a_hull_triangle": ("covers_hull", "wrong"),
    "skips_a_flip": ("delaunay", "wrong"),
    "float_predicates": ("delaunay", "wrong"),
    "flips_what_doubles_resolve": ("delaunay", "rounding"),
    "counts_from_one": ("indices", "wrong"),
    "counts_from_minus_one": ("indices", "wrong"),
    "repeats_a_triangle": ("admissible", "wrong"),
    "covers_twice": ("admissible", "wrong"),
    "swaps_orientation": ("orientation", "wrong"),
    "exits": ("answers", "dies"),
    "leaves": ("answers", "dies"),
    "segfaults": ("answers", "dies"),
    "hangs": ("answers", "hangs"),
    "raises": ("answers", "refuses"),
    "wrong_far_away": ("all_points_used", "wrong"),
    "keeps_duplicates": ("admissible", "wrong"),
    "merges_near_points": ("all_points_used", "wrong"),
    "returns_nan": ("finite", "wrong"),
    "returns_single_precision": ("no_new_points", "wrong"),
    "adds_the_centre": ("no_new_points", "wrong"),
    "never_the_same": ("repeatable", "wrong"),
    "sorts_in_place": ("keeps_input", "wrong"),
    "returns_nothing": ("answers", "wrong"),
    "eats_memory": ("answers", "refuses"),
}
#: What each mesher of segments breaks, and how.
PLANTED_SEGMENTS: dict[str, tuple[str, str]] = {
    "loses_a_segment": ("segments_present", "wrong"),
    "ignores_segments": ("segments_present", "wrong"),
    "carves_too_much": ("covers_hull", "wrong"),
}
#: What each mesher of domains breaks, and how.
PLANTED_DOMAINS: dict[str, tuple[str, str]] = {
    "fills_holes": ("covers_domain", "wrong"),
}
