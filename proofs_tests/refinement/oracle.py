"""What refinement promises, from the definitions, in fractions: slow, naive, sharing no code with the library."""

from collections import Counter
from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations, pairwise
from typing import NamedTuple

from proofs_tests import oracles
from proofs_tests.kernel import shape_oracle
from proofs_tests.kernel.strategies import Point
from proofs_tests.mesh.constrained_oracle import chain
from proofs_tests.oracles import RationalPoint, Triangle

__all__ = ["Output", "angle_faults", "area_faults", "encroached", "mesh_faults", "nearest_before", "small_input_angle"]


class Output(NamedTuple):
    """A refined mesh and the graph that it came from, in plain lists."""

    points: list[Point]
    triangles: list[Triangle]
    graph_points: list[Point]
    segments: list[tuple[int, int]]


def _pairs(t: Triangle) -> list[tuple[int, int]]:
    a, b, c = t
    return [(a, b), (b, c), (c, a)]


def _pieces(output: Output, points: Sequence[RationalPoint]) -> tuple[list[str], set[frozenset[int]]]:
    """Return the segments that are no chains of edges, and the edges on segments."""
    edges = {frozenset(pair) for t in output.triangles for pair in _pairs(t)}
    index = {p: v for v, p in reversed(list(enumerate(points)))}
    ends = oracles.rationals(output.graph_points)
    faults, on_segments = [], set()
    for a, b in output.segments:
        if ends[a] not in index or ends[b] not in index:
            faults.append(f"an end of segment {a}-{b} is no vertex")
            continue
        pieces = [frozenset(piece) for piece in pairwise(chain(points, (index[ends[a]], index[ends[b]])))]
        if not set(pieces) <= edges:
            faults.append(f"segment {a}-{b} is no chain")
        on_segments |= set(pieces)
    return faults, on_segments


def mesh_faults(output: Output, area: Fraction | None = None) -> list[str]:
    """Theorems A, B, E, F: what is wrong with the mesh as a constrained Delaunay triangulation of the graph's domain.

    ``area`` is twice that of the domain: positive triangles that match along edges and have their boundary on segments
    cover faces of the segments, each as often as every other place of it, and the domain's area says that it is once.
    """
    points = oracles.rationals(output.points)
    faults = [] if len(set(points)) == len(points) else ["two vertices at one place"]
    areas = [oracles.orient(*(points[v] for v in t)) for t in output.triangles]
    faults += [f"triangle {t} is not counterclockwise" for t, a in enumerate(areas) if a <= 0]
    directed = Counter(pair for t in output.triangles for pair in _pairs(t))
    faults += [f"edge {pair} occurs {count} times" for pair, count in directed.items() if count > 1]
    missing, on_segments = _pieces(output, points)
    faults += missing
    faults += [
        f"boundary edge {pair} on no segment"
        for pair in directed
        if pair[::-1] not in directed and frozenset(pair) not in on_segments
    ]
    if area is not None and sum(areas) != area:
        faults.append(f"the area is {float(sum(areas))}, not {float(area)}")
    apex = {pair: sum(t) - sum(pair) for t in output.triangles for pair in _pairs(t)}
    for (a, b), c in apex.items():
        d = apex.get((b, a))
        if d is not None and frozenset((a, b)) not in on_segments:
            centre, radius = oracles.circumcircle(points[a], points[b], points[c])
            if oracles.squared_distance(centre, points[d]) < radius:
                faults.append(f"edge {a}-{b} is not Delaunay")
    return faults


def encroached(output: Output) -> set[tuple[frozenset[int], int]]:
    """The edges on segments, with opposite corners inside their diametral circles."""
    points = oracles.rationals(output.points)
    _, on_segments = _pieces(output, points)
    found = set()
    for t in output.triangles:
        for a, b in _pairs(t):
            c = sum(t) - a - b
            (ax, ay), (bx, by), (cx, cy) = points[a], points[b], points[c]
            if frozenset((a, b)) in on_segments and (ax - cx) * (bx - cx) + (ay - cy) * (by - cy) < 0:
                found.add((frozenset((a, b)), c))
    return found


def angle_faults(output: Output, degrees: float) -> set[int]:
    """The triangles with an angle below the bound."""
    points = oracles.rationals(output.points)
    return {
        i for i, t in enumerate(output.triangles) if shape_oracle.angle_below([points[v] for v in t], degrees)
    }  # fmt: skip


def area_faults(output: Output, area: float) -> set[int]:
    """The triangles with an area above the bound."""
    return {i for i, t in enumerate(output.triangles) if shape_oracle.area_above([output.points[v] for v in t], area)}


def small_input_angle(output: Output, degrees: float) -> bool:
    """Whether two segments of the graph meet at less than the angle: at a common point, or an end inside of another."""
    points = oracles.rationals(output.graph_points)
    places = sorted(set(points))
    rays: dict[RationalPoint, list[RationalPoint]] = {p: [] for p in places}
    for a, b in output.segments:
        on_it = [p for p in places if oracles.on_segment(p, points[a], points[b])]
        for p, q in pairwise(on_it):
            rays[p].append(q)
            rays[q].append(p)
    return any(
        oracles.orient(p, q, r) != 0 and shape_oracle.compare_angle(p, q, r, degrees) < 0
        for p, ends in rays.items()
        for q, r in combinations(set(ends), 2)
    )


def nearest_before(points: Sequence[RationalPoint], v: int) -> Fraction:
    """The squared distance of a vertex from the nearest one with a smaller number."""
    return min(oracles.squared_distance(points[v], p) for p in points[:v])
