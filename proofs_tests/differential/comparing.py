"""What the library answers, held against brute force."""

from collections.abc import Iterator
from itertools import combinations

import numpy as np
from proofs_tests.differential import judging, triangulating
from proofs_tests.differential.families import Given
from proofs_tests.differential.table import Table, sign
from proofs_tests.differential.triangulating import Triangle

from exactkernel import incircle_batch, orient2d_batch
from exactkernel.types import FloatArray, IntArray
from exactmesh import PSLG, Carve, constrained_delaunay, delaunay, verify
from exactmesh.errors import CollinearPointsError, CrossingError, PSLGError, TooFewPointsError
from exactmesh.strategies import Corrupted, PlainMesh
from exactmesh.triangulation import Triangulation
from exactmesh.verify import Property, Verdict

__all__ = ["disagreements"]


def disagreements(given: Given) -> list[str]:
    """Return in what the library and brute force differ on an input, in sentences."""
    if isinstance(given, PSLG):
        return list(_of_graph(given))
    if isinstance(given, PlainMesh | Corrupted):
        return list(_of_mesh(given))
    table = Table(given.tolist())
    return [*_of_predicates(given, table), *_of_delaunay(given, table)]


def _of_predicates(points: FloatArray, table: Table) -> Iterator[str]:
    """Every triple and every four of the given points, in their order."""
    rank, n = table.rank, len(points)
    triples = np.array(list(combinations(range(n), 3)), dtype=np.int64).reshape(-1, 3)
    signs = orient2d_batch(*(points[triples[:, i]] for i in range(3))).tolist()
    for (a, b, c), found in zip(triples.tolist(), signs, strict=True):
        if found != sign(table.twice[rank[a]][rank[b]][rank[c]]):
            yield f"orient2d of points {a}, {b}, {c} is {found}"
    fours = np.array(list(combinations(range(n), 4)), dtype=np.int64).reshape(-1, 4)
    signs = incircle_batch(*(points[fours[:, i]] for i in range(4))).tolist()
    for four, found in zip(fours.tolist(), signs, strict=True):
        ranks = [rank[v] for v in four]
        if found != (table.incircle(*ranks)[0] if len(set(ranks)) == 4 else 0):
            yield f"incircle of points {four} is {found}"


def _rows(mesh: Triangulation, table: Table, points: FloatArray) -> Iterator[str]:
    """Look at vertices and representatives; triangles are for the caller."""
    first = [table.rank.index(rank) for rank in table.rank]
    where = mesh.representative.tolist()
    for v, (own, other) in enumerate(zip(where, first, strict=True)):
        if own != where[other]:
            yield f"point {v} is vertex {own}, its first twin {other} is vertex {where[other]}"
        elif own >= 0 and mesh.points[own].tolist() != points[other].tolist():
            yield f"vertex {own} does not lie where point {other} does"


def _ranks(mesh: Triangulation, table: Table) -> list[int]:
    """Return the rank of each vertex."""
    ranks = [-1] * len(mesh.points)
    for v, vertex in enumerate(mesh.representative.tolist()):
        if vertex >= 0:
            ranks[vertex] = table.rank[v]
    return ranks


def _triangles(mesh: Triangulation, table: Table) -> tuple[set[Triangle], bool]:
    """Return the triangles by ranks, and whether all are there once and counterclockwise."""
    ranks = _ranks(mesh, table)
    rows = [(ranks[a], ranks[b], ranks[c]) for a, b, c in mesh.triangles.tolist()]
    found: set[Triangle] = set()
    for row in rows:
        a, b, c = sorted(row)
        found.add((a, b, c))
    return found, len(found) == len(rows) and all(table.twice[a][b][c] > 0 for a, b, c in rows)


def _of_triangles(mesh: Triangulation, table: Table, expected: set[Triangle], what: str) -> Iterator[str]:
    found, is_sound = _triangles(mesh, table)
    if found != expected:
        yield f"{what}: {sorted(found - expected)} are there and {sorted(expected - found)} are not, by ranks"
    elif not is_sound:
        yield f"{what}: a triangle is clockwise, or there twice"


def _of_delaunay(points: FloatArray, table: Table) -> Iterator[str]:
    expected = triangulating.delaunay(table)
    try:
        mesh = delaunay(points)
    except (CollinearPointsError, TooFewPointsError) as error:
        if expected:
            yield f"delaunay: {error}"
        return
    yield from _rows(mesh, table, points)
    yield from _of_triangles(mesh, table, expected, "delaunay")


def _of_graph(graph: PSLG) -> Iterator[str]:
    table = Table(graph.points.tolist())
    ends = [(table.rank[a], table.rank[b]) for a, b in graph.segments.tolist()]
    pieces = triangulating.pieces_of(table, ends)
    crossing = triangulating.crossing_segments(table, pieces)
    fixed = {piece for chain in pieces for piece in chain}
    try:
        mesh = constrained_delaunay(graph, carve=False)
    except CrossingError as error:
        told = sorted((min(pair), max(pair)) for pair in error.pairs.tolist())
        if told != crossing:
            yield f"constrained_delaunay: segments {told} cross, by brute force {crossing}"
        return
    if crossing:
        yield f"constrained_delaunay: segments {crossing} cross, and nobody says so"
        return
    expected = triangulating.constrained(table, fixed)
    yield from _rows(mesh, table, graph.points)
    yield from _of_triangles(mesh, table, expected, "constrained_delaunay of the hull")
    yield from _of_edges(mesh, table, fixed)
    yield from _of_domain(graph, table, expected, pieces)


def _of_edges(mesh: Triangulation, table: Table, fixed: set[tuple[int, int]]) -> Iterator[str]:
    ranks = _ranks(mesh, table)
    found = {(min(ranks[a], ranks[b]), max(ranks[a], ranks[b])) for a, b in mesh.segments.tolist()}
    if found != fixed:
        yield f"constrained edges are {sorted(found)}, pieces of segments {sorted(fixed)}, by ranks"


def _of_domain(graph: PSLG, table: Table, hull: set[Triangle], pieces: list[list[tuple[int, int]]]) -> Iterator[str]:
    dug = {
        t
        for t in hull
        for hole in graph.holes.tolist()
        if table.contains(*triangulating.counterclockwise(table, t), hole)
    }
    even_odd = graph.rule is Carve.EVEN_ODD
    inside, is_open = triangulating.domain(table, hull, pieces, dug, even_odd=even_odd)
    is_refused = not inside or (is_open and not even_odd)
    try:
        mesh = constrained_delaunay(graph)
    except PSLGError as error:
        if not is_refused:
            yield f"carving: {error}"
        return
    if is_refused:
        yield "carving: an open outline, or an empty domain, is not refused"
        return
    yield from _of_triangles(mesh, table, inside, "the domain")
    ends = mesh.representative[graph.segments]
    segments = ends[(ends >= 0).all(axis=1) & (ends[:, 0] != ends[:, 1])]
    for labels in (np.zeros(len(mesh.triangles)), mesh.triangles.min(axis=1).astype(np.float64)):
        yield from _of_report(mesh.points, mesh.triangles, segments, labels)


_COMPARED = {Verdict.HOLDS: True, Verdict.FAILS: False}


def _of_mesh(mesh: PlainMesh | Corrupted) -> Iterator[str]:
    segments = mesh.segments if isinstance(mesh, Corrupted) else None
    labels = mesh.labels if isinstance(mesh, Corrupted) else None
    yield from _of_report(mesh.points, mesh.triangles, segments, labels)


def _of_report(
    points: FloatArray, triangles: IntArray, segments: IntArray | None, labels: FloatArray | None
) -> Iterator[str]:
    report = verify(points, triangles, segments=segments, labels=labels)
    told = judging.answers(
        points.tolist(),
        triangles.tolist(),
        None if segments is None else segments.tolist(),
        None if labels is None else labels.tolist(),
    )
    for property_, answer in told.items():
        verdict = report.verdict(property_)
        if verdict in _COMPARED and _COMPARED[verdict] is not answer:
            yield f"verify: {property_} {verdict}, by brute force {answer}"
        elif verdict not in _COMPARED and not _may_be_undecided(property_, told):
            yield f"verify: {property_} is undecided without a reason"


def _may_be_undecided(property_: Property, told: dict[Property, bool]) -> bool:
    return not all(told[needed] for needed in judging.PREREQUISITES.get(property_, ()) if needed in told)
