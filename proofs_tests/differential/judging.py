"""The properties of a mesh by brute force: every pair of triangles, every point, every directed edge."""

from collections.abc import Sequence
from itertools import combinations
from math import isfinite

from proofs_tests.differential.table import Table
from proofs_tests.differential.triangulating import counterclockwise

from exactmesh.verify import Property

__all__ = ["PREREQUISITES", "Judge", "answers"]

Corners = tuple[int, int, int]  # indices of points
Segment = tuple[int, int]

#: What may be undecided, and without which other properties only.
PREREQUISITES = {
    Property.COVERS_HULL: (Property.ADMISSIBLE,),
    Property.DELAUNAY: (Property.ADMISSIBLE, Property.COVERS_HULL),
    Property.SEGMENTS_PRESENT: (Property.ADMISSIBLE,),
    Property.REGIONS: (Property.ADMISSIBLE, Property.SEGMENTS_PRESENT),
}


def answers(
    points: Sequence[Sequence[float]],
    triangles: Sequence[Corners],
    segments: Sequence[Segment] | None,
    labels: Sequence[float] | None,
) -> dict[Property, bool]:
    """Return whether each property holds that can be told; on bad numbers and indices nothing else rests."""
    told = {
        Property.FINITE: all(isfinite(x) and isfinite(y) for x, y in points),
        Property.INDICES: all(len(set(t)) == 3 and min(t) >= 0 and max(t) < len(points) for t in triangles),
    }
    if not all(told.values()):
        return told
    judge = Judge(points, triangles)
    told |= judge.combinatorial() | judge.geometric()
    if segments is not None:
        told[Property.SEGMENTS_PRESENT] = all(judge.is_chain(*segment) for segment in segments)
        if labels is not None:
            told[Property.REGIONS] = judge.labels_change_on(segments, labels)
    return told


class Judge:
    """A mesh whose indices are those of finite points."""

    def __init__(self, points: Sequence[Sequence[float]], triangles: Sequence[Corners]) -> None:
        self.table = Table(points)
        self.count = len(points)
        self.triangles = [tuple(t) for t in triangles]
        rank = self.table.rank
        self.ranks = [(rank[a], rank[b], rank[c]) for a, b, c in self.triangles]
        self.areas = [self.table.twice[a][b][c] for a, b, c in self.ranks]
        self.is_solid = all(self.areas)

    def combinatorial(self) -> dict[Property, bool]:
        edges = [edge for a, b, c in self.triangles for edge in ((a, b), (b, c), (c, a))]
        return {
            Property.DISTINCT_POINTS: len(set(self.table.rank)) == self.count,
            Property.ALL_POINTS_USED: {v for t in self.triangles for v in t} == set(range(self.count)),
            Property.EDGE_MANIFOLD: len(set(edges)) == len(edges),
            Property.VERTEX_MANIFOLD: all(self._is_fan(v) for v in range(self.count)),
        }

    def _is_fan(self, v: int) -> bool:
        """The edges opposite the vertex form one path or cycle: one in, one out, and all are reached from the first."""
        opposite = [(t[(t.index(v) + 1) % 3], t[(t.index(v) + 2) % 3]) for t in self.triangles if v in t]
        after = dict(opposite)
        if len(after) < len(opposite) or len({b for _, b in opposite}) < len(opposite):
            return False
        starts = set(after) - set(after.values())
        at, steps = next(iter(starts or after), -1), 0
        while at in after and steps < len(opposite):
            at, steps = after[at], steps + 1
        return len(starts) <= 1 and steps == len(opposite)

    def geometric(self) -> dict[Property, bool]:
        is_admissible = self.is_solid and all(self._meet(s, t) for s, t in combinations(range(len(self.triangles)), 2))
        largest = [self._largest_angle(t) for t in self.ranks]
        return {
            Property.ORIENTATION: all(area > 0 for area in self.areas),
            Property.ADMISSIBLE: is_admissible,
            Property.COVERS_HULL: is_admissible and sum(map(abs, self.areas)) == self._hull(),
            Property.DELAUNAY: self.is_solid and not any(self._is_spoilt(*t) for t in self.ranks),
            Property.WEAKLY_ACUTE: self.is_solid and all(sign <= 0 for sign in largest),
            Property.ACUTE: self.is_solid and all(sign < 0 for sign in largest),
        }

    def _meet(self, s: int, t: int) -> bool:
        """Two solid triangles meet in what they have in common by index, and in nothing else.

        Two convex polygons have no interior in common if and only if the line of a side of one separates them; then
        they meet on that line.
        """
        common = [self.table.rank[v] for v in set(self.triangles[s]) & set(self.triangles[t])]
        for first, second in ((s, t), (t, s)):
            a, b, c = counterclockwise(self.table, self.ranks[first])
            for u, v in ((a, b), (b, c), (c, a)):
                sides = [(self.table.twice[u][v][w], w) for w in self.ranks[second]]
                if all(side <= 0 for side, _ in sides):
                    on_line = [w for side, w in sides if side == 0]
                    return sorted(common) == _shared((min(u, v), max(u, v)), on_line)
        return False

    def _hull(self) -> int:
        """Return twice the area of the hull: of the pairs that have all others on their left."""
        area, table = 0, self.table
        for a in range(table.n):
            for b in range(table.n):
                on_left = (table.twice[a][b][w] > 0 or w in table.between(a, b) for w in range(table.n))
                if a != b and all(on_left):
                    (ax, ay), (bx, by) = table.at[a], table.at[b]
                    area += ax * by - ay * bx
        return area

    def _is_spoilt(self, a: int, b: int, c: int) -> bool:
        turn = 1 if self.table.twice[a][b][c] > 0 else -1
        return any(turn * self.table.incircle(a, b, c, d)[0] > 0 for d in range(self.table.n) if d not in (a, b, c))

    def _largest_angle(self, t: Corners) -> int:
        """Return the sign of the largest angle less 90 degrees, by Pythagoras."""
        a, b, c = (self.table.at[v] for v in t)
        x, y, z = sorted((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2 for p, q in ((a, b), (b, c), (c, a)))
        return (z > x + y) - (z < x + y)

    def is_chain(self, start: int, end: int) -> bool:
        """Tell whether edges lead from the start to the end of a segment, on it and ever forward."""
        rank = self.table.rank
        along = self.table.between(rank[start], rank[end])
        steps = along if rank[start] < rank[end] else along[::-1]
        reached = {start}
        for here in steps:
            for t in self.triangles:
                for v in reached & set(t):
                    if rank[v] == here:
                        reached |= {w for w in t if rank[w] in steps and steps.index(rank[w]) > steps.index(here)}
        return end in reached

    def labels_change_on(self, segments: Sequence[Segment], labels: Sequence[float]) -> bool:
        rank = self.table.rank
        lines = [set(self.table.between(rank[a], rank[b])) for a, b in segments]
        pairs = combinations(range(len(self.triangles)), 2)
        shared = [(set(self.triangles[s]) & set(self.triangles[t]), labels[s] == labels[t]) for s, t in pairs]
        return all(
            alike or len(edge) < 2 or any({rank[v] for v in edge} <= line for line in lines) for edge, alike in shared
        )


def _shared(side: tuple[int, int], others: Sequence[int]) -> list[int]:
    """Return the ends of what a side and points of another triangle have in common on one line, by their ranks."""
    if not others:
        return []
    low, high = max(side[0], min(others)), min(side[1], max(others))
    return [] if low > high else [low] if low == high else [low, high]
